//! The certificate of a program, in words and as JSON.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use serde_json::json;

use super::time_words::{minutes, sharp, time_saved};
use crate::cam::{Certificate, Gouge, Job, Side, TimeSaved};
use crate::check::{LostFeature, Place};
use crate::gcode::{Arcs, Finding, Severity, Units, WriteOptions};
use crate::plane::Region;
use crate::units::MM_PER_INCH;

/// The deepest cut into the part that a program may make, in millimetres: what rounding and arc fitting can add up to.
pub(super) const GOUGE_LIMIT: f64 = 0.002;

/// Places named in words; JSON has them all.
const PLACES_SHOWN: usize = 6;

/// Whether a program may be run without a second look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Nothing was found.
    Good,
    /// A feature is lost, the part is cut into or hangs on the stock, the controller would refuse it, or the geometry is
    /// not proved.
    Failed,
}

/// All that is to be told about a program. Places are in the machine's coordinates.
pub(super) struct MillReport<'a> {
    pub(super) input: &'a Path,
    pub(super) job: &'a Job,
    pub(super) dialect: &'a str,
    pub(super) options: WriteOptions,
    pub(super) part: &'a Region,
    pub(super) certificate: &'a Certificate,
    pub(super) lost: &'a [LostFeature],
    pub(super) findings: &'a [Finding],
    pub(super) contradictions: usize,
    /// Outlines with a smaller path radius, and the smallest in millimetres.
    pub(super) eased: Option<(usize, f64)>,
    /// How many shapes lie wholly on others and change nothing.
    pub(super) covered: usize,
    pub(super) accept_losses: bool,
    /// Against the path with sharp inside corners; `None` where this one is sharp, or that one cannot be planned.
    pub(super) saved: Option<&'a TimeSaved>,
    pub(super) written: &'a [PathBuf],
    /// The program that is not written, because it cuts into the part.
    pub(super) withheld: Option<&'a Path>,
}

/// Words for a program that is not written, where there is another file of its name.
pub(super) fn older_one(path: &Path) -> &'static str {
    if path.is_file() { "; the file of that name is an older one" } else { "" }
}

/// Whether a program cuts into what must remain.
pub(super) fn gouges(gouge: Option<&Gouge>) -> bool {
    gouge.is_some_and(|g| g.depth_mm > GOUGE_LIMIT)
}

