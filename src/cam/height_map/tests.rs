use std::f64::consts::PI;

use proptest::prelude::*;

use super::super::tool::{Tool, ToolShape};
use super::*;
use crate::gcode::read;

const HEAD: &str = "G21 G90 G17 G94 F100\nG0 Z5\n";

/// Stock of 40 by 30 by 10 with its middle at the origin.
fn stock() -> Stock {
    Stock::new(Point::new(-20.0, -15.0), [40.0, 30.0, 10.0], 0.0)
}

/// What is left after `path`, and the volume that was told.
fn cut_in(stock: Stock, tool: &Tool, path: &str, cell: f64) -> (HeightMap, f64) {
    let mut map = HeightMap::new(stock, cell).unwrap();
    let cutter = Cutter::new(tool);
    let program = read(&format!("{HEAD}{path}")).unwrap();
    let removed = program.motions.iter().filter(|m| m.is_feed()).map(|m| map.cut(&cutter, m, &mut Vec::new())).sum();
    (map, removed)
}

fn cut(tool: &str, path: &str, cell: f64) -> (HeightMap, f64) {
    cut_in(stock(), &tool.parse().unwrap(), path, cell)
}

fn near(found: f64, expected: f64, within: f64) {
    assert!((found / expected - 1.0).abs() < within, "{found} against {expected}");
}

/// The height at the middle of the cell that holds a place.
fn at(map: &HeightMap, x: f64, y: f64) -> f64 {
    map.height_at(Point::new(x, y)).unwrap()
}

#[test]
fn a_straight_slot_has_the_volume_of_its_plan() {
    let (map, removed) = cut("1=flat 6mm", "G0 X-10 Y1\nG1 Z-2\nG1 X8 Y-3", 0.05);
    let length = 18f64.hypot(4.0);
    near(removed, 2.0 * (length * 6.0 + PI * 9.0), 1e-3);
    near(map.removed(), removed, 1e-12);
    assert_eq!(at(&map, 0.0, 0.0), -2.0);
    assert_eq!(at(&map, 0.0, 10.0), 0.0);
}

#[test]
fn a_ball_that_plunges_leaves_a_cap() {
    for depth in [0.5, 2.0, 3.0] {
        let (_, removed) = cut("1=ball 6mm", &format!("G0 X1 Y2\nG1 Z-{depth}"), 0.02);
        near(removed, PI * depth * depth * (3.0 - depth / 3.0), 1e-3);
    }
    // Deeper than its radius: half a ball under a cylinder.
    let (_, removed) = cut("1=ball 6mm", "G0 X1 Y2\nG1 Z-5", 0.02);
    near(removed, PI * 27.0 * 2.0 / 3.0 + PI * 9.0 * 2.0, 1e-3);
}

#[test]
fn a_v_groove_is_as_wide_as_its_depth_allows() {
    let (map, _) = cut("1=v60 10mm", "G0 X-12 Y0.1\nG1 Z-3\nG1 X12", 0.05);
    let cut_rows = (0..map.rows()).filter(|&row| at(&map, 0.0, map.center(0, row).y) < 0.0).count();
    let width = cut_rows as f64 * map.cell()[1];
    assert!((width - 2.0 * 3.0 * (PI / 6.0).tan()).abs() < 1.5 * map.cell()[1], "{width}");
    // The bottom of the groove, and half way up: as high as the sides are steep, at the middles of the cells.
    for y in [0.1, 0.7, -0.9] {
        let row = ((y + 15.0) / map.cell()[1]).floor() as usize;
        let off = (map.center(0, row).y - 0.1).abs();
        assert!((at(&map, 3.0, y) - (-3.0 + off / (PI / 6.0).tan())).abs() < 1e-12);
    }
    // A flat tip makes it wider.
    let (tipped, _) = cut("1=v60 10mm tip 1mm", "G0 X-12 Y0.1\nG1 Z-3\nG1 X12", 0.05);
    assert_eq!((at(&tipped, 0.0, 0.5), at(&tipped, 0.0, -0.3)), (-3.0, -3.0));
}

