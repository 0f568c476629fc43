//! The surface of cut stock, closed all around.
//!
//! Stages: right triangles over the cells are halved until each is as near to the heights as asked; those with nothing left
//! above the lower face are left out; the rest, the same at the lower face and walls around the stock make the surface.
//! Halving is decided at the middle of the longest side, which two triangles share, so that no vertex lies within an
//! edge (right-triangulated irregular networks, Evans, Kirkpatrick and Townsend 2001).
//!
//! Guaranteed: closed, each edge between two faces, each vertex in one fan. Where stock is cut through so that only an edge
//! or a point would hang together, it is left thicker by [`HAIR`].

use std::collections::HashMap;

use super::height_map::HeightMap;
use super::motion::Point3;

/// A surface of triangles, counterclockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StockSurface {
    /// The vertices, in millimetres.
    pub points: Vec<Point3>,
    /// Their indices, three for each face.
    pub faces: Vec<[u32; 3]>,
}

/// Cells along the largest triangles: a power of two.
const TILE: usize = 64;

/// What is thinner than this, in millimetres, is cut through: files in single precision must tell both faces apart.
const HAIR: f64 = 1e-3;

/// Rounds of thickening: each makes at least one vertex thicker, and in practice a few are enough.
const MOST_ROUNDS: usize = 1000;

/// The surface of what stands on `map`, within `tolerance` millimetres of the heights at the middles of its cells.
pub fn stock_surface(map: &HeightMap, tolerance: f64) -> StockSurface {
    if map.columns() < 2 || map.rows() < 2 {
        return StockSurface::default();
    }
    let mut net = Net::new(map);
    net.measure();
    net.triangulate(tolerance);
    net.thicken();
    net.surface(map)
}

/// A place of the grid: column and row.
type Place = (usize, usize);

/// Triangles over a grid of heights.
struct Net {
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
    bottom: f64,
    /// How far the heights are from the triangle whose longest side has its middle there, or any that is halved from it.
    errors: Vec<f32>,
    /// Columns of `errors`, which covers whole tiles.
    stride: usize,
    tiles: [usize; 2],
    triangles: Vec<[u32; 3]>,
}

impl Net {
    fn new(map: &HeightMap) -> Net {
        let (columns, rows) = (map.columns(), map.rows());
        let bottom = map.stock().bottom_mm;
        let heights = (0..rows).flat_map(|row| (0..columns).map(move |column| map.height(column, row)));
        let heights = heights.map(|h| if h < bottom + HAIR { bottom } else { h }).collect();
        let tiles = [columns, rows].map(|count| (count - 1).div_ceil(TILE));
        let stride = tiles[0] * TILE + 1;
        let errors = vec![0.0; stride * (tiles[1] * TILE + 1)];
        Net { columns, rows, heights, bottom, errors, stride, tiles, triangles: Vec::new() }
    }

    fn height(&self, (column, row): Place) -> f64 {
        self.heights[row.min(self.rows - 1) * self.columns + column.min(self.columns - 1)]
    }

    /// The two triangles of each tile, as the ends of the longest side and the right angle, counterclockwise.
    fn roots(&self) -> impl Iterator<Item = [Place; 3]> + use<> {
        let tiles = self.tiles;
        (0..tiles[1]).flat_map(move |row| {
            (0..tiles[0]).flat_map(move |column| {
                let (x, y) = (column * TILE, row * TILE);
                let corner = |dx: usize, dy: usize| (x + dx * TILE, y + dy * TILE);
                [[corner(1, 1), corner(0, 0), corner(1, 0)], [corner(0, 0), corner(1, 1), corner(0, 1)]]
            })
        })
    }

    /// Fills `errors`, the smallest triangles of all tiles first, so that neighbours across tiles agree.
    fn measure(&mut self) {
        let depth = 2 * TILE.ilog2() as usize;
        for level in (0..depth).rev() {
            let roots = self.roots();
            for root in roots {
                for path in 0..1usize << level {
                    let mut triangle = root;
                    for bit in (0..level).rev() {
                        triangle = halves(triangle)[path >> bit & 1];
                    }
                    self.measure_one(triangle);
                }
            }
        }
    }

    fn measure_one(&mut self, triangle: [Place; 3]) {
        let [a, b, _] = triangle;
        let m = middle(a, b);
        let index = m.1 * self.stride + m.0;
        let at_middle = (self.height(m) - 0.5 * (self.height(a) + self.height(b))).abs();
        let mut error = if self.straddles(triangle) { f32::INFINITY } else { at_middle as f32 };
        for [p, q, _] in halves(triangle) {
            let n = middle(p, q);
            // The halves of the smallest triangles have no middles.
            if n != p && n != q && (p.0 + q.0) % 2 == 0 && (p.1 + q.1) % 2 == 0 {
                error = error.max(self.errors[n.1 * self.stride + n.0]);
            }
        }
        self.errors[index] = self.errors[index].max(error);
    }

    /// Whether a triangle lies partly beyond the last cells.
    fn straddles(&self, triangle: [Place; 3]) -> bool {
        let crosses =
            |values: [usize; 3], last: usize| values.iter().any(|&v| v < last) && values.iter().any(|&v| v > last);
        crosses(triangle.map(|p| p.0), self.columns - 1) || crosses(triangle.map(|p| p.1), self.rows - 1)
    }

