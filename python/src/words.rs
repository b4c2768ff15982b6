//! Common arguments of calls: patches by name, rules of arrays, number of threads.

use std::collections::BTreeMap;

use motet::base::Threads;
use motet::mesh::history::{Carry, Rules};
use motet::motion::FacetSet;
use motet::{Error, Mesh};
use pyo3::prelude::*;

use crate::arrays::Ids;
use crate::error::{OrRaise, to_exception};

/// The number of threads; 0 means all cores.
pub(crate) fn threads(n: usize) -> PyResult<Threads> {
    Threads::new(n).or_raise()
}

/// One of a few keywords.
pub(crate) fn one_of<T: Copy>(option: &str, word: &str, known: &[(&str, T)]) -> PyResult<T> {
    known.iter().find(|(name, _)| *name == word).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<String> = known.iter().map(|(name, _)| format!("{name:?}")).collect();
        to_exception(
            Error::options(format!("{option}={word:?} means nothing"))
                .remedy(format!("choose one of {}", names.join(", "))),
        )
    })
}

/// The rules by which arrays are carried, from their names to "mean", "linear", "inherit" or "drop".
pub(crate) fn rules(mesh: &Mesh, carry: &BTreeMap<String, String>) -> PyResult<Rules> {
    let mut rules = Rules::default();
    for (name, word) in carry {
        let known = [
            ("mean", Carry::Mean),
            ("linear", Carry::Linear),
            ("inherit", Carry::Inherit),
            ("drop", Carry::Drop),
        ];
        rules.carry(mesh, name, one_of("carry", word, &known)?).or_raise()?;
    }
    Ok(rules)
}

/// Facets, as named by a call.
#[derive(FromPyObject)]
pub(crate) enum Facets<'py> {
    Number(i32),
    Name(String),
    /// The concatenated vertices of all facets, and how many each facet has.
    Own((Ids<'py>, usize)),
}

/// The facets that a word refers to: a patch by name or number, or the facets themselves.
pub(crate) fn facets(mesh: &Mesh, word: &Facets<'_>) -> PyResult<FacetSet> {
    let word = match word {
        Facets::Number(label) => label.to_string(),
        Facets::Name(name) => name.clone(),
        Facets::Own((vertices, n)) => {
            let vertices = crate::arrays::vertices(vertices, mesh.points.len())?;
            return Ok(FacetSet::of_rings("facets given", vertices.chunks(*n)));
        }
    };
    FacetSet::find(mesh, &word).or_raise()
}

/// The facets of each of several words.
pub(crate) fn all_facets(mesh: &Mesh, words: &[Facets<'_>]) -> PyResult<Vec<FacetSet>> {
    words.iter().map(|word| facets(mesh, word)).collect()
}
