//! Shapes for tests and benchmarks, made by formulas and a fixed generator of numbers: the same on every machine.
//!
//! Every generator names its sizes in units of the radius that the shape is meant for, which is 1.

#![allow(dead_code, reason = "every test uses some of the shapes")]

use std::f64::consts::{PI, TAU};

use clopen::plane::{Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;

/// A linear congruential generator (Knuth's MMIX constants): the numbers are spread well enough for shapes.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Numbers {
        let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x2545_F491_4F6C_DD1D);
        numbers.unit();
        numbers
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// In 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }
}

fn polygon(points: &[(f64, f64)]) -> Ring {
    Ring::polygon(points.iter().map(|&(x, y)| Point::new(x, y)))
}

/// An axis-parallel rectangle.
pub fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Ring {
    polygon(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
}

/// An L of two arms of length `arm` and width `width`: one concave corner.
pub fn l_corner(arm: f64, width: f64) -> Region {
    Region::new(vec![polygon(&[(0.0, 0.0), (arm, 0.0), (arm, width), (width, width), (width, arm), (0.0, arm)])])
}

/// A rectangle with a slot of the given width cut from above, its bottom flat.
pub fn slotted_plate(width: f64, height: f64, slot_width: f64, slot_depth: f64) -> Region {
    let (a, b) = ((width - slot_width) / 2.0, (width + slot_width) / 2.0);
    let bottom = height - slot_depth;
    Region::new(vec![polygon(&[
        (0.0, 0.0),
        (width, 0.0),
        (width, height),
        (b, height),
        (b, bottom),
        (a, bottom),
        (a, height),
        (0.0, height),
    ])])
}

/// Two circles of radius `radius` whose centres are `distance` apart.
pub fn two_disks(radius: f64, distance: f64) -> Region {
    let center = |x: f64| Ring::circle(Point::new(x, 0.0), radius);
    Region::new(vec![center(-distance / 2.0), center(distance / 2.0)])
}

/// A closed fractal coast of about `vertices` vertices about a square of half side `size`, by displacing midpoints. Where
/// it crosses itself the loops are cut off: the outline is the largest ring of its union.
pub fn coast(vertices: usize, size: f64, seed: u64) -> Region {
    let mut numbers = Numbers::new(seed);
    let mut points =
        vec![Point::new(-size, -size), Point::new(size, -size), Point::new(size, size), Point::new(-size, size)];
    while points.len() < vertices {
        let n = points.len();
        let mut finer = Vec::with_capacity(2 * n);
        for i in 0..n {
            let (a, b) = (points[i], points[(i + 1) % n]);
            let normal = Vector::new(-(b.y - a.y), b.x - a.x);
            finer.push(a);
            if finer.len() + (n - i - 1) < vertices {
                finer.push(nalgebra::center(&a, &b) + normal * numbers.between(-0.2, 0.2));
            }
        }
        points = finer;
    }
    let contour: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
    let shapes = FloatOverlay::<[f64; 2], i64>::from_subj(&contour).overlay(OverlayRule::Subject, FillRule::NonZero);
    let rings = shapes.iter().flatten().map(|c| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1]))));
    Region::new(rings.max_by(|a, b| a.area().total_cmp(&b.area())).into_iter().collect())
}

/// A star of `tips` tips between two radii.
pub fn star(tips: usize, inner: f64, outer: f64) -> Region {
    Region::new(vec![Ring::polygon((0..2 * tips).map(|k| {
        let (radius, angle) = (if k % 2 == 0 { outer } else { inner }, PI * k as f64 / tips as f64);
        Point::new(radius * angle.cos(), radius * angle.sin())
    }))])
}

/// A gear of `teeth` trapezoidal teeth with a round bore of true arcs.
pub fn gear(teeth: usize, root: f64, tip: f64, bore: f64) -> Region {
    let pitch = TAU / teeth as f64;
    let at = |radius: f64, angle: f64| Point::new(radius * angle.cos(), radius * angle.sin());
    let outline = Ring::polygon((0..teeth).flat_map(|k| {
        let a = pitch * k as f64;
        [at(root, a), at(root, a + 0.45 * pitch), at(tip, a + 0.55 * pitch), at(tip, a + 0.9 * pitch)]
    }));
    Region::new(vec![outline, Ring::circle(Point::origin(), bore).reversed()])
}

