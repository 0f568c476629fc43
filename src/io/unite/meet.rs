//! Which rings cross, touch or overlap: themselves or each other.

use crate::plane::{Bounds, Link, Point, Ring, Segment};

/// Links nearer than this, in parts of the larger side of the drawing, touch. A few cells of the overlay's grid.
const TOUCH: f64 = 2.5e-13;

/// How far the chords that stand for an arc may stray from it, in parts of its radius. They are tested with that margin,
/// so that nothing is missed; what is found for nothing costs time only.
const ARC_MARGIN: f64 = 1e-5;

/// Links that turn back by this angle, in radians, run over each other.
const FOLD_ANGLE: f64 = 1e-12;

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

/// A straight piece that stands for a link or a part of it.
struct Piece {
    start: Point,
    end: Point,
    margin: f64,
    ring: u32,
    /// Position in the ring, and how many pieces the ring has.
    place: u32,
    count: u32,
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
        if (i == j && meets[i]) || !is_meeting(a, b) {
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

fn pieces(rings: &[Ring], touch: f64) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(rings.iter().map(Ring::len).sum());
    for (number, ring) in rings.iter().enumerate() {
        let first = pieces.len();
        for segment in ring.segments() {
            let mut start = segment.start;
            let mut push = |end: Point, margin: f64| {
                pieces.push(Piece { start, end, margin, ring: number as u32, place: 0, count: 0 });
                start = end;
            };
            match segment.link {
                Link::Line => push(segment.end, touch / 2.0),
                Link::Arc(arc) => {
                    let sagitta = ARC_MARGIN * arc.radius;
                    // Two halves at least: the ends of a piece tell it from its neighbour.
                    let middle = segment.point_at(0.5);
                    for (a, b) in [(segment.start, middle), (middle, segment.end)] {
                        Segment { start: a, end: b, ..segment }.flatten(sagitta, |p| push(p, touch / 2.0 + sagitta));
                    }
                }
            }
        }
        let count = (pieces.len() - first) as u32;
        for (place, piece) in pieces[first..].iter_mut().enumerate() {
            (piece.place, piece.count) = (place as u32, count);
        }
    }
    pieces
}

fn is_meeting(a: &Piece, b: &Piece) -> bool {
    if a.ring == b.ring {
        let follows = |a: &Piece, b: &Piece| (a.place + 1) % a.count == b.place;
        let (ab, ba) = (follows(a, b), follows(b, a));
        // A ring of two straight pieces is a line there and back.
        if ab && ba {
            return true;
        }
        if ab || ba {
            let (d, e) = (a.end - a.start, b.end - b.start);
            return d.dot(&e) < 0.0 && d.perp(&e).abs() <= FOLD_ANGLE * d.norm() * e.norm();
        }
    }
    is_crossing(a, b) || is_near(a, b)
}

fn is_crossing(a: &Piece, b: &Piece) -> bool {
    let side = |p: &Piece, q: Point| (p.end - p.start).perp(&(q - p.start));
    let opposite = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    opposite(side(a, b.start), side(a, b.end)) && opposite(side(b, a.start), side(b, a.end))
}

fn is_near(a: &Piece, b: &Piece) -> bool {
    let limit = a.margin + b.margin;
    let near = |p: &Piece, q: Point| Segment::line(p.start, p.end).nearest(q).distance <= limit;
    near(a, b.start) || near(a, b.end) || near(b, a.start) || near(b, a.end)
}

/// Boxes over the pieces in their order along the rings: neighbours there are neighbours in the plane.
struct Tree {
    levels: Vec<Vec<Bounds>>,
    len: usize,
}

impl Tree {
    fn new(pieces: &[Piece]) -> Tree {
        let boxed = |p: &Piece| Bounds::of_points([p.start, p.end]).inflated(p.margin);
        let leaf = |p: &[Piece]| p.iter().map(boxed).fold(Bounds::EMPTY, Bounds::union);
        let mut levels = vec![pieces.chunks(LEAF).map(leaf).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|l| l.len() > 1) {
            let above = below.chunks(2).map(|b| b.iter().copied().fold(Bounds::EMPTY, Bounds::union)).collect();
            levels.push(above);
        }
        Tree { levels, len: pieces.len() }
    }

    /// Calls `visit` with all pairs (first before second) of pieces whose leaves overlap.
    fn visit_pairs(&self, mut visit: impl FnMut(usize, usize)) {
        if self.len == 0 {
            return;
        }
        let range = |leaf: usize| leaf * LEAF..((leaf + 1) * LEAF).min(self.len);
        let mut stack = vec![(self.levels.len() - 1, 0, 0)];
        while let Some((level, a, b)) = stack.pop() {
            if level == 0 {
                for i in range(a) {
                    range(b).filter(|&j| i < j).for_each(|j| visit(i, j));
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
