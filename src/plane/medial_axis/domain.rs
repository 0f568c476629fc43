//! Cutting a region by maximal disks, until what is left are strips between two pieces of its boundary.
//!
//! A maximal disk that touches the boundary in two places cuts the axis in two at its centre, and the axis of either part
//! is found by itself (Choi, Choi and Moon, "Mathematical theory of medial axis transform", 1997, theorem 5.2). So whatever
//! rounding does to a single disk, the axis hangs together as it should. A part is a cyclic list of boundary pieces and
//! *gates*, the disks that it was cut by; a convex corner is a gate of radius zero.

use super::outline::Outline;
use super::site::{Foot, Piece, Site, Touch};
use super::{AxisNode, NodeKind};
use crate::plane::{Point, Vector};

/// Halvings of a stretch of boundary in the search for a branch: as many as a number has digits.
const HALVINGS: usize = 60;

/// Relative difference up to which two disks are the same one, and two places that they touch; what is touched there is
/// told by direction.
const SAME_RADIUS: f64 = 1e-9;

/// An item of a part's boundary.
#[derive(Clone, Copy, Debug)]
pub(super) enum Item {
    Piece(Piece),
    /// The number of the node at its centre.
    Gate(usize),
}

/// The axis as it is found.
#[derive(Default)]
pub(super) struct Graph {
    pub nodes: Vec<(AxisNode, NodeKind)>,
    /// Two nodes, and the nodes between them.
    pub edges: Vec<(usize, usize, Vec<AxisNode>)>,
}

impl Graph {
    pub fn add_node(&mut self, point: Point, clearance: f64, kind: NodeKind) -> usize {
        self.nodes.push((AxisNode { point, clearance }, kind));
        self.nodes.len() - 1
    }
}

/// The disk at a foot that can grow no more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disk {
    pub center: Point,
    pub radius: f64,
    /// The item that it touches, and where; `None` where its own arc is what it cannot outgrow.
    pub contact: Option<(usize, f64)>,
}

/// Cuts parts; `trace` is called with strips.
pub(super) struct Cutter<'a> {
    pub outline: &'a Outline,
    /// The distance below which two places are one.
    pub tiny: f64,
    pub graph: &'a mut Graph,
    pub waiting: Vec<Vec<Item>>,
}

/// A strip: a piece, the gate where it ends, the opposite piece, the gate where that ends.
pub(super) type Strip = (Piece, usize, Piece, usize);

