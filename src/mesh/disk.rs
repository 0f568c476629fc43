//! What a few triangles lie in, tighter than a box.

use super::{Point, Vector};

/// Rounding may make a disk seem farther than it is by less than this part of the square of its distance.
const DISK_ROUNDING: f64 = 1e-12;

/// The same for this part of the square of the distance from its centre.
const CENTER_ROUNDING: f64 = 1e-14;

/// A thick disk with the triangles of a node in it, across their mean normal.
///
/// A ball that touches a finely sampled surface is near a great many boxes, each as thick as its triangles are long where the
/// surface is not along an axis; disks are as thin as the surface is flat.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disk {
    center: Point,
    /// Of unit length, or zero.
    normal: Vector,
    /// Half its thickness.
    half: f64,
    radius: f64,
}

impl Disk {
    /// Nothing is outside of it.
    pub const EVERYTHING: Disk = Disk {
        center: Point::new(0.0, 0.0, 0.0),
        normal: Vector::new(0.0, 0.0, 0.0),
        half: f64::INFINITY,
        radius: f64::INFINITY,
    };

    /// The disk around a centre along the mean normal of triangles.
    pub fn around(triangles: &[[Point; 3]], center: Point) -> Disk {
        let sum: Vector = triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a))).sum();
        let Some(normal) = sum.try_normalize(0.0) else { return Disk::EVERYTHING };
        let offsets = triangles.iter().flatten().map(|p| p - center);
        let (half, radius2) = offsets.fold((0.0f64, 0.0f64), |(half, radius2), q| {
            (half.max(normal.dot(&q).abs()), radius2.max(normal.cross(&q).norm_squared()))
        });
        Disk { center, normal, half, radius: radius2.sqrt() }
    }

    /// The square of the distance of `p` from the disk, no more than it is.
    #[inline]
    pub fn distance2(&self, p: &Point) -> f64 {
        let q = p - self.center;
        let (q2, height) = (q.norm_squared(), self.normal.dot(&q).abs());
        let above = (height - self.half).max(0.0);
        let across2 = q2 - height * height;
        let beside = if across2 <= self.radius * self.radius { 0.0 } else { across2.sqrt() - self.radius };
        ((above * above + beside * beside) * (1.0 - DISK_ROUNDING) - CENTER_ROUNDING * q2).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::nearest_on_triangle;

    #[test]
    fn no_triangle_is_nearer_than_its_disk() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut is_tight = 0;
        for _ in 0..2000 {
            let mut place = |size: f64| Point::new(size * next(), size * next(), 0.1 * size * next());
            let triangles: Vec<[Point; 3]> = (0..4).map(|_| [place(1.0), place(1.0), place(1.0)]).collect();
            let disk = Disk::around(&triangles, place(0.5));
            let p = place(6.0);
            let least = triangles
                .iter()
                .map(|t| (p - nearest_on_triangle(p, *t).0).norm_squared())
                .fold(f64::INFINITY, f64::min);
            assert!(disk.distance2(&p) <= least * (1.0 + 1e-14) + 1e-30);
            is_tight += usize::from(disk.distance2(&p) > 0.5 * least);
        }
        assert!(is_tight > 200, "{is_tight}");
        let p = Point::new(1.0, 2.0, 3.0);
        assert_eq!(Disk::EVERYTHING.distance2(&p), 0.0);
        assert_eq!(Disk::around(&[[p; 3]], p).distance2(&Point::origin()), 0.0);
    }
}
