//! A drawing shape by shape: what each fills, the lines that it strokes, and what it is called.

use std::fmt;

use usvg::roxmltree::Node;

use super::collect::Item;
use super::drawing::Drawing;
use super::error::{Place, ReadError, Warning};
use super::gather::{Gathered, gather};
use super::joined::joined;
use super::options::{ReadOptions, Strokes};
use super::viewport::Page;
use crate::io::unite::{self, Rule};
use crate::plane::{Bounds, Point, Region, Ring};
use crate::units::DrawingScale;

/// The namespace of Inkscape's attributes, which name its layers.
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// A colour of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color(pub [u8; 3]);

impl Color {
    /// The colour that CSS writes so: `red`, `#f00`, `#ff0000`, `rgb(255, 0, 0)`.
    pub fn parse(text: &str) -> Option<Color> {
        let color: svgtypes::Color = text.trim().parse().ok()?;
        Some(Color([color.red, color.green, color.blue]))
    }
}

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// A line that a shape strokes, along its middle.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLine {
    /// Its elements, in user units. Of an open line the last element, which leads back to its start, is no part.
    pub ring: Ring,
    /// Whether it ends where it starts.
    pub is_closed: bool,
}

/// A shape of a drawing, transforms applied: user units, y up.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnShape {
    /// Its element, `id` and line.
    pub place: Place,
    /// The `id`s and layer names of all that is around it, itself included, the innermost first.
    pub names: Vec<String>,
    /// What it is filled with; none for an unfilled one, or a pattern.
    pub fill: Option<Color>,
    /// What it is stroked with.
    pub stroke: Option<Color>,
    /// What it fills.
    pub area: Region,
    /// What it strokes.
    pub lines: Vec<DrawnLine>,
}

/// A drawing shape by shape, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Shapes {
    /// The shapes that fill or stroke something.
    pub shapes: Vec<DrawnShape>,
    /// Millimetres in a user unit, where the file or the options say.
    pub mm_per_unit: Option<f64>,
    /// What the root element says of place and size.
    pub page: Page,
    /// What was left out.
    pub warnings: Vec<Warning>,
}

impl Shapes {
    /// The smallest box that holds all areas and lines.
    pub fn bounds(&self) -> Bounds {
        let rings = self.shapes.iter().flat_map(|s| s.area.rings.iter().chain(s.lines.iter().map(|l| &l.ring)));
        rings.fold(Bounds::EMPTY, |b, ring| b.union(ring.bounds()))
    }

    /// What the shapes with these indices fill, united. Shapes that fill nothing count with the closed lines that they
    /// stroke, all of them together by the even-odd rule: drawings for machines often have no fills, and a circle in a
    /// rectangle is a hole there. Open lines whose ends meet are a closed one.
    pub fn united(&self, which: &[usize]) -> Region {
        let chosen = || which.iter().filter_map(|&k| self.shapes.get(k));
        let stroked = self.outlines(which).into_iter();
        let closed: Vec<Ring> = stroked.filter(|line| line.is_closed).map(|line| line.ring).collect();
        let mut areas: Vec<Vec<Ring>> = chosen().map(|shape| shape.area.rings.clone()).collect();
        areas.push(unite::resolve(closed, Rule::EvenOdd));
        Region::new(unite::united(areas))
    }

    /// The lines of those of the shapes with these indices that fill nothing; open ones joined where their ends meet.
    fn outlines(&self, which: &[usize]) -> Vec<DrawnLine> {
        let chosen = which.iter().filter_map(|&k| self.shapes.get(k));
        let lines = chosen.filter(|shape| shape.area.is_empty()).flat_map(|shape| &shape.lines);
        let (closed, open): (Vec<&DrawnLine>, Vec<&DrawnLine>) = lines.partition(|line| line.is_closed);
        closed.into_iter().cloned().chain(joined(&open)).collect()
    }

    /// Where the open lines among the shapes with these indices begin that no others make a closed one: they have no inside.
    pub fn open_lines(&self, which: &[usize]) -> Vec<Point> {
        let open = self.outlines(which).into_iter().filter(|line| !line.is_closed);
        open.filter_map(|line| line.ring.vertices.first().map(|v| v.point)).collect()
    }

    /// The middles of those of the shapes with these indices that lie wholly on what another one fills: united they change
    /// nothing. Of equal shapes it is the later ones.
    pub fn covered(&self, which: &[usize]) -> Vec<Point> {
        self.covered_shapes(which).into_iter().map(|k| self.shapes[k].area.bounds().center()).collect()
    }

    /// The indices of the same shapes.
    pub fn covered_shapes(&self, which: &[usize]) -> Vec<usize> {
        let is_filled = |k: &usize| self.shapes.get(*k).is_some_and(|shape| !shape.area.is_empty());
        let filled: Vec<usize> = which.iter().copied().filter(is_filled).collect();
        let region = |k: usize| &self.shapes[filled[k]].area;
        let bounds: Vec<Bounds> = (0..filled.len()).map(|k| region(k).bounds()).collect();
        let areas: Vec<f64> = (0..filled.len()).map(|k| region(k).area()).collect();
        let lies_on = |k: usize, j: usize| {
            let is_smaller = || areas[k] < areas[j] || (region(k) == region(j) && j < k);
            bounds[j].union(bounds[k]) == bounds[j] && is_smaller() && region(j).covers(region(k))
        };
        let is_covered = |k: &usize| (0..filled.len()).any(|j| j != *k && lies_on(*k, j));
        (0..filled.len()).filter(is_covered).map(|k| filled[k]).collect()
    }

