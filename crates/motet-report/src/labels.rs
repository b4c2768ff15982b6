//! The patches and regions of an input, which a reader of the page shows, hides and makes transparent one by
//! one; and how opaque each is at first.
//!
//! The rule, for the patches of a frame and for its regions: one is *inside* if the others go around it, by
//! their winding number at its triangles. If one is inside, all that go around it are open: they are drawn
//! at [`OPEN`], so that what they contain is seen. Otherwise everything is opaque. Boxes alone would not do:
//! that of the outlet of a branch lies inside that of the vessel wall.

use std::collections::BTreeMap;

use motet::base::{Point, VertexId};
use motet::geometry::triangle::centroid;
use motet::mesh::bounds;
use motet::spatial::WindingNumber;
use serde::Serialize;

use crate::arrays::{Array, PATCH, REGION};
use crate::part::Frame;

/// The opacity of what is open.
const OPEN: f64 = 0.2;
/// From this winding number on, a point counts as inside. A point on a surface has 0.5; one halfway down a
/// tube without caps, four radii long, 0.89.
const INSIDE: f64 = 0.75;
/// At how many triangles of each patch or region, evenly chosen, the winding number is taken.
const SAMPLES: usize = 32;

/// A patch or a region.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Label {
    /// The index of its array in the list of all arrays.
    pub(crate) array: usize,
    /// The number of the patch or region; `None` for the triangles that have no patch where others have one.
    pub(crate) id: Option<i32>,
    /// How opaque it is at first, from 0 to 1.
    pub(crate) opacity: f64,
}

/// Triangles of the skin, by the label that they have in an array.
type Groups = BTreeMap<Option<i32>, Vec<[VertexId; 3]>>;

/// Adds those patches and regions of a frame that are not known yet.
pub(crate) fn add(labels: &mut Vec<Label>, frame: &Frame) {
    for (array, groups) in frame.arrays.iter().filter_map(|(i, array)| Some((*i, groups(frame, array)?))) {
        let is_known = |id: &Option<i32>| labels.iter().any(|label| (label.array, label.id) == (array, *id));
        if groups.keys().all(is_known) {
            continue;
        }
        let opacities = opacities(&frame.mesh.points, &groups);
        let all = groups.keys().zip(opacities).map(|(&id, opacity)| Label { array, id, opacity });
        let new: Vec<Label> = all.filter(|label| !is_known(&label.id)).collect();
        labels.extend(new);
    }
}

/// The labels of which an array has more than one: those worth a list.
pub(crate) fn listed(labels: &[Label]) -> impl Iterator<Item = &Label> {
    let has_others = |label: &Label| labels.iter().filter(|other| other.array == label.array).count() > 1;
    labels.iter().filter(move |label| has_others(label))
}

fn groups(frame: &Frame, array: &Array) -> Option<Groups> {
    let name = array.key.name.as_str();
    if !array.key.is_label || ![PATCH, REGION].contains(&name) {
        return None;
    }
    let mut groups = Groups::new();
    if name == REGION {
        // Those inside have no triangle of the skin, but cells at a cut.
        let regions = array.values.iter().filter(|value| !value.is_nan());
        groups.extend(regions.map(|&value| (Some(value as i32), Vec::new())));
    }
    for (triangle, &cells) in frame.layout.triangles.iter().zip(&frame.layout.triangle_cells) {
        let value = array.of_triangle(cells);
        let id = (!value.is_nan()).then_some(value as i32);
        // A triangle between cells has no region.
        if id.is_some() || name == PATCH {
            let corners = triangle.map(|v| frame.layout.vertices[v as usize]);
            groups.entry(id).or_default().push(corners);
        }
    }
    Some(groups)
}

/// How opaque each of several surfaces is at first, by the rule above.
fn opacities(points: &[Point], groups: &Groups) -> Vec<f64> {
    let all: Vec<Shape> = groups.values().map(|triangles| Shape::of(points, triangles)).collect();
    let is_inside: Vec<bool> = (0..all.len()).map(|i| is_inside(&all, i)).collect();
    let is_open = |i: usize| {
        let mut inner = (0..all.len()).filter(|&j| j != i && is_inside[j]);
        if is_inside[i] { inner.any(|j| all[j].is_within(&[&all[i]])) } else { inner.next().is_some() }
    };
    (0..all.len()).map(|i| if is_open(i) { OPEN } else { 1.0 }).collect()
}

