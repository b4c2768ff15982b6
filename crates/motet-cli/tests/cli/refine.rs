//! `motet refine`: what it writes, what it remembers, what it refuses.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::Point;
use motet::io::read;
use motet::mesh::Field;
use motet::mesh::check::check;
use motet::mesh::history::History;
use motet::mesh::shapes::{Coil, ball, box_grid, mixed};
use serde_json::Value;

fn linear(p: Point) -> f64 {
    2.0 * p[0] - 3.0 * p[1] + 0.5 * p[2] + 1.0
}

fn lumen() -> Mesh {
    let mut mesh = box_grid([4; 3], [[0.0; 3], [1.0; 3]]);
    mesh.set_point_field(Field::scalars(
        "linear",
        mesh.points.iter().map(|p| linear(*p)).collect::<Vec<_>>(),
    ));
    mesh.set_point_field(Field::vectors("velocity", &mesh.points));
    let n = mesh.cells.len();
    mesh.set_cell_field(Field::scalars("stress", (0..n).map(|c| c as f64).collect::<Vec<_>>()));
    mesh
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("lumen.vtu", &lumen());
    let coil = Coil { centre: [0.5; 3], radius: 0.2, pitch: 0.1, turns: 2.0, wire_radius: 0.02 };
    folder.mesh("coil.vtp", &coil.mesh(24, 8).unwrap());
    folder
}

fn report(folder: &Folder, words: &[&str]) -> Value {
    let call = folder.motet(words.iter().chain(&["--json"])).assert().success();
    serde_json::from_str(&stdout(&call)).unwrap()
}

#[test]
fn what_is_divided_is_remembered_and_taken_back() {
    let folder = folder();
    let reported = report(
        &folder,
        &["refine", "lumen.vtu", "-o", "one.vtu", "--ball", "0.2,0.2,0.2,0.1", "--generations", "2"],
    );
    let steps = reported["steps"].as_array().unwrap();
    assert_eq!(steps.iter().map(|s| s["step"].as_str().unwrap()).collect::<Vec<_>>(), ["came", "1", "2"]);
    assert!(steps.windows(2).all(|w| w[0]["tets"].as_u64() < w[1]["tets"].as_u64()));
    assert_eq!((reported["complete"].as_bool(), reported["first_tets"].as_u64()), (Some(true), Some(384)));
    assert!(reported["volume_deviation"].as_f64().unwrap() < 1e-13);
    let one = read(folder.path("one.vtu")).unwrap();
    assert!(check(&one).is_empty());
    let values = one.point_field("linear").unwrap().values.to_f64().unwrap();
    assert!(one.points.iter().zip(values).all(|(p, value)| (value - linear(*p)).abs() < 1e-13));
    assert!(one.cell_field("refine_root").is_some() && one.point_field("refine_reference").is_some());

    // Taking back level after level restores the points and cells of the file.
    report(&folder, &["refine", "one.vtu", "-o", "two.vtu", "--coarsen"]);
    let two = read(folder.path("two.vtu")).unwrap();
    assert!(two.cells.len() < one.cells.len() && two.cell_field("refine_root").is_some());
    report(&folder, &["refine", "two.vtu", "-o", "three.vtu", "--coarsen"]);
    let (three, first) = (read(folder.path("three.vtu")).unwrap(), lumen());
    assert!(three.points == first.points && three.cells == first.cells);
    assert!(three.cell_field("refine_root").is_none());
    assert_eq!(three.point_data, first.point_data);
    // So does taking back as many levels at once as requested.
    report(&folder, &["refine", "one.vtu", "-o", "four.vtu", "--coarsen", "--generations", "6"]);
    assert!(folder.read("four.vtu") == folder.read("three.vtu"));
}

#[test]
fn a_front_that_moves_on_leaves_nothing_behind() {
    let folder = folder();
    let at = |x: f64, input: &str, output: &str| {
        let words = format!("{x},0,0,{},1,1", x + 0.25);
        let words = ["refine", input, "-o", output, "--box", &words, "--limit-generation", "1", "--coarsen"];
        report(&folder, &words)["steps"].as_array().unwrap().last().unwrap()["tets"].as_u64().unwrap()
    };
    let n = [at(0.0, "lumen.vtu", "0.vtu"), at(0.25, "0.vtu", "1.vtu"), at(0.5, "1.vtu", "2.vtu")];
    assert!(n[0] > 600 && n[1] < 2 * n[0] && n[2] < 2 * n[1], "{n:?}");
    let direct = at(0.5, "lumen.vtu", "direct.vtu");
    assert_eq!(n[2], direct, "as if it had always been there");
}

