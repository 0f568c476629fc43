//! A sheet of pixels with a view on the plane.

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, PremultipliedColorU8, Stroke,
    StrokeDash, Transform,
};

use super::PreviewError;
use super::lettering;
use crate::plane::{Bounds, Point, Region, Segment};

/// Chords stay within this of arcs, in pixels.
const FLATTENING: f64 = 0.08;

/// A colour, red, green, blue and opacity from 0 to 255.
pub(super) type Rgba = [u8; 4];

/// Places in the picture in pixels, from the upper left corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Pixels in a millimetre (or in the unit of the region).
    pub(super) scale: f64,
    /// Where the origin of the plane is.
    pub(super) origin: Point,
}

impl View {
    /// The view that shows `bounds` in the middle of the box from `corner` with `size`, in pixels.
    pub(super) fn fit(bounds: &Bounds, corner: Point, size: [f64; 2], scale: f64) -> View {
        let center = bounds.center();
        let middle = Point::new(corner.x + 0.5 * size[0], corner.y + 0.5 * size[1]);
        View { scale, origin: Point::new(middle.x - scale * center.x, middle.y + scale * center.y) }
    }

    pub(super) fn pixel(&self, p: Point) -> Point {
        Point::new(self.origin.x + self.scale * p.x, self.origin.y - self.scale * p.y)
    }

    /// The place of the plane that a pixel shows: the other way round.
    pub(super) fn place(&self, pixel: Point) -> Point {
        Point::new((pixel.x - self.origin.x) / self.scale, (self.origin.y - pixel.y) / self.scale)
    }

    /// Points of `element` after its start, in pixels.
    fn trace(&self, element: &Segment, mut emit: impl FnMut(Point)) {
        element.flatten(FLATTENING / self.scale, |p| emit(self.pixel(p)));
    }

    /// The outline of a region, in pixels.
    pub(super) fn region(&self, region: &Region) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for ring in &region.rings {
            let Some(first) = ring.vertices.first() else { continue };
            move_to(&mut builder, self.pixel(first.point));
            for element in ring.segments() {
                self.trace(&element, |p| line_to(&mut builder, p));
            }
            builder.close();
        }
        builder.finish()
    }

    /// Elements as lines, joined where they follow each other, in pixels; in paths of not much more than [`MOST_POINTS`].
    pub(super) fn elements(&self, elements: impl IntoIterator<Item = Segment>) -> Vec<Path> {
        let mut paths = Vec::new();
        let mut builder = PathBuilder::new();
        let mut end: Option<Point> = None;
        for element in elements {
            if builder.len() > MOST_POINTS {
                paths.extend(std::mem::replace(&mut builder, PathBuilder::new()).finish());
                end = None;
            }
            if end != Some(element.start) {
                move_to(&mut builder, self.pixel(element.start));
            }
            self.trace(&element, |p| line_to(&mut builder, p));
            end = Some(element.end);
        }
        paths.extend(builder.finish());
        paths
    }

    /// Closed polygons, in pixels.
    pub(super) fn polygons<'a>(&self, polygons: impl IntoIterator<Item = &'a Vec<Point>>) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for polygon in polygons {
            for (i, p) in polygon.iter().enumerate() {
                let q = self.pixel(*p);
                if i == 0 { move_to(&mut builder, q) } else { line_to(&mut builder, q) }
            }
            builder.close();
        }
        builder.finish()
    }
}

/// Lines are stroked in paths of about so many points: the outline of a stroke takes hundreds of bytes for each, and filling
/// it takes time with the square of the lines that cross a row of pixels.
const MOST_POINTS: usize = 1 << 12;

/// Far outside of any picture: keeps `f32` from overflowing.
const FAR: f64 = 1e6;

fn move_to(builder: &mut PathBuilder, p: Point) {
    builder.move_to(p.x.clamp(-FAR, FAR) as f32, p.y.clamp(-FAR, FAR) as f32);
}

fn line_to(builder: &mut PathBuilder, p: Point) {
    builder.line_to(p.x.clamp(-FAR, FAR) as f32, p.y.clamp(-FAR, FAR) as f32);
}

