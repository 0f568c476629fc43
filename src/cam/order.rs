//! In which order contours are cut, and where each is entered.
//!
//! What lies inside of a contour is cut before it: holes before their part, parts in a hole before the hole. Within this
//! order the travel is made short: always the nearest next, then stretches are turned round or moved while that helps.

use crate::plane::Point;

use super::Contour;

/// Above this many contours only the nearest next is sought: improving takes quadratic time a round.
const LARGEST_IMPROVED: usize = 800;

/// Rounds of improvement; real drawings settle in a handful.
const LARGEST_ROUNDS: usize = 30;

/// The longest stretch that is moved elsewhere as a whole.
const LONGEST_MOVED: usize = 3;

/// How much shorter, in millimetres, a change has to be: keeps rounding from going round in circles.
const WORTHWHILE: f64 = 1e-6;

/// A contour to cut and the entry to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stop {
    pub(super) contour: usize,
    pub(super) entry: usize,
}

/// The order for `contours`, beginning near `start`.
pub(super) fn order(contours: &[Contour], start: Point) -> Vec<Stop> {
    let parents = parents(contours);
    let mut stops = nearest_next(contours, &parents, start);
    if stops.len() <= LARGEST_IMPROVED {
        improve(&mut stops, contours, &parents, start);
    }
    stops
}

/// For every contour the smallest one that it lies in.
pub(super) fn parents(contours: &[Contour]) -> Vec<Option<usize>> {
    let bounds: Vec<_> = contours.iter().map(|c| c.path.bounds()).collect();
    let areas: Vec<f64> = contours.iter().map(Contour::area).collect();
    let mut by_area: Vec<usize> = (0..contours.len()).collect();
    by_area.sort_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
    let mut parents = vec![None; contours.len()];
    for (rank, &inner) in by_area.iter().enumerate() {
        let Some(vertex) = contours[inner].path.vertices.first() else { continue };
        parents[inner] = by_area[rank + 1..]
            .iter()
            .copied()
            .find(|&outer| bounds[outer].contains(vertex.point) && contours[outer].encloses(&contours[inner]));
    }
    parents
}

/// Always the nearest entry of a contour that has nothing left inside.
fn nearest_next(contours: &[Contour], parents: &[Option<usize>], start: Point) -> Vec<Stop> {
    let mut inside = vec![0usize; contours.len()];
    parents.iter().flatten().for_each(|&p| inside[p] += 1);
    let mut free: Vec<usize> = (0..contours.len()).filter(|&c| inside[c] == 0).collect();
    let mut stops = Vec::with_capacity(contours.len());
    let mut here = start;
    while !free.is_empty() {
        let mut best = (f64::INFINITY, 0, 0);
        for (slot, &c) in free.iter().enumerate() {
            for (e, entry) in contours[c].entries.iter().enumerate() {
                let distance = (entry.point - here).norm();
                // Equal distances: the contour that comes first, whatever the order of the free ones.
                if distance < best.0 || (distance == best.0 && c < free[best.1]) {
                    best = (distance, slot, e);
                }
            }
        }
        let (_, slot, entry) = best;
        let contour = free.swap_remove(slot);
        here = contours[contour].entries[entry].point;
        stops.push(Stop { contour, entry });
        if let Some(p) = parents[contour] {
            inside[p] -= 1;
            if inside[p] == 0 {
                free.push(p);
            }
        }
    }
    stops
}

/// The travel between the stops, from `start`.
#[cfg(test)]
fn travel(stops: &[Stop], contours: &[Contour], start: Point) -> f64 {
    let places = stops.iter().map(|s| place(contours, s));
    places.fold((0.0, start), |(sum, here), p| (sum + (p - here).norm(), p)).0
}

fn place(contours: &[Contour], stop: &Stop) -> Point {
    contours[stop.contour].entries[stop.entry].point
}

/// Turns stretches round, moves short ones, and chooses entries anew, while that shortens the travel.
fn improve(stops: &mut Vec<Stop>, contours: &[Contour], parents: &[Option<usize>], start: Point) {
    for _ in 0..LARGEST_ROUNDS {
        let turned = turn_stretches(stops, contours, parents, start);
        let moved = move_stretches(stops, contours, parents, start);
        let chosen = choose_entries(stops, contours, start);
        if !(turned || moved || chosen) {
            return;
        }
    }
}

