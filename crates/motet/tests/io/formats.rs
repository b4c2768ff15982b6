//! MSH, STL, OBJ, Medit, TetGen, Netgen, SU2, openCARP, UNV, Nastran, Ansys, Fluent, MED, Exodus II, XDMF
//! and DOLFIN files: written files are read back; damage is reported.

use std::fs;
use std::path::Path;

use motet::Mesh;
use motet::base::{Csr, Point, Threads, VertexId};
use motet::io::{Encoding, Format, Input, Notes, WriteOptions, formats, read, read_as, read_noted, write};
use motet::mesh::{CellKind, Cells, Field, Values};
use proptest::prelude::*;

fn format(extension: &str) -> &'static Format {
    formats().iter().find(|f| f.extensions.contains(&extension)).expect("the format is registered")
}

/// Parses bytes as a file with this extension, in memory.
fn parse(extension: &str, bytes: &[u8]) -> motet::Result<Mesh> {
    let path = format!("in{extension}");
    read_as(
        format(extension),
        &Input { path: Path::new(&path), bytes, threads: &Threads::single(), notes: &Notes::default() },
    )
}

fn notes_of(extension: &str, bytes: &[u8]) -> Vec<String> {
    let (path, notes) = (format!("in{extension}"), Notes::default());
    read_as(
        format(extension),
        &Input { path: Path::new(&path), bytes, threads: &Threads::single(), notes: &notes },
    )
    .expect("it is read");
    notes.into_vec()
}

/// Writes into memory; returns the first file, and what was lost.
fn print(extension: &str, mesh: &Mesh, options: &WriteOptions) -> (Vec<u8>, Vec<String>) {
    let mut written =
        format(extension).to_files(mesh, options, &Threads::single()).expect("the mesh is written");
    (written.files.swap_remove(0).1, written.lost)
}

fn options(version: &str, encoding: Encoding) -> WriteOptions {
    WriteOptions { version: Some(version.to_owned()), encoding, ..WriteOptions::default() }
}

fn bits(points: &[Point]) -> Vec<[u64; 3]> {
    points.iter().map(|p| p.map(f64::to_bits)).collect()
}

/// Checks that points and cells are the same, to the bit.
fn same_grid(found: &Mesh, expected: &Mesh) -> Result<(), TestCaseError> {
    prop_assert_eq!(bits(&found.points), bits(&expected.points));
    prop_assert_eq!(&found.cells, &expected.cells);
    Ok(())
}

/// Writes a mesh of which nothing may be lost, and reads it; points and cells come back.
fn round_trip(extension: &str, mesh: &Mesh) -> Result<Mesh, TestCaseError> {
    let (bytes, lost) = print(extension, mesh, &WriteOptions::default());
    prop_assert!(lost.is_empty(), "{lost:?}");
    let back = parse(extension, &bytes).unwrap();
    same_grid(&back, mesh)?;
    Ok(back)
}

/// Labels volume cells as `region` and surface cells as `patch`, with numbers added to the given ones.
fn set_labels(mesh: &mut Mesh, labels: &[i32], [region, patch]: [i32; 2]) {
    for (array, dim, added) in [("region", 3, region), ("patch", 2, patch)] {
        let id = |(&label, kind): (&i32, &CellKind)| if kind.dim() == Some(dim) { added + label } else { 0 };
        let ids: Vec<i32> = labels.iter().zip(mesh.cells.kinds()).map(id).collect();
        if ids.iter().any(|&id| id != 0) {
            mesh.set_cell_field(Field::scalars(array, ids));
        }
    }
}

const MSH_KINDS: &[CellKind] = &[
    CellKind::VERTEX,
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::BIQUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::TRIQUADRATIC_HEXAHEDRON,
    CellKind::QUADRATIC_WEDGE,
    CellKind::BIQUADRATIC_QUADRATIC_WEDGE,
    CellKind::QUADRATIC_PYRAMID,
];
const MEDIT_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_TETRA,
];

const ABAQUS_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::BIQUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_WEDGE,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::TRIQUADRATIC_HEXAHEDRON,
];

/// Surface cells, then volume cells.
const NETGEN_KINDS: &[CellKind] = &[
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::TETRA,
    CellKind::PYRAMID,
    CellKind::WEDGE,
    CellKind::HEXAHEDRON,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_LINEAR_WEDGE,
    CellKind::QUADRATIC_PYRAMID,
    CellKind::QUADRATIC_HEXAHEDRON,
];

const NASTRAN_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::QUADRATIC_WEDGE,
    CellKind::QUADRATIC_PYRAMID,
];
/// Volume cells, then surface cells.
const EXODUS_KINDS: &[CellKind] = &[
    CellKind::TETRA,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::HEXAHEDRON,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::TRIQUADRATIC_HEXAHEDRON,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::QUADRATIC_TRIANGLE,
];
const CDB_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::QUADRATIC_WEDGE,
    CellKind::QUADRATIC_PYRAMID,
];
const MED_KINDS: &[CellKind] = &[
    CellKind::VERTEX,
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::QUADRATIC_LINE,
    CellKind::CUBIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::BIQUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::BIQUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_HEXAHEDRON,
    CellKind::TRIQUADRATIC_HEXAHEDRON,
    CellKind::QUADRATIC_WEDGE,
    CellKind::QUADRATIC_PYRAMID,
];
const UNV_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
    CellKind::QUADRATIC_WEDGE,
    CellKind::QUADRATIC_HEXAHEDRON,
];

const XDMF_KINDS: &[CellKind] = &[
    CellKind::VERTEX,
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::PYRAMID,
    CellKind::WEDGE,
    CellKind::HEXAHEDRON,
    CellKind::QUADRATIC_LINE,
    CellKind::QUADRATIC_TRIANGLE,
    CellKind::QUADRATIC_QUAD,
    CellKind::BIQUADRATIC_QUAD,
    CellKind::QUADRATIC_TETRA,
];

const OPENCARP_KINDS: &[CellKind] = &[
    CellKind::LINE,
    CellKind::TRIANGLE,
    CellKind::QUAD,
    CellKind::TETRA,
    CellKind::PYRAMID,
    CellKind::WEDGE,
    CellKind::HEXAHEDRON,
];

/// Volume cells, then those of patches.
const SU2_KINDS: &[CellKind] = &[
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::TRIANGLE,
    CellKind::QUAD,
];

fn coordinate() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE
}

/// A mesh of up to 20 points and 12 cells of the given kinds, in their order where `sorted`,
/// and a label for each cell.
fn meshes(kinds: &'static [CellKind], sorted: bool) -> impl Strategy<Value = (Mesh, Vec<i32>)> {
    let points = prop::collection::vec(prop::array::uniform3(coordinate()), 1..20);
    let cells =
        prop::collection::vec((0..kinds.len(), prop::collection::vec(0u32..1000, 27), 0i32..4), 0..12);
    (points, cells).prop_map(move |(points, mut rows)| {
        if sorted {
            rows.sort_by_key(|(kind, ..)| *kind);
        }
        let mut cells = Cells::new();
        for (kind, ids, _) in &rows {
            let n = kinds[*kind].n_vertices().expect("kinds here have a number of vertices");
            cells.push(kinds[*kind], ids[..n].iter().map(|id| VertexId(id % points.len() as u32)));
        }
        (Mesh::new(points, cells), rows.into_iter().map(|(.., label)| label).collect())
    })
}

