//! The specimen of a font: lines of text before and after.

use super::PreviewError;
use super::canvas::{Canvas, View};
use super::palette;
use crate::plane::{Bounds, Point, Region};

/// A line of text in the old letters and in the new ones, in font units, its baseline starting at the origin.
#[derive(Clone, Debug, Default)]
pub struct SpecimenRow {
    /// In the old letters.
    pub before: Region,
    /// In the new letters.
    pub after: Region,
}

/// White round the sheet, and distance of baselines, in ems.
const MARGIN: f64 = 0.5;
const LEADING: f64 = 1.35;

/// Higher pictures are none.
const HIGHEST: f64 = 65_536.0;

/// More room between rows than between the two lines of one.
const BETWEEN_ROWS: f64 = 0.45;

/// A specimen as a PNG file of `size` pixels in width: every row in the old letters, grey, and below in the new ones, with what
/// was added and removed in colour.
///
/// # Errors
/// Where there is nothing to draw, or the size is absurd.
pub fn specimen(rows: &[SpecimenRow], units_per_em: f64, size: u32) -> Result<Vec<u8>, PreviewError> {
    let bounds = rows.iter().fold(Bounds::EMPTY, |b, row| b.union(row.before.bounds()).union(row.after.bounds()));
    let is_finite = bounds.min.coords.iter().chain(bounds.max.coords.iter()).all(|x| x.is_finite());
    if bounds.is_empty() || !is_finite || bounds.width() <= 0.0 {
        return Err(PreviewError::Nothing);
    }
    if !(64..=16_384).contains(&size) {
        return Err(PreviewError::Size { width: size, height: size });
    }
    let em = units_per_em;
    let scale = f64::from(size) / (bounds.width() + 2.0 * MARGIN * em);
    let row_height = (2.0 * LEADING + BETWEEN_ROWS) * em;
    let height = scale * (row_height * rows.len() as f64 + 2.0 * MARGIN * em);
    if height >= HIGHEST {
        return Err(PreviewError::Size { width: size, height: height as u32 });
    }
    let mut canvas = Canvas::new(f64::from(size), height)?;
    for (k, row) in rows.iter().enumerate() {
        let baseline = |line: f64| -> View {
            let y = MARGIN * em + k as f64 * row_height + (line + 0.85) * LEADING * em;
            View { scale, origin: Point::new(scale * (MARGIN * em - bounds.min.x), scale * y) }
        };
        let (above, below) = (baseline(0.0), baseline(1.0));
        canvas.fill(above.region(&row.before).as_ref(), palette::KEPT, None);
        let (old, new) = (below.region(&row.before), below.region(&row.after));
        canvas.fill(new.as_ref(), palette::MOVED, None);
        canvas.fill(old.as_ref(), palette::REMOVED, None);
        if let Some(mask) = canvas.mask(new.as_ref()) {
            canvas.fill(old.as_ref(), palette::INK, Some(&mask));
        }
    }
    canvas.into_png()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    #[test]
    fn a_specimen_is_a_picture_and_nothing_is_an_error() {
        let disk = |r: f64| Region::new(vec![Ring::circle(Point::new(500.0, 300.0), r)]);
        let row = SpecimenRow { before: disk(300.0), after: disk(280.0) };
        let png = specimen(&[row.clone(), row], 1000.0, 300).unwrap();
        assert_eq!(&png[1..4], b"PNG");
        assert_eq!(specimen(&[], 1000.0, 300), Err(PreviewError::Nothing));
        assert_eq!(specimen(&[SpecimenRow::default()], 1000.0, 300), Err(PreviewError::Nothing));
    }
}
