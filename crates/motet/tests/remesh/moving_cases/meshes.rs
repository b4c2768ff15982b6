//! The meshes that are moved: labelled Delaunay tets of scattered points, of ordinary quality.

use motet::base::{Point, Threads, VertexId};
use motet::delaunay::Triangulation;
use motet::geometry::tet::FACETS;
use motet::geometry::vector::{norm, scale, sub};
use motet::mesh::TetMesh;
use motet::mesh::tet_facets::for_each_tet_facet;
use motet::remesh::remesh;

use super::scatter::{Numbers, Scatter};

/// Patches 1 to 6 are the sides of the box, xmin to zmax; this is the sphere or the membrane.
pub const INNER: i32 = 7;

/// The least distance between points, relative to the requested edge length.
const NEAREST: f64 = 0.8;
/// The least distance of inner points from walls, relative to the requested edge length.
const FROM_WALLS: f64 = 0.6;

/// The space between a sphere and a box: a channel with a sphere in it.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    pub low: Point,
    pub high: Point,
    pub centre: Point,
    pub radius: f64,
    /// Edge length at the sphere and far from it.
    pub sizes: [f64; 2],
    pub growth: f64,
}

impl Channel {
    fn height(&self, p: Point) -> f64 {
        norm(sub(p, self.centre)) - self.radius
    }

    /// The mesh, before slivers are removed.
    pub fn mesh(&self, seed: u64) -> TetMesh {
        let [near, far] = self.sizes;
        let size = |p: Point| (near + self.growth * self.height(p)).clamp(near, far);
        let mut scatter = Scatter::new(seed, NEAREST * far);
        scatter.fill(
            |_| NEAREST * near,
            |numbers| {
                let d = [(); 3].map(|()| numbers.between(-1.0, 1.0));
                let length = norm(d);
                let out = scale(d, self.radius / length);
                (length < 1.0 && length > 0.1).then(|| [0, 1, 2].map(|i| self.centre[i] + out[i]))
            },
        );
        let n_sphere = scatter.points.len();
        let stack = Stack { low: self.low, high: self.high, levels: vec![self.low[2], self.high[2]] };
        stack.scatter(&mut scatter, &size, |p| self.height(p) > FROM_WALLS * size(p));
        stack.mesh(scatter.points, |tet| tet.iter().all(|v| v.index() < n_sphere))
    }
}

/// A box, cut into layers by planes across z, each a region of its own.
pub struct Stack {
    pub low: Point,
    pub high: Point,
    /// Bottom, planes between, top.
    pub levels: Vec<f64>,
}

impl Stack {
    /// The mesh with edges of about this length, before slivers are removed.
    pub fn even_mesh(&self, size: f64, seed: u64) -> TetMesh {
        let mut scatter = Scatter::new(seed, NEAREST * size);
        self.scatter(&mut scatter, &|_| size, |_| true);
        self.mesh(scatter.points, |_| false)
    }

