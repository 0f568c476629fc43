//! Jobs that make no sense: each is refused before it is begun, with its line and something to try.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60">
<rect id="a" x="10" y="10" width="40" height="40" fill="#f00"/>
<circle id="c" cx="30" cy="30" r="5" fill="#00f"/>
<path id="l" d="M15 15L45 15" fill="none" stroke="#0f0"/>
</svg>"##;

/// Everything before the operations, which begin on line 32.
const HEAD: &str = "version = 1
[stock]
thickness = 6
[machine]
dialect = \"grbl\"
[[tool]]
number = 1
diameter = 3
feed = 1000
plunge-feed = 300
spindle-speed = 18000
depth-per-pass = 1
[[tool]]
number = 2
diameter = 6
depth-per-pass = 2
[[tool]]
number = 3
type = \"v\"
angle = 90
diameter = 6
depth-per-pass = 2
[[tool]]
number = 4
type = \"drill\"
diameter = 3
[[tool]]
number = 5
type = \"ball\"
diameter = 4
depth-per-pass = 1
";

fn clopen(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("clopen").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// What the command says of `job`, and its exit status.
fn mill(job: &str) -> (String, Option<i32>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), DRAWING).unwrap();
    fs::write(folder.path().join("job.toml"), job).unwrap();
    let output = clopen(folder.path(), &["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview"]);
    (said(&output), output.status.code())
}

/// Every operation, put behind the head, is refused with these words and the line of these.
fn refused(cases: &[(&str, &str, &str)]) {
    for (operation, line_of, words) in cases {
        let job = format!("{HEAD}[[operation]]\n{operation}\n");
        let line = 1 + job.lines().position(|l| l.contains(line_of)).unwrap_or_else(|| panic!("{line_of}"));
        let (text, code) = mill(&job);
        assert_eq!(code, Some(2), "{operation}: {text}");
        assert!(text.contains(words), "{operation}: {text}");
        assert!(text.contains(&format!("line {line}: ")), "{operation}: line {line}: {text}");
    }
}

#[test]
fn what_would_take_all_memory_or_days_is_refused_before_it_is_begun() {
    refused(&[
        ("kind = \"profile\"\ntool = 1\ndepth = 2\ntabs = { count = 1000000000 }", "tabs =", "at most 1000"),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 2\ntabs = { spacing = 1e-9, width = 1e-9 }",
            "tabs =",
            "run into each other",
        ),
        ("kind = \"profile\"\ntool = 1\ndepth = 2\ntabs = { at = [] }", "tabs =", "name one at least"),
        ("kind = \"profile\"\ntool = 1\ndepth = 2\ntabs = { at = [[nan, 0.0]] }", "tabs =", "no place of a machine"),
        ("kind = \"drill\"\ntool = 4\ndepth = 2\nselect = { id = \"c\" }\npeck = 1e-5", "peck =", "at least 0.010 mm"),
        ("kind = \"pocket\"\ntool = 1\ndepth = 1\nstepover = 0.001", "stepover =", "at least 1 %"),
        ("kind = \"pocket\"\ntool = 1\ndepth = 1\nstepover = 1e-9\npattern = \"raster\"", "stepover =", "at least 1 %"),
        ("kind = \"pocket\"\ntool = 1\ndepth = 1\nstepover = \"1%\"", "[[operation]]", "lie inside of each other"),
        (
            "kind = \"pocket\"\ntool = 1\ndepth = 1\nallowance = 0.2\nfinish = false\ncorners = \"dogbone\"",
            "corners =",
            "give corners to the operation that finishes",
        ),
        ("kind = \"facing\"\ntool = 1\ndepth = 1\nstepover = 0.001", "stepover =", "at least 1 %"),
    ]);
    let (text, code) = mill(
        &format!("{HEAD}[[operation]]\nkind = \"engrave\"\ntool = 1\ndepth = 1\n")
            .replace("= 6\ndepth", "= 1e-6\ndepth"),
    );
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("line 15: diameter is 0.000001 mm"), "{text}");
}

#[test]
fn a_drawing_in_the_wrong_unit_is_refused_with_the_length_of_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let job = format!("{HEAD}[[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 1\n");
    fs::write(folder.path().join("job.toml"), job).unwrap();
    for (extent, words) in [("1e9", "mm across"), ("40000", "km")] {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{extent}mm\" height=\"{extent}mm\" viewBox=\"0 0 1 1\">\
             <rect width=\"1\" height=\"1\"/></svg>"
        );
        fs::write(folder.path().join("a.svg"), svg).unwrap();
        let output = clopen(folder.path(), &["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview"]);
        assert_eq!(output.status.code(), Some(2), "{extent}: {}", said(&output));
        assert!(said(&output).contains("line 32: operation \"pocket 1\""), "{extent}: {}", said(&output));
        assert!(said(&output).contains(words), "{extent}: {}", said(&output));
    }
}

