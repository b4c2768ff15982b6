//! A named array on points, on cells, or on the mesh as a whole.

use crate::base::{Error, Result};

macro_rules! values {
    ($($variant:ident($t:ty) $doc:literal;)*) => {
        /// Numbers in the type that the file stores them in, or texts.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Values {
            $(#[doc = $doc] $variant(Vec<$t>),)*
        }

        impl Values {
            /// Number of values, counting each component.
            pub fn len(&self) -> usize {
                match self { $(Self::$variant(v) => v.len(),)* }
            }

            /// Appends the values of `more`. Returns `false` and changes nothing if they are of another type.
            pub fn append(&mut self, more: &Self) -> bool {
                match (self, more) {
                    $((Self::$variant(v), Self::$variant(more)) => v.extend_from_slice(more),)*
                    _ => return false,
                }
                true
            }

            /// The given rows of `components` values each, in the given order.
            fn pick(&self, components: usize, rows: impl Iterator<Item = usize>) -> Self {
                match self { $(Self::$variant(v) => Self::$variant(pick(v, components, rows)),)* }
            }
        }

        $(impl From<Vec<$t>> for Values {
            fn from(v: Vec<$t>) -> Self { Self::$variant(v) }
        })*
    };
}

fn pick<T: Clone>(values: &[T], components: usize, rows: impl Iterator<Item = usize>) -> Vec<T> {
    rows.flat_map(|row| values[row * components..][..components].iter().cloned()).collect()
}

values! {
    I8(i8) "8-bit signed";
    U8(u8) "8-bit unsigned";
    I16(i16) "16-bit signed";
    U16(u16) "16-bit unsigned";
    I32(i32) "32-bit signed";
    U32(u32) "32-bit unsigned";
    I64(i64) "64-bit signed";
    U64(u64) "64-bit unsigned";
    F32(f32) "single precision";
    F64(f64) "double precision";
    Text(String) "texts, one a value";
}

impl Values {
    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the values are of an integer type.
    pub fn is_integer(&self) -> bool {
        !matches!(self, Self::F32(_) | Self::F64(_) | Self::Text(_))
    }

    /// Value `i` as a double-precision number; `None` for a text.
    pub fn get_f64(&self, i: usize) -> Option<f64> {
        Some(match self {
            Self::I8(v) => v[i].into(),
            Self::U8(v) => v[i].into(),
            Self::I16(v) => v[i].into(),
            Self::U16(v) => v[i].into(),
            Self::I32(v) => v[i].into(),
            Self::U32(v) => v[i].into(),
            Self::I64(v) => v[i] as f64,
            Self::U64(v) => v[i] as f64,
            Self::F32(v) => v[i].into(),
            Self::F64(v) => v[i],
            Self::Text(_) => return None,
        })
    }

    /// Sets value `i` to `x`. Returns `false` and changes nothing for texts, if an integer type cannot
    /// represent `x`, and if `x` is finite but beyond the range of single precision.
    ///
    /// Panics if there is no such value.
    pub fn set_f64(&mut self, i: usize, x: f64) -> bool {
        macro_rules! whole {
            ($v:expr, $t:ty) => {{
                // A saturated value does not convert back to `x`, except at 2^63 and 2^64, to which the
                // maxima round; hence the second test.
                let fits = (x as $t) as f64 == x && x < <$t>::MAX as f64 + 1.0;
                if fits {
                    $v[i] = x as $t;
                }
                fits
            }};
        }
        match self {
            Self::I8(v) => whole!(v, i8),
            Self::U8(v) => whole!(v, u8),
            Self::I16(v) => whole!(v, i16),
            Self::U16(v) => whole!(v, u16),
            Self::I32(v) => whole!(v, i32),
            Self::U32(v) => whole!(v, u32),
            Self::I64(v) => whole!(v, i64),
            Self::U64(v) => whole!(v, u64),
            Self::F32(v) => {
                let fits = (x as f32).is_finite() || !x.is_finite();
                if fits {
                    v[i] = x as f32;
                }
                fits
            }
            Self::F64(v) => {
                v[i] = x;
                true
            }
            Self::Text(_) => false,
        }
    }

