//! A histogram of gaps, in a few lines of text.

use std::fmt;

use crate::table::{Table, count, short};

/// Number of bins from the least to the largest gap.
const N_BINS: usize = 10;

/// Length of the longest bar.
const WIDTH: usize = 40;

/// If the largest gap exceeds the least by this factor, bins are spaced geometrically.
const GEOMETRIC_RATIO: f64 = 30.0;

/// Counts of gaps by size.
pub(crate) struct Histogram {
    /// The lower limit of each bin, then the upper limit of the last.
    limits: Vec<f64>,
    counts: Vec<usize>,
    warn: Option<f64>,
}

impl Histogram {
    /// The histogram of some gaps; `None` where there is nothing to show.
    pub(crate) fn of(gaps: &[f64], warn: Option<f64>) -> Option<Self> {
        let low = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let high = gaps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !(low.is_finite() && high > low) {
            return None;
        }
        let is_wide = low > 0.0 && high > GEOMETRIC_RATIO * low;
        let limit = |i: usize| {
            let part = i as f64 / N_BINS as f64;
            if is_wide { low * (high / low).powf(part) } else { low + (high - low) * part }
        };
        let limits: Vec<f64> = (0..=N_BINS).map(limit).collect();
        let mut counts = vec![0; N_BINS];
        for gap in gaps {
            counts[limits[1..N_BINS].partition_point(|limit| limit <= gap)] += 1;
        }
        Some(Self { limits, counts, warn })
    }
}

impl fmt::Display for Histogram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let most = self.counts.iter().copied().max().unwrap_or(1).max(1);
        let mut table = Table::new(["gap from", "vertices", ""]);
        for (&limit, &n) in self.limits.iter().zip(&self.counts) {
            let bar = "#".repeat((n * WIDTH).div_ceil(most));
            let mark = if self.warn.is_some_and(|warn| limit < warn) { "!" } else { "" };
            table.row([format!("{}{mark}", short(limit)), count(n), format!("{bar:<WIDTH$}")]);
        }
        table.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gap_is_counted_once() {
        let gaps = [0.1, 0.2, 0.2, 1.1];
        let histogram = Histogram::of(&gaps, Some(0.15)).expect("gaps differ");
        assert_eq!(histogram.counts.iter().sum::<usize>(), gaps.len());
        assert_eq!((histogram.counts[0], histogram.counts[N_BINS - 1]), (1, 1));
        assert!(histogram.to_string().contains('!'));
        assert!(Histogram::of(&[], None).is_none());
        let wide = Histogram::of(&[0.001, 0.01, 1.0], None).expect("gaps differ");
        assert_eq!(wide.counts.iter().sum::<usize>(), 3);
    }
}
