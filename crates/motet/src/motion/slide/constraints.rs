//! How each vertex of sliding patches may move: in one plane, along the line where planes meet, or not at
//! all.
//!
//! A vertex whose boundary facets all slide is constrained by their planes. With one plane it has two degrees
//! of freedom, where two planes meet one, where three meet none. Vertices on any other facet are driven, and
//! so are those that the caller wants driven.

use std::collections::{BTreeMap, HashMap};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{cross, dot, norm, scale};
use crate::mesh::Boundary;
use crate::motion::options::FacetSet;
use crate::motion::slide::key;
use crate::motion::slide::plane::Plane;

/// Two planes are distinct where their angle is more than this many times the uncertainty of their normals.
/// The two halves of a shallow dish, which are one patch, differ by twice that uncertainty.
const UNCERTAINTY_FACTOR: f64 = 4.0;

/// Planes with an angle of 30 degrees or more are distinct whatever their uncertainty: its sine.
const MAX_UNCERTAINTY: f64 = 0.5;

/// The least uncertainty of normals: rounding.
const ROUNDING: f64 = 1e-9;

/// A plane in which one patch slides, or several patches side by side.
#[derive(Clone, Debug)]
pub(crate) struct PatchPlane {
    /// All facets in the plane.
    pub(crate) set: FacetSet,
    pub(crate) plane: Plane,
}

/// The vertices that are constrained to the same planes.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    /// The planes, as indices among all of them, in rising order.
    pub(crate) planes: Vec<u32>,
    /// The unit vector along the line where the planes meet; `None` where there is one plane.
    pub(crate) along: Option<Point>,
    /// The vertices, in rising order.
    pub(crate) free: Vec<VertexId>,
    /// For a line: the other vertices that lie on all of its planes, in rising order.
    pub(crate) anchors: Vec<VertexId>,
}

/// All planes, and the vertices that slide in them. Lines come first, those of more planes before others,
/// then planes, so that what a vertex follows is placed before it.
#[derive(Clone, Debug, Default)]
pub(crate) struct SlidingConstraints {
    pub(crate) patch_planes: Vec<PatchPlane>,
    pub(crate) constraints: Vec<Constraint>,
}

/// The sets whose facets a vertex is on, and whether it is also driven.
struct Member {
    vertex: VertexId,
    sets: Vec<u32>,
    is_driven: bool,
}

impl SlidingConstraints {
    /// Finds the planes of `sets` and the vertices that slide in them. `driven`, in rising order, are
    /// vertices that do not slide wherever they lie; `tolerance` is how far a patch may be off its plane,
    /// relative to its radius.
    ///
    /// # Errors
    /// When a set is not flat.
    pub(crate) fn new(
        points: &[Point],
        sets: &[FacetSet],
        boundary: &Boundary,
        driven: &[VertexId],
        tolerance: f64,
    ) -> Result<Self> {
        let plane = |set: &FacetSet| {
            Plane::new(points, set, tolerance).map_err(|e: Error| e.at(format!("sliding patch {}", set.name)))
        };
        let planes = sets.iter().map(plane).collect::<Result<Vec<_>>>()?;
        let members = members(sets, boundary, driven);
        let sliding = members.iter().filter(|m| !m.is_driven);
        let (patch_planes, plane_of) = merge_coplanar(points, sets, &planes, sliding, tolerance);
        let mut constrained: BTreeMap<Vec<u32>, Vec<VertexId>> = BTreeMap::new();
        let mut others: Vec<(Vec<u32>, VertexId)> = Vec::new();
        let mut lines: HashMap<Vec<u32>, Option<Point>> = HashMap::new();
        for member in &members {
            let mut on: Vec<u32> = member.sets.iter().map(|&s| plane_of[s as usize]).collect();
            on.sort_unstable();
            on.dedup();
            let along = lines.entry(on.clone()).or_insert_with(|| line(&patch_planes, &on));
            match member.is_driven || (on.len() > 1 && along.is_none()) {
                true => others.push((on, member.vertex)),
                false => constrained.entry(on).or_default().push(member.vertex),
            }
        }
        let anchors = |planes: &[u32]| -> Vec<VertexId> {
            let has_all = |on: &[u32]| on != planes && planes.iter().all(|p| on.binary_search(p).is_ok());
            let of_lines =
                constrained.iter().filter(|(on, _)| has_all(on)).flat_map(|(_, v)| v.iter().copied());
            let is_here = |on: &[u32]| on == planes || has_all(on);
            let mut all: Vec<VertexId> =
                others.iter().filter(|(on, _)| is_here(on)).map(|(_, v)| *v).chain(of_lines).collect();
            all.sort_unstable();
            all
        };
        let mut sorted: Vec<Constraint> = constrained
            .iter()
            .map(|(planes, free)| Constraint {
                along: lines[planes],
                anchors: if planes.len() > 1 { anchors(planes) } else { Vec::new() },
                planes: planes.clone(),
                free: free.clone(),
            })
            // On a line without anchors, vertices have nothing to follow.
            .filter(|constraint| constraint.along.is_none() || !constraint.anchors.is_empty())
            .collect();
        sorted.sort_by_key(|constraint| std::cmp::Reverse(constraint.planes.len()));
        Ok(Self { patch_planes, constraints: sorted })
    }

