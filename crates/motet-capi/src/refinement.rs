//! Refinement: tets divided, step after step, and divisions taken back.

use std::ptr;

use motet::base::{TetId, Threads};
use motet::mesh::history::{Changed, History, Rules};
use motet::refine::{Criterion, MeshRefinement, Options, RefineWords, Target, Wanted};
use motet::{Error, Result};
use serde_json::json;

use crate::changing::MotetOutcome;
use crate::guard::{MotetError, guarded};
use crate::memory::{
    expect, free, handle, handle_mut, out_handle, read_versioned, set_handle, threads, values, values_mut,
    versioned,
};
use crate::mesh::MotetMesh;
use crate::watch::{MotetWatch, Watched};

/// A refinement, the threads that it uses, and who watches its calls.
pub(crate) struct MotetRefinement {
    refinement: MeshRefinement,
    threads: Threads,
    watched: Watched,
}

versioned! {
    /// See the header.
    MotetRefinementOptions, motet_refinement_options_init {
        threads: i32 = 0,
        watched_by: *mut MotetWatch = ptr::null_mut(),
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_new(
    mesh: *const MotetMesh,
    options: *const MotetRefinementOptions,
    refinement: *mut *mut MotetRefinement,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(refinement, "refinement")?;
        let mesh = &handle(mesh, "mesh")?.0;
        let given = read_versioned(options)?;
        let (mut threads, watched) = (threads(given.threads)?, Watched::by(given.watched_by));
        let new = |threads: &Threads| MeshRefinement::new(mesh, Options::default(), threads);
        let refinement = watched.call(&mut threads, new)?;
        set_handle(place, MotetRefinement { refinement, threads, watched });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_free(refinement: *mut MotetRefinement) {
    free(refinement);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_mesh(
    refinement: *const MotetRefinement,
) -> *const MotetMesh {
    handle(refinement, "refinement").map_or(ptr::null(), |handle| MotetMesh::of(handle.refinement.mesh()))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_generations(
    refinement: *const MotetRefinement,
    generations: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetRefinement { refinement, .. } = handle(refinement, "refinement")?;
        let n_cells = refinement.mesh().cells.len();
        expect(n, n_cells, "cells")?;
        let out = values_mut(generations, n_cells, "generations")?;
        out.fill(-1);
        let cells = refinement.part().tet_to_cell;
        let all = cells.iter().zip(refinement.refinement().generations());
        all.for_each(|(cell, generation)| out[cell.index()] = generation.into());
        Ok(())
    })
}

/// Stores the outcome of a change, unless `outcome` is NULL.
fn store_outcome(
    refinement: &MeshRefinement,
    history: History,
    not_reached: Option<String>,
    outcome: *mut *mut MotetOutcome,
) -> Result<()> {
    if outcome.is_null() {
        return Ok(());
    }
    let place = out_handle(outcome, "outcome")?;
    let mesh = refinement.mesh().clone();
    let report = json!({ "tets": refinement.refinement().summary().n_tets });
    set_handle(place, MotetOutcome::new(mesh, Some(history), &report, not_reached)?);
    Ok(())
}

/// What is done to marked tets.
enum Change {
    Divide,
    Coarsen,
}

fn change(
    refinement: *mut MotetRefinement,
    marks: *const i32,
    n: i64,
    change: Change,
    outcome: *mut *mut MotetOutcome,
) -> Result<()> {
    if !outcome.is_null() {
        out_handle(outcome, "outcome")?;
    }
    let MotetRefinement { refinement, threads, .. } = handle_mut(refinement, "refinement")?;
    expect(n, refinement.mesh().cells.len(), "marks")?;
    let marks = values(marks, refinement.mesh().cells.len(), "marks")?;
    let cells = refinement.part().tet_to_cell;
    let marked: Vec<TetId> =
        (0..cells.len()).filter(|&t| marks[cells[t].index()] != 0).map(TetId::new).collect();
    let rules = Rules::default();
    let Changed { report: summary, history, .. } = match change {
        Change::Divide => refinement.refine(&marked, &rules, threads)?,
        Change::Coarsen => refinement.coarsen(&marked, &rules, threads)?,
    };
    let held = (summary.n_held > 0).then(|| format!("{} marked tets could not be changed", summary.n_held));
    store_outcome(refinement, history, held, outcome)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_divide(
    refinement: *mut MotetRefinement,
    marks: *const i32,
    n: i64,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || change(refinement, marks, n, Change::Divide, outcome))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_coarsen(
    refinement: *mut MotetRefinement,
    marks: *const i32,
    n: i64,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || change(refinement, marks, n, Change::Coarsen, outcome))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_refinement_near(
    refinement: *mut MotetRefinement,
    surface: *const MotetMesh,
    at: f64,
    growth: f64,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        if !outcome.is_null() {
            out_handle(outcome, "outcome")?;
        }
        let MotetRefinement { refinement, threads, watched } = handle_mut(refinement, "refinement")?;
        let surface = &handle(surface, "surface")?.0;
        // An error leaves the generations before it, whose history would be lost: a copy is refined.
        let mut refined = refinement.clone();
        let reached = watched.call(threads, |threads| {
            let target = Target::of_mesh(surface, threads)?.into();
            let criterion = Criterion::NearSize { target, size: at, growth };
            let wanted = RefineWords::default().wanted(vec![criterion])?;
            let wanted = Wanted { keeps_history: true, ..wanted };
            refined.reach(&wanted, &Rules::default(), threads, |_| ())
        })?;
        *refinement = refined;
        let not_reached = reached.not_reached();
        let history = reached.history.ok_or_else(|| Error::input("no history was kept"))?;
        store_outcome(refinement, history, not_reached, outcome)
    })
}
