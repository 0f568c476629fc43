//! Exact surfaces.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::mesh::{NONE, PolygonMesh, TriangleMesh, self_intersections};
use crate::rolling::Roller;

const R: f64 = 0.4;

fn flow<'a>(mesh: &TriangleMesh, obstacle: Obstacle, h: f64) -> SurfaceFlow<'a> {
    SurfaceFlow::new(mesh, obstacle, SurfaceField::constant(R), &SurfaceSettings::new(h)).unwrap()
}

fn closed(mesh: &TriangleMesh, h: f64) -> FlownSurface {
    let mut flow = flow(mesh, Obstacle::CLOSING, h);
    assert!(flow.run(f64::INFINITY) != Status::Going);
    assert!(flow.report().end.unwrap().is_limit(), "{:?}", flow.report());
    flow.result()
}

/// A field that knows where the ball touches `mesh`.
fn landing_field(mesh: &TriangleMesh) -> SurfaceField<'static> {
    let roller = Roller::new(mesh).unwrap();
    let contact = move |p, n, r| {
        roller.touch(p, n, r).map(|touch| Landing { point: touch.point, normal: touch.normal, gap: touch.gap })
    };
    SurfaceField { contact: Some(Box::new(contact)), ..SurfaceField::constant(R) }
}

fn landed(mesh: &TriangleMesh, h: f64) -> FlownSurface {
    let settings = SurfaceSettings { on_contact: OnContact::Freeze, ..SurfaceSettings::new(h) };
    let mut flow = SurfaceFlow::new(mesh, Obstacle::CLOSING, landing_field(mesh), &settings).unwrap();
    flow.run(f64::INFINITY);
    assert!(flow.report().end.unwrap().is_limit() && flow.report().contacts.is_empty(), "{:?}", flow.report());
    flow.result()
}

fn prism(outline: &[[f64; 2]], length: f64) -> TriangleMesh {
    let n = outline.len() as u32;
    let points = [0.0, length].into_iter().flat_map(|z| outline.iter().map(move |p| Point::new(p[0], p[1], z)));
    let mut mesh = PolygonMesh::new(points.collect());
    mesh.push(&(0..n).rev().collect::<Vec<_>>());
    mesh.push(&(n..2 * n).collect::<Vec<_>>());
    for k in 0..n {
        let l = (k + 1) % n;
        mesh.push(&[k, l, l + n, k + n]);
    }
    let mesh = mesh.triangulated();
    TriangleMesh::new(mesh.points, mesh.faces)
}

fn angle_piece() -> TriangleMesh {
    prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 2.0)
}

/// A profile, from one point of the x axis to another with falling x, turned about it.
fn turned(profile: &[[f64; 2]], around: usize) -> TriangleMesh {
    let last = profile.len() - 1;
    let mut points = vec![Point::new(profile[0][0], 0.0, 0.0), Point::new(profile[last][0], 0.0, 0.0)];
    for (i, [x, y]) in profile.iter().enumerate().take(last).skip(1) {
        points.extend((0..around).map(|j| {
            let angle = TAU * (j as f64 + 0.5 * (i % 2) as f64) / around as f64;
            Point::new(*x, y * angle.cos(), y * angle.sin())
        }));
    }
    let at = |i: usize, j: usize| (2 + (i - 1) * around + j % around) as u32;
    let mut faces = vec![];
    for j in 0..around {
        faces.extend([[0, at(1, j), at(1, j + 1)], [1, at(last - 1, j + 1), at(last - 1, j)]]);
        for i in 1..last - 1 {
            let (k, l) = if i % 2 == 0 { (j, j + 1) } else { (j + 1, j) };
            let (a, b) = (at(i, j), at(i, j + 1));
            faces.extend(if i % 2 == 0 {
                [[a, at(i + 1, k), b], [b, at(i + 1, k), at(i + 1, l)]]
            } else {
                [[a, at(i + 1, l), at(i + 1, k)], [a, at(i + 1, k), b]]
            });
        }
    }
    TriangleMesh::new(points, faces)
}

