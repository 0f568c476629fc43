//! How far a point is from the boundary of the closing of a solid by a ball, from the definition alone.
//!
//! A is the solid, r the radius. The balls outside of A have their centres in D, the points at least r away from A; the closing
//! is what no such ball reaches: the points at least r away from D. A point at the distance d from D is inside the closing
//! by d - r, or outside of it by r - d.
//!
//! The distance from D is found twice:
//! 1. from above, by going from a centre near by to the nearest one that the triangles around it allow (linearized to
//!    half-spaces, until they stay the same): exact, where it finds the right one;
//! 2. from below, by cutting a box around the point in eight again and again, nearest boxes first. Boxes that lie in a single ball
//!    of radius r around a point of A hold no centre. When the nearest box left is as far as what 1 has found, nothing is nearer;
//!    a free centre met on the way that is nearer starts 1 again.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::half_spaces::{HalfSpace, nearest_in_all};
use crate::mesh::{Point, TriangleMesh, Vector, nearest_on_triangle};
use crate::reference::Solid;

/// By so much of the radius a ball may reach into the solid: rounding.
const TOUCH: f64 = 1e-9;

/// Steps of the search from above; most points take four to eight.
const MOST_STEPS: usize = 60;

/// A step of the search from above goes no farther than this, in radii: where the solid is curved, half-spaces made far away mean little.
const STRIDE: f64 = 0.7;

/// Where the half-spaces have nothing in common, as in a tube narrower than the ball, the search goes on from the last free centre in
/// steps half as long, down to this.
const LEAST_STRIDE: f64 = 0.02;

/// Where no search from a ball that touches finds anything, one begins so many radii away: above the mouth of such a tube.
const FAR_START: f64 = 2.0;

/// The search from above ends with steps below this, in radii.
const LAST_STEP: f64 = 1e-7;

/// Triangles that hold a ball at most; more than three only on the way.
const MOST_HOLDING: usize = 10;

/// The search from below ends where it could gain no more than this, in radii.
pub(super) const RESOLUTION: f64 = 4e-3;

/// Boxes of one search from below, at most.
const MOST_BOXES: usize = 4_000;

/// So many points of the solid are remembered during one search from below.
const MOST_KNOWN: usize = 24;

/// The search goes no farther than this, in radii.
const FARTHEST: f64 = 4.0;

/// Where a point is with respect to the closing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    /// How far inside the closing; negative: how far outside. In the unit of the mesh.
    pub(super) depth: f64,
    /// No centre is nearer by more than this.
    pub(super) uncertainty: f64,
}

/// The centres of all balls outside of a solid.
pub(super) struct Centres<'a> {
    mesh: &'a TriangleMesh,
    solid: &'a Solid,
    radius: f64,
}

