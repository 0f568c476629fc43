//! Findings about a program, of any origin: what a controller refuses, and what the machine should not do.

use super::block::Block;
use super::interpreter::interpret;
use super::rules::{Rule, Severity};
use super::{GRBL, LINUXCNC};
use crate::cam::{Motion, MotionKind, Program};

/// Whose rules to apply. Our own always apply.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Controller {
    /// GRBL 1.1.
    Grbl,
    /// LinuxCNC 2.9.
    LinuxCnc,
    /// A program that is to run on either.
    #[default]
    Both,
}

/// What the header that clopen writes says before the name of the dialect.
pub const DIALECT_COMMENT: &str = "dialect ";

/// The header of a program is looked for in so many lines.
const HEADER_LINES: usize = 40;

impl Controller {
    /// The controller that the header of a program written by clopen names.
    pub fn of_header(text: &str) -> Option<Controller> {
        let blocks = text.lines().take(HEADER_LINES).map(Block::parse);
        let mut comments = blocks.flat_map(|b| b.comments).skip_while(|c| !c.starts_with("clopen "));
        let name = comments.find_map(|c| c.strip_prefix(DIALECT_COMMENT).map(str::to_owned))?;
        match name.trim() {
            name if name == GRBL.name => Some(Controller::Grbl),
            name if name == LINUXCNC.name => Some(Controller::LinuxCnc),
            _ => None,
        }
    }
}

/// What to hold a program against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LintOptions {
    /// Whose rules.
    pub controller: Controller,
    /// Where the top of the stock lies, z in millimetres.
    pub stock_top: f64,
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
        Finding { line, rule, severity: info.severity, message }
    }
}

/// All findings about `text`, a whole program, by line.
pub fn lint(text: &str, options: &LintOptions) -> Vec<Finding> {
    let read = interpret(text);
    let mut findings = read.findings;
    check_motions(&read.program, options.stock_top, &mut findings);
    check_end(&read.program, text.lines().count(), options.stock_top, &mut findings);
    findings.retain(|f| applies(f.rule, options.controller));
    findings.sort_by_key(|f| f.line);
    findings
}

fn applies(rule: Rule, controller: Controller) -> bool {
    let info = rule.info();
    rule.is_ours()
        || match controller {
            Controller::Grbl => info.grbl_error.is_some(),
            Controller::LinuxCnc => info.linuxcnc_refuses,
            // A rule of the reader itself: nobody can tell what such a program does.
            Controller::Both => true,
        }
        || info.meaning_lost
}

fn check_motions(program: &Program, stock_top: f64, findings: &mut Vec<Finding>) {
    let top = stock_top - HEIGHT_ROUNDING;
    let mut spindle_was_on = false;
    let mut has_dwelt = false;
    let mut said_off = false;
    for (index, motion) in program.motions.iter().enumerate() {
        let mut find = |rule, detail: String| findings.push(Finding::new(motion.line, rule, detail));
        if motion.spindle_on != spindle_was_on {
            (spindle_was_on, has_dwelt, said_off) = (motion.spindle_on, false, false);
        }
        let moves_in_plane = motion.from.xy() != motion.to.xy();
        match motion.kind {
            MotionKind::Dwell { seconds } => has_dwelt |= motion.spindle_on && seconds > 0.0,
            MotionKind::Rapid => {
                if motion.to.z < top && motion.to.z < motion.from.z {
                    find(Rule::RapidPlunge, format!("to z {:.3}", motion.to.z));
                } else if moves_in_plane && motion.lowest() < top {
                    find(Rule::RapidThroughMaterial, format!("at z {:.3}", motion.lowest()));
                } else if moves_in_plane && motion.lowest() < stock_top + LOW_TRAVEL {
                    find(Rule::LowTravel, format!("at z {:.3}", motion.lowest()));
                }
            }
            MotionKind::Feed { .. } | MotionKind::Arc { .. } => {
                if motion.lowest() < top {
                    if !motion.spindle_on && !said_off {
                        find(Rule::SpindleOff, String::new());
                        said_off = true;
                    }
                    if motion.spindle_on && !has_dwelt {
                        find(Rule::NoDwell, String::new());
                        has_dwelt = true;
                    }
                }
                if is_circle_in_path(&program.motions, index) {
                    find(Rule::ArcEndEqualsStart, String::new());
                }
            }
        }
    }
}

/// Whether the motion is a full circle between other motions of one path. A circle that is meant is entered and left
/// by Z, or follows another one.
fn is_circle_in_path(motions: &[Motion], index: usize) -> bool {
    let is_circle = |m: &Motion| matches!(m.kind, MotionKind::Arc { .. }) && m.from.xy() == m.to.xy();
    let is_path = |m: Option<&Motion>| m.is_some_and(|m| m.is_feed() && m.from.xy() != m.to.xy());
    is_circle(&motions[index])
        && is_path(index.checked_sub(1).and_then(|before| motions.get(before)))
        && is_path(motions.get(index + 1))
}

fn check_end(program: &Program, line_count: usize, stock_top: f64, findings: &mut Vec<Finding>) {
    let last_line = program.end_line.unwrap_or(line_count.max(1));
    let mut find = |rule| findings.push(Finding::new(last_line, rule, String::new()));
    if program.end_line.is_none() {
        find(Rule::NoProgramEnd);
    }
    match program.motions.iter().rfind(|m| !matches!(m.kind, MotionKind::Dwell { .. })) {
        None => find(Rule::NoMotion),
        Some(last) if last.to.z < stock_top - HEIGHT_ROUNDING => find(Rule::ToolLeftDown),
        Some(_) => {}
    }
}