proptest! {
    #[test]
    fn msh_comes_back((mut mesh, labels) in meshes(MSH_KINDS, false), seed in any::<u32>()) {
        let values = |n: usize| (0..n).map(|i| f64::from(seed) / (i as f64 + 3.0)).collect::<Vec<_>>();
        mesh.set_point_field(Field { name: "u v".into(), components: 3, values: values(3 * mesh.points.len()).into() });
        mesh.set_cell_field(Field::scalars("q", values(mesh.cells.len())));
        mesh.set_cell_field(Field::scalars("gmsh:physical", labels.clone()));
        mesh.label_names.regions.insert(1, "the blood".into());
        mesh.label_names.patches.insert(2, "a wall".into());
        for version in ["2.2", "4.1"] {
            for encoding in [Encoding::Ascii, Encoding::Binary] {
                let (bytes, lost) = print(".msh", &mesh, &options(version, encoding));
                prop_assert!(lost.is_empty(), "{lost:?}");
                let back = parse(".msh", &bytes).unwrap();
                same_grid(&back, &mesh)?;
                prop_assert_eq!(&back.label_names, &mesh.label_names);
                prop_assert_eq!(back.point_field("u v"), mesh.point_field("u v"));
                if !mesh.cells.is_empty() {
                    prop_assert_eq!(back.cell_field("q"), mesh.cell_field("q"));
                }
                let found = back.cell_field("gmsh:physical").and_then(|f| f.values.to_i64());
                let found = found.unwrap_or_else(|| vec![0; mesh.cells.len()]);
                prop_assert_eq!(found, labels.iter().map(|&l| i64::from(l)).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn msh_keeps_entities_that_have_one_label((mut mesh, labels) in meshes(MSH_KINDS, false)) {
        mesh.set_cell_field(Field::scalars("gmsh:physical", labels.clone()));
        let entities: Vec<i32> = labels.iter().map(|l| 10 + l).collect();
        mesh.set_cell_field(Field::scalars("gmsh:geometrical", entities.clone()));
        for version in ["2.2", "4.1"] {
            let (bytes, lost) = print(".msh", &mesh, &options(version, Encoding::Binary));
            prop_assert!(lost.is_empty(), "{lost:?}");
            let back = parse(".msh", &bytes).unwrap();
            if !entities.is_empty() {
                prop_assert_eq!(back.cell_field("gmsh:geometrical"), mesh.cell_field("gmsh:geometrical"));
            }
        }
    }

    #[test]
    fn medit_comes_back((mut mesh, labels) in meshes(MEDIT_KINDS, true)) {
        let refs: Vec<i32> = (0..mesh.points.len() as i32).map(|i| i - 3).collect();
        mesh.set_point_field(Field::scalars("medit:ref", refs));
        mesh.set_cell_field(Field::scalars("medit:ref", labels));
        for extension in [".mesh", ".meshb"] {
            let back = round_trip(extension, &mesh)?;
            prop_assert_eq!(back.point_field("medit:ref"), mesh.point_field("medit:ref"));
            let marked = mesh.cell_field("medit:ref").filter(|f| f.values.to_i64().unwrap().iter().any(|&r| r != 0));
            prop_assert_eq!(back.cell_field("medit:ref"), marked);
        }
    }

    #[test]
    fn abaqus_comes_back((mut mesh, labels) in meshes(ABAQUS_KINDS, false)) {
        set_labels(&mut mesh, &labels, [0, 0]);
        let back = round_trip(".inp", &mesh)?;
        prop_assert_eq!(&back.cell_data, &mesh.cell_data);
        prop_assert_eq!(&back.label_names, &mesh.label_names);
    }

    #[test]
    fn su2_comes_back((mut mesh, labels) in meshes(SU2_KINDS, true)) {
        let on_sides = labels.iter().zip(mesh.cells.kinds()).map(|(&l, kind)| if kind.dim() == Some(2) { l + 1 } else { 0 });
        let mut tags: Vec<i32> = on_sides.collect();
        // SU2 groups cells by patch.
        tags.sort_unstable();
        // A surface in the plane z = 0 would have two dimensions.
        mesh.points[0][2] = 1.0;
        let is_labelled = tags.iter().any(|&tag| tag != 0);
        mesh.set_cell_field(Field::scalars("su2:tag", tags));
        mesh.label_names.patches.insert(2, "wall".into());
        let (bytes, lost) = print(".su2", &mesh, &WriteOptions::default());
        prop_assert!(lost.iter().all(|l| l.contains("numbers of patches")), "{lost:?}");
        let back = parse(".su2", &bytes).unwrap();
        same_grid(&back, &mesh)?;
        if is_labelled {
            prop_assert_eq!(patch_names(&back), patch_names(&mesh));
        }
    }

    #[test]
    fn netgen_comes_back((mut mesh, labels) in meshes(NETGEN_KINDS, true)) {
        // A surface in the plane z = 0 would have two dimensions.
        mesh.points[0][2] = 1.0;
        mesh.set_cell_field(Field::scalars("netgen:index", labels.iter().map(|label| label + 1).collect::<Vec<_>>()));
        mesh.label_names.regions.insert(2, "the blood".into());
        mesh.label_names.patches.insert(3, "wall".into());
        for extension in [".vol", ".vol.gz"] {
            let back = round_trip(extension, &mesh)?;
            prop_assert_eq!(&back.label_names, &mesh.label_names);
            prop_assert_eq!(back.cell_field("netgen:index"), mesh.cell_field("netgen:index").filter(|_| !labels.is_empty()));
        }
    }

    #[test]
    fn unv_comes_back((mut mesh, labels) in meshes(UNV_KINDS, false)) {
        set_labels(&mut mesh, &labels, [1, 7]);
        let back = round_trip(".unv", &mesh)?;
        prop_assert_eq!(&back.cell_data, &mesh.cell_data);
        prop_assert_eq!(&back.label_names, &mesh.label_names);
    }

    #[test]
    fn ansys_archives_come_back((mut mesh, labels) in meshes(CDB_KINDS, false)) {
        // Nodes that coincide would make other cells, so each cell gets those that follow its first.
        let given = std::mem::take(&mut mesh.cells);
        mesh.points.resize(27, [0.5; 3]);
        for (_, kind, vertices) in given.iter() {
            mesh.cells.push(kind, (0..vertices.len() as u32).map(|k| VertexId((vertices[0].0 + k) % 27)));
        }
        let positive: Vec<i32> = labels.iter().map(|label| label + 1).collect();
        set_labels(&mut mesh, &positive, [0, 6]);
        let back = round_trip(".cdb", &mesh)?;
        prop_assert_eq!(&back.cell_data, &mesh.cell_data);
        prop_assert_eq!(&back.label_names, &mesh.label_names);
    }

    #[test]
    fn med_comes_back((mut mesh, labels) in meshes(MED_KINDS, false), seed in any::<u32>()) {
        set_labels(&mut mesh, &labels, [1, 7]);
        let values = |n: usize| (0..n).map(|i| f64::from(seed) / (i as f64 + 3.0)).collect::<Vec<_>>();
        mesh.set_point_field(Field { name: "u v".into(), components: 3, values: values(3 * mesh.points.len()).into() });
        if !mesh.cells.is_empty() {
            mesh.set_cell_field(Field { name: "q".into(), components: 2, values: values(2 * mesh.cells.len()).into() });
            mesh.set_cell_field(Field::scalars("n", labels.iter().map(|&l| i64::from(l)).collect::<Vec<_>>()));
        }
        let back = round_trip(".med", &mesh)?;
        let sorted = |mesh: &Mesh| {
            let mut fields = mesh.cell_data.clone();
            fields.sort_by(|a, b| a.name.cmp(&b.name));
            fields
        };
        prop_assert_eq!(sorted(&back), sorted(&mesh));
        prop_assert_eq!(&back.point_data, &mesh.point_data);
        prop_assert_eq!(&back.label_names, &mesh.label_names);
    }

    #[test]
    fn nastran_comes_back((mut mesh, labels) in meshes(NASTRAN_KINDS, false)) {
        // Fields of 16 characters hold no more than single precision of all numbers.
        mesh.points.iter_mut().flatten().for_each(|x| *x = f64::from(*x as f32).clamp(-1e9, 1e9));
        let refs = labels.iter().zip(mesh.cells.kinds()).map(|(&label, kind)| 1 + label + 10 * kind.dim().unwrap() as i32);
        mesh.set_cell_field(Field::scalars("nastran:ref", refs.collect::<Vec<_>>()));
        let (bytes, lost) = print(".bdf", &mesh, &WriteOptions::default());
        prop_assert!(lost.iter().all(|what| what.ends_with("coordinates are rounded to the 16 characters of a field")), "{lost:?}");
        let back = parse(".bdf", &bytes).unwrap();
        prop_assert_eq!(&back.cells, &mesh.cells);
        prop_assert_eq!(back.cell_field("nastran:ref"), mesh.cell_field("nastran:ref").filter(|_| !labels.is_empty()));
        for (x, y) in back.points.iter().flatten().zip(mesh.points.iter().flatten()) {
            prop_assert!((x - y).abs() <= 1e-10 * y.abs(), "{x} {y}");
            prop_assert!(!lost.is_empty() || x.to_bits() == y.to_bits());
        }
    }

    #[test]
    fn exodus_comes_back((mut mesh, labels) in meshes(EXODUS_KINDS, false), seed in any::<u32>()) {
        set_labels(&mut mesh, &labels, [1, 7]);
        // The places of cells, by which the order of the file is undone.
        let n = mesh.cells.len();
        mesh.set_cell_field(Field::scalars("place", (1..=n).map(|i| i as f64).collect::<Vec<_>>()));
        let values: Vec<f64> = (0..3 * mesh.points.len()).map(|i| f64::from(seed) / (i as f64 + 3.0)).collect();
        mesh.set_point_field(Field { name: "u".into(), components: 3, values: values.into() });
        let (bytes, lost) = print(".exo", &mesh, &WriteOptions::default());
        let back = parse(".exo", &bytes).unwrap();
        prop_assert_eq!(bits(&back.points), bits(&mesh.points));
        prop_assert_eq!(back.point_field("u"), mesh.point_field("u"));
        prop_assert_eq!(back.cells.len(), n);
        // Facets of volume cells lose their values, and take their vertices from the cells.
        if lost.iter().all(|what| !what.contains("side sets")) {
            let places = back.cell_field("place").map(|f| f.values.to_i64().unwrap()).unwrap_or_default();
            for (cell, place) in places.iter().map(|place| *place as usize - 1).enumerate() {
                prop_assert_eq!(back.cells.kinds()[cell], mesh.cells.kinds()[place]);
                prop_assert_eq!(back.cells.connectivity().list(cell), mesh.cells.connectivity().list(place));
                for (found, given) in [(back.regions(), mesh.regions()), (back.patches(), mesh.patches())] {
                    let id = |labels: &Option<motet::mesh::Labels>, i: usize| labels.as_ref().map_or(0, |labels| labels.ids[i]);
                    prop_assert_eq!(id(&found, cell), id(&given, place));
                }
            }
        }
    }

    #[test]
    fn xdmf_comes_back((mut mesh, labels) in meshes(XDMF_KINDS, false), seed in any::<u32>()) {
        let values = |n: usize| (0..n).map(|i| f64::from(seed) / (i as f64 + 3.0)).collect::<Vec<_>>();
        mesh.set_point_field(Field { name: "u v".into(), components: 3, values: values(3 * mesh.points.len()).into() });
        mesh.set_cell_field(Field::scalars("region", labels.clone()));
        mesh.set_cell_field(Field::scalars("patch", labels));
        mesh.label_names.regions.insert(1, "the <blood>".into());
        let back = round_trip(".xdmf", &mesh)?;
        prop_assert_eq!(&back.point_data, &mesh.point_data);
        // Arrays may come back in another order.
        prop_assert_eq!(back.cell_data.len(), mesh.cell_data.len());
        for field in &mesh.cell_data {
            prop_assert_eq!(back.cell_field(&field.name), Some(field));
        }
        prop_assert_eq!(&back.label_names, &mesh.label_names);
    }

    #[test]
    fn opencarp_comes_back((mut mesh, labels) in meshes(OPENCARP_KINDS, false)) {
        mesh.set_cell_field(Field::scalars("elemTag", labels));
        let vectors: Vec<Point> = (0..mesh.cells.len()).map(|i| [0.1, -0.0, i as f64]).collect();
        mesh.set_cell_field(Field::vectors("fiber", &vectors));
        let folder = tempfile::tempdir().unwrap();
        let lost = write(folder.path().join("out.pts"), &mesh, &WriteOptions::default()).unwrap();
        prop_assert!(lost.is_empty(), "{lost:?}");
        for name in ["out.pts", "out.elem", "out.lon"] {
            let back = read(folder.path().join(name)).unwrap();
            same_grid(&back, &mesh)?;
            if !mesh.cells.is_empty() {
                prop_assert_eq!(&back.cell_data, &mesh.cell_data);
            }
        }
    }

    #[test]
    fn tetgen_comes_back(
        (mut mesh, labels) in meshes(&[CellKind::TETRA, CellKind::TRIANGLE, CellKind::LINE], true),
        quadratic in any::<bool>(),
    ) {
        if quadratic {
            let ids: Vec<_> = (0..20).map(|i| VertexId(i % mesh.points.len() as u32)).collect();
            mesh.cells = Cells::uniform(CellKind::QUADRATIC_TETRA, ids).unwrap();
        } else {
            mesh.set_cell_field(Field::scalars("tetgen:ref", labels));
        }
        let markers: Vec<i32> = (0..mesh.points.len() as i32).collect();
        let heights: Vec<f64> = mesh.points.iter().map(|p| p[2]).collect();
        mesh.set_point_field(Field::scalars("tetgen:attr1", heights));
        mesh.set_point_field(Field::scalars("tetgen:ref", markers));
        let folder = tempfile::tempdir().unwrap();
        let lost = write(folder.path().join("out.ele"), &mesh, &WriteOptions::default()).unwrap();
        prop_assert!(lost.is_empty(), "{lost:?}");
        for name in ["out.node", "out.ele"] {
            let back = read(folder.path().join(name)).unwrap();
            same_grid(&back, &mesh)?;
            prop_assert_eq!(&back.point_data, &mesh.point_data);
            let marked = mesh.cell_field("tetgen:ref").filter(|f| f.values.to_i64().unwrap().iter().any(|&r| r != 0));
            prop_assert_eq!(back.cell_field("tetgen:ref"), marked);
        }
    }

    #[test]
    fn obj_comes_back((mut mesh, labels) in meshes(&[CellKind::TRIANGLE, CellKind::QUAD], false)) {
        mesh.set_cell_field(Field::scalars("patch", labels.iter().map(|l| l + 1).collect::<Vec<_>>()));
        for label in 1..6 {
            mesh.label_names.patches.insert(label, format!("part {label}"));
        }
        let back = round_trip(".obj", &mesh)?;
        prop_assert_eq!(patch_names(&back), if labels.iter().any(|l| *l != labels[0]) { patch_names(&mesh) } else { vec![] });
    }

    #[test]
    fn stl_keeps_corners_and_patches((mut mesh, labels) in meshes(&[CellKind::TRIANGLE], false)) {
        prop_assume!(!mesh.cells.is_empty());
        mesh.set_cell_field(Field::scalars("patch", labels.iter().map(|l| l + 1).collect::<Vec<_>>()));
        for label in 1..6 {
            mesh.label_names.patches.insert(label, format!("part {label}"));
        }
        let text = WriteOptions { encoding: Encoding::Ascii, ..WriteOptions::default() };
        let back = parse(".stl", &print(".stl", &mesh, &text).0).unwrap();
        prop_assert_eq!(corners(&back), corners(&mesh));
        prop_assert_eq!(patch_names(&back), if labels.iter().any(|l| *l != labels[0]) { patch_names(&mesh) } else { vec![] });

        // In binary, after rounding to single precision, which the first writing does.
        mesh.set_cell_field(Field::scalars("attribute", labels.iter().map(|&l| l as u16).collect::<Vec<_>>()));
        let once = parse(".stl", &print(".stl", &mesh, &WriteOptions::default()).0).unwrap();
        let rounded = corners(&mesh).iter().map(|t| t.map(|p| p.map(|x| f64::from(x as f32)))).collect::<Vec<_>>();
        prop_assert_eq!(corners(&once), rounded);
        let marked = mesh.cell_field("attribute").filter(|_| labels.iter().any(|&l| l != 0));
        prop_assert_eq!(once.cell_field("attribute"), marked);
    }

    /// Whatever is cut off or overwritten, the result is a mesh or an error, never a panic.
    #[test]
    fn damage_is_survived(
        (mut mesh, labels) in meshes(MSH_KINDS, false),
        cut in 0.0..1.0f64,
        flips in prop::collection::vec((0.0..1.0f64, any::<u8>()), 0..4),
    ) {
        mesh.set_cell_field(Field::scalars("gmsh:physical", labels));
        let files = [
            (".msh", options("2.2", Encoding::Ascii)),
            (".msh", options("2.2", Encoding::Binary)),
            (".msh", options("4.1", Encoding::Ascii)),
            (".msh", options("4.1", Encoding::Binary)),
            (".mesh", WriteOptions::default()),
            (".meshb", WriteOptions::default()),
            (".inp", WriteOptions::default()),
            (".su2", WriteOptions::default()),
            (".vol", WriteOptions::default()),
            (".unv", WriteOptions::default()),
            (".bdf", WriteOptions::default()),
            (".cdb", WriteOptions::default()),
            (".med", WriteOptions::default()),
            (".exo", WriteOptions::default()),
            (".xdmf", WriteOptions::default()),
            (".obj", WriteOptions::default()),
            (".stl", WriteOptions::default()),
            (".stl", WriteOptions { encoding: Encoding::Ascii, ..WriteOptions::default() }),
        ];
        for (extension, options) in files {
            let (mut bytes, _) = print(extension, &mesh, &options);
            let n = bytes.len();
            // A surface without cells has no bytes.
            for (place, value) in flips.iter().filter(|_| n > 0) {
                bytes[(place * n as f64) as usize] ^= value;
            }
            let _ = parse(extension, &bytes);
            let _ = parse(extension, &bytes[..(cut * n as f64) as usize]);
        }
    }
}

/// The name of each cell's patch.
fn patch_names(mesh: &Mesh) -> Vec<String> {
    mesh.patches().map_or(vec![], |p| p.ids.iter().map(|&id| p.name(id)).collect())
}

fn corners(mesh: &Mesh) -> Vec<[Point; 3]> {
    mesh.cells.iter().map(|(.., v)| [v[0], v[1], v[2]].map(|v| mesh.points[v.index()])).collect()
}

/// Every message names the place; most suggest a remedy.
#[test]
fn damaged_files_are_reported() {
    let msh2 = |body: &str| format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{body}");
    let msh4 = |body: &str| format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{body}");
    let medit = |body: &str| format!("MeshVersionFormatted 2\nDimension 3\n{body}");
    let xml = |body: &str| {
        format!(
            "<dolfin><mesh celltype=\"tetrahedron\" dim=\"3\"><vertices size=\"1\">\n<vertex index=\"0\" x=\"0\" y=\"0\" z=\"0\"/></vertices>{body}"
        )
    };
    let cases: Vec<(&str, String, &str)> = vec![
        (".msh", String::new(), "is empty (0 bytes); get a new copy of the file"),
        (".msh", "hello\n".into(), "line 1: expected the start of a section ($...), found `hello`"),
        (".msh", "$NOD\n1\n".into(), "expected MSH version 2.2 or 4.1, found version 1; convert it"),
        (".msh", "$Nodes\n0\n".into(), "line 2: expected $MeshFormat at the start of the file, found $Nodes"),
        (".msh", "$MeshFormat\n4 0 8\n".into(), "line 2: expected MSH version 2.2 or 4.1, found version `4`"),
        (".msh", "$MeshFormat\n2.2 0 16\n".into(), "line 2: expected numbers of 4 or 8 bytes, found 16"),
        (
            ".msh",
            "$MeshFormat\n4.1 1 8\n\x01\x02\x03\x04".into(),
            "byte 24: expected the number 1 in either byte order",
        ),
        (".msh", "$MeshFormat\n2.2 0 8\n".into(), "expected $EndMeshFormat, found the end of the file"),
        (".msh", msh2(""), "there is no section $Nodes"),
        (
            ".msh",
            msh2("$Nodes\n1152921504606846976\n"),
            "line 5: 1152921504606846976 nodes declared, but the rest of the file can hold at most 0",
        ),
        (".msh", msh2("$Nodes\n-1\n"), "line 5: the number of nodes is negative: -1"),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0\n$EndNodes\n"),
            "coordinate z: expected a number in double precision, found `$EndNodes`",
        ),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0 1e999\n$EndNodes\n"),
            "line 6: coordinate z: expected a number in double precision, found `1e999`",
        ),
        (".msh", msh2("$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n"), "$Nodes: node 1 occurs twice"),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n"),
            "line 7: expected $EndNodes, found `2`; the count of the section is wrong",
        ),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 15 2 0 0 7\n$EndElements\n"),
            "line 10: element 1 refers to node 7, which does not exist",
        ),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 99 2 0 0 7\n$EndElements\n"),
            "line 10: element type 99 is not supported",
        ),
        (
            ".msh",
            msh2("$Nodes\n1\n1 0 0 0\n$EndNodes\n$NodeData\n1\n\"p\"\n0\n3\n0\n1\n1\n5 2.0\n$EndNodeData\n"),
            "array p: has a value for node 5, which does not exist",
        ),
        (".msh", msh2("$Foo\n1 2 3\n"), "expected $EndFoo, found the end of the file"),
        (
            ".msh",
            msh4("$Nodes\n1 2 1 2\n3 1 0 1\n1\n0 0 0\n$EndNodes\n"),
            "2 nodes declared, but the blocks contain 1",
        ),
        (
            ".msh",
            msh4("$Elements\n1 1 1 1\n0 1 15 1\n1 1\n$EndElements\n"),
            "line 7: elements precede the nodes",
        ),
        (
            ".stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n".into(),
            "line 5: expected coordinate z, found the end of the file; the file is truncated",
        ),
        (
            ".stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n".into(),
            "line 4: coordinate z: expected a number in double precision, found `x`",
        ),
        (".stl", "solid a\nendsolid a\n".into(), "the surface has no triangles"),
        (
            ".stl",
            format!("{}\x02\0\0\0", " ".repeat(80)),
            "byte 80: a binary STL file with 2 triangles has 184 bytes, but this file has 84",
        ),
        (
            ".stl",
            "\x7fELF".into(),
            "byte 0: expected text that starts with `solid`, or a binary header of 84 bytes, found",
        ),
        (
            ".stl",
            "version https://git-lfs.github.com/spec/v1\noid sha256:0\n".into(),
            "is a Git LFS pointer, not the file itself; fetch the file: git lfs pull",
        ),
        (".obj", "# nothing\n".into(), "the file contains no vertices"),
        (".obj", "v 0 0\n".into(), "line 1: expected three coordinates of a vertex"),
        (".obj", "v 0 0 zero\n".into(), "line 1: coordinate: expected a number, found `zero`"),
        (".obj", "v 0 0 0\nf 1\n".into(), "line 2: too few vertices for this element: 1"),
        (
            ".obj",
            "v 0 0 0\nf 1 1 0\n".into(),
            "line 2: an element refers to vertex 0, but 1 vertices precede it",
        ),
        (
            ".obj",
            "v 0 0 0\nf 1 1 -2\n".into(),
            "line 2: an element refers to vertex -2, but 1 vertices precede it",
        ),
        (
            ".obj",
            "v 0 0 0\n\nf 1/1 1//1 9/1/1\nv 0 0 0\n".into(),
            "line 3: an element refers to vertex 9, but the file has 2 vertices",
        ),
        (".obj", "version 2\n".into(), "line 1: statement: expected one of Wavefront OBJ"),
        (".mesh", "MeshVersion 2\n".into(), "line 1: the first word: expected `MeshVersionFormatted`"),
        (".mesh", "MeshVersionFormatted 7\n".into(), "line 1: expected format version 1 to 4, found 7"),
        (
            ".mesh",
            "MeshVersionFormatted 2\nVertices 1\n0 0 0 0\n".into(),
            "line 2: vertices precede the dimension",
        ),
        (".mesh", medit("End\n"), "there is no section Vertices"),
        (".mesh", medit("Vertices 4294967296\n0 0 0 0\n"), "line 3: 4294967296 vertices declared"),
        (
            ".mesh",
            medit("Vertices 1\n0 0 0 0\nTetrahedra 1\n1 1 1 2 0\nEnd\n"),
            "line 6: a cell refers to vertex 2, but there are 1 vertices, numbered from 1",
        ),
        (
            ".mesh",
            medit("Vertices 1\n0 0 0 0\nTetrahedra 1\n1 1 1 0 0\nEnd\n"),
            "line 6: a cell refers to vertex 0",
        ),
        (
            ".mesh",
            medit("Vertices 1\n0 0 0 0\nRidges 1\n4\nEnd\n"),
            "a mark refers to entry 4 of section Edges, which has 0",
        ),
        (".mesh", medit("Vertices 1\n0 0 0 0\n1 2 3 4\n"), "line 5: section: expected a name, found `1`"),
        (".xml", "<VTKFile/>".into(), "line 1: expected root element `dolfin`, found `VTKFile`"),
        (".xml", "<dolfin>".into(), "line 1: the file ends before all elements are closed"),
        (
            ".xml",
            "<dolfin><mesh_function dim=\"2\" size=\"0\"/></dolfin>".into(),
            "the file contains no mesh; it contains marks on a mesh",
        ),
        (".xml", xml("<cells size=\"99999999\">"), "line 2: 99999999 cells declared"),
        (
            ".xml",
            xml(
                "<cells size=\"1\"><tetrahedron index=\"0\" v0=\"0\" v1=\"0\" v2=\"0\" v3=\"5\"/></cells></mesh></dolfin>",
            ),
            "line 2: cell 0 refers to vertex 5, but there are 1 vertices, numbered from 0",
        ),
        (".xml", xml("<cells size=\"1\"></cells></mesh></dolfin>"), "line 2: 1 elements declared, 0 found"),
        (".xml", "<dolfin>\n<mesh celltype=".into(), "line 2: not well-formed XML"),
    ];
    for (extension, text, expected) in cases {
        let error = match parse(extension, text.as_bytes()) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{extension} file was read: {text}"),
        };
        assert!(error.contains(expected), "{extension}: {text}\n  found: {error}\n  expected: {expected}");
        assert!(error.starts_with(&format!("in{extension}: ")), "{error}");
    }
}

