//! `clopen surface offset IN -d DISTANCE`.

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Context as _, Result, bail};
use clap::Args;

use super::MeshLength;
use super::digits::{Places, count, number};
use super::work::{Input, format_of};
use crate::cli::check::FormatArg;
use crate::cli::{ExitStatus, output};
use crate::io::mesh::{self as files, MeshFormat};
use crate::mesh::{Point, PolygonMesh, Thickness, Vector, offset, offset_part, self_intersections};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct OffsetArgs {
    /// The mesh: OBJ, STL or PLY by its name; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// How far each face moves along its normal: in units of the mesh, or 2% (of the diagonal of its box); below zero inward
    #[arg(short, long, value_name = "DISTANCE", allow_hyphen_values = true)]
    distance: SignedLength,
    /// Where the result goes: OBJ, STL or PLY by its name; standard output, as OBJ, unless given
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Give the solid between the mesh and the moved one, with walls along borders
    #[arg(long)]
    shell: bool,
    /// Take only the faces with a corner that was moved: the mesh is a PLY that `close`, `open` or `clopen` wrote, with a
    /// displacement for each vertex
    #[arg(long)]
    only_moved: bool,
    /// Mend what can be mended without a choice, before anything is moved
    #[arg(long)]
    repair: bool,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// A length with a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SignedLength {
    length: MeshLength,
    sign: f64,
}

impl FromStr for SignedLength {
    type Err = String;

    fn from_str(text: &str) -> Result<SignedLength, String> {
        let text = text.trim();
        let (digits, sign) = text.strip_prefix('-').map_or((text, 1.0), |digits| (digits, -1.0));
        let length =
            digits.parse().map_err(|_| "write 0.05 (in units of the mesh), 2%, or -0.05 for inward".to_owned())?;
        Ok(SignedLength { length, sign })
    }
}

/// What was done.
#[derive(Clone, Debug, serde::Serialize)]
struct Report {
    distance_units: f64,
    vertices_in: usize,
    faces_in: usize,
    faces_taken: usize,
    vertices_out: usize,
    faces_out: usize,
    volume_in: f64,
    volume_out: f64,
    self_intersections_in: usize,
    self_intersections_out: usize,
    /// A corner of the first face that passes through another one.
    first_self_intersection: Option<[f64; 3]>,
    /// Faces that the distance turns over.
    faces_turned: usize,
    /// A corner of the first of them, before it is moved.
    first_turned: Option<[f64; 3]>,
    remarks: Vec<String>,
    #[serde(skip)]
    places: Places,
}

