//! The bytes of one glyph in the table `glyf`: read, stripped of instructions, and made.

use super::contour::{Contour, ContourPoint};
use super::sfnt::{i16_at, put_u16, u16_at};
use crate::plane::{Point, Vector};

/// Bytes before the contours or components: their number and the box.
const HEADER: usize = 10;

// Flags of a point.
const ON_CURVE: u8 = 0x01;
const X_SHORT: u8 = 0x02;
const Y_SHORT: u8 = 0x04;
const REPEAT: u8 = 0x08;
const X_SAME: u8 = 0x10;
const Y_SAME: u8 = 0x20;

// Flags of a component.
const ARGS_ARE_WORDS: u16 = 0x0001;
const ARGS_ARE_XY: u16 = 0x0002;
const HAS_SCALE: u16 = 0x0008;
const MORE_COMPONENTS: u16 = 0x0020;
const HAS_XY_SCALE: u16 = 0x0040;
const HAS_MATRIX: u16 = 0x0080;
const HAS_INSTRUCTIONS: u16 = 0x0100;
const SCALED_OFFSET: u16 = 0x0800;

/// What a glyph is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Glyph {
    /// Nothing: a blank.
    Empty,
    /// Contours of its own.
    Simple(Simple),
    /// Other glyphs.
    Composite(Composite),
}

/// A glyph with contours of its own.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Simple {
    pub contours: Vec<Contour>,
    /// Its bytes without instructions and without padding.
    pub stripped: Vec<u8>,
}

/// A glyph made of others.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Composite {
    pub components: Vec<Component>,
    /// Its bytes without instructions and without the flag that announces them.
    pub stripped: Vec<u8>,
}

/// A glyph put somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Component {
    pub glyph: u16,
    /// Columns of the linear part: the images of the axes.
    axes: [Vector; 2],
    place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Offset(Vector),
    /// Point of what is there already, and point of the component that comes to lie on it.
    Points(usize, usize),
}

impl Component {
    /// Whether it is placed by the numbers of points, which change where outlines do.
    pub fn is_anchored(&self) -> bool {
        matches!(self.place, Place::Points(..))
    }

    /// The contours of the component where they belong, given what stands there already; `None` where a point that it
    /// hangs on is missing.
    pub fn placed(&self, contours: &[Contour], before: &[Contour]) -> Option<Vec<Contour>> {
        let [x, y] = self.axes;
        let linear = |p: Point| Point::from(x * p.x + y * p.y);
        let offset = match self.place {
            Place::Offset(offset) => offset,
            Place::Points(there, here) => {
                let anchor = before.iter().flatten().nth(there)?.point;
                anchor - linear(contours.iter().flatten().nth(here)?.point)
            }
        };
        let moved = |p: &ContourPoint| ContourPoint { point: linear(p.point) + offset, ..*p };
        Some(contours.iter().map(|contour| contour.iter().map(moved).collect()).collect())
    }
}

/// Reads the bytes of a glyph.
///
/// # Errors
/// What is wrong with them.
pub(super) fn parse(data: &[u8]) -> Result<Glyph, &'static str> {
    if data.is_empty() {
        return Ok(Glyph::Empty);
    }
    const CUT: &str = "its data is cut off";
    let count = i16_at(data, 0).filter(|_| data.len() >= HEADER).ok_or(CUT)?;
    match usize::try_from(count) {
        Ok(0) => Ok(Glyph::Empty),
        Ok(count) => simple(data, count).ok_or(CUT).map(Glyph::Simple),
        Err(_) => composite(data).ok_or(CUT).map(Glyph::Composite),
    }
}

fn simple(data: &[u8], count: usize) -> Option<Simple> {
    let ends: Option<Vec<usize>> = (0..count).map(|k| u16_at(data, HEADER + 2 * k).map(usize::from)).collect();
    let ends = ends.filter(|ends| ends.is_sorted())?;
    let points = ends.last()? + 1;
    let length_at = HEADER + 2 * count;
    let body = length_at + 2 + usize::from(u16_at(data, length_at)?);
    let mut flags = Vec::with_capacity(points);
    let mut at = body;
    while flags.len() < points {
        let flag = *data.get(at)?;
        at += 1;
        let mut times = 1;
        if flag & REPEAT != 0 {
            times += usize::from(*data.get(at)?);
            at += 1;
        }
        flags.resize((flags.len() + times).min(points), flag);
    }
    let mut axis = |short: u8, same: u8| -> Option<Vec<i32>> {
        let mut value = 0;
        let mut values = Vec::with_capacity(points);
        for flag in &flags {
            if flag & short != 0 {
                let step = i32::from(*data.get(at)?);
                at += 1;
                value += if flag & same != 0 { step } else { -step };
            } else if flag & same == 0 {
                value += i32::from(i16_at(data, at)?);
                at += 2;
            }
            values.push(value);
        }
        Some(values)
    };
    let (xs, ys) = (axis(X_SHORT, X_SAME)?, axis(Y_SHORT, Y_SAME)?);
    let mut contours = Vec::with_capacity(count);
    let mut first = 0;
    for end in ends {
        let contour = (first..=end).map(|k| ContourPoint {
            point: Point::new(f64::from(xs[k]), f64::from(ys[k])),
            on_curve: flags[k] & ON_CURVE != 0,
        });
        contours.push(contour.collect());
        first = end + 1;
    }
    let stripped = [&data[..length_at], &[0, 0], &data[body..at]].concat();
    Some(Simple { contours, stripped })
}

