//! Refinement of whole meshes: labels, arrays and cells of other kinds are carried along, and files remember
//! divisions.

use crate::common::invariants::fits;
use motet::Mesh;
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::tet::{centroid, volume};
use motet::io;
use motet::mesh::check::{check, is_conforming};
use motet::mesh::history::{Changed, Rules};
use motet::mesh::shapes::{box_grid, mixed};
use motet::mesh::{CellKind, Field, TetPart, Values};
use motet::refine::{MeshRefinement, Options, mark};
use motet::remesh::{self, remesh_mesh};

fn threads() -> Threads {
    Threads::single()
}

fn linear([x, y, z]: Point) -> f64 {
    1.0 + 2.0 * x - 3.0 * y + 0.5 * z
}

fn corners(mesh: &Mesh, tet: [VertexId; 4]) -> [Point; 4] {
    tet.map(|v| mesh.points[v.index()])
}

/// A box of two regions and six patches; arrays of several sorts.
fn labelled_box(n: usize) -> Mesh {
    let mut mesh = box_grid([n; 3], [[0.0; 3], [1.0; 3]]);
    let mut regions = vec![0i32; mesh.cells.len()];
    for (cell, tet) in mesh.cells.tets() {
        regions[cell.index()] = 5 + i32::from(centroid(corners(&mesh, tet))[0] > 0.5);
    }
    let n_cells = mesh.cells.len();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("stress", (0..n_cells).map(|c| (c as f64).sin()).collect::<Vec<_>>()));
    mesh.set_point_field(Field::scalars(
        "pressure",
        mesh.points.iter().map(|&p| linear(p)).collect::<Vec<_>>(),
    ));
    mesh.set_point_field(Field::scalars("GlobalNodeID", (0..mesh.points.len() as i64).collect::<Vec<_>>()));
    mesh
}

fn integral(mesh: &Mesh, name: &str) -> f64 {
    let values = mesh.cell_field(name).unwrap().values.to_f64().unwrap();
    mesh.cells.tets().map(|(cell, tet)| values[cell.index()] * volume(corners(mesh, tet)).abs()).sum()
}

fn in_ball(refinement: &MeshRefinement, centre: Point, radius: f64) -> Vec<TetId> {
    mark::in_ball(refinement.refinement().mesh(), centre, radius, &threads())
}

fn all(refinement: &MeshRefinement) -> Vec<TetId> {
    (0..refinement.refinement().mesh().tets.len()).map(TetId::new).collect()
}

#[test]
fn labels_and_arrays_go_along_and_come_back() {
    let first = labelled_box(4);
    let rules = Rules::default();
    let mut refinement = MeshRefinement::new(&first, Options::default(), &threads()).unwrap();
    for radius in [0.4, 0.2, 0.1] {
        let marked = in_ball(&refinement, [0.3, 0.0, 0.2], radius);
        let Changed { report: summary, history, .. } =
            refinement.refine(&marked, &rules, &threads()).unwrap();
        let mesh = refinement.mesh();
        assert_eq!(summary.n_held, 0);
        assert!(check(mesh).is_empty());
        assert!(history.ledger.regions.iter().all(|r| r.deviation <= 1e-13 * r.volume_before));
        assert_eq!(history.ledger.n_outside, 0);
    }
    let mesh = refinement.mesh().clone();
    fits(&TetPart::of(&first).unwrap().mesh, &TetPart::of(&mesh).unwrap().mesh);
    assert!(refinement.part().mesh == TetPart::of(&mesh).unwrap().mesh);
    let pressure = mesh.point_field("pressure").unwrap().values.to_f64().unwrap();
    for (&p, value) in mesh.points.iter().zip(pressure) {
        assert!((value - linear(p)).abs() < 1e-13);
    }
    assert!((integral(&mesh, "stress") - integral(&first, "stress")).abs() < 1e-13);
    let mut ids = mesh.point_field("GlobalNodeID").unwrap().values.to_i64().unwrap();
    ids.sort_unstable();
    assert!(ids.windows(2).all(|w| w[0] < w[1]), "no two points have one number");

    for _ in 0..3 {
        refinement.coarsen(&all(&refinement), &rules, &threads()).unwrap();
    }
    let back = refinement.mesh();
    assert!(back.points == first.points && back.cells == first.cells);
    for name in ["region", "patch"] {
        assert_eq!(back.cell_field(name), first.cell_field(name));
    }
    assert_eq!(back.point_data, first.point_data);
    assert!((integral(back, "stress") - integral(&first, "stress")).abs() < 1e-13);
    assert!(refinement.with_memory(&threads()) == *back, "nothing to remember");
}

