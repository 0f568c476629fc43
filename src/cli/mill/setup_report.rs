//! What a job with operations came to, in words and as JSON.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use serde_json::json;

use super::notice_words::{MOST_ALIKE, notice_words};
use super::setup::{Done, Written};
use super::travel;
use crate::cam::{LoosePiece, OperationKind, Setup, Side, TabPlaces, Tabs, TimeSaved, Uncut, estimate, uncut};
use crate::cli::report::{GOUGE_LIMIT, Verdict, describe, gouges, older_one};
use crate::cli::time_words::{minutes, sharp, time_saved};
use crate::gcode::{Dialect, MachineKind, Severity};
use crate::rolling::Topology;

/// All that is to be told of a job. Places are in the machine's coordinates.
pub(super) struct SetupReport<'a> {
    pub(super) input: &'a Path,
    pub(super) job: &'a Path,
    pub(super) setup: &'a Setup,
    pub(super) dialect: &'a Dialect,
    pub(super) done: &'a [Done<'a>],
    pub(super) accept_losses: bool,
    pub(super) written: &'a [Written],
    /// Whether the programs are no files, because one cuts into what must remain, into a clamp, or beyond the machine.
    pub(super) is_withheld: bool,
    pub(super) unsafe_travel: &'a [String],
    /// What is worked on after it has been cut free, or begins below what is there.
    pub(super) out_of_order: &'a [String],
    /// What operations take of the tabs of others.
    pub(super) tabs_lost: &'a [String],
    /// What else is unusual.
    pub(super) remarks: &'a [String],
    /// Against paths with sharp inside corners; `None` where nothing is rounded, or they cannot be planned.
    pub(super) saved: Option<&'a TimeSaved>,
    pub(super) files: &'a [PathBuf],
}

/// What is wrong with an operation, and what is only to be known.
struct Words {
    failures: Vec<String>,
    notes: Vec<String>,
}

