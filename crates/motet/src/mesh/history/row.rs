//! The rows of entities that changed: old entities with shares, and the main one among them.

use std::ops::Range;

use crate::base::{Csr, Error, Id, Result};

/// Tolerance on the sum of the shares of a row, which must be 1.
const SUM_TOLERANCE: f64 = 1e-9;

/// For each entity that changed, the old entities that it came from.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "Parts<I>"))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "I: Id + serde::Deserialize<'de>")))]
pub struct Rows<I> {
    /// The new ids, in rising order.
    ids: Vec<I>,
    /// The old ids of each row.
    from: Csr<I>,
    /// A share for each old id of each row.
    shares: Vec<f64>,
    /// The main old id of each row.
    main: Vec<I>,
}

/// The stored parts of [`Rows`], not yet validated.
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
struct Parts<I> {
    ids: Vec<I>,
    from: Csr<I>,
    shares: Vec<f64>,
    main: Vec<I>,
}

impl<I: Id> TryFrom<Parts<I>> for Rows<I> {
    type Error = Error;

    fn try_from(parts: Parts<I>) -> Result<Self> {
        let Parts { ids, from, shares, main } = parts;
        let n = ids.len();
        if from.len() != n || main.len() != n || shares.len() != from.items().len() {
            return Err(Error::input(format!(
                "{n} ids need one row and one main id each, \
                 but there are {} rows with {} shares for {} old ids, and {} main ids",
                from.len(),
                shares.len(),
                from.items().len(),
                main.len()
            )));
        }
        if let Some(w) = ids.windows(2).find(|w| w[0] >= w[1]) {
            return Err(Error::input(format!("row {} follows row {}: ids must ascend", w[1], w[0])));
        }
        Ok(Self { ids, from, shares, main })
    }
}

/// Where one entity that changed came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a, I> {
    /// The old entities.
    pub from: &'a [I],
    /// The share of each; they sum to 1. All are positive except in [rows for quadratic
    /// fields](super::Origins::quadratic).
    pub shares: &'a [f64],
    /// The old entity whose ids, names and directions are inherited: the one with the largest share or, for a
    /// moved vertex, the vertex itself.
    pub main: I,
}

impl<I> Default for Rows<I> {
    fn default() -> Self {
        Self { ids: Vec::new(), from: Csr::default(), shares: Vec::new(), main: Vec::new() }
    }
}

impl<I: Id> Rows<I> {
    /// No rows.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the row of `id`, which must be larger than all ids before. Shares that are not positive are left
    /// out, and the others are scaled to sum to 1; if none are left, `main` gets share 1.
    ///
    /// Panics if `id` is not the largest.
    pub fn push(&mut self, id: I, parts: &[(I, f64)], main: I) {
        let sum: f64 = parts.iter().map(|p| p.1).filter(|&share| share > 0.0).sum();
        if let &[(old, share)] = parts
            && share > 0.0
            && share.is_finite()
        {
            self.push_signed(id, &[(old, 1.0)], main);
        } else if sum > 0.0 && sum.is_finite() {
            let scaled = parts.iter().map(|&(old, share)| (old, share / sum)).filter(|p| p.1 > 0.0);
            self.push_signed(id, &scaled.collect::<Vec<_>>(), main);
        } else {
            self.push_signed(id, &[(main, 1.0)], main);
        }
    }

    /// Adds the row of `id`, which must be larger than all ids before. Shares may be of either sign and stay
    /// as they are, except that the largest is adjusted to make them sum to 1.
    ///
    /// Panics if `id` is not the largest, or there are no parts.
    pub fn push_signed(&mut self, id: I, parts: &[(I, f64)], main: I) {
        assert!(self.ids.last().is_none_or(|&last| last < id), "rows come in rising order of their ids");
        assert!(!parts.is_empty(), "a row has parts");
        let start = self.shares.len();
        self.from.push(parts.iter().map(|p| p.0));
        self.shares.extend(parts.iter().map(|p| p.1));
        adjust_sum(&mut self.shares[start..]);
        self.ids.push(id);
        self.main.push(main);
    }

    /// Adds rows whose ids are larger than all before.
    ///
    /// Panics if they are not.
    pub(crate) fn append(&mut self, rows: Self) {
        let is_after = self.ids.last().is_none_or(|last| rows.ids.first().is_none_or(|first| last < first));
        assert!(is_after, "rows come in rising order of their ids");
        if self.is_empty() {
            *self = rows;
            return;
        }
        self.append_range(&rows, 0..rows.len());
    }

    fn append_range(&mut self, rows: &Self, range: Range<usize>) {
        let [start, end] = [range.start, range.end].map(|i| rows.from.offsets()[i] as usize);
        self.ids.extend_from_slice(&rows.ids[range.clone()]);
        self.main.extend_from_slice(&rows.main[range.clone()]);
        self.from.append_range(&rows.from, range);
        self.shares.extend_from_slice(&rows.shares[start..end]);
    }

