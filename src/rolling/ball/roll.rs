//! One level: where every vertex goes with a ball of some radius, and the surface moved there.

use super::contact;
use super::covering::{Covering, State};
use super::{parallel, remesh};
use crate::mesh::{Point, Vector};

/// An edge that gets longer than so many times its length, or so many edge lengths, is stretched: what lies between its ends
/// may be lost.
const STRETCHED: f64 = 2.5;

/// Balls that are nearer to the input than their radius by less than this part of it touch it.
const TOUCHING: f64 = 1e-8;

/// Coarse faces near what moves are cut so often at most.
const CUTS: usize = 8;

/// A vertex that would move by less than this many sagittas of its edges stays, and by less than so many edge lengths: the
/// samples of a surface that the ball fits are on it, not their chords.
const SAGITTAS: f64 = 2.0;
const DEAD_BAND: f64 = 0.05;

/// Whether some edge would be stretched so that what lies between may be lost.
pub(super) fn stretches(covering: &Covering, targets: &[Option<Target>]) -> bool {
    let place = |v: u32| match targets.get(v as usize) {
        Some(Some(Target::Goes(p, _))) => *p,
        _ => covering.point(v),
    };
    (0..targets.len() as u32).filter(|&v| matches!(targets[v as usize], Some(Target::Goes(..)))).any(|v| {
        covering.mesh.spokes(v).any(|h| {
            let length = (place(v) - place(covering.mesh.target(h))).norm();
            length > STRETCHED * covering.edge.max(covering.mesh.length(h))
        })
    })
}

/// What goes on from level to level.
pub(super) struct Roll {
    /// Directions in which to look for a ball first.
    pub normals: Vec<Vector>,
    pub threads: usize,
}

/// Where a vertex is to go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Stays,
    Lost,
    Goes(Point, State),
}

impl Roll {
    /// The vertices of `among` that the ball does not touch along their normals.
    pub fn untouched(&self, covering: &Covering, among: Vec<u32>) -> Vec<u32> {
        let is_untouched = parallel::map(&among, self.threads, |&v| {
            let (x, normal) = (covering.point(v), self.normals[v as usize]);
            let r = covering.radius(x);
            !covering.mesh.is_boundary(v)
                && covering.mesh.has_vertex(v)
                && covering.ground.hierarchy.is_nearer(x + normal * r, r * (1.0 - TOUCHING))
        });
        among.into_iter().zip(is_untouched).filter(|(_, is)| *is).map(|(v, _)| v).collect()
    }

    /// Cuts long edges whose middles the ball does not touch, though it touches both ends: a concave edge of a coarse mesh
    /// begins and ends in vertices that stay.
    pub fn cut_edges_between(&mut self, covering: &mut Covering, moving: &mut Vec<u32>) {
        let mut moves = vec![false; covering.state.len()];
        let targets = parallel::map(moving, self.threads, |&v| self.target(covering, v));
        for (&v, target) in moving.iter().zip(&targets) {
            moves[v as usize] = !matches!(target, Target::Stays);
        }
        let mesh = &covering.mesh;
        let edges: Vec<u32> = (0..3 * mesh.face_count() as u32)
            .filter(|&h| mesh.is_edge(h) && !moves[mesh.origin(h) as usize] && !moves[mesh.target(h) as usize])
            .filter(|&h| mesh.length(h) > remesh::LONGEST * covering.edge)
            .collect();
        let hidden = parallel::map(&edges, self.threads, |&h| {
            let unit = |x: u32| mesh.area_vector(mesh.face_of(x)).try_normalize(0.0).unwrap_or_default();
            let normal = (unit(h) + unit(mesh.twin(h)?)).try_normalize(0.0)?;
            let middle = nalgebra::center(&covering.point(mesh.origin(h)), &covering.point(mesh.target(h)));
            let r = covering.radius(middle);
            let reach = r - DEAD_BAND * covering.edge;
            let is_hidden = reach > 0.0 && covering.ground.hierarchy.is_nearer(middle + normal * r, reach);
            is_hidden.then_some((middle, normal))
        });
        for (h, found) in edges.into_iter().zip(hidden) {
            let Some((middle, normal)) = found else { continue };
            let w = covering.split(h, middle, State::Kept);
            self.normals.resize(covering.state.len(), Vector::zeros());
            self.normals[w as usize] = normal;
            moving.push(w);
        }
    }

