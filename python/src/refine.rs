//! Refinement: tets divided over many generations, and divisions undone.

use std::collections::BTreeMap;
use std::sync::Arc;

use motet::base::{Point, TetId};
use motet::mesh::history;
use motet::refine;
use motet::refine::sizes::SizeLimits;
use motet::refine::{
    Aim, Amount, Estimator, HessianSizes, MeshRefinement, Options, RefineWords, Size, Target, Wanted,
    fix_sizes,
};
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::arrays::Read;
use crate::convert::{MeshArg, parts};
use crate::error::{OrRaise, call, input, options};
use crate::history::{ChangedParts, History};
use crate::report::report;
use crate::watch::watched;
use crate::words::{rules, threads};

/// A criterion of what to divide.
#[pyclass(frozen, from_py_object, module = "motet._motet")]
#[derive(Clone)]
pub(crate) struct Criterion(pub(crate) refine::Criterion);

/// A share of the error, or a number of tets.
#[derive(FromPyObject)]
enum AmountArg {
    Tets(usize),
    Share(f64),
}

fn checked(criterion: refine::Criterion) -> PyResult<Criterion> {
    criterion.check().or_raise()?;
    Ok(Criterion(criterion))
}

fn target(surface: &MeshArg) -> PyResult<Arc<Target>> {
    Target::of_mesh(&surface.0, &threads(1)?).map(Arc::new).or_raise()
}

fn estimate(array: String, by: Estimator, amount: AmountArg) -> PyResult<Criterion> {
    let amount = match amount {
        AmountArg::Tets(n) => Amount::Tets(n),
        AmountArg::Share(share) => Amount::Share(share),
    };
    checked(refine::Criterion::Estimate { array, by, amount })
}

fn of_text(word: &str, text: &str) -> PyResult<Criterion> {
    refine::Criterion::of_text(word, text).map(Criterion).or_raise()
}

#[pymethods]
impl Criterion {
    #[staticmethod]
    fn all() -> Self {
        Self(refine::Criterion::All)
    }

    #[staticmethod]
    fn near(surface: MeshArg, within: f64) -> PyResult<Self> {
        checked(refine::Criterion::Near { target: target(&surface)?, within })
    }

    #[staticmethod]
    fn near_size(surface: MeshArg, size: f64, growth: Option<f64>) -> PyResult<Self> {
        let growth = growth.unwrap_or(refine::Criterion::GROWTH);
        checked(refine::Criterion::NearSize { target: target(&surface)?, size, growth })
    }

    #[staticmethod]
    fn ball(centre: Point, radius: f64) -> PyResult<Self> {
        checked(refine::Criterion::Ball { centre, radius })
    }

    #[staticmethod]
    fn r#box(low: Point, high: Point) -> PyResult<Self> {
        checked(refine::Criterion::Box([low, high]))
    }

    #[staticmethod]
    fn region(name: String) -> PyResult<Self> {
        checked(refine::Criterion::Region(name))
    }

    #[staticmethod]
    fn patch(name: String, within: Option<f64>) -> PyResult<Self> {
        checked(refine::Criterion::Patch { patch: name, within })
    }

    #[staticmethod]
    fn size(size: f64) -> PyResult<Self> {
        checked(refine::Criterion::Size(Size::Uniform(size)))
    }

    #[staticmethod]
    fn size_array(array: String) -> PyResult<Self> {
        checked(refine::Criterion::Size(Size::Array(array)))
    }

    #[staticmethod]
    fn r#where(condition: &str) -> PyResult<Self> {
        of_text("where", condition)
    }

    #[staticmethod]
    fn gradient(threshold: &str) -> PyResult<Self> {
        of_text("gradient", threshold)
    }

    #[staticmethod]
    fn vorticity(threshold: &str) -> PyResult<Self> {
        of_text("vorticity", threshold)
    }

    #[staticmethod]
    fn q(threshold: &str) -> PyResult<Self> {
        of_text("q", threshold)
    }

    #[staticmethod]
    fn jump(array: String, amount: AmountArg) -> PyResult<Self> {
        estimate(array, Estimator::Jump, amount)
    }

    #[staticmethod]
    fn recovery(array: String, amount: AmountArg) -> PyResult<Self> {
        estimate(array, Estimator::Recovery, amount)
    }

    #[staticmethod]
    #[pyo3(signature = (arrays, *, error = None, range_part = None, tets = None, smallest = None))]
    fn hessian(
        arrays: Vec<String>,
        error: Option<f64>,
        range_part: Option<f64>,
        tets: Option<usize>,
        smallest: Option<f64>,
    ) -> PyResult<Self> {
        let aim = match (error, range_part, tets) {
            (Some(error), None, None) => Aim::Error(error),
            (None, Some(part), None) => Aim::RangePart(part),
            (None, None, Some(n)) => Aim::Tets(n),
            _ => return Err(options("hessian: give one of error, range_part and tets")),
        };
        let limits = SizeLimits { smallest: smallest.unwrap_or(0.0), ..SizeLimits::default() };
        checked(refine::Criterion::Hessian(HessianSizes { arrays, aim, limits }))
    }
}

