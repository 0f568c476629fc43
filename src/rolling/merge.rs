//! The morphological closing, exactly: what a disk in the plane cannot reach, whatever the way along the curve.
//!
//! Let D be the input dilated by the disk; its boundary is part of the locus. Stages:
//!
//! 1. The locus at a radius smaller by [`SHRINK`], so that gaps of exactly one diameter stay open.
//! 2. Its crossings. At each, the boundary of D can only enter by one of the two pieces and leave by the other.
//! 3. Walks along the stretches between crossings that obey this rule.
//! 4. A walk bounds free space, or lies in D: distances to the input tell. The distances of *all* stretches are held
//!    against the walks; a contradiction means that a crossing was misjudged by rounding, or that the preparation filled
//!    too much, and the whole is done again from the input itself, at a radius that differs in the ninth digit
//!    ([`ATTEMPTS`]).
//! 5. Back to the boundary: a piece of the locus goes to the element it touched, bit for bit; a crossing is a centre
//!    where the disk touches two elements, and gives a new arc from foot to foot. Centres are solved at the exact radius.
//! 6. In a thin neck filled from both sides the new arcs cross each other: see [`super::trim`].

mod emit;

use super::Scanned;
use super::crossings::crossings;
use super::locus::{Locus, Piece, RING_SPREAD, TINY, Touch};
use super::loops::{Event, Itinerary};
use super::solid::Solid;
use super::trim::{Knot, Tip, trim};
use crate::plane::{Point, Region};

/// How much smaller the disk of the locus is: gaps within this of one diameter count as open, always.
pub(super) const SHRINK: f64 = 1e-8;

/// How often the merge is tried, each time with another radius near r (1 - SHRINK).
const ATTEMPTS: u32 = 6;

/// A sample of the locus nearer to the input than the disk by more than this, relative to the radius, lies in D.
const INSIDE: f64 = 3e-9;

/// How many units of the coordinates' last place a distance may be off.
pub(super) const ROUNDING_STEPS: f64 = 32.0;

/// A stretch of the locus shorter than this, relative to the radius, is too near to its crossings for its distance to
/// contradict anything.
const TELLING: f64 = 1e-4;

/// Samples that decide on a ring or a walk.
const SAMPLES: usize = 16;

/// The result of a merge.
#[derive(Clone, Debug)]
pub(super) struct Merged {
    pub(super) region: Region,
    /// Stretches of the locus whose distance contradicts what was made of them. Zero proves the combinatorics.
    pub(super) contradictions: usize,
    /// Centres of the disk where it touches two elements that are no neighbours on one ring.
    pub(super) bridges: Vec<Point>,
}

/// The morphological closing of `raw` by a disk of radius `r`. `prepared` is `raw` or any region between it and its
/// closing. Coordinates are known to `resolution`.
pub(super) fn merge(prepared: &Scanned, raw: &Region, r: f64, resolution: f64) -> Merged {
    let solid = Solid::closing(raw);
    let mut best: Option<Merged> = None;
    for attempt in 0..ATTEMPTS {
        // Incommensurable steps: no coincidence survives two attempts.
        let shrink = SHRINK * (1.0 + 0.381_966 * f64::from(attempt));
        // The input itself is the safest thing to start from, and the slowest.
        let (start, still) = if attempt == 0 { (&prepared.region, Some(&*prepared.still)) } else { (raw, None) };
        let merged = Attempt::new(start, still, &solid, r, r * (1.0 - shrink), resolution).run();
        let settled = merged.contradictions == 0;
        if best.as_ref().is_none_or(|b| merged.contradictions < b.contradictions) {
            best = Some(merged);
        }
        if settled {
            break;
        }
    }
    best.unwrap_or_else(|| Merged { region: prepared.region.clone(), contradictions: 1, bridges: vec![] })
}

/// Where the result of a scan along the curves may differ from the morphological closing of `raw`: crossings of the
/// locus, and a point of every ring whose locus lies in D as a whole.
pub(super) fn differences(scanned: &Region, raw: &Region, r: f64, resolution: f64) -> Vec<Point> {
    let solid = Solid::closing(raw);
    // Nothing is walked here, and no vertex asked whether it is still where it was.
    let mut attempt = Attempt::new(scanned, None, &solid, r, r * (1.0 - SHRINK), resolution);
    let mut places: Vec<Point> = attempt.events.iter().step_by(2).map(|e| e.point).collect();
    for (ring, verdict) in scanned.rings.iter().zip(attempt.ring_verdicts()) {
        if verdict == Some(Verdict::Covered) {
            places.extend(ring.vertices.first().map(|v| v.point));
        }
    }
    places
}

