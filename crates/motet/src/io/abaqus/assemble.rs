//! Builds one mesh from the parsed model.

use std::collections::HashMap;

use super::line::Label;
use super::model::Model;
use super::scope::{Scope, Set};
use super::sets::{Context, Members, Numbering, Placed, SetKind};
use super::surfaces::Facets;
use crate::base::{Error, Result, VertexId};
use crate::io::format::Notes;
use crate::io::named_sets::{NSET, Named, NamedSets, Rank, Runs, set_arrays, set_labels};
use crate::io::tags::push_elements;
use crate::mesh::{Cells, Mesh};

/// Puts the instances, then the flat file or the assembly, into one mesh.
pub(super) fn assemble(model: Model<'_>, notes: &Notes) -> Result<Mesh> {
    let (instances, top) = (model.instances, model.top);
    let mut mesh = Mesh::new(Vec::new(), Cells::new());
    let mut placed: Vec<Placed> = Vec::with_capacity(instances.len() + 1);
    let mut instance_of_key = HashMap::new();
    for scope in instances.iter().chain([&top]) {
        let mut here = put(&mut mesh, scope)?;
        for sort in [SetKind::Elements, SetKind::Nodes] {
            let around = Context {
                here: &here,
                instances: &placed,
                instance_of_key: &instance_of_key,
                cells: &mesh.cells,
                notes,
            };
            match sort {
                SetKind::Elements => here.element_sets = around.members(&scope.element_sets, sort)?,
                SetKind::Nodes => here.node_sets = around.members(&scope.node_sets, sort)?,
            }
        }
        if let Some(name) = &scope.name
            && instance_of_key.insert(name.key.clone(), placed.len()).is_some()
        {
            return Err(Error::input(format!("duplicate instance name `{}`", name.shown))
                .remedy("rename one of them"));
        }
        placed.push(here);
    }
    if mesh.points.is_empty() {
        return Err(
            Error::input("there are no nodes").remedy("the file contains no mesh: choose another file")
        );
    }
    let mut facets = Facets::new(&mesh.cells, notes);
    let mut collected = Collected { are_several: instances.len() > 1, ..Collected::default() };
    for (scope, here) in instances.iter().chain([&top]).zip(&placed) {
        let around = Context {
            here,
            instances: &placed,
            instance_of_key: &instance_of_key,
            cells: &mesh.cells,
            notes,
        };
        collected.take(scope, &around, &mut facets)?;
    }
    if collected.n_internal > 0 {
        notes.add(format!("sets for internal use by the preprocessor are skipped: {}", collected.n_internal));
    }
    let n_own = mesh.cells.len();
    let added = facets.added;
    added.into_iter().for_each(|(kind, vertices)| mesh.cells.push(kind, vertices));
    set_labels(&mut mesh, n_own, &collected.of_cells.all, notes);
    set_arrays(&mut mesh.point_data, NSET, collected.of_points.all.iter(), mesh.points.len(), notes);
    Ok(mesh)
}

/// Appends the nodes and elements of a scope to the mesh.
fn put(mesh: &mut Mesh, scope: &Scope) -> Result<Placed> {
    let nodes = Numbering::new(&scope.node_ids, "node", mesh.points.len())?;
    let elements = Numbering::new(&scope.element_ids, "element", mesh.cells.len())?;
    if mesh.points.len() + scope.points.len() > VertexId::MAX_COUNT {
        return Err(Error::input("more nodes than a mesh can hold"));
    }
    mesh.points.extend(scope.points.iter().map(|&p| scope.placement.apply(p)));
    let first = mesh.cells.len() as u32;
    let scoped = scope.element_ids.iter().copied().zip(scope.kinds.iter().copied());
    push_elements(&mut mesh.cells, scoped, &scope.nodes, |node| nodes.place(node))?;
    let cells = first..mesh.cells.len() as u32;
    Ok(Placed { nodes, elements, cells, node_sets: Members::default(), element_sets: Members::default() })
}

/// The sets and surfaces collected from all scopes.
#[derive(Default)]
struct Collected {
    are_several: bool,
    of_cells: NamedSets,
    of_points: NamedSets,
    n_internal: usize,
}

impl Collected {
    fn take(&mut self, scope: &Scope, around: &Context<'_>, facets: &mut Facets<'_>) -> Result<()> {
        let here = around.here;
        for (set, runs) in scope.element_sets.all.iter().zip(&here.element_sets.runs) {
            let has_section = scope.with_section.contains(&set.label.key);
            if let Some(named) = self.named(scope, set, runs, has_section) {
                self.of_cells.add(named);
            }
        }
        for (set, runs) in scope.node_sets.all.iter().zip(&here.node_sets.runs) {
            if let Some(named) = self.named(scope, set, runs, false) {
                self.of_points.add(named);
            }
        }
        for surface in &scope.surfaces {
            let runs = facets.surface(surface, around)?;
            if surface.is_internal {
                self.n_internal += 1;
            } else {
                self.of_cells.add_surface(self.name_in(scope, &surface.label), runs);
            }
        }
        if let Some(label) = scope.name.as_ref().filter(|_| self.are_several && !here.cells.is_empty()) {
            let name = label.shown.clone();
            self.of_cells.add(Named {
                name,
                number: 0,
                runs: vec![here.cells.clone()],
                rank: Rank::Instance,
            });
        }
        Ok(())
    }

    /// The name of a set or surface of a scope, prefixed with the instance name where there are several
    /// instances.
    fn name_in(&self, scope: &Scope, label: &Label) -> String {
        match &scope.name {
            Some(instance) if self.are_several => format!("{}.{}", instance.shown, label.shown),
            _ => label.shown.clone(),
        }
    }

    /// A set as the mesh stores it; `None` for an internal set without a section.
    fn named(&mut self, scope: &Scope, set: &Set, runs: &Runs, has_section: bool) -> Option<Named> {
        let rank = match () {
            () if has_section => Rank::Section,
            () if set.is_internal => {
                self.n_internal += 1;
                return None;
            }
            () if set.is_declared => Rank::Declared,
            () => Rank::OfElements,
        };
        Some(Named { name: self.name_in(scope, &set.label), number: 0, runs: runs.clone(), rank })
    }
}
