//! The pieces by which a closing or opening differs from its part, and how each of them touches the part.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;

use crate::plane::{BoundaryIndex, Link, Point, Region, Ring, Segment, turn_angle};

/// The sagitta of flattened arcs over the radius.
pub(super) const FLATNESS: f64 = 1e-3;

/// Where both boundaries are nearer than this over the radius, nothing has moved: what flattening makes of two arcs that
/// coincide, with room.
const SLIVER: f64 = 2.5 * FLATNESS;

/// Runs along the outline of a piece shorter than this over the radius do not count as contacts: near the ends of a
/// tangent arc it is the flattening that decides which boundary an edge is on.
const SHORTEST_CONTACT: f64 = 2e-2;

/// A turn above this (radians) is a corner: where arcs meet smoothly offsets know their tangents to 1e-6.
const TIP: f64 = 1e-4;

/// A corner farther from the part than this over the radius does not rest on it.
const OFF_PART: f64 = 1e-6;

/// A connected piece of the difference.
pub(super) struct Piece {
    /// Its outline: an outer ring and its holes, as polygons.
    pub(super) outline: Region,
    /// Stretches of its outline that were the part's boundary.
    pub(super) contacts: Vec<Contact>,
    /// Stretches of its outline that are new boundary, each with its points in order.
    pub(super) new_stretches: Vec<Vec<Point>>,
    /// Whether new boundary has a corner off the part's boundary: two disks that have not rolled from one place to the other
    /// meet there, in a neck that neither can pass.
    pub(super) has_tip: bool,
}

/// A stretch of a piece's outline that was the part's boundary.
pub(super) struct Contact {
    /// Index of the ring in the part.
    pub(super) ring: usize,
    /// Whether it is a whole ring of the outline.
    pub(super) is_whole_ring: bool,
    /// Its points in order.
    pub(super) points: Vec<Point>,
}

impl Piece {
    /// The greatest distance of what was the part's boundary from the new one: how deep a filling is. Zero without new
    /// boundary.
    pub(super) fn depth(&self) -> f64 {
        let new: Vec<Segment> =
            self.new_stretches.iter().flat_map(|s| s.windows(2)).map(|w| Segment::line(w[0], w[1])).collect();
        if new.is_empty() {
            return 0.0;
        }
        let index = BoundaryIndex::of_segments(new);
        self.contacts.iter().flat_map(|c| &c.points).map(|p| index.distance(*p)).fold(0.0, f64::max)
    }

    /// Whether the piece is made across the plane, and not along the curve: an ordinary fillet is glued to the part along one
    /// stretch and has one free side, on which disks rest on the part wherever they meet.
    pub(super) fn is_topological(&self) -> bool {
        self.contacts.len() != 1 || self.new_stretches.len() != 1 || self.has_tip
    }
}

/// Polygons of a region, with arcs flattened to [`FLATNESS`] of the radius.
pub(super) fn polygons(region: &Region, sagitta: f64) -> Vec<Vec<[f64; 2]>> {
    let polygon = |ring: &Ring| ring.flatten(sagitta).iter().map(|p| [p.x, p.y]).collect();
    region.rings.iter().map(polygon).collect()
}

/// A boolean operation on two regions with arcs flattened to `sagitta`: shapes of an outer ring and its holes.
pub(super) fn overlay(a: &Region, b: &Region, rule: OverlayRule, sagitta: f64) -> Vec<Region> {
    let (a, b) = (polygons(a, sagitta), polygons(b, sagitta));
    // Its integer grid needs finite coordinates of moderate size; others have no difference that could be measured.
    let is_sane = |x: &f64| x.abs() < 1e150;
    if !a.iter().chain(&b).flatten().flatten().all(is_sane) {
        return Vec::new();
    }
    let shapes = FloatOverlay::<[f64; 2], i64>::from_subj_and_clip(&a, &b).overlay(rule, FillRule::NonZero);
    let ring = |c: &Vec<[f64; 2]>| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1])));
    shapes.iter().map(|shape| Region::new(shape.iter().map(ring).collect())).collect()
}

/// The pieces of `larger` outside `smaller`, seen from `part`, which is one of the two.
pub(super) fn pieces(part: &Region, result: &Region, larger: &Region, smaller: &Region, radius: f64) -> Vec<Piece> {
    let sagitta = FLATNESS * radius;
    let shapes = overlay(larger, smaller, OverlayRule::Difference, sagitta);
    // Flattened as in the difference: an edge of a piece then lies on one of the two to the grid of the overlay, and near
    // the end of a tangent arc it cannot be mistaken for the other.
    let part_index = flattened_index(part, sagitta);
    let result_index = flattened_index(result, sagitta);
    let ring_of: Vec<usize> =
        part.rings.iter().enumerate().flat_map(|(k, r)| std::iter::repeat_n(k, r.flatten(sagitta).len())).collect();
    let tips = tips(result, part, radius);
    let mut found = Vec::new();
    let outlines = shapes.iter().flat_map(|s| without_slivers(s, &part_index, &result_index, radius));
    for outline in outlines {
        let mut piece = Piece { outline, contacts: Vec::new(), new_stretches: Vec::new(), has_tip: false };
        for ring in &piece.outline.rings {
            let runs = runs(ring, &part_index, &result_index, &ring_of, radius);
            let is_whole_ring = runs.len() == 1;
            for run in runs {
                match run.part_ring {
                    Some(ring) => piece.contacts.push(Contact { ring, is_whole_ring, points: run.points }),
                    None => piece.new_stretches.push(run.points),
                }
            }
        }
        if !tips.is_empty() {
            let outline = BoundaryIndex::new(&piece.outline);
            piece.has_tip = tips.iter().any(|p| outline.is_nearer(*p, sagitta));
        }
        found.push(piece);
    }
    found
}

