//! Writes a sheet of 200 parts with curved outlines and two holes each, and a job for it:
//! `cargo run --release --example sheet -- FOLDER`; then, there, `clopen mill sheet.svg --depth 6 --depth-per-pass 2 -o sheet.nc`
//! and `clopen mill sheet.svg --job sheet.toml -o job.nc`. A number behind the folder is that of the curves a lobe is made of.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const COLUMNS: usize = 20;
const ROWS: usize = 10;
const PITCH: f64 = 60.0;

/// Curves a lobe of a part is made of.
const CURVES: usize = 4;

/// Three tabs on every outline, three passes.
const JOB: &str = r#"version = 1

[stock]
thickness = 6

[machine]
dialect = "grbl"
acceleration = 400

[[tool]]
number = 1
diameter = 3.175
flute-length = 15
feed = 1200
plunge-feed = 350
spindle-speed = 18000
depth-per-pass = 2

[[operation]]
kind = "profile"
tool = 1
through = true
tabs = { count = 3, width = 5, height = 1.5 }
"#;

/// A part with so many lobes, as deep as `depth` of its radius, each of so many cubic curves.
fn part(x: f64, y: f64, lobes: usize, curves: usize, depth: f64) -> String {
    let knots = curves * lobes;
    let radius = |t: f64| 18.0 * (1.0 + depth * (lobes as f64 * t).cos());
    let slope = |t: f64| -18.0 * depth * lobes as f64 * (lobes as f64 * t).sin();
    let at = |t: f64| [x + radius(t) * t.cos(), y + radius(t) * t.sin()];
    let speed = |t: f64| [slope(t) * t.cos() - radius(t) * t.sin(), slope(t) * t.sin() + radius(t) * t.cos()];
    let step = TAU / knots as f64;
    let [x0, y0] = at(0.0);
    let mut d = format!("M{x0:.4},{y0:.4}");
    for k in 0..knots {
        let (s, t) = (k as f64 * step, (k + 1) as f64 * step);
        let ([px, py], [qx, qy], [ux, uy], [vx, vy]) = (at(s), at(t), speed(s), speed(t));
        let third = step / 3.0;
        // Writing to a string cannot fail.
        let _ = write!(
            d,
            "C{:.4},{:.4} {:.4},{:.4} {qx:.4},{qy:.4}",
            px + third * ux,
            py + third * uy,
            qx - third * vx,
            qy - third * vy
        );
    }
    d + "Z"
}

fn drawing(curves: usize) -> String {
    let (width, height) = (COLUMNS as f64 * PITCH, ROWS as f64 * PITCH);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for n in 0..COLUMNS * ROWS {
        let (x, y) = ((n % COLUMNS) as f64 * PITCH + PITCH / 2.0, (n / COLUMNS) as f64 * PITCH + PITCH / 2.0);
        let (lobes, depth) = (3 + n % 6, 0.1 + 0.2 * (n % 7) as f64 / 6.0);
        let holes: String = [-6.0, 6.0].map(|dx| circle(x + dx, y, 3.0)).concat();
        let _ = writeln!(svg, "<path fill-rule=\"evenodd\" d=\"{}{holes}\"/>", part(x, y, lobes, curves, depth));
    }
    svg + "</svg>\n"
}

fn circle(x: f64, y: f64, r: f64) -> String {
    format!("M{},{y}A{r},{r} 0 0 1 {},{y}A{r},{r} 0 0 1 {},{y}Z", x - r, x + r, x - r)
}

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("which folder? cargo run --release --example sheet -- FOLDER");
        return ExitCode::from(2);
    };
    let curves = std::env::args().nth(2).and_then(|text| text.parse().ok()).unwrap_or(CURVES).max(1);
    for (name, text) in [("sheet.svg", drawing(curves)), ("sheet.toml", JOB.to_owned())] {
        let path = folder.join(name);
        if let Err(error) = std::fs::write(&path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
