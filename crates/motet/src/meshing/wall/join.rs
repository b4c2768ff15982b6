//! Joins what was given and its wall into one mesh, with labels, arrays and history.

use super::super::compact::used_vertices;
use super::super::layers::{OutwardLayers, split};
use super::labels::WallLabels;
use super::lumen::Lumen;
use super::options::Options;
use super::report::Report;
use crate::base::{CellId, MaybeId, Point, Result, Threads, VertexId, absent};
use crate::mesh::history::{Changed, History, Ledger, Origins, Rows, Rules, number_anew};
use crate::mesh::{CellKind, Cells, Field, Mesh, Qualities, Spread};

/// Cells that a wall adds, each with the triangle on which it stands and its label.
#[derive(Default)]
struct Added {
    cells: Cells,
    stands_on: Vec<u32>,
    labels: Vec<i32>,
}

impl Added {
    fn push(&mut self, kind: CellKind, vertices: Vec<VertexId>, triangle: u32, label: i32) {
        self.cells.push(kind, vertices);
        self.stands_on.push(triangle);
        self.labels.push(label);
    }

    /// These cells with wedges, pyramids and quads divided into tets and triangles.
    fn split(self, points: &[Point]) -> Self {
        let rows = Field::scalars("row", (0..self.cells.len() as i64).collect::<Vec<_>>());
        let whole = Mesh { cell_data: vec![rows], ..Mesh::new(points.to_vec(), self.cells) };
        let parts = split(whole);
        let rows = parts.cell_data[0].values.to_i64().unwrap_or_default();
        let of = |row: &i64| (self.stands_on[*row as usize], self.labels[*row as usize]);
        let (stands_on, labels) = rows.iter().map(of).unzip();
        Self { cells: parts.cells, stands_on, labels }
    }
}

/// Joins the base of a lumen and its wall.
pub(super) fn join(
    mesh: &Mesh,
    lumen: &Lumen,
    layers: &OutwardLayers,
    options: &Options,
    threads: &Threads,
) -> Result<Changed<Report>> {
    let ends = layers.ends();
    let labels = WallLabels::new(mesh, lumen, &ends, &options.name);
    let n_base = lumen.base.points.len();
    // Points that close the surface are left out.
    let n_virtual = lumen.surfaces.points.len() - n_base;
    let number = |v: VertexId| match v.index() {
        i if i < n_base => v,
        i => VertexId::new(i - n_virtual),
    };
    let numbers = |vertices: &[VertexId]| vertices.iter().map(|v| number(*v)).collect::<Vec<_>>();
    let above = layers.points();
    let mut points = lumen.base.points.clone();
    points.extend(above.iter().map(|(p, _)| *p));

    let mut volume = Added::default();
    for (kind, vertices, t) in layers.cells() {
        volume.push(kind, numbers(&vertices), t, labels.region);
    }
    let mut surface = Added::default();
    let outer = layers.outer();
    for (_, t) in outer.iter().filter(|(_, t)| !lumen.is_cell[*t as usize]) {
        let triangle = lumen.surfaces.triangles[*t as usize].to_vec();
        surface.push(CellKind::TRIANGLE, triangle, *t, labels.interface);
    }
    for (triangle, t) in &outer {
        surface.push(CellKind::TRIANGLE, numbers(triangle), *t, labels.outer);
    }
    for end in &ends {
        let kind = if end.ring.len() == 3 { CellKind::TRIANGLE } else { CellKind::QUAD };
        surface.push(kind, numbers(&end.ring), end.triangle, labels.end(lumen, end));
    }
    let whole =
        options.keep_prisms.then(|| (volume.cells.clone(), volume.stands_on.clone(), volume.labels.clone()));
    let tets = volume.split(&points);
    let eas = spread(&points, &tets.cells, threads);
    let added = match whole {
        Some((cells, stands_on, labels)) => [Added { cells, stands_on, labels }, surface],
        None => [tets, surface.split(&points)],
    };

    let mut cells = lumen.base.cells.clone();
    added
        .iter()
        .for_each(|part| part.cells.iter().for_each(|(_, kind, v)| cells.push(kind, v.iter().copied())));
    let feet = above.iter().map(|(_, foot)| *foot);
    let history = History {
        vertices: vertices(mesh, lumen, feet)?,
        cells: cell_origins(mesh, lumen, added.iter().flat_map(|part| &part.stands_on).copied())?,
        ledger: Ledger::default(),
    };
    let (mut new, history) = without_unused(Mesh::new(points, cells), history)?;
    history.transfer_on(mesh, &mut new, &Rules::default(), threads)?;
    number_anew(&mut new, &absent(history.vertices.kept()), &absent(history.cells.kept()));
    let of_new: Vec<i32> = added.iter().flat_map(|part| &part.labels).copied().collect();
    new.label_names = mesh.label_names.clone();
    labels.write(&mut new, lumen, lumen.base.cells.len(), &of_new);
    let report = Report {
        region: labels.region,
        name: labels.region_name.clone(),
        outer: labels.patch_names[&labels.outer].clone(),
        ends: labels.end_names(),
        interface: outer.len(),
        layers: layers.report(),
        eas,
    };
    Ok(Changed { mesh: new, history, report })
}

