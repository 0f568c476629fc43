//! Where the surface runs into itself.

use super::SurfaceFront;
use super::front::is_gone;
use crate::mesh::{Hierarchy, Point, cross};

/// What changed since contacts were last looked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    /// Vertices at faces that cross go back to where they were, and stay.
    freeze: bool,
    /// The faces of the input.
    pub ground: Option<Hierarchy>,
    /// Faces that changed, some of them twice.
    changed: Vec<u32>,
    /// Where vertices were, in the order in which they moved.
    places: Vec<(u32, Point)>,
    /// Faces that were found to cross.
    known: Vec<bool>,
}

impl Contacts {
    pub fn new(freeze: bool) -> Contacts {
        Contacts { freeze, ..Contacts::default() }
    }

    /// Remembers that a face changed.
    pub fn note(&mut self, f: u32) {
        self.changed.push(f);
    }

    /// Remembers where a vertex was before it moved.
    pub fn remember(&mut self, v: u32, p: Point) {
        if self.freeze {
            self.places.push((v, p));
        }
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
        let places = std::mem::take(&mut self.contacts.places);
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
        if self.contacts.freeze && !pairs.is_empty() {
            self.put_back(&pairs, places);
        }
        found
    }

    /// Puts the vertices of crossing faces back to where they were first of all since the last search, and pins them.
    fn put_back(&mut self, pairs: &[(u32, u32)], mut places: Vec<(u32, Point)>) {
        places.sort_by_key(|(v, _)| *v);
        places.dedup_by_key(|(v, _)| *v);
        let mut vertices: Vec<u32> = pairs.iter().flat_map(|&(f, g)| [f, g]).flat_map(|f| self.mesh.face(f)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        for v in vertices {
            if let Ok(k) = places.binary_search_by_key(&v, |(v, _)| *v) {
                self.place(v, places[k].1);
                if self.input.points.get(v as usize) == Some(&places[k].1) {
                    self.vertices[v as usize].moved = false;
                }
            }
            self.vertices[v as usize].pinned = true;
            self.touch(v);
        }
        self.contacts.places.clear();
    }
}
