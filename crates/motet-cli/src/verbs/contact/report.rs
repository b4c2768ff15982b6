//! What contact reports: to people tables and a histogram, to programs an object.

use std::path::PathBuf;

use motet::base::Point;
use motet::contact::{Ahead, Contact, Gaps, PairGap};
use motet::geometry::distance::Feature;
use serde::Serialize;

use super::args::ContactArgs;
use super::delaunay::Beside;
use super::frames::Frame;
use super::histogram::Histogram;
use crate::console::Console;
use crate::table::{Table, count, seconds, short, time as time_of};

/// How many groups of warned vertices are told where nobody asks for all.
const FIRST: usize = 10;

/// All that was found.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    output: PathBuf,
    warn: Option<f64>,
    /// Whether something warns in any frame.
    warning: bool,
    /// The time of the first frame that warns, and of the first in which something touches.
    first_warning: Option<f64>,
    first_touch: Option<f64>,
    bodies: Vec<BodyFacts>,
    steps: Vec<Step>,
    pub(crate) seconds: Stages,
}

/// Seconds by stage.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Stages {
    /// Preparing surfaces and measuring.
    pub(crate) measure: f64,
    pub(crate) look_ahead: f64,
    pub(crate) write: f64,
    pub(crate) total: f64,
}

/// A surface of the first frame.
#[derive(Debug, Serialize)]
struct BodyFacts {
    name: String,
    file: PathBuf,
    vertices: usize,
    triangles: usize,
    closed: bool,
    room: bool,
}

/// What was found in one frame.
#[derive(Debug, Serialize)]
pub(crate) struct Step {
    time: f64,
    file: Option<PathBuf>,
    /// The least gap of all; 0 where surfaces meet, null where nothing is within reach.
    least: Option<f64>,
    warning: bool,
    /// By body: gaps of its vertices.
    gaps: Vec<Spread>,
    pairs: Vec<Pair>,
    warned: Vec<Group>,
    first_contact: Option<First>,
    /// How good the answer by Delaunay tets is, where that was asked for.
    delaunay: Option<Beside>,
    #[serde(skip)]
    all: Vec<f64>,
    #[serde(skip)]
    looked_ahead: bool,
}

