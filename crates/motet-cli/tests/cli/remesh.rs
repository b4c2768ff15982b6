//! `motet remesh`: what it writes, what it reports, what it refuses.

use crate::common::random::Random;
use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::{CellId, Point, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet;
use motet::io::read;
use motet::mesh::history::{History, Origin};
use motet::mesh::shapes::{box_grid, quadratic};
use motet::mesh::{CellKind, Field};
use serde_json::Value;

fn linear(p: Point) -> f64 {
    2.0 * p[0] - 3.0 * p[1] + 0.5 * p[2] + 1.0
}

/// A box whose inner vertices were shaken by up to `shake` of a cell, with a linear and two constant fields.
fn shaken(shake: f64) -> Mesh {
    let mut mesh = box_grid([5; 3], [[0.0; 3], [1.0; 3]]);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for point in mesh.points.iter_mut().filter(|p| p.iter().all(|&x| x > 0.0 && x < 1.0)) {
        *point = point.map(|x| x + shake / 5.0 * random.between(-1.0, 1.0));
    }
    let (n_points, n_cells) = (mesh.points.len(), mesh.cells.len());
    mesh.set_point_field(Field::scalars(
        "linear",
        mesh.points.iter().map(|p| linear(*p)).collect::<Vec<_>>(),
    ));
    mesh.set_point_field(Field::scalars("constant", vec![0.3; n_points]));
    mesh.set_cell_field(Field::scalars("constant", vec![0.1; n_cells]));
    mesh.set_cell_field(Field::scalars("number", (0..n_cells as i64).collect::<Vec<_>>()));
    mesh
}

/// A folder with a mesh that can be repaired completely, and one with a wall that allows no good tet.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("shaken.vtu", &shaken(0.4));
    let mut flat = box_grid([3; 3], [[0.0; 3], [1.0; 3]]);
    flat.points.iter_mut().for_each(|p| p[2] *= 0.05);
    folder.mesh("flat.vtu", &flat);
    folder
}

fn report(call: &assert_cmd::assert::Assert) -> Value {
    serde_json::from_str(&stdout(call)).expect("one object")
}

/// EAS of every tet, with its cell.
fn qualities(mesh: &Mesh) -> Vec<(CellId, f64)> {
    mesh.cells.tets().map(|(cell, t)| (cell, eas(t.map(|v| mesh.points[v.index()])))).collect()
}

#[test]
fn a_mesh_is_repaired_and_the_report_is_true() {
    let folder = folder();
    let call = folder.motet(["remesh", "shaken.vtu", "-o", "out.vtu", "--json"]).assert().code(0);
    let reported = report(&call);
    for key in ["mesh", "output", "complete", "min_eas", "operations", "kept", "untouched", "layers", "left"]
    {
        assert!(!reported[key].is_null(), "{key}");
    }
    for stage in ["read", "join", "repair", "extract", "history", "fields", "write", "total"] {
        assert!(reported["seconds"][stage].as_f64().is_some_and(|s| s >= 0.0), "{stage}");
    }
    assert_eq!(reported["complete"], true);
    assert_eq!(reported["left"].as_array().map(Vec::len), Some(0));
    for (state, file) in [("before", "shaken.vtu"), ("after", "out.vtu")] {
        let (state, mesh) = (&reported[state], read(folder.path(file)).unwrap());
        let qualities = qualities(&mesh);
        let n = |holds: &dyn Fn(f64) -> bool| qualities.iter().filter(|q| holds(q.1)).count();
        assert_eq!(state["points"], mesh.points.len());
        assert_eq!(state["cells"], mesh.cells.len());
        assert_eq!(state["tets"], qualities.len());
        assert_eq!(state["bad"], n(&|q| q < 0.2));
        assert_eq!(state["inverted"], n(&|q| q <= 0.0));
        let types = state["types"].as_object().unwrap();
        assert_eq!(types.values().map(|n| n.as_u64().unwrap()).sum::<u64>(), n(&|q| q < 0.2) as u64);
        let worst = qualities.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert_eq!(state["worst_eas"]["value"], worst.1);
        assert_eq!(state["worst_eas"]["cell"], worst.0.0);
        assert_eq!(state["worst_eas"]["place"].as_array().map(Vec::len), Some(3));
    }
    assert!(reported["before"]["bad"].as_u64() > Some(5));
    assert_eq!(folder.names(), ["flat.vtu", "out.vtu", "shaken.vtu"]);
}