impl<'a> Centres<'a> {
    /// The centres outside of `solid`, which is what `mesh` encloses.
    pub(super) fn new(mesh: &'a TriangleMesh, solid: &'a Solid, radius: f64) -> Centres<'a> {
        Centres { mesh, solid, radius }
    }

    /// Whether a ball about `y` is outside of the solid.
    pub(super) fn is_free(&self, y: Point) -> bool {
        !self.solid.hierarchy().is_nearer(y, self.radius * (1.0 - TOUCH)) && self.solid.distance(y) > 0.0
    }

    /// The contact of a point on the surface of the solid itself, which is never outside of the closing, with outward directions to
    /// try first. The depth is one that is proved, the true one may be larger by the uncertainty.
    pub(super) fn contact_on_surface(&self, x: Point, outward: &[Vector]) -> Contact {
        let starts = outward.iter().map(|n| x + n * self.radius);
        if starts.clone().any(|y| self.is_free(y)) {
            return Contact { depth: 0.0, uncertainty: 0.0 };
        }
        let found =
            starts.filter_map(|y| self.nearest_around(x, y)).map(|y| (y - x).norm()).fold(f64::INFINITY, f64::min);
        if found <= self.radius * (1.0 + RESOLUTION) {
            return Contact { depth: (found - self.radius).max(0.0), uncertainty: 0.0 };
        }
        let contact = self.certified(x, found);
        // Only what is proved: between touching faces a search may end before it finds the narrow way out.
        Contact { depth: (contact.depth - contact.uncertainty).max(0.0), uncertainty: contact.uncertainty }
    }

    /// The contact of any point, with outward directions to try first.
    pub(super) fn contact(&self, x: Point, outward: &[Vector]) -> Contact {
        if self.is_free(x) {
            return Contact { depth: -self.radius, uncertainty: 0.0 };
        }
        let search = |away: f64| {
            let starts = outward.iter().map(|n| x + n * (away * self.radius));
            starts.filter_map(|y| self.nearest_around(x, y)).map(|y| (y - x).norm()).fold(f64::INFINITY, f64::min)
        };
        let found = search(1.0);
        self.certified(x, if found.is_finite() { found } else { search(FAR_START) })
    }

    /// The free centre nearest to `x` that a search from `start` leads to.
    fn nearest_around(&self, x: Point, start: Point) -> Option<Point> {
        let r = self.radius;
        let mut holding: Vec<u32> = Vec::with_capacity(MOST_HOLDING);
        let mut y = start;
        let mut best: Option<Point> = None;
        let mut stride = STRIDE;
        for _ in 0..MOST_STEPS {
            let near = self.solid.signed(y, r * (1.0 - TOUCH));
            let is_inside = near.is_some_and(|s| s.distance < 0.0);
            match near {
                Some(s) if holding.contains(&s.face) => {}
                Some(s) => {
                    if holding.len() == MOST_HOLDING {
                        self.drop_slackest(y, is_inside, &mut holding);
                    }
                    holding.push(s.face);
                }
                None if best.is_none_or(|b| (y - x).norm() < (b - x).norm()) => best = Some(y),
                None => {}
            }
            let spaces: Vec<HalfSpace> = holding.iter().map(|&f| self.half_space(y, f, is_inside)).collect();
            let Some(next) = nearest_in_all(x, &spaces, 1e-10 * r) else {
                stride *= 0.5;
                let Some(free) = best.filter(|_| stride > LEAST_STRIDE) else { return best };
                holding.clear();
                y = free;
                continue;
            };
            // What does not hold it any more is forgotten.
            let mut slack = spaces.iter().map(|s| -s.lack(next));
            holding.retain(|_| slack.next().is_some_and(|s| s < 0.1 * r));
            let step = next - y;
            if near.is_none() && step.norm() < LAST_STEP * r {
                return best;
            }
            y += step * (stride * r / step.norm()).min(1.0);
        }
        best
    }

    /// Forgets the triangle that holds a ball at `y` least.
    fn drop_slackest(&self, y: Point, is_inside: bool, holding: &mut Vec<u32>) {
        let lack = |face: u32| self.half_space(y, face, is_inside).lack(y);
        let least = (0..holding.len()).min_by(|&a, &b| lack(holding[a]).total_cmp(&lack(holding[b])));
        least.map(|k| holding.swap_remove(k));
    }

    /// The half-space of centres that triangle `face` leaves to a ball near `y`: an inner one, as triangles are convex.
    fn half_space(&self, y: Point, face: u32, is_inside: bool) -> HalfSpace {
        let (p, _) = nearest_on_triangle(y, self.mesh.triangle(face as usize));
        let outward = self.solid.face_normal(face);
        let away = (y - p).try_normalize(1e-12 * self.radius).unwrap_or(outward);
        let normal = if is_inside && away.dot(&outward) < 0.0 { -away } else { away };
        HalfSpace { normal, offset: normal.dot(&p.coords) + self.radius }
    }

    /// Whether all places of a box that are nearer to `x` than `within` are in the ball around a point of the solid.
    fn is_in_ball(&self, p: &Point, x: Point, within: f64, cell: &Cell) -> bool {
        let (center, half) = (cell.center, cell.half);
        let limit = (self.radius * (1.0 - TOUCH)).powi(2);
        let farthest2: f64 = (0..3).map(|k| ((center[k] - p[k]).abs() + half).powi(2)).sum();
        // |z - p|² = |z - x|² + 2 (z - x)·(x - p) + |x - p|²: the first is bounded by the ball, the second by the box.
        let from = x - p;
        let along = (center - x).dot(&from) + half * from.abs().sum();
        let in_lens2 = within * within + 2.0 * along + from.norm_squared();
        farthest2.min(in_lens2) < limit
    }

    /// Whether the middle of a box is a free centre; nothing where no place of the box that is nearer to `x` than `within` can be
    /// one, because it is in the ball around a point of the solid: one of those that are `known`, or the one nearest to the
    /// middle, which is then known as well.
    fn look_into(&self, x: Point, within: f64, cell: &Cell, known: &mut Vec<Point>) -> Option<Free> {
        let (r, center, half) = (self.radius, cell.center, cell.half);
        let is_in_ball = |p: &Point| self.is_in_ball(p, x, within, cell);
        if let Some(k) = known.iter().position(is_in_ball) {
            // What holds one box holds its neighbours, which come next.
            known[..=k].rotate_right(1);
            return None;
        }
        let reach = half * 3f64.sqrt();
        // The solid is no farther than any point of it.
        let no_farther =
            known.iter().map(|p| (center - p).norm()).fold(r + reach, f64::min) * (1.0 + TOUCH) + TOUCH * r;
        let Some(near) = self.solid.signed(center, no_farther) else { return Some(Free::Yes) };
        known.truncate(MOST_KNOWN - 1);
        known.insert(0, near.nearest);
        if is_in_ball(&near.nearest) || near.distance < -reach {
            return None;
        }
        Some(if near.distance >= r { Free::Yes } else { Free::No })
    }

    /// The contact, where a centre is known at the distance `found`.
    fn certified(&self, x: Point, found: f64) -> Contact {
        let r = self.radius;
        let mut found = found.min(FARTHEST * r);
        let gain = RESOLUTION * r;
        let mut boxes = BinaryHeap::new();
        boxes.push(Cell { distance: 0.0, center: x, half: found });
        let mut looked = 0;
        let mut known = Vec::with_capacity(MOST_KNOWN);
        let mut below = found;
        while let Some(cell) = boxes.pop() {
            if cell.distance >= found - gain || looked >= MOST_BOXES {
                below = cell.distance.min(found);
                break;
            }
            looked += 1;
            let Some(free) = self.look_into(x, found - gain, &cell, &mut known) else { continue };
            let center_distance = (cell.center - x).norm();
            if free == Free::Yes && center_distance < found {
                found = center_distance;
                if let Some(y) = self.nearest_around(x, cell.center) {
                    found = found.min((y - x).norm());
                }
            }
            let half = 0.5 * cell.half;
            for k in 0..8 {
                let side = |i: u32| if k >> i & 1 == 0 { -half } else { half };
                let center = cell.center + Vector::new(side(0), side(1), side(2));
                let distance = (0..3).map(|i| ((center[i] - x[i]).abs() - half).max(0.0).powi(2)).sum::<f64>().sqrt();
                let part = Cell { distance, center, half };
                // Most parts are held by what all but held the whole: these need not wait for their turn.
                if distance < found - gain && !known.first().is_some_and(|p| self.is_in_ball(p, x, found - gain, &part))
                {
                    boxes.push(part);
                }
            }
        }
        Contact { depth: found - r, uncertainty: (found - below).max(0.0) }
    }
}

