//! Files of other programs that motet does not read: reports what they are, and a program that converts them.

use std::path::Path;

use crate::base::{Error, Result};

/// A foreign file type and how to convert it; `FILE` in the remedy stands for the name of the file.
struct ForeignFormat {
    name: &'static str,
    extensions: &'static [&'static str],
    remedy: &'static str,
}

const MESHIO: &str = "convert it with meshio (pip install meshio): meshio convert FILE mesh.vtu";
const MESHIO_HDF: &str = "convert it with meshio (pip install meshio[all]): meshio convert FILE mesh.vtu";
const PARAVIEW: &str = "open it in ParaView and save the data as .vtu";
const CAD: &str = "mesh it first: gmsh -2 -format stl FILE -o surface.stl (a surface), or gmsh -3 -format msh41 FILE -o mesh.msh";
const GEOMETRY: &str = "mesh the geometry first: gmsh -3 -format msh41 FILE -o mesh.msh";
const TRIMESH: &str = "convert it with trimesh (pip install trimesh) or Blender, to .stl, .obj or .ply";

const FOREIGN: &[ForeignFormat] = &[
    ForeignFormat {
        name: "a solution of Ansys Fluent without its mesh",
        extensions: &[".dat.h5"],
        remedy: "read the mesh from the case (.cas.h5); for the solution, open the case in ParaView and save the data as .vtu",
    },
    ForeignFormat { name: "an XDMF file of version 2", extensions: &[".xdmf2"], remedy: MESHIO_HDF },
    ForeignFormat {
        name: "an HDF5 file of an unknown kind",
        extensions: &[".h5", ".hdf5"],
        remedy: "give it the extension of its format: .vtkhdf, .cgns, .exo, .med or .cas.h5; of XDMF, give the .xdmf file beside it",
    },
    ForeignFormat { name: "a MOAB file", extensions: &[".h5m"], remedy: MESHIO_HDF },
    ForeignFormat {
        name: "an openCARP mesh in binary form",
        extensions: &[".bpts", ".belem", ".blon"],
        remedy: "convert it to text with meshtool: meshtool convert -imsh=FILE -ifmt=carp_bin -omsh=mesh -ofmt=carp_txt",
    },
    ForeignFormat { name: "a UGRID file", extensions: &[".ugrid"], remedy: MESHIO },
    ForeignFormat { name: "a FLAC3D grid", extensions: &[".f3grid"], remedy: MESHIO },
    ForeignFormat { name: "a Kratos model part", extensions: &[".mdpa"], remedy: MESHIO },
    ForeignFormat { name: "an AVS-UCD file", extensions: &[".avs"], remedy: MESHIO },
    ForeignFormat {
        name: "a Permas file",
        extensions: &[".post", ".post.gz", ".dato", ".dato.gz"],
        remedy: MESHIO,
    },
    ForeignFormat { name: "a Tecplot file", extensions: &[".plt", ".szplt", ".tec"], remedy: PARAVIEW },
    ForeignFormat {
        name: "an EnSight file",
        extensions: &[".case", ".encas", ".geo.ensight"],
        remedy: PARAVIEW,
    },
    ForeignFormat {
        name: "an LS-DYNA file",
        extensions: &[".k", ".key", ".dyn", ".d3plot"],
        remedy: PARAVIEW,
    },
    ForeignFormat {
        name: "a result of Ansys Mechanical",
        extensions: &[".rst", ".rth"],
        remedy: "convert it with ansys-mapdl-reader (pip install ansys-mapdl-reader), which saves .vtk",
    },
    ForeignFormat {
        name: "a COMSOL file",
        extensions: &[".mphtxt", ".mphbin"],
        remedy: "export it from COMSOL as .nas",
    },
    ForeignFormat { name: "a Gmsh geometry", extensions: &[".geo", ".geo_unrolled"], remedy: GEOMETRY },
    ForeignFormat {
        name: "a CAD model",
        extensions: &[".step", ".stp", ".iges", ".igs", ".brep"],
        remedy: CAD,
    },
    ForeignFormat {
        name: "a surface of a 3D scene",
        extensions: &[".3mf", ".dae", ".fbx", ".usd", ".usdz", ".x3d", ".wrl", ".3ds", ".amf"],
        remedy: TRIMESH,
    },
    ForeignFormat {
        name: "an image",
        extensions: &[".nii", ".nii.gz", ".nrrd", ".mha", ".mhd", ".dcm", ".tif", ".tiff"],
        remedy: "segment it first, for example with 3D Slicer, and save the surface as .stl or .vtp",
    },
    ForeignFormat {
        name: "a compressed file",
        extensions: &[".gz", ".zip", ".bz2", ".xz", ".zst", ".tar", ".7z"],
        remedy: "decompress it first",
    },
];

