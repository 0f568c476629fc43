//! Every operation of a job held against its program as it was read back.
//!
//! Nothing of how the paths were planned is used: what must remain, how many tabs and holes were asked for and where, and the
//! motions that the text asks for.

use super::Side;
use super::certificate::{ProgramStatistics, statistics};
use super::cone_gouge::deepest_carving;
use super::feeds::Feeds;
use super::gouge::{Gouge, deepest_cut};
use super::islands::{Island, islands};
use super::loose::{LoosePiece, loose_pieces};
use super::motion::{Motion, Program};
use super::operation::{Keep, Planned};
use super::operation_run::OPERATION_COMMENT;
use super::removal::{Uncut, uncut};
use super::setup::{Cutting, Operation, OperationKind, Workpiece};
use super::solid::Remainder;
use super::time::{Machine, motion_seconds};
use super::tool::ToolShape;
use crate::threads::both;

/// How far a tool may pass below the top of a tab, in millimetres: rounding of the text.
const TAB_ROUNDING: f64 = 0.002;

/// How far from the middle of a tab its path is looked for, in millimetres: rounding and arc fitting.
const ON_TAB: f64 = 0.005;

/// How far from the middle of a hole, in tool radii, its bottom is looked for: bored holes are reached beside it.
const IN_HOLE: f64 = 1.05;

/// What a program says of one operation.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OperationCheck {
    /// What it is called.
    pub label: String,
    /// The number of its tool.
    pub tool: u32,
    /// Lengths and counts.
    pub statistics: ProgramStatistics,
    /// Seconds that it takes.
    pub seconds: f64,
    /// The deepest cut into what is drawn to remain.
    pub gouge: Option<Gouge>,
    /// The deepest cut beyond the boundary that the path was meant for.
    pub overcut: Option<Gouge>,
    /// What is left standing beside the outline; only of profiles.
    pub uncut: Option<Uncut>,
    /// What comes loose although tabs were asked for; only of profiles through the stock.
    pub loose: Vec<LoosePiece>,
    /// What is left standing in a pocket.
    pub islands: Vec<Island>,
    /// Tabs that were asked for and placed, and those that the program leaves.
    pub tabs: [usize; 2],
    /// Holes that were asked for, and those that the program reaches the bottom of.
    pub holes: [usize; 2],
    /// Passes that were asked for, and those whose height the program goes down to; 0 where the depth follows from the shape.
    pub passes: [usize; 2],
}

impl OperationCheck {
    /// Whether the program does what was asked, but for what the tool cannot reach.
    pub fn is_done(&self) -> bool {
        self.tabs[0] == self.tabs[1]
            && self.holes[0] == self.holes[1]
            && (self.passes[0] == 0 || self.passes[0] <= self.passes[1])
            && self.islands.is_empty()
    }
}

/// The motions of `program` for each of its operations, in order: those behind each comment that names one.
pub fn split_operations(program: &Program) -> Vec<Program> {
    let named = program.comments.iter().filter(|c| c.text.starts_with(OPERATION_COMMENT));
    let starts: Vec<usize> = named.map(|c| c.line).collect();
    let of = |k: usize| {
        let end = starts.get(k + 1).copied().unwrap_or(usize::MAX);
        let motions = program.motions.iter().filter(|m| m.line > starts[k] && m.line < end);
        Program { motions: motions.copied().collect(), comments: Vec::new(), ..program.clone() }
    };
    (0..starts.len()).map(of).collect()
}

/// Holds `program`, which has the motions of one operation, against what was asked for.
pub fn check_operation(
    program: &Program,
    operation: &Operation,
    planned: &Planned,
    tool: &super::Tool,
    stock: &Workpiece,
    machine: &Machine,
) -> OperationCheck {
    let stock_top = stock.top;
    let against = |f: &dyn Fn(&Keep) -> Option<Gouge>| planned.keep.as_ref().and_then(f);
    let statistics = statistics(program, stock_top);
    let is_through_all = |side: Side| side != Side::On;
    let islands = match (&operation.kind, &planned.keep) {
        // What a larger tool has cut before is no part of this program.
        (OperationKind::Pocket { rest_of: None, .. } | OperationKind::Drill { .. }, Some(keep)) => {
            islands(program, &keep.kept, tool.radius(), keep.floor)
        }
        _ => Vec::new(),
    };
    let feeds = Feeds::new(program);
    let cutting = &operation.cutting;
    let heights: Vec<f64> = match operation.kind {
        OperationKind::Profile { .. } | OperationKind::Pocket { .. } => {
            // Above an onion skin, and through it.
            let floor = stock_top - cutting.depth;
            let skin = cutting.onion_skin.map_or(f64::NEG_INFINITY, |skin| cutting.base(stock) + skin);
            cutting.pass_heights(stock_top).into_iter().filter(|h| *h > skin || h - floor < TAB_ROUNDING).collect()
        }
        _ => Vec::new(),
    };
    let uncut = || match (&operation.kind, &planned.keep) {
        (OperationKind::Profile { side, .. }, Some(keep)) if is_through_all(*side) => {
            Some(uncut(program, &keep.part, keep.remainder, keep.distance, keep.floor))
        }
        _ => None,
    };
    let gouge = || match operation.kind {
        OperationKind::VCarve { .. } => {
            against(&|k| deepest_carving(program, &k.part, tool, stock_top - cutting.start_depth))
        }
        _ => against(&|k| deepest_cut(program, &k.part, k.remainder, k.distance, stock_top)),
    };
    let beside = || against(&|k| beside(program, k, &operation.kind, tool, stock_top));
    let deepest = || gouge().into_iter().chain(beside()).max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm));
    let overcut = || match operation.kind {
        OperationKind::VCarve { .. } => None,
        _ => against(&|k| deepest_cut(program, &k.kept, k.remainder, k.distance, stock_top)),
    };
    let loose = || match operation.kind {
        OperationKind::Profile { .. } if cutting.tabs.is_some() && is_through(cutting, stock) => {
            loose_pieces(program, tool, cutting.base(stock))
        }
        _ => Vec::new(),
    };
    let ((uncut, loose), (gouge, overcut)) = both(|| (uncut(), loose()), || (deepest(), overcut()));
    OperationCheck {
        label: operation.label.clone(),
        tool: tool.number,
        seconds: motion_seconds(program, machine).iter().sum(),
        gouge,
        overcut,
        uncut,
        loose,
        islands,
        tabs: [planned.tabs.len(), planned.tabs.iter().filter(|tab| stands(&feeds, tab, tool.radius())).count()],
        holes: [planned.holes.len(), planned.holes.iter().filter(|hole| is_open(&feeds, hole)).count()],
        passes: [heights.len(), heights_reached(program, &heights)],
        statistics,
    }
}