/// Whether the middle of a box is a free centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Free {
    Yes,
    No,
}

/// A box that may hold a centre; the nearest is looked into first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    distance: f64,
    center: Point,
    half: f64,
}

impl Eq for Cell {}

impl Ord for Cell {
    fn cmp(&self, other: &Cell) -> Ordering {
        // The smaller of equally near ones first, and then any fixed order.
        let places = |c: &Cell| [c.center.x, c.center.y, c.center.z];
        let of_places = || {
            let pairs = places(self).into_iter().zip(places(other));
            pairs.fold(Ordering::Equal, |order, (a, b)| order.then(a.total_cmp(&b)))
        };
        other.distance.total_cmp(&self.distance).then_with(|| other.half.total_cmp(&self.half)).then_with(of_places)
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Cell) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::surface_shapes::{both, extruded, sphere};

    #[test]
    fn depths_in_the_notch_of_an_l_are_those_of_its_fillet() {
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let mesh = extruded(&l, 2.0, 0.3);
        let solid = Solid::new(&mesh);
        let r = 0.4;
        let centres = Centres::new(&mesh, &solid, r);
        for (u, v) in [(0.0, 0.0), (0.05, 0.05), (0.1, 0.2), (0.2, 0.1), (0.02, 0.3), (0.15, 0.15), (0.25, 0.3)] {
            let x = Point::new(1.0 + u, 1.0 + v, 0.9);
            let expected = (r - u).hypot(r - v) - r;
            // With a hint, with a wrong one, and with none.
            for hints in [vec![Vector::new(0.7, 0.7, 0.0)], vec![Vector::z()], vec![]] {
                let contact = centres.contact(x, &hints);
                assert!((contact.depth - expected).abs() < 1e-6, "{u} {v}: {} {expected}", contact.depth);
                assert!(contact.uncertainty <= RESOLUTION * r);
            }
        }
        // On the surface: the notch itself, and where nothing need move.
        let notch = centres.contact_on_surface(Point::new(1.0, 1.0, 0.9), &[Vector::x(), Vector::y()]);
        assert!((notch.depth - (2f64.sqrt() - 1.0) * r).abs() < 1e-6);
        let edge = centres.contact_on_surface(Point::new(2.0, 0.5, 2.0), &[Vector::x()]);
        assert_eq!(edge, Contact { depth: 0.0, uncertainty: 0.0 });
        // A place where a ball is.
        assert_eq!(centres.contact(Point::new(3.0, 3.0, 3.0), &[]).depth, -r);
    }

