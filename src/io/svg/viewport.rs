//! The page: its view box, and how large a user unit is.

use std::str::FromStr;

use svgtypes::{Align, AspectRatio, LengthUnit};
use usvg::roxmltree::Node;

use crate::units::{MM_PER_INCH, PX_PER_INCH};

use super::shape::to_pixels;

/// How unequal the scales of x and y may be, relative, to count as one: widths are often written with few digits.
const UNEVEN_SCALE: f64 = 1e-3;

/// The attributes of the root element that say where the drawing stands and how large it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// `width`, as written.
    pub width: Option<String>,
    /// `height`, as written.
    pub height: Option<String>,
    /// `viewBox`, as written.
    pub view_box: Option<String>,
    /// `preserveAspectRatio`, as written.
    pub preserve_aspect_ratio: Option<String>,
}

/// How large a user unit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum UnitSize {
    /// In millimetres.
    Millimetres(f64),
    /// The file does not say.
    Unknown,
    /// Not the same along x and y.
    Uneven,
}

impl Page {
    pub(super) fn of_root(root: Node) -> Page {
        let text = |name| root.attribute(name).map(str::to_owned);
        Page {
            width: text("width"),
            height: text("height"),
            view_box: text("viewBox"),
            preserve_aspect_ratio: text("preserveAspectRatio"),
        }
    }

    /// The view box: x, y, width and height in user units.
    pub fn view_box(&self) -> Option<[f64; 4]> {
        let view = svgtypes::ViewBox::from_str(self.view_box.as_deref()?).ok()?;
        Some([view.x, view.y, view.w, view.h])
    }

    /// What the page shows: x, y, width and height in user units. That is the view box; without one, width and height.
    pub fn area(&self) -> Option<[f64; 4]> {
        let side = |text: &Option<String>| {
            let pixels = to_pixels(svgtypes::Length::from_str(text.as_deref()?.trim()).ok()?)?;
            (pixels > 0.0 && pixels.is_finite()).then_some(pixels)
        };
        match &self.view_box {
            Some(_) => self.view_box(),
            None => Some([0.0, 0.0, side(&self.width)?, side(&self.height)?]),
        }
    }

    /// Whether there is a view box that means nothing: then the drawing's own units mean nothing either.
    pub(super) fn has_invalid_view_box(&self) -> bool {
        self.view_box.is_some() && self.view_box().is_none()
    }

    /// Whether its physical size rests on numbers without a unit, which the format takes for 1/96 of an inch.
    pub fn has_size_without_unit(&self) -> bool {
        let texts = [self.width.as_deref(), self.height.as_deref()];
        let mut sizes = texts.into_iter().flatten().filter(|text| physical(Some(text)).is_some()).peekable();
        sizes.peek().is_some()
            && sizes.all(|t| svgtypes::Length::from_str(t.trim()).is_ok_and(|l| l.unit == LengthUnit::None))
    }

    pub(super) fn aspect(&self) -> AspectRatio {
        self.preserve_aspect_ratio.as_deref().and_then(|t| AspectRatio::from_str(t).ok()).unwrap_or_default()
    }

    pub(super) fn unit_size(&self) -> UnitSize {
        let (width, height) = (physical(self.width.as_deref()), physical(self.height.as_deref()));
        if self.has_invalid_view_box() {
            return UnitSize::Unknown;
        }
        let Some([_, _, view_width, view_height]) = self.view_box() else {
            // Without a view box a user unit is a CSS pixel, provided that the file has a size at all.
            let sized = width.is_some() || height.is_some();
            return if sized { UnitSize::Millimetres(MM_PER_INCH / PX_PER_INCH) } else { UnitSize::Unknown };
        };
        let aspect = self.aspect();
        match (width.map(|w| w / view_width), height.map(|h| h / view_height)) {
            (None, None) => UnitSize::Unknown,
            (Some(s), None) | (None, Some(s)) => UnitSize::Millimetres(s),
            (Some(x), Some(y)) if aspect.align == Align::None => {
                let even = (x - y).abs() <= UNEVEN_SCALE * x.max(y);
                if even { UnitSize::Millimetres(x) } else { UnitSize::Uneven }
            }
            (Some(x), Some(y)) => UnitSize::Millimetres(if aspect.slice { x.max(y) } else { x.min(y) }),
        }
    }
}

