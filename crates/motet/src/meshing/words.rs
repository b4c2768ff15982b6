//! How surfaces are filled, in words: what files, Python and other callers give.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::adapt::Adapting;
use super::bodies::Seed;
use super::fill::{Dividing, Options};
use super::layers::{Layers, Stack};
use super::sizes::Sizes;
use super::surfaces::Surfaces;
use crate::base::{Error, Point, Result, read_text};
use crate::delaunay::EdgePoints;
use crate::preflight::Repairs;
use crate::words;

words! {
    /// How closed surfaces are repaired first, and filled with tets.
    pub struct MeshingWords {
        /// Points are put inside so that edges have about this length, in the unit of the surface, and bad
        /// tets are repaired; `auto`: the length of the surface's edges, growing inwards. By default only
        /// points without which there are no tets.
        size: Option<EdgeLength> = None,
        /// Whether triangles of the surface are divided to a `size` within their planes, creases kept, or
        /// replaced by even ones.
        surface: Dividing = Dividing::default(),
        /// How far a surface that is adapted may stray from the given one, and that from it, in the unit of
        /// the surface. By default a thousandth of the largest extent.
        distance: Option<f64> = None,
        /// Edges at which triangles meet at more than this angle, in degrees, are creases that stay where a
        /// surface is adapted.
        feature_angle: f64 = Adapting::default().feature_angle,
        /// Sizes grow from the surface inwards, by so much per unit of distance, up to `size`; at most 0.7.
        /// By default they grow, by 0.3, where `size` is `auto` or an array gives sizes.
        growth: Option<f64> = None,
        /// An array of the surface's points or cells that has the sizes there, growing inwards, up to `size`.
        size_array: Option<String> = None,
        /// Places in regions, each with the name of the region.
        seeds: Vec<Seed> = Vec::new(),
        /// Places in regions that are left out.
        holes: Vec<Point> = Vec::new(),
        /// What closed surfaces turned inward enclose, such as the cavity of a hollow body, is left out. With
        /// `repair` such surfaces stay turned inward.
        voids: bool = Options::default().voids,
        /// Tets below this EAS are repaired, the surface kept. By default 0.2 with sizes, else none is.
        min_eas: Option<f64> = None,
        /// Thin layers on walls, as `[PATCH=]N,FIRST,GROWTH`: their number, the thickness of the first, and
        /// the ratio of each thickness to the one before. They go on one patch, or on all that are neither
        /// caps (flat, with a sharp crease all around) nor named. Where there is no space they are thinner,
        /// or absent.
        layers: Vec<WallLayers> = Vec::new(),
        /// Patches that get the `layers` without a patch, which then go on no others.
        layers_on: Vec<String> = Vec::new(),
        /// Layers stay wedges and pyramids instead of being divided into tets: for formats that hold these,
        /// such as VTU, VTK and MSH.
        keep_prisms: bool = Layers::default().keep_prisms,
        /// The surfaces are repaired first: edges are divided at vertices on them (T-junctions), faces that
        /// lie on each other are divided alike, triangles without area and duplicates are dropped, all are
        /// turned outward, small holes are closed.
        repair: bool = false,
        /// Surfaces that cross are divided along the lines where they do, and those that touch: each space
        /// between them is a region. Alone, or with `repair`.
        cut: bool = false,
        /// Bodies that cross, touch or lie on each other become one, all surfaces together: what lies inside
        /// is left out, except voids, which face inward. Alone, or with `repair`; not with `cut`.
        unite: bool = false,
        /// The surfaces are replaced by a closed one within this distance, in their unit, around what they
        /// enclose, as winding numbers tell: they may be open, torn, double, and cross. Walls and gaps
        /// thinner than the distance may be lost. Not with `cut` or `unite`.
        wrap: Option<f64> = None,
        /// With `repair`, holes of at most this many edges are closed.
        hole_edges: usize = 32,
        /// With `repair`, points nearer than this are merged, in the unit of the surface.
        merge: f64 = 0.0,
        /// Points on edges of the surface are allowed: its triangles are then in pieces, and the tets are
        /// Delaunay as far as the triangles allow.
        delaunay: bool = false,
    }
}