fn composite(data: &[u8]) -> Option<Composite> {
    let mut stripped = data.get(..HEADER)?.to_vec();
    let mut components = Vec::new();
    let mut at = HEADER;
    loop {
        let start = at;
        let (flags, glyph) = (u16_at(data, at)?, u16_at(data, at + 2)?);
        at += 4;
        let signed = flags & ARGS_ARE_XY != 0;
        let mut argument = || -> Option<i32> {
            let word = flags & ARGS_ARE_WORDS != 0;
            let value = match (word, signed) {
                (true, true) => i32::from(i16_at(data, at)?),
                (true, false) => i32::from(u16_at(data, at)?),
                (false, true) => i32::from(*data.get(at)? as i8),
                (false, false) => i32::from(*data.get(at)?),
            };
            at += if word { 2 } else { 1 };
            Some(value)
        };
        let (a, b) = (argument()?, argument()?);
        let mut number = || {
            at += 2;
            i16_at(data, at - 2).map(|x| f64::from(x) / 16384.0)
        };
        let axes = if flags & HAS_SCALE != 0 {
            let s = number()?;
            [Vector::new(s, 0.0), Vector::new(0.0, s)]
        } else if flags & HAS_XY_SCALE != 0 {
            [Vector::new(number()?, 0.0), Vector::new(0.0, number()?)]
        } else if flags & HAS_MATRIX != 0 {
            [Vector::new(number()?, number()?), Vector::new(number()?, number()?)]
        } else {
            [Vector::x(), Vector::y()]
        };
        let place = if signed {
            let (x, y) = (f64::from(a), f64::from(b));
            // Apple's way, where the flag asks for it: the offset is scaled, too.
            let scaled = flags & SCALED_OFFSET != 0;
            Place::Offset(if scaled { Vector::new(x * axes[0].norm(), y * axes[1].norm()) } else { Vector::new(x, y) })
        } else {
            Place::Points(a as usize, b as usize)
        };
        components.push(Component { glyph, axes, place });
        stripped.extend((flags & !HAS_INSTRUCTIONS).to_be_bytes());
        stripped.extend(data.get(start + 2..at)?);
        if flags & MORE_COMPONENTS == 0 {
            return Some(Composite { components, stripped });
        }
    }
}

/// The smallest box of whole units around the points of `contours`: x min, y min, x max, y max; zeros without points.
pub(super) fn whole_box(contours: &[Contour]) -> [i16; 4] {
    let points = || contours.iter().flatten().map(|p| p.point);
    if points().next().is_none() {
        return [0; 4];
    }
    let low = |f: fn(Point) -> f64| points().map(f).fold(f64::INFINITY, f64::min).floor() as i16;
    let high = |f: fn(Point) -> f64| points().map(f).fold(f64::NEG_INFINITY, f64::max).ceil() as i16;
    [low(|p| p.x), low(|p| p.y), high(|p| p.x), high(|p| p.y)]
}

/// Replaces the box in the header of a glyph.
pub(super) fn put_box(data: &mut [u8], bounds: [i16; 4]) {
    for (k, side) in bounds.into_iter().enumerate() {
        put_u16(data, 2 + 2 * k, side as u16);
    }
}

/// The bytes of a glyph of contours whose coordinates are whole; `None` where numbers exceed what the format can hold.
pub(super) fn encode(contours: &[Contour]) -> Option<Vec<u8>> {
    if contours.is_empty() {
        return Some(Vec::new());
    }
    let mut data = i16::try_from(contours.len()).ok()?.to_be_bytes().to_vec();
    data.extend([0; 8]);
    put_box(&mut data, whole_box(contours));
    let mut end = 0usize;
    for contour in contours {
        end += contour.len();
        data.extend(u16::try_from(end.checked_sub(1)?).ok()?.to_be_bytes());
    }
    data.extend([0, 0]);
    let mut flags: Vec<u8> = Vec::new();
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    let mut from = [0i32; 2];
    for p in contours.iter().flatten() {
        let to = [p.point.x as i32, p.point.y as i32];
        let x = encode_step(to[0].checked_sub(from[0])?, X_SHORT, X_SAME, &mut xs)?;
        let y = encode_step(to[1].checked_sub(from[1])?, Y_SHORT, Y_SAME, &mut ys)?;
        flags.push(x | y | if p.on_curve { ON_CURVE } else { 0 });
        from = to;
    }
    for run in flags.chunk_by(|a, b| a == b) {
        for part in run.chunks(256) {
            match part.len() {
                1 => data.push(part[0]),
                n => data.extend([part[0] | REPEAT, (n - 1) as u8]),
            }
        }
    }
    data.extend(xs);
    data.extend(ys);
    Some(data)
}

