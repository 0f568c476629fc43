//! Times closings by different methods on the same shapes in the same run, and says who is wrong:
//! `cargo bench --bench peers -- [--drawings] [--scaling] [--shapes] [--most VERTICES] [--seconds BUDGET]`, all tables unless some are named.
//!
//! Milliseconds, best and median of several rounds; in a round every method runs once, so that what else the machine
//! does hits all alike. What is timed is the bare closing, for the peers two offsets there and back; their arcs may
//! stray by 1e-3 r, as in a milling program. The rolling disk knows no such tolerance. A result is marked with its distance
//! from that of the rolling disk where it is beyond what its method allows.

#[path = "../tests/laws/mod.rs"]
mod laws;
#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::path::Path;
use std::time::Instant;

use cavalier_contours::polyline::{PlineSource, PlineSourceMut, Polyline};
use cavalier_contours::shape_algorithms::{Shape, ShapeOffsetOptions};
use clipper2_rust::{EndType, JoinType, Path64, Paths64, Point64, inflate_paths_64};
use clopen::io::svg::{self, Curves, ReadOptions};
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use clopen::rolling::{self, Topology};
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

/// How far arcs of polygon clippers may stray, over the radius.
const SAGITTA: f64 = 1e-3;

/// A clipped result is off by the sagitta of both offsets, and by more where two arcs meet at a small angle; it is wrong beyond
/// this, over the radius.
const CLIPPER_ALLOWS: f64 = 10.0 * SAGITTA;

/// The tolerances of exact arcs, over the radius: those that a user would take, and those at which the answers are right.
const CAVALIER_LOOSE: [f64; 3] = [1e-5, 1e-4, 1e-4];
const CAVALIER_TIGHT: [f64; 3] = [1e-10, 1e-9, 1e-8];
const CAVALIER_ALLOWS: f64 = 4e-4;

/// A method that took longer than this is left out of the rows of the same series that are longer: they are so by ten
/// times, and time, and for some memory, grows with the square.
const PATIENCE_MS: f64 = 500.0;

/// Rounds at least, of which methods that use up their share of the time are spared all but three.
const FEWEST_ROUNDS: usize = 15;

/// A result in the form of its method.
enum Result {
    Region(Region),
    Shape(Shape<f64>),
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
    Integers(Paths64, f64, Point),
}

struct Method {
    name: &'static str,
    /// How far its result may be off, over the radius.
    allows: f64,
    run: fn(&Region, f64) -> Result,
}

const METHODS: [Method; 5] = [
    Method { name: "rolling disk", allows: f64::INFINITY, run: rolling_disk },
    Method { name: "cavalier", allows: CAVALIER_ALLOWS, run: |a, r| cavalier(a, r, CAVALIER_LOOSE) },
    Method { name: "cavalier tight", allows: CAVALIER_ALLOWS, run: |a, r| cavalier(a, r, CAVALIER_TIGHT) },
    Method { name: "i_overlay", allows: CLIPPER_ALLOWS, run: i_overlay },
    Method { name: "clipper2", allows: CLIPPER_ALLOWS, run: clipper2 },
];

struct Input {
    name: String,
    region: Region,
    r: f64,
}

/// What one method took for one input.
struct Timing {
    milliseconds: Vec<f64>,
    /// Over the radius, where the result is not within what the method allows.
    wrong: Option<f64>,
}

fn main() {
    let (mut tables, mut most, mut seconds) = (vec![], 1_000_000, 3.0);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--most" => most = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(most),
            "--seconds" => seconds = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(seconds),
            // Cargo passes flags of its own to a benchmark.
            "--drawings" | "--scaling" | "--shapes" => tables.push(argument),
            _ => {}
        }
    }
    let asked = |name: &str| tables.is_empty() || tables.iter().any(|t| t == name);
    if asked("--drawings") {
        table("drawings, closed by 2 % of the diagonal", drawings(), seconds);
    }
    if asked("--shapes") {
        table("small shapes", small_shapes(), 0.2 * seconds);
    }
    if asked("--scaling") {
        let sizes = [1_000, 10_000, 100_000, 1_000_000].into_iter().filter(|n| *n <= most);
        let sizes: Vec<usize> = sizes.collect();
        table("fractal coast, closed by 2 %", sizes.iter().map(|&n| coast(n)).collect(), seconds);
        table("smooth outline, closed by 2 %", sizes.iter().map(|&n| smooth(n)).collect(), seconds);
    }
}