    /// Corners first, then points on edges, on sides and planes, inside.
    fn scatter(&self, scatter: &mut Scatter, size: &dyn Fn(Point) -> f64, is_clear: impl Fn(Point) -> bool) {
        let sides = [[self.low[0], self.high[0]], [self.low[1], self.high[1]]];
        let layers: Vec<[f64; 2]> = self.levels.windows(2).map(|z| [z[0], z[1]]).collect();
        for &z in &self.levels {
            (0..4).for_each(|i| scatter.push([sides[0][i & 1], sides[1][i >> 1], z]));
        }
        for &z in &self.levels {
            for i in 0..2 {
                divide(scatter, size, [sides[0][0], sides[1][i], z], [sides[0][1], sides[1][i], z]);
                divide(scatter, size, [sides[0][i], sides[1][0], z], [sides[0][i], sides[1][1], z]);
            }
        }
        for [below, above] in &layers {
            for [x, y] in [0, 1, 2, 3].map(|i| [sides[0][i & 1], sides[1][i >> 1]]) {
                divide(scatter, size, [x, y, *below], [x, y, *above]);
            }
        }
        let least = |p: Point| NEAREST * size(p);
        let at = |numbers: &mut Numbers, [low, high]: [f64; 2]| numbers.between(low, high);
        for &z in &self.levels {
            scatter.fill(least, |n| Some([at(n, sides[0]), at(n, sides[1]), z]));
        }
        for &layer in &layers {
            for i in 0..2 {
                scatter.fill(least, |n| Some([sides[0][i], at(n, sides[1]), at(n, layer)]));
                scatter.fill(least, |n| Some([at(n, sides[0]), sides[1][i], at(n, layer)]));
            }
        }
        for &layer in &layers {
            scatter.fill(least, |n| {
                let p = [at(n, sides[0]), at(n, sides[1]), at(n, layer)];
                let room = (p[0] - sides[0][0]).min(sides[0][1] - p[0]);
                let room = room.min(p[1] - sides[1][0]).min(sides[1][1] - p[1]);
                let room = room.min(p[2] - layer[0]).min(layer[1] - p[2]);
                (room > FROM_WALLS * size(p) && is_clear(p)).then_some(p)
            });
        }
    }

    /// The Delaunay tets of each layer, without those for which `is_out` holds; each layer is a region, with
    /// labelled walls.
    fn mesh(&self, points: Vec<Point>, is_out: impl Fn(&[VertexId; 4]) -> bool) -> TetMesh {
        let mut mesh = TetMesh { points, ..TetMesh::default() };
        for (region, z) in (1..).zip(self.levels.windows(2)) {
            let is_here = |v: &VertexId| (z[0]..=z[1]).contains(&mesh.points[v.index()][2]);
            let ids: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).filter(is_here).collect();
            let layer: Vec<Point> = ids.iter().map(|v| mesh.points[v.index()]).collect();
            let delaunay = Triangulation::new(&layer, &Threads::single()).expect("the points span a volume");
            let tets = delaunay.tets().iter().map(|tet| tet.map(|v| ids[v.index()]));
            mesh.tets.extend(tets.filter(|tet| !is_out(tet)));
            mesh.regions.resize(mesh.tets.len(), region);
        }
        let mut walls = Vec::new();
        for_each_tet_facet(&mesh.tets, &[], |sharing| {
            let of = |&(tet, i): &(motet::base::TetId, usize)| {
                FACETS[i].map(|place| mesh.tets[tet.index()][place])
            };
            match sharing.tets {
                [one] => walls.push(of(one)),
                [one, other] if mesh.regions[one.0.index()] != mesh.regions[other.0.index()] => {
                    walls.push(of(one));
                }
                _ => {}
            }
        });
        mesh.patches = walls.iter().map(|wall| self.patch(wall.map(|v| mesh.points[v.index()]))).collect();
        mesh.triangles = walls;
        mesh
    }

    fn patch(&self, wall: [Point; 3]) -> i32 {
        let lies_on = |side: usize| {
            let plane = if side.is_multiple_of(2) { self.low } else { self.high };
            wall.iter().all(|p| p[side / 2] == plane[side / 2])
        };
        (0..6).find(|&side| lies_on(side)).map_or(INNER, |side| side as i32 + 1)
    }
}

/// Adds points to the interior of an edge, about evenly.
fn divide(scatter: &mut Scatter, size: &dyn Fn(Point) -> f64, from: Point, to: Point) {
    let at =
        |t: f64| [0, 1, 2].map(|i| if from[i] == to[i] { from[i] } else { from[i] + t * (to[i] - from[i]) });
    let n = (norm(sub(to, from)) / size(at(0.5))).round().max(1.0);
    for i in 1..n as usize {
        let off = scatter.numbers.between(-0.15, 0.15);
        scatter.push(at((i as f64 + off) / n));
    }
}

/// Removes slivers and nothing else, as any mesh generator does before it returns a mesh.
pub fn prepared(mesh: &TetMesh) -> TetMesh {
    remesh(mesh, &super::keep(), &Threads::single()).expect("it is a mesh").extract.mesh
}
