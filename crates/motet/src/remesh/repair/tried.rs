//! Which bad tets have been tried in vain since anything changed at their vertices: they would be tried in vain again.

use crate::base::{TetId, VertexId};
use crate::kernel::Complex;

/// A memory of what was tried, with a clock that each change moves on.
///
/// On a surface whose triangles make thousands of tets bad for good, rounds that change a few others cost next to nothing by it. What it overlooks: a
/// cavity may reach beyond the tets at the vertices.
#[derive(Debug)]
pub(super) struct Tried {
    /// What was asked for when it began: of what else is asked it knows nothing.
    target: f64,
    now: u32,
    /// When each tet was tried in vain; 0: never.
    in_vain: Vec<u32>,
    /// When a tet of each vertex was last changed; 0: never.
    changed: Vec<u32>,
}

impl Tried {
    /// A memory that begins now, of tets for which `target` is asked. It has to be told of all that changes from now on.
    pub(super) fn of(target: f64) -> Self {
        Self { target, now: 1, in_vain: Vec::new(), changed: Vec::new() }
    }

    /// A memory that keeps nothing.
    pub(super) fn nothing() -> Self {
        Self::of(f64::NAN)
    }

    /// Whether a tet was tried in vain, and nothing at its vertices has changed since.
    pub(super) fn knows(&self, complex: &Complex, tet: TetId, target: f64) -> bool {
        let Some(&tried) = self.in_vain.get(tet.index()) else { return false };
        let changed = |v: VertexId| self.changed.get(v.index()).copied().unwrap_or(0);
        target == self.target && tried > 0 && complex.vertices(tet).into_iter().all(|v| changed(v) < tried)
    }

    /// A tet has been tried in vain.
    pub(super) fn in_vain(&mut self, tet: TetId, target: f64) {
        if target == self.target {
            put(&mut self.in_vain, tet.index(), self.now);
        }
    }

    /// Tets have come.
    pub(super) fn came(&mut self, complex: &Complex, tets: &[TetId]) {
        for v in tets.iter().flat_map(|&t| complex.vertices(t)) {
            put(&mut self.changed, v.index(), self.now);
        }
        self.now += 1;
    }
}

fn put(times: &mut Vec<u32>, i: usize, now: u32) {
    if times.len() <= i {
        times.resize(i + 1, 0);
    }
    times[i] = now;
}
