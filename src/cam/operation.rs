//! Operations: from shapes to what one tool does with them.
//!
//! All geometry is in millimetres and in the machine's coordinates. Every operation says what must remain, so that the
//! program, read back, can be held against it.

mod chamfer;
mod drill;
mod engrave;
mod facing;
mod finish;
mod pocket;
mod profile;
mod raster;
mod relief;
mod rest;
mod spurs;
mod v_carve;

pub use drill::circle;

use super::lay::{APPROACH, Laying};
use super::lead::Room;
use super::{
    ChamferError, Contour, Corners, Cutting, Direction, Hole, Move, MoveKind, Notice, OffsetError, Operation,
    OperationKind, PathRadius, Remainder, Settings, Setup, Side, Tool, Toolpath, close_for_path, fit_arcs, offset,
};
use crate::plane::{Point, Region, Ring, Turn, Vector};
use crate::rolling::{self, Topology};
use crate::units::Radius;

/// A line to follow.
#[derive(Clone, Debug, PartialEq)]
pub struct CutLine {
    /// Its elements. Of an open line the last element, which leads back to its start, is no part.
    pub ring: Ring,
    /// Whether it ends where it starts.
    pub is_closed: bool,
}

/// The shapes that an operation is done to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Geometry {
    /// What they fill, united.
    pub area: Region,
    /// What they stroke.
    pub lines: Vec<CutLine>,
    /// Holes that earlier operations have drilled.
    pub holes: Vec<Hole>,
    /// Parts beside the shapes that other operations cut out: they must not be touched.
    pub others: Region,
}

/// What an operation must not touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Keep {
    /// The shapes as they are drawn.
    pub part: Region,
    /// The boundary that the cut is meant to have, with the drawing's solid on its left.
    pub kept: Region,
    /// Which side of it remains.
    pub remainder: Remainder,
    /// How far the tool's centre keeps from it.
    pub distance: f64,
    /// z of the floor.
    pub floor: f64,
    /// Parts beside the shapes that other operations cut out.
    pub others: Region,
}

/// A tab that was placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabPlace {
    /// Its middle, on the path.
    pub at: Point,
    /// z of the tool over it.
    pub top: f64,
}

/// What an operation came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// What the tool does.
    pub toolpath: Toolpath,
    /// What must remain, where that is a region.
    pub keep: Option<Keep>,
    /// What was not done as asked.
    pub notices: Vec<Notice>,
    /// The tabs.
    pub tabs: Vec<TabPlace>,
    /// The holes.
    pub holes: Vec<Hole>,
    /// How many places of the path rest on two findings that contradict each other.
    pub contradictions: usize,
}

/// Why an operation cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OperationError {
    /// The outline has no offset by the tool.
    #[error(transparent)]
    Offset(#[from] OffsetError),
    /// The shapes have no area.
    #[error("the shapes it is done to fill nothing: give them a fill, or engrave their lines")]
    NoArea,
    /// Nothing is left to cut.
    #[error("there is nothing to cut: the tool, {diameter} mm, is too large for the shapes")]
    TooLarge {
        /// Diameter of the tool.
        diameter: f64,
    },
    /// The larger tool has left nothing.
    #[error("the larger tool has left nothing that this one, {diameter} mm, could reach")]
    NothingLeft {
        /// Diameter of the tool.
        diameter: f64,
    },
    /// There are no lines and no outlines.
    #[error("there is no line to follow")]
    NoLines,
    /// No circle among the shapes.
    #[error("there is no circle to drill: holes are circles, or shapes with circular holes")]
    NoCircles,
    /// A circle that the tool does not fit into.
    #[error(
        "the hole of {hole:.3} mm at ({:.3}, {:.3}) is smaller than the tool, {diameter} mm: take a smaller tool", at.x, at.y
    )]
    HoleTooSmall {
        /// Its centre.
        at: Point,
        /// Its diameter.
        hole: f64,
        /// Diameter of the tool.
        diameter: f64,
    },
    /// A cone that cannot make the chamfer.
    #[error(transparent)]
    Chamfer(#[from] ChamferError),
    /// A cone that would go through the stock.
    #[error(
        "the tip would go {depth:.3} mm deep, and the stock is {thickness} mm thick: take a cone with a wider angle, or less width \
         or max-depth"
    )]
    ThroughStock {
        /// How deep it would go.
        depth: f64,
        /// How thick the stock is.
        thickness: f64,
    },
    /// Neither stock nor shapes have a size.
    #[error("facing needs the width and height of the stock, or shapes")]
    NothingToFace,
    /// Carving failed.
    #[error("{0}")]
    Carving(String),
}

