//! The ways of a carving as a network, and the long chains that run along all of it.
//!
//! Few lifts: a chain goes on through a branch as straight as it can, until nothing is left there. One that begins at a node
//! with an odd number of ways ends at another one, so that no network can do with fewer chains than half of these; rounds
//! that are left over where a chain passes are put into it (Hierholzer).

use std::collections::BTreeMap;

use super::stretch::below;
use crate::cam::Point3;
use crate::plane::Vector;

/// Ends of ways nearer than this are one node, in millimetres: half of what a carving may be off.
const ONE_NODE: f64 = 5e-4;

/// Ways that meet at nodes.
#[derive(Default)]
pub(super) struct Network {
    ways: Vec<Vec<Point3>>,
    /// The nodes where each begins and ends.
    ends: Vec<[usize; 2]>,
    places: Vec<Point3>,
    /// The ways at every node, a loop twice.
    at: Vec<Vec<usize>>,
    cells: BTreeMap<(i64, i64), Vec<usize>>,
}

/// A way and whether it is run backwards.
type Run = (usize, bool);

impl Network {
    /// The network of `ways`, and of `rings`, closed, which are divided where a way ends on one of their corners.
    pub fn new(ways: &[Vec<Point3>], rings: &[Vec<Point3>]) -> Network {
        let mut network = Network::default();
        for way in ways {
            network.add(way.clone());
        }
        for ring in rings {
            let n = ring.len();
            let corners: Vec<usize> = (0..n).filter(|&k| network.find(&ring[k]).is_some()).collect();
            let corners = if corners.is_empty() { vec![0] } else { corners };
            for (i, &from) in corners.iter().enumerate() {
                let to = corners.get(i + 1).copied().unwrap_or(corners[0] + n);
                network.add((from..=to).map(|k| ring[k % n]).collect());
            }
        }
        network
    }

    /// What a pass down to `height` has to cut when all above `above` is cut.
    pub fn pass(&self, above: f64, height: f64) -> Network {
        let mut network = Network::default();
        for stretch in self.ways.iter().flat_map(|way| below(way, above)) {
            // Nothing is left to cut where a stretch only touches the height of the pass before.
            if above.is_infinite() || stretch.iter().any(|p| p.z < above) {
                network.add(raised(&stretch, height));
            }
        }
        network
    }

    fn cell(p: &Point3) -> (i64, i64) {
        // Saturates far away, where all share a cell.
        ((p.x / ONE_NODE).floor() as i64, (p.y / ONE_NODE).floor() as i64)
    }