#[test]
fn a_smallest_angle_may_be_asked() {
    let folder = folder();
    let words = ["remesh", "shaken.vtu", "-o", "out.vtu", "--min-dihedral", "16", "--json"];
    let reported = report(&folder.motet(words).assert().code(0));
    assert!(reported["min_eas"].as_f64().is_some_and(|eas| eas > 0.2), "{reported}");
    let info = report(&folder.motet(["info", "out.vtu", "--json"]).assert().code(0));
    assert!(info["quality"]["dihedral_deg"]["min"].as_f64().is_some_and(|deg| deg >= 16.0), "{info}");
}

#[test]
fn the_table_tells_what_was_found_and_done() {
    let folder = folder();
    let call = folder.motet(["remesh", "shaken.vtu", "-o", "out.vtu"]).assert().code(0);
    let reported = stdout(&call);
    for word in [
        "type",
        "found",
        "left",
        "III",
        "other",
        "done: ",
        "before",
        "after",
        "worst EAS",
        "inverted",
        "kept to the bit: ",
        "error of integral",
        "interpolated",
        "wrote out.vtu",
        "repaired",
    ] {
        assert!(reported.contains(word), "{word}: {reported}");
    }
    assert_eq!(stderr(&call), "");
    let call = folder.motet(["remesh", "shaken.vtu", "-o", "out.vtu", "-q"]).assert().code(0);
    assert_eq!((stdout(&call), stderr(&call)), (String::new(), String::new()));
}

#[test]
fn what_cannot_be_repaired_is_reported_with_place_and_reason() {
    let folder = folder();
    let words = ["remesh", "flat.vtu", "-o", "out.vtu", "--layers", "repair"];
    let call = folder.motet(words.into_iter().chain(["--json"])).assert().code(4);
    let reported = report(&call);
    assert_eq!(reported["complete"], false);
    let left = reported["left"].as_array().unwrap();
    assert_eq!(reported["after"]["bad"], left.len());
    assert!(left.len() > 10);
    let mesh = read(folder.path("out.vtu")).unwrap();
    for left in left {
        let cell = CellId::new(left["cell"].as_u64().unwrap() as usize);
        let tet = [0, 1, 2, 3].map(|i| mesh.points[mesh.cells.vertices(cell)[i].index()]);
        // To the last digit in the text; the parser of JSON may be off by one.
        assert!(stdout(&call).contains(&format!("\"eas\": {}", eas(tet))), "{left} {}", eas(tet));
        let place = left["place"].as_array().unwrap();
        assert!((place[0].as_f64().unwrap() - tet.iter().map(|p| p[0]).sum::<f64>() / 4.0).abs() < 1e-12);
        assert!(!left["reason"].is_null() && left["type"].is_string());
        assert!(left["why"].as_str().is_some_and(|why| why.len() > 10));
    }
    // The first ten and a count; all of them with -v.
    let call = folder.motet(words).assert().code(4);
    let lines = |reported: &str| reported.lines().filter(|line| line.starts_with("  cell ")).count();
    assert_eq!(lines(&stdout(&call)), 10);
    assert!(stdout(&call).contains(&format!("and {} more", left.len() - 10)));
    assert!(stderr(&call).contains("not reached: "), "{}", stderr(&call));
    let call = folder.motet(words.into_iter().chain(["-v"])).assert().code(4);
    assert_eq!(lines(&stdout(&call)), left.len());
}