#[test]
fn a_helical_bore_is_as_wide_as_the_circle_and_the_tool() {
    for turn in ["G3", "G2"] {
        let path = format!("G0 X4 Y0\nG1 Z0\n{turn} X4 Y0 Z-2 I-4 J0\n{turn} X4 Y0 Z-4 I-4 J0\n{turn} X4 Y0 I-4 J0");
        let (map, removed) = cut("1=flat 3mm", &path, 0.04);
        near(removed, 4.0 * PI * (5.5 * 5.5 - 2.5 * 2.5), 1e-3);
        assert_eq!((at(&map, 4.0, 0.5), at(&map, 0.0, 0.0)), (-4.0, 0.0));
    }
    // One turn without the level one: the floor is a ramp. A place is lowest when the far edge of the tool leaves it.
    let (map, _) = cut("1=flat 3mm", "G0 X4 Y0\nG1 Z0\nG3 X4 Y0 Z-4 I-4 J0", 0.04);
    let place = |column: usize, row: usize| map.center(column, row);
    let (column, row) = ((20.0 - 4.0) / map.cell()[0], 15.0 / map.cell()[1]);
    let p = place(column as usize, row as usize);
    let away = p.coords.norm();
    let half = ((away * away + 16.0 - 2.25) / (8.0 * away)).acos();
    let travelled = p.y.atan2(p.x).rem_euclid(2.0 * PI) + half;
    assert!((map.height(column as usize, row as usize) + 4.0 * travelled / (2.0 * PI)).abs() < 1e-9);
}

/// The least of z + h over the places of a motion, taken one by one, and the least distance from the axis.
fn lowest_by_steps(tool: &Tool, motion: &Motion, p: Point) -> (f64, f64) {
    const STEPS: usize = 6_000;
    let elements: Vec<_> = motion.trace().collect();
    let whole: f64 = elements.iter().map(|s| s.length()).sum();
    let (mut lowest, mut nearest) = (0.0f64, f64::INFINITY);
    let mut before = 0.0;
    for element in &elements {
        let share = element.length() / whole;
        for k in 0..=STEPS {
            let t = k as f64 / STEPS as f64;
            let center = element.point_at(t);
            let z = motion.from.z + (motion.to.z - motion.from.z) * (before + t * share);
            nearest = nearest.min((p - center).norm());
            if let Some(height) = tool.height_at((p - center).norm()) {
                lowest = lowest.min(z + height);
            }
        }
        before += share;
    }
    (lowest, nearest)
}

#[test]
fn every_motion_of_every_shape_is_swept_as_if_place_by_place() {
    let paths = [
        "G0 X-8 Y-3\nG1 Z-1\nG1 X6 Y5 Z-4",
        "G0 X-8 Y-3\nG1 Z-4\nG1 X6 Y5 Z-0.5",
        "G0 X-1 Y-1\nG1 Z0\nG1 X0.3 Y-1.1 Z-6",
        "G0 X6 Y0\nG1 Z-2\nG3 X0 Y6 I-6 J0",
        "G0 X1 Y0\nG1 Z-2\nG2 X0 Y-1 I-1 J0",
        "G0 X6 Y0\nG1 Z-2\nG2 X0 Y6 I-6 J0",
        "G0 X6 Y0\nG1 Z-1\nG3 X0 Y6 Z-5 I-6 J0",
        "G0 X1 Y0\nG1 Z-5\nG2 X0 Y1 Z-1 I-1 J0",
        "G0 X6 Y0\nG1 Z0\nG3 X6 Y0 Z-4 I-6 J0",
    ];
    let mut compared = 0;
    for tool in ["1=flat 4mm", "1=ball 4mm", "1=v60 5mm", "1=v90 5mm tip 0.8mm", "1=drill 3mm"] {
        let tool: Tool = tool.parse().unwrap();
        for path in paths {
            let program = read(&format!("{HEAD}{path}")).unwrap();
            let motion = program.motions.last().unwrap();
            let mut map = HeightMap::new(stock(), 0.37).unwrap();
            map.cut(&Cutter::new(&tool), motion, &mut Vec::new());
            for row in 0..map.rows() {
                for column in 0..map.columns() {
                    let p = map.center(column, row);
                    let (by_steps, nearest) = lowest_by_steps(&tool, motion, p);
                    let found = map.heights[row * map.columns() + column];
                    // At the rim a hair aside decides whether the tool is over a place at all, and for how long.
                    if (nearest - tool.radius()).abs() < 0.01 {
                        continue;
                    }
                    // A ball is steep near its rim: what chords and steps stray aside is seen many times over in the height.
                    let within = if tool.shape == ToolShape::Ball { 0.02 } else { 4e-3 };
                    assert!(
                        (found - by_steps).abs() < within,
                        "{path} with {}: {found} against {by_steps} at {p}",
                        tool.title()
                    );
                    compared += usize::from(found < 0.0);
                }
            }
        }
    }
    assert!(compared > 10_000, "{compared}");
}

