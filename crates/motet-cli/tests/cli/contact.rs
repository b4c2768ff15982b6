//! `motet contact`: what it writes, what it reports, what it refuses.

use crate::common::{Folder, stderr, stdout};
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::io::{SeriesWriter, WriteOptions, read, read_series};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Field, Surface};
use serde_json::Value;

/// The boundary of the box between two corners, facing outward.
fn block(low: Point, high: Point) -> Mesh {
    let surface = Surface::boundary_of(&box_grid([2; 3], [low, high]));
    let used = surface.vertices();
    let new = |v: &VertexId| VertexId::new(used.binary_search(v).expect("a vertex of a triangle"));
    let vertices = surface.triangles.as_flattened().iter().map(new).collect();
    let points = used.iter().map(|v| surface.points[v.index()]).collect();
    Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, vertices).expect("by threes"))
}

/// Two blocks 0.5 apart along x, the second of them on its way to the first at speed 2.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("left.vtp", &block([0.0; 3], [1.0; 3]));
    let mut right = block([1.5, 0.25, 0.25], [2.0, 0.75, 0.75]);
    right.set_point_field(Field::vectors("v", &vec![[-2.0, 0.0, 0.0]; right.points.len()]));
    folder.mesh("right.vtp", &right);
    folder
}

fn report(folder: &Folder, words: &str) -> Value {
    let call = folder.motet(words.split_whitespace()).arg("--json").assert().success();
    serde_json::from_str(&stdout(&call)).expect("one JSON object")
}

fn values(mesh: &Mesh, name: &str) -> Vec<f64> {
    mesh.point_field(name).unwrap_or_else(|| panic!("an array {name}")).values.to_f64().expect("numbers")
}

#[test]
fn two_blocks_have_their_gap_on_both_and_in_the_report() {
    let folder = folder();
    let reported = report(&folder, "contact left.vtp right.vtp -o gaps.vtp --warn 0.6");
    let step = &reported["steps"][0];
    assert_eq!(step["least"], 0.5);
    assert_eq!(step["pairs"][0]["distance"], 0.5);
    assert_eq!(step["pairs"][0]["bodies"], serde_json::json!(["left", "right"]));
    assert_eq!(reported["bodies"][1]["closed"], true);
    assert_eq!((&reported["warning"], &step["time"]), (&Value::Bool(true), &Value::from(0.0)));
    let mesh = read(folder.path("gaps.vtp")).expect("it is written");
    let (gap, warning) = (values(&mesh, "gap"), values(&mesh, "warning"));
    let (body, cell) = (values(&mesh, "closest_body"), values(&mesh, "closest_cell"));
    let normal = mesh.point_field("gap_normal").expect("normals").to_vectors().expect("vectors");
    let n_left = read(folder.path("left.vtp")).expect("the input").points.len();
    let body_of = mesh.cell_field("body").expect("bodies").values.to_f64().expect("numbers");
    let mut on_face = 0;
    for (i, p) in mesh.points.iter().enumerate() {
        assert_eq!(body[i], if i < n_left { 2.0 } else { 1.0 });
        assert_eq!(body_of[cell[i] as usize], body[i], "the closest cell is one of the closest body");
        // A vertex has a warning if its triangles do.
        assert!(warning[i] == 1.0 || gap[i] >= 0.6, "{p:?}");
        assert!(warning[i] == 0.0 || gap[i] <= 1.2, "{p:?}");
        if p[0] == 1.5 {
            on_face += 1;
            assert_eq!((gap[i], normal[i]), (0.5, [-1.0, 0.0, 0.0]));
        }
    }
    assert_eq!(on_face, 9);
    assert_eq!(
        mesh.cells.len(),
        reported["bodies"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|b| b["triangles"].as_u64().expect("a count") as usize)
            .sum::<usize>()
    );
}

