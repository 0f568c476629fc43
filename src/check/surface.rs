//! A closed or opened surface against the definition of closing and opening.

use std::collections::{HashMap, HashSet};

use super::surface_contact::{Centres, Contact, RESOLUTION};
use super::surface_report::{
    ContactError, CurvatureBound, SelfIntersections, SurfaceCheckError, SurfaceContainment, SurfaceKept, SurfacePlace,
    SurfaceReport, SurfaceTopologies, TriangleQuality,
};
use super::surface_samples::{SurfaceSample, samples};
use super::surface_shape::{angles, is_used, minimum_curvatures, topology, winding_number};
use super::surface_whole::Pair;
use crate::mesh::{Point, TriangleMesh, self_intersections};
use crate::reference::{Operation, Solid};
use crate::threads;

/// A vertex of the output has moved if it is farther than this from the input, in diagonals of the input: above all rounding,
/// below all that is meant.
pub const MOVED: f64 = 1e-6;

/// A vertex need not move if a ball that touches it reaches this far into the input at most, in radii.
const STILL: f64 = 1e-6;

/// Pairs of crossing faces that a report names.
const NAMED_PAIRS: usize = 20;

/// Compares a closing or opening of `input` by a ball of `radius` with what it should be. An opening is the closing of the
/// complement: both surfaces are turned inside out, and all is measured alike. `edge_length` is the one that the lengths
/// in the report refer to.
///
/// The contact error of a place x is dist(x, D) - r with D the centres of all balls of radius r that are outside of the solid: negative
/// where x is outside of the true closing by so much. It is computed from the triangles of the input alone, and certified to
/// 4 thousandths of the radius where `certain_share` counts it.
///
/// # Errors
/// See [`SurfaceCheckError`].
pub fn surface(
    input: &TriangleMesh,
    output: &TriangleMesh,
    radius: f64,
    operation: Operation,
    edge_length: f64,
) -> Result<SurfaceReport, SurfaceCheckError> {
    let is_length = |x: f64| x.is_finite() && x > 0.0;
    if !is_length(radius) || !is_length(edge_length) {
        return Err(SurfaceCheckError::Length { radius, edge_length });
    }
    validate(input, "input")?;
    validate(output, "output")?;
    let turned = match operation {
        Operation::Close => None,
        Operation::Open => Some([input.reversed(), output.reversed()]),
    };
    let [input, output] = turned.as_ref().map_or([input, output], |[a, b]| [a, b]);
    let (solid, result) = (Solid::new(input), Solid::new(output));
    let limit = MOVED * input.diagonal();
    let has_moved = threads::map(&output.points, threads::available(), |p| !solid.hierarchy().is_nearer(*p, limit));
    let moved_face = |f: usize| output.faces[f].iter().any(|&v| has_moved[v as usize]);
    let normals = output.vertex_normals();
    let moved = samples(output, &normals, moved_face);
    let kept = samples(output, &normals, |f| !moved_face(f));
    let centres = Centres::new(input, &solid, radius);
    let covered = samples(input, &input.vertex_normals(), |_| true);
    let outside = threads::map(&covered, threads::available(), |s| result.distance(s.point));
    let pair = Pair { input, output, solid: &solid, limit, radius };
    let output_pairs = self_intersections(output);
    Ok(SurfaceReport {
        operation,
        radius_units: radius,
        edge_length_units: edge_length,
        contact: contact_error(&centres, &moved, &kept, edge_length, radius),
        containment: containment([input, output], &solid, &moved, (&covered, &outside), edge_length),
        whole: pair.look(&covered, &outside, |y| centres.is_free(y), edge_length),
        kept: kept_part(input, output, &centres, radius),
        self_intersections: SelfIntersections {
            input_pairs: self_intersections(input).len(),
            output_pairs: output_pairs.len(),
            first_output_pairs: output_pairs.into_iter().take(NAMED_PAIRS).collect(),
        },
        quality: quality(output, moved_face, edge_length),
        curvature: curvature(output, &has_moved, radius),
        topology: SurfaceTopologies { input: topology(input), output: topology(output) },
    })
}

fn validate(mesh: &TriangleMesh, name: &'static str) -> Result<(), SurfaceCheckError> {
    if mesh.faces.is_empty() {
        return Err(SurfaceCheckError::Empty { mesh: name });
    }
    if let Some(vertex) = mesh.points.iter().position(|p| !p.coords.iter().all(|x| x.is_finite())) {
        return Err(SurfaceCheckError::NotFinite { mesh: name, vertex });
    }
    let exists = |f: &[u32; 3]| f.iter().all(|&v| (v as usize) < mesh.points.len());
    match mesh.faces.iter().position(|f| !exists(f)) {
        Some(face) => Err(SurfaceCheckError::Face { mesh: name, face }),
        None => Ok(()),
    }
}