/// The gaps of one body's vertices that have one.
#[derive(Debug, Serialize)]
struct Spread {
    body: String,
    vertices: usize,
    warned: usize,
    min: Option<f64>,
    median: Option<f64>,
    max: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Pair {
    bodies: [String; 2],
    /// Null where nothing is within reach.
    distance: Option<f64>,
    points: Option<[Point; 2]>,
    /// The cell of each file.
    cells: Option<[usize; 2]>,
    features: Option<[&'static str; 2]>,
    /// Cells of the files that meet.
    crossings: Vec<[usize; 2]>,
    /// Vertices of each that are where the other does not let them be.
    wrong: [usize; 2],
    depth: f64,
    /// Triangles of each nearer than the warning distance.
    warned_triangles: [usize; 2],
}

/// Connected vertices that warn.
#[derive(Debug, Serialize)]
struct Group {
    body: String,
    /// The body that the nearest of them is near to.
    near: Option<String>,
    vertices: usize,
    gap: f64,
    /// The point of its file.
    point: usize,
    place: Point,
}

/// The first contact, if vertices go on straight.
#[derive(Debug, Serialize)]
struct First {
    /// From the time of the frame; nothing touches before.
    after: f64,
    bodies: [String; 2],
    cells: [usize; 2],
    place: Point,
}

impl Report {
    pub(crate) fn new(args: &ContactArgs) -> Self {
        Self {
            output: args.output.clone(),
            warn: args.warn,
            warning: false,
            first_warning: None,
            first_touch: None,
            bodies: Vec::new(),
            steps: Vec::new(),
            seconds: Stages::default(),
        }
    }

    pub(crate) fn is_warned(&self) -> bool {
        self.warning
    }

    pub(crate) fn add(&mut self, contact: &Contact, frame: &Frame, step: Step) {
        if self.bodies.is_empty() {
            self.bodies = (0..)
                .zip(frame.bodies.iter().zip(&frame.sources).zip(&step.gaps))
                .map(facts(contact))
                .collect();
        }
        self.warning |= step.warning;
        if step.warning {
            self.first_warning.get_or_insert(step.time);
        }
        if step.least == Some(0.0) {
            self.first_touch.get_or_insert(step.time);
        }
        self.steps.push(step);
    }

    pub(crate) fn tell(&self, console: &Console) {
        console.report(self);
        let mut bodies = Table::new(["surface", "vertices", "triangles", "closed"]);
        for body in &self.bodies {
            let closed = match (body.closed, body.room) {
                (false, _) => "no",
                (true, false) => "yes",
                (true, true) => "yes, a room",
            };
            bodies.row([body.name.clone(), count(body.vertices), count(body.triangles), closed.into()]);
        }
        console.say(bodies);
        match self.steps.as_slice() {
            [step] => step.tell(self.warn, console),
            steps => self.tell_series(steps, console),
        }
        self.hint_at_rooms(console);
        console.say(format_args!("wrote {}", self.output.display()));
        let Stages { measure, look_ahead, write, total } = self.seconds;
        let [measure, look_ahead, write, total] = [measure, look_ahead, write, total].map(seconds);
        console
            .say(format_args!("measured {measure}, looked ahead {look_ahead}, wrote {write}, all {total}"));
    }

    fn tell_series(&self, steps: &[Step], console: &Console) {
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
        console.say(table);
        if let Some(time) = self.first_warning {
            console.say(format_args!("the first warning is at time {}", time_of(time)));
        }
        if let Some(time) = self.first_touch {
            console.say(format_args!("the first touching is at time {}", time_of(time)));
        }
    }

    /// A closed surface around all others is a room as a rule.
    fn hint_at_rooms(&self, console: &Console) {
        let Some(step) = self.steps.first() else { return };
        for pair in &step.pairs {
            for (own, other) in [(0, 1), (1, 0)] {
                let find = |name: &String| self.bodies.iter().find(|body| body.name == *name);
                let (Some(a), Some(b)) = (find(&pair.bodies[own]), find(&pair.bodies[other])) else {
                    continue;
                };
                if pair.wrong[own] == a.vertices && !b.room {
                    console.warn(format_args!(
                        "all of {} is inside {}: if that is the wall of a room, say --room {}",
                        a.name, b.name, b.name
                    ));
                }
            }
        }
    }
}

impl Step {
    pub(crate) fn new(
        (time, file): (f64, Option<PathBuf>),
        contact: &Contact,
        frame: &Frame,
        gaps: &Gaps,
        ahead: Option<&Ahead>,
    ) -> Self {
        let name = |body: u32| contact.name(body).to_owned();
        let cell = |body: u32, triangle: u32| frame.sources[body as usize].cells[triangle as usize].index();
        let spread =
            |(id, body): (u32, &motet::contact::BodyGaps)| Spread::new(name(id), &body.gap, &body.warning);
        let group = |g: motet::contact::Warned| Group {
            body: name(g.bodies[0]),
            near: (g.bodies[1] != motet::contact::NONE).then(|| name(g.bodies[1])),
            vertices: g.n_vertices,
            gap: g.gap,
            point: g.vertex.index() - frame.sources[g.bodies[0] as usize].first_point,
            place: g.place,
        };
        let first = ahead.and_then(|ahead| ahead.first).map(|f| First {
            after: f.time,
            bodies: f.bodies.map(name),
            cells: [0, 1].map(|i| cell(f.bodies[i], f.triangles[i])),
            place: f.place,
        });
        let least = gaps.least();
        Self {
            time,
            file,
            least: least.is_finite().then_some(least),
            warning: gaps.is_warned(),
            gaps: (0..).zip(&gaps.bodies).map(spread).collect(),
            pairs: gaps.pairs.iter().map(|pair| Pair::new(pair, &name, &cell)).collect(),
            warned: contact.warned(gaps).into_iter().map(group).collect(),
            first_contact: first,
            delaunay: None,
            all: gaps
                .bodies
                .iter()
                .flat_map(|body| &body.gap)
                .copied()
                .filter(|gap| gap.is_finite())
                .collect(),
            looked_ahead: ahead.is_some(),
        }
    }

    /// With what is known of the answer by Delaunay tets.
    pub(crate) fn beside(mut self, delaunay: Option<Beside>) -> Self {
        self.delaunay = delaunay;
        self
    }

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

    fn tell(&self, warn: Option<f64>, console: &Console) {
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
        console.say(table);
        let mut table = Table::new(["gaps of vertices", "least", "median", "largest", "warned"]);
        for gap in &self.gaps {
            let [min, median, max] = [gap.min, gap.median, gap.max].map(|x| x.map_or("-".into(), short));
            table.row([gap.body.clone(), min, median, max, count(gap.warned)]);
        }
        console.say(table);
        if let Some(histogram) = Histogram::of(&self.all, warn) {
            console.say(histogram);
        }
        if let Some(Beside { gap_tets, least, compared, exact, largest_over, largest_under, seconds: s }) =
            &self.delaunay
        {
            console.say(format_args!(
                "by {} Delaunay tets in {}: least gap {}, too large by up to {}, too small by up to {}, exact at {:.1} % of {} vertices",
                count(*gap_tets),
                seconds(*s),
                least.map_or("-".into(), short),
                short(*largest_over),
                short(*largest_under),
                100.0 * exact,
                count(*compared)
            ));
        }
        let n = if console.is_verbose() { self.warned.len() } else { FIRST };
        for group in self.warned.iter().take(n) {
            let near = group.near.as_ref().map_or(String::new(), |near| format!(" of {near}"));
            console.say(format_args!(
                "warned: {} vertices of {} within {}{near}, nearest point {} at {}",
                count(group.vertices),
                group.body,
                short(group.gap),
                group.point,
                group.place.map(short).join(", ")
            ));
        }
        if self.warned.len() > n {
            console.say(format_args!(
                "and {} groups more: -v and --json tell all",
                count(self.warned.len() - n)
            ));
        }
        match &self.first_contact {
            Some(first) => console.say(format_args!(
                "no contact before {}, then {} near {}",
                short(first.after),
                first.bodies.join(" and "),
                first.place.map(short).join(", ")
            )),
            None if self.looked_ahead => console.say("no contact ahead"),
            None => {}
        }
    }
}

impl Spread {
    fn new(body: String, gaps: &[f64], warning: &[bool]) -> Self {
        let mut sorted: Vec<f64> = gaps.iter().copied().filter(|gap| gap.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        Self {
            body,
            vertices: gaps.len(),
            warned: warning.iter().filter(|&&warns| warns).count(),
            min: sorted.first().copied(),
            median: sorted.get(sorted.len() / 2).copied(),
            max: sorted.last().copied(),
        }
    }
}

impl Pair {
    fn new(pair: &PairGap, name: &impl Fn(u32) -> String, cell: &impl Fn(u32, u32) -> usize) -> Self {
        let cells = |triangles: [u32; 2]| [0, 1].map(|i| cell(pair.bodies[i], triangles[i]));
        let feature = |feature| match feature {
            Feature::Vertex(_) => "vertex",
            Feature::Edge(_) => "edge",
            Feature::Face => "face",
        };
        Self {
            bodies: pair.bodies.map(name),
            distance: pair.nearest.map(|n| n.distance),
            points: pair.nearest.map(|n| n.points),
            cells: pair.nearest.map(|n| cells(n.triangles)),
            features: pair.nearest.map(|n| n.features.map(feature)),
            crossings: pair.crossings.iter().map(|&triangles| cells(triangles)).collect(),
            wrong: pair.n_wrong,
            depth: pair.depth,
            warned_triangles: pair.n_warned,
        }
    }
}

fn facts<'a>(
    contact: &'a Contact,
) -> impl FnMut((u32, ((&'a motet::contact::Body, &'a super::frames::Source), &'a Spread))) -> BodyFacts {
    |(id, ((body, source), spread))| BodyFacts {
        name: body.name.clone(),
        file: source.file.clone(),
        vertices: spread.vertices,
        triangles: body.triangles.len(),
        closed: contact.is_closed(id),
        room: body.is_room,
    }
}
