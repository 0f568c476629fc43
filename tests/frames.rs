//! Pictures of states, from closings and openings with growing radii. With `CLOPEN_PICTURES=FOLDER` they are kept for looking at.

use std::path::Path;

use clopen::io::svg::{Drawing, ReadOptions, Still, animate, read};
use clopen::plane::Region;
use clopen::preview::{Cell, Picture, animation, contact_sheet};
use clopen::rolling::{Topology, close, open};
use clopen::units::Radius;

fn keep(name: &str, bytes: &[u8]) {
    if let Some(folder) = std::env::var_os("CLOPEN_PICTURES") {
        std::fs::write(Path::new(&folder).join(name), bytes).unwrap();
    }
}

fn word() -> Drawing {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/word.svg");
    read(&std::fs::read(path).unwrap(), &ReadOptions::default()).unwrap()
}

/// The largest radius, in millimetres.
const LARGEST: f64 = 5.7;

fn radii(n: usize) -> Vec<Radius> {
    (1..=n).map(|k| Radius::new(LARGEST * k as f64 / n as f64).unwrap()).collect()
}

fn opened(drawing: &Drawing, n: usize) -> Vec<Region> {
    radii(n).into_iter().map(|r| open(&drawing.region, r, Topology::Keep).region).collect()
}

fn closed(drawing: &Drawing, n: usize) -> Vec<Region> {
    radii(n).into_iter().map(|r| close(&drawing.region, r, Topology::Keep).region).collect()
}

fn pixels(png: &[u8]) -> tiny_skia::Pixmap {
    tiny_skia::Pixmap::decode_png(png).unwrap()
}

#[test]
fn a_contact_sheet_of_a_word() {
    let drawing = word();
    let states = [opened(&drawing, 6), closed(&drawing, 6)].concat();
    let cells = states.iter().enumerate().map(|(k, after)| {
        let name = if k < 6 { "opening" } else { "closing" };
        Cell { caption: format!("{name}, {:.2} mm", radii(6)[k % 6].get()), before: &drawing.region, after }
    });
    let cells: Vec<Cell> = cells.collect();
    let png = contact_sheet(&cells, None, 1600).unwrap();
    keep("word-sheet.png", &png);
    assert_eq!(png, contact_sheet(&cells, None, 1600).unwrap(), "the same bytes again");
    assert!(png.len() < 150_000, "{} bytes", png.len());
    let picture = pixels(&png);
    assert_eq!(picture.width(), 1600);
    for color in [[252, 194, 215], [165, 216, 255], [73, 80, 87]] {
        assert!(picture.pixels().iter().any(|p| [p.red(), p.green(), p.blue()] == color), "{color:?} is missing");
    }
    keep("word-row.png", &contact_sheet(&cells[..6], Some(6), 1600).unwrap());
    keep("word-one.png", &contact_sheet(&cells[5..6], None, 1000).unwrap());
}

#[test]
fn a_word_in_motion() {
    let drawing = word();
    let states = opened(&drawing, 24);
    let seconds = |k: usize| if k == 23 { 1.5 } else { 0.125 };
    let picture = |(k, region): (usize, _)| Picture {
        caption: format!("{:.2} mm", radii(24)[k].get()),
        region,
        seconds: seconds(k),
    };
    let pictures: Vec<Picture> = states.iter().enumerate().map(picture).collect();
    let png = animation(&drawing.region, &pictures, 800).unwrap();
    keep("word-animation.png", &png);
    assert!(png.len() < 400_000, "{} bytes", png.len());
    // To whoever knows no animation it is the last state.
    let last = animation(&drawing.region, &pictures[23..], 800).unwrap();
    let (shown, last) = (pixels(&png), pixels(&last));
    let differs =
        |(a, b): &(&tiny_skia::PremultipliedColorU8, &tiny_skia::PremultipliedColorU8)| a.red().abs_diff(b.red()) > 40;
    assert_eq!(shown.pixels().iter().zip(last.pixels()).filter(differs).count(), 0);

    let still = |(k, region): (usize, _)| Still {
        region,
        caption: format!("{:.2} mm", radii(24)[k].get()),
        seconds: seconds(k),
    };
    let stills: Vec<Still> = states.iter().enumerate().map(still).collect();
    let svg = animate(&drawing, &stills);
    keep("word-animation.svg", svg.as_bytes());
    assert!(svg.len() < 400_000, "{} bytes", svg.len());
    // The captions would be read as shapes.
    let mute = svg.split("<g fill=\"#343a40\"").next().unwrap().to_owned() + "</svg>";
    let read_back = read(mute.as_bytes(), &ReadOptions::default()).unwrap();
    let off = (read_back.region.area() / states[23].area() - 1.0).abs();
    assert!(off < 1e-3, "the last state is off by {off}");
}
