//! Reports and lost features on shapes whose answers are known.

mod shapes;

use clopen::check::{LostFeature, Report, compare, lost_features};
use clopen::plane::{Point, Region, Ring, Vector};
use clopen::reference::{self, Operation};
use clopen::units::Radius;

fn radius(r: f64) -> Radius {
    Radius::new(r).unwrap()
}

fn closed(region: &Region, r: f64, operation: Operation) -> Region {
    reference::closing(region, radius(r), operation).unwrap().region
}

fn lost(region: &Region, r: f64, operation: Operation) -> Vec<LostFeature> {
    lost_features(region, &closed(region, r, operation), radius(r), operation)
}

fn report(input: &Region, output: &Region, operation: Operation) -> Report {
    let reference = reference::closing(input, radius(1.0), operation).unwrap();
    compare(input, output, &reference, radius(1.0), operation)
}

/// A report on something far away and turned, which must read the same.
fn placements() -> [(f64, f64, Vector); 3] {
    [(0.0, 1.0, Vector::zeros()), (0.7, 1.0, Vector::new(1e6, 2e6)), (2.0, 1e-6, Vector::zeros())]
}

#[test]
fn lost_features_are_named_with_their_sizes() {
    for (angle, scale, offset) in placements() {
        let place = |region: &Region| shapes::placed(region, angle, scale, offset);
        let near = |a: f64, b: f64| (a - b * scale).abs() <= 0.02 * b * scale;

        let plate = Ring::polygon([(-9., -9.), (9., -9.), (9., 9.), (-9., 9.)].map(|(x, y)| Point::new(x, y)));
        let bored = Region::new(vec![plate.clone(), Ring::circle(Point::new(3.0, 2.0), 0.8).reversed()]);
        match lost(&place(&bored), scale, Operation::Close).as_slice() {
            [LostFeature::HoleFilled { center, diameter, area }] => {
                let expected = place(&Region::new(vec![Ring::circle(Point::new(3.0, 2.0), 1.0)])).bounds().center();
                assert!((Point::new(center.x, center.y) - expected).norm() < 0.02 * scale, "{center:?}");
                assert!(near(*diameter, 1.6) && near(*area / scale, std::f64::consts::PI * 0.64), "{diameter} {area}");
            }
            other => panic!("{other:?}"),
        }
        match lost(&place(&shapes::two_disks(2.0, 4.5)), scale, Operation::Close).as_slice() {
            [LostFeature::PartsMerged { components: 2, .. }] => {}
            other => panic!("{other:?}"),
        }
        for (depth, width) in [(6.0, 1.2), (1.5, 1.8), (0.8, 0.5)] {
            let slotted = place(&shapes::slotted_plate(20.0, 10.0, width, depth));
            match lost(&slotted, scale, Operation::Close).as_slice() {
                [LostFeature::GapFilled { width: found, .. }] => {
                    assert!(near(*found, width), "{found} for {width}");
                }
                other => panic!("{depth} {width}: {other:?}"),
            }
        }
        match lost(&place(&shapes::keyhole(2.0, 0.9, 2.0)), scale, Operation::Close).as_slice() {
            [LostFeature::GapFilled { width, .. }] => assert!((0.8..1.3).contains(&(width / scale)), "{width}"),
            other => panic!("{other:?}"),
        }
        match lost(&place(&shapes::dumbbell(4.0, 3.0, 1.0)), scale, Operation::Open).as_slice() {
            [LostFeature::NeckCut { width, .. }] => assert!((0.8..1.3).contains(&(width / scale)), "{width}"),
            other => panic!("{other:?}"),
        }
        let crumbs = Region::new(vec![plate, Ring::circle(Point::new(12.0, 0.0), 0.5)]);
        match lost(&place(&crumbs), scale, Operation::Open).as_slice() {
            [LostFeature::ComponentLost { diameter, .. }] => assert!(near(*diameter, 1.0)),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn fillets_are_no_losses() {
    for (angle, scale, offset) in placements() {
        for (name, region, operation) in [
            ("L", shapes::l_corner(10.0, 4.0), Operation::Close),
            ("L, opened", shapes::l_corner(10.0, 4.0), Operation::Open),
            ("wide slot", shapes::slotted_plate(20.0, 10.0, 2.2, 6.0), Operation::Close),
            ("shallow slot", shapes::slotted_plate(20.0, 10.0, 0.5, 0.4), Operation::Close),
            ("star", shapes::star(5, 6.0, 12.0), Operation::Close),
            ("bored gear", shapes::gear(12, 20.0, 24.0, 5.0), Operation::Close),
            ("exact gaps", shapes::squares(3, 2, 4.0, 2.0), Operation::Close),
        ] {
            let region = shapes::placed(&region, angle, scale, offset);
            assert_eq!(lost(&region, scale * 0.999_999, operation), [], "{name} at {angle}, {scale}");
        }
    }
}

#[test]
fn a_right_result_has_no_differences() {
    let mut kept = 0;
    for number in 0..40 {
        let (name, region) = shapes::mixed(number);
        for operation in [Operation::Close, Operation::Open] {
            let report = report(&region, &closed(&region, 1.0, operation), operation);
            assert!(report.passes(1e-9, false), "{name}, {operation:?}: {report:?}");
            assert!(report.smallest_radius.is_none(), "{name}, {operation:?}: {:?}", report.smallest_radius);
            assert!(report.area.mean_difference_over_r < 1e-9, "{name}, {operation:?}");
            kept += report.kept.still_vertices;
        }
    }
    assert!(kept > 1000);
}

#[test]
fn errors_are_measured() {
    let region = shapes::l_corner(10.0, 4.0);
    let right = closed(&region, 1.0, Operation::Close);
    let depth = 2f64.sqrt() - 1.0;
    let untouched = report(&region, &region, Operation::Close);
    assert!((untouched.hausdorff.largest_over_r - depth).abs() < 1e-9, "{:?}", untouched.hausdorff);
    assert_eq!(untouched.smallest_radius.unwrap().radius_units, 0.0);
    assert_eq!(untouched.kept.fraction, 1.0);
    assert_eq!(untouched.kept.still_vertices, 5);
    assert_eq!(untouched.containment.violation_units, 0.0);
    let difference = 1.0 - std::f64::consts::PI / 4.0;
    assert!((untouched.area.symmetric_difference_units2 - difference).abs() < 1e-4);

    let moved = shapes::placed(&right, 0.0, 1.0, Vector::new(1e-3, 0.0));
    let shifted = report(&region, &moved, Operation::Close);
    assert!((shifted.hausdorff.largest_over_r - 1e-3).abs() < 1e-12, "{:?}", shifted.hausdorff);
    assert!((shifted.containment.violation_over_r - 1e-3).abs() < 1e-12);
    assert_eq!(shifted.kept.found, 0);
    assert!(shifted.passes(1.1e-3, false) && !shifted.passes(0.9e-3, false));

    let sharper = report(&region, &closed(&region, 0.9, Operation::Close), Operation::Close);
    assert!((sharper.smallest_radius.unwrap().radius_over_r - 0.9).abs() < 1e-9);
    assert!((sharper.hausdorff.largest_over_r - 0.1 * depth).abs() < 1e-9, "{:?}", sharper.hausdorff);
}

#[test]
fn a_result_that_keeps_its_topology_is_judged_where_topology_agrees() {
    // Two squares that merge, far from an L that does not.
    let mut region = shapes::squares(2, 1, 4.0, 1.0);
    region.rings.extend(shapes::placed(&shapes::l_corner(10.0, 4.0), 0.0, 1.0, Vector::new(30.0, 0.0)).rings);
    let mut kept = closed(&region, 1.0, Operation::Close);
    kept.rings.retain(|r| r.bounds().min.x > 20.0);
    kept.rings.extend(region.rings[..2].iter().cloned());
    let result = report(&region, &kept, Operation::Close);
    assert!(result.passes(1e-9, true) && !result.passes(1e-2, false), "{result:?}");
    assert_eq!(result.topological_pieces, 1);
    // A fault away from the change of topology is not excused.
    let faulty = report(&region, &region, Operation::Close);
    assert!(!faulty.passes(1e-2, true), "{faulty:?}");
}

#[test]
fn nothing_is_compared_without_a_word() {
    let region = shapes::l_corner(10.0, 4.0);
    let empty = report(&region, &Region::default(), Operation::Close);
    assert_eq!(empty.hausdorff.reference_to_output_units, f64::INFINITY);
    assert!(!empty.passes(1.0, false) && !empty.passes(1.0, true));
    let both = report(&Region::default(), &Region::default(), Operation::Close);
    assert!(both.passes(0.0, false), "{both:?}");
}

/// Two disks of free space overlap in the gap between two bumps: each bump gets a tip, and nothing is joined.
#[test]
fn tips_in_a_neck_are_left_out_where_topology_is_kept() {
    let bumps = shapes::two_disks(4.0, 9.9);
    let merged = closed(&bumps, 1.0, Operation::Close);
    assert_eq!(merged.topology(), bumps.topology());
    let kept = report(&bumps, &bumps, Operation::Close);
    assert!(kept.hausdorff.largest_over_r > 1e-2, "{}", kept.hausdorff.largest_over_r);
    assert!(kept.passes(1e-4, true));
    assert!(!kept.passes(1e-4, false));
    // A fillet that is missing is no matter of topology.
    let corner = shapes::placed(&shapes::slotted_plate(20.0, 10.0, 4.0, 3.0), 0.0, 1.0, Vector::zeros());
    assert!(!report(&corner, &corner, Operation::Close).passes(1e-4, true));
}
