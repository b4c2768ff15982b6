//! Closes open rims by caps of triangles, with the same connectivity for every frame of a moving surface.
//!
//! A cap consists of rings of vertices that shrink towards the middle of its rim, each vertex a fixed mean of
//! vertices of the rim: so caps follow a rim that moves or bends. A cap is as flat as its rim. Rims that were
//! cut by hand are not flat; they can be moved onto their planes.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, distance, dot, scale, sub, unit};
use crate::mesh::disc::{disc_of_rings, n_rings};
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Surface, unused_name};
use crate::preflight::open_rims;

/// The caps of a surface, made from one frame and applied to any.
#[derive(Clone, Debug)]
pub struct Caps {
    n_points: usize,
    /// The triangles of the surface, with patches.
    triangles: Vec<[VertexId; 3]>,
    patches: Vec<i32>,
    names: BTreeMap<i32, String>,
    rims: Vec<Rim>,
}

/// How flat a rim, and therefore its cap, is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RimPlane {
    /// The patch of the cap.
    pub patch: String,
    /// The largest distance of a vertex of the rim from the middle of the rim, in the unit of the points.
    pub radius: f64,
    /// The largest distance of a vertex of the rim from the rim's plane: the one through the middle, normal
    /// to the rim's area vector.
    pub deviation: f64,
}

/// One rim and its cap.
#[derive(Clone, Debug)]
struct Rim {
    /// In the direction in which the cap's triangles run around it.
    vertices: Vec<VertexId>,
    /// The number of rings inside it.
    n_rings: usize,
    label: i32,
}

