//! What a larger tool has left: the stretches of a smaller tool's paths on which it cuts something.
//!
//! The larger tool has cut all but the closing of what stays by its radius (and that of its path). Where the smaller tool's
//! centre keeps its own radius from that closing, it only cuts air. The closings are exact, and where neither of them
//! differs from the drawing the paths touch the larger closing to the last digits: nothing is cut twice but a short overlap.

use super::{Geometry, Keep, Larger, Level, OperationError, Planned, Work};
use crate::cam::nearest_next::nearest_next;
use crate::cam::solid::Solid;
use crate::cam::walk::Walk;
use crate::cam::{Move, MoveKind, Remainder, Side, close_for_path};
use crate::plane::{Point, Segment};

/// Less than this, in millimetres, is not cut again: what the arcs of programs are off.
const LEAST: f64 = 0.005;

/// How far the stretches reach into what is cut already, in tool radii: there the tool goes down.
const OVERLAP: f64 = 0.5;

/// How finely a path is looked at, in tool radii; what is narrower is thinner than a hundredth of that.
const STEP: f64 = 0.1;

/// Halvings of a step to find where a stretch begins: to a thousandth of it.
const HALVINGS: usize = 10;

/// Rings behind each other: the tools of a job differ by no more.
const MOST_RINGS: usize = 200;

/// `larger` is the other tool; rings lie `stepover` apart.
pub(super) fn plan(
    work: &Work,
    geometry: &Geometry,
    side: Side,
    larger: Larger,
    stepover: f64,
) -> Result<Planned, OperationError> {
    if geometry.area.is_empty() {
        return Err(OperationError::NoArea);
    }
    let stays = side.kept_material(&geometry.area);
    let radius = work.tool.radius();
    let mut notices = Vec::new();
    let wall = Level::beside_outlines(work, &stays, radius, &mut notices)?;
    let Larger { radius: larger, path_radius, eases } = larger;
    let left = close_for_path(&stays, larger, path_radius, eases, work.cutting.topology).region;
    let left = side.solid(&left);
    let mut rings: Vec<Vec<Vec<Segment>>> = vec![stretches(work, &wall, &left, radius)];
    for k in 1..MOST_RINGS {
        let Ok(level) = Level::new(&stays, radius + k as f64 * stepover, work.path_radius, work.cutting.topology)
        else {
            break;
        };
        let found = stretches(work, &level, &left, radius);
        if found.is_empty() {
            break;
        }
        rings.push(found);
    }
    let heights = work.cutting.pass_heights(work.stock_top);
    let mut moves = work.first_moves();
    let mut count = 0;
    // From the middle to the wall.
    for paths in rings.into_iter().rev() {
        for path in in_order(paths, moves.last().map_or(Point::origin(), |m| m.to)) {
            cut(work, &path, &heights, count, &mut moves);
            count += 1;
        }
    }
    if count == 0 {
        return Err(OperationError::NothingLeft { diameter: work.tool.diameter });
    }
    let (kept, remainder) = match side {
        Side::Outside | Side::On => (wall.closed, Remainder::Inside),
        Side::Inside => (wall.closed.reversed(), Remainder::Outside),
    };
    let keep = Keep {
        part: geometry.area.clone(),
        kept,
        remainder,
        distance: radius,
        floor: work.floor,
        others: geometry.others.clone(),
    };
    Ok(Planned {
        toolpath: work.toolpath(moves, count),
        keep: Some(keep),
        notices,
        tabs: Vec::new(),
        holes: Vec::new(),
        contradictions: wall.contradictions,
    })
}

/// The stretches of all paths of a level on which the tool cuts something of what is left.
fn stretches(work: &Work, level: &Level, left: &Solid, radius: f64) -> Vec<Vec<Segment>> {
    let cuts = |p: Point| left.contains(p) || left.boundary.is_nearer(p, radius - LEAST);
    let mut found = Vec::new();
    for contour in work.contours(&level.path) {
        let elements: Vec<Segment> = contour.path.segments().filter(|s| s.length() > 0.0).collect();
        if elements.is_empty() {
            continue;
        }
        let walk = Walk::new(elements);
        let length = walk.length();
        let count = (length / (STEP * radius)).ceil().max(4.0) as usize;
        let way = |k: usize| length * (k as f64 / count as f64);
        let is_cut: Vec<bool> = (0..count).map(|k| cuts(walk.point_at(way(k)))).collect();
        let Some(first) = (0..count).find(|&k| !is_cut[k]) else {
            found.push(walk.stretch(0.0, length));
            continue;
        };
        // Where between two samples it changes.
        let change = |from: f64, to: f64, rising: bool| {
            let (mut a, mut b) = (from, to);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if cuts(walk.point_at(middle)) == rising { b = middle } else { a = middle }
            }
            0.5 * (a + b)
        };
        let step = length / count as f64;
        let mut start: Option<f64> = None;
        for k in first..first + count {
            let (now, next) = (is_cut[k % count], is_cut[(k + 1) % count]);
            let at = step * k as f64;
            if !now && next {
                start = Some(change(at, at + step, true));
            } else if now
                && !next
                && let Some(begin) = start.take()
            {
                let end = change(at, at + step, false);
                let overlap = OVERLAP * radius;
                let reach = (end - begin + 2.0 * overlap).min(length);
                found.push(walk.stretch((begin - overlap).rem_euclid(length), reach));
            }
        }
    }
    found
}

/// Paths in the order in which always the nearest start comes next.
fn in_order(mut paths: Vec<Vec<Segment>>, here: Point) -> Vec<Vec<Segment>> {
    paths.retain(|p| !p.is_empty());
    let ends: Vec<[Point; 2]> = paths.iter().map(|p| [p[0].start, p[p.len() - 1].end]).collect();
    nearest_next(&ends, false, here).into_iter().map(|next| std::mem::take(&mut paths[next.path])).collect()
}

fn cut(work: &Work, path: &[Segment], heights: &[f64], contour: usize, moves: &mut Vec<Move>) {
    let safe = work.setup.rig.safe_height;
    let mut push = |to: Point, z: f64, kind: MoveKind| moves.push(Move { to, z, kind, contour });
    let (start, end) = (path[0].start, path[path.len() - 1].end);
    for &height in heights {
        push(start, safe, MoveKind::Rapid);
        if work.approach() < safe {
            push(start, work.approach(), MoveKind::Rapid);
        }
        push(start, height, MoveKind::Plunge);
        path.iter().for_each(|s| push(s.end, height, MoveKind::Cut(s.link)));
        push(end, safe, MoveKind::Rapid);
    }
}
