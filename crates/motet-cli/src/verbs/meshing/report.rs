//! The report of `motet mesh`: a few lines for people, an object for programs.

use std::path::PathBuf;

use motet::mesh::Qualities;
use motet::meshing;
use motet::preflight::{FaultKind, Preflight, Repair, RepairKind};
use motet::remesh;
use serde::Serialize;

use super::args::MeshArgs;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{count, seconds, short};
use crate::words;

/// All results of `motet mesh`.
#[derive(Debug, Serialize)]
pub(crate) struct Report<'a> {
    #[serde(serialize_with = "words::paths")]
    surfaces: Vec<PathBuf>,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Whether the mesh is as requested.
    complete: bool,
    repairs: &'a [Repair],
    preflight: &'a Preflight,
    /// `null` where the surfaces were refused.
    filled: Option<meshing::Report>,
    /// `null` where no improvement was requested.
    improved: Option<remesh::Report>,
    /// `null` where no layers were requested.
    layers: Option<meshing::layers::Report>,
    /// Quality of all tets of the mesh; `null` where the surfaces were refused.
    quality: Option<Qualities>,
    seconds: Seconds,
}

#[derive(Debug, Default, Serialize)]
struct Seconds {
    read: f64,
    check: f64,
    fill: f64,
    write: f64,
    total: f64,
}

/// The maximum number of faults, and of regions, that are listed.
const N_LISTED: usize = 20;

impl<'a> Report<'a> {
    pub(super) fn new(args: &MeshArgs, preflight: &'a Preflight, repairs: &'a [Repair]) -> Self {
        Self {
            surfaces: args.surfaces.iter().chain(&args.membrane).cloned().collect(),
            output: args.output.clone(),
            complete: false,
            repairs,
            preflight,
            filled: None,
            improved: None,
            layers: None,
            quality: None,
            seconds: Seconds::default(),
        }
    }

