//! Every report contains the quality of all tets: the same numbers for all verbs, compared with values sorted
//! here.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::Names as _;
use motet::geometry::quality::{Measure, eas, mean_ratio};
use motet::io::read;
use motet::mesh::shapes::{ball, box_grid, sphere_in_box};
use motet::mesh::{CellKind, Cells, Surface};
use serde_json::Value;

const HEAD: &str = "quality of all tets";

/// Worst, 1 %, 5 %, median, mean EAS, and the mean of the mean ratios.
fn expected(mesh: &Mesh) -> [f64; 6] {
    let of = |measure: fn([[f64; 3]; 4]) -> f64| -> Vec<f64> {
        mesh.cells.tets().map(|(_, tet)| measure(tet.map(|v| mesh.points[v.index()]))).collect()
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mut sorted, ratios) = (of(eas), of(mean_ratio));
    sorted.sort_by(f64::total_cmp);
    let at = |part: f64| sorted[(part * (sorted.len() - 1) as f64) as usize];
    [at(0.0), at(0.01), at(0.05), at(0.5), mean(&sorted), mean(&ratios)]
}

fn holds(report: &Value, mesh: &Mesh, what: &str) {
    let keys = ["worst", "p1", "p5", "median", "mean", "mean_ratio"];
    for (key, value) in keys.into_iter().zip(expected(mesh)) {
        let found = report[key].as_f64().unwrap_or(f64::NAN);
        assert!((found - value).abs() < 1e-12, "{what}, {key}: {found}, expected {value}");
    }
}

/// A folder with a sphere in a box, a host and a device, and a closed surface.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(6, 4));
    folder.mesh("host.vtu", &box_grid([6; 3], [[-1.5; 3], [1.5; 3]]));
    let mut device = ball(3, 2);
    device.points.iter_mut().for_each(|p| *p = p.map(|x| 0.5 * x));
    folder.mesh("device.vtu", &device);
    let surface = Surface::boundary_of(&ball(4, 4));
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    folder.mesh("ball.stl", &Mesh::new(surface.points, cells));
    folder
}

/// The JSON report of a call, after its table for people was checked.
fn reported(folder: &Folder, words: &[&str]) -> Value {
    let text = stdout(&folder.motet(words).assert().success());
    let rows: Vec<&str> = text.lines().skip_while(|line| !line.contains(HEAD)).skip(1).collect();
    assert!(rows.first().is_some_and(|row| row.split_whitespace().count() > 6), "{words:?}: {text}");
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    serde_json::from_str(&stdout(&call)).expect("one object")
}

#[test]
fn info_tells_the_distribution_and_the_lengths_of_edges() {
    let folder = folder();
    let info = reported(&folder, &["info", "box.vtu"]);
    let quality = &info["quality"];
    holds(&quality["distribution"], &read(folder.path("box.vtu")).unwrap(), "info");
    assert_eq!(quality["distribution"]["worst"], quality["eas"]["min"]);
    assert_eq!(quality["distribution"]["p5"], quality["eas"]["percentiles"][1]);
    assert_eq!(quality["distribution"]["mean_ratio"], quality["mean_ratio"]["mean"]);
    let edges: Vec<f64> = serde_json::from_value(quality["edges"].clone()).unwrap();
    assert!(edges.len() == 3 && 0.0 < edges[0] && edges[0] < edges[1] && edges[1] < edges[2], "{edges:?}");
}

#[test]
fn changed_meshes_are_reported_before_and_after() {
    let folder = folder();
    let host = read(folder.path("box.vtu")).unwrap();
    let of = |name: &str| read(folder.path(name)).unwrap();
    let remeshed = reported(&folder, &["remesh", "box.vtu", "-o", "remeshed.vtu", "--min-eas", "0.26"]);
    holds(&remeshed["before"]["quality"], &host, "remesh, before");
    holds(&remeshed["after"]["quality"], &of("remeshed.vtu"), "remesh, after");
    let words = ["refine", "box.vtu", "-o", "fine.vtu", "--ball", "2,0,0,0.5", "--generations", "1"];
    let refined = reported(&folder, &words);
    holds(&refined["steps"][0]["quality"], &host, "refine, before");
    holds(&refined["steps"][1]["quality"], &of("fine.vtu"), "refine, after");
    let implanted = reported(&folder, &["implant", "host.vtu", "device.vtu", "-o", "with.vtu"]);
    holds(&implanted["quality"][0], &of("host.vtu"), "implant, host");
    holds(&implanted["quality"][1], &of("with.vtu"), "implant, mesh");
}

