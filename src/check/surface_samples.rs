//! Corners, middles of edges and middles of faces: where a surface is measured.

use std::collections::HashMap;

use crate::mesh::{Point, TriangleMesh, Vector};

/// A place of a surface.
#[derive(Clone, Debug)]
pub(super) struct SurfaceSample {
    pub(super) point: Point,
    /// Directions away from the solid.
    pub(super) outward: Vec<Vector>,
    /// The area that it stands for: over each face a rule that is exact for cubic functions.
    pub(super) area: f64,
}

/// The weights of that rule.
const CENTER: f64 = 9.0 / 20.0;
const MIDDLE: f64 = 2.0 / 15.0;
const CORNER: f64 = 1.0 / 20.0;

/// The samples of the faces for which `is_wanted` holds, each place once: in the order of these faces.
pub(super) fn samples(
    mesh: &TriangleMesh,
    normals: &[Vector],
    is_wanted: impl Fn(usize) -> bool,
) -> Vec<SurfaceSample> {
    let mut samples: Vec<SurfaceSample> = Vec::new();
    // Vertices as edges from themselves to themselves.
    let mut found: HashMap<[u32; 2], usize> = HashMap::new();
    for (k, face) in mesh.faces.iter().enumerate().filter(|(k, _)| is_wanted(*k)) {
        let area_vector = mesh.area_vector(k);
        let (area, normal) = (0.5 * area_vector.norm(), area_vector.try_normalize(0.0));
        let corners = mesh.triangle(k);
        let center = Point::from(corners.iter().map(|p| p.coords).sum::<Vector>() / 3.0);
        samples.push(SurfaceSample { point: center, outward: normal.into_iter().collect(), area: CENTER * area });
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (a, b) = (face[i], face[j]);
            let places = [
                ([a, a], corners[i], normals[a as usize], CORNER),
                ([a.min(b), a.max(b)], nalgebra::center(&corners[i], &corners[j]), Vector::zeros(), MIDDLE),
            ];
            for (key, point, own, weight) in places {
                let at = *found.entry(key).or_insert_with(|| {
                    let outward = if own == Vector::zeros() { Vec::new() } else { vec![own] };
                    samples.push(SurfaceSample { point, outward, area: 0.0 });
                    samples.len() - 1
                });
                samples[at].area += weight * area;
                // On an edge also half way between the faces.
                let outward = &mut samples[at].outward;
                if let (Some(n), false) = (normal, outward.len() > MOST_DIRECTIONS) {
                    let between = outward.first().filter(|_| key[0] != key[1]).and_then(|m| (m + n).try_normalize(0.0));
                    outward.extend(between);
                    if outward.iter().all(|m| m.dot(&n) < SAME) {
                        outward.push(n);
                    }
                }
            }
        }
    }
    samples
}

/// Directions of one place, about: each costs a search.
const MOST_DIRECTIONS: usize = 4;

/// The cosine of the angle below which directions are the same: about a degree and a half.
const SAME: f64 = 0.9997;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::surface_shapes::sphere;

    #[test]
    fn every_place_is_there_once_and_the_areas_are_that_of_the_surface() {
        let ball = sphere(Point::origin(), 1.0, 5);
        let all = samples(&ball, &ball.vertex_normals(), |_| true);
        let faces = ball.faces.len();
        assert_eq!(all.len(), faces + 3 * faces / 2 + ball.points.len());
        let sum: f64 = all.iter().map(|s| s.area).sum();
        assert!((sum - ball.area()).abs() < 1e-12);
        for sample in &all {
            assert!(!sample.outward.is_empty());
            assert!(sample.outward.iter().all(|n| n.dot(&sample.point.coords) > 0.9));
        }
    }
}
