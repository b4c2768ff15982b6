//! Output of `motet contact` for people: tables, a histogram, places with warnings.

use super::delaunay::DelaunayAccuracy;
use super::histogram::Histogram;
use super::report::{InRoom, Pair, Report, Stages, Step};
use crate::console::Console;
use crate::outcome::Outcome;
use crate::table::{Table, count, seconds, short, time as time_of};

/// How many groups of vertices with warnings are listed without `--verbose`.
const N_LISTED: usize = 10;

impl Report {
    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        let mut bodies = Table::new(["surface", "vertices", "triangles", "closed"]);
        for body in &self.bodies {
            let closed = match (body.closed, body.room) {
                (false, _) => "no",
                (true, false) => "yes",
                (true, true) => "yes, a room",
            };
            bodies.row([body.name.clone(), count(body.vertices), count(body.triangles), closed.into()]);
        }
        console.print(bodies);
        self.print_rooms(console);
        match self.steps.as_slice() {
            [step] => step.print(self.warn, console),
            steps => self.print_series(steps, console),
        }
        console.print(format_args!("wrote {}", self.output.display()));
        let Stages { measure, look_ahead, write, total } = self.seconds;
        let [measure, look_ahead, write, total] = [measure, look_ahead, write, total].map(seconds);
        console
            .print(format_args!("measured {measure}, looked ahead {look_ahead}, wrote {write}, all {total}"));
    }

    fn print_series(&self, steps: &[Step], console: &Console) {
        let mut table =
            Table::new(["time", "least gap", "between", "warned vertices", "crossings", "contact after"]);
        for step in steps {
            let near = step.nearest();
            let n_warned: usize = step.gaps.iter().map(|gap| gap.warned).sum();
            let n_crossings: usize = step.pairs.iter().map(|pair| pair.crossings.len()).sum();
            table.row([
                time_of(step.time),
                step.least.map_or("-".into(), short),
                near.map_or("-".into(), |pair| pair.bodies.join(" and ")),
                count(n_warned),
                count(n_crossings),
                step.contact_after(),
            ]);
        }
        console.print(table);
        if let Some(time) = self.first_warning {
            console.print(format_args!("the first warning is at time {}", time_of(time)));
        }
        if let Some(time) = self.first_touch {
            console.print(format_args!("the first contact is at time {}", time_of(time)));
        }
    }

    /// Prints which surfaces were taken for rooms, and why.
    fn print_rooms(&self, console: &Console) {
        for body in self.bodies.iter().filter(|body| body.room && !body.closed) {
            console.warn(format_args!(
                "{} is open, so it has no inside: --room {} has no effect; `motet cap` closes rims",
                body.name, body.name
            ));
        }
        for InRoom { room, surface, share } in &self.rooms {
            if let Some(share) = share {
                console.print(format_args!(
                    "{room} is treated as the room of {surface}, {} % of whose area lies inside (use \
                     --no-room if {room} is solid)",
                    percent(*share)
                ));
            }
        }
    }
}

/// A part in percent, rounded down: only the whole gives 100.
fn percent(part: f64) -> String {
    format!("{}", (1000.0 * part).floor() / 10.0)
}

impl Step {
    fn nearest(&self) -> Option<&Pair> {
        let near = self.pairs.iter().filter(|pair| pair.distance.is_some());
        near.min_by(|x, y| {
            x.distance.unwrap_or(f64::INFINITY).total_cmp(&y.distance.unwrap_or(f64::INFINITY))
        })
    }

    fn contact_after(&self) -> String {
        match &self.first_contact {
            Some(first) => time_of(first.after),
            None if self.looked_ahead => "none ahead".into(),
            None => "-".into(),
        }
    }

    fn print(&self, warn: Option<f64>, console: &Console) {
        let mut table = Table::new(["between", "least gap", "at", "crossings", "deepest"]);
        for pair in &self.pairs {
            table.row([
                pair.bodies.join(" and "),
                pair.distance.map_or("none within reach".into(), short),
                pair.points.map_or("-".into(), |[a, _]| a.map(short).join(", ")),
                count(pair.crossings.len()),
                short(pair.depth),
            ]);
        }
        console.print(table);
        let mut table = Table::new(["gaps of vertices", "least", "median", "largest", "warned"]);
        for gap in &self.gaps {
            let [min, median, max] = [gap.min, gap.median, gap.max].map(|x| x.map_or("-".into(), short));
            table.row([gap.body.clone(), min, median, max, count(gap.warned)]);
        }
        console.print(table);
        if let Some(histogram) = Histogram::of(&self.all, warn) {
            console.print(histogram);
        }
        if let Some(DelaunayAccuracy {
            gap_tets,
            least,
            compared,
            exact,
            largest_over,
            largest_under,
            seconds: s,
        }) = &self.delaunay
        {
            console.print(format_args!(
                "by {} Delaunay tets in {}: least gap {}, too large by up to {}, too small by up to {}, \
                 exact at {:.1} % of {} vertices",
                count(*gap_tets),
                seconds(*s),
                least.map_or("-".into(), short),
                short(*largest_over),
                short(*largest_under),
                100.0 * exact,
                count(*compared)
            ));
        }
        let n = if console.is_verbose() { self.warned.len() } else { N_LISTED };
        for group in self.warned.iter().take(n) {
            let near = group.near.as_ref().map_or(String::new(), |near| format!(" of {near}"));
            console.print(format_args!(
                "warned: {} vertices of {} within {}{near}, nearest point {} at {}",
                count(group.vertices),
                group.body,
                group.gap.map_or("the warning distance at their triangles".into(), short),
                group.point,
                group.place.map(short).join(", ")
            ));
        }
        if self.warned.len() > n {
            console.print(format_args!(
                "and {} more groups; -v or --json lists all",
                count(self.warned.len() - n)
            ));
        }
        match &self.first_contact {
            Some(first) => console.print(format_args!(
                "no contact before {}, then {} near {}",
                short(first.after),
                first.bodies.join(" and "),
                first.place.map(short).join(", ")
            )),
            None if self.looked_ahead => console.print("no contact ahead"),
            None => {}
        }
    }
}
