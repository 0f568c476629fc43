//! Which cells a cutter passes over, and how low its surface gets there.
//!
//! At a distance d from its axis the surface of a cutter stands h(d) above its tip. Along a motion the least of z + h(d) over
//! the way is what counts at a cell: for level motions that is h at the least distance from the path; along a straight slope
//! z + h is convex, and its least value known in closed form for every shape; along a helix a flat tool is lowest where it enters or
//! leaves the reach of the cell. Helices of other shapes are swept as chords.

use std::f64::consts::{PI, TAU};

use super::height_map::HeightMap;
use super::motion::{Motion, MotionKind, Point3};
use super::tool::{Tool, ToolShape};
use crate::plane::{Arc, Bounds, Point, Segment, Turn, Vector};

/// Helices of tools that are not flat are swept as chords that stray from them by no more than this, in millimetres: half
/// of what controllers allow themselves. The surface that is left strays by no more either.
pub const CHORD_TOLERANCE: f64 = 0.001;

/// A helix becomes no more chords than this: beyond it, it is absurd.
const MOST_CHORDS: f64 = 2e4;

/// Ways shorter than this in the plane, in millimetres, are plunges.
const PLUNGE: f64 = 1e-9;

/// A cell over which the cutter passed below what stands there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Index of the cell.
    pub(super) cell: usize,
    /// Lowest height of the cutter's surface at the middle of the cell.
    pub(super) z: f64,
}

/// A tool as far as it cuts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cutter {
    shape: ToolShape,
    /// The profile is that of the tool, of which only this much around the axis counts.
    radius: f64,
    /// The tool's own radius.
    full_radius: f64,
}

/// A piece of a motion that is swept in one go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Element {
    /// A straight way, sloping or level; a plunge where it has no length in the plane.
    Straight {
        /// Where it starts.
        from: Point3,
        /// Where it ends.
        to: Point3,
    },
    /// Along an arc at one height.
    Level {
        /// The arc.
        arc: Segment,
        /// The height of the tip.
        z: f64,
    },
    /// Along an arc with height changing evenly.
    Helix {
        /// The circle.
        circle: Arc,
        /// Direction from the centre to the start, in radians.
        start: f64,
        /// Angle travelled, in (0, 2π].
        sweep: f64,
        /// Height of the tip at the start.
        from: f64,
        /// And at the end.
        to: f64,
        /// What holds the arc.
        bounds: Bounds,
    },
}

impl Cutter {
    pub(super) fn new(tool: &Tool) -> Cutter {
        Cutter { shape: tool.shape, radius: tool.radius(), full_radius: tool.radius() }
    }

    /// The same without the outermost `margin`.
    pub(super) fn without(&self, margin: f64) -> Cutter {
        Cutter { radius: (self.radius - margin).max(0.0), ..*self }
    }

    /// The pieces of a motion; none for a dwell, or where a number is not finite.
    pub(super) fn elements(&self, motion: &Motion) -> Vec<Element> {
        let (from, to) = (motion.from, motion.to);
        let is_finite = [from, to].iter().all(|p| p.coords.iter().all(|x| x.is_finite()));
        if !is_finite {
            return Vec::new();
        }
        let straight = || vec![Element::Straight { from, to }];
        match motion.kind {
            MotionKind::Dwell { .. } => Vec::new(),
            MotionKind::Rapid | MotionKind::Feed { .. } => straight(),
            MotionKind::Arc { .. } if motion.trace().next().is_none() => straight(),
            MotionKind::Arc { .. } if from.z == to.z => {
                motion.trace().map(|arc| Element::Level { arc, z: from.z }).collect()
            }
            MotionKind::Arc { center, turn, .. } => {
                let sweep: f64 = motion.trace().map(|s| s.sweep()).sum();
                let bounds = motion.trace().fold(Bounds::EMPTY, |b, s| b.union(s.bounds()));
                let radius = 0.5 * ((from.xy() - center).norm() + (to.xy() - center).norm());
                let circle = Arc { center, radius, turn };
                let spoke = from.xy() - center;
                let start = spoke.y.atan2(spoke.x);
                match self.shape {
                    ToolShape::Flat => vec![Element::Helix { circle, start, sweep, from: from.z, to: to.z, bounds }],
                    _ => chords(motion, &circle, sweep),
                }
            }
        }
    }

    /// Finds the cells where the cutter gets below what stands on `map`.
    pub(super) fn gather(&self, map: &HeightMap, element: &Element, hits: &mut Vec<Hit>) {
        match *element {
            Element::Straight { from, to } if from.z.min(to.z) < map.stock().top_mm => {
                self.gather_straight(map, from, to, hits);
            }
            Element::Level { arc, z } if z < map.stock().top_mm => self.gather_level(map, &arc, z, hits),
            Element::Helix { circle, start, sweep, from, to, bounds } if from.min(to) < map.stock().top_mm => {
                let rise = (to - from) / sweep;
                let reach = bounds.inflated(self.radius);
                for row in map.grid.rows_between(reach.min.y, reach.max.y) {
                    for column in map.grid.columns_between(reach.min.x, reach.max.x) {
                        let spoke = map.grid.center(column, row) - circle.center;
                        let travelled = self.lowest_on_helix(spoke, &circle, start, sweep, rise);
                        if let Some(angle) = travelled {
                            push(map, row, column, from + rise * angle, hits);
                        }
                    }
                }
            }
            _ => {}
        }
    }

