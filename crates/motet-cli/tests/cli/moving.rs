//! `motet move`: what it writes, what it reports, what it refuses.

use std::time::{Duration, Instant};

use crate::common::{Folder, cube, stderr, stdout};
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::io::{read, read_series};
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field, bounds};
use serde_json::Value;

const AFFINE: [[f64; 4]; 3] = [[1.1, 0.05, -0.02, 0.3], [0.03, 0.9, 0.04, -0.2], [-0.01, 0.02, 1.05, 0.1]];

fn affine_word() -> String {
    AFFINE.as_flattened().iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// The largest distance of `moved` from the affine image of `reference`, over the box of that image.
fn affine_error(reference: &[Point], moved: &[Point]) -> f64 {
    let image = |p: &Point| AFFINE.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d);
    let images: Vec<Point> = reference.iter().map(image).collect();
    let [low, high] = bounds(&images).expect("points");
    let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    images.iter().zip(moved).flat_map(|(a, b)| (0..3).map(move |i| (a[i] - b[i]).abs())).fold(0.0, f64::max)
        / size
}

fn report(call: &assert_cmd::assert::Assert) -> Value {
    serde_json::from_str(&stdout(call)).expect("one object")
}

#[test]
fn an_affine_motion_of_the_boundary_moves_every_vertex_affinely() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(6, 4));
    folder.motet(["move", "box.vtu", "-o", "out.vtu", "--affine", &affine_word()]).assert().code(0);
    let (before, after) = (read(folder.path("box.vtu")).unwrap(), read(folder.path("out.vtu")).unwrap());
    let error = affine_error(&before.points, &after.points);
    assert!(error < 1e-10, "{error:.3e}");
}

#[test]
fn a_patch_is_shifted_in_steps_and_a_series_written() {
    let folder = Folder::new();
    let mesh = sphere_in_box(6, 4);
    folder.mesh("box.vtu", &mesh);
    let words = [
        "move",
        "box.vtu",
        "-o",
        "out.pvd",
        "--translate",
        "sphere=1,0,0",
        "--steps",
        "4",
        "--dt",
        "0.5",
        "--json",
    ];
    let reported = report(&folder.motet(words).assert().code(0));
    assert_eq!(reported["complete"], true);
    assert_eq!(reported["steps"].as_array().map(Vec::len), Some(5));
    for key in ["points", "cells", "untouched", "setup", "before", "after", "seconds"] {
        assert!(!reported[key].is_null(), "{key}");
    }
    for key in ["worst_eas", "bad", "inverted", "substeps", "fraction", "time", "file"] {
        assert!(!reported["steps"][4][key].is_null(), "{key}");
    }
    let series = read_series(folder.path("out.pvd")).unwrap();
    assert_eq!(series.iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0.0, 0.5, 1.0, 1.5, 2.0]);
    let first = read(&series[0].1).unwrap();
    assert_eq!(first.points, mesh.points);
    let last = read(&series[4].1).unwrap();
    let displacement = last.point_field("displacement").unwrap().to_vectors().unwrap();
    let shifted = |v: VertexId| {
        last.points[v.index()]
            == [mesh.points[v.index()][0] + 1.0, mesh.points[v.index()][1], mesh.points[v.index()][2]]
    };
    let velocity = last.point_field("velocity").unwrap().to_vectors().unwrap();
    let patches = mesh.patches().unwrap();
    let of_patch = |name: &str| {
        let id = patches.find(name).unwrap();
        let cells = mesh.cells.iter().filter(|(cell, _, _)| patches.ids[cell.index()] == id);
        cells.flat_map(|(_, _, vertices)| vertices.to_vec()).collect::<Vec<VertexId>>()
    };
    assert!(of_patch("sphere").into_iter().all(shifted));
    assert!(of_patch("sphere").iter().all(|v| (displacement[v.index()][0] - 1.0).abs() < 1e-15));
    assert!(of_patch("box").iter().all(|v| displacement[v.index()] == [0.0; 3]));
    assert!(of_patch("sphere").iter().all(|v| (velocity[v.index()][0] - 0.5).abs() < 1e-12));
    assert_eq!(last.cells, mesh.cells);
    assert!(last.cell_field("region").is_some() && last.cell_field("patch").is_some());
}

