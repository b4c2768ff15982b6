//! One layout per topology: frames of the same cells share it, in whatever order they are read.
//!
//! A frame is read more than once: first for its skin, later for its inside, which refers to vertices of the
//! skin. Both must have the same layout, so a frame's layout depends only on its topology and not on what was
//! read in between.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::rc::Rc;

use motet::base::{CellId, VertexId};
use motet::geometry::vector::is_finite;
use motet::mesh::CellKind;
use motet::mesh::adjacency::{FacetUse, Facets};
use motet::{Error, Mesh, Result};

use crate::input::Meshes;
use crate::layout::Layout;
use crate::skin::pieces;

/// How many ids of layouts are kept in memory: a quarter of a gigabyte. One layout is kept however large it
/// is.
const MAX_IDS: usize = 1 << 26;

/// A hash of everything that a layout depends on except the order of vertices: cells, which points are not
/// finite, and how facets with more than three corners are divided. It has 128 bits, so that two topologies
/// do not collide by chance.
type Topology = [u64; 2];

/// The layouts of an input; those used last are kept, the others are recomputed when needed.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// The frame whose points determine the order of vertices of a topology.
    sources: HashMap<Topology, usize>,
    /// The topology of each frame when it was first read.
    topologies: HashMap<usize, Topology>,
    held: Vec<(Topology, Rc<Layout>)>,
    most_ids: usize,
}

impl Default for Layouts {
    fn default() -> Self {
        Self::of_at_most(MAX_IDS)
    }
}

impl Layouts {
    fn of_at_most(most_ids: usize) -> Self {
        Self { sources: HashMap::new(), topologies: HashMap::new(), held: Vec::new(), most_ids }
    }

    /// The layout of a frame, given its mesh.
    ///
    /// # Errors
    /// When the frame has other cells than when it was first read, or a frame that must be read again cannot
    /// be.
    pub(crate) fn of(&mut self, input: &Meshes, frame: usize, mesh: &Mesh) -> Result<Rc<Layout>> {
        let topology = topology(mesh);
        if *self.topologies.entry(frame).or_insert(topology) != topology {
            return Err(changed(input, frame));
        }
        if let Some(place) = self.held.iter().position(|(held, _)| *held == topology) {
            let held = self.held.remove(place);
            self.held.push(held);
        } else {
            let layout = self.made(input, frame, mesh, topology)?;
            self.held.push((topology, Rc::new(layout)));
            self.drop_oldest();
        }
        Ok(Rc::clone(&self.held[self.held.len() - 1].1))
    }

    fn made(&mut self, input: &Meshes, frame: usize, mesh: &Mesh, own: Topology) -> Result<Layout> {
        let source = *self.sources.entry(own).or_insert(frame);
        if source == frame {
            return Ok(Layout::of(mesh));
        }
        let (mesh, _) = input.read(source)?;
        if topology(&mesh) != own {
            return Err(changed(input, source));
        }
        Ok(Layout::of(&mesh))
    }

    fn drop_oldest(&mut self) {
        let mut n_ids: usize = self.held.iter().map(|(_, layout)| layout.n_ids()).sum();
        while n_ids > self.most_ids && self.held.len() > 1 {
            n_ids -= self.held.remove(0).1.n_ids();
        }
    }
}

fn changed(input: &Meshes, frame: usize) -> Error {
    Error::input("the cells of this frame changed while the page was made")
        .in_file(input.file_of(frame))
        .remedy("wait until nothing writes the series any more, then make the page again")
}

fn topology(mesh: &Mesh) -> Topology {
    let mut hashers = [0u8, 1].map(|salt| {
        let mut hasher = DefaultHasher::new();
        salt.hash(&mut hasher);
        hasher
    });
    let facets = Facets::of(&mesh.cells);
    for hasher in &mut hashers {
        mesh.points.len().hash(hasher);
        for (v, point) in mesh.points.iter().enumerate() {
            if !is_finite(*point) {
                v.hash(hasher);
            }
        }
        for (cell, kind, vertices) in mesh.cells.iter() {
            (kind, vertices).hash(hasher);
            each_division(mesh, &facets, cell, &mut |pieces| pieces.hash(hasher));
        }
    }
    hashers.map(|hasher| hasher.finish())
}

