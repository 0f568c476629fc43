//! Rings made of bytes: whatever they are, closing does not panic and gives numbers; and where they are rings without
//! crossings, the closing holds them.
#![no_main]

use clopen::plane::{Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex, VertexId};
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use libfuzzer_sys::fuzz_target;

/// What may poke out, over the radius.
const CONTAINMENT: f64 = 1e-9;

/// The first bytes choose the grid, the place, the radius and whether it is a star; every three more are a vertex.
struct Case {
    region: Region,
    r: f64,
    is_star: bool,
}

fn case(bytes: &[u8]) -> Option<Case> {
    let (&[kind, size, far, radius], rest) = bytes.split_first_chunk::<4>()?;
    let scale = f64::from(i32::from(size % 32) - 16).exp2();
    let offset = if far > 200 { Vector::new(1048576.0, -524288.0) * scale } else { Vector::zeros() };
    let r = scale * (f64::from(radius) + 1.0) / 8.0;
    let is_star = kind % 4 != 0;
    let mut rings = vec![];
    let mut vertices: Vec<Vertex> = vec![];
    let count = (rest.len() / 3).min(256);
    // Rings without vertices are a case of tests/found.rs.
    if count == 0 {
        return None;
    }
    for (k, b) in rest.chunks_exact(3).take(count).enumerate() {
        let point = if is_star {
            // One ring around the origin, which cannot cross itself.
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            Point::new(cos, sin) * (1.0 + f64::from(b[0]))
        } else {
            Point::new(f64::from(b[0]), f64::from(b[1]))
        };
        let point = point * scale + offset;
        let joint = if b[2] & 8 != 0 { Joint::Smooth } else { Joint::Corner };
        let id = Some(VertexId::from_index(k));
        vertices.push(Vertex { point, link: Link::Line, joint, id });
        if !is_star && b[2] & 7 == 7 {
            rings.push(ring(std::mem::take(&mut vertices), rest));
        }
    }
    if !vertices.is_empty() {
        rings.push(if is_star { Ring { vertices } } else { ring(vertices, rest) });
    }
    Some(Case { region: Region::new(rings), r, is_star: is_star && count > 2 })
}

/// Some links become arcs.
fn ring(mut vertices: Vec<Vertex>, bytes: &[u8]) -> Ring {
    let n = vertices.len();
    for i in 0..n {
        let (a, b) = (vertices[i].point, vertices[(i + 1) % n].point);
        let bend = bytes[(7 * i + 1) % bytes.len()];
        if bend < 192 || a == b {
            continue;
        }
        let bulge = (f64::from(bend) - 223.5) / 32.0;
        let chord = b - a;
        let center = a + chord * 0.5 + Vector::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let turn = if bulge > 0.0 { Turn::Left } else { Turn::Right };
        vertices[i].link = Link::Arc(Arc { center, radius: (a - center).norm(), turn });
    }
    Ring { vertices }
}

fuzz_target!(|bytes: &[u8]| {
    let Some(Case { region, r, is_star }) = case(bytes) else { return };
    let Ok(radius) = Radius::new(r) else { return };
    let largest = region.bounds().min.coords.amax().max(region.bounds().max.coords.amax());
    for topology in [Topology::Merge, Topology::Keep] {
        let closed = rolling::close(&region, radius, topology).region;
        for v in closed.rings.iter().flat_map(|r| &r.vertices) {
            assert!(v.point.x.is_finite() && v.point.y.is_finite(), "{topology:?}: a coordinate is not finite");
        }
        let opened = rolling::open(&region, radius, topology).region;
        for v in opened.rings.iter().flat_map(|r| &r.vertices) {
            assert!(v.point.x.is_finite() && v.point.y.is_finite(), "{topology:?}: a coordinate is not finite");
        }
        if !is_star {
            continue;
        }
        let index = BoundaryIndex::new(&closed);
        for p in region.segments().flat_map(|s| [s.start, s.point_at(0.5)]) {
            let d = index.distance(p);
            let allowed = CONTAINMENT * r + 8.0 * f64::EPSILON * largest;
            assert!(d <= allowed || index.winding_number(p) > 0, "{topology:?}: {p} pokes out by {} r", d / r);
        }
    }
});
