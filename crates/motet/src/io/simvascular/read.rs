//! Reads a folder into one mesh.
//!
//! Points of a face are matched to the volume by `GlobalNodeID`, or by equal coordinates if a file has none.
//! Triangles of faces follow the cells of the volume, with the array `patch`: `ModelFaceID` if each face has
//! a distinct one, else consecutive numbers in the order of the file names. Patches are named after the
//! files.
//!
//! A volume without regions becomes a single region with label 1.
//!
//! Arrays on cells continue over the triangles if the face has them under the same name (`GlobalElementID`:
//! the element behind the triangle); otherwise the values are 0, or NaN for real numbers.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::base::{Error, Result, VertexId};
use crate::io::format::Input;
use crate::io::reading::read_file;
use crate::io::simvascular::{FACE_ID, NODE_ID, SURFACES, VOLUME};
use crate::io::tags::Tags;
use crate::io::vtkxml;
use crate::mesh::{Field, Mesh, Values};

/// The files of a folder.
struct Layout {
    volume: PathBuf,
    /// Name and file of each face, sorted by name.
    faces: Vec<(String, PathBuf)>,
}

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let layout = Layout::of(input.path)?;
    let mut mesh = read_file(&vtkxml::VTU, &layout.volume, input.threads, input.notes)?;
    let by_id = node_ids(&mesh).map(|ids| Tags::new(&ids, NODE_ID)).transpose();
    let by_id = by_id.map_err(|e| e.in_file(&layout.volume))?;
    let point_index = PointIndex::new(&mesh);
    if mesh.regions().is_none() {
        let region =
            mesh.cells.kinds().iter().map(|kind| i32::from(kind.dim() == Some(3))).collect::<Vec<_>>();
        mesh.set_cell_field(Field::scalars("region", region));
    }
    let mut labels = vec![0; mesh.cells.len()];
    let mut faces = Vec::new();
    for (name, path) in &layout.faces {
        let face = read_file(&vtkxml::VTP, path, input.threads, input.notes)?;
        if face.cells.dim() == Some(3) {
            return Err(Error::input("contains volume cells, but a face must be a surface")
                .in_file(path)
                .remedy("write only the surface"));
        }
        let vertices = match (&by_id, node_ids(&face)) {
            (Some(tags), Some(ids)) => vertices_by_id(tags, &ids),
            _ => point_index.vertices_of(&face),
        };
        let vertices = vertices.map_err(|e| e.in_file(path))?;
        faces.push((name, face, vertices));
    }
    let face_labels = face_labels(faces.iter().map(|(_, face, _)| face));
    for ((name, face, vertices), label) in faces.iter().zip(&face_labels) {
        for (_, kind, cell) in face.cells.iter() {
            mesh.cells.push(kind, cell.iter().map(|v| vertices[v.index()]));
        }
        labels.resize(mesh.cells.len(), *label);
        mesh.label_names.patches.insert(*label, (*name).clone());
        extend_arrays(&mut mesh, face);
    }
    mesh.set_cell_field(Field::scalars("patch", labels));
    Ok(mesh)
}

impl Layout {
    fn of(folder: &Path) -> Result<Self> {
        let complete = folder.join(VOLUME);
        if complete.is_file() {
            let faces = files(&folder.join(SURFACES), "vtp")?;
            if faces.is_empty() {
                return Err(Error::input("there are no faces (*.vtp)").in_file(folder.join(SURFACES)));
            }
            return Ok(Self { volume: complete, faces });
        }
        let volumes = files(folder, "vtu")?;
        let surfaces = files(folder, "vtp")?;
        let faces_of = |stem: &str| -> Vec<(String, PathBuf)> {
            let face = |(name, path): &(String, PathBuf)| {
                let name = name.strip_prefix(stem)?.strip_prefix('_')?;
                Some((name.to_owned(), path.clone()))
            };
            surfaces.iter().filter_map(face).collect()
        };
        let with_faces: Vec<_> = volumes
            .iter()
            .map(|(stem, path)| (stem, path, faces_of(stem)))
            .filter(|v| !v.2.is_empty())
            .collect();
        match &with_faces[..] {
            [(_, volume, faces)] => Ok(Self { volume: (*volume).clone(), faces: faces.clone() }),
            [] => Err(Error::input(
                "is a folder that contains neither mesh-complete.mesh.vtu with mesh-surfaces/*.vtp nor NAME.vtu with NAME_*.vtp",
            )
            .in_file(folder)
            .remedy("give one of the files in it")),
            many => {
                let names: Vec<&str> = many.iter().map(|v| v.0.as_str()).collect();
                Err(Error::input(format!("contains {} volumes: {}", many.len(), names.join(", ")))
                    .in_file(folder)
                    .remedy("put each into its own folder, or give one of the files"))
            }
        }
    }
}

/// Stem and path of the files with this extension, sorted by name; empty if the folder does not exist.
fn files(folder: &Path, extension: &str) -> Result<Vec<(String, PathBuf)>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|e| Error::io(folder, e))? {
        let path = entry.map_err(|e| Error::io(folder, e))?.path();
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
            && let Some(stem) = path.file_stem()
        {
            found.push((stem.to_string_lossy().into_owned(), path.clone()));
        }
    }
    found.sort();
    Ok(found)
}

