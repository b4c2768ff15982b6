//! What a displacement would do, in the order of the page.

use motet::Result;
use motet::base::{CellId, Point, Threads};
use motet::mesh::{BAD_EAS, OrientedTets, Qualities, Spread};
use motet_report::Order;
use serde::{Deserialize, Serialize};

use crate::parts::SeparateParts;

/// The names of arrays whose values follow the mesh; the page knows them by these.
pub(crate) const EAS: &str = "EAS quality";
pub(crate) const GAP: &str = "gap";
/// How many bad tets are shown while a part is dragged: the worst.
const MAX_BAD: usize = 300;

/// The numbers that describe a mesh.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Measured {
    pub(crate) tets: usize,
    /// The EAS of all tets.
    pub(crate) eas: Option<Spread>,
    pub(crate) bad: usize,
    pub(crate) inverted: usize,
    /// The least distance between parts that stand apart.
    pub(crate) gap: Option<f64>,
}

/// The mesh with its vertices elsewhere.
pub(crate) struct Preview {
    pub(crate) measured: Measured,
    /// The EAS of each tet.
    eas: Vec<f64>,
    /// The gap at each vertex, where gaps are measured.
    pub(crate) gaps: Option<Vec<f64>>,
    /// Bad tets, as indices of tets.
    bad: Vec<usize>,
}

impl Preview {
    /// Judges the tets with their vertices at `points`; measures gaps if `parts` are given.
    ///
    /// # Errors
    /// When gaps cannot be measured.
    pub(crate) fn of(
        tets: &OrientedTets,
        parts: Option<&mut SeparateParts>,
        points: &[Point],
        threads: &Threads,
    ) -> Result<Self> {
        let eas = Qualities::eas_of_each(points, &tets.tets, threads);
        let low: Vec<usize> = (0..eas.len()).filter(|&i| eas[i] < BAD_EAS).collect();
        let inverted = low.iter().filter(|&&i| tets.is_inverted(i, points)).count();
        let bad = tets.judge(points, low, BAD_EAS).bad;
        let (gaps, gap) = match parts {
            Some(parts) => {
                let (gaps, least) = parts.gaps(points, threads)?;
                (Some(gaps), Some(least).filter(|gap| gap.is_finite()))
            }
            None => (None, None),
        };
        let spread = Spread::of_values(&mut eas.clone(), true);
        let measured = Measured { tets: eas.len(), eas: spread, bad: bad.len(), inverted, gap };
        Ok(Self { measured, eas, gaps, bad })
    }
}

/// What the page requests while a patch is dragged.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreviewRequest {
    pub(crate) patch: String,
    /// The displacement since the last step.
    pub(crate) by: Point,
    /// The array whose values are shown.
    pub(crate) array: Option<String>,
    /// Whether the inside is shown.
    pub(crate) inside: bool,
}

/// Lists of numbers for the page, each with its name and length: positions, values on the skin and inside,
/// and which cells are bad.
#[derive(Default)]
pub(crate) struct Lists {
    pub(crate) lengths: Vec<(&'static str, usize)>,
    pub(crate) bytes: Vec<u8>,
}

impl Lists {
    pub(crate) fn of(
        preview: &Preview,
        order: &Order,
        tets: &OrientedTets,
        points: &[Point],
        request: &PreviewRequest,
    ) -> Self {
        let mut lists = Self::default();
        let is_shown_inside = request.inside || !preview.bad.is_empty();
        let n = if is_shown_inside { order.vertices.len() } else { order.n_skin };
        let coordinate = |v: usize| points[order.vertices[v].index()].map(|x| x as f32);
        lists.put("points", (0..n).flat_map(coordinate));
        let place_of = |cell: CellId| tets.cells.binary_search(&cell).ok();
        let of_cell = |&cell: &CellId| place_of(cell).map_or(NO_VALUE, |i| preview.eas[i] as f32);
        match (request.array.as_deref(), &preview.gaps) {
            (Some(EAS), _) => {
                lists.put("skin", order.triangles.iter().map(of_cell));
                let solids = if is_shown_inside { &order.solids[..] } else { &[] };
                lists.put("inside", solids.iter().map(of_cell));
            }
            (Some(GAP), Some(gaps)) => {
                let of_vertex = |v: usize| number(gaps[order.vertices[v].index()]);
                lists.put("skin", (0..order.n_skin).map(of_vertex));
                lists.put("inside", (order.n_skin..n).map(of_vertex));
            }
            _ => {
                lists.put("skin", std::iter::empty());
                lists.put("inside", std::iter::empty());
            }
        }
        let worst = worst_cells(preview, tets);
        let is_shown = |(_, cell): &(u32, &CellId)| worst.binary_search(cell).is_ok();
        let bad: Vec<u32> = (0..).zip(&order.solids).filter(is_shown).map(|(i, _)| i).collect();
        lists.lengths.push(("bad", bad.len()));
        lists.bytes.extend(bad.iter().flat_map(|i| i.to_le_bytes()));
        lists
    }

    fn put(&mut self, name: &'static str, numbers: impl Iterator<Item = f32>) {
        let before = self.bytes.len();
        self.bytes.extend(numbers.flat_map(f32::to_le_bytes));
        self.lengths.push((name, (self.bytes.len() - before) / 4));
    }
}

/// The worst of the bad tets, in rising order: more would hide what is dragged.
fn worst_cells(preview: &Preview, tets: &OrientedTets) -> Vec<CellId> {
    let mut bad = preview.bad.clone();
    bad.sort_by(|&a, &b| preview.eas[a].total_cmp(&preview.eas[b]));
    let mut cells: Vec<CellId> = bad.iter().take(MAX_BAD).map(|&i| tets.cells[i]).collect();
    cells.sort_unstable();
    cells
}

/// Stands for "no number" on the page.
const NO_VALUE: f32 = 3e38;

fn number(x: f64) -> f32 {
    if x.is_finite() { x as f32 } else { NO_VALUE }
}
