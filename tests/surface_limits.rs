//! What closings tend to, what they are duals of, and what they contain.

#[allow(dead_code)]
mod solids;

use std::f64::consts::{PI, TAU};
use std::path::Path;

use clopen::io::mesh::{MeshFormat, read};
use clopen::mesh::{NONE, Point, TriangleMesh, Vector};
use clopen::rolling::{ClosedSurface, SurfaceOptions, close_surface};

fn close(mesh: &TriangleMesh, r: f64, edge: f64) -> ClosedSurface {
    let options = SurfaceOptions { radius: &|_| r, pin_distance: &|_| f64::INFINITY, edge, threads: 2 };
    close_surface(mesh, &options).unwrap()
}

fn result(closed: &ClosedSurface) -> TriangleMesh {
    TriangleMesh::new(closed.points.clone(), closed.faces.clone())
}

/// As in Fig. 16 of the paper: with larger and larger balls the closing becomes the convex hull.
#[test]
fn the_closing_by_larger_and_larger_balls_becomes_the_convex_hull() {
    let input = solids::two_spheres().triangulated();
    // The hull of what is turned in 48 steps is the hull of the profile, turned: cones between rings of as many sides.
    let farthest = input.points.iter().map(|p| p.y.hypot(p.z)).fold(0.0, f64::max);
    let end = input.points.iter().filter(|p| p.y.hypot(p.z) > farthest * (1.0 - 1e-9)).map(|p| p.x).fold(0.0, f64::max);
    let dent: Vec<Vector> = input.points.iter().filter(|p| p.x.abs() < end - 1e-9).map(|p| p.coords).collect();
    assert!(dent.len() > 500, "what the hull covers");
    let mut rings: Vec<(f64, f64)> =
        input.points.iter().filter(|p| p.x >= end - 1e-9).map(|p| (p.x, p.y.hypot(p.z))).collect();
    rings.sort_by(|a, b| a.0.total_cmp(&b.0));
    rings.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-9);
    let sides = 48.0;
    let section = 0.5 * sides * (TAU / sides).sin();
    let caps: f64 =
        rings.windows(2).map(|w| (w[1].0 - w[0].0) * (w[0].1.powi(2) + w[0].1 * w[1].1 + w[1].1.powi(2)) / 3.0).sum();
    let hull = section * 2.0 * (end * farthest * farthest + caps);
    let diagonal = input.diagonal();
    let edge = diagonal / 40.0;
    let mut last = input.volume();
    for times in [0.5, 2.0, 5.0, 20.0, 100.0] {
        let r = times * diagonal;
        let closed = close(&input, r, edge);
        assert_eq!(closed.conflicts, [], "{times}");
        let volume = result(&closed).volume();
        println!("r = {times} diagonals: volume {volume:.5}, hull {hull:.5}");
        assert!(last < volume && volume < hull * (1.0 + 1e-3), "{times}: {last} {volume} {hull}");
        // The neck: the ball rests on both spheres.
        let depth = (r + 1.0) - ((r + 1.0).powi(2) - 0.49).sqrt();
        let neck = closed.points.iter().filter(|p| p.x.abs() < 0.3 * edge).map(|p| p.y.hypot(p.z));
        let least = neck.fold(f64::INFINITY, f64::min);
        assert!((least - (1.0 - depth)).abs() < 0.1 * edge, "{times}: {least} {}", 1.0 - depth);
        last = volume;
    }
    assert!(last > 0.998 * hull, "{last} {hull}");
}

/// As in Fig. 23 of the paper: the tray opened and the ice closed.
#[test]
fn ice_leaves_the_opened_tray_as_it_is_closed_itself() {
    let (tray, ice) = (solids::tray().triangulated(), solids::ice().triangulated());
    let (r, edge) = (0.2, 0.04);
    // Opening is the closing of what is empty.
    let opened = close(&tray.reversed(), r, edge);
    let closed = close(&ice, r, edge);
    assert!(opened.conflicts.is_empty() && closed.conflicts.is_empty());
    assert!(result(&opened).reversed().volume() < tray.volume() && result(&closed).volume() > ice.volume());
    // Turned over and back nothing is lost: to the last bit.
    let twice = close(&tray.reversed().reversed().reversed(), r, edge);
    assert_eq!((&twice.points, &twice.faces), (&opened.points, &opened.faces));
    // Where the ridge was rounded, the ice has become so much larger: the surfaces are the same. At the rim, which only the tray has,
    // they are not.
    let surfaces = [result(&opened), result(&closed)];
    let new = |c: &ClosedSurface| -> Vec<Point> {
        let points = c.points.iter().zip(&c.origins).filter(|(_, o)| **o == NONE).map(|(p, _)| *p);
        let inside = |p: &Point| (1.2..2.3).contains(&p.x) && (0.55..1.95).contains(&p.y) && (0.4..1.25).contains(&p.z);
        points.filter(inside).collect()
    };
    for (points, other) in [(new(&opened), &surfaces[1]), (new(&closed), &surfaces[0])] {
        assert!(points.len() > 100, "{}", points.len());
        let off = points.iter().map(|p| distance(other, *p)).fold(0.0, f64::max);
        println!("{} vertices fit within {:.4} edge lengths", points.len(), off / edge);
        // What would move by less than a twentieth of an edge stays, and faces are chords.
        assert!(off < 0.08 * edge, "{off}");
    }
}

