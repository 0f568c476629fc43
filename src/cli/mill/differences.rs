//! How the result will differ from the drawing: every place with its size, its reason, and what a smaller tool would gain.

use crate::cam::{Gouge, Island, Notice, Uncut, UncutPlace};
use crate::check::{LostFeature, Place};
use crate::cli::report::why_lost;
use crate::plane::{Point, Region, Ring};
use crate::preview::Difference;

/// Rows of one kind for one operation; the rest is told in one more.
const MOST_ROWS: usize = 30;

/// A corner that stays round by no more than this, in millimetres, is sharp for most purposes: what a smaller tool is sized for.
const NEARLY_SHARP: f64 = 0.1;

/// The operation and the tool that leave something.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    pub(super) operation: String,
    /// Diameter of the tool in millimetres.
    pub(super) diameter: f64,
    /// Path radius in millimetres.
    pub(super) path_radius: f64,
    /// The operation that cuts what this one leaves, if there is one.
    pub(super) followed_by: Option<String>,
}

impl Cut {
    fn row(
        &self,
        feature: impl Into<String>,
        at: Option<Point>,
        amount: String,
        why: String,
        gain: String,
    ) -> Difference {
        let operation = self.operation.clone();
        Difference { operation, feature: feature.into(), places: at.into_iter().collect(), amount, why, gain }
    }

    /// The features of the drawing that are gone.
    pub(super) fn lost(&self, lost: &[LostFeature]) -> Vec<Difference> {
        let mut rows: Vec<Difference> = lost.iter().take(MOST_ROWS).map(|f| self.lost_row(f)).collect();
        rows.extend(self.more(lost.len(), "lost features"));
        rows
    }

    fn lost_row(&self, feature: &LostFeature) -> Difference {
        let (what, place, amount) = match *feature {
            LostFeature::HoleFilled { center, diameter, area } => {
                (format!("hole {diameter:.2} mm wide"), center, format!("filled, {area:.2} mm²"))
            }
            LostFeature::PartsMerged { components, place, width } => {
                (format!("gap of {width:.2} mm between parts"), place, format!("filled: {components} parts become one"))
            }
            LostFeature::GapFilled { place, width, depth, area } => {
                (format!("gap {width:.2} mm wide"), place, format!("filled, {depth:.2} mm deep, {area:.2} mm²"))
            }
            LostFeature::ComponentLost { center, diameter, area } => {
                (format!("opening {diameter:.2} mm wide"), center, format!("not cut, {area:.2} mm²"))
            }
            LostFeature::NeckCut { place, width, depth, area } => {
                (format!("neck {width:.2} mm wide"), place, format!("not cut, {depth:.2} mm long, {area:.2} mm²"))
            }
        };
        let why = why_lost(feature.width(), self.diameter, self.path_radius);
        self.row(what, Some(point(place)), amount, why, self.gain(feature.width()))
    }

    /// The largest tool that would cut what is so wide.
    fn gain(&self, width: f64) -> String {
        let with_radius = width - 2.0 * self.path_radius;
        let mut ways = Vec::new();
        if width > self.diameter && self.path_radius > 0.0 {
            ways.push(format!("this tool with a path radius below {:.3} mm", 0.5 * (width - self.diameter)));
        }
        if with_radius > 0.0 && with_radius <= self.diameter && self.path_radius > 0.0 {
            ways.push(format!("a tool below {with_radius:.3} mm"));
        }
        if width <= self.diameter {
            let radius = if self.path_radius > 0.0 { " with path radius 0" } else { "" };
            ways.push(format!("a tool below {width:.3} mm{radius}"));
        }
        let ways = ways.join(", or ");
        if ways.is_empty() { self.follows() } else { format!("{ways} cuts it{}", self.follows()) }
    }

    fn follows(&self) -> String {
        self.followed_by.as_ref().map_or(String::new(), |later| format!("; \"{later}\" takes what it can of it"))
    }

    /// What stands beside the outline. Where a feature is lost, that says it already.
    pub(super) fn uncut(&self, uncut: &Uncut, lost: &[LostFeature]) -> Vec<Difference> {
        let is_told = |place: &UncutPlace| {
            let area = Region::new(place.outlines.iter().map(|o| Ring::polygon(o.iter().copied())).collect());
            lost.iter().any(|f| area.contains(point(middle(f))))
        };
        let places: Vec<&UncutPlace> = uncut.places.iter().filter(|p| !is_told(p)).collect();
        let mut rows: Vec<Difference> = places.iter().take(MOST_ROWS).map(|p| self.uncut_row(p)).collect();
        rows.extend(self.more(places.len(), "places that stand"));
        rows
    }

