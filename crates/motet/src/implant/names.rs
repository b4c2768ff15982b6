//! Regions, patches and names of what is new.

use std::collections::{BTreeMap, BTreeSet};

use super::devices::Devices;
use super::layout::{Layout, Pieces};
use super::options::Inside;
use super::owner::{Owner, Patch};
use crate::base::VertexId;
use crate::mesh::{Labels, Mesh};

/// What follows the name of the device in the name of its contact patch.
const CONTACT: &str = "-contact";

/// The labels of what is new.
pub(super) struct Names {
    /// The arrays that hold regions and patches.
    arrays: [String; 2],
    /// The regions of each device; none for hollow ones.
    pub(super) regions: Vec<Vec<i32>>,
    /// The patch of each device.
    pub(super) patches: Vec<i32>,
    /// The patch of what each device has in common with walls, if anything.
    pub(super) contacts: Vec<Option<i32>>,
    /// The region of the host's tets, if the host has no regions.
    host: Option<i32>,
}

impl Names {
    pub(super) fn new(host: &Mesh, devices: &Devices, new_triangles: &[([VertexId; 3], Patch)]) -> Self {
        let [regions, patches] = [host.regions(), host.patches()];
        let last = |labels: &Option<Labels>, names: &BTreeMap<i32, String>| {
            let used = labels.as_ref().and_then(|labels| labels.ids.iter().max().copied()).unwrap_or(0);
            used.max(names.keys().max().copied().unwrap_or(0)).max(0)
        };
        let array = |labels: &Option<Labels>, name: &str| {
            labels.as_ref().map_or_else(|| name.to_owned(), |labels| labels.array.clone())
        };
        let mut next = last(&regions, &host.label_names.regions);
        let own = regions.is_none().then(|| {
            next += 1;
            next
        });
        let mut of_devices = Vec::new();
        for (inside, names) in devices.insides.iter().zip(&devices.region_names) {
            let n = if *inside == Inside::Hollow { 0 } else { names.len() as i32 };
            of_devices.push((next + 1..=next + n).collect());
            next += n;
        }
        let first = last(&patches, &host.label_names.patches) + 1;
        let n = devices.names.len();
        let mut contacts = vec![None; n];
        let met: BTreeSet<Patch> = new_triangles.iter().map(|(_, patch)| *patch).collect();
        let met = met.iter().filter_map(|patch| match patch {
            Patch::Contact(k) => Some(*k as usize),
            _ => None,
        });
        met.zip(first + n as i32..).for_each(|(k, patch)| contacts[k] = Some(patch));
        Self {
            arrays: [array(&regions, "region"), array(&patches, "patch")],
            regions: of_devices,
            patches: (first..).take(n).collect(),
            contacts,
            host: own,
        }
    }

    /// The patch of a new triangle; `None` if it keeps that of the triangle that it was a part of.
    fn patch(&self, patch: Patch) -> Option<i32> {
        match patch {
            Patch::Device(k) => Some(self.patches[k as usize]),
            Patch::Contact(k) => self.contacts[k as usize],
            Patch::Host(_) | Patch::Unlabelled => None,
        }
    }

    /// The region of a new tet.
    fn region(&self, owner: Owner) -> i32 {
        match owner {
            Owner::Host(region) => self.host.unwrap_or(region),
            Owner::Device(k) => self.regions[k as usize].first().copied().unwrap_or(0),
            Owner::Unfilled => 0,
        }
    }
}

/// Gives everything new its regions, patches and names.
pub(super) fn label(mesh: &mut Mesh, pieces: &Pieces, layout: &Layout, names: &Names) {
    let Pieces { devices, gap, draft, .. } = *pieces;
    let [of_tets, of_triangles] = &names.arrays;
    let (mut regions, mut patches) = (mesh.label_numbers(of_tets), mesh.label_numbers(of_triangles));
    if let Some(own) = names.host {
        for (cell, _) in mesh.cells.tets() {
            regions[cell.index()] = own.into();
        }
        mesh.label_names.regions.entry(own).or_insert_with(|| "host".to_owned());
    }
    let first = layout.n_host_cells;
    for (i, (_, patch)) in draft.triangles.iter().enumerate() {
        if let Some(patch) = names.patch(*patch) {
            (regions[first + i], patches[first + i]) = (0, patch.into());
        }
    }
    let first = first + draft.triangles.len();
    let own = gap.own_tets.iter().map(|tet| names.regions[tet.device as usize][tet.region as usize]);
    for (i, region) in draft.owners.iter().map(|owner| names.region(*owner)).chain(own).enumerate() {
        (regions[first + i], patches[first + i]) = (region.into(), 0);
    }
    mesh.set_labels(&names.arrays, regions, patches);
    for (k, name) in devices.names.iter().enumerate() {
        mesh.label_names.patches.insert(names.patches[k], name.clone());
        if let Some(patch) = names.contacts[k] {
            mesh.label_names.patches.insert(patch, format!("{name}{CONTACT}"));
        }
        let regions = names.regions[k].iter().copied().zip(devices.region_names[k].iter().cloned());
        mesh.label_names.regions.extend(regions);
    }
}
