//! `clopen surface`: closing, opening and clopening of meshes, and the check of any result.

mod check;
mod choose;
mod cut;
mod digits;
mod flow;
mod offset;
mod pins;
mod repairs;
mod report;
mod touch;
mod work;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, Subcommand, ValueEnum};

use super::check::FormatArg;
use super::{ExitStatus, output};
use pins::FieldArgs;

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct SurfaceArgs {
    #[command(subcommand)]
    command: SurfaceCommand,
}

#[derive(Clone, Debug, Subcommand)]
enum SurfaceCommand {
    /// Fill what a ball cannot reach from outside: concave edges get the ball's radius, the rest stays
    Close(WorkArgs),
    /// Remove what a ball cannot reach from inside: convex edges get the ball's radius, the rest stays
    Open(WorkArgs),
    /// Close and open, one after the other
    Clopen(ClopenArgs),
    /// Cut off what lies in front of a plane, with a cap
    Cut(cut::CutArgs),
    /// Move a mesh along its normals, or make a shell of it
    Offset(offset::OffsetArgs),
    /// Measure a closed or opened mesh against the definition: contact error, containment, kept vertices, triangles
    Check(check::SurfaceCheckArgs),
}

/// The arguments of `close` and `open`.
#[derive(Clone, Debug, Args)]
struct WorkArgs {
    /// The mesh: OBJ, STL or PLY by its name; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Radius of the ball: in units of the mesh, or 2% (of the diagonal of its box)
    #[arg(short, long, value_name = "RADIUS", allow_hyphen_values = true)]
    radius: MeshLength,
    /// Where the result goes: OBJ, STL or PLY by its name; standard output, as OBJ, unless given. PLY gets a colour and a
    /// displacement for each vertex: what stays keeps the colour that it has, what moved is orange; other numbers are left out
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Roll an ellipsoid in place of the ball: its half axes along x, y and z are the radius times these numbers
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    stretch: Option<pins::Stretch>,
    /// Length of edges where the surface moves; found from the radius and the mesh unless given
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    edge_length: Option<MeshLength>,
    /// How the result is found
    #[arg(long, value_enum, default_value_t = MethodArg::Auto)]
    method: MethodArg,
    /// Mend what can be mended without a choice: faces that are duplicates or degenerate, faces oriented against their
    /// neighbours, vertices without faces
    #[arg(long)]
    repair: bool,
    /// Where a picture goes, PNG: before and after, what moved in another colour
    #[arg(long, value_name = "PICTURE")]
    preview: Option<PathBuf>,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    flow: flow::FlowArgs,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// The arguments of `clopen`.
#[derive(Clone, Debug, Args)]
struct ClopenArgs {
    #[command(flatten)]
    work: WorkArgs,
    /// Which comes first
    #[arg(long, value_enum, default_value_t = OrderArg::CloseOpen)]
    order: OrderArg,
}

/// `--order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OrderArg {
    /// Close, then open
    CloseOpen,
    /// Open, then close
    OpenClose,
}

/// `--method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum MethodArg {
    /// Direct; where that leaves something undone also flow, and of the two what the ball finds nearer to the exact result
    Auto,
    /// A ball rolls on the surface: the limit at once; what need not move stays bit for bit
    Direct,
    /// The surface flows in time at the speed of its curvature, to the same limit: slower, with states on the way
    Flow,
    /// Dilation and erosion on a grid, for comparison: nothing is kept
    Volume,
}

/// What is done to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum Step {
    Close,
    Open,
}

/// A length in units of the mesh, or in parts of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum MeshLength {
    Units(f64),
    Percent(f64),
}

impl std::str::FromStr for MeshLength {
    type Err = String;

    fn from_str(text: &str) -> Result<MeshLength, String> {
        let (number, percent) = match text.trim().strip_suffix('%') {
            Some(number) => (number, true),
            None => (text.trim(), false),
        };
        let value: f64 = number.trim().parse().map_err(|_| "write 0.05 (in units of the mesh) or 2%".to_owned())?;
        if !(value > 0.0 && value.is_finite()) {
            return Err("it must be a finite number above zero: 0.05 (in units of the mesh) or 2%".to_owned());
        }
        Ok(if percent { MeshLength::Percent(value) } else { MeshLength::Units(value) })
    }
}

