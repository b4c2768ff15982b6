//! How gaps are measured, in words, with rooms by name: what files, Python and other callers give.

use super::body::{Body, Room};
use super::options::Options;
use crate::base::{Error, Result, suggestion};
use crate::words;

words! {
    /// How gaps between surfaces are measured, and what counts as one.
    pub struct GapWords {
        /// Gaps below this distance are reported as warnings, in the unit of the mesh.
        warn: Option<f64> = Options::default().warn,
        /// Gaps are measured up to this distance. By default however large they are; those of a surface with
        /// itself up to four times `warn`, or a tenth of the size of all surfaces.
        within: Option<f64> = None,
        /// Gaps of each surface with itself are measured, too, neighbours left out.
        own: bool = Options::default().own,
        /// Only places count that face each other through free space, not through the thickness of a body.
        facing: bool = Options::default().facing,
        /// Within one surface, and between surfaces that share vertices, places count as a gap where the way
        /// along the surface is at least this many times as long as the way across.
        fold: f64 = Options::default().fold,
    }
}

impl GapWords {
    /// The options that these words determine.
    pub fn options(&self) -> Options {
        Options {
            warn: self.warn,
            own: self.own,
            within: self.within.unwrap_or(Options::default().within),
            facing: self.facing,
            fold: self.fold,
        }
    }
}

/// Makes the bodies of these names rooms, and no others.
///
/// # Errors
/// If there is no body of a name; the error names the nearest, or all.
pub fn set_rooms(bodies: &mut [Body], names: &[String]) -> Result<()> {
    for name in names {
        if bodies.iter().all(|body| body.name != *name) {
            return Err(Error::options(format!("there is no surface `{name}` that could be a room"))
                .remedy(suggestion(name, bodies.iter().map(|body| body.name.as_str()))));
        }
    }
    for body in bodies {
        body.room = if names.contains(&body.name) { Room::Yes } else { Room::No };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_those_of_the_options() {
        assert_eq!(GapWords::default().options(), Options::default());
        let words: GapWords = serde_json::from_str(r#"{"within": 2, "own": true}"#).unwrap();
        assert_eq!(words.options(), Options { within: 2.0, own: true, ..Options::default() });
    }

    #[test]
    fn rooms_have_the_given_names_and_all_others_are_none() {
        let body = |name: &str| Body { name: name.to_owned(), ..Body::default() };
        let mut bodies = [body("stent"), body("vessel")];
        set_rooms(&mut bodies, &["vessel".to_owned()]).unwrap();
        assert_eq!(bodies.each_ref().map(|body| &body.room), [&Room::No, &Room::Yes]);
        set_rooms(&mut bodies, &[]).unwrap();
        assert_eq!(bodies.each_ref().map(|body| &body.room), [&Room::No, &Room::No]);
        let error = set_rooms(&mut bodies, &["vesel".to_owned()]).unwrap_err();
        assert!(error.to_string().contains("did you mean `vessel`?"), "{error}");
    }
}
