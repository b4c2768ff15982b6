//! The summary of a mesh in numbers, as printed by `motet info`.

use std::collections::BTreeMap;

use crate::base::{CellId, Point, Threads, VertexId};
#[cfg(feature = "suite")]
use crate::geometry::quality::Measure;
use crate::geometry::vector::{distance, in_range};
use crate::geometry::{quality, triangle};
#[cfg(feature = "suite")]
use crate::mesh::Spread;
use crate::mesh::adjacency::Facets;
use crate::mesh::check::{Defect, DefectKind, SurfaceFacets, check_with, is_closed, is_conforming};
use crate::mesh::curved::CurvedSummary;
use crate::mesh::{
    Boundary, CellKind, Judged, Labels, Mesh, OrientedTets, Qualities, cell_volume, edge_lengths, triangulate,
};

/// A tet below this EAS is bad.
pub const BAD_EAS: f64 = 0.2;

/// The summary of a mesh in numbers. Field names are those of `motet info --json`.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Summary {
    /// Number of points.
    pub points: usize,
    /// Number of cells of each type, by meshio's names.
    pub cells: BTreeMap<String, usize>,
    /// The lowest and the highest corner of the bounding box of all finite points.
    pub bounds: Option<[Point; 2]>,
    /// The sum of the signed volumes of all volume cells, tets oriented by their neighbours, edges taken as
    /// straight.
    pub volume: f64,
    /// Volume cells by label; empty if the mesh has no labels for them.
    pub regions: BTreeMap<String, RegionSummary>,
    /// Surface cells by label; empty if the mesh has no labels for them.
    pub patches: BTreeMap<String, PatchSummary>,
    /// All surface cells together; `None` if there are none.
    pub surface: Option<PatchSummary>,
    /// Shape of the triangles of a mesh without volume cells; `None` if it has volume cells, or no triangles
    /// with finite points.
    pub triangles: Option<TriangleSummary>,
    /// The boundary of the volume cells; `None` if there are none.
    pub boundary: Option<BoundarySummary>,
    /// Shape of the tets (of quadratic ones, by their corners); `None` if there are none.
    pub quality: Option<QualitySummary>,
    /// Quadratic volume cells by their Jacobian; `None` if there are none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub curved: Option<CurvedSummary>,
    /// Number of volume cells that are inverted or flat: their volume, for tets as oriented by their
    /// neighbours, is not positive, or they are quadratic and folded inside.
    pub inverted: usize,
    /// Number of tets that the file numbers opposite to their orientation. They are judged as oriented, and
    /// are not inverted for that alone.
    pub turned: usize,
    /// Whether cells meet facet to facet.
    pub conforming: bool,
    /// Every defect: see [`crate::mesh::check`].
    pub defects: Vec<Defect>,
}

/// The volume cells of one label.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RegionSummary {
    /// Number of tets among them.
    pub tets: usize,
    /// Number of cells of any kind.
    pub cells: usize,
    /// Sum of the signed volumes of these cells.
    pub volume: f64,
}

/// The surface cells of one label.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct PatchSummary {
    /// Number of triangles that they are divided into.
    pub triangles: usize,
    /// Number of cells of any kind.
    pub cells: usize,
    /// Sum of the areas of these cells.
    pub area: f64,
    /// Whether exactly two of these cells meet at each edge.
    pub closed: bool,
}

/// Shape of the triangles of a surface.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct TriangleSummary {
    /// The shortest, the median and the longest edge length.
    pub edges: [f64; 3],
    /// `4 sqrt(3) area / sum of squared edge lengths`: 1 for an equilateral triangle, 0 for one without area.
    pub mean_ratio: MinMean,
    /// The smallest angle in degrees.
    pub min_angle_deg: f64,
    /// The cell that has the triangle of least mean ratio.
    pub worst_cell: CellId,
    /// The centroid of that triangle.
    pub worst_at: Point,
}

/// The boundary of the volume cells.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct BoundarySummary {
    /// Number of facets.
    pub facets: usize,
    /// Number of vertices.
    pub vertices: usize,
}