impl Cutter<'_> {
    fn site(&self, piece: &Piece) -> &Site {
        &self.outline.sites[piece.site]
    }

    fn foot_of(&self, item: &Item, param: f64) -> Foot {
        match item {
            Item::Piece(piece) => self.site(piece).at(param),
            Item::Gate(node) => Foot { point: self.graph.nodes[*node].0.point, normal: Vector::zeros() },
        }
    }

    /// The first thing that the growing disk at `foot` touches in `items`, but for those that `skip` names; `None` where
    /// nothing stops it. `limit` is what its own piece allows.
    fn grow(&self, items: &[Item], foot: &Foot, limit: f64, skip: impl Fn(usize) -> bool) -> Option<Disk> {
        let mut radius = limit;
        let mut near: Vec<(usize, Touch)> = Vec::new();
        for (k, item) in items.iter().enumerate() {
            let Item::Piece(piece) = item else { continue };
            if skip(k) {
                continue;
            }
            let Some(touch) = self.site(piece).touch(piece.from, piece.to, foot, self.tiny) else { continue };
            if touch.radius < radius * (1.0 - SAME_RADIUS) {
                near.clear();
            }
            if touch.radius <= radius * (1.0 + SAME_RADIUS) {
                near.push((k, touch));
                radius = radius.min(touch.radius);
            }
        }
        // A disk at a vertex touches the ends of links too, but not along their normals.
        let feet = near.iter().map(|(k, touch)| (*k, touch, self.foot_of(&items[*k], touch.param)));
        let first = feet.clone().min_by(|a, b| a.1.radius.total_cmp(&b.1.radius)).filter(|f| f.1.radius < limit);
        let contact = first.and_then(|(_, _, Foot { point: place, .. })| {
            let center = foot.center(radius);
            let same_place = feet.filter(|(.., f)| (f.point - place).norm() <= SAME_RADIUS * radius);
            let slant = |f: &Foot| (f.center(radius) - center).norm();
            let straightest = same_place.min_by(|a, b| slant(&a.2).total_cmp(&slant(&b.2)));
            straightest.map(|(k, touch, _)| (k, touch.param))
        });
        radius.is_finite().then(|| Disk { center: foot.center(radius), radius, contact })
    }

    /// Takes all waiting parts to pieces and gives the strips to `trace`.
    pub fn run(&mut self, mut trace: impl FnMut(&mut Graph, Strip)) {
        while let Some(items) = self.waiting.pop() {
            let items = self.without_neighbouring_gates(items);
            if let Some(joint) = middle_joint(&items) {
                self.cut_at_joint(items, joint);
                continue;
            }
            // From here on gates and pieces take turns.
            match items.len() {
                0..=3 => {}
                4 => {
                    if let Some(strip) = strip(&items) {
                        trace(self.graph, strip);
                    }
                }
                _ => self.cut_at_branch(items),
            }
        }
    }

    /// Gates without boundary between them are one disk.
    fn without_neighbouring_gates(&mut self, items: Vec<Item>) -> Vec<Item> {
        let mut out: Vec<Item> = Vec::with_capacity(items.len());
        for item in items {
            if let (Item::Gate(b), Some(Item::Gate(a))) = (item, out.last()) {
                if *a != b {
                    self.graph.edges.push((*a, b, vec![]));
                }
            } else {
                out.push(item);
            }
        }
        while let (true, Some(Item::Gate(a)), Some(Item::Gate(b))) = (out.len() > 1, out.first(), out.last()) {
            if a != b {
                self.graph.edges.push((*b, *a, vec![]));
            }
            out.pop();
        }
        out
    }

    /// Cuts by the disk at the place where item `joint` ends and the next one begins.
    fn cut_at_joint(&mut self, mut items: Vec<Item>, joint: usize) {
        // The place becomes the beginning of the list.
        let n = items.len();
        items.rotate_left((joint + 1) % n);
        let (Item::Piece(after), Item::Piece(before)) = (items[0], items[n - 1]) else { return };
        let limits = (self.site(&before).own_limit(), self.site(&after).own_limit());
        let foot = self.site(&before).at(before.to);
        let disk = self.grow(&items, &foot, limits.0.min(limits.1), |k| k == 0 || k == n - 1);
        match disk {
            Some(Disk { center, radius, contact: Some((at, param)) }) => {
                let node = Item::Gate(self.graph.add_node(center, radius, NodeKind::Inner));
                let (first, second) = split(&items, at, param);
                self.waiting.push(first.into_iter().chain([node]).collect());
                self.waiting.push(second.into_iter().chain([node]).collect());
            }
            Some(Disk { radius, .. }) => {
                // The tighter of the two arcs is part of the disk's circle.
                let arc = if limits.0 == radius { n - 1 } else { 0 };
                self.shrink_arc(items, arc);
            }
            None => {
                // Nothing but rounding is left between the two.
                items.remove(0);
                self.waiting.push(items);
            }
        }
    }

    /// Replaces a convex arc that one disk touches all along by the gate of that disk.
    fn shrink_arc(&mut self, mut items: Vec<Item>, at: usize) {
        if let Item::Piece(piece) = items[at]
            && let Site::Arc { arc, .. } = *self.site(&piece)
        {
            items[at] = Item::Gate(self.graph.add_node(arc.center, arc.radius, NodeKind::Inner));
            self.waiting.push(items);
        }
    }

    /// Cuts a part of three or more pieces, a gate between any two: across, or by a disk that touches three.
    fn cut_at_branch(&mut self, mut items: Vec<Item>) {
        let n = items.len();
        let length = |item: &Item| match item {
            Item::Piece(p) => self.site(p).length(p.from, p.to),
            Item::Gate(_) => -1.0,
        };
        let longest = (0..n).max_by(|&a, &b| length(&items[a]).total_cmp(&length(&items[b]))).unwrap_or(0);
        items.rotate_left(longest);
        // Items with even numbers are pieces now.
        let Item::Piece(own) = items[0] else { return };
        let limit = self.site(&own).own_limit();
        let (mut low, mut high) = (own.from, own.to);
        // What the disk touches beside the next piece; the piece before, until something else is seen.
        let mut third = n - 2;
        for step in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if step > 0 && (middle <= low || middle >= high) {
                break;
            }
            let foot = self.site(&own).at(middle);
            match self.grow(&items, &foot, limit, |k| k == 0) {
                Some(Disk { contact: None, .. }) => return self.shrink_arc(items, 0),
                Some(Disk { contact: Some((2, _)), .. }) => high = middle,
                Some(Disk { center, radius, contact: Some((at, param)) }) => {
                    if step == 0 && at != n - 2 {
                        let node = Item::Gate(self.graph.add_node(center, radius, NodeKind::Inner));
                        return self.cut_across(&items, middle, at, param, node);
                    }
                    third = at;
                    low = middle;
                }
                None => low = middle,
            }
        }
        self.cut_in_three(&items, low, third);
    }

    /// Cuts by a disk that touches the first item at `own` and another one.
    fn cut_across(&mut self, items: &[Item], own: f64, at: usize, param: f64, node: Item) {
        let (own_before, own_after) = halves(&items[0], own);
        let (first, second) = split(items, at, param);
        let first = [own_after].into_iter().chain(first.into_iter().skip(1)).chain([node]);
        self.waiting.push(first.collect());
        self.waiting.push(second.into_iter().chain([own_before, node]).collect());
    }

    /// Cuts by the disk that touches the first piece at `own`, the next piece and the one at `third`.
    fn cut_in_three(&mut self, items: &[Item], own: f64, third: usize) {
        let (Item::Piece(a), Item::Piece(b), Item::Piece(c)) = (items[0], items[2], items[third]) else { return };
        let foot = self.site(&a).at(own);
        let touch = |p: &Piece| self.site(p).touch(p.from, p.to, &foot, self.tiny);
        let (on_b, on_c) = (touch(&b), touch(&c));
        let radius = [on_b, on_c].iter().flatten().map(|t| t.radius).fold(self.site(&a).own_limit(), f64::min);
        let node = if radius.is_finite() {
            self.graph.add_node(foot.center(radius), radius, NodeKind::Inner)
        } else if let Item::Gate(gate) = items[1] {
            gate
        } else {
            return;
        };
        let node = Item::Gate(node);
        let (a_before, a_after) = halves(&items[0], own);
        let (b_before, b_after) = halves(&items[2], on_b.map_or(b.from, |t| t.param));
        let (c_before, c_after) = halves(&items[third], on_c.map_or(c.to, |t| t.param));
        self.waiting.push(vec![a_after, items[1], b_before, node]);
        self.waiting.push([b_after].iter().chain(&items[3..third]).chain(&[c_before, node]).copied().collect());
        self.waiting.push([c_after].iter().chain(&items[third + 1..]).chain(&[a_before, node]).copied().collect());
    }

    /// Joins the list of every hole to another one, by the disk at the hole's leftmost place: that touches a ring which
    /// reaches farther left. What cannot be joined bounds nothing, and is dropped.
    pub fn join_holes(&mut self, mut lists: Vec<Vec<Item>>, is_hole: impl Fn(usize) -> bool) {
        for ring in 0..lists.len() {
            if !is_hole(ring) {
                continue;
            }
            let Some((at, param)) = self.leftmost(&lists[ring], ring) else { continue };
            let Item::Piece(piece) = lists[ring][at] else { continue };
            let foot = self.site(&piece).at(param);
            let found = lists.iter().enumerate().filter_map(|(k, list)| {
                let disk = self.grow(list, &foot, f64::INFINITY, |i| self.is_of(&list[i], ring))?;
                Some((k, disk))
            });
            let nearest = found.min_by(|a, b| a.1.radius.total_cmp(&b.1.radius));
            let Some((other, Disk { center, radius, contact: Some((to, to_param)) })) = nearest else {
                lists[ring].clear();
                continue;
            };
            if other == ring {
                continue;
            }
            let node = Item::Gate(self.graph.add_node(center, radius, NodeKind::Inner));
            let mut around = std::mem::take(&mut lists[ring]);
            around.rotate_left(at);
            let (before, after) = halves(&around[0], param);
            around[0] = after;
            around.push(before);
            let (first, second) = split(&lists[other], to, to_param);
            lists[other] = first.into_iter().chain([node]).chain(around).chain([node]).chain(second).collect();
        }
        self.waiting.extend(lists.into_iter().filter(|l| !l.is_empty()));
    }

    fn is_of(&self, item: &Item, ring: usize) -> bool {
        matches!(item, Item::Piece(p) if self.outline.ring_of[p.site] == ring)
    }

    /// The leftmost place of a ring; of a vertex and the links that meet there, the vertex.
    fn leftmost(&self, items: &[Item], ring: usize) -> Option<(usize, f64)> {
        let mut best: Option<(f64, usize, f64)> = None;
        for (k, item) in items.iter().enumerate() {
            let Item::Piece(piece) = item else { continue };
            if self.outline.ring_of[piece.site] != ring {
                continue;
            }
            let site = self.site(piece);
            let param = site.leftmost(piece.from, piece.to);
            let x = site.at(param).point.x;
            let wins = match site {
                Site::Vertex { .. } => best.is_none_or(|b| x <= b.0),
                _ => best.is_none_or(|b| x < b.0),
            };
            if wins {
                best = Some((x, k, param));
            }
        }
        best.map(|(_, k, param)| (k, param))
    }
}