#[test]
fn a_truncated_gzip_file_is_reported() {
    let error = parse(".xml.gz", b"\x1f\x8b\x08\0\0\0\0\0\0\0").unwrap_err().to_string();
    assert!(error.contains("cannot be decompressed"), "{error}");
}

#[test]
fn tetgen_files_that_do_not_fit_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let message = |name: &str| read(folder.path().join(name)).unwrap_err().to_string();
    file("a.ele", "1 4 0\n1 1 2 3 4\n");
    assert!(
        message("a.ele").contains("a.node: the file with the points of the .ele file does not exist"),
        "{}",
        message("a.ele")
    );
    file("a.node", "2 3 0 0\n1 0 0 0\n3 0 0 0\n");
    assert!(message("a.ele").contains("line 3: expected node 2, found node 3"), "{}", message("a.ele"));
    file("a.node", "2 3 0 0\n1 0 0 0\n2 0 0\n");
    assert!(message("a.ele").contains("line 3: node coordinate is missing"), "{}", message("a.ele"));
    file("a.node", "2 3 0 0\n1 0 0 0\n2 0 0 0\n");
    assert!(
        message("a.node")
            .contains("a.ele: line 2: an element refers to node 3, but nodes are numbered from 1 to 2"),
        "{}",
        message("a.node")
    );
    file("a.ele", "1 5 0\n");
    assert!(
        message("a.node").contains("line 1: expected tetrahedra with 4 or 10 nodes, found elements with 5"),
        "{}",
        message("a.node")
    );
    file("a.ele", "9999999999 4 0\n");
    assert!(message("a.node").contains("9999999999 elements declared"), "{}", message("a.node"));
    file("a.node", "5000 3 99999 0\n");
    assert!(message("a.node").contains("5000 nodes declared"), "{}", message("a.node"));
}