impl MeshingWords {
    /// The options that these words determine for surfaces; `at_points` are the sizes from the array, one per
    /// point of the surfaces.
    ///
    /// # Errors
    /// When more than one of `cut`, `unite` and `wrap` is requested, or layers are out of range, requested
    /// twice for a patch, or for one that does not exist.
    pub fn options(&self, surfaces: &Surfaces, at_points: Option<Vec<f64>>) -> Result<Options> {
        if [self.cut, self.unite, self.wrap.is_some()]
            .into_iter()
            .filter(|is_requested| *is_requested)
            .count()
            > 1
        {
            return Err(Error::options(
                "`cut` keeps what bodies have in common as regions, `unite` makes one of them, `wrap` a new surface",
            )
            .remedy("give one of them"));
        }
        let largest = match self.size {
            Some(EdgeLength::Length(h)) => Some(h),
            _ => None,
        };
        let sizes = Sizes::of(largest, self.size == Some(EdgeLength::Auto), self.growth, at_points);
        Ok(Options {
            edge_points: if self.delaunay { EdgePoints::Stay } else { EdgePoints::MoveInside },
            dividing: self.surface,
            adapting: Adapting { distance: self.distance, feature_angle: self.feature_angle },
            seeds: self.seeds.clone(),
            holes: self.holes.clone(),
            voids: self.voids,
            layers: self.layers(surfaces)?,
            ..Options::with_sizes(sizes, self.min_eas)
        })
    }

    /// What is repaired of the surfaces before they are filled; `None`: nothing.
    pub fn repairs(&self) -> Option<Repairs> {
        let repairs = match self.repair {
            true => Repairs::all(self.merge, self.hole_edges),
            false => Repairs::default(),
        };
        let is_any = self.repair || self.cut || self.unite || self.wrap.is_some();
        let (cut, unite, wrap, keep_inward) = (self.cut, self.unite, self.wrap, self.voids);
        is_any.then_some(Repairs { cut, unite, wrap, keep_inward, ..repairs })
    }

    /// The requested layers; `None` where there are none.
    fn layers(&self, surfaces: &Surfaces) -> Result<Option<Layers>> {
        let mut everywhere = self.layers_without_patch()?;
        let of_patch = |layers: &WallLayers| Some((layers.patch.clone()?, layers.stack));
        let mut named: Vec<(String, Stack)> = self.layers.iter().filter_map(of_patch).collect();
        if !self.layers_on.is_empty() {
            let stack = everywhere.take().ok_or_else(|| {
                Error::options("patches get layers that are given without a patch, but there are none")
                    .remedy("give N,FIRST,GROWTH for them")
            })?;
            named.extend(self.layers_on.iter().map(|patch| (patch.clone(), stack)));
        }
        let mut by_patch = BTreeMap::new();
        for (patch, stack) in named {
            if by_patch.insert(surfaces.find_patch(&patch)?, stack).is_some() {
                return Err(twice(&format!("on `{patch}`")));
            }
        }
        let layers = Layers { everywhere, by_patch, keep_prisms: self.keep_prisms };
        (!self.layers.is_empty()).then(|| layers.check().map(|()| layers)).transpose()
    }

    /// The layers that are given without a patch.
    fn layers_without_patch(&self) -> Result<Option<Stack>> {
        let mut without = self.layers.iter().filter(|layers| layers.patch.is_none());
        match (without.next(), without.next()) {
            (_, Some(_)) => Err(twice("without a patch")),
            (first, None) => Ok(first.map(|layers| layers.stack)),
        }
    }
}

fn twice(which: &str) -> Error {
    Error::options(format!("layers {which} are given twice")).remedy("leave one out")
}