#[test]
fn what_is_not_bad_stays_to_the_bit_and_fields_keep_what_they_mean() {
    let folder = folder();
    let words = ["remesh", "shaken.vtu", "-o", "out.vtu", "--history", "history.json", "--json"];
    let reported = report(&folder.motet(words).assert().code(0));
    let (old, new) = (read(folder.path("shaken.vtu")).unwrap(), read(folder.path("out.vtu")).unwrap());
    let history: History = serde_json::from_slice(&folder.read("history.json")).unwrap();
    assert_eq!((history.vertices.len(), history.cells.len()), (new.points.len(), new.cells.len()));
    let mut n_kept = 0;
    for (id, was) in (0..).zip(history.cells.kept()).filter_map(|(id, was)| Some((id, was.get()?))) {
        let bits = |mesh: &Mesh, v: &[VertexId]| -> Vec<[u64; 3]> {
            v.iter().map(|v| mesh.points[v.index()].map(f64::to_bits)).collect()
        };
        assert_eq!(bits(&new, new.cells.vertices(CellId(id))), bits(&old, old.cells.vertices(was)));
        n_kept += u64::from(new.cells.kind(CellId(id)) == CellKind::TETRA);
    }
    assert_eq!(reported["kept"], n_kept);
    // The arrays carried by the history are those written.
    for field in &old.point_data {
        assert_eq!(Some(&history.transfer_points(field).unwrap()), new.point_field(&field.name));
    }
    for field in &old.cell_data {
        assert_eq!(Some(&history.transfer_cells(field).unwrap()), new.cell_field(&field.name));
    }
    let values = new.point_field("linear").unwrap().values.to_f64().unwrap();
    let error = values.iter().zip(&new.points).map(|(x, p)| (x - linear(*p)).abs()).fold(0.0, f64::max);
    assert!(error < 1e-12, "{error:.3e}");
    assert_eq!(new.point_field("constant").unwrap().values, vec![0.3; new.points.len()].into());
    assert_eq!(new.cell_field("constant").unwrap().values, vec![0.1; new.cells.len()].into());
    assert_eq!(new.label_names, old.label_names);
    assert_eq!(new.patches().unwrap().used(), old.patches().unwrap().used());
    assert!(
        new.regions()
            .unwrap()
            .ids
            .iter()
            .zip(new.cells.kinds())
            .all(|(&id, &kind)| { id == i32::from(kind == CellKind::TETRA) })
    );
}

/// The integral of a cell array over all tets.
fn integral(mesh: &Mesh, name: &str) -> f64 {
    let values = mesh.cell_field(name).unwrap().values.to_f64().unwrap();
    let volume = |t: [VertexId; 4]| tet::volume(t.map(|v| mesh.points[v.index()])).abs();
    mesh.cells.tets().map(|(cell, t)| values[cell.index()] * volume(t)).sum()
}

#[test]
fn the_report_tells_how_well_arrays_were_carried() {
    let folder = Folder::new();
    // Without inverted tets, since overlapping tets contain too much.
    let mut mesh = shaken(0.3);
    let mut random = Random(0x1234_5678_9abc_def1);
    mesh.set_cell_field(Field::scalars(
        "pressure",
        (0..mesh.cells.len()).map(|_| random.between(-1.0, 1.0)).collect::<Vec<_>>(),
    ));
    folder.mesh("shaken.vtu", &mesh);
    let words = ["remesh", "shaken.vtu", "-o", "out.vtu", "--json", "--quality"];
    let words = words.into_iter().chain(["--carry", "constant=inherit", "--carry", "linear=linear"]);
    let reported = report(&folder.motet(words).assert().code(0));
    let new = read(folder.path("out.vtu")).unwrap();
    let fields = reported["fields"].as_array().unwrap();
    let heads: Vec<_> = fields.iter().map(|f| [&f["name"], &f["on"], &f["rule"]]).collect();
    // Integer arrays have no integrals; the quality was not carried.
    assert_eq!(
        heads,
        [
            ["linear", "points", "linear"],
            ["constant", "points", "inherit"],
            ["constant", "cells", "inherit"],
            ["pressure", "cells", "conserve"]
        ]
    );
    for field in fields {
        let regions = field["regions"].as_array().unwrap();
        assert!(regions.len() == 1 && regions[0]["region"] == 1, "{field}");
        assert!(regions[0]["deviation"].as_f64().is_some_and(|d| d < 1e-13), "{field}");
        let [before, after] =
            ["range_before", "range_after"].map(|range| [0, 1].map(|i| field[range][i].as_f64()));
        assert!(before[0] <= after[0] && after[1] <= before[1], "{field}");
    }
    // The integral of the linear field over the unit cube, and that of the array as written.
    let integral_of = |i: usize, when: &str| fields[i]["regions"][0][when][0].as_f64().unwrap();
    assert!(
        (integral_of(0, "before") - 0.75).abs() < 1e-12 && (integral_of(0, "after") - 0.75).abs() < 1e-12
    );
    assert!((integral_of(3, "before") - integral(&mesh, "pressure")).abs() < 1e-12);
    assert!((integral_of(3, "after") - integral(&new, "pressure")).abs() < 1e-12);
}

