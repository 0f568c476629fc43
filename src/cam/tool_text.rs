//! Tools in words: as programs carry them in comments, and as they are typed.

use std::fmt;
use std::str::FromStr;

use super::tool::{Tool, ToolShape};
use crate::units::{DrawingScale, Length};

/// The angle of the point of drills for wood, plastics and metals alike, in degrees.
const DRILL_ANGLE: f64 = 118.0;

/// Longest comment about a tool, in characters: the shortest line of a controller less brackets. A longer name is cut off.
const LONGEST_COMMENT: usize = 76;

/// Decimals of lengths and angles in comments, in millimetres and degrees: nanometres, more than any tool is known to.
const DECIMALS: usize = 6;

/// Cutting edges of tools of which only shape and diameter are known: what most routers' bits have.
const USUAL_FLUTES: u32 = 2;

/// Why a text describes no tool.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{text}\" is no tool: write its number, its shape and its diameter, for example \"T1=flat 3.175mm\", \"2=ball 6mm\", \
     \"3=v60 6mm\", \"3=v60 6mm tip 0.2mm\" or \"4=drill 3mm\""
)]
pub struct ParseToolError {
    text: String,
}

impl Tool {
    /// A tool of which only shape and diameter are known.
    pub fn new(number: u32, shape: ToolShape, diameter: f64) -> Tool {
        let name = String::new();
        Tool { number, name, shape, is_drill: false, diameter, flutes: USUAL_FLUTES, flute_length: f64::INFINITY }
    }

    /// What a program says of the tool in a comment, without brackets: [`Tool::from_comment`] reads it back.
    ///
    /// `tool 1 "6 mm end mill" flat diameter 6 mm`, `tool 2 "v" cone angle 60 deg tip 0 mm diameter 6 mm`, `tool 3 "" drill cone
    /// angle 118 deg tip 0 mm diameter 3 mm`. Edges are not told. What a comment cannot hold is replaced in the name, which
    /// is cut off where the line would be too long for a controller.
    pub fn comment(&self) -> String {
        let shape = match self.shape {
            ToolShape::Flat => "flat".to_owned(),
            ToolShape::Ball => "ball".to_owned(),
            ToolShape::Cone { angle, tip_diameter } => {
                format!("cone angle {} deg tip {} mm", Decimal(angle.to_degrees()), Decimal(tip_diameter))
            }
        };
        let drill = if self.is_drill { "drill " } else { "" };
        let start = format!("tool {} \"", self.number);
        let end = format!("\" {drill}{shape} diameter {} mm", Decimal(self.diameter));
        let room = LONGEST_COMMENT.saturating_sub(start.len() + end.len());
        let name: String = self.name.chars().map(harmless).take(room).collect();
        format!("{start}{}{end}", name.trim_end())
    }

    /// The tool that a comment written as [`Tool::comment`] says describes; `None` where it does not.
    pub fn from_comment(text: &str) -> Option<Tool> {
        let (number, rest) = text.trim().strip_prefix("tool ")?.split_once(" \"")?;
        let (name, rest) = rest.rsplit_once('"')?;
        let mut words = rest.split_whitespace().peekable();
        let is_drill = words.next_if_eq(&"drill").is_some();
        let shape = match words.next()? {
            "flat" => ToolShape::Flat,
            "ball" => ToolShape::Ball,
            "cone" => {
                let angle = quantity(&mut words, "angle", "deg")?.to_radians();
                ToolShape::Cone { angle, tip_diameter: quantity(&mut words, "tip", "mm")? }
            }
            _ => return None,
        };
        let diameter = quantity(&mut words, "diameter", "mm")?;
        let tool = Tool { name: name.to_owned(), is_drill, ..Tool::new(number.parse().ok()?, shape, diameter) };
        (words.next().is_none() && tool.is_possible()).then_some(tool)
    }

    /// The tool that a line of another program's tool list describes, as many posts write it:
    /// `T1 D=6. CR=0. - ZMIN=-3. - flat end mill`; lengths are in units of `millimetres`.
    pub fn from_tool_list(text: &str, millimetres: f64) -> Option<Tool> {
        let lower = text.trim().to_ascii_lowercase();
        let mut words = lower.split_whitespace();
        let number = words.next()?.strip_prefix('t')?.parse().ok()?;
        let value = |key: &str| -> Option<f64> {
            let text = lower.split_whitespace().find_map(|w| w.strip_prefix(key))?;
            text.trim_end_matches("deg").parse().ok()
        };
        let diameter = value("d=")? * millimetres;
        let taper = value("taper=").filter(|t| *t > 0.0);
        let corner = value("cr=").unwrap_or(0.0) * millimetres;
        let is_drill = lower.contains("drill");
        let shape = match () {
            // The taper is the angle to the axis, except for drills, whose point has its whole angle there.
            () if is_drill => cone(taper.unwrap_or(DRILL_ANGLE), 0.0),
            () if taper.is_some() => cone(2.0 * taper?, 0.0),
            () if lower.contains("ball") => ToolShape::Ball,
            // A rounded corner has no shape here; a flat one takes more than it, which is the safe side for the part.
            () if corner < 0.5 * diameter => ToolShape::Flat,
            () => ToolShape::Ball,
        };
        let tool = Tool { is_drill, ..Tool::new(number, shape, diameter) };
        tool.is_possible().then_some(tool)
    }

