//! Prisms as a CAD program writes them: two triangles a side, fans at the ends.

use motet::base::{Point, VertexId};
use motet::mesh::{CellKind, Cells, Mesh};

/// The surface of a prism of `n` sides with its corners on a circle.
pub(crate) fn prism(n: usize, radius: f64, height: f64) -> Mesh {
    let corner = |i: usize, z: f64| -> Point {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        [radius * angle.cos(), radius * angle.sin(), z]
    };
    let points = [0.0, height].into_iter().flat_map(|z| (0..n).map(move |i| corner(i, z))).collect();
    let mut ids = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        ids.extend([i, j, n + j, i, n + j, n + i]);
    }
    for i in 1..n - 1 {
        ids.extend([0, i + 1, i, n, n + i, n + i + 1]);
    }
    let ids = ids.into_iter().map(VertexId::new).collect();
    Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, ids).unwrap())
}

/// The mesh with transformed points.
pub(crate) fn moved(mesh: &Mesh, to: impl Fn(Point) -> Point) -> Mesh {
    Mesh::new(mesh.points.iter().map(|p| to(*p)).collect(), mesh.cells.clone())
}

/// The mesh rotated by odd angles about two axes.
pub(crate) fn turned(mesh: &Mesh) -> Mesh {
    let [(s, c), (t, d)] = [0.7f64, 1.1].map(f64::sin_cos);
    moved(mesh, |[x, y, z]| {
        let [x, y] = [c * x - s * y, s * x + c * y];
        [x, d * y - t * z, t * y + d * z]
    })
}
