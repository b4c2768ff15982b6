//! Reads a mesh.

use std::path::Path;

use crate::base::{Error, Result};
use crate::io::cells_of_faces::{Sides, push_face};
use crate::io::format::{Input, Notes};
use crate::io::polymesh::file::File;
use crate::io::polymesh::folder::{load, mesh_folder};
use crate::mesh::{Field, Mesh};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let folder = mesh_folder(input.path).ok_or_else(|| {
        Error::input(
            "there is no polyMesh: points, faces and owner are neither here nor in constant/polyMesh",
        )
        .in_file(input.path)
        .remedy("give the case, or its polyMesh folder")
    })?;
    let points = required(&folder, "points", |file| file.points())?;
    let faces = required(&folder, "faces", |file| file.faces())?;
    let owner = required(&folder, "owner", |file| file.labels())?;
    let neighbour = required(&folder, "neighbour", |file| file.labels())?;
    let patches = required(&folder, "boundary", patches)?;
    let in_folder = |e: Error| e.in_file(&folder);
    let sides = Sides::new(&faces, &owner, &neighbour, points.len()).map_err(in_folder)?;
    let mut mesh = Mesh::new(points, sides.cells());
    let n_cells = mesh.cells.len();
    let mut labels = vec![0; n_cells];
    for (label, patch) in (1..).zip(&patches) {
        let end = patch.start.checked_add(patch.n).filter(|&end| end <= faces.len());
        let end = end.ok_or_else(|| {
            in_folder(Error::input(format!(
                "patch {} extends beyond the {} faces of the mesh",
                patch.name,
                faces.len()
            )))
        })?;
        for face in patch.start..end {
            push_face(&mut mesh.cells, faces.list(face));
        }
        labels.resize(mesh.cells.len(), label);
        mesh.label_names.patches.insert(label, patch.name.clone());
    }
    zones(&folder, &mut mesh, n_cells, input.notes)?;
    mesh.set_cell_field(Field::scalars("patch", labels));
    for other in ["faceZones", "pointZones"] {
        let is_there = load(&folder, other)?.is_some_and(|(_, bytes)| !bytes.ends_with(b"0()"));
        if is_there && has_entries(&folder, other)? {
            input.notes.add(format!("{other} are skipped"));
        }
    }
    Ok(mesh)
}

/// Reads a required file.
fn required<T>(folder: &Path, name: &str, read: impl Fn(&mut File<'_>) -> Result<T>) -> Result<T> {
    optional(folder, name, read)?.ok_or_else(|| {
        Error::input("is missing")
            .in_file(folder.join(name))
            .remedy("a polyMesh has points, faces, owner, neighbour and boundary")
    })
}

fn optional<T>(folder: &Path, name: &str, read: impl Fn(&mut File<'_>) -> Result<T>) -> Result<Option<T>> {
    let Some((path, bytes)) = load(folder, name)? else { return Ok(None) };
    File::open(&bytes).and_then(|mut file| read(&mut file)).map(Some).map_err(|e| e.in_file(path))
}

fn has_entries(folder: &Path, name: &str) -> Result<bool> {
    Ok(optional(folder, name, |file| file.count())?.is_some_and(|n| n > 0))
}

struct Patch {
    name: String,
    start: usize,
    n: usize,
}

/// Reads the patches of `boundary`.
fn patches(file: &mut File<'_>) -> Result<Vec<Patch>> {
    let n = file.count()?;
    file.expect(b"(")?;
    let mut patches = Vec::new();
    for _ in 0..n {
        let name = String::from_utf8_lossy(file.word()?).trim_matches('"').to_owned();
        file.expect(b"{")?;
        let (mut start, mut faces) = (None, None);
        loop {
            match file.word()? {
                b"}" => break,
                b"startFace" => start = Some(file.count()?),
                b"nFaces" => faces = Some(file.count()?),
                _ => {}
            }
            file.skip_entry()?;
        }
        let (Some(start), Some(n)) = (start, faces) else {
            return Err(file.error(format!("patch {name} has no startFace or no nFaces")));
        };
        patches.push(Patch { name, start, n });
    }
    file.expect(b")").map(|()| patches)
}

/// Reads the cell zones as regions.
fn zones(folder: &Path, mesh: &mut Mesh, n_cells: usize, notes: &Notes) -> Result<()> {
    let zones = optional(folder, "cellZones", |file| {
        let n = file.count()?;
        if n == 0 {
            return Ok(Vec::new());
        }
        file.expect(b"(")?;
        let mut zones = Vec::new();
        for _ in 0..n {
            let name = String::from_utf8_lossy(file.word()?).trim_matches('"').to_owned();
            file.expect(b"{")?;
            loop {
                match file.word()? {
                    b"}" => break,
                    b"cellLabels" => {
                        if file.peek().starts_with(b"List") {
                            file.word()?;
                        }
                        zones.push((name.clone(), file.labels()?));
                    }
                    _ => {}
                }
                file.skip_entry()?;
            }
        }
        file.expect(b")").map(|()| zones)
    })?;
    let Some(zones) = zones.filter(|zones| !zones.is_empty()) else { return Ok(()) };
    let mut regions = vec![0; mesh.cells.len()];
    for (label, (name, cells)) in (1..).zip(zones) {
        for cell in cells {
            let place = usize::try_from(cell).ok().filter(|&cell| cell < n_cells).ok_or_else(|| {
                Error::input(format!(
                    "zone {name} refers to cell {cell}, but there are {n_cells} cells, numbered from 0"
                ))
                .in_file(folder.join("cellZones"))
            })?;
            if regions[place] != 0 {
                notes.add("for cells in several zones, only the first is used");
            } else {
                regions[place] = label;
            }
        }
        mesh.label_names.regions.insert(label, name);
    }
    mesh.set_cell_field(Field::scalars("region", regions));
    Ok(())
}
