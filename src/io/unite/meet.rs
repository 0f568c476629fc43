//! Which rings cross, touch or overlap: themselves or each other.
//!
//! Stages: (1) a tree of boxes over the links, in the order of a curve that fills the plane, gives the pairs whose boxes
//! overlap; (2) of such a pair an arc is halved, and its halves again, as long as chord and sagitta do not tell the two
//! apart. So an arc that nothing comes near costs no more than a line.

use std::f64::consts::TAU;

use crate::plane::{Arc, Bounds, Link, Point, Ring, Segment};

use super::nearby::along_curve;

/// Links nearer than this, in parts of the larger side of the drawing, touch. A few cells of the overlay's grid.
pub(super) const TOUCH: f64 = 2.5e-13;

/// How far the chords that stand for an arc in the end may stray from it, in parts of its radius. They are tested with
/// that margin, so that nothing is missed; what is found for nothing costs time only.
const ARC_MARGIN: f64 = 1e-5;

/// Arcs are halved no more often than this: beyond, the margin is below what `f64` resolves on the radius.
const MOST_HALVINGS: u32 = 16;

/// Links that turn back by this angle, in radians, run over each other.
const FOLD_ANGLE: f64 = 1e-12;

/// Two arcs of one circle that follow each other and leave this angle of it open, in radians, meet nowhere else.
const OPEN_ANGLE: f64 = 1e-3;

/// Pieces in a leaf of the tree of boxes.
const LEAF: usize = 4;

/// Rings that hang together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// Their indices.
    pub rings: Vec<usize>,
    /// Whether anything meets; if not, it is a single ring.
    pub meets: bool,
}

/// A link or a part of it: a chord, and how far the link may be from it.
#[derive(Clone, Copy)]
struct Piece {
    start: Point,
    end: Point,
    /// The circle and the angle swept, of an arc.
    arc: Option<(Arc, f64)>,
    touch: f64,
    /// How often it is halved until it is taken for its chord.
    halvings: u32,
    ring: u32,
    /// Position in the ring of the first chord that it ends up as, and how many of them the ring has.
    place: u64,
    count: u64,
}

/// The rings, grouped by what meets what, in the order of the first ring of each group.
pub(super) fn groups(rings: &[Ring], extent: f64) -> Vec<Group> {
    let pieces = pieces(rings, TOUCH * extent);
    let mut leader: Vec<usize> = (0..rings.len()).collect();
    let mut meets = vec![false; rings.len()];
    Tree::new(&pieces).visit_pairs(|a, b| {
        let (a, b) = (&pieces[a], &pieces[b]);
        let (i, j) = (find(&mut leader, a.ring as usize), find(&mut leader, b.ring as usize));
        // Rings known to hang together need no further proof.
        if (i == j && meets[i]) || a.is_continued_by(b) || !is_meeting(a, b) {
            return;
        }
        leader[i.max(j)] = i.min(j);
        meets[i.min(j)] = true;
    });
    let mut groups: Vec<Group> = Vec::new();
    let mut number = vec![usize::MAX; rings.len()];
    for ring in (0..rings.len()).filter(|&i| !rings[i].is_empty()) {
        let first = find(&mut leader, ring);
        if number[first] == usize::MAX {
            number[first] = groups.len();
            groups.push(Group { rings: Vec::new(), meets: meets[first] });
        }
        groups[number[first]].rings.push(ring);
    }
    groups
}

fn find(leader: &mut [usize], mut i: usize) -> usize {
    while leader[i] != i {
        leader[i] = leader[leader[i]];
        i = leader[i];
    }
    i
}

/// The links of all rings.
fn pieces(rings: &[Ring], touch: f64) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(rings.iter().map(Ring::len).sum());
    for (number, ring) in rings.iter().enumerate() {
        let first = pieces.len();
        let mut count = 0;
        for segment in ring.segments() {
            let Segment { start, end, link } = segment;
            let arc = match link {
                Link::Line => None,
                Link::Arc(arc) => Some((arc, segment.sweep())),
            };
            let halvings = arc.map_or(0, |(_, sweep)| halvings(sweep));
            pieces.push(Piece { start, end, arc, touch, halvings, ring: number as u32, place: count, count: 0 });
            count += 1 << halvings;
        }
        pieces[first..].iter_mut().for_each(|piece| piece.count = count);
    }
    pieces
}