pub(super) fn node_ids(mesh: &Mesh) -> Option<Vec<u64>> {
    let ids = mesh.point_field(NODE_ID).filter(|f| f.components == 1)?.values.to_i64()?;
    ids.into_iter().map(|id| u64::try_from(id).ok()).collect()
}

fn vertices_by_id(tags: &Tags, ids: &[u64]) -> Result<Vec<VertexId>> {
    let found: Vec<VertexId> = ids.iter().filter_map(|&id| tags.place(id).map(VertexId)).collect();
    if found.len() == ids.len() {
        return Ok(found);
    }
    let first = ids.iter().position(|&id| tags.place(id).is_none()).unwrap_or(0);
    Err(Error::input(format!(
        "{} of {} points have a {NODE_ID} that is not in the volume; the first is {}",
        ids.len() - found.len(),
        ids.len(),
        ids[first]
    ))
    .at(format!("point {first}"))
    .remedy("the face belongs to another volume"))
}

/// Vertices of the volume, indexed by exact coordinates.
struct PointIndex {
    places: HashMap<[u64; 3], VertexId>,
}

impl PointIndex {
    fn new(mesh: &Mesh) -> Self {
        let mut places = HashMap::new();
        for (i, point) in mesh.points.iter().enumerate() {
            places.entry(key(point)).or_insert(VertexId::new(i));
        }
        Self { places }
    }

    fn vertices_of(&self, face: &Mesh) -> Result<Vec<VertexId>> {
        let find = |point| self.places.get(&key(point)).copied();
        let missing: Vec<usize> =
            (0..face.points.len()).filter(|&i| find(&face.points[i]).is_none()).collect();
        match missing.first() {
            None => Ok(face.points.iter().filter_map(find).collect()),
            Some(first) => Err(Error::input(format!(
                "{} of {} points are not in the volume; the first is at {:?}",
                missing.len(),
                face.points.len(),
                face.points[*first]
            ))
            .at(format!("point {first}"))
            .remedy(format!("give both files the point array {NODE_ID}"))),
        }
    }
}

/// Hash key of a point; adding 0 turns -0 into 0.
fn key(point: &[f64; 3]) -> [u64; 3] {
    point.map(|x| (x + 0.0).to_bits())
}

/// A label for each face: its `ModelFaceID` if all faces have distinct positive ones, else consecutive
/// numbers.
fn face_labels<'f>(faces: impl Iterator<Item = &'f Mesh> + Clone) -> Vec<i32> {
    let own = |face: &Mesh| {
        let ids = face.cell_field(FACE_ID)?.values.to_i64()?;
        let first = *ids.first()?;
        ids.iter().all(|&id| id == first).then_some(i32::try_from(first).ok()?)
    };
    let labels: Option<Vec<i32>> = faces.clone().map(own).collect();
    let differ = |labels: &Vec<i32>| {
        let mut sorted = labels.clone();
        sorted.sort_unstable();
        sorted.windows(2).all(|w| w[0] < w[1]) && sorted.first().is_some_and(|&least| least > 0)
    };
    labels.filter(differ).unwrap_or_else(|| (1..).take(faces.count()).collect())
}

/// Extends the cell arrays of `mesh` over the cells of `face`, which have just been added.
fn extend_arrays(mesh: &mut Mesh, face: &Mesh) {
    let (n_all, n_face) = (mesh.cells.len(), face.cells.len());
    for theirs in &face.cell_data {
        if mesh.cell_field(&theirs.name).is_none() {
            let mut field = theirs.pick([]);
            pad(&mut field.values, (n_all - n_face) * theirs.components);
            mesh.cell_data.push(field);
        }
    }
    for ours in &mut mesh.cell_data {
        let theirs = face.cell_field(&ours.name).filter(|f| f.components == ours.components);
        if !theirs.is_some_and(|theirs| append(&mut ours.values, &theirs.values)) {
            pad(&mut ours.values, n_all * ours.components);
        }
    }
}

/// Appends values, converted to a type that holds both; returns false if there is none.
fn append(ours: &mut Values, theirs: &Values) -> bool {
    macro_rules! same {
        ($($variant:ident)*) => {
            match (&mut *ours, theirs) {
                $((Values::$variant(a), Values::$variant(b)) => { a.extend(b.iter().cloned()); return true; })*
                _ => {}
            }
        };
    }
    same!(I8 U8 I16 U16 I32 U32 I64 U64 F32 F64 Text);
    if let (true, Some(mut all), Some(more)) = (ours.is_integer(), ours.to_i64(), theirs.to_i64()) {
        all.extend(more);
        *ours = Values::I64(all);
        return true;
    }
    let (Some(mut all), Some(more)) = (ours.to_f64(), theirs.to_f64()) else { return false };
    all.extend(more);
    *ours = Values::F64(all);
    true
}

/// Pads to `n` values with 0, NaN or empty texts.
fn pad(values: &mut Values, n: usize) {
    macro_rules! zeros {
        ($($variant:ident)*) => {
            match values {
                $(Values::$variant(v) => v.resize(n, 0),)*
                Values::F32(v) => v.resize(n, f32::NAN),
                Values::F64(v) => v.resize(n, f64::NAN),
                Values::Text(v) => v.resize(n, String::new()),
            }
        };
    }
    zeros!(I8 U8 I16 U16 I32 U32 I64 U64);
}
