//! Data passed by pointer, checked once: arrays with strides, texts, handles, structs that state their size.

use std::borrow::Cow;
use std::ffi::{CStr, c_char};
use std::slice;

use motet::base::{Point, Threads, VertexId};
use motet::{Error, Result};

fn missing(what: &str) -> Error {
    Error::options(format!("{what} is NULL")).remedy("motet.h describes what each call needs")
}

/// A count passed from C.
pub(crate) fn count(n: i64, what: &str) -> Result<usize> {
    usize::try_from(n).map_err(|_| Error::options(format!("{n} {what}, expected 0 or more")))
}

/// A number of an option; `None` for 0, which leaves the choice to motet. All other values are passed on; the
/// library refuses invalid ones.
pub(crate) fn optional(x: f64) -> Option<f64> {
    (x != 0.0).then_some(x)
}

/// Fails where a count differs from the expected one.
pub(crate) fn expect(n: i64, expected: usize, what: &str) -> Result<()> {
    match usize::try_from(n) == Ok(expected) {
        true => Ok(()),
        false => Err(Error::options(format!("space for {n} {what} is given, expected {expected}"))),
    }
}

/// A slice of `n` values to read.
pub(crate) fn values<'a, T>(start: *const T, n: usize, what: &str) -> Result<&'a [T]> {
    match (start.is_null(), n) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(missing(what)),
        // SAFETY: the header requires that many values behind the pointer.
        (false, _) => Ok(unsafe { slice::from_raw_parts(start, n) }),
    }
}

/// A slice of `n` values to write.
pub(crate) fn values_mut<'a, T>(start: *mut T, n: usize, what: &str) -> Result<&'a mut [T]> {
    match (start.is_null(), n) {
        (_, 0) => Ok(&mut []),
        (true, _) => Err(missing(what)),
        // SAFETY: the header requires memory for that many values, which nothing else uses during the call.
        (false, _) => Ok(unsafe { slice::from_raw_parts_mut(start, n) }),
    }
}

fn stride(stride: i64, what: &str) -> Result<usize> {
    match usize::try_from(stride) {
        Ok(stride) if stride >= 3 => Ok(stride),
        _ => Err(Error::options(format!("{what}: a stride of {stride}, expected 3 or more"))
            .remedy("3 for contiguous rows")),
    }
}

/// The number of doubles that `n` rows span.
fn extent(n: usize, stride: usize) -> usize {
    if n == 0 { 0 } else { (n - 1).saturating_mul(stride).saturating_add(3) }
}

/// Rows of three numbers: borrowed if they are contiguous, copied otherwise.
pub(crate) fn rows<'a>(start: *const f64, n: i64, step: i64, what: &str) -> Result<Cow<'a, [Point]>> {
    let (n, step) = (count(n, what)?, stride(step, what)?);
    let flat = values(start, extent(n, step), what)?;
    Ok(match step {
        3 => Cow::Borrowed(flat.as_chunks::<3>().0),
        _ => Cow::Owned((0..n).map(|i| [0, 1, 2].map(|k| flat[i * step + k])).collect()),
    })
}

/// Fills rows of three numbers: in place if they are contiguous, through a copy otherwise. Where `fill`
/// fails, strided rows stay unchanged.
pub(crate) fn fill_rows<T>(
    start: *mut f64,
    n: i64,
    step: i64,
    what: &str,
    fill: impl FnOnce(&mut [Point]) -> Result<T>,
) -> Result<T> {
    let (n, step) = (count(n, what)?, stride(step, what)?);
    let flat = values_mut(start, extent(n, step), what)?;
    if step == 3 {
        return fill(flat.as_chunks_mut::<3>().0);
    }
    let mut rows: Vec<Point> = (0..n).map(|i| [0, 1, 2].map(|k| flat[i * step + k])).collect();
    let done = fill(&mut rows)?;
    rows.iter().enumerate().for_each(|(i, row)| flat[i * step..][..3].copy_from_slice(row));
    Ok(done)
}

/// Fails where rows to be read share memory with rows to be written. Copied rows do not.
pub(crate) fn check_no_overlap(read: &[Point], written: *mut f64, n: i64, step: i64) -> Result<()> {
    let length = extent(count(n, "rows")?, stride(step, "rows")?);
    let end = written.addr().saturating_add(length.saturating_mul(size_of::<f64>()));
    let read = read.as_ptr_range();
    match read.start.addr() < end && written.addr() < read.end.addr() {
        false => Ok(()),
        true => {
            Err(Error::options("points share memory with displacement")
                .remedy("give them memory of their own"))
        }
    }
}

/// A text passed from C.
pub(crate) fn text<'a>(start: *const c_char, what: &str) -> Result<&'a str> {
    if start.is_null() {
        return Err(missing(what));
    }
    // SAFETY: the header requires a text that ends with a zero.
    let text = unsafe { CStr::from_ptr(start) }.to_str();
    text.map_err(|_| Error::options(format!("{what} is not valid UTF-8")))
}

/// Several texts passed from C.
pub(crate) fn texts<'a>(start: *const *const c_char, n: i64, what: &str) -> Result<Vec<&'a str>> {
    values(start, count(n, what)?, what)?.iter().map(|&one| text(one, what)).collect()
}

/// Several texts passed from C, copied.
pub(crate) fn owned(start: *const *const c_char, n: i64, what: &str) -> Result<Vec<String>> {
    Ok(texts(start, n, what)?.into_iter().map(str::to_owned).collect())
}

