//! Arguments of `motet refine`: the syntax and meaning of each.

use std::path::PathBuf;

use motet::refine::sizes::SizeLimits;
use motet::refine::{Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Relation, Size};

use crate::words::{named, number, numbers, positive};

/// A parsed `SURFACE=DISTANCE`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Near {
    pub(crate) surface: PathBuf,
    pub(crate) within: f64,
}

/// A parsed `SURFACE=H[,GROWTH]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NearSize {
    pub(crate) surface: PathBuf,
    pub(crate) size: f64,
    pub(crate) growth: f64,
}

/// How much edge lengths grow per unit of distance from a surface, by default.
const GROWTH: f64 = 0.5;

pub(crate) fn near(text: &str) -> Result<Near, String> {
    let (surface, within) = named(text, "SURFACE=DISTANCE, such as stent.stl=0.2,")?;
    match number(within)? {
        within if within >= 0.0 => Ok(Near { surface: surface.into(), within }),
        within => Err(format!("the distance must be 0 or more; got {within}")),
    }
}

pub(crate) fn near_size(text: &str) -> Result<NearSize, String> {
    let expected = "SURFACE=H[,GROWTH], such as stent.stl=0.05,0.3,";
    let (surface, rest) = named(text, expected)?;
    let (size, growth) = match numbers(rest)?[..] {
        [size] => (size, GROWTH),
        [size, growth] => (size, growth),
        _ => return Err(format!("{expected} is expected")),
    };
    match size > 0.0 && growth >= 0.0 {
        true => Ok(NearSize { surface: surface.into(), size, growth }),
        false => Err("a size above 0 and a growth of 0 or more are expected".into()),
    }
}

pub(crate) fn ball(text: &str) -> Result<Criterion, String> {
    match numbers(text)?[..] {
        [x, y, z, radius] => checked(Criterion::Ball { centre: [x, y, z], radius }),
        ref other => Err(format!("X,Y,Z,R has 4 numbers; got {}", other.len())),
    }
}

pub(crate) fn in_box(text: &str) -> Result<Criterion, String> {
    match numbers(text)?.as_chunks::<3>() {
        ([low, high], []) => checked(Criterion::Box([*low, *high])),
        (all, rest) => Err(format!("X0,Y0,Z0,X1,Y1,Z1 has 6 numbers; got {}", 3 * all.len() + rest.len())),
    }
}

pub(crate) fn region(text: &str) -> Result<Criterion, String> {
    match text {
        "" => Err("the name or number of a region is expected".into()),
        _ => Ok(Criterion::Region(text.into())),
    }
}

/// Parses `PATCH` or `PATCH=DISTANCE`; if what follows the last `=` is not a number, it is part of the name.
pub(crate) fn patch(text: &str) -> Result<Criterion, String> {
    let example = "PATCH or PATCH=DISTANCE";
    let (patch, within) = match named(text, example).map(|(name, rest)| (name, number(rest))) {
        Ok((name, Ok(within))) => (name, Some(within)),
        _ if text.is_empty() => return Err(format!("{example} is expected")),
        _ => (text, None),
    };
    checked(Criterion::Patch { patch: patch.into(), within })
}

pub(crate) fn size(text: &str) -> Result<Criterion, String> {
    match number(text) {
        Ok(h) => checked(Criterion::Size(Size::Uniform(h))),
        Err(_) if text.is_empty() || text.trim().parse::<f64>().is_ok() => {
            Err("a number above 0 is expected, or the name of an array".into())
        }
        Err(_) => Ok(Criterion::Size(Size::Array(text.into()))),
    }
}

pub(crate) fn condition(text: &str) -> Result<Condition, String> {
    text.parse().map_err(|e: motet::Error| e.to_string())
}

pub(crate) fn gradient(text: &str) -> Result<Criterion, String> {
    let (array, above) = threshold(text)?;
    Ok(Criterion::Gradient { array, above })
}

pub(crate) fn vorticity(text: &str) -> Result<Criterion, String> {
    let (array, above) = threshold(text)?;
    Ok(Criterion::Vorticity { array, above })
}

pub(crate) fn q(text: &str) -> Result<Criterion, String> {
    let (array, above) = threshold(text)?;
    Ok(Criterion::Q { array, above })
}

/// Parses `ARRAY>VALUE`.
fn threshold(text: &str) -> Result<(String, f64), String> {
    match condition(text) {
        Ok(Condition { array, relation: Relation::Above, value }) => Ok((array, value)),
        _ => Err("ARRAY>VALUE is expected, such as velocity>50".into()),
    }
}

pub(crate) fn jump(text: &str) -> Result<Criterion, String> {
    estimate(text, Estimator::Jump)
}

pub(crate) fn recovery(text: &str) -> Result<Criterion, String> {
    estimate(text, Estimator::Recovery)
}

fn estimate(text: &str, by: Estimator) -> Result<Criterion, String> {
    let (array, amount) = named(text, "ARRAY=SHARE or ARRAY=Ntets, such as p=0.5 or p=200000tets,")?;
    let amount = match tets(amount)? {
        Some(n) => Amount::Tets(n),
        None => Amount::Share(number(amount)?),
    };
    checked(Criterion::Estimate { array: array.into(), by, amount })
}

