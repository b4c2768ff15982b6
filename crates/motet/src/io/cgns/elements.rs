//! Sections of elements: the type of each element, and its nodes or faces.

use crate::base::{Csr, Result, VertexId};
use crate::io::cgns::kinds::{ElementType, MIXED, NFACE, NGON};
use crate::io::cgns::node::Node;
use crate::io::format::Notes;
use crate::mesh::CellKind;

/// A run of consecutively numbered elements.
pub(super) struct Section {
    pub(super) name: String,
    /// The number of the first element; the first of a zone is 1.
    pub(super) first: i64,
    pub(super) body: Body,
}

/// The elements of a section.
pub(super) enum Body {
    /// The kind of each element and its nodes in VTK's order; `None` for elements without a cell kind here.
    Cells(Vec<Option<CellKind>>, Csr<u32>),
    /// Polygons.
    Faces(Csr<u32>),
    /// The numbers of the polygons of each polyhedron, negative where the polygon faces inward.
    Polyhedra(Csr<i64>),
}

impl Section {
    /// Number of elements.
    pub(super) fn len(&self) -> usize {
        match &self.body {
            Body::Cells(kinds, _) => kinds.len(),
            Body::Faces(lists) => lists.len(),
            Body::Polyhedra(lists) => lists.len(),
        }
    }

    /// Reads a section of a zone with `n_points` points.
    pub(super) fn read(node: &Node, n_points: usize, notes: &Notes) -> Result<Self> {
        let number = node.ints()?.first().copied().unwrap_or(0);
        let (first, n) = range(node)?;
        let source = Source { node, n, n_points, ids: node.required_child("ElementConnectivity")?.ints()? };
        let body = match number {
            MIXED => source.mixed(notes)?,
            NGON => Body::Faces(source.lists(|id| source.point(id))?),
            NFACE => Body::Polyhedra(source.lists(Ok)?),
            number => source.fixed(number, notes)?,
        };
        Ok(Self { name: node.name.clone(), first, body })
    }
}

/// The number of the first element, and the number of elements.
fn range(node: &Node) -> Result<(i64, usize)> {
    let ends = node.required_child("ElementRange")?.ints()?;
    let &[first, last] = ends.as_slice() else {
        return Err(node.error("element range: expected two numbers"));
    };
    let n = last.checked_sub(first).and_then(|n| n.checked_add(1)).and_then(|n| usize::try_from(n).ok());
    match n.filter(|_| first >= 1) {
        Some(n) => Ok((first, n)),
        None => Err(node.error(format!("invalid element range: {first} to {last}"))),
    }
}

struct Source<'a> {
    node: &'a Node,
    n: usize,
    n_points: usize,
    ids: Vec<i64>,
}

impl Source<'_> {
    fn point(&self, id: i64) -> Result<u32> {
        let place = usize::try_from(id).ok().and_then(|id| id.checked_sub(1)).filter(|&p| p < self.n_points);
        place.map(|p| p as u32).ok_or_else(|| {
            self.node
                .error(format!("an element refers to point {id}, but there are {} points", self.n_points))
        })
    }

    fn fits(&self, n_expected: Option<usize>) -> Result<()> {
        if n_expected == Some(self.ids.len()) && self.ids.len() <= VertexId::MAX_COUNT {
            return Ok(());
        }
        Err(self.node.error(format!(
            "{} elements declared, but {} node numbers do not match them",
            self.n,
            self.ids.len()
        )))
    }

    /// Elements of one type.
    fn fixed(&self, number: i64, notes: &Notes) -> Result<Body> {
        let Some(element) = ElementType::of(number) else {
            return Err(self.node.error(format!("unknown element type {number}")));
        };
        self.fits(self.n.checked_mul(element.n_nodes))?;
        let mut out = Cells::default();
        self.ids.chunks_exact(element.n_nodes).try_for_each(|ids| out.push(self, element, ids))?;
        out.finish(notes)
    }

    /// Elements of several types; a type number precedes the nodes of each.
    fn mixed(&self, notes: &Notes) -> Result<Body> {
        let mut out = Cells::default();
        let mut rest = self.ids.as_slice();
        while let Some((&number, tail)) = rest.split_first() {
            let Some(element) = ElementType::of(number) else {
                return Err(self.node.error(format!("unknown element type {number} in a mixed section")));
            };
            let Some((ids, tail)) = tail.split_at_checked(element.n_nodes) else {
                return Err(self.node.error("the last element is truncated"));
            };
            out.push(self, element, ids)?;
            rest = tail;
        }
        self.fits((out.kinds.len() == self.n).then_some(self.ids.len()))?;
        out.finish(notes)
    }

    /// Lists of varying lengths: with start offsets, or, before version 4, with the length before each list.
    fn lists<T>(&self, of: impl Fn(i64) -> Result<T>) -> Result<Csr<T>> {
        let mut lists = Csr::default();
        let mut push = |ids: &[i64]| {
            let ids = ids.iter().map(|&id| of(id)).collect::<Result<Vec<T>>>()?;
            lists.push(ids);
            Ok(())
        };
        self.fits(Some(self.ids.len()))?;
        match self.node.child("ElementStartOffset")? {
            Some(offsets) => {
                let starts = offsets.ints()?;
                let ends = starts.first().zip(starts.last());
                let n = self.ids.len();
                if starts.len().checked_sub(1) != Some(self.n)
                    || !starts.is_sorted()
                    || ends.is_none_or(|(&first, &last)| first != 0 || usize::try_from(last) != Ok(n))
                {
                    return Err(offsets.error(format!(
                        "expected {} numbers that ascend from 0 to {n}",
                        self.n.saturating_add(1)
                    )));
                }
                starts.windows(2).try_for_each(|pair| push(&self.ids[pair[0] as usize..pair[1] as usize]))?;
            }
            None => {
                let mut rest = self.ids.as_slice();
                while let Some((&n, tail)) = rest.split_first() {
                    let list = usize::try_from(n).ok().and_then(|n| tail.split_at_checked(n));
                    let (list, tail) = list.ok_or_else(|| {
                        self.node.error(format!("a list of length {n} exceeds the remaining data"))
                    })?;
                    push(list)?;
                    rest = tail;
                }
            }
        }
        self.fits((lists.len() == self.n).then_some(self.ids.len()))?;
        Ok(lists)
    }
}

/// The cells collected so far.
#[derive(Default)]
struct Cells {
    kinds: Vec<Option<CellKind>>,
    nodes: Csr<u32>,
    n_unsupported: std::collections::BTreeMap<&'static str, usize>,
    order: Option<(ElementType, Vec<usize>)>,
}

impl Cells {
    fn push(&mut self, source: &Source<'_>, element: ElementType, ids: &[i64]) -> Result<()> {
        if element.kind.is_none() {
            *self.n_unsupported.entry(element.name).or_default() += 1;
        }
        if self.order.as_ref().is_none_or(|(of, _)| *of != element) {
            self.order = Some((element, element.vtk_to_cgns()));
        }
        let order = self.order.as_ref().map_or(&[][..], |(_, order)| order);
        let nodes = order.iter().map(|&place| source.point(ids[place])).collect::<Result<Vec<u32>>>()?;
        self.kinds.push(element.kind);
        self.nodes.push(nodes);
        Ok(())
    }

    fn finish(self, notes: &Notes) -> Result<Body> {
        for (name, n) in self.n_unsupported {
            notes.add(format!("elements of type {name} are skipped ({n}): motet has no such cell kind"));
        }
        Ok(Body::Cells(self.kinds, self.nodes))
    }
}
