//! The surface of every body that gets layers, as seen from inside: each body has vertices of its own.
//!
//! Where a surface separates two bodies, the layers of one do not move the other. So the skin of a body
//! shares no vertex with that of another, and what grows on it depends on one side only.

use std::collections::BTreeMap;

use super::flats::{Flats, is_on_cap, unit};
use super::neighbors::{NONE, neighbors};
use super::options::{Layers, Stack};
use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::geometry::triangle::area_vector;
use crate::meshing::surfaces::Surfaces;
use crate::preflight::Role;

/// The bodies in front of a triangle and behind it.
pub(super) type Sides = [Option<u32>; 2];

/// The triangles around bodies that get layers.
#[derive(Debug, Default)]
pub(super) struct Skin {
    pub(super) points: Vec<Point>,
    /// For each vertex, the vertex of the surfaces.
    pub(super) to_vertex: Vec<VertexId>,
    /// Oriented out of their body.
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// For each triangle, the triangle of the surfaces.
    pub(super) to_triangle: Vec<u32>,
    /// For each triangle, whether the triangle of the surfaces has the opposite orientation.
    pub(super) is_turned: Vec<bool>,
    /// The body behind each triangle.
    pub(super) bodies: Vec<u32>,
    /// For each triangle, the index in `stacks` of what grows on it; [`NONE`] where nothing does.
    pub(super) stack_of: Vec<u32>,
    pub(super) stacks: Vec<Stack>,
    /// The unit normal of each triangle, out of the body.
    pub(super) normals: Vec<Point>,
    /// The triangles around each vertex.
    pub(super) stars: Csr<u32>,
    /// For each edge of each triangle, the triangle beyond it.
    pub(super) behind: Vec<[u32; 3]>,
    /// Flat parts among the triangles on which nothing grows and which have no body on the other side: edges
    /// of layers may slide there.
    pub(super) flats: Flats,
    /// Whether a column rises out of the plane of a cap where it hardly could in it.
    pub(super) may_slant: bool,
    /// For each vertex of the surfaces, its vertices in the skin, with their bodies.
    of_vertex: Csr<(u32, VertexId)>,
    /// For each triangle of the surfaces, its triangles in the skin.
    pub(super) of_triangle: Csr<u32>,
}

impl Skin {
    /// Builds the skin.
    ///
    /// # Errors
    /// When layers are requested on a membrane, or on a patch without triangles.
    pub(super) fn new(surfaces: &Surfaces, layers: &Layers, sides: &[Sides]) -> Result<Self> {
        let stacks: Vec<Stack> = layers.everywhere.iter().chain(layers.by_patch.values()).copied().collect();
        let chosen = stacks_of_triangles(surfaces, layers, sides)?;
        Ok(Self::of(surfaces, stacks, &chosen, sides))
    }

    /// Builds the skin around closed surfaces, on which one stack grows outward where `on` holds. The other
    /// triangles form ends.
    pub(super) fn outside(surfaces: &Surfaces, stack: Stack, on: &[bool]) -> Self {
        let chosen: Vec<_> = on.iter().map(|&on| on.then_some((0, 0))).collect();
        let mut skin = Self::of(surfaces, vec![stack], &chosen, &vec![[Some(0), None]; on.len()]);
        skin.may_slant = true;
        skin.flats = Flats::ends(&skin.points, &skin.triangles, &skin.behind, |t| skin.stack_of[t] == NONE);
        skin
    }

    /// Builds the skin inside closed surfaces, on which one stack grows inward where `on` holds.
    pub(super) fn inside(surfaces: &Surfaces, stack: Stack, on: &[bool]) -> Self {
        let chosen: Vec<_> = on.iter().map(|&on| on.then_some((0, 1))).collect();
        Self::of(surfaces, vec![stack], &chosen, &vec![[None, Some(0)]; on.len()])
    }

    /// Builds the skin of the bodies in which something grows: `chosen` has the stack on each triangle and
    /// the side on which it grows.
    fn of(surfaces: &Surfaces, stacks: Vec<Stack>, chosen: &[Option<(u32, usize)>], sides: &[Sides]) -> Self {
        let mut grows_in = vec![false; sides.iter().flatten().flatten().max().map_or(0, |&b| b as usize + 1)];
        for (t, side) in chosen.iter().enumerate().filter_map(|(t, c)| c.map(|(_, side)| (t, side))) {
            sides[t][side].into_iter().for_each(|body| grows_in[body as usize] = true);
        }
        let mut skin = Self { stacks, ..Self::default() };
        let mut corners = Vec::new();
        for (t, &[a, b, c]) in surfaces.triangles.iter().enumerate() {
            for (side, body) in sides[t].into_iter().enumerate() {
                let Some(body) = body.filter(|&body| grows_in[body as usize]) else { continue };
                // Behind a triangle it faces out of the body, in front of it into the body.
                corners.push(if side == 1 { [a, b, c] } else { [a, c, b] });
                skin.is_turned.push(side == 0);
                skin.bodies.push(body);
                skin.to_triangle.push(t as u32);
                skin.stack_of.push(match chosen[t] {
                    Some((stack, grows_on)) if grows_on == side => stack,
                    _ => NONE,
                });
            }
        }
        skin.number(surfaces, &corners);
        skin.relate(sides);
        skin
    }

