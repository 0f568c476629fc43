//! Pictures of surfaces, without a graphics card.
//!
//! A buffer of depths with four samples a pixel; parallel rays, the box around the surface in view; a fixed light. The side
//! looked at is the one of four that shows most of what moved. The same input gives the same bytes.

use tiny_skia::{Color, Pixmap};

use super::PreviewError;
use super::mesh_raster::{Scene, Shading};
use super::mesh_view::{Camera, VIEWS, View};
use crate::mesh::{Point, TriangleMesh};

/// How a surface is shown.
#[derive(Clone, Copy, Debug)]
pub struct MeshStyle<'a> {
    /// Faces that moved, which get another colour: one flag for each.
    pub moved: Option<&'a [bool]>,
    /// The colour of each vertex, red green blue: instead of the colours for what moved and what did not.
    pub colours: Option<&'a [[u8; 3]]>,
    /// How the light falls.
    pub shading: Shading,
    /// The longer side of the picture in pixels.
    pub size: u32,
}

impl Default for MeshStyle<'_> {
    fn default() -> Self {
        MeshStyle { moved: None, colours: None, shading: Shading::Smooth, size: 1024 }
    }
}

/// What stays.
const STAYS: [u8; 3] = [214, 218, 222];
/// What moved.
const MOVED: [u8; 3] = [242, 94, 140];

/// Pixels of the rough pictures by which a side is chosen.
const ROUGH: u32 = 160;

/// A surface as a PNG file.
///
/// # Errors
/// Where there is nothing to show, coordinates are not finite, or the size is absurd.
pub fn mesh(mesh: &TriangleMesh, style: &MeshStyle) -> Result<Vec<u8>, PreviewError> {
    meshes(&[(mesh, *style)])
}

/// Surfaces side by side as a PNG file, all seen from the same side and at the same scale: before and after. The largest of
/// the sizes holds for all.
///
/// # Errors
/// As for [`mesh`].
pub fn meshes(pictures: &[(&TriangleMesh, MeshStyle)]) -> Result<Vec<u8>, PreviewError> {
    let size = pictures.iter().map(|(_, style)| style.size).max().ok_or(PreviewError::Nothing)?;
    if !(64..=16_384).contains(&size) {
        return Err(PreviewError::Size { width: size, height: size });
    }
    // Vertices that no face has are not seen.
    let used: Vec<Point> = pictures.iter().flat_map(|(mesh, _)| corners(mesh)).collect();
    let Some(&first) = used.first() else { return Err(PreviewError::Nothing) };
    let [low, high] = used.iter().fold([first; 2], |[low, high], p| [low.inf(p), high.sup(p)]);
    let is_finite = used.iter().all(|p| p.coords.iter().all(|x| x.is_finite()));
    if !is_finite || !(high - low).norm().is_finite() {
        return Err(PreviewError::Nothing);
    }
    let camera = |view: usize, size: u32| Camera::fit(View::new([low, high], view), used.iter(), size);
    let camera = camera(best_view(pictures, |view| camera(view, ROUGH)), size);
    let (width, height) = (camera.width, camera.height);
    let all = u64::from(width) * pictures.len() as u64;
    let too_large = PreviewError::Size { width: all.min(u64::from(u32::MAX)) as u32, height };
    let total = u32::try_from(all).ok().filter(|&w| w <= WIDEST).ok_or(too_large.clone())?;
    let mut sheet = Pixmap::new(total, height).ok_or(too_large)?;
    sheet.fill(Color::WHITE);
    for (k, (mesh, style)) in pictures.iter().enumerate() {
        let offset = k * width as usize;
        let bytes = sheet.data_mut();
        Scene::new(mesh, &camera, style.shading).paint(
            |face, weights| own_colour(mesh, style, face, weights),
            |x, y, [r, g, b]| {
                let at = 4 * (y * total as usize + offset + x);
                bytes[at..at + 4].copy_from_slice(&[r, g, b, 255]);
            },
        );
    }
    sheet.encode_png().map_err(|e| PreviewError::Encoding(e.to_string()))
}

/// Wider pictures are none.
const WIDEST: u32 = 65_536;

/// The places of all vertices that faces have.
fn corners(mesh: &TriangleMesh) -> Vec<Point> {
    let mut is_used = vec![false; mesh.points.len()];
    for &v in mesh.faces.as_flattened() {
        is_used[v as usize] = true;
    }
    mesh.points.iter().zip(is_used).filter(|(_, used)| *used).map(|(p, _)| *p).collect()
}

/// The side that shows most of what moved; the first where nothing is said to have moved, or all sides show as much.
fn best_view(pictures: &[(&TriangleMesh, MeshStyle)], camera: impl Fn(usize) -> Camera) -> usize {
    if !pictures.iter().any(|(_, style)| style.moved.is_some_and(|m| m.contains(&true))) {
        return 0;
    }
    let seen = |view: usize| -> usize {
        let camera = camera(view);
        let of = |(mesh, style): &(&TriangleMesh, MeshStyle)| match style.moved {
            Some(moved) => Scene::new(mesh, &camera, Shading::Flat).count(|face| moved.get(face) == Some(&true))[0],
            None => 0,
        };
        pictures.iter().map(of).sum()
    };
    let counts: Vec<usize> = (0..VIEWS).map(seen).collect();
    // The first of equals.
    (0..VIEWS).rev().max_by_key(|&k| counts[k]).unwrap_or(0)
}

