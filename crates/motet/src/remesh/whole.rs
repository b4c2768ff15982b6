//! Remeshing of a whole mesh: cells of other kinds stay, and arrays are carried across.

use std::collections::BTreeMap;
use std::time::Instant;

use crate::base::{CellId, Csr, MaybeId, Point, Result, Threads, VertexId, absent};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{dot, sub};
use crate::kernel::Extract;
use crate::mesh::history::{Changed, History, Origins, Rules, number_anew};
use crate::mesh::{CellKind, Cells, Cutout, Field, Mesh, TetPart};
use crate::remesh::held::{Held, Required};
use crate::remesh::run::{Outcome, remesh_keeping};
use crate::remesh::{Options, Report};
use crate::spatial::trace::{ChangedVertex, Labelled, LocalChange, quadratic_rows, trace};

/// Tets of a part with a vertex within this many layers of its cut are near it.
const NEAR_CUT: u8 = 2;

/// Repairs the bad tets of a mesh of any cells, and carries its arrays across by `rules`. Whatever is
/// unchanged stays to the bit: points, cells, rows of arrays.
/// Where the surface may change, lines are divided and merged with their edges; vertices of cells of other
/// kinds are neither moved nor removed. What is marked as required (see [`marks`](crate::mesh::marks)) stays.
/// If `GlobalNodeID` and `GlobalElementID` number points and tets, new ones get new numbers.
///
/// # Errors
/// If there is no tet, if the tets do not form a valid mesh (the error names the first offending cell), and
/// if a rule fits no array.
pub fn remesh_mesh(
    mesh: &Mesh,
    options: &Options,
    rules: &Rules,
    threads: &Threads,
) -> Result<Changed<Report>> {
    let (part, extract_seconds) = extract_tets(mesh, options)?;
    let mut outcome = remesh_part(mesh, &part, options, rules, threads)?;
    outcome.report.seconds.join += extract_seconds;
    Ok(outcome)
}

/// Repairs the bad tets of a mesh as [`remesh_mesh`] does, given its tets as `part`. In `part`, more vertices
/// and edges can be fixed than those at other cells.
///
/// # Errors
/// The errors of [`remesh_mesh`].
pub fn remesh_part(
    mesh: &Mesh,
    part: &TetPart,
    options: &Options,
    rules: &Rules,
    threads: &Threads,
) -> Result<Changed<Report>> {
    let Repaired { mut report, extract, joined } = changed(mesh, part, options, threads)?;
    let begin = Instant::now();
    let history = history(mesh, part, &extract, &joined, threads)?;
    let new_points = absent(&extract.vertex_to_old);
    let mut new = Mesh::new(extract.mesh.points, joined.cells);
    pass_arrays(mesh, &mut new, &history, &new_points, rules, threads)?;
    report.seconds.history = begin.elapsed().as_secs_f64();
    Ok(Changed { mesh: new, history, report })
}

/// Repairs the bad tets of a part of a mesh, and puts it back. The part has been cut out of `whole`, whose
/// vertices are at `points`, and may have been moved since; the options are for it as a mesh of its own.
/// `None` if tets near its cut were changed, so that tets beyond might have been, too. The tets of the report
/// are those of the whole meshes, all counts are of the part.
///
/// # Errors
/// The errors of [`remesh_mesh`].
pub(crate) fn remesh_cutout(
    whole: &Mesh,
    points: &[Point],
    cutout: &Cutout,
    options: &Options,
    rules: &Rules,
    threads: &Threads,
) -> Result<Option<Changed<Report>>> {
    let (mut part, extract_seconds) = extract_tets(&cutout.mesh, options)?;
    cutout.fix_cut(&mut part);
    let Repaired { report, extract, joined } = changed(&cutout.mesh, &part, options, threads)?;
    let is_near_cut = |&v: &VertexId| cutout.is_near_cut(v, NEAR_CUT);
    if extract.removed_tets.iter().any(|t| part.mesh.tets[t.index()].iter().any(is_near_cut)) {
        return Ok(None);
    }
    let begin = Instant::now();
    let history = history(&cutout.mesh, &part, &extract, &joined, threads)?;
    let changed_part = Mesh::new(extract.mesh.points, joined.cells);
    let back = cutout.put_back(whole, points, &changed_part, &extract.vertex_to_old, &history)?;
    let new_points = absent(&extract.vertex_to_old).into_iter().map(|v| back.vertices[v.index()]);
    let mut new = back.mesh;
    pass_arrays(whole, &mut new, &back.history, &new_points.collect::<Vec<_>>(), rules, threads)?;
    let mut report = report.in_cells(|cell| cutout.cells[cell.index()], |cell| back.cells[cell.index()]);
    report.seconds.join += extract_seconds;
    report.seconds.history = begin.elapsed().as_secs_f64();
    Ok(Some(Changed { mesh: new, history: back.history, report }))
}

