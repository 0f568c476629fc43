//! G-code programs: written, read back, linted.

mod arc_words;
mod block;
mod codes;
mod comment;
mod dialect;
mod grid;
mod interpreter;
mod lint;
mod reader;
mod round_arc;
mod rules;
mod writer;

pub use dialect::{Dialect, GRBL, LINUXCNC};
pub use lint::{Controller, DIALECT_COMMENT, Finding, LOW_TRAVEL, LintOptions, lint};
pub use reader::{ReadError, read};
pub use rules::{RULES, Rule, RuleInfo, Severity};
pub use writer::{Arcs, LINES_FOR_ARC_TOLERANCE, Units, WriteError, WriteOptions, write};
