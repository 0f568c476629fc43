//! Where the locus crosses itself.
//!
//! A binary tree over the pieces in chain order carries boxes and total turning: a stretch that turns by less than π
//! cannot cross itself and is not looked into. Two pieces cross where their carriers do, inside both; near an end of a
//! piece the side of that end decides, by a sign that the next piece of the chain computes alike, so that a crossing
//! near a joint belongs to exactly one of the two.

use std::f64::consts::{PI, TAU};

use super::carrier::{circle_circle, line_circle};
use super::locus::{Locus, Piece};
use super::loops::Event;
use crate::plane::{Bounds, Point};

/// Pieces in a leaf.
const LEAF: usize = 4;

/// A chain whose total turning is below this (less than π, with room for rounding) cannot cross itself.
const STRAIGHT_ENOUGH: f64 = 3.1;

/// A crossing this near to a joint, relative to the radius, is given to a piece by the side of the joint.
const NEAR_JOINT: f64 = 1e-6;

#[derive(Clone, Copy)]
struct Stretch {
    bounds: Bounds,
    /// Total absolute turning of the pieces and of the joints between them; infinite across two rings.
    turning: f64,
}

/// All proper crossings of the locus of a disk of radius `r`, two events each.
pub(super) fn crossings(locus: &Locus, r: f64) -> Vec<Event> {
    let pieces = &locus.pieces;
    let mut finder =
        Finder { locus, boxes: pieces.iter().map(Piece::bounds).collect(), near: NEAR_JOINT * r, events: vec![] };
    if !pieces.is_empty() {
        finder.run();
    }
    finder.events
}

struct Finder<'a> {
    locus: &'a Locus,
    boxes: Vec<Bounds>,
    near: f64,
    events: Vec<Event>,
}

impl Finder<'_> {
    /// The turn at the start of piece `i`, infinite where a ring starts.
    fn joint(&self, i: usize) -> f64 {
        let pieces = &self.locus.pieces;
        if pieces[i].ring == pieces[i - 1].ring { pieces[i].joint } else { f64::INFINITY }
    }

    fn levels(&self) -> Vec<Vec<Stretch>> {
        let n = self.boxes.len();
        let leaf = |k: usize| {
            let first = k * LEAF;
            let mut s = Stretch { bounds: self.boxes[first], turning: self.locus.pieces[first].sweep };
            for i in first + 1..(first + LEAF).min(n) {
                s.bounds = s.bounds.union(self.boxes[i]);
                s.turning += self.locus.pieces[i].sweep + self.joint(i);
            }
            s
        };
        let mut levels = vec![(0..n.div_ceil(LEAF)).map(leaf).collect::<Vec<_>>()];
        let mut width = LEAF;
        while let Some(below) = levels.last().filter(|l| l.len() > 1) {
            let above = (0..below.len().div_ceil(2))
                .map(|k| match below.get(2 * k + 1) {
                    None => below[2 * k],
                    Some(right) => Stretch {
                        bounds: below[2 * k].bounds.union(right.bounds),
                        turning: below[2 * k].turning + right.turning + self.joint((2 * k + 1) * width),
                    },
                })
                .collect();
            levels.push(above);
            width *= 2;
        }
        levels
    }

    fn run(&mut self) {
        let levels = self.levels();
        let mut stack = vec![(levels.len() - 1, 0, 0)];
        while let Some((level, a, b)) = stack.pop() {
            let (sa, sb) = (&levels[level][a], &levels[level][b]);
            if a == b {
                if sa.turning <= STRAIGHT_ENOUGH {
                    continue;
                }
            } else {
                if !sa.bounds.overlaps(&sb.bounds) {
                    continue;
                }
                if b == a + 1 && sa.turning + sb.turning + self.joint((b * LEAF) << level) <= STRAIGHT_ENOUGH {
                    continue;
                }
            }
            if level == 0 {
                self.leaves(a, b, &sb.bounds);
                continue;
            }
            let count = levels[level - 1].len();
            for x in [2 * a, 2 * a + 1] {
                for y in [2 * b, 2 * b + 1] {
                    if x <= y && y < count && (a == b || x < count) {
                        stack.push((level - 1, x, y));
                    }
                }
            }
        }
    }

    fn leaves(&mut self, a: usize, b: usize, other: &Bounds) {
        let n = self.boxes.len();
        for i in a * LEAF..(a * LEAF + LEAF).min(n) {
            if !self.boxes[i].overlaps(other) {
                continue;
            }
            let from = if a == b { i + 1 } else { b * LEAF };
            for j in from..(b * LEAF + LEAF).min(n) {
                self.pair(i, j);
            }
        }
    }

    fn pair(&mut self, i: usize, j: usize) {
        if !self.boxes[i].overlaps(&self.boxes[j]) {
            return;
        }
        let pieces = &self.locus.pieces;
        if pieces[i].ring == pieces[j].ring {
            let ring = &self.locus.rings[pieces[i].ring as usize];
            // Neighbours meet at their joint and nowhere else.
            if j == i + 1 || (i == ring.start as usize && j + 1 == ring.end as usize) {
                return;
            }
        }
        // Computed from one of the two, whichever ring comes first: with other rings around them they may change places.
        let place = |k: usize| (pieces[k].start.x, pieces[k].start.y);
        let (i, j) = if place(j) < place(i) { (j, i) } else { (i, j) };
        let (p, q) = (&pieces[i], &pieces[j]);
        let near = self.near;
        let mut found = |x: Point| {
            if is_far_outside(p, x, near) || is_far_outside(q, x, near) {
                return;
            }
            let (Some(s), Some(t)) = (parameter(p, q, x, near), parameter(q, p, x, near)) else { return };
            let leaves = p.tangent(x).perp(&q.tangent(x)) > 0.0;
            let k = self.events.len() as u32;
            self.events.push(Event { piece: i as u32, at: s, point: x, twin: k + 1, leaves });
            self.events.push(Event { piece: j as u32, at: t, point: x, twin: k, leaves: !leaves });
        };
        match (p.bend == 0.0, q.bend == 0.0) {
            (true, true) => {
                let (d, e) = (p.end - p.start, q.end - q.start);
                let cross = d.perp(&e);
                if cross != 0.0 {
                    found(p.start + d * ((q.start - p.start).perp(&e) / cross));
                }
            }
            (true, false) => line_arc(p, q, found),
            (false, true) => line_arc(q, p, found),
            (false, false) => circle_circle(p.center, p.radius, q.center, q.radius, 0.0).iter().for_each(found),
        }
    }
}