/// What distances say of a sample of the locus.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// On the boundary of D.
    Free,
    /// Inside D.
    Covered,
}

struct Attempt<'a> {
    region: &'a Region,
    /// Which vertices of the region are vertices of the input; all where it is the input.
    still: Option<&'a [Vec<bool>]>,
    solid: &'a Solid,
    r: f64,
    /// Below this distance to the input a sample lies in D.
    limit: f64,
    locus: Locus,
    events: Vec<Event>,
    itinerary: Itinerary,
    centers: Vec<Option<Point>>,
    contradictions: usize,
}

impl<'a> Attempt<'a> {
    fn new(
        region: &'a Region,
        still: Option<&'a [Vec<bool>]>,
        solid: &'a Solid,
        r: f64,
        locus_radius: f64,
        resolution: f64,
    ) -> Attempt<'a> {
        let locus = Locus::new(region, locus_radius, TINY * locus_radius + ROUNDING_STEPS * resolution);
        let events = crossings(&locus, r);
        let itinerary = Itinerary::new(&events, |p| locus.pieces[p as usize].ring);
        let limit = locus_radius - (INSIDE + TINY + RING_SPREAD) * r - 2.0 * ROUNDING_STEPS * resolution;
        let centers = vec![None; events.len()];
        Attempt { region, still, solid, r, limit, locus, events, itinerary, centers, contradictions: 0 }
    }

    fn run(mut self) -> Merged {
        let walks = self.itinerary.walks(&self.events, true);
        let mut in_kept_walk = vec![false; self.events.len()];
        let mut kept = vec![];
        for walk in walks {
            if self.walk_is_free(&walk) {
                walk.iter().for_each(|&e| in_kept_walk[e as usize] = true);
                kept.push(walk);
            }
        }
        self.hold_against_distances(&in_kept_walk);
        let mut rings = self.rings_without_crossings();
        let mut bridges = vec![];
        for walk in &kept {
            let ring = self.emit(walk, &mut bridges);
            if !ring.is_empty() {
                rings.push(ring);
            }
        }
        let tips = self.facing_tips(&in_kept_walk);
        let trimmed = trim(rings, &tips, self.r);
        Merged {
            region: Region::new(trimmed.rings),
            contradictions: self.contradictions + trimmed.contradictions,
            bridges,
        }
    }

    fn piece(&self, e: u32) -> &Piece {
        &self.locus.pieces[self.events[e as usize].piece as usize]
    }

    fn next(&self, e: u32) -> u32 {
        self.itinerary.next[e as usize]
    }

    /// Whether the stretch from `e` to the next event lies on one piece.
    fn on_one_piece(&self, e: u32) -> bool {
        let (from, to) = (&self.events[e as usize], &self.events[self.next(e) as usize]);
        from.piece == to.piece && to.at > from.at
    }

    /// Whether no boundary is nearer to `p` than the disk allows.
    fn has_room(&self, p: Point) -> bool {
        !self.solid.index.is_nearer(p, self.limit)
    }

    fn verdict(&self, p: Point) -> Verdict {
        // Where boundaries touch, the locus of one can run far from both through the solid of the other.
        if self.has_room(p) && self.solid.is_outside(p) { Verdict::Free } else { Verdict::Covered }
    }

    /// Whether what the other locus touches at `e` comes nearer to `p` than the disk allows: a quick answer to most
    /// questions whether `p` is covered. Only vertices that have not moved are believed: what the preparation made is not
    /// yet known to be right.
    fn is_covered_by_twin(&self, p: Point, e: u32) -> bool {
        let twin = self.piece(self.events[e as usize].twin);
        let ring = &self.region.rings[twin.ring as usize];
        let node = twin.node as usize;
        let is_near = |k: usize| {
            self.still.is_none_or(|still| still[twin.ring as usize][k])
                && (ring.vertices[k].point - p).norm_squared() < self.limit * self.limit
        };
        is_near(node) || is_near((node + 1) % ring.len())
    }

    /// A point well inside the stretch from `e` to the next event, and the length it stands for.
    fn sample(&self, e: u32) -> (Point, f64) {
        let (from, to) = (&self.events[e as usize], &self.events[self.next(e) as usize]);
        let (first, last) = (&self.locus.pieces[from.piece as usize], &self.locus.pieces[to.piece as usize]);
        let scale = |p: &Piece| if p.bend == 0.0 { 1.0 } else { p.radius };
        if self.on_one_piece(e) {
            return (first.at(0.5 * (from.at + to.at)), (to.at - from.at) * scale(first));
        }
        let head = (first.extent() - from.at) * scale(first);
        let tail = to.at * scale(last);
        let mut best = if head >= tail {
            (first.at(0.5 * (from.at + first.extent())), head)
        } else {
            (last.at(0.5 * to.at), tail)
        };
        // A few whole pieces in between: the longest is the most telling.
        let ring = &self.locus.rings[first.ring as usize];
        let n = ring.end - ring.start;
        let between = (to.piece + n - from.piece + n - 1) % n;
        const LOOKED_AT: u32 = 8;
        for k in 0..between.min(LOOKED_AT) {
            let step = 1 + k * between / between.min(LOOKED_AT);
            let piece = &self.locus.pieces[(ring.start + (from.piece - ring.start + step) % n) as usize];
            let length = piece.length();
            if length > best.1 {
                best = (piece.at(0.5 * piece.extent()), length);
            }
        }
        best
    }

    fn walk_is_free(&self, walk: &[u32]) -> bool {
        let step = walk.len().div_ceil(SAMPLES);
        self.solid.is_outside(self.sample(walk[0]).0)
            && walk.iter().step_by(step).all(|&e| self.has_room(self.sample(e).0))
    }

    /// Every stretch must be free if it is kept and covered if it is not, where it is long enough to tell.
    fn hold_against_distances(&mut self, in_kept_walk: &[bool]) {
        for e in 0..self.events.len() as u32 {
            let (p, length) = self.sample(e);
            if length <= TELLING * self.r {
                continue;
            }
            let contradicts = if in_kept_walk[e as usize] {
                self.verdict(p) == Verdict::Covered
            } else {
                let covered = self.is_covered_by_twin(p, e) || self.is_covered_by_twin(p, self.next(e));
                !covered && self.verdict(p) == Verdict::Free
            };
            self.contradictions += usize::from(contradicts);
        }
    }

    /// What becomes of each ring as a whole: nothing is known of one whose locus has crossings. Samples of one ring
    /// that disagree are a contradiction.
    fn ring_verdicts(&mut self) -> Vec<Option<Verdict>> {
        let mut crossed = vec![false; self.region.rings.len()];
        for e in &self.events {
            crossed[self.locus.pieces[e.piece as usize].ring as usize] = true;
        }
        let mut verdicts = vec![None; crossed.len()];
        for (k, range) in self.locus.rings.iter().enumerate().filter(|(k, _)| !crossed[*k]) {
            let step = range.len().div_ceil(SAMPLES).max(1);
            let samples = range.clone().step_by(step).map(|k| &self.locus.pieces[k as usize]);
            let free = samples.clone().filter(|p| self.verdict(p.at(0.5 * p.extent())) == Verdict::Free).count();
            let covered = samples.count() - free;
            self.contradictions += free.min(covered);
            verdicts[k] = Some(if free >= covered { Verdict::Free } else { Verdict::Covered });
        }
        verdicts
    }

    /// Rings whose locus crosses nothing and is free: they stay as they are.
    fn rings_without_crossings(&mut self) -> Vec<Vec<Knot>> {
        let verdicts = self.ring_verdicts();
        let whole = self.region.rings.iter().zip(verdicts).zip(&self.locus.rings);
        whole
            .filter(|((_, verdict), range)| *verdict == Some(Verdict::Free) && !range.is_empty())
            .map(|((ring, _), _)| ring.vertices.iter().map(|&vertex| Knot { vertex, born: None }).collect())
            .collect()
    }

    /// Vertices where a kept stretch ends and the next one starts less than half a turn further: the two new arcs
    /// there point at each other.
    fn facing_tips(&self, in_kept_walk: &[bool]) -> Vec<Tip> {
        let mut ends_kept = vec![false; self.events.len()];
        for e in 0..self.events.len() as u32 {
            if in_kept_walk[e as usize] {
                ends_kept[self.next(e) as usize] = true;
            }
        }
        let mut tips = vec![];
        let mut ended: Option<u32> = None;
        for &e in &self.itinerary.order {
            if self.piece(e).touch != Touch::Vertex {
                continue;
            }
            if ends_kept[e as usize] {
                ended = Some(e);
            }
            if in_kept_walk[e as usize]
                && let Some(f) = ended.take()
            {
                let (a, b) = (&self.events[f as usize], &self.events[e as usize]);
                if a.piece == b.piece && b.at - a.at < std::f64::consts::PI {
                    tips.push(Tip { leaving: f, arriving: b.twin });
                }
            }
        }
        tips
    }
}
