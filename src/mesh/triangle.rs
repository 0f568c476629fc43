//! The nearest point of a triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).

use super::Point;

/// The part of a triangle that a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Its inside.
    Face,
    /// The edge from this corner to the next.
    Edge(u8),
    /// This corner.
    Corner(u8),
}

/// The point of the triangle that is nearest to `p`, and what it lies on.
#[inline]
pub fn nearest_on_triangle(p: Point, [a, b, c]: [Point; 3]) -> (Point, Feature) {
    let (ab, ac) = (b - a, c - a);
    let ap = p - a;
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Feature::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Feature::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    let (towards, away) = (d4 - d3, d5 - d6);
    if va <= 0.0 && towards >= 0.0 && away >= 0.0 {
        return (b + (c - b) * (towards / (towards + away)), Feature::Edge(1));
    }
    let scale = 1.0 / (va + vb + vc);
    (a + ab * (vb * scale) + ac * (vc * scale), Feature::Face)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_is_nearest_to_what_lies_beyond_it() {
        let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Point::from);
        for (from, expected, feature) in [
            ([1.0, 1.0, 3.0], [1.0, 1.0, 0.0], Feature::Face),
            ([2.0, -5.0, 1.0], [2.0, 0.0, 0.0], Feature::Edge(0)),
            ([4.0, 4.0, 1.0], [2.0, 2.0, 0.0], Feature::Edge(1)),
            ([-1.0, 3.0, -1.0], [0.0, 3.0, 0.0], Feature::Edge(2)),
            ([-1.0, -1.0, 0.0], [0.0, 0.0, 0.0], Feature::Corner(0)),
            ([6.0, -1.0, 0.0], [4.0, 0.0, 0.0], Feature::Corner(1)),
            ([-1.0, 6.0, 2.0], [0.0, 4.0, 0.0], Feature::Corner(2)),
        ] {
            assert_eq!(nearest_on_triangle(from.into(), triangle), (expected.into(), feature));
        }
    }
}
