use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::cam::test_shapes::{filled, p, plate, rounded_l, star, wavy, wavy_offset};
use crate::plane::Vector;

/// The smallest and the largest distance of the path from the region, densely sampled.
fn distances(path: &Region, region: &Region) -> (f64, f64) {
    let index = BoundaryIndex::new(region);
    let mut range = (f64::INFINITY, 0f64);
    for s in path.segments() {
        for k in 0..=16 {
            let d = index.distance(s.point_at(f64::from(k) / 16.0));
            range = (range.0.min(d), range.1.max(d));
        }
    }
    range
}

#[test]
fn a_square_grows_arcs_at_its_corners() {
    let square = Region::new(vec![Ring::polygon([p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)])]);
    let path = offset(&square, 2.0).unwrap();
    let ring = &path.rings[0];
    assert_eq!(ring.len(), 8);
    // Steiner: A + P d + π d².
    assert!((path.area() - (100.0 + 80.0 + 4.0 * PI)).abs() < 1e-12);
    assert!((path.perimeter() - (40.0 + 4.0 * PI)).abs() < 1e-12);
    let arcs: Vec<Arc> =
        ring.vertices.iter().filter_map(|v| if let Link::Arc(a) = v.link { Some(a) } else { None }).collect();
    assert_eq!(arcs.len(), 4);
    for arc in arcs {
        assert_eq!((arc.radius, arc.turn), (2.0, Turn::Left));
        assert!(square.rings[0].vertices.iter().any(|v| v.point == arc.center));
    }
}

#[test]
fn concave_arcs_shrink_and_vanish() {
    let path = offset(&rounded_l(3.0), 2.0).unwrap();
    let fillets: Vec<Arc> = path.rings[0]
        .vertices
        .iter()
        .filter_map(|v| if let Link::Arc(a) = v.link { Some(a) } else { None })
        .filter(|a| a.turn == Turn::Right)
        .collect();
    assert_eq!(fillets.len(), 1);
    assert!((fillets[0].radius - 1.0).abs() < 1e-12);
    // Tight: the path has a corner at the centre of the fillet.
    let tight = rounded_l(2.0);
    let path = offset(&tight, 2.0).unwrap();
    assert!(path.rings[0].vertices.iter().any(|v| (v.point - p(12.0, 12.0)).norm() < 1e-12));
    assert_eq!(path.rings[0].len(), 11);
    let (near, far) = distances(&path, &tight);
    assert!((near - 2.0).abs() < 1e-12 && (far - 2.0).abs() < 1e-12, "{near} {far}");
}

#[test]
fn holes_shrink_by_the_same_rule_and_one_as_large_as_the_tool_is_a_point() {
    let path = offset(&plate(2, 1, 3.0), 1.5).unwrap();
    assert!((path.rings[1].area() + PI * 1.5 * 1.5).abs() < 1e-12);
    let drill = offset(&plate(2, 1, 1.5), 1.5).unwrap();
    assert_eq!(drill.rings[1].len(), 1);
    assert!((drill.rings[1].vertices[0].point - p(6.0, 6.0)).norm() < 1e-12);
    assert!(matches!(offset(&plate(2, 1, 1.4), 1.5), Err(OffsetError::TooTight { radius, .. }) if radius == 1.4));
}

/// Two disks of radius 10 that overlap, the notches between them filled by arcs of `radius`; turned and moved.
fn two_disks(radius: f64, turned: f64, moved: Vector) -> Region {
    let fillet = p(0.0, ((10.0 + radius) * (10.0 + radius) - 64.0).sqrt());
    let place = |q: Point| {
        let (sin, cos) = turned.sin_cos();
        Point::new(cos * q.x - sin * q.y, sin * q.x + cos * q.y) + moved
    };
    // Where the upper fillet touches the right disk.
    let t = p(8.0, 0.0) + (fillet - p(8.0, 0.0)) * (10.0 / (10.0 + radius));
    let arc = |from: Point, center: Point, radius: f64, turn: Turn| Vertex {
        link: Link::Arc(Arc { center: place(center), radius, turn }),
        ..Vertex::corner(place(from))
    };
    Region::new(vec![Ring {
        vertices: vec![
            arc(p(t.x, -t.y), p(8.0, 0.0), 10.0, Turn::Left),
            arc(p(18.0, 0.0), p(8.0, 0.0), 10.0, Turn::Left),
            arc(t, fillet, radius, Turn::Right),
            arc(p(-t.x, t.y), p(-8.0, 0.0), 10.0, Turn::Left),
            arc(p(-18.0, 0.0), p(-8.0, 0.0), 10.0, Turn::Left),
            arc(p(-t.x, -t.y), p(0.0, -fillet.y), radius, Turn::Right),
        ],
    }])
}

