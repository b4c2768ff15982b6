//! A fresh folder for each test, and the program run in it.

#[path = "../../../../motet/tests/common/random.rs"]
#[allow(dead_code, reason = "tests of the library use other parts of it")]
pub(crate) mod random;

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::io::{WriteOptions, write};
use motet::mesh::{CellKind, Cells};

/// A folder that is removed after the test.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The program, to be run in this folder.
    pub(crate) fn motet<S: AsRef<std::ffi::OsStr>>(&self, words: impl IntoIterator<Item = S>) -> Command {
        let mut command = Command::cargo_bin("motet").expect("the program is built");
        command.current_dir(self.0.path()).args(words);
        command
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).expect("the file is written");
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("the file is there")
    }

    /// Writes a mesh in the format given by the name, and returns the name.
    pub(crate) fn mesh(&self, name: &str, mesh: &Mesh) -> String {
        write(self.path(name), mesh, &WriteOptions::default()).expect("the mesh is written");
        name.to_string()
    }

    /// Writes [`cube`].
    pub(crate) fn cube(&self, name: &str) -> String {
        self.mesh(name, &cube(3))
    }

    /// Everything in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder is readable");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The unit cube in `n`^3 cubes of six tets each (Kuhn's), all positive.
pub(crate) fn cube(n: u32) -> Mesh {
    let m = n + 1;
    let id = |p: [u32; 3]| VertexId(p[0] * m * m + p[1] * m + p[2]);
    let grid = |n: u32| (0..n).flat_map(move |i| (0..n).flat_map(move |j| (0..n).map(move |k| [i, j, k])));
    let points: Vec<Point> = grid(m).map(|p| p.map(|x| f64::from(x) / f64::from(n))).collect();
    let mut cells = Cells::new();
    for corner in grid(n) {
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let mut at = corner;
            let mut tet = vec![id(at)];
            for axis in axes {
                at[axis] += 1;
                tet.push(id(at));
            }
            if [[0, 2, 1], [2, 1, 0], [1, 0, 2]].contains(&axes) {
                tet.swap(2, 3);
            }
            cells.push(CellKind::TETRA, tet);
        }
    }
    Mesh::new(points, cells)
}

pub(crate) fn stdout(call: &Assert) -> String {
    String::from_utf8_lossy(&call.get_output().stdout).into_owned()
}

pub(crate) fn stderr(call: &Assert) -> String {
    String::from_utf8_lossy(&call.get_output().stderr).into_owned()
}

/// The folder of real meshes, where it exists.
pub(crate) fn data() -> Option<PathBuf> {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MOTET_DATA").map_or_else(default, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no real meshes; set MOTET_DATA");
    None
}
