//! The rules that programs are held against, as one table.
//!
//! What a controller itself refuses stands in its dialect, with how it refuses it. A rule that no controller enforces is
//! our own: what keeps cutters, work and fingers whole.

use std::fmt;

use super::Dialect;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The program depends on something that it does not say, or is unusual.
    Warning,
    /// A controller refuses the program, or the machine does harm.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

/// Which programs a rule is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleScope {
    /// All, whatever the controller takes.
    Always,
    /// Those for controllers whose dialect says so by its codes, letters, lengths and tolerances.
    Data,
    /// Those for controllers that refuse what breaks the rule.
    Refused,
}

impl fmt::Display for RuleScope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RuleScope::Always => "always",
            RuleScope::Data => "as the dialect says",
            RuleScope::Refused => "where the controller refuses it",
        })
    }
}

/// What becomes of the motions that are read where a rule is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// They are those of a machine.
    Exact,
    /// The controller refuses the line, or moves elsewhere: what is read is a guess, and so is what it cuts.
    Guessed,
    /// There are none.
    Lost,
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
    /// Which programs it is for.
    pub scope: RuleScope,
    /// What a reader of the program makes of it.
    pub reading: Reading,
    /// What it says, for people.
    pub meaning: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

macro_rules! rules {
    ($($variant:ident $name:literal $severity:ident $scope:ident $reading:tt $meaning:literal $source:literal;)*) => {
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
                scope: RuleScope::$scope,
                reading: rules!(@reading $reading),
                meaning: $meaning,
                source: $source,
            },)*
        ];
    };
    (@reading clear) => { Reading::Exact };
    (@reading guessed) => { Reading::Guessed };
    (@reading lost) => { Reading::Lost };
}