impl SetupReport<'_> {
    pub(super) fn verdict(&self) -> Verdict {
        if self.failures().is_empty() { Verdict::Good } else { Verdict::Failed }
    }

    /// What is wrong, in sentences.
    pub(super) fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        for done in self.done {
            let words = words(done, self.setup, self.accept_losses, MOST_ALIKE).failures.into_iter();
            failures.extend(words.map(|f| format!("{}: {f}", done.check.label)));
        }
        failures.extend(self.job_failures().cloned());
        for written in self.written {
            if written.findings.iter().any(|f| f.severity == Severity::Error) {
                let (name, dialect) = (written.path.display(), &self.dialect.name);
                failures.push(format!("{name}: {dialect} would refuse the program, or it does harm"));
            }
        }
        failures
    }

    /// What is wrong with the job as a whole, in sentences.
    fn job_failures(&self) -> impl Iterator<Item = &String> {
        // Tape or a vacuum may hold what is cut free, and another program may have cut before.
        let out_of_order = self.out_of_order.iter().filter(|_| !self.accept_losses);
        self.unsafe_travel.iter().chain(self.tabs_lost).chain(out_of_order)
    }

    /// Whether an operation does what was asked.
    pub(super) fn is_good(&self, done: &Done) -> bool {
        words(done, self.setup, self.accept_losses, MOST_ALIKE).failures.is_empty()
    }

    /// What is unusual about the job, in sentences.
    pub(super) fn warnings(&self) -> Vec<String> {
        // Beams and pens have no edges.
        let has_edges = self.dialect.machine == MachineKind::Router;
        let mut warnings = if has_edges { self.setup.cutting_warnings() } else { Vec::new() };
        warnings.extend(self.remarks.iter().cloned());
        warnings.extend(self.out_of_order.iter().filter(|_| self.accept_losses).cloned());
        warnings
    }

    /// Seconds that all programs take.
    pub(super) fn seconds(&self) -> f64 {
        self.written.iter().map(|w| estimate(&w.program, &self.setup.rig.limits).total_seconds()).sum()
    }

    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<24}{:>5}{:>7}{:>10}{:>9}{:>8}{:>11}{:>9}",
            "operation", "tool", "passes", "cut mm", "depth", "time s", "gouge mm", "checked"
        );
        for done in self.done {
            let check = &done.check;
            let gouge = check.gouge.map_or("-".to_owned(), |g| format!("{:.4}", g.depth_mm.max(0.0)));
            let verdict = if words(done, self.setup, self.accept_losses, MOST_ALIKE).failures.is_empty() {
                "good"
            } else {
                "FAILED"
            };
            let label: String = check.label.chars().take(23).collect();
            // Of holes and of what is as deep as it is wide no passes are asked for.
            let passes = match check.passes {
                [0, _] => "-".to_owned(),
                [asked, found] if asked == found => found.to_string(),
                [asked, found] => format!("{found}/{asked}"),
            };
            let _ = writeln!(
                text,
                "{label:<24}{:>5}{passes:>7}{:>10.1}{:>9.3}{:>8.1}{gouge:>11}{verdict:>9}",
                check.tool, check.statistics.cut_length_mm, check.statistics.depth_mm, check.seconds
            );
        }
        if let Some([x, y, z]) = travel::extents(self.setup, self.done, self.written) {
            let _ = writeln!(
                text,
                "{:<24}x {:.2} to {:.2}, y {:.2} to {:.2}, z {:.2} to {:.2} mm, the tools' width included",
                "takes up", x[0], x[1], y[0], y[1], z[0], z[1]
            );
        }
        let _ = writeln!(text, "{:<24}{}", "time", minutes(self.seconds()));
        if let Some(saved) = self.saved {
            let _ = writeln!(text, "{:<24}{}", "time saved", time_saved(saved));
        }
        for done in self.done {
            let words = words(done, self.setup, self.accept_losses, MOST_ALIKE);
            for failure in words.failures {
                let _ = writeln!(text, "FAILED  {}: {failure}", done.check.label);
            }
            for note in words.notes {
                let _ = writeln!(text, "note    {}: {note}", done.check.label);
            }
        }
        for warning in self.warnings() {
            let _ = writeln!(text, "note    {warning}");
        }
        for failure in self.job_failures() {
            let _ = writeln!(text, "FAILED  {failure}");
        }
        for written in self.written {
            for finding in &written.findings {
                let severity = format!("{:?}", finding.severity).to_lowercase();
                let _ = writeln!(text, "{}:{}: {severity}: {}", written.path.display(), finding.line, finding.message);
            }
        }
        for program in self.written.iter().filter(|_| self.is_withheld) {
            let why =
                "a program of this job would cut into the part, or does not stay in the machine and off the clamps";
            let older = older_one(&program.path);
            let _ = writeln!(text, "{:<24}{}: {why}{older}", "NOT WRITTEN", program.path.display());
        }
        for file in self.files {
            let _ = writeln!(text, "{:<24}{}", "written", file.display());
        }
        text
    }

    pub(super) fn json(&self) -> Result<String> {
        let operations: Vec<_> = self
            .done
            .iter()
            .map(|done| {
                let words = words(done, self.setup, self.accept_losses, usize::MAX);
                json!({
                    "check": done.check,
                    "line": done.operation.line,
                    "tabs": done.planned.tabs.iter().map(|t| [t.at.x, t.at.y]).collect::<Vec<_>>(),
                    "failures": words.failures,
                    "notes": words.notes,
                })
            })
            .collect();
        let programs: Vec<_> = self
            .written
            .iter()
            .map(|w| {
                let time = estimate(&w.program, &self.setup.rig.limits);
                json!({ "path": w.path, "time": time, "findings": w.findings })
            })
            .collect();
        let value = json!({
            "drawing": self.input,
            "job": self.job,
            "dialect": self.dialect.name,
            "operations": operations,
            "programs": programs,
            "takes_up_mm": travel::extents(self.setup, self.done, self.written),
            "sharp": self.saved.map(sharp),
            "warnings": self.warnings(),
            "beyond_travel": self.unsafe_travel,
            "out_of_order": self.out_of_order,
            "tabs_lost": self.tabs_lost,
            "gouge_limit_mm": GOUGE_LIMIT,
            "good": self.verdict() == Verdict::Good,
            "written": self.files,
            "withheld": self.is_withheld,
        });
        Ok(serde_json::to_string_pretty(&value)? + "\n")
    }
}

