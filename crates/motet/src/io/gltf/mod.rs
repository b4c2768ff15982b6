//! glTF 2.0: the triangles of a scene, from binary files (`.glb`) and from text with its buffers inside
//! (`.gltf`).
//!
//! Implemented here because `gltf` (1.4) reads ranges of buffers unchecked. Each primitive is a patch, named
//! by its node or mesh; points at the same place are merged, since files repeat them where normals or texture
//! coordinates differ. Axes and unit stay as they are (by convention y up, metres).

mod buffers;
mod document;
mod transform;

use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::{Format, Input};
use crate::io::memory_budget::MemoryBudget;
use crate::io::weld::keep_points;
use crate::mesh::{CellKind, Cells, Field, Mesh, firsts_at_place, unused_name};
use buffers::{Buffers, damaged};
use document::{Document, Primitive};
use transform::Transform;

pub(super) const FORMAT: Format =
    Format { name: "glTF", extensions: &[".glb", ".gltf"], read: Some(read), write: None };

/// The first bytes of a binary file.
const MAGIC: &[u8] = b"glTF";

/// The kinds of chunks of a binary file.
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// Modes of primitives: separate triangles, a strip, a fan.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// Bytes of a point and of a triangle in memory.
const BYTES: [u64; 2] = [24, 32];

fn read(input: &Input<'_>) -> Result<Mesh> {
    let (text, binary) = chunks(input.bytes)?;
    let document: Document = serde_json::from_slice(text).map_err(|e| damaged(format!("its JSON: {e}")))?;
    if let Some(extension) = document.extensions_required.iter().find(|name| !is_harmless(name)) {
        return Err(Error::input(format!("the scene requires the extension {extension}, which is not read"))
            .remedy("export it without compression of meshes"));
    }
    let buffers = Buffers::new(&document, binary)?;
    let mut reader = Reader {
        document: &document,
        buffers,
        budget: MemoryBudget::of(input.bytes.len() as u64),
        input,
        points: Vec::new(),
        triangles: Vec::new(),
        patches: Vec::new(),
        names: Vec::new(),
    };
    reader.scene()?;
    reader.into_mesh()
}

/// Whether an extension that a scene requires changes no triangle.
fn is_harmless(extension: &str) -> bool {
    extension.starts_with("KHR_materials_") || extension == "KHR_texture_transform"
}

/// The JSON text of a file, and the binary chunk after it.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    if !bytes.starts_with(MAGIC) {
        return Ok((bytes, None));
    }
    let version = bytes.get(4..8).map(|b| b[0]);
    if version != Some(2) {
        return Err(Error::input("is not of version 2 of glTF").remedy("export the scene as glTF 2.0"));
    }
    let (mut rest, mut found) = (bytes.get(12..).unwrap_or_default(), [None, None]);
    while let (Some(head), Some(kind)) = (rest.get(..4), rest.get(4..8)) {
        let length = u32::from_le_bytes(std::array::from_fn(|i| head[i])) as usize;
        let chunk = rest.get(8..).and_then(|after| after.get(..length));
        let chunk = chunk.ok_or_else(|| damaged("a chunk ends beyond the file"))?;
        let place = if kind == JSON { 0 } else { 1 };
        if (kind == JSON || kind == BIN) && found[place].is_none() {
            found[place] = Some(chunk);
        }
        rest = &rest[8 + length..];
    }
    let [text, binary] = found;
    Ok((text.ok_or_else(|| damaged("the file has no JSON"))?, binary))
}

struct Reader<'a> {
    document: &'a Document,
    buffers: Buffers<'a>,
    budget: MemoryBudget,
    input: &'a Input<'a>,
    points: Vec<Point>,
    triangles: Vec<[VertexId; 3]>,
    patches: Vec<i32>,
    names: Vec<String>,
}

