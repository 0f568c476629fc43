//! One semi-implicit step, for curves and surfaces alike.
//!
//! With U the moving vertices, M the mass, L the stiffness and x0 the positions,
//!
//! ```text
//! (M + tau L)_UU d_U = -tau (L x0)_U,   d = 0 elsewhere
//! ```
//!
//! (eq. 18 of the paper, written for the displacement d): frozen vertices are not touched, so they stay bit for bit, and
//! the largest |d| tells whether the flow still goes on.

use crate::linalg::{Chains, Entry, Singular, SparseCholesky};

/// A boundary in space of `D` dimensions, in so far as a step needs to know it.
pub trait Front<const D: usize> {
    /// Its kind of stiffness matrix.
    type Stiffness: Stiffness;

    /// Finds the moving set, the vertices that the obstacle lets go, and gives the system of its step; `None` where
    /// everything stays.
    fn release(&mut self) -> Option<System<Self::Stiffness, D>>;

    /// How far beyond the bound the vertices of the moving set would be after these displacements, in the order and the
    /// unit of [`System::beyond`]; negative within it.
    fn beyond(&self, displacements: &[[f64; D]]) -> Vec<f64>;

    /// Moves the vertices of the moving set, in the order of the system, as far as they may go, and mends the mesh
    /// around them.
    fn displace(&mut self, displacements: &[[f64; D]]) -> Displaced;

    /// Places where the boundary crosses itself that were not there when it was last asked.
    fn contacts(&mut self) -> Vec<[f64; D]>;

    /// The edge length aimed at, where it is shortest of all.
    fn edge_length(&self) -> f64;
}

/// The system of a step, without the time step.
#[derive(Clone, Debug)]
pub struct System<S, const D: usize> {
    /// The diagonal of M_UU.
    pub mass: Vec<f64>,
    /// L_UU.
    pub stiffness: S,
    /// -(L x0)_U.
    pub force: Vec<[f64; D]>,
    /// How far beyond the bound each vertex is, in any one unit; positive.
    pub beyond: Vec<f64>,
}

/// Vertices at the bound may go on moving by up to so many edge lengths in a step.
pub const TREMBLING: f64 = 1e-6;

/// What became of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displaced {
    /// How many vertices moved.
    pub moving: usize,
    /// The largest displacement, in edge lengths of the place.
    pub largest: f64,
    /// The shortest edge length aimed at where vertices moved by more than a millionth of it; infinite where none did.
    pub shortest_edge: f64,
    /// By how much the boundary became smaller (length of curves, area of surfaces).
    pub shrunk: f64,
    /// What the boundary swept over (area of the plane, volume of space).
    pub swept: f64,
}

/// The stiffness L_UU of the moving vertices.
pub trait Stiffness {
    /// What solves with it.
    type Factor: Factor;

    /// Factors M + tau L; `last` is what came out of that with another mass.
    ///
    /// # Errors
    /// Where that is not positive definite.
    fn factor(&self, mass: &[f64], tau: f64, last: Option<Self::Factor>) -> Result<Self::Factor, Singular>;
}

/// A factored system.
pub trait Factor {
    /// Solves in place, one row for each unknown.
    fn solve<const D: usize>(&self, x: &mut [[f64; D]]);
}

/// How often a step is taken anew to let vertices land on the bound.
const LANDINGS: usize = 4;

/// A vertex that goes past the bound by less than this part of what it was beyond it has landed.
const LANDED: f64 = 0.05;

/// Takes a step of `tau`; `None` where nothing moves.
///
/// The speed jumps from the bound's curvature to nothing where the bound is reached. So what would go past it in the step
/// is slowed down until it lands there, as Filippov's solutions of such an equation do: its mass is divided by the
/// part of the way that it is to go. Without that, vertices that go past the bound one by one leave the others with a
/// bound that is sharper by about 2 tau / h².
///
/// # Errors
/// Where the system cannot be solved.
pub fn step<const D: usize, F: Front<D>>(front: &mut F, tau: f64) -> Result<Option<Displaced>, Singular> {
    let Some(System { mut mass, stiffness, force, beyond }) = front.release() else { return Ok(None) };
    let mut d = Vec::new();
    let mut last = None;
    for landing in 0..=LANDINGS {
        d.clear();
        d.extend(force.iter().map(|f| f.map(|x| tau * x)));
        let factor = stiffness.factor(&mass, tau, last.take())?;
        factor.solve(&mut d);
        last = Some(factor);
        if d.as_flattened().iter().any(|d| !d.is_finite()) {
            return Err(Singular);
        }
        if landing == LANDINGS {
            break;
        }
        let after = front.beyond(&d);
        let mut landed = true;
        for ((mass, before), after) in mass.iter_mut().zip(&beyond).zip(after) {
            if after < -LANDED * before {
                landed = false;
                *mass *= (before - after) / before;
            }
        }
        if landed {
            break;
        }
    }
    Ok(Some(front.displace(&d)))
}

/// A stiffness of any pattern: the entries on and below the diagonal.
#[derive(Clone, Debug)]
pub struct SparseStiffness(pub Vec<Entry>);

impl Stiffness for SparseStiffness {
    type Factor = SparseCholesky;

    fn factor(&self, mass: &[f64], tau: f64, last: Option<SparseCholesky>) -> Result<SparseCholesky, Singular> {
        let stiff = self.0.iter().map(|e| Entry { value: tau * e.value, ..*e });
        let masses = mass.iter().enumerate().map(|(k, m)| Entry { row: k, column: k, value: *m });
        let entries: Vec<Entry> = stiff.chain(masses).collect();
        match last {
            Some(last) => last.with(&entries),
            None => SparseCholesky::new(mass.len(), &entries),
        }
    }
}

impl Factor for SparseCholesky {
    fn solve<const D: usize>(&self, x: &mut [[f64; D]]) {
        SparseCholesky::solve(self, x);
    }
}

impl Factor for Chains {
    fn solve<const D: usize>(&self, x: &mut [[f64; D]]) {
        Chains::solve(self, x);
    }
}
