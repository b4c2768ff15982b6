//! Arguments of `motet mesh` for layers.

use motet::Error;
use motet::meshing::Surfaces;
use motet::meshing::layers::{Layers, Stack};

use crate::words::number;

/// A parsed `[PATCH=]N,FIRST,GROWTH`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayersArg {
    pub(crate) patch: Option<String>,
    pub(crate) stack: Stack,
}

pub(crate) fn layers(text: &str) -> Result<LayersArg, String> {
    // Split at the last equals sign, since numbers contain none and names might.
    let (patch, numbers) = match text.rsplit_once('=') {
        Some((patch, numbers)) if !patch.is_empty() => (Some(patch.to_string()), numbers),
        Some(_) => return Err("[PATCH=]N,FIRST,GROWTH is expected, such as wall=5,0.02,1.2".into()),
        None => (None, text),
    };
    let words: Vec<&str> = numbers.split(',').map(str::trim).collect();
    let [n, first, growth] = words[..] else {
        return Err(format!("N,FIRST,GROWTH has 3 numbers; got {}", words.len()));
    };
    let count = n.parse().map_err(|_| format!("`{n}` is not a valid number of layers"))?;
    let stack = Stack { count, first: number(first)?, growth: number(growth)? };
    stack.check().map_err(|error| error.to_string())?;
    Ok(LayersArg { patch, stack })
}

/// The layers that the arguments request; `None` where there are none.
///
/// # Errors
/// When a patch does not exist, or is given layers twice.
pub(super) fn stacks(
    words: &[LayersArg],
    on: &[String],
    keep_prisms: bool,
    surfaces: &Surfaces,
) -> motet::Result<Option<Layers>> {
    if words.is_empty() {
        return Ok(None);
    }
    let mut layers = Layers { keep_prisms, ..Layers::default() };
    let twice = |what: &str| Error::options(format!("layers {what} are given twice")).remedy("leave one out");
    for word in words.iter().filter(|word| word.patch.is_none()) {
        if layers.everywhere.replace(word.stack).is_some() {
            return Err(twice("without a patch"));
        }
    }
    let mut named: Vec<(&str, Stack)> =
        words.iter().filter_map(|word| Some((word.patch.as_deref()?, word.stack))).collect();
    if !on.is_empty() {
        let stack = layers.everywhere.take().ok_or_else(|| {
            Error::options("--layers-on without --layers").remedy("give --layers N,FIRST,GROWTH as well")
        })?;
        named.extend(on.iter().map(|patch| (patch.as_str(), stack)));
    }
    for (patch, stack) in named {
        if layers.by_patch.insert(surfaces.find_patch(patch)?, stack).is_some() {
            return Err(twice(&format!("on `{patch}`")));
        }
    }
    Ok(Some(layers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_read_with_and_without_a_patch() {
        let stack = Stack { count: 5, first: 0.02, growth: 1.2 };
        assert_eq!(layers("5,0.02,1.2"), Ok(LayersArg { patch: None, stack }));
        assert_eq!(layers("a=b=5, 2e-2, 1.2"), Ok(LayersArg { patch: Some("a=b".into()), stack }));
    }

    #[test]
    fn what_is_off_is_reported() {
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
            assert!(layers(text).is_err_and(|why| why.contains(part)), "{text}: {:?}", layers(text));
        }
    }
}
