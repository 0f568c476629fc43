//! The ball by itself: where it comes to rest at a point, for whoever moves the points.

use super::contact::{Ground, UNTOUCHED};
use super::{BESIDE, TOUCHING, parallel};
use crate::mesh::{HalfEdgeMesh, Hierarchy, NotManifold, Point, TriangleMesh, Vector};

/// A surface that a ball rolls on from outside.
#[derive(Clone, Debug)]
pub struct Roller {
    mesh: HalfEdgeMesh,
    hierarchy: Hierarchy,
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
        let mesh = HalfEdgeMesh::new(surface.points.clone(), &surface.faces)?;
        Ok(Roller { mesh, hierarchy: Hierarchy::new(&surface.points, &surface.faces) })
    }

    /// Where a ball of `radius` that is empty of the surface rests that comes nearest to `p`, looked for from the side to which
    /// the unit vector `normal` points; `None` where it finds no rest on this side.
    pub fn touch(&self, p: Point, normal: Vector, radius: f64) -> Option<Touch> {
        // A point of the surface is nowhere outside of the closing, so a ball that touches it is the nearest.
        if self.hierarchy.is_nearer(p, TOUCHING * radius) && self.is_free(p, normal, radius) {
            return Some(Touch { point: p, normal, gap: 0.0 });
        }
        let ground = Ground { mesh: &self.mesh, hierarchy: &self.hierarchy };
        let rest = ground.rest(p, p + normal * radius, radius, UNTOUCHED)?;
        let way = rest.center - p;
        let is_behind = self.hierarchy.is_crossed(p + way * BESIDE, rest.center);
        (!is_behind).then(|| Touch { point: rest.point(), normal: rest.normal, gap: way.norm() - radius })
    }

    /// Whether the ball of `radius` that touches the point `p` of the surface along `normal` is empty of it.
    fn is_free(&self, p: Point, normal: Vector, radius: f64) -> bool {
        !self.hierarchy.is_nearer(p + normal * radius, radius * (1.0 - TOUCHING))
    }
}

/// What a ball finds on a surface that is to be the closing of the one it rolls on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// The largest distance of the middle of a face from the closing.
    pub largest: f64,
    /// The middles of faces that are farther from it than was allowed, and where the ball finds no rest, in the order of the faces.
    pub off: Vec<Point>,
    /// The area of those faces.
    pub off_area: f64,
}

impl Roller {
    /// Asks at the middle of every face how far it is from the closing by a ball of the radius at the place, where that is above
    /// zero. What is not farther than `allowed` is not told.
    pub fn survey(
        &self,
        surface: &TriangleMesh,
        radius: &(dyn Fn(Point) -> f64 + Sync),
        allowed: f64,
        threads: usize,
    ) -> Survey {
        let faces: Vec<u32> = (0..surface.faces.len() as u32).collect();
        let looked = parallel::map(&faces, threads, |&f| {
            let doubled = surface.area_vector(f as usize);
            let [a, b, c] = surface.triangle(f as usize);
            let middle = Point::from((a.coords + b.coords + c.coords) / 3.0);
            let r = radius(middle);
            let (Some(normal), true) = (doubled.try_normalize(0.0), r > 0.0) else { return (middle, 0.0, 0.0) };
            let gap = self.touch(middle, normal, r).map_or(f64::INFINITY, |touch| touch.gap.abs());
            (middle, gap, 0.5 * doubled.norm())
        });
        let mut survey = Survey::default();
        for (middle, gap, area) in looked {
            if gap > allowed {
                survey.off.push(middle);
                survey.off_area += area;
            }
            if gap.is_finite() {
                survey.largest = survey.largest.max(gap);
            }
        }
        survey
    }
}
