//! Where the ball comes to rest: the centre nearest to a point of the surface.
//!
//! The centres that the ball may have are the points no nearer to the input than its radius. The one nearest to x is found with
//! a working set of triangles: each keeps the centre out of a half-space, the nearest point of all half-spaces is the next
//! guess, and what is too near to that joins the set.

use super::cells::Cells;
use super::half_spaces::{HalfSpace, nearest};
use super::memo::Memo;
use crate::mesh::{
    Feature, HalfEdgeMesh, Hierarchy, NONE, Nearest, NotManifold, Point, TriangleMesh, Vector, nearest_on_triangle,
};

/// Contacts within this part of the radius are as near as the radius.
const TOUCHING: f64 = 2e-9;

/// Half-spaces are met to this part of the radius, or, where none is, as well as this allows.
const MET: f64 = 1e-10;
const NEARLY_MET: f64 = 1e-4;

/// A step shorter than this part of the radius ends the search: the centre has settled along the offset surface, and its
/// contacts are right to second order.
const SETTLED: f64 = 1e-3;

/// After so many steps any free centre is good: with its contacts it gives a point of the closing, if not the nearest one.
/// Nearly parallel contacts settle slowly.
const PATIENCE: usize = 10;

/// No step is longer than this part of the radius: half-spaces speak of what is near.
const LONGEST_STEP: f64 = 0.7;

/// Steps to the resting place; nearly all take fewer than ten.
const STEPS: usize = 60;

/// Triangles in the working set.
const WORKING_SET: usize = 14;

/// Triangles that hold nothing and are farther away than the radius by this part of it are let go.
const SLACK: f64 = 0.1;

/// So many balls at rest are remembered for each face of the input, and so many at most.
const RESTS_PER_FACE: usize = 4;
const MOST_RESTS: usize = 1 << 17;

/// After a step shorter than this part of the radius the ball is where others come to rest, too.
const FAR: f64 = 0.3;

/// The input that the ball rolls on.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    pub mesh: HalfEdgeMesh,
    pub hierarchy: Hierarchy,
    /// Balls that came to rest.
    rests: Memo<Question, Option<Rest>>,
    cells: Cells,
    /// The unit normals of the faces.
    face_normals: Vec<Vector>,
    /// The pseudo-normals of the vertices.
    vertex_normals: Vec<Vector>,
}

/// A ball at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rest {
    /// Its centre and radius.
    pub center: Point,
    pub radius: f64,
    /// The unit vector from the surface towards the centre: the normal of the result.
    pub normal: Vector,
    /// Triangles that hold it; [`NONE`] where fewer do.
    pub contacts: [u32; 3],
}

/// All that decides where a ball comes to rest, bit for bit: the point, the start and the radius, and the guess.
type Question = ([u64; 7], [u32; 3]);

/// No contacts.
pub(super) const UNTOUCHED: [u32; 3] = [NONE; 3];

impl Rest {
    /// The ball of another radius that touches the same point.
    pub fn grown(&self, radius: f64) -> Rest {
        Rest { center: self.center + self.normal * (radius - self.radius), radius, ..*self }
    }

    /// The point of the result that it touches.
    pub fn point(&self) -> Point {
        self.center - self.normal * self.radius
    }
}

impl Ground {
    /// Arranges a surface for a ball to roll on.
    ///
    /// # Errors
    /// Where the faces form no surface.
    pub fn new(surface: &TriangleMesh) -> Result<Ground, NotManifold> {
        let mesh = HalfEdgeMesh::new(surface.points.clone(), &surface.faces)?;
        let hierarchy = Hierarchy::new(&surface.points, &surface.faces);
        let unit = |f: u32| mesh.area_vector(f).try_normalize(0.0).unwrap_or_default();
        let face_normals: Vec<Vector> = (0..mesh.face_count() as u32).map(unit).collect();
        let at = |v: u32| {
            let p = mesh.points[v as usize];
            let spokes = mesh.spokes(v).map(|h| {
                let (u, w) = (mesh.target(h), mesh.opposite(h));
                let (u, w) = (mesh.points[u as usize] - p, mesh.points[w as usize] - p);
                face_normals[mesh.face_of(h) as usize] * u.cross(&w).norm().atan2(u.dot(&w))
            });
            spokes.sum()
        };
        let vertex_normals = (0..mesh.points.len() as u32).map(at).collect();
        let rests = Memo::new((RESTS_PER_FACE * mesh.face_count()).min(MOST_RESTS));
        Ok(Ground { mesh, hierarchy, rests, cells: Cells::new(), face_normals, vertex_normals })
    }

    /// The outward direction at a point of the surface that is nearest to some other: of a face, an edge or a vertex. Its
    /// sign against the direction to that other point tells inside from outside (Bærentzen and Aanæs, 2005).
    pub fn pseudo_normal(&self, face: u32, feature: Feature) -> Vector {
        let unit = |f: u32| self.face_normals[f as usize];
        match feature {
            Feature::Face => unit(face),
            Feature::Edge(k) => {
                let h = 3 * face + u32::from(k);
                unit(face) + self.mesh.twin(h).map_or(Vector::zeros(), |t| unit(self.mesh.face_of(t)))
            }
            Feature::Corner(k) => self.vertex_normals[self.mesh.face(face)[usize::from(k)] as usize],
        }
    }

    /// Whether `p` lies inside, `hit` being the point of the surface nearest to it.
    pub fn is_inside(&self, p: Point, hit: &Nearest) -> bool {
        (p - hit.point).dot(&self.pseudo_normal(hit.face, hit.feature)) < 0.0
    }

