//! What a closing fills, or an opening removes, beyond rounding corners.

use std::collections::BTreeSet;

use super::Place;
use super::moved::{Contact, Piece, pieces};
use crate::plane::{InscribedCircle, Point, Region, inscribed_circle};
use crate::reference::Operation;
use crate::units::Radius;

/// A filling shallower than this over the radius is a fillet, not a feature. Shallow is measured from the new boundary, which
/// the disk still reaches: a right-angled corner keeps a fillet of 0.41, the root of a gap that the disk nearly fits into
/// less.
pub const SHALLOWEST_FILLING: f64 = 0.5;

/// An inlet at least this deep over the width of its mouth is a slot that vanished, unless it is a [corner](CORNER_FULLNESS).
pub const SLOT_DEPTH: f64 = 1.0;

/// An inlet that fills no more than this fraction of the rectangle of its mouth and depth is a corner: two straight walls fill
/// half of it.
pub const CORNER_FULLNESS: f64 = 0.6;

/// A corner at least this deep over the width of its mouth is a slot that vanished all the same: the fillet of a corner of
/// 28 degrees or more is shallower.
pub const CORNER_DEPTH: f64 = 2.0;

/// An inlet that fills at least this fraction of the rectangle of its mouth and depth is a slot that vanished, however
/// wide: a corner of two straight walls fills half of it.
pub const SLOT_FULLNESS: f64 = 0.75;

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
        /// The greatest distance of the old boundary from the new one.
        depth: f64,
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
        /// The greatest distance of the old boundary from the new one.
        depth: f64,
        /// Area of what was removed.
        area: f64,
    },
}

impl LostFeature {
    /// What a tool would have to fit into, in the units of the drawing.
    pub fn width(&self) -> f64 {
        match *self {
            LostFeature::HoleFilled { diameter, .. } | LostFeature::ComponentLost { diameter, .. } => diameter,
            LostFeature::PartsMerged { width, .. }
            | LostFeature::GapFilled { width, .. }
            | LostFeature::NeckCut { width, .. } => width,
        }
    }
}

/// What `result`, a closing or opening of `part` by a disk of `radius`, has lost; in the order of the pieces from below.
///
/// A fillet in a corner is no loss. A filled
/// inlet is one if the filling is deeper than [`SHALLOWEST_FILLING`] and the inlet either [deeper than wide](SLOT_DEPTH),
/// [sharp](CORNER_DEPTH) or [box-like](SLOT_FULLNESS). Accurate to about a thousandth of the radius, to which arcs are flattened.
pub fn lost_features(part: &Region, result: &Region, radius: Radius, operation: Operation) -> Vec<LostFeature> {
    let r = radius.get();
    let is_closing = operation == Operation::Close;
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
    let vanished = piece.new_stretches.is_empty() && whole_ring;
    let depth = piece.depth();
    let (is_gap, mouth) = match piece.contacts.as_slice() {
        [contact] => (depth >= SHALLOWEST_FILLING * r && is_slot(contact), Some(contact.mouth())),
        contacts => (contacts.len() > 1, None),
    };
    if !(vanished || merges || is_gap) {
        return;
    }
    let InscribedCircle { center, radius, .. } = inscribed_circle(&piece.outline);
    let (place, width, area) = (Place::from(center), 2.0 * radius, piece.outline.area());
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
            LostFeature::GapFilled { place, width, depth, area }
        } else {
            LostFeature::NeckCut { place, width, depth, area }
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
fn is_slot(contact: &Contact) -> bool {
    let (Some(&a), Some(&b)) = (contact.points.first(), contact.points.last()) else { return false };
    let chord = b - a;
    let mouth = chord.norm();
    let height = |p: &Point| if mouth > 0.0 { (chord.perp(&(p - a)) / mouth).abs() } else { (p - a).norm() };
    let depth = contact.points.iter().map(height).fold(0.0, f64::max);
    let doubled: f64 = contact.points.windows(2).map(|w| (w[0] - a).perp(&(w[1] - a))).sum();
    let (area, rectangle) = (0.5 * doubled.abs(), mouth * depth);
    let deepest = if area <= CORNER_FULLNESS * rectangle { CORNER_DEPTH } else { SLOT_DEPTH };
    depth >= deepest * mouth || area >= SLOT_FULLNESS * rectangle
}

/// Which rings of a region belong together.
struct Components {
    /// The outer ring that each ring belongs to.
    of_ring: Vec<usize>,
    is_hole: Vec<bool>,
}

impl Components {
    fn new(region: &Region) -> Components {
        Components { of_ring: region.owners(), is_hole: region.rings.iter().map(|r| r.area() < 0.0).collect() }
    }
}
