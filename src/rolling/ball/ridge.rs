//! The ridges of the closing: where two balls at once are nearest, the surface has a sharp edge that no vertex of one ball
//! reaches. Vertices are put on them, so that edges run along ridges and not across.

use super::contact::Rest;
use super::covering::{Covering, State};
use crate::mesh::{Point, Vector};
use crate::threads;

/// A ridge that an edge cuts off by less than this many edge lengths is not worth a vertex.
const WORTH: f64 = 0.04;

/// Balls whose centres are nearer than this part of the radius are one.
const ONE: f64 = 0.02;

/// Balls that are farther apart than this part of their diameter do not meet.
const APART: f64 = 0.999;

/// A point of a ridge has settled where it moves by less than so many edge lengths.
const SETTLED: f64 = 1e-4;

/// A ridge is not looked for farther away than so many edge lengths.
const REACH: f64 = 2.0;

/// It is none where it is farther than this from where either ball touches.
const MISSED: f64 = 1e-3;

/// Steps to settle.
const STEPS: usize = 20;

/// Vertices that are this near to a ridge, in edge lengths, go there themselves.
const NEAR: f64 = 0.45;

/// Where no vertex can be put on an edge, an end that is this near goes to the ridge.
const FAR: f64 = 1.2;

/// No vertex is put this near to another, in edge lengths.
const CROWDED: f64 = 0.15;

/// What a vertex does to its faces by going to a ridge: they keep this part of their quality, or this quality.
const QUALITY_KEPT: f64 = 0.6;
const GOOD: f64 = 0.35;

/// They agree with their balls as they did but for rounding, or this well.
const AGREES: f64 = 0.5;
const ROUNDING: f64 = 0.01;

