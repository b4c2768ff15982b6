//! How a call is parsed: the verbs.

use clap::{Parser, Subcommand};

use crate::common::Common;
use crate::verbs::{
    cap, contact, convert, demo, implant, info, meshing, moving, quality, refine, remesh, report, run, shell,
    surface, view, wall,
};

/// motet keeps tetrahedral meshes good while the world in them moves.
#[derive(Debug, Parser)]
#[command(name = "motet", version, subcommand_required = true, arg_required_else_help = true)]
#[command(max_term_width = 100)]
#[command(after_help = "\
The extension of a file gives its format: .vtu .vtp .pvd .vtk .msh .mesh .inp .cgns .stl .obj \
.node .xml ...

Exit status: 0 done; 2 usage error; 3 an input cannot be read or does not suit the verb; 4 the \
requested result was not reached (what was reached is written, and the reason is reported); 1 \
any other error.

`motet help VERB` describes a verb, with examples.")]
pub(crate) struct Call {
    #[command(subcommand)]
    pub(crate) verb: Verb,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Info(info::InfoArgs),
    Quality(quality::QualityArgs),
    Convert(convert::ConvertArgs),
    Cap(cap::CapArgs),
    Surface(Box<surface::SurfaceArgs>),
    Mesh(Box<meshing::MeshArgs>),
    Wall(Box<wall::WallArgs>),
    Move(Box<moving::MoveArgs>),
    Remesh(Box<remesh::RemeshArgs>),
    Refine(Box<refine::RefineArgs>),
    Implant(Box<implant::ImplantArgs>),
    Contact(Box<contact::ContactArgs>),
    Run(run::RunArgs),
    Report(report::ReportArgs),
    View(view::ViewArgs),
    Demo(demo::DemoArgs),
    Completions(shell::CompletionsArgs),
    Man(shell::ManArgs),
}
