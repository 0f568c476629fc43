//! Pictures of a bracket and its program. With `CLOPEN_PICTURES=FOLDER` they are kept for looking at.

use clopen::cam::{CertifyOptions, Program, Tool, certify};
use clopen::gcode::read;
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vertex};
use clopen::preview::{self, Scene};

const TOOL_RADIUS: f64 = 1.5875;
const FILLET: f64 = 3.5875;

fn corner(x: f64, y: f64) -> Vertex {
    Vertex::corner(Point::new(x, y))
}

/// A bracket of 80 by 60 mm with one inside corner at (25, 20), sharp or rounded, two round holes and a square one.
fn bracket(fillet: Option<f64>) -> Region {
    let mut outer = vec![corner(0.0, 0.0), corner(80.0, 0.0), corner(80.0, 20.0)];
    match fillet {
        None => outer.push(corner(25.0, 20.0)),
        Some(r) => {
            let arc = Arc { center: Point::new(25.0 + r, 20.0 + r), radius: r, turn: Turn::Right };
            let start = Vertex { link: Link::Arc(arc), joint: Joint::Corner, ..corner(25.0 + r, 20.0) };
            outer.extend([start, corner(25.0, 20.0 + r)]);
        }
    }
    outer.extend([corner(25.0, 60.0), corner(0.0, 60.0)]);
    let mut rings = vec![Ring { vertices: outer }];
    for (x, y, r) in [(65.0, 10.0, 4.0), (12.5, 50.0, 4.0), (45.0, 10.0, 1.0)] {
        rings.push(Ring::circle(Point::new(x, y), r).reversed());
    }
    let square = [[8.0, 8.0], [8.0, 30.0], [17.0, 30.0], [17.0, 8.0]];
    rings.push(Ring::polygon(square.map(|p| Point::new(p[0], p[1]))));
    Region::new(rings)
}

/// Two holes, the square, then around in three passes; the small hole is too small for the tool.
fn bracket_program() -> Program {
    let t = TOOL_RADIUS;
    let mut text = String::from("G21 G90 G17 G94\nG0 Z5\nM3 S12000\nG4 P3\n");
    let mut levels = |path: &dyn Fn(&mut String), x: f64, y: f64| {
        text += &format!("G0 X{x:.3} Y{y:.3}\n");
        for z in [-2.0, -4.0, -6.0] {
            text += &format!("G1 Z{z} F200\nF1200\n");
            path(&mut text);
        }
        text += "G0 Z5\n";
    };
    for (x, y) in [(65.0, 10.0), (12.5, 50.0)] {
        let r = 4.0 - t;
        let start = x + r;
        levels(&|s| *s += &format!("G3 X{start:.3} Y{y:.3} I{:.3} J0\n", -((start * 1e3).round() / 1e3 - x)), start, y);
    }
    let (a, b, c, d) = (8.0 + t, 17.0 - t, 8.0 + t, 30.0 - t);
    levels(&|s| *s += &format!("G1 Y{d:.3}\nX{a:.3}\nY{c:.3}\nX{b:.3}\nY15\n"), b, 15.0);
    let (f, g) = (25.0 + FILLET, 20.0 + FILLET);
    let around = format!(
        "G1 Y60\nG2 X0 Y{top:.4} I{t} J0\nG1 X25\nG2 X{e:.4} Y60 I0 J-{t}\nG1 Y{g:.4}\nG3 X{f:.4} Y{h:.4} I2 J0\nG1 X80\n\
         G2 X{right:.4} Y20 I0 J-{t}\nG1 Y0\nG2 X80 Y-{t} I-{t} J0\nG1 X0\nG2 X-{t} Y0 I0 J{t}\nG1 Y40\n",
        top = 60.0 + t,
        e = 25.0 + t,
        h = 20.0 + t,
        right = 80.0 + t,
    );
    levels(&|s| *s += &around, -t, 40.0);
    text += "X0 Y0\nM5\nM2\n";
    read(&text).unwrap()
}

fn keep(name: &str, png: &[u8]) {
    if let Some(folder) = std::env::var_os("CLOPEN_PICTURES") {
        std::fs::write(std::path::Path::new(&folder).join(name), png).unwrap();
    }
}

