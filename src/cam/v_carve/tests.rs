use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use super::*;
use crate::cam::test_shapes::p;
use crate::plane::Ring;

fn bit(angle: f64, tip_diameter: f64, diameter: f64) -> Tool {
    let shape = ToolShape::Cone { angle, tip_diameter };
    Tool { number: 1, name: String::new(), shape, is_drill: false, diameter, flutes: 2, flute_length: 30.0 }
}

fn spec(tool: Tool) -> VCarve {
    VCarve { tool, stock_top: 0.0, max_depth: None, depth_per_pass: 100.0 }
}

fn rectangle(width: f64, height: f64) -> Region {
    Region::new(vec![Ring::polygon([p(0.0, 0.0), p(width, 0.0), p(width, height), p(0.0, height)])])
}

#[test]
fn a_slot_is_as_deep_as_its_half_width_over_the_slope() {
    let slope = (0.5 * FRAC_PI_3).tan();
    let carving = v_carve(&rectangle(40.0, 6.0), &spec(bit(FRAC_PI_3, 0.0, 12.0))).unwrap();
    let depth = 3.0 / slope;
    assert!((carving.deepest - depth).abs() < 1e-9);
    assert!(carving.flat.is_empty());
    // Four corners and two branches: three chains, one of which runs along the ridge.
    assert_eq!(carving.chains.len(), 3);
    let ridge = carving.chains.iter().flat_map(|c| c.windows(2)).find(|w| w.iter().all(|q| (q.z + depth).abs() < 1e-9));
    assert!(ridge.is_some_and(|w| ((w[0] - w[1]).norm() - 34.0).abs() < 1e-6), "{:?}", carving.chains);
    // Up to the corners at the stock's top.
    let at_top = carving.chains.iter().flatten().filter(|q| q.z == 0.0).count();
    assert_eq!(at_top, 4);
}

#[test]
fn the_flat_of_the_tip_makes_it_less_deep() {
    let carving = v_carve(&rectangle(40.0, 6.0), &spec(bit(FRAC_PI_2, 1.0, 12.0))).unwrap();
    assert!((carving.deepest - 2.5).abs() < 1e-9);
    // The tip does not go where the corner is narrower than it.
    let nearest = carving.chains.iter().flatten().map(|q| q.x.min(q.y)).fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.5).abs() < 1e-6, "{nearest}");
}

#[test]
fn what_is_wider_than_the_depth_allows_has_a_flat_bottom() {
    let carve = VCarve { max_depth: Some(2.0), ..spec(bit(FRAC_PI_2, 0.0, 12.0)) };
    let carving = v_carve(&rectangle(40.0, 10.0), &carve).unwrap();
    assert_eq!(carving.deepest, 2.0);
    assert!((carving.flat.area() - 36.0 * 6.0).abs() < 1e-6, "{}", carving.flat.area());
    // Four ends, and four branches at the corners of the bottom: four chains.
    assert_eq!(carving.chains.len(), 4, "{:?}", carving.chains);
    // With a tip the wall meets the bottom where it would without.
    let blunt = VCarve { tool: bit(FRAC_PI_2, 1.0, 12.0), ..carve };
    let carving = v_carve(&rectangle(40.0, 10.0), &blunt).unwrap();
    assert!((carving.flat.area() - (36.0 * 6.0 - (4.0 - std::f64::consts::PI) * 0.25)).abs() < 1e-6);
    let reach = carving.chains.iter().flatten().filter(|q| q.z == -2.0).map(|q| q.x).fold(f64::INFINITY, f64::min);
    assert!((reach - 2.5).abs() < 1e-6);
}

#[test]
fn the_tool_is_never_deeper_than_it_is_wide() {
    let carving = v_carve(&rectangle(40.0, 20.0), &spec(bit(FRAC_PI_2, 0.0, 6.0))).unwrap();
    assert!((carving.deepest - 3.0).abs() < 1e-12);
    assert!((carving.flat.area() - 34.0 * 14.0).abs() < 1e-6);
}

