//! Programs that are run one after the other on the same stock, as those of a job for a machine that cannot change tools.

use super::motion::{Program, ProgramUnit};
use super::tool::Tool;
use super::tool_table::ToolTable;

/// Appends `next`, whose lines are counted on from `lines`; `given` are tools that are known besides its comments.
///
/// The tool that it starts with without naming it gets the number that its comments tell. What it leaves open when it begins,
/// it takes from where `before` ended: the machine stands there.
pub fn append(before: &mut Program, mut next: Program, lines: usize, given: &[Tool]) {
    let own = ToolTable::gather(given, &next).get(0).map_or(0, |tool| tool.number);
    let factor = |unit: Option<ProgramUnit>| unit.unwrap_or(ProgramUnit::Millimetre).millimetres();
    before.unit = match before.motions.is_empty() {
        true => next.unit,
        false => before.unit.filter(|_| factor(before.unit) == factor(next.unit)),
    };
    let mut place = before.motions.last().map(|m| m.to);
    for motion in &mut next.motions {
        motion.line += lines;
        if motion.tool == 0 {
            motion.tool = own;
        }
        let Some(here) = &mut place else { continue };
        let travels = motion.trace().next().is_some();
        if travels {
            (motion.from.x, motion.from.y) = (here.x, here.y);
            place = None;
            continue;
        }
        // Up and down where the machine stands.
        let (from, to) = (motion.from, motion.to);
        motion.from = *here;
        if to.z != from.z {
            here.z = to.z;
        }
        motion.to = *here;
    }
    for comment in &mut next.comments {
        comment.line += lines;
    }
    before.motions.append(&mut next.motions);
    before.comments.append(&mut next.comments);
    before.end_line = next.end_line.map(|line| line + lines);
    before.spindle_speed = before.spindle_speed.max(next.spindle_speed);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::Point3;
    use crate::gcode::read;

    #[test]
    fn the_second_goes_on_where_the_first_ended() {
        let mut program =
            read("(tool 3 \"drill\" flat diameter 3 mm)\nG21 G90\nG0 Z5\nG0 X10 Y20\nG1 Z-2 F100\nG0 Z5\nM2\n")
                .unwrap();
        let next =
            read("(tool 1 \"mill\" flat diameter 6 mm)\nG21 G90\nG0 Z5\nG4 P1\nG0 X40 Y20\nG1 Z-1 F100\nM2\n").unwrap();
        append(&mut program, next, 7, &[]);
        let second: Vec<_> = program.motions.iter().filter(|m| m.line > 7).collect();
        assert_eq!(
            (second[0].line, second[0].from, second[0].to),
            (10, Point3::new(10.0, 20.0, 5.0), Point3::new(10.0, 20.0, 5.0))
        );
        let travel = second.iter().find(|m| m.line == 12).unwrap();
        assert_eq!((travel.from, travel.to), (Point3::new(10.0, 20.0, 5.0), Point3::new(40.0, 20.0, 5.0)));
        assert!(program.motions.windows(2).all(|pair| pair[0].to == pair[1].from), "no gap: {:#?}", program.motions);
        assert!(second.iter().all(|m| m.tool == 1), "named by its comment");
        assert_eq!(program.end_line, Some(14));
        assert_eq!(ToolTable::gather(&[], &program).iter().count(), 2);
    }
}
