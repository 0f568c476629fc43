//! What operations of a job do to each other, and to what lies beside their shapes.

use std::fs;

use assert_cmd::Command;
use serde_json::Value;

/// A drawing of 100 x 100 mm whose shapes are `body`.
fn drawing(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"100mm\" viewBox=\"0 0 100 100\">{body}</svg>"
    )
}

const HEAD: &str = "version = 1
[stock]
thickness = 6
zero = \"drawing\"
[machine]
dialect = \"linuxcnc\"
[[tool]]
number = 1
diameter = 3
depth-per-pass = 2
[[tool]]
number = 2
type = \"v\"
angle = 90
diameter = 10
[[tool]]
number = 3
diameter = 1.5
depth-per-pass = 0.75
[[tool]]
number = 4
type = \"ball\"
diameter = 3
depth-per-pass = 2
";

/// One operation: its name, and its keys.
fn operation(name: &str, keys: &str) -> String {
    let keys = keys.replace("; ", "\n");
    // Sharp corners, where there are any.
    let rounds = ["profile", "pocket", "chamfer"].iter().any(|kind| keys.contains(&format!("kind = \"{kind}\"")));
    let sharp = if rounds { "path-radius = 0\n" } else { "" };
    format!("[[operation]]\nname = \"{name}\"\n{sharp}{keys}\n")
}

struct Run {
    said: String,
    code: Option<i32>,
    /// What was written, or nothing.
    program: String,
}

impl Run {
    /// That the run failed with these words.
    #[track_caller]
    fn fails(&self, words: &str) {
        assert_eq!(self.code, Some(1), "{}", self.said);
        assert!(self.said.contains(words), "{words} is missing: {}", self.said);
    }

    #[track_caller]
    fn is_good(&self) {
        assert_eq!(self.code, Some(0), "{}", self.said);
    }
}

fn mill(body: &str, operations: &[String], more: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), drawing(body)).unwrap();
    fs::write(folder.path().join("job.toml"), format!("{HEAD}{}", operations.concat())).unwrap();
    let arguments = [&["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview"], more].concat();
    let output = Command::cargo_bin("clopen").unwrap().current_dir(folder.path()).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    let program = fs::read_to_string(folder.path().join("x.nc")).unwrap_or_default();
    Run { said, code: output.status.code(), program }
}

const PAIR: &str = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"30\" height=\"30\"/><rect id=\"b\" x=\"44\" y=\"10\" width=\"30\" height=\"30\"/>";

/// Cut out through the stock.
const OUT: &str = "kind = \"profile\"; tool = 1; through = true";

#[test]
fn tabs_that_another_operation_takes_fail() {
    let a = operation("a", &format!("{OUT}; select = {{ id = \"a\" }}; tabs = {{ at = [[40, -25]], height = 1.5 }}"));
    let b = operation("b", &format!("{OUT}; select = {{ id = \"b\" }}; tabs = {{ at = [[74, -25]], height = 1.5 }}"));
    mill(PAIR, &[a.clone(), b.clone()], &[]).fails("operation \"b\" takes a tab of \"a\" away, 1 of 1");
    let apart = PAIR.replace("x=\"44\"", "x=\"50\"");
    let b = b.replace("[[74,", "[[80,");
    mill(&apart, &[a.clone(), b], &[]).is_good();
    // A smaller tool around the same part, without tabs, leaves none.
    let again = operation("again", "kind = \"profile\"; tool = 3; through = true; select = { id = \"a\" }");
    mill(PAIR, &[a, again], &["--accept-losses"]).fails("operation \"again\" takes a tab of \"a\" away");
}

#[test]
fn outlines_that_the_tool_clears_need_no_tabs() {
    let circle = |x: f64, r: f64| format!("M{},30a{r},{r} 0 1 1 {},0a{r},{r} 0 1 1 {},0Z", x - r, 2.0 * r, -2.0 * r);
    let plate = |small: f64| {
        let (holes, large) = (circle(25.0, small), circle(50.0, 9.0));
        format!("<path fill-rule=\"evenodd\" d=\"M10,10H70V50H10Z{holes}{large}\"/>")
    };
    let job = operation("a", &format!("{OUT}; tabs = {{ count = 2, width = 2, height = 1 }}"));
    let count = |run: &Run| {
        serde_json::from_str::<Value>(&run.said).unwrap()["operations"][0]["tabs"].as_array().unwrap().len()
    };
    // Nothing is left of a hole of 5.9 mm by a tool of 3 mm that goes around in it, and a pin of one of 6.4 mm.
    let run = mill(&plate(2.95), std::slice::from_ref(&job), &["--format", "json"]);
    run.is_good();
    assert_eq!(count(&run), 4, "the outline and the large hole");
    let run = mill(&plate(2.95), std::slice::from_ref(&job), &[]);
    assert!(run.said.contains("no tabs on one outline: the tool clears all inside"), "{}", run.said);
    let run = mill(&plate(3.2), std::slice::from_ref(&job), &[]);
    run.fails("2 tabs find no place");
    // Where they are named they are asked for.
    let named = operation("a", &format!("{OUT}; tabs = {{ at = [[25, -27]], width = 2, height = 1 }}"));
    mill(&plate(2.95), &[named], &[]).fails("a tab finds no place");
}