#[test]
fn tetgen_numbering_starts_at_the_first_number() {
    let folder = tempfile::tempdir().unwrap();
    for base in [0, 1, 17] {
        let row = |i: i32, rest: &str| format!("{} {rest} # remark\n", base + i);
        let nodes: String = (0..4).map(|i| row(i, &format!("{i} 0 0 0.5 7"))).collect();
        fs::write(folder.path().join("a.node"), format!("# made by hand\n\n4 3 1 1\n{nodes}")).unwrap();
        fs::write(
            folder.path().join("a.ele"),
            format!("1 4 1\n{base} {} {} {} {base} -3\n", base + 3, base + 2, base + 1),
        )
        .unwrap();
        fs::write(folder.path().join("a.face"), format!("1 1\n0 {base} {} {} 5\n", base + 1, base + 2))
            .unwrap();
        let mesh = read(folder.path().join("a.node")).unwrap();
        assert_eq!(mesh.cells.connectivity().items(), [3, 2, 1, 0, 0, 1, 2].map(VertexId));
        assert_eq!(mesh.cell_field("tetgen:ref").unwrap().values, Values::I32(vec![-3, 5]));
        assert_eq!(mesh.point_field("tetgen:ref").unwrap().values, Values::I32(vec![7; 4]));
        assert_eq!(mesh.point_field("tetgen:attr1").unwrap().values, Values::F64(vec![0.5; 4]));
    }
}

