//! Quadratic cells judged by their Jacobian: compared with dense sampling of its definition, and with maps of
//! known derivative.

use crate::common::random::Random;
use motet::base::Point;
use motet::geometry::vector::{add, cross, distance, dot, scale, sub};
use motet::mesh::check::{DefectKind, check};
use motet::mesh::curved::{CurvedCells, Jacobian, is_curved_kind, is_upright, middles};
use motet::mesh::{CellKind, Cells, Mesh, Summary, shapes};

const TET_CORNERS: [Point; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

fn determinant([a, b, c]: [Point; 3]) -> f64 {
    dot(cross(a, b), c)
}

/// Barycentric coordinates of a grid of places in the tetrahedron.
fn places_in_a_tet(n: usize) -> Vec<[f64; 4]> {
    let all = (0..=n).flat_map(|i| (0..=n - i).flat_map(move |j| (0..=n - i - j).map(move |k| [i, j, k])));
    all.map(|[i, j, k]| [n - i - j - k, i, j, k].map(|x| x as f64 / n as f64)).collect()
}

/// `det J` of a quadratic tet by definition: sums of nodes times derivatives of `L (2 L - 1)` and `4 L L'`.
fn of_tet(nodes: &[Point], l: [f64; 4]) -> f64 {
    let by = |k: usize| {
        let corner = (0..4).map(|i| (nodes[i], if i == k { 4.0 * l[i] - 1.0 } else { 0.0 }));
        let middle = TET_EDGES.iter().enumerate().map(|(m, &[a, b])| {
            let other = if a == k {
                l[b]
            } else if b == k {
                l[a]
            } else {
                0.0
            };
            (nodes[4 + m], 4.0 * other)
        });
        corner.chain(middle).fold([0.0; 3], |sum, (p, w)| add(sum, scale(p, w)))
    };
    determinant([1, 2, 3].map(|k| sub(by(k), by(0))))
}

/// A tet whose nodes are displaced by up to `most`.
fn shaken_tet(random: &mut Random, most: f64) -> Vec<Point> {
    let middle = |&[a, b]: &[usize; 2]| scale(add(TET_CORNERS[a], TET_CORNERS[b]), 0.5);
    let nodes = TET_CORNERS.into_iter().chain(TET_EDGES.iter().map(middle));
    nodes.map(|p| p.map(|x| x + most * (2.0 * random.next() - 1.0))).collect()
}

#[test]
fn random_quadratic_tets_are_upright_where_no_sample_of_their_jacobian_is_negative() {
    let mut random = Random(7);
    let (mut n_upright, mut n_folded, mut n_folded_between_nodes) = (0, 0, 0);
    for i in 0..400 {
        let nodes = shaken_tet(&mut random, 0.1 + 0.15 * f64::from(i % 3));
        let samples: Vec<f64> = places_in_a_tet(20).into_iter().map(|l| of_tet(&nodes, l)).collect();
        let [low, high] = [f64::min, f64::max].map(|f| samples.iter().copied().reduce(f).unwrap());
        let jacobian = Jacobian::of(CellKind::QUADRATIC_TETRA, &nodes).unwrap();
        let found = jacobian.least().determinant;
        // The least value is attained, and no sample is below it.
        assert!(found <= low + 1e-5 * (high - low), "{found} {low}");
        assert!(found >= low - 0.05 * (high - low), "{found} {low}");
        if is_upright(CellKind::QUADRATIC_TETRA, &nodes, false) {
            n_upright += 1;
            assert!(low > 0.0 && found > 0.0);
        } else {
            n_folded += 1;
            assert!(found <= 1e-5 * high.max(-low));
            let at_nodes = places_in_a_tet(2).into_iter().map(|l| of_tet(&nodes, l));
            n_folded_between_nodes += usize::from(at_nodes.reduce(f64::min).unwrap() > 0.0);
        }
        let mirrored: Vec<Point> = nodes.iter().map(|p| [-p[0], p[1], p[2]]).collect();
        let upright = |nodes: &[Point], reversed| is_upright(CellKind::QUADRATIC_TETRA, nodes, reversed);
        assert_eq!(upright(&nodes, false), upright(&mirrored, true));
    }
    assert!(
        n_upright > 50 && n_folded > 50 && n_folded_between_nodes > 0,
        "{n_upright} {n_folded_between_nodes}"
    );
}

/// The nodes of a straight cell of a kind: corners of the usual reference cell, and the other nodes between
/// them.
fn reference(kind: CellKind) -> Vec<Point> {
    let middles = middles(kind);
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut nodes: Vec<Point> = match middles[0].node {
        4 => TET_CORNERS.to_vec(),
        5 => square.iter().map(|[x, y]| [*x, *y, 0.0]).chain([[0.5, 0.5, 1.0]]).collect(),
        6 => [0.0, 1.0].iter().flat_map(|z| [0, 1, 3].map(|i| [square[i][0], square[i][1], *z])).collect(),
        _ => [0.0, 1.0].iter().flat_map(|z| square.map(|[x, y]| [x, y, *z])).collect(),
    };
    for middle in middles {
        let sum = middle.corners.iter().fold([0.0; 3], |sum, &c| add(sum, nodes[c]));
        nodes.push(scale(sum, 1.0 / middle.corners.len() as f64));
    }
    nodes
}

/// Whether a place is in the reference cell of a kind.
fn is_inside(n_corners: usize, [x, y, z]: Point) -> bool {
    match n_corners {
        4 => x + y + z <= 1.0,
        5 => (x - 0.5).abs() <= 0.5 * (1.0 - z) && (y - 0.5).abs() <= 0.5 * (1.0 - z),
        6 => x + y <= 1.0,
        _ => true,
    }
}

/// A quadratic map: for each coordinate its coefficients of 1, x, y, z, xx, yy, xy, yz, zx, zz.
struct QuadraticMap([[f64; 10]; 3]);

impl QuadraticMap {
    fn random(random: &mut Random, bend: f64, has_squares_of_z: bool) -> Self {
        let mut map = [[0.0; 10]; 3];
        for (i, row) in map.iter_mut().enumerate() {
            row[1..4].iter_mut().for_each(|x| *x = 0.4 * (random.next() - 0.5));
            row[4..].iter_mut().for_each(|x| *x = bend * (random.next() - 0.5));
            row[1 + i] += 1.0;
            row[9] *= f64::from(u8::from(has_squares_of_z));
        }
        Self(map)
    }

    fn apply(&self, [x, y, z]: Point) -> Point {
        let terms = [1.0, x, y, z, x * x, y * y, x * y, y * z, z * x, z * z];
        self.0.map(|row| row.iter().zip(terms).map(|(a, b)| a * b).sum())
    }

    /// The determinant of the map's derivative.
    fn determinant(&self, [x, y, z]: Point) -> f64 {
        determinant(self.0.map(|[_, a, b, c, xx, yy, xy, yz, zx, zz]| {
            [
                a + 2.0 * xx * x + xy * y + zx * z,
                b + 2.0 * yy * y + xy * x + yz * z,
                c + 2.0 * zz * z + yz * y + zx * x,
            ]
        }))
    }
}

/// The shape functions of every kind include all quadratic polynomials: a cell whose nodes are moved by a
/// quadratic map is the image under that map.
#[test]
fn cells_of_every_kind_under_a_quadratic_map_have_its_jacobian() {
    let mut random = Random(11);
    let mut n_folded = 0;
    for &kind in CellKind::NAMED.iter().filter(|kind| is_curved_kind(**kind)) {
        let straight = reference(kind);
        let n_corners = middles(kind)[0].node;
        for i in 0..30 {
            let has_squares_of_z = kind != CellKind::QUADRATIC_LINEAR_WEDGE;
            let map = QuadraticMap::random(&mut random, [0.4, 1.0, 2.5][i % 3], has_squares_of_z);
            let nodes: Vec<Point> = straight.iter().map(|&p| map.apply(p)).collect();
            let found = Jacobian::of(kind, &nodes).unwrap().least();
            let n = 12;
            let grid = (0..(n + 1) * (n + 1) * (n + 1))
                .map(|i| [i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)])
                .map(|p| p.map(|x| x as f64 / n as f64))
                .filter(|p| is_inside(n_corners, *p));
            let samples: Vec<(f64, Point)> = grid.map(|p| (map.determinant(p), map.apply(p))).collect();
            let low = samples.iter().map(|s| s.0).fold(f64::INFINITY, f64::min);
            let high = samples.iter().map(|s| s.0.abs()).fold(0.0, f64::max);
            assert!(found.determinant <= low + 1e-5 * high, "{kind:?} {found:?} {low}");
            assert!(found.determinant >= low - 0.1 * high, "{kind:?} {found:?} {low}");
            // Where the map folds, several places of the cell coincide in space: one of them has that
            // determinant.
            let extent = samples.iter().map(|s| distance(s.1, samples[0].1)).fold(0.0, f64::max);
            let is_there = |s: &(f64, Point)| {
                distance(s.1, found.place) < 0.2 * extent && (s.0 - found.determinant).abs() < 0.1 * high
            };
            assert!(samples.iter().any(is_there), "{kind:?} {found:?}");
            let is_folded = !is_upright(kind, &nodes, false);
            n_folded += usize::from(is_folded);
            assert!(
                if is_folded { found.determinant <= 1e-5 * high } else { low > 0.0 },
                "{kind:?} {found:?}"
            );
        }
    }
    assert!(n_folded > 20, "{n_folded}");
}

