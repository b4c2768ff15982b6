//! Motion: boundary displacements in, volume mesh out.

use std::ffi::c_char;
use std::ptr;

use motet::base::Threads;
use motet::motion::{
    Certificate, Extent, FacetSet, Motion, MotionParts, Mover, Options, PointMover, SlideTolerance,
};
use motet::{Error, Mesh, Result};

use crate::constants;
use crate::guard::{MotetError, guarded, or_default};
use crate::memory::{
    check_no_overlap, copy_out, count, expect, fill_rows, free, handle, handle_mut, id, optional, out_handle,
    read_versioned, rows, set_handle, texts, threads, values, values_mut, versioned, vertex,
};
use crate::mesh::MotetMesh;
use crate::watch::{MotetWatch, Watched};

/// A mover, the threads that it uses, and who watches its calls.
pub(crate) struct MotetMover {
    mover: Mover,
    threads: Threads,
    watched: Watched,
}

versioned! {
    /// See the header.
    MotetMoverOptions, motet_mover_options_init {
        method: i32 = 0,
        within_walls: i32 = 0,
        smooth: i32 = 0,
        substeps: i32 = 50,
        threads: i32 = 1,
        rigid_layer_cells: i32 = 0,
        rigid_layer: f64 = 0.0,
        residual: f64 = 1e-6,
        factor_gib: f64 = 0.0,
        slide: *const *const c_char = ptr::null(),
        n_slide: i64 = 0,
        bodies: *const *const c_char = ptr::null(),
        n_bodies: i64 = 0,
        wall: *const *const c_char = ptr::null(),
        n_wall: i64 = 0,
        also_moved: *const i32 = ptr::null(),
        n_also_moved: i64 = 0,
        slide_tolerance: f64 = SlideTolerance::DEFAULT.0,
        watched_by: *mut MotetWatch = ptr::null_mut(),
    }
}

impl MotetMoverOptions {
    fn options(&self, mesh: &Mesh) -> Result<Options> {
        let find = |names, n, what: &str| {
            texts(names, n, what)?
                .into_iter()
                .map(|name| FacetSet::find(mesh, name))
                .collect::<Result<Vec<_>>>()
        };
        let natural = |n: i32, what: &str| count(n.into(), what);
        let cells = natural(self.rigid_layer_cells, "cells of the rigid layer")?;
        let motion = Motion {
            method: constants::method(self.method)?,
            within_walls: self.within_walls != 0,
            smooth: natural(self.smooth, "sweeps")?,
            rigid_layer: extent(self.rigid_layer, cells)?,
            slide_tolerance: self.slide_tolerance,
            residual: self.residual,
            factor_gib: self.factor_gib,
            substeps: natural(self.substeps, "sub-steps")?,
            ..Motion::default()
        };
        let moved = values(self.also_moved, count(self.n_also_moved, "also_moved")?, "also_moved")?;
        let moved = moved.iter().map(|&v| vertex(v, mesh.points.len(), "also_moved"));
        motion.options_on(MotionParts {
            bodies: find(self.bodies, self.n_bodies, "bodies")?,
            wall: FacetSet::joined(find(self.wall, self.n_wall, "wall")?),
            sliding: find(self.slide, self.n_slide, "slide")?,
            also_moved: moved.collect::<Result<_>>()?,
        })
    }
}

