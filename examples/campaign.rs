//! Thousands of random shapes through the rolling disk, held against the offset references, and both against the
//! definition of the closing: `cargo run --release --example campaign -- --shapes 20000 [--first N] [--only N]`.
//!
//! Exit 1 where the rolling disk is wrong or breaks a law. The same numbers give the same shapes everywhere.

#[path = "../tests/laws/mod.rs"]
mod laws;
#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use clopen::plane::{Arc, Link, Point, Region, Ring, Turn, Vector, VertexId};
use clopen::reference::{self, Operation, ReferenceError};
use clopen::rolling::{self, Outcome, Topology};
use laws::{ACCURACY, Arbiter};
use shapes::Numbers;

/// What may poke out, over the radius.
const CONTAINMENT: f64 = 1e-9;

/// Places at which a dispute is settled.
const PLACES: usize = 48;

/// One in this many shapes is judged by the definition even where nobody disputes it.
const SPOT_CHECK: u64 = 16;

/// A part, a radius and what to do: a function of the number alone.
struct Case {
    name: String,
    input: Region,
    r: f64,
    operation: Operation,
}

/// What came of a case.
#[derive(Default)]
struct Findings {
    /// Laws broken, and verdicts against the rolling disk.
    wrong: Vec<String>,
    agreed: bool,
    /// Differs from the reference, which the definition proves wrong.
    reference_wrong: bool,
    /// Differs from the reference where a change of the radius within the band decides.
    undecided: bool,
    refused: bool,
    input_refused: bool,
    contradictions: usize,
    spot_checked: bool,
    kept_proved: bool,
    rolling: Duration,
    reference: Duration,
    distance_over_r: f64,
}

fn main() -> ExitCode {
    let (mut count, mut first, mut only) = (2000, 0, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().and_then(|v| v.parse::<u64>().ok());
        match (name.as_str(), value) {
            ("--shapes", Some(n)) => count = n,
            ("--first", Some(n)) => first = n,
            ("--only", Some(n)) => only = Some(n),
            _ => {
                eprintln!("usage: campaign [--shapes COUNT] [--first NUMBER] [--only NUMBER]");
                return ExitCode::from(2);
            }
        }
    }
    match only {
        Some(number) => repeat(number),
        None => run(first, count),
    }
}

fn run(first: u64, count: u64) -> ExitCode {
    let start = Instant::now();
    let bar = indicatif::ProgressBar::new(count);
    let (next, all) = (AtomicU64::new(first), Mutex::new(vec![]));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= first + count {
                        break;
                    }
                    let findings = judge(&case(number), number);
                    for wrong in &findings.wrong {
                        bar.suspend(|| println!("WRONG {number}: {wrong}"));
                    }
                    bar.inc(1);
                    // The lock is poisoned only where a thread has panicked, which ends the campaign anyway.
                    all.lock().expect("no thread panics while it holds the lock").push((number, findings));
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut all = all.into_inner().expect("all threads have ended well");
    all.sort_by_key(|(number, _)| *number);
    report(&all, start.elapsed())
}

