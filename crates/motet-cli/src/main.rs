//! The program `motet`: arguments in, exit status out.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(motet_cli::run(std::env::args_os()))
}