    fn gather_straight(&self, map: &HeightMap, from: Point3, to: Point3, hits: &mut Vec<Hit>) {
        let way = to.xy() - from.xy();
        let length = way.norm();
        // A plunge leaves what its lower end leaves.
        let (along, length, rise, z) = match length > PLUNGE {
            true => (way / length, length, (to.z - from.z) / length, from.z),
            false => (Vector::x(), 0.0, 0.0, from.z.min(to.z)),
        };
        let lowest = from.z.min(to.z);
        let reach = Bounds::EMPTY.with_point(from.xy()).with_point(to.xy()).inflated(self.radius);
        let is_level_flat = self.shape == ToolShape::Flat && rise == 0.0;
        for row in map.grid.rows_between(reach.min.y, reach.max.y) {
            let y = map.grid.center(0, row).y;
            let Some((left, right)) = self.row_of_stadium(from.xy(), to.xy(), along, y) else { continue };
            let columns = map.grid.columns_between(left, right);
            let start = row * map.grid.columns;
            if is_level_flat {
                for column in columns {
                    if map.heights[start + column] > z {
                        hits.push(Hit { cell: start + column, z });
                    }
                }
                continue;
            }
            for column in columns {
                if map.heights[start + column] <= lowest {
                    continue;
                }
                let spoke = map.grid.center(column, row) - from.xy();
                if let Some(height) = self.lowest_on_line(spoke.dot(&along), spoke.perp(&along), length, rise) {
                    // Rounding must not put it below both ends.
                    push(map, row, column, (z + height).max(lowest), hits);
                }
            }
        }
    }

    /// Where the row at `y` crosses what the cutter sweeps in the plane between two places.
    fn row_of_stadium(&self, from: Point, to: Point, along: Vector, y: f64) -> Option<(f64, f64)> {
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in [from, to] {
            let half = self.radius * self.radius - (y - p.y) * (y - p.y);
            if half >= 0.0 {
                left = left.min(p.x - half.sqrt());
                right = right.max(p.x + half.sqrt());
            }
        }
        let across = Vector::new(-along.y, along.x) * self.radius;
        for side in [across, -across] {
            let (a, b) = (from + side, to + side);
            let t = (y - a.y) / (b.y - a.y);
            // A level side meets the row only where the disks at its ends do.
            if (0.0..=1.0).contains(&t) {
                let x = a.x + t * (b.x - a.x);
                left = left.min(x);
                right = right.max(x);
            }
        }
        (left <= right).then_some((left, right))
    }

    /// The least of `rise` u + h over the way, seen from a place `ahead` of the start along it and `aside` of it; `None`
    /// where the cutter does not reach it.
    #[inline]
    fn lowest_on_line(&self, ahead: f64, aside: f64, length: f64, rise: f64) -> Option<f64> {
        let half_squared = self.radius * self.radius - aside * aside;
        if half_squared < 0.0 {
            return None;
        }
        // The cutter is over the place while its axis is no more than `half` before or behind it.
        let half = half_squared.sqrt();
        let from_foot = match self.shape {
            ToolShape::Flat => -half * sign(rise),
            ToolShape::Ball => {
                let full = (self.full_radius * self.full_radius - aside * aside).max(0.0).sqrt();
                -rise * full / (1.0 + rise * rise).sqrt()
            }
            ToolShape::Cone { angle, tip_diameter } => {
                let steepness = 1.0 / (0.5 * angle).tan();
                let tip = (0.25 * tip_diameter * tip_diameter - aside * aside).max(0.0).sqrt();
                let lowest = match rise.abs() < steepness {
                    true => rise.abs() * aside.abs() / (steepness * steepness - rise * rise).sqrt(),
                    false => half,
                };
                -sign(rise) * lowest.max(tip)
            }
        };
        let u = (ahead + from_foot.clamp(-half, half)).clamp(0.0, length);
        let off_squared = (u - ahead) * (u - ahead);
        // At the ends of the reach rounding must not lose a cell that the row's range holds.
        (off_squared <= half_squared + ROUNDING).then(|| rise * u + self.height(off_squared + aside * aside))
    }

