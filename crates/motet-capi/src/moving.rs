//! The loop: a mesh that follows its walls, step by step, and stays good.

use std::ffi::c_char;
use std::ptr;

use motet::base::{Point, Threads};
use motet::contact::GapWords;
use motet::motion::{Motion, SlideTolerance, Strain};
use motet::moving::{GAP, MovingMesh, Options, RepairWords, Step, WatchWords};
use motet::refine::{Criterion, RefineWords, Size, Target, Wanted};
use motet::{Error, Mesh, Result, io};
use serde_json::json;

use crate::changing::MotetOutcome;
use crate::constants::{self, On};
use crate::guard::{MotetError, guarded, or_default};
use crate::memory::{
    copy_out, count, expect, fill_rows, free, handle, handle_mut, optional, out_handle, owned,
    read_versioned, rows, set_handle, text, threads, versioned,
};
use crate::mesh::{MotetMesh, field};
use crate::motion::extent;
use crate::watch::{MotetWatch, Watched};

/// A moving mesh, the threads that it uses, and who watches its calls.
pub(crate) struct MotetMoving {
    moving: MovingMesh,
    threads: Threads,
    watched: Watched,
}

impl MotetMoving {
    /// Makes a call that is watched.
    fn call<T: Send>(
        &mut self,
        work: impl FnOnce(&mut MovingMesh, &Threads) -> Result<T> + Send,
    ) -> Result<T> {
        let Self { moving, threads, watched } = self;
        watched.call(threads, |threads| work(moving, threads))
    }
}

versioned! {
    /// See the header.
    MotetMovingOptions, motet_moving_options_init {
        method: i32 = 0,
        within_walls: i32 = 0,
        smooth: i32 = 0,
        rigid_layer_cells: i32 = 0,
        rigid_layer: f64 = 0.0,
        inside: *const *const c_char = ptr::null(),
        n_inside: i64 = 0,
        slide: *const *const c_char = ptr::null(),
        n_slide: i64 = 0,
        bodies: *const *const c_char = ptr::null(),
        n_bodies: i64 = 0,
        wall: *const *const c_char = ptr::null(),
        n_wall: i64 = 0,
        no_repair: i32 = 0,
        surface: i32 = 0,
        distance: f64 = 0.0,
        min_eas: f64 = 0.2,
        margin: f64 = 0.05,
        floor: f64 = 0.05,
        improve_below: f64 = 0.75,
        contents: *const *const c_char = ptr::null(),
        n_contents: i64 = 0,
        watch: *const *const c_char = ptr::null(),
        n_watch: i64 = 0,
        warn: f64 = 0.0,
        within: f64 = 0.0,
        horizon: f64 = 0.0,
        hold: f64 = 0.0,
        remembered: i32 = 64,
        threads: i32 = 0,
        hold_names: *const *const c_char = ptr::null(),
        n_hold_names: i64 = 0,
        slide_tolerance: f64 = SlideTolerance::DEFAULT.0,
        valid_at_start: i32 = 0,
        strain_in_band: i32 = 0,
        returns: i32 = 0,
        watched_by: *mut MotetWatch = ptr::null_mut(),
    }
}

impl MotetMovingOptions {
    fn options(&self, mesh: &Mesh) -> Result<Options> {
        let (surface, distance) = constants::surface_rule(self.surface, self.distance)?;
        let repair = RepairWords {
            off: self.no_repair != 0,
            min_eas: self.min_eas,
            surface,
            distance,
            hold: owned(self.hold_names, self.n_hold_names, "hold_names")?,
            margin: self.margin,
            floor: self.floor,
            improve_below: self.improve_below,
            valid_at_start: self.valid_at_start != 0,
        };
        let watch = WatchWords {
            patches: owned(self.watch, self.n_watch, "watch")?,
            horizon: optional(self.horizon),
            hold: optional(self.hold),
        };
        let gaps =
            GapWords { warn: optional(self.warn), within: optional(self.within), ..GapWords::default() };
        Ok(Options {
            motion: self.motion()?,
            returns: self.returns != 0,
            contents: owned(self.contents, self.n_contents, "contents")?,
            watch: watch.watching(&gaps, mesh)?,
            remembered: count(self.remembered.into(), "changes to be remembered")?,
            ..repair.options(mesh)?
        })
    }

