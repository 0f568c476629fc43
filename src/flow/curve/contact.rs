//! Where the boundary runs into itself.

use super::outline::Outline;
use crate::plane::{Bounds, ChainTree, Point, Segment, place_along_curve};

/// A search for edges that cross, among those that changed since it was last done and all others.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    /// The edges that were whole at the first search, by the nodes that they leave: they stay where they are while they
    /// are whole.
    whole: Option<Edges>,
    /// The other edges.
    loose: Vec<u32>,
    /// Edges that changed since the last search, some of them twice.
    changed: Vec<u32>,
    is_loose: Vec<bool>,
    /// Nodes whose edges were found to cross.
    known: Vec<bool>,
}

/// Edges in an order of place.
#[derive(Clone, Debug)]
struct Edges {
    leaving: Vec<u32>,
    segments: Vec<Segment>,
    tree: ChainTree,
}

impl Edges {
    fn new(outline: &Outline, leaving: Vec<u32>) -> Edges {
        let segments: Vec<Segment> = leaving.iter().map(|&i| outline.edge(i)).collect();
        let boxes: Vec<Bounds> = segments.iter().map(Segment::bounds).collect();
        Edges { tree: ChainTree::new(&boxes), leaving, segments }
    }

    /// Calls `visit` with every edge that meets `segment`, and where; edges that share an end with it aside.
    fn meet(&self, segment: &Segment, mut visit: impl FnMut(u32, Point)) {
        self.tree.visit_near_box(
            &segment.bounds(),
            || 0.0,
            |k| {
                let other = &self.segments[k];
                let ends = [segment.start, segment.end];
                if ends.contains(&other.start) || ends.contains(&other.end) {
                    return;
                }
                let approach = segment.approach(other);
                if approach.distance == 0.0 {
                    visit(self.leaving[k], approach.on_first);
                }
            },
        );
    }
}

impl Contacts {
    /// Remembers that the edge that leaves `i` changed.
    pub fn note(&mut self, i: u32) {
        self.changed.push(i);
    }

    /// Places where edges that changed since the last search cross others, but for crossings that are known.
    pub fn look(&mut self, outline: &Outline) -> Vec<Point> {
        let n = outline.nodes.len();
        self.is_loose.resize(n, false);
        self.known.resize(n, false);
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|&i| !outline.node(i).dead);
        self.loose.retain(|&i| {
            let stays = !outline.node(i).dead;
            self.is_loose[i as usize] = stays;
            self.known[i as usize] &= stays;
            stays
        });
        for &i in &changed {
            if !std::mem::replace(&mut self.is_loose[i as usize], true) {
                self.loose.push(i);
            }
        }
        // Neighbours in the plane are to be neighbours in the list.
        let bounds = Bounds::of_points(self.loose.iter().map(|&i| outline.node(i).point));
        self.loose.sort_by_cached_key(|&i| (place_along_curve(outline.node(i).point, &bounds), i));
        let loose = Edges::new(outline, self.loose.clone());
        let whole = self.whole.get_or_insert_with(|| {
            let is_whole = |i: &u32| !outline.node(*i).dead && outline.node(*i).whole;
            Edges::new(outline, (0..n as u32).filter(is_whole).collect())
        });
        let mut found = Vec::new();
        for i in changed {
            let segment = outline.edge(i);
            let mut meet = |j: u32, place: Point| {
                // One crossing is many in the steps that follow: of edges that cross, and of those put between them.
                let is_new = !self.known[i as usize] && !self.known[j as usize];
                (self.known[i as usize], self.known[j as usize]) = (true, true);
                if is_new {
                    found.push(place);
                }
            };
            loose.meet(&segment, &mut meet);
            whole.meet(&segment, |j, place| {
                if outline.node(j).whole && !outline.node(j).dead {
                    meet(j, place);
                }
            });
        }
        found
    }
}
