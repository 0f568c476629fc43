//! The whole command `clopen surface`: from a mesh to a mesh, a picture, a report and an exit status.

#[allow(dead_code)]
mod solids;

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{Point, PolygonMesh, Vector, self_intersections};
use serde_json::Value;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, mesh) in [("bracket", solids::bracket()), ("capsule", solids::capsule()), ("figure", solids::figure())] {
        fs::write(folder.path().join(format!("{name}.obj")), write(&mesh, MeshFormat::Obj)).unwrap();
    }
    folder
}

fn surface(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder).arg("surface").args(arguments.split_whitespace()).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn done(folder: &Path, arguments: &str) -> Output {
    let output = surface(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    output
}

fn mesh(folder: &Path, name: &str) -> PolygonMesh {
    let format = MeshFormat::of_path(Path::new(name)).unwrap();
    read(&fs::read(folder.join(name)).unwrap(), format).unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_mesh_is_closed_with_a_picture_and_a_report() {
    let folder = folder();
    let output = done(folder.path(), "close bracket.obj -r .3 -o out.obj --preview out.png --format json");
    let report = json(&output);
    let [kept, all] = ["faces_kept", "faces_in"].map(|k| report[k].as_u64().unwrap());
    assert!(kept > all / 2 && kept < all, "{kept} of {all}");
    assert_eq!(report["conflicts"].as_array().unwrap().len(), 0);
    // Quads that did not change are quads, with their corners, and stand first in their order.
    let (before, after) = (mesh(folder.path(), "bracket.obj"), mesh(folder.path(), "out.obj"));
    let corners = |m: &PolygonMesh, k: usize| m.polygon(k).iter().map(|&v| m.points[v as usize]).collect::<Vec<_>>();
    let mut from = 0;
    for k in 0..kept as usize {
        let face = corners(&after, k);
        from = (from..before.polygon_count()).find(|&j| corners(&before, j) == face).expect("a face of the input") + 1;
    }
    let picture = tiny_skia::Pixmap::decode_png(&fs::read(folder.path().join("out.png")).unwrap()).unwrap();
    assert!(picture.width() > 100);
    let checked = json(&done(folder.path(), "check bracket.obj out.obj -r .3 --format json"));
    assert!(checked["contact"]["largest_over_h"].as_f64().unwrap() < 0.6, "{checked}");
    // Quads count as they do in the file.
    assert_eq!(report["faces_out"].as_u64().unwrap() as usize, after.polygon_count());
}

#[test]
fn a_check_counts_what_was_left_undone() {
    let folder = folder();
    fs::copy(folder.path().join("bracket.obj"), folder.path().join("same.obj")).unwrap();
    let output = surface(folder.path(), "check bracket.obj same.obj -r .3");
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    // The middle of the concave edge is (√2 - 1) r below the fillet, and h is a sixth of r.
    let line = text.lines().find(|l| l.starts_with("left undone where nothing moved")).unwrap();
    assert!(line.contains("at most 2.485 h at (0.8000, 0.8000, "), "{line}");
    assert!(text.lines().last().unwrap().starts_with("FAILED: something was left undone"), "{text}");
    assert!(!text.contains(['{', '"']), "a person reads this: {text}");
    done(folder.path(), "check bracket.obj same.obj -r .3 --moved-only");
    done(folder.path(), "check capsule.obj capsule.obj -r .1");
    // What a pin holds is left on purpose; near it, where the radius eases, the full ball still finds that what moved is off.
    done(folder.path(), "close bracket.obj -r .3 --pin-box 0,0,-1,9,9,1.5 -o out.obj");
    let last = |arguments: &str| {
        let text = String::from_utf8(surface(folder.path(), arguments).stdout).unwrap();
        text.lines().last().unwrap().to_owned()
    };
    assert!(last("check bracket.obj out.obj -r .3").contains("left undone"));
    assert!(!last("check bracket.obj out.obj -r .3 --moved-only").contains("left undone"));
}

/// A cube of six faces.
fn cube() -> PolygonMesh {
    solids::blocks([1, 1, 1], 10.0, |_| true)
}

#[test]
fn where_nothing_is_left_nothing_is_written() {
    let folder = folder();
    fs::write(folder.path().join("cube.obj"), write(&cube(), MeshFormat::Obj)).unwrap();
    for command in ["open", "clopen --order open-close"] {
        let output = surface(folder.path(), &format!("{command} cube.obj -r 5.5 -o out.obj --preview out.png"));
        assert_eq!(output.status.code(), Some(1), "{}", words(&output));
        assert!(words(&output).contains("NOTHING is left"), "{}", words(&output));
        assert!(!folder.path().join("out.obj").exists() && !folder.path().join("out.png").exists());
    }
}

#[test]
fn regions_are_held_against_the_surface_and_not_its_vertices() {
    let folder = folder();
    fs::write(folder.path().join("cube.obj"), write(&cube(), MeshFormat::Obj)).unwrap();
    // Two opposite vertices are in no box, the first is in one: the other boxes lie on faces and edges.
    done(folder.path(), "open cube.obj -r 1 --only-box -1,-1,-1,4,4,4 --only-box 3,-1,-1,4,2.5,2.5 -o out.obj");
    let points = mesh(folder.path(), "out.obj").points;
    assert_eq!(cube().points.iter().filter(|p| points.contains(p)).count(), 7);
    for (region, expected) in [("3,3,3,4,4,4", "holds nothing of the surface"), ("3,-1,-1,4,2.5,2.5", "but no vertex")]
    {
        let output = surface(folder.path(), &format!("open cube.obj -r 1 --only-box {region} -o no.obj"));
        assert_eq!(output.status.code(), Some(2));
        assert!(words(&output).contains(expected), "{}", words(&output));
    }
}

#[test]
fn reports_speak_of_what_was_done() {
    let folder = folder();
    let varying = "close bracket.obj -r .3 --method direct --radius-from 0,0,0=.2 --radius-to 2,0,0=.25 -o out.obj";
    let output = surface(folder.path(), varying);
    assert!(words(&output).starts_with("closing by 0.2 to 0.25 with"), "{}", words(&output));
    // Bodies that overlap, with faces that are there twice.
    let mut two = cube();
    let first = two.points.len() as u32;
    two.points.extend(cube().points.iter().map(|p| p + Vector::new(5.0, 5.1, 5.2)));
    for polygon in cube().polygons() {
        two.push(&polygon.iter().map(|v| v + first).collect::<Vec<_>>());
    }
    two.push(cube().polygon(2));
    fs::write(folder.path().join("two.obj"), write(&two, MeshFormat::Obj)).unwrap();
    let output = surface(folder.path(), "cut two.obj --plane 0,0,1,0,0,1 --repair -o out.obj");
    for expected in ["repaired: 1 duplicate face left out (face 12)", "unite them first"] {
        assert!(words(&output).contains(expected), "{expected}: {}", words(&output));
    }
}

#[test]
fn what_is_convex_comes_back_as_it_was() {
    let folder = folder();
    for format in ["obj", "ply"] {
        done(folder.path(), &format!("close capsule.obj -r .2 -o out.{format}"));
        let (before, after) = (mesh(folder.path(), "capsule.obj"), mesh(folder.path(), &format!("out.{format}")));
        assert_eq!(before.points, after.points);
        assert!(before.polygons().eq(after.polygons()));
    }
}

#[test]
fn opening_is_closing_of_what_is_empty() {
    let folder = folder();
    let mut inside_out = PolygonMesh::new(solids::bracket().points);
    for polygon in solids::bracket().polygons() {
        inside_out.push(&polygon.iter().rev().copied().collect::<Vec<_>>());
    }
    fs::write(folder.path().join("empty.obj"), write(&inside_out, MeshFormat::Obj)).unwrap();
    let refused = surface(folder.path(), "close empty.obj -r .2 -o out.obj");
    assert_eq!(refused.status.code(), Some(2));
    assert!(words(&refused).contains("inside out"), "{}", words(&refused));
    done(folder.path(), "open bracket.obj -r .2 -o out.obj");
    assert!(mesh(folder.path(), "out.obj").triangulated().volume() < solids::bracket().triangulated().volume());
}

#[test]
fn ply_tells_what_moved_and_how_far() {
    let folder = folder();
    done(folder.path(), "close bracket.obj -r .3 -o out.ply");
    let after = mesh(folder.path(), "out.ply");
    assert_eq!((after.colours.len(), after.scalars.len()), (after.points.len(), after.points.len()));
    let farthest = after.scalars.iter().copied().fold(0.0, f64::max);
    assert!((farthest - 0.3 * (2f64.sqrt() - 1.0)).abs() < 0.05, "{farthest}");
    assert!(after.scalars.contains(&0.0));
}

#[test]
fn radii_vary_and_pins_hold() {
    let folder = folder();
    done(folder.path(), "close bracket.obj -r .3 --pin-box -1,-1,-1,4,4,1.5 -o out.obj");
    let after = mesh(folder.path(), "out.obj");
    let fillet = |z: &dyn Fn(f64) -> bool| {
        after.points.iter().any(|p| z(p.z) && p.x > 0.81 && p.y > 0.81 && p.x < 1.05 && p.y < 1.05)
    };
    assert!(!fillet(&|z| z < 0.5) && fillet(&|z| z > 0.8));
    done(folder.path(), "close bracket.obj -r .3 --radius-from 0,0,0=.15 --radius-to 0,0,1=.35 -o vary.obj");
    let vary = mesh(folder.path(), "vary.obj");
    let depth = |z: f64| {
        let near = vary
            .points
            .iter()
            .filter(|p| (p.z - z).abs() < 0.06 && (p.x - p.y).abs() < 0.03 && p.x > 0.79 && p.x < 1.3);
        near.map(|p| (p.x - 0.8).hypot(p.y - 0.8)).fold(0.0, f64::max)
    };
    assert!(depth(0.75) > 1.2 * depth(0.25), "{} {}", depth(0.75), depth(0.25));
}

#[test]
fn bad_input_is_one_sentence_and_exit_two() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("empty.obj", "");
    write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    write("three.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    write("cut.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n");
    for (arguments, expected) in [
        ("close empty.obj -r 1 -o out.obj", "empty.obj"),
        ("close nan.obj -r 1 -o out.obj", "line 2"),
        ("close range.obj -r 1 -o out.obj", "line 4"),
        ("close three.obj -r 1 -o out.obj", "edge"),
        ("close cut.stl -r 1 -o out.obj", "cut.stl"),
        ("close absent.obj -r 1 -o out.obj", "absent.obj"),
        ("close bracket.obj -r 1e9 -o out.obj", "radius"),
        ("close bracket.obj -r 1e-9 -o out.obj", "radius"),
        ("close bracket.obj -r .0001 -o out.obj", "a radius of 0.0001 is too small"),
        (
            "close bracket.obj -r .3 --bound none -o out.obj",
            "--bound means something to a flow only: add --method flow",
        ),
        ("open bracket.obj -r .3 --method direct --time-step 1 -o out.obj", "--time-step"),
        ("close bracket.obj -r .3 --contacts near -o out.obj", "--contacts"),
        ("close bracket.obj -r .3 --on-contact stop -o out.obj", "--on-contact"),
        ("close bracket.obj -r .3 --curvature mean -o out.obj", "--curvature"),
        ("close bracket.obj -r .3 --time .1 -o out.obj", "--time"),
        ("close bracket.obj -r .3 -o out.obj --preview ./out.obj", "two results"),
        ("close bracket.obj -r .3 -o out.obj --preview out.jpg", "out.png"),
        ("close bracket.obj -r .3 -o out.obj --preview bracket.obj", "bracket.obj"),
        ("close bracket.obj -r .3 --preview -", "standard output"),
        ("close bracket.obj -r .3 --edge-length 1e-9 -o out.obj", "edge length"),
        ("close bracket.obj -r 0 -o out.obj", "above zero"),
        ("close bracket.obj -r .3 -o out.xyz", ".obj, .stl or .ply"),
        ("close bracket.obj -r .3 -o bracket.obj", "bracket.obj"),
        ("close bracket.obj -r .3 --pin-ball 99,0,0,1 -o out.obj", "holds nothing of the surface"),
        ("close bracket.obj -r .3 --radius-by-vertex -o out.obj", "radius-by-vertex"),
        ("close bracket.obj -r .3 --format json", "-o OUT.obj"),
    ] {
        let output = surface(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
        assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
        assert!(!folder.path().join("out.obj").exists(), "{arguments}");
    }
}

#[test]
fn a_flow_shows_its_states_and_comes_to_the_same_limit() {
    let folder = folder();
    let report = json(&done(folder.path(), "close bracket.obj -r .3 --method flow -o limit.obj --format json"));
    assert!(["still", "slow"].contains(&report["flow"]["end"].as_str().unwrap()), "{report}");
    done(folder.path(), "close bracket.obj -r .3 -o direct.obj");
    let volume = |name: &str| mesh(folder.path(), name).triangulated().volume();
    let start = volume("bracket.obj");
    let (flow, direct) = (volume("limit.obj") - start, volume("direct.obj") - start);
    assert!((flow - direct).abs() < 0.1 * direct, "{flow} {direct}");
    done(folder.path(), "close bracket.obj -r .3 --method flow --time .2 --frames 3 -o state.obj");
    let states = ["state-01.obj", "state-02.obj", "state-03.obj"].map(|name| volume(name) - start);
    assert!(0.0 < states[0] && states[0] < states[1] && states[1] < states[2] && states[2] < 1.02 * flow, "{states:?}");
    assert!(!folder.path().join("state.obj").exists());
    let output = surface(folder.path(), "close bracket.obj -r .3 --method flow --bound none -o none.obj");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn an_ellipsoid_is_a_ball_on_a_squeezed_mesh() {
    let folder = folder();
    // Along the concave edge it is as good as the ball: the fillet is the same where the ends are far.
    done(folder.path(), "close bracket.obj -r .3 --stretch 1,2,1 -o out.obj");
    let (before, after) = (mesh(folder.path(), "bracket.obj"), mesh(folder.path(), "out.obj"));
    let new = after.points.iter().filter(|p| !before.points.contains(p) && p.z > 0.3 && p.z < 0.7);
    let on_fillet: Vec<f64> =
        new.filter(|p| p.x > 0.81 && p.y > 0.81).map(|p| ((p.x - 1.1) / 0.3).hypot((p.y - 1.4) / 0.6) - 1.0).collect();
    assert!(on_fillet.len() > 10);
    assert!(on_fillet.iter().all(|off| off.abs() < 1e-3), "{on_fillet:?}");
    let kept = after.points.iter().filter(|p| before.points.contains(p)).count();
    assert!(kept > before.points.len() / 2);
    assert_eq!(surface(folder.path(), "close bracket.obj -r .3 --stretch 1,0,1 -o out.obj").status.code(), Some(2));
}

#[test]
fn meshes_have_pictures() {
    let folder = folder();
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder.path()).args(["preview", "figure.obj", "-o", "figure.png", "--size", "300"]);
    assert_eq!(command.output().unwrap().status.code(), Some(0));
    let picture = tiny_skia::Pixmap::decode_png(&fs::read(folder.path().join("figure.png")).unwrap()).unwrap();
    assert_eq!(picture.width().max(picture.height()), 300);
    // From standard input each format is recognized.
    let figure = mesh(folder.path(), "figure.obj");
    for format in [MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Ply] {
        let mut command = Command::cargo_bin("clopen").unwrap();
        command.current_dir(folder.path()).args(["preview", "-", "-o", "in.png", "--size", "300"]);
        let output = command.write_stdin(write(&figure, format)).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{format}: {}", words(&output));
        assert_eq!(tiny_skia::Pixmap::load_png(folder.path().join("in.png")).unwrap().width(), picture.width());
    }
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder.path()).args(["preview", "figure.obj", "-o", "figure.svg"]);
    assert_eq!(command.output().unwrap().status.code(), Some(2));
}

#[test]
fn the_volumetric_method_is_there_for_comparison() {
    let folder = folder();
    let report = json(&done(folder.path(), "close bracket.obj -r .3 --method volume -o out.obj --format json"));
    assert_eq!(report["vertices_kept"], 0);
    assert!(report["volume_out"].as_f64().unwrap() > report["volume_in"].as_f64().unwrap());
}

/// The bracket, and a small box that hovers where its fillet will be.
fn bracket_and_box() -> PolygonMesh {
    let mut mesh = solids::bracket();
    let hover = solids::blocks([1, 1, 2], 0.04, |_| true);
    let first = mesh.points.len() as u32;
    mesh.points.extend(hover.points.iter().map(|p| p + Vector::new(0.84, 0.84, 0.46)));
    for polygon in hover.polygons() {
        mesh.push(&polygon.iter().map(|v| v + first).collect::<Vec<_>>());
    }
    mesh
}

#[test]
fn frozen_surfaces_never_pass_through_themselves() {
    let folder = folder();
    fs::write(folder.path().join("meet.obj"), write(&bracket_and_box(), MeshFormat::Obj)).unwrap();
    let run = |on_contact: &str| {
        let arguments = format!(
            "close meet.obj -r .3 --method flow --contacts near --on-contact {on_contact} -o out.obj --format json"
        );
        let output = surface(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(1), "{}", words(&output));
        let crossings = self_intersections(&mesh(folder.path(), "out.obj").triangulated()).len();
        (crossings, json(&output)["flow"]["contacts"].as_array().unwrap().clone())
    };
    assert!(self_intersections(&bracket_and_box().triangulated()).is_empty());
    let (stopped, _) = run("stop");
    assert!(stopped > 0, "they do meet");
    let (crossings, places) = run("freeze");
    assert_eq!(crossings, 0);
    assert!(!places.is_empty());
    for place in places {
        let [x, y, z] = [0, 1, 2].map(|k| place[k].as_f64().unwrap());
        let away = |p: f64, low: f64, high: f64| (low - p).max(p - high).max(0.0);
        let distance = away(x, 0.84, 0.88).hypot(away(y, 0.84, 0.88)).hypot(away(z, 0.46, 0.54));
        assert!(distance < 0.1, "{place} is {distance} from where they meet");
    }
}

#[test]
fn what_no_method_can_do_is_told_and_what_one_can_is_done() {
    let folder = folder();
    // A small prism of few faces that hovers over a large one: rims that stay lie far apart across the gap.
    let prism = |[x, y, z]: [f64; 3], side: f64, height: f64| {
        let base = [[0.0, 0.0], [side, 0.0], [side / 2.0, 0.866 * side]];
        [z, z + height].into_iter().flat_map(move |z| base.map(|[a, b]| Point::new(x + a, y + b, z)))
    };
    let mut meet = PolygonMesh::default();
    for (first, points) in [(0, prism([0.0; 3], 1.0, 0.3)), (6, prism([0.45, 0.25, 0.39], 0.1, 0.3))] {
        meet.points.extend(points);
        for face in [[2, 1, 0].as_slice(), &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]] {
            meet.push(&face.iter().map(|v| v + first).collect::<Vec<u32>>());
        }
    }
    fs::write(folder.path().join("meet.obj"), write(&meet, MeshFormat::Obj)).unwrap();
    let output = surface(folder.path(), "close meet.obj -r .05 -o out.obj --format json");
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    let report = json(&output);
    assert!(!report["conflicts"].as_array().unwrap().is_empty());
    let choice = &report["choices"][0];
    assert!(choice["because"].as_str().unwrap().contains("farther than"), "{choice}");
    assert!(self_intersections(&mesh(folder.path(), "out.obj").triangulated()).is_empty());
    // A plate with a tunnel that the ball cannot pass: its closing has no tunnel. A surface that flows always has one.
    let plate = solids::blocks([9, 9, 4], 0.1, |[x, y, _]| x != 4 || y != 4);
    fs::write(folder.path().join("plate.obj"), write(&plate, MeshFormat::Obj)).unwrap();
    let report = json(&done(folder.path(), "close plate.obj -r .2 -o out.obj --format json"));
    assert_eq!(report["choices"][0]["used"], "direct");
    assert!(self_intersections(&mesh(folder.path(), "out.obj").triangulated()).is_empty());
    let report = json(&done(folder.path(), "close bracket.obj -r .3 -o out.obj --format json"));
    assert_eq!(report["choices"][0]["used"], "direct");
}

#[test]
fn a_flow_lands_on_the_ball_unless_told_to_end_by_curvature() {
    let folder = folder();
    let report =
        json(&done(folder.path(), "close bracket.obj -r .3 --method flow --edge-length .05 -o out.obj --format json"));
    let error = report["largest_error_edge_lengths"].as_f64().unwrap();
    assert!(error < 0.5, "{report}");
    let near = "close bracket.obj -r .3 --method flow --edge-length .05 --contacts near -o near.obj --format json";
    assert!(json(&surface(folder.path(), near))["largest_error_edge_lengths"].is_null());
    let output = surface(folder.path(), "clopen bracket.obj -r .3 --method flow --contacts all -o out.obj");
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output).contains("--contacts near"), "{}", words(&output));
}
