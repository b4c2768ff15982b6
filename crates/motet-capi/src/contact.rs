//! Contact: distances between surfaces, and when they will touch.

use motet::base::{Threads, VertexId};
use motet::contact::{Body, Contact, GapWords, Room};
use motet::{Error, Result};

use crate::constants;
use crate::guard::{MotetError, guarded};
use crate::memory::{
    count, expect, free, handle, handle_mut, id, optional, out_handle, read_versioned, rows, set_handle,
    threads, values, values_mut, versioned, vertex,
};

/// Surfaces and the threads that measure them.
pub(crate) struct MotetContact {
    contact: Contact,
    threads: Threads,
}

versioned! {
    /// See the header.
    MotetContactOptions, motet_contact_options_init {
        warn: f64 = 0.0,
        within: f64 = 0.0,
        fold: f64 = 3.0,
        own: i32 = 0,
        facing: i32 = 0,
        threads: i32 = 0,
    }
}

impl MotetContactOptions {
    fn words(&self) -> GapWords {
        GapWords {
            warn: optional(self.warn),
            within: optional(self.within),
            own: self.own != 0,
            facing: self.facing != 0,
            fold: self.fold,
        }
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_new(
    points: *const f64,
    n_points: i64,
    stride: i64,
    triangles: *const i32,
    counts: *const i64,
    is_room: *const i32,
    n_bodies: i64,
    options: *const MotetContactOptions,
    contact: *mut *mut MotetContact,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(contact, "contact")?;
        let given = read_versioned(options)?;
        let threads = threads(given.threads)?;
        let points = rows(points, n_points, stride, "points")?.into_owned();
        let bodies = BodyArrays { triangles, counts, is_room, n_bodies }.bodies(points.len())?;
        let contact = Contact::new(points, bodies, given.words().options(), &threads)?;
        set_handle(place, MotetContact { contact, threads });
        Ok(())
    })
}

/// Bodies as C passes them.
struct BodyArrays {
    /// Three vertices for each triangle, body after body.
    triangles: *const i32,
    /// The number of triangles of each body.
    counts: *const i64,
    /// Whether each body is a room; NULL: found for all.
    is_room: *const i32,
    n_bodies: i64,
}

impl BodyArrays {
    fn bodies(&self, n_points: usize) -> Result<Vec<Body>> {
        let n = count(self.n_bodies, "bodies")?;
        let counts = values(self.counts, n, "counts")?.iter().map(|&k| count(k, "triangles"));
        let counts: Vec<usize> = counts.collect::<Result<_>>()?;
        let rooms = self.rooms(n)?;
        let n_ids =
            counts.iter().try_fold(0usize, |sum, &k| sum.checked_add(k)).and_then(|k| k.checked_mul(3));
        let n_ids = n_ids.ok_or_else(|| Error::options("more triangles than ids"))?;
        let mut rest = values(self.triangles, n_ids, "triangles")?.as_chunks::<3>().0.iter().enumerate();
        let mut bodies = Vec::with_capacity(n);
        for (room, k) in rooms.into_iter().zip(counts) {
            let triangle = |(t, corners): (usize, &[i32; 3])| {
                let [a, b, c] = corners.map(|v| vertex(v, n_points, &format!("triangle {t}")));
                Ok([a?, b?, c?])
            };
            let triangles: Vec<[VertexId; 3]> = rest.by_ref().take(k).map(triangle).collect::<Result<_>>()?;
            bodies.push(Body { name: format!("body {}", bodies.len()), triangles, room });
        }
        Ok(bodies)
    }

    fn rooms(&self, n: usize) -> Result<Vec<Room>> {
        if self.is_room.is_null() {
            return Ok(vec![Room::Found; n]);
        }
        values(self.is_room, n, "is_room")?.iter().map(|&number| constants::room(number)).collect()
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_free(contact: *mut MotetContact) {
    free(contact);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_refit(
    contact: *mut MotetContact,
    points: *const f64,
    n_points: i64,
    stride: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetContact { contact, threads } = handle_mut(contact, "contact")?;
        contact.refit(&rows(points, n_points, stride, "points")?, threads)
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_measure(
    contact: *mut MotetContact,
    gaps: *mut f64,
    n_points: i64,
    least: *mut f64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetContact { contact, threads } = handle_mut(contact, "contact")?;
        expect(n_points, contact.points().len(), "gaps")?;
        let out = values_mut(gaps, contact.points().len(), "gaps")?;
        let measured = contact.measure(threads);
        out.fill(f64::INFINITY);
        for body in &measured.bodies {
            for (v, gap) in body.vertices.iter().zip(&body.gap) {
                out[v.index()] = out[v.index()].min(*gap);
            }
        }
        // SAFETY: the header requires NULL or a place for a number.
        if let Some(place) = unsafe { least.as_mut() } {
            *place = measured.least();
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_nearest(
    contact: *mut MotetContact,
    first: i32,
    second: i32,
    distance: *mut f64,
    places: *mut f64,
    triangles: *mut i32,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetContact { contact, threads } = handle_mut(contact, "contact")?;
        let distance = handle_mut(distance, "distance")?;
        let pair = [first, second].map(i64::from);
        let found = contact.nearest(threads).into_iter();
        let mut found = found.map(|(bodies, nearest)| (bodies.map(|body| i64::from(body.0)), nearest));
        let Some((bodies, nearest)) =
            found.find(|(bodies, _)| *bodies == pair || [bodies[1], bodies[0]] == pair)
        else {
            return Err(Error::options(format!(
                "bodies {first} and {second} are not measured against each other"
            ))
            .remedy(format!("there are {}, from 0", contact.n_bodies())));
        };
        *distance = nearest.map_or(f64::INFINITY, |nearest| nearest.distance);
        let Some(nearest) = nearest else { return Ok(()) };
        let is_turned = bodies != pair;
        let order = |[a, b]: [usize; 2]| if is_turned { [b, a] } else { [a, b] };
        if !places.is_null() {
            let out = values_mut(places, 6, "places")?;
            for (k, of) in order([0, 1]).into_iter().enumerate() {
                out[3 * k..][..3].copy_from_slice(&nearest.points[of]);
            }
        }
        if !triangles.is_null() {
            let out = values_mut(triangles, 2, "triangles")?;
            out.copy_from_slice(&order([0, 1]).map(|of| id(nearest.triangles[of])));
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_contact_ahead(
    contact: *const MotetContact,
    velocity: *const f64,
    n_points: i64,
    stride: i64,
    horizon: f64,
    time: *mut f64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetContact { contact, threads } = handle(contact, "contact")?;
        let time = handle_mut(time, "time")?;
        let horizon = optional(horizon).unwrap_or(f64::INFINITY);
        let ahead = contact.look_ahead(&rows(velocity, n_points, stride, "velocity")?, horizon, threads)?;
        *time = ahead.first.map_or(f64::INFINITY, |first| first.time);
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::Versioned;

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let words = MotetContactOptions::DEFAULT.words();
        assert_eq!(format!("{words:?}"), format!("{:?}", GapWords::default()));
    }
}
