//! Consistent counts: every verb reports the same number of bad tets, inverted ones and tets of boundary
//! layers for a mesh.

use motet::Mesh;
use motet::base::{Threads, VertexId};
use motet::geometry::predicates::orient3d;
use motet::geometry::quality::eas;
use motet::mesh::check::{DefectKind, check};
use motet::mesh::shapes::box_grid;
use motet::mesh::{BAD_EAS, CellKind, Cells, Field, OrientedTets, Summary, TetPart};
use motet::motion::{self, Mover};
use motet::moving::{self, MovingMesh};
use motet::remesh::{self, remesh};

/// The counts of one verb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counts {
    bad: usize,
    layers: usize,
    inverted: usize,
}

/// Counts by `motet info`.
fn by_info(mesh: &Mesh) -> Counts {
    let summary = Summary::of(mesh);
    let eas = summary.quality.unwrap().eas;
    Counts { bad: eas.bad, layers: eas.layers, inverted: summary.inverted }
}

/// Counts by the certificate of a motion.
fn by_mover(mesh: &Mesh) -> Counts {
    let mover = Mover::new(mesh, &motion::Options::default(), &Threads::single()).unwrap();
    let certificate = mover.quality(&mesh.points, &Threads::single());
    let quality = certificate.quality;
    assert_eq!(certificate.inverted, certificate.inverted_before);
    Counts { bad: quality.bad, layers: quality.layers, inverted: certificate.inverted }
}

/// Counts by the report of a repair, for the input mesh.
fn by_remesh(mesh: &Mesh) -> Counts {
    let part = TetPart::of(mesh).unwrap();
    let before = remesh(&part.mesh, &remesh::Options::default(), &Threads::single()).unwrap().report.before;
    Counts { bad: before.bad, layers: before.layers, inverted: before.inverted }
}

/// Counts by a step of a moving mesh, which does not report layers.
fn by_step(mesh: &Mesh) -> [usize; 2] {
    let options = moving::Options { repair: None, ..moving::Options::default() };
    let mut moving = MovingMesh::new(mesh, options, &Threads::single()).unwrap();
    let step = moving.certify(&Threads::single()).unwrap();
    [step.bad, step.inverted]
}

/// Asserts that all verbs agree; returns the counts.
fn counted(what: &str, mesh: &Mesh) -> Counts {
    let info = by_info(mesh);
    assert_eq!(by_mover(mesh), info, "{what}: mover");
    assert_eq!(by_remesh(mesh), info, "{what}: remesh");
    assert_eq!(by_step(mesh), [info.bad, info.inverted], "{what}: step");
    info
}

/// The mesh with some of its tets numbered the other way round.
fn renumbered(mesh: &Mesh, is_turned: impl Fn(usize) -> bool) -> Mesh {
    let mut cells = Cells::new();
    for (cell, kind, vertices) in mesh.cells.iter() {
        let mut vertices = vertices.to_vec();
        if kind == CellKind::TETRA && is_turned(cell.index()) {
            vertices.swap(1, 2);
        }
        cells.push(kind, vertices);
    }
    Mesh { cells, ..mesh.clone() }
}

/// A box with thin layers at the top and at the bottom, each twice as thick as the one before.
fn layered() -> Mesh {
    let heights = [0.0, 0.005, 0.015, 0.035, 0.16, 0.33, 0.5, 0.67, 0.84, 0.965, 0.985, 0.995, 1.0];
    let mut mesh = box_grid([16, 16, 12], [[0.0; 3], [1.0; 3]]);
    mesh.points.iter_mut().for_each(|p| p[2] = heights[(12.0 * p[2]).round() as usize]);
    mesh
}

/// A box with displaced inner vertices: some tets are bad, some inverted.
fn shaken() -> Mesh {
    let mut mesh = box_grid([4, 4, 4], [[0.0; 3], [4.0; 3]]);
    for (i, p) in mesh.points.iter_mut().enumerate() {
        if p.iter().all(|x| *x > 0.0 && *x < 4.0) {
            (0..3).for_each(|k| p[k] += 0.45 * ((7 * i + 3 * k) as f64).sin());
        }
    }
    mesh
}

/// Bad and inverted tets by definition, of a consistently numbered mesh.
fn by_definition(mesh: &Mesh) -> [usize; 2] {
    let tets = || mesh.cells.tets().map(|(_, tet)| tet.map(|v| mesh.points[v.index()]));
    let is_inverted = |[a, b, c, d]: &[[f64; 3]; 4]| orient3d(*a, *b, *c, *d) <= 0;
    [tets().filter(|tet| eas(*tet) < BAD_EAS).count(), tets().filter(is_inverted).count()]
}

