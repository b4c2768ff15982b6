//! A sphere inside a box: a common benchmark of mesh motion.
//!
//! ```text
//!   +-----------+     Six blocks between the faces of the box and the sphere; each
//!   | \ |   | / |     shell between them is the surface of a cube of n x n quads a
//!   |--/-----\--|     face, 6 n^2 + 2 vertices, bent from sphere to box.
//!   | |       | |
//!   |--\-----/--|
//!   | / |   | \ |
//!   +-----------+
//! ```

use crate::base::{MaybeId, Point, VertexId};
use crate::geometry::vector::{norm, scale};
use crate::mesh::shapes::labelled::labelled;
use crate::mesh::shapes::split::to_tets;
use crate::mesh::{CellKind, Cells, Mesh};

/// Half the edge of the box; the sphere has radius 1.
const HALF_EDGE: f64 = 5.0;

/// Shell `s` of `layers` cuts a ray of length R at `R^((s / layers)^GRADING)`. At 1, the cells along a ray
/// would all have the same shape; a little more makes those at the slanted walls flatter, where the worst
/// are. Of the values tried, 1 to 1.3, the worst EAS of the mesh of 32 k vertices is 0.187 at 1, 0.199 at
/// 1.1, 0.182 at 1.2.
const GRADING: f64 = 1.1;

/// The space between the sphere of radius 1 around the origin and the box
/// `[-5, 5]^3`: `layers + 1` shells of `6 n^2 + 2` vertices each, sphere first.
/// Region `fluid`; patches `sphere` and `box`.
///
/// The four mesh sizes of the paper that introduced this benchmark are about `(n, layers)` = (15, 7), (22,
/// 10), (30, 13), (38, 17).
///
/// Panics unless `n` and `layers` are at least 1.
pub fn sphere_in_box(n: usize, layers: usize) -> Mesh {
    assert!(n > 0 && layers > 0, "a mesh has cells");
    let shell = Shell::new(n);
    let n_vertices = shell.directions.len();
    let rays: Vec<Point> = shell.directions.iter().map(|d| scale(*d, HALF_EDGE)).collect();
    let mut points = Vec::with_capacity(n_vertices * (layers + 1));
    for s in 0..=layers {
        let fraction = (s as f64 / layers as f64).powf(GRADING);
        points.extend(rays.iter().map(|ray| if s == layers { *ray } else { point_on_ray(*ray, fraction) }));
    }
    let cells = to_tets(&shell.extruded(layers));
    labelled(points, cells, "fluid", &["sphere", "box"], |facet| {
        usize::from(facet.iter().any(|v| v.index() >= n_vertices))
    })
}

/// The point at `|ray|^fraction` along a ray from the origin.
fn point_on_ray(ray: Point, fraction: f64) -> Point {
    let length = norm(ray);
    scale(ray, length.powf(fraction) / length)
}

/// The surface of a cube, with `n` x `n` quads per face.
pub(super) struct Shell {
    /// The position of each vertex on the cube `[-1, 1]^3`, with evenly divided angles; those farthest from
    /// the origin come first. Since the smallest id determines the diagonal, quads are cut towards the
    /// corners of the cube, which is the shorter way on the sphere, and quads along rays from the inner end
    /// of the longer ray to the outer end of the shorter one.
    pub(super) directions: Vec<Point>,
    /// The quads, facing outward.
    pub(super) quads: Vec<[VertexId; 4]>,
    /// The lattice indices of each vertex, 0 to n along each axis.
    pub(super) places: Vec<[usize; 3]>,
}

impl Shell {
    pub(super) fn new(n: usize) -> Self {
        let direction = |place: [usize; 3]| place.map(|i| even_angle(i, n));
        // In integers, so that mirror images are equally far, to the bit.
        let farness = |place: &[usize; 3]| -> usize {
            let mut squares: Vec<usize> = place.iter().map(|&i| (2 * i).abs_diff(n)).collect();
            squares.sort_unstable();
            // The largest is always n.
            squares[1] * squares[1] + squares[0] * squares[0]
        };
        let mut places: Vec<[usize; 3]> = super::boxes::lattice([n + 1; 3])
            .filter(|place| place.iter().any(|&i| i == 0 || i == n))
            .collect();
        places.sort_by_key(|place| (std::cmp::Reverse(farness(place)), *place));
        let index = |place: [usize; 3]| place[0] + (n + 1) * (place[1] + (n + 1) * place[2]);
        let mut ids = vec![MaybeId::NONE; (n + 1).pow(3)];
        for (i, place) in places.iter().enumerate() {
            ids[index(*place)] = VertexId::new(i).into();
        }
        let vertex = |place| ids[index(place)].get().expect("corners of quads lie on the shell");
        let quads = quads(n).map(|quad| quad.map(vertex)).collect();
        Self { directions: places.iter().map(|p| direction(*p)).collect(), quads, places }
    }

    /// Hexahedra between `layers + 1` copies of the shell, numbered one after the
    /// other, innermost first.
    pub(super) fn extruded(&self, layers: usize) -> Cells {
        let mut cells = Cells::new();
        for layer in 0..layers {
            for quad in &self.quads {
                let copy = |s: usize| quad.map(|v| VertexId::new(v.index() + s * self.directions.len()));
                cells.push(CellKind::HEXAHEDRON, copy(layer).into_iter().chain(copy(layer + 1)));
            }
        }
        cells
    }
}

/// The tangent at step `i` of `n` even steps from -45 to 45 degrees, exactly antisymmetric about the middle.
pub(super) fn even_angle(i: usize, n: usize) -> f64 {
    let step = 2.0 * i as f64 - n as f64;
    if step.abs() == n as f64 { step.signum() } else { (step / n as f64 * std::f64::consts::FRAC_PI_4).tan() }
}

/// The quads on the faces of a cube of `n` cells along each axis, by lattice indices, facing outward.
fn quads(n: usize) -> impl Iterator<Item = [[usize; 3]; 4]> {
    (0..6 * n * n).map(move |q| {
        let (side, s, t) = (q / (n * n), q / n % n, q % n);
        let axis = side / 2;
        let place = |ds: usize, dt: usize| {
            let mut place = [0; 3];
            place[axis] = if side % 2 == 0 { 0 } else { n };
            place[(axis + 1) % 3] = s + ds;
            place[(axis + 2) % 3] = t + dt;
            place
        };
        if side % 2 == 0 {
            [place(0, 0), place(0, 1), place(1, 1), place(1, 0)]
        } else {
            [place(0, 0), place(1, 0), place(1, 1), place(0, 1)]
        }
    })
}
