//! The flow of outlines: its limit, its states, and what it leaves alone.

mod shapes;

use clopen::flow::{CurveFlow, DEFAULT_EDGE, End, Field, FlowError, Obstacle, OnContact, Settings, Status};
use clopen::plane::{BoundaryIndex, Link, Point, Region, Ring, Vector, Vertex, VertexId};
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use shapes::hausdorff;

fn radius() -> Radius {
    Radius::new(1.0).unwrap()
}

fn start(region: &Region, obstacle: Obstacle, edge: f64) -> CurveFlow<'static> {
    let settings = Settings { edge, ..Settings::default() };
    CurveFlow::new(region, obstacle, Field::constant(radius()), &settings).unwrap()
}

/// The region with an identity for every vertex.
fn numbered(region: &Region) -> Region {
    let mut region = region.clone();
    let vertices = region.rings.iter_mut().flat_map(|r| &mut r.vertices);
    vertices.enumerate().for_each(|(k, v)| v.id = Some(VertexId::from_index(k)));
    region
}

/// How far `inner` sticks out of `outer` at its vertices and the middles of its edges.
fn sticks_out(inner: &Region, outer: &Region) -> f64 {
    let index = BoundaryIndex::new(outer);
    let far = i32::from(outer.area() < 0.0);
    let places = inner.segments().flat_map(|s| [s.start, s.point_at(0.5)]);
    let out = |p: Point| if index.winding_number(p) + far > 0 { 0.0 } else { index.distance(p) };
    places.map(out).fold(0.0, f64::max)
}

#[test]
fn the_limit_is_the_exact_closing_and_opening() {
    let mut tried = 0;
    for (name, region) in shapes::flow_shapes() {
        for (obstacle, exact) in [
            (Obstacle::CLOSING, rolling::close(&region, radius(), Topology::Keep)),
            (Obstacle::OPENING, rolling::open(&region, radius(), Topology::Keep)),
        ] {
            let mut flow = start(&region, obstacle, DEFAULT_EDGE);
            let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("{name} goes on") };
            assert!(end.is_limit(), "{name} {obstacle:?}: {end:?}");
            let error = hausdorff(&flow.region(), &exact.region, 0.1 * DEFAULT_EDGE) / DEFAULT_EDGE;
            assert!(error <= 0.05, "{name} {obstacle:?}: {error} h");
            let error = hausdorff(&flow.rounded(), &exact.region, 0.1 * DEFAULT_EDGE) / DEFAULT_EDGE;
            assert!(error <= 0.05, "{name} {obstacle:?}, arcs: {error} h");
            tried += 1;
        }
    }
    assert_eq!(tried, 16);
}

#[test]
fn arcs_follow_the_chords_and_need_far_fewer_vertices() {
    let (mut tried, mut fewer) = (0, 0);
    for (name, region) in shapes::flow_shapes() {
        let region = numbered(&region);
        for time in [0.02, f64::INFINITY] {
            let mut flow = start(&region, Obstacle::CLOPENING, DEFAULT_EDGE);
            flow.run(time);
            let (chords, arcs) = (flow.region(), flow.rounded());
            // The sagitta of the chords, which is large where corners have just begun to flow, and what arcs may stray.
            let most = if time < 1.0 { 0.12 } else { 0.05 };
            let apart = hausdorff(&chords, &arcs, 0.1 * DEFAULT_EDGE) / DEFAULT_EDGE;
            assert!(apart <= most, "{name} at {time}: {apart} h");
            let ids = |r: &Region| r.rings.iter().flat_map(|r| &r.vertices).filter_map(|v| v.id).collect::<Vec<_>>();
            assert_eq!(ids(&chords), ids(&arcs), "{name} at {time}");
            assert_eq!(chords.topology(), arcs.topology());
            let moved = |r: &Region| r.vertex_count() - ids(r).len();
            fewer += usize::from(2 * moved(&arcs) < moved(&chords));
            tried += 1;
        }
    }
    assert!(3 * fewer > tried, "{fewer} of {tried}");
}

