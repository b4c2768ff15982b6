//! The record of the job that made a state: the content of the job and of its files.
//!
//! A run resumes from a state only with the job that made it. What cannot change the steps already made is
//! left out: the length of the run, and where files lie.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use motet::{Error, Result, io};
use serde_json::{Value, json};

use super::job::Job;

/// How many differences are named.
const MAX_LISTED: usize = 4;

/// Keys with their values as text. The value of a file is a summary of its content.
pub(super) type Record = BTreeMap<String, String>;

/// The record of a job.
///
/// # Errors
/// When a file that the job names cannot be read.
pub(super) fn of(job: &Job) -> Result<Record> {
    let mut record = Record::new();
    let said = serde_json::to_value(&**job).map_err(|e| Error::io(&job.file, e.into()))?;
    flatten("", &said, &mut record);
    for key in ["output", "time.periods"] {
        record.remove(key);
    }
    record.insert("time.steps".into(), job.steps_in_period().to_string());
    for (key, named) in job.files() {
        record.insert(key, fingerprint(&job.path(&named))?);
    }
    Ok(record)
}

/// The differences: the key, the old value and the new value of each.
pub(super) fn differences(was: &Record, is: &Record) -> Vec<String> {
    let keys = was.keys().chain(is.keys().filter(|key| !was.contains_key(*key)));
    let differ = keys.filter(|key| was.get(*key) != is.get(*key));
    let value = |of: &Record, key: &str| of.get(key).map_or("nothing", String::as_str).to_owned();
    let mut listed: Vec<String> =
        differ.map(|key| format!("{key} was {} and is {}", value(was, key), value(is, key))).collect();
    let n = listed.len();
    if n > MAX_LISTED {
        listed.truncate(MAX_LISTED);
        listed.push(format!("{} more", n - MAX_LISTED));
    }
    listed
}

/// Reads a record that [`write`] wrote.
///
/// # Errors
/// When it does not exist, or is not a record.
pub(super) fn read(file: &Path) -> Result<Record> {
    let invalid = |what: &str| Err(Error::input(what).in_file(file).remedy("omit --resume to start anew"));
    match std::fs::read(file) {
        Err(_) => invalid("does not exist; it records the job that made the state"),
        Ok(bytes) => serde_json::from_slice(&bytes)
            .or_else(|_| invalid("is damaged; it records the job that made the state")),
    }
}

/// Writes a record, and waits until it is on the disk.
///
/// # Errors
/// When the system refuses.
pub(super) fn write(file: &Path, record: &Record) -> Result<()> {
    io::replace(file, format!("{:#}\n", json!(record)).as_bytes())?;
    io::sync(file)
}

/// Adds the leaves of a value, with keys within keys joined by dots. What a job omits gets no key.
fn flatten(key: &str, value: &Value, record: &mut Record) {
    let within = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match value {
        Value::Null => {}
        Value::Object(all) => all.iter().for_each(|(name, value)| flatten(&within(name), value, record)),
        Value::Array(all) if all.iter().any(Value::is_object) => {
            all.iter().enumerate().for_each(|(i, value)| flatten(&within(&i.to_string()), value, record));
        }
        other => {
            record.insert(key.to_owned(), other.to_string());
        }
    }
}

/// A summary of the content of a file, or of all files of a folder or series: the number of bytes, and a
/// checksum.
fn fingerprint(path: &Path) -> Result<String> {
    let mut sum = Checksum::default();
    let series = if io::can_write_series(path) { io::read_series(path)? } else { Vec::new() };
    for file in series.into_iter().map(|(_, file)| file).chain([path.to_owned()]) {
        // One step of a file with several stands for the whole file.
        files_of(&io::file_of(&file), &mut |file| {
            std::fs::read(file).map(|bytes| sum.add(&bytes)).map_err(|e| Error::io(file, e))
        })?;
    }
    Ok(format!("{} bytes with sum {:016x}", sum.n_bytes, sum.state))
}

fn files_of(path: &Path, of: &mut impl FnMut(&Path) -> Result<()>) -> Result<()> {
    if !path.is_dir() {
        return of(path);
    }
    let entries = std::fs::read_dir(path).and_then(|all| all.map(|e| Ok(e?.path())).collect());
    let mut entries: Vec<PathBuf> = entries.map_err(|e| Error::io(path, e))?;
    entries.sort();
    entries.iter().try_for_each(|entry| files_of(entry, of))
}

/// FNV-1a (Fowler, Noll and Vo 1991) in 64 bits: detects changed files, but not files forged to look alike.
struct Checksum {
    n_bytes: u64,
    state: u64,
}

impl Default for Checksum {
    fn default() -> Self {
        Self { n_bytes: 0, state: 0xcbf2_9ce4_8422_2325 }
    }
}

impl Checksum {
    fn add(&mut self, bytes: &[u8]) {
        self.n_bytes += bytes.len() as u64;
        for byte in bytes {
            self.state = (self.state ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
