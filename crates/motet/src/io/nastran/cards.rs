//! Cards: lines of fields with the lines that continue them.

use std::borrow::Cow;

use crate::io::text::{Text, find};

/// Fields kept of a card: more than any element has.
const MAX_FIELDS: usize = 64;

/// The columns of a name and of a field; fields after a name with a star are twice as wide.
const COLUMNS: usize = 8;

/// A card: its name in capitals and without a star, its fields, and where it starts.
pub(super) struct Card<'a> {
    pub(super) name: String,
    pub(super) fields: Vec<Cow<'a, [u8]>>,
    pub(super) position: usize,
}

impl Card<'_> {
    /// A field, counted from 1 as in manuals; empty if it is blank.
    pub(super) fn field(&self, number: usize) -> &[u8] {
        number.checked_sub(1).and_then(|i| self.fields.get(i)).map_or(&[], |field| field)
    }
}

/// The next card; `None` at the end of the data. `comment` gets the lines that are comments.
pub(super) fn next<'a>(text: &mut Text<'a>, comment: &mut impl FnMut(&[u8])) -> Option<Card<'a>> {
    let (position, line) = content_line(text, comment)?;
    let (name, mut fields) = split(line);
    loop {
        let mut ahead = text.clone();
        let Some((_, line)) = content_line(&mut ahead, comment) else { break };
        let (first, further) = split(line);
        if !is_continuation(&first) {
            break;
        }
        *text = ahead;
        if fields.len() < MAX_FIELDS {
            fields.extend(further);
        }
    }
    let name = String::from_utf8_lossy(&name).trim_end_matches('*').trim_end().to_ascii_uppercase();
    Some(Card { name, fields, position })
}

fn is_continuation(first: &[u8]) -> bool {
    first.first().is_none_or(|byte| matches!(byte, b'+' | b'*'))
}

/// The next line that is not blank, without comment, and where it starts.
fn content_line<'a>(text: &mut Text<'a>, comment: &mut impl FnMut(&[u8])) -> Option<(usize, &'a [u8])> {
    loop {
        let position = text.position();
        let line = text.line()?;
        if line.starts_with(b"$") {
            comment(line);
        }
        let line = &line[..find(line, b'$').unwrap_or(line.len())];
        if !line.trim_ascii().is_empty() {
            return Some((position, line.trim_ascii_end()));
        }
    }
}

/// The first field of a line and its data fields, as many as a line has.
fn split(line: &[u8]) -> (Cow<'_, [u8]>, Vec<Cow<'_, [u8]>>) {
    if line.contains(&b',') { split_free(line) } else { split_fixed(line) }
}

fn fields_of(name: &[u8]) -> usize {
    if name.contains(&b'*') { 4 } else { 8 }
}

/// Splits at commas. A field after the last one points to the line that continues.
fn split_free(line: &[u8]) -> (Cow<'_, [u8]>, Vec<Cow<'_, [u8]>>) {
    let mut parts = line.split(|&byte| byte == b',').map(|part| Cow::Borrowed(part.trim_ascii()));
    let name = parts.next().unwrap_or_default();
    let n_fields = fields_of(&name);
    let mut fields: Vec<_> = parts.take(MAX_FIELDS).collect();
    // Some programs write all fields in one line.
    if fields.len() <= n_fields + 1 {
        fields.resize(n_fields, Cow::Borrowed(&[]));
    }
    (name, fields)
}

/// Splits into columns; a tabulator goes to the next one.
fn split_fixed(line: &[u8]) -> (Cow<'_, [u8]>, Vec<Cow<'_, [u8]>>) {
    if line.contains(&b'\t') {
        let mut wide = Vec::with_capacity(line.len());
        for &byte in line {
            match byte {
                b'\t' => wide.resize((wide.len() / COLUMNS + 1) * COLUMNS, b' '),
                _ => wide.push(byte),
            }
        }
        let (name, fields) = columns(&wide);
        let owned = |field: &[u8]| Cow::Owned(field.to_vec());
        return (owned(name), fields.into_iter().map(owned).collect());
    }
    let (name, fields) = columns(line);
    (Cow::Borrowed(name), fields.into_iter().map(Cow::Borrowed).collect())
}

fn columns(line: &[u8]) -> (&[u8], Vec<&[u8]>) {
    let part = |start: usize, len: usize| {
        line.get(start..).map_or(&[][..], |rest| rest[..rest.len().min(len)].trim_ascii())
    };
    let name = part(0, COLUMNS);
    let n_fields = fields_of(name);
    let width = 8 * COLUMNS / n_fields;
    (name, (0..n_fields).map(|i| part(COLUMNS + i * width, width)).collect())
}