#[test]
fn the_scaled_jacobian_does_not_change_with_place_size_and_turn() {
    let mut random = Random(3);
    let (sin, cos) = 0.7f64.sin_cos();
    for &kind in CellKind::NAMED.iter().filter(|kind| is_curved_kind(**kind)) {
        let nodes: Vec<Point> =
            reference(kind).into_iter().map(|p| p.map(|x| x + 0.08 * (random.next() - 0.5))).collect();
        let first = Jacobian::of(kind, &nodes).unwrap().least().scaled;
        for (size, shift) in [(1.0, 1e3), (1e-3, 0.0), (1e3, -1e3)] {
            let moved: Vec<Point> = (nodes.iter())
                .map(|[x, y, z]| [cos * x - sin * y, *z, -(sin * x + cos * y)].map(|x| size * x + shift))
                .collect();
            let now = Jacobian::of(kind, &moved).unwrap().least().scaled;
            assert!((now - first).abs() < 1e-5, "{kind:?} {size} {shift}: {now} {first}");
            let single: Vec<Point> = moved.iter().map(|p| p.map(|x| f64::from(x as f32))).collect();
            let now = Jacobian::of(kind, &single).unwrap().least().scaled;
            assert!((now - first).abs() < 5e-2, "{kind:?} {size} {shift}: {now} {first}");
        }
    }
}