/// A requested edge length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeLength {
    /// This length.
    Length(f64),
    /// That of the edges of the surface, growing inwards.
    Auto,
}

impl EdgeLength {
    /// The length that a text denotes: a number, or `auto`.
    ///
    /// # Errors
    /// When the text is neither, or the number is not above 0.
    pub fn of_text(text: &str) -> Result<Self> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let length = text.trim().parse().ok().filter(|h| *h > 0.0 && f64::is_finite(*h));
        length
            .map(Self::Length)
            .ok_or_else(|| Error::options(format!("a size is a number above 0, or auto; got `{text}`")))
    }
}

impl Serialize for EdgeLength {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Length(length) => serializer.serialize_f64(*length),
            Self::Auto => serializer.serialize_str("auto"),
        }
    }
}

impl<'de> Deserialize<'de> for EdgeLength {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read_text(deserializer, Self::of_text)
    }
}

/// Requested layers, as a text: `[PATCH=]N,FIRST,GROWTH`.
#[derive(Clone, Debug, PartialEq)]
pub struct WallLayers {
    /// The patch that gets them, by name or number; `None`: all walls but caps and patches that are named.
    pub patch: Option<String>,
    /// The layers.
    pub stack: Stack,
}

impl WallLayers {
    /// The layers that a text denotes: their number, the thickness of the first and the ratio of each
    /// thickness to the one before, behind the patch, if there is one: `wall=5,0.02,1.2`.
    ///
    /// # Errors
    /// When the text is none of this, or a number is out of its range.
    pub fn of_text(text: &str) -> Result<Self> {
        // Split at the last equals sign, since numbers contain none and names might.
        let (patch, numbers) = match text.rsplit_once('=') {
            Some((patch, numbers)) => (Some(patch.to_owned()), numbers),
            None => (None, text),
        };
        let words: Vec<&str> = numbers.split(',').map(str::trim).collect();
        let [count, first, growth] = words[..] else {
            return Err(Error::options(format!("N,FIRST,GROWTH has 3 numbers; got {}", words.len())));
        };
        if patch.as_deref() == Some("") {
            return Err(Error::options("[PATCH=]N,FIRST,GROWTH is expected, such as wall=5,0.02,1.2"));
        }
        let count = count
            .parse()
            .map_err(|_| Error::options(format!("`{count}` is not a valid number of layers")))?;
        let stack = Stack { count, first: finite(first)?, growth: finite(growth)? };
        stack.check()?;
        Ok(Self { patch, stack })
    }
}

fn finite(word: &str) -> Result<f64> {
    let number = word.parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| Error::options(format!("`{word}` is not a finite number")))
}

impl Serialize for WallLayers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Stack { count, first, growth } = self.stack;
        let patch = self.patch.as_ref().map(|patch| format!("{patch}=")).unwrap_or_default();
        serializer.collect_str(&format_args!("{patch}{count},{first},{growth}"))
    }
}