/// A comb: `teeth` teeth of width 1 and the given length; gaps of exactly `gap`.
pub fn comb(teeth: usize, length: f64, gap: f64) -> Region {
    let pitch = 1.0 + gap;
    let mut points = vec![(0.0, -1.0), (pitch * teeth as f64 - gap, -1.0)];
    for k in (0..teeth).rev() {
        let x = pitch * k as f64;
        points.extend([(x + 1.0, length), (x, length)]);
        if k > 0 {
            points.extend([(x, 0.0), (x - gap, 0.0)]);
        }
    }
    Region::new(vec![polygon(&points)])
}

/// A grid of squares of side `side`, `gap` apart: dyadic sizes give gaps that are exact in floating point.
pub fn squares(columns: usize, rows: usize, side: f64, gap: f64) -> Region {
    let pitch = side + gap;
    let square = |k: usize| {
        let (x, y) = (pitch * (k % columns) as f64, pitch * (k / columns) as f64);
        rectangle(x, y, x + side, y + side)
    };
    Region::new((0..columns * rows).map(square).collect())
}

/// Two squares joined by a neck.
pub fn dumbbell(side: f64, neck_length: f64, neck_width: f64) -> Region {
    let (h, w) = (side / 2.0, neck_width / 2.0);
    let (a, b) = (neck_length / 2.0, neck_length / 2.0 + side);
    Region::new(vec![polygon(&[
        (-b, -h),
        (-a, -h),
        (-a, -w),
        (a, -w),
        (a, -h),
        (b, -h),
        (b, h),
        (a, h),
        (a, w),
        (-a, w),
        (-a, h),
        (-b, h),
    ])])
}

/// A plate with a keyhole: a round chamber of true arcs that opens upward through a straight slot.
pub fn keyhole(chamber_radius: f64, slot_width: f64, slot_length: f64) -> Region {
    let half = slot_width / 2.0;
    let rise = (chamber_radius * chamber_radius - half * half).sqrt();
    let size = 3.0 * chamber_radius + slot_length;
    let top = rise + slot_length;
    let mut ring = polygon(&[
        (-size, -size),
        (size, -size),
        (size, top),
        (half, top),
        (half, rise),
        (-half, rise),
        (-half, top),
        (-size, top),
    ]);
    ring.vertices[4].link = Link::Arc(Arc { center: Point::origin(), radius: chamber_radius, turn: Turn::Right });
    Region::new(vec![ring])
}

/// A strip of the given width wound outward.
pub fn spiral(turns: f64, pitch: f64, width: f64, vertices: usize) -> Region {
    let at = |t: f64, offset: f64| {
        let angle = TAU * turns * t;
        let radius = pitch * (1.0 + turns * t) + offset;
        Point::new(radius * angle.cos(), radius * angle.sin())
    };
    let n = vertices / 2;
    let t = |k: usize| k as f64 / (n - 1) as f64;
    let outer = (0..n).map(|k| at(t(k), width / 2.0));
    let inner = (0..n).rev().map(|k| at(t(k), -width / 2.0));
    Region::new(vec![Ring::polygon(outer.chain(inner))])
}

/// A disk-like polygon with `count` thin spikes outward and cracks inward.
pub fn spikes(count: usize, seed: u64) -> Region {
    let mut numbers = Numbers::new(seed);
    let pitch = TAU / count as f64;
    Region::new(vec![Ring::polygon((0..count).flat_map(|k| {
        let a = pitch * k as f64;
        let tip = if numbers.unit() < 0.5 { numbers.between(1.0, 4.0) } else { numbers.between(6.0, 12.0) };
        let half = numbers.between(0.001, 0.2) * pitch;
        let middle = a + 0.5 * pitch;
        [(5.0, a), (5.0, middle - half), (tip, middle), (5.0, middle + half)]
            .map(|(radius, angle): (f64, f64)| Point::new(radius * angle.cos(), radius * angle.sin()))
    }))])
}

/// The union of `count` random rectangles and polygonal discs in a square of half side `size`.
pub fn union(count: usize, size: f64, seed: u64) -> Region {
    let mut numbers = Numbers::new(seed);
    let contours: Vec<Vec<[f64; 2]>> = (0..count)
        .map(|_| {
            let center = Point::new(numbers.between(-size, size), numbers.between(-size, size));
            let (corners, a, b, turn) = if numbers.unit() < 0.5 {
                (4, numbers.between(0.2, 4.0), numbers.between(0.2, 4.0), numbers.between(0.0, TAU))
            } else {
                let radius = numbers.between(0.3, 3.0);
                (12 + numbers.below(40), radius, radius, 0.0)
            };
            (0..corners)
                .map(|k| {
                    let angle = TAU * (k as f64 + 0.5) / corners as f64;
                    let (x, y) = (a * angle.cos(), b * angle.sin());
                    let (sin, cos) = turn.sin_cos();
                    [center.x + cos * x - sin * y, center.y + sin * x + cos * y]
                })
                .collect()
        })
        .collect();
    let shapes = FloatOverlay::<[f64; 2], i64>::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::NonZero);
    let rings = shapes.iter().flatten().map(|c| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1]))));
    Region::new(rings.collect())
}

