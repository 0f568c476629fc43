//! The point of an intersection of a few half-spaces that is nearest to a given one.

use crate::mesh::{Point, Vector};

/// The half-space of the points y with normal·y >= offset; the normal is a unit vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub normal: Vector,
    pub offset: f64,
}

/// The nearest point and what holds it: y = x + the sum of multipliers times normals, multipliers zero or positive, at most
/// three of them above zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub point: Point,
    /// The half-spaces on whose borders it lies, and their multipliers.
    pub by: [(usize, f64); 3],
    pub count: usize,
}

/// Normals whose sine is below this are parallel: two of them hold what one does.
const PARALLEL: f64 = 1e-5;

/// Normals whose triple product is below this hold no more than two of them.
const COPLANAR: f64 = 1e-6;

/// The point of all `spaces` nearest to `x`, each met to `tolerance`; the least violating combination where none is that
/// good but one is within `slack`. `None` where all are worse: the half-spaces have nothing in common near `x`.
///
/// Few half-spaces hold a point, so the combinations of one, two and three are tried in this order, which ends with the
/// true one: a feasible point with positive multipliers is the nearest point (Karush, Kuhn and Tucker).
pub(super) fn nearest(x: Point, spaces: &[HalfSpace], tolerance: f64, slack: f64) -> Option<Held> {
    let violation = |y: &Point| spaces.iter().map(|s| s.offset - s.normal.dot(&y.coords)).fold(0.0, f64::max);
    let none = Held { point: x, by: [(0, 0.0); 3], count: 0 };
    if violation(&x) <= tolerance {
        return Some(none);
    }
    let mut best: Option<(f64, Held)> = None;
    let mut consider = |held: Held| {
        let violation = violation(&held.point);
        if best.as_ref().is_none_or(|(least, _)| violation < *least) {
            best = Some((violation, held));
        }
        violation <= tolerance
    };
    let gap: Vec<f64> = spaces.iter().map(|s| s.offset - s.normal.dot(&x.coords)).collect();
    for (i, s) in spaces.iter().enumerate() {
        if gap[i] > 0.0
            && consider(Held { point: x + s.normal * gap[i], by: [(i, gap[i]), (0, 0.0), (0, 0.0)], count: 1 })
        {
            return best.map(|b| b.1);
        }
    }
    for i in 0..spaces.len() {
        for j in 0..i {
            let (m, n) = (spaces[i].normal, spaces[j].normal);
            let cosine = m.dot(&n);
            let determinant = 1.0 - cosine * cosine;
            if determinant < PARALLEL * PARALLEL {
                continue;
            }
            let a = (gap[i] - cosine * gap[j]) / determinant;
            let b = (gap[j] - cosine * gap[i]) / determinant;
            if a >= 0.0
                && b >= 0.0
                && consider(Held { point: x + m * a + n * b, by: [(i, a), (j, b), (0, 0.0)], count: 2 })
            {
                return best.map(|b| b.1);
            }
        }
    }
    for i in 0..spaces.len() {
        for j in 0..i {
            for k in 0..j {
                let [l, m, n] = [i, j, k].map(|q| spaces[q].normal);
                let (mn, nl, lm) = (m.cross(&n), n.cross(&l), l.cross(&m));
                let determinant = l.dot(&mn);
                if determinant.abs() < COPLANAR {
                    continue;
                }
                let step = (mn * gap[i] + nl * gap[j] + lm * gap[k]) / determinant;
                let [a, b, c] = [mn, nl, lm].map(|cross| step.dot(&cross) / determinant);
                // What rounding makes of a multiplier of zero.
                let least = -1e-12 * (a.abs() + b.abs() + c.abs());
                if a < least || b < least || c < least {
                    continue;
                }
                let by = [(i, a.max(0.0)), (j, b.max(0.0)), (k, c.max(0.0))];
                if consider(Held { point: x + step, by, count: 3 }) {
                    return best.map(|b| b.1);
                }
            }
        }
    }
    best.filter(|(violation, _)| *violation <= slack).map(|(_, held)| held)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(normal: [f64; 3], offset: f64) -> HalfSpace {
        let normal = Vector::from(normal);
        HalfSpace { normal: normal.normalize(), offset: offset / normal.norm() }
    }

    #[test]
    fn one_two_or_three_half_spaces_hold_the_nearest_point() {
        let spaces = [space([1., 0., 0.], 1.0), space([0., 1., 0.], 2.0), space([0., 0., 1.], 3.0)];
        for (count, x, expected) in [
            (0, [5., 5., 5.], [5., 5., 5.]),
            (1, [0., 5., 5.], [1., 5., 5.]),
            (2, [0., 0., 5.], [1., 2., 5.]),
            (3, [0., 0., 0.], [1., 2., 3.]),
        ] {
            let held = nearest(x.into(), &spaces, 1e-12, 0.0).unwrap();
            assert!((held.point - Point::from(expected)).norm() < 1e-12 && held.count == count, "{held:?}");
            let sum: Vector = held.by[..held.count].iter().map(|(k, m)| spaces[*k].normal * *m).sum();
            assert!((Point::from(x) + sum - held.point).norm() < 1e-12);
        }
    }

    #[test]
    fn half_spaces_without_a_common_point_hold_nothing() {
        let apart = [space([1., 0., 0.], 1.0), space([-1., 0., 0.], 1.0)];
        assert!(nearest(Point::origin(), &apart, 1e-9, 0.5).is_none());
        // What is apart by less than the slack is as good as touching.
        let touching = [space([1., 0., 0.], 1.0), space([-1., 0., 0.], -1.0 + 1e-6)];
        assert!(nearest(Point::origin(), &touching, 1e-9, 1e-5).is_some());
    }
}
