//! Times closings by different methods on the same shapes in the same run: `cargo bench --bench peers -- [VERTICES...]`.
//!
//! Milliseconds of the fastest of several runs. What is timed is the bare closing, two offsets there and back, without
//! the certificate that `reference` adds; the tolerance of arcs is 1e-3 r, as in a milling program.

#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::time::Instant;

use cavalier_contours::polyline::{PlineSource, PlineSourceMut, Polyline};
use cavalier_contours::shape_algorithms::{Shape, ShapeOffsetOptions};
use clopen::plane::{Link, Region};
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

/// A closing to be timed: gives the number of vertices of its result, so that no work can be left out.
type Closing = Box<dyn Fn(&Region, f64) -> usize>;

/// The columns of the table. ADD COLUMNS HERE.
fn methods() -> Vec<(&'static str, Closing)> {
    vec![
        ("cavalier", Box::new(|region, r| cavalier(region, r, [1e-5, 1e-4, 1e-4]))),
        ("cavalier tight", Box::new(|region, r| cavalier(region, r, [1e-10, 1e-9, 1e-8]))),
        ("i_overlay i64", Box::new(overlay)),
    ]
}

/// The rows of the table: a name, a shape and its radius. ADD DRAWINGS HERE.
fn inputs(coasts: &[usize]) -> Vec<(String, Region, f64)> {
    let two_percent = |region: &Region| 0.02 * region.bounds().diagonal();
    let mut inputs = vec![
        ("gear".to_owned(), shapes::gear(24, 20.0, 24.0, 6.0), 1.0),
        ("comb".to_owned(), shapes::comb(40, 8.0, 1.5), 1.0),
        ("star".to_owned(), shapes::star(60, 20.0, 30.0), 1.0),
    ];
    for &n in coasts {
        let coast = shapes::coast(n, 50.0, 7);
        let r = two_percent(&coast);
        inputs.push((format!("coast {n}"), coast, r));
    }
    inputs
}

fn main() {
    // Cargo passes its own flags to a benchmark; numbers are sizes of coasts.
    let sizes: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![1024, 4096] } else { sizes };
    let methods = methods();
    print!("{:<16}{:>9}{:>9}", "input", "vertices", "r");
    methods.iter().for_each(|(name, _)| print!("{name:>18}"));
    println!("   (ms, vertices of the result)");
    for (name, region, r) in inputs(&sizes) {
        print!("{name:<16}{:>9}{r:>9.3}", region.vertex_count());
        for (_, closing) in &methods {
            let (milliseconds, vertices) = fastest(|| closing(&region, r));
            print!("{milliseconds:>10.2} {vertices:>7}");
        }
        println!();
    }
}

/// The fastest of at least 3 runs, and of as many as fit into a third of a second.
fn fastest(run: impl Fn() -> usize) -> (f64, usize) {
    let (mut best, mut total, mut runs, mut vertices) = (f64::INFINITY, 0.0, 0, 0);
    while runs < 3 || (total < 300.0 && runs < 1000) {
        let start = Instant::now();
        vertices = std::hint::black_box(run());
        let elapsed = start.elapsed().as_secs_f64() * 1e3;
        best = best.min(elapsed);
        total += elapsed;
        runs += 1;
    }
    (best, vertices)
}

/// Tolerances are in radii.
fn cavalier(region: &Region, r: f64, [pos_equal_eps, offset_dist_eps, slice_join_eps]: [f64; 3]) -> usize {
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
    let closed = Shape::from_plines(lines).parallel_offset(-r, &options).parallel_offset(r, &options);
    closed.ccw_plines.iter().chain(&closed.cw_plines).map(|p| p.polyline.vertex_count()).sum()
}

fn overlay(region: &Region, r: f64) -> usize {
    let rings: Vec<Vec<[f64; 2]>> =
        region.rings.iter().map(|ring| ring.flatten(1e-3 * r).iter().map(|p| [p.x, p.y]).collect()).collect();
    // The angle whose chord has a sagitta of 1e-3 r.
    let angle = 2.0 * (1.0f64 - 1e-3).acos();
    let style = |offset: f64| OutlineStyle::new(offset).line_join(LineJoin::Round(angle));
    let dilated = rings.outline_as::<i64>(&style(r));
    let closed = dilated.outline_as::<i64>(&style(-r));
    closed.iter().flatten().map(Vec::len).sum()
}
