//! States of a drawing as one SVG file that plays by itself.
//!
//! Every browser plays it without script (SMIL), also where it is embedded as an image. Who knows no animation sees the last
//! state. A part (an outline with its holes) that looks the same in states that follow each other is written once for all of
//! them. The outlines are for looking at: what moved is rounded and thinned far below a pixel; [`write`](fn@super::write) gives a
//! state with all its digits.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::ops::Range;

use crate::plane::{Bounds, Region, Ring};

use super::drawing::Drawing;
use super::parts::Parts;
use super::thin::thinned;
use super::write::{PathWriter, write_link};

/// A state of a drawing in an animation.
#[derive(Clone, Debug)]
pub struct Still<'a> {
    /// The state.
    pub region: &'a Region,
    /// What stands below it.
    pub caption: String,
    /// For how long it is shown.
    pub seconds: f64,
}

/// Sizes as fractions of the diagonal of what is drawn.
const MARGIN: f64 = 0.03;
const CAPTION: f64 = 0.022;

/// Moved outlines are drawn within this of where they are, as a fraction of the diagonal: a tenth of a pixel on a large screen.
const TOLERANCE: f64 = 4e-5;

/// Moved vertices are rounded to a power of ten below this, as a fraction of the diagonal.
const ROUNDING: f64 = 2e-5;

const SOLID: &str = "#495057";
const BEFORE: &str = "#adb5bd";
const INK: &str = "#343a40";

/// The animation of `stills`, over the thin outlines of the drawing itself, as an SVG file in the drawing's user units; it
/// starts again for ever. Without stills it shows the drawing.
pub fn animate(drawing: &Drawing, stills: &[Still]) -> String {
    animate_among(drawing, &[], stills)
}

/// The animation of `stills` of what is chosen of a drawing, as [`animate`] makes it; the other parts stand still.
pub fn animate_parts(parts: &Parts, stills: &[Still]) -> String {
    let others = parts.parts.iter().enumerate().filter(|(k, _)| *k != parts.chosen);
    let others: Vec<&Drawing> = others.map(|(_, part)| &part.drawing).collect();
    animate_among(parts.chosen(), &others, stills)
}

fn animate_among(drawing: &Drawing, others: &[&Drawing], stills: &[Still]) -> String {
    let around = others.iter().fold(drawing.region.bounds(), |b, other| b.union(other.region.bounds()));
    let bounds = stills.iter().fold(around, |b, s| b.union(s.region.bounds()));
    let diagonal = bounds.diagonal();
    let seconds: Vec<f64> = stills.iter().map(|s| s.seconds.max(0.0)).collect();
    let clock = Clock::new(&seconds);
    let writer = PathWriter::new(drawing);
    let mut svg = opening(&bounds);

    let unit = 10f64.powf((ROUNDING * diagonal).log10().floor());
    let mut timeline = Timeline::default();
    for (k, still) in stills.iter().enumerate() {
        for part in parts(&thinned(still.region, TOLERANCE * diagonal, unit)) {
            timeline.shows(k, path_data(&writer, &part));
        }
    }
    let _ = writeln!(svg, "<g fill=\"{SOLID}\" fill-rule=\"evenodd\">");
    for other in others {
        let data = path_data(&PathWriter::new(other), &other.region.rings);
        let _ = writeln!(svg, "<path d=\"{data}\"/>");
    }
    for (data, shown) in &timeline.parts {
        svg += &clock.element("path", &format!("d=\"{data}\""), "", shown);
    }
    let before = path_data(&writer, &drawing.region.rings);
    let _ = writeln!(
        svg,
        "</g>\n<path fill=\"none\" stroke=\"{BEFORE}\" vector-effect=\"non-scaling-stroke\" d=\"{before}\"/>"
    );

    let size = CAPTION * diagonal;
    let (x, y) = (bounds.min.x, -bounds.min.y + MARGIN * diagonal + size);
    let _ = writeln!(svg, "<g fill=\"{INK}\" font-family=\"sans-serif\" font-size=\"{size:.6}\">");
    for (k, still) in stills.iter().enumerate() {
        let text = still.caption.replace('&', "&amp;").replace('<', "&lt;");
        svg += &clock.element("text", &format!("x=\"{x:.6}\" y=\"{y:.6}\""), &text, &(k..k + 1));
    }
    svg + "</g>\n</svg>\n"
}

fn opening(bounds: &Bounds) -> String {
    let margin = MARGIN * bounds.diagonal();
    let page = bounds.inflated(margin);
    let (width, height) = (page.width(), page.height() + 1.5 * CAPTION * bounds.diagonal());
    let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\"");
    let _ = writeln!(svg, " viewBox=\"{:.6} {:.6} {width:.6} {height:.6}\">", page.min.x, -page.max.y);
    svg
}

