//! The whole state of a moving mesh in a file, and back: a run that was stopped continues with the same
//! bytes.
//!
//! The file is a VTU that ParaView opens directly. Data besides the mesh is stored in arrays whose names
//! begin with `moving:`; they are removed on reading.

use std::path::Path;
use std::sync::Arc;

use crate::base::{CellId, Error, Point, Result, Threads, VertexId};
use crate::io::{self, Compression, WriteOptions};
use crate::mesh::{Field, Mesh, Values};
use crate::motion::Mover;
use crate::moving::current::{Current, LeftBad, Records};
use crate::moving::first_mesh::Returns;
use crate::moving::moving_mesh::{Clock, MovingMesh};
use crate::moving::options::Options;
use crate::moving::options_text::differences;
use crate::moving::sizes::{SizeMap, Sizes};
use crate::moving::wall::Wall;

const PREFIX: &str = "moving:";
const FIRST: &str = "moving:first";
const REST: &str = "moving:rest";
const BEFORE: &str = "moving:before";
const FIRST_EAS: &str = "moving:first_eas";
const REFERENCE: &str = "moving:reference";
const NODE: &str = "moving:node";
const PLACES: &str = "moving:wall_places";
const TRIANGLES: &str = "moving:wall_triangles";
const BODY: &str = "moving:wall_body";
const HELD: &str = "moving:wall_held";
const LEFT: &str = "moving:left";
/// Places, and the edge lengths wanted there: at first, and after the last refinement.
const SIZES: [[&str; 2]; 2] =
    [["moving:size_places", "moving:sizes"], ["moving:refined_size_places", "moving:refined_sizes"]];
const CLOCK: &str = "moving:clock";
const OPTIONS: &str = "moving:options";
const POINT_ARRAYS: &str = "moving:point_arrays";
const CELL_ARRAYS: &str = "moving:cell_arrays";
/// Separates the names of arrays: occurs in none of them, since XML does not allow it.
const BETWEEN: char = '\0';

