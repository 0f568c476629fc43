//! The rolling disk against closed forms, and against the laws that every closing obeys.

use std::f64::consts::{FRAC_PI_4, PI};

use clopen::plane::{
    Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex, VertexId, right_normal,
};
use clopen::rolling::{Outcome, Topology, close, open};
use clopen::units::Radius;
use proptest::prelude::*;

const MERGE: Topology = Topology::Merge;
const KEEP: Topology = Topology::Keep;

fn radius(r: f64) -> Radius {
    Radius::new(r).unwrap()
}

/// A region of polygons, every vertex with an identity.
fn polygons(rings: &[&[(f64, f64)]]) -> Region {
    let mut region =
        Region::new(rings.iter().map(|r| Ring::polygon(r.iter().map(|&(x, y)| Point::new(x, y)))).collect());
    number(&mut region);
    region
}

fn number(region: &mut Region) {
    let vertices = region.rings.iter_mut().flat_map(|r| &mut r.vertices);
    for (i, v) in vertices.enumerate() {
        v.id = Some(VertexId::from_index(i));
    }
}

fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<(f64, f64)> {
    vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
}

/// Largest distance between the two boundaries, by samples of both.
fn distance(a: &Region, b: &Region) -> f64 {
    let one_way = |a: &Region, b: &Region| {
        let index = BoundaryIndex::new(b);
        a.segments().flat_map(|s| [0.0, 0.3, 0.6].map(|t| index.distance(s.point_at(t)))).fold(0.0, f64::max)
    };
    if a.is_empty() && b.is_empty() { 0.0 } else { one_way(a, b).max(one_way(b, a)) }
}

fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b} within {tolerance}");
}

fn both(region: &Region, r: f64) -> [Outcome; 2] {
    [close(region, radius(r), MERGE), close(region, radius(r), KEEP)]
}

#[test]
fn a_concave_corner_gets_a_fillet_and_every_other_vertex_stays_bit_for_bit() {
    let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)];
    let input = polygons(&[&points]);
    for outcome in both(&input, 1.5) {
        assert!(outcome.differences.is_empty());
        let ring = &outcome.region.rings[0];
        assert_eq!(ring.len(), 7);
        assert_close(outcome.region.area() - input.area(), 1.5 * 1.5 * (1.0 - FRAC_PI_4), 1e-13);
        for v in ring.vertices.iter().filter(|v| v.id.is_some()) {
            assert_eq!(v.point, input.rings[0].vertices[v.id.unwrap().index()].point);
        }
        assert_eq!(ring.vertices.iter().filter(|v| v.id.is_some()).count(), 5);
        let arcs: Vec<_> = ring.segments().filter(|s| s.link != Link::Line).collect();
        assert_eq!(arcs.len(), 1);
        assert_eq!((arcs[0].start, arcs[0].end), (Point::new(5.5, 4.0), Point::new(4.0, 5.5)));
    }
}

