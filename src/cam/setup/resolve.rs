//! From what was typed to a job that makes sense.

mod cutting;
mod keys;
mod operation;
mod rest;
mod tool;

use std::ops::Range;

use self::rest::sorted_by_tool;
use super::file::{KeepoutFile, SetupFile, refuse_flags};
use super::locate::Locator;
use super::problem::{InvalidSetup, SetupProblem};
use super::{Operation, Rig, SETUP_VERSION, Setup, Workpiece};
use crate::cam::{DEFAULT_DWELL, DEFAULT_ORIGIN, DEFAULT_SAFE_CLEARANCE, JobFile, Keepout, Machine, Tool};
use crate::plane::{Bounds, Point};
use crate::units::{DrawingScale, Length, nearest};

/// Largest length a job may name, in millimetres: beyond any machine.
const LARGEST_LENGTH: f64 = 10_000.0;

/// Largest rate of any kind: feeds in mm/min, speeds in 1/min, accelerations in mm/s².
const LARGEST_RATE: f64 = 1e6;

/// Smallest rate of any kind: below it a machine stands still for all that anyone sees, and times lose their meaning.
const SMALLEST_RATE: f64 = 0.1;

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
        if (SMALLEST_RATE..=LARGEST_RATE).contains(&value) {
            return Some(value);
        }
        self.at(
            place,
            format!("{} is {value}: it must be at least {SMALLEST_RATE}, and at most {LARGEST_RATE}", place.key),
        );
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
            let over = |a: &Bounds, b: &Bounds| {
                a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y
            };
            if let Some(j) = keepouts[..k].iter().position(|other| over(&one.outline, &other.outline)) {
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
            let resolved = self.operation(operation, k, &stock, &rig, &tools, file);
            operations.extend(resolved);
        }
        self.rests(file, &operations, &tools);
        if file.sort_by_tool {
            operations = sorted_by_tool(operations, &tools);
        }
        Setup { stock, rig, tools, keepouts, operations }
    }

    fn stock(&mut self, file: &SetupFile) -> Workpiece {
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
        Workpiece {
            zero: file.stock.zero.unwrap_or(DEFAULT_ORIGIN),
            size: width.zip(height).map(|(w, h)| [w, h]),
            thickness,
            top,
            material: file.stock.material.clone(),
        }
    }

    fn rig(&mut self, file: &SetupFile, stock: &Workpiece) -> Rig {
        let machine = &file.machine;
        let default = Machine::default();
        let mut axes = |key: &str, typed: Option<[f64; 3]>, default: [f64; 3]| match typed {
            Some(values) if values.iter().all(|v| (SMALLEST_RATE..=LARGEST_RATE).contains(v)) => values,
            Some(values) => {
                let line = self.locator.line_in("machine", key);
                self.problems.push(SetupProblem {
                    line,
                    message: format!(
                        "{key} is {values:?}: every value must be at least {SMALLEST_RATE} and at most {LARGEST_RATE}"
                    ),
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
        let largest_spindle_speed = machine.largest_spindle_speed;
        if let Some(speed) = largest_spindle_speed
            && !(SMALLEST_RATE..=LARGEST_RATE).contains(&speed)
        {
            let line = self.locator.line_in("machine", "largest-spindle-speed");
            self.complain(
                line,
                format!(
                    "largest-spindle-speed is {speed}: it must be at least {SMALLEST_RATE} and at most {LARGEST_RATE}"
                ),
            );
        }
        Rig {
            dialect: self
                .flags
                .dialect
                .clone()
                .or_else(|| machine.dialect.clone())
                .unwrap_or_else(|| "grbl".to_owned()),
            inches: self.flags.inches.or(machine.inches).unwrap_or(false),
            arcs: self.flags.no_arcs.map(|no| !no).or(machine.arcs).unwrap_or(true),
            limits: Machine { acceleration, rapid, junction_deviation, ..default },
            travel,
            safe_height,
            dwell,
            largest_spindle_speed,
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
        if let Some(top) = file.top
            && !(top.is_finite() && top.abs() <= LARGEST_LENGTH)
        {
            self.at(
                Place { table, key: "top" },
                format!(
                    "top of a keepout is {top}: it is a height in millimetres; leave it out for a keepout of any height"
                ),
            );
        }
        let corners = [Point::new(file.x[0], file.y[0]), Point::new(file.x[1], file.y[1])];
        Keepout { outline: Bounds::of_points(corners), top: file.top.unwrap_or(f64::INFINITY) }
    }
}
