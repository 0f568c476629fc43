//! What stays, closed for a tool and the radius of its path.
//!
//! The radius that follows from feed and acceleration is a wish. An outline that the tool can cut and that this radius would
//! lose (a hole that it fills, parts that it joins, a hole that it cuts in two) gets half of it, and half of that again,
//! until nothing is lost; the others keep it.

use std::collections::{BTreeMap, HashMap};

use crate::plane::{BoundaryIndex, Bounds, Point, Region, Ring, Segment};
use crate::rolling::{self, Topology};
use crate::units::Radius;

/// How often the radius is halved before the path stays sharp.
const HALVINGS: i32 = 4;

/// What stays, closed.
#[derive(Clone, Debug)]
pub struct ClosedForPath {
    /// The region.
    pub region: Region,
    /// Contradictions that rounding left, see [`rolling::Outcome`].
    pub contradictions: usize,
    /// Outlines with a smaller path radius, and the smallest in millimetres; `None` where all have the one asked for.
    pub eased: Option<(usize, f64)>,
}

/// Closes `stays` so that a path at `distance` turns nowhere tighter than `path_radius`, both in millimetres; outlines that the
/// tool can cut and that this would lose get a smaller one if `eases` says so.
pub fn close_for_path(
    stays: &Region,
    distance: f64,
    path_radius: f64,
    eases: bool,
    topology: Topology,
) -> ClosedForPath {
    let close = |path_radius: f64| match Radius::new(distance + path_radius) {
        Ok(radius) => {
            let outcome = rolling::close(stays, radius, topology);
            ClosedForPath { region: outcome.region, contradictions: outcome.contradictions, eased: None }
        }
        // Nothing is to be closed on the outline itself.
        Err(_) => ClosedForPath { region: stays.clone(), contradictions: 0, eased: None },
    };
    let closed = close(path_radius);
    // What is not lost to the radius of the tool and the path is not lost to that of the tool.
    if !eases
        || path_radius <= 0.0
        || ring_by_ring(stays, &closed.region)
        || Outlines::new(stays, &closed.region).lost(stays).is_none()
    {
        return closed;
    }
    let sharp = close(0.0).region;
    ease(&sharp, &closed, path_radius, close).unwrap_or(closed)
}

/// Whether it is plain to see that every ring of a closing is made of one ring of what was closed, and every one of these made
/// into one: by the vertices that have not moved.
fn ring_by_ring(stays: &Region, closed: &Region) -> bool {
    let bits = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    let vertices = |(k, ring): (usize, &'_ Ring)| ring.vertices.iter().map(|v| (bits(v.point), k)).collect::<Vec<_>>();
    let ring_at: HashMap<[u64; 2], usize> = stays.rings.iter().enumerate().flat_map(vertices).collect();
    let mut made_of: Vec<usize> = Vec::new();
    for ring in &closed.rings {
        let mut sources = ring.vertices.iter().filter_map(|v| ring_at.get(&bits(v.point)));
        let Some(&first) = sources.next() else { return false };
        if sources.any(|source| *source != first) {
            return false;
        }
        made_of.push(first);
    }
    made_of.sort_unstable();
    made_of.into_iter().eq(0..stays.rings.len())
}

/// The closing with smaller radii for the outlines that the tool alone would not lose; `None` where there are none.
fn ease(
    sharp: &Region,
    rounded: &ClosedForPath,
    path_radius: f64,
    close: impl Fn(f64) -> ClosedForPath,
) -> Option<ClosedForPath> {
    let outlines = Outlines::new(sharp, &rounded.region);
    let Lost { kept, mut outlines_lost } = outlines.lost(sharp)?;
    let count = outlines_lost.len();
    let mut rings: Vec<Ring> = kept.into_iter().map(|k| rounded.region.rings[k].clone()).collect();
    let (mut contradictions, mut least) = (rounded.contradictions, path_radius);
    for radius in (1..=HALVINGS).map(|h| path_radius * 0.5f64.powi(h)).chain([0.0]) {
        let closed = close(radius);
        let found = outlines.of(&closed.region)?;
        outlines_lost.retain(|(outline, asked)| {
            let own = found.get(outline).map_or(&[][..], Vec::as_slice);
            let stands = structure(&closed.region, own) == *asked;
            if stands {
                rings.extend(own.iter().map(|&k| closed.region.rings[k].clone()));
                least = radius;
            }
            !stands
        });
        contradictions = contradictions.max(closed.contradictions);
        if outlines_lost.is_empty() {
            return Some(ClosedForPath { region: Region::new(rings), contradictions, eased: Some((count, least)) });
        }
    }
    None
}

/// What a rounded closing loses.
struct Lost {
    /// The rings of the rounded closing that are as they should be.
    kept: Vec<usize>,
    /// The outlines whose rings are not, and how many outer rings and holes each should have.
    outlines_lost: Vec<(Outline, [usize; 2])>,
}

/// Outer rings and holes.
fn structure(region: &Region, rings: &[usize]) -> [usize; 2] {
    let holes = rings.iter().filter(|&&k| region.rings[k].area() < 0.0).count();
    [rings.len() - holes, holes]
}

/// What the tool goes around, or into, by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outline {
    /// A hole of what stays, with the islands in it, by its ring in the sharp closing.
    Hole(usize),
    /// What is joined by the rounded closing, by its outer ring there.
    Outside(usize),
}

