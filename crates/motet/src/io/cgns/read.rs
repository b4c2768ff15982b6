//! Reads a mesh.

use crate::base::{Error, Result, VertexId};
use crate::io::cgns::arrays::{Places, Solutions};
use crate::io::cgns::cells::{Span, place};
use crate::io::cgns::families::Families;
use crate::io::cgns::labels::{LabelSources, set_labels};
use crate::io::cgns::meshio;
use crate::io::cgns::node::Node;
use crate::io::cgns::seams::{Seam, join_points, seams};
use crate::io::cgns::zone::Zone;
use crate::io::format::{Input, Notes};
use crate::mesh::{Cells, Mesh};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let root = Node::root(input.bytes)?;
    let bases = root.children_of("CGNSBase_t")?;
    if bases.is_empty()
        && let Some(mesh) = meshio::read(&root)?
    {
        return Ok(mesh);
    }
    let base = bases.first().ok_or_else(|| {
        Error::input("is an HDF5 file without a node labelled CGNSBase_t")
            .remedy("give the file the extension of its format")
    })?;
    if bases.len() > 1 {
        input.notes.add(format!("the file has {} bases: only {} is read", bases.len(), base.name));
    }
    let cell_dim = base.ints()?.first().and_then(|&dim| usize::try_from(dim).ok()).unwrap_or(0);
    let families = Families::of(base)?;
    let mut mesh = Mesh::new(Vec::new(), Cells::new());
    let mut zones = Vec::new();
    let mut solutions = Solutions::default();
    for node in base.children_of("Zone_t")? {
        zones.push(join(&mut mesh, &mut solutions, Zone::read(node, input.notes)?, cell_dim, input.notes)?);
    }
    if zones.is_empty() {
        return Err(base.error("a base without zones contains no mesh"));
    }
    mesh.point_data = solutions.points.finish(mesh.points.len());
    mesh.cell_data = solutions.cells.finish(mesh.cells.len());
    let labelled: Vec<LabelSources<'_>> = zones.iter().map(Joined::labelled).collect();
    set_labels(&mut mesh, &labelled, &families, cell_dim, input.notes);
    join_zones(&mut mesh, &zones, input.notes);
    Ok(mesh)
}

/// A zone whose points and cells are in the mesh.
struct Joined {
    zone: Zone,
    spans: Vec<Span>,
    points: (usize, usize),
    seams: Vec<Option<Seam>>,
}

impl Joined {
    fn labelled(&self) -> LabelSources<'_> {
        LabelSources {
            zone: &self.zone.node.name,
            family: self.zone.family.as_deref(),
            conditions: &self.zone.conditions,
            spans: &self.spans,
            points: self.points,
        }
    }
}

/// Appends a zone to the mesh.
fn join(
    mesh: &mut Mesh,
    solutions: &mut Solutions,
    mut zone: Zone,
    cell_dim: usize,
    notes: &Notes,
) -> Result<Joined> {
    let (first_point, n_points) = (mesh.points.len(), zone.points.len());
    if first_point + n_points > VertexId::MAX_COUNT {
        return Err(zone.node.error("more points than a mesh can hold"));
    }
    let spans = place(&zone, first_point as u32, &mut mesh.cells)?;
    mesh.points.append(&mut zone.points);
    zone.sections.clear();
    let places = Places { first_point, n_points, spans: &spans, kinds: mesh.cells.kinds(), cell_dim };
    solutions.take(&zone.node, &places, notes)?;
    let seams = seams(&zone.node)?;
    Ok(Joined { zone, spans, points: (first_point, n_points), seams })
}

/// Merges the points where zones meet, and adds a note where their correspondence is not given or does not
/// hold.
fn join_zones(mesh: &mut Mesh, zones: &[Joined], notes: &Notes) {
    let mut pairs = Vec::new();
    let mut is_open = false;
    for zone in zones {
        for seam in &zone.seams {
            let found = |seam: &Seam| zones.iter().find(|other| other.zone.node.name == seam.other);
            match seam.as_ref().and_then(|seam| Some((seam, found(seam)?))) {
                Some((seam, other)) => pairs.extend(seam.pairs(zone.points, other.points)),
                None => is_open = true,
            }
        }
    }
    if pairs.is_empty() && !is_open {
        return;
    }
    if join_points(mesh, &pairs) > 0 || is_open {
        notes.add("points are duplicated where zones meet without valid point-to-point lists");
    }
}
