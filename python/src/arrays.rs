//! Conversion between numpy arrays and lists of the library; arrays take over the memory of lists.

use std::ops::Deref;

use bytemuck::allocation::cast_vec;
use motet::base::{Point, VertexId};
use motet::mesh::{Field, Values};
use numpy::ndarray::{Dimension, Ix1, Ix2};
use numpy::{
    Element, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray, PyReadwriteArray,
    PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::error::{input, to_exception};

/// An array that is read in place. Another type, another number of axes, or memory that another call is
/// writing to are errors of the input.
pub(crate) struct Read<'py, T: Element, D: Dimension>(PyReadonlyArray<'py, T, D>);

/// An array that is written in place. Errors are as for [`Read`], also for read-only arrays.
pub(crate) struct Written<'py, T: Element, D: Dimension>(pub(crate) PyReadwriteArray<'py, T, D>);

/// Points or vectors, shape `(n, 3)`.
pub(crate) type Vectors<'py> = Read<'py, f64, Ix2>;
/// Points or vectors that are written, shape `(n, 3)`.
pub(crate) type VectorsOut<'py> = Written<'py, f64, Ix2>;
/// Indices of vertices, cells or triangles.
pub(crate) type Ids<'py> = Read<'py, u32, Ix1>;

impl<'py, T: Element, D: Dimension> Deref for Read<'py, T, D> {
    type Target = PyReadonlyArray<'py, T, D>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a, 'py, T: Element, D: Dimension> FromPyObject<'a, 'py> for Read<'py, T, D> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let array = array::<T, D>(given)?;
        array.try_readonly().map(Self).map_err(|_| written())
    }
}

impl<'a, 'py, T: Element, D: Dimension> FromPyObject<'a, 'py> for Written<'py, T, D> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let array = array::<T, D>(given)?;
        array.try_readwrite().map(Self).map_err(|failed| {
            input(format!(
                "the output array cannot be written: {failed}; it must be writeable and share no memory with \
                 another array"
            ))
        })
    }
}

fn written() -> PyErr {
    input("an input array is being written by this or another call; give it its own memory")
}

/// An array with the required element type and number of axes.
fn array<'py, T: Element, D: Dimension>(
    given: Borrowed<'_, 'py, PyAny>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    if let Ok(array) = given.cast::<PyArray<T, D>>() {
        return Ok(array.to_owned());
    }
    let found = match given.cast::<PyUntypedArray>() {
        Ok(array) => format!("an array of {} and {} axes", array.dtype(), array.ndim()),
        Err(_) => format!("{}", given.get_type()),
    };
    let axes = D::NDIM.map_or_else(String::new, |n| format!(" and {n} axes"));
    Err(input(format!("expected an array of {}{axes}, found {found}", T::get_dtype(given.py()))))
}

/// The rows of an array that is contiguous and has three columns.
pub(crate) fn rows<'a>(array: &'a Vectors<'_>, what: &str) -> PyResult<&'a [Point]> {
    let flat = array.as_slice().ok().filter(|_| array.shape()[1] == 3);
    flat.map(|flat| flat.as_chunks::<3>().0).ok_or_else(|| {
        input(format!("{what} of shape {:?}, expected (n, 3), contiguous and of float64", array.shape()))
    })
}

/// The rows of an array to be written that is contiguous and has three columns.
pub(crate) fn rows_mut<'a>(out: &'a mut VectorsOut<'_>, what: &str) -> PyResult<&'a mut [Point]> {
    let shape = out.0.shape().to_vec();
    let flat = out.0.as_slice_mut().ok().filter(|_| shape[1] == 3);
    flat.map(|flat| flat.as_chunks_mut::<3>().0).ok_or_else(|| {
        input(format!("{what} of shape {shape:?}, expected (n, 3), contiguous and of float64"))
    })
}

/// A list of ids as an array.
pub(crate) fn ids<'py, T: bytemuck::Pod>(py: Python<'py>, list: Vec<T>) -> Bound<'py, PyArray1<u32>> {
    PyArray1::from_vec(py, cast_vec::<T, u32>(list))
}

/// Vertices from an array of their numbers.
pub(crate) fn vertices(array: &Ids<'_>, n_points: usize) -> PyResult<Vec<VertexId>> {
    let ids: Vec<VertexId> = array.as_array().iter().map(|&v| VertexId(v)).collect();
    match ids.iter().find(|v| v.index() >= n_points) {
        None => Ok(ids),
        Some(v) => Err(input(format!("vertex {v} is out of range: the mesh has {n_points} points"))),
    }
}

/// Points or vectors as an array `(n, 3)`.
pub(crate) fn vectors<'py>(py: Python<'py>, list: Vec<Point>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    table(py, list.into_flattened(), 3)
}

/// An array of rows of `columns` values each.
pub(crate) fn table<'py, T: Element>(
    py: Python<'py>,
    flat: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let n = flat.len() / columns.max(1);
    PyArray1::from_vec(py, flat).reshape([n, columns])
}

macro_rules! across {
    ($($variant:ident($t:ty);)*) => {
        /// The values of a field: an array of shape `(n,)`, or `(n, components)`; texts are a list.
        pub(crate) fn from_field<'py>(py: Python<'py>, field: Field) -> PyResult<Bound<'py, PyAny>> {
            let k = field.components;
            match field.values {
                $(Values::$variant(v) if k == 1 => Ok(PyArray1::from_vec(py, v).into_any()),
                Values::$variant(v) => Ok(table(py, v, k)?.into_any()),)*
                Values::Text(v) => Ok(PyList::new(py, v)?.into_any()),
            }
        }

        /// A field from an array of one, two or three dimensions, the first of which counts the rows; or from
        /// a list of texts.
        pub(crate) fn to_field(name: String, array: &Bound<'_, PyAny>) -> PyResult<Field> {
            $(if let Ok(array) = array.cast::<PyArrayDyn<$t>>() {
                let shape = array.shape().to_vec();
                let components = shape.iter().skip(1).product();
                let array = array.try_readonly().map_err(|_| written())?;
                let values: Vec<$t> = array.as_array().iter().copied().collect();
                return Ok(Field { name, components, values: Values::$variant(values) });
            })*
            if let Ok(array) = array.cast::<PyArrayDyn<bool>>() {
                let values: Vec<u8> = array.try_readonly().map_err(|_| written())?.as_array().iter().map(|&b| b.into()).collect();
                return Ok(Field { components: array.shape().iter().skip(1).product(), name, values: values.into() });
            }
            match array.extract::<Vec<String>>() {
                Ok(texts) => Ok(Field::scalars(name, texts)),
                Err(_) => Err(to_exception(
                    motet::Error::input(format!(
                        "{} is neither an array of numbers nor a list of strings",
                        array.get_type()
                    ))
                    .at(format!("array {name}")),
                )),
            }
        }
    };
}

across! {
    F64(f64);
    F32(f32);
    I64(i64);
    I32(i32);
    U8(u8);
    I8(i8);
    I16(i16);
    U16(u16);
    U32(u32);
    U64(u64);
}
