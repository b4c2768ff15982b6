//! Arguments of `motet move`: the syntax and meaning of each.

use std::path::PathBuf;

use motet::base::Point;
use motet::motion::Extent;

use crate::words::{named, numbers};

/// A parsed `PATCH=dx,dy,dz`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Translate {
    pub(crate) patch: String,
    pub(crate) by: Point,
}

/// A parsed `PATCH=ax,ay,az,deg[,cx,cy,cz]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rotate {
    pub(crate) patch: String,
    pub(crate) axis: Point,
    pub(crate) degrees: f64,
    pub(crate) centre: Option<Point>,
}

/// A parsed `NAME=FILE`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatchFile {
    pub(crate) name: String,
    pub(crate) file: PathBuf,
}

pub(crate) fn translate(text: &str) -> Result<Translate, String> {
    let (patch, numbers) = patch_and_numbers(text)?;
    match numbers[..] {
        [x, y, z] => Ok(Translate { patch, by: [x, y, z] }),
        _ => Err(format!("PATCH=dx,dy,dz has 3 numbers; got {}", numbers.len())),
    }
}

pub(crate) fn rotate(text: &str) -> Result<Rotate, String> {
    let (patch, numbers) = patch_and_numbers(text)?;
    let (axis, degrees, centre) = match numbers[..] {
        [x, y, z, degrees] => ([x, y, z], degrees, None),
        [x, y, z, degrees, a, b, c] => ([x, y, z], degrees, Some([a, b, c])),
        _ => return Err(format!("PATCH=ax,ay,az,deg[,cx,cy,cz] has 4 or 7 numbers; got {}", numbers.len())),
    };
    if axis == [0.0; 3] {
        return Err("the axis 0,0,0 points nowhere".into());
    }
    Ok(Rotate { patch, axis, degrees, centre })
}

pub(crate) fn affine(text: &str) -> Result<[[f64; 4]; 3], String> {
    let numbers = numbers(text)?;
    match numbers.as_chunks::<4>() {
        ([a, b, c], []) => Ok([*a, *b, *c]),
        _ => Err(format!("a 3x4 matrix has 12 numbers, row by row; got {}", numbers.len())),
    }
}

pub(crate) fn patch_file(text: &str) -> Result<PatchFile, String> {
    match text.split_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => {
            Ok(PatchFile { name: name.into(), file: file.into() })
        }
        _ => Err("NAME=FILE is expected, such as wall=lumen_wall.vtp".into()),
    }
}

/// Parses the thickness of the layer that moves rigidly with the wall: a distance, or layers of cells such as
/// `3layers`.
pub(crate) fn layer(text: &str) -> Result<Extent, String> {
    Extent::of_text(text).map_err(|e| e.what().to_owned())
}

fn patch_and_numbers(text: &str) -> Result<(String, Vec<f64>), String> {
    let (patch, rest) = named(text, "PATCH=numbers, such as wall=0,0,0.5,")?;
    Ok((patch.into(), numbers(rest)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_what_the_help_says() {
        let shift = translate("wall=1,-2.5,3e-2").unwrap();
        assert_eq!(shift, Translate { patch: "wall".into(), by: [1.0, -2.5, 0.03] });
        let turn = rotate("a=b=0,0,1,90,1,2,3").unwrap();
        assert_eq!((turn.patch.as_str(), turn.centre), ("a=b", Some([1.0, 2.0, 3.0])));
        assert_eq!(rotate("a=0,0,1,90").unwrap().centre, None);
        assert_eq!(affine("1 0 0 5; 0 1 0 6; 0 0 1 7").unwrap()[1], [0.0, 1.0, 0.0, 6.0]);
        assert_eq!(layer("0.25").unwrap(), Extent::Distance(0.25));
        assert_eq!(layer("3layers").unwrap(), Extent::Cells(3));
        assert_eq!(layer("1layer").unwrap(), Extent::Cells(1));
    }

    #[test]
    fn what_is_off_is_reported() {
        for (text, part) in
            [("wall", "PATCH="), ("wall=1,2", "3 numbers"), ("wall=1,2,x", "`x`"), ("w=1,2,nan", "finite")]
        {
            assert!(translate(text).unwrap_err().contains(part), "{text}");
        }
        assert!(rotate("a=0,0,0,9").unwrap_err().contains("nowhere"));
        assert!(affine("1,2,3").unwrap_err().contains("12 numbers"));
        assert!(layer("0").is_err() && layer("-1").is_err() && layer("0layers").is_err());
        assert!(patch_file("wall").is_err() && patch_file("=x").is_err());
    }
}
