//! No pass of an operation goes deeper into the full material than a pass may.

mod engagement;

use clopen::cam::{Geometry, Motion, MotionKind, Program, Setup, SetupFile, plan_operation};
use clopen::gcode;
use clopen::units::DrawingScale;
use engagement::{OWN_FALL, deepest_step};

const SCALE: DrawingScale = DrawingScale { mm_per_unit: Some(1.0), diagonal: 100.0 };

/// Most that a pass goes down.
const PASS: f64 = 1.0;

/// Radius of the tool.
const RADIUS: f64 = 1.5;

fn setup(operation: &str) -> Setup {
    let text = format!(
        "version = 1\n[stock]\nthickness = 6\n[[tool]]\nnumber = 1\ndiameter = 3\ndepth-per-pass = 1\nfeed = 1000\n\
         plunge-feed = 200\n[[operation]]\ntool = 1\n{operation}"
    );
    let file: SetupFile = text.parse().unwrap();
    file.resolve(&Default::default(), &SCALE).unwrap_or_else(|e| panic!("{e}"))
}

fn program(operation: &str, path: &str) -> Program {
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100"><path d="{path}"/></svg>"#
    );
    let drawing = clopen::io::svg::read(svg.as_bytes(), &Default::default()).unwrap();
    let geometry = Geometry { area: drawing.region, ..Geometry::default() };
    let setup = setup(operation);
    let planned = plan_operation(&setup, &setup.operations[0], &geometry).unwrap_or_else(|e| panic!("{e}"));
    let text = gcode::write(&planned.toolpath, &[], &gcode::GRBL, Default::default()).unwrap();
    gcode::read(&text).unwrap()
}

/// How deep the tool goes where nothing has been cut within the allowance and half its radius.
fn deepest(operation: &str, path: &str, allowance: f64) -> f64 {
    let reach = allowance + 0.5 * RADIUS + 0.05;
    let (depth, line) = deepest_step(&program(operation, path), 0.0, reach);
    println!("{depth} at line {line}");
    depth - OWN_FALL * reach
}

const SQUARE: &str = "M20 20H60V60H20Z";
const SLOTTED: &str = "M20 20H60V60H44V44H36V60H20Z";

#[test]
fn the_arc_on_which_the_tool_leaves_a_ramp_is_cut_in_every_pass() {
    let operation = "kind = \"profile\"\nthrough = true\nlead = 4\n";
    assert!(deepest(operation, SQUARE, 0.0) <= PASS);
}

#[test]
fn dogbones_are_cut_in_every_pass_also_with_an_allowance() {
    for corners in ["dogbone", "t-bone"] {
        let operation = format!("kind = \"profile\"\nthrough = true\nallowance = 0.2\ncorners = \"{corners}\"\n");
        assert!(deepest(&operation, SLOTTED, 0.2) <= PASS, "{corners}");
    }
}

#[test]
fn walls_that_the_roughing_has_no_room_for_are_cut_in_every_pass() {
    // A slot of 3.9 mm, so long that a ramp is down before it is around: the tool fits in, with the allowance it does not.
    let slot = "M10 28.05H80V31.95H10Z";
    for kind in ["profile\"\nside = \"inside", "pocket"] {
        let operation = format!("kind = \"{kind}\"\nthrough = true\nallowance = 0.6\npath-radius = 0\n");
        assert!(deepest(&operation, slot, 0.0) <= PASS, "{kind}");
        // In a wide one the walls are finished at once.
        let heights = program(&operation, SQUARE);
        let finishing = heights.motions.iter().filter(|m| m.is_feed() && m.from.z == m.to.z && m.to.z < -6.0).count();
        assert!(finishing > 0);
    }
}

#[test]
fn thick_onion_skins_are_cut_in_passes_and_stand_on_the_bottom_of_the_stock() {
    let operation = "kind = \"profile\"\nthrough = true\nonion-skin = 2.5\n";
    assert!(deepest(operation, SQUARE, 0.0) <= PASS);
    let heights: Vec<f64> = program(operation, SQUARE).motions.iter().map(Motion::lowest).collect();
    assert!(heights.iter().any(|z| (z + 3.5).abs() < 1e-9), "the skin is not as thick as asked");
}

#[test]
fn the_tool_goes_down_the_flanks_of_tabs_at_the_feed_of_ramps() {
    let program = program("kind = \"profile\"\nthrough = true\ntabs = { count = 3, width = 5, height = 2 }\n", SQUARE);
    let falling = program.motions.iter().filter(|m| m.is_feed() && m.to.z < m.from.z - 1e-6);
    assert!(falling.clone().count() > 20);
    for motion in falling {
        let feed = match motion.kind {
            MotionKind::Feed { feed } | MotionKind::Arc { feed, .. } => feed,
            MotionKind::Rapid | MotionKind::Dwell { .. } => f64::INFINITY,
        };
        assert!(feed <= 200.0, "line {}: {feed}", motion.line);
    }
}

#[test]
fn tabs_stand_after_roughing_and_finishing() {
    // Roughed and finished paths pass over the same tabs: nothing below their tops comes near their middles.
    let text =
        "kind = \"profile\"\nthrough = true\nallowance = 0.3\nlead = 4\ntabs = { count = 4, width = 6, height = 2 }\n";
    let setup = setup(text);
    let region = clopen::io::svg::read(
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100"><path d="{SQUARE}"/></svg>"#
        )
        .as_bytes(),
        &Default::default(),
    )
    .unwrap()
    .region;
    let geometry = Geometry { area: region, ..Geometry::default() };
    let planned = plan_operation(&setup, &setup.operations[0], &geometry).unwrap();
    assert_eq!(planned.tabs.len(), 4);
    let program = program(text, SQUARE);
    // Between them both go down to the floor.
    let at_floor = program.motions.iter().filter(|m| m.from.z == -6.2 && m.to.z == -6.2);
    assert!(at_floor.map(Motion::length).sum::<f64>() > 2.0 * 100.0);
    for tab in &planned.tabs {
        // They stand on the bottom of the stock, not on the floor of the cut.
        assert_eq!(tab.top, -4.0);
        for motion in program.motions.iter().filter(|m| m.lowest() < tab.top - 1e-3) {
            assert!(
                motion.trace().all(|s| s.nearest(tab.at).distance >= RADIUS - 0.01),
                "line {} takes the tab at {:?}",
                motion.line,
                tab.at
            );
        }
    }
}

#[test]
fn the_way_down_begins_above_the_stock_wherever_the_operation_starts() {
    let program = program("kind = \"pocket\"\nstart-depth = 3\ndepth = 5\n", SQUARE);
    assert!(program.motions.iter().filter(|m| !m.is_feed()).all(|m| m.to.z >= 1.0));
}