#[test]
fn states_at_the_same_time_do_not_depend_on_the_edge_length() {
    for (name, region) in shapes::flow_shapes().into_iter().filter(|(name, _)| ["corner", "serif"].contains(name)) {
        for obstacle in [Obstacle::CLOSING, Obstacle::OPENING] {
            let mut flows = [1.0, 0.5].map(|f| start(&region, obstacle, f * DEFAULT_EDGE));
            for time in [0.02, 0.1, 0.5] {
                for flow in &mut flows {
                    flow.run(time);
                }
                let [a, b] = [flows[0].region(), flows[1].region()];
                let difference = hausdorff(&a, &b, 0.05 * DEFAULT_EDGE);
                assert!(difference <= 0.01, "{name} {obstacle:?} at {time}: {difference} r");
            }
        }
    }
}

#[test]
fn what_does_not_move_stays_bit_for_bit() {
    for (name, region) in shapes::flow_shapes() {
        let region = numbered(&region);
        let input: Vec<Vertex> = region.rings.iter().flat_map(|r| &r.vertices).copied().collect();
        for obstacle in [Obstacle::CLOSING, Obstacle::OPENING, Obstacle::CLOPENING] {
            let mut flow = start(&region, obstacle, DEFAULT_EDGE);
            flow.run(0.1);
            let output = flow.region();
            let kept: Vec<&Vertex> = output.rings.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_some()).collect();
            assert!(kept.iter().all(|v| input[v.id.unwrap().index()].point == v.point), "{name} {obstacle:?}");
            assert_eq!(kept.len(), flow.report().kept, "{name} {obstacle:?}");
            assert_eq!(output, {
                let mut again = start(&region, obstacle, DEFAULT_EDGE);
                again.run(0.1);
                again.region()
            });
        }
    }
    // A plate with true arcs: the corner moves, the bore stays an arc.
    let mut region = shapes::keyhole(3.0, 2.5, 2.0);
    region.rings.push(Ring::circle(Point::new(-6.0, -6.0), 1.0).reversed());
    let mut flow = start(&numbered(&region), Obstacle::CLOSING, DEFAULT_EDGE);
    flow.run(f64::INFINITY);
    let bore = &flow.region().rings[1];
    assert!(bore.vertices.iter().all(|v| matches!(v.link, Link::Arc(_)) && v.id.is_some()), "{bore:?}");
}

#[test]
fn a_closing_contains_its_input_at_every_time_and_an_opening_is_contained() {
    let mut tried = 0;
    for number in 0..40 {
        let (name, region) = shapes::mixed(number);
        let mut closing = start(&region, Obstacle::CLOSING, 0.2);
        let mut opening = start(&region, Obstacle::OPENING, 0.2);
        let mut before = [region.clone(), region.clone()];
        for time in [0.01, 0.1, 1.0] {
            closing.run(time);
            opening.run(time);
            if !closing.report().contacts.is_empty() || !opening.report().contacts.is_empty() {
                break;
            }
            let after = [closing.region(), opening.region()];
            // Arcs become chords within a ten-thousandth of an edge length.
            const SLACK: f64 = 1e-9 + 1e-4 * 0.2;
            let out = sticks_out(&before[0], &after[0]).max(sticks_out(&after[1], &before[1]));
            assert!(out <= SLACK, "{name} at {time}: {out}");
            before = after;
            tried += 1;
        }
    }
    assert!(tried > 60, "{tried}");
}

#[test]
fn opening_is_closing_of_what_is_empty() {
    for (name, region) in shapes::flow_shapes() {
        let mut opening = start(&region, Obstacle::OPENING, DEFAULT_EDGE);
        let mut closing = start(&region.reversed(), Obstacle::CLOSING, DEFAULT_EDGE);
        opening.run(0.3);
        closing.run(0.3);
        assert_eq!(opening.region(), closing.region().reversed(), "{name}");
        assert_eq!(opening.rounded(), closing.rounded().reversed(), "{name}");
    }
}

#[test]
fn a_small_hole_closes_and_is_gone() {
    let plate = shapes::rectangle(-10.0, -10.0, 10.0, 10.0);
    let hole = Ring::circle(Point::new(1.0, 2.0), 0.5).reversed();
    let mut flow = start(&Region::new(vec![plate.clone(), hole]), Obstacle::CLOSING, DEFAULT_EDGE);
    let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("it goes on") };
    assert!(end.is_limit(), "{end:?}");
    assert_eq!(flow.region(), Region::new(vec![plate]));
    // A circle of radius a shrinks to a point in the time a² / 2.
    assert!((flow.time() - 0.125).abs() < 0.005, "{}", flow.time());
}

