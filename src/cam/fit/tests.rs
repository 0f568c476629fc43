use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::cam::offset;
use crate::cam::test_shapes::{filled, largest_corner, p, rounded_l, wavy, wavy_offset};
use crate::plane::{BoundaryIndex, Region};

/// The most that `fitted` comes nearer to the part than `path`, the most it goes farther, in that order.
fn deviation(fitted: &Ring, region: &Region, distance: f64) -> (f64, f64) {
    let index = BoundaryIndex::new(region);
    let mut worst = (0f64, 0f64);
    for s in fitted.segments() {
        let count = (s.length() / 0.01).ceil().clamp(4.0, 1e4) as usize;
        for k in 0..=count {
            let d = index.distance(s.point_at(k as f64 / count as f64)) - distance;
            worst = (worst.0.max(-d), worst.1.max(d));
        }
    }
    worst
}

#[test]
fn true_lines_and_arcs_pass_unchanged() {
    let path = offset(&rounded_l(3.0), 2.0).unwrap();
    assert_eq!(fit_arcs(&path.rings[0]), path.rings[0]);
    assert_eq!(fit_arcs(&Ring::default()), Ring::default());
}

#[test]
fn a_flattened_circle_becomes_a_circle() {
    for (ring, distance, radius) in
        [(wavy(10.0, 0.0, 0.0, 400), 1.5, 11.5), (wavy(10.0, 0.0, 0.0, 400).reversed(), 1.5, 8.5)]
    {
        let path = offset(&Region::new(vec![ring]), distance).unwrap();
        let fitted = fit_arcs(&path.rings[0]);
        assert!(fitted.len() <= 8, "{} elements", fitted.len());
        for s in fitted.segments() {
            let Link::Arc(arc) = s.link else { panic!("{s:?} is no arc") };
            // The mitred hole is wider than the circle by the sagitta of its chords, 3e-4.
            assert!((arc.radius - radius).abs() < 4e-4 && (arc.center - Point::origin()).norm() < 1e-3);
        }
    }
}

#[test]
fn smooth_curves_become_few_arcs_within_tolerance_and_without_corners() {
    for (lobes, depth, count) in [(5.0, 0.2, 4000), (3.0, 0.1, 1500), (2.0, 0.3, 3000)] {
        for hole in [false, true] {
            let ring = wavy(20.0, depth, lobes, count);
            let ring = if hole { ring.reversed() } else { ring };
            let region = Region::new(vec![ring]);
            let path = offset(&region, 1.0).unwrap();
            let fitted = fit_arcs(&path.rings[0]);
            assert!(fitted.len() * 10 < count, "{} elements for {count} chords", fitted.len());
            assert!(largest_corner(&fitted) < 1e-6, "a corner of {}", largest_corner(&fitted));
            let (nearer, farther) = deviation(&fitted, &region, 1.0);
            assert!(nearer <= ARC_FIT_TOLERANCE * (1.0 + 1e-9), "{nearer}");
            assert!(farther <= ARC_FIT_TOLERANCE + LARGEST_BULGE, "{farther}");
            // Against the curve itself, not its chords.
            let sign = if hole { -1.0 } else { 1.0 };
            let exact = (0..60_000).map(|k| wavy_offset(20.0, depth, lobes, f64::from(k) * PI / 30_000.0, sign));
            let index = BoundaryIndex::new(&Region::new(vec![Ring::polygon(exact)]));
            let points = fitted.segments().flat_map(|s| (0..50).map(move |k| s.point_at(f64::from(k) / 50.0)));
            let worst = points.map(|q| index.distance(q)).fold(0.0, f64::max);
            assert!(worst < 2.0 * ARC_FIT_TOLERANCE, "{worst}");
        }
    }
}

