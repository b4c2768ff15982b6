//! The program `motet`, called as a user or a script calls it.

mod bad_input;
mod cap;
mod common;
mod contact;
mod contract;
mod hostile;
mod implant;
mod meshing;
mod moving;
mod moving_slide;
mod quality;
mod refine;
mod remesh;
mod report;
mod run;
mod surface;
mod view;
mod wall;
