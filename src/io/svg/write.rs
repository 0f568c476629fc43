//! Regions back to SVG, with the commands of the file where they did not change.
//!
//! A number is written with the fewest digits that read back as the same `f64`. A curve is written as its own command
//! where the region still has all its samples in order and nothing else between them, forwards or (for a ring turned
//! round) backwards. Where only some samples are left, each run of them is written as the part of the curve between
//! its ends: a single command with control points of its own. The arcs that remain are `A` commands.
//!
//! So what is written strays from the region, whose links are the chords, by at most
//! [`Drawing::chord_tolerance`], and is as near to the curves of the file as rounding allows. Of a drawing that was read
//! as polygons ([`Curves::Polygon`]) the vertices are written, and no curves.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::fmt::Write as _;

use crate::plane::{Link, Point, Region, Ring, Segment, Vertex, VertexId};

use super::drawing::{Curve, CurveKind, Drawing};
use super::options::Curves;
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

/// Writes rings of a drawing as path data.
pub(super) struct PathWriter<'a> {
    drawing: &'a Drawing,
    /// The curves by the vertices where they start and where they end; none where vertices alone are written.
    starting: HashMap<VertexId, Vec<u32>>,
    ending: HashMap<VertexId, Vec<u32>>,
}

/// A stretch of a ring that follows a curve, sample by sample.
#[derive(Clone, Copy)]
struct Run<'a> {
    curve: &'a Curve,
    /// The numbers of the samples where it starts and ends: they fall where it runs backwards.
    from: u32,
    to: u32,
}

impl Run<'_> {
    fn length(&self) -> usize {
        self.from.abs_diff(self.to) as usize
    }

    fn is_whole(&self) -> bool {
        self.length() == self.curve.last() as usize
    }
}

