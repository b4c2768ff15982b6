//! Files do not depend on the number of threads: neither the bytes that are written nor the meshes that are
//! read.

use std::path::Path;

use motet::Mesh;
use motet::base::Threads;
use motet::io::{
    Compression, Encoding, Input, Notes, WriteOptions, Written, formats, read_as, read_noted, read_on, write,
    write_on,
};
use motet::mesh::{Field, shapes};

/// A mesh whose arrays take many blocks of files, with fields of several types.
fn large() -> Mesh {
    let mut mesh = shapes::sphere_in_box(20, 6);
    let n = mesh.points.len();
    mesh.point_data.push(Field::scalars("u", (0..n).map(|i| (i as f64).sin()).collect::<Vec<f64>>()));
    mesh.point_data.push(Field::vectors("v", &mesh.points.clone()));
    mesh.cell_data.push(Field::scalars("k", (0..mesh.cells.len() as i64).collect::<Vec<i64>>()));
    mesh.field_data.push(Field::scalars("note", vec!["a text".to_owned(), "another".to_owned()]));
    mesh
}

fn all_options() -> Vec<WriteOptions> {
    let mut all = Vec::new();
    for encoding in [Encoding::Ascii, Encoding::Base64, Encoding::Binary] {
        for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
            all.push(WriteOptions { encoding, compression, version: None });
        }
    }
    all
}

fn pools() -> Vec<Threads> {
    [2, 3, 7].map(|n| Threads::exactly(n).expect("threads start")).into()
}

#[test]
fn the_bytes_of_each_format_do_not_depend_on_the_threads() {
    let mesh = large();
    assert!(mesh.cells.connectivity().items().len() * 8 > 9 * (256 << 10), "many blocks");
    let pools = pools();
    for format in formats().iter().filter(|format| format.write.is_some()) {
        let is_xml = format.extensions[0].starts_with(".vt");
        for options in all_options().into_iter().filter(|o| is_xml || o.compression == Compression::Zlib) {
            // Some formats refuse some options, and always with the same words.
            let files = |threads: &Threads| -> Result<Written, String> {
                format.to_files(&mesh, &options, threads).map_err(|e| e.to_string())
            };
            let alone = files(&Threads::single());
            for pool in &pools {
                let together = files(pool);
                let is_same = match (&alone, &together) {
                    (Ok(a), Ok(b)) => a.files == b.files && a.lost == b.lost,
                    (Err(a), Err(b)) => a == b,
                    _ => false,
                };
                assert!(is_same, "{}, {options:?}, {} threads", format.name, pool.count());
            }
        }
    }
}

#[test]
fn versions_of_formats_do_not_depend_on_the_threads() {
    let mesh = large();
    for (extension, version) in [(".msh", "2.2"), (".msh", "4.1"), (".vtk", "4.2"), (".vtk", "5.1")] {
        let format = formats().iter().find(|f| f.extensions.contains(&extension)).expect("it is registered");
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let options = WriteOptions { encoding, version: Some(version.into()), ..WriteOptions::default() };
            let files = |threads: &Threads| format.to_files(&mesh, &options, threads).expect("written").files;
            let alone = files(&Threads::single());
            assert!(pools().iter().all(|pool| files(pool) == alone), "{extension} {version} {encoding:?}");
        }
    }
}

#[test]
fn files_on_disk_are_those_in_memory_and_are_read_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = large();
    let format = &formats()[0];
    let pools = pools();
    for options in all_options() {
        let path = folder.path().join("a.vtu");
        write(&path, &mesh, &options).expect("written");
        let alone = std::fs::read(&path).expect("read");
        let in_memory = format.to_files(&mesh, &options, &Threads::single()).expect("written");
        assert!(in_memory.files[0].1 == alone, "{options:?}");
        let back = read_noted(&path).expect("read back");
        assert_eq!(back.0.points, mesh.points);
        for pool in &pools {
            write_on(&path, &mesh, &options, pool).expect("written");
            assert!(std::fs::read(&path).expect("read") == alone, "{options:?}");
            assert!(read_on(&path, pool).expect("read back") == back, "{options:?}");
            let notes = Notes::default();
            let input = Input { path: Path::new("a.vtu"), bytes: &alone, threads: pool, notes: &notes };
            assert!(read_as(format, &input).expect("read back") == back.0, "{options:?}");
        }
    }
}

#[test]
fn damage_is_reported_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.vtu");
    write(&path, &large(), &WriteOptions::default()).expect("written");
    let mut bytes = std::fs::read(&path).expect("read");
    let start = bytes.len() / 3;
    bytes[start..].iter_mut().for_each(|byte| *byte ^= 0x5a);
    std::fs::write(&path, &bytes).expect("written");
    let error = |threads: &Threads| read_on(&path, threads).expect_err("it is damaged").to_string();
    let alone = error(&Threads::single());
    assert!(pools().iter().all(|pool| error(pool) == alone), "{alone}");
}
