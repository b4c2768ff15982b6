//! `motet mesh`: what it fills, what it refuses, what it repairs.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::io::read;
use motet::mesh::check::check;
use motet::mesh::shapes::{Flap, ThickTube, ball};
use motet::mesh::{CellKind, Cells, Field, Surface};
use serde_json::Value;

/// The surface of a ball, without some of its triangles.
fn ball_surface(n_missing: usize) -> Mesh {
    let surface = Surface::boundary_of(&ball(4, 4));
    let mut cells = Cells::new();
    surface.triangles.iter().skip(n_missing).for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

fn report(folder: &Folder, words: &[&str]) -> Value {
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    serde_json::from_str(&stdout(&call)).expect("one object")
}

#[test]
fn a_ball_is_filled() {
    let folder = Folder::new();
    folder.mesh("ball.stl", &ball_surface(0));
    let reported = report(&folder, &["mesh", "ball.stl", "-o", "ball.vtu", "--size", "0.3"]);
    assert_eq!(reported["complete"], true, "{reported}");
    assert_eq!(reported["filled"]["triangles"], reported["filled"]["triangles_kept"]);
    assert!(reported["improved"]["after"]["bad"] == 0, "{reported}");
    let mesh = read(folder.path("ball.vtu")).unwrap();
    assert!(check(&mesh).is_empty());
}

#[test]
fn regions_and_patches_are_those_of_the_surface() {
    let folder = Folder::new();
    folder.mesh("vessel.vtp", &ThickTube::default().mesh().unwrap());
    let reported = report(&folder, &["mesh", "vessel.vtp", "-o", "vessel.vtu"]);
    assert_eq!(reported["filled"]["bodies"].as_array().map(Vec::len), Some(2), "{reported}");
    let mesh = read(folder.path("vessel.vtu")).unwrap();
    let patches = mesh.patches().unwrap();
    for name in ["lumen_inlet", "interface", "outer", "wall_outlet"] {
        assert!(patches.find(name).is_some(), "{name}");
    }
    assert_eq!(mesh.regions().unwrap().used(), [1, 2]);
}

#[test]
fn a_flap_in_the_same_file_or_its_own_has_two_sides() {
    let folder = Folder::new();
    let whole = Flap { reach: 0.6, ..Flap::default() }.mesh().unwrap();
    let labels = whole.patches().unwrap();
    let flap = labels.find("flap").unwrap();
    let part = |is_flap: bool| {
        let mut cells = Cells::new();
        let of_part = whole.cells.iter().filter(|(cell, _, _)| (labels.ids[cell.index()] == flap) == is_flap);
        of_part.for_each(|(_, kind, vertices)| cells.push(kind, vertices.iter().copied()));
        Mesh::new(whole.points.clone(), cells)
    };
    folder.mesh("lumen.vtp", &part(false));
    folder.mesh("flap.vtp", &part(true));
    let reported = report(&folder, &["mesh", "lumen.vtp", "--membrane", "flap.vtp", "-o", "out.vtu"]);
    assert_eq!(reported["filled"]["triangles"], reported["filled"]["triangles_kept"], "{reported}");
    assert!(read(folder.path("out.vtu")).unwrap().patches().unwrap().find("flap").is_some());
    // Without `--membrane`, the flap is an open surface.
    folder.motet(["mesh", "lumen.vtp", "flap.vtp", "-o", "no.vtu"]).assert().code(3);
}

/// A file per patch, as vessels come from modelling programs.
#[test]
fn files_that_end_at_common_edges_are_one_surface() {
    let folder = Folder::new();
    let whole = ThickTube::default().mesh().unwrap();
    let labels = whole.patches().unwrap();
    let mut words: Vec<String> = vec!["mesh".into()];
    for (patch, name) in &labels.names {
        let mut cells = Cells::new();
        let of_patch = whole.cells.iter().filter(|(cell, _, _)| labels.ids[cell.index()] == *patch);
        of_patch.for_each(|(_, kind, vertices)| cells.push(kind, vertices.iter().copied()));
        words.push(format!("{name}.stl"));
        folder.mesh(&words[words.len() - 1], &Mesh::new(whole.points.clone(), cells));
    }
    let call = |words: &[String], output: &str| {
        let words: Vec<&str> = words.iter().map(String::as_str).chain(["-o", output]).collect();
        report(&folder, &words)
    };
    let reported = call(&words, "vessel.vtu");
    assert_eq!(reported["preflight"]["n_surfaces"], 1, "{reported}");
    assert_eq!(reported["filled"]["bodies"].as_array().map(Vec::len), Some(2), "{reported}");
    let mesh = read(folder.path("vessel.vtu")).unwrap();
    for name in labels.names.values() {
        assert!(mesh.patches().unwrap().find(name).is_some(), "{name}");
    }
    // A wall between two meshes may be given by both: it is used once.
    std::fs::copy(folder.path("interface.stl"), folder.path("inner.stl")).unwrap();
    let twice: Vec<String> = words.iter().cloned().chain(["inner.stl".to_owned()]).collect();
    assert_eq!(call(&twice, "twice.vtu")["filled"]["triangles"], reported["filled"]["triangles"]);
    // Without the last of them it is open, and all the others are named.
    words.pop();
    let call = folder.motet(words.iter().map(String::as_str).chain(["-o", "no.vtu"])).assert().code(3);
    assert!(words[1..].iter().all(|file| stderr(&call).contains(file.as_str())), "{}", stderr(&call));
}

#[test]
fn a_hole_is_refused_with_its_place_and_mended_on_request() {
    let folder = Folder::new();
    folder.mesh("torn.stl", &ball_surface(2));
    let call =
        folder.motet(["mesh", "torn.stl", "-o", "out.vtu", "--culprits", "wrong.vtp"]).assert().code(3);
    assert!(stderr(&call).contains("open_edge"), "{}", stderr(&call));
    assert!(!folder.path("out.vtu").exists());
    assert!(read(folder.path("wrong.vtp")).unwrap().cells.len() > 2);
    let reported = report(&folder, &["mesh", "torn.stl", "-o", "out.vtu", "--repair"]);
    assert!(!reported["repairs"].as_array().unwrap().is_empty());
    assert!(folder.path("out.vtu").exists());
}

#[test]
fn words_that_mean_nothing_are_refused() {
    let folder = Folder::new();
    folder.mesh("ball.stl", &ball_surface(0));
    for words in [
        &["mesh", "ball.stl"][..],
        &["mesh", "ball.stl", "-o", "out.vtu", "--size", "-1"],
        &["mesh", "ball.stl", "-o", "out.vtu", "--merge", "0.1"],
        &["mesh", "ball.stl", "-o", "ball.stl"],
    ] {
        folder.motet(words).assert().code(2);
    }
    folder.motet(["mesh", "none.stl", "-o", "out.vtu"]).assert().code(3);
    folder.motet(["mesh", "ball.stl", "-o", "out.vtu", "--size", "1e-9"]).assert().code(2);
}

#[test]
fn sizes_grow_from_the_surface_on_request() {
    let folder = Folder::new();
    let mut ball = ball_surface(0);
    ball.point_data.push(Field::scalars("h", vec![0.2; ball.points.len()]));
    ball.cell_data.push(Field::scalars("bad", vec![-1.0; ball.cells.len()]));
    folder.mesh("ball.vtp", &ball);
    let inside = |words: &[&str]| {
        let reported = report(&folder, &[&["mesh", "ball.vtp", "-o", "out.vtu"], words].concat());
        assert_eq!(
            (&reported["complete"], &reported["improved"]["after"]["bad"]),
            (&true.into(), &0.into()),
            "{reported}"
        );
        reported["filled"]["points_inside"].as_u64().unwrap()
    };
    let auto = inside(&["--size", "auto"]);
    let slow = inside(&["--size", "auto", "--growth", "0.1"]);
    let limited = inside(&["--size", "0.15", "--growth", "0.5"]);
    let array = inside(&["--size-array", "h"]);
    let both = inside(&["--size-array", "h", "--size", "0.2"]);
    assert!(auto < slow && slow < limited && array < both, "{auto} {slow} {limited} {array} {both}");
    for (words, code, expected) in [
        (&["--size", "large"][..], 2, "or auto"),
        (&["--growth", "0.9"], 2, "at most 0.7"),
        (&["--size-array", "none"], 3, "ball.vtp: the surface has no array `none`; point arrays: h"),
        (&["--size-array", "bad"], 3, "array `bad`: cell 0"),
        (&["--size", "1e-9", "--growth", "0.3"], 3, "larger"),
    ] {
        let call = folder.motet(["mesh", "ball.vtp", "-o", "no.vtu"].iter().chain(words)).assert().code(code);
        assert!(stderr(&call).contains(expected), "{}", stderr(&call));
    }
    assert!(!folder.path("no.vtu").exists());
}

#[test]
fn regions_are_named_and_left_out_by_their_places() {
    let folder = Folder::new();
    let outer = ball_surface(0);
    let mut inner = outer.clone();
    inner.points.iter_mut().flatten().for_each(|x| *x *= 0.5);
    folder.mesh("outer.stl", &outer);
    folder.mesh("inner.stl", &inner);
    let words = ["mesh", "inner.stl", "outer.stl", "-o", "out.vtu", "--seed", "-0.01,0,0=core"];
    let reported = report(&folder, &words);
    let names: Vec<_> =
        reported["filled"]["bodies"].as_array().unwrap().iter().map(|b| b["name"].clone()).collect();
    assert_eq!(names, ["outer", "core"]);
    let regions = read(folder.path("out.vtu")).unwrap().regions().unwrap();
    assert_eq!((regions.find("outer"), regions.find("core")), (Some(1), Some(2)));
    let said = folder.motet(words).assert().success();
    assert!(stdout(&said).contains("region 2 core: "), "{}", stdout(&said));
    let hole = report(&folder, &[&words[..5], &["--hole", "0,0,0"]].concat());
    assert_eq!(hole["filled"]["bodies"].as_array().map(Vec::len), Some(1), "{hole}");
    let whole = reported["filled"]["bodies"][0]["volume"].as_f64().unwrap();
    assert!((hole["filled"]["bodies"][0]["volume"].as_f64().unwrap() - whole).abs() < 1e-9);
    for (word, code) in [("9,0,0=far", 3), ("0,0=two", 2), ("0,0,0=", 2)] {
        folder.motet(["mesh", "outer.stl", "-o", "no.vtu", "--seed", word]).assert().code(code);
    }
    let twice = ["mesh", "outer.stl", "-o", "no.vtu", "--seed", "0,0,0=a", "--seed", "0.1,0,0=b"];
    let call = folder.motet(twice).assert().code(2);
    assert!(stderr(&call).contains("another seed names `a`"), "{}", stderr(&call));
}

#[test]
fn layers_grow_on_walls_and_are_reported() {
    let folder = Folder::new();
    let whole = ThickTube::default().mesh().unwrap();
    let labels = whole.patches().unwrap();
    let lumen = ["lumen_inlet", "lumen_outlet", "interface"].map(|name| labels.find(name).unwrap());
    let (mut cells, mut patches) = (Cells::new(), Vec::new());
    for (cell, kind, vertices) in whole.cells.iter() {
        if lumen.contains(&labels.ids[cell.index()]) {
            cells.push(kind, vertices.iter().copied());
            patches.push(labels.ids[cell.index()]);
        }
    }
    let mut mesh = Mesh::new(whole.points.clone(), cells);
    mesh.label_names = whole.label_names.clone();
    mesh.cell_data = vec![motet::mesh::Field::scalars("patch", patches)];
    folder.mesh("lumen.vtp", &mesh);
    let call = ["mesh", "lumen.vtp", "-o", "lumen.vtu", "--size", "0.4", "--layers"];
    let with = |words: &[&'static str]| call.iter().copied().chain(words.iter().copied()).collect::<Vec<_>>();
    let everywhere = report(&folder, &with(&["4,0.02,1.2"]));
    assert_eq!(everywhere["complete"], true, "{everywhere}");
    let layers = &everywhere["layers"];
    assert_eq!((&layers["full"], &layers["without"]), (&layers["vertices"], &0.into()), "{layers}");
    assert_eq!(layers["prisms"], 4 * 2 * 24 * 24, "{layers}");
    let made = read(folder.path("lumen.vtu")).unwrap();
    assert!(check(&made).is_empty());
    assert!(made.patches().unwrap().find("interface").is_some());
    // Given by patch, in two ways.
    for words in [&["interface=4,0.02,1.2"][..], &["4,0.02,1.2", "--layers-on", "interface"]] {
        let reported = report(&folder, &with(words));
        assert_eq!(reported["layers"], everywhere["layers"]);
        assert_eq!(read(folder.path("lumen.vtu")).unwrap(), made);
    }
    let reported = report(&folder, &with(&["4,0.02,1.2", "--keep-prisms"]));
    assert_eq!(reported["layers"], everywhere["layers"]);
    let prisms = read(folder.path("lumen.vtu")).unwrap();
    assert!(check(&prisms).is_empty());
    assert!(prisms.cells.counts().contains(&(CellKind::WEDGE, 4 * 2 * 24 * 24)));
    let sum = |what: &str| -> u64 {
        reported["filled"]["bodies"].as_array().unwrap().iter().map(|body| body[what].as_u64().unwrap()).sum()
    };
    let n_tets = prisms.cells.tets().count() as u64;
    let n_volume = prisms.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)).count() as u64;
    assert_eq!((sum("tets"), sum("prisms")), (n_tets, n_volume - n_tets));
    let call = folder.motet(with(&["4,0.02,1.2"])).assert().success();
    assert!(stdout(&call).contains("as thick as requested at 600 of 600 vertices"), "{}", stdout(&call));
}