#[test]
fn arrays_are_carried_as_the_call_says() {
    let folder = folder();
    let words =
        ["remesh", "shaken.vtu", "-o", "out.vtu", "--carry", "linear=drop", "--carry", "constant=inherit"];
    folder.motet(words.into_iter().chain(["--quality"])).assert().code(0);
    let new = read(folder.path("out.vtu")).unwrap();
    assert!(new.point_field("linear").is_none() && new.point_field("constant").is_some());
    let written = new.cell_field("eas").unwrap().values.to_f64().unwrap();
    assert!(qualities(&new).into_iter().all(|(cell, q)| written[cell.index()] == q));
    for (word, part) in [("nothing=drop", "no array `nothing`"), ("number=mean", "no mean")] {
        let call = folder.motet(["remesh", "shaken.vtu", "-o", "new.vtu", "--carry", word]).assert().code(2);
        assert!(stderr(&call).contains(part), "{}", stderr(&call));
    }
    assert_eq!(folder.names(), ["flat.vtu", "out.vtu", "shaken.vtu"]);
}

#[test]
fn words_that_mean_nothing_are_refused() {
    let folder = folder();
    let call = |more: &[&str]| {
        let words = ["remesh", "shaken.vtu", "-o", "out.vtu"].iter().chain(more).copied().collect::<Vec<_>>();
        stderr(&folder.motet(words).assert().code(2))
    };
    assert!(call(&["--distance", "0.1"]).contains("`adapt`"));
    assert!(call(&["--min-eas", "0"]).contains("between 0"));
    assert!(call(&["--min-eas", "1.5"]).contains("between 0"));
    assert!(call(&["--min-dihedral", "80"]).contains("70"));
    assert!(call(&["--surface", "bend"]).contains("keep"));
    assert!(call(&["--surface", "adapt", "--distance", "0"]).contains("positive"));
    assert!(call(&["--carry", "linear"]).contains("ARRAY=drop"));
    assert!(call(&["--history", "out.vtu"]).contains("overwrite"));
    let docx = folder.motet(["remesh", "shaken.vtu", "-o", "out.docx"]).assert().code(2);
    assert!(stderr(&docx).contains(".vtu"));
    let nowhere = ["remesh", "shaken.vtu", "-o", "out.vtu", "--history", "flat.vtu/no/h.json"];
    assert!(stderr(&folder.motet(nowhere).assert().code(3)).contains("folder"));
    assert_eq!(folder.names(), ["flat.vtu", "shaken.vtu"]);
}

