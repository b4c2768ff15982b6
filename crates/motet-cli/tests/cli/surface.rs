//! `motet surface`: what it makes even, what it prints, what it refuses.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::io::read;
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Field, Surface};
use serde_json::Value;

/// A tube without ends, of radius 1 and length 4, with narrow triangles and a linear point array.
fn tube() -> Mesh {
    let (n, m) = (48, 5);
    let points: Vec<_> = (0..=m)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .map(|(i, j)| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [angle.cos(), angle.sin(), 4.0 * j as f64 / m as f64]
        })
        .collect();
    let mut cells = Cells::new();
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let id = |i: usize, j: usize| VertexId::new(j * n + i % n);
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        cells.push(CellKind::TRIANGLE, [a, b, c]);
        cells.push(CellKind::TRIANGLE, [a, c, d]);
    }
    let mut mesh = Mesh::new(points, cells);
    let height: Vec<f64> = mesh.points.iter().map(|p| p[2]).collect();
    mesh.set_point_field(Field::scalars("height", height));
    mesh
}

#[test]
fn an_open_tube_gets_even_triangles_and_a_report() {
    let folder = Folder::new();
    folder.mesh("tube.vtp", &tube());
    let words = ["surface", "tube.vtp", "-o", "even.vtp", "--size", "0.3", "--distance", "0.02"];
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!((&report["complete"], &report["not_reached"]), (&Value::Bool(true), &Value::Null));
    assert_eq!((&report["before"]["rims"], &report["after"]["rims"]), (&2.into(), &2.into()));
    assert!(report["after"]["angles"]["worst"].as_f64().unwrap() > 25.0, "{report}");
    assert!(report["before"]["angles"]["worst"].as_f64().unwrap() < 10.0, "{report}");
    assert_eq!((&report["after"]["crossings"], &report["after"]["volume"]), (&0.into(), &Value::Null));
    assert_eq!(report["allowed"], 0.02);
    for key in ["to_given", "from_given"] {
        assert!(report[key].as_f64().unwrap() <= 0.02, "{report}");
    }
    let made = read(folder.path("even.vtp")).unwrap();
    assert_eq!(report["after"]["triangles"], made.cells.len());
    let height = made.point_field("height").unwrap().values.to_f64().unwrap();
    assert!(height.iter().zip(&made.points).all(|(h, p)| (h - p[2]).abs() < 0.03));
    let text = stdout(&folder.motet(words).assert().success());
    for part in ["given", "new", "least angle", "rims", "open", "(0.02000 allowed)"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn smoothing_and_volume_meshes_are_named() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]));
    let call = folder.motet(["surface", "box.vtu", "-o", "box.stl", "--smooth", "2"]).assert().success();
    let text = stdout(&call);
    assert!(text.contains("smoothed in 2 passes") && text.contains("the smoothed one"), "{text}");
    assert!(text.contains("48 cells that are not of the surface are left out"), "{text}");
}

#[test]
fn what_is_no_surface_and_wrong_words_are_refused() {
    let folder = Folder::new();
    folder.mesh("tube.vtp", &tube());
    let mut lines = Cells::new();
    lines.push(CellKind::LINE, [0, 1].map(VertexId::new));
    folder.mesh("lines.vtp", &Mesh::new(vec![[0.0; 3], [1.0; 3]], lines));
    for (words, code, part) in [
        (&["surface", "lines.vtp", "-o", "a.vtp"][..], 3, "no surface"),
        (&["surface", "none.vtp", "-o", "a.vtp"], 3, "none.vtp"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--size-array", "h"], 3, "point arrays: height"),
        (&["surface", "tube.vtp", "-o", "tube.vtp"], 2, "overwrite"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--size", "0"], 2, "--size"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--distance", "0"], 2, "--distance"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--merge", "0.1"], 2, "--repair"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--growth", "2"], 2, "growth"),
        (&["surface", "tube.vtp", "-o", "a.vtp", "--feature-angle", "200"], 2, "angle"),
    ] {
        let call = folder.motet(words).assert().code(code);
        assert!(stderr(&call).contains(part), "{words:?}: {}", stderr(&call));
        assert!(!folder.path("a.vtp").exists());
    }
}

#[test]
fn a_flipped_triangle_is_turned_with_repair() {
    let folder = Folder::new();
    let mut cells = Cells::new();
    for (cell, kind, vertices) in tube().cells.iter() {
        let mut vertices = vertices.to_vec();
        if cell.index() == 17 {
            vertices.swap(0, 1);
        }
        cells.push(kind, vertices);
    }
    folder.mesh("tube.vtp", &Mesh::new(tube().points, cells));
    let call =
        folder.motet(["surface", "tube.vtp", "-o", "even.stl", "--repair", "--json"]).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!(report["repairs"][0]["name"], "turned");
    assert_eq!(
        (&report["after"]["rims"], report["after"]["open_edges"] != report["before"]["open_edges"]),
        (&2.into(), true)
    );
}