#[test]
fn edges_get_short_at_a_device() {
    let folder = folder();
    let words = [
        "refine",
        "lumen.vtu",
        "-o",
        "fine.vtu",
        "--near-size",
        "coil.vtp=0.1,0.5",
        "--quality",
        "--history",
        "h.json",
    ];
    let reported = report(&folder, &words);
    assert_eq!(reported["complete"].as_bool(), Some(true));
    let fine = read(folder.path("fine.vtu")).unwrap();
    assert!(check(&fine).is_empty() && fine.cell_field("eas").is_some());
    let history: History = serde_json::from_slice(&folder.read("h.json")).unwrap();
    assert_eq!((history.vertices.len(), history.cells.len()), (fine.points.len(), fine.cells.len()));
    assert_eq!(history.cells.n_old(), lumen().cells.len());
    // Nothing is left to do, and nothing is done.
    let again = report(
        &folder,
        &["refine", "fine.vtu", "-o", "again.vtu", "--near-size", "coil.vtp=0.1,0.5", "--coarsen"],
    );
    let steps = again["steps"].as_array().unwrap();
    assert_eq!(steps[0]["tets"], steps.last().unwrap()["tets"]);
    // If stopped early, what was reached is written.
    let words =
        ["refine", "lumen.vtu", "-o", "short.vtu", "--near-size", "coil.vtp=0.05", "--limit-generation", "1"];
    let call = folder.motet(words).assert().code(4);
    assert!(stderr(&call).contains("not reached: not all edges are as short"), "{}", stderr(&call));
    let call = folder.motet(words.iter().chain(&["--json"])).assert().code(4);
    let reported: Value = serde_json::from_str(&stdout(&call)).unwrap();
    assert!(
        reported["not_reached"].as_str().is_some_and(|why| why.starts_with("not all edges")),
        "{reported}"
    );
    assert!(folder.path("short.vtu").exists());
}

#[test]
fn new_points_lie_on_the_true_surface() {
    let folder = Folder::new();
    let sphere = |n| ball(n, 2);
    folder.mesh("ball.vtu", &sphere(3));
    folder.mesh("true.vtu", &sphere(24));
    let reported = report(&folder, &["refine", "ball.vtu", "-o", "straight.vtu", "--all"]);
    assert!(reported["on_surface"].is_null());
    let reported =
        report(&folder, &["refine", "ball.vtu", "-o", "round.vtu", "--all", "--surface", "true.vtu"]);
    assert!(reported["on_surface"]["moved"].as_u64().unwrap() > 50, "{reported}");
    assert_eq!(reported["on_surface"]["short"].as_u64(), Some(0));
    let volume = |name: &str| {
        let mesh = read(folder.path(name)).unwrap();
        assert!(check(&mesh).is_empty(), "{name}");
        mesh.cells
            .tets()
            .map(|(_, t)| motet::geometry::tet::volume(t.map(|v| mesh.points[v.index()])))
            .sum::<f64>()
    };
    let [first, straight, round, exact] = ["ball.vtu", "straight.vtu", "round.vtu", "true.vtu"].map(volume);
    assert!((straight - first).abs() < 1e-12 * first);
    assert!(exact - round < 0.35 * (exact - first), "{first} {round} {exact}");
    // Back to the first mesh all the same.
    report(&folder, &["refine", "round.vtu", "-o", "back.vtu", "--coarsen"]);
    assert!(read(folder.path("back.vtu")).unwrap().points == sphere(3).points);
}

#[test]
fn cells_of_other_kinds_stay() {
    let folder = Folder::new();
    folder.mesh("mixed.vtu", &mixed(3));
    let call = folder.motet(["refine", "mixed.vtu", "-o", "fine.vtu", "--all"]).assert().success();
    assert!(
        stdout(&call).contains("cells of other kinds (except lines) hold their edges"),
        "{}",
        stdout(&call)
    );
}

#[test]
fn what_cannot_be_is_refused_before_any_work() {
    let folder = folder();
    let refused = |words: &[&str], code: i32, what: &str| {
        let all = ["refine", "lumen.vtu", "-o", "never.vtu"].iter().chain(words);
        let call = folder.motet(all).assert().code(code);
        assert!(stderr(&call).contains(what), "{words:?}: {}", stderr(&call));
        assert!(!folder.path("never.vtu").exists());
    };
    refused(&[], 2, "--all");
    refused(&["--where", "nothing>1"], 3, "nothing");
    refused(&["--where", "linear>1e9"], 3, "no tet is marked");
    refused(&["--ball", "9,9,9,1"], 3, "no tet is marked");
    refused(&["--size", "1e-9"], 3, "there are ids for only");
    refused(&["--near", "absent.stl=1"], 3, "absent.stl");
    refused(&["--ball", "1,2,3"], 2, "--ball");
    refused(&["--region", "nowhere"], 2, "nowhere");
    refused(&["--all", "--history", "lumen.vtu"], 2, "lumen.vtu");
    // Memory arrays that belong to another mesh.
    let mut wrong = lumen();
    let n = wrong.cells.len();
    wrong.set_cell_field(Field::scalars("refine_root", vec![0; n]));
    folder.mesh("wrong.vtu", &wrong);
    let call = folder.motet(["refine", "wrong.vtu", "-o", "never.vtu", "--all"]).assert().code(3);
    assert!(stderr(&call).contains("refine_path") && stderr(&call).contains("--forget"), "{}", stderr(&call));
    folder.motet(["refine", "wrong.vtu", "-o", "anew.vtu", "--all", "--forget"]).assert().success();
}
