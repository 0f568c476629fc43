//! From what was typed to a job that makes sense.

use std::ops::Range;

use super::file::{
    InvalidSetup, KeepoutFile, OperationFile, OperationKindName, RatesFile, SetupFile, SetupProblem, TabsFile,
    ToolFile, ToolName, refuse_flags,
};
use super::locate::Locator;
use super::{
    Corners, Cutting, Keepout, Operation, OperationKind, Pattern, Rig, SETUP_VERSION, Setup, Steps, Stock, TabPlaces,
    Tabs,
};
use crate::cam::job_file::TypedPathRadius;
use crate::cam::{
    DEFAULT_DEPTH_PER_PASS, DEFAULT_DIRECTION, DEFAULT_DWELL, DEFAULT_ENTRY, DEFAULT_FEED, DEFAULT_PATH_RADIUS,
    DEFAULT_PLUNGE_FEED, DEFAULT_SAFE_CLEARANCE, DEFAULT_SIDE, DEFAULT_SPINDLE_SPEED, JobFile, Machine, PathRadius,
    Tool, ToolShape,
};
use crate::units::{DrawingScale, Length, Speed, nearest};

/// Largest length a job may name, in millimetres: beyond any machine.
const LARGEST_LENGTH: f64 = 10_000.0;

/// Largest rate of any kind: feeds in mm/min, speeds in 1/min, accelerations in mm/s².
const LARGEST_RATE: f64 = 1e6;

/// Most passes of an operation: more is a slip of the unit.
const MOST_PASSES: f64 = 1000.0;

/// Distance between neighbouring paths unless it is said, as a share of the tool's diameter.
const DEFAULT_STEPOVER: f64 = 0.4;

/// The largest share of the diameter that paths may lie apart: beyond it, ridges stay between straight ones.
const LARGEST_STEPOVER: f64 = 0.95;

/// Angle of a drill's tip in degrees.
const DRILL_ANGLE: f64 = 118.0;

/// Width of a tab in tool diameters, and its height as a share of the depth, unless they are said.
const DEFAULT_TAB_WIDTH: f64 = 2.0;
const DEFAULT_TAB_HEIGHT: f64 = 0.4;

/// How much deeper than the stock is thick a cut through it goes, in millimetres, so that nothing hangs on by a film.
const THROUGH: f64 = 0.2;

/// How much deeper than its stock an operation may go: into the board below.
const DEEPEST_BELOW: f64 = 5.0;

impl SetupFile {
    /// The job, for a drawing of this scale, with what the flags say in place of what the file says.
    ///
    /// # Errors
    /// Lists every value that makes no sense, with its line.
    pub fn resolve(&self, flags: &JobFile, scale: &DrawingScale) -> Result<Setup, InvalidSetup> {
        let mut resolver = Resolver { locator: &self.locator, scale, flags, problems: Vec::new() };
        let setup = resolver.setup(self);
        let mut problems = resolver.problems;
        problems.sort_by_key(|p| p.line);
        if problems.is_empty() { Ok(setup) } else { Err(InvalidSetup { problems }) }
    }
}

/// Where a value stands: in which table, and under which name.
#[derive(Clone, Copy)]
struct Place<'a> {
    table: &'a Range<usize>,
    key: &'a str,
}

struct Resolver<'a> {
    locator: &'a Locator,
    scale: &'a DrawingScale,
    flags: &'a JobFile,
    problems: Vec<SetupProblem>,
}

