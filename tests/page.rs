//! `clopen mill --html`: one page that tells all, and needs nothing but a browser.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn samples() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples")
}

/// The page that `clopen mill` writes with these arguments, and its exit status.
fn page(folder: &Path, arguments: &[&str]) -> (String, i32) {
    let output = Command::cargo_bin("clopen")
        .unwrap()
        .current_dir(folder)
        .arg("mill")
        .args(arguments)
        .args(["-o", "part.nc", "--html", "part.html"])
        .output()
        .unwrap();
    let status = output.status.code().unwrap();
    assert!(status < 2, "{}", String::from_utf8_lossy(&output.stderr));
    (fs::read_to_string(folder.join("part.html")).unwrap(), status)
}

/// Elements that have no end.
const EMPTY: [&str; 4] = ["meta", "input", "img", "br"];

/// The elements of a page with their attributes, in order. Fails where one is not closed, or closed in the wrong place.
fn elements(html: &str) -> Vec<(String, String)> {
    let mut open: Vec<String> = Vec::new();
    let mut found = Vec::new();
    let mut rest = html.strip_prefix("<!DOCTYPE html>\n").expect("a page of HTML 5");
    while let Some(start) = rest.find('<') {
        // Inside of scripts and styles nothing is markup but their end.
        let raw = open.last().filter(|name| ["script", "style"].contains(&name.as_str()));
        let start = match raw {
            Some(name) => rest.find(&format!("</{name}")).unwrap_or_else(|| panic!("no end of {name}")),
            None => start,
        };
        let end = start + rest[start..].find('>').expect("an end of the tag");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "closed out of order");
            continue;
        }
        let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()), "{tag}");
        assert_eq!(attributes.matches('"').count() % 2, 0, "{tag}");
        if !EMPTY.contains(&name) {
            open.push(name.to_owned());
        }
        found.push((name.to_owned(), attributes.to_owned()));
    }
    assert!(open.is_empty(), "never closed: {open:?}");
    found
}

