use super::*;
use crate::plane::{Arc, Link, Point, Region, Turn, Vertex, VertexId};

fn polygon(points: &[(f64, f64)]) -> Ring {
    let vertex = |(k, &(x, y))| Vertex { id: Some(VertexId::from_index(k)), ..Vertex::corner(Point::new(x, y)) };
    Ring { vertices: points.iter().enumerate().map(vertex).collect() }
}

fn square(x: f64, y: f64, side: f64) -> Ring {
    polygon(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)])
}

fn resolved(rings: Vec<Ring>, rule: Rule) -> Region {
    Region::new(resolve(rings, rule))
}

#[test]
fn rings_apart_pass_through_unchanged() {
    let rings = vec![square(0.1, 0.2, 5.0), square(1.3, 1.3, 1.0), square(7.7, 0.0, 1.0)];
    let result = resolved(rings.clone(), Rule::EvenOdd);
    assert_eq!(result.rings[0], rings[0]);
    assert_eq!(result.rings[1], rings[1].reversed());
    assert_eq!(result.rings[2], rings[2]);
    let result = resolved(rings, Rule::NonZero);
    assert_eq!(result.topology(), crate::plane::TopologyCount { components: 2, holes: 0 });
}

#[test]
fn overlapping_squares_unite_and_intersect_with_their_corners_kept() {
    let rings = vec![square(0.1, 0.1, 3.0), square(2.1, 1.3, 3.0)];
    for (rule, area) in [
        (Rule::NonZero, 18.0 - 1.8),
        (Rule::AtLeast(1), 18.0 - 1.8),
        (Rule::AtLeast(2), 1.8),
        (Rule::EvenOdd, 18.0 - 3.6),
    ] {
        let result = resolved(rings.clone(), rule);
        assert!((result.area() - area).abs() < 1e-12, "{rule:?} {}", result.area());
        let given: Vec<Point> = rings.iter().flat_map(|r| r.vertices.iter().map(|v| v.point)).collect();
        let vertices = result.rings.iter().flat_map(|r| &r.vertices);
        assert!(vertices.clone().all(|v| v.id.is_some() == given.contains(&v.point)));
        assert!(vertices.filter(|v| v.id.is_none()).count() >= 2);
    }
}

#[test]
fn what_lies_around_a_crossing_counts() {
    // Two overlapping squares inside a third: under the nonzero rule nothing of them is left.
    let nested = || vec![square(0.0, 0.0, 10.0), square(1.0, 1.0, 3.0), square(2.0, 2.0, 3.0)];
    assert_eq!(resolved(nested(), Rule::NonZero).rings.len(), 1);
    let odd = resolved(nested(), Rule::EvenOdd);
    assert!((odd.area() - 90.0).abs() < 1e-9, "{}", odd.area());
    assert!((resolved(nested(), Rule::AtLeast(2)).area() - 14.0).abs() < 1e-9);
    assert!((resolved(nested(), Rule::AtLeast(3)).area() - 4.0).abs() < 1e-9);
}

#[test]
fn a_star_follows_its_rule() {
    let star = || vec![polygon(&[(50.0, -5.0), (76.45, -86.41), (7.2, -36.1), (92.8, -36.1), (23.55, -86.41)])];
    let odd = resolved(star(), Rule::EvenOdd);
    assert_eq!((odd.rings.len(), odd.topology().holes), (5, 0));
    assert!(odd.rings.iter().all(|r| r.len() == 3));
    let whole = resolved(star(), Rule::NonZero);
    assert_eq!((whole.rings.len(), whole.rings[0].len()), (1, 10));
    assert_eq!(whole.rings[0].vertices.iter().filter(|v| v.id.is_some()).count(), 5);
}

#[test]
fn circles_that_overlap_keep_their_arcs() {
    let rings = vec![Ring::circle(Point::new(0.0, 0.0), 5.0), Ring::circle(Point::new(6.0, 0.0), 5.0)];
    let lens = 2.0 * (25.0 * 0.6f64.acos() - 12.0);
    for (rule, area) in [(Rule::AtLeast(1), 50.0 * std::f64::consts::PI - lens), (Rule::AtLeast(2), lens)] {
        let result = resolved(rings.clone(), rule);
        assert!((result.area() - area).abs() < 1e-12 * area, "{} {area}", result.area());
        let cuts = result.rings[0].vertices.iter().filter(|v| (v.point.x - 3.0).abs() < 1e-14);
        assert_eq!(cuts.filter(|v| (v.point.y.abs() - 4.0).abs() < 1e-14).count(), 2);
        assert!(result.rings[0].vertices.iter().all(|v| v.link != Link::Line));
    }
}

