//! Many faces in the place of many others, where the surface is cut and joined in another way.

use std::collections::BTreeMap;

use super::{HalfEdgeMesh, NONE, NotManifold};

impl HalfEdgeMesh {
    /// Takes faces out and puts others in their place, appended. Edges that are left open become boundaries.
    ///
    /// # Errors
    /// Where the surface would be none any more: then nothing has changed.
    pub fn replace(&mut self, gone: &[u32], new: &[[u32; 3]]) -> Result<(), NotManifold> {
        let mut gone = gone.to_vec();
        gone.sort_unstable();
        gone.dedup();
        let goes = |f: u32| gone.binary_search(&f).is_ok();
        let mut around: Vec<u32> =
            gone.iter().flat_map(|&f| self.face(f)).chain(new.iter().flatten().copied()).collect();
        around.sort_unstable();
        around.dedup();
        // The links of all vertices that are concerned: from corner to corner in the faces that they will have.
        let mut links: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (f, &[a, b, c]) in (0u32..).zip(new) {
            if a == b || b == c || c == a {
                return Err(NotManifold::Face(self.face_count() as u32 + f));
            }
            for (v, x, y) in [(a, b, c), (b, c, a), (c, a, b)] {
                if links.insert((v, x), y).is_some() {
                    return Err(NotManifold::Edge(v, x));
                }
            }
        }
        for &v in &around {
            for h in self.spokes(v).filter(|&h| !goes(h / 3)) {
                if links.insert((v, self.target(h)), self.opposite(h)).is_some() {
                    return Err(NotManifold::Edge(v, self.target(h)));
                }
            }
        }
        let mut degree: BTreeMap<u32, usize> = BTreeMap::new();
        let mut ends: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &(v, x) in links.keys() {
            *degree.entry(v).or_default() += 1;
            ends.entry(v).or_default().push(x);
        }
        for (v, mut from) in ends {
            from.sort_unstable();
            let reached: Vec<u32> = from.iter().map(|&x| links[&(v, x)]).collect();
            let first = from.iter().copied().find(|x| !reached.contains(x)).unwrap_or(from[0]);
            let count = std::iter::successors(Some(first), |&x| links.get(&(v, x)).copied().filter(|&y| y != first));
            if count.filter(|&x| links.contains_key(&(v, x))).count() != degree[&v] {
                return Err(NotManifold::Vertex(v));
            }
        }
        self.put(&gone, new, &around);
        Ok(())
    }

    /// Does what [`HalfEdgeMesh::replace`] has found good; `around` are the corners of all those faces.
    fn put(&mut self, gone: &[u32], new: &[[u32; 3]], around: &[u32]) {
        let mut beside: Vec<u32> = around.iter().flat_map(|&v| self.spokes(v).collect::<Vec<_>>()).collect();
        for &f in gone {
            for h in self.half_edges(f) {
                let twin = std::mem::replace(&mut self.twin[h as usize], NONE);
                if twin != NONE {
                    self.twin[twin as usize] = NONE;
                }
                self.origin[h as usize] = NONE;
            }
        }
        beside.retain(|&h| self.origin[h as usize] != NONE);
        for &corners in new {
            let first = self.add_face(corners);
            beside.extend([first, first + 1, first + 2]);
        }
        // Each edge between two of those vertices has both of its half-edges here, as each leaves one of them.
        let open: BTreeMap<(u32, u32), u32> = beside
            .iter()
            .filter(|&&h| self.twin[h as usize] == NONE)
            .map(|&h| ((self.origin(h), self.target(h)), h))
            .collect();
        for (&(a, b), &h) in &open {
            if let Some(&t) = open.get(&(b, a)) {
                self.twin[h as usize] = t;
            }
        }
        for &v in around {
            self.outgoing[v as usize] = NONE;
        }
        for h in beside {
            let v = self.origin(h);
            if self.outgoing[v as usize] == NONE {
                self.settle(v, h);
            }
        }
    }
}
