use proptest::prelude::*;

use super::*;
use crate::cam::test_shapes::{p, plate};
use crate::plane::{Region, Ring};

fn contours(region: &Region) -> Vec<Contour> {
    region.rings.iter().filter_map(|r| Contour::new(r.clone(), true)).collect()
}

/// Every contour once, and nothing before what lies in it.
fn assert_allowed(stops: &[Stop], contours: &[Contour]) {
    let mut seen: Vec<usize> = stops.iter().map(|s| s.contour).collect();
    seen.sort_unstable();
    assert_eq!(seen, (0..contours.len()).collect::<Vec<_>>());
    let at = positions(stops);
    for outer in 0..contours.len() {
        for inner in 0..contours.len() {
            if inner != outer
                && contours[outer].area() > contours[inner].area()
                && contours[outer].encloses(&contours[inner])
            {
                assert!(at[inner] < at[outer], "{inner} lies in {outer} and is cut later");
            }
        }
    }
}

#[test]
fn holes_come_before_their_part_and_islands_before_the_hole() {
    let square =
        |x: f64, y: f64, size: f64| Ring::polygon([p(x, y), p(x + size, y), p(x + size, y + size), p(x, y + size)]);
    // The outer ring is nearest to the start, listed first, and still last.
    let region = Region::new(vec![
        square(0.0, 0.0, 100.0),
        square(10.0, 10.0, 60.0).reversed(),
        square(20.0, 20.0, 20.0),
        square(25.0, 25.0, 5.0).reversed(),
        square(200.0, 0.0, 10.0),
    ]);
    let contours = contours(&region);
    assert_eq!(parents(&contours), [None, Some(0), Some(1), Some(2), None]);
    let stops = order(&contours, Point::origin());
    assert_allowed(&stops, &contours);
    let sequence: Vec<usize> = stops.iter().map(|s| s.contour).collect();
    assert_eq!(sequence, [3, 2, 1, 0, 4]);
}

#[test]
fn travel_over_a_grid_of_holes_is_near_the_shortest() {
    let region = plate(8, 8, 2.0);
    let contours = contours(&region);
    let stops = order(&contours, Point::origin());
    assert_allowed(&stops, &contours);
    // 63 steps between holes 12 mm apart; entries on the rims can make every step shorter by up to 4 mm.
    let length = travel(&stops, &contours, Point::origin());
    assert!(length < 63.0 * 12.0, "{length}");
    assert_eq!(stops, order(&contours, Point::origin()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Improving never breaks the order and never makes the travel longer.
    #[test]
    fn improving_improves(centers in proptest::collection::vec((0.0..200.0f64, 0.0..200.0f64, 0..3u8), 1..40)) {
        let mut rings = Vec::new();
        for (x, y, depth) in centers {
            // Nested circles on a grid, so that contours do not cross.
            let center = p((x / 20.0).floor() * 20.0, (y / 20.0).floor() * 20.0);
            if rings.iter().any(|r: &Ring| r.winding_number(center) != 0) {
                continue;
            }
            for k in 0..=depth {
                let ring = Ring::circle(center, 8.0 - 2.0 * f64::from(k));
                rings.push(if k % 2 == 0 { ring } else { ring.reversed() });
            }
        }
        let contours = contours(&Region::new(rings));
        let parents = parents(&contours);
        let start = Point::origin();
        let greedy = nearest_next(&contours, &parents, start);
        assert_allowed(&greedy, &contours);
        let better = order(&contours, start);
        assert_allowed(&better, &contours);
        prop_assert!(travel(&better, &contours, start) <= travel(&greedy, &contours, start) + 1e-9);
    }
}
