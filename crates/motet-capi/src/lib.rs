//! The C library: what `include/motet.h` promises. That header is the reference; here is no second one.
//!
//! | file | what it holds |
//! |---|---|
//! | `guard` | statuses and errors; a panic stops here |
//! | `memory` | what comes by pointer: arrays with strides, texts, handles, structs with a size |
//! | `mesh`, `motion`, `changing`, `refinement`, `contact`, `moving` | the calls, as the header has them in order |

#![allow(unsafe_code, reason = "what a C program gives is pointers; each is looked at in `memory`, once")]
#![allow(clippy::missing_safety_doc, reason = "the header says what each call needs")]
#![allow(clippy::too_many_arguments, reason = "C passes arrays as pointer, count and stride")]

mod changing;
mod contact;
mod guard;
mod memory;
mod mesh;
mod motion;
mod moving;
mod refinement;

/// The version of this library.
#[unsafe(no_mangle)]
pub extern "C" fn motet_version() -> i32 {
    let part = |text: &str| text.parse::<i32>().unwrap_or(0);
    part(env!("CARGO_PKG_VERSION_MAJOR")) * 10_000
        + part(env!("CARGO_PKG_VERSION_MINOR")) * 100
        + part(env!("CARGO_PKG_VERSION_PATCH"))
}
