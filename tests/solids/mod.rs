//! Surfaces that are made, not downloaded: closed, oriented outward, without self-intersections.

use clopen::mesh::{Point, PolygonMesh, Vector};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The surface of all cubes of side `h` for which `is_solid` holds, in quads; solid cubes may meet in faces only.
pub fn blocks(size: [i32; 3], h: f64, is_solid: impl Fn([i32; 3]) -> bool) -> PolygonMesh {
    let inside = |c: [i32; 3]| (0..3).all(|k| (0..size[k]).contains(&c[k])) && is_solid(c);
    let mut numbers: BTreeMap<[i32; 3], u32> = BTreeMap::new();
    let mut mesh = PolygonMesh::default();
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in (0..size[0]).filter(|&x| inside([x, y, z])) {
                for axis in 0..3 {
                    for side in [0, 1] {
                        let mut beside = [x, y, z];
                        beside[axis] += 2 * side - 1;
                        if inside(beside) {
                            continue;
                        }
                        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                        let mut around = [[0, 0], [1, 0], [1, 1], [0, 1]];
                        if side == 0 {
                            around.reverse();
                        }
                        let quad = around.map(|[i, j]| {
                            let mut corner = [x, y, z];
                            corner[axis] += side;
                            corner[u] += i;
                            corner[v] += j;
                            *numbers.entry(corner).or_insert_with(|| {
                                mesh.points.push(Point::from(corner.map(|k| f64::from(k) * h)));
                                mesh.points.len() as u32 - 1
                            })
                        });
                        mesh.push(&quad);
                    }
                }
            }
        }
    }
    mesh
}

/// A profile of (place along x, distance from the x axis) turned around it in `n` steps; it starts and ends on the axis.
pub fn revolved(profile: &[[f64; 2]], n: u32) -> PolygonMesh {
    let last = profile.len() - 1;
    let mut mesh = PolygonMesh::default();
    mesh.points.push(Point::new(profile[0][0], 0.0, 0.0));
    for [x, rho] in &profile[1..last] {
        mesh.points.extend((0..n).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            Point::new(*x, rho * cos, rho * sin)
        }));
    }
    mesh.points.push(Point::new(profile[last][0], 0.0, 0.0));
    let ring = |i: u32, k: u32| 1 + (i - 1) * n + k % n;
    let end = mesh.points.len() as u32 - 1;
    for k in 0..n {
        mesh.push(&[0, ring(1, k + 1), ring(1, k)]);
        for i in 1..last as u32 - 1 {
            mesh.push(&[ring(i, k), ring(i, k + 1), ring(i + 1, k + 1), ring(i + 1, k)]);
        }
        mesh.push(&[ring(last as u32 - 1, k), ring(last as u32 - 1, k + 1), end]);
    }
    mesh
}

/// One step of the scheme of Catmull and Clark (1978) on a closed surface.
pub fn subdivided(mesh: &PolygonMesh) -> PolygonMesh {
    let count = mesh.points.len();
    let mut points: Vec<Vector> = vec![Vector::zeros(); count];
    let mut faces_at = vec![0.0; count];
    let centers: Vec<Vector> = mesh
        .polygons()
        .map(|p| p.iter().map(|v| mesh.points[*v as usize].coords).sum::<Vector>() / p.len() as f64)
        .collect();
    let mut edges: BTreeMap<(u32, u32), (u32, Vector)> = BTreeMap::new();
    for (polygon, center) in mesh.polygons().zip(&centers) {
        for (k, &a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            let next = (count + centers.len() + edges.len()) as u32;
            edges.entry((a.min(b), a.max(b))).or_insert((next, Vector::zeros())).1 += center / 4.0;
            points[a as usize] += center;
            faces_at[a as usize] += 1.0;
        }
    }
    let at = |v: u32| mesh.points[v as usize].coords;
    // (F + 2 E + (n - 3) P) / n with the means of the faces' and of the edges' middles.
    let mut middles: Vec<Vector> = vec![Vector::zeros(); count];
    for &(a, b) in edges.keys() {
        middles[a as usize] += (at(a) + at(b)) / 2.0;
        middles[b as usize] += (at(a) + at(b)) / 2.0;
    }
    for v in 0..count {
        let n: f64 = faces_at[v];
        points[v] = (points[v] / n + middles[v] * (2.0 / n) + at(v as u32) * (n - 3.0)) / n;
    }
    let mut places = points;
    places.extend(&centers);
    places.resize(count + centers.len() + edges.len(), Vector::zeros());
    for (&(a, b), &(number, quarter)) in &edges {
        places[number as usize] = quarter + (at(a) + at(b)) / 4.0;
    }
    let mut finer = PolygonMesh::new(places.into_iter().map(Point::from).collect());
    let middle = |a: u32, b: u32| edges[&(a.min(b), a.max(b))].0;
    for (f, polygon) in mesh.polygons().enumerate() {
        let n = polygon.len();
        for (k, &v) in polygon.iter().enumerate() {
            let (before, after) = (polygon[(k + n - 1) % n], polygon[(k + 1) % n]);
            finer.push(&[v, middle(v, after), (count + f) as u32, middle(before, v)]);
        }
    }
    finer
}

/// An extruded L: two legs of length 2 and width .8, 1 thick, with edges of .1; its concave edge is at x = y = .8.
pub fn bracket() -> PolygonMesh {
    blocks([20, 20, 10], 0.1, |[x, y, _]| x < 8 || y < 8)
}

/// An extruded plus: four concave edges; 3 wide, arms 1 wide and 1 thick, with edges of .1.
pub fn plus() -> PolygonMesh {
    blocks([30, 30, 10], 0.1, |[x, y, _]| (10..20).contains(&x) || (10..20).contains(&y))
}

