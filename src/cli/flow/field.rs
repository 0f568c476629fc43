//! What the flow is bound by: radii and pins, from arguments to geometry.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context as _, Result, bail};
use clap::Args;

use crate::cli::close::refuse_absurd;
use crate::cli::input::read_bytes;
use crate::io::picture::GreyPicture;
use crate::io::svg::{Parts, RADIUS_ATTRIBUTE};
use crate::plane::{
    BoundaryIndex, Bounds, Gradient, PinnedArea, PinnedRegion, Point, RadiusField, RadiusMap, Region, VertexId,
    pin_distance,
};
use crate::units::{DrawingScale, Length, Radius};

use super::own::OwnRadii;

/// Over the options that say what binds the flow.
pub(super) const HEADING: &str = "Radius and pins (coordinates are user units as in the file, y down)";

/// Radii and pins.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = HEADING)]
pub(super) struct FieldArgs {
    /// Radius of the disk: 2mm, 0.125in, 3px, 5u (user units) or 2% (of the diagonal); a bare number is millimetres.
    /// Elements with a data-clopen-radius="2mm", on them or around them, have that one instead
    #[arg(short, long, value_name = "LENGTH", allow_hyphen_values = true)]
    radius: Option<Length>,
    /// The radius at a point, from which it varies linearly to the other one: 10,0=1mm
    #[arg(
        long,
        value_name = "X,Y=LENGTH",
        requires = "radius_to",
        conflicts_with = "radius",
        allow_hyphen_values = true
    )]
    radius_from: Option<PlacedRadius>,
    /// The radius at the other point, and beyond: 90,0=6mm
    #[arg(long, value_name = "X,Y=LENGTH", requires = "radius_from", allow_hyphen_values = true)]
    radius_to: Option<PlacedRadius>,
    /// A grey picture that says how large the radius is where, PNG; it is laid over the page
    #[arg(
        long,
        value_name = "PICTURE",
        requires_all = ["radius_black", "radius_white"],
        conflicts_with_all = ["radius", "radius_from"]
    )]
    radius_map: Option<PathBuf>,
    /// The radius where the picture is black
    #[arg(long, value_name = "LENGTH", requires = "radius_map", allow_hyphen_values = true)]
    radius_black: Option<Length>,
    /// The radius where the picture is white
    #[arg(long, value_name = "LENGTH", requires = "radius_map", allow_hyphen_values = true)]
    radius_white: Option<Length>,
    /// A rectangle in which nothing moves; may be given more than once. Nearer to it than half the radius the bound eases: the
    /// outline meets what is pinned without a corner
    #[arg(long = "pin", value_name = "X,Y,WIDTH,HEIGHT", allow_hyphen_values = true)]
    rectangles: Vec<PinRectangle>,
    /// A circle in which nothing moves; may be given more than once
    #[arg(long = "pin-circle", value_name = "CX,CY,RADIUS", allow_hyphen_values = true)]
    circles: Vec<PinCircle>,
}

/// What the arguments mean for a drawing, in its user units with y up.
pub(super) struct Field {
    /// What holds where no element says otherwise; none where all of them do.
    base: Option<RadiusField>,
    own: Option<OwnRadii>,
    range: [Radius; 2],
    pins: Vec<PinnedArea>,
}

impl Field {
    /// The field as the flow asks for it.
    pub(super) fn view(&self) -> crate::flow::Field<'_> {
        crate::flow::Field {
            radius: Box::new(|p, vertex| self.radius(p, vertex)),
            pin_distance: Box::new(|p| pin_distance(&self.pins, p)),
        }
    }

    /// The smallest and the largest radius that there may be on the outline.
    pub(super) fn range(&self) -> [Radius; 2] {
        self.range
    }

    fn radius(&self, p: Point, vertex: Option<VertexId>) -> f64 {
        let own = self.own.as_ref().and_then(|own| own.at(p, vertex));
        // One of the two says something everywhere: what does not is refused beforehand.
        own.map(Radius::get).or_else(|| Some(self.base.as_ref()?.at(p))).unwrap_or(f64::NAN)
    }
}

impl FieldArgs {
    /// One radius for everything.
    #[cfg(feature = "text")]
    pub(super) fn constant(radius: Length) -> FieldArgs {
        FieldArgs { radius: Some(radius), ..FieldArgs::default() }
    }

