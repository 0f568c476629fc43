//! A surface that some other road has brought near its closing, brought onto it.

use std::collections::BTreeSet;

use super::changes::Changes;
use super::conflicts::{self, Trouble};
use super::contact::Ground;
use super::covering::{Covering, Refusals, State};
use super::{BESIDE, ClosedSurface, SurfaceOptions};
use crate::mesh::{HalfEdgeMesh, NONE, NotManifold, Point, TriangleMesh, Vector};
use crate::threads;

/// A vertex lands where the ball touches if that is no farther than so many edge lengths.
const NEAR: f64 = 2.0;

/// Rounds of remeshing on the closing.
const ROUNDS: usize = 5;

/// Where the surface would pass through itself, what is nearer than so many edge lengths stays as it came; twice as far with each try.
const AROUND: f64 = 2.0;

/// So many tries.
const TRIES: usize = 5;

/// Brings what moved of a surface near the closing of `input` onto it: vertices go where the ball touches, edges along ridges. Where
/// that would make it pass through itself or dip into the input, it stays as it came.
///
/// # Errors
/// Where the faces form no surface.
pub fn land_surface(
    input: &TriangleMesh,
    near: &ClosedSurface,
    options: &SurfaceOptions,
) -> Result<ClosedSurface, NotManifold> {
    let ground = Ground::new(input)?;
    let field = |p: Point| options.ball(p);
    let start = start(&ground, &field, near, options)?;
    let mut frozen: BTreeSet<u32> = BTreeSet::new();
    for k in 0..TRIES {
        let mut covering = start.clone();
        for &v in &frozen {
            covering.state[v as usize] = State::Kept;
        }
        for v in 0..covering.state.len() as u32 {
            if let State::Moved(rest) = covering.state[v as usize] {
                covering.mesh.points[v as usize] = rest.point();
                for f in covering.mesh.faces_at(v).collect::<Vec<_>>() {
                    covering.touch(f);
                }
            }
        }
        covering.remesh(ROUNDS);
        let found = conflicts::find(&covering);
        let bad: Vec<Point> = found
            .conflicts
            .iter()
            .filter(|c| matches!(c.trouble, Trouble::Fold | Trouble::Dip))
            .map(|c| c.place)
            .collect();
        if bad.is_empty() {
            return Ok(landed(&covering, near));
        }
        let around = AROUND * f64::from(1u32 << k) * options.edge;
        let before = frozen.len();
        for (v, p) in (0u32..).zip(&near.points) {
            if start.state[v as usize] != State::Kept && bad.iter().any(|q| (p - q).norm() < around) {
                frozen.insert(v);
            }
        }
        if frozen.len() == before {
            break;
        }
    }
    Ok(near.clone())
}

/// The surface as it came, with the balls that its vertices are to land on.
fn start<'a>(
    ground: &'a Ground,
    field: &'a (dyn Fn(Point) -> f64 + Sync),
    near: &ClosedSurface,
    options: &SurfaceOptions,
) -> Result<Covering<'a>, NotManifold> {
    let surface = TriangleMesh::new(near.points.clone(), near.faces.clone());
    let normals: Vec<Vector> = surface.vertex_normals();
    let mut covering = Covering {
        ground,
        mesh: HalfEdgeMesh::new(surface.points, &surface.faces)?,
        state: vec![State::Kept; near.points.len()],
        touched: near.parents.iter().map(|parent| *parent == NONE).collect(),
        parent: (0..near.faces.len() as u32).collect(),
        filled: BTreeSet::new(),
        clear: Vec::new(),
        part: 1.0,
        field,
        edge: options.edge,
        threads: options.threads,
        bold: None,
        changes: Changes::default(),
        refusals: Refusals::default(),
    };
    let moved: Vec<u32> = (0u32..).zip(&near.origins).filter(|(_, origin)| **origin == NONE).map(|(v, _)| v).collect();
    let rests = threads::map(&moved, options.threads, |&v| {
        let x = covering.point(v);
        if covering.mesh.is_boundary(v) || covering.radius(x) <= 0.0 {
            return None;
        }
        let rest = covering.roll(x, normals[v as usize])?;
        let is_near = (rest.point() - x).norm() < NEAR * options.edge && rest.normal.dot(&normals[v as usize]) > 0.0;
        (is_near && !ground.hierarchy.is_crossed(rest.point() + rest.normal * (BESIDE * rest.radius), rest.center))
            .then_some(rest)
    });
    for (v, rest) in moved.into_iter().zip(rests) {
        if let Some(rest) = rest {
            covering.state[v as usize] = State::Moved(rest);
        }
    }
    Ok(covering)
}

/// What came out: what had not moved, as it was.
fn landed(covering: &Covering, near: &ClosedSurface) -> ClosedSurface {
    let (mut faces, mut parents) = (Vec::new(), Vec::new());
    let mut is_used = vec![false; covering.state.len()];
    let mut was_used = vec![false; near.points.len()];
    near.faces.iter().flatten().for_each(|&v| was_used[v as usize] = true);
    for f in covering.mesh.faces() {
        let face = covering.mesh.face(f);
        face.iter().for_each(|&v| is_used[v as usize] = true);
        faces.push(face);
        let stays = (f as usize) < near.faces.len() && !covering.touched[f as usize];
        parents.push(if stays { near.parents[f as usize] } else { NONE });
    }
    let mut closed = ClosedSurface { parents, ..ClosedSurface::default() };
    let mut number = vec![NONE; is_used.len()];
    for v in 0..is_used.len() {
        // What no face ever used stays, too.
        if !is_used[v] && was_used.get(v).is_none_or(|was| *was) {
            continue;
        }
        number[v] = closed.points.len() as u32;
        closed.points.push(covering.mesh.points[v]);
        closed.origins.push(near.origins.get(v).copied().unwrap_or(NONE));
    }
    closed.faces = faces.into_iter().map(|f| f.map(|v| number[v as usize])).collect();
    closed
}
