//! The handle: surfaces prepared once, and measured at every step.

use std::sync::OnceLock;

use super::body::{Body, BodyView, PreparedBody, Room};
use super::input::vertices_of;
use super::options::Options;
use super::pair::{self, Guesses};
use super::results::{BodyGaps, Gaps, Nearest, Warned};
use super::room::{self, Within};
use super::side::Side;
use super::surface_graph::SurfaceGraph;
use crate::base::{BodyId, DisjointSets, Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::distance;
use crate::mesh;

/// Without a limit, a body is measured against itself up to this fraction of the size of all bodies.
const OWN_REACH: f64 = 0.1;

/// With only a warning distance, a body is measured against itself up to this multiple of it.
const OWN_WARNINGS: f64 = 4.0;

/// Surfaces that may touch. Built once, and refitted as points move. Each measurement starts from the last
/// result, which saves time and does not change the answer.
#[derive(Clone, Debug)]
pub struct Contact {
    pub(super) points: Vec<Point>,
    pub(super) bodies: Vec<PreparedBody>,
    /// The rooms as given, for each body.
    given_rooms: Vec<Room>,
    /// Which bodies lie in which rooms.
    rooms: Vec<Within>,
    /// Built when it is first needed.
    graph: OnceLock<SurfaceGraph>,
    options: Options,
    /// The pairs that are measured, and whether they have vertices in common, so that neighbours must be left
    /// out.
    pairs: Vec<([BodyId; 2], bool)>,
    /// The guesses for each pair.
    guesses: Vec<Guesses>,
}

impl Contact {
    /// Prepares `bodies` over `points`: all pairs of bodies will be measured, and each body with itself if
    /// [`Options::own`] is set. What is connected, what is closed and what is a room is decided here, and
    /// stays so when points move.
    ///
    /// # Errors
    /// When there is nothing to measure, a body has no triangles, a triangle names a point beyond `points`,
    /// one of their points is not finite, an option is negative or NaN, or a body is given as the room of one
    /// that does not exist.
    pub fn new(points: Vec<Point>, bodies: Vec<Body>, options: Options, threads: &Threads) -> Result<Self> {
        check(&bodies, &options)?;
        let given_rooms: Vec<Room> = bodies.iter().map(|body| body.room.clone()).collect();
        room::check(&given_rooms)?;
        let vertices = |body: &Body| vertices_of(&format!("surface {}", body.name), &body.triangles, &points);
        let vertices = bodies.iter().map(vertices).collect::<Result<Vec<_>>>()?;
        let joined = joined(&points, &bodies, threads);
        let mut bodies = threads.each(bodies.into_iter().zip(vertices).collect(), |(body, vertices)| {
            PreparedBody::new(body, vertices, &points, &joined, threads)
        });
        let rooms = room::within(&points, &bodies, &given_rooms, threads);
        let n = bodies.len();
        let all = (0..n)
            .flat_map(|a| (a..n).map(move |b| [a, b].map(BodyId::new)))
            .filter(|[a, b]| a != b || options.own);
        let is_joined =
            |[a, b]: [BodyId; 2]| a == b || bodies[a.index()].shares_vertex_with(&bodies[b.index()]);
        let pairs: Vec<_> = all.map(|pair| (pair, is_joined(pair))).collect();
        for &([a, b], is_joined) in &pairs {
            if is_joined || options.facing {
                [a, b].iter().for_each(|id| bodies[id.index()].prepare_facing(&points));
            }
        }
        let guesses = vec![Guesses::default(); pairs.len()];
        Ok(Self { points, bodies, given_rooms, rooms, graph: OnceLock::new(), options, pairs, guesses })
    }

    /// Takes over points that moved; the triangles stay.
    ///
    /// # Errors
    /// When the number of points is not the same as before, or a point of a body is not finite; then nothing
    /// is taken over.
    pub fn refit(&mut self, points: &[Point], threads: &Threads) -> Result<()> {
        if points.len() != self.points.len() {
            return Err(Error::input(format!("got {} points, expected {}", points.len(), self.points.len()))
                .remedy("give all points in their original order"));
        }
        self.bodies.iter().try_for_each(|body| body.check(points))?;
        self.points.copy_from_slice(points);
        threads.each(self.bodies.iter_mut().collect(), |body| body.refit(points, threads));
        Ok(())
    }

    /// The points as they were last given.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// How many bodies there are.
    pub fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    /// The name of a body.
    pub fn name(&self, body: BodyId) -> &str {
        &self.bodies[body.index()].name
    }

    /// The triangles of a body.
    pub fn triangles(&self, body: BodyId) -> &[[VertexId; 3]] {
        &self.bodies[body.index()].triangles
    }

    /// Whether a body is closed, so that it has an inside: every edge is used as often one way as the other,
    /// where vertices repeated by [seams](fn@crate::mesh::seams) count as one.
    pub fn is_closed(&self, body: BodyId) -> bool {
        self.bodies[body.index()].is_closed
    }

    /// On which side of a body its gaps are: outside a closed one, inside a room; on both sides of one that
    /// is open, or a room within another.
    pub fn side(&self, body: BodyId) -> Side {
        self.view_alone(body).free
    }

    /// Which bodies lie in which rooms, by room, then by body: as given, or as found by [`Contact::new`].
    pub fn rooms(&self) -> &[Within] {
        &self.rooms
    }

    /// What a body is the room of, for a handle of the same bodies with other triangles, so that they remain
    /// rooms of the same.
    pub fn room(&self, body: BodyId) -> Room {
        match &self.given_rooms[body.index()] {
            Room::Found => Room::Of(self.rooms.iter().filter(|w| w.room == body).map(|w| w.body).collect()),
            given => given.clone(),
        }
    }

    /// Two bodies as seen by each other.
    pub(super) fn view(&self, [a, b]: [BodyId; 2]) -> [BodyView<'_>; 2] {
        let is_room =
            |room: BodyId, body: BodyId| self.rooms.iter().any(|w| w.room == room && w.body == body);
        match a == b {
            true => [self.view_alone(a); 2],
            false => [self.bodies[a.index()].view(is_room(a, b)), self.bodies[b.index()].view(is_room(b, a))],
        }
    }

    /// A body as seen by itself.
    fn view_alone(&self, body: BodyId) -> BodyView<'_> {
        let is_room =
            self.given_rooms[body.index()] == Room::Yes || self.rooms.iter().any(|w| w.room == body);
        let is_within = self.rooms.iter().any(|w| w.body == body);
        let view = self.bodies[body.index()].view(is_room);
        if is_room && is_within { BodyView { free: Side::Both, ..view } } else { view }
    }

    /// Measures the gap at every vertex, and the nearest points of every pair.
    pub fn measure(&mut self, threads: &Threads) -> Gaps {
        let new = |body: &PreparedBody| BodyGaps::new(&body.vertices, &self.points);
        let mut bodies: Vec<BodyGaps> = self.bodies.iter().map(new).collect();
        let pairs = self.for_each_pair(|scene, guesses| {
            let (gap, sides) = scene.measure(guesses, threads);
            for (side, id) in sides.into_iter().zip(scene.ids) {
                side.merge_into(scene, &mut bodies[id.index()]);
            }
            gap
        });
        Gaps { bodies, pairs }
    }

    /// The nearest points of every pair of bodies and nothing else, as a solver needs them at every
    /// iteration; `None` if nothing is within reach.
    pub fn nearest(&mut self, threads: &Threads) -> Vec<([BodyId; 2], Option<Nearest>)> {
        self.for_each_pair(|scene, guesses| (scene.ids, scene.nearest_only(guesses, threads)))
    }

    fn for_each_pair<T>(&mut self, mut of: impl FnMut(&pair::Scene<'_>, &mut Guesses) -> T) -> Vec<T> {
        let mut guesses = std::mem::take(&mut self.guesses);
        let scenes = self.measured_pairs().zip(&mut guesses).map(|((ids, graph, options), guesses)| {
            let bodies = self.view(ids);
            of(&pair::Scene { points: &self.points, bodies, ids, graph, options }, guesses)
        });
        let answers = scenes.collect();
        self.guesses = guesses;
        answers
    }

    /// Groups of connected vertices with a warning, the nearest first.
    pub fn warned(&self, gaps: &Gaps) -> Vec<Warned> {
        let mut groups: Vec<Warned> = Vec::new();
        for (id, body) in (0..).map(BodyId).zip(&gaps.bodies) {
            let mut is_open = body.warning.clone();
            for seed in 0..is_open.len() {
                if !std::mem::take(&mut is_open[seed]) {
                    continue;
                }
                let (mut group, mut next) = (vec![seed], 0);
                while let Some(&place) = group.get(next) {
                    next += 1;
                    let own = self.bodies[id.index()].ids[place];
                    let around = self.graph().neighbors(own).iter().copied();
                    for near in around.chain([own]).flat_map(|v| self.bodies[id.index()].places_of(v)) {
                        if std::mem::take(&mut is_open[near]) {
                            group.push(near);
                        }
                    }
                }
                let nearer = |x: usize, y: usize| if body.gap[y] < body.gap[x] { y } else { x };
                let at = group.iter().copied().fold(seed, nearer);
                let vertex = body.vertices[at];
                groups.push(Warned {
                    bodies: (id, body.closest_body[at]),
                    n_vertices: group.len(),
                    gap: body.gap[at],
                    vertex,
                    place: self.points[vertex.index()],
                });
            }
        }
        groups.sort_by(|x, y| x.gap.total_cmp(&y.gap).then(x.vertex.cmp(&y.vertex)));
        groups
    }

    /// The edges of all bodies: only warnings and surfaces with vertices in common need them.
    fn graph(&self) -> &SurfaceGraph {
        let triangles = self.bodies.iter().flat_map(|body| &body.joined);
        self.graph.get_or_init(|| SurfaceGraph::new(self.points.len(), triangles))
    }

    /// Each pair, with the paths along the surface if the bodies have vertices in common, and the options
    /// that it is measured with.
    pub(super) fn measured_pairs(
        &self,
    ) -> impl Iterator<Item = ([BodyId; 2], Option<&SurfaceGraph>, Options)> {
        let own = match self.options.own {
            true => Options { within: self.own_reach(), ..self.options },
            false => self.options,
        };
        self.pairs.iter().map(move |&([a, b], is_joined)| {
            ([a, b], is_joined.then(|| self.graph()), if a == b { own } else { self.options })
        })
    }

    /// How far a body is measured against itself.
    fn own_reach(&self) -> f64 {
        let vertices = self.bodies.iter().flat_map(|body| &body.vertices);
        let points = || vertices.map(|v| self.points[v.index()]).collect::<Vec<_>>();
        let size = || mesh::bounds(&points()).map_or(0.0, |[low, high]| distance(low, high));
        match self.options.warn {
            _ if self.options.within.is_finite() => self.options.within,
            Some(warn) => OWN_WARNINGS * warn,
            None => OWN_REACH * size(),
        }
    }
}

/// The joined id of every point: vertices repeated by seams of a body share one.
fn joined(points: &[Point], bodies: &[Body], threads: &Threads) -> Vec<VertexId> {
    let all = threads.each(bodies.iter().collect(), |body| mesh::seams(points, &body.triangles));
    let mut sets = DisjointSets::new(points.len());
    all.iter().flatten().for_each(|[v, first]| sets.join(v.0, first.0));
    sets.roots().into_iter().map(VertexId).collect()
}

fn check(bodies: &[Body], options: &Options) -> Result<()> {
    if bodies.is_empty() || bodies.len() == 1 && !options.own {
        return Err(Error::options(format!(
            "{} surface given, but contact is measured between two",
            bodies.len()
        ))
        .remedy("give another surface, or enable contact of the surface with itself"));
    }
    if bodies.len() > BodyId::MAX_COUNT {
        return Err(Error::options("too many surfaces"));
    }
    options.check()
}
