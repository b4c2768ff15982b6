//! A ball.

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, norm, scale};
use crate::mesh::shapes::boxes::lattice;
use crate::mesh::shapes::cubed_sphere::{Shell, even_angle};
use crate::mesh::shapes::labelled::labelled;
use crate::mesh::shapes::split::to_tets;
use crate::mesh::{CellKind, Cells, Mesh};

/// Half the diagonal of the core, as a fraction of the radius.
const CORE: f64 = 0.5;

/// Roundness of the core: 0 is a cube, 1 a ball (on which the edges of the cube would be flat).
const ROUNDNESS: f64 = 0.5;

/// The ball of radius 1 around the origin: a core of `n^3` cells and `layers` shells around it, with six tets
/// per cell. Region `ball`; patch `sphere`.
///
/// Panics unless `n` and `layers` are at least 1.
pub fn ball(n: usize, layers: usize) -> Mesh {
    assert!(n > 0 && layers > 0, "a mesh has cells");
    let shell = Shell::new(n);
    let on_core = |cube: Point| {
        let largest = cube.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let length = norm(cube);
        let round = if length > 0.0 { scale(cube, largest / length) } else { cube };
        scale(add(scale(cube, (1.0 - ROUNDNESS) / 3f64.sqrt()), scale(round, ROUNDNESS)), CORE)
    };
    let mut points: Vec<Point> = Vec::new();
    for s in 0..=layers {
        let outward = s as f64 / layers as f64;
        points.extend(shell.directions.iter().map(|d| {
            let sphere = scale(*d, 1.0 / norm(*d));
            add(scale(on_core(*d), 1.0 - outward), scale(sphere, outward))
        }));
    }
    let mut cells = shell.extruded(layers);
    let core_ids = core_vertices(n, &shell, &mut points, on_core);
    push_core(n, &core_ids, &mut cells);
    labelled(points, to_tets(&cells), "ball", &["sphere"], |_| 0)
}

/// The vertices of the core by lattice index: those of the innermost shell, and new ones inside.
fn core_vertices(
    n: usize,
    shell: &Shell,
    points: &mut Vec<Point>,
    on_core: impl Fn(Point) -> Point,
) -> Vec<VertexId> {
    let mut ids = vec![None; (n + 1).pow(3)];
    for (v, place) in shell.places.iter().enumerate() {
        ids[index(n, *place)] = Some(VertexId::new(v));
    }
    lattice([n + 1; 3])
        .map(|place| {
            ids[index(n, place)].unwrap_or_else(|| {
                points.push(on_core(place.map(|i| even_angle(i, n))));
                VertexId::new(points.len() - 1)
            })
        })
        .collect()
}

fn index(n: usize, [i, j, k]: [usize; 3]) -> usize {
    i + (n + 1) * (j + (n + 1) * k)
}

fn push_core(n: usize, ids: &[VertexId], cells: &mut Cells) {
    for place in lattice([n; 3]) {
        let hexahedron = super::boxes::lattice_cell([n; 3], place);
        cells.push(CellKind::HEXAHEDRON, hexahedron.map(|v| ids[v.index()]));
    }
}