#[test]
fn a_motion_beyond_the_wall_stops_where_it_must_and_exits_4() {
    let folder = Folder::new();
    // With six quads per face, one vertex of the sphere is nearest to the wall.
    folder.mesh("box.vtu", &sphere_in_box(6, 3));
    let words = ["move", "box.vtu", "-o", "out.vtu", "--translate", "sphere=6,0,0", "--json"];
    let call = folder.motet(words).assert().code(4);
    let reported = report(&call);
    assert_eq!(reported["complete"], false);
    assert_eq!(reported["after"]["inverted"], 0);
    let fraction = reported["after"]["fraction"].as_f64().expect("a number");
    assert!(0.0 < fraction && fraction < 4.0 / 6.0, "{fraction}");
    let why = reported["not_reached"].as_str().expect("a reason");
    assert!(stderr(&call).contains(&format!("not reached: {why}")), "{}", stderr(&call));
    let mut near =
        folder.motet(["move", "box.vtu", "-o", "out.vtu", "--translate", "sphere=0.1,0,0", "--json"]);
    assert!(report(&near.assert().success())["not_reached"].is_null());
    assert!(read(folder.path("out.vtu")).is_ok());
}

/// The boundary of the cube as a surface of its own, with vertices picked by `keep`.
fn face(mesh: &Mesh, keep: impl Fn(Point) -> bool) -> (Mesh, Vec<VertexId>) {
    let boundary = motet::mesh::Boundary::of(&mesh.cells);
    let facets = boundary.facets.iter().filter(|f| f.iter().all(|v| keep(mesh.points[v.index()])));
    let facets: Vec<&[VertexId]> = facets.collect();
    let mut vertices: Vec<VertexId> = facets.iter().flat_map(|f| f.iter().copied()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut cells = Cells::new();
    for facet in facets {
        let place = |v: &VertexId| VertexId::new(vertices.binary_search(v).expect("collected above"));
        cells.push(CellKind::TRIANGLE, facet.iter().map(place));
    }
    (Mesh::new(vertices.iter().map(|v| mesh.points[v.index()]).collect(), cells), vertices)
}

fn grown(p: Point, by: f64) -> Point {
    [0.5 + (p[0] - 0.5) * (1.0 + by), 0.5 + (p[1] - 0.5) * (1.0 + by), p[2]]
}

#[test]
fn a_wall_follows_its_surfaces_while_the_ends_slide() {
    let folder = Folder::new();
    let mesh = cube(4);
    folder.mesh("cube.vtu", &mesh);
    let on_side = |p: Point| p[0] == 0.0 || p[0] == 1.0 || p[1] == 0.0 || p[1] == 1.0;
    let boundary_side = |f: Point| on_side(f);
    let (mut wall, vertices) = face(&mesh, boundary_side);
    folder.mesh("floor.vtp", &face(&mesh, |p| p[2] == 0.0).0);
    folder.mesh("lid.vtp", &face(&mesh, |p| p[2] == 1.0).0);
    let ids: Vec<i64> = vertices.iter().map(|v| i64::from(v.0) + 1).collect();
    wall.set_point_field(Field::scalars("GlobalNodeID", ids));
    let still = wall.points.clone();
    let mut entries = String::new();
    for (k, by) in [0.1, 0.2, 0.0].into_iter().enumerate() {
        wall.points = still.iter().map(|p| grown(*p, by)).collect();
        folder.mesh(&format!("wall{k}.vtp"), &wall);
        entries += &format!("<DataSet timestep=\"{k}.25\" file=\"wall{k}.vtp\"/>");
    }
    let pvd = format!("<VTKFile type=\"Collection\"><Collection>{entries}</Collection></VTKFile>");
    folder.write("wall.pvd", pvd.as_bytes());
    let words = [
        "move",
        "cube.vtu",
        "-o",
        "new/folder/out.pvd",
        "--displacement",
        "wall.pvd",
        "--patch",
        "floor=floor.vtp",
        "--patch",
        "lid=lid.vtp",
        "--slide",
        "floor",
        "--slide",
        "lid",
    ];
    folder.motet(words).assert().code(0);
    let series = read_series(folder.path("new/folder/out.pvd")).unwrap();
    assert_eq!(series.iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0.25, 1.25, 2.25]);
    let widest = read(&series[1].1).unwrap();
    for (p, q) in mesh.points.iter().zip(&widest.points) {
        let image = grown(*p, 0.2);
        assert!((0..3).all(|i| (q[i] - image[i]).abs() < 1e-12), "{p:?}: {q:?}, expected {image:?}");
    }
    assert_eq!(
        read(&series[2].1).unwrap().points,
        mesh.points,
        "a wall that comes back brings all vertices back"
    );
}

