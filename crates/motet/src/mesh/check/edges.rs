//! Edges and vertices where a surface is open, inconsistently oriented, or not a manifold.

use crate::base::{DisjointSets, MaybeId, VertexId, id};
use crate::mesh::Mesh;
use crate::mesh::check::SurfaceFacets;
use crate::mesh::check::defect::{Defect, DefectKind, Example};

/// One side of a facet: the edge, the direction in which the facet runs along it, and where its corners are
/// among all corners of all facets.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    edge: [VertexId; 2],
    facet: u32,
    forward: bool,
    /// Indices of the corners at `edge[0]` and `edge[1]`.
    corners: [u32; 2],
}

/// All sides of all facets, sorted by edge.
fn sorted_sides(facets: &SurfaceFacets) -> Vec<Side> {
    let mut sides = Vec::with_capacity(facets.rings.items().len());
    for (f, ring) in facets.rings.iter().enumerate() {
        let start = facets.rings.offsets()[f];
        for i in 0..ring.len() {
            let next = (i + 1) % ring.len();
            let (from, to) = (ring[i], ring[next]);
            let (i, next) = (start + i as u32, start + next as u32);
            let (edge, corners) = if from <= to { ([from, to], [i, next]) } else { ([to, from], [next, i]) };
            if from != to {
                sides.push(Side { edge, facet: f as u32, forward: from <= to, corners });
            }
        }
    }
    sides.sort_unstable();
    sides
}

/// Whether exactly two facets meet at every edge of these rings of corners, and there is at least one edge.
pub fn is_closed<'a>(rings: impl Iterator<Item = &'a [VertexId]>) -> bool {
    let mut edges: Vec<[VertexId; 2]> = Vec::new();
    for ring in rings {
        let following = ring.iter().cycle().skip(1);
        edges.extend(ring.iter().zip(following).map(|(&a, &b)| [a.min(b), a.max(b)]).filter(|[a, b]| a != b));
    }
    edges.sort_unstable();
    !edges.is_empty() && edges.chunk_by(|a, b| a == b).all(|same| same.len() == 2)
}

pub(super) fn defects(mesh: &Mesh, facets: &SurfaceFacets) -> Vec<Defect> {
    let mut open = Defect::empty(DefectKind::OpenEdge);
    let mut non_manifold = Defect::empty(DefectKind::NonManifoldEdge);
    let mut misoriented = Defect::empty(DefectKind::MisorientedEdge);
    // Corners at one vertex are connected if their facets share an edge there.
    let mut corners = DisjointSets::new(facets.rings.items().len());
    let sides = sorted_sides(facets);
    for same in sides.chunk_by(|x, y| x.edge == y.edge) {
        let example = || {
            let cells: Vec<_> = same.iter().map(|side| facets.cells[side.facet as usize]).collect();
            Example::new(&cells, &same[0].edge, &mesh.points)
        };
        match same {
            [_] => open.add(example),
            // Boundary facets are oriented by their cells, and inverted cells are reported already.
            [x, y] if x.forward == y.forward && !facets.of_volume => misoriented.add(example),
            [_, _] => {}
            _ => non_manifold.add(example),
        }
        for side in &same[1..] {
            corners.join(same[0].corners[0], side.corners[0]);
            corners.join(same[0].corners[1], side.corners[1]);
        }
    }
    vec![open, misoriented, non_manifold, pinched(mesh, facets, &mut corners)]
}

id!(
    /// A fan of facets around a vertex, by one of its corners.
    FanId
);

/// Vertices whose corners form more than one connected set.
fn pinched(mesh: &Mesh, facets: &SurfaceFacets, corners: &mut DisjointSets) -> Defect {
    let mut defect = Defect::empty(DefectKind::NonManifoldVertex);
    let mut fan_of = vec![MaybeId::NONE; mesh.points.len()];
    let mut reported = vec![false; mesh.points.len()];
    for (corner, &v) in facets.rings.items().iter().enumerate() {
        let fan = FanId(corners.root(corner as u32));
        if fan_of[v.index()].get_or_insert_with(|| fan) != fan
            && !std::mem::replace(&mut reported[v.index()], true)
        {
            defect.add(|| Example::new(&[], &[v], &mesh.points));
        }
    }
    defect
}