impl Resolver<'_> {
    fn complain(&mut self, line: usize, message: impl Into<String>) {
        self.problems.push(SetupProblem { line, message: message.into() });
    }

    fn at(&mut self, place: Place, message: impl Into<String>) {
        let line = self.locator.line_of(place.table, place.key);
        self.complain(line, message);
    }

    /// A length of a table in millimetres.
    fn mm(&mut self, place: Place, length: Option<Length>) -> Option<f64> {
        let millimetres = length?.to_millimetres(self.scale);
        match millimetres {
            Ok(mm) if mm.is_finite() && mm.abs() <= LARGEST_LENGTH => Some(mm),
            Ok(mm) => {
                self.at(place, format!("{} is {mm:.3e} mm, which no machine does: is the unit right?", place.key));
                None
            }
            Err(error) => {
                self.at(place, format!("{}: {error}", place.key));
                None
            }
        }
    }

    /// A length that must be above zero.
    fn above_zero(&mut self, place: Place, length: Option<Length>) -> Option<f64> {
        let mm = self.mm(place, length)?;
        if mm > 0.0 {
            return Some(mm);
        }
        self.at(place, format!("{} is {mm} mm: it must be above zero", place.key));
        None
    }

    /// A length that must not be negative.
    fn zero_or_more(&mut self, place: Place, length: Option<Length>) -> Option<f64> {
        let mm = self.mm(place, length)?;
        if mm >= 0.0 {
            return Some(mm);
        }
        self.at(place, format!("{} is {mm} mm: it must be zero or more", place.key));
        None
    }

    fn rate(&mut self, place: Place, value: Option<f64>) -> Option<f64> {
        let value = value?;
        if value > 0.0 && value <= LARGEST_RATE {
            return Some(value);
        }
        self.at(place, format!("{} is {value}: it must be above zero, and at most {LARGEST_RATE}", place.key));
        None
    }

    fn word<T: Copy>(&mut self, place: Place, word: Option<&str>, choices: &[(&str, T)], default: T) -> T {
        let Some(word) = word else { return default };
        let lower = word.trim().to_ascii_lowercase();
        if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == lower) {
            return *choice;
        }
        let near = nearest(&lower, choices.iter().map(|(name, _)| *name));
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let hint = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
        self.at(place, format!("{} \"{word}\" is none of {}{hint}", place.key, names.join(", ")));
        default
    }

    fn setup(&mut self, file: &SetupFile) -> Setup {
        match file.version {
            Some(version) if version != SETUP_VERSION => {
                let line = self.locator.line_of(&(0..0), "version");
                self.complain(
                    line,
                    format!("version {version} of job files is unknown: this program reads version {SETUP_VERSION}"),
                );
            }
            _ => {}
        }
        if let Some(flag) = refuse_flags(self.flags) {
            self.complain(0, format!("{flag} means nothing for a job with operations: they name their tools"));
        }
        let stock = self.stock(file);
        let rig = self.rig(file, &stock);
        let tools: Vec<Tool> = file.tool.iter().map(|t| self.tool(t.get_ref(), &t.span())).collect();
        for (k, tool) in tools.iter().enumerate() {
            if tools[..k].iter().any(|other| other.number == tool.number) {
                let line = self.locator.line(file.tool[k].span().start);
                self.complain(line, format!("there is another tool {}: give each a number of its own", tool.number));
            }
        }
        let keepouts: Vec<Keepout> = file.keepout.iter().map(|k| self.keepout(k.get_ref(), &k.span())).collect();
        for (k, one) in keepouts.iter().enumerate() {
            let over = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
            if let Some(j) = keepouts[..k].iter().position(|other| over(one.x, other.x) && over(one.y, other.y)) {
                let (line, other) =
                    (self.locator.line(file.keepout[k].span().start), self.locator.line(file.keepout[j].span().start));
                self.complain(line, format!("this keepout overlaps that of line {other}: make one of them"));
            }
        }
        if file.operation.is_empty() {
            self.complain(0, "there is no [[operation]]: say what is to be done");
        }
        let mut operations: Vec<Operation> = Vec::new();
        for (k, operation) in file.operation.iter().enumerate() {
            let resolved = self.operation(operation.get_ref(), &operation.span(), k, &stock, &tools, file);
            operations.extend(resolved);
        }
        if file.sort_by_tool {
            let first = |tool: usize| operations.iter().position(|o| o.tool == tool);
            let ranks: Vec<Option<usize>> = operations.iter().map(|o| first(o.tool)).collect();
            let mut order: Vec<usize> = (0..operations.len()).collect();
            order.sort_by_key(|&k| (ranks[k], k));
            operations = order.into_iter().map(|k| operations[k].clone()).collect();
        }
        Setup { stock, rig, tools, keepouts, operations }
    }

    fn stock(&mut self, file: &SetupFile) -> Stock {
        let top_line = self.locator.line_in("stock", "top");
        let mut length = |key: &str, length: Option<Length>| {
            let mm = length?.to_millimetres(self.scale);
            match mm {
                Ok(mm) if mm > 0.0 && mm <= LARGEST_LENGTH => Some(mm),
                Ok(mm) => {
                    let line = self.locator.line_in("stock", key);
                    self.problems.push(SetupProblem {
                        line,
                        message: format!(
                            "{key} of the stock is {mm} mm: it must be above zero and at most {LARGEST_LENGTH}"
                        ),
                    });
                    None
                }
                Err(error) => {
                    let line = self.locator.line_in("stock", key);
                    self.problems.push(SetupProblem { line, message: format!("{key}: {error}") });
                    None
                }
            }
        };
        let (width, height) = (length("width", file.stock.width), length("height", file.stock.height));
        let thickness = length("thickness", file.stock.thickness);
        let top = self.flags.stock_top.or(file.stock.top).map_or(Ok(0.0), |l| l.to_millimetres(self.scale));
        let top = match top {
            Ok(top) if top.is_finite() && top.abs() <= LARGEST_LENGTH => top,
            _ => {
                self.complain(top_line, "top of the stock must be a length that a machine has");
                0.0
            }
        };
        Stock { size: width.zip(height).map(|(w, h)| [w, h]), thickness, top, material: file.stock.material.clone() }
    }

    fn rig(&mut self, file: &SetupFile, stock: &Stock) -> Rig {
        let machine = &file.machine;
        let default = Machine::default();
        let mut axes = |key: &str, typed: Option<[f64; 3]>, default: [f64; 3]| match typed {
            Some(values) if values.iter().all(|v| *v > 0.0 && *v <= LARGEST_RATE) => values,
            Some(values) => {
                let line = self.locator.line_in("machine", key);
                self.problems.push(SetupProblem {
                    line,
                    message: format!("{key} is {values:?}: every value must be above zero and at most {LARGEST_RATE}"),
                });
                default
            }
            None => default,
        };
        let flag = self.flags.acceleration.map(|a| [a; 3]);
        let acceleration =
            axes("acceleration", flag.or(machine.acceleration.map(|a| a.values())), default.acceleration);
        let rapid = axes("rapid", machine.rapid.map(|a| a.values()), default.rapid);
        let travel = machine.travel.map(|t| axes("travel", Some(t), t));
        let safe = self.flags.safe_height.or(machine.safe_height).map(|l| l.to_millimetres(self.scale));
        let safe_height = match safe {
            None => stock.top + DEFAULT_SAFE_CLEARANCE,
            Some(Ok(height)) if height > stock.top && height <= LARGEST_LENGTH => height,
            Some(_) => {
                let line = self.locator.line_in("machine", "safe-height");
                self.complain(line, format!("safe-height must be above the top of the stock, {} mm", stock.top));
                stock.top + DEFAULT_SAFE_CLEARANCE
            }
        };
        let dwell = self.flags.dwell.or(machine.dwell).unwrap_or(DEFAULT_DWELL);
        if !(0.0..=LARGEST_RATE).contains(&dwell) {
            let line = self.locator.line_in("machine", "dwell");
            self.complain(line, format!("dwell is {dwell} s: it must be zero or more"));
        }
        let deviation = machine.junction_deviation.map(|l| l.to_millimetres(self.scale));
        let junction_deviation = match deviation {
            None => default.junction_deviation,
            Some(Ok(mm)) if mm > 0.0 && mm <= 1.0 => mm,
            Some(_) => {
                let line = self.locator.line_in("machine", "junction-deviation");
                self.complain(line, "junction-deviation must be above zero and at most 1 mm");
                default.junction_deviation
            }
        };
        Rig {
            dialect: self
                .flags
                .dialect
                .as_ref()
                .map(ToString::to_string)
                .or_else(|| machine.dialect.clone())
                .unwrap_or_else(|| "grbl".to_owned()),
            inches: self.flags.inches.or(machine.inches).unwrap_or(false),
            arcs: self.flags.no_arcs.map(|no| !no).or(machine.arcs).unwrap_or(true),
            limits: Machine { acceleration, rapid, junction_deviation, ..default },
            travel,
            safe_height,
            dwell,
            largest_spindle_speed: machine.largest_spindle_speed,
        }
    }

    fn tool(&mut self, file: &ToolFile, table: &Range<usize>) -> Tool {
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
            flutes: file.flutes.unwrap_or(2).max(1),
            flute_length,
        }
    }

    fn keepout(&mut self, file: &KeepoutFile, table: &Range<usize>) -> Keepout {
        for (key, [least, largest]) in [("x", file.x), ("y", file.y)] {
            if !(least < largest && least.is_finite() && largest.is_finite()) {
                self.at(
                    Place { table, key },
                    format!("{key} of a keepout is [{least}, {largest}]: the smaller comes first"),
                );
            }
        }
        Keepout { x: file.x, y: file.y, top: file.top.unwrap_or(f64::INFINITY) }
    }

    /// The index of the tool that is named.
    fn find_tool(&mut self, place: Place, name: &ToolName, tools: &[Tool]) -> Option<usize> {
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

    fn operation(
        &mut self,
        file: &OperationFile,
        table: &Range<usize>,
        index: usize,
        stock: &Stock,
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

    fn cutting(
        &mut self,
        file: &OperationFile,
        table: &Range<usize>,
        stock: &Stock,
        tool: &Tool,
        rates: &RatesFile,
        kind: OperationKindName,
    ) -> Cutting {
        let place = |key| Place { table, key };
        let start_depth = self.zero_or_more(place("start-depth"), file.start_depth).unwrap_or(0.0);
        let depth = self.depth(file, table, stock, kind);
        if depth <= start_depth && kind != OperationKindName::Chamfer {
            self.at(place("depth"), format!("depth is {depth} mm, not below the start-depth of {start_depth} mm"));
        }
        if let Some(thickness) = stock.thickness
            && depth > thickness + DEEPEST_BELOW
        {
            self.at(place("depth"), format!("depth is {depth} mm, far below the stock, which is {thickness} mm thick"));
        }
        let typed = self.flags.depth_per_pass.or(file.depth_per_pass).or(rates.depth_per_pass);
        let depth_per_pass =
            self.above_zero(place("depth-per-pass"), typed).unwrap_or(DEFAULT_DEPTH_PER_PASS.min(0.5 * tool.diameter));
        if depth_per_pass > tool.flute_length {
            self.at(
                place("depth-per-pass"),
                format!(
                    "a pass of {depth_per_pass} mm is deeper than the flutes of tool {}, {} mm",
                    tool.number, tool.flute_length
                ),
            );
        }
        if (depth - start_depth) / depth_per_pass > MOST_PASSES {
            self.at(
                place("depth-per-pass"),
                format!("depth {depth} mm at {depth_per_pass} mm a pass takes more than {MOST_PASSES} passes"),
            );
        }
        let steps = [("even", Steps::Even), ("stepped", Steps::Stepped)];
        let feed = self.flags.feed.or(file.feed).or(rates.feed).unwrap_or_else(|| speed(DEFAULT_FEED));
        let plunge_feed = self
            .flags
            .plunge_feed
            .or(file.plunge_feed)
            .or(rates.plunge_feed)
            .unwrap_or_else(|| speed(DEFAULT_PLUNGE_FEED));
        let spindle = self.flags.spindle_speed.or(file.spindle_speed).or(rates.spindle_speed);
        let spindle_speed = self.rate(place("spindle-speed"), spindle).unwrap_or(DEFAULT_SPINDLE_SPEED);
        let path_radius = match self.flags.path_radius.or(file.path_radius) {
            None => DEFAULT_PATH_RADIUS,
            Some(TypedPathRadius::Auto) => PathRadius::Auto,
            Some(TypedPathRadius::Length(length)) => {
                PathRadius::Length(self.zero_or_more(place("path-radius"), Some(length)).unwrap_or(0.0))
            }
        };
        let allowance = self.zero_or_more(place("allowance"), file.allowance).unwrap_or(0.0);
        let tabs = file.tabs.as_ref().and_then(|tabs| self.tabs(tabs, table, depth - start_depth, tool));
        let onion_skin = self.above_zero(place("onion-skin"), file.onion_skin);
        if onion_skin.is_some_and(|skin| skin >= depth - start_depth) {
            self.at(place("onion-skin"), "the onion skin is as thick as the cut is deep");
        }
        Cutting {
            start_depth,
            depth,
            depth_per_pass,
            steps: self.word(place("passes"), file.passes.as_deref(), &steps, Steps::Even),
            final_pass: self.above_zero(place("final-pass"), file.final_pass),
            feed,
            plunge_feed,
            spindle_speed,
            direction: self.flags.direction.or(file.direction).unwrap_or(DEFAULT_DIRECTION),
            path_radius,
            entry: self.flags.entry.or(file.entry).unwrap_or(DEFAULT_ENTRY),
            lead: self.above_zero(place("lead"), file.lead),
            tabs,
            onion_skin,
            allowance,
            finish: file.finish.unwrap_or(allowance > 0.0),
        }
    }

    fn depth(&mut self, file: &OperationFile, table: &Range<usize>, stock: &Stock, kind: OperationKindName) -> f64 {
        let place = |key| Place { table, key };
        if file.through == Some(true) && self.flags.depth.is_none() {
            if file.depth.is_some() {
                self.at(place("through"), "depth and through contradict each other: leave one out");
            }
            if let Some(thickness) = stock.thickness {
                return thickness + THROUGH;
            }
            self.at(place("through"), "through needs the thickness of the stock: thickness in [stock]");
            return 1.0;
        }
        let typed = self.flags.depth.or(file.depth);
        match (typed, kind) {
            (Some(_), _) => self.above_zero(place("depth"), typed).unwrap_or(1.0),
            // The depth follows from the width.
            (None, OperationKindName::VCarve | OperationKindName::Chamfer) => stock.thickness.unwrap_or(LARGEST_LENGTH),
            (None, _) => {
                self.at(place("depth"), "this operation needs a depth, or through = true");
                1.0
            }
        }
    }

    fn tabs(&mut self, file: &TabsFile, table: &Range<usize>, depth: f64, tool: &Tool) -> Option<Tabs> {
        let place = |key| Place { table, key };
        let said =
            usize::from(file.count.is_some()) + usize::from(file.spacing.is_some()) + usize::from(file.at.is_some());
        if said != 1 {
            self.at(place("tabs"), "tabs need one of count, spacing and at");
            return None;
        }
        let places = match (file.count, &file.at) {
            (Some(0), _) => {
                self.at(place("count"), "count of tabs is 0: leave them out, or ask for some");
                return None;
            }
            (Some(count), _) => TabPlaces::Count(count),
            (None, Some(at)) => TabPlaces::At(at.clone()),
            (None, None) => TabPlaces::Spacing(self.above_zero(place("spacing"), file.spacing)?),
        };
        let width = self.above_zero(place("width"), file.width).unwrap_or(DEFAULT_TAB_WIDTH * tool.diameter);
        let height = self.above_zero(place("height"), file.height).unwrap_or(DEFAULT_TAB_HEIGHT * depth);
        if height > depth {
            self.at(place("height"), format!("tabs of {height} mm are higher than the cut is deep, {depth} mm"));
        }
        Some(Tabs { places, width, height })
    }
}

/// What a tool does in a material, over what it does in any.
fn rates(tool: &ToolFile, material: Option<&str>) -> RatesFile {
    let special = material.and_then(|m| tool.material.get(m)).cloned().unwrap_or_default();
    RatesFile {
        feed: special.feed.or(tool.feed),
        plunge_feed: special.plunge_feed.or(tool.plunge_feed),
        spindle_speed: special.spindle_speed.or(tool.spindle_speed),
        depth_per_pass: special.depth_per_pass.or(tool.depth_per_pass),
    }
}

fn speed(mm_per_min: f64) -> Speed {
    // The defaults are above zero.
    Speed::from_mm_per_min(mm_per_min).unwrap_or_else(|| unreachable!("a default feed is above zero"))
}