// RS274/NGC is the NIST report NISTIR 6556, with its sections; names with numbers are issues of projects.
rules! {
    // The text.
    BadNumber "bad-number" Error Always lost "A letter without a number." "RS274/NGC 3.3.2";
    UnknownText "unknown-text" Error Always lost "Characters that mean nothing in a program." "RS274/NGC 3.3";
    Expression "expression" Error Data lost "A parameter or expression: neither this controller nor this reader works it out." "RS274/NGC 3.3.2";
    Exponent "exponent" Error Always lost "A number with an exponent: controllers read the E as a word." "RS274/NGC 3.3.2.1";
    UnknownCode "unknown-code" Error Always lost "A code that no controller here knows." "the dialect's codes";
    UnsupportedCode "unsupported-code" Error Data clear "A code or word that this controller does not know." "the dialect's codes and letters";
    ToolChange "tool-change" Error Data clear "M6, where the controller cannot change tools." "the dialect's codes";
    SeveralCodes "several-codes" Error Data guessed "A second command on a line, where the controller runs the first alone." "Marlin, parser.cpp";
    MotionWordMissing "motion-word-missing" Error Data guessed "Coordinates without G0 to G3, where the controller forgets them at the end of every line." "Marlin, GCODE_MOTION_MODES";
    NotFollowed "not-followed" Warning Always lost "Something that this reader does not follow: a cycle, spline, cutter compensation, subroutine, parameter or expression." "this reader";
    ShiftedOrigin "shifted-origin" Warning Always guessed "An offset or a change of coordinate system whose size only the machine knows; positions are read as if there were none." "this reader";
    SetOrigin "set-origin" Warning Always clear "The program moves its own zero, and controllers may keep it for the next one." "RS274/NGC 3.5.18";
    Homing "homing" Warning Always clear "A motion to a place that only the machine knows (G28, G30, G53)." "this reader";
    UnknownWay "unknown-way" Error Always guessed "A motion below the top of the stock, or at a feed, to or from a place that only the machine knows: nobody can say what it cuts." "this reader";
    DuplicateWord "duplicate-word" Error Always lost "The same letter twice on a line." "RS274/NGC 3.3.3";
    ConflictingCodes "conflicting-codes" Error Always lost "Two codes of one group on a line." "RS274/NGC 3.4";
    UnusedWord "unused-word" Error Refused clear "A word that nothing on its line uses." "RS274/NGC 3.5";
    LineTooLong "line-too-long" Error Data clear "More characters than the controller's line holds." "grbl 80 characters, LinuxCNC 255, Marlin 96";
    UnclosedComment "unclosed-comment" Error Refused clear "A comment bracket that is never closed." "RS274/NGC 3.3.4";
    NestedComment "nested-comment" Error Always lost "A bracket inside a comment in brackets." "RS274/NGC 3.3.4";
    PercentSign "percent-sign" Warning Refused clear "A % line, which only some senders drop." "RS274/NGC 3.1";
    ProgramNumber "program-number" Warning Refused clear "A program number (O word)." "RS274/NGC 3.3";
    BlockDelete "block-delete" Warning Always clear "A line that one controller runs and another skips." "RS274/NGC 3.3";
    // What must be said before anything moves.
    MissingUnits "missing-units" Warning Data clear "Motion before G20 or G21 says in which unit." "jscut 84, OpenBuilds-CAM 67 76 98";
    MissingPlane "missing-plane" Warning Data clear "Motion before G17 says in which plane." "a program always";
    MissingDistanceMode "missing-distance-mode" Warning Data clear "Motion before G90 or G91 says from where distances count." "a program always";
    MissingFeedMode "missing-feed-mode" Warning Data clear "Motion at a feed before G93 or G94 says what F means." "a program always";
    MissingMotionMode "missing-motion-mode" Error Refused clear "Coordinates before any of G0 to G3 says how to go there." "RS274/NGC 3.5";
    NoFeed "no-feed" Error Always guessed "Motion at a feed without an F above zero." "grbl 723, gnea/grbl 167 255, bCNC 88";
    FeedOfRapid "feed-of-rapid" Warning Always clear "Motion at the feed that was last said with a rapid: the cut may run at the speed of travel." "Marlin, one feed for G0 and G1";
    RapidWithoutFeed "rapid-without-feed" Warning Data clear "A rapid without an F, where it would keep to the feed of the cut before." "Marlin, one feed for G0 and G1";
    FeedAfterToolChange "feed-after-tool-change" Warning Always clear "The first cut of a tool at the feed of the tool before." "a program always";
    NegativeValue "negative-value" Error Always clear "A feed, speed, time or tool number below zero." "RS274/NGC 3.5";
    SpeedOutOfRange "speed-out-of-range" Warning Data clear "An S above the controller's full speed." "Marlin, CUTTER_POWER_UNIT";
    DwellWithoutTime "dwell-without-time" Error Always guessed "G4 without its time." "RS274/NGC 3.5.4";
    // Arcs.
    NoArcs "no-arcs" Error Data clear "An arc, or a helix, where the controller has none." "krabzcam 7, juicy-gcode 17";
    ArcWithoutCenter "arc-without-center" Error Always lost "An arc with neither I, J nor R." "RS274/NGC 3.5.3.2";
    ArcWithoutEnd "arc-without-end" Error Refused clear "An arc without X and Y." "RS274/NGC 3.5.3.2";
    ArcRadiusMismatch "arc-radius-mismatch" Error Data guessed "Ends of an arc at different distances from its centre, by more than the controller takes." "grbl 619 897, gnea/grbl 230 562 771, LaserGRBL 1674";
    ArcImprecise "arc-imprecise" Warning Always clear "Ends of an arc at distances from its centre that differ by more than 0.002 mm." "RS274/NGC 3.5.3.2";
    ArcWrongPlane "arc-wrong-plane" Error Refused clear "A centre word that is not of the plane in force." "RS274/NGC 3.5.3.2";
    ArcOtherPlane "arc-other-plane" Warning Always clear "An arc outside of the XY plane." "this reader";
    ArcRadiusForm "arc-radius-form" Warning Always clear "An arc given by its radius: near a half circle rounding moves its centre far." "RS274/NGC 3.5.3.1";
    ArcRadiusTooSmall "arc-radius-too-small" Error Data guessed "An arc whose ends are farther apart than twice its R." "RS274/NGC 3.5.3.1";
    ArcRadiusClosed "arc-radius-closed" Error Always guessed "An arc given by its radius that ends where it starts." "RS274/NGC 3.5.3.1";
    ArcEndEqualsStart "arc-end-equals-start" Warning Always clear "A full circle in the middle of a path: perhaps an arc whose rounded end equals its start." "a program never";
    // What the machine does.
    TravelBeforeLift "travel-before-lift" Error Always clear "XY motion before Z was moved: the tool may be anywhere." "a program always";
    RapidThroughMaterial "rapid-through-material" Error Always clear "A rapid in XY below the top of the stock." "FreeCAD 8140 18318 31981, grid-apps 4 9, PureCutCNC 467 480";
    RapidPlunge "rapid-plunge" Error Always clear "A rapid down into the stock." "FreeCAD 8140 18318 31981";
    LowTravel "low-travel" Warning Always clear "A rapid in XY less than 0.5 mm above the stock." "a program always";
    FastPlunge "fast-plunge" Warning Always clear "Straight down into the stock at the feed of cutting sideways, or faster." "LaserWeb4 311, makercam 3, FreeCAD 28484";
    SpindleOff "spindle-off" Error Always clear "Cutting with the spindle off." "a program always";
    NoDwell "no-dwell" Warning Always clear "Cutting before the spindle had time to start: no G4 after M3 or M4." "grbl 1373, gnea/grbl 701 730, pcb2gcode 85";
    NoSpindleSpeed "no-spindle-speed" Warning Always clear "M3 or M4 without an S above zero." "a program always";
    SpindleOnAtToolChange "spindle-on-at-tool-change" Error Always clear "M6 with the spindle on." "grblHAL, tool change mode 0";
    BeamOnTravel "beam-on-travel" Warning Always clear "A rapid with the beam on: dark only where the controller is in laser mode." "gnea/grbl wiki, Laser Mode";
    SpindleLeftOn "spindle-left-on" Warning Always clear "The program ends without M5." "a program always";
    ToolLeftDown "tool-left-down" Warning Always clear "The program ends with the tool below the top of the stock." "a program always";
    NoProgramEnd "no-program-end" Error Data clear "No M2 or M30 at the end." "RS274/NGC 3.6.1";
    AfterEnd "after-end" Warning Always clear "Something follows M2 or M30: it never runs, or only after the next start." "RS274/NGC 3.6.1";
    NoMotion "no-motion" Warning Always clear "Nothing moves." "a program always";
}

