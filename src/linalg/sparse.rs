//! Sparse systems of any pattern, by Cholesky factorization.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

use super::Singular;

/// An entry on or below the diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Row, at least the column.
    pub row: usize,
    /// Column.
    pub column: usize,
    /// Value; those of entries in the same place add up.
    pub value: f64,
}

/// A factored sparse symmetric positive definite matrix: unknowns in an order of approximate minimum degree, one thread,
/// so that the digits depend on the matrix alone.
#[derive(Debug)]
pub struct SparseCholesky {
    /// Where the entries of the matrix go.
    pattern: SymbolicSparseColMat<u32>,
    order: Argsort<u32>,
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<f64>,
}

impl SparseCholesky {
    /// Factors the matrix of `n` unknowns with these entries on and below the diagonal.
    ///
    /// # Errors
    /// Where the matrix is not positive definite or an entry is out of place.
    pub fn new(n: usize, entries: &[Entry]) -> Result<SparseCholesky, Singular> {
        if entries.iter().any(|e| e.row < e.column) {
            return Err(Singular);
        }
        let places: Vec<Pair<u32, u32>> =
            entries.iter().map(|e| Pair { row: e.row as u32, col: e.column as u32 }).collect();
        let (pattern, order) =
            SymbolicSparseColMat::<u32>::try_new_from_indices(n, n, &places).map_err(|_| Singular)?;
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Lower, SymmetricOrdering::Amd, Default::default())
                .map_err(|_| Singular)?;
        let factor = vec![0.0; symbolic.len_val()];
        SparseCholesky { pattern, order, symbolic, factor }.with(entries)
    }

    /// Factors another matrix, whose entries are in the same places in the same order.
    ///
    /// # Errors
    /// Where the matrix is not positive definite.
    ///
    /// # Panics
    /// Where there are fewer entries than there were.
    pub fn with(mut self, entries: &[Entry]) -> Result<SparseCholesky, Singular> {
        // A square root of infinity is no error to the factorization.
        if entries.iter().any(|e| !e.value.is_finite()) {
            return Err(Singular);
        }
        let values: Vec<f64> = entries.iter().map(|e| e.value).collect();
        let matrix =
            SparseColMat::new_from_argsort(self.pattern.clone(), &self.order, &values).map_err(|_| Singular)?;
        let symbolic = &self.symbolic;
        let mut buffer = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
        let stack = MemStack::new(&mut buffer);
        symbolic
            .factorize_numeric_llt::<f64>(
                &mut self.factor,
                matrix.as_ref(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                stack,
                Default::default(),
            )
            .map_err(|_| Singular)?;
        Ok(self)
    }

    /// Solves in place: `x` is the right-hand side, one row for each unknown, and becomes the solution.
    ///
    /// # Panics
    /// Where there are not as many rows as unknowns.
    pub fn solve<const D: usize>(&self, x: &mut [[f64; D]]) {
        let mut buffer = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(D, Par::Seq));
        let stack = MemStack::new(&mut buffer);
        let columns = MatMut::from_column_major_slice_mut(x.as_flattened_mut(), D, self.symbolic.nrows());
        // Rows of points are the columns of the transposed matrix.
        let columns = columns.transpose_mut();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(Conj::No, columns, Par::Seq, stack);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_solved() {
        const SIDE: usize = 12;
        let n = SIDE * SIDE;
        let mut entries = vec![];
        for k in 0..n {
            entries.push(Entry { row: k, column: k, value: 4.1 });
            if k % SIDE > 0 {
                entries.push(Entry { row: k, column: k - 1, value: -1.0 });
            }
            if k >= SIDE {
                entries.push(Entry { row: k, column: k - SIDE, value: -1.0 });
            }
        }
        let x: Vec<[f64; 3]> = (0..n).map(|k| [1.0, k as f64, (k as f64).sin()]).collect();
        let mut y = vec![[0.0; 3]; n];
        for e in &entries {
            for column in 0..3 {
                y[e.row][column] += e.value * x[e.column][column];
                if e.row != e.column {
                    y[e.column][column] += e.value * x[e.row][column];
                }
            }
        }
        SparseCholesky::new(n, &entries).unwrap().solve(&mut y);
        for (found, expected) in y.iter().flatten().zip(x.iter().flatten()) {
            assert!((found - expected).abs() < 1e-11 * n as f64, "{found} for {expected}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let at = |row, column, value| Entry { row, column, value };
        assert!(SparseCholesky::new(2, &[at(0, 0, 1.0), at(1, 0, -1.0), at(1, 1, 1.0)]).is_err());
        assert!(SparseCholesky::new(1, &[at(0, 0, f64::INFINITY)]).is_err());
        assert!(SparseCholesky::new(2, &[at(0, 0, 1.0), at(0, 1, 0.1), at(1, 1, 1.0)]).is_err());
    }
}
