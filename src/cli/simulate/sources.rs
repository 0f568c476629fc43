//! The programs of a simulation, whose lines are counted through.

use std::path::PathBuf;

use serde::Serialize;

/// One program.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Source {
    pub(super) path: PathBuf,
    /// How many lines the programs before it have.
    pub(super) lines_before: usize,
}

/// All of them in their order; at least one.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub(super) struct Sources(pub(super) Vec<Source>);

impl Sources {
    /// The names, in their order.
    pub(super) fn names(&self) -> String {
        self.0.iter().map(|s| s.path.display().to_string()).collect::<Vec<_>>().join(", ")
    }

    /// Before a line: nothing, or of which of several programs it is; and its number there.
    pub(super) fn place(&self, line: usize) -> (String, usize) {
        let source = self.0.iter().rev().find(|s| s.lines_before < line);
        match source {
            Some(source) if self.0.len() > 1 => (format!("{}: ", source.path.display()), line - source.lines_before),
            _ => (String::new(), line),
        }
    }

    /// A line in words.
    pub(super) fn words(&self, line: usize) -> String {
        let (file, line) = self.place(line);
        format!("{file}line {line}")
    }
}