/// What the page's script draws.
fn work(html: &str) -> Value {
    let data = html.split(r#"<script type="application/json" id="work">"#).nth(1).unwrap();
    serde_json::from_str(data.split("</script>").next().unwrap()).unwrap()
}

/// Nothing comes from elsewhere.
fn assert_self_contained(html: &str) {
    let found = elements(html);
    assert!(found.len() > 50, "{}", found.len());
    for (name, attributes) in &found {
        assert!(!["link", "iframe", "object", "embed", "base", "form", "b"].contains(&name.as_str()), "{name}");
        for source in attributes.split("src=").skip(1) {
            assert!(source.starts_with("\"data:image/png;base64,"), "{}", &source[..40.min(source.len())]);
        }
        assert!(!attributes.contains("href="), "{attributes}");
    }
    for word in ["http:", "https:", "//cdn", "@import", "url(", "fetch(", "import("] {
        assert!(!html.contains(word), "{word}");
    }
    assert!(html.contains("default-src 'none'"));
}

#[test]
fn the_page_of_a_part_tells_all_and_stands_alone() {
    let folder = tempfile::tempdir().unwrap();
    let bracket = samples().join("bracket.svg");
    let (html, status) = page(folder.path(), &[bracket.to_str().unwrap()]);
    assert_self_contained(&html);
    assert!(html.contains("<h1>bracket.svg: what will be cut</h1>") && html.contains("img alt=\"picture of part.nc\""));
    assert_eq!(html.contains("<strong>Good</strong>"), status == 0);
    assert!(html.contains("Time saved by rounding") && html.contains("with sharp inside corners"));
    // All motions, to the end of the program.
    let text = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    let program = clopen::gcode::read(&text).unwrap();
    let shown = work(&html);
    let motions = shown["motions"].as_array().unwrap();
    assert!(motions.len() >= program.motions.len(), "{} of {}", motions.len(), program.motions.len());
    let (last, expected) = (motions.last().unwrap(), program.motions.last().unwrap());
    assert_eq!(last[1].as_u64().unwrap() as usize, expected.line);
    assert_eq!(last[5].as_f64().unwrap(), expected.to.z);
    let seconds = clopen::cam::estimate(&program, &clopen::cam::Machine::default()).total_seconds();
    assert!((last[0].as_f64().unwrap() - seconds).abs() < 1e-3, "{last} {seconds}");
    assert_eq!(shown["tools"][0]["diameter"], 3.175);
    assert_eq!(page(folder.path(), &[bracket.to_str().unwrap()]).0, html, "the same page each time");
}

#[test]
fn the_page_of_a_job_has_a_program_for_each_tool() {
    let folder = tempfile::tempdir().unwrap();
    let [drawing, job] = ["bracket.svg", "bracket.toml"].map(|name| samples().join("jobs").join(name));
    let arguments = [drawing.to_str().unwrap(), "--job", job.to_str().unwrap(), "--no-preview"];
    let (html, _) = page(folder.path(), &arguments);
    assert_self_contained(&html);
    assert!(!html.contains("<img"));
    for label in
        ["bolt holes", "slot around a boss", "corners of the slot", "seat of a square part", "marks", "cut out"]
    {
        assert!(html.contains(&format!("<td>{label}</td>")), "{label}");
    }
    let names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    let files = names.iter().filter(|n| n.ends_with(".nc")).count();
    let shown = work(&html);
    assert_eq!(shown["programs"].as_array().unwrap().len(), files);
    // Each with its own tool, although programs for this controller do not name it.
    assert_eq!(shown["tools"][0]["name"], "3 mm drill");
    // The larger tool leaves the corners of the slot, and the page knows who takes them.
    assert!(html.contains("; &quot;corners of the slot&quot; takes what it can of it"));
}

#[test]
fn lost_features_are_told_with_the_tool_that_would_cut_them() {
    let folder = tempfile::tempdir().unwrap();
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40"><path d="M5 5H55V35H5Z M20 20a1 1 0 1 0 2 0a1 1 0 1 0 -2 0Z" fill-rule="evenodd"/></svg>"#;
    fs::write(folder.path().join("plate.svg"), svg).unwrap();
    let (html, status) = page(folder.path(), &["plate.svg", "--path-radius", "0"]);
    assert_eq!(status, 1);
    assert!(html.contains("<strong>Not good</strong>") && html.contains("1 feature of the drawing is lost"));
    for cell in ["hole 2.00 mm wide", "16, 15", "filled, 3.14 mm²", "the tool of 3.175 mm does not fit"] {
        assert!(html.contains(&format!("{cell}</td>")), "{cell}");
    }
    // Flattening takes a little of the circle.
    assert!(html.contains("<td>a tool below 1.99"));
    assert!(!html.contains("<td>inside corner"), "what stands in the hole is the hole");
    assert!(html.contains("there is nothing to compare"));
}

#[test]
fn names_are_text_and_never_markup() {
    let folder = tempfile::tempdir().unwrap();
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40"><rect width="60" height="40"/></svg>"#;
    fs::write(folder.path().join("a&b<i>.svg"), svg).unwrap();
    let job = "version = 1\n[stock]\nthickness = 6\n[[tool]]\nnumber = 1\nname = '</script><b>\"mill\"'\ndiameter = 3\n\
               [[operation]]\nkind = \"profile\"\nname = '</script><b>'\ntool = 1\nthrough = true\n";
    fs::write(folder.path().join("job.toml"), job).unwrap();
    let (html, _) = page(folder.path(), &["a&b<i>.svg", "--job", "job.toml", "--no-preview"]);
    assert_self_contained(&html);
    assert!(html.contains("<td>&lt;/script&gt;&lt;b&gt;</td>") && html.contains("<h1>a&amp;b&lt;i&gt;.svg"));
    assert_eq!(work(&html)["tools"][0]["name"], "</script><b>\"mill\"");
}

#[test]
fn a_page_takes_no_place_that_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let bracket = samples().join("bracket.svg");
    for html in ["-", "part.nc", "part.png"] {
        let output = Command::cargo_bin("clopen")
            .unwrap()
            .current_dir(folder.path())
            .args(["mill", bracket.to_str().unwrap(), "-o", "part.nc", "--html", html])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
