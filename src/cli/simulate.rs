//! `clopen simulate FILE.nc`: what anyone's program does to its stock, and what goes wrong on the way.

mod args;
mod report;
mod sources;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};

use super::check::FormatArg;
use super::engaged::with_heights;
use super::{ExitStatus, input, output};
use crate::cam::{
    self, Against, AgainstOptions, CutLevel, HeightMap, Program, Remainder, Side, SimulateOptions, Simulation, Stock,
    ToolTable,
};
use crate::gcode::{self, Dialect, Finding, HeaderStock, LintOptions, Reading, Rule};
use crate::io::mesh::{self as files, MeshFormat};
use crate::mesh::PolygonMesh;
use crate::plane::Point;
use crate::preview::{self, DEFAULT_SIZE};
pub(super) use args::SimulateArgs;
use report::SimulateReport;
use sources::{Source, Sources};

/// Faces of the STL stay this near to the height map, in millimetres: less than paper.
const STL_TOLERANCE: f64 = 0.01;

/// How deep beams and pens cut whose programs know no depth, and how high they are lifted, in millimetres, where the thickness
/// of the stock is not given.
const NO_DEPTH: f64 = 1.0;

/// Runs the command: exit status 1 where something was found.
///
/// # Errors
/// Where the program or the drawing cannot be read, a tool is not known, the stock makes no sense, or a file cannot be written.
pub(super) fn run(args: &SimulateArgs) -> Result<ExitStatus> {
    check_targets(args)?;
    let Read { program, sources, guesses, top, thickness } = read(args)?;
    let name = || sources.names();
    let tools = ToolTable::gather(&args.tools, &program);
    let stock = stock(args, &program, &tools, top, thickness)?;
    let options = options(args, &program, &tools, stock)?;
    let simulation = cam::simulate(&program, &tools, &options).with_context(name)?;
    let floor = floor(args, &program, &tools, &stock)?;
    let against = against(args, &program, &tools, &stock, floor)?;
    let levels = match &args.output.levels {
        Some(_) => cam::cut_levels(&program, &tools, &stock).with_context(name)?,
        None => Vec::new(),
    };
    let contents = contents(args, &simulation, &levels)?;
    output::write_together(
        &contents.iter().map(|(path, bytes)| (path.as_path(), bytes.as_slice())).collect::<Vec<_>>(),
    )?;
    let written: Vec<PathBuf> = contents.into_iter().map(|(path, _)| path).collect();
    let report = SimulateReport {
        sources: &sources,
        tools: &tools,
        used: used(&program, top),
        unknown_to_program: {
            let moves = |number| program.motions.iter().any(|m| m.tool == number);
            let told = |number| moves(0) && tools.get(0).is_some_and(|t| t.number == number);
            let numbers = args.tools.iter().map(|t| t.number);
            numbers.filter(|n| !moves(*n) && !told(*n)).collect()
        },
        stock_is_given: args.stock.stock.is_some(),
        simulation: &simulation,
        guesses: &guesses,
        levels: &levels,
        against: against.as_ref(),
        floor,
        side: args.against.side,
        written: &written,
    };
    let text = match args.format {
        FormatArg::Text => report.text(),
        FormatArg::Json => report.json()?,
    };
    // Where a picture is on standard output, the report must not be.
    if written.iter().any(|path| path == Path::new("-")) {
        output::say(&text);
    } else {
        output::print(&text)?;
    }
    Ok(if report.is_clean() { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

/// What was read.
struct Read {
    /// All programs as one.
    program: Program,
    sources: Sources,
    /// What the linter finds that makes the motions, as they were read, no machine's.
    guesses: Vec<Finding>,
    /// z of the top of the stock, and its thickness where it is known.
    top: f64,
    thickness: Option<f64>,
}

fn read(args: &SimulateArgs) -> Result<Read> {
    let asked = args.dialect.as_deref().map(input::dialect).transpose()?;
    let size = args.stock.size()?;
    let mut all = Read {
        program: Program::default(),
        sources: Sources(Vec::new()),
        guesses: Vec::new(),
        top: 0.0,
        thickness: size.map(|[_, _, thickness]| thickness),
    };
    let mut lines_before = 0;
    for path in &args.files {
        let name = || path.display().to_string();
        let text = input::read_text(path)?;
        if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') {
            bail!("{}: this is a drawing and no program: make one of it with `clopen mill` first", name());
        }
        if all.sources.0.is_empty() {
            all.top = input::stock_top(args.stock.stock_top, &text)?;
            all.thickness = all.thickness.or(HeaderStock::of(&text).and_then(|stock| stock.thickness));
        }
        let top = all.top;
        let dialect = asked.as_ref().or(Dialect::of_header(&text)).unwrap_or(Dialect::portable());
        let program = gcode::read_as(&text, dialect).with_context(name)?;
        if program.motions.is_empty() {
            bail!("{}: nothing moves: there is no motion in it that could be simulated", name());
        }
        let program = with_heights(program, dialect, top + NO_DEPTH, top - all.thickness.unwrap_or(NO_DEPTH));
        cam::check_tools(&program, &ToolTable::gather(&args.tools, &program), top).with_context(name)?;
        let findings = gcode::lint(&text, &LintOptions { dialect, stock_top: top });
        // What follows the end does not run.
        let is_other = |f: &Finding| f.rule.info().reading != Reading::Exact || f.rule == Rule::AfterEnd;
        let findings = findings.into_iter().filter(is_other);
        all.guesses.extend(findings.map(|f| Finding { line: f.line + lines_before, ..f }));
        match args.files.len() {
            1 => all.program = program,
            _ => cam::append(&mut all.program, program, lines_before, &args.tools),
        }
        all.sources.0.push(Source { path: path.clone(), lines_before });
        lines_before += text.lines().count();
    }
    Ok(all)
}

/// Before any work: names that cannot be.
fn check_targets(args: &SimulateArgs) -> Result<()> {
    if let Some(picture) = &args.output.output {
        output::keep_png(picture)?;
    }
    if let Some(stl) = args.output.stl.as_ref().filter(|p| p.as_path() != Path::new("-"))
        && MeshFormat::of_path(stl) != Some(MeshFormat::Stl)
    {
        bail!("{}: the mesh is an STL: call it {}", stl.display(), stl.with_extension("stl").display());
    }
    let inputs = || args.files.iter().chain(&args.against.against);
    if inputs().filter(|path| path.as_path() == Path::new("-")).count() > 1 {
        bail!("only one file can come from standard input: name the others");
    }
    let targets = [args.output.output.as_ref(), args.output.stl.as_ref()];
    for target in targets.into_iter().flatten() {
        output::keep_folder(target)?;
        for input in inputs() {
            output::keep_input(input, target)?;
        }
    }
    Ok(())
}

fn stock(args: &SimulateArgs, program: &Program, tools: &ToolTable, top: f64, thickness: Option<f64>) -> Result<Stock> {
    let found = match (args.stock.size()?, args.stock.corner()?) {
        (Some(size), Some([x, y])) => Some(Stock::new(Point::new(x, y), size, top)),
        (Some(size), None) => Stock::around(program, tools, size, top),
        (None, _) => {
            let of_cuts = Stock::of_cuts(program, tools, top);
            of_cuts.map(|stock| Stock { bottom_mm: thickness.map_or(stock.bottom_mm, |t| top - t), ..stock })
        }
    };
    let Some(stock) = found else {
        bail!(
            "{}: nothing goes below z {top}, so that there is nothing to tell the stock by: say where its top is \
             (--stock-top), or all of it (--stock 100x60x6mm --stock-at 0,0)",
            args.files.iter().map(|f| f.display().to_string()).collect::<Vec<_>>().join(", ")
        );
    };
    Ok(stock)
}

fn options(args: &SimulateArgs, program: &Program, tools: &ToolTable, stock: Stock) -> Result<SimulateOptions> {
    let smallest = used(program, stock.top_mm).into_iter().filter_map(|n| tools.get(n)).map(|t| t.diameter);
    let default_cell = || HeightMap::default_cell(&stock, smallest.fold(f64::INFINITY, f64::min).min(LARGEST_TOOL));
    let cell = args.stock.cell.map(|c| input::millimetres(c, "--cell")).transpose()?;
    Ok(SimulateOptions {
        stock,
        cell: cell.unwrap_or_else(default_cell),
        keepouts: args.stock.keepouts.clone(),
        spoil: input::millimetres(args.stock.spoil, "--spoil")?,
        machine: args.machine()?,
    })
}

/// The diameter that cells are chosen for where no tool cuts, in millimetres.
const LARGEST_TOOL: f64 = 20.0;

/// The numbers of the tools that go below the top of the stock.
fn used(program: &Program, top: f64) -> Vec<u32> {
    let mut numbers: Vec<u32> = program.motions.iter().filter(|m| m.is_in_stock(top)).map(|m| m.tool).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// z that the cut must reach. Where it is not said: that of the deepest cut sideways, but none below a stock that is given,
/// because through cuts go a little deeper; the tips of drills do too, and count only where there is nothing else.
fn floor(args: &SimulateArgs, program: &Program, tools: &ToolTable, stock: &Stock) -> Result<f64> {
    if let Some(z) = args.against.floor {
        return input::millimetres(z, "--floor");
    }
    let feeds = || program.motions.iter().filter(|m| m.is_feed());
    let is_mill = |number| tools.get(number).is_none_or(|t| !t.is_drill);
    let sideways = feeds().filter(|m| is_mill(m.tool) && m.trace().next().is_some());
    let deepest = sideways.map(|m| m.lowest()).fold(stock.top_mm, f64::min);
    let deepest =
        if deepest < stock.top_mm { deepest } else { feeds().map(|m| m.lowest()).fold(stock.top_mm, f64::min) };
    Ok(if args.stock.stock.is_some() { deepest.max(stock.bottom_mm) } else { deepest })
}

fn against(
    args: &SimulateArgs,
    program: &Program,
    tools: &ToolTable,
    stock: &Stock,
    floor: f64,
) -> Result<Option<Against>> {
    let Some(path) = &args.against.against else { return Ok(None) };
    let drawing = args.reading.read(path)?;
    let Some(mm_per_unit) = drawing.mm_per_unit else {
        bail!(
            "{}: the drawing has no physical size: say how many of its units make an inch (--dpi 96) or how wide the part \
             is (--width 100mm)",
            path.display()
        );
    };
    let part = drawing.region.scaled(mm_per_unit);
    let part = part.translated(cam::translation(args.against.origin, &part));
    let remainder = match args.against.side {
        Side::Outside => Some(Remainder::Inside),
        Side::Inside => Some(Remainder::Outside),
        Side::On => None,
    };
    let options = AgainstOptions { remainder, stock_top: stock.top_mm, floor };
    Ok(Some(cam::against(program, tools, &part, &options)))
}

/// The files that were asked for.
fn contents(args: &SimulateArgs, simulation: &Simulation, levels: &[CutLevel]) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let mut contents = Vec::new();
    if let Some(path) = &args.output.output {
        contents.push((path.clone(), preview::cut_stock(&simulation.map, &simulation.events, DEFAULT_SIZE)?));
    }
    if let Some(prefix) = &args.output.levels {
        for (level, number) in levels.iter().zip(1..) {
            let mut name = prefix.clone().into_os_string();
            name.push(format!("-{number:02}.png"));
            let picture = preview::cut_level(level, simulation.map.stock(), DEFAULT_SIZE)?;
            contents.push((PathBuf::from(name), picture));
        }
    }
    if let Some(path) = &args.output.stl {
        let surface = cam::stock_surface(&simulation.map, STL_TOLERANCE);
        if surface.faces.is_empty() {
            bail!("{}: nothing of the stock is left that a mesh could show; try a smaller --cell", path.display());
        }
        let mesh = PolygonMesh::of_triangles(surface.points, &surface.faces);
        contents.push((path.clone(), files::write(&mesh, MeshFormat::Stl)));
    }
    Ok(contents)
}
