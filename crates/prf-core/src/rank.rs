//! Rank correlation: does a reward order states as their true progress does?

/// Spearman's rank correlation of two equally long series, in [−1, 1]; ties share the mean of their ranks.
///
/// `None` when the series differ in length, have fewer than two values, hold a NaN, or one of them is constant.
///
/// ```
/// use prf_core::spearman;
///
/// assert_eq!(spearman(&[1.0, 2.0, 3.0], &[0.1, 0.5, 0.6]), Some(1.0));
/// assert_eq!(spearman(&[1.0, 2.0, 3.0], &[4.0, 4.0, 4.0]), None);
/// ```
pub fn spearman(a: &[f64], b: &[f64]) -> Option<f64> {
    let unordered = |values: &[f64]| values.iter().any(|value| value.is_nan());
    if a.len() != b.len() || a.len() < 2 || unordered(a) || unordered(b) {
        return None;
    }
    pearson(&ranks(a), &ranks(b))
}

/// The probability that a value marked as positive lies above one that isn't, in [0, 1]; of equal ones half counts. This is
/// the area under the ROC curve: 0.5 tells nothing, 0 is always wrong.
///
/// `None` when the series differ in length, hold a NaN, or all marks are the same.
///
/// ```
/// use prf_core::auc;
///
/// assert_eq!(auc(&[0.2, 0.7, 0.9], &[false, true, true]), Some(1.0));
/// assert_eq!(auc(&[0.2, 0.7, 0.7, 0.9], &[false, true, false, true]), Some(0.875));
/// ```
pub fn auc(values: &[f64], positive: &[bool]) -> Option<f64> {
    let positives = positive.iter().filter(|&&positive| positive).count();
    let negatives = positive.len() - positives;
    if values.len() != positive.len() || positives == 0 || negatives == 0 || values.iter().any(|value| value.is_nan()) {
        return None;
    }
    let sum: f64 = ranks(values).iter().zip(positive).filter(|(_, positive)| **positive).map(|(rank, _)| rank).sum();
    // What the sum would be at the least is taken off: the positives' ranks among themselves.
    let below = sum - (positives * (positives - 1)) as f64 / 2.0;
    Some(below / (positives * negatives) as f64)
}

/// The rank of each value, from 0; the mean rank where values are equal.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let mean = start as f64 + (equal.len() - 1) as f64 / 2.0;
        equal.iter().for_each(|&index| ranks[index] = mean);
        start += equal.len();
    }
    ranks
}

fn pearson(a: &[f64], b: &[f64]) -> Option<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut covariance, mut variance_a, mut variance_b) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        covariance += (a - mean_a) * (b - mean_b);
        variance_a += (a - mean_a).powi(2);
        variance_b += (b - mean_b).powi(2);
    }
    let scale = (variance_a * variance_b).sqrt();
    (scale > 0.0).then(|| (covariance / scale).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_share_their_mean_rank() {
        // Ranks 0, 1.5, 1.5, 3 against 0, 1, 2, 3: covariance 4.5, variances 4.5 and 5.
        let expected = 4.5 / (4.5f64 * 5.0).sqrt();
        let found = spearman(&[1.0, 2.0, 2.0, 3.0], &[10.0, 20.0, 30.0, 40.0]).expect("defined");
        assert!((found - expected).abs() < 1e-12, "{found} should be {expected}");
    }

    #[test]
    fn only_the_order_counts() {
        let a = [3.0, -1.0, 7.0, 2.0, 10.0];
        let b = a.map(f64::exp);
        assert_eq!(spearman(&a, &b), Some(1.0));
        assert_eq!(spearman(&a, &b.map(|value| -value)), Some(-1.0));
    }

    #[test]
    fn the_area_counts_the_pairs_in_order() {
        // Of 2 × 3 pairs: 0.5 lies above 0.1 and 0.4, 0.3 above 0.1 and level with the other 0.3.
        let values = [0.5, 0.3, 0.1, 0.3, 0.6];
        let area = auc(&values, &[true, true, false, false, false]);
        let by_hand = (2.0 + 1.0 + 0.5) / 6.0;
        assert!((area.expect("both kinds") - by_hand).abs() < 1e-12, "{area:?}");
        assert_eq!(auc(&values, &[false; 5]), None);
        assert_eq!(auc(&values, &[true; 5]), None);
        assert_eq!(auc(&values, &[true, false]), None);
        assert_eq!(auc(&[f64::NAN, 1.0], &[true, false]), None);
    }

    #[test]
    fn what_has_no_order_has_no_correlation() {
        assert_eq!(spearman(&[1.0], &[1.0]), None);
        assert_eq!(spearman(&[1.0, 2.0], &[1.0]), None);
        assert_eq!(spearman(&[1.0, f64::NAN], &[1.0, 2.0]), None);
        assert_eq!(spearman(&[0.0, -0.0], &[1.0, 2.0]), None);
    }
}
