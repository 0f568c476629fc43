//! Pieces that are left standing to hold a part: where along a path they are, and how high the tool passes over them.

use super::strands::Strands;
use super::walk::Walk;
use super::{TabPlaces, Tabs};
use crate::plane::{Bounds, Link, Point, Segment, Turn, right_normal};

/// Length of a tab's flank in heights of the tab over the floor: its steepest place, in the middle, then has 45 degrees.
const FLANK: f64 = 1.5;

/// Straight pieces of a flank: the polygon keeps within 1 % of the tab's height of the smooth curve.
const FLANK_PIECES: usize = 8;

/// Arcs of the path tighter than this, in tool diameters, are no good places for tabs: a knife cuts straight.
const ROUND: f64 = 4.0;

/// Tabs on arcs tighter than this, in tool diameters, are told.
const TIGHT: f64 = 1.0;

/// How finely places for tabs are sought along a path, in parts of its length.
const SEARCH_STEPS: usize = 720;

/// How far other strands of the path keep from the middle of a tab, in tool diameters: nearer ones leave nothing beside the
/// path that a tab could hold on to.
const HOLD: f64 = 0.99;

/// Tabs hold on to what stands this far beside the tool, in tool diameters.
const BESIDE: f64 = 0.02;

/// Half of the narrowest that the way around a corner may leave of a tab, in widths of the tab: where it is wanted, and where
/// there are only tight arcs.
const NECK: [f64; 2] = [0.25, 0.1];

/// Steps in which tabs beside another path are made longer, in widths of the tab.
const LONGER: f64 = 0.05;

/// What is around the tabs of an operation.
pub(super) struct Ground<'a> {
    /// z of what they stand on.
    pub base: f64,
    /// z of the floor of the cut, below that where it goes through the stock.
    pub floor: f64,
    /// Diameter of the tool.
    pub tool_diameter: f64,
    /// How far from the start of a path, in millimetres, its tabs begin.
    pub seam: f64,
    /// How far beside the path another one runs that passes over the same tabs.
    pub allowance: f64,
    /// The side of the paths on which the waste is.
    pub waste: Turn,
    /// All paths.
    pub strands: &'a Strands,
}

impl Ground<'_> {
    /// Whether something stands beside the path, at `way` on it, that a tab could hold on to: no path takes it away.
    fn holds(&self, walk: &Walk, way: f64, strands: &Strands) -> bool {
        let swept = 0.5 * self.tool_diameter + self.allowance;
        let outward = right_normal(walk.tangent_at(way));
        let aside = if self.waste == Turn::Right { outward } else { -outward };
        !strands.come_nearer(walk.point_at(way) + aside * (swept + BESIDE * self.tool_diameter), swept)
    }

    /// How far the tool goes down from the top of a tab.
    fn fall(&self, tabs: &Tabs) -> f64 {
        self.base + tabs.height - self.floor
    }

    /// How far from the start of a path the middle of a tab may be.
    pub(super) fn clearance(&self, tabs: &Tabs) -> f64 {
        self.plateau(tabs) + FLANK * self.fall(tabs) + self.seam
    }

    /// Half the length over which the tool stays up.
    fn plateau(&self, tabs: &Tabs) -> f64 {
        0.5 * (tabs.width + self.tool_diameter)
    }
}

/// Rounding of lengths, relative.
const ROUNDING: f64 = 1e-9;

/// A tab on a path.
#[derive(Clone, Copy, Debug)]
struct Tab {
    /// Where along the path its middle is, in [0, length).
    middle: f64,
    /// Half the length over which the tool stays up.
    plateau: f64,
}

/// The tabs of one path.
#[derive(Clone, Debug, Default)]
pub(super) struct TabLine {
    /// In the order of the path.
    tabs: Vec<Tab>,
    /// z of the tool over a tab.
    top: f64,
    /// How far the tool goes down from there to the floor of the cut.
    fall: f64,
    /// Length of the path.
    length: f64,
}

/// What became of the tabs that were asked for on one path.
#[derive(Clone, Debug, Default)]
pub(super) struct Placed {
    /// Those that are there.
    pub line: TabLine,
    /// How many were asked for.
    pub asked: usize,
    /// How many of those that are there stand on tight arcs, for want of better places.
    pub on_arcs: usize,
    /// Where tabs were asked for by their places and where they are instead, if farther away than they are long.
    pub moved: Vec<[Point; 2]>,
}

