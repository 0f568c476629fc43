//! A job with operations: from the drawing and the job file to programs that are held against both.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, anyhow, bail};

use super::drawn::{chosen, drawn_outlines, geometry, parts, shift};
use super::setup_report::SetupReport;
use super::setup_saved::{sharp_plan, sharp_programs, sharp_setup};
use super::{
    FormatArg, LAP_DEPTH, LASER_POWER, MillArgs, Verdict, job_order, keep_page, laser_power, setup_page, stock_edges,
    target, travel,
};
use crate::cam::{
    self, Entry, Geometry, Hole, Notice, Operation, OperationCheck, OperationKind, Planned, Program, Remainder, Setup,
    SetupFile, Side, Step, Steps, Tool, check_amount, check_operation, plan_operation, split_operations,
};
use crate::check::{LostFeature, lost_features};
use crate::cli::engaged::{laps, with_heights};
use crate::cli::report::gouges;
use crate::cli::{ExitStatus, input, output};
use crate::gcode::{
    self, Arcs, DIALECT_COMMENT, Dialect, Finding, HeaderStock, LintOptions, MachineKind, Units, WriteOptions,
};
use crate::plane::{Point, Region};
use crate::preview::{self, DEFAULT_SIZE, Scene};
use crate::reference::Operation as ReferenceOperation;
use crate::threads;
use crate::units::Radius;

/// A program of the job, as the machine gets it.
pub(super) struct Written {
    /// Which it is, counted from 0.
    pub(super) index: usize,
    pub(super) path: PathBuf,
    pub(super) text: String,
    pub(super) program: Program,
    pub(super) findings: Vec<Finding>,
}

/// An operation with what was planned for it and what its program does.
pub(super) struct Done<'a> {
    pub(super) operation: &'a Operation,
    pub(super) planned: Planned,
    pub(super) check: OperationCheck,
    /// The motions that are its own.
    pub(super) run: Program,
    /// The index of the program that they are from.
    pub(super) program: usize,
    pub(super) lost: Vec<LostFeature>,
    /// How wide the tool cuts.
    pub(super) width: f64,
    pub(super) path_radius: f64,
}