    fn gather_level(&self, map: &HeightMap, arc: &Segment, z: f64, hits: &mut Vec<Hit>) {
        let crate::plane::Link::Arc(circle) = arc.link else { return };
        let sweep = arc.sweep();
        let reach = arc.bounds().inflated(self.radius);
        let (outer, inner) = (circle.radius + self.radius, circle.radius - self.radius);
        let (start, end) = match circle.turn {
            Turn::Left => (arc.start - circle.center, arc.end - circle.center),
            Turn::Right => (arc.end - circle.center, arc.start - circle.center),
        };
        // Counterclockwise from `start` to `end`.
        let is_beside = |spoke: Vector| match sweep <= PI {
            true => start.perp(&spoke) >= 0.0 && spoke.perp(&end) >= 0.0,
            false => start.perp(&spoke) >= 0.0 || spoke.perp(&end) >= 0.0,
        };
        let radius_squared = self.radius * self.radius;
        for row in map.grid.rows_between(reach.min.y, reach.max.y) {
            let dy = map.grid.center(0, row).y - circle.center.y;
            let half = |radius: f64| (radius * radius - dy * dy).max(0.0).sqrt();
            // Rounding may put a cell outside of its row's range that the end of a straight way reaches exactly.
            let outside = half(outer) + ROUNDING;
            // No cell of the hole in the middle can be reached.
            let inside = if inner > 0.0 { half(inner) - ROUNDING } else { 0.0 };
            let x = circle.center.x;
            let spans = match inside > 0.0 {
                true => [(x - outside, x - inside), (x + inside, x + outside)],
                false => [(x - outside, x + outside), (1.0, 0.0)],
            };
            for (left, right) in spans {
                let (left, right) = (left.max(reach.min.x), right.min(reach.max.x));
                if left > right {
                    continue;
                }
                for column in map.grid.columns_between(left, right) {
                    if map.heights[row * map.grid.columns + column] <= z {
                        continue;
                    }
                    let spoke = map.grid.center(column, row) - circle.center;
                    let distance_squared = match is_beside(spoke) {
                        true => (spoke.norm() - circle.radius).powi(2),
                        false => (spoke - start).norm_squared().min((spoke - end).norm_squared()),
                    };
                    if distance_squared <= radius_squared {
                        push(map, row, column, z + self.height(distance_squared), hits);
                    }
                }
            }
        }
    }

    /// How far along a helix a flat cutter is lowest over a place, as an angle; `None` where it does not reach it.
    fn lowest_on_helix(&self, spoke: Vector, circle: &Arc, start: f64, sweep: f64, rise: f64) -> Option<f64> {
        let away = spoke.norm();
        let cosine =
            (away * away + circle.radius * circle.radius - self.radius * self.radius) / (2.0 * away * circle.radius);
        let lower = |first: f64, last: f64| if rise < 0.0 { last } else { first };
        if cosine > 1.0 || (away == 0.0 && circle.radius > self.radius) {
            return None;
        }
        // In reach all the way around; or only while the axis is within `half` of the direction of the place.
        if cosine <= -1.0 || away == 0.0 {
            return Some(lower(0.0, sweep));
        }
        let half = cosine.acos();
        let direction = circle.turn.sign() * (spoke.y.atan2(spoke.x) - start);
        let meeting = direction.rem_euclid(TAU);
        let reaches = [meeting - TAU, meeting, meeting + TAU].into_iter().filter_map(|middle| {
            let (first, last) = ((middle - half).max(0.0), (middle + half).min(sweep));
            (first <= last).then(|| lower(first, last))
        });
        reaches.reduce(if rise < 0.0 { f64::max } else { f64::min })
    }

    /// The height of the surface above the tip at a distance from the axis.
    #[inline]
    fn height(&self, distance_squared: f64) -> f64 {
        match self.shape {
            ToolShape::Flat => 0.0,
            ToolShape::Ball => {
                let r = self.full_radius;
                r - (r * r - distance_squared).max(0.0).sqrt()
            }
            ToolShape::Cone { angle, tip_diameter } => {
                (distance_squared.sqrt() - 0.5 * tip_diameter).max(0.0) / (0.5 * angle).tan()
            }
        }
    }
}

/// Squares of lengths and lengths nearer to a limit than this, in millimetres, are at it.
const ROUNDING: f64 = 1e-9;

/// 0 for 0, where [`f64::signum`] is 1.
#[inline]
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

#[inline]
fn push(map: &HeightMap, row: usize, column: usize, z: f64, hits: &mut Vec<Hit>) {
    let cell = row * map.grid.columns + column;
    if map.heights[cell] > z {
        hits.push(Hit { cell, z });
    }
}

/// A helix as straight ways.
fn chords(motion: &Motion, circle: &Arc, sweep: f64) -> Vec<Element> {
    let step = 2.0 * (1.0 - (CHORD_TOLERANCE / circle.radius).min(1.0)).acos();
    let count = (sweep / step).ceil().clamp(1.0, MOST_CHORDS) as usize;
    let at = |k: usize| {
        if k == count {
            return motion.to;
        }
        let t = k as f64 / count as f64;
        let p = circle.travel(motion.from.xy(), sweep * t);
        Point3::new(p.x, p.y, motion.from.z + (motion.to.z - motion.from.z) * t)
    };
    let mut from = motion.from;
    let pieces = (1..=count).map(|k| {
        let to = at(k);
        let piece = Element::Straight { from, to };
        from = to;
        piece
    });
    pieces.collect()
}
