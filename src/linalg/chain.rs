//! Tridiagonal systems: chains of unknowns, open or closed to a ring.

use super::Singular;

/// Whether the two ends of a chain are neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closure {
    /// The chain has two ends.
    Open,
    /// The last unknown and the first are coupled too.
    Ring,
}

/// Factored symmetric positive definite matrices, one after the other, in which unknown `k` is coupled to `k` ± 1.
///
/// Open chains take Thomas' algorithm, rings the same with the Sherman–Morrison correction for the two entries in the
/// corners (Press et al., Numerical Recipes, 2.7.2). Both are stable without pivots as the matrices are positive definite.
#[derive(Clone, Debug, Default)]
pub struct Chains {
    /// What elimination multiplies the row above by to take it off the row below; of the last row of a chain, nothing.
    multipliers: Vec<f64>,
    pivots: Vec<f64>,
    /// Where each chain ends, and of a ring what the coupling of its ends adds.
    ends: Vec<(usize, Option<Corner>)>,
}

/// The matrix of a ring is that of an open chain plus `u uᵀ / gamma`, u = (gamma, 0, …, 0, coupling).
#[derive(Clone, Debug)]
struct Corner {
    /// `coupling / gamma`: the last entry of v = u / gamma.
    ratio: f64,
    /// The open chain's solution for u, divided by 1 + vᵀ of it.
    correction: Vec<f64>,
}

impl Chains {
    /// Appends the matrix whose rows are `(diagonal entry, coupling to the next row)`, and factors it. The last row's
    /// coupling is that to the first one in a ring, which has three rows at least; in an open chain it means nothing.
    ///
    /// # Errors
    /// Where the matrix is not positive definite.
    ///
    /// # Panics
    /// Where a ring has fewer than three rows.
    pub fn push(&mut self, rows: impl Iterator<Item = (f64, f64)>, closure: Closure) -> Result<(), Singular> {
        let start = self.pivots.len();
        for (diagonal, coupling) in rows {
            self.pivots.push(diagonal);
            self.multipliers.push(coupling);
        }
        let (pivots, multipliers) = (&mut self.pivots[start..], &mut self.multipliers[start..]);
        let n = pivots.len();
        let corner = match closure {
            Closure::Open => {
                eliminate(pivots, multipliers)?;
                None
            }
            Closure::Ring => {
                assert!(n >= 3, "a ring has three rows at least");
                let coupling = multipliers[n - 1];
                let gamma = -pivots[0];
                pivots[0] -= gamma;
                pivots[n - 1] -= coupling * coupling / gamma;
                eliminate(pivots, multipliers)?;
                let mut u = vec![[0.0]; n];
                (u[0], u[n - 1]) = ([gamma], [coupling]);
                substitute(pivots, multipliers, &mut u);
                let ratio = coupling / gamma;
                let scale = 1.0 + u[0][0] + ratio * u[n - 1][0];
                if !(scale.is_finite() && scale != 0.0) {
                    return Err(Singular);
                }
                Some(Corner { ratio, correction: u.iter().map(|[x]| x / scale).collect() })
            }
        };
        self.ends.push((start + n, corner));
        Ok(())
    }

    /// Solves in place: `x` is the right-hand side, one row for each unknown, and becomes the solution.
    ///
    /// # Panics
    /// Where there are not as many rows as unknowns.
    pub fn solve<const D: usize>(&self, x: &mut [[f64; D]]) {
        assert_eq!(x.len(), self.pivots.len(), "a row for each unknown");
        let mut start = 0;
        for (end, corner) in &self.ends {
            let x = &mut x[start..*end];
            substitute(&self.pivots[start..*end], &self.multipliers[start..*end], x);
            if let (Some(Corner { ratio, correction }), [first, .., last]) = (corner, &*x) {
                let (first, last) = (*first, *last);
                for (row, c) in x.iter_mut().zip(correction) {
                    for (column, entry) in row.iter_mut().enumerate() {
                        *entry -= (first[column] + ratio * last[column]) * c;
                    }
                }
            }
            start = *end;
        }
    }
}

