//! The closing of surfaces, directly: a ball rolls on the input, and every vertex that it cannot touch goes to where the
//! ball comes to rest nearest to it.
//!
//! A vertex x moves if and only if no ball of radius r that is empty of the input touches it. The centre nearest to x of all that
//! the ball may have, y, is found by contact ([`contact`]); x' = y + r (x - y) / |x - y| is a point of the closing, and
//! (y - x') / r its normal there. As C_r(C_s(A)) = C_r(A) for s < r, the radius is reached in steps, with the triangles made good in
//! between ([`remesh`]); contacts are always with the input, so nothing adds up.

mod cells;
mod changes;
mod conflicts;
mod contact;
mod covering;
mod half_spaces;
mod hidden;
mod land;
mod memo;
mod mend;
mod remesh;
mod result;
mod retry;
mod reveal;
mod ridge;
mod roll;
mod roller;
mod unfold;
mod zip;

use changes::Changes;
pub use conflicts::{Conflict, Trouble};
use contact::Ground;
use covering::{Covering, Refusals, State};
pub use land::land_surface;
use retry::retry;
use roll::{Roll, stretches};
pub use roller::{Roller, Survey, Touch};

use crate::mesh::{NotManifold, Point, TriangleMesh};

/// The radius grows by this factor from level to level, beginning above so many edge lengths.
///
/// The nearest centre jumps where two families of balls are equally near, and what lies between is reached by splitting the
/// edges that it stretches: the more radii on the way, the less there is between.
const GROWTH: f64 = 1.5;
const FIRST_RADIUS: f64 = 1.0;

/// From level to level the radius grows by less where edges would be stretched, down to this factor.
const LEAST_GROWTH: f64 = 1.25;

/// Rounds of remeshing on the way, and in the end.
const ROUNDS: usize = 3;
const LAST_ROUNDS: usize = 5;

/// Tears of a level are mended so often.
const MENDINGS: usize = 3;

/// Where more than this part of the faces that moved is not the closing, a bold try would not help.
const HOPELESS: f64 = 0.5;

/// A bold try may make so many times the vertices there were.
const MOST_VERTICES: usize = 2;

/// What moved of a surface has crumpled where it has so many times the area that the whole surface and the box around it have: the
/// closing spans what it fills with less than it covers, and is nowhere wider than the hull.
const CRUMPLED: f64 = 1.25;

/// The radius grows by this much for every unit of distance from what is pinned.
const EASE: f64 = 1.0;

/// Balls that are nearer to the input than their radius by less than this part of it touch it.
const TOUCHING: f64 = 1e-8;

/// Whether a ball lies on the other side of the surface is asked from this part of the way to its centre on.
const BESIDE: f64 = 1e-6;

/// How a surface is closed.
pub struct SurfaceOptions<'a> {
    /// The radius of the ball at a place, in units of the surface. Nothing moves where it is 0 or below, or no number.
    pub radius: &'a (dyn Fn(Point) -> f64 + Sync),
    /// How far a place is from what is to stay as it is.
    pub pin_distance: &'a (dyn Fn(Point) -> f64 + Sync),
    /// The length of edges where the surface moves: above 0, and at most the radius, of which it should be a sixth or less.
    pub edge: f64,
    /// How many threads work; the result does not depend on it.
    pub threads: usize,
}