#[test]
fn an_outline_much_smaller_than_the_disk_vanishes_and_leaves_nothing_turned_over() {
    for (name, region) in shapes::flow_shapes().into_iter().filter(|(name, _)| *name != "gear") {
        let field = Field::constant(Radius::new(500.0).unwrap());
        let mut flow = CurveFlow::new(&region, Obstacle::OPENING, field, &Settings::default()).unwrap();
        let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("{name} goes on") };
        assert!(end.is_limit(), "{name}: {end:?}");
        assert!(flow.region().is_empty(), "{name}: {:?}", flow.region().topology());
    }
}

#[test]
fn a_circle_shrinks_at_the_speed_of_its_curvature() {
    let circle = Region::new(vec![Ring::circle(Point::origin(), 0.9)]);
    let mut flow = start(&circle, Obstacle::OPENING, DEFAULT_EDGE);
    for time in [0.1, 0.2, 0.3] {
        flow.run(time);
        let expected = (0.81f64 - 2.0 * time).sqrt();
        for v in &flow.region().rings[0].vertices {
            assert!((v.point.coords.norm() - expected).abs() < 2e-3, "{time}: {} for {expected}", v.point);
        }
    }
}

#[test]
fn the_flow_without_a_bound_moves_what_is_curved_and_nothing_else() {
    let square = Region::new(vec![shapes::rectangle(0.0, 0.0, 10.0, 10.0)]);
    let mut flow = start(&square, Obstacle::NONE, DEFAULT_EDGE);
    flow.run(0.2);
    let bounded = {
        let mut f = start(&square, Obstacle::OPENING, DEFAULT_EDGE);
        f.run(f64::INFINITY);
        f.region()
    };
    assert!(sticks_out(&flow.region(), &square) < 1e-9);
    flow.run(3.0);
    assert!(flow.region().area() < bounded.area() - 1.0, "it goes on past the opening");
}

#[test]
fn clopening_bounds_both_sides_at_once() {
    let mut flow = start(&shapes::serif(), Obstacle::CLOPENING, DEFAULT_EDGE);
    let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("it goes on") };
    assert!(end.is_limit(), "{end:?}");
    let region = flow.region();
    let ring = &region.rings[0];
    for i in 0..ring.len() {
        let (into, out) = (ring.segment((i + ring.len() - 1) % ring.len()), ring.segment(i));
        let turn = clopen::plane::turn_angle(into.end - into.start, out.end - out.start);
        // Longer edges are of the drawing, and count as one edge length.
        let counted = |length: f64| if length > 1.5 * DEFAULT_EDGE { DEFAULT_EDGE } else { length };
        let unit = (0.5 * counted(into.length())).asin() + (0.5 * counted(out.length())).asin();
        assert!(turn.abs() <= 1.01 * unit, "turn {turn} for {unit} at {}", out.start);
    }
}

#[test]
fn pinned_vertices_stay_and_the_rest_flows_on() {
    let region = shapes::l_corner(7.0, 3.0);
    // The concave corner at (3, 3) is pinned, the convex ones are not.
    let field = || Field {
        radius: Box::new(|_, _| 1.0),
        pin_distance: Box::new(|p| ((p - Point::new(3.0, 3.0)).norm() - 0.5).max(0.0)),
    };
    let mut closing = CurveFlow::new(&region, Obstacle::CLOSING, field(), &Settings::default()).unwrap();
    assert_eq!(closing.run(f64::INFINITY), Status::Ended(End::Still));
    assert_eq!(closing.region(), region);
    let mut both = CurveFlow::new(&region, Obstacle::CLOPENING, field(), &Settings::default()).unwrap();
    both.run(f64::INFINITY);
    let kept: Vec<Point> = both.region().rings[0].vertices.iter().map(|v| v.point).collect();
    assert!(kept.contains(&Point::new(3.0, 3.0)) && !kept.contains(&Point::new(0.0, 0.0)));
}

