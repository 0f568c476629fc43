//! A mesh read and looked at, worked on, and written with what did not change as it was.

use std::path::Path;

use anyhow::{Context as _, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};

use super::digits::number;
use super::{MethodArg, Step, WorkArgs, repairs};
use crate::cli::input;
use crate::io::mesh::{self as files, MeshFormat};
use crate::mesh::{
    MOST_INTERSECTIONS, NONE, Point, PolygonMesh, Problem, Repair, Severity, TriangleMesh, problems, repair,
};
use crate::preview::{self, MeshStyle};
use crate::reference::volumetric_close;
use crate::rolling::{ClosedSurface, Conflict};

/// Edges are to be so many radii long: a fillet of a right angle gets ten.
const EDGE: f64 = 1.0 / 6.0;

/// They are no shorter than this part of the radius, however fine the mesh.
const FINEST_EDGE: f64 = 1.0 / 30.0;

/// Edges are no longer than this, in diagonals of the mesh, unless they are asked for: with a ball much larger than the mesh, whose
/// closing is nearly the convex hull, parts of the radius would be.
const LONGEST_EDGE: f64 = 1.0 / 40.0;

/// Radii from the smallest to the largest of these, in diagonals of the mesh, make sense. Beyond the largest the closing is the
/// convex hull but for a thousandth of the diagonal.
const RADII: [f64; 2] = [1e-5, 100.0];

/// Beyond these, in units of the mesh, products of lengths leave the range of numbers.
const DIAGONALS: [f64; 2] = [1e-50, 1e50];

/// Edges shorter than this, in diagonals, would make more triangles than a machine can hold.
const SHORTEST_EDGE: f64 = 1e-5;

/// Edges shorter than this part of the largest coordinate are lost in its rounding.
const STEPS: f64 = 1e-12;

/// So many problems are named.
const NAMED: usize = 5;

/// Colours of what moved and what stayed, in PLY files.
const MOVED: [u8; 3] = [232, 119, 34];
const STAYED: [u8; 3] = [200, 204, 209];

/// A mesh as it was read.
pub(super) struct Input {
    pub polygons: PolygonMesh,
    pub triangles: TriangleMesh,
    pub allowed: Vec<Problem>,
    pub repairs: Vec<Repair>,
    /// What the file calls the numbers at its vertices, if it has some.
    pub scalar_name: Option<String>,
    /// What the file says that no result has.
    left_out: Vec<&'static str>,
}

/// The format of a file that is to be written.
pub(super) fn format_of(path: &Path) -> Result<MeshFormat> {
    if path == Path::new("-") {
        return Ok(MeshFormat::Obj);
    }
    match MeshFormat::of_path(path) {
        Some(format) => Ok(format),
        None => bail!("{}: the name says no format: write .obj, .stl or .ply", path.display()),
    }
}

/// The polygons in a file.
pub(super) fn read_polygons(path: &Path) -> Result<PolygonMesh> {
    Ok(read_file(path)?.polygons)
}

/// What is in a file.
struct File {
    polygons: PolygonMesh,
    /// What it calls the numbers at the vertices.
    scalar_name: Option<String>,
    left_out: Vec<&'static str>,
}

fn read_file(path: &Path) -> Result<File> {
    let bytes = input::read_bytes(path)?;
    let format = MeshFormat::of_path(path).unwrap_or_else(|| MeshFormat::of_bytes(&bytes));
    let polygons = files::read(&bytes, format).with_context(|| path.display().to_string())?;
    Ok(File { polygons, scalar_name: files::scalar_name(&bytes, format), left_out: files::left_out(&bytes, format) })
}

/// Refuses meshes of a size that lengths on it cannot be reckoned with.
pub(super) fn keep_size(path: &Path, diagonal: f64) -> Result<()> {
    if (DIAGONALS[0]..=DIAGONALS[1]).contains(&diagonal) {
        return Ok(());
    }
    bail!(
        "{}: the diagonal of its box is {diagonal:e}: give it other units, so that it is from {:e} to {:e}",
        path.display(),
        DIAGONALS[0],
        DIAGONALS[1]
    )
}