#[test]
fn layers_that_mean_nothing_are_refused() {
    let folder = Folder::new();
    folder.mesh("ball.stl", &ball_surface(0));
    for words in [
        &["--layers", "0,0.1,1"][..],
        &["--layers", "-1,0.1,1"],
        &["--layers", "3,-0.1,1"],
        &["--layers", "3,nan,1"],
        &["--layers", "3,0.1,0"],
        &["--layers", "999999999,0.1,1"],
        &["--layers", "3,0.1"],
        &["--layers", "none=3,0.1,1"],
        &["--layers", "3,0.1,1", "--layers", "2,0.1,1"],
        &["--layers", "ball=3,0.1,1", "--layers", "1=3,0.1,1"],
        &["--layers", "ball=3,0.1,1", "--layers-on", "ball"],
        &["--layers-on", "ball"],
        &["--keep-prisms"],
        &["--layers", "3,0.1,1", "--delaunay"],
    ] {
        let call = ["mesh", "ball.stl", "-o", "out.vtu"].iter().chain(words);
        let call = folder.motet(call).assert().code(2);
        assert!(!stderr(&call).is_empty());
        assert!(!folder.path("out.vtu").exists());
    }
    // Layers too thin for double precision are left out; the mesh is made.
    folder.motet(["mesh", "ball.stl", "-o", "out.vtu", "--layers", "3,1e-30,1"]).assert().code(4);
    assert!(check(&read(folder.path("out.vtu")).unwrap()).is_empty());
}