#[test]
fn a_mesh_without_linear_tets_is_refused_with_a_remedy() {
    let folder = folder();
    folder.mesh("quadratic.vtu", &quadratic(&box_grid([2; 3], [[0.0; 3], [1.0; 3]])));
    let call = folder.motet(["remesh", "quadratic.vtu", "-o", "out.vtu", "--json"]).assert().code(3);
    assert!(stderr(&call).starts_with("error: quadratic.vtu: "), "{}", stderr(&call));
    let reported = report(&call);
    assert!(reported["error"]["remedy"].is_string(), "{reported}");
    assert_eq!(folder.names(), ["flat.vtu", "quadratic.vtu", "shaken.vtu"]);
}

#[test]
fn a_good_mesh_comes_back_as_it_is() {
    let folder = folder();
    let good = folder.cube("good.vtu");
    let reported = report(&folder.motet(["remesh", &good, "-o", "out.vtu", "--json"]).assert().code(0));
    assert_eq!((&reported["untouched"], &reported["before"]["bad"]), (&1.0.into(), &0.into()));
    assert_eq!(folder.read("good.vtu"), folder.read("out.vtu"));
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let folder = folder();
    for (threads, out) in [("1", "one.vtu"), ("2", "two.vtu")] {
        let words = ["remesh", "shaken.vtu", "-o", out, "--threads", threads, "--surface", "adapt"];
        folder.motet(words).assert().code(0);
    }
    assert_eq!(folder.read("one.vtu"), folder.read("two.vtu"));
}

#[test]
fn other_formats_in_and_out() {
    let folder = folder();
    for name in ["a.msh", "a.mesh", "a.vtk", "folder/"] {
        folder.motet(["remesh", "shaken.vtu", "-o", name]).assert().code(0);
        let reported = report(&folder.motet(["info", name, "--json"]).assert().code(0));
        assert_eq!(reported["quality"]["eas"]["bad"], 0, "{name}");
        // Repaired again, nothing is bad any more.
        let again = folder.motet(["remesh", name, "-o", "again.vtu", "--json"]).assert().code(0);
        assert_eq!(report(&again)["untouched"], 1.0, "{name}");
    }
}

#[test]
fn a_surface_that_adapts_lets_more_be_repaired() {
    let folder = Folder::new();
    let mut mesh = shaken(0.0);
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    // Within the sides as well.
    for point in &mut mesh.points {
        let n_free = point.iter().filter(|&&x| x > 0.0 && x < 1.0).count();
        *point = point.map(|x| {
            x + if n_free >= 2 && x > 0.0 && x < 1.0 { 0.08 * random.between(-1.0, 1.0) } else { 0.0 }
        });
    }
    folder.mesh("sides.vtu", &mesh);
    let left = |more: &[&str]| {
        let words = ["remesh", "sides.vtu", "-o", "out.vtu", "--json"].iter().chain(more).copied();
        let call = folder.motet(words.collect::<Vec<_>>()).assert();
        let code = call.get_output().status.code();
        let reported = report(&call);
        assert_eq!(code, Some(if reported["complete"] == true { 0 } else { 4 }));
        reported["after"]["bad"].as_u64().unwrap()
    };
    let kept = left(&[]);
    let adapted = left(&["--surface", "adapt", "--distance", "0.01"]);
    assert!(adapted < kept, "{adapted} {kept}");
}

#[test]
fn the_history_tells_of_vertices_that_came_or_moved() {
    let folder = folder();
    let words = ["remesh", "shaken.vtu", "-o", "out.vtu", "--goal", "best", "--history", "h.json"];
    folder.motet(words).assert().code(0);
    let history: History = serde_json::from_slice(&folder.read("h.json")).unwrap();
    let changed = history.vertices.iter().filter(|origin| matches!(origin, Origin::Changed(_))).count();
    assert!(changed > 0);
}

/// A box of even tets with a point array of sizes.
fn sized() -> Folder {
    let folder = Folder::new();
    let mut mesh = shaken(0.0);
    let n = mesh.points.len();
    mesh.set_point_field(Field::scalars(
        "h",
        mesh.points.iter().map(|p| 0.1 + 0.2 * p[0]).collect::<Vec<_>>(),
    ));
    mesh.set_point_field(Field::vectors("velocity", &vec![[1.0; 3]; n]));
    let mut off = vec![0.2; n];
    off[17] = -0.2;
    mesh.set_point_field(Field::scalars("off", off));
    folder.mesh("box.vtu", &mesh);
    folder
}

