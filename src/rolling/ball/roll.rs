//! One level: where every vertex goes with a ball of some radius, and the surface moved there.

use super::contact;
use super::covering::{Covering, State};
use super::hidden::DEAD_BAND;
use super::{BESIDE, TOUCHING};
use crate::mesh::{Point, Vector};
use crate::threads;

/// An edge that gets longer than so many times its length, or so many edge lengths, is stretched: what lies between its ends
/// may be lost.
const STRETCHED: f64 = 2.5;

/// Coarse faces near what moves are cut so often at most.
const CUTS: usize = 8;

/// A vertex that would move by less than this many sagittas of its edges, or within [`DEAD_BAND`], stays.
const SAGITTAS: f64 = 2.0;

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
        let is_untouched = threads::map(&among, covering.threads, |&v| {
            let (x, normal) = (covering.point(v), self.normals[v as usize]);
            let r = covering.radius(x);
            !covering.mesh.is_boundary(v)
                && covering.mesh.has_vertex(v)
                && covering.ground.hierarchy.is_nearer(x + normal * r, r * (1.0 - TOUCHING))
        });
        among.into_iter().zip(is_untouched).filter(|(_, is)| *is).map(|(v, _)| v).collect()
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
            let found = threads::map(&open, covering.threads, |&v| self.target(covering, v));
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
        covering.changes.mark_all();
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
        let start = x + (rest.center - x) * BESIDE;
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
        let goes = |v: u32| matches!(targets.get(v as usize), Some(Some(Target::Goes(..) | Target::Lost)));
        let all: Vec<u32> = (0..covering.state.len() as u32).filter(|&v| goes(v)).collect();
        let new = self.cut_long(covering, &all, |_| true);
        targets.resize(covering.state.len(), None);
        moving.extend(&new);
        new
    }

    /// Looks for a rest of vertices without one, from where their neighbours came to rest.
    fn find_lost(&self, covering: &mut Covering) {
        loop {
            let lost: Vec<u32> =
                (0..covering.state.len() as u32).filter(|&v| covering.state[v as usize] == State::Lost).collect();
            let found = threads::map(&lost, covering.threads, |&v| {
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
