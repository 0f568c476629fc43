//! Pieces that are left standing to hold a part: where along a path they are, and how high the tool passes over them.

use super::walk::Walk;
use super::{TabPlaces, Tabs};
use crate::plane::{Link, Point, Segment, turn_angle};

/// Length of a tab's flank in heights of the tab: its steepest place, in the middle, then has 45 degrees.
const FLANK: f64 = 1.5;

/// Straight pieces of a flank: the polygon keeps within 1 % of the tab's height of the smooth curve.
const FLANK_PIECES: usize = 8;

/// Arcs of the path tighter than this, in tool diameters, are no places for tabs: a knife cuts straight.
const TIGHT: f64 = 1.0;

/// How finely places for tabs are sought along a path, in parts of its length.
const SEARCH_STEPS: usize = 720;

/// The tabs of one path.
#[derive(Clone, Debug, Default)]
pub(super) struct TabLine {
    /// Where along the path their middles are, in [0, length).
    middles: Vec<f64>,
    /// Half the length over which the tool stays up.
    plateau: f64,
    /// z of the tool over a tab.
    top: f64,
    /// Height of a tab.
    height: f64,
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
}

impl TabLine {
    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.middles.len()
    }

    /// The middles of the tabs on the path.
    pub(super) fn points(&self, walk: &Walk) -> Vec<Point> {
        self.middles.iter().map(|&way| walk.point_at(way)).collect()
    }

    /// The lowest that the tool may be at `way`, which may be several times around.
    pub(super) fn lowest(&self, way: f64) -> f64 {
        let mut lowest = f64::NEG_INFINITY;
        for middle in &self.middles {
            let apart = (way - middle).rem_euclid(self.length);
            let distance = apart.min(self.length - apart) - self.plateau;
            let flank = FLANK * self.height;
            if distance <= 0.0 {
                return self.top;
            }
            if distance < flank {
                let t = distance / flank;
                lowest = lowest.max(self.top - self.height * t * t * (3.0 - 2.0 * t));
            }
        }
        lowest
    }

    /// The places between `from` and `from + length` where the way over the tabs bends, in order.
    pub(super) fn bends(&self, from: f64, length: f64) -> Vec<f64> {
        let mut bends = Vec::new();
        let flank = FLANK * self.height;
        for middle in &self.middles {
            let offsets = (0..=FLANK_PIECES).map(|k| self.plateau + flank * (k as f64 / FLANK_PIECES as f64));
            for offset in offsets.flat_map(|o| [-o, o]) {
                let mut way = (middle + offset - from).rem_euclid(self.length);
                while way < length {
                    bends.push(from + way);
                    way += self.length;
                }
            }
        }
        bends.sort_by(f64::total_cmp);
        bends
    }

    /// Places tabs along `walk`, off its start, tight arcs and each other.
    pub(super) fn place(tabs: &Tabs, walk: &Walk, floor: f64, tool_diameter: f64, seam: f64) -> Placed {
        let length = walk.length();
        let plateau = 0.5 * (tabs.width + tool_diameter);
        let reach = plateau + FLANK * tabs.height;
        let wanted: Vec<f64> = match &tabs.places {
            TabPlaces::Count(count) => evenly(*count, length),
            TabPlaces::Spacing(spacing) => evenly(((length / spacing).round() as usize).max(2), length),
            TabPlaces::At(points) => {
                points.iter().map(|p| walk.nearest_way(Point::new(p[0], p[1]))).filter_map(|(way, _)| way).collect()
            }
        };
        let mut placed = Placed { asked: wanted.len(), ..Placed::default() };
        let line = TabLine { middles: Vec::new(), plateau, top: floor + tabs.height, height: tabs.height, length };
        placed.line = line;
        let tight = tight_stretches(walk.segments(), TIGHT * tool_diameter);
        let spikes = spikes(walk.segments());
        for way in wanted {
            let free = |at: f64, arcs: bool| {
                let clear = |middle: f64, other: f64| {
                    let apart = (at - middle).rem_euclid(length);
                    apart.min(length - apart) >= reach + other
                };
                let is_on_spike = spikes.iter().any(|&(a, b)| overlaps(at, plateau, a, b, length));
                clear(0.0, seam)
                    && !is_on_spike
                    && placed.line.middles.iter().all(|&m| clear(m, reach))
                    && (arcs || !tight.iter().any(|&(a, b)| overlaps(at, plateau, a, b, length)))
            };
            // As near as can be to where it is wanted.
            let nearest_free = |arcs: bool| {
                (0..=SEARCH_STEPS / 2)
                    .flat_map(|k| [k as f64, -(k as f64)])
                    .map(|k| (way + k * length / SEARCH_STEPS as f64).rem_euclid(length))
                    .find(|&at| free(at, arcs))
            };
            if let Some(at) = nearest_free(false) {
                placed.line.middles.push(at);
            } else if let Some(at) = nearest_free(true) {
                placed.line.middles.push(at);
                placed.on_arcs += 1;
            }
        }
        placed.line.middles.sort_by(f64::total_cmp);
        placed
    }
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

/// The stretches out to corners and back: the tool passes them twice, and a tab on one way would be cut on the other.
fn spikes(segments: &[Segment]) -> Vec<(f64, f64)> {
    let n = segments.len();
    let mut ways = vec![0.0];
    for segment in segments {
        ways.push(ways[ways.len() - 1] + segment.length());
    }
    let turns_back =
        |k: usize| turn_angle(segments[k].end_tangent(), segments[k + 1].start_tangent()).abs() > ABOUT_TURN;
    (0..n.saturating_sub(1)).filter(|&k| turns_back(k)).map(|k| (ways[k], ways[k + 2])).collect()
}

/// Turns of more than this, in radians, are out and back: 170 degrees.
const ABOUT_TURN: f64 = 2.97;

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

    #[test]
    fn tabs_stand_evenly_and_are_as_long_and_high_as_asked() {
        let placed = TabLine::place(&tabs(TabPlaces::Count(4)), &square(), -6.0, 3.0, 0.0);
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
    fn tabs_keep_off_seams_tight_arcs_and_each_other() {
        let near_seam = tabs(TabPlaces::At(vec![[1.0, 0.0], [2.0, 0.0]]));
        let placed = TabLine::place(&near_seam, &square(), -6.0, 3.0, 5.0);
        assert_eq!(placed.line.count(), 2);
        let points = placed.line.points(&square());
        assert!(points[0].x >= 12.4, "{points:?}");
        assert!((placed.line.middles[1] - placed.line.middles[0]).abs() >= 15.0);
        // A circle of 4 mm with tabs of 6 mm: nowhere room for six.
        let circle = Walk::new(Ring::circle(Point::origin(), 2.0).segments().collect());
        let placed = TabLine::place(&tabs(TabPlaces::Count(6)), &circle, -6.0, 3.0, 0.0);
        assert!(placed.line.count() < placed.asked);
        // A larger one is one tight arc all around for a tool of 30 mm, and bears a tab all the same.
        let circle = Walk::new(Ring::circle(Point::origin(), 28.0).segments().collect());
        let placed = TabLine::place(&tabs(TabPlaces::Count(2)), &circle, -6.0, 30.0, 0.0);
        assert_eq!((placed.line.count(), placed.on_arcs), (2, 2));
    }
}