#[test]
fn a_slot_narrower_than_the_disk_fills_up_to_an_arc_between_its_lips() {
    let (w, r) = (1.0, 2.0);
    let points = [
        (0.0, 0.0),
        (20.0, 0.0),
        (20.0, 10.0),
        (10.0 + w, 10.0),
        (10.0 + w, 3.0),
        (10.0, 3.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ];
    let input = polygons(&[&points]);
    let half = (0.5 * w / r).asin();
    let sagging = r * r * (half - half.sin() * half.cos());
    for outcome in both(&input, r) {
        assert!(outcome.differences.is_empty());
        assert_close(outcome.region.area(), 200.0 - sagging, 1e-12);
        assert_eq!(outcome.region.rings[0].len(), 6);
    }
}

#[test]
fn a_gap_of_exactly_one_diameter_stays_open() {
    for offset in [0.0, 0.1, 1e3] {
        let a = rectangle(offset, 0.0, 4.0 + offset, 4.0);
        let b = rectangle(6.0 + offset, 0.0, 10.0 + offset, 4.0);
        let input = polygons(&[&a, &b]);
        let outcome = close(&input, radius(1.0), MERGE);
        assert_eq!(outcome.region, input, "at offset {offset}");
    }
}

#[test]
fn two_squares_nearer_than_one_diameter_merge_or_keep_apart_as_asked() {
    let (gap, r) = (1.0, 2.0);
    let input = polygons(&[&rectangle(0.0, 0.0, 4.0, 4.0), &rectangle(4.0 + gap, 0.0, 8.0 + gap, 4.0)]);
    let [merged, kept] = both(&input, r);
    let half = (0.5 * gap / r).asin();
    let sagging = r * r * (half - half.sin() * half.cos());
    assert_eq!(merged.region.rings.len(), 1);
    assert_eq!(merged.contradictions, 0);
    assert_close(merged.region.area(), 32.0 + 4.0 * gap - 2.0 * sagging, 1e-12);
    assert_eq!(kept.region, input);
    assert!(!kept.differences.is_empty(), "the two meanings differ here, and that must be said");
}

#[test]
fn two_disks_are_bridged_by_two_arcs() {
    // Centres 2d apart, radius a; the bridging disk touches both: its centre is at height h above the axis.
    let (a, d, r): (f64, f64, f64) = (3.0, 4.0, 5.0);
    let mut input = Region::new(vec![Ring::circle(Point::new(-d, 0.0), a), Ring::circle(Point::new(d, 0.0), a)]);
    number(&mut input);
    let outcome = close(&input, radius(r), MERGE);
    assert_eq!(outcome.contradictions, 0);
    assert_eq!(outcome.region.rings.len(), 1);
    let h = ((a + r) * (a + r) - d * d).sqrt();
    let angle = (d / h).atan();
    // Kite between the four centres less the sectors of the two input disks and of the two bridging disks inside it.
    let bridge = 2.0 * d * h - 2.0 * a * a * (0.5 * PI - angle) - 2.0 * r * r * angle;
    assert_close(outcome.region.area(), 2.0 * PI * a * a + bridge, 1e-11);
    let radii: Vec<f64> = outcome
        .region
        .segments()
        .filter_map(|s| match s.link {
            Link::Arc(Arc { radius, turn: Turn::Right, .. }) => Some(radius),
            _ => None,
        })
        .collect();
    assert_eq!(radii, [r, r]);
}

#[test]
fn a_hole_below_the_disk_is_filled_and_one_of_its_size_is_not() {
    let plate = rectangle(-10.0, -10.0, 10.0, 10.0);
    for (hole, stays) in [(0.999, false), (1.0, true), (1.001, true)] {
        let mut input = polygons(&[&plate]);
        input.rings.push(Ring::circle(Point::origin(), hole).reversed());
        for outcome in both(&input, 1.0) {
            assert_eq!(outcome.region.rings.len(), if stays { 2 } else { 1 }, "hole of radius {hole}");
            if stays {
                assert_eq!(outcome.region, input);
            }
        }
    }
}

#[test]
fn opening_rounds_convex_corners_and_takes_thin_parts_away() {
    let input = polygons(&[&rectangle(0.0, 0.0, 10.0, 10.0), &rectangle(20.0, 0.0, 30.0, 1.0)]);
    let outcome = open(&input, radius(1.0), MERGE);
    assert_eq!(outcome.region.rings.len(), 1);
    assert_close(outcome.region.area(), 100.0 - 4.0 * (1.0 - FRAC_PI_4), 1e-12);
}

#[test]
fn opening_a_closing_takes_its_arcs_as_they_are() {
    let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)];
    for topology in [MERGE, KEEP] {
        let closed = close(&polygons(&[&points]), radius(1.5), topology).region;
        let opened = open(&closed, radius(1.5), topology).region;
        // Five convex corners lose what one concave corner has gained.
        assert_close(closed.area() - opened.area(), 5.0 * 1.5 * 1.5 * (1.0 - FRAC_PI_4), 1e-12);
        let again = open(&opened, radius(1.5), topology).region;
        assert!(distance(&opened, &again) < 1e-12);
    }
}

#[test]
fn arcs_and_lines_meet_in_a_fillet_tangent_to_both() {
    // A plate with a half disk standing on its top side: two concave corners between line and arc.
    let (a, r): (f64, f64) = (3.0, 1.0);
    let mut input = polygons(&[&[(-10.0, -5.0), (10.0, -5.0), (10.0, 0.0), (a, 0.0), (-a, 0.0), (-10.0, 0.0)]]);
    input.rings[0].vertices[3].link = Link::Arc(Arc { center: Point::origin(), radius: a, turn: Turn::Left });
    let x = ((a + r) * (a + r) - r * r).sqrt();
    let angle = (r / x).atan();
    // Triangle below the centre of the fillet less a sector of the half disk and one of the fillet.
    let gain = 0.5 * x * r - 0.5 * a * a * angle - 0.5 * r * r * (0.5 * PI - angle);
    for outcome in both(&input, r) {
        assert!(outcome.contradictions == 0 && outcome.differences.is_empty());
        assert_close(outcome.region.area() - input.area(), 2.0 * gain, 1e-12);
        assert_eq!(outcome.region.rings[0].len(), 8);
    }
}

