//! How much results of one drawing differ from each other.

use i_overlay::core::overlay_rule::OverlayRule;

use super::Place;
use super::compare::AREA_FLATNESS;
use super::farthest::{RESOLUTION, farthest};
use super::moved::overlay;
use super::report::finite_or_word;
use crate::plane::{BoundaryIndex, Region};
use crate::units::Radius;

/// A result and what it is called.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it is.
    pub region: &'a Region,
}

/// How much two results differ. Lengths are in the units of the drawing.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// One of the two.
    pub first: String,
    /// The other.
    pub second: String,
    /// The largest distance from a point of one boundary to the other, both ways; infinite where one of them is empty.
    #[serde(serialize_with = "finite_or_word")]
    pub largest_units: f64,
    /// Where it is found; none where they do not differ.
    pub place: Option<Place>,
    /// The area of what is in one and not in the other, with arcs flattened to 1e-5 of the radius.
    pub symmetric_difference_units2: f64,
}

/// Every two of the results compared, each with those that follow it: no point of a boundary is farther from the other
/// than the one found by more than 1e-6 of `radius`.
pub fn differences(results: &[Named], radius: Radius) -> Vec<Difference> {
    let indices: Vec<BoundaryIndex> = results.iter().map(|r| BoundaryIndex::new(r.region)).collect();
    let pairs = (0..results.len()).flat_map(|i| (i + 1..results.len()).map(move |j| (i, j)));
    let compared = pairs.map(|(i, j)| {
        let (a, b, r) = (results[i], results[j], radius.get());
        let forth = farthest(a.region, &indices[j], RESOLUTION * r, |_, d| d, &|_, _| false);
        let back = farthest(b.region, &indices[i], RESOLUTION * r, |_, d| d, &|_, _| false);
        let (largest, place) = if forth.0 >= back.0 { forth } else { back };
        let differing = overlay(a.region, b.region, OverlayRule::Xor, AREA_FLATNESS * r);
        Difference {
            first: a.name.to_owned(),
            second: b.name.to_owned(),
            largest_units: largest,
            place: place.filter(|_| largest > 0.0).map(Into::into),
            symmetric_difference_units2: differing.iter().map(Region::area).sum(),
        }
    });
    compared.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Point, Ring};

    #[test]
    fn every_two_of_three_are_compared_both_ways() {
        let square = |a: f64| {
            Region::new(vec![Ring::polygon([(0.0, 0.0), (a, 0.0), (a, a), (0.0, a)].map(|(x, y)| Point::new(x, y)))])
        };
        let (small, large, none) = (square(1.0), square(3.0), Region::default());
        let named =
            [("small", &small), ("large", &large), ("none", &none)].map(|(name, region)| Named { name, region });
        let found = differences(&named, Radius::new(1.0).unwrap());
        let names: Vec<String> = found.iter().map(|d| format!("{} {}", d.first, d.second)).collect();
        assert_eq!(names, ["small large", "small none", "large none"]);
        // The far corner of the large square is the farthest from the small one.
        assert!((found[0].largest_units - 8f64.sqrt()).abs() < 1e-6);
        assert_eq!(found[0].place.map(|p| (p.x, p.y)), Some((3.0, 3.0)));
        assert!((found[0].symmetric_difference_units2 - 8.0).abs() < 1e-6);
        assert!(found[1].largest_units.is_infinite());
        let same = differences(&[named[1], named[1]], Radius::new(1.0).unwrap());
        assert_eq!((same[0].largest_units, same[0].place), (0.0, None));
        assert!(same[0].symmetric_difference_units2 < 1e-9);
    }
}
