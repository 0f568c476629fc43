use super::*;
use crate::mesh::{Repair, Severity, repair};

/// The surface of a box of quads, with corners at 0 and 1, by default outward.
const CUBE: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Adds a cube; turned inside out if it is to be a cavity.
fn add_cube(mesh: &mut PolygonMesh, low: f64, size: f64, inward: bool) {
    let first = mesh.points.len() as u32;
    let at = |k: u32, bit: u32| low + size * f64::from(k >> bit & 1);
    mesh.points.extend((0..8).map(|k| Point::new(at(k, 0), at(k, 1), at(k, 2))));
    for face in CUBE {
        let mut face = face.map(|v| v + first);
        if inward {
            face.reverse();
        }
        mesh.push(&face);
    }
}

fn cube() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    add_cube(&mut mesh, 0.0, 1.0, false);
    mesh
}

fn rebuilt(mesh: &PolygonMesh, change: impl Fn(usize, &mut Vec<u32>)) -> PolygonMesh {
    let mut other = PolygonMesh::new(mesh.points.clone());
    for (k, polygon) in mesh.polygons().enumerate() {
        let mut polygon = polygon.to_vec();
        change(k, &mut polygon);
        if !polygon.is_empty() {
            other.push(&polygon);
        }
    }
    other
}

#[test]
fn a_cube_has_no_problems() {
    assert_eq!(problems(&cube()), []);
    assert!((cube().triangulated().volume() - 1.0).abs() < 1e-15);
    let (same, repairs) = repair(cube());
    assert_eq!((same, repairs), (cube(), vec![]));
}

#[test]
fn what_cannot_be_a_surface_is_named_first() {
    assert_eq!(problems(&PolygonMesh::default()), [Problem::Empty]);
    let mut mesh = cube();
    mesh.push(&[0, 1, 8]);
    mesh.points[3].y = f64::NAN;
    let found = problems(&mesh);
    assert_eq!(found, [Problem::NoSuchVertex { polygon: 6, vertex: 8 }, Problem::NotFinite { vertex: 3 }]);
    assert!(found.iter().all(|p| p.severity() == Severity::Refused));
    let (_, repairs) = repair(mesh);
    assert_eq!(repairs, []);
}

#[test]
fn boundaries_are_counted_and_allowed() {
    let open = rebuilt(&cube(), |k, p| {
        if k < 2 {
            p.clear();
        }
    });
    let expected = [Problem::Boundary { vertex: 0, edges: 4 }, Problem::Boundary { vertex: 4, edges: 4 }];
    assert_eq!(problems(&open), expected);
    assert!(expected.iter().all(|p| p.severity() == Severity::Allowed));
}

#[test]
fn what_is_degenerate_or_there_twice_is_dropped() {
    let mut mesh = cube();
    mesh.push(&[3, 3, 1]);
    mesh.push(&[3, 1, 0, 2]);
    mesh.push(&[0, 1, 0, 2]);
    mesh.points.push(Point::new(0.5, 0.25, 9.0));
    mesh.scalars = (0..9).map(f64::from).collect();
    let expected = [
        Problem::RepeatedCorner { polygon: 6, vertex: 3 },
        Problem::RepeatedCorner { polygon: 8, vertex: 0 },
        Problem::Duplicate { polygon: 7, of: 0 },
        Problem::Unused { vertex: 8 },
    ];
    assert_eq!(problems(&mesh), expected);
    assert!(expected.iter().all(|p| p.severity() == Severity::Repairable));
    let (repaired, repairs) = repair(mesh);
    assert_eq!(
        repairs,
        [
            Repair::DroppedDegenerate { polygon: 6 },
            Repair::DroppedDuplicate { polygon: 7, of: 0 },
            Repair::DroppedDegenerate { polygon: 8 },
            Repair::DroppedVertex { vertex: 8 },
        ]
    );
    let mut with_scalars = cube();
    with_scalars.scalars = (0..8).map(f64::from).collect();
    assert_eq!(repaired, with_scalars);
}

