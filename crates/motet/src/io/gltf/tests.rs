//! Scenes made by hand: places, transforms, strips and fans, and files that contradict themselves.

use std::path::Path;

use super::*;
use crate::base::Threads;
use crate::io::format::Notes;

/// A scene of one tetrahedron: the buffer has 4 points, then 12 numbers of vertices as bytes.
fn scene(nodes: &str) -> (String, Vec<u8>) {
    let points: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{nodes}],
        "meshes": [{{"name": "tet", "primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}],
        "buffers": [{{"byteLength": 60}}]}}"#
    );
    (text, bytes)
}

fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut all = b"glTF".to_vec();
    all.extend(2u32.to_le_bytes());
    all.extend((28 + text.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(JSON, text.as_slice()), (BIN, binary)] {
        all.extend((chunk.len() as u32).to_le_bytes());
        all.extend(kind);
        all.extend(chunk);
    }
    all
}

fn read_bytes(bytes: &[u8]) -> Result<Mesh> {
    let (threads, notes) = (Threads::single(), Notes::default());
    read(&Input { path: Path::new("scene.glb"), bytes, threads: &threads, notes: &notes })
}

fn volume(mesh: &Mesh) -> f64 {
    crate::mesh::Surface::of(mesh).enclosed_volume()
}

#[test]
fn binary_and_text_hold_the_same_scene() {
    let (text, bytes) = scene(r#"{"mesh": 0}"#);
    let mesh = read_bytes(&glb(&text, &bytes)).unwrap();
    assert_eq!((mesh.points.len(), mesh.cells.len()), (4, 4));
    assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-15);
    use base64::Engine as _;
    let encoded = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let inside = text.replace(
        r#""byteLength": 60"#,
        &format!(r#""byteLength": 60, "uri": "data:application/octet-stream;base64,{encoded}""#),
    );
    assert_eq!(read_bytes(inside.as_bytes()).unwrap(), mesh);
    let outside = text.replace(r#""byteLength": 60"#, r#""byteLength": 60, "uri": "scene.bin""#);
    assert!(read_bytes(outside.as_bytes()).unwrap_err().to_string().contains("file of their own"));
}

#[test]
fn nodes_are_moved_turned_scaled_and_mirrored() {
    let (text, bytes) = scene(
        r#"{"children": [1, 2], "translation": [10, 0, 0]},
           {"name": "a", "mesh": 0, "scale": [2, 2, -2], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]},
           {"name": "b", "mesh": 0, "matrix": [0, 3, 0, 0, -3, 0, 0, 0, 0, 0, 3, 0, 0, 5, 0, 1]}"#,
    );
    let mesh = read_bytes(&glb(&text, &bytes)).unwrap();
    assert_eq!(mesh.label_names.patches.values().collect::<Vec<_>>(), ["a", "b"]);
    // Eight and 27 times the volume; the mirrored one still faces outward.
    assert!((volume(&mesh) - 35.0 / 6.0).abs() < 1e-12, "{}", volume(&mesh));
    // A quarter of a turn around z takes x to y.
    let has = |q: Point| mesh.points.iter().any(|p| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-12));
    assert!(has([10.0, 2.0, 0.0]) && has([8.0, 0.0, 0.0]) && has([10.0, 0.0, -2.0]), "{:?}", mesh.points);
    assert!(has([10.0, 8.0, 0.0]) && has([7.0, 5.0, 0.0]), "{:?}", mesh.points);
}

#[test]
fn strips_and_fans_are_triangles() {
    for (mode, indices, expected) in [
        (5, [0, 1, 2, 3, 0, 1, 0, 0, 0, 0, 0, 0], vec![[0, 1, 2], [2, 1, 3]]),
        (6, [0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0], vec![[0, 1, 2], [0, 2, 3]]),
    ] {
        let (text, mut bytes) = scene(r#"{"mesh": 0}"#);
        bytes[48..].copy_from_slice(&indices);
        let text = text
            .replace(r#""indices": 1"#, &format!(r#""indices": 1, "mode": {mode}"#))
            .replace(r#""count": 12"#, r#""count": 4"#);
        let mesh = read_bytes(&glb(&text, &bytes)).unwrap();
        let found: Vec<Vec<u32>> =
            mesh.cells.iter().map(|(_, _, v)| v.iter().map(|v| v.0).collect()).collect();
        assert_eq!(found, expected);
    }
}

#[test]
fn files_that_contradict_themselves_are_refused() {
    let (text, bytes) = scene(r#"{"mesh": 0}"#);
    let whole = glb(&text, &bytes);
    for (from, to, part) in [
        (r#""count": 4"#, r#""count": 5"#, "beyond its view"),
        (r#""count": 4"#, r#""count": 18446744073709551615"#, "limit"),
        (r#""byteLength": 48"#, r#""byteLength": 4800"#, "beyond the buffer"),
        (r#""byteOffset": 48"#, r#""byteOffset": 18446744073709551615"#, "beyond the buffer"),
        (r#""bufferView": 0"#, r#""bufferView": 7"#, "no buffer view"),
        (r#""componentType": 5121"#, r#""componentType": 5126"#, "whole numbers"),
        (r#""nodes": [0]"#, r#""nodes": [0, 0]"#, "child twice"),
        (r#""nodes": [0]"#, r#""nodes": [3]"#, "does not exist"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 0, "children": [0]}"#, "child twice"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 1}"#, "does not exist"),
        (r#"{"mesh": 0}"#, r#"{}"#, "no triangles"),
        (r#""asset""#, r#""extensionsRequired": ["KHR_draco_mesh_compression"], "asset""#, "KHR_draco"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = read_bytes(&glb(&text.replacen(from, to, 1), &bytes)).unwrap_err().to_string();
        assert!(error.contains(part), "{to}: {error}");
    }
    let mut off = bytes.clone();
    off[48] = 9;
    assert!(read_bytes(&glb(&text, &off)).unwrap_err().to_string().contains("vertex 9 of 4"));
    // Cut anywhere, or with any byte changed, it is read or refused.
    for n in 0..whole.len() {
        let _ = read_bytes(&whole[..n]);
        let mut changed = whole.clone();
        changed[n] ^= 0xff;
        let _ = read_bytes(&changed);
    }
}