    fn uncut_row(&self, place: &UncutPlace) -> Difference {
        let reach = 0.5 * self.diameter + self.path_radius;
        // What a disk leaves in a corner grows with its radius.
        let left = |radius: f64| place.depth_mm * radius / reach;
        let mut gain = String::new();
        if self.path_radius > 0.0 {
            gain += &format!("path radius 0 leaves {:.3} mm; ", left(0.5 * self.diameter));
        }
        let sharp = 2.0 * reach * NEARLY_SHARP / place.depth_mm;
        if left(0.5 * self.diameter) > NEARLY_SHARP {
            gain += &format!("a tool of {sharp:.2} mm with path radius 0 leaves {NEARLY_SHARP} mm");
        } else if self.path_radius > 0.0 {
            gain += "a smaller tool is not worth it";
        } else {
            gain += "hardly anything";
        }
        let path_radius = match self.path_radius {
            0.0 => String::new(),
            radius => format!(" with a path radius of {radius:.3} mm"),
        };
        self.row(
            "inside corner",
            Some(Point::new(place.x_mm, place.y_mm)),
            format!("stays round: {:.3} mm² stand, up to {:.3} mm from the outline", place.area_mm2, place.depth_mm),
            format!("a tool of {} mm{path_radius} leaves a radius of {reach:.3} mm", self.diameter),
            gain + &self.follows(),
        )
    }

    /// The deepest cut into what must remain.
    pub(super) fn gouge(&self, gouge: &Gouge) -> Difference {
        self.row(
            "outline",
            Some(Point::new(gouge.x_mm, gouge.y_mm)),
            format!("cut into by {:.4} mm", gouge.depth_mm),
            format!("line {} of the program", gouge.line),
            "please report this".to_owned(),
        )
    }

    /// What stands in a pocket.
    pub(super) fn islands(&self, islands: &[Island]) -> Vec<Difference> {
        let row = |island: &Island| {
            self.row(
                "island in a pocket",
                Some(Point::new(island.x_mm, island.y_mm)),
                format!("{:.3} mm thick stays standing", island.thickness_mm),
                "the paths do not meet there".to_owned(),
                "a smaller stepover or path radius".to_owned(),
            )
        };
        let mut rows: Vec<Difference> = islands.iter().take(MOST_ROWS).map(row).collect();
        rows.extend(self.more(islands.len(), "islands"));
        rows
    }

    /// What was not done as asked.
    pub(super) fn notices(&self, notices: &[Notice]) -> Vec<Difference> {
        let row = |notice: &Notice| {
            let bottom = |step: f64| format!("cleared by the tip in paths {step:.2} mm apart");
            let (at, feature, amount, why, gain) = match *notice {
                Notice::BottomCleared(step) => {
                    return self.row(
                        "flat bottom",
                        None,
                        bottom(step),
                        "the letters are wider than the tool reaches".to_owned(),
                        "a wider tool".to_owned(),
                    );
                }
                Notice::NothingToHold(count) => {
                    return self.row(
                        "tabs",
                        None,
                        format!("none on {count} outlines"),
                        "nothing comes loose there".to_owned(),
                        String::new(),
                    );
                }
                Notice::PathRadiusEased(count, least) => {
                    return self.row(
                        "path radius",
                        None,
                        format!("down to {least:.3} mm on {count} outlines"),
                        "more would lose outlines that the tool can cut".to_owned(),
                        "a smaller tool, or a lower feed".to_owned(),
                    );
                }
                Notice::LeadSkipped(p) => (
                    p,
                    "lead",
                    "left out: the tool comes down on the outline".to_owned(),
                    "no room for its arc",
                    "a smaller lead",
                ),
                Notice::LeadShortened(p, radius) => {
                    (p, "lead", format!("a radius of {radius:.3} mm"), "no room for a larger arc", "a smaller lead")
                }
                Notice::OpenLine(p) => {
                    (p, "line", "not cut".to_owned(), "it is open and has no inside", "a closed line, or engraving")
                }
                Notice::TabMoved(p, to) => {
                    let apart = (to - p).norm();
                    (p, "tab", format!("{apart:.2} mm away"), "no room where it was asked for", "another place")
                }
                Notice::Covered(p) => {
                    (p, "shape", "nothing".to_owned(), "it lies wholly on another one", "a hole of that shape")
                }
                Notice::NotRound(p) => {
                    (p, "shape", "not drilled".to_owned(), "it is no circle", "a pocket, or another select")
                }
                Notice::HoleNarrow(p, diameter) => (
                    p,
                    "hole",
                    format!("as wide as the drill, not {diameter:.3} mm"),
                    "a drill makes holes of its own size",
                    "a drill of its size, or an end mill",
                ),
                Notice::HelixSkipped(p) => (
                    p,
                    "helix",
                    "left out: the tool ramps along the path".to_owned(),
                    "no room for its circle",
                    "a smaller tool",
                ),
                Notice::NoHole(p) => (
                    p,
                    "entry",
                    "ramps along the path".to_owned(),
                    "no drilled hole near by takes the tool",
                    "a wider hole before",
                ),
                Notice::CornerSkipped(p) => (
                    p,
                    "relief of a corner",
                    "left out: it stays round".to_owned(),
                    "the tool does not come near",
                    "a smaller tool",
                ),
                Notice::TabsDropped(p, count) => {
                    (p, "tabs", format!("{count} left out"), "no place on the outline", "fewer or narrower tabs")
                }
                Notice::TabsOnArcs(p, count) => {
                    (p, "tabs", format!("{count} on tight arcs"), "no straighter place", "fewer or narrower tabs")
                }
            };
            self.row(feature, Some(at), amount, why.to_owned(), gain.to_owned())
        };
        let mut rows: Vec<Difference> = notices.iter().take(MOST_ROWS).map(row).collect();
        rows.extend(self.more(notices.len(), "notices"));
        rows
    }