#[test]
fn mirrored_programs_leave_mirrored_maps() {
    let path = |s: f64, turn: &str| {
        format!(
            "G0 X{} Y-3.03\nG1 Z-1\nG1 X{} Y5.01 Z-3\n{turn} X{} Y5.01 Z-2 I{} J0\nG1 Y-2",
            -8.11 * s,
            6.07 * s,
            0.07 * s,
            -3.0 * s
        )
    };
    for tool in ["1=flat 4.01mm", "1=ball 4.01mm", "1=v60 5.01mm"] {
        let (map, _) = cut(tool, &path(1.0, "G3"), 0.25);
        let (mirrored, _) = cut(tool, &path(-1.0, "G2"), 0.25);
        for row in 0..map.rows() {
            for column in 0..map.columns() {
                let other = mirrored.height(map.columns() - 1 - column, row);
                assert!((map.height(column, row) - other).abs() < 1e-9, "{tool} at {}", map.center(column, row));
            }
        }
    }
}

#[test]
fn what_is_no_stock_has_no_map() {
    let flat = Stock { bottom_mm: 0.0, ..stock() };
    assert!(matches!(HeightMap::new(flat, 0.1), Err(MapError::Stock(..))));
    for cell in [0.0, -1.0, f64::NAN, 1e-6] {
        assert!(matches!(HeightMap::new(stock(), cell), Err(MapError::Cells(..))), "{cell}");
    }
    assert_eq!(HeightMap::new(stock(), 1e6).unwrap().columns(), 1);
    assert!((HeightMap::default_cell(&stock(), 4.0) - 0.1).abs() < 1e-12);
    let large = Stock::new(Point::origin(), [2000.0, 2000.0, 5.0], 0.0);
    assert_eq!(HeightMap::default_cell(&large, 4.0), 1.0);
}

/// Some motion at a feed in or above the stock.
fn some_motion() -> impl Strategy<Value = String> {
    let place = (-22.0..22.0f64, -17.0..17.0f64, -6.0..2.0f64);
    prop_oneof![
        place.clone().prop_map(|(x, y, z)| format!("G1 X{x:.3} Y{y:.3} Z{z:.3}\n")),
        (place, 0.0..9.0f64, any::<bool>()).prop_map(|((_, _, z), r, left)| {
            let turn = if left { "G3" } else { "G2" };
            format!("G91\n{turn} X0 Y0 Z{z:.3} I{r:.3} J1\nG90\n")
        }),
    ]
}

fn some_tool() -> impl Strategy<Value = Tool> {
    let shape = prop_oneof![
        Just(ToolShape::Flat),
        Just(ToolShape::Ball),
        (0.3..2.8f64, 0.0..1.0f64).prop_map(|(angle, tip_diameter)| ToolShape::Cone { angle, tip_diameter }),
    ];
    (shape, 1.0..8.0f64).prop_map(|(shape, diameter)| Tool::new(1, shape, diameter))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn motions_never_add_material_and_their_order_does_not_matter(
        tool in some_tool(),
        motions in prop::collection::vec(some_motion(), 1..8),
    ) {
        let program = read(&format!("{HEAD}G0 X0 Y0\n{}", motions.concat())).unwrap();
        let cutter = Cutter::new(&tool);
        let run = |backwards: bool| {
            let mut map = HeightMap::new(stock(), 0.5).unwrap();
            let mut order: Vec<_> = program.motions.iter().collect();
            if backwards {
                order.reverse();
            }
            let mut removed = 0.0;
            for motion in order {
                let before = map.clone();
                let taken = map.cut(&cutter, motion, &mut Vec::new());
                prop_assert!(taken >= 0.0);
                prop_assert!(map.heights.iter().zip(&before.heights).all(|(now, then)| now <= then));
                removed += taken;
            }
            prop_assert!((removed - map.removed()).abs() < 1e-6);
            Ok(map)
        };
        // No message with all heights in it.
        prop_assert!(run(false)? == run(true)?);
    }
}
