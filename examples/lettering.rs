//! The contact sheets of lettering in the README: `cargo run --release --example lettering -- FOLDER` writes `word-in-time.png`
//! (opening and closing of a serif word by the flow, at six times each) and `word-by-radius.png` (what opening with six radii
//! makes of it, which is no state of that flow).

use std::error::Error;
use std::path::{Path, PathBuf};

use clopen::flow::{CurveFlow, Field, Obstacle, Settings};
use clopen::io::svg::{ReadOptions, read};
use clopen::plane::Region;
use clopen::preview::{Cell, Frame, contact_sheet, time_captions};
use clopen::rolling::{Topology, open};
use clopen::units::Radius;

/// The radius of the flow, in millimetres.
const RADIUS: f64 = 3.0;

/// States on each sheet of either kind.
const STATES: usize = 6;

/// Pixels.
const WIDTH: u32 = 1600;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or(PathBuf::from("."), PathBuf::from);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/word.svg");
    let word = read(&std::fs::read(path)?, &ReadOptions::default())?.region;

    let mut cells = Vec::new();
    let (opening, closing) = (states(&word, Obstacle::OPENING)?, states(&word, Obstacle::CLOSING)?);
    for (name, frames) in [("opening", &opening), ("closing", &closing)] {
        for (frame, caption) in frames.iter().zip(time_captions(frames)) {
            cells.push(Cell { caption: format!("{name}, {caption}"), before: &word, after: &frame.region });
        }
    }
    std::fs::write(folder.join("word-in-time.png"), contact_sheet(&cells, Some(3), WIDTH)?)?;

    let radii: Vec<f64> = (1..=STATES).map(|k| RADIUS * k as f64 / STATES as f64).collect();
    let opened: Result<Vec<Region>, _> =
        radii.iter().map(|&r| Ok::<_, Box<dyn Error>>(open(&word, Radius::new(r)?, Topology::Keep).region)).collect();
    let opened = opened?;
    let cell = |(r, after): (&f64, _)| Cell { caption: format!("opening, r {r} mm"), before: &word, after };
    let cells: Vec<Cell> = radii.iter().zip(&opened).map(cell).collect();
    std::fs::write(folder.join("word-by-radius.png"), contact_sheet(&cells, Some(3), WIDTH)?)?;
    Ok(())
}

/// States of the flow, evenly spread in the area that it sweeps over.
fn states(word: &Region, obstacle: Obstacle) -> Result<Vec<Frame>, Box<dyn Error>> {
    let radius = Radius::new(RADIUS)?;
    let start = || CurveFlow::new(word, obstacle, Field::constant(radius), &Settings::default());
    let mut whole = start()?;
    whole.run(f64::INFINITY);
    let mut flow = start()?;
    let mut frames = Vec::new();
    for k in 1..=STATES {
        let swept = whole.swept() * k as f64 / STATES as f64;
        while flow.swept() < swept && flow.time() < whole.time() {
            flow.step(whole.time());
        }
        frames.push(Frame { time: flow.time() / (RADIUS * RADIUS), region: flow.rounded() });
    }
    Ok(frames)
}
