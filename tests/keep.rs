//! The closing that keeps the topology: what it left wrong once, and the flow whose limit it is.

mod laws;

use clopen::flow::{CurveFlow, DEFAULT_EDGE, Field, Obstacle, Settings, Status};
use clopen::plane::{Joint, Link, Point, Region, Ring, Vertex};
use clopen::reference::{self, Operation};
use clopen::rolling::{self, Topology};

/// What a distance between equal boundaries may be.
const ROUNDING: f64 = 1e-14;

fn polygon(points: &[(f64, f64)]) -> Ring {
    Ring::polygon(points.iter().map(|&(x, y)| Point::new(x, y)))
}

/// A domed chamber and a box, joined by a channel narrower than the disk of radius 1. The dome is a curve of radius 1.6 in
/// chords; where it meets the floor, the disk touches one of them anywhere along it.
fn chambers(chords: u32) -> Ring {
    const DOME: f64 = 1.6;
    const FLOOR: f64 = -0.7;
    let first = (FLOOR / DOME).asin();
    let sweep = std::f64::consts::PI - 2.0 * first;
    let dome = (0..=chords).map(|k| {
        let (sin, cos) = (first + sweep * f64::from(k) / f64::from(chords)).sin_cos();
        let joint = if k == 0 || k == chords { Joint::Corner } else { Joint::Smooth };
        Vertex { joint, ..Vertex::corner(Point::new(DOME * cos, DOME * sin)) }
    });
    let rest = [(-0.25, FLOOR), (-0.25, -3.0), (-2.0, -3.0), (-2.0, -6.0), (2.0, -6.0), (2.0, -3.0), (0.25, -3.0)];
    let rest = rest.into_iter().chain([(0.25, FLOOR)]).map(|(x, y)| Vertex::corner(Point::new(x, y)));
    Ring { vertices: dome.chain(rest).collect() }
}

fn both(input: &Region, operation: Operation) -> [rolling::Outcome; 2] {
    let run = if operation == Operation::Close { rolling::close } else { rolling::open };
    [Topology::Keep, Topology::Merge].map(|topology| run(input, laws::radius(1.0), topology))
}

/// What holds of a kept result whatever the shape.
fn obeys(input: &Region, kept: &rolling::Outcome, operation: Operation) {
    assert_eq!(kept.contradictions, 0);
    assert_eq!(laws::crossing(&kept.region, 1.0), None);
    let (violation, place) = laws::containment(input, &kept.region, operation, 1.0);
    assert!(violation <= 1e-9, "containment fails by {violation} at {place}");
}

/// How far the limit of the flow and a result lie apart, in edge lengths of the flow, and where.
fn from_the_flow(input: &Region, operation: Operation, result: &Region) -> (f64, Point) {
    let obstacle = if operation == Operation::Close { Obstacle::CLOSING } else { Obstacle::OPENING };
    let mut flow = CurveFlow::new(input, obstacle, Field::constant(laws::radius(1.0)), &Settings::default()).unwrap();
    assert!(matches!(flow.run(f64::INFINITY), Status::Ended(end) if end.is_limit()));
    assert_eq!(flow.report().contacts, []);
    let (distance, place) = laws::hausdorff(&flow.region(), result, 0.1 * DEFAULT_EDGE);
    (distance / DEFAULT_EDGE, place)
}

#[test]
fn chords_that_an_arc_has_shortened_are_still_chords_of_a_curve() {
    let plate = polygon(&[(-8.0, -10.0), (8.0, -10.0), (8.0, 6.0), (-8.0, 6.0)]);
    let mut shortened = 0;
    for chords in [150, 157, 163, 170] {
        let chambers = chambers(chords);
        let pocket = Region::new(vec![plate.clone(), chambers.reversed()]);
        for (input, operation) in [(Region::new(vec![chambers]), Operation::Open), (pocket, Operation::Close)] {
            let [kept, merged] = both(&input, operation);
            obeys(&input, &kept, operation);
            // In the plane the channel is cut through; along the curve nothing in it moves.
            assert_eq!(kept.region.rings.len() + 1, merged.region.rings.len());
            assert_ne!(kept.differences, []);
            let (error, place) = from_the_flow(&input, operation, &kept.region);
            assert!(error <= 0.05, "{chords} chords, {operation:?}: {error} h at {place}");
            // The disk touches the chord that leaves the dome's last sample in its first half, or the other way round.
            let dome = kept.region.segments().filter(|s| s.link == Link::Line && s.start.y > 0.0 && s.end.y > 0.0);
            let lengths: Vec<f64> = dome.map(|s| s.length()).filter(|&l| l < 0.1).collect();
            let (least, most) = lengths.iter().fold((1.0, 0.0), |(a, b): (f64, f64), &l| (a.min(l), b.max(l)));
            shortened += usize::from(least < 0.5 * most);
            // What has been rolled along is left as it is.
            let again = both(&kept.region, operation);
            for outcome in [&again[0], &both(&merged.region, operation)[1]] {
                assert_eq!(outcome.contradictions, 0);
            }
            assert!(laws::hausdorff(&again[0].region, &kept.region, 1.0).0 <= ROUNDING, "{chords} {operation:?}");
        }
    }
    assert!(shortened > 0);
}

