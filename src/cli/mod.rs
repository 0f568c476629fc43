//! The command line: arguments, one file a command, reports. Alone knows clap and terminals.

pub mod check;
mod clopen;
mod close;
mod engaged;
mod flow;
mod font;
mod input;
mod lint;
mod mill;
mod output;
mod preview;
mod report;
mod simulate;
mod surface;
mod text;
mod time_words;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Morphological closing and opening of outlines; outlines to milling programs that are checked before anything is cut.
#[derive(Debug, Parser)]
#[command(name = "clopen", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Turn the outlines of a drawing into a checked milling program, with a picture and a certificate
    Mill(Box<mill::MillArgs>),
    /// Fill what a disk cannot reach from outside: concave corners get the disk's radius, the rest stays
    Close(close::CloseArgs),
    /// Remove what a disk cannot reach from inside: convex corners get the disk's radius, the rest stays
    Open(close::CloseArgs),
    /// Let outlines flow in time towards their closing, opening or both, and show the states on the way
    Flow(Box<flow::FlowArgs>),
    /// Close and open, one after the other: both bounds on curvature; the report says how much the order matters
    Clopen(clopen::ClopenArgs),
    /// Compare a closed or opened drawing with an independent reference
    Check(check::CheckArgs),
    /// Draw a picture of a drawing (SVG), of a mesh (OBJ, STL, PLY) or of a program (anything else)
    Preview(preview::PreviewArgs),
    /// Set a line of text and close or open its letters
    Text(text::TextArgs),
    /// Restyle a whole font: all its glyphs closed or opened, in an installable TrueType font
    Font(font::FontArgs),
    /// Close, open or clopen a mesh with a ball, and check any such result
    Surface(Box<surface::SurfaceArgs>),
    /// Look for what a controller would refuse and what a machine should not do, in anyone's program
    Lint(lint::LintArgs),
    /// Run anyone's program on a block of stock: what it cuts, how long it takes, and what goes wrong on the way
    Simulate(Box<simulate::SimulateArgs>),
}

/// How a command ended, for those who run it in a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ExitStatus {
    /// Done, and every check passed.
    Done,
    /// Done, and a check failed.
    CheckFailed,
    /// Could not run.
    CouldNotRun,
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> ExitCode {
        ExitCode::from(match status {
            ExitStatus::Done => 0,
            ExitStatus::CheckFailed => 1,
            ExitStatus::CouldNotRun => 2,
        })
    }
}

/// Runs the command that was typed.
pub fn main() -> ExitCode {
    let command = Cli::parse().command;
    output::tidy_when_broken_off();
    let result = match command {
        Command::Mill(args) => mill::run(&args),
        Command::Close(args) => close::run(&args, close::Operation::Close),
        Command::Open(args) => close::run(&args, close::Operation::Open),
        Command::Flow(args) => flow::run(&args),
        Command::Clopen(args) => clopen::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Preview(args) => preview::run(&args),
        Command::Text(args) => text::run(&args),
        Command::Font(args) => font::run(&args),
        Command::Surface(args) => surface::run(&args),
        Command::Lint(args) => lint::run(&args),
        Command::Simulate(args) => simulate::run(&args),
    };
    match result {
        Ok(status) => status.into(),
        Err(error) => {
            output::say(&format!("clopen: {error:#}\n"));
            ExitStatus::CouldNotRun.into()
        }
    }
}