/// The largest turn at a vertex of a region, in radians, corners of the drawing aside.
fn largest_turn(region: &Region, corners: &[Point]) -> f64 {
    let mut largest: f64 = 0.0;
    for ring in &region.rings {
        let n = ring.len();
        for k in 0..n {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| ring.vertices[k % n].point);
            if corners.iter().all(|c| (c - b).norm() > 1e-9) {
                largest = largest.max(clopen::plane::turn_angle(b - a, c - b).abs());
            }
        }
    }
    largest
}

#[test]
fn the_flow_joins_what_is_pinned_without_a_corner() {
    // A fillet of radius 1 wants half of its length on the leg that is pinned down to half a radius from the corner.
    let region = shapes::l_corner(7.0, 3.0);
    let corners: Vec<Point> = region.rings[0].vertices.iter().map(|v| v.point).collect();
    let (corner, end) = (Point::new(3.0, 3.0), Point::new(3.0, 3.5));
    let result = |edge: f64, eased: bool| {
        let distance = move |p: Point| if p.y >= end.y && p.x < 3.1 { 0.0 } else { (p - end).norm() };
        let pin_distance = move |p: Point| if eased || distance(p) == 0.0 { distance(p) } else { f64::INFINITY };
        let field = Field { radius: Box::new(|_, _| 1.0), pin_distance: Box::new(pin_distance) };
        let mut flow =
            CurveFlow::new(&region, Obstacle::CLOSING, field, &Settings { edge, ..Settings::default() }).unwrap();
        let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("it goes on") };
        assert!(end.is_limit(), "{end:?}");
        assert!(BoundaryIndex::new(&flow.region()).distance(corner) > 0.1, "the corner is filled");
        assert!(sticks_out(&region, &flow.region()) < 1e-12);
        flow.region()
    };
    // A disk of radius 1 that rests on the other leg and on the end of the pin meets the leg at 30 degrees.
    assert!(largest_turn(&result(DEFAULT_EDGE, false), &corners) > 0.45, "a pin without easing is met in a corner");
    let [coarse, fine] = [1.0, 0.25].map(|part| largest_turn(&result(part * DEFAULT_EDGE, true), &corners));
    assert!(coarse < 0.25, "{coarse}");
    // What is left are the turns of a polygon along a curve.
    assert!(fine < 0.35 * coarse, "{fine} of {coarse}");
}

#[test]
fn pinned_samples_of_a_curve_stay_and_those_beside_them_join_them_smoothly() {
    // A notch, a half circle of radius 1/2 in the top of a block, and a disk about its lowest point.
    let samples = 60;
    let mut points = vec![Point::new(-4.0, -4.0), Point::new(4.0, -4.0), Point::new(4.0, 0.0)];
    points.extend((0..=samples).map(|k| {
        let (sin, cos) = (std::f64::consts::PI * f64::from(k) / f64::from(samples)).sin_cos();
        Point::new(0.5 * cos, -0.5 * sin)
    }));
    points.push(Point::new(-4.0, 0.0));
    let block = Region::new(vec![Ring::polygon(points)]);
    let region = numbered(&block);
    let distance = |p: Point| ((p - Point::new(0.0, -0.5)).norm() - 0.2).max(0.0);
    let field = Field { radius: Box::new(|_, _| 1.0), pin_distance: Box::new(distance) };
    let mut flow = CurveFlow::new(&region, Obstacle::CLOSING, field, &Settings::default()).unwrap();
    let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("it goes on") };
    assert!(end.is_limit(), "{end:?}");
    let result = flow.region();
    let kept: Vec<&Vertex> = result.rings[0].vertices.iter().filter(|v| v.id.is_some()).collect();
    let pinned: Vec<&Vertex> = region.rings[0].vertices.iter().filter(|v| distance(v.point) == 0.0).collect();
    assert!(pinned.len() > 10 && pinned.iter().all(|v| kept.contains(v)));
    assert!(kept.len() < region.vertex_count() - 10, "the sides of the notch move");
    let corners = [[-4.0, -4.0], [4.0, -4.0], [4.0, 0.0], [0.5, 0.0], [-0.5, 0.0], [-4.0, 0.0]].map(Point::from);
    let turn = largest_turn(&result, &corners);
    assert!(turn < 0.25, "{turn}");
}

