//! How a surface is made even, in words: what files, Python and other callers give.

use super::super::adapt::Adapting;
use super::super::sizes::{Sizes, sizes_by};
use super::super::words::EdgeLength;
use super::clip::Cut;
use super::options::Options;
use crate::base::{Error, Result};
use crate::mesh::Mesh;
use crate::preflight::Repairs;
use crate::words;

words! {
    /// How a surface gets even triangles.
    pub struct SurfaceWords {
        /// Edges have about this length, in the unit of the surface, and are shorter where the distance
        /// requires it; `auto`, as by default: that of the edges of as many even triangles.
        size: Option<EdgeLength> = None,
        /// How far the new surface may stray from the given one, and that from it, in the unit of the
        /// surface. By default a thousandth of the largest extent.
        distance: Option<f64> = None,
        /// Edges at which triangles meet at more than this angle, in degrees, are creases that stay.
        feature_angle: f64 = Adapting::default().feature_angle,
        /// How much sizes grow per unit of distance from where they are smaller; at most 0.7. By default 0.3.
        growth: Option<f64> = None,
        /// An array of the surface's points or cells that has the sizes there, up to `size`.
        size_array: Option<String> = None,
        /// Ends that are cut off first. Six numbers x, y, z, nx, ny, nz: the part in front of the plane
        /// through the place x, y, z with this normal, along the line nearest to the place; the rest of the
        /// vessel stays where it meets the plane again. Four numbers x, y, z, r: all inside a sphere.
        clip: Vec<Vec<f64>> = Vec::new(),
        /// The surface is repaired first: edges are divided at vertices on them (T-junctions), faces that lie
        /// on each other are divided alike, duplicates are dropped, triangles are turned to face one side,
        /// outward where the surface is closed. Holes stay, unless `hole_edges` is given.
        repair: bool = false,
        /// Bodies that cross, touch or lie on each other become one: what lies inside is left out, except
        /// voids, which face inward. The surface has to be closed. Alone, or with `repair`.
        unite: bool = false,
        /// The surface is replaced by a closed one within this distance, in its unit, around what it
        /// encloses, as winding numbers tell: it may be open, torn, double, and cross itself. Walls and gaps
        /// thinner than the distance may be lost. Not with `unite`.
        wrap: Option<f64> = None,
        /// With `repair`, holes of at most this many edges are closed.
        hole_edges: usize = 0,
        /// With `repair`, points nearer than this are merged, in the unit of the surface.
        merge: f64 = 0.0,
        /// The surface is smoothed first, in so many passes that keep its volume (Taubin 1995); rims, borders
        /// of patches and creases stay. The distance is then measured from the smoothed surface.
        smooth: usize = 0,
    }
}

impl SurfaceWords {
    /// The options that these words determine for a mesh.
    ///
    /// # Errors
    /// When both `unite` and `wrap` are requested, when the mesh has no such array of sizes, or a size in it
    /// is not a length.
    pub fn options(&self, mesh: &Mesh) -> Result<Options> {
        if self.unite && self.wrap.is_some() {
            return Err(Error::options("`unite` divides the surface, `wrap` makes a new one")
                .remedy("give one of the two"));
        }
        let largest = match self.size {
            Some(EdgeLength::Length(h)) => Some(h),
            _ => None,
        };
        let at_points = self.size_array.as_deref().map(|array| sizes_by(mesh, array)).transpose()?;
        let repairs = match self.repair {
            true => Repairs {
                close_holes: (self.hole_edges > 0).then_some(self.hole_edges),
                ..Repairs::all(self.merge, self.hole_edges)
            },
            false => Repairs::default(),
        };
        Ok(Options {
            cuts: self.clip.iter().map(|numbers| Cut::of_numbers(numbers)).collect::<Result<_>>()?,
            sizes: Sizes::of(largest, false, self.growth, at_points),
            adapting: Adapting { distance: self.distance, feature_angle: self.feature_angle },
            repairs: Repairs { unite: self.unite, wrap: self.wrap, ..repairs },
            smooth: self.smooth,
            held: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::ball;

    #[test]
    fn the_defaults_are_those_of_the_options() {
        let mesh = ball(2, 1);
        assert_eq!(SurfaceWords::default().options(&mesh).unwrap(), Options::default());
    }

    #[test]
    fn words_become_options() {
        let mesh = ball(2, 1);
        let words: SurfaceWords =
            serde_json::from_str(r#"{"size": 0.5, "growth": 0.2, "repair": true, "smooth": 3}"#).unwrap();
        let options = words.options(&mesh).unwrap();
        assert_eq!(options.sizes, Sizes::of(Some(0.5), false, Some(0.2), None));
        assert_eq!((options.repairs.close_holes, options.repairs.orient, options.smooth), (None, true, 3));
        let closing = SurfaceWords { repair: true, hole_edges: 9, ..SurfaceWords::default() };
        assert_eq!(closing.options(&mesh).unwrap().repairs.close_holes, Some(9));
        let unknown = SurfaceWords { size_array: Some("h".into()), ..SurfaceWords::default() };
        assert!(unknown.options(&mesh).unwrap_err().to_string().contains("no array `h`"));
    }
}
