//! A mesh that moves with its walls: repaired on the way, arrays and maps carried, saved and resumed,
//! watched.

use motet::base::{Point, Threads, VertexId, Watch};
use motet::contact;
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::volume;
use motet::geometry::vector::{add, norm, sub};
use motet::mesh::shapes::{TubeOptions, WallCells, sphere_in_box, tube};
use motet::mesh::{Field, Mesh, check};
use motet::motion::Prescribed;
use motet::moving::{MovingMesh, Options, Watching, Why};
use motet::refine::{Criterion, Wanted};
use motet::{ErrorKind, Result};

fn threads() -> Threads {
    Threads::single()
}

fn is_sphere(p: Point) -> bool {
    norm(p) < 1.01
}

/// A displacement for each driven vertex: `of` the sphere, none of the box.
fn sphere_goes(moving: &MovingMesh, of: impl Fn(Point) -> Point) -> Vec<Point> {
    let goes = |&p: &Point| if is_sphere(p) { sub(of(p), p) } else { [0.0; 3] };
    moving.driven_places().iter().map(goes).collect()
}

fn shift(by: Point) -> impl Fn(Point) -> Point {
    move |p| add(p, by)
}

fn total_volume(mesh: &Mesh) -> f64 {
    mesh.cells.tets().map(|(_, tet)| volume(tet.map(|v| mesh.points[v.index()]))).sum()
}

fn content(mesh: &Mesh, name: &str) -> f64 {
    let density = mesh.cell_field(name).unwrap().values.to_f64().unwrap();
    let of = |tet: [VertexId; 4]| volume(tet.map(|v| mesh.points[v.index()]));
    mesh.cells.tets().map(|(cell, tet)| density[cell.index()] * of(tet)).sum()
}

fn box_mesh() -> Mesh {
    let mut mesh = sphere_in_box(6, 5);
    let linear: Vec<f64> = mesh.points.iter().map(|p| 1.0 + 0.5 * p[0] - 0.25 * p[2]).collect();
    mesh.set_point_field(Field::scalars("linear", linear));
    let dye = (0..mesh.cells.len()).map(|i| 1.0 + (i as f64 * 0.1).sin()).collect::<Vec<_>>();
    mesh.set_cell_field(Field::scalars("dye", dye));
    mesh
}

/// Back and forth along x, as far as three radii of the sphere from the middle, where one radius is left to
/// the wall; with half a turn there.
fn cycle(k: usize) -> Prescribed {
    let angle = k as f64 / 12.0 * std::f64::consts::TAU;
    let turn = Prescribed::Turn { axis: [0.1, 0.2, 1.0], angle: 1.6 * angle.sin(), centre: [0.0; 3] };
    Prescribed::Sequence(vec![turn, Prescribed::Shift([3.0 * angle.sin(), 0.4 * (2.0 * angle).sin(), 0.0])])
}

fn along(motion: Prescribed) -> impl Fn(Point) -> Point {
    move |p| motion.apply(p, 1.0)
}

fn options() -> Options {
    let mut options = Options { contents: vec!["dye".into()], ..Options::default() };
    options.motion.smooth = 2;
    options
}

#[test]
fn a_sphere_goes_far_and_comes_back_again_and_again_and_no_tet_is_bad() {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    let (volume_at_first, dye_at_first) = (total_volume(&mesh), content(&mesh, "dye"));
    let mut n_changes = 0;
    for k in 1..=36 {
        let displacement = sphere_goes(&moving, along(cycle(k)));
        let step = moving.advance(k as f64, &displacement, &threads()).unwrap();
        let worst = step.worst.unwrap();
        println!(
            "step {k}: {} tets, {} bad, worst {:.4}, {} legs, {} changes",
            step.tets,
            step.bad,
            worst.eas,
            step.legs,
            step.changes.len()
        );
        assert!(step.complete && step.inverted == 0 && step.bad == 0 && worst.eas >= 0.2);
        assert_eq!((step.step, step.time, moving.step(), moving.time()), (k, k as f64, k, k as f64));
        n_changes += step.changes.len();
        let now = moving.mesh();
        assert!(check::check(now).is_empty(), "{:?}", check::check(now));
        // The walls are where they were driven.
        let all = now.points.iter().zip(moving.displacement()).map(|(&p, d)| (sub(p, d), d));
        let mut n = 0;
        for (first, d) in all.filter(|(first, _)| is_sphere(*first)) {
            assert!(norm(sub(d, cycle(k).displacement(first, 1.0))) < 1e-13);
            n += 1;
        }
        assert_eq!(n, moving.driven_places().iter().filter(|p| is_sphere(**p)).count());
        assert!((total_volume(now) - volume_at_first).abs() < 1e-12 * volume_at_first);
        assert!((content(now, "dye") - dye_at_first).abs() < 1e-12 * dye_at_first, "step {k}");
    }
    assert!(n_changes > 3, "the motion is far enough to need repair");
}

