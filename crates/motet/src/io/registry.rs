//! Determines the format of a file, and reads and writes files of any format.

use std::path::{Path, PathBuf};

use crate::base::{Error, Result, Threads};
use crate::io::format::{Format, Notes, Write, WriteOptions};
use crate::io::reading::{checked, read_file};
use crate::io::replace::{can_have_folder, replace_all, replace_folder, replace_with};
use crate::io::{
    abaqus, cdb, cgns, dolfin, exodus, fluent, foreign, gltf, legacy, med, medit, msh, nastran, netgen, obj,
    off, opencarp, ply, polymesh, simvascular, stl, su2, tetgen, unv, vtkhdf, vtkxml, xdmf,
};
use crate::mesh::Mesh;

/// Every format, in the order in which extensions are looked up.
pub fn formats() -> &'static [Format] {
    FORMATS
}

const FORMATS: &[Format] = &[
    vtkxml::VTU,
    vtkxml::VTP,
    vtkxml::PARTS,
    legacy::VTK,
    vtkhdf::FORMAT,
    cgns::FORMAT,
    msh::FORMAT,
    stl::FORMAT,
    obj::FORMAT,
    ply::FORMAT,
    off::FORMAT,
    gltf::FORMAT,
    medit::MESH,
    medit::MESHB,
    medit::SOL,
    medit::SOLB,
    abaqus::FORMAT,
    tetgen::FORMAT,
    su2::FORMAT,
    opencarp::FORMAT,
    netgen::VOL,
    netgen::VOL_GZ,
    unv::FORMAT,
    nastran::FORMAT,
    cdb::FORMAT,
    fluent::FORMAT,
    fluent::HDF5,
    med::FORMAT,
    exodus::FORMAT,
    xdmf::FORMAT,
    dolfin::FORMAT,
    polymesh::FORMAT,
    simvascular::FORMAT,
];

/// Formats that are only recognized to reject them with advice.
const REFUSED: &[Format] = &[vtkxml::OTHERS];

fn by_extension(path: &Path) -> Result<&'static Format> {
    let name = path.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
    let mut all = FORMATS.iter().chain(REFUSED);
    all.find(|f| f.extensions.iter().any(|e| name.ends_with(e))).ok_or_else(|| {
        if let Some(error) = foreign::by_extension(path) {
            return error;
        }
        let known: Vec<_> = FORMATS.iter().flat_map(|f| f.extensions).copied().collect();
        Error::input("no format has this file extension")
            .in_file(path)
            .remedy(format!("known extensions: {}", known.join(" ")))
    })
}

/// The format in which to write `path`: a folder format if the path ends with a slash or is a folder.
fn for_writing(path: &Path) -> Result<&'static Format> {
    let ends_with_slash =
        path.as_os_str().as_encoded_bytes().last().is_some_and(|&b| std::path::is_separator(b.into()));
    if polymesh::is_polymesh_name(path) {
        return Ok(&polymesh::FORMAT);
    }
    if ends_with_slash {
        return Ok(&simvascular::FORMAT);
    }
    let format = by_extension(path);
    if path.is_dir() {
        return match format {
            Ok(format) if !format.is_folder() => {
                Err(Error::options(format!("is a folder, but its name is that of a file ({})", format.name))
                    .in_file(path)
                    .remedy("choose another file name, or append a slash to the folder name"))
            }
            _ => Ok(&simvascular::FORMAT),
        };
    }
    let format = format?;
    match format.is_folder() {
        true => Err(Error::options("is a marker file for ParaView and cannot hold a mesh")
            .in_file(path)
            .remedy("give the folder: constant/polyMesh")),
        false => Ok(format),
    }
}

/// Checks whether a mesh can be written to `path`, so that a long run can check before it starts: the
/// extension must belong to a format with a writer, and its folder must exist or be one that can be made.
///
/// # Errors
/// Of kind [`ErrorKind::Options`](crate::ErrorKind::Options) for the extension or a non-empty target folder,
/// [`ErrorKind::Io`](crate::ErrorKind::Io) for a file in the place of its folder.
pub fn can_write(path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    let writable = match for_writing(path) {
        Err(error) if path.is_dir() => return Err(error),
        format => format.is_ok_and(|f| f.write.is_some()),
    };
    if let Some(error) = for_writing(path).ok().and_then(|format| written_otherwise(format, path)) {
        return Err(error);
    }
    if !writable {
        let known: Vec<_> =
            FORMATS.iter().filter(|f| f.write.is_some()).flat_map(|f| f.extensions).copied().collect();
        return Err(Error::options("no format with this file extension can be written")
            .in_file(path)
            .remedy(format!("writable extensions: {}", known.join(" "))));
    }
    refuse_full_folder(path)?;
    can_have_folder(path)
}

