//! The picture of a program: what it cuts, how, and what it leaves.

use std::collections::HashSet;

use super::PreviewError;
use super::outline::{short, split_moved};
use super::palette;
use super::sheet::{Entry, Sample, Sheet};
use crate::cam::{Motion, MotionKind, Program, Tool, ToolShape, Uncut, statistics};
use crate::plane::{Bounds, Point, Region, Segment};
use crate::threads;

/// What the picture of a program shows.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The program, read back.
    pub program: &'a Program,
    /// What must remain; `None` where only the program is known.
    pub part: Option<&'a Region>,
    /// The intended boundary of what remains.
    pub kept: Option<&'a Region>,
    /// What is left standing.
    pub uncut: Option<&'a Uncut>,
    /// The tools that cut, known by their numbers; a single one is that of the whole program whatever its number. Empty
    /// where they are not known.
    pub tools: &'a [Tool],
    /// Where the top of the stock lies, z in millimetres.
    pub stock_top: f64,
}

impl<'a> Scene<'a> {
    /// A scene of a program alone, stock top at 0.
    pub fn new(program: &'a Program) -> Scene<'a> {
        Scene { program, part: None, kept: None, uncut: None, tools: &[], stock_top: 0.0 }
    }

    /// How wide the tool cuts on `motion` at the top of the stock, in millimetres from its axis, where it goes deepest;
    /// `None` where the tool is not known.
    fn cut_radius(&self, motion: &Motion) -> Option<f64> {
        let tool = match self.tools {
            [only] => only,
            tools => tools.iter().find(|tool| tool.number == motion.tool)?,
        };
        Some(tool.radius_at(self.stock_top - motion.from.z.min(motion.to.z)))
    }
}

/// Boundaries of part and closing nearer than this, in millimetres, are the same.
const SAME_BOUNDARY: f64 = 1e-4;

/// Steps of colour between the top of the stock and the deepest pass.
const DEPTH_STEPS: usize = 24;

/// Circles are drawn around small uncut places where there are no more than this.
const MOST_CIRCLES: usize = 16;

/// Places smaller than this over the larger side of what is shown get a circle, which is as large.
const SMALL_PLACE: f64 = 0.018;

/// The picture of `scene` as a PNG file of `size` pixels on its long side.
///
/// # Errors
/// Where there is nothing to draw, or the size is absurd.
pub fn program(scene: &Scene, size: u32) -> Result<Vec<u8>, PreviewError> {
    let bounds = bounds(scene);
    let depth = statistics(scene.program, scene.stock_top).depth_mm;
    let ((on, off), moved) = threads::both(
        || scene.part.map(|part| split_moved(part, scene.kept, SAME_BOUNDARY)).unwrap_or_default(),
        || scene.kept.map(|kept| split_moved(kept, scene.part, SAME_BOUNDARY).1).unwrap_or_default(),
    );
    let entries = legend(scene, &bounds, depth, !moved.is_empty(), f64::from(size) / 1000.0);
    let mut sheet = Sheet::new(&bounds, size, entries)?;
    let view = sheet.view;
    let unit = sheet.unit;
    let in_stock = || scene.program.motions.iter().filter(|m| m.is_in_stock(scene.stock_top));

    if let Some(part) = scene.part {
        sheet.canvas.fill(view.region(part).as_ref(), palette::PART, None);
    }
    draw_swaths(scene, &mut sheet);
    draw_uncut(scene, &bounds, &mut sheet);
    if scene.part.is_some() {
        sheet.canvas.stroke(&view.elements(off), palette::KEPT, 0.8 * unit, None);
        sheet.canvas.stroke(&view.elements(on), palette::KEPT, 1.5 * unit, None);
        sheet.canvas.stroke(&view.elements(moved), palette::MOVED, 2.0 * unit, None);
    }
    draw_path(scene, depth, &mut sheet);
    let rapids = scene.program.motions.iter().filter(|m| m.is_rapid()).flat_map(Motion::trace);
    let dash = Some([4.0 * unit, 3.0 * unit]);
    sheet.canvas.stroke_dashed(&view.elements(rapids), palette::RAPID, 0.8 * unit, dash, None);
    for motion in in_stock().filter(|m| m.from.z >= scene.stock_top) {
        let at = view.pixel(motion.from.xy());
        sheet.canvas.disk(at, 4.2 * unit, palette::WHITE);
        sheet.canvas.disk(at, 3.2 * unit, palette::START);
    }
    if bounds.contains(Point::origin()) {
        sheet.canvas.target(view.pixel(Point::origin()), 5.0 * unit, palette::ORIGIN, 1.4 * unit);
    }
    sheet.finish("mm")
}

/// What must be seen: the part and what the tool sweeps. Rapids may leave the picture.
fn bounds(scene: &Scene) -> Bounds {
    let regions = [scene.part, scene.kept].into_iter().flatten();
    let outlines = regions.fold(Bounds::EMPTY, |b, r| b.union(r.bounds()));
    let of_path = |only_cuts: bool| {
        scene
            .program
            .motions
            .iter()
            .filter(|m| !only_cuts || m.is_in_stock(scene.stock_top))
            .filter(|m| !matches!(m.kind, MotionKind::Dwell { .. }))
            .fold(Bounds::EMPTY, |b, m| m.trace().fold(b.with_point(m.to.xy()), |b, s| b.union(s.bounds())))
    };
    let path = of_path(true);
    let radius = scene.tools.iter().map(Tool::radius).filter(|r| r.is_finite()).fold(0.0, f64::max);
    let cut = if path.is_empty() { path } else { path.inflated(radius) };
    let all = outlines.union(cut);
    if all.is_empty() { of_path(false) } else { all }
}

fn legend(scene: &Scene, bounds: &Bounds, depth: f64, is_moved: bool, unit: f64) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |sample, text: String| entries.push(Entry { sample, text });
    if let Some(part) = scene.part {
        let b = part.bounds();
        add(Sample::Fill(palette::PART, None), format!("part {} x {} mm", short(b.width()), short(b.height())));
        add(Sample::Line(palette::KEPT, 1.5 * unit), "outline".to_owned());
    }
    if is_moved {
        add(Sample::Line(palette::MOVED, 2.0 * unit), "rounded by the tool".to_owned());
    }
    if let Some(uncut) = scene.uncut.filter(|u| !u.places.is_empty()) {
        let text = format!("uncut {} mm²", short(uncut.area_mm2));
        add(Sample::Fill(palette::UNCUT, Some(palette::UNCUT_LINE)), text);
        if circled(uncut, bounds).next().is_some() {
            add(Sample::Ring(palette::UNCUT_LINE), "small uncut place".to_owned());
        }
    }
    match scene.tools {
        [] => {}
        [only] if only.shape == ToolShape::Flat => {
            add(Sample::Fill(palette::SWATH, None), format!("cut, {} mm wide", thousandths(only.diameter)));
        }
        _ => add(Sample::Fill(palette::SWATH, None), "cut".to_owned()),
    }
    if depth > 0.0 {
        let colors = (0..=DEPTH_STEPS).map(|k| palette::depth(k as f64 / DEPTH_STEPS as f64)).collect();
        add(Sample::Ramp(colors), format!("path, 0 to {} mm deep", short(depth)));
    }
    if scene.program.motions.iter().any(Motion::is_rapid) {
        add(Sample::Dashed(palette::RAPID), "rapid".to_owned());
    }
    if scene.program.motions.iter().any(|m| m.is_in_stock(scene.stock_top)) {
        add(Sample::Dot(palette::START), "entry".to_owned());
    }
    if bounds.contains(Point::origin()) {
        add(Sample::Target(palette::ORIGIN), "x 0, y 0".to_owned());
    }
    entries
}