#[test]
fn as_long_as_nothing_changes_a_step_depends_on_where_the_walls_are_alone() {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    let there = sphere_goes(&moving, shift([0.4, 0.1, -0.2]));
    let away = sphere_goes(&moving, shift([-0.5, 0.3, 0.1]));
    let still = vec![[0.0; 3]; there.len()];
    moving.advance(1.0, &there, &threads()).unwrap();
    let first = moving.mesh().points.clone();
    moving.advance(2.0, &away, &threads()).unwrap();
    assert!(moving.advance(3.0, &there, &threads()).unwrap().changes.is_empty());
    assert_eq!(moving.mesh().points, first);
    moving.advance(4.0, &still, &threads()).unwrap();
    assert_eq!(moving.mesh().points, mesh.points);
    assert!(moving.history_since(0).unwrap().is_none());
    let back: Vec<Point> = first.iter().zip(&mesh.points).map(|(&a, &b)| sub(b, a)).collect();
    assert_eq!(moving.velocity(), back);
}

#[test]
fn histories_lead_from_any_step_to_the_present_one() {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    // Arrays kept by the caller, one set at first and one later, each with the vertex positions of its time.
    let mut kept: Vec<(usize, Field)> = vec![(0, Field::vectors("place", &mesh.points))];
    for k in 1..=6 {
        let displacement = sphere_goes(&moving, along(cycle(k)));
        let step = moving.advance(k as f64, &displacement, &threads()).unwrap();
        for change in &step.changes {
            assert_eq!(change.why, Why::Repair);
            assert!(change.bad_before > 0 && change.volume_deviation < 1e-12);
            assert_eq!(change.points_before.len(), change.history.vertices.n_old());
        }
        if k == 3 {
            kept.push((3, Field::vectors("place", &moving.mesh().points)));
        }
    }
    for (step, field) in kept {
        let history = moving.history_since(step).unwrap().expect("there were changes");
        let carried = history.transfer_points(&field).unwrap().to_vectors().unwrap();
        assert_eq!(carried.len(), moving.mesh().points.len());
        // Kept vertices have exactly the position that they had then.
        let vertices = history.vertices.kept().iter().zip(&carried);
        let old = field.to_vectors().unwrap();
        for (v, place) in vertices.filter_map(|(v, place)| Some((v.get()?, *place))) {
            assert_eq!(place, old[v.index()]);
        }
    }
    assert!(moving.remembers(0) && moving.remembers(6) && !moving.remembers(7));
    let mut short = MovingMesh::new(&mesh, Options { remembered: 1, ..options() }, &threads()).unwrap();
    for k in 1..=12 {
        let displacement = sphere_goes(&short, along(cycle(k)));
        short.advance(k as f64, &displacement, &threads()).unwrap();
    }
    assert!(!short.remembers(0) && short.remembers(12));
    let reported = short.history_since(0).unwrap_err();
    assert_eq!(reported.kind(), ErrorKind::Options);
    assert!(reported.to_string().contains("since step 0 are not known"), "{reported}");
    let reported = short.history_since(13).unwrap_err().to_string();
    assert!(reported.contains("step 13") && reported.contains("the last one is 12"), "{reported}");
}

