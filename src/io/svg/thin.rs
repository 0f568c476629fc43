//! Outlines with no more vertices than a screen can show.

use crate::plane::{Link, Point, Region, Ring, Segment, Vertex};

/// An arc with ends less than so many units of rounding apart is drawn straight: its ends may round past each other, and what
/// was a bit of a circle would be all of it.
const SHORTEST_ARC: f64 = 10.0;

/// The region with what an operation moved rounded to multiples of `unit`, and without the moved vertices that lie within
/// `tolerance` of the line through those that are left. Vertices with an identity stay as they are.
pub(super) fn thinned(region: &Region, tolerance: f64, unit: f64) -> Region {
    Region::new(region.rings.iter().map(|ring| thinned_ring(ring, tolerance, unit)).collect())
}

fn thinned_ring(ring: &Ring, tolerance: f64, unit: f64) -> Ring {
    let n = ring.len();
    // Between two moved straight links a vertex may go.
    let may_go = |k: usize| {
        let (vertex, before) = (&ring.vertices[k], &ring.vertices[(k + n - 1) % n]);
        vertex.id.is_none() && vertex.link == Link::Line && before.link == Link::Line
    };
    let mut stays: Vec<bool> = (0..n).map(|k| !may_go(k)).collect();
    if n > 3 && !stays.iter().any(|&s| s) {
        // A ring that moved as a whole is held by its first vertex and the one farthest from it.
        let first = ring.vertices[0].point;
        let away = |k: &usize| (ring.vertices[*k].point - first).norm();
        stays[0] = true;
        if let Some(far) = (1..n).max_by(|a, b| away(a).total_cmp(&away(b))) {
            stays[far] = true;
        }
    }
    let held: Vec<usize> = (0..n).filter(|&k| stays[k]).collect();
    if n > 3 {
        for (i, &from) in held.iter().enumerate() {
            let to = held.get(i + 1).copied().unwrap_or(held[0] + n);
            hold_needed(|k| ring.vertices[k % n].point, from, to, tolerance, &mut |k| stays[k % n] = true);
        }
    }
    let mut vertices: Vec<Vertex> = (0..n).filter(|&k| stays[k] || n <= 3).map(|k| rounded(ring, k, unit)).collect();
    vertices.dedup_by(|next, vertex| {
        let is_same = vertex.point == next.point && vertex.link == Link::Line && n > 3;
        if is_same {
            (vertex.link, vertex.id) = (next.link, vertex.id.or(next.id));
        }
        is_same
    });
    Ring { vertices }
}

/// Holds of the points between `from` and `to` those without which the line would stray (Douglas and Peucker, 1973).
fn hold_needed(point: impl Fn(usize) -> Point, from: usize, to: usize, tolerance: f64, hold: &mut impl FnMut(usize)) {
    let mut pending = vec![(from, to)];
    while let Some((from, to)) = pending.pop() {
        let chord = Segment::line(point(from), point(to));
        let away = |k: usize| (chord.nearest(point(k)).distance, k);
        let farthest = (from + 1..to).map(away).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, k)) = farthest.filter(|(distance, _)| *distance > tolerance) {
            hold(k);
            pending.extend([(from, k), (k, to)]);
        }
    }
}

fn rounded(ring: &Ring, k: usize, unit: f64) -> Vertex {
    let vertex = ring.vertices[k];
    let next = &ring.vertices[(k + 1) % ring.len()];
    let round = |x: f64| {
        let steps = (x / unit).round();
        // A product with a power of ten below one would end in many digits, a quotient does not.
        if unit < 1.0 { steps / (1.0 / unit).round() } else { steps * unit }
    };
    let point = match vertex.id {
        Some(_) => vertex.point,
        None => vertex.point.map(round),
    };
    let link = match vertex.link {
        Link::Arc(arc) if vertex.id.is_none() || next.id.is_none() => {
            let is_short = (next.point - vertex.point).norm() < SHORTEST_ARC * unit;
            let is_long = ring.segment(k).sweep() > std::f64::consts::PI;
            match (is_short, is_long) {
                (true, true) => Link::Arc(arc),
                (true, false) => Link::Line,
                _ => Link::Arc(crate::plane::Arc { radius: round(arc.radius).max(unit), ..arc }),
            }
        }
        link => link,
    };
    // The ends of a nearly whole circle must stay apart as they are.
    let keeps_ends = |k: usize| {
        let s = ring.segment(k);
        s.sweep() > std::f64::consts::PI && (s.end - s.start).norm() < SHORTEST_ARC * unit
    };
    let before = (k + ring.len() - 1) % ring.len();
    let point = if keeps_ends(k) || keeps_ends(before) { vertex.point } else { point };
    Vertex { point, link, ..vertex }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{BoundaryIndex, VertexId};

    fn circle(n: usize, with_ids: bool) -> Ring {
        let vertex = |k: usize| {
            let (sin, cos) = (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
            let id = with_ids.then(|| VertexId::from_index(k));
            Vertex { id, ..Vertex::corner(Point::new(10.0 * cos, 10.0 * sin)) }
        };
        Ring { vertices: (0..n).map(vertex).collect() }
    }

    #[test]
    fn moved_vertices_are_thinned_within_the_tolerance() {
        let region = Region::new(vec![circle(1000, false)]);
        let thin = thinned(&region, 0.01, 0.001);
        // Chords of a sagitta of 0.01 are 0.89 long, of which 70 go round; halving takes up to twice as many.
        assert!((60..150).contains(&thin.vertex_count()), "{}", thin.vertex_count());
        let index = BoundaryIndex::new(&thin);
        for s in region.segments() {
            assert!(index.distance(s.start) < 0.0111, "{}", s.start);
        }
        for v in &thin.rings[0].vertices {
            assert!(v.point.x.to_string().len() <= 7, "{} has more digits than it was rounded to", v.point.x);
        }
    }

    #[test]
    fn what_has_an_identity_stays_bit_for_bit() {
        let region = Region::new(vec![circle(1000, true), Ring::circle(Point::new(1.0 / 3.0, 0.0), 2.0)]);
        assert_eq!(thinned(&Region::new(vec![region.rings[0].clone()]), 1.0, 0.1).rings[0], region.rings[0]);
        let disk = thinned(&Region::new(vec![region.rings[1].clone()]), 1.0, 0.01);
        assert!((disk.area() / region.rings[1].area() - 1.0).abs() < 0.01, "arcs stay arcs: {}", disk.area());
    }

    #[test]
    fn short_arcs_do_not_become_whole_circles() {
        for k in 0..360 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let start = Point::new(5.0 * cos, 5.0 * sin);
            let arc = crate::plane::Arc { center: Point::origin(), radius: 5.0, turn: crate::plane::Turn::Left };
            let end = arc.travel(start, 1e-4);
            let vertices = vec![
                Vertex { link: Link::Arc(arc), ..Vertex::corner(start) },
                Vertex::corner(end),
                Vertex::corner(Point::new(-3.0 * sin, 3.0 * cos)),
            ];
            let thin = thinned(&Region::new(vec![Ring { vertices }]), 0.0, 0.001);
            assert!(thin.rings[0].segments().all(|s| s.sweep() < 1.0), "{k}");
        }
    }
}
