//! Modules import only downward: an upward or circular import fails here.
//!
//! The floors are those of the table in `src/lib.rs`. Two modules on one floor do not import each other;
//! nothing imports through the crate root.

use std::fs;
use std::path::{Path, PathBuf};

const FLOORS: &[(&str, u32)] = &[
    ("base", 0),
    ("algebra", 1),
    ("geometry", 1),
    ("mesh", 2),
    ("io", 3),
    ("spatial", 3),
    ("kernel", 4),
    ("preflight", 4),
    ("ops", 5),
    ("delaunay", 6),
    ("refine", 6),
    ("remesh", 6),
    ("motion", 7),
    ("meshing", 7),
    ("contact", 7),
    ("implant", 8),
    ("moving", 9),
];

fn floor(module: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the source folder is readable") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

/// The modules that a line names after `crate::`, with groups in braces expanded.
fn imports(line: &str) -> Vec<String> {
    let code = line.split("//").next().unwrap_or_default();
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        let heads: Vec<&str> = match rest.strip_prefix('{') {
            Some(group) => group.split(',').collect(),
            None => vec![rest],
        };
        for head in heads {
            let name: String = head.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if !name.is_empty() {
                found.push(name);
            }
        }
    }
    found
}

/// The fault in a line of a file of `module`, if any.
fn fault(module: &str, line: &str) -> Option<String> {
    let here = floor(module)?;
    imports(line).into_iter().find_map(|target| match floor(&target) {
        _ if target == module => None,
        None => Some(format!("imports `crate::{target}` through the crate root")),
        Some(there) if there >= here => Some(format!("floor {here} imports `{target}` of floor {there}")),
        Some(_) => None,
    })
}

#[test]
fn modules_import_only_downward() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    let mut faults = Vec::new();
    for file in files.iter().filter(|f| f.file_name().is_some_and(|n| n != "lib.rs")) {
        let within = file.strip_prefix(&source).expect("files lie in the source folder");
        let module = within.components().next().expect("a path has a part").as_os_str().to_string_lossy();
        let module = module.trim_end_matches(".rs");
        if floor(module).is_none() {
            faults.push(format!("{}: module `{module}` has no floor", within.display()));
        }
        let text = fs::read_to_string(file).expect("source is text");
        for (number, line) in text.lines().enumerate() {
            if let Some(fault) = fault(module, line) {
                faults.push(format!("{}:{}: {fault}", within.display(), number + 1));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn the_scan_finds_what_it_looks_for() {
    assert_eq!(fault("mesh", "use crate::geometry::vector;"), None);
    assert_eq!(fault("mesh", "use crate::mesh::Cells;"), None);
    assert!(fault("mesh", "use crate::motion::Mover;").is_some());
    assert!(fault("io", "    crate::spatial::locate(x)").is_some());
    assert!(fault("mesh", "use crate::Error;").is_some());
    assert!(fault("base", "use crate::{base::Point, mesh::Mesh};").is_some());
    assert_eq!(fault("base", "/// see [`crate::mesh::Mesh`]"), None);
}