/// The sheet.
pub(super) struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// A white sheet.
    pub(super) fn new(width: f64, height: f64) -> Result<Canvas, PreviewError> {
        let (w, h) = (width.ceil() as u32, height.ceil() as u32);
        let mut pixmap = Pixmap::new(w, h).ok_or(PreviewError::Size { width: w, height: h })?;
        pixmap.fill(Color::WHITE);
        Ok(Canvas { pixmap })
    }

    pub(super) fn width(&self) -> f64 {
        f64::from(self.pixmap.width())
    }

    pub(super) fn height(&self) -> f64 {
        f64::from(self.pixmap.height())
    }

    pub(super) fn fill(&mut self, path: Option<&Path>, color: Rgba, mask: Option<&Mask>) {
        if let Some(path) = path {
            let paint = Paint { anti_alias: !is_dense(path), ..paint(color) };
            self.pixmap.fill_path(path, &paint, FillRule::Winding, Transform::identity(), mask);
        }
    }

    pub(super) fn stroke<'a>(
        &mut self,
        paths: impl IntoIterator<Item = &'a Path>,
        color: Rgba,
        width: f64,
        mask: Option<&Mask>,
    ) {
        self.stroke_dashed(paths, color, width, None, mask);
    }

    pub(super) fn stroke_dashed<'a>(
        &mut self,
        paths: impl IntoIterator<Item = &'a Path>,
        color: Rgba,
        width: f64,
        dash: Option<[f64; 2]>,
        mask: Option<&Mask>,
    ) {
        let stroke = Stroke {
            width: width as f32,
            line_cap: if dash.is_some() { LineCap::Butt } else { LineCap::Round },
            line_join: LineJoin::Round,
            dash: dash.and_then(|d| StrokeDash::new(d.map(|x| x as f32).to_vec(), 0.0)),
            ..Stroke::default()
        };
        for path in paths {
            let paint = Paint { anti_alias: !is_dense(path), ..paint(color) };
            self.pixmap.stroke_path(path, &paint, &stroke, Transform::identity(), mask);
        }
    }

    /// Limits drawing to the inside of `path`.
    pub(super) fn mask(&self, path: Option<&Path>) -> Option<Mask> {
        let mut mask = Mask::new(self.pixmap.width(), self.pixmap.height())?;
        mask.fill_path(path?, FillRule::Winding, true, Transform::identity());
        Some(mask)
    }

    pub(super) fn rectangle(&mut self, corner: Point, size: [f64; 2], color: Rgba) {
        let rect = tiny_skia::Rect::from_xywh(corner.x as f32, corner.y as f32, size[0] as f32, size[1] as f32);
        if let Some(rect) = rect {
            self.pixmap.fill_rect(rect, &paint(color), Transform::identity(), None);
        }
    }

    pub(super) fn disk(&mut self, center: Point, radius: f64, color: Rgba) {
        let circle = PathBuilder::from_circle(center.x as f32, center.y as f32, radius as f32);
        self.fill(circle.as_ref(), color, None);
    }

    pub(super) fn circle(&mut self, center: Point, radius: f64, color: Rgba, width: f64) {
        let circle = PathBuilder::from_circle(center.x as f32, center.y as f32, radius as f32);
        self.stroke(circle.as_ref(), color, width, None);
    }

    /// A circle with a cross that sticks out of it.
    pub(super) fn target(&mut self, center: Point, radius: f64, color: Rgba, width: f64) {
        let arm = 1.6 * radius;
        self.circle(center, radius, color, width);
        for (dx, dy) in [(arm, 0.0), (0.0, arm)] {
            let end = |sign: f64| Point::new(center.x + sign * dx, center.y + sign * dy);
            self.line(end(-1.0), end(1.0), color, width, None);
        }
    }

    pub(super) fn line(&mut self, from: Point, to: Point, color: Rgba, width: f64, dash: Option<[f64; 2]>) {
        let mut builder = PathBuilder::new();
        move_to(&mut builder, from);
        line_to(&mut builder, to);
        self.stroke_dashed(builder.finish().as_ref(), color, width, dash, None);
    }

    /// Colours the pixels whose middles `color` has one for; it is asked with their places in the view.
    pub(super) fn shade(&mut self, view: &View, color: impl Fn(Point) -> Option<[u8; 3]>) {
        let width = self.pixmap.width() as usize;
        for (index, pixel) in self.pixmap.pixels_mut().iter_mut().enumerate() {
            let middle = Point::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5);
            if let Some([r, g, b]) = color(view.place(middle)) {
                *pixel = tiny_skia::ColorU8::from_rgba(r, g, b, 255).premultiply();
            }
        }
    }

    /// Diagonal lines over the whole sheet, within `mask`.
    pub(super) fn hatch(&mut self, color: Rgba, spacing: f64, width: f64, mask: Option<&Mask>) {
        let mut builder = PathBuilder::new();
        let (w, h) = (self.width(), self.height());
        for k in 0..((w + h) / spacing).ceil() as usize {
            let x = k as f64 * spacing;
            move_to(&mut builder, Point::new(x, 0.0));
            line_to(&mut builder, Point::new(x - h, h));
        }
        self.stroke(builder.finish().as_ref(), color, width, mask);
    }

    /// Writes `text` with its baseline starting at `at`; `height` is that of digits. Returns the width.
    pub(super) fn text(&mut self, text: &str, at: Point, height: f64, color: Rgba) -> f64 {
        let unit = height / lettering::CAP_HEIGHT;
        let (lines, width) = lettering::layout(text);
        let mut builder = PathBuilder::new();
        for line in lines {
            for (i, p) in line.iter().enumerate() {
                let q = Point::new(at.x + unit * p.x, at.y - unit * p.y);
                if i == 0 { move_to(&mut builder, q) } else { line_to(&mut builder, q) }
            }
        }
        self.stroke(builder.finish().as_ref(), color, TEXT_WEIGHT * height, None);
        unit * width
    }

    /// The pixels, row after row from the top; all are opaque.
    pub(super) fn pixels(&self) -> &[PremultipliedColorU8] {
        self.pixmap.pixels()
    }

    /// The picture as a PNG file.
    pub(super) fn into_png(self) -> Result<Vec<u8>, PreviewError> {
        self.pixmap.encode_png().map_err(|e| PreviewError::Encoding(e.to_string()))
    }
}

/// Rows of pixels crossed by all lines of a path, beyond which its edges are not smoothed: smoothing takes time for each of
/// them, and in such a thicket nothing of it is seen.
const DENSE: f64 = 4e6;

fn is_dense(path: &Path) -> bool {
    let heights = path.points().windows(2).map(|w| f64::from((w[1].y - w[0].y).abs()));
    heights.sum::<f64>() > DENSE
}

/// Width of the strokes of letters as a fraction of their height.
const TEXT_WEIGHT: f64 = 0.12;

/// The width that [`Canvas::text`] will take.
pub(super) fn text_width(text: &str, height: f64) -> f64 {
    lettering::layout(text).1 * height / lettering::CAP_HEIGHT
}

fn paint(color: Rgba) -> Paint<'static> {
    let [r, g, b, a] = color;
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, a);
    paint
}
