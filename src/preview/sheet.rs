//! How a picture is laid out: the drawing above, the scale bar and the legend below.

use super::PreviewError;
use super::canvas::{Canvas, Rgba, View, text_width};
use super::palette;
use crate::plane::{Bounds, Point};

/// One entry of the legend.
pub(super) struct Entry {
    pub(super) sample: Sample,
    pub(super) text: String,
}

/// What stands before the text of an entry.
pub(super) enum Sample {
    /// A filled box; with its hatching.
    Fill(Rgba, Option<Rgba>),
    /// A line.
    Line(Rgba, f64),
    /// A dashed line.
    Dashed(Rgba),
    /// A dot.
    Dot(Rgba),
    /// A circle.
    Ring(Rgba),
    /// A circle with a cross in it.
    Target(Rgba),
    /// A band of colours from left to right.
    Ramp(Vec<Rgba>),
    /// Nothing: words alone.
    None,
}

/// A picture in the making.
pub(super) struct Sheet {
    pub(super) canvas: Canvas,
    pub(super) view: View,
    /// Pixels that a line of ordinary width takes: all widths are multiples of it.
    pub(super) unit: f64,
    margin: f64,
    text_height: f64,
    footer_top: f64,
    rows: Vec<Vec<Entry>>,
}

/// Long side of a picture in pixels, unless told otherwise.
pub const DEFAULT_SIZE: u32 = 1600;

/// The short side is at least this much of the long one, so that the legend has room.
const SHORTEST_SIDE: f64 = 0.5;

/// Length of the scale bar at most, as a fraction of the width.
const SCALE_BAR: f64 = 0.2;

impl Sheet {
    /// A sheet for `bounds` with its legend, `size` pixels on its long side.
    pub(super) fn new(bounds: &Bounds, size: u32, entries: Vec<Entry>) -> Result<Sheet, PreviewError> {
        let is_finite = bounds.min.coords.iter().chain(bounds.max.coords.iter()).all(|x| x.is_finite());
        if bounds.is_empty() || !is_finite || bounds.diagonal() <= 0.0 {
            return Err(PreviewError::Nothing);
        }
        if !(64..=16_384).contains(&size) {
            return Err(PreviewError::Size { width: size, height: size });
        }
        let long = f64::from(size);
        let text_height = (0.0095 * long).max(6.0);
        let margin = 0.035 * long;
        let (w, h) = (bounds.width().max(1e-3 * bounds.height()), bounds.height().max(1e-3 * bounds.width()));
        // The footer depends on the width, which depends on the footer where the picture is tall: two rounds settle it.
        let mut width = long;
        let mut rows = Vec::new();
        let mut entries = entries;
        let mut height = long;
        let mut footer = 0.0;
        let mut scale = 1.0;
        for _ in 0..3 {
            let all: Vec<Entry> = rows.drain(..).flatten().chain(entries.drain(..)).collect();
            rows = wrap(all, width - 2.0 * margin, text_height);
            footer = margin * 1.6 + (rows.len() as f64 + 1.0) * text_height * ROW;
            scale = (long - 2.0 * margin) / w;
            if scale * h + 2.0 * margin + footer <= long {
                width = long;
                height = (scale * h + 2.0 * margin + footer).max(SHORTEST_SIDE * long);
            } else {
                scale = scale.min((long - 2.0 * margin - footer) / h);
                height = long;
                width = (scale * w + 2.0 * margin).max(SHORTEST_SIDE * long);
            }
        }
        let plot = [width - 2.0 * margin, height - footer - 2.0 * margin];
        let view = View::fit(bounds, Point::new(margin, margin), plot, scale);
        let canvas = Canvas::new(width, height)?;
        let footer_top = height - footer;
        Ok(Sheet { canvas, view, unit: long / 1000.0, margin, text_height, footer_top, rows })
    }

    /// Draws the footer and gives the file.
    pub(super) fn finish(mut self, unit_name: &str) -> Result<Vec<u8>, PreviewError> {
        let (width, height) = (self.canvas.width(), self.canvas.height());
        // Nothing of the drawing (rapids may leave it) shows under the legend.
        let top = Point::new(0.0, self.footer_top);
        self.canvas.rectangle(top, [width, height - self.footer_top], palette::WHITE);
        let rule = |x: f64| Point::new(x, self.footer_top);
        let (left, right) = (rule(self.margin), rule(width - self.margin));
        self.canvas.line(left, right, palette::RULE, self.unit, None);
        let row_height = self.text_height * ROW;
        let mut y = self.footer_top + 0.5 * self.margin + row_height;
        self.scale_bar(y, unit_name);
        y += 0.6 * self.margin;
        for row in std::mem::take(&mut self.rows) {
            y += row_height;
            let mut x = self.margin;
            for entry in row {
                x += self.entry(&entry, Point::new(x, y));
            }
        }
        self.canvas.into_png()
    }

