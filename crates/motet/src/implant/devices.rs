//! All devices as one set of triangles, and the tets that they keep.

use super::options::{Device, Inside};
use crate::base::{Csr, Error, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::tet::volume;
use crate::geometry::triangle::area;
use crate::mesh::{Surface, TetMesh, TetPart, firsts_at_place};
use crate::meshing::{compact, used_vertices};
use crate::preflight::{Role, preflight, renamed};

/// Devices over one list of points; what several of them share is stored once.
pub(super) struct Devices {
    /// The points that triangles and tets use.
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// The devices that each triangle belongs to, in ascending order.
    pub(super) of_triangle: Csr<u32>,
    /// The tets that devices keep.
    pub(super) own_tets: Vec<OwnTet>,
    pub(super) insides: Vec<Inside>,
    pub(super) names: Vec<String>,
    /// The names of the regions of each device: that of the device, followed by the region's own name if
    /// there are several.
    pub(super) region_names: Vec<Vec<String>>,
}

/// A tet that a device keeps, positively oriented.
#[derive(Clone, Copy, Debug)]
pub(super) struct OwnTet {
    pub(super) vertices: [VertexId; 4],
    pub(super) device: u32,
    /// The region of the tet, as an index into the names of its device in [`Devices::region_names`].
    pub(super) region: u32,
}

impl Devices {
    /// Joins the surfaces and tets of all devices.
    ///
    /// # Errors
    /// When a device has no surface, or none that encloses something without fault; when one is to keep its
    /// tets and has none, or has other cells as well.
    pub(super) fn join(devices: &[Device], threads: &Threads) -> Result<Self> {
        let (mut points, mut triangles, mut of) = (Vec::new(), Vec::new(), Vec::new());
        let (mut own_tets, mut region_names) = (Vec::new(), Vec::new());
        for (device, number) in devices.iter().zip(0u32..) {
            let first = points.len();
            let moved = |v: VertexId| VertexId::new(first + v.index());
            if device.inside == Inside::Own {
                let part = tets(device)?;
                let (ids, names) = regions(device, &part);
                for (tet, region) in part.tets.iter().zip(&part.regions) {
                    let region = ids.binary_search(region).unwrap_or_default() as u32;
                    own_tets.push(OwnTet { vertices: tet.map(moved), device: number, region });
                }
                region_names.push(names);
            } else {
                region_names.push(vec![device.name.clone()]);
            }
            let surface = surface(device);
            triangles.extend(surface.triangles.iter().map(|t| t.map(moved)));
            of.resize(triangles.len(), number);
            points.extend_from_slice(&device.mesh.points);
        }
        let kept = firsts_at_place(&points);
        let triangles = renamed(&triangles, &kept);
        check(devices, &points, &triangles, &of, threads)?;
        for OwnTet { vertices, .. } in &mut own_tets {
            *vertices = vertices.map(|v| kept[v.index()]);
            if volume(vertices.map(|v| points[v.index()])) < 0.0 {
                vertices.swap(2, 3);
            }
        }
        let mut joined = Self {
            points,
            triangles: Vec::new(),
            of_triangle: Csr::default(),
            own_tets,
            insides: devices.iter().map(|device| device.inside).collect(),
            names: devices.iter().map(|device| device.name.clone()).collect(),
            region_names,
        };
        joined.share(&triangles, &of);
        joined.compact();
        Ok(joined)
    }

    /// Adds each triangle once, as the first device has it.
    fn share(&mut self, triangles: &[[VertexId; 3]], of: &[u32]) {
        let mut order: Vec<usize> = (0..triangles.len()).collect();
        order.sort_by_key(|&t| (sorted_ids(triangles[t]), t));
        let mut groups: Vec<&[usize]> =
            order.chunk_by(|&x, &y| sorted_ids(triangles[x]) == sorted_ids(triangles[y])).collect();
        groups.sort_unstable_by_key(|same| same[0]);
        for same in groups {
            self.triangles.push(triangles[same[0]]);
            self.of_triangle.push(same.iter().map(|&t| of[t]));
        }
    }

    /// Removes points that nothing uses.
    fn compact(&mut self) {
        let of_tets = self.own_tets.iter().flat_map(|tet| &tet.vertices);
        let is_used = used_vertices(self.points.len(), self.triangles.as_flattened().iter().chain(of_tets));
        let (points, old_to_new) = compact(&self.points, &is_used);
        self.triangles = renamed(&self.triangles, &old_to_new);
        self.own_tets.iter_mut().for_each(|tet| tet.vertices = tet.vertices.map(|v| old_to_new[v.index()]));
        self.points = points;
    }

    /// The triangles of a device.
    pub(super) fn triangles_of(&self, device: usize) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.triangles.len()).filter(move |&t| self.of_triangle.list(t).contains(&(device as u32)))
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [Point; 3] {
        self.triangles[triangle].map(|v| self.points[v.index()])
    }

    /// The edge length of an equilateral triangle whose area is the median of all triangles.
    pub(super) fn size(&self) -> f64 {
        let mut areas: Vec<f64> = (0..self.triangles.len()).map(|t| area(self.corners(t))).collect();
        let middle = areas.len() / 2;
        (areas.select_nth_unstable_by(middle, f64::total_cmp).1.max(0.0) * 4.0 / 3f64.sqrt()).sqrt()
    }

    /// The volume that each device encloses.
    pub(super) fn volumes(&self, devices: &[Device]) -> Vec<f64> {
        devices.iter().map(|device| surface(device).enclosed_volume().abs()).collect()
    }
}

