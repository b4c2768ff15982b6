//! The patches that can be dragged, and the distances between those that stand apart.

use motet::base::{Point, Threads, VertexId};
use motet::contact::{Body, Contact, Options, Room, sweep_apart};
use motet::geometry::vector::{add, distance, dot, norm, scale, sub, unit};
use motet::mesh::Surface;
use motet::{Mesh, Result};
use serde::Serialize;

/// A patch that can be dragged.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Patch {
    pub(crate) name: String,
    pub(crate) id: i32,
    /// Its vertices, as indices of driven vertices.
    #[serde(skip)]
    pub(crate) nodes: Vec<usize>,
}

/// The patches of a mesh with driven vertices; `driven` is in rising order.
pub(crate) fn patches(mesh: &Mesh, driven: &[VertexId]) -> Vec<Patch> {
    let surface = Surface::own_or_boundary_of(mesh);
    let patch = |id: i32| {
        let vertices = vertices_of(&surface, |other| other == id);
        let nodes = vertices.iter().filter_map(|v| driven.binary_search(v).ok());
        let name = surface.patch_names.get(&id).cloned().unwrap_or_else(|| id.to_string());
        Patch { name, id, nodes: nodes.collect() }
    };
    ids(&surface).into_iter().map(patch).filter(|patch| !patch.nodes.is_empty()).collect()
}

/// The parts of a surface that stand apart: each patch that shares no vertex with another one, and all other
/// patches together.
pub(crate) struct Apart {
    contact: Contact,
    parts: Vec<Part>,
}

/// A patch that stands apart.
struct Part {
    patch: i32,
    triangles: Vec<[VertexId; 3]>,
    vertices: Vec<VertexId>,
    /// The triangles of all other parts.
    others: Vec<[VertexId; 3]>,
    /// How near it may come to them: a fraction of the length of its edges, so that tets between them can be
    /// good.
    clearance: f64,
    /// How far it may go in any direction without coming that near.
    free: f64,
}

/// The fraction of the median edge length that a part keeps to others.
const CLEARANCE: f64 = 0.5;
/// How often a part turns aside within one displacement.
const TURNS: usize = 4;
/// A displacement below this fraction of what was asked for is not worth another turn.
const LEAST: f64 = 1e-3;

impl Apart {
    /// The parts of a mesh; `None` if there are fewer than two.
    ///
    /// # Errors
    /// When distances cannot be measured on this mesh.
    pub(crate) fn of(mesh: &Mesh, threads: &Threads) -> Result<Option<Self>> {
        let surface = Surface::own_or_boundary_of(mesh);
        let ids = ids(&surface);
        let mut n_patches_at = vec![0u32; mesh.points.len()];
        for &id in &ids {
            vertices_of(&surface, |other| other == id).iter().for_each(|v| n_patches_at[v.index()] += 1);
        }
        let is_apart = |id: &i32| {
            vertices_of(&surface, |other| other == *id).iter().all(|v| n_patches_at[v.index()] == 1)
        };
        let apart: Vec<i32> = ids.iter().copied().filter(is_apart).collect();
        let body = |name: String, triangles| Body { name, triangles, room: Room::Found };
        let one = |&id: &i32| body(id.to_string(), triangles_of(&surface, |other| other == id));
        let mut bodies: Vec<Body> = apart.iter().map(one).collect();
        if apart.len() < ids.len() {
            bodies.push(body("others".to_owned(), triangles_of(&surface, |other| !apart.contains(&other))));
        }
        if bodies.len() < 2 {
            return Ok(None);
        }
        let part = |&patch: &i32| {
            let triangles = triangles_of(&surface, |other| other == patch);
            Part {
                patch,
                vertices: vertices_of(&surface, |other| other == patch),
                others: triangles_of(&surface, |other| other != patch),
                clearance: CLEARANCE * median_edge(&mesh.points, &triangles),
                free: 0.0,
                triangles,
            }
        };
        let mut parts: Vec<Part> = apart.iter().map(part).collect();
        let mut contact = Contact::new(mesh.points.clone(), bodies, Options::default(), threads)?;
        for part in &mut parts {
            let gap = nearest(&mut contact, part.patch, threads).map_or(0.0, |(gap, _)| gap);
            part.free = gap - part.clearance;
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
        let Some(part) = self.parts.iter().find(|part| part.patch == patch) else { return Ok(by) };
        if norm(by) <= part.free {
            return Ok(by);
        }
        let (mut at, mut velocity) = (points.to_vec(), vec![[0.0; 3]; points.len()]);
        let (mut done, mut left) = ([0.0; 3], by);
        for _ in 0..TURNS {
            part.vertices.iter().for_each(|v| velocity[v.index()] = left);
            let clearance = vec![part.clearance; part.triangles.len()];
            let bodies = [&part.triangles[..], &part.others[..]];
            let times = sweep_apart(&at, &velocity, bodies, &clearance, 1.0, threads);
            let way = times.into_iter().fold(1.0, f64::min);
            done = add(done, scale(left, way));
            left = scale(left, 1.0 - way);
            if way == 1.0 || norm(left) <= LEAST * norm(by) {
                break;
            }
            part.vertices.iter().for_each(|v| at[v.index()] = add(points[v.index()], done));
            self.contact.refit(&at, threads)?;
            let Some(away) = nearest(&mut self.contact, patch, threads).and_then(|(_, away)| unit(away))
            else {
                break;
            };
            left = sub(left, scale(away, dot(left, away).min(0.0)));
        }
        Ok(done)
    }
}

/// The distance of a patch from the nearest other body, and the vector from there to the patch.
fn nearest(contact: &mut Contact, patch: i32, threads: &Threads) -> Option<(f64, Point)> {
    let name = patch.to_string();
    let nearest = contact.nearest(threads).into_iter().filter_map(|(bodies, nearest)| {
        let side = bodies.iter().position(|&body| contact.name(body) == name)?;
        nearest.map(|nearest| (nearest.distance, sub(nearest.points[side], nearest.points[1 - side])))
    });
    nearest.min_by(|a, b| a.0.total_cmp(&b.0))
}

fn median_edge(points: &[Point], triangles: &[[VertexId; 3]]) -> f64 {
    let sides = |[a, b, c]: &[VertexId; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let length = |[a, b]: [VertexId; 2]| distance(points[a.index()], points[b.index()]);
    let mut lengths: Vec<f64> = triangles.iter().flat_map(sides).map(length).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(0.0)
}

fn ids(surface: &Surface) -> Vec<i32> {
    let mut ids = surface.patches.clone();
    ids.sort_unstable();
    ids.dedup();
    ids
}

fn triangles_of(surface: &Surface, is_in: impl Fn(i32) -> bool) -> Vec<[VertexId; 3]> {
    let triangles = surface.triangles.iter().zip(&surface.patches).filter(|(_, id)| is_in(**id));
    triangles.map(|(t, _)| *t).collect()
}

fn vertices_of(surface: &Surface, is_in: impl Fn(i32) -> bool) -> Vec<VertexId> {
    let mut vertices = triangles_of(surface, is_in).into_flattened();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
