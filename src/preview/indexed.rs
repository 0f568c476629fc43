//! Pictures with a palette: a third of the bytes of full colour, which drawings in few colours do not need.

use std::collections::{BTreeMap, HashMap};

use png::{BitDepth, ColorType, Compression, Filter};

use super::PreviewError;
use super::canvas::Canvas;

/// A colour without opacity.
type Rgb = [u8; 3];

/// Colours that a palette has at most.
const MOST_COLORS: usize = 256;

/// How often colours are found in pictures.
#[derive(Default)]
pub(super) struct Census {
    counts: BTreeMap<Rgb, u64>,
}

/// Colours by number.
pub(super) struct Palette {
    colors: Vec<Rgb>,
    /// The number of the colour that stands for all that agree in so many leading bits.
    numbers: HashMap<Rgb, u8>,
    bits: u32,
}

fn leading(color: Rgb, bits: u32) -> Rgb {
    color.map(|c| c >> (8 - bits))
}

/// The pixels in runs of one colour, row after row.
fn runs(canvas: &Canvas) -> impl Iterator<Item = (Rgb, usize)> + '_ {
    let pixels = canvas.pixels();
    pixels.chunk_by(|a, b| a == b).map(|run| ([run[0].red(), run[0].green(), run[0].blue()], run.len()))
}

impl Census {
    /// Counts the pixels of one more picture.
    pub(super) fn add(&mut self, canvas: &Canvas) {
        for (color, length) in runs(canvas) {
            *self.counts.entry(color).or_default() += length as u64;
        }
    }

    /// The palette: exact where the colours are few; else colours of equal leading bits are one, the most frequent of
    /// them, so that areas keep their colours and only the soft edges between them are coarser.
    pub(super) fn palette(&self) -> Palette {
        let buckets = |bits: u32| {
            let mut best: BTreeMap<Rgb, (u64, Rgb)> = BTreeMap::new();
            for (&color, &count) in &self.counts {
                let entry = best.entry(leading(color, bits)).or_insert((count, color));
                if count > entry.0 {
                    *entry = (count, color);
                }
            }
            best
        };
        // At two bits there are no more than 64.
        let (bits, best) =
            (3..=8).rev().map(|b| (b, buckets(b))).find(|(_, b)| b.len() <= MOST_COLORS).unwrap_or((2, buckets(2)));
        let numbers = best.keys().zip(0u8..=255).map(|(&key, number)| (key, number)).collect();
        Palette { colors: best.values().map(|&(_, color)| color).collect(), numbers, bits }
    }
}

impl Palette {
    /// The colour of every pixel by its number, row after row. The canvas has been counted before.
    pub(super) fn index(&self, canvas: &Canvas) -> Vec<u8> {
        let mut indices = Vec::with_capacity(canvas.pixels().len());
        for (color, length) in runs(canvas) {
            let number = self.numbers.get(&leading(color, self.bits)).copied().unwrap_or(0);
            indices.resize(indices.len() + length, number);
        }
        indices
    }

    /// A file that is to hold pictures of `width` by `height` pixels with this palette.
    pub(super) fn encoder<'a>(
        &self,
        file: &'a mut Vec<u8>,
        width: u32,
        height: u32,
    ) -> png::Encoder<'a, &'a mut Vec<u8>> {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(self.colors.concat());
        encoder.set_compression(Compression::High);
        // Numbers of colours are no brightness that a filter could foretell.
        encoder.set_filter(Filter::NoFilter);
        encoder
    }
}

/// The picture as a PNG file with a palette.
pub(super) fn encode(canvas: &Canvas) -> Result<Vec<u8>, PreviewError> {
    let mut census = Census::default();
    census.add(canvas);
    let palette = census.palette();
    let mut file = Vec::new();
    let encoder = palette.encoder(&mut file, canvas.width() as u32, canvas.height() as u32);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&palette.index(canvas)).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(file)
}

/// Files in memory are always written; an error is told all the same.
pub(super) fn failed(error: png::EncodingError) -> PreviewError {
    PreviewError::Encoding(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Point;

    fn decode(png: &[u8]) -> Vec<Rgb> {
        let picture = tiny_skia::Pixmap::decode_png(png).unwrap();
        picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect()
    }

    #[test]
    fn few_colours_are_kept_exactly() {
        let mut canvas = Canvas::new(40.0, 20.0).unwrap();
        canvas.rectangle(Point::new(3.0, 4.0), [20.0, 10.0], [1, 2, 3, 255]);
        canvas.disk(Point::new(30.0, 10.0), 6.5, [200, 30, 90, 255]);
        let expected: Vec<Rgb> = canvas.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
        assert!(expected.contains(&[1, 2, 3]) && expected.contains(&[200, 30, 90]));
        assert_eq!(decode(&encode(&canvas).unwrap()), expected);
    }

    #[test]
    fn of_many_colours_the_frequent_ones_are_exact_and_the_others_near() {
        let mut canvas = Canvas::new(64.0, 64.0).unwrap();
        for k in 0..1024_u32 {
            let color = [(k % 32 * 8) as u8, (k / 32 * 8) as u8, (k % 7 * 30) as u8, 255];
            canvas.rectangle(Point::new(f64::from(k % 32), f64::from(k / 32)), [1.0, 1.0], color);
        }
        canvas.rectangle(Point::new(0.0, 40.0), [64.0, 24.0], [33, 77, 131, 255]);
        let expected: Vec<Rgb> = canvas.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
        let found = decode(&encode(&canvas).unwrap());
        assert_eq!(found[50 * 64 + 20], [33, 77, 131]);
        assert_eq!(found[33 * 64 + 60], [255, 255, 255]);
        for (a, b) in expected.iter().zip(&found) {
            let off = a.iter().zip(b).map(|(x, y)| x.abs_diff(*y)).max().unwrap();
            assert!(off < 64, "{a:?} became {b:?}");
        }
    }
}
