//! The system of a step, and the nodes about it.

use super::*;
use crate::flow::step::{Front, Stiffness, System};
use crate::plane::{Ring, Vector};

fn front(rings: Vec<Ring>, obstacle: Obstacle) -> CurveFront<'static> {
    let field = Field::constant(Radius::new(1.0).unwrap());
    CurveFront::new(Outline::new(&Region::new(rings)), obstacle, field, DEFAULT_EDGE)
}

/// A ring that bends both ways, more sharply than the disk in many places.
fn wave(center: Point, size: f64) -> Ring {
    Ring::polygon((0..90).map(|k| {
        let angle = f64::from(k) * std::f64::consts::TAU / 90.0;
        center + Vector::new(angle.cos(), angle.sin()) * (size * (1.0 + 0.2 * (9.0 * angle).sin()))
    }))
}

#[test]
fn chains_and_the_sparse_solver_agree_on_the_step() {
    // Open runs, and a small ring that moves as a whole.
    let small = Ring::circle(Point::new(40.0, 0.0), 0.4);
    let rings = vec![wave(Point::origin(), 5.0), small, wave(Point::new(20.0, 0.0), 2.0)];
    let mut front = front(rings, Obstacle::CLOPENING);
    let tau = 0.05 * front.edge_length().powi(2);
    for step in 0..50 {
        let System { mass, stiffness, force, .. } = front.release().unwrap();
        let (mut chains, mut sparse) = (force.clone(), force);
        stiffness.factor(&mass, tau, None).unwrap().solve(&mut chains);
        stiffness.to_sparse().factor(&mass, tau, None).unwrap().solve(&mut sparse);
        let largest = chains.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(largest > 0.0);
        for (a, b) in chains.as_flattened().iter().zip(sparse.as_flattened()) {
            assert!((a - b).abs() <= 1e-12 * largest, "step {step}: {a} and {b}");
        }
        if step == 0 {
            assert!(
                stiffness.has_ring() && stiffness.has_open_run(),
                "both kinds of chains are to be tested: {stiffness:?}"
            );
        }
        chains.as_flattened_mut().iter_mut().for_each(|d| *d *= tau);
        front.displace(&chains);
    }
}

#[test]
fn samples_of_a_circle_that_the_disk_can_follow_do_not_move() {
    // Uneven samples, inscribed in a hole of radius 1 and in one that is larger.
    for radius in [1.0, 1.3] {
        let hole = Ring::polygon((0..200).map(|k| {
            let angle = f64::from(k) * 0.0312 + 0.01 * f64::from(k * k % 7) * 0.2;
            Point::new(radius * angle.cos(), radius * angle.sin())
        }));
        let mut front = front(vec![hole.reversed()], Obstacle::CLOSING);
        assert!(front.release().is_none(), "radius {radius}");
    }
    let mut sharper = front(vec![Ring::circle(Point::origin(), 0.99).reversed()], Obstacle::CLOSING);
    assert!(sharper.release().is_some());
}

#[test]
fn nothing_is_moved_back_over_its_edges() {
    let p = Point::new;
    let mut front = front(
        vec![Ring::polygon([p(0.0, 0.0), p(9.0, 0.0), p(9.0, 9.0), p(4.0, 4.0), p(0.0, 9.0)])],
        Obstacle::CLOSING,
    );
    let rows = front.release().unwrap().mass.len();
    assert_eq!(rows, 1, "the one concave corner");
    assert!(front.displace(&[[0.0, -0.1]]).largest == 0.0, "into the solid");
    front.release().unwrap();
    assert!((front.displace(&[[0.0, 0.01]]).largest - 0.01 / DEFAULT_EDGE).abs() < 1e-12, "out of it");
}

#[test]
fn an_outline_without_motion_comes_out_as_it_went_in() {
    let region = Region::new(vec![Ring::circle(Point::new(3.0, 4.0), 2.0), wave(Point::new(20.0, 0.0), 8.0)]);
    assert_eq!(Outline::new(&region).region(), region);
}