#[test]
fn displacements_of_nodes_over_time_are_written_and_read() {
    let folder = Folder::new();
    let mut mesh = cube(3);
    // With its own ids, as part of a larger model.
    let ids: Vec<i64> = (0..mesh.points.len() as i64).map(|v| 1000 - v).collect();
    mesh.set_point_field(Field::scalars("GlobalNodeID", ids));
    folder.mesh("cube.vtu", &mesh);
    let (lid, vertices) = face(&mesh, |p| p[2] == 1.0);
    folder.mesh("lid.vtp", &lid);
    let lift = ["--patch", "lid=lid.vtp", "--translate", "lid=0,0.1,0.25", "--dt", "0.5", "--steps", "2"];
    let words = ["move", "cube.vtu", "-o", "lifted.vtu", "--nodal", "lid=lid.dat"];
    folder.motet(words.iter().chain(&lift)).assert().code(0);
    let series = motet::io::NodalSeries::read(folder.path("lid.dat")).unwrap();
    assert_eq!(series.times, [0.0, 0.5, 1.0]);
    assert_eq!(series.ids, vertices.iter().map(|v| 1000 - v.index() as i64).collect::<Vec<_>>());
    assert!(series.vectors(0).unwrap().iter().all(|d| *d == [0.0; 3]));
    assert!(series.vectors(2).unwrap().iter().all(|d| (d[1] - 0.1).abs() + (d[2] - 0.25).abs() < 1e-15));
    folder.motet(["move", "cube.vtu", "-o", "again.pvd", "--displacement", "lid.dat"]).assert().code(0);
    let frames = read_series(folder.path("again.pvd")).unwrap();
    assert_eq!(frames.iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
    let (lifted, again) = (read(folder.path("lifted.vtu")).unwrap(), read(&frames[2].1).unwrap());
    for (p, q) in lifted.points.iter().zip(&again.points) {
        assert!((0..3).all(|i| (p[i] - q[i]).abs() < 1e-15), "{p:?} {q:?}");
    }
    for (words, code, reported) in [
        (["--displacement", "lid.dat", "--steps", "3"], 2, "omit --steps"),
        (["--displacement", "lid.dat", "--nodal", "lid=lid.dat"], 2, "would overwrite a file of the call"),
        (["--displacement", "lid.dat", "--nodal", "no=no.dat"], 2, "no patch `no`"),
        (["--displacement", "lid.dat", "--nodal", "lid=lid.dat/no.dat"], 3, "folder cannot be made"),
    ] {
        let call =
            folder.motet(["move", "cube.vtu", "-o", "no.vtu"].iter().chain(&words)).assert().code(code);
        assert!(stderr(&call).contains(reported), "{}", stderr(&call));
    }
    folder.write("strange.dat", b"3 1 1\n0\n17\n0 0 1\n");
    let call =
        folder.motet(["move", "cube.vtu", "-o", "no.vtu", "--displacement", "strange.dat"]).assert().code(3);
    assert!(
        stderr(&call).starts_with("error: strange.dat: point 0: no point of the mesh has GlobalNodeID 17"),
        "{}",
        stderr(&call)
    );
}

#[test]
fn a_surface_without_ids_is_matched_by_position_or_refused_with_numbers() {
    let folder = Folder::new();
    let mesh = cube(3);
    folder.mesh("cube.vtu", &mesh);
    let (mut lid, vertices) = face(&mesh, |p| p[2] == 1.0);
    lid.set_point_field(Field::vectors("displacement", &vec![[0.0, 0.0, 0.25]; vertices.len()]));
    folder.mesh("lid.vtp", &lid);
    folder.motet(["move", "cube.vtu", "-o", "out.vtu", "--displacement", "lid.vtp"]).assert().code(0);
    let moved = read(folder.path("out.vtu")).unwrap();
    assert!(vertices.iter().all(|v| moved.points[v.index()][2] == 1.25));
    lid.points.iter_mut().for_each(|p| p[2] += 0.25);
    folder.mesh("raised.vtp", &lid);
    let call =
        folder.motet(["move", "cube.vtu", "-o", "no.vtu", "--displacement", "raised.vtp"]).assert().code(3);
    let message = stderr(&call);
    assert!(message.starts_with("error: raised.vtp: point 0: 16 of the surface's 16 points"), "{message}");
    assert!(message.contains("2.500e-1") && message.contains("GlobalNodeID"), "{message}");
    assert!(!folder.path("no.vtu").exists());
}

#[test]
fn an_array_moves_the_boundary_and_its_inner_values_are_not_looked_at() {
    let folder = Folder::new();
    let mut mesh = cube(3);
    let boundary = motet::mesh::Boundary::of(&mesh.cells).vertices;
    let mut given = vec![[f64::NAN; 3]; mesh.points.len()];
    boundary.iter().for_each(|v| given[v.index()] = [0.1 * mesh.points[v.index()][0], 0.0, 0.0]);
    mesh.set_point_field(Field::vectors("u", &given));
    mesh.set_point_field(Field::scalars("p", vec![0.0; mesh.points.len()]));
    folder.mesh("cube.vtu", &mesh);
    folder
        .motet(["move", "cube.vtu", "-o", "out.vtu", "--displacement", "u", "--steps", "3"])
        .assert()
        .code(0);
    let moved = read(folder.path("out.vtu")).unwrap();
    for (p, q) in mesh.points.iter().zip(&moved.points) {
        assert!((q[0] - 1.1 * p[0]).abs() < 1e-12 && q[1] == p[1] && q[2] == p[2], "{p:?}: {q:?}");
    }
    let call = folder.motet(["move", "cube.vtu", "-o", "no.vtu", "--displacement", "v"]).assert().code(2);
    assert!(stderr(&call).contains("vector point arrays of the mesh: u"), "{}", stderr(&call));
    let call = folder.motet(["move", "cube.vtu", "-o", "no.vtu", "--displacement", "p"]).assert().code(3);
    assert!(stderr(&call).contains("array p"), "{}", stderr(&call));
}

#[test]
fn words_that_mean_nothing_are_refused_before_work() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(3, 2));
    let cases: &[(&[&str], &str)] = &[
        (&["move", "box.vtu", "-o", "out.vtu"], "required"),
        (&["move", "box.vtu", "-o", "out.docx", "--translate", "sphere=1,0,0"], "extension"),
        (&["move", "box.vtu", "-o", "out.vtu", "--translate", "ball=1,0,0"], "sphere, box"),
        (&["move", "box.vtu", "-o", "out.vtu", "--translate", "sphere=1,0"], "3 numbers"),
        (&["move", "box.vtu", "-o", "out.vtu", "--rotate", "sphere=0,0,0,90"], "nowhere"),
        (
            &["move", "box.vtu", "-o", "out.vtu", "--translate", "sphere=1,0,0", "--method", "magic"],
            "delaunay",
        ),
        (
            &["move", "box.vtu", "-o", "out.vtu", "--translate", "sphere=1,0,0", "--rigid-layer", "thick"],
            "3layers",
        ),
        (
            &[
                "move",
                "box.vtu",
                "-o",
                "out.vtu",
                "--translate",
                "sphere=1,0,0",
                "--affine",
                "1,0,0,0,0,1,0,0,0,0,1,0",
            ],
            "cannot be used with",
        ),
    ];
    for (words, part) in cases {
        let call = folder.motet(*words).assert().code(2);
        assert!(stderr(&call).contains(part), "{words:?}: {}", stderr(&call));
    }
    assert_eq!(folder.names(), ["box.vtu"]);
}

