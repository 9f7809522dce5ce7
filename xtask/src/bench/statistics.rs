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
}
