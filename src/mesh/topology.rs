//! Which triangles are neighbours, also where they make no surface.

use super::TriangleMesh;

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