/// Shape of the tets.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct QualitySummary {
    /// Equi-angle quality.
    pub eas: EasSummary,
    /// Dihedral angles in degrees.
    pub dihedral_deg: Range,
    /// `12 (3V)^(2/3) / sum of squared edge lengths`.
    pub mean_ratio: MinMean,
    /// Quality statistics over all tets.
    pub distribution: Qualities,
    /// The shortest, the median and the longest edge length.
    pub edges: [f64; 3],
}

/// Equi-angle quality of the tets.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct EasSummary {
    /// The worst EAS.
    pub min: f64,
    /// The 1st percentile, the 5th percentile and the median.
    pub percentiles: [f64; 3],
    /// The mean EAS.
    pub mean: f64,
    /// Number of bad tets: below [`BAD_EAS`], and not in a boundary layer.
    pub bad: usize,
    /// Number of tets below [`BAD_EAS`] in a boundary layer: thin on purpose.
    pub layers: usize,
    /// The cell with the worst EAS.
    pub worst_cell: CellId,
    /// The centroid of the corners of that cell.
    pub worst_at: Point,
    /// Number of tets with an EAS below 0, in [0, 0.1), [0.1, 0.2), ... and [0.9, 1].
    pub histogram: [usize; 11],
}

/// The smallest and the largest value.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Range {
    /// The smallest.
    pub min: f64,
    /// The largest value.
    pub max: f64,
}

/// The smallest value and the mean.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MinMean {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
}

impl Summary {
    /// Summarises a mesh; about two seconds for a million tets.
    pub fn of(mesh: &Mesh) -> Self {
        Self::of_oriented(mesh, &OrientedTets::of(mesh, &Threads::single()))
    }

    /// Summarises a mesh, and how some quality measures of its linear and quadratic tets (of quadratic ones,
    /// by their corners) are distributed, in the order of the measures. Tets with a point that is not finite
    /// are left out; no distribution if no tets remain.
    #[cfg(feature = "suite")]
    pub fn with_measures(
        mesh: &Mesh,
        measures: &[Measure],
        threads: &Threads,
    ) -> (Self, Vec<(Measure, Spread)>) {
        let tets = OrientedTets::of(mesh, threads);
        let spreads = Spread::of_tets(mesh, &tets, measures, threads);
        (Self::of_oriented(mesh, &tets), spreads)
    }

    fn of_oriented(mesh: &Mesh, tets: &OrientedTets) -> Self {
        let boundary = Boundary::of(&mesh.cells);
        let defects = check_with(mesh, &boundary, tets);
        let volumes = finite_volumes(mesh, tets);
        let count = |kind| defects.iter().find(|d| d.kind == kind).map_or(0, |d| d.count);
        let surface_cells = || mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        let has_volume = mesh.cells.dim() == Some(3);
        Self {
            points: mesh.points.len(),
            cells: mesh.cells.counts().into_iter().map(|(kind, n)| (kind.label(), n)).collect(),
            bounds: mesh.bounds(),
            // An empty sum is -0 in Rust.
            volume: volumes.iter().sum::<f64>() + 0.0,
            regions: mesh.regions().map(|labels| regions(mesh, &labels, &volumes)).unwrap_or_default(),
            patches: mesh.patches().map(|labels| patches(mesh, &labels)).unwrap_or_default(),
            surface: surface_cells().next().map(|_| patch(mesh, &surface_cells().collect::<Vec<_>>())),
            triangles: if has_volume { None } else { triangle_shapes(mesh) },
            boundary: has_volume
                .then(|| BoundarySummary { facets: boundary.len(), vertices: boundary.vertices.len() }),
            quality: tet_quality(mesh, tets),
            curved: CurvedSummary::of(mesh),
            inverted: count(DefectKind::InvertedCell)
                + count(DefectKind::FlatCell)
                + count(DefectKind::FoldedCell),
            turned: tets.turned.len(),
            conforming: is_conforming(&defects),
            defects,
        }
    }
}

