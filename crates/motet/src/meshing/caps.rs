//! Open rims closed by caps of triangles, the same for every frame of a surface that moves.
//!
//! ```text
//!    o---o---o     rim          Rings of vertices between the rim and the mean of its vertices, each with as many
//!   / o--o--o \                 as keeps triangles about as long as wide. A vertex of a ring is a fixed mean of
//!  o-o   x   o-o                vertices of the rim, so caps follow a rim that moves or bends.
//! ```

use std::collections::{BTreeMap, HashMap};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{add, distance, scale, sub};
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Surface, unused_name};

/// The width of a ring over the length of the rim's edges: that of regular triangles.
const RING: f64 = 0.866;

/// The caps of a surface, made from one frame of it, put on any.
#[derive(Clone, Debug)]
pub struct Caps {
    n_points: usize,
    /// The triangles of the surface, with patches.
    triangles: Vec<[VertexId; 3]>,
    patches: Vec<i32>,
    names: BTreeMap<i32, String>,
    rims: Vec<Rim>,
}

/// One rim and its cap.
#[derive(Clone, Debug)]
struct Rim {
    /// As the cap's triangles go round it.
    vertices: Vec<VertexId>,
    /// How many vertices each ring has, from the outermost; the last is the mean of the rim.
    rings: Vec<usize>,
    label: i32,
}

impl Caps {
    /// Finds the rims of a surface: chains of edges that one triangle alone uses. Caps are patches `cap_1`, `cap_2`, ..., the longest rim first; what has no patch is
    /// `wall`.
    ///
    /// # Errors
    /// When there is no rim, or rims touch each other in a vertex.
    pub fn of(surface: &Mesh) -> Result<Self> {
        let Surface { triangles, patches, patch_names: mut names, .. } = Surface::of(surface);
        let mut rims = rims(&triangles)?;
        let length = |rim: &Vec<VertexId>| edges(rim, &surface.points).iter().sum::<f64>();
        rims.sort_by(|a, b| length(b).total_cmp(&length(a)).then_with(|| a.cmp(b)));
        let mut patches = patches;
        if patches.contains(&0) {
            let label = 1 + patches.iter().copied().max().unwrap_or(0);
            patches.iter_mut().filter(|p| **p == 0).for_each(|p| *p = label);
            names.insert(label, "wall".to_owned());
        }
        let first = 1 + patches.iter().copied().max().unwrap_or(0);
        let mut made = Vec::new();
        for (label, vertices) in (first..).zip(rims) {
            let name =
                unused_name(&format!("cap_{}", label - first + 1), |name| names.values().any(|n| n == name));
            names.insert(label, name);
            let rings = rings(&vertices, &surface.points);
            made.push(Rim { vertices, rings, label });
        }
        Ok(Self { n_points: surface.points.len(), triangles, patches, names, rims: made })
    }

    /// How many rims were found.
    pub fn len(&self) -> usize {
        self.rims.len()
    }

    /// Whether there is none: never so.
    pub fn is_empty(&self) -> bool {
        self.rims.is_empty()
    }

    /// A frame of the surface, closed. Its points come first; the same number of points and triangles for every frame.
    ///
    /// # Errors
    /// When the frame has another number of points.
    pub fn close(&self, frame: &Mesh) -> Result<Mesh> {
        if frame.points.len() != self.n_points {
            return Err(Error::input(format!(
                "has {} points, the first frame {}",
                frame.points.len(),
                self.n_points
            ))
            .remedy("frames of one surface have the same points in the same order"));
        }
        let (mut points, mut triangles, mut patches) =
            (frame.points.clone(), self.triangles.clone(), self.patches.clone());
        for rim in &self.rims {
            rim.close(&mut points, &mut triangles);
            patches.resize(triangles.len(), rim.label);
        }
        let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened())?;
        Ok(Mesh {
            cell_data: vec![Field::scalars("patch", patches)],
            label_names: LabelNames { patches: self.names.clone(), ..LabelNames::default() },
            ..Mesh::new(points, cells)
        })
    }
}

/// The lengths of the edges of a rim.
fn edges(rim: &[VertexId], points: &[Point]) -> Vec<f64> {
    let next = rim.iter().cycle().skip(1);
    rim.iter().zip(next).map(|(a, b)| distance(points[a.index()], points[b.index()])).collect()
}

/// Chains of edges that one triangle alone uses, each turned against its triangle: as a cap goes.
fn rims(triangles: &[[VertexId; 3]]) -> Result<Vec<Vec<VertexId>>> {
    let ways = || triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut uses: HashMap<[VertexId; 2], usize> = HashMap::new();
    ways().for_each(|[a, b]| *uses.entry([a.min(b), a.max(b)]).or_default() += 1);
    let mut next: BTreeMap<VertexId, VertexId> = BTreeMap::new();
    for [a, b] in ways().filter(|[a, b]| uses[&[*a.min(b), *a.max(b)]] == 1) {
        if next.insert(b, a).is_some() {
            return Err(Error::input(
                "two rims of the surface meet here, or its triangles are turned both ways",
            )
            .at(format!("point {b}"))
            .remedy("mend the surface first: `motet mesh --repair` names what is wrong"));
        }
    }
    let mut rims = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let (mut rim, mut at) = (Vec::new(), start);
        while let Some(to) = next.remove(&at) {
            rim.push(at);
            at = to;
        }
        if at != start || rim.len() < 3 {
            return Err(Error::input("a rim of the surface does not close").at(format!("point {at}")));
        }
        rims.push(rim);
    }
    match rims.is_empty() {
        true => Err(Error::input("has no open rim to cap")),
        false => Ok(rims),
    }
}

