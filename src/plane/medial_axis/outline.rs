//! The boundary as cyclic lists of pieces and of gates at convex corners.

use std::f64::consts::PI;

use super::NodeKind;
use super::domain::{Graph, Item};
use super::site::{Piece, Site};
use crate::plane::{Joint, Region, Ring, Segment, turn_angle};

/// Turn in radians up to which two elements meet without a corner of either kind: a little above what rounding does to the
/// directions of elements of ordinary length.
const TANGENT_TURN: f64 = 1e-9;

/// Turn in radians up to which a convex corner is rounding noise of the drawing, and no branch goes to it: 0.06 degrees,
/// what drawings written with few digits have where a line becomes an arc.
const NOISE_TURN: f64 = 1e-3;

/// Turn in radians from which a sample of a smooth curve is a true corner: a cusp of the curve itself. Half a quarter turn;
/// samples close enough to stand for a curve turn far less.
const CUSP_TURN: f64 = 0.25 * PI;

/// The sites of all rings, and the ring of each.
#[derive(Default)]
pub(super) struct Outline {
    pub sites: Vec<Site>,
    pub ring_of: Vec<usize>,
}

impl Outline {
    /// The list of a ring, whose elements shorter than `tiny` are left out; `None` where less than two are left.
    pub fn add(&mut self, region: &Region, number: usize, tiny: f64, graph: &mut Graph) -> Option<Vec<Item>> {
        let (segments, joints) = without_tiny(&region.rings[number], tiny);
        let n = segments.len();
        if n < 2 {
            return None;
        }
        let turns: Vec<f64> = (0..n).map(|i| turn_before(&segments, i)).collect();
        let mut items = Vec::with_capacity(2 * n);
        for (i, segment) in segments.iter().enumerate() {
            let turn = turns[i];
            if turn > TANGENT_TURN {
                let is_corner = match joints[i] {
                    Joint::Smooth => turn > CUSP_TURN,
                    Joint::Corner => turn > NOISE_TURN + turn_of_chords(&joints, &turns, i),
                };
                let kind = if is_corner { NodeKind::Corner } else { NodeKind::Sample };
                items.push(Item::Gate(graph.add_node(segment.start, 0.0, kind)));
            } else if turn < -TANGENT_TURN {
                let normal = crate::plane::left_normal(segments[(i + n - 1) % n].end_tangent()).normalize();
                items.push(self.piece(Site::Vertex { at: segment.start, first_normal: normal, turn: -turn }, number));
            }
            items.push(self.piece(Site::of_segment(segment), number));
        }
        Some(items)
    }

    fn piece(&mut self, site: Site, ring: usize) -> Item {
        self.sites.push(site);
        self.ring_of.push(ring);
        Item::Piece(Piece { site: self.sites.len() - 1, from: 0.0, to: site.end() })
    }
}

/// The turn at the start of element `i`. The tip of a needle turns by π up to rounding, to whichever side.
fn turn_before(segments: &[Segment], i: usize) -> f64 {
    let before = &segments[(i + segments.len() - 1) % segments.len()];
    let turn = turn_angle(before.end_tangent(), segments[i].start_tangent());
    if turn < NOISE_TURN - PI { turn + 2.0 * PI } else { turn }
}

/// What of the turn at corner `i` may be that of the chords that meet there: where a curve begins, its first chord differs
/// from its tangent by about half the turn at the next sample, and by all of it where the curvature falls fast.
fn turn_of_chords(joints: &[Joint], turns: &[f64], i: usize) -> f64 {
    let n = joints.len();
    [(i + n - 1) % n, (i + 1) % n].iter().filter(|&&k| joints[k] == Joint::Smooth).map(|&k| turns[k].abs()).sum()
}

/// The elements of a ring long enough to have a direction, and the joint at the start of each.
fn without_tiny(ring: &Ring, tiny: f64) -> (Vec<Segment>, Vec<Joint>) {
    let kept: Vec<usize> = (0..ring.len()).filter(|&i| ring.segment(i).length() > tiny).collect();
    let n = kept.len();
    let segments = (0..n).map(|k| {
        let (vertex, next) = (&ring.vertices[kept[k]], &ring.vertices[kept[(k + 1) % n]]);
        Segment { start: vertex.point, end: next.point, link: vertex.link }
    });
    // A corner among what was left out is one.
    let joints = (0..n).map(|k| {
        let before = kept[(k + n - 1) % n];
        let between = (1..=ring.len()).map(|step| (before + step) % ring.len()).take_while(|&i| i != kept[k]);
        let all_smooth = between.chain([kept[k]]).all(|i| ring.vertices[i].joint == Joint::Smooth);
        if all_smooth { Joint::Smooth } else { Joint::Corner }
    });
    (segments.collect(), joints.collect())
}