#[test]
fn the_same_ring_twice_is_the_ring() {
    for ring in [square(0.3, 0.7, 1.1), Ring::circle(Point::new(0.3, 0.7), 1.1)] {
        let result = resolve(vec![ring.clone(), ring.clone()], Rule::AtLeast(1));
        assert_eq!(result.len(), 1);
        assert!((result[0].area() - ring.area()).abs() < 1e-13);
        let same = |v: &Vertex| ring.vertices.iter().any(|w| w.point == v.point && w.link == v.link);
        assert!(result[0].vertices.iter().all(same), "{result:?}");
        assert_eq!(result[0].len(), ring.len());
    }
}

#[test]
fn a_circle_cut_by_a_line_through_its_centre() {
    let half = polygon(&[(-9.0, 0.0), (9.0, 0.0), (9.0, 9.0), (-9.0, 9.0)]);
    let result = resolve(vec![half, Ring::circle(Point::new(0.0, 0.0), 2.0)], Rule::AtLeast(2));
    assert_eq!(result.len(), 1);
    assert!((result[0].area() - 2.0 * std::f64::consts::PI).abs() < 1e-12);
    let arc = Arc { center: Point::new(0.0, 0.0), radius: 2.0, turn: Turn::Left };
    assert_eq!(result[0].vertices.iter().filter(|v| v.link == Link::Arc(arc)).count(), 2);
}

#[test]
fn squares_that_share_a_side_become_one() {
    let result = resolve(vec![square(0.0, 0.0, 1.0), square(1.0, 0.0, 1.0)], Rule::AtLeast(1));
    assert_eq!(result.len(), 1);
    assert_eq!(result[0].area(), 2.0);
    // Touching in a corner: two rings.
    let result = resolve(vec![square(0.0, 0.0, 1.0), square(1.0, 1.0, 1.0)], Rule::AtLeast(1));
    assert_eq!(result.len(), 2);
}

#[test]
fn lines_there_and_back_vanish() {
    let spike = polygon(&[(30.0, 30.0), (40.0, 30.0), (30.0, 30.0)]);
    let line = polygon(&[(0.0, 0.0), (1.0, 1.0)]);
    assert_eq!(resolve(vec![spike, line], Rule::NonZero), []);
}

/// Areas of random sets of polygons and circles against those of the overlay on flattened outlines.
#[test]
fn random_outlines_have_the_area_of_their_polygons() {
    use i_overlay::core::fill_rule::FillRule;
    use i_overlay::float::simplify::SimplifyShape;
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut crossings = 0;
    for case in 0..200 {
        // Every third case on a coarse grid, where contacts and overlaps are exact.
        let snap = |x: f64| if case % 3 == 0 { (x * 2.0).round() / 2.0 } else { x };
        let offset = if case % 5 == 0 { 1e6 } else { 0.0 };
        let mut rings = Vec::new();
        for _ in 0..2 + (random() * 5.0) as usize {
            let center = Point::new(offset + snap(random() * 8.0), snap(random() * 8.0));
            let ring = if random() < 0.5 {
                Ring::circle(center, snap(0.5 + random() * 3.0))
            } else {
                let n = 3 + (random() * 6.0) as usize;
                let corner =
                    || Point::new(snap(center.x - 3.0 + random() * 6.0), snap(center.y - 3.0 + random() * 6.0));
                Ring::polygon(std::iter::repeat_with(corner).take(n))
            };
            rings.push(if random() < 0.3 { ring.reversed() } else { ring });
        }
        let flat: Vec<Vec<[f64; 2]>> =
            rings.iter().map(|r| r.flatten(3e-8).iter().map(|p| [p.x - offset, p.y]).collect()).collect();
        for (rule, fill) in [(Rule::NonZero, FillRule::NonZero), (Rule::EvenOdd, FillRule::EvenOdd)] {
            let result = resolve(rings.clone(), rule);
            let area: f64 = result.iter().map(Ring::area).sum();
            let polygon = |c: &Vec<[f64; 2]>| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1]))).area();
            let expected: f64 = flat.simplify_shape(fill).iter().flatten().map(polygon).sum();
            assert!((area - expected).abs() < 1e-6, "case {case} {rule:?}: {area}, not {expected}: {rings:?}");
            // Once resolved, nothing changes any more.
            let again = resolve(result.clone(), Rule::AtLeast(1));
            let area_again: f64 = again.iter().map(Ring::area).sum();
            assert!((area - area_again).abs() < 1e-9, "case {case} {rule:?}: {area}, again {area_again}");
            // Far from the origin a contact is exact to the last digit only, and may turn into a seam.
            assert!(offset != 0.0 || result.len() == again.len(), "case {case} {rule:?}");
            crossings += result.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_none()).count();
        }
    }
    assert!(crossings > 500);
}

