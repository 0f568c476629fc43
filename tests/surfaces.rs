//! The closing of surfaces by a ball: exact cases, and what it leaves alone.

#[allow(dead_code)]
mod solids;

use clopen::mesh::{HalfEdgeMesh, NONE, Point, PolygonMesh, TriangleMesh, self_intersections};
use clopen::rolling::{ClosedSurface, SurfaceOptions, close_surface};

const ANYWHERE: f64 = f64::INFINITY;

fn close(mesh: &TriangleMesh, r: f64, edge: f64) -> ClosedSurface {
    close_with(mesh, r, edge, 2, &|_| ANYWHERE)
}

fn close_with(
    mesh: &TriangleMesh,
    r: f64,
    edge: f64,
    threads: usize,
    pin_distance: &(dyn Fn(Point) -> f64 + Sync),
) -> ClosedSurface {
    close_surface(mesh, &SurfaceOptions { radius: &|_| r, pin_distance, edge, threads }).unwrap()
}

fn triangles(mesh: &PolygonMesh) -> TriangleMesh {
    mesh.triangulated()
}

/// What must hold of any result: a closed surface, with the input's vertices and faces where it says so, bit for bit.
fn check(input: &TriangleMesh, closed: &ClosedSurface) {
    let mesh = HalfEdgeMesh::new(closed.points.clone(), &closed.faces).unwrap();
    let open = |m: &HalfEdgeMesh| (0..m.points.len() as u32).filter(|&v| m.is_boundary(v)).count();
    let before = HalfEdgeMesh::new(input.points.clone(), &input.faces).unwrap();
    assert_eq!(open(&mesh), open(&before));
    let bits = |p: &Point| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
    for (p, &v) in closed.points.iter().zip(&closed.origins) {
        assert!(v == NONE || bits(p) == bits(&input.points[v as usize]));
    }
    let kept: Vec<u32> = closed.parents.iter().copied().filter(|&f| f != NONE).collect();
    assert!(kept.is_sorted(), "faces stay in order");
    for (face, &parent) in closed.faces.iter().zip(&closed.parents) {
        if parent != NONE {
            assert_eq!(face.map(|v| closed.origins[v as usize]), input.faces[parent as usize]);
        }
    }
    let origins: Vec<u32> = closed.origins.iter().copied().filter(|&v| v != NONE).collect();
    assert!(origins.is_sorted(), "vertices stay in order");
}

#[test]
fn a_concave_edge_gets_a_fillet_of_the_radius() {
    let input = triangles(&solids::bracket());
    let r = 0.3;
    let edges = [0.06, 0.05, 0.04, 0.03, 0.02];
    let mut means = Vec::new();
    for edge in edges {
        let closed = close(&input, r, edge);
        check(&input, &closed);
        assert!(closed.conflicts.is_empty(), "{:?}", closed.conflicts.first());
        // Away from the ends, where the ball rolls around the corner.
        let inner = |p: &Point| p.z > 0.2 * r && p.z < 1.0 - 0.2 * r;
        let off = |p: &Point| ((p.x - 0.8 - r).hypot(p.y - 0.8 - r) - r).abs() / edge;
        let moved = closed.points.iter().zip(&closed.origins).filter(|(p, v)| **v == NONE && inner(p));
        let mut on_fillet = 0;
        for (p, _) in moved {
            // New vertices of the input's own faces stay where the chords of a fillet would not tell them from it.
            let is_flat = p.x < 0.8 + 1e-12 || p.y < 0.8 + 1e-12;
            let beyond = p.x > 0.8 + r || p.y > 0.8 + r;
            assert!(beyond || off(p) < if is_flat { 0.05 } else { 1e-4 }, "{p} is {} edges off", off(p));
            on_fillet += usize::from(!is_flat);
        }
        assert!(on_fillet > 50);
        // Faces are chords of it.
        let new = closed.faces.iter().zip(&closed.parents).filter(|(_, parent)| **parent == NONE);
        let centers = new.map(|(f, _)| {
            Point::from(f.iter().map(|&v| closed.points[v as usize].coords).sum::<nalgebra::Vector3<f64>>() / 3.0)
        });
        let offs: Vec<f64> = centers
            .filter(|p| inner(p) && p.x > 0.8 + 0.1 * edge && p.y > 0.8 + 0.1 * edge)
            .filter(|p| p.x < 0.8 + 0.9 * r && p.y < 0.8 + 0.9 * r)
            .map(|p| off(&p))
            .collect();
        means.push(offs.iter().sum::<f64>() / offs.len() as f64 * edge);
        assert!(offs.iter().all(|o| *o < 0.05), "{:?}", offs.iter().copied().fold(0.0, f64::max));
    }
    let slope = slope(&edges.map(f64::ln), &means.iter().map(|m| m.ln()).collect::<Vec<_>>());
    assert!(slope > 1.8, "the error falls with the square of the edge, not with the power {slope}: {means:?}");
}

