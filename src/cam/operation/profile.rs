//! Along outlines, outside, inside or on them.

use super::finish::Roughing;
use super::relief::{insert, insert_ways, reliefs, relieved};
use super::{Corners, Geometry, Keep, Level, OperationError, Planned, TabPlace, Work, fitted};
use crate::cam::entry::EntryPlace;
use crate::cam::lay::{HELIX_RADIUS, Notice, Pen};
use crate::cam::lead::Room;
use crate::cam::order::order;
use crate::cam::solid::Solid;
use crate::cam::strands::Strands;
use crate::cam::tabs::{Ground, TabLine};
use crate::cam::walk::Walk;
use crate::cam::{Contour, Entry, Remainder, Side, TabPlaces, Tabs};
use crate::plane::{Joint, Link, Point, Region, Ring, Segment, Vertex, inscribed_circle};

pub(super) fn plan(work: &Work, geometry: &Geometry, side: Side, corners: Corners) -> Result<Planned, OperationError> {
    if geometry.area.is_empty() {
        return Err(OperationError::NoArea);
    }
    let stays = side.kept_material(&geometry.area);
    let distance = if side == Side::On { 0.0 } else { work.tool.radius() };
    let mut notices = Vec::new();
    let final_level = Level::beside_outlines(work, &stays, distance, &mut notices)?;
    let rough = match work.cutting.allowance {
        allowance if allowance > 0.0 && side != Side::On => {
            Some(Level::beside_outlines(work, &stays, distance + allowance, &mut Vec::new())?)
        }
        _ => None,
    };
    let mut cuts = Cuts::new(work, geometry, &final_level.closed, distance, side);
    cuts.notices = notices;
    let heights = work.cutting.pass_heights(work.stock_top);
    let skin = work.cutting.onion_skin.map(|skin| work.base + skin);
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
    let asked = work.cutting.tabs.as_ref();
    let routes = match &rough {
        None => {
            let routes = cuts.routes(&contours, asked);
            cuts.cut(&routes, work.top, &above_skin);
            routes
        }
        Some(rough) if work.cutting.finish => {
            let mut path = fitted(&rough.path);
            insert_ways(&mut path, &ways, Roughing::reach(work));
            let rough = work.contours_of(&path);
            let finals = cuts.routes(&contours, asked);
            let before = cuts.routes_beside(&rough, asked, &finals);
            let roughing = Roughing::new(work, &rough);
            let floor = above_skin.last().copied().unwrap_or(work.floor);
            // Walls that the roughing has been beside: one pass, as deep as the flutes are long.
            let at_once = steps(work.top, floor, work.tool.flute_length);
            let mut is_roughed = vec![false; before.len()];
            // Every wall with its roughing, so that what is inside of a part is done before the part is loose.
            for route in &finals {
                let Some(beside) = roughing.beside(route.start, &route.path) else {
                    cuts.cut(std::slice::from_ref(route), work.top, &above_skin);
                    continue;
                };
                for k in beside {
                    if !std::mem::replace(&mut is_roughed[k], true) {
                        cuts.cut(&before[k..=k], work.top, &above_skin);
                    }
                }
                cuts.finish(std::slice::from_ref(route), work.top, &at_once);
            }
            finals
        }
        Some(rough) => {
            let mut path = fitted(&rough.path);
            insert_ways(&mut path, &ways, Roughing::reach(work));
            let routes = cuts.routes(&work.contours_of(&path), asked);
            cuts.cut(&routes, work.top, &above_skin);
            routes
        }
    };
    if let Some(skin) = skin {
        cuts.cut(&routes, skin, &steps(skin, work.floor, work.cutting.depth_per_pass));
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
    let keep = Keep { part, kept, remainder, distance, floor: work.floor, others: geometry.others.clone() };
    Ok(Planned {
        toolpath: work.toolpath(cuts.moves, cuts.count),
        keep: Some(keep),
        notices: cuts.notices,
        tabs: cuts.tabs,
        holes: Vec::new(),
        contradictions: shape.contradictions,
    })
}

/// z of even passes from `top` down to `floor`, none thicker than `thickest`.
pub(super) fn steps(top: f64, floor: f64, thickest: f64) -> Vec<f64> {
    let depth = top - floor;
    let count = (depth / thickest).ceil().max(1.0) as usize;
    (1..=count).map(|k| top - depth * (k as f64 / count as f64)).collect()
}

/// The moves of a profile as they grow.
struct Cuts<'a> {
    work: &'a Work<'a>,
    geometry: &'a Geometry,
    solid: Solid,
    others: Solid,
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
            others: Solid::new(&geometry.others, Remainder::Inside),
            distance,
            has_room: side != Side::On,
            moves: work.first_moves(),
            notices: Vec::new(),
            tabs: Vec::new(),
            count: 0,
        }
    }

    /// The ways along all contours in a good order, with tabs, of which the words are told.
    fn routes(&mut self, contours: &[Contour], asked: Option<&Tabs>) -> Vec<Route> {
        let cleared = asked.map(|asked| self.off_tabs(contours, asked));
        let contours = cleared.as_deref().unwrap_or(contours);
        let stops = order(contours, Point::origin());
        let starts = stops.iter().map(|stop| (&contours[stop.contour], contours[stop.contour].entries[stop.entry]));
        let mut routes: Vec<Route> = starts.map(|(contour, entry)| Route::new(contour, &entry)).collect();
        let Some(asked) = asked else { return routes };
        let mut strands = Strands::default();
        routes.iter().enumerate().for_each(|(k, route)| strands.add(k, &route.path));
        let ground = self.ground(&strands);
        let by_place = matches!(asked.places, TabPlaces::At(_));
        // A ball is narrower where the stock ends.
        let radius = self.work.tool.radius_at(self.work.base - self.work.floor);
        let nothing_loose: Vec<bool> =
            routes.iter().map(|route| !by_place && clears_its_inside(&route.path, radius)).collect();
        let cleared = nothing_loose.iter().filter(|is| **is).count();
        self.notices.extend((cleared > 0).then_some(Notice::NothingToHold(cleared)));
        let (each, astray) = shared_out(asked, &routes, ASTRAY * self.work.tool.diameter);
        self.notices.extend(astray.into_iter().map(|p| Notice::TabsDropped(p, 1)));
        for (k, route) in routes.iter_mut().enumerate() {
            if route.path.is_empty() || nothing_loose[k] {
                continue;
            }
            let walk = Walk::new(route.path.clone());
            let placed = TabLine::place(&each[k], &walk, k, &ground);
            let missing = placed.asked - placed.line.count();
            if missing > 0 {
                self.notices.push(Notice::TabsDropped(route.start, missing));
            }
            self.notices.extend(placed.moved.iter().map(|&[asked, got]| Notice::TabMoved(asked, got)));
            if placed.on_arcs > 0 {
                self.notices.push(Notice::TabsOnArcs(route.start, placed.on_arcs));
            }
            let top = self.work.base + asked.height;
            route.middles = placed.line.points(&walk);
            self.tabs.extend(route.middles.iter().map(|&at| TabPlace { at, top }));
            route.tabs = placed.line;
        }
        routes
    }

    /// The contours, entered where tabs are not asked for by their places: as far from those as can be, where none is far enough.
    fn off_tabs(&self, contours: &[Contour], asked: &Tabs) -> Vec<Contour> {
        let TabPlaces::At(points) = &asked.places else { return contours.to_vec() };
        let strands = Strands::default();
        let clearance = self.ground(&strands).clearance(asked);
        let reach = ASTRAY * self.work.tool.diameter;
        let off = |contour: &Contour| {
            let on_path = |p: &[f64; 2]| {
                let nearest = contour.nearest_entry(Point::new(p[0], p[1]))?.point;
                ((nearest - Point::new(p[0], p[1])).norm() <= reach).then_some(nearest)
            };
            let tabs: Vec<Point> = points.iter().filter_map(on_path).collect();
            let apart = |e: &EntryPlace| tabs.iter().map(|t| (e.point - t).norm()).fold(f64::INFINITY, f64::min);
            let mut entries: Vec<EntryPlace> =
                contour.entries.iter().copied().filter(|e| apart(e) >= clearance).collect();
            if entries.is_empty() && !contour.is_point() {
                // Between the tabs, on a straight piece if there is one.
                let walk = Walk::new(contour.path.segments().collect());
                let place = |k: usize| contour.nearest_entry(walk.point_at(walk.length() * k as f64 / ENTRIES as f64));
                let places: Vec<EntryPlace> = (0..ENTRIES).filter_map(place).collect();
                let is_straight = |e: &EntryPlace| matches!(contour.path.segment(e.element).link, Link::Line);
                let farthest = |among: &mut dyn Iterator<Item = &EntryPlace>| {
                    among.copied().max_by(|a, b| apart(a).total_cmp(&apart(b)))
                };
                let straight =
                    farthest(&mut places.iter().filter(|e| is_straight(e))).filter(|e| apart(e) >= clearance);
                entries.extend(straight.or_else(|| farthest(&mut places.iter().chain(&contour.entries))));
            }
            Contour { entries, path: contour.path.clone() }
        };
        contours.iter().map(off).collect()
    }

    /// The ways along contours beside `finals`: they start where those start, and pass over the same tabs.
    fn routes_beside(&self, contours: &[Contour], asked: Option<&Tabs>, finals: &[Route]) -> Vec<Route> {
        let nearest = |p: Point| {
            let distances =
                contours.iter().map(|c| c.path.segments().map(|s| s.nearest(p).distance).fold(f64::MAX, f64::min));
            distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
        };
        let starts: Vec<(Option<usize>, Point)> = finals.iter().map(|r| (nearest(r.start), r.start)).collect();
        let middles = finals.iter().flat_map(|route| route.middles.iter());
        let middles: Vec<(Option<usize>, Point)> = middles.map(|&p| (nearest(p), p)).collect();
        let strands = Strands::default();
        let ground = self.ground(&strands);
        let route = |(k, contour): (usize, &Contour)| {
            let own = |points: &[(Option<usize>, Point)]| -> Vec<Point> {
                points.iter().filter(|(near, _)| *near == Some(k)).map(|(_, p)| *p).collect()
            };
            let start = own(&starts).first().and_then(|&p| contour.nearest_entry(p));
            let mut route = Route::new(contour, &start.unwrap_or(contour.entries[0]));
            if let Some(asked) = asked.filter(|_| !route.path.is_empty()) {
                let walk = Walk::new(route.path.clone());
                route.tabs = TabLine::beside(asked, &walk, &own(&middles), &ground);
            }
            route
        };
        contours.iter().enumerate().map(route).collect()
    }

    fn ground<'b>(&self, strands: &'b Strands) -> Ground<'b> {
        let tool = self.work.tool;
        // What the tool takes beside the start on its way down and up.
        let beside = match self.work.cutting.entry {
            Entry::Helix => self.work.cutting.lead.unwrap_or(HELIX_RADIUS * tool.radius()),
            _ => self.work.cutting.lead.unwrap_or(0.0),
        };
        Ground {
            base: self.work.base,
            floor: self.work.floor,
            tool_diameter: tool.diameter,
            seam: tool.radius() + beside,
            allowance: self.work.cutting.allowance,
            waste: self.work.part_side().opposite(),
            strands,
        }
    }

    /// Every way down to the last height.
    fn cut(&mut self, routes: &[Route], top: f64, heights: &[f64]) {
        self.cut_with(routes, top, heights, self.work.cutting.lead);
    }

    /// The same of walls that have been roughed: leads stay where the roughing has been.
    fn finish(&mut self, routes: &[Route], top: f64, heights: &[f64]) {
        self.cut_with(routes, top, heights, self.work.cutting.lead.map(|lead| lead.min(self.work.cutting.allowance)));
    }

    fn cut_with(&mut self, routes: &[Route], top: f64, heights: &[f64], lead: Option<f64>) {
        let middles: Vec<Point> = self.tabs.iter().map(|tab| tab.at).collect();
        let room = Room { solid: &self.solid, distance: self.distance, others: Some(&self.others), tabs: &middles };
        let mut laying = self.work.laying(top, heights, self.has_room.then_some(room), &self.geometry.holes);
        laying.lead = lead;
        for route in routes {
            let mut pen = Pen { moves: &mut self.moves, notices: &mut self.notices, contour: self.count };
            laying.closed(route.start, &route.path, &route.tabs, &mut pen);
            self.count += 1;
        }
    }
}

