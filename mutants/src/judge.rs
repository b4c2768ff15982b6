//! Runs the tests on mutants, and reports which mutants they detect.

use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use crate::suite::{Ended, Test};
use crate::tree::Tree;

/// Maximum seconds for one mutant, and for all of them.
pub struct Limits {
    pub each: f64,
    pub all: f64,
}

/// Runs the tests that reach each mutant until one fails. Verdicts of an earlier run are kept; with `again`,
/// those of mutants that no test detected are not.
pub fn judge(
    tree: &Tree,
    suite: &[Test],
    kept: &Path,
    limits: Limits,
    again: bool,
) -> io::Result<HashMap<usize, String>> {
    let mut key_to_id: HashMap<&str, usize> = HashMap::new();
    key_to_id.extend(tree.mutants.iter().enumerate().map(|(id, m)| (m.key.as_str(), id)));
    let mut verdicts = HashMap::new();
    for line in fs::read_to_string(kept).unwrap_or_default().lines() {
        let (verdict, key) = line.split_once('\t').unwrap_or_default();
        if let Some(id) = key_to_id.get(key) {
            verdicts.insert(*id, verdict.to_string());
        }
    }
    if again {
        verdicts.retain(|_, verdict| verdict.starts_with("caught") || verdict.starts_with("timed out"));
    }
    let mut ids: Vec<usize> = (0..tree.mutants.len()).filter(|id| !tree.dropped.contains(id)).collect();
    ids.retain(|id| !verdicts.contains_key(id));
    // Sorted by a hash, so that any part of the list is representative.
    ids.sort_by_key(|id| {
        let mut hasher = DefaultHasher::new();
        tree.mutants[*id].key.hash(&mut hasher);
        hasher.finish()
    });
    let mut id_to_tests: HashMap<usize, Vec<usize>> = HashMap::new();
    for (t, test) in suite.iter().enumerate() {
        test.reached.iter().for_each(|id| id_to_tests.entry(*id).or_default().push(t));
    }
    let mut kept = fs::OpenOptions::new().append(true).create(true).open(kept)?;
    let started = Instant::now();
    let mut counts = Counts::default();
    for (id, verdict) in &verdicts {
        let by = verdict.split_once(" by ").and_then(|(_, name)| suite.iter().position(|t| t.name == name));
        by.into_iter().for_each(|t| counts.add(&tree.mutants[*id].file, t, true));
    }
    for (n, &id) in ids.iter().enumerate() {
        if started.elapsed().as_secs_f64() > limits.all {
            break;
        }
        let file = tree.mutants[id].file.as_str();
        let mut tests = id_to_tests.remove(&id).unwrap_or_default();
        let cost = |t: &usize| (suite[*t].seconds + 0.01) / counts.chance(file, *t);
        tests.sort_by(|x, y| cost(x).total_cmp(&cost(y)));
        let begun = Instant::now();
        let mut verdict = if tests.is_empty() { "not reached" } else { "survived" }.to_string();
        for t in tests {
            let test = &suite[t];
            if begun.elapsed().as_secs_f64() + test.seconds > limits.each {
                verdict = "capped".into();
                continue;
            }
            let limit = Duration::from_secs_f64(10.0 * test.seconds + 5.0);
            let ended = test.run(tree, &(id + 1).to_string(), limit)?;
            counts.add(file, t, ended != Ended::Passed);
            if ended != Ended::Passed {
                let how = if ended == Ended::Failed { "caught" } else { "timed out" };
                verdict = format!("{how} by {}", test.name);
                break;
            }
        }
        writeln!(kept, "{verdict}\t{}", tree.mutants[id].key)?;
        eprintln!(
            "{}/{} {:.1} s: {verdict}: {}",
            n + 1,
            ids.len(),
            begun.elapsed().as_secs_f64(),
            tree.mutants[id].key
        );
        verdicts.insert(id, verdict);
    }
    Ok(verdicts)
}

/// How often each test ran and how often it failed, on mutants of each file and on all.
#[derive(Default)]
struct Counts<'a> {
    of_file: HashMap<(&'a str, usize), [f64; 2]>,
    of_all: HashMap<usize, [f64; 2]>,
}

impl<'a> Counts<'a> {
    fn add(&mut self, file: &'a str, test: usize, has_failed: bool) {
        let both = [self.of_file.entry((file, test)).or_default(), self.of_all.entry(test).or_default()];
        both.into_iter()
            .for_each(|[ran, failed]| (*ran, *failed) = (*ran + 1.0, *failed + f64::from(has_failed)));
    }

    /// Estimates the probability that a test fails on the next mutant of a file.
    fn chance(&self, file: &str, test: usize) -> f64 {
        let [ran, failed] = self.of_all.get(&test).copied().unwrap_or_default();
        let of_any = (failed + 0.5) / (ran + 5.0);
        let [ran, failed] = self.of_file.get(&(file, test)).copied().unwrap_or_default();
        (failed + 3.0 * of_any) / (ran + 3.0)
    }
}

/// Prints counts by folder and the surviving mutants; returns whether there are none.
pub fn report(tree: &Tree, verdicts: &HashMap<usize, String>, equivalent: &str) -> bool {
    const KINDS: [&str; 7] =
        ["caught", "timed out", "equivalent", "survived", "not reached", "capped", "not run"];
    let mut folders: BTreeMap<&str, [usize; KINDS.len()]> = BTreeMap::new();
    let mut left = Vec::new();
    // Each line has a key, a tab and the reason.
    let equivalent: HashSet<&str> =
        equivalent.lines().filter_map(|l| l.rsplit_once('\t')).map(|(key, _)| key).collect();
    for (id, mutant) in tree.mutants.iter().enumerate().filter(|(id, _)| !tree.dropped.contains(id)) {
        let verdict = verdicts.get(&id).map_or("not run", String::as_str);
        let mut kind = KINDS.iter().position(|kind| verdict.starts_with(kind)).unwrap_or(KINDS.len() - 1);
        if kind > 1 && equivalent.contains(mutant.key.as_str()) {
            kind = 2;
        }
        let folder = mutant.file.rsplit_once('/').map_or("", |(folder, _)| folder);
        folders.entry(folder).or_default()[kind] += 1;
        if kind > 2 && kind < KINDS.len() - 1 {
            left.push(format!("{}\t{}\t(line {})", KINDS[kind], mutant.key, mutant.line));
        }
    }
    println!("folder | {}", KINDS.join(" | "));
    for (folder, counts) in folders {
        println!("{folder} | {}", counts.map(|n| n.to_string()).join(" | "));
    }
    left.iter().for_each(|line| println!("{line}"));
    left.is_empty()
}
