//! The arguments of `clopen simulate`, and what they say in millimetres.

use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use clap::Args;

use crate::cam::{Keepout, Machine, Origin, Side, Tool};
use crate::cli::check::FormatArg;
use crate::cli::input::{self, ReadArgs};
use crate::units::{Length, Speed};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(in crate::cli) struct SimulateArgs {
    /// The program, or several that are run one after the other on the same stock; - is standard input
    #[arg(value_name = "FILE", required = true)]
    pub(super) files: Vec<PathBuf>,
    /// A tool by its number: "T1=flat 3.175mm", "2=ball 6mm", "3=v60 6mm tip 0.2mm", "4=drill 3mm"; may be given more
    /// than once, and beats what comments of the program say. 0 is the tool that the program starts with
    #[arg(long = "tool", value_name = "TOOL", allow_hyphen_values = true)]
    pub(super) tools: Vec<Tool>,
    /// The controller whose program it is: a name as of `clopen lint --dialect`, or a dialect file. Beams and pens, whose
    /// programs have no depth, cut through the stock [default: as the header of a program of clopen says, or portable]
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) dialect: Option<String>,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    pub(super) format: FormatArg,
    #[command(flatten)]
    pub(super) output: OutputArgs,
    #[command(flatten)]
    pub(super) stock: StockArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    pub(super) against: AgainstArgs,
    #[command(flatten)]
    pub(super) reading: ReadArgs,
}

/// What is made besides the report.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Output")]
pub(super) struct OutputArgs {
    /// A picture of the cut stock from above, PNG
    #[arg(short, long, value_name = "PICTURE")]
    pub(super) output: Option<PathBuf>,
    /// A picture of what is cut at each depth, from the top down: PREFIX-01.png, PREFIX-02.png ...
    #[arg(long, value_name = "PREFIX")]
    pub(super) levels: Option<PathBuf>,
    /// The cut stock as a closed mesh, binary STL
    #[arg(long, value_name = "FILE.stl")]
    pub(super) stl: Option<PathBuf>,
}

/// What is cut.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Stock")]
pub(super) struct StockArgs {
    /// Width, height and thickness of the stock, 100x60x6mm [default: what is cut, with a margin, as thick as the deepest cut]
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true)]
    pub(super) stock: Option<String>,
    /// x,y of its lower left corner [default: what is cut lies in its middle]
    #[arg(long, value_name = "PLACE", allow_hyphen_values = true, requires = "stock")]
    pub(super) stock_at: Option<String>,
    /// z of its top [default: as the header of a program of clopen says, else 0]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub(super) stock_top: Option<Length>,
    /// How far below the stock tools may go
    #[arg(long, value_name = "LENGTH", default_value_t = Length::Millimetres(crate::cam::DEFAULT_SPOIL), allow_hyphen_values = true)]
    pub(super) spoil: Length,
    /// A box that no tool may enter, as x0,y0,x1,y1 or with the z of its top behind them; may be given more than once
    #[arg(long = "keepout", value_name = "BOX", allow_hyphen_values = true)]
    pub(super) keepouts: Vec<Keepout>,
    /// Side of the cells of the height map, at most a quarter of the smallest tool [default: a fortieth of it, or as many as are
    /// four million]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub(super) cell: Option<Length>,
}

/// The machine whose time is told.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Machine")]
struct MachineArgs {
    /// Acceleration of all axes in mm/s² [default: 500]
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    acceleration: Option<f64>,
    /// Speed of rapids on all axes [default: 5000mm/min, up and down 1500mm/min]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    rapid: Option<Speed>,
    /// How far corners might be cut at speed, GRBL's $11 [default: 0.01mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    junction_deviation: Option<Length>,
}

/// What the program is held against.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Part")]
pub(super) struct AgainstArgs {
    /// The drawing of the part, SVG: gouges into it and what is left beside it are told
    #[arg(long, value_name = "DRAWING")]
    pub(super) against: Option<PathBuf>,
    /// outside of parts and inside of holes; inside; or on the outline
    #[arg(long, value_name = "SIDE", default_value = "outside", requires = "against")]
    pub(super) side: Side,
    /// What of the drawing is x = 0, y = 0: corner or center of the part, or the drawing's own origin
    #[arg(long, value_name = "PLACE", default_value = "corner", requires = "against")]
    pub(super) origin: Origin,
    /// z that the cut must reach [default: the deepest cut sideways, or the lower face of --stock]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, requires = "against")]
    pub(super) floor: Option<Length>,
}

impl StockArgs {
    /// Width, height and thickness.
    pub(super) fn size(&self) -> Result<Option<[f64; 3]>> {
        let Some(text) = &self.stock else { return Ok(None) };
        let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || " .xX/".contains(c));
        let wrong = || anyhow!("--stock \"{text}\": write width, height and thickness, for example 100x60x6mm");
        let parts: Vec<f64> = lengths(text, ['x', 'X'], unit, "--stock").ok_or_else(wrong)?;
        let size: [f64; 3] = parts.try_into().map_err(|_| wrong())?;
        if !size.iter().all(|side| side.is_finite() && *side > 0.0) {
            bail!("--stock \"{text}\": width, height and thickness must be above zero");
        }
        Ok(Some(size))
    }

    /// The lower left corner.
    pub(super) fn corner(&self) -> Result<Option<[f64; 2]>> {
        let Some(text) = &self.stock_at else { return Ok(None) };
        let wrong = || anyhow!("--stock-at \"{text}\": write x and y of the lower left corner, for example -5mm,-5mm");
        let parts: Vec<f64> = lengths(text, [','; 2], "", "--stock-at").ok_or_else(wrong)?;
        Ok(Some(parts.try_into().map_err(|_| wrong())?))
    }
}

/// Lengths between separators; a unit behind the last holds for those that have none.
fn lengths(text: &str, separators: [char; 2], unit: &str, option: &str) -> Option<Vec<f64>> {
    let one = |part: &str| {
        let bare = part.trim().chars().all(|c| c.is_ascii_digit() || ".-+/ ".contains(c));
        let part = if bare { format!("{part}{unit}") } else { part.to_owned() };
        input::millimetres(part.parse().ok()?, option).ok()
    };
    text.split(separators).map(one).collect()
}

impl SimulateArgs {
    pub(super) fn machine(&self) -> Result<Machine> {
        let MachineArgs { acceleration, rapid, junction_deviation } = &self.machine;
        let mut machine = Machine::default();
        if let Some(value) = *acceleration {
            if !(value.is_finite() && value > 0.0) {
                bail!("--acceleration is {value} mm/s²: it must be above zero");
            }
            machine.acceleration = [value; 3];
        }
        if let Some(speed) = rapid {
            machine.rapid = [speed.mm_per_min(); 3];
        }
        if let Some(length) = *junction_deviation {
            machine.junction_deviation = input::millimetres(length, "--junction-deviation")?;
            if machine.junction_deviation.is_nan() || machine.junction_deviation <= 0.0 {
                bail!("--junction-deviation is {length}: it must be above zero");
            }
        }
        Ok(machine)
    }
}
