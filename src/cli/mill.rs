//! `clopen mill`: outlines to a program that was read back and checked before anyone is told that it is there.

mod args;
mod differences;
mod drawn;
mod init;
mod job_order;
mod notice_words;
mod page;
mod saved;
mod select;
mod setup;
mod setup_page;
mod setup_report;
mod setup_saved;
mod stock_edges;
mod travel;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, anyhow, bail};

use super::check::FormatArg;
use super::engaged::{laps, with_heights};
use super::report::{MillReport, Verdict, gouges};
use super::{ExitStatus, input, output};
use crate::cam::{
    self, Certificate, CertifyOptions, ClosedForPath, Entry, Job, JobFile, Machine, OffsetError, PathRadius, PlanError,
    Program, Remainder, SetupFile, Side, Tool, Toolpath,
};
use crate::check::{LostFeature, lost_features};
use crate::gcode::{self, Arcs, DIALECT_COMMENT, Dialect, Finding, LintOptions, MachineKind, Units, WriteOptions};
use crate::io::svg::Drawing;
use crate::plane::Region;
use crate::preview::{self, DEFAULT_SIZE, Scene};
use crate::reference::Operation;
use crate::rolling::Topology;
use crate::threads;
use crate::units::{Length, Radius};
pub(super) use args::MillArgs;
use notice_words::MOST_ALIKE;

/// What the flags and the job file say together.
struct Settings {
    job: Job,
    topology: Topology,
    dialect: Dialect,
    options: WriteOptions,
}

/// The work as far as the geometry goes, in millimetres and in the machine's coordinates.
struct Plan {
    part: Region,
    /// The intended boundary of what remains, with the drawing's solid on its left.
    kept: Region,
    toolpath: Toolpath,
    lost: Vec<LostFeature>,
    contradictions: usize,
    /// Outlines with a smaller path radius, and the smallest.
    eased: Option<(usize, f64)>,
}

/// What stays, closed, and the way around it.
struct Shape {
    closed: ClosedForPath,
    toolpath: Toolpath,
}

/// The program, and what it was found to do.
struct Checked {
    text: String,
    program: Program,
    findings: Vec<Finding>,
    certificate: Certificate,
}

