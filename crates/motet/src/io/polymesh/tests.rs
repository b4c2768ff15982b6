//! Round trips of cases, and truncated and damaged files.

use std::path::Path;

use crate::base::{Error, Point, Threads, VertexId};
use crate::io::format::{Encoding, Input, Notes, WriteOptions, Written};
use crate::io::polymesh::{FORMAT, is_case, read, write};
use crate::mesh::shapes::{mixed, quadratic, sphere_in_box};
use crate::mesh::{CellKind, Cells, Field, Mesh, cell_volumes};

fn written(mesh: &Mesh, encoding: Encoding) -> Written {
    write::write(mesh, &WriteOptions { encoding, ..WriteOptions::default() }, &Threads::single()).unwrap()
}

fn put(folder: &Path, written: &Written) {
    written.files.iter().for_each(|(name, bytes)| std::fs::write(folder.join(name), bytes).unwrap());
}

fn get(folder: &Path) -> Result<Mesh, Error> {
    let notes = Notes::default();
    let mesh = read::read(&Input { path: folder, bytes: &[], threads: &Threads::single(), notes: &notes })?;
    mesh.validate().map(|()| mesh)
}

#[test]
fn cells_of_every_kind_round_trip_in_their_order() {
    for mesh in [mixed(2), sphere_in_box(2, 2)] {
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let folder = tempfile::tempdir().unwrap();
            let written = written(&mesh, encoding);
            assert!(written.lost.is_empty(), "{:?}", written.lost);
            put(folder.path(), &written);
            assert!(is_case(folder.path()));
            let back = get(folder.path()).unwrap();
            assert_eq!(back.points, mesh.points);
            let solid = |mesh: &Mesh| {
                let kinds = mesh.cells.kinds().iter().copied();
                kinds.filter(|kind| kind.dim() == Some(3)).collect::<Vec<_>>()
            };
            assert_eq!(solid(&back), solid(&mesh));
            let before = cell_volumes(&mesh.cells, &mesh.points);
            let after = cell_volumes(&back.cells, &back.points);
            let volumes =
                before.iter().zip(&after).zip(mesh.cells.kinds()).filter(|(_, k)| k.dim() == Some(3));
            volumes.for_each(|((a, b), kind)| assert!((a - b).abs() < 1e-14, "{kind:?}: {a} {b}"));
            let used = |mesh: &Mesh| -> Vec<String> {
                let patches = mesh.patches().unwrap();
                patches.used().into_iter().map(|label| patches.name(label)).collect()
            };
            assert_eq!(used(&back), used(&mesh));
            // Reading and writing again gives the same bytes.
            assert_eq!(super::tests::written(&back, encoding).files[..4], written.files[..4]);
        }
    }
}

#[test]
fn losses_are_reported() {
    let mut mesh = quadratic(&mixed(1));
    mesh.set_point_field(Field::scalars("u", vec![0.0; mesh.points.len()]));
    let written = written(&mesh, Encoding::Binary);
    assert!(written.lost.iter().any(|lost| lost.contains("middle nodes")), "{:?}", written.lost);
    assert!(written.lost.iter().any(|lost| lost.contains('u')), "{:?}", written.lost);
    let refused = |mesh: &Mesh| {
        write::write(mesh, &WriteOptions::default(), &Threads::single()).unwrap_err().to_string()
    };
    let triangle = Cells::uniform(CellKind::TRIANGLE, [0, 1, 2].map(VertexId).to_vec()).unwrap();
    let flat: Vec<Point> = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(refused(&Mesh::new(flat, triangle)).contains("volume cells"));
    let mut broken = sphere_in_box(2, 2);
    broken.points[3][1] = f64::NAN;
    assert!(refused(&broken).contains("point 3"));
}