/// Where every contour stands in the order.
fn positions(stops: &[Stop]) -> Vec<usize> {
    let mut at = vec![0; stops.len()];
    stops.iter().enumerate().for_each(|(i, s)| at[s.contour] = i);
    at
}

/// The distance from the stop before position `i` (or the start) to `p`.
fn leg_to(stops: &[Stop], contours: &[Contour], start: Point, i: usize, p: Point) -> f64 {
    let from = if i == 0 { start } else { place(contours, &stops[i - 1]) };
    (p - from).norm()
}

fn turn_stretches(stops: &mut [Stop], contours: &[Contour], parents: &[Option<usize>], start: Point) -> bool {
    let mut changed = false;
    let mut at = positions(stops);
    for i in 0..stops.len() {
        // The first place behind the stretch that has to stay behind it.
        let mut fence = usize::MAX;
        let mut j = i;
        while j < stops.len() {
            fence = parents[stops[j].contour].map_or(fence, |p| fence.min(at[p]));
            if fence <= j {
                break;
            }
            let (a, b) = (place(contours, &stops[i]), place(contours, &stops[j]));
            let after = stops.get(j + 1).map(|s| place(contours, s));
            let old = leg_to(stops, contours, start, i, a) + after.map_or(0.0, |p| (p - b).norm());
            let new = leg_to(stops, contours, start, i, b) + after.map_or(0.0, |p| (p - a).norm());
            if j > i && new < old - WORTHWHILE {
                stops[i..=j].reverse();
                at = positions(stops);
                changed = true;
                // The fence was that of the stretch before it was turned: begin anew.
                fence = usize::MAX;
                j = i;
                continue;
            }
            j += 1;
        }
    }
    changed
}

fn move_stretches(stops: &mut Vec<Stop>, contours: &[Contour], parents: &[Option<usize>], start: Point) -> bool {
    let mut changed = false;
    for length in 1..=LONGEST_MOVED {
        let mut i = 0;
        while i + length <= stops.len() {
            if let Some(to) = better_position(stops, contours, parents, start, i, length) {
                let stretch: Vec<Stop> = stops.drain(i..i + length).collect();
                stops.splice(to..to, stretch);
                changed = true;
            }
            i += 1;
        }
    }
    changed
}

/// Where the stretch `i..i + length` stands better, as a position in the order without it.
fn better_position(
    stops: &[Stop],
    contours: &[Contour],
    parents: &[Option<usize>],
    start: Point,
    i: usize,
    length: usize,
) -> Option<usize> {
    let end = i + length;
    let (first, last) = (place(contours, &stops[i]), place(contours, &stops[end - 1]));
    let inside = |c: usize| stops[i..end].iter().any(|s| s.contour == c);
    let rest: Vec<Stop> = stops[..i].iter().chain(&stops[end..]).copied().collect();
    // Behind everything that lies inside of it, before everything that it lies in.
    let earliest = rest.iter().rposition(|s| parents[s.contour].is_some_and(inside)).map_or(0, |k| k + 1);
    let is_parent = |c: usize| stops[i..end].iter().any(|s| parents[s.contour] == Some(c));
    let latest = rest.iter().position(|s| is_parent(s.contour)).unwrap_or(rest.len());
    let cost = |k: usize| {
        let after = rest.get(k).map(|s| place(contours, s));
        let into = leg_to(&rest, contours, start, k, first);
        let skipped = after.map_or(0.0, |p| leg_to(&rest, contours, start, k, p));
        into + after.map_or(0.0, |p| (p - last).norm()) - skipped
    };
    let now = cost(i);
    let best = (earliest..=latest).map(|k| (cost(k), k)).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
    (best.0 < now - WORTHWHILE).then_some(best.1)
}

fn choose_entries(stops: &mut [Stop], contours: &[Contour], start: Point) -> bool {
    let mut changed = false;
    for i in 0..stops.len() {
        let after = stops.get(i + 1).map(|s| place(contours, s));
        let cost = |p: Point| leg_to(stops, contours, start, i, p) + after.map_or(0.0, |a| (a - p).norm());
        let entries = &contours[stops[i].contour].entries;
        let now = cost(entries[stops[i].entry].point);
        let best = entries.iter().map(|e| cost(e.point)).zip(0..).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, entry)) = best.filter(|(c, _)| *c < now - WORTHWHILE) {
            stops[i].entry = entry;
            changed = true;
        }
    }
    changed
}

#[cfg(test)]
mod tests;
