//! What lies beyond the edges of the stock, where its size is known.

use super::setup::Done;
use crate::cam::{OperationKind, Origin, Setup};
use crate::plane::{Bounds, Point, Vector};

/// Less than this beyond an edge, in millimetres, is rounding of the drawing.
const ROUNDING: f64 = 0.01;

/// Shapes and paths that leave the stock, in sentences. With `zero` at a corner the stock begins there, with the centre it lies
/// around it; where the drawing says what zero is, the stock may lie anywhere.
pub(super) fn beyond(setup: &Setup, zero: Origin, done: &[Done]) -> Vec<String> {
    let Some([width, height]) = setup.stock.size else { return Vec::new() };
    let corner = match zero {
        Origin::Corner => Point::origin(),
        Origin::Center => Point::new(-0.5 * width, -0.5 * height),
        Origin::Drawing => return Vec::new(),
    };
    let stock = Bounds::of_points([corner, corner + Vector::new(width, height)]);
    done.iter().filter_map(|done| leaves(setup, &stock, done)).collect()
}

fn leaves(setup: &Setup, stock: &Bounds, done: &Done) -> Option<String> {
    let label = &done.operation.label;
    let size = format!("{} x {} mm", stock.width(), stock.height());
    let drawn = done.planned.keep.as_ref().map(|keep| keep.part.bounds());
    if let Some(over) = drawn.map(|drawn| overhang(stock, &drawn)).filter(|over| *over > ROUNDING) {
        return Some(format!(
            "operation \"{label}\": its shapes reach {over:.2} mm beyond the edge of the stock, {size}: is the scale of the \
             drawing right?"
        ));
    }
    if matches!(done.operation.kind, OperationKind::Facing { .. }) {
        // It runs out of the stock on purpose.
        return None;
    }
    let top = setup.stock.top;
    let cut = done.run.motions.iter().filter(|m| m.is_feed() && m.is_in_stock(top));
    let cut = cut.flat_map(|m| m.trace()).fold(Bounds::of_points([]), |b, s| b.union(s.bounds()));
    // Beside an edge the whole tool stands outside, and its leads a little farther.
    let over = if cut.is_empty() { 0.0 } else { overhang(stock, &cut) - setup.tool_of(done.operation).diameter };
    (over > ROUNDING).then(|| {
        format!("operation \"{label}\": the tool leaves the stock, {size}, and cuts {over:.2} mm beside it: what lies there?")
    })
}

/// How far `inner` reaches beyond `outer`.
fn overhang(outer: &Bounds, inner: &Bounds) -> f64 {
    if inner.is_empty() {
        return 0.0;
    }
    let low = (outer.min.x - inner.min.x).max(outer.min.y - inner.min.y);
    low.max(inner.max.x - outer.max.x).max(inner.max.y - outer.max.y)
}
