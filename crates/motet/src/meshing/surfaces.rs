//! Surfaces of several meshes as one set of points and triangles.

use std::collections::BTreeMap;

use super::compact::{compact, named};
use crate::base::{Error, Point, Result, Threads, VertexId, rising};
use crate::mesh::{Mesh, Surface, firsts_at_place};
use crate::preflight::{self, Preflight, Repaired, Repairs, Role, renamed};

/// Surfaces to be filled, joined: points at one place are one vertex.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// The points of all meshes, one mesh after the other, also those that no triangle uses.
    pub points: Vec<Point>,
    /// The triangles of all meshes.
    pub triangles: Vec<[VertexId; 3]>,
    /// Which mesh each triangle is of.
    pub surface_of: Vec<u32>,
    /// What each mesh is.
    pub roles: Vec<Role>,
    /// The name that each mesh came with.
    pub names: Vec<String>,
    /// The patch of each triangle. Where no mesh but one has labels of its own, those; otherwise new ones.
    pub patches: Vec<i32>,
    /// Names of patches, where there are any.
    pub patch_names: BTreeMap<i32, String>,
}

impl Surfaces {
    /// Joins the surface cells of meshes; of a mesh without any, the boundary of its volume cells. Each comes with a name for its triangles,
    /// which they take where they have no patches.
    ///
    /// # Errors
    /// When there is no mesh, or more points than can be counted.
    pub fn new(meshes: &[(&Mesh, Role, &str)]) -> Result<Self> {
        let mut all = Self {
            points: Vec::new(),
            triangles: Vec::new(),
            surface_of: Vec::new(),
            roles: meshes.iter().map(|m| m.1).collect(),
            names: meshes.iter().map(|m| m.2.to_owned()).collect(),
            patches: Vec::new(),
            patch_names: BTreeMap::new(),
        };
        for (number, &(mesh, _, name)) in meshes.iter().enumerate() {
            all.add(mesh, number as u32, name)?;
        }
        let kept = firsts_at_place(&all.points);
        all.triangles = renamed(&all.triangles, &kept);
        Ok(all)
    }

    fn add(&mut self, mesh: &Mesh, number: u32, name: &str) -> Result<()> {
        let mut surface = Surface::of(mesh);
        if surface.triangles.is_empty() {
            surface = Surface::boundary_of(mesh);
        }
        let first = self.points.len();
        if first + surface.points.len() > VertexId::MAX_COUNT {
            return Err(
                Error::input("more points than can be counted").remedy("mesh the surfaces one by one")
            );
        }
        let moved = |t: &[VertexId; 3]| t.map(|v| VertexId::new(first + v.index()));
        self.triangles.extend(surface.triangles.iter().map(moved));
        self.points.extend(&surface.points);
        self.surface_of.resize(self.triangles.len(), number);
        self.label(&surface, name);
        Ok(())
    }

    /// Gives the triangles of a surface their patches: as they are where no other surface has them, else the next numbers that are free.
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
            let name = own.or_else(|| (*old == 0).then(|| name.to_string()));
            self.patch_names.extend(name.map(|name| (new, name)));
        }
        self.patches.extend(surface.patches.iter().map(|old| old_to_new[old]));
    }

    /// What would stop these surfaces from being filled.
    pub fn preflight(&self, threads: &Threads) -> Preflight {
        preflight::preflight(&self.points, &self.triangles, &self.surface_of, &self.roles, threads)
    }

    /// Mends what is asked for, and tells what was done.
    ///
    /// # Errors
    /// When the repairs mean nothing, such as a distance below 0.
    pub fn repair(&mut self, repairs: &Repairs, threads: &Threads) -> Result<Repaired> {
        let done = preflight::repair(
            &self.points,
            &self.triangles,
            &self.surface_of,
            &self.roles,
            repairs,
            threads,
        )?;
        self.patches = done.labels(&self.patches);
        self.triangles = done.triangles.clone();
        self.surface_of = done.surface_of.clone();
        Ok(done)
    }

    /// Without points that no triangle uses: they need not even be apart from the triangles.
    pub(super) fn compact(mut self) -> Self {
        let is_used = named(self.points.len(), self.triangles.as_flattened().iter());
        let (points, old_to_new) = compact(&self.points, &is_used);
        self.points = points;
        self.triangles = renamed(&self.triangles, &old_to_new);
        self
    }

    /// Without triangles that an earlier surface has as well.
    pub(super) fn without_shared(&self) -> Self {
        let mut order: Vec<(u32, [VertexId; 3])> =
            self.triangles.iter().map(|&t| rising(t)).zip(0..).map(|(t, i)| (i, t)).collect();
        order.sort_unstable_by_key(|&(i, t)| (t, i));
        let mut is_kept = vec![true; self.triangles.len()];
        for pair in order.windows(2) {
            is_kept[pair[1].0 as usize] &= pair[0].1 != pair[1].1;
        }
        fn keep<T: Copy>(all: &[T], is_kept: &[bool]) -> Vec<T> {
            all.iter().zip(is_kept).filter(|(_, kept)| **kept).map(|(x, _)| *x).collect()
        }
        Self {
            triangles: keep(&self.triangles, &is_kept),
            surface_of: keep(&self.surface_of, &is_kept),
            patches: keep(&self.patches, &is_kept),
            ..self.clone()
        }
    }
}