fn report(all: &[(u64, Findings)], elapsed: Duration) -> ExitCode {
    let count = |test: fn(&Findings) -> bool| all.iter().filter(|(_, f)| test(f)).count();
    let numbers = |test: fn(&Findings) -> bool| -> Vec<u64> {
        all.iter().filter(|(_, f)| test(f)).map(|(n, _)| *n).take(20).collect()
    };
    let sum = |time: fn(&Findings) -> Duration| all.iter().map(|(_, f)| time(f)).sum::<Duration>().as_secs_f64();
    println!("shapes                          {:>8}", all.len());
    println!("agree with their reference      {:>8}   within {ACCURACY:e} r", count(|f| f.agreed));
    println!(
        "reference proved wrong          {:>8}   {:?}",
        count(|f| f.reference_wrong),
        numbers(|f| f.reference_wrong)
    );
    println!("hang on the last digits of r    {:>8}   {:?}", count(|f| f.undecided), numbers(|f| f.undecided));
    println!("reference refused               {:>8}   judged by distances alone", count(|f| f.refused));
    println!("no valid shape                  {:>8}   not judged", count(|f| f.input_refused));
    println!("also judged by distances        {:>8}", count(|f| f.spot_checked));
    println!("keeping proved to be merging    {:>8}", count(|f| f.kept_proved));
    println!(
        "contradictions reported         {:>8}   {:?}",
        count(|f| f.contradictions > 0),
        numbers(|f| f.contradictions > 0)
    );
    println!(
        "ROLLING DISK WRONG              {:>8}   {:?}",
        count(|f| !f.wrong.is_empty()),
        numbers(|f| !f.wrong.is_empty())
    );
    let largest = all.iter().filter(|(_, f)| f.agreed).map(|(_, f)| f.distance_over_r).fold(0.0, f64::max);
    println!("largest distance of agreement   {largest:>8.1e} r");
    println!(
        "seconds                         {:>8.1}   rolling {:.1}, references {:.1} (sums over threads)",
        elapsed.as_secs_f64(),
        sum(|f| f.rolling),
        sum(|f| f.reference)
    );
    let judged = count(|f| f.agreed || f.reference_wrong || f.undecided || f.refused);
    // A campaign that judges nothing proves nothing.
    if count(|f| !f.wrong.is_empty()) == 0 && 10 * judged >= 9 * all.len() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    }
}

/// One case again, with a smaller shape that has the same fault, as Rust.
fn repeat(number: u64) -> ExitCode {
    let case = case(number);
    println!("{}: {} vertices, r = {:?}, {:?}", case.name, case.input.vertex_count(), case.r, case.operation);
    let findings = judge(&case, number);
    println!("distance {:.3e} r, {} contradictions", findings.distance_over_r, findings.contradictions);
    if findings.wrong.is_empty() {
        return ExitCode::SUCCESS;
    }
    findings.wrong.iter().for_each(|w| println!("WRONG: {w}"));
    let kind = |w: &str| w.split(':').next().map(str::to_owned);
    let wanted = kind(&findings.wrong[0]);
    let smaller = reduced(&case, |case| judge(case, number).wrong.iter().any(|w| kind(w) == wanted));
    println!("// r = {:?}, {:?}\n{}", smaller.r, smaller.operation, laws::as_rust(&smaller.input));
    ExitCode::from(1)
}

/// The case without every ring and vertex that its fault does not need.
fn reduced(case: &Case, fails: impl Fn(&Case) -> bool) -> Case {
    let with = |input: Region| Case { name: case.name.clone(), input, r: case.r, operation: case.operation };
    let still = |input: &Region| laws::crossing(input, case.r).is_none() && fails(&with(input.clone()));
    let mut input = case.input.clone();
    for k in (0..input.rings.len()).rev() {
        let mut smaller = input.clone();
        smaller.rings.remove(k);
        if still(&smaller) {
            input = smaller;
        }
    }
    for ring in 0..input.rings.len() {
        let mut chunk = input.rings[ring].len() / 2;
        while chunk > 0 {
            let mut i = 0;
            while i < input.rings[ring].len() {
                let mut smaller = input.clone();
                let end = (i + chunk).min(smaller.rings[ring].len());
                smaller.rings[ring].vertices.drain(i..end);
                // An arc needs the end that it had.
                let enough = smaller.rings[ring].len() > 2;
                let sound = smaller.segments().all(|s| match s.link {
                    Link::Line => true,
                    Link::Arc(a) => ((s.end - a.center).norm() - a.radius).abs() < 1e-7 * a.radius,
                });
                if enough && sound && still(&smaller) { input = smaller } else { i += chunk }
            }
            chunk /= 2;
        }
    }
    with(input)
}