#[test]
fn wires_become_one_closed_surface() {
    let folder = Folder::new();
    let points = vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.05], [0.2, 1.0, 0.05], [f64::NAN; 3]];
    let mut cells = Cells::new();
    [[0, 1], [2, 3]].into_iter().for_each(|ends| cells.push(CellKind::LINE, ends.map(VertexId::new)));
    let mut lines = Mesh::new(points[..4].to_vec(), cells.clone());
    lines.set_point_field(Field::scalars("r", vec![0.1; 4]));
    folder.mesh("lines.vtp", &lines);
    let words = ["surface", "lines.vtp", "-o", "wires.stl", "--tubes"];
    let call = folder.motet(words.iter().chain(&["0.1", "--json"])).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    let wires = &report["wires"];
    assert_eq!((&wires["chains"], &wires["bodies"], &wires["sides"]), (&2.into(), &1.into(), &8.into()));
    assert_eq!((&report["after"]["crossings"], &report["after"]["open_edges"]), (&0.into(), &0.into()));
    assert_eq!(report["allowed"].as_f64().unwrap(), 0.1 / 8.0);
    let text = stdout(&folder.motet(words.iter().chain(&["r", "--sides", "10"])).assert().success());
    for part in ["2 wires of 2 segments", "as tubes of 10 sides", "in 1 body"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // A point that is not finite is named, and left out on request.
    cells.push(CellKind::LINE, [3, 4].map(VertexId::new));
    folder.mesh("nan.vtk", &Mesh::new(points, cells));
    let words = ["surface", "nan.vtk", "-o", "nan.stl", "--tubes", "0.1"];
    let text = stderr(&folder.motet(words).assert().code(3));
    assert!(text.contains("point 4") && text.contains("repair"), "{text}");
    let call = folder.motet(words.iter().chain(&["--repair"])).assert().success();
    assert!(stderr(&call).contains("1 segments that are not finite"), "{}", stderr(&call));
}

#[test]
fn wires_come_from_texts_and_from_parameters() {
    let folder = Folder::new();
    std::fs::write(folder.path("positions.txt"), "0 0 0\n1 0 0\n2 0 1\n").unwrap();
    std::fs::write(folder.path("pairs.txt"), "1 2\n2 3\n").unwrap();
    let words = ["surface", "positions.txt", "--segments", "pairs.txt", "-o", "wire.stl", "--tubes", "0.1"];
    let text = stdout(&folder.motet(words).assert().success());
    assert!(text.contains("1 wire of 2 segments"), "{text}");
    let stent = ["surface", "-o", "stent.stl", "--stent", "radius=0.6,length=1,wires=4,pitch=3,wire=0.05"];
    let text = stdout(&folder.motet(stent).assert().success());
    assert!(text.contains("4 wires") && text.contains("joined by material"), "{text}");
    let coil = ["surface", "-o", "coil.stl", "--coil", "turns=1,wire=0.05"];
    let text = stdout(&folder.motet(coil).assert().success());
    assert!(text.contains("1 wire of 48 segments"), "{text}");
    std::fs::write(folder.path("pairs.txt"), "1 2\n2 4\n").unwrap();
    for (words, code, part) in [
        (&words[..], 3, "line 2"),
        (&["surface", "-o", "a.stl"], 2, "required"),
        (&["surface", "-o", "a.stl", "--stent", "radius=x"], 2, "not a number"),
        (&["surface", "-o", "a.stl", "--stent", "wire=1,wire=2"], 2, "twice"),
        (&["surface", "-o", "a.stl", "--stent", "radiuss=1"], 2, "radius"),
        (&["surface", "-o", "a.stl", "--stent", "wires=3"], 2, "even number"),
        (&["surface", "-o", "a.stl", "--coil", "turns=-1"], 2, "turns"),
        (&["surface", "positions.txt", "--segments", "pairs.txt", "-o", "a.stl"], 2, "--tubes"),
    ] {
        let call = folder.motet(words).assert().code(code);
        assert!(stderr(&call).contains(part), "{words:?}: {}", stderr(&call));
        assert!(!folder.path("a.stl").exists());
    }
}

/// Two boxes that overlap, with a linear array.
fn boxes() -> Mesh {
    boxes_without(0)
}

/// The boxes without the first triangles.
fn boxes_without(n_missing: usize) -> Mesh {
    two_boxes([[[0.0; 3], [1.0; 3]], [[0.5, 0.25, 0.25], [2.0, 0.75, 0.75]]], n_missing)
}