/// How many vertices each ring has.
fn rings(rim: &[VertexId], points: &[Point]) -> Vec<usize> {
    let n = rim.len();
    let centre = mean(rim, points);
    let radius = rim.iter().map(|v| distance(points[v.index()], centre)).sum::<f64>() / n as f64;
    let edge = edges(rim, points).iter().sum::<f64>() / n as f64;
    let n_rings = if edge > 0.0 { ((radius / (RING * edge)).round() as usize).clamp(1, n) } else { 1 };
    let inner = (1..n_rings).map(|j| (n * (n_rings - j)).div_ceil(n_rings).max(5));
    inner.chain([1]).collect()
}

fn mean(rim: &[VertexId], points: &[Point]) -> Point {
    let sum = rim.iter().fold([0.0; 3], |sum, v| add(sum, points[v.index()]));
    scale(sum, 1.0 / rim.len() as f64)
}

impl Rim {
    /// Adds the points and the triangles of the cap.
    fn close(&self, points: &mut Vec<Point>, triangles: &mut Vec<[VertexId; 3]>) {
        let centre = mean(&self.vertices, points);
        let mut outer = self.vertices.clone();
        for (j, &n) in self.rings.iter().enumerate() {
            let inward = (j + 1) as f64 / self.rings.len() as f64;
            let first = points.len();
            for k in 0..n {
                let on_rim = self.at(k as f64 / n as f64, points);
                let place = if n == 1 { centre } else { add(on_rim, scale(sub(centre, on_rim), inward)) };
                points.push(place);
            }
            let inner: Vec<VertexId> = (first..points.len()).map(VertexId::new).collect();
            zip(&outer, &inner, triangles);
            outer = inner;
        }
    }

    /// The place at a part of the way round the rim, by number of vertices.
    fn at(&self, part: f64, points: &[Point]) -> Point {
        let n = self.vertices.len();
        let along = part * n as f64;
        let k = along.floor() as usize;
        let [a, b] = [k % n, (k + 1) % n].map(|k| points[self.vertices[k].index()]);
        add(a, scale(sub(b, a), along - along.floor()))
    }
}

/// Triangles between two rings that begin at the same part of the way round.
fn zip(outer: &[VertexId], inner: &[VertexId], triangles: &mut Vec<[VertexId; 3]>) {
    let (n, m) = (outer.len(), inner.len());
    let (mut i, mut j) = (0, 0);
    // Whichever ring's next vertex comes first on the way round; a ring of one has none.
    while i < n || (j < m && m > 1) {
        let is_outer = m == 1 || j == m || (i < n && (2 * i + 1) * m <= (2 * j + 1) * n);
        let [a, b] = [outer[i % n], inner[j % m]];
        if is_outer {
            triangles.push([a, outer[(i + 1) % n], b]);
            i += 1;
        } else {
            triangles.push([a, inner[(j + 1) % m], b]);
            j += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Threads;
    use crate::mesh::shapes::Aneurysm;
    use crate::preflight::{Role, preflight};

    /// An aneurysm without its inlet and outlet.
    fn open() -> Mesh {
        let whole = Aneurysm::default().mesh().unwrap();
        let surface = Surface::of(&whole);
        let wall = whole.find_patch("wall").unwrap();
        let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| **p == wall);
        let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
        Mesh::new(whole.points, Cells::uniform(CellKind::TRIANGLE, triangles).unwrap())
    }

    #[test]
    fn a_vessel_gets_two_caps_and_encloses_what_it_did() {
        let open = open();
        let caps = Caps::of(&open).unwrap();
        assert_eq!(caps.len(), 2);
        let closed = caps.close(&open).unwrap();
        assert_eq!(closed.points[..open.points.len()], open.points);
        let surface = Surface::of(&closed);
        assert!(crate::mesh::check::is_closed(surface.triangles.iter().map(|t| t.as_slice())));
        let whole = Surface::of(&Aneurysm::default().mesh().unwrap()).enclosed_volume();
        // Rims are flat, so caps are.
        assert!((surface.enclosed_volume() - whole).abs() < 1e-12 * whole);
        assert_eq!(closed.label_names.patches.values().collect::<Vec<_>>(), ["wall", "cap_1", "cap_2"]);
        assert!(
            preflight(
                &surface.points,
                &surface.triangles,
                &vec![0; surface.triangles.len()],
                &[Role::Boundary],
                &Threads::single()
            )
            .is_fit()
        );
    }

    #[test]
    fn caps_follow_a_rim_that_moves() {
        let open = open();
        let caps = Caps::of(&open).unwrap();
        let mut moved = open.clone();
        let map = |p: Point| [1.1 * p[0] + 0.2 * p[1] + 3.0, 0.9 * p[1], p[2] - 0.3 * p[0]];
        moved.points.iter_mut().for_each(|p| *p = map(*p));
        let [a, b] = [&open, &moved].map(|frame| caps.close(frame).unwrap());
        assert_eq!(a.cells, b.cells);
        for (p, q) in a.points.iter().zip(&b.points) {
            assert!(distance(map(*p), *q) < 1e-13);
        }
        moved.points.pop();
        assert!(caps.close(&moved).is_err());
    }

    #[test]
    fn what_has_no_rim_is_told() {
        let whole = Aneurysm::default().mesh().unwrap();
        assert!(Caps::of(&whole).unwrap_err().to_string().contains("no open rim"));
        let two = [[0, 1, 2], [0, 3, 4]].map(|t| t.map(VertexId)).as_flattened().to_vec();
        let touching = Mesh::new(vec![[0.0; 3]; 5], Cells::uniform(CellKind::TRIANGLE, two).unwrap());
        assert!(Caps::of(&touching).unwrap_err().to_string().starts_with("point 0"));
    }
}