/// The slope of the line that fits some points best.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let middle = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mx, my) = (middle(x), middle(y));
    let covariance: f64 = x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

#[test]
fn a_small_fillet_between_wide_faces_takes_few_faces_and_none_lies_on_another() {
    // Faces 600 edge lengths wide that were cut edge by edge became slivers, 147 000 vertices of them; slivers where the fillets
    // begin turned their backs on each other.
    let outline = [[0.0, 0.0], [4.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0], [0.0, 4.0]];
    let mut mesh = PolygonMesh::default();
    for z in [0.0, 10.0] {
        mesh.points.extend(outline.map(|[x, y]| Point::new(x, y, z)));
    }
    for [a, b, c, d] in [[0, 1, 4, 7], [1, 2, 3, 4], [7, 4, 5, 6]] {
        mesh.push(&[d, c, b, a]);
        mesh.push(&[a + 8, b + 8, c + 8, d + 8]);
    }
    for v in 0..8 {
        let w = (v + 1) % 8;
        mesh.push(&[v, w, w + 8, v + 8]);
    }
    let input = triangles(&mesh);
    for (r, most) in [(0.17, 20_000), (2.0, 2_000)] {
        let closed = close(&input, r, r / 6.0);
        check(&input, &closed);
        assert!(closed.conflicts.is_empty(), "{:?}", closed.conflicts.first());
        assert!(closed.points.len() < most, "{} vertices at {r}", closed.points.len());
        let normal = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|v| closed.points[v as usize]);
            (b - a).cross(&(c - a)).normalize()
        };
        let mut beside = std::collections::BTreeMap::new();
        for f in &closed.faces {
            for k in 0..3 {
                let (a, b) = (f[k], f[(k + 1) % 3]);
                beside.insert((a, b), normal(f));
                let other: Option<&nalgebra::Vector3<f64>> = beside.get(&(b, a));
                let place = closed.points[a as usize];
                assert!(other.is_none_or(|n| n.dot(&normal(f)) > -0.1), "two faces lie on each other at {place}");
            }
        }
    }
}

#[test]
fn a_concave_edge_between_two_vertices_that_stay_is_found() {
    // The L of twelve vertices: both ends of its concave edge are touched by balls that lie on the end faces.
    let mut mesh = PolygonMesh::default();
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    for z in [0.0, 1.0] {
        mesh.points.extend(outline.map(|[x, y]| Point::new(x, y, z)));
    }
    mesh.push(&[5, 4, 3, 2, 1, 0]);
    mesh.push(&[6, 7, 8, 9, 10, 11]);
    for k in 0..6 {
        let next = (k + 1) % 6;
        mesh.push(&[k, next, next + 6, k + 6]);
    }
    let input = triangles(&mesh);
    let closed = close(&input, 0.3, 0.05);
    check(&input, &closed);
    let result = TriangleMesh::new(closed.points.clone(), closed.faces.clone());
    // Between the ends the fillet adds (1 - pi / 4) r² to the section.
    let gained = (result.volume() - input.volume()) / ((1.0 - std::f64::consts::FRAC_PI_4) * 0.09);
    assert!(closed.conflicts.is_empty() && gained > 0.6 && gained < 1.0, "{gained}");
}

