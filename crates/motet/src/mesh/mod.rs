//! Floor 2: the exchange form. Plain arrays that hold everything a file holds.

mod cell_kind;
mod cells;
mod exchange;
mod field;
mod labels;

pub use cell_kind::CellKind;
pub use cells::Cells;
pub use exchange::{Mesh, bounds};
pub use field::{Field, Values};
pub use labels::{LabelNames, Labels};
