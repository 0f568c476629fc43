//! What operations make of the shapes they are given: nothing is left out without a word, and no other part is touched.

use clopen::cam::{
    CutLine, Geometry, Machine, Motion, Notice, Program, Setup, SetupFile, check_operation, plan_operation,
};
use clopen::gcode;
use clopen::plane::{Point, Region, Ring};
use clopen::units::DrawingScale;

const SCALE: DrawingScale = DrawingScale { mm_per_unit: Some(1.0), diagonal: 100.0 };

fn setup(stock: &str, operation: &str) -> Setup {
    let text = format!(
        "version = 1\n[stock]\nthickness = 6\n{stock}\n[[tool]]\nnumber = 1\ndiameter = 3\n[[tool]]\nnumber = 2\n\
         type = \"drill\"\ndiameter = 2\n[[operation]]\n{operation}"
    );
    let file: SetupFile = text.parse().unwrap();
    file.resolve(&Default::default(), &SCALE).unwrap_or_else(|e| panic!("{e}"))
}

fn square(x: f64, y: f64, side: f64) -> Ring {
    Ring::polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)].map(|(x, y)| Point::new(x, y)))
}

fn run(setup: &Setup, geometry: &Geometry) -> (clopen::cam::Planned, Program) {
    let planned = plan_operation(setup, &setup.operations[0], geometry).unwrap_or_else(|e| panic!("{e}"));
    let text = gcode::write(&planned.toolpath, &[], &gcode::GRBL, Default::default()).unwrap();
    let program = gcode::read(&text).unwrap();
    (planned, program)
}

#[test]
fn a_part_of_another_operation_is_kept_clear_of_by_leads_and_held_against_the_program() {
    let setup = setup("", "kind = \"profile\"\ntool = 1\nthrough = true\nlead = 8\nentry = \"plunge\"\n");
    let own = Region::new(vec![square(10.0, 10.0, 20.0)]);
    // Four millimetres beside: room for the tool, not for the lead.
    let beside = Region::new(vec![square(34.0, 10.0, 20.0)]);
    let gouge = |others: &Region| {
        let geometry = Geometry { area: own.clone(), others: others.clone(), ..Geometry::default() };
        let (planned, program) = run(&setup, &geometry);
        let tool = setup.tool_of(&setup.operations[0]);
        let check = check_operation(&program, &setup.operations[0], &planned, tool, &setup.stock, &Machine::default());
        check.gouge.map_or(f64::NEG_INFINITY, |g| g.depth_mm)
    };
    assert!(gouge(&beside) <= 0.002, "{}", gouge(&beside));
    // Two millimetres beside there is no room for the tool: that is told.
    let touching = Region::new(vec![square(32.0, 10.0, 20.0)]);
    assert!((gouge(&touching) - 1.0).abs() < 1e-6, "{}", gouge(&touching));
}

#[test]
fn drills_come_out_below_with_their_full_diameter() {
    let setup = setup("", "kind = \"drill\"\ntool = 2\nthrough = true\n");
    let area = Region::new(vec![Ring::circle(Point::new(20.0, 20.0), 1.0)]);
    let (planned, program) = run(&setup, &Geometry { area, ..Geometry::default() });
    let lowest = program.motions.iter().map(Motion::lowest).fold(0.0, f64::min);
    let tip = 1.0 / (0.5 * 118f64.to_radians()).tan();
    assert!((lowest + 6.2 + tip).abs() < 1e-3, "{lowest}");
    assert!(planned.notices.is_empty());
}

#[test]
fn holes_that_the_drill_does_not_make_are_told() {
    let setup = setup("", "kind = \"drill\"\ntool = 2\ndepth = 3\n");
    let wide = Ring::circle(Point::new(20.0, 20.0), 2.0);
    let area = Region::new(vec![wide, square(40.0, 40.0, 5.0)]);
    let (planned, _) = run(&setup, &Geometry { area, ..Geometry::default() });
    assert!(planned.notices.iter().any(|n| matches!(n, Notice::HoleNarrow(_, d) if (d - 4.0).abs() < 1e-9)));
    assert!(planned.notices.iter().any(|n| matches!(n, Notice::NotRound(_))));
}

#[test]
fn engraving_follows_lines_that_pass_their_own_ends() {
    let setup = setup("", "kind = \"engrave\"\ntool = 1\ndepth = 0.5\nentry = \"plunge\"\n");
    let points = [(10.0, 40.0), (20.0, 46.0), (30.0, 40.0), (30.0, 50.0), (20.0, 46.0)];
    let ring = Ring::polygon(points.map(|(x, y)| Point::new(x, y)));
    let length: f64 = ring.segments().take(4).map(|s| s.length()).sum();
    let lines = vec![CutLine { ring, is_closed: false }];
    let (_, program) = run(&setup, &Geometry { lines, ..Geometry::default() });
    let cut: f64 = program.motions.iter().filter(|m| m.to.z < -0.4).flat_map(|m| m.trace()).map(|s| s.length()).sum();
    assert!((cut - length).abs() < 1e-3, "{cut} of {length}");
}

#[test]
fn facing_takes_the_stock_where_it_lies() {
    let setup = setup("width = 100\nheight = 60\nzero = \"center\"\n", "kind = \"facing\"\ntool = 1\ndepth = 0.5\n");
    let area = Region::new(vec![square(0.0, 0.0, 10.0)]);
    let (_, program) = run(&setup, &Geometry { area, ..Geometry::default() });
    let cuts = || program.motions.iter().filter(|m| m.to.z < 0.0);
    let lowest = cuts().map(|m| m.to.y).fold(f64::INFINITY, f64::min);
    let left = cuts().map(|m| m.to.x).fold(f64::INFINITY, f64::min);
    assert!(lowest <= -30.0 && left <= -50.0, "{lowest} {left}");
}