/// The error for a file in a format of another program, recognized by its extension; `None` for other
/// extensions.
pub(super) fn by_extension(path: &Path) -> Option<Error> {
    let name = path.file_name()?.to_string_lossy().to_lowercase();
    FOREIGN
        .iter()
        .find(|f| f.extensions.iter().any(|e| name.ends_with(e)))
        .map(|f| not_supported(f.name, f.remedy, path))
}

fn not_supported(what: &str, remedy: &str, path: &Path) -> Error {
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Error::input(format!("is {what}, which motet does not read"))
        .in_file(path)
        .remedy(remedy.replace("FILE", &file))
}

/// Rejects content of another program, whatever the extension; `extensions` are those of the expected format.
pub(super) fn refuse(path: &Path, bytes: &[u8], extensions: &[&str]) -> Result<()> {
    let is = |extension: &str| extensions.contains(&extension);
    let start = bytes.trim_ascii_start();
    let named = |what: &str, remedy: &str| Err(not_supported(what, remedy, path));
    let misnamed = |what: &str, extensions: &str| {
        let error = Error::input(format!("is {what}, but has the extension of another format"));
        Err(error.in_file(path).remedy(format!("give it the extension of its format: {extensions}")))
    };
    if bytes.starts_with(b"CDF") && matches!(bytes.get(3), Some(1 | 2 | 5)) && !is(".exo") {
        return misnamed("a netCDF file, perhaps Exodus II", ".exo");
    }
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xfd7zXZ\x00") || bytes.starts_with(b"BZh") {
        return named("a compressed file", "decompress it first");
    }
    if bytes.starts_with(b"\x1f\x8b") && !extensions.iter().any(|e| e.ends_with(".gz")) {
        return named("a gzip file", "decompress it first: gunzip -c FILE");
    }
    if bytes.starts_with(b"\x89HDF\r\n\x1a\n")
        && ![".cgns", ".vtkhdf", ".exo", ".med", ".cas.h5"].into_iter().any(is)
    {
        return misnamed("an HDF5 file", ".vtkhdf, .cgns, .exo, .med, or of Fluent .cas.h5 or .msh.h5");
    }
    if start.starts_with(b"ISO-10303-21") {
        return named("a CAD model (STEP)", CAD);
    }
    let head = &start[..start.len().min(400)];
    let has = |word: &[u8]| head.windows(word.len()).any(|w| w.eq_ignore_ascii_case(word));
    if has(b"<xdmf") && !is(".xdmf") {
        return misnamed("an XDMF file", ".xdmf");
    }
    if is(".mesh") && (start.starts_with(b"<") || start.starts_with(b"$MeshFormat")) {
        return Err(Error::input("is not a Medit mesh")
            .in_file(path)
            .remedy("give it the extension of its format, such as .msh for Gmsh"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_files_are_reported_with_a_converter() {
        let of = |name: &str| by_extension(Path::new(name)).map(|e| e.to_string()).unwrap_or_default();
        assert!(
            of("a/Wing.H5M").contains("MOAB file")
                && of("a/Wing.H5M").contains("meshio convert Wing.H5M mesh.vtu")
        );
        assert!(
            of("x.xdmf2").contains("XDMF")
                && of("x.step").contains("gmsh")
                && of("x.dat.h5").contains("read the mesh from the case (.cas.h5")
                && of("x.h5").contains("give it the extension")
        );
        assert!(by_extension(Path::new("x.docx")).is_none());
    }

    #[test]
    fn foreign_content_is_recognized_under_any_extension() {
        let refused = |bytes: &[u8], extension: &str| {
            refuse(Path::new("f.msh"), bytes, &[extension]).err().map(|e| e.to_string()).unwrap_or_default()
        };
        assert!(refused(b"CDF\x01", ".vtu").contains("netCDF"));
        assert!(
            refused(b"\x1f\x8b\x08", ".vtu").contains("gunzip")
                && refused(b"\x1f\x8b\x08", ".xml.gz").is_empty()
        );
        assert!(refused(b"<?xml version='1.0'?><Xdmf>", ".xml").contains("XDMF"));
        assert!(refused(b"$MeshFormat\n", ".msh").is_empty() && refused(b"<VTKFile", ".vtu").is_empty());
    }
}
