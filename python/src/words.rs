//! Common arguments of calls: patches by name, rules of arrays, number of threads.

use std::collections::BTreeMap;

use motet::Mesh;
use motet::base::{Names, Threads};
use motet::mesh::history::{Carry, Rules};
use motet::meshing::MeshingWords;
use motet::meshing::even::SurfaceWords;
use motet::meshing::wall::WallWords;
use motet::motion::FacetSet;
use motet::remesh::RemeshWords;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Ids;
use crate::error::OrRaise;
use crate::report::report;

/// The number of threads; 0 means all cores.
pub(crate) fn threads(n: usize) -> PyResult<Threads> {
    Threads::new(n).or_raise()
}

/// The meaning of an option's value, which must be one of the known names.
pub(crate) fn one_of<T: Copy>(option: &str, given: &str, known: &[(&str, T)]) -> PyResult<T> {
    motet::base::one_of(option, given, known).or_raise()
}

/// The value of an option that has this name in the library.
pub(crate) fn name_of<T: Names>(given: &str) -> PyResult<T> {
    T::of(given).or_raise()
}

/// The defaults of the library, by function and argument.
#[pyfunction]
pub(crate) fn defaults(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("remesh", report(py, &RemeshWords::default())?)?;
    all.set_item("mesh", report(py, &MeshingWords::default())?)?;
    all.set_item("surface", report(py, &SurfaceWords::default())?)?;
    all.set_item("wall", report(py, &WallWords::default())?)?;
    Ok(all)
}

/// The rules by which arrays are carried, by name: "mean", "linear", "inherit" or "drop".
pub(crate) fn rules(mesh: &Mesh, carry: &BTreeMap<String, String>) -> PyResult<Rules> {
    let mut rules = Rules::default();
    for (name, rule) in carry {
        let known = [
            ("mean", Carry::Mean),
            ("linear", Carry::Linear),
            ("inherit", Carry::Inherit),
            ("drop", Carry::Drop),
        ];
        rules.carry(mesh, name, one_of("carry", rule, &known)?).or_raise()?;
    }
    Ok(rules)
}

/// Facets given by an argument: a patch by number or name, or the facets themselves.
#[derive(FromPyObject)]
pub(crate) enum Facets<'py> {
    Number(i32),
    Name(String),
    /// The concatenated vertices of all facets, and how many each facet has.
    Own((Ids<'py>, usize)),
}

/// The facets that an argument refers to.
pub(crate) fn facets(mesh: &Mesh, given: &Facets<'_>) -> PyResult<FacetSet> {
    let patch = match given {
        Facets::Number(label) => label.to_string(),
        Facets::Name(name) => name.clone(),
        Facets::Own((vertices, n)) => {
            let vertices = crate::arrays::vertices(vertices, mesh.points.len())?;
            return Ok(FacetSet::of_rings("facets given", vertices.chunks(*n)));
        }
    };
    FacetSet::find(mesh, &patch).or_raise()
}

/// The facets that each of several arguments refers to.
pub(crate) fn all_facets(mesh: &Mesh, given: &[Facets<'_>]) -> PyResult<Vec<FacetSet>> {
    given.iter().map(|one| facets(mesh, one)).collect()
}