/// The way of `operation` over `geometry`.
///
/// # Errors
/// Where there is nothing to do, or the tool is too large.
pub fn plan_operation(setup: &Setup, operation: &Operation, geometry: &Geometry) -> Result<Planned, OperationError> {
    let work = Work::new(setup, operation);
    let goes_around = matches!(operation.kind, OperationKind::Profile { .. } | OperationKind::Pocket { .. });
    if goes_around && work.tool.diameter > geometry.area.bounds().diagonal() && !geometry.area.is_empty() {
        return Err(OperationError::TooLarge { diameter: work.tool.diameter });
    }
    match &operation.kind {
        OperationKind::Profile { side, rest_of: Some(larger), .. } => rest::plan(
            &work,
            geometry,
            *side,
            Larger::new(setup, operation, *larger),
            REST_STEPOVER * work.tool.diameter,
        ),
        OperationKind::Profile { side, corners, rest_of: None } => profile::plan(&work, geometry, *side, *corners),
        OperationKind::Pocket { stepover, rest_of: Some(larger), .. } => {
            rest::plan(&work, geometry, Side::Inside, Larger::new(setup, operation, *larger), *stepover)
        }
        OperationKind::Pocket { pattern, stepover, corners, rest_of: None } => {
            pocket::plan(&work, geometry, *pattern, *stepover, *corners)
        }
        OperationKind::Drill { peck } => drill::plan(&work, geometry, *peck),
        OperationKind::Engrave => engrave::plan(&work, geometry),
        OperationKind::VCarve { max_depth } => v_carve::plan(&work, geometry, *max_depth),
        OperationKind::Facing { stepover } => facing::plan(&work, geometry, *stepover),
        OperationKind::Chamfer { side, width } => chamfer::plan(&work, geometry, *side, *width),
    }
}

/// Distance between the paths of a profile's rest, in tool diameters.
const REST_STEPOVER: f64 = 0.4;

/// An earlier tool by which what stays was closed.
#[derive(Clone, Copy, Debug)]
struct Larger {
    radius: f64,
    path_radius: f64,
    eases: bool,
}

impl Larger {
    fn new(setup: &Setup, operation: &Operation, diameter: f64) -> Larger {
        let acceleration = setup.rig.limits.acceleration[0].min(setup.rig.limits.acceleration[1]);
        let earlier = setup.operations.iter().filter(|o| o.line < operation.line);
        let used = earlier.filter(|o| setup.tool_of(o).diameter == diameter);
        let path = |o: &Operation| (o.cutting.path_radius_mm(acceleration), o.cutting.path_radius == PathRadius::Auto);
        let (path_radius, eases) = used.map(path).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(path(operation));
        Larger { radius: 0.5 * diameter, path_radius, eases }
    }
}

/// An operation with all that it takes from the job.
struct Work<'a> {
    setup: &'a Setup,
    tool: &'a Tool,
    cutting: &'a Cutting,
    /// z of the top of the stock.
    stock_top: f64,
    /// z from which it starts.
    top: f64,
    /// z where it ends.
    floor: f64,
    /// z of what tabs and skins stand on.
    base: f64,
    path_radius: f64,
}

