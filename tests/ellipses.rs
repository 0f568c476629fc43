//! The rolling ellipse obeys the laws of every closing, measured in the plane itself.

mod shapes;

use clopen::plane::{BoundaryIndex, Bounds, Link, Point, Region, Stretch, Stretched, Vector};
use clopen::rolling::{Outcome, Topology, close, open};
use clopen::units::Radius;
use shapes::{Numbers, mixed, placed};

/// Chords that stand for curves in these tests may be so far off, over the radius.
const TOLERANCE: f64 = 1e-5;

/// The same for what is closed again: every chord of an arc of the ellipse itself has its centre in the same place.
const COARSE: f64 = 1e-3;

struct Case {
    name: String,
    input: Region,
    stretched: Stretched,
}

/// Random shapes, and for each an ellipse, whose half axes are 1 and something.
fn cases() -> impl Iterator<Item = Case> {
    (0..60).map(|number| {
        let (name, shape) = mixed(number);
        let mut numbers = Numbers::new(number);
        let far = [0.0, 0.0, 1e5][numbers.below(3)];
        let input = placed(&shape, numbers.between(0.0, 6.0), 1.0, Vector::new(far, -0.7 * far));
        let aspect = [1.3, 3.0, 0.4][numbers.below(3)];
        let stretch = Stretch::new(aspect, numbers.between(-400.0, 400.0)).unwrap();
        let stretched = Stretched::new(&input, stretch, &input.bounds(), TOLERANCE);
        Case { name: format!("{name} by {aspect} at {}", stretch.degrees()), input, stretched }
    })
}

fn radius() -> Radius {
    Radius::new(1.0).unwrap()
}

/// How far the points of `inner` stick out of `outer`.
fn sticking_out(inner: &Region, outer: &Region) -> f64 {
    let index = BoundaryIndex::new(outer);
    let is_out = |p: &Point| index.winding_number(*p) <= 0;
    let points = inner.segments().flat_map(|s| [0.0, 0.21, 0.5, 0.83].map(|t| s.point_at(t)));
    points.filter(is_out).map(|p| index.distance(p)).fold(0.0, f64::max)
}

#[test]
fn closings_contain_and_openings_are_contained() {
    let mut moved = 0;
    for case in cases() {
        let size = case.input.bounds().max.coords.amax().max(case.input.bounds().min.coords.amax());
        let allowed = 1e-9 + 2.0 * TOLERANCE + 64.0 * f64::EPSILON * size;
        let closed = close(case.stretched.region(), radius(), Topology::Merge);
        let opened = open(case.stretched.region(), radius(), Topology::Merge);
        let on_page = |o: &Outcome| case.stretched.flattened(&o.region, TOLERANCE);
        if !closed.region.is_empty() {
            let out = sticking_out(&case.input, &on_page(&closed));
            assert!(out < allowed, "{}: the input sticks out by {out:e}", case.name);
        }
        let out = sticking_out(&on_page(&opened), &case.input);
        assert!(out < allowed, "{}: the opening sticks out by {out:e}", case.name);
        moved += usize::from(case.stretched.area(&closed.region) > case.input.area() + 1e-3);
    }
    assert!(moved > 30, "{moved}");
}

#[test]
fn what_does_not_move_is_the_vertex_that_it_was() {
    let (mut kept, mut made) = (0, 0);
    for case in cases() {
        let outcome = close(case.stretched.region(), radius(), Topology::Keep);
        let bits = |p: Point| (p.x.to_bits(), p.y.to_bits());
        let present: std::collections::HashSet<_> =
            case.input.rings.iter().flat_map(|r| &r.vertices).map(|v| bits(v.point)).collect();
        for v in outcome.region.rings.iter().flat_map(|r| &r.vertices) {
            let out = case.stretched.restored(v);
            if v.id.is_some() {
                kept += usize::from(present.contains(&bits(out.point)));
            } else {
                made += 1;
            }
        }
        // Into the frame and out of it again nothing has changed, though rounding was done on the way.
        let there_and_back = case.stretched.flattened(case.stretched.region(), TOLERANCE);
        let lines = case.input.segments().all(|s| s.link == Link::Line);
        if lines {
            let points =
                |r: &Region| r.rings.iter().flat_map(|r| &r.vertices).map(|v| bits(v.point)).collect::<Vec<_>>();
            assert_eq!(points(&there_and_back), points(&case.input), "{}", case.name);
        }
    }
    assert!(kept > 2000 && made > 500, "{kept} {made}");
}

#[test]
fn closing_twice_is_closing_once_and_an_opening_is_the_closing_of_what_is_empty() {
    for case in cases() {
        let closed = close(case.stretched.region(), radius(), Topology::Merge);
        if closed.contradictions > 0 || closed.region.is_empty() {
            continue;
        }
        let area = case.stretched.area(&closed.region);
        // Once more, from what is on the page: with chords for its arcs.
        let on_page = case.stretched.flattened(&closed.region, COARSE);
        let again = Stretched::new(&on_page, *case.stretched.stretch(), &on_page.bounds(), COARSE);
        let twice = close(again.region(), radius(), Topology::Merge);
        let off = (again.area(&twice.region) - area).abs() / on_page.perimeter();
        assert!(off < 2.0 * COARSE, "{}: off by {off:e}", case.name);

        let empty = Stretched::new(&case.input.reversed(), *case.stretched.stretch(), &case.input.bounds(), TOLERANCE);
        let dual = close(empty.region(), radius(), Topology::Merge).region.reversed();
        let opened = open(case.stretched.region(), radius(), Topology::Merge).region;
        assert!((dual.area() - opened.area()).abs() <= 1e-9 * opened.area().abs().max(1.0), "{}", case.name);
    }
}

#[test]
fn a_corner_gets_the_arc_of_the_ellipse() {
    // A right angle in the frame's own axes: the ellipse of half axes 2 and 1 touches both legs at its own extremes.
    let p = Point::new;
    let ell = [p(0.0, 0.0), p(9.0, 0.0), p(9.0, 4.0), p(4.0, 4.0), p(4.0, 9.0), p(0.0, 9.0)];
    let input = Region::new(vec![clopen::plane::Ring::polygon(ell)]);
    let stretched = Stretched::new(&input, Stretch::new(2.0, 0.0).unwrap(), &Bounds::of_points(ell), TOLERANCE);
    let outcome = close(stretched.region(), Radius::new(2.0).unwrap(), Topology::Keep);
    let points: Vec<Point> = outcome.region.rings[0].vertices.iter().map(|v| stretched.restored(v).point).collect();
    assert!(points.contains(&p(6.0, 4.0)) && points.contains(&p(4.0, 5.0)), "{points:?}");
    assert!(!points.contains(&p(4.0, 4.0)));
    // What is filled: the rectangle of the half axes without a quarter of the ellipse.
    let filled = stretched.area(&outcome.region) - input.area();
    assert!((filled - (2.0 - std::f64::consts::FRAC_PI_2)).abs() < 1e-12, "{filled}");
    assert!((stretched.flattened(&outcome.region, 1e-9).area() - input.area() - filled).abs() < 1e-7);
}
