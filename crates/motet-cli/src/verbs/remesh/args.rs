//! Arguments of `motet remesh`, as its help shows them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use motet::Error;
use motet::Mesh;
use motet::remesh::{self, Held, Options, Sizes, SurfaceRule};

use crate::arrays::ArrayArgs;
use crate::words::positive;
use crate::writing::WritingArgs;

/// Find the bad tets of a mesh and repair them, leaving the others alone
///
/// A tet is bad when its equi-angle quality (EAS: 1 regular, 0 flat, negative inverted) is below --min-eas.
/// Each is repaired in place: edges and facets are swapped, edges split and collapsed, vertices moved and
/// inserted; a change is made only if it raises the worst quality of the tets it touches. Everything else
/// stays as it is, to the bit. Regions, patches and all arrays are carried over.
#[derive(Debug, Args)]
#[command(override_usage = "motet remesh MESH -o OUT [OPTIONS]")]
#[command(after_help = "\
Types of bad tets: I two opposite edges cross closely, II a vertex lies close to an opposite \
edge, III a vertex lies over the middle of the opposite facet, IV an edge is short.

Arrays of real numbers are interpolated on points and averaged over what each new tet overlaps \
on cells, so that integrals stay; whole numbers, names and directions are inherited. \
GlobalNodeID and GlobalElementID of new points and tets are new numbers.

With --sizes, edges longer than 1.5 times their size are split at their middles and edges \
shorter than 0.5 times their size are collapsed, as far as that makes no tet bad; then bad tets \
are repaired. The size of an edge is the mean of the sizes at its ends. On a kept surface edges \
stay as they are.

Line cells are divided and merged with their edges where the surface may change, and keep their \
arrays. Entities that a Medit file marks as required stay to the bit, as with --hold; so do both \
sides of a slit, or of an interface with doubled points.

Examples:
  motet remesh moved.vtu -o repaired.vtu
  motet remesh moved.vtu -o repaired.vtu --surface adapt --distance 0.01
        the wall may move by 0.01 units where it makes tets bad
  motet remesh scan.msh -o better.vtu --goal best        the worst tets as good as they get
  motet remesh coarse.vtu -o fine.vtu --sizes 0.3 --surface adapt      edges of about 0.3 everywhere
  motet remesh scan.vtu -o graded.vtu --sizes h --surface adapt        of about the point array h
  motet remesh moved.vtu -o repaired.vtu --hold solid --hold inlet     the solid and the inlet stay
  motet remesh moved.vtu -o repaired.vtu --json | jq .left
  motet remesh moved.vtu -o repaired.vtu --carry flags=drop --history repaired.json

