use super::*;
use crate::gcode::read;
use crate::plane::Point;

const HEAD: &str = "G21 G90 G17 G94 F100\nG0 Z5\nM3 S1000\nG4 P1\n";

fn options() -> SimulateOptions {
    SimulateOptions {
        stock: Stock::new(Point::new(-20.0, -15.0), [40.0, 30.0, 6.0], 0.0),
        cell: 0.1,
        keepouts: Vec::new(),
        spoil: DEFAULT_SPOIL,
        machine: Machine::default(),
    }
}

fn run_with(tools: &[&str], text: &str, options: &SimulateOptions) -> Result<Simulation, SimulateError> {
    let program = read(text).unwrap();
    let given: Vec<Tool> = tools.iter().map(|t| t.parse().unwrap()).collect();
    simulate(&program, &ToolTable::gather(&given, &program), options)
}

fn run(tool: &str, path: &str) -> Simulation {
    run_with(&[tool], &format!("{HEAD}{path}"), &options()).unwrap()
}

/// The kinds of the events with their lines after the head.
fn events(tool: &str, path: &str) -> Vec<(EventKind, usize)> {
    run(tool, path).events.iter().map(|e| (e.kind, e.line - 4)).collect()
}

const RAPID: EventKind = EventKind::RapidThroughStock;

#[test]
fn rapids_are_judged_by_what_stands_at_that_moment() {
    let pocket = "G0 X0 Y0\nG1 Z-3\nG1 X10\nG0 Z5\n";
    // Back into what is cut, and along it; also with the last decimals rounded otherwise.
    assert_eq!(events("0=flat 4mm", &format!("{pocket}G0 X5\nG0 Z-3\nG0 X2.5")), []);
    assert_eq!(events("0=flat 4mm", &format!("{pocket}G0 X10.001 Y0.001\nG0 Z-3.0005")), []);
    // Beside it, deeper, on past its end.
    assert_eq!(events("0=flat 4mm", &format!("{pocket}G0 Y1\nG0 Z-3")), [(RAPID, 6)]);
    assert_eq!(events("0=flat 4mm", &format!("{pocket}G0 Z-3.2")), [(RAPID, 5)]);
    assert_eq!(events("0=flat 4mm", &format!("{pocket}G0 Z-3\nG0 X12")), [(RAPID, 6)]);
    // Before it was cut.
    assert_eq!(events("0=flat 4mm", "G0 X5 Y0\nG0 Z-3\nG0 Z5\nG0 X0\nG1 Z-3\nG1 X10"), [(RAPID, 2)]);
    // Beside the stock there is nothing.
    assert_eq!(events("0=flat 4mm", "G0 X-30\nG0 Z-3\nG0 Z5"), []);
    let found = run("0=flat 4mm", &format!("{pocket}G0 Z-3\nG0 X12")).events[0];
    assert!((found.amount - 3.0).abs() < 1e-12 && found.x_mm > 10.0 && found.z_mm == -3.0, "{found:?}");
}

#[test]
fn tools_below_the_stock_are_found() {
    let overrun = |z: f64| events("0=flat 4mm", &format!("G0 X0 Y0\nG1 Z{z}\nG1 X3\nG1 X5\nG0 Z5\nG0 X6\nG1 Z{z}"));
    assert_eq!(overrun(-6.5), []);
    // What goes on is one event, what comes again another.
    assert_eq!(overrun(-6.6), [(EventKind::Overrun, 2), (EventKind::Overrun, 7)]);
}