/// `region` turned by `angle` (radians), scaled, and then moved.
pub fn placed(region: &Region, angle: f64, scale: f64, offset: Vector) -> Region {
    let (sin, cos) = angle.sin_cos();
    let map = |p: Point| Point::new(scale * (cos * p.x - sin * p.y), scale * (sin * p.x + cos * p.y)) + offset;
    let vertex = |v: &Vertex| {
        let link = match v.link {
            Link::Line => Link::Line,
            Link::Arc(arc) => Link::Arc(Arc { center: map(arc.center), radius: arc.radius * scale, ..arc }),
        };
        Vertex { point: map(v.point), link, joint: Joint::Corner, id: v.id }
    };
    Region::new(region.rings.iter().map(|r| Ring { vertices: r.vertices.iter().map(vertex).collect() }).collect())
}

/// One of a family of shapes of many kinds, for a radius of 1: the same number gives the same shape.
pub fn mixed(number: u64) -> (String, Region) {
    let mut numbers = Numbers::new(number);
    let n = number;
    let (name, region) = match number % 10 {
        0 | 1 => ("coast", coast(16 << numbers.below(5), numbers.between(2.0, 30.0), n)),
        2 | 3 => ("union", union(3 + numbers.below(12), numbers.between(3.0, 8.0), n)),
        4 => ("spikes", spikes(5 + numbers.below(20), n)),
        5 => (
            "squares",
            squares(
                1 + numbers.below(4),
                1 + numbers.below(4),
                0.5 * (1 + numbers.below(8)) as f64,
                [2.0, 1.0, 3.0][numbers.below(3)],
            ),
        ),
        6 => ("comb", comb(2 + numbers.below(5), numbers.between(0.2, 6.0), [2.0, 1.5, 2.5][numbers.below(3)])),
        7 => ("dumbbell", dumbbell(numbers.between(2.5, 6.0), numbers.between(0.5, 6.0), numbers.between(0.1, 2.4))),
        8 => ("keyhole", keyhole(numbers.between(0.5, 3.0), numbers.between(0.2, 0.9), numbers.between(0.1, 3.0))),
        _ => ("star", star(3 + numbers.below(12), numbers.between(0.5, 4.0), numbers.between(5.0, 12.0))),
    };
    (format!("{name} {number}"), region)
}

/// An upright stroke with slab serifs and a wedge, as of a letter I with a flag: right, sharp and blunt corners.
pub fn serif() -> Region {
    Region::new(vec![polygon(&[
        (-4.0, 0.0),
        (4.0, 0.0),
        (4.0, 0.7),
        (1.2, 1.3),
        (1.2, 12.0),
        (3.5, 12.6),
        (3.5, 13.4),
        (-4.0, 13.0),
        (-4.0, 12.4),
        (-1.2, 12.0),
        (-1.2, 1.3),
        (-4.0, 0.7),
    ])])
}

/// The shapes that the flow is held against the exact closing on, by name.
pub fn flow_shapes() -> Vec<(&'static str, Region)> {
    vec![
        ("corner", l_corner(7.0, 3.0)),
        ("slot", slotted_plate(10.0, 8.0, 1.2, 5.0)),
        ("star", star(7, 4.0, 10.0)),
        ("gear", gear(11, 8.0, 10.0, 3.0)),
        ("serif", serif()),
        ("dumbbell", dumbbell(5.0, 4.0, 1.0)),
        ("spiral", spiral(3.0, 4.0, 2.5, 600)),
        ("coast", coast(300, 12.0, 5)),
    ]
}

/// The largest distance from one boundary to the other, either way, looked for at places `spacing` apart.
pub fn hausdorff(a: &Region, b: &Region, spacing: f64) -> f64 {
    let one_way = |from: &Region, to: &Region| {
        let index = BoundaryIndex::new(to);
        let places = from.segments().flat_map(|s| {
            let n = (s.length() / spacing).ceil().max(1.0) as usize;
            (0..n).map(move |k| s.point_at(k as f64 / n as f64))
        });
        places.map(|p| index.distance(p)).fold(0.0, f64::max)
    };
    one_way(a, b).max(one_way(b, a))
}
