//! Blocks, tubes and what touches the plane.

use super::*;
use crate::mesh::{HalfEdgeMesh, TriangleMesh, problems};

/// The surface of the cubes of side 1 for which `is_solid` holds, as quads that share vertices; cubes meet in faces only.
fn blocks(size: i32, is_solid: impl Fn([i32; 3]) -> bool) -> PolygonMesh {
    let inside = |c: [i32; 3]| c.iter().all(|x| (0..size).contains(x)) && is_solid(c);
    let mut numbers: HashMap<[i32; 3], u32> = HashMap::new();
    let mut mesh = PolygonMesh::default();
    let cells = (0..size).flat_map(|z| (0..size).flat_map(move |y| (0..size).map(move |x| [x, y, z])));
    for cell in cells.filter(|c| inside(*c)) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beside = cell;
            beside[axis] += 2 * side - 1;
            if inside(beside) {
                continue;
            }
            let mut around = [[0, 0], [1, 0], [1, 1], [0, 1]];
            if side == 0 {
                around.reverse();
            }
            let quad = around.map(|[i, j]| {
                let mut corner = cell;
                corner[axis] += side;
                corner[(axis + 1) % 3] += i;
                corner[(axis + 2) % 3] += j;
                *numbers.entry(corner).or_insert_with(|| {
                    mesh.points.push(Point::from(corner.map(f64::from)));
                    mesh.points.len() as u32 - 1
                })
            });
            mesh.push(&quad);
        }
    }
    mesh
}

fn plane(point: [f64; 3], normal: [f64; 3]) -> CutPlane {
    CutPlane::new(point.into(), normal.into()).unwrap()
}

/// What must hold of any cut of a closed surface.
fn closed(input: &PolygonMesh, plane: &CutPlane) -> TriangleMesh {
    let left = cut(input, plane, Cap::Closed).unwrap();
    assert_eq!(left.open_ends, 0);
    assert_eq!(problems(&left.mesh), []);
    let origins: Vec<u32> = left.origins.iter().copied().filter(|&v| v != NONE).collect();
    assert!(origins.is_sorted());
    for (p, &v) in left.mesh.points.iter().zip(&left.origins) {
        assert!(plane.height(*p) < 1e-9);
        assert!(v == NONE || *p == input.points[v as usize]);
    }
    // What was not cut comes first, in its order.
    let behind = |p: &&[u32]| p.iter().all(|&v| plane.height(input.points[v as usize]) < -1e-9);
    let corners = |p: &[u32]| p.iter().map(|&v| left.origins[v as usize]).collect::<Vec<_>>();
    let kept: Vec<Vec<u32>> = left.mesh.polygons().take(left.kept).map(corners).collect();
    let mut from = 0;
    for polygon in input.polygons().filter(behind) {
        from += kept[from..].iter().position(|k| k == polygon).unwrap() + 1;
    }
    let triangles = left.mesh.triangulated();
    let mesh = HalfEdgeMesh::new(triangles.points.clone(), &triangles.faces).unwrap();
    assert!((0..mesh.points.len() as u32).all(|v| !mesh.is_boundary(v)));
    triangles
}

/// A frame: a square ring of four by four, one high, with a hole of two by two.
fn frame() -> PolygonMesh {
    blocks(4, |[x, y, z]| z == 0 && !((1..3).contains(&x) && (1..3).contains(&y)))
}

#[test]
fn both_halves_make_the_whole() {
    let shapes = [blocks(3, |_| true), frame(), blocks(4, |[x, y, z]| x == 0 || y == 0 || z == 0)];
    let planes = [
        ([0.0, 0.0, 0.4], [0.0, 0.0, 1.0]),
        ([1.3, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.5, 1.5, 0.5], [1.0, 2.0, 3.0]),
        ([1.5, 1.5, 0.5], [-1.0, 0.3, 0.1]),
    ];
    for shape in &shapes {
        for (p, n) in planes {
            let whole = shape.triangulated().volume();
            let halves = [n, n.map(|x| -x)].map(|n| closed(shape, &plane(p, n)).volume());
            assert!((halves[0] + halves[1] - whole).abs() < 1e-9 * whole, "{halves:?} {whole}");
            assert!(halves[0] > 0.0 && halves[1] > 0.0);
        }
    }
}

#[test]
fn caps_have_holes_and_islands() {
    // The frame cut flat: one loop with a hole in it.
    let half = closed(&frame(), &plane([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]));
    assert!((half.volume() - 6.0).abs() < 1e-12);
    // A hollow box with a box in it.
    let nested = blocks(7, |c| c.iter().any(|x| [0, 6].contains(x)) || c.iter().all(|x| (2..5).contains(x)));
    let half = closed(&nested, &plane([0.0, 0.0, 3.5], [0.0, 0.0, 1.0]));
    assert!((half.volume() - (49.0 + 2.5 * 24.0 + 9.0 * 1.5)).abs() < 1e-9, "{}", half.volume());
    // Many holes in a plate.
    let sieve = blocks(9, |[x, y, z]| z == 0 && !(x % 2 == 1 && y % 2 == 1));
    let half = closed(&sieve, &plane([0.0, 0.0, 0.25], [0.0, 0.0, 1.0]));
    assert!((half.volume() - 0.25 * 65.0).abs() < 1e-9);
    // In any direction.
    let tilted = plane([4.5, 4.5, 0.5], [0.02, -0.03, 1.0]);
    let turned = plane([4.5, 4.5, 0.5], [-0.02, 0.03, -1.0]);
    let halves = closed(&sieve, &tilted).volume() + closed(&sieve, &turned).volume();
    assert!((halves - 65.0).abs() < 1e-9, "{halves}");
}

