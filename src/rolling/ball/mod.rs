//! The closing of surfaces, directly: a ball rolls on the input, and every vertex that it cannot touch goes to where the
//! ball comes to rest nearest to it.
//!
//! A vertex x moves if and only if no ball of radius r that is empty of the input touches it. The centre nearest to x of all that
//! the ball may have, y, is found by contact ([`contact`]); x' = y + r (x - y) / |x - y| is a point of the closing, and
//! (y - x') / r its normal there. As C_r(C_s(A)) = C_r(A) for s < r, the radius is reached in steps, with the triangles made good in
//! between ([`remesh`]); contacts are always with the input, so nothing adds up.

mod conflicts;
mod contact;
mod covering;
mod half_spaces;
mod parallel;
mod remesh;
mod result;
mod roller;

pub use conflicts::{Conflict, Trouble};
use contact::{Ground, Rest};
use covering::{Covering, State};
pub use roller::{Roller, Survey, Touch};

use crate::mesh::{HalfEdgeMesh, Hierarchy, NotManifold, Point, TriangleMesh, Vector};

/// The radius grows by this factor from level to level, beginning above so many edge lengths.
///
/// The nearest centre jumps where two families of balls are equally near, and what lies between is reached by splitting the
/// edges that it stretches: the more radii on the way, the less there is between.
const GROWTH: f64 = 1.5;
const FIRST_RADIUS: f64 = 1.0;

/// Balls that are nearer to the input than their radius by less than this part of it touch it.
const TOUCHING: f64 = 1e-8;

/// Rounds of remeshing on the way, and in the end.
const ROUNDS: usize = 3;
const LAST_ROUNDS: usize = 5;

/// Coarse faces near what moves are cut so often at most.
const CUTS: usize = 8;

/// So often it is tried again, with smaller balls around what could not be done.
const ATTEMPTS: usize = 3;

/// Around a conflict nothing moves within this part of the radius, twice and thrice as far where that is not enough; from there
/// the radius grows by this much for every unit of distance, as it does from what is pinned.
const CLEARANCE: f64 = 0.25;
const EASE: f64 = 1.0;

/// A vertex that would move by less than this many sagittas of its edges stays, and by less than so many edge lengths: the
/// samples of a surface that the ball fits are on it, not their chords.
const SAGITTAS: f64 = 2.0;
const DEAD_BAND: f64 = 0.05;

/// How a surface is closed.
pub struct SurfaceOptions<'a> {
    /// The radius of the ball at a place.
    pub radius: &'a (dyn Fn(Point) -> f64 + Sync),
    /// How far a place is from what is to stay as it is.
    pub pin_distance: &'a (dyn Fn(Point) -> f64 + Sync),
    /// The length of edges where the surface moves.
    pub edge: f64,
    /// How many threads work; the result does not depend on it.
    pub threads: usize,
}

/// A closed surface.
#[derive(Clone, Debug, Default)]
pub struct ClosedSurface {
    /// Vertices: those of the input first, in its order, as far as they are left.
    pub points: Vec<Point>,
    /// The vertex of the input that each of them is, bit for bit; [`NONE`](crate::mesh::NONE) for those that moved or are new.
    pub origins: Vec<u32>,
    /// Faces, those of the input first, in its order, as far as they are left.
    pub faces: Vec<[u32; 3]>,
    /// The face of the input that each of them is; [`NONE`](crate::mesh::NONE) for those that changed.
    pub parents: Vec<u32>,
    /// What could not be done.
    pub conflicts: Vec<Conflict>,
    /// The largest distance of the middle of an edge or a face from the closing, where it moved.
    pub error: f64,
}

