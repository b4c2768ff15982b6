//! What is put in, and how.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::geometry::vector::LARGEST;
use crate::mesh::{CellKind, Mesh};
use crate::meshing::MOST_GROWTH;
use crate::names;
use crate::remesh;

/// A device: a closed surface, or a mesh of tets.
#[derive(Clone, Debug)]
pub struct Device {
    /// The mesh of the device: the surface cells, or the boundary of the volume cells if there are none or
    /// the tets are kept.
    pub mesh: Mesh,
    /// The name of its region and its patch.
    pub name: String,
    /// What becomes of the space in it.
    pub inside: Inside,
}

names! {
    /// What becomes of the space in a device.
    pub enum Inside: "inside" {
        /// The device's own tets, as they are.
        Own = "own",
        /// New tets, in a region of their own.
        Filled = "fill",
        /// Nothing: its surface bounds the mesh.
        Hollow = "hollow",
    }
}

names! {
    /// What part of the host is refined towards devices before it is carved.
    ///
    /// What is carved is filled anew, and the sizes of new tets grow from the devices to the host by
    /// themselves. So as a rule only walls of the host need refinement: they stay, and tets between a device
    /// and a nearby wall whose facets are far larger than the gap would be bad.
    pub enum Adapt: "adapt" {
        /// Walls (boundary, interfaces, labelled facets) nearer to a device than half the length of their
        /// edges: these cannot be carved.
        Walls = "walls",
        /// Nothing.
        No = "none",
        /// Everything nearby, by `size` and `growth`: fields then keep their values, since each new tet is
        /// a part of an old one.
        All = "all",
    }
}

names! {
    /// What becomes of the part of a device outside of the host, where it passes through the host's boundary.
    pub enum Outside: "outside" {
        /// It is cut off; the host's wall bounds the device there.
        Cut = "cut",
        /// It is kept; the host's wall ends at the device.
        Keep = "keep",
    }
}

impl Device {
    /// A device that keeps its tets if it has any, and is filled otherwise.
    pub fn new(mesh: Mesh, name: impl Into<String>) -> Self {
        let has_tets = mesh.cells.kinds().contains(&CellKind::TETRA);
        Self { mesh, name: name.into(), inside: if has_tets { Inside::Own } else { Inside::Filled } }
    }
}

/// What the surface of a device becomes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Interface {
    /// Each of its triangles is a facet of the result. It has to be closed, and must not cross itself.
    #[default]
    Match,
    /// A new surface near it: for devices that touch or cross themselves, have open ends or duplicate
    /// triangles, or consist of bad triangles. They are filled or hollow.
    Conform {
        /// How far the new surface may be from the old one, and the old one from it; `None`: a fifth of the
        /// radius of a round wire as thick as the device. If that is not reached, the nearest surface found
        /// is taken (a finer one only if it is nearer by a tenth), and the report says so.
        tolerance: Option<f64>,
    },
}

/// How devices are put in.
#[derive(Clone, Debug)]
pub struct Options {
    /// What surfaces of devices become. Default: [`Interface::Match`].
    pub interface: Interface,
    /// What becomes of the parts of devices outside of the host. Default: [`Outside::Cut`].
    pub outside: Outside,
    /// How far surfaces may stray where devices meet walls, so that no narrow triangles stay there; `None`: a
    /// twentieth of the device's edge length. 0: not at all. Default: `None`.
    pub stray: Option<f64>,
    /// The edge length beside the devices where the host is refined, and that of new surfaces, in the unit of
    /// the host; `None`: in the host that of the devices, on new surfaces what their tolerance requires.
    /// Default: `None`.
    pub size: Option<f64>,
    /// How much sizes grow per unit of distance from the devices, above 0 and at most [`MOST_GROWTH`].
    /// Default: 0.5.
    pub growth: f64,
    /// What part of the host is refined before it is carved. Default: [`Adapt::Walls`].
    pub adapt: Adapt,
    /// Tets of the host nearer to a device than this multiple of their edge length are replaced. Default: 1.
    pub carve: f64,
    /// Tets of the host farther from all devices than this multiple of their edge length stay, to the bit.
    /// Default: 3.
    pub reach: f64,
    /// Initial values of arrays of the host in devices, by name, with one number for each component; also at
    /// points that no cell of the host has. Other arrays, and arrays where nothing is given, have what the
    /// host had there. Default: none.
    pub starts: BTreeMap<String, Vec<f64>>,
    /// What is repaired at the end, within [`reach`](Self::reach). Default: tets of an EAS below 0.2.
    pub improve: remesh::Options,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            interface: Interface::Match,
            outside: Outside::Cut,
            stray: None,
            size: None,
            growth: 0.5,
            adapt: Adapt::Walls,
            carve: 1.0,
            reach: 3.0,
            starts: BTreeMap::new(),
            improve: remesh::Options::default(),
        }
    }
}

impl Options {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Names the first number that is out of range.
    pub(super) fn check(&self) -> Result<()> {
        let refused = |what: String, remedy: &str| Err(Error::options(what).remedy(remedy));
        if let Some(size) = self.size.filter(|size| !(*size > 0.0 && *size <= LARGEST)) {
            return refused(
                format!("the size is {size}, expected a length above 0 and at most {LARGEST:e}"),
                "leave it out",
            );
        }
        if let Some(stray) = self.stray.filter(|stray| !(*stray >= 0.0 && *stray <= LARGEST)) {
            return refused(
                format!("surfaces may stray by {stray}, expected a length of at least 0"),
                "leave it out",
            );
        }
        if let Interface::Conform { tolerance: Some(tolerance) } = self.interface
            && !(tolerance > 0.0 && tolerance <= LARGEST)
        {
            return refused(
                format!("the tolerance is {tolerance}, expected a length above 0"),
                "leave it out",
            );
        }
        if !(self.growth > 0.0 && self.growth <= MOST_GROWTH) {
            let what = format!(
                "the growth of sizes is {}, expected more than 0 and at most {MOST_GROWTH}",
                self.growth
            );
            return refused(what, "0.5 is the default");
        }
        if !(self.carve > 0.0 && self.carve <= self.reach && self.reach <= LARGEST) {
            let what = format!(
                "tets within {} edge lengths of a device are to be replaced, and those beyond {} edge lengths \
                 to stay",
                self.carve, self.reach
            );
            return refused(what, "give numbers above 0, the second at least as large as the first");
        }
        self.improve.check()
    }
}
