//! Hostile environments: names that are not Unicode, full disks, links, control characters, limits.

use crate::common::{Folder, cube, stderr, stdout};
use motet::base::VertexId;
use motet::mesh::{CellKind, Cells};

fn object(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("one object: {e}: {text}"))
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_unicode_is_a_name() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    let name = |bytes: &'static [u8]| OsStr::from_bytes(bytes).to_owned();
    let (mesh, out) = (name(b"a\xff.vtu"), name(b"o\xff.vtu"));
    folder.cube("a.vtu");
    std::fs::rename(folder.path("a.vtu"), folder.path("x").with_file_name(&mesh)).unwrap();
    let word = OsStr::new;
    let calls: [Vec<&OsStr>; 5] = [
        vec![word("info"), &mesh],
        vec![word("convert"), &mesh, &out],
        vec![word("remesh"), &mesh, word("-o"), &out],
        vec![word("refine"), &mesh, word("-o"), &out, word("--all")],
        vec![word("move"), &mesh, word("-o"), &out, word("--affine"), word("1,0,0,0,0,1,0,0,0,0,1,0.1")],
    ];
    for words in calls {
        let call = folder.motet(words.iter().chain([&word("--json")])).assert().code(0);
        assert!(stdout(&call).contains('\u{fffd}'), "{words:?}: {}", stdout(&call));
        object(&stdout(&call));
    }
    let call = folder.motet([word("info"), &name(b"no\xff.vtu"), word("--json")]).assert().code(3);
    assert_eq!(object(&stdout(&call))["error"]["exit"], 3);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_reported() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    for words in [&["info", &mesh][..], &["info", &mesh, "--json"], &["help"], &["--version"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let program = folder.motet(words).get_program().to_owned();
        let ran = std::process::Command::new(program)
            .args(words)
            .current_dir(folder.path(""))
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(ran.status.code(), Some(1), "{words:?}");
        let message = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(message.contains("error: standard output: cannot be written"), "{words:?}: {message}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let program = folder.motet(["info"]).get_program().to_owned();
    let mut call = std::process::Command::new(program)
        .args(["info", &mesh, "--json"])
        .current_dir(folder.path(""))
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(call.stdout.take());
    let ran = call.wait_with_output().unwrap();
    assert_eq!(
        (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned()),
        (Some(0), String::new())
    );
}

#[test]
fn control_characters_of_a_name_do_not_reach_the_terminal() {
    let folder = Folder::new();
    let call = folder.motet(["info", "a\u{1b}[31mb\nerror: c.vtu"]).assert().code(3);
    assert!(!stderr(&call).contains('\u{1b}') && stderr(&call).lines().count() == 1, "{:?}", stderr(&call));
    let mesh = folder.cube("a\u{1b}]0;x.vtu");
    let call = folder.motet(["info", &mesh]).assert().code(0);
    assert!(
        !stdout(&call).contains('\u{1b}') && stdout(&call).contains("a\\u{1b}]0;x.vtu"),
        "{:?}",
        stdout(&call)
    );
    let call = folder.motet(["info", "a.vtu", "--\u{1b}[31m"]).assert().code(2);
    assert!(!stderr(&call).contains('\u{1b}'), "{:?}", stderr(&call));
}

#[test]
fn more_threads_than_the_machine_has_are_not_made() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    for (threads, out) in [("1", "one.vtu"), ("100000", "many.vtu"), ("18446744073709551615", "most.vtu")] {
        let words = ["refine", &mesh, "-o", out, "--all", "--threads", threads];
        folder.motet(words).timeout(std::time::Duration::from_secs(60)).assert().code(0);
    }
    assert_eq!(folder.read("one.vtu"), folder.read("many.vtu"));
    assert_eq!(folder.read("one.vtu"), folder.read("most.vtu"));
}

#[cfg(unix)]
#[test]
fn outputs_follow_links_and_keep_rights() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    folder.write("real.vtu", b"before");
    std::fs::set_permissions(folder.path("real.vtu"), PermissionsExt::from_mode(0o600)).unwrap();
    symlink("real.vtu", folder.path("link.vtu")).unwrap();
    folder.motet(["convert", &mesh, "link.vtu"]).assert().code(0);
    assert!(folder.path("link.vtu").is_symlink());
    assert_ne!(folder.read("real.vtu"), b"before");
    let mode = std::fs::metadata(folder.path("real.vtu")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    std::fs::hard_link(folder.path("real.vtu"), folder.path("hard.vtu")).unwrap();
    let call = folder.motet(["convert", &mesh, "hard.vtu"]).assert().code(0);
    assert!(stderr(&call).contains("hard link"), "{}", stderr(&call));
}

#[test]
fn a_folder_named_as_a_file_is_neither_read_nor_written() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    std::fs::create_dir(folder.path("adir.vtu")).unwrap();
    let call = folder.motet(["convert", &mesh, "adir.vtu"]).assert().code(2);
    assert!(stderr(&call).contains("is a folder"), "{}", stderr(&call));
    let call = folder.motet(["info", "adir.vtu"]).assert().code(3);
    assert!(stderr(&call).contains("is a folder"), "{}", stderr(&call));
    assert_eq!(std::fs::read_dir(folder.path("adir.vtu")).unwrap().count(), 0);
}