impl TabLine {
    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.tabs.len()
    }

    /// The middles of the tabs on the path.
    pub(super) fn points(&self, walk: &Walk) -> Vec<Point> {
        self.tabs.iter().map(|tab| walk.point_at(tab.middle)).collect()
    }

    /// The lowest that the tool may be at `way`, which may be several times around.
    pub(super) fn lowest(&self, way: f64) -> f64 {
        let mut lowest = f64::NEG_INFINITY;
        for tab in &self.tabs {
            let apart = (way - tab.middle).rem_euclid(self.length);
            let distance = apart.min(self.length - apart) - tab.plateau;
            let flank = FLANK * self.fall;
            if distance <= 0.0 {
                return self.top;
            }
            if distance < flank {
                let t = distance / flank;
                lowest = lowest.max(self.top - self.fall * t * t * (3.0 - 2.0 * t));
            }
        }
        lowest
    }

    /// The first place from `way` on that is at least `margin` off every tab; none where the tabs leave no such place.
    pub(super) fn clear_from(&self, way: f64, margin: f64) -> Option<f64> {
        let reach = |tab: &Tab| tab.plateau + FLANK * self.fall + margin;
        let apart = |way: f64, tab: &Tab| {
            let ahead = (tab.middle - way).rem_euclid(self.length);
            ahead.min(self.length - ahead)
        };
        let mut way = way;
        // Every tab pushes the place on at most once.
        for _ in 0..=self.tabs.len() {
            match self.tabs.iter().find(|tab| apart(way, tab) < reach(tab) * (1.0 - ROUNDING)) {
                Some(tab) => way = (tab.middle + reach(tab)).rem_euclid(self.length),
                None => return Some(way),
            }
        }
        None
    }

    /// The places between `from` and `from + length` where the way over the tabs bends, in order.
    pub(super) fn bends(&self, from: f64, length: f64) -> Vec<f64> {
        let mut bends = Vec::new();
        let flank = FLANK * self.fall;
        for tab in &self.tabs {
            let offsets = (0..=FLANK_PIECES).map(|k| tab.plateau + flank * (k as f64 / FLANK_PIECES as f64));
            for offset in offsets.flat_map(|o| [-o, o]) {
                let mut way = (tab.middle + offset - from).rem_euclid(self.length);
                while way < length {
                    bends.push(from + way);
                    way += self.length;
                }
            }
        }
        bends.sort_by(f64::total_cmp);
        bends
    }

    /// Places tabs along the path of this number, off its start, tight arcs and each other, and where no other strand takes
    /// what they would hold on to.
    pub(super) fn place(tabs: &Tabs, walk: &Walk, path: usize, ground: &Ground) -> Placed {
        let length = walk.length();
        let reach = ground.plateau(tabs) + FLANK * ground.fall(tabs);
        let wanted: Vec<f64> = match &tabs.places {
            TabPlaces::Count(count) => evenly(*count, length),
            TabPlaces::Spacing(spacing) => evenly(((length / spacing).round() as usize).max(2), length),
            TabPlaces::At(points) => {
                points.iter().map(|p| walk.nearest_way(Point::new(p[0], p[1]))).filter_map(|(way, _)| way).collect()
            }
        };
        let mut placed = Placed { asked: wanted.len(), line: TabLine::empty(tabs, walk, ground), ..Placed::default() };
        let half = ground.plateau(tabs);
        let bounds = walk.segments().iter().fold(Bounds::EMPTY, |b, s| b.union(s.bounds()));
        // The roughing takes of what lies between two paths on both sides.
        let hold = HOLD * ground.tool_diameter + 2.0 * ground.allowance;
        let strands = ground.strands.near(bounds, hold + 2.0 * BESIDE * ground.tool_diameter);
        let round = tight_stretches(walk.segments(), ROUND * ground.tool_diameter);
        let tight = tight_stretches(walk.segments(), TIGHT * ground.tool_diameter);
        for way in wanted {
            let free = |at: f64, arcs: Option<&[(f64, f64)]>| {
                let clear = |middle: f64, other: f64| {
                    let apart = (at - middle).rem_euclid(length);
                    apart.min(length - apart) >= reach + other
                };
                clear(0.0, ground.seam)
                    && placed.line.tabs.iter().all(|tab| clear(tab.middle, reach))
                    && !arcs.unwrap_or_default().iter().any(|&(a, b)| overlaps(at, half, a, b, length))
                    && !strands.pass(walk.point_at(at), path, at, hold)
                    && ground.holds(walk, at, &strands)
                    && leaves(
                        walk,
                        at,
                        half,
                        walk.point_at(at),
                        0.5 * ground.tool_diameter + ground.allowance + NECK[usize::from(arcs.is_none())] * tabs.width,
                    )
            };
            // As near as can be to where it is wanted.
            let nearest_free = |arcs: Option<&[(f64, f64)]>| {
                (0..=SEARCH_STEPS / 2)
                    .flat_map(|k| [k as f64, -(k as f64)])
                    .map(|k| (way + k * length / SEARCH_STEPS as f64).rem_euclid(length))
                    .find(|&at| free(at, arcs))
            };
            let off_arcs = nearest_free(Some(&round)).or_else(|| nearest_free(Some(&tight)));
            placed.on_arcs += usize::from(off_arcs.is_none() && nearest_free(None).is_some());
            let Some(at) = off_arcs.or_else(|| nearest_free(None)) else { continue };
            placed.line.tabs.push(Tab { middle: at, plateau: half });
            let [asked, got] = [walk.point_at(way), walk.point_at(at)];
            if matches!(tabs.places, TabPlaces::At(_)) && (asked - got).norm() > tabs.width {
                placed.moved.push([asked, got]);
            }
        }
        placed.line.sort();
        placed
    }

    /// The tabs of a path beside another one, whose tabs are at `points`: the tool stays up until it is as far from their
    /// middles as it has to be. Spikes into corners take up some of the way beside a tab, and are not as long on both paths.
    pub(super) fn beside(tabs: &Tabs, walk: &Walk, points: &[Point], ground: &Ground) -> TabLine {
        let mut line = TabLine::empty(tabs, walk, ground);
        let away = 0.5 * ground.tool_diameter + NECK[1] * tabs.width;
        let [half, most] = [ground.plateau(tabs), 0.5 * walk.length()];
        let tab = |p: Point| {
            let middle = walk.nearest_way(p).0?;
            let longer = (0..).map(|k| half + f64::from(k) * LONGER * tabs.width).take_while(|half| *half < most);
            let plateau = longer.into_iter().find(|&half| leaves(walk, middle, half, p, away)).unwrap_or(most);
            Some(Tab { middle, plateau })
        };
        line.tabs = points.iter().filter_map(|&p| tab(p)).collect();
        line.sort();
        line
    }

    fn sort(&mut self) {
        self.tabs.sort_by(|a, b| a.middle.total_cmp(&b.middle));
    }

    fn empty(tabs: &Tabs, walk: &Walk, ground: &Ground) -> TabLine {
        TabLine { tabs: Vec::new(), top: ground.base + tabs.height, fall: ground.fall(tabs), length: walk.length() }
    }
}

