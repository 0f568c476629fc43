//! `clopen surface check` fails what is no closing: what is missing, turned over, there twice, or open.

#[allow(dead_code)]
mod solids;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{Point, PolygonMesh};

fn put(folder: &Path, name: &str, mesh: &PolygonMesh) {
    fs::write(folder.join(name), write(mesh, MeshFormat::Obj)).unwrap();
}

fn surface(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("clopen"));
    command.current_dir(folder).arg("surface").args(arguments.split_whitespace()).output().unwrap()
}

/// The exit status, and the last line of the report or the error.
fn verdict(folder: &Path, arguments: &str) -> (i32, String) {
    let output = surface(folder, arguments);
    let text = if output.stdout.is_empty() { &output.stderr } else { &output.stdout };
    let text = String::from_utf8_lossy(text);
    (output.status.code().unwrap(), text.lines().last().unwrap_or_default().to_owned())
}

/// The faces of a mesh, changed one by one: each becomes none, one or several.
fn rebuilt(mesh: &PolygonMesh, change: impl Fn(usize, &[u32]) -> Vec<Vec<u32>>) -> PolygonMesh {
    let mut result = PolygonMesh::new(mesh.points.clone());
    for (k, polygon) in mesh.polygons().enumerate() {
        change(k, polygon).iter().for_each(|polygon| result.push(polygon));
    }
    result
}

fn turned(polygon: &[u32]) -> Vec<u32> {
    polygon.iter().rev().copied().collect()
}

/// An L whose concave edge a ball of .3 rounds, and its closing.
fn l_and_its_closing(folder: &Path) -> [PolygonMesh; 2] {
    let l = solids::blocks([4, 4, 2], 0.5, |[x, y, _]| x < 2 || y < 2);
    put(folder, "l.obj", &l);
    assert_eq!(surface(folder, "close l.obj -r .3 -o closed.obj").status.code(), Some(0));
    let closed = read(&fs::read(folder.join("closed.obj")).unwrap(), MeshFormat::Obj).unwrap();
    assert_eq!(verdict(folder, "check l.obj closed.obj -r .3"), (0, "passed".to_owned()));
    [l, closed]
}

#[test]
fn results_that_miss_most_of_the_surface_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let [l, closed] = l_and_its_closing(folder);
    let is_kept = |polygon: &[u32]| polygon.iter().all(|&v| l.points.contains(&closed.points[v as usize]));
    let keep = |yes: bool| if yes { 1 } else { 0 };
    let first = (0..closed.polygon_count()).find(|&k| is_kept(closed.polygon(k))).unwrap();
    for (what, expected, result) in [
        ("one face alone", "missing", rebuilt(&closed, |k, p| vec![p.to_vec(); keep(k == first)])),
        ("what was kept", "borders", rebuilt(&closed, |_, p| vec![p.to_vec(); keep(is_kept(p))])),
        ("all but one face", "borders", rebuilt(&closed, |k, p| vec![p.to_vec(); keep(k != first)])),
        ("each face twice", "twice", rebuilt(&closed, |_, p| vec![p.to_vec(); 2])),
        (
            "one face turned over",
            "run alike",
            rebuilt(&closed, |k, p| vec![if k == first { turned(p) } else { p.to_vec() }]),
        ),
        ("inside out", "the result is inside out", rebuilt(&closed, |_, p| vec![turned(p)])),
    ] {
        put(folder, "bad.obj", &result);
        for option in ["", " --moved-only"] {
            let (code, words) = verdict(folder, &format!("check l.obj bad.obj -r .3{option}"));
            assert!(code == 1 && words.starts_with("FAILED") && words.contains(expected), "{what}: {words}");
        }
    }
}

#[test]
fn a_cube_inside_out_is_no_closing_of_a_cube() {
    let folder = tempfile::tempdir().unwrap();
    let cube = solids::blocks([1, 1, 1], 1.0, |_| true);
    put(folder.path(), "cube.obj", &cube);
    put(folder.path(), "out.obj", &rebuilt(&cube, |_, p| vec![turned(p)]));
    for operation in ["close", "open"] {
        let (code, words) = verdict(folder.path(), &format!("check cube.obj out.obj -r .01 --op {operation}"));
        assert!(code == 1 && words.contains("inside out"), "{operation}: {words}");
    }
    assert_eq!(verdict(folder.path(), "check cube.obj cube.obj -r .01").0, 0);
}

