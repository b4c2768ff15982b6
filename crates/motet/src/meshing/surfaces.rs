//! Joins the surfaces of several meshes into one set of points and triangles.

use std::collections::BTreeMap;

use super::compact::{compact, used_vertices};
use crate::base::{Error, Point, Result, Threads, VertexId, sorted_ids};
use crate::mesh::{Mesh, Surface, firsts_at_place};
use crate::preflight::{self, Preflight, RepairKind, Repaired, Repairs, Role, renamed};

/// Joined surfaces to be filled: coincident points are one vertex, and meshes that end at a common edge are
/// one surface.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// The points of all meshes, one mesh after the other, including unused ones.
    pub points: Vec<Point>,
    /// The triangles of all meshes.
    pub triangles: Vec<[VertexId; 3]>,
    /// The surface that each triangle belongs to.
    pub surface_of: Vec<u32>,
    /// The role of each surface.
    pub roles: Vec<Role>,
    /// The name of the first mesh of each surface.
    pub names: Vec<String>,
    /// The meshes that each surface is made of, in ascending order.
    pub meshes: Vec<Vec<u32>>,
    /// The patch of each triangle. The first mesh keeps its labels; later meshes get new ones.
    pub patches: Vec<i32>,
    /// Names of patches, where there are any.
    pub patch_names: BTreeMap<i32, String>,
    /// Triangles of walls and gaps that were lost by [`Self::repair`], since they are thinner than the
    /// distance of a wrap.
    pub n_lost: usize,
}

impl Surfaces {
    /// Joins the surface cells of meshes, or the boundary of the volume cells for a mesh without any. Each
    /// mesh comes with a role and a name; the name is given to triangles without a patch.
    ///
    /// # Errors
    /// When there are more points than ids.
    pub fn new(meshes: &[(&Mesh, Role, &str)]) -> Result<Self> {
        let surfaces: Vec<_> = meshes
            .iter()
            .map(|&(mesh, role, name)| (Surface::own_or_boundary_of(mesh), role, name))
            .collect();
        let surfaces: Vec<_> = surfaces.iter().map(|(surface, role, name)| (surface, *role, *name)).collect();
        Self::of(&surfaces)
    }

    /// Joins surfaces, each with a role and a name, as [`Self::new`] does.
    pub(super) fn of(surfaces: &[(&Surface, Role, &str)]) -> Result<Self> {
        let mut all = Self {
            points: Vec::new(),
            triangles: Vec::new(),
            surface_of: Vec::new(),
            roles: surfaces.iter().map(|m| m.1).collect(),
            names: surfaces.iter().map(|m| m.2.to_owned()).collect(),
            meshes: (0..surfaces.len() as u32).map(|mesh| vec![mesh]).collect(),
            patches: Vec::new(),
            patch_names: BTreeMap::new(),
            n_lost: 0,
        };
        for (number, &(surface, _, name)) in surfaces.iter().enumerate() {
            all.add(surface, number as u32, name)?;
        }
        let kept = firsts_at_place(&all.points);
        all.triangles = renamed(&all.triangles, &kept);
        all.join();
        Ok(all)
    }

    /// Merges surfaces that end at a common edge; a triangle that several of them contain stays in the first.
    fn join(&mut self) {
        let part_of =
            preflight::joined_surfaces(&self.points, &self.triangles, &self.surface_of, &self.roles);
        if (0..).eq(part_of.iter().copied()) {
            return;
        }
        self.keep_firsts(|this, t| (part_of[this.surface_of[t] as usize], this.surface_of[t]));
        self.merge(&part_of);
    }

    /// Makes each surface part of another, or of itself; `part_of` names the first of each.
    fn merge(&mut self, part_of: &[u32]) {
        let is_first = |s: &usize| part_of[*s] as usize == *s;
        let firsts: Vec<usize> = (0..part_of.len()).filter(is_first).collect();
        let new = |s: u32| firsts.partition_point(|&first| first < part_of[s as usize] as usize);
        let mut meshes = vec![Vec::new(); firsts.len()];
        for (s, own) in (0u32..).zip(&self.meshes) {
            meshes[new(s)].extend(own);
        }
        meshes.iter_mut().for_each(|own| own.sort_unstable());
        self.surface_of.iter_mut().for_each(|s| *s = new(*s) as u32);
        self.roles = firsts.iter().map(|&s| self.roles[s]).collect();
        self.names = firsts.iter().map(|&s| self.names[s].clone()).collect();
        self.meshes = meshes;
    }

