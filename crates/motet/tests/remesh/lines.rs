//! Line cells in remeshing: they are divided and merged with their edges, and never lost; cells of other
//! kinds hold their edges, without affecting nearby repair.

use std::collections::{BTreeMap, BTreeSet};

use motet::base::{CellId, Threads, VertexId};
use motet::geometry::vector::distance;
use motet::mesh::check::check;
use motet::mesh::history::{Changed, Rules};
use motet::mesh::shapes::{box_grid, mixed};
use motet::mesh::{CellKind, Field, Mesh, Values};
use motet::remesh::{Options, Report, Sizes, SurfaceRule, remesh_mesh};

fn options(size: f64) -> Options {
    Options {
        sizes: Some(Sizes::Uniform(size)),
        surface: SurfaceRule::Adapt { distance: None },
        ..Options::default()
    }
}

fn remeshed(mesh: &Mesh, options: &Options) -> Changed<Report> {
    let outcome = remesh_mesh(mesh, options, &Rules::default(), &Threads::single()).unwrap();
    assert!(check(&outcome.mesh).is_empty(), "{:?}", check(&outcome.mesh));
    outcome
}

/// Adds lines between points at given places, each with the number of its curve and a real-valued weight.
fn with_lines(mut mesh: Mesh, lines: &[([[f64; 3]; 2], i32)]) -> Mesh {
    let n = mesh.cells.len();
    let vertex = |place: [f64; 3]| {
        let near = |p: &[f64; 3]| distance(*p, place) < 1e-9;
        VertexId::new(mesh.points.iter().position(near).expect("a point at the place"))
    };
    let ends: Vec<[VertexId; 2]> = lines.iter().map(|(ends, _)| ends.map(vertex)).collect();
    ends.iter().for_each(|&ends| mesh.cells.push(CellKind::LINE, ends));
    for field in &mut mesh.cell_data {
        let rows = (0..n).chain(std::iter::repeat_n(0, lines.len()));
        *field = field.pick(rows);
    }
    let curves = std::iter::repeat_n(0, n).chain(lines.iter().map(|line| line.1));
    mesh.set_cell_field(Field::scalars("curve", curves.collect::<Vec<i32>>()));
    let weights = std::iter::repeat_n(0.0, n).chain(lines.iter().map(|line| f64::from(line.1) * 0.5));
    mesh.set_cell_field(Field::scalars("weight", weights.collect::<Vec<f64>>()));
    mesh
}

/// The lines of a mesh, each with its curve.
fn lines(mesh: &Mesh) -> Vec<([VertexId; 2], i32)> {
    let Values::I32(curves) = &mesh.cell_field("curve").unwrap().values else { panic!("whole numbers") };
    let all = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::LINE);
    all.map(|(cell, _, v)| ([v[0], v[1]], curves[cell.index()])).collect()
}

/// Asserts that every line is an edge of a tet and no edge has two lines; returns the length of each curve.
fn lengths(mesh: &Mesh) -> BTreeMap<i32, f64> {
    let rising = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
    let mut edges = BTreeSet::new();
    for (_, tet) in mesh.cells.tets() {
        for (i, j) in (0..4).flat_map(|i| (0..i).map(move |j| (i, j))) {
            edges.insert(rising([tet[i], tet[j]]));
        }
    }
    let (mut seen, mut lengths) = (BTreeSet::new(), BTreeMap::new());
    for (line, curve) in lines(mesh) {
        assert!(edges.contains(&rising(line)), "{line:?} is no edge of a tet");
        assert!(seen.insert(rising(line)), "{line:?} is there twice");
        *lengths.entry(curve).or_default() +=
            distance(mesh.points[line[0].index()], mesh.points[line[1].index()]);
    }
    lengths
}

fn same_lengths(before: &Mesh, after: &Mesh) {
    let (before, after) = (lengths(before), lengths(after));
    assert_eq!(before.keys().collect::<Vec<_>>(), after.keys().collect::<Vec<_>>());
    for (curve, length) in &before {
        assert!(
            (after[curve] - length).abs() < 1e-12 * length,
            "curve {curve}: {length} became {}",
            after[curve]
        );
    }
}