impl MovingMesh {
    /// Writes everything that later steps depend on. Earlier changes are not included: after loading,
    /// [`Self::remembers`] none of them.
    ///
    /// # Errors
    /// The errors of [`io::write`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let Current { mesh, mover, records, left, .. } = &self.now;
        let clock = self.clock;
        let n_free = clock.n_free.map_or(f64::NAN, |n| n as f64);
        let mut file = mesh.clone();
        for (name, values) in [(FIRST, &records.first), (BEFORE, &records.before)] {
            file.set_point_field(Field::vectors(name, values));
        }
        if let Some(rest) = &records.rest {
            file.set_point_field(Field::vectors(REST, rest));
        }
        file.set_point_field(Field::vectors(REFERENCE, mover.reference()));
        file.set_point_field(Field::scalars(NODE, records.node.clone()));
        file.set_cell_field(Field::scalars(FIRST_EAS, records.first_eas.clone()));
        let triangles: Vec<u32> = self.wall.triangles.as_flattened().iter().map(|v| v.0).collect();
        file.field_data.extend([
            Field::vectors(PLACES, &self.wall.places),
            Field { components: 3, ..Field::scalars(TRIANGLES, triangles) },
            Field::scalars(CLOCK, vec![clock.step as f64, clock.time, clock.dt, n_free]),
        ]);
        file.field_data.extend(LeftBad::to_fields(left, LEFT));
        self.sizes.store_in(&mut file);
        self.returns.store_in(&mut file, &records.in_first);
        file.field_data.extend([
            text(OPTIONS, &self.options.to_json()?),
            text(POINT_ARRAYS, &names(&mesh.point_data)),
            text(CELL_ARRAYS, &names(&mesh.cell_data)),
        ]);
        if !self.wall.body.is_empty() {
            file.field_data.push(Field::scalars(BODY, self.wall.body.clone()));
        }
        if let Some(hold) = &self.hold {
            file.field_data.push(Field::vectors(HELD, &hold.last));
        }
        // Written after every step, read once: not worth compressing.
        let options = WriteOptions { compression: Compression::None, ..WriteOptions::default() };
        io::write(path, &file, &options).map(|_| ())
    }

    /// Continues from a file written by [`Self::save`], with the options it was saved with;
    /// [`Options::remembered`] may differ.
    ///
    /// # Errors
    /// If the file cannot be read or is not such a file, if other options are given (the error names them),
    /// and as for [`Self::new`].
    pub fn load(path: impl AsRef<Path>, options: Options, threads: &Threads) -> Result<Self> {
        let path = path.as_ref();
        let file = io::read(path)?;
        Self::from_state(file, options, threads).map_err(|e| match e.file() {
            Some(_) => e,
            None => e.in_file(path),
        })
    }

    fn from_state(mut mesh: Mesh, options: Options, threads: &Threads) -> Result<Self> {
        let mut arrays = StateArrays { fields: Vec::new() };
        for list in [&mut mesh.point_data, &mut mesh.cell_data, &mut mesh.field_data] {
            let is_ours = |field: &mut Field| field.name.starts_with(PREFIX);
            arrays.fields.extend(list.extract_if(.., is_ours));
        }
        let differ = differences(&arrays.text(OPTIONS)?, &options.to_json()?);
        if !differ.is_empty() {
            return Err(Error::options(format!("was saved with different options: {}", differ.join("; ")))
                .remedy("use the options it was saved with, or start a new run from its mesh"));
        }
        // Writers add arrays of labels if the mesh has them under other names.
        arrange(&mut mesh.point_data, &arrays.text(POINT_ARRAYS)?)?;
        arrange(&mut mesh.cell_data, &arrays.text(CELL_ARRAYS)?)?;
        let clock = arrays.floats(CLOCK)?;
        let &[step, time, dt, n_free] = clock.as_slice() else { return Err(damaged_state(CLOCK)) };
        let clock =
            Clock { step: step as usize, time, dt, n_free: (n_free >= 0.0).then_some(n_free as usize) };
        let wall = Wall {
            places: arrays.vectors(PLACES)?,
            triangles: triangles(&arrays.ids(TRIANGLES)?)?,
            body: match options.watch.as_ref().and_then(|watch| watch.hold) {
                Some(_) => arrays.ids(BODY)?,
                None => Vec::new(),
            },
        };
        let sizes = Sizes::from_state(&arrays)?;
        let (returns, in_first) = Returns::from_state(&arrays, &mesh, wall.places.len(), &options, threads)?;
        let records = Records {
            first: arrays.vectors(FIRST)?,
            rest: options.returns.then(|| arrays.vectors(REST)).transpose()?,
            before: arrays.vectors(BEFORE)?,
            node: arrays.ids(NODE)?,
            first_eas: arrays.floats(FIRST_EAS)?,
            in_first,
        };
        check(&wall, &records, [mesh.points.len(), mesh.cells.len()])?;
        let left = arrays.left(LEFT, mesh.cells.len())?;
        let here = std::mem::replace(&mut mesh.points, arrays.vectors(REFERENCE)?);
        let mover = Mover::new(&mesh, &options.motion.options(&mesh)?, threads)?;
        mesh.points = here;
        let now = Current::of(mesh, mover, records, left, &wall, threads)?;
        let forgotten = Some(clock.step);
        let mut moving = Self::of(options, wall, now, sizes, clock, threads)?;
        (moving.forgotten, moving.returns) = (forgotten, returns);
        if let Some(hold) = &mut moving.hold {
            hold.last = arrays.vectors(HELD)?;
            if hold.last.len() != moving.wall.places.len() {
                return Err(damaged_state(HELD));
            }
        }
        Ok(moving)
    }
}

/// The arrays taken from a file.
pub(super) struct StateArrays {
    fields: Vec<Field>,
}

impl StateArrays {
    pub(super) fn has(&self, name: &str) -> bool {
        self.fields.iter().any(|field| field.name == name)
    }

    /// The arrays whose names begin with `prefix`, with the prefix removed.
    pub(super) fn named(&self, prefix: &str) -> Vec<Field> {
        let rest = |field: &Field| {
            field.name.strip_prefix(prefix).map(|name| Field { name: name.to_owned(), ..field.clone() })
        };
        self.fields.iter().filter_map(rest).collect()
    }

    fn field(&self, name: &str) -> Result<&Field> {
        self.fields.iter().find(|field| field.name == name).ok_or_else(|| damaged_state(name))
    }

    pub(super) fn vectors(&self, name: &str) -> Result<Vec<Point>> {
        self.field(name)?.to_vectors()
    }

    pub(super) fn floats(&self, name: &str) -> Result<Vec<f64>> {
        self.field(name)?.values.to_f64().ok_or_else(|| damaged_state(name))
    }

    pub(super) fn ids(&self, name: &str) -> Result<Vec<u32>> {
        match &self.field(name)?.values {
            Values::U32(ids) => Ok(ids.clone()),
            _ => Err(damaged_state(name)),
        }
    }

    pub(super) fn bytes(&self, name: &str) -> Result<Vec<u8>> {
        match &self.field(name)?.values {
            Values::U8(bytes) => Ok(bytes.clone()),
            _ => Err(damaged_state(name)),
        }
    }

    fn text(&self, name: &str) -> Result<String> {
        String::from_utf8(self.bytes(name)?).map_err(|_| damaged_state(name))
    }

