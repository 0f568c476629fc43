//! The medial axis of shapes of many kinds: what holds of every axis.

mod shapes;

use clopen::plane::{
    AxisNode, BoundaryIndex, Joint, Link, MedialAxis, Point, Region, Segment, Vector, medial_axis, turn_angle,
};
use clopen::rolling::{Topology, close, open};
use clopen::units::Radius;

/// How far a node may be from equidistant, relative to the size of the shape: branch points between elements that are
/// almost parallel are the least certain.
const EQUIDISTANT: f64 = 1e-8;

fn is_below_chord_everywhere(a: &AxisNode, b: &AxisNode, index: &BoundaryIndex, slack: f64) -> bool {
    (0..=8).all(|k| {
        let t = f64::from(k) / 8.0;
        let p = a.point + (b.point - a.point) * t;
        a.clearance + (b.clearance - a.clearance) * t <= index.distance(p) + slack
    })
}

/// By how much the disks between two nodes miss `p`, at least; negative inside. The function is convex along the chord.
fn gap_to_chord(a: &AxisNode, b: &AxisNode, p: Point) -> f64 {
    let gap = |t: f64| {
        let center = a.point + (b.point - a.point) * t;
        (p - center).norm() - (a.clearance + (b.clearance - a.clearance) * t)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let (s, t) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if gap(s) < gap(t) { high = t } else { low = s }
    }
    gap(0.5 * (low + high)).min(gap(0.0)).min(gap(1.0))
}

fn components(axis: &MedialAxis) -> usize {
    let mut root: Vec<usize> = (0..axis.nodes.len()).collect();
    fn find(root: &[usize], mut k: usize) -> usize {
        while root[k] != k {
            k = root[k];
        }
        k
    }
    for e in &axis.edges {
        let (a, b) = (find(&root, e.ends[0]), find(&root, e.ends[1]));
        root[a] = b;
    }
    (0..root.len()).filter(|&k| root[k] == k).count()
}

/// Whether the disk touches the boundary in two directions, or all along an arc.
fn is_maximal(node: &AxisNode, region: &Region, slack: f64) -> bool {
    let mut first: Option<Vector> = None;
    region.segments().any(|s| {
        let near = s.nearest(node.point);
        let at_center = |s: &Segment| matches!(s.link, Link::Arc(a) if (a.center - node.point).norm() <= slack);
        if (near.distance - node.clearance).abs() > slack {
            return false;
        }
        let spoke = (near.point - node.point) / node.clearance;
        let apart = first.is_some_and(|f| (f - spoke).norm() > 1e-9);
        first = first.or(Some(spoke));
        apart || at_center(&s)
    })
}

