//! Conditions on arrays: `p>3`, `|velocity|>=0.5`, `velocity:z<0`, `region!=2`.

use std::fmt;
use std::str::FromStr;

use super::array::{On, column};
use crate::base::{Error, Result};
use crate::mesh::{Mesh, TetPart};

/// How a value is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `>`
    Above,
    /// `>=`
    AtLeast,
    /// `<`
    Below,
    /// `<=`
    AtMost,
    /// `==`
    Equal,
    /// `!=`
    Unequal,
}

const RELATIONS: [(&str, Relation); 6] = [
    (">", Relation::Above),
    (">=", Relation::AtLeast),
    ("<", Relation::Below),
    ("<=", Relation::AtMost),
    ("==", Relation::Equal),
    ("!=", Relation::Unequal),
];

impl Relation {
    /// Compares a value with another. NaN never satisfies a relation.
    pub fn holds(self, value: f64, than: f64) -> bool {
        match self {
            Self::Above => value > than,
            Self::AtLeast => value >= than,
            Self::Below => value < than,
            Self::AtMost => value <= than,
            Self::Equal => value == than,
            Self::Unequal => !value.is_nan() && value != than,
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (text, _) = RELATIONS.iter().find(|(_, relation)| relation == self).unwrap_or(&RELATIONS[0]);
        f.write_str(text)
    }
}

/// A condition on the values of an array on points or cells.
///
/// ```
/// use motet::refine::Condition;
/// let condition: Condition = "velocity:x >= 0.5".parse().unwrap();
/// assert_eq!((condition.array.as_str(), condition.value), ("velocity:x", 0.5));
/// assert_eq!(condition.to_string(), "velocity:x>=0.5");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// The array, or a part of it: `p`, `|v|`, `v:x`, `v[3]`. Vectors count by their length.
    pub array: String,
    /// How its values are compared.
    pub relation: Relation,
    /// The value they are compared with, in the units of the array.
    pub value: f64,
}

impl FromStr for Condition {
    type Err = Error;

    /// Parses `ARRAY>VALUE`, with any of `> >= < <= == !=`; the last relation in the text counts.
    fn from_str(text: &str) -> Result<Self> {
        let expected = || {
            Error::options(format!("`{text}` is not a condition"))
                .remedy("ARRAY>VALUE is expected, such as p>100, with one of > >= < <= == !=")
        };
        let is_sign = |c: char| "<>=!".contains(c);
        let end = text.rfind(is_sign).ok_or_else(expected)? + 1;
        let array = text[..end].trim_end_matches(is_sign);
        let sign = &text[array.len()..end];
        let (_, relation) = RELATIONS.iter().find(|(known, _)| *known == sign).ok_or_else(expected)?;
        let value: f64 = text[end..].trim().parse().map_err(|_| expected())?;
        let condition = Self { array: array.trim().to_owned(), relation: *relation, value };
        if condition.array.is_empty() { Err(expected()) } else { condition.check().map(|()| condition) }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}{}", self.array, self.relation, self.value)
    }
}

impl Condition {
    /// Checks that the value compared with is finite.
    ///
    /// # Errors
    /// When it is not.
    pub fn check(&self) -> Result<()> {
        match self.value.is_finite() {
            true => Ok(()),
            false => {
                Err(Error::options(format!("`{self}` is not a valid condition: its value is not finite")))
            }
        }
    }

    /// Returns for each tet of `mesh` whether the condition holds: for a cell array, for the value of the
    /// tet; for a point array, at one or more vertices.
    ///
    /// # Errors
    /// When there is no such array, or no such component of it.
    pub fn of_tets(&self, mesh: &Mesh, part: &TetPart) -> Result<Vec<bool>> {
        self.check()?;
        let column = column(mesh, &self.array)?;
        let holds = |row: usize| self.relation.holds(column.values[row], self.value);
        Ok(match column.on {
            On::Cells => part.tet_to_cell.iter().map(|cell| holds(cell.index())).collect(),
            On::Points => part.mesh.tets.iter().map(|tet| tet.iter().any(|v| holds(v.index()))).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_read_as_they_are_written() {
        let read = |text: &str| text.parse::<Condition>().unwrap();
        for (text, array, relation, value) in [
            ("p>3", "p", Relation::Above, 3.0),
            (" wall shear <= -2.5e-3 ", "wall shear", Relation::AtMost, -2.5e-3),
            ("|v|>=.5", "|v|", Relation::AtLeast, 0.5),
            ("a->b!=0", "a->b", Relation::Unequal, 0.0),
            ("v[0] == 1", "v[0]", Relation::Equal, 1.0),
            ("x<y<7", "x<y", Relation::Below, 7.0),
        ] {
            assert_eq!(read(text), Condition { array: array.into(), relation, value }, "{text}");
            assert_eq!(read(&read(text).to_string()), read(text));
        }
    }

    #[test]
    fn what_is_no_condition_is_reported() {
        for text in ["p", "p>", ">3", "p>x", "p=3", "p=>3", "p<>3", "", "p>3>"] {
            let error = text.parse::<Condition>().unwrap_err().to_string();
            assert!(error.contains("ARRAY>VALUE"), "{text}: {error}");
        }
        for text in ["p>nan", "p<inf"] {
            assert!(
                text.parse::<Condition>().unwrap_err().to_string().contains("its value is not finite"),
                "{text}"
            );
        }
    }

    #[test]
    fn no_number_is_so() {
        assert!(RELATIONS.iter().all(|(_, relation)| !relation.holds(f64::NAN, 0.0)));
    }
}
