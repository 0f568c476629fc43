//! `--method flow`: the surface in time.

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};
use indicatif::ProgressBar;

use super::pins::Field;
use super::work::{Done, Input};
use super::{Step, WorkArgs};
use crate::flow::{
    Contact, DEFAULT_SURFACE_TIME_STEP, End, Kind, Landing, Obstacle, OnContact, Status, SurfaceField, SurfaceFlow,
    SurfaceSettings,
};
use crate::mesh::TriangleMesh;
use crate::rolling::{Roller, Touch};

/// Frames that a run may have.
pub(super) const MOST_FRAMES: u32 = 1000;

/// What only a flow has.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Flow (with --method flow)")]
pub(super) struct FlowArgs {
    /// Stop at this time, in squares of the radius; the limit unless given
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub time: Option<f64>,
    /// So many states evenly in time up to --time, numbered: OUT-01.obj, OUT-02.obj, ...
    #[arg(long, value_name = "NUMBER", requires = "time")]
    pub frames: Option<u32>,
    /// Step in time, in squares of the edge length [default: 2; with --time 0.2]
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    time_step: Option<f64>,
    /// What drives the surface [default: minimum]
    #[arg(long, value_enum)]
    curvature: Option<CurvatureArg>,
    /// What stays where it is [default: curvature]
    #[arg(long, value_enum)]
    bound: Option<BoundArg>,
    /// Where the surface stops [default: all; near with --time, --curvature mean, --bound none, and for clopen]
    #[arg(long, value_enum)]
    contacts: Option<ContactsArg>,
    /// What happens where the surface runs into itself [default: freeze]
    #[arg(long, value_enum)]
    on_contact: Option<OnContactArg>,
}

impl FlowArgs {
    /// An option that was given and means nothing without a flow.
    pub fn first_given(&self) -> Option<&'static str> {
        let given = [
            (self.time.is_some(), "--time"),
            (self.frames.is_some(), "--frames"),
            (self.time_step.is_some(), "--time-step"),
            (self.curvature.is_some(), "--curvature"),
            (self.bound.is_some(), "--bound"),
            (self.contacts.is_some(), "--contacts"),
            (self.on_contact.is_some(), "--on-contact"),
        ];
        given.into_iter().find(|(is_given, _)| *is_given).map(|(_, name)| name)
    }
}

/// Near a pin, the radius of a flow is this part of the distance from it, as [`SurfaceField`] says.
pub(super) const PIN_EASE: f64 = 0.7;

/// Time steps of flows that are looked at on the way.
const FINE_TIME_STEP: f64 = 0.2;

/// Steps shorter than this come to nothing in a lifetime; longer ones than that gain nothing.
const SHORTEST_TIME_STEP: f64 = 1e-4;
const LONGEST_TIME_STEP: f64 = 100.0;

/// `--curvature`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CurvatureArg {
    /// The smallest curvature at a place: what closing is
    Minimum,
    /// The mean of both, for comparison
    Mean,
}

/// `--bound`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BoundArg {
    /// What is less curved than the ball
    Curvature,
    /// Nothing, for comparison: needs --time
    None,
}

/// `--contacts`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ContactsArg {
    /// Where its curvature is the ball's: seen along the surface, as in the paper
    Near,
    /// On the ball itself, which touches the surface wherever it is in space
    All,
}

/// `--on-contact`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OnContactArg {
    /// It goes on, and the places are told
    Report,
    /// The flow stops there
    Stop,
    /// No move is made that takes the surface through itself; where that holds it up is told
    Freeze,
}

/// How a flow went.
#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Flown {
    pub steps: u64,
    pub time_r2: f64,
    pub end: Option<End>,
    pub contacts: Vec<[f64; 3]>,
    /// Faces whose middles are farther than an edge length from the exact result, for a flow that was to end there.
    pub short: Vec<[f64; 3]>,
}

impl Flown {
    /// Whether it got where it was to go.
    pub fn is_sound(&self) -> bool {
        self.end.is_none_or(End::is_limit) && self.contacts.is_empty() && self.short.is_empty()
    }
}

/// The field of a flow, which lands on the ball if there is one that rolls.
pub(super) fn space<'a>(field: &'a Field, roller: Option<Roller>) -> SurfaceField<'a> {
    let contact = roller.map(|roller| -> Contact<'a> {
        Box::new(move |p, normal, radius| {
            let Touch { point, normal, gap } = roller.touch(p, normal, radius)?;
            Some(Landing { point, normal, gap })
        })
    });
    SurfaceField {
        radius: Box::new(|p| (field.radius)(p)),
        pin_distance: Box::new(|p| (field.pin_distance)(p)),
        contact,
        facing: field.facing.as_ref().map(|facing| Box::new(facing) as Box<_>),
    }
}