#[test]
fn a_file_remembers() {
    let first = labelled_box(4);
    let rules = Rules::default();
    let mut one = MeshRefinement::new(&first, Options::default(), &threads()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("fine.vtu");
    for step in 0..3 {
        let marked = in_ball(&one, [0.3, 0.1, 0.2], 0.3 / f64::from(step + 1));
        one.refine(&marked, &rules, &threads()).unwrap();
        io::write(&file, &one.with_memory(&threads()), &io::WriteOptions::default()).unwrap();
        let mut other =
            MeshRefinement::new(&io::read(&file).unwrap(), Options::default(), &threads()).unwrap();
        assert!(one.mesh() == other.mesh() && one.refinement().mesh() == other.refinement().mesh());
        let marked = in_ball(&one, [0.8, 0.8, 0.8], 0.1);
        let [a, b] = [&mut one, &mut other].map(|x| x.refine(&marked, &rules, &threads()).unwrap().report);
        assert!(a == b && one.mesh() == other.mesh());
    }
    let mut last = MeshRefinement::new(&one.with_memory(&threads()), Options::default(), &threads()).unwrap();
    while last.refinement().is_divided() {
        let n = last.refinement().mesh().tets.len();
        last.coarsen(&all(&last), &rules, &threads()).unwrap();
        assert!(last.refinement().mesh().tets.len() < n, "something is taken back");
    }
    assert!(last.mesh().points == first.points && last.mesh().cells == first.cells);
}

#[test]
fn remeshing_in_between_is_known_from_the_file() {
    let mut one = MeshRefinement::new(&labelled_box(8), Options::default(), &threads()).unwrap();
    for centre in [[0.2; 3], [0.8; 3]] {
        let marked = in_ball(&one, centre, 0.1);
        one.refine(&marked, &Rules::default(), &threads()).unwrap();
    }
    let mut moved = one.with_memory(&threads());
    // One inner vertex moves almost through a facet.
    let inside =
        |p: &Point| p.iter().all(|x| *x > 0.01 && *x < 0.99) && p.iter().all(|x| (x - 0.8).abs() < 0.2);
    let v = moved.points.iter().position(inside).unwrap();
    moved.points[v][0] += 0.055;
    let options = remesh::Options::default();
    let repaired = remesh_mesh(&moved, &options, &Rules::default(), &threads()).unwrap();
    println!("{} tets after remeshing", repaired.report.after.tets);
    let mut other = MeshRefinement::new(&repaired.mesh, Options::default(), &threads()).unwrap();
    let n = other.mesh().cells.len();
    loop {
        let before = other.mesh().cells.len();
        other.coarsen(&all(&other), &Rules::default(), &threads()).unwrap();
        assert!(is_conforming(&check(other.mesh())));
        if other.mesh().cells.len() == before {
            break;
        }
    }
    println!("{n} cells became {}, {} at first", other.mesh().cells.len(), labelled_box(8).cells.len());
    assert!(other.mesh().cells.len() < n);
    let first = labelled_box(8);
    let there: std::collections::HashSet<[[u64; 3]; 4]> = other
        .mesh()
        .cells
        .tets()
        .map(|(_, t)| corners(other.mesh(), t).map(|p| p.map(f64::to_bits)))
        .collect();
    let far = first.cells.tets().map(|(_, t)| corners(&first, t)).filter(|c| centroid(*c)[0] < 0.45);
    assert!(far.clone().count() > 1000);
    assert!(far.into_iter().all(|c| there.contains(&c.map(|p| p.map(f64::to_bits)))));
}

#[test]
fn cells_of_other_kinds_keep_their_edges() {
    let first = mixed(3);
    let others = |mesh: &Mesh| -> Vec<Vec<Point>> {
        let other =
            mesh.cells.iter().filter(|(_, kind, _)| !matches!(*kind, CellKind::TETRA | CellKind::TRIANGLE));
        other.map(|(_, _, vertices)| vertices.iter().map(|v| mesh.points[v.index()]).collect()).collect()
    };
    assert!(!others(&first).is_empty());
    let mut refinement = MeshRefinement::new(&first, Options::default(), &threads()).unwrap();
    for _ in 0..2 {
        let marked = all(&refinement);
        let summary = refinement.refine(&marked, &Rules::default(), &threads()).unwrap().report;
        println!("{summary:?}");
        assert!(summary.n_held > 0, "those at other cells are left out");
        assert!(is_conforming(&check(refinement.mesh())), "{:?}", check(refinement.mesh()));
        assert_eq!(others(refinement.mesh()), others(&first));
    }
}

#[test]
fn arrays_of_another_mesh_are_refused() {
    let mut refinement = MeshRefinement::new(&labelled_box(4), Options::default(), &threads()).unwrap();
    refinement.refine(&in_ball(&refinement, [0.5; 3], 0.2), &Rules::default(), &threads()).unwrap();
    let good = refinement.with_memory(&threads());
    let mut missing = good.clone();
    missing.cell_data.retain(|field| field.name != "refine_path");
    let mut words = good.clone();
    let n = words.cells.len();
    words.set_cell_field(Field::scalars("refine_piece", vec![0.5; n]));
    let mut swapped = good.clone();
    if let Some(Values::F64(values)) =
        swapped.point_data.iter_mut().find(|f| f.name == "refine_reference").map(|f| &mut f.values)
    {
        values.iter_mut().for_each(|x| *x = x.sin() * 7.0);
    }
    for (mesh, what) in [(missing, "'refine_path'"), (words, "'refine_piece'"), (swapped, "")] {
        match MeshRefinement::new(&mesh, Options::default(), &threads()) {
            Err(error) => assert!(error.to_string().contains(what), "{error}"),
            Ok(_) => panic!("{what} is not right"),
        }
    }
}
