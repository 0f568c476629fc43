//! Triangles into samples: a buffer of depths, and light.

use super::mesh_view::Camera;
use crate::mesh::{TriangleMesh, Vector};

/// Samples of a pixel along each of its sides.
pub(super) const SAMPLES: usize = 2;

/// So many samples are worked on at a time: what bounds the memory of large pictures.
const BAND: usize = 1 << 23;

/// Faces that meet at a smaller angle look like one smooth surface, in degrees.
const CREASE: f64 = 35.0;

/// No face.
const NONE: u32 = u32::MAX;

/// How the light falls on faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Round where faces meet at small angles, with edges where they meet at large ones.
    #[default]
    Smooth,
    /// Each face by itself.
    Flat,
}

/// Triangles in the picture, their corners in samples, with all that their light depends on.
pub(super) struct Scene {
    corners: Vec<[Vector; 3]>,
    /// Directions of the picture, of each corner.
    normals: Vec<[Vector; 3]>,
    lamps: Lamps,
    width: usize,
    height: usize,
}

impl Scene {
    pub(super) fn new(mesh: &TriangleMesh, camera: &Camera, shading: Shading) -> Scene {
        let seen = |p| {
            let q = camera.pixel(p) * SAMPLES as f64;
            // Samples lie in the middle of their squares.
            Vector::new(q.x - 0.5, q.y - 0.5, q.z)
        };
        let points: Vec<Vector> = mesh.points.iter().map(seen).collect();
        let normals = corner_normals(mesh, shading);
        Scene {
            corners: mesh.faces.iter().map(|f| f.map(|v| points[v as usize])).collect(),
            normals: normals.iter().map(|n| n.map(|n| camera.view.direction(&n))).collect(),
            lamps: Lamps::new(),
            width: camera.width as usize * SAMPLES,
            height: camera.height as usize * SAMPLES,
        }
    }

    /// How many samples show a face for which `counts` holds, and how many show any.
    pub(super) fn count(&self, counts: impl Fn(usize) -> bool) -> [usize; 2] {
        let mut found = [0; 2];
        self.for_each_band(|_, seen| {
            for &face in seen.iter().filter(|&&face| face != NONE) {
                found[0] += usize::from(counts(face as usize));
                found[1] += 1;
            }
        });
        found
    }

    /// The colours of all pixels, row after row from the top, of faces whose own colour at the weights of their corners
    /// `colour` tells; white where there is none.
    pub(super) fn paint(
        &self,
        colour: impl Fn(usize, [f64; 3]) -> [f64; 3],
        mut pixel: impl FnMut(usize, usize, [u8; 3]),
    ) {
        let columns = self.width / SAMPLES;
        self.for_each_band(|first_row, seen| {
            for (row, lines) in seen.chunks_exact(self.width * SAMPLES).enumerate() {
                for column in 0..columns {
                    let mut sum = [0.0; 3];
                    for k in 0..SAMPLES * SAMPLES {
                        let (x, y) = (column * SAMPLES + k % SAMPLES, k / SAMPLES);
                        let light = match lines[y * self.width + x] {
                            NONE => [255.0; 3],
                            face => self.light(face as usize, [x, first_row + row * SAMPLES + y], &colour),
                        };
                        for (total, part) in sum.iter_mut().zip(light) {
                            *total += part;
                        }
                    }
                    let mean = sum.map(|x| (x / (SAMPLES * SAMPLES) as f64).round().clamp(0.0, 255.0) as u8);
                    pixel(column, first_row / SAMPLES + row, mean);
                }
            }
        });
    }

    /// Calls `visit` with the faces that each sample of a band of rows shows, and the first row of the band.
    fn for_each_band(&self, mut visit: impl FnMut(usize, &[u32])) {
        let rows = (BAND / self.width.max(1)).max(SAMPLES) / SAMPLES * SAMPLES;
        let rows = rows.min(self.height);
        let (mut depths, mut faces) = (Vec::new(), Vec::new());
        for start in (0..self.height).step_by(rows.max(1)) {
            let end = (start + rows).min(self.height);
            depths.clear();
            depths.resize((end - start) * self.width, f32::INFINITY);
            faces.clear();
            faces.resize((end - start) * self.width, NONE);
            for face in 0..self.corners.len() {
                self.draw(face, start, end, &mut depths, &mut faces);
            }
            visit(start, &faces);
        }
    }