    /// The bad tets that [`LeftBad::to_fields`] wrote.
    pub(super) fn left(&self, name: &str, n_cells: usize) -> Result<Vec<LeftBad>> {
        let [cells, eas, forced] = LeftBad::names(name);
        let (cells, eas, forced) = (self.ids(&cells)?, self.floats(&eas)?, self.floats(&forced)?);
        let is_right = cells.len() == eas.len()
            && cells.len() == forced.len()
            && cells.is_sorted()
            && cells.iter().all(|&cell| (cell as usize) < n_cells);
        if !is_right {
            return Err(damaged_state(name));
        }
        let all = cells.into_iter().zip(eas).zip(forced);
        Ok(all
            .map(|((cell, eas), forced)| LeftBad { cell: CellId(cell), eas, is_forced: forced != 0.0 })
            .collect())
    }
}

impl Sizes {
    fn store_in(&self, file: &mut Mesh) {
        let Self { first, now } = self;
        let is_refined = !Arc::ptr_eq(first, now);
        for ([places, sizes], map) in SIZES.into_iter().zip([Some(first), is_refined.then_some(now)]) {
            if let Some(map) = map {
                file.field_data.push(Field::vectors(places, &map.places));
                file.field_data.push(Field::scalars(sizes, map.sizes.clone()));
            }
        }
    }

    fn from_state(arrays: &StateArrays) -> Result<Self> {
        let of = |[places, sizes]: [&str; 2]| -> Result<Arc<SizeMap>> {
            let map = SizeMap::new(arrays.vectors(places)?, arrays.floats(sizes)?);
            let is_size = |size: &f64| (0.0..f64::INFINITY).contains(size);
            let is_right = map.places.len() == map.sizes.len();
            match is_right && map.sizes.iter().all(is_size) {
                true => Ok(Arc::new(map)),
                false => Err(damaged_state(sizes)),
            }
        };
        let first = of(SIZES[0])?;
        let now = if arrays.has(SIZES[1][0]) { of(SIZES[1])? } else { first.clone() };
        Ok(Self { first, now })
    }
}

impl LeftBad {
    fn names(name: &str) -> [String; 3] {
        ["", "_eas", "_forced"].map(|end| format!("{name}{end}"))
    }

    pub(super) fn to_fields(all: &[Self], name: &str) -> [Field; 3] {
        let [cells, eas, forced] = Self::names(name);
        [
            Field::scalars(cells, all.iter().map(|left| left.cell.0).collect::<Vec<_>>()),
            Field::scalars(eas, all.iter().map(|left| left.eas).collect::<Vec<_>>()),
            Field::scalars(forced, all.iter().map(|left| u8::from(left.is_forced)).collect::<Vec<_>>()),
        ]
    }
}

fn text(name: &str, text: &str) -> Field {
    Field::scalars(name, text.as_bytes().to_vec())
}

/// The names of arrays, each followed by [`BETWEEN`].
fn names(fields: &[Field]) -> String {
    fields.iter().flat_map(|field| [field.name.as_str(), "\0"]).collect()
}

/// Keeps only the arrays with these names, in their order.
fn arrange(fields: &mut Vec<Field>, names: &str) -> Result<()> {
    let mut all = std::mem::take(fields);
    for name in names.split_terminator(BETWEEN) {
        let place = all.iter().position(|field| field.name == name).ok_or_else(|| damaged_state(name))?;
        fields.push(all.remove(place));
    }
    Ok(())
}

fn triangles(ids: &[u32]) -> Result<Vec<[VertexId; 3]>> {
    match ids.as_chunks::<3>() {
        (triangles, []) => Ok(triangles.iter().map(|t| t.map(VertexId)).collect()),
        _ => Err(damaged_state(TRIANGLES)),
    }
}

fn check(wall: &Wall, records: &Records, [n_points, n_cells]: [usize; 2]) -> Result<()> {
    let n = wall.places.len();
    let is_node = |&node: &u32| node == super::wall::NO_NODE || (node as usize) < n;
    if !records.node.iter().all(is_node) || records.node.len() != n_points {
        return Err(damaged_state(NODE));
    }
    if records.first_eas.len() != n_cells {
        return Err(damaged_state(FIRST_EAS));
    }
    if !wall.body.is_empty() && wall.body.len() != wall.triangles.len() {
        return Err(damaged_state(BODY));
    }
    match wall.triangles.as_flattened().iter().all(|v| v.index() < n) {
        true => Ok(()),
        false => Err(damaged_state(TRIANGLES)),
    }
}

pub(super) fn damaged_state(name: &str) -> Error {
    Error::input(format!(
        "is not a saved state of a moving mesh, or is damaged: the array {name} is missing or invalid"
    ))
    .remedy("restart the run from the beginning")
}
