//! The system of a step along a curve: frozen nodes cut the rings into chains.

use super::outline::Outline;
use crate::flow::step::{SparseStiffness, Stiffness, System};
use crate::linalg::{Chains, Closure, Entry, Singular};

/// The second difference along runs of moving nodes.
#[derive(Clone, Debug, Default)]
pub struct Runs {
    /// Where each run ends, and whether it is a whole ring.
    ends: Vec<(usize, Closure)>,
    /// The reciprocal length of the edge before each node.
    before: Vec<f64>,
    /// The same of the edge after it.
    after: Vec<f64>,
}

impl Runs {
    fn ranges(&self) -> impl Iterator<Item = (std::ops::Range<usize>, Closure)> + '_ {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|(end, _)| *end));
        starts.zip(&self.ends).map(|(start, &(end, closure))| (start..end, closure))
    }

    /// Whether some ring moves as a whole.
    pub fn has_ring(&self) -> bool {
        self.ends.iter().any(|(_, closure)| *closure == Closure::Ring)
    }

    /// Whether some run ends at nodes that stay.
    pub fn has_open_run(&self) -> bool {
        self.ends.iter().any(|(_, closure)| *closure == Closure::Open)
    }

    /// The same matrix by its entries.
    pub fn to_sparse(&self) -> SparseStiffness {
        let mut entries = Vec::new();
        for (range, closure) in self.ranges() {
            for k in range.clone() {
                entries.push(Entry { row: k, column: k, value: self.before[k] + self.after[k] });
                let next = if k + 1 < range.end { k + 1 } else { range.start };
                if k < next || closure == Closure::Ring {
                    entries.push(Entry { row: k.max(next), column: k.min(next), value: -self.after[k] });
                }
            }
        }
        SparseStiffness(entries)
    }
}

impl Stiffness for Runs {
    type Factor = Chains;

    fn factor(&self, mass: &[f64], tau: f64, _: Option<Chains>) -> Result<Chains, Singular> {
        let mut chains = Chains::default();
        for (range, closure) in self.ranges() {
            let row = |k: usize| (mass[k] + tau * (self.before[k] + self.after[k]), -tau * self.after[k]);
            chains.push(range.map(row), closure)?;
        }
        Ok(chains)
    }
}

/// The system of the moving nodes, which stand in `moving` run after run; `run_ends` tells where the runs end.
pub(super) fn system(
    outline: &Outline,
    moving: &[u32],
    ends: Vec<(usize, Closure)>,
    beyond: Vec<f64>,
) -> System<Runs, 2> {
    let n = moving.len();
    let mut runs = Runs { ends, before: Vec::with_capacity(n), after: Vec::with_capacity(n) };
    let (mut mass, mut force) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for &i in moving {
        let node = outline.node(i);
        let (to_prev, to_next) =
            (outline.node(node.prev).point - node.point, outline.node(node.next).point - node.point);
        let (a, b) = (to_prev.norm(), to_next.norm());
        runs.before.push(1.0 / a);
        runs.after.push(1.0 / b);
        mass.push(0.5 * (a + b));
        force.push((to_prev / a + to_next / b).into());
    }
    System { mass, stiffness: runs, force, beyond }
}
