//! Surfaces whose closing is known exactly.

use super::*;
use crate::mesh::Vector;
use crate::reference::surface_shapes::{extruded, overlapping_spheres, sphere};

const R: f64 = 0.3;
const A: f64 = 0.8;

/// Where the neck between the spheres of [`overlapping_spheres`] is: from the axis, at x.
fn neck(x: f64) -> f64 {
    ((1.0 + R).powi(2) - A * A).sqrt() - (R * R - x * x).sqrt()
}

/// The closing of the spheres in the same triangles: vertices in the neck are lifted on to it, and `lift` beyond.
fn closed_spheres(lift: f64, n: u32) -> [TriangleMesh; 2] {
    let input = overlapping_spheres(A, n);
    let mut output = input.clone();
    for p in &mut output.points {
        if p.x.abs() < R * A / (1.0 + R) {
            let factor = (neck(p.x) + lift) / p.y.hypot(p.z);
            (p.y, p.z) = (p.y * factor, p.z * factor);
        }
    }
    [input, output]
}

#[test]
fn an_exact_closing_has_no_error_but_that_of_its_facets() {
    let [input, output] = closed_spheres(0.0, 20);
    let h = input.mean_edge();
    let report = surface(&input, &output, R, Operation::Close, h).unwrap();
    let contact = &report.contact;
    assert!(contact.moved_samples > 500 && contact.certain_share == 1.0, "{contact:?}");
    // Facets of spheres and neck: two sagittas of diagonals.
    assert!(contact.largest_over_h < 2.0 * 2.0 * h / 8.0 / R, "{contact:?}");
    assert!(contact.mean_over_h < 0.06, "{contact:?}");
    let kept = &report.kept;
    // The facets end the neck a ring of vertices earlier than the spheres.
    assert!(kept.still_vertex_share > 0.9 && kept.vertices_found == kept.still_vertices_found, "{kept:?}");
    assert!(kept.vertices_found < kept.input_vertices && kept.vertex_share > 0.5);
    assert!(report.containment.input_violation_over_h < 0.1 && report.containment.output_violation_over_h < 0.1);
    assert_eq!(report.self_intersections.output_pairs, 0);
    assert_eq!(report.topology.input, report.topology.output);
    assert!(report.curvature.share_below_1_1 < 0.1, "{:?}", report.curvature);
}

#[test]
fn too_fat_and_unfilled_are_measured_as_they_are() {
    for lift in [0.1, -0.05] {
        let [input, output] = closed_spheres(lift, 16);
        let report = surface(&input, &output, R, Operation::Close, 0.1).unwrap().contact;
        let (there, not) = if lift > 0.0 {
            (report.too_fat_over_h, report.unfilled_over_h)
        } else {
            (report.unfilled_over_h, report.too_fat_over_h)
        };
        assert!((there - 10.0 * lift.abs()).abs() < 0.15, "{report:?}");
        assert!(not < 0.15, "{report:?}");
        // Where the neck ends, the faces reach down to what stays.
        assert!(report.bias_over_h / lift > 4.0 && report.bias_over_h / lift < 11.0, "{report:?}");
    }
}

#[test]
fn an_opening_is_the_closing_of_the_complement() {
    let [input, output] = closed_spheres(0.01, 10);
    let closed = surface(&input, &output, R, Operation::Close, 0.1).unwrap();
    let opened = surface(&input.reversed(), &output.reversed(), R, Operation::Open, 0.1).unwrap();
    assert_eq!(SurfaceReport { operation: Operation::Close, ..opened }, closed);
}

#[test]
fn what_should_have_moved_is_found() {
    let input = overlapping_spheres(A, 20);
    let report = surface(&input, &input, R, Operation::Close, 0.1).unwrap();
    assert_eq!((report.contact.moved_samples, report.quality.moved_faces), (0, 0));
    // The crease is below the neck.
    let depth = neck(0.0) - (1.0 - A * A).sqrt();
    assert!((report.contact.unfilled_where_kept_over_h - depth / 0.1).abs() < 0.1, "{:?}", report.contact);
    assert!(report.kept.vertex_share == 1.0 && report.kept.still_vertices < report.kept.input_vertices);
    // A convex body has nothing to move.
    let ball = sphere(Point::origin(), 1.0, 8);
    let report = surface(&ball, &ball, R, Operation::Close, 0.1).unwrap();
    assert_eq!((report.contact.unfilled_where_kept_over_h, report.kept.still_vertex_share), (0.0, 1.0));
    assert_eq!(report.kept.face_share, 1.0);
}

#[test]
fn violations_of_containment_are_measured() {
    let ball = sphere(Point::origin(), 1.0, 8);
    let mut dented = ball.clone();
    let k = dented.points.iter().position(|p| p.z > 0.999).unwrap();
    dented.points[k] -= Vector::z() * 0.125;
    let report = surface(&ball, &dented, R, Operation::Close, 0.1).unwrap().containment;
    assert!(report.input_violation_units > 0.07 && report.input_violation_units <= 0.125, "{report:?}");
    // From the tip straight up, or to the faces beside it.
    assert!((report.output_violation_units - 0.125).abs() < 0.02, "{report:?}");
    let opened = surface(&ball, &dented, R, Operation::Open, 0.1).unwrap().containment;
    assert!(opened.input_violation_units < 1e-12 && opened.output_violation_units < 1e-12, "{opened:?}");
}

#[test]
fn a_block_keeps_what_is_far_from_its_notch_and_names_the_rest() {
    let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let input = extruded(&l, 2.0, 0.25);
    let mut output = input.clone();
    for p in &mut output.points {
        if (p.x - 1.0).abs() < 1e-9 && (p.y - 1.0).abs() < 1e-9 && p.z > 0.6 && p.z < 1.4 {
            (p.x, p.y) = (1.05, 1.05);
        }
    }
    let report = surface(&input, &output, 0.3, Operation::Close, 0.25).unwrap();
    let (kept, all) = (report.kept.vertices_found, report.kept.input_vertices);
    assert_eq!(all - kept, 3);
    assert!(report.kept.faces_found < report.kept.input_faces);
    assert!(report.contact.too_fat_over_h < 1e-6, "{:?}", report.contact);
    let place = report.contact.unfilled_place.unwrap();
    assert!((place[0] - 1.0).abs() < 0.1 && (place[1] - 1.0).abs() < 0.1, "{place:?}");
    assert!(serde_json::to_string(&report).unwrap().contains("\"too_fat_over_h\""));
}

#[test]
fn what_cannot_be_checked_is_said() {
    let ball = sphere(Point::origin(), 1.0, 2);
    let check = |a: &TriangleMesh, b: &TriangleMesh, r: f64| surface(a, b, r, Operation::Close, 0.1).unwrap_err();
    assert_eq!(check(&ball, &TriangleMesh::default(), 0.1), SurfaceCheckError::Empty { mesh: "output" });
    assert!(matches!(check(&ball, &ball, 0.0), SurfaceCheckError::Length { .. }));
    let mut broken = ball.clone();
    broken.points[3].y = f64::NAN;
    assert_eq!(check(&broken, &ball, 0.1), SurfaceCheckError::NotFinite { mesh: "input", vertex: 3 });
    let mut broken = ball.clone();
    broken.faces[2][0] = 500;
    assert_eq!(check(&ball, &broken, 0.1), SurfaceCheckError::Face { mesh: "output", face: 2 });
}