fn pixel(picture: &tiny_skia::Pixmap, x: u32, y: u32) -> [u8; 3] {
    let p = picture.pixel(x, y).unwrap();
    [p.red(), p.green(), p.blue()]
}

#[test]
fn a_bracket_and_its_program() {
    let (part, kept, program) = (bracket(None), bracket(Some(FILLET)), bracket_program());
    let certificate = certify(&program, &part, &kept, &CertifyOptions::new(TOOL_RADIUS));
    assert!(certificate.gouge.unwrap().depth_mm < 0.002, "{:?}", certificate.gouge);
    assert!(certificate.overcut.unwrap().depth_mm < 0.002, "{:?}", certificate.overcut);
    assert_eq!(certificate.uncut.places.len(), 6, "{:#?}", certificate.uncut.places);
    assert_eq!(certificate.path_radius.smallest_concave_mm, Some(0.0), "the square hole has corners");

    let scene = Scene {
        part: Some(&part),
        kept: Some(&kept),
        uncut: Some(&certificate.uncut),
        tools: &[Tool::flat(1, 2.0 * TOOL_RADIUS)],
        ..Scene::new(&program)
    };
    let png = preview::program(&scene, preview::DEFAULT_SIZE).unwrap();
    keep("bracket.png", &png);
    assert_eq!(png, preview::program(&scene, preview::DEFAULT_SIZE).unwrap(), "the same bytes again");
    let picture = tiny_skia::Pixmap::decode_png(&png).unwrap();
    assert_eq!(picture.width().max(picture.height()), preview::DEFAULT_SIZE);
    assert_eq!(pixel(&picture, 2, 2), [255, 255, 255]);
    let colours: std::collections::BTreeSet<[u8; 3]> =
        picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    for (name, colour) in
        [("part", [250, 236, 209]), ("swath", [233, 238, 243]), ("uncut", [255, 169, 77]), ("moved", [214, 51, 108])]
    {
        assert!(colours.contains(&colour), "nothing in the colour of {name}");
    }

    let alone = Scene { tools: &[Tool::flat(1, 2.0 * TOOL_RADIUS)], ..Scene::new(&program) };
    keep("program.png", &preview::program(&alone, 1000).unwrap());
}

#[test]
fn an_outline_before_and_after() {
    let (part, kept) = (bracket(None), bracket(Some(FILLET)));
    keep("outline.png", &preview::outline(&kept, Some(&part), "mm", 1200).unwrap());
    keep("tall.png", &preview::outline(&bracket_column(), None, "", 1200).unwrap());
}

fn bracket_column() -> Region {
    let p = Point::new;
    Region::new(vec![Ring::polygon([p(0.0, 0.0), p(4.0, 0.0), p(4.0, 50.0), p(0.0, 50.0)])])
}

/// Circles on circles, each as large as the picture: their strokes are drawn a part at a time, and the last is there too.
#[test]
fn strokes_of_very_many_points() {
    const CIRCLES: usize = 2_500;
    let circles = "G2 X0 Y0 I5 J0\n".repeat(CIRCLES);
    let many = read(&format!("G21 G90 G17 G94 F100\nM3 S1\nG0 Z1\nG1 Z-1\n{circles}G1 X-20\n")).unwrap();
    let mut few = many.clone();
    few.motions.drain(2..1 + CIRCLES);
    assert_eq!(few.motions.len(), 4, "{:?}", few.motions);
    // Left of the circles there is nothing but the last line.
    let left_half = |program: &Program| {
        let png = preview::program(&Scene { tools: &[Tool::flat(1, 1.0)], ..Scene::new(program) }, 900).unwrap();
        let picture = tiny_skia::Pixmap::decode_png(&png).unwrap();
        let (w, h) = (picture.width() / 2, picture.height());
        (0..w).flat_map(|x| (0..h).map(move |y| (x, y))).map(|(x, y)| pixel(&picture, x, y)).collect::<Vec<_>>()
    };
    let drawn = left_half(&many);
    assert!(drawn.iter().filter(|p| **p != [255, 255, 255]).count() > 5_000);
    assert_eq!(drawn, left_half(&few));
}
