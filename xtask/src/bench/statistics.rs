//! Median and spread of repeated measurements.

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

/// The mean. `None` for no values.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The slope of the straight line that fits best; `None` without two different points.
pub(super) fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let along: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let rise: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (along > 0.0).then(|| rise / along)
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
    fn slopes_of_straight_lines_are_exact() {
        let line: Vec<(f64, f64)> = [0.0, 1.0, 4.0].iter().map(|&x| (x, 3.0 - 2.0 * x)).collect();
        assert!((slope(&line).unwrap() + 2.0).abs() < 1e-12);
        assert_eq!(slope(&line[..1]), None);
        assert_eq!(slope(&[]), None);
    }
}