/// Refuses radii that make no sense on a mesh of this diagonal.
pub(super) fn keep_radius(path: &Path, radius: f64, diagonal: f64) -> Result<()> {
    if (RADII[0] * diagonal..=RADII[1] * diagonal).contains(&radius) {
        return Ok(());
    }
    bail!(
        "{}: a radius of {} on a mesh whose box has a diagonal of {}: give one from {:.3e} to {:.3e}, for example 2%",
        path.display(),
        number(radius),
        number(diagonal),
        RADII[0] * diagonal,
        RADII[1] * diagonal
    )
}

/// Refuses `--edge-length` where it is longer than the radius, or makes more triangles than can be held.
pub(super) fn keep_edge(edge: f64, radius: f64, diagonal: f64) -> Result<()> {
    let shortest = SHORTEST_EDGE * diagonal;
    if (shortest..=radius).contains(&edge) {
        return Ok(());
    }
    bail!(
        "--edge-length {}: an edge length must be at most the radius ({}) and at least {shortest:.3e}",
        number(edge),
        number(radius)
    )
}

/// The longest edges on a mesh of this diagonal, unless they are asked for.
pub(super) fn longest_edge(diagonal: f64) -> f64 {
    LONGEST_EDGE * diagonal
}

impl Input {
    /// Reads a mesh and looks at it.
    ///
    /// # Errors
    /// Where the file cannot be read, or the mesh is no surface with an inside.
    pub fn read(path: &Path, mend: bool) -> Result<Input> {
        let File { mut polygons, scalar_name, left_out } = read_file(path)?;
        let mut repairs = Vec::new();
        if mend {
            (polygons, repairs) = repair(polygons);
        }
        let triangles = polygons.triangulated();
        // Before all else: where products of lengths are no numbers, nothing that is found is true.
        if !triangles.faces.is_empty() {
            keep_size(path, triangles.diagonal())?;
        }
        let found = problems(&polygons);
        let refused: Vec<&Problem> = found
            .iter()
            .filter(|p| match p.severity() {
                Severity::Refused => true,
                // A vertex without faces hurts nobody.
                Severity::Repairable => !matches!(p, Problem::Unused { .. }),
                Severity::Allowed => false,
            })
            .collect();
        if let Some(first) = refused.first() {
            let more = match refused.len() - 1 {
                0 => String::new(),
                n => format!(" (and {n} more such problems)"),
            };
            let hint = if first.severity() == Severity::Repairable { "; --repair mends that" } else { "" };
            bail!("{}: {first}{hint}{more}", path.display());
        }
        let allowed = found.iter().filter(|p| p.severity() == Severity::Allowed).copied().collect();
        Ok(Input { polygons, triangles, allowed, repairs, scalar_name, left_out })
    }

    /// Where the mesh is, in words.
    pub fn extent(&self) -> String {
        let [low, high] = self.triangles.bounds().unwrap_or([Point::origin(); 2]);
        format!("it reaches from ({}, {}, {}) to ({}, {}, {})", low.x, low.y, low.z, high.x, high.y, high.z)
    }

    /// What may make all the work pointless, in words: it is said before that begins.
    pub fn warnings(&self) -> Vec<String> {
        let is_coincident = |p: &&Problem| matches!(p, Problem::Coincident { .. });
        let coincident: Vec<&Problem> = self.allowed.iter().filter(is_coincident).collect();
        let mut warnings = Vec::new();
        if let Some(first) = coincident.first() {
            warnings.push(match coincident.len() {
                1 => first.to_string(),
                n => format!("{first} ({n} such pairs in all)"),
            });
        }
        let unwelded = self.allowed.iter().filter(|p| matches!(p, Problem::Unwelded { .. }));
        warnings.extend(unwelded.map(Problem::to_string));
        warnings
    }