/// The case of a number.
fn case(number: u64) -> Case {
    let mut numbers = Numbers::new(number ^ 0xC105_ED00);
    let operation = if numbers.unit() < 0.5 { Operation::Close } else { Operation::Open };
    let (mut name, mut shape) = part(number, &mut numbers);
    // A third has been closed or opened before, so that arcs come in.
    if numbers.below(3) == 0 {
        let before = numbers.between(0.2, 1.6);
        let close = numbers.unit() < 0.6;
        let run = if close { rolling::close } else { rolling::open };
        let earlier = run(&shape, laws::radius(before), Topology::Merge).region;
        if !earlier.is_empty() {
            shape = earlier;
            name += if close { ", closed before" } else { ", opened before" };
        }
    }
    // Half at the radius that exact gaps are made for.
    let r = if numbers.unit() < 0.5 { 1.0 } else { numbers.between(0.15, 3.0) };
    let (angle, scale) = match numbers.below(3) {
        0 => (0.0, (numbers.below(17) as f64 - 8.0).exp2()),
        1 => (0.0, 1.0),
        _ => (numbers.between(0.0, 6.3), numbers.between(-7.0, 7.0).exp()),
    };
    let r = r * scale;
    let offset = if numbers.below(3) == 0 {
        name += ", far away";
        // Even multiples leave exact gaps exact.
        Vector::new(1048576.0, -1048576.0) * r.log2().round().exp2()
    } else {
        Vector::zeros()
    };
    let mut input = shapes::placed(&shape, angle, scale, offset);
    for (i, v) in input.rings.iter_mut().flat_map(|ring| &mut ring.vertices).enumerate() {
        v.id = Some(VertexId::from_index(i));
    }
    Case { name, input, r, operation }
}

fn part(number: u64, numbers: &mut Numbers) -> (String, Region) {
    if numbers.unit() < 0.65 {
        return shapes::mixed(number);
    }
    let (name, region) = match numbers.below(9) {
        0 => (
            "spiral",
            shapes::spiral(
                numbers.between(1.0, 4.0),
                numbers.between(1.0, 4.0),
                numbers.between(0.1, 0.9),
                40 + 2 * numbers.below(100),
            ),
        ),
        1 => (
            "gear",
            shapes::gear(
                5 + numbers.below(20),
                numbers.between(4.0, 9.0),
                numbers.between(9.5, 14.0),
                numbers.between(0.3, 3.5),
            ),
        ),
        2 => ("circles", circles(numbers)),
        3 => ("tangent circles", touching_free_disk(numbers)),
        4 => ("plate with bores", bored_plate(numbers)),
        5 => (
            "slot",
            shapes::slotted_plate(12.0, 8.0, [2.0, 0.5, 3.0, 1.5][numbers.below(4)], numbers.between(0.5, 7.0)),
        ),
        6 => ("nested", nested(numbers)),
        _ => ("bulges", bulges(numbers)),
    };
    (format!("{name} {number}"), region)
}

/// A star whose links are arcs that bulge to either side.
fn bulges(numbers: &mut Numbers) -> Region {
    let n = 3 + numbers.below(14);
    let (inner, bend) = (numbers.between(1.0, 6.0), numbers.between(0.05, 0.6));
    let mut ring = Ring::polygon((0..n).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * (k as f64 + numbers.between(0.0, 0.5)) / n as f64).sin_cos();
        Point::new(cos, sin) * numbers.between(inner, 7.0)
    }));
    for i in 0..n {
        let s = ring.segment(i);
        let bulge = numbers.between(-bend, bend);
        if numbers.unit() < 0.7 && bulge.abs() > 0.01 {
            let chord = s.end - s.start;
            let center = nalgebra::center(&s.start, &s.end)
                + Vector::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
            let turn = if bulge > 0.0 { Turn::Left } else { Turn::Right };
            ring.vertices[i].link = Link::Arc(Arc { center, radius: (s.start - center).norm(), turn });
        }
    }
    Region::new(vec![ring])
}

