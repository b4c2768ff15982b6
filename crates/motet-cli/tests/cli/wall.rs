//! `motet wall`: what it makes, what it prints, what it refuses.

use crate::common::{Folder, stderr, stdout};
use motet::io::read;
use motet::mesh::shapes::{TubeOptions, box_grid, mixed, tube};
use motet::mesh::{CellKind, Field};
use serde_json::Value;

#[test]
fn a_tube_gets_a_wall_and_a_report() {
    let folder = Folder::new();
    let mut lumen = tube(&TubeOptions::default());
    let heights: Vec<f64> = lumen.points.iter().map(|p| p[2]).collect();
    lumen.set_point_field(Field::scalars("height", heights));
    folder.mesh("blood.vtu", &lumen);
    let words = ["wall", "blood.vtu", "-o", "fsi.vtu", "--thickness", "0.2", "--layers", "2"];
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!((&report["complete"], &report["name"]), (&Value::Bool(true), &"wall".into()));
    assert_eq!(report["ends"], serde_json::json!(["wall_inlet", "wall_outlet"]));
    assert_eq!(report["layers"]["full"], report["layers"]["vertices"]);
    let made = read(folder.path("fsi.vtu")).unwrap();
    assert_eq!(made.points[..lumen.points.len()], lumen.points);
    let n = |mesh: &motet::Mesh| mesh.cells.tets().count();
    assert_eq!(n(&made), n(&lumen) + report["layers"]["tets"].as_u64().unwrap() as usize);
    let height = made.point_field("height").unwrap().values.to_f64().unwrap();
    assert!(height.iter().zip(&made.points).all(|(h, p)| (h - p[2]).abs() < 1e-9));
    let text = stdout(&folder.motet(words).assert().success());
    for part in
        ["region 2, wall", "thickness (least, median, largest)", "ends: wall_inlet, wall_outlet", "EAS"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let words = ["wall", "blood.vtu", "-o", "w.vtu", "--of-radius", "0.1", "--keep-prisms", "--on", "wall"];
    folder.motet(words).assert().success();
    let kinds = read(folder.path("w.vtu")).unwrap().cells.kinds().to_vec();
    assert!(kinds.contains(&CellKind::WEDGE) && kinds.contains(&CellKind::QUAD));
}

#[test]
fn what_has_no_wall_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]));
    folder.mesh("mixed.vtu", &mixed(2));
    for (words, status, part) in [
        (&["wall", "none.vtu", "-o", "a.vtu", "--thickness", "0.1"][..], 3, "none.vtu"),
        (&["wall", "mixed.vtu", "-o", "a.vtu", "--thickness", "0.1"], 3, "not a triangle"),
        (&["wall", "box.vtu", "-o", "a.vtu", "--thickness", "t"], 3, "no array `t`"),
        (&["wall", "box.vtu", "-o", "a.vtu"], 2, "--thickness"),
        (&["wall", "box.vtu", "-o", "a.vtu", "--thickness", "0"], 2, "--thickness"),
        (&["wall", "box.vtu", "-o", "a.vtu", "--thickness", "1", "--of-radius", "1"], 2, "--of-radius"),
        (&["wall", "box.vtu", "-o", "a.vtu", "--thickness", "0.1", "--layers", "0"], 2, "number of layers"),
        (&["wall", "box.vtu", "-o", "a.vtu", "--thickness", "0.1", "--on", "x"], 2, "no patch `x`"),
        (&["wall", "box.vtu", "-o", "box.vtu", "--thickness", "0.1"], 2, "overwrite"),
    ] {
        let call = folder.motet(words).assert().code(status);
        assert!(stderr(&call).contains(part), "{words:?}: {}", stderr(&call));
        assert!(!folder.path("a.vtu").exists());
    }
}