/// The colour of a face before light falls on it, at the weights of its corners.
fn own_colour(mesh: &TriangleMesh, style: &MeshStyle, face: usize, weights: [f64; 3]) -> [f64; 3] {
    let plain = if style.moved.is_some_and(|m| m.get(face) == Some(&true)) { MOVED } else { STAYS };
    let Some(colours) = style.colours else { return plain.map(f64::from) };
    let mut sum = [0.0; 3];
    for (v, w) in mesh.faces[face].into_iter().zip(weights) {
        let colour = colours.get(v as usize).copied().unwrap_or(plain);
        for (total, part) in sum.iter_mut().zip(colour) {
            *total += w * f64::from(part);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with a corner at the origin.
    fn block(x: f64, y: f64, z: f64) -> TriangleMesh {
        let corner = |k: u32| Point::new(f64::from(k & 1) * x, f64::from(k >> 1 & 1) * y, f64::from(k >> 2 & 1) * z);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriangleMesh::new((0..8).map(corner).collect(), faces)
    }

    /// The pixels of a picture: its width and height, and red green blue.
    fn decode(png: &[u8]) -> (u32, u32, Vec<[u8; 3]>) {
        let pixmap = Pixmap::decode_png(png).unwrap();
        let pixels = pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
        (pixmap.width(), pixmap.height(), pixels)
    }

    fn is_white(p: &[u8; 3]) -> bool {
        *p == [255; 3]
    }

    #[test]
    fn a_cube_covers_the_hexagon_that_geometry_says() {
        let cube = block(1.0, 1.0, 1.0);
        assert!((cube.volume() - 1.0).abs() < 1e-12);
        let style = MeshStyle { size: 400, shading: Shading::Flat, ..MeshStyle::default() };
        let (width, height, pixels) = decode(&mesh(&cube, &style).unwrap());
        // A unit cube's shadow along n has the area |nx| + |ny| + |nz|.
        let (rise, reach) = 28f64.to_radians().sin_cos();
        let (sin, cos) = 55f64.to_radians().sin_cos();
        let area = rise + reach * (sin + cos);
        let tall = reach + rise * (sin + cos);
        let scale = f64::from(width.max(height)) * 0.92 / tall.max(sin + cos);
        let covered = pixels.iter().filter(|p| !is_white(p)).count() as f64;
        assert!((covered / (area * scale * scale) - 1.0).abs() < 0.02, "{covered} of {}", area * scale * scale);
        // Three sides are seen, each of one brightness: inside them three colours and no more.
        let mut shades = pixels.clone();
        shades.sort_unstable();
        let frequent = shades.chunk_by(|a, b| a == b).filter(|c| c.len() > 2000 && !is_white(&c[0])).count();
        assert_eq!(frequent, 3);
    }

    #[test]
    fn what_moved_is_seen_and_what_is_hidden_is_not() {
        let cube = block(1.0, 1.0, 1.0);
        let is_pink = |p: &&[u8; 3]| p[0] > p[1].saturating_add(60);
        for face in 0..6 {
            let moved: Vec<bool> = (0..12).map(|f| f / 2 == face).collect();
            let style = MeshStyle { moved: Some(&moved), size: 128, ..MeshStyle::default() };
            let (_, _, pixels) = decode(&mesh(&cube, &style).unwrap());
            let pink = pixels.iter().filter(is_pink).count();
            // The side is chosen so that it is seen, but nobody looks from below.
            assert_eq!(pink > 500, face != 0, "side {face}: {pink} pixels");
        }
    }

    #[test]
    fn vertex_colours_blend_over_a_face() {
        let flat = TriangleMesh::new(
            vec![Point::new(0.0, 0.0, 0.0), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)],
            vec![[0, 1, 2]],
        );
        let colours = [[255, 0, 0], [0, 255, 0], [0, 0, 255]];
        let style = MeshStyle { colours: Some(&colours), size: 200, ..MeshStyle::default() };
        let (_, _, pixels) = decode(&mesh(&flat, &style).unwrap());
        for k in 0..3 {
            assert!(pixels.iter().any(|p| p[k] > 150 && p[(k + 1) % 3] < 60 && p[(k + 2) % 3] < 60), "corner {k}");
        }
    }

    #[test]
    fn pictures_side_by_side_share_their_scale() {
        let (small, large) = (block(1.0, 1.0, 1.0), block(2.0, 2.0, 2.0));
        let style = MeshStyle { size: 200, ..MeshStyle::default() };
        let (width, _, pixels) = decode(&meshes(&[(&small, style), (&large, style)]).unwrap());
        let half = width as usize / 2;
        let count = |left: bool| {
            let inside = |(k, p): (usize, &[u8; 3])| usize::from((k % (width as usize) < half) == left && !is_white(p));
            pixels.iter().enumerate().map(inside).sum::<usize>() as f64
        };
        assert!((count(false) / count(true) - 4.0).abs() < 0.1, "twice as large, four times the pixels");
        assert_eq!(
            meshes(&[(&small, style), (&large, style)]).unwrap(),
            meshes(&[(&small, style), (&large, style)]).unwrap()
        );
    }

    #[test]
    fn what_cannot_be_shown_is_an_error() {
        let style = MeshStyle::default();
        assert_eq!(mesh(&TriangleMesh::default(), &style), Err(PreviewError::Nothing));
        assert_eq!(meshes(&[]), Err(PreviewError::Nothing));
        let mut broken = block(1.0, 1.0, 1.0);
        broken.points[3].x = f64::NAN;
        assert_eq!(mesh(&broken, &style), Err(PreviewError::Nothing));
        let tiny = MeshStyle { size: 3, ..style };
        assert!(matches!(mesh(&block(1.0, 1.0, 1.0), &tiny), Err(PreviewError::Size { .. })));
        // Faces without area, and a surface that is one point.
        let point = TriangleMesh::new(vec![Point::origin(); 3], vec![[0, 1, 2]]);
        assert!(mesh(&point, &style).is_ok());
    }
}
