//! Parts of curves: the samples of a curve by number, and the curve from one sample to another.

use crate::plane::{Point, VertexId};

use super::drawing::{Curve, CurveKind, Sources};

impl Curve {
    /// The number of its last sample, where it ends; the first, where it starts, is 0.
    pub(super) fn last(&self) -> u32 {
        self.inner + 1
    }

    /// The vertex that is sample number `k`.
    pub(super) fn sample(&self, k: u32) -> VertexId {
        match k {
            0 => self.from,
            k if k > self.inner => self.to,
            k => VertexId::from_index((self.first_inner + k) as usize - 1),
        }
    }

    /// Whether it is drawn as chords between samples at equal steps of the parameter: only such a curve has parts.
    pub(super) fn has_parts(&self) -> bool {
        self.steps == self.inner + 1 && !matches!(self.kind, CurveKind::Elliptic { arc: Some(_), .. })
    }

    /// The shape from sample `i` to sample `j`, `i < j`: the same curve in the same direction, up to rounding, and its
    /// own shape where that is all of it. Needs [`Curve::has_parts`].
    pub(super) fn part(&self, sources: &Sources, i: u32, j: u32) -> Option<CurveKind> {
        if (i, j) == (0, self.last()) {
            return Some(self.kind);
        }
        let point = |id| sources.vertex(id).map(|v| v.point);
        let (from, to) = (point(self.from)?, point(self.to)?);
        let (s, t) = (f64::from(i) / f64::from(self.steps), f64::from(j) / f64::from(self.steps));
        Some(match self.kind {
            CurveKind::Quadratic(c) => CurveKind::Quadratic(blossom([from, c, to], [s, t])),
            CurveKind::Cubic(c, d) => {
                let points = [from, c, d, to];
                CurveKind::Cubic(blossom(points, [s, s, t]), blossom(points, [s, t, t]))
            }
            CurveKind::Elliptic { radii, rotation, angle, sweep, arc } => {
                CurveKind::Elliptic { radii, rotation, angle: angle * (t - s), sweep, arc }
            }
        })
    }
}

/// The blossom of a Bézier curve: de Casteljau's construction with another parameter in each step. The control points
/// of the part from s to t are its values at (s, .., s), (s, .., s, t), .., (t, .., t).
fn blossom<const N: usize, const DEGREE: usize>(mut points: [Point; N], parameters: [f64; DEGREE]) -> Point {
    for (step, t) in parameters.into_iter().enumerate() {
        for k in 0..N - 1 - step {
            points[k] = Point::from(points[k].coords * (1.0 - t) + points[k + 1].coords * t);
        }
    }
    points[0]
}