#[test]
fn arcs_that_touch_stay_joined_without_tiny_elements() {
    for (turned, moved) in [(0.0, Vector::zeros()), (0.7, Vector::new(1e4, -3e3))] {
        for (radius, count) in [(3.0, 6), (2.0, 4)] {
            let region = two_disks(radius, turned, moved);
            let path = offset(&region, 2.0).unwrap();
            assert_eq!(path.rings[0].len(), count);
            let radii: Vec<f64> = path.rings[0]
                .vertices
                .iter()
                .filter_map(|v| if let Link::Arc(a) = v.link { Some(a.radius) } else { None })
                .collect();
            assert!(radii.iter().all(|r| *r == 12.0 || *r == 1.0), "{radii:?}");
            let (near, far) = distances(&path, &region);
            assert!((near - 2.0).abs() < 1e-10 && (far - 2.0).abs() < 1e-10, "{near} {far}");
        }
    }
}

#[test]
fn the_path_does_not_pass_a_neck() {
    // Two diamonds tip to tip, 2 apart: a disk of radius 2 does not pass, and comes to rest above and below.
    let diamond = |x: f64| Ring::polygon([p(x + 20.0, 0.0), p(x, 20.0), p(x - 20.0, 0.0), p(x, -20.0)]);
    let part = Region::new(vec![diamond(-21.0), diamond(21.0)]);
    for (radius, smallest) in [(2.0, 2.0), (2.1, 2.0), (2.3, 1.0), (2.1, 0.5)] {
        let closed =
            crate::rolling::close(&part, crate::units::Radius::new(radius).unwrap(), crate::rolling::Topology::Merge);
        let path = offset(&closed.region, smallest).unwrap();
        let (near, far) = distances(&path, &closed.region);
        let passes = smallest < 1.0;
        // Where it does not pass it follows the resting disk, which is farther from the neck.
        assert!((near - smallest).abs() < 1e-9, "{radius} {smallest}: {near}");
        assert!(far < if passes { smallest } else { radius } + 1e-9, "{radius} {smallest}: {far}");
        let concave = path.segments().filter_map(|s| match s.link {
            Link::Arc(Arc { radius, turn: Turn::Right, .. }) => Some(radius),
            _ => None,
        });
        assert!(concave.fold(f64::INFINITY, f64::min) > radius - smallest - 1e-9);
        if radius > smallest {
            for ring in &path.rings {
                for i in 0..ring.len() {
                    let before = ring.segment((i + ring.len() - 1) % ring.len());
                    let turn = crate::plane::turn_angle(before.end_tangent(), ring.segment(i).start_tangent());
                    assert!(
                        turn > -1e-6,
                        "{radius} {smallest}: a concave corner of {turn} at {}",
                        ring.vertices[i].point
                    );
                }
            }
        }
        // One path around both, or one around each where the tool passes.
        assert_eq!(path.rings.len(), if passes { 2 } else { 1 }, "{radius} {smallest}");
        assert!(path.rings.iter().all(|r| r.area() > 0.0));
    }
}

#[test]
fn what_is_not_closed_is_refused_with_the_place() {
    let sharp = rounded_l(0.0);
    let Err(OffsetError::ConcaveCorner { at, turn }) = offset(&sharp, 1.0) else { panic!("a corner passed") };
    assert_eq!(at, p(10.0, 10.0));
    assert!((turn - PI / 2.0).abs() < 1e-12);
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        assert!(matches!(offset(&sharp, bad), Err(OffsetError::InvalidDistance(_))));
    }
    // On the outline: as it is.
    assert_eq!(offset(&sharp, 0.0).unwrap(), sharp);
    assert!(offset(&Region::default(), 1.0).unwrap().is_empty());
    // Marked smooth, but tighter than the tool all around.
    let tight = Region::new(vec![wavy(1.0, 0.0, 0.0, 64).reversed()]);
    assert!(matches!(offset(&tight, 1.2), Err(OffsetError::NoRoom { .. })), "{:?}", offset(&tight, 1.2));
}