    /// All values as double precision; `None` for texts.
    pub fn to_f64(&self) -> Option<Vec<f64>> {
        (0..self.len()).map(|i| self.get_f64(i)).collect()
    }

    /// All values as whole numbers; `None` for texts, and if any value is not whole or does not fit.
    pub fn to_i64(&self) -> Option<Vec<i64>> {
        // At 2^63, to which the maximum rounds, the saturated value converts back; hence the second test.
        let whole = |x: f64| ((x as i64) as f64 == x && x < i64::MAX as f64).then_some(x as i64);
        match self {
            Self::I8(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::U8(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::I16(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::U16(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::I32(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::U32(v) => Some(v.iter().map(|&x| x.into()).collect()),
            Self::I64(v) => Some(v.clone()),
            Self::U64(v) => v.iter().map(|&x| i64::try_from(x).ok()).collect(),
            Self::F32(v) => v.iter().map(|&x| whole(x.into())).collect(),
            Self::F64(v) => v.iter().map(|&x| whole(x)).collect(),
            Self::Text(_) => None,
        }
    }
}

/// A named array of `n` rows of `components` values each.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The name of the field, as shown to users.
    pub name: String,
    /// Number of values in a row: 1 for a scalar, 3 for a vector, 9 for a tensor.
    pub components: usize,
    /// All rows, end to end.
    pub values: Values,
}

impl Field {
    /// A field of scalars.
    pub fn scalars(name: impl Into<String>, values: impl Into<Values>) -> Self {
        Self { name: name.into(), components: 1, values: values.into() }
    }

    /// A field of vectors, such as displacements.
    pub fn vectors(name: impl Into<String>, values: &[[f64; 3]]) -> Self {
        Self { name: name.into(), components: 3, values: Values::F64(values.as_flattened().to_vec()) }
    }

    /// Number of rows.
    pub fn n_rows(&self) -> usize {
        self.values.len() / self.components.max(1)
    }

    /// A field of the given rows, in the given order, copied bit for bit.
    ///
    /// Panics if there is no such row.
    pub fn pick(&self, rows: impl IntoIterator<Item = usize>) -> Self {
        let values = self.values.pick(self.components, rows.into_iter());
        Self { name: self.name.clone(), components: self.components, values }
    }

    /// The rows as vectors in space.
    ///
    /// # Errors
    /// If the field does not have three components, or holds texts.
    pub fn to_vectors(&self) -> Result<Vec<[f64; 3]>> {
        let flat = self.values.to_f64().filter(|_| self.components == 3);
        let flat = flat.ok_or_else(|| {
            Error::input(format!("has {} component(s), but a vector of 3 is needed", self.components))
                .at(format!("array {}", self.name))
        })?;
        Ok(flat.as_chunks::<3>().0.to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_from_2_to_the_63_are_no_whole_numbers_of_64_bits() {
        let limit = 2.0f64.powi(63);
        assert_eq!(Values::F64(vec![limit]).to_i64(), None);
        assert_eq!(Values::F32(vec![limit as f32]).to_i64(), None);
        assert_eq!(Values::F64(vec![f64::INFINITY]).to_i64(), None);
        let below = limit - 1024.0;
        assert_eq!(Values::F64(vec![-limit, below]).to_i64(), Some(vec![i64::MIN, below as i64]));
    }

    #[test]
    fn a_finite_number_does_not_become_infinite_in_single_precision() {
        let mut values = Values::F32(vec![1.0]);
        assert!(!values.set_f64(0, 1e39) && !values.set_f64(0, -1e39));
        assert_eq!(values, Values::F32(vec![1.0]));
        assert!(values.set_f64(0, f64::from(f32::MAX)));
        assert_eq!(values, Values::F32(vec![f32::MAX]));
        assert!(values.set_f64(0, f64::NEG_INFINITY));
        assert_eq!(values, Values::F32(vec![f32::NEG_INFINITY]));
        assert!(values.set_f64(0, f64::NAN) && values.get_f64(0).unwrap().is_nan());
    }
}