    /// Where the vertices go with a ball of the covering's radius.
    pub fn targets(&mut self, covering: &mut Covering, moving: &mut Vec<u32>) -> Vec<Option<Target>> {
        let mut targets: Vec<Option<Target>> = vec![None; covering.state.len()];
        let mut open: Vec<u32> = (0..covering.state.len() as u32)
            .filter(|&v| covering.mesh.has_vertex(v) && !covering.is_kept(v))
            .chain(moving.iter().copied().filter(|&v| covering.is_kept(v) && covering.mesh.has_vertex(v)))
            .collect();
        open.sort_unstable();
        for cut in 0..=CUTS {
            let found = parallel::map(&open, self.threads, |&v| self.target(covering, v));
            for (&v, target) in open.iter().zip(found) {
                targets[v as usize] = Some(target);
            }
            if cut == CUTS {
                break;
            }
            open = self.cut_coarse(covering, &mut targets, moving);
            if open.is_empty() {
                break;
            }
        }
        targets
    }

    /// Moves the surface there.
    pub fn advance(&mut self, covering: &mut Covering, targets: Vec<Option<Target>>) {
        for (v, target) in targets.into_iter().enumerate() {
            match target {
                None | Some(Target::Stays) => {}
                Some(Target::Lost) => covering.state[v] = State::Lost,
                Some(Target::Goes(p, state)) => {
                    covering.mesh.points[v] = p;
                    covering.state[v] = state;
                }
            }
        }
        for v in 0..covering.state.len() as u32 {
            if !covering.is_kept(v) {
                for f in covering.mesh.faces_at(v).collect::<Vec<_>>() {
                    covering.touch(f);
                }
            }
        }
        self.find_lost(covering);
    }

    /// Where a vertex goes.
    fn target(&self, covering: &Covering, v: u32) -> Target {
        let x = covering.point(v);
        let r = covering.radius(x);
        let normal = match covering.rest(v) {
            Some(rest) => rest.normal,
            None if covering.is_kept(v) => self.normals[v as usize],
            None => {
                let sum: Vector = covering.mesh.faces_at(v).map(|f| covering.mesh.area_vector(f)).sum();
                sum.try_normalize(0.0).unwrap_or_default()
            }
        };
        let is_kept = covering.is_kept(v);
        if r <= 0.0 || covering.mesh.is_boundary(v) {
            return Target::Stays;
        }
        if is_kept && !covering.ground.hierarchy.is_nearer(x + normal * r, r * (1.0 - TOUCHING)) {
            return Target::Stays;
        }
        if let State::Ridge(a, b) = &covering.state[v as usize]
            && let Some((p, a, b)) = covering.ridge(x, &a.grown(r), &b.grown(r))
            && ![a, b]
                .iter()
                .any(|rest| covering.ground.hierarchy.is_crossed(x + (rest.center - x) * 1e-6, rest.center))
        {
            return Target::Goes(p, State::Ridge(a, b));
        }
        let rolled = match covering.rest(v) {
            Some(rest) => covering.ground.rest(x, rest.grown(r).center, r, rest.contacts),
            None => covering.roll(x, normal),
        };
        let Some(rest) = rolled else { return Target::Lost };
        if is_kept {
            let around: Vec<f64> = covering.mesh.spokes(v).map(|h| covering.mesh.length(h)).collect();
            let mean = around.iter().sum::<f64>() / around.len().max(1) as f64;
            let dead = (SAGITTAS * mean * mean / (8.0 * r)).min(DEAD_BAND * covering.edge);
            if (rest.center - x).norm() - r <= dead {
                return Target::Stays;
            }
        }
        // The ball must lie on this side of the surface.
        let start = x + (rest.center - x) * 1e-6;
        if covering.ground.hierarchy.is_crossed(start, rest.center) {
            return Target::Lost;
        }
        Target::Goes(rest.point(), State::Moved(rest))
    }

