//! The final arbiter: whether a point lies in a closing, from the definition and from distances alone.
//!
//! A point is *not* in the closing of a solid iff an open disk of the radius holds it and misses the solid: iff there is a
//! centre at distance at least r from the solid and less than r from the point. So let g(p) be the distance from p to
//! the nearest centre that keeps r from the solid: p is in the closing iff g(p) >= r, and inside it g(p) - r is exactly
//! the depth of p under the boundary of the closing.
//!
//! The nearest centre is p itself, or the foot of p on an offset curve, or a crossing of two offset curves: all of them
//! are listed, nearest first, and the first one that keeps its distance is the answer. Quadratic in the number of
//! elements within 2 r, and without any structure that could be wrong.

use super::{Frame, Operation};
use crate::plane::{BoundaryIndex, Link, Point, Region, Segment, Vector, left_normal, right_normal};
use crate::units::Radius;

/// Half the width of the band around the radius within which no verdict is given, over the radius: the rounding of
/// coordinates at 1e6 radii from the origin stays below it.
pub const RADIUS_BAND: f64 = 1e-9;

/// How near to the boundary of the closing a point counts as on it, over the radius: what a change of the radius by
/// [`RADIUS_BAND`] moves the fillet of a sharp corner.
const DEPTH_BAND: f64 = 4.0 * RADIUS_BAND;

/// By how much a candidate centre may miss its distance by rounding, over the radius: above the rounding of
/// drawings of a thousand radii.
const CANDIDATE_ROUNDING: f64 = 1e-11;

/// How far beyond the radius a nearest centre is looked for, over the radius: depths beyond it are cut off.
const REACH: f64 = 0.1;

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Membership {
    /// In the closing (or opening), even with a slightly smaller (larger) radius.
    Inside,
    /// Outside, even with a slightly different radius.
    Outside,
    /// On the boundary, or a change of the radius by [`RADIUS_BAND`] decides.
    WithinTolerance,
}

/// What the witness says of a claimed result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The largest error of the samples, in the units of the drawing: 0 for a right result, up to rounding. Cut off at a
    /// tenth of the radius for claims that lie too deep inside.
    pub worst_error: f64,
    /// Where it is; `None` without samples.
    pub place: Option<Point>,
    /// How many points were judged.
    pub samples: usize,
    /// How many of them depend on a change of the radius by [`RADIUS_BAND`], as gaps of exactly 2 r do: they are not
    /// counted as errors.
    pub undecidable: usize,
}

/// A solid with its operation, arranged for questions.
pub struct Witness {
    /// In the coordinates of the frame, where the radius is 1.
    region: Region,
    index: BoundaryIndex,
    vertices: Vec<Point>,
    frame: Frame,
    radius: f64,
    operation: Operation,
}

impl Witness {
    /// A witness for the closing or opening of `region` by a disk of `radius`.
    pub fn new(region: &Region, radius: Radius, operation: Operation) -> Witness {
        let frame = Frame::new(region.bounds(), radius.get());
        let region = frame.to_unit(region);
        let vertices = region.rings.iter().flat_map(|r| r.vertices.iter().map(|v| v.point)).collect();
        let index = BoundaryIndex::new(&region);
        Witness { region, index, vertices, frame, radius: radius.get(), operation }
    }

    /// Whether `p` lies in the closing or opening.
    pub fn membership(&self, p: Point) -> Membership {
        // The closing grows with the radius: in it with the smaller one means in it.
        let in_fill = if self.depth_for(p, 1.0 - RADIUS_BAND) > DEPTH_BAND {
            Some(true)
        } else if self.depth_for(p, 1.0 + RADIUS_BAND) < -DEPTH_BAND {
            Some(false)
        } else {
            None
        };
        match (in_fill, self.operation) {
            (None, _) => Membership::WithinTolerance,
            (Some(true), Operation::Close) | (Some(false), Operation::Open) => Membership::Inside,
            (Some(false), Operation::Close) | (Some(true), Operation::Open) => Membership::Outside,
        }
    }