/// A handle to read from.
pub(crate) fn handle<'a, T>(handle: *const T, what: &str) -> Result<&'a T> {
    // SAFETY: the header requires a handle that was made by this library and has not been freed.
    unsafe { handle.as_ref() }.ok_or_else(|| missing(what))
}

/// A handle to be changed.
pub(crate) fn handle_mut<'a, T>(handle: *mut T, what: &str) -> Result<&'a mut T> {
    // SAFETY: as for `handle`; the header also requires that nothing else uses it during the call.
    unsafe { handle.as_mut() }.ok_or_else(|| missing(what))
}

/// The place for a new handle, set to NULL until there is one.
pub(crate) fn out_handle<'a, T>(place: *mut *mut T, what: &str) -> Result<&'a mut *mut T> {
    let place = handle_mut(place, what)?;
    *place = std::ptr::null_mut();
    Ok(place)
}

/// Moves a new object to the heap and gives its handle to the caller.
pub(crate) fn set_handle<T>(place: &mut *mut T, thing: T) {
    *place = Box::into_raw(Box::new(thing));
}

/// Frees the object of a handle; NULL is permitted.
pub(crate) fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: the header requires a handle that was made by this library and has not been freed.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// A struct whose first member is its size, and whose members may be copied as bytes.
///
/// # Safety
/// The type is `repr(C)`, and every member is valid for any bytes that a C program can store there: numbers
/// and pointers.
pub(crate) unsafe trait Versioned: Copy {
    /// The default values of the members.
    const DEFAULT: Self;
    /// The function of the header that sets the defaults: the name of the struct and `_init`.
    #[cfg(test)]
    const INIT: &'static str;
    /// The members behind the size, in their order.
    #[cfg(test)]
    fn members() -> Vec<Member>;
}

/// A member of a struct of the header, as this library declares it.
#[cfg(test)]
pub(crate) struct Member {
    pub(crate) name: &'static str,
    /// The type in Rust.
    pub(crate) kind: &'static str,
    /// The default value, as `Debug` writes it.
    pub(crate) default: String,
}

/// Defines a struct of the header: its members with their defaults, and the function that sets all of them to
/// these.
macro_rules! versioned {
    ($(#[$doc:meta])* $name:ident, $init:ident { $($member:ident: $type:ty = $default:expr,)* }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $name {
            size: usize,
            $($member: $type,)*
        }

        // SAFETY: the header declares numbers and pointers, in this order.
        unsafe impl crate::memory::Versioned for $name {
            const DEFAULT: Self = Self { size: size_of::<Self>(), $($member: $default,)* };
            #[cfg(test)]
            const INIT: &'static str = stringify!($init);
            #[cfg(test)]
            fn members() -> Vec<crate::memory::Member> {
                vec![$(crate::memory::Member {
                    name: stringify!($member),
                    kind: stringify!($type),
                    default: format!("{:?}", Self::DEFAULT.$member),
                },)*]
            }
        }

        #[unsafe(no_mangle)]
        pub(crate) unsafe extern "C" fn $init(place: *mut $name, size: usize) {
            let default: $name = crate::memory::Versioned::DEFAULT;
            crate::memory::copy_out(&default, place, size);
        }
    };
}
pub(crate) use versioned;

/// Copies a struct given by a program that may know fewer members: the others keep their defaults, as do all
/// for NULL.
pub(crate) fn read_versioned<T: Versioned>(given: *const T) -> Result<T> {
    let mut all = T::DEFAULT;
    if given.is_null() {
        return Ok(all);
    }
    // SAFETY: the size is the first member of each of these structs.
    let size = unsafe { given.cast::<usize>().read() };
    if size < size_of::<usize>() {
        return Err(Error::options("a struct of options has no size").remedy("call its _init first"));
    }
    // SAFETY: the program guarantees that this many bytes are there; the trait, that they may be copied.
    unsafe {
        given.cast::<u8>().copy_to_nonoverlapping((&raw mut all).cast::<u8>(), size.min(size_of::<T>()));
    }
    Ok(all)
}

/// Copies a struct to the program, up to the size that the program knows.
pub(crate) fn copy_out<T: Versioned>(value: &T, place: *mut T, size: usize) {
    if place.is_null() {
        return;
    }
    let n = size.min(size_of::<T>());
    // SAFETY: the program guarantees space for this many bytes.
    unsafe {
        (&raw const *value).cast::<u8>().copy_to_nonoverlapping(place.cast::<u8>(), n);
        if n >= size_of::<usize>() {
            place.cast::<usize>().write(n);
        }
    }
}

pub(crate) fn threads(n: i32) -> Result<Threads> {
    let n = usize::try_from(n).map_err(|_| Error::options(format!("{n} threads, expected 0 or more")))?;
    Threads::new(n)
}

/// A vertex by its number, which must be below `n_points`.
pub(crate) fn vertex(id: i32, n_points: usize, what: &str) -> Result<VertexId> {
    match usize::try_from(id) {
        Ok(v) if v < n_points => Ok(VertexId::new(v)),
        _ => Err(Error::input(format!("vertex {id} is out of range: there are {n_points} points")).at(what)),
    }
}

/// An id as passed to C; -1 for none.
pub(crate) fn id(v: u32) -> i32 {
    i32::try_from(v).unwrap_or(-1)
}