#[test]
fn a_binary_stl_may_begin_with_solid() {
    let mut bytes = b"solid as binary files should not".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(1u32.to_le_bytes());
    for x in [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend(0u16.to_le_bytes());
    let mesh = parse(".stl", &bytes).unwrap();
    assert_eq!(mesh.points, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert!(mesh.cell_data.is_empty());
}

#[test]
fn solids_become_patches_with_their_names() {
    let facet =
        "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n endloop\nendfacet\n";
    let text = format!(
        "solid wall\n{facet}endsolid wall\nsolid inlet of 3\n{facet}{facet}endsolid\nsolid wall\n{facet}endsolid wall\n"
    );
    let mesh = parse(".stl", text.as_bytes()).unwrap();
    assert_eq!(mesh.points.len(), 3);
    assert_eq!(patch_names(&mesh), ["wall", "inlet of 3", "inlet of 3", "wall"]);
}

#[test]
fn all_statements_of_an_obj_are_kept_or_noted() {
    let text = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0 \\\n 0.5\nv 0 1 0\nv 1 1 0\nvt 0 0\ng left\nf 1/1/1 2//1 3/1\nusemtl red\n\
        g right\nf -4 -3 -2 -1\nl 1 2 3\np 4\nf 1 2 3 4 1\n";
    let mesh = parse(".obj", text).unwrap();
    let kinds =
        [CellKind::TRIANGLE, CellKind::QUAD, CellKind::POLY_LINE, CellKind::VERTEX, CellKind::POLYGON];
    assert_eq!(mesh.cells.kinds(), kinds);
    assert_eq!(mesh.cells.vertices(motet::base::CellId(1)), [0, 1, 2, 3].map(VertexId));
    assert_eq!(mesh.cell_field("patch").unwrap().values, Values::I32(vec![1, 2, 2, 2, 2]));
    let notes = notes_of(".obj", text);
    for word in ["`mtllib`", "`vt`", "`usemtl`", "weights and colours"] {
        assert!(notes.iter().any(|note| note.contains(word)), "{word}: {notes:?}");
    }
}

#[test]
fn medit_marks_round_trip() {
    let text = b"MeshVersionFormatted\n2\nDimension\n3\n# a remark\nVertices\n3\n0 0 0 1\n1 0 0 2\n0 1 0 3\n\
        Triangles 1\n1 2 3 9\nEdges 2\n1 2 4\n2 3 5\nCorners 1\n2\nRidges\n1 2\nRequiredTriangles 1\n1\n\
        Normals 1\n0 0 1\nNormalAtVertices 1\n1 1\nEnd\n";
    let mesh = parse(".mesh", text).unwrap();
    assert_eq!(mesh.point_field("medit:corner").unwrap().values, Values::U8(vec![0, 1, 0]));
    assert_eq!(mesh.cell_field("medit:ridge").unwrap().values, Values::U8(vec![0, 0, 1]));
    assert_eq!(mesh.cell_field("medit:required").unwrap().values, Values::U8(vec![1, 0, 0]));
    assert_eq!(notes_of(".mesh", text).len(), 2, "the two sections of normals");
    let (bytes, lost) = print(".mesh", &mesh, &WriteOptions::default());
    assert!(lost.iter().all(|l| l.contains("order")), "{lost:?}");
    let back = parse(".mesh", &bytes).unwrap();
    assert_eq!(back.point_data, mesh.point_data);
    // Edges come first after reading.
    assert_eq!(back.cell_field("medit:ridge").unwrap().values, Values::U8(vec![0, 1, 0]));
    assert_eq!(back.cell_field("medit:required").unwrap().values, Values::U8(vec![0, 0, 1]));
    assert_eq!(back.cell_field("medit:ref").unwrap().values, Values::I32(vec![4, 5, 9]));
}

#[test]
fn losses_are_reported() {
    let mut mesh =
        Mesh::new(vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], Cells::new());
    mesh.cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    mesh.cells.push(CellKind::QUAD, [0, 1, 2, 3].map(VertexId));
    mesh.cells.push(CellKind::POLYGON, [0, 1, 2, 3, 0].map(VertexId));
    mesh.set_point_field(Field::scalars("pressure", vec![0.0; 4]));
    mesh.set_cell_field(Field::scalars("title", Values::Text(vec![String::new(); 3])));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 1, 1]));
    mesh.label_names.patches.insert(1, "wall".into());
    for (extension, sentences) in [
        (".msh", vec!["1 cells of kind polygon", "text arrays are not written (MSH has none): title"]),
        (
            ".stl",
            vec![
                "1 cells of kind tetra",
                "split into triangles",
                "pressure",
                "title",
                "single precision",
                "patch names",
            ],
        ),
        (".obj", vec!["1 cells of kind tetra", "pressure", "title"]),
        (
            ".mesh",
            vec![
                "1 cells of kind polygon",
                "pressure",
                "title",
                "label names are not written (Medit has none): wall",
                "order",
            ],
        ),
        (".node", vec!["1 cells of kind polygon", "1 cells of kind quad", "attributes", "title", "wall"]),
    ] {
        let (_, lost) = print(extension, &mesh, &WriteOptions::default());
        for sentence in sentences {
            assert!(
                lost.iter().any(|l| l.contains(sentence)),
                "{extension} does not report `{sentence}`: {lost:?}"
            );
        }
    }
}

