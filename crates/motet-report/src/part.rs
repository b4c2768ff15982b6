//! One frame, packed: its skin, and as much of its inside as the budget allows.

use std::collections::BTreeMap;

use motet::Mesh;
use motet::base::{CellId, Point};
use serde::Serialize;

use crate::arrays::{self, Array};
use crate::codec::{Block, Kind};
use crate::layout::{Layout, Solids};
use crate::skin::NONE;
use crate::store::{BlockId, Store};

/// Coordinates are stored as integers up to this: a resolution of a millionth of the frame's bounding box.
const MAX_COORDINATE: f64 = 1_048_575.0;
/// How many bad tets are stored where the inside is not.
const MAX_BAD: usize = 20_000;

/// The values of one array: `low + step * n`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Values {
    pub(crate) block: BlockId,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) step: f64,
}

/// Values by the index of their array in the list of all arrays.
pub(crate) type ValuesByArray = BTreeMap<usize, Values>;

/// The vectors of one array at a sample of points or triangles of the skin: `step * (n - 32767)`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Vectors {
    block: BlockId,
    step: f64,
}

/// What is visible of a frame from outside.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SkinPart {
    /// The lowest corner of the bounding box, and the step of coordinates.
    pub(crate) low: Point,
    pub(crate) step: Point,
    points: BlockId,
    triangles: BlockId,
    edges: BlockId,
    pub(crate) values: ValuesByArray,
    /// Vectors by the index of their array.
    pub(crate) vectors: BTreeMap<usize, Vectors>,
}

/// The volume cells of a frame, or some of them.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct InsidePart {
    pub(crate) holds: Holds,
    /// Whether all arrays are included, or only quality and labels.
    #[serde(skip)]
    pub(crate) with_arrays: bool,
    /// The vertices that are not on the skin.
    points: BlockId,
    #[serde(skip_serializing_if = "Option::is_none")]
    tets: Option<BlockId>,
    /// Where not all cells are tets: the number of bounding triangles of each cell, the triangles, and their
    /// edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    facets: Option<[BlockId; 3]>,
    /// Which of the cells are bad tets.
    bad: BlockId,
    /// Positions along each axis of the planes whose cells are included.
    pub(crate) planes: [Vec<f64>; 3],
    pub(crate) values: ValuesByArray,
}

/// Which volume cells are included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Holds {
    /// All cells.
    All,
    /// Cells that this many planes along each axis cross, and bad ones.
    Planes(usize),
    /// Only bad ones.
    Bad,
}

impl SkinPart {
    /// All blocks, with those of arrays if requested.
    pub(crate) fn blocks(&self, with_arrays: bool) -> Vec<BlockId> {
        let arrays = self.values.values().map(|v| v.block).chain(self.vectors.values().map(|v| v.block));
        [self.points, self.triangles, self.edges].into_iter().chain(arrays.filter(|_| with_arrays)).collect()
    }

    pub(crate) fn clear_arrays(&mut self) {
        self.values.clear();
        self.vectors.clear();
    }
}

impl InsidePart {
    pub(crate) fn blocks(&self) -> Vec<BlockId> {
        let facets = self.facets.iter().flatten().chain(&self.tets).copied();
        let values = self.values.values().map(|v| v.block);
        [self.points, self.bad].into_iter().chain(facets).chain(values).collect()
    }
}

/// A frame to be packed.
pub(crate) struct Frame<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) layout: &'a Layout,
    /// Arrays with their indices in the list of all arrays.
    pub(crate) arrays: &'a [(usize, Array)],
    /// Bad tets, in ascending order of cells.
    pub(crate) bad: &'a [CellId],
    /// The lowest corner of the bounding box, and the step of coordinates.
    pub(crate) grid: (Point, Point),
}

/// The lowest corner of a mesh's bounding box, and the step of stored coordinates.
pub(crate) fn grid(mesh: &Mesh) -> (Point, Point) {
    let [low, high] = mesh.bounds().unwrap_or([[0.0; 3]; 2]);
    // Divide first: the difference of huge numbers may overflow.
    (low, [0, 1, 2].map(|i| (high[i] / MAX_COORDINATE) - (low[i] / MAX_COORDINATE)))
}

