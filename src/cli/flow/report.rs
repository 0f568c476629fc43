//! What a flow did, in words and as JSON.

use std::path::PathBuf;

use super::record::Recording;
use super::{BoundArg, FlowOptions, OperationArg};
use crate::cli::close::spread;
use crate::flow::End;
use crate::io::svg::Drawing;
use crate::plane::TopologyCount;
use crate::preview::Frame;
use crate::units::Radius;

/// What was done. Lengths are user units of the drawing, times squares of the (largest) radius; places have y down as in
/// SVG.
#[derive(Debug, serde::Serialize)]
pub(super) struct Report {
    operation: Option<OperationArg>,
    bound: BoundArg,
    smallest_radius_units: f64,
    largest_radius_units: f64,
    smallest_radius_mm: Option<f64>,
    largest_radius_mm: Option<f64>,
    edge_length_over_r: f64,
    steps: u64,
    time_r2: f64,
    /// Why it ended before the time that was asked for; none where it did not.
    end: Option<End>,
    largest_last_displacement_edge_lengths: f64,
    swept_square_units: f64,
    moved_fraction: f64,
    vertices_in: usize,
    vertices_kept: usize,
    vertices_out: usize,
    area_in_square_units: f64,
    area_out_square_units: f64,
    topology_in: TopologyCount,
    topology_out: TopologyCount,
    contacts_units: Vec<[f64; 2]>,
    frames: Vec<FrameReport>,
    written: Vec<PathBuf>,
}

/// One of the states.
#[derive(Debug, serde::Serialize)]
struct FrameReport {
    time_r2: f64,
    area_square_units: f64,
}

/// Places named in words; JSON has them all.
const PLACES_SHOWN: usize = 5;

impl Report {
    pub(super) fn new(
        drawing: &Drawing,
        options: &FlowOptions,
        range: [Radius; 2],
        edge: f64,
        recording: &Recording,
        frames: &[Frame],
        written: Vec<PathBuf>,
    ) -> Report {
        let [smallest, largest] = range.map(Radius::get);
        let mm = |units: f64| drawing.mm_per_unit.map(|mm| mm * units);
        let flow = &recording.report;
        let (before, after) = (&drawing.region, frames.last().map(|f| &f.region));
        Report {
            operation: options.op.filter(|_| options.bound == BoundArg::Curvature),
            bound: options.bound,
            smallest_radius_units: smallest,
            largest_radius_units: largest,
            smallest_radius_mm: mm(smallest),
            largest_radius_mm: mm(largest),
            edge_length_over_r: edge,
            steps: flow.steps,
            time_r2: flow.time / (largest * largest),
            end: flow.end,
            largest_last_displacement_edge_lengths: flow.largest,
            swept_square_units: flow.swept,
            moved_fraction: flow.moved_fraction,
            vertices_in: flow.vertices,
            vertices_kept: flow.kept,
            vertices_out: after.map_or(0, |a| a.vertex_count()),
            area_in_square_units: before.area(),
            area_out_square_units: after.map_or(0.0, |a| a.area()),
            topology_in: before.topology(),
            topology_out: after.map_or(TopologyCount { components: 0, holes: 0 }, |a| a.topology()),
            contacts_units: spread(&flow.contacts, smallest).iter().map(|p| [p.x, -p.y]).collect(),
            frames: frames
                .iter()
                .map(|f| FrameReport { time_r2: f.time, area_square_units: f.region.area() })
                .collect(),
            written,
        }
    }

    /// Whether the flow got where it was to go without running into itself.
    pub(super) fn is_good(&self) -> bool {
        is_good(self.end, self.contacts_units.len())
    }

    pub(super) fn lines(&self) -> String {
        let what = match self.operation {
            Some(OperationArg::Close) => "closing",
            Some(OperationArg::Open) => "opening",
            Some(OperationArg::Clopen) => "clopening",
            None => "flow without a bound",
        };
        let range = |low: f64, high: f64, decimals: usize| {
            if low == high { format!("{low:.decimals$}") } else { format!("{low:.decimals$} to {high:.decimals$}") }
        };
        let mm = match (self.smallest_radius_mm, self.largest_radius_mm) {
            (Some(low), Some(high)) => format!(" ({} mm)", range(low, high, 4)),
            _ => String::new(),
        };
        let count = |t: &TopologyCount| format!("{} + {}", t.components, t.holes);
        let mut text = format!(
            "{what} by {} user units{mm} for {:.4} r² in {} steps: {}\n",
            range(self.smallest_radius_units, self.largest_radius_units, 6),
            self.time_r2,
            self.steps,
            ending(self.end),
        );
        text += &format!(
            "{} of {} vertices kept bit for bit, {:.2} % of the boundary moved, area {:+.4} %, parts + holes {} -> {}\n",
            self.vertices_kept,
            self.vertices_in,
            100.0 * self.moved_fraction,
            100.0 * (self.area_out_square_units / self.area_in_square_units - 1.0),
            count(&self.topology_in),
            count(&self.topology_out),
        );
        if !self.contacts_units.is_empty() {
            let places: Vec<String> =
                self.contacts_units.iter().take(PLACES_SHOWN).map(|[x, y]| format!("({x:.2}, {y:.2})")).collect();
            let more = self.contacts_units.len().saturating_sub(PLACES_SHOWN);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            text += &format!(
                "CONTACT: the boundary ran into itself near {}{more}; --on-contact stop ends the flow before\n",
                places.join(" ")
            );
        }
        if self.vertices_out == 0 {
            text += "nothing is left: try a smaller radius, or an earlier --time\n";
        }
        if !self.written.is_empty() {
            let names: Vec<String> = self.written.iter().map(|p| p.display().to_string()).collect();
            text += &format!("wrote {}\n", names.join(", "));
        }
        text
    }
}

fn is_good(end: Option<End>, contacts: usize) -> bool {
    end.is_none_or(End::is_limit) && contacts == 0
}

fn ending(end: Option<End>) -> &'static str {
    match end {
        None => "stopped at --time",
        Some(End::Still) => "the limit, nothing is sharper than the disk any more",
        Some(End::Slow) => "the limit, nothing moves any more",
        Some(End::Contact) => "STOPPED where the boundary ran into itself",
        Some(End::Stalled) => {
            "STALLED, vertices go on moving, and nothing comes of it; try a larger --tolerance, another --edge-length or a smaller --time-step"
        }
        Some(End::Singular) => "STOPPED, a step could not be solved; try a smaller --time-step",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flow_that_did_not_get_there_is_not_good_and_says_what_to_try() {
        assert!([None, Some(End::Still), Some(End::Slow)].iter().all(|end| is_good(*end, 0) && !is_good(*end, 1)));
        for end in [End::Stalled, End::Singular] {
            assert!(!is_good(Some(end), 0));
            assert!(ending(Some(end)).contains("--time-step"));
        }
        assert!(!is_good(Some(End::Contact), 0));
    }
}
