//! The tests, built once, with the duration of each and the mutants that it reaches.

use std::collections::HashMap;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};

use serde_json::Value;

use crate::tree::{CRATE, Tree};

/// Tests that take longer than this are left out.
const LONGEST: Duration = Duration::from_secs(30);
/// Memory limit of a test, in kB, since a mutant can fill a list endlessly.
const MEMORY: &str = "6000000";

pub struct Test {
    program: PathBuf,
    pub name: String,
    pub seconds: f64,
    pub reached: Vec<usize>,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Ended {
    Passed,
    Failed,
    TimedOut,
}

/// Builds the library, dropping mutants that do not compile, and then its tests; returns the test programs.
pub fn build(tree: &mut Tree, target: &Path, tests: &[String]) -> io::Result<Vec<PathBuf>> {
    let cargo = |words: &[&str], more: &[String], folder: &Path| {
        let mut command = Command::new("cargo");
        command.args(words).args(["-p", "motet", "--message-format=json"]).args(more);
        command.current_dir(folder).env("CARGO_TARGET_DIR", target).env("CARGO_INCREMENTAL", "0");
        let printed = command.env("CARGO_PROFILE_DEV_DEBUG", "0").stderr(Stdio::inherit()).output()?.stdout;
        let lines = printed.split(|b| *b == b'\n').filter_map(|line| serde_json::from_slice(line).ok());
        io::Result::Ok(lines.collect::<Vec<Value>>())
    };
    loop {
        tree.write()?;
        let messages = cargo(&["build", "--lib"], &[], &tree.folder)?;
        let mut errors = messages.iter().map(|m| &m["message"]).filter(|m| m["level"] == "error").peekable();
        if errors.peek().is_none() {
            break;
        }
        let before = tree.dropped.len();
        for error in errors {
            let spans = error["spans"].as_array().into_iter().flatten().filter(|s| s["is_primary"] == true);
            let is_ours = spans.clone().any(|s| {
                let byte = |key: &str| s[key].as_u64().unwrap_or(0) as usize;
                tree.drop_at(
                    s["file_name"].as_str().unwrap_or(""),
                    Range { start: byte("byte_start"), end: byte("byte_end") },
                )
            });
            if !is_ours && spans.count() > 0 {
                eprintln!("{}", error["rendered"].as_str().unwrap_or("an error"));
            }
        }
        let n = tree.dropped.len() - before;
        eprintln!("{n} mutants do not compile");
        if n == 0 {
            return Err(io::Error::other("the library does not compile"));
        }
    }
    let messages = cargo(&["test", "--no-run"], tests, &tree.folder)?;
    let mut programs = Vec::new();
    for message in messages.iter().filter(|m| m["profile"]["test"] == true) {
        programs.extend(message["executable"].as_str().map(PathBuf::from));
    }
    programs.sort();
    Ok(programs)
}

/// Runs each test by itself, or reads the results of an earlier run with the same mutants.
pub fn baseline(tree: &Tree, programs: &[PathBuf], kept: &Path) -> io::Result<Vec<Test>> {
    let old = fs::read_to_string(kept).unwrap_or_default();
    let old: HashMap<&str, &str> = old.lines().filter_map(|line| line.split_once('\t')).collect();
    let mut kept = fs::OpenOptions::new().append(true).create(true).open(kept)?;
    let reach = tree.folder.join("reach.txt");
    let mut tests = Vec::new();
    for program in programs {
        let listed = Command::new(program)
            .args(["--list", "--format=terse"])
            .current_dir(tree.folder.join(CRATE))
            .output()?;
        let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
        let stem = program.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for name in listed.lines().filter_map(|line| line.strip_suffix(": test")) {
            let mut test =
                Test { program: program.clone(), name: name.into(), seconds: 0.0, reached: Vec::new() };
            let label = format!("{stem}:{name}");
            let found = if let Some(found) = old.get(label.as_str()) {
                found.to_string()
            } else {
                fs::write(&reach, "")?;
                let started = Instant::now();
                let ended = test.run(tree, "reach", LONGEST)?;
                let seconds = started.elapsed().as_secs_f64();
                let found = match ended {
                    Ended::Passed => {
                        format!("{seconds:.3} {}", fs::read_to_string(&reach)?.replace('\n', " "))
                    }
                    Ended::Failed => "fails".into(),
                    Ended::TimedOut => "long".into(),
                };
                writeln!(kept, "{label}\t{found}")?;
                found
            };
            let mut numbers = found.split_whitespace();
            match numbers.next().and_then(|seconds| seconds.parse().ok()) {
                Some(seconds) => test.seconds = seconds,
                None => {
                    eprintln!("left out, {found}: {label}");
                    continue;
                }
            }
            test.reached = numbers.filter_map(|id| id.parse::<usize>().ok()).map(|id| id - 1).collect();
            tests.push(test);
        }
    }
    Ok(tests)
}

impl Test {
    /// Runs this test alone in a process of its own.
    pub fn run(&self, tree: &Tree, mutant: &str, limit: Duration) -> io::Result<Ended> {
        let mut command = Command::new("sh");
        command.args(["-c", "ulimit -v \"$0\"; exec \"$@\"", MEMORY]).arg(&self.program);
        command.args(["--exact", &self.name, "--quiet", "--test-threads=1"]);
        command.env("MUTANT", mutant).env("MUTANT_REACH", tree.folder.join("reach.txt"));
        // Random cases are the same each time; failures are neither minimised nor stored.
        command.env("PROPTEST_RNG_SEED", "1").env("PROPTEST_MAX_SHRINK_ITERS", "0");
        command.env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1");
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let started = Instant::now();
        let mut child = command.current_dir(tree.folder.join(CRATE)).spawn()?;
        loop {
            match child.try_wait()? {
                Some(status) if status.success() => return Ok(Ended::Passed),
                Some(_) => return Ok(Ended::Failed),
                None if started.elapsed() > limit => {
                    child.kill()?;
                    child.wait()?;
                    return Ok(Ended::TimedOut);
                }
                None => thread::sleep(Duration::from_millis(2)),
            }
        }
    }
}