Exit status 4: a bad tet is left, or an edge that is too long and not at a kept surface; the \
mesh is written, and the report says what is left and why.")]
pub(crate) struct RemeshArgs {
    /// The mesh file (or folder)
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Tets below this EAS are bad
    #[arg(long, value_name = "EAS", default_value_t = 0.2, value_parser = eas, help_heading = "Repair")]
    pub(crate) min_eas: f64,
    /// Tets with a dihedral angle below this are bad, too: --min-eas is raised to the EAS that guarantees it,
    /// 0.014 per degree
    #[arg(long, value_name = "DEG", value_parser = degrees, help_heading = "Repair")]
    pub(crate) min_dihedral: Option<f64>,
    /// What may change on the boundary, on interfaces of regions and on surface cells
    #[arg(long, value_name = "RULE", default_value = "keep", help_heading = "Repair")]
    pub(crate) surface: Surface,
    /// How far an adapting surface may stray from where it was, in units of the mesh [default: a
    /// thousandth of the largest extent]
    #[arg(long, value_name = "D", value_parser = positive, help_heading = "Repair")]
    distance: Option<f64>,
    /// Bring edges to this length, or to the value of a point array
    #[arg(long, value_name = "H|ARRAY", value_parser = sizes, help_heading = "Repair")]
    sizes: Option<SizesArg>,
    /// Keep the tets of this region, or the triangles of this patch, and their vertices as they are, to the
    /// bit; by name or number. Repeatable
    #[arg(long, value_name = "NAME", help_heading = "Repair")]
    hold: Vec<String>,
    /// When to stop
    #[arg(long, value_name = "GOAL", default_value = "repair", help_heading = "Repair")]
    pub(crate) goal: Goal,
    /// What to do with the thin tets of boundary layers at walls, whose angles would count as bad
    #[arg(long, value_name = "RULE", default_value = "keep", help_heading = "Repair")]
    layers: Layers,
    /// Maximum number of rounds over the bad tets
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "Repair")]
    rounds: u32,

    #[command(flatten)]
    pub(crate) arrays: ArrayArgs,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Surface {
    /// Nothing: surfaces stay to the bit
    Keep,
    /// They may change within --distance; creases, corners and borders of patches stay
    Adapt,
    /// They may change within --distance; so may creases and corners where nothing else helps
    Loose,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Goal {
    /// When no bad tet is left, with as few tets touched as possible
    Repair,
    /// When the worst tets everywhere are as good as they get
    Best,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Layers {
    /// They stay as they are and count as good
    Keep,
    /// They are repaired like any bad tet
    Repair,
}

/// The requested sizes.
#[derive(Clone, Debug, PartialEq)]
enum SizesArg {
    Length(f64),
    /// Name of a point array.
    Array(String),
}

impl RemeshArgs {
    pub(crate) fn options(&self) -> motet::Result<Options> {
        let surface = match (self.surface, self.distance) {
            (Surface::Keep, None) => SurfaceRule::Keep,
            (Surface::Adapt, distance) => SurfaceRule::Adapt { distance },
            (Surface::Loose, distance) => SurfaceRule::Loose { distance },
            (Surface::Keep, Some(_)) => {
                return Err(Error::options(
                    "--distance bounds how far a surface may stray, but this one is kept",
                )
                .remedy("add --surface adapt"));
            }
        };
        Ok(Options {
            min_eas: self.min_eas,
            min_dihedral_deg: self.min_dihedral.unwrap_or(0.0),
            goal: match self.goal {
                Goal::Repair => remesh::Goal::Repair,
                Goal::Best => remesh::Goal::Best,
            },
            surface,
            keep_layers: self.layers == Layers::Keep,
            rounds: self.rounds as usize,
            ..Options::default()
        })
    }

    /// The regions and patches of a mesh that the call holds.
    pub(crate) fn held(&self, mesh: &Mesh) -> motet::Result<Held> {
        Held::of_names(mesh, &self.hold)
    }

    /// The sizes that the call requests, possibly from an array of the mesh.
    pub(crate) fn sizes(&self, mesh: &Mesh) -> motet::Result<Option<Sizes>> {
        let name = match &self.sizes {
            None => return Ok(None),
            Some(SizesArg::Length(h)) => return Ok(Some(Sizes::Uniform(*h))),
            Some(SizesArg::Array(name)) => name,
        };
        let Some(field) = mesh.point_field(name) else {
            let known: Vec<&str> = mesh.point_data.iter().map(|f| f.name.as_str()).collect();
            return Err(Error::options(format!(
                "--sizes: {name} is neither a number nor a point array of the mesh"
            ))
            .remedy(match known[..] {
                [] => "give a number above 0: the mesh has no point arrays".to_owned(),
                _ => format!("give a number above 0 or one of its point arrays: {}", known.join(", ")),
            }));
        };
        match field.values.to_f64().filter(|_| field.components == 1) {
            Some(sizes) => Ok(Some(Sizes::Vertices(sizes))),
            None => Err(Error::input("does not have one number for each point, as sizes require")
                .at(format!("array {name}"))
                .remedy("give --sizes an array of one component")),
        }
    }
}

pub(crate) fn eas(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(eas) if 0.0 < eas && eas < 1.0 => Ok(eas),
        _ => Err("an EAS between 0 (flat) and 1 (regular) is expected, such as 0.2".into()),
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(degrees) if 0.0 < degrees && degrees < 70.0 => Ok(degrees),
        _ => Err("degrees between 0 and 70 are expected (a regular tet has 70.5)".into()),
    }
}

fn sizes(text: &str) -> Result<SizesArg, String> {
    match text.parse::<f64>() {
        Ok(h) if 0.0 < h && h < f64::INFINITY => Ok(SizesArg::Length(h)),
        Ok(_) => Err("a number above 0 is expected, or the name of a point array".into()),
        Err(_) => Ok(SizesArg::Array(text.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_what_the_help_says() {
        assert_eq!(eas("0.25"), Ok(0.25));
        assert_eq!(degrees("14.1"), Ok(14.1));
        assert_eq!(sizes("0.3"), Ok(SizesArg::Length(0.3)));
        assert_eq!(sizes("h"), Ok(SizesArg::Array("h".to_owned())));
    }

    #[test]
    fn what_is_off_is_reported() {
        for text in ["0", "1", "-0.2", "nan", "x"] {
            assert!(eas(text).is_err(), "{text}");
        }
        assert!(["0", "-0.3", "nan", "inf"].into_iter().all(|text| sizes(text).is_err()));
        assert!(degrees("70.6").is_err() && degrees("0").is_err());
    }
}
