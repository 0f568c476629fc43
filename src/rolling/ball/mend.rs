//! Cutting out what tore, and closing the rims with each other where they lie on the same sheet of the closing.
//!
//! Where the ball no longer fits between two walls, the closing joins them: another topology than that of the input. The vertices
//! of each wall go to the mouths of the gap, some to one, some to another, and what spans from mouth to mouth is not the
//! closing. Cut out, it leaves a rim for each wall along the middle of each mouth, on the closing: the rims of facing walls
//! lie side by side there, and the strip between them is filled from where they are nearest.

use std::collections::{BTreeMap, BTreeSet};

use super::conflicts;
use super::contact::{Rest, UNTOUCHED};
use super::covering::{Covering, State};
use super::zip::{Corner, Strip, zip};
use crate::mesh::{Point, Vector};

/// Balls at the ends of an edge that are farther apart than this many radii are on different sides of a gap.
const JUMP: f64 = 1.9;

/// What is longer than this many edge lengths after remeshing could not be split, and may be torn.
const STRETCHED: f64 = 2.0;

/// Rims are joined over so many edge lengths at least, however small the ball.
const NARROW: f64 = 3.0;

/// Which rims are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rims {
    /// Those of vertices that moved, over the radius of the ball.
    Moved,
    /// Those of vertices that stay, too, over gaps as wide as the ball.
    All,
}