    /// What people call the tool: its name, or what is known of its shape.
    pub fn title(&self) -> String {
        if !self.name.is_empty() {
            return self.name.clone();
        }
        let diameter = Decimal(self.diameter);
        match self.shape {
            ToolShape::Cone { angle, .. } if self.is_drill => {
                format!("drill {diameter} mm, {} deg", Decimal(angle.to_degrees()))
            }
            _ if self.is_drill => format!("drill {diameter} mm"),
            ToolShape::Flat => format!("flat {diameter} mm"),
            ToolShape::Ball => format!("ball {diameter} mm"),
            ToolShape::Cone { angle, tip_diameter } => {
                let tip =
                    if tip_diameter > 0.0 { format!(", tip {} mm", Decimal(tip_diameter)) } else { String::new() };
                format!("v{} {diameter} mm{tip}", Decimal(angle.to_degrees()))
            }
        }
    }

    /// Whether its measures are those of a thing.
    fn is_possible(&self) -> bool {
        let shape_is = match self.shape {
            ToolShape::Flat | ToolShape::Ball => true,
            ToolShape::Cone { angle, tip_diameter } => {
                angle > 0.0 && angle < std::f64::consts::PI && (0.0..=self.diameter).contains(&tip_diameter)
            }
        };
        self.diameter.is_finite() && self.diameter > 0.0 && shape_is
    }
}

/// A typed tool: `T1=flat 3.175mm`.
impl FromStr for Tool {
    type Err = ParseToolError;

    fn from_str(text: &str) -> Result<Tool, ParseToolError> {
        typed(text).filter(Tool::is_possible).ok_or_else(|| ParseToolError { text: text.to_owned() })
    }
}

fn typed(text: &str) -> Option<Tool> {
    let (number, rest) = text.split_once('=')?;
    let number = number.trim().trim_start_matches(['t', 'T']).parse().ok()?;
    let lower = rest.to_ascii_lowercase();
    let mut words = lower.split_whitespace();
    let shape = words.next()?;
    // "3.175 mm" as well as "3.175mm".
    let lengths = words.collect::<Vec<_>>().join("");
    let (diameter, tip) = match lengths.split_once("tip") {
        Some((diameter, tip)) => (millimetres(diameter)?, millimetres(tip)?),
        None => (millimetres(&lengths)?, 0.0),
    };
    let angle_after = |prefix: &str| shape.strip_prefix(prefix)?.parse::<f64>().ok();
    let tool = match shape {
        "flat" => Tool::new(number, ToolShape::Flat, diameter),
        "ball" => Tool::new(number, ToolShape::Ball, diameter),
        "drill" => Tool { is_drill: true, ..Tool::new(number, cone(DRILL_ANGLE, tip), diameter) },
        _ => match (angle_after("v"), angle_after("drill")) {
            (Some(angle), _) => Tool::new(number, cone(angle, tip), diameter),
            (_, Some(angle)) => Tool { is_drill: true, ..Tool::new(number, cone(angle, tip), diameter) },
            _ => return None,
        },
    };
    (tip == 0.0 || matches!(tool.shape, ToolShape::Cone { .. })).then_some(tool)
}

/// A typed length; those relative to a drawing are none.
fn millimetres(text: &str) -> Option<f64> {
    let no_drawing = DrawingScale { mm_per_unit: None, diagonal: 0.0 };
    text.parse::<Length>().ok()?.to_millimetres(&no_drawing).ok().filter(|_| !text.ends_with('%'))
}

fn cone(degrees: f64, tip_diameter: f64) -> ToolShape {
    ToolShape::Cone { angle: degrees.to_radians(), tip_diameter }
}

/// The number between a word and a unit.
fn quantity<'a>(words: &mut impl Iterator<Item = &'a str>, name: &str, unit: &str) -> Option<f64> {
    let is_named = words.next()? == name;
    let value = words.next()?.parse().ok()?;
    (is_named && words.next()? == unit).then_some(value)
}

/// What a comment in brackets can hold, and no quotes, which end the name.
fn harmless(c: char) -> char {
    match c {
        '(' => '[',
        ')' => ']',
        '"' => '\'',
        '!' | '~' | '?' | '%' | '$' | ';' => '_',
        c if c.is_ascii_graphic() => c,
        c if c.is_whitespace() => ' ',
        _ => '_',
    }
}

