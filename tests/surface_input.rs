//! Meshes that users and hostile testers have: what `clopen surface` says of them, before the long work and without end.

#[allow(dead_code)]
mod solids;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{Point, PolygonMesh, Vector, problems};
use serde_json::Value;

fn put(folder: &Path, name: &str, mesh: &PolygonMesh) {
    fs::write(folder.join(name), write(mesh, MeshFormat::Obj)).unwrap();
}

fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("clopen"));
    command.current_dir(folder).arg("surface").args(arguments.split_whitespace()).stdin(Stdio::null());
    command
}

fn surface(folder: &Path, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn refused(folder: &Path, arguments: &str, expected: &str) {
    let output = surface(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
    assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
}

fn cube() -> PolygonMesh {
    solids::blocks([1, 1, 1], 4.0, |_| true)
}

fn l() -> PolygonMesh {
    solids::blocks([4, 4, 2], 0.5, |[x, y, _]| x < 2 || y < 2)
}

/// Two meshes as one, the second moved.
fn both(one: &PolygonMesh, other: &PolygonMesh, by: Vector) -> PolygonMesh {
    let mut both = one.clone();
    both.points.extend(other.points.iter().map(|p| p + by));
    for polygon in other.polygons() {
        both.push(&polygon.iter().map(|v| v + one.points.len() as u32).collect::<Vec<_>>());
    }
    both
}

#[test]
fn vertices_without_faces_do_not_count_for_the_size() {
    let folder = tempfile::tempdir().unwrap();
    let mut stray = l();
    stray.points.push(Point::new(1e9, -1e9, 0.0));
    put(folder.path(), "stray.obj", &stray);
    put(folder.path(), "l.obj", &l());
    let radius = |name: &str| {
        let output = surface(folder.path(), &format!("close {name} -r 10% -o out.obj --format json"));
        assert_eq!(output.status.code(), Some(0), "{}", words(&output));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["radius_units"].clone()
    };
    assert_eq!(radius("stray.obj"), radius("l.obj"));
    let out = read(&fs::read(folder.path().join("out.obj")).unwrap(), MeshFormat::Obj).unwrap();
    assert!((out.triangulated().diagonal() - 3.0).abs() < 1e-12);
}

#[test]
fn faces_that_come_back_to_their_corners_without_end_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = cube();
    long.push(&[0, 1, 2, 3].repeat(200_000));
    put(folder.path(), "long.obj", &long);
    for command in [
        "close long.obj -r .1 -o out.obj",
        "cut long.obj --plane 0,0,1,0,0,1 -o out.obj",
        "check long.obj long.obj -r .1",
    ] {
        refused(
            folder.path(),
            command,
            "long.obj: face 6 (counted from 0) has 800000 corners at no more than 4 vertices",
        );
    }
    assert!(!problems(&long).is_empty());
    // Polygons with holes, which come back to some of their corners, are none of these.
    let square = |s: f64| [[-s, -s], [s, -s], [s, s], [-s, s]].map(|[x, y]| Point::new(x, y, 0.0));
    let mut frame = PolygonMesh::new(square(2.0).into_iter().chain(square(1.0)).collect());
    frame.push(&[0, 1, 2, 3, 0, 4, 7, 6, 5, 4]);
    assert_eq!(frame.first_tangled(), None);
}

#[test]
fn what_lies_on_each_other_is_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let side = 4.0;
    for (name, by) in [("same", 0.0), ("beside", side), ("over", 0.5 * side)] {
        put(folder.path(), "two.obj", &both(&cube(), &cube(), Vector::new(by, 0.0, 0.0)));
        for method in ["direct", "volume"] {
            // A small ball, which has nothing to do.
            let output = surface(folder.path(), &format!("close two.obj -r .1 --method {method} -o out.obj"));
            let text = words(&output);
            let first = text.lines().next().unwrap_or_default();
            assert!(
                first.starts_with("note: faces ") && first.contains("unite the bodies first"),
                "{name} {method}: {text}"
            );
            assert_eq!(text.matches("lie on each other").count(), 1, "{name} {method}: {text}");
        }
    }
    // Those that only touch along an edge, or are apart, are not meant.
    for by in [Vector::new(side, side, 0.0), Vector::new(side + 0.5, 0.0, 0.0)] {
        put(folder.path(), "two.obj", &both(&cube(), &cube(), by));
        assert!(
            !words(&surface(folder.path(), "cut two.obj --plane 0,0,1,0,0,1 -o out.obj")).contains("lie on each other")
        );
    }
}

/// Each face with vertices of its own.
fn soup(mesh: &PolygonMesh) -> PolygonMesh {
    let mut soup = PolygonMesh::default();
    for polygon in mesh.polygons() {
        let first = soup.points.len() as u32;
        soup.points.extend(polygon.iter().map(|&v| mesh.points[v as usize]));
        soup.push(&(first..soup.points.len() as u32).collect::<Vec<_>>());
    }
    soup
}

