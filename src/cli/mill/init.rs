//! `clopen mill --init`: a commented job file for a drawing.

use anyhow::Result;

use super::MillArgs;
use crate::cam::{SampleShape, commented_sample};
use crate::cli::{ExitStatus, input, output};
use crate::io::svg::DrawnShape;

/// Prints the file.
///
/// # Errors
/// Where the drawing cannot be read, or there is no such dialect.
pub(super) fn run(args: &MillArgs) -> Result<ExitStatus> {
    let shapes = args.reading.read_shapes(&args.input)?;
    let scale = shapes.mm_per_unit.unwrap_or(1.0);
    let listed: Vec<SampleShape> =
        shapes.shapes.iter().enumerate().map(|(k, s)| SampleShape { words: words(k + 1, s, scale) }).collect();
    let name = args.input.file_name().map_or("drawing.svg".into(), |n| n.to_string_lossy().into_owned());
    let all: Vec<usize> = (0..shapes.shapes.len()).collect();
    let covered = shapes.covered_shapes(&all);
    // Lines on what is filled are engraved, most often.
    let is_filled = |k: &usize| !shapes.shapes[*k].area.is_empty();
    let outer: Vec<usize> = match covered.is_empty() && (all.iter().all(is_filled) || !all.iter().any(is_filled)) {
        true => Vec::new(),
        false => all.into_iter().filter(|k| is_filled(k) && !covered.contains(k)).map(|k| k + 1).collect(),
    };
    let dialect = args.typed().dialect.unwrap_or_else(|| "grbl".to_owned());
    input::dialect(&dialect)?;
    output::print(&commented_sample(&name, &dialect, &listed, &outer))?;
    Ok(ExitStatus::Done)
}

fn words(number: usize, shape: &DrawnShape, scale: f64) -> String {
    let bounds = shape.lines.iter().fold(shape.area.bounds(), |b, l| b.union(l.ring.bounds()));
    let mut words =
        format!("{number}: {} {:.2} x {:.2} mm", shape.place.element, bounds.width() * scale, bounds.height() * scale);
    if let Some(fill) = shape.fill {
        words += &format!(", fill {fill}");
    }
    if let Some(stroke) = shape.stroke {
        words += &format!(", stroke {stroke}");
    }
    for name in &shape.names {
        words += &format!(", \"{name}\"");
    }
    words
}
