//! A scene that is moved, and the server that pages ask.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::Arc;
use std::thread;

use motet::base::{Point, Threads};
use motet::geometry::vector::{norm, sub};
use motet::mesh::Cells;
use motet::mesh::shapes::sphere_in_box;
use motet::{Mesh, contact};
use motet_view::{MoveRequest, PreviewRequest, Scene, Server};
use serde_json::{Value, json};

fn scene(mesh: Mesh) -> Scene {
    Scene::new(mesh, "a.vtu", Threads::single()).unwrap()
}

/// A sphere of radius 1 in a box that reaches from -5 to 5.
fn sphere() -> Scene {
    scene(sphere_in_box(6, 6))
}

fn move_request(patch: &str, by: Point) -> MoveRequest {
    serde_json::from_value(json!({ "patch": patch, "by": by })).unwrap()
}

fn preview_request(patch: &str, by: Point) -> PreviewRequest {
    serde_json::from_value(json!({ "patch": patch, "by": by, "array": "gap", "inside": true })).unwrap()
}

fn facts(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The facts and the lists of an answer to a preview.
fn unpacked(answer: &[u8]) -> (Value, Vec<(String, Vec<u8>)>) {
    let length = u32::from_le_bytes(answer[..4].try_into().unwrap()) as usize;
    let facts: Value = serde_json::from_slice(&answer[4..4 + length]).unwrap();
    let mut rest = &answer[4 + length.next_multiple_of(4)..];
    let lists = facts["lists"].as_array().unwrap().iter().map(|list| {
        let (bytes, after) = rest.split_at(4 * list[1].as_u64().unwrap() as usize);
        rest = after;
        (list[0].as_str().unwrap().to_owned(), bytes.to_vec())
    });
    let lists = lists.collect();
    assert!(rest.is_empty());
    (facts, lists)
}

/// The positions of the vertices of the sphere.
fn places(mesh: &Mesh) -> Vec<Point> {
    let patches = mesh.patches().unwrap();
    let sphere = patches.find("sphere").unwrap();
    let cells = mesh.cells.iter().zip(&patches.ids).filter(|(_, id)| **id == sphere);
    cells.flat_map(|((_, _, vertices), _)| vertices).map(|v| mesh.points[v.index()]).collect()
}

/// The least and the largest coordinate of the sphere along an axis.
fn extent(mesh: &Mesh, axis: usize) -> [f64; 2] {
    let along = places(mesh).into_iter().map(|p| p[axis]);
    along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[test]
fn a_preview_changes_nothing_and_tells_where_everything_goes() {
    let mut scene = sphere();
    let before = scene.file().unwrap();
    let (said, lists) = unpacked(&scene.preview(&preview_request("sphere", [0.25, 0.0, 0.0])).unwrap());
    assert_eq!(scene.file().unwrap(), before);
    assert_eq!(said["tets"], scene.mesh().cells.tets().count());
    let names: Vec<&str> = lists.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["points", "skin", "inside", "bad"]);
    assert_eq!(lists[0].1.len(), 12 * scene.mesh().points.len());
    assert_eq!(lists[1].1.len() + lists[2].1.len(), 4 * scene.mesh().points.len());
    // The moved sphere is among them, to the precision of the page.
    let places =
        lists[0].1.as_chunks::<12>().0.iter().map(|bytes| {
            [0, 4, 8].map(|i| f64::from(f32::from_le_bytes(bytes[i..i + 4].try_into().unwrap())))
        });
    let on_sphere = |centre: Point| move |p: &Point| (norm(sub(*p, centre)) - 1.0).abs() < 1e-6;
    let n = scene.mesh().points.iter().filter(|p| on_sphere([0.0; 3])(p)).count();
    assert!(n > 0);
    assert_eq!(places.filter(on_sphere([0.25, 0.0, 0.0])).count(), n);
}

#[test]
fn steps_are_undone_to_the_byte() {
    let mut scene = sphere();
    let mut files = vec![scene.file().unwrap()];
    for by in [[0.9, 0.0, 0.0], [0.0, 0.8, 0.3], [-1.2, 0.0, 0.0]] {
        let said = facts(&scene.shift(&move_request("sphere", by)).unwrap());
        assert!(said["can_undo"] == true && said["inverted"] == 0 && said["bad"] == 0, "{said}");
        let file = scene.file().unwrap();
        assert!(!files.contains(&file));
        files.push(file);
    }
    files.pop();
    for file in files.iter().rev() {
        scene.undo().unwrap();
        assert!(scene.file().unwrap() == *file);
    }
    assert_eq!(facts(&scene.facts().unwrap())["can_undo"], false);
    assert!(scene.undo().is_err());
}

#[test]
fn what_is_undone_can_be_done_again_with_the_same_bytes() {
    let mut scene = sphere();
    let by = move_request("sphere", [0.7, 0.7, -0.7]);
    scene.shift(&by).unwrap();
    let file = scene.file().unwrap();
    scene.undo().unwrap();
    scene.shift(&by).unwrap();
    assert!(scene.file().unwrap() == file);
}

#[test]
fn a_part_stops_before_another_and_slides_along_it() {
    let mut scene = sphere();
    let said = facts(&scene.shift(&move_request("sphere", [50.0, 1.5, 0.0])).unwrap());
    assert_eq!(said["inverted"], 0, "{said}");
    let room = 5.0 - extent(scene.mesh(), 0)[1];
    assert!(0.01 < room && room < 0.5, "{room}: {said}");
    // It stopped along x alone, and is still a sphere.
    assert!((extent(scene.mesh(), 1)[1] - 2.5).abs() < 1e-2, "{:?}", extent(scene.mesh(), 1));
    let size = |axis| extent(scene.mesh(), axis)[1] - extent(scene.mesh(), axis)[0];
    assert!((0..3).all(|axis| (size(axis) - 2.0).abs() < 1e-9));
    assert!((said["gap"].as_f64().unwrap() - room).abs() < 1e-9, "{said}: {room}");
    // Pressed on, it stays; nothing creeps.
    for _ in 0..3 {
        scene.shift(&move_request("sphere", [50.0, 0.0, 0.0])).unwrap();
    }
    assert!(5.0 - extent(scene.mesh(), 0)[1] > 0.8 * room);
}

#[test]
fn questions_that_make_no_sense_are_refused_and_change_nothing() {
    let mut scene = sphere();
    let file = scene.file().unwrap();
    assert!(scene.shift(&move_request("nothing", [0.0; 3])).unwrap_err().to_string().contains("nothing"));
    for by in [[1e300; 3], [1e200, 0.0, 0.0]] {
        assert!(scene.shift(&move_request("sphere", by)).is_err());
        assert!(scene.preview(&preview_request("sphere", by)).is_err());
    }
    assert!(scene.file().unwrap() == file);
}

#[test]
fn a_surface_is_shown_but_not_moved() {
    let mesh = sphere_in_box(2, 2);
    let mut cells = Cells::new();
    for (_, kind, vertices) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        cells.push(kind, vertices.iter().copied());
    }
    let mesh = Mesh::new(mesh.points, cells);
    let mut scene = scene(mesh);
    let said = facts(&scene.facts().unwrap());
    assert!(said["not_movable"].as_str().unwrap().contains("cannot be moved"), "{said}");
    assert_eq!(said["patches"], json!([]));
    assert!(scene.page().unwrap().contains("id=\"live\""));
    assert!(scene.shift(&move_request("1", [0.0; 3])).is_err());
}

