//! All that an area holds, down to a floor.
//!
//! Rings: the exact offsets of the outline, each with the path radius, from the middle outwards; where that would leave
//! islands, [`spurs`] take them. Raster: the outline, then parallel lines from wall to wall.

use super::finish::Roughing;
use super::profile::steps;
use super::relief::{insert, reliefs, relieved};
use super::spurs::spurs;
use super::{Corners, Geometry, Keep, Level, OperationError, Planned, Work, fitted, raster};
use crate::cam::contour::Contour;
use crate::cam::lay::{Notice, Pen};
use crate::cam::lead::Room;
use crate::cam::order::order;
use crate::cam::tabs::TabLine;
use crate::cam::{Move, MoveKind, Pattern, Remainder, Side};
use crate::plane::{Link, Point, Region, Segment};

/// The most rings inside of each other: more is a slip of the unit.
const MOST_RINGS: usize = 5000;

/// How often the path radius is halved where a ring has no room for it, before it is given up.
const HALVINGS: usize = 2;

/// Heights nearer than this, in millimetres, are one: rounding of sums of depths.
const SAME_HEIGHT: f64 = 1e-9;

/// Neighbouring paths farther apart than this, in stepovers, are not joined by a way through the stock.
const LONGEST_JOIN: f64 = 2.5;

pub(super) fn plan(
    work: &Work,
    geometry: &Geometry,
    pattern: Pattern,
    stepover: f64,
    corners: Corners,
) -> Result<Planned, OperationError> {
    if geometry.area.is_empty() {
        return Err(OperationError::NoArea);
    }
    let stays = Side::Inside.kept_material(&geometry.area);
    let radius = work.tool.radius();
    let rough_distance = radius + work.cutting.allowance;
    let mut notices = Vec::new();
    let outline = Level::beside_outlines(work, &stays, rough_distance, &mut notices)?;
    let is_finished = work.cutting.allowance > 0.0 && work.cutting.finish;
    let last = if is_finished {
        notices.clear();
        Level::beside_outlines(work, &stays, radius, &mut notices)?
    } else {
        outline.clone()
    };
    if last.path.is_empty() {
        return Err(OperationError::TooLarge { diameter: work.tool.diameter });
    }
    let solid = Side::Inside.solid(&outline.closed);
    let mut cuts = Cuts {
        work,
        geometry,
        room: Room { solid: &solid, distance: rough_distance, others: None, tabs: &[] },
        join: LONGEST_JOIN * stepover,
        moves: work.first_moves(),
        notices,
        count: 0,
    };
    let heights = work.cutting.pass_heights(work.stock_top);
    match pattern {
        Pattern::Rings => {
            let rings = rings(work, &stays, &outline.path, rough_distance, stepover);
            let contours: Vec<Contour> = rings.iter().flat_map(|level| work.contours(level)).collect();
            let stops: Vec<usize> = order(&contours, Point::origin()).iter().map(|s| s.contour).collect();
            let mut above = work.top;
            for &height in &heights {
                cuts.rings(&contours, &stops, above, height);
                above = height;
            }
        }
        Pattern::Raster => {
            let contours = work.contours(&outline.path);
            let stops: Vec<usize> = order(&contours, Point::origin()).iter().map(|s| s.contour).collect();
            let mut above = work.top;
            for &height in &heights {
                cuts.rings(&contours, &stops, above, height);
                cuts.raster(&outline.path, stepover, height);
                above = height;
            }
        }
    }
    if is_finished {
        cuts.finish(&last, radius, &outline.path, &heights);
    }
    let distance = if is_finished { radius } else { rough_distance };
    let islands = spurs(&last.path, &paths_at(&cuts.moves, work.floor), radius);
    let mut above = work.top;
    for &height in heights.iter().filter(|_| !islands.is_empty()) {
        islands.iter().for_each(|spur| cuts.line(spur.from, spur.to, above, height));
        above = height;
    }
    let mut path = fitted(&last.path);
    let reliefs = reliefs(&stays, corners, radius, work.path_radius, &mut cuts.notices);
    let ways = insert(&mut path, &reliefs, &mut cuts.notices);
    let mut above = work.top;
    for &height in heights.iter().filter(|_| !ways.is_empty()) {
        ways.iter().for_each(|way| cuts.line(way.start, way.end, above, height));
        above = height;
    }
    let Cuts { moves, notices, count, .. } = cuts;
    let remainder = Remainder::Outside;
    let keep = Keep {
        part: relieved(&geometry.area, remainder, &ways, radius),
        kept: relieved(&last.closed.reversed(), remainder, &ways, radius),
        remainder,
        distance,
        floor: work.floor,
        others: geometry.others.clone(),
    };
    Ok(Planned {
        toolpath: work.toolpath(moves, count),
        keep: Some(keep),
        notices,
        tabs: Vec::new(),
        holes: Vec::new(),
        contradictions: last.contradictions,
    })
}

