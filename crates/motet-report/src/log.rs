//! Reports and logs in JSON, whatever their keys: single facts, and tables with a row per step.

use std::path::{Path, PathBuf};

use motet::{Error, Result};
use serde_json::{Map, Value};

use crate::numbers::short;

/// A list of objects within a row is spread over columns if it has at most this length.
const LONGEST_SPREAD: usize = 12;
/// Columns that come before all others.
const FIRST: [&str; 2] = ["step", "time"];

/// The content of a JSON file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Log {
    pub(crate) file: PathBuf,
    /// Keys with their values, in the order of the file.
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) tables: Vec<Table>,
}

/// A table from a list of objects.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    pub(crate) name: String,
    pub(crate) n_rows: usize,
    pub(crate) columns: Vec<Column>,
}

/// The values of one key in all rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) cells: Vec<Cell>,
}

/// The value of one row for one key.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    None,
    Number(f64),
    Text(String),
}

impl Column {
    /// The numbers, `None` where a row has none.
    pub(crate) fn numbers(&self) -> Vec<Option<f64>> {
        let number = |cell: &Cell| if let Cell::Number(x) = cell { Some(*x) } else { None };
        self.cells.iter().map(number).collect()
    }
}

impl Table {
    pub(crate) fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    fn add(&mut self, row: &Map<String, Value>) {
        let mut cells = Vec::new();
        spread("", row, &mut cells);
        for (name, cell) in cells {
            let known = self.columns.iter().position(|column| column.name == name);
            let place = known.unwrap_or_else(|| {
                self.columns.push(Column { name, cells: Vec::new() });
                self.columns.len() - 1
            });
            // A key that occurs twice (`a.b` and `b` within `a`) keeps its first value.
            let column = &mut self.columns[place].cells;
            if column.len() <= self.n_rows {
                column.resize(self.n_rows, Cell::None);
                column.push(cell);
            }
        }
        self.n_rows += 1;
    }

    fn finished(mut self) -> Self {
        self.columns.iter_mut().for_each(|column| column.cells.resize(self.n_rows, Cell::None));
        let rank =
            |column: &Column| FIRST.iter().position(|name| *name == column.name).unwrap_or(FIRST.len());
        self.columns.sort_by_key(rank);
        self
    }
}

/// Reads a file of one object (or one list of objects): the `--json` output of a verb.
///
/// # Errors
/// When it cannot be read, or contains anything else.
pub(crate) fn read_object(path: &Path) -> Result<Log> {
    let value: Value = serde_json::from_slice(&bytes(path)?).map_err(|e| invalid_json(path, e.line(), &e))?;
    let mut log = Log { file: path.to_owned(), ..Log::default() };
    match &value {
        Value::Object(object) => log.add("", object),
        Value::Array(rows) if is_table(rows) => log.tables.push(table("rows", rows)),
        other => return Err(not_an_object(path, other)),
    }
    Ok(log)
}

/// Reads a file with an object per line.
///
/// # Errors
/// When it cannot be read, or a line is not an object; names the line.
pub(crate) fn read_lines(path: &Path) -> Result<Log> {
    let bytes = bytes(path)?;
    let mut rows = Table { name: "steps".into(), ..Table::default() };
    for (line, text) in (1..).zip(bytes.split(|&b| b == b'\n')) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        match serde_json::from_slice(text).map_err(|e| invalid_json(path, line, &e))? {
            Value::Object(object) => rows.add(&object),
            other => return Err(not_an_object(path, &other).at(format!("line {line}"))),
        }
    }
    if rows.n_rows == 0 {
        return Err(Error::input("the log is empty: one object per line is expected")
            .in_file(path)
            .remedy("leave it out until the run has written its first step"));
    }
    Ok(Log { file: path.to_owned(), tables: vec![rows.finished()], ..Log::default() })
}

fn bytes(path: &Path) -> Result<Vec<u8>> {
    let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
    if bytes.trim_ascii().is_empty() {
        return Err(Error::input("is empty, but JSON is expected")
            .in_file(path)
            .remedy("write it again: motet VERB ... --json > FILE"));
    }
    Ok(bytes)
}

fn invalid_json(path: &Path, line: usize, e: &serde_json::Error) -> Error {
    Error::input(format!("is not valid JSON: {e}"))
        .in_file(path)
        .at(format!("line {line}"))
        .remedy("give the --json output of a verb, or a .jsonl log with one object per line")
}