/// The strip that a list of two pieces and two gates is.
fn strip(items: &[Item]) -> Option<Strip> {
    match *items {
        [Item::Piece(a), Item::Gate(g), Item::Piece(b), Item::Gate(h)] => Some((a, g, b, h)),
        [Item::Gate(h), Item::Piece(a), Item::Gate(g), Item::Piece(b)] => Some((a, g, b, h)),
        _ => None,
    }
}

/// The item behind which another piece follows without a gate, the one nearest to the middle of the list.
fn middle_joint(items: &[Item]) -> Option<usize> {
    let n = items.len();
    let is_joint = |k: usize| matches!((items[k], items[(k + 1) % n]), (Item::Piece(_), Item::Piece(_)));
    let middle = n / 2;
    (n > 1).then(|| (0..n).map(|step| (middle + step) % n).find(|&k| is_joint(k)))?
}

/// The list up to the place `param` of item `at`, and from there on.
fn split(items: &[Item], at: usize, param: f64) -> (Vec<Item>, Vec<Item>) {
    let (before, after) = halves(&items[at], param);
    let first = items[..at].iter().copied().chain([before]).collect();
    let second = [after].into_iter().chain(items[at + 1..].iter().copied()).collect();
    (first, second)
}

/// A piece up to `param` and from there on.
fn halves(item: &Item, param: f64) -> (Item, Item) {
    match *item {
        Item::Piece(p) => (Item::Piece(Piece { to: param, ..p }), Item::Piece(Piece { from: param, ..p })),
        gate => (gate, gate),
    }
}