impl MillReport<'_> {
    pub(super) fn gouges(&self) -> bool {
        gouges(self.certificate.gouge.as_ref())
    }

    fn refused(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }

    /// Whether the cut does not go all around. On the outline the tool has no side that must remain, and no width.
    fn hangs(&self) -> bool {
        self.job.side != Side::On && !self.certificate.uncut.is_cut_free
    }

    /// A length with so many decimals of a millimetre, and in inches where the program is.
    fn length(&self, mm: f64, decimals: usize) -> String {
        match self.options.units {
            Units::Millimetres => format!("{mm:.decimals$} mm"),
            Units::Inches => format!("{mm:.decimals$} mm ({:.*} in)", decimals + 2, mm / MM_PER_INCH),
        }
    }

    pub(super) fn verdict(&self) -> Verdict {
        if self.failures().is_empty() { Verdict::Good } else { Verdict::Failed }
    }

    /// What is wrong, in sentences.
    pub(super) fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        if !self.lost.is_empty() && !self.accept_losses {
            let are = if self.lost.len() == 1 { "is" } else { "are" };
            failures.push(format!("{} of the drawing {are} lost", count(self.lost.len(), "feature")));
        }
        if self.covered > 0 && !self.accept_losses {
            let lie = if self.covered == 1 { "lies" } else { "lie" };
            failures.push(format!("{} {lie} wholly on others and change nothing", count(self.covered, "shape")));
        }
        if let Some(gouge) = self.certificate.gouge.filter(|_| self.gouges()) {
            failures.push(format!("line {} cuts {:.4} mm into the part", gouge.line, gouge.depth_mm));
        }
        if self.hangs() {
            failures.push("the cut does not go all around: the part hangs on the stock".to_owned());
        }
        if self.refused() {
            failures.push(format!("{} would refuse the program, or it does harm", self.dialect));
        }
        if self.contradictions > 0 {
            failures.push("rounding left contradictions in the closing: the path is not proved".to_owned());
        }
        failures
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
            "path_radius_is_before_lines": self.options.arcs == Arcs::Lines,
            "certificate": self.certificate,
            "gouge_limit_mm": GOUGE_LIMIT,
            "sharp": self.saved.map(sharp),
            "lost_features": self.lost,
            "findings": self.findings,
            "contradictions": self.contradictions,
            "smaller_path_radius": self.eased.map(|(outlines, least)| json!({ "outlines": outlines, "least_mm": least })),
            "covered_shapes": self.covered,
            "good": self.verdict() == Verdict::Good,
            "written": self.written,
            "withheld": self.withheld,
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
                "{:.2} x {:.2} mm{}, {}, {} ({})",
                bounds.width(),
                bounds.height(),
                match self.options.units {
                    Units::Millimetres => String::new(),
                    Units::Inches =>
                        format!(" ({:.4} x {:.4} in)", bounds.width() / MM_PER_INCH, bounds.height() / MM_PER_INCH),
                },
                count(topology.components, "part"),
                count(topology.holes, "hole"),
                self.input.display()
            ),
        );
        line(
            "tool",
            format!(
                "{}, path radius {}: corners that it cannot enter are rounded to {}",
                self.length(self.job.tool_diameter, 3),
                self.length(self.job.path_radius_mm(), 3),
                self.length(self.job.closing_radius(), 3),
            ),
        );
        if let Some((count, least)) = self.eased {
            line("", eased(count, least));
        }
        line(
            "depth",
            format!(
                "{} in {} pass{}, {}",
                self.length(s.depth_mm, 2),
                s.passes,
                if s.passes == 1 { "" } else { "es" },
                self.dialect
            ),
        );
        if let Some(b) = s.cut_box {
            let half = 0.5 * self.job.tool_diameter;
            let sides = [b.min_x_mm - half, b.max_x_mm + half, b.min_y_mm - half, b.max_y_mm + half];
            let ranges = |unit: f64, decimals: usize| {
                let [left, right, front, back] = sides.map(|side| format!("{:.decimals$}", side / unit));
                format!("x {left} to {right}, y {front} to {back}")
            };
            let inches = match self.options.units {
                Units::Millimetres => String::new(),
                Units::Inches => format!(" ({} in)", ranges(MM_PER_INCH, 4)),
            };
            line("takes up", format!("{} mm{inches}, the tool's width included", ranges(1.0, 3)));
        }
        self.cut_lines(&mut line);
        let radius = |r: Option<f64>| r.map_or("none (straight)".to_owned(), |mm| self.length(mm, 3));
        let concave = c.path_radius.smallest_concave_mm;
        line(
            "path",
            format!(
                "smallest radius {}, {}{}",
                radius(c.path_radius.smallest_mm),
                concave
                    .map_or("no inside corners".to_owned(), |mm| format!("in inside corners {}", self.length(mm, 3))),
                if self.options.arcs == Arcs::Lines { " (before it was broken into lines)" } else { "" }
            ),
        );
        line(
            "",
            format!(
                "{} cut, {} rapid, {}, {}",
                self.length(s.cut_length_mm, 0),
                self.length(s.rapid_length_mm, 0),
                count(s.lines, "line"),
                count(s.arcs, "arc")
            ),
        );
        line("time", format!("{}, at {} mm/s2", minutes(c.time.total_seconds()), self.job.acceleration));
        if let Some(saved) = self.saved {
            line("time saved", time_saved(saved));
        }
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
        if let Some(program) = self.withheld {
            let older = older_one(program);
            line("NOT WRITTEN", format!("{}: it would cut into the part{older}", program.display()));
        }
        if !self.written.is_empty() {
            let names: Vec<String> = self.written.iter().map(|p| p.display().to_string()).collect();
            line("wrote", names.join(", "));
        }
        text
    }

    /// What the cut does to the part and what it leaves.
    fn cut_lines(&self, line: &mut impl FnMut(&str, String)) {
        let c = self.certificate;
        let is_on = self.job.side == Side::On;
        // On the outline the tool's width is taken from the part by half, as asked: what counts is its centre.
        let label = if is_on { "centre" } else { "gouge" };
        match c.gouge {
            Some(g) if g.depth_mm > 0.0 => {
                let verdict = if self.gouges() { "TOO DEEP, limit" } else { "limit" };
                line(
                    label,
                    format!(
                        "{}{} at ({:.3}, {:.3}), line {} ({verdict} {GOUGE_LIMIT} mm)",
                        if is_on { "inside of the outline by up to " } else { "" },
                        self.length(g.depth_mm, 5),
                        g.x_mm,
                        g.y_mm,
                        g.line
                    ),
                );
            }
            _ if is_on => line(label, "nowhere inside of the outline".to_owned()),
            _ => line(label, "none".to_owned()),
        }
        if is_on {
            let half = self.length(0.5 * self.job.tool_diameter, 3);
            return line("", format!("the tool takes {half} on either side of it"));
        }
        line("uncut", format!("{:.3} mm2 in {}", c.uncut.area_mm2, count(c.uncut.places.len(), "place")));
        for place in c.uncut.places.iter().take(PLACES_SHOWN) {
            line(
                "",
                format!(
                    "{:.3} mm2 at ({:.3}, {:.3}), up to {} from the part",
                    place.area_mm2,
                    place.x_mm,
                    place.y_mm,
                    self.length(place.depth_mm, 3)
                ),
            );
        }
        more(line, c.uncut.places.len());
        if self.hangs() {
            line("NOT CUT FREE", "the cut does not go all around: the part hangs on the stock".to_owned());
        }
    }

    fn lost_lines(&self, line: &mut impl FnMut(&str, String)) {
        if self.covered > 0 {
            let what = format!("{} wholly on others, which change nothing", count(self.covered, "shape"));
            line("LOST", format!("{what}: a hole is drawn as part of the same path, with fill-rule=\"evenodd\""));
        }
        match (self.lost.is_empty(), self.covered) {
            (true, 0) => return line("lost", "nothing".to_owned()),
            (true, _) => return,
            (false, _) => {}
        }
        for (i, feature) in self.lost.iter().take(PLACES_SHOWN).enumerate() {
            line(
                if i == 0 { "LOST" } else { "" },
                describe(feature, self.job.tool_diameter, self.job.path_radius_mm()),
            );
        }
        more(line, self.lost.len());
        let fits = |f: &LostFeature| f.width() >= self.job.tool_diameter;
        let tip = match (self.lost.iter().any(fits), self.lost.iter().all(fits)) {
            (_, true) => "try a smaller --path-radius",
            (true, false) => "try a smaller --path-radius, and a smaller tool",
            (false, false) => "try a smaller tool",
        };
        let accept = if self.accept_losses { "accepted" } else { "--accept-losses accepts this" };
        line("", format!("{tip}; {accept}"));
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

/// Sizes of features are known to this part of themselves.
const SIZE_ACCURACY: f64 = 0.01;

/// That some outlines have a smaller path radius than the others.
pub(super) fn eased(count: usize, least: f64) -> String {
    match count {
        1 => format!("one outline has a path radius of {least:.3} mm: a larger one would lose it"),
        _ => format!("{count} outlines have smaller path radii, down to {least:.3} mm: larger ones would lose them"),
    }
}

/// Why a feature of this width is lost.
pub(super) fn why_lost(width: f64, tool_diameter: f64, path_radius: f64) -> String {
    if (width - tool_diameter).abs() < SIZE_ACCURACY * tool_diameter {
        format!("that is the tool of {tool_diameter} mm, which needs more room to move")
    } else if width < tool_diameter {
        format!("the tool of {tool_diameter} mm does not fit")
    } else {
        let room = 0.5 * (width - tool_diameter);
        format!("the tool fits, but not with a path radius of {path_radius:.3} mm: at most {room:.3} mm")
    }
}

/// What a feature is, and why the tool cannot make it.
pub(super) fn describe(feature: &LostFeature, tool_diameter: f64, path_radius: f64) -> String {
    let at = |p: &Place| format!("at ({:.3}, {:.3})", p.x, p.y);
    let why = |width: f64| why_lost(width, tool_diameter, path_radius);
    match feature {
        LostFeature::HoleFilled { center, diameter, .. } => {
            format!("hole {diameter:.2} mm wide {}: filled; {}", at(center), why(*diameter))
        }
        LostFeature::PartsMerged { components, place, width } => {
            format!("{components} parts merge {}, across a gap of {width:.2} mm; {}", at(place), why(*width))
        }
        LostFeature::GapFilled { place, width, depth, .. } => {
            format!("gap up to {width:.2} mm wide {}: filled, {depth:.2} mm deep; {}", at(place), why(*width))
        }
        LostFeature::ComponentLost { center, diameter, .. } => {
            format!("opening {diameter:.2} mm wide {}: not cut; {}", at(center), why(*diameter))
        }
        LostFeature::NeckCut { place, width, .. } => {
            format!("neck {width:.2} mm wide {}: not cut; {}", at(place), why(*width))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::{CertifyOptions, certify};
    use crate::gcode::read;
    use crate::plane::{Point, Ring};

    /// Around a square of 10 mm with a tool of 4 mm, and the same without the last side.
    const AROUND: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P2\nG0 X-2 Y0\nG1 Z-1 F100\nG1 Y10 F600\nG2 X0 Y12 I2 J0\n\
        G1 X10\nG2 X12 Y10 I0 J-2\nG1 Y0\nG2 X10 Y-2 I-2 J0\n";

    #[test]
    fn a_part_that_hangs_on_the_stock_fails() {
        let part = Region::new(vec![Ring::polygon(
            [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]].map(|p| Point::new(p[0], p[1])),
        )]);
        let verdict = |end: &str, side: Side| {
            let program = read(&format!("{AROUND}{end}G0 Z5\nM5\nM2\n")).unwrap();
            let certificate = certify(&program, &part, &part, &CertifyOptions::new(2.0));
            let job = Job { side, ..Job::default() };
            let report = MillReport {
                input: Path::new("square.svg"),
                job: &job,
                dialect: "grbl",
                options: WriteOptions { units: Units::Millimetres, arcs: Arcs::Arcs },
                part: &part,
                certificate: &certificate,
                lost: &[],
                findings: &[],
                contradictions: 0,
                eased: None,
                covered: 0,
                accept_losses: false,
                saved: None,
                written: &[],
                withheld: None,
            };
            (report.verdict(), report.text().contains("NOT CUT FREE"))
        };
        assert_eq!(verdict("G1 X0\nG2 X-2 Y0 I0 J2\n", Side::Outside), (Verdict::Good, false));
        assert_eq!(verdict("", Side::Outside), (Verdict::Failed, true));
        assert_eq!(verdict("", Side::On), (Verdict::Good, false));
    }
}