#[test]
fn the_neck_between_two_balls_is_a_piece_of_a_torus() {
    let input = triangles(&solids::two_spheres());
    let (r, edge) = (0.5, 0.08);
    let closed = close(&input, r, edge);
    check(&input, &closed);
    assert!(closed.conflicts.is_empty());
    // The ball rests on both: its centre is 1.5 from both centres, which are .7 from the plane between.
    let rho = (1.5f64 * 1.5 - 0.7 * 0.7).sqrt();
    let moved: Vec<&Point> = closed
        .points
        .iter()
        .zip(&closed.origins)
        .filter(|(p, v)| **v == NONE && p.x.abs() < 0.1)
        .map(|(p, _)| p)
        .collect();
    assert!(moved.len() > 20);
    for p in moved {
        let off = (p.x.hypot(p.y.hypot(p.z) - rho) - r).abs();
        // The spheres are polyhedra of 48 sides, which stand back by their sagitta.
        assert!(off < 0.01, "{p}: {off}");
    }
}

#[test]
fn what_is_convex_comes_out_bit_for_bit() {
    let sphere = {
        let steps = 20;
        let profile: Vec<[f64; 2]> = (0..=steps)
            .map(|k| std::f64::consts::PI * f64::from(k) / f64::from(steps))
            .map(|t| [-t.cos(), t.sin()])
            .collect();
        solids::revolved(&profile, 30)
    };
    let cube = solids::blocks([4, 4, 4], 0.25, |_| true);
    for mesh in [solids::capsule(), sphere, cube] {
        let input = triangles(&mesh);
        for r in [0.05, 0.3, 2.0] {
            let closed = close(&input, r, r / 6.0);
            assert_eq!((closed.points, closed.faces), (input.points.clone(), input.faces.clone()));
            assert!(closed.conflicts.is_empty() && closed.error == 0.0);
        }
    }
}

#[test]
fn the_result_does_not_hang_on_the_threads() {
    // The second has a gap that is cut out and filled.
    let gap = solids::blocks([16, 16, 10], 0.1, |[x, _, z]| x < 3 || !(4..=5).contains(&z));
    for input in [solids::plus(), gap].map(|mesh| triangles(&mesh)) {
        let [one, two, five] = [1, 2, 5].map(|threads| close_with(&input, 0.3, 0.05, threads, &|_| ANYWHERE));
        assert!(one.origins.contains(&NONE));
        for other in [two, five] {
            assert_eq!(one.points, other.points);
            assert_eq!((&one.faces, &one.parents, &one.origins), (&other.faces, &other.parents, &other.origins));
        }
    }
}

#[test]
fn a_corner_of_coarse_faces_gets_three_fillets_and_a_piece_of_the_ball() {
    // A cube without one of its eight parts, each face of which is a square as large as the part.
    let input = triangles(&solids::blocks([2, 2, 2], 1.0, |cell| cell != [1, 1, 1]));
    let r = 0.4;
    let closed = close(&input, r, 0.05);
    check(&input, &closed);
    assert!(closed.conflicts.is_empty(), "{:?}", closed.conflicts.first());
    let center = Point::new(1.0 + r, 1.0 + r, 1.0 + r);
    let moved = closed.points.iter().zip(&closed.origins).filter(|(p, v)| **v == NONE && p.coords.min() > 1.0 + 1e-9);
    let mut in_corner = 0;
    for (p, _) in moved.filter(|(p, _)| p.coords.max() < 1.0 + r) {
        in_corner += 1;
        assert!(((p - center).norm() / r - 1.0).abs() < 1e-9, "{p}");
    }
    assert!(in_corner > 10);
}

