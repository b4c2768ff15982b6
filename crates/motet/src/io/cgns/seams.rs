//! Points where zones meet one to one: those that the file declares identical are merged.

use crate::base::{DisjointSets, Result, VertexId};
use crate::geometry::vector::distance;
use crate::io::cgns::conditions::{Numbers, is_on_points};
use crate::io::cgns::node::Node;
use crate::mesh::Mesh;

/// Maximum distance of identical points, relative to the extent of the mesh: files may have seven-digit
/// coordinates.
const MERGE_TOLERANCE: f64 = 1e-6;

/// Points of a zone and the identical points of another zone.
pub(super) struct Seam {
    /// The name of the other zone.
    pub(super) other: String,
    own_points: Vec<i64>,
    other_points: Vec<i64>,
}

/// The seams of a zone; `None` for each that does not pair points.
pub(super) fn seams(zone: &Node) -> Result<Vec<Option<Seam>>> {
    let mut all = Vec::new();
    for connectivity in zone.children_of("ZoneGridConnectivity_t")? {
        for node in connectivity.children()? {
            match node.label.as_str() {
                "GridConnectivity_t" => all.push(seam(&node)?),
                "GridConnectivity1to1_t" | "OversetHoles_t" => all.push(None),
                _ => {}
            }
        }
    }
    Ok(all)
}

fn seam(node: &Node) -> Result<Option<Seam>> {
    let is_one_to_one = node.text_of("GridConnectivityType_t")?.as_deref() == Some("Abutting1to1");
    // For example the two sides of a periodic flow, which do not coincide.
    let has_property = node.child_of("GridConnectivityProperty_t")?.is_some();
    if !is_one_to_one || has_property || !is_on_points(node)? {
        return Ok(None);
    }
    let own = Numbers::of(node, "PointList", "PointRange")?;
    let other = Numbers::of(node, "PointListDonor", "PointRangeDonor")?;
    let (Some(Numbers::List(own_points)), Some(Numbers::List(other_points))) = (own, other) else {
        return Ok(None);
    };
    let path = node.text()?;
    let other = path.rsplit('/').next().unwrap_or_default().to_owned();
    Ok((own_points.len() == other_points.len()).then_some(Seam { other, own_points, other_points }))
}

impl Seam {
    /// The pairs of identical points, as indices in the mesh, given the first index and the number of points
    /// of each zone.
    pub(super) fn pairs(&self, own: (usize, usize), other: (usize, usize)) -> impl Iterator<Item = [u32; 2]> {
        let place = |(first, n): (usize, usize), number: i64| {
            let at = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
            at.filter(|&at| at < n).map(|at| (first + at) as u32)
        };
        let both = self.own_points.iter().zip(&self.other_points);
        both.filter_map(move |(&a, &b)| Some([place(own, a)?, place(other, b)?]))
    }
}

/// Merges each pair of points that coincide; returns the number of pairs that do not.
pub(super) fn join_points(mesh: &mut Mesh, pairs: &[[u32; 2]]) -> usize {
    let Some([low, high]) = mesh.bounds() else { return pairs.len() };
    let farthest = MERGE_TOLERANCE * distance(low, high);
    let mut sets = DisjointSets::new(mesh.points.len());
    let mut n_apart = 0;
    for &[a, b] in pairs {
        let is_one = distance(mesh.points[a as usize], mesh.points[b as usize]) <= farthest;
        if is_one {
            sets.join(a, b);
        } else {
            n_apart += 1;
        }
    }
    // The first of merged points is kept.
    let mut kept = Vec::new();
    let mut new: Vec<VertexId> = Vec::with_capacity(mesh.points.len());
    for v in 0..mesh.points.len() {
        let root = sets.root(v as u32) as usize;
        new.push(if root == v { VertexId::new(kept.len()) } else { new[root] });
        if root == v {
            kept.push(v);
        }
    }
    if kept.len() < new.len() {
        mesh.points = kept.iter().map(|&v| mesh.points[v]).collect();
        mesh.point_data.iter_mut().for_each(|field| *field = field.pick(kept.iter().copied()));
        mesh.cells = mesh.cells.renumbered(&new);
    }
    n_apart
}
