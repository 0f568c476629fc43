//! Arcs on which the tool comes to a path and leaves it, and circles on which it comes down beside it.
//!
//! Both lie in the waste, tangent to the path. Nothing is taken on trust: every element is measured against what must
//! remain, and where there is no room the arcs get smaller, and are left out in the end, with a word.

use super::solid::Solid;
use crate::plane::{Arc, Link, Point, Segment, Turn, Vector, left_normal};

/// How much nearer than the tool's radius a lead may come to what remains, in millimetres: half of the gouge that a
/// program may have, and what chords of smooth curves may be off.
const LEAD_TOLERANCE: f64 = 1e-3;

/// How often a lead or a helix is halved before it is left out.
const HALVINGS: usize = 3;

/// Where the centre of a tool may be.
pub(super) struct Room<'a> {
    /// What must remain.
    pub solid: &'a Solid,
    /// How far the centre keeps from it.
    pub distance: f64,
    /// Parts of other operations, from which it keeps as far.
    pub others: Option<&'a Solid>,
    /// The middles of tabs, which it must not take away.
    pub tabs: &'a [Point],
}

impl Room<'_> {
    /// Whether the centre may run along `element`.
    pub(super) fn has(&self, element: &Segment) -> bool {
        let allowed = LEAD_TOLERANCE - self.distance;
        let is_free = |solid: &Solid| solid.deepest(element, allowed, 0.1 * LEAD_TOLERANCE).0 <= allowed;
        is_free(self.solid)
            && self.others.is_none_or(is_free)
            && !self.tabs.iter().any(|&tab| element.is_nearer(tab, self.distance))
    }
}

/// A circle beside a path that touches it at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lead {
    /// Where the path is met.
    pub at: Point,
    /// The centre.
    pub center: Point,
    /// The radius.
    pub radius: f64,
    /// The side of the path it lies on, which is also its turn.
    pub side: Turn,
    /// The direction of the path.
    pub tangent: Vector,
}

impl Lead {
    fn new(at: Point, tangent: Vector, side: Turn, radius: f64) -> Lead {
        let center = at + left_normal(tangent) * (side.sign() * radius);
        Lead { at, center, radius, side, tangent }
    }

    fn arc(&self, start: Point, end: Point) -> Segment {
        Segment { start, end, link: Link::Arc(Arc { center: self.center, radius: self.radius, turn: self.side }) }
    }

    /// The quarter circle that ends on the path.
    pub(super) fn arriving(&self) -> Segment {
        self.arc(self.center - self.tangent * self.radius, self.at)
    }

    /// The quarter circle that begins on the path.
    pub(super) fn leaving(&self) -> Segment {
        self.arc(self.at, self.center + self.tangent * self.radius)
    }

    /// The way back from the end of the leaving arc to the start of the arriving one.
    pub(super) fn returning(&self) -> Segment {
        Segment::line(self.leaving().end, self.arriving().start)
    }

    /// The whole circle from the path to the path, in two halves.
    pub(super) fn circle(&self) -> [Segment; 2] {
        let opposite = self.center + (self.center - self.at);
        [self.arc(self.at, opposite), self.arc(opposite, self.at)]
    }

    /// The largest lead of at most `radius` that has room, with all that `parts` says it travels.
    pub(super) fn find(
        at: Point,
        tangent: Vector,
        side: Turn,
        radius: f64,
        room: &Room,
        parts: impl Fn(&Lead) -> Vec<Segment>,
    ) -> Option<Lead> {
        (0..=HALVINGS)
            .map(|k| Lead::new(at, tangent, side, radius * 0.5f64.powi(k as i32)))
            .find(|lead| parts(lead).iter().all(|s| room.has(s)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::Remainder;
    use crate::plane::{Region, Ring};

    #[test]
    fn leads_touch_the_path_and_keep_off_the_part() {
        let part = Region::new(vec![Ring::polygon(
            [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(|(x, y)| Point::new(x, y)),
        )]);
        let solid = Solid::new(&part, Remainder::Inside);
        let room = Room { solid: &solid, distance: 2.0, others: None, tabs: &[] };
        // Below the part, going right: the part on the left, the waste on the right.
        let at = Point::new(10.0, -2.0);
        let parts = |l: &Lead| vec![l.arriving(), l.leaving(), l.returning()];
        let lead = Lead::find(at, Vector::new(1.0, 0.0), Turn::Right, 3.0, &room, parts).unwrap();
        assert_eq!(lead.radius, 3.0);
        assert!((lead.arriving().end_tangent() - Vector::new(1.0, 0.0)).norm() < 1e-12);
        assert!((lead.leaving().start_tangent() - Vector::new(1.0, 0.0)).norm() < 1e-12);
        assert!((lead.arriving().start - Point::new(7.0, -5.0)).norm() < 1e-12);
        assert!((lead.leaving().end - Point::new(13.0, -5.0)).norm() < 1e-12);
        // On the other side lies the part.
        assert!(Lead::find(at, Vector::new(1.0, 0.0), Turn::Left, 3.0, &room, parts).is_none());
    }

    #[test]
    fn a_lead_gets_smaller_where_there_is_little_room() {
        // A slot 6 wide: the centre of a tool of radius 2 has a strip of 2.
        let wall = |y: f64| {
            Ring::polygon([(0.0, y), (40.0, y), (40.0, y + 5.0), (0.0, y + 5.0)].map(|(x, y)| Point::new(x, y)))
        };
        let solid = Solid::new(&Region::new(vec![wall(0.0), wall(11.0)]), Remainder::Inside);
        let room = Room { solid: &solid, distance: 2.0, others: None, tabs: &[] };
        let at = Point::new(20.0, 7.0);
        let lead = Lead::find(at, Vector::new(-1.0, 0.0), Turn::Right, 6.0, &room, |l| vec![l.arriving()]).unwrap();
        assert_eq!(lead.radius, 1.5);
        let whole = Lead::find(at, Vector::new(-1.0, 0.0), Turn::Right, 6.0, &room, |l| l.circle().to_vec()).unwrap();
        assert_eq!(whole.radius, 0.75);
    }
}
