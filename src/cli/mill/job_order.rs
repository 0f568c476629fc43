//! The order of a job: what is cut before it is worked on, and what one operation takes from another.

use super::setup::Done;
use crate::cam::{Geometry, Operation, OperationKind, Planned, Setup, Side, TabPlace, tabs_taken};
use crate::plane::{Point, Region, Ring};

/// A floor thinner than this, in millimetres, holds nothing.
const FILM: f64 = 0.1;

/// Depths nearer to each other than this, in millimetres, are one.
const SAME_DEPTH: f64 = 1e-6;

/// An operation with what it is done to.
pub(super) struct Step<'a> {
    operation: &'a Operation,
    geometry: &'a Geometry,
    planned: &'a Planned,
}

/// The steps of a job.
pub(super) fn steps<'a>(setup: &'a Setup, geometries: &'a [Geometry], planned: &'a [Planned]) -> Vec<Step<'a>> {
    let all = setup.operations.iter().zip(geometries).zip(planned);
    all.map(|((operation, geometry), planned)| Step { operation, geometry, planned }).collect()
}

/// What is wrong with the order, in sentences: parts that are worked on after they have been cut free, and cuts that begin
/// below what is there.
pub(super) fn out_of_order(setup: &Setup, steps: &[Step]) -> Vec<String> {
    let free = late_work(setup, steps, false).map(|(first, later)| {
        let cause = match first.cutting.onion_skin {
            Some(_) => "cuts the last skin below the part",
            None => "cuts the part free",
        };
        format!(
            "operation \"{}\" {cause} before \"{}\" works on it: write it behind that one, or give it tabs",
            first.label, later.label
        )
    });
    free.chain(late_starts(steps)).collect()
}

/// Parts that hang on tabs only when they are worked on: no danger, but no good work either.
pub(super) fn loosened(setup: &Setup, steps: &[Step]) -> Vec<String> {
    let hanging = late_work(setup, steps, true);
    hanging
        .map(|(first, later)| {
            format!(
                "operation \"{}\" leaves the part on its tabs before \"{}\" works on it: what is cut inside first is cut in \
                 firm stock",
                first.label, later.label
            )
        })
        .collect()
}

/// Pairs of an operation and the first later one that works on what it has cut out: on tabs, or free.
fn late_work<'a>(
    setup: &'a Setup,
    steps: &'a [Step],
    on_tabs: bool,
) -> impl Iterator<Item = (&'a Operation, &'a Operation)> {
    steps.iter().enumerate().filter_map(move |(k, first)| {
        let concerned: Vec<&Step> =
            steps[k + 1..].iter().filter(|later| !is_done_to_the_hole(first.operation, later.operation)).collect();
        if concerned.is_empty() {
            return None;
        }
        let loose: Vec<Region> =
            cut_out(setup, first).into_iter().filter(|c| hangs(setup, first, c) == on_tabs).collect();
        let later = concerned.into_iter().find(|later| loose.iter().any(|part| works_on(later.geometry, part)))?;
        Some((first.operation, later.operation))
    })
}

/// Whether the first operation cuts a hole, and the later one goes along its wall: what has fallen out of it does not matter.
fn is_done_to_the_hole(first: &Operation, later: &Operation) -> bool {
    let is_hole = matches!(first.kind, OperationKind::Profile { side: Side::Inside, .. });
    is_hole
        && (later.kind.rest_of().is_some()
            || matches!(later.kind, OperationKind::Profile { .. } | OperationKind::Chamfer { .. }))
}

/// What an operation cuts out of the stock: parts, and what falls out of them.
fn cut_out(setup: &Setup, step: &Step) -> Vec<Region> {
    let goes_through = setup.stock.thickness.is_some_and(|thickness| step.operation.cutting.depth > thickness - FILM);
    let area = &step.geometry.area;
    match step.operation.kind {
        _ if !goes_through => Vec::new(),
        OperationKind::Profile { rest_of: None, side: Side::Outside | Side::On | Side::Inside, .. } => {
            area.components()
        }
        // The islands.
        OperationKind::Pocket { rest_of: None, .. } => {
            let holes = area.rings.iter().filter(|ring| ring.area() < 0.0);
            holes.map(|ring| Region::new(vec![ring.reversed()])).collect()
        }
        OperationKind::Engrave => {
            let closed = step.geometry.lines.iter().filter(|line| line.is_closed).map(|line| &line.ring);
            let solid = |ring: &Ring| if ring.area() < 0.0 { ring.reversed() } else { ring.clone() };
            closed.map(|ring| Region::new(vec![solid(ring)])).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether one of the operation's tabs stands at the part.
fn hangs(setup: &Setup, step: &Step, part: &Region) -> bool {
    // On the path, half a tool beside the outline; with rounded corners a little farther.
    let reach = setup.tool_of(step.operation).diameter + step.operation.cutting.allowance;
    let around = part.bounds().inflated(reach);
    let stands_at = |tab: &TabPlace| around.contains(tab.at) && part.segments().any(|s| s.is_nearer(tab.at, reach));
    step.planned.tabs.iter().any(stands_at)
}

fn works_on(geometry: &Geometry, part: &Region) -> bool {
    let is_inside = |p: Point| part.rings.iter().map(|ring| ring.winding_number(p)).sum::<i32>() > 0;
    let lines = || geometry.lines.iter().flat_map(|line| &line.ring.vertices);
    (!geometry.area.is_empty() && part.overlaps(&geometry.area)) || lines().any(|v| is_inside(v.point))
}

/// Operations that begin below the top of the stock where none before them has cut as deep.
fn late_starts(steps: &[Step]) -> impl Iterator<Item = String> {
    steps.iter().enumerate().filter_map(|(k, step)| {
        let start = step.operation.cutting.start_depth;
        let clears = |before: &&Step| {
            let is_deep = before.operation.cutting.depth >= start - SAME_DEPTH;
            let is_there = matches!(before.operation.kind, OperationKind::Facing { .. })
                || before.geometry.area.overlaps(&step.geometry.area)
                || works_on(step.geometry, &before.geometry.area);
            is_deep && is_there
        };
        let is_late = start > SAME_DEPTH && !steps[..k].iter().any(|before| clears(&before));
        is_late.then(|| {
            format!(
                "operation \"{}\" starts {start} mm below the top of the stock, and nothing before it cuts there as deep: leave \
                 start-depth out, or put before it what does",
                step.operation.label
            )
        })
    })
}

/// Tabs that the operation they were made by leaves, and another one takes, in sentences.
pub(super) fn tabs_lost(setup: &Setup, done: &[Done]) -> Vec<String> {
    let mut lost = Vec::new();
    for (k, holding) in done.iter().enumerate().filter(|(_, d)| !d.planned.tabs.is_empty()) {
        for (_, other) in done.iter().enumerate().filter(|(j, _)| *j != k) {
            let radius = setup.tool_of(holding.operation).radius();
            let tool = setup.tool_of(other.operation);
            let count = tabs_taken(&holding.planned.tabs, radius, &other.run, tool);
            if count > 0 {
                let tabs = if count == 1 { "a tab" } else { "tabs" };
                lost.push(format!(
                    "operation \"{}\" takes {tabs} of \"{}\" away, {count} of {}: put them elsewhere (at), or give that one tabs too",
                    other.operation.label,
                    holding.operation.label,
                    holding.planned.tabs.len()
                ));
            }
        }
    }
    lost
}
