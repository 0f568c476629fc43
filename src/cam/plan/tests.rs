use proptest::prelude::*;

use super::*;
use crate::cam::Entry;
use crate::cam::lay::RAMP_SLOPE;
use crate::cam::test_shapes::{filled, p, plate, rounded_l, star, wavy};
use crate::cam::{ARC_FIT_TOLERANCE, PathRadius, Side};
use crate::plane::Segment;
use crate::plane::{BoundaryIndex, Link, Ring};

fn job() -> Job {
    Job { tool_diameter: 4.0, path_radius: PathRadius::Length(1.0), ..Job::default() }
}

/// Start and end of every move, the first aside, whose start is unknown.
fn legs(toolpath: &Toolpath) -> impl Iterator<Item = (&Move, &Move)> {
    toolpath.moves.windows(2).map(|w| (&w[0], &w[1]))
}

/// What every toolpath has to keep to.
fn assert_safe(toolpath: &Toolpath, job: &Job) {
    assert!(matches!(toolpath.moves[0].kind, MoveKind::Rapid) && toolpath.moves[0].z == job.safe_height);
    assert_eq!(toolpath.moves.last().unwrap().z, job.safe_height);
    for (a, b) in legs(toolpath) {
        match b.kind {
            MoveKind::Rapid if a.to != b.to => assert!(a.z == job.safe_height && b.z == job.safe_height),
            MoveKind::Rapid => assert!(b.z > job.stock_top),
            MoveKind::Plunge => assert!(a.to == b.to && b.z < a.z),
            MoveKind::Ramp(link) => {
                let length = Segment { start: a.to, end: b.to, link }.length();
                assert!(b.z < a.z && a.z - b.z < RAMP_SLOPE * length + 1e-6, "{} over {length}", a.z - b.z);
            }
            MoveKind::Cut(_) => assert!(a.z == b.z && b.z < job.stock_top),
        }
    }
}

/// The length cut at every height, by contour.
fn cut_lengths(toolpath: &Toolpath, contour: usize) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::new();
    for (a, b) in legs(toolpath).filter(|(_, b)| b.contour == contour) {
        if let MoveKind::Cut(link) = b.kind {
            let length = Segment { start: a.to, end: b.to, link }.length();
            match out.last_mut().filter(|(z, _)| *z == b.z) {
                Some((_, sum)) => *sum += length,
                None => out.push((b.z, length)),
            }
        }
    }
    out
}

#[test]
fn every_pass_goes_all_around_at_its_height() {
    let (job, part) = (job(), rounded_l(3.0));
    let toolpath = plan(&job, &part, &part).unwrap();
    assert_safe(&toolpath, &job);
    let whole = offset(&part, 2.0).unwrap().perimeter();
    let passes = cut_lengths(&toolpath, 0);
    assert_eq!(passes.iter().map(|(z, _)| *z).collect::<Vec<_>>(), [-1.0, -2.0, -3.0]);
    for (_, length) in passes {
        assert!((length - whole).abs() < 1e-6);
    }
}

#[test]
fn climbing_goes_clockwise_around_parts_and_counterclockwise_in_holes() {
    // A clockwise spindle that travels north has its eastern teeth moving south, with the work, where the part is: the part
    // lies to the right.
    let part = plate(2, 1, 4.0);
    for (direction, sign) in [(Direction::Climb, -1.0), (Direction::Conventional, 1.0)] {
        let job = Job { direction, entry: Entry::Plunge, depth: 1.0, ..job() };
        let toolpath = plan(&job, &part, &part).unwrap();
        assert_eq!(toolpath.part_side, if sign < 0.0 { Turn::Right } else { Turn::Left });
        for contour in 0..3 {
            let doubled: f64 = legs(&toolpath)
                .filter(|(_, b)| b.contour == contour)
                .filter_map(|(a, b)| Some(Segment { start: a.to, end: b.to, link: b.link()? }.doubled_area()))
                .sum();
            // Holes are cut first.
            let hole = if contour < 2 { -1.0 } else { 1.0 };
            assert!(doubled * sign * hole > 1.0, "contour {contour}, {direction:?}: {doubled}");
        }
    }
}

#[test]
fn inside_the_tool_stays_in_the_outline() {
    let part = Region::new(vec![Ring::circle(p(0.0, 0.0), 20.0), Ring::circle(p(0.0, 0.0), 8.0).reversed()]);
    let job = Job { side: Side::Inside, origin: Origin::Drawing, entry: Entry::Plunge, ..job() };
    let toolpath = plan(&job, &part, &job.side.kept_material(&part)).unwrap();
    assert_safe(&toolpath, &job);
    let mut radii = [0; 2];
    for m in toolpath.moves.iter().filter(|m| m.link().is_some()) {
        let r = (m.to - Point::origin()).norm();
        if (r - 18.0).abs() < 1e-9 {
            radii[0] += 1;
        } else {
            assert!((r - 10.0).abs() < 1e-9, "{r}");
            radii[1] += 1;
        }
    }
    assert!(radii[0] > 0 && radii[1] > 0);
    // On the outline itself.
    let on = Job { side: Side::On, ..job };
    let toolpath = plan(&on, &part, &part).unwrap();
    assert!(toolpath.moves.iter().any(|m| (m.to.coords.norm() - 20.0).abs() < 1e-9));
}