/// A bar of height 2 with a gap of 6 in it: disks of radius 5 rest on the four corners of the gap from above and from
/// below, and touch each other in its middle. Found at "n" of the word of the samples, which was lost.
#[test]
fn disks_that_touch_each_other_from_both_sides_of_a_gap() {
    let ends = [
        polygon(&[(-30.0, -1.0), (-3.0, -1.0), (-3.0, 1.0), (-30.0, 1.0)]),
        polygon(&[(3.0, -1.0), (30.0, -1.0), (30.0, 1.0), (3.0, 1.0)]),
    ];
    for turned in [0.0, 0.1, 0.7, 1.3, 2.9] {
        let (sin, cos) = f64::sin_cos(turned);
        let mut input = Region::new(ends.to_vec());
        for v in input.rings.iter_mut().flat_map(|ring| &mut ring.vertices) {
            v.point = Point::new(cos * v.point.x - sin * v.point.y, sin * v.point.x + cos * v.point.y);
        }
        let radius = laws::radius(5.0);
        for (operation, input) in [(Operation::Close, input.clone()), (Operation::Open, input.reversed())] {
            let merge = if operation == Operation::Close { rolling::close } else { rolling::open };
            // An opening of the empty plane around: solid far away.
            let merged = merge(&input, radius, Topology::Merge);
            assert_eq!(merged.contradictions, 0, "{operation:?} turned by {turned}");
            // Two segments under the arcs, of half-angle a: the middle of the gap is filled but for them.
            let a = f64::asin(0.6);
            let filled = 6.0 * 2.0 - 25.0 * (2.0 * a - f64::sin(2.0 * a));
            let added = merged.region.area().abs() - input.area().abs();
            assert!((added - filled).abs() < 1e-6, "{operation:?} turned by {turned}: {added} is not {filled}");
        }
        let reference = reference::closing(&input, radius, Operation::Close).unwrap();
        let merged = rolling::close(&input, radius, Topology::Merge);
        let (distance, place) = laws::hausdorff(&merged.region, &reference.region, 5.0);
        assert!(distance < 1e-3, "{distance} from the reference at {place}");
    }
}

/// A plate with a concave corner at the origin, of which the disk of radius 1 fills (√2 - 1) of the diagonal, and with a
/// slit too narrow for the disk. `finger` reaches into the corner: on the plate itself, or a part of its own.
fn corner_with_a_finger(finger: &[(f64, f64)], on_the_plate: bool) -> Region {
    let corner = [(0.0, 8.0), (-4.0, 8.0), (-4.0, -4.0), (8.0, -4.0)];
    // The walls of the slit do not see each other along the curve: each ends in wide space, and so does each lip.
    let slit =
        [(8.0, -2.25), (3.0, -2.25), (3.0, -3.2), (0.6, -3.2), (0.6, -0.8), (3.0, -0.8), (3.0, -1.75), (8.0, -1.75)];
    let around: Vec<(f64, f64)> = corner.into_iter().chain(slit).collect();
    let finger: Vec<(f64, f64)> = finger.to_vec();
    if on_the_plate {
        Region::new(vec![polygon(&[around, finger, vec![(0.0, 0.0)]].concat())])
    } else {
        Region::new(vec![polygon(&[around, vec![(8.0, 0.0), (0.0, 0.0)]].concat()), polygon(&finger)])
    }
}

#[test]
fn outlines_that_run_into_each_other_are_joined_there_and_nowhere_else() {
    let island = [(0.2, 0.15), (0.5, 0.15), (0.5, 0.45), (0.2, 0.45)];
    // From the end of the lower wall, far over the disk's way, and back into the corner.
    let bridge =
        [(8.0, 0.0), (7.9, 0.0), (7.9, 6.0), (0.2, 6.0), (0.2, 0.2), (0.3, 0.2), (0.3, 5.9), (7.8, 5.9), (7.8, 0.0)];
    for (name, input) in
        [("island", corner_with_a_finger(&island, false)), ("bridge", corner_with_a_finger(&bridge, true))]
    {
        let slit_ends =
            |region: &Region| region.segments().filter(|s| s.start.x > 2.5 && (s.start.y + 2.0).abs() < 0.3).count();
        for (operation, input) in [(Operation::Close, input.clone()), (Operation::Open, input.reversed())] {
            let run = if operation == Operation::Close { rolling::close } else { rolling::open };
            let kept = run(&input, laws::radius(1.0), Topology::Keep);
            assert_eq!(kept.contradictions, 0, "{name} {operation:?}");
            assert_ne!(kept.differences, [], "{name} {operation:?}");
            let solid = if operation == Operation::Close { kept.region.clone() } else { kept.region.reversed() };
            assert_eq!(laws::crossing(&solid, 1.0), None, "{name} {operation:?}");
            // The island is a part of the plate now, and the bridge encloses a hole.
            let parts = solid.rings.iter().filter(|ring| ring.area() > 0.0).count();
            assert_eq!(parts, 1, "{name} {operation:?}");
            assert_eq!(solid.rings.len(), if name == "island" { 1 } else { 2 }, "{name} {operation:?}");
            // The slit is far from there, and stays as the flow leaves it.
            assert_eq!(slit_ends(&solid), slit_ends(&input), "{name} {operation:?}");
            let again = run(&kept.region, laws::radius(1.0), Topology::Keep);
            assert_eq!(again.contradictions, 0, "{name} {operation:?}");
            assert!(laws::hausdorff(&again.region, &kept.region, 1.0).0 <= ROUNDING, "{name} {operation:?}");
        }
    }
}
