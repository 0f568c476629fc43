//! Surfaces for tests.

use crate::mesh::{Point, TriangleMesh};

/// A simple polygon, counterclockwise with sides parallel to the axes, extruded along z from 0 to `height`: its sides of
/// quads about `step` wide, each cut in two, its ends cut by ears.
pub(crate) fn extruded(polygon: &[[f64; 2]], height: f64, step: f64) -> TriangleMesh {
    let mut ring = Vec::new();
    for (k, a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let n = (length / step).round().max(1.0) as usize;
        for i in 0..n {
            let t = i as f64 / n as f64;
            ring.push([a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]);
        }
    }
    let layers = (height / step).round().max(1.0) as usize;
    let n = ring.len() as u32;
    let mut mesh = TriangleMesh::default();
    for layer in 0..=layers {
        let z = height * layer as f64 / layers as f64;
        mesh.points.extend(ring.iter().map(|p| Point::new(p[0], p[1], z)));
    }
    for layer in 0..layers as u32 {
        for i in 0..n {
            let (a, b) = (layer * n + i, layer * n + (i + 1) % n);
            mesh.faces.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    let top = layers as u32 * n;
    for [a, b, c] in ears(&ring) {
        mesh.faces.extend([[a, c, b], [top + a, top + b, top + c]]);
    }
    mesh
}

/// A polygon as triangles.
fn ears(ring: &[[f64; 2]]) -> Vec<[u32; 3]> {
    let cross = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(|k| ring[k as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut left: Vec<u32> = (0..ring.len() as u32).collect();
    let mut faces = Vec::new();
    while left.len() > 2 {
        let n = left.len();
        let is_ear = |k: usize| {
            let [a, b, c] = [left[k], left[(k + 1) % n], left[(k + 2) % n]];
            let inside = |&p: &u32| {
                ![a, b, c].contains(&p) && cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0
            };
            cross(a, b, c) > 1e-12 && !left.iter().any(inside)
        };
        let k = (0..n).find(|&k| is_ear(k)).expect("a simple polygon has an ear");
        faces.push([left[k], left[(k + 1) % n], left[(k + 2) % n]]);
        left.remove((k + 1) % n);
    }
    faces
}

/// A sphere: an octahedron whose faces are cut into n² triangles each, on the sphere.
pub(crate) fn sphere(center: Point, radius: f64, n: u32) -> TriangleMesh {
    let mut numbers = std::collections::HashMap::new();
    let mut mesh = TriangleMesh::default();
    for octant in 0..8u32 {
        let sign = |k: u32| if octant >> k & 1 == 0 { 1 } else { -1 };
        let mut vertex = |i: u32, j: u32| {
            let k = n - i - j;
            let key = [i as i32 * sign(0), j as i32 * sign(1), k as i32 * sign(2)];
            *numbers.entry(key).or_insert_with(|| {
                let v = crate::mesh::Vector::from(key.map(f64::from)).normalize();
                mesh.points.push(center + v * radius);
                mesh.points.len() as u32 - 1
            })
        };
        let mut faces = Vec::new();
        for i in 0..n {
            for j in 0..n - i {
                faces.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 2 <= n {
                    faces.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
        let is_mirrored = octant.count_ones() % 2 == 1;
        mesh.faces.extend(faces.into_iter().map(|[a, b, c]| if is_mirrored { [a, c, b] } else { [a, b, c] }));
    }
    mesh
}

/// Two surfaces as one.
pub(crate) fn both(a: &TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let shift = a.points.len() as u32;
    let points = a.points.iter().chain(&b.points).copied().collect();
    let faces = a.faces.iter().copied().chain(b.faces.iter().map(|f| f.map(|v| v + shift))).collect();
    TriangleMesh::new(points, faces)
}

/// The union of two spheres of radius 1 about (±a, 0, 0), of a profile of `n` chords a sphere turned in `2 n` steps.
pub(crate) fn overlapping_spheres(a: f64, n: u32) -> TriangleMesh {
    // From the left pole to the plane where they meet.
    let last = std::f64::consts::PI - a.acos();
    let half: Vec<[f64; 2]> =
        (0..=n).map(|k| last * f64::from(k) / f64::from(n)).map(|t| [-a - t.cos(), t.sin()]).collect();
    let mirrored = half[..n as usize].iter().rev().map(|p| [-p[0], p[1]]);
    let profile: Vec<[f64; 2]> = half.iter().copied().chain(mirrored).collect();
    let turns = 2 * n;
    let mut mesh = TriangleMesh::default();
    let rings = profile.len() as u32 - 2;
    for [x, rho] in &profile[1..=rings as usize] {
        for i in 0..turns {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(turns)).sin_cos();
            mesh.points.push(Point::new(*x, rho * cos, rho * sin));
        }
    }
    let (left, right) = (mesh.points.len() as u32, mesh.points.len() as u32 + 1);
    mesh.points.extend([Point::new(profile[0][0], 0.0, 0.0), Point::new(-profile[0][0], 0.0, 0.0)]);
    for i in 0..turns {
        let j = (i + 1) % turns;
        for ring in 1..rings {
            let (a, b) = ((ring - 1) * turns, ring * turns);
            mesh.faces.extend([[a + i, b + i, b + j], [a + i, b + j, a + j]]);
        }
        let end = (rings - 1) * turns;
        mesh.faces.extend([[left, i, j], [right, end + j, end + i]]);
    }
    mesh.reversed()
}
