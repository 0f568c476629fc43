//! What a closing fills, or an opening removes, beyond rounding corners.

use std::collections::{BTreeSet, BinaryHeap};

use super::Place;
use super::moved::{Contact, Piece, pieces};
use crate::plane::{BoundaryIndex, Point, Region, Vector};
use crate::units::Radius;

/// An inlet shallower than this over the radius is texture, not a feature.
pub const SHALLOWEST_INLET: f64 = 0.5;

/// An inlet at least this deep over the width of its mouth is a slot that vanished. The fillet of a corner of 53 degrees or more is
/// shallower.
pub const SLOT_DEPTH: f64 = 1.0;

/// An inlet that fills at least this fraction of the rectangle of its mouth and depth is a slot that vanished, however
/// wide: a corner of two straight walls fills half of it.
pub const SLOT_FULLNESS: f64 = 0.75;

/// Accuracy of inscribed circles, over the size of the piece.
const INSCRIBED_ACCURACY: f64 = 0.01;

/// The most cells that the search for an inscribed circle looks at.
const INSCRIBED_CELLS: usize = 400;

/// Something of the part that is gone. Lengths are in the units of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum LostFeature {
    /// A closing filled a whole hole.
    HoleFilled {
        /// Centre of the largest circle in the hole.
        center: Place,
        /// Diameter of that circle.
        diameter: f64,
        /// Area of the hole.
        area: f64,
    },
    /// A closing joined separate parts.
    PartsMerged {
        /// How many parts meet at this bridge.
        components: usize,
        /// Centre of the largest circle in the bridge.
        place: Place,
        /// Diameter of that circle.
        width: f64,
    },
    /// A closing filled a slot, or the mouth of an inlet, or a neck of a hole.
    GapFilled {
        /// Centre of the largest circle in the filling.
        place: Place,
        /// The width of its mouth; or the diameter of that circle, where the filling is open on several sides.
        width: f64,
        /// Area of the filling.
        area: f64,
    },
    /// An opening removed a whole part.
    ComponentLost {
        /// Centre of the largest circle in the part.
        center: Place,
        /// Diameter of that circle.
        diameter: f64,
        /// Area of the part.
        area: f64,
    },
    /// An opening cut a neck or removed a prong or a thin wall.
    NeckCut {
        /// Centre of the largest circle in what was removed.
        place: Place,
        /// The width of its root; or the diameter of that circle, where it hung on several sides.
        width: f64,
        /// Area of what was removed.
        area: f64,
    },
}

/// What `result`, a closing or opening of `part` by a disk of `radius`, has lost; in the order of the pieces from below.
///
/// A closing has the larger area, so which of the two it is need not be said. A fillet in a corner is no loss. A filled
/// inlet is one if it is deeper than [`SHALLOWEST_INLET`] and either [deeper than wide](SLOT_DEPTH) or
/// [box-like](SLOT_FULLNESS). Accurate to about a thousandth of the radius, to which arcs are flattened.
pub fn lost_features(part: &Region, result: &Region, radius: Radius) -> Vec<LostFeature> {
    let r = radius.get();
    let is_closing = result.area() >= part.area();
    let (larger, smaller) = if is_closing { (result, part) } else { (part, result) };
    let components = Components::new(part);
    let mut found = Vec::new();
    for piece in pieces(part, result, larger, smaller, r) {
        classify(&piece, &components, is_closing, r, &mut found);
    }
    found
}

fn classify(piece: &Piece, components: &Components, is_closing: bool, r: f64, found: &mut Vec<LostFeature>) {
    let whole_ring = piece.contacts.iter().any(|c| c.is_whole_ring && components.is_hole[c.ring] == is_closing);
    let joined: BTreeSet<usize> = piece.contacts.iter().map(|c| components.of_ring[c.ring]).collect();
    let merges = is_closing && joined.len() > 1;
    let vanished = piece.new_stretches == 0 && whole_ring;
    let (is_gap, mouth) = match piece.contacts.as_slice() {
        [contact] => (is_slot(contact, r), Some(contact.mouth())),
        contacts => (contacts.len() > 1, None),
    };
    if !(vanished || merges || is_gap) {
        return;
    }
    let (center, half) = inscribed_circle(&piece.outline);
    let (place, width, area) = (Place::from(center), 2.0 * half, piece.outline.area());
    if vanished {
        found.push(if is_closing {
            LostFeature::HoleFilled { center: place, diameter: width, area }
        } else {
            LostFeature::ComponentLost { center: place, diameter: width, area }
        });
    }
    if merges {
        found.push(LostFeature::PartsMerged { components: joined.len(), place, width });
    } else if is_gap && !vanished {
        let width = mouth.unwrap_or(width);
        found.push(if is_closing {
            LostFeature::GapFilled { place, width, area }
        } else {
            LostFeature::NeckCut { place, width, area }
        });
    }
}

