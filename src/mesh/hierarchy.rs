//! Bounding boxes around bounding boxes around triangles: nearest points, and what a segment meets.

mod neighbourhood;

pub use neighbourhood::Neighbourhood;

use super::disk::Disk;
use super::{Feature, Point, Vector, nearest_on_triangle};

/// So many triangles are looked at one by one.
const LEAF: usize = 4;

/// Deeper than any hierarchy of u32 triangles that is halved at every node.
const DEPTH: usize = 64;

/// Work on pairs of triangles is divided so often: some hundred pieces.
const DIVISIONS: usize = 6;

/// A box of the hierarchy.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: Point,
    high: Point,
    /// The first of two children, or of the triangles of a leaf.
    first: u32,
    /// How many triangles; none: two children.
    count: u32,
}

impl Node {
    /// The square of the distance of `p` from the box.
    #[inline]
    fn distance2(&self, p: &Point) -> f64 {
        let x = (self.low.x - p.x).max(p.x - self.high.x).max(0.0);
        let y = (self.low.y - p.y).max(p.y - self.high.y).max(0.0);
        let z = (self.low.z - p.z).max(p.z - self.high.z).max(0.0);
        x * x + y * y + z * z
    }

    fn meets(&self, other: &Node) -> bool {
        boxes_meet([&self.low, &self.high], [&other.low, &other.high])
    }
}

/// Whether two boxes have a point in common.
#[inline]
fn boxes_meet([low, high]: [&Point; 2], [l, h]: [&Point; 2]) -> bool {
    (0..3).all(|k| l[k] <= high[k] && h[k] >= low[k])
}

/// What rounding makes of a distance from a box is less than this part of it.
const ROUNDING: f64 = 1e-12;

/// Nodes of so many triangles or fewer have a disk: larger ones are seldom flat, and few.
const DISK: usize = 1024;

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Where it is.
    pub point: Point,
    /// How far it is.
    pub distance: f64,
    /// The triangle that it lies on; of several the one that was met first.
    pub face: u32,
    /// What of the triangle it lies on.
    pub feature: Feature,
}

/// Triangles arranged for queries.
#[derive(Clone, Debug, Default)]
pub struct Hierarchy {
    nodes: Vec<Node>,
    /// The disk of each node.
    disks: Vec<Disk>,
    /// The corners of the triangles, in the order of the leaves.
    triangles: Vec<[Point; 3]>,
    /// The number of the face that each of them is.
    faces: Vec<u32>,
}

