//! Where each vertex and each cell of a changed mesh came from; transfers fields across the change.
//!
//! A [`History`] is data: it can be stored, sent, and applied later to any number of fields and time levels.
//! Most of a mesh is *kept*, and its values are copied bit for bit. Whatever changed has a row of old
//! entities (vertices or cells) with shares that sum to 1:
//!
//! | in the new mesh | its row |
//! |---|---|
//! | a new or moved vertex | the vertices of the old tet at its place, with their weights there; away from walls also a row of the vertices around that is exact for quadratic fields |
//! | a new tet | the old tets that it overlaps, each with its fraction of the new tet's volume |
//! | any other new cell | the one cell that it inherits from |
//!
//! A [`Rule`] determines how values are transferred: interpolated, conserved, inherited or dropped.
//! [`field_ledger`] reports how well that went. Calls that change a mesh return a [`Changed`]: the mesh, its
//! history, and their report.

mod carry;
mod changed;
mod fields;
mod ledger;
mod numbers;
mod origins;
mod row;
mod rule;

pub use changed::Changed;
pub use fields::{FieldIntegral, FieldLedger, On, field_ledger};
pub use ledger::{Ledger, RegionLedger};
pub(crate) use numbers::numbers_cells;
pub use numbers::{REFINE_ROOT, number_anew};
pub(crate) use origins::merge_parts;
pub use origins::{Origin, Origins};
pub use row::{Row, Rows};
pub use rule::{Carry, Rule, Rules};

use crate::base::{CellId, VertexId};

/// What a change did to a mesh, in arrays: where everything came from, and how well volumes match.
///
/// ```
/// use motet::base::{MaybeId, VertexId};
/// use motet::mesh::Field;
/// use motet::mesh::history::{History, Ledger, Origins, Rows};
/// # fn main() -> motet::Result<()> {
/// // Three vertices; the new mesh has the last two, and one halfway between the first two.
/// let mut halfway = Rows::new();
/// halfway.push(VertexId(2), &[(VertexId(0), 0.5), (VertexId(1), 0.5)], VertexId(0));
/// let kept = vec![VertexId(1).into(), VertexId(2).into(), MaybeId::NONE];
/// let history = History {
///     vertices: Origins::new(3, kept, halfway)?,
///     cells: Origins::identity(0),
///     ledger: Ledger::default(),
/// };
/// let new = history.transfer_points(&Field::scalars("pressure", vec![1.0, 2.0, 4.0]))?;
/// assert_eq!(new.values, vec![2.0, 4.0, 1.5].into());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct History {
    /// Where each vertex of the new mesh came from.
    pub vertices: Origins<VertexId>,
    /// Where each cell of the new mesh came from, of any kind.
    pub cells: Origins<CellId>,
    /// How well the volumes of old and new tets match.
    pub ledger: Ledger,
}

impl History {
    /// The history of a mesh that did not change.
    pub fn identity(n_points: usize, n_cells: usize) -> Self {
        Self {
            vertices: Origins::identity(n_points),
            cells: Origins::identity(n_cells),
            ledger: Ledger::default(),
        }
    }

    /// This change followed by a `later` one, as one: from the old mesh of this change to the new mesh of the
    /// later one. A transfer by it gives what the two transfers give, up to rounding and except where
    /// [`Rule::Interpolate`] limits a value; inherited values are exactly the same.
    ///
    /// Panics if `later` does not start from as many vertices and cells as this one ends with.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        Self {
            vertices: self.vertices.then(&later.vertices),
            cells: self.cells.then(&later.cells),
            ledger: self.ledger.then(&later.ledger),
        }
    }
}