    /// What of the file is not in a result of this format, in words; whether such a result has the colours of the vertices.
    pub fn left_out(&self, has_colours: bool) -> Option<String> {
        let mut left_out = self.left_out.clone();
        if !self.polygons.colours.is_empty() && !has_colours {
            left_out.push("colours of vertices (PLY has them)");
        }
        (!left_out.is_empty()).then(|| format!("not in the result: {}", left_out.join(", ")))
    }

    /// All that is worth saying of a mesh of which a part is cut or moved; whether the result has the colours of its vertices.
    pub fn all_remarks(&self, has_colours: bool) -> Vec<String> {
        self.warnings().into_iter().chain(self.remarks(false)).chain(self.left_out(has_colours)).collect()
    }

    /// What is allowed and worth saying besides; whether borders stay where they are, as where a ball rolls.
    pub fn remarks(&self, are_borders_pinned: bool) -> Vec<String> {
        let words = |problem: &Problem| match problem {
            Problem::Boundary { vertex, edges } if !are_borders_pinned => {
                format!("the surface has a boundary of {edges} edges at vertex {vertex}")
            }
            other => other.to_string(),
        };
        let mut remarks: Vec<String> = repairs::words(&self.repairs).into_iter().collect();
        let is_warned_of = |p: &&Problem| matches!(p, Problem::Coincident { .. } | Problem::Unwelded { .. });
        let others: Vec<&Problem> = self.allowed.iter().filter(|p| !is_warned_of(p)).collect();
        remarks.extend(others.iter().take(NAMED).map(|p| words(p)));
        let crossings = self.allowed.iter().filter(|p| matches!(p, Problem::SelfIntersection { .. })).count();
        if crossings > 0 {
            let more = if crossings >= MOST_INTERSECTIONS { " or more" } else { "" };
            remarks.push(format!(
                "{crossings} pairs of faces{more} pass through each other in all: if these are bodies that overlap, unite them first; what is \
                 inside of another body is not the outside of the whole"
            ));
        } else if others.len() > NAMED {
            remarks.push(format!("{} such remarks in all", others.len()));
        }
        remarks
    }
}

/// What came out.
pub(super) struct Done {
    /// Vertices, and which of the input's each is, or none.
    pub points: Vec<Point>,
    pub origins: Vec<u32>,
    /// Faces, and which of the input's triangles each is, or none.
    pub faces: Vec<[u32; 3]>,
    pub parents: Vec<u32>,
    pub conflicts: Vec<Conflict>,
    /// The largest distance from the exact result that was seen, where it was looked for.
    pub error: Option<f64>,
    pub edge: f64,
    /// The radius that was asked for, and from where to where it goes.
    pub radius: f64,
    pub radii: [f64; 2],
    /// Which method each step took, and why.
    pub choices: Vec<super::choose::Choice>,
    /// How the flow went, if it was one.
    pub flown: Option<super::flow::Flown>,
}