#[test]
fn sizes_may_be_a_number_or_an_array() {
    let folder = sized();
    for (sizes, n_tets) in [("0.11", 5_000..15_000), ("h", 1_000..5_000), ("0.6", 20..400)] {
        let words = ["remesh", "box.vtu", "-o", "out.vtu", "--surface", "adapt", "--sizes", sizes, "--json"];
        let reported = report(&folder.motet(words).assert().code(0));
        let after = &reported["sizes"]["after"];
        println!("{sizes}: {} tets, {after}", reported["after"]["tets"]);
        assert_eq!((&after["too_long"], &reported["after"]["bad"]), (&0.into(), &0.into()));
        assert!(n_tets.contains(&reported["after"]["tets"].as_u64().unwrap()), "{reported}");
        assert!(after["max"].as_f64() <= Some(1.5) && after["min"].as_f64() > Some(0.0));
        for key in ["edges", "too_short", "too_long_held", "too_short_held"] {
            assert!(after[key].is_u64(), "{key}");
        }
        let new = read(folder.path("out.vtu")).unwrap();
        let values = new.point_field("linear").unwrap().values.to_f64().unwrap();
        assert!(values.iter().zip(&new.points).all(|(x, p)| (x - linear(*p)).abs() < 1e-12));
        assert_eq!(new.cell_field("constant").unwrap().values, vec![0.1; new.cells.len()].into());
    }
    let call = folder.motet(["remesh", "box.vtu", "-o", "out.vtu", "--sizes", "0.11"]).assert().code(0);
    for word in ["longer than 1.5", "shorter than 0.5", "of them held", "edges split"] {
        assert!(stdout(&call).contains(word), "{}", stdout(&call));
    }
    let reported = report(&folder.motet(["remesh", "box.vtu", "-o", "out.vtu", "--json"]).assert().code(0));
    assert!(reported["sizes"].is_null());
}

#[test]
fn sizes_that_are_none_are_refused() {
    let folder = sized();
    for (sizes, code, parts) in [
        ("0", 2, ["above 0", "point array"]),
        ("-1", 2, ["above 0", "point array"]),
        ("nan", 2, ["above 0", "point array"]),
        ("nothing", 2, ["a point array", "linear, constant, h"]),
        ("velocity", 3, ["array velocity", "one component"]),
        ("off", 3, ["point 17", "positive"]),
        ("1e-5", 3, ["at most 1.0e7", "times as large"]),
    ] {
        let words = ["remesh", "box.vtu", "-o", "out.vtu", &format!("--sizes={sizes}")].map(str::to_owned);
        let call = folder.motet(words).assert().code(code);
        assert!(parts.iter().all(|part| stderr(&call).contains(part)), "{sizes}: {}", stderr(&call));
    }
    assert_eq!(folder.names(), ["box.vtu"]);
}

#[test]
fn what_is_named_is_held() {
    let folder = folder();
    // All tets belong to one region: where it is held, nothing can be done.
    let words = ["remesh", "shaken.vtu", "-o", "held.vtu", "--hold", "box", "--surface", "adapt", "--json"];
    let reported = report(&folder.motet(words).assert().success());
    assert!(reported["held"].as_u64().unwrap() > 0 && reported["after"]["bad"] == 0, "{reported}");
    let [before, after] = ["shaken.vtu", "held.vtu"].map(|name| read(folder.path(name)).unwrap());
    assert!(before.points == after.points && before.cells == after.cells);
    let call =
        folder.motet(["remesh", "shaken.vtu", "-o", "never.vtu", "--hold", "nothing"]).assert().code(2);
    assert!(stderr(&call).contains("the mesh has the regions box"), "{}", stderr(&call));
}
