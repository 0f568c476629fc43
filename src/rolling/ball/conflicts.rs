//! What is not the closing: tears, folds, and what dips into the input.

use std::collections::BTreeMap;

use super::covering::{Covering, State, area_vector};
use super::remesh::LONGEST;
use crate::mesh::{Hierarchy, Point, cross};
use crate::threads;

/// The middle of an edge or a face may be this far from the closing, in edge lengths, where the surface is whole.
const TORN: f64 = 1.0;

/// What is this near, in edge lengths, need not be looked at from other balls.
const CLOSE: f64 = 0.1;

/// A face whose normal is farther from that of a ball at its corner than this cosine tells is folded.
const FOLDED: f64 = -0.2;

/// In the result, where the balls at the corners of a face agree with each other, the face agrees with them by this cosine at
/// least: otherwise it stands on the surface as a thorn does.
const STANDING: f64 = 0.1;

/// Balls whose normals agree by more than this cosine lie on the same side of a face.
const ALIKE: f64 = 0.5;

/// Faces may dip into the input by so many edge lengths.
const DIP: f64 = 0.05;

/// What is wrong in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Trouble {
    /// Neighbours go to different sides of what the ball cannot reach: the surface would tear.
    Tear,
    /// The surface would lie on itself.
    Fold,
    /// The ball finds no rest.
    Lost,
    /// The surface would cut into the input.
    Dip,
    /// Something between the corners of a coarse face should move, and did not.
    Missed,
}

/// A place where the closing could not be had directly. What is around it was left as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conflict {
    /// Where.
    pub place: Point,
    /// What.
    pub trouble: Trouble,
}

/// Faces that are not the closing.
pub(super) struct Found {
    pub faces: Vec<u32>,
    pub conflicts: Vec<Conflict>,
    /// How far the others are from the closing in their middles.
    pub errors: Vec<(u32, f64)>,
}

/// Looks at all faces that moved.
pub(super) fn find(covering: &Covering) -> Found {
    find_since(covering, None)
}

/// The same where the surface has been looked at before: what is as it was and was good still is.
pub(super) fn find_since(covering: &Covering, before: Option<(&Covering, &Found)>) -> Found {
    let is_good = known_good(covering, before);
    let active: Vec<u32> = covering.active_faces().into_iter().filter(|&f| !is_good[f as usize]).collect();
    let mut found = among(covering, &active);
    found.errors.extend(before.into_iter().flat_map(|(_, b)| &b.errors).filter(|(f, _)| is_good[*f as usize]));
    // A blunt end of a thin sheet turns its back on the balls of both sides, and is none of this. What is folded passes through
    // something, or turns its back on balls that agree with each other.
    let numbers: Vec<u32> = covering.mesh.faces().collect();
    let faces: Vec<[u32; 3]> = numbers.iter().map(|&f| covering.mesh.face(f)).collect();
    let hierarchy = Hierarchy::new(&covering.mesh.points, &faces);
    let changed: Vec<u32> =
        numbers.iter().copied().filter(|&f| covering.is_touched(f) && !is_good[f as usize]).collect();
    let crossed = threads::map(&changed, covering.threads, |&f| {
        let [a, b, c] = covering.mesh.triangle(f);
        let mut crossed = Vec::new();
        let agreement = covering.agreement(covering.mesh.face(f), &area_vector([a, b, c]));
        if agreement < STANDING && balls_agree(covering, f) {
            crossed.push(f);
        }
        hierarchy.any_in_box(a.inf(&b).inf(&c), a.sup(&b).sup(&c), |k| {
            let g = numbers[k as usize];
            let crosses = f != g && cross([a, b, c], covering.mesh.triangle(g));
            if crosses {
                // What has not changed is not looked at from its own side.
                crossed.extend([f, g].into_iter().filter(|&f| covering.is_touched(f)));
            }
            crosses
        });
        crossed
    });
    let mut bad: BTreeMap<u32, Conflict> = found.faces.into_iter().zip(found.conflicts).collect();
    for f in crossed.into_iter().flatten() {
        bad.entry(f).or_insert(Conflict { place: middle(covering.mesh.triangle(f)), trouble: Trouble::Fold });
    }
    let may_miss = |f: u32| covering.is_coarse(f) && !bad.contains_key(&f) && !is_good[f as usize];
    let coarse: Vec<u32> = numbers.into_iter().filter(|&f| may_miss(f)).collect();
    let missed = threads::map(&coarse, covering.threads, |&f| {
        let is_kept = covering.mesh.face(f).iter().all(|&v| covering.is_kept(v));
        let stays = is_kept && !covering.filled.contains(&f) && !covering.is_clear(f);
        let radius = |p| covering.radius(p);
        let look = || covering.ground.hidden_between(covering.mesh.triangle(f), &radius, covering.edge);
        if stays { look() } else { None }
    });
    for (f, place) in coarse.into_iter().zip(missed) {
        if let Some(place) = place {
            bad.insert(f, Conflict { place, trouble: Trouble::Missed });
        }
    }
    found.errors.retain(|(f, _)| !bad.contains_key(f));
    (found.faces, found.conflicts) = bad.into_iter().unzip();
    found
}

