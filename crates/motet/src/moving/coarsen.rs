//! Divisions undone by edge lengths, where the record of what was divided is lost.

use std::sync::Arc;

use crate::base::{Error, Result, Threads, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::distance;
use crate::mesh::{TetMesh, TetPart};
use crate::moving::current::{Derived, present_rules};
use crate::moving::moving_mesh::MovingMesh;
use crate::moving::step::Change;
use crate::moving::wall::NO_NODE;
use crate::refine::sizes::SizeLimits;
use crate::remesh::{self, Goal, SHORT, Sizes, SurfaceRule, remesh_part};

/// If a smaller fraction of the tets than this has an edge that is too short, nothing is done.
const ENOUGH: f64 = 0.05;
/// Requested sizes are this fraction of the allowed edge length, so that what is collapsed is not divided
/// again at once. A flap that beat to its wall and back once was left with 27,017 tets from 18,924; with a
/// fraction of 1 with 22,460, but then, as its gap became narrow, 51 % of the tets changed per step, against
/// 30 % with 0.7.
const SIZE: f64 = 0.7;

impl MovingMesh {
    /// Undoes by edge lengths what [`Self::refine`] cannot: where repairs have changed divided tets, the
    /// record of what was divided is lost. Edges are collapsed that are shorter than about a third both of
    /// their first length at this place and of the gap beside them, on walls only within flat parts; nodes of
    /// the first mesh stay. `smallest` is the least size that a gap can require.
    ///
    /// Nothing is done if less than a twentieth of the tets have such an edge. If nothing is watched, gaps
    /// impose no size.
    ///
    /// # Errors
    /// If `smallest` is not a length, if an array cannot be carried, and if the watch stops the call. Then
    /// everything is as before the call.
    pub fn coarsen(&mut self, smallest: f64, threads: &Threads) -> Result<Option<Change>> {
        if smallest.is_nan() || smallest < 0.0 {
            return Err(Error::options(format!("the smallest length must be 0 or more; got {smallest}"))
                .remedy("give a length of 0 or more"));
        }
        let gaps = self.gaps_here(threads)?;
        let Self { now, options, wall, .. } = &*self;
        let mut part = TetPart::of(&now.mesh)?;
        let all: Vec<VertexId> = (0..now.mesh.points.len()).map(VertexId::new).collect();
        let mut sizes = self.sizes.first.at_vertices(now, &now.mesh.points, &all, wall, options, threads);
        if let Some(gaps) = gaps {
            sizes.iter_mut().zip(gaps).for_each(|(size, gap)| *size = size.min(gap.max(smallest)));
        }
        SizeLimits { smallest: f64::MIN_POSITIVE, ..SizeLimits::default() }.apply(&part.mesh, &mut sizes);
        sizes.iter_mut().for_each(|size| *size *= SIZE);
        if (n_short(&part.mesh, &sizes) as f64) < ENOUGH * part.mesh.tets.len() as f64 {
            return Ok(None);
        }
        let shape = now.tets.shape(&now.mesh.points, options.limit(), threads);
        let nodes = (0..).zip(&now.records.node).filter(|(_, node)| **node != NO_NODE);
        part.mesh.fixed_vertices.extend(nodes.map(|(v, _)| VertexId(v)));
        part.mesh.fixed_vertices.sort_unstable();
        part.mesh.fixed_vertices.dedup();
        let repair = options.repair.clone().unwrap_or_default();
        let remesh_options = remesh::Options {
            goal: Goal::Coarsen,
            sizes: Some(Sizes::Vertices(sizes)),
            surface: SurfaceRule::Flat { distance: None },
            min_eas: (repair.min_eas + options.margin).min(1.0),
            // Tets that are bad only because a wall was divided are repaired here, where that division may be
            // undone.
            only: Some(shape.bad.iter().map(|(cell, _)| *cell).collect()),
            ..repair
        };
        let given = now.mesh.clone();
        let rules = present_rules(&options.rules, &given);
        let outcome = remesh_part(&given, &part, &remesh_options, &rules, threads)?;
        if outcome.report.kept == now.tets.len() && outcome.mesh.points == given.points {
            return Ok(None);
        }
        let derived = Derived {
            given: &given,
            mesh: outcome.mesh,
            history: Arc::new(outcome.history),
            before: now.records.before.clone(),
        };
        self.take_over(derived, &shape, outcome.report.operations, threads).map(Some)
    }
}

/// How many tets have an edge that is too short.
fn n_short(mesh: &TetMesh, sizes: &[f64]) -> usize {
    let is_short = |tet: &[VertexId; 4], [i, j]: [usize; 2]| {
        let [a, b] = [tet[i].index(), tet[j].index()];
        distance(mesh.points[a], mesh.points[b]) < SHORT * 0.5 * (sizes[a] + sizes[b])
    };
    mesh.tets.iter().filter(|tet| EDGES.into_iter().any(|edge| is_short(tet, edge))).count()
}
