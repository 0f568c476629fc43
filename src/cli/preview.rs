//! `clopen preview FILE -o PICTURE.png`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::Args;

use super::ExitStatus;
use super::input::{self, ReadArgs};
use super::output;
use crate::cam::Tool;
use crate::gcode;
use crate::io::mesh::{self as files, MeshFormat};
use crate::preview::{self, DEFAULT_SIZE, MeshStyle, Scene};
use crate::units::Length;

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct PreviewArgs {
    /// A drawing (SVG), a mesh (OBJ, STL or PLY, by its name) or a program; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where the picture goes, PNG; beside the file unless given
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
    /// Pixels on the long side
    #[arg(long, value_name = "PIXELS", default_value_t = DEFAULT_SIZE)]
    size: u32,
    /// Diameter of the tool, for a program that does not say it
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    tool_diameter: Option<Length>,
    /// z of the top of the stock, for a program [default: as the header of a program of clopen says, else 0]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    stock_top: Option<Length>,
    #[command(flatten)]
    reading: ReadArgs,
}

/// Runs the command.
///
/// # Errors
/// Where the file cannot be read or the picture not written.
pub(super) fn run(args: &PreviewArgs) -> Result<ExitStatus> {
    if let Some(output) = &args.output {
        output::keep_png(output)?;
    }
    let bytes = input::read_bytes(&args.file)?;
    // A drawing begins with markup, whatever its name; a program never does.
    let is_svg = bytes.trim_ascii_start().first() == Some(&b'<') || bytes.starts_with(b"\xef\xbb\xbf<");
    // What comes without a name is a mesh if it looks like one.
    let format = match MeshFormat::of_path(&args.file) {
        None if args.file == Path::new("-") && !is_svg => MeshFormat::known_by(&bytes),
        by_name => by_name,
    };
    let target = args.output.clone().unwrap_or_else(|| beside(&args.file, is_svg && format.is_none()));
    output::keep_input(&args.file, &target)?;
    let picture = match format {
        Some(format) => mesh(args, &bytes, format)?,
        None if is_svg => drawing(args, &bytes)?,
        None => program(args, bytes)?,
    };
    output::write(&target, &picture)?;
    if target != Path::new("-") {
        output::say(&format!("wrote {}\n", target.display()));
    }
    Ok(ExitStatus::Done)
}

fn mesh(args: &PreviewArgs, bytes: &[u8], format: MeshFormat) -> Result<Vec<u8>> {
    let name = || args.file.display().to_string();
    let polygons = files::read(bytes, format).with_context(name)?;
    let colours = Some(polygons.colours.as_slice()).filter(|c| c.len() == polygons.points.len());
    let style = MeshStyle { colours, size: args.size, ..MeshStyle::default() };
    preview::mesh(&polygons.triangulated(), &style).with_context(name)
}

fn drawing(args: &PreviewArgs, bytes: &[u8]) -> Result<Vec<u8>> {
    let drawing = args.reading.read_from(bytes, &args.file)?;
    let (region, unit) = match drawing.mm_per_unit {
        Some(mm) => (drawing.region.scaled(mm), "mm"),
        None => (drawing.region, ""),
    };
    preview::outline(&region, None, unit, args.size).with_context(|| args.file.display().to_string())
}

fn program(args: &PreviewArgs, bytes: Vec<u8>) -> Result<Vec<u8>> {
    let text = input::into_text(bytes, &args.file)?;
    let name = || args.file.display().to_string();
    let program = gcode::read(&text).with_context(name)?;
    let stock_top = input::stock_top(args.stock_top, &text)?;
    let typed = args.tool_diameter.map(|d| input::millimetres(d, "--tool-diameter")).transpose()?;
    if let Some(diameter) = typed.filter(|d| *d <= 0.0) {
        bail!("--tool-diameter is {diameter} mm: it must be above zero");
    }
    let tool = typed.or(program.tool_diameter()).map(|diameter| Tool::flat(1, diameter));
    let scene = Scene { tools: tool.as_slice(), stock_top, ..Scene::new(&program) };
    preview::program(&scene, args.size).with_context(name)
}

/// `part.nc` → `part.png`, and `part.svg` → `part.svg.png`, which is no picture of a program; in the current folder for
/// standard input.
fn beside(file: &Path, is_svg: bool) -> PathBuf {
    match file {
        _ if file == Path::new("-") => PathBuf::from("preview.png"),
        _ if is_svg => file.with_extension("svg.png"),
        _ => file.with_extension("png"),
    }
}
