//! What the closing of a surface costs, phase by phase, as the mesh grows and what moves does not.
//!
//! `cargo run --release --example surface_scaling` measures a bracket, whose concave edge is filled, beside a ball that has
//! nothing to fill, with ten thousand, a hundred thousand and a million vertices in all; `-- FILE RADIUS EDGE` measures any mesh.
//! Each runs in a process of its own, so that the peak of memory is its own.

use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{HalfEdgeMesh, Hierarchy, PolygonMesh, problems};
use clopen::rolling::{SurfaceOptions, close_surface};

#[path = "../tests/solids/mod.rs"]
#[allow(dead_code)]
mod solids;

const SIZES: [u32; 3] = [10_000, 100_000, 1_000_000];

/// The bracket, and a ball far from it with so many vertices that both have about `count`.
fn bracket_and_ball(count: u32) -> PolygonMesh {
    let bracket = solids::bracket();
    let rest = f64::from(count) - bracket.points.len() as f64;
    // A cube blown up, so that its quads are alike everywhere.
    let n = (rest / 6.0).sqrt().round().max(2.0);
    let mut ball = solids::blocks([n as i32; 3], 1.0, |_| true);
    for p in &mut ball.points {
        let cube = p.coords.map(|x| ((2.0 * x / n - 1.0) * std::f64::consts::FRAC_PI_4).tan());
        *p = clopen::mesh::Point::new(5.0, 0.0, 0.0) + cube.normalize();
    }
    let from = bracket.points.len() as u32;
    let mut both = PolygonMesh::new([bracket.points.as_slice(), &ball.points].concat());
    bracket.polygons().for_each(|p| both.push(p));
    ball.polygons().for_each(|p| both.push(&p.iter().map(|v| v + from).collect::<Vec<_>>()));
    both
}

/// The peak of this process's memory, where the system tells (`/proc`, Linux).
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn measure(path: &Path, radius: f64, edge: f64) -> Result<(), Box<dyn std::error::Error>> {
    let mut marks = vec![];
    let mut start = Instant::now();
    let mut mark = |name: &'static str| {
        let now = Instant::now();
        marks.push((name, 1e3 * (now - std::mem::replace(&mut start, now)).as_secs_f64()));
    };
    let format = MeshFormat::of_path(path).ok_or("the name says no format: .obj, .stl or .ply")?;
    let polygons = read(&std::fs::read(path)?, format)?;
    mark("reading");
    let found = problems(&polygons).len();
    mark("problems");
    let mesh = polygons.triangulated();
    mark("triangles");
    // What the closing begins with, once by itself.
    let half_edges = HalfEdgeMesh::new(mesh.points.clone(), &mesh.faces)?;
    mark("neighbours");
    let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
    mark("hierarchy");
    let normals = mesh.vertex_normals();
    mark("normals");
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let tested = std::thread::scope(|scope| {
        let part = mesh.points.len().div_ceil(threads).max(1);
        let (hierarchy, points, normals) = (&hierarchy, mesh.points.chunks(part), normals.chunks(part));
        let count = |(points, normals): (&[clopen::mesh::Point], &[clopen::mesh::Vector])| {
            let tests = points.iter().zip(normals);
            tests.filter(|&(p, n)| hierarchy.is_nearer(p + n * radius, radius * (1.0 - 1e-8))).count()
        };
        let parts: Vec<_> = points.zip(normals).map(|both| scope.spawn(move || count(both))).collect();
        parts.into_iter().map(|part| part.join().unwrap_or(0)).sum::<usize>()
    });
    mark("first test");
    drop((half_edges, hierarchy, normals));
    start = Instant::now();
    let mut mark = |name: &'static str, start: &mut Instant| {
        let now = Instant::now();
        marks.push((name, 1e3 * (now - std::mem::replace(start, now)).as_secs_f64()));
    };
    let options = SurfaceOptions { radius: &|_| radius, pin_distance: &|_| f64::INFINITY, edge, threads };
    let closed = close_surface(&mesh, &options)?;
    mark("closing", &mut start);
    let bytes = write(&PolygonMesh::of_triangles(closed.points.clone(), &closed.faces), format);
    mark("writing", &mut start);
    let of = |name: &str| marks.iter().find(|m| m.0 == name).map_or(0.0, |m| m.1);
    let begins = of("neighbours") + of("hierarchy") + of("normals") + of("first test");
    print!("| {} | {} | {} |", mesh.points.len(), tested, closed.origins.iter().filter(|&&v| v == u32::MAX).count());
    for name in ["reading", "problems", "triangles", "neighbours", "hierarchy", "normals", "first test"] {
        print!(" {:.1} |", of(name));
    }
    let memory = peak_megabytes().map_or("?".to_owned(), |m| format!("{m:.0}"));
    println!(" {:.1} | {:.1} | {:.1} | {memory} |", of("closing"), of("closing") - begins, of("writing"));
    eprintln!("{} problems, {} conflicts, {} bytes", found, closed.conflicts.len(), bytes.len());
    Ok(())
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [word, path, radius, edge] = arguments.as_slice()
        && word == "--one"
    {
        return measure(Path::new(path), radius.parse()?, edge.parse()?);
    }
    println!(
        "Milliseconds; the rest is the closing without what it begins with: neighbours, hierarchy, normals and first test.\n\n\
         | vertices | not touched | new | reading | problems | triangles | neighbours | hierarchy | normals | first test | closing \
         | of which rest | writing | peak MB |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    let one = |path: &Path, radius: &str, edge: &str| -> Result<(), Box<dyn std::error::Error>> {
        let status = Command::new(std::env::current_exe()?).arg("--one").arg(path).args([radius, edge]).status()?;
        if status.success() { Ok(()) } else { Err("it did not end well".into()) }
    };
    if let [path, radius, edge] = arguments.as_slice() {
        return one(Path::new(path), radius, edge);
    }
    let folder = tempfile::tempdir()?;
    for count in SIZES {
        let path = folder.path().join("both.obj");
        std::fs::write(&path, write(&bracket_and_ball(count), MeshFormat::Obj))?;
        one(&path, "0.3", "0.05")?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}
