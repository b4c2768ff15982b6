//! Repairs broken meshes; prints the outcomes for each kind of damage, and the longest time.
//!
//! `wrecks [N] [FIRST]`: the wrecks FIRST to FIRST + N; the exit status is 1 if a result is invalid without
//! being reported or refused. `wrecks N FIRST CELLS`: boxes of CELLS cells along each axis instead, with
//! inner vertices displaced by up to two edge lengths.

#[path = "../tests/common/mod.rs"]
#[allow(unreachable_pub, unused_imports, reason = "tests share it, and use other parts of it")]
mod common;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

use common::wreck::{Ending, Wreck};
use motet::remesh::SurfaceRule;

fn main() -> ExitCode {
    let mut numbers = std::env::args().skip(1).map_while(|word| word.parse::<u64>().ok());
    let (n, first) = (numbers.next().unwrap_or(1000), numbers.next().unwrap_or(0));
    let cells = numbers.next().and_then(|n| usize::try_from(n).ok());
    let mut table: BTreeMap<(String, String), usize> = BTreeMap::new();
    let (mut longest, mut n_faults) = ((0.0, first), 0);
    for seed in first..first + n {
        let wreck = match cells {
            Some(cells) => Wreck::shaken_box(seed, cells, 0.2 * (1 + seed % 10) as f64),
            None => Wreck::new(seed),
        };
        let surface = if seed % 4 == 0 { SurfaceRule::Adapt { distance: None } } else { SurfaceRule::Keep };
        if std::env::var_os("WRECKS_VERBOSE").is_some() {
            eprintln!("{seed} {:?} {} tets", wreck.damage, wreck.mesh.tets.len());
        }
        let start = Instant::now();
        let end =
            catch_unwind(AssertUnwindSafe(|| wreck.end(surface))).unwrap_or_else(|_| Err("panicked".into()));
        let seconds = start.elapsed().as_secs_f64();
        if seconds > longest.0 {
            longest = (seconds, seed);
        }
        if let Err(why) = &end {
            println!("{seed}: {:?}, {surface:?}: {why}", wreck.damage);
            n_faults += 1;
        }
        let end = match end {
            Ok(Ending::Valid) => "valid",
            Ok(Ending::Reported) => "told",
            Ok(Ending::Refused) => "refused",
            Err(_) => "FAULT",
        };
        *table.entry((format!("{:?}", wreck.damage), end.into())).or_default() += 1;
    }
    table.iter().for_each(|((damage, end), n)| println!("{damage:9} {end:8} {n}"));
    println!("longest {:.2} s, wreck {}", longest.0, longest.1);
    if n_faults > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
