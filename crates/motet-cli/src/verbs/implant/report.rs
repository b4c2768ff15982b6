//! The report of `motet implant`: a few lines for people, an object for programs.

use std::path::PathBuf;

use motet::base::Point;
use motet::implant;
use motet::mesh::Qualities;
use motet::remesh::Left;
use serde::Serialize;

use super::args::ImplantArgs;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::quality;
use crate::table::{Table, count, seconds, short};
use crate::words;

/// All results of `motet implant`.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    #[serde(serialize_with = "words::paths")]
    host: PathBuf,
    #[serde(serialize_with = "words::paths")]
    devices: Vec<PathBuf>,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Where the history was written, if it was.
    #[serde(serialize_with = "words::paths")]
    history: Option<PathBuf>,
    /// Whether the mesh is valid, every triangle of the devices is a facet, and the only bad tets left are
    /// those that surfaces force.
    complete: bool,
    /// Whether the mesh conforms and no tet is inverted.
    valid: bool,
    /// The largest relative deviation of a volume from its expected value.
    volume_deviation: f64,
    /// Bad tets that no angle of a surface forces.
    unforced: usize,
    /// Quality of all tets, of the host and of the new mesh.
    quality: [Option<Qualities>; 2],
    report: implant::Report,
    seconds: Seconds,
}

/// How many of the remaining bad tets are listed without `--verbose`.
const N_LISTED: usize = 10;

impl Report {
    /// `quality`: of the host and of the new mesh.
    pub(super) fn new(
        args: &ImplantArgs,
        report: implant::Report,
        quality: [Option<Qualities>; 2],
        seconds: Seconds,
    ) -> Self {
        Self {
            host: args.host.clone(),
            devices: args.devices.clone(),
            output: args.output.clone(),
            history: args.arrays.history.clone(),
            complete: report.is_complete(),
            valid: report.is_valid(),
            volume_deviation: report.volume_deviation(),
            unforced: report.n_unforced(),
            quality,
            report,
            seconds,
        }
    }

    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        let report = &self.report;
        if let Some(adapted) = report.adapted {
            console.print(format_args!(
                "refined {} times: {} tets of the host became {}",
                adapted.generations,
                count(adapted.tets_before),
                count(adapted.tets_after)
            ));
        }
        console.print(format_args!(
            "{} tets carved; kept to the bit: {} of {}, {} %",
            count(report.carved),
            count(report.kept),
            count(report.host_tets),
            (report.kept_share * 1e4).floor() / 1e2
        ));
        console.print(self.device_table());
        for device in &report.devices {
            let Some(fit) = device.fit else { continue };
            console.print(format_args!(
                "{}: new surface within {} of the old one, the old one within {} of it; {} was requested{}",
                device.name,
                short(fit.to_old),
                short(fit.from_old),
                short(fit.tolerance),
                if fit.is_reached() { "" } else { " and not reached" }
            ));
        }
        report.devices.iter().filter_map(describe_at_walls).for_each(|text| console.print(text));
        let worst = report.improved.after.worst;
        console.print(format_args!(
            "{} tets; {} bad ones near the devices were repaired, {} bad new tets are left; worst EAS there \
             {}",
            count(report.tets),
            count(report.improved.before.bad.saturating_sub(report.improved.after.bad)),
            count(report.improved.left.len()),
            worst.map_or("-".into(), |worst| short(worst.eas))
        ));
        let [host, mesh] = self.quality;
        console.print(quality::table([("host", host), ("with devices", mesh)]));
        console.print(format_args!(
            "volume {}, expected {}; off by {:.0e} at most",
            short(report.volume),
            short(report.volume_expected),
            self.volume_deviation
        ));
        for defect in &report.defects {
            console.warn(format_args!("{}: {}", defect.kind.name(), count(defect.count)));
        }
        self.print_remaining(console);
        console.print(format_args!("wrote {}", self.output.display()));
        if let Some(history) = &self.history {
            console.print(format_args!("wrote {}", history.display()));
        }
        let implant::Seconds { devices, adapt, carve, fill, improve, join, check } = report.seconds;
        let [devices, adapt, carve, fill, improve, join, check, total] =
            [devices, adapt, carve, fill, improve, join, check, self.seconds.total].map(seconds);
        console.print(format_args!(
            "devices {devices}, refined {adapt}, carved {carve}, filled {fill}, repaired {improve}, joined {join}, checked {check}, all {total}"
        ));
    }

    fn device_table(&self) -> Table {
        let mut table =
            Table::new(["device", "region", "patch", "triangles", "unchanged", "encloses", "volume"]);
        for device in &self.report.devices {
            table.row([
                device.name.clone(),
                if device.regions.is_empty() { "hollow".into() } else { listed(&device.regions) },
                device.patch.to_string(),
                count(device.triangles),
                count(device.triangles_kept),
                short(device.enclosed),
                if device.regions.is_empty() { "-".into() } else { short(device.volume) },
            ]);
        }
        table
    }

    fn print_remaining(&self, console: &Console) {
        if !self.report.host_left.is_empty() {
            console.print(format_args!(
                "{} bad tets of the host near the devices are left unchanged",
                count(self.report.host_left.len())
            ));
        }
        let left = &self.report.improved.left;
        if left.is_empty() {
            return;
        }
        let n_forced = left.len() - self.unforced;
        console.print(format_args!(
            "{} of the bad tets that are left are forced by surfaces, {} are not:",
            count(n_forced),
            count(self.unforced)
        ));
        let mut listed: Vec<&Left> = left.iter().collect();
        listed.sort_by_key(|left| left.reason.is_forced());
        let n = if console.is_verbose() { listed.len() } else { N_LISTED };
        for left in listed.iter().take(n) {
            console.print(format_args!(
                "  cell {} at {}, EAS {}: {}",
                left.tet,
                place(left.place),
                short(left.eas),
                left.reason
            ));
        }
        if listed.len() > n {
            console.print(format_args!("  and {} more; -v or --json lists all", count(listed.len() - n)));
        }
    }
}

/// Describes how a device meets walls of the host; `None` where it does not.
fn describe_at_walls(device: &implant::DeviceReport) -> Option<String> {
    let (at, outside) = (device.triangles_at_walls, device.triangles_outside);
    if at + outside == 0 && device.contact_patch.is_none() {
        return None;
    }
    let mut text = format!(
        "{}: meets walls of the host: {} triangles are divided there or have changed",
        device.name,
        count(at)
    );
    if outside > 0 {
        text += &format!(", {} lay outside and were cut off", count(outside));
    }
    if let Some(patch) = device.contact_patch {
        text += &format!("; the facets common to both are patch {patch}, {}-contact", device.name);
    }
    Some(text)
}

fn listed(ids: &[i32]) -> String {
    ids.iter().map(i32::to_string).collect::<Vec<_>>().join(", ")
}

fn place(p: Point) -> String {
    p.map(short).join(", ")
}
