//! Arguments of `motet mesh`: the syntax and meaning of each.

use motet::base::Point;
use motet::meshing::Seed;

use crate::words::numbers;

/// Parses `X,Y,Z`.
pub(super) fn place(text: &str) -> Result<Point, String> {
    let numbers = numbers(text)?;
    <[f64; 3]>::try_from(numbers).map_err(|other| format!("X,Y,Z has 3 numbers; got {}", other.len()))
}

/// Parses `X,Y,Z=NAME`, split at the first `=`, since numbers contain none.
pub(super) fn seed(text: &str) -> Result<Seed, String> {
    match text.split_once('=') {
        Some((at, name)) if !name.trim().is_empty() => {
            Ok(Seed { place: place(at)?, name: name.trim().to_owned() })
        }
        _ => Err("X,Y,Z=NAME, such as 0,0,12.5=lumen, is expected".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_what_the_help_says() {
        assert_eq!(place("-1,2.5,3e-1"), Ok([-1.0, 2.5, 0.3]));
        let parsed = seed("0,0,1=the=lumen").unwrap();
        assert_eq!((parsed.place, parsed.name.as_str()), ([0.0, 0.0, 1.0], "the=lumen"));
    }

    #[test]
    fn what_is_off_is_reported() {
        assert!(place("1,2").unwrap_err().contains("3 numbers; got 2"));
        assert!(place("1,2,x").unwrap_err().contains("`x`"));
        for text in ["1,2,3", "1,2,3=", "1,2=a", "=a", ""] {
            assert!(seed(text).is_err(), "{text}");
        }
    }
}