impl Covering<'_> {
    /// Cuts out the faces that are not the closing, and fills what is left open. Whether anything was done.
    ///
    /// Gaps that have no rim in common are mended each for itself: one that cannot be is left as it is.
    pub fn mend(&mut self) -> bool {
        let torn = self.torn();
        self.mend_these(torn, Rims::Moved)
    }

    /// The same for what is known to be torn as soon as the vertices have gone to their balls.
    pub fn mend_jumps(&mut self) -> bool {
        let torn = self.active_faces().into_iter().filter(|&f| self.jumps(f)).collect();
        self.mend_these(torn, Rims::Moved)
    }

    /// The same for some faces with so many rings of moved ones around them.
    pub fn mend_around(&mut self, faces: &[u32], rings: usize, rims: Rims) -> bool {
        let mut torn: BTreeSet<u32> = faces.iter().copied().collect();
        for _ in 0..rings {
            let corners: BTreeSet<u32> = torn.iter().flat_map(|&f| self.mesh.face(f)).collect();
            let around = corners.into_iter().flat_map(|v| self.mesh.faces_at(v).map(move |f| (v, f)));
            torn.extend(around.filter(|&(v, f)| !self.is_kept(v) || self.filled.contains(&f)).map(|(_, f)| f));
        }
        self.mend_these(torn.into_iter().collect(), rims)
    }

    fn jumps(&self, f: u32) -> bool {
        self.mesh.face(f).iter().any(|&v| self.state[v as usize] == State::Lost)
            || self.mesh.half_edges(f).iter().any(|&h| {
                let (u, v) = (self.mesh.origin(h), self.mesh.target(h));
                let (Some(a), Some(b)) = (self.rest(u), self.rest(v)) else { return false };
                self.mesh.length(h) > STRETCHED * self.edge && (a.center - b.center).norm() > JUMP * a.radius
            })
    }

    fn mend_these(&mut self, torn: Vec<u32>, which: Rims) -> bool {
        if torn.is_empty() {
            return false;
        }
        let gone = self.inside(self.cut(torn));
        if gone.is_empty() {
            return false;
        }
        let Some(rims) = self.rims(&gone) else { return false };
        let normal = |v: u32| {
            let moved = self.rest(v).map(|rest| rest.normal);
            if which == Rims::All { moved.or_else(|| self.normal_beside(v, &gone)) } else { moved }
        };
        let corner = |&v: &u32| Corner { vertex: v, point: self.point(v), normal: normal(v) };
        let corners: Vec<Vec<Corner>> = rims.iter().map(|rim| rim.iter().map(corner).collect()).collect();
        let is_edge = |a: u32, b: u32| {
            let has = |a, b| {
                let mut spokes = self.mesh.spokes(a);
                spokes.any(|h| self.mesh.target(h) == b && !gone.contains(&self.mesh.face_of(h)))
            };
            has(a, b) || has(b, a)
        };
        let radii = corners.iter().flatten().map(|c| self.radius(c.point));
        let width = if which == Rims::All { 2.0 } else { 1.0 };
        let reach = width * radii.fold(NARROW * self.edge, f64::max);
        let strips = zip(&corners, reach, self.edge, is_edge);
        let mut mended = false;
        for (faces, polygons) in self.gaps(&gone, &strips) {
            let mut new: Vec<[u32; 3]> = polygons.iter().flat_map(|&p| strips[p].triangles.iter().copied()).collect();
            let hubs: Option<Vec<(Point, Rest)>> =
                polygons.iter().filter(|&&p| strips[p].rest.len() > 2).map(|&p| self.hub(&strips[p].rest)).collect();
            let Some(hubs) = hubs else { continue };
            let first = self.state.len();
            let fans = polygons.iter().map(|&p| &strips[p].rest).filter(|rest| rest.len() > 2);
            for (fan, (p, rest)) in fans.zip(hubs) {
                let hub = self.mesh.add_vertex(p);
                self.state.push(State::Moved(rest));
                new.extend((0..fan.len()).map(|k| [fan[k], fan[(k + 1) % fan.len()], hub]));
            }
            let is_put = self.put(&faces, &new);
            if !is_put {
                self.state[first..].fill(State::Kept);
            }
            mended |= is_put;
        }
        mended
    }

    /// The normal at a vertex beside what goes, of the faces that stay.
    fn normal_beside(&self, v: u32, gone: &BTreeSet<u32>) -> Option<Vector> {
        let stay = self.mesh.faces_at(v).filter(|f| !gone.contains(f));
        stay.map(|f| self.mesh.area_vector(f)).sum::<Vector>().try_normalize(0.0)
    }

    /// A point of the closing in the middle of a polygon.
    fn hub(&self, polygon: &[u32]) -> Option<(Point, Rest)> {
        let rests: Vec<&Rest> = polygon.iter().filter_map(|&v| self.rest(v)).collect();
        let count = polygon.len() as f64;
        let middle = Point::from(polygon.iter().map(|&v| self.point(v).coords).sum::<Vector>() / count);
        let start =
            Point::from(rests.iter().map(|rest| rest.center.coords).sum::<Vector>() / rests.len().max(1) as f64);
        let rest = self.ground.rest(middle, start, self.radius(middle), UNTOUCHED)?;
        Some((rest.point(), rest))
    }

    /// Puts faces in the place of others. Whether that makes a surface.
    fn put(&mut self, gone: &[u32], new: &[[u32; 3]]) -> bool {
        let corners: BTreeSet<u32> = gone.iter().flat_map(|&f| self.mesh.face(f)).collect();
        // A new face counts as a part of one that it touches.
        let parents: BTreeMap<u32, u32> =
            gone.iter().flat_map(|&f| self.mesh.face(f).map(|v| (v, self.parent[f as usize]))).collect();
        let first = self.mesh.face_count() as u32;
        if self.mesh.replace(gone, new).is_err() {
            return false;
        }
        self.parent.extend(new.iter().map(|face| parents[&face[0]]));
        self.filled.extend(first..self.mesh.face_count() as u32);
        for f in gone.iter().copied().chain(first..self.mesh.face_count() as u32) {
            self.touch(f);
        }
        for &v in corners.iter().chain(new.iter().flatten()) {
            self.changes.mark(v);
        }
        for v in corners {
            if !self.mesh.has_vertex(v) {
                self.state[v as usize] = State::Kept;
            }
        }
        true
    }

    /// What goes, by gaps: pieces of it and the strips that fill them, as far as they have rims in common.
    fn gaps(&self, gone: &BTreeSet<u32>, strips: &[Strip]) -> Vec<(Vec<u32>, Vec<usize>)> {
        let mut strip_at: BTreeMap<u32, usize> = BTreeMap::new();
        for (k, strip) in strips.iter().enumerate() {
            strip_at.extend(strip.corners.iter().map(|&v| (v, k)));
        }
        let mut faces_at: Vec<Vec<u32>> = vec![Vec::new(); strips.len()];
        for &f in gone {
            for v in self.mesh.face(f) {
                if let Some(&k) = strip_at.get(&v) {
                    faces_at[k].push(f);
                }
            }
        }
        let mut left = gone.clone();
        let mut gaps = Vec::new();
        while let Some(first) = left.pop_first() {
            let (mut faces, mut at) = (vec![first], 0);
            let mut filled: BTreeSet<usize> = BTreeSet::new();
            while at < faces.len() {
                let f = faces[at];
                at += 1;
                let mut near: Vec<u32> = self.beside(f).collect();
                for k in self.mesh.face(f).iter().filter_map(|v| strip_at.get(v)) {
                    if filled.insert(*k) {
                        near.extend(&faces_at[*k]);
                    }
                }
                faces.extend(near.into_iter().filter(|g| left.remove(g)));
            }
            faces.sort_unstable();
            gaps.push((faces, filled.into_iter().collect()));
        }
        gaps
    }

    /// What goes with the faces that are torn, so that every vertex beside it keeps a single fan of faces.
    fn cut(&self, torn: Vec<u32>) -> BTreeSet<u32> {
        let torn: BTreeSet<u32> = torn.into_iter().collect();
        let mut gone = torn.clone();
        let mut spared: BTreeSet<u32> = BTreeSet::new();
        loop {
            self.widen(&torn, &mut gone, &mut spared);
            let count = gone.len();
            self.take_islands(&mut gone);
            if gone.len() == count {
                return gone;
            }
        }
    }

    /// The faces that are not the closing, as far as long edges and folds tell where to look.
    fn torn(&self) -> Vec<u32> {
        let (mut torn, others): (Vec<u32>, Vec<u32>) =
            self.active_faces().into_iter().partition(|&f| conflicts::is_folded(self, f));
        let is_suspect = |f: &u32| {
            self.mesh.face(*f).iter().any(|&v| self.state[v as usize] == State::Lost)
                || self.mesh.half_edges(*f).iter().any(|&h| self.mesh.length(h) > STRETCHED * self.edge)
        };
        let suspects: Vec<u32> = others.into_iter().filter(is_suspect).collect();
        torn.extend(conflicts::among(self, &suspects).faces);
        torn
    }

    /// Takes so many faces more that every vertex beside what goes keeps one fan of faces; where that would take what never
    /// moved, its faces are spared.
    fn widen(&self, torn: &BTreeSet<u32>, gone: &mut BTreeSet<u32>, spared: &mut BTreeSet<u32>) {
        let mut open: Vec<u32> = gone.iter().flat_map(|&f| self.mesh.face(f)).collect();
        while let Some(v) = open.pop() {
            let faces: Vec<u32> = self.mesh.faces_at(v).collect();
            let starts = (0..faces.len()).filter(|&k| {
                let before = faces[(k + faces.len() - 1) % faces.len()];
                !gone.contains(&faces[k]) && gone.contains(&before)
            });
            if starts.count() < 2 {
                continue;
            }
            let moved = |f: &u32| self.filled.contains(f) || !self.mesh.face(*f).iter().all(|&v| self.is_kept(v));
            let may_go = |f: &u32| (moved(f) || torn.contains(f)) && !spared.contains(f);
            if faces.iter().all(may_go) {
                gone.extend(&faces);
            } else {
                for f in &faces {
                    gone.remove(f);
                }
                spared.extend(&faces);
            }
            open.extend(faces.iter().flat_map(|&f| self.mesh.face(f)).filter(|&u| u != v));
        }
    }

    /// Takes also what is cut off from all that never moved: pieces of surface deep in a gap.
    fn take_islands(&self, gone: &mut BTreeSet<u32>) {
        let mut seen: BTreeSet<u32> = BTreeSet::new();
        let beside: Vec<u32> = gone.iter().flat_map(|&f| self.beside(f)).filter(|f| !gone.contains(f)).collect();
        let mut islands: Vec<Vec<u32>> = Vec::new();
        let mut is_mainland = false;
        for start in beside {
            if seen.contains(&start) {
                continue;
            }
            seen.insert(start);
            let (mut piece, mut at, mut stays) = (vec![start], 0, false);
            while at < piece.len() {
                let f = piece[at];
                at += 1;
                if self.mesh.face(f).iter().all(|&v| self.is_kept(v)) {
                    stays = true;
                    continue;
                }
                for g in self.beside(f) {
                    if !gone.contains(&g) && seen.insert(g) {
                        piece.push(g);
                    }
                }
            }
            if stays {
                is_mainland = true;
            } else {
                islands.push(piece);
            }
        }
        if !is_mainland {
            // All of it moves: the largest piece is the surface.
            islands.sort_by_key(|piece| piece.len());
            islands.pop();
        }
        gone.extend(islands.into_iter().flatten());
    }

    /// Of what goes, the pieces that do not reach a boundary, which stays.
    fn inside(&self, gone: BTreeSet<u32>) -> BTreeSet<u32> {
        let mut left = gone.clone();
        let mut inside = gone;
        while let Some(first) = left.pop_first() {
            let (mut piece, mut at) = (vec![first], 0);
            while at < piece.len() {
                let near: Vec<u32> = self.beside(piece[at]).collect();
                piece.extend(near.into_iter().filter(|g| left.remove(g)));
                at += 1;
            }
            if piece.iter().any(|&f| self.mesh.half_edges(f).iter().any(|&h| self.mesh.twin(h).is_none())) {
                piece.iter().for_each(|f| _ = inside.remove(f));
            }
        }
        inside
    }

    /// The faces beside a face.
    fn beside(&self, f: u32) -> impl Iterator<Item = u32> + '_ {
        self.mesh.half_edges(f).into_iter().filter_map(|h| self.mesh.twin(h)).map(|t| self.mesh.face_of(t))
    }

    /// The rims of what goes, each as the faces that go run around it. `None` where it reaches a boundary.
    fn rims(&self, gone: &BTreeSet<u32>) -> Option<Vec<Vec<u32>>> {
        let mut next: BTreeMap<u32, u32> = BTreeMap::new();
        for &f in gone {
            for h in self.mesh.half_edges(f) {
                if !gone.contains(&self.mesh.face_of(self.mesh.twin(h)?)) {
                    next.insert(self.mesh.origin(h), self.mesh.target(h));
                }
            }
        }
        let mut rims = Vec::new();
        while let Some((first, mut at)) = next.pop_first() {
            let mut rim = vec![first];
            while at != first {
                rim.push(at);
                at = next.remove(&at)?;
            }
            rims.push(rim);
        }
        Some(rims)
    }
}