/// Disks that do not meet.
fn circles(numbers: &mut Numbers) -> Region {
    let mut disks: Vec<(Point, f64)> = vec![];
    for _ in 0..3 + numbers.below(20) {
        let (c, a) = (Point::new(numbers.between(-6.0, 6.0), numbers.between(-6.0, 6.0)), numbers.between(0.1, 2.0));
        if disks.iter().all(|(d, b)| (c - d).norm() > a + b + 1e-3) {
            disks.push((c, a));
        }
    }
    Region::new(disks.iter().map(|&(c, a)| Ring::circle(c, a)).collect())
}

/// A row of disks at distances of exactly one diameter of the rolling disk, or near it.
fn touching_free_disk(numbers: &mut Numbers) -> Region {
    let (mut x, mut rings) = (0.0, vec![]);
    let mut before = 0.0;
    for _ in 0..2 + numbers.below(5) {
        let a = 0.25 * (1 + numbers.below(12)) as f64;
        x += before + a + [2.0, 2.0, 1.5, 2.5][numbers.below(4)];
        rings.push(Ring::circle(Point::new(x, 0.0), a));
        before = a;
    }
    Region::new(rings)
}

/// A plate with round holes, some of exactly the size of the disk.
fn bored_plate(numbers: &mut Numbers) -> Region {
    let mut holes: Vec<(Point, f64)> = vec![];
    for _ in 0..2 + numbers.below(10) {
        let c = Point::new(numbers.between(-5.0, 5.0), numbers.between(-3.0, 3.0));
        let a = [1.0, 0.5, 1.5, numbers.between(0.1, 2.0)][numbers.below(4)];
        if holes.iter().all(|(d, b)| (c - d).norm() > a + b + 1e-3) {
            holes.push((c, a));
        }
    }
    let mut rings = vec![shapes::rectangle(-8.0, -6.0, 8.0, 6.0)];
    rings.extend(holes.iter().map(|&(c, a)| Ring::circle(c, a).reversed()));
    Region::new(rings)
}

/// Parts in holes of parts.
fn nested(numbers: &mut Numbers) -> Region {
    let mut size = numbers.between(1.0, 2.0);
    let mut rings = vec![];
    for k in 0..2 + numbers.below(5) {
        let square = numbers.unit() < 0.5;
        let ring = if square {
            shapes::rectangle(-size, -size, size, size)
        } else {
            Ring::circle(Point::new(numbers.between(-0.05, 0.05), 0.0), size)
        };
        rings.push(ring);
        // A square's corner is farther than its side.
        size = size * if square { 1.45 } else { 1.0 } + 0.1 + [0.9, 1.9, numbers.between(0.1, 3.0)][k % 3];
    }
    // The outermost is solid; then they alternate.
    let n = rings.len();
    let turned = rings.into_iter().enumerate();
    Region::new(turned.map(|(k, r)| if (n - 1 - k).is_multiple_of(2) { r } else { r.reversed() }).collect())
}

fn apply(case: &Case, topology: Topology) -> Outcome {
    let run = if case.operation == Operation::Close { rolling::close } else { rolling::open };
    run(&case.input, laws::radius(case.r), topology)
}

