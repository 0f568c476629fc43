//! Operations of a job file.

use std::ops::Range;

use super::cutting::rates;
use super::{Place, Resolver};
use crate::cam::setup::file::{OperationFile, OperationKindName, SetupFile};
use crate::cam::setup::{Corners, Operation, OperationKind, Pattern, Workpiece};
use crate::cam::{DEFAULT_SIDE, Tool, ToolShape};
use crate::units::Length;

/// Distance between neighbouring paths unless it is said, as a share of the tool's diameter.
const DEFAULT_STEPOVER: f64 = 0.4;

/// The largest share of the diameter that paths may lie apart: beyond it, ridges stay between straight ones.
const LARGEST_STEPOVER: f64 = 0.95;

impl Resolver<'_> {
    pub(super) fn operation(
        &mut self,
        file: &OperationFile,
        table: &Range<usize>,
        index: usize,
        stock: &Workpiece,
        tools: &[Tool],
        whole: &SetupFile,
    ) -> Option<Operation> {
        let place = |key| Place { table, key };
        let Some(kind) = file.kind.as_deref() else {
            self.at(
                place("kind"),
                "an operation needs a kind: profile, pocket, drill, engrave, v-carve, facing or chamfer",
            );
            return None;
        };
        let kind = self.word(place("kind"), Some(kind), &OperationKindName::ALL, OperationKindName::Profile);
        let Some(name) = &file.tool else {
            self.at(place("tool"), "an operation needs a tool, by number or name");
            return None;
        };
        let tool_index = self.find_tool(place("tool"), name, tools)?;
        let tool = &tools[tool_index];
        let label = file.name.clone().filter(|n| !n.trim().is_empty());
        let label = label.unwrap_or_else(|| format!("{} {}", file.kind.as_deref().unwrap_or_default(), index + 1));
        let rates = rates(whole.tool[tool_index].get_ref(), stock.material.as_deref());
        let cutting = self.cutting(file, table, stock, tool, &rates, kind);
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
                OperationKind::Pocket { pattern, stepover, corners, rest_of }
            }
            OperationKindName::Drill => OperationKind::Drill { peck: self.above_zero(place("peck"), file.peck) },
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
            Some(share) if share > 0.0 && share <= LARGEST_STEPOVER => share * diameter,
            _ => {
                self.at(
                    place,
                    format!(
                        "stepover must be above zero and at most {} % of the tool's diameter: a length, or \"40%\" of it",
                        100.0 * LARGEST_STEPOVER
                    ),
                );
                DEFAULT_STEPOVER * diameter
            }
        }
    }
}