    fn scale_bar(&mut self, y: f64, unit_name: &str) {
        let length = round_below(SCALE_BAR * self.canvas.width() / self.view.scale);
        let pixels = length * self.view.scale;
        let (a, b) = (Point::new(self.margin, y), Point::new(self.margin + pixels, y));
        let weight = 1.6 * self.unit;
        let tick = 0.5 * self.text_height;
        self.canvas.line(a, b, palette::INK, weight, None);
        for (k, size) in [(0.0, 1.0), (0.25, 0.5), (0.5, 0.7), (0.75, 0.5), (1.0, 1.0)] {
            let x = a.x + k * pixels;
            let up = Point::new(x, y - tick * size);
            self.canvas.line(Point::new(x, y), up, palette::INK, weight, None);
        }
        let text = format!("{length} {unit_name}");
        let at = Point::new(b.x + self.text_height, y);
        self.canvas.text(text.trim_end(), at, self.text_height, palette::INK);
    }

    /// Draws an entry with its baseline at `at`; the width it takes.
    fn entry(&mut self, entry: &Entry, at: Point) -> f64 {
        let h = self.text_height;
        let (w, sample_height) = (sample_width(&entry.sample, h), 1.3 * h);
        let top = Point::new(at.x, at.y - h - 0.15 * h);
        let middle = top.y + 0.5 * sample_height;
        let (left, right) = (Point::new(at.x, middle), Point::new(at.x + w, middle));
        match &entry.sample {
            Sample::Fill(color, hatching) => {
                self.canvas.rectangle(top, [w, sample_height], *color);
                if let Some(line) = hatching {
                    for k in 0..3 {
                        let x = at.x + w * (0.2 + 0.3 * f64::from(k));
                        let (a, b) = (Point::new(x + 0.3 * h, top.y), Point::new(x - 0.3 * h, top.y + sample_height));
                        self.canvas.line(a, b, *line, self.unit, None);
                    }
                }
            }
            Sample::Line(color, weight) => self.canvas.line(left, right, *color, *weight, None),
            Sample::Dashed(color) => {
                self.canvas.line(left, right, *color, self.unit, Some([4.0 * self.unit, 3.0 * self.unit]));
            }
            Sample::Dot(color) => {
                self.canvas.disk(Point::new(at.x + 0.5 * w, middle), 0.5 * h, *color);
            }
            Sample::Ring(color) => {
                self.canvas.circle(Point::new(at.x + 0.5 * h, middle), 0.6 * h, *color, 1.2 * self.unit);
            }
            Sample::Target(color) => {
                self.canvas.target(Point::new(at.x + 0.5 * w, middle), 0.5 * h, *color, 1.4 * self.unit);
            }
            Sample::Ramp(colors) => {
                let step = w / colors.len().max(1) as f64;
                for (k, color) in colors.iter().enumerate() {
                    let corner = Point::new(at.x + step * k as f64, top.y + 0.25 * sample_height);
                    self.canvas.rectangle(corner, [step + 0.5, 0.5 * sample_height], *color);
                }
            }
            Sample::None => {}
        }
        let text_at = Point::new(at.x + w + if w > 0.0 { 0.7 * h } else { 0.0 }, at.y);
        self.canvas.text(&entry.text, text_at, h, palette::INK);
        entry_width(entry, h)
    }
}

/// Distance of baselines in heights of digits.
const ROW: f64 = 2.3;

fn sample_width(sample: &Sample, text_height: f64) -> f64 {
    match sample {
        Sample::None => 0.0,
        Sample::Dot(_) | Sample::Ring(_) => text_height,
        Sample::Target(_) => 1.6 * text_height,
        Sample::Ramp(_) => 5.0 * text_height,
        _ => 2.4 * text_height,
    }
}

/// The width of an entry with the room after it.
fn entry_width(entry: &Entry, text_height: f64) -> f64 {
    let sample = sample_width(&entry.sample, text_height);
    let gap = if sample > 0.0 { 0.7 * text_height } else { 0.0 };
    sample + gap + text_width(&entry.text, text_height) + 2.2 * text_height
}

fn wrap(entries: Vec<Entry>, width: f64, text_height: f64) -> Vec<Vec<Entry>> {
    let mut rows: Vec<Vec<Entry>> = vec![Vec::new()];
    let mut x = 0.0;
    for entry in entries {
        let w = entry_width(&entry, text_height);
        if x + w > width && x > 0.0 {
            rows.push(Vec::new());
            x = 0.0;
        }
        x += w;
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

/// The largest of 1, 2, 5 times a power of ten that is not above `x`.
fn round_below(x: f64) -> f64 {
    // Digits are made from whole exponents, so that 0.2 reads "0.2".
    let exponent = x.log10().floor() as i32;
    let best = [5.0, 2.0, 1.0].into_iter().map(|m| scaled(m, exponent)).find(|&l| l <= x);
    best.unwrap_or_else(|| scaled(1.0, exponent))
}

fn scaled(mantissa: f64, exponent: i32) -> f64 {
    if exponent >= 0 { mantissa * 10f64.powi(exponent) } else { mantissa / 10f64.powi(-exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_are_round() {
        for (x, expected) in [(57.0, 50.0), (49.0, 20.0), (19.9, 10.0), (1.0, 1.0), (0.3, 0.2), (0.09, 0.05)] {
            assert_eq!(round_below(x), expected, "{x}");
        }
    }
}