#[test]
fn samples_of_concave_curves_are_mitred_and_tight_ones_repaired() {
    let hole = Region::new(vec![wavy(8.0, 0.1, 3.0, 600).reversed()]);
    let path = offset(&hole, 2.0).unwrap();
    let (near, far) = distances(&path, &hole);
    assert!(near > 2.0 - 1e-12 && far < 2.0 + 1e-3, "{near} {far}");
    // A hole that the tool just fills: chords as tight as the tool, some of which would run backwards.
    let tight = Region::new(vec![wavy(2.0002, 0.00005, 7.0, 1000).reversed()]);
    let path = offset(&tight, 2.0).unwrap();
    let (near, _) = distances(&path, &tight);
    assert!(near > 2.0 - REPAIR_TOLERANCE, "{near}");
    assert!(path.rings[0].len() < 100, "chords that ran backwards are gone: {}", path.rings[0].len());
}

#[test]
fn tiny_links_leave_no_trace() {
    let mut ring = filled(&[p(0.0, 0.0), p(40.0, 0.0), p(40.0, 10.0), p(10.0, 10.0), p(10.0, 30.0), p(0.0, 30.0)], 3.0);
    let clean = offset(&Region::new(vec![ring.clone()]), 2.0).unwrap();
    // Slivers with a direction that is noise, one at a corner and one in the middle of a link.
    ring.vertices.insert(1, Vertex::corner(ring.vertices[1].point + Vector::new(1e-13, 2e-13)));
    ring.vertices.insert(1, Vertex::corner(p(20.0, 0.0)));
    ring.vertices.insert(2, Vertex::corner(p(20.0, 1e-13)));
    let noisy = offset(&Region::new(vec![ring]), 2.0).unwrap();
    assert_eq!(noisy.rings[0].len(), clean.rings[0].len() + 1);
    assert!((noisy.area() - clean.area()).abs() < 1e-9);
}

#[test]
fn chords_of_a_smooth_curve_stay_marked() {
    let ring = wavy(20.0, 0.2, 5.0, 2000);
    let path = offset(&Region::new(vec![ring]), 1.5).unwrap();
    assert!(path.rings[0].vertices.iter().all(|v| v.joint == Joint::Smooth));
    // The vertices of the path lie on the curve's own offset, up to the mitres.
    let exact: Vec<Point> =
        (0..40_000).map(|k| wavy_offset(20.0, 0.2, 5.0, f64::from(k) * PI / 20_000.0, 1.5)).collect();
    let index = BoundaryIndex::new(&Region::new(vec![Ring::polygon(exact)]));
    let worst = path.rings[0].vertices.iter().map(|v| index.distance(v.point)).fold(0.0, f64::max);
    assert!(worst < 2e-4, "{worst}");
}

fn radii() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(30.0..60.0f64, 3..9)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Convex shapes have Steiner's area; the offset keeps its distance everywhere.
    #[test]
    fn steiner_holds_for_convex_shapes(angles in proptest::collection::vec(0.0..std::f64::consts::TAU, 3..20), d in 0.01..30.0f64) {
        let mut angles = angles;
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
        prop_assume!(angles.len() >= 3);
        let ring = Ring::polygon(angles.iter().map(|a| p(50.0 + 20.0 * a.cos(), 20.0 * a.sin())));
        let region = Region::new(vec![ring]);
        let path = offset(&region, d).unwrap();
        let steiner = region.area() + region.perimeter() * d + PI * d * d;
        prop_assert!((path.area() - steiner).abs() < 1e-9 * steiner);
    }

    /// Closed stars: every point of the path is at the distance, whatever the radius of the fillets.
    #[test]
    fn the_path_keeps_its_distance(radii in radii(), d in 0.1..3.0f64, extra in prop_oneof![Just(0.0), 0.0..3.0f64], shift in prop_oneof![Just(0.0), Just(1e4)]) {
        let region = Region::new(vec![filled(&star(p(shift, -shift), &radii), d + extra)]);
        let path = offset(&region, d).unwrap();
        let (near, far) = distances(&path, &region);
        // Joints that count as tangent are mitred.
        let tolerance = 1e-9 * (1.0 + shift) + 0.125 * TANGENT_TURN * TANGENT_TURN * d;
        prop_assert!((near - d).abs() < tolerance && (far - d).abs() < tolerance, "{} {} {}", d, near, far);
    }
}
