//! How a closed path is cut: down to every pass, around, over the tabs, and away.

use super::lead::{Lead, Room};
use super::tabs::TabLine;
use super::walk::Walk;
use super::{Entry, Move, MoveKind};
use crate::plane::{Point, Segment, Turn, Vector};

/// Fall of a ramp or a helix over its length: 5.7 degrees, gentle for end mills that do not cut at their centre.
pub(super) const RAMP_SLOPE: f64 = 0.1;

/// The shortest path that is ramped along, in tool diameters: on shorter ones the tool turns on the spot, and a straight
/// plunge loads it no more.
const SHORTEST_RAMPED: f64 = 0.5;

/// The most rounds that a ramp or a helix makes; where a pass would take more, the tool plunges.
const LARGEST_RAMP_ROUNDS: f64 = 50.0;

/// How high above the stock the tool goes from rapid to plunge, in millimetres: sheets are rarely flatter.
pub(super) const APPROACH: f64 = 1.0;

/// Radius of a helix in tool radii, unless the lead's is said: nothing stays standing in its middle.
pub(super) const HELIX_RADIUS: f64 = 0.8;

/// A hole that the tool may go down in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// Its centre.
    pub center: Point,
    /// Its diameter.
    pub diameter: f64,
    /// z of its bottom.
    pub bottom: f64,
    /// z down to which it has its full diameter: above the point of a drill.
    pub full_bottom: f64,
}

/// What was not done as asked, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Notice {
    /// There is no room for a lead.
    LeadSkipped(Point),
    /// There is room only for a lead of this radius.
    LeadShortened(Point, f64),
    /// There is no room for a helix: the tool ramps or plunges.
    HelixSkipped(Point),
    /// No hole of the drawing is wide and deep enough and near by an open way: the tool ramps.
    NoHole(Point),
    /// The path does not come near this corner: it has no relief.
    CornerSkipped(Point),
    /// A flat bottom is cleared with the tip, in paths so far apart.
    BottomCleared(f64),
    /// A shape with its middle here lies wholly on another one and changes nothing.
    Covered(Point),
    /// An open line begins here: it has no inside, and nothing is cut along it.
    OpenLine(Point),
    /// The tab that was asked for at the first place is at the second.
    TabMoved(Point, Point),
    /// A shape with its middle here is no circle and is not drilled.
    NotRound(Point),
    /// The circle here, of this diameter, is wider than the drill: the hole comes out as wide as the drill.
    HoleNarrow(Point, f64),
    /// So many tabs found no place on the path that starts here.
    TabsDropped(Point, usize),
    /// So many outlines have no tabs: the tool clears all that is inside of them, and nothing comes loose.
    NothingToHold(usize),
    /// So many outlines, which the path radius that follows from feed and acceleration would lose, have smaller ones, down to
    /// this, in millimetres.
    PathRadiusEased(usize, f64),
    /// So many tabs stand on tight arcs.
    TabsOnArcs(Point, usize),
}

/// What the cuts of one operation share.
pub(super) struct Laying<'a> {
    /// z of travel.
    pub safe_height: f64,
    /// z where rapid becomes plunge.
    pub approach: f64,
    /// z from which the first pass goes down.
    pub top: f64,
    /// z of every pass, from the top down.
    pub heights: &'a [f64],
    /// How the tool gets down.
    pub entry: Entry,
    /// Diameter of the tool.
    pub tool_diameter: f64,
    /// Most that a pass goes down.
    pub depth_per_pass: f64,
    /// Radius of leads.
    pub lead: Option<f64>,
    /// The side of the path where the waste is.
    pub waste: Turn,
    /// Where the tool may be; none where that is not known, and leads and helices are left out.
    pub room: Option<Room<'a>>,
    /// Holes that are there.
    pub holes: &'a [Hole],
}

/// Appends the moves of one contour.
pub(super) struct Pen<'a> {
    pub moves: &'a mut Vec<Move>,
    pub notices: &'a mut Vec<Notice>,
    /// The number of the contour.
    pub contour: usize,
}

impl Pen<'_> {
    pub(super) fn push(&mut self, to: Point, z: f64, kind: MoveKind) {
        self.moves.push(Move { to, z, kind, contour: self.contour });
    }

    /// Along elements at constant z.
    fn follow(&mut self, elements: &[Segment], z: f64) {
        for s in elements {
            self.push(s.end, z, MoveKind::Cut(s.link));
        }
    }

    /// Along elements, falling evenly.
    fn descend(&mut self, elements: &[Segment], from: f64, to: f64) {
        let whole: f64 = elements.iter().map(Segment::length).sum();
        let mut gone = 0.0;
        for (i, s) in elements.iter().enumerate() {
            gone += s.length();
            let z = if i + 1 == elements.len() { to } else { from + (to - from) * (gone / whole) };
            self.push(s.end, z, MoveKind::Ramp(s.link));
        }
    }
}