/// Runs the command.
///
/// # Errors
/// Where a mesh cannot be read, is no surface, cannot be moved, or the result cannot be written.
pub(super) fn run(args: &OffsetArgs) -> Result<ExitStatus> {
    let target = args.output.clone().unwrap_or_else(|| PathBuf::from("-"));
    if args.format == FormatArg::Json && target.as_os_str() == "-" {
        bail!("--format json prints the report on standard output, where the mesh would go: add -o OUT.obj");
    }
    output::keep_input(&args.input, &target)?;
    output::keep_folder(&target)?;
    let format = format_of(&target)?;
    let input = Input::read(&args.input, args.repair)?;
    let mesh = &input.polygons;
    let diagonal = input.triangles.diagonal();
    let is_wanted = |polygon: &[u32]| !args.only_moved || has_moved(mesh, polygon, diagonal);
    let taken = mesh.polygons().filter(|polygon| is_wanted(polygon)).count();
    if args.only_moved && input.scalar_name.as_deref() != Some(DISPLACEMENT) {
        bail!(
            "--only-moved: the mesh has no displacements: write it as PLY, clopen surface close IN -r RADIUS -o OUT.ply"
        );
    }
    if taken == 0 {
        bail!("--only-moved: no vertex of the mesh has moved");
    }
    let distance = args.distance.sign * args.distance.length.on(diagonal);
    if distance.abs() > FARTHEST * diagonal {
        bail!(
            "--distance: {} on a mesh whose box has a diagonal of {}: give one up to {}",
            number(distance),
            number(diagonal),
            number(FARTHEST * diagonal)
        );
    }
    let thickness = if args.shell { Thickness::Shell } else { Thickness::Surface };
    let moved = offset_part(mesh, distance, thickness, is_wanted).with_context(|| args.input.display().to_string())?;
    let turned = turned(mesh, distance, is_wanted)?;
    if turned.len() == taken {
        bail!(
            "{}: a distance of {} turns the whole surface inside out: it is more than the surface is thick or round there; \
             give a smaller one (the diagonal of the mesh is {})",
            args.input.display(),
            number(distance),
            number(diagonal)
        );
    }
    let triangles = moved.triangulated();
    let crossings = self_intersections(&triangles);
    output::write(&target, &files::write_named(&moved, format, input.scalar_name.as_deref()))?;
    let report = Report {
        distance_units: distance,
        vertices_in: input.polygons.points.len(),
        faces_in: input.polygons.polygon_count(),
        faces_taken: taken,
        vertices_out: moved.points.len(),
        faces_out: moved.polygon_count(),
        volume_in: input.triangles.volume(),
        volume_out: triangles.volume(),
        self_intersections_in: self_intersections(&input.triangles).len(),
        self_intersections_out: crossings.len(),
        first_self_intersection: crossings.first().map(|&(f, _)| triangles.triangle(f as usize)[0].into()),
        faces_turned: turned.len(),
        first_turned: turned.first().map(|&p| p.into()),
        places: Places::on(diagonal),
        remarks: input.all_remarks(format != MeshFormat::Stl),
    };
    match args.format {
        FormatArg::Text => output::say(&report.lines()),
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
    }
    let is_sound = report.self_intersections_out <= report.self_intersections_in && report.faces_turned == 0;
    Ok(if is_sound { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

/// What `close`, `open` and `clopen` call the numbers that they write.
const DISPLACEMENT: &str = "displacement";

/// Distances beyond this, in diagonals of the mesh, are a slip.
const FARTHEST: f64 = 1000.0;

/// A vertex has moved if its displacement is above this, in diagonals of the mesh: less is rounding, where faces were only cut.
const MOVED: f64 = 1e-6;

/// Whether a corner of a polygon has moved.
fn has_moved(mesh: &PolygonMesh, polygon: &[u32], diagonal: f64) -> bool {
    polygon.iter().any(|&v| mesh.scalars.get(v as usize).is_some_and(|d| d.abs() > MOVED * diagonal))
}

/// A corner of each polygon that the move turns over: its normal is reversed, or it is turned by half a circle in its plane, as
/// the faces of a cube are that is moved inward by more than half its side.
fn turned(mesh: &PolygonMesh, distance: f64, is_wanted: impl Fn(&[u32]) -> bool) -> Result<Vec<Point>> {
    let surface = offset(mesh, distance, Thickness::Surface)?;
    let pairs = mesh.polygons().zip(surface.polygons()).filter(|(polygon, _)| is_wanted(polygon));
    let is_turned = |&(before, after): &(&[u32], &[u32])| {
        let [old, new] = [(mesh, before), (&surface, after)].map(|(mesh, corners)| sides(mesh, corners));
        let [was, is] = [&old, &new].map(|sides| area_vector(sides));
        is.dot(&was) < 0.0 || old.iter().zip(&new).all(|(a, b)| a.dot(b) < 0.0)
    };
    Ok(pairs.filter(is_turned).map(|(before, _)| mesh.points[before[0] as usize]).collect())
}

/// The sides of a polygon as vectors.
fn sides(mesh: &PolygonMesh, corners: &[u32]) -> Vec<Vector> {
    let at = |k: usize| mesh.points[corners[k % corners.len()] as usize];
    (0..corners.len()).map(|k| at(k + 1) - at(k)).collect()
}

/// Twice the area within these sides, along the normal.
fn area_vector(sides: &[Vector]) -> Vector {
    let mut from_first = Vector::zeros();
    sides.iter().fold(Vector::zeros(), |sum, side| {
        let part = from_first.cross(side);
        from_first += side;
        sum + part
    })
}

impl Report {
    fn lines(&self) -> String {
        let mut text = format!(
            "moved by {} along the normals: {} of {} faces, now {} vertices and {} faces; volume {}\n",
            number(self.distance_units),
            self.faces_taken,
            self.faces_in,
            self.vertices_out,
            self.faces_out,
            number(self.volume_out)
        );
        if let Some(first) = self.first_self_intersection {
            text += &format!(
                "CROSSED: {} of faces pass through each other ({} before), one at {}: the surface is more curved there than the distance \
                 allows\n",
                count(self.self_intersections_out, "pair", "pairs"),
                self.self_intersections_in,
                self.places.show(first)
            );
        }
        if let Some(first) = self.first_turned {
            text += &format!(
                "TURNED: {} turned over, one from {}: the distance is more than the surface is thick or round there\n",
                count(self.faces_turned, "face is", "faces are"),
                self.places.show(first)
            );
        }
        self.remarks.iter().for_each(|remark| text += &format!("note: {remark}\n"));
        text
    }
}
