//! Runs of chords become arcs.
//!
//! A drawing's Bézier curves arrive as chords whose inner vertices are marked [`Joint::Smooth`]; their exact offset is a
//! run of short lines and short arcs of the tool's radius. Such a run is replaced by biarcs that share tangents, so that
//! the path stays free of corners. True lines and arcs pass unchanged.
//!
//! Stages: the ring is cut into runs at its corners; every run gets *places* on the exact offset where its direction is
//! that of the curve; from each place the farthest one is sought that a biarc reaches within [`ARC_FIT_TOLERANCE`].
//! Places are chosen so that the chords lie on the part's side of the arcs: on the arcs about convex vertices, and in the
//! middle of chords between concave ones.

use crate::plane::{Biarc, Joint, Link, Place, Point, Ring, Segment, turn_angle};

use super::simplify::{join_aligned, ring_of_segments};

/// The most that a fitted arc may leave the exact path towards the part, in millimetres, and the most that it may leave
/// the places where path and curve agree to either side. A quarter of the gouge that a program may have.
pub const ARC_FIT_TOLERANCE: f64 = 5e-4;

/// The most that an arc may bulge away from the part between places, in millimetres, beyond the tolerance. The bulge is
/// the sagitta of chords, so runs with longer ones were no flattened curve, and stay.
const LARGEST_BULGE: f64 = 2e-3;

/// The fewest stations that a biarc has to pass: on fewer it would not be shorter than what it replaces, as the elements
/// that it begins and ends on are cut in two.
const FEWEST_STATIONS: usize = 3;

/// The most that a biarc turns, in radians: half a turn and it would no longer be clear which of its arcs is meant.
const LARGEST_TURN: f64 = 2.0;

/// Replaces runs of chords of smooth curves by arcs, joins collinear lines and arcs of one circle.
///
/// `path` has the part on its left. The result has no [`Joint::Smooth`] left.
pub fn fit_arcs(path: &Ring) -> Ring {
    if path.len() < 2 {
        return path.clone();
    }
    let n = path.len();
    let mut segments = Vec::with_capacity(n);
    match (0..n).find(|&i| path.vertices[i].joint == Joint::Corner) {
        None => {
            let whole: Vec<Segment> = path.segments().collect();
            segments.extend(fit_closed(&whole));
        }
        Some(first) => {
            let mut i = 0;
            while i < n {
                let mut run = vec![path.segment((first + i) % n)];
                i += 1;
                while i < n && path.vertices[(first + i) % n].joint == Joint::Smooth {
                    run.push(path.segment((first + i) % n));
                    i += 1;
                }
                fit_run(&run, &mut segments);
            }
        }
    }
    ring_of_segments(&join_aligned(&segments))
}

/// A closed curve without corners: cut open at one of its places.
fn fit_closed(whole: &[Segment]) -> Vec<Segment> {
    let mut out = Vec::new();
    let Some(cut) = stations(whole, Ends::Closed).first().copied() else { return whole.to_vec() };
    let mut run: Vec<Segment> = vec![Segment { start: cut.place.point, ..whole[cut.element] }];
    run.extend_from_slice(&whole[cut.element + 1..]);
    run.extend_from_slice(&whole[..cut.element]);
    run.push(Segment { end: cut.place.point, ..whole[cut.element] });
    fit_run(&run, &mut out);
    out
}

/// A place of a run where its direction is that of the curve.
#[derive(Clone, Copy, Debug)]
struct Station {
    element: usize,
    place: Place,
    /// How far the run has turned until here, both ways counted.
    turned: f64,
}

/// Whether a run has ends.
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    Open,
    Closed,
}

