//! Deliberately broken meshes, and checks of validity by definition, independent of the code by which `motet`
//! ensures it.

use std::collections::{BTreeMap, HashMap};

use motet::base::{Point, Threads, VertexId};
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::volume;
use motet::geometry::vector::distance;
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{TetMesh, TetPart};
use motet::remesh::{Options, SurfaceRule, remesh};

use super::{Numbers, random_mesh};

/// The damage done to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Damage {
    /// Inner vertices moved at random, some or all, by up to twice their shortest edge.
    Shaken,
    /// A tet added on the inner side of a boundary facet, so that two lie on one side of it.
    Folded,
    /// A duplicate of a tet, with its vertices in another order.
    Doubled,
    /// A tet with one vertex replaced by another of the mesh.
    Misnamed,
    /// Vertices of the boundary moved through the mesh.
    Pushed,
}

pub(crate) const DAMAGES: [Damage; 5] =
    [Damage::Shaken, Damage::Folded, Damage::Doubled, Damage::Misnamed, Damage::Pushed];

/// A broken mesh and its damage.
pub(crate) struct Wreck {
    pub(crate) damage: Damage,
    pub(crate) sound: TetMesh,
    pub(crate) mesh: TetMesh,
}

/// The outcome of repairing a wreck.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Ending {
    /// Every tet is positive, and the mesh is valid.
    Valid,
    /// Flat or inverted tets are left, and the report counts them.
    Reported,
    /// An error that names a place.
    Refused,
}

impl Wreck {
    /// The wreck for a seed: shakes of every size, folds, several regions, membranes.
    pub(crate) fn new(seed: u64) -> Self {
        let mut numbers = Numbers(seed);
        let damage =
            if numbers.below(2) == 0 { Damage::Shaken } else { DAMAGES[numbers.below(DAMAGES.len())] };
        let sound = sound(&mut numbers);
        let mut mesh = sound.clone();
        match damage {
            Damage::Shaken => shake(&mut mesh, &mut numbers),
            Damage::Folded => fold(&mut mesh, &mut numbers),
            Damage::Doubled => double(&mut mesh, &mut numbers),
            Damage::Misnamed => misname(&mut mesh, &mut numbers),
            Damage::Pushed => push(&mut mesh, &mut numbers),
        }
        Self { damage, sound, mesh }
    }

    /// A box of `n` cells along each axis, with all inner vertices moved by up to `part` of an edge along
    /// each axis.
    pub(crate) fn shaken_box(seed: u64, n: usize, part: f64) -> Self {
        let sound = TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
        let (mut mesh, mut numbers) = (sound.clone(), Numbers(seed));
        let is_inner = |p: &Point| p.iter().all(|x| *x > 0.0 && *x < 1.0);
        for p in mesh.points.iter_mut().filter(|p| is_inner(p)) {
            p.iter_mut().for_each(|x| *x += (2.0 * numbers.unit() - 1.0) * part / n as f64);
        }
        Self { damage: Damage::Shaken, sound, mesh }
    }

    /// Repairs the wreck by a rule for the surface and returns the outcome; a violation is described in the
    /// error.
    pub(crate) fn end(&self, surface: SurfaceRule) -> Result<Ending, String> {
        let options = Options { surface, ..Options::default() };
        let outcome = match remesh(&self.mesh, &options, &Threads::single()) {
            Ok(outcome) => outcome,
            Err(error) if error.place().is_some() => return Ok(Ending::Refused),
            Err(error) => return Err(format!("refused without a place: {error}")),
        };
        let (new, reported) = (&outcome.extract.mesh, outcome.report.after.inverted);
        let n_wrong = sound_connectivity(new)?;
        if n_wrong > 0 || reported > 0 {
            return if reported > 0 {
                Ok(Ending::Reported)
            } else {
                Err(format!(
                    "{n_wrong} facets of flat or inverted tets, none reported; {:?}",
                    outcome.report.after.worst
                ))
            };
        }
        let keeps_walls = matches!(surface, SurfaceRule::Keep) && matches!(self.damage, Damage::Shaken);
        if keeps_walls {
            same_walls(&self.sound, new)?;
        }
        Ok(Ending::Valid)
    }
}

fn sound(numbers: &mut Numbers) -> TetMesh {
    match numbers.below(4) {
        0 => random_mesh(8 + numbers.below(60), numbers.next()),
        1 => {
            let n = [(); 3].map(|()| 1 + numbers.below(4));
            TetPart::of(&box_grid(n, [[0.0; 3], [1.0; 3]])).unwrap().mesh
        }
        2 => TetPart::of(&sphere_in_box(2 + numbers.below(2), 2)).unwrap().mesh,
        _ => with_membrane(numbers),
    }
}

