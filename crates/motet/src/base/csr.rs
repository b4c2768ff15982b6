//! Lists of lists in two flat arrays (compressed sparse rows).

use std::ops::Range;

use crate::base::Threads;

/// `n` lists of `T`, end to end in one array.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "Parts<T>"))]
pub struct Csr<T> {
    offsets: Vec<u32>,
    items: Vec<T>,
}

/// The stored form of a [`Csr`], before validation.
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
struct Parts<T> {
    offsets: Vec<u32>,
    items: Vec<T>,
}

impl<T> TryFrom<Parts<T>> for Csr<T> {
    type Error = &'static str;

    fn try_from(parts: Parts<T>) -> Result<Self, Self::Error> {
        Self::new(parts.offsets, parts.items).ok_or("offsets do not rise from 0 to the number of items")
    }
}

impl<T> Default for Csr<T> {
    fn default() -> Self {
        Self { offsets: vec![0], items: Vec::new() }
    }
}

impl<T> Csr<T> {
    /// Lists from `offsets`, which has one entry more than there are lists, starts at 0, never decreases and
    /// ends at `items.len()`; `None` when it does not.
    pub fn new(offsets: Vec<u32>, items: Vec<T>) -> Option<Self> {
        let rises = offsets.windows(2).all(|w| w[0] <= w[1]);
        let spans = offsets.first() == Some(&0) && offsets.last().map(|&o| o as usize) == Some(items.len());
        (rises && spans).then_some(Self { offsets, items })
    }

    /// How many lists there are.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there are no lists.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// List `i`.
    #[inline]
    pub fn list(&self, i: usize) -> &[T] {
        &self.items[self.offsets[i] as usize..self.offsets[i + 1] as usize]
    }

    /// List `i`, mutable.
    #[inline]
    pub fn list_mut(&mut self, i: usize) -> &mut [T] {
        &mut self.items[self.offsets[i] as usize..self.offsets[i + 1] as usize]
    }

    /// All lists in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[T]> + Clone + '_ {
        self.offsets.windows(2).map(|w| &self.items[w[0] as usize..w[1] as usize])
    }

    /// Where each list starts, and where the last one ends.
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// All items, list after list.
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// Lists of the same lengths, with `new(item)` for each item.
    pub(crate) fn with_items<U>(&self, new: impl FnMut(&T) -> U) -> Csr<U> {
        Csr { offsets: self.offsets.clone(), items: self.items.iter().map(new).collect() }
    }

    /// The lists of some runs of this one, with `new(item)` for each item.
    pub(crate) fn runs(
        &self,
        runs: impl Iterator<Item = Range<usize>>,
        new: impl Fn(&T) -> T + Copy,
    ) -> Self {
        let mut offsets = Vec::with_capacity(self.offsets.len());
        let mut items = Vec::with_capacity(self.items.len());
        offsets.push(0);
        for run in runs {
            let [start, end] = [run.start, run.end].map(|i| self.offsets[i]);
            let shift = start - items.len() as u32;
            items.extend(self.items[start as usize..end as usize].iter().map(new));
            offsets.extend(self.offsets[run.start + 1..=run.end].iter().map(|offset| offset - shift));
        }
        Self { offsets, items }
    }

    /// Adds a list at the end.
    ///
    /// Panics past `u32::MAX` items in all.
    pub fn push(&mut self, list: impl IntoIterator<Item = T>) {
        self.items.extend(list);
        self.offsets.push(u32::try_from(self.items.len()).expect("fewer than 2^32 items"));
    }
}

impl<T: Copy> Csr<T> {
    /// Adds some lists of another at the end.
    ///
    /// Panics past `u32::MAX` items in all.
    pub(crate) fn append_range(&mut self, other: &Self, lists: Range<usize>) {
        let [start, end] = [lists.start, lists.end].map(|i| other.offsets[i]);
        let n = u32::try_from(self.items.len()).expect("fewer than 2^32 items");
        assert!(n.checked_add(end - start).is_some(), "fewer than 2^32 items");
        self.items.extend_from_slice(&other.items[start as usize..end as usize]);
        self.offsets.extend(other.offsets[lists.start + 1..=lists.end].iter().map(|o| n + (o - start)));
    }
}

impl<T: Copy + Send + Sync> Csr<T> {
    /// Adds lists of one length at the end.
    ///
    /// Panics past `u32::MAX` items in all.
    pub(crate) fn push_all<const N: usize>(&mut self, lists: &[[T; N]], threads: &Threads) {
        const MIN_PART: usize = 1 << 14;
        let (n, items) = (self.items.len(), lists.as_flattened());
        assert!(u32::try_from(n + items.len()).is_ok(), "fewer than 2^32 items");
        threads.append(&mut self.items, items.len(), MIN_PART, |i| items[i]);
        threads.append(&mut self.offsets, lists.len(), MIN_PART, |i| (n + (i + 1) * N) as u32);
    }
}

impl<T: Copy + Default> Csr<T> {
    /// Groups `(list, item)` pairs into `n_lists` lists; items keep the order in which `pairs` yields them.
    /// `pairs` is called twice.
    pub fn from_pairs<I>(n_lists: usize, pairs: impl Fn() -> I) -> Self
    where
        I: Iterator<Item = (usize, T)>,
    {
        let mut offsets = vec![0u32; n_lists + 1];
        for (list, _) in pairs() {
            offsets[list + 1] += 1;
        }
        for i in 0..n_lists {
            offsets[i + 1] += offsets[i];
        }
        let mut items = vec![T::default(); offsets[n_lists] as usize];
        let mut next = offsets.clone();
        for (list, item) in pairs() {
            items[next[list] as usize] = item;
            next[list] += 1;
        }
        Self { offsets, items }
    }
}

#[cfg(test)]
mod tests {
    use super::Csr;

    #[test]
    fn pairs_keep_their_order_within_a_list() {
        let pairs = [(2, 'a'), (0, 'b'), (2, 'c'), (0, 'd')];
        let lists = Csr::from_pairs(3, || pairs.iter().copied());
        assert_eq!(lists.list(0), ['b', 'd']);
        assert!(lists.list(1).is_empty());
        assert_eq!(lists.list(2), ['a', 'c']);
    }

    #[test]
    fn offsets_that_do_not_fit_are_refused() {
        assert!(Csr::new(vec![0, 2, 1], vec![1, 2]).is_none());
        assert!(Csr::new(vec![1, 2], vec![1, 2]).is_none());
        assert!(Csr::new(vec![0, 3], vec![1, 2]).is_none());
        assert!(Csr::<u8>::new(vec![], vec![]).is_none());
        assert!(Csr::new(vec![0, 1, 2], vec![1, 2]).is_some());
        assert!(serde_json::from_str::<Csr<u8>>(r#"{"offsets": [0, 3], "items": [1, 2]}"#).is_err());
        assert!(serde_json::from_str::<Csr<u8>>(r#"{"offsets": [0, 2], "items": [1, 2]}"#).is_ok());
    }
}
