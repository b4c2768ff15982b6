//! How devices are put into a mesh, in words: what files, Python and other callers give.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::implant::options::{Adapt, Device, Inside, Interface, Options, Outside};
use crate::mesh::Mesh;
use crate::{names, remesh, words};

names! {
    /// The name of an [`Interface`].
    pub enum InterfaceName: "interface" {
        /// Each triangle of a device is a facet of the mesh.
        Match = "match",
        /// A new surface is made near that of a device, within `tolerance`: for devices that touch or cross
        /// themselves, have open ends or bad triangles.
        Conform = "conform",
    }
}

words! {
    /// How devices are put into a mesh.
    pub struct ImplantWords {
        /// What becomes of the space inside devices. With `own` those without tets are filled.
        inside: Inside = Inside::default(),
        /// What the surfaces of devices become.
        interface: InterfaceName = InterfaceName::default(),
        /// How far new surfaces may be from the old ones, in the unit of the host, with the interface
        /// `conform`. By default a fifth of the radius of a wire as thick as the device.
        tolerance: Option<f64> = None,
        /// What becomes of the part of a device outside the host, where it passes through the host's
        /// boundary.
        outside: Outside = Options::default().outside,
        /// How far surfaces may stray where a device meets a wall, in the unit of the host, so that no narrow
        /// triangles stay there. 0: not at all. By default a twentieth of the device's edges.
        stray: Option<f64> = Options::default().stray,
        /// What part of the host is refined near devices before it is carved.
        adapt: Adapt = Options::default().adapt,
        /// The length of edges beside devices where the host is refined, and on new surfaces, in the unit of
        /// the host. By default that of the devices' edges, and what `tolerance` requires.
        size: Option<f64> = Options::default().size,
        /// How much edge lengths grow per unit of distance from devices, above 0 and at most 0.7.
        growth: f64 = Options::default().growth,
        /// Tets of the host nearer to a device than this multiple of their edge length are replaced.
        carve: f64 = Options::default().carve,
        /// Tets of the host farther from all devices than this multiple of their edge length stay, to the
        /// bit.
        reach: f64 = Options::default().reach,
        /// Tets within `reach` below this EAS are repaired.
        min_eas: f64 = Options::default().improve.min_eas,
        /// Initial values of arrays of the host in devices, by name, with a number for each component. By
        /// default what the host had there.
        values: BTreeMap<String, Vec<f64>> = Options::default().starts,
    }
}

impl ImplantWords {
    /// The options that these words determine; all others have their defaults.
    ///
    /// # Errors
    /// If a number is out of range, or a tolerance is given although the triangles of devices are kept.
    pub fn options(&self) -> Result<Options> {
        let options = Options {
            interface: self.interface()?,
            outside: self.outside,
            stray: self.stray,
            size: self.size,
            growth: self.growth,
            adapt: self.adapt,
            carve: self.carve,
            reach: self.reach,
            starts: self.values.clone(),
            improve: remesh::Options { min_eas: self.min_eas, ..Options::default().improve },
        };
        options.check()?;
        Ok(options)
    }

    fn interface(&self) -> Result<Interface> {
        match (self.interface, self.tolerance) {
            (InterfaceName::Match, None) => Ok(Interface::Match),
            (InterfaceName::Conform, tolerance) => Ok(Interface::Conform { tolerance }),
            (InterfaceName::Match, Some(_)) => Err(Error::options(
                "a tolerance applies to new surfaces, but the triangles of devices are to be kept",
            )
            .remedy("use `conform` for the interface, or leave the tolerance out")),
        }
    }

    /// A device with this mesh and this name.
    pub fn device(&self, mesh: Mesh, name: impl Into<String>) -> Device {
        let device = Device::new(mesh, name);
        match self.inside {
            Inside::Own => device,
            inside => Device { inside, ..device },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellKind, Cells, Surface, shapes};

    fn read(text: &str) -> ImplantWords {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn a_table_of_json_becomes_options() {
        let words =
            read(r#"{"interface": "conform", "tolerance": 0.1, "adapt": "none", "values": {"p": [1]}}"#);
        let options = words.options().unwrap();
        assert_eq!(options.interface, Interface::Conform { tolerance: Some(0.1) });
        assert_eq!((options.adapt, options.outside), (Adapt::No, Outside::Cut));
        assert_eq!(options.starts["p"], [1.0]);
    }

    #[test]
    fn the_defaults_are_those_of_the_options() {
        let (words, usual) = (ImplantWords::default().options().unwrap(), Options::default());
        assert_eq!(format!("{words:?}"), format!("{usual:?}"));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |text: &str| read(text).options().unwrap_err().to_string();
        assert!(error(r#"{"tolerance": 0.1}"#).contains("use `conform`"));
        assert!(error(r#"{"growth": 5}"#).contains("the growth of sizes is 5"));
        let unknown = serde_json::from_str::<ImplantWords>(r#"{"outside": "ceep"}"#).unwrap_err();
        assert!(unknown.to_string().contains("did you mean `keep`?"), "{unknown}");
    }

    #[test]
    fn devices_keep_their_tets_where_they_have_some() {
        let tets = shapes::ball(2, 1);
        let Surface { points, triangles, .. } = Surface::boundary_of(&tets);
        let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened()).unwrap();
        let surface = Mesh::new(points, cells);
        let inside = |text: &str, mesh: &Mesh| read(text).device(mesh.clone(), "device").inside;
        assert_eq!(inside("{}", &tets), Inside::Own);
        assert_eq!(inside("{}", &surface), Inside::Filled);
        assert_eq!(inside(r#"{"inside": "fill"}"#, &tets), Inside::Filled);
        assert_eq!(inside(r#"{"inside": "hollow"}"#, &surface), Inside::Hollow);
    }
}
