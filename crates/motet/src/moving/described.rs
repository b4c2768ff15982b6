//! Options as text, by which a state knows that it is gone on with by the options it was saved with.

use std::collections::BTreeMap;

use crate::moving::options::Options;

/// So many differences are named.
const MOST: usize = 4;

impl Options {
    /// All that steps depend on, a line an option. How many changes are remembered is left out.
    pub(super) fn described(&self) -> String {
        format!("{:#?}", Self { remembered: 0, ..self.clone() })
    }
}

/// What differs, each by its name, what it was and what it is; empty where nothing does.
pub(super) fn differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (values(was), values(is));
    let names = was.keys().chain(is.keys().filter(|name| !was.contains_key(*name)));
    let differ = names.filter(|name| was.get(*name) != is.get(*name));
    let value =
        |of: &BTreeMap<String, String>, name: &str| of.get(name).map_or("nothing", String::as_str).to_owned();
    let told = differ.map(|name| format!("{name} was {} and is {}", value(&was, name), value(&is, name)));
    let mut told: Vec<String> = told.collect();
    let n = told.len();
    if n > MOST {
        told.truncate(MOST);
        told.push(format!("{} more", n - MOST));
    }
    told
}

/// Values by their names, those of structs within structs joined by dots; what has no name by its place.
fn values(text: &str) -> BTreeMap<String, String> {
    let (mut values, mut open) = (BTreeMap::new(), Vec::<(String, usize)>::new());
    for line in text.lines().map(str::trim) {
        if line.starts_with(['}', ')', ']']) {
            open.pop();
            continue;
        }
        let (name, value) = match line.split_once(": ") {
            Some((name, value)) => (name.to_owned(), value),
            None => (String::new(), line),
        };
        if value.ends_with(['{', '(', '[']) {
            open.push((name, 0));
            continue;
        }
        let place = open.last_mut().map_or(0, |(_, n)| std::mem::replace(n, *n + 1));
        let own = if name.is_empty() { place.to_string() } else { name };
        let path = open.iter().map(|(name, _)| name.as_str()).filter(|name| !name.is_empty());
        let path: Vec<&str> = path.chain([own.as_str()]).collect();
        values.insert(path.join("."), value.trim_end_matches(',').to_owned());
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_named_and_what_is_remembered_does_not_count() {
        let options = Options::default();
        let same = Options { remembered: 3, ..options.clone() };
        assert!(differences(&options.described(), &same.described()).is_empty());
        let mut other = Options { floor: 0.1, contents: vec!["dye".into()], ..options.clone() };
        other.motion.smoothing = 7;
        let told = differences(&options.described(), &other.described()).join("; ");
        assert!(told.contains("motion.smoothing was 0 and is 7"), "{told}");
        assert!(told.contains("floor was 0.05 and is 0.1"), "{told}");
        assert!(told.contains("contents") && told.contains("dye"), "{told}");
        let none = Options { repair: None, ..options.clone() };
        let told = differences(&options.described(), &none.described()).join("; ");
        assert!(told.contains("repair"), "{told}");
    }
}