/// Runs the command for a job file with operations.
///
/// # Errors
/// Where the drawing or the job makes no sense, or a file cannot be written.
pub(super) fn run(args: &MillArgs, job: &Path, text: &str) -> Result<ExitStatus> {
    let name = args.input.display();
    let target = target(args);
    output::keep_file(&target)?;
    output::keep_input(&args.input, &target)?;
    output::keep_input(job, &target)?;
    keep_page(args)?;
    let shapes = args.reading.read_shapes(&args.input)?;
    let Some(mm_per_unit) = shapes.mm_per_unit else {
        bail!(
            "{name}: the drawing has no physical size: say how many of its units make an inch (--dpi 96) or how wide \
             the part is (--width 100mm)"
        );
    };
    if let Some(note) = args.reading.scale_note(&shapes.page) {
        output::say(&format!("clopen: {name}: {note}\n"));
    }
    let mut file: SetupFile = text.parse().with_context(|| job.display().to_string())?;
    let settings = read_machine_settings(&mut file, job)?;
    let resolve =
        |file: SetupFile| file.resolve(&args.typed(), &shapes.scale()).with_context(|| job.display().to_string());
    let mut setup = resolve(file.clone())?;
    let (dialect, dialect_file) = input::dialect_beside(&setup.rig.dialect, job)?;
    if dialect.machine != MachineKind::Router {
        let power = Some(LASER_POWER).filter(|_| dialect.machine == MachineKind::Laser);
        file.default_rates(power, LAP_DEPTH);
        setup = resolve(file)?;
    }
    // All that is read: nothing of it may be written over.
    let inputs: Vec<&Path> = [Some(args.input.as_path()), Some(job), settings.as_deref(), dialect_file.as_deref()]
        .into_iter()
        .flatten()
        .collect();
    keep_inputs(&inputs, [target.as_path()].into_iter().chain(args.html.as_deref()))?;
    if !dialect.has_depth() {
        // Nothing goes down: on a ramp the beam would go around several times in one pass.
        setup.operations.iter_mut().for_each(|o| o.cutting.entry = Entry::Plunge);
    }
    if dialect.machine == MachineKind::Laser {
        for cutting in setup.operations.iter_mut().map(|o| &mut o.cutting) {
            cutting.steps = Steps::Even;
            let pass = (cutting.depth - cutting.start_depth) / cutting.pass_heights(0.0).len() as f64;
            cutting.spindle_speed = laser_power(cutting.spindle_speed, pass, cutting.depth_per_pass);
        }
    }
    let shift = shift(setup.stock.zero, &shapes, mm_per_unit);
    let options = WriteOptions {
        units: if setup.rig.inches { Units::Inches } else { Units::Millimetres },
        arcs: if setup.rig.arcs { Arcs::Arcs } else { Arcs::Lines },
    };

    let place = |o: &Operation| format!("{}: line {}: operation \"{}\"", job.display(), o.line, o.label);
    let parts = parts(&setup, &shapes, mm_per_unit, shift);
    let drawn = |o: &Operation, holes: &[Hole]| geometry(o, &shapes, mm_per_unit, shift, holes, &parts);
    let mut planned: Vec<Planned> = Vec::new();
    let mut worked_on: Vec<Geometry> = Vec::new();
    let mut holes: Vec<Hole> = Vec::new();
    let sharp = sharp_setup(&setup);
    let mut sharp_plans: Vec<Option<Planned>> = Vec::new();
    for (k, operation) in setup.operations.iter().enumerate() {
        let geometry = drawn(operation, &holes).with_context(|| place(operation))?;
        check_amount(&setup, operation, &geometry).with_context(|| place(operation))?;
        let (plan, sharp_plan) = threads::both(
            || plan_operation(&setup, operation, &geometry),
            || sharp.as_ref().and_then(|sharp| sharp_plan(&setup, sharp, k, &geometry)),
        );
        let mut plan = plan.with_context(|| place(operation))?;
        sharp_plans.push(sharp_plan);
        if !matches!(operation.kind, OperationKind::Facing { .. }) {
            let covered = shapes.covered(&chosen(&shapes, operation)?);
            plan.notices.extend(covered.into_iter().map(|p| Notice::Covered(p * mm_per_unit + shift)));
        }
        if !matches!(operation.kind, OperationKind::Facing { .. } | OperationKind::Engrave) {
            let open = shapes.open_lines(&chosen(&shapes, operation)?);
            plan.notices.extend(open.into_iter().map(|p| Notice::OpenLine(p * mm_per_unit + shift)));
        }
        holes.extend(&plan.holes);
        worked_on.push(geometry);
        planned.push(plan);
    }
    let (out_of_order, loosened) = {
        let steps = job_order::steps(&setup, &worked_on, &planned);
        (job_order::out_of_order(&setup, &steps), job_order::loosened(&setup, &steps))
    };
    let steps = steps(&setup, &planned);
    let written = write(args, &setup, &dialect, options, &steps, &target)?;
    let runs = runs(&planned, &written)?;
    let has_files = target != Path::new("-");
    let is_drawn = !args.no_preview && (has_files || args.html.is_some());
    let draw_all = || -> Result<Vec<Option<Vec<u8>>>> {
        let drawn_outlines = drawn_outlines(&shapes, mm_per_unit, shift);
        let tools_of = |program: usize| {
            let own = setup.operations.iter().zip(&runs).filter(move |(_, (of, _))| *of == program);
            tools(&setup, own.map(|(operation, _)| operation))
        };
        let picture = |w: &Written| is_drawn.then(|| draw(&setup, &drawn_outlines, &tools_of(w.index), w)).transpose();
        written.iter().map(picture).collect()
    };
    let (done, (pictures, sharp)) = threads::both(
        || hold_against(&setup, &dialect, planned.clone(), &runs),
        || {
            let sharp = sharp
                .as_ref()
                .and_then(|sharp| sharp_programs(&setup, sharp, &dialect, options, &planned, sharp_plans));
            (draw_all(), sharp)
        },
    );
    let pictures = pictures?;
    let tabs_lost = job_order::tabs_lost(&setup, &done);
    let mut unsafe_travel = travel::beyond_travel(&setup, &written);
    unsafe_travel.extend(travel::collisions(&setup, &done, &written));
    let mut remarks = stock_edges::beyond(&setup, setup.stock.zero, &done);
    remarks.extend(travel::unknown_ways(&setup, &written));
    remarks.extend(loosened);
    let saved = sharp.map(|sharp| sharp.saves(&setup, &written));

    // A program may be run by one who has not read the report.
    let is_withheld = done.iter().any(|d| gouges(d.check.gouge.as_ref())) || !unsafe_travel.is_empty();
    let programs = written.iter().filter(|_| !is_withheld);
    let mut contents: Vec<(PathBuf, Vec<u8>)> =
        programs.map(|w| (w.path.clone(), w.text.clone().into_bytes())).collect();
    if target == Path::new("-") && written.len() > 1 {
        bail!("the job takes {} programs, one a tool: name a file with --output", written.len());
    }
    for (program, png) in written.iter().zip(&pictures).filter(|_| has_files) {
        contents.extend(png.clone().map(|png| (program.path.with_extension("png"), png)));
    }
    let files: Vec<PathBuf> = contents.iter().map(|(path, _)| path.clone()).chain(args.html.clone()).collect();
    let report = SetupReport {
        input: &args.input,
        job,
        setup: &setup,
        dialect: &dialect,
        done: &done,
        accept_losses: args.accept_losses,
        written: &written,
        is_withheld,
        unsafe_travel: &unsafe_travel,
        out_of_order: &out_of_order,
        tabs_lost: &tabs_lost,
        remarks: &remarks,
        saved: saved.as_ref(),
        files: &files,
    };
    if let Some(html) = &args.html {
        contents.push((html.clone(), setup_page::page(&report, pictures).into_bytes()));
    }
    keep_inputs(&inputs, contents.iter().map(|(path, _)| path.as_path()))?;
    output::write_together(&contents.iter().map(|(p, b)| (p.as_path(), b.as_slice())).collect::<Vec<_>>())?;
    let text = match args.format {
        FormatArg::Text => report.text(),
        FormatArg::Json => report.json()?,
    };
    if target == Path::new("-") {
        output::say(&text);
    } else {
        output::print(&text)?;
    }
    Ok(match report.verdict() {
        Verdict::Good => ExitStatus::Done,
        Verdict::Failed => ExitStatus::CheckFailed,
    })
}

