//! A contact sheet: states of drawings side by side, each against what it was made from, with a caption.

use super::PreviewError;
use super::canvas::{Canvas, Rgba, View, text_width};
use super::indexed;
use super::palette;
use super::state::{Before, Changes};
use crate::plane::{Bounds, Point, Region};

/// One picture of a contact sheet.
#[derive(Clone, Debug)]
pub struct Cell<'a> {
    /// What stands below it, in small letters, digits and `.,:-+/()²`; other characters are blanks.
    pub caption: String,
    /// What the state was made from.
    pub before: &'a Region,
    /// The state.
    pub after: &'a Region,
}

/// Sizes as fractions of the width of the sheet.
const MARGIN: f64 = 0.025;
const GAP: f64 = 0.03;

/// Height of captions as a fraction of the width of a picture, and its limits as fractions of the width of the sheet: a
/// sheet of many pictures has to be read, one of a single picture not to shout.
const CAPTION: f64 = 0.032;
const SMALLEST_CAPTION: f64 = 0.0065;
const LARGEST_CAPTION: f64 = 0.0105;

/// Width over height that a sheet is brought near to by the number of columns.
const ASPECT: f64 = 1.6;

/// Lines of ordinary width as a fraction of the width of a picture, in pixels at least [`THINNEST`].
const WEIGHT: f64 = 0.0022;
const THINNEST: f64 = 0.8;

/// Pixels on either side at most.
const LARGEST_SIDE: f64 = 16_384.0;

/// The contact sheet of `cells`, as a PNG file `width` pixels wide. All are drawn to one scale, in so many `columns`, or as many
/// as look well.
///
/// # Errors
/// Where there is nothing to draw, or the size is absurd.
pub fn contact_sheet(cells: &[Cell], columns: Option<usize>, width: u32) -> Result<Vec<u8>, PreviewError> {
    let bounds: Vec<Bounds> = cells.iter().map(|c| c.before.bounds().union(c.after.bounds())).collect();
    let extent = bounds.iter().fold([0.0, 0.0], |[w, h], b| [b.width().max(w), b.height().max(h)]);
    let is_finite = |b: &Bounds| b.min.coords.iter().chain(b.max.coords.iter()).all(|x| x.is_finite());
    if extent == [0.0, 0.0] || !bounds.iter().all(|b| b.is_empty() || is_finite(b)) {
        return Err(PreviewError::Nothing);
    }
    if !(64.0..=LARGEST_SIDE).contains(&f64::from(width)) {
        return Err(PreviewError::Size { width, height: width });
    }
    let columns = columns.unwrap_or_else(|| best_columns(cells.len(), extent)).clamp(1, cells.len());
    let layout = Layout::new(f64::from(width), cells.len(), columns, extent);
    if layout.height > LARGEST_SIDE {
        return Err(PreviewError::Size { width, height: layout.height as u32 });
    }
    let mut canvas = Canvas::new(f64::from(width), layout.height)?;
    let mut changes = Changes::default();
    let mut before: Option<(&Region, Before)> = None;
    for (k, (cell, bounds)) in cells.iter().zip(&bounds).enumerate() {
        // States of one drawing follow each other, and its boundary is arranged once for all.
        let known = before.take().filter(|(region, _)| std::ptr::eq(*region, cell.before));
        let (_, before) = before.insert(known.unwrap_or_else(|| (cell.before, Before::new(cell.before))));
        let corner = layout.corner(k);
        if !bounds.is_empty() {
            let view = View::fit(bounds, corner, layout.picture, layout.scale);
            before.draw(cell.after, &mut canvas, &view, layout.weight);
            let found = before.changes(cell.after);
            changes.added |= found.added;
            changes.removed |= found.removed;
        }
        let x = corner.x + 0.5 * (layout.picture[0] - text_width(&cell.caption, layout.caption));
        let y = corner.y + layout.picture[1] + layout.caption_room - 0.4 * layout.caption;
        canvas.text(&cell.caption, Point::new(x.max(0.0), y), layout.caption, palette::INK);
    }
    layout.legend(&mut canvas, changes);
    indexed::encode(&canvas)
}

/// Where things stand, in pixels.
struct Layout {
    height: f64,
    columns: usize,
    picture: [f64; 2],
    scale: f64,
    caption: f64,
    /// Between the bottom of a picture and that of its caption.
    caption_room: f64,
    margin: f64,
    gap: f64,
    weight: f64,
}

impl Layout {
    fn new(width: f64, cells: usize, columns: usize, extent: [f64; 2]) -> Layout {
        let (margin, gap) = (MARGIN * width, GAP * width);
        let room = (width - 2.0 * margin - (columns - 1) as f64 * gap) / columns as f64;
        // A tall drawing does not need a sheet of which most is high and empty.
        let scale = (room / extent[0]).min(width / extent[1]);
        let picture = [room, scale * extent[1]];
        let caption = (CAPTION * room).clamp(SMALLEST_CAPTION * width, LARGEST_CAPTION * width).max(6.0);
        let caption_room = 2.6 * caption;
        let rows = cells.div_ceil(columns) as f64;
        let legend = 2.0 * margin;
        let height = margin + rows * (picture[1] + caption_room) + (rows - 1.0) * 0.6 * gap + legend;
        let weight = (WEIGHT * room).clamp(THINNEST, (0.001 * width).max(THINNEST));
        Layout { height, columns, picture, scale, caption, caption_room, margin, gap, weight }
    }

