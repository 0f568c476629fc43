//! V-carvings of shapes of many kinds: nothing outside is cut, everything inside is.

mod shapes;

use clopen::cam::{CARVING_TOLERANCE, Point3, Tool, ToolShape, VCarve, VCarving, v_carve};
use clopen::plane::{BoundaryIndex, Point, Region};

/// How much of the region may be left uncut at the stock's top, in millimetres.
const UNCUT: f64 = 0.01;

fn spec(degrees: f64, max_depth: Option<f64>, depth_per_pass: f64) -> VCarve {
    let shape = ToolShape::Cone { angle: f64::to_radians(degrees), tip_diameter: 0.0 };
    let tool =
        Tool { number: 1, name: String::new(), shape, is_drill: false, diameter: 30.0, flutes: 2, flute_length: 40.0 };
    VCarve { tool, stock_top: 0.0, max_depth, depth_per_pass }
}

/// By how much the cone, on its way from one place to another, misses `p` at the stock's top; convex along the way.
fn gap(carve: &VCarve, a: &Point3, b: &Point3, p: Point) -> f64 {
    let at = |t: f64| {
        let tip = a + (b - a) * t;
        (p.coords - tip.coords.xy()).norm() - carve.tool.radius_at(carve.stock_top - tip.z)
    };
    let length = (b - a).norm() * (1.0 + (0.5 * 2.1f64).tan());
    if 0.5 * (at(0.0) + at(1.0)) - length > UNCUT {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let (s, t) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(s) < at(t) { high = t } else { low = s }
    }
    at(0.5 * (low + high)).min(at(0.0)).min(at(1.0))
}

fn assert_carves(name: &str, region: &Region, carve: &VCarve) -> VCarving {
    let carving = v_carve(region, carve).unwrap_or_else(|e| panic!("{name}: {e}"));
    let index = BoundaryIndex::new(region);
    let ways = || {
        let pairs = |c: &'_ Vec<Point3>| (0..c.len()).map(|k| (c[k], c[(k + 1).min(c.len() - 1)])).collect::<Vec<_>>();
        carving.chains.iter().flat_map(pairs)
    };
    for (a, b) in ways() {
        for k in 0..=6 {
            let tip = a + (b - a) * (f64::from(k) / 6.0);
            let p = Point::new(tip.x, tip.y);
            let (radius, clearance) = (carve.tool.radius_at(carve.stock_top - tip.z), index.distance(p));
            assert!(radius <= clearance + CARVING_TOLERANCE, "{name}: at {tip} {radius} wide in {clearance}");
            assert!(clearance < CARVING_TOLERANCE || region.contains(p), "{name}: {tip} is outside");
            assert!(tip.z <= carve.stock_top + 1e-9 && tip.z >= carve.stock_top - carving.deepest - 1e-9);
        }
    }
    const GRID: u32 = 24;
    let bounds = region.bounds();
    let mut looked_at = 0;
    for k in 0..GRID * GRID {
        let at = |k: u32, low: f64, side: f64| low + side * (f64::from(k) + 0.4321) / f64::from(GRID);
        let p = Point::new(at(k % GRID, bounds.min.x, bounds.width()), at(k / GRID, bounds.min.y, bounds.height()));
        if region.contains(p) && !carving.flat.contains(p) {
            looked_at += 1;
            let is_cut = ways().any(|(a, b)| gap(carve, &a, &b, p) <= UNCUT);
            assert!(is_cut, "{name}: {p} is not cut");
        }
    }
    assert!(looked_at > 0, "{name}: no place was looked at");
    carving
}

#[test]
fn shapes_are_carved_whole_and_nothing_else_is() {
    for number in 0..60 {
        let (name, region) = shapes::mixed(number);
        assert_carves(&name, &region, &spec(90.0, None, 100.0));
    }
}

#[test]
fn flat_bottoms_begin_where_the_walls_end() {
    let mut with_bottom = 0;
    for number in 0..60 {
        let (name, region) = shapes::mixed(number);
        let carving = assert_carves(&name, &region, &spec(60.0, Some(0.8), 0.3));
        let index = BoundaryIndex::new(&region);
        let wall = 0.8 * 30f64.to_radians().tan();
        for segment in carving.flat.segments() {
            let distance = index.distance(segment.point_at(0.5));
            assert!((distance - wall).abs() < CARVING_TOLERANCE, "{name}: the bottom begins {distance} from the edge");
        }
        with_bottom += usize::from(!carving.flat.is_empty());
    }
    assert!(with_bottom > 40, "{with_bottom}");
}

#[test]
fn letters_are_carved_to_the_tips_of_their_serifs() {
    let word = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/samples/word.svg")).unwrap();
    let drawing = clopen::io::svg::read(&word, &clopen::io::svg::ReadOptions::default()).unwrap();
    let deep = assert_carves("word", &drawing.region, &spec(60.0, None, 100.0));
    assert!(deep.flat.is_empty());
    let shallow = assert_carves("word", &drawing.region, &spec(60.0, Some(3.0), 1.0));
    assert!(shallow.flat.area() > 100.0);
    // The stems of a word as wide as a hand need few lifts.
    assert!(deep.chains.len() < 40, "{}", deep.chains.len());
}
