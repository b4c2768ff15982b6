//! The verbs, one file or folder each.

pub(crate) mod cap;
pub(crate) mod contact;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod implant;
pub(crate) mod info;
pub(crate) mod meshing;
pub(crate) mod moving;
pub(crate) mod quality;
pub(crate) mod refine;
pub(crate) mod remesh;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod shell;
pub(crate) mod surface;
pub(crate) mod view;
pub(crate) mod wall;