fn line_arc(line: &Piece, arc: &Piece, found: impl FnMut(Point)) {
    let d = line.end - line.start;
    line_circle(line.start, d / d.norm(), arc.center, arc.radius, 0.0).iter().for_each(found);
}

/// Twice the signed area, or the difference of squares, that tells on which side of the carrier of `q` a point lies.
fn side(q: &Piece, x: Point) -> f64 {
    if q.bend == 0.0 {
        (q.end - q.start).perp(&(x - q.start))
    } else {
        let radius = (x - q.center).norm();
        (radius - q.radius) * (radius + q.radius)
    }
}

/// How [`side`] of `q` changes along `p` at their crossing `x`: positive where it grows.
fn growth(p: &Piece, q: &Piece, x: Point) -> f64 {
    let along = p.tangent(x);
    if q.bend == 0.0 { (q.end - q.start).perp(&along) } else { along.dot(&(x - q.center)) }
}

/// The parameter on `p` of the crossing `x` of the carriers of `p` and `q`, where it lies on `p`.
fn parameter(p: &Piece, q: &Piece, x: Point, near: f64) -> Option<f64> {
    let (at, extent, scale) = if p.bend == 0.0 {
        let d = p.end - p.start;
        let length = d.norm();
        ((x - p.start).dot(&d) / length, length, 1.0)
    } else {
        let (u, v) = (p.start - p.center, x - p.center);
        let mut angle = (p.bend * u.perp(&v)).atan2(u.dot(&v));
        if angle < 0.0 {
            angle += TAU;
        }
        // The shorter way to a point before the start.
        if angle > 0.5 * (TAU + p.sweep) {
            angle -= TAU;
        }
        (angle, p.sweep, p.radius)
    };
    let (from_start, to_end) = (at * scale, (extent - at) * scale);
    if from_start < -near || to_end < -near {
        return None;
    }
    if from_start > near && to_end > near {
        return Some(at);
    }
    // The start lies before the crossing where `side` has still to change, the end after it where it has changed.
    let grows = growth(p, q, x) > 0.0;
    let before = from_start > near || (side(q, p.start) >= 0.0) != grows;
    let after = to_end > near || (side(q, p.end) >= 0.0) == grows;
    (before && after).then(|| at.clamp(0.0, extent))
}

/// Whether `x`, a point of the carrier of `p`, lies clearly beyond one of its ends: told by signs, without a root or an
/// angle.
#[inline]
fn is_far_outside(p: &Piece, x: Point, near: f64) -> bool {
    if p.bend == 0.0 {
        let d = p.end - p.start;
        let (along, length_squared) = ((x - p.start).dot(&d), d.norm_squared());
        let beyond = (-along).max(along - length_squared);
        beyond > 0.0 && beyond * beyond > near * near * length_squared
    } else {
        let v = x - p.center;
        let slack = -near * p.radius;
        p.sweep <= PI
            && (p.bend * (p.start - p.center).perp(&v) < slack || p.bend * v.perp(&(p.end - p.center)) < slack)
    }
}
