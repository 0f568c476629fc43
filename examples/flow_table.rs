//! What the flow is measured by: its limit against the exact closing and opening for several edge lengths and time steps
//! (as the paper's Fig. 14), its states in time for edges halved, and what a step costs on outlines of which little moves.
//!
//! `cargo run --release --example flow_table [-- SHAPE]`

#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::time::Instant;

use clopen::flow::{CurveFlow, DEFAULT_EDGE, DEFAULT_TIME_STEP, Field, Obstacle, Settings, Status};
use clopen::plane::{Point, Region, Ring};
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use shapes::hausdorff;

/// Edge lengths as numbers of them to the radius, and time steps in squares of the edge length.
const EDGES: [f64; 3] = [6.5, 13.0, 26.0];
const TIME_STEPS: [f64; 3] = [0.2, 0.05, 0.0125];

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let shapes: Vec<_> = shapes::flow_shapes().into_iter().filter(|(name, _)| name.contains(&only)).collect();
    if shapes.is_empty() {
        eprintln!("no shape is called {only}");
        std::process::exit(2);
    }
    limits(&shapes);
    states(&shapes);
    if only.is_empty() {
        costs();
    }
}

/// The radius of every shape.
fn radius() -> Radius {
    Radius::new(1.0).expect("1 is a radius")
}

fn flow(region: &Region, obstacle: Obstacle, edge: f64, time_step: f64) -> CurveFlow<'static> {
    let settings = Settings { edge, time_step, ..Settings::default() };
    CurveFlow::new(region, obstacle, Field::constant(radius()), &settings).expect("the settings are in range")
}

fn limits(shapes: &[(&str, Region)]) {
    println!("Largest distance of the limit to the exact result, in edge lengths h (in brackets: time to it, r²)");
    print!("{:15}", "");
    for edge in EDGES {
        for step in TIME_STEPS {
            print!("{:>17}", format!("r/{edge}, {step} h²"));
        }
    }
    println!();
    for (name, region) in shapes {
        let exact = [
            ("close", Obstacle::CLOSING, rolling::close(region, radius(), Topology::Keep)),
            ("open", Obstacle::OPENING, rolling::open(region, radius(), Topology::Keep)),
        ];
        for (operation, obstacle, exact) in exact {
            print!("{:15}", format!("{name} {operation}"));
            for edge in EDGES.map(|n| 1.0 / n) {
                for step in TIME_STEPS {
                    let mut flow = flow(region, obstacle, edge, step);
                    flow.run(f64::INFINITY);
                    let error = hausdorff(&flow.region(), &exact.region, 0.05 * edge) / edge;
                    print!("{:>17}", format!("{error:.4} ({:.2})", flow.time()));
                }
            }
            println!();
        }
    }
}

fn states(shapes: &[(&str, Region)]) {
    println!("\nLargest distance between the states at the same time for h and h/2, in r (default h and time step)");
    const TIMES: [f64; 6] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
    print!("{:15}", "t / r²");
    TIMES.iter().for_each(|t| print!("{t:9}"));
    println!();
    for (name, region) in shapes {
        for (operation, obstacle) in [("close", Obstacle::CLOSING), ("open", Obstacle::OPENING)] {
            print!("{:15}", format!("{name} {operation}"));
            let mut flows = [1.0, 0.5].map(|f| flow(region, obstacle, f * DEFAULT_EDGE, DEFAULT_TIME_STEP));
            for time in TIMES {
                for flow in &mut flows {
                    flow.run(time);
                }
                let [a, b] = [flows[0].region(), flows[1].region()];
                print!("{:9.5}", hausdorff(&a, &b, 0.02 * DEFAULT_EDGE));
            }
            println!();
        }
    }
}

/// A regular polygon so large that nothing of it moves, with notches; about a hundredth of its vertices lie in them.
fn notched(vertices: usize) -> Region {
    let circumference = 0.05 * vertices as f64;
    let radius = circumference / std::f64::consts::TAU;
    let at = |k: usize, depth: f64| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / vertices as f64).sin_cos();
        Point::new((radius - depth) * cos, (radius - depth) * sin)
    };
    Region::new(vec![Ring::polygon((0..vertices).map(|k| at(k, if k % 1000 < 10 { 0.6 } else { 0.0 })))])
}

fn costs() {
    println!("\nWhat a step costs where a hundredth of the outline moves (200 steps)");
    println!("{:>10}{:>12}{:>10}{:>18}{:>22}", "vertices", "start, ms", "moving", "a step, us", "a moving vertex, ns");
    for vertices in [10_000, 100_000, 1_000_000] {
        let region = notched(vertices);
        let start = Instant::now();
        let mut flow = flow(&region, Obstacle::CLOSING, DEFAULT_EDGE, DEFAULT_TIME_STEP);
        flow.step(f64::INFINITY);
        let started = start.elapsed();
        let (start, mut moved, mut steps) = (Instant::now(), 0, 0);
        while steps < 200 && flow.step(f64::INFINITY) == Status::Going {
            steps += 1;
            moved += flow.last_step().0;
        }
        let elapsed = start.elapsed().as_secs_f64();
        let (step, moving) = (elapsed / f64::from(steps), moved as f64 / f64::from(steps));
        println!(
            "{vertices:>10}{:>12.1}{moving:>10.0}{:>18.1}{:>22.0}",
            started.as_secs_f64() * 1e3,
            step * 1e6,
            1e9 * elapsed / moved as f64
        );
    }
}
