//! Neighbours in the plane made neighbours in a list, and what runs around a point.

use std::cell::OnceCell;

use crate::plane::{BoundaryIndex, Bounds, ChainTree, Point, Region, Ring};

/// Indices of `boxes` in the order of a Z-shaped curve that fills the plane: what is near in the list is near in the plane,
/// whatever the order of the file.
pub(super) fn along_curve(boxes: &[Bounds]) -> Vec<usize> {
    let all = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
    let side = all.width().max(all.height());
    // Casts saturate: whatever is no number counts as 0.
    let cell = |x: f64, least: f64| spread(((x - least) / side * f64::from(u32::MAX)) as u32);
    let code = |b: &Bounds| {
        let center = b.center();
        cell(center.x, all.min.x) | cell(center.y, all.min.y) << 1
    };
    let mut order: Vec<(u64, usize)> = boxes.iter().map(code).zip(0..).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, i)| i).collect()
}

/// The bits of `x` with a gap after each.
fn spread(x: u32) -> u64 {
    const STAGES: [(u32, u64); 5] = [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ];
    STAGES.iter().fold(u64::from(x), |x, (shift, mask)| (x | x << shift) & mask)
}

/// Rings of more links than this get an index of their own.
const MANY_LINKS: usize = 32;

/// Rings, arranged for the question how often they run around a point.
pub(super) struct Surroundings<'a> {
    rings: &'a [Ring],
    order: Vec<usize>,
    tree: ChainTree,
    indices: Vec<OnceCell<BoundaryIndex>>,
}

impl<'a> Surroundings<'a> {
    /// `boxes` are those of `rings`.
    pub fn new(rings: &'a [Ring], boxes: &[Bounds]) -> Surroundings<'a> {
        let order = along_curve(boxes);
        let sorted: Vec<Bounds> = order.iter().map(|&i| boxes[i]).collect();
        Surroundings { rings, tree: ChainTree::new(&sorted), order, indices: vec![OnceCell::new(); rings.len()] }
    }

    /// The winding number around `p` of all rings that `counts` takes.
    pub fn winding_number(&self, p: Point, counts: impl Fn(usize) -> bool) -> i32 {
        let mut winding = 0;
        self.tree.visit_near(
            p,
            || 0.0,
            |k| {
                let i = self.order[k];
                if counts(i) {
                    winding += self.of_ring(i, p);
                }
            },
        );
        winding
    }

    fn of_ring(&self, i: usize, p: Point) -> i32 {
        let ring = &self.rings[i];
        if ring.len() <= MANY_LINKS {
            return ring.winding_number(p);
        }
        let index = || BoundaryIndex::new(&Region::new(vec![ring.clone()]));
        self.indices[i].get_or_init(index).winding_number(p)
    }
}

/// Points in a leaf of the tree of boxes.
const LEAF: usize = 4;

/// Points, arranged for the question which of them lie on a line.
pub(super) struct Points {
    points: Vec<Point>,
    levels: Vec<Vec<Bounds>>,
}

impl Points {
    pub fn new(points: &[Point]) -> Points {
        let boxes: Vec<Bounds> = points.iter().map(|p| Bounds::of_points([*p])).collect();
        let points: Vec<Point> = along_curve(&boxes).into_iter().map(|i| points[i]).collect();
        let leaf = |p: &[Point]| Bounds::of_points(p.iter().copied());
        let mut levels = vec![points.chunks(LEAF).map(leaf).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|l| l.len() > 1) {
            let above = below.chunks(2).map(|b| b.iter().copied().fold(Bounds::EMPTY, Bounds::union)).collect();
            levels.push(above);
        }
        Points { points, levels }
    }

    /// Calls `visit` with every point nearer than `reach` to the line from `a` to `b`, and how far along it is, in parts
    /// of its length.
    pub fn visit_on_line(&self, a: Point, b: Point, reach: f64, mut visit: impl FnMut(Point, f64)) {
        let d = b - a;
        let length = d.norm();
        if self.points.is_empty() || length == 0.0 {
            return;
        }
        let line = Bounds::of_points([a, b]).inflated(reach);
        let off = |p: Point| (d.perp(&(p - a)) / length).abs();
        let mut stack = vec![(self.levels.len() - 1, 0)];
        while let Some((level, index)) = stack.pop() {
            let bounds = &self.levels[level][index];
            if !bounds.overlaps(&line) || off(bounds.center()) > 0.5 * bounds.diagonal() + reach {
                continue;
            }
            if level > 0 {
                stack.extend(
                    [2 * index, 2 * index + 1]
                        .map(|i| (level - 1, i))
                        .iter()
                        .filter(|(l, i)| *i < self.levels[*l].len()),
                );
                continue;
            }
            for p in self.points.iter().skip(index * LEAF).take(LEAF) {
                let along = (p - a).dot(&d) / (length * length);
                if off(*p) < reach && (0.0..=1.0).contains(&along) {
                    visit(*p, along);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_quarter_after_quarter() {
        let at = |x: f64, y: f64| Bounds::of_points([Point::new(x, y)]);
        let grid: Vec<Bounds> = (0..16).map(|k| at(f64::from(k % 4), f64::from(k / 4))).collect();
        assert_eq!(along_curve(&grid), [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15]);
        assert_eq!(along_curve(&[at(f64::NAN, 0.0), at(1.0, 1.0)]).len(), 2);
        assert_eq!(along_curve(&[at(1.0, 1.0)]), [0]);
    }

    #[test]
    fn windings_are_those_of_all_rings_together() {
        let circle = |x: f64, r: f64| Ring::circle(Point::new(x, 0.0), r);

        let angles = (0..200).map(|k| f64::from(k) * std::f64::consts::TAU / 200.0);
        let gear = Ring::polygon(angles.map(|a| {
            let r = 6.0 + (a * 30.0).sin();
            Point::new(r * a.cos(), r * a.sin())
        }));
        let rings = [gear, circle(0.0, 3.0).reversed(), circle(1.0, 0.5), circle(20.0, 2.0)];
        let boxes: Vec<Bounds> = rings.iter().map(Ring::bounds).collect();
        let surroundings = Surroundings::new(&rings, &boxes);
        for k in 0..400 {
            let p = Point::new(f64::from(k % 20) * 1.3 - 3.01, f64::from(k / 20) * 0.71 - 7.03);
            for left_out in 0..=4 {
                let expected: i32 = (0..4).filter(|i| *i != left_out).map(|i| rings[i].winding_number(p)).sum();
                assert_eq!(surroundings.winding_number(p, |i| i != left_out), expected, "{p} without {left_out}");
            }
        }
    }
}
