//! Files: written and read back in each format, whole or in parts, on any number of threads.

mod formats;
mod parts;
mod threads;
mod vtk;
