//! Whether a result is all there, and the right way round.

use std::collections::HashSet;

use super::surface::{Largest, bits};
use super::surface_report::{SurfacePlace, SurfaceWhole};
use super::surface_samples::SurfaceSample;
use super::surface_shape::border_edges;
use crate::mesh::{Hierarchy, Point, TriangleMesh, Vector, nearest_on_triangle};
use crate::reference::Solid;
use crate::threads;

/// A place of the input is missing in the output only beyond this, in radii: less is what is left of facets.
const LEFT: f64 = 1e-3;

/// Faces on each other whose normals agree by less than this cosine look to opposite sides.
const OPPOSITE: f64 = -0.5;

/// A volume below this part of the cube of the diagonal has no sign.
const NO_VOLUME: f64 = 1e-9;

/// What is asked about.
pub(super) struct Pair<'a> {
    pub input: &'a TriangleMesh,
    pub output: &'a TriangleMesh,
    pub solid: &'a Solid,
    /// What is nearer to the input than this has not moved.
    pub limit: f64,
    pub radius: f64,
}

impl Pair<'_> {
    /// Asks all of it; of the `samples` of the input each is that far from the output, and `is_free` tells whether a ball about a
    /// point is outside of the input.
    pub fn look(
        &self,
        samples: &[SurfaceSample],
        distances: &[f64],
        is_free: impl Fn(Point) -> bool + Sync,
        h: f64,
    ) -> SurfaceWhole {
        let missing = self.missing(samples, distances, is_free);
        let (turned_faces, turned_area, turned_place) = self.turned();
        let (new_border_edges, new_border_place) = self.new_borders();
        let [doubled_faces_in, doubled_faces_out] = [self.input, self.output].map(doubled);
        SurfaceWhole {
            missing_units: missing.value,
            missing_over_h: missing.value / h,
            missing_place: missing.place,
            inside_out: self.is_inside_out(),
            turned_faces,
            turned_area_over_h2: turned_area / (h * h),
            turned_place,
            new_border_edges,
            new_border_place,
            doubled_faces_in,
            doubled_faces_out,
        }
    }

    /// How far the output is at most from a place of the input that a ball touches: a closing has it on its surface.
    fn missing(&self, samples: &[SurfaceSample], distances: &[f64], is_free: impl Fn(Point) -> bool + Sync) -> Largest {
        let far: Vec<usize> = (0..samples.len()).filter(|&k| distances[k].abs() > LEFT * self.radius).collect();
        let is_touched = threads::map(&far, threads::available(), |&k| {
            let SurfaceSample { point, outward, .. } = &samples[k];
            outward.iter().any(|n| is_free(point + n * self.radius))
        });
        let touched = far.iter().zip(is_touched).filter(|(_, touched)| *touched);
        Largest::of(touched.map(|(&k, _)| (distances[k].abs(), samples[k].point)))
    }

    /// Whether the output is solid where the input is empty and the other way round, as far as both are closed.
    fn is_inside_out(&self) -> bool {
        let volume = |mesh: &TriangleMesh| {
            let is_closed = border_edges(mesh).is_empty();
            Some(mesh.volume()).filter(|v| is_closed && v.abs() > NO_VOLUME * mesh.diagonal().powi(3))
        };
        let [before, after] = [self.input, self.output].map(volume);
        before.zip(after).is_some_and(|(before, after)| before * after < 0.0)
    }

    /// The faces of the output that lie on the input and face the other way: how many, their area, and the middle of the first.
    fn turned(&self) -> (usize, f64, Option<SurfacePlace>) {
        let faces: Vec<usize> = (0..self.output.faces.len()).collect();
        let is_turned = threads::map(&faces, threads::available(), |&f| self.is_turned(f));
        let turned = || faces.iter().zip(&is_turned).filter(|(_, turned)| **turned).map(|(&f, _)| f);
        let area = turned().map(|f| 0.5 * self.output.area_vector(f).norm()).sum();
        (turned().count(), area, turned().next().map(|f| middle(self.output.triangle(f)).into()))
    }

    fn is_turned(&self, f: usize) -> bool {
        let corners = self.output.triangle(f);
        let Some(normal) = self.output.area_vector(f).try_normalize(0.0) else { return false };
        let p = middle(corners);
        let hierarchy = self.solid.hierarchy();
        if !corners.iter().chain([&p]).all(|p| hierarchy.is_nearer(*p, self.limit)) {
            return false;
        }
        // Where sheets of the input lie on each other, one that faces the same way will do.
        let (mut some, mut alike) = (false, false);
        let around = Vector::repeat(self.limit);
        hierarchy.any_in_box(p - around, p + around, |g| {
            let (nearest, _) = nearest_on_triangle(p, self.input.triangle(g as usize));
            if (nearest - p).norm() <= self.limit {
                let cosine = self.solid.face_normal(g).dot(&normal);
                some |= cosine < OPPOSITE;
                alike |= cosine > -OPPOSITE;
            }
            alike
        });
        some && !alike
    }

    /// The border edges of the output that do not lie on a border of the input.
    fn new_borders(&self) -> (usize, Option<SurfacePlace>) {
        let before = border_edges(self.input);
        let flat: Vec<[u32; 3]> = before.iter().map(|&[a, b]| [a, b, b]).collect();
        let borders = Hierarchy::new(&self.input.points, &flat);
        let is_old = |p: &Point| !flat.is_empty() && borders.is_nearer(*p, self.limit);
        let new = border_edges(self.output).into_iter().map(|ends| {
            let [p, q] = ends.map(|v| self.output.points[v as usize]);
            [p, nalgebra::center(&p, &q), q]
        });
        let mut first = None;
        let count = new.filter(|places| !places.iter().all(is_old)).inspect(|places| {
            first = first.or(Some(places[1].into()));
        });
        (count.count(), first)
    }
}

fn middle([a, b, c]: [Point; 3]) -> Point {
    Point::from((a.coords + b.coords + c.coords) / 3.0)
}

/// How many faces have the same three places as one before them, whichever way they run.
fn doubled(mesh: &TriangleMesh) -> usize {
    let mut seen: HashSet<[[u64; 3]; 3]> = HashSet::with_capacity(mesh.faces.len());
    let mut is_again = |k: &usize| {
        let mut places = mesh.triangle(*k).map(|p| bits(&p));
        places.sort_unstable();
        !seen.insert(places)
    };
    (0..mesh.faces.len()).filter(|k| is_again(k)).count()
}