#[test]
fn it_is_reported_in_words_with_a_histogram() {
    let folder = folder();
    let call = folder
        .motet(["contact", "left.vtp", "right.vtp", "-o", "gaps.vtp", "--warn", "0.6"])
        .assert()
        .success();
    let said = stdout(&call);
    for word in
        ["left and right", "0.5000", "median", "####", "warned: 17 vertices of right", "wrote gaps.vtp"]
    {
        assert!(said.contains(word), "{word} in {said}");
    }
    let call = folder.motet("contact left.vtp right.vtp -o gaps.vtp -q".split(' ')).assert().success();
    assert_eq!((stdout(&call), stderr(&call)), (String::new(), String::new()));
}

#[test]
fn velocities_tell_when_it_will_touch() {
    let folder = folder();
    let reported = report(&folder, "contact left.vtp right.vtp -o gaps.vtp --velocity v");
    let after = reported["steps"][0]["first_contact"]["after"].as_f64().expect("a time");
    assert!(after <= 0.25 && after > 0.249, "{after}");
    let times = values(&read(folder.path("gaps.vtp")).expect("it is written"), "time_to_contact");
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((least - after).abs() < 1e-15, "{least}");
    assert!(times.iter().any(|t| t.is_nan()), "the far sides never touch");
    let reported = report(&folder, "contact left.vtp right.vtp -o gaps.vtp --velocity v --horizon 0.2");
    assert_eq!(reported["steps"][0]["first_contact"], Value::Null);
}

#[test]
fn a_series_goes_in_and_a_series_comes_out() {
    let folder = folder();
    let mut series = SeriesWriter::new(folder.path("right.pvd"), WriteOptions::default());
    let mut block = read(folder.path("right.vtp")).expect("the input");
    for k in 0..5 {
        series.add(f64::from(k), &block).expect("it is written");
        block.points.iter_mut().for_each(|p| p[0] -= 0.2);
    }
    let reported = report(&folder, "contact left.vtp right.pvd -o out/gaps.pvd --warn 0.25");
    let steps = reported["steps"].as_array().expect("a list");
    let least: Vec<f64> = steps.iter().map(|step| step["least"].as_f64().expect("a gap")).collect();
    for (got, expected) in least.iter().zip([0.5, 0.3, 0.1, 0.0, 0.0]) {
        assert!((got - expected).abs() < 1e-12, "{least:?}");
    }
    assert_eq!(
        (&reported["first_warning"], &reported["first_touch"]),
        (&Value::from(2.0), &Value::from(3.0))
    );
    // At time 2 the contact is half a step away; none is visible from time 0.
    let after = steps[2]["first_contact"]["after"].as_f64().expect("a time");
    assert!(after <= 0.5 && after > 0.499, "{after}");
    assert_eq!(steps[0]["first_contact"], Value::Null);
    assert!(!steps[3]["pairs"][0]["crossings"].as_array().expect("a list").is_empty());
    assert!(steps[4]["pairs"][0]["depth"].as_f64().expect("a depth") > 0.2);
    let frames = read_series(folder.path("out/gaps.pvd")).expect("a series");
    let call = folder.motet(["contact", "left.vtp", "right.pvd", "-o", "last.vtp"]).assert().code(0);
    assert!(stderr(&call).contains("the last of 5 frames"), "{}", stderr(&call));
    assert_eq!(frames.len(), 5);
    let last = read(&frames[4].1).expect("a frame");
    assert!(values(&last, "gap").iter().any(|&gap| gap < -0.2));
}

#[test]
fn patches_of_a_mesh_are_bodies() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &box_grid([4; 3], [[0.0; 3], [1.0, 2.0, 3.0]]));
    let reported = report(&folder, "contact box.vtu --patches zmin,zmax,xmin -o gaps.vtp");
    let pairs = reported["steps"][0]["pairs"].as_array().expect("a list");
    assert_eq!(pairs.len(), 3);
    assert_eq!(pairs[0]["distance"], 3.0);
    assert_eq!(pairs[1]["bodies"], serde_json::json!(["zmin", "xmin"]));
    let refused = folder.motet("contact box.vtu --patches zmin,top -o gaps.vtp".split(' ')).assert().code(2);
    assert!(stderr(&refused).contains("`top`") && stderr(&refused).contains("zmax"));
}

