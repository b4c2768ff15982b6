//! How a mesh follows its walls, in words, with patches by name: what files, Python and other callers give.

use std::fmt;

use serde::de::{self, Deserializer};
use serde::{Deserialize, Serialize, Serializer};

use crate::base::{Error, Result, VertexId, one_of, read_named};
use crate::mesh::{Boundary, Mesh};
use crate::motion::options::{
    Elastic, Extent, FacetSet, Laplace, Limits, Method, Options, RigidLayer, SlideTolerance, Strain,
};
use crate::words;

words! {
    /// How the inside of a mesh follows its walls. Patches are given by name or number: ids of cells do not
    /// outlast a change of the mesh.
    pub struct Motion {
        /// How vertices inside follow the walls: `delaunay`, `bodies`, `guided`, `elastic`, `laplace`, `idw`
        /// or `rbf`.
        method: MethodName = MethodName::Delaunay,
        /// Patches that each move as a rigid body, with the method `bodies`; a patch inside, such as that
        /// between fluid and solid, carries what it encloses. Without any, each connected part of the walls
        /// is a body, except the outer one.
        bodies: Vec<String> = Vec::new(),
        /// Where `bodies` put the strain: `band`, beside them, or `even`, over all that lies between them and
        /// walls that stay. By default `even`; in a run, `band` where a body moves on or far.
        strain: Option<Strain> = None,
        /// Sweeps of smoothing after each step: vertices of bad tets, and no others, move to where their tets
        /// are better. 2 are enough.
        smooth: usize = 0,
        /// All that is nearer to the wall than this moves rigidly with it: a distance in the unit of the
        /// mesh, or layers of cells such as `3layers`.
        rigid_layer: Option<Extent> = None,
        /// Patches that have the rigid layer. Without any, all that do not slide.
        rigid_layer_at: Vec<String> = Vec::new(),
        /// Keeps the graph within the walls, so that no vertex follows the wall of another branch, or the far
        /// side of a flap. Facets of the boundary must not cross or touch each other.
        within_walls: bool = false,
        /// Flat patches whose vertices slide in their plane, following the rim; where two such patches meet,
        /// they slide along the line; where three meet, they stay.
        slide: Vec<String> = Vec::new(),
        /// How far vertices of a sliding patch may be off its plane, as a fraction of its radius.
        slide_tolerance: f64 = SlideTolerance::DEFAULT.0,
        /// Patches inside the volume whose vertices are driven, such as a flap.
        inside: Vec<String> = Vec::new(),
        /// The relative residual to which methods with a linear system solve it.
        residual: f64 = Elastic::default().tolerance.residual,
        /// Keeps a factorisation of the system's matrix from step to step, where it takes at most this many
        /// GiB: steps are faster, setting up takes longer.
        factor_gib: f64 = 0.0,
        /// The largest number of parts in which a step is done where cells would invert.
        substeps: usize = Limits::default().substeps,
    }
}

impl Motion {
    /// The options for a mesh as it is now, with patches by their facets.
    ///
    /// # Errors
    /// When the mesh has no patch of a name, or a word does not fit the method.
    pub fn options(&self, mesh: &Mesh) -> Result<Options> {
        let facets = |words: &[String]| -> Result<Vec<FacetSet>> {
            words.iter().map(|word| FacetSet::find(mesh, word)).collect()
        };
        self.options_on(MotionParts {
            bodies: facets(&self.bodies)?,
            wall: FacetSet::joined(facets(&self.rigid_layer_at)?),
            sliding: facets(&self.slide)?,
            also_moved: self.driven_inside(mesh)?,
        })
    }

    /// The options for parts of a mesh that are given by their facets: names of patches are not looked up.
    ///
    /// # Errors
    /// When a word does not fit the method, or the memory for a factor is negative.
    pub fn options_on(&self, parts: MotionParts) -> Result<Options> {
        let MotionParts { bodies, wall, sliding, also_moved } = parts;
        Ok(Options {
            method: self.method(bodies, wall.clone())?,
            strain: self.strain.unwrap_or_default(),
            within_walls: self.within_walls,
            smoothing: self.smooth,
            also_moved,
            rigid_layer: self.rigid_layer.map(|extent| RigidLayer { extent, wall }),
            sliding,
            slide_tolerance: SlideTolerance(self.slide_tolerance),
            limits: Limits { substeps: self.substeps, ..Limits::default() },
        })
    }

