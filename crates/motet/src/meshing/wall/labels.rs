//! Regions, patches and names of a wall.

use std::collections::BTreeMap;

use super::super::layers::EndFacet;
use super::lumen::Lumen;
use crate::mesh::{Labels, Mesh, unused_name};

/// The name of the region inside, where it has none.
const INSIDE: &str = "fluid";

/// The name of the patch on the outer side of a wall.
const OUTER: &str = "outer";

/// The labels of what a wall adds.
pub(super) struct WallLabels {
    /// The array that holds each: regions, patches.
    arrays: [String; 2],
    /// The region of the volume cells inside, if they have none.
    inside: Option<i32>,
    pub(super) region: i32,
    pub(super) region_name: String,
    /// The patch of triangles that lumen and wall share and that have none.
    pub(super) interface: i32,
    pub(super) outer: i32,
    pub(super) patch_names: BTreeMap<i32, String>,
    /// The patches of ends, by the patch of the cap; 0 for caps without one.
    ends: BTreeMap<i32, i32>,
}

impl WallLabels {
    /// Chooses labels that the mesh does not have yet. An end beside the cap `inlet` is called
    /// `NAME_inlet`, one without a cap `NAME_end`.
    pub(super) fn new(mesh: &Mesh, lumen: &Lumen, ends: &[EndFacet], name: &str) -> Self {
        let [regions, patches] = [mesh.regions(), mesh.patches()];
        let array = |labels: &Option<Labels>, name: &str| {
            labels.as_ref().map_or_else(|| name.to_owned(), |labels| labels.array.clone())
        };
        let (region_names, mut patch_names) = (&mesh.label_names.regions, lumen.surfaces.patch_names.clone());
        patch_names.extend(mesh.label_names.patches.clone());
        let inside = (lumen.is_volume() && regions.is_none()).then_some(1);
        let used = regions.as_ref().map_or_else(Vec::new, Labels::used);
        let last = used.iter().chain(region_names.keys()).copied().max().unwrap_or(0);
        let region = 1 + last.max(inside.unwrap_or(0)).max(0);
        let used = lumen.surfaces.patches.iter().chain(patch_names.keys()).copied();
        let mut next =
            used.chain(patches.as_ref().map_or_else(Vec::new, Labels::used)).max().unwrap_or(0).max(0);
        let mut add = |name: &str| {
            next += 1;
            let name = unused_name(name, |name| patch_names.values().any(|known| known == name));
            patch_names.insert(next, name);
            next
        };
        let (interface, outer) = (add(super::lumen::INTERFACE), add(OUTER));
        let mut of_caps = BTreeMap::new();
        let mut caps: Vec<i32> = ends.iter().map(|end| lumen.cap_at(end)).collect();
        caps.sort_unstable();
        caps.dedup();
        for cap in caps {
            let of = lumen.surfaces.patch_names.get(&cap).cloned();
            let of = of.unwrap_or_else(|| if cap == 0 { "end".into() } else { cap.to_string() });
            of_caps.insert(cap, add(&format!("{name}_{of}")));
        }
        let region_name = unused_name(name, |name| region_names.values().any(|known| known == name));
        Self {
            arrays: [array(&regions, "region"), array(&patches, "patch")],
            inside,
            region,
            region_name,
            interface,
            outer,
            patch_names,
            ends: of_caps,
        }
    }

    /// The patch of an end.
    pub(super) fn end(&self, lumen: &Lumen, end: &EndFacet) -> i32 {
        self.ends.get(&lumen.cap_at(end)).copied().unwrap_or(0)
    }

    /// The names of the patches at ends.
    pub(super) fn end_names(&self) -> Vec<String> {
        self.ends.values().map(|patch| self.patch_names[patch].clone()).collect()
    }

    /// Writes labels and names: `new` has the label of each cell after the first `n_base`.
    pub(super) fn write(&self, mesh: &mut Mesh, lumen: &Lumen, n_base: usize, new: &[i32]) {
        let dims: Vec<Option<usize>> = mesh.cells.kinds().iter().map(|kind| kind.dim()).collect();
        let mut both = self.arrays.each_ref().map(|array| mesh.label_numbers(array));
        if let Some(inside) = self.inside {
            (0..n_base).filter(|&i| dims[i] == Some(3)).for_each(|i| both[0][i] = inside.into());
            mesh.label_names.regions.insert(inside, INSIDE.into());
        }
        if !lumen.is_volume() {
            // The cells of the base are the triangles on which the wall stands.
            let on = (0..lumen.n_real).filter(|&t| lumen.on[t]);
            on.zip(0..).for_each(|(t, i): (usize, usize)| both[1][i] = lumen.surfaces.patches[t].into());
        }
        for (i, &label) in (n_base..).zip(new) {
            let own = usize::from(dims[i] != Some(3));
            both[own][i] = label.into();
            both[1 - own][i] = 0;
        }
        let [regions, patches] = both;
        mesh.set_labels(&self.arrays, regions, patches);
        mesh.label_names.regions.insert(self.region, self.region_name.clone());
        let used: Vec<i32> = mesh.patches().map_or_else(Vec::new, |patches| patches.used());
        let names = self.patch_names.iter().filter(|(patch, _)| used.contains(patch));
        mesh.label_names.patches.extend(names.map(|(patch, name)| (*patch, name.clone())));
    }
}
