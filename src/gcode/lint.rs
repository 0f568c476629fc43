//! Findings about a program, of any origin: what a controller refuses, and what the machine should not do.

mod motions;

use super::Dialect;
use super::interpreter::interpret;
use super::rules::{Rule, Severity};
use crate::cam::{MotionKind, Program};

/// What to hold a program against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LintOptions<'a> {
    /// Whose rules; our own always apply.
    pub dialect: &'a Dialect,
    /// Where the top of the stock lies, z in millimetres.
    pub stock_top: f64,
}

impl Default for LintOptions<'_> {
    /// A program of unknown destination, the tool set to zero on the stock.
    fn default() -> Self {
        LintOptions { dialect: Dialect::portable(), stock_top: 0.0 }
    }
}

/// One thing found in a program.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// The line, counted from 1.
    pub line: usize,
    /// The rule that is broken.
    pub rule: Rule,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in a sentence.
    pub message: String,
    /// Where the rule comes from: the controller and how it refuses, or who was hurt.
    pub source: String,
}

/// Rapids in XY closer to the stock than this, in millimetres, are a finding: chips and clamps stand higher.
pub const LOW_TRAVEL: f64 = 0.5;

/// Heights closer to the top of the stock than this, in millimetres, are on it: rounding of programs in inches.
const HEIGHT_ROUNDING: f64 = 2e-3;

impl Finding {
    /// A finding about `line`, with what the table says, and what it is about.
    pub(super) fn new(line: usize, rule: Rule, detail: impl Into<String>) -> Finding {
        let info = rule.info();
        let detail: String = detail.into();
        let message = match info.meaning.strip_suffix('.') {
            Some(meaning) if !detail.is_empty() => format!("{meaning} ({detail})."),
            _ => info.meaning.to_owned(),
        };
        Finding { line, rule, severity: info.severity, message, source: info.source.to_owned() }
    }
}

/// All findings about `text`, a whole program, by line.
pub fn lint(text: &str, options: &LintOptions) -> Vec<Finding> {
    let dialect = options.dialect;
    let read = interpret(text, dialect);
    let mut findings = read.findings;
    motions::check(&read.program, &read.tool_changes, options, &mut findings);
    // The first tells enough: until the machine is back at a known place, all others follow from it.
    let below = read.unknown_ways.iter().find(|(_, z)| *z < options.stock_top - HEIGHT_ROUNDING);
    findings.extend(below.map(|(line, _)| Finding::new(*line, Rule::UnknownWay, "")));
    check_end(&read.program, text.lines().count(), options, &mut findings);
    findings.retain(|f| f.rule.is_for(dialect));
    // Behind a line that the controller follows and this reader does not, nobody here knows places, feeds and arcs.
    let lost = findings.iter().filter(|f| f.rule == Rule::NotFollowed).map(|f| f.line).min();
    findings.retain(|f| lost.is_none_or(|lost| f.line < lost) || !f.rule.is_about_places());
    for finding in &mut findings {
        if let Some(how) = dialect.refuses.get(&finding.rule) {
            finding.source = format!("{}: {how}", dialect.name);
        }
    }
    findings.sort_by_key(|f| f.line);
    findings
}

fn check_end(program: &Program, line_count: usize, options: &LintOptions, findings: &mut Vec<Finding>) {
    let last_line = program.end_line.unwrap_or(line_count.max(1));
    let mut find = |rule| findings.push(Finding::new(last_line, rule, String::new()));
    if program.end_line.is_none() && !options.dialect.program_end.is_empty() {
        find(Rule::NoProgramEnd);
    }
    match program.motions.iter().rfind(|m| !matches!(m.kind, MotionKind::Dwell { .. })) {
        None => find(Rule::NoMotion),
        Some(last) if last.to.z < options.stock_top - HEIGHT_ROUNDING => find(Rule::ToolLeftDown),
        Some(_) => {}
    }
}
