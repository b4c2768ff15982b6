//! Refines the host towards the devices: its walls, which cannot be carved, or all of it.

use std::sync::Arc;

use super::devices::Devices;
use super::options::{Adapt, Options};
use super::report::Adapted;
use crate::base::{Point, Result, TetId, Threads};
use crate::geometry::tet::FACETS;
use crate::geometry::triangle::centroid;
use crate::geometry::vector::distance;
use crate::mesh::history::{History, Rules};
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::mesh::{Mesh, TetMesh, TetPart};
use crate::refine::wish::{check_expected, marked};
use crate::refine::{Criterion, MeshRefinement, Target, wishes_of_all};
use crate::spatial::NearestTriangle;

/// Edges within this factor of the requested size are short enough: the next division would halve them.
const WITHIN: f64 = 1.5;

/// How much longer edges of walls may be per unit of distance from a device. A tet on an even facet is good
/// with its apex at 0.4 of the edge length or more.
const WALL_GROWTH: f64 = 2.0;

/// Divides tets of the host until their edges beside the devices are as short as `size`; `None` if nothing
/// has to be divided.
///
/// # Errors
/// When the host has no tets, or would have too many.
pub(super) fn adapt(
    host: &Mesh,
    devices: &Devices,
    size: f64,
    options: &Options,
    rules: &Rules,
    threads: &Threads,
) -> Result<Option<(Mesh, History, Adapted)>> {
    let target = Arc::new(Target::new(devices.points.clone(), devices.triangles.clone(), threads)?);
    let criterion =
        Criterion::NearSize { target: target.clone(), size: WITHIN * size, growth: options.growth };
    let marks = |mesh: &Mesh, part: &TetPart| match options.adapt {
        Adapt::No => Ok(Vec::new()),
        Adapt::Walls => Ok(at_walls(&part.mesh, target.tree(), size)),
        Adapt::All => {
            let wishes = wishes_of_all(std::slice::from_ref(&criterion), mesh, part, threads)?;
            check_expected(&wishes)?;
            Ok(marked(&wishes))
        }
    };
    let part = TetPart::of(host)?;
    let mut adapted =
        Adapted { size, generations: 0, tets_before: part.mesh.tets.len(), tets_after: part.mesh.tets.len() };
    let mut marked = marks(host, &part)?;
    if marked.is_empty() {
        return Ok(None);
    }
    let mut refinement = MeshRefinement::new(host, crate::refine::Options::default(), threads)?;
    let mut history = History::identity(host.points.len(), host.cells.len());
    while !marked.is_empty() {
        let changed = refinement.refine(&marked, rules, threads)?;
        history = history.then(&changed.history);
        adapted.generations += 1;
        if changed.report.n_held == marked.len() {
            break;
        }
        marked = marks(refinement.mesh(), &refinement.part())?;
    }
    adapted.tets_after = refinement.refinement().mesh().tets.len();
    Ok(Some((refinement.mesh().clone(), history, adapted)))
}

/// The tets at walls whose facets there are too large for their distance from a device, in ascending order.
fn at_walls(host: &TetMesh, nearest: &NearestTriangle, size: f64) -> Vec<TetId> {
    let mut marks = Vec::new();
    for_each_tet_facet(&host.tets, &host.triangles, |sharing| {
        if sharing.is_wall(&host.regions) {
            let (t, i) = sharing.tets[0];
            let corners = FACETS[i].map(|k| host.points[host.tets[t.index()][k].index()]);
            if is_too_large(corners, nearest, size) {
                marks.extend(sharing.tets.iter().map(|(tet, _)| *tet));
            }
        }
    });
    marks.sort_unstable();
    marks.dedup();
    marks
}

fn is_too_large([a, b, c]: [Point; 3], nearest: &NearestTriangle, size: f64) -> bool {
    let centre = centroid([a, b, c]);
    let longest = [[a, b], [b, c], [c, a]].map(|[p, q]| distance(p, q)).into_iter().fold(0.0, f64::max);
    let radius = [a, b, c].map(|p| distance(p, centre)).into_iter().fold(0.0, f64::max);
    // If all devices are farther away than this, the facet may stay as it is.
    let enough = (longest / WITHIN - size) / WALL_GROWTH;
    enough > 0.0 && nearest.closest_within(centre, radius + enough).is_some()
}
