//! Criteria as texts, such as `0,0,0,1` for a ball: the syntax of files and of the command line.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Relation, Size, Target, non_negative,
    positive,
};
use crate::base::{Error, Result, suggestion};
use crate::refine::sizes::SizeLimits;

/// A criterion that a text states: complete, or without the surface that it measures from, which is a file.
#[derive(Clone, Debug)]
pub(in crate::refine) enum Stated {
    /// A complete criterion.
    Whole(Criterion),
    /// [`Criterion::Near`] of the surface in a file.
    Near { surface: PathBuf, within: f64 },
    /// [`Criterion::NearSize`] of the surface in a file.
    NearSize { surface: PathBuf, size: f64, growth: f64 },
}

/// Reads a criterion from a text.
type Reader = fn(&str) -> Result<Criterion>;

/// The words of criteria that need no file, each with what reads its texts.
const READERS: [(&str, Reader); 12] = [
    ("box", in_box),
    ("ball", ball),
    ("region", region),
    ("patch", patch),
    ("size", size),
    ("where", |text| text.parse().map(Criterion::Where)),
    ("gradient", |text| threshold(text, |array, above| Criterion::Gradient { array, above })),
    ("jump", |text| estimate(text, Estimator::Jump)),
    ("recovery", |text| estimate(text, Estimator::Recovery)),
    ("hessian", hessian),
    ("vorticity", |text| threshold(text, |array, above| Criterion::Vorticity { array, above })),
    ("q", |text| threshold(text, |array, above| Criterion::Q { array, above })),
];

impl Stated {
    /// What a text states for a word.
    ///
    /// # Errors
    /// When there is no such word, or the text does not have its syntax.
    pub(in crate::refine) fn of(word: &str, text: &str) -> Result<Self> {
        match word {
            "near" => near(text),
            "near_size" => near_size(text),
            _ => Criterion::of_text(word, text).map(Self::Whole),
        }
    }

    /// The file of the surface, if there is one.
    pub(in crate::refine) fn surface(&self) -> Option<&Path> {
        match self {
            Self::Whole(_) => None,
            Self::Near { surface, .. } | Self::NearSize { surface, .. } => Some(surface),
        }
    }

    /// The criterion, with the surface that `read` finds in its file.
    ///
    /// # Errors
    /// The errors of `read`.
    pub(in crate::refine) fn criterion(
        self,
        read: impl FnOnce(&Path) -> Result<Arc<Target>>,
    ) -> Result<Criterion> {
        Ok(match self {
            Self::Whole(criterion) => criterion,
            Self::Near { surface, within } => Criterion::Near { target: read(&surface)?, within },
            Self::NearSize { surface, size, growth } => {
                Criterion::NearSize { target: read(&surface)?, size, growth }
            }
        })
    }
}

impl Criterion {
    /// How much edge lengths grow per unit of distance from a surface, by default.
    pub const GROWTH: f64 = 0.5;

    /// The criterion that a text states for a word, such as `0,0,0,1` for `ball`. The words are those of
    /// [`RefineWords`](crate::refine::RefineWords), without those that name the file of a surface.
    ///
    /// # Errors
    /// When there is no such word, or the text does not have its syntax; the error says what is expected.
    pub fn of_text(word: &str, text: &str) -> Result<Self> {
        let Some((_, read)) = READERS.iter().find(|(known, _)| *known == word) else {
            return Err(Error::options(format!("there is no criterion `{word}` that a text alone states"))
                .remedy(suggestion(word, READERS.iter().map(|(known, _)| *known))));
        };
        let criterion = read(text)?;
        criterion.check()?;
        Ok(criterion)
    }
}

fn near(text: &str) -> Result<Stated> {
    let (surface, within) = named(text, "SURFACE=DISTANCE, such as stent.stl=0.2")?;
    let within = number(within)?;
    non_negative("the distance from a surface", within)?;
    Ok(Stated::Near { surface: surface.into(), within })
}

fn near_size(text: &str) -> Result<Stated> {
    let syntax = "SURFACE=H[,GROWTH], such as stent.stl=0.05,0.3";
    let (surface, rest) = named(text, syntax)?;
    let (size, growth) = match numbers(rest)?[..] {
        [size] => (size, Criterion::GROWTH),
        [size, growth] => (size, growth),
        _ => return Err(expected(syntax, text)),
    };
    positive("the size at a surface", size)?;
    non_negative("the growth of sizes", growth)?;
    Ok(Stated::NearSize { surface: surface.into(), size, growth })
}

