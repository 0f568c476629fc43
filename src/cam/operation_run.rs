//! The operations of a program: what stands under one comment `(operation NAME)`, or is done with one tool.

use super::motion::{Motion, Program};
use super::tool_table::ToolTable;

/// What a comment that names an operation begins with.
pub const OPERATION_COMMENT: &str = "operation ";

/// What one operation of a program does.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OperationRun {
    /// Its name, or that of its tool.
    pub name: String,
    /// The number of its first tool.
    pub tool: u32,
    /// Its first line.
    pub first_line: usize,
    /// The line of its last motion.
    pub last_line: usize,
    /// Way at a feed below the top of the stock, in millimetres.
    pub cut_length_mm: f64,
    /// How long it takes.
    pub seconds: f64,
    /// The lowest z of a motion below the top of the stock; `None` where there is none.
    pub deepest_z_mm: Option<f64>,
    /// What it removes, in cubic millimetres.
    pub removed_mm3: f64,
}

impl OperationRun {
    pub(super) fn add(&mut self, motion: &Motion, seconds: f64, removed: f64, stock_top: f64) {
        self.last_line = motion.line;
        self.seconds += seconds;
        self.removed_mm3 += removed;
        if motion.is_in_stock(stock_top) {
            if motion.is_feed() {
                self.cut_length_mm += motion.length();
            }
            self.deepest_z_mm = Some(self.deepest_z_mm.map_or(motion.lowest(), |z| z.min(motion.lowest())));
        }
    }

    /// Going up before the first operation, and parking after the last, are none.
    pub(super) fn is_worth_telling(&self) -> bool {
        self.deepest_z_mm.is_some()
    }
}

/// The operations of `program`, each with the index of its first motion, in order; the first begins with the program.
///
/// Where comments name operations, these are they; else each run of motions with one tool is one.
pub(super) fn operation_starts(program: &Program, tools: &ToolTable) -> Vec<(usize, OperationRun)> {
    let start = |index: usize, name: &str| {
        let motion = program.motions.get(index)?;
        let (tool, line) = (motion.tool, motion.line);
        let run = OperationRun {
            name: name.to_owned(),
            tool,
            first_line: line,
            last_line: line,
            cut_length_mm: 0.0,
            seconds: 0.0,
            deepest_z_mm: None,
            removed_mm3: 0.0,
        };
        Some((index, run))
    };
    let named = program.comments.iter().filter_map(|c| Some((c.line, c.text.strip_prefix(OPERATION_COMMENT)?.trim())));
    let mut starts: Vec<(usize, OperationRun)> = Vec::new();
    for (line, name) in named {
        let index = program.motions.partition_point(|m| m.line < line);
        let Some((index, run)) = start(index, name) else { break };
        starts.push((index, OperationRun { first_line: line, ..run }));
    }
    if !starts.is_empty() {
        if starts[0].0 > 0 {
            starts.splice(0..0, start(0, "before the first operation"));
        }
        return starts;
    }
    let title = |tool: u32| match (tools.get(tool), tool) {
        (Some(tool), _) => tool.title(),
        (None, 0) => "no tool".to_owned(),
        (None, number) => format!("tool {number}"),
    };
    let changes = (1..program.motions.len()).filter(|&i| program.motions[i].tool != program.motions[i - 1].tool);
    std::iter::once(0).chain(changes).filter_map(|i| start(i, &title(program.motions.get(i)?.tool))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    fn names(text: &str) -> Vec<(usize, String)> {
        let program = read(text).unwrap();
        let starts = operation_starts(&program, &ToolTable::gather(&[], &program));
        starts.into_iter().map(|(index, run)| (index, run.name)).collect()
    }

    #[test]
    fn comments_name_operations_and_else_tools_do() {
        let text = "G21 G90\nG0 Z5\n(operation holes)\nG0 X1\n(operation outline)\nG0 X2\nG0 X3";
        let expected = [(0, "before the first operation"), (1, "holes"), (2, "outline")];
        assert_eq!(names(text), expected.map(|(i, n)| (i, n.to_owned())));
        let text = "(T2 D=3 CR=0 - drill)\nG21 G90\nG0 Z5\nT1\nG0 X1\nT2\nG0 X2\nG0 X3";
        let expected = [(0, "drill 3 mm, 118 deg"), (1, "tool 1"), (2, "drill 3 mm, 118 deg")];
        assert_eq!(names(text), expected.map(|(i, n)| (i, n.to_owned())));
        assert_eq!(names("(operation nothing)\n"), []);
    }
}
