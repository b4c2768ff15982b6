//! The patches that can be dragged, and the distances between those that stand apart.

use std::collections::BTreeMap;

use motet::base::{BodyId, Point, Threads, VertexId};
use motet::contact::{Body, Contact, Options, Room, sweep_apart};
use motet::geometry::vector::{add, dot, norm, scale, sub, unit};
use motet::mesh::{Surface, edge_lengths};
use motet::motion::FacetSet;
use motet::{Mesh, Result};
use serde::Serialize;

/// A patch that can be dragged.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Patch {
    pub(crate) name: String,
    pub(crate) id: i32,
    /// The vertices of the patch, as positions in the list of driven vertices.
    #[serde(skip)]
    pub(crate) nodes: Vec<usize>,
}

/// The patches of a mesh with driven vertices; `driven` is in rising order.
pub(crate) fn patches(mesh: &Mesh, driven: &[VertexId]) -> Vec<Patch> {
    let Some(labels) = mesh.patches() else { return Vec::new() };
    let patch = |id: i32| {
        let FacetSet { name, vertices, .. } = FacetSet::of_patch(mesh, id);
        let nodes = vertices.iter().filter_map(|v| driven.binary_search(v).ok());
        Patch { name, id, nodes: nodes.collect() }
    };
    labels.used().into_iter().map(patch).filter(|patch| !patch.nodes.is_empty()).collect()
}

/// The parts of a surface that stand apart: each patch that shares no vertex with another one, and all other
/// patches together.
pub(crate) struct SeparateParts {
    /// The bodies are the parts, in their order, then the other patches.
    contact: Contact,
    parts: Vec<Part>,
}

/// A patch that stands apart.
struct Part {
    patch: i32,
    triangles: Vec<[VertexId; 3]>,
    vertices: Vec<VertexId>,
    /// The triangles of everything else.
    others: Vec<[VertexId; 3]>,
    /// The distance that it keeps from everything else: a fraction of the length of its edges, so that tets
    /// between them can be good.
    clearance: f64,
    /// How far it can move in any direction and keep that distance.
    free_path: f64,
}

/// The fraction of its median edge length that a part keeps from others.
const CLEARANCE: f64 = 0.5;
/// How often a part changes direction within one displacement.
const MAX_SLIDES: usize = 4;
/// The fraction of a displacement below which the rest is not worth another change of direction.
const MIN_REST: f64 = 1e-3;

impl SeparateParts {
    /// The parts of a mesh; `None` if there are fewer than two.
    ///
    /// # Errors
    /// When distances cannot be measured on this mesh.
    pub(crate) fn of(mesh: &Mesh, threads: &Threads) -> Result<Option<Self>> {
        let surface = Surface::own_or_boundary_of(mesh);
        let mut by_patch = BTreeMap::<i32, Vec<[VertexId; 3]>>::new();
        for (triangle, id) in surface.triangles.iter().zip(&surface.patches) {
            by_patch.entry(*id).or_default().push(*triangle);
        }
        let mut n_patches_at = vec![0u32; mesh.points.len()];
        let vertices: BTreeMap<i32, _> = by_patch.iter().map(|(id, all)| (*id, vertices_of(all))).collect();
        vertices.values().flatten().for_each(|v| n_patches_at[v.index()] += 1);
        let is_separate = |id: &i32| vertices[id].iter().all(|v| n_patches_at[v.index()] == 1);
        let (separate, joined): (Vec<i32>, Vec<i32>) = by_patch.keys().partition(|id| is_separate(id));
        let all_but = |id: i32| by_patch.iter().filter(move |(other, _)| **other != id).flat_map(|(_, t)| t);
        let part = |&patch: &i32| {
            let triangles = by_patch[&patch].clone();
            let lengths = edge_lengths(&mesh.points, triangles.iter().copied());
            Part {
                patch,
                vertices: vertices[&patch].clone(),
                others: all_but(patch).copied().collect(),
                clearance: CLEARANCE * lengths.map_or(0.0, |[_, median, _]| median),
                free_path: 0.0,
                triangles,
            }
        };
        let mut parts: Vec<Part> = separate.iter().map(part).collect();
        let rest: Vec<_> = joined.iter().flat_map(|id| by_patch[id].iter().copied()).collect();
        let bodies =
            parts.iter().map(|part| part.triangles.clone()).chain(Some(rest).filter(|t| !t.is_empty()));
        let body = |triangles| Body { name: String::new(), triangles, room: Room::Found };
        let bodies: Vec<Body> = bodies.map(body).collect();
        if bodies.len() < 2 {
            return Ok(None);
        }
        let mut contact = Contact::new(mesh.points.clone(), bodies, Options::default(), threads)?;
        for (k, part) in parts.iter_mut().enumerate() {
            let distance = nearest(&mut contact, k, threads).map_or(0.0, |(distance, _)| distance);
            part.free_path = distance - part.clearance;
        }
        Ok(Some(Self { contact, parts }))
    }

