//! Random jobs, each written, read back, linted, held against what it asks for and run on a block of stock:
//! `cargo run --release --example jobs -- --jobs 10000 [--first N] [--only N]`.
//!
//! Exit 1 where a rapid meets material, a program cuts into what must remain by more than 0.002 mm, a controller would
//! refuse it, or a tab, hole or pass that was asked for is missing without a word. The same numbers give the same jobs
//! everywhere.

#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::fmt::Write as _;
use std::process::ExitCode;

use clopen::cam::{
    Geometry, Machine, Notice, OperationError, Setup, SetupFile, SimulateOptions, Step, Stock, ToolTable,
    check_operation, plan_operation, simulate, split_operations,
};
use clopen::gcode::{self, Dialect, LintOptions};
use clopen::plane::{Region, Ring, Vector};
use clopen::units::DrawingScale;
use shapes::Numbers;

/// The deepest cut into what must remain, in millimetres.
const GOUGE_LIMIT: f64 = 0.002;

/// Cells along the longer side of the stock.
const CELLS: f64 = 300.0;

/// Cells at least so fine, in tool diameters: coarser ones do not show what the tool does.
const FINEST: f64 = 0.24;

/// Below the stock tools may go into the board by this much, in millimetres.
const SPOIL: f64 = 1.0;

