//! A binary tree of bounding boxes over elements that stand in the order of a chain.
//!
//! Neighbours along a chain are neighbours in the plane, so the order needs no sorting: building is one pass, and the
//! boxes are nearly as tight as those of a sorted hierarchy.

use std::ops::Range;

use super::{Bounds, Point};

/// How many consecutive elements share a leaf: a balance of boxes kept against elements tested, by measurement.
const LEAF: usize = 4;

/// Levels of a tree over more elements than any memory holds: each level halves them.
const MOST_LEVELS: usize = 48;

/// Boxes over `n` elements in chain order: level 0 holds the leaves, the last level one box.
#[derive(Clone, Debug)]
pub struct ChainTree {
    levels: Vec<Vec<Bounds>>,
    len: usize,
}

impl ChainTree {
    /// The tree over `boxes`, one box an element.
    pub fn new(boxes: &[Bounds]) -> ChainTree {
        let union = |b: &[Bounds]| b.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        let mut levels = vec![boxes.chunks(LEAF).map(union).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|l| l.len() > 1) {
            let above = below.chunks(2).map(union).collect();
            levels.push(above);
        }
        ChainTree { levels, len: boxes.len() }
    }

    /// Calls `visit` with every element whose leaf comes within `reach()` of `p`, nearer subtrees first.
    ///
    /// `reach` is asked anew before every descent, so that a search for the nearest element can shrink it, and a search
    /// for any element can end itself by returning a negative number.
    pub fn visit_near(&self, p: Point, reach: impl FnMut() -> f64, visit: impl FnMut(usize)) {
        self.descend(|b| b.distance_squared(p), reach, visit);
    }

    /// Calls `visit` with every element whose leaf comes within `reach()` of `query`, nearer subtrees first, as
    /// [`ChainTree::visit_near`] does for a point.
    pub fn visit_near_box(&self, query: &Bounds, reach: impl FnMut() -> f64, visit: impl FnMut(usize)) {
        self.descend(|b| b.gap_squared(query), reach, visit);
    }

    /// Whether `test` holds for some element whose leaf comes within `reach` of `p`, nearer subtrees first.
    #[inline]
    pub fn any_near(&self, p: Point, reach: f64, mut test: impl FnMut(usize) -> bool) -> bool {
        let limit = reach * reach;
        let Some(top) = self.levels.len().checked_sub(1).filter(|_| self.len > 0) else { return false };
        // At most one child a level waits while the other is looked into.
        let mut waiting = [(0u32, 0u32); MOST_LEVELS];
        let mut count = 0;
        let (mut level, mut index) = (top, 0);
        loop {
            let next = if level == 0 {
                if (index * LEAF..((index + 1) * LEAF).min(self.len)).any(&mut test) {
                    return true;
                }
                None
            } else {
                let below = &self.levels[level - 1];
                let (a, b) = (2 * index, 2 * index + 1);
                let da = below[a].distance_squared(p);
                let db = below.get(b).map_or(f64::INFINITY, |bounds| bounds.distance_squared(p));
                let (near, far, nearest, farthest) = if da <= db { (a, b, da, db) } else { (b, a, db, da) };
                if farthest <= limit {
                    waiting[count] = (level as u32 - 1, far as u32);
                    count += 1;
                }
                (nearest <= limit).then_some((level - 1, near))
            };
            (level, index) = match next {
                Some(next) => next,
                None if count == 0 => return false,
                None => {
                    count -= 1;
                    (waiting[count].0 as usize, waiting[count].1 as usize)
                }
            };
        }
    }

    /// Calls `visit` with every element of every leaf that is entered: a box is where the boxes about it are and `enter`
    /// is true of it and of the elements in it.
    pub fn visit_entered(&self, enter: impl Fn(&Bounds, Range<usize>) -> bool, mut visit: impl FnMut(usize)) {
        let mut stack = Vec::with_capacity(self.levels.len());
        if self.len > 0 {
            stack.push((self.levels.len() - 1, 0));
        }
        while let Some((level, index)) = stack.pop() {
            let elements = (index * LEAF) << level..(((index + 1) * LEAF) << level).min(self.len);
            if !enter(&self.levels[level][index], elements.clone()) {
                continue;
            }
            if level == 0 {
                elements.for_each(&mut visit);
                continue;
            }
            if 2 * index + 1 < self.levels[level - 1].len() {
                stack.push((level - 1, 2 * index + 1));
            }
            stack.push((level - 1, 2 * index));
        }
    }

    #[inline]
    fn descend(
        &self,
        distance_squared_to: impl Fn(&Bounds) -> f64,
        mut reach: impl FnMut() -> f64,
        mut visit: impl FnMut(usize),
    ) {
        if self.len == 0 {
            return;
        }
        let mut stack = Vec::with_capacity(self.levels.len());
        let top = self.levels.len() - 1;
        stack.push((top, 0, distance_squared_to(&self.levels[top][0])));
        while let Some((level, index, distance_squared)) = stack.pop() {
            let limit = reach();
            // Nothing is nearer than a negative distance.
            if limit < 0.0 {
                return;
            }
            if distance_squared > limit * limit {
                continue;
            }
            if level == 0 {
                (index * LEAF..((index + 1) * LEAF).min(self.len)).for_each(&mut visit);
                continue;
            }
            let below = &self.levels[level - 1];
            let (a, b) = (2 * index, 2 * index + 1);
            let da = distance_squared_to(&below[a]);
            if b < below.len() {
                let db = distance_squared_to(&below[b]);
                if da <= db {
                    stack.push((level - 1, b, db));
                    stack.push((level - 1, a, da));
                } else {
                    stack.push((level - 1, a, da));
                    stack.push((level - 1, b, db));
                }
            } else {
                stack.push((level - 1, a, da));
            }
        }
    }
}
