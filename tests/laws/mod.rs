//! What every right closing obeys, each law measured by distances alone: shared by tests and the campaign.
//!
//! Nothing here knows how a closing is computed. Lengths are in the units of the drawing.

#![allow(dead_code, reason = "every test uses some of the laws")]

use std::collections::HashSet;

use clopen::plane::{BoundaryIndex, Link, Point, Region, Segment, Turn, Vector, left_normal};
use clopen::reference::Operation;
use clopen::reference::witness::Witness;
use clopen::units::Radius;

/// Samples of a boundary are at most this far apart, over the radius.
const SAMPLE_STEP: f64 = 1.0 / 12.0;

/// Elements have at least this many samples, and no more than [`MOST_SAMPLES`].
const FEWEST_SAMPLES: f64 = 4.0;
const MOST_SAMPLES: f64 = 4096.0;

/// By how much of the radius the radius itself may be off: gaps this near to one diameter, and crossings that hang on it,
/// count as undecided. The rolling disk says of itself that it leaves gaps open that are within 1e-8 of one diameter.
pub const RADIUS_BAND: f64 = 2e-8;

/// What a boundary may be off, over the radius.
pub const ACCURACY: f64 = 1e-7;

/// Points of the boundary: ends and places between.
pub fn samples(region: &Region, r: f64) -> impl Iterator<Item = Point> + '_ {
    region.segments().flat_map(move |s| {
        let count = (s.length() / (SAMPLE_STEP * r)).ceil().clamp(FEWEST_SAMPLES, MOST_SAMPLES);
        (0..count as usize).map(move |k| s.point_at(k as f64 / count))
    })
}

/// The largest distance from a sample of one boundary to the other (exact lines and arcs), and where; infinite where only
/// one of them is empty.
pub fn farthest(from: &Region, to: &BoundaryIndex, r: f64) -> (f64, Point) {
    let mut worst = (0.0, Point::origin());
    for p in samples(from, r) {
        let d = to.distance(p);
        if d > worst.0 {
            worst = (d, p);
        }
    }
    worst
}

/// The distance of two boundaries: the larger of both ways.
pub fn hausdorff(a: &Region, b: &Region, r: f64) -> (f64, Point) {
    match (a.is_empty(), b.is_empty()) {
        (true, true) => (0.0, Point::origin()),
        (true, false) => (f64::INFINITY, b.bounds().center()),
        (false, true) => (f64::INFINITY, a.bounds().center()),
        (false, false) => {
            let (forth, back) = (farthest(a, &BoundaryIndex::new(b), r), farthest(b, &BoundaryIndex::new(a), r));
            if forth.0 >= back.0 { forth } else { back }
        }
    }
}

/// How far the containment fails that the operation promises, and where: a closing holds its input, an opening lies in it.
///
/// Asked at the boundary of the input, which also holds for results whose rings overlap each other, as those that keep
/// the topology do: there solid is what is wound around at least once.
pub fn containment(input: &Region, output: &Region, operation: Operation, r: f64) -> (f64, Point) {
    let index = BoundaryIndex::new(output);
    let mut worst = (0.0, Point::origin());
    for p in samples(input, r) {
        let d = index.distance(p);
        if d.is_finite() && d > worst.0 && (index.winding_number(p) > 0) != (operation == Operation::Close) {
            worst = (d, p);
        }
    }
    if output.is_empty() && !input.is_empty() && operation == Operation::Close {
        worst = (f64::INFINITY, input.bounds().center());
    }
    worst
}

fn bits(p: Point) -> (u64, u64) {
    // Adding zero makes one zero of both.
    ((p.x + 0.0).to_bits(), (p.y + 0.0).to_bits())
}