/// Visits the division into triangles of a surface cell, or of the facets of a volume cell, where these are
/// not triangles.
fn each_division(mesh: &Mesh, facets: &Facets, cell: CellId, see: &mut impl FnMut(Vec<([VertexId; 3], u8)>)) {
    let kind = mesh.cells.kind(cell);
    match kind.dim() {
        _ if matches!(kind, CellKind::TETRA | CellKind::TRIANGLE) => {}
        Some(2) => see(pieces(mesh, kind, mesh.cells.vertices(cell))),
        Some(3) => (0..facets.count(cell) as u32).for_each(|local| {
            let (kind, vertices) = facets.vertices(FacetUse { cell, local });
            see(pieces(mesh, kind, &vertices.collect::<Vec<_>>()));
        }),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use motet::base::Point;
    use motet::io::{self, WriteOptions};
    use motet::mesh::Cells;
    use motet::mesh::shapes::{ball, box_grid, mixed};

    use super::*;
    use crate::input::Source;

    fn meshes(folder: &Path, meshes: &[Mesh]) -> Meshes {
        let path = |i| folder.join(format!("{i}.vtu"));
        for (i, mesh) in meshes.iter().enumerate() {
            io::write(path(i), mesh, &WriteOptions::default()).unwrap();
        }
        let frames = (0..meshes.len()).map(|i| (i as f64, Source::File(path(i)))).collect();
        Meshes { file: path(0), is_series: true, frames }
    }

    fn mirrored(mesh: &Mesh) -> Mesh {
        let mut mesh = mesh.clone();
        mesh.points.iter_mut().for_each(|p| *p = [-p[0], p[2], p[1]]);
        mesh
    }

    #[test]
    fn a_layout_is_the_same_whatever_was_read_in_between_and_forgotten() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (ball(2, 2), box_grid([2; 3], [[0.0; 3], [1.0; 3]]));
        let frames = [a.clone(), b.clone(), mirrored(&a), mixed(1), mirrored(&b)];
        let input = meshes(folder.path(), &frames);
        for most_ids in [0, MAX_IDS] {
            let mut layouts = Layouts::of_at_most(most_ids);
            let mut first: [Option<Vec<VertexId>>; 5] = Default::default();
            for frame in [0, 1, 2, 3, 4, 2, 0, 4, 1, 3, 3, 2, 1, 0] {
                let layout = layouts.of(&input, frame, &frames[frame]).unwrap();
                let vertices = first[frame].get_or_insert_with(|| layout.vertices.clone());
                assert_eq!(*vertices, layout.vertices);
                assert!(layouts.held.len() == 1 || most_ids > 0);
            }
            assert!(first[0] == first[2] && first[1] == first[4] && first[0] != first[1]);
            assert!(
                Layout::of(&frames[2]).vertices != Layout::of(&frames[0]).vertices,
                "order follows points"
            );
        }
    }

    #[test]
    fn a_frame_whose_cells_change_meanwhile_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let input = meshes(folder.path(), &[ball(2, 1), ball(2, 1)]);
        let mut layouts = Layouts::of_at_most(0);
        layouts.of(&input, 0, &ball(2, 1)).unwrap();
        let error = layouts.of(&input, 0, &ball(2, 2)).unwrap_err();
        assert!(error.to_string().contains("changed while") && error.remedy_text().is_some());
        io::write(input.file_of(0), &ball(3, 1), &WriteOptions::default()).unwrap();
        layouts.held.clear();
        assert!(layouts.of(&input, 1, &ball(2, 1)).is_err());
    }

    #[test]
    fn points_that_are_no_numbers_and_other_diagonals_are_other_topologies() {
        let mut mesh = ball(2, 1);
        let before = topology(&mesh);
        mesh.points[3][1] += 0.1;
        assert_eq!(topology(&mesh), before);
        mesh.points[3][1] = f64::NAN;
        assert_ne!(topology(&mesh), before);
        // A square, and squares with a dent at one corner or at the next.
        let polygon = |points: [Point; 4]| {
            let ring = (0..4).map(VertexId).collect();
            topology(&Mesh::new(points.to_vec(), Cells::uniform(CellKind::QUAD, ring).unwrap()))
        };
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let dented = |v: usize| {
            let mut points = square;
            points[v] = [0.6 - 0.2 * square[v][0], 0.6 - 0.2 * square[v][1], 0.0];
            polygon(points)
        };
        assert_eq!(polygon(square), polygon(square.map(|p| [p[0] + 3.0, 2.0 * p[1], 1.0])));
        assert_ne!(dented(0), dented(1));
    }
}
