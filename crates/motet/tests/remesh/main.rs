//! Remeshing: repair of bad tets, and edges of requested lengths.

#[path = "../common/mod.rs"]
mod common;

mod bad_tets;
mod cases;
mod forced;
mod held;
mod line_moves;
mod lines;
#[allow(dead_code, unreachable_pub, reason = "the example shares it, and uses other parts of it")]
mod moving_cases;
mod reports;
mod rules;
mod sizes;
mod threads;
mod whole;
mod wrecks;