impl Frame<'_> {
    pub(crate) fn skin(&self, store: &mut Store) -> SkinPart {
        let (low, step) = self.grid;
        let layout = self.layout;
        let values = self.arrays.iter().filter_map(|(id, array)| {
            let values: Vec<f64> = match array.key.on {
                arrays::Place::Cell => layout.triangle_cells.iter().map(|&c| array.of_triangle(c)).collect(),
                arrays::Place::Point => of_points(array, layout, 0..layout.n_skin),
            };
            Some((*id, put_values(store, array, &values)?))
        });
        let values = values.collect();
        SkinPart {
            low,
            step,
            points: store.put(Block::of(Kind::Steps, &self.places(0..layout.n_skin))),
            triangles: store.put(Block::of(Kind::Ids, &layout.triangles)),
            edges: store.put(Block::column(Kind::Plain, &layout.edges)),
            values,
            vectors: self.vectors(store),
        }
    }

    /// Packs the vectors of each array that has some, at a sample of the skin.
    fn vectors(&self, store: &mut Store) -> BTreeMap<usize, Vectors> {
        let layout = self.layout;
        let of_array = |array: &Array| -> Vec<[f64; 3]> {
            match array.key.on {
                arrays::Place::Cell => arrays::sample(layout.triangles.len())
                    .map(|i| array.vector_of_triangle(layout.triangle_cells[i]))
                    .collect(),
                arrays::Place::Point => {
                    arrays::sample(layout.n_skin).map(|i| array.vectors[layout.vertices[i].index()]).collect()
                }
            }
        };
        let with_vectors = self.arrays.iter().filter(|(_, array)| array.key.is_vector);
        let packed = with_vectors.filter_map(|(id, array)| {
            let (block, step) = arrays::pack_vectors(&of_array(array))?;
            Some((*id, Vectors { block: store.put(block), step }))
        });
        packed.collect()
    }

    /// Packs the inside; `None` where it contains no cells of the requested kind.
    pub(crate) fn inside(&self, holds: Holds, with_arrays: bool, store: &mut Store) -> Option<InsidePart> {
        let planes = self.planes(holds);
        let chosen = self.chosen(holds, &planes);
        if chosen.is_empty() {
            return None;
        }
        let (vertices, solids) = self.renumbered(&chosen, holds);
        let is_bad = |i: &usize| self.is_bad(chosen[*i]);
        let bad: Vec<u32> = (0..chosen.len()).filter(is_bad).map(|i| i as u32).collect();
        let kept = |array: &Array| with_arrays || array.key.is_label || array.key.name == arrays::EAS;
        let values = self.arrays.iter().filter(|(_, array)| kept(array) && !array.is_of_surface);
        let values = values.filter_map(|(id, array)| {
            let values: Vec<f64> = match array.key.on {
                arrays::Place::Cell => {
                    chosen.iter().map(|&i| array.values[self.layout.solid_cells[i].index()]).collect()
                }
                arrays::Place::Point => of_points(array, self.layout, vertices.iter().copied()),
            };
            Some((*id, put_values(store, array, &values)?))
        });
        let values = values.collect();
        let (tets, facets) = put_solids(store, &solids);
        Some(InsidePart {
            holds,
            with_arrays,
            points: store.put(Block::of(Kind::Steps, &self.places(vertices.iter().copied()))),
            tets,
            facets,
            bad: store.put(Block::column(Kind::Steps, &bad)),
            planes,
            values,
        })
    }

    /// The number of volume cells that can be included.
    pub(crate) fn n_solids(&self) -> usize {
        self.layout.solid_cells.len()
    }

    /// Coordinates of vertices of the layout as integers.
    fn places(&self, vertices: impl Iterator<Item = usize>) -> Vec<[u32; 3]> {
        let (low, step) = self.grid;
        let place = |v: usize| {
            let p = self.mesh.points[self.layout.vertices[v].index()];
            [0, 1, 2].map(|i| if step[i] > 0.0 { ((p[i] - low[i]) / step[i]).round() as u32 } else { 0 })
        };
        vertices.map(place).collect()
    }

    /// Planes that divide the bounding box into equal parts along each axis.
    fn planes(&self, holds: Holds) -> [Vec<f64>; 3] {
        let n = if let Holds::Planes(n) = holds { n } else { 0 };
        let (low, step) = self.grid;
        let at =
            |axis: usize, i: usize| low[axis] + step[axis] * MAX_COORDINATE * (i + 1) as f64 / (n + 1) as f64;
        [0, 1, 2].map(|axis| (0..n).map(|i| at(axis, i)).collect())
    }

    fn chosen(&self, holds: Holds, planes: &[Vec<f64>; 3]) -> Vec<usize> {
        let all = 0..self.n_solids();
        match holds {
            Holds::All => all.collect(),
            Holds::Bad => all.filter(|&i| self.is_bad(i)).take(MAX_BAD).collect(),
            Holds::Planes(_) => all.filter(|&i| self.is_crossed(i, planes) || self.is_bad(i)).collect(),
        }
    }

    fn is_bad(&self, solid: usize) -> bool {
        self.bad.binary_search(&self.layout.solid_cells[solid]).is_ok()
    }

    /// Whether a plane crosses a cell, or may do so with rounded coordinates.
    fn is_crossed(&self, solid: usize, planes: &[Vec<f64>; 3]) -> bool {
        let (_, step) = self.grid;
        (0..3).any(|axis| {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for v in self.layout.solids.vertices(solid) {
                let x = self.mesh.points[self.layout.vertices[v as usize].index()][axis];
                range = [range[0].min(x), range[1].max(x)];
            }
            let first = planes[axis].partition_point(|&c| c < range[0] - 2.0 * step[axis]);
            planes[axis].get(first).is_some_and(|&c| c <= range[1] + 2.0 * step[axis])
        })
    }

    /// The vertices of the chosen cells that are not on the skin, and the cells with renumbered vertices.
    fn renumbered(&self, chosen: &[usize], holds: Holds) -> (Vec<usize>, Solids) {
        let layout = self.layout;
        let n_skin = layout.n_skin;
        if holds == Holds::All {
            return ((n_skin..layout.vertices.len()).collect(), layout.solids.clone());
        }
        let mut place = vec![NONE; layout.vertices.len()];
        chosen.iter().flat_map(|&i| layout.solids.vertices(i)).for_each(|v| place[v as usize] = 0);
        let vertices: Vec<usize> = (n_skin..place.len()).filter(|&v| place[v] == 0).collect();
        (0..n_skin).for_each(|v| place[v] = v as u32);
        vertices.iter().zip(n_skin as u32..).for_each(|(&v, new)| place[v] = new);
        let solids = match &layout.solids {
            Solids::Tets(tets) => {
                Solids::Tets(chosen.iter().map(|&i| tets[i].map(|v| place[v as usize])).collect())
            }
            Solids::Facets(solids) => {
                let new = |(t, edges): &([u32; 3], u8)| (t.map(|v| place[v as usize]), *edges);
                Solids::Facets(chosen.iter().map(|&i| solids[i].iter().map(new).collect()).collect())
            }
        };
        (vertices, solids)
    }
}