/// The extent of the rigid layer, if there is one.
pub(crate) fn extent(distance: f64, cells: usize) -> Result<Option<Extent>> {
    match (optional(distance), cells > 0) {
        (Some(_), true) => Err(Error::options("a rigid layer is given both by a distance and by cells")
            .remedy("give one of them")),
        (Some(distance), false) => Ok(Some(Extent::Distance(distance))),
        (None, true) => Ok(Some(Extent::Cells(cells))),
        (None, false) => Ok(None),
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_new(
    mesh: *const MotetMesh,
    options: *const MotetMoverOptions,
    mover: *mut *mut MotetMover,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(mover, "mover")?;
        let mesh = &handle(mesh, "mesh")?.0;
        mesh.validate()?;
        let given = read_versioned(options)?;
        let (mut threads, watched) = (threads(given.threads)?, Watched::by(given.watched_by));
        let options = given.options(mesh)?;
        let mover = watched.call(&mut threads, |threads| Mover::new(mesh, &options, threads))?;
        set_handle(place, MotetMover { mover, threads, watched });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_free(mover: *mut MotetMover) {
    free(mover);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_n_points(mover: *const MotetMover) -> i64 {
    or_default(0, || Some(handle(mover, "mover").ok()?.mover.reference().len() as i64))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_n_boundary(mover: *const MotetMover) -> i64 {
    or_default(0, || Some(handle(mover, "mover").ok()?.mover.boundary().len() as i64))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_boundary(
    mover: *const MotetMover,
    vertices: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let boundary = handle(mover, "mover")?.mover.boundary();
        expect(n, boundary.len(), "vertices")?;
        let out = values_mut(vertices, boundary.len(), "vertices")?;
        out.iter_mut().zip(boundary).for_each(|(out, v)| *out = id(v.0));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_weights(
    mover: *const MotetMover,
    vertex: i32,
    vertices: *mut i32,
    weights: *mut f64,
    is_hanging: *mut i32,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mover = &handle(mover, "mover")?.mover;
        let vertex = self::vertex(vertex, mover.reference().len(), "vertex")?;
        let found = mover.weights(vertex);
        *handle_mut(is_hanging, "is_hanging")? = found.is_some().into();
        if let Some((of, with)) = found {
            values_mut(vertices, 4, "vertices")?.copy_from_slice(&of.map(|v| id(v.0)));
            values_mut(weights, 4, "weights")?.copy_from_slice(&with);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_step(
    mover: *const MotetMover,
    displacement: *const f64,
    n_boundary: i64,
    displacement_stride: i64,
    points: *mut f64,
    n_points: i64,
    points_stride: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetMover { mover, threads, .. } = handle(mover, "mover")?;
        expect(n_boundary, mover.boundary().len(), "displacements")?;
        expect(n_points, mover.reference().len(), "points")?;
        let displacement = rows(displacement, n_boundary, displacement_stride, "displacement")?;
        check_no_overlap(&displacement, points, n_points, points_stride)?;
        fill_rows(points, n_points, points_stride, "points", |out| mover.step(&displacement, out, threads))
    })
}

versioned! {
    /// See the header.
    MotetCertificate, motet_certificate_init {
        complete: i32 = 0,
        substeps: i32 = 0,
        fraction: f64 = 0.0,
        inverted: i64 = 0,
        inverted_before: i64 = 0,
        bad: i64 = 0,
        worst_cell: i64 = -1,
        worst_eas: f64 = f64::NAN,
        worst_place: [f64; 3] = [f64::NAN; 3],
        seconds: f64 = 0.0,
        worst_curved_cell: i64 = -1,
        worst_curved_jacobian: f64 = f64::NAN,
        leaves_plane_vertex: i64 = -1,
        leaves_plane_distance: f64 = 0.0,
    }
}

impl MotetCertificate {
    fn of(certificate: &Certificate) -> Self {
        let worst = certificate.quality.worst_eas;
        let curved = certificate.quality.worst_curved_jacobian;
        let leaves = certificate.leaves_plane.as_ref().filter(|leaves| leaves.is_significant);
        Self {
            size: size_of::<Self>(),
            complete: certificate.complete.into(),
            substeps: certificate.substeps as i32,
            fraction: certificate.fraction,
            inverted: certificate.inverted as i64,
            inverted_before: certificate.inverted_before as i64,
            bad: certificate.quality.bad as i64,
            worst_cell: worst.map_or(-1, |worst| worst.cell.0.into()),
            worst_eas: worst.map_or(f64::NAN, |worst| worst.value),
            worst_place: worst.map_or([f64::NAN; 3], |worst| worst.place),
            seconds: certificate.seconds.total,
            worst_curved_cell: curved.map_or(-1, |worst| worst.cell.0.into()),
            worst_curved_jacobian: curved.map_or(f64::NAN, |worst| worst.value),
            leaves_plane_vertex: leaves.map_or(-1, |leaves| leaves.vertex.0.into()),
            leaves_plane_distance: leaves.map_or(0.0, |leaves| leaves.distance),
        }
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mover_advance(
    mover: *mut MotetMover,
    displacement: *const f64,
    n_boundary: i64,
    displacement_stride: i64,
    points: *mut f64,
    n_points: i64,
    points_stride: i64,
    certificate: *mut MotetCertificate,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetMover { mover, threads, watched } = handle_mut(mover, "mover")?;
        expect(n_boundary, mover.boundary().len(), "displacements")?;
        expect(n_points, mover.reference().len(), "points")?;
        let displacement = rows(displacement, n_boundary, displacement_stride, "displacement")?;
        check_no_overlap(&displacement, points, n_points, points_stride)?;
        let reached = fill_rows(points, n_points, points_stride, "points", |out| {
            watched.call(threads, |threads| mover.advance(&displacement, out, threads))
        })?;
        if !certificate.is_null() {
            let size = read_versioned(certificate.cast_const())?.size;
            copy_out(&MotetCertificate::of(&reached), certificate, size);
        }
        Ok(())
    })
}

/// A point mover and the threads that it uses.
pub(crate) struct MotetPointMover {
    mover: PointMover,
    threads: Threads,
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_point_mover_new(
    nodes: *const f64,
    n_nodes: i64,
    node_stride: i64,
    points: *const f64,
    n_points: i64,
    point_stride: i64,
    n_threads: i32,
    mover: *mut *mut MotetPointMover,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(mover, "mover")?;
        let threads = threads(n_threads)?;
        let nodes = rows(nodes, n_nodes, node_stride, "nodes")?;
        let mover = PointMover::new(&nodes, &rows(points, n_points, point_stride, "points")?, &threads)?;
        set_handle(place, MotetPointMover { mover, threads });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_point_mover_free(mover: *mut MotetPointMover) {
    free(mover);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_point_mover_step(
    mover: *const MotetPointMover,
    displacement: *const f64,
    n_nodes: i64,
    displacement_stride: i64,
    points: *mut f64,
    n_points: i64,
    points_stride: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetPointMover { mover, threads } = handle(mover, "mover")?;
        expect(n_nodes, mover.n_nodes(), "displacements")?;
        expect(n_points, mover.reference().len(), "points")?;
        let displacement = rows(displacement, n_nodes, displacement_stride, "displacement")?;
        check_no_overlap(&displacement, points, n_points, points_stride)?;
        fill_rows(points, n_points, points_stride, "points", |out| mover.step(&displacement, out, threads))
    })
}
