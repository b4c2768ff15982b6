//! How near patches are to each other, and for how long contact is ruled out.

use crate::base::{BodyId, Point, Result, Threads, VertexId};
use crate::contact::{self, Contact, FirstContact};
use crate::mesh::Mesh;
use crate::moving::options::Watching;
use crate::moving::step::{Closest, Gaps};

/// The watched patches: prepared once for each mesh, refitted at each step.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    watching: Watching,
    contact: Option<Contact>,
    /// The last measurement.
    pub(super) last: Option<contact::Gaps>,
}

impl Watch {
    pub(super) fn new(watching: Watching) -> Self {
        Self { watching, contact: None, last: None }
    }

    /// Discards the prepared search after the mesh has changed its triangles.
    pub(super) fn forget(&mut self) {
        self.contact = None;
    }

    /// Whether [`Self::last`] refers to triangles that no longer exist, or does not exist.
    pub(super) fn is_stale(&self) -> bool {
        self.contact.is_none()
    }

    /// Measures the gaps, and looks ahead if a velocity and a duration are given.
    pub(super) fn measure(
        &mut self,
        mesh: &Mesh,
        velocity: Option<(&[Point], f64)>,
        threads: &Threads,
    ) -> Result<Gaps> {
        let contact = match self.contact.take() {
            Some(mut contact) => {
                contact.refit(&mesh.points, threads)?;
                contact
            }
            None => {
                let bodies = self.watching.bodies(mesh)?;
                let options = within_reach(&bodies, self.watching.options);
                Contact::new(mesh.points.clone(), bodies, options, threads)?
            }
        };
        let contact = self.contact.insert(contact);
        let gaps = contact.measure(threads);
        let first = match velocity {
            Some((velocity, dt)) => {
                let horizon = self.watching.horizon.unwrap_or(dt);
                contact.look_ahead(velocity, horizon, threads)?.first
            }
            None => None,
        };
        let report = report_of(contact, &gaps, first);
        self.last = Some(gaps);
        Ok(report)
    }
}

/// With only a warning distance given, connected patches are measured up to this multiple of it.
const JOINED_WARNINGS: f64 = 4.0;

/// Patches that share vertices are near each other everywhere along what they share; which of that is a gap
/// is found by paths along the surface. Without a limit the search covers the whole wall: 6 s per step for a
/// flap of 336 triangles, 7 ms within two warning distances.
fn within_reach(bodies: &[contact::Body], options: contact::Options) -> contact::Options {
    let Some(warn) = options.warn.filter(|_| options.within == f64::INFINITY) else { return options };
    let vertices = |body: &contact::Body| {
        let mut all: Vec<VertexId> = body.triangles.as_flattened().to_vec();
        all.sort_unstable();
        all.dedup();
        all
    };
    let mut all: Vec<VertexId> = bodies.iter().flat_map(vertices).collect();
    all.sort_unstable();
    let is_joined = all.windows(2).any(|pair| pair[0] == pair[1]);
    contact::Options { within: if is_joined { JOINED_WARNINGS * warn } else { options.within }, ..options }
}

fn report_of(contact: &Contact, gaps: &contact::Gaps, first: Option<FirstContact>) -> Gaps {
    let name = |body: BodyId| contact.name(body).to_owned();
    let pairs = gaps.pairs.iter().map(|pair| Closest {
        patches: pair.bodies.map(name),
        gap: pair.nearest.map(|nearest| nearest.distance),
        place: pair.nearest.map(|nearest| nearest.points[0]),
        crossings: pair.crossings.len(),
    });
    Gaps {
        least: Some(gaps.least()).filter(|least| least.is_finite()),
        pairs: pairs.collect(),
        held: 0,
        farthest_held: None,
        cramped: None,
        warned: gaps.bodies.iter().map(|body| body.warning.iter().filter(|w| **w).count()).sum(),
        touch_not_before: first.map(|first| first.time),
    }
}
