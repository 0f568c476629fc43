//! How much an operation will come to, told before it is begun: a slip of a unit must not take all memory and the whole night.

use super::MOST_TABS;
use super::{Operation, OperationKind, Pattern, Setup, TabPlaces};
use crate::cam::Geometry;
use crate::plane::{Bounds, Point, Region};

/// The longest path of one operation, in millimetres: ten kilometres are a week of cutting at a metre a minute.
const LONGEST_PATH: f64 = 1e7;

/// The most paths beside each other from the wall of an area to its middle: each is a rolling of its own.
const MOST_RINGS: f64 = 500.0;

/// The largest extent of the shapes in millimetres: beyond it micrometres are lost in rounding.
const LARGEST_SHAPES: f64 = 1e7;

/// Distance between neighbouring paths where it is not chosen, in tool diameters: the least of all operations.
const FLAT_STEPOVER: f64 = 0.05;

/// Why an operation is not begun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AmountError {
    /// The shapes are larger than any machine.
    #[error(
        "the shapes are {size:.1e} mm across, more than {LARGEST_SHAPES:.0e}: is the width or the scale of the drawing right?"
    )]
    Shapes {
        /// Their extent in millimetres.
        size: f64,
    },
    /// The path would be too long.
    #[error(
        "the tool would go about {:.0} km, and at most {:.0} km are planned: a larger stepover, a larger tool or deeper passes make \
         the way shorter; is the scale of the drawing right?", length / 1e6, LONGEST_PATH / 1e6
    )]
    Path {
        /// Its length in millimetres, about.
        length: f64,
    },
    /// There would be too many paths inside of each other.
    #[error(
        "about {count:.0} paths {stepover:.4} mm apart would lie inside of each other, and at most {MOST_RINGS} are planned: take a \
         larger stepover or a larger tool, or pattern = \"raster\" in a pocket"
    )]
    Rings {
        /// How many, about.
        count: f64,
        /// Millimetres between them.
        stepover: f64,
    },
    /// There would be too many tabs.
    #[error(
        "tabs every {spacing} mm are more than {MOST_TABS} on an outline of {length:.0} mm: put them farther apart"
    )]
    Tabs {
        /// Millimetres between them.
        spacing: f64,
        /// Length of the outline in millimetres.
        length: f64,
    },
}

/// Refuses an operation that would take all memory or days, without planning it.
///
/// # Errors
/// Says what there would be too much of.
pub fn check_amount(setup: &Setup, operation: &Operation, geometry: &Geometry) -> Result<(), AmountError> {
    let bounds = geometry.lines.iter().fold(geometry.area.bounds(), |b, line| b.union(line.ring.bounds()));
    let size = if bounds.is_empty() { 0.0 } else { bounds.diagonal() };
    if size.is_nan() || size > LARGEST_SHAPES {
        return Err(AmountError::Shapes { size });
    }
    if let Some(tabs) = &operation.cutting.tabs
        && let TabPlaces::Spacing(spacing) = tabs.places
    {
        let length = geometry.area.rings.iter().map(|ring| ring.length()).fold(0.0, f64::max);
        if length / spacing > MOST_TABS as f64 {
            return Err(AmountError::Tabs { spacing, length });
        }
    }
    let tool = setup.tool_of(operation);
    let area = &geometry.area;
    let drawn = area.perimeter() + geometry.lines.iter().map(|line| line.ring.length()).sum::<f64>();
    let passes = || operation.cutting.pass_heights(setup.stock.top).len() as f64;
    let (length, rings) = match operation.kind {
        OperationKind::Pocket { stepover, rest_of, pattern, .. } if rest_of.is_some() || pattern == Pattern::Rings => {
            (passes() * (drawn + area.area().abs() / stepover), Some(stepover))
        }
        OperationKind::Pocket { stepover, .. } => (passes() * (drawn + area.area().abs() / stepover), None),
        OperationKind::Facing { stepover } => {
            let faced = match setup.stock.size {
                Some([width, height]) => Bounds::of_points([Point::origin(), Point::new(width, height)]),
                None => area.bounds(),
            };
            let extent = |length: f64| length + tool.diameter;
            let size = if faced.is_empty() { 0.0 } else { extent(faced.width()) * extent(faced.height()) };
            (passes() * size / stepover, None)
        }
        OperationKind::VCarve { .. } => {
            // Where the cone is too small for the area, its tip clears the bottom.
            let is_wide = widest(area) > tool.diameter;
            let step = FLAT_STEPOVER * tool.diameter;
            (drawn + if is_wide { area.area().abs() / step } else { 0.0 }, is_wide.then_some(step))
        }
        OperationKind::Drill { .. } if tool.is_drill => (0.0, None),
        OperationKind::Drill { .. } => (passes() * (drawn + area.area().abs() / tool.radius()), None),
        OperationKind::Profile { .. } | OperationKind::Engrave | OperationKind::Chamfer { .. } => {
            (passes() * drawn, None)
        }
    };
    if length > LONGEST_PATH {
        return Err(AmountError::Path { length });
    }
    match rings {
        Some(stepover) if 0.5 * widest(area) / stepover > MOST_RINGS => {
            Err(AmountError::Rings { count: 0.5 * widest(area) / stepover, stepover })
        }
        _ => Ok(()),
    }
}

/// How wide an area is at its widest, about: exact for disks, twice too little at most for strips.
fn widest(area: &Region) -> f64 {
    let perimeter = area.perimeter();
    if perimeter > 0.0 { 4.0 * area.area().abs() / perimeter } else { 0.0 }
}
