//! Changes one expression of the library at a time and runs the tests that reach it. A change that no test
//! detects shows a missing test, unnecessary code, or an equivalent change.
//!
//! All mutants are compiled into one build, each behind a run-time switch.

mod find;
mod judge;
mod suite;
mod tree;

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs, io};

use tree::Tree;

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("mutants: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> io::Result<bool> {
    let mut words = env::args().skip(1);
    let next = words.next().map(PathBuf::from);
    let root = next.ok_or_else(|| io::Error::other("the folder of the project, then paths in it"))?;
    let paths: Vec<String> = words.collect();
    let number =
        |name: &str, default: f64| env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default);
    let tests = env::var("MUTANTS_TESTS").unwrap_or_else(|_| "--lib --tests".into());
    let tests: Vec<String> = tests.split_whitespace().map(Into::into).collect();
    let own = root.join("mutants");
    let target = own.join("target");
    let results = target.join("results");
    fs::create_dir_all(&results)?;

    let mut tree = Tree::new(&root, target.join("tree"), &paths)?;
    let list = tree.mutants.iter().map(|m| format!("{}\n", m.key)).collect::<String>();
    if fs::read_to_string(results.join("list.txt")).ok().as_ref() != Some(&list) {
        let _ = fs::remove_file(results.join("tests.txt"));
        fs::write(results.join("list.txt"), &list)?;
    }
    let dropped = fs::read_to_string(results.join("dropped.txt")).unwrap_or_default();
    let dropped: std::collections::HashSet<&str> = dropped.lines().collect();
    tree.dropped =
        (0..tree.mutants.len()).filter(|i| dropped.contains(tree.mutants[*i].key.as_str())).collect();
    let programs = suite::build(&mut tree, &target.join("build"), &tests)?;
    let dropped = tree.dropped.iter().map(|i| format!("{}\n", tree.mutants[*i].key)).collect::<String>();
    fs::write(results.join("dropped.txt"), dropped)?;
    eprintln!(
        "{} mutants, {} more do not compile",
        tree.mutants.len() - tree.dropped.len(),
        tree.dropped.len()
    );
    let suite = suite::baseline(&tree, &programs, &results.join("tests.txt"))?;
    eprintln!("{} tests, {:.0} s", suite.len(), suite.iter().map(|t| t.seconds).sum::<f64>());

    let limits =
        judge::Limits { each: number("MUTANTS_EACH", 60.0), all: number("MUTANTS_ALL", f64::INFINITY) };
    let again = env::var("MUTANTS_AGAIN").is_ok();
    let verdicts = judge::judge(&tree, &suite, &results.join("verdicts.txt"), limits, again)?;
    let equivalent = fs::read_to_string(own.join("equivalent.txt")).unwrap_or_default();
    Ok(judge::report(&tree, &verdicts, &equivalent))
}