#[test]
fn a_room_is_found_and_reported_and_can_be_told() {
    let folder = Folder::new();
    folder.mesh("room.vtp", &block([0.0; 3], [4.0; 3]));
    folder.mesh("thing.vtp", &block([1.0; 3], [2.0; 3]));
    let call = folder.motet("contact thing.vtp room.vtp -o gaps.vtp".split(' ')).assert().success();
    let found = "room is treated as the room of thing, 100 % of whose area lies inside";
    assert!(stdout(&call).contains(found), "{}", stdout(&call));
    for words in ["", " --room room", " --method delaunay"] {
        let reported = report(&folder, &format!("contact thing.vtp room.vtp -o gaps.vtp --warn 0.5{words}"));
        assert_eq!(reported["steps"][0]["pairs"][0]["wrong"], serde_json::json!([0, 0]));
        assert_eq!(reported["steps"][0]["gaps"][0]["min"], 1.0);
        assert_eq!(
            (&reported["warning"], &reported["bodies"][1]["room"]),
            (&Value::Bool(false), &Value::Bool(true))
        );
        let share = if words.contains("--room") { Value::Null } else { 1.0.into() };
        assert_eq!(
            reported["rooms"],
            serde_json::json!([{ "room": "room", "surface": "thing", "share": share }])
        );
    }
    let solid = report(&folder, "contact thing.vtp room.vtp -o gaps.vtp --warn 0.5 --no-room");
    assert_eq!((&solid["rooms"], &solid["warning"]), (&serde_json::json!([]), &Value::Bool(true)));
    assert_eq!(solid["steps"][0]["gaps"][0]["max"], -1.0);
    folder.motet("contact thing.vtp room.vtp -o gaps.vtp --no-room --room room".split(' ')).assert().code(2);
}

#[test]
fn vertices_that_delaunay_tets_do_not_measure_have_finite_depths() {
    let folder = Folder::new();
    folder.mesh("solid.vtp", &block([0.0; 3], [4.0; 3]));
    folder.mesh("thing.vtp", &block([1.0; 3], [2.0; 3]));
    let words = "contact thing.vtp solid.vtp -o gaps.vtp --warn 0.5 --method delaunay --no-room";
    let call = folder.motet(words.split(' ')).assert().success();
    let text = stdout(&call) + &stderr(&call);
    assert!(!text.contains("inf") && !text.contains("NaN"), "{text}");
    let reported = report(&folder, words);
    assert_eq!(reported["steps"][0]["gaps"][0]["max"], -1.0, "as deep as it is");
    assert!(
        reported["steps"][0]["warned"].as_array().expect("groups").iter().all(|group| group["gap"].is_f64())
    );
    let mesh = read(folder.path("gaps.vtp")).expect("it is written");
    assert!(values(&mesh, "gap")[..26].iter().all(|gap| gap.is_finite() && *gap < 0.0));
}

#[test]
fn rooms_of_a_series_are_those_of_its_first_frame() {
    let folder = Folder::new();
    folder.mesh("room.vtp", &block([0.0; 3], [4.0; 3]));
    let mut series = SeriesWriter::new(folder.path("thing.pvd"), WriteOptions::default());
    // The last frame has other triangles and lies outside.
    let last = Surface::boundary_of(&box_grid([1; 3], [[5.0; 3], [6.0; 3]]));
    let cells = last.triangles.as_flattened().to_vec();
    let last = Mesh::new(last.points, Cells::uniform(CellKind::TRIANGLE, cells).expect("by threes"));
    let frames = [block([1.0; 3], [2.0; 3]), block([3.0; 3], [4.5; 3]), last];
    for (k, mesh) in (0u8..).zip(&frames) {
        series.add(f64::from(k), mesh).expect("a frame is written");
    }
    let reported = report(&folder, "contact thing.pvd room.vtp -o out/gaps.pvd --warn 0.5");
    assert_eq!(reported["rooms"].as_array().map(Vec::len), Some(1));
    let wrong: Vec<_> = (0..3).map(|k| reported["steps"][k]["pairs"][0]["wrong"][0].as_u64()).collect();
    assert_eq!(wrong, [Some(0), Some(19), Some(8)]);
}