/// The request of a call; on Python's side a class with these attributes.
#[derive(FromPyObject)]
pub(crate) struct Request {
    criteria: Vec<Criterion>,
    coarsen: bool,
    coarsen_where: Vec<String>,
    generations: Option<u32>,
    limit_generation: Option<u8>,
    smallest: Option<f64>,
    at_most: Option<usize>,
    surface: Option<MeshArg>,
    carry: BTreeMap<String, String>,
    forget: bool,
}

/// The report of a step.
#[derive(Serialize)]
struct Done {
    tets: usize,
    promoted: usize,
    cut: usize,
    held: usize,
}

impl Done {
    fn of(summary: &refine::Summary) -> Self {
        Self { tets: summary.n_tets, promoted: summary.n_promoted, cut: summary.n_cut, held: summary.n_held }
    }
}

#[derive(Serialize)]
struct RefineReport {
    complete: bool,
    steps: Vec<refine::Step>,
}

/// Returns the new mesh with its memory, its history, the report, and why edges are longer than requested.
#[pyfunction]
pub(crate) fn refined<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    request: Request,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ChangedParts<'py>> {
    let mut mesh = if request.forget { MeshRefinement::forget(&mesh.0) } else { mesh.0 };
    let rules = rules(&mesh, &request.carry)?;
    let words = RefineWords {
        coarsen: request.coarsen,
        coarsen_where: request.coarsen_where,
        generations: request.generations,
        limit_generation: request.limit_generation,
        smallest: request.smallest,
        at_most: request.at_most,
        ..RefineWords::default()
    };
    let criteria = request.criteria.into_iter().map(|criterion| criterion.0).collect();
    let mut wanted = Wanted {
        surface: request.surface.as_ref().map(target).transpose()?,
        keeps_history: true,
        ..words.wanted(criteria).or_raise()?
    };
    let (new, done) = watched(py, threads, progress, |threads| {
        let sizes = fix_sizes(&mut wanted.criteria, &mut mesh, threads)?;
        let mut refinement = MeshRefinement::new(&mesh, Options::default(), threads)?;
        let done = refinement.reach(&wanted, &rules, threads, |_| ())?;
        let mut new = refinement.with_memory(threads);
        new.point_data.retain(|field| !sizes.contains(&field.name));
        Ok((new, done))
    })?;
    let not_reached = done.not_reached();
    let report = report(py, &RefineReport { complete: done.is_reached, steps: done.steps })?;
    let history = done.history.ok_or_else(|| input("no history was kept"))?;
    Ok((parts(py, new)?, History(history), report, not_reached))
}

/// A mesh whose tets are divided, and divisions undone, step by step.
#[pyclass(module = "motet._motet")]
pub(crate) struct Refinement {
    refinement: MeshRefinement,
    threads: motet::base::Threads,
}

#[pymethods]
impl Refinement {
    #[new]
    fn new(py: Python<'_>, mesh: MeshArg, threads: usize) -> PyResult<Self> {
        let threads = self::threads(threads)?;
        let refinement = call(py, || MeshRefinement::new(&mesh.0, Options::default(), &threads))?;
        Ok(Self { refinement, threads })
    }

    fn mesh<'py>(&self, py: Python<'py>, memory: bool) -> PyResult<Bound<'py, PyDict>> {
        parts(
            py,
            if memory { self.refinement.with_memory(&self.threads) } else { self.refinement.mesh().clone() },
        )
    }

    /// The number of divisions that led to each cell from one of the first mesh; -1 for cells that are not
    /// tets.
    fn generations<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        let part = self.refinement.part();
        let mut all = vec![-1i16; self.refinement.mesh().cells.len()];
        for (cell, generation) in part.tet_to_cell.iter().zip(self.refinement.refinement().generations()) {
            all[cell.index()] = generation.into();
        }
        numpy::PyArray1::from_vec(py, all).into_any()
    }

    fn change<'py>(
        &mut self,
        py: Python<'py>,
        cells: Read<'_, bool, Ix1>,
        is_back: bool,
        carry: BTreeMap<String, String>,
    ) -> PyResult<(History, Bound<'py, PyAny>)> {
        let rules = rules(self.refinement.mesh(), &carry)?;
        let is_marked = cells.as_array();
        if is_marked.len() != self.refinement.mesh().cells.len() {
            return Err(input(format!(
                "{} marks, but the mesh has {} cells",
                is_marked.len(),
                self.refinement.mesh().cells.len()
            )));
        }
        let cells = self.refinement.part().tet_to_cell;
        let marked: Vec<TetId> = cells
            .iter()
            .enumerate()
            .filter(|(_, cell)| is_marked[cell.index()])
            .map(|(t, _)| TetId::new(t))
            .collect();
        let (summary, history): (_, history::History) = call(py, || {
            let done = match is_back {
                false => self.refinement.refine(&marked, &rules, &self.threads),
                true => self.refinement.coarsen(&marked, &rules, &self.threads),
            };
            done.map(|done| (done.report, done.history))
        })?;
        Ok((History(history), report(py, &Done::of(&summary))?))
    }
}