/// The error for a form of files that is only read, of programs whose files are written in another form.
fn written_otherwise(format: &Format, path: &Path) -> Option<Error> {
    format.extensions.contains(&".cas.h5").then(|| {
        Error::options(format!("{} files can only be read", format.name))
            .in_file(path)
            .remedy("write .cas, the form in text, which Fluent reads as .msh, too")
    })
}

/// Rejects a non-empty folder as a target, so that nothing is lost and no old files remain among new ones.
fn refuse_full_folder(path: &Path) -> Result<()> {
    match path.read_dir().map(|mut entries| entries.next().is_some()) {
        Ok(true) => Err(Error::options("is a folder that is not empty")
            .in_file(path)
            .remedy("give a new or empty folder")),
        _ => Ok(()),
    }
}

/// The format of an existing folder.
fn folder_format(path: &Path) -> &'static Format {
    if polymesh::is_case(path) { &polymesh::FORMAT } else { &simvascular::FORMAT }
}

/// Reads a file or folder in the format of its extension; `flow.vtkhdf#3` is step 3 of that file.
///
/// # Errors
/// An error names the file and the place in it, what was expected and found, and a remedy.
pub fn read(path: impl AsRef<Path>) -> Result<Mesh> {
    read_noted(path).map(|(mesh, _)| mesh)
}

/// Reads like [`read`], and also returns notes on what the reader skipped, each a message for the user.
///
/// # Errors
/// The errors of [`read`].
pub fn read_noted(path: impl AsRef<Path>) -> Result<(Mesh, Vec<String>)> {
    read_on(path, &Threads::single())
}

/// Reads like [`read_noted`], on several threads where the format allows it. The mesh does not depend on
/// them.
///
/// # Errors
/// The errors of [`read`].
pub fn read_on(path: impl AsRef<Path>, threads: &Threads) -> Result<(Mesh, Vec<String>)> {
    let path = path.as_ref();
    let notes = Notes::default();
    if let Some(step) = vtkhdf::StepPath::of(path) {
        let mesh = checked(vtkhdf::read_step(&step, &notes), path, &notes)?;
        return Ok((mesh, notes.into_vec()));
    }
    let format = if path.is_dir() { folder_format(path) } else { by_extension(path)? };
    let mesh = read_file(format, path, threads, &notes)?;
    Ok((mesh, notes.into_vec()))
}

/// Writes a mesh in the format of the extension. The file appears whole or not at all: it is written to a
/// temporary file beside `path`, which is then renamed.
///
/// Returns what the format could not hold.
///
/// # Errors
/// If the format cannot hold the mesh, or the file cannot be written.
pub fn write(path: impl AsRef<Path>, mesh: &Mesh, options: &WriteOptions) -> Result<Vec<String>> {
    write_on(path, mesh, options, &Threads::single())
}

/// Writes like [`write()`], on several threads where the format allows it. The bytes do not depend on them.
///
/// # Errors
/// The errors of [`write()`].
pub fn write_on(
    path: impl AsRef<Path>,
    mesh: &Mesh,
    options: &WriteOptions,
    threads: &Threads,
) -> Result<Vec<String>> {
    let path = path.as_ref();
    let format = for_writing(path)?;
    let only_read = || written_otherwise(format, path).unwrap_or_else(|| format.only_read().in_file(path));
    let write = format.write.ok_or_else(only_read)?;
    mesh.validate()?;
    let written = match write {
        Write::File(write) => {
            let (mut lost, note) = replace_with(path, threads, |output| write(mesh, options, output))?;
            lost.extend(note);
            return Ok(lost);
        }
        Write::Files(write) => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            write(mesh, options, threads, &stem).map_err(|e| e.in_file(path))?
        }
    };
    if format.is_folder() {
        refuse_full_folder(path)?;
        replace_folder(path, &written.files)?;
        return Ok(written.lost);
    }
    let files =
        written.files.iter().map(|(extension, bytes)| (with_extension(path, extension), bytes.as_slice()));
    let notes = replace_all(&files.collect::<Vec<_>>())?;
    Ok([written.lost, notes].concat())
}

/// `path` with its extension replaced; unchanged if `extension` is empty.
fn with_extension(path: &Path, extension: &str) -> PathBuf {
    if extension.is_empty() {
        path.to_owned()
    } else {
        path.with_extension(extension.trim_start_matches('.'))
    }
}