/// Does the steps, one after the other; the states on the way of a flow that was asked for them, and the last one.
pub(super) fn apply(args: &WorkArgs, input: &Input, steps: &[Step]) -> Result<Vec<Done>> {
    if let Some(option) = args.flow.first_given().filter(|_| args.method != MethodArg::Flow) {
        bail!("{option} means something to a flow only: add --method flow");
    }
    let diagonal = input.triangles.diagonal();
    let radius = args.radius.on(diagonal);
    let mut field = args.field.resolve(input, radius)?;
    let stretch = args.stretch.map_or([1.0; 3], |s| s.0);
    if stretch != [1.0; 3] {
        field = field.stretched(stretch);
        if !matches!(args.method, MethodArg::Auto | MethodArg::Direct) {
            bail!("--stretch: only --method auto and direct roll an ellipsoid");
        }
    }
    if field.facing.is_some() && args.method != MethodArg::Flow {
        bail!(
            "--radius-facing: a ball has no direction, only the flow can tell where the surface faces: add --method flow"
        );
    }
    for r in [field.smallest, field.largest] {
        keep_radius(&args.input, r, diagonal)?;
    }
    let edge = match args.edge_length {
        Some(edge) => edge.on(diagonal),
        None => (EDGE * field.smallest)
            .min(input.triangles.mean_edge().max(FINEST_EDGE * field.smallest))
            .min(longest_edge(diagonal)),
    };
    let shortest = SHORTEST_EDGE * diagonal;
    if args.edge_length.is_none() && edge < shortest {
        let least = shortest / if input.triangles.mean_edge() < shortest { FINEST_EDGE } else { EDGE };
        bail!(
            "{}: a radius of {} is too small for a mesh whose box has a diagonal of {}: its fillets would have more triangles than \
             can be held; give {least:.3e} or more",
            args.input.display(),
            number(field.smallest),
            number(diagonal)
        );
    }
    keep_edge(edge, field.smallest, diagonal)?;
    let [low, high] = input.triangles.bounds().unwrap_or([Point::origin(); 2]);
    let far = low.coords.amax().max(high.coords.amax());
    if edge < STEPS * far {
        bail!(
            "{}: coordinates as large as {far:.3e} are rounded too coarsely for an edge length of {}; move the mesh nearer to the origin",
            args.input.display(),
            number(edge)
        );
    }
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
        bar.set_style(style);
    }
    let mut done = Done {
        points: input.triangles.points.clone(),
        origins: (0..input.triangles.points.len() as u32).collect(),
        faces: input.triangles.faces.clone(),
        parents: (0..input.triangles.faces.len() as u32).collect(),
        conflicts: Vec::new(),
        error: None,
        edge,
        radius,
        radii: [field.smallest, field.largest],
        choices: Vec::new(),
        flown: None,
    };
    bar.enable_steady_tick(std::time::Duration::from_millis(100));
    if args.method == MethodArg::Flow {
        let states = super::flow::run(args, input, steps, &field, radius, edge, &bar);
        bar.finish_and_clear();
        return states;
    }
    for step in steps {
        if done.faces.is_empty() {
            break;
        }
        bar.set_message(match step {
            Step::Close => "closing",
            Step::Open => "opening",
        });
        let squeezed = done.points.iter().map(|p| scaled(*p, stretch.map(|s| 1.0 / s))).collect();
        let mut mesh = TriangleMesh::new(squeezed, done.faces.clone());
        if *step == Step::Open {
            mesh = mesh.reversed();
        }
        let mut next = match args.method {
            MethodArg::Auto | MethodArg::Direct => {
                let chosen = super::choose::close(args.method, &mesh, &field, edge, &bar)?;
                done.choices.push(chosen.choice);
                chosen.surface
            }
            // It has been seen to above.
            MethodArg::Flow | MethodArg::Volume => {
                let closed = volumetric_close(&mesh, radius, edge).context("--method volume")?;
                ClosedSurface {
                    origins: vec![NONE; closed.points.len()],
                    parents: vec![NONE; closed.faces.len()],
                    points: closed.points,
                    faces: closed.faces,
                    ..ClosedSurface::default()
                }
            }
        };
        if *step == Step::Open {
            next.faces.iter_mut().for_each(|f| f.swap(1, 2));
        }
        // What did not move has the bits that it had before it was squeezed.
        for (p, &origin) in next.points.iter_mut().zip(&next.origins) {
            *p = if origin == NONE { scaled(*p, stretch) } else { done.points[origin as usize] };
        }
        // Faces that did not change are those of the input, corner by corner.
        let through = |of: &[u32], k: u32| if k == NONE { NONE } else { of[k as usize] };
        done = Done {
            origins: next.origins.iter().map(|&k| through(&done.origins, k)).collect(),
            parents: next.parents.iter().map(|&k| through(&done.parents, k)).collect(),
            points: next.points,
            faces: next.faces,
            conflicts: [done.conflicts, next.conflicts].concat(),
            error: (args.method != MethodArg::Volume).then(|| done.error.unwrap_or(0.0).max(next.error)),
            ..done
        };
    }
    bar.finish_and_clear();
    Ok(vec![done])
}

