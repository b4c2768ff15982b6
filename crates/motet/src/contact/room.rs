//! Which bodies are rooms: closed surfaces that others are meant to lie within, such as a vessel around a
//! stent.
//!
//! A closed surface has an inside, but nothing in its triangles says whether that is solid. The caller may
//! state it ([`Room`]); otherwise a closed surface that encloses most of another body's area is the room of
//! that body. A room is one for certain other bodies: a balloon is a body in its vessel, and the room of the
//! wire in it.

use serde::Serialize;

use super::body::{PreparedBody, Room};
use super::inside::{Location, locations};
use crate::base::{BodyId, Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle::area;
use crate::mesh::bounds;
use crate::preflight::crossings;

/// A surface is the room of a body if it encloses more than this fraction of the body's area.
const MIN_SHARE: f64 = 0.5;

/// A body that lies in another, which is its room.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Within {
    /// The body that is the room.
    pub room: BodyId,
    /// The body that lies in it.
    pub body: BodyId,
    /// The fraction of the body's area that was inside when this was found; `None` if it was given.
    pub share: Option<f64>,
}

/// Checks which bodies are given as rooms of which.
///
/// # Errors
/// When a body is given as the room of one that does not exist, or of itself.
pub(super) fn check(rooms: &[Room]) -> Result<()> {
    for (own, room) in rooms.iter().enumerate() {
        let Room::Of(others) = room else { continue };
        if let Some(other) = others.iter().find(|b| b.index() >= rooms.len() || b.index() == own) {
            return Err(Error::options(format!("body {own} cannot be the room of body {other}"))
                .remedy(format!("give other bodies, numbered from 0 to {}", rooms.len() - 1)));
        }
    }
    Ok(())
}

/// All pairs of a room and a body in it, by room, then by body.
pub(super) fn within(
    points: &[Point],
    bodies: &[PreparedBody],
    given: &[Room],
    threads: &Threads,
) -> Vec<Within> {
    let ids = || (0..bodies.len()).map(BodyId::new);
    let pairs = ids().flat_map(|room| ids().map(move |body| [room, body])).filter(|[a, b]| a != b);
    let share = |room: BodyId, body: BodyId| {
        let [room, body] = [room, body].map(|id| &bodies[id.index()]);
        share_within(points, body, room, threads)
    };
    let within = |[room, body]: [BodyId; 2]| {
        let as_given = Within { room, body, share: None };
        match &given[room.index()] {
            Room::No => None,
            Room::Of(others) => others.contains(&body).then_some(as_given),
            Room::Yes => {
                let is_in_it = given[body.index()] == Room::Yes && share(body, room) > MIN_SHARE;
                (!is_in_it).then_some(as_given)
            }
            Room::Found => {
                let inside = share(room, body);
                let is_found = inside > MIN_SHARE && share(body, room) <= MIN_SHARE;
                is_found.then_some(Within { share: Some(inside), ..as_given })
            }
        }
    };
    pairs.filter_map(within).collect()
}

/// The fraction of a body's area inside a closed surface. The rest is outside; what lies on the surface does
/// not count. Each corner stands for a third of its triangle.
fn share_within(points: &[Point], body: &PreparedBody, room: &PreparedBody, threads: &Threads) -> f64 {
    if !room.is_closed || !may_enclose(points, room, body) {
        return 0.0;
    }
    let crossings = crossings(points, &body.triangles, &room.triangles, threads);
    let own = body.joined_vertices();
    let locations = locations(points, &own, &body.joined, &room.joined, &crossings, threads);
    let (mut inside, mut outside) = (0.0, 0.0);
    for (t, triangle) in (0..).zip(&body.joined) {
        let third = area(body.corners(points, t)) / 3.0;
        for v in triangle {
            match own.binary_search(v).map(|i| locations[i]) {
                Ok(Location::Inside) => inside += third,
                Ok(Location::Outside) => outside += third,
                _ => {}
            }
        }
    }
    if inside > 0.0 { inside / (inside + outside) } else { 0.0 }
}

/// Whether the room's box meets that of the body.
fn may_enclose(points: &[Point], room: &PreparedBody, body: &PreparedBody) -> bool {
    let of = |vertices: &[VertexId]| vertices.iter().map(|v| points[v.index()]).collect::<Vec<_>>();
    let boxes = [room, body].map(|body| bounds(&of(&body.vertices)));
    let [Some([low, high]), Some([from, to])] = boxes else { return false };
    (0..3).all(|k| low[k] <= to[k] && from[k] <= high[k])
}