    /// What lengths typed for the drawing are measured by.
    pub fn scale(&self) -> DrawingScale {
        DrawingScale { mm_per_unit: self.mm_per_unit, diagonal: self.bounds().diagonal() }
    }
}

/// Reads an SVG file shape by shape. Shapes may overlap and touch each other: none is united with another.
///
/// Strokes are lines, whatever `options` say of them: a tool follows them. `width_mm` of the options means areas and lines.
///
/// # Errors
/// As [`read`](super::read), except that strokes alone are something.
pub fn read_shapes(bytes: &[u8], options: &ReadOptions) -> Result<Shapes, ReadError> {
    let options = ReadOptions { strokes: Strokes::Lines, ..options.clone() };
    gather(bytes, &options, None, |gathered| {
        let mut shapes = Vec::new();
        for element in 0..gathered.collection.instances.len() as u32 {
            shapes.extend(shape(&gathered, element));
        }
        let mut drawn = Shapes { shapes, mm_per_unit: None, page: gathered.page.clone(), warnings: Vec::new() };
        if drawn.shapes.is_empty() {
            return Err(gathered.nothing_filled());
        }
        drawn.mm_per_unit = gathered.mm_per_unit(drawn.bounds().width());
        drawn.warnings = gathered.collection.warnings;
        Ok(drawn)
    })
}

/// The element with this number; `None` where nothing of it is drawn, as in clip paths.
fn shape(gathered: &Gathered, element: u32) -> Option<DrawnShape> {
    let collection = &gathered.collection;
    let items: Vec<Item> = collection.items.iter().filter(|i| i.element == element).cloned().collect();
    let Drawing { region: area, .. } = gathered.drawing(&items);
    let stroked = collection.lines.iter().filter(|l| l.element == element);
    let lines: Vec<DrawnLine> = stroked.flat_map(|l| gathered.lines(l)).collect();
    if area.is_empty() && lines.is_empty() {
        return None;
    }
    let instance = &collection.instances[element as usize];
    let around = gathered.source.around(instance);
    let colors = collection.colors.get(&element).copied().unwrap_or_default();
    Some(DrawnShape {
        place: gathered.source.place(*around.first()?),
        names: around.iter().flat_map(|node| names(gathered, node)).collect(),
        fill: colors.fill.map(Color).filter(|_| !area.is_empty()),
        stroke: colors.stroke.map(Color).filter(|_| !lines.is_empty()),
        area,
        lines,
    })
}

fn names(gathered: &Gathered, node: &Node) -> Vec<String> {
    let label = node.attribute((INKSCAPE, "label")).map(str::to_owned);
    gathered.source.place(*node).id.into_iter().chain(label).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(body: &str) -> Shapes {
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="{INKSCAPE}" width="100mm" height="100mm"
            viewBox="0 0 100 100">{body}</svg>"#
        );
        read_shapes(svg.as_bytes(), &ReadOptions::default()).unwrap()
    }

    #[test]
    fn every_shape_has_its_own_area_lines_colours_and_names() {
        let drawn = read(
            r##"<g id="g1" inkscape:label="Holes" transform="translate(10 0)"><circle id="a" cx="5" cy="5" r="2"
            fill="red"/></g><path id="b" d="M0 0H10V10" fill="none" stroke="#00f"/><rect width="10" height="10"
            style="fill:lime;stroke:black"/>"##,
        );
        let [hole, line, plate] = &drawn.shapes[..] else { panic!("{drawn:?}") };
        assert_eq!(hole.names, ["a", "g1", "Holes"]);
        assert_eq!((hole.fill, hole.stroke), (Color::parse("#f00"), None));
        assert!((hole.area.area() - 4.0 * std::f64::consts::PI).abs() < 1e-12);
        assert_eq!(hole.area.bounds().center(), crate::plane::Point::new(15.0, -5.0));
        assert!(line.area.is_empty());
        assert_eq!(line.stroke, Color::parse("blue"));
        assert!(!line.lines[0].is_closed);
        let length: f64 = line.lines[0].ring.segments().take(2).map(|s| s.length()).sum();
        assert_eq!((line.lines[0].ring.len(), length), (3, 20.0));
        assert_eq!((plate.fill, plate.stroke), (Color::parse("lime"), Color::parse("black")));
        assert!(plate.lines[0].is_closed && plate.area.area() == 100.0);
        assert_eq!(drawn.mm_per_unit, Some(1.0));
        assert!(drawn.warnings.is_empty(), "{:?}", drawn.warnings);
    }

    #[test]
    fn strokes_alone_are_a_drawing_and_nothing_is_an_error() {
        let line = read(r#"<line x1="0" y1="1" x2="5" y2="1" stroke="red"/>"#);
        assert_eq!(line.shapes[0].lines[0].ring.segments().next().map(|s| s.length()), Some(5.0));
        assert!(read_shapes(b"<svg xmlns='http://www.w3.org/2000/svg'/>", &ReadOptions::default()).is_err());
    }
}