#[test]
fn a_surface_is_held_against_itself() {
    let folder = Folder::new();
    let (one, other) = (block([0.0; 3], [1.0; 3]), block([1.25, 0.0, 0.0], [2.0, 1.0, 1.0]));
    folder.mesh("one.vtp", &one);
    folder.mesh("other.vtp", &other);
    let mut two = one.clone();
    let first = two.points.len() as u32;
    other.cells.iter().for_each(|(_, kind, v)| two.cells.push(kind, v.iter().map(|v| VertexId(v.0 + first))));
    two.points.extend(&other.points);
    folder.mesh("two.vtp", &two);
    let reported = report(&folder, "contact two.vtp --self -o gaps.vtp --warn 0.3");
    assert_eq!(reported["steps"][0]["least"], 0.25);
    // As two files they have the same warnings.
    let apart = report(&folder, "contact one.vtp other.vtp -o apart.vtp --warn 0.3");
    let warned = |reported: &Value, body: usize| {
        reported["steps"][0]["gaps"][body]["warned"].as_u64().expect("a count")
    };
    assert_eq!(warned(&reported, 0), warned(&apart, 0) + warned(&apart, 1));
    let gap = |name: &str| values(&read(folder.path(name)).expect("it is written"), "gap");
    for (alone, among) in gap("gaps.vtp").into_iter().zip(gap("apart.vtp")) {
        // Vertices half way along the sides are measured along their own surface.
        assert!(alone == among || among > 0.5, "{alone} for {among}");
    }
}

#[test]
fn scripts_can_stop_at_a_warning() {
    let folder = folder();
    let call = |words: &str| folder.motet(words.split(' ').map(str::to_owned)).assert();
    call("contact left.vtp right.vtp -o gaps.vtp --warn 0.6 --fail-on-warning").code(4);
    assert!(folder.path("gaps.vtp").exists(), "what was found is written");
    call("contact left.vtp right.vtp -o gaps.vtp --warn 0.4 --fail-on-warning").code(0);
    call("contact left.vtp right.vtp -o gaps.vtp --warn 0.6").code(0);
    call("contact left.vtp right.vtp -o gaps.vtp --fail-on-warning").code(2);
}

#[test]
fn what_cannot_be_measured_is_refused_with_the_place() {
    let folder = folder();
    let points = vec![[0.0; 3], [1.0, f64::NAN, 0.0], [0.0, 1.0, 0.0]];
    let triangle = Cells::uniform(CellKind::TRIANGLE, [0, 1, 2].map(VertexId).to_vec()).expect("by threes");
    folder.mesh("nan.vtp", &Mesh::new(points.clone(), triangle));
    folder.mesh("points.vtu", &Mesh::new(points, Cells::new()));
    for (words, code, said) in [
        ("contact left.vtp -o gaps.vtp", 2, "another surface"),
        ("contact left.vtp points.vtu -o gaps.vtp", 3, "points.vtu"),
        ("contact left.vtp nan.vtp -o gaps.vtp", 3, "point 1"),
        ("contact left.vtp gone.vtp -o gaps.vtp", 3, "gone.vtp"),
        ("contact left.vtp right.vtp -o left.vtp", 2, "overwrite"),
        ("contact left.vtp right.vtp -o right.vtp/gaps.vtp", 3, "right.vtp is a file"),
        ("contact left.vtp right.vtp -o gaps.vtp --velocity w", 2, "`w`"),
        ("contact left.vtp right.vtp -o gaps.vtp --horizon 1", 2, "--velocity"),
        ("contact left.vtp right.vtp -o gaps.vtp --room wall", 2, "left, right"),
        ("contact left.vtp right.vtp -o gaps.vtp --patches a,b", 2, "one mesh"),
        ("contact left.vtp right.vtp -o gaps.vtp --warn 0", 2, "positive"),
    ] {
        let call = folder.motet(words.split(' ')).assert().code(code);
        assert!(stderr(&call).contains(said), "{words}: {}", stderr(&call));
    }
    assert!(!folder.path("gaps.vtp").exists());
}
