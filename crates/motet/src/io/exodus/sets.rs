//! Blocks, side sets and node sets as named sets, and the facets of side sets as cells.

use std::collections::HashMap;

use super::kinds::sides;
use super::source::Source;
use crate::base::{Error, Result, VertexId};
use crate::io::facet_key::{FacetKey, facet_key};
use crate::io::format::Notes;
use crate::io::named_sets::{NSET, Named, NamedSets, PATCH, REGION, Rank, Runs, merged, set_arrays};
use crate::mesh::facets::{FacetShape, facet_shapes};
use crate::mesh::{CellKind, Mesh, corners};

/// The numbers in the names of arrays with this prefix, rising.
pub(super) fn numbered(source: &Source<'_>, prefix: &str) -> Vec<usize> {
    let number = |name: &str| name.strip_prefix(prefix).and_then(|number| number.parse().ok());
    let mut numbers: Vec<usize> = source.names().into_iter().filter_map(number).filter(|&n| n > 0).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// The numbers and names of the sets of one sort.
pub(super) struct Directory {
    ids: Vec<i64>,
    names: Vec<String>,
}

impl Directory {
    /// Of blocks (`eb`), side sets (`ss`) or node sets (`ns`).
    pub(super) fn read(source: &Source<'_>, sort: &str) -> Result<Self> {
        Ok(Self {
            ids: source.ints(&format!("{sort}_prop1"))?,
            names: source.texts(&format!("{sort}_names"))?,
        })
    }

    /// The `number`th set, counted from 1, under its name or the prefix and its number.
    pub(super) fn set(&self, number: usize, prefix: &str, runs: Runs, rank: Rank) -> Named {
        let id = self.ids.get(number - 1).copied().unwrap_or(number as i64);
        let name = self.names.get(number - 1).filter(|name| !name.is_empty());
        let name = name.cloned().unwrap_or_else(|| format!("{prefix}{id}"));
        Named { name, number: i32::try_from(id).unwrap_or(0), runs, rank }
    }
}

/// The prefix of the names of blocks of cells of a kind.
pub(super) fn prefix_of(kind: CellKind) -> &'static str {
    if kind.dim() == Some(3) { REGION } else { PATCH }
}

/// Adds the cells of a block to a set; blocks of one name are one set.
pub(super) fn add_block(sets: &mut Vec<Named>, block: Named) {
    match sets.iter_mut().find(|set| set.name == block.name) {
        Some(set) => set.runs = merged([std::mem::take(&mut set.runs), block.runs].concat()),
        None => sets.push(block),
    }
}

/// Reads side sets: facets without a cell are appended. `cell_of` gives the cell of an element.
pub(super) fn side_sets(
    source: &Source<'_>,
    mesh: &mut Mesh,
    cell_of: &[Option<u32>],
    sets: &mut NamedSets,
    notes: &Notes,
) -> Result<()> {
    let directory = Directory::read(source, "ss")?;
    let is_flat = source.dimension("num_dim")? == Some(2);
    let mut known: HashMap<FacetKey, u32> = HashMap::new();
    for (cell, kind, vertices) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        known.entry(facet_key(corners(kind, vertices).iter().copied())).or_insert(cell.0);
    }
    for number in numbered(source, "elem_ss") {
        let (elements, of_element) =
            (source.ints(&format!("elem_ss{number}"))?, source.ints(&format!("side_ss{number}"))?);
        let bad = |what: String| {
            Error::input(what).at(format!("side set {number}")).remedy("the file is damaged: write it again")
        };
        if elements.len() != of_element.len() {
            return Err(bad(format!("{} elements, but {} sides", elements.len(), of_element.len())));
        }
        let mut runs = Runs::new();
        for (&element, &side) in elements.iter().zip(&of_element) {
            let cell = usize::try_from(element).ok().and_then(|i| cell_of.get(i.checked_sub(1)?));
            let cell =
                cell.ok_or_else(|| bad(format!("refers to element {element} of {}", cell_of.len())))?;
            let Some(cell) = *cell else { continue };
            let kind = mesh.cells.kinds()[cell as usize];
            match kind.dim() {
                Some(3) => {
                    let facet = facet(mesh, cell, side, &mut known)
                        .ok_or_else(|| bad(format!("refers to side {side} of a {}", kind.label())))?;
                    runs.push(facet..facet + 1);
                }
                // The sides of a shell are its two faces, then its edges.
                Some(2) if matches!(side, 1 | 2) && !is_flat => runs.push(cell..cell + 1),
                _ => notes.add("edges and ends in side sets are skipped, faces are kept"),
            }
        }
        if !runs.is_empty() {
            sets.all.push(directory.set(number, PATCH, merged(runs), Rank::Surface));
        }
    }
    Ok(())
}

/// The facet of a cell on a side, given by its corners, and its vertices.
pub(super) fn on_side(
    kind: CellKind,
    vertices: &[VertexId],
    side: &[u8],
) -> Option<(&'static FacetShape, Vec<VertexId>)> {
    let set = |corners: &[u8]| corners.iter().fold(0u32, |set, &corner| set | 1 << corner);
    let shape = facet_shapes(kind)?.iter().find(|shape| set(shape.corners()) == set(side))?;
    Some((shape, shape.nodes.iter().map(|&i| vertices[usize::from(i)]).collect()))
}

/// The surface cell on a side of a volume cell, which is appended if there is none.
fn facet(mesh: &mut Mesh, cell: u32, side: i64, known: &mut HashMap<FacetKey, u32>) -> Option<u32> {
    let kind = mesh.cells.kinds()[cell as usize];
    let side = sides(kind).get(usize::try_from(side).ok()?.checked_sub(1)?)?;
    let (shape, nodes) = on_side(kind, mesh.cells.connectivity().list(cell as usize), side)?;
    let next = mesh.cells.len() as u32;
    let found = *known.entry(facet_key(nodes[..shape.n_corners].iter().copied())).or_insert(next);
    if found == next {
        mesh.cells.push(shape.kind, nodes);
    }
    Some(found)
}

/// Reads node sets as point arrays of 0 and 1.
pub(super) fn node_sets(source: &Source<'_>, mesh: &mut Mesh, notes: &Notes) -> Result<()> {
    let directory = Directory::read(source, "ns")?;
    let n_points = mesh.points.len();
    let mut sets = NamedSets::default();
    for number in numbered(source, "node_ns") {
        let place = |node: i64| {
            let place =
                usize::try_from(node).ok().and_then(|node| node.checked_sub(1)).filter(|&i| i < n_points);
            place.map(|i| i as u32..i as u32 + 1).ok_or_else(|| {
                Error::input(format!("refers to node {node} of {n_points}"))
                    .at(format!("node set {number}"))
                    .remedy("the file is damaged: write it again")
            })
        };
        let nodes = source.ints(&format!("node_ns{number}"))?;
        let runs = nodes.into_iter().map(place).collect::<Result<Runs>>()?;
        if !runs.is_empty() {
            sets.add(directory.set(number, "node set ", merged(runs), Rank::Declared));
        }
    }
    set_arrays(&mut mesh.point_data, NSET, sets.all.iter(), n_points, notes);
    Ok(())
}