/// Corners between two arcs of the result, off the part's boundary.
fn tips(result: &Region, part: &Region, radius: f64) -> Vec<Point> {
    let part = BoundaryIndex::new(part);
    let is_tip = |before: &Segment, after: &Segment| {
        matches!((before.link, after.link), (Link::Arc(_), Link::Arc(_)))
            && turn_angle(before.end_tangent(), after.start_tangent()).abs() > TIP
            && !part.is_nearer(after.start, OFF_PART * radius)
    };
    let mut found = vec![];
    for ring in &result.rings {
        let Some(mut before) = ring.segments().last() else { continue };
        for after in ring.segments() {
            if is_tip(&before, &after) {
                found.push(after.start);
            }
            before = after;
        }
    }
    found
}

fn flattened_index(region: &Region, sagitta: f64) -> BoundaryIndex {
    let polygon = |ring: &Ring| Ring::polygon(ring.flatten(sagitta));
    let rings: Vec<Ring> = region.rings.iter().map(polygon).collect();
    // In the order of the rings: the numbers of elements are asked for.
    BoundaryIndex::of_segments(rings.iter().flat_map(Ring::segments).collect())
}

/// The pieces that remain of an outline without its slivers.
///
/// Where both boundaries run along each other, rounding and flattening leave slivers that string pieces together like
/// beads. Edges near to both boundaries are taken out, and the ends of what is left are joined to the nearest beginnings.
fn without_slivers(shape: &Region, part: &BoundaryIndex, result: &BoundaryIndex, radius: f64) -> Vec<Region> {
    let thin = SLIVER * radius;
    let is_sliver = |s: &Segment| {
        let middle = nalgebra::center(&s.start, &s.end);
        part.is_nearer(middle, thin) && result.is_nearer(middle, thin)
    };
    let mut rings: Vec<Ring> = Vec::new();
    let mut chains: Vec<Vec<Point>> = Vec::new();
    for ring in &shape.rings {
        let slivers: Vec<bool> = ring.segments().map(|s| is_sliver(&s)).collect();
        let n = slivers.len();
        let Some(first) = slivers.iter().position(|x| *x) else {
            rings.push(ring.clone());
            continue;
        };
        let mut is_open = false;
        for i in (1..=n).map(|k| (first + k) % n) {
            let s = ring.segment(i);
            if slivers[i] {
                is_open = false;
                continue;
            }
            match chains.last_mut().filter(|_| is_open) {
                Some(chain) => chain.push(s.end),
                None => chains.push(vec![s.start, s.end]),
            }
            is_open = true;
        }
    }
    while let Some(mut chain) = chains.pop() {
        loop {
            let (begin, end) = (chain[0], chain[chain.len() - 1]);
            let gap = |other: &Vec<Point>| (other[0] - end).norm();
            let nearest = (0..chains.len()).min_by(|&i, &j| gap(&chains[i]).total_cmp(&gap(&chains[j])));
            match nearest.filter(|&i| gap(&chains[i]) < (begin - end).norm()) {
                Some(i) => chain.extend(chains.remove(i)),
                None => break,
            }
        }
        rings.push(Ring::polygon(chain));
    }
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|r| r.area() > 0.0);
    let mut regions: Vec<Region> = outer.into_iter().map(|r| Region::new(vec![r])).collect();
    for hole in holes {
        let inside = hole.vertices[0].point;
        if let Some(region) = regions.iter_mut().find(|region| region.rings[0].winding_number(inside) > 0) {
            region.rings.push(hole);
        }
    }
    regions
}

/// A stretch of an outline on the part's boundary (with the ring's index) or on the result's.
struct Run {
    part_ring: Option<usize>,
    length: f64,
    points: Vec<Point>,
}

fn runs(ring: &Ring, part: &BoundaryIndex, result: &BoundaryIndex, ring_of: &[usize], radius: f64) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for s in ring.segments() {
        let middle = nalgebra::center(&s.start, &s.end);
        let on_part = part.nearest(middle);
        let on_result = result.distance(middle);
        let part_ring = on_part.filter(|(_, n)| n.distance < on_result).map(|(i, _)| ring_of[i]);
        match runs.last_mut().filter(|run| run.part_ring == part_ring) {
            Some(run) => {
                run.length += s.length();
                run.points.push(s.end);
            }
            None => runs.push(Run { part_ring, length: s.length(), points: vec![s.start, s.end] }),
        }
    }
    let longest = runs.iter().map(|r| r.length).fold(0.0, f64::max);
    // On a piece that is small as a whole the longest stretches still count.
    let shortest = (SHORTEST_CONTACT * radius).min(0.1 * longest);
    runs.retain(|run| run.length >= shortest);
    let mut merged: Vec<Run> = Vec::new();
    for run in runs {
        match merged.last_mut().filter(|last| last.part_ring == run.part_ring) {
            Some(last) => last.append(run),
            None => merged.push(run),
        }
    }
    if merged.len() > 1 && merged[0].part_ring == merged[merged.len() - 1].part_ring {
        let first = merged.remove(0);
        if let Some(last) = merged.last_mut() {
            last.append(first);
        }
    }
    merged
}

impl Run {
    fn append(&mut self, next: Run) {
        self.length += next.length;
        self.points.extend(next.points);
    }
}