/// The volume of each cell, for tets as oriented; 0 where it is not finite.
fn finite_volumes(mesh: &Mesh, tets: &OrientedTets) -> Vec<f64> {
    let facets = Facets::of(&mesh.cells);
    let are_reversed = tets.are_reversed(mesh.cells.len());
    let volume = |i| {
        let volume = cell_volume(&facets, CellId::new(i), &mesh.points);
        if are_reversed[i] { -volume } else { volume }
    };
    (0..mesh.cells.len()).map(|i| Some(volume(i)).filter(|v| v.is_finite()).unwrap_or(0.0)).collect()
}

/// The name of each label in use, with its number added where two labels share a name.
fn keys(labels: &Labels) -> BTreeMap<i32, String> {
    let used = labels.used();
    let name = |id: &i32| labels.name(*id);
    let shared = |id: &i32| used.iter().filter(|other| name(other) == name(id)).count() > 1;
    used.iter().map(|id| (*id, if shared(id) { format!("{} ({id})", name(id)) } else { name(id) })).collect()
}

fn regions(mesh: &Mesh, labels: &Labels, volumes: &[f64]) -> BTreeMap<String, RegionSummary> {
    let mut by_id: BTreeMap<i32, RegionSummary> = BTreeMap::new();
    for (cell, kind, _) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        let region = by_id.entry(labels.ids[cell.index()]).or_default();
        region.tets += usize::from(matches!(kind, CellKind::TETRA | CellKind::QUADRATIC_TETRA));
        region.cells += 1;
        region.volume += volumes[cell.index()];
    }
    named(labels, by_id)
}

fn patches(mesh: &Mesh, labels: &Labels) -> BTreeMap<String, PatchSummary> {
    let mut by_id: BTreeMap<i32, Vec<SurfaceCell>> = BTreeMap::new();
    for cell in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        by_id.entry(labels.ids[cell.0.index()]).or_default().push(cell);
    }
    named(labels, by_id.into_iter().map(|(id, cells)| (id, patch(mesh, &cells))).collect())
}

/// The summaries by label name; cells without a label count only in the totals.
fn named<T>(labels: &Labels, by_id: BTreeMap<i32, T>) -> BTreeMap<String, T> {
    let keys = keys(labels);
    by_id.into_iter().filter_map(|(id, summary)| Some((keys.get(&id)?.clone(), summary))).collect()
}

type SurfaceCell<'a> = (CellId, CellKind, &'a [VertexId]);

fn patch(mesh: &Mesh, cells: &[SurfaceCell]) -> PatchSummary {
    let mut summary = PatchSummary { cells: cells.len(), ..PatchSummary::default() };
    for (_, kind, vertices) in cells {
        triangulate(*kind, vertices, &mesh.points, &mut |corners| {
            let area = triangle::area(corners.map(|v| mesh.points[v.index()]));
            summary.triangles += 1;
            summary.area += if area.is_finite() { area } else { 0.0 };
        });
    }
    summary.closed = is_closed(SurfaceFacets::from_cells(cells.iter().copied()).rings.iter());
    summary
}

/// Shape of the triangles whose points are finite; other surface cells count as the triangles that they are
/// divided into.
fn triangle_shapes(mesh: &Mesh) -> Option<TriangleSummary> {
    let mut all: Vec<[VertexId; 3]> = Vec::new();
    let (mut worst, mut sum, mut min_angle) = ((f64::INFINITY, CellId::new(0), [0.0; 3]), 0.0, f64::INFINITY);
    for (cell, kind, vertices) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        triangulate(kind, vertices, &mesh.points, &mut |triangle| {
            let corners = triangle.map(|v| mesh.points[v.index()]);
            if !corners.into_iter().all(in_range) {
                return;
            }
            let ratio = triangle_mean_ratio(corners);
            let angles = (0..3).map(|k| triangle::angle_at(corners, k));
            min_angle = angles.fold(min_angle, f64::min);
            sum += ratio;
            if ratio < worst.0 {
                worst = (ratio, cell, triangle::centroid(corners));
            }
            all.push(triangle);
        });
    }
    let edges = edge_lengths(&mesh.points, all.iter().copied())?;
    Some(TriangleSummary {
        edges,
        mean_ratio: MinMean { min: worst.0, mean: sum / all.len() as f64 },
        min_angle_deg: min_angle.to_degrees(),
        worst_cell: worst.1,
        worst_at: worst.2,
    })
}