    /// Among triangles with the same vertices within a group, keeps those of the group's first member; `of`
    /// returns group and member of a triangle.
    fn keep_firsts(&mut self, of: impl Fn(&Self, usize) -> (u32, u32)) {
        let key = |t: usize| {
            let (group, member) = of(self, t);
            (group, sorted_ids(self.triangles[t]), member)
        };
        let mut order: Vec<_> = (0..self.triangles.len()).map(|t| (key(t), t)).collect();
        order.sort_unstable();
        let mut is_kept = vec![true; self.triangles.len()];
        for same in order.chunk_by(|x, y| (x.0.0, x.0.1) == (y.0.0, y.0.1)) {
            same.iter().filter(|(key, _)| key.2 != same[0].0.2).for_each(|&(_, t)| is_kept[t] = false);
        }
        fn keep<T>(all: &mut Vec<T>, is_kept: &[bool]) {
            let mut kept = is_kept.iter();
            all.retain(|_| *kept.next().unwrap_or(&true));
        }
        keep(&mut self.triangles, &is_kept);
        keep(&mut self.surface_of, &is_kept);
        keep(&mut self.patches, &is_kept);
    }

    fn add(&mut self, surface: &Surface, number: u32, name: &str) -> Result<()> {
        let first = self.points.len();
        if first + surface.points.len() > VertexId::MAX_COUNT {
            return Err(Error::input("the surfaces have more points than there are ids")
                .remedy("mesh the surfaces one by one"));
        }
        let moved = |t: &[VertexId; 3]| t.map(|v| VertexId::new(first + v.index()));
        self.triangles.extend(surface.triangles.iter().map(moved));
        self.points.extend(&surface.points);
        self.surface_of.resize(self.triangles.len(), number);
        self.label(surface, name);
        Ok(())
    }

    /// Gives the triangles of a surface their patches: unchanged if no other surface has labels yet, else the
    /// next free numbers.
    fn label(&mut self, surface: &Surface, name: &str) {
        let mut old_to_new = BTreeMap::new();
        let mut next = self.patches.iter().copied().max().unwrap_or(0).max(0) + 1;
        let is_taken = !self.patches.is_empty();
        for &old in &surface.patches {
            old_to_new.entry(old).or_insert_with(|| {
                let new = if is_taken || old <= 0 { next } else { old };
                next = next.max(new + 1);
                new
            });
        }
        for (old, &new) in &old_to_new {
            let own = surface.patch_names.get(old).cloned();
            let name = own.or_else(|| (*old == 0 || old_to_new.len() == 1).then(|| name.to_string()));
            self.patch_names.extend(name.map(|name| (new, name)));
        }
        self.patches.extend(surface.patches.iter().map(|old| old_to_new[old]));
    }

    /// Finds a patch by its name or number.
    ///
    /// # Errors
    /// When there is no such patch.
    pub fn find_patch(&self, word: &str) -> Result<i32> {
        let named = self.patch_names.iter().find(|(_, name)| *name == word).map(|(&id, _)| id);
        let numbered = || word.parse().ok().filter(|id| self.patches.contains(id));
        named.or_else(numbered).ok_or_else(|| {
            let mut known = self.patches.clone();
            known.sort_unstable();
            known.dedup();
            let name = |id: &i32| self.patch_names.get(id).cloned().unwrap_or_else(|| id.to_string());
            let known: Vec<String> = known.iter().map(name).collect();
            Error::options(format!("the surface has no patch `{word}`"))
                .remedy(format!("it has {}", known.join(", ")))
        })
    }

    /// Checks for everything that would stop these surfaces from being filled.
    pub fn preflight(&self, threads: &Threads) -> Preflight {
        preflight::preflight(&self.points, &self.triangles, &self.surface_of, &self.roles, threads)
    }

    /// Makes the requested repairs, and reports what was done. Surfaces that are united or wrapped are one
    /// afterwards.
    ///
    /// # Errors
    /// When the options are invalid, such as a negative distance.
    pub fn repair(&mut self, repairs: &Repairs, threads: &Threads) -> Result<Repaired> {
        if repairs.unite || repairs.wrap.is_some() {
            self.merge_boundaries();
        }
        let done = preflight::repair(
            &self.points,
            &self.triangles,
            &self.surface_of,
            &self.roles,
            repairs,
            threads,
        )?;
        self.patches = done.labels(&self.patches);
        self.points = done.points.clone();
        self.triangles = done.triangles.clone();
        self.surface_of = done.surface_of.clone();
        self.n_lost += done.count(RepairKind::DroppedThin);
        self.join();
        Ok(done)
    }

    /// Makes all boundaries one surface.
    fn merge_boundaries(&mut self) {
        let is_boundary = |s: usize| self.roles[s] == Role::Boundary;
        let Some(first) = (0..self.roles.len()).find(|&s| is_boundary(s)) else { return };
        let part_of: Vec<u32> =
            (0..self.roles.len()).map(|s| if is_boundary(s) { first } else { s } as u32).collect();
        self.merge(&part_of);
    }

    /// Removes points that no triangle uses: these may even lie on triangles.
    pub(super) fn compact(mut self) -> Self {
        let is_used = used_vertices(self.points.len(), self.triangles.as_flattened().iter());
        let (points, old_to_new) = compact(&self.points, &is_used);
        self.points = points;
        self.triangles = renamed(&self.triangles, &old_to_new);
        self
    }

    /// Removes triangles that have the same vertices as an earlier one.
    pub(super) fn without_shared(&self) -> Self {
        let mut kept = self.clone();
        kept.keep_firsts(|_, t| (0, t as u32));
        kept
    }
}
