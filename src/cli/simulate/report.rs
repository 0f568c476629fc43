//! What came of a simulation, in words and as JSON.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use serde_json::json;

use super::sources::Sources;
use crate::cam::{Against, CutLevel, Event, Gouge, OperationRun, Side, Simulation, Stock, ToolTable};
use crate::cli::report::GOUGE_LIMIT;
use crate::gcode::Finding;

/// Events and places named in words; JSON has them all.
const SHOWN: usize = 12;

/// The width of the column of lines, where they are not longer.
const LINES_WIDTH: usize = 13;

/// All that is to be told.
pub(super) struct SimulateReport<'a> {
    pub(super) sources: &'a Sources,
    pub(super) tools: &'a ToolTable,
    /// The numbers of the tools that cut.
    pub(super) used: Vec<u32>,
    /// The numbers of tools that were given and do not move.
    pub(super) unknown_to_program: Vec<u32>,
    pub(super) stock_is_given: bool,
    pub(super) simulation: &'a Simulation,
    /// What of the program could not be followed as it is written.
    pub(super) guesses: &'a [Finding],
    pub(super) levels: &'a [CutLevel],
    pub(super) against: Option<&'a Against>,
    /// z that the cut must reach.
    pub(super) floor: f64,
    pub(super) side: Side,
    pub(super) written: &'a [PathBuf],
}

