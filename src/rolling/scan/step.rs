//! What to do at one node: where a new arc of the disk goes, decided before anything is changed.

use super::{CLEAR, HIDDEN, LinkKind, MIN_EXCESS, MIN_LINK, Meets, Mode, Roller, Step};
use crate::plane::{Point, right_normal};
use crate::rolling::carrier::{Carrier, center_of_chord};
use crate::rolling::excess::{HALF_TURN, half_turn_tangent};
use crate::rolling::track::{Contact, Track};

impl Roller<'_> {
    pub(super) fn decide(&self, a: u32, b: u32, c: u32, excess: f64) -> Step {
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
            (false, true) => {
                let d = self.node(c).next;
                let left = self.track(a);
                if !self.is_rolling(c)
                    && d != a
                    && d != b
                    && let Some((start, end)) = self.corner(a, c)
                {
                    return Step::Corner { first: b, start, last: c, end };
                }
                self.slide_back(a, b, c, &left)
            }
            (true, false) => {
                let z = self.node(a).prev;
                let right = self.track(b);
                if !self.is_rolling(z)
                    && z != c
                    && z != b
                    && let Some((start, end)) = self.corner(z, b)
                {
                    return Step::Corner { first: a, start, last: b, end };
                }
                self.slide_forward(a, b, c, &right)
            }
        }
    }

    /// Two straight links: the disk touches both at the same distance from the corner.
    fn straight_corner(&self, [a, b, c]: [u32; 3], excess: f64, left: &Track, right: &Track) -> Step {
        let min_link = MIN_LINK * self.r;
        let corner = self.node(b).point;
        let (u, v) = (left.tangent_at(corner), right.tangent_at(corner));
        let reach = if excess > HALF_TURN - MIN_LINK { f64::INFINITY } else { self.r * half_turn_tangent(u, v) };
        let shorter = left.length.min(right.length);
        if reach < shorter - min_link {
            Step::Cut { start: corner - u * reach, end: corner + v * reach }
        } else if (left.length - right.length).abs() <= min_link {
            self.kill(a, b, c)
        } else if left.length < right.length {
            Step::Forward(corner + v * left.length, Meets::Angle)
        } else {
            Step::Back(corner - u * right.length, Meets::Angle)
        }
    }

    /// A corner with an arc of the input on at least one side.
    fn curved_corner(&self, a: u32, b: u32, c: u32, left: &Track, right: &Track) -> Step {
        if let Some((start, end)) = self.corner(a, b) {
            return Step::Cut { start, end };
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
            (Some(t), Some(s)) if t.at > left.length - s.at => Step::Back(s.point, Meets::Tangent),
            (Some(t), _) => Step::Forward(t.point, Meets::Tangent),
            (None, Some(s)) => Step::Back(s.point, Meets::Tangent),
            (None, None) => self.kill(a, b, c),
        }
    }

    /// Whether the disk about `center` holds no part of the link that leaves node `i`.
    fn is_clear(&self, center: Point, i: u32) -> bool {
        !self.segment(i).is_nearer(center, self.r * (1.0 - CLEAR))
    }

    /// The contacts of a disk that touches the links of nodes `i` and `j`, the first one before its end and the second
    /// after its start.
    fn corner(&self, i: u32, j: u32) -> Option<(Point, Point)> {
        let (left, right) = (&self.track(i), &self.track(j));
        let (r, min_link) = (self.r, MIN_LINK * self.r);
        let (first, second): (Contact, Contact) = if left.is_straight() && right.is_straight() {
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
            (Contact { at: t, point: left.start + u * t }, Contact { at: s, point: right.start + w * s.max(0.0) })
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
            nearest
        };
        let fits = first.at > min_link
            && first.at <= left.length + min_link
            && second.at >= -min_link
            && second.at < right.length - min_link;
        fits.then_some((first.point, second.point))
    }

    /// Where a disk that rests on `p` first touches `track`, looked for from its start.
    fn touch_ahead(&self, p: Point, track: &Track) -> Option<Contact> {
        let min_link = MIN_LINK * self.r;
        let contacts = self.resting_on(p, track).into_iter().flatten().filter(|t| t.at >= -min_link);
        contacts.min_by(|a, b| a.at.total_cmp(&b.at))
    }

    /// Where a disk that rests on `p` first touches `track`, looked for from its end.
    fn touch_behind(&self, track: &Track, p: Point) -> Option<Contact> {
        let min_link = MIN_LINK * self.r;
        let contacts = self.resting_on(p, track).into_iter().flatten().filter(|t| t.at <= track.length + min_link);
        contacts.max_by(|a, b| a.at.total_cmp(&b.at))
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
                    Step::Back(t.point, Meets::Tangent)
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
                    Step::Forward(t.point, Meets::Tangent)
                } else {
                    Step::Refuse
                }
            }
            _ => self.kill(a, b, c),
        }
    }

    fn kill(&self, a: u32, b: u32, c: u32) -> Step {
        let (from, to) = (self.node(a).point, self.node(c).point);
        // An arc of the input may bulge where its ends do not tell.
        let bulges = |i: u32| {
            matches!(self.node(i).link, LinkKind::Input(_)) && !self.is_clear(center_of_chord(from, to, self.r), i)
        };
        if bulges(a) || bulges(b) {
            return Step::Refuse;
        }
        let chord = (to - from).norm();
        let spans = chord <= 2.0 * self.r * (1.0 + HIDDEN);
        let hidden = || {
            let center = center_of_chord(from, to, self.r);
            (self.node(b).point - center).norm() >= self.r * (1.0 - HIDDEN)
        };
        // Where the ends coincide there is no telling on which side of them the disk lies.
        let safe = self.mode == Mode::Geodesic || (chord > MIN_EXCESS * self.r && hidden());
        if spans && safe { Step::Kill } else { Step::Refuse }
    }
}
