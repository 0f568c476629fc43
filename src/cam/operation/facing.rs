//! The top of the stock made flat.

use super::{Geometry, OperationError, Planned, Work, raster};
use crate::cam::lay::Pen;
use crate::cam::{MoveKind, Origin};
use crate::plane::{Bounds, Link, Point, Vector};

/// How far the tool goes beyond the edge of the stock, in tool radii: it comes down beside it.
const OVERRUN: f64 = 1.2;

pub(super) fn plan(work: &Work, geometry: &Geometry, stepover: f64) -> Result<Planned, OperationError> {
    let bounds = match work.setup.stock.size {
        // Where the drawing says what zero is, the stock may lie anywhere: what is faced is what is drawn.
        Some([width, height]) if work.setup.stock.zero != Origin::Drawing || geometry.area.is_empty() => {
            let size = Vector::new(width, height);
            let corner = match work.setup.stock.zero {
                Origin::Center => Point::from(-0.5 * size),
                Origin::Corner | Origin::Drawing => Point::origin(),
            };
            Bounds::of_points([corner, corner + size])
        }
        _ => geometry.area.bounds(),
    };
    if bounds.is_empty() {
        return Err(OperationError::NothingToFace);
    }
    let safe = work.setup.rig.safe_height;
    let over = OVERRUN * work.tool.radius();
    let (left, right) = (bounds.min.x - over, bounds.max.x + over);
    // Half a tool stands over at the first and at the last line.
    let rows = raster::heights(bounds.min.y, bounds.max.y, stepover);
    let mut moves = work.first_moves();
    let mut notices = Vec::new();
    for (number, height) in work.cutting.pass_heights(work.stock_top).into_iter().enumerate() {
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: number };
        let start = Point::new(left, rows[0]);
        pen.push(start, safe, MoveKind::Rapid);
        pen.push(start, height, MoveKind::Plunge);
        for (k, &y) in rows.iter().enumerate() {
            let (from, to) = if k % 2 == 0 { (left, right) } else { (right, left) };
            if k > 0 {
                pen.push(Point::new(from, y), height, MoveKind::Cut(Link::Line));
            }
            pen.push(Point::new(to, y), height, MoveKind::Cut(Link::Line));
        }
        let end = moves.last().map_or(start, |m| m.to);
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: number };
        pen.push(end, safe, MoveKind::Rapid);
    }
    let count = work.cutting.pass_heights(work.stock_top).len();
    Ok(Planned {
        toolpath: work.toolpath(moves, count),
        keep: None,
        notices,
        tabs: Vec::new(),
        holes: Vec::new(),
        contradictions: 0,
    })
}
