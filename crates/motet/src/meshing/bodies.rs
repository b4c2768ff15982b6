//! The bodies that surfaces enclose: numbered from the outside in, named, left out on request.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use serde::{Deserialize, Serialize};

use super::surfaces::Surfaces;
use crate::base::{Error, Point, Result, VertexId, same_orientation, sorted_ids};
use crate::delaunay::Constrained;
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::{FACETS, holds, volume};
use crate::geometry::vector::in_range;
use crate::mesh::{CellKind, LabelPlaces, Mesh, bounds, unused_name};
use crate::preflight::Role;

/// A place in a body, and the name to give to the body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Seed {
    /// Any place in the body, not on a surface.
    pub place: Point,
    /// The name of the region.
    pub name: String,
}

/// A region of the resulting mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Body {
    /// The number of the region.
    pub region: i32,
    /// The name of the region, if it has one.
    pub name: Option<String>,
    /// The number of tets.
    pub tets: usize,
    /// The number of prisms and pyramids of layers, where these are not divided into tets.
    pub prisms: usize,
    /// The volume of the body.
    pub volume: f64,
    /// Whether it is a void: closed surfaces turned inward enclose it.
    pub is_void: bool,
}

/// The bodies of a mesh, in the order of their region numbers.
pub(crate) fn bodies_of_mesh(mesh: &Mesh) -> Vec<Body> {
    let Some(regions) = mesh.regions() else { return Vec::new() };
    let (mut bodies, mut places) = (Vec::new(), LabelPlaces::default());
    for (cell, tet) in mesh.cells.tets() {
        let region = regions.ids[cell.index()];
        let place = places.of(region);
        if place == bodies.len() {
            let name = regions.names.get(&region).cloned();
            bodies.push(Body { region, name, tets: 0, prisms: 0, volume: 0.0, is_void: false });
        }
        let body = &mut bodies[place];
        body.tets += 1;
        body.volume += volume(tet.map(|v| mesh.points[v.index()]));
    }
    bodies.sort_by_key(|body| body.region);
    bodies
}

/// Counts the tets and prisms of a mesh into its bodies, which must be in the order of their regions.
pub(super) fn count_cells(bodies: &mut [Body], mesh: &Mesh) {
    let Some(regions) = mesh.regions() else { return };
    bodies.iter_mut().for_each(|body| (body.tets, body.prisms) = (0, 0));
    for (cell, kind, _) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        let region = regions.ids[cell.index()];
        let Ok(place) = bodies.binary_search_by_key(&region, |body| body.region) else { continue };
        let body = &mut bodies[place];
        *(if kind == CellKind::TETRA { &mut body.tets } else { &mut body.prisms }) += 1;
    }
}

/// The side of a triangle: a body, or `None` outside of all.
type Side = Option<u32>;

/// Names and voids of the bodies, by their numbers.
#[derive(Debug, Default)]
pub(super) struct NumberedBodies {
    pub(super) names: BTreeMap<u32, String>,
    /// Bodies that are kept although closed surfaces turned inward enclose them.
    pub(super) voids: BTreeSet<u32>,
    /// How many such bodies were left out.
    pub(super) n_left_out: usize,
}

/// Which bodies have names, and which are left out.
pub(super) struct Named<'a> {
    /// Places in bodies, with names for their regions.
    pub(super) seeds: &'a [Seed],
    /// Places in bodies that are left out.
    pub(super) holes: &'a [Point],
    /// Whether bodies enclosed by closed surfaces turned inward are left out.
    pub(super) leaves_voids_out: bool,
}