impl<'de> Deserialize<'de> for WallLayers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read_text(deserializer, Self::of_text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Words;
    use crate::mesh::shapes;
    use crate::preflight::Role;

    fn ball() -> Surfaces {
        Surfaces::new(&[(&shapes::ball(2, 2), Role::Boundary, "ball")]).unwrap()
    }

    fn layers(all: &[&str], on: &[&str]) -> Result<Option<Layers>> {
        let layers = all.iter().map(|text| WallLayers::of_text(text)).collect::<Result<_>>()?;
        let layers_on = on.iter().map(|&patch| patch.to_owned()).collect();
        MeshingWords { layers, layers_on, ..MeshingWords::default() }.layers(&ball())
    }

    #[test]
    fn a_table_of_json_becomes_options() {
        let text = r#"{"size": 0.5, "growth": 0.2, "surface": "divide", "layers": ["2,0.1,1.5"], "repair": true,
            "seeds": [{"place": [0, 0, 0], "name": "core"}], "hole_edges": 9, "voids": true}"#;
        let words: MeshingWords = serde_json::from_str(text).unwrap();
        let options = words.options(&ball(), None).unwrap();
        assert_eq!(options.sizes, Sizes::of(Some(0.5), false, Some(0.2), None));
        assert_eq!((options.dividing, options.voids), (Dividing::Always, true));
        assert_eq!(options.layers.unwrap().everywhere, Some(Stack { count: 2, first: 0.1, growth: 1.5 }));
        let repairs = words.repairs().unwrap();
        assert_eq!((repairs.close_holes, repairs.keep_inward), (Some(9), true));
        assert_eq!(serde_json::to_value(&words).unwrap()["layers"][0], "2,0.1,1.5");
    }

    #[test]
    fn the_defaults_are_those_of_the_options() {
        let words = MeshingWords::default();
        let options = words.options(&ball(), None).unwrap();
        assert_eq!(format!("{options:?}"), format!("{:?}", Options::default()));
        assert!(words.repairs().is_none());
        assert_eq!(MeshingWords::NAMES.len(), 20);
    }

    #[test]
    fn a_size_is_a_number_or_auto() {
        assert_eq!(EdgeLength::of_text("auto").unwrap(), EdgeLength::Auto);
        assert_eq!(EdgeLength::of_text("0.3").unwrap(), EdgeLength::Length(0.3));
        for text in ["0", "-1", "nan", "inf", "", "Auto"] {
            let error = EdgeLength::of_text(text).unwrap_err().to_string();
            assert!(error.contains("or auto"), "{text}: {error}");
        }
    }

    #[test]
    fn layers_go_on_all_walls_or_on_patches() {
        let stack = Stack { count: 5, first: 0.02, growth: 1.2 };
        let read = |text: &str| WallLayers::of_text(text).unwrap();
        assert_eq!(read("5,0.02,1.2"), WallLayers { patch: None, stack });
        assert_eq!(read("a=b=5, 2e-2, 1.2"), WallLayers { patch: Some("a=b".into()), stack });
        assert_eq!(layers(&[], &[]).unwrap(), None);
        assert_eq!(layers(&["5,0.02,1.2"], &[]).unwrap().unwrap().everywhere, Some(stack));
        let one = layers(&["sphere=5,0.02,1.2"], &[]).unwrap().unwrap();
        assert_eq!((one.everywhere, one.by_patch.len()), (None, 1));
        assert_eq!(layers(&["5,0.02,1.2"], &["sphere"]).unwrap().unwrap(), one);
    }

    #[test]
    fn layers_that_contradict_each_other_are_refused() {
        for (all, on, part) in [
            (&["3,0.1,1", "2,0.1,1"][..], &[][..], "without a patch are given twice"),
            (&["sphere=3,0.1,1", "1=3,0.1,1"], &[], "on `1` are given twice"),
            (&["sphere=3,0.1,1"], &["sphere"], "there are none"),
            (&[], &["sphere"], "there are none"),
            (&["none=3,0.1,1"], &[], "no patch `none`"),
        ] {
            let error = layers(all, on).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn texts_that_are_no_layers_are_refused() {
        for (text, part) in [
            ("5,0.02", "3 numbers"),
            ("=5,0.02,1", "expected"),
            ("x,0.02,1", "`x`"),
            ("-1,0.02,1", "`-1`"),
            ("2.5,0.02,1", "`2.5`"),
            ("0,0.02,1", "1 to 200"),
            ("1000000,0.02,1", "1 to 200"),
            ("99999999999,0.02,1", "not a valid number of layers"),
            ("3,0,1", "above 0"),
            ("3,-1,1", "above 0"),
            ("3,nan,1", "finite"),
            ("3,0.1,0", "above 0"),
            ("3,0.1,-2", "above 0"),
            ("3,0.1,inf", "finite"),
            ("200,1e300,10", "too thick or thin to represent"),
            ("200,1,1e-9", "too thick or thin to represent"),
        ] {
            let error = WallLayers::of_text(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