fn ball(text: &str) -> Result<Criterion> {
    match numbers(text)?[..] {
        [x, y, z, radius] => Ok(Criterion::Ball { centre: [x, y, z], radius }),
        ref other => Err(Error::options(format!("X,Y,Z,R has 4 numbers; got {}", other.len()))),
    }
}

fn in_box(text: &str) -> Result<Criterion> {
    let numbers = numbers(text)?;
    match numbers.as_chunks::<3>() {
        ([low, high], []) => Ok(Criterion::Box([*low, *high])),
        _ => Err(Error::options(format!("X0,Y0,Z0,X1,Y1,Z1 has 6 numbers; got {}", numbers.len()))),
    }
}

fn region(text: &str) -> Result<Criterion> {
    match text {
        "" => Err(expected("the name or number of a region", text)),
        _ => Ok(Criterion::Region(text.into())),
    }
}

/// Reads `PATCH` or `PATCH=DISTANCE`; if what follows the last `=` is not a number, it is part of the name.
fn patch(text: &str) -> Result<Criterion> {
    let syntax = "PATCH or PATCH=DISTANCE";
    let (patch, within) = match named(text, syntax).map(|(name, rest)| (name, number(rest))) {
        Ok((name, Ok(within))) => (name, Some(within)),
        _ if text.is_empty() => return Err(expected(syntax, text)),
        _ => (text, None),
    };
    Ok(Criterion::Patch { patch: patch.into(), within })
}

fn size(text: &str) -> Result<Criterion> {
    match number(text) {
        Ok(h) => Ok(Criterion::Size(Size::Uniform(h))),
        Err(_) if text.is_empty() || text.trim().parse::<f64>().is_ok() => {
            Err(expected("a number above 0, or the name of an array", text))
        }
        Err(_) => Ok(Criterion::Size(Size::Array(text.into()))),
    }
}

/// Reads `ARRAY>VALUE`.
fn threshold(text: &str, criterion: fn(String, f64) -> Criterion) -> Result<Criterion> {
    match text.parse() {
        Ok(Condition { array, relation: Relation::Above, value }) => Ok(criterion(array, value)),
        _ => Err(expected("ARRAY>VALUE, such as velocity>50", text)),
    }
}

fn estimate(text: &str, by: Estimator) -> Result<Criterion> {
    let (array, amount) = named(text, "ARRAY=SHARE or ARRAY=Ntets, such as p=0.5 or p=200000tets")?;
    let amount = match tets(amount)? {
        Some(n) => Amount::Tets(n),
        None => Amount::Share(number(amount)?),
    };
    Ok(Criterion::Estimate { array: array.into(), by, amount })
}

/// Reads `ARRAY[,ARRAY]=ERROR`, `=P%` or `=Ntets`.
fn hessian(text: &str) -> Result<Criterion> {
    let syntax = "ARRAY[,ARRAY]=ERROR, =P% or =Ntets, such as p,velocity=2%";
    let (arrays, aim) = named(text, syntax)?;
    let aim = match (tets(aim)?, aim.strip_suffix('%')) {
        (Some(n), _) => Aim::Tets(n),
        (None, Some(percent)) => Aim::RangePart(number(percent)? / 100.0),
        (None, None) => Aim::Error(number(aim)?),
    };
    let arrays: Vec<String> = arrays.split(',').map(|array| array.trim().to_owned()).collect();
    match arrays.iter().any(String::is_empty) {
        true => Err(expected(syntax, text)),
        false => Ok(Criterion::Hessian(HessianSizes { arrays, aim, limits: SizeLimits::default() })),
    }
}

/// Reads `Ntets`; `None` for text without this ending.
fn tets(text: &str) -> Result<Option<usize>> {
    let Some(n) = text.strip_suffix("tets") else { return Ok(None) };
    match n.trim().parse() {
        Ok(n) if n > 0 => Ok(Some(n)),
        _ => Err(expected("a number of tets, such as 200000tets", text)),
    }
}

/// Splits `NAME=rest` at the last `=`: numbers contain none, names might.
fn named<'a>(text: &'a str, syntax: &str) -> Result<(&'a str, &'a str)> {
    let parts = text.rsplit_once('=').filter(|(name, _)| !name.is_empty());
    parts.ok_or_else(|| expected(syntax, text))
}