impl Caps {
    /// Finds the rims of a surface: chains of edges that only one triangle uses. Caps become patches `cap_1`,
    /// `cap_2`, ..., the longest rim first; triangles without a patch become `wall`.
    ///
    /// # Errors
    /// When there is no rim, or open edges do not form closed chains.
    pub fn of(surface: &Mesh) -> Result<Self> {
        let Surface { triangles, patches, patch_names: mut names, .. } = Surface::of(surface);
        let points = &surface.points;
        let mut rims = rims(points, &triangles)?;
        rims.sort_by(|a, b| length(b, points).total_cmp(&length(a, points)).then_with(|| a.cmp(b)));
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
            let n_rings = n_rings(points, &vertices);
            made.push(Rim { vertices, n_rings, label });
        }
        Ok(Self { n_points: surface.points.len(), triangles, patches, names, rims: made })
    }

    /// The number of rims.
    pub fn len(&self) -> usize {
        self.rims.len()
    }

    /// Whether there are no rims; always false.
    pub fn is_empty(&self) -> bool {
        self.rims.is_empty()
    }

    /// Returns how flat the rims of a frame are, in the order of the caps.
    ///
    /// # Errors
    /// When the frame has a different number of points, or a rim encloses no area.
    pub fn planes(&self, frame: &Mesh) -> Result<Vec<RimPlane>> {
        self.check(frame)?;
        let plane = |rim: &Rim| Ok(self.plane_of(rim, &frame.points)?.0);
        self.rims.iter().map(plane).collect()
    }

    /// Returns a frame of the surface with the vertices of each rim moved onto the rim's plane, along its
    /// normal, so that its caps will be flat; all else stays to the bit. Also returns how far each rim was
    /// off.
    ///
    /// # Errors
    /// The errors of [`Self::planes`]; also when a triangle at a rim would turn over or lose its area.
    pub fn flatten(&self, frame: &Mesh) -> Result<(Mesh, Vec<RimPlane>)> {
        self.check(frame)?;
        let mut flat = frame.clone();
        let mut planes = Vec::new();
        for rim in &self.rims {
            let (found, middle, normal) = self.plane_of(rim, &frame.points)?;
            for v in &rim.vertices {
                let p = frame.points[v.index()];
                flat.points[v.index()] = sub(p, scale(normal, dot(normal, sub(p, middle))));
            }
            planes.push(found);
        }
        let area = |points: &[Point], t: &[VertexId; 3]| area_vector(t.map(|v| points[v.index()]));
        let is_turned = |t: &&[VertexId; 3]| {
            let [before, after] = [&frame.points, &flat.points].map(|points| area(points, t));
            before != after && dot(before, after) <= 0.0
        };
        match self.triangles.iter().find(is_turned) {
            None => Ok((flat, planes)),
            Some(t) => Err(Error::input("a triangle at the rim would turn over if the rim were flattened")
                .at(format!("point {} at {:?}", t[0], frame.points[t[0].index()]))
                .remedy("cut the vessel across, so that its rim is nearer to a plane; or cap it as it is")),
        }
    }

    fn check(&self, frame: &Mesh) -> Result<()> {
        match frame.points.len() == self.n_points {
            true => Ok(()),
            false => Err(Error::input(format!(
                "has {} points, but the first frame has {}",
                frame.points.len(),
                self.n_points
            ))
            .remedy("frames of one surface have the same points in the same order")),
        }
    }

    /// Returns the plane of a rim: how flat the rim is, its middle, and the unit normal.
    fn plane_of(&self, rim: &Rim, points: &[Point]) -> Result<(RimPlane, Point, Point)> {
        let patch = self.names.get(&rim.label).cloned().unwrap_or_default();
        let corners: Vec<Point> = rim.vertices.iter().map(|v| points[v.index()]).collect();
        let middle = scale(corners.iter().copied().fold([0.0; 3], add), 1.0 / corners.len() as f64);
        let next = corners.iter().cycle().skip(1);
        let area =
            corners.iter().zip(next).fold([0.0; 3], |sum, (&p, &q)| add(sum, area_vector([middle, p, q])));
        let Some(normal) = unit(area) else {
            return Err(Error::input("the rim encloses no area, so it has no plane")
                .at(format!("{patch}, point {}", rim.vertices[0])));
        };
        let off = |p: &Point| dot(normal, sub(*p, middle)).abs();
        let plane = RimPlane {
            patch,
            radius: corners.iter().map(|&p| distance(p, middle)).fold(0.0, f64::max),
            deviation: corners.iter().map(off).fold(0.0, f64::max),
        };
        Ok((plane, middle, normal))
    }

    /// Returns a frame of the surface, closed. Its own points come first; the numbers of points and triangles
    /// are the same for every frame.
    ///
    /// # Errors
    /// When the frame has a different number of points.
    pub fn close(&self, frame: &Mesh) -> Result<Mesh> {
        self.check(frame)?;
        let (mut points, mut triangles, mut patches) =
            (frame.points.clone(), self.triangles.clone(), self.patches.clone());
        for rim in &self.rims {
            triangles.extend(disc_of_rings(&mut points, &rim.vertices, rim.n_rings));
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

/// Finds closed chains of open edges, each in the direction in which a cap runs around it.
fn rims(points: &[Point], triangles: &[[VertexId; 3]]) -> Result<Vec<Vec<VertexId>>> {
    let [closed, torn] = open_rims(points, triangles);
    if let Some(v) = torn.first().and_then(|rim| rim.first()) {
        return Err(Error::input(
            "open edges lead nowhere from here: triangles are not consistently oriented",
        )
        .at(format!("point {v}"))
        .remedy("repair the surface first: `motet mesh --repair` reports what is wrong"));
    }
    match closed.is_empty() {
        true => Err(Error::input("has no open rim to cap")),
        false => Ok(closed),
    }
}

fn length(rim: &[VertexId], points: &[Point]) -> f64 {
    let next = rim.iter().cycle().skip(1);
    rim.iter().zip(next).map(|(a, b)| distance(points[a.index()], points[b.index()])).sum()
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
    fn rims_are_flattened_and_nothing_else_is_touched() {
        let mut open = open();
        let caps = Caps::of(&open).unwrap();
        let before = open.clone();
        let flat_rims: Vec<RimPlane> = caps.planes(&open).unwrap();
        assert!(flat_rims.iter().all(|rim| rim.deviation < 1e-12 * rim.radius));
        // Every other vertex of a rim is off by 0.02 of the radius along the normal of its plane, the others
        // by -0.02.
        for (rim, plane) in caps.rims.iter().zip(&flat_rims) {
            let (_, _, normal) = caps.plane_of(rim, &before.points).unwrap();
            for (i, v) in rim.vertices.iter().enumerate() {
                let by = if i % 2 == 0 { 0.02 } else { -0.02 } * plane.radius;
                open.points[v.index()] = add(open.points[v.index()], scale(normal, by));
            }
        }
        let (flat, planes) = caps.flatten(&open).unwrap();
        assert_eq!(planes, caps.planes(&open).unwrap());
        let is_on_rim = |v: usize| caps.rims.iter().any(|rim| rim.vertices.contains(&VertexId::new(v)));
        for (v, (p, q)) in open.points.iter().zip(&flat.points).enumerate() {
            assert!(is_on_rim(v) || p == q);
        }
        for (plane, was) in caps.planes(&flat).unwrap().iter().zip(&planes) {
            assert!(plane.deviation < 1e-14 * plane.radius, "{plane:?}");
            assert!((was.deviation / was.radius - 0.02).abs() < 2e-3, "{was:?}");
        }
    }

    #[test]
    fn a_rim_that_cannot_be_flattened_is_refused_with_its_place() {
        // A tent without its floor: two of its four corners are so high that the walls would turn over.
        let points =
            vec![[1.0, 0.0, 3.0], [0.0, 1.0, -3.0], [-1.0, 0.0, 3.0], [0.0, -1.0, -3.0], [0.0, 0.0, 1.0]];
        let walls = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]].map(|t| t.map(VertexId));
        let cells = |walls: &[[VertexId; 3]]| {
            Cells::uniform(CellKind::TRIANGLE, walls.as_flattened().to_vec()).unwrap()
        };
        let tent = Mesh::new(points, cells(&walls));
        let caps = Caps::of(&tent).unwrap();
        assert!((caps.planes(&tent).unwrap()[0].deviation - 3.0).abs() < 1e-15);
        assert!(caps.flatten(&tent).is_ok());
        let mut folded = tent.clone();
        folded.points[4] = [0.9, 0.0, 2.0];
        folded.points[0] = [0.5, 0.0, 3.0];
        let error = caps.flatten(&folded).unwrap_err().to_string();
        assert!(error.contains("point") && error.contains("turn over"), "{error}");
    }

    #[test]
    fn what_has_no_rim_is_reported() {
        let whole = Aneurysm::default().mesh().unwrap();
        assert!(Caps::of(&whole).unwrap_err().to_string().contains("no open rim"));
        // Two that share an edge and face opposite sides.
        let two = [[0, 1, 2], [0, 1, 3]].map(|t| t.map(VertexId)).as_flattened().to_vec();
        let torn = Mesh::new(vec![[0.0; 3]; 4], Cells::uniform(CellKind::TRIANGLE, two).unwrap());
        assert!(Caps::of(&torn).unwrap_err().to_string().starts_with("point "));
    }
}
