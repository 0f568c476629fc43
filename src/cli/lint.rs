//! `clopen lint FILE.nc`: anyone's program.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};

use super::ExitStatus;
use super::check::FormatArg;
use super::{input, output};
use crate::gcode::{Controller, LintOptions, Severity, lint};
use crate::units::Length;

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct LintArgs {
    /// The program; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Whose rules to apply; our own about safe motion always apply [default: both, or what a program written by clopen
    /// says in its header]
    #[arg(long, value_enum)]
    controller: Option<ControllerArg>,
    /// z of the top of the stock
    #[arg(long, value_name = "LENGTH", default_value_t = Length::Millimetres(0.0), allow_hyphen_values = true)]
    stock_top: Length,
    /// How to print the findings
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// `--controller`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ControllerArg {
    /// GRBL 1.1
    Grbl,
    /// LinuxCNC 2.9
    Linuxcnc,
    /// A program that is to run on either
    Both,
}

/// Runs the command: exit status 1 where an error is found.
///
/// # Errors
/// Where the file cannot be read, or is a drawing.
pub(super) fn run(args: &LintArgs) -> Result<ExitStatus> {
    let text = input::read_text(&args.file)?;
    if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') {
        bail!("{}: this is a drawing and no program: name what `clopen mill` wrote", args.file.display());
    }
    let stock_top = input::millimetres(args.stock_top, "--stock-top")?;
    let controller = match args.controller {
        Some(ControllerArg::Grbl) => Controller::Grbl,
        Some(ControllerArg::Linuxcnc) => Controller::LinuxCnc,
        Some(ControllerArg::Both) => Controller::Both,
        None => Controller::of_header(&text).unwrap_or_default(),
    };
    let findings = lint(&text, &LintOptions { controller, stock_top });
    match args.format {
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&findings)? + "\n"))?,
        FormatArg::Text => {
            let lines = findings.iter().map(|f| {
                let severity = format!("{:?}", f.severity).to_lowercase();
                format!("{}:{}: {severity}: {}\n", args.file.display(), f.line, f.message)
            });
            output::print(&lines.collect::<String>())?;
            if findings.is_empty() {
                eprintln!("{}: no findings", args.file.display());
            }
        }
    }
    let failed = findings.iter().any(|f| f.severity == Severity::Error);
    Ok(if failed { ExitStatus::CheckFailed } else { ExitStatus::Done })
}