/// The EAS of tets.
fn spread(points: &[Point], cells: &Cells, threads: &Threads) -> Option<Spread> {
    let tets: Vec<[VertexId; 4]> = cells.tets().map(|(_, tet)| tet).collect();
    Spread::of_values(&mut Qualities::eas_of_each(points, &tets, threads), true)
}

/// The origins of points: those of the base, then those of the wall, each from its foot.
fn vertices(mesh: &Mesh, lumen: &Lumen, feet: impl Iterator<Item = VertexId>) -> Result<Origins<VertexId>> {
    let mut kept: Vec<MaybeId<VertexId>> = lumen.points.iter().map(|v| (*v).into()).collect();
    let mut rows = Rows::new();
    for foot in feet {
        let foot = lumen.points[foot.index()];
        rows.push(VertexId::new(kept.len()), &[(foot, 1.0)], foot);
        kept.push(MaybeId::NONE);
    }
    Origins::new(mesh.points.len(), kept, rows)
}

/// The origins of cells: those of the base, then those of the wall, each from the cell beside it.
fn cell_origins(mesh: &Mesh, lumen: &Lumen, stands_on: impl Iterator<Item = u32>) -> Result<Origins<CellId>> {
    let (mut kept, mut rows) = (Vec::new(), Rows::new());
    for (cell, &from) in lumen.base.cells.iter().map(|(cell, ..)| cell).zip(&lumen.cells) {
        // Polygons of a surface were divided.
        if mesh.cells.kind(from) == lumen.base.cells.kind(cell) {
            kept.push(from.into());
        } else {
            rows.push(cell, &[(from, 1.0)], from);
            kept.push(MaybeId::NONE);
        }
    }
    for triangle in stands_on {
        let from = lumen.beside[triangle as usize];
        rows.push(CellId::new(kept.len()), &[(from, 1.0)], from);
        kept.push(MaybeId::NONE);
    }
    Origins::new(mesh.cells.len(), kept, rows)
}

/// The mesh without the points of caps that were left out.
fn without_unused(mesh: Mesh, history: History) -> Result<(Mesh, History)> {
    let vertices = (0..mesh.cells.len()).flat_map(|cell| mesh.cells.vertices(CellId::new(cell)));
    let is_used = used_vertices(mesh.points.len(), vertices);
    let kept: Vec<MaybeId<VertexId>> =
        (0..is_used.len()).filter(|&v| is_used[v]).map(|v| VertexId::new(v).into()).collect();
    if kept.len() == mesh.points.len() {
        return Ok((mesh, history));
    }
    let (points, old_to_new) = super::super::compact::compact(&mesh.points, &is_used);
    let then = Origins::new(mesh.points.len(), kept, Rows::new())?;
    let history = History { vertices: history.vertices.then(&then), ..history };
    Ok((Mesh::new(points, mesh.cells.renumbered(&old_to_new)), history))
}