/// The mean ratio of a triangle: 1 if it is equilateral, 0 if it has no area or no extent.
fn triangle_mean_ratio([a, b, c]: [Point; 3]) -> f64 {
    let squares: f64 = [[a, b], [b, c], [c, a]].iter().map(|[p, q]| distance(*p, *q).powi(2)).sum();
    let ratio = 4.0 * 3f64.sqrt() * triangle::area([a, b, c]) / squares;
    if ratio.is_finite() { ratio } else { 0.0 }
}

/// Shape of the tets whose points are finite; `None` if there are none.
fn tet_quality(mesh: &Mesh, tets: &OrientedTets) -> Option<QualitySummary> {
    let mut total: Option<QualitySummary> = None;
    let (mut all, mut low) = (Vec::new(), Vec::new());
    for (i, &cell) in tets.cells.iter().enumerate() {
        let tet = tets.corners(i, &mesh.points);
        if tet.into_iter().all(in_range) {
            let eas = total.get_or_insert_with(QualitySummary::empty).add(cell, tet);
            all.push(eas);
            if eas < BAD_EAS {
                low.push(i);
            }
        }
    }
    let judged = tets.judge(&mesh.points, low, BAD_EAS);
    let edges = edge_lengths(&mesh.points, tets.tets.iter().copied()).unwrap_or_default();
    total.map(|quality| QualitySummary { edges, ..quality }.finished(&mut all, &judged))
}

impl QualitySummary {
    fn empty() -> Self {
        let eas = EasSummary {
            min: f64::INFINITY,
            percentiles: [1.0; 3],
            mean: 0.0,
            bad: 0,
            layers: 0,
            worst_cell: CellId(0),
            worst_at: [0.0; 3],
            histogram: [0; 11],
        };
        let dihedral_deg = Range { min: f64::INFINITY, max: f64::NEG_INFINITY };
        let mean_ratio = MinMean { min: f64::INFINITY, mean: 0.0 };
        Self { eas, dihedral_deg, mean_ratio, distribution: Qualities::default(), edges: [0.0; 3] }
    }

    /// Adds a tet and returns its EAS. Until [`Self::finished`] is called, the mean ratio is a sum, angles
    /// are in radians, and the distribution is not set.
    fn add(&mut self, cell: CellId, tet: [Point; 4]) -> f64 {
        let (eas, mean_ratio) = (quality::eas(tet), quality::mean_ratio(tet));
        if eas < self.eas.min {
            self.eas.min = eas;
            self.eas.worst_cell = cell;
            self.eas.worst_at = crate::geometry::tet::centroid(tet);
        }
        self.eas.histogram[if eas < 0.0 { 0 } else { 1 + ((eas * 10.0) as usize).min(9) }] += 1;
        let [low, high] = quality::dihedral::min_max(tet);
        self.dihedral_deg.min = self.dihedral_deg.min.min(low);
        self.dihedral_deg.max = self.dihedral_deg.max.max(high);
        self.mean_ratio.min = self.mean_ratio.min.min(mean_ratio);
        self.mean_ratio.mean += mean_ratio;
        eas
    }

    /// Completes the summary. `all` holds the EAS of all tets, and is reordered.
    fn finished(mut self, all: &mut [f64], judged: &Judged) -> Self {
        let all = Qualities::of_values(all, self.mean_ratio.mean).unwrap_or_default();
        self.eas.percentiles = [all.p1, all.p5, all.median];
        (self.eas.bad, self.eas.layers) = (judged.bad.len(), judged.layers.len());
        (self.eas.mean, self.mean_ratio.mean, self.distribution) = (all.mean, all.mean_ratio, all);
        self.dihedral_deg =
            Range { min: self.dihedral_deg.min.to_degrees(), max: self.dihedral_deg.max.to_degrees() };
        self
    }
}
