//! Material between wires that nearly touch, so that no thin gap or sharp crevice remains.

use std::collections::BTreeMap;

use super::options::Options;
use super::parts::{BALL_OVER_RADIUS, Ball, divided, sharp_bends};
use crate::base::{Point, Threads};
use crate::geometry::segment;
use crate::geometry::vector::{add, distance, scale, sub};
use crate::mesh::shapes::{Wire, corner_radius};
use crate::spatial::{BoxTree, bounding_box, expanded};

/// The radius of a bridge over the smaller one of the wires that it joins.
const RADIUS: f64 = 0.75;

/// The distance of places on a wire at which others are looked for, over its radius.
const STEP: f64 = 0.25;

/// A contact no longer than this times the radius of the bridge is joined by a ball, a longer one by a tube.
const SHORT: f64 = 3.0;

/// Places whose distance along one wire, or along two from their common end, is below this times the sum of
/// their radii are not joined: between wires that part at 39 degrees or more there is no sharp crevice.
const APART: f64 = 3.0;

/// Material between wires.
#[derive(Clone, Debug, Default)]
pub(super) struct Bridges {
    pub(super) wires: Vec<Wire>,
    pub(super) balls: Vec<Ball>,
    /// The number of places where wires are joined.
    pub(super) n: usize,
    /// The smallest gap between the round wires that are not joined, if any is below the radius.
    pub(super) least_gap: Option<f64>,
}

/// A place where wires are near each other.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// The two wires, and how far along the first.
    wires: [u32; 2],
    step: u32,
    /// The distance of the round wires, negative where they overlap.
    gap: f64,
    middle: Point,
    radius: f64,
}

/// A segment of a wire, with the length of the wire up to it.
struct Piece {
    wire: u32,
    ends: [Point; 2],
    radii: [f64; 2],
    begin: f64,
    length: f64,
}

impl Bridges {
    /// The bridges between wires that are nearer than the options say, or overlap by less.
    pub(super) fn of(wires: &[Wire], around: usize, options: &Options, threads: &Threads) -> Self {
        let pieces = pieces(wires);
        let largest = pieces.iter().flat_map(|piece| piece.radii).fold(0.0, f64::max);
        let reach = 2.0 * largest + options.gap(largest).max(largest);
        let boxes: Vec<_> = pieces.iter().map(|piece| expanded(bounding_box(piece.ends), reach)).collect();
        let tree = BoxTree::new(&boxes);
        let lengths: Vec<f64> =
            wires.iter().map(|w| (0..w.n_segments()).map(|s| w.length(s)).sum()).collect();
        let found: Vec<Vec<Contact>> = threads.map(wires.len(), |w| {
            let mut found = Vec::new();
            contacts(w, wires, &pieces, &tree, &lengths, &mut found);
            found
        });
        let mut bridges = Self::default();
        let mut by_pair: BTreeMap<[u32; 2], Vec<Contact>> = BTreeMap::new();
        for contact in found.into_iter().flatten() {
            let allowed = options.gap(contact.radius / RADIUS);
            if contact.gap <= allowed {
                by_pair.entry(contact.wires).or_default().push(contact);
            } else if contact.gap < contact.radius / RADIUS {
                bridges.least_gap = Some(bridges.least_gap.map_or(contact.gap, |g| g.min(contact.gap)));
            }
        }
        for contacts in by_pair.values() {
            let is_next =
                |a: &Contact, b: &Contact| b.step == a.step + 1 && distance(a.middle, b.middle) < a.radius;
            for run in contacts.chunk_by(is_next) {
                let least = run.iter().map(|contact| contact.gap).fold(f64::INFINITY, f64::min);
                let allowed = options.gap(run[0].radius / RADIUS);
                // Wires that overlap by more are one body already.
                if allowed > 0.0 && least >= -allowed {
                    bridges.add(run, around);
                }
            }
        }
        bridges
    }

