//! Curvature at a vertex, and what it is compared with.
//!
//! The minimum curvature is that of the paper's eq. 17 and 18, with the factor of eq. 18 put right:
//!
//! ```text
//! H = 1/4 sum of length times dihedral angle (convex: positive),  K = 2 pi - sum of angles,  M = a third of the areas
//! k = (H - sqrt(max(0, H² - M K))) / M
//! ```
//!
//! On samples of a cylinder of radius r it scatters by some per cent about 1/r, as the faces happen to lie. So it is compared,
//! as the turn of an outline is, with what the same formula gives for neighbours in the same directions that do lie on the
//! ball's track: that scatters alike. Edges longer than they may be ([`LONGEST`]) count as edges of the length h, which is
//! what they become once the vertex moves.

use crate::mesh::{Point, Vector};

/// Edges longer than so many edge lengths count as one.
pub(super) const LONGEST: f64 = 1.5;

/// Curvatures that differ from the bound by more than this part of it are compared with the bound itself.
const NEAR: f64 = 0.5;

/// The faces at a vertex, summed up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ring {
    /// A third of the areas.
    pub mass: f64,
    /// The mean curvature, integrated.
    pub mean: f64,
    /// The Gaussian curvature, integrated.
    pub gauss: f64,
    /// The sum of the unit normals, weighted by angles.
    pub normal: Vector,
}

impl Ring {
    /// The sums at `center` among the points `around` it, counterclockwise. `bend` is told each edge and its dihedral angle.
    pub fn new(center: Point, around: &[Point], mut bend: impl FnMut(Vector, f64)) -> Ring {
        let n = around.len();
        let mut ring = Ring { gauss: std::f64::consts::TAU, ..Ring::default() };
        let edge = |i: usize| around[i % n] - center;
        let cross = |i: usize| edge(i).cross(&edge(i + 1));
        let mut before = cross(n - 1);
        for i in 0..n {
            let (here, e) = (cross(i), edge(i));
            let (doubled_area, length) = (here.norm(), e.norm());
            let angle = doubled_area.atan2(e.dot(&edge(i + 1)));
            // The angle between the normals, about the edge.
            let dihedral = -(before.cross(&here).dot(&e) / length.max(f64::MIN_POSITIVE)).atan2(before.dot(&here));
            ring.mass += doubled_area / 6.0;
            ring.gauss -= angle;
            ring.mean += 0.25 * length * dihedral;
            ring.normal += here * (angle / doubled_area.max(f64::MIN_POSITIVE));
            bend(e, dihedral);
            before = here;
        }
        ring
    }

    /// The minimum and the maximum curvature.
    pub fn principal(&self) -> [f64; 2] {
        let root = (self.mean * self.mean - self.mass * self.gauss).max(0.0).sqrt();
        [(self.mean - root) / self.mass, (self.mean + root) / self.mass]
    }
}

/// What of curvature a flow is driven by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    Minimum,
    Maximum,
    Mean,
}

/// Curvature at a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curved {
    /// What drives the flow.
    pub curvature: f64,
    /// What it is at the bound.
    pub unit: f64,
}

/// The curvature at `center`, `unit` being 1/r. Points farther away than they may be are drawn near in `around`.
pub(super) fn curved(center: Point, around: &mut [Point], measure: Measure, r: f64, h: f64) -> Curved {
    for p in around.iter_mut() {
        let e = *p - center;
        let length = e.norm();
        if length > LONGEST * h {
            *p = center + e * (h / length);
        }
    }
    let mut tensor = Tensor::default();
    let mut bends = [(Vector::zeros(), 0.0); MOST_BENDS];
    let mut count = 0;
    let ring = Ring::new(center, around, |e, angle| {
        if count < MOST_BENDS {
            bends[count] = (e, angle);
            count += 1;
        }
    });
    let [least, most] = ring.principal();
    let unit = 1.0 / r;
    let (curvature, other, sign) = match measure {
        Measure::Minimum => (least, most, -1.0),
        Measure::Maximum => (most, least, 1.0),
        Measure::Mean => return Curved { curvature: ring.mean / ring.mass, unit },
    };
    let is_near = (sign * curvature * r - 1.0).abs() < NEAR && other.abs() * h < 1.0;
    let Some(normal) = ring.normal.try_normalize(0.0).filter(|_| is_near) else { return Curved { curvature, unit } };
    let frame = Frame::new(normal);
    bends[..count].iter().for_each(|(e, angle)| tensor.add(frame.project(*e), *angle));
    let [x, y] = tensor.direction(measure == Measure::Maximum);
    let along = frame.u * x + frame.v * y;
    let across = normal.cross(&along);
    // The same directions and distances in the tangent plane, on a surface that has the bound's curvature.
    for p in around.iter_mut() {
        let e = *p - center;
        let (s, t) = (e.dot(&along), e.dot(&across));
        let height = -sign * s * s / (r + (r * r - s * s).max(0.0).sqrt()) - 0.5 * other * t * t;
        *p = center + along * s + across * t + normal * height;
    }
    let model = Ring::new(center, around, |_, _| {}).principal();
    let model = sign * if measure == Measure::Minimum { model[0] } else { model[1] };
    // Nothing that makes a bound of its own.
    Curved { curvature, unit: model.clamp((1.0 - NEAR) * unit, (1.0 + NEAR) * unit) }
}

/// Vertices with more edges than this have their direction from so many.
const MOST_BENDS: usize = 32;

/// Two directions in a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub u: Vector,
    pub v: Vector,
}

impl Frame {
    /// The plane across a unit normal.
    pub fn new(normal: Vector) -> Frame {
        let axis = Vector::ith(normal.iamin(), 1.0);
        let u = axis.cross(&normal).normalize();
        Frame { u, v: normal.cross(&u) }
    }

    pub fn project(&self, e: Vector) -> [f64; 2] {
        [e.dot(&self.u), e.dot(&self.v)]
    }
}

/// How a surface bends in its tangent plane: the sum of length times dihedral angle over edges, across the edge (Cohen-Steiner
/// and Morvan, 2003).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tensor {
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Tensor {
    /// Adds an edge in the plane that bends by so much.
    pub fn add(&mut self, [x, y]: [f64; 2], angle: f64) {
        let length = x.hypot(y);
        if length > 0.0 {
            let w = angle / length;
            self.xx += w * y * y;
            self.xy -= w * x * y;
            self.yy += w * x * x;
        }
    }

    /// The unit direction in which it bends least, or most.
    pub fn direction(&self, most: bool) -> [f64; 2] {
        // Of the direction that bends most.
        let angle = 0.5 * (2.0 * self.xy).atan2(self.xx - self.yy);
        let (sin, cos) = angle.sin_cos();
        if most { [cos, sin] } else { [-sin, cos] }
    }
}