    /// What the arguments mean for what is chosen of a drawing; `named` are areas in which nothing moves, by their `id`s.
    ///
    /// # Errors
    /// Names the option, or the element, and says what to do.
    pub(super) fn resolve(&self, parts: &Parts, named: &[(String, Region)]) -> Result<Field> {
        let pins = self.pins(&parts.chosen().region, named)?;
        let base = self.radius_field(parts)?;
        let own = OwnRadii::read(parts)?;
        let lonely = own.as_ref().map_or(Some(None), |own| own.without().map(Some));
        let base = match (base, lonely) {
            (Some(base), Some(_)) => Some(base),
            // Nothing is left that it could hold for.
            (_, None) => None,
            (None, Some(Some(place))) => {
                bail!("no radius for {place}: give it a {RADIUS_ATTRIBUTE}, or one to all that have none with -r 2mm")
            }
            (None, Some(None)) => bail!(
                "no radius: give one with -r 2mm, two with --radius-from and --radius-to, a picture with --radius-map, or \
                 every element its own with {RADIUS_ATTRIBUTE}"
            ),
        };
        let ranges = base.iter().map(RadiusField::range).chain(own.iter().map(OwnRadii::range));
        let range = ranges.reduce(|[a, b], [c, d]| [if c < a { c } else { a }, if d > b { d } else { b }]);
        let range = range.context("no radius: give one with -r 2mm")?;
        Ok(Field { base, own, range, pins })
    }

    fn radius_field(&self, parts: &Parts) -> Result<Option<RadiusField>> {
        let (scale, diagonal) = (parts.scale(), parts.bounds().diagonal());
        let radius = |length: Length, option: &str| resolve_radius(length, option, &scale, diagonal);
        if let Some(length) = self.radius {
            return Ok(Some(RadiusField::Constant(radius(length, "--radius")?)));
        }
        if let (Some(from), Some(to)) = (self.radius_from, self.radius_to) {
            let end =
                |placed: PlacedRadius, option| Ok::<_, anyhow::Error>((placed.point(), radius(placed.radius, option)?));
            let (start, end) = (end(from, "--radius-from")?, end(to, "--radius-to")?);
            let gradient = Gradient::new(start, end);
            return gradient.map(|g| Some(RadiusField::Gradient(g))).with_context(|| {
                format!(
                    "--radius-from {from} and --radius-to {to} are in the same place: give two points, or one --radius"
                )
            });
        }
        if let (Some(path), Some(black), Some(white)) = (&self.radius_map, self.radius_black, self.radius_white) {
            let (black, white) = (radius(black, "--radius-black")?, radius(white, "--radius-white")?);
            return Ok(Some(RadiusField::Map(radius_map(path, parts, black, white)?)));
        }
        Ok(None)
    }

    fn pins(&self, region: &Region, named: &[(String, Region)]) -> Result<Vec<PinnedArea>> {
        let rectangles = self.rectangles.iter().map(|pin| (format!("--pin {pin}"), pin.area()));
        let circles = self.circles.iter().map(|pin| (format!("--pin-circle {pin}"), pin.area()));
        let named =
            named.iter().map(|(id, area)| (format!("--pin-id {id}"), PinnedArea::Region(PinnedRegion::new(area))));
        let mut areas = Vec::new();
        let mut outline = None;
        for (typed, area) in rectangles.chain(circles).chain(named) {
            if !area.touches(outline.get_or_insert_with(|| BoundaryIndex::new(region))) {
                let b = region.bounds();
                let [left, top, right, bottom] = [b.min.x, -b.max.y, b.max.x, -b.min.y].map(|x| x + 0.0);
                bail!(
                    "{typed} touches no outline and would hold nothing: what flows reaches from ({left:.2}, {top:.2}) to \
                     ({right:.2}, {bottom:.2}) in user units, y down"
                );
            }
            areas.push(area);
        }
        Ok(areas)
    }
}

/// The radius that was typed as `option`, on a drawing of that scale and diagonal.
pub(super) fn resolve_radius(length: Length, option: &str, scale: &DrawingScale, diagonal: f64) -> Result<Radius> {
    let units = length.to_user_units(scale).with_context(|| option.to_owned())?;
    let radius = Radius::new(units).map_err(|_| anyhow::anyhow!("{option} {length}: it must be above zero"))?;
    refuse_absurd(radius, length, option, diagonal)?;
    Ok(radius)
}

fn radius_map(path: &Path, parts: &Parts, black: Radius, white: Radius) -> Result<RadiusMap> {
    let name = || path.display().to_string();
    let picture = GreyPicture::read(&read_bytes(path)?).with_context(name)?;
    // A drawing without a page has at least an extent.
    let area = match parts.chosen().page.area() {
        Some([x, y, width, height]) => rectangle(x, y, width, height),
        None => parts.bounds(),
    };
    RadiusMap::new(picture.columns, picture.levels, area, black, white)
        .with_context(|| format!("{}: the drawing's page has no width or height to lay it over", name()))
}