fn two_percent(name: &str, region: Region) -> Input {
    let r = 0.02 * region.bounds().diagonal();
    Input { name: name.to_owned(), region, r }
}

/// From the shared data, or else from the samples; absent ones are named.
fn drawings() -> Vec<Input> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let options = ReadOptions { curves: Curves::Polygon, ..ReadOptions::default() };
    let read = |name: &str| {
        let places = [root.join("../shared/data/2d"), root.join("samples")];
        let bytes = places.iter().find_map(|p| std::fs::read(p.join(name).with_extension("svg")).ok());
        let drawing = bytes.and_then(|b| svg::read(&b, &options).ok());
        if drawing.is_none() {
            println!("skipped: no {name}.svg in ../shared/data/2d or samples");
        }
        drawing.map(|d| two_percent(name.rsplit('_').next().unwrap_or(name), d.region))
    };
    ["country_vietnam", "emblem_canada_maple_leaf", "country_norway"].into_iter().filter_map(read).collect()
}

fn small_shapes() -> Vec<Input> {
    let unit = |name: &str, region| Input { name: name.to_owned(), region, r: 1.0 };
    vec![
        unit("gear", shapes::gear(24, 20.0, 24.0, 6.0)),
        unit("comb", shapes::comb(40, 8.0, 1.5)),
        unit("star", shapes::star(60, 20.0, 30.0)),
    ]
}

fn coast(vertices: usize) -> Input {
    two_percent("coast", shapes::coast(vertices, 50.0, 7))
}

/// A round outline with lobes, some too narrow for the disk, sampled densely.
fn smooth(vertices: usize) -> Input {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / vertices as f64;
        let radius = 50.0 + 12.0 * (5.0 * angle).cos() + 2.0 * (37.0 * angle).sin();
        Point::new(radius * angle.cos(), radius * angle.sin())
    };
    two_percent("smooth", Region::new(vec![Ring::polygon((0..vertices).map(at))]))
}

fn table(title: &str, inputs: Vec<Input>, seconds: f64) {
    println!("\n{title}; ms, best / median of rounds; x: how many times the rolling disk's best");
    print!("{:<10}{:>9}", "input", "vertices");
    METHODS.iter().for_each(|m| print!(" {:>30}", m.name));
    println!();
    let mut patient = [true; METHODS.len()];
    for input in inputs {
        let timings = measure(&input, seconds, &patient);
        print!("{:<10}{:>9}", input.name, input.region.vertex_count());
        let own = timings[0].as_ref().map_or(f64::NAN, |t| t.milliseconds[0]);
        for (k, timing) in timings.iter().enumerate() {
            let Some(Timing { milliseconds, wrong }) = timing else {
                print!(" {:>30}", "-");
                continue;
            };
            let (best, median) = (milliseconds[0], milliseconds[milliseconds.len() / 2]);
            patient[k] &= best < PATIENCE_MS;
            let ratio = if k == 0 { format!("{} rounds", milliseconds.len()) } else { format!("{:.1} x", best / own) };
            let mark = wrong.map_or(String::new(), |d| format!(" WRONG {d:.0e}"));
            print!(" {:>30}", format!("{best:.2}/{median:.2} {ratio}{mark}"));
        }
        println!();
    }
}

fn measure(input: &Input, seconds: f64, patient: &[bool]) -> Vec<Option<Timing>> {
    let Input { region, r, .. } = input;
    let mut timings: Vec<Option<Timing>> = patient.iter().map(|_| None).collect();
    let start = Instant::now();
    let mut own = Region::default();
    for round in 0.. {
        if round >= FEWEST_ROUNDS && start.elapsed().as_secs_f64() > seconds || round >= 200 {
            break;
        }
        for (k, method) in METHODS.iter().enumerate().filter(|(k, _)| patient[*k]) {
            // The slow ones need not run in every round.
            if round >= 3
                && timings[k].as_ref().is_some_and(|t| t.milliseconds.iter().sum::<f64>() > 1e3 * seconds / 4.0)
            {
                continue;
            }
            let begin = Instant::now();
            let result = std::hint::black_box((method.run)(region, *r));
            let elapsed = begin.elapsed().as_secs_f64() * 1e3;
            if round > 0 {
                timings[k].as_mut().expect("the first round has made it").milliseconds.push(elapsed);
                continue;
            }
            let result = as_region(&result);
            if k == 0 {
                own.clone_from(&result);
            }
            let (distance, _) = laws::hausdorff(&own, &result, *r);
            let wrong = (distance > method.allows * r).then_some(distance / r);
            timings[k] = Some(Timing { milliseconds: vec![elapsed], wrong });
        }
    }
    for timing in timings.iter_mut().flatten() {
        timing.milliseconds.sort_by(f64::total_cmp);
    }
    timings
}

