//! `clopen clopen`: closing and opening, one after the other, by the rolling disk.

use anyhow::Result;
use clap::{Args, ValueEnum};
use indicatif::ProgressBar;

use super::ExitStatus;
use super::close::{CloseArgs, Done, Operation, Report, Work};
use crate::check::{Named, differences};
use crate::flow::{CurveFlow, Field, Obstacle, Settings, Status};
use crate::plane::Region;

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct ClopenArgs {
    /// What is done first
    #[arg(long, value_enum, default_value_t = Order::CloseOpen)]
    order: Order,
    #[command(flatten)]
    shared: CloseArgs,
}

/// `--order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Order {
    /// Closing, then opening: what is narrow is filled before it can break
    CloseOpen,
    /// Opening, then closing: what is thin is removed before it can hold a filling
    OpenClose,
}

impl Order {
    fn other(self) -> Order {
        match self {
            Order::CloseOpen => Order::OpenClose,
            Order::OpenClose => Order::CloseOpen,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Order::CloseOpen => "close-open",
            Order::OpenClose => "open-close",
        }
    }

    fn steps(self) -> [Operation; 2] {
        match self {
            Order::CloseOpen => [Operation::Close, Operation::Open],
            Order::OpenClose => [Operation::Open, Operation::Close],
        }
    }

    /// Both operations, the second on the result of the first: arcs that the first made are input like any other, and
    /// kept where the second has no reason to move them.
    fn run(self, work: &Work) -> Done {
        let [first, second] = self.steps();
        let first = work.apply(first, work.region());
        let second = work.apply(second, &first.region);
        let proved = first.contradictions == 0 && second.contradictions == 0;
        let places = [first.differences, second.differences].concat();
        Done { region: second.region, places, proved }
    }
}

/// Runs the command.
///
/// # Errors
/// As [`super::close::run`].
pub(super) fn run(args: &ClopenArgs) -> Result<ExitStatus> {
    args.shared.run(|work| {
        let (order, other) = (args.order, args.order.other());
        let (done, otherwise) = (order.run(work), other.run(work));
        let (region, other_region) = (work.on_page(&done.region), work.on_page(&otherwise.region));
        let (flow, remark) = flow(work)?;
        let flow = work.on_page(&flow);
        let results = [(order.name(), &region), (other.name(), &other_region), ("flow", &flow)];
        let results = results.map(|(name, region)| Named { name, region });
        let report = Report::clopening(order, work, &done, differences(&results, work.radius), remark);
        Ok((done.region, report))
    })
}

/// The flow is given up after this time, in r²: the end of a slot of width w moves at about π / w, so that by then any slot that
/// closes has closed to a depth of seventy radii.
const MOST_TIME: f64 = 50.0;

/// The limit of the flow with both bounds at once, and what is to be said of it where that is not all.
fn flow(work: &Work) -> Result<(Region, Option<String>)> {
    let (region, field) = (work.region(), Field::constant(work.radius));
    let mut flow = CurveFlow::new(region, Obstacle::CLOPENING, field, &Settings::default())?;
    // What that takes is not known before; hidden where standard error is no terminal.
    let bar = ProgressBar::new_spinner().with_message("both bounds at once");
    let most = MOST_TIME * work.radius.get() * work.radius.get();
    while flow.step(most) == Status::Going && flow.time() < most {
        bar.inc(1);
    }
    bar.finish_and_clear();
    let report = flow.report();
    let remark = match report.end {
        None => Some(format!("the flow has not come to its limit in {MOST_TIME} r²: clopen flow goes on")),
        Some(end) if !end.is_limit() => Some("the flow stalled on its way; this is its best state".to_owned()),
        Some(_) if !report.contacts.is_empty() => {
            let times =
                if report.contacts.len() == 1 { "once".to_owned() } else { format!("{} times", report.contacts.len()) };
            Some(format!("the flow ran into itself {times}, which the disk does not"))
        }
        Some(_) => None,
    };
    Ok((flow.rounded(), remark))
}
