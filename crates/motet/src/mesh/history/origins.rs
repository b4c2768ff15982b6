//! Where each vertex, or each cell, of a new mesh came from.

use super::row::{Row, Rows, Signs};
use crate::base::{Error, Id, MaybeId, Result, absent};

/// Rows for quadratic fields that are longer than this are dropped when changes are joined, since each change
/// makes them longer.
const MAX_ROW_LENGTH: usize = 400;

/// For each entity of the new mesh, a vertex or a cell, the old entity that it is, or a row of old entities
/// with shares.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "Parts<I>"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "I: Id + serde::Serialize", deserialize = "I: Id + serde::Deserialize<'de>"))
)]
pub struct Origins<I: Id> {
    n_old: usize,
    /// The old id of each new entity that was kept; none if it changed.
    kept: Vec<MaybeId<I>>,
    /// A row for each new entity that changed, in their order.
    changed: Rows<I>,
    /// A further row, for quadratic fields, for some of the entities that changed.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Rows::is_empty"))]
    quadratic: Rows<I>,
}

/// Where one entity came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Origin<'a, I> {
    /// It is this old entity.
    Kept(I),
    /// It is new, or was moved.
    Changed(Row<'a, I>),
}

/// The stored parts of [`Origins`], not yet validated.
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(bound(deserialize = "I: Id + serde::Deserialize<'de>"))
)]
struct Parts<I> {
    n_old: usize,
    kept: Vec<MaybeId<I>>,
    changed: Rows<I>,
    #[cfg_attr(feature = "serde", serde(default))]
    quadratic: Rows<I>,
}

impl<I: Id> TryFrom<Parts<I>> for Origins<I> {
    type Error = Error;

    fn try_from(parts: Parts<I>) -> Result<Self> {
        Self::new(parts.n_old, parts.kept, parts.changed)?.with_quadratic(parts.quadratic)
    }
}

impl<I: Id> Origins<I> {
    /// Origins of new entities from `n_old` old ones. `kept` has the old id of each new entity, or
    /// none if it changed and `changed` has its row.
    ///
    /// # Errors
    /// If an old id does not exist, shares are not valid, or an entity has both an old id and a row, or
    /// neither.
    pub fn new(n_old: usize, kept: Vec<MaybeId<I>>, changed: Rows<I>) -> Result<Self> {
        changed.check(n_old, Signs::Positive)?;
        let known = kept.iter().enumerate().filter_map(|(new, old)| Some((new, old.get()?)));
        if let Some((new, old)) = known.clone().find(|(_, old)| old.place() >= n_old) {
            return Err(Error::input(format!("refers to the old id {old}, but there were only {n_old}"))
                .at(format!("origin of {new}")));
        }
        if absent(&kept) != changed.ids() {
            let n_without = kept.len() - known.count();
            return Err(Error::input(format!(
                "{n_without} entities without an old id need one row each, \
                 but there are {} rows, or rows for other ids",
                changed.len()
            )));
        }
        Ok(Self { n_old, kept, changed, quadratic: Rows::new() })
    }

    /// Origins as [`new`](Self::new) makes them, of which the caller knows that they are valid.
    pub(crate) fn trusted(n_old: usize, kept: Vec<MaybeId<I>>, changed: Rows<I>) -> Self {
        debug_assert!(Self::new(n_old, kept.clone(), changed.clone()).is_ok());
        Self { n_old, kept, changed, quadratic: Rows::new() }
    }

    /// Replaces the rows for quadratic fields, which only entities that changed may have.
    ///
    /// # Errors
    /// If an old id does not exist, shares do not sum to 1, or an entity with such a row has not changed.
    pub fn with_quadratic(self, rows: Rows<I>) -> Result<Self> {
        rows.check(self.n_old, Signs::Any)?;
        match rows.ids().iter().find(|id| self.changed.ids().binary_search(id).is_err()) {
            Some(id) => Err(Error::input("has a row for quadratic fields, but has not changed")
                .at(format!("origin of {id}"))),
            None => Ok(Self { quadratic: rows, ..self }),
        }
    }

    /// The origins of `n` entities that all were kept.
    ///
    /// Panics if `n` is more than ids can count.
    pub fn identity(n: usize) -> Self {
        Self {
            n_old: n,
            kept: (0..n).map(|id| I::of(id).into()).collect(),
            changed: Rows::new(),
            quadratic: Rows::new(),
        }
    }

    /// Number of entities in the old mesh.
    pub fn n_old(&self) -> usize {
        self.n_old
    }

    /// Number of entities in the new mesh.
    pub fn len(&self) -> usize {
        self.kept.len()
    }