/// Refuses results in place of what is read.
fn keep_inputs<'a>(inputs: &[&Path], mut results: impl Iterator<Item = &'a Path>) -> Result<()> {
    results.try_for_each(|result| inputs.iter().try_for_each(|input| output::keep_input(input, result)))
}

/// What GRBL answered to `$$`, where the job file names a file with it; and that file.
fn read_machine_settings(file: &mut SetupFile, job: &Path) -> Result<Option<PathBuf>> {
    let Some(name) = &file.machine.settings else { return Ok(None) };
    let path = job.parent().unwrap_or(Path::new("")).join(name);
    let text = input::read_text(&path)?;
    let settings = gcode::grbl_settings::read(&text).with_context(|| path.display().to_string())?;
    let travel = match settings.travel {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    file.machine.take(&settings.machine(&cam::Machine::default()), travel, settings.spindle_max);
    Ok(Some(path))
}

/// What is done one after the other.
pub(super) fn steps(setup: &Setup, planned: &[Planned]) -> Vec<Step> {
    let step = |(o, p): (&Operation, &Planned)| Step {
        label: o.label.clone(),
        tool: setup.tool_of(o).clone(),
        toolpath: p.toolpath.clone(),
    };
    setup.operations.iter().zip(planned).map(step).collect()
}

/// The texts, and what they say when they are read back.
fn write(
    args: &MillArgs,
    setup: &Setup,
    dialect: &Dialect,
    options: WriteOptions,
    steps: &[Step],
    target: &Path,
) -> Result<Vec<Written>> {
    let header = header(args, setup, dialect);
    let files = gcode::write_files(steps, &header, dialect, options)?;
    let mut written = Vec::with_capacity(files.len());
    for (index, file) in files.into_iter().enumerate() {
        let path = match (file.suffix.as_str(), target.file_stem()) {
            ("", _) | (_, None) => target.to_path_buf(),
            (suffix, Some(stem)) => {
                let extension = target.extension().unwrap_or("nc".as_ref());
                let name = format!("{}{suffix}.{}", stem.to_string_lossy(), extension.to_string_lossy());
                target.with_file_name(name)
            }
        };
        let (findings, program) = threads::both(
            || gcode::lint(&file.text, &LintOptions { dialect, stock_top: setup.stock.top }),
            || gcode::read_as(&file.text, dialect),
        );
        let program = program.context("the program cannot be read back; please report this")?;
        let deepest = setup.operations.iter().map(|o| o.cutting.depth).fold(0.0, f64::max);
        let program = with_heights(program, dialect, setup.rig.safe_height, setup.stock.top - deepest);
        written.push(Written { index, path, text: file.text, program, findings });
    }
    Ok(written)
}

/// The settings that stand at the top of the programs.
fn header(args: &MillArgs, setup: &Setup, dialect: &Dialect) -> Vec<String> {
    let mut lines = vec![
        format!("clopen {}", env!("CARGO_PKG_VERSION")),
        format!("drawing {}", drawing_name(args)),
        format!("{DIALECT_COMMENT}{}", dialect.name),
    ];
    lines.push(HeaderStock { thickness: setup.stock.thickness, top: setup.stock.top }.to_string());
    lines
}

/// The longest name of a drawing in a program, in characters: it stays on its line, and no part of it is taken for a comment of
/// another meaning.
const LONGEST_DRAWING_NAME: usize = 40;

/// The name of the drawing as a program tells it.
fn drawing_name(args: &MillArgs) -> String {
    let name = args.input.file_name().map_or("-".into(), |n| n.to_string_lossy().into_owned());
    name.chars().take(LONGEST_DRAWING_NAME).collect()
}

/// The part of the programs that is each operation's own, behind the index of the program.
fn runs(planned: &[Planned], written: &[Written]) -> Result<Vec<(usize, Program)>> {
    let runs: Vec<(usize, Program)> =
        written.iter().flat_map(|w| split_operations(&w.program).into_iter().map(|run| (w.index, run))).collect();
    if runs.len() != planned.len() {
        return Err(anyhow!(
            "the programs have {} operations and the job {}; please report this",
            runs.len(),
            planned.len()
        ));
    }
    Ok(runs)
}

/// Every operation against the part of the programs that is its own.
fn hold_against<'a>(
    setup: &'a Setup,
    dialect: &Dialect,
    planned: Vec<Planned>,
    runs: &[(usize, Program)],
) -> Vec<Done<'a>> {
    let all = setup.operations.iter().zip(planned).zip(runs);
    all.map(|((operation, planned), (program, run))| {
        let tool = setup.tool_of(operation);
        let (top, up) = (setup.stock.top, setup.rig.safe_height);
        let run = with_heights(run.clone(), dialect, up, top - operation.cutting.depth);
        let acceleration = setup.rig.limits.acceleration;
        let path_radius = operation.cutting.path_radius_mm(acceleration[0].min(acceleration[1]));
        let width = width(operation, &planned, tool);
        let (mut check, lost) = threads::both(
            || check_operation(&run, operation, &planned, tool, &setup.stock, &setup.rig.limits),
            || lost(operation, &planned, 0.5 * width + path_radius),
        );
        if !dialect.has_depth() && check.passes[0] > 0 {
            // All passes are at one height: what counts is how often it goes around.
            check.passes[1] = laps(&run, top).min(check.passes[0]);
        }
        Done { operation, planned, check, lost, width, path_radius, run, program: *program }
    })
    .collect()
}

