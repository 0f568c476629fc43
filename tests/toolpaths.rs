//! From any outline to a program that is read back: closing, toolpath, text, rules. All by public functions.

use std::f64::consts::TAU;

use clopen::cam::{Direction, Entry, Job, MotionKind, Origin, PathRadius, Side, plan};
use clopen::gcode::{Dialect, LintOptions, Units, WriteOptions, lint, read, write};
use clopen::plane::{Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Segment, Vertex};
use clopen::rolling::{Topology, close};
use clopen::units::Radius;
use proptest::prelude::*;

/// What a program may cut into the part, in millimetres.
const LARGEST_GOUGE: f64 = 0.002;

/// A jagged outline: one radius a ray.
fn jagged(center: Point, radii: &[f64]) -> Ring {
    let n = radii.len() as f64;
    Ring::polygon(radii.iter().enumerate().map(|(k, r)| {
        let angle = TAU * k as f64 / n;
        Point::new(center.x + r * angle.cos(), center.y + r * angle.sin())
    }))
}

/// A smooth outline by chords: waves of the given heights on a circle.
fn smooth(center: Point, size: f64, waves: &[f64], count: usize) -> Ring {
    let at = |k: usize| {
        let angle = TAU * k as f64 / count as f64;
        let sum: f64 = waves.iter().enumerate().map(|(n, h)| h * ((n + 2) as f64 * angle + h * 7.0).sin()).sum();
        let r = size * (1.0 + sum);
        Point::new(center.x + r * angle.cos(), center.y + r * angle.sin())
    };
    Ring { vertices: (0..count).map(|k| Vertex { joint: Joint::Smooth, ..Vertex::corner(at(k)) }).collect() }
}

fn outline() -> impl Strategy<Value = Region> {
    let jagged_ring = proptest::collection::vec(15.0..60.0f64, 5..40).prop_map(|r| jagged(Point::origin(), &r));
    let smooth_ring = (20.0..60.0f64, proptest::collection::vec(-0.08..0.08f64, 1..9), 100..2500usize)
        .prop_map(|(size, waves, count)| smooth(Point::origin(), size, &waves, count));
    let hole = prop_oneof![
        (1.0..7.0f64).prop_map(|r| Some(Ring::circle(Point::origin(), r).reversed())),
        proptest::collection::vec(4.0..9.0f64, 4..12).prop_map(|r| Some(jagged(Point::origin(), &r).reversed())),
        (4.0..8.0f64, proptest::collection::vec(-0.06..0.06f64, 1..6), 100..600usize)
            .prop_map(|(size, waves, count)| Some(smooth(Point::origin(), size, &waves, count).reversed())),
        Just(None),
    ];
    let neighbour = proptest::option::of((61.0..75.0f64, 3..40usize));
    (prop_oneof![jagged_ring, smooth_ring], hole, neighbour).prop_map(|(outer, hole, neighbour)| {
        let mut rings = vec![outer];
        rings.extend(hole);
        // A polygon beside it, on a circle that the outline does not reach.
        let beside = neighbour.map(|(x, n)| jagged(Point::new(x + 20.0, 0.0), &vec![15.0; n]));
        let reach = rings[0].vertices.iter().map(|v| v.point.coords.norm()).fold(0.0, f64::max);
        rings.extend(beside.filter(|b| b.bounds().min.x > reach));
        Region::new(rings)
    })
}

fn job() -> impl Strategy<Value = Job> {
    let path_radius =
        prop_oneof![Just(PathRadius::Length(0.0)), Just(PathRadius::Auto), (0.0..2.0f64).prop_map(PathRadius::Length)];
    (1.0..6.0f64, path_radius, any::<bool>(), any::<bool>(), any::<bool>()).prop_map(
        |(tool_diameter, path_radius, inside, climb, ramp)| Job {
            tool_diameter,
            path_radius,
            side: if inside { Side::Inside } else { Side::Outside },
            direction: if climb { Direction::Climb } else { Direction::Conventional },
            entry: if ramp { Entry::Ramp } else { Entry::Plunge },
            origin: Origin::Drawing,
            ..Job::default()
        },
    )
}

/// The deepest cut of a program into what stays.
fn gouge(text: &str, kept: &Region, radius: f64) -> f64 {
    let index = BoundaryIndex::new(kept);
    let mut deepest = 0f64;
    for motion in read(text).unwrap().motions.iter().filter(|m| m.to.z < 0.0) {
        let (start, end) = (Point::new(motion.from.x, motion.from.y), Point::new(motion.to.x, motion.to.y));
        let link = match motion.kind {
            MotionKind::Arc { center, turn, .. } => Link::Arc(Arc { center, radius: (start - center).norm(), turn }),
            _ => Link::Line,
        };
        let segment = Segment { start, end, link };
        let count = (segment.length() / 0.1).ceil().clamp(1.0, 500.0) as usize;
        for k in 0..=count {
            deepest = deepest.max(radius - index.distance(segment.point_at(k as f64 / count as f64)));
        }
    }
    deepest
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    /// Whatever the outline and the job, the program breaks no rule of its controller and spares the part.
    #[test]
    fn any_outline_becomes_a_program_that_spares_it(
        part in outline(), job in job(), dialect in 0..Dialect::built_in().len(), inches: bool,
    ) {
        let kept = job.side.kept_material(&part);
        let closed = close(&kept, Radius::new(job.closing_radius()).unwrap(), Topology::Merge).region;
        if closed.is_empty() {
            return Ok(());
        }
        let toolpath = plan(&job, &part, &closed).map_err(|e| TestCaseError::fail(e.to_string()))?;
        let dialect = &Dialect::built_in()[dialect];
        let units = if inches && dialect.units.contains(&Units::Inches) { Units::Inches } else { Units::Millimetres };
        let text = write(&toolpath, &job.summary(), dialect, WriteOptions { units, ..WriteOptions::default() }).unwrap();
        let findings = lint(&text, &LintOptions { dialect, stock_top: job.stock_top });
        prop_assert!(findings.is_empty(), "{}: {:?}", dialect.name, findings);
        // Without depth there is no telling what is in the stock.
        if !dialect.has_depth() {
            return Ok(());
        }
        let deepest = gouge(&text, &kept, 0.5 * job.tool_diameter);
        prop_assert!(deepest <= LARGEST_GOUGE, "{} mm", deepest);
    }
}