/// The parts of a region: every outer ring with the holes directly in it.
fn parts(region: &Region) -> Vec<Vec<Ring>> {
    let rings: Vec<&Ring> = region.rings.iter().filter(|r| r.len() > 1).collect();
    let area: Vec<f64> = rings.iter().map(|r| r.area()).collect();
    let bounds: Vec<Bounds> = rings.iter().map(|r| r.bounds()).collect();
    let mut parts: Vec<Vec<Ring>> = Vec::new();
    let mut part_of: HashMap<usize, usize> = HashMap::new();
    let outer: Vec<usize> = (0..rings.len()).filter(|&k| area[k] > 0.0).collect();
    for &k in &outer {
        part_of.insert(k, parts.len());
        parts.push(vec![rings[k].clone()]);
    }
    for k in (0..rings.len()).filter(|k| !part_of.contains_key(k)) {
        let inside = rings[k].segment(0).point_at(0.5);
        let holds = |&&o: &&usize| bounds[o].contains(inside) && rings[o].winding_number(inside) > 0;
        let around = outer.iter().filter(holds).min_by(|&&a, &&b| area[a].total_cmp(&area[b]));
        if let Some(part) = around.and_then(|o| part_of.get(o)) {
            parts[*part].push(rings[k].clone());
        }
    }
    parts
}

fn path_data(writer: &PathWriter, rings: &[Ring]) -> String {
    let mut data = String::new();
    for ring in rings.iter().filter(|r| r.len() > 1) {
        writer.ring(ring, |i, _, data| write_link(&ring.segment(i), data), &mut data);
    }
    data
}

/// Which part is seen in which states, in the order of their first appearance.
#[derive(Default)]
struct Timeline {
    parts: Vec<(String, Range<usize>)>,
    /// The latest run of states of a part.
    latest: HashMap<String, usize>,
}

impl Timeline {
    /// State `k` shows the part; states come in order.
    fn shows(&mut self, k: usize, data: String) {
        if let Some(&latest) = self.latest.get(&data) {
            let shown = &mut self.parts[latest].1;
            if shown.end >= k {
                shown.end = k + 1;
                return;
            }
        }
        self.latest.insert(data.clone(), self.parts.len());
        self.parts.push((data, k..k + 1));
    }
}

/// When states begin and end.
struct Clock {
    /// Where each state begins, as a fraction of the whole, and 1.
    begins: Vec<f64>,
    seconds: f64,
}

impl Clock {
    fn new(seconds: &[f64]) -> Clock {
        let total: f64 = seconds.iter().sum();
        let mut begins = vec![0.0];
        let mut passed = 0.0;
        for s in seconds {
            passed += s;
            begins.push(if total > 0.0 { (passed / total).min(1.0) } else { 1.0 });
        }
        Clock { begins, seconds: total }
    }

    fn states(&self) -> usize {
        self.begins.len() - 1
    }

    fn is_still(&self, shown: &Range<usize>) -> bool {
        *shown == (0..self.states()) || self.seconds <= 0.0
    }

    /// An element that is seen while `shown` is; where nothing plays, if it is seen at the end.
    fn element(&self, name: &str, attributes: &str, text: &str, shown: &Range<usize>) -> String {
        let hidden = if shown.end == self.states() { "" } else { " visibility=\"hidden\"" };
        let animate = if self.is_still(shown) { String::new() } else { self.animate(shown) };
        if text.is_empty() && animate.is_empty() {
            return format!("<{name}{hidden} {attributes}/>\n");
        }
        format!("<{name}{hidden} {attributes}>{text}{animate}</{name}>\n")
    }

    /// What shows and hides its parent.
    fn animate(&self, shown: &Range<usize>) -> String {
        let (begin, end) = (self.begins[shown.start], self.begins[shown.end]);
        let (mut values, mut times) = (vec!["hidden"], vec![0.0]);
        if shown.start == 0 {
            values[0] = "visible";
        } else {
            values.push("visible");
            times.push(begin);
        }
        if shown.end < self.states() {
            values.push("hidden");
            times.push(end);
        }
        let times: Vec<String> = times.iter().map(|t| short(*t)).collect();
        format!(
            "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"{}\" keyTimes=\"{}\" dur=\"{}s\" \
             repeatCount=\"indefinite\"/>",
            values.join(";"),
            times.join(";"),
            short(self.seconds)
        )
    }
}