/// A rectangle of the file, where y points down.
fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Bounds {
    Bounds { min: Point::new(x, -(y + height)), max: Point::new(x + width, -y) }
}

/// So many finite numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parse = |t: &str| t.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let found: Option<Vec<f64>> = text.split(',').map(parse).collect();
    found?.try_into().ok()
}

/// A radius at a point: `10,0=1mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlacedRadius {
    place: [f64; 2],
    radius: Length,
}

impl PlacedRadius {
    fn point(&self) -> Point {
        Point::new(self.place[0], -self.place[1])
    }
}

impl FromStr for PlacedRadius {
    type Err = String;

    fn from_str(text: &str) -> Result<PlacedRadius, String> {
        let error = || "write a point and the radius there, for example 10,0=1mm".to_owned();
        let (place, radius) = text.split_once('=').ok_or_else(error)?;
        let place = numbers(place).ok_or_else(error)?;
        Ok(PlacedRadius { place, radius: radius.parse().map_err(|e: crate::units::ParseLengthError| e.to_string())? })
    }
}

impl fmt::Display for PlacedRadius {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}={}", self.place[0], self.place[1], self.radius)
    }
}

/// A pinned rectangle: `x,y,width,height`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PinRectangle([f64; 4]);

impl PinRectangle {
    fn area(&self) -> PinnedArea {
        let [x, y, width, height] = self.0;
        PinnedArea::Rectangle(rectangle(x, y, width, height))
    }
}

impl FromStr for PinRectangle {
    type Err = String;

    fn from_str(text: &str) -> Result<PinRectangle, String> {
        let found = numbers(text).filter(|[_, _, width, height]| *width > 0.0 && *height > 0.0);
        found.map(PinRectangle).ok_or_else(|| {
            "write the upper left corner, a width and a height above zero, for example 10,5,20,8".to_owned()
        })
    }
}

impl fmt::Display for PinRectangle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, width, height] = self.0;
        write!(f, "{x},{y},{width},{height}")
    }
}

/// A pinned disk: `cx,cy,radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PinCircle([f64; 3]);

impl PinCircle {
    fn area(&self) -> PinnedArea {
        let [x, y, radius] = self.0;
        PinnedArea::Disk { center: Point::new(x, -y), radius }
    }
}

impl FromStr for PinCircle {
    type Err = String;

    fn from_str(text: &str) -> Result<PinCircle, String> {
        let found = numbers(text).filter(|[_, _, radius]| *radius > 0.0);
        found.map(PinCircle).ok_or_else(|| "write the middle and a radius above zero, for example 10,5,4".to_owned())
    }
}

impl fmt::Display for PinCircle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, radius] = self.0;
        write!(f, "{x},{y},{radius}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_pins_are_read() {
        let placed: PlacedRadius = " 10, -2.5 =1mm".parse().unwrap();
        assert_eq!(placed, PlacedRadius { place: [10.0, -2.5], radius: Length::Millimetres(1.0) });
        assert_eq!(placed.point(), Point::new(10.0, 2.5));
        assert_eq!(placed.to_string().parse(), Ok(placed));
        for text in ["", "10,0", "10=1mm", "1,2,3=1mm", "nan,0=1mm", "1,2=", "1,2=3 miles"] {
            assert!(text.parse::<PlacedRadius>().is_err(), "{text}");
        }
        let pin: PinRectangle = "1,2,3,4".parse().unwrap();
        assert!(pin.area().contains(Point::new(3.9, -5.9)) && !pin.area().contains(Point::new(3.9, -6.1)));
        assert!(pin.area().contains(Point::new(1.0, -2.0)) && !pin.area().contains(Point::new(1.0, 2.0)));
        for text in ["1,2,3", "1,2,0,4", "1,2,3,-4", "1,2,inf,4", "a,b,c,d", "1,2,3,4,5"] {
            assert!(text.parse::<PinRectangle>().is_err(), "{text}");
        }
        let pin: PinCircle = "1,2,3".parse().unwrap();
        assert!(pin.area().contains(Point::new(1.0, -4.9)) && !pin.area().contains(Point::new(1.0, 1.1)));
        assert!("1,2,0".parse::<PinCircle>().is_err() && "1,2".parse::<PinCircle>().is_err());
    }
}