/// Whether the path, from `half` behind `at` on around to `half` before it, keeps `distance` from a point.
fn leaves(walk: &Walk, at: f64, half: f64, point: Point, distance: f64) -> bool {
    let low = walk.length() - 2.0 * half;
    let start = (at + half).rem_euclid(walk.length());
    low > 0.0 && !walk.stretch(start, low).iter().any(|s| s.is_nearer(point, distance))
}

/// `count` places, the first half a step from the start.
fn evenly(count: usize, length: f64) -> Vec<f64> {
    (0..count).map(|k| length * ((k as f64 + 0.5) / count as f64)).collect()
}

/// Whether [at - half, at + half] and [a, b] have anything in common on a circle of this length.
fn overlaps(at: f64, half: f64, a: f64, b: f64, length: f64) -> bool {
    let middle = 0.5 * (a + b);
    let apart = (at - middle).rem_euclid(length);
    apart.min(length - apart) < half + 0.5 * (b - a)
}

/// The stretches of tight arcs.
fn tight_stretches(segments: &[Segment], radius: f64) -> Vec<(f64, f64)> {
    let mut way = 0.0;
    let mut stretches = Vec::new();
    for segment in segments {
        let end = way + segment.length();
        if matches!(segment.link, Link::Arc(arc) if arc.radius < radius) {
            stretches.push((way, end));
        }
        way = end;
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn square() -> Walk {
        let corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)];
        Walk::new(Ring::polygon(corners.map(|(x, y)| Point::new(x, y))).segments().collect())
    }

    fn tabs(places: TabPlaces) -> Tabs {
        Tabs { places, width: 6.0, height: 2.0 }
    }

    fn place(tabs: &Tabs, walk: &Walk, tool_diameter: f64, seam: f64) -> Placed {
        let mut strands = Strands::default();
        strands.add(0, walk.segments());
        TabLine::place(
            tabs,
            walk,
            0,
            &Ground {
                base: -6.0,
                floor: -6.0,
                tool_diameter,
                allowance: 0.0,
                waste: Turn::Right,
                seam,
                strands: &strands,
            },
        )
    }

    #[test]
    fn tabs_stand_evenly_and_are_as_long_and_high_as_asked() {
        let placed = place(&tabs(TabPlaces::Count(4)), &square(), 3.0, 0.0);
        assert_eq!((placed.line.count(), placed.asked, placed.on_arcs), (4, 4, 0));
        let line = &placed.line;
        // The tool, 3 wide, is up for 9: what is left at the top is 6 long.
        assert_eq!(line.lowest(50.0), -4.0);
        assert_eq!(line.lowest(54.49), -4.0);
        assert!(line.lowest(54.6) < -4.0);
        assert!((line.lowest(50.0 + 4.5 + 1.5) + 5.0).abs() < 1e-12);
        assert_eq!(line.lowest(58.0), f64::NEG_INFINITY);
        // Once more around.
        assert_eq!(line.lowest(450.0), -4.0);
        assert!(line.bends(400.0, 100.0).iter().all(|b| (400.0..500.0).contains(b)));
        assert_eq!(line.bends(0.0, 400.0).len(), 4 * 2 * (FLANK_PIECES + 1));
    }

    #[test]
    fn spikes_into_corners_take_nothing_of_a_tab_that_stands_on_a_path_beside() {
        // The tab stands at (50, 0); two spikes of 2 mm beside it take 8 of the 9 mm for which the tool would stay up.
        let corners = [
            (0.0, 1.0),
            (48.8, 1.0),
            (48.8, 3.0),
            (48.8, 1.0),
            (51.2, 1.0),
            (51.2, 3.0),
            (51.2, 1.0),
            (100.0, 1.0),
            (100.0, 100.0),
            (0.0, 100.0),
        ];
        let walk = Walk::new(Ring::polygon(corners.map(|(x, y)| Point::new(x, y))).segments().collect());
        let strands = Strands::default();
        let ground = Ground {
            base: -6.0,
            floor: -6.0,
            tool_diameter: 3.0,
            allowance: 1.0,
            waste: Turn::Right,
            seam: 0.0,
            strands: &strands,
        };
        let tab = Point::new(50.0, 0.0);
        let line = TabLine::beside(&tabs(TabPlaces::Count(1)), &walk, &[tab], &ground);
        for way in (0..4000).map(|k| walk.length() * f64::from(k) / 4000.0) {
            let distance = (walk.point_at(way) - tab).norm();
            assert!(line.lowest(way) == -4.0 || distance > 1.5 + 0.1 * 6.0, "{way}: {distance}");
        }
        // And no longer than that.
        assert!(line.tabs[0].plateau < 4.5 + 8.0, "{:?}", line.tabs);
    }

    #[test]
    fn tabs_keep_off_seams_tight_arcs_and_each_other() {
        let near_seam = tabs(TabPlaces::At(vec![[1.0, 0.0], [2.0, 0.0]]));
        let placed = place(&near_seam, &square(), 3.0, 5.0);
        assert_eq!(placed.line.count(), 2);
        let points = placed.line.points(&square());
        assert!(points[0].x >= 12.4, "{points:?}");
        assert!((placed.line.tabs[1].middle - placed.line.tabs[0].middle).abs() >= 15.0);
        // A circle of 4 mm with tabs of 6 mm: nowhere room for six.
        let circle = Walk::new(Ring::circle(Point::origin(), 2.0).segments().collect());
        let placed = place(&tabs(TabPlaces::Count(6)), &circle, 3.0, 0.0);
        assert!(placed.line.count() < placed.asked);
        // A larger one is one tight arc all around for a tool of 30 mm, and bears a tab all the same.
        let circle = Walk::new(Ring::circle(Point::origin(), 28.0).segments().collect());
        let placed = place(&tabs(TabPlaces::Count(2)), &circle, 30.0, 0.0);
        assert_eq!((placed.line.count(), placed.on_arcs), (2, 2));
    }
}