    /// How deep `p` lies inside, 0 where it is outside or deeper than `within`.
    pub fn depth(&self, p: Point, within: f64) -> f64 {
        match self.hierarchy.nearest(p, within) {
            Some(hit) if self.is_inside(p, &hit) => hit.distance,
            _ => 0.0,
        }
    }

    /// The half-space that triangle `face` keeps the centre of a ball of radius `r` near `y` out of.
    fn half_space(&self, face: u32, y: Point, r: f64) -> HalfSpace {
        let (p, feature) = nearest_on_triangle(y, self.mesh.triangle(face));
        let outward = self.pseudo_normal(face, feature);
        let normal = match (y - p).try_normalize(1e-14 * r) {
            Some(n) if n.dot(&outward) < 0.0 => -n,
            Some(n) => n,
            None => outward.try_normalize(0.0).unwrap_or_default(),
        };
        HalfSpace { normal, offset: normal.dot(&p.coords) + r }
    }

    /// Rolls a ball of radius `r` from `start` to the centre nearest to `x`; a guess of what it will touch makes it faster.
    /// `None` where it finds no rest.
    pub fn rest(&self, x: Point, start: Point, r: f64, guess: [u32; 3]) -> Option<Rest> {
        let question = ([x.x, x.y, x.z, start.x, start.y, start.z, r].map(f64::to_bits), guess);
        self.rests.get_or(question, || self.roll(x, start, r, guess))
    }

    /// The point of the surface nearest to `y` if it is nearer than `within`, where the ball has come by a step of so long.
    fn nearest(&self, y: Point, within: f64, step: f64) -> Option<Nearest> {
        if step > FAR * within {
            return self.hierarchy.nearest(y, within);
        }
        self.cells.nearest(&self.hierarchy, y, within)
    }

    fn roll(&self, x: Point, start: Point, r: f64, guess: [u32; 3]) -> Option<Rest> {
        let mut y = start;
        let mut set: Vec<u32> = guess.into_iter().filter(|&t| t != NONE).collect();
        let mut spaces: Vec<HalfSpace> = Vec::with_capacity(WORKING_SET);
        let mut held = None;
        let mut step = f64::INFINITY;
        for round in 0..STEPS {
            if round > 0 || set.is_empty() {
                match self.nearest(y, r * (1.0 - TOUCHING), step) {
                    Some(hit) if !set.contains(&hit.face) => {
                        if set.len() == WORKING_SET {
                            self.drop_slackest(&mut set, &held, y, r);
                        }
                        set.push(hit.face);
                    }
                    Some(hit) if step < 1e-9 * r => {
                        return (hit.distance > r * (1.0 - 1e-6)).then(|| at_rest(x, y, r, held)).flatten();
                    }
                    Some(_) => {}
                    None if !set.is_empty() && (step < SETTLED * r || round > PATIENCE) => {
                        return at_rest(x, y, r, held);
                    }
                    None if set.is_empty() => set.push(self.hierarchy.nearest(y, 2.0 * r)?.face),
                    None => {}
                }
            }
            spaces.clear();
            spaces.extend(set.iter().map(|&t| self.half_space(t, y, r)));
            let next = nearest(x, &spaces, MET * r, NEARLY_MET * r)?;
            let by =
                next.by.map(|(k, multiplier)| (set[k.min(set.len() - 1)], multiplier, spaces[k.min(spaces.len() - 1)]));
            held = Some((by, next.count));
            let motion = next.point - y;
            step = motion.norm();
            y = if step > LONGEST_STEP * r { y + motion * (LONGEST_STEP * r / step) } else { next.point };
            let holds = |t: u32| by[..next.count].iter().any(|b| b.0 == t);
            let mut k = 0;
            set.retain(|&t| {
                let s = &spaces[k];
                k += 1;
                holds(t) || s.normal.dot(&y.coords) - s.offset <= SLACK * r
            });
        }
        None
    }

    fn drop_slackest(&self, set: &mut Vec<u32>, held: &Option<Hold>, y: Point, r: f64) {
        let holds = |t: u32| held.as_ref().is_some_and(|(by, count)| by[..*count].iter().any(|b| b.0 == t));
        let slack = |t: u32| {
            let s = self.half_space(t, y, r);
            s.normal.dot(&y.coords) - s.offset
        };
        let free = (0..set.len()).filter(|&k| !holds(set[k]));
        if let Some(k) = free.max_by(|&a, &b| slack(set[a]).total_cmp(&slack(set[b]))) {
            set.swap_remove(k);
        }
    }
}

/// What holds a ball: triangles, multipliers and half-spaces.
type Hold = ([(u32, f64, HalfSpace); 3], usize);

/// The ball at `y`, with what holds it: the direction to the surface is that of the forces of its contacts.
fn at_rest(x: Point, y: Point, radius: f64, held: Option<Hold>) -> Option<Rest> {
    let (by, count) = held?;
    let force: Vector = by[..count].iter().map(|(_, multiplier, s)| s.normal * *multiplier).sum();
    let normal = force.try_normalize(0.0).or_else(|| (y - x).try_normalize(0.0))?;
    let mut contacts = UNTOUCHED;
    for (contact, b) in contacts.iter_mut().zip(&by[..count]) {
        *contact = b.0;
    }
    (count > 0).then_some(Rest { center: y, radius, normal, contacts })
}