/// A maximum and where it is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Largest {
    pub(super) value: f64,
    pub(super) place: Option<SurfacePlace>,
}

impl Largest {
    fn meet(&mut self, value: f64, p: Point) {
        if value > self.value {
            *self = Largest { value, place: Some([p.x, p.y, p.z]) };
        }
    }

    pub(super) fn of(values: impl Iterator<Item = (f64, Point)>) -> Largest {
        let mut largest = Largest::default();
        values.for_each(|(value, p)| largest.meet(value, p));
        largest
    }
}

/// A part of a whole; `of_none` where there is no whole.
fn share(part: f64, whole: f64, of_none: f64) -> f64 {
    if whole > 0.0 { part / whole } else { of_none }
}

fn contact_error(
    centres: &Centres,
    moved: &[SurfaceSample],
    kept: &[SurfaceSample],
    h: f64,
    radius: f64,
) -> ContactError {
    let errors: Vec<Contact> = threads::map(moved, threads::available(), |s| centres.contact(s.point, &s.outward));
    let still: Vec<Contact> =
        threads::map(kept, threads::available(), |s| centres.contact_on_surface(s.point, &s.outward));
    let pairs = || moved.iter().zip(&errors);
    let area: f64 = moved.iter().map(|s| s.area).sum();
    let rest: f64 = kept.iter().map(|s| s.area).sum();
    let integral = |f: &dyn Fn(f64) -> f64| pairs().map(|(s, e)| s.area * f(e.depth)).sum::<f64>();
    let too_fat = Largest::of(pairs().map(|(s, e)| (-e.depth, s.point)));
    // Where the search was broken off only what is proved counts.
    let is_certain = |e: &Contact| e.uncertainty <= 1.01 * RESOLUTION * radius;
    let proved = |e: &Contact| if is_certain(e) { e.depth } else { (e.depth - e.uncertainty).max(0.0) };
    let unfilled = Largest::of(pairs().filter(|(_, e)| e.depth > 0.0).map(|(s, e)| (proved(e), s.point)));
    let in_doubt = Largest::of(pairs().filter(|(_, e)| e.depth > 0.0).map(|(s, e)| (e.depth - proved(e), s.point)));
    let not_moved = Largest::of(kept.iter().zip(&still).map(|(s, e)| (e.depth, s.point)));
    let certain = errors.iter().filter(|e| is_certain(e)).count();
    ContactError {
        mean_over_h: share(integral(&f64::abs), area, 0.0) / h,
        bias_over_h: share(integral(&|e| -e), area, 0.0) / h,
        largest_over_h: too_fat.value.max(unfilled.value) / h,
        too_fat_over_h: too_fat.value / h,
        too_fat_place: too_fat.place,
        unfilled_over_h: unfilled.value / h,
        unfilled_place: unfilled.place,
        in_doubt_over_h: in_doubt.value / h,
        in_doubt_place: in_doubt.place,
        unfilled_where_kept_over_h: not_moved.value / h,
        unfilled_where_kept_place: not_moved.place,
        uncertain_where_kept_over_h: still.iter().map(|e| e.uncertainty).fold(0.0, f64::max) / h,
        share_beyond_half_h: share(integral(&|e| f64::from(u8::from(e.abs() > 0.5 * h))), area, 0.0),
        moved_area_share: share(area, area + rest, 0.0),
        moved_samples: moved.len(),
        kept_samples: kept.len(),
        uncertainty_over_h: errors.iter().map(|e| e.uncertainty).fold(0.0, f64::max) / h,
        certain_share: share(certain as f64, errors.len() as f64, 1.0),
    }
}

fn containment(
    [input, output]: [&TriangleMesh; 2],
    solid: &Solid,
    moved: &[SurfaceSample],
    (covered, outside): (&[SurfaceSample], &[f64]),
    h: f64,
) -> SurfaceContainment {
    let points: Vec<Point> = moved.iter().map(|s| s.point).collect();
    let inside = threads::map(&points, threads::available(), |p| -solid.distance(*p));
    let [below, beyond] = [hollow(input), hollow(output)];
    let sunken = deepest(&inside, &points, |p| winding_number(input, p) + below > 0.5);
    let points: Vec<Point> = covered.iter().map(|s| s.point).collect();
    let bared = deepest(outside, &points, |p| winding_number(output, p) + beyond < 0.5);
    SurfaceContainment {
        output_violation_units: sunken.value,
        output_violation_over_h: sunken.value / h,
        output_place: sunken.place,
        input_violation_units: bared.value,
        input_violation_over_h: bared.value / h,
        input_place: bared.place,
    }
}

/// What is added to the winding number of a surface that is turned inside out: all of space around it is solid.
fn hollow(mesh: &TriangleMesh) -> f64 {
    if mesh.volume() < 0.0 { 1.0 } else { 0.0 }
}

