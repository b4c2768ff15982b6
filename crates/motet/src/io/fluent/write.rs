//! Writes points, zones of cells and zones of faces as text.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;

use super::INTERIOR;
use crate::base::Result;
use crate::io::format::WriteOptions;
use crate::io::output::{Output, write_all};
use crate::io::owned_faces::{Face, NONE, Sorted, UNLABELLED, cell_numbers, word};
use crate::io::text::push_floats;
use crate::mesh::{CellKind, Labels, Mesh, unused_name};

const NAME: &str = "Fluent";

/// The type of zones of walls.
const WALL: (i64, &str) = (3, "wall");

/// Types of zones by the start of their names.
const TYPES: &[(&str, (i64, &str))] =
    &[("inlet", (10, "velocity-inlet")), ("outlet", (5, "pressure-outlet")), ("symmetry", (7, "symmetry"))];

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let mut lost = Vec::new();
    let regions = mesh.regions().unwrap_or_default();
    let (numbers, order) = by_region(mesh, cell_numbers(mesh, NAME)?, &regions);
    let mut sorted = Sorted::of(mesh, &numbers)?;
    let points = sorted.renumber(mesh)?;
    sorted.report_losses(NAME, mesh, points.len(), &mut lost);
    let zones = Zones::of(mesh, &regions, &order, &sorted, &mut lost);
    let n_points = points.len();
    let head = format!(
        "(0 \"mesh written by motet\")\n(2 3)\n(10 (0 1 {n_points:x} 0 3))\n(10 (1 1 {n_points:x} 1 3)(\n"
    );
    write_all(output, head.as_bytes())?;
    output.rows(n_points, |rows, mut out| {
        for point in &points[rows] {
            push_floats(&mut out, point);
            out.push(b'\n');
        }
        out
    })?;
    write_all(output, b"))\n")?;
    write_all(output, &cells(mesh, &order, &zones))?;
    faces(output, &sorted, &zones)?;
    let mut names = Vec::new();
    for zone in zones.of_cells.iter().chain([&zones.interior]).chain(&zones.of_faces) {
        let _ = writeln!(names, "(45 ({} {} {})())", zone.id, zone.kind.1, zone.name);
    }
    write_all(output, &names)?;
    Ok(lost)
}

/// The cells region by region: for each cell of the mesh its number, and the cell with each number.
fn by_region(mesh: &Mesh, mut numbers: Vec<u32>, regions: &Labels) -> (Vec<u32>, Vec<usize>) {
    let mut order: Vec<usize> = (0..mesh.cells.len()).filter(|&cell| numbers[cell] != NONE).collect();
    // Cells without a region come last, as their zone does.
    let region = |cell: usize| match regions.ids.get(cell).copied().unwrap_or(0) {
        0 => (true, 0),
        id => (false, id),
    };
    order.sort_by_key(|&cell| region(cell));
    order.iter().zip(0..).for_each(|(&cell, number)| numbers[cell] = number);
    (numbers, order)
}