#[test]
fn planes_through_vertices_edges_and_faces_cut_clean() {
    let stairs = blocks(3, |[x, _, z]| x + z < 3);
    for k in 1..3 {
        let z = f64::from(k);
        let left = closed(&stairs, &plane([0.0, 0.0, z], [0.0, 0.0, 1.0]));
        assert!((left.volume() - [9.0, 15.0][k as usize - 1]).abs() < 1e-12);
        assert!(left.points.iter().all(|p| p.iter().all(|x| x.fract() == 0.0)), "no vertex is new");
        let left = closed(&stairs, &plane([0.0, 0.0, z], [0.0, 0.0, -1.0]));
        assert!((left.volume() - [9.0, 3.0][k as usize - 1]).abs() < 1e-12);
    }
    // Along the diagonals of the steps, which is an edge of them.
    let left = closed(&stairs, &plane([3.0, 0.0, 0.0], [1.0, 0.0, 1.0]));
    assert!((left.volume() - 13.5).abs() < 1e-12);
    // The top alone touches: nothing is cut.
    let all = cut(&stairs, &plane([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]), Cap::Closed).unwrap();
    assert_eq!((all.mesh, all.caps), (stairs, 0));
}

#[test]
fn what_touches_in_a_corner_becomes_two_vertices() {
    // Legs that are joined on the side that is cut off, and a tower that stands on what is left.
    let arch = blocks(3, |[x, y, z]| y == 0 && (z > 0 || x != 1));
    let left = closed(&arch, &plane([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]));
    assert!((left.volume() - 2.0).abs() < 1e-12);
    let towers = blocks(2, |[x, y, z]| z == 0 || (x == 0 && y == 0));
    let left = closed(&towers, &plane([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]));
    assert!((left.volume() - 1.0).abs() < 1e-12);
    // A saddle with its ends at the top: they touch the plane from behind.
    let mut saddle = PolygonMesh::new(
        [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, -1.0], [0.0, -1.0, -1.0], [0.0, 0.0, -3.0], [0.0, 0.0, -0.5]]
            .map(Point::from)
            .to_vec(),
    );
    for [a, b, c] in [[0, 5, 2], [0, 3, 5], [1, 2, 5], [1, 5, 3], [0, 2, 4], [3, 0, 4], [2, 1, 4], [1, 3, 4]] {
        saddle.push(&[a, b, c]);
    }
    let saddle_volume = saddle.triangulated().volume();
    assert!(saddle_volume > 0.0);
    let left = cut(&saddle, &plane([0.0; 3], [0.0, 0.0, 1.0]), Cap::Closed).unwrap();
    assert_eq!((left.mesh, left.caps), (saddle.clone(), 0));
    // Through its middle the section is two triangles with a corner in common.
    let halves = [1.0, -1.0].map(|n| closed(&saddle, &plane([0.0, 0.0, -0.5], [0.0, 0.0, n])).volume());
    assert!((halves[0] + halves[1] - saddle_volume).abs() < 1e-12);
}

#[test]
fn an_open_cut_and_an_open_surface_stay_open() {
    let cube = blocks(2, |_| true);
    let left = cut(&cube, &plane([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]), Cap::Open).unwrap();
    assert_eq!((left.caps, left.kept), (0, 4));
    assert!((left.mesh.triangulated().area() - 8.0).abs() < 1e-12);
    // A cube without its front: the cut is a piece with two ends, and a cap would have no border there.
    let mut open = PolygonMesh::new(cube.points.clone());
    cube.polygons().filter(|p| p.iter().any(|&v| cube.points[v as usize].x > 0.0)).for_each(|p| open.push(p));
    let left = cut(&open, &plane([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]), Cap::Closed).unwrap();
    assert_eq!((left.caps, left.open_ends), (0, 1));
    let beside = cut(&open, &plane([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]), Cap::Closed).unwrap();
    assert_eq!((beside.caps, beside.open_ends), (0, 1));
}

#[test]
fn colours_and_numbers_are_those_between_the_ends() {
    let mut cube = blocks(1, |_| true);
    cube.colours = cube.points.iter().map(|p| if p.z > 0.5 { [200, 0, 0] } else { [0, 100, 0] }).collect();
    cube.scalars = cube.points.iter().map(|p| p.z).collect();
    let left = cut(&cube, &plane([0.0, 0.0, 0.25], [0.0, 0.0, 1.0]), Cap::Closed).unwrap().mesh;
    assert_eq!((left.colours.len(), left.scalars.len()), (left.points.len(), left.points.len()));
    for ((p, colour), scalar) in left.points.iter().zip(&left.colours).zip(&left.scalars) {
        assert_eq!(*scalar, p.z);
        assert_eq!(*colour, if p.z > 0.0 { [50, 75, 0] } else { [0, 100, 0] });
    }
}

#[test]
fn planes_that_make_no_sense_are_refused() {
    assert_eq!(CutPlane::new(Point::origin(), Vector::zeros()), Err(CutError::Normal));
    assert_eq!(CutPlane::new(Point::new(f64::NAN, 0.0, 0.0), Vector::z()), Err(CutError::Normal));
    let beyond = plane([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
    assert_eq!(cut(&blocks(1, |_| true), &beyond, Cap::Closed).err(), Some(CutError::NothingLeft));
}
