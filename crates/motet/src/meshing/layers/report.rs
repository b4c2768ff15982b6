//! What came of the layers.

use serde::Serialize;

use super::columns::Columns;
use super::skin::Skin;
use super::thickness::Heights;
use crate::base::{Point, VertexId};

/// A thickness counts as what was asked from this part of it on: the rest is rounding.
const ALL: f64 = 1.0 - 1e-9;

/// How layers went. Vertices are those of walls with layers, once for each body; thickness is that of all layers together, at right angles to
/// the wall.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Cells of the layers before they are divided: prisms, where columns end pyramids and tets.
    pub prisms: usize,
    /// The tets that they are divided into.
    pub tets: usize,
    /// Their volume.
    pub volume: f64,
    /// Vertices of walls on which layers were asked for.
    pub vertices: usize,
    /// Those whose layers are as thick as asked.
    pub full: usize,
    /// Those whose layers gave way: thinner, or none.
    pub reduced: usize,
    /// Those without any.
    pub without: usize,
    /// The least, the median and the largest thickness, those without left out; `null` where no layer stands.
    pub thickness: Option<[f64; 3]>,
    /// The least part of the thickness asked that a vertex has; 0 where one has none.
    pub least_share: f64,
    /// Where that is.
    pub least_at: Option<Point>,
    /// How often layers had to be made thinner, once all were as thick as there is room.
    pub rounds: usize,
}

impl Report {
    /// All but cells and volumes.
    pub(super) fn new(skin: &Skin, columns: &Columns, heights: &Heights, rounds: usize) -> Self {
        let mut report = Self { rounds, least_share: 1.0, ..Self::default() };
        let mut found = Vec::new();
        for (w, &asked) in heights.asked.iter().enumerate().filter(|(_, asked)| **asked > 0.0) {
            let thickness = heights.heights[w];
            let share = thickness / asked;
            report.vertices += 1;
            report.full += usize::from(share >= ALL);
            report.without += usize::from(columns.count(VertexId::new(w)) == 0);
            if share < report.least_share.min(ALL) {
                (report.least_share, report.least_at) = (share, Some(skin.points[w]));
            }
            found.extend((thickness > 0.0).then_some(thickness));
        }
        report.reduced = report.vertices - report.full;
        found.sort_by(f64::total_cmp);
        let middle = found.len() / 2;
        report.thickness = found.first().map(|&least| [least, found[middle], found[found.len() - 1]]);
        report
    }
}
