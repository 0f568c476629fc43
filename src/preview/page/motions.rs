//! The programs as the script takes them: motions with their times.

use super::text::{number, quoted};
use super::{Page, PageProgram};
use crate::cam::{MotionKind, Point3, motion_seconds, statistics};
use crate::plane::{Bounds, Link, Region};

/// Decimals of places, millimetres: a tenth of a micrometre.
const DECIMALS: usize = 4;

/// Decimals of times, seconds. The time of a motion's end is written, so that rounding does not add up.
const TIME_DECIMALS: usize = 4;

/// What a motion is, in the data.
const RAPID: u8 = 0;
const LINE: u8 = 1;
const ARC: u8 = 2;
const WAIT: u8 = 3;
/// What no motion makes: the program goes on from a place that was not known.
const JUMP: u8 = 4;

/// All programs, as a JSON array.
pub(super) fn json(page: &Page) -> String {
    let programs: Vec<String> = page.programs.iter().enumerate().map(|(k, p)| program(page, k, p)).collect();
    format!("[{}]", programs.join(",\n"))
}

fn program(page: &Page, index: usize, shown: &PageProgram) -> String {
    let program = shown.program;
    let mut end = 0.0;
    let mut place: Option<Point3> = None;
    let mut tool = None;
    let mut motions = Vec::with_capacity(program.motions.len());
    let mut changes = Vec::new();
    for (motion, seconds) in program.motions.iter().zip(motion_seconds(program, &shown.machine)) {
        if place != Some(motion.from) {
            motions.push(row(end, motion.line, JUMP, motion.from, ""));
        }
        if tool != Some(motion.tool) {
            tool = Some(motion.tool);
            changes.push(format!("[{},{}]", motions.len(), motion.tool));
        }
        end += seconds;
        let sweep: f64 = motion.trace().map(|s| s.sweep()).sum();
        let (kind, more) = match motion.kind {
            MotionKind::Rapid => (RAPID, String::new()),
            MotionKind::Feed { .. } => (LINE, String::new()),
            MotionKind::Dwell { .. } => (WAIT, String::new()),
            // An arc without length is none.
            MotionKind::Arc { .. } if sweep == 0.0 => (LINE, String::new()),
            MotionKind::Arc { center, turn, .. } => {
                let [x, y] = [center.x, center.y].map(|v| number(v, DECIMALS));
                (ARC, format!(",{x},{y},{}", number(turn.sign() * sweep, 6)))
            }
        };
        motions.push(row(end, motion.line, kind, motion.to, &more));
        place = Some(motion.to);
    }
    let tools: Vec<String> = shown
        .tools
        .iter()
        .map(|t| {
            format!(
                "{{\"number\":{},\"name\":{},\"diameter\":{}}}",
                t.number,
                quoted(&t.name),
                number(t.diameter, DECIMALS)
            )
        })
        .collect();
    let marks: Vec<String> = page
        .differences
        .iter()
        .enumerate()
        .filter(|(_, d)| d.program == index)
        .filter_map(|(k, d)| d.at.map(|p| format!("[{},{},{}]", k + 1, number(p.x, DECIMALS), number(p.y, DECIMALS))))
        .collect();
    let b = bounds(shown);
    format!(
        "{{\"box\":[{},{},{},{}],\"top\":{},\"depth\":{},\"tools\":[{}],\"changes\":[{}],\"marks\":[{}],\"outlines\":[{}],\n\"motions\":[{}]}}",
        number(b.min.x, DECIMALS),
        number(b.min.y, DECIMALS),
        number(b.max.x, DECIMALS),
        number(b.max.y, DECIMALS),
        number(shown.stock_top, DECIMALS),
        number(statistics(program, shown.stock_top).depth_mm, DECIMALS),
        tools.join(","),
        changes.join(","),
        marks.join(","),
        shown.outlines.iter().map(|r| quoted(&path(r))).collect::<Vec<_>>().join(","),
        motions.join(",\n")
    )
}

fn row(end: f64, line: usize, kind: u8, to: Point3, more: &str) -> String {
    let [x, y, z] = [to.x, to.y, to.z].map(|v| number(v, DECIMALS));
    format!("[{},{line},{kind},{x},{y},{z}{more}]", number(end, TIME_DECIMALS))
}

/// What must be seen: outlines, and what the tools sweep in the stock. Rapids may leave the picture.
fn bounds(shown: &PageProgram) -> Bounds {
    let outlines = shown.outlines.iter().fold(Bounds::EMPTY, |b, r| b.union(r.bounds()));
    let radius = shown.tools.iter().map(|t| 0.5 * t.diameter).filter(|r| r.is_finite()).fold(0.0, f64::max);
    let path = |only_cuts: bool| {
        let motions = shown.program.motions.iter().filter(|m| !only_cuts || m.is_in_stock(shown.stock_top));
        motions.fold(Bounds::EMPTY, |b, m| m.trace().fold(b.with_point(m.to.xy()), |b, s| b.union(s.bounds())))
    };
    let cut = path(true);
    let all = outlines.union(if cut.is_empty() { cut } else { cut.inflated(radius) });
    if all.is_empty() { path(false) } else { all }
}

/// A region as the data of an SVG path, y upward.
fn path(region: &Region) -> String {
    let mut data = String::new();
    let xy = |x: f64, y: f64| format!("{} {}", number(x, DECIMALS), number(y, DECIMALS));
    for ring in &region.rings {
        for (k, s) in ring.segments().enumerate() {
            if k == 0 {
                data += &format!("M{}", xy(s.start.x, s.start.y));
            }
            data += &match s.link {
                Link::Line => format!("L{}", xy(s.end.x, s.end.y)),
                Link::Arc(arc) => {
                    let r = number(arc.radius, DECIMALS);
                    let large = u8::from(s.sweep() > std::f64::consts::PI);
                    let left = u8::from(arc.turn.sign() > 0.0);
                    format!("A{r} {r} 0 {large} {left} {}", xy(s.end.x, s.end.y))
                }
            };
        }
        data.push('Z');
    }
    data
}