fn not_an_object(path: &Path, value: &Value) -> Error {
    let found = match value {
        Value::Null => "null",
        Value::Bool(_) => "a boolean",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    };
    Error::input(format!("an object or a list of objects is expected, found {found}"))
        .in_file(path)
        .remedy("give the --json output of a verb, or a .jsonl log with one object per line")
}

impl Log {
    fn add(&mut self, prefix: &str, object: &Map<String, Value>) {
        for (key, value) in object {
            let name = joined(prefix, key);
            match value {
                Value::Object(inner) => self.add(&name, inner),
                Value::Array(rows) if is_table(rows) => self.tables.push(table(&name, rows)),
                other => self.facts.extend(text(other).map(|text| (name, text))),
            }
        }
    }
}

fn is_table(rows: &[Value]) -> bool {
    !rows.is_empty() && rows.iter().all(Value::is_object)
}

fn table(name: &str, rows: &[Value]) -> Table {
    let mut table = Table { name: name.to_owned(), ..Table::default() };
    rows.iter().filter_map(Value::as_object).for_each(|row| table.add(row));
    table.finished()
}

fn joined(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// The keys and values of one row; keys of nested objects are joined by dots.
fn spread(prefix: &str, row: &Map<String, Value>, cells: &mut Vec<(String, Cell)>) {
    for (key, value) in row {
        let name = joined(prefix, key);
        match value {
            Value::Object(inner) => spread(&name, inner, cells),
            Value::Array(rows) if is_table(rows) && rows.len() <= LONGEST_SPREAD => {
                for (i, row) in rows.iter().filter_map(Value::as_object).enumerate() {
                    spread(&format!("{name} {}", name_of_row(row, i)), row, cells);
                }
            }
            Value::Number(x) => cells.push((name, Cell::Number(x.as_f64().unwrap_or(f64::NAN)))),
            other => cells.push((name, text(other).map_or(Cell::None, Cell::Text))),
        }
    }
}

/// The name of an object in a list: its `name`, otherwise its first text, otherwise its number.
fn name_of_row(row: &Map<String, Value>, i: usize) -> String {
    let texts = || row.values().filter_map(Value::as_str);
    row.get("name").and_then(Value::as_str).or_else(|| texts().next()).map_or(i.to_string(), str::to_owned)
}

/// A value in few words; `None` for null.
fn text(value: &Value) -> Option<String> {
    Some(match value {
        Value::Null => return None,
        Value::Bool(is) => if *is { "yes" } else { "no" }.to_owned(),
        Value::Number(x) => match x.as_i64() {
            Some(whole) => whole.to_string(),
            None => short(x.as_f64()?),
        },
        Value::String(text) => text.clone(),
        Value::Array(list) if list.is_empty() => "none".to_owned(),
        Value::Array(list) if list.len() <= 9 && list.iter().all(|x| x.is_number() || x.is_string()) => {
            list.iter().filter_map(text).collect::<Vec<_>>().join(", ")
        }
        Value::Array(list) => format!("{} entries", list.len()),
        Value::Object(object) => format!("{} keys", object.len()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Result<Log> {
        let file = tempfile::Builder::new().suffix(".jsonl").tempfile().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read_lines(file.path())
    }

    #[test]
    fn keys_that_come_and_go_leave_gaps() {
        let log = lines("{\"a\": 1, \"step\": 0}\n\n{\"step\": 1, \"seconds\": {\"graph\": 0.5}}\n").unwrap();
        let table = &log.tables[0];
        let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["step", "a", "seconds.graph"]);
        assert_eq!(table.columns[1].numbers(), [Some(1.0), None]);
        assert_eq!(table.columns[2].numbers(), [None, Some(0.5)]);
    }

    #[test]
    fn lists_of_objects_are_spread_by_their_names() {
        let log =
            lines("{\"gaps\": [{\"body\": \"left\", \"min\": 0.5}, {\"body\": \"right\", \"min\": 2}]}")
                .unwrap();
        assert_eq!(log.tables[0].column("gaps right.min").unwrap().numbers(), [Some(2.0)]);
    }

    #[test]
    fn what_is_no_object_is_reported_with_its_line() {
        let message = |text| lines(text).unwrap_err().to_string();
        assert!(
            message("{}\n3\n").contains("line 2: an object or a list of objects is expected, found a number")
        );
        assert!(message("{}\n{\n").contains("line 2: is not valid JSON"));
        assert!(message(" \n").contains("is empty"));
    }
}
