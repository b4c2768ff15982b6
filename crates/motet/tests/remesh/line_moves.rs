//! Vertices of lines where the surface adapts: they move along their line, and lines keep their positions.

use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{distance, norm, sub};
use motet::kernel::Complex;
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::remesh::{Options, Outcome, Sizes, SurfaceRule, remesh};

const N: usize = 5;

/// The unit cube with lines between grid points; each vertex in `drawn` is moved along x towards its
/// neighbour.
fn lined(ends: &[[[usize; 3]; 2]], drawn: &[([usize; 3], f64)]) -> TetMesh {
    let mut mesh = TetPart::of(&box_grid([N; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    let place = |at: [usize; 3]| at.map(|i| i as f64 / N as f64);
    let vertex = |at: [usize; 3]| {
        let near = |p: &Point| distance(*p, place(at)) < 1e-9;
        VertexId::new(mesh.points.iter().position(near).unwrap())
    };
    mesh.lines = ends.iter().map(|line| line.map(vertex)).collect();
    mesh.line_labels = vec![1; ends.len()];
    let moved: Vec<_> = drawn.iter().map(|&(at, by)| (vertex(at), by)).collect();
    moved.into_iter().for_each(|(v, by)| mesh.points[v.index()][0] += by / N as f64);
    mesh
}

fn adapted(mesh: &TetMesh) -> Outcome {
    let options = Options { surface: SurfaceRule::Adapt { distance: Some(0.01) }, ..Options::default() };
    remesh(mesh, &options, &Threads::single()).unwrap()
}

fn length(mesh: &TetMesh) -> f64 {
    mesh.lines.iter().map(|[a, b]| distance(mesh.points[a.index()], mesh.points[b.index()])).sum()
}

/// A line along x from one end of the cube to the other, in a side or inside.
fn along(y: usize, z: usize) -> Vec<[[usize; 3]; 2]> {
    (0..N).map(|i| [[i, y, z], [i + 1, y, z]]).collect()
}

#[test]
fn vertices_of_a_line_go_along_it_and_the_line_stays_where_it_is() {
    let mut n_moved = 0;
    // On an edge of the cube, in a side, and inside.
    for (y, z) in [(0, 0), (2, 0), (2, 3)] {
        let mesh = lined(&along(y, z), &[([2, y, z], 0.8)]);
        let Outcome { extract, report } = adapted(&mesh);
        assert!(report.before.bad > 0 && report.after.bad == 0, "{y} {z}: {:?}", report.before);
        let new = &extract.mesh;
        assert!((length(new) - 1.0).abs() < 1e-12, "{y} {z}: {}", length(new));
        let on_line = |v: VertexId| {
            let p = new.points[v.index()];
            norm(sub(p, [p[0], y as f64 / N as f64, z as f64 / N as f64])) < 1e-12
        };
        assert!(new.lines.as_flattened().iter().all(|v| on_line(*v)));
        assert!(new.line_labels.iter().all(|label| *label == 1));
        let line = |mesh: &TetMesh| {
            let mut all: Vec<f64> =
                mesh.lines.as_flattened().iter().map(|v| mesh.points[v.index()][0]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        n_moved += usize::from(line(new) != line(&mesh));
    }
    assert!(n_moved > 0, "no vertex of a line was moved, merged or inserted");
}

#[test]
fn a_corner_of_a_line_stays_where_it_is() {
    // In the side z = 0: along x, then along y; the corner is near a vertex of the line.
    let ends =
        [[[0, 2, 0], [1, 2, 0]], [[1, 2, 0], [2, 2, 0]], [[2, 2, 0], [2, 3, 0]], [[2, 3, 0], [2, 4, 0]]];
    let mesh = lined(&ends, &[([1, 2, 0], 0.85)]);
    let corner = [2.0 / N as f64, 2.0 / N as f64, 0.0];
    let Outcome { extract, report } = adapted(&mesh);
    assert!(report.before.bad > 0 && report.after.bad == 0, "{:?}", report.before);
    let new = &extract.mesh;
    assert!((length(new) - length(&mesh)).abs() < 1e-12, "{}", length(new));
    let ends = new.lines.as_flattened().iter().filter(|v| distance(new.points[v.index()], corner) < 1e-12);
    assert_eq!(ends.count(), 2, "two lines meet in the corner");
}

#[test]
fn lines_are_merged_wherever_they_lie() {
    for (y, z) in [(0, 0), (2, 0), (2, 3)] {
        let mesh = lined(&along(y, z), &[]);
        let sizes = Some(Sizes::Uniform(0.6));
        let surface = SurfaceRule::Adapt { distance: Some(0.01) };
        let outcome =
            remesh(&mesh, &Options { sizes, surface, ..Options::default() }, &Threads::single()).unwrap();
        let new = &outcome.extract.mesh;
        assert!(
            new.lines.len() < N && (length(new) - 1.0).abs() < 1e-12,
            "{y} {z}: {} lines",
            new.lines.len()
        );
        let complex = Complex::new(new).unwrap();
        complex.verify().unwrap();
        assert!(
            new.lines.iter().all(|[a, b]| complex.line(*a, *b).is_some()),
            "every line is an edge of a tet"
        );
    }
}

#[test]
fn a_line_that_bends_a_little_is_not_cut_short() {
    // In a side of the cube: the middle of the line is displaced, too little for a corner but farther than
    // the permitted distance.
    let mut mesh = lined(&along(2, 0), &[]);
    let middle = mesh.lines[2][0];
    mesh.points[middle.index()][1] += 0.08;
    let before = length(&mesh);
    for sizes in [None, Some(Sizes::Uniform(0.6))] {
        let surface = SurfaceRule::Adapt { distance: Some(0.01) };
        let new =
            remesh(&mesh, &Options { sizes, surface, ..Options::default() }, &Threads::single()).unwrap();
        let after = length(&new.extract.mesh);
        assert!((after - before).abs() < 0.01 * before, "{before} became {after}");
    }
}