/// Passes the arrays of a mesh to a changed one, in which `new_points` were inserted.
fn pass_arrays(
    old: &Mesh,
    new: &mut Mesh,
    history: &History,
    new_points: &[VertexId],
    rules: &Rules,
    threads: &Threads,
) -> Result<()> {
    history.transfer_on(old, new, rules, threads)?;
    number_anew(new, new_points, &absent(history.cells.kept()));
    new.unmark(new_points);
    Ok(())
}

/// Whether all arrays of a mesh are labels of its cells, so that [`remesh_labelled`] loses none.
pub fn has_only_labels(mesh: &Mesh) -> bool {
    mesh.point_data.is_empty() && labels(mesh).count() == mesh.cell_data.len()
}

/// The arrays that hold the regions and patches of a mesh.
fn labels(mesh: &Mesh) -> impl Iterator<Item = &Field> {
    let arrays = [mesh.regions(), mesh.patches()].map(|labels| labels.map(|labels| labels.array));
    mesh.cell_data.iter().filter(move |field| arrays.iter().flatten().any(|array| *array == field.name))
}

/// Repairs the bad tets of a mesh as [`remesh_mesh`] does, but keeps only the labels of its cells and builds
/// no history, which takes as long as the repair where most tets change. Returns the new mesh and the report.
///
/// # Errors
/// If there is no tet, and if the tets do not form a valid mesh (the error names the first offending cell).
pub fn remesh_labelled(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<(Mesh, Report)> {
    let (part, extract_seconds) = extract_tets(mesh, options)?;
    let Repaired { mut report, extract, joined } = changed(mesh, &part, options, threads)?;
    report.seconds.join += extract_seconds;
    let sources = joined.label_sources(&part, &extract);
    let pick = |field: &Field| field.pick(sources.iter().map(|cell| cell.index()));
    let new = Mesh {
        cell_data: labels(mesh).map(pick).collect(),
        field_data: mesh.field_data.clone(),
        label_names: mesh.label_names.clone(),
        ..Mesh::new(extract.mesh.points, joined.cells)
    };
    Ok((new, report))
}

/// Checks the options and extracts the tets of a mesh; returns them with the seconds that it took.
fn extract_tets(mesh: &Mesh, options: &Options) -> Result<(TetPart, f64)> {
    options.check()?;
    let begin = Instant::now();
    let part = TetPart::of(mesh)?;
    Ok((part, begin.elapsed().as_secs_f64()))
}

/// A mesh after remeshing, before its arrays are carried across.
struct Repaired {
    report: Report,
    extract: Extract,
    joined: Joined,
}

fn changed(mesh: &Mesh, part: &TetPart, options: &Options, threads: &Threads) -> Result<Repaired> {
    let tet_of = |cell: &CellId| part.tet_to_cell.binary_search(cell).ok().map(CellId::new);
    let only = options.only.as_ref().map(|only| only.iter().filter_map(tet_of).collect());
    let held = Held { cells: options.held.cells.iter().filter_map(tet_of).collect(), ..options.held.clone() };
    let mut options = Options { only, held, ..options.clone() };
    if let Some(cells) = options.improve.as_mut().and_then(|improve| improve.cells.as_mut()) {
        *cells = cells.iter().filter_map(tet_of).collect();
    }
    let required = Required::of(mesh, part);
    let Outcome { mut report, extract } =
        remesh_keeping(&part.mesh, &required, &options, threads).map_err(|error| part.at_cell(error))?;
    let begin = Instant::now();
    let joined = Joined::of(mesh, part, &extract);
    report.seconds.extract += begin.elapsed().as_secs_f64();
    let report = report.in_cells(|tet| part.tet_to_cell[tet.index()], |tet| joined.tet_to_cell[tet.index()]);
    Ok(Repaired { report, extract, joined })
}

/// The cells of the new mesh, and the old cell of each.
struct Joined {
    cells: Cells,
    /// The old cell of each cell; none for new ones.
    cell_to_old: Vec<MaybeId<CellId>>,
    /// The cell of each tet of the new mesh.
    tet_to_cell: Vec<CellId>,
    /// New triangles: the cell of each, and its index among the triangles.
    new_triangles: Vec<(CellId, usize)>,
    /// New lines: the cell of each, and its index among the lines.
    new_lines: Vec<(CellId, usize)>,
    /// Old triangles that were removed, by index.
    removed_triangles: Vec<usize>,
}

impl Joined {
    fn of(old: &Mesh, part: &TetPart, extract: &Extract) -> Self {
        let mut kept = Kept::of(old, part, extract);
        let n_cells = old.cells.len() + extract.new_tets.len();
        let mut joined = Self {
            cells: Cells::new(),
            cell_to_old: Vec::with_capacity(n_cells),
            tet_to_cell: Vec::with_capacity(extract.mesh.tets.len()),
            new_triangles: Vec::new(),
            new_lines: Vec::new(),
            removed_triangles: std::mem::take(&mut kept.removed_triangles),
        };
        let mut faces = old.cells.polyhedron_faces().iter();
        for (cell, kind, vertices) in old.cells.iter().filter(|(cell, _, _)| !kept.is_removed[cell.index()]) {
            if kind == CellKind::TETRA {
                joined.tet_to_cell.push(CellId::new(joined.cells.len()));
            }
            joined.cell_to_old.push(cell.into());
            let vertices = vertices.iter().map(|&v| kept.vertex(v));
            if kind == CellKind::POLYHEDRON {
                joined
                    .cells
                    .push_polyhedron(vertices, faces.next().map_or_else(Csr::default, |f| kept.faces(f)));
            } else {
                joined.cells.push(kind, vertices);
            }
        }
        for &i in &kept.new_triangles {
            joined.new_triangles.push((CellId::new(joined.cells.len()), i));
            joined.push_new(CellKind::TRIANGLE, &oriented_as_before(i, part, extract));
        }
        for tet in &extract.mesh.tets[extract.mesh.tets.len() - extract.new_tets.len()..] {
            joined.tet_to_cell.push(CellId::new(joined.cells.len()));
            joined.push_new(CellKind::TETRA, tet);
        }
        for &i in &kept.new_lines {
            joined.new_lines.push((CellId::new(joined.cells.len()), i));
            joined.push_new(CellKind::LINE, &line_as_before(i, part, extract));
        }
        joined
    }

    /// For each cell, the old cell that its labels come from: itself; for a new tet a removed one of its
    /// region; for a new triangle or line the old one that it is a part of.
    fn label_sources(&self, part: &TetPart, extract: &Extract) -> Vec<CellId> {
        let mut sources = self.cell_to_old.clone();
        let removed = extract.removed_tets.iter().map(|t| t.index());
        let of_region: BTreeMap<i32, CellId> =
            removed.map(|t| (part.mesh.regions[t], part.tet_to_cell[t])).collect();
        for (t, cell) in self.tet_to_cell.iter().enumerate() {
            if sources[cell.index()].is_none() {
                sources[cell.index()] = of_region[&extract.mesh.regions[t]].into();
            }
        }
        for &(cell, t) in &self.new_triangles {
            sources[cell.index()] = part.triangle_to_cell[extract.triangle_to_old[t] as usize].into();
        }
        for &(cell, line) in &self.new_lines {
            sources[cell.index()] = part.line_to_cell[extract.line_to_old[line] as usize].into();
        }
        sources.into_iter().map(|cell| cell.get().expect("each new cell is a part of an old one")).collect()
    }

    fn push_new(&mut self, kind: CellKind, vertices: &[VertexId]) {
        self.cells.push(kind, vertices.iter().copied());
        self.cell_to_old.push(MaybeId::NONE);
    }
}

/// What is left of the old mesh, and how it is renumbered.
struct Kept {
    is_removed: Vec<bool>,
    old_to_vertex: Vec<MaybeId<VertexId>>,
    removed_triangles: Vec<usize>,
    new_triangles: Vec<usize>,
    new_lines: Vec<usize>,
}

impl Kept {
    fn of(old: &Mesh, part: &TetPart, extract: &Extract) -> Self {
        let mut is_removed = vec![false; old.cells.len()];
        extract.removed_tets.iter().for_each(|t| is_removed[part.tet_to_cell[t.index()].index()] = true);
        let mut kept = Self {
            is_removed,
            old_to_vertex: extract.old_to_vertex(old.points.len()),
            removed_triangles: Vec::new(),
            new_triangles: Vec::new(),
            new_lines: Vec::new(),
        };
        let (before, after) = (&part.mesh, &extract.mesh);
        (kept.removed_triangles, kept.new_triangles) =
            kept.compared([&before.triangles, &after.triangles], &extract.triangle_to_old);
        let removed_lines;
        (removed_lines, kept.new_lines) = kept.compared([&before.lines, &after.lines], &extract.line_to_old);
        let triangles = kept.removed_triangles.iter().map(|&t| part.triangle_to_cell[t]);
        let lines = removed_lines.iter().map(|&line| part.line_to_cell[line]);
        triangles.chain(lines).for_each(|cell| kept.is_removed[cell.index()] = true);
        kept
    }

    /// The old cells of a kind that were removed, and the new ones that were inserted, by index. Cells with
    /// unchanged vertices stay; they come first among the new ones, in their old order.
    fn compared<const N: usize>(
        &self,
        [before, after]: [&[[VertexId; N]]; 2],
        to_old: &[u32],
    ) -> (Vec<usize>, Vec<usize>) {
        let mut stays = vec![false; before.len()];
        let mut inserted = Vec::new();
        for (i, &old) in to_old.iter().enumerate() {
            let is_same =
                |t: usize| before[t].map(|v| self.old_to_vertex[v.index()]) == after[i].map(MaybeId::from);
            match old as usize {
                t if inserted.is_empty() && is_same(t) => stays[t] = true,
                _ => inserted.push(i),
            }
        }
        ((0..before.len()).filter(|&t| !stays[t]).collect(), inserted)
    }

    fn vertex(&self, old: VertexId) -> VertexId {
        self.old_to_vertex[old.index()].get().expect("a cell that stays keeps its vertices")
    }

    fn faces(&self, faces: &Csr<VertexId>) -> Csr<VertexId> {
        let mut new = Csr::default();
        faces.iter().for_each(|face| new.push(face.iter().map(|&v| self.vertex(v))));
        new
    }
}

/// The vertices of a new triangle, ordered so that it faces the same way as the old one that it is a part of.
fn oriented_as_before(i: usize, part: &TetPart, extract: &Extract) -> [VertexId; 3] {
    let [a, b, c] = extract.mesh.triangles[i];
    let before = part.mesh.triangles[extract.triangle_to_old[i] as usize];
    let is = area_vector([a, b, c].map(|v| extract.mesh.points[v.index()]));
    let was = area_vector(before.map(|v| part.mesh.points[v.index()]));
    if dot(is, was) < 0.0 { [a, c, b] } else { [a, b, c] }
}

/// The vertices of a new line, ordered so that it runs the same way as the old one that it is a part of.
fn line_as_before(i: usize, part: &TetPart, extract: &Extract) -> [VertexId; 2] {
    let [a, b] = extract.mesh.lines[i];
    let [was_a, was_b] = part.mesh.lines[extract.line_to_old[i] as usize];
    let way = |points: &[Point], [a, b]: [VertexId; 2]| sub(points[b.index()], points[a.index()]);
    let (is, was) = (way(&extract.mesh.points, [a, b]), way(&part.mesh.points, [was_a, was_b]));
    if dot(is, was) < 0.0 { [b, a] } else { [a, b] }
}

/// The history: where every vertex and cell came from.
fn history(
    old: &Mesh,
    part: &TetPart,
    extract: &Extract,
    joined: &Joined,
    threads: &Threads,
) -> Result<History> {
    let mut vertex_to_old = extract.vertex_to_old.clone();
    let mut changed_vertices = Vec::with_capacity(extract.changed_vertices.len());
    for &vertex in &extract.changed_vertices {
        let was = std::mem::replace(&mut vertex_to_old[vertex.index()], MaybeId::NONE);
        changed_vertices.push(ChangedVertex { vertex, was: was.get() });
    }
    let (before, after) = (&part.mesh, &extract.mesh);
    let old_tet = |t: usize| (part.tet_to_cell[t], before.tets[t], before.regions[t]);
    let new_tet = |t: usize| (joined.tet_to_cell[t], after.tets[t], after.regions[t]);
    let old_triangle = |&t: &usize| (part.triangle_to_cell[t], before.triangles[t], before.patches[t]);
    let new_triangle = |&(cell, t): &(CellId, usize)| (cell, after.triangles[t], after.patches[t]);
    let n_kept = after.tets.len() - extract.new_tets.len();
    let traced = trace(
        &LocalChange {
            old_points: &old.points,
            new_points: &after.points,
            removed_tets: &labelled(extract.removed_tets.iter().map(|t| old_tet(t.index()))),
            new_tets: &labelled((n_kept..after.tets.len()).map(new_tet)),
            removed_triangles: &labelled(joined.removed_triangles.iter().map(old_triangle)),
            new_triangles: &labelled(joined.new_triangles.iter().map(new_triangle)),
            changed_vertices: &changed_vertices,
        },
        threads,
    )?;
    let wide = quadratic_rows(old, &traced.vertices, threads);
    // Lines are the last cells.
    let mut cells = traced.cells;
    for &(cell, i) in &joined.new_lines {
        let before = part.line_to_cell[extract.line_to_old[i] as usize];
        cells.push(cell, &[(before, 1.0)], before);
    }
    Ok(History {
        vertices: Origins::new(old.points.len(), vertex_to_old, traced.vertices)?.with_quadratic(wide)?,
        cells: Origins::new(old.cells.len(), joined.cell_to_old.clone(), cells)?,
        ledger: traced.ledger,
    })
}

fn labelled<const N: usize>(cells: impl Iterator<Item = (CellId, [VertexId; N], i32)>) -> Vec<Labelled<N>> {
    cells.map(|(cell, vertices, label)| Labelled { cell, vertices, label }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Point;
    use crate::geometry::quality::eas;
    use crate::geometry::vector::{add, norm, sub};
    use crate::mesh::shapes::box_grid;
    use crate::ops::defect;
    use crate::remesh::{Density, Improve, SurfaceRule, Whole};

    const MIDDLE: Point = [8.0; 3];

    /// A grid in which the vertices near the middle are shaken, with arrays, and its tets of low quality.
    fn shaken(seed: f64) -> (Mesh, Vec<CellId>) {
        let mut mesh = box_grid([16; 3], [[0.0; 3], [16.0; 3]]);
        for (i, p) in mesh.points.iter_mut().enumerate().filter(|(_, p)| norm(sub(**p, MIDDLE)) < 2.2) {
            let shake = [1.0, 2.3, 3.1].map(|k| 0.45 * (k * (i as f64 + seed)).sin());
            *p = add(*p, shake);
        }
        mesh.set_point_field(Field::scalars(
            "x",
            mesh.points.iter().map(|p| p[0] * p[1]).collect::<Vec<_>>(),
        ));
        let numbers: Vec<i32> = (0..mesh.points.len() as i32).collect();
        mesh.set_point_field(Field::scalars("GlobalNodeID", numbers));
        mesh.set_cell_field(Field::scalars(
            "of",
            (0..mesh.cells.len()).map(|c| c as f64).collect::<Vec<_>>(),
        ));
        let quality = |tet: [VertexId; 4]| eas(tet.map(|v| mesh.points[v.index()]));
        let low = mesh.cells.tets().filter(|(_, tet)| quality(*tet) < 0.25).map(|(cell, _)| cell).collect();
        (mesh, low)
    }

    fn whole(mesh: &Mesh) -> Whole {
        let quality = |tet: [VertexId; 4]| eas(tet.map(|v| mesh.points[v.index()]));
        let sum: f64 =
            mesh.cells.tets().map(|(_, tet)| defect(quality(tet)) + defect(quality(tet).max(0.0))).sum();
        let n_inside = mesh.points.iter().filter(|p| p.iter().all(|x| (0.1..15.9).contains(x))).count();
        let tets = mesh.cells.tets().count();
        Whole { tets, free_vertices: n_inside, mean_defect: sum / tets as f64, extent: 16.0 }
    }

    #[test]
    fn a_part_is_repaired_as_within_the_whole_mesh() {
        let (threads, rules) = (Threads::single(), Rules::default());
        let (mut n_changed, mut n_repaired) = (0, 0);
        for seed in 0..12 {
            let (mesh, low) = shaken(f64::from(seed));
            let surface =
                if seed % 2 == 0 { SurfaceRule::Keep } else { SurfaceRule::Adapt { distance: None } };
            for improves in [false, true] {
                let improve = |points: &[Point], cells: Vec<CellId>| Improve {
                    cells: Some(cells),
                    density: Some(Density { sizes: vec![1.3; points.len()], lack: seed as isize - 4 }),
                    pose: Some(points.to_vec()),
                    ..Improve::filled()
                };
                let options = Options {
                    only: Some(low.clone()),
                    improve: improves.then(|| improve(&mesh.points, low.clone())),
                    surface,
                    keep_layers: false,
                    part_of: Some(whole(&mesh)),
                    ..Options::default()
                };
                let of_whole = remesh_mesh(&mesh, &options, &rules, &threads).unwrap();
                let part = Cutout::around(&mesh, &low, 6, mesh.cells.len() - 1, &threads).unwrap();
                let options = Options {
                    only: Some(part.inside(&low)),
                    improve: improves.then(|| improve(&part.mesh.points, part.inside(&low))),
                    ..options
                };
                let of_part = remesh_cutout(&mesh, &mesh.points, &part, &options, &rules, &threads).unwrap();
                let Some(of_part) = of_part else { continue };
                // A failed `assert_eq` would print both meshes.
                assert!(of_part.mesh == of_whole.mesh, "seed {seed}, improves: {improves}");
                assert!(of_part.history == of_whole.history, "seed {seed}, improves: {improves}");
                assert_eq!(of_part.report.operations, of_whole.report.operations);
                n_changed += usize::from(!of_part.history.cells.changed().is_empty());
                n_repaired += 1;
            }
        }
        assert!(n_repaired > 12 && n_changed > 12, "{n_repaired} parts, {n_changed} of them changed");
    }
}
