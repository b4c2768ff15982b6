//! `motet implant`: what it puts in, what it reports, what it refuses.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::Point;
use motet::io::read;
use motet::mesh::check::check;
use motet::mesh::history::History;
use motet::mesh::shapes::{Aneurysm, Coil, ball, box_grid};
use motet::mesh::{CellKind, Cells, Field, Surface};
use serde_json::Value;

fn small_ball(radius: f64, x: f64) -> Mesh {
    let mut mesh = ball(3, 2);
    mesh.points.iter_mut().for_each(|p| *p = [x + radius * p[0], radius * p[1], radius * p[2]]);
    mesh
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("host.vtu", &box_grid([6; 3], [[-1.5; 3], [1.5; 3]]));
    let coil = Coil { centre: [0.0; 3], radius: 0.6, pitch: 0.5, turns: 2.0, wire_radius: 0.12 };
    folder.mesh("coil.stl", &coil.mesh(40, 8).unwrap());
    folder.mesh("ball.vtu", &small_ball(0.5, 0.0));
    folder
}

fn report(folder: &Folder, words: &[&str]) -> Value {
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    serde_json::from_str(&stdout(&call)).expect("one object")
}

#[test]
fn a_coil_and_what_the_report_says_of_it() {
    let folder = folder();
    let words = ["implant", "host.vtu", "coil.stl", "-o", "out.vtu", "--quality", "--history", "h.json"];
    let reported = report(&folder, &words);
    assert_eq!(
        (&reported["complete"], &reported["valid"], &reported["unforced"]),
        (&true.into(), &true.into(), &0.into())
    );
    assert!(reported["volume_deviation"].as_f64().unwrap() < 1e-9);
    let device = &reported["report"]["devices"][0];
    assert_eq!(device["triangles"], device["triangles_kept"]);
    assert_eq!((device["name"].as_str(), device["regions"][0].as_i64()), (Some("coil"), Some(2)));
    let mesh = read(folder.path("out.vtu")).unwrap();
    assert!(check(&mesh).is_empty());
    assert!(mesh.cell_field("eas").is_some());
    assert_eq!(mesh.regions().unwrap().find("coil"), Some(2));
    let patch = mesh.patches().unwrap();
    let n = patch.ids.iter().filter(|id| Some(**id) == patch.find("coil")).count();
    assert_eq!(n as u64, device["triangles"].as_u64().unwrap());
    let history: History = serde_json::from_slice(&folder.read("h.json")).unwrap();
    assert_eq!((history.vertices.len(), history.cells.len()), (mesh.points.len(), mesh.cells.len()));
    // Output for people, and the same result a second time.
    let call =
        folder.motet(["implant", "host.vtu", "coil.stl", "-o", "again.vtu", "--quality"]).assert().code(0);
    for what in ["tets carved; kept to the bit", "coil", "volume 27", "wrote again.vtu"] {
        assert!(stdout(&call).contains(what), "{what}");
    }
    assert_eq!(folder.read("out.vtu"), folder.read("again.vtu"));
}