    /// Numbers the corners separately for each body.
    fn number(&mut self, surfaces: &Surfaces, corners: &[[VertexId; 3]]) {
        let with_body = |(corners, &body): (&[VertexId; 3], &u32)| corners.map(|v| (v, body));
        let mut all: Vec<(VertexId, u32)> = corners.iter().zip(&self.bodies).flat_map(with_body).collect();
        all.sort_unstable();
        all.dedup();
        self.of_vertex = Csr::from_pairs(surfaces.points.len(), || {
            all.iter().enumerate().map(|(w, &(v, body))| (v.index(), (body, VertexId::new(w))))
        });
        self.to_vertex = all.iter().map(|&(v, _)| v).collect();
        self.points = self.to_vertex.iter().map(|v| surfaces.points[v.index()]).collect();
        let of =
            |(corners, &body): (&[VertexId; 3], &u32)| corners.map(|v| self.vertex(v, body).unwrap_or(v));
        self.triangles = corners.iter().zip(&self.bodies).map(of).collect();
        self.of_triangle = Csr::from_pairs(surfaces.triangles.len(), || {
            self.to_triangle.iter().zip(0..).map(|(&t, s)| (t as usize, s))
        });
    }

    /// The vertex of a body's skin for a vertex of the surfaces.
    pub(super) fn vertex(&self, vertex: VertexId, body: u32) -> Option<VertexId> {
        self.of_vertex.list(vertex.index()).iter().find(|(of, _)| *of == body).map(|&(_, w)| w)
    }

    fn relate(&mut self, sides: &[Sides]) {
        let area = |t: &[VertexId; 3]| area_vector(t.map(|v| self.points[v.index()]));
        self.normals = self.triangles.iter().map(|t| unit(area(t))).collect();
        self.stars = Csr::from_pairs(self.points.len(), || {
            (0u32..).zip(&self.triangles).flat_map(|(t, corners)| corners.map(|v| (v.index(), t)))
        });
        self.behind = neighbors(&self.triangles);
        let is_free = |s: usize| {
            self.stack_of[s] == NONE && sides[self.to_triangle[s] as usize].iter().any(Option::is_none)
        };
        self.flats = Flats::find(&self.points, &self.triangles, &self.behind, is_free);
    }

    pub(super) fn has_stack(&self, triangle: u32) -> bool {
        self.stack_of[triangle as usize] != NONE
    }

    /// The triangles around a vertex on which layers grow.
    pub(super) fn walls(&self, vertex: VertexId) -> impl Iterator<Item = u32> + Clone + '_ {
        self.stars.list(vertex.index()).iter().copied().filter(|&t| self.has_stack(t))
    }

    /// Whether the triangles around a vertex form a single fan, so that there is only one inward side.
    pub(super) fn is_one_fan(&self, vertex: VertexId) -> bool {
        let star = self.stars.list(vertex.index());
        let Some(&first) = star.first() else { return false };
        let (mut t, mut n) = (first, 0);
        loop {
            n += 1;
            let corners = self.triangles[t as usize];
            let Some(k) = corners.iter().position(|&v| v == vertex) else { return false };
            t = self.behind[t as usize][k];
            if t == first || t == NONE || n > star.len() {
                return t == first && n == star.len();
            }
        }
    }
}

/// For each triangle of the surfaces, the stack on it and the side on which it grows.
fn stacks_of_triangles(
    surfaces: &Surfaces,
    layers: &Layers,
    sides: &[Sides],
) -> Result<Vec<Option<(u32, usize)>>> {
    let places: BTreeMap<i32, u32> =
        layers.by_patch.keys().copied().zip(u32::from(layers.everywhere.is_some())..).collect();
    let is_cap = match layers.everywhere {
        Some(_) => is_on_cap(&surfaces.points, &surfaces.triangles),
        None => Vec::new(),
    };
    let mut chosen = vec![None; surfaces.triangles.len()];
    let mut is_met = vec![false; layers.by_patch.len()];
    for (t, patch) in surfaces.patches.iter().enumerate() {
        let [front, behind] = sides[t];
        let is_membrane = surfaces.roles[surfaces.surface_of[t] as usize] == Role::Membrane
            || front.is_some() && front == behind;
        let stack = match places.get(patch) {
            Some(_) if is_membrane => return Err(on_membrane(surfaces, *patch, t)),
            Some(&stack) => {
                is_met[stack as usize - usize::from(layers.everywhere.is_some())] = true;
                stack
            }
            None if layers.everywhere.is_none() || is_membrane || is_cap[t] => continue,
            None => 0,
        };
        // Between two bodies, layers grow on the side that the triangle faces away from.
        chosen[t] = match sides[t] {
            [None, None] => None,
            [Some(_), None] => Some((stack, 0)),
            [_, Some(_)] => Some((stack, 1)),
        };
    }
    if let Some((patch, _)) = layers.by_patch.keys().zip(is_met).find(|(_, met)| !met) {
        return Err(Error::options(format!("layers are requested on patch {patch}, which has no triangles")));
    }
    Ok(chosen)
}

fn on_membrane(surfaces: &Surfaces, patch: i32, triangle: usize) -> Error {
    let name = surfaces.patch_names.get(&patch).cloned().unwrap_or_else(|| patch.to_string());
    Error::options(format!("layers are requested on `{name}`, which is a membrane"))
        .at(format!("triangle {triangle}"))
        .remedy("layers grow only on walls: omit the membrane")
}