/// The places of a run, in order.
fn stations(run: &[Segment], ends: Ends) -> Vec<Station> {
    let n = run.len();
    let is_arc = |i: usize| matches!(run[i].link, Link::Arc(_));
    let neighbour = |i: usize, step: usize| {
        (ends == Ends::Closed || (i + step > 0 && i + step <= n)).then(|| (i + step + n - 1) % n)
    };
    let mut out = Vec::with_capacity(n + 2);
    let mut turned = 0.0;
    if ends == Ends::Open {
        out.push(Station { element: 0, place: Place { point: run[0].start, tangent: run[0].start_tangent() }, turned });
    }
    for i in 0..n {
        let (before, after) = (neighbour(i, 0), neighbour(i, 2));
        if let Some(b) = before {
            turned += turn_angle(run[b].end_tangent(), run[i].start_tangent()).abs();
        }
        let sweep = run[i].sweep();
        match run[i].link {
            Link::Arc(arc) => {
                // A curve through samples turns at each in proportion to the chords beside it.
                let length = |j: Option<usize>| j.map_or(0.0, |j| run[j].length());
                let (l0, l1) = (length(before), length(after));
                let share = if before.is_some() && after.is_some() && l0 + l1 > 0.0 { l0 / (l0 + l1) } else { 0.5 };
                let point = arc.travel(run[i].start, share * sweep);
                let place = Place { point, tangent: arc.tangent_at(point) };
                out.push(Station { element: i, place, turned: turned + share * sweep });
            }
            Link::Line if before.is_some_and(|b| !is_arc(b)) || after.is_some_and(|a| !is_arc(a)) => {
                let place = Place { point: run[i].point_at(0.5), tangent: run[i].start_tangent() };
                out.push(Station { element: i, place, turned });
            }
            Link::Line => {}
        }
        turned += sweep;
    }
    if ends == Ends::Open {
        let last = &run[n - 1];
        out.push(Station { element: n - 1, place: Place { point: last.end, tangent: last.end_tangent() }, turned });
    }
    out
}

/// Fits an open run and appends what replaces it.
fn fit_run(run: &[Segment], out: &mut Vec<Segment>) {
    if run.len() < 3 {
        out.extend_from_slice(run);
        return;
    }
    let stations = stations(run, Ends::Open);
    let last = stations.len() - 1;
    let mut from = 0;
    while from < last {
        let fits = |to: usize| biarc_within_tolerance(run, &stations[from..=to]);
        // Gallop, then bisect: the number of stations looked at stays a small multiple of those passed.
        let (mut good, mut best) = (from + 1, None);
        let mut step = FEWEST_STATIONS;
        let mut bad = last + 1;
        while good < last && from + FEWEST_STATIONS <= last {
            let to = (from + step).min(last);
            match fits(to) {
                Some(biarc) => (good, best) = (to, Some(biarc)),
                None => {
                    bad = to;
                    break;
                }
            }
            step *= 2;
        }
        while best.is_some() && good + 1 < bad {
            let middle = good + (bad - good) / 2;
            match fits(middle) {
                Some(biarc) => (good, best) = (middle, Some(biarc)),
                None => bad = middle,
            }
        }
        match best {
            Some(biarc) => out.extend([biarc.first, biarc.second]),
            None => between(run, &stations[from], &stations[good], |s| out.push(s)),
        }
        from = good;
    }
}

/// The biarc from the first to the last of `stations`, if the run between keeps to it.
fn biarc_within_tolerance(run: &[Segment], stations: &[Station]) -> Option<Biarc> {
    let (first, last) = (stations.first()?, stations.last()?);
    if last.turned - first.turned > LARGEST_TURN {
        return None;
    }
    let biarc = Biarc::between(first.place, last.place)?;
    if stations.iter().any(|s| biarc.offside(s.place.point).abs() > ARC_FIT_TOLERANCE) {
        return None;
    }
    // Right of the arc means that the arc is nearer to the part than the run.
    let allowed = -(ARC_FIT_TOLERANCE + LARGEST_BULGE)..=ARC_FIT_TOLERANCE;
    let mut within = true;
    between(run, first, last, |element| {
        let mut look = |p: Point| within &= allowed.contains(&biarc.offside(p));
        look(element.start);
        look(element.end);
        biarc.extremes(&element).into_iter().flatten().for_each(look);
    });
    within.then_some(biarc)
}

/// Calls `emit` with the parts of the run between two stations.
fn between(run: &[Segment], from: &Station, to: &Station, mut emit: impl FnMut(Segment)) {
    for (i, element) in run.iter().enumerate().take(to.element + 1).skip(from.element) {
        let start = if i == from.element { from.place.point } else { element.start };
        let end = if i == to.element { to.place.point } else { element.end };
        // A station at the very end of its element leaves nothing.
        if start != end {
            emit(Segment { start, end, ..*element });
        }
    }
}

#[cfg(test)]
mod tests;