#[test]
fn devices_keep_their_tets_are_filled_or_hollow() {
    let folder = folder();
    let regions = |words: &[&str]| {
        let reported =
            report(&folder, &[&["implant", "host.vtu", "ball.vtu", "-o", "out.vtu"], words].concat());
        let mesh = read(folder.path("out.vtu")).unwrap();
        let ids = mesh.regions().unwrap().ids;
        (reported["report"]["regions"].as_array().unwrap().len(), ids.iter().filter(|id| **id == 2).count())
    };
    let n_own = ball(3, 2).cells.tets().count();
    assert_eq!(regions(&[]), (2, n_own));
    let (n, n_new) = regions(&["--fill"]);
    assert!(n == 2 && n_new != n_own);
    assert_eq!(regions(&["--hollow"]), (1, 0));
    folder.mesh("ball_2.vtu", &small_ball(0.3, 0.9));
    let reported = report(&folder, &["implant", "host.vtu", "ball.vtu", "ball_2.vtu", "-o", "out.vtu"]);
    let names: Vec<_> = reported["report"]["devices"]
        .as_array()
        .unwrap()
        .iter()
        .map(|d| d["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["ball", "ball_2"]);
}

#[test]
fn a_device_through_a_wall_is_cut_off_or_kept() {
    let folder = folder();
    folder.mesh("wall.vtu", &small_ball(0.5, 1.2));
    let words = ["implant", "host.vtu", "wall.vtu", "-o", "out.vtu", "--fill", "--stray", "0.01"];
    let reported = report(&folder, &words);
    let device = &reported["report"]["devices"][0];
    let n = |key: &str| device[key].as_u64().unwrap();
    assert_eq!(n("triangles"), n("triangles_kept") + n("triangles_at_walls") + n("triangles_outside"));
    assert!(n("triangles_at_walls") > 0 && reported["report"]["volume"].as_f64().unwrap() < 27.01);
    let mesh = read(folder.path("out.vtu")).unwrap();
    assert!(check(&mesh).is_empty());
    assert_eq!(
        mesh.patches().unwrap().find("wall-contact"),
        device["contact_patch"].as_i64().map(|id| id as i32)
    );
    let reported = report(&folder, &[&words[..], &["--outside", "keep"]].concat());
    assert!(reported["report"]["volume"].as_f64().unwrap() > 27.01);
    assert!(reported["report"]["devices"][0]["contact_patch"].is_null());
    let call = folder.motet(words).assert().code(0);
    assert!(stdout(&call).contains("wall: meets walls of the host"), "{}", stdout(&call));
}

#[test]
fn arrays_begin_in_devices_with_what_is_given() {
    let folder = folder();
    let mut host = read(folder.path("host.vtu")).unwrap();
    host.set_point_field(Field::vectors("u", &vec![[1.0, 2.0, 3.0]; host.points.len()]));
    host.set_cell_field(Field::scalars("c", vec![5i32; host.cells.len()]));
    folder.mesh("with.vtu", &host);
    report(
        &folder,
        &["implant", "with.vtu", "ball.vtu", "-o", "out.vtu", "--value", "u=0,0.5,0", "--value", "c=7"],
    );
    let mesh = read(folder.path("out.vtu")).unwrap();
    let (u, c) = (mesh.point_field("u").unwrap().to_vectors().unwrap(), mesh.cell_field("c").unwrap());
    for (p, u) in mesh.points.iter().zip(&u) {
        // The surface belongs to the host as well.
        let is_within =
            p.iter().map(|x| x * x).sum::<f64>().sqrt() < 0.49 && p.iter().any(|x| x.abs() < 0.49);
        let expected = if is_within && *u != [1.0, 2.0, 3.0] { [0.0, 0.5, 0.0] } else { [1.0, 2.0, 3.0] };
        assert_eq!(*u, expected);
    }
    assert_eq!(u.iter().filter(|u| **u == [0.0, 0.5, 0.0]).count(), n_inside(&small_ball(0.5, 0.0)));
    let ids = mesh.regions().unwrap().ids;
    for (cell, _) in mesh.cells.tets() {
        let expected = if ids[cell.index()] == 2 { 7.0 } else { 5.0 };
        assert_eq!(c.values.get_f64(cell.index()), Some(expected));
    }
    let refused = |value: &str, what: &str| {
        let words = ["implant", "with.vtu", "ball.vtu", "-o", "no.vtu", "--value", value];
        assert!(stderr(&folder.motet(words).assert().code(2)).contains(what), "{value}");
    };
    refused("x=1", "no array of that name");
    refused("u=1", "got 1 numbers for 3 components");
    refused("c=0.5", "the array cannot hold");
    refused("region=3", "holds the regions");
    refused("c=a", "not a finite number");
}

/// The number of points of a mesh that are not on its boundary.
fn n_inside(mesh: &Mesh) -> usize {
    mesh.points.len() - Surface::boundary_of(mesh).vertices().len()
}

#[test]
fn an_implanted_mesh_moves_with_its_wall_and_is_repaired() {
    let folder = folder();
    let aneurysm = Aneurysm { around: 24, ..Aneurysm::default() };
    folder.mesh("aneurysm.vtp", &aneurysm.mesh().unwrap());
    folder.motet(["mesh", "aneurysm.vtp", "-o", "lumen.vtu", "--size", "0.3"]).assert().success();
    let coil = Coil { centre: [0.0; 3], radius: 0.7, pitch: 0.4, turns: 3.0, wire_radius: 0.1 };
    let mut loops = coil.mesh(40, 8).unwrap();
    loops.points.iter_mut().for_each(|p| *p = [p[0], aneurysm.sac_height + p[2], -p[1]]);
    folder.mesh("loops.stl", &loops);
    folder.motet(["implant", "lumen.vtu", "loops.stl", "-o", "coiled.vtu"]).assert().success();
    // The wall swells by a sixth between its ends, which stay; the coil stays as well.
    let mut mesh = read(folder.path("coiled.vtu")).unwrap();
    let end = mesh.points.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
    let swell = |p: &Point| {
        let share = (1.0 - (p[0] / end).powi(2)).max(0.0) / 6.0;
        [0.0, share * p[1], share * p[2]]
    };
    mesh.set_point_field(Field::vectors("d", &mesh.points.iter().map(swell).collect::<Vec<_>>()));
    folder.mesh("swollen.vtu", &mesh);
    let patch = mesh.patches().unwrap().find("loops").unwrap().to_string();
    folder
        .motet([
            "move",
            "swollen.vtu",
            "-o",
            "moved.vtu",
            "--displacement",
            "d",
            "--steps",
            "4",
            "--fixed",
            &patch,
        ])
        .assert()
        .success();
    let call = folder.motet(["remesh", "moved.vtu", "-o", "good.vtu", "--json"]).assert().success();
    let reported: Value = serde_json::from_str(&stdout(&call)).unwrap();
    let repaired = &reported["after"];
    assert_eq!((&repaired["bad"], &repaired["inverted"]), (&0.into(), &0.into()), "{reported}");
    assert!(reported["before"]["bad"].as_u64() > Some(0), "nothing to repair");
    let good = read(folder.path("good.vtu")).unwrap();
    assert!(check(&good).is_empty());
    let key = |p: &Point| p.map(|x| (x + 0.0).to_bits());
    let points: std::collections::HashSet<_> = good.points.iter().map(key).collect();
    let surface = Surface::of(&read(folder.path("loops.stl")).unwrap());
    assert!(surface.points.iter().all(|p| points.contains(&key(p))));
}

#[test]
fn bad_input_ends_with_the_reason_and_nothing_written() {
    let folder = folder();
    folder.mesh("far.vtu", &small_ball(0.5, 9.0));
    folder.mesh("wall.vtu", &small_ball(0.5, 1.2));
    folder.mesh("large.vtu", &small_ball(9.0, 0.0));
    let whole = Surface::boundary_of(&small_ball(0.5, 0.0));
    let mut cells = Cells::new();
    whole.triangles.iter().skip(1).for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    folder.mesh("open.stl", &Mesh::new(whole.points, cells));
    let refused = |words: &[&str], code: i32, what: &[&str]| {
        let call = folder.motet([&["implant"], words, &["-o", "out.vtu"]].concat()).assert().code(code);
        for what in what {
            assert!(stderr(&call).contains(what), "{what}: {}", stderr(&call));
        }
        assert!(!folder.path("out.vtu").exists());
    };
    refused(&["host.vtu", "far.vtu"], 3, &["far.vtu", "lies outside of the host"]);
    refused(&["host.vtu", "wall.vtu"], 3, &["wall.vtu", "`wall` keeps its tets", "at ("]);
    refused(&["host.vtu", "large.vtu"], 3, &["large.vtu", "contains the whole host"]);
    refused(&["host.vtu", "open.stl"], 3, &["open.stl", "the surface ends at the edge"]);
    refused(&["host.vtu", "ball.vtu", "ball.vtu"], 3, &["ball"]);
    refused(&["coil.stl", "ball.vtu"], 3, &["coil.stl", "no linear tetrahedra"]);
    refused(&["host.vtu", "none.stl"], 3, &["none.stl"]);
    refused(&["host.vtu"], 2, &["DEVICE"]);
    refused(&["host.vtu", "ball.vtu", "--growth", "5"], 2, &["the growth of sizes is 5"]);
    refused(&["host.vtu", "ball.vtu", "--carve", "9"], 2, &["9"]);
    refused(&["host.vtu", "ball.vtu", "--carry", "none=drop"], 2, &["none"]);
    refused(&["host.vtu", "ball.vtu", "--stray=-1"], 2, &["a number of 0 or more is expected"]);
    folder.motet(["implant", "host.vtu", "ball.vtu", "-o", "ball.vtu"]).assert().code(2);
}
