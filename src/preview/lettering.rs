//! A small alphabet of strokes, so that pictures need no font.
//!
//! Glyphs are written on a grid where small letters are 4 high, digits and ascenders 6, descenders reach -2. `M x y`
//! lifts the pen, `L x y` draws a line, `A cx cy r from to` draws an arc (degrees, counterclockwise where `to` is
//! larger), joined to what was drawn before it unless `M` precedes it directly.

use crate::plane::{Point, Vector};

/// Height of digits and ascenders in units of the grid.
pub(super) const CAP_HEIGHT: f64 = 6.0;

/// Room between two glyphs.
const GAP: f64 = 1.5;

/// Width of a blank.
const BLANK: f64 = 2.2;

/// Degrees between the points of an arc.
const ARC_STEP: f64 = 15.0;

fn strokes(glyph: char) -> &'static str {
    match glyph {
        'a' => "A 2 2 2 0 360 M 4 4 L 4 0",
        'b' => "M 0 6 L 0 0 M A 2 2 2 0 360",
        'c' => "A 2 2 2 45 315",
        'd' => "A 2 2 2 0 360 M 4 6 L 4 0",
        'e' => "M 0 2 L 4 2 A 2 2 2 0 310",
        'f' => "M 0.8 0 L 0.8 4.6 A 2.2 4.6 1.4 180 80 M 0 4 L 2.2 4",
        'g' => "A 2 2 2 0 360 M 4 4 L 4 -0.1 A 2 -0.1 2 0 -145",
        'h' => "M 0 6 L 0 0 M 0 2 A 2 2 2 180 0 L 4 0",
        'i' => "M 0 4 L 0 0 M 0 5.6 L 0 5.8",
        'j' => "M 1 4 L 1 -1 A 0 -1 1 0 -90 M 1 5.6 L 1 5.8",
        'k' => "M 0 6 L 0 0 M 3.2 4 L 0 1.3 M 1.3 2.4 L 3.4 0",
        'l' => "M 0 6 L 0 1 A 1 1 1 180 270",
        'm' => "M 0 4 L 0 0 M 0 2.5 A 1.5 2.5 1.5 180 0 L 3 0 M 3 2.5 A 4.5 2.5 1.5 180 0 L 6 0",
        'n' => "M 0 4 L 0 0 M 0 2 A 2 2 2 180 0 L 4 0",
        'o' => "A 2 2 2 0 360",
        'p' => "M 0 4 L 0 -2 M A 2 2 2 0 360",
        'q' => "A 2 2 2 0 360 M 4 4 L 4 -2",
        'r' => "M 0 4 L 0 0 M 0 2 A 2 2 2 180 70",
        's' => "A 1.5 3 1 35 270 A 1.5 1 1 90 -145",
        't' => "M 0.9 5.5 L 0.9 1.1 A 2 1.1 1.1 180 285 M 0 4 L 2.2 4",
        'u' => "M 0 4 L 0 2 A 2 2 2 180 360 M 4 4 L 4 0",
        'v' => "M 0 4 L 1.8 0 L 3.6 4",
        'w' => "M 0 4 L 1.4 0 L 2.8 4 L 4.2 0 L 5.6 4",
        'x' => "M 0 4 L 3.4 0 M 0 0 L 3.4 4",
        'y' => "M 0 4 L 1.9 0 M 3.8 4 L 1.2 -2",
        'z' => "M 0 4 L 3.2 4 L 0 0 L 3.2 0",
        '0' => "M 4 4 A 2 4 2 0 180 L 0 2 A 2 2 2 180 360 L 4 4",
        '1' => "M 0 4.7 L 1.7 6 L 1.7 0",
        '2' => "A 2 4 2 165 -38 L 0 0 L 4 0",
        '3' => "A 1.9 4.5 1.5 150 -90 A 1.9 1.5 1.5 90 -150",
        '4' => "M 3 0 L 3 6 L 0 1.7 L 4.1 1.7",
        '5' => "M 3.5 6 L 0.8 6 L 0.44 3.12 A 1.9 1.9 1.9 140 -140",
        '6' => "M 2.2 6 L 0.36 2.85 A 2 1.9 1.9 150 510",
        '7' => "M 0 6 L 3.8 6 L 1.3 0",
        '8' => "A 2 4.55 1.45 0 360 M A 2 1.55 1.55 0 360",
        '9' => "M 1.8 0 L 3.64 3.15 A 2 4.1 1.9 -30 330",
        '.' => "M 0 0 L 0 0.2",
        ',' => "M 0.3 0.2 L 0 -1",
        ':' => "M 0 0.4 L 0 0.6 M 0 3.4 L 0 3.6",
        '-' => "M 0 2.3 L 2.4 2.3",
        '+' => "M 0 2.3 L 3 2.3 M 1.5 0.8 L 1.5 3.8",
        '/' => "M 0 -0.6 L 2.4 6.4",
        '(' => "A 4.2 2.5 4.2 130 230",
        ')' => "A -2.6 2.5 4.2 50 -50",
        '²' => "A 0.8 5.8 0.8 160 -40 L 0 4 L 1.7 4",
        _ => "",
    }
}

