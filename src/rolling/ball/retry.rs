//! What is not the closing after the last level, cut out and filled anew, with more around it each time.

use std::collections::BTreeMap;

use super::conflicts::{Found, find, find_since};
use super::covering::Covering;
use super::mend::Rims;
use super::{MOST_VERTICES, ROUNDS};
use crate::mesh::Point;

/// So many rings of faces around what is wrong are cut out at most.
const RINGS: usize = 4;

/// What is wrong in neighbouring cells with sides of so many edge lengths is one place.
const APART: f64 = 8.0;

/// So many tries that help nowhere are enough.
const PATIENCE: usize = 6;

/// The ways of filling that are tried with each number of rings: which rims are joined, and whether long edges are split boldly.
const WAYS: [(Rims, bool); 3] = [(Rims::Moved, false), (Rims::All, false), (Rims::All, true)];

/// Cuts out what is not the closing and fills it anew, and keeps that wherever it is better.
pub(super) fn retry(mut covering: Covering) -> (Covering, Found) {
    let mut found = find(&covering);
    let most = MOST_VERTICES * covering.state.len();
    let mut in_vain = 0;
    for (rings, (rims, bold)) in (1..=RINGS).flat_map(|rings| WAYS.map(|way| (rings, way))) {
        let places = places(&found, APART * covering.edge);
        if places.is_empty() || in_vain == PATIENCE {
            break;
        }
        let tried = |faces: &[u32]| {
            let mut tried = covering.clone();
            tried.mend_around(faces, rings, rims);
            tried.bold = bold.then_some(most);
            tried.remesh(ROUNDS);
            tried.bold = None;
            let left = find_since(&tried, Some((&covering, &found)));
            (tried, left)
        };
        let (mut better, mut left) = tried(&places.concat());
        let helped = helped(&found, &places, &left);
        if !helped.is_empty() && helped.len() < places.len() {
            (better, left) = tried(&helped.concat());
        }
        in_vain += 1;
        if left.faces.len() < found.faces.len() {
            (covering, found) = (better, left);
            in_vain = 0;
        }
    }
    unfolded(covering, found)
}

/// The same with fewer faces that turn their backs on each other, where no more than before is wrong.
fn unfolded<'a>(covering: Covering<'a>, found: Found) -> (Covering<'a>, Found) {
    let mut tried = covering.clone();
    tried.unfold();
    let left = find_since(&tried, Some((&covering, &found)));
    if left.faces.len() <= found.faces.len() { (tried, left) } else { (covering, found) }
}

/// The faces that are not the closing, by places: cells of so large a side and those beside them.
fn places(found: &Found, side: f64) -> Vec<Vec<u32>> {
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    for (&f, conflict) in found.faces.iter().zip(&found.conflicts) {
        let Point { coords } = conflict.place;
        cells.entry([coords.x, coords.y, coords.z].map(|x| (x / side).floor() as i64)).or_default().push(f);
    }
    let mut places = Vec::new();
    while let Some((first, mut place)) = cells.pop_first() {
        let mut open = vec![first];
        while let Some([x, y, z]) = open.pop() {
            for n in 0..27 {
                let cell = [x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1];
                if let Some(faces) = cells.remove(&cell) {
                    place.extend(faces);
                    open.push(cell);
                }
            }
        }
        place.sort_unstable();
        places.push(place);
    }
    places
}

/// The places at which less is wrong than there was.
fn helped(found: &Found, places: &[Vec<u32>], left: &Found) -> Vec<Vec<u32>> {
    let place_of: BTreeMap<u32, usize> =
        places.iter().enumerate().flat_map(|(k, place)| place.iter().map(move |&f| (f, k))).collect();
    let mut counts = vec![0; places.len()];
    for conflict in &left.conflicts {
        let distance = |k: usize| (found.conflicts[k].place - conflict.place).norm_squared();
        if let Some(k) = (0..found.faces.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))) {
            counts[place_of[&found.faces[k]]] += 1;
        }
    }
    places.iter().zip(counts).filter(|(place, count)| *count < place.len()).map(|(place, _)| place.clone()).collect()
}