#[test]
fn a_patch_that_is_fixed_stays_also_where_it_meets_one_that_moves() {
    let folder = Folder::new();
    let mesh = cube(3);
    folder.mesh("cube.vtu", &mesh);
    folder.mesh("lid.vtp", &face(&mesh, |p| p[2] == 1.0).0);
    folder.mesh("side.vtp", &face(&mesh, |p| p[0] == 0.0).0);
    let words = [
        "move",
        "cube.vtu",
        "-o",
        "out.vtu",
        "--patch",
        "lid=lid.vtp",
        "--patch",
        "side=side.vtp",
        "--rotate",
        "lid=0,0,1,10",
        "--translate",
        "lid=0,0,0.1",
        "--fixed",
        "side",
    ];
    folder.motet(words).assert().code(0);
    let moved = read(folder.path("out.vtu")).unwrap();
    for (p, q) in mesh.points.iter().zip(&moved.points) {
        assert!(p[0] != 0.0 || p == q, "{p:?}");
        assert!(p[0] == 0.0 || p[2] != 1.0 || (q[2] - 1.1).abs() < 1e-15, "{p:?}");
    }
}

#[test]
fn the_bytes_of_a_motion_do_not_depend_on_the_threads() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(8, 5));
    for (threads, out) in [("1", "one.vtu"), ("2", "two.vtu"), ("3", "three.vtu")] {
        let words = ["move", "box.vtu", "-o", out, "--translate", "sphere=2,0.5,0", "--threads", threads];
        folder.motet(words).assert().code(0);
    }
    assert_eq!(folder.read("one.vtu"), folder.read("two.vtu"));
    assert_eq!(folder.read("one.vtu"), folder.read("three.vtu"));
}