    /// Puts a face where it is nearer than what was there.
    fn draw(&self, face: usize, start: usize, end: usize, depths: &mut [f32], faces: &mut [u32]) {
        let [a, b, c] = self.corners[face];
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let first = |x: f64| x.ceil().max(0.0) as usize;
        // One past the last sample.
        let last = |x: f64, limit: usize| (x.floor() + 1.0).clamp(0.0, limit as f64) as usize;
        let (left, right) = (first(low.x), last(high.x, self.width));
        let (top, bottom) = (first(low.y).max(start), last(high.y, end));
        let area = cross(a, b, c);
        if area == 0.0 || left >= right || top >= bottom {
            return;
        }
        for y in top..bottom {
            let line = (y - start) * self.width;
            for x in left..right {
                let w = weights([a, b, c], area, [x as f64, y as f64]);
                if w[0] >= 0.0 && w[1] >= 0.0 && w[2] >= 0.0 {
                    let depth = (w[0] * a.z + w[1] * b.z + w[2] * c.z) as f32;
                    let at = line + x;
                    if depth < depths[at] {
                        depths[at] = depth;
                        faces[at] = face as u32;
                    }
                }
            }
        }
    }

    /// The colour of a sample, from 0 to 255.
    fn light(&self, face: usize, [x, y]: [usize; 2], colour: &impl Fn(usize, [f64; 3]) -> [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.corners[face];
        let area = cross(a, b, c);
        let w = weights([a, b, c], area, [x as f64, y as f64]);
        let [u, v, n] = self.normals[face];
        let normal = (u * w[0] + v * w[1] + n * w[2]).try_normalize(0.0).unwrap_or(Vector::z());
        // Down is positive in the picture: what faces the eye runs clockwise there.
        let is_back = area > 0.0;
        let normal = if is_back { -normal } else { normal };
        let own = if is_back { BACK.map(f64::from) } else { colour(face, w) };
        let diffuse = AMBIENT
            + KEY * normal.dot(&self.lamps.key).max(0.0)
            + FILL * normal.dot(&self.lamps.fill).max(0.0)
            + SKY * (0.5 + 0.5 * normal.y);
        let gloss = 255.0 * GLOSS * normal.dot(&self.lamps.half).max(0.0).powi(GLOSS_POWER);
        own.map(|x| (x * diffuse + gloss).min(255.0))
    }
}

/// The light: a lamp above the left shoulder, a weak one from the right, the sky and what is all around. The brightest
/// face has about its own colour.
const KEY_FROM: [f64; 3] = [-0.45, 0.62, 0.64];
const FILL_FROM: [f64; 3] = [0.85, -0.1, 0.5];
const KEY: f64 = 0.53;
const FILL: f64 = 0.17;
const SKY: f64 = 0.14;
const AMBIENT: f64 = 0.34;
/// The shine of a matt varnish.
const GLOSS: f64 = 0.10;
const GLOSS_POWER: i32 = 24;
/// The inside of a surface, where it is open or turned inside out.
const BACK: [u8; 3] = [120, 108, 92];

/// Unit vectors towards the lamps.
struct Lamps {
    key: Vector,
    fill: Vector,
    /// Half way between the lamp and the eye.
    half: Vector,
}

impl Lamps {
    fn new() -> Lamps {
        let [key, fill] = [KEY_FROM, FILL_FROM].map(|d| Vector::from(d).normalize());
        Lamps { key, fill, half: (key + Vector::z()).normalize() }
    }
}

/// Twice the area of a triangle in the picture, with its sign.
fn cross(a: Vector, b: Vector, c: Vector) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The weights of the corners at a place in the picture: all at least 0 in the triangle.
fn weights([a, b, c]: [Vector; 3], area: f64, [x, y]: [f64; 2]) -> [f64; 3] {
    let part = |p: Vector, q: Vector| ((p.x - x) * (q.y - y) - (p.y - y) * (q.x - x)) / area;
    [part(b, c), part(c, a), part(a, b)]
}

/// Normals at the corners of the faces: with smooth shading the mean of the faces around the vertex that meet the face at
/// less than [`CREASE`], by area.
fn corner_normals(mesh: &TriangleMesh, shading: Shading) -> Vec<[Vector; 3]> {
    let areas: Vec<Vector> = (0..mesh.faces.len()).map(|k| mesh.area_vector(k)).collect();
    let units: Vec<Vector> = areas.iter().map(|n| n.try_normalize(0.0).unwrap_or_default()).collect();
    if shading == Shading::Flat {
        return units.iter().map(|&n| [n; 3]).collect();
    }
    // The faces at each vertex, one vertex after the other.
    let mut starts = vec![0u32; mesh.points.len() + 1];
    for v in mesh.faces.as_flattened() {
        starts[*v as usize + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; 3 * mesh.faces.len()];
    for (k, face) in mesh.faces.iter().enumerate() {
        for &v in face {
            around[next[v as usize] as usize] = k as u32;
            next[v as usize] += 1;
        }
    }
    let limit = CREASE.to_radians().cos();
    let normal = |k: usize, v: u32| -> Vector {
        let faces = &around[starts[v as usize] as usize..starts[v as usize + 1] as usize];
        let alike = faces.iter().map(|&f| f as usize).filter(|&f| units[f].dot(&units[k]) >= limit);
        alike.map(|f| areas[f]).sum::<Vector>().try_normalize(0.0).unwrap_or(units[k])
    };
    mesh.faces.iter().enumerate().map(|(k, face)| face.map(|v| normal(k, v))).collect()
}