#[test]
fn a_closing_contains_its_input_and_does_not_cross_itself() {
    for (name, mesh) in solids::all() {
        let input = triangles(&mesh);
        let r = 0.04 * input.diagonal();
        let closed = close(&input, r, r / 6.0);
        check(&input, &closed);
        assert!(closed.conflicts.is_empty(), "{name} {:?}", closed.conflicts.first());
        let result = TriangleMesh::new(closed.points.clone(), closed.faces.clone());
        assert!(result.volume() >= input.volume() * (1.0 - 1e-9), "{name}");
        assert_eq!(self_intersections(&result).len(), self_intersections(&input).len(), "{name}");
    }
}

#[test]
fn what_is_pinned_stays_and_the_rest_is_closed() {
    let input = triangles(&solids::bracket());
    let pinned = |p: Point| (p.z - 0.4).max(0.0);
    let closed = close_with(&input, 0.3, 0.05, 2, &pinned);
    check(&input, &closed);
    let moved: Vec<f64> =
        closed.points.iter().zip(&closed.origins).filter(|(_, v)| **v == NONE).map(|(p, _)| p.z).collect();
    assert!(moved.iter().all(|z| *z >= 0.4), "{:?}", moved.iter().copied().fold(f64::INFINITY, f64::min));
    assert!(moved.iter().any(|z| *z > 0.8));
}

#[test]
fn a_gap_open_on_three_sides_is_shut() {
    // Two plates with a gap that is open on three sides, joined along the fourth.
    let blocks =
        |gap: bool| triangles(&solids::blocks([16, 16, 10], 0.1, |[x, _, z]| !gap || x < 3 || !(4..=5).contains(&z)));
    let input = blocks(true);
    let closed = close(&input, 0.3, 0.05);
    check(&input, &closed);
    assert!(closed.conflicts.is_empty(), "{:?}", closed.conflicts.first());
    let result = TriangleMesh::new(closed.points.clone(), closed.faces.clone());
    assert!(self_intersections(&result).is_empty());
    assert_eq!(euler(&closed.faces), 2);
    // The ball rests on both edges of the gap: at its mouth a groove is left, as deep as a segment of the ball is high.
    let (r, half) = (0.3f64, 0.1f64);
    let segment = r * r * (half / r).asin() - half * (r * r - half * half).sqrt();
    let grooves = segment * (1.6 + 2.0 * 1.3);
    let filled = (result.volume() - input.volume()) / (blocks(false).volume() - input.volume() - grooves);
    assert!((filled - 1.0).abs() < 0.01, "{filled}");
}

/// Vertices less edges plus faces: 2 for a ball, 0 with a handle.
fn euler(faces: &[[u32; 3]]) -> i64 {
    let mut edges: Vec<[u32; 2]> =
        faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut vertices: Vec<u32> = faces.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.len() as i64 - edges.len() as i64 + faces.len() as i64
}

#[test]
fn a_window_narrower_than_the_ball_is_shut() {
    // A plate of 2 x 2 x .3 with a window of .2 x .2: no ball of radius .15 gets through it.
    let frame = solids::blocks([40, 40, 6], 0.05, |[x, y, _]| !((18..22).contains(&x) && (18..22).contains(&y)));
    let input = triangles(&frame);
    assert_eq!(euler(&input.faces), 0);
    let closed = close(&input, 0.15, 0.05);
    check(&input, &closed);
    assert!(closed.conflicts.is_empty(), "{} {:?}", closed.conflicts.len(), closed.conflicts.first());
    assert_eq!(euler(&closed.faces), 2, "the handle is gone");
    let result = TriangleMesh::new(closed.points.clone(), closed.faces.clone());
    assert!(self_intersections(&result).is_empty());
    // Above the middle the ball rests on the four corners of the window or on its edges: it dips by no more than this.
    let dip = 0.15 - (0.15f64 * 0.15 - 0.1 * 0.1).sqrt();
    let lowest = closed
        .points
        .iter()
        .filter(|p| (p.x - 1.0).hypot(p.y - 1.0) < 0.05 && p.z > 0.15)
        .map(|p| p.z)
        .fold(f64::INFINITY, f64::min);
    assert!((0.3 - lowest - dip).abs() < 0.01, "{lowest}");
}
