//! Closed walks along crossing curves that change curve at every crossing.

use crate::plane::Point;

/// One side of a crossing: the place on one of the two pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) piece: u32,
    /// Parameter on the piece.
    pub(super) at: f64,
    pub(super) point: Point,
    /// The event of the same crossing on the other piece.
    pub(super) twin: u32,
    /// Whether the other curve crosses to the left here: cross(own tangent, other tangent) > 0. The boundary of the
    /// union of what lies on the left of both can only *leave* the crossing along this piece.
    pub(super) leaves: bool,
}

/// The events along every ring: which one follows which.
#[derive(Clone, Debug)]
pub(super) struct Itinerary {
    /// Events in the order of their pieces and parameters.
    pub(super) order: Vec<u32>,
    /// The event that follows on the same ring.
    pub(super) next: Vec<u32>,
}

impl Itinerary {
    /// Sorts `events`; `ring_of` tells the ring of a piece, pieces of one ring stand together.
    pub(super) fn new(events: &[Event], ring_of: impl Fn(u32) -> u32) -> Itinerary {
        let mut order: Vec<u32> = (0..events.len() as u32).collect();
        order.sort_unstable_by(|&a, &b| {
            let (x, y) = (&events[a as usize], &events[b as usize]);
            x.piece.cmp(&y.piece).then(x.at.total_cmp(&y.at)).then(a.cmp(&b))
        });
        let mut next = vec![0; events.len()];
        let ring = |k: usize| ring_of(events[order[k] as usize].piece);
        let mut first = 0;
        while first < order.len() {
            let mut end = first + 1;
            while end < order.len() && ring(end) == ring(first) {
                end += 1;
            }
            for k in first..end {
                next[order[k] as usize] = order[if k + 1 < end { k + 1 } else { first }];
            }
            first = end;
        }
        Itinerary { order, next }
    }

    /// Closed walks: along a ring from an event to the next, there over to the twin, and on.
    ///
    /// Only stretches that start at an event with `leaves == start` and end at one with `leaves != start` are walked.
    /// A walk is named by the events at which its stretches start.
    pub(super) fn walks(&self, events: &[Event], start: bool) -> Vec<Vec<u32>> {
        let open =
            |e: u32| events[e as usize].leaves == start && events[self.next[e as usize] as usize].leaves != start;
        let mut used = vec![false; events.len()];
        let mut walks = vec![];
        for &first in &self.order {
            let mut walk = vec![];
            let mut e = first;
            while !used[e as usize] && open(e) {
                used[e as usize] = true;
                walk.push(e);
                e = events[self.next[e as usize] as usize].twin;
            }
            if e == first && !walk.is_empty() {
                walks.push(walk);
            }
        }
        walks
    }
}
