//! The report of `motet wall`: a few lines for people, an object for programs.

use std::path::PathBuf;

use motet::meshing::wall;
use serde::Serialize;

use super::args::WallArgs;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::table::{count, seconds, short};
use crate::words::{self, shown};

/// All results of `motet wall`.
#[derive(Debug, Serialize)]
pub(super) struct Report<'a> {
    #[serde(serialize_with = "words::paths")]
    input: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Whether there is a wall everywhere.
    complete: bool,
    #[serde(flatten)]
    report: &'a wall::Report,
    seconds: Seconds,
}

impl<'a> Report<'a> {
    pub(super) fn new(args: &WallArgs, report: &'a wall::Report, seconds: Seconds) -> Self {
        Self {
            input: args.input.clone(),
            output: args.output.clone(),
            complete: report.not_reached().is_none(),
            report,
            seconds,
        }
    }

    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        let wall::Report { region, name, outer, ends, interface, layers, eas, .. } = self.report;
        console.print(format_args!(
            "region {region}, {}: {} prisms ({} tets), volume {}, on {} triangles",
            shown(name),
            count(layers.prisms),
            count(layers.tets),
            short(layers.volume),
            count(*interface)
        ));
        if let Some([least, median, largest]) = layers.thickness {
            console.print(format_args!(
                "thickness (least, median, largest) {}, {}, {}; as requested at {} of {} vertices",
                short(least),
                short(median),
                short(largest),
                count(layers.full),
                count(layers.vertices)
            ));
        }
        if let (Some([x, y, z]), true) = (layers.least_at, layers.reduced > 0) {
            console.print(format_args!(
                "thinner where there is no space: at least {} of that requested, at {}, {}, {}",
                short(layers.least_share),
                short(x),
                short(y),
                short(z)
            ));
        }
        if let Some(eas) = eas {
            console.print(format_args!(
                "EAS of its tets: worst {}, 1 % {}, median {}, mean {}",
                short(eas.worst),
                short(eas.p1),
                short(eas.median),
                short(eas.mean)
            ));
        }
        let ends: Vec<String> = ends.iter().map(|name| shown(name).to_string()).collect();
        console.print(format_args!("patches: {} outside; ends: {}", shown(outer), ends.join(", ")));
        console.print(format_args!("all {}", seconds(self.seconds.total)));
    }
}