    fn triangulate(&mut self, tolerance: f64) {
        let mut open: Vec<[Place; 3]> = self.roots().collect();
        open.reverse();
        while let Some(triangle) = open.pop() {
            let [a, b, c] = triangle;
            let m = middle(a, b);
            let can_be_halved = (a.0 + b.0) % 2 == 0 && (a.1 + b.1) % 2 == 0;
            if can_be_halved && f64::from(self.errors[m.1 * self.stride + m.0]) > tolerance {
                open.extend(halves(triangle).into_iter().rev());
            } else if [a, b, c].iter().all(|p| p.0 < self.columns && p.1 < self.rows) {
                self.triangles.push([a, b, c].map(|p| (p.1 * self.columns + p.0) as u32));
            }
        }
    }

    fn is_through(&self, vertex: u32) -> bool {
        self.heights[vertex as usize] <= self.bottom
    }

    fn is_kept(&self, triangle: &[u32; 3]) -> bool {
        triangle.iter().any(|&v| !self.is_through(v))
    }

    /// Raises vertices at the lower face at which the surface would touch itself.
    ///
    /// Both faces share the vertices that are cut through. An edge of two such vertices may have material on one side only,
    /// and the triangles with material around such a vertex must be one run that does not close.
    fn thicken(&mut self) {
        for _ in 0..MOST_ROUNDS {
            // Triangles around each vertex that is cut through, and edges between two of them there.
            let mut fans: HashMap<u32, i32> = HashMap::new();
            let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
            for triangle in self.triangles.iter().filter(|t| self.is_kept(t) && t.iter().any(|&v| self.is_through(v))) {
                for k in 0..3 {
                    let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
                    if self.is_through(p) {
                        *fans.entry(p).or_default() += 1;
                    }
                    if self.is_through(p) || self.is_through(q) {
                        *edges.entry([p.min(q), p.max(q)]).or_default() += 1;
                    }
                }
            }
            let mut raised: Vec<u32> = Vec::new();
            for (&[p, q], &count) in edges.iter().filter(|(_, count)| **count > 1) {
                debug_assert!(count == 2, "an edge has two sides");
                for v in [p, q] {
                    if let Some(fan) = fans.get_mut(&v) {
                        *fan -= 1;
                    }
                }
                if self.is_through(p) && self.is_through(q) {
                    raised.extend([p, q]);
                }
            }
            raised.extend(fans.iter().filter(|(_, runs)| **runs != 1).map(|(v, _)| *v));
            // A triangle's side may lie along the edge of the stock, where nothing is beyond it.
            if raised.is_empty() {
                return;
            }
            for v in raised {
                self.heights[v as usize] = self.bottom + HAIR;
            }
        }
    }

    fn surface(&self, map: &HeightMap) -> StockSurface {
        let mut surface = StockSurface::default();
        let mut numbers: HashMap<(u32, bool), u32> = HashMap::new();
        let outline = map.stock().outline();
        let mut vertex = |v: u32, is_upper: bool, points: &mut Vec<Point3>| {
            // Where stock is cut through, both faces are one.
            let is_upper = is_upper || self.is_through(v);
            *numbers.entry((v, is_upper)).or_insert_with(|| {
                let (column, row) = (v as usize % self.columns, v as usize / self.columns);
                let center = map.center(column, row);
                // The outermost cells reach to the sides of the stock.
                let to_side = |k: usize, count: usize, min: f64, middle: f64, max: f64| match k {
                    0 => min,
                    k if k + 1 == count => max,
                    _ => middle,
                };
                let x = to_side(column, self.columns, outline.min.x, center.x, outline.max.x);
                let y = to_side(row, self.rows, outline.min.y, center.y, outline.max.y);
                let z = if is_upper { self.heights[v as usize] } else { self.bottom };
                points.push(Point3::new(x, y, z));
                (points.len() - 1) as u32
            })
        };
        let last = [self.columns as u32 - 1, self.rows as u32 - 1];
        let place = |v: u32| [v % self.columns as u32, v / self.columns as u32];
        let on_side = |p: u32, q: u32| {
            let (p, q) = (place(p), place(q));
            (0..2).any(|axis| p[axis] == q[axis] && (p[axis] == 0 || p[axis] == last[axis]))
        };
        for triangle in self.triangles.iter().filter(|t| self.is_kept(t)) {
            let upper = triangle.map(|v| vertex(v, true, &mut surface.points));
            let lower = triangle.map(|v| vertex(v, false, &mut surface.points));
            surface.faces.extend([upper, [lower[0], lower[2], lower[1]]]);
            for k in 0..3 {
                let next = (k + 1) % 3;
                if !on_side(triangle[k], triangle[next]) {
                    continue;
                }
                let wall = [[upper[k], lower[k], lower[next]], [upper[k], lower[next], upper[next]]];
                surface.faces.extend(wall.into_iter().filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0]));
            }
        }
        surface
    }
}

fn middle(a: Place, b: Place) -> Place {
    ((a.0 + b.0) / 2, (a.1 + b.1) / 2)
}

/// The halves of a triangle, cut from its right angle to the middle of its longest side; counterclockwise as it is.
fn halves([a, b, c]: [Place; 3]) -> [[Place; 3]; 2] {
    let m = middle(a, b);
    [[c, a, m], [b, c, m]]
}

#[cfg(test)]
mod tests;
