//! What rings leave standing between them, and short ways from the rings over it.
//!
//! Rings with rounded corners lie farther apart in sharp corners than on straight stretches, and rings narrower than the
//! path radius vanish. What no ring reaches is found by the overlay of what they sweep, and cut by straight ways from the
//! nearest ring: the disk around an uncut point that reaches to that ring has no ring in it, not the outermost one either,
//! so that the way never leaves the pocket.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use crate::cam::stroke::{Polygon, Stroke};
use crate::plane::{BoundaryIndex, Point, Region, Ring, Segment, inscribed_circle};

/// Chord error of the overlay, in tool radii.
const FLATTENING: f64 = 1e-4;

/// Pieces that hold no larger circle than this, in tool radii, are errors of the overlay: several times its chord error.
const SMALLEST: f64 = 1e-3;

/// The most rounds of spurs: each takes the middle out of every piece that is left.
const MOST_ROUNDS: usize = 60;

/// A straight way from a ring over an uncut place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spur {
    /// On a ring.
    pub from: Point,
    /// In the middle of the place.
    pub to: Point,
}

/// The ways over all that a tool of `radius` along `rings` leaves standing inside of `outline`, which is one of them.
pub(super) fn spurs(outline: &Region, rings: &[Vec<Segment>], radius: f64) -> Vec<Spur> {
    let tolerance = FLATTENING * radius;
    // A little less than the tool sweeps, so that nothing is missed.
    let stroke = Stroke { radius: radius - tolerance, tolerance };
    let polygon = |ring: &Ring| ring.flatten(tolerance).iter().map(|p| [p.x, p.y]).collect::<Polygon>();
    let area: Vec<Polygon> = outline.rings.iter().map(polygon).collect();
    let swept: Vec<Polygon> = rings.iter().flat_map(|path| stroke.rings(path)).collect();
    let mut left = area.overlay_as::<i64>(&swept, OverlayRule::Difference, FillRule::NonZero);
    let index = BoundaryIndex::of_segments(rings.iter().flatten().copied().collect());
    let mut spurs = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let mut swept: Vec<Polygon> = Vec::new();
        let mut uncut: Vec<Polygon> = Vec::new();
        for shape in left {
            let ring = |points: &Polygon| Ring::polygon(points.iter().map(|&[x, y]| Point::new(x, y)));
            let circle = inscribed_circle(&Region::new(shape.iter().map(ring).collect()));
            if circle.radius < SMALLEST * radius {
                continue;
            }
            let Some((_, nearest)) = index.nearest(circle.center) else { return spurs };
            let spur = Spur { from: nearest.point, to: circle.center };
            swept.extend(stroke.rings(&[Segment::line(spur.from, spur.to)]));
            spurs.push(spur);
            uncut.extend(shape);
        }
        if uncut.is_empty() {
            break;
        }
        left = uncut.overlay_as::<i64>(&swept, OverlayRule::Difference, FillRule::NonZero);
    }
    spurs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Ring {
        Ring::polygon([(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| Point::new(x, y)))
    }

    #[test]
    fn a_wide_middle_is_reached_by_spurs_and_a_narrow_one_needs_none() {
        let wide = Region::new(vec![square(5.0)]);
        let path: Vec<Vec<Segment>> = vec![wide.segments().collect()];
        assert!(spurs(&wide, &path, 5.01).is_empty());
        let found = spurs(&wide, &path, 4.0);
        // A square of 2 x 2 is left: one way to its middle covers it.
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].to.coords.norm() < 0.1);
        assert!((found[0].from.coords.amax() - 5.0).abs() < 1e-9);
    }
}