/// A number with at most five decimals.
fn short(x: f64) -> String {
    let text = format!("{x:.5}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::svg::{ReadOptions, read};
    use crate::plane::{Point, Vector};
    use usvg::roxmltree::{Document, Node};

    /// A frame with a hole in which a disk stands, and a square beside it.
    const SVG: &str = "<svg viewBox='0 0 40 20'><path fill-rule='evenodd' d='M0 0H20V20H0ZM5 5H15V15H5Z'/>\
                       <circle cx='10' cy='10' r='3'/><rect x='25' y='5' width='8' height='8'/></svg>";

    fn drawing() -> Drawing {
        read(SVG.as_bytes(), &ReadOptions::default()).unwrap()
    }

    /// The drawing with the square that stands beside moved `by` to the right.
    fn moved(drawing: &Drawing, by: f64) -> Region {
        let is_square = |ring: &Ring| ring.bounds().min.x > 21.0;
        let shifted = |ring: &Ring| {
            let mut ring = ring.translated(Vector::new(by, 0.0));
            ring.vertices.iter_mut().for_each(|v| v.id = None);
            ring
        };
        let rings = drawing.region.rings.iter();
        Region::new(rings.map(|r| if is_square(r) && by > 0.0 { shifted(r) } else { r.clone() }).collect())
    }

    fn animated(regions: &[Region], seconds: &[f64]) -> String {
        let still = |(region, &seconds)| Still { region, caption: "0.5 r² <&".to_owned(), seconds };
        let stills: Vec<Still> = regions.iter().zip(seconds).map(still).collect();
        animate(&drawing(), &stills)
    }

    fn elements<'a>(document: &'a Document, name: &str) -> Vec<Node<'a, 'a>> {
        document.descendants().filter(|n| n.has_tag_name(name)).collect()
    }

    #[test]
    fn a_part_that_stays_is_written_once() {
        let drawing = drawing();
        let states: Vec<Region> = [0.0, 1.0, 2.0, 2.0].map(|by| moved(&drawing, by)).to_vec();
        let svg = animated(&states, &[1.0, 1.0, 1.0, 2.0]);
        let document = Document::parse(&svg).unwrap();
        let paths = elements(&document, "path");
        // The frame with its hole, the disk, three places of the square, and the outlines of the drawing.
        assert_eq!(paths.len(), 6, "{svg}");
        let still: Vec<_> = paths.iter().filter(|p| !p.has_children()).collect();
        assert_eq!(still.len(), 3);
        assert!(still.iter().all(|p| p.attribute("visibility").is_none()));
        let hidden = |p: &&Node| p.attribute("visibility") == Some("hidden");
        assert_eq!(paths.iter().filter(hidden).count(), 2, "all but the last are hidden where nothing plays");
        let animate = |p: &Node, name: &str| p.first_element_child().unwrap().attribute(name).unwrap().to_owned();
        let times: Vec<String> = paths.iter().filter(|p| p.has_children()).map(|p| animate(p, "keyTimes")).collect();
        assert_eq!(times, ["0;0.2", "0;0.2;0.4", "0;0.4"]);
        assert_eq!(animate(paths.iter().find(|p| p.has_children()).unwrap(), "values"), "visible;hidden");
        assert_eq!(animate(paths.iter().find(|p| p.has_children()).unwrap(), "dur"), "5s");
        let captions = elements(&document, "text");
        assert_eq!(captions.len(), 4);
        assert!(captions.iter().all(|c| c.text() == Some("0.5 r² <&")));
        assert!(read(svg.as_bytes(), &ReadOptions::default()).is_ok());
    }

    #[test]
    fn one_state_does_not_move() {
        let svg = animated(&[drawing().region], &[1.0]);
        let document = Document::parse(&svg).unwrap();
        assert!(elements(&document, "animate").is_empty());
        assert_eq!(elements(&document, "text")[0].text(), Some("0.5 r² <&"));
        assert!(Document::parse(&animate(&drawing(), &[])).is_ok());
        let nothing = [drawing().region, Region::default()];
        let svg = animated(&nothing, &[1.0, 1.0]);
        let document = Document::parse(&svg).unwrap();
        assert!(elements(&document, "path").iter().filter(|p| p.has_children()).count() == 3);
    }

    #[test]
    fn parts_are_outer_rings_with_their_holes() {
        let mut sizes: Vec<usize> = parts(&drawing().region).iter().map(Vec::len).collect();
        sizes.sort_unstable();
        assert_eq!(sizes, [1, 1, 2]);
        let lonely = Region::new(vec![Ring::circle(Point::origin(), 1.0).reversed()]);
        assert!(parts(&lonely).is_empty());
    }
}
