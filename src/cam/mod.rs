//! From a closed region to the moves of a tool, and from the moves of a program back to what they cut.
//!
//! A [`Job`] says what to cut and how. Its [`Side`] says which region has to be closed, and by how much; the closing
//! itself is not made here. [`plan`] takes the closed region and gives a [`Toolpath`]: the exact [`offset`] of the
//! boundary, runs of chords joined to arcs ([`fit_arcs`]), contours in an order that never frees a piece before its
//! inside is done, entries away from corners, passes by depth. [`certify`] takes a program as it was read back and tells
//! what it does to the part.
//!
//! Guaranteed: the tool's centre keeps the tool's radius from the closed region, up to [`ARC_FIT_TOLERANCE`]; it travels
//! in x and y only at the safe height; it enters the stock only by a ramp or a straight plunge at the plunge feed.
//! Refused: regions with concave features tighter than the tool, jobs with values that make no sense.

mod against;
mod certificate;
mod chamfer;
mod closing;
mod cone_gouge;
mod contour;
mod entry;
mod event;
mod feeds;
mod fit;
mod gouge;
mod height_map;
mod islands;
mod job;
mod job_file;
mod keepout;
mod lay;
mod lead;
mod leftover;
mod levels;
mod loose;
mod motion;
mod nearest_next;
mod offset;
mod operation;
mod operation_check;
mod operation_run;
mod order;
mod path_radius;
mod plan;
mod removal;
mod sequence;
mod setup;
mod side;
mod simplify;
mod simulate;
mod solid;
mod stock;
mod stock_surface;
mod strands;
mod stroke;
mod sweep;
mod swept;
mod tabs;
#[cfg(test)]
pub(crate) mod test_shapes;
mod time;
mod time_saved;
mod tool;
mod tool_table;
mod tool_text;
mod toolpath;
mod v_carve;
mod walk;

pub use against::{Against, AgainstOptions, against};
pub use certificate::{Certificate, CertifyOptions, CutBox, ProgramStatistics, certify, statistics};
pub use chamfer::{Chamfer, ChamferError, chamfer_depth};
pub use closing::{ClosedForPath, close_for_path};
pub use cone_gouge::deepest_carving;
pub use contour::Contour;
pub use event::{Event, EventKind};
pub use fit::{ARC_FIT_TOLERANCE, fit_arcs};
pub use gouge::{Gouge, deepest_cut};
pub use height_map::{CHORD_TOLERANCE, HeightMap, MapError};
pub use islands::{Island, islands};
pub use job::{
    DEFAULT_ACCELERATION, DEFAULT_DEPTH, DEFAULT_DEPTH_PER_PASS, DEFAULT_DIRECTION, DEFAULT_DWELL, DEFAULT_ENTRY,
    DEFAULT_FEED, DEFAULT_ORIGIN, DEFAULT_PATH_RADIUS, DEFAULT_PLUNGE_FEED, DEFAULT_SAFE_CLEARANCE, DEFAULT_SIDE,
    DEFAULT_SPINDLE_SPEED, DEFAULT_STOCK_TOP, DEFAULT_TOOL_DIAMETER, Direction, Entry, InvalidJob, Job, JobProblem,
    Origin, PathRadius,
};
pub use job_file::{JobFile, ParseJobError, TypedPathRadius, UnknownChoice};
pub use keepout::{Keepout, ParseKeepoutError};
pub use lay::{Hole, Notice};
pub use leftover::{LEAST_LEFTOVER, Leftover};
pub use levels::{CutLevel, LevelError, cut_levels};
pub use loose::{LoosePiece, loose_pieces};
pub use motion::{Comment, Motion, MotionKind, Point3, Program, ProgramUnit, Trace};
pub use offset::{OffsetError, offset};
pub use operation::{CutLine, Geometry, Keep, OperationError, Planned, TabPlace, circle, plan_operation};
pub use operation_check::{OperationCheck, check_operation, split_operations, tabs_taken};
pub use operation_run::{OPERATION_COMMENT, OperationRun};
pub use path_radius::{PathPlace, TightestTurns, tightest_turns};
pub use plan::{PlanError, plan, translation};
pub use removal::{LEAST_UNCUT_DEPTH, Uncut, UncutPlace, uncut};
pub use sequence::append;
pub use setup::{
    AmountError, Corners, Cutting, InvalidSetup, Operation, OperationKind, Pattern, Rig, SETUP_VERSION, SampleShape,
    SelectFile, Setup, SetupFile, SetupProblem, Steps, TabPlaces, Tabs, Words, Workpiece, check_amount, chip_load,
    commented_sample, surface_speed,
};
pub use side::Side;
pub use simulate::{DEFAULT_SPOIL, SimulateError, SimulateOptions, Simulation, check_tools, simulate};
pub use solid::Remainder;
pub use stock::Stock;
pub use stock_surface::{StockSurface, stock_surface};
pub use time::{Machine, ProgramTime, estimate, motion_seconds};
pub use time_saved::TimeSaved;
pub use tool::{Tool, ToolShape};
pub use tool_table::ToolTable;
pub use tool_text::ParseToolError;
pub use toolpath::{Move, MoveKind, Settings, Step, Toolpath};
pub use v_carve::{CARVING_TOLERANCE, VCarve, VCarveError, VCarving, v_carve};
