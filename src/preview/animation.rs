//! States of a drawing as an animated PNG.

use super::PreviewError;
use super::canvas::{Canvas, View};
use super::indexed::{Census, failed};
use super::palette;
use super::state::Before;
use crate::plane::{Point, Region};

/// One picture of an animation.
#[derive(Clone, Debug)]
pub struct Picture<'a> {
    /// What stands below it, as in a [`Cell`](super::Cell).
    pub caption: String,
    /// The state.
    pub region: &'a Region,
    /// For how long it is shown, in seconds, from 0 to 60.
    pub seconds: f64,
}

/// Sizes as fractions of the long side.
const MARGIN: f64 = 0.03;
const CAPTION: f64 = 0.014;
const WEIGHT: f64 = 0.0015;

/// Delays are written in these parts of a second.
const TICKS: u16 = 100;

/// The animation of `pictures`, each against `before`, `size` pixels on its long side; it starts again for ever.
///
/// The file is a PNG of the last state to whoever does not know animations. What does not change from one picture to the
/// next is not repeated.
///
/// # Errors
/// Where there is nothing to draw, or the size is absurd.
pub fn animation(before: &Region, pictures: &[Picture], size: u32) -> Result<Vec<u8>, PreviewError> {
    let stage = Stage::new(before, pictures, size)?;
    // The palette must be known before the first picture is written, and pictures are too large to keep all of them.
    let mut census = Census::default();
    for picture in pictures {
        census.add(&stage.draw(picture)?);
    }
    let palette = census.palette();
    let index = |picture: &Picture| Ok::<_, PreviewError>(palette.index(&stage.draw(picture)?));
    let [width, height] = stage.pixels;

    let mut shown: Vec<(Vec<u8>, Window, f64)> = Vec::new();
    let mut last: Vec<u8> = Vec::new();
    for picture in pictures {
        let pixels = index(picture)?;
        match (Window::of_changes(&last, &pixels, width, height), shown.last_mut()) {
            // It looks the same: shown for longer.
            (None, Some((.., seconds))) => *seconds += picture.seconds,
            (window, _) => {
                let window = window.unwrap_or(Window::all(width, height));
                shown.push((window.cut(&pixels, width), window, picture.seconds));
            }
        }
        last = pixels;
    }

    let mut file = Vec::new();
    let mut encoder = palette.encoder(&mut file, width, height);
    let is_animated = shown.len() > 1;
    if is_animated {
        encoder.set_animated(shown.len() as u32, 0).map_err(failed)?;
        encoder.set_sep_def_img(true).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&last).map_err(failed)?;
    for (pixels, window, seconds) in shown.iter().filter(|_| is_animated) {
        let ticks = (seconds * f64::from(TICKS)).round() as u16;
        writer.set_frame_delay(ticks, TICKS).map_err(failed)?;
        // Neither place nor size may leave the picture with what was set before.
        writer.reset_frame_position().map_err(failed)?;
        writer.set_frame_dimension(window.width, window.height).map_err(failed)?;
        writer.set_frame_position(window.x, window.y).map_err(failed)?;
        writer.write_image_data(pixels).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(file)
}

/// What all pictures have in common.
struct Stage<'a> {
    before: Before<'a>,
    view: View,
    size: [f64; 2],
    pixels: [u32; 2],
    margin: f64,
    caption: f64,
    weight: f64,
}

impl Stage<'_> {
    fn new<'a>(before: &'a Region, pictures: &[Picture], size: u32) -> Result<Stage<'a>, PreviewError> {
        let before = Before::new(before);
        let bounds = pictures.iter().fold(before.bounds(), |b, p| b.union(p.region.bounds()));
        let is_finite = bounds.min.coords.iter().chain(bounds.max.coords.iter()).all(|x| x.is_finite());
        if pictures.is_empty() || bounds.is_empty() || !is_finite || bounds.diagonal() <= 0.0 {
            return Err(PreviewError::Nothing);
        }
        if !(64..=16_384).contains(&size) {
            return Err(PreviewError::Size { width: size, height: size });
        }
        let long = f64::from(size);
        let (margin, caption) = (MARGIN * long, (CAPTION * long).max(6.0));
        let footer = 2.0 * caption;
        let room = [long - 2.0 * margin, long - 2.0 * margin - footer];
        let scale = (room[0] / bounds.width()).min(room[1] / bounds.height());
        let plot = [scale * bounds.width(), scale * bounds.height()].map(|side| side.max(0.1 * long));
        let size = [plot[0] + 2.0 * margin, plot[1] + 2.0 * margin + footer].map(f64::round);
        let view = View::fit(&bounds, Point::new(margin, margin), plot, scale);
        let pixels = size.map(|side| side as u32);
        Ok(Stage { before, view, size, pixels, margin, caption, weight: (WEIGHT * long).max(0.8) })
    }

    fn draw(&self, picture: &Picture) -> Result<Canvas, PreviewError> {
        let mut canvas = Canvas::new(self.size[0], self.size[1])?;
        self.before.draw(picture.region, &mut canvas, &self.view, self.weight);
        let at = Point::new(self.margin, self.size[1] - 0.8 * self.margin);
        canvas.text(&picture.caption, at, self.caption, palette::INK);
        Ok(canvas)
    }
}