    fn motion(&self) -> Result<Motion> {
        let natural = |n: i32, what: &str| count(n.into(), what);
        let cells = natural(self.rigid_layer_cells, "cells of the rigid layer")?;
        Ok(Motion {
            method: constants::method(self.method)?,
            bodies: owned(self.bodies, self.n_bodies, "bodies")?,
            strain: (self.strain_in_band != 0).then_some(Strain::Band),
            smooth: natural(self.smooth, "sweeps")?,
            rigid_layer: extent(self.rigid_layer, cells)?,
            rigid_layer_at: owned(self.wall, self.n_wall, "wall")?,
            within_walls: self.within_walls != 0,
            slide: owned(self.slide, self.n_slide, "slide")?,
            slide_tolerance: self.slide_tolerance,
            inside: owned(self.inside, self.n_inside, "inside")?,
            ..Motion::default()
        })
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_new(
    mesh: *const MotetMesh,
    options: *const MotetMovingOptions,
    moving: *mut *mut MotetMoving,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(moving, "moving")?;
        let mesh = &handle(mesh, "mesh")?.0;
        mesh.validate()?;
        let given = read_versioned(options)?;
        let (mut threads, watched) = (threads(given.threads)?, Watched::by(given.watched_by));
        let options = given.options(mesh)?;
        let moving = watched.call(&mut threads, |threads| MovingMesh::new(mesh, options, threads))?;
        set_handle(place, MotetMoving { moving, threads, watched });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_load(
    path: *const c_char,
    options: *const MotetMovingOptions,
    moving: *mut *mut MotetMoving,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(moving, "moving")?;
        let path = text(path, "path")?;
        let given = read_versioned(options)?;
        let (mut threads, watched) = (threads(given.threads)?, Watched::by(given.watched_by));
        let options = given.options(&io::read(path)?)?;
        let moving = watched.call(&mut threads, |threads| MovingMesh::load(path, options, threads))?;
        set_handle(place, MotetMoving { moving, threads, watched });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_save(
    moving: *const MotetMoving,
    path: *const c_char,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || handle(moving, "moving")?.moving.save(text(path, "path")?))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_free(moving: *mut MotetMoving) {
    free(moving);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_n_driven(moving: *const MotetMoving) -> i64 {
    or_default(0, || Some(handle(moving, "moving").ok()?.moving.driven_places().len() as i64))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_time(moving: *const MotetMoving) -> f64 {
    or_default(f64::NAN, || Some(handle(moving, "moving").ok()?.moving.time()))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_step(moving: *const MotetMoving) -> i64 {
    or_default(0, || Some(handle(moving, "moving").ok()?.moving.step() as i64))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_mesh(moving: *const MotetMoving) -> *const MotetMesh {
    handle(moving, "moving").map_or(ptr::null(), |handle| MotetMesh::of(handle.moving.mesh()))
}

/// Copies rows of three numbers to the caller's array, which must have as many.
fn put_rows(all: &[Point], out: *mut f64, n: i64, stride: i64, what: &str) -> Result<()> {
    expect(n, all.len(), what)?;
    fill_rows(out, n, stride, what, |out| {
        out.copy_from_slice(all);
        Ok(())
    })
}

/// Defines functions that return a row of three numbers for each vertex or driven vertex.
macro_rules! rows_out {
    ($($name:ident, $what:literal, $of:expr;)*) => {
        $(#[unsafe(no_mangle)]
        pub(crate) unsafe extern "C" fn $name(
            moving: *const MotetMoving,
            out: *mut f64,
            n: i64,
            stride: i64,
            error: *mut *mut MotetError,
        ) -> i32 {
            let of: fn(&MovingMesh) -> Vec<Point> = $of;
            guarded(error, || put_rows(&of(&handle(moving, "moving")?.moving), out, n, stride, $what))
        })*
    };
}

rows_out! {
    motet_moving_driven_places, "places", |moving| moving.driven_places().to_vec();
    motet_moving_velocity, "velocities", MovingMesh::velocity;
    motet_moving_displacement, "displacements", MovingMesh::displacement;
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_set_array(
    moving: *mut MotetMoving,
    on: i32,
    name: *const c_char,
    values: *const f64,
    n: i64,
    components: i32,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetMoving { moving, .. } = handle_mut(moving, "moving")?;
        let field = field(text(name, "name")?, values, n, components)?;
        match constants::on(on)? {
            On::Points => moving.set_point_field(field),
            On::Cells => moving.set_cell_field(field),
        }
    })
}

versioned! {
    /// See the header.
    MotetStep, motet_step_init {
        step: i64 = 0,
        time: f64 = 0.0,
        complete: i32 = 0,
        legs: i32 = 0,
        fraction: f64 = 0.0,
        changes: i64 = 0,
        points: i64 = 0,
        tets: i64 = 0,
        bad: i64 = 0,
        forced: i64 = 0,
        inverted: i64 = 0,
        worst_cell: i64 = -1,
        worst_eas: f64 = f64::NAN,
        worst_place: [f64; 3] = [f64::NAN; 3],
        gap: f64 = f64::INFINITY,
        warned: i64 = 0,
        held: i64 = 0,
        touch_not_before: f64 = f64::INFINITY,
        seconds: f64 = 0.0,
    }
}

impl MotetStep {
    fn of(step: &Step) -> Self {
        let gaps = step.gaps.as_ref();
        Self {
            size: size_of::<Self>(),
            step: step.step as i64,
            time: step.time,
            complete: step.complete.into(),
            legs: step.legs as i32,
            fraction: step.fraction,
            changes: step.changes.len() as i64,
            points: step.points as i64,
            tets: step.tets as i64,
            bad: step.bad as i64,
            forced: step.forced as i64,
            inverted: step.inverted as i64,
            worst_cell: step.worst.map_or(-1, |worst| worst.cell.0.into()),
            worst_eas: step.worst.map_or(f64::NAN, |worst| worst.eas),
            worst_place: step.worst.map_or([f64::NAN; 3], |worst| worst.place),
            gap: gaps.and_then(|gaps| gaps.least).unwrap_or(f64::INFINITY),
            warned: gaps.map_or(0, |gaps| gaps.warned as i64),
            held: gaps.map_or(0, |gaps| gaps.held as i64),
            touch_not_before: gaps.and_then(|gaps| gaps.touch_not_before).unwrap_or(f64::INFINITY),
            seconds: step.seconds.total,
        }
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_advance(
    moving: *mut MotetMoving,
    time: f64,
    displacement: *const f64,
    n_driven: i64,
    stride: i64,
    step: *mut MotetStep,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let moving = handle_mut(moving, "moving")?;
        expect(n_driven, moving.moving.driven_places().len(), "displacements")?;
        let size = read_versioned(step.cast_const())?.size;
        let displacement = rows(displacement, n_driven, stride, "displacement")?;
        let reached = moving.call(|moving, threads| moving.advance(time, &displacement, threads))?;
        copy_out(&MotetStep::of(&reached), step, size);
        Ok(())
    })
}

/// Stores the number of changes of a call, unless `changes` is NULL.
fn store_count(n_changes: usize, changes: *mut i64) {
    // SAFETY: the header requires NULL or a place for a number.
    if let Some(place) = unsafe { changes.as_mut() } {
        *place = n_changes as i64;
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_repair(
    moving: *mut MotetMoving,
    changes: *mut i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let repaired = handle_mut(moving, "moving")?.call(MovingMesh::repair)?;
        store_count(repaired.into_iter().count(), changes);
        Ok(())
    })
}

fn refined(
    moving: *mut MotetMoving,
    wanted: impl FnOnce(&Threads) -> Result<Wanted> + Send,
    changes: *mut i64,
) -> Result<()> {
    let moving = handle_mut(moving, "moving")?;
    store_count(moving.call(|moving, threads| moving.refine(&wanted(threads)?, threads))?.len(), changes);
    Ok(())
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_refine_near(
    moving: *mut MotetMoving,
    surface: *const MotetMesh,
    at: f64,
    growth: f64,
    coarsen: i32,
    changes: *mut i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let surface = &handle(surface, "surface")?.0;
        let wanted = |threads: &Threads| {
            let target = Target::of_mesh(surface, threads)?.into();
            let words = RefineWords { coarsen: coarsen != 0, ..RefineWords::default() };
            words.wanted(vec![Criterion::NearSize { target, size: at, growth }])
        };
        refined(moving, wanted, changes)
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_refine_gaps(
    moving: *mut MotetMoving,
    smallest: f64,
    coarsen: i32,
    changes: *mut i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        if !(smallest > 0.0 && smallest.is_finite()) {
            return Err(Error::options(format!("the smallest edge length must be positive; got {smallest}"))
                .remedy("gaps can become arbitrarily narrow: give the length at which division stops"));
        }
        let words = RefineWords { smallest: Some(smallest), coarsen: coarsen != 0, ..RefineWords::default() };
        refined(moving, |_| words.wanted(vec![Criterion::Size(Size::Array(GAP.to_owned()))]), changes)
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_remembers(moving: *const MotetMoving, step: i64) -> i32 {
    or_default(0, || {
        let moving = &handle(moving, "moving").ok()?.moving;
        Some(moving.remembers(usize::try_from(step).ok()?).into())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_moving_since(
    moving: *const MotetMoving,
    step: i64,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(outcome, "outcome")?;
        let moving = &handle(moving, "moving")?.moving;
        let step = count(step, "steps")?;
        if let Some(history) = moving.history_since(step)? {
            let report = json!({ "since": step, "step": moving.step() });
            set_handle(place, MotetOutcome::new(moving.mesh().clone(), Some(history), &report, None)?);
        }
        Ok(())
    })
}