/// A ball with bumps and dents that no seed repeats.
fn bumpy(seed: u64) -> TriangleMesh {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let waves: Vec<(Vector, f64, f64)> = (0..8)
        .map(|_| {
            let direction = Vector::new(next() - 0.5, next() - 0.5, next() - 0.5).normalize();
            (direction * (2.0 + 5.0 * next()), TAU * next(), 0.03 + 0.06 * next())
        })
        .collect();
    let steps = 36;
    let profile: Vec<[f64; 2]> =
        (0..=steps).map(|k| PI * f64::from(k) / f64::from(steps)).map(|t| [-t.cos(), t.sin()]).collect();
    let mut mesh = solids::revolved(&profile, 48);
    for p in &mut mesh.points {
        let bump: f64 = waves.iter().map(|(k, phase, size)| size * (k.dot(&p.coords) + phase).cos()).sum();
        *p = Point::from(p.coords * (1.0 + bump));
    }
    mesh.triangulated()
}

#[test]
fn closings_contain_what_they_close() {
    for seed in 1..=6 {
        let input = bumpy(seed);
        let r = 0.6;
        let edge = 0.06;
        let closed = close(&input, r, edge);
        let moved = closed.origins.iter().filter(|o| **o == NONE).count();
        assert!(moved > 100, "{seed}: {moved} moved");
        let [vertices, faces] = dips(&input, &closed);
        println!("seed {seed}: {moved} moved, vertices dip {vertices:.1e}, faces {:.4} edge lengths", faces / edge);
        assert!(vertices <= 1e-9 * input.diagonal(), "{seed}: {vertices}");
        assert!(faces <= 0.05 * edge, "{seed}: {faces}");
    }
}

#[test]
fn closings_of_shared_meshes_contain_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/3d");
    if !folder.is_dir() {
        println!("skipped: ../shared is absent");
        return;
    }
    for (name, r, edge) in [("rocker", 0.06, 0.01), ("mechanical1", 0.07, 0.01)] {
        let bytes = std::fs::read(folder.join(format!("{name}_input.obj"))).unwrap();
        let input = read(&bytes, MeshFormat::Obj).unwrap().triangulated();
        let closed = close(&input, r, edge);
        let [vertices, faces] = dips(&input, &closed);
        println!(
            "{name}: {} new vertices dip {:.1e} diagonals at most, faces {:.4} edge lengths, {} conflicts",
            closed.origins.iter().filter(|o| **o == NONE).count(),
            vertices / input.diagonal(),
            faces / edge,
            closed.conflicts.len()
        );
        assert!(vertices <= 1e-9 * input.diagonal(), "{name}: {vertices}");
        assert!(faces <= 0.05 * edge, "{name}: {faces}");
    }
}

/// How deep new vertices, and middles of new faces and of their sides, are in the input.
fn dips(input: &TriangleMesh, closed: &ClosedSurface) -> [f64; 2] {
    let vertices: Vec<Point> =
        closed.points.iter().zip(&closed.origins).filter(|(_, o)| **o == NONE).map(|(p, _)| *p).collect();
    let mut middles = vec![];
    for (face, _) in closed.faces.iter().zip(&closed.parents).filter(|(_, parent)| **parent == NONE) {
        let [a, b, c] = face.map(|v| closed.points[v as usize]);
        middles.push(Point::from((a.coords + b.coords + c.coords) / 3.0));
        middles.extend([(a, b), (b, c), (c, a)].map(|(p, q)| nalgebra::center(&p, &q)));
    }
    let rays = Rays::new(input);
    let deepest = |points: &[Point]| {
        let inside = points.iter().filter(|p| rays.is_inside(**p));
        inside.map(|p| distance(input, *p)).fold(0.0, f64::max)
    };
    [vertices, middles].map(|points| {
        std::thread::scope(|scope| {
            let halves = points.chunks(points.len().div_ceil(2).max(1));
            let threads: Vec<_> = halves.map(|half| scope.spawn(|| deepest(half))).collect();
            threads.into_iter().map(|t| t.join().unwrap()).fold(0.0, f64::max)
        })
    })
}

