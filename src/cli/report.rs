//! The certificate of a program, in words and as JSON.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use serde_json::json;

use crate::cam::{Certificate, Job};
use crate::check::{LostFeature, Place};
use crate::gcode::{Finding, Severity};
use crate::plane::Region;

/// The deepest cut into the part that a program may make, in millimetres: what rounding and arc fitting can add up to.
pub(super) const GOUGE_LIMIT: f64 = 0.002;

/// Places named in words; JSON has them all.
const PLACES_SHOWN: usize = 6;

/// Whether a program may be run without a second look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Nothing was found.
    Good,
    /// A feature is lost, the part is cut into, the controller would refuse it, or the geometry is not proved.
    Failed,
}

/// All that is to be told about a program. Places are in the machine's coordinates.
pub(super) struct MillReport<'a> {
    pub(super) input: &'a Path,
    pub(super) job: &'a Job,
    pub(super) dialect: &'a str,
    pub(super) part: &'a Region,
    pub(super) certificate: &'a Certificate,
    pub(super) lost: &'a [LostFeature],
    pub(super) findings: &'a [Finding],
    pub(super) contradictions: usize,
    pub(super) accept_losses: bool,
    pub(super) written: &'a [PathBuf],
}

impl MillReport<'_> {
    fn gouges(&self) -> bool {
        self.certificate.gouge.is_some_and(|g| g.depth_mm > GOUGE_LIMIT)
    }

    fn refused(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }

    pub(super) fn verdict(&self) -> Verdict {
        let losses = !self.lost.is_empty() && !self.accept_losses;
        if losses || self.gouges() || self.refused() || self.contradictions > 0 {
            Verdict::Failed
        } else {
            Verdict::Good
        }
    }

    pub(super) fn json(&self) -> Result<String> {
        let bounds = self.part.bounds();
        let value = json!({
            "drawing": self.input,
            "part_width_mm": bounds.width(),
            "part_height_mm": bounds.height(),
            "part_topology": self.part.topology(),
            "tool_diameter_mm": self.job.tool_diameter,
            "closing_radius_mm": self.job.closing_radius(),
            "dialect": self.dialect,
            "certificate": self.certificate,
            "gouge_limit_mm": GOUGE_LIMIT,
            "lost_features": self.lost,
            "findings": self.findings,
            "contradictions": self.contradictions,
            "good": self.verdict() == Verdict::Good,
            "written": self.written,
        });
        Ok(serde_json::to_string_pretty(&value)? + "\n")
    }

    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |label: &str, value: String| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{label:<16}{value}");
        };
        let bounds = self.part.bounds();
        let topology = self.part.topology();
        let c = self.certificate;
        let s = &c.statistics;
        line(
            "part",
            format!(
                "{:.2} x {:.2} mm, {}, {} ({})",
                bounds.width(),
                bounds.height(),
                count(topology.components, "part"),
                count(topology.holes, "hole"),
                self.input.display()
            ),
        );
        line(
            "tool",
            format!(
                "{} mm, path radius {:.3} mm, closing radius {:.3} mm, {} pass{}, {}",
                self.job.tool_diameter,
                self.job.path_radius_mm(),
                self.job.closing_radius(),
                s.passes,
                if s.passes == 1 { "" } else { "es" },
                self.dialect
            ),
        );
        match c.gouge {
            Some(g) if g.depth_mm > 0.0 => {
                let verdict = if self.gouges() { "TOO DEEP, limit" } else { "limit" };
                line(
                    "gouge",
                    format!(
                        "{:.5} mm at ({:.3}, {:.3}), line {} ({verdict} {GOUGE_LIMIT} mm)",
                        g.depth_mm, g.x_mm, g.y_mm, g.line
                    ),
                );
            }
            _ => line("gouge", "none".to_owned()),
        }
        line("uncut", format!("{:.3} mm2 in {}", c.uncut.area_mm2, count(c.uncut.places.len(), "place")));
        for place in c.uncut.places.iter().take(PLACES_SHOWN) {
            line(
                "",
                format!(
                    "{:.3} mm2 at ({:.3}, {:.3}), up to {:.3} mm from the part",
                    place.area_mm2, place.x_mm, place.y_mm, place.depth_mm
                ),
            );
        }
        more(&mut line, c.uncut.places.len());
        let radius = |r: Option<f64>| r.map_or("straight".to_owned(), |mm| format!("{mm:.3} mm"));
        line(
            "path",
            format!(
                "smallest radius {}, in inside corners {}",
                radius(c.path_radius.smallest_mm),
                radius(c.path_radius.smallest_concave_mm)
            ),
        );
        line(
            "",
            format!(
                "{:.0} mm cut, {:.0} mm rapid, {}, {}",
                s.cut_length_mm,
                s.rapid_length_mm,
                count(s.lines, "line"),
                count(s.arcs, "arc")
            ),
        );
        line("time", format!("{}, at {} mm/s2", minutes(c.time.total_seconds()), self.job.acceleration));
        self.lost_lines(&mut line);
        for f in self.findings {
            line(
                if f.severity == Severity::Error { "REFUSED" } else { "note" },
                format!("line {}: {}", f.line, f.message),
            );
        }
        if self.contradictions > 0 {
            line(
                "NOT PROVED",
                "rounding left contradictions in the closing: change a radius by a thousandth".to_owned(),
            );
        }
        let names: Vec<String> = self.written.iter().map(|p| p.display().to_string()).collect();
        line("wrote", names.join(", "));
        text
    }

    fn lost_lines(&self, line: &mut impl FnMut(&str, String)) {
        if self.lost.is_empty() {
            return line("lost", "nothing".to_owned());
        }
        for (i, feature) in self.lost.iter().take(PLACES_SHOWN).enumerate() {
            line(if i == 0 { "LOST" } else { "" }, describe(feature));
        }
        more(line, self.lost.len());
        let tip = if self.job.path_radius_mm() > 0.0 { "--path-radius 0 or a smaller tool" } else { "a smaller tool" };
        let accept = if self.accept_losses { "accepted" } else { "--accept-losses accepts this" };
        line("", format!("try {tip}; {accept}"));
    }
}

fn more(line: &mut impl FnMut(&str, String), total: usize) {
    if total > PLACES_SHOWN {
        line("", format!("and {} more (--format json lists all)", total - PLACES_SHOWN));
    }
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn minutes(seconds: f64) -> String {
    if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else {
        format!("{:.0} min {:.0} s", (seconds / 60.0).floor(), seconds % 60.0)
    }
}

/// Sizes are known to a hundredth of themselves.
fn describe(feature: &LostFeature) -> String {
    let at = |p: &Place| format!("at ({:.3}, {:.3})", p.x, p.y);
    match feature {
        LostFeature::HoleFilled { center, diameter, .. } => {
            format!("hole of diameter {diameter:.2} mm {}: filled, the tool cannot enter it", at(center))
        }
        LostFeature::PartsMerged { components, place, width } => {
            format!("{components} parts merge {}, across a gap of {width:.2} mm", at(place))
        }
        LostFeature::GapFilled { place, width, depth, .. } => {
            format!("gap up to {width:.2} mm wide {}: filled, {depth:.2} mm deep", at(place))
        }
        LostFeature::ComponentLost { center, diameter, .. } => {
            format!("opening of diameter {diameter:.2} mm {}: the tool cannot enter it", at(center))
        }
        LostFeature::NeckCut { place, width, .. } => {
            format!("neck {width:.2} mm wide {}: the tool cannot enter it", at(place))
        }
    }
}