fn is_inside(all: &[Shape], i: usize) -> bool {
    let others: Vec<&Shape> = (0..all.len()).filter(|&j| j != i).map(|j| &all[j]).collect();
    all[i].is_within(&others)
}

/// One of several surfaces: its box, its winding number, and some of its triangles.
struct Shape {
    bounds: [Point; 2],
    winding: WindingNumber,
    samples: Vec<Point>,
}

impl Shape {
    fn of(points: &[Point], triangles: &[[VertexId; 3]]) -> Self {
        let corners = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
        let all: Vec<Point> = triangles.iter().flat_map(corners).collect();
        let n = triangles.len().min(SAMPLES);
        let sample = |i: usize| centroid(corners(&triangles[i * triangles.len() / n]));
        Self {
            bounds: bounds(&all).unwrap_or_default(),
            winding: WindingNumber::new(points, triangles),
            samples: (0..n).map(sample).collect(),
        }
    }

    /// Whether other surfaces together go around this one. The sign does not count: cells may be numbered
    /// either way.
    fn is_within(&self, others: &[&Self]) -> bool {
        let at = |p: Point| others.iter().map(|other| other.winding.at(p)).sum::<f64>();
        is_box_within(self.bounds, others)
            && !self.samples.is_empty()
            && (self.samples.iter().map(|&p| at(p)).sum::<f64>() / self.samples.len() as f64).abs() > INSIDE
    }
}

/// Whether a box lies inside that of other surfaces together.
fn is_box_within([low, high]: [Point; 2], others: &[&Shape]) -> bool {
    let least = |i: usize| others.iter().map(|other| other.bounds[0][i]).fold(f64::INFINITY, f64::min);
    let most = |i: usize| others.iter().map(|other| other.bounds[1][i]).fold(f64::NEG_INFINITY, f64::max);
    (0..3).all(|i| least(i) <= low[i] && high[i] <= most(i))
}

#[cfg(test)]
mod tests {
    use motet::Mesh;
    use motet::base::CellId;
    use motet::geometry::vector::norm;
    use motet::mesh::shapes::{ball, box_grid, sphere_in_box};
    use motet::mesh::{CellKind, Cells, Field, Surface};

    use super::*;
    use crate::arrays;
    use crate::layout::Layout;
    use crate::part::grid;

    /// The labels of a mesh, each with its name, or its number, and its opacity.
    fn labels(mesh: &Mesh) -> Vec<(String, f64)> {
        let arrays: Vec<_> = arrays::of(mesh, &[]).into_iter().enumerate().collect();
        let layout = Layout::of(mesh);
        let mut labels = Vec::new();
        add(&mut labels, &Frame { mesh, layout: &layout, arrays: &arrays, bad: &[], grid: grid(mesh) });
        let name = |label: &Label| {
            let names = &arrays[label.array].1.names;
            label.id.map_or("none".to_owned(), |id| names.get(&id).cloned().unwrap_or(id.to_string()))
        };
        listed(&labels).map(|label| (name(label), label.opacity)).collect()
    }

    fn opacity(labels: &[(String, f64)], name: &str) -> f64 {
        labels.iter().find(|(own, _)| own == name).expect("the label").1
    }

    /// Surfaces in one mesh, each with a patch of its own, numbered from 1.
    fn together(surfaces: &[Mesh]) -> Mesh {
        let (mut points, mut cells, mut patches) = (Vec::new(), Cells::new(), Vec::new());
        for (mesh, patch) in surfaces.iter().zip(1i32..) {
            let surface = Surface::boundary_of(mesh);
            for triangle in &surface.triangles {
                let corners = triangle.map(|v| VertexId::new(v.index() + points.len()));
                cells.push(CellKind::TRIANGLE, corners);
                patches.push(patch);
            }
            points.extend(surface.points);
        }
        let mut mesh = Mesh::new(points, cells);
        mesh.set_cell_field(Field::scalars("patch", patches));
        mesh
    }

    fn scaled(mesh: &Mesh, factor: f64, shift: f64) -> Mesh {
        let mut mesh = mesh.clone();
        mesh.points.iter_mut().for_each(|p| *p = [factor * p[0] + shift, factor * p[1], factor * p[2]]);
        mesh
    }