/// The outlines of a sharp closing, and how the rounded one joins those around which all is open.
struct Outlines<'a> {
    /// The boundary of the sharp closing, with the ring of each element.
    boundary: BoundaryIndex,
    ring_of: Vec<usize>,
    /// For each of its rings the hole that it lies in or is.
    hole_of: Vec<Option<usize>>,
    /// The outer rings of the rounded closing that lie in no hole.
    outer: Vec<(Bounds, Ring)>,
    /// Their boundary, with the ring of each element.
    outer_boundary: BoundaryIndex,
    outer_of: Vec<usize>,
    /// What is nearer to a ring than this lies on it.
    touch: f64,
    rounded: &'a Region,
}

/// Rounding of closings, in parts of the size of the drawing.
const TOUCH: f64 = 1e-12;

impl<'a> Outlines<'a> {
    fn new(sharp: &Region, rounded: &'a Region) -> Outlines<'a> {
        // Seen from outside holes are areas, and outer rings their islands.
        let owners = sharp.reversed().owners();
        let hole = |k: usize| (owners[k] != k || sharp.rings[k].area() < 0.0).then_some(owners[k]);
        let (boundary, ring_of) = indexed(sharp.rings.iter());
        let hole_of: Vec<Option<usize>> = (0..sharp.rings.len()).map(hole).collect();
        let is_outside = |ring: &&Ring| ring.area() > 0.0 && hole_around(&boundary, &ring_of, &hole_of, ring).is_none();
        let outer: Vec<(Bounds, Ring)> =
            rounded.rings.iter().filter(is_outside).map(|ring| (ring.bounds(), ring.clone())).collect();
        let (outer_boundary, outer_of) = indexed(outer.iter().map(|(_, ring)| ring));
        let touch = TOUCH * rounded.bounds().diagonal();
        Outlines { boundary, ring_of, hole_of, outer, outer_boundary, outer_of, touch, rounded }
    }

    /// What the rounded closing loses of the sharp one: `None` where that is nothing, or the two cannot be compared.
    fn lost(&self, sharp: &Region) -> Option<Lost> {
        let asked = self.of(sharp)?;
        let found = self.of(self.rounded)?;
        let mut lost = Lost { kept: Vec::new(), outlines_lost: Vec::new() };
        for (outline, rings) in asked {
            let asked = structure(sharp, &rings);
            let own = found.get(&outline).map_or(&[][..], Vec::as_slice);
            if structure(self.rounded, own) == asked {
                lost.kept.extend(own);
            } else {
                lost.outlines_lost.push((outline, asked));
            }
        }
        lost.kept.sort_unstable();
        (!lost.outlines_lost.is_empty()).then_some(lost)
    }

    /// The rings of a closing between the sharp and the rounded one, by the outlines that they belong to; `None` where there is
    /// one that belongs nowhere.
    fn of(&self, region: &Region) -> Option<BTreeMap<Outline, Vec<usize>>> {
        let mut found: BTreeMap<Outline, Vec<usize>> = BTreeMap::new();
        for (k, ring) in region.rings.iter().enumerate() {
            let outline = match hole_around(&self.boundary, &self.ring_of, &self.hole_of, ring) {
                Some(hole) => Outline::Hole(hole),
                None => Outline::Outside(self.around(ring.vertices.first()?.point)?),
            };
            found.entry(outline).or_default().push(k);
        }
        Some(found)
    }

    /// The outer ring of the rounded closing that a point lies on or in: the smallest, where they lie in each other.
    fn around(&self, place: Point) -> Option<usize> {
        let (nearest, found) = self.outer_boundary.nearest(place)?;
        if found.distance <= self.touch {
            return Some(self.outer_of[nearest]);
        }
        let is_around = |&k: &usize| self.outer[k].0.contains(place) && self.outer[k].1.winding_number(place) != 0;
        let area = |k: usize| self.outer[k].1.area();
        (0..self.outer.len()).filter(is_around).min_by(|&i, &j| area(i).total_cmp(&area(j)))
    }
}

/// The boundary of some rings, with the number of the ring of each element.
fn indexed<'a>(rings: impl Iterator<Item = &'a Ring>) -> (BoundaryIndex, Vec<usize>) {
    let elements: Vec<(usize, Segment)> =
        rings.enumerate().flat_map(|(k, ring)| ring.segments().map(move |segment| (k, segment))).collect();
    let (ring_of, elements) = elements.into_iter().unzip();
    (BoundaryIndex::of_segments(elements), ring_of)
}