fn rolling_disk(region: &Region, r: f64) -> Result {
    Result::Region(rolling::close(region, laws::radius(r), Topology::Merge).region)
}

/// Tolerances are in radii.
fn cavalier(region: &Region, r: f64, [pos_equal_eps, offset_dist_eps, slice_join_eps]: [f64; 3]) -> Result {
    let options = ShapeOffsetOptions {
        pos_equal_eps: pos_equal_eps * r,
        offset_dist_eps: offset_dist_eps * r,
        slice_join_eps: slice_join_eps * r,
    };
    let lines = region.rings.iter().map(|ring| {
        let mut line = Polyline::new_closed();
        for s in ring.segments() {
            let bulge = match s.link {
                Link::Line => 0.0,
                Link::Arc(arc) => arc.turn.sign() * (s.sweep() / 4.0).tan(),
            };
            line.add(s.start.x, s.start.y, bulge);
        }
        line
    });
    Result::Shape(Shape::from_plines(lines).parallel_offset(-r, &options).parallel_offset(r, &options))
}

fn i_overlay(region: &Region, r: f64) -> Result {
    let rings: Vec<Vec<[f64; 2]>> =
        region.rings.iter().map(|ring| ring.flatten(SAGITTA * r).iter().map(|p| [p.x, p.y]).collect()).collect();
    // The angle whose chord has the sagitta.
    let angle = 2.0 * (1.0 - SAGITTA).acos();
    let style = |offset: f64| OutlineStyle::new(offset).line_join(LineJoin::Round(angle));
    let dilated = rings.outline_as::<i64>(&style(r));
    Result::Polygons(dilated.outline_as::<i64>(&style(-r)))
}

fn clipper2(region: &Region, r: f64) -> Result {
    // Units of its integers: a millionth of the radius.
    let (scale, center) = (1e6 / r, region.bounds().center());
    let paths: Paths64 = region
        .rings
        .iter()
        .map(|ring| -> Path64 {
            let points = ring.flatten(SAGITTA * r).into_iter().map(|p| (p - center) * scale);
            points.map(|p| Point64::new(p.x.round() as i64, p.y.round() as i64)).collect()
        })
        .collect();
    let offset = |paths: &Paths64, delta: f64| {
        inflate_paths_64(paths, delta, JoinType::Round, EndType::Polygon, 2.0, SAGITTA * 1e6)
    };
    Result::Integers(offset(&offset(&paths, 1e6), -1e6), 1.0 / scale, center)
}

fn as_region(result: &Result) -> Region {
    match result {
        Result::Region(region) => region.clone(),
        Result::Shape(shape) => {
            let lines = shape.ccw_plines.iter().chain(&shape.cw_plines);
            Region::new(lines.map(|line| ring_of(&line.polyline)).filter(|r| r.len() > 1).collect())
        }
        Result::Polygons(shapes) => Region::new(
            shapes.iter().flatten().map(|c| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1])))).collect(),
        ),
        Result::Integers(paths, unit, center) => {
            let point = |p: &Point64| center + Vector::new(p.x as f64, p.y as f64) * *unit;
            Region::new(paths.iter().map(|path| Ring::polygon(path.iter().map(point))).collect())
        }
    }
}

fn ring_of(line: &Polyline<f64>) -> Ring {
    let n = line.vertex_count();
    let vertex = |i: usize| {
        let (a, b) = (line.at(i), line.at((i + 1) % n));
        let (from, to) = (Point::new(a.x, a.y), Point::new(b.x, b.y));
        let link = if a.bulge.abs() < 1e-12 {
            Link::Line
        } else {
            let chord = to - from;
            let center = nalgebra::center(&from, &to)
                + Vector::new(-chord.y, chord.x) * ((1.0 - a.bulge * a.bulge) / (4.0 * a.bulge));
            let turn = if a.bulge > 0.0 { Turn::Left } else { Turn::Right };
            Link::Arc(Arc { center, radius: (from - center).norm(), turn })
        };
        Vertex { point: from, link, joint: Joint::Corner, id: None }
    };
    Ring { vertices: (0..n).map(vertex).collect() }
}
