//! `motet refine`: tets divided where it matters.

mod args;
mod criteria;
mod words;

use motet::mesh::{Field, TetPart};
use motet::refine::wish::{check_expected, coarser, marked};
use motet::refine::wishes_of_all;
use motet::{Error, io};

pub(crate) use args::RefineArgs;

use crate::args::Common;
use crate::console::Console;
use crate::exit::Outcome;
use crate::table::count;
use crate::verbs::remesh::rules;

/// So far: says what would be divided in the first generation, and writes it as the cell array `marked`.
pub(crate) fn run(args: &RefineArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    io::can_write(&args.output)?;
    check_served(args)?;
    let threads = common.threads()?;
    let criteria = criteria::criteria(args, &threads)?;
    let (mut mesh, notes) = io::read_noted(&args.mesh)?;
    notes.iter().for_each(|what| console.warn(what));
    rules(&args.carry, &mesh).map_err(|e| e.in_file(&args.mesh))?;
    let part = TetPart::of(&mesh).map_err(|e| e.in_file(&args.mesh))?;
    let wishes = wishes_of_all(&criteria, &mesh, &part, &threads).map_err(|e| e.in_file(&args.mesh))?;
    let mut limited = wishes.clone();
    args.limits().apply(&part.mesh, &[], &mut limited);
    check_expected(&limited).map_err(|e| e.in_file(&args.mesh))?;
    let marks = marked(&limited);
    let mut is_marked = vec![0u8; mesh.cells.len()];
    marks.iter().for_each(|tet| is_marked[part.tet_to_cell[tet.index()].index()] = 1);
    mesh.set_cell_field(Field::scalars("marked", is_marked));
    let lost = io::write(&args.output, &mesh, &args.writing.options())?;
    lost.iter().for_each(|what| console.warn(what));
    let back = if args.coarsen { coarser(&wishes).len() } else { 0 };
    console.say(format_args!(
        "{} of {} tets would be divided, {} may be taken back",
        count(marks.len()),
        count(part.mesh.tets.len()),
        count(back)
    ));
    Ok(Outcome::Done)
}

fn check_served(args: &RefineArgs) -> motet::Result<()> {
    let asked = [
        (args.surface.is_some(), "--surface"),
        (args.history.is_some(), "--history"),
        (args.quality, "--quality"),
        (args.forget, "--forget"),
        (!args.coarsen_where.is_empty(), "--coarsen-where"),
        (args.generations.is_some_and(|n| n > 1), "--generations"),
    ];
    match asked.into_iter().find(|(is_asked, _)| *is_asked) {
        Some((_, word)) => Err(Error::options(format!("{word} is not served yet"))),
        None => Ok(()),
    }
}
