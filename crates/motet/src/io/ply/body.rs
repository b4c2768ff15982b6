//! The numbers of a PLY file, element by element.

use super::fits;
use super::header::{Element, Header};
use crate::base::{Csr, Error, Result};
use crate::io::scalar::{ByteOrder, Scalar};
use crate::io::text::Text;

/// The rows of an element, as columns.
#[derive(Debug)]
pub(super) struct Table {
    columns: Vec<Column>,
}

#[derive(Debug)]
struct Column {
    name: String,
    kind: Scalar,
    /// For lists what they hold, end to end.
    numbers: Vec<f64>,
    /// For lists where each begins.
    offsets: Option<Vec<u32>>,
}

impl Table {
    /// The numbers of a column, which goes.
    pub(super) fn take(&mut self, name: &str) -> Option<(Scalar, Vec<f64>)> {
        let i = self.columns.iter().position(|column| column.name == name && column.offsets.is_none())?;
        let column = self.columns.remove(i);
        Some((column.kind, column.numbers))
    }

    /// The lists of one of these names, which go.
    pub(super) fn take_list(&mut self, names: &[&str]) -> Option<Csr<f64>> {
        let is_it = |column: &Column| names.contains(&column.name.as_str()) && column.offsets.is_some();
        let i = self.columns.iter().position(is_it)?;
        let column = self.columns.remove(i);
        Csr::new(column.offsets?, column.numbers)
    }

    /// The names of the lists that are left.
    pub(super) fn lists(&self) -> Vec<&str> {
        self.columns
            .iter()
            .filter(|column| column.offsets.is_some())
            .map(|column| column.name.as_str())
            .collect()
    }

    /// The columns that are left, without lists.
    pub(super) fn columns(self) -> Vec<(String, Scalar, Vec<f64>)> {
        let own = self.columns.into_iter().filter(|column| column.offsets.is_none());
        own.map(|column| (column.name, column.kind, column.numbers)).collect()
    }
}

/// What is left of the file.
pub(super) struct Body<'a> {
    text: Text<'a>,
    bytes: &'a [u8],
    order: Option<ByteOrder>,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        let mut text = Text::new(bytes);
        text.set_position(header.length);
        Self { text, bytes: &bytes[header.length..], order: header.order }
    }

    /// The rows of the next element.
    pub(super) fn table(&mut self, element: &Element) -> Result<Table> {
        let left = if self.order.is_some() { self.bytes.len() } else { self.text.rest().len() };
        if !fits(element, left, self.order.is_none()) {
            return Err(Error::input(format!(
                "{} elements `{}` are announced, more than the {left} bytes that follow can hold",
                element.n, element.name
            ))
            .remedy("the file is cut off or damaged: get it again"));
        }
        let column = |property: &super::header::Property| Column {
            name: property.name.clone(),
            kind: property.kind,
            numbers: Vec::with_capacity(element.n),
            offsets: property.count.map(|_| vec![0]),
        };
        let mut columns: Vec<Column> = element.properties.iter().map(column).collect();
        for row in 0..element.n {
            let at = |e: Error| e.at(format!("element {row} of `{}`", element.name));
            for (column, property) in columns.iter_mut().zip(&element.properties) {
                let n = match property.count {
                    None => 1,
                    Some(kind) => self.length(kind).map_err(at)?,
                };
                for _ in 0..n {
                    column.numbers.push(self.number(property.kind).map_err(at)?);
                }
                if let Some(offsets) = &mut column.offsets {
                    let end = u32::try_from(column.numbers.len());
                    offsets.push(
                        end.map_err(|_| at(Error::input("lists with more numbers than there are ids")))?,
                    );
                }
            }
        }
        Ok(Table { columns })
    }

    /// The length of a list: no more than there are bytes.
    fn length(&mut self, kind: Scalar) -> Result<usize> {
        let n = self.number(kind)?;
        let left = if self.order.is_some() { self.bytes.len() } else { self.text.rest().len() };
        match n >= 0.0 && n <= left as f64 {
            true => Ok(n as usize),
            false => Err(Error::input(format!("a list of {n} numbers, where {left} bytes follow"))
                .remedy("the file is cut off or damaged: get it again")),
        }
    }

    fn number(&mut self, kind: Scalar) -> Result<f64> {
        let Some(order) = self.order else { return self.text_number(kind) };
        let Some((bytes, rest)) = self.bytes.split_at_checked(kind.size()) else {
            return Err(Error::input("the file ends here").remedy("it is cut off: get it again"));
        };
        self.bytes = rest;
        Ok(decoded(kind, bytes, order))
    }

    fn text_number(&mut self, kind: Scalar) -> Result<f64> {
        let x = self.text.float("a number")?;
        let range = match kind {
            Scalar::I8 => Some((i8::MIN.into(), i8::MAX.into())),
            Scalar::U8 => Some((0.0, u8::MAX.into())),
            Scalar::I16 => Some((i16::MIN.into(), i16::MAX.into())),
            Scalar::U16 => Some((0.0, u16::MAX.into())),
            Scalar::I32 => Some((i32::MIN.into(), i32::MAX.into())),
            Scalar::U32 => Some((0.0, u32::MAX.into())),
            _ => None,
        };
        match range.is_none_or(|(low, high): (f64, f64)| x.fract() == 0.0 && low <= x && x <= high) {
            true => Ok(x),
            false => Err(self.text.error(format!("{x} is no number of the type that the head says"))),
        }
    }
}

/// A number from its bytes, of which there are as many as the type takes.
fn decoded(kind: Scalar, bytes: &[u8], order: ByteOrder) -> f64 {
    macro_rules! decode {
        ($t:ty) => {{
            let bytes = bytes.first_chunk().copied().unwrap_or_default();
            let x =
                if order == ByteOrder::Big { <$t>::from_be_bytes(bytes) } else { <$t>::from_le_bytes(bytes) };
            x as f64
        }};
    }
    match kind {
        Scalar::I8 => decode!(i8),
        Scalar::U8 => decode!(u8),
        Scalar::I16 => decode!(i16),
        Scalar::U16 => decode!(u16),
        Scalar::I32 => decode!(i32),
        Scalar::U32 => decode!(u32),
        Scalar::I64 => decode!(i64),
        Scalar::U64 => decode!(u64),
        Scalar::F32 => decode!(f32),
        Scalar::F64 => decode!(f64),
    }
}