#[test]
fn faces_with_their_own_vertices_are_welded_by_repair() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "soup.obj", &soup(&l()));
    put(folder.path(), "l.obj", &l());
    let twice = soup(&l()).points.len() - l().points.len();
    let text = words(&surface(folder.path(), "close soup.obj -r .3 -o out.obj"));
    assert!(text.starts_with(&format!("note: {twice} vertices on borders lie exactly where others do")), "{text}");
    assert!(text.contains("--repair welds them"), "{text}");
    let output = surface(folder.path(), "close soup.obj -r .3 --repair -o out.obj");
    assert_eq!(output.status.code(), Some(0), "{}", words(&output));
    assert!(words(&output).contains(&format!("{twice} vertices welded to others")), "{}", words(&output));
    assert!(!words(&output).contains("boundary"), "{}", words(&output));
    surface(folder.path(), "close l.obj -r .3 -o whole.obj");
    let volume = |name: &str| {
        read(&fs::read(folder.path().join(name)).unwrap(), MeshFormat::Obj).unwrap().triangulated().volume()
    };
    assert!(
        (volume("out.obj") - volume("whole.obj")).abs() < 1e-3
            && volume("out.obj") > l().triangulated().volume() + 1e-3
    );
    // Closed bodies that touch keep their vertices.
    let (kept, repairs) = clopen::mesh::repair(both(&cube(), &cube(), Vector::new(4.0, 4.0, 0.0)));
    assert_eq!((kept.points.len(), repairs.len()), (16, 0));
}

#[test]
fn what_the_result_does_not_have_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut coloured = cube();
    coloured.colours = vec![[255, 0, 0]; 8];
    let text = String::from_utf8(write(&coloured, MeshFormat::Obj)).unwrap();
    let text = format!("mtllib a.mtl\no thing\nvt 0 0\nvn 0 0 1\nusemtl red\ns off\n{text}");
    fs::write(folder.path().join("cube.obj"), text).unwrap();
    let all = "note: not in the result: texture coordinates, normals, materials, names of objects and groups, smoothing groups";
    for (arguments, expected) in [
        ("close cube.obj -r .1 -o out.obj", format!("{all}, colours of vertices (PLY has them)\n")),
        ("close cube.obj -r .1 -o out.ply", format!("{all}\n")),
        ("cut cube.obj --plane 0,0,1,0,0,1 -o out.obj", format!("{all}\n")),
        ("offset cube.obj -d .1 -o out.stl", format!("{all}, colours of vertices (PLY has them)\n")),
    ] {
        let text = words(&surface(folder.path(), arguments));
        assert!(text.contains(&expected), "{arguments}: {text}");
    }
    put(folder.path(), "plain.obj", &cube());
    assert!(!words(&surface(folder.path(), "close plain.obj -r .1 -o out.obj")).contains("not in the result"));
}

#[test]
fn refusals_name_the_file_or_the_option() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "cube.obj", &cube());
    let mut huge = cube();
    huge.points.iter_mut().for_each(|p| *p = Point::from(p.coords * 1e200));
    put(folder.path(), "huge.obj", &huge);
    refused(
        folder.path(),
        "close cube.obj -r .1 --edge-length 0.000000001 -o out.obj",
        "--edge-length 1e-9: an edge length must be",
    );
    refused(folder.path(), "close huge.obj -r .1 -o out.obj", "huge.obj: the diagonal of its box is");
    refused(folder.path(), "close cube.obj -r 1e300 -o out.obj", "cube.obj: a radius of 1e300 on a mesh");
    // A normal of any length is a direction.
    for normal in ["0,1e300,1e300", "0,1e-300,1e-300"] {
        let output = surface(folder.path(), &format!("cut cube.obj --plane 2,2,2,{normal} -o out.obj"));
        assert_eq!(output.status.code(), Some(0), "{}", words(&output));
        let left = read(&fs::read(folder.path().join("out.obj")).unwrap(), MeshFormat::Obj).unwrap();
        assert!((left.triangulated().volume() - 32.0).abs() < 1e-9);
    }
    // Radii in parts of the diagonal are told with the digits that mean something; and without volume there is no part of it.
    let flat = solids::blocks([1, 1, 1], 4.0, |_| true);
    let mut open = PolygonMesh::new(flat.points.clone());
    open.push(flat.polygon(0));
    put(folder.path(), "open.obj", &open);
    let text = words(&surface(folder.path(), "close open.obj -r 2% -o out.obj"));
    assert!(
        text.starts_with("closing by 0.113137 with edges of 0.0188562: 8 of 8 vertices and 1 of 1 face kept"),
        "{text}"
    );
    assert!(!text.contains("NaN"), "{text}");
}

#[cfg(unix)]
#[test]
fn what_never_ends_is_not_read_to_the_end() {
    let folder = tempfile::tempdir().unwrap();
    refused(folder.path(), "close /dev/zero -r 1 -o out.obj", "/dev/zero: more than 1 GiB");
}

#[test]
fn thousands_of_kinds_of_elements_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let ply = String::from_utf8(
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
          element face 1\nproperty list uchar int vertex_indices\n"
            .to_vec(),
    )
    .unwrap();
    let more: String = (0..200_000).map(|k| format!("element e{k} 0\n")).collect();
    let text = format!("{ply}{more}end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    assert_eq!(read(text.as_bytes(), MeshFormat::Ply).unwrap().polygon_count(), 1);
    let twice = format!("{ply}{more}element face 1\nend_header\n");
    assert!(read(twice.as_bytes(), MeshFormat::Ply).unwrap_err().to_string().contains("not there yet"));
    drop(folder);
}

#[test]
fn where_nothing_could_be_done_the_report_says_so() {
    // Bodies that touch in a face, with a ball as large as a quarter of them: the surface crumples between them.
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "two.obj", &both(&cube(), &cube(), Vector::new(4.0, 0.0, 0.0)));
    let output = surface(folder.path(), "close two.obj -r 1 -o out.obj");
    let text = words(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let out = read(&fs::read(folder.path().join("out.obj")).unwrap(), MeshFormat::Obj).unwrap();
    if out.points.len() == 16 {
        assert!(text.contains("NOTHING was changed"), "{text}");
    }
    assert!(text.lines().any(|line| line.starts_with("method: ")), "{text}");
    assert!(!text.contains("1 places"), "{text}");
}