fn assert_is_axis(name: &str, region: &Region, tolerance: f64) {
    let axis = medial_axis(region, tolerance);
    let index = BoundaryIndex::new(region);
    let size = region.bounds().diagonal();
    let slack = EQUIDISTANT * size;
    for node in axis.edges.iter().flat_map(|e| &e.nodes).chain(&axis.nodes) {
        let distance = index.distance(node.point);
        assert!((distance - node.clearance).abs() <= 1e-9 * size, "{name}: {node:?} has distance {distance}");
        assert!(node.clearance <= slack || region.contains(node.point), "{name}: {node:?} is outside");
        assert!(node.clearance <= slack || is_maximal(node, region, slack), "{name}: {node:?} is not on the axis");
    }
    for e in &axis.edges {
        assert!((e.nodes[0].point - axis.nodes[e.ends[0]].point).norm() == 0.0, "{name}");
        assert!((e.nodes[e.nodes.len() - 1].point - axis.nodes[e.ends[1]].point).norm() == 0.0, "{name}");
        for w in e.nodes.windows(2) {
            assert!(is_below_chord_everywhere(&w[0], &w[1], &index, tolerance), "{name}: chord {w:?} gouges");
        }
    }
    let topology = region.topology();
    let pieces = components(&axis);
    assert_eq!(pieces, topology.components, "{name}: connected pieces");
    assert_eq!(axis.edges.len() + pieces - axis.nodes.len(), topology.holes, "{name}: cycles");
    for ring in &region.rings {
        let n = ring.len();
        for i in 0..n {
            let (before, after) = (ring.segment((i + n - 1) % n), ring.segment(i));
            let turn = turn_angle(before.end_tangent(), after.start_tangent());
            if turn > 0.01 && ring.vertices[i].joint == Joint::Corner {
                let reached = axis.nodes.iter().any(|k| k.clearance == 0.0 && (k.point - after.start).norm() <= slack);
                assert!(reached, "{name}: no branch to the corner {} of {turn}", after.start);
            }
        }
    }
    const GRID: u32 = 28;
    let bounds = region.bounds();
    for k in 0..GRID * GRID {
        let at = |k: u32, low: f64, side: f64| low + side * (f64::from(k) + 0.4321) / f64::from(GRID);
        let p = Point::new(at(k % GRID, bounds.min.x, bounds.width()), at(k / GRID, bounds.min.y, bounds.height()));
        if !region.contains(p) {
            continue;
        }
        let gap_to = |n: &AxisNode| (p - n.point).norm() - n.clearance;
        let is_in_chord = |a: &AxisNode, b: &AxisNode| {
            // The gap changes at most twice as fast as the place.
            0.5 * (gap_to(a) + gap_to(b)) - (a.point - b.point).norm() <= tolerance
                && gap_to_chord(a, b, p) <= tolerance
        };
        let is_covered = axis.nodes.iter().any(|n| gap_to(n) <= tolerance)
            || axis.edges.iter().flat_map(|e| e.nodes.windows(2)).any(|w| is_in_chord(&w[0], &w[1]));
        assert!(is_covered, "{name}: {p} is in no disk of the axis");
    }
}

#[test]
fn shapes_of_all_kinds_have_an_axis() {
    for number in 0..120 {
        let (name, region) = shapes::mixed(number);
        assert_is_axis(&name, &region, 1e-3);
    }
}

#[test]
fn shapes_turned_scaled_and_far_away_have_an_axis_too() {
    for number in 0..60 {
        let (name, region) = shapes::mixed(number);
        let placed = shapes::placed(&region, 0.3 + number as f64, 20.0, Vector::new(3000.0, -1500.0));
        assert_is_axis(&format!("{name}, placed"), &placed, 1e-3);
    }
}

#[test]
fn shapes_with_round_corners_have_an_axis() {
    let mut arcs = 0;
    for number in 0..80 {
        let (name, region) = shapes::mixed(number);
        let radius = Radius::new(0.4).unwrap();
        let closed = close(&region, radius, Topology::Merge).region;
        let opened = open(&region, radius, Topology::Merge).region;
        for (name, round) in [(format!("{name}, closed"), closed), (format!("{name}, opened"), opened)] {
            arcs += round.segments().filter(|s| s.link != Link::Line).count();
            assert_is_axis(&name, &round, 1e-3);
        }
    }
    assert!(arcs > 500, "{arcs}");
}

#[test]
fn an_axis_is_that_of_the_same_region_begun_elsewhere() {
    let (_, region) = shapes::mixed(12);
    let mut rotated = region.clone();
    rotated.rings.iter_mut().for_each(|r| r.vertices.rotate_left(3));
    rotated.rings.reverse();
    let length = |r: &Region| -> f64 {
        let axis = medial_axis(r, 1e-4);
        axis.edges.iter().flat_map(|e| e.nodes.windows(2)).map(|w| (w[0].point - w[1].point).norm()).sum()
    };
    let (a, b) = (length(&region), length(&rotated));
    assert!(a > 1.0 && (a - b).abs() < 1e-4 * a, "{a} {b}");
}
