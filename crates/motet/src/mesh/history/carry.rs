//! Transfers fields across a change: bit for bit to what was kept, by a rule to the rest.

use super::origins::{Origin, Origins};
use super::rule::is_averageable;
use super::{History, Row, Rows, Rule, Rules};
use crate::base::{Error, Id, Result, Threads};
use crate::mesh::data::check_rows;
use crate::mesh::{Field, Mesh, Values};

impl History {
    /// Transfers a point array of the old mesh to the points of the new one, by [`Rule::of_points`].
    ///
    /// # Errors
    /// If the array does not have one row for each old point.
    pub fn transfer_points(&self, field: &Field) -> Result<Field> {
        check(field, self.vertices.n_old(), "point")?;
        Ok(carried(&self.vertices, field, Rule::of_points(field), &Threads::single()))
    }

    /// Transfers a cell array of the old mesh to the cells of the new one, by [`Rule::of_cells`].
    ///
    /// # Errors
    /// If the array does not have one row for each old cell.
    pub fn transfer_cells(&self, field: &Field) -> Result<Field> {
        check(field, self.cells.n_old(), "cell")?;
        Ok(carried(&self.cells, field, Rule::of_cells(field), &Threads::single()))
    }

    /// Transfers a point array like [`Self::transfer_points`], by a given rule; `None` for [`Rule::Drop`].
    ///
    /// # Errors
    /// If the array does not have one row for each old point, or the rule does not apply: values on points
    /// are interpolated, not conserved, and whole numbers and texts have no mean.
    pub fn transfer_points_by(&self, field: &Field, rule: Rule) -> Result<Option<Field>> {
        self.points_by(field, rule, &Threads::single())
    }

    fn points_by(&self, field: &Field, rule: Rule, threads: &Threads) -> Result<Option<Field>> {
        check(field, self.vertices.n_old(), "point")?;
        check_rule(field, rule, &[Rule::Interpolate, Rule::Linear], "point")?;
        Ok((rule != Rule::Drop).then(|| carried(&self.vertices, field, rule, threads)))
    }

    /// Transfers a cell array like [`Self::transfer_cells`], by a given rule; `None` for [`Rule::Drop`].
    ///
    /// # Errors
    /// If the array does not have one row for each old cell, or the rule does not apply: values on cells are
    /// conserved, not interpolated, and whole numbers and texts have no mean.
    pub fn transfer_cells_by(&self, field: &Field, rule: Rule) -> Result<Option<Field>> {
        self.cells_by(field, rule, &Threads::single())
    }

    fn cells_by(&self, field: &Field, rule: Rule, threads: &Threads) -> Result<Option<Field>> {
        check(field, self.cells.n_old(), "cell")?;
        check_rule(field, rule, &[Rule::Conserve], "cell")?;
        Ok((rule != Rule::Drop).then(|| carried(&self.cells, field, rule, threads)))
    }

    /// Transfers to `new` all arrays of `old` that it lacks, on points, on cells and on the mesh as a whole,
    /// and the names of labels. Arrays that `new` already has stay as they are.
    ///
    /// # Errors
    /// If a mesh does not match the history, an array has the wrong length, or a rule names no array of `old`
    /// or does not apply to it. `new` is then unchanged.
    pub fn transfer(&self, old: &Mesh, new: &mut Mesh, rules: &Rules) -> Result<()> {
        self.transfer_on(old, new, rules, &Threads::single())
    }

    /// Transfers as [`transfer`](Self::transfer) does, on several threads.
    pub(crate) fn transfer_on(
        &self,
        old: &Mesh,
        new: &mut Mesh,
        rules: &Rules,
        threads: &Threads,
    ) -> Result<()> {
        check_count("old mesh", "points", self.vertices.n_old(), old.points.len())?;
        check_count("old mesh", "cells", self.cells.n_old(), old.cells.len())?;
        check_count("new mesh", "points", self.vertices.len(), new.points.len())?;
        check_count("new mesh", "cells", self.cells.len(), new.cells.len())?;
        check_names(&old.point_data, rules.points.keys(), "point")?;
        check_names(&old.cell_data, rules.cells.keys(), "cell")?;
        let on_points = missing(&old.point_data, &new.point_data).map(|field| {
            let rule = rules.points.get(&field.name).copied().unwrap_or_else(|| Rule::of_points(field));
            self.points_by(field, rule, threads)
        });
        let on_points: Vec<Option<Field>> = on_points.collect::<Result<_>>()?;
        let on_cells = missing(&old.cell_data, &new.cell_data).map(|field| {
            let rule = rules.cells.get(&field.name).copied().unwrap_or_else(|| Rule::of_cells(field));
            self.cells_by(field, rule, threads)
        });
        let on_cells: Vec<Option<Field>> = on_cells.collect::<Result<_>>()?;
        let on_mesh: Vec<Field> = missing(&old.field_data, &new.field_data).cloned().collect();
        new.point_data.extend(on_points.into_iter().flatten());
        new.cell_data.extend(on_cells.into_iter().flatten());
        new.field_data.extend(on_mesh);
        for (&label, name) in &old.label_names.regions {
            new.label_names.regions.entry(label).or_insert_with(|| name.clone());
        }
        for (&label, name) in &old.label_names.patches {
            new.label_names.patches.entry(label).or_insert_with(|| name.clone());
        }
        Ok(())
    }
}

/// The arrays of `old` whose names `new` does not have.
fn missing<'a>(old: &'a [Field], new: &'a [Field]) -> impl Iterator<Item = &'a Field> {
    old.iter().filter(|field| new.iter().all(|other| other.name != field.name))
}

