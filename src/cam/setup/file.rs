//! Job files with operations, as they are typed.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::Deserialize;
use toml::Spanned;

use super::locate::Locator;
use super::plain_words::reworded;
use super::problem::{InvalidSetup, SetupProblem};
use crate::cam::job_file::{TypedPathRadius, typed};
use crate::cam::{Direction, Entry, JobFile, Machine, Origin, Side};
use crate::rolling::Topology;
use crate::units::{Length, Speed};

/// A job file with operations. Lengths and feeds are texts with a unit or bare numbers, which are millimetres and
/// millimetres a minute.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct SetupFile {
    /// The version of the format.
    pub version: Option<i64>,
    /// Whether all that one tool does is done at once; otherwise the operations keep their order.
    pub sort_by_tool: bool,
    /// `[stock]`.
    pub stock: StockFile,
    /// `[machine]`.
    pub machine: MachineFile,
    /// `[[tool]]`.
    pub tool: Vec<Spanned<ToolFile>>,
    /// `[[operation]]`.
    pub operation: Vec<Spanned<OperationFile>>,
    /// `[[keepout]]`.
    pub keepout: Vec<Spanned<KeepoutFile>>,
    /// The text, to find lines in.
    #[serde(skip)]
    pub(super) locator: Locator,
}

/// `[stock]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct StockFile {
    /// Extent along x.
    #[serde(deserialize_with = "typed")]
    pub width: Option<Length>,
    /// Extent along y.
    #[serde(deserialize_with = "typed")]
    pub height: Option<Length>,
    /// Thickness.
    #[serde(deserialize_with = "typed")]
    pub thickness: Option<Length>,
    /// z of its top.
    #[serde(deserialize_with = "typed")]
    pub top: Option<Length>,
    /// `corner`, `center` or `drawing`: what becomes x = 0, y = 0.
    #[serde(deserialize_with = "typed")]
    pub zero: Option<Origin>,
    /// What it is made of.
    pub material: Option<String>,
}

/// `[machine]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct MachineFile {
    /// The name or file of its dialect.
    pub dialect: Option<String>,
    /// A file with what GRBL answers to `$$`: accelerations, speeds, travel.
    pub settings: Option<String>,
    /// Inches instead of millimetres in programs.
    pub inches: Option<bool>,
    /// Arcs instead of lines.
    pub arcs: Option<bool>,
    /// mm/s², one for all axes or one each.
    pub acceleration: Option<PerAxis>,
    /// Largest speed in mm/min, one for all axes or one each.
    pub rapid: Option<PerAxis>,
    /// mm.
    #[serde(deserialize_with = "typed")]
    pub junction_deviation: Option<Length>,
    /// Travel of x, y and z in mm.
    pub travel: Option<[f64; 3]>,
    /// z of travel.
    #[serde(deserialize_with = "typed")]
    pub safe_height: Option<Length>,
    /// Seconds to wait for the spindle.
    pub dwell: Option<f64>,
    /// The fastest that the spindle turns.
    pub largest_spindle_speed: Option<f64>,
}

impl MachineFile {
    /// Takes what the machine itself says, where this file says nothing.
    pub fn take(&mut self, limits: &Machine, travel: Option<[f64; 3]>, largest_spindle_speed: Option<f64>) {
        self.acceleration.get_or_insert(PerAxis::Each(limits.acceleration));
        self.rapid.get_or_insert(PerAxis::Each(limits.rapid));
        self.junction_deviation.get_or_insert(Length::Millimetres(limits.junction_deviation));
        self.travel = self.travel.or(travel);
        // A machine without a spindle says 0.
        self.largest_spindle_speed = self.largest_spindle_speed.or(largest_spindle_speed.filter(|speed| *speed > 0.0));
    }
}

/// One number for all axes, or one each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub enum PerAxis {
    /// For all.
    All(f64),
    /// For x, y and z.
    Each([f64; 3]),
}

impl PerAxis {
    pub(super) fn values(self) -> [f64; 3] {
        match self {
            PerAxis::All(value) => [value; 3],
            PerAxis::Each(values) => values,
        }
    }
}