    pub(super) fn end(
        &mut self,
        filled: meshing::Report,
        improved: Option<remesh::Report>,
        layers: Option<meshing::layers::Report>,
        quality: Option<Qualities>,
        [read, check, fill, write, total]: [f64; 5],
        complete: bool,
    ) {
        self.filled = Some(filled);
        self.improved = improved;
        self.layers = layers;
        self.quality = quality;
        self.complete = complete;
        self.seconds = Seconds { read, check, fill, write, total };
    }

    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        if !self.repairs.is_empty() {
            console.print(format_args!("{} repairs (--json lists them)", count(self.repairs.len())));
        }
        self.print_divided(console);
        console.print(self.preflight);
        if let Some(narrow) = self.preflight.narrow.filter(|_| !self.is_adapted()) {
            console.print(format_args!(
                "  {} triangles are so narrow that each tet on them is bad, of EAS at most {} at ({}): \
                 --surface adapt replaces them",
                count(narrow.n_triangles),
                short(narrow.highest_eas),
                narrow.at.map(short).join(", "),
            ));
        }
        for rim in self.preflight.rims.iter().take(N_LISTED) {
            console.print(format_args!("  rim: {rim}"));
        }
        let in_rims = self.preflight.n_torn_edges == 0;
        let fatal = self.preflight.faults.iter().filter(|fault| fault.is_fatal);
        let fatal = fatal.filter(|fault| !in_rims || fault.kind != FaultKind::OpenEdge);
        for fault in fatal.clone().take(N_LISTED) {
            console.print(format_args!("  {}: {fault}", fault.kind.name()));
        }
        let more = fatal.count().saturating_sub(N_LISTED);
        if more > 0 {
            console
                .print(format_args!("  and {} more (--json lists them, --culprits shows them)", count(more)));
        }
        if let Some(filled) = &self.filled {
            self.print_filled(filled, console);
        }
    }

    fn is_adapted(&self) -> bool {
        self.filled.as_ref().is_some_and(|filled| filled.adapted.is_some())
    }

    /// Prints where triangles were divided, by kind: how many places, and the first of them.
    fn print_divided(&self, console: &Console) {
        for (kind, what) in [
            (RepairKind::TJunction, "vertices on edges (T-junctions): the edges are divided there"),
            (RepairKind::Imprinted, "pairs of triangles lie on each other: they are divided alike"),
            (RepairKind::CutCrossing, "pairs of triangles cross: they are divided along the crossings"),
            (
                RepairKind::DroppedInside,
                "triangles or pieces of them lie inside other bodies: they are left out",
            ),
            (
                RepairKind::United,
                "triangles meet other bodies: they are divided, and the part inside is left out",
            ),
            (
                RepairKind::ShiftedVertex,
                "vertices were shifted by a tiny length, so that triangles could be divided there",
            ),
            (RepairKind::Wrapped, "surface was replaced by a new one around what it encloses"),
            (RepairKind::DroppedOutside, "triangles enclose nothing: they are left out"),
            (RepairKind::DroppedThin, "triangles of walls or gaps thinner than the distance were lost"),
            (RepairKind::LeftApart, "surface whose bodies cannot be united: it is left unchanged"),
            (RepairKind::KeptWall, "walls between bodies, on which each body has a triangle: one is kept"),
            (
                RepairKind::LeftMeeting,
                "surface that cannot be divided where it meets itself or others: it is left unchanged",
            ),
        ] {
            let of_kind = || self.repairs.iter().filter(|repair| repair.kind == kind);
            let place = of_kind().find_map(|repair| repair.at);
            let first =
                place.map_or_else(String::new, |at| format!("; the first at ({})", at.map(short).join(", ")));
            if of_kind().next().is_some() {
                console.print(format_args!("  {} {what}{first}", count(of_kind().count())));
            }
        }
    }

    fn print_filled(&self, filled: &meshing::Report, console: &Console) {
        console.print(format_args!(
            "{} tets in {} regions; worst EAS {}",
            count(filled.tets),
            filled.bodies.len(),
            short(filled.worst_eas)
        ));
        if let Some(divided) = filled.divided {
            console.print(format_args!(
                "the surface was divided: {} triangles in place of {}",
                count(divided.after),
                count(divided.before)
            ));
        }
        if let Some(adapted) = filled.adapted {
            console.print(format_args!(
                "the surface was adapted: {} triangles in place of {}, at most {} from it, and it from them at most {} ({} allowed)",
                count(adapted.after),
                count(adapted.before),
                short(adapted.to_given),
                short(adapted.from_given),
                short(adapted.allowed)
            ));
        }
        console.print(format_args!(
            "{} of {} triangles are facets unchanged; {} points were inserted inside, {} on edges",
            count(filled.triangles_kept),
            count(filled.triangles),
            count(filled.points_inside),
            count(filled.points_on_edges)
        ));
        if filled.voids > 0 {
            console.print(format_args!(
                "{} voids are left out: surfaces turned inward enclose them",
                count(filled.voids)
            ));
        }
        if filled.triangles_outside > 0 {
            console.warn(format_args!(
                "{} triangles enclose nothing, and are left out",
                count(filled.triangles_outside)
            ));
        }
        if filled.not_positive > 0 {
            console.warn(format_args!(
                "{} tets have no volume at the precision of their coordinates",
                count(filled.not_positive)
            ));
        }
        if let Some(layers) = &self.layers {
            print_layers(layers, console);
        }
        if let Some(improved) = &self.improved {
            console.print(format_args!(
                "improved: {} tets, worst EAS {}; {} bad tets were repaired, {} are left",
                count(improved.after.tets),
                improved.after.worst.map_or("-".into(), |worst| short(worst.eas)),
                count(improved.before.bad.saturating_sub(improved.after.bad)),
                count(improved.after.bad)
            ));
        }
        if self.quality.is_some() {
            console.print(quality::table([("the mesh", self.quality)]));
        }
        for body in filled.bodies.iter().take(N_LISTED) {
            let name = body.name.as_ref().map_or_else(String::new, |name| format!(" {name}"));
            let void =
                if body.is_void { "; surfaces turned inward enclose it: --voids leaves it out" } else { "" };
            console.print(format_args!(
                "region {}{name}: {} tets{}, volume {}{void}",
                body.region,
                count(body.tets),
                if body.prisms > 0 { format!(" and {} prisms", count(body.prisms)) } else { String::new() },
                short(body.volume)
            ));
        }
        let more = filled.bodies.len().saturating_sub(N_LISTED);
        if more > 0 {
            console.print(format_args!("and {} more (--json lists them)", count(more)));
        }
        console.print(format_args!(
            "filled {}, all {}",
            seconds(self.seconds.fill),
            seconds(self.seconds.total)
        ));
    }
}

fn print_layers(layers: &meshing::layers::Report, console: &Console) {
    let thickness = layers.thickness.map_or("none".into(), |t| t.map(short).join(", "));
    console.print(format_args!(
        "layers: {} prisms of volume {}; thickness (least, median, largest) {thickness}",
        count(layers.prisms),
        short(layers.volume)
    ));
    console.print(format_args!(
        "as thick as requested at {} of {} vertices of walls, thinner at {}, none at {}",
        count(layers.full),
        count(layers.vertices),
        count(layers.reduced - layers.without),
        count(layers.without)
    ));
    if let Some(place) = layers.least_at {
        console.print(format_args!(
            "the least fraction of the requested thickness is {}, at {}",
            short(layers.least_share),
            place.map(short).join(", ")
        ));
    }
}