    /// The method with its parameters; `wall` is where a Laplace equation is stiff.
    ///
    /// # Errors
    /// When there are words that the method does not use, or the memory for a factor is negative.
    fn method(&self, bodies: Vec<FacetSet>, wall: Option<FacetSet>) -> Result<Method> {
        if self.factor_gib < 0.0 || self.factor_gib.is_nan() {
            return Err(Error::options(format!(
                "the memory for a factor must be 0 or more GiB; got {}",
                self.factor_gib
            ))
            .remedy("give 0 or a positive number"));
        }
        if self.method != MethodName::Bodies {
            for (word, is_given, what) in [
                ("bodies", !self.bodies.is_empty(), "names rigid bodies"),
                ("strain", self.strain.is_some(), "says where bodies put the strain"),
            ] {
                if is_given {
                    return Err(Error::options(format!(
                        "`{word}` {what}, but the method `{}` does not use rigid bodies",
                        self.method
                    ))
                    .remedy("use the method bodies"));
                }
            }
        }
        let factor_bytes = (self.factor_gib * (1u64 << 30) as f64) as u64;
        let mut elastic = Elastic { factor_bytes, ..Elastic::default() };
        elastic.tolerance.residual = self.residual;
        let tolerance = elastic.tolerance;
        Ok(match self.method {
            MethodName::Delaunay => Method::Delaunay,
            MethodName::Bodies => Method::Bodies(bodies),
            MethodName::Guided => Method::Guided,
            MethodName::Elastic => Method::Elastic(elastic),
            MethodName::Laplace => {
                Method::Laplace(Laplace { wall, tolerance, factor_bytes, ..Laplace::default() })
            }
            MethodName::Idw => Method::InverseDistance,
            MethodName::Rbf => Method::Radial,
        })
    }

    /// The driven vertices of a mesh: those of its boundary and of patches inside, in rising order.
    ///
    /// # Errors
    /// When the mesh has no patch of a name.
    pub fn driven(&self, mesh: &Mesh) -> Result<Vec<VertexId>> {
        let mut driven = Boundary::of(&mesh.cells).vertices;
        driven.extend(self.driven_inside(mesh)?);
        driven.sort_unstable();
        driven.dedup();
        Ok(driven)
    }

    /// The vertices of patches inside, in rising order; some may lie on the boundary.
    fn driven_inside(&self, mesh: &Mesh) -> Result<Vec<VertexId>> {
        let mut inside = Vec::new();
        for word in &self.inside {
            inside.extend(FacetSet::find(mesh, word)?.vertices);
        }
        inside.sort_unstable();
        inside.dedup();
        Ok(inside)
    }
}

/// The parts of a mesh that the words of a [`Motion`] name.
#[derive(Clone, Debug, Default)]
pub struct MotionParts {
    /// The rigid bodies; without any, each connected part of the walls is one, except the outer one.
    pub bodies: Vec<FacetSet>,
    /// The wall that has the rigid layer, or where a Laplace equation is stiff; `None`: all that does not
    /// slide.
    pub wall: Option<FacetSet>,
    /// Flat parts whose vertices slide.
    pub sliding: Vec<FacetSet>,
    /// Vertices that are driven in addition to those of the boundary.
    pub also_moved: Vec<VertexId>,
}

/// The name of a [`Method`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MethodName {
    /// [`Method::Delaunay`].
    #[default]
    Delaunay,
    /// [`Method::Bodies`].
    Bodies,
    /// [`Method::Guided`].
    Guided,
    /// [`Method::Elastic`].
    Elastic,
    /// [`Method::Laplace`].
    Laplace,
    /// [`Method::InverseDistance`].
    Idw,
    /// [`Method::Radial`].
    Rbf,
}

impl MethodName {
    /// All names, the cheapest methods first.
    pub const ALL: [Self; 7] =
        [Self::Delaunay, Self::Bodies, Self::Guided, Self::Elastic, Self::Laplace, Self::Idw, Self::Rbf];

    /// The method with this name.
    ///
    /// # Errors
    /// When there is none; the error names the nearest, or all.
    pub fn of(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|method| method.as_str() == name).ok_or_else(|| {
            Error::options(format!("there is no method `{name}`"))
                .remedy(one_of(name, Self::ALL.iter().map(|method| method.as_str())))
        })
    }

    /// The name in files and on the command line.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Delaunay => "delaunay",
            Self::Bodies => "bodies",
            Self::Guided => "guided",
            Self::Elastic => "elastic",
            Self::Laplace => "laplace",
            Self::Idw => "idw",
            Self::Rbf => "rbf",
        }
    }
}