/// The outline, and inside of it ring after ring while there is room.
fn rings(work: &Work, stays: &Region, outline: &Region, distance: f64, stepover: f64) -> Vec<Region> {
    let mut levels = vec![outline.clone()];
    for k in 1..MOST_RINGS {
        let at = distance + k as f64 * stepover;
        let radii = (0..=HALVINGS).map(|h| work.path_radius * 0.5f64.powi(h as i32)).chain([0.0]);
        let level = radii
            .filter_map(|radius| Level::new(stays, at, radius, work.cutting.topology).ok())
            .find(|l| !l.path.is_empty());
        match level {
            Some(level) => levels.push(level.path),
            None => break,
        }
    }
    levels
}

/// The moves of a pocket as they grow.
struct Cuts<'a> {
    work: &'a Work<'a>,
    geometry: &'a Geometry,
    room: Room<'a>,
    /// The longest way from path to path through the stock.
    join: f64,
    moves: Vec<Move>,
    notices: Vec<Notice>,
    count: usize,
}

impl Cuts<'_> {
    /// The walls once more: at full depth where the path `rough` has been beside them, else in all passes.
    fn finish(&mut self, level: &Level, distance: f64, rough: &Region, heights: &[f64]) {
        let solid = Side::Inside.solid(&level.closed);
        let roughing = Roughing::new(self.work, &self.work.contours(rough));
        let is_beside = |c: &Contour| {
            let path: Vec<_> = c.path.segments().collect();
            c.path.vertices.first().is_some_and(|v| roughing.beside(v.point, &path).is_some())
        };
        let (roughed, full): (Vec<_>, Vec<_>) = self.work.contours(&level.path).into_iter().partition(is_beside);
        let at_once = steps(self.work.top, self.work.floor, self.work.tool.flute_length);
        for (contours, heights) in [(&roughed, at_once.as_slice()), (&full, heights)] {
            let room = Room { solid: &solid, distance, others: None, tabs: &[] };
            let laying = self.work.laying(self.work.top, heights, Some(room), &self.geometry.holes);
            for stop in order(contours, Point::origin()) {
                let contour = &contours[stop.contour];
                let entry = contour.entries[stop.entry];
                let mut pen = Pen { moves: &mut self.moves, notices: &mut self.notices, contour: self.count };
                laying.closed(entry.point, &contour.around_from(&entry), &TabLine::default(), &mut pen);
                self.count += 1;
            }
        }
    }

    fn pen(&mut self) -> Pen<'_> {
        Pen { moves: &mut self.moves, notices: &mut self.notices, contour: self.count }
    }

    /// Where the tool is, if it is at `height` but for having been drawn up.
    fn here(&self, height: f64) -> Option<Point> {
        let [.., down, up] = self.moves.as_slice() else { return None };
        (up.kind == MoveKind::Rapid && down.z == height && down.to == up.to).then_some(up.to)
    }

    /// Whether the way from where the tool is to `to` is short and open: then it stays down.
    fn joins(&mut self, to: Point, height: f64) -> bool {
        let Some(here) = self.here(height) else { return false };
        let open = here == to || ((to - here).norm() <= self.join && self.room.has(&Segment::line(here, to)));
        if open {
            // It was drawn up too early.
            self.moves.pop();
        }
        open
    }

    fn rings(&mut self, contours: &[Contour], stops: &[usize], above: f64, height: f64) {
        for &number in stops {
            let contour = &contours[number];
            let near = self.here(height).and_then(|here| contour.nearest_entry(here));
            let joined = near.filter(|entry| self.joins(entry.point, height));
            let path = |entry: &crate::cam::entry::EntryPlace| contour.around_from(entry);
            match joined {
                Some(entry) => {
                    let safe = self.work.setup.rig.safe_height;
                    let elements = path(&entry);
                    let mut pen = self.pen();
                    pen.push(entry.point, height, MoveKind::Cut(Link::Line));
                    elements.iter().for_each(|s| pen.push(s.end, height, MoveKind::Cut(s.link)));
                    pen.push(entry.point, safe, MoveKind::Rapid);
                }
                None => {
                    // Never empty.
                    let Some(entry) = contour.entries.first().copied() else { continue };
                    let heights = [height];
                    let room = Room { solid: self.room.solid, distance: self.room.distance, others: None, tabs: &[] };
                    let mut laying = self.work.laying(above, &heights, Some(room), &self.geometry.holes);
                    laying.lead = None;
                    let mut pen = Pen { moves: &mut self.moves, notices: &mut self.notices, contour: self.count };
                    laying.closed(entry.point, &path(&entry), &TabLine::default(), &mut pen);
                }
            }
            self.count += 1;
        }
    }

    /// A straight cut whose start is cut already.
    fn line(&mut self, from: Point, to: Point, above: f64, height: f64) {
        let safe = self.work.setup.rig.safe_height;
        let joined = self.joins(from, height);
        let mut pen = self.pen();
        if joined {
            pen.push(from, height, MoveKind::Cut(Link::Line));
        } else {
            pen.push(from, safe, MoveKind::Rapid);
            if above < safe {
                pen.push(from, above, MoveKind::Plunge);
            }
            pen.push(from, height, MoveKind::Plunge);
        }
        pen.push(to, height, MoveKind::Cut(Link::Line));
        pen.push(to, safe, MoveKind::Rapid);
        self.count += 1;
    }

    /// To and fro inside of `outline`, which is cut already.
    fn raster(&mut self, outline: &Region, stepover: f64, height: f64) {
        if outline.is_empty() {
            return;
        }
        let bounds = outline.bounds();
        let rows = raster::heights(bounds.min.y, bounds.max.y, stepover);
        let inner = rows.get(1..rows.len() - 1).unwrap_or_default();
        let mut left: Vec<Vec<[f64; 2]>> = inner.iter().map(|&y| raster::stretches(outline, y)).collect();
        while let Some(first) = left.iter().position(|row| !row.is_empty()) {
            for (row, &y) in inner.iter().enumerate().skip(first) {
                let here = self.here(height).filter(|_| row > first);
                let ends = |[a, b]: [f64; 2]| [Point::new(a, y), Point::new(b, y)];
                // The stretch with the end nearest to the tool, or the first one.
                let chosen = match here {
                    None => (0, false),
                    Some(here) => {
                        let all = left[row].iter().enumerate().flat_map(|(k, &s)| {
                            let [a, b] = ends(s);
                            [(k, false, (a - here).norm()), (k, true, (b - here).norm())]
                        });
                        match all.min_by(|a, b| a.2.total_cmp(&b.2)) {
                            Some((k, turned, _)) => (k, turned),
                            None => break,
                        }
                    }
                };
                let [a, b] = ends(left[row][chosen.0]);
                let (from, to) = if chosen.1 { (b, a) } else { (a, b) };
                let open = |here: Point| (from - here).norm() <= self.join && self.room.has(&Segment::line(here, from));
                if here.is_some_and(|here| !open(here)) {
                    break;
                }
                left[row].remove(chosen.0);
                self.line(from, to, height, height);
            }
        }
    }
}

/// What is cut at the height `z`, in runs without a lift.
fn paths_at(moves: &[Move], z: f64) -> Vec<Vec<Segment>> {
    let mut paths: Vec<Vec<Segment>> = vec![Vec::new()];
    for pair in moves.windows(2) {
        match pair[1].kind {
            MoveKind::Cut(link) if (pair[0].z - z).abs() < SAME_HEIGHT && (pair[1].z - z).abs() < SAME_HEIGHT => {
                if let Some(path) = paths.last_mut() {
                    path.push(Segment { start: pair[0].to, end: pair[1].to, link });
                }
            }
            _ => paths.push(Vec::new()),
        }
    }
    paths.retain(|path| path.iter().any(|s| s.length() > 0.0));
    paths
}
