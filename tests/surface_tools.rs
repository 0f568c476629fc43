//! The whole commands `clopen surface cut` and `offset`, and what is left of any command that is broken off.

#[allow(dead_code)]
mod solids;

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use clopen::io::mesh::{MeshFormat, read, scalar_name, write, write_named};
use clopen::mesh::{PolygonMesh, problems};
use serde_json::Value;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, mesh) in [("bracket", solids::bracket()), ("teeth", solids::teeth())] {
        fs::write(folder.path().join(format!("{name}.obj")), write(&mesh, MeshFormat::Obj)).unwrap();
    }
    folder
}

fn surface(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("clopen"));
    command.current_dir(folder).arg("surface").args(arguments.split_whitespace());
    command
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn done(folder: &Path, arguments: &str) -> Value {
    let output = surface(folder, &format!("{arguments} --format json")).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn mesh(folder: &Path, name: &str) -> PolygonMesh {
    let format = MeshFormat::of_path(Path::new(name)).unwrap();
    read(&fs::read(folder.join(name)).unwrap(), format).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|f| f.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_plane_cuts_off_what_is_in_front_of_it() {
    let folder = folder();
    let report = done(folder.path(), "cut bracket.obj --plane 0,0,.35,0,0,1 -o below.obj");
    assert!((report["volume_out"].as_f64().unwrap() - 2.56 * 0.35).abs() < 1e-9, "{report}");
    let (before, after) = (mesh(folder.path(), "bracket.obj"), mesh(folder.path(), "below.obj"));
    assert_eq!(problems(&after), []);
    let kept = report["faces_kept"].as_u64().unwrap() as usize;
    let corners = |m: &PolygonMesh, k: usize| m.polygon(k).iter().map(|&v| m.points[v as usize]).collect::<Vec<_>>();
    let below = (0..before.polygon_count()).filter(|&k| corners(&before, k).iter().all(|p| p.z < 0.35));
    let below: Vec<_> = below.map(|k| corners(&before, k)).collect();
    assert_eq!((0..kept).map(|k| corners(&after, k)).collect::<Vec<_>>(), below);
    for (arguments, expected) in [
        ("cut bracket.obj --plane 0,0,-1,0,0,1 -o out.obj", "turn the normal"),
        ("cut bracket.obj --plane 0,0,1,0,0,0 -o out.obj", "no length"),
        ("cut bracket.obj --plane 0,0,1 -o out.obj", "a point and a normal"),
        ("offset bracket.obj -d 0 -o out.obj", "0.05"),
        ("offset bracket.obj -d .1 --only-moved -o out.obj", "PLY"),
        ("offset absent.obj -d .1 -o out.obj", "absent.obj"),
    ] {
        let output = surface(folder.path(), arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
    }
    assert!(!folder.path().join("out.obj").exists());
}

#[test]
fn braces_are_a_closing_cut_open_and_thickened() {
    let folder = folder();
    done(folder.path(), "close teeth.obj -r .1 -o closed.ply");
    done(folder.path(), "cut closed.ply --plane 0,0,.62,0,0,-1 --open -o sheet.ply");
    let report = done(folder.path(), "offset sheet.ply -d .03 --shell -o braces.obj");
    let braces = mesh(folder.path(), "braces.obj");
    assert_eq!(problems(&braces), []);
    // Inside they are the teeth, bit for bit.
    let sheet = mesh(folder.path(), "sheet.ply");
    assert_eq!(braces.points[..sheet.points.len()], sheet.points);
    let thickness = report["volume_out"].as_f64().unwrap() / sheet.triangulated().area();
    assert!((0.03..0.04).contains(&thickness), "{thickness}");
    // The part alone that was filled in.
    done(folder.path(), "offset closed.ply -d .01 --shell --only-moved -o filled.obj");
    let filled = mesh(folder.path(), "filled.obj");
    assert!(filled.points.iter().all(|p| p.z > 0.4 && p.z < 1.2), "only roots of teeth have moved");
}

#[test]
fn what_the_distance_is_too_large_for_fails() {
    let folder = folder();
    let output = surface(folder.path(), "offset bracket.obj -d -.6 -o out.obj").output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    assert!(words(&output).contains("CROSSED"));
}

#[test]
fn a_solid_is_not_turned_inside_out() {
    let folder = folder();
    let cube = solids::blocks([1, 1, 1], 10.0, |_| true);
    fs::write(folder.path().join("cube.obj"), write(&cube, MeshFormat::Obj)).unwrap();
    for arguments in ["-d -6", "-d -6 --shell", "-d -5.001"] {
        let output = surface(folder.path(), &format!("offset cube.obj {arguments} -o out.obj")).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", words(&output));
        assert!(words(&output).contains("inside out"), "{}", words(&output));
        assert!(!folder.path().join("out.obj").exists());
    }
    for (arguments, volume) in [("-d -4.9", 0.2f64.powi(3)), ("-d -4 --shell", 1000.0 - 8.0), ("-d 20", 125e3)] {
        let report = done(folder.path(), &format!("offset cube.obj {arguments} -o out.obj"));
        assert!((report["volume_out"].as_f64().unwrap() - volume).abs() < 1e-6 * volume, "{report}");
        assert_eq!(report["faces_turned"], 0);
    }
    // A slab of which the rims alone turn over: it is told, with the place.
    let slab = solids::blocks([4, 4, 1], 1.0, |[x, y, _]| x == 0 || y == 0);
    fs::write(folder.path().join("slab.obj"), write(&slab, MeshFormat::Obj)).unwrap();
    let output = surface(folder.path(), "offset slab.obj -d .6 -o out.obj").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "outward there is room: {}", words(&output));
    let output = surface(folder.path(), "offset slab.obj -d -.6 -o out.obj").output().unwrap();
    assert_ne!(output.status.code(), Some(0), "{}", words(&output));
    assert!(words(&output).contains("TURNED") || words(&output).contains("inside out"), "{}", words(&output));
}

#[test]
fn numbers_at_vertices_keep_their_name_and_are_no_displacements() {
    let folder = folder();
    let mut cube = solids::blocks([2, 2, 2], 1.0, |_| true);
    cube.scalars = cube.points.iter().map(|p| p.z).collect();
    let quality = write_named(&cube, MeshFormat::Ply, Some("quality"));
    fs::write(folder.path().join("cube.ply"), &quality).unwrap();
    done(folder.path(), "cut cube.ply --plane 0,0,1.5,0,0,1 -o cut.ply");
    let cut = fs::read(folder.path().join("cut.ply")).unwrap();
    assert_eq!(scalar_name(&cut, MeshFormat::Ply).as_deref(), Some("quality"));
    let below = mesh(folder.path(), "cut.ply");
    assert!(below.points.iter().zip(&below.scalars).all(|(p, s)| (p.z - s).abs() < 1e-12));
    let output = surface(folder.path(), "offset cube.ply -d .1 --only-moved -o out.ply").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output).contains("no displacements"), "{}", words(&output));
    let output = surface(folder.path(), "open cube.ply -r .2 -o out.ply").output().unwrap();
    assert!(words(&output).contains("`quality`"), "{}", words(&output));
    assert_eq!(
        scalar_name(&fs::read(folder.path().join("out.ply")).unwrap(), MeshFormat::Ply).unwrap(),
        "displacement"
    );
}