impl<'a> PathWriter<'a> {
    pub(super) fn new(drawing: &'a Drawing) -> PathWriter<'a> {
        let mut starting: HashMap<VertexId, Vec<u32>> = HashMap::new();
        let mut ending: HashMap<VertexId, Vec<u32>> = HashMap::new();
        if drawing.curves != Curves::Polygon {
            for (index, curve) in drawing.sources.curves.iter().enumerate() {
                starting.entry(curve.from).or_default().push(index as u32);
                ending.entry(curve.to).or_default().push(index as u32);
            }
        }
        PathWriter { drawing, starting, ending }
    }

    /// Adds a ring of two vertices or more to the data.
    pub(super) fn ring(&self, ring: &Ring, data: &mut String) {
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
            if let Some(run) = self.longest_run(ring, first, k)
                && self.run(run, |samples| at(k + samples).point, data)
            {
                k += run.length();
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

    /// Writes the curve or the part of it; `point` is the vertex that many samples along. Whether it can be written.
    fn run(&self, run: Run, point: impl Fn(usize) -> Point, data: &mut String) -> bool {
        let Run { curve, from, to } = run;
        let backwards = to < from;
        // A part of an ellipse near half a turn is written in two, as arcs are.
        let parts = match curve.kind {
            CurveKind::Elliptic { angle, .. } if !run.is_whole() => {
                let angle = angle * run.length() as f64 / f64::from(curve.steps);
                ((angle / LARGEST_ARC).ceil() as usize).clamp(1, run.length())
            }
            _ => 1,
        };
        let mut done = 0;
        for part in 1..=parts {
            let next = run.length() * part / parts;
            let sample = |along: usize| if backwards { from - along as u32 } else { from + along as u32 };
            let (i, j) = (sample(done).min(sample(next)), sample(done).max(sample(next)));
            let kind = if run.is_whole() { Some(curve.kind) } else { curve.part(&self.drawing.sources, i, j) };
            let Some(kind) = kind else { return false };
            write_curve(if backwards { kind.reversed() } else { kind }, point(next), data);
            done = next;
        }
        true
    }

    /// The longest stretch of a curve that the ring follows from its vertex `k` on (counted from `first`).
    fn longest_run(&self, ring: &Ring, first: usize, k: usize) -> Option<Run<'a>> {
        let n = ring.len();
        let id = ring.vertices[(first + k) % n].id?;
        let curves = &self.drawing.sources.curves;
        let listed = |map: &HashMap<VertexId, Vec<u32>>| map.get(&id).cloned().unwrap_or_default();
        let starting = listed(&self.starting).into_iter().map(|c| (c, 0, false));
        let ending = listed(&self.ending).into_iter().map(|c| (c, curves[c as usize].last(), true));
        let inner = self.drawing.sources.vertex(id).and_then(|v| v.sample).filter(|_| !self.starting.is_empty());
        let inner = inner.into_iter().flat_map(|(c, k)| [(c, k, false), (c, k, true)]);
        let runs = starting.chain(ending).chain(inner).filter_map(|(number, from, backwards)| {
            let curve = curves.get(number as usize)?;
            let length = followed(curve, from, backwards, |j| &ring.vertices[(first + k + j) % n], n - k);
            let to = if backwards { from - length } else { from + length };
            let run = Run { curve, from, to };
            (length > 0 && (run.is_whole() || curve.has_parts())).then_some(run)
        });
        // Of equals the first.
        runs.reduce(|a, b| if b.length() > a.length() { b } else { a })
    }
}

/// How many samples of `curve`, from number `from` on, the vertices follow: at most `limit`.
fn followed<'v>(curve: &Curve, from: u32, backwards: bool, at: impl Fn(usize) -> &'v Vertex, limit: usize) -> u32 {
    let link = match curve.kind {
        CurveKind::Elliptic { arc: Some(arc), .. } => Link::Arc(arc),
        _ => Link::Line,
    };
    let link = if backwards { link.reversed() } else { link };
    let left = if backwards { from } else { curve.last().saturating_sub(from) };
    let goes_on = |&j: &u32| {
        let next = if backwards { from - j } else { from + j };
        j as usize <= limit && at(j as usize - 1).link == link && at(j as usize).id == Some(curve.sample(next))
    };
    (1..=left).take_while(goes_on).count() as u32
}

fn write_curve(kind: CurveKind, to: Point, data: &mut String) {
    let _ = match kind {
        CurveKind::Quadratic(c) => write!(data, "Q{} {}", Pair(c), Pair(to)),
        CurveKind::Cubic(c, d) => write!(data, "C{} {} {}", Pair(c), Pair(d), Pair(to)),
        CurveKind::Elliptic { radii: (rx, ry), rotation, angle, sweep, .. } => {
            let (large, sweep) = (u8::from(angle > PI), u8::from(sweep));
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

    /// The drawing's region with the sample in the middle of each curve moved off it.
    fn with_moved_samples(drawing: &Drawing) -> Region {
        let middles: Vec<VertexId> =
            drawing.sources.curves.iter().filter(|c| c.inner > 0).map(|c| c.sample(c.last() / 2)).collect();
        let mut region = drawing.region.clone();
        for v in region.rings.iter_mut().flat_map(|r| &mut r.vertices) {
            if v.id.is_some_and(|id| middles.contains(&id)) {
                *v = Vertex { id: None, point: v.point + crate::plane::Vector::new(1e-3, 1e-3), ..*v };
            }
        }
        region
    }

    const CURVES: &str = "M0 4C1 5 3 5 4 4Q5 2 4 0A3 2.5 10 0 0 0 0.1Z";

    #[test]
    fn a_curve_with_a_moved_sample_is_written_as_its_two_parts() {
        // Clockwise and counterclockwise, so that the parts are written in both directions.
        for path in [CURVES, "M0 4L0 0.1A3 2.5 10 0 1 4 0Q5 2 4 4C3 5 1 5 0 4Z"] {
            let (drawing, _) = path_data(path);
            let region = with_moved_samples(&drawing);
            let written = write(&drawing, &region);
            let count = |c| written.split(" d=\"").nth(1).unwrap().matches(c).count();
            // Two chords at each moved sample, and the closing line is the Z or a line.
            assert_eq!((count('C'), count('Q'), count('A')), (2, 2, 2), "{written}");
            assert!((6..=7).contains(&count('L')), "{written}");
            // The parts are the curves: their samples are found again, each bit of them.
            let again = crate::io::svg::read_alike(written.as_bytes(), &ReadOptions::default(), &drawing).unwrap();
            let points: Vec<Point> = again.region.rings.iter().flat_map(|r| &r.vertices).map(|v| v.point).collect();
            assert_eq!(points.len(), region.vertex_count());
            assert!(region.rings[0].vertices.iter().all(|v| points.contains(&v.point)));
            // Sampled by themselves, too, they stray no farther than chords may.
            let alone = read(written.as_bytes(), &ReadOptions::default()).unwrap();
            let index = crate::plane::BoundaryIndex::new(&region);
            let samples = alone.region.rings.iter().flat_map(|r| &r.vertices).map(|v| index.distance(v.point));
            let worst = samples.fold(0.0, f64::max);
            assert!(worst <= drawing.chord_tolerance, "{worst}");
        }
    }

    #[test]
    fn a_part_of_an_ellipse_near_half_a_turn_is_written_in_two() {
        let (drawing, _) = path_data("M0 4A4 2 0 0 1 8 4Z");
        let mut region = drawing.region.clone();
        let last = drawing.sources.curves[0].sample(drawing.sources.curves[0].inner);
        region.rings[0].vertices.retain(|v| v.id != Some(last));
        let written = write(&drawing, &region);
        assert_eq!(written.matches('A').count(), 2, "{written}");
        let again = read(written.as_bytes(), &ReadOptions::default()).unwrap();
        let step = PI / f64::from(drawing.sources.curves[0].steps);
        assert!((again.region.area() - region.area()).abs() < step * step, "{written}");
    }

    #[test]
    fn of_polygons_the_vertices_are_written() {
        let text = format!("<svg viewBox='0 0 9 9'><path d='{CURVES}'/><circle cx='7' cy='7' r='1'/></svg>");
        let options = ReadOptions { curves: Curves::Polygon, ..ReadOptions::default() };
        let drawing = read(text.as_bytes(), &options).unwrap();
        let written = write(&drawing, &drawing.region);
        let data = written.split(" d=\"").nth(1).unwrap();
        assert!(!data.contains(['C', 'Q', 'A']));
        let again = read(written.as_bytes(), &options).unwrap();
        let points =
            |d: &Drawing| -> Vec<Point> { d.region.rings.iter().flat_map(|r| &r.vertices).map(|v| v.point).collect() };
        let (first, second) = (points(&drawing), points(&again));
        assert_eq!(first.len(), second.len());
        assert!(first.iter().all(|p| second.contains(p)));
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
