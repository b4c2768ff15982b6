//! The C library behind `include/motet.h`. That header is the reference; it is not repeated here.
//!
//! | file | what it holds |
//! |---|---|
//! | `constants` | the constants of the header |
//! | `guard` | statuses and errors; a panic stops here |
//! | `watch` | long calls: progress and a way to stop |
//! | `memory` | data passed by pointer: arrays with strides, texts, handles, structs with a size |
//! | `mesh`, `motion`, `changing`, `refinement`, `contact`, `moving` | the calls, in the order of the header |

#![allow(unsafe_code, reason = "what a C program gives is pointers; each is looked at in `memory`, once")]
#![allow(clippy::missing_safety_doc, reason = "the header says what each call needs")]
#![allow(clippy::too_many_arguments, reason = "C passes arrays as pointer, count and stride")]

mod changing;
mod constants;
mod contact;
mod guard;
#[cfg(test)]
mod header;
mod memory;
mod mesh;
mod motion;
mod moving;
mod refinement;
mod watch;

/// The version of this library as one number, `10000 major + 100 minor + patch`.
#[unsafe(no_mangle)]
pub extern "C" fn motet_version() -> i32 {
    let part = |text: &str| text.parse::<i32>().unwrap_or(0);
    part(env!("CARGO_PKG_VERSION_MAJOR")) * 10_000
        + part(env!("CARGO_PKG_VERSION_MINOR")) * 100
        + part(env!("CARGO_PKG_VERSION_PATCH"))
}