/// Removes bodies with holes and, on request, voids that no seed names; numbers the others from the outside
/// in.
///
/// Bodies are named by seeds. If there are several closed surfaces, other bodies get the name of the smallest
/// one that encloses them.
///
/// # Errors
/// When a place lies in no body or on a surface, when places contradict each other, or when nothing is left.
pub(super) fn arrange(
    tets: &mut Constrained,
    surfaces: &Surfaces,
    triangles: &[[VertexId; 3]],
    named: &Named,
) -> Result<NumberedBodies> {
    let Named { seeds, holes, leaves_voids_out } = *named;
    let mut names = BTreeMap::new();
    for seed in seeds {
        let body = body_at(tets, seed.place)?;
        check_seed(&names, body, seed)?;
        names.insert(body, seed.name.clone());
    }
    let mut holes =
        holes.iter().map(|&place| hole_at(tets, place, &names)).collect::<Result<BTreeSet<_>>>()?;
    let voids: BTreeSet<u32> = &voids(tets, surfaces, triangles) - &holes;
    let left_out: BTreeSet<u32> =
        voids.iter().copied().filter(|body| leaves_voids_out && !names.contains_key(body)).collect();
    holes.extend(&left_out);
    let order = from_outside(&tets.triangle_to_bodies);
    let by_surface = EnclosingSurfaces::find(tets, surfaces, triangles).names(tets, surfaces, &order);
    for (body, name) in by_surface {
        if !names.contains_key(&body) && !holes.contains(&body) {
            let unused = unused_name(&name, |name| names.values().any(|other| other == name));
            names.insert(body, unused);
        }
    }
    let kept = order.iter().filter(|body| !holes.contains(body));
    let new: BTreeMap<u32, u32> = kept.copied().zip(0..).collect();
    if new.is_empty() && !order.is_empty() {
        return Err(Error::options("every body is a hole or a void").remedy("leave a body to be filled"));
    }
    renumber(tets, &new);
    Ok(NumberedBodies {
        names: names.into_iter().filter_map(|(body, name)| Some((*new.get(&body)?, name))).collect(),
        voids: voids.iter().filter_map(|body| new.get(body).copied()).collect(),
        n_left_out: left_out.len(),
    })
}

/// The bodies with winding number 0 with respect to the closed surfaces, as their triangles are oriented.
/// Empty if the winding number depends on the path taken into a body, because triangles are not consistently
/// oriented.
fn voids(tets: &Constrained, surfaces: &Surfaces, triangles: &[[VertexId; 3]]) -> BTreeSet<u32> {
    let mut faces: BTreeMap<[VertexId; 3], i32> = BTreeMap::new();
    for (t, _) in surfaces
        .triangles
        .iter()
        .zip(&surfaces.surface_of)
        .filter(|(_, s)| surfaces.roles[**s as usize] == Role::Boundary)
    {
        *faces.entry(sorted_ids(*t)).or_default() +=
            if same_orientation(*t, sorted_ids(*t)) { 1 } else { -1 };
    }
    let inward = |i: usize| {
        let t = triangles[i];
        let n = faces.get(&sorted_ids(t)).copied().unwrap_or(0);
        if same_orientation(t, sorted_ids(t)) { n } else { -n }
    };
    let beyond = beyond(&tets.triangle_to_bodies);
    let mut winding: BTreeMap<Side, i32> = BTreeMap::from([(None, 0)]);
    let mut todo = VecDeque::from([None]);
    while let Some(side) = todo.pop_front() {
        for &(i, other) in beyond.get(&side).map_or(&[][..], Vec::as_slice) {
            let is_inward = tets.triangle_to_bodies[i][0] == side;
            let there = winding[&side] + if is_inward { inward(i) } else { -inward(i) };
            match winding.get(&other) {
                Some(known) if *known != there => return BTreeSet::new(),
                Some(_) => {}
                None => {
                    winding.insert(other, there);
                    todo.push_back(other);
                }
            }
        }
    }
    winding.into_iter().filter(|(_, winding)| *winding == 0).filter_map(|(side, _)| side).collect()
}

fn renumber(tets: &mut Constrained, new: &BTreeMap<u32, u32>) {
    let is_same = new.iter().all(|(old, new)| old == new);
    if is_same && tets.bodies.iter().all(|&body| (body as usize) < new.len()) {
        return;
    }
    let kept = |body: &u32| new.get(body).copied();
    let both = tets.tets.iter().zip(&tets.bodies);
    (tets.tets, tets.bodies) = both.filter_map(|(tet, body)| Some((*tet, kept(body)?))).unzip();
    for sides in &mut tets.triangle_to_bodies {
        *sides = sides.map(|side| kept(&side?));
    }
}

