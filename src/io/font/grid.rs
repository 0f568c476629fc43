//! Knots to the whole units of a font.
//!
//! A corner goes to the nearest place of the grid, at most 0.71 units away. A smooth knot may slide along the outline, too:
//! among the places around it the one is taken that lies nearest to the outline and not far from the knot, so that a
//! stem that ends in an arc stays straight. A control point is rounded to where it keeps the tangents at its knots. Points on
//! the curve that come to lie in the middle of two control points are left out: there the joint is smooth by itself.

use super::contour::{Contour, ContourPoint};
use super::quadratics::Knot;
use crate::plane::{BoundaryIndex, Point, Vector};

/// A knot is smooth where the outline turns by less than this (radians): samples of curves turn by less, serifs by more.
const SMOOTH_TURN: f64 = 0.12;

/// A knot may be left out where the middle of its control points is this near, in font units.
const IMPLIED: f64 = 0.26;

/// How much nearer to the outline a place must be to be taken, for every unit that it is farther from the knot.
const SLIDE_COST: f64 = 0.06;

/// How far a smooth knot may slide, in units, and in parts of the way to its neighbours.
const FARTHEST_SLIDE: f64 = 3.0;
const SLIDE_PART: f64 = 0.4;

/// Coordinates nearer to half a unit than this are taken for half a unit: which way it goes must not hang on rounding.
const HALF: f64 = 1e-6;

/// A point of a contour in whole units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    pub point: Point,
    pub on_curve: bool,
    /// Whether the outline is smooth there.
    pub is_smooth: bool,
    /// Whether it was rounded, and may be elsewhere as well: what the font had on the grid stays.
    pub is_free: bool,
}

/// A contour in whole units.
#[derive(Clone, Debug, Default)]
pub(super) struct Rounded {
    pub points: Vec<Placed>,
}

/// The contour of `knots` in whole units; `exact` is the outline that they follow.
pub(super) fn contour(knots: &[Knot], exact: &BoundaryIndex) -> Rounded {
    let n = knots.len();
    let directions: Vec<[Vector; 2]> = (0..n).map(|k| directions(knots, k)).collect();
    let is_smooth: Vec<bool> = directions.iter().map(|[a, b]| turn(*a, *b) < SMOOTH_TURN).collect();
    let placed: Vec<Point> = (0..n)
        .map(|k| {
            let p = knots[k].point;
            if is_whole(p) || !is_smooth[k] {
                return rounded(p);
            }
            let neighbours = [knots[(k + n - 1) % n].point, knots[(k + 1) % n].point];
            let room = neighbours.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
            slid(p, (SLIDE_PART * room).min(FARTHEST_SLIDE), exact)
        })
        .collect();
    let controls: Vec<Vec<Point>> = (0..n)
        .map(|k| {
            let next = (k + 1) % n;
            let last = knots[k].controls.len().saturating_sub(1);
            let steer = |(j, control): (usize, &Point)| {
                // The tangents that the control point must keep: at the knot before it, and at the one after.
                let before = (j == 0 && is_smooth[k]).then_some((placed[k], directions[k][1]));
                let after = (j == last && is_smooth[next]).then_some((placed[next], directions[next][0]));
                if is_whole(*control) { *control } else { steered(*control, [before, after]) }
            };
            knots[k].controls.iter().enumerate().map(steer).collect()
        })
        .collect();
    let mut rounded = Rounded::default();
    for k in 0..n {
        let middle = controls[(k + n - 1) % n].last().zip(controls[k].first()).map(|(a, b)| nalgebra::center(a, b));
        // What the font had in the middle of two control points, and what may as well be there.
        let is_implied = middle.is_some_and(|middle| {
            let off = (middle - knots[k].point).norm();
            !is_whole(knots[k].point) && is_smooth[k] && off <= IMPLIED
        });
        if !is_implied {
            rounded.points.push(Placed {
                point: placed[k],
                on_curve: true,
                is_smooth: is_smooth[k],
                is_free: !is_whole(knots[k].point),
            });
        }
        for (point, exact) in controls[k].iter().zip(&knots[k].controls) {
            rounded.points.push(Placed { point: *point, on_curve: false, is_smooth: true, is_free: !is_whole(*exact) });
        }
    }
    rounded.drop_repetition();
    rounded
}