/// Vertices of the input that lie on the output's boundary, or within `reach` of it, and are none of its vertices. Where
/// the disk bends the boundary it moves every vertex, so only the others count: convex ones for a closing.
pub fn lost_vertices(input: &Region, output: &Region, operation: Operation, reach: f64) -> (usize, Vec<Point>) {
    /// Turns below this are straight.
    const STRAIGHT: f64 = 1e-6;
    let present: HashSet<(u64, u64)> = output.rings.iter().flat_map(|r| &r.vertices).map(|v| bits(v.point)).collect();
    let index = BoundaryIndex::new(output);
    let sign = if operation == Operation::Close { 1.0 } else { -1.0 };
    let (mut still, mut lost) = (0, vec![]);
    for ring in &input.rings {
        let n = ring.len();
        for i in 0..n {
            let (before, after) = (ring.segment((i + n - 1) % n), ring.segment(i));
            let (u, v) = (before.end_tangent(), after.start_tangent());
            let turn = clopen::plane::turn_angle(u, v) * sign;
            if turn > STRAIGHT && index.is_nearer(after.start, reach) {
                still += 1;
                if !present.contains(&bits(after.start)) {
                    lost.push(after.start);
                }
            }
        }
    }
    (still, lost)
}

/// Of vertices that seem lost those that a disk larger by a thousandth still touches: they need not have moved.
///
/// The others may have moved by less than a rounding shows at the radius itself; at the larger one they lie deeper.
pub fn truly_still(lost: Vec<Point>, input: &Region, operation: Operation, r: f64) -> Vec<Point> {
    if lost.is_empty() {
        return lost;
    }
    /// What the witness may miss a touch by. Of two vertices 2.5e-9 r apart at a corner the disk can touch one and pass
    /// the other at 9e-11 r: that one has moved.
    const TOUCHED: f64 = 2e-11;
    let witness = Witness::new(input, radius(r * 1.001), operation);
    lost.into_iter().filter(|&p| witness.depth(p) <= TOUCHED * r).collect()
}

/// Whether a vertex with an identity stands where the input's vertex of that identity stands.
pub fn misplaced_identities(input: &Region, output: &Region) -> usize {
    let mut places = vec![];
    for v in input.rings.iter().flat_map(|r| &r.vertices) {
        if let Some(id) = v.id {
            places.resize(places.len().max(id.index() + 1), None);
            places[id.index()] = Some(bits(v.point));
        }
    }
    let vertices = output.rings.iter().flat_map(|r| &r.vertices);
    vertices.filter_map(|v| Some((v.id?, v.point))).filter(|(id, p)| places[id.index()] != Some(bits(*p))).count()
}

/// Whether every coordinate is a number.
pub fn is_finite(region: &Region) -> bool {
    region.segments().all(|s| {
        let link = match s.link {
            Link::Line => true,
            Link::Arc(arc) => arc.center.coords.iter().all(|x| x.is_finite()) && arc.radius.is_finite(),
        };
        link && s.start.coords.iter().all(|x| x.is_finite())
    })
}

/// A place where the boundary crosses itself or runs the wrong way, by more than [`ACCURACY`].
///
/// Every element is cut where it meets any other; on the left of every piece the winding number must be 1, on the right 0.
/// Pieces that another element accompanies at that accuracy say nothing.
pub fn crossing(region: &Region, r: f64) -> Option<Point> {
    let aside = ACCURACY * r;
    let index = BoundaryIndex::new(region);
    let segments = index.segments();
    let mut cuts: Vec<Vec<f64>> = vec![vec![0.0, 1.0]; segments.len()];
    let boxes: Vec<_> = segments.iter().map(Segment::bounds).collect();
    let mut order: Vec<usize> = (0..segments.len()).collect();
    order.sort_by(|&a, &b| boxes[a].min.x.total_cmp(&boxes[b].min.x));
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..].iter().take_while(|&&j| boxes[j].min.x <= boxes[i].max.x) {
            if boxes[i].overlaps(&boxes[j]) {
                for p in meetings(&segments[i], &segments[j]) {
                    for k in [i, j] {
                        cuts[k].extend(fraction(&segments[k], p));
                    }
                }
            }
        }
    }
    for (s, cuts) in segments.iter().zip(&mut cuts) {
        let length = s.length();
        cuts.sort_by(f64::total_cmp);
        for pair in cuts.windows(2) {
            // Too short to be away from its neighbours.
            if (pair[1] - pair[0]) * length < 100.0 * aside {
                continue;
            }
            let t = 0.5 * (pair[0] + pair[1]);
            let p = s.point_at(t);
            let normal = left_normal(tangent(s, p));
            let alone = [-1.0, 1.0].map(|k| {
                let q = p + normal * (k * 4.0 * aside);
                index.distance(q) > 2.0 * aside
            });
            let winding = |k: f64| index.winding_number(p + normal * (k * aside));
            if alone == [true, true] && (winding(1.0), winding(-1.0)) != (1, 0) {
                return Some(p);
            }
        }
    }
    None
}