impl RuleInfo {
    /// The rule called `name`.
    pub fn named(name: &str) -> Option<&'static RuleInfo> {
        RULES.iter().find(|r| r.name.eq_ignore_ascii_case(name.trim()))
    }
}

impl Rule {
    /// The entry of the table.
    pub fn info(self) -> &'static RuleInfo {
        &RULES[self as usize]
    }

    /// Whether the rule is about where the tool is, or how it gets there: who has lost the thread cannot judge that.
    pub(super) fn is_about_places(self) -> bool {
        (Rule::NoFeed..=Rule::FeedAfterToolChange).contains(&self)
            || (Rule::ArcWithoutCenter..=Rule::FastPlunge).contains(&self)
            || matches!(self, Rule::UnknownWay | Rule::ToolLeftDown | Rule::NoMotion)
    }

    /// Whether programs for `dialect` are held against the rule.
    pub fn is_for(self, dialect: &Dialect) -> bool {
        match self.info().scope {
            RuleScope::Always | RuleScope::Data => true,
            RuleScope::Refused => dialect.refuses.contains_key(&self),
        }
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

impl<'de> serde::Deserialize<'de> for Rule {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Rule, D::Error> {
        let name = String::deserialize(deserializer)?;
        let info = RuleInfo::named(&name);
        info.map(|i| i.rule).ok_or_else(|| serde::de::Error::custom(format!("\"{name}\" is no rule")))
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
            assert_eq!(RuleInfo::named(info.name), Some(info));
        }
    }
}