    #[test]
    fn depths_between_disjoint_spheres_are_those_of_the_neck_that_joins_them() {
        // From SURFACE's exact cases: the neck has the radius rho - sqrt(r² - x²).
        let (a, r) = (1.1, 0.5);
        let mesh = both(&sphere(Point::new(-a, 0.0, 0.0), 1.0, 40), &sphere(Point::new(a, 0.0, 0.0), 1.0, 40));
        let solid = Solid::new(&mesh);
        let centres = Centres::new(&mesh, &solid, r);
        let rho = (1.5f64 * 1.5 - a * a).sqrt();
        for t in [0.0, 0.1, 0.2] {
            for lift in [-0.1, 0.0, 0.05] {
                let (sin, cos) = (0.3f64 + 2.0 * t).sin_cos();
                let height = rho - (r * r - t * t).sqrt() + lift;
                let expected = (rho - height).hypot(t) - r;
                let x = Point::new(t, height * cos, height * sin);
                let contact = centres.contact(x, &[Vector::new(0.0, cos, sin)]);
                // The facets are within 3e-4 of their spheres.
                assert!((contact.depth - expected).abs() < 1e-3, "{t} {lift}: {} {expected}", contact.depth);
                assert!(contact.uncertainty <= RESOLUTION * r);
            }
        }
    }

    #[test]
    fn what_hint_leads_to_a_farther_ball_is_corrected_by_the_search_from_below() {
        // In a slot of width 2 r + a little both walls are touched; hints into the floor find nothing near by.
        let u = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.9, 2.0], [1.9, 1.0], [1.1, 1.0], [1.1, 2.0], [0.0, 2.0]];
        let mesh = extruded(&u, 3.0, 0.4);
        let solid = Solid::new(&mesh);
        let fits = Centres::new(&mesh, &solid, 0.39);
        let x = Point::new(1.5, 1.05, 1.5);
        for hint in [Vector::y(), -Vector::y(), Vector::x()] {
            let depth = fits.contact(x, &[hint]).depth;
            assert!((depth - -0.05).abs() < 1e-6, "{depth}");
        }
        // A ball that does not fit rests on the rims.
        let r = 0.5;
        let depth = Centres::new(&mesh, &solid, r).contact(x, &[Vector::y()]).depth;
        let center = 2.0 + (r * r - 0.4f64 * 0.4).sqrt();
        assert!((depth - (center - 1.05 - r)).abs() < 1e-6, "{depth}");
    }
}
