//! What became of wires.

use serde::Serialize;

use super::super::even;
use super::super::sizes::{Grading, Sizes};
use crate::mesh::Mesh;

/// The surface of wires.
#[derive(Clone, Debug)]
pub struct Tubes {
    /// Triangles that face outward, of the patch `wire`: closed, and free of crossings.
    pub mesh: Mesh,
    /// What became of the wires.
    pub report: Report,
    /// The length of edges at each point: that of the sides of the tubes, and a little more, so that the
    /// triangles between rings need no division.
    pub sizes: Vec<f64>,
    /// Whether each point is so far from where tubes met that its triangles are even as they are.
    pub is_far: Vec<bool>,
    /// How far the surface may stray when it is made even.
    pub allowed: f64,
}

/// What became of wires whose surface was made even.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EvenReport {
    /// How the surface was made even; the surface before is the united tubes.
    #[serde(flatten)]
    pub surface: even::Report,
    /// What became of the wires.
    pub wires: Report,
}

/// The even surface of wires.
#[derive(Clone, Debug)]
pub struct EvenTubes {
    /// The surface.
    pub mesh: Mesh,
    /// What became of it.
    pub report: EvenReport,
}

/// What became of wires. Lengths are in the unit of the points.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Chains of segments, from end or branch to end or branch.
    pub chains: usize,
    /// Segments of the centre lines.
    pub segments: usize,
    /// Segments that a repair left out: not finite, or without length.
    pub left_out: usize,
    /// Cells that are no lines, which are left out.
    pub other_cells: usize,
    /// The length of the centre lines.
    pub length: f64,
    /// The smallest and the largest radius.
    pub radii: [f64; 2],
    /// Sides of each tube.
    pub sides: usize,
    /// Points where three or more segments meet, joined by a ball.
    pub branches: usize,
    /// Bends too sharp for a mitre, joined by a ball.
    pub sharp_bends: usize,
    /// Places where wires that nearly touch are joined by material between them.
    pub bridges: usize,
    /// The smallest gap between wires that stay apart, if one is below the radius.
    pub least_gap: Option<f64>,
    /// The volume of the round wires, each for itself: sections times lengths.
    pub wire_volume: f64,
    /// The volume that the surface encloses.
    pub volume: f64,
    /// Bodies: parts of the surface that are not connected by vertices.
    pub bodies: usize,
    /// Edges of more than two triangles, where wires touch along an edge; at 0, and without pinched
    /// vertices, the surface is a manifold.
    pub branching_edges: usize,
    /// Vertices at which the surface touches itself.
    pub pinched_vertices: usize,
    /// Places where tubes and balls met, apart from each other.
    pub meetings: usize,
    /// How many of these were divided only after points there had been shifted, by a small part of the
    /// radius.
    pub shifted: usize,
    /// How often the sections were turned, since dividing the tubes where they meet failed before.
    pub retries: usize,
}

impl Tubes {
    /// Fills in what options of making the surface even leave open: the distance follows the radius of the
    /// wires, sizes the sides of the tubes.
    pub fn fit(&self, mut options: even::Options) -> even::Options {
        options.adapting.distance = options.adapting.distance.or(Some(self.allowed));
        let is_open = match &options.sizes {
            None => true,
            Some(Sizes::Graded(grading)) => grading.largest.is_none() && grading.at_points.is_none(),
            Some(Sizes::Uniform(_)) => false,
        };
        if is_open {
            let growth = match &options.sizes {
                Some(Sizes::Graded(grading)) => grading.growth,
                _ => Grading::default().growth,
            };
            options.held.clone_from(&self.is_far);
            options.sizes =
                Some(Sizes::Graded(Grading { at_points: Some(self.sizes.clone()), growth, largest: None }));
        }
        options
    }
}

impl Report {
    /// Notes for the reader of a report, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.left_out > 0 {
            notes.push(format!(
                "{} segments that are not finite or have no length are left out",
                self.left_out
            ));
        }
        if self.branching_edges + self.pinched_vertices > 0 {
            notes.push(format!(
                "the surface touches itself: {} edges of more than two triangles, {} vertices",
                self.branching_edges, self.pinched_vertices
            ));
        }
        notes
    }
}
