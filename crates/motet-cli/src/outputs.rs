//! Outputs are looked at before any work, so that nothing is worked out in vain.

use std::path::Path;

use motet::{Error, Result, io};

/// Refuses an output that cannot be written, or that would overwrite one of the inputs, which `what` names. A series is many files: its folder
/// is made where there is none.
pub(crate) fn check<'a>(output: &Path, inputs: impl IntoIterator<Item = &'a Path>, what: &str) -> Result<()> {
    if io::is_series(output) {
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.map_or(Ok(()), std::fs::create_dir_all).map_err(|e| Error::io(output, &e))?;
    } else {
        io::can_write(output)?;
    }
    let is_output =
        |input: &Path| input.canonicalize().ok().is_some_and(|a| output.canonicalize().is_ok_and(|b| a == b));
    match inputs.into_iter().any(is_output) {
        true => Err(Error::options(format!("the result would overwrite {what} it is made from"))
            .in_file(output)
            .remedy("give --output another name")),
        false => Ok(()),
    }
}
