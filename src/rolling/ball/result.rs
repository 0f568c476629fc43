//! What comes out: the input as far as it is left, then what is new.

use super::ClosedSurface;
use super::conflicts::{Conflict, Found, Trouble};
use super::covering::{Covering, State};
use crate::mesh::{NONE, Point, TriangleMesh};

/// The surface, with the regions that hold a face that was found bad as they were in the input.
pub(super) fn result(input: &TriangleMesh, covering: &Covering, found: Found) -> ClosedSurface {
    let regions = regions(covering, input.faces.len());
    let mut is_bad = vec![false; input.faces.len()];
    for &f in &found.faces {
        is_bad[regions[covering.parent[f as usize] as usize] as usize] = true;
    }
    let reverted = |f: u32| is_bad[regions[covering.parent[f as usize] as usize] as usize];
    let (mut faces, mut parents) = (Vec::new(), Vec::new());
    for f in 0..covering.mesh.face_count() as u32 {
        let is_input = (f as usize) < input.faces.len();
        if is_input && (reverted(f) || !covering.touched[f as usize]) {
            faces.push(input.faces[f as usize]);
            parents.push(f);
        } else if covering.mesh.has_face(f) && !reverted(f) {
            faces.push(covering.mesh.face(f));
            parents.push(NONE);
        }
    }
    // Vertices of the input that nothing but reverted faces use are where they were.
    let mut is_used = vec![false; covering.mesh.points.len()];
    let mut is_original = vec![false; covering.mesh.points.len()];
    for (face, parent) in faces.iter().zip(&parents) {
        for &v in face {
            is_used[v as usize] = true;
            is_original[v as usize] |= *parent != NONE || covering.state[v as usize] == State::Kept;
        }
    }
    let errors = found.errors.iter().filter(|(f, _)| !reverted(*f)).map(|(_, error)| *error);
    let error = errors.fold(0.0, f64::max);
    let mut closed = ClosedSurface { parents, conflicts: found.conflicts, error, ..ClosedSurface::default() };
    let mut number = vec![NONE; is_used.len()];
    for v in 0..is_used.len() {
        let is_input = v < input.points.len();
        // What no face ever used stays, too.
        if !(is_used[v] || is_input && !covering.has_been_used(v as u32)) {
            continue;
        }
        number[v] = closed.points.len() as u32;
        let stays = is_input && (is_original[v] || !is_used[v]);
        closed.points.push(if stays { input.points[v] } else { covering.mesh.points[v] });
        closed.origins.push(if stays { v as u32 } else { NONE });
    }
    closed.faces = faces.into_iter().map(|f| f.map(|v| number[v as usize])).collect();
    closed
}

/// The input, with one place that could not be done.
pub(super) fn unmoved(input: &TriangleMesh, place: Point) -> ClosedSurface {
    ClosedSurface {
        points: input.points.clone(),
        origins: (0..input.points.len() as u32).collect(),
        faces: input.faces.clone(),
        parents: (0..input.faces.len() as u32).collect(),
        conflicts: vec![Conflict { place, trouble: Trouble::Fold }],
        error: 0.0,
    }
}

/// The region of each face of the input: touched faces that are neighbours are of one region, in the input or where gaps were
/// mended; any other face is one of its own.
fn regions(covering: &Covering, count: usize) -> Vec<u32> {
    let mut above: Vec<u32> = (0..count as u32).collect();
    fn top(above: &mut [u32], mut f: u32) -> u32 {
        while above[f as usize] != f {
            above[f as usize] = above[above[f as usize] as usize];
            f = above[f as usize];
        }
        f
    }
    let mut join = |f: u32, g: u32| {
        let (f, g) = (top(&mut above, f), top(&mut above, g));
        above[f.max(g) as usize] = f.min(g);
    };
    for (mesh, parent) in [(&covering.ground.mesh, None), (&covering.mesh, Some(&covering.parent))] {
        let of = |f: u32| parent.map_or(f, |parent| parent[f as usize]);
        for f in mesh.faces().filter(|&f| covering.is_touched(f)) {
            for t in mesh.half_edges(f).into_iter().filter_map(|h| mesh.twin(h)) {
                if covering.is_touched(mesh.face_of(t)) {
                    join(of(f), of(mesh.face_of(t)));
                }
            }
        }
    }
    (0..count as u32).map(|f| top(&mut above, f)).collect()
}