struct Zone {
    id: i32,
    kind: (i64, &'static str),
    name: String,
    /// Number of cells or faces.
    n: usize,
}

/// All zones, in the order of their cells and faces.
struct Zones {
    of_cells: Vec<Zone>,
    interior: Zone,
    of_faces: Vec<Zone>,
}

impl Zones {
    fn of(mesh: &Mesh, regions: &Labels, order: &[usize], sorted: &Sorted, lost: &mut Vec<String>) -> Self {
        let mut n_of: BTreeMap<(bool, i32), usize> = BTreeMap::new();
        for &cell in order {
            let id = regions.ids.get(cell).copied().unwrap_or(0);
            *n_of.entry((id == 0, id)).or_default() += 1;
        }
        let patches = mesh.patches().unwrap_or_default();
        let mut taken: BTreeSet<i32> =
            n_of.keys().map(|key| key.1).chain(sorted.outer.keys().copied()).collect();
        let mut used = BTreeSet::new();
        let mut names: Vec<String> = Vec::new();
        let mut zone = |labels: &Labels,
                        id: Option<i32>,
                        [what, default]: [&str; 2],
                        kind: Option<(i64, &'static str)>,
                        n: usize| {
            let own = id.filter(|&id| id > 0 && used.insert(id));
            let number = own.unwrap_or_else(|| {
                let free = (1..).find(|number| !taken.contains(number)).unwrap_or(1);
                taken.insert(free);
                used.insert(free);
                free
            });
            let given = id.and_then(|id| labels.names.get(&id));
            let name = given.map_or_else(|| format!("{default}-{number}"), |name| word(name, what));
            let name = unused_name(&name, |name| names.iter().any(|known| known == name));
            names.push(name.clone());
            if let Some(id) = id.filter(|&id| id != number) {
                lost.push(format!("{what} {id} is written with number {number}"));
            }
            if let Some(given) = given.filter(|given| **given != name) {
                lost.push(format!("the name {given:?} is written as {name}"));
            }
            let kind = kind.unwrap_or_else(|| {
                let lower = name.to_lowercase();
                TYPES.iter().find(|(start, _)| lower.starts_with(start)).map_or(WALL, |(_, kind)| *kind)
            });
            Zone { id: number, kind, name, n }
        };
        let fluid = Some((1, "fluid"));
        let of_cells = n_of
            .iter()
            .map(|(&(is_bare, id), &n)| {
                zone(regions, (!is_bare).then_some(id), ["region", "fluid"], fluid, n)
            })
            .collect();
        let of_faces = sorted.outer.iter().map(|(&id, faces)| {
            zone(&patches, Some(id).filter(|&id| id != UNLABELLED), ["patch", "wall"], None, faces.len())
        });
        let of_faces = of_faces.collect();
        let interior = Some((INTERIOR, "interior"));
        let interior = zone(&patches, None, ["patch", "interior"], interior, sorted.inner.len());
        Self { of_cells, interior, of_faces }
    }
}

/// The type of a cell.
fn cell_type(kind: CellKind) -> u8 {
    match kind {
        CellKind::TETRA | CellKind::QUADRATIC_TETRA => 2,
        CellKind::HEXAHEDRON
        | CellKind::VOXEL
        | CellKind::QUADRATIC_HEXAHEDRON
        | CellKind::TRIQUADRATIC_HEXAHEDRON
        | CellKind::BIQUADRATIC_QUADRATIC_HEXAHEDRON => 4,
        CellKind::PYRAMID | CellKind::QUADRATIC_PYRAMID => 5,
        CellKind::WEDGE
        | CellKind::QUADRATIC_WEDGE
        | CellKind::QUADRATIC_LINEAR_WEDGE
        | CellKind::BIQUADRATIC_QUADRATIC_WEDGE => 6,
        _ => 7,
    }
}

/// Zones of cells, with the type of each cell where they have several.
fn cells(mesh: &Mesh, order: &[usize], zones: &Zones) -> Vec<u8> {
    let mut out = Vec::new();
    let _ = writeln!(out, "(12 (0 1 {:x} 0 0))", order.len());
    let mut rest = order;
    let mut first = 1;
    for zone in &zones.of_cells {
        let (own, tail) = rest.split_at(zone.n);
        rest = tail;
        let types: Vec<u8> = own.iter().map(|&cell| cell_type(mesh.cells.kinds()[cell])).collect();
        let last = first + zone.n - 1;
        let _ = write!(out, "(12 ({:x} {first:x} {last:x} {} ", zone.id, zone.kind.0);
        if types.iter().all(|&kind| kind == types[0]) {
            let _ = writeln!(out, "{}))", types[0]);
        } else {
            let _ = writeln!(out, "0)(");
            for line in types.chunks(40) {
                line.iter().for_each(|kind| {
                    let _ = write!(out, "{kind} ");
                });
                out.push(b'\n');
            }
            let _ = writeln!(out, "))");
        }
        first = last + 1;
    }
    out
}

fn faces(output: &mut Output<'_>, sorted: &Sorted, zones: &Zones) -> Result<()> {
    let n = zones.interior.n + zones.of_faces.iter().map(|zone| zone.n).sum::<usize>();
    write_all(output, format!("(13 (0 1 {n:x} 0 0))\n").as_bytes())?;
    let all = [&sorted.inner].into_iter().chain(sorted.outer.values());
    let mut first = 1;
    for (zone, faces) in [&zones.interior].into_iter().chain(&zones.of_faces).zip(all) {
        if faces.is_empty() {
            continue;
        }
        let last = first + faces.len() - 1;
        write_all(
            output,
            format!("(13 ({:x} {first:x} {last:x} {:x} 0)(\n", zone.id, zone.kind.0).as_bytes(),
        )?;
        output.rows(faces.len(), |rows, mut out| {
            faces[rows].iter().for_each(|face| push_face(&mut out, face));
            out
        })?;
        write_all(output, b"))\n")?;
        first = last + 1;
    }
    Ok(())
}

/// Writes a face so that it runs counter-clockwise seen from inside its owner, the first of its cells.
fn push_face(out: &mut Vec<u8>, face: &Face) {
    let _ = write!(out, "{:x}", face.ring.len());
    face.ring.iter().rev().for_each(|vertex| {
        let _ = write!(out, " {:x}", vertex + 1);
    });
    let neighbour = if face.neighbour == NONE { 0 } else { face.neighbour + 1 };
    let _ = writeln!(out, " {:x} {neighbour:x}", face.owner + 1);
}
