//! Reads data items: numbers in the file, or in an HDF5 file beside it.

use std::collections::HashMap;
use std::path::Path;

use crate::base::{Error, Result};
use crate::io::hdf;
use crate::io::scalar::Scalar;
use crate::io::text::quoted;
use crate::io::vtkxml::Element;
use crate::mesh::Values;

/// The numbers of a data item.
pub(super) struct Data {
    pub(super) values: Values,
    pub(super) shape: Vec<usize>,
}

impl Data {
    /// Number of rows: the first dimension.
    pub(super) fn n_rows(&self) -> usize {
        self.shape.first().copied().unwrap_or(0)
    }

    /// Number of values in a row.
    pub(super) fn n_columns(&self) -> usize {
        self.shape.iter().skip(1).fold(1, |n, &d| n.saturating_mul(d))
    }
}

/// The HDF5 files that a file refers to, each opened once.
pub(super) struct Source<'a> {
    path: &'a Path,
    files: HashMap<String, hdf::Group>,
}

impl<'a> Source<'a> {
    /// For the file at `path`, beside which the others lie.
    pub(super) fn new(path: &'a Path) -> Self {
        Self { path, files: HashMap::new() }
    }

    /// The only data item of an element.
    pub(super) fn only_item(&mut self, element: &Element<'_>) -> Result<Data> {
        let mut items = element.children_named("DataItem");
        match (items.next(), items.next()) {
            (Some(item), None) => self.item(item),
            (None, _) => Err(Error::input("there are no numbers (DataItem)")
                .at(element.place())
                .remedy("structured grids are not supported: save it as an unstructured grid")),
            (Some(_), Some(_)) => Err(Error::input("expected one DataItem, found several")
                .at(element.place())
                .remedy("write coordinates as XYZ and cells as one list")),
        }
    }

    fn item(&mut self, item: &Element<'_>) -> Result<Data> {
        if let Some(kind) = item.attribute("ItemType").filter(|kind| !kind.eq_ignore_ascii_case("Uniform")) {
            return Err(Error::input(format!(
                "data items of type {} are not supported",
                quoted(kind.as_bytes())
            ))
            .at(item.place())
            .remedy("write the numbers themselves"));
        }
        if item.attribute("Reference").is_some() {
            return Err(Error::input("references to other data items are not supported")
                .at(item.place())
                .remedy("write the numbers themselves"));
        }
        match item.attribute("Format").unwrap_or("XML") {
            "XML" => text(item),
            "HDF" => self.hdf(item),
            other => Err(Error::input(format!(
                "data items of format {} are not supported",
                quoted(other.as_bytes())
            ))
            .at(item.place())
            .remedy("write the numbers as HDF or XML")),
        }
    }

    /// Reads an array of an HDF5 file, given as `FILE:/GROUP/ARRAY`.
    fn hdf(&mut self, item: &Element<'_>) -> Result<Data> {
        let place = String::from_utf8_lossy(item.text);
        let Some((file, path)) = place.rsplit_once(':') else {
            return Err(Error::input(format!(
                "expected FILE:/GROUP/ARRAY, found {}",
                quoted(place.as_bytes())
            ))
            .at(item.place()));
        };
        let file = file.trim();
        if !self.files.contains_key(file) {
            let beside = self.path.with_file_name(file);
            if !beside.is_file() {
                return Err(Error::input(format!(
                    "the file with its numbers does not exist: {}",
                    beside.display()
                ))
                .at(item.place())
                .remedy("put the file into the folder of the .xdmf file"));
            }
            let group = hdf::open_in_place(&beside).map_err(|e| e.in_file(&beside))?;
            self.files.insert(file.to_owned(), group);
        }
        let mut names: Vec<&str> = path.trim().split('/').filter(|name| !name.is_empty()).collect();
        let name = names.pop().unwrap_or_default();
        let missing = |name: &str| {
            Error::input(format!(
                "{file} has no array {}: {} is missing",
                path.trim(),
                quoted(name.as_bytes())
            ))
            .at(item.place())
            .remedy("the files do not belong together, or are damaged")
        };
        let mut inner: Option<hdf::Group> = None;
        for group in names {
            let outer = inner.as_ref().unwrap_or(&self.files[file]);
            inner = Some(outer.group(group)?.ok_or_else(|| missing(group))?);
        }
        let group = inner.as_ref().unwrap_or(&self.files[file]);
        let array = group.array(name)?.ok_or_else(|| missing(name))?;
        Ok(Data { shape: vec![array.rows(), array.components()], values: array.all()? })
    }
}

/// Reads numbers that are text in the file.
fn text(item: &Element<'_>) -> Result<Data> {
    let shape = dimensions(item)?;
    let kind = number_type(item)?;
    let content = std::str::from_utf8(item.text)
        .map_err(|_| Error::input("expected numbers, found other bytes").at(item.place()))?;
    let n = shape.iter().try_fold(1usize, |n, &d| n.checked_mul(d)).filter(|&n| n <= content.len());
    let Some(n) = n.or_else(|| shape.contains(&0).then_some(0)) else {
        return Err(Error::input(format!(
            "{} numbers declared, but the text has {} characters",
            item.attribute("Dimensions").unwrap_or_default(),
            content.len()
        ))
        .at(item.place())
        .remedy("the file is truncated or damaged: get a new copy"));
    };
    let mut tokens = content.split_ascii_whitespace();
    let values = kind.parse(n, &mut tokens).map_err(|token| {
        Error::input(format!("expected a number, found {}", quoted(token.as_bytes()))).at(item.place())
    })?;
    if values.len() < n || tokens.next().is_some() {
        let found = if values.len() < n { values.len().to_string() } else { "more".into() };
        return Err(Error::input(format!("expected {n} numbers, found {found}")).at(item.place()));
    }
    Ok(Data { values, shape })
}

fn dimensions(item: &Element<'_>) -> Result<Vec<usize>> {
    let text = item.attribute("Dimensions").unwrap_or_default();
    let shape: Option<Vec<usize>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    shape.filter(|shape| !shape.is_empty()).ok_or_else(|| {
        Error::input(format!("expected Dimensions, such as \"10 3\", found {}", quoted(text.as_bytes())))
            .at(item.place())
    })
}

fn number_type(item: &Element<'_>) -> Result<Scalar> {
    let name = item.attribute("NumberType").or_else(|| item.attribute("DataType")).unwrap_or("Float");
    let precision = item.attribute("Precision");
    Ok(match (name.to_ascii_lowercase().as_str(), precision.unwrap_or("4")) {
        ("float", "4") => Scalar::F32,
        ("float", "8") => Scalar::F64,
        ("char", _) | ("int", "1") => Scalar::I8,
        ("uchar", _) | ("uint", "1") => Scalar::U8,
        ("short", _) | ("int", "2") => Scalar::I16,
        ("ushort", _) | ("uint", "2") => Scalar::U16,
        ("int", "4") => Scalar::I32,
        ("uint", "4") => Scalar::U32,
        ("int", "8") => Scalar::I64,
        ("uint", "8") => Scalar::U64,
        (name, bytes) => {
            return Err(Error::input(format!("numbers of type {name} with {bytes} bytes are not supported"))
                .at(item.place()));
        }
    })
}
