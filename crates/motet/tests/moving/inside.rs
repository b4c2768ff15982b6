//! Inner patches that are driven, histories of repairs, and invalid numbers that are refused.

use motet::base::{Point, Threads, VertexId};
use motet::contact;
use motet::geometry::vector::{add, distance, norm};
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{Boundary, CellKind, Field, Mesh};
use motet::motion::Motion;
use motet::moving::{MovingMesh, Options, Watching, Why};
use motet::refine::{Criterion, Wanted};

const SHEET: i32 = 99;

fn threads() -> Threads {
    Threads::single()
}

/// A box with a sheet of triangles across its middle.
fn with_sheet() -> Mesh {
    let mut mesh = box_grid([4; 3], [[0.0; 3], [1.0; 3]]);
    let is_on = |mesh: &Mesh, v: VertexId| mesh.points[v.index()][0] == 0.5;
    let mut patches = mesh.patches().unwrap().ids.clone();
    let mut sheet: Vec<[VertexId; 3]> = Vec::new();
    for (_, tet) in mesh.cells.tets() {
        let on: Vec<VertexId> = tet.into_iter().filter(|v| is_on(&mesh, *v)).collect();
        let Ok(mut facet) = <[VertexId; 3]>::try_from(on) else { continue };
        facet.sort_unstable();
        sheet.push(facet);
    }
    sheet.sort_unstable();
    sheet.dedup();
    for facet in sheet {
        mesh.cells.push(CellKind::TRIANGLE, facet);
        patches.push(SHEET);
    }
    let n = mesh.cells.len();
    mesh.cell_data.clear();
    assert_eq!(patches.len(), n);
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

fn inside() -> Options {
    Options { motion: Motion { inside: vec![SHEET.to_string()], ..Motion::default() }, ..Options::default() }
}

#[test]
fn what_is_driven_is_the_boundary_and_the_patches_inside() {
    let mesh = with_sheet();
    let driven = inside().motion.driven(&mesh).unwrap();
    let boundary = Boundary::of(&mesh.cells).vertices;
    let is_driven = |v: &VertexId| boundary.contains(v) || mesh.points[v.index()][0] == 0.5;
    let expected: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).filter(is_driven).collect();
    assert!(expected.len() > boundary.len());
    assert_eq!(driven, expected);
    assert_eq!(Motion::default().driven(&mesh).unwrap(), boundary);
    let moving = MovingMesh::new(&mesh, inside(), &threads()).unwrap();
    let places: Vec<Point> = driven.iter().map(|v| mesh.points[v.index()]).collect();
    assert_eq!(moving.driven_places(), places);
}

#[test]
fn a_sheet_inside_goes_where_it_is_requested_also_where_it_was_divided() {
    let mut moving = MovingMesh::new(&with_sheet(), inside(), &threads()).unwrap();
    let shear = |p: &Point| [0.2 * p[1] + 0.1 * p[2], 0.0, 0.15 * p[0]];
    let near = Criterion::Ball { centre: [0.5; 3], radius: 0.3 };
    let fine = Wanted { criteria: vec![near], generations: Some(1), ..Wanted::default() };
    assert_eq!(moving.refine(&fine, &threads()).unwrap().len(), 1);
    let before = moving.mesh().points.clone();
    let on_sheet = before.iter().filter(|p| p[0] == 0.5).count();
    assert!(on_sheet > 25, "the sheet was divided: {on_sheet}");
    let displacement: Vec<Point> = moving.driven_places().iter().map(shear).collect();
    assert!(moving.advance(1.0, &displacement, &threads()).unwrap().complete);
    for (p, q) in before.iter().zip(&moving.mesh().points) {
        assert!(distance(add(*p, shear(p)), *q) < 1e-9, "{p:?} {q:?}");
    }
    // Only the sheet moves: the other driven vertices stay.
    let bulge = |p: &Point| {
        if p[0] == 0.5 && p[1] * p[2] * (1.0 - p[1]) * (1.0 - p[2]) > 0.0 {
            [0.1, 0.0, 0.0]
        } else {
            [0.0; 3]
        }
    };
    let displacement: Vec<Point> = moving.driven_places().iter().map(bulge).collect();
    assert!(moving.advance(2.0, &displacement, &threads()).unwrap().complete);
    let middle = moving.mesh().points.iter().any(|p| distance(*p, [0.6, 0.5, 0.5]) < 1e-12);
    assert!(middle, "the middle of the sheet");
}

/// A mesh with inner vertices displaced until tets are bad.
fn astray() -> Mesh {
    let mut mesh = sphere_in_box(3, 3);
    for (i, p) in mesh.points.iter_mut().enumerate() {
        if norm(*p) > 1.01 && p.iter().all(|x| x.abs() < 4.99) {
            (0..3).for_each(|k| p[k] += 0.4 * ((7 * i + 3 * k) as f64).sin());
        }
    }
    mesh
}

#[test]
fn after_a_repair_without_a_step_gaps_are_those_of_the_new_mesh() {
    let watch = Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options::default(),
        horizon: None,
        hold: None,
    };
    let options = Options { watch: Some(watch), ..Options::default() };
    let mut moving = MovingMesh::new(&astray(), options, &threads()).unwrap();
    let before = moving.certify(&threads()).unwrap();
    assert!(before.bad > 0);
    let change = moving.repair(&threads()).unwrap().unwrap();
    assert_eq!((change.why, change.tets_before, change.bad_before), (Why::Repair, before.tets, before.bad));
    assert_ne!(change.tets_before, change.tets_after);
    let after = moving.certify(&threads()).unwrap();
    assert_eq!((after.bad, after.tets), (0, change.tets_after));
    assert_eq!(after.gaps.unwrap().least, before.gaps.unwrap().least, "walls stay");
    assert_eq!(moving.gaps().unwrap().at_points(after.points).len(), after.points);
    let displacement = vec![[0.1, 0.0, 0.0]; moving.driven_places().len()];
    assert!(moving.advance(1.0, &displacement, &threads()).unwrap().complete);
}

#[test]
fn a_watch_needs_a_time_and_a_distance_that_mean_something() {
    let with = |horizon: Option<f64>, hold: Option<f64>| {
        let patches = vec!["sphere".into(), "box".into()];
        let watch = Watching { patches, options: contact::Options::default(), horizon, hold };
        MovingMesh::new(
            &sphere_in_box(3, 3),
            Options { watch: Some(watch), ..Options::default() },
            &threads(),
        )
        .is_ok()
    };
    assert!(with(None, None) && with(Some(1e-9), None) && with(None, Some(0.1)));
    for horizon in [0.0, -1.0, f64::NAN] {
        assert!(!with(Some(horizon), None), "{horizon}");
    }
    for hold in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(!with(None, Some(hold)), "{hold}");
    }
}
