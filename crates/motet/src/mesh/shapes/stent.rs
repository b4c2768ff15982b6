//! A stent as a closed surface: rings that zigzag around a cylinder, joined by links, with the same triangles
//! at every radius.
//!
//! ```text
//!    /\    /\    /\     ring 1, and a link to ring 0 where a valley meets a crown.
//!   /  \  /  \  /  \    Unrolled, a ring is the band between two graphs over the angle,
//!  /    \/    \/    \   so no part of it crosses another at any radius; thickness is added
//!       ||    ||        along the radius. With all crowns linked the cells are diamonds, with
//!  \    /\    /\    /   fewer links the stent is of the open kind.
//!   \  /  \  /  \  /
//!    \/    \/    \/     ring 0
//! ```

use std::f64::consts::{PI, TAU};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::LARGEST;
use crate::mesh::Mesh;
use crate::mesh::shapes::check_count;
use crate::mesh::shapes::labelled::surface_mesh;

/// The parameters of a stent. It lies along z from 0; its radius is an argument of [`Self::points`].
#[derive(Clone, Debug, PartialEq)]
pub struct Stent {
    /// Length; the same at every radius. Default 10.
    pub length: f64,
    /// Number of rings; default 6.
    pub rings: usize,
    /// Number of crowns of each ring; default 8.
    pub crowns: usize,
    /// Width of the struts, seen from outside; default 0.15. Where crimping leaves no space for it, they are
    /// narrower.
    pub strut_width: f64,
    /// Thickness in radial direction, inward; default 0.1.
    pub thickness: f64,
    /// Length of the links, which is the gap between rings; default 0.15.
    pub link_length: f64,
    /// A link at every crown (1), at every second one (2) and so on; default 1.
    pub link_every: usize,
    /// Number of segments from a crown to the next valley; links are one segment wide. Default 6.
    pub segments: usize,
}

impl Default for Stent {
    fn default() -> Self {
        Self {
            length: 10.0,
            rings: 6,
            crowns: 8,
            strut_width: 0.15,
            thickness: 0.1,
            link_length: 0.15,
            link_every: 1,
            segments: 6,
        }
    }
}

/// The corners of the cross-section of a strut, in order around it.
#[derive(Clone, Copy)]
enum Corner {
    LowInner,
    LowOuter,
    HighOuter,
    HighInner,
}
use Corner::{HighInner, HighOuter, LowInner, LowOuter};