/// How often an arc is halved until its chords stay within [`ARC_MARGIN`]: once at least, as the ends of a piece tell it
/// from its neighbour.
fn halvings(sweep: f64) -> u32 {
    let step = 2.0 * (1.0 - ARC_MARGIN).acos();
    ((sweep / step).log2().ceil().max(1.0) as u32).min(MOST_HALVINGS)
}

impl Piece {
    /// How far the piece and what touches it may be from the chord.
    fn margin(&self) -> f64 {
        let sagitta = self.arc.map_or(0.0, |(arc, sweep)| arc.radius * (1.0 - (0.5 * sweep).cos()));
        self.touch / 2.0 + sagitta
    }

    fn bounds(&self) -> Bounds {
        match self.arc {
            None => Bounds::of_points([self.start, self.end]).inflated(self.touch / 2.0),
            Some((arc, _)) => {
                let link = Segment { start: self.start, end: self.end, link: Link::Arc(arc) };
                link.bounds().inflated(self.touch / 2.0 + ARC_MARGIN * arc.radius)
            }
        }
    }

    fn halves(&self) -> [Piece; 2] {
        let Some((arc, sweep)) = self.arc else { return [*self; 2] };
        let middle = arc.travel(self.start, 0.5 * sweep);
        let half = Piece { arc: Some((arc, 0.5 * sweep)), halvings: self.halvings - 1, ..*self };
        [Piece { end: middle, ..half }, Piece { start: middle, place: self.place + (1 << half.halvings), ..half }]
    }

    /// Whether `next` begins where the piece ends, in the ring of both.
    fn is_before(&self, next: &Piece) -> bool {
        self.ring == next.ring && (self.place + (1 << self.halvings)) % self.count == next.place
    }

    /// Whether both are arcs of one circle that follow each other without meeting anywhere else.
    fn is_continued_by(&self, other: &Piece) -> bool {
        let (Some((a, sweep_a)), Some((b, sweep_b))) = (self.arc, other.arc) else { return false };
        let (ab, ba) = (self.is_before(other), other.is_before(self));
        a == b && ((ab && ba) || ((ab || ba) && sweep_a + sweep_b < TAU - OPEN_ANGLE))
    }
}

fn is_meeting(a: &Piece, b: &Piece) -> bool {
    if a.halvings == 0 && b.halvings == 0 {
        let (ab, ba) = (a.is_before(b), b.is_before(a));
        // A ring of two straight pieces is a line there and back.
        if ab && ba {
            return true;
        }
        if ab || ba {
            let (d, e) = (a.end - a.start, b.end - b.start);
            return d.dot(&e) < 0.0 && d.perp(&e).abs() <= FOLD_ANGLE * d.norm() * e.norm();
        }
    }
    let (margin_a, margin_b) = (a.margin(), b.margin());
    if !(is_crossing(a, b) || is_near(a, b, margin_a + margin_b)) {
        return false;
    }
    if a.halvings == 0 && b.halvings == 0 {
        return true;
    }
    // The one that is known less.
    let is_a = b.halvings == 0 || (a.halvings > 0 && margin_a >= margin_b);
    if is_a { a.halves().iter().any(|a| is_meeting(a, b)) } else { b.halves().iter().any(|b| is_meeting(a, b)) }
}

fn is_crossing(a: &Piece, b: &Piece) -> bool {
    let side = |p: &Piece, q: Point| (p.end - p.start).perp(&(q - p.start));
    let opposite = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    opposite(side(a, b.start), side(a, b.end)) && opposite(side(b, a.start), side(b, a.end))
}

fn is_near(a: &Piece, b: &Piece, limit: f64) -> bool {
    let near = |p: &Piece, q: Point| Segment::line(p.start, p.end).nearest(q).distance <= limit;
    near(a, b.start) || near(a, b.end) || near(b, a.start) || near(b, a.end)
}

/// Boxes over the pieces, in an order in which neighbours are neighbours in the plane.
struct Tree {
    /// The pieces in that order, with their boxes.
    pieces: Vec<(usize, Bounds)>,
    levels: Vec<Vec<Bounds>>,
}