impl SimulateReport<'_> {
    /// Whether nothing was found that should not be. What a round tool leaves in corners is told, but must be.
    pub(super) fn is_clean(&self) -> bool {
        self.simulation.events.is_empty()
            && self.guesses.is_empty()
            && self.against.is_none_or(|against| against.left.is_empty())
            && !self.gouge().is_some_and(|g| g.depth_mm > GOUGE_LIMIT)
    }

    fn gouge(&self) -> Option<Gouge> {
        self.against?.gouge
    }

    pub(super) fn json(&self) -> Result<String> {
        let Simulation { map, events, operations, time, removed_mm3 } = self.simulation;
        let tools: Vec<_> = self.used.iter().filter_map(|number| Some((number, self.tools.get(*number)?))).collect();
        let tools: Vec<_> = tools
            .into_iter()
            .map(|(number, t)| {
                json!({
                    "number": number,
                    "name": t.title(),
                    "shape": t.shape,
                    "is_drill": t.is_drill,
                    "diameter_mm": t.diameter,
                })
            })
            .collect();
        let value = json!({
            "programs": self.sources,
            "tools": tools,
            "tools_not_in_program": self.unknown_to_program,
            "stock": map.stock(),
            "stock_is_given": self.stock_is_given,
            "cell_mm": map.cell(),
            "operations": operations,
            "removed_mm3": removed_mm3,
            "time": time,
            "total_seconds": time.total_seconds(),
            "findings": self.guesses,
            "events": events,
            "levels": self.levels,
            "against": self.against,
            "floor_mm": self.against.map(|_| self.floor),
            "gouge_limit_mm": GOUGE_LIMIT,
            "clean": self.is_clean(),
            "written": self.written,
        });
        Ok(serde_json::to_string_pretty(&value)? + "\n")
    }

    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |label: &str, value: String| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{label:<12}{value}");
        };
        let Simulation { map, events, time, .. } = self.simulation;
        line(if self.sources.0.len() == 1 { "program" } else { "programs" }, self.sources.names());
        let Stock { min_x_mm, max_x_mm, min_y_mm, max_y_mm, top_mm, bottom_mm } = *map.stock();
        line(
            "stock",
            format!(
                "x {min_x_mm:.2} to {max_x_mm:.2}, y {min_y_mm:.2} to {max_y_mm:.2}, z {bottom_mm:.2} to {top_mm:.2} mm{}",
                if self.stock_is_given { "" } else { " (what is cut, with a margin; --stock says otherwise)" }
            ),
        );
        line(
            "map",
            format!("{} x {} cells of {:.3} x {:.3} mm", map.columns(), map.rows(), map.cell()[0], map.cell()[1]),
        );
        for number in &self.used {
            if let Some(tool) = self.tools.get(*number) {
                line("tool", format!("{number}: {}", tool.title()));
            }
        }
        for number in &self.unknown_to_program {
            line("note", format!("--tool {number}: the program has no tool {number}, and this one is not used"));
        }
        self.operation_lines(&mut line);
        line(
            "time",
            format!(
                "{} ({} at a feed, {} rapid, {} waiting)",
                duration(time.total_seconds()),
                duration(time.feed_seconds),
                duration(time.rapid_seconds),
                duration(time.dwell_seconds)
            ),
        );
        for level in self.levels {
            line("level", format!("z {:.3}: {:.2} mm2 cut", level.z_mm, level.area_mm2));
        }
        self.against_lines(&mut line);
        for finding in self.guesses.iter().take(SHOWN) {
            let place = self.sources.words(finding.line);
            line("FOUND", format!("{place}: {} [{}]", finding.message, finding.rule));
        }
        if self.guesses.len() > SHOWN {
            line("", format!("and {} more like these (--format json lists all)", self.guesses.len() - SHOWN));
        }
        if !self.guesses.is_empty() {
            line(
                "",
                "these lines are not as a machine runs them: what stands above and in the picture is a guess"
                    .to_owned(),
            );
        }
        for event in events.iter().take(SHOWN) {
            line("FOUND", describe(event, self.sources));
        }
        if events.len() > SHOWN {
            line("", format!("and {} more (--format json lists all)", events.len() - SHOWN));
        }
        if events.is_empty() && self.guesses.is_empty() && self.is_clean() {
            line("found", "nothing".to_owned());
        }
        if !self.written.is_empty() {
            let names: Vec<String> = self.written.iter().map(|p| p.display().to_string()).collect();
            line("wrote", names.join(", "));
        }
        text
    }

    /// One row for each operation.
    fn operation_lines(&self, line: &mut impl FnMut(&str, String)) {
        let operations = &self.simulation.operations;
        if operations.is_empty() {
            return line("cuts", "nothing".to_owned());
        }
        let lines = |o: &OperationRun| {
            let (file, first) = self.sources.place(o.first_line);
            format!("{file}{first}-{}", self.sources.place(o.last_line).1)
        };
        let names = operations.iter().map(|o| o.name.chars().count());
        let width = names.max().unwrap_or(0).max("operation".len());
        let wide = operations.iter().map(|o| lines(o).chars().count()).max().unwrap_or(0).max(LINES_WIDTH);
        let row = |cells: [&str; 6]| {
            let [name, lines, length, time, z, volume] = cells;
            format!("{name:<width$}  {lines:>wide$}  {length:>11}  {time:>12}  {z:>9}  {volume:>11}")
        };
        line("", row(["operation", "lines", "cut mm", "time", "z mm", "removed mm3"]));
        for o in operations {
            line(
                "",
                row([
                    &o.name,
                    &lines(o),
                    &format!("{:.1}", o.cut_length_mm),
                    &duration(o.seconds),
                    &o.deepest_z_mm.map_or("-".to_owned(), |z| format!("{z:.3}")),
                    &format!("{:.1}", o.removed_mm3),
                ]),
            );
        }
    }

    fn against_lines(&self, line: &mut impl FnMut(&str, String)) {
        let Some(against) = self.against else { return };
        let label = if self.side == Side::On { "centre" } else { "gouge" };
        match against.gouge {
            Some(g) if g.depth_mm > 0.0 => {
                let verdict = if g.depth_mm > GOUGE_LIMIT { "TOO DEEP, limit" } else { "limit" };
                let what = if self.side == Side::On { "inside of the outline by " } else { "" };
                let depth = g.depth_mm;
                let at = format!("({:.3}, {:.3}), {}", g.x_mm, g.y_mm, self.sources.words(g.line));
                line(label, format!("{what}{depth:.4} mm with the centre at {at} ({verdict} {GOUGE_LIMIT} mm)"));
            }
            _ => line(label, "none".to_owned()),
        }
        for left in against.left.iter().take(SHOWN) {
            let (x, y, length) = (left.x_mm, left.y_mm, left.length_mm);
            let apart = left.depth_mm.map_or(String::new(), |d| format!(", {d:.3} mm from the cut"));
            let what = match left.is_whole_outline {
                true => format!(
                    "the outline around ({x:.3}, {y:.3}), {length:.1} mm long, is cut nowhere down to z {:.3}",
                    self.floor
                ),
                false => format!(
                    "{length:.1} mm of an outline, at ({x:.3}, {y:.3}), are not cut down to z {:.3}{apart}",
                    self.floor
                ),
            };
            line("NOT CUT", what);
        }
        if against.left.len() > SHOWN {
            line("", format!("and {} more (--format json lists all)", against.left.len() - SHOWN));
        }
        if let Some(uncut) = &against.uncut {
            let places = uncut.places.len();
            line("uncut", format!("{:.3} mm2 in {places} place{}", uncut.area_mm2, if places == 1 { "" } else { "s" }));
            for place in uncut.places.iter().take(SHOWN) {
                let (x, y, depth) = (place.x_mm, place.y_mm, place.depth_mm);
                let area = place.area_mm2;
                line("", format!("{area:.3} mm2 at ({x:.3}, {y:.3}), up to {depth:.3} mm from the part"));
            }
            if places > SHOWN {
                line("", format!("and {} more (--format json lists all)", places - SHOWN));
            }
            if !uncut.is_cut_free {
                line("", "the cut does not go all around at the floor: the part hangs on the stock".to_owned());
            }
        }
        for number in &against.tools_left_out {
            line("", format!("tool {number} is a V bit and was not held against the part"));
        }
    }
}

fn describe(event: &Event, sources: &Sources) -> String {
    let (file, first) = sources.place(event.line);
    let lines = match event.last_line {
        last if last == event.line => format!("{file}line {first}"),
        last => format!("{file}lines {first} to {}", sources.place(last).1),
    };
    let (amount, unit) = (event.amount, event.kind.unit());
    let place = format!("({:.3}, {:.3}, {:.3})", event.x_mm, event.y_mm, event.z_mm);
    format!("{lines}: {}, {amount:.3} {unit} at {place}, tool {}", event.kind.words(), event.tool)
}

fn duration(seconds: f64) -> String {
    match seconds.round() {
        _ if seconds < 59.95 => format!("{seconds:.1} s"),
        s => format!("{:.0} min {:.0} s", (s / 60.0).floor(), s % 60.0),
    }
}
