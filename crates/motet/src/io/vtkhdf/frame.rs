//! Selects the parts of a file that make up one mesh, and the first row of each in every array.

use std::ops::Range;

use crate::base::{Error, Result};
use crate::io::hdf::{Array, Group};

/// The group of steps in a transient file.
pub(super) struct Steps {
    group: Group,
    /// The time of each step.
    pub(super) times: Vec<f64>,
}

impl Steps {
    /// Reads the steps of a file; `None` if it has none.
    pub(super) fn of(root: &Group) -> Result<Option<Self>> {
        let Some(group) = root.group("Steps")? else { return Ok(None) };
        let values = group.required_array("Values")?;
        let times = values.all()?.to_f64().ok_or_else(|| values.error("times are not numbers"))?;
        let declared = group.ints("NSteps").and_then(|n| n.first().copied());
        if declared.is_some_and(|n| usize::try_from(n) != Ok(times.len())) || times.is_empty() {
            let declared = declared.unwrap_or_default();
            return Err(values.error(format!("{} times for {declared} steps", times.len())));
        }
        Ok(Some(Self { group, times }))
    }

    /// The row of the array `name` for a step; `None` if there is no such array.
    fn row(&self, name: &str, step: usize) -> Result<Option<Vec<usize>>> {
        self.group.array(name)?.map(|array| row(&array, step)).transpose()
    }

    /// The row for a step, like [`Self::row`], of an array in a subgroup.
    fn row_within(&self, group: &str, name: &str, step: usize) -> Result<Option<Vec<usize>>> {
        let array = self.group.group(group)?.map(|g| g.array(name)).transpose()?.flatten();
        array.map(|array| row(&array, step)).transpose()
    }
}

fn row(array: &Array, step: usize) -> Result<Vec<usize>> {
    array.ints(step..step + 1)?.into_iter().map(|n| whole(array, n)).collect()
}

fn whole(array: &Array, n: i64) -> Result<usize> {
    usize::try_from(n).map_err(|_| array.error(format!("{n} is not a valid number of rows")))
}

/// The counts of an array for a range of parts.
pub(super) fn counts(group: &Group, name: &str, parts: &Range<usize>) -> Result<Vec<usize>> {
    let array = group.required_array(name)?;
    array.ints(parts.clone())?.into_iter().map(|n| whole(&array, n)).collect()
}

/// One mesh of a file: the only one, or that of a step.
pub(super) struct Frame<'a> {
    root: &'a Group,
    step: Option<(&'a Steps, usize)>,
    /// The parts that make up this mesh.
    pub(super) parts: Range<usize>,
}

impl<'a> Frame<'a> {
    /// The mesh of a file without steps, which consists of all parts.
    pub(super) fn whole(root: &'a Group) -> Result<Self> {
        let parts = 0..root.required_array("NumberOfPoints")?.rows();
        Ok(Self { root, step: None, parts })
    }

    /// The mesh of a step.
    pub(super) fn of_step(root: &'a Group, steps: &'a Steps, step: usize) -> Result<Self> {
        let first = |name| Ok::<_, Error>(steps.row(name, step)?.and_then(|row| row.first().copied()));
        let all = root.required_array("NumberOfPoints")?;
        let n = first("NumberOfParts")?.unwrap_or(all.rows() / steps.times.len());
        let start = first("PartOffsets")?.unwrap_or(step * n);
        match start.checked_add(n).filter(|&end| end <= all.rows()) {
            Some(end) => Ok(Self { root, step: Some((steps, step)), parts: start..end }),
            None => Err(all.error(format!(
                "step {step} refers to {n} parts from part {start}, but there are {}",
                all.rows()
            ))),
        }
    }

    /// The first row of the frame according to the array `offsets` of the steps, or, if it is not given
    /// there, the result of `before`.
    pub(super) fn start(
        &self,
        offsets: &str,
        column: usize,
        before: impl Fn() -> Result<usize>,
    ) -> Result<usize> {
        let stored = match self.step {
            Some((steps, step)) => steps.row(offsets, step)?.and_then(|row| row.get(column).copied()),
            None => None,
        };
        stored.map_or_else(before, Ok)
    }

    /// The sum of the counts of all parts before this frame.
    pub(super) fn rows_before(&self, group: &Group, counted: &str) -> Result<usize> {
        let counts = counts(group, counted, &(0..self.parts.start))?;
        Ok(counts.iter().fold(0, |sum, n| sum.saturating_add(*n)))
    }

    /// The first row of the points.
    pub(super) fn first_point(&self) -> Result<usize> {
        self.start("PointOffsets", 0, || self.rows_before(self.root, "NumberOfPoints"))
    }

    /// The first row of an array of `kind` (`PointData`, `CellData`); `default` if the steps do not specify
    /// it.
    pub(super) fn first_value(&self, kind: &str, name: &str, default: usize) -> Result<usize> {
        let Some((steps, step)) = self.step else { return Ok(default) };
        let row = steps.row_within(&format!("{kind}Offsets"), name, step)?;
        Ok(row.and_then(|row| row.first().copied()).unwrap_or(default))
    }

    /// The rows of a field data array, and the number of values in each.
    pub(super) fn field_rows(&self, name: &str, array: &Array) -> Result<(Range<usize>, usize)> {
        let all = (0..array.rows(), array.components());
        let Some((steps, step)) = self.step else { return Ok(all) };
        let sizes = steps.row_within("FieldDataSizes", name, step)?;
        let (components, n) = match sizes.as_deref() {
            Some(&[components, n]) => (components, n),
            _ => (all.1, 1),
        };
        let start = steps.row_within("FieldDataOffsets", name, step)?.and_then(|row| row.first().copied());
        match start.or_else(|| (all.0.end == steps.times.len()).then_some(step)) {
            // An array whose width changes over time is not addressed by rows: it is returned whole.
            Some(start) if components == all.1 => Ok((start..start.saturating_add(n), components)),
            _ => Ok(all),
        }
    }
}
