//! Operations that cut what a larger tool has left: what they rest on, and where they may stand.

use super::{Place, Resolver};
use crate::cam::Tool;
use crate::cam::setup::file::SetupFile;
use crate::cam::setup::{Operation, OperationKind};

/// Depths nearer than this, in millimetres, are one: units and sums are rounded.
const SAME_DEPTH: f64 = 1e-6;

/// Whether `earlier` cuts areas or outlines with a tool of this diameter.
fn leaves_rest(earlier: &Operation, tools: &[Tool], diameter: f64) -> bool {
    let is_kind = matches!(earlier.kind, OperationKind::Profile { .. } | OperationKind::Pocket { .. });
    is_kind && tools[earlier.tool].diameter == diameter
}

impl Resolver<'_> {
    /// Refuses rests of tools that have not been there, or not so deep; `operations` stand as in the file.
    pub(super) fn rests(&mut self, file: &SetupFile, operations: &[Operation], tools: &[Tool]) {
        for (k, operation) in operations.iter().enumerate() {
            let Some(diameter) = operation.kind.rest_of() else { continue };
            let own = file.operation.iter().map(|o| o.span());
            // The table that starts on the line of the operation: there is one.
            let Some(table) = own.into_iter().find(|s| self.locator.line(s.start) == operation.line) else { continue };
            let earlier = || operations[..k].iter().filter(|o| leaves_rest(o, tools, diameter));
            let deepest = earlier().map(|o| o.cutting.depth).reduce(f64::max);
            let place = Place { table: &table, key: "rest-of" };
            match deepest {
                None => self.at(
                    place,
                    format!(
                        "no profile or pocket before this operation is cut with the tool of {diameter} mm: put one there, \
                         or leave out rest-of"
                    ),
                ),
                Some(deepest) if deepest < operation.cutting.depth - SAME_DEPTH => self.at(
                    place,
                    format!(
                        "the tool of {diameter} mm has gone {deepest} mm deep, and this operation goes {} mm: below it all is \
                         left, so take the same depth, or leave out rest-of",
                        operation.cutting.depth
                    ),
                ),
                Some(_) => {}
            }
        }
    }
}

/// The operations, all of one tool together as far as that goes: a rest stays behind everything that the larger tool has cut
/// before it. Of one tool they keep their order.
pub(super) fn sorted_by_tool(operations: Vec<Operation>, tools: &[Tool]) -> Vec<Operation> {
    let waits = |k: usize, j: usize| {
        let diameter = operations[k].kind.rest_of();
        j < k && diameter.is_some_and(|d| leaves_rest(&operations[j], tools, d))
    };
    let mut left: Vec<usize> = (0..operations.len()).collect();
    let mut order: Vec<usize> = Vec::with_capacity(left.len());
    while let Some(&first) = left.first() {
        // The first one never waits: all before it is done.
        let tool = operations[first].tool;
        let mut later = Vec::new();
        let mut is_open = true;
        for &k in &left {
            let is_mine = operations[k].tool == tool;
            is_open = is_open && !(is_mine && left.iter().any(|&j| waits(k, j) && !order.contains(&j)));
            if is_mine && is_open { order.push(k) } else { later.push(k) }
        }
        left = later;
    }
    order.into_iter().map(|k| operations[k].clone()).collect()
}