/// Half circles of radius 1 at -a and a, joined.
fn profile(a: f64, h: f64) -> Vec<[f64; 2]> {
    let half = (-a).acos();
    let n = (half / h).round() as usize;
    let right: Vec<[f64; 2]> = (0..=n).map(|k| half * k as f64 / n as f64).map(|t| [a + t.cos(), t.sin()]).collect();
    right.iter().copied().chain(right.iter().rev().skip(1).map(|p| [-p[0], p[1]])).collect()
}

/// Uneven samples of a concave cylinder, with edges of about `h`.
fn trough(radius: f64, h: f64) -> TriangleMesh {
    let (n, m) = ((2.0 * radius / h) as usize, (1.5 / h) as usize);
    let mut state = 12345u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut mesh = TriangleMesh::default();
    for i in 0..=n {
        for j in 0..=m {
            let uneven = if i == 0 || j == 0 || i == n || j == m { 0.0 } else { 0.5 };
            let angle = (i as f64 + uneven * next()) * h / radius;
            let z = (j as f64 + uneven * next()) * h;
            mesh.points.push(Point::new(radius * angle.sin(), -radius * angle.cos(), z));
        }
    }
    let at = |i: usize, j: usize| (i * (m + 1) + j) as u32;
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        mesh.faces.extend(if next() > 0.0 { [[a, c, b], [a, d, c]] } else { [[a, d, b], [b, d, c]] });
    }
    mesh
}

/// The mean and the largest of absolute values.
fn summary(errors: &[f64]) -> (f64, f64) {
    let sum: f64 = errors.iter().map(|e| e.abs()).sum();
    (sum / errors.len() as f64, errors.iter().fold(0.0, |m, e| m.max(e.abs())))
}

/// Distances of the vertices in the fillet of an angle piece from it, in `h`; positive where it is too fat.
fn fillet_errors(surface: &FlownSurface, h: f64) -> Vec<f64> {
    let is_in = |p: &&Point| {
        (1.0 + 1e-9..1.0 + R).contains(&p.x)
            && (1.0 + 1e-9..1.0 + R).contains(&p.y)
            && (0.2 * R..2.0 - 0.2 * R).contains(&p.z)
    };
    surface.points.iter().filter(is_in).map(|p| (R - (1.0 + R - p.x).hypot(1.0 + R - p.y)) / h).collect()
}

#[test]
fn what_is_convex_comes_out_bit_for_bit() {
    let cube = prism(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 1.0);
    let half: Vec<[f64; 2]> = (0..=10).map(|k| f64::from(k) * 0.05 * PI).map(|t| [0.5 + t.cos(), t.sin()]).collect();
    let capsule: Vec<[f64; 2]> = half.iter().copied().chain(half.iter().rev().map(|p| [-p[0], p[1]])).collect();
    for mesh in [cube, turned(&profile(0.0, 0.1), 60), turned(&capsule, 31)] {
        let result = closed(&mesh, 0.1);
        assert_eq!((&result.points, &result.faces), (&mesh.points, &mesh.faces));
        assert!(result.origins.iter().zip(0..).all(|(o, k)| *o == k));
        assert!(result.parents.iter().zip(0..).all(|(p, k)| *p == k));
    }
}

#[test]
fn samples_of_a_cylinder_that_the_ball_can_follow_do_not_move() {
    let mut wide = flow(&trough(1.005 * R, 0.05), Obstacle::CLOSING, 0.05);
    assert_eq!(wide.run(f64::INFINITY), Status::Ended(End::Still));
    assert_eq!(wide.report().steps, 0);
    let mut narrow = flow(&trough(0.98 * R, 0.05), Obstacle::CLOSING, 0.05);
    narrow.step(f64::INFINITY);
    assert!(narrow.last_step().0 > 400, "all but the boundary: {:?}", narrow.last_step());
}