/// `[[tool]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ToolFile {
    /// Its number on the machine.
    pub number: Option<u32>,
    /// What people call it.
    pub name: Option<String>,
    /// `flat`, `ball`, `v` or `drill`.
    #[serde(rename = "type")]
    pub kind: Option<String>,
    /// Diameter at its widest.
    #[serde(deserialize_with = "typed")]
    pub diameter: Option<Length>,
    /// Degrees between the sides of a cone.
    pub angle: Option<f64>,
    /// Diameter of the flat at a cone's tip.
    #[serde(deserialize_with = "typed")]
    pub tip_diameter: Option<Length>,
    /// How many cutting edges.
    pub flutes: Option<u32>,
    /// Length of the cutting edges.
    #[serde(deserialize_with = "typed")]
    pub flute_length: Option<Length>,
    /// Feed along the path, in any material.
    #[serde(deserialize_with = "typed")]
    pub feed: Option<Speed>,
    /// Feed of ramps and plunges, in any material.
    #[serde(deserialize_with = "typed")]
    pub plunge_feed: Option<Speed>,
    /// Revolutions a minute, in any material.
    pub spindle_speed: Option<f64>,
    /// Most that a pass may go deeper, in any material.
    #[serde(deserialize_with = "typed")]
    pub depth_per_pass: Option<Length>,
    /// What it does in certain ones.
    pub material: BTreeMap<String, RatesFile>,
}

/// Feeds and speeds in one material.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct RatesFile {
    /// Feed along the path.
    #[serde(deserialize_with = "typed")]
    pub feed: Option<Speed>,
    /// Feed of ramps and plunges.
    #[serde(deserialize_with = "typed")]
    pub plunge_feed: Option<Speed>,
    /// Revolutions a minute.
    pub spindle_speed: Option<f64>,
    /// Most that a pass may go deeper.
    #[serde(deserialize_with = "typed")]
    pub depth_per_pass: Option<Length>,
}

/// `[[keepout]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct KeepoutFile {
    /// Least and largest x in mm.
    pub x: [f64; 2],
    /// Least and largest y in mm.
    pub y: [f64; 2],
    /// z of its top in mm.
    pub top: Option<f64>,
}

/// A tool by number or name.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum ToolName {
    /// Its number.
    Number(u32),
    /// Its name.
    Name(String),
}

/// A word or several.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Words {
    /// One.
    One(String),
    /// Any of them.
    Any(Vec<String>),
}

impl Words {
    /// The words.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        match self {
            Words::One(word) => std::slice::from_ref(word),
            Words::Any(words) => words.as_slice(),
        }
        .iter()
        .map(String::as_str)
    }
}

/// Which shapes of the drawing: those that all of these mean; all shapes where nothing is said.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct SelectFile {
    /// `id`s of shapes or of groups around them.
    pub id: Option<Words>,
    /// Layers: `id`s or Inkscape's names of groups.
    pub layer: Option<Words>,
    /// Fill colours.
    pub fill: Option<Words>,
    /// Stroke colours.
    pub stroke: Option<Words>,
    /// Places in the order of the file, counted from 1.
    pub order: Option<Vec<usize>>,
}

/// What an operation does, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperationKindName {
    /// `profile`.
    Profile,
    /// `pocket`.
    Pocket,
    /// `drill`.
    Drill,
    /// `engrave`.
    Engrave,
    /// `v-carve`.
    VCarve,
    /// `facing`.
    Facing,
    /// `chamfer`.
    Chamfer,
}

impl OperationKindName {
    /// All names.
    pub const ALL: [(&'static str, OperationKindName); 7] = [
        ("profile", OperationKindName::Profile),
        ("pocket", OperationKindName::Pocket),
        ("drill", OperationKindName::Drill),
        ("engrave", OperationKindName::Engrave),
        ("v-carve", OperationKindName::VCarve),
        ("facing", OperationKindName::Facing),
        ("chamfer", OperationKindName::Chamfer),
    ];

    /// The name as it is typed.
    pub fn word(self) -> &'static str {
        OperationKindName::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(word, _)| word)
    }
}