/// Rings that run over each other along lines which the grid cannot hold, and circles that touch in one point: their edges
/// are parallel but for rounding, and must not be cut without end.
#[test]
fn seams_on_slanted_lines_and_many_tangent_circles_come_to_an_end() {
    let (sin, cos) = 33f64.to_radians().sin_cos();
    let slanted = |x: f64, y: f64| Point::new(cos * x - sin * y, sin * x + cos * y);
    let on_one_line = |k: u32| {
        let (x, w, h) = (50.0 - 0.37 * f64::from(k), 20.0 + 1.7 * f64::from(k), 5.0 + 0.5 * f64::from(k));
        Ring::polygon([slanted(x, 0.0), slanted(x + w, 0.0), slanted(x + w, h), slanted(x, h)])
    };
    let result = resolve((0..64).map(on_one_line).collect(), Rule::AtLeast(1));
    let largest = on_one_line(63).area();
    let area: f64 = result.iter().map(Ring::area).sum();
    assert_eq!(result.len(), 1);
    assert!((area - largest).abs() < 1e-9 * largest, "{area}, not {largest}");

    let grid = |k: u32| {
        let (x, y) = (f64::from(k % 12), f64::from(k / 12));
        Ring::polygon([(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)].map(|(x, y)| slanted(x, y)))
    };
    let result = resolve((0..144).map(grid).collect(), Rule::AtLeast(1));
    let area: f64 = result.iter().map(Ring::area).sum();
    assert_eq!(result.len(), 1);
    assert!((area - 144.0).abs() < 1e-9, "{area}");

    let nested = |k: u32| Ring::circle(Point::new(5.0 + 0.5 * f64::from(k), 0.0), 5.0 + 0.5 * f64::from(k));
    let result = resolve((0..64).map(nested).collect(), Rule::EvenOdd);
    let area: f64 = result.iter().map(Ring::area).sum();
    let expected: f64 = (0..64).map(|k| if k % 2 == 1 { nested(k).area() } else { -nested(k).area() }).sum();
    assert!((area - expected).abs() < 1e-4 * expected, "{area}, not {expected}");
}

/// Thousands of rings apart, in no order, among each other and within a large one of many links.
#[test]
fn many_rings_apart_pass_through() {
    let mut rings: Vec<Ring> = (0..20_000u64)
        .map(|k| {
            // 7919 is prime to 20 000: all places, far from each other in the list.
            let place = k * 7919 % 20_000;
            Ring::circle(Point::new((place % 200) as f64, (place / 200) as f64), 0.3)
        })
        .collect();
    rings.push(Ring::circle(Point::new(100.0, 50.0), 400.0));
    let hull = Ring::polygon((0..5000).map(|k| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 5000.0).sin_cos();
        Point::new(100.0 + 300.0 * cos, 50.0 + 300.0 * sin)
    }));
    rings.push(hull);
    let result = resolve(rings.clone(), Rule::EvenOdd);
    assert_eq!(result.len(), rings.len());
    // Large ring solid, the hull in it a hole, the circles solid.
    let solid = result.iter().filter(|r| r.area() > 0.0).count();
    assert_eq!(solid, 20_001);
}
