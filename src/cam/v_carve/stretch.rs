//! Parts of polylines, and fewer points for the same way.

use crate::cam::Point3;
use crate::plane::AxisNode;

/// How much wider than the limit an axis may be and still count as within it, relative: rounding of a slot that is exactly
/// as wide as the tool.
const LIMIT_ROUNDING: f64 = 1e-9;

/// The stretches of an axis on which the clearance is from `least` to `most`.
pub(super) fn clipped(nodes: &[AxisNode], least: f64, most: f64) -> Vec<Vec<AxisNode>> {
    let between = |a: &AxisNode, b: &AxisNode, t: f64| AxisNode {
        point: a.point + (b.point - a.point) * t,
        clearance: a.clearance + (b.clearance - a.clearance) * t,
    };
    stretches(nodes, |n| n.clearance, least, most * (1.0 + LIMIT_ROUNDING), between)
}

/// The stretches of a way that lie below `height`.
pub(super) fn below(way: &[Point3], height: f64) -> Vec<Vec<Point3>> {
    stretches(way, |p| p.z, f64::NEG_INFINITY, height, |a, b, t| a + (b - a) * t)
}

/// The stretches of a polyline on which `value`, which changes evenly between its points, is from `least` to `most`; no
/// stretches without length, but for a polyline that is a point.
fn stretches<P: Clone>(
    points: &[P],
    value: impl Fn(&P) -> f64,
    least: f64,
    most: f64,
    between: impl Fn(&P, &P, f64) -> P,
) -> Vec<Vec<P>> {
    let is_in = |p: &P| (least..=most).contains(&value(p));
    if let [point] = points {
        return if is_in(point) { vec![vec![point.clone()]] } else { vec![] };
    }
    let mut out: Vec<Vec<P>> = Vec::new();
    let mut open: Vec<P> = points.first().filter(|p| is_in(p)).cloned().into_iter().collect();
    for w in points.windows(2) {
        let (a, b) = (value(&w[0]), value(&w[1]));
        // Where the chord passes a limit strictly between its ends, in order.
        let mut cuts: Vec<f64> = [least, most]
            .into_iter()
            .filter(|limit| limit.is_finite() && (a < *limit && *limit < b || b < *limit && *limit < a))
            .map(|limit| (limit - a) / (b - a))
            .collect();
        cuts.sort_by(f64::total_cmp);
        for t in cuts {
            let cut = between(&w[0], &w[1], t);
            if open.is_empty() {
                open.push(cut);
            } else {
                open.push(cut);
                out.push(std::mem::take(&mut open));
            }
        }
        if is_in(&w[1]) {
            open.push(w[1].clone());
        } else if !open.is_empty() {
            // It left at its last point, which is on the limit.
            out.push(std::mem::take(&mut open));
        }
    }
    out.push(open);
    out.retain(|stretch| stretch.len() > 1);
    out
}

/// The way with as few of its points as stay within `tolerance` of it (Douglas and Peucker).
pub(super) fn simplified(way: &[Point3], tolerance: f64) -> Vec<Point3> {
    let mut is_kept = vec![false; way.len()];
    for end in [0, way.len().saturating_sub(1)] {
        if let Some(end) = is_kept.get_mut(end) {
            *end = true;
        }
    }
    let mut waiting = vec![(0, way.len().saturating_sub(1))];
    while let Some((from, to)) = waiting.pop() {
        let farthest = (from + 1..to)
            .map(|k| (k, distance_to_chord(&way[k], &way[from], &way[to])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, distance)) = farthest
            && distance > tolerance
        {
            is_kept[k] = true;
            waiting.extend([(from, k), (k, to)]);
        }
    }
    way.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

fn distance_to_chord(p: &Point3, a: &Point3, b: &Point3) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    if t.is_finite() { (p - a - along * t).norm() } else { (p - a).norm() }
}
