//! Tridiagonal systems: chains of unknowns, open or closed to a ring.

use super::Singular;

/// Whether the two ends of a chain are neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closure {
    /// The chain has two ends.
    Open,
    /// The last unknown and the first are coupled by this off-diagonal entry's place: the last of [`Chain::new`]'s.
    Ring,
}

/// A factored symmetric positive definite matrix whose unknown `k` is coupled to `k` ± 1.
///
/// Open chains take Thomas' algorithm, rings the same with the Sherman–Morrison correction for the two entries in the
/// corners (Press et al., Numerical Recipes, 2.7.2). Both are stable without pivots as the matrix is positive definite.
#[derive(Clone, Debug)]
pub struct Chain {
    /// What elimination multiplies the row above by; one fewer than there are unknowns.
    multipliers: Vec<f64>,
    pivots: Vec<f64>,
    /// Of a ring the coupling of its ends.
    corner: Option<Corner>,
}

/// The matrix of a ring is that of an open chain plus `u uᵀ / gamma`, u = (gamma, 0, …, 0, coupling).
#[derive(Clone, Debug)]
struct Corner {
    /// `coupling / gamma`: the last entry of v = u / gamma.
    ratio: f64,
    /// The open chain's solution for u, divided by 1 + vᵀ of it.
    correction: Vec<f64>,
}

impl Chain {
    /// Factors the matrix with the diagonal `diagonal`, whose entry (k, k + 1) is `couplings[k]`. A ring has as many
    /// couplings as unknowns, at least three; an open chain has one fewer.
    ///
    /// # Errors
    /// Where the matrix is not positive definite.
    ///
    /// # Panics
    /// Where the numbers of entries do not fit each other.
    pub fn new(mut diagonal: Vec<f64>, couplings: &[f64], closure: Closure) -> Result<Chain, Singular> {
        let n = diagonal.len();
        match closure {
            Closure::Open => {
                assert_eq!(couplings.len() + 1, n.max(1), "an open chain has one coupling fewer than unknowns");
                Chain::open(diagonal, couplings)
            }
            Closure::Ring => {
                assert!(n >= 3 && couplings.len() == n, "a ring has a coupling for every unknown, three at least");
                let coupling = couplings[n - 1];
                let gamma = -diagonal[0];
                diagonal[0] -= gamma;
                diagonal[n - 1] -= coupling * coupling / gamma;
                let mut chain = Chain::open(diagonal, &couplings[..n - 1])?;
                let mut u = vec![[0.0]; n];
                (u[0], u[n - 1]) = ([gamma], [coupling]);
                chain.solve(&mut u);
                let ratio = coupling / gamma;
                let scale = 1.0 + u[0][0] + ratio * u[n - 1][0];
                if !(scale.is_finite() && scale != 0.0) {
                    return Err(Singular);
                }
                chain.corner = Some(Corner { ratio, correction: u.iter().map(|[x]| x / scale).collect() });
                Ok(chain)
            }
        }
    }

    fn open(mut diagonal: Vec<f64>, couplings: &[f64]) -> Result<Chain, Singular> {
        let mut multipliers = Vec::with_capacity(couplings.len());
        for (k, &coupling) in couplings.iter().enumerate() {
            let multiplier = coupling / diagonal[k];
            diagonal[k + 1] -= multiplier * coupling;
            multipliers.push(multiplier);
        }
        if diagonal.iter().all(|pivot| pivot.is_finite() && *pivot > 0.0) {
            Ok(Chain { multipliers, pivots: diagonal, corner: None })
        } else {
            Err(Singular)
        }
    }

    /// The number of unknowns.
    #[allow(clippy::len_without_is_empty, reason = "there is no chain without unknowns")]
    pub fn len(&self) -> usize {
        self.pivots.len()
    }

    /// Solves in place: `x` is the right-hand side, one row for each unknown, and becomes the solution.
    ///
    /// # Panics
    /// Where there are not as many rows as unknowns.
    pub fn solve<const D: usize>(&self, x: &mut [[f64; D]]) {
        let n = self.pivots.len();
        assert_eq!(x.len(), n, "a row for each unknown");
        for k in 1..n {
            let multiplier = self.multipliers[k - 1];
            let above = x[k - 1];
            for (entry, above) in x[k].iter_mut().zip(above) {
                *entry -= multiplier * above;
            }
        }
        for k in (0..n).rev() {
            let pivot = self.pivots[k];
            x[k].iter_mut().for_each(|entry| *entry /= pivot);
            if k + 1 < n {
                let (multiplier, below) = (self.multipliers[k], x[k + 1]);
                for (entry, below) in x[k].iter_mut().zip(below) {
                    *entry -= multiplier * below;
                }
            }
        }
        if let Some(Corner { ratio, correction }) = &self.corner {
            let (first, last) = (x[0], x[n - 1]);
            for (row, c) in x.iter_mut().zip(correction) {
                for (column, entry) in row.iter_mut().enumerate() {
                    *entry -= (first[column] + ratio * last[column]) * c;
                }
            }
        }
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
                Chain::new(diagonal.clone(), couplings, closure).unwrap().solve(&mut y);
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
        assert_eq!(Chain::new(vec![1.0, 1.0], &[-1.0], Closure::Open).err(), Some(Singular));
        assert_eq!(Chain::new(vec![1.0, f64::NAN], &[0.5], Closure::Open).err(), Some(Singular));
        assert_eq!(Chain::new(vec![-1.0], &[], Closure::Open).err(), Some(Singular));
    }
}
