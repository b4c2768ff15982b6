//! The origin of everything in a new mesh, and arrays carried from the old mesh.

use motet::base::{CellId, Id, VertexId};
use motet::mesh::history::{self, Origins};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{from_field, ids, to_field};
use crate::error::{call, input};
use crate::report::report;
use crate::words::one_of;
use motet::mesh::history::Rule;

/// A new mesh, its history, the report, and why the requested result was not reached.
pub(crate) type ChangedParts<'py> = (Bound<'py, PyDict>, History, Bound<'py, PyAny>, Option<String>);

/// A history.
#[pyclass(frozen, module = "motet._motet")]
pub(crate) struct History(pub(crate) history::History);

#[pymethods]
impl History {
    /// The old vertex of each new vertex; 2^32-1 for inserted ones.
    #[getter]
    fn vertex_to_old<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        kept::<VertexId>(py, &self.0.vertices)
    }

    /// The old cell of each new cell; 2^32-1 for inserted ones.
    #[getter]
    fn cell_to_old<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        kept::<CellId>(py, &self.0.cells)
    }

    /// The old vertex of each new vertex, or the one with the largest share in it.
    #[getter]
    fn vertex_to_main<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        ids(py, self.0.vertices.main().collect()).into_any()
    }

    /// The old cell of each new cell, or the one with the largest share in it.
    #[getter]
    fn cell_to_main<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        ids(py, self.0.cells.main().collect()).into_any()
    }

    /// How well the volumes of old and new cells agree.
    #[getter]
    fn ledger<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        report(py, &self.0.ledger)
    }

    /// Carries an array of the old mesh to the new one.
    fn transfer<'py>(
        &self,
        py: Python<'py>,
        name: String,
        array: &Bound<'py, PyAny>,
        on: &str,
        rule: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let field = to_field(name, array)?;
        let on_points = one_of("on", on, &[("points", true), ("cells", false)])?;
        let (mean, linear) = match on_points {
            true => (Rule::Interpolate, Rule::Linear),
            false => (Rule::Conserve, Rule::Conserve),
        };
        let rule = rule
            .map(|rule| {
                one_of("rule", rule, &[("mean", mean), ("linear", linear), ("inherit", Rule::Inherit)])
            })
            .transpose()?;
        let new = call(py, || match (on_points, rule) {
            (true, None) => self.0.transfer_points(&field).map(Some),
            (false, None) => self.0.transfer_cells(&field).map(Some),
            (true, Some(rule)) => self.0.transfer_points_by(&field, rule),
            (false, Some(rule)) => self.0.transfer_cells_by(&field, rule),
        });
        from_field(py, new?.ok_or_else(|| input("the rule drops the array"))?)
    }

    /// The whole history, as dictionaries and lists.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        report(py, &self.0)
    }

    /// Restores a history from the result of [`Self::state`].
    #[staticmethod]
    fn of_state(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let restored = pythonize::depythonize(state);
        restored.map(Self).map_err(|failed| input(format!("not a history: {failed}")))
    }

    fn __repr__(&self) -> String {
        let (vertices, cells) = (&self.0.vertices, &self.0.cells);
        format!(
            "vertices {} -> {}, cells {} -> {}",
            vertices.n_old(),
            vertices.len(),
            cells.n_old(),
            cells.len()
        )
    }

    /// The composition of this change with a later one.
    fn then(&self, later: &Self) -> PyResult<Self> {
        let fits = |a: usize, b: usize| a == b;
        if !fits(self.0.vertices.len(), later.0.vertices.n_old())
            || !fits(self.0.cells.len(), later.0.cells.n_old())
        {
            return Err(input("the later history does not start from the resulting mesh of the first"));
        }
        Ok(Self(self.0.then(&later.0)))
    }
}

fn kept<'py, I: Id + bytemuck::Pod>(py: Python<'py>, origins: &Origins<I>) -> Bound<'py, PyAny> {
    ids(py, origins.kept().to_vec()).into_any()
}