    /// The upper left corner of picture `k`.
    fn corner(&self, k: usize) -> Point {
        let (column, row) = ((k % self.columns) as f64, (k / self.columns) as f64);
        let x = self.margin + column * (self.picture[0] + self.gap);
        Point::new(x, self.margin + row * (self.picture[1] + self.caption_room + 0.6 * self.gap))
    }

    fn legend(&self, canvas: &mut Canvas, changes: Changes) {
        let h = self.caption;
        let y = self.height - 0.75 * self.margin;
        let mut x = self.margin;
        let mut entry = |draw: &dyn Fn(&mut Canvas, Point, Point), text: &str| {
            draw(canvas, Point::new(x, y - h), Point::new(x + 2.4 * h, y));
            x += 3.1 * h;
            x += canvas.text(text, Point::new(x, y), h, palette::INK) + 2.4 * h;
        };
        let weight = self.weight;
        let line = |color: Rgba, weight: f64| {
            move |canvas: &mut Canvas, a: Point, b: Point| {
                let y = 0.5 * (a.y + b.y);
                canvas.line(Point::new(a.x, y), Point::new(b.x, y), color, weight, None);
            }
        };
        let fill = |color: Rgba| {
            move |canvas: &mut Canvas, a: Point, b: Point| canvas.rectangle(a, [b.x - a.x, b.y - a.y], color)
        };
        if changes != Changes::default() {
            entry(&line(palette::BEFORE, weight), "before");
            entry(&line(palette::MOVED, 1.5 * weight), "moved");
        }
        if changes.added {
            entry(&fill(palette::ADDED), "added");
        }
        if changes.removed {
            entry(&fill(palette::REMOVED), "removed");
        }
    }
}

/// The number of columns with which the sheet is nearest to [`ASPECT`]; pictures that are missing in the last row count.
fn best_columns(cells: usize, extent: [f64; 2]) -> usize {
    let badness = |columns: usize| {
        let layout = Layout::new(1.0, cells, columns, extent);
        let empty = (columns * cells.div_ceil(columns) - cells) as f64 / cells as f64;
        // The caption has a least height in pixels, which means nothing here.
        let rows = cells.div_ceil(columns) as f64;
        let height = rows * (layout.picture[1] + 0.03) + 0.06;
        (1.0 / height / ASPECT).ln().abs() + empty
    };
    (1..=cells).min_by(|&a, &b| badness(a).total_cmp(&badness(b))).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn square(side: f64) -> Region {
        let p = Point::new;
        Region::new(vec![Ring::polygon([p(0.0, 0.0), p(side, 0.0), p(side, side), p(0.0, side)])])
    }

    fn sheet(columns: Option<usize>, after: &[Region], before: &Region) -> Result<tiny_skia::Pixmap, PreviewError> {
        let cells: Vec<Cell> = after.iter().map(|after| Cell { caption: "0.5 r²".to_owned(), before, after }).collect();
        contact_sheet(&cells, columns, 600).map(|png| tiny_skia::Pixmap::decode_png(&png).unwrap())
    }

    fn count(picture: &tiny_skia::Pixmap, color: Rgba) -> usize {
        let is_it = |p: &&tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()] == color[..3];
        picture.pixels().iter().filter(is_it).count()
    }

    #[test]
    fn pictures_stand_side_by_side_to_one_scale() {
        let states = [square(10.0), square(5.0)];
        let picture = sheet(Some(2), &states, &square(10.0)).unwrap();
        let row = sheet(Some(1), &states, &square(10.0)).unwrap();
        assert_eq!((picture.width(), row.width()), (600, 600));
        assert!(row.height() > 2 * picture.height());
        // A whole square and a quarter of one, the rest of which is coloured as removed.
        let (solid, removed) = (count(&picture, palette::SOLID) as f64, count(&picture, palette::REMOVED) as f64);
        assert!((solid / removed - 1.25 / 0.75).abs() < 0.1, "{solid} and {removed}");
        assert_eq!(count(&picture, palette::ADDED), 0);
        // A line of a pixel is soft, and blends with what it runs on.
        let is_reddish = |p: &&tiny_skia::PremultipliedColorU8| p.red() > p.green().saturating_add(60);
        assert!(picture.pixels().iter().filter(is_reddish).count() > 50);
    }

    #[test]
    fn columns_suit_the_shape_of_the_drawing() {
        assert_eq!(best_columns(1, [1.0, 1.0]), 1);
        assert_eq!(best_columns(6, [1.0, 1.0]), 3);
        // Words are wide.
        assert_eq!(best_columns(6, [5.0, 1.0]), 2);
        assert_eq!(best_columns(12, [5.0, 1.0]), 2);
        assert_eq!(best_columns(8, [1.0, 3.0]), 8);
    }

    #[test]
    fn nothing_and_absurd_sizes_are_errors() {
        assert_eq!(contact_sheet(&[], None, 600), Err(PreviewError::Nothing));
        let (empty, some) = (Region::default(), square(1.0));
        let cell = |before, after| [Cell { caption: String::new(), before, after }];
        assert_eq!(contact_sheet(&cell(&empty, &empty), None, 600), Err(PreviewError::Nothing));
        assert!(matches!(contact_sheet(&cell(&some, &some), None, 7), Err(PreviewError::Size { .. })));
        let all: Vec<Cell> = std::iter::repeat_n(cell(&some, &some), 40).flatten().collect();
        assert!(matches!(contact_sheet(&all, Some(1), 600), Err(PreviewError::Size { .. })));
        // What is melted away altogether is a picture of nothing but what was.
        assert!(contact_sheet(&cell(&some, &empty), None, 600).is_ok());
    }
}
