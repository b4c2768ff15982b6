//! The certificate: what was done, and what the mesh is worth.

use serde::Serialize;

use crate::base::reasons;
use crate::mesh::check::Defect;
use crate::meshing::Body;
use crate::remesh::{self, Left};

/// The result of refining the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Adapted {
    /// The requested edge length beside the devices.
    pub size: f64,
    /// How often tets were divided.
    pub generations: u32,
    /// Tets of the host as given.
    pub tets_before: usize,
    /// Tets of the host when it was carved.
    pub tets_after: usize,
}

/// How well a new surface fits the original one of a device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Fit {
    /// The largest distance of the new surface from the old one, at corners and at the middles of edges and
    /// triangles.
    pub to_old: f64,
    /// The largest distance of the old surface, where it bounds the device, from the new one, at the middles
    /// of edges and triangles.
    pub from_old: f64,
    /// The largest distance allowed.
    pub tolerance: f64,
}

impl Fit {
    /// Whether both distances are within the tolerance.
    pub fn is_reached(&self) -> bool {
        self.farthest() <= self.tolerance
    }

    /// The larger of the two distances.
    pub fn farthest(&self) -> f64 {
        self.to_old.max(self.from_old)
    }
}

/// What became of a device.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DeviceReport {
    /// The name of the device.
    pub name: String,
    /// The regions of the tets in it: one, or those of the tets that it keeps; none if it is hollow.
    pub regions: Vec<i32>,
    /// The patch of its surface.
    pub patch: i32,
    /// Triangles of its surface.
    pub triangles: usize,
    /// Triangles of its surface that are facets of the mesh as they were given.
    pub triangles_kept: usize,
    /// Triangles of its surface that were not kept, since it meets a wall of the host there.
    pub triangles_at_walls: usize,
    /// Triangles of its surface that were cut off with what lies outside.
    pub triangles_outside: usize,
    /// The patch of what it and walls of the host have in common, if that is an area.
    pub contact_patch: Option<i32>,
    /// How well its new surface fits, if it got one. Triangles and enclosed volume are then those of the new
    /// one.
    pub fit: Option<Fit>,
    /// The volume that its surface encloses; without the part outside of the host if that was cut off.
    pub enclosed: f64,
    /// The volume of its regions; 0 if it is hollow.
    pub volume: f64,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Joining and checking the devices.
    pub devices: f64,
    /// Refining the host.
    pub adapt: f64,
    /// Finding the tets to remove.
    pub carve: f64,
    /// Filling the cavity.
    pub fill: f64,
    /// Repairing.
    pub improve: f64,
    /// Joining everything, and carrying arrays.
    pub join: f64,
    /// Checking the mesh.
    pub check: f64,
}

/// What was done, and what the mesh is worth.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// How the host was refined; `None` if that was not necessary.
    pub adapted: Option<Adapted>,
    /// Tets of the host, after refinement.
    pub host_tets: usize,
    /// Tets of the host that were carved.
    pub carved: usize,
    /// Tets of the host that stayed, to the bit.
    pub kept: usize,
    /// [`kept`](Self::kept) as a fraction of [`host_tets`](Self::host_tets).
    pub kept_share: f64,
    /// Tets of the mesh.
    pub tets: usize,
    /// The devices, in their order.
    pub devices: Vec<DeviceReport>,
    /// The regions of the mesh.
    pub regions: Vec<Body>,
    /// The host's volume, less what hollow devices enclose of it, plus what is kept of devices outside of it.
    pub volume_expected: f64,
    /// The volume of the mesh.
    pub volume: f64,
    /// The report of the repair; its tets are cells of the mesh. Bad tets that are left are new ones.
    pub improved: remesh::Report,
    /// Bad tets of the host near the devices that are left as they were.
    pub host_left: Vec<Left>,
    /// The defects of the mesh; empty if it is sound.
    pub defects: Vec<Defect>,
    /// Seconds by stage.
    pub seconds: Seconds,
}

impl Report {
    /// Whether the mesh conforms and its tets are positive.
    pub fn is_valid(&self) -> bool {
        crate::mesh::check::is_conforming(&self.defects) && self.improved.after.inverted == 0
    }

    /// Whether the mesh is valid, every triangle of the devices is a facet, new surfaces are near enough, and
    /// no bad tet is left except those of the host and those that walls force.
    pub fn is_complete(&self) -> bool {
        self.not_reached().is_none()
    }

    /// Why the requested result was not reached; `None` if it was.
    pub fn not_reached(&self) -> Option<String> {
        let is_divided = |device: &&DeviceReport| {
            let n_at = device.triangles_at_walls + device.triangles_outside;
            device.triangles_kept + n_at != device.triangles
        };
        let is_far = |device: &&DeviceReport| device.fit.is_some_and(|fit| !fit.is_reached());
        let of_devices = |what: &str, is_so: &dyn Fn(&&DeviceReport) -> bool| {
            let names: Vec<&str> =
                self.devices.iter().filter(is_so).map(|device| device.name.as_str()).collect();
            (!names.is_empty()).then(|| format!("{what}: {}", names.join(", ")))
        };
        let n_inverted = self.improved.after.inverted;
        let n_unforced = self.n_unforced();
        reasons([
            (!crate::mesh::check::is_conforming(&self.defects))
                .then(|| "cells do not meet facet to facet: see the defects".to_owned()),
            (n_inverted > 0).then(|| format!("{n_inverted} tets are inverted or flat")),
            of_devices("triangles of devices are divided", &is_divided),
            of_devices("surfaces are farther from their devices than the tolerance", &is_far),
            (n_unforced > 0).then(|| format!("{n_unforced} bad tets are left that are not forced by a wall")),
        ])
    }

    /// How many of the bad new tets that are left are not forced by an angle of a wall.
    pub fn n_unforced(&self) -> usize {
        self.improved.left.iter().filter(|left| !left.reason.is_forced()).count()
    }

    /// The largest relative deviation of the volume of the mesh, and of that of each device's regions, from
    /// what it should be.
    pub fn volume_deviation(&self) -> f64 {
        let part = |is: f64, expected: f64| (is - expected).abs() / expected.abs().max(f64::MIN_POSITIVE);
        let of_devices = self.devices.iter().filter(|device| !device.regions.is_empty());
        let of_devices = of_devices.map(|device| part(device.volume, device.enclosed));
        of_devices.fold(part(self.volume, self.volume_expected), f64::max)
    }
}