#[test]
fn names_become_openfoam_words() {
    let mut mesh = sphere_in_box(2, 2);
    let names: Vec<String> = ["Wall (inner)/1", "3rd; patch"].map(str::to_owned).to_vec();
    mesh.label_names.patches = mesh.label_names.patches.keys().copied().zip(names).collect();
    let files = written(&mesh, Encoding::Ascii).files;
    let boundary = String::from_utf8(files[4].1.clone()).unwrap();
    assert!(boundary.contains("Wall__inner__1\n    {\n        type wall"), "{boundary}");
    assert!(boundary.contains("patch_3rd__patch\n    {\n        type patch"), "{boundary}");
}

#[test]
fn damage_is_refused_and_nothing_panics() {
    for encoding in [Encoding::Ascii, Encoding::Binary] {
        let whole = written(&mixed(1), encoding);
        let folder = tempfile::tempdir().unwrap();
        put(folder.path(), &whole);
        for (name, bytes) in &whole.files {
            let file = folder.path().join(name);
            for len in (0..bytes.len() - 2).step_by(1 + bytes.len() / 300) {
                std::fs::write(&file, &bytes[..len]).unwrap();
                let error = get(folder.path()).map(|_| ()).unwrap_err().to_string();
                assert!(
                    error.contains(name.as_str()) || error.contains("polyMesh"),
                    "{name} cut at {len}: {error}"
                );
            }
            for place in (0..bytes.len()).step_by(1 + bytes.len() / 300) {
                for bit in [0, 3, 6] {
                    let mut damaged = bytes.clone();
                    damaged[place] ^= 1 << bit;
                    std::fs::write(&file, &damaged).unwrap();
                    let _ = get(folder.path());
                }
            }
            std::fs::write(&file, bytes).unwrap();
        }
        let changed = |name: &str, from: &str, to: &str| {
            let (_, bytes) = whole.files.iter().find(|(file, _)| file == name).unwrap();
            let text = String::from_utf8_lossy(bytes).into_owned();
            assert!(text.contains(from));
            std::fs::write(folder.path().join(name), text.replacen(from, to, 1)).unwrap();
            let error = get(folder.path()).map(|_| ()).unwrap_err().to_string();
            std::fs::write(folder.path().join(name), bytes).unwrap();
            error
        };
        assert!(changed("boundary", "startFace ", "startFace 9").contains("beyond"));
        assert!(changed("boundary", "nFaces", "many").contains("no startFace or no nFaces"));
        if encoding == Encoding::Ascii {
            let n = mixed(1).points.len();
            assert!(changed("points", &format!("\n{n}\n"), "\n900000000\n").contains("entries declared"));
            assert!(changed("owner", "(\n0\n", "(\n70000\n").contains("refers to cell 70000"));
            assert!(changed("faces", "4(", "4(99").contains("a point that does not exist"));
            assert!(changed("points", "label=32", "label=16").contains("expected numbers of 32 or 64 bits"));
        }
    }
    assert_eq!(FORMAT.extensions, ["polymesh/", ".foam"]);
}

#[test]
fn comments_and_uniform_lists_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let head = |class: &str| {
        format!("/* C++ \\*/\nFoamFile {{ version 2; format ascii; class {class}; }}\n// * * * //\n")
    };
    let put = |name: &str, class: &str, text: &str| {
        std::fs::write(folder.path().join(name), head(class) + text).unwrap();
    };
    put("points", "vectorField", "4 ( (0 0 0) (1 0 0) // far\n (0 1 0) (0 0 1) )");
    put("faces", "faceList", "4(3(0 2 1) 3(0 1 3) 3(1 2 3) 3(2 0 3))");
    put("owner", "labelList", "4{0}");
    put("neighbour", "labelList", "0()");
    put("boundary", "polyBoundaryMesh", "1 ( all { type wall; inGroups 1(wall); nFaces 4; startFace 0; } )");
    let mesh = get(folder.path()).unwrap();
    assert_eq!(mesh.cells.counts(), [(CellKind::TRIANGLE, 4), (CellKind::TETRA, 1)]);
    assert!((cell_volumes(&mesh.cells, &mesh.points)[0] - 1.0 / 6.0).abs() < 1e-15);
    assert_eq!(mesh.find_patch("all").unwrap(), 1);
}
