//! The page of a single profile.

use super::differences::{Cut, merged};
use super::{Checked, Plan, Settings};
use crate::cam::{Side, Tool};
use crate::cli::report::{MillReport, Verdict};
use crate::preview::{Outline, Page, PageFinding, PageOperation, PageProgram, PageTool};

/// The name of a file that the page tells of.
pub(super) fn file_name(path: &std::path::Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// What lint says, with the file it says it of.
pub(super) fn finding(file: &str, finding: &crate::gcode::Finding) -> PageFinding {
    PageFinding {
        place: format!("{file}, line {}", finding.line),
        is_error: finding.severity == crate::gcode::Severity::Error,
        message: finding.message.clone(),
        source: finding.source.clone(),
    }
}

/// The page. The report's places are the machine's, as are those of the plan.
pub(super) fn page(
    report: &MillReport,
    settings: &Settings,
    plan: &Plan,
    checked: &Checked,
    name: String,
    picture: Option<Vec<u8>>,
) -> String {
    let job = &settings.job;
    let certificate = &checked.certificate;
    let is_on = job.side == Side::On;
    let cut = Cut {
        operation: "profile".to_owned(),
        diameter: job.tool_diameter,
        path_radius: job.path_radius_mm(),
        followed_by: None,
    };
    let mut differences = cut.lost(&plan.lost);
    differences.extend(certificate.gouge.filter(|_| report.gouges()).map(|g| cut.gouge(&g)));
    if !is_on {
        differences.extend(cut.uncut(&certificate.uncut, &plan.lost));
    }
    let bounds = plan.part.bounds();
    let mut facts = vec![
        ("drawing".to_owned(), file_name(report.input)),
        ("part".to_owned(), format!("{:.2} x {:.2} mm", bounds.width(), bounds.height())),
        ("dialect".to_owned(), settings.dialect.name.clone()),
    ];
    facts.extend(job.summary().into_iter().map(|line| {
        let (name, value) = named(&line);
        (name.to_owned(), value.to_owned())
    }));
    facts.push(("corners".to_owned(), format!("those inside get a radius of {:.3} mm", job.closing_radius())));
    let tool = Tool { name: format!("tool of {} mm", job.tool_diameter), ..Tool::flat(1, job.tool_diameter) };
    let findings = report.findings.iter().map(|f| finding(&name, f)).collect();
    let operation = PageOperation {
        label: format!("profile, {}", format!("{:?}", job.side).to_lowercase()),
        tool: tool.name.clone(),
        passes: certificate.statistics.passes,
        cut_length: certificate.statistics.cut_length_mm,
        depth: certificate.statistics.depth_mm,
        seconds: certificate.time.total_seconds(),
        gouge: certificate.gouge.filter(|_| !is_on).map(|g| g.depth_mm),
        is_good: report.verdict() == Verdict::Good,
    };
    let program = PageProgram {
        name,
        program: &checked.program,
        machine: super::machine(job),
        tools: vec![PageTool::new(1, &tool)],
        picture,
    };
    crate::preview::page(&Page {
        title: format!("{}: what will be cut", file_name(report.input)),
        is_good: report.verdict() == Verdict::Good,
        failures: report.failures(),
        facts,
        operations: vec![operation],
        differences: merged(differences),
        saved: report.saved.copied(),
        seconds: certificate.time.total_seconds(),
        findings,
        warnings: Vec::new(),
        programs: vec![program],
        outlines: vec![Outline { region: plan.part.clone(), remains: job.side != Side::Inside }],
        stock_top: job.stock_top,
    })
}

/// A line of a job's summary as a name and a value: the first word, or two where the second is no number.
fn named(line: &str) -> (&str, &str) {
    let starts_value = |word: &str| word.starts_with(|c: char| c.is_ascii_digit());
    let ends: Vec<usize> = line.match_indices(' ').map(|(at, _)| at).collect();
    let end = ends.iter().find(|at| starts_value(&line[**at + 1..])).or(ends.first());
    end.map_or((line, ""), |at| (&line[..*at], &line[at + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_a_summary_have_names() {
        assert_eq!(named("tool diameter 3 mm"), ("tool diameter", "3 mm"));
        assert_eq!(named("feed 1000 mm/min, plunge feed 300 mm/min"), ("feed", "1000 mm/min, plunge feed 300 mm/min"));
        assert_eq!(named("side outside, direction climb"), ("side", "outside, direction climb"));
        assert_eq!(named("word"), ("word", ""));
    }
}