impl Covering<'_> {
    /// The point of the ridge between two balls that is nearest to `x`, with the balls as they rest there. `None` where
    /// they roll into one, or do not meet.
    pub fn ridge(&self, x: Point, a: &Rest, b: &Rest) -> Option<(Point, Rest, Rest)> {
        let (mut p, mut a, mut b) = (x, *a, *b);
        for _ in 0..STEPS {
            let between = b.center - a.center;
            let distance = between.norm();
            let r = 0.5 * (a.radius + b.radius);
            if distance < ONE * r || distance > 2.0 * APART * r {
                return None;
            }
            let axis = between / distance;
            let middle = nalgebra::center(&a.center, &b.center);
            let from = p - middle;
            let out = (from - axis * from.dot(&axis)).try_normalize(0.0)?;
            let next = middle + out * (r * r - 0.25 * distance * distance).sqrt();
            let motion = (next - p).norm();
            p = next;
            if (p - x).norm() > REACH * self.edge {
                return None;
            }
            let r = self.radius(p);
            a = self.ground.rest(p, a.center, r, a.contacts)?;
            b = self.ground.rest(p, b.center, r, b.contacts)?;
            if motion < SETTLED * self.edge {
                let off = |rest: &Rest| ((rest.center - p).norm() - rest.radius).abs();
                if off(&a).max(off(&b)) > MISSED * self.edge || (a.center - b.center).norm() < ONE * r {
                    return None;
                }
                (a.normal, b.normal) = ((a.center - p) / r, (b.center - p) / r);
                return Some((p, a, b));
            }
        }
        None
    }

    /// How far an edge runs below a ridge that it crosses, about: half of what the balls at its ends turn apart along it.
    /// At vertices on ridges the ball counts that is on this side.
    pub fn crossing(&self, u: u32, v: u32) -> f64 {
        self.sides(u, v).map_or(0.0, |(height, ..)| height)
    }

    fn sides(&self, u: u32, v: u32) -> Option<(f64, Rest, Rest)> {
        let along = self.point(u) - self.point(v);
        let mut least: Option<(f64, Rest, Rest)> = None;
        for a in self.rests(u) {
            for b in self.rests(v) {
                let height = 0.25 * (a.normal - b.normal).dot(&along);
                if least.as_ref().is_none_or(|l| height < l.0) {
                    least = Some((height, *a, *b));
                }
            }
        }
        least
    }

    /// Whether an edge crosses a ridge that is worth a vertex.
    pub fn crosses_ridge(&self, u: u32, v: u32) -> bool {
        self.crossing(u, v) > WORTH * self.edge
    }

    /// Puts vertices on the ridges that edges cross.
    pub fn sharpen(&mut self) {
        let edges = self.edges();
        let heights = threads::map(&edges, self.threads, |&h| self.crossing(self.mesh.origin(h), self.mesh.target(h)));
        let mut edges: Vec<(f64, u32)> = heights.into_iter().zip(edges).collect();
        edges.retain(|(height, _)| *height > WORTH * self.edge);
        edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let found = threads::map(&edges, self.threads, |&(_, h)| {
            let (u, v) = (self.mesh.origin(h), self.mesh.target(h));
            let (_, a, b) = self.sides(u, v)?;
            let found = self.ridge(nalgebra::center(&self.point(u), &self.point(v)), &a, &b)?;
            Some((u, v, self.point(u), self.point(v), found))
        });
        for ((_, h), found) in edges.into_iter().zip(found) {
            let Some((u, v, p, q, (x, a, b))) = found else { continue };
            // What came before may have moved its ends, or cut it.
            let is_same =
                (self.mesh.origin(h), self.mesh.target(h)) == (u, v) && (self.point(u), self.point(v)) == (p, q);
            if !is_same || !self.crosses_ridge(u, v) {
                continue;
            }
            let along = (q - p) / (q - p).norm_squared();
            let t = (x - p).dot(&along);
            let off = (x - p - (q - p) * t).norm();
            if off <= WORTH * self.edge || !(0.0..=1.0).contains(&t) {
                continue;
            }
            let (near, distance) = if t < 0.5 { (u, (x - p).norm()) } else { (v, (x - q).norm()) };
            let on_ridge = matches!(self.state[near as usize], State::Ridge(..));
            let state = State::Ridge(a, b);
            if !on_ridge && distance < NEAR * self.edge && self.go_to(near, x, state) {
                continue;
            }
            if distance > CROWDED * self.edge && self.may_split(h, x, &state) {
                self.split(h, x, state);
            } else if !on_ridge && distance < FAR * self.edge {
                self.go_to(near, x, state);
            }
        }
    }

    /// Moves a vertex if its faces stay good. Whether they do.
    pub fn go_to(&mut self, v: u32, x: Point, state: State) -> bool {
        let (p, before) = (self.point(v), self.state[v as usize]);
        let (q0, s0) = self.fan(v);
        self.mesh.points[v as usize] = x;
        self.state[v as usize] = state;
        let (q1, s1) = self.fan(v);
        let stays_good = q1 >= (QUALITY_KEPT * q0).min(GOOD) && s1 >= s0.min(AGREES) - ROUNDING;
        if stays_good && !self.mesh.faces_at(v).any(|f| self.dips(self.mesh.triangle(f))) {
            self.changes.mark(v);
            return true;
        }
        self.mesh.points[v as usize] = p;
        self.state[v as usize] = before;
        false
    }

    /// The balls that touch a vertex.
    pub fn rests(&self, v: u32) -> impl Iterator<Item = &Rest> {
        let (a, b) = match &self.state[v as usize] {
            State::Moved(a) => (Some(a), None),
            State::Ridge(a, b) => (Some(a), Some(b)),
            _ => (None, None),
        };
        a.into_iter().chain(b)
    }

    /// How well a unit normal agrees with a ball that touches a vertex; 1 where none does.
    pub fn agrees(&self, v: u32, unit: &Vector) -> f64 {
        self.rests(v).map(|rest| rest.normal.dot(unit)).reduce(f64::max).unwrap_or(1.0)
    }
}