/// A point with each coordinate times a number.
pub(super) fn scaled(p: Point, by: [f64; 3]) -> Point {
    Point::new(p.x * by[0], p.y * by[1], p.z * by[2])
}

impl Done {
    /// Whether each face has moved or is new.
    fn moved(&self) -> Vec<bool> {
        self.parents.iter().map(|&p| p == NONE).collect()
    }

    /// The input and the result side by side.
    pub fn picture(&self, input: &Input) -> Result<Vec<u8>> {
        let after = TriangleMesh::new(self.points.clone(), self.faces.clone());
        let moved = self.moved();
        let style = MeshStyle { moved: Some(&moved), ..MeshStyle::default() };
        preview::meshes(&[(&input.triangles, MeshStyle::default()), (&after, style)]).context("--preview")
    }

    /// The result as a file: polygons of the input whose triangles are all unchanged come first, in its order.
    pub fn write(&self, input: &Input, format: MeshFormat) -> Vec<u8> {
        files::write(&self.polygons(input, format == MeshFormat::Ply), format)
    }

    /// How many polygons of the input are unchanged.
    pub fn kept_polygons(&self, input: &Input) -> Vec<bool> {
        let count = input.polygons.polygon_count();
        let parent = |t: usize| input.triangles.parents.get(t).map_or(t, |&p| p as usize);
        let mut total = vec![0u32; count];
        (0..input.triangles.faces.len()).for_each(|t| total[parent(t)] += 1);
        let mut left = vec![0u32; count];
        self.parents.iter().filter(|&&p| p != NONE).for_each(|&p| left[parent(p as usize)] += 1);
        total.iter().zip(&left).map(|(t, l)| *t > 0 && t == l).collect()
    }

    /// How many faces the file of the result has.
    pub fn polygon_count(&self, input: &Input) -> usize {
        let kept = self.kept_polygons(input);
        let parent = |t: u32| input.triangles.parents.get(t as usize).map_or(t, |&p| p);
        let is_cut = |&&origin: &&u32| origin == NONE || !kept[parent(origin) as usize];
        kept.iter().filter(|kept| **kept).count() + self.parents.iter().filter(is_cut).count()
    }

    fn polygons(&self, input: &Input, colour: bool) -> PolygonMesh {
        let mut mesh = PolygonMesh::new(self.points.clone());
        let mut number = vec![NONE; input.triangles.points.len()];
        for (k, &v) in self.origins.iter().enumerate() {
            if v != NONE {
                number[v as usize] = k as u32;
            }
        }
        let kept = self.kept_polygons(input);
        for (k, _) in kept.iter().enumerate().filter(|(_, kept)| **kept) {
            let corners: Vec<u32> = input.polygons.polygon(k).iter().map(|&v| number[v as usize]).collect();
            mesh.push(&corners);
        }
        let parent = |t: u32| input.triangles.parents.get(t as usize).map_or(t, |&p| p);
        for (face, &origin) in self.faces.iter().zip(&self.parents) {
            if origin == NONE || !kept[parent(origin) as usize] {
                mesh.push(face);
            }
        }
        if colour {
            self.paint(&mut mesh, input);
        }
        mesh
    }

    /// Colours and displacements of the vertices.
    fn paint(&self, mesh: &mut PolygonMesh, input: &Input) {
        let surface = crate::mesh::Hierarchy::new(&input.triangles.points, &input.triangles.faces);
        let own = &input.polygons.colours;
        for (k, &v) in self.origins.iter().enumerate() {
            let stays = v != NONE;
            let colour = if stays { own.get(v as usize).copied().unwrap_or(STAYED) } else { MOVED };
            mesh.colours.push(colour);
            let distance = || surface.nearest(self.points[k], f64::INFINITY).map_or(0.0, |hit| hit.distance);
            mesh.scalars.push(if stays { 0.0 } else { distance() });
        }
    }
}
