//! The parts that a surface of wires is joined of: tubes along chains, and balls where chains end at sharp
//! bends and branches.

use std::collections::{BTreeMap, BTreeSet};

use super::centre_lines::CentreLines;
use crate::base::{Point, VertexId, sorted_ids};
use crate::mesh::shapes::{Wire, chains, corner_radius};

/// A line may bend by so much at a point that the section leans by the tangent of 45 degrees.
const MOST_LEAN: f64 = 1.0;

/// Leaning sections may take this part of a segment, so that rings stay apart.
const MOST_OF_SEGMENT: f64 = 0.9;

/// The radius of a ball over that of the wires that it joins. Balls of the same radius would touch tubes all
/// along a circle; of this one they cross them at a definite angle.
pub(super) const BALL_OVER_RADIUS: f64 = 1.1;

/// A ball that joins wires.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) centre: Point,
    pub(super) radius: f64,
}

/// The parts of a surface of wires.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    /// Chains, each with the wires that it was divided into at sharp bends.
    pub(super) chains: Vec<Wire>,
    pub(super) wires: Vec<Wire>,
    pub(super) balls: Vec<Ball>,
    /// How many points there are where three or more segments meet.
    pub(super) branches: usize,
    /// How many bends are too sharp for a mitre.
    pub(super) sharp_bends: usize,
}

impl Parts {
    /// The parts of centre lines, for tubes with so many sides.
    pub(super) fn of(lines: &CentreLines, around: usize) -> Self {
        let mut radii: BTreeMap<VertexId, (f64, f64)> = BTreeMap::new();
        let mut neighbours: BTreeMap<VertexId, BTreeSet<VertexId>> = BTreeMap::new();
        let mut largest = BTreeMap::<VertexId, f64>::new();
        for (&segment, own) in lines.segments.iter().zip(&lines.radii) {
            for k in 0..2 {
                let sum = radii.entry(segment[k]).or_default();
                *sum = (sum.0 + own[k], sum.1 + 1.0);
                neighbours.entry(segment[k]).or_default().insert(segment[1 - k]);
                let most = largest.entry(segment[k]).or_default();
                *most = most.max(own[k]);
            }
        }
        // The radius of a segment whose ends have others: where three or more meet, each keeps its own.
        let of_segment: BTreeMap<[VertexId; 2], [f64; 2]> = lines
            .segments
            .iter()
            .zip(&lines.radii)
            .map(|(s, r)| if s[0] <= s[1] { (*s, *r) } else { (sorted_ids(*s), [r[1], r[0]]) })
            .collect();
        let mut parts = Self::default();
        for (v, others) in neighbours.iter().filter(|(_, others)| others.len() > 2) {
            parts.branches += usize::from(!others.is_empty());
            parts.balls.push(Ball { centre: lines.points[v.index()], radius: BALL_OVER_RADIUS * largest[v] });
        }
        let mean = |v: VertexId| radii[&v].0 / radii[&v].1;
        let corner = corner_radius(around);
        for chain in chains(lines.points.len(), &lines.segments) {
            let ids = &chain.vertices;
            let own_end = |v: VertexId, beside: VertexId| {
                let edge = sorted_ids([v, beside]);
                of_segment.get(&edge).map_or(mean(v), |r| if edge[0] == v { r[0] } else { r[1] })
            };
            let radius = |i: usize| match (chain.closed, i) {
                (false, 0) => own_end(ids[0], ids[1]),
                (false, i) if i + 1 == ids.len() => own_end(ids[i], ids[i - 1]),
                _ => mean(ids[i]),
            };
            let wire = Wire {
                points: ids.iter().map(|v| lines.points[v.index()]).collect(),
                radii: (0..ids.len()).map(radius).collect(),
                closed: chain.closed,
            };
            let cuts = sharp_bends(&wire, corner);
            parts.sharp_bends += cuts.len();
            let ball = |&i: &usize| Ball { centre: wire.points[i], radius: BALL_OVER_RADIUS * wire.radii[i] };
            parts.balls.extend(cuts.iter().map(ball));
            parts.wires.extend(divided(&wire, &cuts));
            parts.chains.push(wire);
        }
        parts
    }
}

/// The points at which a line bends too sharply for the width of its tube: rings there would lean into the
/// next ones. In the order along the line.
pub(super) fn sharp_bends(wire: &Wire, corner: f64) -> Vec<usize> {
    let n = wire.points.len();
    let reach: Vec<f64> = (0..n)
        .map(|i| match wire.lean(i) {
            lean if lean <= MOST_LEAN => lean * corner * wire.radii[i],
            _ => f64::INFINITY,
        })
        .collect();
    let mut is_sharp: Vec<bool> = reach.iter().map(|r| r.is_infinite()).collect();
    loop {
        let mut is_changed = false;
        for segment in 0..wire.n_segments() {
            let [a, b] = wire.ends(segment);
            let [of_a, of_b] = [a, b].map(|i| if is_sharp[i] { 0.0 } else { reach[i] });
            if of_a + of_b > MOST_OF_SEGMENT * wire.length(segment) {
                is_sharp[if of_a > of_b { a } else { b }] = true;
                is_changed = true;
            }
        }
        if !is_changed {
            return (0..n).filter(|&i| is_sharp[i]).collect();
        }
    }
}

/// A line divided at some of its points.
pub(super) fn divided(wire: &Wire, cuts: &[usize]) -> Vec<Wire> {
    let n = wire.points.len();
    let piece = |indices: Vec<usize>| Wire {
        points: indices.iter().map(|&i| wire.points[i % n]).collect(),
        radii: indices.iter().map(|&i| wire.radii[i % n]).collect(),
        closed: false,
    };
    match (wire.closed, cuts) {
        (_, []) => vec![wire.clone()],
        (true, [first, ..]) => {
            let ends = cuts.iter().copied().chain([first + n]).collect::<Vec<_>>();
            ends.windows(2).map(|pair| piece((pair[0]..=pair[1]).collect())).collect()
        }
        (false, _) => {
            let ends = [0].into_iter().chain(cuts.iter().copied()).chain([n - 1]).collect::<Vec<_>>();
            ends.windows(2).map(|pair| piece((pair[0]..=pair[1]).collect())).collect()
        }
    }
}
