//! A uniformly divided box.

use crate::base::{Point, VertexId};
use crate::mesh::shapes::labelled::labelled;
use crate::mesh::shapes::split::to_tets;
use crate::mesh::{CellKind, Cells, Mesh};

/// The box between two corners, with `n` cells along each axis and six tets per cell (Kuhn's, all around one
/// diagonal). Region `box`; patches `xmin`, `xmax`, `ymin`, `ymax`, `zmin`, `zmax`.
///
/// Panics unless `n` is at least 1 and `low < high` along each axis.
pub fn box_grid(n: [usize; 3], [low, high]: [Point; 2]) -> Mesh {
    assert!((0..3).all(|k| n[k] > 0 && low[k] < high[k]), "a box has cells, and a size");
    let points = lattice_points(n, |k, i| low[k] + (high[k] - low[k]) * (i as f64 / n[k] as f64));
    let sides = points.clone();
    let side_of = move |facet: &[VertexId]| {
        let on = |k: usize, x: f64| facet.iter().all(|v| sides[v.index()][k] == x);
        (0..6).find(|&s| on(s / 2, if s % 2 == 0 { low[s / 2] } else { high[s / 2] })).unwrap_or(0)
    };
    labelled(
        points,
        to_tets(&lattice_cells(n)),
        "box",
        &["xmin", "xmax", "ymin", "ymax", "zmin", "zmax"],
        side_of,
    )
}

/// The points of a lattice, x fastest; `at(k, i)` is the coordinate of index `i` along axis `k`.
pub(super) fn lattice_points(n: [usize; 3], at: impl Fn(usize, usize) -> f64) -> Vec<Point> {
    lattice([n[0] + 1, n[1] + 1, n[2] + 1]).map(|ijk| [0, 1, 2].map(|k| at(k, ijk[k]))).collect()
}

/// The indices of all points of a lattice of `n` points along each axis, x fastest.
pub(super) fn lattice(n: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..n[0] * n[1] * n[2]).map(move |i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])])
}

/// The vertices of the cell at `ijk` of a lattice of `n` cells along each axis, as a hexahedron.
pub(super) fn lattice_cell(n: [usize; 3], ijk: [usize; 3]) -> [VertexId; 8] {
    HEXAHEDRON.map(|d| {
        let [i, j, k] = [0, 1, 2].map(|axis| ijk[axis] + d[axis]);
        VertexId::new(i + (n[0] + 1) * (j + (n[1] + 1) * k))
    })
}

/// The hexahedra of a lattice.
pub(super) fn lattice_cells(n: [usize; 3]) -> Cells {
    let mut cells = Cells::new();
    lattice(n).for_each(|ijk| cells.push(CellKind::HEXAHEDRON, lattice_cell(n, ijk)));
    cells
}

/// The corners of a hexahedron in VTK's order.
const HEXAHEDRON: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
