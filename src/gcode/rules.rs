//! The rules that programs are held against, as one table.
//!
//! GRBL's are those of version 1.1 with its error numbers, LinuxCNC's those of its interpreter 2.9, both measured. A
//! rule that neither controller enforces is our own: what keeps cutters, work and fingers whole.

use std::fmt;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The program depends on something that it does not say, or is unusual.
    Warning,
    /// A controller refuses the program, or the machine does harm.
    Error,
}

/// One rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RuleInfo {
    /// Which rule this is.
    pub rule: Rule,
    /// Its name in reports.
    pub name: &'static str,
    /// How bad it is to break it.
    pub severity: Severity,
    /// The error number by which GRBL 1.1 refuses a line that breaks it.
    pub grbl_error: Option<u8>,
    /// Whether LinuxCNC's interpreter refuses it.
    pub linuxcnc_refuses: bool,
    /// Whether what the program means is lost, so that it cannot be simulated.
    pub meaning_lost: bool,
    /// What it says, for people.
    pub meaning: &'static str,
}

macro_rules! rules {
    ($($variant:ident $name:literal $severity:ident grbl $grbl:tt linuxcnc $linuxcnc:tt $meaning_lost:tt $meaning:literal;)*) => {
        /// The name of a rule.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Rule {
            $(#[doc = $meaning] $variant,)*
        }

        /// All rules, in the order of [`Rule`].
        pub const RULES: &[RuleInfo] = &[
            $(RuleInfo {
                rule: Rule::$variant,
                name: $name,
                severity: Severity::$severity,
                grbl_error: rules!(@grbl $grbl),
                linuxcnc_refuses: rules!(@linuxcnc $linuxcnc),
                meaning_lost: rules!(@lost $meaning_lost),
                meaning: $meaning,
            },)*
        ];
    };
    (@grbl ok) => { None };
    (@grbl $number:literal) => { Some($number) };
    (@linuxcnc ok) => { false };
    (@linuxcnc no) => { true };
    (@lost clear) => { false };
    (@lost lost) => { true };
}

