//! A page that tells all about a program: one HTML file that needs nothing but a browser.
//!
//! Guaranteed: no network and no other files, which the page forbids itself by a policy; whatever is said in the data stands in
//! the page as text, never as markup; the same data gives the same bytes. The path moves in a canvas, drawn by a script in the
//! page from the motions as they were read back.

mod base64;
mod motions;
mod sections;
mod text;

use crate::cam::{Machine, Program, TimeSaved, Tool, ToolShape};
use crate::plane::{Point, Region};

/// All that the page tells. Places are in the machine's coordinates, in millimetres.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// What was cut.
    pub title: String,
    /// Whether nothing is wrong.
    pub is_good: bool,
    /// What is wrong, in sentences.
    pub failures: Vec<String>,
    /// What was asked for: names and values.
    pub facts: Vec<(String, String)>,
    /// The operations in their order.
    pub operations: Vec<PageOperation>,
    /// How the result will differ from the drawing, and from what was asked for.
    pub differences: Vec<Difference>,
    /// What rounding saves; `None` where that is not known.
    pub saved: Option<TimeSaved>,
    /// Seconds that all takes.
    pub seconds: f64,
    /// What a controller or a user should know of the program.
    pub findings: Vec<PageFinding>,
    /// What is unusual about the job.
    pub warnings: Vec<String>,
    /// The programs, in the order in which they run.
    pub programs: Vec<PageProgram<'a>>,
    /// What is shown under the path.
    pub outlines: Vec<Outline>,
    /// Where the top of the stock lies, z.
    pub stock_top: f64,
}

/// A row of the table of operations. Lengths are millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct PageOperation {
    /// What it is called.
    pub label: String,
    /// What it is done with.
    pub tool: String,
    /// Levels that it cuts.
    pub passes: usize,
    /// Way at a feed in the stock.
    pub cut_length: f64,
    /// How deep it goes.
    pub depth: f64,
    /// Seconds.
    pub seconds: f64,
    /// The deepest cut into what must remain, where something must.
    pub gouge: Option<f64>,
    /// Whether it does what was asked.
    pub is_good: bool,
}

/// One way in which the result differs from the drawing, or the program from what was asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The operation.
    pub operation: String,
    /// What it is about.
    pub feature: String,
    /// Where: every place that this is true of.
    pub places: Vec<Point>,
    /// What becomes of it, and by how much.
    pub amount: String,
    /// Why.
    pub why: String,
    /// What a smaller tool, or another setting, would gain.
    pub gain: String,
}

/// What lint says about a line.
#[derive(Clone, Debug, PartialEq)]
pub struct PageFinding {
    /// The file and line.
    pub place: String,
    /// Whether a controller refuses the program, or harm is done.
    pub is_error: bool,
    /// What is wrong.
    pub message: String,
    /// Who says so.
    pub source: String,
}

/// A program, as it moves and as a picture.
#[derive(Clone, Debug)]
pub struct PageProgram<'a> {
    /// What its file is called.
    pub name: String,
    /// As it was read back.
    pub program: &'a Program,
    /// The machine that runs it.
    pub machine: Machine,
    /// Its tools; where motions do not say theirs, the first.
    pub tools: Vec<PageTool>,
    /// The picture, a PNG file.
    pub picture: Option<Vec<u8>>,
}

/// An outline under the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Its area.
    pub region: Region,
    /// Whether the area must remain.
    pub remains: bool,
}

/// A tool, as the page shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct PageTool {
    /// The number that motions know it by.
    pub number: u32,
    /// What it is called.
    pub name: String,
    /// Its diameter in millimetres.
    pub diameter: f64,
    /// The same at its tip.
    pub tip: f64,
    /// How much wider it gets with every millimetre above its tip.
    pub widening: f64,
}

impl PageTool {
    /// The tool that motions know by `number`.
    pub fn new(number: u32, tool: &Tool) -> PageTool {
        let (tip, widening) = match tool.shape {
            ToolShape::Flat | ToolShape::Ball => (tool.diameter, 0.0),
            ToolShape::Cone { angle, tip_diameter } => (tip_diameter, 2.0 * (0.5 * angle).tan()),
        };
        PageTool { number, name: tool.name.clone(), diameter: tool.diameter, tip, widening }
    }
}

const STYLE: &str = include_str!("page/style.css");
/// What goes wrong is told where a test can find it; apart, so that it is there whatever becomes of the script.
const WATCH: &str = "window.onerror = (message) => { document.body.dataset.error = String(message); };";
const SCRIPT: &str = include_str!("page/script.js");

/// What the page may load: nothing. Pictures are in it, as are style and script.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The page as text.
pub fn page(page: &Page) -> String {
    let mut html = String::new();
    html.push_str("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    html.push_str(&format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n"));
    html.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    html.push_str("<meta name=\"color-scheme\" content=\"light dark\">\n");
    html.push_str(&format!(
        "<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n",
        text::escaped(&page.title)
    ));
    sections::verdict(page, &mut html);
    sections::player(page, &mut html);
    sections::differences(page, &mut html);
    sections::operations(page, &mut html);
    sections::time(page, &mut html);
    sections::findings(page, &mut html);
    sections::pictures(page, &mut html);
    html.push_str("<script type=\"application/json\" id=\"work\">");
    html.push_str(&motions::json(page));
    html.push_str(&format!("</script>\n<script>{WATCH}</script>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n"));
    html
}

#[cfg(test)]
mod tests;