#[test]
fn a_mesh_with_a_point_that_is_not_finite_is_shown() {
    let mut mesh = sphere_in_box(2, 2);
    mesh.points[0][1] = f64::NAN;
    let scene = scene(mesh);
    assert!(facts(&scene.facts().unwrap())["not_movable"].as_str().unwrap().contains("not finite"));
    assert!(scene.page().unwrap().contains("id=\"live\""));
}

/// Status and text of an answer.
fn get(server: &Server, request: &str) -> (u16, String) {
    let address = server.address();
    let port = address.split(['/', ':']).nth(4).unwrap();
    let mut stream = TcpStream::connect(format!("127.0.0.1:{port}")).unwrap();
    stream.write_all(request.replace("PORT", port).as_bytes()).unwrap();
    let mut text = Vec::new();
    stream.read_to_end(&mut text).unwrap();
    let text = String::from_utf8_lossy(&text).into_owned();
    (text.split(' ').nth(1).unwrap().parse().unwrap(), text)
}

#[test]
fn only_who_knows_the_address_is_answered() {
    let scene = sphere();
    let server = Arc::new(Server::new(scene, 0).unwrap());
    let served = Arc::clone(&server);
    let thread = thread::spawn(move || served.serve());
    let address = server.address();
    let word = address.split('/').nth(3).unwrap();
    let ask = |path: &str, host: &str| {
        get(&server, &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"))
    };
    let post = |path: &str, text: &str| {
        let length = text.len();
        let request = format!(
            "POST /{word}/{path} HTTP/1.1\r\nHost: 127.0.0.1:PORT\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{text}"
        );
        get(&server, &request)
    };
    assert_eq!(ask(&format!("/{word}/"), "127.0.0.1:PORT").0, 200);
    assert_eq!(ask(&format!("/{word}/facts"), "localhost:PORT").0, 200);
    for (path, host) in [
        ("/".to_owned(), "127.0.0.1:PORT"),
        ("/facts".to_owned(), "127.0.0.1:PORT"),
        (format!("/{word}"), "127.0.0.1:PORT"),
        (format!("/{word}/../facts"), "127.0.0.1:PORT"),
        (format!("/{word}/facts"), "example.org"),
        (format!("/{word}/facts"), "example.org:PORT"),
        (format!("/{word}/none"), "127.0.0.1:PORT"),
    ] {
        assert_eq!(ask(&path, host).0, 404, "{path} {host}");
    }
    let move_by = json!({ "patch": "sphere", "by": [0.5, 0.0, 0.0] }).to_string();
    assert_eq!(ask(&format!("/{word}/move"), "127.0.0.1:PORT").0, 404);
    assert_eq!(post("move", &move_by).0, 200);
    for text in ["", "{}", "[1,2]", "{\"patch\": 3}", &format!("{move_by} more"), &"[".repeat(1 << 17)] {
        assert_eq!(post("move", text).0, 400, "{:.40}", text);
    }
    assert_eq!(post("undo", "{}").0, 200);
    let (status, text) = post("undo", "{}");
    assert!(status == 400 && text.contains("nothing to undo"), "{text}");
    let taken = Server::new(
        self::scene(sphere_in_box(2, 2)),
        address.split(['/', ':']).nth(4).unwrap().parse().unwrap(),
    );
    assert!(taken.is_err());
    server.close();
    thread.join().unwrap();
}

#[test]
fn gaps_are_those_of_a_measurement() {
    let scene = sphere();
    let mesh = scene.mesh();
    let names = ["sphere".to_owned(), "box".to_owned()];
    let bodies = contact::Body::of_mesh(mesh, "surface", &names, 0).unwrap();
    let bodies: Vec<_> = bodies.into_iter().map(|(body, _)| body).collect();
    let options = contact::Options::default();
    let mut contact =
        contact::Contact::new(mesh.points.clone(), bodies, options, &Threads::single()).unwrap();
    let least = contact.measure(&Threads::single()).least();
    assert_eq!(facts(&scene.facts().unwrap())["gap"], least);
}