/// Reads numbers between commas, semicolons or white space.
fn numbers(text: &str) -> Result<Vec<f64>> {
    let is_between = |c: char| c == ',' || c == ';' || c.is_ascii_whitespace();
    text.split(is_between).filter(|word| !word.is_empty()).map(number).collect()
}

fn number(text: &str) -> Result<f64> {
    let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| Error::options(format!("`{text}` is not a finite number")))
}

fn expected(what: &str, text: &str) -> Error {
    Error::options(format!("expected {what}; got `{text}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn word(word: &str, text: &str) -> String {
        format!("{:?}", Stated::of(word, text).unwrap())
    }

    #[test]
    fn texts_state_criteria() {
        assert!(word("near", "a=b.stl=0.2").contains(r#"Near { surface: "a=b.stl", within: 0.2 }"#));
        assert!(word("near_size", "a.stl=0.05").contains("size: 0.05, growth: 0.5"));
        assert!(word("near_size", "a.stl=0.05,0").contains("size: 0.05, growth: 0.0"));
        assert!(word("ball", "1,-2,3,0.5").contains("centre: [1.0, -2.0, 3.0], radius: 0.5"));
        assert!(word("box", "0,0,0,1,2,3").contains("[[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]"));
        assert!(word("region", "fluid").contains(r#"Region("fluid")"#));
        assert!(word("patch", "wall").contains(r#"patch: "wall", within: None"#));
        assert!(word("patch", "wall=0.3").contains(r#"patch: "wall", within: Some(0.3)"#));
        assert!(word("patch", "a=b").contains(r#"patch: "a=b", within: None"#));
        assert!(word("size", "0.3").contains("Uniform(0.3)"));
        assert!(word("size", "h").contains(r#"Array("h")"#));
        assert!(word("where", "p<=3").contains(r#"array: "p", relation: AtMost, value: 3.0"#));
        assert!(word("gradient", "p>3").contains(r#"Gradient { array: "p", above: 3.0 }"#));
        assert!(word("jump", "p=0.5").contains("by: Jump, amount: Share(0.5)"));
        assert!(word("recovery", "v:x=20000tets").contains("by: Recovery, amount: Tets(20000)"));
        assert!(word("hessian", "p, v=0.5").contains(r#"arrays: ["p", "v"], aim: Error(0.5)"#));
        assert!(word("hessian", "p=2%").contains("aim: RangePart(0.02)"));
        assert!(word("hessian", "p=500000tets").contains("aim: Tets(500000)"));
        assert!(word("vorticity", "v>2").contains(r#"Vorticity { array: "v", above: 2.0 }"#));
        assert!(word("q", "velocity>1e3").contains(r#"Q { array: "velocity", above: 1000.0 }"#));
    }

    #[test]
    fn what_is_off_is_reported() {
        let refused = |word: &str, text: &str| Stated::of(word, text).unwrap_err().to_string();
        for (word, text, said) in [
            ("near", "stent.stl", "SURFACE=DISTANCE"),
            ("near", "stent.stl=-1", "0 or more"),
            ("near_size", "a=1,2,3", "GROWTH"),
            ("near_size", "a=0", "above 0"),
            ("near_size", "a=1,-1", "0 or more"),
            ("ball", "1,2,3", "4 numbers; got 3"),
            ("ball", "1,2,3,-1", "radius"),
            ("box", "0,0,0,1,1", "6 numbers; got 5"),
            ("box", "0,0,0,1,1,-1", "lowest corner first"),
            ("region", "", "region"),
            ("patch", "", "PATCH"),
            ("patch", "wall=-1", "0 or more"),
            ("jump", "p=1.5", "at most 1"),
            ("jump", "p=0tets", "number of tets"),
            ("vorticity", "v<3", "ARRAY>VALUE"),
            ("gradient", "v", "ARRAY>VALUE"),
            ("where", "p", "ARRAY>VALUE"),
            ("regoin", "a", "did you mean `region`?"),
        ] {
            assert!(refused(word, text).contains(said), "{word} {text}: {}", refused(word, text));
        }
        for text in ["0", "-1", "nan", "inf", ""] {
            assert!(refused("size", text).contains("above 0"), "{text}");
        }
        for text in ["p", "p=", "p=0", "p=-2%", "p=0%", "p=200%", ",p=1", "p=xtets"] {
            refused("hessian", text);
        }
    }
}
