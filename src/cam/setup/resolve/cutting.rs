//! How the operations of a job file cut.

use std::ops::Range;

use super::{LARGEST_LENGTH, Place, Resolver};
use crate::cam::job_file::TypedPathRadius;
use crate::cam::setup::file::{OperationFile, OperationKindName, RatesFile, TabsFile, ToolFile};
use crate::cam::setup::{Cutting, MOST_TABS, Steps, TabPlaces, Tabs, Workpiece};
use crate::cam::{
    DEFAULT_DEPTH_PER_PASS, DEFAULT_DIRECTION, DEFAULT_ENTRY, DEFAULT_FEED, DEFAULT_PATH_RADIUS, DEFAULT_PLUNGE_FEED,
    DEFAULT_SPINDLE_SPEED, PathRadius, Tool,
};
use crate::rolling::Topology;
use crate::units::Speed;

/// Most passes of an operation: more is a slip of the unit.
const MOST_PASSES: f64 = 1000.0;

/// Width of a tab in tool diameters, and its height as a share of the depth, unless they are said.
const DEFAULT_TAB_WIDTH: f64 = 2.0;
const DEFAULT_TAB_HEIGHT: f64 = 0.4;

/// How much deeper than the stock is thick a cut through it goes, in millimetres, so that nothing hangs on by a film.
const THROUGH: f64 = 0.2;

/// How much deeper than the stock is thick an operation may go, in millimetres: into the board below, which lies on the table
/// of the machine. The point of a drill is not counted.
const DEEPEST_BELOW: f64 = 2.0;