/// The number of steps of [`cycle`] that end with tets without positive volume at the vertex positions at the
/// start of the step, recomputed from the history; with the worst EAS of all steps.
fn steps_off_at_start(options: Options) -> (usize, f64) {
    let mut moving = MovingMesh::new(&box_mesh(), options, &threads()).unwrap();
    let (mut n_off, mut worst) = (0, f64::INFINITY);
    for k in 1..=12 {
        let start = Field::vectors("start", &moving.mesh().points);
        let displacement = sphere_goes(&moving, along(cycle(k)));
        let step = moving.advance(k as f64, &displacement, &threads()).unwrap();
        assert!(step.complete, "step {k}");
        worst = step.worst.map_or(worst, |tet| worst.min(tet.eas));
        let Some(history) = moving.history_since(k - 1).unwrap() else {
            assert!(step.inverted_at_start.is_none());
            continue;
        };
        let start = history.transfer_points(&start).unwrap().to_vectors().unwrap();
        let is_off = |tet: [VertexId; 4]| {
            let [a, b, c, d] = tet.map(|v| start[v.index()]);
            orient3d(a, b, c, d) <= 0
        };
        let off: Vec<_> =
            moving.mesh().cells.tets().filter(|(_, tet)| is_off(*tet)).map(|tet| tet.0).collect();
        assert_eq!(step.inverted_at_start.map_or(0, |found| found.tets), off.len(), "step {k}");
        if let Some(found) = step.inverted_at_start {
            assert!(off.contains(&found.worst.cell) && found.worst.eas <= 0.0);
            n_off += 1;
        }
    }
    (n_off, worst)
}

#[test]
fn tets_that_are_inverted_where_the_step_began_are_reported_and_avoided_on_request() {
    // A mesh that is improved as well has none in these steps.
    let options = Options { improve_below: 0.0, ..options() };
    let (n_off, _) = steps_off_at_start(options.clone());
    assert!(n_off > 0, "steps are large enough for some");
    for improve_below in [0.0, 0.75] {
        let valid = Options { valid_at_start: true, improve_below, ..options.clone() };
        let (n_off, worst) = steps_off_at_start(valid);
        assert_eq!(n_off, 0);
        assert!(worst > 0.05, "{worst}");
    }
}

#[test]
fn a_run_that_is_saved_and_loaded_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    let mesh = box_mesh();
    let watched = || {
        let watch = Watching {
            patches: vec!["sphere".into(), "box".into()],
            options: contact::Options { warn: Some(1.5), ..contact::Options::default() },
            horizon: Some(3.0),
            hold: None,
        };
        Options { watch: Some(watch), ..options() }
    };
    let mut whole = MovingMesh::new(&mesh, watched(), &threads()).unwrap();
    let mut broken = MovingMesh::new(&mesh, watched(), &Threads::new(2).unwrap()).unwrap();
    for k in 1..=14 {
        let displacement = sphere_goes(&whole, along(cycle(k)));
        let a = whole.advance(k as f64, &displacement, &threads()).unwrap();
        broken.save(&file).unwrap();
        // Every second time with more threads.
        let threads = Threads::new(1 + k % 2).unwrap();
        broken = MovingMesh::load(&file, watched(), &threads).unwrap();
        assert_eq!(broken.driven_places(), whole.driven_places());
        let b = broken.advance(k as f64, &displacement, &threads).unwrap();
        assert_eq!((a.bad, a.legs, a.worst, &a.gaps), (b.bad, b.legs, b.worst, &b.gaps));
        assert_eq!(broken.mesh(), whole.mesh(), "step {k}");
        assert_eq!(broken.velocity(), whole.velocity());
        assert!(broken.remembers(k - 1) && (k < 2 || !broken.remembers(k - 2)));
    }
}

#[test]
fn a_state_keeps_the_arrays_in_their_order_and_knows_its_options() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    let mut mesh = box_mesh();
    // Labels under a name for which writers add their own field.
    let labels = mesh.cell_data.iter_mut().find(|field| field.name == "patch").unwrap();
    labels.name = "gmsh:physical".into();
    mesh.cell_data.retain(|field| field.name != "region");
    let mut whole = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    whole.advance(1.0, &sphere_goes(&whole, shift([0.4, 0.0, 0.0])), &threads()).unwrap();
    whole.save(&file).unwrap();
    let mut loaded = MovingMesh::load(&file, Options { remembered: 1, ..options() }, &threads()).unwrap();
    assert_eq!(loaded.mesh(), whole.mesh());
    for moving in [&mut whole, &mut loaded] {
        let n = moving.mesh().cells.len();
        moving.set_cell_field(Field::scalars("later", vec![1.0; n])).unwrap();
    }
    assert_eq!(loaded.mesh(), whole.mesh());
    let reported = loaded.history_since(0).unwrap_err().to_string();
    assert!(reported.contains("since step 0 are not known, only those since step 1"), "{reported}");
    assert!(loaded.history_since(1).unwrap().is_none());
    // Other options cannot resume.
    let mut other = options();
    other.motion.smooth = 0;
    let reported = MovingMesh::load(&file, other, &threads()).unwrap_err();
    assert_eq!(reported.kind(), ErrorKind::Options);
    assert!(reported.to_string().contains("motion.smooth was 2 and is 0"), "{reported}");
}