    /// These rows and others, by rising ids; no id is in both.
    pub(crate) fn merged(self, others: Self) -> Self {
        let is_apart = |x: &Self, y: &Self| {
            x.ids.last().is_none_or(|last| y.ids.first().is_none_or(|first| last < first))
        };
        if is_apart(&self, &others) || is_apart(&others, &self) {
            let (mut first, second) = if is_apart(&self, &others) { (self, others) } else { (others, self) };
            first.append(second);
            return first;
        }
        let mut merged = Self::new();
        let (mut i, mut k) = (0, 0);
        // Rows below the next one of the others.
        let run = |rows: &Self, first: usize, next: I| {
            first..first + rows.ids[first..].partition_point(|id| *id < next)
        };
        while i < self.len() && k < others.len() {
            let first = run(&self, i, others.ids[k]);
            i = first.end;
            merged.append_range(&self, first);
            if i < self.len() {
                let second = run(&others, k, self.ids[i]);
                k = second.end;
                merged.append_range(&others, second);
            }
        }
        merged.append_range(&self, i..self.len());
        merged.append_range(&others, k..others.len());
        merged
    }

    /// These rows with new ids by `new` and old ones by `old`, both of which keep their order.
    pub(crate) fn renumbered(&self, new: impl Fn(I) -> I, old: impl Fn(I) -> I) -> Self {
        Self {
            ids: self.ids.iter().map(|&id| new(id)).collect(),
            from: self.from.with_items(|&id| old(id)),
            shares: self.shares.clone(),
            main: self.main.iter().map(|&id| old(id)).collect(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The new ids that have rows, in rising order.
    pub fn ids(&self) -> &[I] {
        &self.ids
    }

    /// The row of a new id, if it has one.
    pub fn of(&self, id: I) -> Option<Row<'_, I>> {
        self.ids.binary_search(&id).ok().map(|i| self.row(i))
    }

    /// All rows in the order of their ids.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Row<'_, I>> + '_ {
        (0..self.len()).map(|i| self.row(i))
    }

    /// The rows from an id on, with their ids.
    pub(super) fn from(&self, id: I) -> impl Iterator<Item = (I, Row<'_, I>)> + '_ {
        let first = self.ids.partition_point(|other| *other < id);
        (first..self.len()).map(|i| (self.ids[i], self.row(i)))
    }

    fn row(&self, i: usize) -> Row<'_, I> {
        let range = self.from.offsets()[i] as usize..self.from.offsets()[i + 1] as usize;
        Row { from: self.from.list(i), shares: &self.shares[range], main: self.main[i] }
    }

    /// Checks that the rows name only the `n_old` old entities, and that their shares are valid.
    pub(super) fn check(&self, n_old: usize, signs: Signs) -> Result<()> {
        let fault =
            self.iter().zip(&self.ids).find_map(|(row, id)| row.fault(n_old, signs).map(|what| (id, what)));
        fault.map_or(Ok(()), |(id, what)| Err(Error::input(what).at(format!("row of {id}"))))
    }
}

/// Which signs the shares of a row may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signs {
    Positive,
    Any,
}

impl<I: Id> Row<'_, I> {
    fn fault(&self, n_old: usize, signs: Signs) -> Option<String> {
        let named = self.from.iter().chain([&self.main]);
        if let Some(beyond) = named.into_iter().find(|old| old.place() >= n_old) {
            return Some(format!("refers to the old id {beyond}, but there were only {n_old}"));
        }
        let sum: f64 = self.shares.iter().sum();
        let fits = |share: f64| share > 0.0 || signs == Signs::Any;
        let must = if signs == Signs::Any { "sum to 1" } else { "be positive and sum to 1" };
        let is_fault = !self.shares.iter().all(|&share| fits(share))
            || (sum - 1.0).abs() > SUM_TOLERANCE
            || sum.is_nan();
        is_fault.then(|| format!("has shares {:?}, which must {must}", self.shares))
    }
}

/// Adjusts the largest share by what rounding left over, so that the sum is 1 to the last digit.
fn adjust_sum(shares: &mut [f64]) {
    let largest = (1..shares.len()).fold(0, |best, i| if shares[i] > shares[best] { i } else { best });
    let others: f64 = (0..shares.len()).filter(|&i| i != largest).map(|i| shares[i]).sum();
    shares[largest] = 1.0 - others;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{CellId, splitmix64};

    /// Rows of ids, runs of which alternate between two lists, against all rows in one list.
    #[test]
    fn merged_rows_are_those_of_both_lists_in_order() {
        for (seed, runs) in [(0, 0), (1, 1), (2, 2), (3, 7), (4, 40)] {
            let (mut both, mut lists, mut id) = (Rows::new(), [Rows::new(), Rows::new()], 0);
            for run in 0..runs {
                for _ in 0..splitmix64(seed + 100 * run) % 5 {
                    let old = |k: u64| CellId::new((splitmix64(id + k) % 90) as usize);
                    let parts: Vec<_> = (0..1 + id % 3).map(|k| (old(k), 0.25 + k as f64)).collect();
                    let new = CellId::new(id as usize);
                    both.push(new, &parts, old(0));
                    lists[run as usize % 2].push(new, &parts, old(0));
                    id += 2;
                }
            }
            let [first, second] = lists;
            assert_eq!(first.clone().merged(second.clone()), both);
            assert_eq!(second.merged(first), both);
        }
    }
}