rules! {
    // The text.
    BadNumber "bad-number" Error grbl 2 linuxcnc no lost "A letter without a number.";
    UnknownText "unknown-text" Error grbl 1 linuxcnc no lost "Characters that mean nothing in a program.";
    Expression "expression" Error grbl 2 linuxcnc ok lost "A parameter or expression, which this reader does not work out.";
    Exponent "exponent" Error grbl 20 linuxcnc no lost "A number with an exponent: controllers read the E as a word.";
    UnknownCode "unknown-code" Error grbl 20 linuxcnc no lost "A code that no controller here knows.";
    GrblUnsupported "grbl-unsupported" Error grbl 20 linuxcnc ok clear "A code or word that GRBL does not know.";
    ToolChange "tool-change" Error grbl 20 linuxcnc ok clear "M6: GRBL has no tool changer.";
    NotFollowed "not-followed" Error grbl 20 linuxcnc ok lost "A cycle, spline or cutter compensation, which this reader does not follow.";
    ShiftedOrigin "shifted-origin" Warning grbl ok linuxcnc ok clear "An offset or a change of coordinate system; positions are read as if there were none.";
    Homing "homing" Warning grbl ok linuxcnc ok clear "A motion to a place that only the machine knows (G28, G30, G53).";
    DuplicateWord "duplicate-word" Error grbl 25 linuxcnc no lost "The same letter twice on a line.";
    ConflictingCodes "conflicting-codes" Error grbl 21 linuxcnc no lost "Two codes of one group on a line.";
    UnusedWord "unused-word" Error grbl 36 linuxcnc no clear "A word that nothing on its line uses.";
    LineTooLong "line-too-long" Error grbl 11 linuxcnc ok clear "More than 79 characters without comments and blanks.";
    LineTooLongLinuxcnc "line-too-long-linuxcnc" Error grbl ok linuxcnc no clear "More than 252 characters with comments and blanks.";
    UnclosedComment "unclosed-comment" Error grbl ok linuxcnc no clear "A comment bracket that is never closed.";
    NestedComment "nested-comment" Error grbl 1 linuxcnc no lost "A bracket inside a comment in brackets.";
    PercentSign "percent-sign" Warning grbl 1 linuxcnc ok clear "A % line, which GRBL refuses unless the sender drops it.";
    ProgramNumber "program-number" Warning grbl 20 linuxcnc ok clear "A program number (O word), which GRBL refuses.";
    BlockDelete "block-delete" Warning grbl ok linuxcnc ok clear "A line that one controller runs and another skips.";
    // What must be said before anything moves.
    MissingUnits "missing-units" Warning grbl ok linuxcnc ok clear "Motion before G20 or G21 says in which unit.";
    MissingPlane "missing-plane" Warning grbl ok linuxcnc ok clear "Motion before G17 says in which plane.";
    MissingDistanceMode "missing-distance-mode" Warning grbl ok linuxcnc ok clear "Motion before G90 or G91 says from where distances count.";
    MissingFeedMode "missing-feed-mode" Warning grbl ok linuxcnc ok clear "Motion at a feed before G93 or G94 says what F means.";
    MissingMotionMode "missing-motion-mode" Error grbl ok linuxcnc no clear "Coordinates before any of G0 to G3 says how to go there.";
    NoFeed "no-feed" Error grbl 22 linuxcnc no clear "Motion at a feed without an F above zero.";
    NegativeValue "negative-value" Error grbl 4 linuxcnc no clear "A feed, speed, time or tool number below zero.";
    DwellWithoutTime "dwell-without-time" Error grbl 28 linuxcnc no clear "G4 without P.";
    // Arcs.
    ArcWithoutCenter "arc-without-center" Error grbl 35 linuxcnc no lost "An arc with neither I, J nor R.";
    ArcWithoutEnd "arc-without-end" Error grbl 26 linuxcnc ok clear "An arc without X and Y.";
    ArcRadiusMismatch "arc-radius-mismatch" Error grbl 33 linuxcnc ok clear "Ends of an arc at different distances from its centre: above 0.5 mm, or above 0.005 mm and 0.1 %, which GRBL refuses.";
    ArcRadiusMismatchLinuxcnc "arc-radius-mismatch-linuxcnc" Error grbl ok linuxcnc no clear "Ends of an arc at different distances from its centre: above 0.028 mm and 0.1 %, or above 2.8 mm, which LinuxCNC refuses.";
    ArcImprecise "arc-imprecise" Warning grbl ok linuxcnc ok clear "Ends of an arc at distances from its centre that differ by more than 0.002 mm.";
    ArcWrongPlane "arc-wrong-plane" Error grbl ok linuxcnc no clear "A centre word that is not of the plane in force.";
    ArcOtherPlane "arc-other-plane" Warning grbl ok linuxcnc ok clear "An arc outside of the XY plane.";
    ArcRadiusForm "arc-radius-form" Warning grbl ok linuxcnc ok clear "An arc given by its radius: near a half circle rounding moves its centre far.";
    ArcRadiusTooSmall "arc-radius-too-small" Error grbl 34 linuxcnc ok clear "An arc whose ends are farther apart than twice its R.";
    ArcRadiusTooSmallLinuxcnc "arc-radius-too-small-linuxcnc" Error grbl ok linuxcnc no clear "An arc whose ends are much farther apart than twice its R.";
    ArcRadiusClosed "arc-radius-closed" Error grbl 33 linuxcnc no clear "An arc given by its radius that ends where it starts.";
    ArcEndEqualsStart "arc-end-equals-start" Warning grbl ok linuxcnc ok clear "A full circle in the middle of a path: perhaps an arc whose rounded end equals its start.";
    // What the machine does.
    TravelBeforeLift "travel-before-lift" Error grbl ok linuxcnc ok clear "XY motion before Z was moved: the tool may be anywhere.";
    RapidThroughMaterial "rapid-through-material" Error grbl ok linuxcnc ok clear "A rapid in XY below the top of the stock.";
    RapidPlunge "rapid-plunge" Error grbl ok linuxcnc ok clear "A rapid down into the stock.";
    LowTravel "low-travel" Warning grbl ok linuxcnc ok clear "A rapid in XY less than 0.5 mm above the stock.";
    SpindleOff "spindle-off" Error grbl ok linuxcnc ok clear "Cutting with the spindle off.";
    NoDwell "no-dwell" Warning grbl ok linuxcnc ok clear "Cutting before the spindle had time to start: no G4 after M3 or M4.";
    NoSpindleSpeed "no-spindle-speed" Warning grbl ok linuxcnc ok clear "M3 or M4 without an S above zero.";
    SpindleLeftOn "spindle-left-on" Warning grbl ok linuxcnc ok clear "The program ends without M5.";
    ToolLeftDown "tool-left-down" Warning grbl ok linuxcnc ok clear "The program ends with the tool below the top of the stock.";
    NoProgramEnd "no-program-end" Error grbl ok linuxcnc no clear "No M2 or M30 at the end.";
    AfterEnd "after-end" Warning grbl ok linuxcnc ok clear "Something follows M2 or M30: it never runs, or only after the next start.";
    NoMotion "no-motion" Warning grbl ok linuxcnc ok clear "Nothing moves.";
}

impl Rule {
    /// The entry of the table.
    pub fn info(self) -> &'static RuleInfo {
        &RULES[self as usize]
    }

    /// Whether neither controller enforces the rule.
    pub fn is_ours(self) -> bool {
        self.info().grbl_error.is_none() && !self.info().linuxcnc_refuses
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.info().name)
    }
}

impl serde::Serialize for Rule {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.info().name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_stands_in_the_order_of_the_names() {
        for (index, info) in RULES.iter().enumerate() {
            assert_eq!(info.rule as usize, index, "{}", info.name);
            assert_eq!(RULES.iter().filter(|r| r.name == info.name).count(), 1, "{}", info.name);
        }
    }
}
