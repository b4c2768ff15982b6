//! What is measured, and what counts as a gap.

use serde::Serialize;

use crate::base::{Error, Result};

/// How contact is measured. Lengths are in units of the points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Options {
    /// Warn of gaps below this; no warnings by default.
    pub warn: Option<f64>,
    /// Whether each body is measured against itself as well (a flap that folds, loops of a coil). Off by
    /// default.
    pub own: bool,
    /// How far to search; larger gaps are infinite. No limit by default; with [`own`](Self::own) a limit
    /// saves time, since a surface that nowhere faces itself is searched to the end.
    pub within: f64,
    /// Whether a gap counts only where both surfaces face each other through free space, not through the
    /// thickness of a body. Off by default between bodies that share no vertex; always on within one body,
    /// and between bodies that share vertices.
    pub facing: bool,
    /// Within one body, and between bodies that share vertices: two places count as neighbours, not as a gap,
    /// if the path along the surface is shorter than this multiple of the straight distance. 3 by default: a
    /// fold counts once it is narrower than 37 degrees (in a wedge of angle `a`, the path along its sides is
    /// `cot(a / 2)` times as long as that across).
    pub fold: f64,
}

impl Options {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Names the first number that is negative or NaN.
    pub(crate) fn check(&self) -> Result<()> {
        let lengths = [
            ("the warning distance", self.warn),
            ("the reach", Some(self.within)),
            ("the fold", Some(self.fold)),
        ];
        for (what, length) in lengths {
            if let Some(length) = length.filter(|length| length.is_nan() || *length < 0.0) {
                return Err(Error::options(format!("{what} is {length}"))
                    .remedy("give a number that is not negative"));
            }
        }
        Ok(())
    }
}

impl Default for Options {
    fn default() -> Self {
        Self { warn: None, own: false, within: f64::INFINITY, facing: false, fold: 3.0 }
    }
}
