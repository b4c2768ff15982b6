//! Operations that change a mesh (repair, implantation, filling), and their outcomes.

use std::ffi::{CString, c_char};

use motet::implant::{Device, ImplantWords, InterfaceName, Outside, implant};
use motet::mesh::history::{Changed, History, Rules};
use motet::meshing::layers::Stack;
use motet::meshing::{EdgeLength, Grading, MeshingWords, Surfaces, WallLayers, fill};
use motet::preflight::Role;
use motet::remesh::{EdgeLengths, GoalName, RemeshWords, remesh_mesh};
use motet::{Error, Mesh, Result};
use serde_json::json;

use crate::constants::{self, On};
use crate::guard::{MotetError, guarded, or_default};
use crate::memory::{
    count, expect, free, handle, optional, out_handle, owned, read_versioned, set_handle, text, texts,
    threads, values, values_mut, versioned,
};
use crate::mesh::{MotetMesh, field, json};
use crate::watch::{MotetWatch, Watched};

/// A new mesh, its history, and the report.
pub(crate) struct MotetOutcome {
    mesh: MotetMesh,
    history: Option<History>,
    report: CString,
    /// Why the requested result was not reached; `None` where it was.
    not_reached: Option<CString>,
}

impl MotetOutcome {
    pub(crate) fn new(
        mesh: Mesh,
        history: Option<History>,
        report: &impl serde::Serialize,
        not_reached: Option<String>,
    ) -> Result<Self> {
        // Reasons are written by this library and contain no zero byte.
        let not_reached = not_reached.map(|why| CString::new(why).unwrap_or_default());
        Ok(Self { mesh: MotetMesh(mesh), history, report: json(report)?, not_reached })
    }

