//! Reports of a remeshing: cells of the mesh in any order, seconds that add up, shares of the mesh before.

use std::time::Instant;

use motet::base::{CellId, Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::centroid;
use motet::mesh::history::{Changed, Rules};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Mesh};
use motet::remesh::{Options, Report, Seconds, Sizes, SurfaceRule, remesh_mesh};

/// A box whose triangles come before its tets, with some inner vertices near others.
fn triangles_first(n: [usize; 3], size: Point) -> Mesh {
    let mesh = box_grid(n, [[0.0; 3], size]);
    let mut cells = Cells::new();
    for wanted in [CellKind::TRIANGLE, CellKind::TETRA] {
        let of_kind = mesh.cells.iter().filter(|(_, kind, _)| *kind == wanted);
        of_kind.for_each(|(_, kind, vertices)| cells.push(kind, vertices.iter().copied()));
    }
    let mut points = mesh.points;
    for (i, p) in points.iter_mut().enumerate() {
        if (0..3).all(|k| p[k] > 0.0 && p[k] < size[k]) {
            (0..3).for_each(|k| p[k] += 0.45 * size[k] / n[k] as f64 * ((7 * i + 3 * k) as f64).sin());
        }
    }
    Mesh { points, cells, ..Mesh::default() }
}

fn remeshed(mesh: &Mesh) -> Changed<Report> {
    remesh_mesh(mesh, &Options::default(), &Rules::default(), &Threads::single()).unwrap()
}

fn corners(mesh: &Mesh, cell: CellId) -> [Point; 4] {
    assert_eq!(mesh.cells.kind(cell), CellKind::TETRA);
    let vertices: [VertexId; 4] = mesh.cells.vertices(cell).try_into().unwrap();
    vertices.map(|v| mesh.points[v.index()])
}

fn assert_places(old: &Mesh, new: &Mesh, report: &Report) {
    for (mesh, worst) in [(old, report.before.worst.unwrap()), (new, report.after.worst.unwrap())] {
        let tet = corners(mesh, worst.tet);
        assert_eq!((eas(tet), centroid(tet)), (worst.eas, worst.place));
    }
    for left in &report.left {
        let tet = corners(new, left.tet);
        assert_eq!((eas(tet), centroid(tet)), (left.eas, left.place));
    }
}

#[test]
fn tets_are_numbered_by_their_cells_also_where_triangles_come_first() {
    let old = triangles_first([6; 3], [1.0; 3]);
    let Changed { mesh, report, .. } = remeshed(&old);
    assert!(report.before.bad > 10 && report.after.bad == 0, "{:?}", report.before);
    assert_places(&old, &mesh, &report);
    // Between two plates nothing helps: the tets left are also reported by their cells.
    let old = triangles_first([4, 4, 1], [2.0, 2.0, 0.01]);
    let Changed { mesh, report, .. } = remeshed(&old);
    assert!(report.left.len() > 10);
    assert_places(&old, &mesh, &report);
}

#[test]
fn counts_and_shares_are_those_of_the_meshes() {
    let old = triangles_first([6; 3], [1.0; 3]);
    let Changed { mesh, report, history, .. } = remeshed(&old);
    let tets = |mesh: &Mesh| mesh.cells.tets().count();
    assert_eq!((report.before.tets, report.after.tets), (tets(&old), tets(&mesh)));
    assert_eq!((report.before.vertices, report.after.vertices), (old.points.len(), mesh.points.len()));
    assert_eq!(report.kept_share, report.kept as f64 / tets(&old) as f64);
    let is_tet = |cell: usize| mesh.cells.kind(CellId::new(cell)) == CellKind::TETRA;
    let kept = history.cells.kept().iter().enumerate().filter(|(cell, old)| is_tet(*cell) && old.is_some());
    assert_eq!(kept.count(), report.kept);
    let bad = |mesh: &Mesh| {
        mesh.cells.tets().filter(|(cell, _)| eas(corners(mesh, *cell)) < report.min_eas).count()
    };
    assert_eq!((report.before.bad, report.after.bad), (bad(&old), bad(&mesh)));
    assert_eq!(report.before.types.iter().sum::<usize>(), report.before.bad);
    let flat = |mesh: &Mesh| mesh.cells.tets().filter(|(cell, _)| eas(corners(mesh, *cell)) <= 0.0).count();
    assert_eq!((report.before.inverted, report.after.inverted), (flat(&old), flat(&mesh)));
}

#[test]
fn stages_take_no_longer_than_the_whole() {
    let mesh = triangles_first([6; 3], [1.0; 3]);
    let begin = Instant::now();
    let Seconds { join, repair, extract, history } = remeshed(&mesh).report.seconds;
    let all = begin.elapsed().as_secs_f64();
    let stages = [join, repair, extract, history];
    assert!(stages.iter().all(|s| *s > 0.0) && stages.iter().sum::<f64>() <= all, "{stages:?} of {all}");
}

#[test]
fn parts_of_a_line_run_as_the_line_does() {
    for is_turned in [false, true] {
        let mut mesh = box_grid([1; 3], [[0.0; 3], [1.0; 3]]);
        let at = |p: Point| VertexId::new(mesh.points.iter().position(|&q| q == p).unwrap());
        let mut ends = [at([0.0; 3]), at([1.0, 0.0, 0.0])];
        if is_turned {
            ends.swap(0, 1);
        }
        mesh.cell_data.clear();
        mesh.cells.push(CellKind::LINE, ends);
        let surface = SurfaceRule::Adapt { distance: None };
        let options = Options { sizes: Some(Sizes::Uniform(0.3)), surface, ..Options::default() };
        let new = remesh_mesh(&mesh, &options, &Rules::default(), &Threads::single()).unwrap().mesh;
        let lines: Vec<_> = new.cells.iter().filter(|(_, kind, _)| *kind == CellKind::LINE).collect();
        assert!(lines.len() > 2);
        for (_, _, v) in lines {
            let way = new.points[v[1].index()][0] - new.points[v[0].index()][0];
            assert_eq!(way < 0.0, is_turned, "{way}");
        }
    }
}
