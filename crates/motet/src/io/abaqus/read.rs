//! Reads the lines of a file, and of the files that it includes, into keywords and data.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::assemble::assemble;
use super::line::Keyword;
use super::model::Model;
use crate::base::{Error, Result};
use crate::io::text::Text;
use crate::io::{Input, is_same_file};
use crate::mesh::Mesh;

/// Maximum depth of nested includes.
const MAX_INCLUDE_DEPTH: usize = 16;
/// Maximum number of included files.
const MAX_INCLUDED_FILES: usize = 10_000;

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut reader =
        Reader { model: Model::new(input.notes), open: vec![input.path.to_owned()], n_included: 0 };
    reader.lines(input.bytes)?;
    let end = || format!("line {}", 1 + input.bytes.iter().filter(|&&b| b == b'\n').count());
    reader.model.finish().map_err(|e| e.at(end()))?;
    assemble(reader.model, input.notes)
}

struct Reader<'n> {
    model: Model<'n>,
    /// The files being read, each included by the one before.
    open: Vec<PathBuf>,
    n_included: usize,
}

impl Reader<'_> {
    fn lines(&mut self, bytes: &[u8]) -> Result<()> {
        let mut text = Text::new(bytes);
        let mut n = 0;
        while let Some(line) = text.line() {
            n += 1;
            let at = n;
            let line = String::from_utf8_lossy(line.trim_ascii());
            let taken = match line.strip_prefix('*') {
                _ if line.is_empty() || line.starts_with("**") => Ok(()),
                None => self.model.data(&line),
                Some(keyword) => self.keyword(&Keyword::parse(&continued(keyword, &mut text, &mut n))),
            };
            taken.map_err(|e| if e.file().is_some() { e } else { e.at(format!("line {at}")) })?;
        }
        Ok(())
    }

    fn keyword(&mut self, keyword: &Keyword) -> Result<()> {
        if keyword.name == "INCLUDE" {
            return self.include(keyword.expect("INPUT")?);
        }
        self.model.keyword(keyword)?;
        // The data of these keywords may be in a separate file.
        let has_data = matches!(keyword.name.as_str(), "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE");
        match keyword.get("INPUT").filter(|_| has_data) {
            Some(file) => self.include(file),
            None => Ok(()),
        }
    }

    /// Reads an included file, whose path is relative to the folder of the including file.
    fn include(&mut self, name: &str) -> Result<()> {
        let name = name.trim_matches('"');
        let from = self.open.last().and_then(|path| path.parent()).unwrap_or(Path::new(""));
        let path = from.join(name);
        let refuse = |what: &str| {
            Error::input(format!("included file `{name}` {what}")).remedy("write the mesh to a single file")
        };
        if self.open.iter().any(|open| is_same_file(open, &path)) {
            return Err(refuse("includes itself, directly or through others"));
        }
        self.n_included += 1;
        if self.open.len() > MAX_INCLUDE_DEPTH || self.n_included > MAX_INCLUDED_FILES {
            return Err(refuse("exceeds the limits: too many includes, or nested too deeply"));
        }
        // Reading a device or pipe might never end.
        if path.metadata().is_ok_and(|m| !m.is_file()) {
            return Err(refuse("is not a regular file"));
        }
        let bytes = std::fs::read(&path).map_err(|e| {
            Error::input(format!("included file `{name}` cannot be read: {e}"))
                .remedy("its path is relative to the folder of the including file")
        })?;
        self.open.push(path.clone());
        self.lines(&bytes).map_err(|e| e.in_file(&path))?;
        self.open.pop();
        Ok(())
    }
}

/// A keyword line joined with its continuation lines, which follow a trailing comma.
fn continued<'k>(keyword: &'k str, text: &mut Text<'_>, n: &mut usize) -> Cow<'k, str> {
    let mut whole = Cow::Borrowed(keyword);
    while whole.ends_with(',') {
        let next = text.clone().line().unwrap_or_default().trim_ascii();
        if next.is_empty() || next.starts_with(b"*") || !next[0].is_ascii_alphabetic() {
            break;
        }
        text.line();
        *n += 1;
        whole.to_mut().push_str(&String::from_utf8_lossy(next));
    }
    whole
}
