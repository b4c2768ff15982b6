//! Floor 3: files. `format` defines what a format is, each format has a file or folder of its own, and
//! `registry` lists them all.

mod abaqus;
mod cdb;
mod cell_labels;
mod cells_of_faces;
mod cgns;
mod dolfin;
mod exodus;
mod facet_key;
mod fluent;
mod foreign;
mod format;
mod ghosts;
mod gltf;
mod gzip;
mod hdf;
#[cfg(test)]
mod in_memory;
mod label_numbers;
mod labels;
mod latin;
mod legacy;
mod lock;
mod med;
mod medit;
mod memory_budget;
mod msh;
mod named_sets;
mod nastran;
mod netgen;
mod nodal;
mod node_order;
mod obj;
mod off;
mod opencarp;
mod output;
mod owned_faces;
mod ply;
mod polygonal;
mod polyhedra;
mod polymesh;
mod reading;
mod registry;
mod replace;
mod scalar;
mod segments;
mod select;
mod series;
mod simvascular;
mod stl;
mod su2;
mod surplus_points;
mod tags;
mod tetgen;
mod text;
mod unv;
mod vtkhdf;
mod vtkxml;
mod weld;
mod xdmf;

pub use format::{Compression, Encoding, Format, Input, Notes, Read, Write, WriteOptions, Written};
pub use lock::OutputLock;
pub use nodal::NodalSeries;
pub use output::Output;
pub use reading::{is_same_file, read_as};
pub use registry::{can_write, formats, read, read_noted, read_on, write, write_on};
pub use replace::{can_have_folder, remove_drafts, replace, replace_all, settle, sync};
pub use segments::read_segments;
pub use series::{
    SeriesWriter, can_be_series, can_write_series, file_of, is_series, parse_series, read_series,
    write_series,
};