/// `[[operation]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct OperationFile {
    /// What is done.
    pub kind: Option<String>,
    /// What it is called.
    pub name: Option<String>,
    /// Its tool.
    pub tool: Option<ToolName>,
    /// The shapes.
    pub select: SelectFile,
    /// Profile, chamfer: which side.
    #[serde(deserialize_with = "typed")]
    pub side: Option<Side>,
    /// How far below the top it starts.
    #[serde(deserialize_with = "typed")]
    pub start_depth: Option<Length>,
    /// How far below the top it ends.
    #[serde(deserialize_with = "typed")]
    pub depth: Option<Length>,
    /// Whether it goes through the stock.
    pub through: Option<bool>,
    /// Most that a pass may go deeper.
    #[serde(deserialize_with = "typed")]
    pub depth_per_pass: Option<Length>,
    /// `even` or `stepped`.
    pub passes: Option<String>,
    /// Thickness of the last pass.
    #[serde(deserialize_with = "typed")]
    pub final_pass: Option<Length>,
    /// Feed along the path.
    #[serde(deserialize_with = "typed")]
    pub feed: Option<Speed>,
    /// Feed of ramps and plunges.
    #[serde(deserialize_with = "typed")]
    pub plunge_feed: Option<Speed>,
    /// Revolutions a minute, or a laser's power.
    pub spindle_speed: Option<f64>,
    /// `climb` or `conventional`.
    #[serde(deserialize_with = "typed")]
    pub direction: Option<Direction>,
    /// A length or `auto`.
    #[serde(deserialize_with = "typed")]
    pub path_radius: Option<TypedPathRadius>,
    /// `ramp`, `helix`, `plunge` or `predrilled`.
    #[serde(deserialize_with = "typed")]
    pub entry: Option<Entry>,
    /// Radius of lead-in and lead-out.
    #[serde(deserialize_with = "typed")]
    pub lead: Option<Length>,
    /// What holds the part.
    pub tabs: Option<TabsFile>,
    /// Thickness left at the floor until the end.
    #[serde(deserialize_with = "typed")]
    pub onion_skin: Option<Length>,
    /// Left at the walls.
    #[serde(deserialize_with = "typed")]
    pub allowance: Option<Length>,
    /// Whether the walls are cut again.
    pub finish: Option<bool>,
    /// Pocket, facing: distance between paths; a length, or a share of the diameter such as `"40%"`.
    pub stepover: Option<toml::Value>,
    /// Pocket: `rings` or `raster`.
    pub pattern: Option<String>,
    /// `round`, `dogbone` or `t-bone`.
    pub corners: Option<String>,
    /// The tool that has been here before.
    pub rest_of: Option<ToolName>,
    /// Drill: depth between withdrawals.
    #[serde(deserialize_with = "typed")]
    pub peck: Option<Length>,
    /// Chamfer: width.
    #[serde(deserialize_with = "typed")]
    pub width: Option<Length>,
    /// V-carve: the deepest.
    #[serde(deserialize_with = "typed")]
    pub max_depth: Option<Length>,
    /// What happens where parts come nearer than the tool.
    #[serde(deserialize_with = "typed")]
    pub topology: Option<Topology>,
}

/// `tabs = { ... }`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct TabsFile {
    /// So many on every outline.
    pub count: Option<usize>,
    /// One every so many millimetres.
    #[serde(deserialize_with = "typed")]
    pub spacing: Option<Length>,
    /// Places in mm.
    pub at: Option<Vec<[f64; 2]>>,
    /// Length of each.
    #[serde(deserialize_with = "typed")]
    pub width: Option<Length>,
    /// Height of each.
    #[serde(deserialize_with = "typed")]
    pub height: Option<Length>,
}

/// The tables that only job files with operations have.
const TABLES: [&str; 6] = ["version", "stock", "machine", "tool", "operation", "keepout"];

impl SetupFile {
    /// Whether `text` is a job file with operations, and not a list of settings for a single profile.
    pub fn is_meant(text: &str) -> bool {
        let starts = |line: &str| {
            let word = line.trim_start().trim_start_matches('[').trim_start();
            let key = word.split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_')).next();
            TABLES.contains(&key.unwrap_or_default())
        };
        text.lines().any(starts)
    }

    /// Sets what the file does not say of its tools: the spindle speed, which of a beam is the power, and the depth per pass.
    pub fn default_rates(&mut self, spindle_speed: Option<f64>, depth_per_pass: Length) {
        for tool in &mut self.tool {
            let tool = tool.as_mut();
            tool.spindle_speed = tool.spindle_speed.or(spindle_speed);
            tool.depth_per_pass.get_or_insert(depth_per_pass);
        }
    }
}

impl FromStr for SetupFile {
    type Err = InvalidSetup;

    fn from_str(text: &str) -> Result<SetupFile, InvalidSetup> {
        let locator = Locator::new(text);
        let mut file: SetupFile = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(0, |span| locator.line(span.start));
            InvalidSetup { problems: vec![SetupProblem { line, message: reworded(error.message()) }] }
        })?;
        file.locator = locator;
        Ok(file)
    }
}

/// Flags that mean every operation, and those that mean the machine.
pub(super) fn refuse_flags(flags: &JobFile) -> Option<&'static str> {
    // A job with operations names its tools.
    flags.tool_diameter.map(|_| "--tool-diameter")
}