#[test]
fn drills_drill_and_spindles_turn() {
    assert_eq!(events("0=drill 3mm", "G0 X0 Y0\nG1 Z-4\nG0 Z5\nG0 X8\nG1 Z-4"), []);
    assert_eq!(events("0=drill 3mm", "G0 X0 Y0\nG1 Z-4\nG1 X2\nG0 Z5"), [(EventKind::DrillSideways, 3)]);
    // In the air it may.
    assert_eq!(events("0=drill 3mm", "G0 X0 Y0\nG1 X2\nG1 Z-4"), []);
    let off = events("0=flat 3mm", "M5\nG0 X0 Y0\nG1 Z-4\nG1 X4\nG0 Z5\nM3\nG0 X8\nG1 Z-4");
    assert_eq!(off, [(EventKind::SpindleOff, 3)]);
    // Where nothing is left to cut, it may stand.
    assert_eq!(events("0=flat 3mm", "G0 X0 Y0\nG1 Z-4\nM5\nG1 Z-2\nG1 Z-4"), []);
}

#[test]
fn keepouts_are_entered_by_the_whole_tool() {
    let with = |keepout: &str, path: &str| {
        let options = SimulateOptions { keepouts: vec![keepout.parse().unwrap()], ..options() };
        let found = run_with(&["0=flat 4mm"], &format!("{HEAD}{path}"), &options).unwrap();
        found.events.iter().map(|e| (e.kind, e.line - 4, e.amount)).collect::<Vec<_>>()
    };
    let collision = EventKind::Collision { keepout: 1 };
    assert_eq!(with("10,10,15,14,8", "G0 X12 Y9\nG0 X0"), [(collision, 1, 1.0)]);
    assert_eq!(with("10,10,15,14,8", "G0 X12 Y8\nG0 X0"), []);
    assert_eq!(with("10,10,15,14,4", "G0 X12 Y9\nG0 X0"), []);
}

#[test]
fn a_tool_that_is_not_known_is_named_with_its_line() {
    let text = format!("{HEAD}T1\nG0 X0 Y0\nG1 Z-1\nG0 Z5\nT2\nG0 X4\nG1 Z-1");
    let error = run_with(&["T1=flat 4mm"], &text, &options()).unwrap_err();
    assert_eq!(error, SimulateError::UnknownTool { number: 2, line: 11 });
    assert!(error.to_string().contains("--tool \"2="), "{error}");
    let error = run_with(&[], &format!("{HEAD}G0 X0\nG1 Z-1"), &options()).unwrap_err();
    assert!(error.to_string().contains("line 6") && error.to_string().contains("--tool \"0="), "{error}");
    // Above the stock no tool is needed.
    assert!(run_with(&[], &format!("{HEAD}G0 X0\nG1 Z0"), &options()).is_ok());
}

#[test]
fn operations_have_their_own_figures() {
    let text = format!(
        "{HEAD}(operation slot)\nT1\nG0 X0 Y0\nG1 Z-2\nG1 X10\nG0 Z5\n(operation hole)\nT2\nG0 X0 Y10\nG1 Z-5\nG4 P1.5\n\
         G0 Z5\n"
    );
    let found = run_with(&["1=flat 4mm", "2=flat 6mm"], &text, &options()).unwrap();
    let [slot, hole] = found.operations.as_slice() else { panic!("{:?}", found.operations) };
    assert_eq!((slot.name.as_str(), slot.tool, slot.first_line, slot.last_line), ("slot", 1, 5, 10));
    assert_eq!((hole.name.as_str(), hole.deepest_z_mm), ("hole", Some(-5.0)));
    assert_eq!((slot.cut_length_mm, hole.cut_length_mm), (17.0, 10.0));
    let volume = 2.0 * (40.0 + 4.0 * std::f64::consts::PI);
    assert!((slot.removed_mm3 / volume - 1.0).abs() < 5e-3, "{slot:?}");
    assert!(hole.seconds > 1.5);
    assert!((found.removed_mm3 - found.map.removed()).abs() < 1e-6);
    assert_eq!(found.events, []);
}

#[test]
fn rapids_above_the_stock_are_never_events() {
    for (x, y) in [(0.0, 0.0), (15.0, 3.3), (-19.0, -14.0)] {
        assert_eq!(events("0=ball 6mm", &format!("G0 Z0\nG0 X{x} Y{y}\nG0 X{} Y{}\nG0 Z9", -y, -x)), []);
    }
}