#[test]
fn the_origin_is_where_the_job_wants_it() {
    let part = Region::new(vec![Ring::polygon([p(10.0, 20.0), p(50.0, 20.0), p(50.0, 40.0), p(10.0, 40.0)])]);
    for (origin, low) in
        [(Origin::Corner, p(-2.0, -2.0)), (Origin::Center, p(-22.0, -12.0)), (Origin::Drawing, p(8.0, 18.0))]
    {
        let job = Job { origin, ..job() };
        let toolpath = plan(&job, &part, &part).unwrap();
        let x = toolpath.moves.iter().map(|m| m.to.x).fold(f64::INFINITY, f64::min);
        let y = toolpath.moves.iter().map(|m| m.to.y).fold(f64::INFINITY, f64::min);
        assert!((p(x, y) - low).norm() < 1e-12, "{origin:?}: {x} {y}");
    }
}

#[test]
fn small_holes_are_entered_by_a_helix_and_points_by_plunging() {
    let job = job();
    // A path of radius 0.5: 3.1 mm around, so that a ramp of 10 mm goes round three times.
    let part = plate(1, 1, 2.5);
    let toolpath = plan(&job, &part, &part).unwrap();
    assert_safe(&toolpath, &job);
    let first: Vec<&Move> = toolpath.moves.iter().filter(|m| m.contour == 0).collect();
    assert!(first.iter().filter(|m| matches!(m.kind, MoveKind::Ramp(Link::Arc(_)))).count() >= 18);
    // A hole as wide as the tool.
    let part = plate(1, 1, 2.0);
    let toolpath = plan(&job, &part, &part).unwrap();
    assert_safe(&toolpath, &job);
    let plunges: Vec<f64> =
        toolpath.moves.iter().filter(|m| m.contour == 0 && m.kind == MoveKind::Plunge).map(|m| m.z).collect();
    assert_eq!(plunges, [-1.0, -2.0, -3.0]);
}

#[test]
fn deep_passes_in_small_holes_plunge_instead_of_turning_forever() {
    let part = plate(1, 1, 2.4);
    let deep = Job { depth: 500.0, depth_per_pass: 500.0, ..job() };
    let toolpath = plan(&deep, &part, &part).unwrap();
    assert_safe(&toolpath, &deep);
    assert!(toolpath.moves.iter().all(|m| m.contour != 0 || !matches!(m.kind, MoveKind::Ramp(_))));
    // A loop smaller than a decimal is a place to drill.
    let speck = plate(1, 1, 2.000_001);
    let toolpath = plan(&job(), &speck, &speck).unwrap();
    assert!(toolpath.moves.iter().all(|m| m.contour != 0 || m.link().is_none()));
}

#[test]
fn nothing_to_cut_and_bad_jobs_are_errors() {
    let part = rounded_l(3.0);
    assert_eq!(plan(&job(), &part, &Region::default()), Err(PlanError::Empty));
    let bad = Job { depth: f64::NAN, ..job() };
    assert!(matches!(plan(&bad, &part, &part), Err(PlanError::Job(_))));
    assert!(matches!(plan(&job(), &part, &rounded_l(1.0)), Err(PlanError::Offset(OffsetError::TooTight { .. }))));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Whatever the shape, the tool keeps its radius from the part, rises where it should, and starts in no corner.
    #[test]
    fn toolpaths_are_safe(radii in proptest::collection::vec(30.0..60.0f64, 3..9), smooth: bool, ramp: bool, climb: bool) {
        let outer = filled(&star(p(0.0, 0.0), &radii), 3.0);
        let hole = if smooth { wavy(8.0, 0.1, 3.0, 500) } else { Ring::circle(p(0.0, 0.0), 8.0) };
        let part = Region::new(vec![outer, hole.reversed()]);
        let job = Job {
            entry: if ramp { Entry::Ramp } else { Entry::Plunge },
            direction: if climb { Direction::Climb } else { Direction::Conventional },
            origin: Origin::Drawing,
            ..job()
        };
        let toolpath = plan(&job, &part, &part).unwrap();
        assert_safe(&toolpath, &job);
        // Straight or convex where it enters the outer contour, which is the second.
        let entered = legs(&toolpath).find(|(_, b)| b.contour == 1 && b.link().is_some()).unwrap();
        match entered.1.link().unwrap() {
            Link::Line => {}
            Link::Arc(arc) => prop_assert_eq!(arc.turn, toolpath.part_side),
        }
        let index = BoundaryIndex::new(&part);
        for (a, b) in legs(&toolpath) {
            let Some(link) = b.link() else { continue };
            let s = Segment { start: a.to, end: b.to, link };
            for k in 0..=20 {
                let d = index.distance(s.point_at(f64::from(k) / 20.0));
                prop_assert!(d > 2.0 - ARC_FIT_TOLERANCE * 1.001, "{}", d);
            }
        }
        // All of the path is cut, at every height.
        let whole = offset(&part, 2.0).unwrap().perimeter();
        let cut: f64 = (0..2).flat_map(|c| cut_lengths(&toolpath, c)).filter(|(z, _)| *z == -3.0).map(|(_, l)| l).sum();
        prop_assert!((cut - whole).abs() < 0.01, "{} {}", cut, whole);
    }
}
