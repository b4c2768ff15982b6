//! `$NodeData` and `$ElementData`: arrays indexed by the numbers of nodes or elements.

use super::source::{Form, Source};
use crate::base::{Error, Result};
use crate::io::Notes;
use crate::io::tags::Tags;
use crate::mesh::{Field, Mesh, Values};

/// What an array is defined on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Location {
    Node,
    Element,
}

/// An array as stored in the file.
pub(super) struct Data {
    pub(super) place: Location,
    name: String,
    step: i32,
    components: usize,
    tags: Vec<u64>,
    values: Vec<f64>,
}

impl Data {
    /// Reads the section after its first line. The head is text in binary files too.
    pub(super) fn read(source: &mut Source<'_>, place: Location) -> Result<Self> {
        let form = std::mem::replace(&mut source.form, Form::Ascii);
        let mut names = Vec::new();
        let n_names = source.text.count("names of an array", 1)?;
        source.text.line();
        for _ in 0..n_names {
            let line = source.text.line().ok_or_else(|| source.text.unexpected_end("name of an array"))?;
            names.push(String::from_utf8_lossy(line).trim().trim_matches('"').to_owned());
        }
        for _ in 0..source.int_count("real tags", 1)? {
            source.double("time of an array")?;
        }
        let n_integers = source.int_count("integer tags", 1)?;
        let mut integers = Vec::with_capacity(n_integers);
        for _ in 0..n_integers {
            integers.push(source.int("integer tag of an array")?);
        }
        let [step, components, n, ..] = integers[..] else {
            return Err(source
                .error(format!(
                    "expected at least 3 integer tags of an array (step, components, values), found {}",
                    integers.len()
                ))
                .remedy("write the file again"));
        };
        source.text.line();
        source.form = form;
        let components = usize::try_from(components)
            .ok()
            .filter(|c| *c > 0)
            .ok_or_else(|| source.error(format!("{components} is not a valid number of components")))?;
        let n = source.checked_count(
            u64::try_from(n).unwrap_or(u64::MAX),
            "values",
            components.saturating_add(1),
        )?;
        let name = names.into_iter().next().unwrap_or_else(|| "unnamed".into());
        let mut data = Self { place, name, step, components, tags: Vec::new(), values: Vec::new() };
        data.tags.reserve(n);
        data.values.reserve(n * components);
        for _ in 0..n {
            data.tags.push(i64::from(source.int("node or element number")?) as u64);
            for _ in 0..components {
                data.values.push(source.double("value of an array")?);
            }
        }
        Ok(data)
    }

    /// Adds the array to the mesh, with each value in its place; missing values are NaN.
    pub(super) fn put(
        self,
        mesh: &mut Mesh,
        nodes: &Tags,
        elements: Option<&(Tags, Vec<u32>)>,
        notes: &Notes,
    ) -> Result<()> {
        let (tags, places, n_rows, what) = match (self.place, elements) {
            (Location::Node, _) | (_, None) => (nodes, &[][..], mesh.points.len(), "node"),
            (Location::Element, Some((tags, places))) => (tags, &places[..], mesh.cells.len(), "element"),
        };
        let mut values = vec![f64::NAN; self.checked_size(n_rows)?];
        let mut missing = vec![true; n_rows];
        for (tag, row) in self.tags.iter().zip(self.values.chunks_exact(self.components)) {
            let Some(place) = tags.place(*tag) else {
                return Err(Error::input(format!("has a value for {what} {tag}, which does not exist"))
                    .at(format!("array {}", self.name))
                    .remedy("the file is damaged: write it again"));
            };
            let place = places.get(place as usize).copied().unwrap_or(place) as usize;
            values[place * self.components..][..self.components].copy_from_slice(row);
            missing[place] = false;
        }
        let n_missing = missing.iter().filter(|m| **m).count();
        if n_missing > 0 {
            notes.add(format!(
                "array {}: {n_missing} of {n_rows} {what}s have no value and get NaN",
                self.name
            ));
        }
        let fields = if self.place == Location::Node { &mut mesh.point_data } else { &mut mesh.cell_data };
        let mut name = self.name;
        if fields.iter().any(|f| f.name == name) {
            let longer = format!("{name}:{}", self.step);
            notes.add(format!("array {name} occurs more than once: a later one is renamed {longer}"));
            name = longer;
        }
        if fields.iter().any(|f| f.name == name) {
            return Err(
                Error::input("occurs more than once with the same time step").at(format!("array {name}"))
            );
        }
        fields.push(Field { name, components: self.components, values: Values::F64(values) });
        Ok(())
    }

    /// The size of the full array, bounded because a few values on a large mesh may declare more components
    /// than memory holds.
    fn checked_size(&self, n_rows: usize) -> Result<usize> {
        let limit = 16 * n_rows.max(self.values.len()).max(1);
        n_rows.checked_mul(self.components).filter(|&size| size <= limit).ok_or_else(|| {
            Error::input(format!("too many components: {} for each of {n_rows} rows", self.components))
                .at(format!("array {}", self.name))
                .remedy("the file is damaged: write it again")
        })
    }
}