/// The surface of a device: its boundary if it keeps its tets or has no surface cells, else its surface
/// cells.
pub(super) fn surface(device: &Device) -> Surface {
    match device.inside {
        Inside::Own => Surface::boundary_of(&device.mesh),
        _ => Surface::own_or_boundary_of(&device.mesh),
    }
}

/// The regions of a device, in ascending order, and the name of each in the result.
fn regions(device: &Device, part: &TetMesh) -> (Vec<i32>, Vec<String>) {
    let mut ids = part.regions.clone();
    ids.sort_unstable();
    ids.dedup();
    let labels = device.mesh.regions();
    let name = |id: &i32| match &labels {
        Some(labels) if ids.len() > 1 => format!("{}-{}", device.name, labels.name(*id)),
        _ => device.name.clone(),
    };
    let names = ids.iter().map(name).collect();
    (ids, names)
}

fn tets(device: &Device) -> Result<TetMesh> {
    let part = TetPart::of(&device.mesh).map_err(|e| {
        Error::input(format!("the device `{}` is to keep its tets, but has none", device.name))
            .at(e.what().to_owned())
            .remedy("make it filled or hollow")
    })?;
    let kinds = device.mesh.cells.kinds().iter();
    let n_solid = kinds.filter(|kind| kind.dim() == Some(3)).count();
    if n_solid == part.mesh.tets.len() {
        return Ok(part.mesh);
    }
    let what = format!(
        "the device `{}` has {} volume cells that are not linear tets",
        device.name,
        n_solid - part.mesh.tets.len()
    );
    Err(Error::input(what).remedy("give a device made only of tets, or make it filled"))
}

fn check(
    devices: &[Device],
    points: &[Point],
    triangles: &[[VertexId; 3]],
    of: &[u32],
    threads: &Threads,
) -> Result<()> {
    let roles = vec![Role::Boundary; devices.len()];
    let found = preflight(points, triangles, of, &roles, threads);
    let Some(error) = found.first_error() else { return Ok(()) };
    let fault = found.faults.iter().find(|fault| fault.is_fatal);
    let name = fault.map_or("", |fault| &devices[fault.surface as usize].name);
    let refusal = Error::input(format!("the device `{name}`: {}", error.what()))
        .at(error.place().unwrap_or_default().to_owned());
    Err(refusal.remedy(error.remedy_text().unwrap_or_default().to_owned()))
}