/// The hole of the sharp closing that a ring lies in. The ring is of a closing that is no smaller: the boundary nearest to any
/// point of it bounds what it lies in.
fn hole_around(boundary: &BoundaryIndex, ring_of: &[usize], hole_of: &[Option<usize>], ring: &Ring) -> Option<usize> {
    let (nearest, _) = boundary.nearest(ring.vertices.first()?.point)?;
    hole_of[ring_of[nearest]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Link;

    fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Ring {
        let p = |dx: f64, dy: f64| Point::new(x + dx, y + dy);
        Ring::polygon([p(0.0, 0.0), p(width, 0.0), p(width, height), p(0.0, height)])
    }

    fn hole(x: f64, y: f64, width: f64, height: f64) -> Ring {
        rectangle(x, y, width, height).reversed()
    }

    /// A tool of radius 1.5, a path radius of 1.
    fn close(rings: Vec<Ring>) -> ClosedForPath {
        close_for_path(&Region::new(rings), 1.5, 1.0, true, Topology::Merge)
    }

    #[test]
    fn holes_that_the_tool_fits_into_stay_and_the_others_keep_their_path_radius() {
        let narrow = hole(10.0, 10.0, 3.9, 12.0);
        let found = close(vec![
            rectangle(0.0, 0.0, 60.0, 30.0),
            hole(30.0, 5.0, 20.0, 20.0),
            narrow,
            hole(22.0, 10.0, 2.0, 5.0),
        ]);
        assert_eq!(found.eased, Some((1, 0.25)), "half of it would fill the hole still");
        let [outer, wide, narrow] = found.region.rings.as_slice() else { panic!("{:?}", found.region.rings.len()) };
        let radii = |ring: &Ring| -> Vec<f64> {
            ring.segments()
                .filter_map(|s| match s.link {
                    Link::Arc(arc) => Some(arc.radius),
                    Link::Line => None,
                })
                .collect()
        };
        assert_eq!(radii(outer), Vec::<f64>::new());
        assert_eq!(radii(wide), [2.5; 4]);
        assert_eq!(radii(narrow), [1.75; 4]);
    }

    #[test]
    fn parts_that_the_tool_fits_between_stay_apart() {
        let parts =
            vec![rectangle(0.0, 0.0, 20.0, 20.0), rectangle(23.9, 0.0, 20.0, 20.0), rectangle(100.0, 0.0, 20.0, 20.0)];
        let found = close(parts.clone());
        assert_eq!((found.eased, found.region.topology().components), (Some((1, 0.25)), 3));
        // Where it does not, nothing is eased.
        let near = vec![rectangle(0.0, 0.0, 20.0, 20.0), rectangle(22.0, 0.0, 20.0, 20.0)];
        let found = close(near);
        assert_eq!((found.eased, found.region.topology().components), (None, 1));
        let asked = close_for_path(&Region::new(parts), 1.5, 1.0, false, Topology::Merge);
        assert_eq!((asked.eased, asked.region.topology().components), (None, 2));
    }

    #[test]
    fn a_hole_with_a_waist_stays_one_and_so_does_an_island_in_it() {
        // Two rooms with a passage of 3.9 mm; a room with an island that leaves as much.
        let p = Point::new;
        let waist = Ring::polygon([
            p(5.0, 5.0),
            p(15.0, 5.0),
            p(15.0, 13.05),
            p(25.0, 13.05),
            p(25.0, 5.0),
            p(35.0, 5.0),
            p(35.0, 25.0),
            p(25.0, 25.0),
            p(25.0, 16.95),
            p(15.0, 16.95),
            p(15.0, 25.0),
            p(5.0, 25.0),
        ]);
        let found = close(vec![
            rectangle(0.0, 0.0, 100.0, 30.0),
            waist.reversed(),
            hole(50.0, 5.0, 20.0, 20.0),
            rectangle(53.9, 8.9, 12.2, 12.2),
        ]);
        assert_eq!(found.eased, Some((2, 0.25)));
        let topology = found.region.topology();
        assert_eq!((topology.components, topology.holes), (2, 2));
        // The same as pockets, seen from the other side.
        let pockets =
            Region::new(vec![waist, rectangle(50.0, 5.0, 20.0, 20.0), hole(53.9, 8.9, 12.2, 12.2)]).reversed();
        let found = close_for_path(&pockets, 1.5, 1.0, true, Topology::Merge);
        assert_eq!((found.eased, found.region.rings.len()), (Some((2, 0.25)), 3));
    }

    #[test]
    fn on_the_outline_the_sharp_path_is_the_outline() {
        let gap = Region::new(vec![rectangle(0.0, 0.0, 20.0, 20.0), rectangle(20.05, 0.0, 20.0, 20.0)]);
        let found = close_for_path(&gap, 0.0, 1.0, true, Topology::Merge);
        assert_eq!((found.eased, found.region), (Some((1, 0.0)), gap));
    }

    #[test]
    fn random_drawings_lose_no_outline_that_the_tool_can_cut() {
        // Boxes of 3 to 14 mm on a plate and holes of that size in it, strewn by a fixed walk; those that meet others are left out.
        for first in 0..60u32 {
            let number =
                |k: u32, span: f64| f64::from((k + 97 * first).wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0 * span;
            let mut boxes: Vec<(Bounds, Ring)> = Vec::new();
            for k in 0..60 {
                let ring = rectangle(
                    number(4 * k, 90.0),
                    number(4 * k + 1, 90.0),
                    3.0 + number(4 * k + 2, 11.0),
                    3.0 + number(4 * k + 3, 11.0),
                );
                let bounds = ring.bounds();
                if boxes.iter().all(|(other, _)| !other.inflated(0.2).overlaps(&bounds)) {
                    boxes.push((bounds, ring));
                }
            }
            let parts = Region::new(boxes.iter().map(|(_, ring)| ring.clone()).collect());
            let mut holes = parts.reversed();
            holes.rings.push(rectangle(-5.0, -5.0, 115.0, 115.0));
            for stays in [parts.clone(), holes, parts.reversed()] {
                let sharp = close_for_path(&stays, 1.5, 0.0, true, Topology::Merge).region.topology();
                let asked = close_for_path(&stays, 1.5, 1.0, false, Topology::Merge);
                let eased = close_for_path(&stays, 1.5, 1.0, true, Topology::Merge);
                assert_eq!(eased.region.topology(), sharp, "{first}");
                assert_eq!(eased.eased.is_none(), asked.region.topology() == sharp, "{first}");
                if eased.eased.is_none() {
                    assert_eq!(eased.region, asked.region);
                }
            }
        }
    }
}