    /// The gap at each point with the parts at `points`, and the least one.
    ///
    /// # Errors
    /// When a position is not finite.
    pub(crate) fn gaps(&mut self, points: &[Point], threads: &Threads) -> Result<(Vec<f64>, f64)> {
        self.contact.refit(points, threads)?;
        let gaps = self.contact.measure(threads);
        Ok((gaps.at_points(points.len()), gaps.least()))
    }

    /// How far a patch gets from `points`, the positions of the mesh, towards a displacement `by`: it stops
    /// before it comes nearer to another part than its clearance, and slides along it. Other patches go all
    /// the way.
    ///
    /// # Errors
    /// When a position is not finite.
    pub(crate) fn reached(
        &mut self,
        patch: i32,
        points: &[Point],
        by: Point,
        threads: &Threads,
    ) -> Result<Point> {
        let Some(k) = self.parts.iter().position(|part| part.patch == patch) else { return Ok(by) };
        let part = &self.parts[k];
        if norm(by) <= part.free_path {
            return Ok(by);
        }
        let (mut at, mut velocity) = (points.to_vec(), vec![[0.0; 3]; points.len()]);
        let clearance = vec![part.clearance; part.triangles.len()];
        let bodies = [&part.triangles[..], &part.others[..]];
        let (mut done, mut rest) = ([0.0; 3], by);
        for _ in 0..MAX_SLIDES {
            part.vertices.iter().for_each(|v| velocity[v.index()] = rest);
            let times = sweep_apart(&at, &velocity, bodies, &clearance, 1.0, threads);
            let fraction = times.into_iter().fold(1.0, f64::min);
            done = add(done, scale(rest, fraction));
            rest = scale(rest, 1.0 - fraction);
            if norm(rest) <= MIN_REST * norm(by) {
                break;
            }
            part.vertices.iter().for_each(|v| at[v.index()] = add(points[v.index()], done));
            self.contact.refit(&at, threads)?;
            let normal = nearest(&mut self.contact, k, threads).and_then(|(_, away)| unit(away));
            let Some(normal) = normal else { break };
            rest = sub(rest, scale(normal, dot(rest, normal).min(0.0)));
        }
        Ok(done)
    }
}

/// The distance of a part from the nearest other body, and the vector from there to the part.
fn nearest(contact: &mut Contact, part: usize, threads: &Threads) -> Option<(f64, Point)> {
    let nearest = contact.nearest(threads).into_iter().filter_map(|(bodies, nearest)| {
        let side = bodies.iter().position(|&body| body == BodyId::new(part))?;
        nearest.map(|nearest| (nearest.distance, sub(nearest.points[side], nearest.points[1 - side])))
    });
    nearest.min_by(|a, b| a.0.total_cmp(&b.0))
}

fn vertices_of(triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    let mut vertices = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
