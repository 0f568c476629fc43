//! The picture of an outline, alone or against what it was before.

use super::PreviewError;
use super::palette;
use super::sheet::{Entry, Sample, Sheet};
use crate::plane::{BoundaryIndex, Region, Segment};

/// An element whose middle lies this much of the drawing's diagonal away from a boundary is not on it: far above the
/// rounding of any file, far below a pixel.
pub(super) const SAME_BOUNDARY: f64 = 1e-6;

/// The picture of `region`, as a PNG file of `size` pixels on its long side; `before` is what it was made from.
///
/// `unit_name` stands at the scale bar, `mm` or nothing.
///
/// # Errors
/// Where there is nothing to draw, or the size is absurd.
pub fn outline(region: &Region, before: Option<&Region>, unit_name: &str, size: u32) -> Result<Vec<u8>, PreviewError> {
    let bounds = before.map_or(region.bounds(), |b| region.bounds().union(b.bounds()));
    let mut entries = Vec::new();
    let entry = |sample, text: &str| Entry { sample, text: text.to_owned() };
    if !bounds.is_empty() {
        let (w, h) = (region.bounds().width(), region.bounds().height());
        let text = format!("{} x {} {unit_name}", short(w), short(h));
        entries.push(entry(Sample::None, text.trim_end()));
    }
    let weight = 1.6 * f64::from(size) / 1000.0;
    entries.push(entry(Sample::Line(palette::KEPT, weight), if before.is_some() { "kept" } else { "outline" }));
    if before.is_some() {
        entries.push(entry(Sample::Line(palette::MOVED, 1.4 * weight), "moved"));
        entries.push(entry(Sample::Fill(palette::ADDED, None), "added"));
        entries.push(entry(Sample::Fill(palette::REMOVED, None), "removed"));
    }
    let mut sheet = Sheet::new(&bounds, size, entries)?;
    let view = sheet.view;
    let path = view.region(region);
    match before {
        None => sheet.canvas.fill(path.as_ref(), palette::PART, None),
        Some(before) => {
            let old = view.region(before);
            sheet.canvas.fill(path.as_ref(), palette::ADDED, None);
            sheet.canvas.fill(old.as_ref(), palette::REMOVED, None);
            if let Some(mask) = sheet.canvas.mask(path.as_ref()) {
                sheet.canvas.fill(old.as_ref(), palette::PART, Some(&mask));
            }
        }
    }
    let (kept, moved) = split_moved(region, before, SAME_BOUNDARY * bounds.diagonal());
    sheet.canvas.stroke(&view.elements(kept), palette::KEPT, weight, None);
    sheet.canvas.stroke(&view.elements(moved), palette::MOVED, 1.4 * weight, None);
    sheet.finish(unit_name)
}

/// The elements of `region` that lie on the boundary of `before`, and those that do not.
pub(super) fn split_moved(region: &Region, before: Option<&Region>, tolerance: f64) -> (Vec<Segment>, Vec<Segment>) {
    let Some(before) = before else { return (region.segments().collect(), Vec::new()) };
    let index = BoundaryIndex::new(before);
    region.segments().partition(|s| index.is_nearer(s.point_at(0.5), tolerance))
}

/// A length with at most two decimals.
pub(super) fn short(length: f64) -> String {
    let text = format!("{length:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Point, Ring};

    fn disk() -> Region {
        Region::new(vec![Ring::circle(Point::new(50.0, 20.0), 20.0)])
    }

    #[test]
    fn the_same_input_gives_the_same_png() {
        let picture = || outline(&disk(), None, "mm", 400).unwrap();
        let png = picture();
        assert_eq!(&png[1..4], b"PNG");
        assert_eq!(png, picture());
    }

    #[test]
    fn nothing_and_absurd_sizes_are_errors() {
        assert_eq!(outline(&Region::default(), None, "mm", 400), Err(PreviewError::Nothing));
        assert!(matches!(outline(&disk(), None, "mm", 3), Err(PreviewError::Size { .. })));
        let far = Region::new(vec![Ring::polygon([Point::new(f64::NAN, 0.0), Point::new(1.0, f64::INFINITY)])]);
        assert_eq!(outline(&far, None, "mm", 400), Err(PreviewError::Nothing));
    }

    #[test]
    fn moved_elements_are_told_from_kept_ones() {
        let p = Point::new;
        let before =
            Region::new(vec![Ring::polygon([p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(5.0, 5.0), p(0.0, 10.0)])]);
        let after = Region::new(vec![Ring::polygon([p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)])]);
        let (kept, moved) = split_moved(&after, Some(&before), 1e-6);
        assert_eq!((kept.len(), moved.len()), (3, 1));
    }
}
