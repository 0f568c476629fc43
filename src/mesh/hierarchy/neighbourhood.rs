//! The triangles near a place, gathered once for many queries around there.

use super::{Hierarchy, Nearest};
use crate::mesh::{Point, Vector, nearest_on_triangle};

/// Squares of distances that differ by less than this part may have been taken for each other by the search through the boxes: then
/// that search decides.
const ALIKE: f64 = 1e-12;

/// What rounding makes of distances is less than this part of them.
const ROUNDING: f64 = 1e-12;

/// The triangles of a hierarchy that are nearer than some distance to a place.
#[derive(Clone, Debug)]
pub struct Neighbourhood {
    center: Point,
    within: f64,
    /// The nearest first.
    triangles: Vec<Near>,
}

/// A triangle that is near: all of it is behind the plane across the way to its nearest point.
#[derive(Clone, Copy, Debug)]
struct Near {
    distance: f64,
    /// The unit vector from its nearest point to the place; zero on the triangle.
    away: Vector,
    /// Its number in the hierarchy.
    number: u32,
}

impl Neighbourhood {
    /// Gathers all that is nearer than `within` to a place; nothing, which covers nothing, where that is more than `most` triangles.
    pub fn gather(hierarchy: &Hierarchy, center: Point, within: f64, most: usize) -> Neighbourhood {
        let limit = within * within;
        let mut triangles = Vec::new();
        let is_too_much = hierarchy.any(
            |node, disk| node.distance2(&center) < limit && disk.distance2(&center) < limit,
            |triangle, k| {
                let way = center - nearest_on_triangle(center, *triangle).0;
                if way.norm_squared() < limit {
                    let away = way.try_normalize(0.0).unwrap_or_default();
                    triangles.push(Near { distance: way.norm(), away, number: k as u32 });
                }
                triangles.len() > most
            },
        );
        if is_too_much {
            return Neighbourhood { center, within: 0.0, triangles: Vec::new() };
        }
        triangles.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance));
        Neighbourhood { center, within, triangles }
    }

    /// Whether all is gathered that is nearer than `within` to `p`.
    pub fn covers(&self, p: Point, within: f64) -> bool {
        (p - self.center).norm() + within < self.within * (1.0 - ROUNDING)
    }

    /// What [`Hierarchy::nearest`] finds, to the last bit, where the neighbourhood [covers](Neighbourhood::covers) what is asked for.
    pub fn nearest(&self, hierarchy: &Hierarchy, p: Point, within: f64) -> Option<Nearest> {
        let way = p - self.center;
        let rounding = ROUNDING * self.within;
        let reach = way.norm() + rounding;
        let within2 = within * within;
        // What is not nearer than this is out of question.
        let mut limit2 = within2 * (1.0 + ALIKE);
        let mut limit = limit2.sqrt();
        let (mut best2, mut best, mut is_alone) = (f64::INFINITY, None, true);
        for near in &self.triangles {
            if near.distance > limit + reach {
                break;
            }
            if near.distance + near.away.dot(&way) > limit + rounding {
                continue;
            }
            let (point, feature) = nearest_on_triangle(p, hierarchy.triangles[near.number as usize]);
            let d2 = (p - point).norm_squared();
            if d2 > limit2 {
                continue;
            }
            is_alone = d2 * (1.0 + ALIKE) < best2;
            if d2 < best2 {
                (best2, best) = (d2, Some((point, near.number, feature)));
                limit2 = d2 * (1.0 + ALIKE);
                limit = limit2.sqrt();
            }
        }
        let (point, k, feature) = best?;
        if !is_alone || best2 * (1.0 + ALIKE) >= within2 {
            return hierarchy.nearest2(p, within2.min(best2 * (1.0 + ALIKE).powi(2) + f64::MIN_POSITIVE));
        }
        Some(Nearest { point, distance: best2.sqrt(), face: hierarchy.faces[k as usize], feature })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_gathered_answers_as_the_hierarchy_does() {
        // A wavy sheet with flat parts, on which many triangles are equally near: above edges and corners.
        let count = 24;
        let place = |i: u32, j: u32| {
            let (x, y) = (f64::from(i), f64::from(j));
            Point::new(x, y, if i < count / 2 { 0.0 } else { (0.9 * x).sin() + (0.7 * y).cos() })
        };
        let points: Vec<Point> = (0..count * count).map(|k| place(k % count, k / count)).collect();
        let faces: Vec<[u32; 3]> = (0..(count - 1) * (count - 1))
            .flat_map(|k| {
                let v = k % (count - 1) + k / (count - 1) * count;
                [[v, v + 1, v + count], [v + 1, v + count + 1, v + count]]
            })
            .collect();
        let hierarchy = Hierarchy::new(&points, &faces);
        let (mut found, mut outside) = (0, 0);
        for k in 0..40u32 {
            let center = Point::new(0.55 * f64::from(k), 0.3 * f64::from(k % 7) + 9.0, 0.25 * f64::from(k % 11));
            let around = Neighbourhood::gather(&hierarchy, center, 3.0, 1000);
            for n in 0..125u32 {
                let way = [n % 5, n / 5 % 5, n / 25].map(|x| 0.25 * f64::from(x) - 0.5);
                let p = center + Vector::from(way);
                for within in [0.5, 1.0, 2.0, 2.5] {
                    if around.covers(p, within) {
                        let expected = hierarchy.nearest(p, within);
                        assert_eq!(around.nearest(&hierarchy, p, within), expected);
                        found += usize::from(expected.is_some());
                    } else {
                        outside += 1;
                    }
                }
            }
            assert!(!Neighbourhood::gather(&hierarchy, center, 3.0, 2).covers(center, 0.1));
        }
        assert!(found > 1000 && outside > 1000, "{found} {outside}");
    }
}
