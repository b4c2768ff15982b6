//! Where each vertex and each cell of a changed mesh came from; carries any field across the change.
//!
//! A [`History`] is data: it can be stored, sent, and applied later to any number of fields and time levels. Most of a
//! mesh is *kept*, and values go over bit for bit. What changed has a row of old things with shares that sum to 1:
//!
//! | of the new mesh | its row |
//! |---|---|
//! | a vertex that is new or moved | the vertices of the old tet that held its place, with their weights there; off walls also a row of the vertices around that is exact for quadratic fields |
//! | a tet that is new | the old tets it overlaps, with their parts of its volume |
//! | any other cell that is new | the one cell it inherits from |
//!
//! What becomes of a value is its [`Rule`]: interpolated, conserved, inherited or dropped. [`field_ledger`] tells how well that went.

mod carry;
mod fields;
mod ledger;
mod numbers;
mod origins;
mod row;
mod rule;

pub use fields::{FieldIntegral, FieldLedger, On, field_ledger};
pub use ledger::{Ledger, RegionLedger};
pub(crate) use numbers::numbers_cells;
pub use numbers::{REFINE_ROOT, number_anew};
pub(crate) use origins::merge;
pub use origins::{Origin, Origins};
pub use row::{Row, Rows};
pub use rule::{Carry, Rule, Rules};

use serde::{Deserialize, Serialize};

use crate::base::{CellId, VertexId};

/// What a change did to a mesh, in arrays: where everything came from, and how well volumes fit.
///
/// ```
/// use motet::base::{CellId, VertexId};
/// use motet::mesh::Field;
/// use motet::mesh::history::{History, Ledger, Origins, Rows};
/// # fn main() -> motet::Result<()> {
/// // Three vertices; the new mesh has the last two, and one halfway between the first two.
/// let mut halfway = Rows::new();
/// halfway.push(VertexId(2), &[(VertexId(0), 0.5), (VertexId(1), 0.5)], VertexId(0));
/// let kept = vec![VertexId(1), VertexId(2), motet::base::Id::NONE];
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Where each vertex of the new mesh came from.
    pub vertices: Origins<VertexId>,
    /// Where each cell of the new mesh came from, of any kind.
    pub cells: Origins<CellId>,
    /// How well the volumes of old and new tets fit.
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

    /// This change and then a `later` one, as one: from this one's old mesh to the later one's new mesh. Transferring by it
    /// gives what two transfers give, up to rounding and where [`Rule::Interpolate`] limits a value; inherited values go the same way exactly.
    ///
    /// Panics when `later` does not start from as many vertices and cells as this one ends with.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        Self {
            vertices: self.vertices.then(&later.vertices),
            cells: self.cells.then(&later.cells),
            ledger: self.ledger.then(&later.ledger),
        }
    }
}
