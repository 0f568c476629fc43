use super::super::motion::Motion;
use super::super::stock::Stock;
use super::super::sweep::Cutter;
use super::super::tool::Tool;
use super::*;
use crate::gcode::read;
use crate::mesh::{PolygonMesh, problems};
use crate::plane::Point;
use proptest::prelude::*;

fn cut(columns: usize, rows: usize, tool: &str, path: &str) -> HeightMap {
    let stock = Stock::new(Point::origin(), [columns as f64 * 0.25, rows as f64 * 0.25, 3.0], 0.0);
    let mut map = HeightMap::new(stock, 0.25).unwrap();
    assert_eq!((map.columns(), map.rows()), (columns, rows));
    let program = read(&format!("G21 G90 G17 G94 F100\nG0 Z5\n{path}")).unwrap();
    let cutter = Cutter::new(&tool.parse::<Tool>().unwrap());
    let feeds: Vec<&Motion> = program.motions.iter().filter(|m| m.is_feed()).collect();
    feeds.into_iter().for_each(|m| {
        map.cut(&cutter, m, &mut Vec::new());
    });
    map
}

fn mesh(surface: &StockSurface) -> PolygonMesh {
    PolygonMesh::of_triangles(surface.points.clone(), &surface.faces)
}

fn volume(surface: &StockSurface) -> f64 {
    let corner = |v: u32| surface.points[v as usize].coords;
    surface.faces.iter().map(|f| corner(f[0]).dot(&corner(f[1]).cross(&corner(f[2]))) / 6.0).sum()
}

fn check(map: &HeightMap) -> StockSurface {
    let surface = stock_surface(map, 0.01);
    assert!(!surface.faces.is_empty());
    let found = problems(&mesh(&surface));
    assert!(found.is_empty(), "{:?}", &found[..found.len().min(5)]);
    surface
}

#[test]
fn whole_stock_is_a_box() {
    for (columns, rows) in [(2, 2), (65, 65), (129, 65), (100, 37), (3, 200)] {
        let map = cut(columns, rows, "1=flat 2mm", "");
        let surface = check(&map);
        let expected = columns as f64 * rows as f64 * 0.0625 * 3.0;
        assert!((volume(&surface) / expected - 1.0).abs() < 1e-9, "{columns} x {rows}: {}", volume(&surface));
    }
    // Where tiles fit, a flat face needs few triangles.
    assert!(stock_surface(&cut(129, 65, "1=flat 2mm", ""), 0.01).faces.len() < 40);
}

#[test]
fn pockets_and_windows_are_closed() {
    let path = "G0 X5 Y5\nG1 Z-1\nG1 X20 Y8\nG1 Z-3\nG3 X20 Y8 I-4 J0\nG0 Z5\nG0 X27 Y3\nG1 Z-2\nG1 X40";
    for tool in ["1=flat 3mm", "1=ball 3mm", "1=v90 5mm"] {
        let map = cut(117, 81, tool, path);
        let surface = check(&map);
        let left =
            map.stock().thickness() * map.stock().outline().width() * map.stock().outline().height() - map.removed();
        // Walls lean by a cell.
        assert!((volume(&surface) / left - 1.0).abs() < 0.02, "{tool}: {} against {left}", volume(&surface));
    }
}

#[test]
fn stock_cut_in_two_is_two_bodies_that_do_not_touch() {
    check(&cut(80, 60, "1=flat 2mm", "G0 X-5 Y7\nG1 Z-3\nG1 X30 Y8"));
    // A groove that reaches the lower face along a line only.
    check(&cut(80, 60, "1=v90 12mm", "G0 X-5 Y7.125\nG1 Z-3\nG1 X30"));
    check(&cut(80, 60, "1=v90 12mm", "G0 X7.125 Y-3\nG1 Z-3\nG1 Y30\nG0 Z5\nG0 X-5 Y7.125\nG1 Z-3\nG1 X30"));
}

#[test]
fn too_little_stock_has_no_surface() {
    assert_eq!(stock_surface(&cut(1, 9, "1=flat 2mm", ""), 0.01), StockSurface::default());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Heights at random, many of them cut through: every way in which cells can touch.
    #[test]
    fn any_heights_make_a_closed_surface(
        columns in 2usize..14,
        rows in 2usize..14,
        levels in prop::collection::vec(0u8..4, 200),
    ) {
        let mut map = cut(columns, rows, "1=flat 2mm", "");
        for (height, level) in map.heights.iter_mut().zip(&levels) {
            *height = [-3.0, -3.0, -1.0, 0.0][usize::from(*level)];
        }
        let surface = stock_surface(&map, 0.01);
        if !surface.faces.is_empty() {
            let found = problems(&mesh(&surface));
            prop_assert!(found.is_empty(), "{:?}", found);
        }
    }
}
