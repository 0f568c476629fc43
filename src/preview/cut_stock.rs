//! Pictures of stock as a program has cut it: from above, and what is gone at one depth.

use super::PreviewError;
use super::canvas::Rgba;
use super::outline::short;
use super::palette;
use super::sheet::{Entry, Sample, Sheet};
use crate::cam::{CutLevel, Event, HeightMap, Stock};
use crate::plane::{Point, Region, Ring};

/// Steps of colour in the legend.
const DEPTH_STEPS: usize = 24;

/// Heights closer to a face of the stock than this, in millimetres, are at it.
const AT_FACE: f64 = 1e-3;

/// A slope of 45 degrees towards the light or away from it changes colours by this much of their brightness.
const RELIEF: f64 = 0.3;

/// The picture of what stands on `map` as a PNG file of `size` pixels on its long side: light from the upper left, the
/// colour by depth, and the places of `events`.
///
/// # Errors
/// Where the size is absurd.
pub fn cut_stock(map: &HeightMap, events: &[Event], size: u32) -> Result<Vec<u8>, PreviewError> {
    let stock = map.stock();
    let lowest = lowest(map);
    let depth = stock.top_mm - lowest;
    let is_through = |z: f64| z < stock.bottom_mm + AT_FACE;
    let mut entries = Vec::new();
    let mut add = |sample, text: String| entries.push(Entry { sample, text });
    add(Sample::Fill(palette::PART, None), stock_text(stock));
    if depth > AT_FACE {
        let colors = (0..=DEPTH_STEPS).map(|k| palette::depth(k as f64 / DEPTH_STEPS as f64)).collect();
        add(Sample::Ramp(colors), format!("0 to {} mm deep", short(depth)));
    }
    if is_through(lowest) {
        add(Sample::Fill(palette::THROUGH, Some(palette::RULE)), "cut through".to_owned());
    }
    if !events.is_empty() {
        let what = if events.len() == 1 { "1 finding".to_owned() } else { format!("{} findings", events.len()) };
        add(Sample::Ring(palette::WRONG), what);
    }
    if stock.outline().contains(Point::origin()) {
        add(Sample::Target(palette::ORIGIN), "x 0, y 0".to_owned());
    }
    let mut sheet = Sheet::new(&stock.outline(), size, entries)?;
    let (view, unit) = (sheet.view, sheet.unit);
    let cell = map.cell();
    // Differences over less than a cell or a pixel are steps.
    let step = cell[0].max(cell[1]).max(1.0 / view.scale);
    sheet.canvas.shade(&view, |p| {
        let z = map.height_at(p)?;
        let color = match z {
            _ if z > stock.top_mm - AT_FACE => palette::PART,
            _ if is_through(z) => palette::THROUGH,
            _ => palette::depth((stock.top_mm - z) / depth),
        };
        let beside = |dx: f64, dy: f64| map.height_at(Point::new(p.x + dx * step, p.y + dy * step)).unwrap_or(z);
        let slope = (beside(1.0, -1.0) - beside(-1.0, 1.0)) / (2.0 * step);
        // Light comes from the upper left: what falls away to the lower right is dark.
        let light = 1.0 + RELIEF * slope.atan() / std::f64::consts::FRAC_PI_4;
        Some(std::array::from_fn(|k| (f64::from(color[k]) * light).clamp(0.0, 255.0) as u8))
    });
    frame(&mut sheet, stock);
    for event in events {
        let at = view.pixel(Point::new(event.x_mm, event.y_mm));
        sheet.canvas.circle(at, 8.0 * unit, palette::WHITE, 3.4 * unit);
        sheet.canvas.circle(at, 8.0 * unit, palette::WRONG, 1.8 * unit);
    }
    origin(&mut sheet, stock);
    sheet.finish("mm")
}

/// The picture of what is cut of `stock` at one depth, as a PNG file of `size` pixels on its long side.
///
/// # Errors
/// Where the size is absurd.
pub fn cut_level(level: &CutLevel, stock: &Stock, size: u32) -> Result<Vec<u8>, PreviewError> {
    let color = palette::depth((stock.top_mm - level.z_mm) / stock.thickness());
    let entry = |sample, text: String| Entry { sample, text };
    let mut entries = vec![
        entry(Sample::Fill(palette::PART, None), stock_text(stock)),
        entry(Sample::Fill(color, None), format!("cut at z {} mm: {} mm²", short(level.z_mm), short(level.area_mm2))),
    ];
    if stock.outline().contains(Point::origin()) {
        entries.push(entry(Sample::Target(palette::ORIGIN), "x 0, y 0".to_owned()));
    }
    let mut sheet = Sheet::new(&stock.outline(), size, entries)?;
    let view = sheet.view;
    sheet.canvas.fill(view.region(&outline(stock)).as_ref(), palette::PART, None);
    sheet.canvas.fill(view.polygons(&level.outlines).as_ref(), color, None);
    frame(&mut sheet, stock);
    origin(&mut sheet, stock);
    sheet.finish("mm")
}

fn lowest(map: &HeightMap) -> f64 {
    let cells = (0..map.rows()).flat_map(|row| (0..map.columns()).map(move |column| (column, row)));
    cells.map(|(column, row)| map.height(column, row)).fold(map.stock().top_mm, f64::min)
}

fn stock_text(stock: &Stock) -> String {
    let b = stock.outline();
    format!("stock {} x {} x {} mm", short(b.width()), short(b.height()), short(stock.thickness()))
}

fn outline(stock: &Stock) -> Region {
    let b = stock.outline();
    let corners = [b.min, Point::new(b.max.x, b.min.y), b.max, Point::new(b.min.x, b.max.y)];
    Region::new(vec![Ring::polygon(corners)])
}

fn frame(sheet: &mut Sheet, stock: &Stock) {
    const FRAME: Rgba = palette::KEPT;
    let lines = sheet.view.elements(outline(stock).segments());
    sheet.canvas.stroke(&lines, FRAME, sheet.unit, None);
}

fn origin(sheet: &mut Sheet, stock: &Stock) {
    if stock.outline().contains(Point::origin()) {
        let (at, unit) = (sheet.view.pixel(Point::origin()), sheet.unit);
        sheet.canvas.target(at, 5.0 * unit, palette::ORIGIN, 1.4 * unit);
    }
}
