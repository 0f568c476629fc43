//! The command `clopen`.

use std::process::ExitCode;

fn main() -> ExitCode {
    clopen::cli::main()
}