fn main() -> ExitCode {
    let (mut count, mut first, mut only) = (500, 0, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let number = arguments.next().and_then(|n| n.parse().ok());
        match (argument.as_str(), number) {
            ("--jobs", Some(n)) => count = n,
            ("--first", Some(n)) => first = n,
            ("--only", Some(n)) => only = Some(n),
            _ => {
                eprintln!("usage: jobs [--jobs N] [--first N] [--only N]");
                return ExitCode::from(2);
            }
        }
    }
    let numbers = match only {
        Some(n) => n..n + 1,
        None => first..first + count,
    };
    let (mut done, mut refused, mut wrong) = (0, 0, 0);
    for number in numbers {
        match run(number, only.is_some()) {
            Ok(true) => done += 1,
            Ok(false) => refused += 1,
            Err(what) => {
                wrong += 1;
                println!("job {number}: {what}");
            }
        }
    }
    println!("{done} jobs good, {refused} refused in words, {wrong} wrong");
    if wrong == 0 && done > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Whether the job was done, or rightly refused; what is wrong otherwise.
fn run(number: u64, is_loud: bool) -> Result<bool, String> {
    let mut numbers = Numbers::new(number);
    let area = shape(&mut numbers);
    let text = job(&mut numbers);
    if is_loud {
        println!("{text}");
    }
    let file: SetupFile = text.parse().map_err(|e| format!("{e}\n{text}"))?;
    let scale = DrawingScale { mm_per_unit: Some(1.0), diagonal: area.bounds().diagonal() };
    let setup = match file.resolve(&Default::default(), &scale) {
        Ok(setup) => setup,
        Err(_) => return Ok(false),
    };
    let operation = &setup.operations[0];
    let geometry = Geometry { area, ..Geometry::default() };
    let planned = match plan_operation(&setup, operation, &geometry) {
        Ok(planned) => planned,
        Err(OperationError::Offset(error)) => return Err(format!("no path: {error}\n{text}")),
        Err(_) => return Ok(false),
    };
    let names = ["grbl", "linuxcnc", "grblhal", "mach3"];
    let dialect = Dialect::named(names[numbers.below(names.len())]).map_err(|e| e.to_string())?;
    let step = Step {
        label: operation.label.clone(),
        tool: setup.tool_of(operation).clone(),
        toolpath: planned.toolpath.clone(),
    };
    let program = gcode::write_steps(&[step], &[], dialect, Default::default()).map_err(|e| e.to_string())?;
    if is_loud {
        println!("{program}");
    }
    let findings = gcode::lint(&program, &LintOptions { dialect, stock_top: 0.0 });
    if let Some(finding) = findings.first() {
        return Err(format!("line {}: {}\n{text}", finding.line, finding.message));
    }
    let read = gcode::read_as(&program, dialect).map_err(|e| e.to_string())?;
    let runs = split_operations(&read);
    let [own] = runs.as_slice() else { return Err(format!("{} operations", runs.len())) };
    let check = check_operation(own, operation, &planned, setup.tool_of(operation), &setup.stock, &Machine::default());
    if let Some(gouge) = check.gouge.filter(|g| g.depth_mm > GOUGE_LIMIT) {
        return Err(format!("gouge {gouge:?}\n{text}"));
    }
    if !check.is_done() {
        let islands = &check.islands;
        let counts = [check.tabs, check.holes, check.passes];
        return Err(format!("tabs, holes, passes {counts:?}, {} islands {:?}\n{text}", islands.len(), islands.first()));
    }
    // Told in words, and the job fails.
    if !check.loose.is_empty() {
        return Ok(false);
    }
    let dropped: usize = planned.notices.iter().map(|n| if let Notice::TabsDropped(_, k) = n { *k } else { 0 }).sum();
    // What comes loose is held against the program above.
    let needless = planned.notices.iter().any(|n| matches!(n, Notice::NothingToHold(_)));
    if planned.tabs.is_empty() && dropped == 0 && !needless && operation.cutting.tabs.is_some() {
        return Err(format!("tabs are gone without a word\n{text}"));
    }
    rapids(&setup, &read, &text)
}

/// Runs the program on a block of stock.
fn rapids(setup: &Setup, program: &clopen::cam::Program, text: &str) -> Result<bool, String> {
    let used = setup.tool_of(&setup.operations[0]).clone();
    let tools = ToolTable::gather(std::slice::from_ref(&used), program);
    let Some(cuts) = Stock::of_cuts(program, &tools, 0.0) else { return Ok(true) };
    let stock = Stock { bottom_mm: -6.0, ..cuts };
    let outline = stock.outline();
    let cell = (outline.width().max(outline.height()) / CELLS).min(FINEST * used.diameter);
    let machine = Machine::default();
    let options = SimulateOptions { stock, cell, keepouts: Vec::new(), spoil: SPOIL, machine };
    let simulation = simulate(program, &tools, &options).map_err(|e| e.to_string())?;
    match simulation.events.first() {
        Some(event) => Err(format!("{event:?}\n{text}")),
        None => Ok(true),
    }
}

/// A region some tens of millimetres large, with holes at times.
fn shape(numbers: &mut Numbers) -> Region {
    let size = numbers.between(8.0, 60.0);
    let seed = numbers.below(1 << 30) as u64;
    let region = match numbers.below(8) {
        0 => shapes::l_corner(1.0, numbers.between(0.2, 0.8)),
        1 => shapes::slotted_plate(1.0, 0.7, numbers.between(0.05, 0.5), numbers.between(0.1, 0.6)),
        2 => shapes::coast(20 + numbers.below(60), 0.5, seed),
        3 => shapes::star(3 + numbers.below(8), numbers.between(0.2, 0.8), 1.0),
        4 => shapes::gear(5 + numbers.below(12), 0.7, 1.0, numbers.between(0.1, 0.5)),
        5 => shapes::dumbbell(0.5, numbers.between(0.1, 0.6), numbers.between(0.02, 0.4)),
        6 => shapes::two_disks(0.5, numbers.between(1.1, 2.0)),
        _ => Region::new(vec![Ring::circle(clopen::plane::Point::origin(), 0.5)]),
    };
    let bounds = region.bounds();
    region.scaled(size / bounds.width().max(bounds.height())).translated(Vector::new(30.0, 30.0))
}

/// The text of a job with one operation.
fn job(numbers: &mut Numbers) -> String {
    let diameter = [0.8, 1.5, 2.0, 3.0, 3.175, 6.0][numbers.below(6)];
    let mut text = format!(
        "version = 1\n[stock]\nthickness = 6\n[[tool]]\nnumber = 1\ndiameter = {diameter}\nfeed = 1200\nplunge-feed = 300\n\
         depth-per-pass = {:.2}\n[[tool]]\nnumber = 2\ntype = \"v\"\nangle = {}\ndiameter = 8\nfeed = 900\nplunge-feed = 250\n",
        numbers.between(0.5, 3.0),
        [30, 60, 90, 120][numbers.below(4)]
    );
    let kind = ["profile", "profile", "pocket", "pocket", "engrave", "v-carve", "chamfer"][numbers.below(7)];
    let tool = if matches!(kind, "v-carve" | "chamfer") { 2 } else { 1 };
    let _ = write!(text, "[[operation]]\nkind = \"{kind}\"\ntool = {tool}\n");
    let mut add = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    match kind {
        "v-carve" => add(format!("max-depth = {:.2}", numbers.between(0.5, 5.0))),
        "chamfer" => add(format!("width = {:.2}", numbers.between(0.2, 2.0))),
        _ if numbers.below(3) == 0 => add("through = true".into()),
        _ => add(format!("depth = {:.2}", numbers.between(0.3, 6.0))),
    }
    // Drawn for every kind, so that a number stays the same job; said where it means something.
    let entry = ["ramp", "helix", "plunge"][numbers.below(3)];
    if kind != "v-carve" {
        add(format!("entry = \"{entry}\""));
    }
    let direction = ["climb", "conventional"][numbers.below(2)];
    if kind != "engrave" {
        add(format!("direction = \"{direction}\""));
    }
    let path_radius = (numbers.below(2) == 0).then(|| numbers.between(0.0, 1.5));
    if let Some(radius) = path_radius.filter(|_| !matches!(kind, "engrave" | "v-carve")) {
        add(format!("path-radius = {radius:.2}"));
    }
    if matches!(kind, "profile" | "chamfer") {
        add(format!("side = \"{}\"", ["outside", "inside"][numbers.below(2)]));
        if numbers.below(2) == 0 {
            add(format!("lead = {:.2}", numbers.between(0.3, 4.0)));
        }
    }
    if kind == "profile" {
        match numbers.below(4) {
            0 => add(format!(
                "tabs = {{ count = {}, width = {:.1}, height = 0.2 }}",
                1 + numbers.below(4),
                numbers.between(1.0, 6.0)
            )),
            1 => add("onion-skin = 0.2".into()),
            _ => {}
        }
    }
    if matches!(kind, "profile" | "pocket") {
        if numbers.below(3) == 0 {
            add(format!("allowance = {:.2}", numbers.between(0.05, 0.5)));
        }
        if numbers.below(4) == 0 {
            add(format!("corners = \"{}\"", ["dogbone", "t-bone"][numbers.below(2)]));
        }
    }
    if kind == "pocket" {
        add(format!("pattern = \"{}\"", ["rings", "raster"][numbers.below(2)]));
        add(format!("stepover = \"{:.0}%\"", numbers.between(20.0, 60.0)));
    }
    text
}