/// The states of the flow, the last one last.
pub(super) fn run(
    args: &WorkArgs,
    input: &Input,
    steps: &[Step],
    field: &Field,
    radius: f64,
    edge: f64,
    bar: &ProgressBar,
) -> Result<Vec<Done>> {
    let flow = &args.flow;
    if let Some(time) = flow.time.filter(|t| !(*t > 0.0 && t.is_finite())) {
        bail!("--time is {time}: it must be above zero; 0.1 is where edges have begun to fill");
    }
    if let Some(step) = flow.time_step.filter(|step| !(SHORTEST_TIME_STEP..=LONGEST_TIME_STEP).contains(step)) {
        bail!("--time-step is {step:e}: give one from {SHORTEST_TIME_STEP:e} to {LONGEST_TIME_STEP}");
    }
    if let Some(frames) = flow.frames.filter(|n| !(1..=MOST_FRAMES).contains(n)) {
        bail!("--frames is {frames}: give a number from 1 to {MOST_FRAMES}");
    }
    let bound = flow.bound.unwrap_or(BoundArg::Curvature);
    if bound == BoundArg::None && flow.time.is_none() {
        bail!("--bound none: without a bound everything shrinks to nothing: say when to stop with --time 0.1");
    }
    let obstacle = match (bound, steps) {
        (BoundArg::None, _) => Obstacle::NONE,
        (_, [Step::Close]) => Obstacle::CLOSING,
        (_, [Step::Open]) => Obstacle::OPENING,
        _ => Obstacle::CLOPENING,
    };
    let default_step = if flow.time.is_some() { FINE_TIME_STEP } else { DEFAULT_SURFACE_TIME_STEP };
    let settings = SurfaceSettings {
        time_step: flow.time_step.unwrap_or(default_step),
        on_contact: match flow.on_contact.unwrap_or(OnContactArg::Freeze) {
            OnContactArg::Report => OnContact::Report,
            OnContactArg::Stop => OnContact::Stop,
            OnContactArg::Freeze => OnContact::Freeze,
        },
        kind: match flow.curvature.unwrap_or(CurvatureArg::Minimum) {
            CurvatureArg::Minimum => Kind::Minimum,
            CurvatureArg::Mean => Kind::Mean,
        },
        ..SurfaceSettings::new(edge)
    };
    // A ball has no direction.
    let is_round = field.facing.is_none() && settings.kind == Kind::Minimum;
    let can_land = is_round && obstacle != Obstacle::CLOPENING && obstacle != Obstacle::NONE;
    if flow.contacts == Some(ContactsArg::All) && !can_land {
        bail!(
            "--contacts all: only closing and opening end on a ball, with --curvature minimum, a bound and no --radius-facing: try --contacts near"
        );
    }
    let lands = flow.contacts.map_or(can_land && flow.time.is_none(), |c| c == ContactsArg::All);
    let is_open = obstacle == Obstacle::OPENING;
    let solid = if is_open { input.triangles.reversed() } else { input.triangles.clone() };
    let roller = Roller::new(&solid).context("--method flow")?;
    let space = space(field, lands.then(|| roller.clone()));
    let mut flowing = SurfaceFlow::new(&input.triangles, obstacle, space, &settings).context("--method flow")?;
    let unit = radius * radius;
    let stops: Vec<f64> = match (flow.time, flow.frames) {
        (None, _) => vec![f64::INFINITY],
        (Some(time), None) => vec![time * unit],
        (Some(time), Some(n)) => (1..=n).map(|k| time * unit * f64::from(k) / f64::from(n)).collect(),
    };
    let mut states = Vec::new();
    for stop in stops {
        while flowing.status() == Status::Going && flowing.time() < stop {
            flowing.step(stop);
            let (moving, largest) = flowing.last_step();
            bar.set_message(format!(
                "time {:.4} r², {moving} vertices move by up to {largest:.4} edge lengths",
                flowing.time() / unit
            ));
        }
        let (result, report) = (flowing.result(), flowing.report());
        let survey = (lands && report.end.is_some()).then(|| {
            let surface = TriangleMesh::new(result.points.clone(), result.faces.clone());
            let surface = if is_open { surface.reversed() } else { surface };
            let radius = |p| (field.radius)(p).min(PIN_EASE * (field.pin_distance)(p));
            roller.survey(&surface, &radius, edge, crate::threads::available())
        });
        states.push(Done {
            points: result.points,
            origins: result.origins,
            faces: result.faces,
            parents: result.parents,
            conflicts: Vec::new(),
            error: survey.as_ref().map(|s| s.largest),
            edge,
            radius,
            radii: [field.smallest, field.largest],
            choices: Vec::new(),
            flown: Some(Flown {
                steps: report.steps,
                time_r2: report.time / unit,
                end: report.end,
                contacts: report.contacts.iter().map(|&p| p.into()).collect(),
                short: survey.iter().flat_map(|s| &s.off).map(|&p| p.into()).collect(),
            }),
        });
    }
    Ok(states)
}