impl SurfaceOptions<'_> {
    /// The radius of the ball at a place: near what is pinned it gets smaller, down to nothing.
    fn ball(&self, p: Point) -> f64 {
        let radius = (self.radius)(p);
        if radius > 0.0 { radius.min(EASE * (self.pin_distance)(p)).max(0.0) } else { 0.0 }
    }
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
    /// The largest distance of the middle of an edge or a face from the closing, where it moved; 0 where nothing did.
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
    let ground = Ground::new(input)?;
    let field = |p: Point| options.ball(p);
    let careful = match cover(input, &ground, &field, options, None) {
        Ok(covering) => retry(covering),
        Err(crumpled) => return Ok(result::unmoved(input, crumpled)),
    };
    let moved = careful.0.active_faces().len() as f64;
    if careful.1.faces.is_empty() || careful.1.faces.len() as f64 > HOPELESS * moved {
        return Ok(result::result(input, &careful.0, careful.1));
    }
    let most = MOST_VERTICES * careful.0.state.len();
    let bold = cover(input, &ground, &field, options, Some(most)).ok().map(retry);
    let better = bold.filter(|bold| bold.1.faces.len() < careful.1.faces.len());
    let (covering, found) = better.unwrap_or(careful);
    Ok(result::result(input, &covering, found))
}

/// The surface moved to where the ball touches.
///
/// A bold try splits long edges even where faces turn their backs on the ball for a while, as long as there are not too many
/// vertices: what is folded then unfolds in the end, or is cut out. Careful ones get stuck where gaps with wide mouths are filled.
///
/// # Errors
/// Where the surface crumples, a place where it does: what lies on itself in ever more folds, as between bodies that touch, would
/// go on growing without ever becoming the closing.
fn cover<'a>(
    input: &TriangleMesh,
    ground: &'a Ground,
    field: &'a (dyn Fn(Point) -> f64 + Sync),
    options: &SurfaceOptions,
    bold: Option<usize>,
) -> Result<Covering<'a>, Point> {
    let most_area = CRUMPLED * roomy_area(input);
    let mut covering = Covering {
        ground,
        mesh: ground.mesh.clone(),
        state: vec![State::Kept; input.points.len()],
        touched: vec![false; input.faces.len()],
        parent: (0..input.faces.len() as u32).collect(),
        filled: std::collections::BTreeSet::new(),
        clear: Vec::new(),
        part: 1.0,
        field,
        edge: options.edge,
        threads: options.threads,
        bold,
        changes: Changes::default(),
        refusals: Refusals::default(),
    };
    let mut roll = Roll { normals: input.vertex_normals() };
    // What the whole ball can touch, smaller ones can.
    let mut moving: Vec<u32> = roll.untouched(&covering, (0..input.points.len() as u32).collect());
    roll.reveal(&mut covering, &mut moving);
    let radii = input.points.iter().map(|p| field(*p)).fold(0.0, f64::max) / options.edge;
    let mut part = (FIRST_RADIUS / radii).min(1.0);
    let mut done = 0.0;
    loop {
        covering.part = part;
        let mut targets = roll.targets(&mut covering, &mut moving);
        while part > done * LEAST_GROWTH && done > 0.0 && stretches(&covering, &targets) {
            part = done * (part / done).sqrt();
            covering.part = part;
            targets = roll.targets(&mut covering, &mut moving);
        }
        roll.advance(&mut covering, targets);
        covering.mend_jumps();
        covering.remesh(if part >= 1.0 { LAST_ROUNDS } else { ROUNDS });
        for _ in 0..MENDINGS {
            if let Some(place) = covering.crumpled(most_area) {
                return Err(place);
            }
            if !covering.mend() {
                break;
            }
            covering.remesh(ROUNDS);
        }
        if part >= 1.0 {
            break;
        }
        (done, part) = (part, (part * GROWTH).min(1.0));
        // The last step is not to be a small one.
        if part * GROWTH.sqrt() > 1.0 {
            part = 1.0;
        }
    }
    covering.bold = None;
    match covering.crumpled(most_area) {
        Some(place) => Err(place),
        None => Ok(covering),
    }
}

/// The area of a surface, or of the box around it where that is larger.
fn roomy_area(mesh: &TriangleMesh) -> f64 {
    let [a, b, c] = mesh.bounds().map_or([0.0; 3], |[low, high]| (high - low).into());
    mesh.area().max(2.0 * (a * b + b * c + c * a))
}