impl Method {
    /// The name of the method, such as `delaunay`.
    pub fn name(&self) -> MethodName {
        match self {
            Self::Delaunay => MethodName::Delaunay,
            Self::Bodies(_) => MethodName::Bodies,
            Self::Guided => MethodName::Guided,
            Self::Elastic(_) => MethodName::Elastic,
            Self::Laplace(_) => MethodName::Laplace,
            Self::InverseDistance => MethodName::Idw,
            Self::Radial => MethodName::Rbf,
        }
    }
}

impl fmt::Display for MethodName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Serialize for MethodName {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for MethodName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        read_named(deserializer, Self::of)
    }
}

impl<'de> Deserialize<'de> for Strain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        read_named(deserializer, Self::of_name)
    }
}

impl Extent {
    /// The extent that a text denotes: a distance such as `0.2`, or layers of cells such as `3layers`.
    ///
    /// # Errors
    /// When the text is neither, or the number is not above 0.
    pub fn of_text(text: &str) -> Result<Self> {
        let cells = text.strip_suffix("layers").or_else(|| text.strip_suffix("layer"));
        let found = match cells {
            Some(n) => n.trim().parse().ok().filter(|n| *n > 0).map(Self::Cells),
            None => text.trim().parse().ok().filter(|d| *d > 0.0 && f64::is_finite(*d)).map(Self::Distance),
        };
        found.ok_or_else(|| {
            Error::options(format!(
                "expected a distance such as 0.2, or cell layers such as 3layers; got {text}"
            ))
        })
    }
}

impl Serialize for Extent {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Distance(distance) => serializer.serialize_f64(*distance),
            Self::Cells(n) => serializer.serialize_str(&format!("{n}layers")),
        }
    }
}

impl<'de> Deserialize<'de> for Extent {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Distance(f64),
            Text(String),
        }
        let text = match Written::deserialize(deserializer)? {
            Written::Distance(distance) => distance.to_string(),
            Written::Text(text) => text,
        };
        Self::of_text(&text).map_err(|e| de::Error::custom(e.what()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Words;
    use crate::mesh::shapes;

    #[test]
    fn a_table_of_json_becomes_options() {
        let text =
            r#"{"method": "bodies", "bodies": ["sphere"], "rigid_layer": "3layers", "strain": "band"}"#;
        let motion: Motion = serde_json::from_str(text).unwrap();
        let options = motion.options(&shapes::sphere_in_box(2, 1)).unwrap();
        assert!(matches!(&options.method, Method::Bodies(sets) if sets.len() == 1));
        assert_eq!(options.strain, Strain::Band);
        assert_eq!(options.rigid_layer.unwrap().extent, Extent::Cells(3));
    }

    #[test]
    fn names_that_do_not_exist_name_the_nearest() {
        let error = |text: &str| serde_json::from_str::<Motion>(text).unwrap_err().to_string();
        assert!(error(r#"{"method": "delauny"}"#).contains("did you mean `delaunay`?"));
        assert!(error(r#"{"within_wall": true}"#).contains("did you mean `within_walls`?"));
        assert!(error(r#"{"rigid_layer": -1}"#).contains("got -1"));
    }

    #[test]
    fn words_that_the_method_does_not_use_are_refused() {
        let motion = Motion { bodies: vec!["sphere".into()], ..Motion::default() };
        let error = motion.options(&shapes::sphere_in_box(2, 1)).unwrap_err();
        assert!(error.to_string().contains("does not use rigid bodies"), "{error}");
    }

    #[test]
    fn every_method_has_the_name_that_it_is_found_by() {
        for name in MethodName::ALL {
            assert_eq!(MethodName::of(name.as_str()).unwrap(), name);
            let motion = Motion { method: name, ..Motion::default() };
            assert_eq!(motion.method(Vec::new(), None).unwrap().name(), name);
        }
    }

    #[test]
    fn the_defaults_are_those_of_the_options() {
        let words = Motion::default().options(&shapes::sphere_in_box(2, 1)).unwrap();
        let usual = Options::default();
        assert_eq!((words.smoothing, words.within_walls), (usual.smoothing, usual.within_walls));
        assert_eq!((words.limits, words.slide_tolerance), (usual.limits, usual.slide_tolerance));
        assert_eq!(Motion::NAMES.len(), 13);
    }
}