fn format_place([x, y, z]: Point) -> String {
    format!("{x}, {y}, {z}")
}

fn check_seed(names: &BTreeMap<u32, String>, body: u32, seed: &Seed) -> Result<()> {
    let at = |what: String, remedy: &str| {
        Err(Error::options(what).at(format!("seed at {}", format_place(seed.place))).remedy(remedy))
    };
    match names.iter().find(|(other, name)| (**other == body) != (**name == seed.name)) {
        Some((other, name)) if *other == body => {
            let what =
                format!("lies in a body that another seed names `{name}` and this one `{}`", seed.name);
            at(what, "give only one of them, or a surface between them")
        }
        Some((_, name)) if *name == seed.name => {
            at(format!("the name `{name}` is already used for another body"), "give each body its own name")
        }
        _ => Ok(()),
    }
}

fn hole_at(tets: &Constrained, place: Point, names: &BTreeMap<u32, String>) -> Result<u32> {
    let body = body_at(tets, place)?;
    match names.get(&body) {
        None => Ok(body),
        Some(name) => {
            let what = format!("the hole lies in a body that a seed names `{name}`");
            Err(Error::options(what).at(format_place(place)).remedy("give either the hole or the seed"))
        }
    }
}

/// Finds the body that contains a place.
fn body_at(tets: &Constrained, place: Point) -> Result<u32> {
    if !in_range(place) {
        return Err(Error::options("the coordinates of a place must be finite").at(format_place(place)));
    }
    let corners = |tet: &[VertexId; 4]| tet.map(|v| tets.points[v.index()]);
    let is_around = |tet: [Point; 4]| {
        (0..3).all(|i| tet.iter().any(|p| p[i] <= place[i]) && tet.iter().any(|p| p[i] >= place[i]))
    };
    let holder = |tet: &[VertexId; 4]| is_around(corners(tet)) && holds(corners(tet), place);
    let Some(t) = tets.tets.iter().position(holder) else {
        let [low, high] = bounds(&tets.points).unwrap_or_default();
        return Err(Error::input("the place lies outside of all enclosed bodies")
            .at(format_place(place))
            .remedy(format!(
                "give a place inside; the surfaces extend from {} to {}",
                format_place(low),
                format_place(high)
            )));
    };
    let tet = tets.tets[t];
    let on = FACETS.map(|f| f.map(|k| tet[k])).into_iter().filter(|facet| {
        let [a, b, c] = facet.map(|v| tets.points[v.index()]);
        orient3d(a, b, c, place) == 0
    });
    match on.filter_map(|facet| wall(tets, facet)).next() {
        None => Ok(tets.bodies[t]),
        Some(triangle) => Err(Error::input("the place lies on the surface, at the border of a body")
            .at(format!("{} on triangle {triangle}", format_place(place)))
            .remedy("give a place inside a body")),
    }
}

/// The triangle that a facet is a part of, if it separates bodies.
fn wall(tets: &Constrained, facet: [VertexId; 3]) -> Option<usize> {
    let is_part = |part: &[VertexId; 3]| sorted_ids(*part) == sorted_ids(facet);
    let mut parting = tets.triangle_to_bodies.iter().enumerate().filter(|(_, sides)| sides[0] != sides[1]);
    parting.find(|(i, _)| tets.triangle_to_facets.list(*i).iter().any(is_part)).map(|(i, _)| i)
}

/// For each body, and first for the outside, the adjacent sides: `(triangle, side beyond it)`.
fn beyond(triangle_to_bodies: &[[Side; 2]]) -> BTreeMap<Side, Vec<(usize, Side)>> {
    let mut beyond: BTreeMap<Side, Vec<(usize, Side)>> = BTreeMap::new();
    for (i, &[front, behind]) in triangle_to_bodies.iter().enumerate().filter(|(_, [a, b])| a != b) {
        beyond.entry(front).or_default().push((i, behind));
        beyond.entry(behind).or_default().push((i, front));
    }
    beyond
}

