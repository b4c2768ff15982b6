//! Surfaces that are hard to mesh: valid, closed, free of crossings, and different for every number.

pub(crate) mod body;
pub(crate) mod cut;
pub(crate) mod famous;
pub(crate) mod lattice;
pub(crate) mod polygons;
pub(crate) mod round;
pub(crate) mod together;

use motet::base::{Point, VertexId};

use super::Numbers;
use body::Body;

/// A surface to be meshed.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[VertexId; 3]>,
    /// The volume enclosed, with the orientation of the triangles (of nested surfaces every second one faces
    /// inward); for surfaces with membranes, the total.
    pub(crate) volume: Option<f64>,
    /// Whether bodies share triangles: an edge can then have an odd number of them.
    pub(crate) has_membranes: bool,
}

/// Case `i`, with 10 to some thousand triangles.
pub(crate) fn random_case(i: u64) -> Case {
    let mut numbers = Numbers(i.wrapping_mul(0x9e37_79b9).wrapping_add(77));
    let (kind, make) = KINDS[(i % KINDS.len() as u64) as usize];
    let mut body = make(&mut numbers);
    let changes = change(&mut body, &mut numbers);
    let Body { points, triangles, volume, has_membranes } = body;
    Case { name: format!("{i} {kind}{changes}"), points, triangles, volume, has_membranes }
}

type Kind = (&'static str, fn(&mut Numbers) -> Body);

const KINDS: [Kind; 23] = [
    ("schoenhardt", |n| famous::schoenhardt(famous::random_twist(n))),
    ("chazelle", |n| famous::chazelle(1 + n.below(8), 0.5f64.powi(1 + n.below(20) as i32))),
    ("comb", |n| polygons::comb(2 + n.below(60), 0.5f64.powi(1 + n.below(12) as i32), n)),
    ("spiral", |n| polygons::spiral(1 + n.below(5), 8 + n.below(24), 0.05 + 0.9 * n.unit(), n)),
    ("cocircular", |n| polygons::cocircular(0.1 + 0.9 * n.unit(), n)),
    ("star", |n| round::star(1 + n.below(3), 0.02 + 0.9 * n.unit(), n)),
    ("hull_sphere", |n| round::hull_of_sphere(8 + n.below(400), n)),
    ("hull_cube", |n| round::hull_of_cube(8 + n.below(300), n)),
    ("hull_lattice", |n| round::hull_of_lattice(8 + n.below(60), 2 + n.below(5), n)),
    ("voxels", |n| lattice::voxels(2 + n.below(6), 0.1 + 0.8 * n.unit(), false, n)),
    ("polycube", |n| lattice::voxels(2 + n.below(6), 0.1 + 0.8 * n.unit(), true, n)),
    ("cells", |n| lattice::cells([1, 2, 3].map(|k| 1 + n.below(5 - k)), n)),
    ("bumps", |n| lattice::bumps(1 + n.below(14), [0.0, 1e-12, 1e-9, 1e-3][n.below(4)], n)),
    ("cut_box", |n| cut::cut_box(20 + n.below(300), n)),
    ("cut_box_thin", |n| cut::cut_box_thin(20 + n.below(300), n)),
    ("nested", |n| together::nested([1 + n.below(10), 10 + n.below(150)][n.below(2)])),
    ("plates", |n| together::plates(1 + n.below(6), [1e-3, 1e-9, 1e-15][n.below(3)], n)),
    ("corners_shared", |n| together::tet_in_box(1 + n.below(3), n)),
    ("edges_shared", |n| together::boxes_in_touch(n)),
    ("knot", |n| round::knot(2 + n.below(3), 60 + n.below(100), 3 + n.below(6))),
    ("coil", |n| round::coil(1 + n.below(5), 10 + n.below(20), 3 + n.below(6))),
    ("star_in_star", |n| together::star_in_star(n)),
    ("wedges", |n| polygons::wedges(3 + n.below(200), 0.5f64.powi(n.below(30) as i32), n)),
];

/// Stretches, shrinks and moves a body by amounts that change no sign: powers of two, and shifts without
/// rounding. Returns a description.
fn change(body: &mut Body, numbers: &mut Numbers) -> String {
    let mut done = String::new();
    if numbers.below(4) == 0 {
        let (axis, by) = (numbers.below(3), [20, -20, 10, -10][numbers.below(4)]);
        body.scale(axis, 2f64.powi(by));
        done += &format!(", axis {axis} by 2^{by}");
    }
    if numbers.below(5) == 0 {
        let by = [40, -40, 20, -20][numbers.below(4)];
        (0..3).for_each(|axis| body.scale(axis, 2f64.powi(by)));
        done += &format!(", all by 2^{by}");
    }
    if numbers.below(4) == 0 && body.shift([1e6, -3e6, 2e6].map(|x| x * (1 + numbers.below(9)) as f64)) {
        done += ", moved";
    }
    for _ in 0..numbers.below(3) {
        body.turn();
    }
    done
}