#[test]
fn a_corner_that_follows_itself_is_left_out_of_its_polygon() {
    let mesh = rebuilt(&cube(), |k, p| {
        if k == 3 {
            *p = vec![2, 6, 6, 7, 3, 2];
        }
    });
    assert_eq!(problems(&mesh), [Problem::RepeatedCorner { polygon: 3, vertex: 6 }]);
    let (repaired, repairs) = repair(mesh);
    assert_eq!(repairs, [Repair::DroppedCorner { polygon: 3, vertex: 6 }]);
    assert_eq!(repaired, cube());
}

#[test]
fn the_smaller_part_is_turned_to_agree_with_the_larger_one() {
    let mesh = rebuilt(&cube(), |k, p| {
        if k == 2 || k == 5 {
            p[1..].reverse();
        }
    });
    let found = problems(&mesh);
    assert_eq!(found.len(), 6);
    assert!(found.contains(&Problem::Inconsistent { polygon: 0, neighbour: 2 }));
    assert!(found.iter().all(|p| p.severity() == Severity::Repairable));
    let (repaired, repairs) = repair(mesh);
    assert_eq!(repaired, cube());
    assert_eq!(repairs, [Repair::Reversed { polygon: 2 }, Repair::Reversed { polygon: 5 }]);
    // Of a cube that is all but two faces inside out these two are turned: what was meant is asked, not guessed.
    let inward = rebuilt(&cube(), |k, p| {
        if k != 2 && k != 5 {
            p.reverse();
        }
    });
    let (repaired, _) = repair(inward);
    assert_eq!(problems(&repaired), [Problem::InsideOut { polygon: 0, polygons: 6 }]);
}

#[test]
fn inside_out_is_a_question_and_a_cavity_is_none() {
    let mut mesh = cube();
    add_cube(&mut mesh, 0.25, 0.5, true);
    assert_eq!(problems(&mesh), []);
    add_cube(&mut mesh, 3.0, 0.5, true);
    assert_eq!(problems(&mesh), [Problem::InsideOut { polygon: 12, polygons: 6 }]);
    assert_eq!(problems(&mesh)[0].severity(), Severity::Refused);
    // In the corner of an L it is in its box, but not in it.
    let mut l = PolygonMesh::new(vec![]);
    let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];
    l.points = [0.0, 1.0].iter().flat_map(|&z| outline.map(|p| Point::new(p[0], p[1], z))).collect();
    l.push(&[5, 4, 3, 2, 1, 0]);
    l.push(&[6, 7, 8, 9, 10, 11]);
    (0..6).for_each(|k| l.push(&[k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6]));
    assert_eq!(problems(&l), []);
    add_cube(&mut l, 0.25, 0.5, true);
    assert_eq!(problems(&l), []);
    let mut beside = rebuilt(&l, |k, p| {
        if k >= 8 {
            p.clear();
        }
    });
    beside.points.truncate(12);
    let first = beside.points.len() as u32;
    add_cube(&mut beside, 0.25, 0.5, true);
    for p in &mut beside.points[first as usize..] {
        *p += nalgebra::Vector3::new(2.0, 2.0, 0.0);
    }
    assert_eq!(problems(&beside), [Problem::InsideOut { polygon: 8, polygons: 6 }]);
}

#[test]
fn edges_and_vertices_that_are_no_surface_are_named() {
    let mut fin = cube();
    fin.points.push(Point::new(0.5, 0.5, 3.0));
    fin.push(&[4, 5, 8]);
    let found = problems(&fin);
    assert!(found.contains(&Problem::NonManifoldEdge { a: 4, b: 5, polygons: 3 }), "{found:?}");
    let mut touching = cube();
    add_cube(&mut touching, 1.0, 1.0, false);
    // The second cube takes the last vertex of the first one.
    let touching = rebuilt(&touching, |_, p| p.iter_mut().filter(|v| **v == 8).for_each(|v| *v = 7));
    let found = problems(&touching);
    assert_eq!(found, [Problem::Unused { vertex: 8 }, Problem::NonManifoldVertex { vertex: 7, fans: 2 }]);
    let mut twice = cube();
    twice.push(&[1, 3, 2, 0]);
    assert_eq!(
        problems(&twice),
        [Problem::TurnedDuplicate { polygon: 6, of: 0 }, Problem::Boundary { vertex: 0, edges: 4 }][..1]
    );
}

