//! Titles of arrays and of columns of logs: plain words, with the unit where it is known.

use crate::arrays::Key;

/// What the quality of tets is called.
pub(crate) const EAS_TITLE: &str = "EAS (quality of a tet)";
/// The unit of lengths.
const LENGTH: &str = "in units of the mesh";

/// What arrays and columns that motet writes are called, with their unit.
const KNOWN: [(&str, &str, &str); 14] = [
    (crate::arrays::EAS, EAS_TITLE, ""),
    ("gap", "gap to the nearest other body", LENGTH),
    ("least_gap", "least gap between bodies", LENGTH),
    ("least", "least gap between bodies", LENGTH),
    ("displacement", "displacement", LENGTH),
    ("velocity", "velocity", "in units of the mesh per unit of time"),
    ("time_to_contact", "time until contact", "in units of time"),
    ("worst_eas", "worst EAS (quality of a tet)", ""),
    ("worst_eas.value", "worst EAS (quality of a tet)", ""),
    ("bad", "number of bad tets", ""),
    ("inverted", "number of inverted tets", ""),
    ("tets", "number of tets", ""),
    ("points", "number of points", ""),
    ("admissible_fraction", "fraction of the motion that was admissible", ""),
];

/// The title of an array, and its unit where it is known.
pub(crate) fn title_and_unit(key: &Key) -> (String, Option<&'static str>) {
    let (title, unit) = known(&key.name);
    (if key.is_vector { format!("length of {title}") } else { title.to_owned() }, unit)
}

/// The title of a column by its name, with its unit; a name that is not known is its own title.
pub(crate) fn title_of(name: &str) -> String {
    let (title, unit) = known(name);
    unit.map_or_else(|| title.to_owned(), |unit| format!("{title}, {unit}"))
}

fn known(name: &str) -> (&str, Option<&'static str>) {
    let entry = KNOWN.iter().find(|(known, ..)| *known == name);
    entry.map_or((name, None), |(_, title, unit)| (title, Some(*unit).filter(|unit| !unit.is_empty())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::Place;

    #[test]
    fn known_arrays_have_words_and_units_others_their_names() {
        let of = |name: &str, is_vector| {
            title_and_unit(&Key { name: name.to_owned(), on: Place::Point, is_label: false, is_vector })
        };
        assert_eq!(of(crate::arrays::EAS, false), ("EAS (quality of a tet)".to_owned(), None));
        assert_eq!(of("pressure [Pa]", false), ("pressure [Pa]".to_owned(), None));
        assert_eq!(of("displacement", true), ("length of displacement".to_owned(), Some(LENGTH)));
        assert_eq!(title_of("gap"), "gap to the nearest other body, in units of the mesh");
        assert_eq!(title_of("anything"), "anything");
    }
}
