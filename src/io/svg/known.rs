//! Curves of a drawing that another drawing may have parts of.
//!
//! What is written of a curve that was cut is a curve of its own, and sampled by itself it would have other samples: two
//! drawings of the same curve could then be told apart by as much as chords stray from it. So the parts are recognised,
//! by their ends (samples of the curve) and by their control points.

use std::collections::HashMap;

use crate::plane::Point;

use super::drawing::{CurveKind, Drawing, Sources};

/// How unlike the numbers of two elliptic arcs may be, relative, that are one: degrees and radians are converted on the
/// way, and centre and angles computed from the ends. Bézier curves have to agree to the last bit.
const ALIKE: f64 = 1e-9;

/// So many samples are known at one place: more are copies of each other, and looking through them takes time.
const MAX_AT_A_PLACE: usize = 16;

/// The curves of a drawing, to be met again in another.
#[derive(Debug)]
pub(in crate::io) struct Known<'a> {
    sources: &'a Sources,
    /// Number of the curve and of the sample for every place.
    samples: HashMap<(u64, u64), Vec<(u32, u32)>>,
}

impl Known<'_> {
    pub fn new(drawing: &Drawing) -> Known<'_> {
        let sources = &drawing.sources;
        let mut samples: HashMap<_, Vec<_>> = HashMap::new();
        for (number, curve) in sources.curves.iter().enumerate().filter(|(_, curve)| curve.has_parts()) {
            for k in 0..=curve.last() {
                if let Some(v) = sources.vertex(curve.sample(k)) {
                    let here = samples.entry(bits(v.point)).or_default();
                    if here.len() < MAX_AT_A_PLACE {
                        here.push((number as u32, k));
                    }
                }
            }
        }
        Known { sources, samples }
    }

    /// The samples between the ends of a curve that is a part of a known one, or all of it, in either direction.
    pub fn samples(&self, from: Point, kind: &CurveKind, to: Point) -> Option<Vec<Point>> {
        let (starts, ends) = (self.samples.get(&bits(from))?, self.samples.get(&bits(to))?);
        let pairs = starts.iter().flat_map(|s| ends.iter().map(move |e| (s, e)));
        pairs.filter(|((c, i), (d, j))| c == d && i != j).find_map(|(&(number, i), &(_, j))| {
            let curve = self.sources.curves.get(number as usize)?;
            let part = curve.part(self.sources, i.min(j), i.max(j))?;
            if !is_same(kind, &if i < j { part } else { part.reversed() }) {
                return None;
            }
            let between: Vec<u32> = if i < j { (i + 1..j).collect() } else { (j + 1..i).rev().collect() };
            between.into_iter().map(|k| self.sources.vertex(curve.sample(k)).map(|v| v.point)).collect()
        })
    }
}

/// The place, with one zero.
fn bits(p: Point) -> (u64, u64) {
    ((p.x + 0.0).to_bits(), (p.y + 0.0).to_bits())
}

fn is_same(a: &CurveKind, b: &CurveKind) -> bool {
    use CurveKind::{Cubic, Elliptic, Quadratic};
    let near = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.abs().max(b.abs());
    match (a, b) {
        (Quadratic(_), Quadratic(_)) | (Cubic(..), Cubic(..)) => a == b,
        (
            Elliptic { radii: r, rotation: d, angle: a, sweep: s, .. },
            Elliptic { radii: q, rotation: e, angle: b, sweep: t, .. },
        ) => s == t && near(r.0, q.0) && near(r.1, q.1) && near(*d, *e) && near(*a, *b),
        _ => false,
    }
}
