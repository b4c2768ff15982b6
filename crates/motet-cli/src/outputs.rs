//! Checks of output paths before any work, so that a bad path does not waste a long computation.

use std::path::Path;

use motet::{Error, Result, io};

/// Refuses an output that cannot be written, or that would overwrite one of the inputs, which `what` names.
pub(crate) fn check<'a>(output: &Path, inputs: impl IntoIterator<Item = &'a Path>, what: &str) -> Result<()> {
    if io::can_write_series(output) {
        io::can_have_folder(output)?;
    } else {
        io::can_write(output)?;
    }
    match inputs.into_iter().any(|input| io::is_same_file(input, output)) {
        true => Err(Error::options(format!("the result would overwrite {what} that it is made from"))
            .in_file(output)
            .remedy("give --output another name")),
        false => Ok(()),
    }
}

/// Refuses an output that cannot be written, and a history file that would overwrite a mesh or whose folder
/// cannot be made.
pub(crate) fn check_with_history(output: &Path, mesh: &Path, history: Option<&Path>) -> Result<()> {
    io::can_write(output)?;
    history.map_or(Ok(()), |history| check_beside(history, [output, mesh], "history"))
}

/// Refuses a file to be written beside a result (`what` names it) that would overwrite one of the `others` or
/// whose folder cannot be made.
pub(crate) fn check_beside<'a>(
    path: &Path,
    others: impl IntoIterator<Item = &'a Path>,
    what: &str,
) -> Result<()> {
    if others.into_iter().any(|other| other == path) {
        return Err(Error::options(format!("the {what} would overwrite a file of the call"))
            .in_file(path)
            .remedy(format!("give the {what} a file of its own")));
    }
    io::can_have_folder(path)
}