/// The largest of `depths` for which `is_confirmed` holds: near folded or degenerate faces the sign of a distance may be wrong.
fn deepest(depths: &[f64], points: &[Point], is_confirmed: impl Fn(Point) -> bool) -> Largest {
    let mut order: Vec<usize> = (0..points.len()).filter(|&k| depths[k] > 0.0).collect();
    order.sort_unstable_by(|&a, &b| depths[b].total_cmp(&depths[a]).then(a.cmp(&b)));
    let found = order.into_iter().take(MOST_CONFIRMATIONS).find(|&k| is_confirmed(points[k]));
    Largest::of(found.into_iter().map(|k| (depths[k], points[k])))
}

/// Each confirmation looks at all faces. A surface with so many wrong signs is reported without violation: its crossings are.
const MOST_CONFIRMATIONS: usize = 2000;

/// The bits of a point; minus zero is zero.
pub(super) fn bits(p: &Point) -> [u64; 3] {
    [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits())
}

fn kept_part(input: &TriangleMesh, output: &TriangleMesh, centres: &Centres, radius: f64) -> SurfaceKept {
    // Places get numbers, and faces are compared by these, whichever corner comes first.
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let mut number = |p: &Point| {
        let next = numbers.len() as u32;
        *numbers.entry(bits(p)).or_insert(next)
    };
    let before: Vec<u32> = input.points.iter().map(&mut number).collect();
    let after: Vec<u32> = output.points.iter().map(&mut number).collect();
    let turned = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c]);
    let faces: HashSet<[u32; 3]> = output.faces.iter().map(|f| turned(f.map(|v| after[v as usize]))).collect();
    let vertices: HashSet<u32> = output.faces.as_flattened().iter().map(|&v| after[v as usize]).collect();
    let used: Vec<u32> = is_used(input).into_iter().zip(0u32..).filter(|(used, _)| *used).map(|(_, v)| v).collect();
    let is_found = |v: &u32| vertices.contains(&before[*v as usize]);
    let normals = input.vertex_normals();
    let depths = threads::map(&used, threads::available(), |&v| {
        centres.contact_on_surface(input.points[v as usize], &[normals[v as usize]]).depth
    });
    let still: Vec<u32> = used.iter().zip(&depths).filter(|(_, d)| **d <= STILL * radius).map(|(v, _)| *v).collect();
    let vertices_found = used.iter().filter(|v| is_found(v)).count();
    let still_vertices_found = still.iter().filter(|v| is_found(v)).count();
    let faces_found = input.faces.iter().filter(|f| faces.contains(&turned(f.map(|v| before[v as usize])))).count();
    SurfaceKept {
        input_vertices: used.len(),
        vertices_found,
        vertex_share: share(vertices_found as f64, used.len() as f64, 1.0),
        still_vertices: still.len(),
        still_vertices_found,
        still_vertex_share: share(still_vertices_found as f64, still.len() as f64, 1.0),
        input_faces: input.faces.len(),
        faces_found,
        face_share: share(faces_found as f64, input.faces.len() as f64, 1.0),
    }
}

fn quality(mesh: &TriangleMesh, is_wanted: impl Fn(usize) -> bool, h: f64) -> TriangleQuality {
    let faces: Vec<usize> = (0..mesh.faces.len()).filter(|&f| is_wanted(f)).collect();
    let mut smallest = (60.0, None);
    let (mut sum, mut edges) = (0.0, 0.0);
    for &f in &faces {
        let corners = mesh.triangle(f);
        let least = angles(corners).into_iter().fold(f64::INFINITY, f64::min).to_degrees();
        if least < smallest.0 {
            smallest = (least, Some([corners[0].x, corners[0].y, corners[0].z]));
        }
        sum += least;
        edges += (0..3).map(|k| (corners[(k + 1) % 3] - corners[k]).norm()).sum::<f64>() / 3.0;
    }
    let count = faces.len() as f64;
    TriangleQuality {
        moved_faces: faces.len(),
        smallest_angle_degrees: smallest.0,
        smallest_angle_place: smallest.1,
        mean_smallest_angle_degrees: share(sum, count, 60.0),
        mean_edge_over_h: share(edges, count, 0.0) / h,
    }
}

fn curvature(mesh: &TriangleMesh, has_moved: &[bool], radius: f64) -> CurvatureBound {
    let curvatures = minimum_curvatures(mesh);
    let used = is_used(mesh);
    let moved: Vec<f64> =
        (0..curvatures.len()).filter(|&v| has_moved[v] && used[v]).map(|v| curvatures[v] * radius).collect();
    let below = |bound: f64| share(moved.iter().filter(|k| **k < -bound).count() as f64, moved.len() as f64, 0.0);
    CurvatureBound {
        moved_vertices: moved.len(),
        share_below_1_1: below(1.1),
        share_below_1_5: below(1.5),
        least_times_r: moved.iter().copied().reduce(f64::min).unwrap_or(0.0),
    }
}

#[cfg(test)]
mod tests;
