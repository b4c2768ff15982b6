//! What all modules have in common: counts, refused numbers, calls that are watched.

mod counts;
mod refused_numbers;
mod watch;
