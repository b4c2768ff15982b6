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
