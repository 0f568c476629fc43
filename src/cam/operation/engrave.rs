//! Along lines: strokes, or the outlines of what is filled.

use super::{CutLine, Geometry, OperationError, Planned, Work};
use crate::cam::lay::Pen;
use crate::cam::nearest_next::nearest_next;
use crate::cam::order::order;
use crate::cam::tabs::TabLine;
use crate::cam::{Contour, MoveKind, fit_arcs};
use crate::plane::{Link, Point, Segment};

pub(super) fn plan(work: &Work, geometry: &Geometry) -> Result<Planned, OperationError> {
    let outlines = geometry.area.rings.iter().map(|ring| CutLine { ring: ring.clone(), is_closed: true });
    let lines: Vec<CutLine> = if geometry.lines.is_empty() { outlines.collect() } else { geometry.lines.clone() };
    if lines.iter().all(|l| l.ring.is_empty()) {
        return Err(OperationError::NoLines);
    }
    let heights = work.cutting.pass_heights(work.stock_top);
    let mut moves = work.first_moves();
    let mut notices = Vec::new();
    let (closed, open): (Vec<_>, Vec<_>) = lines.iter().partition(|l| l.is_closed);
    let contours: Vec<Contour> = closed.iter().filter_map(|l| Contour::new(fit_arcs(&l.ring), false)).collect();
    let laying = work.laying(work.top, &heights, None, &[]);
    let mut count = 0;
    for stop in order(&contours, Point::origin()) {
        let contour = &contours[stop.contour];
        let entry = contour.entries[stop.entry];
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: count };
        laying.closed(entry.point, &contour.around_from(&entry), &TabLine::default(), &mut pen);
        count += 1;
    }
    let mut paths: Vec<Vec<Segment>> = open.iter().map(|l| open_path(l)).filter(|p| !p.is_empty()).collect();
    let here = moves.last().map_or(Point::origin(), |m| m.to);
    let ends: Vec<[Point; 2]> = paths.iter().map(|p| [p[0].start, p[p.len() - 1].end]).collect();
    for next in nearest_next(&ends, true, here) {
        let path = std::mem::take(&mut paths[next.path]);
        let path = if next.is_turned { reversed(&path) } else { path };
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: count };
        follow(work, &path, &heights, &mut pen);
        count += 1;
    }
    Ok(Planned {
        toolpath: work.toolpath(moves, count),
        keep: None,
        notices,
        tabs: Vec::new(),
        holes: Vec::new(),
        contradictions: 0,
    })
}

/// The elements of an open line, with arcs where chords stand for them.
fn open_path(line: &CutLine) -> Vec<Segment> {
    let (Some(first), Some(last)) = (line.ring.vertices.first(), line.ring.vertices.last()) else { return Vec::new() };
    let elements: Vec<Segment> = fit_arcs(&line.ring).segments().collect();
    let n = elements.len();
    // Fitting may begin elsewhere: the line runs from behind the element that leads from its end back to its start. A line
    // may pass its own ends before, so that they alone do not tell.
    let closes = |s: &Segment| s.start == last.point && s.end == first.point && s.link == Link::Line;
    match elements.iter().position(closes) {
        Some(closing) => (1..n).map(|k| elements[(closing + k) % n]).collect(),
        // Fitting has taken the way back into an arc, or dropped it: the line as it is drawn.
        None => line.ring.segments().take(line.ring.len() - 1).collect(),
    }
}

fn reversed(path: &[Segment]) -> Vec<Segment> {
    path.iter().rev().map(Segment::reversed).collect()
}

/// To and fro along an open path, a pass each.
fn follow(work: &Work, path: &[Segment], heights: &[f64], pen: &mut Pen) {
    let safe = work.setup.rig.safe_height;
    let mut way = path.to_vec();
    let start = way[0].start;
    pen.push(start, safe, MoveKind::Rapid);
    if work.approach() < safe {
        pen.push(start, work.approach(), MoveKind::Rapid);
    }
    for &height in heights {
        pen.push(way[0].start, height, MoveKind::Plunge);
        for s in &way {
            pen.push(s.end, height, MoveKind::Cut(s.link));
        }
        way = reversed(&way);
    }
    let end = way[0].start;
    pen.push(end, safe, MoveKind::Rapid);
}