    fn more(&self, total: usize, what: &str) -> Option<Difference> {
        let left = total.checked_sub(MOST_ROWS).filter(|left| *left > 0)?;
        let amount = "smaller or like those above".to_owned();
        Some(self.row(format!("{left} more {what}"), None, amount, String::new(), String::new()))
    }
}

/// Rows that say the same of several places made one, in the order of the first.
pub(super) fn merged(rows: Vec<Difference>) -> Vec<Difference> {
    let mut merged: Vec<Difference> = Vec::new();
    let words = |d: &Difference| [&d.operation, &d.feature, &d.amount, &d.why, &d.gain].map(String::clone);
    for row in rows {
        match merged.iter_mut().find(|m| words(m) == words(&row)) {
            Some(same) => same.places.extend(row.places),
            None => merged.push(row),
        }
    }
    merged
}

fn point(place: Place) -> Point {
    Point::new(place.x, place.y)
}

fn middle(feature: &LostFeature) -> Place {
    match *feature {
        LostFeature::HoleFilled { center, .. } | LostFeature::ComponentLost { center, .. } => center,
        LostFeature::PartsMerged { place, .. }
        | LostFeature::GapFilled { place, .. }
        | LostFeature::NeckCut { place, .. } => place,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(diameter: f64, path_radius: f64) -> Cut {
        Cut { operation: "profile".into(), diameter, path_radius, followed_by: None }
    }

    fn hole(diameter: f64) -> LostFeature {
        LostFeature::HoleFilled { center: Place { x: 5.0, y: 6.0 }, diameter, area: 1.0 }
    }

    #[test]
    fn the_largest_tool_follows_from_the_size_of_the_feature() {
        for (width, diameter, path_radius, expected) in [
            (2.0, 3.0, 0.5, "a tool below 1.000 mm, or a tool below 2.000 mm with path radius 0 cuts it"),
            (2.0, 3.0, 1.0, "a tool below 2.000 mm with path radius 0 cuts it"),
            (2.0, 3.0, 0.0, "a tool below 2.000 mm cuts it"),
            (3.5, 3.0, 0.5, "this tool with a path radius below 0.250 mm, or a tool below 2.500 mm cuts it"),
        ] {
            let row = &cut(diameter, path_radius).lost(&[hole(width)])[0];
            assert_eq!(row.gain, expected, "{width} {diameter} {path_radius}");
            assert_eq!(row.places, [Point::new(5.0, 6.0)]);
        }
    }

    /// A right-angled corner: a disk of radius r leaves (sqrt 2 - 1) r.
    #[test]
    fn a_corner_tells_what_smaller_tools_leave_of_it() {
        let depth = |r: f64| (2f64.sqrt() - 1.0) * r;
        let place = |r: f64| UncutPlace { x_mm: 0.0, y_mm: 0.0, area_mm2: 1.0, depth_mm: depth(r), outlines: vec![] };
        let gain = |d: f64, p: f64| cut(d, p).uncut_row(&place(0.5 * d + p)).gain;
        assert_eq!(gain(4.0, 1.0), "path radius 0 leaves 0.828 mm; a tool of 0.48 mm with path radius 0 leaves 0.1 mm");
        assert!((depth(0.24) - 0.1).abs() < 1e-3);
        assert_eq!(gain(0.4, 0.0), "hardly anything");
    }

    #[test]
    fn what_is_true_of_several_places_is_said_once() {
        let rows = cut(3.0, 0.0).lost(&[hole(1.0), hole(2.0), hole(1.0)]);
        let merged = merged(rows);
        assert_eq!(merged.iter().map(|d| d.places.len()).collect::<Vec<_>>(), [2, 1]);
    }

    #[test]
    fn a_lost_hole_is_told_once_and_long_lists_end() {
        let square = |x: f64, y: f64| {
            vec![Point::new(x, y), Point::new(x + 2.0, y), Point::new(x + 2.0, y + 2.0), Point::new(x, y + 2.0)]
        };
        let place =
            |x: f64| UncutPlace { x_mm: x, y_mm: 0.0, area_mm2: 4.0, depth_mm: 1.0, outlines: vec![square(x, 5.0)] };
        let uncut = Uncut { area_mm2: 8.0, places: vec![place(4.0), place(20.0)], is_cut_free: true };
        let rows = cut(3.0, 0.0).uncut(&uncut, &[hole(1.0)]);
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0].places[0].x, 20.0);
        let many = cut(3.0, 0.0).lost(&vec![hole(1.0); MOST_ROWS + 3]);
        assert_eq!((many.len(), many[MOST_ROWS].feature.as_str()), (MOST_ROWS + 1, "3 more lost features"));
    }
}