#[test]
fn what_is_no_state_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    let mesh = sphere_in_box(2, 2);
    motet::io::write(&file, &mesh, &motet::io::WriteOptions::default()).unwrap();
    let reported = MovingMesh::load(&file, Options::default(), &threads()).unwrap_err();
    assert_eq!(reported.kind(), ErrorKind::Input);
    assert!(
        reported.to_string().contains("state.vtu") && reported.to_string().contains("not a saved state"),
        "{reported}"
    );
    MovingMesh::new(&mesh, Options::default(), &threads()).unwrap().save(&file).unwrap();
    let saved = motet::io::read(&file).unwrap();
    let damaged = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = saved.clone();
        change(&mut mesh);
        motet::io::write(&file, &mesh, &motet::io::WriteOptions::default()).unwrap();
        MovingMesh::load(&file, Options::default(), &threads()).unwrap_err().to_string()
    };
    let node = |mesh: &mut Mesh| {
        let n = mesh.points.len();
        mesh.set_point_field(Field::scalars("moving:node", vec![4_000_000_u32; n]));
    };
    assert!(damaged(&node).contains("moving:node"));
    assert!(damaged(&|mesh| mesh.field_data.retain(|f| f.name != "moving:clock")).contains("moving:clock"));
    assert!(damaged(&|mesh| mesh.point_data.retain(|f| f.name != "moving:first")).contains("moving:first"));
}

#[test]
fn what_cannot_be_done_leaves_all_as_it_was() -> Result<()> {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, options(), &threads())?;
    let far = sphere_goes(&moving, shift([2.9, 0.0, 0.0]));
    moving.advance(1.0, &sphere_goes(&moving, shift([0.5, 0.0, 0.0])), &threads())?;
    let (before, velocity) = (moving.mesh().clone(), moving.velocity());
    let mut broken = far.clone();
    broken[7][1] = f64::NAN;
    let watch = Watch::new();
    watch.stop();
    let stopped = Threads::single().watched(&watch);
    let reported = [
        moving.advance(2.0, &far[1..], &threads()).unwrap_err(),
        moving.advance(2.0, &broken, &threads()).unwrap_err(),
        moving.advance(1.0, &far, &threads()).unwrap_err(),
        moving.advance(f64::INFINITY, &far, &threads()).unwrap_err(),
        moving.advance(2.0, &far, &stopped).unwrap_err(),
    ];
    for (error, part) in
        reported.iter().zip(["driven", "vertex 7", "not after the current time 1", "not after", "stopped"])
    {
        assert!(error.to_string().contains(part), "{error}");
    }
    assert_eq!((moving.mesh(), moving.velocity(), moving.step()), (&before, velocity, 1));
    assert!(moving.set_cell_field(Field::scalars("p", vec![0.0; 3])).is_err());
    assert!(moving.advance(2.0, &far, &threads())?.complete);
    Ok(())
}

#[test]
fn without_repair_a_motion_ends_where_a_cell_would_turn_over() {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, Options { repair: None, ..options() }, &threads()).unwrap();
    let n_cells = mesh.cells.len();
    let through = sphere_goes(&moving, shift([4.2, 0.0, 0.0]));
    let step = moving.advance(1.0, &through, &threads()).unwrap();
    assert!(!step.complete && step.fraction > 0.5 && step.fraction < 1.0 && step.inverted == 0);
    assert_eq!(step.time, step.fraction);
    assert_eq!(moving.mesh().cells.len(), n_cells);
    // With repair, the sphere does not go through the wall, either.
    let mut moving = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    let step = moving.advance(1.0, &through, &threads()).unwrap();
    assert!(!step.complete && step.inverted == 0, "{step:?}");
}

