//! Arrays as solutions: each scalar is an array, each vector three.

use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::cgns::names::{MAX_NAME_LENGTH, truncated, valid};
use crate::io::cgns::parts::{CELL_DATA, FACE_DATA, POINT_DATA, Part};
use crate::io::cgns::tree::{Ints, Tree};
use crate::io::select::lost_arrays;
use crate::mesh::{Field, Mesh, Values};

/// The solution nodes of a mesh whose first surface cell has the number `first_face`.
pub(super) fn solutions(
    mesh: &Mesh,
    parts: &[Part],
    cell_dim: usize,
    (first_face, ints): (i64, Ints),
    lost: &mut Vec<String>,
) -> Vec<Tree> {
    let mut all = Vec::new();
    let points: Vec<Field> = mesh.point_data.iter().filter_map(|f| converted(f, "point", lost)).collect();
    all.extend(solution(POINT_DATA, "Vertex", None, &points, lost));
    let labels = cell_labels(mesh, None);
    let is_label =
        |f: &&Field| matches!(f.name.as_str(), "region" | "patch") || labels_cover(&labels, mesh, f);
    let unexpressed = mesh.cell_data.iter().filter(|f| is_label(f) && !labels_cover(&labels, mesh, f));
    lost.extend(lost_arrays("CGNS", "cell", unexpressed));
    let cells: Vec<Field> =
        mesh.cell_data.iter().filter(|f| !is_label(f)).filter_map(|f| converted(f, "cell", lost)).collect();
    let of_dim = |dim: usize| -> Vec<usize> {
        parts.iter().filter(|part| part.dim == dim).flat_map(|part| &part.cells).copied().collect()
    };
    let picked = |field: &Field, rows: &[usize]| field.pick(rows.iter().copied());
    let filling = of_dim(cell_dim);
    let on_cells: Vec<Field> = cells.iter().map(|f| picked(f, &filling)).collect();
    all.extend(solution(CELL_DATA, "CellCenter", None, &on_cells, lost));
    let mut on_faces = Vec::new();
    if cell_dim == 3 {
        let faces = of_dim(2);
        on_faces.extend(cells.iter().map(|f| picked(f, &faces)).filter(has_values));
        let range = ints.values([first_face, first_face + faces.len() as i64 - 1]);
        // These arrays have the same names as on the cells, for which losses were already reported.
        all.extend(solution(FACE_DATA, "FaceCenter", Some(range), &on_faces, &mut Vec::new()));
    }
    let lower: Vec<usize> = (0..cell_dim.min(2)).flat_map(of_dim).collect();
    let of_lower = cells.iter().filter(|f| has_values(&picked(f, &lower)));
    if let Some(names) = lost_arrays("CGNS", "cell", of_lower) {
        lost.push(format!("on curves and points, {names}"));
    }
    lost.extend(lost_arrays("CGNS", "field", &mesh.field_data));
    all
}

/// Whether any value differs from the default for missing values (NaN, or 0 for integers).
fn has_values(field: &Field) -> bool {
    match &field.values {
        Values::F32(values) => values.iter().any(|x| !x.is_nan()),
        Values::F64(values) => values.iter().any(|x| !x.is_nan()),
        other => other.to_i64().is_none_or(|values| values.iter().any(|&x| x != 0)),
    }
}

/// The array converted to a type that CGNS supports; `None` if there is no such type.
fn converted(field: &Field, what: &str, lost: &mut Vec<String>) -> Option<Field> {
    let short = || -> Option<Vec<i32>> {
        field.values.to_i64()?.into_iter().map(|x| i32::try_from(x).ok()).collect()
    };
    let values = match &field.values {
        Values::I8(_) | Values::U8(_) | Values::I16(_) | Values::U16(_) => Values::I32(short()?),
        Values::U32(_) | Values::U64(_) => match field.values.to_i64() {
            Some(values) => Values::I64(values),
            None => {
                lost.push(format!(
                    "{what} array {} is not written: its numbers exceed signed 64-bit integers",
                    field.name
                ));
                return None;
            }
        },
        Values::Text(_) => {
            lost.extend(lost_arrays("CGNS", &format!("{what} text"), [field]));
            return None;
        }
        same => return Some(Field { values: same.clone(), ..field.clone() }),
    };
    lost.push(format!(
        "the type of {what} array {} is not kept: CGNS has only signed integers of 32 and 64 bits",
        field.name
    ));
    Some(Field { name: field.name.clone(), components: field.components, values })
}

/// A solution node; `None` if there are no arrays with values.
fn solution(
    name: &str,
    location: &str,
    range: Option<Values>,
    fields: &[Field],
    lost: &mut Vec<String>,
) -> Option<Tree> {
    let has_rows = |f: &&Field| f.n_rows() > 0;
    fields.iter().find(has_rows)?;
    // The CGNS libraries reject solutions on a subset of the faces.
    let label = if range.is_some() { "UserDefinedData_t" } else { "FlowSolution_t" };
    let mut node = Tree::new(name, label);
    node.child(Tree::with_text("GridLocation", "GridLocation_t", location));
    node.children(range.map(|ends| Tree::range("PointRange", ends)));
    let mut taken = ["GridLocation", "PointRange"].map(str::to_owned).to_vec();
    for field in fields.iter().filter(has_rows) {
        for (component, wanted) in names(field, lost).into_iter().enumerate() {
            let name = valid(&wanted, &taken);
            if name != wanted {
                lost.push(format!("the array name {wanted:?} is written as {name:?}"));
            }
            let rows = (0..field.n_rows()).map(|row| row * field.components + component);
            let flat = Field { name: String::new(), components: 1, values: field.values.clone() };
            node.child(Tree::with(&name, "DataArray_t", flat.pick(rows).values));
            taken.push(name);
        }
    }
    Some(node)
}

/// The names of the components of an array.
fn names(field: &Field, lost: &mut Vec<String>) -> Vec<String> {
    match field.components {
        1 => vec![field.name.clone()],
        3 => {
            let stem = truncated(&field.name, MAX_NAME_LENGTH - 1);
            if stem != field.name {
                lost.push(format!("the array name {:?} is written as {stem:?}", field.name));
            }
            ["X", "Y", "Z"].map(|axis| format!("{stem}{axis}")).to_vec()
        }
        n => {
            lost.push(format!(
                "array {} is written as {n} scalars: CGNS vectors have three components",
                field.name
            ));
            (1..=n).map(|i| format!("{}_{i}", field.name)).collect()
        }
    }
}
