//! The page of a job with operations.

use super::differences::{Cut, merged};
use super::page::{file_name, finding};
use super::setup::{Done, tools_of};
use super::setup_report::{SetupReport, corners_left, loose_part};
use crate::cam::{OperationKind, Remainder, Setup};
use crate::cli::report::{Verdict, gouges};
use crate::plane::{Region, Ring};
use crate::preview::{Difference, Outline, Page, PageOperation, PageProgram, PageTool};

/// The page, with the pictures of the programs in their order, where there are any.
pub(super) fn page(report: &SetupReport, pictures: Vec<Option<Vec<u8>>>) -> String {
    let setup = report.setup;
    let facts = [
        ("drawing", file_name(report.input)),
        ("job", file_name(report.job)),
        ("dialect", report.dialect.name.clone()),
        ("stock", stock(setup)),
        ("safe height", format!("z {} mm", setup.rig.safe_height)),
        ("acceleration", setup.rig.limits.acceleration.map(|a| a.to_string()).join(", ") + " mm/s²"),
    ];
    let findings = report.written.iter().flat_map(|w| w.findings.iter().map(|f| finding(&file_name(&w.path), f)));
    let mut warnings = report.warnings();
    let loose = |d: &Done| loose_part(d, setup).map(|words| format!("{}: {words}", d.check.label));
    warnings.extend(report.done.iter().filter_map(loose));
    let programs = report.written.iter().zip(pictures).map(|(w, picture)| PageProgram {
        name: file_name(&w.path),
        program: &w.program,
        machine: setup.rig.limits,
        tools: tools_of(setup, report.done, w.index).iter().map(|t| PageTool::new(t.number, t)).collect(),
        picture,
    });
    crate::preview::page(&Page {
        title: format!("{}: what will be cut", file_name(report.input)),
        is_good: report.verdict() == Verdict::Good,
        failures: report.failures(),
        facts: facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        operations: report.done.iter().map(|d| operation(report, d)).collect(),
        differences: merged(report.done.iter().flat_map(|d| differences(setup, d)).collect()),
        saved: report.saved.copied(),
        seconds: report.seconds(),
        findings: findings.collect(),
        warnings,
        programs: programs.collect(),
        outlines: outlines(report.done),
        stock_top: setup.stock.top,
    })
}

fn stock(setup: &Setup) -> String {
    let stock = &setup.stock;
    let thickness = stock.thickness.map(|t| format!("{t} mm thick"));
    let parts = [stock.material.clone(), thickness, Some(format!("top at z {} mm", stock.top))];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn operation(report: &SetupReport, done: &Done) -> PageOperation {
    let (check, statistics) = (&done.check, &done.check.statistics);
    PageOperation {
        label: check.label.clone(),
        tool: format!("{}: {}", check.tool, report.setup.tool_of(done.operation).name),
        passes: check.passes[1],
        cut_length: statistics.cut_length_mm,
        depth: statistics.depth_mm,
        seconds: check.seconds,
        gouge: check.gouge.map(|g| g.depth_mm),
        is_good: report.is_good(done),
    }
}

/// What must remain of parts, and what is cut into them.
fn outlines(done: &[Done]) -> Vec<Outline> {
    let mut outlines: Vec<Outline> = Vec::new();
    for planned in done.iter().map(|d| &d.planned) {
        let holes = planned.holes.iter().map(|h| Ring::circle(h.center, 0.5 * h.diameter)).collect();
        let keep = planned.keep.as_ref().map(|k| (k.part.clone(), k.remainder == Remainder::Inside));
        for (region, remains) in keep.into_iter().chain([(Region::new(holes), false)]) {
            let outline = Outline { region, remains };
            if !outline.region.is_empty() && !outlines.contains(&outline) {
                outlines.push(outline);
            }
        }
    }
    outlines
}

fn differences(setup: &Setup, done: &Done) -> Vec<Difference> {
    let (operation, check) = (done.operation, &done.check);
    let tool = setup.tool_of(operation);
    let later = setup.rest_of(operation);
    let cut = Cut {
        operation: check.label.clone(),
        diameter: tool.diameter,
        path_radius: done.path_radius,
        followed_by: later.map(|o| o.label.clone()),
    };
    let mut rows = Vec::new();
    rows.extend(check.gouge.filter(|g| gouges(Some(g))).map(|g| cut.gouge(&g)));
    rows.extend(cut.lost(&done.lost));
    let is_held = !done.planned.tabs.is_empty() || operation.cutting.onion_skin.is_some();
    // Tabs stand where the tool goes around: they are no corners that it does not reach.
    let left = match &operation.kind {
        OperationKind::Profile { .. } if is_held => None,
        OperationKind::Profile { .. } => check.uncut.clone(),
        _ => corners_left(done),
    };
    rows.extend(left.iter().flat_map(|u| cut.uncut(u, &done.lost)));
    rows.extend(cut.islands(&check.islands));
    rows.extend(cut.notices(&done.planned.notices));
    rows
}
