//! The drawing of a job in the machine's coordinates: what each operation is done to, and what is cut out.

use anyhow::Result;

use super::select::select;
use crate::cam::{self, Geometry, Hole, Operation, OperationKind, Origin, SelectFile, Setup, Side};
use crate::io::svg::Shapes;
use crate::plane::{Bounds, Region, Vector};

/// What brings the origin to where the job wants it, in millimetres.
pub(super) fn shift(zero: Origin, shapes: &Shapes, mm_per_unit: f64) -> Vector {
    let bounds = shapes.bounds();
    match zero {
        Origin::Corner => -bounds.min.coords * mm_per_unit,
        Origin::Center => -bounds.center().coords * mm_per_unit,
        Origin::Drawing => Vector::zeros(),
    }
}

/// The shapes that an operation is done to. Drilling means the circles among all, where nothing is selected.
pub(super) fn chosen(shapes: &Shapes, operation: &Operation) -> Result<Vec<usize>> {
    let chosen = select(shapes, &operation.select)?;
    if !matches!(operation.kind, OperationKind::Drill { .. }) || operation.select != SelectFile::default() {
        return Ok(chosen);
    }
    let is_round = |k: &usize| {
        let area = shapes.united(&[*k]);
        !area.is_empty() && area.rings.iter().all(|ring| cam::circle(ring).is_some())
    };
    let round: Vec<usize> = chosen.iter().copied().filter(is_round).collect();
    Ok(if round.is_empty() { chosen } else { round })
}

/// The shapes of an operation in the machine's coordinates.
pub(super) fn geometry(
    operation: &Operation,
    shapes: &Shapes,
    scale: f64,
    shift: Vector,
    holes: &[Hole],
    parts: &[Region],
) -> Result<Geometry> {
    let chosen = chosen(shapes, operation)?;
    let area = shapes.united(&chosen).scaled(scale).translated(shift);
    let lines = match operation.kind {
        OperationKind::Engrave => chosen
            .iter()
            .flat_map(|&k| &shapes.shapes[k].lines)
            .map(|line| cam::CutLine { ring: line.ring.scaled(scale).translated(shift), is_closed: line.is_closed })
            .collect(),
        _ => Vec::new(),
    };
    // What has something in common with the shapes is the same part, or worked on inside.
    let pieces: Vec<(Bounds, Region)> = area.components().into_iter().map(|piece| (piece.bounds(), piece)).collect();
    let is_other = |part: &&Region| {
        let bounds = part.bounds();
        !pieces.iter().any(|(around, piece)| around.overlaps(&bounds) && piece.overlaps(part))
    };
    let others = Region::new(parts.iter().filter(is_other).flat_map(|part| part.rings.iter().cloned()).collect());
    Ok(Geometry { area, lines, holes: holes.to_vec(), others })
}

/// The parts that operations cut out of the stock; none of operations whose selection fails, which is told elsewhere.
pub(super) fn parts(setup: &Setup, shapes: &Shapes, scale: f64, shift: Vector) -> Vec<Region> {
    let cut_out = |o: &&Operation| matches!(o.kind, OperationKind::Profile { side: Side::Outside, .. });
    let chosen = setup.operations.iter().filter(cut_out).filter_map(|o| select(shapes, &o.select).ok());
    chosen.flat_map(|chosen| shapes.united(&chosen).scaled(scale).translated(shift).components()).collect()
}

/// The outlines of all shapes in the machine's coordinates.
pub(super) fn drawn_outlines(shapes: &Shapes, scale: f64, shift: Vector) -> Region {
    let rings = (0..shapes.shapes.len()).flat_map(|k| shapes.united(&[k]).rings);
    Region::new(rings.collect()).scaled(scale).translated(shift)
}