/// The directions in which the outline comes to a knot and leaves it.
fn directions(knots: &[Knot], k: usize) -> [Vector; 2] {
    let n = knots.len();
    let knot = &knots[k];
    let before = &knots[(k + n - 1) % n];
    let from = before.controls.last().copied().unwrap_or(before.point);
    let to = knot.controls.first().copied().unwrap_or(knots[(k + 1) % n].point);
    [knot.point - from, to - knot.point]
}

fn turn(a: Vector, b: Vector) -> f64 {
    a.perp(&b).abs().atan2(a.dot(&b))
}

fn is_whole(p: Point) -> bool {
    p.coords.iter().all(|x| x.fract() == 0.0)
}

/// The nearest place of the grid; of two the one above.
fn rounded(p: Point) -> Point {
    let round = |x: f64| (x + 0.5 + HALF).floor();
    Point::new(round(p.x), round(p.y))
}

/// The places of the grid within a square about `p`.
fn places(p: Point, reach: f64) -> impl Iterator<Item = Point> {
    let center = rounded(p);
    let reach = reach.ceil() as i32;
    (-reach..=reach).flat_map(move |i| (-reach..=reach).map(move |j| center + Vector::new(f64::from(i), f64::from(j))))
}

/// The place on the grid that is nearest to the outline, not far from `p`.
fn slid(p: Point, reach: f64, exact: &BoundaryIndex) -> Point {
    let mut best: Option<(Point, f64)> = None;
    for q in places(p, reach) {
        let slide = (q - p).norm();
        // What is known to cost more need not be measured.
        let worth = best.map_or(f64::INFINITY, |(_, least)| least - SLIDE_COST * slide);
        if slide > reach.max(std::f64::consts::FRAC_1_SQRT_2 + HALF) || worth <= 0.0 || !exact.is_nearer(q, worth) {
            continue;
        }
        best = Some((q, exact.distance(q) + SLIDE_COST * slide));
    }
    best.map_or_else(|| rounded(p), |(q, _)| q)
}

/// The place on the grid for a control point, near its own and near the tangents through its knots.
fn steered(control: Point, tangents: [Option<(Point, Vector)>; 2]) -> Point {
    let off_tangent = |q: Point| -> f64 {
        let off = |(knot, along): (Point, Vector)| {
            along.try_normalize(0.0).map_or(0.0, |along| along.perp(&(q - knot)).abs())
        };
        tangents.iter().flatten().copied().map(off).sum()
    };
    // Half of what a control point moves is what the curve moves.
    best(places(control, 1.0), |q| 0.5 * (q - control).norm() + off_tangent(q)).unwrap_or_else(|| rounded(control))
}

/// The first of those with the least cost.
fn best(places: impl Iterator<Item = Point>, cost: impl Fn(Point) -> f64) -> Option<Point> {
    let least = places.map(|q| (q, cost(q))).reduce(|a, b| if b.1 < a.1 { b } else { a });
    least.map(|(q, _)| q)
}

impl Rounded {
    /// Its points as fonts hold them.
    pub fn contour(&self) -> Contour {
        self.points.iter().map(|p| ContourPoint { point: p.point, on_curve: p.on_curve }).collect()
    }

    /// Takes out points that repeat the one before, and control points on their knots.
    pub fn drop_repetition(&mut self) {
        loop {
            let n = self.points.len();
            let repeats = |k: usize| n > 1 && self.points[k].point == self.points[(k + 1) % n].point;
            let Some(k) = (0..n).find(|&k| repeats(k)) else { return };
            // Of a knot and a control point the knot stays.
            let gone = if self.points[k].on_curve { (k + 1) % n } else { k };
            self.points.remove(gone);
        }
    }
}