/// Closes a surface with a ball.
///
/// Where the radius varies, every vertex is closed by the ball of its place. Near what is pinned the radius is at most the
/// distance from it, so that the surface joins smoothly what stays.
///
/// # Errors
/// Where the faces form no surface.
pub fn close_surface(input: &TriangleMesh, options: &SurfaceOptions) -> Result<ClosedSurface, NotManifold> {
    let mesh = HalfEdgeMesh::new(input.points.clone(), &input.faces)?;
    let hierarchy = Hierarchy::new(&input.points, &input.faces);
    let ground = Ground { mesh: &mesh, hierarchy: &hierarchy };
    let mut conflicts: Vec<Conflict> = Vec::new();
    let mut stays: Vec<Point> = Vec::new();
    for attempt in 0..=ATTEMPTS {
        // Around what could not be done the ball gets smaller, down to nothing.
        let corners: Vec<[u32; 3]> = (0..stays.len() as u32).map(|k| [k; 3]).collect();
        let avoided = Hierarchy::new(&stays, &corners);
        let clearance = CLEARANCE * attempt as f64;
        let field = |p: Point| {
            let r = (options.radius)(p);
            let pinned = (options.pin_distance)(p);
            let near = avoided.nearest(p, (1.0 / EASE + clearance) * r).map_or(f64::INFINITY, |n| n.distance);
            r.min(EASE * pinned.min(near - clearance * r)).max(0.0)
        };
        let covering = cover(input, &ground, &field, options);
        let found = conflicts::find(&covering, options.threads);
        let is_last = attempt == ATTEMPTS || found.faces.is_empty();
        if !is_last {
            for f in &found.faces {
                for v in covering.mesh.face(*f) {
                    stays.push(covering.point(v));
                    stays.extend(mesh.points.get(v as usize));
                }
            }
        }
        conflicts.extend(found.conflicts);
        if is_last {
            return Ok(result::result(input, &covering, &found.faces, conflicts, found.error));
        }
    }
    unreachable!("the last attempt returns")
}

/// The surface moved to where the ball touches.
fn cover<'a>(
    input: &TriangleMesh,
    ground: &'a Ground<'a>,
    field: &'a (dyn Fn(Point) -> f64 + Sync),
    options: &SurfaceOptions,
) -> Covering<'a> {
    let mut covering = Covering {
        ground,
        mesh: ground.mesh.clone(),
        state: vec![State::Kept; input.points.len()],
        touched: vec![false; input.faces.len()],
        parent: (0..input.faces.len() as u32).collect(),
        part: 1.0,
        field,
        edge: options.edge,
    };
    let mut roll = Roll { normals: input.vertex_normals(), threads: options.threads };
    // What the whole ball can touch, smaller ones can.
    let mut moving: Vec<u32> = roll.untouched(&covering, (0..input.points.len() as u32).collect());
    roll.cut_edges_between(&mut covering, &mut moving);
    let radii = input.points.iter().map(|p| field(*p)).fold(0.0, f64::max) / options.edge;
    let levels = ((radii / FIRST_RADIUS).ln() / GROWTH.ln()).floor().max(0.0) as i32;
    for level in (0..=levels).rev() {
        covering.part = GROWTH.powi(-level);
        roll.advance(&mut covering, &mut moving);
        covering.remesh(if level == 0 { LAST_ROUNDS } else { ROUNDS });
    }
    covering
}

/// What goes on from level to level.
struct Roll {
    /// Directions in which to look for a ball first.
    normals: Vec<Vector>,
    threads: usize,
}

/// Where a vertex is to go.
#[derive(Clone, Copy, Debug)]
enum Target {
    Stays,
    Lost,
    Goes(Point, Rest),
}

impl Roll {
    /// The vertices of `among` that the ball does not touch along their normals.
    fn untouched(&self, covering: &Covering, among: Vec<u32>) -> Vec<u32> {
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
    fn cut_edges_between(&mut self, covering: &mut Covering, moving: &mut Vec<u32>) {
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

    /// Moves the surface to where a ball of the covering's radius touches.
    fn advance(&mut self, covering: &mut Covering, moving: &mut Vec<u32>) {
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
        for (v, target) in targets.into_iter().enumerate() {
            match target {
                None | Some(Target::Stays) => {}
                Some(Target::Lost) => covering.state[v] = State::Lost,
                Some(Target::Goes(p, rest)) => {
                    covering.mesh.points[v] = p;
                    covering.state[v] = State::Moved(rest);
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
        let Some(rest) = covering.roll(x, normal) else { return Target::Lost };
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
        Target::Goes(rest.point(), rest)
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