fn check(field: &Field, n_old: usize, what: &str) -> Result<()> {
    let remedy = "give the array of the mesh before the change";
    check_rows(std::slice::from_ref(field), n_old, what).map_err(|e| e.remedy(remedy))
}

fn check_rule(field: &Field, rule: Rule, means: &[Rule], what: &str) -> Result<()> {
    let known: Vec<String> = means.iter().map(|mean| format!("{mean:?}")).collect();
    let error = match rule {
        Rule::Inherit | Rule::Drop => return Ok(()),
        rule if !means.contains(&rule) => {
            Error::options(format!("cannot be transferred by the rule {rule:?}"))
                .remedy(format!("{what} arrays take {}, Inherit or Drop", known.join(", ")))
        }
        _ if is_averageable(field) => return Ok(()),
        _ => Error::options(format!(
            "cannot be transferred by the rule {rule:?}, since whole numbers and texts have no mean"
        ))
        .remedy("use Inherit, or store it as floats"),
    };
    Err(error.at(format!("{what} array {}", field.name)))
}

fn check_count(mesh: &str, what: &str, expected: usize, got: usize) -> Result<()> {
    if expected == got {
        return Ok(());
    }
    let text = format!("has {got} {what}, but the history is of a mesh with {expected}");
    Err(Error::input(text).at(mesh).remedy("give the two meshes that the history belongs to"))
}

fn check_names<'a>(fields: &[Field], mut names: impl Iterator<Item = &'a String>, what: &str) -> Result<()> {
    let Some(name) = names.find(|name| fields.iter().all(|field| field.name != **name)) else {
        return Ok(());
    };
    let known: Vec<&str> = fields.iter().map(|f| f.name.as_str()).collect();
    Err(Error::options(format!("a rule names this array, but the mesh has only {}", known.join(", ")))
        .at(format!("{what} array {name}")))
}

/// Transfers `field`, which has a row for each old entity. Floats follow the rule; all other values are
/// inherited.
fn carried<I: Id>(origins: &Origins<I>, field: &Field, rule: Rule, threads: &Threads) -> Field {
    let n = field.components;
    let values = match &field.values {
        Values::F64(old) if rule != Rule::Inherit => Values::F64(mixed(origins, n, rule, old, threads)),
        Values::F32(old) if rule != Rule::Inherit => Values::F32(mixed(origins, n, rule, old, threads)),
        _ => return field.pick(origins.main().map(I::place)),
    };
    Field { name: field.name.clone(), components: field.components, values }
}

/// A floating-point type whose sums are taken in double precision.
trait Float: Copy + Into<f64> + Send + Sync {
    fn rounded(x: f64) -> Self;
}

impl Float for f64 {
    fn rounded(x: f64) -> Self {
        x
    }
}

impl Float for f32 {
    fn rounded(x: f64) -> Self {
        x as f32
    }
}

/// How many entities a thread takes at a time.
const RUN: usize = 1 << 14;

fn mixed<I: Id, T: Float>(
    origins: &Origins<I>,
    components: usize,
    rule: Rule,
    old: &[T],
    threads: &Threads,
) -> Vec<T> {
    let (none, quadratic) = (Rows::new(), origins.quadratic());
    let wide = if rule == Rule::Interpolate { quadratic } else { &none };
    threads.in_runs(origins.len(), RUN, |(): &mut (), run| {
        let mut new = Vec::with_capacity(run.len() * components);
        let mut wide = wide.from(I::of(run.start)).peekable();
        for (place, origin) in run.clone().zip(origins.from(run.start)) {
            let wide = wide.next_if(|(id, _)| id.place() == place).map(|(_, row)| row);
            match origin {
                Origin::Kept(id) => new.extend_from_slice(&old[id.place() * components..][..components]),
                Origin::Changed(row) => new.extend((0..components).map(|k| {
                    let value = |id: I| old[id.place() * components + k].into();
                    T::rounded(interpolated(&row, wide.as_ref(), value))
                })),
            }
        }
        new
    })
}

/// The value by a row for linear fields or, if there is one, by the row `wide` for quadratic fields. It
/// differs from the linear value by no more than the spread of the values in `row`, so that a jump or a NaN
/// two rings away does not spoil it.
fn interpolated<I: Id>(row: &Row<'_, I>, wide: Option<&Row<'_, I>>, value: impl Fn(I) -> f64) -> f64 {
    let linear = mean(row, &value);
    let Some(wide) = wide else { return linear };
    let ends = |(least, largest): (f64, f64), &id: &I| (value(id).min(least), value(id).max(largest));
    let (least, largest) = row.from.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
    let (apart, term) = (largest - least, mean(wide, &value) - linear);
    if term.is_finite() && apart.is_finite() { linear + term.clamp(-apart, apart) } else { linear }
}

/// The mean of a row's values. Differences from the first value are summed, so that equal values are
/// reproduced to the bit; and the mean is limited to the range of the values, which rounding and negative
/// shares might leave.
fn mean<I: Id>(row: &Row<'_, I>, value: impl Fn(I) -> f64) -> f64 {
    let first = value(row.from[0]);
    let (mut sum, mut least, mut largest) = (0.0, first, first);
    for (&id, &share) in row.from.iter().zip(row.shares).skip(1) {
        let value = value(id);
        sum += share * (value - first);
        (least, largest) = (least.min(value), largest.max(value));
    }
    let mean = first + sum;
    // NaN passes through: it was in the values before.
    if mean < least {
        least
    } else if mean > largest {
        largest
    } else {
        mean
    }
}
