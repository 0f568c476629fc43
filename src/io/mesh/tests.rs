//! What all formats must do.

use super::*;
use crate::mesh::Point;

fn message(bytes: impl AsRef<[u8]>, format: MeshFormat) -> String {
    read(bytes.as_ref(), format).unwrap_err().to_string()
}

/// A triangle, a concave quad and a pentagon, with numbers that decimals cannot hold.
fn polygons() -> PolygonMesh {
    let tenth = 0.1f64;
    let mut mesh = PolygonMesh::new(vec![
        Point::new(0.0, -0.0, tenth + 0.2),
        Point::new(1.0 / 3.0, 1e-300, 5e-324),
        Point::new(std::f64::consts::PI, -1e22, f64::MAX),
        Point::new(0.1, 1e-7, 123456789.125),
        Point::new(-2.5, 1e16, 1e15),
        Point::new(f64::MIN_POSITIVE, f64::EPSILON, 1.0 - f64::EPSILON),
    ]);
    mesh.push(&[0, 1, 2]);
    mesh.push(&[5, 4, 1, 0]);
    mesh.push(&[2, 3, 4, 5, 0]);
    mesh
}

fn bits(mesh: &PolygonMesh) -> Vec<u64> {
    mesh.points.iter().flat_map(|p| p.iter().map(|x| x.to_bits()).collect::<Vec<_>>()).collect()
}

#[test]
fn obj_and_ply_give_back_every_bit() {
    let mut mesh = polygons();
    for step in 0..3 {
        if step == 1 {
            mesh.colours = (0..6).map(|k| [43 * k, 255 - k, if k == 0 { 1 } else { 0 }]).collect();
        }
        if step == 2 {
            mesh.scalars = (0..6).map(|k| f64::from(k) / 7.0).collect();
        }
        for format in [MeshFormat::Obj, MeshFormat::Ply] {
            let bytes = write(&mesh, format);
            assert_eq!(MeshFormat::of_bytes(&bytes), format);
            let back = read(&bytes, format).unwrap();
            assert_eq!(bits(&back), bits(&mesh), "{format}");
            assert_eq!(back.polygons().collect::<Vec<_>>(), mesh.polygons().collect::<Vec<_>>());
            assert_eq!(back.colours, mesh.colours);
            assert_eq!(back.scalars, if format == MeshFormat::Ply { mesh.scalars.clone() } else { vec![] });
        }
    }
}