#[test]
fn tolerances_and_lengths_that_mean_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "cube.obj", &solids::blocks([1, 1, 1], 1.0, |_| true));
    for (options, expected) in [
        ("-r .1 --tolerance nan", "above zero"),
        ("-r .1 --tolerance inf", "above zero"),
        ("-r .1 --tolerance -1", "above zero"),
        ("-r .1 --tolerance 0", "above zero"),
        ("-r 1e9", "cube.obj: a radius of 1e9 on a mesh whose box has a diagonal of 1.73205: give one from"),
        ("-r 1e300", "a radius of 1e300 on"),
        ("-r .1 --edge-length .2", "--edge-length 0.2: an edge length must be at most the radius (0.1)"),
        ("-r .1 --edge-length 1e-9", "--edge-length 1e-9: an edge length must be"),
    ] {
        let output = surface(folder.path(), &format!("check cube.obj cube.obj {options}"));
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{options}: {words}");
        assert!(words.contains(expected), "{options}: {words}");
        // Closing refuses the same lengths in the same words.
        if !options.contains("tolerance") {
            let output = surface(folder.path(), &format!("close cube.obj {options} -o out.obj"));
            assert!(String::from_utf8_lossy(&output.stderr).contains(expected), "{options}");
        }
    }
}

#[test]
fn a_ball_that_all_but_fits_a_cup_is_found_on_its_rim() {
    // A cup whose bore of 48 facets is a little narrower than the ball, which rests on its rim.
    let folder = tempfile::tempdir().unwrap();
    let cup = solids::revolved(&[[0.0, 0.0], [0.0, 10.0], [20.0, 10.0], [20.0, 8.0], [2.0, 8.0], [2.0, 0.0]], 48);
    put(folder.path(), "cup.obj", &cup);
    // What the ball leaves of the bore, rebuilt by hand: a bowl below the rim, in rings about the axis.
    let (r, rim): (f64, f64) = (8.1, 8.0 * (std::f64::consts::PI / 48.0).cos());
    let center = 20.0 + (r * r - rim * rim).sqrt();
    let bowl = (0..12).rev().map(|k| rim * f64::from(k) / 12.0).map(|rho| [center - (r * r - rho * rho).sqrt(), rho]);
    let profile: Vec<[f64; 2]> = [[0.0, 0.0], [0.0, 10.0], [20.0, 10.0], [20.0, 8.0]].into_iter().chain(bowl).collect();
    put(folder.path(), "closed.obj", &solids::revolved(&profile, 48));
    let (code, words) = verdict(folder.path(), "check cup.obj closed.obj -r 8.1 --edge-length 1");
    assert_eq!((code, words.as_str()), (0, "passed"));
    // Too little and too much are still told.
    for lift in [-3.0, 3.0] {
        let moved: Vec<[f64; 2]> =
            profile.iter().map(|&[x, rho]| if x < 20.0 && x > 10.0 { [x + lift, rho] } else { [x, rho] }).collect();
        put(folder.path(), "moved.obj", &solids::revolved(&moved, 48));
        let (code, words) = verdict(folder.path(), "check cup.obj moved.obj -r 8.1 --edge-length 1");
        assert!(code == 1 && words.starts_with("FAILED"), "{lift}: {words}");
    }
}

#[test]
fn places_on_small_meshes_have_digits() {
    let folder = tempfile::tempdir().unwrap();
    let mut l = solids::blocks([4, 4, 2], 0.5, |[x, y, _]| x < 2 || y < 2);
    l.points.iter_mut().for_each(|p| *p = Point::from(p.coords * 1e-6));
    put(folder.path(), "l.obj", &l);
    let output = surface(folder.path(), "check l.obj l.obj -r 3e-7");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("h at (0.0000010000, 0.0000010000, 0.0"), "{text}");
    assert!(text.starts_with("h is 5e-8 and the radius 3e-7;"), "{text}");
}