fn tangent(s: &Segment, p: Point) -> Vector {
    match s.link {
        Link::Line => s.start_tangent(),
        Link::Arc(arc) => arc.tangent_at(p),
    }
}

/// Where on the element, as a fraction of its length, a point of its carrier lies.
fn fraction(s: &Segment, p: Point) -> Option<f64> {
    let t = match s.link {
        Link::Line => {
            let d = s.end - s.start;
            (p - s.start).dot(&d) / d.norm_squared()
        }
        Link::Arc(arc) => arc.angle_between(s.start, p) / s.sweep(),
    };
    (t > 0.0 && t < 1.0).then_some(t)
}

/// Points where the carriers of two elements meet.
fn meetings(a: &Segment, b: &Segment) -> Vec<Point> {
    match (a.link, b.link) {
        (Link::Line, Link::Line) => {
            let (u, v, w) = (a.end - a.start, b.end - b.start, b.start - a.start);
            let cross = u.perp(&v);
            if cross == 0.0 { vec![] } else { vec![a.start + u * (w.perp(&v) / cross)] }
        }
        (Link::Line, Link::Arc(arc)) => line_circle(a, arc.center, arc.radius),
        (Link::Arc(arc), Link::Line) => line_circle(b, arc.center, arc.radius),
        (Link::Arc(p), Link::Arc(q)) => {
            let d = q.center - p.center;
            let distance = d.norm();
            if distance == 0.0 {
                return vec![];
            }
            let u = d / distance;
            let along = 0.5 * (distance + (p.radius - q.radius) * (p.radius + q.radius) / distance);
            both_sides(p.center + u * along, left_normal(u), (p.radius - along) * (p.radius + along))
        }
    }
}

fn line_circle(line: &Segment, center: Point, radius: f64) -> Vec<Point> {
    let Some(u) = (line.end - line.start).try_normalize(0.0) else { return vec![] };
    let foot = line.start + u * (center - line.start).dot(&u);
    let height = (center - foot).norm();
    both_sides(foot, u, (radius - height) * (radius + height))
}

fn both_sides(foot: Point, direction: Vector, squared: f64) -> Vec<Point> {
    if squared < 0.0 {
        return vec![];
    }
    let v = direction * squared.sqrt();
    vec![foot + v, foot - v]
}

/// Whether any arc turns the way that the operation removes and is tighter than the disk, which no right result has.
pub fn tightest(region: &Region, operation: Operation) -> f64 {
    let removed = if operation == Operation::Close { Turn::Right } else { Turn::Left };
    let arcs = region.segments().filter_map(|s| match s.link {
        Link::Arc(arc) if arc.turn == removed => Some(arc.radius),
        _ => None,
    });
    arcs.fold(f64::INFINITY, f64::min)
}

/// The definition of a closing asked at a slightly smaller and at a slightly larger radius.
pub struct Arbiter<'a> {
    input: &'a Region,
    smaller: Witness,
    larger: Witness,
    operation: Operation,
    r: f64,
}

/// A place where a claimed result cannot be right.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    pub place: Point,
    /// By how much, at least.
    pub error: f64,
    pub what: &'static str,
}