#[test]
fn a_volume_becomes_its_boundary_in_formats_of_surfaces() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    let tets = [0, 1, 2, 3, 1, 3, 2, 4].map(VertexId).to_vec();
    let mesh = Mesh::new(corners.to_vec(), Cells::uniform(CellKind::TETRA, tets).unwrap());
    for extension in [".stl", ".obj", ".ply", ".off"] {
        let (bytes, lost) = print(extension, &mesh, &WriteOptions::default());
        assert!(lost.iter().any(|l| l.contains("boundary")), "{lost:?}");
        let surface = parse(extension, &bytes).unwrap();
        assert_eq!(surface.cells.counts(), [(CellKind::TRIANGLE, 6)]);
        // Facing outward, a closed surface encloses its volume: 1/6 and 1/3 of the unit cube.
        let volume: f64 = self::corners(&surface)
            .iter()
            .map(|[a, b, c]| {
                a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            })
            .sum();
        assert!((volume / 6.0 - 0.5).abs() < 1e-15, "{extension}: {}", volume / 6.0);
    }
}

#[test]
fn dolfin_tets_are_reoriented_and_marks_become_patches() {
    let text = br#"<?xml version="1.0"?><dolfin><mesh celltype="tetrahedron" dim="3"><vertices size="5">
        <vertex index="0" x="0" y="0" z="0"/><vertex index="1" x="1" y="0" z="0"/><vertex index="2" x="0" y="1" z="0"/>
        <vertex index="3" x="0" y="0" z="1"/><vertex index="4" x="0" y="0" z="-1"/></vertices>
        <cells size="2"><tetrahedron index="0" v0="0" v1="1" v2="2" v3="3"/>
        <tetrahedron index="1" v0="0" v1="1" v2="2" v3="4"/></cells>
        <domains><mesh_value_collection type="uint" dim="2" size="3">
        <value cell_index="0" local_entity="3" value="0"/><value cell_index="1" local_entity="3" value="0"/>
        <value cell_index="1" local_entity="0" value="6"/></mesh_value_collection>
        <mesh_value_collection type="uint" dim="3" size="2"><value cell_index="0" local_entity="0" value="4"/>
        <value cell_index="1" local_entity="0" value="5"/></mesh_value_collection></domains></mesh></dolfin>"#;
    let mesh = parse(".xml", text).unwrap();
    // The second tet lies below its base, so that its sorted vertices make it negative.
    let ids: Vec<u32> = mesh.cells.connectivity().items().iter().map(|v| v.0).collect();
    assert_eq!(ids, [0, 1, 2, 3, 0, 1, 4, 2, 0, 2, 1, 1, 4, 2]);
    assert_eq!(patch_names(&mesh), ["0", "0", "0", "6"], "the first two are cells without a patch");
    assert_eq!(mesh.patches().unwrap().ids, [0, 0, 1, 7]);
    assert_eq!(mesh.regions().unwrap().ids, [4, 5, 0, 0]);
}

