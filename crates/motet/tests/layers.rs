//! The structure of the source: modules import only downward, files of a module do not import each other in a
//! ring, and comments and names of modules keep the rules of style.
//!
//! The floors are those of the table in `src/lib.rs`. Two modules of one floor do not see each other; nothing
//! imports through the crate root.

use std::collections::{BTreeMap, BTreeSet};
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
    ("ops", 5),
    ("delaunay", 5),
    ("preflight", 6),
    ("refine", 6),
    ("remesh", 6),
    ("surface", 7),
    ("motion", 7),
    ("contact", 7),
    ("meshing", 8),
    ("implant", 9),
    ("moving", 10),
];

/// Macros that are exported, which the language puts at the crate root, and the modules that define them.
const MACROS: &[(&str, &str)] = &[("words", "base"), ("names", "base")];

fn floor(module: &str) -> Option<u32> {
    let module = MACROS.iter().find(|(name, _)| *name == module).map_or(module, |(_, home)| home);
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

/// The files of a crate by the path of their module; `mod.rs` and `lib.rs` are their folder's.
fn modules(source: &Path) -> BTreeMap<Vec<String>, String> {
    let mut files = Vec::new();
    rust_files(source, &mut files);
    let module = |file: &PathBuf| {
        let within = file.strip_prefix(source).expect("files lie in the source folder").with_extension("");
        let mut path: Vec<String> = within.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if path.last().is_some_and(|name| matches!(name.as_str(), "mod" | "lib" | "main")) {
            path.pop();
        }
        (path, code(&fs::read_to_string(file).expect("source is text")))
    };
    files.iter().map(module).collect()
}

/// Source without comments and unit tests.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// `a::{b, c::{d, e}}` taken apart: `a::b`, `a::c::d`, `a::c::e`.
fn apart(path: &str) -> Vec<String> {
    let Some(open) = path.find('{') else { return vec![path.trim().to_owned()] };
    let (head, rest) = (&path[..open], &path[open + 1..]);
    let (mut depth, mut begin, mut found) = (0, 0, Vec::new());
    for (at, c) in rest.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                found.extend(apart(&format!("{}{}", head.trim(), rest[begin..at].trim())));
                begin = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    found
}

/// The paths that a file names: those of its `use` items, and those that begin with `crate` or `super`.
fn paths(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let is_item = code[..at].trim_end_matches(' ').ends_with(['\n', ')', 'b']) || at == 0;
        if let Some(end) = code[at..].find(';').filter(|_| is_item) {
            found.extend(apart(&code[at + 4..at + end]));
        }
    }
    for head in ["crate::", "super::"] {
        for (at, _) in code.match_indices(head) {
            let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            found.push(code[at..].chars().take_while(|c| is_path(*c)).collect());
        }
    }
    found
}

/// The other file of the crate that a path leads to, unless one of the two is a parent of the other.
fn target(of: &[String], path: &str, modules: &BTreeMap<Vec<String>, String>) -> Option<Vec<String>> {
    let path = path.split(" as ").next().unwrap_or_default();
    let mut parts = path.split("::").map(str::trim).peekable();
    let mut at = match parts.peek() {
        Some(&"crate") => Vec::new(),
        Some(&("self" | "super")) => of.to_vec(),
        _ => return None,
    };
    for part in parts {
        match part {
            "crate" | "self" => {}
            "super" => drop(at.pop()),
            name => {
                at.push(name.to_owned());
                if !modules.contains_key(&at) {
                    at.pop();
                    break;
                }
            }
        }
    }
    (!at.starts_with(of) && !of.starts_with(&at)).then_some(at)
}

/// Files that import each other in a ring: each with all others that it reaches and that reach it.
fn rings(modules: &BTreeMap<Vec<String>, String>) -> BTreeSet<Vec<String>> {
    let edges: BTreeMap<&Vec<String>, BTreeSet<Vec<String>>> = modules
        .iter()
        .map(|(of, code)| (of, paths(code).iter().filter_map(|path| target(of, path, modules)).collect()))
        .collect();
    let reached = |from: &Vec<String>| {
        let (mut found, mut open) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(next) = open.pop() {
            for to in edges.get(&next).into_iter().flatten() {
                if found.insert(to.clone()) {
                    open.push(to.clone());
                }
            }
        }
        found
    };
    let all: BTreeMap<_, _> = modules.keys().map(|module| (module, reached(module))).collect();
    let ring = |module: &Vec<String>| -> Vec<String> {
        let back = all[module].iter().filter(|other| all[other].contains(module));
        back.map(|path| path.join("::")).collect()
    };
    modules.keys().map(ring).filter(|ring| !ring.is_empty()).collect()
}