impl<'a> Arbiter<'a> {
    pub fn new(input: &'a Region, operation: Operation, r: f64) -> Arbiter<'a> {
        let witness = |factor: f64| Witness::new(input, radius(r * factor), operation);
        Arbiter { input, smaller: witness(1.0 - RADIUS_BAND), larger: witness(1.0 + RADIUS_BAND), operation, r }
    }

    /// How far a point is from being on the boundary, whatever the radius in the band.
    fn off_boundary(&self, p: Point) -> (f64, &'static str) {
        let (low, high) = (self.smaller.depth(p), self.larger.depth(p));
        if low > 0.0 { (low, "is covered by the truth") } else { ((-high).max(0.0), "has a free disk over it") }
    }

    /// The worst of these points that `claim` has on its boundary.
    pub fn fault_on_boundary(&self, points: impl Iterator<Item = Point>) -> Option<Fault> {
        self.worst(points.map(|p| {
            let (error, what) = self.off_boundary(p);
            Fault { place: p, error, what }
        }))
    }

    /// The worst of these points that do not lie on the boundary of `claim`, but may have to.
    pub fn fault_off_boundary(&self, claim: &Region, points: impl Iterator<Item = Point>) -> Option<Fault> {
        let index = BoundaryIndex::new(claim);
        self.worst(points.filter_map(|p| {
            let d = if claim.is_empty() { self.r } else { index.distance(p) };
            if d <= ACCURACY * self.r {
                return None;
            }
            let filled = claim.contains(p) == (self.operation == Operation::Close);
            if filled {
                // All within d is filled: so it must be that deep, which depths are told up to a tenth of the radius.
                let depth = self.larger.depth(p);
                let error = d.min(0.09 * self.r) - depth;
                return Some(Fault { place: p, error, what: "is filled too deep" });
            }
            // Nothing within d is filled.
            let around = (0..8).map(|k| {
                let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
                p + Vector::new(cos, sin) * (0.7 * d)
            });
            around
                .chain([p])
                .map(|p| Fault { place: p, error: self.smaller.depth(p), what: "is left empty" })
                .max_by(|a, b| a.error.total_cmp(&b.error))
        }))
    }

    fn worst(&self, faults: impl Iterator<Item = Fault>) -> Option<Fault> {
        faults.filter(|f| f.error > ACCURACY * self.r).max_by(|a, b| a.error.total_cmp(&b.error))
    }

    /// Why `claim` is wrong, judged where it differs from `other` by more than `apart` (units); `None` where it is not.
    pub fn fault_against(&self, claim: &Region, other: &Region, apart: f64, most: usize) -> Option<Fault> {
        let far = |from: &Region, to: &Region| {
            let index = BoundaryIndex::new(to);
            let far: Vec<Point> =
                samples(from, self.r).filter(|p| to.is_empty() || index.distance(*p) > apart).collect();
            thinned(far, most)
        };
        self.fault_on_boundary(far(claim, other).into_iter())
            .or_else(|| self.fault_off_boundary(claim, far(other, claim).into_iter()))
    }

    /// Why `claim` is wrong, judged at about `most` points of its boundary and of the input's.
    pub fn fault(&self, claim: &Region, most: usize) -> Option<Fault> {
        let of_claim = thinned(samples(claim, self.r).collect(), most);
        let of_input = thinned(samples(self.input, self.r).collect(), most);
        // A point of the input that even a larger disk touches is on the boundary of the truth.
        let touched = of_input.into_iter().filter(|p| self.larger.depth(*p) <= 0.1 * ACCURACY * self.r);
        self.fault_on_boundary(of_claim.into_iter()).or_else(|| {
            let index = BoundaryIndex::new(claim);
            self.worst(touched.map(|p| {
                let error = if claim.is_empty() { self.r } else { index.distance(p) };
                Fault { place: p, error, what: "is touched by a free disk and not on the boundary" }
            }))
        })
    }
}

fn thinned(points: Vec<Point>, most: usize) -> Vec<Point> {
    let step = points.len().div_ceil(most.max(1)).max(1);
    points.into_iter().step_by(step).collect()
}

pub fn radius(r: f64) -> Radius {
    Radius::new(r).expect("radii of tests are positive")
}

/// `region` as the text of a Rust expression, for a test that repeats a fault.
pub fn as_rust(region: &Region) -> String {
    let mut text = String::from("Region::new(vec![\n");
    for ring in &region.rings {
        text += "    Ring { vertices: vec![\n";
        for v in &ring.vertices {
            match v.link {
                Link::Line => text += &format!("        line({:?}, {:?}),\n", v.point.x, v.point.y),
                Link::Arc(a) => {
                    text += &format!(
                        "        arc({:?}, {:?}, {:?}, {:?}, {:?}, Turn::{:?}),\n",
                        v.point.x, v.point.y, a.center.x, a.center.y, a.radius, a.turn
                    );
                }
            }
        }
        text += "    ] },\n";
    }
    text + "])"
}