impl Stent {
    /// The triangles, facing outward: each edge belongs to two of them, once in each direction.
    ///
    /// # Errors
    /// If the parameters do not fit: counts too small or too large, lengths that are not positive, or rings
    /// that are no longer than their struts are wide.
    pub fn triangles(&self) -> Result<Vec<[VertexId; 3]>> {
        self.check()?;
        let mut quads = Vec::new();
        for ring in 0..self.rings {
            for i in 0..self.n_around() {
                let at = |corner, next| self.vertex(ring, i + next, corner);
                quads.push([at(LowOuter, 0), at(LowOuter, 1), at(HighOuter, 1), at(HighOuter, 0)]);
                quads.push([at(LowInner, 0), at(HighInner, 0), at(HighInner, 1), at(LowInner, 1)]);
                // Both are cut along the same diagonal, so that they stay apart however steep the strut is.
                if !self.has_link(ring, i) {
                    quads.push([at(HighOuter, 0), at(HighOuter, 1), at(HighInner, 1), at(HighInner, 0)]);
                }
                if ring == 0 || !self.has_link(ring - 1, i) {
                    quads.push([at(LowInner, 1), at(LowOuter, 1), at(LowOuter, 0), at(LowInner, 0)]);
                }
                if self.has_link(ring, i) {
                    let above = |corner, next| self.vertex(ring + 1, i + next, corner);
                    quads.push([at(HighOuter, 0), at(HighOuter, 1), above(LowOuter, 1), above(LowOuter, 0)]);
                    quads.push([at(HighInner, 0), above(LowInner, 0), above(LowInner, 1), at(HighInner, 1)]);
                    quads.push([at(HighOuter, 0), above(LowOuter, 0), above(LowInner, 0), at(HighInner, 0)]);
                    quads.push([at(HighOuter, 1), at(HighInner, 1), above(LowInner, 1), above(LowOuter, 1)]);
                }
            }
        }
        Ok(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
    }

    /// The points of the stent at an outer radius; the triangles are the same at every radius.
    ///
    /// # Errors
    /// The errors of [`Stent::triangles`], and if the radius is not larger than the thickness.
    pub fn points(&self, radius: f64) -> Result<Vec<Point>> {
        self.check()?;
        if !(radius > self.thickness && radius <= LARGEST) {
            return Err(Error::options(format!(
                "the radius {radius} must be larger than the thickness {}, and at most {LARGEST:e}",
                self.thickness
            ))
            .remedy("give an outer radius larger than the thickness"));
        }
        let mut points = Vec::with_capacity(4 * self.rings * self.n_around());
        for ring in 0..self.rings {
            for i in 0..self.n_around() {
                let phase = self.phase(i);
                let (sin, cos) = (phase / self.crowns as f64).sin_cos();
                let (middle, half) = self.strut(ring, phase, radius);
                let inner = radius - self.thickness;
                let [low, high] = [middle - half, middle + half];
                for (r, z) in [(inner, low), (radius, low), (radius, high), (inner, high)] {
                    points.push([r * cos, r * sin, z]);
                }
            }
        }
        Ok(points)
    }

    /// Points and triangles as a mesh with the patch `stent`.
    ///
    /// # Errors
    /// The errors of [`Stent::points`].
    pub fn mesh(&self, radius: f64) -> Result<Mesh> {
        Ok(surface_mesh(self.points(radius)?, &self.triangles()?, "stent"))
    }

    /// Number of links.
    pub fn n_links(&self) -> usize {
        let linked = |ring: usize| (0..self.n_around()).filter(|&i| self.has_link(ring, i)).count();
        (0..self.rings).map(linked).sum()
    }

    fn check(&self) -> Result<()> {
        let counts = [self.rings, self.crowns, self.link_every];
        if counts.contains(&0) || self.segments < 2 {
            return Err(Error::options("a stent needs rings, crowns and links, and two segments per strut")
                .remedy("give rings, crowns and link_every of at least 1 and segments of at least 2"));
        }
        // Counts beyond this are a mistake, and ids would not fit.
        let n = [self.rings, self.crowns, self.segments].map(|n| n as f64).iter().product::<f64>() * 8.0;
        check_count(n)?;
        let lengths = [self.length, self.strut_width, self.thickness, self.link_length];
        if lengths.iter().any(|x| !(*x > 0.0 && *x <= LARGEST)) {
            return Err(Error::options(format!(
                "got {lengths:?} for length, strut width, thickness and link length"
            ))
            .remedy("give lengths larger than 0"));
        }
        if self.amplitude() <= 0.0 {
            let (rings, length) = (self.rings, self.length);
            return Err(Error::options(format!("{rings} rings do not fit into a length of {length}"))
                .remedy("ask for fewer rings, narrower struts or shorter links"));
        }
        Ok(())
    }

    /// Half the distance along z from valley to crown, on the centre line of the strut.
    fn amplitude(&self) -> f64 {
        let links = self.link_length * (self.rings as f64 - 1.0);
        ((self.length - links) / self.rings as f64 - self.strut_width) / 2.0
    }

    fn n_around(&self) -> usize {
        2 * self.segments * self.crowns
    }

    /// The phase of the zigzag at position `i`, 2 pi for each crown. Crowns and valleys are in the middle of
    /// a segment, where links fit.
    fn phase(&self, i: usize) -> f64 {
        let in_crown = i % (2 * self.segments);
        let crown = i / (2 * self.segments);
        TAU * crown as f64 + PI * (in_crown as f64 + 0.5) / self.segments as f64
    }

    /// The position along z of the centre line of a strut, and half the height of the strut there: half its
    /// width over the cosine of its slope.
    ///
    /// The height must not grow faster than crowns move away from the valleys of the next ring, by `amplitude
    /// (1 - |cos|)`; growing half as fast keeps the rings a link length apart at every radius.
    fn strut(&self, ring: usize, phase: f64, radius: f64) -> (f64, f64) {
        let amplitude = self.amplitude();
        let sign = if ring.is_multiple_of(2) { 1.0 } else { -1.0 };
        let pitch = 2.0 * amplitude + self.strut_width + self.link_length;
        let middle =
            amplitude + self.strut_width / 2.0 + pitch * ring as f64 + sign * amplitude * phase.cos();
        let slope = amplitude * self.crowns as f64 * phase.sin() / radius;
        let half = self.strut_width / 2.0;
        (middle, (half * slope.hypot(1.0)).min(half + amplitude * (1.0 - phase.cos().abs()) / 2.0))
    }

    /// Whether a link leads up from this ring at the segment from `i`.
    fn has_link(&self, ring: usize, i: usize) -> bool {
        // Even rings have their crowns where the phase is 0, odd ones half a period later.
        let shift = if ring.is_multiple_of(2) { 1 } else { 1 + self.segments };
        let (crown, place) = ((i + shift) / (2 * self.segments), (i + shift) % (2 * self.segments));
        ring + 1 < self.rings && place == 0 && (crown % self.crowns + ring).is_multiple_of(self.link_every)
    }

    fn vertex(&self, ring: usize, i: usize, corner: Corner) -> VertexId {
        let n = self.n_around();
        VertexId::new((ring * n + i % n) * 4 + corner as usize)
    }
}
