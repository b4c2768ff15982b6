//! Statuses and errors. Every call that can fail runs in [`guarded`], which converts errors and catches
//! panics.

use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use motet::{Error, ErrorKind, Result};

use crate::constants::{INPUT, INTERNAL, IO, OK, OPTIONS, STOPPED};

/// An error, its parts as C strings.
pub(crate) struct MotetError {
    status: i32,
    message: CString,
    what: CString,
    file: Option<CString>,
    place: Option<CString>,
    remedy: Option<CString>,
}

impl MotetError {
    fn new(error: &Error) -> Self {
        Self {
            status: match error.kind() {
                ErrorKind::Options => OPTIONS,
                ErrorKind::Io | ErrorKind::Output => IO,
                ErrorKind::Stopped => STOPPED,
                _ => INPUT,
            },
            message: text(error.to_string()),
            what: text(error.what()),
            file: error.file().map(|file| text(file.display().to_string())),
            place: error.place().map(text),
            remedy: error.remedy_text().map(text),
        }
    }

    fn internal(what: &str) -> Self {
        let message = format!("internal error in motet: {what}");
        Self {
            status: INTERNAL,
            message: text(message),
            what: text(what),
            file: None,
            place: None,
            remedy: None,
        }
    }
}

/// A C string of a text, with zero bytes removed.
pub(crate) fn text(text: impl Into<Vec<u8>>) -> CString {
    let mut bytes: Vec<u8> = text.into();
    bytes.retain(|&b| b != 0);
    CString::new(bytes).unwrap_or_default()
}

/// Makes a call and returns its status; stores the error, or NULL, in `error` unless that is NULL.
pub(crate) fn guarded(error: *mut *mut MotetError, call: impl FnOnce() -> Result<()>) -> i32 {
    let failed = match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(())) => None,
        Ok(Err(failed)) => Some(MotetError::new(&failed)),
        Err(panic) => {
            let what = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let what = what.or_else(|| panic.downcast_ref::<String>().cloned());
            Some(MotetError::internal(&what.unwrap_or_default()))
        }
    };
    let status = failed.as_ref().map_or(OK, |failed| failed.status);
    // SAFETY: the header requires NULL or a place for a pointer.
    if let Some(place) = unsafe { error.as_mut() } {
        *place = failed.map_or(ptr::null_mut(), |failed| Box::into_raw(Box::new(failed)));
    }
    status
}

/// Runs a call that fails only by a bug in this library; returns `otherwise` then.
pub(crate) fn or_default<T>(otherwise: T, call: impl FnOnce() -> Option<T>) -> T {
    catch_unwind(AssertUnwindSafe(call)).ok().flatten().unwrap_or(otherwise)
}

macro_rules! parts {
    ($($name:ident, $of:expr;)*) => {
        $(#[unsafe(no_mangle)]
        pub(crate) unsafe extern "C" fn $name(error: *const MotetError) -> *const c_char {
            let of: fn(&MotetError) -> Option<&CString> = $of;
            // SAFETY: the header requires NULL or an error that has not been freed.
            unsafe { error.as_ref() }.and_then(of).map_or(ptr::null(), |text| text.as_ptr())
        })*
    };
}

parts! {
    motet_error_message, |e| Some(&e.message);
    motet_error_what, |e| Some(&e.what);
    motet_error_file, |e| e.file.as_ref();
    motet_error_place, |e| e.place.as_ref();
    motet_error_remedy, |e| e.remedy.as_ref();
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_error_status(error: *const MotetError) -> i32 {
    // SAFETY: the header requires NULL or an error that has not been freed.
    unsafe { error.as_ref() }.map_or(OK, |error| error.status)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_error_free(error: *mut MotetError) {
    crate::memory::free(error);
}