/// A box of two regions, and a labelled sheet across part of it.
fn with_membrane(numbers: &mut Numbers) -> TetMesh {
    let n = 2 + numbers.below(3);
    let mut mesh = TetPart::of(&box_grid([n, n, 2], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    let middle =
        |t: &[VertexId; 4], axis: usize| t.iter().map(|v| mesh.points[v.index()][axis]).sum::<f64>() / 4.0;
    mesh.regions = mesh.tets.iter().map(|t| if middle(t, 0) < 0.5 { 1 } else { 2 }).collect();
    let is_in_sheet = |f: &[VertexId; 3]| f.iter().all(|v| mesh.points[v.index()][2] == 0.5);
    let mut sheet: Vec<[VertexId; 3]> =
        facets(&mesh).map(|(_, f)| f).filter(is_in_sheet).map(|f| sorted(&f)).collect();
    sheet.sort_unstable();
    sheet.dedup();
    sheet.truncate(1 + numbers.below(sheet.len()));
    mesh.patches = vec![4; sheet.len()];
    mesh.triangles = sheet;
    mesh
}

fn facets(mesh: &TetMesh) -> impl Iterator<Item = (usize, [VertexId; 3])> + '_ {
    const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
    mesh.tets.iter().enumerate().flat_map(|(t, tet)| OUTWARD.map(|f| (t, f.map(|i| tet[i]))))
}

fn sorted(facet: &[VertexId; 3]) -> [VertexId; 3] {
    let mut key = *facet;
    key.sort_unstable();
    key
}

/// The facets that belong to one tet only, separate two regions, or have a triangle.
fn walls(mesh: &TetMesh) -> Vec<[VertexId; 3]> {
    let mut uses: HashMap<[VertexId; 3], Vec<usize>> = HashMap::new();
    facets(mesh).for_each(|(t, f)| uses.entry(sorted(&f)).or_default().push(t));
    let triangles: Vec<_> = mesh.triangles.iter().map(sorted).collect();
    let is_wall = |(f, tets): &(&[VertexId; 3], &Vec<usize>)| {
        tets.len() == 1
            || tets.windows(2).any(|w| mesh.regions[w[0]] != mesh.regions[w[1]])
            || triangles.contains(f)
    };
    let mut walls: Vec<_> = uses.iter().filter(is_wall).map(|(f, _)| *f).collect();
    walls.sort_unstable();
    walls
}

fn shortest_edges(mesh: &TetMesh) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; mesh.points.len()];
    for tet in &mesh.tets {
        for (&v, &w) in tet.iter().flat_map(|v| tet.iter().map(move |w| (v, w))).filter(|(v, w)| v != w) {
            let length = distance(mesh.points[v.index()], mesh.points[w.index()]);
            shortest[v.index()] = shortest[v.index()].min(length);
        }
    }
    shortest
}

fn shake(mesh: &mut TetMesh, numbers: &mut Numbers) {
    let mut is_held = vec![false; mesh.points.len()];
    walls(mesh).as_flattened().iter().for_each(|v| is_held[v.index()] = true);
    let (part, share) = (2.0 * numbers.unit(), if numbers.below(2) == 0 { 1.0 } else { numbers.unit() });
    for (v, length) in shortest_edges(mesh).into_iter().enumerate() {
        if !is_held[v] && length.is_finite() && numbers.unit() < share {
            (0..3).for_each(|i| mesh.points[v][i] += (2.0 * numbers.unit() - 1.0) * part * length);
        }
    }
}

fn fold(mesh: &mut TetMesh, numbers: &mut Numbers) {
    let boundary: Vec<_> = {
        let mut uses: HashMap<[VertexId; 3], Vec<(usize, [VertexId; 3])>> = HashMap::new();
        facets(mesh).for_each(|(t, f)| uses.entry(sorted(&f)).or_default().push((t, f)));
        let mut alone: Vec<_> = uses.into_values().filter(|u| u.len() == 1).map(|u| u[0]).collect();
        alone.sort_unstable();
        alone
    };
    let (tet, [a, b, c]) = boundary[numbers.below(boundary.len())];
    let apex = match numbers.below(2) {
        0 => mesh.tets[numbers.below(mesh.tets.len())][numbers.below(4)],
        _ => {
            let centre: Point = std::array::from_fn(|i| {
                mesh.tets[tet].iter().map(|v| mesh.points[v.index()][i]).sum::<f64>() / 4.0
            });
            mesh.points.push(centre);
            VertexId::new(mesh.points.len() - 1)
        }
    };
    if ![a, b, c].contains(&apex) {
        mesh.tets.push([a, c, b, apex]);
        mesh.regions.push(mesh.regions[tet]);
    }
}

