//! What is not the closing after the last level, cut out and filled anew, with more around it each time.

use std::collections::BTreeMap;

use super::conflicts::{Found, find, find_since};
use super::covering::Covering;
use super::mend::Rims;
use super::{MOST_VERTICES, ROUNDS};

/// So many rings of faces around what is wrong are cut out at most.
const RINGS: usize = 4;

/// What is wrong within so many edge lengths of each other is one place.
const APART: f64 = 8.0;

/// So many tries that help nowhere are enough.
const PATIENCE: usize = 6;

/// The ways of filling that are tried with each number of rings: which rims are joined, and whether long edges are split boldly.
const WAYS: [(Rims, bool); 3] = [(Rims::Moved, false), (Rims::All, false), (Rims::All, true)];

/// Cuts out what is not the closing and fills it anew, and keeps that wherever it is better.
pub(super) fn retry(mut covering: Covering) -> (Covering, Found) {
    let mut found = find(&covering);
    let mut in_vain = 0;
    for (rings, (rims, bold)) in (1..=RINGS).flat_map(|rings| WAYS.map(|way| (rings, way))) {
        let places = places(&found, APART * covering.edge);
        if places.is_empty() || in_vain == PATIENCE {
            break;
        }
        let tried = |faces: &[u32]| {
            let mut tried = covering.clone();
            tried.mend_around(faces, rings, rims);
            tried.bold = bold.then_some(MOST_VERTICES * covering.state.len());
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
    (covering, found)
}

/// The faces that are not the closing, by places that are farther apart than a distance.
fn places(found: &Found, apart: f64) -> Vec<Vec<u32>> {
    let mut left: Vec<usize> = (0..found.faces.len()).collect();
    let mut places = Vec::new();
    while let Some(first) = left.pop() {
        let (mut place, mut at) = (vec![first], 0);
        while at < place.len() {
            let here = found.conflicts[place[at]].place;
            at += 1;
            let near: Vec<usize>;
            (near, left) =
                left.into_iter().partition(|&k| (found.conflicts[k].place - here).norm_squared() <= apart * apart);
            place.extend(near);
        }
        places.push(place.into_iter().map(|k| found.faces[k]).collect());
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
