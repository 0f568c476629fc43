//! G-code programs: written, read back, linted.

mod arc_words;
mod block;
mod codes;
mod comment;
mod dialect;
pub mod grbl_settings;
mod grid;
mod header;
mod interpreter;
mod lint;
mod reader;
mod round_arc;
mod rules;
mod writer;

pub use dialect::{
    ArcMismatch, CodeSet, CommentStyle, DIALECT_COMMENT, Dialect, DialectError, GRBL, InvalidCode, LINUXCNC,
    MachineKind, SpindleFull, Statement, TimeUnit, Units, UnknownDialect,
};
pub use header::HeaderStock;
pub use lint::{Finding, LOW_TRAVEL, LintOptions, lint};
pub use reader::{ReadError, read, read_as};
pub use rules::{RULES, Reading, Rule, RuleInfo, RuleScope, Severity};
pub use writer::{
    Arcs, LINES_FOR_ARC_TOLERANCE, ProgramFile, WriteError, WriteOptions, write, write_files, write_steps,
};