#[test]
fn a_key_that_means_nothing_for_its_kind_is_refused_with_the_kinds_that_take_it() {
    let start = |kind: &str, tool: u8| format!("kind = \"{kind}\"\ntool = {tool}\n");
    let depth = "depth = 1\nselect = { id = \"c\" }\n";
    let mut cases: Vec<(String, String, String)> = Vec::new();
    let mut case = |kind: &str, tool: u8, rest: &str, key: &str, takers: &str| {
        let operation = start(kind, tool) + rest + key;
        let name = key.split(" =").next().unwrap().to_owned();
        cases.push((
            operation,
            format!("{name} ="),
            format!("{name} means nothing in an operation of kind {kind}: leave it out, it belongs to {takers}"),
        ));
    };
    for (kind, tool, rest) in [
        ("pocket", 1, depth),
        ("drill", 4, depth),
        ("engrave", 1, depth),
        ("facing", 1, depth),
        ("v-carve", 3, ""),
        ("chamfer", 3, "width = 0.5\n"),
    ] {
        case(kind, tool, rest, "tabs = { count = 2 }", "profile");
        case(kind, tool, rest, "onion-skin = 0.2", "profile");
    }
    for key in ["lead = 1", "allowance = 0.1", "finish = true"] {
        case("drill", 4, depth, key, "profile, pocket");
    }
    for (key, takers) in [
        ("peck = 1", "drill"),
        ("stepover = 1", "pocket, facing"),
        ("max-depth = 1", "v-carve"),
        ("width = 1", "chamfer"),
        ("corners = \"dogbone\"", "profile, pocket"),
    ] {
        case("engrave", 1, depth, key, takers);
    }
    case("v-carve", 3, "", "depth = 1", "profile, pocket, drill, engrave, facing");
    let cases: Vec<(&str, &str, &str)> = cases.iter().map(|(a, b, c)| (a.as_str(), b.as_str(), c.as_str())).collect();
    refused(&cases);
    let coarse = "kind = \"pocket\"\ntool = 2\ndepth = 2\n[[operation]]\nkind = \"profile\"\nside = \"inside\"\ntool = 1\ndepth = 2\nrest-of = 2\n";
    for key in ["tabs = { count = 2 }", "lead = 1", "onion-skin = 0.2", "allowance = 0.1", "corners = \"dogbone\""] {
        let name = key.split(" =").next().unwrap();
        refused(&[(&format!("{coarse}{key}"), &format!("{name} ="), "together with rest-of")]);
    }
}

#[test]
fn what_defaults_and_tools_say_is_no_key_of_the_operation() {
    let (text, code) =
        mill(&format!("{HEAD}[[operation]]\nkind = \"drill\"\ntool = 1\nthrough = true\nselect = {{ id = \"c\" }}\n"));
    assert_eq!(code, Some(0), "{text}");
}

#[test]
fn values_that_no_tool_and_no_machine_has_are_refused() {
    refused(&[
        ("kind = \"profile\"\ntool = 1\ndepth = 5\nfinal-pass = 10", "final-pass", "as thick as the cut is deep"),
        ("kind = \"profile\"\ntool = 1\ndepth = 5\nfinal-pass = 4", "final-pass", "more than depth-per-pass"),
        ("kind = \"profile\"\ntool = 1\ndepth = 2\nallowance = 2", "allowance", "more than the radius"),
        ("kind = \"pocket\"\ntool = 1\ndepth = 8.1", "depth = 8.1", "the stock is 6 mm thick"),
        ("kind = \"profile\"\ntool = 3\ndepth = 2", "tool = 3", "use it to v-carve, chamfer or engrave"),
        ("kind = \"profile\"\ntool = 1\ndepth = 2\nspindle-speed = 0.001", "spindle-speed = 0", "at least 0.1"),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 2\n[[keepout]]\nx = [0, 20]\ny = [0, 20]\ntop = -inf",
            "top =",
            "a height in millimetres",
        ),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 1\nname = \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx operation two\"",
            "name =",
            "at most 40",
        ),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 1\n[[tool]]\nnumber = 7\ndiameter = 2\nflutes = 0",
            "flutes",
            "1 cutting edge",
        ),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 1\n[[tool]]\nnumber = 7\ndiameter = 2\nangle = 60",
            "angle = 60",
            "that of a cone",
        ),
        ("kind = \"profile\"\ntool = [1]\ndepth = 1", "tool = [1]", "its number or its name"),
        (
            "kind = \"profile\"\ntool = 1\ndepth = 1\nselect = \"a\"",
            "select =",
            "the text \"a\" makes no sense here: select = { id",
        ),
    ]);
}