const O: [f64; 3] = [0.0; 3];
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const XY: [f64; 3] = [1.0, 1.0, 0.0];
const XYZ: [f64; 3] = [1.0; 3];

#[test]
fn lines_are_divided_with_their_edges() {
    let cube = || box_grid([1; 3], [O, XYZ]);
    // An edge of the cube, three edges with different labels that meet, the diagonal of a face, and that of
    // the cube inside.
    let cases = [
        vec![([O, X], 3)],
        vec![([O, X], 1), ([O, Y], 2), ([X, XY], 2)],
        vec![([O, XY], 4)],
        vec![([O, XYZ], 5), ([O, X], 5)],
    ];
    for requested in cases {
        let first = with_lines(cube(), &requested);
        let Changed { mesh, report, .. } = remeshed(&first, &options(0.3));
        assert!(report.is_complete() && report.after.bad == 0, "{:?}", report.after);
        same_lengths(&first, &mesh);
        let longest = lines(&mesh)
            .into_iter()
            .map(|(l, _)| distance(mesh.points[l[0].index()], mesh.points[l[1].index()]));
        assert!(longest.fold(0.0, f64::max) <= 1.5 * 0.3);
        // Arrays are carried along: each curve has one weight.
        let Values::F64(weights) = &mesh.cell_field("weight").unwrap().values else { panic!("real numbers") };
        let of_lines = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::LINE);
        for ((cell, ..), (_, curve)) in of_lines.zip(lines(&mesh)) {
            assert_eq!(weights[cell.index()], f64::from(curve) * 0.5);
        }
    }
}

#[test]
fn lines_are_merged_with_their_edges() {
    let n = 8;
    let at = |k: usize| [k as f64 / n as f64, 0.0, 0.0];
    // Two curves along one edge of the box: the vertex where they meet stays.
    let along: Vec<_> = (0..n).map(|k| ([at(k), at(k + 1)], if k < 3 { 1 } else { 2 })).collect();
    let first = with_lines(box_grid([n; 3], [O, XYZ]), &along);
    let Changed { mesh, report, .. } = remeshed(&first, &options(0.5));
    assert_eq!(report.after.bad, 0);
    same_lengths(&first, &mesh);
    assert!(lines(&mesh).len() < n, "{} lines", lines(&mesh).len());
}

#[test]
fn a_surface_that_is_kept_keeps_its_lines() {
    let mut first = with_lines(box_grid([3; 3], [O, XYZ]), &[([O, [1.0 / 3.0, 0.0, 0.0]], 1)]);
    // A bad tet, so that there is something to repair.
    let inner =
        (0..first.points.len()).find(|&v| first.points[v].iter().all(|&x| x > 0.1 && x < 0.5)).unwrap();
    first.points[inner] = [0.34, 0.34, 0.02];
    let Changed { mesh, .. } = remeshed(&first, &Options::default());
    let ends = |mesh: &Mesh| {
        lines(mesh).into_iter().map(|(l, c)| (l.map(|v| mesh.points[v.index()]), c)).collect::<Vec<_>>()
    };
    assert_eq!(ends(&first), ends(&mesh));
}

#[test]
fn beside_cells_of_other_kinds_no_tet_becomes_flat() {
    let first = mixed(2);
    let begin = std::time::Instant::now();
    let Changed { mesh, report, .. } =
        remesh_mesh(&first, &options(0.08), &Rules::default(), &Threads::single()).unwrap();
    let others = |mesh: &Mesh| {
        let is_other = |kind: CellKind| kind != CellKind::TETRA && kind != CellKind::TRIANGLE;
        let other = mesh.cells.iter().filter(|(_, kind, _)| is_other(*kind));
        let corners = |(_, kind, vertices): (CellId, CellKind, &[VertexId])| {
            (kind, vertices.iter().map(|v| mesh.points[v.index()]).collect::<Vec<_>>())
        };
        other.map(corners).collect::<Vec<_>>()
    };
    assert_eq!(others(&first), others(&mesh));
    let worst = report.after.worst.unwrap().eas.min(report.before.worst.unwrap().eas);
    println!("{} tets, {} bad, worst {worst}, {:?}", report.after.tets, report.after.bad, begin.elapsed());
    assert!(worst >= 0.02f64.min(report.before.worst.unwrap().eas), "{worst}");
}