impl Tree {
    fn new(pieces: &[Piece]) -> Tree {
        let boxes: Vec<Bounds> = pieces.iter().map(Piece::bounds).collect();
        let pieces: Vec<(usize, Bounds)> = along_curve(&boxes).into_iter().map(|i| (i, boxes[i])).collect();
        let leaf = |p: &[(usize, Bounds)]| p.iter().map(|(_, b)| *b).fold(Bounds::EMPTY, Bounds::union);
        let mut levels = vec![pieces.chunks(LEAF).map(leaf).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|l| l.len() > 1) {
            let above = below.chunks(2).map(|b| b.iter().copied().fold(Bounds::EMPTY, Bounds::union)).collect();
            levels.push(above);
        }
        Tree { pieces, levels }
    }

    /// Calls `visit` with all pairs (first before second) of pieces whose boxes overlap.
    fn visit_pairs(&self, mut visit: impl FnMut(usize, usize)) {
        let n = self.pieces.len();
        if n == 0 {
            return;
        }
        let range = |leaf: usize| leaf * LEAF..((leaf + 1) * LEAF).min(n);
        let mut stack = vec![(self.levels.len() - 1, 0, 0)];
        while let Some((level, a, b)) = stack.pop() {
            if level == 0 {
                for (k, (i, box_i)) in range(a).map(|k| (k, self.pieces[k])) {
                    let after = range(b).filter(|&l| k < l).map(|l| self.pieces[l]);
                    after.filter(|(_, b)| b.overlaps(&box_i)).for_each(|(j, _)| visit(i.min(j), i.max(j)));
                }
                continue;
            }
            let below = &self.levels[level - 1];
            for i in [2 * a, 2 * a + 1] {
                for j in [2 * b, 2 * b + 1] {
                    if i <= j && j < below.len() && below[i].overlaps(&below[j]) {
                        stack.push((level - 1, i, j));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Ring {
        let corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)];
        Ring::polygon(corners.map(|(x, y)| Point::new(x, y)))
    }

    fn meeting(rings: &[Ring]) -> Vec<(Vec<usize>, bool)> {
        groups(rings, 10.0).into_iter().map(|g| (g.rings, g.meets)).collect()
    }

    #[test]
    fn rings_group_by_contact() {
        let apart = [square(0.0, 0.0, 5.0), square(1.0, 1.0, 3.0), square(7.0, 0.0, 1.0)];
        assert_eq!(meeting(&apart), [(vec![0], false), (vec![1], false), (vec![2], false)]);
        // Overlap, contact in a corner, contact along a side.
        for x in [4.0, 5.0] {
            assert_eq!(meeting(&[square(0.0, 0.0, 5.0), square(x, x, 5.0)]), [(vec![0, 1], true)]);
        }
        assert_eq!(meeting(&[square(0.0, 0.0, 5.0), square(5.0, 1.0, 1.0)]), [(vec![0, 1], true)]);
    }

    #[test]
    fn a_ring_that_meets_itself_is_found() {
        let p = Point::new;
        let bow_tie = Ring::polygon([p(0.0, 0.0), p(1.0, 1.0), p(1.0, 0.0), p(0.0, 1.0)]);
        let spike = Ring::polygon([p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(1.0, 0.5), p(0.0, 1.0)]);
        let touch = Ring::polygon([p(0.0, 0.0), p(2.0, 0.0), p(1.0, 1.0), p(2.0, 2.0), p(0.0, 2.0), p(1.0, 1.0)]);
        for ring in [bow_tie, spike, touch] {
            assert_eq!(meeting(&[ring]), [(vec![0], true)]);
        }
    }

    #[test]
    fn arcs_meet_where_their_chords_do_not() {
        let circle = |x: f64| Ring::circle(Point::new(x, 0.0), 1.0);
        assert_eq!(meeting(&[circle(0.0)]), [(vec![0], false)]);
        assert_eq!(meeting(&[circle(0.0), circle(2.1)]).len(), 2);
        // Tangent at a point that is no vertex.
        let turned = Ring::circle(Point::new(2.0 * 0.1f64.cos(), 2.0 * 0.1f64.sin()), 1.0);
        assert_eq!(meeting(&[circle(0.0), turned]).len(), 1);
    }
}