#[test]
fn obj_is_read_in_all_its_ways() {
    let text = "\u{feff}# a comment \\\r\nmtllib C:\\x.mtl\r\no thing\r\nv 1 2 3\r\nv 4 5 6 1.0 # weight\r\n\
                v 7 \\\r\n  8\\\r\n 9\r\n\r\nvn 0 0 1\r\nvt 0 0\r\nf 1/1/1 2//1 3/1\r\nv 1e3 -.5 +2.\r\ns off\r\nl 1 2\r\nf -1 -2 \\\r\n-3 -4\r\n\
                \tf  1 2 5 \r\nv 0 0 0";
    let mesh = read(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(mesh.points.len(), 5);
    assert_eq!(mesh.points[2], Point::new(7.0, 8.0, 9.0));
    assert_eq!(mesh.points[3], Point::new(1000.0, -0.5, 2.0));
    let polygons: Vec<_> = mesh.polygons().collect();
    assert_eq!(polygons, [&[0, 1, 2][..], &[3, 2, 1, 0], &[0, 1, 4]]);
    assert!(mesh.colours.is_empty() && mesh.scalars.is_empty());
    let old = text.replace("\r\n", "\r").replace("# a comment \\", "#");
    assert_eq!(read(old.as_bytes(), MeshFormat::Obj).unwrap(), mesh);
}

#[test]
fn obj_colours_have_two_scales() {
    let fractions = "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(read(fractions.as_bytes(), MeshFormat::Obj).unwrap().colours, [[255, 128, 0], [0, 0, 0], [255; 3]]);
    let bytes = "v 0 0 0 1 200 0\nv 1 0 0 1 0 0 7\nv 0 1 0 1 2 3\nf 1 2 3\n";
    assert_eq!(read(bytes.as_bytes(), MeshFormat::Obj).unwrap().colours, [[1, 200, 0], [0, 0, 7], [1, 2, 3]]);
}

#[test]
fn what_is_wrong_with_an_obj_is_named_by_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let of = |rest: &str| message(format!("{start}{rest}"), MeshFormat::Obj);
    assert!(of("f 1 2 4\nf 1 2 3\n").contains("line 4: a face has the corner 4, but there are 3 vertices"));
    assert!(of("f 1 2 3\nf 1 -4 3\n").contains("line 5: a face has the corner -4"));
    assert!(of("f 0 1 2\n").contains("line 4: a face has the corner 0"));
    assert!(of("f 1 2 99999999999\n").contains("corner 99999999999"));
    assert!(of("f 1 2 99999999999999999999999\n").contains("line 4: \"99999999999999999999999\" stands where"));
    assert!(of("f 1 2\n").contains("line 4: a face has 2 corners, and needs three"));
    assert!(of("f 1 2 x\n").contains("line 4: \"x\" stands where the number of a vertex must be"));
    assert!(of("v 1 nan 2\nf 1 2 3\n").contains("line 4: a coordinate is \"nan\", not a finite number"));
    assert!(of("v 1 1e999 2\nf 1 2 3\n").contains("line 4: a coordinate is \"1e999\""));
    assert!(of("v 1 1,5 2\nf 1 2 3\n").contains("line 4: \"1,5\" stands where a number must be"));
    assert!(of("v 1 2\nf 1 2 3\n").contains("line 4: the end of the line stands where a number must be"));
    assert!(of("f 1 2 3\nv 1 2").contains("line 5: the file breaks off before a number"));
    assert!(of("").contains("no faces (3 vertices)"));
    assert!(of("f 1 2 3\nfacet normal 0 0 1\n").contains("line 5: \"facet\" stands where a statement of an OBJ"));
    assert!(of("f 1 2 3\n0.5 0.5 0.5\n").contains("line 5"));
    assert!(of("f 1 2 3\n\0\0\0\n").contains("line 5"));
    let late = "f 1 2 3\nf 2 3 4\nf 1 2 5\nf 2 3 6\n".to_string() + start + "v 0 0 1\n";
    assert!(message(late, MeshFormat::Obj).contains("line 3: a face has the corner 5, but there are 4 vertices"));
    assert!(message(" \r\n", MeshFormat::Obj).contains("empty"));
}

#[test]
fn files_under_a_wrong_name_are_told() {
    let mesh = polygons();
    for (is, called) in [
        (MeshFormat::Ply, MeshFormat::Obj),
        (MeshFormat::Stl, MeshFormat::Obj),
        (MeshFormat::Obj, MeshFormat::Stl),
        (MeshFormat::Ply, MeshFormat::Stl),
        (MeshFormat::Obj, MeshFormat::Ply),
        (MeshFormat::Stl, MeshFormat::Ply),
    ] {
        let error = message(write(&mesh, is), called);
        let end = is.to_string().to_lowercase();
        assert_eq!(error, format!("the file is called {called} but is {is}: rename it to end with .{end}"));
    }
    assert_eq!(MeshFormat::of_path(Path::new("a/b.OBJ")), Some(MeshFormat::Obj));
    assert_eq!(MeshFormat::of_path(Path::new("a.b/ply")), None);
    assert!(message("<html>", MeshFormat::Obj).contains("line 1"));
    assert!(message("<html>", MeshFormat::Stl).contains("breaks off before the end of the header"));
    assert!(message("<html>", MeshFormat::Ply).contains("\"ply\""));
}