#[test]
fn a_run_that_is_killed_leaves_a_whole_shorter_series() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(10, 6));
    let mut run = std::process::Command::new(assert_cmd::cargo::cargo_bin!("motet"))
        .current_dir(folder.path("."))
        .args(["move", "box.vtu", "-o", "out.pvd", "--translate", "sphere=1,0,0", "--steps", "100000", "-q"])
        .spawn()
        .expect("the program starts");
    let begin = Instant::now();
    while !folder.path("out_0003.vtu").exists() && begin.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    run.kill().expect("the program runs");
    run.wait().expect("the program ends");
    let series = read_series(folder.path("out.pvd")).unwrap();
    assert!(series.len() >= 3 && series.len() < 100_000, "{}", series.len());
    for (_, file) in series {
        read(file).unwrap();
    }
}

#[test]
fn a_series_that_another_process_writes_is_left_alone() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &box_grid([2; 3], [[0.0; 3], [1.0; 3]]));
    let held = motet::io::OutputLock::take(&folder.path("out.pvd")).unwrap();
    let words = ["move", "box.vtu", "-o", "out.pvd", "--translate", "zmax=0,0,0.1", "--steps", "2"];
    let message = stderr(&folder.motet(words).assert().code(1));
    assert!(message.contains("out.pvd") && message.contains(&std::process::id().to_string()), "{message}");
    assert!(!folder.path("out_0000.vtu").exists() && !folder.path("out.pvd").exists());
    drop(held);
    folder.motet(words).assert().code(0);
    assert_eq!(folder.names(), ["box.vtu", "out.pvd", "out_0000.vtu", "out_0001.vtu", "out_0002.vtu"]);
}