    /// Adds the bridge of one run of places.
    fn add(&mut self, run: &[Contact], around: usize) {
        self.n += 1;
        let length: f64 = run.windows(2).map(|pair| distance(pair[0].middle, pair[1].middle)).sum();
        let nearest =
            run.iter().min_by(|a, b| a.gap.abs().total_cmp(&b.gap.abs())).expect("runs are not empty");
        if length <= SHORT * nearest.radius {
            self.balls.push(Ball { centre: nearest.middle, radius: nearest.radius });
            return;
        }
        // Every other place suffices.
        let mut wire = Wire { points: Vec::new(), radii: Vec::new(), closed: false };
        for contact in run {
            if wire.points.last().is_none_or(|last| distance(*last, contact.middle) > 0.5 * contact.radius) {
                wire.points.push(contact.middle);
                wire.radii.push(contact.radius);
            }
        }
        let cuts = sharp_bends(&wire, corner_radius(around));
        let ball = |&i: &usize| Ball { centre: wire.points[i], radius: BALL_OVER_RADIUS * wire.radii[i] };
        self.balls.extend(cuts.iter().map(ball));
        self.wires.extend(divided(&wire, &cuts));
    }
}

fn pieces(wires: &[Wire]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (number, wire) in (0u32..).zip(wires) {
        let mut begin = 0.0;
        for s in 0..wire.n_segments() {
            let [ends, radii] = [wire.ends(s); 2];
            let length = wire.length(s);
            pieces.push(Piece {
                wire: number,
                ends: ends.map(|i| wire.points[i]),
                radii: radii.map(|i| wire.radii[i]),
                begin,
                length,
            });
            begin += length;
        }
    }
    pieces
}

/// The places at which a wire is near later ones, or near a part of itself farther along.
fn contacts(
    number: usize,
    wires: &[Wire],
    pieces: &[Piece],
    tree: &BoxTree,
    lengths: &[f64],
    found: &mut Vec<Contact>,
) {
    let (wire, mut touching, mut step, mut begin) = (&wires[number], Vec::new(), 0u32, 0.0);
    for s in 0..wire.n_segments() {
        let [a, b] = wire.ends(s);
        let length = wire.length(s);
        let n = (length / (STEP * wire.radii[a].min(wire.radii[b]))).ceil().max(1.0) as usize;
        for k in 0..n {
            step += 1;
            let share = (k as f64 + 0.5) / n as f64;
            let place = add(scale(wire.points[a], 1.0 - share), scale(wire.points[b], share));
            let radius = (1.0 - share) * wire.radii[a] + share * wire.radii[b];
            let along = begin + share * length;
            tree.touching([place; 2], &mut touching);
            touching.sort_unstable();
            let mut best: BTreeMap<u32, Contact> = BTreeMap::new();
            for other in touching.iter().map(|&i| &pieces[i as usize]).filter(|o| o.wire as usize >= number) {
                let t = segment::closest(other.ends, place);
                let at = add(other.ends[0], scale(sub(other.ends[1], other.ends[0]), t));
                let of_other = (1.0 - t) * other.radii[0] + t * other.radii[1];
                let way = way(
                    wires,
                    lengths,
                    [number, other.wire as usize],
                    [along, other.begin + t * other.length],
                );
                if way < APART * (radius + of_other) {
                    continue;
                }
                let off = distance(place, at);
                let gap = off - radius - of_other;
                let share = if off > 0.0 { (radius + 0.5 * gap) / off } else { 0.5 };
                let middle = add(place, scale(sub(at, place), share));
                let contact = Contact {
                    wires: [number as u32, other.wire],
                    step,
                    gap,
                    middle,
                    radius: RADIUS * radius.min(of_other),
                };
                let nearer = best.get(&other.wire).is_none_or(|known| gap < known.gap);
                if nearer {
                    best.insert(other.wire, contact);
                }
            }
            found.extend(best.into_values());
        }
        begin += length;
    }
}

/// The way between places of two wires, given by how far along them they are: along one wire, or from an end
/// that both have; infinite where there is none. Along one wire it is negative for a place that comes before.
fn way(wires: &[Wire], lengths: &[f64], [a, b]: [usize; 2], [along_a, along_b]: [f64; 2]) -> f64 {
    if a == b {
        let way = along_b - along_a;
        return if wires[a].closed { way.min(lengths[a] - way) } else { way };
    }
    if wires[a].closed || wires[b].closed {
        return f64::INFINITY;
    }
    let ends = |w: usize, along: f64| {
        let points = &wires[w].points;
        [(points[0], along), (points[points.len() - 1], lengths[w] - along)]
    };
    let mut least = f64::INFINITY;
    for (p, way_a) in ends(a, along_a) {
        for (_, way_b) in ends(b, along_b).into_iter().filter(|(q, _)| *q == p) {
            least = least.min(way_a + way_b);
        }
    }
    least
}
