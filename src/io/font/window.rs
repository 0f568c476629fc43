//! A short stretch of a contour in whole units, and the moves by which it comes nearer to the outline it stands for.
//!
//! What a stretch costs is measured both ways: points on its curves against the exact outline near it, and points of the exact
//! outline that it stands for against its curves. Only what exceeds the limit counts, and the kinks in smooth places. Single
//! points try the places around them, then neighbours try theirs together; where that does not do, points are left out (the
//! joint is implied then, and lies on half units), put in, and curves are split, each followed by the moves of points.

use std::collections::HashMap;

use super::grid::Placed;
use super::stroke::{Stroke, strokes};
use crate::plane::{BoundaryIndex, Point, Segment, Vector};

/// So many different strokes are measured for one stretch: those that can be brought within the limit need far fewer, and
/// what cannot be must end.
const MOST_STROKES: usize = 12_000;

/// How far, in units, single points and pairs of them look around.
const REACH: i32 = 2;

/// Knots slide along the outline as far, in units.
const FARTHEST_SLIDE: i32 = 5;

/// Excess counts as so much a unit: more than any kink (radians).
const EXCESS_COST: f64 = 1e3;

/// All that has excess costs more than this, and all that has none less.
const EXCESSIVE: f64 = 100.0;

/// Where the outline is smooth no knot turns by more than this (radians), a right angle and some more: steps of single units
/// do turn by as much. Control points of blunt tips turn by more.
const SHARPEST_KNOT: f64 = 1.75;
const SHARPEST_CONTROL: f64 = 2.6;

/// Points are put on lines where these are longer than this, in units.
const LONG_LINE: f64 = 4.0;

/// Rounds of moves that change the number of points.
const DEPTH: usize = 2;

/// Of those so many are followed further.
const PROMISING: usize = 5;

/// What a stretch is measured against.
pub(super) struct Window {
    /// The exact outline around it.
    near: BoundaryIndex,
    /// Points of the exact outline that it stands for, in their order.
    samples: Vec<Point>,
    /// The distance beyond which a point counts.
    limit: f64,
    closed: bool,
    known: HashMap<[i64; 6], Measured>,
}

/// What one stroke is, whatever the others are.
struct Measured {
    /// By how much its points exceed the limit, together.
    excess: f64,
    /// By how much every sample is farther from it than the limit.
    distances: Vec<f64>,
}

impl Window {
    pub fn new(near: BoundaryIndex, samples: Vec<Point>, limit: f64, closed: bool) -> Window {
        Window { near, samples, limit, closed, known: HashMap::new() }
    }

    /// Points that may change: of an open chain not those that strokes outside of it hang on.
    fn free(&self, chain: &[Placed]) -> std::ops::Range<usize> {
        if self.closed { 0..chain.len() } else { 2..chain.len().saturating_sub(2).max(2) }
    }

    /// Whether as much was tried as is worth it.
    fn is_spent(&self) -> bool {
        self.known.len() > MOST_STROKES
    }

    /// Whether a chain that costs this exceeds the limit somewhere.
    pub fn exceeds(cost: f64) -> bool {
        cost >= EXCESSIVE
    }

    /// What a chain costs; of one that costs more than `limit` as much as is known.
    fn cost(&mut self, chain: &[Placed], limit: f64) -> f64 {
        let kinks = kinks(chain, self.closed);
        let cost = |excess: f64| if excess > 0.0 { EXCESSIVE + EXCESS_COST * excess + kinks } else { kinks };
        let mut excess = folds(chain, self.closed);
        let mut least = vec![f64::INFINITY; self.samples.len()];
        for (_, stroke) in strokes(chain, self.closed) {
            let measured = self.measured(&stroke);
            excess += measured.excess;
            if cost(excess) >= limit {
                return cost(excess);
            }
            for (least, far) in least.iter_mut().zip(&measured.distances) {
                *least = least.min(*far);
            }
        }
        excess += least.iter().sum::<f64>();
        cost(excess)
    }

    /// A stroke, measured once: chains share most of theirs.
    fn measured(&mut self, stroke: &Stroke) -> &Measured {
        let (near, samples, limit) = (&self.near, &self.samples, self.limit);
        self.known.entry(stroke.key()).or_insert_with(|| {
            let count = stroke.chord_count(limit);
            let points: Vec<Point> = (0..=count).map(|k| stroke.point_at(k as f64 / count as f64)).collect();
            let off = |p: &Point| if near.is_nearer(*p, limit) { 0.0 } else { near.distance(*p) - limit };
            let far = |p: &Point| -> f64 {
                let to_chord = |ends: &[Point]| Segment::line(ends[0], ends[1]).nearest(*p).distance;
                (points.windows(2).map(to_chord).fold(f64::INFINITY, f64::min) - limit).max(0.0)
            };
            Measured { excess: points.iter().map(off).sum(), distances: samples.iter().map(far).collect() }
        })
    }

