//! The ball by itself: where it comes to rest at a point, for whoever moves the points.

use super::contact::{Ground, UNTOUCHED};
use super::remesh::LONGEST;
use super::{BESIDE, TOUCHING};
use crate::mesh::{NotManifold, Point, TriangleMesh, Vector};
use crate::threads;

/// A surface that a ball rolls on from outside.
#[derive(Clone, Debug)]
pub struct Roller {
    ground: Ground,
}

/// A ball that came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The point of the closing that it touches.
    pub point: Point,
    /// The unit vector from there to its centre: the normal of the closing.
    pub normal: Vector,
    /// How far the point that was asked about is inside of the closing; negative where it is outside, 0 where the ball touches it.
    pub gap: f64,
}

impl Roller {
    /// Arranges a surface for a ball to roll on.
    ///
    /// # Errors
    /// Where the faces form no surface.
    pub fn new(surface: &TriangleMesh) -> Result<Roller, NotManifold> {
        Ok(Roller { ground: Ground::new(surface)? })
    }

    /// Where a ball of `radius` that is empty of the surface rests that comes nearest to `p`, looked for from the side to which
    /// the unit vector `normal` points; `None` where it finds no rest on this side.
    pub fn touch(&self, p: Point, normal: Vector, radius: f64) -> Option<Touch> {
        // A point of the surface is nowhere outside of the closing, so a ball that touches it is the nearest.
        if self.ground.hierarchy.is_nearer(p, TOUCHING * radius) && self.is_free(p, normal, radius) {
            return Some(Touch { point: p, normal, gap: 0.0 });
        }
        let rest = self.ground.rest(p, p + normal * radius, radius, UNTOUCHED)?;
        let way = rest.center - p;
        let is_behind = self.ground.hierarchy.is_crossed(p + way * BESIDE, rest.center);
        (!is_behind).then(|| Touch { point: rest.point(), normal: rest.normal, gap: way.norm() - radius })
    }

    /// Whether the ball of `radius` that touches the point `p` of the surface along `normal` is empty of it.
    fn is_free(&self, p: Point, normal: Vector, radius: f64) -> bool {
        !self.ground.hierarchy.is_nearer(p + normal * radius, radius * (1.0 - TOUCHING))
    }
}

/// What a ball finds on a surface that is to be the closing of the one it rolls on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// The largest distance from the closing that the ball found.
    pub largest: f64,
    /// Places in faces that are farther from it than was allowed, in the order of the faces.
    pub off: Vec<Point>,
    /// How many of them are where the ball finds no rest: nobody can tell how far they are.
    pub lost: usize,
    /// The area of those faces.
    pub off_area: f64,
}

impl Roller {
    /// Asks in every face how far it is from the closing by a ball of the radius at the place, where that is above zero: at its
    /// middle, or all over it where it has sides longer than `edge` by half. What is not farther than `edge` is not told.
    pub fn survey(
        &self,
        surface: &TriangleMesh,
        radius: &(dyn Fn(Point) -> f64 + Sync),
        edge: f64,
        threads: usize,
    ) -> Survey {
        let faces: Vec<u32> = (0..surface.faces.len() as u32).collect();
        let looked = threads::map(&faces, threads, |&f| {
            let doubled = surface.area_vector(f as usize);
            let normal = doubled.try_normalize(0.0)?;
            let [a, b, c] = surface.triangle(f as usize);
            let is_coarse = [b - a, c - b, a - c].iter().any(|side| side.norm() > LONGEST * edge);
            let place = if is_coarse {
                self.ground.hidden_between([a, b, c], &|p| radius(p), edge)?
            } else {
                Point::from((a.coords + b.coords + c.coords) / 3.0)
            };
            let r = radius(place);
            (r > 0.0).then(|| (place, self.touch(place, normal, r).map(|touch| touch.gap.abs()), 0.5 * doubled.norm()))
        });
        let mut survey = Survey::default();
        for (place, gap, area) in looked.into_iter().flatten() {
            if gap.is_none_or(|gap| gap > edge) {
                survey.off.push(place);
                survey.off_area += area;
            }
            survey.lost += usize::from(gap.is_none());
            survey.largest = survey.largest.max(gap.unwrap_or(0.0));
        }
        survey
    }
}