    /// Cuts long edges of the input beside vertices that are to move; the new vertices.
    fn cut_coarse(
        &mut self,
        covering: &mut Covering,
        targets: &mut Vec<Option<Target>>,
        moving: &mut Vec<u32>,
    ) -> Vec<u32> {
        let goes = |targets: &[Option<Target>], v: u32| {
            matches!(targets.get(v as usize), Some(Some(Target::Goes(..) | Target::Lost)))
        };
        let mut edges: Vec<u32> = (0..covering.state.len() as u32)
            .filter(|&v| goes(targets, v))
            .flat_map(|v| covering.mesh.faces_at(v).collect::<Vec<_>>())
            .flat_map(|f| covering.mesh.half_edges(f))
            .map(|h| covering.mesh.twin(h).map_or(h, |t| h.min(t)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let on_input = |covering: &Covering, v: u32| covering.is_kept(v);
        let mut long: Vec<(f64, u32)> = edges
            .into_iter()
            .filter(|&h| on_input(covering, covering.mesh.origin(h)) && on_input(covering, covering.mesh.target(h)))
            .map(|h| (covering.mesh.length(h), h))
            .filter(|(length, _)| *length > remesh::LONGEST * covering.edge)
            .collect();
        long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut new = Vec::new();
        for (_, h) in long {
            let mesh = &covering.mesh;
            let middle = nalgebra::center(&covering.point(mesh.origin(h)), &covering.point(mesh.target(h)));
            let faces = [Some(h), mesh.twin(h)].into_iter().flatten().map(|x| mesh.area_vector(mesh.face_of(x)));
            let normal: Vector = faces.filter_map(|n| n.try_normalize(0.0)).sum();
            let w = covering.split(h, middle, State::Kept);
            self.normals.resize(covering.state.len(), Vector::zeros());
            self.normals[w as usize] = normal.try_normalize(0.0).unwrap_or_default();
            targets.push(None);
            moving.push(w);
            new.push(w);
        }
        new
    }

    /// Looks for a rest of vertices without one, from where their neighbours came to rest.
    fn find_lost(&self, covering: &mut Covering) {
        loop {
            let lost: Vec<u32> =
                (0..covering.state.len() as u32).filter(|&v| covering.state[v as usize] == State::Lost).collect();
            let found = parallel::map(&lost, self.threads, |&v| {
                let rests: Vec<(Vector, Vector)> = covering
                    .mesh
                    .neighbours(v)
                    .filter_map(|u| covering.rest(u).map(|rest| (covering.point(u).coords, rest.center.coords)))
                    .collect();
                let count = rests.len() as f64;
                let mean =
                    |of: fn(&(Vector, Vector)) -> Vector| Point::from(rests.iter().map(of).sum::<Vector>() / count);
                let (x, y) = (mean(|r| r.0), mean(|r| r.1));
                if rests.is_empty() {
                    return None;
                }
                let rest = covering.ground.rest(x, y, covering.radius(x), contact::UNTOUCHED)?;
                (!covering.ground.hierarchy.is_crossed(x, rest.center)).then_some(rest)
            });
            let mut any = false;
            for (v, rest) in lost.into_iter().zip(found) {
                if let Some(rest) = rest {
                    covering.mesh.points[v as usize] = rest.point();
                    covering.state[v as usize] = State::Moved(rest);
                    any = true;
                }
            }
            if !any {
                return;
            }
        }
    }
}
