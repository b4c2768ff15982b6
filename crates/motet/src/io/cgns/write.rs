//! Writes a mesh: one base, one zone, and in it a section for each region and patch.

use crate::base::{Csr, Result};
use crate::io::cgns::faces::{self, Faces, needs_faces};
use crate::io::cgns::kinds::{ElementType, MIXED, NFACE, NGON};
use crate::io::cgns::parts::{INNER_FACES, Part, ZONE, element_type, parts};
use crate::io::cgns::solutions::solutions;
use crate::io::cgns::tree::{Ints, Tree};
use crate::io::format::WriteOptions;
use crate::io::output::{Output, write_all};
use crate::io::select::keep_cells;
use crate::mesh::{Mesh, Values};

/// The declared version of the files: the oldest one whose libraries accept lists with offsets, as all later
/// ones do.
const VERSION: f32 = 3.4;

/// Writes uncompressed data: the CGNS libraries reject the HDF5 format that the compression used here needs.
pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let of_faces = mesh.cells.kinds().iter().any(|&kind| needs_faces(kind));
    let (mesh, mut lost) = keep_cells(mesh, "CGNS", |kind| match of_faces {
        true => faces::holds(kind),
        false => element_type(kind).is_some(),
    });
    let cell_dim = mesh.cells.dim().unwrap_or(1).max(1);
    let parts = parts(&mesh, &mut lost);
    // Where cells are made of faces, the faces come first.
    let is_first = |part: &&Part| of_faces && part.dim == 2;
    let (first, then): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(is_first);
    let order: Vec<usize> =
        first.into_iter().chain(then).flat_map(|part| part.cells.iter().copied()).collect();
    if order.windows(2).any(|w| w[0] > w[1]) {
        lost.push("the order of the cells is not kept: CGNS groups cells by region and patch".into());
    }
    let ints = Ints::of(&mesh);
    let mut numbered =
        SectionWriter { ints, next: 1, sections: Vec::new(), ranges: vec![(0, 0); parts.len()] };
    match of_faces {
        true => numbered.all_faces(&mesh, &parts)?,
        false => numbered.all_cells(&mesh, &parts),
    }
    let zone = zone(&mesh, &parts, cell_dim, numbered, &mut lost);
    let mut base = Tree::with("Base", "CGNSBase_t", Values::I32(vec![cell_dim as i32, 3]));
    base.child(zone);
    parts.iter().filter(|part| part.has_label).for_each(|part| base.child(family(part)));
    let version = Tree::with("CGNSLibraryVersion", "CGNSLibraryVersion_t", Values::F32(vec![VERSION]));
    write_all(output, &Tree::file(vec![version, base])?)?;
    Ok(lost)
}

fn zone(
    mesh: &Mesh,
    parts: &[Part],
    cell_dim: usize,
    numbered: SectionWriter,
    lost: &mut Vec<String>,
) -> Tree {
    let n_cells = mesh.cells.kinds().iter().filter(|kind| kind.dim() == Some(cell_dim)).count();
    let sizes = numbered.ints.values([mesh.points.len() as i64, n_cells as i64, 0]);
    let mut zone = Tree::shaped(ZONE, "Zone_t", sizes, &[3, 1]);
    zone.child(Tree::with_text("ZoneType", "ZoneType_t", "Unstructured"));
    zone.child(coordinates(mesh));
    numbered.sections.into_iter().for_each(|section| zone.child(section));
    if cell_dim == 3 {
        zone.children(conditions(parts, &numbered.ranges, numbered.ints));
    }
    let first_face = parts.iter().zip(&numbered.ranges).find(|(part, _)| part.dim == 2);
    let first_face = first_face.map_or(1, |(_, range)| range.0);
    zone.children(solutions(mesh, parts, cell_dim, (first_face, numbered.ints), lost));
    zone
}

fn coordinates(mesh: &Mesh) -> Tree {
    let mut grid = Tree::new("GridCoordinates", "GridCoordinates_t");
    for (axis, name) in ["CoordinateX", "CoordinateY", "CoordinateZ"].into_iter().enumerate() {
        let column: Vec<f64> = mesh.points.iter().map(|point| point[axis]).collect();
        grid.child(Tree::with(name, "DataArray_t", Values::F64(column)));
    }
    grid
}

/// A family, which marks the name of a section as that of a label and stores the number of the label.
fn family(part: &Part) -> Tree {
    let mut family = Tree::new(&part.name, "Family_t");
    if part.dim == 2 {
        family.child(Tree::with_text("FamilyBC", "FamilyBC_t", "UserDefined"));
        // Gmsh turns this name into a physical group.
        family.child(Tree::with_text(&part.name, "FamilyName_t", &part.name));
    }
    family.child(Tree::with("Ordinal", "Ordinal_t", Values::I32(vec![part.number])));
    family
}