#[test]
fn a_body_turns_by_a_right_angle_and_takes_the_cells_along() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(11, 6));
    let turn = ["move", "box.vtu", "-o", "out.vtu", "--rotate", "sphere=0,0,1,90", "--method", "bodies"];
    for more in [&[][..], &["--body", "sphere"], &["--within-walls"]] {
        let call = folder.motet(turn.iter().chain(more).chain(&["--json"])).assert().code(0);
        let report = report(&call);
        let certificate = &report["steps"][0];
        assert_eq!((&certificate["inverted"], &certificate["substeps"]), (&Value::from(0), &Value::from(0)));
    }
    let call = folder.motet([&turn[..6], &["--body", "sphere"]].concat()).assert().code(2);
    assert!(stderr(&call).contains("--method bodies"));
}

#[test]
fn the_cheapest_method_that_keeps_the_mesh_good_is_taken() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(11, 6));
    let auto = |motion: [&str; 2], more: &[&str]| {
        let words = ["move", "box.vtu", "-o", "out.vtu", "--method", "auto", "--steps", "2", "--json"];
        report(&folder.motet(words.iter().chain(&motion).chain(more)).assert().code(0))
    };
    let reported = auto(["--translate", "sphere=0.3,0,0"], &[]);
    assert_eq!(reported["choice"]["method"], "delaunay");
    assert_eq!(reported["choice"]["tried"].as_array().unwrap().len(), 1);
    let reported = auto(["--rotate", "sphere=0,0,1,90"], &["--smooth", "2"]);
    assert_eq!(reported["choice"]["method"], "bodies");
    assert!(
        reported["choice"]["tried"][0]["kept"] == false && reported["choice"]["tried"][1]["kept"] == true
    );
    let least = reported["choice"]["least"].as_f64().unwrap();
    assert!(reported["after"]["worst_eas"]["value"].as_f64().unwrap() >= least);
    // No method is as good as that: the best is taken, and a message says so.
    let words = [
        "move",
        "box.vtu",
        "-o",
        "out.vtu",
        "--method",
        "auto",
        "--least",
        "0.9",
        "--translate",
        "sphere=0.3,0,0",
    ];
    let call = folder.motet(words).assert().code(0);
    assert!(stderr(&call).contains("no method keeps every cell"));
    let call = folder
        .motet(["move", "box.vtu", "-o", "out.vtu", "--least", "0.1", "--translate", "sphere=1,0,0"])
        .assert()
        .code(2);
    assert!(stderr(&call).contains("--method auto"));
}

#[test]
fn a_factor_is_kept_where_there_is_room_for_it() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(6, 4));
    let move_it = |out: &str, more: &[&str]| {
        let words = ["move", "box.vtu", "-o", out, "--translate", "sphere=0.3,0.1,0", "--json", "--method"];
        folder.motet(words.iter().chain(more))
    };
    let iterated = report(&move_it("iterated.vtu", &["elastic", "--residual", "1e-11"]).assert().code(0));
    let exact = report(&move_it("exact.vtu", &["elastic", "--factor", "0.5"]).assert().code(0));
    let no_room = report(&move_it("no_room.vtu", &["elastic", "--factor", "1e-6"]).assert().code(0));
    assert!(exact["setup"]["factor_bytes"].as_u64().unwrap() > 100_000);
    assert!(exact["steps"][0]["iterations"] == 0 && iterated["steps"][0]["iterations"] != 0);
    assert!(no_room["setup"]["factor_bytes"] == 0 && no_room["steps"][0]["iterations"] != 0);
    let worst = |report: &Value| report["after"]["worst_eas"]["value"].as_f64().unwrap();
    assert!((worst(&exact) - worst(&iterated)).abs() < 1e-6);
    let call = move_it("none.vtu", &["delaunay", "--factor", "1"]).assert().code(2);
    assert!(stderr(&call).contains("--method elastic"));
}
