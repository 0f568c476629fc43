//! The axis between two pieces of boundary: points equidistant from both, as many as the tolerance needs.

use super::domain::{Graph, Strip};
use super::outline::Outline;
use super::site::{Piece, Site};
use super::{AxisNode, Tracing};

/// Halvings of a piece at most: beyond it two places are one.
const MOST_HALVINGS: usize = 24;

/// Where along a stretch its distance from the chord is looked at. The axis of two lines, arcs or vertices is a plane conic
/// in the space of place and clearance, so it bends to one side, and three places tell how far.
const PROBES: [f64; 3] = [0.5, 0.25, 0.75];

/// Adds the edge of a strip to the graph. Chords stay within `tracing.tolerance` of the axis, in the space of place and
/// clearance.
pub(super) fn trace(outline: &Outline, graph: &mut Graph, (a, end, b, start): Strip, tracing: &Tracing) {
    let sites = &outline.sites;
    // The longer piece has the finer parameter.
    let reach = |p: &Piece| sites[p.site].length(p.from, p.to);
    let b_is_longer = reach(&b) > reach(&a);
    let (own, other) = if b_is_longer { (b, a) } else { (a, b) };
    let (from, to) = if b_is_longer { (end, start) } else { (start, end) };
    let sampler = Sampler { own: &sites[own.site], other: &sites[other.site], piece: other, tracing };
    let mut points = Vec::new();
    sampler.refine((own.from, graph.nodes[from].0), (own.to, graph.nodes[to].0), MOST_HALVINGS, &mut points);
    graph.edges.push((from, to, points));
}

struct Sampler<'a> {
    own: &'a Site,
    other: &'a Site,
    piece: Piece,
    tracing: &'a Tracing,
}

impl Sampler<'_> {
    /// The centre of the disk that touches its own piece at `param`, and the other one.
    fn at(&self, param: f64) -> Option<AxisNode> {
        let foot = self.own.at(param);
        let touch = self.other.touch(self.piece.from, self.piece.to, &foot, self.tracing.tiny)?;
        let clearance = touch.radius.min(self.own.own_limit());
        Some(AxisNode { point: foot.center(clearance), clearance })
    }

    /// Adds the nodes between two, in order.
    fn refine(&self, from: (f64, AxisNode), to: (f64, AxisNode), halvings: usize, out: &mut Vec<AxisNode>) {
        if halvings == 0 {
            return;
        }
        let at = |t: f64| self.at(from.0 + (to.0 - from.0) * t);
        let strays = |n: AxisNode| n.distance_to_chord(&from.1, &to.1) > self.tracing.tolerance;
        if !PROBES.iter().any(|&t| at(t).is_some_and(strays)) {
            return;
        }
        let middle = 0.5 * (from.0 + to.0);
        let Some(node) = self.at(middle) else { return };
        self.refine(from, (middle, node), halvings - 1, out);
        out.push(node);
        self.refine((middle, node), to, halvings - 1, out);
    }
}