/// Turns a diagonal into pivots, and couplings into multipliers.
fn eliminate(diagonal: &mut [f64], couplings: &mut [f64]) -> Result<(), Singular> {
    for k in 1..diagonal.len() {
        let coupling = couplings[k - 1];
        let multiplier = coupling / diagonal[k - 1];
        diagonal[k] -= multiplier * coupling;
        couplings[k - 1] = multiplier;
    }
    let is_sound = |pivot: &f64| pivot.is_finite() && *pivot > 0.0;
    if diagonal.iter().all(is_sound) { Ok(()) } else { Err(Singular) }
}

/// Forwards, and back.
fn substitute<const D: usize>(pivots: &[f64], multipliers: &[f64], x: &mut [[f64; D]]) {
    for k in 1..x.len() {
        let (multiplier, above) = (multipliers[k - 1], x[k - 1]);
        for (entry, above) in x[k].iter_mut().zip(above) {
            *entry -= multiplier * above;
        }
    }
    let mut below = [0.0; D];
    for (k, row) in x.iter_mut().enumerate().rev() {
        // Nothing is below the last row.
        let multiplier = if below == [0.0; D] { 0.0 } else { multipliers[k] };
        for (entry, below) in row.iter_mut().zip(below) {
            *entry = *entry / pivots[k] - multiplier * below;
        }
        below = *row;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrix times `x`.
    fn product(diagonal: &[f64], couplings: &[f64], x: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let n = diagonal.len();
        let mut y: Vec<[f64; 2]> = (0..n).map(|k| x[k].map(|entry| diagonal[k] * entry)).collect();
        for (k, c) in couplings.iter().enumerate() {
            let next = (k + 1) % n;
            for column in 0..2 {
                y[k][column] += c * x[next][column];
                y[next][column] += c * x[k][column];
            }
        }
        y
    }

    fn entries(n: usize) -> (Vec<f64>, Vec<f64>, Vec<[f64; 2]>) {
        let wave = |k: usize, f: f64| (k as f64 * f).sin();
        let couplings: Vec<f64> = (0..n).map(|k| -2.0 - wave(k, 1.7)).collect();
        let diagonal = (0..n).map(|k| 0.1 - couplings[k] - couplings[(k + n - 1) % n]).collect();
        (diagonal, couplings, (0..n).map(|k| [wave(k, 0.9), wave(k, 2.3)]).collect())
    }

    #[test]
    fn chains_and_rings_of_every_length_are_solved() {
        for n in 1..40 {
            let (diagonal, couplings, x) = entries(n);
            let close = |closure, couplings: &[f64]| {
                let mut y = product(&diagonal, couplings, &x);
                let mut chains = Chains::default();
                let couplings = couplings.iter().copied().chain([f64::NAN]);
                chains.push(diagonal.iter().copied().zip(couplings), closure).unwrap();
                chains.solve(&mut y);
                for (found, expected) in y.iter().flatten().zip(x.iter().flatten()) {
                    assert!((found - expected).abs() < 1e-12, "{n} {closure:?}: {found} for {expected}");
                }
            };
            close(Closure::Open, &couplings[..n - 1]);
            if n >= 3 {
                close(Closure::Ring, &couplings);
            }
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let refused = |rows: &[(f64, f64)]| Chains::default().push(rows.iter().copied(), Closure::Open).is_err();
        assert!(refused(&[(1.0, -1.0), (1.0, 0.0)]));
        assert!(refused(&[(1.0, 0.5), (f64::NAN, 0.0)]));
        assert!(refused(&[(-1.0, 0.0)]));
        assert!(!refused(&[(1.0, 0.5), (1.0, f64::NAN)]));
    }
}
