//! `motet mesh`: what it fills, what it refuses, what it mends.

mod common;

use common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::io::read;
use motet::mesh::check::check;
use motet::mesh::shapes::{Flap, ThickTube, ball};
use motet::mesh::{CellKind, Cells, Surface};
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
    let told = report(&folder, &["mesh", "ball.stl", "-o", "ball.vtu", "--size", "0.3"]);
    assert_eq!(told["complete"], true, "{told}");
    assert_eq!(told["filled"]["triangles"], told["filled"]["triangles_kept"]);
    assert!(told["improved"]["after"]["bad"] == 0, "{told}");
    let mesh = read(folder.path("ball.vtu")).unwrap();
    assert!(check(&mesh).is_empty());
}

#[test]
fn regions_and_patches_are_those_of_the_surface() {
    let folder = Folder::new();
    folder.mesh("vessel.vtp", &ThickTube::default().mesh().unwrap());
    let told = report(&folder, &["mesh", "vessel.vtp", "-o", "vessel.vtu"]);
    assert_eq!(told["filled"]["volumes"].as_array().map(Vec::len), Some(2), "{told}");
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
    let told = report(&folder, &["mesh", "lumen.vtp", "--membrane", "flap.vtp", "-o", "out.vtu"]);
    assert_eq!(told["filled"]["triangles"], told["filled"]["triangles_kept"], "{told}");
    assert!(read(folder.path("out.vtu")).unwrap().patches().unwrap().find("flap").is_some());
    // Without the word, the flap is an open surface.
    folder.motet(["mesh", "lumen.vtp", "flap.vtp", "-o", "no.vtu"]).assert().code(3);
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
    let told = report(&folder, &["mesh", "torn.stl", "-o", "out.vtu", "--repair"]);
    assert!(!told["repairs"].as_array().unwrap().is_empty());
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
fn layers_grow_on_walls_and_are_told() {
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
    // The same said by patch, in two ways.
    for words in [&["interface=4,0.02,1.2"][..], &["4,0.02,1.2", "--layers-on", "interface"]] {
        let told = report(&folder, &with(words));
        assert_eq!(told["layers"], everywhere["layers"]);
        assert_eq!(read(folder.path("lumen.vtu")).unwrap(), made);
    }
    let told = report(&folder, &with(&["4,0.02,1.2", "--keep-prisms"]));
    assert_eq!(told["layers"], everywhere["layers"]);
    let prisms = read(folder.path("lumen.vtu")).unwrap();
    assert!(check(&prisms).is_empty());
    assert!(prisms.cells.counts().contains(&(CellKind::WEDGE, 4 * 2 * 24 * 24)));
    let call = folder.motet(with(&["4,0.02,1.2"])).assert().success();
    assert!(stdout(&call).contains("as thick as asked at 600 of 600 vertices"), "{}", stdout(&call));
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
    // No digits for the layers: none is there, the mesh is.
    folder.motet(["mesh", "ball.stl", "-o", "out.vtu", "--layers", "3,1e-30,1"]).assert().code(4);
    assert!(check(&read(folder.path("out.vtu")).unwrap()).is_empty());
}
