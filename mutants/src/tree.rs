//! A copy of the project that contains every mutant, each behind a run-time switch.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

use crate::find::{Form, Site, find};

/// A change of the source; its number is its index in the list plus one.
pub struct Mutant {
    pub file: String,
    pub line: usize,
    /// File, function and change, separated by tabs: identifies the mutant as long as these stay the same.
    pub key: String,
    site: usize,
    text: String,
}

/// The crate whose tests are run.
pub const CRATE: &str = "crates/motet";

pub struct Tree {
    pub folder: PathBuf,
    pub mutants: Vec<Mutant>,
    files: Vec<(String, String, Vec<Site>)>,
    library: String,
    /// Mutants that do not compile.
    pub dropped: HashSet<usize>,
    /// The ranges of each mutant and of its site in the written file.
    places: HashMap<usize, (Range<usize>, Range<usize>)>,
}

impl Tree {
    /// Finds the mutants of all source files below some paths of a project.
    pub fn new(root: &Path, folder: PathBuf, paths: &[String]) -> io::Result<Self> {
        let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root).output()?.stdout;
        let listed = String::from_utf8_lossy(&listed).into_owned();
        let all: Vec<_> = listed.split('\0').filter(|name| root.join(name).is_file()).collect();
        let is_below = |name: &str| paths.iter().any(|p| name == p || name.starts_with(&format!("{p}/")));
        let mut files = Vec::new();
        let mut tests = HashSet::new();
        for name in all.iter().filter(|name| name.ends_with(".rs") && is_below(name)) {
            let source = fs::read_to_string(root.join(name))?;
            let (sites, modules) = find(&source).map_err(io::Error::other)?;
            let beside = name.strip_suffix("mod.rs").map_or(name.replace(".rs", "/"), Into::into);
            tests.extend(modules.iter().map(|module| format!("{beside}{module}.rs")));
            files.push((name.to_string(), source, sites));
        }
        files.retain(|(name, ..)| !tests.contains(name));
        let library = format!("{CRATE}/src/lib.rs");
        for name in
            all.into_iter().filter(|name| *name != library && files.iter().all(|(file, ..)| file != name))
        {
            put(&folder.join(name), &fs::read(root.join(name))?)?;
        }
        let library = fs::read_to_string(root.join(library))?;
        let (mutants, dropped, places) = Default::default();
        let mut tree = Self { folder, mutants, files, library, dropped, places };
        tree.number();
        Ok(tree)
    }

    fn number(&mut self) {
        let mut times: HashMap<String, u32> = HashMap::new();
        for (file, source, sites) in &self.files {
            for (site, found) in sites.iter().enumerate() {
                let line = source[..found.range.start].matches('\n').count() + 1;
                for (text, what) in &found.mutants {
                    let mut key = format!("{file}\t{}\t{what}", found.function);
                    let n = times.entry(key.clone()).or_default();
                    *n += 1;
                    if *n > 1 {
                        key += &format!(" ({n})");
                    }
                    let (file, text) = (file.clone(), text.clone());
                    self.mutants.push(Mutant { file, line, key, site, text });
                }
            }
        }
    }

    /// Writes the sources with all mutants except the dropped ones.
    pub fn write(&mut self) -> io::Result<()> {
        self.places.clear();
        for (file, source, sites) in &self.files {
            let mut ids: Vec<Vec<usize>> = vec![Vec::new(); sites.len()];
            let own = |(i, m): &(usize, &Mutant)| m.file == *file && !self.dropped.contains(i);
            self.mutants.iter().enumerate().filter(own).for_each(|(i, m)| ids[m.site].push(i));
            // Ends before beginnings; inner ends first, outer beginnings first.
            let mut marks = Vec::new();
            for (site, found) in sites.iter().enumerate().filter(|(site, _)| !ids[*site].is_empty()) {
                marks.push((found.range.start, 1, site as isize, site));
                if found.form != Form::Body {
                    marks.push((found.range.end, 0, -(site as isize), site));
                }
            }
            marks.sort_unstable();
            let (mut text, mut at, mut begins) = (String::new(), 0, HashMap::new());
            for (place, is_begin, _, site) in marks {
                text += &source[at..place];
                at = place;
                if is_begin == 0 {
                    text += if sites[site].form == Form::Left { "}" } else { "})" };
                    for id in &ids[site] {
                        let end = text.len();
                        self.places.entry(*id).and_modify(|(_, around)| around.end = end);
                    }
                    continue;
                }
                let begin = text.len();
                begins.insert(site, begin);
                text += if sites[site].form == Form::Expression { "(" } else { "" };
                for &id in &ids[site] {
                    let is_on = format!("crate::mutants::on({})", id + 1);
                    let from = text.len();
                    text += &match sites[site].form {
                        Form::Expression => format!("if {is_on} {{ {} }} else ", self.mutants[id].text),
                        Form::Body => format!("if {is_on} {{ {} }} ", self.mutants[id].text),
                        Form::Left => format!("if !{is_on} {{"),
                    };
                    self.places.insert(id, (from..text.len(), begin..text.len()));
                }
                text += if sites[site].form == Form::Expression { "{ " } else { "" };
            }
            text += &source[at..];
            put(&self.folder.join(file), text.as_bytes())?;
        }
        let allowed = "#![allow(warnings, arithmetic_overflow, unconditional_panic, unconditional_recursion, reason = \"a mutant is wrong on purpose\")]";
        let library = format!("{allowed}\n{}\n#[doc(hidden)]\npub mod mutants;\n", self.library);
        put(&self.folder.join(CRATE).join("src/lib.rs"), library.as_bytes())?;
        let n_mutants = format!("N_MUTANTS: usize = {}", self.mutants.len() + 1);
        let switch = include_str!("switch.rs").replace("N_MUTANTS: usize = 1", &n_mutants);
        put(&self.folder.join(CRATE).join("src/mutants.rs"), switch.as_bytes())
    }

    /// Drops the mutants where the compiler found an error; returns false if there are none.
    pub fn drop_at(&mut self, file: &str, span: Range<usize>) -> bool {
        let within = |around: &Range<usize>| around.start <= span.start && span.end <= around.end;
        let own = || self.places.iter().filter(|(id, _)| self.mutants[**id].file == file);
        let mut bad: Vec<usize> = own().filter(|(_, (place, _))| within(place)).map(|(id, _)| *id).collect();
        if bad.is_empty() {
            let around = own().filter(|(_, (_, around))| within(around));
            let least =
                around.min_by_key(|(_, (_, around))| around.len()).map(|(_, (_, around))| around.clone());
            bad =
                own().filter(|(_, (_, around))| Some(around) == least.as_ref()).map(|(id, _)| *id).collect();
        }
        self.dropped.extend(&bad);
        !bad.is_empty()
    }
}

/// Writes a file unless it already has these contents.
fn put(path: &Path, contents: &[u8]) -> io::Result<()> {
    if fs::read(path).is_ok_and(|old| old == contents) {
        return Ok(());
    }
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    fs::write(path, contents)
}