#[test]
fn a_filled_surface_is_reported() {
    let folder = folder();
    let filled = reported(&folder, &["mesh", "ball.stl", "-o", "ball.vtu", "--size", "0.3"]);
    holds(&filled["quality"], &read(folder.path("ball.vtu")).unwrap(), "mesh");
}

#[test]
fn each_frame_of_a_motion_is_reported() {
    let folder = folder();
    let words = ["move", "box.vtu", "-o", "out.pvd", "--translate", "sphere=0.5,0,0", "--steps", "2"];
    let moved = reported(&folder, &words);
    holds(&moved["before"]["quality"], &read(folder.path("box.vtu")).unwrap(), "move, before");
    let frames = motet::io::read_series(folder.path("out.pvd")).unwrap();
    assert_eq!(frames.len(), 3);
    for (k, (_, file)) in frames.iter().enumerate() {
        holds(&moved["steps"][k]["quality"], &read(file).unwrap(), "move, a frame");
    }
    assert_eq!(moved["after"]["quality"], moved["steps"][2]["quality"]);
}

#[test]
fn a_page_has_the_distribution_of_meshes_and_logs() {
    let folder = folder();
    let line = |step: u32, worst: f64| {
        format!(
            "{{\"step\": {step}, \"quality\": {{\"worst\": {worst}, \"p1\": 0.3, \"median\": 0.6, \"mean\": 0.5}}}}\n"
        )
    };
    folder.write("run.jsonl", (line(0, 0.2) + &line(1, 0.25)).as_bytes());
    folder.motet(["report", "box.vtu", "run.jsonl", "-o", "page.html"]).assert().success();
    let page = String::from_utf8(folder.read("page.html")).unwrap();
    for what in ["EAS (quality of a tet), of all tets", "1 % below", "5 % below", "median EAS", "mean ratio"]
    {
        assert!(page.contains(what), "{what}");
    }
}

#[test]
fn quality_compares_meshes_by_every_measure() {
    let folder = folder();
    folder.motet(["remesh", "box.vtu", "--goal", "best", "-o", "best.vtu"]).assert().success();
    let call = folder.motet(["quality", "box.vtu", "best.vtu", "--json"]).assert().success();
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    for (entry, name) in report["meshes"].as_array().unwrap().iter().zip(["box.vtu", "best.vtu"]) {
        let mesh = read(folder.path(name)).unwrap();
        assert_eq!(entry["file"], name);
        assert_eq!(entry["tets"], mesh.cells.tets().count());
        assert_eq!(entry["measures"].as_object().unwrap().len(), Measure::ALL.len());
        for measure in Measure::ALL {
            let tets = mesh.cells.tets().map(|(_, tet)| tet.map(|v| mesh.points[v.index()]));
            let mut sorted: Vec<f64> = tets.map(|tet| measure.of_tet(tet)).collect();
            sorted.sort_by(f64::total_cmp);
            if !measure.is_better_if_larger() {
                sorted.reverse();
            }
            let at = |part: f64| sorted[(part * (sorted.len() - 1) as f64) as usize];
            let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
            let expected = [("worst", at(0.0)), ("p1", at(0.01)), ("p5", at(0.05)), ("median", at(0.5))];
            let found = &entry["measures"][measure.as_str()];
            for (key, value) in expected.into_iter().chain([("mean", mean)]) {
                let is = found[key].as_f64().unwrap();
                assert!((is - value).abs() < 1e-11 * value.abs().max(1.0), "{measure} {key}: {is} {value}");
            }
        }
    }
    let words = ["quality", "box.vtu", "best.vtu", "--measures", "eas,radius_ratio"];
    let table = stdout(&folder.motet(words).assert().success());
    let names = ["mesh", "box.vtu", "best.vtu", "", "measure", "eas", "best.vtu", "radius_ratio", "best.vtu"];
    let first = |line: &str| line.split_whitespace().next().unwrap_or_default().to_string();
    assert_eq!(table.lines().map(first).collect::<Vec<_>>(), names);
    let call = folder.motet(["quality", "box.vtu", "--measures", "radius"]).assert().code(2);
    assert!(stderr(&call).contains("radius_ratio"), "{}", stderr(&call));
    let call = folder.motet(["quality", "ball.stl"]).assert().code(3);
    assert!(stderr(&call).contains("there are no tets"), "{}", stderr(&call));
}