    /// A chain that costs less, where one is found, and what the chain cost before and after.
    pub fn improved(&mut self, chain: Vec<Placed>) -> (Vec<Placed>, f64, f64) {
        let before = self.cost(&chain, f64::INFINITY);
        let (chain, cost) = self.without_knots(chain, before);
        let (mut best, mut least) = self.moved(chain, cost, REACH);
        for _ in 0..DEPTH {
            if !Window::exceeds(least) || self.is_spent() {
                break;
            }
            let mut variants: Vec<(Vec<Placed>, f64)> = Vec::new();
            for variant in self.variants(&best) {
                let cost = self.cost(&variant, f64::INFINITY);
                variants.push(self.moved(variant, cost, 0));
            }
            // The sort is stable: of equals the first.
            variants.sort_by(|a, b| a.1.total_cmp(&b.1));
            variants.truncate(PROMISING);
            let known = least;
            for (variant, cost) in variants {
                let tried = self.moved(variant, cost, 1);
                if tried.1 < least {
                    (best, least) = tried;
                }
                if !Window::exceeds(least) {
                    break;
                }
            }
            if least >= known {
                break;
            }
        }
        (best, before, least)
    }

    /// The chain without the knots that are better implied: a joint without a kink.
    fn without_knots(&mut self, mut chain: Vec<Placed>, mut cost: f64) -> (Vec<Placed>, f64) {
        let mut k = self.free(&chain).start;
        while self.free(&chain).contains(&k) {
            let n = chain.len();
            let is_between = !chain[(k + n - 1) % n].on_curve && !chain[(k + 1) % n].on_curve;
            if chain[k].on_curve && chain[k].is_free && chain[k].is_smooth && is_between {
                let knot = chain.remove(k);
                let without = self.cost(&chain, cost);
                if without < cost {
                    cost = without;
                    continue;
                }
                chain.insert(k, knot);
            }
            k += 1;
        }
        (chain, cost)
    }

    /// The chain after its points have moved, singly and, where that does not do, in pairs of neighbours.
    fn moved(&mut self, mut chain: Vec<Placed>, mut cost: f64, reach: i32) -> (Vec<Placed>, f64) {
        loop {
            while !self.is_spent() && self.move_singles(&mut chain, &mut cost) {}
            if !Window::exceeds(cost) || !(1..=reach).any(|reach| self.move_pairs(&mut chain, &mut cost, reach)) {
                return (chain, cost);
            }
        }
    }

    fn move_singles(&mut self, chain: &mut [Placed], cost: &mut f64) -> bool {
        let before = *cost;
        for k in self.free(chain).filter(|&k| chain[k].is_free).collect::<Vec<_>>() {
            let mut best = chain[k].point;
            let place = best;
            for step in steps(REACH) {
                chain[k].point = place + step;
                let tried = self.cost(chain, *cost);
                if tried < *cost {
                    (best, *cost) = (chain[k].point, tried);
                }
            }
            chain[k].point = best;
        }
        *cost < before
    }

    fn move_pairs(&mut self, chain: &mut [Placed], cost: &mut f64, reach: i32) -> bool {
        let before = *cost;
        let n = chain.len();
        let free = self.free(chain);
        for k in free.clone() {
            let next = (k + 1) % n;
            if self.is_spent() || !free.contains(&next) || !chain[k].is_free || !chain[next].is_free {
                continue;
            }
            let places = [chain[k].point, chain[next].point];
            let mut best = places;
            for first in steps(reach) {
                for second in steps(reach) {
                    (chain[k].point, chain[next].point) = (places[0] + first, places[1] + second);
                    let tried = self.cost(chain, *cost);
                    if tried < *cost {
                        (best, *cost) = ([chain[k].point, chain[next].point], tried);
                    }
                }
            }
            [chain[k].point, chain[next].point] = best;
        }
        *cost < before
    }