/// The source folders of all crates.
fn sources() -> Vec<PathBuf> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in `crates`");
    let names = ["motet", "motet-cli", "motet-capi", "motet-report"];
    names.map(|name| crates.join(name).join("src")).into_iter().filter(|path| path.is_dir()).collect()
}

#[test]
fn no_files_import_each_other_in_a_ring() {
    let found: Vec<String> = sources()
        .iter()
        .flat_map(|source| rings(&modules(source)).into_iter().map(|ring| ring.join(", ")))
        .collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn rings_are_found() {
    let files = [
        ("a", ""),
        ("a::x", "use super::{y::{T, U}};"),
        ("a::y", "crate::a::z()"),
        ("a::z", "use super::x;"),
    ];
    let path = |name: &str| name.split("::").map(str::to_owned).collect::<Vec<_>>();
    let modules: BTreeMap<_, _> = files.map(|(name, code)| (path(name), code.to_owned())).into();
    assert_eq!(rings(&modules), BTreeSet::from([vec!["a::x".into(), "a::y".into(), "a::z".into()]]));
    let tree: BTreeMap<_, _> =
        [("a", "use self::x::T;"), ("a::x", "use super::U;")].map(|(n, c)| (path(n), c.to_owned())).into();
    assert!(rings(&tree).is_empty(), "parent and child");
}

/// The longest line of comments, as that of code in `rustfmt.toml`; rows of tables and addresses may be longer.
const LONGEST: usize = 110;

#[test]
fn comments_are_no_longer_than_code() {
    let mut found = Vec::new();
    for source in sources() {
        let mut files = Vec::new();
        rust_files(&source, &mut files);
        for file in files {
            let text = fs::read_to_string(&file).expect("source is text");
            let is_long = |line: &&str| {
                let body = line.trim_start().trim_start_matches(['/', '!']).trim_start();
                let is_comment = line.trim_start().starts_with("//");
                is_comment && !body.starts_with('|') && line.chars().count() > LONGEST
            };
            let lines = text.lines().enumerate().filter(|(_, line)| is_long(line));
            found.extend(lines.map(|(number, _)| format!("{}:{}", file.display(), number + 1)));
        }
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Names of modules that say nothing of what is in them.
const VAGUE: &[&str] =
    &["exchange", "handle", "implanting", "keep", "kept", "legs", "now", "recone", "spare", "tell", "way"];

#[test]
fn names_of_modules_say_what_is_in_them() {
    let mut found = Vec::new();
    for source in sources() {
        let vague = modules(&source)
            .into_keys()
            .filter(|path| path.last().is_some_and(|name| VAGUE.contains(&name.as_str())));
        found.extend(vague.map(|path| path.join("::")));
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// A file beside the `main.rs` of a program of tests that no `mod` line names is not compiled.
#[test]
fn every_file_of_tests_is_compiled() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in `crates`");
    let mut missing = Vec::new();
    let mut n_programs = 0;
    for name in ["motet", "motet-cli", "motet-report"] {
        for folder in fs::read_dir(crates.join(name).join("tests")).expect("the folder of tests is readable")
        {
            let folder = folder.expect("the entry is readable").path();
            let Ok(main) = fs::read_to_string(folder.join("main.rs")) else { continue };
            n_programs += 1;
            for entry in fs::read_dir(&folder).expect("the folder is readable") {
                let path = entry.expect("the entry is readable").path();
                let stem = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
                if stem != "main" && !main.lines().any(|line| line == format!("mod {stem};")) {
                    missing.push(path.display().to_string());
                }
            }
        }
    }
    assert!(missing.is_empty() && n_programs > 10, "{n_programs} programs; no `mod` line for {missing:?}");
}