impl Contact {
    /// The distance of its ends.
    fn mouth(&self) -> f64 {
        match (self.points.first(), self.points.last()) {
            (Some(a), Some(b)) => (b - a).norm(),
            _ => 0.0,
        }
    }
}

/// Whether an inlet that was filled down to its bottom is more than a corner.
fn is_slot(contact: &Contact, r: f64) -> bool {
    let (Some(&a), Some(&b)) = (contact.points.first(), contact.points.last()) else { return false };
    let chord = b - a;
    let mouth = chord.norm();
    let height = |p: &Point| if mouth > 0.0 { (chord.perp(&(p - a)) / mouth).abs() } else { (p - a).norm() };
    let depth = contact.points.iter().map(height).fold(0.0, f64::max);
    if depth < SHALLOWEST_INLET * r {
        return false;
    }
    let doubled: f64 = contact.points.windows(2).map(|w| (w[0] - a).perp(&(w[1] - a))).sum();
    depth >= SLOT_DEPTH * mouth || 0.5 * doubled.abs() >= SLOT_FULLNESS * mouth * depth
}

/// Which rings of a region belong together.
struct Components {
    /// The outer ring that each ring belongs to.
    of_ring: Vec<usize>,
    is_hole: Vec<bool>,
}

impl Components {
    fn new(region: &Region) -> Components {
        let areas: Vec<f64> = region.rings.iter().map(|r| r.area()).collect();
        let owner = |k: usize| -> usize {
            if areas[k] > 0.0 {
                return k;
            }
            let Some(v) = region.rings[k].vertices.first() else { return k };
            (0..areas.len())
                .filter(|&j| areas[j] > -areas[k] && region.rings[j].winding_number(v.point) > 0)
                .min_by(|&i, &j| areas[i].total_cmp(&areas[j]))
                .unwrap_or(k)
        };
        Components { of_ring: (0..areas.len()).map(owner).collect(), is_hole: areas.iter().map(|a| *a < 0.0).collect() }
    }
}

/// A square of the search for the inscribed circle, ordered by the largest circle that it could hold.
struct Cell {
    best_possible: f64,
    center: Point,
    half: f64,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Cell) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Cell) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cell {
    fn cmp(&self, other: &Cell) -> std::cmp::Ordering {
        self.best_possible.total_cmp(&other.best_possible)
    }
}

/// The largest circle in a polygon, by dividing squares that could still hold a larger one.
fn inscribed_circle(outline: &Region) -> (Point, f64) {
    let index = BoundaryIndex::new(outline);
    let signed = |p: Point| index.distance(p) * if outline.contains(p) { 1.0 } else { -1.0 };
    let bounds = outline.bounds();
    let half = 0.5 * bounds.width().min(bounds.height());
    let mut best = (bounds.center(), signed(bounds.center()));
    if half <= 0.0 {
        return (best.0, best.1.max(0.0));
    }
    let mut cells = BinaryHeap::new();
    let add = |center: Point, half: f64, cells: &mut BinaryHeap<Cell>, best: &mut (Point, f64)| {
        let d = signed(center);
        if d > best.1 {
            *best = (center, d);
        }
        cells.push(Cell { best_possible: d + half * std::f64::consts::SQRT_2, center, half });
    };
    // At most a few dozen squares across a long piece: larger ones where it is longer.
    let half = half.max(bounds.diagonal() / 48.0);
    let (columns, rows) =
        ((bounds.width() / (2.0 * half)).ceil() as usize, (bounds.height() / (2.0 * half)).ceil() as usize);
    for k in 0..columns.max(1) * rows.max(1) {
        let step = Vector::new((k % columns.max(1)) as f64, (k / columns.max(1)) as f64) * (2.0 * half);
        add(bounds.min + Vector::new(half, half) + step, half, &mut cells, &mut best);
    }
    let accuracy = INSCRIBED_ACCURACY * half;
    for _ in 0..INSCRIBED_CELLS {
        let Some(cell) = cells.pop().filter(|c| c.best_possible > best.1 + accuracy) else { break };
        let h = 0.5 * cell.half;
        for (sx, sy) in [(-h, -h), (h, -h), (-h, h), (h, h)] {
            add(cell.center + Vector::new(sx, sy), h, &mut cells, &mut best);
        }
    }
    (best.0, best.1.max(0.0))
}