fn of_points(array: &Array, layout: &Layout, vertices: impl Iterator<Item = usize>) -> Vec<f64> {
    vertices.map(|v| array.values[layout.vertices[v].index()]).collect()
}

fn put_values(store: &mut Store, array: &Array, values: &[f64]) -> Option<Values> {
    let packed = arrays::pack(array.key.on, values)?;
    let block = store.put(packed.block);
    Some(Values { block, low: packed.low, high: packed.high, step: packed.step })
}

fn put_solids(store: &mut Store, solids: &Solids) -> (Option<BlockId>, Option<[BlockId; 3]>) {
    match solids {
        Solids::Tets(tets) => (Some(store.put(Block::of(Kind::Ids, tets))), None),
        Solids::Facets(solids) => {
            let counts: Vec<u32> = solids.iter().map(|facets| facets.len() as u32).collect();
            let triangles: Vec<[u32; 3]> = solids.iter().flatten().map(|(t, _)| *t).collect();
            let edges: Vec<u32> = solids.iter().flatten().map(|(_, edges)| u32::from(*edges)).collect();
            let blocks = [
                Block::column(Kind::Plain, &counts),
                Block::of(Kind::Ids, &triangles),
                Block::column(Kind::Plain, &edges),
            ];
            (None, Some(blocks.map(|block| store.put(block))))
        }
    }
}
