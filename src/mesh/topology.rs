//! Which triangles are neighbours, also where they make no surface.

use super::TriangleMesh;

/// A triangle is without area where twice its area is not above this times the square of its longest edge: its normal would
/// be rounding.
const NO_AREA: f64 = 1e-14;

/// Sets of numbers that are joined, each with a parity against its set.
pub(super) struct Joined {
    parent: Vec<u32>,
    is_odd: Vec<bool>,
}

impl Joined {
    pub fn new(count: usize) -> Joined {
        Joined { parent: (0..count as u32).collect(), is_odd: vec![false; count] }
    }

    /// The set of `k`, and whether `k` is odd in it.
    pub fn find(&mut self, k: u32) -> (u32, bool) {
        let (mut root, mut is_odd) = (k, false);
        while self.parent[root as usize] != root {
            is_odd ^= self.is_odd[root as usize];
            root = self.parent[root as usize];
        }
        let (mut at, mut rest) = (k, is_odd);
        while self.parent[at as usize] != root && at != root {
            let next = self.parent[at as usize];
            let own = self.is_odd[at as usize];
            (self.parent[at as usize], self.is_odd[at as usize]) = (root, rest);
            rest ^= own;
            at = next;
        }
        (root, is_odd)
    }

    /// Joins two sets so that `a` and `b` differ or not; false where they are joined the other way already. The lower number
    /// stands for both.
    pub fn join(&mut self, a: u32, b: u32, differ: bool) -> bool {
        let ((p, odd_a), (q, odd_b)) = (self.find(a), self.find(b));
        let is_odd = odd_a ^ odd_b ^ differ;
        if p == q {
            return !is_odd;
        }
        let (low, high) = (p.min(q), p.max(q));
        (self.parent[high as usize], self.is_odd[high as usize]) = (low, is_odd);
        true
    }
}

/// The edges of triangles, with the half-edges of each: half-edge 3 f + k runs from corner k of face f.
pub(super) struct Edges {
    sorted: Vec<(u64, u32)>,
}

impl Edges {
    pub fn new(mesh: &TriangleMesh) -> Edges {
        let mut sorted: Vec<(u64, u32)> = Vec::with_capacity(3 * mesh.faces.len());
        for h in 0..3 * mesh.faces.len() as u32 {
            let [a, b] = ends(mesh, h);
            sorted.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), h));
        }
        sorted.sort_unstable();
        Edges { sorted }
    }

    /// The half-edges of each edge.
    pub fn groups(&self) -> impl Iterator<Item = &[(u64, u32)]> {
        self.sorted.chunk_by(|a, b| a.0 == b.0)
    }
}

/// Where a half-edge starts and ends.
pub(super) fn ends(mesh: &TriangleMesh, h: u32) -> [u32; 2] {
    let face = mesh.faces[h as usize / 3];
    [face[h as usize % 3], face[(h as usize + 1) % 3]]
}

/// Which polygons have another one at an edge.
pub(super) fn have_neighbours(mesh: &TriangleMesh, edges: &Edges, polygon_count: usize) -> Vec<bool> {
    let mut have = vec![false; polygon_count];
    let parent = |&(_, h): &(u64, u32)| mesh.parents[h as usize / 3];
    for group in edges.groups() {
        if group.iter().any(|h| parent(h) != parent(&group[0])) {
            group.iter().for_each(|h| have[parent(h) as usize] = true);
        }
    }
    have
}

/// The polygons of which a triangle has no normal, in order.
pub(super) fn without_area(mesh: &TriangleMesh) -> Vec<u32> {
    let is_flat = |f: &usize| {
        let [a, b, c] = mesh.triangle(*f);
        let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        mesh.area_vector(*f).norm() <= NO_AREA * longest2
    };
    let mut flat: Vec<u32> = (0..mesh.faces.len()).filter(is_flat).map(|f| mesh.parents[f]).collect();
    flat.dedup();
    flat
}
