//! All devices as one set of triangles, and the tets that they bring.

use super::options::{Device, Inside};
use crate::base::{Csr, Error, Point, Result, Threads, VertexId, rising};
use crate::geometry::tet::volume;
use crate::geometry::triangle::area;
use crate::mesh::{Surface, TetPart, firsts_at_place};
use crate::meshing::{compact, named};
use crate::preflight::{Role, preflight, renamed};

/// Devices over one list of points; what several of them share is there once.
pub(super) struct Devices {
    /// The points that triangles and tets use.
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// The devices that each triangle is of, rising.
    pub(super) of_triangle: Csr<u32>,
    /// The tets that devices keep, positively oriented, and the device of each.
    pub(super) own_tets: Vec<([VertexId; 4], u32)>,
    pub(super) insides: Vec<Inside>,
    pub(super) names: Vec<String>,
}

impl Devices {
    /// # Errors
    /// When a device has no surface, or none that encloses something without fault; when one is to keep tets and has none, or other cells as well.
    pub(super) fn join(devices: &[Device], threads: &Threads) -> Result<Self> {
        let (mut points, mut triangles, mut of) = (Vec::new(), Vec::new(), Vec::new());
        let mut own_tets = Vec::new();
        for (device, number) in devices.iter().zip(0u32..) {
            let first = points.len();
            let moved = |v: VertexId| VertexId::new(first + v.index());
            if device.inside == Inside::Own {
                own_tets.extend(tets(device)?.into_iter().map(|tet| (tet.map(moved), number)));
            }
            let surface = surface(device);
            triangles.extend(surface.triangles.iter().map(|t| t.map(moved)));
            of.resize(triangles.len(), number);
            points.extend_from_slice(&device.mesh.points);
        }
        let kept = firsts_at_place(&points);
        let triangles = renamed(&triangles, &kept);
        check(devices, &points, &triangles, &of, threads)?;
        let mut own_tets: Vec<_> = own_tets
            .into_iter()
            .map(|(tet, of): (_, u32)| (tet.map(|v: VertexId| kept[v.index()]), of))
            .collect();
        for (tet, _) in &mut own_tets {
            if volume(tet.map(|v| points[v.index()])) < 0.0 {
                tet.swap(2, 3);
            }
        }
        let mut joined = Self {
            points,
            triangles: Vec::new(),
            of_triangle: Csr::default(),
            own_tets,
            insides: devices.iter().map(|device| device.inside).collect(),
            names: devices.iter().map(|device| device.name.clone()).collect(),
        };
        joined.share(&triangles, &of);
        joined.compact();
        Ok(joined)
    }

    /// Puts in each triangle once, as the first device has it.
    fn share(&mut self, triangles: &[[VertexId; 3]], of: &[u32]) {
        let mut order: Vec<usize> = (0..triangles.len()).collect();
        order.sort_by_key(|&t| (rising(triangles[t]), t));
        let mut groups: Vec<&[usize]> =
            order.chunk_by(|&x, &y| rising(triangles[x]) == rising(triangles[y])).collect();
        groups.sort_unstable_by_key(|same| same[0]);
        for same in groups {
            self.triangles.push(triangles[same[0]]);
            self.of_triangle.push(same.iter().map(|&t| of[t]));
        }
    }

    /// Leaves out points that nothing uses.
    fn compact(&mut self) {
        let of_tets = self.own_tets.iter().flat_map(|(tet, _)| tet);
        let is_used = named(self.points.len(), self.triangles.as_flattened().iter().chain(of_tets));
        let (points, old_to_new) = compact(&self.points, &is_used);
        self.triangles = renamed(&self.triangles, &old_to_new);
        self.own_tets.iter_mut().for_each(|(tet, _)| *tet = tet.map(|v| old_to_new[v.index()]));
        self.points = points;
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [Point; 3] {
        self.triangles[triangle].map(|v| self.points[v.index()])
    }

    /// The length of the edges of an even triangle as large as the middle one of all.
    pub(super) fn size(&self) -> f64 {
        let mut areas: Vec<f64> = (0..self.triangles.len()).map(|t| area(self.corners(t))).collect();
        let middle = areas.len() / 2;
        (areas.select_nth_unstable_by(middle, f64::total_cmp).1.max(0.0) * 4.0 / 3f64.sqrt()).sqrt()
    }

    /// What each device encloses.
    pub(super) fn volumes(&self, devices: &[Device]) -> Vec<f64> {
        devices.iter().map(|device| surface(device).enclosed_volume().abs()).collect()
    }
}

/// The boundary of a device that keeps its tets or has no surface cells, else its surface cells.
pub(super) fn surface(device: &Device) -> Surface {
    let surface = Surface::of(&device.mesh);
    if device.inside == Inside::Own || surface.triangles.is_empty() {
        return Surface::boundary_of(&device.mesh);
    }
    surface
}

fn tets(device: &Device) -> Result<Vec<[VertexId; 4]>> {
    let part = TetPart::of(&device.mesh).map_err(|e| {
        Error::input(format!("the device `{}` is to keep its tets, and has none", device.name))
            .at(e.what().to_owned())
            .remedy("let it be filled, or hollow")
    })?;
    let kinds = device.mesh.cells.kinds().iter();
    let n_solid = kinds.filter(|kind| kind.dim() == Some(3)).count();
    if n_solid == part.mesh.tets.len() {
        return Ok(part.mesh.tets);
    }
    let what = format!(
        "the device `{}` has {} volume cells that are no linear tets",
        device.name,
        n_solid - part.mesh.tets.len()
    );
    Err(Error::input(what).remedy("give one of tets alone, or let it be filled"))
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
    let told = Error::input(format!("the device `{name}`: {}", error.what()))
        .at(error.place().unwrap_or_default().to_owned());
    Err(told.remedy(error.remedy_text().unwrap_or_default().to_owned()))
}