impl Reader<'_> {
    /// Reads the nodes of the scene, from its roots on; without a scene, those that are no children.
    fn scene(&mut self) -> Result<()> {
        let document = self.document;
        let scene = document.scenes.get(document.scene.unwrap_or(0));
        let mut is_child = vec![false; document.nodes.len()];
        let children = document.nodes.iter().flat_map(|node| &node.children);
        children.filter(|&&c| c < document.nodes.len()).for_each(|&c| is_child[c] = true);
        let roots: Vec<usize> = match scene {
            Some(scene) => scene.nodes.clone(),
            None => (0..document.nodes.len()).filter(|&i| !is_child[i]).collect(),
        };
        let mut is_read = vec![false; document.nodes.len()];
        let mut todo: Vec<(usize, Transform)> =
            roots.into_iter().rev().map(|i| (i, Transform::IDENTITY)).collect();
        while let Some((i, above)) = todo.pop() {
            let node = document.nodes.get(i).ok_or_else(|| damaged(format!("node {i} does not exist")))?;
            if std::mem::replace(&mut is_read[i], true) {
                return Err(damaged(format!("node {i} is a child twice")));
            }
            let here = above.then(&Transform::of(node));
            if let Some(mesh) = node.mesh {
                self.mesh(mesh, node.name.as_deref(), &here)?;
                if node.skin.is_some() {
                    self.input.notes.add("skins are skipped: meshes are in their rest position");
                }
            }
            todo.extend(node.children.iter().rev().map(|&child| (child, here)));
        }
        Ok(())
    }

    fn mesh(&mut self, id: usize, node: Option<&str>, transform: &Transform) -> Result<()> {
        let mesh =
            self.document.meshes.get(id).ok_or_else(|| damaged(format!("mesh {id} does not exist")))?;
        let name = node.or(mesh.name.as_deref()).unwrap_or("part").to_owned();
        for primitive in &mesh.primitives {
            let name = unused_name(&name, |name| self.names.iter().any(|known| known == name));
            self.primitive(primitive, transform)?;
            self.names.push(name);
            self.patches.resize(self.triangles.len(), self.names.len() as i32);
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive, transform: &Transform) -> Result<()> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        if ![TRIANGLES, STRIP, FAN].contains(&mode) {
            self.input.notes.add("points and lines of the scene are skipped");
            return Ok(());
        }
        let places =
            primitive.attributes.get("POSITION").ok_or_else(|| damaged("a primitive has no POSITION"))?;
        let count = |id: usize| self.document.accessors.get(id).map_or(0, |accessor| accessor.count as u64);
        let n_corners = primitive.indices.map_or(count(*places), count);
        self.budget.take(BYTES[0].saturating_mul(count(*places)))?;
        self.budget.take(BYTES[1].saturating_mul(n_corners))?;
        let own = self.buffers.places(*places)?;
        let indices = match primitive.indices {
            Some(id) => self.buffers.indices(id)?,
            None => (0..own.len() as u32).collect(),
        };
        if let Some(off) = indices.iter().find(|&&v| v as usize >= own.len()) {
            return Err(damaged(format!("a triangle refers to vertex {off} of {}", own.len())));
        }
        let first = self.points.len();
        if first + own.len() > VertexId::MAX_COUNT {
            return Err(
                Error::input("the scene has more points than there are ids").remedy("export parts of it")
            );
        }
        self.points.extend(own.into_iter().map(|p| transform.of_point(p)));
        let id = |v: u32| VertexId::new(first + v as usize);
        let corners: Vec<[u32; 3]> = match mode {
            STRIP => indices
                .windows(3)
                .enumerate()
                .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
                .collect(),
            FAN => {
                indices.get(1..).unwrap_or_default().windows(2).map(|w| [indices[0], w[0], w[1]]).collect()
            }
            _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        };
        let is_mirror = transform.is_mirror();
        let turned = |[a, b, c]: [u32; 3]| if is_mirror { [a, c, b] } else { [a, b, c] };
        self.triangles.extend(corners.into_iter().map(|t| turned(t).map(id)));
        Ok(())
    }

    fn into_mesh(self) -> Result<Mesh> {
        if self.triangles.is_empty() {
            return Err(Error::input("the scene has no triangles").remedy("export its meshes, too"));
        }
        let cells = Cells::uniform(CellKind::TRIANGLE, self.triangles.into_flattened())?;
        let mut mesh = Mesh::new(self.points, cells);
        let firsts = firsts_at_place(&mesh.points);
        let kept: Vec<usize> = (0..firsts.len()).filter(|&v| firsts[v].index() == v).collect();
        if kept.len() < firsts.len() {
            let mut new = vec![VertexId::default(); firsts.len()];
            kept.iter().enumerate().for_each(|(i, &v)| new[v] = VertexId::new(i));
            (0..firsts.len()).for_each(|v| new[v] = new[firsts[v].index()]);
            keep_points(&mut mesh, &kept, &new);
        }
        if self.names.len() > 1 {
            mesh.set_cell_field(Field::scalars("patch", self.patches));
            mesh.label_names.patches = (1..).zip(self.names).collect();
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests;