/// The faces that are as they were when they were good.
fn known_good(covering: &Covering, before: Option<(&Covering, &Found)>) -> Vec<bool> {
    let mut is_good = vec![false; covering.mesh.face_count()];
    let Some((earlier, found)) = before else { return is_good };
    let same = |v: u32| {
        let same = |state: Option<&State>| state == Some(&covering.state[v as usize]);
        same(earlier.state.get(v as usize)) && earlier.point(v) == covering.point(v)
    };
    for f in earlier.mesh.faces().filter(|&f| covering.mesh.has_face(f)) {
        is_good[f as usize] =
            earlier.mesh.face(f) == covering.mesh.face(f) && covering.mesh.face(f).into_iter().all(same);
    }
    found.faces.iter().for_each(|&f| is_good[f as usize] = false);
    is_good
}

/// Looks at some faces.
pub(super) fn among(covering: &Covering, faces: &[u32]) -> Found {
    let looked = threads::map(faces, covering.threads, |&f| look(covering, f));
    let mut found = Found { faces: Vec::new(), conflicts: Vec::new(), errors: Vec::new() };
    for (&f, seen) in faces.iter().zip(looked) {
        match seen {
            Ok(error) => found.errors.push((f, error)),
            Err(trouble) => {
                found.faces.push(f);
                found.conflicts.push(Conflict { place: middle(covering.mesh.triangle(f)), trouble });
            }
        }
    }
    found
}

/// The middle of a triangle.
fn middle([a, b, c]: [Point; 3]) -> Point {
    Point::from((a.coords + b.coords + c.coords) / 3.0)
}

/// Whether a face turns its back on a ball that touches one of its corners.
pub(super) fn is_folded(covering: &Covering, f: u32) -> bool {
    covering.agreement(covering.mesh.face(f), &area_vector(covering.mesh.triangle(f))) < FOLDED
}

/// Whether the balls that touch the corners of a face lie on the same side of it.
fn balls_agree(covering: &Covering, f: u32) -> bool {
    let rests: Vec<_> = covering.mesh.face(f).into_iter().flat_map(|v| covering.rests(v)).collect();
    rests.len() > 1 && rests.iter().all(|a| rests.iter().all(|b| a.normal.dot(&b.normal) > ALIKE))
}

/// How far the middle of a face and those of its long edges are from the closing.
fn look(covering: &Covering, f: u32) -> Result<f64, Trouble> {
    let corners = covering.mesh.face(f);
    if corners.iter().any(|&v| covering.state[v as usize] == State::Lost) {
        return Err(Trouble::Lost);
    }
    let triangle = covering.mesh.triangle(f);
    let center = middle(triangle);
    if covering.ground.depth(center, covering.edge) > DIP * covering.edge {
        return Err(Trouble::Dip);
    }
    // Balls at the corners may be those of different sides: the nearest that one of them rolls to counts, or one from above.
    let normal = area_vector(triangle).try_normalize(0.0);
    let rests: Vec<_> = corners.iter().filter_map(|&v| covering.rest(v)).collect();
    if rests.is_empty() && !covering.filled.contains(&f) {
        return Ok(0.0);
    }
    let long = covering.mesh.half_edges(f).into_iter().filter(|&h| covering.mesh.length(h) > LONGEST * covering.edge);
    let middles = long
        .map(|h| nalgebra::center(&covering.point(covering.mesh.origin(h)), &covering.point(covering.mesh.target(h))));
    let mut largest: f64 = 0.0;
    for p in std::iter::once(center).chain(middles) {
        let r = covering.radius(p);
        let mut least = f64::INFINITY;
        let guesses = rests.iter().map(|rest| (rest.center, rest.contacts));
        let above = normal.map(|normal| (p + normal * r, super::contact::UNTOUCHED));
        for (start, contacts) in guesses.chain(above) {
            if let Some(found) = covering.ground.rest(p, start, r, contacts) {
                least = least.min((found.point() - p).norm());
            }
            if least <= CLOSE * covering.edge {
                break;
            }
        }
        if r > 0.0 && least > TORN * covering.edge {
            return Err(Trouble::Tear);
        }
        // Where the ball has no radius nothing is to be reached.
        largest = largest.max(if least.is_finite() { least } else { 0.0 });
    }
    Ok(largest)
}