#[test]
fn every_door_counts_the_same_whichever_way_tets_are_numbered() {
    for (what, mesh) in [("layered", layered()), ("shaken", shaken())] {
        let counts = counted(what, &mesh);
        let [low, inverted] = by_definition(&mesh);
        assert_eq!((counts.bad + counts.layers, counts.inverted), (low, inverted), "{what}");
        for (how, other) in
            [("turned", renumbered(&mesh, |_| true)), ("mixed", renumbered(&mesh, |cell| cell % 3 == 0))]
        {
            assert_eq!(counted(&format!("{what}, {how}"), &other), counts, "{what}, {how}");
            let [volume, same] = [&mesh, &other].map(|mesh| Summary::of(mesh).volume);
            assert!((volume - same).abs() < 1e-12 * volume, "{what}, {how}");
            let turned_over = |mesh: &Mesh| {
                let is_so = |kind| matches!(kind, DefectKind::InvertedCell | DefectKind::FlatCell);
                check(mesh)
                    .iter()
                    .filter(|defect| is_so(defect.kind))
                    .map(|defect| defect.count)
                    .sum::<usize>()
            };
            assert_eq!(turned_over(&other), counts.inverted, "{what}, {how}");
        }
    }
}

#[test]
fn thin_tets_of_layers_are_not_bad_and_others_are() {
    let mut mesh = layered();
    let counts = counted("layered", &mesh);
    assert!(counts.layers > 1000 && counts.bad == 0 && counts.inverted == 0, "{counts:?}");
    // A vertex inside that is moved towards a neighbour makes slivers, which stand in no column.
    let inside =
        |p: &[f64; 3]| p[2] > 0.2 && p[2] < 0.5 && p[0] > 0.2 && p[0] < 0.8 && p[1] > 0.2 && p[1] < 0.8;
    let place = mesh.points.iter().position(inside).unwrap();
    mesh.points[place][0] += 0.062;
    let drawn = counted("with slivers", &mesh);
    assert!(drawn.bad > 0 && drawn.layers == counts.layers, "{drawn:?}");
}

#[test]
fn a_tet_folded_over_its_neighbour_is_inverted() {
    let mesh = box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]);
    assert_eq!(counted("sound", &mesh).inverted, 0);
    let mut folded = Mesh::new(mesh.points.clone(), mesh.cells.clone());
    // On the inner side of a boundary facet of the first tet, positive by itself.
    let (cell, tet) = mesh.cells.tets().next().unwrap();
    let boundary = motet::mesh::Boundary::of(&mesh.cells);
    let facet = (0..boundary.len()).find(|&i| boundary.cells[i] == cell).unwrap();
    let [a, b, c]: [VertexId; 3] = boundary.facets.list(facet).try_into().unwrap();
    let centre = [0, 1, 2].map(|k| tet.iter().map(|v| mesh.points[v.index()][k]).sum::<f64>() / 4.0);
    folded.points.push(centre);
    folded.cells.push(CellKind::TETRA, [a, c, b, VertexId::new(mesh.points.len())]);
    assert!(check(&folded).iter().any(|defect| defect.kind == DefectKind::FoldedFacet));
    let info = by_info(&folded);
    assert_eq!((info.inverted, by_remesh(&folded)), (1, info));
}

/// The counts in the report of a repair are those of the new mesh.
#[test]
fn what_a_repair_reports_is_what_the_new_mesh_has() {
    for (what, mesh, limits) in [("layered", layered(), &[0.2][..]), ("shaken", shaken(), &[0.2, 0.45][..])] {
        let part = TetPart::of(&mesh).unwrap();
        for &min_eas in limits {
            let options = remesh::Options { min_eas, ..remesh::Options::default() };
            let outcome = remesh(&part.mesh, &options, &Threads::single()).unwrap();
            let (new, after) = (&outcome.extract.mesh, &outcome.report.after);
            let tets = OrientedTets::of_tets(new, &Threads::single());
            let low = (0..new.tets.len()).filter(|&t| eas(tets.corners(t, &new.points)) < min_eas).collect();
            let judged = tets.judge(&new.points, low, min_eas);
            assert_eq!(
                (judged.bad.len(), judged.layers.len()),
                (after.bad, after.layers),
                "{what} {min_eas}"
            );
            assert_eq!(outcome.report.left.len(), after.bad, "{what} {min_eas}");
            let n_inverted = (0..new.tets.len()).filter(|&t| tets.is_inverted(t, &new.points)).count();
            assert_eq!(n_inverted, after.inverted, "{what} {min_eas}");
        }
    }
}

/// The values of the cell array match the counts.
#[test]
fn the_array_of_qualities_is_of_oriented_tets() {
    let mesh = shaken();
    let values = |mesh: &Mesh| -> Field { mesh.tet_field("eas", eas) };
    let other = renumbered(&mesh, |cell| cell % 2 == 0);
    let [ours, theirs] = [&mesh, &other].map(|mesh| values(mesh).values.to_f64().unwrap());
    for (x, y) in ours.iter().zip(&theirs) {
        assert!(x.is_nan() && y.is_nan() || (x - y).abs() < 1e-12, "{x} and {y}");
    }
}
