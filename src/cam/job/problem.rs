//! What is wrong with a job.

use std::fmt;

use super::{DEFAULT_SAFE_CLEARANCE, LARGEST_PASS_COUNT};
use crate::units::{Brief, ResolveLengthError};

/// One value of a job that makes no sense. Fields are named as in a job file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JobProblem {
    /// Zero, negative, or not a number.
    #[error("{field} is {}: it must be a number above zero", Brief(*.value))]
    NotPositive {
        /// Which value.
        field: &'static str,
        /// What it is.
        value: f64,
    },
    /// Negative, or not a number.
    #[error("{field} is {}: it must be zero or more", Brief(*.value))]
    Negative {
        /// Which value.
        field: &'static str,
        /// What it is.
        value: f64,
    },
    /// Not a number, or infinite.
    #[error("{field} is {}: it must be a finite number", Brief(*.value))]
    NotFinite {
        /// Which value.
        field: &'static str,
        /// What it is.
        value: f64,
    },
    /// Beyond any machine.
    #[error("{field} is {}: at most {limit} makes sense; is the unit right?", Brief(*.value))]
    TooLarge {
        /// Which value.
        field: &'static str,
        /// What it is.
        value: f64,
        /// The most it may be.
        limit: f64,
    },
    /// Below what a machine resolves.
    #[error("{field} is {} mm: at least {limit} mm makes sense; is the unit right?", Brief(*.value))]
    TooSmall {
        /// Which value.
        field: &'static str,
        /// What it is, in millimetres.
        value: f64,
        /// The least it may be, in millimetres.
        limit: f64,
    },
    /// A rate at which a machine stands still for all that anyone sees.
    #[error("{field} is {}: at least {limit} makes sense; is the unit right?", Brief(*.value))]
    TooSlow {
        /// Which value.
        field: &'static str,
        /// What it is.
        value: f64,
        /// The least it may be.
        limit: f64,
    },
    /// The tool would travel through the stock.
    #[error(
        "safe-height is {} mm, not above stock-top, {} mm: try safe-height = {}",
        Brief(*.safe_height), Brief(*.stock_top), Brief(stock_top + DEFAULT_SAFE_CLEARANCE)
    )]
    SafeHeightTooLow {
        /// z of travel.
        safe_height: f64,
        /// z of the top of the stock.
        stock_top: f64,
    },
    /// depth / depth-per-pass is absurd.
    #[error(
        "depth {} mm at depth-per-pass {} mm takes more than {LARGEST_PASS_COUNT} passes",
        Brief(*.depth), Brief(*.depth_per_pass)
    )]
    TooManyPasses {
        /// Total depth.
        depth: f64,
        /// Most of one pass.
        depth_per_pass: f64,
    },
    /// A length that has no meaning for the drawing.
    #[error("{field}: {source}")]
    Length {
        /// Which value.
        field: &'static str,
        /// Why.
        source: ResolveLengthError,
    },
}

/// All that is wrong with a job; never empty.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct InvalidJob {
    /// The problems, in the order of the fields.
    pub problems: Vec<JobProblem>,
}

impl fmt::Display for InvalidJob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            write!(f, "{}{problem}", if i == 0 { "" } else { "; " })?;
        }
        Ok(())
    }
}
