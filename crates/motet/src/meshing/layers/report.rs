//! Statistics on layers.

use serde::Serialize;

use super::columns::Columns;
use super::skin::Skin;
use super::thickness::Heights;
use crate::base::{Point, VertexId};

/// A thickness counts as full from this fraction of the requested one: the rest is rounding.
const ALL: f64 = 1.0 - 1e-9;

/// Statistics on layers. Vertices are those of walls with layers, counted once per body; thickness is that of
/// all layers together, normal to the wall.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Cells of the layers before division: prisms, and pyramids and tets where columns end.
    pub prisms: usize,
    /// Tets that these cells are divided into.
    pub tets: usize,
    /// The volume of the layers.
    pub volume: f64,
    /// Vertices of walls on which layers were requested.
    pub vertices: usize,
    /// Vertices whose layers are as thick as requested.
    pub full: usize,
    /// Vertices whose layers gave way: thinner, or none.
    pub reduced: usize,
    /// Vertices without layers.
    pub without: usize,
    /// The least, the median and the largest thickness over vertices that have layers; `null` if there are
    /// none.
    pub thickness: Option<[f64; 3]>,
    /// The smallest ratio of actual to requested thickness at any vertex; 0 if one has no layers.
    pub least_share: f64,
    /// The position of that vertex.
    pub least_at: Option<Point>,
    /// The number of rounds in which layers had to be made thinner than the first estimate allowed.
    pub rounds: usize,
}

impl Report {
    /// Computes everything except cells and volumes.
    pub(super) fn new(skin: &Skin, columns: &Columns, heights: &Heights, rounds: usize) -> Self {
        let mut report = Self { rounds, least_share: 1.0, ..Self::default() };
        let mut found = Vec::new();
        for (w, &requested) in heights.requested.iter().enumerate().filter(|(_, requested)| **requested > 0.0)
        {
            let thickness = heights.heights[w];
            let share = thickness / requested;
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
