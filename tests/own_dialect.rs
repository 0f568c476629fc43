//! A dialect of one's own: the example of the README.

use std::fs;

use assert_cmd::Command;

const README: &str = include_str!("../README.md");

/// The lines of the README from one that starts with `first`, as long as they are indented.
fn example(first: &str) -> String {
    let lines = README.lines().skip_while(|line| !line.trim_start().starts_with(first));
    lines.map_while(|line| line.strip_prefix("    ")).map(|line| format!("{line}\n")).collect()
}

#[test]
fn the_example_of_the_readme_cools_parks_and_uses_another_work_offset() {
    let dialect = example("# my-machine.toml");
    assert!(dialect.contains("base"), "{dialect}");
    let folder = tempfile::tempdir().unwrap();
    let drawing = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40mm\" height=\"30mm\" viewBox=\"0 0 40 30\">\
                   <rect id=\"r\" x=\"5\" y=\"5\" width=\"30\" height=\"20\"/></svg>";
    let job = "version = 1\n[stock]\nthickness = 6\n[machine]\ndialect = \"my-machine.toml\"\n[[tool]]\nnumber = 1\ndiameter = 3\n\
               [[operation]]\nkind = \"profile\"\ntool = 1\nthrough = true\n";
    for (name, text) in [("my-machine.toml", dialect.as_str()), ("a.svg", drawing), ("job.toml", job)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for arguments in
        [&["mill", "a.svg", "--job", "job.toml"][..], &["mill", "a.svg", "--dialect", "my-machine.toml", "-o", "a.nc"]]
    {
        let output = Command::cargo_bin("clopen").unwrap().current_dir(folder.path()).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        let program = fs::read_to_string(folder.path().join("a.nc")).unwrap();
        let line = |wanted: &str| {
            program.lines().position(|l| l == wanted).unwrap_or_else(|| panic!("no {wanted}:\n{program}"))
        };
        let lines = [line("G55"), line("M3 S18000 M8"), line("M5 M9"), line("G0 X0 Y200"), line("M30")];
        assert!(lines.is_sorted(), "{program}");
    }
}