    #[test]
    fn a_box_around_a_sphere_is_open() {
        let labels = labels(&sphere_in_box(3, 2));
        assert_eq!((opacity(&labels, "sphere"), opacity(&labels, "box")), (1.0, OPEN));
    }

    #[test]
    fn what_lies_beside_or_is_alone_stays_opaque() {
        let one = ball(4, 2);
        assert!(labels(&together(std::slice::from_ref(&one))).is_empty(), "one patch needs no list");
        let two = labels(&together(&[one.clone(), scaled(&one, 1.0, 3.0)]));
        assert!(two.len() == 2 && two.iter().all(|label| label.1 == 1.0), "{two:?}");
        let sides = labels(&box_grid([2, 3, 4], [[0.0; 3], [1.0; 3]]));
        assert!(sides.len() == 6 && sides.iter().all(|label| label.1 == 1.0), "{sides:?}");
    }

    #[test]
    fn of_nested_balls_all_but_the_innermost_are_open_and_another_inside_beside_them_is_not() {
        let ball = ball(4, 2);
        let all = [
            scaled(&ball, 3.0, 0.0),
            scaled(&ball, 1.0, 1.2),
            scaled(&ball, 0.4, 1.2),
            scaled(&ball, 0.5, -1.0),
        ];
        let labels = labels(&together(&all));
        let opacities: Vec<f64> = labels.iter().map(|label| label.1).collect();
        assert_eq!(opacities, [OPEN, OPEN, 1.0, 1.0]);
    }

    #[test]
    fn the_outlet_of_a_branch_opens_no_wall_though_its_box_lies_inside() {
        // A plate with a short leg in the middle of one side; the end of the leg is the outlet. A second leg,
        // at the rim and longer, makes the box.
        let grid = box_grid([4, 5, 5], [[0.0; 3], [4.0, 5.0, 5.0]]);
        let is_kept = |[x, y, z]: Point| {
            x < 1.0 || (z > 2.0 && z < 3.0 && (y < 1.0 || (y > 2.0 && y < 3.0 && x < 2.0)))
        };
        let mut cells = Cells::new();
        for (_, kind, vertices) in grid.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
            let middle = [0, 1, 2].map(|i| {
                vertices.iter().map(|v| grid.points[v.index()][i]).sum::<f64>() / vertices.len() as f64
            });
            if is_kept(middle) {
                cells.push(kind, vertices.to_vec());
            }
        }
        let surface = Surface::boundary_of(&Mesh::new(grid.points.clone(), cells));
        let is_end = |t: &[VertexId; 3]| {
            t.iter().map(|v| surface.points[v.index()]).all(|p| p[0] == 2.0 && (2.0..=3.0).contains(&p[1]))
        };
        let patches: Vec<i32> = surface.triangles.iter().map(|t| 1 + i32::from(is_end(t))).collect();
        assert!(patches.contains(&2));
        let mut cells = Cells::new();
        surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
        let mut mesh = Mesh::new(surface.points.clone(), cells);
        mesh.set_cell_field(Field::scalars("patch", patches));
        assert_eq!(labels(&mesh), [("1".to_owned(), 1.0), ("2".to_owned(), 1.0)]);
    }

    #[test]
    fn a_region_inside_is_listed() {
        let mut mesh = ball(4, 2);
        let at = |i: usize| mesh.points[mesh.cells.vertices(CellId::new(i))[0].index()];
        let inner = |i: usize| norm(at(i)) < 0.1;
        let regions: Vec<i32> = (0..mesh.cells.len()).map(|i| if inner(i) { 2 } else { 1 }).collect();
        mesh.set_cell_field(Field::scalars("region", regions));
        let labels = labels(&mesh);
        assert_eq!(labels, [("ball".to_owned(), 1.0), ("2".to_owned(), 1.0)]);
    }

    #[test]
    fn an_inner_patch_opens_an_outside_without_patches() {
        let mesh = sphere_in_box(3, 2);
        let patches = mesh.patches().expect("patches");
        let sphere = patches.find("sphere").expect("the sphere");
        let mut bare = mesh.clone();
        let ids: Vec<i32> = patches.ids.iter().map(|&id| if id == sphere { 7 } else { 0 }).collect();
        bare.cell_data.clear();
        bare.label_names = Default::default();
        bare.set_cell_field(Field::scalars("patch", ids));
        let labels = labels(&bare);
        assert_eq!((opacity(&labels, "7"), opacity(&labels, "0")), (1.0, OPEN));
    }
}