/// A part of a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
}

impl Window {
    fn all(width: u32, height: u32) -> Window {
        Window { x: 0, y: 0, width, height }
    }

    /// The smallest window in which `b` differs from `a`; everything where `a` is no picture, none where they are equal.
    fn of_changes(a: &[u8], b: &[u8], width: u32, height: u32) -> Option<Window> {
        if a.len() != b.len() {
            return Some(Window::all(width, height));
        }
        let row = width as usize;
        let rows = || a.chunks(row).zip(b.chunks(row)).enumerate().filter(|(_, (a, b))| a != b);
        let (top, _) = rows().next()?;
        let bottom = rows().next_back()?.0;
        let columns = |(_, (a, b)): (usize, (&[u8], &[u8]))| {
            let differs = |(x, y): (&u8, &u8)| x != y;
            let left = a.iter().zip(b).position(differs).unwrap_or(0);
            let right = a.iter().zip(b).rposition(differs).unwrap_or(row - 1);
            (left, right)
        };
        let (left, right) =
            rows().map(columns).reduce(|(l, r), (left, right)| (l.min(left), r.max(right))).unwrap_or((0, row - 1));
        let size = |from: usize, to: usize| (to - from + 1) as u32;
        Some(Window { x: left as u32, y: top as u32, width: size(left, right), height: size(top, bottom) })
    }

    fn cut(&self, pixels: &[u8], width: u32) -> Vec<u8> {
        let rows = pixels.chunks(width as usize).skip(self.y as usize).take(self.height as usize);
        let columns = self.x as usize..(self.x + self.width) as usize;
        rows.flat_map(|row| &row[columns.clone()]).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn disk(radius: f64) -> Region {
        Region::new(vec![Ring::circle(Point::origin(), radius)])
    }

    fn pictures(regions: &[Region]) -> Vec<Picture<'_>> {
        regions.iter().map(|region| Picture { caption: "0.1 r²".to_owned(), region, seconds: 0.25 }).collect()
    }

    /// The frames as they are shown one after the other, by number of palette, with delays in seconds.
    fn play(png: &[u8]) -> Vec<(Vec<u8>, f64)> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let [width, height] = [reader.info().width, reader.info().height].map(|n| n as usize);
        let count = reader.info().animation_control().unwrap().num_frames;
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut buffer).unwrap();
        let mut shown = vec![0; width * height];
        let mut all = vec![(buffer.clone(), 0.0)];
        for _ in 0..count {
            reader.next_frame(&mut buffer).unwrap();
            let control = *reader.info().frame_control().unwrap();
            let (w, x) = (control.width as usize, control.x_offset as usize);
            for (k, row) in buffer.chunks(w).take(control.height as usize).enumerate() {
                let start = (control.y_offset as usize + k) * width + x;
                shown[start..start + w].copy_from_slice(row);
            }
            all.push((shown.clone(), f64::from(control.delay_num) / f64::from(control.delay_den)));
        }
        all
    }

    #[test]
    fn an_animation_plays_every_state_and_is_a_picture_of_the_last() {
        let states = [disk(5.0), disk(4.0), disk(4.0), disk(3.0)];
        let png = animation(&states[0], &pictures(&states), 200).unwrap();
        let played = play(&png);
        assert_eq!(played.len(), 4, "the default picture and three that differ");
        assert_eq!(played[0].0, played[3].0);
        assert_ne!(played[1].0, played[2].0);
        assert_eq!(played.iter().map(|p| p.1).collect::<Vec<_>>(), [0.0, 0.25, 0.5, 0.25]);
        let size = |regions: &[Region]| animation(&states[0], &pictures(regions), 200).unwrap().len();
        assert_eq!(size(&states[..1]), size(&[disk(5.0), disk(5.0)]), "without change there is one picture");
        let plain = tiny_skia::Pixmap::decode_png(&png).unwrap();
        let ratio = plain.pixels().iter().filter(|p| p.red() == palette::SOLID[0]).count() as f64;
        assert!(
            (ratio / (std::f64::consts::PI * (3.0_f64 * 188.0 / 10.0 * 0.88).powi(2)) - 1.0).abs() < 0.25,
            "{ratio}"
        );
    }

    #[test]
    fn windows_hold_what_changes() {
        let mut b = vec![0; 12];
        assert_eq!(Window::of_changes(&[0; 12], &b, 4, 3), None);
        b[5] = 1;
        b[10] = 1;
        let window = Window::of_changes(&[0; 12], &b, 4, 3).unwrap();
        assert_eq!(window, Window { x: 1, y: 1, width: 2, height: 2 });
        assert_eq!(window.cut(&b, 4), [1, 0, 0, 1]);
    }

    #[test]
    fn nothing_and_absurd_sizes_are_errors() {
        assert_eq!(animation(&disk(1.0), &[], 200), Err(PreviewError::Nothing));
        assert!(matches!(animation(&disk(1.0), &pictures(&[disk(1.0)]), 9), Err(PreviewError::Size { .. })));
        assert_eq!(animation(&Region::default(), &pictures(&[Region::default()]), 200), Err(PreviewError::Nothing));
    }
}
