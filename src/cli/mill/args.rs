//! The arguments of `clopen mill`.

use std::path::PathBuf;

use clap::Args;

use crate::cam::{Direction, Entry, JobFile, Origin, Side, TypedPathRadius};
use crate::cli::check::FormatArg;
use crate::cli::close::TopologyArg;
use crate::cli::input::ReadArgs;
use crate::units::{Length, Speed};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(in crate::cli) struct MillArgs {
    /// The drawing, SVG; - is standard input
    #[arg(value_name = "IN")]
    pub(super) input: PathBuf,
    /// Where the program goes; unless given, the drawing's name with .nc in the current folder
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// A job file (TOML): settings of a single profile, or stock, machine, tools and operations; flags beat the file, the
    /// file beats defaults
    #[arg(long, value_name = "FILE")]
    pub(super) job: Option<PathBuf>,
    /// Print a commented job file for the drawing, and do nothing else
    #[arg(long, conflicts_with_all = ["job", "output"])]
    pub(super) init: bool,
    /// Exit with 0 although features of the drawing are lost, or pieces come loose
    #[arg(long)]
    pub(super) accept_losses: bool,
    /// Make no picture
    #[arg(long)]
    pub(super) no_preview: bool,
    /// Write the whole certificate as one HTML page too: what will differ, why and what would help, the time that rounding
    /// saves, and the path in motion; it needs nothing but a browser
    #[arg(long, value_name = "FILE", conflicts_with = "init")]
    pub(super) html: Option<PathBuf>,
    /// How to print the certificate
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    pub(super) format: FormatArg,
    #[command(flatten)]
    cut: CutArgs,
    #[command(flatten)]
    program: ProgramArgs,
    #[command(flatten)]
    pub(super) reading: ReadArgs,
}

/// What to cut and how. Defaults: see `--help`.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Cutting")]
struct CutArgs {
    /// Diameter of the tool [default: 3.175mm; a beam 0.2mm, a pen 0.5mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    tool_diameter: Option<Length>,
    /// Depth of the cut [default: 3mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    depth: Option<Length>,
    /// Most that a pass may go deeper than the one before [default: 1mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    depth_per_pass: Option<Length>,
    /// Feed along the path [default: 1000mm/min]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    feed: Option<Speed>,
    /// Feed of ramps and plunges [default: 300mm/min]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    plunge_feed: Option<Speed>,
    /// Spindle speed in revolutions a minute; the power of a beam [default: 18000; a beam 1000]
    #[arg(long, value_name = "RPM", allow_hyphen_values = true)]
    spindle_speed: Option<f64>,
    /// Seconds to wait for the spindle [default: 3]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    dwell: Option<f64>,
    /// z of travel [default: 5mm above the top of the stock]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    safe_height: Option<Length>,
    /// z of the top of the stock [default: 0]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    stock_top: Option<Length>,
    /// What becomes x = 0, y = 0: corner or center of the part, or the drawing's own origin [default: corner]
    #[arg(long, value_name = "PLACE")]
    origin: Option<Origin>,
    /// climb or conventional [default: climb]
    #[arg(long, value_name = "WAY")]
    direction: Option<Direction>,
    /// outside of parts and inside of holes; inside; or on the outline [default: outside]
    #[arg(long, value_name = "SIDE")]
    side: Option<Side>,
    /// Smallest radius of the path in inside corners: a length, or auto for feed squared over acceleration
    /// [default: auto]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    path_radius: Option<TypedPathRadius>,
    /// Acceleration of the machine in mm/s² [default: 500]
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    acceleration: Option<f64>,
    /// ramp or plunge [default: ramp]
    #[arg(long, value_name = "WAY")]
    entry: Option<Entry>,
    /// What happens where parts come nearer to each other than the tool [default: merge]
    #[arg(long, value_enum)]
    topology: Option<TopologyArg>,
}

/// How the program is written.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Program")]
struct ProgramArgs {
    /// The controller's dialect: grbl, grblhal, fluidnc, linuxcnc, mach3, mach4, marlin, smoothieware, grbl-laser, plotter,
    /// plotter-servo, or a file of your own (my-machine.toml) [default: grbl]
    #[arg(long, value_name = "NAME|FILE")]
    dialect: Option<String>,
    /// Lines instead of arcs, for machines without them
    #[arg(long)]
    no_arcs: bool,
    /// Write inches (G20) instead of millimetres
    #[arg(long)]
    inches: bool,
}

impl MillArgs {
    /// What was typed of the job.
    pub(super) fn typed(&self) -> JobFile {
        let (cut, program) = (&self.cut, &self.program);
        JobFile {
            tool_diameter: cut.tool_diameter,
            depth: cut.depth,
            depth_per_pass: cut.depth_per_pass,
            feed: cut.feed,
            plunge_feed: cut.plunge_feed,
            spindle_speed: cut.spindle_speed,
            dwell: cut.dwell,
            safe_height: cut.safe_height,
            stock_top: cut.stock_top,
            origin: cut.origin,
            direction: cut.direction,
            side: cut.side,
            path_radius: cut.path_radius,
            acceleration: cut.acceleration,
            entry: cut.entry,
            topology: cut.topology.map(Into::into),
            dialect: program.dialect.clone(),
            no_arcs: program.no_arcs.then_some(true),
            inches: program.inches.then_some(true),
        }
    }
}
