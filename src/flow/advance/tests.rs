//! Flows that do not get where they are going, on fronts that are made to fail.

use super::*;
use crate::flow::{SparseStiffness, System};
use crate::linalg::Entry;

/// A single vertex that is always beyond the bound.
struct Stuck {
    /// Its stiffness: where mass and stiffness add up to nothing, no step can be solved.
    stiffness: f64,
    /// What the boundary loses in a step.
    shrinkage: f64,
    /// How often it was moved.
    moves: u64,
    /// From this move on it crosses itself.
    crosses_at: u64,
}

impl Stuck {
    fn new(stiffness: f64, shrinkage: f64) -> Stuck {
        Stuck { stiffness, shrinkage, moves: 0, crosses_at: u64::MAX }
    }
}

impl Front<2> for Stuck {
    type Stiffness = SparseStiffness;

    fn release(&mut self) -> Option<System<SparseStiffness, 2>> {
        Some(System {
            mass: vec![1.0],
            stiffness: SparseStiffness(vec![Entry { row: 0, column: 0, value: self.stiffness }]),
            force: vec![[1.0, 0.0]],
            beyond: vec![1.0],
        })
    }

    fn beyond(&self, _: &[[f64; 2]]) -> Vec<f64> {
        vec![1.0]
    }

    fn displace(&mut self, displacements: &[[f64; 2]]) -> Displaced {
        assert!(displacements[0][0].is_finite());
        self.moves += 1;
        Displaced { moving: 1, largest: 0.1, shortest_edge: 1.0, shrunk: self.shrinkage, swept: 0.0 }
    }

    fn contacts(&mut self) -> Vec<[f64; 2]> {
        if self.moves >= self.crosses_at { vec![[7.0, 8.0]] } else { Vec::new() }
    }

    fn edge_length(&self) -> f64 {
        1.0
    }
}

const TIME_STEP: f64 = 0.05;

fn advance(front: Stuck, on_contact: OnContact) -> Advance<Stuck, 2> {
    Advance::new(front, TIME_STEP, DEFAULT_TOLERANCE, on_contact)
}

/// Steps until it ends, but no more often than that.
fn run(advance: &mut Advance<Stuck, 2>, limit: u64) -> Status {
    for _ in 0..limit {
        if advance.step(f64::INFINITY) != Status::Going {
            break;
        }
    }
    advance.status()
}

#[test]
fn a_flow_that_moves_and_never_gets_smaller_has_stalled() {
    let mut stalled = advance(Stuck::new(1.0, 0.0), OnContact::Report);
    assert_eq!(run(&mut stalled, 10 * STALL_STEPS), Status::Ended(End::Stalled));
    assert_eq!(stalled.steps, STALL_STEPS + 1);
    // What has ended is not moved any more.
    assert_eq!(stalled.step(f64::INFINITY), Status::Ended(End::Stalled));
    assert_eq!((stalled.front.moves, stalled.steps), (STALL_STEPS + 1, STALL_STEPS + 1));
    assert!(!End::Stalled.is_limit() && !End::Singular.is_limit() && !End::Contact.is_limit());
}

#[test]
fn vertices_that_tremble_in_and_out_have_stalled() {
    // What is gained is lost again: too little is left over for progress.
    let mut stalled = advance(Stuck::new(1.0, 1e-3 * STALLED_SHRINKAGE / STALL_STEPS as f64), OnContact::Report);
    assert_eq!(run(&mut stalled, 10 * STALL_STEPS), Status::Ended(End::Stalled));
}

#[test]
fn slow_progress_is_progress() {
    let mut going = advance(Stuck::new(1.0, 2.0 * STALLED_SHRINKAGE / STALL_STEPS as f64), OnContact::Report);
    assert_eq!(run(&mut going, 5 * STALL_STEPS), Status::Going);
    assert_eq!(going.steps, 5 * STALL_STEPS);
}

#[test]
fn a_step_that_cannot_be_solved_moves_nothing() {
    // Mass and stiffness cancel, or have no positive sum, or are no numbers.
    for stiffness in [-1.0 / TIME_STEP, -10.0 / TIME_STEP, f64::NAN, f64::INFINITY] {
        let mut singular = advance(Stuck::new(stiffness, 1.0), OnContact::Report);
        assert_eq!(run(&mut singular, 10), Status::Ended(End::Singular), "{stiffness}");
        assert_eq!((singular.front.moves, singular.steps, singular.time), (0, 0, 0.0), "{stiffness}");
    }
}

#[test]
fn contacts_end_a_flow_that_is_to_stop_there_and_no_other() {
    let crossing = || Stuck { crosses_at: 20, ..Stuck::new(1.0, 1.0) };
    let mut stopped = advance(crossing(), OnContact::Stop);
    assert_eq!(run(&mut stopped, 100), Status::Ended(End::Contact));
    assert!((20..25).contains(&stopped.steps) && stopped.contacts == [[7.0, 8.0]], "{}", stopped.steps);
    let mut going = advance(crossing(), OnContact::Report);
    assert_eq!(run(&mut going, 100), Status::Going);
    assert!(going.contacts.contains(&[7.0, 8.0]));
}