/// Boundary conditions, one for each patch.
fn conditions(parts: &[Part], ranges: &[(i64, i64)], ints: Ints) -> Option<Tree> {
    let mut all = Tree::new("ZoneBC", "ZoneBC_t");
    let mut patches = parts.iter().zip(ranges).filter(|(part, _)| part.dim == 2).peekable();
    patches.peek()?;
    for (part, &(first, last)) in patches {
        let mut condition = Tree::with_text(&part.name, "BC_t", "FamilySpecified");
        condition.child(Tree::range("PointRange", ints.values([first, last])));
        condition.child(Tree::with_text("GridLocation", "GridLocation_t", "FaceCenter"));
        condition.child(Tree::with_text("FamilyName", "FamilyName_t", &part.name));
        all.child(condition);
    }
    Some(all)
}

/// Sections, whose elements are numbered consecutively.
struct SectionWriter {
    ints: Ints,
    next: i64,
    sections: Vec<Tree>,
    /// The numbers of the first and last element of each part.
    ranges: Vec<(i64, i64)>,
}

impl SectionWriter {
    /// Adds a section for each part.
    fn all_cells(&mut self, mesh: &Mesh, parts: &[Part]) {
        for (i, part) in parts.iter().enumerate() {
            self.ranges[i] = self.cells(mesh, part);
        }
    }

    /// Adds polygons, then polyhedra made of them, then all other cells.
    fn all_faces(&mut self, mesh: &Mesh, parts: &[Part]) -> Result<()> {
        let faces = Faces::of(mesh, parts)?;
        let mut rings = faces.rings.iter();
        let ids = |ring: &[u32]| ring.iter().map(|&v| i64::from(v) + 1).collect::<Vec<i64>>();
        for (i, part) in parts.iter().enumerate().filter(|(_, part)| part.dim == 2) {
            let own = rings.by_ref().take(part.cells.len()).map(ids).collect();
            self.ranges[i] = self.lists(&part.name, NGON, own);
        }
        let others: Vec<Vec<i64>> = rings.map(ids).collect();
        if !others.is_empty() {
            self.lists(INNER_FACES, NGON, others);
        }
        let mut of_cells = faces.of_cells;
        for (i, part) in parts.iter().enumerate().filter(|(_, part)| part.dim != 2) {
            self.ranges[i] = match part.dim {
                3 => {
                    let own = part.cells.iter().map(|&cell| std::mem::take(&mut of_cells[cell])).collect();
                    self.lists(&part.name, NFACE, own)
                }
                _ => self.cells(mesh, part),
            };
        }
        Ok(())
    }

    /// Adds the cells of a part: a section of one type, or a mixed section with a type for each cell.
    fn cells(&mut self, mesh: &Mesh, part: &Part) -> (i64, i64) {
        let of_cell = |cell: usize| element_type(mesh.cells.kinds()[cell]);
        let ids = |cell: usize, element: ElementType| {
            let vertices = mesh.cells.connectivity().list(cell);
            cgns_to_vtk(element).into_iter().map(|place| vertices[place].index() as i64 + 1)
        };
        match part.element_type(mesh) {
            Some(element) => {
                let all = part.cells.iter().flat_map(|&cell| ids(cell, element)).collect();
                self.section(&part.name, element.number, part.cells.len(), all, None)
            }
            None => {
                let mut lists = Csr::default();
                for (element, &cell) in part.cells.iter().filter_map(|cell| Some((of_cell(*cell)?, cell))) {
                    lists.push(std::iter::once(element.number).chain(ids(cell, element)));
                }
                self.csr(&part.name, MIXED, &lists)
            }
        }
    }

    fn lists(&mut self, name: &str, number: i64, lists: Vec<Vec<i64>>) -> (i64, i64) {
        let mut all = Csr::default();
        lists.into_iter().for_each(|list| all.push(list));
        self.csr(name, number, &all)
    }

    fn csr(&mut self, name: &str, number: i64, lists: &Csr<i64>) -> (i64, i64) {
        let starts = lists.offsets().iter().map(|&start| i64::from(start)).collect();
        self.section(name, number, lists.len(), lists.items().to_vec(), Some(starts))
    }

    fn section(
        &mut self,
        name: &str,
        number: i64,
        n: usize,
        ids: Vec<i64>,
        starts: Option<Vec<i64>>,
    ) -> (i64, i64) {
        let (first, last) = (self.next, self.next + n as i64 - 1);
        let mut section = Tree::with(name, "Elements_t", Values::I32(vec![number as i32, 0]));
        section.child(Tree::with("ElementRange", "IndexRange_t", self.ints.values([first, last])));
        section.child(Tree::with("ElementConnectivity", "DataArray_t", self.ints.values(ids)));
        if let Some(starts) = starts {
            section.child(Tree::with("ElementStartOffset", "DataArray_t", self.ints.values(starts)));
        }
        self.sections.push(section);
        self.next = last + 1;
        (first, last)
    }
}

/// For each node in CGNS's order, its position in VTK's order.
fn cgns_to_vtk(element: ElementType) -> Vec<usize> {
    let order = element.vtk_to_cgns();
    let mut inverse = vec![0; order.len()];
    order.iter().enumerate().for_each(|(vtk, &cgns)| inverse[cgns] = vtk);
    inverse
}