#[test]
fn a_concave_edge_gets_a_fillet() {
    for (h, mean, max) in [(0.1, 0.05, 0.25), (0.05, 0.05, 0.35)] {
        let result = closed(&angle_piece(), h);
        let errors = fillet_errors(&result, h);
        let found = summary(&errors);
        assert!(errors.len() > 50 && found.0 < mean && found.1 < max, "{found:?}");
    }
}

#[test]
fn two_spheres_get_the_neck_of_a_torus() {
    let a = 0.7;
    for (h, bound) in [(0.1, 0.06), (0.05, 0.01)] {
        let mesh = turned(&profile(a, h), (TAU / h).round() as usize);
        let result = closed(&mesh, h);
        let rho = ((1.0 + R) * (1.0 + R) - a * a).sqrt();
        let moved = result.points.iter().zip(&result.origins).filter(|(_, o)| **o == NONE);
        let errors: Vec<f64> = moved.map(|(p, _)| (R - (p.y.hypot(p.z) - rho).hypot(p.x)) / h).collect();
        let (mean, max) = summary(&errors);
        assert!(errors.len() > 100 && mean < bound && max < 2.0 * bound, "{mean} {max} of {}", errors.len());
        for (p, o) in result.points.iter().zip(&result.origins) {
            assert!(*o == NONE || *p == mesh.points[*o as usize]);
        }
    }
}

#[test]
fn what_lands_on_the_ball_is_on_it_to_the_last_digits() {
    for h in [0.1, 0.05] {
        let result = landed(&angle_piece(), h);
        let (mean, max) = summary(&fillet_errors(&result, h));
        assert!(mean < 1e-6 && max < 1e-4, "{mean} {max}");
        let mesh = turned(&profile(0.7, h), (TAU / h).round() as usize);
        let result = landed(&mesh, h);
        let rho = ((1.0 + R) * (1.0 + R) - 0.49f64).sqrt();
        let moved = result.points.iter().zip(&result.origins).filter(|(_, o)| **o == NONE);
        let errors: Vec<f64> = moved.map(|(p, _)| (R - (p.y.hypot(p.z) - rho).hypot(p.x)) / h).collect();
        let (mean, max) = summary(&errors);
        // The spheres are faceted, so the ball sinks in by up to their sagitta, an eighth of h².
        assert!(errors.len() > 100 && mean < 0.3 * h && max < 0.5 * h, "{mean} {max}");
        assert!(self_intersections(&TriangleMesh::new(result.points, result.faces)).is_empty());
    }
}

#[test]
fn what_the_ball_fits_rests_though_it_could_land() {
    for mesh in [turned(&profile(0.0, 0.1), 60), trough(1.005 * R, 0.05)] {
        let result = landed(&mesh, 0.05);
        assert!(result.points == mesh.points && result.faces == mesh.faces);
    }
    assert!(landed(&trough(0.9 * R, 0.05), 0.05).origins.contains(&NONE));
}

#[test]
fn opening_is_the_closing_of_the_complement_bit_for_bit() {
    let mesh = angle_piece().reversed();
    let mut opening = flow(&mesh, Obstacle::OPENING, 0.1);
    opening.run(f64::INFINITY);
    let (opened, mut closed) = (opening.result(), closed(&mesh.reversed(), 0.1));
    closed.faces.iter_mut().for_each(|f| f.swap(1, 2));
    assert!(opened == closed && opened.origins.contains(&NONE));
}