#[test]
fn a_smooth_stretch_between_corners_is_fitted_alone() {
    // A half disk: its round side by chords, its straight side with two real corners.
    let mut ring = wavy(10.0, 0.0, 0.0, 400);
    ring.vertices.truncate(201);
    ring.vertices[0].joint = Joint::Corner;
    ring.vertices[200].joint = Joint::Corner;
    let region = Region::new(vec![ring]);
    let path = offset(&region, 2.0).unwrap();
    let fitted = fit_arcs(&path.rings[0]);
    assert!(fitted.len() < 20, "{}", fitted.len());
    let longest_line = fitted.segments().filter(|s| s.link == Link::Line).map(|s| s.length()).fold(0.0, f64::max);
    assert!((longest_line - 20.0).abs() < 1e-9);
    let (nearer, farther) = deviation(&fitted, &region, 2.0);
    assert!(nearer <= ARC_FIT_TOLERANCE && farther <= ARC_FIT_TOLERANCE + LARGEST_BULGE, "{nearer} {farther}");
    assert!(largest_corner(&fitted) < 1e-6);
}

#[test]
fn coarse_polygons_marked_smooth_are_no_curves() {
    // Chords with a sagitta of a tenth of a millimetre.
    let region = Region::new(vec![wavy(10.0, 0.0, 0.0, 24)]);
    let path = offset(&region, 1.0).unwrap();
    let (nearer, farther) = deviation(&fit_arcs(&path.rings[0]), &region, 1.0);
    assert!(nearer < 1e-9 && farther < 1e-9, "{nearer} {farther}");
}

#[test]
fn collinear_links_are_joined() {
    let ring = filled(&[p(0.0, 0.0), p(5.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)], 0.0);
    let path = offset(&Region::new(vec![ring]), 1.0).unwrap();
    assert_eq!(fit_arcs(&path.rings[0]).len(), 8);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Samples at uneven distances, and a little off any curve.
    #[test]
    fn the_part_is_safe_from_uneven_samples(
        steps in proptest::collection::vec((0.05..1.0f64, -1.0..1.0f64), 100..600), noise in 0.0..4e-4f64, hole: bool,
    ) {
        let whole: f64 = steps.iter().map(|s| s.0).sum();
        let mut angle = 0.0;
        let vertices = steps.iter().map(|(step, off)| {
            angle += 2.0 * PI * step / whole;
            let point = wavy_offset(12.0, 0.08, 3.0, angle, noise * off);
            crate::plane::Vertex { joint: Joint::Smooth, ..crate::plane::Vertex::corner(point) }
        });
        let ring = Ring { vertices: vertices.collect() };
        let region = Region::new(vec![if hole { ring.reversed() } else { ring }]);
        let Ok(path) = offset(&region, 1.0) else { return Ok(()) };
        let fitted = fit_arcs(&path.rings[0]);
        let (before, after) = (deviation(&path.rings[0], &region, 1.0), deviation(&fitted, &region, 1.0));
        prop_assert!(after.0 <= before.0 + ARC_FIT_TOLERANCE * 1.000001, "{:?} {:?}", before, after);
        prop_assert!(after.1 <= before.1 + ARC_FIT_TOLERANCE + LARGEST_BULGE, "{:?} {:?}", before, after);
    }

    /// Whatever the curve and its sampling, the part is not cut by more than the tolerance.
    #[test]
    fn the_part_is_safe(size in 5.0..40.0f64, depth in 0.0..0.15f64, lobes in 0..5u8, count in 30..1500usize, d in 0.2..1.5f64, hole: bool) {
        let ring = wavy(size, depth, f64::from(lobes), count);
        let region = Region::new(vec![if hole { ring.reversed() } else { ring }]);
        let Ok(path) = offset(&region, d) else { return Ok(()) };
        let fitted = fit_arcs(&path.rings[0]);
        let (nearer, farther) = deviation(&fitted, &region, d);
        let (near_before, far_before) = deviation(&path.rings[0], &region, d);
        prop_assert!(nearer <= near_before + ARC_FIT_TOLERANCE * 1.000001, "{} {}", nearer, near_before);
        prop_assert!(farther <= far_before + ARC_FIT_TOLERANCE + LARGEST_BULGE, "{} {}", farther, far_before);
        prop_assert!(fitted.len() <= path.rings[0].len());
    }
}