    /// The constraints with planes and lines fitted to the vertices at `points`: a patch may have rotated as
    /// a whole.
    ///
    /// # Errors
    /// When the facets of a plane have no area there.
    pub(crate) fn refitted(&self, points: &[Point]) -> Result<Self> {
        let refit = |flat: &PatchPlane| {
            let plane = Plane::new(points, &flat.set, f64::INFINITY);
            Ok(PatchPlane {
                set: flat.set.clone(),
                plane: plane.map_err(|e: Error| e.at(format!("sliding patch {}", flat.set.name)))?,
            })
        };
        let patch_planes = self.patch_planes.iter().map(refit).collect::<Result<Vec<_>>>()?;
        let constraints = self.constraints.iter().map(|constraint| Constraint {
            along: constraint.along.map(|before| line(&patch_planes, &constraint.planes).unwrap_or(before)),
            ..constraint.clone()
        });
        Ok(Self { constraints: constraints.collect(), patch_planes })
    }

    /// The line or the plane that constrains each vertex, as an index into [`Self::constraints`].
    pub(crate) fn constraint_of(&self, n_points: usize) -> Vec<Option<u32>> {
        let mut of = vec![None; n_points];
        for (i, constraint) in (0..).zip(&self.constraints) {
            constraint.free.iter().for_each(|v| of[v.index()] = Some(i));
        }
        of
    }
}

/// The vertices of the boundary on facets of sets, in rising order.
fn members(sets: &[FacetSet], boundary: &Boundary, driven: &[VertexId]) -> Vec<Member> {
    const OTHER: u32 = u32::MAX;
    let mut set_of = HashMap::new();
    for (i, set) in (0u32..).zip(sets) {
        set.rings.iter().for_each(|ring| {
            set_of.entry(key(ring)).or_insert(i);
        });
    }
    let mut pairs: Vec<(VertexId, u32)> = Vec::new();
    let rings = FacetSet::of_boundary(boundary, "", |_| true).rings;
    for (corners, vertices) in rings.iter().zip(boundary.facets.iter()) {
        let set = set_of.get(&key(corners)).copied().unwrap_or(OTHER);
        pairs.extend(vertices.iter().map(|&v| (v, set)));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let of_vertex = |pairs: &[(VertexId, u32)]| {
        let vertex = pairs[0].0;
        let sets: Vec<u32> = pairs.iter().map(|(_, set)| *set).filter(|set| *set != OTHER).collect();
        let is_driven = sets.len() < pairs.len() || driven.binary_search(&vertex).is_ok();
        Member { vertex, sets, is_driven }
    };
    let members = pairs.chunk_by(|a, b| a.0 == b.0).map(of_vertex);
    members.filter(|member| !member.sets.is_empty()).collect()
}

/// The distinct planes, and the one of each set: sets that meet without an angle share a plane.
fn merge_coplanar<'a>(
    points: &[Point],
    sets: &[FacetSet],
    planes: &[Plane],
    sliding: impl Iterator<Item = &'a Member>,
    tolerance: f64,
) -> (Vec<PatchPlane>, Vec<u32>) {
    let mut meet: Vec<[u32; 2]> = Vec::new();
    for member in sliding {
        let with = |(i, &a): (usize, &u32)| member.sets[i + 1..].iter().map(move |&b| [a, b]);
        meet.extend(member.sets.iter().enumerate().flat_map(with));
    }
    meet.sort_unstable();
    meet.dedup();
    let mut patch_planes: Vec<PatchPlane> = sets
        .iter()
        .zip(planes)
        .map(|(set, plane)| PatchPlane { set: set.clone(), plane: plane.clone() })
        .collect();
    let mut plane_of: Vec<u32> = (0..sets.len() as u32).collect();
    for [a, b] in meet {
        let [i, j] = [a, b].map(|set| plane_of[set as usize]);
        if i == j || are_distinct(&planes[a as usize], &planes[b as usize]) {
            continue;
        }
        let both = [i, j].map(|flat| patch_planes[flat as usize].set.clone());
        let Some(set) = FacetSet::joined(both) else { continue };
        if let Ok(plane) = Plane::new(points, &set, tolerance) {
            patch_planes[i.min(j) as usize] = PatchPlane { set, plane };
            plane_of.iter_mut().filter(|flat| **flat == i.max(j)).for_each(|flat| *flat = i.min(j));
        }
    }
    // Renumbers the remaining planes.
    let mut used = plane_of.clone();
    used.sort_unstable();
    used.dedup();
    plane_of.iter_mut().for_each(|flat| *flat = used.partition_point(|u| u < flat) as u32);
    (used.iter().map(|&u| patch_planes[u as usize].clone()).collect(), plane_of)
}

fn are_distinct(a: &Plane, b: &Plane) -> bool {
    norm(cross(a.normal, b.normal)) > angle_uncertainty([a, b])
}

/// The sine of the largest angle between planes that their uncertainty may account for.
fn angle_uncertainty<'a>(planes: impl IntoIterator<Item = &'a Plane>) -> f64 {
    MAX_UNCERTAINTY.min(
        UNCERTAINTY_FACTOR * planes.into_iter().map(|plane| plane.normal_error() + ROUNDING).sum::<f64>(),
    )
}

/// The direction of the line where planes meet; `None` where there is one plane, where they meet in a point,
/// or where their angle is uncertain.
fn line(patch_planes: &[PatchPlane], on: &[u32]) -> Option<Point> {
    let planes: Vec<&Plane> = on.iter().map(|&flat| &patch_planes[flat as usize].plane).collect();
    let mut best = [0.0; 3];
    for (i, a) in planes.iter().enumerate() {
        for b in &planes[i + 1..] {
            let along = cross(a.normal, b.normal);
            if norm(along) > norm(best) && are_distinct(a, b) {
                best = along;
            }
        }
    }
    // The flatter the angle, the less certain the direction: by one over its sine.
    let angle_uncertainty = angle_uncertainty(planes.iter().copied());
    let lies_in = |plane: &&Plane| dot(plane.normal, best).abs() <= angle_uncertainty;
    let sine = norm(best);
    (sine > 0.0 && planes.iter().all(lies_in)).then(|| scale(best, 1.0 / sine))
}
