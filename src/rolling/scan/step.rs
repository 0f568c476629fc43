//! What to do at one node: where a new arc of the disk goes, decided before anything is changed.

use super::change::{Meets, NewArc, Step};
use super::nodes::LinkKind;
use super::{HIDDEN, MIN_EXCESS, MIN_LINK, Mode, Roller};
use crate::plane::{Point, Segment, left_normal, right_normal};
use crate::rolling::carrier::{Carrier, center_of_chord};
use crate::rolling::excess::{HALF_TURN, half_turn_tangent};
use crate::rolling::track::{Contact, Track};

impl Roller<'_> {
    pub(super) fn decide(&self, a: u32, b: u32, c: u32, excess: f64) -> Step {
        let step = self.propose(a, b, c, excess);
        // An arc this short is rounding, and its ends may lie anywhere about each other.
        if let Step::Cut(arc) | Step::Corner { arc, .. } = step
            && (arc.end - arc.start).norm() <= self.min_excess * self.r
        {
            return Step::Refuse;
        }
        // What is safe has no turn beyond half a turn, and steps outward by its construction.
        if self.mode == Mode::Safe || self.is_outward(&step, a, b, c) { step } else { Step::Refuse }
    }

    fn propose(&self, a: u32, b: u32, c: u32, excess: f64) -> Step {
        match (self.is_rolling(a), self.is_rolling(b)) {
            (true, true) => self.kill(a, b, c),
            (false, false) => {
                let (left, right) = (self.track(a), self.track(b));
                if left.is_straight() && right.is_straight() {
                    self.straight_corner([a, b, c], excess, &left, &right)
                } else {
                    self.curved_corner(a, b, c, &left, &right)
                }
            }
            (false, true) => self.corner_over(b).unwrap_or_else(|| self.slide_back(a, b, c, &self.track(a))),
            (true, false) => self.corner_over(a).unwrap_or_else(|| self.slide_forward(a, b, c, &self.track(b))),
        }
    }

    /// The corner between the links before and after an arc of the disk, which leaves node `over` and goes.
    fn corner_over(&self, over: u32) -> Option<Step> {
        let (first, last) = (self.node(over).prev, self.node(over).next);
        // In a ring of three links or fewer the two meet elsewhere, too.
        if first == last || self.node(last).next == first || self.is_rolling(first) || self.is_rolling(last) {
            return None;
        }
        Some(Step::Corner { first: over, last, arc: self.corner(first, last)? })
    }

    /// Two straight links: the disk touches both at the same distance from the corner.
    fn straight_corner(&self, [a, b, c]: [u32; 3], excess: f64, left: &Track, right: &Track) -> Step {
        let min_link = MIN_LINK * self.r;
        let corner = self.node(b).point;
        let (u, v) = (left.tangent_at(corner), right.tangent_at(corner));
        let reach = if excess > HALF_TURN - MIN_LINK { f64::INFINITY } else { self.r * half_turn_tangent(u, v) };
        let shorter = left.length.min(right.length);
        if reach < shorter - min_link {
            let start = corner - u * reach;
            return Step::Cut(NewArc { start, end: corner + v * reach, center: start + right_normal(u) * self.r });
        }
        // Both links are too short: the disk rests on their ends, or on the end of the shorter one.
        let arc = |start: Point, end: Point| NewArc { start, end, center: center_of_chord(start, end, self.r) };
        if (left.length - right.length).abs() <= min_link {
            self.kill(a, b, c)
        } else if left.length < right.length {
            Step::Forward(arc(left.start, corner + v * left.length), Meets::Angle)
        } else {
            Step::Back(arc(corner - u * right.length, self.node(c).point), Meets::Angle)
        }
    }

    /// A corner with an arc of the input on at least one side.
    fn curved_corner(&self, a: u32, b: u32, c: u32, left: &Track, right: &Track) -> Step {
        if let Some(arc) = self.corner(a, b) {
            return Step::Cut(arc);
        }
        let min_link = MIN_LINK * self.r;
        // The disk reaches beyond an end: it rests on that end and touches the other link, clear of the first.
        let forward = self
            .touch_ahead(self.node(a).point, right)
            .filter(|t| t.at < right.length - min_link && self.is_clear(right.center_at(t, self.r), a));
        let back = self
            .touch_behind(left, self.node(c).point)
            .filter(|t| t.at > min_link && self.is_clear(left.center_at(t, self.r), b));
        match (forward, back) {
            (Some(t), Some(s)) if t.at > left.length - s.at => self.back_to(&s, left, c),
            (Some(t), _) => self.forward_to(&t, right, a),
            (None, Some(s)) => self.back_to(&s, left, c),
            (None, None) => self.kill(a, b, c),
        }
    }

    /// The disk touches `left` and rests on node `c`.
    fn back_to(&self, contact: &Contact, left: &Track, c: u32) -> Step {
        let center = left.center_at(contact, self.r);
        Step::Back(NewArc { start: contact.point, end: self.node(c).point, center }, Meets::Tangent)
    }

    /// The disk rests on node `a` and touches `right`.
    fn forward_to(&self, contact: &Contact, right: &Track, a: u32) -> Step {
        let center = right.center_at(contact, self.r);
        Step::Forward(NewArc { start: self.node(a).point, end: contact.point, center }, Meets::Tangent)
    }

    /// Whether the disk about `center` holds no part of the link that leaves node `i`.
    fn is_clear(&self, center: Point, i: u32) -> bool {
        !self.segment(i).is_nearer(center, self.clear)
    }

    /// Whether a step takes nothing away from the solid: the disk of its new arc holds no part of the links that the
    /// arc replaces, and they pass it on the solid's side.
    ///
    /// Where a curve has run into itself the turn at a node can exceed half a turn, and the disk can lie on the
    /// wrong side of what it replaces.
    fn is_outward(&self, step: &Step, a: u32, b: u32, c: u32) -> bool {
        let at = |i: u32| self.node(i).point;
        match *step {
            Step::Refuse => true,
            Step::Kill => {
                let center = center_of_chord(at(a), at(c), self.r);
                self.replaces(center, &[at(a), at(b), at(c)], &[self.segment(a), self.segment(b)])
            }
            Step::Cut(arc) => self.replaces(arc.center, &[arc.start, at(b), arc.end], &[]),
            Step::Corner { first, last, arc } => {
                self.replaces(arc.center, &[arc.start, at(first), at(last), arc.end], &[self.segment(first)])
            }
            Step::Back(arc, meets) => {
                let links = [self.segment(b), Segment::line(arc.start, at(b))];
                let links = if meets == Meets::Tangent { &links[..1] } else { &links };
                self.replaces(arc.center, &[arc.start, at(b), at(c)], links)
            }
            Step::Forward(arc, meets) => {
                let links = [self.segment(a), Segment::line(at(b), arc.end)];
                let links = if meets == Meets::Tangent { &links[..1] } else { &links };
                self.replaces(arc.center, &[at(a), at(b), arc.end], links)
            }
        }
    }

    /// Whether an arc of the disk about `center` from the first to the last point of `path` lies outward of it; `links`
    /// are those that the disk does not touch by its construction.
    fn replaces(&self, center: Point, path: &[Point], links: &[Segment]) -> bool {
        let (from, to) = (path[0], path[path.len() - 1]);
        let Some(u) = (to - from).try_normalize(0.0) else { return false };
        // From the end of the path back to its start through the middle of the arc: not around the centre.
        let middle = center + left_normal(u) * self.r;
        let around = path.windows(2).map(|p| (p[0], p[1])).chain([(to, middle), (middle, from)]);
        let winding: i32 = around.map(|(p, q)| Segment::line(p, q).ray_crossings(center)).sum();
        winding == 0 && links.iter().all(|s| !s.is_nearer(center, self.clear))
    }

    /// The contacts of a disk that touches the links of nodes `i` and `j`, the first one before its end and the second
    /// after its start.
    fn corner(&self, i: u32, j: u32) -> Option<NewArc> {
        let (left, right) = (&self.track(i), &self.track(j));
        let (r, min_link) = (self.r, MIN_LINK * self.r);
        let (first, second, center): (Contact, Contact, Point) = if left.is_straight() && right.is_straight() {
            let (u, w) = (left.tangent_at(left.start), right.tangent_at(right.start));
            let (sine, cosine) = (u.perp(&w), u.dot(&w));
            // A right turn, neither straight on nor straight back.
            let angle_known = if cosine > 0.0 { MIN_EXCESS } else { MIN_LINK };
            if sine > -angle_known {
                return None;
            }
            let along = (right.start - left.start).perp(&w) / sine;
            let apex = left.start + u * along;
            let reach = r * half_turn_tangent(u, w);
            let (t, s) = (along - reach, (apex - right.start).dot(&w) + reach);
            let start = left.start + u * t;
            let (first, second) =
                (Contact { at: t, point: start }, Contact { at: s, point: right.start + w * s.max(0.0) });
            (first, second, start + right_normal(u) * r)
        } else {
            // Rolling back from the corner, the disk first fits at the contacts nearest to it.
            let roots = left.carrier(r).roots(&right.carrier(r), MIN_EXCESS * r);
            let touching = roots.iter().filter_map(|o| Some((left.touch(o, r)?, right.touch(o, r)?)));
            let inside = touching.filter(|(t, s)| {
                t.at > min_link && t.at <= left.length + min_link && s.at >= -min_link && s.at < right.length - min_link
            });
            let nearest = inside.max_by(|a, b| a.0.at.total_cmp(&b.0.at))?;
            let center = left.center_at(&nearest.0, r);
            if !(self.is_clear(center, i) && self.is_clear(center, j)) {
                return None;
            }
            (nearest.0, nearest.1, center)
        };
        let fits = first.at > min_link
            && first.at <= left.length + min_link
            && second.at >= -min_link
            && second.at < right.length - min_link;
        fits.then_some(NewArc { start: first.point, end: second.point, center })
    }

    /// Where a disk that rests on `p` first touches `track`, looked for from its start.
    fn touch_ahead(&self, p: Point, track: &Track) -> Option<Contact> {
        let min_link = MIN_LINK * self.r;
        let ahead = |t: &Contact| t.at >= -min_link && self.is_arc(p, t.point, track.center_at(t, self.r));
        let contacts = self.resting_on(p, track).into_iter().flatten().filter(ahead);
        contacts.min_by(|a, b| a.at.total_cmp(&b.at))
    }

    /// Where a disk that rests on `p` first touches `track`, looked for from its end.
    fn touch_behind(&self, track: &Track, p: Point) -> Option<Contact> {
        let min_link = MIN_LINK * self.r;
        let behind =
            |t: &Contact| t.at <= track.length + min_link && self.is_arc(t.point, p, track.center_at(t, self.r));
        let contacts = self.resting_on(p, track).into_iter().flatten().filter(behind);
        contacts.max_by(|a, b| a.at.total_cmp(&b.at))
    }

    /// Whether a disk lies to the right of the way from one point of its edge to another: a disk that touches a link
    /// beyond the point that it rests on is on the wrong side of that point.
    fn is_arc(&self, from: Point, to: Point, center: Point) -> bool {
        (to - from).perp(&(center - from)) <= MIN_LINK * self.r * self.r
    }

    /// The contacts with `track` of the disks that rest on `p`.
    fn resting_on(&self, p: Point, track: &Track) -> [Option<Contact>; 2] {
        // A point of the track itself is touched there; rounding must not lose it.
        let slack = MIN_EXCESS * self.r;
        let roots = track.carrier(self.r).roots(&Carrier::Circle(p, self.r), slack);
        let rests = |o: &Point| ((o - p).norm() - self.r).abs() <= MIN_LINK * self.r;
        let mut contacts = roots.iter().filter(rests).map(|o| track.touch(o, self.r));
        [contacts.next().flatten(), contacts.next().flatten()]
    }

    /// A link followed by an arc of the disk that ends at `c`: roll back until the disk rests on `c`.
    fn slide_back(&self, a: u32, b: u32, c: u32, left: &Track) -> Step {
        let min_link = MIN_LINK * self.r;
        let target = self.node(c).point;
        let contact = if left.is_straight() {
            let u = left.tangent_at(left.start);
            let w = target - left.start;
            let (along, across) = (w.dot(&u), w.dot(&right_normal(u)));
            (across > 0.0).then(|| {
                let at = along - (across * (2.0 * self.r - across)).max(0.0).sqrt();
                Contact { at, point: left.start + u * at }
            })
        } else {
            self.touch_behind(left, target)
        };
        match contact {
            Some(t) if t.at > min_link => {
                if t.at < left.length {
                    self.back_to(&t, left, c)
                } else {
                    Step::Refuse
                }
            }
            _ => self.kill(a, b, c),
        }
    }

    /// The mirror image of [`Roller::slide_back`].
    fn slide_forward(&self, a: u32, b: u32, c: u32, right: &Track) -> Step {
        let min_link = MIN_LINK * self.r;
        let target = self.node(a).point;
        let contact = if right.is_straight() {
            let v = right.tangent_at(right.start);
            let w = target - right.start;
            let (along, across) = (w.dot(&v), w.dot(&right_normal(v)));
            (across > 0.0).then(|| {
                let at = along + (across * (2.0 * self.r - across)).max(0.0).sqrt();
                Contact { at, point: right.start + v * at }
            })
        } else {
            self.touch_ahead(target, right)
        };
        match contact {
            Some(t) if t.at < right.length - min_link => {
                if t.at > 0.0 {
                    self.forward_to(&t, right, a)
                } else {
                    Step::Refuse
                }
            }
            _ => self.kill(a, b, c),
        }
    }

    fn kill(&self, a: u32, b: u32, c: u32) -> Step {
        let (from, to) = (self.node(a).point, self.node(c).point);
        let chord = (to - from).norm();
        if chord > 2.0 * self.r * (1.0 + HIDDEN) {
            return Step::Refuse;
        }
        let center = center_of_chord(from, to, self.r);
        let hidden = || (self.node(b).point - center).norm() >= self.r * (1.0 - HIDDEN);
        // Where the ends coincide there is no telling on which side of them the disk lies.
        let safe = self.mode == Mode::Geodesic || (chord > MIN_EXCESS * self.r && hidden());
        // A link of the input may pass through the disk where its ends do not tell.
        let passes = |i: u32, start: Point, end: Point| match self.node(i).link {
            LinkKind::Rolling(_) => false,
            LinkKind::Line => Segment::line(start, end).is_nearer(center, self.clear),
            LinkKind::Input(_) => !self.is_clear(center, i),
        };
        let corner = self.node(b).point;
        let safe = safe && !passes(a, from, corner) && !passes(b, corner, to);
        if safe { Step::Kill } else { Step::Refuse }
    }
}
