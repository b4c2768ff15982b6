//! Joins tets of the core and prisms of the layers into one mesh.

use super::columns::{Columns, Site, distinct};
use super::core::Core;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{MaybeId, Point, VertexId};
use crate::mesh::{CellKind, Cells, Field, Mesh};
use crate::meshing::surfaces::Surfaces;

/// Maps sites in columns to vertices of the mesh.
struct Numbers<'a> {
    columns: &'a Columns<'a>,
    /// The vertex of the mesh at each foot.
    feet: Vec<MaybeId<VertexId>>,
    /// The vertex of the mesh at each top that is not the foot.
    tops: Vec<MaybeId<VertexId>>,
    /// For each column, the vertex at the first level in between.
    between: Vec<u32>,
}

impl<'a> Numbers<'a> {
    /// Numbers the sites that are not in the core, and adds their points.
    fn new(
        skin: &Skin,
        columns: &'a Columns,
        core: &Core,
        to_mesh: &[VertexId],
        points: &mut Vec<Point>,
    ) -> Self {
        let in_mesh = |v: &MaybeId<VertexId>| v.get().map(|v| to_mesh[v.index()]).into();
        let mut of_vertex: Vec<MaybeId<VertexId>> = core.of_vertex.iter().map(in_mesh).collect();
        let mut feet = vec![MaybeId::NONE; skin.points.len()];
        let mut between = vec![0; skin.points.len()];
        for w in 0..skin.points.len() {
            let vertex = VertexId::new(w);
            let n = columns.count(vertex);
            let foot = &mut of_vertex[skin.to_vertex[w].index()];
            // A foot that slid away is no longer needed, unless another body uses it.
            if foot.is_none() && n > 0 {
                *foot = VertexId::new(points.len()).into();
                points.push(skin.points[w]);
            }
            feet[w] = *foot;
            between[w] = points.len() as u32;
            points.extend((1..n).map(|level| columns.at(Site { foot: vertex, level })));
        }
        Self { columns, feet, tops: core.of_skin.iter().map(in_mesh).collect(), between }
    }

    fn of(&self, Site { foot, level }: Site) -> VertexId {
        let known = match level {
            0 => self.feet[foot.index()],
            level if level == self.columns.count(foot) => self.tops[foot.index()],
            level => VertexId(self.between[foot.index()] + level - 1).into(),
        };
        known.get().expect("the site of a column is numbered")
    }
}

/// Cells with their labels.
#[derive(Default)]
struct Labelled {
    cells: Cells,
    regions: Vec<i32>,
    patches: Vec<i32>,
}

impl Labelled {
    fn push(
        &mut self,
        kind: CellKind,
        vertices: impl IntoIterator<Item = VertexId>,
        region: i32,
        patch: i32,
    ) {
        self.cells.push(kind, vertices);
        self.regions.push(region);
        self.patches.push(patch);
    }
}

/// Returns the mesh of core and layers: tets and prisms with their regions, then triangles and quads with
/// their patches. `mesh` is that of the core, without the tops of layers; `to_mesh` maps vertices of the core
/// to those of `mesh`.
pub(super) fn glue(
    mesh: &Mesh,
    to_mesh: &[VertexId],
    surfaces: &Surfaces,
    skin: &Skin,
    columns: &Columns,
    core: &Core,
) -> Mesh {
    let mut points = mesh.points.clone();
    let numbers = Numbers::new(skin, columns, core, to_mesh, &mut points);
    let labels = |labels: Option<crate::mesh::Labels>| {
        labels.map_or_else(|| vec![0; mesh.cells.len()], |labels| labels.ids)
    };
    let (regions, patches) = (labels(mesh.regions()), labels(mesh.patches()));
    let (mut volume, mut surface) = (Labelled::default(), Labelled::default());
    for (cell, kind, vertices) in mesh.cells.iter() {
        let into = if kind.dim() == Some(3) { &mut volume } else { &mut surface };
        into.push(kind, vertices.iter().copied(), regions[cell.index()], patches[cell.index()]);
    }
    for t in 0..skin.triangles.len() as u32 {
        let region = skin.bodies[t as usize] as i32 + 1;
        for (kind, sites) in columns.prisms(t).filter_map(|prism| prism.cell()) {
            volume.push(kind, sites.into_iter().map(|site| numbers.of(site)), region, 0);
        }
        add_surface(&mut surface, surfaces, skin, columns, core, &numbers, t);
    }
    for (i, (_, kind, vertices)) in surface.cells.iter().enumerate() {
        volume.push(kind, vertices.iter().copied(), surface.regions[i], surface.patches[i]);
    }
    Mesh {
        cell_data: vec![Field::scalars("region", volume.regions), Field::scalars("patch", volume.patches)],
        label_names: mesh.label_names.clone(),
        ..Mesh::new(points, volume.cells)
    }
}

/// Adds the wall below the prisms on a triangle of the skin, and their sides on caps, as surface cells.
fn add_surface(
    surface: &mut Labelled,
    surfaces: &Surfaces,
    skin: &Skin,
    columns: &Columns,
    core: &Core,
    numbers: &Numbers,
    t: u32,
) {
    if columns.prisms(t).next().is_none() {
        return;
    }
    let patch = |t: u32| surfaces.patches[skin.to_triangle[t as usize] as usize];
    let wall = surfaces.triangles[skin.to_triangle[t as usize] as usize];
    // With a body on the other side the wall is already there: it bounds the core of that body.
    if !core.is_two_sided(skin.to_triangle[t as usize]) {
        let feet = wall.map(|v| {
            let foot = skin.vertex(v, skin.bodies[t as usize]).expect("a corner of the skin's triangle");
            numbers.of(Site { foot, level: 0 })
        });
        surface.push(CellKind::TRIANGLE, feet, 0, patch(t));
    }
    for (k, &beyond) in skin.behind[t as usize].iter().enumerate() {
        if beyond == NONE || skin.has_stack(beyond) {
            continue;
        }
        for side in columns.sides(t, k) {
            let mut ring: Vec<VertexId> = distinct(side).into_iter().map(|site| numbers.of(site)).collect();
            if skin.is_turned[beyond as usize] {
                ring.reverse();
            }
            match ring.len() {
                3 => surface.push(CellKind::TRIANGLE, ring, 0, patch(beyond)),
                4 => surface.push(CellKind::QUAD, ring, 0, patch(beyond)),
                _ => {}
            }
        }
    }
}