#[test]
fn a_spindle_speed_beyond_the_machine_is_refused_where_it_is_said() {
    let profile = "[[operation]]\nkind = \"profile\"\ntool = 1\ndepth = 1\n";
    let slow = HEAD.replace("dialect = \"grbl\"", "dialect = \"grbl\"\nlargest-spindle-speed = 12000");
    let (text, code) = mill(&format!("{slow}{profile}"));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("line 12: spindle-speed is 18000") && text.contains("12000"), "{text}");
    let (text, code) = mill(&format!("{slow}{profile}spindle-speed = 12000\nselect = {{ id = \"a\" }}\n"));
    assert_eq!(code, Some(0), "{text}");
    let (text, _) = mill(&format!("{slow}{profile}spindle-speed = 12001\n"));
    assert!(text.contains("line 37: spindle-speed is 12001"), "{text}");
}

#[test]
fn what_the_controller_answers_is_refused_by_its_own_file_and_line_and_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("a.svg", DRAWING);
    let job = HEAD.replace("dialect = \"grbl\"", "dialect = \"my.toml\"\nsettings = \"grbl.txt\"");
    write("job.toml", &format!("{job}[[operation]]\nkind = \"profile\"\ntool = 1\ndepth = 1\n"));
    write("my.toml", "base = \"grbl\"\n");
    let run = |more: &[&str]| {
        let output = clopen(folder.path(), &[&["mill", "a.svg", "--job", "job.toml", "--no-preview"], more].concat());
        (said(&output), output.status.code())
    };
    for (settings, words) in [
        ("$11=0.01\n$130=0\n", "line 2: $130 is 0"),
        ("$11=0.01\n$120=1e308\n", "line 2: $120 is 1"),
        ("$110=1e-300\n", "line 1: $110 is"),
    ] {
        write("grbl.txt", settings);
        let (text, code) = run(&["-o", "x.nc"]);
        assert_eq!(code, Some(2), "{text}");
        assert!(text.contains("grbl.txt") && text.contains(words) && !text.contains("job.toml"), "{text}");
    }
    write("grbl.txt", "$30=12000\n");
    let (text, _) = run(&["-o", "x.nc"]);
    assert!(text.contains("spindle-speed is 18000"), "{text}");
    write("grbl.txt", "$30=24000\n");
    for (file, before) in [("grbl.txt", "$30=24000\n"), ("my.toml", "base = \"grbl\"\n")] {
        for more in [["-o", file].as_slice(), &["-o", "x.nc", "--html", file]] {
            let (text, code) = run(more);
            assert_eq!(code, Some(2), "{more:?}: {text}");
            assert!(text.contains("written over"), "{more:?}: {text}");
            assert_eq!(fs::read_to_string(folder.path().join(file)).unwrap(), before);
        }
    }
    // The second program of a job, and a profile without operations, keep them as well.
    write("x-2-t2.nc", "$30=24000\n");
    let two = fs::read_to_string(folder.path().join("job.toml")).unwrap().replace("grbl.txt", "x-2-t2.nc");
    write("job.toml", &format!("{two}[[operation]]\nkind = \"profile\"\ntool = 2\ndepth = 1\n"));
    let (text, code) = run(&["-o", "x.nc"]);
    assert_eq!(code, Some(2), "{text}");
    assert_eq!(fs::read_to_string(folder.path().join("x-2-t2.nc")).unwrap(), "$30=24000\n", "{text}");
    let output = clopen(folder.path(), &["mill", "a.svg", "--dialect", "my.toml", "-o", "my.toml", "--no-preview"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert_eq!(fs::read_to_string(folder.path().join("my.toml")).unwrap(), "base = \"grbl\"\n");
}

#[test]
fn a_rest_needs_something_that_it_is_the_rest_of() {
    refused(&[
        ("kind = \"pocket\"\ntool = 1\ndepth = 2\nrest-of = 2", "rest-of", "no profile or pocket before"),
        (
            "kind = \"pocket\"\ntool = 2\ndepth = 1\n[[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 2\nrest-of = 2",
            "rest-of",
            "has gone 1 mm deep, and this operation goes 2 mm",
        ),
        (
            "kind = \"pocket\"\ntool = 1\ndepth = 2\nrest-of = 2\n[[operation]]\nkind = \"pocket\"\ntool = 2\ndepth = 2",
            "rest-of",
            "no profile or pocket before",
        ),
    ]);
}

#[test]
fn a_broken_dialect_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), DRAWING).unwrap();
    fs::write(folder.path().join("my.toml"), "base = \"grbl\"\nline-numbers = 300\n").unwrap();
    let output = clopen(folder.path(), &["mill", "a.svg", "--dialect", "my.toml", "-o", "x.nc"]);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert_eq!(text.matches("invalid type").count(), 1, "{text}");
}
