//! The command line: arguments, commands, reports.

pub mod check;
