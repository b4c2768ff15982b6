//! The active mutant: the number in `MUTANT`. With `MUTANT=reach` none is active, and the numbers of mutants
//! reached are appended to the file `MUTANT_REACH`.

use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const N_MUTANTS: usize = 1;
const UNREAD: u32 = u32::MAX;
const REACH: u32 = u32::MAX - 1;
static ON: AtomicU32 = AtomicU32::new(UNREAD);
static REACHED: [AtomicBool; N_MUTANTS] = [const { AtomicBool::new(false) }; N_MUTANTS];

#[inline(always)]
pub fn on(id: u32) -> bool {
    let on = ON.load(Relaxed);
    on == id || (on >= REACH && is_on(id))
}

#[cold]
#[inline(never)]
fn is_on(id: u32) -> bool {
    if ON.load(Relaxed) == UNREAD {
        let on = std::env::var("MUTANT").unwrap_or_default();
        ON.store(if on == "reach" { REACH } else { on.parse().unwrap_or(0) }, Relaxed);
    }
    if ON.load(Relaxed) == REACH && !REACHED[id as usize].swap(true, Relaxed) {
        let file = std::env::var("MUTANT_REACH").expect("MUTANT=reach needs MUTANT_REACH");
        let file = std::fs::OpenOptions::new().append(true).create(true).open(file);
        file.and_then(|mut file| file.write_all(format!("{id}\n").as_bytes())).expect("a file to append to");
    }
    ON.load(Relaxed) == id
}