#[test]
fn pieces_that_no_tab_holds_fail_the_job() {
    let hole = |d: &str| format!("<path fill-rule=\"evenodd\" d=\"M5,5H95V95H5Z{d}\"/>");
    let job = |count: usize, keys: &str| {
        operation("a", &format!("{OUT}; tabs = {{ count = {count}, width = 3, height = 1 }}{keys}"))
    };
    // Two rooms joined by a passage that the tool clears: two slugs, and each needs a tab.
    let rooms = hole("M20,30H40V45.5H60V30H80V70H60V50.5H40V70H20Z");
    mill(&rooms, &[job(1, "")], &[]).fails("comes loose, no tab holds it");
    // Tape or a vacuum may do.
    mill(&rooms, &[job(1, "")], &["--accept-losses"]).is_good();
    mill(&rooms, &[job(4, "")], &[]).is_good();
    // An island 6.3 mm from the wall: what stands between two cuts of 3 mm is what the tabs hold on to, and roughing takes it.
    let ring = "M40,50a10,10 0 1 0 20,0a10,10 0 1 0 -20,0Z";
    let island = hole(&format!("M33.7,50a16.3,16.3 0 1 0 32.6,0a16.3,16.3 0 1 0 -32.6,0Z{ring}"));
    mill(&island, &[job(2, "")], &[]).is_good();
    mill(&island, &[job(2, "; allowance = 0.4")], &[]).fails("no place on an outline");
    // Where places are named the rest is meant to come loose, which is told.
    let named = operation("a", &format!("{OUT}; tabs = {{ at = [[20, -50]], width = 3, height = 1 }}"));
    let run = mill(&rooms, &[named], &[]);
    run.is_good();
    assert!(run.said.contains("note    a: a piece of"), "{}", run.said);
}

#[test]
fn a_ball_leaves_a_slug_where_it_is_narrow_and_tabs_hold_it() {
    // At the bottom of the stock a ball of 3 mm that goes 0.2 mm below it is 1.5 mm wide.
    let plate =
        "<path fill-rule=\"evenodd\" d=\"M10,10H70V50H10Z M27.1,30a2.9,2.9 0 1 1 5.8,0a2.9,2.9 0 1 1 -5.8,0Z\"/>";
    let job = operation("a", &format!("{OUT}; tabs = {{ count = 2, width = 2, height = 1 }}"));
    let flat = mill(plate, std::slice::from_ref(&job), &[]);
    assert!(flat.said.contains("nothing comes loose"), "{}", flat.said);
    let ball = mill(plate, &[job.replace("tool = 1", "tool = 4")], &[]);
    ball.fails("find no place");
    ball.fails("comes loose");
}

#[test]
fn outlines_that_the_tool_can_cut_are_not_lost_to_a_path_radius_that_nobody_asked_for() {
    // A hole of 3.6 mm, and two parts 3.6 mm apart; a tool of 3 mm that would go around corners with 0.8 mm.
    let parts = "<path fill-rule=\"evenodd\" d=\"M10,10H40V40H10Z M20,25a1.8,1.8 0 1 1 3.6,0a1.8,1.8 0 1 1 -3.6,0Z\"/>\
                 <rect x=\"43.6\" y=\"10\" width=\"20\" height=\"30\"/>";
    let auto = operation("a", &format!("{OUT}; feed = 1200")).replace("path-radius = 0\n", "");
    let run = mill(parts, std::slice::from_ref(&auto), &[]);
    run.is_good();
    assert!(run.said.contains("2 outlines have smaller path radii, down to 0.200 mm"), "{}", run.said);
    // Asked for, it is kept, and what it loses is told.
    let asked = auto.replace("[[operation]]", "[[operation]]\npath-radius = 0.8");
    let run = mill(parts, &[asked], &[]);
    run.fails("hole 3.60 mm wide");
    run.fails("2 parts merge");
}