#[test]
fn a_concave_arc_below_the_radius_is_spanned_by_the_disk() {
    // A round notch of radius 1 in the top side.
    let mut input = polygons(&[&[(-10.0, -5.0), (10.0, -5.0), (10.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (-10.0, 0.0)]]);
    input.rings[0].vertices[3].link = Link::Arc(Arc { center: Point::origin(), radius: 1.0, turn: Turn::Right });
    let r: f64 = 2.0;
    let half = (1.0 / r).asin();
    for outcome in both(&input, r) {
        assert_close(outcome.region.area(), 100.0 - r * r * (half - half.sin() * half.cos()), 1e-12);
    }
}

#[test]
fn a_sampled_curve_that_the_disk_can_follow_does_not_move() {
    // A hole of radius 5, sampled: corners of a polygon, or samples of a smooth curve.
    let n = 200;
    for (joint, moves) in [(Joint::Corner, true), (Joint::Smooth, false)] {
        let mut hole = Ring::polygon((0..n).map(|k| {
            let angle = -std::f64::consts::TAU * f64::from(k) / f64::from(n);
            Point::new(5.0 * angle.cos(), 5.0 * angle.sin())
        }));
        hole.vertices.iter_mut().for_each(|v| v.joint = joint);
        let mut input = polygons(&[&rectangle(-9.0, -9.0, 9.0, 9.0)]);
        input.rings.push(hole);
        number(&mut input);
        for outcome in both(&input, 2.0) {
            assert_eq!(outcome.region != input, moves);
            assert!(distance(&outcome.region, &input) < 5e-4);
        }
    }
}

#[test]
fn a_part_inside_a_hole_that_the_disk_cannot_enter_is_reported_where_nothing_crosses() {
    // The disk fits the hole, but not beside the part in it; no two loci cross, one lies inside the other.
    let plate = rectangle(-20.0, -20.0, 20.0, 20.0);
    let part = rectangle(-2.0, -2.0, 2.0, 2.0);
    let mut input = polygons(&[&plate, &part]);
    input.rings.push(Ring::circle(Point::origin(), 8.0).reversed());
    let [merged, kept] = both(&input, 7.5);
    assert_eq!(merged.region.rings.len(), 1);
    assert!(!kept.differences.is_empty());
}

#[test]
fn a_hole_does_not_outlive_its_part() {
    // A washer too thin for the disk: opening takes the ring away, and its hole must go with it.
    let mut input = polygons(&[&rectangle(0.0, 0.0, 20.0, 20.0), &rectangle(40.0, 0.0, 90.0, 50.0)]);
    input.rings.push(Ring::polygon([(7., 7.), (7., 13.), (13., 13.), (13., 7.)].map(|(x, y)| Point::new(x, y))));
    for topology in [MERGE, KEEP] {
        let opened = open(&input, radius(11.0), topology);
        assert_eq!(opened.region.rings.len(), 1, "{topology:?}");
        assert!(opened.region.area() > 0.0);
        assert!(open(&input, radius(500.0), topology).region.is_empty(), "{topology:?}");
    }
}

#[test]
fn rings_that_touch_at_a_vertex_have_loci_that_coincide_and_still_close() {
    // Two thin wedges with a common apex and a common top line.
    let input = polygons(&[&[(0.0, 0.0), (-4.0, 0.0), (-3.0, -3.0)], &[(0.0, 0.0), (3.0, -3.0), (4.0, 0.0)]]);
    let outcome = close(&input, radius(1.0), MERGE);
    assert_eq!(outcome.contradictions, 0);
    assert_eq!(outcome.region.rings.len(), 1);
}

#[test]
fn an_empty_region_closes_to_nothing() {
    for topology in [MERGE, KEEP] {
        assert!(close(&Region::default(), radius(1.0), topology).region.is_empty());
    }
}

/// Parts on a grid: stars of a random outline, some with a hole.
fn parts() -> impl Strategy<Value = Region> {
    let star = (prop::collection::vec((0.2f64..1.0, 0.0f64..0.8), 5..24), any::<bool>());
    prop::collection::vec(star, 1..5).prop_map(|stars| {
        let mut rings = vec![];
        for (k, (spokes, hole)) in stars.iter().enumerate() {
            let center = Point::new(11.0 * (k % 2) as f64, 11.0 * (k / 2) as f64);
            let outline = |scale: f64| {
                Ring::polygon(spokes.iter().enumerate().map(|(i, (length, wobble))| {
                    let angle = (i as f64 + wobble) / spokes.len() as f64 * std::f64::consts::TAU;
                    center + Vector::new(angle.cos(), angle.sin()) * (5.5 * scale * length)
                }))
            };
            // Spokes more than half a turn apart make a ring that turns the wrong way.
            let outer = outline(1.0);
            if outer.area() <= 0.0 || outer.winding_number(center) != 1 {
                continue;
            }
            if *hole {
                rings.push(outline(0.6).reversed());
            }
            rings.push(outer);
        }
        let mut region = Region::new(rings);
        number(&mut region);
        region
    })
}

/// How far `inner` pokes out of `outer`.
fn outside(inner: &Region, outer: &Region) -> f64 {
    let index = BoundaryIndex::new(outer);
    let points = inner.segments().flat_map(|s| [s.start, s.point_at(0.5)]);
    points.filter(|&p| index.winding_number(p) <= 0).map(|p| index.distance(p)).fold(0.0, f64::max)
}

fn turned(region: &Region, angle: f64, scale: f64) -> Region {
    let rotation = nalgebra::Rotation2::new(angle);
    let map = |p: Point| rotation * p * scale;
    let vertex = |v: &Vertex| Vertex {
        point: map(v.point),
        link: match v.link {
            Link::Line => Link::Line,
            Link::Arc(a) => Link::Arc(Arc { center: map(a.center), radius: a.radius * scale, ..a }),
        },
        ..*v
    };
    Region::new(region.rings.iter().map(|r| Ring { vertices: r.vertices.iter().map(vertex).collect() }).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn closing_contains_its_input_and_every_point_of_it_is_touched_by_a_free_disk(input in parts(), r in 0.05f64..6.0) {
        let outcome = close(&input, radius(r), MERGE);
        prop_assert_eq!(outcome.contradictions, 0);
        prop_assert!(outside(&input, &outcome.region) <= 1e-9 * r);
        let index = BoundaryIndex::new(&input);
        for s in outcome.region.segments().filter(|s| s.length() > 1e-6 * r) {
            let p = s.point_at(0.5);
            let tangent = match s.link { Link::Line => s.start_tangent(), Link::Arc(arc) => arc.tangent_at(p) };
            let center = p + right_normal(tangent) * r;
            prop_assert!(index.distance(center) >= r * (1.0 - 3e-8), "no free disk at {p}");
        }
    }

    #[test]
    fn vertices_with_an_identity_have_not_moved(input in parts(), r in 0.05f64..6.0) {
        let originals: Vec<Point> = input.rings.iter().flat_map(|q| &q.vertices).map(|v| v.point).collect();
        for topology in [MERGE, KEEP] {
            let outcome = close(&input, radius(r), topology);
            for v in outcome.region.rings.iter().flat_map(|q| &q.vertices) {
                if let Some(id) = v.id {
                    prop_assert_eq!(v.point, originals[id.index()]);
                }
            }
        }
    }

    #[test]
    fn closing_twice_is_closing_once(input in parts(), r in 0.05f64..6.0) {
        let once = close(&input, radius(r), MERGE).region;
        let twice = close(&once, radius(r), MERGE);
        prop_assert_eq!(twice.contradictions, 0);
        prop_assert!(distance(&once, &twice.region) <= 1e-7 * r);
    }

    #[test]
    fn a_larger_disk_closes_more(input in parts(), r in 0.05f64..3.0, factor in 1.01f64..2.0) {
        let small = close(&input, radius(r), MERGE).region;
        let large = close(&input, radius(r * factor), MERGE).region;
        prop_assert!(outside(&small, &large) <= 1e-7 * r);
    }

    #[test]
    fn opening_is_the_closing_of_the_complement(input in parts(), r in 0.05f64..6.0) {
        let opened = open(&input, radius(r), MERGE).region;
        prop_assert!(outside(&opened, &input) <= 1e-9 * r);
        let dual = close(&input.reversed(), radius(r), MERGE).region.reversed();
        prop_assert_eq!(opened, dual);
    }

    #[test]
    fn where_the_locus_does_not_cross_itself_both_meanings_agree(input in parts(), r in 0.05f64..6.0) {
        let kept = close(&input, radius(r), KEEP);
        if kept.differences.is_empty() {
            let merged = close(&input, radius(r), MERGE).region;
            prop_assert!(distance(&kept.region, &merged) <= 1e-7 * r);
        }
    }

    #[test]
    fn the_start_vertex_the_angle_the_scale_and_the_place_do_not_matter(
        input in parts(), r in 0.05f64..6.0, shift in 1usize..5, angle in 0.0f64..6.0, power in -6i32..7,
    ) {
        let expected = close(&input, radius(r), MERGE).region;
        let mut rotated = input.clone();
        for ring in &mut rotated.rings {
            let n = shift % ring.len();
            ring.vertices.rotate_left(n);
        }
        prop_assert!(distance(&expected, &close(&rotated, radius(r), MERGE).region) <= 1e-7 * r);
        let scale = 10f64.powi(power);
        let there = turned(&input, angle, scale);
        let back = turned(&close(&there, radius(r * scale), MERGE).region, 0.0, 1.0 / scale);
        prop_assert!(distance(&expected, &turned(&back, -angle, 1.0)) <= 1e-7 * r);
        let far = Vector::new(1e6, -1e6);
        let away = close(&input.translated(far), radius(r), MERGE).region.translated(-far);
        prop_assert!(distance(&expected, &away) <= 1e-7 * r + 1e-8);
    }
}