#[test]
fn clopening_rounds_both_kinds_of_edges() {
    let mut flow = flow(&angle_piece(), Obstacle::CLOPENING, 0.1);
    flow.run(0.3 * R * R);
    let result = flow.result();
    // Away from the ends, where three edges meet.
    let inner: Vec<&Point> = result.points.iter().filter(|p| (0.5..1.5).contains(&p.z)).collect();
    let near = |p: [f64; 2]| inner.iter().map(|q| (q.x - p[0]).hypot(q.y - p[1])).fold(f64::INFINITY, f64::min);
    assert!(near([1.0, 1.0]) > 0.02 && near([2.0, 0.0]) > 0.02, "{} {}", near([1.0, 1.0]), near([2.0, 0.0]));
}

#[test]
fn the_same_time_is_the_same_state_at_half_the_edge_length() {
    let swept = [0.08, 0.04].map(|h| {
        let settings = SurfaceSettings { time_step: 0.2, ..SurfaceSettings::new(h) };
        let mut flow =
            SurfaceFlow::new(&angle_piece(), Obstacle::CLOSING, SurfaceField::constant(R), &settings).unwrap();
        flow.run(0.2 * R * R);
        assert_eq!(flow.time(), 0.2 * R * R);
        let result = flow.result();
        TriangleMesh::new(result.points, result.faces).volume() - angle_piece().volume()
    });
    assert!((swept[0] / swept[1] - 1.0).abs() < 0.1, "{swept:?}");
}

#[test]
fn pins_and_boundaries_stay() {
    let field = SurfaceField {
        radius: Box::new(|_| R),
        pin_distance: Box::new(|p: Point| (p - Point::new(1.0, 1.0, 1.0)).norm() - 0.1),
        contact: None,
        facing: None,
    };
    let mut flow = SurfaceFlow::new(&angle_piece(), Obstacle::CLOSING, field, &SurfaceSettings::new(0.1)).unwrap();
    flow.run(f64::INFINITY);
    let points = flow.result().points;
    assert!(points.iter().any(|p| p.x == 1.0 && p.y == 1.0 && (p.z - 1.0).abs() <= 0.1), "the edge at the pin");
    assert!(!points.iter().any(|p| p.x == 1.0 && p.y == 1.0 && (p.z - 0.4).abs() < 0.2), "and away from it");
    let open = trough(0.7 * R, 0.07);
    let mut flow = self::flow(&open, Obstacle::CLOSING, 0.07);
    flow.step(f64::INFINITY);
    let result = flow.result();
    let corner = |p: &Point| p.z == 0.0;
    let expected = open.points.iter().filter(|p| corner(p)).count();
    assert_eq!(result.points.iter().filter(|p| corner(p)).count(), expected);
}

