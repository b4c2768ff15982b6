//! What is repaired, in words: what files, Python and other callers give.

use serde::{Deserialize, Serialize};

use crate::base::{Error, Result};
use crate::mesh::Mesh;
use crate::remesh::held::Held;
use crate::remesh::options::{Goal, Options, SurfaceRule};
use crate::remesh::sizes::Sizes;
use crate::{names, words};

words! {
    /// What is repaired, and how.
    pub struct RemeshWords {
        /// Tets below this EAS are bad.
        min_eas: f64 = Options::default().min_eas,
        /// Tets with a dihedral angle below this, in degrees, are bad, too: the least EAS is raised to the
        /// one that guarantees it, 0.014 per degree.
        min_dihedral_deg: f64 = Options::default().min_dihedral_deg,
        /// When to stop.
        goal: GoalName = GoalName::default(),
        /// What may happen to the boundary, to interfaces of regions and to surface cells.
        surface: SurfaceName = SurfaceName::default(),
        /// How far a surface that may change may stray from where it was, in the unit of the mesh. By default
        /// a thousandth of the largest extent.
        distance: Option<f64> = None,
        /// Whether thin tets of boundary layers at walls, whose angles would count as bad, stay as they are
        /// and count as good, or are repaired like any bad tet.
        keep_layers: bool = Options::default().keep_layers,
        /// Regions whose tets, and patches whose triangles, stay to the bit, with their vertices; by name or
        /// number.
        hold: Vec<String> = Vec::new(),
        /// Edges are brought to this length, or to the value of a point array. By default they stay as long
        /// as they are.
        sizes: Option<EdgeLengths> = None,
        /// The largest number of rounds over the bad tets.
        rounds: usize = Options::default().rounds,
    }
}

impl RemeshWords {
    /// The options that these words determine for a mesh; all others have their defaults.
    ///
    /// # Errors
    /// As [`Self::check`]; or when the mesh has no region, patch or array of a name.
    pub fn options(&self, mesh: &Mesh) -> Result<Options> {
        Ok(Options {
            held: Held::of_names(mesh, &self.hold)?,
            sizes: self.sizes.as_ref().map(|sizes| sizes.at_points(mesh)).transpose()?,
            ..self.of_any_mesh()?
        })
    }

    /// Checks all that does not depend on a mesh, for callers that have not read theirs yet.
    ///
    /// # Errors
    /// When a number is out of its range, or a distance is given for a surface that is kept.
    pub fn check(&self) -> Result<()> {
        self.of_any_mesh().map(drop)
    }

    /// The options without those that depend on a mesh.
    fn of_any_mesh(&self) -> Result<Options> {
        let options = Options {
            min_eas: self.min_eas,
            min_dihedral_deg: self.min_dihedral_deg,
            goal: self.goal.into(),
            surface: self.surface.within(self.distance)?,
            keep_layers: self.keep_layers,
            rounds: self.rounds,
            ..Options::default()
        };
        options.check()?;
        Ok(options)
    }
}

names! {
    /// The name of a [`Goal`].
    pub enum GoalName: "goal" {
        /// When no bad tet is left, with as few tets touched as possible.
        Repair = "repair",
        /// When the worst tets everywhere are as good as they get.
        Best = "best",
    }
}

impl From<GoalName> for Goal {
    fn from(name: GoalName) -> Self {
        match name {
            GoalName::Repair => Self::Repair,
            GoalName::Best => Self::Best,
        }
    }
}

names! {
    /// The name of a [`SurfaceRule`].
    pub enum SurfaceName: "surface rule" {
        /// Nothing: surfaces stay to the bit.
        Keep = "keep",
        /// They may change within the distance; creases, corners and borders of patches stay.
        Adapt = "adapt",
        /// They may change within the distance; so may creases and corners where nothing else helps.
        Loose = "loose",
    }
}

impl SurfaceName {
    /// The rule with this name and distance.
    ///
    /// # Errors
    /// When a distance is given for a surface that is kept.
    pub fn within(self, distance: Option<f64>) -> Result<SurfaceRule> {
        match (self, distance) {
            (Self::Keep, None) => Ok(SurfaceRule::Keep),
            (Self::Keep, Some(_)) => {
                Err(Error::options("a distance bounds how far a surface may stray, but this one is kept")
                    .remedy("let the surface `adapt`, or leave the distance out"))
            }
            (Self::Adapt, distance) => Ok(SurfaceRule::Adapt { distance }),
            (Self::Loose, distance) => Ok(SurfaceRule::Loose { distance }),
        }
    }
}