/// The lines of `text` in units of the grid, its baseline starting at the origin, and its width.
pub(super) fn layout(text: &str) -> (Vec<Vec<Point>>, f64) {
    let mut lines = Vec::new();
    let mut x = 0.0;
    for c in text.chars() {
        let glyph = lines_of(strokes(c));
        let points = || glyph.iter().flatten();
        if points().next().is_none() {
            x += BLANK;
            continue;
        }
        let left = points().map(|p: &Point| p.x).fold(f64::INFINITY, f64::min);
        let right = points().map(|p: &Point| p.x).fold(f64::NEG_INFINITY, f64::max);
        let shift = Vector::new(x - left, 0.0);
        lines.extend(glyph.iter().map(|line| line.iter().map(|p| p + shift).collect::<Vec<_>>()));
        x += right - left + GAP;
    }
    (lines, (x - GAP).max(0.0))
}

fn lines_of(strokes: &str) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = Vec::new();
    let mut is_lifted = true;
    let mut words = strokes.split(' ').peekable();
    while let Some(command) = words.next() {
        let mut numbers = [0.0; 5];
        let mut count = 0;
        while let Some(number) = words.peek().and_then(|w| w.parse::<f64>().ok()) {
            if count < numbers.len() {
                numbers[count] = number;
                count += 1;
            }
            words.next();
        }
        let mut draw = |p: Point| {
            if std::mem::take(&mut is_lifted) {
                lines.push(Vec::new());
            }
            if let Some(line) = lines.last_mut() {
                line.push(p);
            }
        };
        let [a, b, radius, from, to] = numbers;
        match command {
            "M" => {
                is_lifted = true;
                if count == 2 {
                    lines.push(vec![Point::new(a, b)]);
                    is_lifted = false;
                }
            }
            "L" => draw(Point::new(a, b)),
            "A" => {
                let steps = ((to - from).abs() / ARC_STEP).ceil().max(1.0);
                for k in 0..=steps as usize {
                    let angle = (from + (to - from) * k as f64 / steps).to_radians();
                    draw(Point::new(a + radius * angle.cos(), b + radius * angle.sin()));
                }
            }
            _ => {}
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_glyphs_have_strokes_within_the_grid() {
        for c in "abcdefghijklmnopqrstuvwxyz0123456789.,:-+/()²".chars() {
            let (lines, width) = layout(&c.to_string());
            assert!(!lines.is_empty() && (0.0..=6.0).contains(&width), "{c}: {width}");
            for p in lines.iter().flatten() {
                assert!((-2.2..=6.9).contains(&p.y), "{c}: {p}");
            }
        }
        assert!(layout("12 mm").1 > layout("12mm").1);
        assert_eq!(layout("").1, 0.0);
    }
}
