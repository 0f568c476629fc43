//! The tools of a program by their numbers.

use std::collections::BTreeMap;

use super::motion::{Program, ProgramUnit};
use super::tool::{Tool, ToolShape};

/// Tools by number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolTable {
    tools: BTreeMap<u32, Tool>,
    /// The only tool that the program itself describes: it is in the spindle where the program names none.
    only: Option<u32>,
}

impl ToolTable {
    /// The tools that `given` and the comments of `program` describe; where both do, what is given holds.
    ///
    /// Comments are understood as [`Tool::comment`] writes them and as [`Tool::from_tool_list`] reads them. Where neither tells
    /// anything of it and the program uses no more than one tool, [`Program::tool_diameter`] is that of a flat one.
    pub fn gather(given: &[Tool], program: &Program) -> ToolTable {
        let unit = program.unit.unwrap_or(ProgramUnit::Millimetre).millimetres();
        let told = program.comments.iter().filter_map(|comment| {
            Tool::from_comment(&comment.text).or_else(|| Tool::from_tool_list(&comment.text, unit))
        });
        let mut tools: BTreeMap<u32, Tool> = told.map(|tool| (tool.number, tool)).collect();
        let only = tools.keys().next().copied().filter(|_| tools.len() == 1);
        let is_told = !tools.is_empty();
        tools.extend(given.iter().map(|tool| (tool.number, tool.clone())));
        if !is_told {
            let first = program.motions.iter().map(|m| m.tool).find(|t| *t != 0).unwrap_or(0);
            let is_one = program.motions.iter().all(|m| m.tool == first || m.tool == 0);
            let diameter = program.tool_diameter().filter(|_| is_one);
            if let Some(diameter) = diameter {
                tools.entry(first).or_insert_with(|| Tool::new(first, ToolShape::Flat, diameter));
            }
        }
        ToolTable { tools, only }
    }

    /// The tool with that number. Where a program names none (0), it is the only one that its comments describe.
    pub fn get(&self, number: u32) -> Option<&Tool> {
        let only = || self.only.filter(|_| number == 0).and_then(|only| self.tools.get(&only));
        self.tools.get(&number).or_else(only)
    }

    /// The tools in the order of their numbers.
    pub fn iter(&self) -> impl Iterator<Item = &Tool> {
        self.tools.values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    fn table(given: &[&str], text: &str) -> ToolTable {
        let given: Vec<Tool> = given.iter().map(|t| t.parse().unwrap()).collect();
        ToolTable::gather(&given, &read(text).unwrap())
    }

    #[test]
    fn what_is_given_beats_what_is_told() {
        let text = "(tool 1 \"mill\" flat diameter 6 mm)\n(T2 D=3. CR=0. - flat end mill)\nG21 G90\nT1\nG0 Z5";
        let told = table(&[], text);
        assert_eq!(told.get(1).map(|t| t.diameter), Some(6.0));
        assert_eq!(told.get(2).map(|t| t.diameter), Some(3.0));
        assert_eq!((told.get(3), told.get(0)), (None, None));
        let given = table(&["1=ball 4mm"], text);
        assert_eq!(given.get(1).map(|t| (t.shape, t.diameter)), Some((ToolShape::Ball, 4.0)));
        assert_eq!(given.iter().count(), 2);
    }

    #[test]
    fn a_given_tool_is_used_where_its_number_is() {
        assert_eq!(table(&["T7=flat 2mm"], "G0 Z5").get(0), None);
        let one = "(tool diameter 3.175 mm)\nG21 G90\nG0 Z5";
        assert_eq!(table(&["T5=flat 6mm"], one).get(0).map(|t| t.diameter), Some(3.175));
        assert_eq!(table(&["0=flat 6mm"], one).get(0).map(|t| t.diameter), Some(6.0));
    }

    #[test]
    fn a_program_that_names_no_tool_uses_the_only_one() {
        let told = "(tool 7 \"mill\" flat diameter 2 mm)\nG0 Z5";
        assert_eq!(table(&[], told).get(0).map(|t| t.number), Some(7));
        assert_eq!(table(&["7=ball 3mm"], told).get(0).map(|t| t.diameter), Some(3.0), "given, it is still that one");
        assert_eq!(table(&["T8=flat 1mm"], told).get(0).map(|t| t.number), Some(7));
        assert_eq!(table(&[], "(tool diameter 3.175 mm)\nG21 G90\nT4\nG0 Z5").get(4).map(|t| t.diameter), Some(3.175));
        let two = table(&[], "(tool diameter 3.175 mm)\nG21 G90\nT4\nG0 Z5\nT5\nG0 X1");
        assert_eq!(two, ToolTable::default(), "whose diameter it is nobody knows");
    }
}
