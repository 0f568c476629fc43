//! Tools of a job file.

use std::ops::Range;

use super::{Place, Resolver};
use crate::cam::setup::file::{ToolFile, ToolName};
use crate::cam::{Tool, ToolShape};
use crate::units::nearest;

/// Smallest diameter of a tool in millimetres: the thinnest drills that are made.
const SMALLEST_DIAMETER: f64 = 0.01;

/// Most cutting edges of a tool: saws have a hundred teeth.
const MOST_FLUTES: u32 = 500;

/// Cutting edges of a tool of which it is not said: what most routers' bits have.
const USUAL_FLUTES: u32 = 2;

/// Angle of a drill's tip in degrees.
const DRILL_ANGLE: f64 = 118.0;

impl Resolver<'_> {
    pub(super) fn tool(&mut self, file: &ToolFile, table: &Range<usize>) -> Tool {
        let place = |key| Place { table, key };
        let Some(number) = file.number.filter(|n| *n >= 1) else {
            self.at(place("number"), "a tool needs a number, 1 or more");
            return Tool::flat(0, 1.0);
        };
        let kinds = [("flat", 0), ("ball", 1), ("v", 2), ("drill", 3)];
        let kind = self.word(place("type"), file.kind.as_deref(), &kinds, 0);
        let diameter = self.above_zero(place("diameter"), file.diameter);
        if file.diameter.is_none() {
            self.at(place("diameter"), format!("tool {number} needs a diameter"));
        }
        let diameter = diameter.unwrap_or(1.0);
        if diameter < SMALLEST_DIAMETER {
            self.at(
                place("diameter"),
                format!("diameter is {diameter} mm: at least {SMALLEST_DIAMETER} mm makes sense; is the unit right?"),
            );
        }
        let tip = self.zero_or_more(place("tip-diameter"), file.tip_diameter).unwrap_or(0.0);
        if tip >= diameter {
            self.at(place("tip-diameter"), "the tip must be narrower than the tool");
        }
        let angle = file.angle.unwrap_or(if kind == 3 { DRILL_ANGLE } else { 90.0 });
        if kind == 2 && file.angle.is_none() {
            self.at(place("angle"), format!("tool {number} is a cone and needs an angle in degrees"));
        }
        if !(angle > 0.0 && angle < 180.0) {
            self.at(place("angle"), format!("angle is {angle}: it must lie between 0 and 180 degrees"));
        }
        if kind < 2 {
            for (key, is_said) in [("angle", file.angle.is_some()), ("tip-diameter", file.tip_diameter.is_some())] {
                if is_said {
                    self.at(
                        place(key),
                        format!("{key} is that of a cone: it belongs to tools of type \"v\" or \"drill\""),
                    );
                }
            }
        }
        let flutes = file.flutes.unwrap_or(USUAL_FLUTES);
        if !(1..=MOST_FLUTES).contains(&flutes) {
            self.at(
                place("flutes"),
                format!("flutes is {flutes}: a tool has 1 cutting edge at least, and at most {MOST_FLUTES}"),
            );
        }
        let flute_length = self.above_zero(place("flute-length"), file.flute_length).unwrap_or(f64::INFINITY);
        let cone = ToolShape::Cone { angle: angle.clamp(1e-3, 179.999).to_radians(), tip_diameter: tip };
        Tool {
            number,
            name: file.name.clone().unwrap_or_else(|| format!("tool {number}")),
            shape: match kind {
                0 => ToolShape::Flat,
                1 => ToolShape::Ball,
                _ => cone,
            },
            is_drill: kind == 3,
            diameter,
            flutes,
            flute_length,
        }
    }

    /// The index of the tool that is named.
    pub(super) fn find_tool(&mut self, place: Place, name: &ToolName, tools: &[Tool]) -> Option<usize> {
        let found = match name {
            ToolName::Number(number) => tools.iter().position(|t| t.number == *number),
            ToolName::Name(name) => tools.iter().position(|t| t.name == *name),
        };
        if found.is_none() {
            let names: Vec<String> = tools.iter().map(|t| format!("{} \"{}\"", t.number, t.name)).collect();
            let typed = match name {
                ToolName::Number(number) => number.to_string(),
                ToolName::Name(name) => format!("\"{name}\""),
            };
            let near = match name {
                ToolName::Name(name) => nearest(name, tools.iter().map(|t| t.name.as_str())),
                ToolName::Number(_) => None,
            };
            let hint = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
            self.at(place, format!("there is no tool {typed}: there are {}{hint}", names.join(", ")));
        }
        found
    }
}