/// Writes a difference of coordinates in the shortest way; the flags that tell which.
fn encode_step(step: i32, short: u8, same: u8, bytes: &mut Vec<u8>) -> Option<u8> {
    if step == 0 {
        return Some(same);
    }
    if let Ok(size) = u8::try_from(step.unsigned_abs()) {
        bytes.push(size);
        return Some(short | if step > 0 { same } else { 0 });
    }
    bytes.extend(i16::try_from(step).ok()?.to_be_bytes());
    Some(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contours() -> Vec<Contour> {
        let far = |k: i32| ContourPoint {
            point: Point::new(f64::from(k * 37 % 700), f64::from(-k * k)),
            on_curve: k % 3 != 0,
        };
        vec![(0..9).map(far).collect(), (40..43).map(far).collect()]
    }

    #[test]
    fn a_glyph_that_is_written_is_read_again() {
        let data = encode(&contours()).unwrap();
        let Glyph::Simple(read) = parse(&data).unwrap() else { panic!("simple") };
        assert_eq!(read.contours, contours());
        assert_eq!(read.stripped, data);
        assert_eq!(parse(&[]), Ok(Glyph::Empty));
    }

    #[test]
    fn instructions_go_and_all_else_stays() {
        let data = encode(&contours()).unwrap();
        let at = HEADER + 4;
        let hinted = [&data[..at], &[0, 3, 1, 2, 3], &data[at + 2..], &[0]].concat();
        let Glyph::Simple(read) = parse(&hinted).unwrap() else { panic!("simple") };
        assert_eq!(read.stripped, data);
    }

    #[test]
    fn cut_data_is_an_error_whatever_its_length() {
        let data = encode(&contours()).unwrap();
        for length in 1..data.len() {
            assert!(parse(&data[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn components_are_placed_by_offset_scale_and_points() {
        // Two components: half as large and shifted by (10, -20); and with its point 0 on point 1 of what is there.
        let mut data = (-1i16).to_be_bytes().to_vec();
        data.extend([0; 8]);
        let words: [u16; 5] =
            [HAS_INSTRUCTIONS | MORE_COMPONENTS | HAS_SCALE | ARGS_ARE_XY | ARGS_ARE_WORDS, 5, 10, 65516, 0x2000];
        words.iter().for_each(|w| data.extend(w.to_be_bytes()));
        data.extend([0, 0, 0, 6, 1, 0, 0, 2, 7, 7]);
        let Glyph::Composite(read) = parse(&data).unwrap() else { panic!("composite") };
        assert_eq!(read.components.iter().map(|c| c.glyph).collect::<Vec<_>>(), [5, 6]);
        let shape = |points: &[(f64, f64)]| -> Vec<Contour> {
            vec![points.iter().map(|&(x, y)| ContourPoint { point: Point::new(x, y), on_curve: true }).collect()]
        };
        let first = read.components[0].placed(&shape(&[(4.0, 8.0), (0.0, 2.0)]), &[]).unwrap();
        assert_eq!(first, shape(&[(12.0, -16.0), (10.0, -19.0)]));
        let second = read.components[1].placed(&shape(&[(1.0, 1.0), (2.0, 2.0)]), &first).unwrap();
        assert_eq!(second, shape(&[(10.0, -19.0), (11.0, -18.0)]));
        assert_eq!(read.components[1].placed(&shape(&[(1.0, 1.0)]), &[]), None);
        // The instructions and their flag are gone, the rest is as it was.
        assert_eq!(read.stripped.len(), data.len() - 4);
        assert_eq!(read.stripped[10], 0);
        let Glyph::Composite(again) = parse(&read.stripped).unwrap() else { panic!("composite") };
        assert_eq!(again.components, read.components);
    }

    #[test]
    fn steps_beyond_the_format_are_refused() {
        let p = |x: f64| ContourPoint { point: Point::new(x, 0.0), on_curve: true };
        assert_eq!(encode(&[vec![p(-20_000.0), p(20_000.0)]]), None);
        // Components of components can put points anywhere.
        assert_eq!(encode(&[vec![p(-1e300), p(1e300)]]), None);
        assert_eq!(encode(&[vec![]]), None);
    }
}