/// All bodies from the outside in; those at equal depth in the order of their first triangle.
fn from_outside(triangle_to_bodies: &[[Side; 2]]) -> Vec<u32> {
    let beyond = beyond(triangle_to_bodies);
    let mut depths: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    let mut todo = VecDeque::from([(None, 0)]);
    while let Some((side, depth)) = todo.pop_front() {
        for &(_, other) in beyond.get(&side).map_or(&[][..], Vec::as_slice) {
            let Some(body) = other else { continue };
            depths.entry(body).or_insert_with(|| {
                todo.push_back((other, depth + 1));
                (depth, beyond[&other].first().map_or(usize::MAX, |first| first.0))
            });
        }
    }
    let mut order: Vec<u32> = depths.keys().copied().collect();
    order.sort_by_key(|body| depths[body]);
    order
}

/// The closed surfaces that enclose each body.
struct EnclosingSurfaces {
    /// For each body its surfaces, in ascending order.
    of_body: BTreeMap<u32, BTreeSet<u32>>,
}

impl EnclosingSurfaces {
    /// Finds them by walking from the outside: crossing a triangle enters or leaves its surfaces.
    fn find(tets: &Constrained, surfaces: &Surfaces, triangles: &[[VertexId; 3]]) -> Self {
        let is_boundary = |s: &u32| surfaces.roles[*s as usize] == Role::Boundary;
        let mut of_triangle: Vec<([VertexId; 3], u32)> = surfaces
            .triangles
            .iter()
            .map(|t| sorted_ids(*t))
            .zip(surfaces.surface_of.iter().copied())
            .collect();
        of_triangle.retain(|(_, s)| is_boundary(s));
        of_triangle.sort_unstable();
        let crossed = |i: usize| {
            let key = sorted_ids(triangles[i]);
            let first = of_triangle.partition_point(|(t, _)| *t < key);
            of_triangle[first..].iter().take_while(move |(t, _)| *t == key).map(|(_, s)| *s)
        };
        let across = |from: &BTreeSet<u32>, i: usize| from ^ &crossed(i).collect();
        let mut of_side: BTreeMap<Side, BTreeSet<u32>> = BTreeMap::from([(None, BTreeSet::new())]);
        let beyond = beyond(&tets.triangle_to_bodies);
        let mut todo = VecDeque::from([None]);
        let mut torn = BTreeSet::new();
        while let Some(side) = todo.pop_front() {
            for &(i, other) in beyond.get(&side).map_or(&[][..], Vec::as_slice) {
                let there = across(&of_side[&side], i);
                match of_side.get(&other) {
                    Some(known) => torn.extend(known ^ &there),
                    None => {
                        of_side.insert(other, there);
                        todo.push_back(other);
                    }
                }
            }
        }
        Self { of_body: of_side.into_iter().filter_map(|(side, of)| Some((side?, &of - &torn))).collect() }
    }

    /// The volume that each surface encloses; absent for surfaces that are not closed by themselves.
    fn volumes(&self, tets: &Constrained) -> BTreeMap<u32, f64> {
        let mut volumes = BTreeMap::new();
        for (tet, body) in tets.tets.iter().zip(&tets.bodies) {
            let volume = volume(tet.map(|v| tets.points[v.index()]));
            let of_body = self.of_body.get(body).into_iter().flatten();
            of_body.for_each(|s| *volumes.entry(*s).or_insert(0.0) += volume);
        }
        volumes
    }

    /// For each body, in this order, the name of the smallest surface that encloses it; empty if there is
    /// only one surface.
    fn names(&self, tets: &Constrained, surfaces: &Surfaces, order: &[u32]) -> Vec<(u32, String)> {
        if surfaces.roles.iter().filter(|role| **role == Role::Boundary).count() < 2 {
            return Vec::new();
        }
        let volumes = self.volumes(tets);
        let smallest = |body: &u32| {
            let holders = self.of_body.get(body)?.iter();
            holders.min_by(|a, b| volumes[a].total_cmp(&volumes[b]))
        };
        let named = |body: &u32| Some((*body, surfaces.names[*smallest(body)? as usize].clone()));
        order.iter().filter_map(named).filter(|(_, name)| !name.is_empty()).collect()
    }
}
