//! Shapes whose axis is known.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::plane::{Arc, Joint, Link, Ring, Turn, Vertex};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn polygon(points: &[(f64, f64)]) -> Region {
    Region::new(vec![Ring::polygon(points.iter().map(|&(x, y)| p(x, y)))])
}

fn has(axis: &MedialAxis, point: Point, clearance: f64) -> bool {
    axis.nodes.iter().any(|n| (n.point - point).norm() < 1e-9 && (n.clearance - clearance).abs() < 1e-9)
}

fn edge_lengths(axis: &MedialAxis) -> Vec<f64> {
    let length = |e: &AxisEdge| e.nodes.windows(2).map(|w| (w[1].point - w[0].point).norm()).sum();
    let mut lengths: Vec<f64> = axis.edges.iter().map(length).collect();
    lengths.sort_by(f64::total_cmp);
    lengths
}

/// An ellipse of chords that are samples of it.
fn ellipse(a: f64, b: f64, count: usize) -> Ring {
    let vertex = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
        Vertex { joint: Joint::Smooth, ..Vertex::corner(p(a * cos, b * sin)) }
    };
    Ring { vertices: (0..count).map(vertex).collect() }
}

#[test]
fn a_rectangle_has_a_ridge_and_four_diagonals() {
    let axis = medial_axis(&polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)]), 1e-3);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (6, 5));
    assert!(has(&axis, p(2.0, 2.0), 2.0) && has(&axis, p(8.0, 2.0), 2.0));
    for corner in [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 4.0), p(0.0, 4.0)] {
        assert!(has(&axis, corner, 0.0));
    }
    assert!(axis.edges.iter().all(|e| e.nodes.len() == 2), "{axis:?}");
    let lengths = edge_lengths(&axis);
    assert!((lengths[0] - 8f64.sqrt()).abs() < 1e-9 && (lengths[4] - 6.0).abs() < 1e-9);
}

#[test]
fn a_square_has_one_branch_point() {
    let axis = medial_axis(&polygon(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]), 1e-3);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (5, 4));
    assert!(has(&axis, p(2.0, 2.0), 1.0));
}

#[test]
fn a_triangle_has_its_incentre() {
    let axis = medial_axis(&polygon(&[(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]), 1e-3);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (4, 3));
    assert!(has(&axis, p(1.0, 1.0), 1.0));
}

#[test]
fn a_disk_is_one_point() {
    for region in [Ring::circle(p(3.0, -2.0), 5.0), ellipse(5.0, 5.0, 400)].map(|r| Region::new(vec![r])) {
        let axis = medial_axis(&region, 1e-3);
        assert_eq!((axis.nodes.len(), axis.edges.len()), (1, 0), "{axis:?}");
        assert!((axis.nodes[0].clearance - 5.0).abs() < 1e-3);
    }
}

#[test]
fn a_ring_has_the_circle_halfway() {
    let region = Region::new(vec![Ring::circle(p(1.0, 1.0), 6.0), Ring::circle(p(1.0, 1.0), 4.0).reversed()]);
    let axis = medial_axis(&region, 1e-4);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (1, 1));
    for node in &axis.edges[0].nodes {
        assert!(((node.point - p(1.0, 1.0)).norm() - 5.0).abs() < 1e-12 && (node.clearance - 1.0).abs() < 1e-12);
    }
    // The chords are as long as the tolerance lets them be, up to their sharing.
    let count = axis.edges[0].nodes.len();
    assert!((edge_lengths(&axis)[0] - 10.0 * PI).abs() < 1e-3 && (200..2000).contains(&count), "{count}");
}

#[test]
fn a_stadium_ends_in_the_centres_of_its_arcs() {
    let arc = |x: f64| Link::Arc(Arc { center: p(x, 0.0), radius: 2.0, turn: Turn::Left });
    let ring = Ring {
        vertices: vec![
            Vertex::corner(p(-3.0, -2.0)),
            Vertex { link: arc(3.0), ..Vertex::corner(p(3.0, -2.0)) },
            Vertex::corner(p(3.0, 2.0)),
            Vertex { link: arc(-3.0), ..Vertex::corner(p(-3.0, 2.0)) },
        ],
    };
    let axis = medial_axis(&Region::new(vec![ring]), 1e-3);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (2, 1), "{axis:?}");
    assert!(has(&axis, p(-3.0, 0.0), 2.0) && has(&axis, p(3.0, 0.0), 2.0));
}

#[test]
fn an_l_has_a_parabola_about_its_concave_corner() {
    let l = polygon(&[(0.0, 0.0), (9.0, 0.0), (9.0, 3.0), (3.0, 3.0), (3.0, 9.0), (0.0, 9.0)]);
    let axis = medial_axis(&l, 1e-5);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (8, 7), "{axis:?}");
    // On the diagonal: as far from the links at the left and below as from the vertex.
    let x = 3.0 * 2f64.sqrt() / (1.0 + 2f64.sqrt());
    assert!(has(&axis, p(x, x), x) && has(&axis, p(7.5, 1.5), 1.5) && has(&axis, p(1.5, 7.5), 1.5), "{axis:?}");
}

#[test]
fn an_ellipse_ends_in_the_centres_of_its_tightest_curvature_without_hairs() {
    let (a, b) = (10.0, 6.0);
    let axis = medial_axis(&Region::new(vec![ellipse(a, b, 700)]), 1e-3);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (2, 1), "{:?}", axis.nodes);
    let end = a - b * b / a;
    for node in &axis.nodes {
        assert!((node.point.x.abs() - end).abs() < 0.1 && node.point.y.abs() < 1e-3, "{node:?}");
    }
}

#[test]
fn a_curve_that_begins_in_a_line_has_no_hair_there() {
    // A drop: two lines, tangent to the arc that samples stand for, with the corners between marked as such.
    let tip = p(0.0, 0.0);
    let half = 60;
    let touching = PI / 6.0;
    let arc = (0..=2 * half).map(|k| {
        let angle = -(0.5 * PI + touching) + (PI + 2.0 * touching) * k as f64 / (2 * half) as f64;
        let joint = if k == 0 || k == 2 * half { Joint::Corner } else { Joint::Smooth };
        Vertex { joint, ..Vertex::corner(p(10.0 + 5.0 * angle.cos(), 5.0 * angle.sin())) }
    });
    let ring = Ring { vertices: [Vertex::corner(tip)].into_iter().chain(arc).collect() };
    let axis = medial_axis(&Region::new(vec![ring]), 1e-2);
    assert_eq!((axis.nodes.len(), axis.edges.len()), (2, 1), "{:?}", axis.nodes);
    assert!(has(&axis, tip, 0.0));
}

#[test]
fn nothing_comes_of_nothing() {
    assert_eq!(medial_axis(&Region::default(), 1e-3), MedialAxis::default());
    let point = polygon(&[(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)]);
    assert!(medial_axis(&point, 1e-3).edges.is_empty());
    let hole_in_nothing = Region::new(vec![Ring::circle(p(0.0, 0.0), 1.0).reversed()]);
    assert!(medial_axis(&hole_in_nothing, 1e-3).edges.is_empty());
    let not_finite = polygon(&[(0.0, f64::NAN), (1.0, 0.0), (f64::INFINITY, 1.0)]);
    assert!(medial_axis(&not_finite, 1e-3).edges.is_empty());
}