fn double(mesh: &mut TetMesh, numbers: &mut Numbers) {
    let t = numbers.below(mesh.tets.len());
    let [a, b, c, d] = mesh.tets[t];
    mesh.tets.push(if numbers.below(2) == 0 { [b, c, a, d] } else { [b, a, c, d] });
    mesh.regions.push(mesh.regions[t]);
}

fn misname(mesh: &mut TetMesh, numbers: &mut Numbers) {
    let (t, i, v) = (numbers.below(mesh.tets.len()), numbers.below(4), numbers.below(mesh.points.len()));
    mesh.tets[t][i] = VertexId::new(v);
}

fn push(mesh: &mut TetMesh, numbers: &mut Numbers) {
    for _ in 0..1 + numbers.below(3) {
        let v = numbers.below(mesh.points.len());
        let to = mesh.points[numbers.below(mesh.points.len())];
        let part = 2.0 * numbers.unit();
        (0..3).for_each(|i| mesh.points[v][i] += part * (to[i] - mesh.points[v][i]));
    }
}

/// Checks that tets fit together: no vertex twice in one, no two alike, at most two at a facet. Returns the
/// number of facets at which a tet is flat, or two lie on one side. The order of the vertices of a tet does
/// not matter.
pub(crate) fn sound_connectivity(mesh: &TetMesh) -> Result<usize, String> {
    let mut seen: HashMap<[VertexId; 4], usize> = HashMap::new();
    for (t, tet) in mesh.tets.iter().enumerate() {
        let mut key = *tet;
        key.sort_unstable();
        if key.windows(2).any(|w| w[0] == w[1]) {
            return Err(format!("tet {t} has the vertices {tet:?}"));
        }
        if let Some(other) = seen.insert(key, t) {
            return Err(format!("the tets {other} and {t} have the same vertices"));
        }
    }
    let mut uses: BTreeMap<[VertexId; 3], Vec<usize>> = BTreeMap::new();
    facets(mesh).for_each(|(t, f)| uses.entry(sorted(&f)).or_default().push(t));
    let mut n_wrong = 0;
    for (facet, uses) in uses {
        let side = |t: usize| {
            let apex = mesh.tets[t].into_iter().find(|v| !facet.contains(v)).unwrap_or(facet[0]);
            let [a, b, c, d] = [facet[0], facet[1], facet[2], apex].map(|v| mesh.points[v.index()]);
            orient3d(a, b, c, d).signum()
        };
        match uses[..] {
            [t] => n_wrong += usize::from(side(t) == 0),
            [t, u] => n_wrong += usize::from(side(t) * side(u) != -1),
            _ => return Err(format!("{} tets share the facet {facet:?}", uses.len())),
        }
    }
    Ok(n_wrong)
}

/// Checks that two meshes have the same walls, by the bits of their points, and regions of the same volume.
fn same_walls(old: &TetMesh, new: &TetMesh) -> Result<(), String> {
    let bits = |mesh: &TetMesh| {
        let of = |f: [VertexId; 3]| {
            let mut corners = f.map(|v| mesh.points[v.index()].map(f64::to_bits));
            corners.sort_unstable();
            corners
        };
        let mut all: Vec<_> = walls(mesh).into_iter().map(of).collect();
        all.sort_unstable();
        all
    };
    if bits(old) != bits(new) {
        return Err("walls have changed".into());
    }
    let volumes = |mesh: &TetMesh| {
        let mut of: BTreeMap<i32, f64> = BTreeMap::new();
        for (tet, region) in mesh.tets.iter().zip(&mesh.regions) {
            *of.entry(*region).or_default() += volume(tet.map(|v| mesh.points[v.index()])).abs();
        }
        of
    };
    let (before, after) = (volumes(old), volumes(new));
    let is_off = |(region, v): (&i32, &f64)| (v - after.get(region).unwrap_or(&0.0)).abs() > 1e-9 * v;
    if before.len() != after.len() || before.iter().any(is_off) {
        return Err(format!("volumes were {before:?} and are {after:?}"));
    }
    Ok(())
}
