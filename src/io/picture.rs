//! Grey pictures, PNG.

use std::io::Cursor;

use png::{ColorType, Decoder, Limits, Transformations};

/// The brightness of every pixel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyPicture {
    /// Pixels in a row.
    pub columns: usize,
    /// From 0 (black) to 1 (white), row after row from the top.
    pub levels: Vec<f64>,
}

/// Why a file is no grey picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// Not a PNG file, or a broken one.
    #[error("this is no PNG picture that can be read ({0}): export it as PNG")]
    Unreadable(String),
    /// Larger than any picture that makes sense here.
    #[error("the picture has {width} by {height} pixels: scale it down to {} million or fewer", MOST_PIXELS / 1_000_000)]
    TooLarge {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A pixel that is neither grey nor transparent.
    #[error(
        "a picture without grey: the pixel {column} from the left, {row} from the top is coloured; convert it to grey"
    )]
    Coloured {
        /// Counted from 1.
        column: usize,
        /// Counted from 1.
        row: usize,
    },
    /// All pixels are the same.
    #[error(
        "a picture without grey: all its pixels are equally bright, so that it says nothing; give one radius instead"
    )]
    Uniform,
}

/// Beyond this a picture would take memory and time, and tell no more.
const MOST_PIXELS: u64 = 100_000_000;

/// How far the channels of a grey pixel may be apart, of 255: pictures that were converted round differently.
const GREY: u16 = 2;

impl GreyPicture {
    /// Reads a PNG file of any kind whose pixels are grey; what is transparent lies on white.
    ///
    /// # Errors
    /// Where the file is no picture, is coloured, or of one brightness all over.
    pub fn read(bytes: &[u8]) -> Result<GreyPicture, PictureError> {
        let unreadable = |e: png::DecodingError| PictureError::Unreadable(e.to_string());
        let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 8 * MOST_PIXELS as usize });
        decoder.set_transformations(Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(unreadable)?;
        let (width, height) = (reader.info().width, reader.info().height);
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(PictureError::TooLarge { width, height });
        }
        let size = reader.output_buffer_size().ok_or(PictureError::TooLarge { width, height })?;
        let mut buffer = vec![0; size];
        let frame = reader.next_frame(&mut buffer).map_err(unreadable)?;
        let is_wide = frame.bit_depth == png::BitDepth::Sixteen;
        let (channels, has_opacity) = match frame.color_type {
            ColorType::Grayscale => (1, false),
            ColorType::GrayscaleAlpha => (2, true),
            ColorType::Rgb => (3, false),
            // Palettes are expanded.
            ColorType::Rgba | ColorType::Indexed => (4, true),
        };
        let columns = width as usize;
        let step = channels * if is_wide { 2 } else { 1 };
        let mut levels = Vec::with_capacity(columns * height as usize);
        for (k, pixel) in buffer.chunks_exact(step).enumerate() {
            let value = |i: usize| match is_wide {
                true => u16::from_be_bytes([pixel[2 * i], pixel[2 * i + 1]]),
                false => u16::from(pixel[i]) * 257,
            };
            let opacity = if has_opacity { f64::from(value(channels - 1)) / 65_535.0 } else { 1.0 };
            let colors = channels - usize::from(has_opacity);
            let (low, high) = (0..colors).map(value).fold((u16::MAX, 0), |(l, h), v| (l.min(v), h.max(v)));
            if f64::from(high - low) * opacity > f64::from(GREY * 257) {
                return Err(PictureError::Coloured { column: k % columns + 1, row: k / columns + 1 });
            }
            // Of a grey pixel the middle channel.
            let level = f64::from(value(colors / 2)) / 65_535.0;
            levels.push(opacity * level + (1.0 - opacity));
        }
        if levels.windows(2).all(|pair| pair[0] == pair[1]) {
            return Err(PictureError::Uniform);
        }
        Ok(GreyPicture { columns, levels })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use png::{BitDepth, Encoder};

    fn file(width: u32, color: ColorType, depth: BitDepth, data: &[u8], palette: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let samples = color.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 };
        let height = (data.len() / samples) as u32 / width;
        let mut encoder = Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if !palette.is_empty() {
            encoder.set_palette(palette.to_vec());
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn levels(bytes: &[u8]) -> Vec<f64> {
        let picture = GreyPicture::read(bytes).unwrap();
        assert_eq!(picture.columns, 2);
        picture.levels
    }

    #[test]
    fn grey_is_read_from_every_kind_of_picture() {
        let eight = BitDepth::Eight;
        let expected = [0.0, 1.0, 0.2, 0.6];
        assert_eq!(levels(&file(2, ColorType::Grayscale, eight, &[0, 255, 51, 153], &[])), expected);
        let alpha = [0, 255, 255, 255, 51, 255, 153, 255];
        assert_eq!(levels(&file(2, ColorType::GrayscaleAlpha, eight, &alpha, &[])), expected);
        let rgb =
            [0, 0, 0, 255, 255, 255, 51, 51, 51, 153, 152, 154].map(|x: u8| if x == 152 || x == 154 { 153 } else { x });
        assert_eq!(levels(&file(2, ColorType::Rgb, eight, &rgb, &[])), expected);
        let palette = [0, 0, 0, 255, 255, 255, 51, 51, 51, 153, 153, 153];
        assert_eq!(levels(&file(2, ColorType::Indexed, eight, &[0, 1, 2, 3], &palette)), expected);
        let wide = [0u8, 0, 255, 255, 0x33, 0x33, 0x80, 0];
        let read = levels(&file(2, ColorType::Grayscale, BitDepth::Sixteen, &wide, &[]));
        assert_eq!(read, [0.0, 1.0, 0.2, f64::from(0x8000) / 65_535.0], "all sixteen bits count");
        // What is transparent lies on white.
        let clear = [0, 0, 0, 255, 90, 0, 0, 51];
        assert_eq!(levels(&file(2, ColorType::GrayscaleAlpha, eight, &clear, &[])), [1.0, 0.0, 1.0, 0.8]);
    }

    #[test]
    fn pictures_without_grey_are_refused() {
        let eight = BitDepth::Eight;
        let rgb = |data: &[u8]| GreyPicture::read(&file(2, ColorType::Rgb, eight, data, &[]));
        assert_eq!(rgb(&[0, 0, 0, 9, 9, 9, 3, 3, 3, 200, 10, 10]), Err(PictureError::Coloured { column: 2, row: 2 }));
        assert!(rgb(&[0, 0, 0, 9, 10, 11, 3, 3, 3, 1, 1, 1]).is_ok(), "grey but for rounding");
        assert_eq!(rgb(&[7; 12]), Err(PictureError::Uniform));
        assert!(matches!(GreyPicture::read(b"<svg/>"), Err(PictureError::Unreadable(_))));
        assert!(matches!(GreyPicture::read(b""), Err(PictureError::Unreadable(_))));
        let whole = file(2, ColorType::Grayscale, eight, &[0, 255, 51, 153], &[]);
        for length in 0..whole.len() {
            // The end mark alone may be missing.
            assert!(GreyPicture::read(&whole[..length]).is_err() || length > whole.len() - 13, "{length}");
        }
    }
}