#[test]
fn every_real_file_is_read_or_refused_with_a_remedy() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MOTET_DATA").map_or(root, Into::into);
    if !folder.is_dir() {
        println!("skipped: no real meshes in {}", folder.display());
        return;
    }
    let mut folders = vec![folder];
    let mut n_read = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.file_name().unwrap().to_string_lossy().to_lowercase();
            if ![".msh", ".stl", ".obj", ".ply", ".off", ".mesh", ".node", ".ele", ".xml.gz"]
                .iter()
                .any(|e| name.ends_with(e))
            {
                continue;
            }
            match read_noted(&path) {
                Ok((mesh, _)) => {
                    assert!(!mesh.cells.is_empty() && !mesh.points.is_empty(), "{}", path.display());
                    n_read += 1;
                }
                Err(error) => {
                    assert!(["empty", "lfs_pointer"].iter().any(|word| name.contains(word)), "{error}");
                    assert!(error.remedy_text().is_some(), "{error}");
                }
            }
        }
    }
    assert!(n_read > 0);
}

/// A folder in SimVascular's layout: one tet, two of its facets as faces.
fn mesh_complete(folder: &Path, with_ids: bool, face_ids: [i32; 2]) {
    let mut volume = Mesh::new(
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        Cells::uniform(CellKind::TETRA, [0, 1, 2, 3].map(VertexId).to_vec()).unwrap(),
    );
    volume.set_cell_field(Field::scalars("GlobalElementID", vec![1i32]));
    volume.set_point_field(Field::scalars("GlobalNodeID", vec![10i32, 20, 30, 40]));
    fs::create_dir_all(folder.join("mesh-surfaces")).unwrap();
    write(folder.join("mesh-complete.mesh.vtu"), &volume, &WriteOptions::default()).unwrap();
    for (name, ids, face_id) in [("wall", [0, 2, 1], face_ids[0]), ("inlet", [0, 1, 3], face_ids[1])] {
        let points = ids.map(|i: usize| volume.points[i]).to_vec();
        let mut face =
            Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, [0, 1, 2].map(VertexId).to_vec()).unwrap());
        face.set_cell_field(Field::scalars("ModelFaceID", vec![face_id]));
        face.set_cell_field(Field::scalars("GlobalElementID", vec![1i32]));
        if with_ids {
            face.set_point_field(Field::scalars("GlobalNodeID", ids.map(|i| 10 * (i as i64 + 1)).to_vec()));
            // Ids are used, not positions.
            face.points.iter_mut().for_each(|p| p[0] += 0.125);
        }
        write(folder.join("mesh-surfaces").join(name).with_extension("vtp"), &face, &WriteOptions::default())
            .unwrap();
    }
}