/// Triangles by where they lie seen along z, in cells: how often a ray passes through them tells inside from outside.
struct Rays {
    /// Turned, so that no face of a machined part is seen edge on.
    mesh: TriangleMesh,
    low: Point,
    cell: f64,
    count: usize,
    cells: Vec<Vec<u32>>,
}

impl Rays {
    fn turned(p: Point) -> Point {
        nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -0.7) * p
    }

    fn new(mesh: &TriangleMesh) -> Rays {
        let points = mesh.points.iter().map(|p| Rays::turned(*p)).collect();
        let mesh = TriangleMesh::new(points, mesh.faces.clone());
        let count = 128;
        let [low, high] = mesh.bounds().unwrap();
        let cell = (high - low).xy().max() / count as f64 * (1.0 + 1e-9);
        let mut rays = Rays { mesh, low, cell, count, cells: vec![vec![]; count * count] };
        for f in 0..rays.mesh.faces.len() {
            let [a, b, c] = rays.mesh.triangle(f);
            let ([i, j], [k, l]) = (rays.cell_of(a.inf(&b).inf(&c)), rays.cell_of(a.sup(&b).sup(&c)));
            for x in i..=k {
                (j..=l).for_each(|y| rays.cells[x * count + y].push(f as u32));
            }
        }
        rays
    }

    fn cell_of(&self, p: Point) -> [usize; 2] {
        [0, 1].map(|k| (((p[k] - self.low[k]) / self.cell).max(0.0) as usize).min(self.count - 1))
    }

    /// Whether the solid is around a place. A ray that passes near an edge is not to be trusted: another place beside it is asked.
    fn is_inside(&self, p: Point) -> bool {
        let p = Rays::turned(p);
        for step in 0..20 {
            let off = 1e-9 * self.cell * f64::from(step);
            let q = Point::new(p.x + 0.7 * off, p.y + 0.3 * off, p.z);
            let [i, j] = self.cell_of(q);
            let mut crossings = 0;
            let mut is_sure = true;
            for &f in &self.cells[i * self.count + j] {
                let [a, b, c] = self.mesh.triangle(f as usize);
                let turn = |u: Point, v: Point| (v.x - u.x) * (q.y - u.y) - (v.y - u.y) * (q.x - u.x);
                let turns = [turn(a, b), turn(b, c), turn(c, a)];
                if turns.contains(&0.0) {
                    is_sure = false;
                    break;
                }
                if turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0) {
                    let whole: f64 = turns.iter().sum();
                    let z = (turns[1] * a.z + turns[2] * b.z + turns[0] * c.z) / whole;
                    crossings += usize::from(z > q.z);
                }
            }
            if is_sure {
                return crossings % 2 == 1;
            }
        }
        panic!("no ray from {p} is clear of edges");
    }
}

/// The distance from all triangles, one by one.
fn distance(mesh: &TriangleMesh, p: Point) -> f64 {
    let mut least = f64::INFINITY;
    for f in 0..mesh.faces.len() {
        let [a, b, c] = mesh.triangle(f);
        let low = a.inf(&b).inf(&c) - p;
        let high = p - a.sup(&b).sup(&c);
        let beyond = low.sup(&high).sup(&Vector::zeros());
        if beyond.norm_squared() < least {
            least = least.min(squared(p, [a, b, c]));
        }
    }
    least.sqrt()
}

/// The square of the distance from a triangle: from its plane where the foot is inside, else from its sides.
fn squared(p: Point, corners: [Point; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let inside = (0..3).all(|k| {
        let (u, v) = (corners[k], corners[(k + 1) % 3]);
        normal.cross(&(v - u)).dot(&(p - u)) >= 0.0
    });
    if inside && normal.norm_squared() > 0.0 {
        return normal.dot(&(p - a)).powi(2) / normal.norm_squared();
    }
    let side = |u: Point, v: Point| {
        let along = v - u;
        let t = ((p - u).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (u + along * t - p).norm_squared()
    };
    side(a, b).min(side(b, c)).min(side(c, a))
}
