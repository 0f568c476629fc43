//! Which shapes of a drawing an operation is done to.

use std::collections::HashSet;

use anyhow::{Result, bail};

use crate::cam::{SelectFile, Words};
use crate::io::svg::{Color, DrawnShape, Shapes};
use crate::units::nearest;

/// The indices of the shapes that `select` means, in the order of the file.
///
/// # Errors
/// Where a name, colour or number means nothing in the drawing, with the nearest name; where all together mean nothing.
pub(super) fn select(shapes: &Shapes, select: &SelectFile) -> Result<Vec<usize>> {
    let all = &shapes.shapes;
    let mut chosen: Vec<bool> = vec![true; all.len()];
    for (what, words) in [("id", &select.id), ("layer", &select.layer)] {
        let Some(words) = words else { continue };
        let names: HashSet<&str> = all.iter().flat_map(|s| &s.names).map(String::as_str).collect();
        if let Some(word) = words.iter().find(|w| !names.contains(w)) {
            let mut known: Vec<&str> = names.iter().copied().collect();
            known.sort_unstable();
            let hint = nearest(word, known.into_iter()).map_or(String::new(), |n| format!("; did you mean \"{n}\"?"));
            bail!("no shape of the drawing has the {what} \"{word}\"{hint}");
        }
        keep(&mut chosen, all, |_, shape| words.iter().any(|w| shape.names.iter().any(|n| n == w)));
    }
    let fill: fn(&DrawnShape) -> Option<Color> = |s| s.fill;
    let stroke: fn(&DrawnShape) -> Option<Color> = |s| s.stroke;
    for (what, words, color) in [("fill", &select.fill, fill), ("stroke", &select.stroke, stroke)] {
        let Some(words) = words else { continue };
        let colors = colors(words, what)?;
        if let Some(missing) = colors.iter().find(|c| !all.iter().any(|s| color(s) == Some(**c))) {
            let mut known: Vec<String> = all.iter().filter_map(color).map(|c| c.to_string()).collect();
            known.sort_unstable();
            known.dedup();
            bail!("no shape of the drawing has the {what} {missing}: there are {}", known.join(", "));
        }
        keep(&mut chosen, all, |_, shape| color(shape).is_some_and(|c| colors.contains(&c)));
    }
    if let Some(order) = &select.order {
        if let Some(beyond) = order.iter().find(|n| !(1..=all.len()).contains(*n)) {
            bail!("there is no shape {beyond}: the drawing has {}, counted from 1", all.len());
        }
        keep(&mut chosen, all, |k, _| order.contains(&(k + 1)));
    }
    let chosen: Vec<usize> = (0..all.len()).filter(|&k| chosen[k]).collect();
    if chosen.is_empty() {
        bail!("no shape of the drawing is all that select asks for");
    }
    Ok(chosen)
}

fn keep(chosen: &mut [bool], shapes: &[DrawnShape], is_meant: impl Fn(usize, &DrawnShape) -> bool) {
    for (k, shape) in shapes.iter().enumerate() {
        chosen[k] &= is_meant(k, shape);
    }
}

fn colors(words: &Words, what: &str) -> Result<Vec<Color>> {
    let color = |word: &str| match Color::parse(word) {
        Some(color) => Ok(color),
        None => bail!("{what}: \"{word}\" is no colour: write red, #f00 or #ff0000"),
    };
    words.iter().map(color).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::svg::{ReadOptions, read_shapes};

    fn shapes() -> Shapes {
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm" viewBox="0 0 10 10">
            <g id="holes"><circle id="a" r="1" fill="red"/><circle id="b" r="1" fill="#00f"/></g>
            <rect id="plate" width="5" height="5" fill="red" stroke="black"/></svg>"##;
        read_shapes(svg, &ReadOptions::default()).unwrap()
    }

    fn meant(toml: &str) -> Result<Vec<usize>> {
        select(&shapes(), &toml::from_str(toml).unwrap())
    }

    #[test]
    fn shapes_are_chosen_by_all_that_is_said_together() {
        assert_eq!(meant("").unwrap(), [0, 1, 2]);
        assert_eq!(meant("layer = \"holes\"").unwrap(), [0, 1]);
        assert_eq!(meant("id = [\"a\", \"plate\"]").unwrap(), [0, 2]);
        assert_eq!(meant("fill = \"#f00\"").unwrap(), [0, 2]);
        assert_eq!(meant("fill = \"red\"\nlayer = \"holes\"").unwrap(), [0]);
        assert_eq!(meant("stroke = \"black\"").unwrap(), [2]);
        assert_eq!(meant("order = [2, 3]").unwrap(), [1, 2]);
    }

    #[test]
    fn what_means_nothing_is_told_with_the_nearest_name() {
        for (toml, expected) in [
            ("id = \"plat\"", "did you mean \"plate\"?"),
            ("fill = \"green\"", "there are #0000ff, #ff0000"),
            ("fill = \"reddish\"", "is no colour"),
            ("order = [0]", "counted from 1"),
            ("order = [4]", "the drawing has 3"),
            ("layer = \"holes\"\nstroke = \"black\"", "all that select asks for"),
        ] {
            let error = meant(toml).unwrap_err().to_string();
            assert!(error.contains(expected), "{toml}: {error}");
        }
    }
}
