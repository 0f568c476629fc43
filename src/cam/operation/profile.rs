//! Along outlines, outside, inside or on them.

use super::finish::Walls;
use super::relief::{insert, reliefs, relieved};
use super::{Corners, Geometry, Keep, OperationError, Planned, TabPlace, Work, fitted};
use crate::cam::lay::{Notice, Pen};
use crate::cam::lead::Room;
use crate::cam::order::order;
use crate::cam::solid::Solid;
use crate::cam::tabs::TabLine;
use crate::cam::walk::Walk;
use crate::cam::{Contour, Remainder, Side};
use crate::plane::{Point, Region};

pub(super) fn plan(work: &Work, geometry: &Geometry, side: Side, corners: Corners) -> Result<Planned, OperationError> {
    if geometry.area.is_empty() {
        return Err(OperationError::NoArea);
    }
    let stays = side.kept_material(&geometry.area);
    let distance = if side == Side::On { 0.0 } else { work.tool.radius() };
    let final_level = work.level(&stays, distance)?;
    let rough = match work.cutting.allowance {
        allowance if allowance > 0.0 && side != Side::On => Some(work.level(&stays, distance + allowance)?),
        _ => None,
    };
    let mut cuts = Cuts::new(work, geometry, &final_level.closed, distance, side);
    let heights = work.cutting.pass_heights(work.stock_top);
    let skin = work.cutting.onion_skin.map(|skin| work.floor + skin);
    // Everything down to the skin, if there is one; then the walls; then the skin.
    let above_skin: Vec<f64> = match skin {
        Some(skin) => heights.iter().copied().filter(|h| *h > skin).chain([skin]).collect(),
        None => heights.clone(),
    };
    let mut path = fitted(&final_level.path);
    let corners = if side == Side::On { Corners::Round } else { corners };
    let reliefs = reliefs(&stays, corners, work.tool.radius(), work.path_radius, &mut cuts.notices);
    let ways = insert(&mut path, &reliefs, &mut cuts.notices);
    let contours = work.contours_of(&path);
    match &rough {
        Some(rough) => {
            cuts.all(&work.contours(&rough.path), work.top, &above_skin, true);
            if work.cutting.finish {
                let walls = Walls::new(work, contours.clone(), &rough.path);
                let floor = above_skin.last().copied().unwrap_or(work.floor);
                cuts.all(&walls.roughed, work.top, &Walls::heights(work, floor), skin.is_none());
                cuts.all(&walls.full, work.top, &above_skin, skin.is_none());
            }
        }
        None => cuts.all(&contours, work.top, &above_skin, true),
    }
    if let Some(skin) = skin {
        cuts.all(&contours, skin, &[work.floor], true);
    }
    if cuts.count == 0 {
        return Err(OperationError::TooLarge { diameter: work.tool.diameter });
    }
    let is_finished = rough.is_none() || work.cutting.finish;
    let shape = if is_finished { final_level } else { rough.unwrap_or(final_level) };
    let (kept, remainder) = match side {
        Side::Outside | Side::On => (shape.closed, Remainder::Inside),
        Side::Inside => (shape.closed.reversed(), Remainder::Outside),
    };
    let part = relieved(&geometry.area, remainder, &ways, work.tool.radius());
    let kept = relieved(&kept, remainder, &ways, work.tool.radius());
    let keep = Keep { part, kept, remainder, distance, floor: work.floor };
    Ok(Planned {
        toolpath: work.toolpath(cuts.moves, cuts.count),
        keep: Some(keep),
        notices: cuts.notices,
        tabs: cuts.tabs,
        holes: Vec::new(),
        contradictions: shape.contradictions,
    })
}

/// The moves of a profile as they grow.
struct Cuts<'a> {
    work: &'a Work<'a>,
    geometry: &'a Geometry,
    solid: Solid,
    distance: f64,
    has_room: bool,
    moves: Vec<crate::cam::Move>,
    notices: Vec<Notice>,
    tabs: Vec<TabPlace>,
    count: usize,
}

impl<'a> Cuts<'a> {
    fn new(work: &'a Work, geometry: &'a Geometry, closed: &Region, distance: f64, side: Side) -> Cuts<'a> {
        Cuts {
            work,
            geometry,
            solid: side.solid(closed),
            distance,
            has_room: side != Side::On,
            moves: work.first_moves(),
            notices: Vec::new(),
            tabs: Vec::new(),
            count: 0,
        }
    }

    /// All contours in a good order, each down to the last height. Tabs are told of once.
    fn all(&mut self, contours: &[Contour], top: f64, heights: &[f64], tells: bool) {
        let room = self.has_room.then_some(Room { solid: &self.solid, distance: self.distance });
        let laying = self.work.laying(top, heights, room, &self.geometry.holes);
        for stop in order(contours, Point::origin()) {
            let contour = &contours[stop.contour];
            let entry = contour.entries[stop.entry];
            let path = contour.around_from(&entry);
            let mut tabs = TabLine::default();
            if let Some(asked) = self.work.cutting.tabs.as_ref().filter(|_| !path.is_empty()) {
                let walk = Walk::new(path.clone());
                let placed =
                    TabLine::place(asked, &walk, self.work.floor, self.work.tool.diameter, self.work.tool.radius());
                if tells {
                    let top = self.work.floor + asked.height;
                    self.tabs.extend(placed.line.points(&walk).into_iter().map(|at| TabPlace { at, top }));
                    let missing = placed.asked - placed.line.count();
                    if missing > 0 {
                        self.notices.push(Notice::TabsDropped(entry.point, missing));
                    }
                    if placed.on_arcs > 0 {
                        self.notices.push(Notice::TabsOnArcs(entry.point, placed.on_arcs));
                    }
                }
                tabs = placed.line;
            }
            let mut pen = Pen { moves: &mut self.moves, notices: &mut self.notices, contour: self.count };
            laying.closed(entry.point, &path, &tabs, &mut pen);
            self.count += 1;
        }
    }
}
