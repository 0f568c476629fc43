//! Parallel lines within a region.

use crate::plane::{Link, Point, Region, Segment};

/// Stretches shorter than this, in millimetres, are not worth a line.
const SHORTEST: f64 = 1e-3;

/// The stretches of the line at height `y` inside of `region`, from left to right.
pub(super) fn stretches(region: &Region, y: f64) -> Vec<[f64; 2]> {
    let mut crossings: Vec<f64> = Vec::new();
    for segment in region.segments() {
        match segment.link {
            Link::Line => {
                // Half-open, so that a vertex on the line counts once.
                if (segment.start.y <= y) != (segment.end.y <= y) {
                    let t = (y - segment.start.y) / (segment.end.y - segment.start.y);
                    crossings.push(segment.start.x + t * (segment.end.x - segment.start.x));
                }
            }
            Link::Arc(_) => arc_crossings(&segment, y, &mut crossings),
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]).filter(|[a, b]| b - a > SHORTEST).collect()
}

/// Where an arc goes through a horizontal line: it is cut where it turns vertically, and each piece is monotonic.
fn arc_crossings(segment: &Segment, y: f64, crossings: &mut Vec<f64>) {
    let Link::Arc(arc) = segment.link else { return };
    let mut stops = vec![segment.start];
    let sweep = segment.sweep();
    let mut turning: Vec<(f64, Point)> = [1.0, -1.0]
        .into_iter()
        .map(|side| Point::new(arc.center.x, arc.center.y + side * arc.radius))
        .map(|p| (arc.angle_between(segment.start, p), p))
        .filter(|(angle, _)| *angle > 0.0 && *angle < sweep)
        .collect();
    turning.sort_by(|a, b| a.0.total_cmp(&b.0));
    stops.extend(turning.into_iter().map(|(_, p)| p));
    stops.push(segment.end);
    for pair in stops.windows(2) {
        if (pair[0].y <= y) != (pair[1].y <= y) {
            let rise = y - arc.center.y;
            let half = (arc.radius * arc.radius - rise * rise).max(0.0).sqrt();
            // The piece lies on one side of the centre.
            let side = if 0.5 * (pair[0].x + pair[1].x) >= arc.center.x { 1.0 } else { -1.0 };
            crossings.push(arc.center.x + side * half);
        }
    }
}

/// The heights of lines that fill [low, high] at most `step` apart, both ends a little inside.
pub(super) fn heights(low: f64, high: f64, step: f64) -> Vec<f64> {
    let count = ((high - low) / step).ceil().max(1.0) as usize;
    (0..=count).map(|k| low + (high - low) * (k as f64 / count as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    #[test]
    fn lines_are_cut_by_lines_and_arcs() {
        let mut region = Region::new(vec![Ring::polygon(
            [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)].map(|(x, y)| Point::new(x, y)),
        )]);
        region.rings.push(Ring::circle(Point::origin(), 5.0).reversed());
        let found = stretches(&region, 3.0);
        assert_eq!(found.len(), 2);
        for (found, expected) in found.iter().flatten().zip([-10.0, -4.0, 4.0, 10.0]) {
            assert!((found - expected).abs() < 1e-12, "{found}");
        }
        assert_eq!(stretches(&region, 10.5), Vec::<[f64; 2]>::new());
        // Touching the hole from outside.
        assert_eq!(stretches(&region, 5.5), [[-10.0, 10.0]]);
    }

    #[test]
    fn heights_are_near_enough() {
        let found = heights(0.0, 10.0, 3.0);
        assert_eq!(found, [0.0, 2.5, 5.0, 7.5, 10.0]);
    }
}