#[test]
fn the_radius_may_vary_in_the_plane() {
    // Four concave corners along a comb; the radius grows from left to right.
    let region = shapes::comb(5, 20.0, 12.0);
    let field =
        Field { radius: Box::new(|p, _| 0.5 + 0.05 * p.x.clamp(0.0, 60.0)), pin_distance: Box::new(|_| f64::INFINITY) };
    let mut flow = CurveFlow::new(&region, Obstacle::CLOSING, field, &Settings::default()).unwrap();
    let Status::Ended(end) = flow.run(f64::INFINITY) else { panic!("it goes on") };
    assert!(end.is_limit(), "{end:?}");
    let result = BoundaryIndex::new(&flow.region());
    for (corner, diagonal) in
        [(Point::new(1.0, 0.0), Vector::new(1.0, 1.0)), (Point::new(53.0 - 13.0, 0.0), Vector::new(1.0, 1.0))]
    {
        // A fillet of radius r stays (√2 - 1) r away from its corner.
        let expected = (2f64.sqrt() - 1.0) * (0.5 + 0.05 * (corner.x + diagonal.x));
        let found = result.distance(corner);
        assert!((found - expected).abs() < 0.12 * expected, "{corner}: {found} for {expected}");
    }
}

/// A concave corner with an island where it will be filled.
fn island() -> Region {
    let mut region = shapes::l_corner(7.0, 3.0);
    region.rings.push(shapes::rectangle(3.1, 3.1, 3.15, 3.15));
    region
}

#[test]
fn contact_is_told_and_can_end_the_flow() {
    let region = island();
    let run = |on_contact| {
        let settings = Settings { on_contact, ..Settings::default() };
        let mut flow = CurveFlow::new(&region, Obstacle::CLOSING, Field::constant(radius()), &settings).unwrap();
        flow.run(50.0);
        flow.report()
    };
    let stopped = run(OnContact::Stop);
    assert_eq!(stopped.end, Some(End::Contact), "{stopped:?}");
    assert_eq!(stopped.contacts.len().min(1), 1);
    let reported = run(OnContact::Report);
    assert_ne!(reported.end, Some(End::Contact));
    assert!(reported.contacts.starts_with(&stopped.contacts) && reported.time > stopped.time);
}

#[test]
fn a_step_looks_at_what_moves_only() {
    // The same notch in outlines a hundred times as long: the same states.
    let notch = |far: f64| {
        let points =
            [(-far, 0.0), (-far, -far), (far, -far), (far, 0.0), (0.5, 0.0), (0.5, -2.0), (-0.5, -2.0), (-0.5, 0.0)];
        Region::new(vec![Ring::polygon(points.map(|(x, y)| Point::new(x, y)))])
    };
    let moving = |far| {
        let mut flow = start(&notch(far), Obstacle::CLOSING, DEFAULT_EDGE);
        (0..100)
            .map(|_| {
                flow.step(f64::INFINITY);
                flow.last_step().0
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(moving(10.0), moving(1000.0));
}

#[test]
fn settings_out_of_range_are_refused() {
    let region = shapes::serif();
    let refused = |settings: Settings, radius: f64| {
        let field = Field { radius: Box::new(move |_, _| radius), pin_distance: Box::new(|_| f64::INFINITY) };
        CurveFlow::new(&region, Obstacle::CLOSING, field, &settings).err()
    };
    let default = Settings::default();
    assert_eq!(refused(default, 1.0), None);
    for edge in [0.0, -1.0, f64::NAN, 2.0] {
        assert!(matches!(refused(Settings { edge, ..default }, 1.0), Some(FlowError::EdgeLength(_))), "{edge}");
    }
    for time_step in [0.0, -1.0, 5.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused(Settings { time_step, ..default }, 1.0), Some(FlowError::TimeStep(_))));
    }
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert!(matches!(refused(Settings { tolerance, ..default }, 1.0), Some(FlowError::Tolerance(_))));
    }
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused(default, radius), Some(FlowError::Radius { .. })), "{radius}");
    }
}
