//! `clopen clopen`: closing and opening, one after the other, by the rolling disk.

use anyhow::Result;
use clap::{Args, ValueEnum};

use super::ExitStatus;
use super::close::{CloseArgs, Done, Operation, Report, Work};
use crate::check::{Named, differences};

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
        let results =
            [Named { name: order.name(), region: &region }, Named { name: other.name(), region: &other_region }];
        let report = Report::clopening(order, work, &done, differences(&results, work.radius));
        Ok((done.region, report))
    })
}