    /// Whether the new mesh has no such entities.
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// For each new entity, the old one that it is, or none.
    pub fn kept(&self) -> &[MaybeId<I>] {
        &self.kept
    }

    /// The rows of the entities that changed.
    pub fn changed(&self) -> &Rows<I> {
        &self.changed
    }

    /// Longer rows for some of the entities that changed, exact for quadratic fields as well as linear ones.
    /// Their shares may be negative.
    pub fn quadratic(&self) -> &Rows<I> {
        &self.quadratic
    }

    /// Where `id` of the new mesh came from.
    ///
    /// Panics if there is no such entity.
    pub fn of(&self, id: I) -> Origin<'_, I> {
        match self.changed.of(id) {
            Some(row) => Origin::Changed(row),
            None => Origin::Kept(self.kept[id.place()].get().expect("kept where it has no row")),
        }
    }

    /// Where every entity came from, in the order of the new mesh.
    pub fn iter(&self) -> impl Iterator<Item = Origin<'_, I>> + '_ {
        self.from(0)
    }

    /// Where every entity from a place on came from.
    pub(super) fn from(&self, place: usize) -> impl Iterator<Item = Origin<'_, I>> + '_ {
        let mut rows = self.changed.from(I::of(place)).map(|(_, row)| row);
        self.kept[place..].iter().map(move |old| match old.get() {
            Some(old) => Origin::Kept(old),
            None => Origin::Changed(rows.next().expect("one row for each that changed")),
        })
    }

    /// For each new entity, the old one that it inherits from.
    pub fn main(&self) -> impl Iterator<Item = I> + '_ {
        self.iter().map(|origin| origin.main())
    }

    /// This change followed by a `later` one, as one.
    ///
    /// Panics if `later` does not start from as many entities as this one ends with.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        assert_eq!(later.n_old, self.len(), "the later change starts where this one ends");
        let mut kept = Vec::with_capacity(later.len());
        let (mut changed, mut quadratic) = (Rows::new(), Rows::new());
        let mut parts = Vec::new();
        for (id, origin) in later.iter().enumerate() {
            let direct = matches!(origin, Origin::Kept(_)).then(|| self.of(origin.main()));
            if let Some(Origin::Kept(old)) = direct {
                kept.push(old.into());
                continue;
            }
            let (id, main) = (I::of(id), self.of(origin.main()).main());
            kept.push(MaybeId::NONE);
            compose(&origin, |middle| self.of(middle), &mut parts);
            changed.push(id, &parts, main);
            let is_wide = |&middle: &I| self.quadratic.of(middle).is_some();
            let wide = later.of_quadratic(id);
            if wide != origin || wide.parts().0.iter().any(is_wide) {
                compose(&wide, |middle| self.of_quadratic(middle), &mut parts);
                if parts.len() <= MAX_ROW_LENGTH {
                    quadratic.push_signed(id, &parts, main);
                }
            }
        }
        Self { n_old: self.n_old, kept, changed, quadratic }
    }

    /// Where `id` came from, by its row for quadratic fields if it has one.
    fn of_quadratic(&self, id: I) -> Origin<'_, I> {
        self.quadratic.of(id).map_or_else(|| self.of(id), Origin::Changed)
    }
}

/// Puts into `parts` the parts of an origin, each replaced by the parts of its own origin; one entry for each
/// old entity, by rising id.
fn compose<'a, I: Id + 'a>(
    origin: &Origin<'_, I>,
    of: impl Fn(I) -> Origin<'a, I>,
    parts: &mut Vec<(I, f64)>,
) {
    parts.clear();
    let (from, shares) = origin.parts();
    for (&middle, &share) in from.iter().zip(shares) {
        let middle = of(middle);
        let (from, shares) = middle.parts();
        parts.extend(from.iter().zip(shares).map(|(&old, &part)| (old, share * part)));
    }
    merge_parts(parts);
}

impl<I: Id> Origin<'_, I> {
    /// The old entity whose ids, names and directions are inherited.
    pub fn main(&self) -> I {
        match self {
            Self::Kept(old) => *old,
            Self::Changed(row) => row.main,
        }
    }

    /// The old entities and their shares; for a kept entity the old one with share 1.
    pub fn parts(&self) -> (&[I], &[f64]) {
        match self {
            Self::Kept(old) => (std::slice::from_ref(old), &[1.0]),
            Self::Changed(row) => (row.from, row.shares),
        }
    }
}

/// Sorts the parts by id, and adds up the shares of equal ids.
pub(crate) fn merge_parts<I: Id>(parts: &mut Vec<(I, f64)>) {
    parts.sort_by_key(|p| p.0);
    parts.dedup_by(|later, first| {
        let same = later.0 == first.0;
        if same {
            first.1 += later.1;
        }
        same
    });
}
