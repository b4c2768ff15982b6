//! The report of `motet contact` for programs; the output for people is in `words`.

use std::path::PathBuf;

use motet::base::{BodyId, Point};
use motet::contact::{Ahead, Contact, Gaps, PairGap, Room};
use motet::geometry::distance::Feature;
use serde::Serialize;

use super::args::ContactArgs;
use super::delaunay::DelaunayAccuracy;
use super::frames::Frame;
use crate::words;

/// All results of `motet contact`.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    #[serde(serialize_with = "words::paths")]
    pub(super) output: PathBuf,
    pub(super) warn: Option<f64>,
    /// Whether there is a warning in any frame.
    pub(super) warning: bool,
    /// The times of the first frame with a warning and of the first in which surfaces touch.
    pub(super) first_warning: Option<f64>,
    pub(super) first_touch: Option<f64>,
    pub(super) bodies: Vec<BodyFacts>,
    /// Which surfaces lie in which rooms, decided in the first frame.
    pub(super) rooms: Vec<InRoom>,
    pub(super) steps: Vec<Step>,
    pub(super) seconds: Stages,
}

/// Seconds by stage.
#[derive(Debug, Default, Serialize)]
pub(super) struct Stages {
    /// Preparing surfaces and measuring.
    pub(super) measure: f64,
    pub(super) look_ahead: f64,
    pub(super) write: f64,
    pub(super) total: f64,
}

/// A surface of the first frame.
#[derive(Debug, Serialize)]
pub(super) struct BodyFacts {
    pub(super) name: String,
    #[serde(serialize_with = "words::paths")]
    pub(super) file: PathBuf,
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    pub(super) closed: bool,
    pub(super) room: bool,
}

/// A surface in a room.
#[derive(Debug, Serialize)]
pub(super) struct InRoom {
    pub(super) room: String,
    pub(super) surface: String,
    /// The part of its area that is inside in the first frame; null where the room was given.
    pub(super) share: Option<f64>,
}

/// What was found in one frame.
#[derive(Debug, Serialize)]
pub(super) struct Step {
    pub(super) time: f64,
    #[serde(serialize_with = "words::paths")]
    pub(super) file: Option<PathBuf>,
    /// The least gap of all; 0 where surfaces meet, null where nothing is within reach.
    pub(super) least: Option<f64>,
    pub(super) warning: bool,
    /// Gaps of the vertices, by body.
    pub(super) gaps: Vec<Spread>,
    pub(super) pairs: Vec<Pair>,
    pub(super) warned: Vec<Group>,
    pub(super) first_contact: Option<First>,
    /// How accurate the gaps by Delaunay tets are, where requested.
    pub(super) delaunay: Option<DelaunayAccuracy>,
    #[serde(skip)]
    pub(super) all: Vec<f64>,
    #[serde(skip)]
    pub(super) looked_ahead: bool,
}

/// Statistics of the gaps of one body, over the vertices that have one.
#[derive(Debug, Serialize)]
pub(super) struct Spread {
    pub(super) body: String,
    pub(super) vertices: usize,
    pub(super) warned: usize,
    pub(super) min: Option<f64>,
    pub(super) median: Option<f64>,
    pub(super) max: Option<f64>,
}

#[derive(Debug, Serialize)]
pub(super) struct Pair {
    pub(super) bodies: [String; 2],
    /// Null where nothing is within reach.
    pub(super) distance: Option<f64>,
    pub(super) points: Option<[Point; 2]>,
    /// The cells of the nearest places, each an index in its file.
    pub(super) cells: Option<[usize; 2]>,
    pub(super) features: Option<[&'static str; 2]>,
    /// Pairs of cells of the files that meet.
    pub(super) crossings: Vec<[usize; 2]>,
    /// Vertices of each body that are where the other one does not permit them.
    pub(super) wrong: [usize; 2],
    pub(super) depth: f64,
    /// Triangles of each body nearer than the warning distance.
    pub(super) warned_triangles: [usize; 2],
}

/// Connected vertices with warnings.
#[derive(Debug, Serialize)]
pub(super) struct Group {
    pub(super) body: String,
    /// The body nearest to the vertex with the least gap.
    pub(super) near: Option<String>,
    pub(super) vertices: usize,
    /// The least gap; null where triangles at the vertices are near enough to warn, but none of the vertices
    /// is within reach.
    pub(super) gap: Option<f64>,
    /// The vertex with the least gap, as a point of its file.
    pub(super) point: usize,
    pub(super) place: Point,
}

/// The first contact if vertices keep their velocities.
#[derive(Debug, Serialize)]
pub(super) struct First {
    /// Time from the frame to the contact; nothing touches before.
    pub(super) after: f64,
    pub(super) bodies: [String; 2],
    pub(super) cells: [usize; 2],
    pub(super) place: Point,
}

impl Report {
    pub(super) fn new(args: &ContactArgs) -> Self {
        Self {
            output: args.output.clone(),
            warn: args.warn,
            warning: false,
            first_warning: None,
            first_touch: None,
            bodies: Vec::new(),
            rooms: Vec::new(),
            steps: Vec::new(),
            seconds: Stages::default(),
        }
    }

    pub(super) fn is_warned(&self) -> bool {
        self.warning
    }

    pub(super) fn add(&mut self, contact: &Contact, frame: &Frame, step: Step) {
        if self.bodies.is_empty() {
            let all = (0..).map(BodyId).zip(frame.bodies.iter().zip(&frame.sources)).zip(&step.gaps);
            let facts = all.map(|((id, (body, source)), spread)| BodyFacts {
                name: body.name.clone(),
                file: source.file.clone(),
                vertices: spread.vertices,
                triangles: body.triangles.len(),
                closed: contact.is_closed(id),
                room: body.room == Room::Yes || contact.rooms().iter().any(|within| within.room == id),
            });
            self.bodies = facts.collect();
            let name = |body: BodyId| contact.name(body).to_owned();
            let rooms = contact.rooms().iter();
            self.rooms =
                rooms.map(|w| InRoom { room: name(w.room), surface: name(w.body), share: w.share }).collect();
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
}

impl Step {
    pub(super) fn new(
        time: f64,
        file: Option<PathBuf>,
        contact: &Contact,
        frame: &Frame,
        gaps: &Gaps,
        ahead: Option<&Ahead>,
    ) -> Self {
        let name = |body: BodyId| contact.name(body).to_owned();
        let cell = |body: BodyId, triangle: u32| frame.sources[body.index()].cells[triangle as usize].index();
        let spread =
            |(id, body): (BodyId, &motet::contact::BodyGaps)| Spread::new(name(id), &body.gap, &body.warning);
        let group = |g: motet::contact::Warned| Group {
            body: name(g.bodies.0),
            near: g.bodies.1.get().map(name),
            vertices: g.n_vertices,
            gap: g.gap.is_finite().then_some(g.gap),
            point: g.vertex.index() - frame.sources[g.bodies.0.index()].first_point,
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
            gaps: (0..).map(BodyId).zip(&gaps.bodies).map(spread).collect(),
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

    /// Adds the accuracy of the gaps by Delaunay tets.
    pub(super) fn with_delaunay(mut self, delaunay: Option<DelaunayAccuracy>) -> Self {
        self.delaunay = delaunay;
        self
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
    fn new(pair: &PairGap, name: &impl Fn(BodyId) -> String, cell: &impl Fn(BodyId, u32) -> usize) -> Self {
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