fn judge(case: &Case, number: u64) -> Findings {
    let Case { name, input, r, operation } = case;
    let (r, operation) = (*r, *operation);
    let mut found = Findings::default();
    if input.is_empty() || laws::crossing(input, r).is_some() {
        found.input_refused = true;
        return found;
    }
    let start = Instant::now();
    let merged = apply(case, Topology::Merge);
    let kept = apply(case, Topology::Keep);
    found.rolling = start.elapsed();
    found.contradictions = merged.contradictions;
    let bounds = input.bounds();
    let largest = bounds.min.coords.amax().max(bounds.max.coords.amax());
    // Coordinates themselves are known to their last place.
    let rounding = 4.0 * f64::EPSILON * largest;
    let mut wrong = vec![];
    for (mode, outcome) in [("merge", &merged), ("keep", &kept)] {
        if !laws::is_finite(&outcome.region) {
            wrong.push(format!("finite: {mode}, {name}: a coordinate is not finite"));
            continue;
        }
        let (violation, place) = laws::containment(input, &outcome.region, operation, r);
        if violation > CONTAINMENT * r + rounding {
            wrong.push(format!("containment: {mode}, {name}: {:.2e} r at {place:?}", violation / r));
        }
        let misplaced = laws::misplaced_identities(input, &outcome.region);
        if misplaced > 0 {
            wrong.push(format!("identity: {mode}, {name}: {misplaced} vertices stand elsewhere"));
        }
        let tightest = laws::tightest(&outcome.region, operation);
        if tightest < r * (1.0 - ACCURACY) {
            wrong.push(format!("radius: {mode}, {name}: an arc of {} r", tightest / r));
        }
    }
    let (_, lost) = laws::lost_vertices(input, &merged.region, operation, 1e-9 * r + rounding);
    if let Some(place) = laws::truly_still(lost, input, operation, r).first() {
        wrong.push(format!("kept: {name}: the vertex {place:?} is lost"));
    }
    for (mode, outcome) in [("merge", &merged), ("keep", &kept)] {
        if let Some(place) = laws::crossing(&outcome.region, r) {
            wrong.push(format!("crossing: {mode}, {name}: at {place:?}, {} contradictions", outcome.contradictions));
        }
    }
    if kept.differences.is_empty() {
        found.kept_proved = true;
        let (d, place) = laws::hausdorff(&merged.region, &kept.region, r);
        if d > ACCURACY * r {
            wrong.push(format!("keep: {name}: {:.2e} r from merge at {place:?} and no difference told", d / r));
        }
    }
    let start = Instant::now();
    let reference = reference::closing(input, laws::radius(r), operation);
    found.reference = start.elapsed();
    let arbiter = std::cell::OnceCell::new();
    let arbiter = || arbiter.get_or_init(|| Arbiter::new(input, operation, r));
    match reference {
        Ok(reference) => {
            let (d, place) = laws::hausdorff(&merged.region, &reference.region, r);
            found.distance_over_r = d / r;
            found.agreed = d <= ACCURACY * r;
            if !found.agreed {
                let ours = arbiter().fault_against(&merged.region, &reference.region, 0.5 * ACCURACY * r, PLACES);
                let theirs = arbiter().fault_against(&reference.region, &merged.region, 0.5 * ACCURACY * r, PLACES);
                match (ours, theirs) {
                    (Some(fault), theirs) => wrong.push(format!(
                        "answer: {name}: {:.2e} r from the reference at {place:?}; {:.2e} r: {:?} {}; reference {}; {} contradictions",
                        d / r,
                        fault.error / r,
                        fault.place,
                        fault.what,
                        if theirs.is_some() { "wrong too" } else { "right" },
                        merged.contradictions
                    )),
                    (None, Some(_)) => found.reference_wrong = true,
                    (None, None) => found.undecided = true,
                }
            }
        }
        Err(ReferenceError::NotCertified { .. }) => found.refused = true,
        Err(error) => wrong.push(format!("case: {name}: {error}")),
    }
    if found.refused || number.is_multiple_of(SPOT_CHECK) {
        found.spot_checked = !found.refused;
        if let Some(fault) = arbiter().fault(&merged.region, PLACES) {
            wrong.push(format!(
                "distances: {name}: {:.2e} r: {:?} {}; {} contradictions",
                fault.error / r,
                fault.place,
                fault.what,
                merged.contradictions
            ));
        }
    }
    found.wrong = wrong;
    found
}