#[test]
fn what_is_refined_moves_on_and_comes_back() {
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, options(), &threads()).unwrap();
    let wanted = Wanted {
        criteria: vec![Criterion::Ball { centre: [0.0; 3], radius: 1.3 }],
        generations: Some(1),
        ..Wanted::default()
    };
    moving.advance(1.0, &sphere_goes(&moving, shift([0.3, 0.0, 0.0])), &threads()).unwrap();
    let change = moving.refine(&wanted, &threads()).unwrap().pop().expect("something was divided");
    assert!(change.why == Why::Refinement && change.tets_after > change.tets_before && change.time == 1.0);
    let n_divided = moving.mesh().cells.len();
    assert!(check::check(moving.mesh()).is_empty());
    // Displacements are still those of the initial walls: new vertices of the sphere follow the triangles
    // that they divide.
    for k in 2..=6 {
        let by = [0.3 * k as f64, 0.0, 0.0];
        let step = moving.advance(k as f64, &sphere_goes(&moving, shift(by)), &threads()).unwrap();
        assert!(step.complete && step.inverted == 0 && step.bad == 0);
        let of_sphere = moving.displacement().into_iter().zip(&moving.mesh().points);
        let near = of_sphere.filter(|(d, p)| norm(sub(**p, *d)) < 1.0 + 1e-9);
        near.for_each(|(d, _)| assert!(norm(sub(d, by)) < 1e-12, "{d:?}"));
    }
    for k in (0..=5).rev() {
        let by = [0.3 * f64::from(k), 0.0, 0.0];
        let step = moving.advance(12.0 - f64::from(k), &sphere_goes(&moving, shift(by)), &threads()).unwrap();
        assert!(step.complete && step.bad == 0);
    }
    let back = Wanted { coarsen: true, ..Wanted::default() };
    assert_eq!(moving.refine(&back, &threads()).unwrap().len(), 1, "something was taken back");
    println!(
        "{} cells at first, {n_divided} divided, {} at the end",
        mesh.cells.len(),
        moving.mesh().cells.len()
    );
    assert!(moving.mesh().cells.len() < n_divided);
}

#[test]
fn what_cells_hold_stays_where_divisions_are_taken_back_after_a_motion() {
    let mesh = box_mesh();
    let held = Options { contents: vec!["dye".into()], ..options() };
    let mut moving = MovingMesh::new(&mesh, held, &threads()).unwrap();
    let first = content(moving.mesh(), "dye");
    let all = Criterion::Ball { centre: [0.0; 3], radius: 2.0 };
    let fine = Wanted { criteria: vec![all], generations: Some(1), ..Wanted::default() };
    assert_eq!(moving.refine(&fine, &threads()).unwrap().len(), 1, "something was divided");
    let mut deviation: f64 = 0.0;
    for (k, by) in [0.4, 0.9, 1.5].into_iter().enumerate() {
        let displacement = sphere_goes(&moving, shift([by, 0.2 * by, 0.0]));
        moving.advance(1.0 + k as f64, &displacement, &threads()).unwrap();
        // Divisions near its current position are taken back.
        let near = Criterion::Ball { centre: [2.0 - by, 0.0, 0.0], radius: 1.0 };
        let back = Wanted { criteria: vec![near], coarsen: true, generations: Some(0), ..Wanted::default() };
        let change = moving.refine(&back, &threads()).unwrap().pop();
        deviation = change.map_or(deviation, |change| deviation.max(change.volume_deviation));
        let now = content(moving.mesh(), "dye");
        assert!((now - first).abs() < 1e-13 * first, "{by}: {now} for {first}");
    }
    assert!(deviation > 1e-6, "volumes differ, or nothing is tested: {deviation}");
}