fn thousandths(length: f64) -> String {
    format!("{length:.3}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What the tools sweep in the stock: one stroke for all motions of the same width, passes over each other once.
fn draw_swaths(scene: &Scene, sheet: &mut Sheet) {
    let view = sheet.view;
    let mut by_width: Vec<(f64, Vec<&Motion>)> = Vec::new();
    for motion in scene.program.motions.iter().filter(|m| m.is_in_stock(scene.stock_top)) {
        let Some(radius) = scene.cut_radius(motion) else { continue };
        match by_width.last_mut() {
            Some((width, motions)) if *width == 2.0 * radius => motions.push(motion),
            _ => by_width.push((2.0 * radius, vec![motion])),
        }
    }
    for (width, motions) in by_width {
        let mut seen = HashSet::new();
        let is_new = |s: &Segment| seen.insert([s.start.x, s.start.y, s.end.x, s.end.y, s.sweep()].map(f64::to_bits));
        let swept = view.elements(motions.iter().flat_map(|m| m.trace()).filter(is_new));
        sheet.canvas.stroke(&swept, palette::SWATH, width * view.scale, None);
        for motion in motions.iter().filter(|m| m.trace().next().is_none()) {
            sheet.canvas.disk(view.pixel(motion.to.xy()), 0.5 * width * view.scale, palette::SWATH);
        }
    }
}

fn draw_uncut(scene: &Scene, bounds: &Bounds, sheet: &mut Sheet) {
    let Some(uncut) = scene.uncut else { return };
    let view = sheet.view;
    let unit = sheet.unit;
    let path = view.polygons(uncut.places.iter().flat_map(|p| &p.outlines));
    let Some(mask) = sheet.canvas.mask(path.as_ref()) else { return };
    sheet.canvas.fill(path.as_ref(), palette::UNCUT, None);
    sheet.canvas.hatch(palette::UNCUT_LINE, 6.0 * unit, 1.2 * unit, Some(&mask));
    sheet.canvas.stroke(path.as_ref(), palette::UNCUT_LINE, 0.8 * unit, None);
    for center in circled(uncut, bounds) {
        sheet.canvas.circle(view.pixel(center), 9.0 * unit, palette::UNCUT_LINE, 1.2 * unit);
    }
}

/// The middles of the places that are too small to be seen in a picture of `bounds`.
fn circled(uncut: &Uncut, bounds: &Bounds) -> impl Iterator<Item = Point> {
    let least = SMALL_PLACE * bounds.width().max(bounds.height());
    let places = uncut.places.iter().filter(|_| uncut.places.len() <= MOST_CIRCLES);
    let boxes = places.map(|place| Bounds::of_points(place.outlines.iter().flatten().copied()));
    boxes.filter(move |b| b.diagonal() < least).map(|b| b.center())
}

/// Width of the line of the first of many passes, in the picture's units.
const WIDEST_LINE: f64 = 5.4;

/// A swath is at least this many times as wide as the widest line on it.
const SWATH_TO_LINE: f64 = 3.0;

/// The path of the tool's centre: deeper passes darker and thinner, above the shallower ones, so that all are seen.
fn draw_path(scene: &Scene, depth: f64, sheet: &mut Sheet) {
    let view = sheet.view;
    let unit = sheet.unit;
    let mut steps: Vec<Vec<Segment>> = vec![Vec::new(); DEPTH_STEPS + 1];
    for motion in scene.program.motions.iter().filter(|m| m.is_feed()) {
        let below = scene.stock_top - 0.5 * (motion.from.z + motion.to.z);
        let t = if depth > 0.0 { (below / depth).clamp(0.0, 1.0) } else { 0.0 };
        let t = if t.is_finite() { t } else { 0.0 };
        steps[(t * DEPTH_STEPS as f64).round() as usize].extend(motion.trace());
    }
    // Lines must not hide the swath of a small tool.
    let swath = scene.tools.iter().map(|t| t.diameter * view.scale).fold(f64::INFINITY, f64::min);
    let thin = (swath / (WIDEST_LINE * SWATH_TO_LINE * unit)).clamp(0.3, 1.0);
    let used = steps.iter().filter(|s| !s.is_empty()).count();
    let mut rank = 0;
    for (k, elements) in steps.into_iter().enumerate().filter(|(_, s)| !s.is_empty()) {
        rank += 1;
        let width = thin * (1.4 + (WIDEST_LINE - 1.4) * (used - rank) as f64 / used as f64);
        let color = palette::depth(k as f64 / DEPTH_STEPS as f64);
        sheet.canvas.stroke(&view.elements(elements), color, width * unit, None);
    }
}
