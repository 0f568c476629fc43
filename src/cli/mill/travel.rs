//! Where the programs of a job take the tool, against what the machine and the clamps leave it.

use super::setup::{Done, Written, tools_of};
use crate::cam::{Setup, Tool};
use crate::plane::Bounds;

/// Which axes would travel farther than the machine can.
pub(super) fn beyond_travel(setup: &Setup, written: &[Written]) -> Vec<String> {
    let Some(travel) = setup.rig.travel else { return Vec::new() };
    let places = || written.iter().flat_map(|w| &w.program.motions).map(|m| m.to);
    let span = |axis: usize| {
        let values = || places().map(|p| p[axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    ["x", "y", "z"]
        .iter()
        .zip(0..3)
        .filter(|(_, axis)| span(*axis) > travel[*axis])
        .map(|(name, axis)| format!("{name} travels {:.1} mm, and the machine {:.1} mm", span(axis), travel[axis]))
        .collect()
}

/// What the tools sweep at a feed, as [least, most] along x, y and z in millimetres; `None` where nothing is cut.
pub(super) fn extents(setup: &Setup, done: &[Done], written: &[Written]) -> Option<[[f64; 2]; 3]> {
    let mut all = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for program in written {
        let tools = tools_of(setup, done, program.index);
        for motion in program.program.motions.iter().filter(|m| m.is_feed()) {
            let radius = tools.iter().find(|t| t.number == motion.tool || tools.len() == 1).map_or(0.0, Tool::radius);
            let swept = motion.trace().fold(Bounds::EMPTY.with_point(motion.to.xy()), |b, s| b.union(s.bounds()));
            let Bounds { min, max } = swept.inflated(radius);
            let [low, high] = [motion.from.z.min(motion.to.z), motion.from.z.max(motion.to.z)];
            for (span, [low, high]) in all.iter_mut().zip([[min.x, max.x], [min.y, max.y], [low, high]]) {
                *span = [span[0].min(low), span[1].max(high)];
            }
        }
    }
    all.iter().all(|[low, high]| low <= high).then_some(all)
}

/// The first motion of every program that enters a keepout.
pub(super) fn collisions(setup: &Setup, done: &[Done], written: &[Written]) -> Vec<String> {
    let mut found = Vec::new();
    for program in written {
        let tools = tools_of(setup, done, program.index);
        let radius = |number: u32| {
            let named = tools.iter().find(|t| t.number == number);
            // A program of one tool does not name it.
            named.map_or_else(|| tools.iter().map(Tool::radius).fold(0.0, f64::max), Tool::radius)
        };
        for (number, keepout) in setup.keepouts.iter().enumerate() {
            let entered = program.program.motions.iter().find_map(|m| {
                // Where the machine comes from is not known.
                let (depth, at) = keepout.entered_by(m, radius(m.tool)).filter(|_| m.line > first_travel(program))?;
                Some((m.line, depth, at))
            });
            if let Some((line, depth, at)) = entered {
                let higher = if keepout.top.is_finite() { ", or travel higher (safe-height)" } else { "" };
                found.push(format!(
                    "{}: line {line} takes the tool {depth:.2} mm into keepout {} at ({:.2}, {:.2}): move the clamp or the part{higher}",
                    program.path.display(),
                    number + 1,
                    at.x,
                    at.y
                ));
            }
        }
    }
    found
}

/// The line of the first travel, which starts at an unknown place.
fn first_travel(program: &Written) -> usize {
    program.program.motions.iter().find(|m| m.trace().next().is_some()).map_or(0, |m| m.line)
}

/// Keepouts that the way to the first cut is not known to miss, in sentences: it may begin anywhere.
pub(super) fn unknown_ways(setup: &Setup, written: &[Written]) -> Vec<String> {
    let high = setup.keepouts.iter().zip(1..).filter(|(keepout, _)| keepout.top >= setup.rig.safe_height);
    let places = written.iter().filter_map(|w| w.program.motions.iter().find(|m| m.line == first_travel(w)));
    let Some(first) = places.map(|m| m.to).next() else { return Vec::new() };
    high.map(|(_, number)| {
        format!(
            "keepout {number} is as high as the tool travels ({} mm), and where the tool comes from is not known: bring it to where \
             nothing is between it and ({:.2}, {:.2}) before you start",
            setup.rig.safe_height, first.x, first.y
        )
    })
    .collect()
}