    fn find(&self, p: &Point3) -> Option<usize> {
        let (x, y) = Network::cell(p);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        let near = around.filter_map(|c| self.cells.get(&c)).flatten().copied();
        let distance = |k: usize| (self.places[k] - p).norm();
        near.filter(|&k| distance(k) <= ONE_NODE).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    fn node(&mut self, p: &Point3) -> usize {
        if let Some(node) = self.find(p) {
            return node;
        }
        let node = self.places.len();
        self.places.push(*p);
        self.at.push(vec![]);
        self.cells.entry(Network::cell(p)).or_default().push(node);
        node
    }

    fn add(&mut self, way: Vec<Point3>) {
        let (Some(first), Some(last)) = (way.first(), way.last()) else { return };
        let ends = [*first, *last].map(|p| self.node(&p));
        ends.iter().for_each(|&e| self.at[e].push(self.ways.len()));
        self.ways.push(way);
        self.ends.push(ends);
    }

    /// Chains along all ways, the next one always that which begins or ends nearest to where the one before ended; `here` is
    /// where the tool is, and will be.
    pub fn chains(&self, here: &mut Vector) -> Vec<Vec<Point3>> {
        let mut chains: Vec<Vec<Point3>> = self.trails().iter().map(|trail| self.chain(trail)).collect();
        let mut ordered = Vec::with_capacity(chains.len());
        let gap = |p: Option<&Point3>, from: &Vector| p.map_or(f64::INFINITY, |p| (p.coords.xy() - from).norm());
        while !chains.is_empty() {
            let distance = |c: &[Point3]| gap(c.first(), here).min(gap(c.last(), here));
            let nearest = (0..chains.len()).min_by(|&a, &b| distance(&chains[a]).total_cmp(&distance(&chains[b])));
            let mut chain = chains.swap_remove(nearest.unwrap_or(0));
            if gap(chain.last(), here) < gap(chain.first(), here) {
                chain.reverse();
            }
            if let Some(last) = chain.last() {
                *here = last.coords.xy();
            }
            ordered.push(chain);
        }
        ordered
    }

    fn chain(&self, trail: &[Run]) -> Vec<Point3> {
        let mut chain: Vec<Point3> = Vec::new();
        for &(way, backwards) in trail {
            let mut points = self.ways[way].clone();
            if backwards {
                points.reverse();
            }
            chain.extend(points);
        }
        chain.dedup();
        chain
    }

    /// Every way in one trail, once.
    fn trails(&self) -> Vec<Vec<Run>> {
        let mut is_free = vec![true; self.ways.len()];
        let mut odd: Vec<usize> = (0..self.places.len()).filter(|&k| self.at[k].len() % 2 == 1).collect();
        // Where it is highest the tool has the least to plunge through.
        odd.sort_by(|&a, &b| self.places[b].z.total_cmp(&self.places[a].z).then(a.cmp(&b)));
        let mut trails = Vec::new();
        for node in odd {
            let has_odd_left = self.at[node].iter().filter(|&&w| is_free[w]).count() % 2 == 1;
            if has_odd_left {
                trails.push(self.trail(node, &mut is_free));
            }
        }
        for trail in &mut trails {
            self.put_rounds_in(trail, &mut is_free);
        }
        for way in 0..self.ways.len() {
            if is_free[way] {
                let mut trail = self.trail(self.ends[way][0], &mut is_free);
                self.put_rounds_in(&mut trail, &mut is_free);
                trails.push(trail);
            }
        }
        trails
    }

    /// From a node on along free ways, as straight as possible, until there is none.
    fn trail(&self, start: usize, is_free: &mut [bool]) -> Vec<Run> {
        let mut trail: Vec<Run> = Vec::new();
        let mut node = start;
        let mut heading = Vector::zeros();
        loop {
            let runs = self.at[node].iter().filter(|&&w| is_free[w]).flat_map(|&w| {
                let [from, to] = self.ends[w];
                [(from, false), (to, true)].into_iter().filter(|e| e.0 == node).map(move |e| (w, e.1))
            });
            let straightness = |run: &Run| self.heading(*run, false).dot(&heading);
            let best = runs.max_by(|a, b| straightness(a).total_cmp(&straightness(b)).then(b.cmp(a)));
            let Some(run) = best else { return trail };
            is_free[run.0] = false;
            heading = self.heading(run, true);
            node = self.ends[run.0][usize::from(!run.1)];
            trail.push(run);
        }
    }

    /// Direction of a run in the plane, at its start or its end.
    fn heading(&self, (way, backwards): Run, at_end: bool) -> Vector {
        let points = &self.ways[way];
        let step = match (points.len(), backwards == at_end) {
            (0 | 1, _) => return Vector::zeros(),
            (_, true) => points[1] - points[0],
            (n, false) => points[n - 1] - points[n - 2],
        };
        let direction = step.xy().try_normalize(0.0).unwrap_or(Vector::zeros());
        if backwards { -direction } else { direction }
    }

    /// Puts rounds over ways that are still free into a trail that passes them.
    fn put_rounds_in(&self, trail: &mut Vec<Run>, is_free: &mut [bool]) {
        let mut k = 0;
        while k < trail.len() {
            let (way, backwards) = trail[k];
            let start = self.ends[way][usize::from(backwards)];
            let round = self.trail(start, is_free);
            let is_none = round.is_empty();
            trail.splice(k..k, round);
            if is_none {
                k += 1;
            }
        }
    }
}

/// The way with what lies below `height` raised to it.
fn raised(way: &[Point3], height: f64) -> Vec<Point3> {
    let mut out: Vec<Point3> = Vec::with_capacity(way.len());
    for (k, p) in way.iter().enumerate() {
        if let Some(before) = k.checked_sub(1).map(|k| &way[k])
            && (before.z - height) * (p.z - height) < 0.0
        {
            let cut = before + (p - before) * ((height - before.z) / (p.z - before.z));
            out.push(Point3::new(cut.x, cut.y, height));
        }
        out.push(Point3::new(p.x, p.y, p.z.max(height)));
    }
    out
}
