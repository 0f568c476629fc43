//! Curvature at a vertex, and what it is compared with.
//!
//! The minimum curvature is that of the paper's eq. 17 and 18, with the factor of eq. 18 put right:
//!
//! ```text
//! H = 1/4 sum of length times dihedral angle (convex: positive),  K = 2 pi - sum of angles,  M = a third of the areas
//! k = (H - sqrt(max(0, H² - M K))) / M
//! ```
//!
//! On samples of a cylinder of radius r that scatters by some per cent about 1/r (by half of it where a vertex has four
//! edges), as the faces happen to lie, and in a flow that goes one way only scatter is drift. So where the quadratic function
//! that fits the neighbours best is determined, its curvature counts: on the same samples, r being eight edge lengths, it is
//! off by 0.0043 of 1/r and scatters by 0.0003. Edges longer than they may be ([`COARSE`]) count as edges of the length h, which
//! is what they become once the vertex moves.

use nalgebra::{SMatrix, SVector};

use crate::mesh::{Point, Vector};

/// Edges longer than so many edge lengths are cut at moving vertices, and count as one edge length at others.
pub(super) const COARSE: f64 = 2.0;

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
    /// The sums at `center` among the points `around` it, counterclockwise.
    pub fn new(center: Point, around: &[Point]) -> Ring {
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

/// What is added to the diagonal of the fit of a quadratic function, whose terms are about 1: neighbours that lie on a conic section
/// leave one open.
const OPEN: f64 = 1e-6;

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
pub(super) fn curved(center: Point, around: &mut [Point], ring: usize, measure: Measure, r: f64, h: f64) -> Curved {
    for p in &mut around[..ring] {
        let e = *p - center;
        let length = e.norm();
        if length > COARSE * h {
            *p = center + e * (h / length);
        }
    }
    let ring = Ring::new(center, &around[..ring]);
    let unit = 1.0 / r;
    let fitted = || {
        let frame = Frame::new(ring.normal.try_normalize(0.0)?);
        let bending = Tensor::fitted(center, around, &frame)?;
        Some(bending.along(bending.direction(measure == Measure::Maximum)))
    };
    let [least, most] = ring.principal();
    let curvature = match measure {
        Measure::Minimum => fitted().unwrap_or(least),
        Measure::Maximum => fitted().unwrap_or(most),
        Measure::Mean => ring.mean / ring.mass,
    };
    Curved { curvature, unit }
}

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

    /// How the surface bends at `center` by the quadratic function that fits its neighbours best (Cazals and Pouget, 2005); `None`
    /// where they leave it open.
    pub fn fitted(center: Point, around: &[Point], frame: &Frame) -> Option<Tensor> {
        if around.len() < 5 {
            return None;
        }
        let normal = frame.u.cross(&frame.v);
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        let mut right = SVector::<f64, 5>::zeros();
        let scale2 = around.iter().map(|p| (p - center).norm_squared()).sum::<f64>() / around.len() as f64;
        let scale = 1.0 / scale2.sqrt().max(f64::MIN_POSITIVE);
        for p in around {
            let e = (p - center) * scale;
            let [x, y] = frame.project(e);
            // Divided by the square of the distance, the height on a circle is half of its curvature, however far away.
            let height = e.dot(&normal) * (x * x + y * y) / e.norm_squared();
            // Heights outward fall where the surface is convex.
            let row = SVector::<f64, 5>::from([x, y, -0.5 * x * x, -x * y, -0.5 * y * y]);
            let weight = 1.0 / e.norm_squared();
            matrix += row * row.transpose() * weight;
            right += row * (weight * height);
        }
        // Rounding of neighbours on a conic section.
        for k in 0..5 {
            matrix[(k, k)] += OPEN;
        }
        let x = matrix.cholesky()?.solve(&right) * scale;
        x.iter().all(|x| x.is_finite()).then_some(Tensor { xx: x[2], xy: x[3], yy: x[4] })
    }

    /// The curvature in a unit direction.
    pub fn along(&self, [x, y]: [f64; 2]) -> f64 {
        self.xx * x * x + 2.0 * self.xy * x * y + self.yy * y * y
    }

    /// The unit direction in which it bends least, or most.
    pub fn direction(&self, most: bool) -> [f64; 2] {
        // Of the direction that bends most.
        let angle = 0.5 * (2.0 * self.xy).atan2(self.xx - self.yy);
        let (sin, cos) = angle.sin_cos();
        if most { [cos, sin] } else { [-sin, cos] }
    }
}