/// How the tool gets down for one contour.
enum Descent {
    /// Along the path.
    Ramp,
    /// Round beside the path.
    Helix(Lead),
    /// Straight, where the path starts or beside it.
    Plunge(Option<Lead>),
    /// In a hole.
    Hole(Hole),
}

/// Where the tool leaves a path.
struct Exit {
    /// How far along the path.
    way: f64,
    arc: Segment,
}

impl Laying<'_> {
    /// All passes of a closed path that starts at `start`, from the safe height back to it. A path without elements is a
    /// place to drill.
    pub(super) fn closed(&self, start: Point, path: &[Segment], tabs: &TabLine, pen: &mut Pen) {
        let walk = (!path.is_empty()).then(|| Walk::new(path.to_vec()));
        let descent = self.descent(start, walk.as_ref(), pen.notices);
        let first = match &descent {
            Descent::Plunge(Some(lead)) => lead.arriving().start,
            Descent::Hole(hole) => hole.center,
            _ => start,
        };
        pen.push(first, self.safe_height, MoveKind::Rapid);
        if self.approach < self.safe_height {
            pen.push(first, self.approach, MoveKind::Rapid);
        }
        let Some(walk) = walk else {
            self.heights.iter().for_each(|&height| pen.push(first, height, MoveKind::Plunge));
            pen.push(first, self.safe_height, MoveKind::Rapid);
            return;
        };
        if matches!(descent, Descent::Ramp | Descent::Helix(_)) {
            pen.push(start, self.top, MoveKind::Plunge);
        }
        // Where on the path the tool is.
        let mut way = 0.0;
        let mut above = self.top;
        let exit =
            if matches!(descent, Descent::Plunge(_)) { None } else { self.exit(&walk, &descent, tabs, pen.notices) };
        for (k, &height) in self.heights.iter().enumerate() {
            let is_last = k + 1 == self.heights.len();
            match &descent {
                Descent::Ramp => {
                    let length = (above - height) / RAMP_SLOPE;
                    self.run(&walk, way, length, [above, height], true, tabs, pen);
                    way = (way + length) % walk.length();
                }
                Descent::Helix(lead) => {
                    let rounds = ((above - height) / (lead.circle_length() * RAMP_SLOPE)).ceil().max(1.0) as usize;
                    let turns: Vec<Segment> = (0..rounds).flat_map(|_| lead.circle()).collect();
                    pen.descend(&turns, above, height);
                }
                Descent::Plunge(None) => pen.push(start, height, MoveKind::Plunge),
                Descent::Plunge(Some(lead)) => {
                    if k > 0 {
                        pen.follow(&[lead.returning()], above);
                    }
                    pen.push(first, height, MoveKind::Plunge);
                    pen.follow(&[lead.arriving()], height);
                }
                Descent::Hole(_) => {
                    pen.push(first, height, MoveKind::Plunge);
                    pen.follow(&[Segment::line(first, start)], height);
                }
            }
            let lap = |from: f64, length: f64, pen: &mut Pen| {
                if length > 0.0 {
                    self.run(&walk, from, length, [height, height], false, tabs, pen);
                }
            };
            let length = walk.length();
            match &exit {
                None => lap(way, length, pen),
                // Out on the arc and back in every pass, so that the last one does not meet the full material there.
                Some(exit) => {
                    let before = (exit.way - way).rem_euclid(length);
                    if is_last {
                        // All around, and on to the arc.
                        lap(way, length + before, pen);
                        pen.follow(&[exit.arc], height);
                    } else {
                        lap(way, before, pen);
                        pen.follow(&[exit.arc, exit.arc.reversed()], height);
                        lap(exit.way, length - before, pen);
                    }
                }
            }
            match &descent {
                Descent::Plunge(Some(lead)) => pen.follow(&[lead.leaving()], height),
                Descent::Hole(_) if !is_last => pen.follow(&[Segment::line(start, first)], height),
                _ => {}
            }
            above = height;
        }
        let here = pen.moves.last().map_or(start, |m| m.to);
        pen.push(here, self.safe_height, MoveKind::Rapid);
    }

    /// The arc on which the tool leaves the path behind its last pass, where one is asked for and has room.
    fn exit(&self, walk: &Walk, descent: &Descent, tabs: &TabLine, notices: &mut Vec<Notice>) -> Option<Exit> {
        let (radius, room) = (self.lead?, self.room.as_ref()?);
        let last = self.heights.last().copied()?;
        let end = match descent {
            Descent::Ramp => (self.top - last) / RAMP_SLOPE,
            _ => 0.0,
        };
        let found = tabs.clear_from(end % walk.length(), radius + 0.5 * self.tool_diameter).and_then(|way| {
            let (at, tangent) = (walk.point_at(way), walk.tangent_at(way));
            Lead::find(at, tangent, self.waste, radius, room, |l| vec![l.leaving()]).map(|lead| (way, lead))
        });
        let Some((way, lead)) = found else {
            notices.push(Notice::LeadSkipped(walk.point_at(end)));
            return None;
        };
        if lead.radius < radius {
            notices.push(Notice::LeadShortened(lead.at, lead.radius));
        }
        Some(Exit { way, arc: lead.leaving() })
    }

    fn descent(&self, start: Point, walk: Option<&Walk>, notices: &mut Vec<Notice>) -> Descent {
        let Some(walk) = walk else { return Descent::Plunge(None) };
        let fall = self.depth_per_pass.min(self.top - self.heights.last().copied().unwrap_or(self.top));
        let shortest = (SHORTEST_RAMPED * self.tool_diameter).max(fall / RAMP_SLOPE / LARGEST_RAMP_ROUNDS);
        let ramp = || if walk.length() >= shortest { Descent::Ramp } else { Descent::Plunge(None) };
        let tangent = walk.tangent_at(0.0);
        match self.entry {
            Entry::Ramp => ramp(),
            Entry::Helix => {
                // A wider one leaves a pin in its middle.
                let widest = 0.5 * self.tool_diameter;
                let radius = self.lead.map_or(HELIX_RADIUS * widest, |lead| lead.min(widest));
                let found = self
                    .room
                    .as_ref()
                    .and_then(|room| Lead::find(start, tangent, self.waste, radius, room, |l| l.circle().to_vec()));
                let rounds = |l: &Lead| fall / (l.circle_length() * RAMP_SLOPE);
                match found.filter(|l| rounds(l) <= LARGEST_RAMP_ROUNDS) {
                    Some(lead) => Descent::Helix(lead),
                    None => {
                        notices.push(Notice::HelixSkipped(start));
                        ramp()
                    }
                }
            }
            Entry::Plunge => Descent::Plunge(self.plunge_lead(start, tangent, notices)),
            Entry::Predrilled => match self.hole(start) {
                Some(hole) => Descent::Hole(hole),
                None => {
                    notices.push(Notice::NoHole(start));
                    ramp()
                }
            },
        }
    }

    fn plunge_lead(&self, start: Point, tangent: Vector, notices: &mut Vec<Notice>) -> Option<Lead> {
        let (radius, room) = (self.lead?, self.room.as_ref()?);
        let all = |l: &Lead| vec![l.arriving(), l.leaving(), l.returning()];
        let lead = Lead::find(start, tangent, self.waste, radius, room, all);
        match &lead {
            None => notices.push(Notice::LeadSkipped(start)),
            Some(lead) if lead.radius < radius => notices.push(Notice::LeadShortened(start, lead.radius)),
            Some(_) => {}
        }
        lead
    }

    /// The nearest hole that takes the tool and has an open way to `start`.
    fn hole(&self, start: Point) -> Option<Hole> {
        let room = self.room.as_ref()?;
        let floor = self.heights.last().copied()?;
        let fits = |h: &&Hole| h.diameter >= self.tool_diameter && h.full_bottom <= floor;
        let mut near: Vec<&Hole> = self.holes.iter().filter(fits).collect();
        near.sort_by(|a, b| (a.center - start).norm().total_cmp(&(b.center - start).norm()));
        near.into_iter().find(|h| room.has(&Segment::line(h.center, start))).copied()
    }

    /// Along the path from `way` for `length`, z going evenly from one height to the other, but over the tabs.
    #[expect(clippy::too_many_arguments, reason = "a stretch, its heights, and what stands in its way")]
    fn run(&self, walk: &Walk, way: f64, length: f64, z: [f64; 2], falling: bool, tabs: &TabLine, pen: &mut Pen) {
        if tabs.count() == 0 {
            let elements = walk.stretch(way, length);
            if falling {
                pen.descend(&elements, z[0], z[1]);
            } else {
                pen.follow(&elements, z[1]);
            }
            return;
        }
        let mut stops = vec![way];
        stops.extend(tabs.bends(way, length));
        stops.push(way + length);
        let height = |at: f64| (z[0] + (z[1] - z[0]) * ((at - way) / length)).max(tabs.lowest(at));
        for pair in stops.windows(2) {
            let (from, to) = (height(pair[0]), height(pair[1]));
            // Down a tab's flank the tool goes into the full material, as on a ramp.
            let kind = |s: &Segment| if falling || to < from { MoveKind::Ramp(s.link) } else { MoveKind::Cut(s.link) };
            let elements = walk.stretch(pair[0] % walk.length(), pair[1] - pair[0]);
            let whole: f64 = elements.iter().map(Segment::length).sum();
            let mut gone = 0.0;
            for s in &elements {
                gone += s.length();
                pen.push(s.end, from + (to - from) * (gone / whole), kind(s));
            }
        }
    }
}

impl Lead {
    fn circle_length(&self) -> f64 {
        std::f64::consts::TAU * self.radius
    }
}