#[test]
fn a_mesh_complete_folder_becomes_one_mesh() {
    for (with_ids, face_ids, labels) in
        [(true, [3, 7], [7, 3]), (false, [3, 7], [7, 3]), (true, [1, 1], [1, 2])]
    {
        let folder = tempfile::tempdir().unwrap();
        mesh_complete(folder.path(), with_ids, face_ids);
        let mesh = read(folder.path()).unwrap();
        // Faces in the order of their names.
        assert_eq!(mesh.cells.connectivity().items(), [0, 1, 2, 3, 0, 1, 3, 0, 2, 1].map(VertexId));
        assert_eq!(mesh.patches().unwrap().ids, [0, labels[0], labels[1]]);
        assert_eq!(patch_names(&mesh)[1..], ["inlet", "wall"]);
        assert_eq!(mesh.regions().unwrap().ids, [1, 0, 0]);
        assert_eq!(mesh.cell_field("GlobalElementID").unwrap().values, Values::I32(vec![1; 3]));
        let face_id = &mesh.cell_field("ModelFaceID").unwrap().values;
        assert_eq!(*face_id, Values::I32(vec![0, face_ids[1], face_ids[0]]));
    }
}

#[test]
fn a_face_of_another_volume_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    mesh_complete(folder.path(), true, [1, 2]);
    let path = folder.path().join("mesh-surfaces/wall.vtp");
    let mut face = read(&path).unwrap();
    face.set_point_field(Field::scalars("GlobalNodeID", vec![10i64, 11, 20]));
    write(&path, &face, &WriteOptions::default()).unwrap();
    let error = read(folder.path()).unwrap_err().to_string();
    assert!(
        error.contains(
            "wall.vtp: point 1: 1 of 3 points have a GlobalNodeID that is not in the volume; the first is 11"
        ),
        "{error}"
    );
    face.point_data.clear();
    write(&path, &face, &WriteOptions::default()).unwrap();
    let error = read(folder.path()).unwrap_err().to_string();
    assert!(error.contains("3 of 3 points are not in the volume"), "{error}");
    fs::remove_dir_all(folder.path().join("mesh-surfaces")).unwrap();
    let error = read(folder.path()).unwrap_err().to_string();
    assert!(error.contains("there are no faces (*.vtp)"), "{error}");
}

#[test]
fn polyhedra_go_into_a_simvascular_folder_and_are_no_faces() {
    let mut cells = Cells::new();
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|face| face.map(VertexId));
    let mut rings = Csr::default();
    faces.into_iter().for_each(|ring| rings.push(ring));
    cells.push(CellKind::TRIANGLE, faces[1]);
    cells.push_polyhedron([0, 1, 2, 3].map(VertexId), rings.clone());
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut mesh = Mesh::new(points, cells);
    mesh.set_cell_field(Field::scalars("patch", vec![5i32, 0]));
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("folder");
    write(parent.path().join("folder/"), &mesh, &WriteOptions::default()).unwrap();
    let back = read(&folder).unwrap();
    assert_eq!(back.cells.kinds(), [CellKind::POLYHEDRON, CellKind::TRIANGLE]);
    assert_eq!(back.cells.polyhedron_faces(), [rings]);
    let face = fs::read_dir(folder.join("mesh-surfaces")).unwrap().next().unwrap().unwrap().path();
    fs::copy(folder.join("mesh-complete.mesh.vtu"), &face).unwrap();
    let error = read(&folder).unwrap_err().to_string();
    assert!(error.contains("contains volume cells, but a face must be a surface"), "{error}");
}

#[test]
fn an_entity_gets_a_number_also_where_the_largest_is_taken() {
    let mut mesh = motet::mesh::shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    let n = mesh.cells.len();
    mesh.cell_data.clear();
    // One entity with several labels: version 4 permits one per entity, so new entities are needed.
    mesh.set_cell_field(Field::scalars("gmsh:geometrical", vec![i32::MAX; n]));
    mesh.set_cell_field(Field::scalars("gmsh:physical", (1..).take(n).collect::<Vec<i32>>()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.msh");
    let options = WriteOptions { version: Some("4.1".into()), ..WriteOptions::default() };
    write(&path, &mesh, &options).unwrap();
    let back = read(&path).unwrap();
    assert_eq!(
        back.cell_field("gmsh:physical").unwrap().values,
        mesh.cell_field("gmsh:physical").unwrap().values
    );
}

#[test]
fn a_mesh_round_trips_through_a_simvascular_folder() {
    let mut mesh = motet::mesh::shapes::box_grid([2, 1, 1], [[0.0; 3], [1.0; 3]]);
    mesh.label_names.patches.insert(1, "wall/left".into());
    mesh.set_point_field(Field::scalars("p", (0..mesh.points.len() as i32).collect::<Vec<_>>()));
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("mesh-complete/");
    let lost = write(&folder, &mesh, &WriteOptions::default()).unwrap();
    assert!(lost.is_empty(), "{lost:?}");
    assert!(folder.join("mesh-surfaces/wall_left.vtp").is_file());
    assert!(folder.join("walls_combined.vtp").is_file());
    let back = read(&folder).unwrap();
    assert_eq!(back.points, mesh.points);
    assert_eq!(back.point_field("p"), mesh.point_field("p"));
    // The cells and labels are the same; faces come in the order of their names.
    let cells = |mesh: &Mesh| {
        let labels = mesh.patches().unwrap().ids;
        let mut cells: Vec<_> =
            mesh.cells.iter().map(|(i, kind, v)| (kind, v.to_vec(), labels[i.index()])).collect();
        cells.sort();
        cells
    };
    assert_eq!(cells(&back), cells(&mesh));
    mesh.label_names.patches.insert(1, "wall_left".into());
    assert_eq!(back.label_names.patches, mesh.label_names.patches);
    // Each facet refers to the element behind it: they share its three vertices.
    let elements = back.cell_field("GlobalElementID").unwrap().values.to_i64().unwrap();
    for (i, kind, vertices) in back.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TRIANGLE) {
        let behind = motet::base::CellId::new(elements[i.index()] as usize - 1);
        assert!(vertices.iter().all(|v| back.cells.vertices(behind).contains(v)), "{kind:?} {i}");
    }
    let error = write(&folder, &mesh, &WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("is a folder that is not empty"), "{error}");
    mesh.cell_data.clear();
    let error = write(parent.path().join("bare/"), &mesh, &WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("no surface cell has a patch"), "{error}");
    assert!(!parent.path().join("bare").exists());
    assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
}
