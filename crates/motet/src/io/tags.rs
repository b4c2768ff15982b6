//! Maps the numbers that a file gives to points or cells to their indices in arrays.

use std::collections::HashMap;

use crate::base::{Error, Result, VertexId};
use crate::mesh::{CellKind, Cells};

/// The index of each number.
#[derive(Debug)]
pub(super) enum Tags {
    /// Index `i` has the number `first + i`, as in most files.
    Running { first: u64, n: usize },
    /// The index of number `first + i`, [`NO_PLACE`] if it is not used.
    Dense { first: u64, places: Vec<u32> },
    /// Numbers with wide gaps.
    Sparse(HashMap<u64, u32>),
}

const NO_PLACE: u32 = u32::MAX;
/// Maximum array size per number for the dense form.
const DENSE_LIMIT: usize = 8;

impl Tags {
    /// Maps the numbers of `what`, given in the order of their indices.
    ///
    /// Fails if a number occurs twice.
    pub(super) fn new(numbers: &[u64], what: &str) -> Result<Self> {
        let first = numbers.iter().copied().min().unwrap_or(0);
        if numbers.iter().zip(0..).all(|(&number, place)| number - first == place) {
            return Ok(Self::Running { first, n: numbers.len() });
        }
        let span = numbers.iter().copied().max().map_or(0, |last| last - first);
        let twice = |number: u64| {
            Error::input(format!("{what} {number} occurs twice")).remedy("give each its own number")
        };
        if span < (DENSE_LIMIT * numbers.len()) as u64 {
            let mut places = vec![NO_PLACE; span as usize + 1];
            for (place, &number) in (0u32..).zip(numbers) {
                let slot = &mut places[(number - first) as usize];
                if std::mem::replace(slot, place) != NO_PLACE {
                    return Err(twice(number));
                }
            }
            return Ok(Self::Dense { first, places });
        }
        let mut places = HashMap::with_capacity(numbers.len());
        for (place, &number) in (0u32..).zip(numbers) {
            if places.insert(number, place).is_some() {
                return Err(twice(number));
            }
        }
        Ok(Self::Sparse(places))
    }

    /// The index of `number`, if it is used.
    #[inline]
    pub(super) fn place(&self, number: u64) -> Option<u32> {
        match self {
            Self::Running { first, n } => {
                number.checked_sub(*first).filter(|&i| i < *n as u64).map(|i| i as u32)
            }
            Self::Dense { first, places } => {
                let place = *places.get(usize::try_from(number.checked_sub(*first)?).ok()?)?;
                (place != NO_PLACE).then_some(place)
            }
            Self::Sparse(places) => places.get(&number).copied(),
        }
    }
}

/// Appends elements as cells: each with its number and kind, and the numbers of its nodes one after the other
/// in `nodes`, of which `vertex` is the vertex.
///
/// # Errors
/// If a node does not exist.
pub(super) fn push_elements(
    cells: &mut Cells,
    elements: impl Iterator<Item = (u64, CellKind)>,
    nodes: &[u64],
    vertex: impl Fn(u64) -> Option<u32>,
) -> Result<()> {
    let mut rest = nodes;
    for (element, kind) in elements {
        let (own, tail) = rest.split_at(kind.n_vertices().unwrap_or(0));
        rest = tail;
        let vertex = |&node: &u64| {
            vertex(node).map(VertexId).ok_or_else(|| {
                Error::input(format!("element {element} refers to node {node}, which does not exist"))
                    .remedy("the file is truncated or damaged: write it again")
            })
        };
        cells.push(kind, own.iter().map(vertex).collect::<Result<Vec<_>>>()?);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_u64_is_a_valid_number() {
        let tags = Tags::new(&[u64::MAX], "node").unwrap();
        assert_eq!((tags.place(u64::MAX), tags.place(0)), (Some(0), None));
        assert!(Tags::new(&[u64::MAX, u64::MAX], "node").is_err());
        assert_eq!(Tags::new(&[u64::MAX, 3], "node").unwrap().place(3), Some(1));
    }

    #[test]
    fn every_number_maps_to_its_index_and_others_to_none() {
        for numbers in [vec![5, 6, 7], vec![9, 1, 4], vec![1 << 60, 3, 77], vec![u64::MAX, 0], vec![]] {
            let tags = Tags::new(&numbers, "node").unwrap();
            for (place, number) in numbers.iter().enumerate() {
                assert_eq!(tags.place(*number), Some(place as u32), "{tags:?}");
            }
            for other in [0, 2, 8, 1 << 59, u64::MAX].into_iter().filter(|n| !numbers.contains(n)) {
                assert_eq!(tags.place(other), None, "{tags:?}");
            }
        }
    }

    #[test]
    fn a_duplicate_number_is_reported() {
        for numbers in [vec![1, 2, 2], vec![1, 1 << 40, 1]] {
            let error = Tags::new(&numbers, "node").unwrap_err().to_string();
            assert!(error.contains("occurs twice"), "{error}");
        }
    }
}