/// Two unit spheres with centres at x = -.7 and .7, as one surface: they meet in a circle of radius sqrt(.51).
pub fn two_spheres() -> PolygonMesh {
    let (a, steps) = (0.7f64, 24);
    // From the pole to where the plane between them cuts the sphere.
    let most = (-a).acos();
    let half: Vec<[f64; 2]> =
        (0..=steps).map(|k| most * f64::from(k) / f64::from(steps)).map(|t| [-a - t.cos(), t.sin()]).collect();
    let mut profile = half.clone();
    profile[steps as usize][0] = 0.0;
    profile.extend(half[..steps as usize].iter().rev().map(|[x, rho]| [-x, *rho]));
    revolved(&profile, 48)
}

/// A cylinder of radius .5 and length 2 with half balls as ends.
pub fn capsule() -> PolygonMesh {
    let (r, cap, side) = (0.5, 10, 20);
    let ball = |k: i32| TAU / 4.0 * f64::from(k) / f64::from(cap);
    let start = (0..=cap).map(|k| [-1.0 - r * ball(k).cos(), r * ball(k).sin()]);
    let middle = (1..side).map(|k| [-1.0 + 2.0 * f64::from(k) / f64::from(side), r]);
    let end = (0..=cap).rev().map(|k| [1.0 + r * ball(k).cos(), r * ball(k).sin()]);
    revolved(&start.chain(middle).chain(end).collect::<Vec<_>>(), 32)
}

/// A tube of radius .35 along a trefoil knot on a torus of radii 2 and 1.
pub fn knot() -> PolygonMesh {
    let (along, around) = (200, 14);
    let place = |t: f64| {
        let r = 2.0 + (3.0 * t).cos();
        Vector::new(r * (2.0 * t).cos(), r * (2.0 * t).sin(), (3.0 * t).sin())
    };
    let mut mesh = PolygonMesh::default();
    for i in 0..along {
        let t = TAU * f64::from(i) / f64::from(along);
        let (sin, cos) = (3.0 * t).sin_cos();
        // The derivative of the place, and the normal of the torus, which is at a right angle to it.
        let along = Vector::new((2.0 * t).cos(), (2.0 * t).sin(), 0.0) * (-3.0 * sin)
            + Vector::new(-(2.0 * t).sin(), (2.0 * t).cos(), 0.0) * (2.0 * (2.0 + cos))
            + Vector::new(0.0, 0.0, 3.0 * cos);
        let u = Vector::new(cos * (2.0 * t).cos(), cos * (2.0 * t).sin(), sin);
        let v = along.normalize().cross(&u);
        mesh.points.extend((0..around).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(around)).sin_cos();
            Point::from(place(t) + (u * cos + v * sin) * 0.35)
        }));
    }
    let at = |i: u32, k: u32| (i % along as u32) * around as u32 + k % around as u32;
    for i in 0..along as u32 {
        for k in 0..around as u32 {
            mesh.push(&[at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)]);
        }
    }
    mesh
}

/// A figure of blocks with head, arms, legs, ears and a tail, subdivided twice: quads throughout.
pub fn figure() -> PolygonMesh {
    let boxes: [[[i32; 2]; 3]; 9] = [
        // Trunk and head, with a neck between.
        [[2, 6], [1, 4], [3, 8]],
        [[3, 5], [1, 4], [8, 9]],
        [[2, 6], [0, 4], [9, 12]],
        // Legs, arms, ears, tail.
        [[2, 3], [1, 4], [0, 3]],
        [[5, 6], [1, 4], [0, 3]],
        [[0, 2], [2, 3], [6, 7]],
        [[6, 8], [2, 3], [6, 7]],
        [[2, 3], [2, 3], [12, 13]],
        [[5, 6], [2, 3], [12, 13]],
    ];
    let tail = [[3, 5], [4, 6], [3, 4]];
    let is_solid =
        |c: [i32; 3]| boxes.iter().chain([&tail]).any(|b| (0..3).all(|k| (b[k][0]..b[k][1]).contains(&c[k])));
    subdivided(&subdivided(&blocks([8, 6, 13], 0.25, is_solid)))
}

/// A tray for ice, with walls of half a unit: in its only cavity, of 2.5 by 1.5 by 1, stands a ridge across, 0.75 wide and 0.5 high.
/// What fills the cavity is [`ice`]; both have the cavity's quads in common.
pub fn tray() -> PolygonMesh {
    blocks(TRAY, 0.125, |c| !in_cavity(c))
}

/// What fills the cavity of the [`tray`], to its rim.
pub fn ice() -> PolygonMesh {
    blocks(TRAY, 0.125, in_cavity)
}

const TRAY: [i32; 3] = [28, 20, 12];

fn in_cavity([x, y, z]: [i32; 3]) -> bool {
    (4..24).contains(&x) && (4..16).contains(&y) && z >= if (11..17).contains(&x) { 8 } else { 4 }
}

/// Six teeth on a gum: blocks with gaps between, subdivided.
pub fn teeth() -> PolygonMesh {
    let is_solid = |[x, y, z]: [i32; 3]| if z < 2 { true } else { x % 3 != 2 && (1..3).contains(&y) };
    subdivided(&subdivided(&blocks([17, 4, 5], 0.25, is_solid)))
}

/// All of them, with their names.
pub fn all() -> Vec<(&'static str, PolygonMesh)> {
    vec![
        ("bracket", bracket()),
        ("plus", plus()),
        ("two-spheres", two_spheres()),
        ("capsule", capsule()),
        ("knot", knot()),
        ("figure", figure()),
        ("tray", tray()),
        ("ice", ice()),
        ("teeth", teeth()),
    ]
}