    /// How deep `p` lies in the fill: in the closing of the solid or, for an opening, in the closing of its complement.
    /// Exact inside, up to a tenth of the radius; outside, minus a lower bound of the distance.
    pub fn depth(&self, p: Point) -> f64 {
        self.depth_for(p, 1.0) * self.radius
    }

    /// The centre nearest to `p` of a disk that misses the solid or, for an opening, lies in it; `None` where that is
    /// farther than 1.1 radii.
    pub fn free_center(&self, p: Point) -> Option<Point> {
        self.nearest_center(self.frame.point_to_unit(p), 1.0).map(|c| self.frame.point_to_drawing(c))
    }

    /// The depth of `p` over the radius, for a radius that is larger by the given factor.
    fn depth_for(&self, p: Point, factor: f64) -> f64 {
        self.unit_depth(self.frame.point_to_unit(p), factor)
    }

    /// Whether `p` belongs to what the disk must not touch: the solid, or its complement for an opening.
    fn blocks(&self, p: Point) -> bool {
        self.region.contains(p) == (self.operation == Operation::Close)
    }

    fn keeps_distance(&self, center: Point, r: f64) -> bool {
        !self.index.is_nearer(center, r - CANDIDATE_ROUNDING) && !self.blocks(center)
    }

    fn unit_depth(&self, p: Point, r: f64) -> f64 {
        let distance = self.nearest_center(p, r).map_or(r * (1.0 + REACH), |c| (c - p).norm());
        distance - r
    }

    /// The centre nearest to `p` that keeps `r` from what the disk must not touch, if it is within reach.
    fn nearest_center(&self, p: Point, r: f64) -> Option<Point> {
        if self.keeps_distance(p, r) {
            return Some(p);
        }
        let reach = r * (1.0 + REACH);
        let curves = self.curves_near(p, r, reach);
        let mut candidates: Vec<(f64, Point)> = Vec::new();
        let mut add = |c: Point| {
            let d = (c - p).norm();
            if d <= reach {
                candidates.push((d, c));
            }
        };
        for (i, a) in curves.iter().enumerate() {
            a.feet(p).into_iter().for_each(&mut add);
            for b in &curves[i + 1..] {
                a.crossings(b).into_iter().flatten().for_each(&mut add);
            }
        }
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.x.total_cmp(&b.1.x)).then(a.1.y.total_cmp(&b.1.y)));
        candidates.into_iter().map(|(_, c)| c).find(|&c| self.keeps_distance(c, r))
    }

    /// The curves at distance `r` from elements and vertices that come within `reach` of `p`.
    fn curves_near(&self, p: Point, r: f64, reach: f64) -> Vec<Curve> {
        let mut curves = Vec::new();
        for &v in &self.vertices {
            if ((v - p).norm() - r).abs() <= reach {
                curves.push(Curve::Circle { center: v, radius: r });
            }
        }
        for s in self.index.segments().iter().filter(|s| s.nearest(p).distance <= r + reach) {
            match s.link {
                Link::Line => {
                    let Some(along) = (s.end - s.start).try_normalize(0.0) else { continue };
                    let normal = match self.operation {
                        Operation::Close => right_normal(along),
                        Operation::Open => left_normal(along),
                    };
                    curves.push(Curve::Line { start: s.start + normal * r, end: s.end + normal * r, along });
                }
                Link::Arc(arc) => {
                    curves.push(Curve::Circle { center: arc.center, radius: arc.radius + r });
                    curves.push(Curve::Circle { center: arc.center, radius: (arc.radius - r).abs() });
                }
            }
        }
        curves
    }
}

/// An offset curve; circles are whole, and lines as long as their elements: what is too much fails its distance.
enum Curve {
    Line { start: Point, end: Point, along: Vector },
    Circle { center: Point, radius: f64 },
}

