//! Where the surface runs into itself.

use super::SurfaceFront;
use super::front::is_gone;
use crate::mesh::{Hierarchy, Point, cross};

/// What changed since contacts were last looked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    /// The faces of the input.
    pub ground: Option<Hierarchy>,
    /// Faces that changed, some of them twice.
    changed: Vec<u32>,
    /// Faces that were found to cross.
    known: Vec<bool>,
}

impl Contacts {
    /// Remembers that a face changed.
    pub fn note(&mut self, f: u32) {
        self.changed.push(f);
    }
}

impl SurfaceFront<'_> {
    /// The faces of the input, arranged for queries.
    pub(super) fn ground(&mut self) -> &Hierarchy {
        let input = &self.input;
        self.contacts.ground.get_or_insert_with(|| Hierarchy::new(&input.points, &input.faces))
    }

    /// Places where faces that changed since the last search pass through others, but for faces of which that is known.
    pub(super) fn find_contacts(&mut self) -> Vec<Point> {
        self.ground();
        let mut changed = std::mem::take(&mut self.contacts.changed);
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|&f| !is_gone(&self.mesh, f));
        let loose: Vec<u32> =
            (0..self.touched.len() as u32).filter(|&f| self.touched[f as usize] && !is_gone(&self.mesh, f)).collect();
        let corners: Vec<[u32; 3]> = loose.iter().map(|&f| self.mesh.face(f)).collect();
        let tree = Hierarchy::new(&self.mesh.points, &corners);
        self.contacts.known.resize(self.mesh.face_count(), false);
        let (mut pairs, mut found) = (Vec::new(), Vec::new());
        for &f in &changed {
            let triangle = self.mesh.triangle(f);
            let [a, b, c] = triangle;
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let mut meet = |g: u32| {
                if g != f && cross(triangle, self.mesh.triangle(g)) {
                    pairs.push((f, g));
                }
            };
            tree.any_in_box(low, high, |k| {
                meet(loose[k as usize]);
                false
            });
            if let Some(ground) = &self.contacts.ground {
                ground.any_in_box(low, high, |g| {
                    if !self.touched[g as usize] {
                        meet(g);
                    }
                    false
                });
            }
        }
        for &(f, g) in &pairs {
            let known = &mut self.contacts.known;
            if !known[f as usize] && !known[g as usize] {
                let [a, b, c] = self.mesh.triangle(f);
                found.push(Point::from((a.coords + b.coords + c.coords) / 3.0));
            }
            (known[f as usize], known[g as usize]) = (true, true);
        }
        found
    }

    /// Where vertices would go on if the surface did not meet itself.
    pub(super) fn blocked(&self) -> Vec<Point> {
        let is_blocked = |v: &u32| self.vertices[*v as usize].blocked && self.mesh.has_vertex(*v);
        (0..self.vertices.len() as u32).filter(is_blocked).map(|v| self.point(v)).collect()
    }
}