/// Two boxes, the first without its first triangles.
fn two_boxes(boxes: [[Point; 2]; 2], n_missing: usize) -> Mesh {
    let boxes = boxes.map(|of| box_grid([3; 3], of));
    let [a, b] = boxes.each_ref().map(Surface::boundary_of);
    let (mut cells, n) = (Cells::new(), a.points.len());
    a.triangles[n_missing..].iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    b.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, t.map(|v| VertexId::new(n + v.index()))));
    let mut mesh = Mesh::new([a.points, b.points].concat(), cells);
    let along: Vec<f64> = mesh.points.iter().map(|p| p[0] + 2.0 * p[1]).collect();
    mesh.set_point_field(Field::scalars("along", along));
    mesh
}

#[test]
fn bodies_that_overlap_become_one() {
    let folder = Folder::new();
    folder.mesh("boxes.vtp", &boxes());
    let words = ["boxes.vtp", "--unite", "--size", "0.2", "--json"];
    let call = folder.motet(["surface", "-o", "one.vtp"].iter().chain(&words)).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert!(report["before"]["crossings"].as_u64().unwrap() > 0, "{report}");
    assert_eq!(report["after"]["crossings"], 0);
    let volume = report["after"]["volume"].as_f64().unwrap();
    assert!((volume - 1.25).abs() < 1e-9, "{volume}");
    let made = read(folder.path("one.vtp")).unwrap();
    let along = made.point_field("along").unwrap().values.to_f64().unwrap();
    assert!(along.iter().zip(&made.points).all(|(x, p)| (x - p[0] - 2.0 * p[1]).abs() < 1e-9));
    let call =
        folder.motet(["mesh", "-o", "one.vtu", "--surface", "adapt"].iter().chain(&words)).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    let bodies = report["filled"]["bodies"].as_array().unwrap();
    assert!(bodies.len() == 1 && (bodies[0]["volume"].as_f64().unwrap() - 1.25).abs() < 1e-9, "{report}");
    let both = ["mesh", "boxes.vtp", "-o", "no.vtu", "--unite", "--cut"];
    assert!(stderr(&folder.motet(both).assert().code(2)).contains("--cut"));
}

#[test]
fn a_plate_thinner_than_the_distance_of_a_wrap_is_lost_and_the_status_says_so() {
    let folder = Folder::new();
    folder.mesh("both.vtp", &two_boxes([[[0.0; 3], [1.0; 3]], [[2.0, 0.0, 0.0], [3.0, 1.0, 0.01]]], 0));
    for words in [&["surface", "-o", "one.vtp"][..], &["mesh", "-o", "one.vtu", "--surface", "adapt"]] {
        let more = ["both.vtp", "--wrap", "0.05", "--size", "0.2"];
        let call = folder.motet(words.iter().chain(&more)).assert().code(4);
        assert!(stderr(&call).contains("triangles of walls or gaps thinner"), "{}", stderr(&call));
    }
}

/// Open, crossing, and cut to pieces: a box without a side through another.
#[test]
fn what_is_torn_is_wrapped() {
    let folder = Folder::new();
    folder.mesh("torn.vtp", &boxes_without(2));
    let refused = folder.motet(["mesh", "torn.vtp", "-o", "no.vtu"]).assert().code(3);
    assert!(stderr(&refused).contains("--wrap"), "{}", stderr(&refused));
    let words = ["torn.vtp", "--wrap", "0.01", "--repair", "--size", "0.2", "--json"];
    let call = folder.motet(["surface", "-o", "one.vtp"].iter().chain(&words)).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!((report["after"]["crossings"].as_u64(), report["after"]["rims"].as_u64()), (Some(0), Some(0)));
    let volume = report["after"]["volume"].as_f64().unwrap();
    assert!((volume - 1.25).abs() < 0.05, "{volume}");
    let made = read(folder.path("one.vtp")).unwrap();
    let along = made.point_field("along").unwrap().values.to_f64().unwrap();
    // Those in the hole take the value of its rim.
    let is_right = |(x, p): &(&f64, &[f64; 3])| (*x - p[0] - 2.0 * p[1]).abs() < 0.05;
    assert!(along.iter().zip(&made.points).filter(is_right).count() * 10 > along.len() * 9);
    let call =
        folder.motet(["mesh", "-o", "one.vtu", "--surface", "adapt"].iter().chain(&words)).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    let bodies = report["filled"]["bodies"].as_array().unwrap();
    assert!(bodies.len() == 1 && (bodies[0]["volume"].as_f64().unwrap() - 1.25).abs() < 0.05, "{report}");
    let both = ["mesh", "torn.vtp", "-o", "no.vtu", "--unite", "--wrap", "0.1"];
    assert!(stderr(&folder.motet(both).assert().code(2)).contains("--wrap"));
}

#[test]
fn what_is_open_is_not_united() {
    let folder = Folder::new();
    folder.mesh("tube.vtp", &tube());
    let call = folder.motet(["surface", "tube.vtp", "-o", "even.vtp", "--unite"]).assert().code(4);
    assert!(stderr(&call).contains("could not be united"), "{}", stderr(&call));
}