/// Parses `ARRAY[,ARRAY]=ERROR`, `=P%` or `=Ntets`.
pub(crate) fn hessian(text: &str) -> Result<HessianSizes, String> {
    let expected = "ARRAY[,ARRAY]=ERROR, =P% or =Ntets, such as p,velocity=2%,";
    let (arrays, aim) = named(text, expected)?;
    let aim = match (tets(aim)?, aim.strip_suffix('%')) {
        (Some(n), _) => Aim::Tets(n),
        (None, Some(percent)) => Aim::RangePart(positive(percent)? / 100.0),
        (None, None) => Aim::Error(positive(aim)?),
    };
    let arrays: Vec<String> = arrays.split(',').map(|array| array.trim().to_owned()).collect();
    if arrays.iter().any(String::is_empty) {
        return Err(format!("{expected} is expected"));
    }
    let sizes = HessianSizes { arrays, aim, limits: SizeLimits::default() };
    checked(Criterion::Hessian(sizes.clone())).map(|_| sizes)
}

/// Parses `Ntets`; `None` for text without this ending.
fn tets(text: &str) -> Result<Option<usize>, String> {
    let Some(n) = text.strip_suffix("tets") else { return Ok(None) };
    match n.trim().parse() {
        Ok(n) if n > 0 => Ok(Some(n)),
        _ => Err(format!("`{text}`: a number of tets is expected, such as 200000tets")),
    }
}

fn checked(criterion: Criterion) -> Result<Criterion, String> {
    match criterion.check() {
        Ok(()) => Ok(criterion),
        Err(error) => Err(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_what_the_help_says() {
        assert_eq!(near("a=b.stl=0.2").unwrap(), Near { surface: "a=b.stl".into(), within: 0.2 });
        let sized = near_size("stent.stl=0.05").unwrap();
        assert_eq!((sized.size, sized.growth), (0.05, GROWTH));
        assert_eq!(near_size("stent.stl=0.05,0").unwrap().growth, 0.0);
        let word = |criterion: Result<Criterion, String>| format!("{:?}", criterion.unwrap());
        assert!(word(ball("1,-2,3,0.5")).contains("centre: [1.0, -2.0, 3.0], radius: 0.5"));
        assert!(word(in_box("0,0,0,1,2,3")).contains("[[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]"));
        assert!(word(patch("wall")).contains(r#"patch: "wall", within: None"#));
        assert!(word(patch("wall=0.3")).contains(r#"patch: "wall", within: Some(0.3)"#));
        assert!(word(patch("a=b")).contains(r#"patch: "a=b", within: None"#));
        assert!(word(size("0.3")).contains("Uniform(0.3)"));
        assert!(word(size("h")).contains(r#"Array("h")"#));
        assert!(word(jump("p=0.5")).contains("by: Jump, amount: Share(0.5)"));
        assert!(word(recovery("v:x=20000tets")).contains("by: Recovery, amount: Tets(20000)"));
        assert!(word(q("velocity>1e3")).contains(r#"array: "velocity", above: 1000.0"#));
        assert_eq!(hessian("p, v=0.5").unwrap().arrays, ["p", "v"]);
        assert_eq!(hessian("p=0.5").unwrap().aim, Aim::Error(0.5));
        assert_eq!(hessian("p=2%").unwrap().aim, Aim::RangePart(0.02));
        assert_eq!(hessian("p=500000tets").unwrap().aim, Aim::Tets(500_000));
        assert_eq!(condition("p<=3").unwrap().to_string(), "p<=3");
    }

    #[test]
    fn what_is_off_is_reported() {
        let refusal = |criterion: Result<Criterion, String>| criterion.unwrap_err();
        assert!(near("stent.stl").unwrap_err().contains("SURFACE=DISTANCE"));
        assert!(near("stent.stl=-1").unwrap_err().contains("0 or more"));
        assert!(near_size("a=1,2,3").unwrap_err().contains("GROWTH"));
        assert!(near_size("a=0").is_err() && near_size("a=1,-1").is_err());
        assert!(refusal(ball("1,2,3")).contains("4 numbers; got 3"));
        assert!(refusal(ball("1,2,3,-1")).contains("radius"));
        assert!(refusal(in_box("0,0,0,1,1")).contains("6 numbers; got 5"));
        assert!(refusal(in_box("0,0,0,1,1,-1")).contains("lowest corner first"));
        assert!(region("").is_err() && patch("").is_err());
        assert!(refusal(patch("wall=-1")).contains("0 or more"));
        for text in ["0", "-1", "nan", "inf", ""] {
            assert!(refusal(size(text)).contains("above 0"), "{text}");
        }
        assert!(refusal(jump("p=1.5")).contains("at most 1"));
        assert!(refusal(jump("p=0tets")).contains("number of tets"));
        assert!(refusal(vorticity("v<3")).contains("ARRAY>VALUE"));
        assert!(refusal(gradient("v")).contains("ARRAY>VALUE"));
        for text in ["p", "p=", "p=0", "p=0%", "p=200%", ",p=1", "p=xtets"] {
            assert!(hessian(text).is_err(), "{text}");
        }
        assert!(condition("p").is_err());
    }
}