impl MeshLength {
    /// The length on a mesh of this diagonal.
    fn on(self, diagonal: f64) -> f64 {
        match self {
            MeshLength::Units(x) => x,
            MeshLength::Percent(x) => 0.01 * x * diagonal,
        }
    }
}

/// Runs the command.
///
/// # Errors
/// Where a mesh cannot be read, is no surface, or the result cannot be written.
pub(super) fn run(args: &SurfaceArgs) -> Result<ExitStatus> {
    match &args.command {
        SurfaceCommand::Close(args) => args.run(&[Step::Close]),
        SurfaceCommand::Open(args) => args.run(&[Step::Open]),
        SurfaceCommand::Clopen(args) => args.work.run(match args.order {
            OrderArg::CloseOpen => &[Step::Close, Step::Open],
            OrderArg::OpenClose => &[Step::Open, Step::Close],
        }),
        SurfaceCommand::Cut(args) => cut::run(args),
        SurfaceCommand::Offset(args) => offset::run(args),
        SurfaceCommand::Check(args) => check::run(args),
    }
}

/// `out.obj` → `out-07.obj`, the seventh of up to 99.
fn numbered(target: &Path, k: usize, n: usize) -> PathBuf {
    let width = n.to_string().len().max(2);
    let stem = target.file_stem().unwrap_or_default().to_string_lossy();
    let extension = target.extension().unwrap_or_default().to_string_lossy();
    target.with_file_name(format!("{stem}-{k:0width$}.{extension}"))
}

impl WorkArgs {
    fn run(&self, steps: &[Step]) -> Result<ExitStatus> {
        let target = self.output.clone().unwrap_or_else(|| PathBuf::from("-"));
        if self.format == FormatArg::Json && target == Path::new("-") {
            bail!("--format json prints the report on standard output, where the mesh would go: add -o OUT.obj");
        }
        let names: Vec<PathBuf> = match self.flow.frames {
            Some(n) if n > 1 && target == Path::new("-") => bail!("{n} frames need a name: add -o OUT.obj"),
            Some(n @ 2..=flow::MOST_FRAMES) => (1..=n as usize).map(|k| numbered(&target, k, n as usize)).collect(),
            _ => vec![target.clone()],
        };
        let targets: Vec<&Path> = names.iter().chain(&self.preview).map(PathBuf::as_path).collect();
        output::keep_apart(&targets)?;
        for target in targets {
            output::keep_input(&self.input, target)?;
            output::keep_folder(target)?;
        }
        if let Some(preview) = &self.preview {
            output::keep_png(preview)?;
        }
        let format = work::format_of(&target)?;
        let input = work::Input::read(&self.input, self.repair)?;
        input.warnings().iter().for_each(|warning| output::say(&format!("note: {warning}\n")));
        let states = work::apply(self, &input, steps)?;
        // There is one at least: each run has a last state.
        let Some(done) = states.last() else { bail!("nothing came out") };
        // Of nothing there is no picture.
        let pictured = self.preview.as_ref().filter(|_| !done.faces.is_empty());
        let picture = pictured.map(|_| done.picture(&input)).transpose()?;
        let bytes: Vec<Vec<u8>> = states.iter().map(|state| state.write(&input, format)).collect();
        let files = names.iter().zip(&bytes).zip(&states).filter(|(_, state)| !state.faces.is_empty());
        let mut files: Vec<(&Path, &[u8])> =
            files.map(|((name, bytes), _)| (name.as_path(), bytes.as_slice())).collect();
        if let (Some(path), Some(picture)) = (&self.preview, &picture) {
            files.push((path, picture));
        }
        output::write_together(&files)?;
        let report = report::Report::new(self, &input, steps, done);
        match self.format {
            FormatArg::Text => output::say(&report.lines()),
            FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
        }
        let is_sound = !done.faces.is_empty()
            && report.conflicts.is_empty()
            && report.flow.as_ref().is_none_or(flow::Flown::is_sound);
        Ok(if is_sound { ExitStatus::Done } else { ExitStatus::CheckFailed })
    }
}
