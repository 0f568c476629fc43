//! Edits of half-edge meshes, each checked against what a surface is.

use super::*;

/// Whether all that is said twice is said alike.
fn check(mesh: &HalfEdgeMesh) {
    for h in 0..mesh.origin.len() as u32 {
        if mesh.origin(h) == NONE {
            continue;
        }
        if let Some(t) = mesh.twin(h) {
            assert_eq!(mesh.twin(t), Some(h));
            assert_eq!((mesh.origin(t), mesh.target(t)), (mesh.target(h), mesh.origin(h)));
        }
        let [a, b, c] = mesh.face(h / 3);
        assert!(a != b && b != c && c != a);
    }
    for v in 0..mesh.points.len() as u32 {
        let there = mesh.faces().filter(|&f| mesh.face(f).contains(&v)).count();
        assert_eq!(mesh.spokes(v).count(), there, "vertex {v}");
        assert!(mesh.spokes(v).all(|h| mesh.origin(h) == v));
        let mut around: Vec<u32> = mesh.neighbours(v).collect();
        around.sort_unstable();
        let mut expected: Vec<u32> =
            mesh.faces().map(|f| mesh.face(f)).filter(|f| f.contains(&v)).flatten().filter(|&u| u != v).collect();
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(around, expected, "vertex {v}");
    }
}

/// Vertices, edges and faces: V - E + F.
fn euler(mesh: &HalfEdgeMesh) -> i64 {
    let vertices = (0..mesh.points.len() as u32).filter(|&v| mesh.has_vertex(v)).count() as i64;
    let edges = (0..mesh.origin.len() as u32).filter(|&h| mesh.is_edge(h)).count() as i64;
    vertices - edges + mesh.faces().count() as i64
}

fn octahedron() -> HalfEdgeMesh {
    let points =
        [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]].map(Point::from);
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    HalfEdgeMesh::new(points.to_vec(), &faces).unwrap()
}

/// A flat square of n by n cells, with a boundary.
fn sheet(n: u32) -> HalfEdgeMesh {
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| Point::new(f64::from(i), f64::from(j), 0.0))).collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let faces: Vec<[u32; 3]> = cells
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
        .collect();
    HalfEdgeMesh::new(points, &faces).unwrap()
}

#[test]
fn surfaces_know_their_neighbours() {
    let closed = octahedron();
    check(&closed);
    assert_eq!((euler(&closed), closed.neighbours(4).collect::<Vec<_>>()), (2, vec![0, 2, 1, 3]));
    assert!((0..6).all(|v| !closed.is_boundary(v)));
    let open = sheet(3);
    check(&open);
    assert_eq!(euler(&open), 1);
    assert!(open.is_boundary(0) && !open.is_boundary(5));
}

#[test]
fn what_is_no_surface_is_named() {
    let points = vec![Point::origin(); 6];
    let new = |faces: &[[u32; 3]]| HalfEdgeMesh::new(points.clone(), faces).unwrap_err();
    assert_eq!(new(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]), NotManifold::Edge(0, 1));
    assert_eq!(new(&[[0, 1, 2], [0, 1, 3]]), NotManifold::Edge(0, 1));
    assert_eq!(new(&[[0, 1, 2], [0, 3, 4]]), NotManifold::Vertex(0));
    assert_eq!(new(&[[0, 1, 1]]), NotManifold::Face(0));
    assert_eq!(new(&[[0, 1, 6]]), NotManifold::Face(0));
}

#[test]
fn edges_are_split_inside_and_on_the_boundary() {
    for mut mesh in [octahedron(), sheet(2)] {
        let before = euler(&mesh);
        for h in 0..mesh.origin.len() as u32 {
            let p = nalgebra::center(&mesh.points[mesh.origin(h) as usize], &mesh.points[mesh.target(h) as usize]);
            let w = mesh.split(h, p);
            assert_eq!(mesh.target(h), w);
            check(&mesh);
        }
        assert_eq!(euler(&mesh), before);
    }
}

#[test]
fn edges_turn_and_turn_back() {
    for mut mesh in [octahedron(), sheet(3)] {
        let mut turned = 0;
        for h in 0..mesh.origin.len() as u32 {
            if mesh.can_flip(h) {
                let faces = [mesh.face(h / 3), mesh.face(mesh.twin(h).unwrap() / 3)];
                let (c, d) = (mesh.opposite(h), mesh.opposite(mesh.twin(h).unwrap()));
                mesh.flip(h);
                check(&mesh);
                assert!([mesh.origin(h), mesh.target(h)].iter().all(|v| [c, d].contains(v)));
                mesh.flip(h);
                check(&mesh);
                let again = [mesh.face(h / 3), mesh.face(mesh.twin(h).unwrap() / 3)];
                let sorted = |f: [[u32; 3]; 2]| {
                    let mut f = f.map(|mut f| {
                        f.sort_unstable();
                        f
                    });
                    f.sort_unstable();
                    f
                };
                assert_eq!(sorted(faces), sorted(again));
                mesh.flip(h);
                turned += 1;
            }
        }
        check(&mesh);
        assert!(turned > 0);
    }
}

#[test]
fn edges_collapse_as_long_as_a_surface_is_left() {
    for mut mesh in [octahedron(), sheet(4)] {
        for h in 0..mesh.origin.len() as u32 {
            let p = nalgebra::center(&mesh.points[mesh.origin(h) as usize], &mesh.points[mesh.target(h) as usize]);
            mesh.split(h, p);
        }
        let before = euler(&mesh);
        let mut merged = 0;
        for _ in 0..4 {
            for h in 0..mesh.origin.len() as u32 {
                if mesh.origin(h) != NONE && mesh.can_collapse(h) {
                    mesh.collapse(h);
                    check(&mesh);
                    assert_eq!(euler(&mesh), before);
                    merged += 1;
                }
            }
        }
        assert!(merged > 10 && mesh.faces().count() >= 1, "{merged}");
        assert!((0..mesh.origin.len() as u32).all(|h| mesh.origin(h) == NONE || !mesh.can_collapse(h)));
    }
}

#[test]
fn faces_are_replaced_where_that_leaves_a_surface() {
    let mut mesh = octahedron();
    let (count, before) = (mesh.face_count() as u32, euler(&mesh));
    // Two neighbours go, and come back with the other diagonal.
    let t = mesh.twin(0).unwrap();
    let (a, b, c, d) = (mesh.origin(0), mesh.target(0), mesh.opposite(0), mesh.opposite(t));
    let gone = [0, mesh.face_of(t)];
    assert!(mesh.replace(&[], &[[a, b, d]]).is_err(), "a third face at an edge");
    assert!(mesh.replace(&gone, &[[c, b, a], [a, d, b]]).is_err(), "oriented the other way");
    assert_eq!(mesh.face_count() as u32, count, "nothing has changed");
    check(&mesh);
    mesh.replace(&gone, &[[d, c, a], [c, d, b]]).unwrap();
    check(&mesh);
    assert_eq!(euler(&mesh), before);
    assert!(gone.iter().all(|&f| !mesh.has_face(f)) && mesh.has_face(count + 1));
    assert!(mesh.half_edge(c, d).is_some() && mesh.half_edge(a, b).is_none());
    // What goes without anything in its place leaves a boundary.
    mesh.replace(&[count], &[]).unwrap();
    check(&mesh);
    assert!([a, c, d].iter().all(|&v| mesh.is_boundary(v)));
}
