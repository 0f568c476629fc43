//! The motions at a feed of a program, arranged for finding those near a place.

use super::motion::{Motion, Program};
use crate::plane::{Bounds, ChainTree, Point};

/// Motions at a feed with boxes around what they trace.
pub(super) struct Feeds<'a> {
    motions: Vec<&'a Motion>,
    tree: ChainTree,
}

impl<'a> Feeds<'a> {
    /// Those of a program.
    pub(super) fn new(program: &'a Program) -> Feeds<'a> {
        let motions: Vec<&Motion> = program.motions.iter().filter(|m| m.is_feed()).collect();
        let traced = |m: &&Motion| {
            let ends = Bounds::of_points([m.from.xy(), m.to.xy()]);
            m.trace().fold(ends, |bounds, element| bounds.union(element.bounds()))
        };
        let boxes: Vec<Bounds> = motions.iter().map(traced).collect();
        Feeds { motions, tree: ChainTree::new(&boxes) }
    }

    /// Whether `test` is true of some motion that may come within `distance` of `p` in the plane.
    pub(super) fn any_near(&self, p: Point, distance: f64, mut test: impl FnMut(&Motion) -> bool) -> bool {
        self.tree.any_near(p, distance, |k| test(self.motions[k]))
    }

    /// The lowest place that any of them reaches; infinitely high without motions.
    pub(super) fn lowest(&self) -> f64 {
        self.motions.iter().map(|m| m.lowest()).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    #[test]
    fn motions_are_found_where_they_pass_and_nowhere_else() {
        let program =
            read("G21 G90 G17 G94\nG0 Z5\nG0 X50 Y50\nF100\nG1 Z-1\nG3 X50 Y50 I-10 J0\nG1 X90\nG0 Z5\nG0 X0 Y0\n")
                .unwrap();
        let feeds = Feeds::new(&program);
        assert_eq!(feeds.lowest(), -1.0);
        // The far side of the circle, which no end of it is near to; the plunge; and no rapid.
        assert!(feeds.any_near(Point::new(30.0, 50.0), 0.5, |m| m.trace().count() == 2));
        assert!(feeds.any_near(Point::new(50.0, 50.0), 0.0, |m| m.trace().next().is_none()));
        assert!(!feeds.any_near(Point::new(0.0, 0.0), 5.0, |m| !m.is_feed() || m.to.xy() == Point::origin()));
        assert!(Feeds::new(&Program::default()).lowest() > 0.0);
    }
}