#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    assert!(Command::new("sh").arg("-c").arg(format!("kill -INT {}", child.id())).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn what_is_broken_off_at_work_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    // It takes a hundred times longer than to begin: all of the knot moves, in small triangles.
    let mut child =
        surface(folder.path(), "open - -r .02 -o out.ply").stdin(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(&write(&solids::knot(), MeshFormat::Obj)).unwrap();
    interrupt(&child);
    assert_ne!(child.wait().unwrap().code(), Some(0));
    assert_eq!(names(folder.path()), [""; 0]);
}

#[cfg(unix)]
#[test]
fn what_is_broken_off_while_it_writes_leaves_all_or_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let n = 400u32;
    let profile: Vec<[f64; 2]> =
        (0..=n).map(|k| std::f64::consts::PI * f64::from(k) / f64::from(n)).map(|t| [-t.cos(), t.sin()]).collect();
    fs::write(folder.path().join("ball.ply"), write(&solids::revolved(&profile, n), MeshFormat::Ply)).unwrap();
    let cut = "cut ball.ply --plane .9,0,0,1,0,0 -o out.obj";
    assert!(surface(folder.path(), cut).stderr(Stdio::null()).status().unwrap().success());
    let whole = fs::read(folder.path().join("out.obj")).unwrap();
    let mut seen = 0;
    for _ in 0..3 {
        fs::remove_file(folder.path().join("out.obj")).unwrap_or_default();
        let mut child = surface(folder.path(), cut).stderr(Stdio::null()).spawn().unwrap();
        // As soon as it begins to write, if it can be seen doing so.
        while child.try_wait().unwrap().is_none() && names(folder.path()).len() < 2 {}
        if child.try_wait().unwrap().is_none() {
            interrupt(&child);
            seen += 1;
        }
        child.wait().unwrap();
        let names = names(folder.path());
        assert!(names == ["ball.ply"] || names == ["ball.ply", "out.obj"], "{names:?}");
        assert!(fs::read(folder.path().join("out.obj")).is_ok_and(|bytes| bytes == whole) || names.len() == 1);
    }
    println!("{seen} of 3 were broken off");
}

#[test]
fn readers_that_go_away_are_no_error() {
    let folder = folder();
    for arguments in ["close teeth.obj -r .1", "cut teeth.obj --plane 0,0,.6,0,0,1", "offset teeth.obj -d .01"] {
        let mut child =
            surface(folder.path(), arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // A little of what is too large for the pipe, then nobody reads.
        let mut first = [0; 10];
        child.stdout.take().unwrap().read_exact(&mut first).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
        assert!(!words(&output).contains("panicked"));
    }
}