/// Whether nothing of the stock stays below the cut; so it is taken to be where its thickness is not known.
fn is_through(cutting: &Cutting, stock: &Workpiece) -> bool {
    stock.thickness.is_none_or(|thickness| cutting.depth >= thickness - TAB_ROUNDING)
}

/// The deepest cut into the parts of other operations.
fn beside(program: &Program, keep: &Keep, kind: &OperationKind, tool: &super::Tool, stock_top: f64) -> Option<Gouge> {
    if keep.others.is_empty() {
        return None;
    }
    let radius = match tool.shape {
        // As wide as it is deep, where it is deepest; letters lie within their shapes whatever their depth.
        ToolShape::Cone { .. } if matches!(kind, OperationKind::VCarve { .. }) => return None,
        ToolShape::Cone { .. } => {
            let lowest = program.motions.iter().map(|m| m.to.z).fold(stock_top, f64::min);
            tool.radius_at(stock_top - lowest)
        }
        ToolShape::Flat | ToolShape::Ball => tool.radius(),
    };
    deepest_cut(program, &keep.others, Remainder::Inside, radius, stock_top)
}

/// Of the heights that were asked for, those that the tool is brought down to at a feed.
fn heights_reached(program: &Program, heights: &[f64]) -> usize {
    let reached = |z: f64| program.motions.iter().any(|m| m.is_feed() && (m.to.z - z).abs() <= TAB_ROUNDING);
    heights.iter().filter(|z| reached(**z)).count()
}

/// Whether some motion passes over a tab, and none, not even beside it, takes its middle away.
fn stands(feeds: &Feeds, tab: &super::TabPlace, radius: f64) -> bool {
    let reach = (radius - ON_TAB).max(ON_TAB);
    let passes = |motion: &Motion, distance: f64| motion.trace().any(|s| s.is_nearer(tab.at, distance));
    let is_over = |motion: &Motion| motion.lowest() >= tab.top - TAB_ROUNDING;
    !feeds.any_near(tab.at, reach, |motion| !is_over(motion) && passes(motion, reach))
        && feeds.any_near(tab.at, ON_TAB, |motion| is_over(motion) && passes(motion, ON_TAB))
}

/// How many of the tabs, on a path of a tool of `radius`, lose what they hold on to or their middle to the motions of another
/// program with `tool`.
pub fn tabs_taken(tabs: &[super::TabPlace], radius: f64, program: &Program, tool: &super::Tool) -> usize {
    let feeds = Feeds::new(program);
    let lowest = feeds.lowest();
    // How far beside a tab a motion at a height takes something of it.
    let reach = |tab: &super::TabPlace, height: f64| {
        let below = tab.top - TAB_ROUNDING - height;
        (below > 0.0).then(|| radius + tool.radius_at(below) - ON_TAB)
    };
    let is_taken = |tab: &&super::TabPlace| {
        reach(tab, lowest).is_some_and(|farthest| {
            feeds.any_near(tab.at, farthest, |motion| {
                reach(tab, motion.lowest()).is_some_and(|reach| motion.trace().any(|s| s.is_nearer(tab.at, reach)))
            })
        })
    };
    tabs.iter().filter(is_taken).count()
}

/// Whether some motion at a feed reaches the bottom of a hole.
fn is_open(feeds: &Feeds, hole: &super::Hole) -> bool {
    let reach = IN_HOLE * 0.5 * hole.diameter;
    feeds.any_near(hole.center, reach, |m| {
        (m.to.xy() - hole.center).norm() <= reach && m.to.z <= hole.bottom + TAB_ROUNDING
    })
}
