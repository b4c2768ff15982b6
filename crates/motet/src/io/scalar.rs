//! Number types of files, and conversion between numbers and bytes or text.

use std::borrow::Cow;
use std::io::Write as _;

use crate::base::{Point, Result};
use crate::io::output::Output;
use crate::mesh::Values;

const NUMBERS_PER_LINE: usize = 12;
/// Numbers that a thread writes as text at a time, whole lines.
const NUMBERS_PER_PART: usize = 1024 * NUMBERS_PER_LINE;

/// The byte order of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

impl ByteOrder {
    pub(super) const NATIVE: Self = if cfg!(target_endian = "little") { Self::Little } else { Self::Big };
}

macro_rules! scalars {
    ($($name:ident($t:ty);)*) => {
        /// A number type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Scalar { $($name,)* }

        impl Scalar {
            /// Size of a number in bytes.
            pub(super) fn size(self) -> usize {
                match self { $(Self::$name => size_of::<$t>(),)* }
            }

            /// `n` numbers, whose bytes `fill` writes. The caller must have checked that the file can hold
            /// that many.
            pub(super) fn filled(
                self, n: usize, order: ByteOrder, fill: impl FnOnce(&mut [u8]) -> Result<()>,
            ) -> Result<Values> {
                Ok(match self {
                    $(Self::$name => {
                        let mut values = vec![<$t>::default(); n];
                        fill(bytemuck::cast_slice_mut(&mut values))?;
                        if order != ByteOrder::NATIVE {
                            swap_all(bytemuck::cast_slice_mut(&mut values), size_of::<$t>());
                        }
                        Values::$name(values)
                    })*
                })
            }

            /// Parses up to `n` numbers from text. `Err` holds the first token that is not such a number; too
            /// few tokens are not an error.
            pub(super) fn parse<'a>(
                self, n: usize, tokens: &mut impl Iterator<Item = &'a str>,
            ) -> Result<Values, &'a str> {
                Ok(match self {
                    $(Self::$name => Values::$name(
                        tokens.take(n).map(|t| t.parse::<$t>().map_err(|_| t)).collect::<Result<_, _>>()?,
                    ),)*
                })
            }
        }

        /// The bytes of all values in native byte order; each text is terminated by a zero byte.
        pub(super) fn native_bytes(values: &Values) -> Cow<'_, [u8]> {
            match values {
                $(Values::$name(v) => Cow::Borrowed(bytemuck::cast_slice(v)),)*
                Values::Text(v) => {
                    Cow::Owned(v.iter().flat_map(|t| t.bytes().chain(std::iter::once(0))).collect())
                }
            }
        }

        /// Writes the bytes of all numbers in big-endian order; texts are skipped.
        pub(super) fn write_big_values(output: &mut Output<'_>, values: &Values) -> Result<()> {
            match values {
                $(Values::$name(v) => write_big(output, v, |x| x.to_be_bytes()),)*
                Values::Text(_) => Ok(()),
            }
        }

        /// Writes numbers as text; texts are skipped.
        pub(super) fn write_text(output: &mut Output<'_>, values: &Values) -> Result<()> {
            match values {
                $(Values::$name(v) => write_lines(output, v),)*
                Values::Text(_) => Ok(()),
            }
        }

        /// The given rows, in the given order.
        pub(super) fn select_rows(values: &Values, components: usize, rows: &[usize]) -> Values {
            let places = || rows.iter().flat_map(|&row| row * components..(row + 1) * components);
            match values {
                $(Values::$name(v) => Values::$name(places().map(|i| v[i]).collect()),)*
                Values::Text(v) => Values::Text(places().map(|i| v[i].clone()).collect()),
            }
        }

        /// Appends the values of `more`; returns `false` if their types differ.
        pub(super) fn append(values: &mut Values, more: Values) -> bool {
            match (values, more) {
                $((Values::$name(v), Values::$name(more)) => v.extend(more),)*
                (Values::Text(v), Values::Text(more)) => v.extend(more),
                _ => return false,
            }
            true
        }
    };
}

scalars! {
    I8(i8);
    U8(u8);
    I16(i16);
    U16(u16);
    I32(i32);
    U32(u32);
    I64(i64);
    U64(u64);
    F32(f32);
    F64(f64);
}