#[test]
fn what_repairs_have_changed_is_taken_back_by_lengths() {
    let mesh = box_mesh();
    let held = Options { contents: vec!["dye".into()], ..options() };
    let mut moving = MovingMesh::new(&mesh, held, &threads()).unwrap();
    let (first, n_first) = (content(moving.mesh(), "dye"), moving.mesh().cells.tets().count());
    assert!(moving.coarsen(0.0, &threads()).unwrap().is_none(), "nothing is short");
    let near = Criterion::Ball { centre: [2.0, 0.0, 0.0], radius: 1.5 };
    let fine = Wanted { criteria: vec![near], generations: Some(2), ..Wanted::default() };
    assert_eq!(moving.refine(&fine, &threads()).unwrap().len(), 1, "something was divided");
    for (k, by) in [1.0, 2.0, 3.0, 1.5, 0.0].into_iter().enumerate() {
        let displacement = sphere_goes(&moving, shift([by, 0.0, 0.0]));
        moving.advance(1.0 + k as f64, &displacement, &threads()).unwrap();
    }
    let back = Wanted { coarsen: true, generations: Some(0), ..Wanted::default() };
    while !moving.refine(&back, &threads()).unwrap().is_empty() {}
    let n_left = moving.mesh().cells.tets().count();
    assert!(n_left as f64 > 1.3 * n_first as f64, "repairs have changed what was divided: {n_left}");
    moving.coarsen(0.0, &threads()).unwrap().expect("much is short");
    let n_now = moving.mesh().cells.tets().count();
    assert!((n_now as f64) < 0.7 * n_left as f64, "{n_first} tets became {n_left}, then {n_now}");
    moving.repair(&threads()).unwrap();
    let step = moving.certify(&threads()).unwrap();
    assert_eq!((step.bad, step.inverted), (0, 0));
    let now = content(moving.mesh(), "dye");
    assert!((now - first).abs() < 1e-13 * first, "{now} for {first}");
    let volumes = [&mesh, moving.mesh()].map(total_volume);
    assert!((volumes[0] - volumes[1]).abs() < 1e-9 * volumes[0], "walls keep their place: {volumes:?}");
}

#[test]
fn what_comes_near_is_warned_of_before_it_is_there() {
    let mesh = box_mesh();
    let watch = Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options { warn: Some(1.2), ..contact::Options::default() },
        horizon: Some(100.0),
        hold: None,
    };
    let mut moving = MovingMesh::new(&mesh, Options { watch: Some(watch), ..options() }, &threads()).unwrap();
    for k in 1..=6 {
        let by = 0.5 * f64::from(k);
        let step =
            moving.advance(f64::from(k), &sphere_goes(&moving, shift([by, 0.0, 0.0])), &threads()).unwrap();
        let gaps = step.gaps.unwrap();
        // The sphere's triangles lie within it, with their vertices on it.
        assert!((gaps.least.unwrap() - (4.0 - by)).abs() < 1e-12);
        assert_eq!(gaps.warned > 0, by > 2.8, "{by}: {gaps:?}");
        let touch = gaps.touch_not_before.unwrap();
        assert!(touch <= (4.0 - by) / 0.5 && touch > 0.99 * (4.0 - by) / 0.5);
        assert_eq!(gaps.pairs[0].patches, ["sphere", "box"]);
        assert!(moving.gaps().unwrap().least() == gaps.least.unwrap());
    }
}

fn kept_apart(hold: f64) -> Options {
    let watch = Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options { warn: Some(1.2), ..contact::Options::default() },
        horizon: None,
        hold: Some(hold),
    };
    Options { watch: Some(watch), ..options() }
}

#[test]
fn what_is_reported_to_go_through_a_wall_stops_in_front_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    let mesh = box_mesh();
    let mut moving = MovingMesh::new(&mesh, kept_apart(0.5), &threads()).unwrap();
    // In a corner of the box, finally nearer to both of its walls than permitted, and back.
    for (k, by) in [1.0, 2.0, 3.0, 3.6, 3.8, 3.6, 2.0, 0.0].into_iter().enumerate() {
        let displacement = sphere_goes(&moving, shift([by, by, 0.0]));
        let step = moving.advance(1.0 + k as f64, &displacement, &threads()).unwrap();
        let gaps = step.gaps.unwrap();
        assert!(step.complete && step.inverted == 0);
        assert_eq!(gaps.held > 0, by > 3.5, "{by}");
        assert!((gaps.least.unwrap() - (4.0 - by).max(0.5)).abs() < 1e-12, "{by}: {:?}", gaps.least);
        // The saved state continues alike.
        moving.save(&file).unwrap();
        moving = MovingMesh::load(&file, kept_apart(0.5), &threads()).unwrap();
    }
    let at_first: Vec<Point> = mesh.points.iter().copied().filter(|p| is_sphere(*p)).collect();
    let is_there = |p: &Point| moving.mesh().points.iter().any(|q| norm(sub(*p, *q)) < 1e-12);
    assert!(at_first.iter().all(is_there), "the sphere is back where it was");
}

