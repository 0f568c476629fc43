//! Open lines whose ends meet, joined: drawings for machines often have outlines in pieces.

use super::shapes::DrawnLine;
use crate::plane::{Joint, Point, Ring, Vertex};

/// Ends nearer to each other than this part of the size of all lines meet: what drawing programs round.
const MEETING: f64 = 1e-5;

/// Open lines as chains, each as long as it gets; those that end where they begin are closed. Ends that meet and are not the same
/// point get a straight element between them: nothing is moved.
pub(super) fn joined(lines: &[&DrawnLine]) -> Vec<DrawnLine> {
    let lines: Vec<&DrawnLine> = lines.iter().copied().filter(|line| line.ring.len() > 1).collect();
    let bounds = lines.iter().fold(crate::plane::Bounds::EMPTY, |b, line| b.union(line.ring.bounds()));
    let ends = Ends::new(&lines, MEETING * bounds.diagonal());
    let mut is_used = vec![false; lines.len()];
    let mut chains = Vec::new();
    for k in 0..lines.len() {
        if std::mem::replace(&mut is_used[k], true) {
            continue;
        }
        let mut chain = lines[k].ring.vertices.clone();
        let mut is_closed = false;
        // First from the end on, then from the start back.
        for _ in 0..2 {
            while let (Some(first), Some(last)) = (chain.first(), chain.last()) {
                if chain.len() > 2 && (first.point - last.point).norm() <= ends.reach {
                    is_closed = true;
                    break;
                }
                let Some((next, is_turned)) = ends.nearest(last.point, &is_used) else { break };
                is_used[next] = true;
                let ring = &lines[next].ring;
                append(&mut chain, if is_turned { ring.reversed() } else { ring.clone() });
            }
            if is_closed {
                break;
            }
            chain = Ring { vertices: chain }.reversed().vertices;
        }
        if is_closed && chain.first().map(|v| v.point) == chain.last().map(|v| v.point) {
            chain.pop();
        }
        chains.push(DrawnLine { ring: Ring { vertices: chain }, is_closed });
    }
    chains
}

/// Adds the vertices of `next` behind `chain`, which ends where it begins, or nearly.
fn append(chain: &mut Vec<Vertex>, next: Ring) {
    let mut next = next.vertices.into_iter();
    let (Some(last), Some(first)) = (chain.last_mut(), next.next()) else { return };
    if last.point == first.point {
        *last = Vertex { link: first.link, joint: Joint::Corner, ..*last };
    } else {
        *last = Vertex { link: crate::plane::Link::Line, joint: Joint::Corner, ..*last };
        chain.push(Vertex { joint: Joint::Corner, ..first });
    }
    chain.extend(next);
}

/// The ends of lines, by x.
struct Ends {
    /// Where, of which line, and whether it is the last point of it.
    ends: Vec<(Point, usize, bool)>,
    reach: f64,
}

impl Ends {
    fn new(lines: &[&DrawnLine], reach: f64) -> Ends {
        let of = |(k, line): (usize, &&DrawnLine)| {
            let (first, last) = (line.ring.vertices.first(), line.ring.vertices.last());
            [first.map(|v| (v.point, k, false)), last.map(|v| (v.point, k, true))]
        };
        let mut ends: Vec<_> = lines.iter().enumerate().flat_map(of).flatten().collect();
        ends.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        Ends { ends, reach }
    }

    /// The line that is not used and begins nearest to `p`, if it meets it, and whether it does so with its last point.
    fn nearest(&self, p: Point, is_used: &[bool]) -> Option<(usize, bool)> {
        let from = self.ends.partition_point(|e| e.0.x < p.x - self.reach);
        let near = self.ends[from..].iter().take_while(|e| e.0.x <= p.x + self.reach);
        let meeting = near.filter(|e| !is_used[e.1] && (e.0 - p).norm() <= self.reach);
        meeting.min_by(|a, b| (a.0 - p).norm().total_cmp(&(b.0 - p).norm())).map(|e| (e.1, e.2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 2]]) -> DrawnLine {
        DrawnLine { ring: Ring::polygon(points.iter().map(|p| Point::new(p[0], p[1]))), is_closed: false }
    }

    #[test]
    fn pieces_of_a_square_in_any_direction_are_a_square() {
        let pieces = [
            line(&[[0.0, 0.0], [10.0, 0.0]]),
            line(&[[0.0, 10.0], [10.0, 10.0]]),
            line(&[[0.0, 10.0], [0.0, 5.0], [0.0, 0.0]]),
            line(&[[10.0, 0.0], [10.0, 10.0]]),
            line(&[[20.0, 0.0], [30.0, 0.0]]),
        ];
        let chains = joined(&pieces.iter().collect::<Vec<_>>());
        assert_eq!(chains.len(), 2, "{chains:?}");
        assert!(chains[0].is_closed && !chains[1].is_closed);
        assert_eq!((chains[0].ring.len(), chains[0].ring.area().abs()), (5, 100.0));
    }

    #[test]
    fn ends_that_nearly_meet_are_bridged_and_nothing_moves() {
        let pieces =
            [line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]), line(&[[10.0, 10.000_01], [0.0, 10.0], [0.0, 0.0]])];
        let chains = joined(&pieces.iter().collect::<Vec<_>>());
        assert_eq!(chains.len(), 1);
        assert!(chains[0].is_closed);
        let points: Vec<Point> = chains[0].ring.vertices.iter().map(|v| v.point).collect();
        let drawn = pieces.iter().flat_map(|p| p.ring.vertices.iter().map(|v| v.point));
        assert!(drawn.into_iter().all(|p| points.contains(&p)), "{points:?}");
        let apart = [line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]), line(&[[10.0, 10.1], [0.0, 10.0], [0.0, 0.0]])];
        assert!(!joined(&apart.iter().collect::<Vec<_>>())[0].is_closed, "a gap is a gap");
    }

    #[test]
    fn a_chain_that_begins_in_the_middle_grows_to_both_sides() {
        let pieces =
            [line(&[[1.0, 0.0], [2.0, 0.0]]), line(&[[2.0, 0.0], [3.0, 0.0]]), line(&[[0.0, 0.0], [1.0, 0.0]])];
        let chains = joined(&pieces.iter().collect::<Vec<_>>());
        assert_eq!(chains.len(), 1);
        assert_eq!((chains[0].ring.len(), chains[0].is_closed), (4, false));
    }
}