impl Curve {
    fn feet(&self, p: Point) -> Vec<Point> {
        match *self {
            Curve::Line { start, end, .. } => vec![Segment::line(start, end).nearest(p).point, start, end],
            Curve::Circle { center, radius } => {
                // The centre of a circle that has shrunk to nothing is its only point, and harmless otherwise.
                let spoke = (p - center).try_normalize(0.0).unwrap_or(Vector::x());
                vec![center + spoke * radius, center]
            }
        }
    }

    fn crossings(&self, other: &Curve) -> [Option<Point>; 2] {
        match (self, other) {
            (Curve::Line { start: p, along: u, .. }, Curve::Line { start: q, along: v, .. }) => {
                let cross = u.perp(v);
                [(cross != 0.0).then(|| p + u * ((q - p).perp(v) / cross)), None]
            }
            (Curve::Line { start, along, .. }, Curve::Circle { center, radius })
            | (Curve::Circle { center, radius }, Curve::Line { start, along, .. }) => {
                let foot = start + along * (center - start).dot(along);
                let height = (center - foot).norm();
                split(foot, *along, (radius - height) * (radius + height))
            }
            (Curve::Circle { center: p, radius: a }, Curve::Circle { center: q, radius: b }) => {
                let distance = (q - p).norm();
                if distance == 0.0 {
                    return [None, None];
                }
                let u = (q - p) / distance;
                let along = 0.5 * (distance + (a - b) * (a + b) / distance);
                split(p + u * along, left_normal(u), (a - along) * (a + along))
            }
        }
    }
}

/// `foot` displaced to both sides by the root of a square; nothing where the square is negative.
fn split(foot: Point, direction: Vector, half_squared: f64) -> [Option<Point>; 2] {
    if half_squared < 0.0 {
        return [None, None];
    }
    let v = direction * half_squared.sqrt();
    [Some(foot + v), Some(foot - v)]
}

/// Judges a claimed closing or opening `result` of `input` at about `samples` points of either boundary.
///
/// Forth: a point of the claimed boundary has depth 0. Back: a point of the input's boundary that has depth 0 lies on the
/// claimed boundary; every ring of a true closing or opening touches the input, so no ring can be missing.
pub fn judge(input: &Region, result: &Region, radius: Radius, operation: Operation, samples: usize) -> Verdict {
    let r = radius.get();
    let witness = Witness::new(input, radius, operation);
    let claimed = BoundaryIndex::new(result);
    let mut verdict = Verdict { worst_error: 0.0, place: None, samples: 0, undecidable: 0 };
    let mut count = |p: Point, error: f64, is_undecidable: &dyn Fn() -> bool| {
        verdict.samples += 1;
        if error > DEPTH_BAND * r && is_undecidable() {
            verdict.undecidable += 1;
        } else if verdict.place.is_none() || error > verdict.worst_error {
            (verdict.worst_error, verdict.place) = (error, Some(p));
        }
    };
    for p in spread(result, samples) {
        count(p, witness.depth(p).abs(), &|| witness.membership(p) == Membership::WithinTolerance);
    }
    for p in spread(input, samples) {
        let distance = claimed.distance(p);
        let is_missing = distance > DEPTH_BAND * r && witness.depth(p) <= DEPTH_BAND * r;
        // Under a slightly larger closing it is no boundary: then nothing is missing there for sure.
        count(p, if is_missing { distance } else { 0.0 }, &|| witness.depth_for(p, 1.0 + RADIUS_BAND) > DEPTH_BAND);
    }
    verdict
}

/// About `count` points of the boundary at equal steps of its length, and at least one in every ring.
fn spread(region: &Region, count: usize) -> Vec<Point> {
    let step = region.perimeter() / count.max(1) as f64;
    if step <= 0.0 || !step.is_finite() {
        return Vec::new();
    }
    let mut points = Vec::new();
    for ring in &region.rings {
        // Half a step in, so that vertices are no more frequent than anything else.
        let mut ahead = 0.5 * step.min(ring.length());
        for s in ring.segments() {
            let length = s.length();
            while ahead < length {
                points.push(s.point_at(ahead / length));
                ahead += step;
            }
            ahead -= length;
        }
    }
    points
}