/// What is to be told of an operation; of many words alike the first `most`.
fn words(done: &Done, setup: &Setup, accept_losses: bool, most: usize) -> Words {
    let (check, planned) = (&done.check, &done.planned);
    let mut failures = Vec::new();
    let mut notes = Vec::new();
    if let Some(gouge) = check.gouge.filter(|g| gouges(Some(g))) {
        let remedy = match done.operation.cutting.topology {
            Topology::Keep => ": topology = \"merge\" leaves out what the tool does not fit into",
            Topology::Merge => "",
        };
        failures.push(format!("line {} cuts {:.4} mm into what must remain{remedy}", gouge.line, gouge.depth_mm));
    }
    for (what, [asked, found]) in [("tabs", check.tabs), ("holes", check.holes)] {
        if asked != found {
            failures.push(format!("{asked} {what} were asked for, and the program has {found}"));
        }
    }
    if check.passes[0] > check.passes[1] {
        failures.push(format!("{} passes were asked for, and the program has {}", check.passes[0], check.passes[1]));
    }
    let later = setup.rest_of(done.operation);
    for feature in &done.lost {
        let words = describe(feature, done.width, done.path_radius);
        match later {
            // The smaller tool is held against the same shapes.
            Some(later) => notes.push(format!("{words}; that is left to \"{}\"", later.label)),
            None if accept_losses => notes.push(words),
            None => failures.push(words),
        }
    }
    for island in &check.islands {
        failures
            .push(format!("{:.3} mm stay standing at ({:.3}, {:.3})", island.thickness_mm, island.x_mm, island.y_mm));
    }
    if planned.contradictions > 0 {
        failures.push(format!("{} places of the path are not proved", planned.contradictions));
    }
    if let Some(uncut) = &check.uncut {
        let held = !planned.tabs.is_empty();
        if !uncut.is_cut_free && !held && done.operation.cutting.onion_skin.is_none() && is_closed(done) {
            failures.push("the cut does not go all around".to_owned());
        }
        if let Some(place) = uncut.places.first().filter(|_| !held) {
            notes.push(format!(
                "the tool leaves {:.2} mm² standing beside the outline in {} places, the largest {:.3} mm thick at ({:.3}, {:.3}): a \
                 smaller tool, rest-of, or corners = \"dogbone\" take it",
                uncut.area_mm2,
                uncut.places.len(),
                place.depth_mm,
                place.x_mm,
                place.y_mm
            ));
        }
    }
    if let Some(left) = corners_left(done).filter(|_| later.is_none())
        && let Some(place) = left.places.first()
    {
        notes.push(format!(
            "the tool leaves {:.2} mm² standing in the corners of the pocket in {} places, the largest {:.3} mm thick at ({:.3}, \
             {:.3}): a smaller tool, rest-of, or corners = \"dogbone\" take it",
            left.area_mm2,
            left.places.len(),
            place.depth_mm,
            place.x_mm,
            place.y_mm
        ));
    }
    // Tabs that have places may be meant for some pieces alone.
    let has_places = matches!(&done.operation.cutting.tabs, Some(Tabs { places: TabPlaces::At(_), .. }));
    let loose = loose_words(&check.loose, most);
    if has_places || accept_losses {
        notes.extend(loose)
    } else {
        failures.extend(loose)
    }
    let [wrong, told] = notice_words(&planned.notices, most);
    failures.extend(wrong);
    notes.extend(told);
    notes.extend(loose_part(done, setup));
    Words { failures, notes }
}

/// What comes loose between tabs.
fn loose_words(pieces: &[LoosePiece], most: usize) -> Vec<String> {
    let told = if pieces.len() > most.saturating_add(1) { most } else { pieces.len() };
    let sentence = |piece: &LoosePiece| {
        format!(
            "a piece of {:.2} mm² around ({:.3}, {:.3}) comes loose, no tab holds it: ask for more tabs, or for some at places \
             beside it; --accept-losses where something else holds it",
            piece.area_mm2, piece.x_mm, piece.y_mm
        )
    };
    let more = (told < pieces.len()).then(|| format!("{} more such pieces", pieces.len() - told));
    pieces[..told].iter().map(sentence).chain(more).collect()
}

/// What a pocket leaves standing in its corners, where no operation before it has cut.
pub(super) fn corners_left(done: &Done) -> Option<Uncut> {
    let keep = done.planned.keep.as_ref()?;
    matches!(done.operation.kind, OperationKind::Pocket { rest_of: None, .. })
        .then(|| uncut(&done.run, &keep.part, keep.remainder, keep.distance, keep.floor))
}

/// Whether a part is loose while it is finished, in words.
pub(super) fn loose_part(done: &Done, setup: &Setup) -> Option<String> {
    let cutting = &done.operation.cutting;
    let through = setup.stock.thickness.is_some_and(|t| cutting.depth >= t);
    let is_held = !done.planned.tabs.is_empty() || cutting.onion_skin.is_some();
    (through && !is_held && cutting.finish && is_profile(done))
        .then(|| "the part is loose when its walls are finished: tabs or an onion skin hold it".to_owned())
}

fn is_profile(done: &Done) -> bool {
    matches!(done.operation.kind, OperationKind::Profile { .. })
}

/// Whether the operation goes around whole outlines.
fn is_closed(done: &Done) -> bool {
    matches!(done.operation.kind, OperationKind::Profile { rest_of: None, side, .. } if side != Side::On)
}