#[test]
fn passes_go_down_step_by_step_and_skip_what_is_done() {
    let carve = VCarve { depth_per_pass: 1.0, stock_top: 5.0, ..spec(bit(FRAC_PI_2, 0.0, 12.0)) };
    let carving = v_carve(&rectangle(40.0, 6.0), &carve).unwrap();
    // Depths of 1, 2 and 3: each pass has its own lowest level, and nothing above the level before but for the first.
    let levels: Vec<(f64, f64)> = carving
        .chains
        .iter()
        .map(|c| c.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q.z), b.max(q.z))))
        .collect();
    for (lowest, highest) in [(4.0, 5.0), (3.0, 4.0), (2.0, 3.0)] {
        assert!(levels.iter().any(|l| (l.0 - lowest).abs() < 1e-9 && l.1 <= highest + 1e-9), "{levels:?}");
    }
    assert!(levels.windows(2).all(|w| w[1].0 <= w[0].0 + 1e-9));
    assert_eq!(levels.iter().filter(|l| l.1 > 4.5).count(), 3, "{levels:?}");
}

#[test]
fn a_round_hole_is_plunged_to() {
    let disk = Region::new(vec![Ring::circle(p(7.0, 8.0), 2.0)]);
    let carving = v_carve(&disk, &spec(bit(FRAC_PI_2, 0.0, 12.0))).unwrap();
    assert_eq!(carving.chains.len(), 1);
    let [tip] = carving.chains[0][..] else { panic!("{:?}", carving.chains) };
    assert!((tip - Point3::new(7.0, 8.0, -2.0)).norm() < 1e-9);
}

#[test]
fn moves_go_down_straight_above_a_chain_and_travel_at_the_safe_height() {
    let carving = v_carve(&rectangle(40.0, 6.0), &spec(bit(FRAC_PI_2, 0.0, 12.0))).unwrap();
    let moves = carving.moves(1.0, 5.0);
    assert!(moves.len() > 8);
    for w in moves.windows(2) {
        let level = (w[0].to - w[1].to).norm() == 0.0;
        match w[1].kind {
            MoveKind::Rapid => assert!(level || (w[0].z == 5.0 && w[1].z == 5.0), "{w:?}"),
            MoveKind::Plunge => assert!(level && w[0].z == 1.0 && w[1].z <= 0.0, "{w:?}"),
            MoveKind::Cut(link) => assert!(link == Link::Line && w[1].z <= 0.0 && w[1].contour == w[0].contour),
            MoveKind::Ramp(_) => panic!("{w:?}"),
        }
    }
    assert_eq!(moves[moves.len() - 1].z, 5.0);
    assert_eq!(moves[moves.len() - 1].contour + 1, carving.chains.len());
}

#[test]
fn what_makes_no_sense_is_refused() {
    let region = rectangle(4.0, 2.0);
    let good = spec(bit(FRAC_PI_2, 0.0, 6.0));
    let with_shape = |shape| VCarve { tool: Tool { shape, ..good.tool.clone() }, ..good.clone() };
    assert_eq!(v_carve(&region, &with_shape(ToolShape::Flat)), Err(VCarveError::NotACone));
    for (angle, tip_diameter) in [(0.0, 0.0), (f64::NAN, 0.0), (4.0, 0.0), (1.0, 7.0), (1.0, -1.0)] {
        let carve = with_shape(ToolShape::Cone { angle, tip_diameter });
        assert_eq!(v_carve(&region, &carve), Err(VCarveError::NotACone), "{angle} {tip_diameter}");
    }
    for carve in [
        VCarve { max_depth: Some(0.0), ..good.clone() },
        VCarve { depth_per_pass: f64::NAN, ..good.clone() },
        VCarve { stock_top: f64::INFINITY, ..good.clone() },
        VCarve { tool: Tool { flute_length: 0.0, ..good.tool.clone() }, ..good.clone() },
    ] {
        assert!(matches!(v_carve(&region, &carve), Err(VCarveError::Invalid { .. })), "{carve:?}");
    }
    assert_eq!(v_carve(&Region::default(), &good), Err(VCarveError::Empty));
    assert_eq!(v_carve(&region, &spec(bit(FRAC_PI_2, 3.0, 6.0))), Err(VCarveError::Empty));
}