#[test]
fn straight_tets_have_one_and_flat_ones_are_flat() {
    for (mesh, n) in [(shapes::quadratic(&shapes::ball(2, 1)), 0), (flat_tet(), 1)] {
        let summary = Summary::of(&mesh);
        let flat = summary.defects.iter().filter(|d| d.kind == DefectKind::FlatCell).map(|d| d.count);
        assert_eq!(flat.sum::<usize>(), n);
        let least = summary.curved.unwrap().min_scaled_jacobian;
        assert!(if n == 0 { (least - 1.0).abs() < 1e-10 } else { least == 0.0 }, "{least}");
    }
    assert!(Summary::of(&shapes::ball(2, 1)).curved.is_none());
}

fn flat_tet() -> Mesh {
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, (0..4).map(motet::base::VertexId));
    shapes::quadratic(&Mesh::new(points, cells))
}

/// A mesh of straight quadratic tets, one of whose inner mid-edge nodes is moved so far that the cells around
/// it fold, though their corners stay.
#[test]
fn a_cell_that_is_folded_between_its_corners_is_a_defect() {
    let mut mesh = shapes::quadratic(&shapes::box_grid([2; 3], [[0.0; 3], [2.0; 3]]));
    assert!(check(&mesh).is_empty());
    let on_boundary = motet::mesh::Boundary::of(&mesh.cells).vertices;
    let is_inner = |v: usize| on_boundary.binary_search(&motet::base::VertexId::new(v)).is_err();
    let pushed = (27..mesh.points.len()).find(|&v| is_inner(v)).unwrap();
    mesh.points[pushed][0] += 0.45;
    let around: Vec<_> = (mesh.cells.iter())
        .filter(|(_, _, nodes)| nodes.iter().any(|v| v.index() == pushed))
        .map(|(cell, ..)| cell)
        .collect();
    let places = |cell| mesh.cells.vertices(cell).iter().map(|v| mesh.points[v.index()]).collect::<Vec<_>>();
    let is_folded = |cell| places_in_a_tet(12).into_iter().any(|l| of_tet(&places(cell), l) <= 0.0);
    let expected: Vec<_> = around.into_iter().filter(|&cell| is_folded(cell)).collect();
    assert!(!expected.is_empty());
    let defects = check(&mesh);
    let folded = defects.iter().find(|d| d.kind == DefectKind::FoldedCell).unwrap();
    assert_eq!((defects.len(), folded.count), (1, expected.len()));
    assert_eq!(folded.examples[0].cells, [expected[0]]);
    let at = folded.examples[0].at.unwrap();
    assert!(distance(at, mesh.points[pushed]) < 1.0);
    let summary = Summary::of(&mesh);
    let curved = summary.curved.unwrap();
    assert_eq!((summary.inverted, curved.cells), (expected.len(), 48));
    assert!(curved.min_scaled_jacobian < 0.0 && expected.contains(&curved.worst_cell));
}

#[test]
fn cells_numbered_the_other_way_round_are_upright_among_their_like() {
    let mut mesh = shapes::quadratic(&shapes::ball(2, 1));
    mesh.points.iter_mut().for_each(|p| p[0] = -p[0]);
    let curved = CurvedCells::of(&mesh.cells, &mesh.points);
    assert!((0..curved.len()).all(|i| curved.is_upright(i, &mesh.points)));
}
