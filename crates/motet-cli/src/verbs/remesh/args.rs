//! Arguments of `motet remesh`, as its help shows them.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use clap::{ArgAction, Args};
use motet::remesh::{EdgeLengths, GoalName, RemeshWords, SurfaceName};

use crate::arrays::ArrayArgs;
use crate::help;
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

    #[arg(long, help = help::effect::<RemeshWords>("min_eas"), value_name = "EAS", value_parser = eas,
        default_value_t = RemeshWords::default().min_eas, help_heading = "Repair")]
    min_eas: f64,
    #[arg(long, help = help::effect::<RemeshWords>("min_dihedral_deg"), value_name = "DEG", value_parser = degrees,
        help_heading = "Repair")]
    min_dihedral: Option<f64>,
    #[arg(long, help = help::effect::<RemeshWords>("surface"), value_name = "RULE", value_parser = help::name_of::<SurfaceName>(),
        default_value_t = RemeshWords::default().surface, help_heading = "Repair")]
    pub(crate) surface: SurfaceName,
    #[arg(long, help = help::effect::<RemeshWords>("distance"), value_name = "D", value_parser = positive, help_heading = "Repair")]
    distance: Option<f64>,
    #[arg(long, help = help::effect::<RemeshWords>("sizes"), value_name = "H|ARRAY", value_parser = EdgeLengths::of_text,
        help_heading = "Repair")]
    sizes: Option<EdgeLengths>,
    #[arg(long, help = help::repeatable::<RemeshWords>("hold"), value_name = "NAME", help_heading = "Repair")]
    hold: Vec<String>,
    #[arg(long, help = help::effect::<RemeshWords>("goal"), value_name = "GOAL", value_parser = help::name_of::<GoalName>(),
        default_value_t = RemeshWords::default().goal, help_heading = "Repair")]
    goal: GoalName,
    #[arg(long = "layers", help = help::effect::<RemeshWords>("keep_layers"), value_name = "RULE", action = ArgAction::Set,
        value_parser = is_keep(), default_value = "keep", help_heading = "Repair")]
    keep_layers: bool,
    #[arg(long, help = help::effect::<RemeshWords>("rounds"), value_name = "N", value_parser = rounds(),
        default_value_t = RemeshWords::default().rounds, help_heading = "Repair")]
    rounds: usize,

    #[command(flatten)]
    pub(crate) arrays: ArrayArgs,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

impl RemeshArgs {
    /// What the call requests.
    pub(super) fn words(&self) -> RemeshWords {
        let usual = RemeshWords::default();
        RemeshWords {
            min_eas: self.min_eas,
            min_dihedral_deg: self.min_dihedral.unwrap_or(usual.min_dihedral_deg),
            goal: self.goal,
            surface: self.surface,
            distance: self.distance,
            keep_layers: self.keep_layers,
            hold: self.hold.clone(),
            sizes: self.sizes.clone(),
            rounds: self.rounds,
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

/// A parser of `keep` and `repair`; true for `keep`.
fn is_keep() -> impl TypedValueParser<Value = bool> {
    PossibleValuesParser::new(["keep", "repair"]).map(|rule| rule == "keep")
}

fn rounds() -> RangedU64ValueParser<usize> {
    RangedU64ValueParser::new().range(1..=10_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_what_the_help_says() {
        assert_eq!(eas("0.25"), Ok(0.25));
        assert_eq!(degrees("14.1"), Ok(14.1));
    }

    #[test]
    fn what_is_off_is_reported() {
        for text in ["0", "1", "-0.2", "nan", "x"] {
            assert!(eas(text).is_err(), "{text}");
        }
        assert!(degrees("70.6").is_err() && degrees("0").is_err());
    }
}
