//! The core that the layers leave, as surfaces to be filled: walls replaced by the tops of their layers, caps
//! with their rims moved inward.

use super::columns::{Columns, Site};
use super::skin::{Sides, Skin};
use crate::base::{MaybeId, Point, VertexId};
use crate::geometry::vector::add;
use crate::meshing::surfaces::Surfaces;

/// Surfaces around the core of each body.
#[derive(Debug)]
pub(super) struct Core {
    pub(super) surfaces: Surfaces,
    /// For each triangle, the original triangle of the surfaces.
    pub(super) to_triangle: Vec<u32>,
    /// The bodies in front of each triangle and behind it, with their numbers without layers.
    pub(super) sides: Vec<Sides>,
    /// For each triangle, whether layers stand below it.
    pub(super) is_raised: Vec<bool>,
    /// For each triangle, whether all its corners are unmoved.
    pub(super) is_unmoved: Vec<bool>,
    is_two_sided: Vec<bool>,
    /// For each vertex of the surfaces, its vertex in the core, if it has one.
    pub(super) of_vertex: Vec<MaybeId<VertexId>>,
    /// For each vertex of the skin, the vertex of the core at the top of its column, if that is not its foot.
    pub(super) of_skin: Vec<MaybeId<VertexId>>,
}

impl Core {
    /// Builds the core; `motions` are the displacements of vertices without columns.
    pub(super) fn new(
        surfaces: &Surfaces,
        sides: &[Sides],
        skin: &Skin,
        columns: &Columns,
        motions: &[Point],
    ) -> Self {
        let empty = Surfaces {
            points: Vec::new(),
            triangles: Vec::new(),
            surface_of: Vec::new(),
            patches: Vec::new(),
            ..surfaces.clone()
        };
        let mut core = Self {
            surfaces: empty,
            to_triangle: Vec::new(),
            sides: Vec::new(),
            is_raised: Vec::new(),
            is_unmoved: Vec::new(),
            is_two_sided: sides.iter().map(|sides| sides.iter().all(Option::is_some)).collect(),
            of_vertex: vec![MaybeId::NONE; surfaces.points.len()],
            of_skin: vec![MaybeId::NONE; skin.points.len()],
        };
        let places: Vec<Point> = (0..skin.points.len())
            .map(|w| match columns.top(VertexId::new(w)) {
                Site { level: 0, .. } if skin.walls(VertexId::new(w)).next().is_none() => {
                    add(skin.points[w], motions[w])
                }
                top => columns.at(top),
            })
            .collect();
        for (t, &corners) in surfaces.triangles.iter().enumerate() {
            let [front, behind] = sides[t];
            let of =
                |body: Option<u32>| body.map(|body| corners.map(|v| moved_vertex(skin, &places, v, body)));
            let (in_front, from_behind) = (of(front), of(behind));
            // Skins share no vertex, so both sides see the same triangle only where it did not move.
            if in_front.is_some() && in_front == from_behind {
                core.add(surfaces, skin, &places, t, [front, behind], corners.map(|v| (v, None)));
                continue;
            }
            for (corner, one) in [(in_front, [front, None]), (from_behind, [None, behind])] {
                if let Some(moved) = corner {
                    let of = |k: usize| (corners[k], moved[k]);
                    core.add(surfaces, skin, &places, t, one, [0, 1, 2].map(of));
                }
            }
        }
        core
    }

    /// Adds a triangle; each corner is given by its vertex of the surfaces and, where it moved, that of the
    /// skin.
    fn add(
        &mut self,
        surfaces: &Surfaces,
        skin: &Skin,
        places: &[Point],
        t: usize,
        sides: Sides,
        corners: [(VertexId, Option<VertexId>); 3],
    ) {
        let points = &mut self.surfaces.points;
        let mut number = |of: &mut MaybeId<VertexId>, p: Point| {
            of.get_or_insert_with(|| {
                points.push(p);
                VertexId::new(points.len() - 1)
            })
        };
        let triangle = corners.map(|(v, moved)| match moved {
            Some(w) => number(&mut self.of_skin[w.index()], places[w.index()]),
            None => number(&mut self.of_vertex[v.index()], surfaces.points[v.index()]),
        });
        self.surfaces.triangles.push(triangle);
        self.surfaces.surface_of.push(surfaces.surface_of[t]);
        self.surfaces.patches.push(surfaces.patches[t]);
        self.to_triangle.push(t as u32);
        self.sides.push(sides);
        let is_unmoved = corners.iter().all(|(_, moved)| moved.is_none());
        self.is_unmoved.push(is_unmoved);
        let mut on_skin = skin_triangles(skin, t as u32, sides);
        self.is_raised.push(!is_unmoved && on_skin.any(|s| skin.has_stack(s)));
    }

    /// Whether a triangle of the surfaces has bodies on both sides.
    pub(super) fn is_two_sided(&self, triangle: u32) -> bool {
        self.is_two_sided[triangle as usize]
    }

    /// The triangles of the skin that a triangle of the core comes from.
    pub(super) fn skin_triangles<'a>(&self, skin: &'a Skin, triangle: u32) -> impl Iterator<Item = u32> + 'a {
        let i = triangle as usize;
        skin_triangles(skin, self.to_triangle[i], self.sides[i])
    }
}

fn skin_triangles(skin: &Skin, t: u32, sides: Sides) -> impl Iterator<Item = u32> + '_ {
    let is_seen = move |&s: &u32| sides.contains(&Some(skin.bodies[s as usize]));
    skin.of_triangle.list(t as usize).iter().copied().filter(is_seen)
}

/// The vertex of a body's skin for a vertex of the surfaces, if it moved.
fn moved_vertex(skin: &Skin, places: &[Point], vertex: VertexId, body: u32) -> Option<VertexId> {
    skin.vertex(vertex, body).filter(|w| places[w.index()] != skin.points[w.index()])
}