impl Hierarchy {
    /// The hierarchy of all `faces`, or of as many as have corners at `points`.
    pub fn new(points: &[Point], faces: &[[u32; 3]]) -> Hierarchy {
        let corners: Vec<[Point; 3]> = faces.iter().map(|f| f.map(|v| points[v as usize])).collect();
        let mut order: Vec<(Point, u32)> = corners
            .iter()
            .zip(0..)
            .map(|([a, b, c], k)| (Point::from((a.coords + b.coords + c.coords) / 3.0), k))
            .collect();
        let mut nodes = Vec::with_capacity(2 * faces.len() / LEAF + 1);
        if faces.is_empty() {
            return Hierarchy::default();
        }
        let empty = Node { low: Point::origin(), high: Point::origin(), first: 0, count: 0 };
        nodes.push(empty);
        // The triangles of each node that is to have a disk; none of the others.
        let mut flat = vec![(0u32, 0u32)];
        let mut open = vec![(0usize, 0usize, faces.len())];
        while let Some((node, start, end)) = open.pop() {
            let far = f64::INFINITY;
            let (mut low, mut high) = (Point::new(far, far, far), Point::new(-far, -far, -far));
            let (mut least, mut most) = (low, high);
            for (center, k) in &order[start..end] {
                (least, most) = (least.inf(center), most.sup(center));
                for p in &corners[*k as usize] {
                    (low, high) = (low.inf(p), high.sup(p));
                }
            }
            if end - start <= DISK {
                flat[node] = (start as u32, end as u32);
            }
            if end - start <= LEAF {
                nodes[node] = Node { low, high, first: start as u32, count: (end - start) as u32 };
                continue;
            }
            // The widest axis of the centres, by halves: as deep as it need be, whatever the triangles.
            let axis = (most - least).imax();
            let middle = (start + end) / 2;
            order[start..end]
                .select_nth_unstable_by(middle - start, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
            let first = nodes.len() as u32;
            nodes.extend([empty, empty]);
            flat.extend([(0, 0); 2]);
            nodes[node] = Node { low, high, first, count: 0 };
            open.push((first as usize, start, middle));
            open.push((first as usize + 1, middle, end));
        }
        let faces: Vec<u32> = order.iter().map(|(_, k)| *k).collect();
        let triangles: Vec<[Point; 3]> = faces.iter().map(|&k| corners[k as usize]).collect();
        let disk = |(node, &(start, end)): (&Node, &(u32, u32))| {
            Disk::around(&triangles[start as usize..end as usize], nalgebra::center(&node.low, &node.high))
        };
        let disks = nodes.iter().zip(&flat).map(disk).collect();
        Hierarchy { nodes, disks, triangles, faces }
    }

    /// The nearest point of the surface to `p`, if it is nearer than `within`.
    pub fn nearest(&self, p: Point, within: f64) -> Option<Nearest> {
        self.nearest2(p, within * within)
    }

    /// The same with the square of the distance.
    fn nearest2(&self, p: Point, within2: f64) -> Option<Nearest> {
        let mut best2 = within2;
        let mut best = None;
        let mut stack = [(0u32, 0.0f64); DEPTH];
        let mut top = 0;
        if let Some(root) = self.nodes.first() {
            stack[0] = (0, root.distance2(&p));
            top = 1;
        }
        while top > 0 {
            top -= 1;
            let (node, distance2) = stack[top];
            if distance2 >= best2 || self.disks[node as usize].distance2(&p) >= best2 {
                continue;
            }
            let node = &self.nodes[node as usize];
            if node.count > 0 {
                for k in node.first..node.first + node.count {
                    let (point, feature) = nearest_on_triangle(p, self.triangles[k as usize]);
                    let d2 = (p - point).norm_squared();
                    if d2 < best2 {
                        best2 = d2;
                        best = Some((point, k, feature));
                    }
                }
                continue;
            }
            let (left, right) = (node.first, node.first + 1);
            let (l, r) = (self.nodes[left as usize].distance2(&p), self.nodes[right as usize].distance2(&p));
            let ((near, n), (far, f)) = if l <= r { ((left, l), (right, r)) } else { ((right, r), (left, l)) };
            if f < best2 {
                stack[top] = (far, f);
                top += 1;
            }
            if n < best2 {
                stack[top] = (near, n);
                top += 1;
            }
        }
        best.map(|(point, k, feature)| Nearest { point, distance: best2.sqrt(), face: self.faces[k as usize], feature })
    }

    /// Whether some point of the surface is nearer to `p` than `distance`.
    pub fn is_nearer(&self, p: Point, distance: f64) -> bool {
        let limit = distance * distance;
        self.any(
            |node, disk| node.distance2(&p) < limit && disk.distance2(&p) < limit,
            |triangle, _| (p - nearest_on_triangle(p, *triangle).0).norm_squared() < limit,
        )
    }

    /// Whether some triangle with a corner more than `height` above the plane through `base` along the unit vector `up` is nearer to
    /// `p` than `distance`.
    pub fn is_nearer_above(&self, p: Point, distance: f64, base: Point, up: Vector, height: f64) -> bool {
        let limit = distance * distance;
        let above = |q: &Point| up.dot(&(q - base));
        let may_be = |node: &Node, disk: &Disk| {
            let half = 0.5 * (node.high - node.low);
            let (middle, most) = (above(&nalgebra::center(&node.low, &node.high)), up.abs().dot(&half));
            let rounding = ROUNDING * (middle.abs() + most);
            middle + most + rounding > height
                && node.distance2(&p) * (1.0 - ROUNDING) < limit
                && disk.distance2(&p) * (1.0 - ROUNDING) < limit
        };
        self.any(may_be, |triangle, _| {
            triangle.iter().any(|q| above(q) > height) && (nearest_on_triangle(p, *triangle).0 - p).norm() < distance
        })
    }

    /// Whether the open segment from `a` to `b` meets a triangle.
    pub fn is_crossed(&self, a: Point, b: Point) -> bool {
        let along = b - a;
        let inverse = along.map(|x| 1.0 / x);
        let meets_box = |node: &Node, _: &Disk| {
            let (mut from, mut to) = (0.0f64, 1.0f64);
            for k in 0..3 {
                // A segment in the plane of a side gives no number, and the box is looked into.
                let (u, v) = ((node.low[k] - a[k]) * inverse[k], (node.high[k] - a[k]) * inverse[k]);
                from = from.max(u.min(v));
                to = to.min(u.max(v));
            }
            from <= to
        };
        self.any(meets_box, |triangle, _| crosses(a, along, triangle))
    }

    /// Calls `visit` with every face whose box meets the box between `low` and `high`; stops where it answers true, and
    /// says whether it did.
    pub fn any_in_box(&self, low: Point, high: Point, mut visit: impl FnMut(u32) -> bool) -> bool {
        let meets = |l: &Point, h: &Point| (0..3).all(|k| l[k] <= high[k] && h[k] >= low[k]);
        self.any(
            |node, _| meets(&node.low, &node.high),
            |[a, b, c], k| meets(&a.inf(b).inf(c), &a.sup(b).sup(c)) && visit(self.faces[k]),
        )
    }

    /// Pairs of nodes, also of a node with itself, that have between them every pair of faces whose boxes meet, each once: pieces
    /// of work for [`Hierarchy::any_pair`], always the same.
    pub(super) fn pieces(&self) -> Vec<[u32; 2]> {
        let mut pieces: Vec<[u32; 2]> = if self.nodes.is_empty() { vec![] } else { vec![[0, 0]] };
        for _ in 0..DIVISIONS {
            let mut smaller = vec![];
            for pair in pieces {
                if !self.divide(pair, &mut smaller) {
                    smaller.push(pair);
                }
            }
            pieces = smaller;
        }
        pieces
    }

    /// Adds pairs of smaller nodes that meet, in place of this one; false where both are leaves.
    fn divide(&self, [a, b]: [u32; 2], smaller: &mut Vec<[u32; 2]>) -> bool {
        let meet = |a: u32, b: u32| self.nodes[a as usize].meets(&self.nodes[b as usize]);
        let (one, other) = (&self.nodes[a as usize], &self.nodes[b as usize]);
        let size = |node: &Node| (node.high - node.low).sum();
        let pairs = match (one.count, other.count) {
            (0, _) if a == b => {
                let (l, r) = (one.first, one.first + 1);
                smaller.extend([[l, l], [r, r]]);
                smaller.extend(meet(l, r).then_some([l, r]));
                return true;
            }
            (0, c) if c > 0 || size(one) >= size(other) => [[one.first, b], [one.first + 1, b]],
            (_, 0) => [[a, other.first], [a, other.first + 1]],
            _ => return false,
        };
        smaller.extend(pairs.into_iter().filter(|&[a, b]| meet(a, b)));
        true
    }

    /// Calls `visit` with every pair of faces of a piece whose boxes meet, and their corners; stops where it answers true.
    pub(super) fn any_pair(&self, piece: [u32; 2], mut visit: impl FnMut([u32; 2], [&[Point; 3]; 2]) -> bool) {
        let leaf = |node: u32| {
            let node = &self.nodes[node as usize];
            node.first as usize..(node.first + node.count) as usize
        };
        let bounds = |[a, b, c]: &[Point; 3]| (a.inf(b).inf(c), a.sup(b).sup(c));
        let mut open = vec![piece];
        while let Some(pair) = open.pop() {
            if self.divide(pair, &mut open) {
                continue;
            }
            for i in leaf(pair[0]) {
                let (low, high) = bounds(&self.triangles[i]);
                for j in leaf(pair[1]).filter(|&j| pair[0] != pair[1] || j > i) {
                    let (l, h) = bounds(&self.triangles[j]);
                    if boxes_meet([&low, &high], [&l, &h])
                        && visit([self.faces[i], self.faces[j]], [&self.triangles[i], &self.triangles[j]])
                    {
                        return;
                    }
                }
            }
        }
    }

    /// Whether `hit` holds for a triangle, given with its place in the order of the leaves, in a box for which `enter` holds.
    fn any(&self, enter: impl Fn(&Node, &Disk) -> bool, mut hit: impl FnMut(&[Point; 3], usize) -> bool) -> bool {
        let mut stack = [0u32; DEPTH];
        let mut top = usize::from(!self.nodes.is_empty());
        while top > 0 {
            top -= 1;
            let (node, disk) = (&self.nodes[stack[top] as usize], &self.disks[stack[top] as usize]);
            if !enter(node, disk) {
                continue;
            }
            if node.count == 0 {
                stack[top] = node.first + 1;
                stack[top + 1] = node.first;
                top += 2;
                continue;
            }
            let leaf = node.first as usize..(node.first + node.count) as usize;
            if leaf.into_iter().any(|k| hit(&self.triangles[k], k)) {
                return true;
            }
        }
        false
    }
}

/// Whether a segment from `a` crosses a triangle (Möller and Trumbore, 1997).
fn crosses(a: Point, along: Vector, [p, q, s]: &[Point; 3]) -> bool {
    let (e1, e2) = (q - p, s - p);
    let h = along.cross(&e2);
    let det = e1.dot(&h);
    if det == 0.0 {
        return false;
    }
    let from = a - p;
    let u = from.dot(&h) / det;
    let cross = from.cross(&e1);
    let v = along.dot(&cross) / det;
    let t = e2.dot(&cross) / det;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 1.0
}

#[cfg(test)]
mod tests;