/// A length in millimetres; `None` where absent, malformed, not above zero or relative.
fn physical(text: Option<&str>) -> Option<f64> {
    let length = svgtypes::Length::from_str(text?.trim()).ok()?;
    let mm = match length.unit {
        // Straight to millimetres: by way of pixels 120mm would not be 120.
        LengthUnit::Mm => length.number,
        LengthUnit::Cm => length.number * 10.0,
        LengthUnit::In => length.number * MM_PER_INCH,
        _ => to_pixels(length)? / PX_PER_INCH * MM_PER_INCH,
    };
    (mm > 0.0 && mm.is_finite()).then_some(mm)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(width: &str, height: &str, view_box: &str, aspect: &str) -> UnitSize {
        let text = |t: &str| (!t.is_empty()).then(|| t.to_owned());
        Page { width: text(width), height: text(height), view_box: text(view_box), preserve_aspect_ratio: text(aspect) }
            .unit_size()
    }

    #[test]
    fn numbers_without_a_unit_are_known() {
        let page = |width: &str| Page { width: Some(width.to_owned()), ..Page::default() };
        for (width, expected) in [("100", true), ("100mm", false), ("100px", false), ("100%", false), ("x", false)] {
            assert_eq!(page(width).has_size_without_unit(), expected, "{width}");
        }
        assert!(!Page::default().has_size_without_unit());
    }

    #[test]
    fn areas_of_pages() {
        let area = |width: &str, height: &str, view_box: Option<&str>| {
            let text = |t: &str| (!t.is_empty()).then(|| t.to_owned());
            Page { width: text(width), height: text(height), view_box: view_box.map(str::to_owned), ..Page::default() }
                .area()
        };
        assert_eq!(area("120mm", "80mm", Some("1 2 30 40")), Some([1.0, 2.0, 30.0, 40.0]));
        assert_eq!(area("120px", "1in", None), Some([0.0, 0.0, 120.0, 96.0]));
        assert_eq!(area("100%", "80", None), None);
        assert_eq!(area("120mm", "80mm", Some("a")), None);
        assert_eq!(area("120", "", None), None);
    }

    #[test]
    fn unit_sizes() {
        let mm = UnitSize::Millimetres;
        assert_eq!(size("120mm", "80mm", "0 0 120 80", ""), mm(1.0));
        assert_eq!(size("4in", "2in", "-100 -50 400 200", ""), mm(0.254));
        assert_eq!(size("100", "100", "", ""), mm(25.4 / 96.0));
        assert_eq!(size("96", "96", "0 0 1 1", ""), mm(25.4));
        assert_eq!(size("100%", "100%", "0 0 9 9", ""), UnitSize::Unknown);
        assert_eq!(size("", "", "0 0 9 9", ""), UnitSize::Unknown);
        assert_eq!(size("", "", "", ""), UnitSize::Unknown);
        assert_eq!(size("100", "100", "a b c", ""), UnitSize::Unknown);
        assert_eq!(size("", "20mm", "0 0 9 10", ""), mm(2.0));
        // Twice as wide as needed: the drawing is fitted in, or fills.
        assert_eq!(size("20mm", "10mm", "0 0 10 10", ""), mm(1.0));
        assert_eq!(size("20mm", "10mm", "0 0 10 10", "xMidYMid slice"), mm(2.0));
        assert_eq!(size("20mm", "10mm", "0 0 10 10", "none"), UnitSize::Uneven);
    }
}