impl Scalar {
    /// Converts `bytes` to numbers; trailing bytes of an incomplete number are ignored.
    pub(super) fn numbers(self, bytes: &[u8], order: ByteOrder) -> Result<Values> {
        let n = bytes.len() / self.size();
        self.filled(n, order, |out| {
            out.copy_from_slice(&bytes[..out.len()]);
            Ok(())
        })
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// Writes numbers as text, up to twelve per line; floats with the fewest digits that recover them exactly.
pub(super) fn write_lines<T: std::fmt::Debug + Sync>(output: &mut Output<'_>, values: &[T]) -> Result<()> {
    let parts: Vec<&[T]> = values.chunks(NUMBERS_PER_PART).collect();
    output.parts(parts.len(), |(), i, out| {
        for line in parts[i].chunks(NUMBERS_PER_LINE) {
            for value in line {
                write!(out, "{value:?} ").expect("writing into memory does not fail");
            }
            out.pop();
            out.push(b'\n');
        }
        Ok(())
    })?;
    Ok(())
}

/// Writes `bytes` of each value.
pub(super) fn write_big<T: Copy + Sync, const N: usize>(
    output: &mut Output<'_>,
    values: &[T],
    bytes: impl Fn(T) -> [u8; N] + Sync + Send,
) -> Result<()> {
    let parts: Vec<&[T]> = values.chunks(NUMBERS_PER_PART).collect();
    output.parts(parts.len(), |(), i, out| {
        out.resize(parts[i].len() * N, 0);
        for (place, &value) in out.as_chunks_mut::<N>().0.iter_mut().zip(parts[i]) {
            *place = bytes(value);
        }
        Ok(())
    })?;
    Ok(())
}

/// Reverses the bytes of every number of `size` bytes.
pub(super) fn swap_all(bytes: &mut [u8], size: usize) {
    fn reverse_each<const N: usize>(bytes: &mut [u8]) {
        bytes.as_chunks_mut::<N>().0.iter_mut().for_each(|number| number.reverse());
    }
    match size {
        2 => reverse_each::<2>(bytes),
        4 => reverse_each::<4>(bytes),
        8 => reverse_each::<8>(bytes),
        _ => {}
    }
}

/// Values as points; `None` for texts.
pub(super) fn to_points(values: Values) -> Option<Vec<Point>> {
    let flat = match values {
        Values::F64(flat) => flat,
        other => other.to_f64()?,
    };
    // Copies only if the allocation is not a whole number of points.
    Some(
        bytemuck::allocation::try_cast_vec(flat).unwrap_or_else(|(_, flat)| flat.as_chunks::<3>().0.to_vec()),
    )
}

/// Fills ids from the bytes of integers of 32 or 64 bits; returns `false` if one is negative or too large.
pub(super) fn fill_ids(ids: &mut [u32], kind: Scalar, order: ByteOrder, bytes: &[u8]) -> bool {
    /// The combined bits of all numbers show whether all fit, without a branch in the loop.
    fn fill<const N: usize>(ids: &mut [u32], bytes: &[u8], wide: impl Fn([u8; N]) -> u64) -> bool {
        let mut bits = 0;
        for (id, &number) in ids.iter_mut().zip(bytes.as_chunks::<N>().0) {
            let wide = wide(number);
            bits |= wide;
            *id = wide as u32;
        }
        bits >> 32 == 0
    }
    match (kind, order) {
        (Scalar::I32, ByteOrder::Little) => fill(ids, bytes, |b| i32::from_le_bytes(b) as u64),
        (Scalar::I32, ByteOrder::Big) => fill(ids, bytes, |b| i32::from_be_bytes(b) as u64),
        (Scalar::U32, ByteOrder::Little) => fill(ids, bytes, |b| u32::from_le_bytes(b).into()),
        (Scalar::U32, ByteOrder::Big) => fill(ids, bytes, |b| u32::from_be_bytes(b).into()),
        (Scalar::I64 | Scalar::U64, ByteOrder::Little) => fill(ids, bytes, u64::from_le_bytes),
        (Scalar::I64 | Scalar::U64, ByteOrder::Big) => fill(ids, bytes, u64::from_be_bytes),
        _ => false,
    }
}

/// Converts numbers to 32-bit ids. `Err` describes the first value that is not an id: negative, too large, or
/// not an integer.
pub(super) fn to_ids(values: &Values) -> Result<Vec<u32>, String> {
    fn all<T: Copy + TryInto<u32> + ToString>(values: &[T]) -> Result<Vec<u32>, String> {
        // Without a branch per number, so that the loop is vectorised.
        let mut fits = true;
        let ids: Vec<u32> = values
            .iter()
            .map(|&x| {
                x.try_into().unwrap_or_else(|_| {
                    fits = false;
                    0
                })
            })
            .collect();
        if fits {
            return Ok(ids);
        }
        let bad = values.iter().find(|&&x| x.try_into().is_err());
        Err(bad.map(ToString::to_string).unwrap_or_default())
    }
    match values {
        Values::I8(v) => all(v),
        Values::U8(v) => all(v),
        Values::I16(v) => all(v),
        Values::U16(v) => all(v),
        Values::I32(v) => all(v),
        Values::U32(v) => Ok(v.clone()),
        Values::I64(v) => all(v),
        Values::U64(v) => all(v),
        Values::F32(_) | Values::F64(_) => match values.to_i64() {
            Some(whole) => all(&whole),
            None => Err("a fraction".into()),
        },
        Values::Text(_) => Err("a text".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_round_trip_in_either_order() {
        let values = Values::F64(vec![1.5, -0.0, f64::MIN_POSITIVE]);
        let bytes = native_bytes(&values).into_owned();
        assert_eq!(Scalar::F64.numbers(&bytes, ByteOrder::NATIVE).unwrap(), values);
        let mut swapped = bytes;
        swap_all(&mut swapped, 8);
        let other = if ByteOrder::NATIVE == ByteOrder::Big { ByteOrder::Little } else { ByteOrder::Big };
        assert_eq!(Scalar::F64.numbers(&swapped, other).unwrap(), values);
    }

    #[test]
    fn the_first_invalid_id_is_reported() {
        assert_eq!(to_ids(&Values::I64(vec![3, -1, 1 << 40])), Err("-1".into()));
        assert_eq!(to_ids(&Values::I64(vec![3, 1 << 40])), Err("1099511627776".into()));
        assert_eq!(to_ids(&Values::F64(vec![3.0, 4.0])), Ok(vec![3, 4]));
        assert_eq!(to_ids(&Values::F64(vec![3.5])), Err("a fraction".into()));
    }
}
