//! Along lines: strokes, or the outlines of what is filled.

use super::{CutLine, Geometry, OperationError, Planned, Work};
use crate::cam::lay::Pen;
use crate::cam::order::order;
use crate::cam::tabs::TabLine;
use crate::cam::{Contour, MoveKind, fit_arcs};
use crate::plane::{Point, Segment};

/// How high above the stock the tool goes from rapid to plunge, in millimetres.
const APPROACH: f64 = 1.0;

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
    let mut here = moves.last().map_or(Point::origin(), |m| m.to);
    while !paths.is_empty() {
        // The nearest end of all that are left; the first of equals.
        let ends = paths.iter().enumerate().flat_map(|(k, p)| {
            let last = p.len() - 1;
            [(k, false, p[0].start), (k, true, p[last].end)]
        });
        let nearest = ends.min_by(|a, b| (a.2 - here).norm().total_cmp(&(b.2 - here).norm()));
        let Some((k, turned, _)) = nearest else { break };
        let path = paths.remove(k);
        let path = if turned { reversed(&path) } else { path };
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: count };
        here = follow(work, &path, &heights, &mut pen);
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
    let fitted = fit_arcs(&line.ring);
    let end = line.ring.vertices.last().map(|v| v.point);
    let start = line.ring.vertices.first().map(|v| v.point);
    // Fitting may begin elsewhere: the line runs from its own start to its own end.
    let elements: Vec<Segment> = fitted.segments().collect();
    let Some(first) = elements.iter().position(|s| Some(s.start) == start) else { return Vec::new() };
    let n = elements.len();
    let around = (0..n).map(|k| elements[(first + k) % n]);
    let mut path: Vec<Segment> = around.collect();
    if let Some(last) = path.iter().position(|s| Some(s.end) == end) {
        path.truncate(last + 1);
    }
    path
}

fn reversed(path: &[Segment]) -> Vec<Segment> {
    path.iter().rev().map(Segment::reversed).collect()
}

/// To and fro along an open path, a pass each; where the tool ends.
fn follow(work: &Work, path: &[Segment], heights: &[f64], pen: &mut Pen) -> Point {
    let safe = work.setup.rig.safe_height;
    let mut way = path.to_vec();
    let start = way[0].start;
    pen.push(start, safe, MoveKind::Rapid);
    if work.top + APPROACH < safe {
        pen.push(start, work.top + APPROACH, MoveKind::Rapid);
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
    end
}