impl<'a> Work<'a> {
    fn new(setup: &'a Setup, operation: &'a Operation) -> Work<'a> {
        let cutting = &operation.cutting;
        let acceleration = setup.rig.limits.acceleration[0].min(setup.rig.limits.acceleration[1]);
        Work {
            setup,
            tool: setup.tool_of(operation),
            cutting,
            stock_top: setup.stock.top,
            top: setup.stock.top - cutting.start_depth,
            floor: setup.stock.top - cutting.depth,
            base: cutting.base(&setup.stock),
            path_radius: cutting.path_radius_mm(acceleration),
        }
    }

    /// z where rapid becomes plunge: above the stock, wherever the operation starts; whether others have cleared the way is not
    /// known.
    fn approach(&self) -> f64 {
        self.stock_top + APPROACH
    }

    fn settings(&self) -> Settings {
        Settings {
            feed: self.cutting.feed,
            plunge_feed: self.cutting.plunge_feed,
            spindle_speed: self.cutting.spindle_speed,
            dwell: self.setup.rig.dwell,
            safe_height: self.setup.rig.safe_height,
        }
    }

    /// Whether rings that have what remains on their left are travelled backwards: a spindle that turns clockwise climbs
    /// with the part on its right.
    fn backwards(&self) -> bool {
        self.cutting.direction == Direction::Climb
    }

    fn part_side(&self) -> Turn {
        if self.backwards() { Turn::Right } else { Turn::Left }
    }

    /// Refuses cones whose tip would go through the stock.
    fn stays_in_stock(&self, depth: f64) -> Result<(), OperationError> {
        match self.setup.stock.thickness {
            Some(thickness) if self.cutting.start_depth + depth > thickness => {
                Err(OperationError::ThroughStock { depth: self.cutting.start_depth + depth, thickness })
            }
            _ => Ok(()),
        }
    }

    /// The toolpath of `moves`, which begin with a rapid to the safe height.
    fn toolpath(&self, moves: Vec<Move>, contour_count: usize) -> Toolpath {
        Toolpath {
            settings: self.settings(),
            moves,
            contour_count,
            part_side: self.part_side(),
            translation: Vector::zeros(),
        }
    }

    /// The first move: to the safe height, at an unknown place.
    fn first_moves(&self) -> Vec<Move> {
        vec![Move { to: Point::origin(), z: self.setup.rig.safe_height, kind: MoveKind::Rapid, contour: 0 }]
    }

    fn laying<'b>(&'b self, top: f64, heights: &'b [f64], room: Option<Room<'b>>, holes: &'b [Hole]) -> Laying<'b> {
        Laying {
            safe_height: self.setup.rig.safe_height,
            approach: self.approach(),
            top,
            heights,
            entry: self.cutting.entry,
            tool_diameter: self.tool.diameter,
            depth_per_pass: self.cutting.depth_per_pass,
            lead: self.cutting.lead,
            waste: self.part_side().opposite(),
            room,
            holes,
        }
    }

    /// Contours of rings that have what remains on their left, in the direction of travel.
    fn contours(&self, rings: &Region) -> Vec<Contour> {
        self.contours_of(&fitted(rings))
    }

    /// The same of rings that have their arcs already.
    fn contours_of(&self, fitted: &Region) -> Vec<Contour> {
        fitted.rings.iter().filter_map(|ring| Contour::new(ring.clone(), self.backwards())).collect()
    }
}

/// Rings with arcs in place of chords.
fn fitted(rings: &Region) -> Region {
    Region::new(rings.rings.iter().map(fit_arcs).collect())
}

/// What stays, closed so that the tool's centre has a path at `distance` with the path radius, and that path.
#[derive(Clone, Debug)]
struct Level {
    closed: Region,
    path: Region,
    contradictions: usize,
}

impl Level {
    fn new(stays: &Region, distance: f64, path_radius: f64, topology: Topology) -> Result<Level, OffsetError> {
        let Ok(radius) = Radius::new(distance + path_radius) else {
            return Ok(Level { closed: stays.clone(), path: stays.clone(), contradictions: 0 });
        };
        let outcome = rolling::close(stays, radius, topology);
        let path = offset(&outcome.region, distance)?;
        Ok(Level { closed: outcome.region, path, contradictions: outcome.contradictions })
    }

    /// The level beside the outlines themselves: none of those that the tool can cut is lost to a path radius that nobody asked
    /// for, which is told.
    fn beside_outlines(
        work: &Work,
        stays: &Region,
        distance: f64,
        notices: &mut Vec<Notice>,
    ) -> Result<Level, OffsetError> {
        let eases = work.cutting.path_radius == PathRadius::Auto;
        let closed = close_for_path(stays, distance, work.path_radius, eases, work.cutting.topology);
        notices.extend(closed.eased.map(|(count, least)| Notice::PathRadiusEased(count, least)));
        let path = offset(&closed.region, distance)?;
        Ok(Level { closed: closed.region, path, contradictions: closed.contradictions })
    }
}
