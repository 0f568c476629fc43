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

use crate::plane::{Link, Point, Region, Ring, Segment, Stretched, Turn, Vertex, VertexId};

use super::drawing::{Curve, CurveKind, Drawing};
use super::options::Curves;
use super::parts::Parts;
use super::viewport::Page;

/// Arcs beyond this angle, in radians, are written in two halves: near half a turn the end points of an `A` command fix
/// its centre badly.
const LARGEST_ARC: f64 = 0.8 * PI;

/// The region as an SVG file with the drawing's page and user units.
pub fn write(drawing: &Drawing, region: &Region) -> String {
    let mut svg = opening(&drawing.page);
    path(None, &data(drawing, region, None), &mut svg);
    svg + "</svg>\n"
}

/// A drawing in parts as an SVG file, with `region` in place of what is chosen and every other part as it is, each a path
/// of its own under the names that it has. Where `stretched` is given it is in the frame of that, and its arcs become
/// arcs of ellipses.
pub fn write_parts(parts: &Parts, region: &Region, stretched: Option<&Stretched>) -> String {
    let mut svg = opening(&parts.chosen().page);
    let mut open: &[String] = &[];
    for (k, part) in parts.parts.iter().enumerate() {
        let shared = open.iter().zip(&part.groups).take_while(|(a, b)| a == b).count();
        svg += &"</g>\n".repeat(open.len() - shared);
        for group in &part.groups[shared..] {
            let _ = writeln!(svg, "<g id=\"{}\">", escaped(group));
        }
        open = &part.groups;
        let drawing = &part.drawing;
        let data =
            if k == parts.chosen { data(drawing, region, stretched) } else { data(drawing, &drawing.region, None) };
        path(part.id.as_deref(), &data, &mut svg);
    }
    svg + &"</g>\n".repeat(open.len()) + "</svg>\n"
}

fn opening(page: &Page) -> String {
    let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\"");
    let Page { width, height, view_box, preserve_aspect_ratio } = page;
    let attributes =
        [("width", width), ("height", height), ("viewBox", view_box), ("preserveAspectRatio", preserve_aspect_ratio)];
    for (name, value) in attributes {
        if let Some(value) = value {
            let _ = write!(svg, " {name}=\"{}\"", escaped(value));
        }
    }
    svg + ">\n"
}

fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn path(id: Option<&str>, data: &str, svg: &mut String) {
    let id = id.map_or(String::new(), |id| format!(" id=\"{}\"", escaped(id)));
    let _ = writeln!(svg, "<path{id} fill-rule=\"evenodd\" d=\"{data}\"/>");
}

/// The path data of a region of a drawing.
fn data(drawing: &Drawing, region: &Region, stretched: Option<&Stretched>) -> String {
    let writer = PathWriter::new(drawing);
    let mut data = String::new();
    for ring in region.rings.iter().filter(|r| r.len() > 1) {
        if !data.is_empty() {
            data.push('\n');
        }
        match stretched {
            None => writer.ring(ring, |i, _, data| write_link(&ring.segment(i), data), &mut data),
            Some(stretched) => {
                let vertices = ring.vertices.iter().map(|v| stretched.restored(v)).collect();
                let link = |i: usize, to: Point, data: &mut String| {
                    write_stretched(&ring.segment(i), to, stretched, data);
                };
                writer.ring(&Ring { vertices }, link, &mut data);
            }
        }
    }
    data
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

    /// Writes a ring; `link` writes the element that leaves the vertex of that number, to the given end.
    pub(super) fn ring(&self, ring: &Ring, link: impl Fn(usize, Point, &mut String), data: &mut String) {
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
            // The closing line is the Z.
            if at(k).link != Link::Line || k + 1 < n {
                link((first + k) % n, at(k + 1).point, data);
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

pub(super) fn write_link(segment: &Segment, data: &mut String) {
    let Link::Arc(arc) = segment.link else {
        let _ = write!(data, "L{}", Pair(segment.end));
        return;
    };
    let flag = sweep_flag(arc.turn);
    for to in arc_ends(segment) {
        let _ = write!(data, "A{} {} 0 0 {flag} {}", arc.radius, arc.radius, Pair(to));
    }
}

/// Writes an element of the frame of `stretched` that ends at `to` outside of it.
fn write_stretched(segment: &Segment, to: Point, stretched: &Stretched, data: &mut String) {
    let Link::Arc(arc) = segment.link else {
        let _ = write!(data, "L{}", Pair(to));
        return;
    };
    let stretch = stretched.stretch();
    let (flag, second) = (sweep_flag(arc.turn), arc.radius / stretch.aspect());
    // Clockwise in a file is counterclockwise with y up.
    let rotation = plain(-stretch.degrees());
    let mut ends = arc_ends(segment).peekable();
    while let Some(end) = ends.next() {
        let end = if ends.peek().is_some() { stretched.out_of_frame(end) } else { to };
        let _ = write!(data, "A{} {second} {rotation} 0 {flag} {}", arc.radius, Pair(end));
    }
}

/// Counterclockwise with y up is counterclockwise on the page: SVG's sweep flag 0.
fn sweep_flag(turn: Turn) -> u8 {
    u8::from(turn == Turn::Right)
}

/// Where the parts end in which an arc is written.
fn arc_ends(segment: &Segment) -> impl Iterator<Item = Point> {
    let parts = (segment.sweep() / LARGEST_ARC).ceil().max(1.0) as usize;
    // Computed along one direction of the two: where an arc bounds one part and the gap in another, the same points.
    let is_left = matches!(segment.link, Link::Arc(arc) if arc.turn == Turn::Left);
    let clockwise = if is_left { segment.reversed() } else { *segment };
    let end = segment.end;
    (1..=parts).map(move |part| {
        let along = if is_left { parts - part } else { part };
        if part == parts { end } else { clockwise.point_at(along as f64 / parts as f64) }
    })
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
mod tests;
