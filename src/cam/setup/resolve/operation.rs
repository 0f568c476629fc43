//! Operations of a job file.

use toml::Spanned;

use super::cutting::rates;
use super::{Place, Resolver};
use crate::cam::setup::file::{OperationFile, OperationKindName, SetupFile};
use crate::cam::setup::{Corners, Operation, OperationKind, Pattern, Rig, Workpiece};
use crate::cam::{DEFAULT_SIDE, Tool, ToolShape};
use crate::units::Length;

/// Distance between neighbouring paths unless it is said, as a share of the tool's diameter.
const DEFAULT_STEPOVER: f64 = 0.4;

/// The smallest share of the diameter that paths may lie apart: a finer floor than that of a hundredth is no tool's, and takes
/// hours.
const SMALLEST_STEPOVER: f64 = 0.01;

/// The longest name of an operation, in characters: with its brackets it fits the shortest line of any controller, so that a
/// program names every operation on one line.
const LONGEST_NAME: usize = 40;

/// The most times that a drill is drawn out of one hole: more is a slip of the unit.
const MOST_PECKS: f64 = 200.0;

/// The largest share of the diameter that paths may lie apart: beyond it, ridges stay between straight ones.
const LARGEST_STEPOVER: f64 = 0.95;

impl Resolver<'_> {
    pub(super) fn operation(
        &mut self,
        typed: &Spanned<OperationFile>,
        index: usize,
        stock: &Workpiece,
        rig: &Rig,
        tools: &[Tool],
        whole: &SetupFile,
    ) -> Option<Operation> {
        let (file, table) = (typed.get_ref(), &typed.span());
        let place = |key| Place { table, key };
        let Some(kind) = file.kind.as_deref() else {
            self.at(
                place("kind"),
                "an operation needs a kind: profile, pocket, drill, engrave, v-carve, facing or chamfer",
            );
            return None;
        };
        let problems = self.problems.len();
        let kind = self.word(place("kind"), Some(kind), &OperationKindName::ALL, OperationKindName::Profile);
        if self.problems.len() > problems {
            // Of an unknown kind nothing else can be judged.
            return None;
        }
        self.keys(file, table, kind);
        let Some(name) = &file.tool else {
            self.at(place("tool"), "an operation needs a tool, by number or name");
            return None;
        };
        let tool_index = self.find_tool(place("tool"), name, tools)?;
        let tool = &tools[tool_index];
        let label = file.name.clone().filter(|n| !n.trim().is_empty());
        let label = label.unwrap_or_else(|| format!("{} {}", file.kind.as_deref().unwrap_or_default(), index + 1));
        if label.chars().count() > LONGEST_NAME {
            self.at(
                place("name"),
                format!(
                    "the name has {} characters: at most {LONGEST_NAME} fit a line of a program",
                    label.chars().count()
                ),
            );
        }
        let rates = rates(whole.tool[tool_index].get_ref(), stock.material.as_deref());
        let cutting = self.cutting(file, table, stock, tool, &rates, kind);
        let own_speed = file.spindle_speed.or(self.flags.spindle_speed);
        if let Some(largest) = rig.largest_spindle_speed
            && cutting.spindle_speed > largest
        {
            // The speed is the tool's where the operation has none of its own.
            let tool_table = whole.tool[tool_index].span();
            let table = if own_speed.is_some() { table } else { &tool_table };
            self.at(
                Place { table, key: "spindle-speed" },
                format!(
                    "spindle-speed is {}, and the machine's spindle turns at most at {largest}: say so many or fewer, or mend \
                     largest-spindle-speed in [machine] ($30 of its settings)",
                    cutting.spindle_speed
                ),
            );
        }
        let rest_of = file.rest_of.as_ref().and_then(|name| {
            let larger = self.find_tool(place("rest-of"), name, tools)?;
            if tools[larger].diameter <= tool.diameter {
                self.at(
                    place("rest-of"),
                    format!("tool {} has left nothing that this tool, no smaller, could reach", tools[larger].number),
                );
            }
            Some(tools[larger].diameter)
        });
        let corners = [("round", Corners::Round), ("dogbone", Corners::Dogbone), ("t-bone", Corners::TBone)];
        let corners = self.word(place("corners"), file.corners.as_deref(), &corners, Corners::Round);
        let side = self.flags.side.or(file.side).unwrap_or(DEFAULT_SIDE);
        let is_cone = matches!(tool.shape, ToolShape::Cone { .. }) && !tool.is_drill;
        let kind = match kind {
            OperationKindName::Profile => OperationKind::Profile { side, corners, rest_of },
            OperationKindName::Pocket => {
                let patterns = [("rings", Pattern::Rings), ("raster", Pattern::Raster)];
                let pattern = self.word(place("pattern"), file.pattern.as_deref(), &patterns, Pattern::Rings);
                let stepover = self.stepover(file, place("stepover"), tool.diameter);
                let stays_rough = cutting.allowance > 0.0 && !cutting.finish;
                if stays_rough && corners != Corners::Round {
                    self.at(
                        place("corners"),
                        "corners are cut with the walls, and finish = false leaves those rough: give corners to the operation that \
                         finishes them",
                    );
                }
                OperationKind::Pocket { pattern, stepover, corners, rest_of }
            }
            OperationKindName::Drill => {
                let peck = self.above_zero(place("peck"), file.peck);
                let depth = cutting.depth - cutting.start_depth;
                if let Some(peck) = peck.filter(|peck| depth / peck > MOST_PECKS) {
                    self.at(
                        place("peck"),
                        format!(
                            "pecks of {peck} mm in a hole {depth} mm deep are more than {MOST_PECKS}: take at least {:.3} mm",
                            depth / MOST_PECKS
                        ),
                    );
                }
                OperationKind::Drill { peck }
            }
            OperationKindName::Engrave => OperationKind::Engrave,
            OperationKindName::VCarve => {
                OperationKind::VCarve { max_depth: self.above_zero(place("max-depth"), file.max_depth) }
            }
            OperationKindName::Facing => {
                OperationKind::Facing { stepover: self.stepover(file, place("stepover"), tool.diameter) }
            }
            OperationKindName::Chamfer => {
                if file.width.is_none() {
                    self.at(place("width"), "a chamfer needs a width");
                }
                OperationKind::Chamfer { side, width: self.above_zero(place("width"), file.width).unwrap_or(1.0) }
            }
        };
        if matches!(kind, OperationKind::VCarve { .. } | OperationKind::Chamfer { .. }) && !is_cone {
            self.at(
                place("tool"),
                format!("tool {} is no cone: carving and chamfering need a tool of type \"v\"", tool.number),
            );
        }
        if is_cone
            && matches!(
                kind,
                OperationKind::Profile { .. } | OperationKind::Pocket { .. } | OperationKind::Facing { .. }
            )
        {
            self.at(
                place("tool"),
                format!(
                    "tool {} is a cone, which leaves slopes: use it to v-carve, chamfer or engrave, and an end mill here",
                    tool.number
                ),
            );
        }
        if tool.is_drill && !matches!(kind, OperationKind::Drill { .. }) {
            self.at(place("tool"), format!("tool {} is a drill: it cuts holes only", tool.number));
        }
        Some(Operation {
            label,
            line: self.locator.line(table.start),
            kind,
            tool: tool_index,
            select: file.select.clone(),
            cutting,
        })
    }

    fn stepover(&mut self, file: &OperationFile, place: Place, diameter: f64) -> f64 {
        let share = match &file.stepover {
            None => Some(DEFAULT_STEPOVER),
            Some(toml::Value::Float(mm)) => Some(mm / diameter),
            Some(toml::Value::Integer(mm)) => Some(*mm as f64 / diameter),
            Some(toml::Value::String(text)) => match text.trim().strip_suffix('%') {
                Some(percent) => percent.trim().parse().ok().map(|p: f64| p / 100.0),
                None => {
                    text.parse::<Length>().ok().and_then(|l| l.to_millimetres(self.scale).ok()).map(|mm| mm / diameter)
                }
            },
            Some(_) => None,
        };
        match share {
            Some(share) if (SMALLEST_STEPOVER..=LARGEST_STEPOVER).contains(&share) => share * diameter,
            _ => {
                self.at(
                    place,
                    format!(
                        "stepover must be at least {} % and at most {} % of the tool's diameter, {diameter} mm: a length, or \
                         \"40%\" of it",
                        100.0 * SMALLEST_STEPOVER,
                        100.0 * LARGEST_STEPOVER
                    ),
                );
                DEFAULT_STEPOVER * diameter
            }
        }
    }
}