#[test]
fn every_reader_that_unpacks_keeps_to_the_limit() {
    let folder = Folder::new();
    let whole = cube(8);
    for (name, words) in [
        ("a.vtu", &["--compression", "zlib"][..]),
        ("b.vtu", &["--compression", "lz4"]),
        ("c.vtu", &["--compression", "lzma"]),
        ("d.vtu", &["--encoding", "base64"]),
        ("e.vtkhdf", &[]),
        ("f.cgns", &[]),
    ] {
        let mesh = folder.mesh("whole.vtu", &whole);
        folder.motet(["convert", &mesh, name].iter().chain(words)).assert().code(0);
        folder.motet(["info", name]).env("MOTET_READ_LIMIT", "1M").assert().code(0);
        let call = folder.motet(["info", name]).env("MOTET_READ_LIMIT", "2K").assert().code(3);
        assert!(stderr(&call).contains("MOTET_READ_LIMIT"), "{name}: {}", stderr(&call));
    }
}

#[test]
fn coordinates_beyond_numbers_are_a_defect_and_no_volume() {
    let folder = Folder::new();
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    let mut mesh = motet::Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], cells);
    mesh.points.iter_mut().flatten().for_each(|x| *x *= 1e120);
    let name = folder.mesh("far.vtu", &mesh);
    let call = folder.motet(["info", &name, "--json"]).assert().code(0);
    let summary = object(&stdout(&call));
    assert!(summary["volume"].is_number(), "{summary}");
    assert!(summary["defects"].to_string().contains("non_finite_point"), "{summary}");
    for verb in [&["remesh"][..], &["refine", "--all"], &["move", "--affine", "1,0,0,0,0,1,0,0,0,0,1,0.1"]] {
        let call =
            folder.motet(verb.iter().copied().chain([name.as_str(), "-o", "out.vtu"])).assert().code(3);
        assert!(stderr(&call).contains("far.vtu"), "{verb:?}: {}", stderr(&call));
    }
}

#[test]
fn files_of_other_programs_are_named() {
    let folder = Folder::new();
    folder.write("wing.ugrid", b"4 0 0 1 0 0 0\n");
    folder.write("wing.h5m", b"\x89HDF\r\n\x1a\n");
    for (name, says) in [("wing.ugrid", "UGRID"), ("wing.h5m", "MOAB")] {
        let call = folder.motet(["convert", name, "o.vtu"]).assert().code(3);
        assert!(
            stderr(&call).contains(says) && stderr(&call).contains("meshio convert"),
            "{}",
            stderr(&call)
        );
    }
}
