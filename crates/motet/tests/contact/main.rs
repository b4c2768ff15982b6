//! Contact of surfaces: gaps, crossings, rooms, the time of the first contact.

#[path = "../common/mod.rs"]
mod common;
#[path = "../surfaces/mod.rs"]
mod surfaces;

mod apart;
mod between;
mod gaps;
mod inside;
mod own;
mod rooms;
mod sweep;
