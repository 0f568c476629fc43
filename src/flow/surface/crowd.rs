//! Which faces are near: so that no move takes the surface through itself.
//!
//! Faces of the input that nobody touched are found by the hierarchy of the input; all others are filed here, in cells, under every
//! cell that their boxes meet. A change of a few faces is asked about before it is made, and costs what is near them.

use super::SurfaceFront;
use crate::mesh::{HalfEdgeMesh, Point, cross};

/// The size of a cell in edge lengths: faces meet few cells, cells meet few faces.
const CELL: f64 = 1.5;

/// A face that meets more cells than this is looked at always.
const MOST_CELLS: i64 = 512;

/// The least number of lists of faces.
const LEAST_LISTS: usize = 1 << 10;

type Cell = [i64; 3];

/// Faces by the cells that they meet.
#[derive(Clone, Debug, Default)]
pub(super) struct Crowd {
    size: f64,
    /// Faces of the cells whose numbers end alike; a power of two of lists.
    lists: Vec<Vec<u32>>,
    /// The lowest and highest cells that each face is filed under.
    spans: Vec<Option<[Cell; 2]>>,
    /// Faces that meet too many.
    large: Vec<u32>,
    /// The question in which each face was last seen.
    seen: Vec<u32>,
    question: u32,
}

impl Crowd {
    /// For so many faces of this edge length.
    pub fn new(edge: f64, faces: usize) -> Crowd {
        let lists = faces.next_power_of_two().max(LEAST_LISTS);
        Crowd { size: CELL * edge, lists: vec![Vec::new(); lists], ..Crowd::default() }
    }

    fn span(&self, [a, b, c]: [Point; 3]) -> [Cell; 2] {
        // Far away all cells are one: a question of speed alone.
        let cell = |p: Point| [p.x, p.y, p.z].map(|x| (x / self.size).floor() as i64);
        [cell(a.inf(&b).inf(&c)), cell(a.sup(&b).sup(&c))]
    }

    fn is_large([low, high]: [Cell; 2]) -> bool {
        let size = |k: usize| high[k].saturating_sub(low[k]).saturating_add(1);
        size(0).saturating_mul(size(1)).saturating_mul(size(2)) > MOST_CELLS
    }

    fn list(&self, [x, y, z]: Cell) -> usize {
        let mixed = (x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791)) as usize;
        mixed & (self.lists.len() - 1)
    }

    /// Files a face, whose corners are there now.
    pub fn file(&mut self, f: u32, triangle: [Point; 3]) {
        if self.spans.len() <= f as usize {
            self.spans.resize(f as usize + 1, None);
            self.seen.resize(f as usize + 1, 0);
        }
        let span = self.span(triangle);
        if self.spans[f as usize] == Some(span) {
            return;
        }
        if let Some(old) = self.spans[f as usize].replace(span) {
            self.each(old, |list| {
                if let Some(k) = list.iter().position(|&g| g == f) {
                    list.swap_remove(k);
                }
            });
        }
        self.each(span, |list| list.push(f));
    }

    fn each(&mut self, span: [Cell; 2], mut visit: impl FnMut(&mut Vec<u32>)) {
        if Crowd::is_large(span) {
            return visit(&mut self.large);
        }
        for cell in cells(span) {
            let list = self.list(cell);
            visit(&mut self.lists[list]);
        }
    }

    /// Whether some filed face that is still there and for which `is_asked` holds passes through a triangle.
    fn crosses(&mut self, mesh: &HalfEdgeMesh, triangle: [Point; 3], is_asked: impl Fn(u32) -> bool) -> bool {
        let [a, b, c] = triangle;
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        self.question += 1;
        let question = self.question;
        let span = self.span(triangle);
        let meets = |seen: &mut [u32], f: u32| {
            if std::mem::replace(&mut seen[f as usize], question) == question || !mesh.has_face(f) || !is_asked(f) {
                return false;
            }
            let [p, q, r] = mesh.triangle(f);
            let (l, h) = (p.inf(&q).inf(&r), p.sup(&q).sup(&r));
            (0..3).all(|k| l[k] <= high[k] && h[k] >= low[k]) && cross(triangle, [p, q, r])
        };
        if Crowd::is_large(span) {
            return (0..self.spans.len() as u32).any(|f| self.spans[f as usize].is_some() && meets(&mut self.seen, f));
        }
        if self.large.iter().any(|&f| meets(&mut self.seen, f)) {
            return true;
        }
        cells(span).any(|cell| {
            let list = self.list(cell);
            self.lists[list].iter().any(|&f| meets(&mut self.seen, f))
        })
    }
}

/// The cells of a span.
fn cells([low, high]: [Cell; 2]) -> impl Iterator<Item = Cell> {
    (low[0]..=high[0])
        .flat_map(move |x| (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z])))
}

impl SurfaceFront<'_> {
    /// Whether faces with these corners would pass through each other or through any but those `without`, whose place they take.
    ///
    /// What only goes on, and is told where it crosses, is asked nothing.
    pub(super) fn would_cross(&mut self, triangles: &[[Point; 3]], without: &[u32]) -> bool {
        if !self.is_guarded {
            return false;
        }
        let among = |k: usize| triangles[..k].iter().any(|t| cross(*t, triangles[k]));
        if (1..triangles.len()).any(among) {
            return true;
        }
        self.ground();
        let Some(ground) = &self.contacts.ground else { return false };
        let (mesh, touched, crowd) = (&self.mesh, &self.touched, &mut self.crowd);
        triangles.iter().any(|&t| {
            let [a, b, c] = t;
            let is_in_input = |g: u32| !touched[g as usize] && !without.contains(&g) && cross(t, mesh.triangle(g));
            crowd.crosses(mesh, t, |f| !without.contains(&f))
                || ground.any_in_box(a.inf(&b).inf(&c), a.sup(&b).sup(&c), is_in_input)
        })
    }

    /// Whether the faces at vertex `v` would pass through others, were it at `p`.
    pub(super) fn would_cross_at(&mut self, v: u32, p: Point) -> bool {
        if !self.is_guarded {
            return false;
        }
        let faces: Vec<u32> = self.mesh.faces_at(v).collect();
        let at = |w: u32| if w == v { p } else { self.point(w) };
        let triangles: Vec<[Point; 3]> = faces.iter().map(|&f| self.mesh.face(f).map(at)).collect();
        self.would_cross(&triangles, &faces)
    }
}
