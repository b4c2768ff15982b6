//! `motet cap`: ends named and extended, ends cut off by `motet surface --clip`.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::VertexId;
use motet::io::read;
use motet::mesh::shapes::Bifurcation;
use motet::mesh::{CellKind, Cells, Surface};

/// The wall of a vessel that branches, open at three ends.
fn open() -> Mesh {
    let whole = Bifurcation::default().mesh().unwrap();
    let (surface, wall) = (Surface::of(&whole), whole.find_patch("wall").unwrap());
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, patch)| **patch == wall);
    let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    Mesh::new(whole.points, Cells::uniform(CellKind::TRIANGLE, triangles).unwrap())
}

#[test]
fn ends_are_cut_named_and_extended() {
    let folder = Folder::new();
    folder.mesh("open.vtp", &open());
    let words = ["surface", "open.vtp", "-o", "cut.vtp", "--clip", "-3.5,0,0,-1,0,0"];
    let text = stdout(&folder.motet(words).assert().success());
    assert!(text.contains("cut off: "), "{text}");
    let least = read(folder.path("cut.vtp")).unwrap().points.iter().map(|p| p[0]).fold(f64::MAX, f64::min);
    assert!((least + 3.5).abs() < 1e-9, "{least}");
    let words =
        ["cap", "cut.vtp", "-o", "lumen.vtp", "--inlet", "largest", "--extend", "inlet=2", "--extend", "1.5"];
    folder.motet(words).assert().success();
    let lumen = read(folder.path("lumen.vtp")).unwrap();
    let mut names: Vec<String> = lumen.label_names.patches.values().cloned().collect();
    names.sort();
    assert_eq!(names, ["inlet", "outlet_1", "outlet_2", "wall"]);
    let least = lumen.points.iter().map(|p| p[0]).fold(f64::MAX, f64::min);
    assert!((least + 5.5).abs() < 1e-6, "{least}");
    folder.motet(["mesh", "lumen.vtp", "-o", "lumen.vtu", "--size", "auto"]).assert().success();
}

#[test]
fn what_cannot_be_cut_or_extended_is_refused() {
    let folder = Folder::new();
    folder.mesh("open.vtp", &open());
    for (words, status, part) in [
        (&["cap", "open.vtp", "-o", "a.vtp", "--extend", "x=1"][..], 2, "no open end `x`"),
        (&["cap", "open.vtp", "-o", "a.vtp", "--extend", "0"], 2, "--extend"),
        (&["cap", "open.vtp", "-o", "a.vtp", "--inlet", "1,2"], 2, "--inlet"),
        (&["surface", "open.vtp", "-o", "a.vtp", "--clip", "0,0,99,0,0,1"], 3, "does not meet"),
        (&["surface", "open.vtp", "-o", "a.vtp", "--clip", "0,0,1"], 2, "--clip"),
        (&["surface", "open.vtp", "-o", "a.vtp", "--clip", "0,0,0,0,0,0"], 2, "--clip"),
    ] {
        let call = folder.motet(words).assert().code(status);
        assert!(stderr(&call).contains(part), "{words:?}: {}", stderr(&call));
        assert!(!folder.path("a.vtp").exists());
    }
}
