//! The command-line call: its verbs, and the options common to all of them.

use clap::{Args, Parser, Subcommand};
use motet::base::Threads;

use crate::verbs::{
    cap, contact, convert, demo, implant, info, meshing, moving, refine, remesh, report, run,
};

/// motet keeps tetrahedral meshes good while the world in them moves.
#[derive(Debug, Parser)]
#[command(name = "motet", version, subcommand_required = true, arg_required_else_help = true)]
#[command(max_term_width = 100)]
#[command(after_help = "\
The ending of a file's name says its format: .vtu .vtp .pvd .vtk .msh .mesh .inp .cgns .stl .obj \
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
    Convert(convert::ConvertArgs),
    Cap(cap::CapArgs),
    Mesh(Box<meshing::MeshArgs>),
    Move(Box<moving::MoveArgs>),
    Remesh(Box<remesh::RemeshArgs>),
    Refine(Box<refine::RefineArgs>),
    Implant(Box<implant::ImplantArgs>),
    Contact(Box<contact::ContactArgs>),
    Run(run::RunArgs),
    Report(report::ReportArgs),
    Demo(demo::DemoArgs),
}

/// Options common to all verbs.
#[derive(Debug, Args)]
#[command(next_help_heading = "Everywhere")]
pub(crate) struct Common {
    /// Print one JSON object on standard output and everything else on standard error
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Number of threads; 0 = one per core. Results do not depend on it
    #[arg(long, global = true, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Print only errors (and the JSON object)
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Print more: what is read, found and written, with times
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

impl Common {
    /// The threads that the call requests.
    pub(crate) fn threads(&self) -> motet::Result<Threads> {
        Threads::new(self.threads)
    }
}
