//! G-code programs: written, read back, linted.

mod arc_words;
mod block;
mod codes;
mod interpreter;
mod lint;
mod motion;
mod reader;
mod rules;

pub use lint::{Controller, Finding, LOW_TRAVEL, LintOptions, lint};
pub use motion::{Comment, Motion, MotionKind, Point3, Program, ProgramUnit, Trace};
pub use reader::{ReadError, read};
pub use rules::{RULES, Rule, RuleInfo, Severity};