#[test]
fn a_strip_of_moebius_has_one_side() {
    let n = 12;
    let place = |k: u32, side: f64| {
        let t = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        let r = 3.0 + side * (t / 2.0).cos();
        Point::new(r * t.cos(), r * t.sin(), side * (t / 2.0).sin())
    };
    let mut mesh = PolygonMesh::new((0..n).flat_map(|k| [place(k, -1.0), place(k, 1.0)]).collect());
    for k in 0..n - 1 {
        mesh.push(&[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]);
    }
    mesh.push(&[2 * n - 2, 1, 0, 2 * n - 1]);
    let found = problems(&mesh);
    assert_eq!(found, [Problem::OneSided { polygon: 0 }, Problem::Boundary { vertex: 0, edges: 2 * n }]);
    let (same, repairs) = repair(mesh.clone());
    assert_eq!((same, repairs), (mesh, vec![]));
}

#[test]
fn faces_without_area_go_only_where_no_crack_is_left() {
    let mut mesh = cube();
    mesh.points.extend([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [7.0, 0.0, 0.0]].map(Point::from));
    mesh.push(&[8, 9, 10]);
    let found = problems(&mesh);
    assert!(found.contains(&Problem::ZeroArea { polygon: 6, is_alone: true }), "{found:?}");
    let (repaired, _) = repair(mesh);
    assert_eq!(repaired, cube());
    // A vertex on an edge, with a triangle that fills the gap of no width.
    let mut filled = rebuilt(&cube(), |k, p| {
        if k == 0 {
            *p = vec![0, 2, 3, 8, 1];
        }
    });
    filled.points.push(Point::new(1.0, 0.5, 0.0));
    filled.push(&[1, 8, 3]);
    let found = problems(&filled);
    assert_eq!(found, [Problem::ZeroArea { polygon: 6, is_alone: false }]);
    let (same, repairs) = repair(filled.clone());
    assert_eq!((same, repairs), (filled, vec![]));
}

#[test]
fn surfaces_that_pass_through_each_other_are_named_by_their_polygons() {
    let mut mesh = cube();
    add_cube(&mut mesh, 0.6, 1.0, false);
    let found = problems(&mesh);
    assert!(!found.is_empty());
    for problem in &found {
        let Problem::SelfIntersection { polygon, other } = *problem else { panic!("{problem}") };
        assert!(polygon < 6 && other >= 6);
        assert!(problem.to_string().contains("pass through each other"));
    }
    // The faces that look to each other's corner, each with three of the other cube, but for parallel ones.
    assert_eq!(found.len(), 6);
}

#[test]
fn a_polygon_that_comes_back_to_a_corner_is_tangled_or_has_a_hole() {
    let mut tangled = PolygonMesh::new(vec![Point::origin(); 4]);
    tangled.push(&[1, 0, 2, 0, 3]);
    let found = problems(&tangled);
    assert!(found.contains(&Problem::Tangled { polygon: 0, vertex: 0 }), "{found:?}");
    // A square with a square hole, cut open between the two.
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]];
    let mut ring = PolygonMesh::new(corners.map(|p| Point::new(p[0], p[1], 0.0)).to_vec());
    ring.push(&[0, 1, 2, 3, 0, 4, 7, 6, 5, 4]);
    assert_eq!(problems(&ring), [Problem::Boundary { vertex: 0, edges: 4 }, Problem::Boundary { vertex: 4, edges: 4 }]);
    assert!((ring.triangulated().area() - 8.0).abs() < 1e-12);
}
