//! `motet completions` and `motet man`: what packages install beside the program.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;
use motet::Error;

use crate::console::Console;
use crate::outcome::Outcome;

/// Print the completions of a shell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  motet completions bash > ~/.local/share/bash-completion/completions/motet
  motet completions zsh > ~/.zfunc/_motet
  motet completions fish > ~/.config/fish/completions/motet.fish")]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Write the manual pages, one for each verb
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  motet man ~/.local/share/man/man1 && man motet-mesh")]
pub(crate) struct ManArgs {
    /// The folder to write to; it is made if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

pub(crate) fn complete(
    args: &CompletionsArgs,
    mut program: Command,
    console: &Console,
) -> motet::Result<Outcome> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "motet", &mut script);
    console.put(&script);
    Ok(Outcome::Done)
}

pub(crate) fn man(args: &ManArgs, program: Command, console: &Console) -> motet::Result<Outcome> {
    let folder = &args.folder;
    let failed = |e: std::io::Error| Error::output(folder, e);
    std::fs::create_dir_all(folder).map_err(failed)?;
    clap_mangen::generate_to(program, folder).map_err(failed)?;
    console.print(format_args!("wrote motet.1 and a page for each verb to {}", folder.display()));
    Ok(Outcome::Done)
}
