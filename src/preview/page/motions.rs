//! The programs as the script takes them: motions with their times.

use super::text::{number, quoted};
use super::{Outline, Page, PageProgram, PageTool};
use crate::cam::{MotionKind, Point3, motion_seconds, statistics};
use crate::plane::{Bounds, Link, Region};

/// Decimals of places, millimetres: a tenth of a micrometre.
const DECIMALS: usize = 4;

/// Decimals of times, seconds. The time of a motion's end is written, so that rounding does not add up.
const TIME_DECIMALS: usize = 4;

/// Decimals of angles, radians: a micrometre on a circle of a metre.
const ANGLE_DECIMALS: usize = 6;

/// What a motion is, in the data.
const RAPID: u8 = 0;
const LINE: u8 = 1;
const ARC: u8 = 2;
const WAIT: u8 = 3;
/// What no motion makes: the program goes on from a place that was not known.
const JUMP: u8 = 4;

/// All programs, one after the other, as a JSON object.
pub(super) fn json(page: &Page) -> String {
    let mut track = Track::default();
    page.programs.iter().for_each(|p| track.run(p));
    let numbers = |values: &[f64]| values.iter().map(|v| number(*v, DECIMALS)).collect::<Vec<_>>().join(",");
    let b = bounds(page);
    let depths = page.programs.iter().map(|p| statistics(p.program, page.stock_top).depth_mm);
    let marks = page.differences.iter().enumerate().flat_map(|(k, d)| d.places.iter().map(move |p| (k + 1, p)));
    let marks: Vec<String> = marks.map(|(k, p)| format!("[{k},{}]", numbers(&[p.x, p.y]))).collect();
    let outline = |o: &Outline| format!("[{},{}]", u8::from(o.remains), quoted(&path(&o.region)));
    let outlines: Vec<String> = page.outlines.iter().map(outline).collect();
    let parts = [
        format!("\"box\":[{}]", numbers(&[b.min.x, b.min.y, b.max.x, b.max.y])),
        format!("\"top\":{}", numbers(&[page.stock_top])),
        format!("\"depth\":{}", numbers(&[depths.fold(0.0, f64::max)])),
        format!("\"programs\":[{}]", track.programs.join(",")),
        format!("\"tools\":[{}]", track.tools.join(",")),
        format!("\"changes\":[{}]", track.changes.join(",")),
        format!("\"marks\":[{}]", marks.join(",")),
        format!("\"outlines\":[{}]", outlines.join(",")),
        format!("\"motions\":[{}]", track.motions.join(",\n")),
    ];
    format!("{{{}}}", parts.join(",\n"))
}

/// Motions one after the other, as JSON.
#[derive(Default)]
struct Track {
    /// When the last motion ends.
    end: f64,
    motions: Vec<String>,
    /// The first motion of each program, and its name.
    programs: Vec<String>,
    tools: Vec<String>,
    /// From which motion on which tool is in the spindle, as an index.
    changes: Vec<String>,
}

impl Track {
    fn run(&mut self, shown: &PageProgram) {
        let program = shown.program;
        let first_tool = self.tools.len();
        let tool = |t: &PageTool| {
            let [diameter, tip, widening] = [t.diameter, t.tip, t.widening].map(|v| number(v, DECIMALS));
            let name = quoted(&t.name);
            format!("{{\"name\":{name},\"diameter\":{diameter},\"tip\":{tip},\"widening\":{widening}}}")
        };
        self.tools.extend(shown.tools.iter().map(tool));
        self.programs.push(format!("[{},{}]", self.motions.len(), quoted(&shown.name)));
        let mut place: Option<Point3> = None;
        let mut tool = None;
        for (motion, seconds) in program.motions.iter().zip(motion_seconds(program, &shown.machine)) {
            if tool != Some(motion.tool) {
                tool = Some(motion.tool);
                let index = shown.tools.iter().position(|t| t.number == motion.tool).unwrap_or(0);
                self.changes.push(format!("[{},{}]", self.motions.len(), first_tool + index));
            }
            if place != Some(motion.from) {
                self.motions.push(row(self.end, motion.line, JUMP, motion.from, ""));
            }
            self.end += seconds;
            let sweep: f64 = motion.trace().map(|s| s.sweep()).sum();
            let (kind, more) = match motion.kind {
                MotionKind::Rapid => (RAPID, String::new()),
                MotionKind::Feed { .. } => (LINE, String::new()),
                MotionKind::Dwell { .. } => (WAIT, String::new()),
                // An arc without length is none.
                MotionKind::Arc { .. } if sweep == 0.0 => (LINE, String::new()),
                MotionKind::Arc { center, turn, .. } => {
                    let [x, y] = [center.x, center.y].map(|v| number(v, DECIMALS));
                    (ARC, format!(",{x},{y},{}", number(turn.sign() * sweep, ANGLE_DECIMALS)))
                }
            };
            self.motions.push(row(self.end, motion.line, kind, motion.to, &more));
            place = Some(motion.to);
        }
    }
}

fn row(end: f64, line: usize, kind: u8, to: Point3, more: &str) -> String {
    let [x, y, z] = [to.x, to.y, to.z].map(|v| number(v, DECIMALS));
    format!("[{},{line},{kind},{x},{y},{z}{more}]", number(end, TIME_DECIMALS))
}

/// What must be seen: outlines, and what the tools sweep in the stock. Rapids may leave the picture.
fn bounds(page: &Page) -> Bounds {
    let outlines = page.outlines.iter().fold(Bounds::EMPTY, |b, o| b.union(o.region.bounds()));
    let path = |shown: &PageProgram, only_cuts: bool| {
        let motions = shown.program.motions.iter().filter(|m| !only_cuts || m.is_in_stock(page.stock_top));
        motions.fold(Bounds::EMPTY, |b, m| m.trace().fold(b.with_point(m.to.xy()), |b, s| b.union(s.bounds())))
    };
    let cuts = page.programs.iter().map(|p| {
        let radius = p.tools.iter().map(|t| 0.5 * t.diameter).filter(|r| r.is_finite()).fold(0.0, f64::max);
        let cut = path(p, true);
        if cut.is_empty() { cut } else { cut.inflated(radius) }
    });
    let all = cuts.fold(outlines, |b, cut| b.union(cut));
    if all.is_empty() { page.programs.iter().fold(all, |b, p| b.union(path(p, false))) } else { all }
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