fn tetrahedron() -> PolygonMesh {
    let corners = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 0.1]];
    PolygonMesh::of_triangles(corners.map(Point::from).to_vec(), &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
}

#[test]
fn binary_stl_is_known_by_its_size() {
    let mut bytes = write(&tetrahedron(), MeshFormat::Stl);
    assert_eq!(bytes.len(), 84 + 4 * 50);
    let mesh = read(&bytes, MeshFormat::Stl).unwrap();
    // Coordinates are rounded to f32, nothing else; a vertex has the number of its first corner.
    let in_f32 = |p: &Point| p.map(|x| f64::from(x as f32));
    let old = tetrahedron();
    assert_eq!(mesh.points, [0, 2, 1, 3].map(|k| in_f32(&old.points[k])));
    assert_eq!(mesh.polygons().collect::<Vec<_>>(), [&[0, 1, 2], &[0, 2, 3], &[2, 1, 3], &[0, 3, 1]]);
    bytes[..6].copy_from_slice(b"solid ");
    assert_eq!(read(&bytes, MeshFormat::Stl).unwrap(), mesh);
    assert_eq!(MeshFormat::of_bytes(&bytes), MeshFormat::Stl);
    // What was read is written and read again without a change.
    let again = read(&write(&mesh, MeshFormat::Stl), MeshFormat::Stl).unwrap();
    assert_eq!(again, mesh);
    bytes[84 + 50 + 12 + 4..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(message(&bytes, MeshFormat::Stl).starts_with("byte 146 (triangle 1, counted from 0): a coordinate is NaN"));
    bytes.pop();
    assert!(message(&bytes, MeshFormat::Stl).contains("promises 4 of \"triangle\""));
    bytes.extend([0; 9]);
    assert!(
        message(&bytes, MeshFormat::Stl).contains("byte 284 (triangle 4, counted from 0): the surface is complete")
    );
    let mut none = vec![b' '; 80];
    none.extend([0; 4]);
    assert!(message(&none, MeshFormat::Stl).contains("no faces"));
    none[80..].copy_from_slice(&[255; 4]);
    assert!(message(&none, MeshFormat::Stl).contains("promises 4294967295 of \"triangle\""));
}

const STL: &str = "solid two words\n facet normal nan 0 1\n  outer loop\n   vertex 0 -0 0\n   vertex 1 0 0\n   vertex 0 0.1 0\n\
                   endloop\n endfacet\n FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 1 0 0\n VERTEX 1 1 0\n VERTEX 0 0.1 -0\n ENDLOOP\n\
                   ENDFACET\nendsolid two words\n";

#[test]
fn text_stl_joins_equal_corners_and_no_others() {
    let mesh = read(STL.as_bytes(), MeshFormat::Stl).unwrap();
    assert_eq!(mesh.points.len(), 4);
    assert_eq!(mesh.points[2].y, 0.1);
    assert_eq!(mesh.polygons().collect::<Vec<_>>(), [&[0, 1, 2], &[1, 3, 2]]);
    let near = STL.replace("VERTEX 1 0 0", "VERTEX 1.0000000000000002 0 0");
    assert_eq!(read(near.as_bytes(), MeshFormat::Stl).unwrap().points.len(), 5);
    let two = STL.repeat(2).replace('\n', "\r\n");
    assert_eq!(read(two.as_bytes(), MeshFormat::Stl).unwrap().polygon_count(), 4);
    let of = |from: &str, to: &str| message(STL.replace(from, to), MeshFormat::Stl);
    assert!(of("vertex 1 0 0", "vertex 1 0").contains("line 5: the end of the line stands where a number"));
    assert!(of("vertex 1 0 0", "vertex 1 0 inf").contains("line 5: a coordinate is \"inf\""));
    assert!(of("vertex 1 0 0\n", "\n").contains("line 7: a face has 2 corners"));
    assert!(of(" endfacet", "end").contains("\"end\" stands where \"endfacet\" must be"));
    assert!(of("OUTER", "v 0 0").contains("line 10: \"v\" stands where \"outer\" must be"));
    assert!(of("endsolid two words", "").contains("breaks off before \"endsolid\""));
    assert!(
        message(format!("{STL}ply\n"), MeshFormat::Stl).contains("line 17: \"ply\" stands where \"solid\" must be")
    );
    for end in 6..STL.len() - 20 {
        assert!(read(&STL.as_bytes()[..end], MeshFormat::Stl).is_err(), "cut at {end}");
    }
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement material 1\nproperty list uchar float weights\n\
                   property int id\nelement vertex 4\nproperty float nx\nproperty double x\nproperty double y\nproperty double z\n\
                   property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float quality\n\
                   element face 2\nproperty uchar flag\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
                   end_header\n2 .5 .5 7\n9 0 0 0 1 2 3 4 .5\n9 1 0 0 1 2 3 4 .25\n\n9 1 1 0 255 2 3 4 .5\n9 0 0.1 0 1 2 3 4 -1e3\n\
                   1 3 0 1 2 0\n1 4 3 2 1 0 2 .5 .5\n";

#[test]
fn text_ply_is_read_by_its_header() {
    let mesh = read(PLY.as_bytes(), MeshFormat::Ply).unwrap();
    assert_eq!(mesh.points[3], Point::new(0.0, 0.1, 0.0));
    assert_eq!(mesh.colours, [[1, 2, 3], [1, 2, 3], [255, 2, 3], [1, 2, 3]]);
    assert_eq!(mesh.scalars, [0.5, 0.25, 0.5, -1000.0]);
    assert_eq!(mesh.polygons().collect::<Vec<_>>(), [&[0, 1, 2][..], &[3, 2, 1, 0]]);
    assert_eq!(read(PLY.replace('\n', "\r\n").as_bytes(), MeshFormat::Ply).unwrap(), mesh);
    assert_eq!(read(PLY.trim_end().as_bytes(), MeshFormat::Ply).unwrap(), mesh);
    // Cut off anywhere it is an error, but for the last digits, which are those of another number.
    for end in 4..PLY.len() - 3 {
        assert!(read(&PLY.as_bytes()[..end], MeshFormat::Ply).is_err(), "cut at {end}");
    }
}

#[test]
fn what_is_wrong_with_a_ply_is_named() {
    let of = |from: &str, to: &str| {
        assert!(PLY.contains(from));
        message(PLY.replace(from, to), MeshFormat::Ply)
    };
    assert!(
        of("3 0 1 2 0", "3 0 1 4 0")
            .contains("line 28: a face has the corner 4, but there are 4 vertices, counted from 0")
    );
    assert!(of("3 0 1 2 0", "3 0 1 -1 0").contains("corner -1"));
    assert!(of("3 0 1 2 0", "3 0 1 1.5 0").contains("line 28: 1.5 stands where the number of a vertex must be"));
    assert!(of("3 0 1 2 0", "2 0 1 0").contains("line 28: a face has 2 corners"));
    assert!(of("3 0 1 2 0", "3 0 1 2 0 8").contains("line 28: \"8\" stands where the end of the line must be"));
    assert!(of("3 0 1 2 0", "-3 0 1 2 0").contains("line 28: -3 stands where the length of a list must be"));
    assert!(of("3 0 1 2 0", "4000000000 0 1 2 0").contains("line 28: the file breaks off"));
    assert!(of("9 1 1 0", "9 1 nan 0").contains("line 26: a number is \"nan\""));
    assert!(of("9 1 1 0", "9 1 x 0").contains("line 26: \"x\" stands where a number must be"));
    assert!(of("vertex 4", "vertex 40000000000").contains("line 7: the header promises 40000000000 of \"vertex\""));
    assert!(of("vertex 4", "vertex 99999999999999999999999").contains("line 7"));
    assert!(
        of("material 1", "material 18446744073709551615").contains("promises 18446744073709551615 of \"material\"")
    );
    assert!(of("face 2", "face 3").contains("breaks off before face 3 of 3"));
    assert!(of("face 2", "face 1").contains("line 29: the surface is complete, but something follows"));
    assert!(of("double z", "double w").contains("no properties x, y and z"));
    assert!(of("vertex_indices", "corners").contains("no list \"vertex_indices\""));
    assert!(of("element vertex", "element point").contains("no element \"vertex\""));
    assert!(of("element face 2", "element strip 2").contains("no faces (4 vertices)"));
    assert!(
        of("element face 2", "element vertex 2")
            .contains("line 17: \"vertex\" stands where an element that is not there yet")
    );
    assert!(of("float nx", "real nx").contains("line 8: \"real\" stands where a type"));
    assert!(of("format ascii 1.0", "format text 1.0").contains("line 2: \"text\" stands where ascii"));
    assert!(of("format ascii 1.0\n", "").contains("no line \"format\""));
    assert!(of("end_header\n", "end\n").contains("line 21: \"end\" stands where a line of a PLY header"));
    let empty = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nelement vertex 0\nproperty float x\nproperty float y\n\
                 property float z\nelement face 0\nproperty list uchar int vertex_index\nend_header\n";
    assert!(message(empty, MeshFormat::Ply).contains("no faces (0 vertices)"));
}

/// The text file in binary.
fn binary(is_big: bool) -> Vec<u8> {
    let name = if is_big { "binary_big_endian" } else { "binary_little_endian" };
    let (header, _) = PLY.split_once("end_header\n").unwrap();
    let mut out = header.replace("ascii", name).into_bytes();
    out.extend(b"end_header\n");
    let mut put = |bytes: &[u8]| match is_big {
        true => out.extend(bytes.iter().rev()),
        false => out.extend(bytes),
    };
    put(&[2]);
    put(&0.5f32.to_le_bytes());
    put(&0.5f32.to_le_bytes());
    put(&7i32.to_le_bytes());
    for (p, red, quality) in
        [([0.0, 0.0], 1, 0.5f32), ([1.0, 0.0], 1, 0.25), ([1.0, 1.0], 255, 0.5), ([0.0, 0.1], 1, -1e3)]
    {
        put(&9f32.to_le_bytes());
        [p[0], p[1], 0.0f64].iter().for_each(|x| put(&x.to_le_bytes()));
        [red, 2, 3, 4].iter().for_each(|b| put(&[*b]));
        put(&quality.to_le_bytes());
    }
    for (corners, more) in [(&[0i32, 1, 2][..], 0u8), (&[3, 2, 1, 0], 2)] {
        put(&[1]);
        put(&[corners.len() as u8]);
        corners.iter().for_each(|v| put(&v.to_le_bytes()));
        put(&[more]);
        (0..more).for_each(|_| put(&0.5f32.to_le_bytes()));
    }
    out
}

#[test]
fn binary_ply_says_the_same_as_text() {
    let mesh = read(PLY.as_bytes(), MeshFormat::Ply).unwrap();
    for is_big in [false, true] {
        let bytes = binary(is_big);
        assert_eq!(read(&bytes, MeshFormat::Ply).unwrap(), mesh);
        for end in 0..bytes.len() {
            assert!(read(&bytes[..end], MeshFormat::Ply).is_err(), "cut at {end}");
        }
        let more = [&bytes[..], b"solid"].concat();
        let size = bytes.len();
        assert!(message(more, MeshFormat::Ply).starts_with(&format!("byte {size} (end 1, counted from 0)")));
    }
    let bytes = binary(false);
    let body = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let mut wrong = bytes.clone();
    wrong[body + 13 + 4..][..8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    assert!(message(&wrong, MeshFormat::Ply).contains("(vertex 0, counted from 0): a coordinate is inf"));
    let faces = body + 13 + 4 * 36;
    let mut wrong = bytes.clone();
    wrong[faces + 2..][..4].copy_from_slice(&4i32.to_le_bytes());
    assert!(message(&wrong, MeshFormat::Ply).contains("(face 0, counted from 0): a face has the corner 4"));
    let mut wrong = bytes.clone();
    wrong[faces + 1] = 250;
    assert!(message(&wrong, MeshFormat::Ply).contains("breaks off before face 1 of 2"));
}

#[test]
fn large_polygons_and_float_colours_are_ply_too() {
    let mut mesh = PolygonMesh::new((0..300).map(|k| Point::new(f64::from(k), f64::from(k * k), 0.0)).collect());
    mesh.push(&(0..300).collect::<Vec<_>>());
    assert_eq!(read(&write(&mesh, MeshFormat::Ply), MeshFormat::Ply).unwrap(), mesh);
    let text = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar uint vertex_index\nelement vertex 3\nproperty float x\n\
                property float y\nproperty float z\nproperty float red\nproperty float green\nproperty float blue\nend_header\n\
                3 0 1 2\n0 0 0 0 .5 1\n1 0 0 2 -1 0\n0 1 0 0 0 0\n";
    let mesh = read(text.as_bytes(), MeshFormat::Ply).unwrap();
    assert_eq!(mesh.colours, [[0, 128, 255], [255, 0, 0], [0, 0, 0]]);
    assert_eq!(mesh.polygon(0), [0, 1, 2]);
}

/// Numbers without any order, always the same ones.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % n
    }
}

#[test]
fn damaged_files_are_errors_or_surfaces() {
    let mut mesh = polygons();
    mesh.colours = vec![[1, 2, 3]; 6];
    mesh.scalars = vec![0.5; 6];
    let files = [
        (MeshFormat::Obj, write(&mesh, MeshFormat::Obj)),
        (MeshFormat::Stl, write(&mesh, MeshFormat::Stl)),
        (MeshFormat::Stl, STL.into()),
        (MeshFormat::Ply, write(&mesh, MeshFormat::Ply)),
        (MeshFormat::Ply, PLY.into()),
        (MeshFormat::Ply, binary(true)),
    ];
    let mut random = Random(1);
    let mut good = [0; 2];
    for (format, whole) in &files {
        for _ in 0..3000 {
            let mut bytes = whole.clone();
            if random.below(3) == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            for _ in 0..random.below(4) {
                let (at, byte) = (random.below(whole.len()), random.below(256) as u8);
                match random.below(3) {
                    0 if at < bytes.len() => bytes[at] = byte,
                    1 if at < bytes.len() => bytes[at] ^= 1 << (byte % 8),
                    // A part of it, twice.
                    _ => {
                        let (from, to) = (at.min(bytes.len()), (at + usize::from(byte)).min(bytes.len()));
                        let part = bytes[from..to].to_vec();
                        bytes.splice(from..from, part);
                    }
                }
            }
            for format in [*format, MeshFormat::of_bytes(&bytes)] {
                let Ok(mesh) = read(&bytes, format) else {
                    good[0] += 1;
                    continue;
                };
                good[1] += 1;
                assert!(mesh.polygon_count() > 0);
                assert!(mesh.points.iter().all(|p| p.iter().all(|x| x.is_finite())));
                assert!(mesh.polygons().all(|p| p.len() >= 3 && p.iter().all(|v| (*v as usize) < mesh.points.len())));
                let triangles = mesh.triangulated();
                assert_eq!(triangles.parents.len(), triangles.faces.len());
            }
        }
    }
    assert!(good.iter().all(|n| *n > 1000), "{good:?}");
}

#[test]
fn large_headers_take_no_memory() {
    for kind in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let text = format!(
            "ply\nformat {kind} 1.0\nelement vertex 4294967295\nproperty double x\nproperty double y\nproperty double z\n\
             element face 4294967295\nproperty list uint int vertex_indices\nend_header\n"
        );
        assert!(message(text, MeshFormat::Ply).contains("promises 4294967295 of \"vertex\""));
    }
}