    fn history(&self) -> Result<&History> {
        self.history.as_ref().ok_or_else(|| Error::options("a mesh made from surfaces has no history"))
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_complete(outcome: *const MotetOutcome) -> i32 {
    or_default(0, || Some(handle(outcome, "outcome").ok()?.not_reached.is_none().into()))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_mesh(outcome: *const MotetOutcome) -> *const MotetMesh {
    handle(outcome, "outcome").map_or(std::ptr::null(), |outcome| &raw const outcome.mesh)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_report(outcome: *const MotetOutcome) -> *const c_char {
    handle(outcome, "outcome").map_or(std::ptr::null(), |outcome| outcome.report.as_ptr())
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_not_reached(outcome: *const MotetOutcome) -> *const c_char {
    let reason = handle(outcome, "outcome").ok().and_then(|outcome| outcome.not_reached.as_deref());
    reason.map_or(std::ptr::null(), std::ffi::CStr::as_ptr)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_to_old(
    outcome: *const MotetOutcome,
    on: i32,
    old: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let history = handle(outcome, "outcome")?.history()?;
        let kept: Vec<u32> = match constants::on(on)? {
            On::Points => history.vertices.kept().iter().map(|v| v.get().map_or(u32::MAX, |v| v.0)).collect(),
            On::Cells => history.cells.kept().iter().map(|c| c.get().map_or(u32::MAX, |c| c.0)).collect(),
        };
        expect(n, kept.len(), "ids")?;
        let out = values_mut(old, kept.len(), "old")?;
        out.iter_mut().zip(kept).for_each(|(out, old)| *out = crate::memory::id(old));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_transfer(
    outcome: *const MotetOutcome,
    on: i32,
    rule: i32,
    values: *const f64,
    n: i64,
    components: i32,
    out: *mut f64,
    n_out: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let history = handle(outcome, "outcome")?.history()?;
        let field = field("values", values, n, components)?;
        let on = constants::on(on)?;
        let rule = constants::transfer_rule(rule, on)?;
        let new = match on {
            On::Points => history.transfer_points_by(&field, rule)?,
            On::Cells => history.transfer_cells_by(&field, rule)?,
        };
        let new = new.and_then(|field| field.values.to_f64()).unwrap_or_default();
        expect(n_out, new.len() / field.components, "rows")?;
        values_mut(out, new.len(), "out")?.copy_from_slice(&new);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_outcome_free(outcome: *mut MotetOutcome) {
    free(outcome);
}

versioned! {
    /// See the header.
    MotetRemeshOptions, motet_remesh_options_init {
        min_eas: f64 = 0.2,
        min_dihedral_deg: f64 = 0.0,
        best: i32 = 0,
        surface: i32 = 0,
        distance: f64 = 0.0,
        repair_layers: i32 = 0,
        rounds: i32 = 20,
        threads: i32 = 0,
        edge_length: f64 = 0.0,
        sizes: *const f64 = std::ptr::null(),
        n_sizes: i64 = 0,
        hold: *const *const c_char = std::ptr::null(),
        n_hold: i64 = 0,
        watched_by: *mut MotetWatch = std::ptr::null_mut(),
    }
}

impl MotetRemeshOptions {
    fn words(&self) -> Result<RemeshWords> {
        let (surface, distance) = constants::surface_rule(self.surface, self.distance)?;
        Ok(RemeshWords {
            min_eas: self.min_eas,
            min_dihedral_deg: self.min_dihedral_deg,
            goal: if self.best != 0 { GoalName::Best } else { GoalName::Repair },
            surface,
            distance,
            keep_layers: self.repair_layers == 0,
            hold: owned(self.hold, self.n_hold, "hold")?,
            sizes: match self.sizes.is_null() {
                true => optional(self.edge_length).map(EdgeLengths::Everywhere),
                false => {
                    let sizes = values(self.sizes, count(self.n_sizes, "sizes")?, "sizes")?;
                    Some(EdgeLengths::Points(sizes.to_vec()))
                }
            },
            rounds: count(self.rounds.into(), "rounds")?,
        })
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_remesh(
    mesh: *const MotetMesh,
    options: *const MotetRemeshOptions,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(outcome, "outcome")?;
        let mesh = &handle(mesh, "mesh")?.0;
        let given = read_versioned(options)?;
        let options = given.words()?.options(mesh)?;
        let done = Watched::by(given.watched_by).call(&mut threads(given.threads)?, |threads| {
            remesh_mesh(mesh, &options, &Rules::default(), threads)
        })?;
        let Changed { mesh, history, report, .. } = done;
        set_handle(place, MotetOutcome::new(mesh, Some(history), &report, report.not_reached())?);
        Ok(())
    })
}

versioned! {
    /// See the header.
    MotetImplantOptions, motet_implant_options_init {
        inside: i32 = 0,
        conform: i32 = 0,
        tolerance: f64 = 0.0,
        keep_outside: i32 = 0,
        adapt: i32 = 1,
        stray: f64 = -1.0,
        edge_length: f64 = 0.0,
        growth: f64 = 0.5,
        carve: f64 = 1.0,
        reach: f64 = 3.0,
        min_eas: f64 = 0.2,
        threads: i32 = 0,
        watched_by: *mut MotetWatch = std::ptr::null_mut(),
    }
}

impl MotetImplantOptions {
    fn words(&self) -> Result<ImplantWords> {
        Ok(ImplantWords {
            inside: constants::inside(self.inside)?,
            interface: if self.conform != 0 { InterfaceName::Conform } else { InterfaceName::Match },
            tolerance: optional(self.tolerance),
            outside: if self.keep_outside != 0 { Outside::Keep } else { Outside::Cut },
            stray: (self.stray != -1.0).then_some(self.stray),
            adapt: constants::adapt(self.adapt)?,
            size: optional(self.edge_length),
            growth: self.growth,
            carve: self.carve,
            reach: self.reach,
            min_eas: self.min_eas,
            ..ImplantWords::default()
        })
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_implant(
    host: *const MotetMesh,
    devices: *const *const MotetMesh,
    names: *const *const c_char,
    n_devices: i64,
    options: *const MotetImplantOptions,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(outcome, "outcome")?;
        let host = &handle(host, "host")?.0;
        let given = read_versioned(options)?;
        let words = given.words()?;
        let options = words.options()?;
        let meshes = values(devices, count(n_devices, "devices")?, "devices")?;
        let names = texts(names, n_devices, "names")?;
        let device = |(mesh, name): (&*const MotetMesh, &str)| {
            Ok(words.device(handle(*mesh, "device")?.0.clone(), name))
        };
        let devices: Vec<Device> = meshes.iter().zip(names).map(device).collect::<Result<_>>()?;
        let made = Watched::by(given.watched_by).call(&mut threads(given.threads)?, |threads| {
            implant(host, &devices, &options, &Rules::default(), threads)
        })?;
        let Changed { mesh, history, report, .. } = made;
        set_handle(place, MotetOutcome::new(mesh, Some(history), &report, report.not_reached())?);
        Ok(())
    })
}

versioned! {
    /// See the header.
    MotetFillOptions, motet_fill_options_init {
        edge_length: f64 = 0.0,
        graded: i32 = 0,
        growth: f64 = 0.0,
        min_eas: f64 = 0.0,
        layers: i32 = 0,
        first_layer: f64 = 0.0,
        layer_growth: f64 = 1.2,
        keep_prisms: i32 = 0,
        repair: i32 = 0,
        threads: i32 = 0,
        cut: i32 = 0,
        voids: i32 = 0,
        watched_by: *mut MotetWatch = std::ptr::null_mut(),
        unite: i32 = 0,
        wrap: f64 = 0.0,
    }
}

impl MotetFillOptions {
    fn words(&self) -> Result<MeshingWords> {
        let is_graded = self.graded != 0;
        let size = optional(self.edge_length).map(EdgeLength::Length);
        Ok(MeshingWords {
            size: size.or(is_graded.then_some(EdgeLength::Auto)),
            growth: optional(self.growth).or(is_graded.then_some(Grading::default().growth)),
            voids: self.voids != 0,
            min_eas: optional(self.min_eas),
            layers: self.layers()?.into_iter().collect(),
            keep_prisms: self.keep_prisms != 0,
            repair: self.repair != 0,
            cut: self.cut != 0,
            unite: self.unite != 0,
            wrap: optional(self.wrap),
            ..MeshingWords::default()
        })
    }

    fn layers(&self) -> Result<Option<WallLayers>> {
        let count = u32::try_from(self.layers)
            .map_err(|_| Error::options(format!("{} layers, expected 0 or more", self.layers)))?;
        let stack = Stack { count, first: self.first_layer, growth: self.layer_growth };
        Ok((count > 0).then_some(WallLayers { patch: None, stack }))
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_fill(
    surfaces: *const *const MotetMesh,
    names: *const *const c_char,
    is_membrane: *const i32,
    n_surfaces: i64,
    options: *const MotetFillOptions,
    outcome: *mut *mut MotetOutcome,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(outcome, "outcome")?;
        let given = read_versioned(options)?;
        let n = count(n_surfaces, "surfaces")?;
        let (meshes, names) = (values(surfaces, n, "surfaces")?, values(names, n, "names")?);
        let membranes =
            if is_membrane.is_null() { vec![0; n] } else { values(is_membrane, n, "is_membrane")?.to_vec() };
        let one = |i: usize| {
            let role = if membranes[i] != 0 { Role::Membrane } else { Role::Boundary };
            Ok((&handle(meshes[i], "surface")?.0, role, text(names[i], "name")?))
        };
        let all: Vec<(&Mesh, Role, &str)> = (0..n).map(one).collect::<Result<_>>()?;
        let words = given.words()?;
        let (filled, not_reached) =
            Watched::by(given.watched_by).call(&mut threads(given.threads)?, |threads| {
                let mut surfaces = Surfaces::new(&all)?;
                if let Some(repairs) = words.repairs() {
                    surfaces.repair(&repairs, threads)?;
                }
                let preflight = surfaces.preflight(threads);
                let options = words.options(&surfaces, None)?;
                let filled = fill(&surfaces, &preflight, &options, threads)?;
                let not_reached = filled.not_reached(&options);
                Ok((filled, not_reached))
            })?;
        let report = json!({ "filled": filled.report, "improved": filled.improved, "layers": filled.layers });
        set_handle(place, MotetOutcome::new(filled.mesh, None, &report, not_reached)?);
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::Versioned;

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let remesh = MotetRemeshOptions::DEFAULT.words().unwrap();
        assert_eq!(json(&remesh).unwrap(), json(&RemeshWords::default()).unwrap());
        let fill = MotetFillOptions::DEFAULT.words().unwrap();
        assert_eq!(json(&fill).unwrap(), json(&MeshingWords::default()).unwrap());
        let implant = MotetImplantOptions::DEFAULT.words().unwrap();
        assert_eq!(json(&implant).unwrap(), json(&ImplantWords::default()).unwrap());
    }
}