#[test]
fn the_radius_may_hang_on_where_the_surface_faces() {
    // A channel: one concave edge faces along x, the other one against it.
    let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [3.0, 2.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let channel = prism(&outline, 1.5);
    let h = 0.06;
    let limit = |mesh: &TriangleMesh, obstacle: Obstacle, sign: f64| {
        let facing = move |n: Vector| if sign * n.x < -0.1 { 0.5 } else { 1.0 };
        let field = SurfaceField { facing: Some(Box::new(facing)), ..SurfaceField::constant(R) };
        let mut flow = SurfaceFlow::new(mesh, obstacle, field, &SurfaceSettings::new(h)).unwrap();
        flow.run(f64::INFINITY);
        assert!(flow.report().end.unwrap().is_limit(), "{:?}", flow.report());
        flow.result()
    };
    let closed = limit(&channel, Obstacle::CLOSING, 1.0);
    for (corner, sign, r) in [(1.0, 1.0, R), (3.0, -1.0, 0.5 * R)] {
        let errors: Vec<f64> = closed
            .points
            .iter()
            .map(|p| [sign * (p.x - corner), p.y - 1.0, p.z])
            .filter(|[x, y, z]| (1e-9..0.7 * r).contains(x) && (1e-9..0.7 * r).contains(y) && (0.3..1.2).contains(z))
            .map(|[x, y, _]| (r - (r - x).hypot(r - y)) / h)
            .collect();
        let (_, largest) = summary(&errors);
        assert!(errors.len() > 20 && largest < 0.1, "{corner}: {} vertices, {largest}", errors.len());
    }
    // What is empty faces the other way.
    let opened = limit(&channel.reversed(), Obstacle::OPENING, -1.0);
    assert_eq!(closed.points, opened.points);
    assert_eq!(closed.faces, opened.faces.iter().map(|&[a, b, c]| [a, c, b]).collect::<Vec<_>>());
}

#[test]
fn mean_curvature_rounds_what_minimum_curvature_leaves_alone() {
    let sphere = turned(&profile(0.0, 0.2), 31);
    for kind in [Kind::Minimum, Kind::Mean] {
        let settings = SurfaceSettings { kind, time_step: 0.5, ..SurfaceSettings::new(0.2) };
        let mut flow = SurfaceFlow::new(&sphere, Obstacle::NONE, SurfaceField::constant(R), &settings).unwrap();
        flow.run(0.05);
        let result = flow.result();
        let radius = result.points.iter().map(|p| p.coords.norm()).sum::<f64>() / result.points.len() as f64;
        // dR/dt = -k / R, with one curvature or the sum of two.
        let k = if kind == Kind::Mean { 2.0 } else { 1.0 };
        let expected = (1.0 - 2.0 * k * 0.05f64).sqrt();
        assert!((radius - expected).abs() < 0.02, "{kind:?}: {radius} for {expected}");
    }
}

#[test]
fn frozen_surfaces_do_not_pass_through_what_is_in_their_way() {
    // A small box that hovers where the fillet will be.
    let mut mesh = angle_piece();
    let hover = prism(&[[1.06, 1.06], [1.1, 1.06], [1.1, 1.1], [1.06, 1.1]], 0.1);
    let first = mesh.points.len() as u32;
    mesh.points.extend(hover.points.iter().map(|p| Point::new(p.x, p.y, p.z + 0.9)));
    mesh.faces.extend(hover.faces.iter().map(|f| f.map(|v| v + first)));
    let crossings = |on_contact| {
        let settings = SurfaceSettings { on_contact, ..SurfaceSettings::new(0.1) };
        let mut flow = SurfaceFlow::new(&mesh, Obstacle::CLOSING, SurfaceField::constant(R), &settings).unwrap();
        flow.run(f64::INFINITY);
        let result = flow.result();
        let report = flow.report();
        (report.contacts.len(), self_intersections(&TriangleMesh::new(result.points, result.faces)).len(), report.end)
    };
    // What goes on is past the box in the end; what stops is in it.
    assert!(crossings(OnContact::Report).0 > 0);
    let stopped = crossings(OnContact::Stop);
    assert!(stopped.1 > 0 && stopped.2 == Some(End::Contact), "{stopped:?}");
    let frozen = crossings(OnContact::Freeze);
    assert!(frozen.0 > 0 && frozen.1 == 0, "{frozen:?}");
}

#[test]
fn settings_out_of_range_are_named() {
    let mesh = angle_piece();
    let error = |settings: SurfaceSettings, radius: f64| {
        SurfaceFlow::new(&mesh, Obstacle::CLOSING, SurfaceField::constant(radius), &settings).err()
    };
    let good = SurfaceSettings::new(0.1);
    assert_eq!(error(SurfaceSettings::new(0.0), R), Some(SurfaceFlowError::EdgeLength(0.0)));
    assert_eq!(error(SurfaceSettings { time_step: -1.0, ..good }, R), Some(SurfaceFlowError::TimeStep(-1.0)));
    assert_eq!(error(SurfaceSettings { tolerance: 2.0, ..good }, R), Some(SurfaceFlowError::Tolerance(2.0)));
    assert_eq!(error(good, 0.0), Some(SurfaceFlowError::Radius { vertex: 0, radius: 0.0 }));
    assert!(error(good, R).is_none());
}