/// A number without needless zeros.
struct Decimal(f64);

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.DECIMALS$}", self.0);
        f.write_str(text.trim_end_matches('0').trim_end_matches('.'))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn named(name: &str, tool: Tool) -> Tool {
        Tool { name: name.to_owned(), ..tool }
    }

    #[test]
    fn comments_are_as_documented() {
        let mill = named("6 mm end mill", Tool::new(1, ToolShape::Flat, 6.0));
        assert_eq!(mill.comment(), "tool 1 \"6 mm end mill\" flat diameter 6 mm");
        let drill = Tool { is_drill: true, ..Tool::new(3, cone(118.0, 0.0), 3.175) };
        assert_eq!(drill.comment(), "tool 3 \"\" drill cone angle 118 deg tip 0 mm diameter 3.175 mm");
        assert_eq!(Tool::from_comment("tool 1 flat diameter 6 mm"), None);
        assert_eq!(Tool::from_comment("tool 1 \"\" flat diameter 0 mm"), None);
        assert_eq!(Tool::from_comment("tool 1 \"\" flat diameter 6 in"), None);
        assert_eq!(Tool::from_comment("tool diameter 3.175 mm"), None);
    }

    #[test]
    fn typed_tools_are_understood() {
        let read = |text: &str| text.parse::<Tool>().unwrap();
        assert_eq!(read("T1=flat 3.175mm"), Tool::new(1, ToolShape::Flat, 3.175));
        assert_eq!(read("1 = FLAT 1/8in"), Tool::new(1, ToolShape::Flat, 3.175));
        assert_eq!(read("2=ball 6 mm"), Tool::new(2, ToolShape::Ball, 6.0));
        assert_eq!(read("2=v60 6mm"), Tool::new(2, cone(60.0, 0.0), 6.0));
        assert_eq!(read("2=v90 6mm tip 0.2 mm"), Tool::new(2, cone(90.0, 0.2), 6.0));
        assert_eq!(read("0=drill135 3"), Tool { is_drill: true, ..Tool::new(0, cone(135.0, 0.0), 3.0) });
        for text in
            ["", "flat 6mm", "T1=flat", "T1=flat 0mm", "T1=flat 5%", "T1=v180 6mm", "T1=cube 6mm", "-1=flat 6mm"]
        {
            assert!(text.parse::<Tool>().is_err(), "{text} should be refused");
        }
        assert!("1=v60 6mm tip 7mm".parse::<Tool>().is_err(), "the tip is wider than the tool");
        assert!("1=flat 6mm tip 1mm".parse::<Tool>().is_err());
    }

    #[test]
    fn tool_lists_of_other_programs_are_understood() {
        let read = |text: &str| Tool::from_tool_list(text, 1.0);
        assert_eq!(read("T1 D=6. CR=0. - ZMIN=-3. - flat end mill"), Some(Tool::new(1, ToolShape::Flat, 6.0)));
        assert_eq!(read("T12 D=6 CR=3 - ZMIN=-3 - ball end mill"), Some(Tool::new(12, ToolShape::Ball, 6.0)));
        assert_eq!(
            read("T2 D=10 CR=0 TAPER=45deg - ZMIN=-1 - chamfer mill"),
            Some(Tool::new(2, cone(90.0, 0.0), 10.0))
        );
        let drill = Tool { is_drill: true, ..Tool::new(3, cone(118.0, 0.0), 3.0) };
        assert_eq!(read("T3 D=3 CR=0 TAPER=118deg - ZMIN=-9 - drill"), Some(drill));
        assert_eq!(Tool::from_tool_list("T1 D=0.25 CR=0", 25.4), Some(Tool::new(1, ToolShape::Flat, 6.35)));
        assert_eq!(read("T1 is the small one"), None);
        assert_eq!(read("TOOL D=6"), None);
    }

    proptest! {
        #[test]
        fn a_comment_is_read_back(
            number in 0u32..1000,
            name in ".{0,60}",
            kind in 0u8..4,
            diameter in 1u32..50_000,
            tip in 0u32..1000,
            angle in 1u32..1799,
        ) {
            let diameter = f64::from(diameter) / 1000.0;
            let tip = (f64::from(tip) / 1000.0).min(diameter);
            let shape = match kind {
                0 => ToolShape::Flat,
                1 => ToolShape::Ball,
                _ => cone(f64::from(angle) / 10.0, tip),
            };
            let tool = Tool { is_drill: kind == 3, ..named(&name, Tool::new(number, shape, diameter)) };
            let comment = tool.comment();
            prop_assert!(comment.len() <= LONGEST_COMMENT, "{comment}");
            prop_assert!(comment.is_ascii() && !comment.contains(['(', ')']));
            let back = Tool::from_comment(&comment).unwrap();
            prop_assert_eq!((back.number, back.shape, back.diameter, back.is_drill),
                (number, shape, diameter, kind == 3));
            // What is read back says the same again.
            prop_assert_eq!(back.comment(), comment);
        }
    }
}
