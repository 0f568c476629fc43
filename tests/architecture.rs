//! The rooms import each other in one direction only.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Who may import whom; a room may always import itself.
const ALLOWED: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("plane", &["units"]),
    ("linalg", &[]),
    ("mesh", &["linalg", "units"]),
    ("flow", &["linalg", "mesh", "plane", "units"]),
    ("rolling", &["mesh", "plane", "units"]),
    ("reference", &["mesh", "plane", "units"]),
    ("check", &["mesh", "plane", "reference", "units"]),
    ("io", &["mesh", "plane", "units"]),
    ("cam", &["plane", "rolling", "units"]),
    ("gcode", &["cam", "plane", "units"]),
    ("preview", &["cam", "gcode", "mesh", "plane", "units"]),
    ("cli", &["cam", "check", "flow", "gcode", "io", "mesh", "plane", "preview", "reference", "rolling", "units"]),
];

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The rooms that the code of a file names after `crate::`; what stands behind `#[cfg(test)]` is free.
fn imports(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let lines = code.lines().filter(|l| !l.trim_start().starts_with("//"));
    lines
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .collect()
}

#[test]
fn rooms_import_each_other_in_one_direction() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let allowed: BTreeMap<_, _> = ALLOWED.iter().copied().collect();
    let mut seen = 0;
    let mut wrong = vec![];
    for entry in fs::read_dir(&root).unwrap() {
        let room_path = entry.unwrap().path();
        if !room_path.is_dir() {
            continue;
        }
        let room = room_path.file_name().unwrap().to_string_lossy().into_owned();
        let may = allowed.get(room.as_str()).unwrap_or_else(|| panic!("src/{room} is no room of the design"));
        let mut files = vec![];
        rust_files(&room_path, &mut files);
        for file in files {
            // Files of tests alone may look at everything.
            if file.file_stem().is_some_and(|s| s == "tests" || s == "test_shapes") {
                continue;
            }
            for import in imports(&fs::read_to_string(&file).unwrap()) {
                seen += 1;
                if import != room && allowed.contains_key(import.as_str()) && !may.contains(&import.as_str()) {
                    wrong.push(format!("{} imports {import}", file.strip_prefix(&root).unwrap().display()));
                }
            }
        }
    }
    assert!(seen > 100, "only {seen} imports were found: the test looks in the wrong place");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn an_import_in_a_comment_or_a_test_does_not_count() {
    let text = "use crate::plane::Point;\n// crate::io\nfn f() -> crate::units::Radius {}\n#[cfg(test)]\nmod tests {\nuse crate::gcode::x;\n";
    assert_eq!(imports(text), ["plane", "units"]);
}