#[test]
fn what_is_requested_to_be_beyond_a_wall_stops_in_front_of_it() {
    let mut moving = MovingMesh::new(&box_mesh(), kept_apart(0.5), &threads()).unwrap();
    // From one side of the box to beyond the opposite one in a step, and back.
    for (k, by) in [2.0, 3.0, 5.0, 40.0, 5.0, -7.0, 0.0].into_iter().enumerate() {
        let displacement = sphere_goes(&moving, shift([by, 0.0, 0.0]));
        let step = moving.advance(1.0 + k as f64, &displacement, &threads()).unwrap();
        let gaps = step.gaps.unwrap();
        assert!(step.complete && step.inverted == 0, "{by}: {}", step.fraction);
        let (gap, expected) = (gaps.least.unwrap(), (4.0 - by.abs()).max(0.5));
        assert!(gap > expected * (1.0 - 1e-9) && gap < expected * (1.0 + 1e-4), "{by}: {gap}");
        assert_eq!(
            (gaps.held > 0, gaps.farthest_held.is_some(), gaps.cramped),
            (by.abs() > 3.5, by.abs() > 3.5, None)
        );
        if let Some(held) = gaps.farthest_held {
            assert_eq!(held.patch, "sphere");
            // Pushes fall short by a quarter of the distance at most.
            let beyond = held.short - (by.abs() - 3.5);
            assert!((-1e-9..0.125).contains(&beyond), "{by}: {held:?}");
        }
    }
}

#[test]
fn walls_that_cannot_be_kept_apart_are_reported() {
    let mesh = box_mesh();
    for hold in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let reported = MovingMesh::new(&mesh, kept_apart(hold), &threads()).unwrap_err();
        assert_eq!(reported.kind(), ErrorKind::Options);
    }
    // Saved without `hold`: there is nothing to keep apart.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    MovingMesh::new(&mesh, options(), &threads()).unwrap().save(&file).unwrap();
    let reported = MovingMesh::load(&file, kept_apart(0.5), &threads()).unwrap_err();
    assert!(reported.to_string().contains("watch"), "{reported}");
}

#[test]
fn what_comes_bad_is_repaired_before_the_first_step() {
    // The vertices inside are displaced, a little farther each time, until tets are bad.
    let astray = |by: f64| {
        let mut mesh = box_mesh();
        let inner = |p: Point| norm(p) > 1.01 && p.iter().all(|x| x.abs() < 4.99);
        for (i, p) in mesh.points.iter_mut().enumerate().filter(|(_, p)| inner(**p)) {
            (0..3).for_each(|k| p[k] += by * ((7 * i + 3 * k) as f64).sin());
        }
        MovingMesh::new(&mesh, options(), &threads()).unwrap()
    };
    let mut certified = (1..20).map(|i| {
        let mut moving = astray(0.01 * f64::from(i));
        let step = moving.certify(&threads()).unwrap();
        (moving, step)
    });
    let (mut moving, before) = certified.find(|(_, step)| step.bad > 0).unwrap();
    assert_eq!(before.inverted, 0);
    let change = moving.repair(&threads()).unwrap().expect("something was repaired");
    assert_eq!((change.why, change.bad_before, change.time), (Why::Repair, before.bad, 0.0));
    assert_eq!(moving.certify(&threads()).unwrap().bad, 0);
    assert!(moving.repair(&threads()).unwrap().is_none());
    assert_eq!(moving.velocity(), vec![[0.0; 3]; moving.mesh().points.len()]);
    let step = moving.advance(1.0, &sphere_goes(&moving, shift([0.3, 0.0, 0.0])), &threads()).unwrap();
    assert!(step.complete && step.bad == 0);
}

#[test]
fn wedges_at_the_wall_stay_and_tets_inside_are_repaired() {
    let mesh = tube(&TubeOptions { wall_layers: 3, wall_cells: WallCells::Wedges, ..TubeOptions::default() });
    let mut moving = MovingMesh::new(&mesh, Options::default(), &threads()).unwrap();
    let kinds = |mesh: &Mesh| mesh.cells.counts();
    let wedges = |mesh: &Mesh| kinds(mesh).into_iter().find(|(k, _)| *k == motet::mesh::CellKind::WEDGE);
    for k in 1..=4 {
        // The vessel bends.
        let bend = |p: &Point| [0.02 * f64::from(k) * p[2] * p[2], 0.0, 0.0];
        let displacement: Vec<Point> = moving.driven_places().iter().map(bend).collect();
        let step = moving.advance(f64::from(k), &displacement, &threads()).unwrap();
        assert!(step.complete && step.inverted == 0);
        assert_eq!(wedges(moving.mesh()), wedges(&mesh));
    }
}
