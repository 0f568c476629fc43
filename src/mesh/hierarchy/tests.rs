use super::*;

/// Points without any order, from a fixed sequence.
fn scattered(count: usize, seed: u64) -> Vec<Point> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| Point::new(next(), next(), next())).collect()
}

#[test]
fn nearest_points_are_those_of_trying_all_triangles() {
    let points = scattered(600, 7);
    let faces: Vec<[u32; 3]> = (0..200).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let hierarchy = Hierarchy::new(&points, &faces);
    for p in scattered(100, 8) {
        let all = faces.iter().map(|f| (p - nearest_on_triangle(p, f.map(|v| points[v as usize])).0).norm());
        let least = all.fold(f64::INFINITY, f64::min);
        let found = hierarchy.nearest(p, f64::INFINITY).unwrap();
        assert!((found.distance - least).abs() < 1e-12);
        assert!((p - found.point).norm() - found.distance < 1e-12);
        assert!(hierarchy.is_nearer(p, 1.01 * least) && !hierarchy.is_nearer(p, 0.99 * least));
        assert!(hierarchy.nearest(p, 0.99 * least).is_none());
    }
    assert!(Hierarchy::new(&[], &[]).nearest(Point::origin(), f64::INFINITY).is_none());
}

#[test]
fn segments_cross_what_lies_between_their_ends() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let hierarchy = Hierarchy::new(&points, &[[0, 1, 2]]);
    let crossed = |a: [f64; 3], b: [f64; 3]| hierarchy.is_crossed(a.into(), b.into());
    assert!(crossed([0.2, 0.2, 1.0], [0.2, 0.2, -1.0]));
    assert!(crossed([0.2, 0.2, -1.0], [0.3, 0.3, 1.0]));
    assert!(!crossed([0.2, 0.2, 1.0], [0.2, 0.2, 0.1]));
    assert!(!crossed([0.7, 0.7, 1.0], [0.7, 0.7, -1.0]));
    assert!(!crossed([0.2, 0.2, 0.0], [0.2, 0.2, 1.0]), "an end on the triangle does not cross it");
}

#[test]
fn boxes_are_asked_for_what_is_in_them() {
    let points = scattered(300, 7);
    let faces: Vec<[u32; 3]> = (0..100).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let hierarchy = Hierarchy::new(&points, &faces);
    let (low, high) = (Point::new(0.1, 0.1, 0.1), Point::new(0.3, 0.4, 0.2));
    let mut found = Vec::new();
    hierarchy.any_in_box(low, high, |f| {
        found.push(f);
        false
    });
    found.sort_unstable();
    let meets = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| points[v as usize]);
        let (l, h) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        (0..3).all(|k| l[k] <= high[k] && h[k] >= low[k])
    };
    let expected: Vec<u32> = (0..100).filter(|&k| meets(&faces[k as usize])).collect();
    assert!(!expected.is_empty());
    assert_eq!(found, expected);
}

#[test]
fn what_is_nearer_above_a_plane_is_found() {
    let points = scattered(600, 7);
    let faces: Vec<[u32; 3]> = (0..200).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let hierarchy = Hierarchy::new(&points, &faces);
    let mut count = 0;
    for (p, q) in scattered(200, 8).into_iter().zip(scattered(200, 9)) {
        let (up, height, distance) = ((q - Point::new(0.5, 0.5, 0.5)).normalize(), 0.1, 0.05);
        let is_hit = |f: &[u32; 3]| {
            let triangle = f.map(|v| points[v as usize]);
            triangle.iter().any(|c| up.dot(&(c - q)) > height)
                && (nearest_on_triangle(p, triangle).0 - p).norm() < distance
        };
        let expected = faces.iter().any(is_hit);
        assert_eq!(hierarchy.is_nearer_above(p, distance, q, up, height), expected);
        count += usize::from(expected);
    }
    assert!((20..180).contains(&count), "{count}");
}
