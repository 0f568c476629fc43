//! Regions back to SVG, with the commands of the file where they did not change.
//!
//! A number is written with the fewest digits that read back as the same `f64`. A curve is written as its own command
//! where the region still has all its samples in order and nothing else between them, forwards or (for a ring turned
//! round) backwards; the arcs that remain are `A` commands.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::fmt::Write as _;

use crate::plane::{Link, Point, Region, Ring, Segment, VertexId};

use super::drawing::{Curve, CurveKind, Drawing};
use super::viewport::Page;

/// Arcs beyond this angle, in radians, are written in two halves: near half a turn the end points of an `A` command fix
/// its centre badly.
const LARGEST_ARC: f64 = 0.8 * PI;

/// The region as an SVG file with the drawing's page and user units.
pub fn write(drawing: &Drawing, region: &Region) -> String {
    let writer = PathWriter::new(drawing);
    let mut data = String::new();
    for ring in region.rings.iter().filter(|r| r.len() > 1) {
        if !data.is_empty() {
            data.push('\n');
        }
        writer.ring(ring, &mut data);
    }
    let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\"");
    let Page { width, height, view_box, preserve_aspect_ratio } = &drawing.page;
    let attributes =
        [("width", width), ("height", height), ("viewBox", view_box), ("preserveAspectRatio", preserve_aspect_ratio)];
    for (name, value) in attributes {
        if let Some(value) = value {
            let value = value.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
            let _ = write!(svg, " {name}=\"{value}\"");
        }
    }
    let _ = write!(svg, ">\n<path fill-rule=\"evenodd\" d=\"{data}\"/>\n</svg>\n");
    svg
}

struct PathWriter<'a> {
    drawing: &'a Drawing,
    /// The curves by the vertices where they start and where they end.
    starting: HashMap<VertexId, Vec<u32>>,
    ending: HashMap<VertexId, Vec<u32>>,
}

impl<'a> PathWriter<'a> {
    fn new(drawing: &'a Drawing) -> PathWriter<'a> {
        let mut starting: HashMap<VertexId, Vec<u32>> = HashMap::new();
        let mut ending: HashMap<VertexId, Vec<u32>> = HashMap::new();
        for (index, curve) in drawing.sources.curves.iter().enumerate() {
            starting.entry(curve.from).or_default().push(index as u32);
            ending.entry(curve.to).or_default().push(index as u32);
        }
        PathWriter { drawing, starting, ending }
    }

    fn ring(&self, ring: &Ring, data: &mut String) {
        // Start where a command does, or a curve that runs over the start would be torn.
        let n = ring.len();
        let is_end = |k: usize| {
            let source = ring.vertices[k].id.and_then(|id| self.drawing.sources.vertex(id));
            source.is_none_or(|s| s.sample.is_none())
        };
        let first = (0..n).find(|&k| is_end(k)).unwrap_or(0);
        let at = |k: usize| &ring.vertices[(first + k) % n];
        let _ = write!(data, "M{}", Pair(at(0).point));
        let mut k = 0;
        while k < n {
            if let Some((curve, backwards)) = self.whole_curve(ring, first, k) {
                write_curve(curve, backwards, at(k + curve.inner as usize + 1).point, data);
                k += curve.inner as usize + 1;
                continue;
            }
            let segment = ring.segment((first + k) % n);
            // The closing line is the Z.
            if segment.link != Link::Line || k + 1 < n {
                write_link(&segment, data);
            }
            k += 1;
        }
        data.push('Z');
    }

    /// The curve that the ring follows, sample by sample, from its vertex `k` on (counted from `first`).
    fn whole_curve(&self, ring: &Ring, first: usize, k: usize) -> Option<(&'a Curve, bool)> {
        let n = ring.len();
        let at = |k: usize| &ring.vertices[(first + k) % n];
        let id = at(k).id?;
        let candidates = |map: &HashMap<VertexId, Vec<u32>>| map.get(&id).cloned().unwrap_or_default();
        let forwards = candidates(&self.starting).into_iter().map(|c| (c, false));
        let backwards = candidates(&self.ending).into_iter().map(|c| (c, true));
        forwards.chain(backwards).find_map(|(number, backwards)| {
            let curve = &self.drawing.sources.curves[number as usize];
            let (inner, target) = (curve.inner as usize, if backwards { curve.from } else { curve.to });
            let link = match curve.kind {
                CurveKind::Elliptic { arc: Some(arc), .. } => Link::Arc(arc),
                _ => Link::Line,
            };
            let link = if backwards { link.reversed() } else { link };
            let sample = |j: usize| {
                let place = if backwards { inner - j } else { j - 1 };
                VertexId::from_index(curve.first_inner as usize + place)
            };
            let whole = k + inner < n
                && (0..=inner).all(|j| at(k + j).link == link)
                && (1..=inner).all(|j| at(k + j).id == Some(sample(j)))
                && at(k + inner + 1).id == Some(target);
            whole.then_some((curve, backwards))
        })
    }
}

fn write_curve(curve: &Curve, backwards: bool, to: Point, data: &mut String) {
    let _ = match curve.kind {
        CurveKind::Quadratic(c) => write!(data, "Q{} {}", Pair(c), Pair(to)),
        CurveKind::Cubic(c, d) if backwards => write!(data, "C{} {} {}", Pair(d), Pair(c), Pair(to)),
        CurveKind::Cubic(c, d) => write!(data, "C{} {} {}", Pair(c), Pair(d), Pair(to)),
        CurveKind::Elliptic { radii: (rx, ry), rotation, large_arc, sweep, .. } => {
            let (large, sweep) = (u8::from(large_arc), u8::from(sweep != backwards));
            write!(data, "A{} {} {} {large} {sweep} {}", rx, ry, plain(rotation), Pair(to))
        }
    };
}

fn write_link(segment: &Segment, data: &mut String) {
    let Link::Arc(arc) = segment.link else {
        let _ = write!(data, "L{}", Pair(segment.end));
        return;
    };
    let sweep = segment.sweep();
    // Counterclockwise with y up is counterclockwise on the page: SVG's sweep flag 0.
    let flag = u8::from(arc.turn == crate::plane::Turn::Right);
    let parts = (sweep / LARGEST_ARC).ceil().max(1.0) as usize;
    for part in 1..=parts {
        let to = segment.point_at(part as f64 / parts as f64);
        let _ = write!(data, "A{} {} 0 0 {flag} {}", arc.radius, arc.radius, Pair(to));
    }
}

/// A point in the file's coordinates.
struct Pair(Point);

impl std::fmt::Display for Pair {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", plain(self.0.x), plain(-self.0.y))
    }
}