/// Requested edge lengths: a number, the name of an array, or a list of numbers.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum EdgeLengths {
    /// One length everywhere.
    Everywhere(f64),
    /// The point array that has the length at each point.
    Array(String),
    /// The length at each point.
    Points(Vec<f64>),
}

impl EdgeLengths {
    /// The lengths that a text denotes: a number, or else the name of a point array.
    ///
    /// # Errors
    /// When the number is not a length.
    pub fn of_text(text: &str) -> Result<Self> {
        match text.parse::<f64>() {
            Ok(h) if 0.0 < h && h < f64::INFINITY => Ok(Self::Everywhere(h)),
            Ok(_) => Err(Error::options("a number above 0 is expected, or the name of a point array")),
            Err(_) => Ok(Self::Array(text.to_owned())),
        }
    }

    /// The sizes at the points of a mesh.
    ///
    /// # Errors
    /// When the mesh has no point array of this name, or one without a number for each point.
    fn at_points(&self, mesh: &Mesh) -> Result<Sizes> {
        let name = match self {
            Self::Everywhere(h) => return Ok(Sizes::Uniform(*h)),
            Self::Points(all) => return Ok(Sizes::Vertices(all.clone())),
            Self::Array(name) => name,
        };
        let field = mesh.point_field(name).ok_or_else(|| unknown_array(mesh, name))?;
        let sizes = field.values.to_f64().filter(|_| field.components == 1).ok_or_else(|| {
            Error::input("does not have one number for each point, as sizes require")
                .at(format!("array {name}"))
                .remedy("give an array of one component")
        })?;
        Ok(Sizes::Vertices(sizes))
    }
}

fn unknown_array(mesh: &Mesh, name: &str) -> Error {
    let known: Vec<&str> = mesh.point_data.iter().map(|field| field.name.as_str()).collect();
    let what = format!("edge lengths: `{name}` is neither a number nor a point array of the mesh");
    Error::options(what).remedy(match known[..] {
        [] => "give a number above 0: the mesh has no point arrays".to_owned(),
        _ => format!("give a number above 0 or one of its point arrays: {}", known.join(", ")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Field, shapes};

    fn options(text: &str) -> Result<Options> {
        serde_json::from_str::<RemeshWords>(text).unwrap().options(&shapes::sphere_in_box(2, 1))
    }

    #[test]
    fn a_table_of_json_becomes_options() {
        let text =
            r#"{"goal": "best", "surface": "loose", "distance": 0.1, "hold": ["sphere"], "sizes": 0.3}"#;
        let options = options(text).unwrap();
        assert_eq!(options.goal, Goal::Best);
        assert_eq!(options.surface, SurfaceRule::Loose { distance: Some(0.1) });
        assert_eq!((options.held.patches.len(), options.sizes), (1, Some(Sizes::Uniform(0.3))));
    }

    #[test]
    fn the_defaults_are_those_of_the_options() {
        let [words, usual] = [options("{}").unwrap(), Options::default()];
        assert_eq!(serde_json::to_string(&words).unwrap(), serde_json::to_string(&usual).unwrap());
    }

    #[test]
    fn what_no_mesh_can_have_is_refused_without_one() {
        for (words, part) in [
            (RemeshWords { distance: Some(0.1), ..RemeshWords::default() }, "this one is kept"),
            (RemeshWords { min_eas: -0.1, ..RemeshWords::default() }, "got -0.1"),
            (RemeshWords { min_dihedral_deg: 80.0, ..RemeshWords::default() }, "got 80"),
        ] {
            let error = words.check().unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        let unknown = RemeshWords { hold: vec!["nothing".into()], ..RemeshWords::default() };
        assert!(unknown.check().is_ok() && unknown.options(&shapes::sphere_in_box(2, 1)).is_err());
    }

    #[test]
    fn edge_lengths_are_a_number_or_an_array() {
        let mut mesh = shapes::sphere_in_box(2, 1);
        let n = mesh.points.len();
        mesh.set_point_field(Field::scalars("h", vec![0.5; n]));
        mesh.set_point_field(Field::vectors("u", &vec![[0.5; 3]; n]));
        let of = |text: &str| EdgeLengths::of_text(text).and_then(|lengths| lengths.at_points(&mesh));
        assert_eq!(of("0.3").unwrap(), Sizes::Uniform(0.3));
        assert_eq!(of("h").unwrap(), Sizes::Vertices(vec![0.5; n]));
        for (text, part) in
            [("0", "above 0"), ("nan", "above 0"), ("g", "arrays: h, u"), ("u", "one component")]
        {
            assert!(of(text).is_err_and(|error| error.to_string().contains(part)), "{text}");
        }
    }
}
