//! Linear systems of the flow's step: symmetric positive definite ones only.
//!
//! A chain of unknowns that know their neighbours alone is solved in one pass forwards and one back ([`Chain`]), a closed
//! chain by one correction of that; any other pattern by a sparse Cholesky factorization ([`SparseCholesky`]). The
//! unknowns are points: each right-hand side has as many columns as space has dimensions.

mod chain;
mod sparse;

pub use chain::{Chain, Closure};
pub use sparse::{Entry, SparseCholesky};

/// A matrix that is not positive definite to working precision, or holds numbers that are not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the system of the step is singular: coordinates are too large or edges too short for its time step")]
pub struct Singular;