/// Whether a tool along a closed path takes all that is inside of it.
fn clears_its_inside(path: &[Segment], radius: f64) -> bool {
    let vertex = |s: &Segment| Vertex { point: s.start, link: s.link, joint: Joint::Corner, id: None };
    let ring = Ring { vertices: path.iter().map(vertex).collect() };
    let length: f64 = path.iter().map(Segment::length).sum();
    // What is nearer to a closed path than the radius has at most this area on one side of it.
    if path.is_empty() || ring.area().abs() >= length * radius {
        return false;
    }
    let inside = if ring.area() < 0.0 { ring.reversed() } else { ring };
    inscribed_circle(&Region::new(vec![inside])).at_most < radius
}

/// So many places along a path are looked at for one between tabs where it can be entered.
const ENTRIES: usize = 64;

/// How far from a path, in tool diameters, a place for a tab may be: the outline itself is half of one away.
const ASTRAY: f64 = 2.0;

/// What every path is asked for: of places that are named those that it is the nearest to; and the places that are farther than
/// `reach` from all.
fn shared_out(asked: &Tabs, routes: &[Route], reach: f64) -> (Vec<Tabs>, Vec<Point>) {
    let TabPlaces::At(points) = &asked.places else { return (vec![asked.clone(); routes.len()], Vec::new()) };
    let mut own: Vec<Vec<[f64; 2]>> = vec![Vec::new(); routes.len()];
    let mut astray = Vec::new();
    for &[x, y] in points {
        let p = Point::new(x, y);
        let distance = |route: &Route| route.path.iter().map(|s| s.nearest(p).distance).fold(f64::INFINITY, f64::min);
        let all = routes.iter().map(distance).enumerate();
        match all.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, distance)| *distance <= reach) {
            Some((k, _)) => own[k].push([x, y]),
            None => astray.push(p),
        }
    }
    (own.into_iter().map(|at| Tabs { places: TabPlaces::At(at), ..asked.clone() }).collect(), astray)
}

/// The way around one contour.
struct Route {
    start: Point,
    /// From the start to the start; empty for a place to drill.
    path: Vec<Segment>,
    tabs: TabLine,
    /// The middles of its tabs.
    middles: Vec<Point>,
}

impl Route {
    fn new(contour: &Contour, entry: &EntryPlace) -> Route {
        Route { start: entry.point, path: contour.around_from(entry), tabs: TabLine::default(), middles: Vec::new() }
    }
}
