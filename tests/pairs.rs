//! Rings of two vertices in the flow: lenses, and what has no inside.

use clopen::flow::{CurveFlow, Field, Obstacle, Settings};
use clopen::plane::{Arc, Link, Point, Region, Ring, Turn, Vertex};
use clopen::units::Radius;

/// Two arcs of radius 1 about centres `apart` from each other.
fn lens(apart: f64) -> Region {
    let y = (1.0 - 0.25 * apart * apart).sqrt();
    let arc = |x: f64| Link::Arc(Arc { center: Point::new(x, 0.0), radius: 1.0, turn: Turn::Left });
    let side = |y: f64, x: f64| Vertex { link: arc(x), ..Vertex::corner(Point::new(0.0, y)) };
    Region::new(vec![Ring { vertices: vec![side(-y, -0.5 * apart), side(y, 0.5 * apart)] }])
}

fn limit(region: &Region, obstacle: Obstacle, radius: f64) -> Region {
    let field = Field::constant(Radius::new(radius).unwrap());
    let mut flow = CurveFlow::new(region, obstacle, field, &Settings::default()).unwrap();
    flow.run(f64::INFINITY);
    flow.region()
}

#[test]
fn a_lens_shorter_than_an_edge_length_moves_and_is_no_panic() {
    for obstacle in [Obstacle::OPENING, Obstacle::CLOPENING] {
        for radius in [0.9, 1.1, 3.0, 8.0, 20.0, 100.0] {
            let left = limit(&lens(1.99), obstacle, radius);
            assert!(left.is_empty(), "{radius} {obstacle:?}: {left:?}");
        }
        let left = limit(&lens(1.0), obstacle, 0.1);
        assert!(!left.is_empty() && left.area() < lens(1.0).area(), "{obstacle:?}");
    }
}

#[test]
fn a_lens_that_has_no_reason_to_move_stays_bit_for_bit() {
    assert_eq!(limit(&lens(1.5), Obstacle::CLOSING, 10.0), lens(1.5));
}

#[test]
fn a_line_there_and_back_is_no_panic() {
    let line = Region::new(vec![Ring::polygon([(0.0, 0.0), (0.02, 0.0)].map(|(x, y)| Point::new(x, y)))]);
    for obstacle in [Obstacle::CLOSING, Obstacle::OPENING, Obstacle::CLOPENING] {
        for region in [&line, &line.reversed()] {
            assert!(limit(region, obstacle, 1.0).area().abs() < 1e-9);
        }
    }
}