#[test]
fn tabs_stay_where_they_are_asked_for() {
    let plate = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"40\"/>";
    // The middles of the sides are where paths are entered otherwise.
    let at = [[40.0, -10.0], [70.0, -30.0]];
    let job = operation("a", &format!("{OUT}; tabs = {{ at = {at:?}, width = 4, height = 1.5 }}"));
    let run = mill(plate, &[job], &["--format", "json"]);
    run.is_good();
    let json: Value = serde_json::from_str(&run.said).unwrap();
    let tabs = json["operations"][0]["tabs"].as_array().unwrap();
    assert_eq!(tabs.len(), 2, "{tabs:?}");
    for (tab, [x, y]) in tabs.iter().zip(at) {
        let (tx, ty) = (tab[0].as_f64().unwrap(), tab[1].as_f64().unwrap());
        let near = at.iter().any(|[x, y]| (tx - x).hypot(ty - y) < 1.6);
        assert!(near, "{tab} is not at ({x}, {y})");
    }
    // Where every side has one, the path is entered between them.
    let all = operation(
        "a",
        &format!("{OUT}; tabs = {{ at = [[40, -10], [70, -30], [40, -50], [10, -30]], width = 4, height = 1.5 }}"),
    );
    let run = mill(plate, &[all], &[]);
    run.is_good();
    assert!(!run.said.contains("had to be moved"), "{}", run.said);
    // In a corner there is no room for one.
    let corner = operation("a", &format!("{OUT}; tabs = {{ at = [[70, -10], [10, -30]], width = 2, height = 1.5 }}"));
    let run = mill(plate, &[corner], &[]);
    assert!(run.said.contains("had to be moved to"), "{}", run.said);
}

#[test]
fn a_cut_that_begins_below_what_is_there_fails() {
    let plate = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"40\"/>";
    let late = operation("late", "kind = \"pocket\"; tool = 1; start-depth = 2; depth = 4");
    mill(plate, std::slice::from_ref(&late), &[]).fails("operation \"late\" starts 2 mm below the top of the stock");
    let before = |depth: f64| operation("before", &format!("kind = \"pocket\"; tool = 1; depth = {depth}"));
    mill(plate, &[before(2.0), late.clone()], &[]).is_good();
    mill(plate, &[before(1.0), late.clone()], &[]).fails("nothing before it cuts there as deep");
    mill(plate, &[late], &["--accept-losses"]).is_good();
}

#[test]
fn chamfers_do_not_reach_into_parts_beside_and_are_not_lost_in_gaps() {
    let near = PAIR.replace("x=\"44\"", "x=\"42\"");
    let chamfer = |width: f64| {
        operation("edge", &format!("kind = \"chamfer\"; tool = 2; width = {width}; select = {{ id = \"a\" }}"))
    };
    let b = operation("b", "kind = \"profile\"; tool = 3; depth = 3; select = { id = \"b\" }");
    let run = mill(&near, &[chamfer(1.0), b.clone()], &[]);
    run.fails("into what must remain");
    assert!(run.program.is_empty(), "not written");
    mill(PAIR, &[chamfer(1.0), b], &[]).is_good();
    let slotted = "<path id=\"a\" fill-rule=\"evenodd\" d=\"M10 10H50V50H10ZM20 30H40V30.8H20Z\"/>";
    mill(slotted, &[chamfer(0.5)], &[]).fails("hole 0.80 mm wide");
    mill(slotted, &[chamfer(0.5)], &["--accept-losses"]).is_good();
}

#[test]
fn outlines_in_pieces_are_joined_and_open_lines_fail() {
    let pieces = "<g fill=\"none\" stroke=\"#000\"><path d=\"M10 10H60\"/><path d=\"M60 50V10\"/><path d=\"M60 50H10\"/>\
                  <path d=\"M10 50L10 10\"/><circle cx=\"35\" cy=\"30\" r=\"8\"/></g>";
    let run = mill(pieces, &[operation("a", OUT)], &["--format", "json"]);
    run.is_good();
    let json: Value = serde_json::from_str(&run.said).unwrap();
    let cut = json["operations"][0]["check"]["statistics"]["cut_length_mm"].as_f64().unwrap();
    // 6.2 mm in four passes, around the plate and inside of the hole, and the ramps between them.
    let lap = 180.0 + 3.0 * std::f64::consts::PI + 13.0 * std::f64::consts::PI;
    assert!((4.0..5.0).contains(&(cut / lap)), "{cut} against laps of {lap}");
    let gap = pieces.replace("M10 50L10 10", "M10 50L10 11");
    mill(&gap, &[operation("a", OUT)], &[]).fails("is open, and nothing is cut along it");
    let on = operation("a", "kind = \"profile\"; tool = 1; depth = 1; side = \"on\"");
    mill(&gap, &[on], &[]).fails("is open, and nothing is cut along it");
    let engraved = operation("a", "kind = \"engrave\"; tool = 2; depth = 0.5");
    mill(&gap, &[engraved], &[]).is_good();
}