/// Runs the command.
///
/// # Errors
/// Where the drawing or the job makes no sense, or a file cannot be written.
pub(super) fn run(args: &MillArgs) -> Result<ExitStatus> {
    if args.init {
        return init::run(args);
    }
    if let Some(job) = &args.job {
        let text = input::read_text(job)?;
        if text.trim().is_empty() {
            bail!("{}: the file is empty: `clopen mill --init {}` prints one", job.display(), args.input.display());
        }
        if SetupFile::is_meant(&text) {
            return setup::run(args, job, &text);
        }
    }
    let name = args.input.display();
    let target = target(args);
    output::keep_file(&target)?;
    let picture = (!args.no_preview && target != Path::new("-")).then(|| target.with_extension("png"));
    output::keep_input(&args.input, &target)?;
    if let Some(picture) = &picture {
        if *picture == target {
            bail!(
                "{}: program and picture would be one file: name the program .nc, or add --no-preview",
                target.display()
            );
        }
        output::keep_input(&args.input, picture)?;
    }
    keep_page(args)?;
    let drawing = args.reading.read(&args.input)?;
    let Some(mm_per_unit) = drawing.mm_per_unit else {
        bail!(
            "{name}: the drawing has no physical size: say how many of its units make an inch (--dpi 96) or how wide \
             the part is (--width 100mm)"
        );
    };
    if let Some(note) = args.reading.scale_note(&drawing.page) {
        output::say(&format!("clopen: {name}: {note}\n"));
    }
    let settings = read_settings(args, &drawing, &target)?;
    let job = &settings.job;
    let part = drawing.region.scaled(mm_per_unit);
    let ((covered, plan), sharp) = threads::both(
        || (args.reading.covered(&args.input), make_plan(&settings, &part)),
        || saved::sharp_path(&settings, &part),
    );
    let told = if covered.len() > MOST_ALIKE + 1 { MOST_ALIKE } else { covered.len() };
    for p in &covered[..told] {
        output::say(&format!(
            "clopen: {name}: the shape around ({:.3}, {:.3}) of the drawing, y up, lies wholly on another one and changes nothing: a hole is \
             drawn as part of the same path, with fill-rule=\"evenodd\"\n",
            p.x, p.y
        ));
    }
    if told < covered.len() {
        output::say(&format!("clopen: {name}: the same of {} more shapes\n", covered.len() - told));
    }
    let mut plan = plan.with_context(|| name.to_string())?;
    let (checked, lost) = threads::both(|| check(args, &settings, &plan), || lost(job, &plan));
    let checked = checked?;
    plan.lost = lost?;
    let is_drawn = picture.is_some() || (args.html.is_some() && !args.no_preview);
    let (drawn, saved) = threads::both(
        || is_drawn.then(|| draw(job, &plan, &checked)).transpose(),
        || sharp.map(|sharp| sharp.saves(job, &plan, &checked.program)),
    );
    let drawn = drawn?;

    let gouges = gouges(checked.certificate.gouge.as_ref());
    let mut contents = Vec::new();
    if !gouges {
        contents.push((target.clone(), checked.text.clone().into_bytes()));
    }
    contents.extend(picture.zip(drawn.clone()));
    let mut written: Vec<PathBuf> = contents.iter().map(|(path, _)| path.clone()).collect();
    written.extend(args.html.clone());
    let report = MillReport {
        input: &args.input,
        job,
        dialect: &settings.dialect.name,
        options: settings.options,
        part: &plan.part,
        certificate: &checked.certificate,
        lost: &plan.lost,
        findings: &checked.findings,
        contradictions: plan.contradictions,
        eased: plan.eased,
        covered: covered.len(),
        accept_losses: args.accept_losses,
        saved: saved.as_ref(),
        written: &written,
        withheld: Some(target.as_path()).filter(|_| gouges),
    };
    if let Some(html) = &args.html {
        let name = if target == Path::new("-") { "program".to_owned() } else { page::file_name(&target) };
        let page = page::page(&report, &settings, &plan, &checked, name, drawn);
        contents.push((html.clone(), page.into_bytes()));
    }
    output::write_together(
        &contents.iter().map(|(path, bytes)| (path.as_path(), bytes.as_slice())).collect::<Vec<_>>(),
    )?;
    let text = match args.format {
        FormatArg::Text => report.text(),
        FormatArg::Json => report.json()?,
    };
    // Where the program itself is on standard output, the certificate must not be.
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

/// What a beam takes, and a pen draws, where nobody says: those of hobby machines.
const LASER_KERF: Length = Length::Millimetres(0.2);
const PEN_WIDTH: Length = Length::Millimetres(0.5);

/// The power for passes of some thickness, of a beam whose full one cuts `depth_per_pass`: in proportion, in whole steps.
fn laser_power(full: f64, pass: f64, depth_per_pass: f64) -> f64 {
    (full * (pass / depth_per_pass).min(1.0)).round().max(1.0)
}

/// How much deeper a beam gets with every lap.
const LAP_DEPTH: Length = Length::Millimetres(1.0);

/// Full power, as S counts it where the controller has not been told otherwise (GRBL's $30).
const LASER_POWER: f64 = 1000.0;

fn read_settings(args: &MillArgs, drawing: &Drawing, target: &Path) -> Result<Settings> {
    let mut typed = args.typed();
    if let Some(path) = &args.job {
        let file: JobFile = input::read_text(path)?.parse().with_context(|| path.display().to_string())?;
        typed = typed.over(file);
    }
    let asked = typed.dialect.as_deref().unwrap_or("grbl");
    let dialect = input::dialect(asked)?;
    if let Some(file) = input::dialect_file(asked) {
        for result in
            [Some(target.to_path_buf()), Some(target.with_extension("png")), args.html.clone()].iter().flatten()
        {
            output::keep_input(&file, result)?;
        }
    }
    if !dialect.has_depth() {
        // Nothing goes down: on a ramp the beam would go around several times in one pass.
        typed.entry = Some(Entry::Plunge);
    }
    match dialect.machine {
        MachineKind::Router => {}
        MachineKind::Laser => {
            typed.tool_diameter.get_or_insert(LASER_KERF);
            typed.spindle_speed.get_or_insert(LASER_POWER);
            typed.depth_per_pass.get_or_insert(LAP_DEPTH);
        }
        MachineKind::Pen => {
            typed.tool_diameter.get_or_insert(PEN_WIDTH);
        }
    }
    let mut job = typed.resolve(&drawing.scale())?;
    if dialect.machine == MachineKind::Laser {
        let pass = job.depth / job.pass_heights().len() as f64;
        job.spindle_speed = laser_power(job.spindle_speed, pass, job.depth_per_pass);
    }
    Ok(Settings {
        job,
        topology: typed.topology.unwrap_or(Topology::Merge),
        dialect,
        options: WriteOptions {
            units: if typed.inches == Some(true) { Units::Inches } else { Units::Millimetres },
            arcs: if typed.no_arcs == Some(true) { Arcs::Lines } else { Arcs::Arcs },
        },
    })
}

/// A part larger than this, in millimetres, is a slip of the unit: beyond it micrometres are lost in rounding.
const LARGEST_PART: f64 = 1e7;

/// Closes what stays by the tool, and plans the way around it.
fn make_plan(settings: &Settings, part: &Region) -> Result<Plan> {
    let job = &settings.job;
    let size = part.bounds().diagonal();
    if size > LARGEST_PART {
        bail!(
            "the part is {size:.1e} mm across, more than {LARGEST_PART:.0e}: is its width or the scale of the drawing right?"
        );
    }
    if job.tool_diameter > size {
        bail!(
            "the tool of {} mm is larger than the whole part ({} mm across): is the unit of --tool-diameter right, \
             and the scale of the drawing?",
            job.tool_diameter,
            if size < 0.1 { format!("{size:.1e}") } else { format!("{size:.1}") }
        );
    }
    let Shape { closed, toolpath } = shape(settings, part)?;
    let ClosedForPath { region: closed, contradictions, eased } = closed;
    // From here on in the machine's coordinates, which are those of the certificate and of the picture.
    let part = part.translated(toolpath.translation);
    let kept = match job.side {
        Side::Outside | Side::On => closed,
        Side::Inside => closed.reversed(),
    }
    .translated(toolpath.translation);
    Ok(Plan { part, kept, toolpath, lost: Vec::new(), contradictions, eased })
}

/// What the closing by the tool and the path radius takes of the part.
fn lost(job: &Job, plan: &Plan) -> Result<Vec<LostFeature>> {
    let radius = job.closing_radius();
    if radius <= 0.0 {
        return Ok(Vec::new());
    }
    // Seen from the drawing: inside, it is the tool's pocket that is opened.
    let operation = match job.side {
        Side::Outside | Side::On => Operation::Close,
        Side::Inside => Operation::Open,
    };
    Ok(lost_features(&plan.part, &plan.kept, Radius::new(radius)?, operation))
}

/// What stays, closed by the tool and the path radius, and the way around it.
fn shape(settings: &Settings, part: &Region) -> Result<Shape> {
    let job = &settings.job;
    let stays = job.side.kept_material(part);
    let eases = job.path_radius == PathRadius::Auto;
    let closed = cam::close_for_path(&stays, job.offset_distance(), job.path_radius_mm(), eases, settings.topology);
    let toolpath = cam::plan(job, part, &closed.region).map_err(|error| match (error, settings.topology) {
        (PlanError::Offset(OffsetError::NoRoom { at }), Topology::Keep) => anyhow!(
            "the tool does not fit between parts of the outline at ({:.4}, {:.4}) of the drawing, y down, in millimetres: \
             try --topology merge, which fills such places, or a smaller tool",
            at.x,
            0.0 - at.y
        ),
        (error, _) => error.into(),
    })?;
    Ok(Shape { closed, toolpath })
}

/// Writes the program, and from here on believes only what it says.
fn check(args: &MillArgs, settings: &Settings, plan: &Plan) -> Result<Checked> {
    let Settings { job, dialect, options, .. } = settings;
    let header = header(args, settings, plan);
    let text = gcode::write(&plan.toolpath, &header, dialect, *options)?;
    let (findings, program) = threads::both(
        || gcode::lint(&text, &LintOptions { dialect, stock_top: job.stock_top }),
        || gcode::read_as(&text, dialect),
    );
    let program = program.context("the program cannot be read back; please report this")?;
    let program = with_heights(program, dialect, job.safe_height, job.stock_top - job.depth);
    let machine = machine(job);
    let remainder = match job.side {
        Side::Outside | Side::On => Remainder::Inside,
        Side::Inside => Remainder::Outside,
    };
    let mut certificate = cam::certify(
        &program,
        &plan.part,
        &plan.kept,
        &CertifyOptions {
            remainder,
            stock_top: job.stock_top,
            floor: Some(job.stock_top - job.depth),
            machine,
            ..CertifyOptions::new(job.offset_distance())
        },
    );
    if !dialect.has_depth() {
        // All passes are at one height: what counts is how often it goes around.
        certificate.statistics.passes = laps(&program, job.stock_top);
    }
    if options.arcs == Arcs::Lines {
        // Between lines every joint is a corner: what counts is the path that they stand for.
        let round = WriteOptions { arcs: Arcs::Arcs, ..*options };
        let round = gcode::read_as(&gcode::write(&plan.toolpath, &header, dialect, round)?, dialect);
        let round = round.context("the path cannot be read back; please report this")?;
        let round = with_heights(round, dialect, job.safe_height, job.stock_top - job.depth);
        certificate.path_radius = cam::tightest_turns(&round, &plan.kept, remainder, job.stock_top);
    }
    Ok(Checked { text, program, findings, certificate })
}

fn machine(job: &Job) -> Machine {
    Machine { acceleration: [job.acceleration; 3], ..Machine::default() }
}

/// The settings that stand at the top of the program.
fn header(args: &MillArgs, settings: &Settings, plan: &Plan) -> Vec<String> {
    let job = &settings.job;
    let bounds = plan.part.bounds();
    let mut lines = vec![
        format!("clopen {}", env!("CARGO_PKG_VERSION")),
        format!("drawing {}", args.input.file_name().map_or("-".into(), |n| n.to_string_lossy().into_owned())),
        format!("part {:.3} x {:.3} mm", bounds.width(), bounds.height()),
    ];
    lines.push(format!("{DIALECT_COMMENT}{}", settings.dialect.name));
    lines.extend(job.summary());
    lines.push(format!("closing radius {:.4} mm", job.closing_radius()));
    lines
}

fn draw(job: &Job, plan: &Plan, checked: &Checked) -> Result<Vec<u8>> {
    let scene = Scene {
        program: &checked.program,
        part: Some(&plan.part),
        kept: Some(&plan.kept),
        uncut: Some(&checked.certificate.uncut),
        tools: &[Tool::flat(1, job.tool_diameter)],
        stock_top: job.stock_top,
    };
    preview::program(&scene, DEFAULT_SIZE).context("the picture cannot be drawn; --no-preview leaves it out")
}

/// Refuses a page in place of what is read, and one on standard output, where the certificate goes.
fn keep_page(args: &MillArgs) -> Result<()> {
    let Some(html) = &args.html else { return Ok(()) };
    if html == Path::new("-") {
        bail!("the page cannot go to standard output, where the certificate goes: name a file, --html part.html");
    }
    for input in [Some(&args.input), args.job.as_ref()].into_iter().flatten() {
        output::keep_input(input, html)?;
    }
    Ok(())
}

fn target(args: &MillArgs) -> PathBuf {
    if let Some(target) = &args.output {
        return target.clone();
    }
    let stem = args.input.file_stem().filter(|_| args.input != Path::new("-"));
    Path::new(stem.unwrap_or("part".as_ref())).with_extension("nc")
}
