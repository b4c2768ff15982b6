//! The criteria of a call, as criteria of the library: its surfaces are read here.

use std::path::Path;
use std::sync::Arc;

use motet::base::Threads;
use motet::refine::{Criterion, Target};
use motet::{Result, io};

use super::args::RefineArgs;
use super::parsers::{Near, NearSize};

/// All criteria of a call.
///
/// # Errors
/// When a file cannot be read, or is not a surface.
pub(crate) fn criteria(args: &RefineArgs, threads: &Threads) -> Result<Vec<Criterion>> {
    let mut all: Vec<Criterion> = args.all.then_some(Criterion::All).into_iter().collect();
    for Near { surface, within } in &args.near {
        all.push(Criterion::Near { target: target(surface, threads)?, within: *within });
    }
    for &NearSize { ref surface, size, growth } in &args.near_size {
        all.push(Criterion::NearSize { target: target(surface, threads)?, size, growth });
    }
    let lists = [
        &args.within_box,
        &args.ball,
        &args.region,
        &args.patch,
        &args.size,
        &args.gradient,
        &args.jump,
        &args.recovery,
        &args.vorticity,
        &args.q,
    ];
    all.extend(lists.into_iter().flatten().cloned());
    all.extend(args.conditions.iter().cloned().map(Criterion::Where));
    all.extend(args.hessian.iter().cloned().map(|mut sizes| {
        sizes.limits.smallest = args.smallest();
        Criterion::Hessian(sizes)
    }));
    Ok(all)
}

/// Reads a surface from which distances are measured.
///
/// # Errors
/// When it cannot be read, or is not a surface.
pub(crate) fn target(surface: &Path, threads: &Threads) -> Result<Arc<Target>> {
    let mesh = io::read(surface)?;
    Target::of_mesh(&mesh, threads).map(Arc::new).map_err(|e| e.in_file(surface))
}