/// The number without a minus on zero.
fn plain(x: f64) -> f64 {
    x + 0.0
}

#[cfg(test)]
mod tests {
    use crate::io::svg::{ReadOptions, read};
    use crate::plane::{Joint, Vertex};

    use super::*;

    fn path_data(d: &str) -> (Drawing, String) {
        let text = format!("<svg viewBox='0 0 9 9'><path d='{d}'/></svg>");
        let drawing = read(text.as_bytes(), &ReadOptions::default()).unwrap();
        let written = write(&drawing, &drawing.region);
        let d = written.split(" d=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        (drawing, d)
    }

    #[test]
    fn kept_commands_are_written_as_they_were_or_turned_round() {
        // Clockwise on the page is clockwise with y up: an outer ring is turned round.
        let (_, d) = path_data("M0 4C1 5 3 5 4 4Q5 2 4 0A2 2 0 0 0 0 0.1Z");
        assert_eq!(d, "M0 4C1 5 3 5 4 4Q5 2 4 0A2.000624902374256 2.000624902374256 0 0 0 0 0.1Z");
        let (_, d) = path_data("M0 4Q2 4.5 4 4L4 0C3 -1 1 -1 0 0.1Z");
        assert_eq!(d, "M0 4Q2 4.5 4 4L4 0C3 -1 1 -1 0 0.1Z");
        let (_, d) = path_data("M0 4L0 0.1C1 -1 3 -1 4 0L4 4Q2 4.5 0 4Z");
        assert_eq!(d, "M4 4L4 0C3 -1 1 -1 0 0.1L0 4Q2 4.5 4 4Z");
    }

    #[test]
    fn a_curve_with_a_moved_sample_is_written_as_links() {
        let (drawing, d) = path_data("M0 4Q2 4.5 4 4L4 0L0 0Z");
        assert!(d.contains('Q'));
        let mut region = drawing.region.clone();
        let moved = region.rings[0].vertices.iter_mut().find(|v| v.joint == Joint::Smooth).unwrap();
        *moved = Vertex { id: None, ..*moved };
        assert!(!write(&drawing, &region).contains('Q'));
    }

    #[test]
    fn arcs_near_half_a_turn_are_written_in_two() {
        let text = "<svg viewBox='0 0 9 9'><circle cx='4' cy='4' r='2'/></svg>";
        let drawing = read(text.as_bytes(), &ReadOptions::default()).unwrap();
        let mut region = drawing.region.clone();
        // Half circles without identity.
        region.rings[0].vertices =
            region.rings[0].vertices.iter().step_by(2).map(|v| Vertex { id: None, ..*v }).collect();
        let written = write(&drawing, &region);
        assert_eq!(written.matches('A').count(), 4);
        let again = read(written.as_bytes(), &ReadOptions::default()).unwrap();
        assert!((again.region.area() - 4.0 * PI).abs() < 1e-14);
        assert!(!written.contains("-0 ") && !written.contains("-0A"));
    }
}