    /// Chains with another number of points, or with a knot that has slid.
    fn variants(&self, chain: &[Placed]) -> Vec<Vec<Placed>> {
        let n = chain.len();
        let mut variants = Vec::new();
        let mut add = |k: usize, gone: usize, new: &[Placed]| {
            let mut variant = chain.to_vec();
            variant.splice(k..k + gone, new.iter().copied());
            variants.push(variant);
        };
        for k in self.free(chain) {
            let here = chain[k];
            let (before, after) = (chain[(k + n - 1) % n], chain[(k + 1) % n]);
            if here.on_curve && here.is_free && here.is_smooth {
                if !before.on_curve && !after.on_curve {
                    add(k, 1, &[]);
                }
                if let Some(along) = (after.point - before.point).try_normalize(0.0) {
                    for slide in (REACH..=FARTHEST_SLIDE).flat_map(|s| [f64::from(s), f64::from(-s)]) {
                        let point = (here.point + along * slide).map(f64::round);
                        add(k, 1, &[Placed { point, ..here }]);
                    }
                }
            }
            if here.on_curve && here.is_free && !here.is_smooth {
                // A corner off the grid on half units: the joint of two control points, a bow of a unit across.
                let off =
                    |step: Vector| Placed { point: here.point + step, on_curve: false, is_smooth: true, is_free: true };
                add(k, 1, &[off(Vector::zeros())]);
                for (first, second) in steps(1).flat_map(|a| steps(1).map(move |b| (a, b))).filter(|(a, b)| a != b) {
                    add(k, 1, &[off(first), off(second)]);
                }
            }
            if !here.on_curve {
                let middle = |p: Point, t: f64| (here.point + (p - here.point) * t).map(f64::round);
                let off = |point: Point| Placed { point, on_curve: false, is_smooth: true, is_free: true };
                let on = |point: Point| Placed { on_curve: true, ..off(point) };
                // The curve by halves, with the joint implied or on the grid.
                let end = |p: Placed| if p.on_curve { p.point } else { nalgebra::center(&p.point, &here.point) };
                let (a, b) = (end(before), end(after));
                let halves = [off(middle(a, 0.5)), off(middle(b, 0.5))];
                if halves[0].point != halves[1].point {
                    add(k, 1, &halves);
                    let curve = Stroke { start: a, control: Some(here.point), end: b };
                    add(k, 1, &[halves[0], on(curve.point_at(0.5).map(f64::round)), halves[1]]);
                }
                if !after.on_curve && self.free(chain).contains(&((k + 1) % n)) && k + 1 < n {
                    // A knot between two control points; or both as one.
                    add(k, 1, &[here, on(middle(after.point, 0.5))]);
                    if here.is_free && after.is_free {
                        add(k, 2, &[off(middle(after.point, 0.5))]);
                    }
                }
            } else if after.on_curve && (after.point - here.point).norm() > LONG_LINE && k + 1 < n {
                let on = |point: Point| Placed { point, on_curve: true, is_smooth: true, is_free: true };
                let along = (after.point - here.point).normalize();
                for place in
                    [here.point + along * 2.0, nalgebra::center(&here.point, &after.point), after.point - along * 2.0]
                {
                    add(k, 1, &[here, on(place.map(f64::round))]);
                }
            }
        }
        variants
    }
}

/// Steps on the grid, none of them nothing, except that both points of a pair may stay.
fn steps(reach: i32) -> impl Iterator<Item = Vector> + Clone {
    (-reach..=reach).flat_map(move |i| (-reach..=reach).map(move |j| Vector::new(f64::from(i), f64::from(j))))
}

/// The turns at knots where the outline is smooth, in radians.
fn kinks(chain: &[Placed], closed: bool) -> f64 {
    turns(chain, closed).filter(|(p, _)| p.on_curve && p.is_smooth).map(|(_, turn)| turn).sum()
}

/// What turns that run back count as excess: a spike along another outline nearby would be near to it, and is none of it.
fn folds(chain: &[Placed], closed: bool) -> f64 {
    let sharpest = |p: &Placed| if p.on_curve { SHARPEST_KNOT } else { SHARPEST_CONTROL };
    turns(chain, closed).filter(|(p, _)| p.is_smooth).map(|(p, turn)| (turn - sharpest(p)).max(0.0)).sum()
}

fn turns(chain: &[Placed], closed: bool) -> impl Iterator<Item = (&Placed, f64)> {
    let n = chain.len();
    let inner = if closed { 0..n } else { 1..n.saturating_sub(1).max(1) };
    inner.map(move |k| {
        let (a, b) = (chain[k].point - chain[(k + n - 1) % n].point, chain[(k + 1) % n].point - chain[k].point);
        (&chain[k], a.perp(&b).abs().atan2(a.dot(&b)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(x: f64, y: f64, on_curve: bool) -> Placed {
        Placed { point: Point::new(x, y), on_curve, is_smooth: true, is_free: true }
    }

    #[test]
    fn a_knot_off_the_grid_of_units_is_left_out() {
        // The outline goes through (11.5, 1.5), half a unit off every knot of whole units there.
        let ends = [placed(0.0, 0.0, true), placed(5.0, 0.0, true), placed(10.0, 0.0, false)];
        let rest = [placed(13.0, 3.0, false), placed(13.0, 8.0, true), placed(13.0, 20.0, true)];
        let exact: Vec<Placed> = ends.iter().chain(&rest).copied().collect();
        let mut points: Vec<Point> = Vec::new();
        for (_, stroke) in strokes(&exact, false) {
            points.extend((0..16).map(|k| stroke.point_at(f64::from(k) / 16.0)));
        }
        points.push(Point::new(13.0, 20.0));
        let segments = points.windows(2).map(|p| Segment::line(p[0], p[1])).collect();
        let mut window = Window::new(BoundaryIndex::of_segments(segments), points, 0.1, false);
        let mut chain = exact.clone();
        chain.insert(3, placed(12.0, 1.0, true));
        let (better, before, after) = window.improved(chain);
        assert!(Window::exceeds(before) && !Window::exceeds(after), "{before} {after}");
        assert_eq!(better, exact);
    }
}