/// How wide the tool cuts in the plane of the shapes: a cone that breaks edges, as wide as it is there.
fn width(operation: &Operation, planned: &Planned, tool: &Tool) -> f64 {
    match (&operation.kind, &planned.keep) {
        (OperationKind::Chamfer { .. }, Some(keep)) => 2.0 * keep.distance,
        _ => tool.diameter,
    }
}

/// What the tool cannot make of the shapes, corners aside.
fn lost(operation: &Operation, planned: &Planned, radius: f64) -> Vec<LostFeature> {
    let is_whole = match operation.kind {
        OperationKind::Profile { side, .. } => side != Side::On,
        OperationKind::Pocket { .. } | OperationKind::Chamfer { .. } => true,
        _ => false,
    };
    let (Some(keep), Ok(radius)) = (planned.keep.as_ref().filter(|_| is_whole), Radius::new(radius)) else {
        return Vec::new();
    };
    let closing = match keep.remainder {
        Remainder::Inside => ReferenceOperation::Close,
        Remainder::Outside => ReferenceOperation::Open,
    };
    lost_features(&keep.part, &keep.kept, radius, closing)
}

/// The tools that a program uses.
pub(super) fn tools_of(setup: &Setup, done: &[Done], program: usize) -> Vec<Tool> {
    tools(setup, done.iter().filter(|d| d.program == program).map(|d| d.operation))
}

/// The tools of some operations.
fn tools<'a>(setup: &Setup, operations: impl Iterator<Item = &'a Operation>) -> Vec<Tool> {
    let mut tools: Vec<Tool> = Vec::new();
    for tool in operations.map(|operation| setup.tool_of(operation)) {
        if tools.iter().all(|known| known.number != tool.number) {
            tools.push(tool.clone());
        }
    }
    tools
}

fn draw(setup: &Setup, outlines: &Region, tools: &[Tool], written: &Written) -> Result<Vec<u8>> {
    let part = Some(outlines).filter(|o| !o.is_empty());
    let scene = Scene { part, tools, stock_top: setup.stock.top, ..Scene::new(&written.program) };
    preview::program(&scene, DEFAULT_SIZE).context("the picture cannot be drawn; --no-preview leaves it out")
}

/// A place in words.
pub(super) fn at(p: Point) -> String {
    format!("({:.3}, {:.3})", p.x + 0.0, p.y + 0.0)
}