#[test]
fn whatever_cuts_a_part_free_before_work_on_it_is_found() {
    let plate = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"60\"/><rect id=\"in\" x=\"30\" y=\"30\" width=\"15\" height=\"15\"/>\
                 <path id=\"line\" d=\"M20 20H40\" fill=\"none\" stroke=\"#000\"/>";
    let pocket = operation("pocket", "kind = \"pocket\"; tool = 1; depth = 2; select = { id = \"in\" }");
    let line = operation("line", "kind = \"engrave\"; tool = 2; depth = 0.5; select = { id = \"line\" }");
    let out =
        |keys: &str| operation("out", &format!("kind = \"profile\"; tool = 1; select = {{ id = \"a\" }}; {keys}"));
    for first in [
        "side = \"outside\"; through = true",
        "side = \"on\"; through = true",
        "side = \"inside\"; through = true",
        "depth = 5.99",
    ] {
        mill(plate, &[out(first), pocket.clone()], &[]).fails("before \"pocket\" works on it");
    }
    mill(plate, &[out("through = true"), line.clone()], &[]).fails("before \"line\" works on it");
    mill(plate, &[out("depth = 4"), pocket.clone(), line.clone()], &[]).is_good();
    mill(plate, &[pocket, line, out("through = true")], &[]).is_good();
    // The tabs of one part do not hold another.
    let both = operation("both", &format!("{OUT}; tabs = {{ at = [[74, -25]], height = 1.5 }}"));
    let in_a = operation("in a", "kind = \"engrave\"; tool = 2; depth = 0.5; select = { id = \"mark\" }");
    let marked = format!("{PAIR}<path id=\"mark\" d=\"M20 20H30\" fill=\"none\" stroke=\"#000\"/>");
    let both = both.replace("path-radius = 0", "path-radius = 0\nselect = { id = [\"a\", \"b\"] }");
    mill(&marked, &[both, in_a], &[]).fails("before \"in a\" works on it");
    // What goes along the wall of a hole does not work on what fell out of it.
    let hole =
        operation("hole", "kind = \"profile\"; tool = 1; side = \"inside\"; through = true; select = { id = \"in\" }");
    let rest = operation(
        "rest",
        "kind = \"profile\"; tool = 3; side = \"inside\"; through = true; rest-of = 1; select = { id = \"in\" }",
    );
    mill(plate, &[hole, rest], &[]).is_good();
}

#[test]
fn facing_covers_what_is_drawn_where_the_drawing_says_what_zero_is() {
    let plate = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"40\"/>";
    let face = operation("face", "kind = \"facing\"; tool = 1; depth = 0.5");
    let run = mill(plate, &[face], &[]);
    run.is_good();
    let ys = run.program.split_whitespace().filter_map(|word| word.strip_prefix('Y')?.parse::<f64>().ok());
    let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    assert!((-51.0..-47.0).contains(&low) && (-13.0..-9.0).contains(&high), "y from {low} to {high}");
}

#[test]
fn drilling_means_the_circles_where_nothing_is_selected() {
    let plate = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"40\"/><circle cx=\"20\" cy=\"20\" r=\"1.5\"/>\
                 <circle cx=\"40\" cy=\"30\" r=\"4\"/>";
    let run = mill(plate, &[operation("holes", "kind = \"drill\"; tool = 1; depth = 4")], &["--format", "json"]);
    run.is_good();
    let json: Value = serde_json::from_str(&run.said).unwrap();
    assert_eq!(json["operations"][0]["check"]["holes"], serde_json::json!([2, 2]));
    let square = "<rect id=\"a\" x=\"10\" y=\"10\" width=\"60\" height=\"40\"/>";
    let run = mill(square, &[operation("holes", "kind = \"drill\"; tool = 1; depth = 4")], &[]);
    assert_eq!(run.code, Some(2), "{}", run.said);
    assert!(run.said.contains("there is no circle to drill"), "{}", run.said);
}