impl Resolver<'_> {
    pub(super) fn cutting(
        &mut self,
        file: &OperationFile,
        table: &Range<usize>,
        stock: &Workpiece,
        tool: &Tool,
        rates: &RatesFile,
        kind: OperationKindName,
    ) -> Cutting {
        let place = |key| Place { table, key };
        let start_depth = self.zero_or_more(place("start-depth"), file.start_depth).unwrap_or(0.0);
        let depth = self.depth(file, table, stock, kind);
        if depth <= start_depth && kind != OperationKindName::Chamfer {
            self.at(place("depth"), format!("depth is {depth} mm, not below the start-depth of {start_depth} mm"));
        }
        let point = if tool.is_drill { tool.height_at(tool.radius()).unwrap_or(0.0) } else { 0.0 };
        if let Some(thickness) = stock.thickness
            && depth > thickness + DEEPEST_BELOW + point
            && !matches!(kind, OperationKindName::VCarve | OperationKindName::Chamfer)
        {
            self.at(
                place("depth"),
                format!(
                    "depth is {depth} mm, and the stock is {thickness} mm thick: at most {DEEPEST_BELOW} mm deeper spares what \
                     lies below; through = true goes {THROUGH} mm deeper"
                ),
            );
        }
        let typed = self.flags.depth_per_pass.or(file.depth_per_pass).or(rates.depth_per_pass);
        let depth_per_pass =
            self.above_zero(place("depth-per-pass"), typed).unwrap_or(DEFAULT_DEPTH_PER_PASS.min(0.5 * tool.diameter));
        if depth_per_pass > tool.flute_length {
            self.at(
                place("depth-per-pass"),
                format!(
                    "a pass of {depth_per_pass} mm is deeper than the flutes of tool {}, {} mm",
                    tool.number, tool.flute_length
                ),
            );
        }
        if (depth - start_depth) / depth_per_pass > MOST_PASSES {
            self.at(
                place("depth-per-pass"),
                format!("depth {depth} mm at {depth_per_pass} mm a pass takes more than {MOST_PASSES} passes"),
            );
        }
        let final_pass = self.above_zero(place("final-pass"), file.final_pass);
        if let Some(last) = final_pass.filter(|last| *last > depth_per_pass) {
            self.at(
                place("final-pass"),
                format!("the final pass is {last} mm, more than depth-per-pass, {depth_per_pass} mm"),
            );
        }
        if final_pass.is_some_and(|last| last >= depth - start_depth) {
            self.at(
                place("final-pass"),
                format!(
                    "the final pass is as thick as the cut is deep, {} mm: nothing is left before it",
                    depth - start_depth
                ),
            );
        }
        let steps = [("even", Steps::Even), ("stepped", Steps::Stepped)];
        let feed = self.flags.feed.or(file.feed).or(rates.feed).unwrap_or_else(|| speed(DEFAULT_FEED));
        let plunge_feed = self
            .flags
            .plunge_feed
            .or(file.plunge_feed)
            .or(rates.plunge_feed)
            .unwrap_or_else(|| speed(DEFAULT_PLUNGE_FEED));
        for (key, feed) in [("feed", feed), ("plunge-feed", plunge_feed)] {
            self.rate(place(key), Some(feed.mm_per_min()));
        }
        let spindle = self.flags.spindle_speed.or(file.spindle_speed).or(rates.spindle_speed);
        let spindle_speed = self.rate(place("spindle-speed"), spindle).unwrap_or(DEFAULT_SPINDLE_SPEED);
        let path_radius = match self.flags.path_radius.or(file.path_radius) {
            None => DEFAULT_PATH_RADIUS,
            Some(TypedPathRadius::Auto) => PathRadius::Auto,
            Some(TypedPathRadius::Length(length)) => {
                PathRadius::Length(self.zero_or_more(place("path-radius"), Some(length)).unwrap_or(0.0))
            }
        };
        let allowance = self.zero_or_more(place("allowance"), file.allowance).unwrap_or(0.0);
        if allowance > tool.radius() {
            self.at(
                place("allowance"),
                format!(
                    "allowance is {allowance} mm, more than the radius of the tool, {} mm: the finishing pass would stand in the full material",
                    tool.radius()
                ),
            );
        }
        let tabs =
            file.tabs.as_ref().and_then(|tabs| self.tabs(tabs, table, (depth - start_depth, stock.thickness), tool));
        let onion_skin = self.above_zero(place("onion-skin"), file.onion_skin);
        if onion_skin.is_some_and(|skin| skin >= depth - start_depth) {
            self.at(place("onion-skin"), "the onion skin is as thick as the cut is deep");
        }
        Cutting {
            start_depth,
            depth,
            depth_per_pass,
            steps: self.word(place("passes"), file.passes.as_deref(), &steps, Steps::Even),
            final_pass,
            feed,
            plunge_feed,
            spindle_speed,
            direction: self.flags.direction.or(file.direction).unwrap_or(DEFAULT_DIRECTION),
            path_radius,
            topology: self.flags.topology.or(file.topology).unwrap_or(Topology::Merge),
            entry: self.flags.entry.or(file.entry).unwrap_or(DEFAULT_ENTRY),
            lead: self.above_zero(place("lead"), file.lead),
            tabs,
            onion_skin,
            allowance,
            finish: file.finish.unwrap_or(allowance > 0.0),
        }
    }

    fn depth(&mut self, file: &OperationFile, table: &Range<usize>, stock: &Workpiece, kind: OperationKindName) -> f64 {
        let place = |key| Place { table, key };
        if file.through == Some(true) && self.flags.depth.is_none() {
            if file.depth.is_some() {
                self.at(place("through"), "depth and through contradict each other: leave one out");
            }
            if let Some(thickness) = stock.thickness {
                return thickness + THROUGH;
            }
            self.at(place("through"), "through needs the thickness of the stock: thickness in [stock]");
            return 1.0;
        }
        let typed = self.flags.depth.or(file.depth);
        match (typed, kind) {
            (Some(_), _) => self.above_zero(place("depth"), typed).unwrap_or(1.0),
            // The depth follows from the width.
            (None, OperationKindName::VCarve | OperationKindName::Chamfer) => stock.thickness.unwrap_or(LARGEST_LENGTH),
            (None, _) => {
                self.at(place("depth"), "this operation needs a depth, or through = true");
                1.0
            }
        }
    }

    fn tabs(
        &mut self,
        file: &TabsFile,
        table: &Range<usize>,
        (depth, thickness): (f64, Option<f64>),
        tool: &Tool,
    ) -> Option<Tabs> {
        let place = |key| Place { table, key };
        let said =
            usize::from(file.count.is_some()) + usize::from(file.spacing.is_some()) + usize::from(file.at.is_some());
        if said != 1 {
            self.at(place("tabs"), "tabs need one of count, spacing and at");
            return None;
        }
        let places = match (file.count, &file.at) {
            (Some(0), _) => {
                self.at(place("count"), "count of tabs is 0: leave them out, or ask for some");
                return None;
            }
            (Some(count), _) if count > MOST_TABS => {
                self.at(place("count"), format!("{count} tabs on every outline: at most {MOST_TABS} make sense"));
                return None;
            }
            (Some(count), _) => TabPlaces::Count(count),
            (None, Some(at)) if at.is_empty() || at.len() > MOST_TABS => {
                self.at(
                    place("at"),
                    format!("there are {} places of tabs: name one at least, and at most {MOST_TABS}", at.len()),
                );
                return None;
            }
            (None, Some(at)) => {
                if let Some([x, y]) = at.iter().find(|p| !p.iter().all(|c| c.abs() <= LARGEST_LENGTH)) {
                    self.at(place("at"), format!("[{x}, {y}] is no place of a machine: x and y in millimetres"));
                }
                TabPlaces::At(at.clone())
            }
            (None, None) => TabPlaces::Spacing(self.above_zero(place("spacing"), file.spacing)?),
        };
        let width = self.above_zero(place("width"), file.width).unwrap_or(DEFAULT_TAB_WIDTH * tool.diameter);
        // The tool stands over a tab before its middle is on it, and after.
        let reach = width + tool.diameter;
        if let TabPlaces::Spacing(spacing) = places
            && spacing <= reach
        {
            self.at(
                place("spacing"),
                format!(
                    "tabs of {width} mm every {spacing} mm run into each other: with a tool of {} mm they need more than {reach} mm",
                    tool.diameter
                ),
            );
        }
        let height = self.above_zero(place("height"), file.height).unwrap_or(DEFAULT_TAB_HEIGHT * depth);
        if height > depth {
            self.at(place("height"), format!("tabs of {height} mm are higher than the cut is deep, {depth} mm"));
        } else if let Some(thickness) = thickness.filter(|thickness| height > *thickness) {
            self.at(place("height"), format!("tabs of {height} mm are higher than the stock is thick, {thickness} mm"));
        }
        Some(Tabs { places, width, height })
    }
}

/// What a tool does in a material, over what it does in any.
pub(super) fn rates(tool: &ToolFile, material: Option<&str>) -> RatesFile {
    let special = material.and_then(|m| tool.material.get(m)).cloned().unwrap_or_default();
    RatesFile {
        feed: special.feed.or(tool.feed),
        plunge_feed: special.plunge_feed.or(tool.plunge_feed),
        spindle_speed: special.spindle_speed.or(tool.spindle_speed),
        depth_per_pass: special.depth_per_pass.or(tool.depth_per_pass),
    }
}

fn speed(mm_per_min: f64) -> Speed {
    // The defaults are above zero.
    Speed::from_mm_per_min(mm_per_min).unwrap_or_else(|| unreachable!("a default feed is above zero"))
}
