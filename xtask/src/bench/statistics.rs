//! Median and spread of repeated measurements; growth and fronts of points.

/// The middle value; the mean of the two in the middle for an even number. `None` for no values.
pub(super) fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = (sorted.len().checked_sub(1)? / 2, sorted.len() / 2);
    Some(0.5 * (sorted[low] + sorted[high]))
}

/// Smallest and largest value. `None` for no values.
pub(super) fn spread(values: &[f64]) -> Option<[f64; 2]> {
    let low = values.iter().copied().min_by(f64::total_cmp)?;
    let high = values.iter().copied().max_by(f64::total_cmp)?;
    Some([low, high])
}

/// A confidence interval of the median of what the values are drawn from, whatever its distribution:
/// from a value to its counterpart from above, such that all values being on one side of the median so
/// often has a probability of at most 1 − `level` (binomial, as in the sign test). `None` for too few
/// values.
pub(super) fn median_interval(values: &[f64], level: f64) -> Option<[f64; 2]> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    // Probability that at most k of n values are below the median.
    let (mut below, mut term) = (0.0, 0.5f64.powi(n as i32));
    let mut outside = 0;
    for k in 0..n / 2 {
        below += term;
        term *= (n - k) as f64 / (k + 1) as f64;
        if 2.0 * below <= 1.0 - level {
            outside = k + 1;
        }
    }
    (outside > 0).then(|| [sorted[outside - 1], sorted[n - outside]])
}

/// The mean. `None` for no values.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Exponent p and factor c of the power law y = c xᵖ that fits best: least squares of the logarithms.
/// `None` without two different positive x.
pub(super) fn power_law(points: &[[f64; 2]]) -> Option<(f64, f64)> {
    let positive = points.iter().filter(|[x, y]| *x > 0.0 && *y > 0.0);
    let logs: Vec<[f64; 2]> = positive.map(|p| p.map(f64::ln)).collect();
    let [x, y] = [0, 1].map(|k| logs.iter().map(|p| p[k]).sum::<f64>() / logs.len() as f64);
    let along: f64 = logs.iter().map(|p| (p[0] - x) * (p[0] - x)).sum();
    let rise: f64 = logs.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    (along > 0.0).then(|| (rise / along, (y - rise / along * x).exp()))
}

/// The points that no other beats in both coordinates, where less is better, by rising x.
pub(super) fn front(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted: Vec<[f64; 2]> =
        points.iter().copied().filter(|p| p.iter().all(|x| x.is_finite())).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut front: Vec<[f64; 2]> = Vec::new();
    for p in sorted {
        if front.last().is_none_or(|last| p[1] < last[1]) {
            front.push(p);
        }
    }
    front
}

/// How y of one front compares with that of another at equal x: the geometric mean of the ratio. What
/// reaches a small x also serves where a larger one would do, so that fronts go on to the right, and
/// are compared from the first x that both reach to the last that either needs; on straight lines
/// between the logarithms. `None` without points.
pub(super) fn front_ratio(one: &[[f64; 2]], other: &[[f64; 2]]) -> Option<f64> {
    const SAMPLES: usize = 64;
    let logs = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let positive: Vec<[f64; 2]> =
            points.iter().copied().filter(|[x, y]| *x > 0.0 && *y > 0.0).collect();
        front(&positive).into_iter().map(|p| p.map(f64::ln)).collect()
    };
    let (one, other) = (logs(one), logs(other));
    let low = one.first()?[0].max(other.first()?[0]);
    let high = one.last()?[0].max(other.last()?[0]);
    let at = |front: &[[f64; 2]], x: f64| match front.partition_point(|p| p[0] < x) {
        0 => front[0][1],
        k if k == front.len() => front[k - 1][1],
        k => {
            let ([x0, y0], [x1, y1]) = (front[k - 1], front[k]);
            y0 + (y1 - y0) * (x - x0) / (x1 - x0)
        }
    };
    let difference = |k: usize| {
        let x = low + (high - low) * (k as f64 + 0.5) / SAMPLES as f64;
        at(&one, x) - at(&other, x)
    };
    Some(((0..SAMPLES).map(difference).sum::<f64>() / SAMPLES as f64).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_one_odd_and_even() {
        assert_eq!((median(&[]), spread(&[]), mean(&[])), (None, None, None));
        assert_eq!((median(&[3.0]), spread(&[3.0])), (Some(3.0), Some([3.0, 3.0])));
        let odd = [5.0, -1.0, 2.0];
        assert_eq!(
            (median(&odd), spread(&odd), mean(&odd)),
            (Some(2.0), Some([-1.0, 5.0]), Some(2.0))
        );
        let even = [9.0, 1.0, 2.0, 4.0];
        assert_eq!(
            (median(&even), spread(&even), mean(&even)),
            (Some(3.0), Some([1.0, 9.0]), Some(4.0))
        );
    }

    #[test]
    fn intervals_of_the_median_are_those_of_the_sign_test() {
        let numbers: Vec<f64> = (1..=15).map(f64::from).collect();
        // P(B(15, ½) ≤ 3) = 0.0176 and P(B(15, ½) ≤ 2) = 0.0037 (tables of the sign test).
        assert_eq!(median_interval(&numbers, 0.95), Some([4.0, 12.0]));
        assert_eq!(median_interval(&numbers, 0.99), Some([3.0, 13.0]));
        assert_eq!(median_interval(&numbers[..8], 0.99), Some([1.0, 8.0]));
        assert_eq!(median_interval(&numbers[..7], 0.99), None);
        assert_eq!(median_interval(&[], 0.5), None);
    }

    #[test]
    fn power_laws_are_found() {
        let points = [1.0, 10.0, 100.0].map(|x: f64| [x, 3.0 * x.powf(-1.5)]);
        let (power, factor) = power_law(&points).unwrap();
        assert!((power + 1.5).abs() < 1e-12 && (factor - 3.0).abs() < 1e-12);
        assert_eq!(power_law(&points[..1]), None);
        assert_eq!(power_law(&[[0.0, 1.0], [1.0, 1.0]]), None);
        assert_eq!(power_law(&[]), None);
    }

    #[test]
    fn fronts_hold_what_nothing_beats() {
        let points = [[3.0, 1.0], [1.0, 5.0], [2.0, 5.0], [2.0, 2.0], [4.0, 1.0], [f64::NAN, 0.0]];
        assert_eq!(front(&points), [[1.0, 5.0], [2.0, 2.0], [3.0, 1.0]]);
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn fronts_are_compared_where_they_meet() {
        let one = [1e-3, 1e-2, 1e-1].map(|x: f64| [x, 1.0 / x]);
        let other = [1e-4, 3e-2, 1e-1].map(|x: f64| [x, 2.0 / x]);
        assert!((front_ratio(&one, &other).unwrap() - 0.5).abs() < 1e-12);
        assert!((front_ratio(&other, &one).unwrap() - 2.0).abs() < 1e-12);
        // One point serves for all larger errors: y = 10 against 100 and 10 on the way.
        let single = front_ratio(&[[1e-3, 10.0]], &[[1e-2, 100.0], [1e-1, 10.0]]).unwrap();
        assert!((single - 0.1f64.sqrt()).abs() < 1e-3, "{single}");
        // Where neither needs more, the first common x counts.
        let alone = front_ratio(&[[1.0, 1.0]], &[[1.0, 4.0]]).unwrap();
        assert!((alone - 0.25).abs() < 1e-12);
        assert_eq!(front_ratio(&one, &[]), None);
    }
}
