//! An order in which always the nearest comes next.

use crate::plane::{Bounds, Point};

/// Paths to a cell of the grid in which they are sought, about.
const PER_CELL: f64 = 2.0;

/// A path of the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Next {
    /// Its number.
    pub path: usize,
    /// Whether it is gone from its end to its start.
    pub is_turned: bool,
}

/// The order of paths of which only the ends are given, from `here` on; equally near ones come in the order that they are
/// given in. Paths are turned where `may_turn`.
pub(super) fn nearest_next(ends: &[[Point; 2]], may_turn: bool, mut here: Point) -> Vec<Next> {
    let mut grid = Grid::new(ends, may_turn);
    let mut is_done = vec![false; ends.len()];
    let mut order = Vec::with_capacity(ends.len());
    while let Some(next) = grid.take_nearest(here, ends, &mut is_done) {
        here = ends[next.path][usize::from(!next.is_turned)];
        order.push(next);
    }
    order
}

/// The ends of paths by where they are.
struct Grid {
    bounds: Bounds,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Next>>,
    left: usize,
}

impl Grid {
    fn new(ends: &[[Point; 2]], may_turn: bool) -> Grid {
        let bounds = Bounds::of_points(ends.iter().flatten().copied());
        let (width, height) = (bounds.width().max(0.0), bounds.height().max(0.0));
        let wanted = (ends.len() as f64 / PER_CELL).max(1.0);
        // Square cells, as many as wanted; in a row where all lie on a line.
        let cell = (width * height / wanted).sqrt().max(width.max(height) / wanted);
        let count = |length: f64| if cell > 0.0 { (length / cell) as usize + 1 } else { 1 };
        let (columns, rows) = (count(width), count(height));
        let mut grid = Grid { bounds, cell, columns, rows, cells: vec![Vec::new(); columns * rows], left: ends.len() };
        for (path, pair) in ends.iter().enumerate() {
            for is_turned in if may_turn { &[false, true][..] } else { &[false] } {
                let [column, row] = grid.place(pair[usize::from(*is_turned)]);
                grid.cells[row * columns + column].push(Next { path, is_turned: *is_turned });
            }
        }
        grid
    }

    fn place(&self, p: Point) -> [usize; 2] {
        let index = |value: f64, count: usize| {
            let at = if self.cell > 0.0 { (value / self.cell).max(0.0) as usize } else { 0 };
            at.min(count - 1)
        };
        [index(p.x - self.bounds.min.x, self.columns), index(p.y - self.bounds.min.y, self.rows)]
    }

    /// Takes the nearest path that is not done.
    fn take_nearest(&mut self, here: Point, ends: &[[Point; 2]], is_done: &mut [bool]) -> Option<Next> {
        if self.left == 0 {
            return None;
        }
        let [column, row] = self.place(here);
        let mut best: Option<(f64, Next)> = None;
        for reach in 0..=self.columns.max(self.rows) {
            // What lies farther out than `reach - 1` cells is at least so far away.
            if best.is_some_and(|(distance, _)| distance < (reach as f64 - 1.0) * self.cell) {
                break;
            }
            let rows = row.saturating_sub(reach)..=(row + reach).min(self.rows - 1);
            for r in rows {
                let is_edge = r.abs_diff(row) == reach;
                let step = if is_edge { 1 } else { (2 * reach).max(1) };
                let first = column as isize - reach as isize;
                for c in (first..=first + 2 * reach as isize).step_by(step) {
                    if c < 0 || c as usize >= self.columns {
                        continue;
                    }
                    let cell = &mut self.cells[r * self.columns + c as usize];
                    cell.retain(|next| !is_done[next.path]);
                    for next in cell {
                        let distance = (ends[next.path][usize::from(next.is_turned)] - here).norm();
                        let key = |d: f64, n: &Next| (d, n.path, n.is_turned);
                        if best.is_none_or(|(d, n)| key(distance, next) < key(d, &n)) {
                            best = Some((distance, *next));
                        }
                    }
                }
            }
        }
        let (_, next) = best?;
        is_done[next.path] = true;
        self.left -= 1;
        Some(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by looking at all that are left.
    fn plain(ends: &[[Point; 2]], may_turn: bool, mut here: Point) -> Vec<Next> {
        let mut left: Vec<usize> = (0..ends.len()).collect();
        let mut order = Vec::new();
        while !left.is_empty() {
            let turns: &[bool] = if may_turn { &[false, true] } else { &[false] };
            let all = left.iter().flat_map(|&path| turns.iter().map(move |&is_turned| Next { path, is_turned }));
            let distance = |n: &Next| (ends[n.path][usize::from(n.is_turned)] - here).norm();
            let next = all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
            here = ends[next.path][usize::from(!next.is_turned)];
            left.retain(|&k| k != next.path);
            order.push(next);
        }
        order
    }

    proptest::proptest! {
        #[test]
        fn the_grid_finds_what_a_look_at_all_finds(
            values in proptest::collection::vec((0u8..40, 0u8..30, 0u8..40, 0u8..30), 0..120),
            may_turn: bool,
            start in (-10.0..60.0, -10.0..60.0),
            flat: bool,
        ) {
            let y = |v: u8| if flat { 0.0 } else { f64::from(v) };
            let ends: Vec<[Point; 2]> = values
                .iter()
                .map(|&(a, b, c, d)| [Point::new(f64::from(a), y(b)), Point::new(f64::from(c), y(d))])
                .collect();
            let here = Point::new(start.0, start.1);
            proptest::prop_assert_eq!(nearest_next(&ends, may_turn, here), plain(&ends, may_turn, here));
        }
    }
}
