//! `clopen surface cut IN --plane X,Y,Z,NX,NY,NZ`.

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Context as _, Result, bail};
use clap::Args;

use super::digits::{count, number};
use super::pins::numbers;
use super::work::{Input, format_of};
use crate::cli::check::FormatArg;
use crate::cli::{ExitStatus, output};
use crate::io::mesh::{self as files, MeshFormat};
use crate::mesh::{Cap, CutPlane, NONE, Point, Vector, cut};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct CutArgs {
    /// The mesh: OBJ, STL or PLY by its name; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// A point of the plane and its normal: what the normal points to is cut off, and what is behind the plane is kept, so that
    /// the normal is that of the new face. 0,0,1,0,0,1 keeps what is below z = 1
    #[arg(long, value_name = "X,Y,Z,NX,NY,NZ", allow_hyphen_values = true)]
    plane: PlaneArg,
    /// Where the result goes: OBJ, STL or PLY by its name; standard output, as OBJ, unless given
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Leave the mesh open where it is cut, in place of a cap in the plane
    #[arg(long)]
    open: bool,
    /// Mend what can be mended without a choice, before anything is cut
    #[arg(long)]
    repair: bool,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// `--plane`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlaneArg(CutPlane);

impl FromStr for PlaneArg {
    type Err = String;

    fn from_str(text: &str) -> Result<PlaneArg, String> {
        let [x, y, z, nx, ny, nz] = numbers::<6>(text)
            .ok_or_else(|| "write a point and a normal, for example 0,0,1,0,0,1 for what is below z = 1".to_owned())?;
        let plane = CutPlane::new(Point::new(x, y, z), Vector::new(nx, ny, nz));
        plane.map(PlaneArg).map_err(|error| error.to_string())
    }
}

/// What was done.
#[derive(Clone, Debug, serde::Serialize)]
struct Report {
    vertices_in: usize,
    vertices_kept: usize,
    vertices_out: usize,
    faces_in: usize,
    faces_kept: usize,
    faces_out: usize,
    cap_triangles: usize,
    /// Pieces of the cut that end at borders of the input and got no cap.
    open_ends: usize,
    volume_in: f64,
    volume_out: f64,
    remarks: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// Where a mesh cannot be read, is no surface, cannot be cut, or the result cannot be written.
pub(super) fn run(args: &CutArgs) -> Result<ExitStatus> {
    let target = args.output.clone().unwrap_or_else(|| PathBuf::from("-"));
    let is_stream = target.as_os_str() == "-";
    if args.format == FormatArg::Json && is_stream {
        bail!("--format json prints the report on standard output, where the mesh would go: add -o OUT.obj");
    }
    output::keep_input(&args.input, &target)?;
    output::keep_folder(&target)?;
    let format = format_of(&target)?;
    let input = Input::read(&args.input, args.repair)?;
    let cap = if args.open { Cap::Open } else { Cap::Closed };
    let left = cut(&input.polygons, &args.plane.0, cap)
        .with_context(|| format!("{} ({})", args.input.display(), input.extent()))?;
    output::write(&target, &files::write_named(&left.mesh, format, input.scalar_name.as_deref()))?;
    let report = Report {
        vertices_in: input.polygons.points.len(),
        vertices_kept: left.origins.iter().filter(|&&v| v != NONE).count(),
        vertices_out: left.mesh.points.len(),
        faces_in: input.polygons.polygon_count(),
        faces_kept: left.kept,
        faces_out: left.mesh.polygon_count(),
        cap_triangles: left.caps,
        open_ends: left.open_ends,
        volume_in: input.triangles.volume(),
        volume_out: left.mesh.triangulated().volume(),
        remarks: input.all_remarks(format != MeshFormat::Stl),
    };
    match args.format {
        FormatArg::Text => output::say(&report.lines(args.open)),
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
    }
    Ok(ExitStatus::Done)
}

impl Report {
    fn lines(&self, is_open: bool) -> String {
        let mut text = format!(
            "cut: {} of {} vertices and {} of {} faces kept bit for bit, now {} and {}\n",
            self.vertices_kept, self.vertices_in, self.faces_kept, self.faces_in, self.vertices_out, self.faces_out
        );
        text += &match self.cap_triangles {
            _ if self.faces_kept == self.faces_in => "note: the plane cuts nothing off\n".to_owned(),
            0 if is_open => "left open where it was cut\n".to_owned(),
            n => format!(
                "{} it; volume {} of {}\n",
                count(n, "triangle in the plane closes", "triangles in the plane close"),
                number(self.volume_out),
                number(self.volume_in)
            ),
        };
        if self.open_ends > 0 {
            let pieces = count(self.open_ends, "piece of the cut ends", "pieces of the cut end");
            text += &format!("note: {pieces} at borders of the mesh and got no cap\n");
        }
        self.remarks.iter().for_each(|remark| text += &format!("note: {remark}\n"));
        text
    }
}
