//! How a wall is made, in words: what files, Python and other callers give.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::super::sizes::sizes_by;
use super::options::{Options, Thickness};
use crate::base::{Error, Result, read_text};
use crate::mesh::Mesh;
use crate::words;

words! {
    /// How a wall is made.
    pub struct WallWords {
        /// How thick the wall is, in the unit of the mesh: a number, or the name of an array of points or
        /// surface cells.
        thickness: Option<ThicknessWord> = None,
        /// How thick the wall is, as a part of the local radius: that of the largest ball that touches the
        /// surface from inside.
        of_radius: Option<f64> = None,
        /// The number of layers.
        layers: u32 = 1,
        /// The ratio of the thickness of each layer to that of the one inside it.
        growth: f64 = 1.0,
        /// The patches on which the wall stands, by name or number. By default all of the surface but caps:
        /// flat parts with a sharp crease all around.
        on: Vec<String> = Vec::new(),
        /// The layers stay wedges and pyramids instead of being divided into tets.
        keep_prisms: bool = false,
        /// The name of the wall's region.
        name: String = "wall".into(),
    }
}

/// How thick a wall is: a length, or an array that says it.
#[derive(Clone, Debug, PartialEq)]
pub enum ThicknessWord {
    /// This length.
    Length(f64),
    /// The array of this name.
    Array(String),
}

impl ThicknessWord {
    /// What a text denotes: a number, or else the name of an array.
    pub fn of_text(text: &str) -> Self {
        text.trim().parse().map_or_else(|_| Self::Array(text.to_owned()), Self::Length)
    }
}

impl Serialize for ThicknessWord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Length(length) => serializer.serialize_f64(*length),
            Self::Array(name) => serializer.serialize_str(name),
        }
    }
}

impl<'de> Deserialize<'de> for ThicknessWord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read_text(deserializer, |text| Ok(Self::of_text(text)))
    }
}

impl WallWords {
    /// The options that these words determine for a mesh.
    ///
    /// # Errors
    /// When the thickness is given not at all or twice, the mesh has no such array, or a value in it is not a
    /// length.
    pub fn options(&self, mesh: &Mesh) -> Result<Options> {
        let thickness = match (&self.thickness, self.of_radius) {
            (Some(ThicknessWord::Length(length)), None) => Thickness::Uniform(*length),
            (Some(ThicknessWord::Array(name)), None) => Thickness::AtPoints(sizes_by(mesh, name)?),
            (None, Some(part)) => Thickness::OfRadius(part),
            (given, _) => {
                let how =
                    if given.is_none() { "no thickness is given" } else { "the thickness is given twice" };
                return Err(Error::options(format!("{how} for the wall"))
                    .remedy("give a length, an array, or a part of the radius"));
            }
        };
        Ok(Options {
            layers: self.layers,
            growth: self.growth,
            on: self.on.clone(),
            keep_prisms: self.keep_prisms,
            name: self.name.clone(),
            ..Options::new(thickness)
        })
    }
}
