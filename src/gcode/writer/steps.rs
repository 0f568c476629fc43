//! Steps of several tools as one program, or as one for each tool.

use super::{WriteError, WriteOptions, Writer};
use crate::cam::{OPERATION_COMMENT, Step, Tool, Toolpath};
use crate::gcode::comment::comment_lines;
use crate::gcode::{Dialect, Units};

/// One of the programs of a job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramFile {
    /// What is added to the name of the job's file: nothing, or `-3-t2` for the third program, of tool 2: by name they sort as they are run.
    pub suffix: String,
    /// The program.
    pub text: String,
}

/// A step as the writer sees it: a toolpath alone has neither name nor tool.
#[derive(Clone, Copy)]
struct Part<'a> {
    label: Option<&'a str>,
    tool: Option<&'a Tool>,
    toolpath: &'a Toolpath,
}

impl<'a> Part<'a> {
    fn of(step: &'a Step) -> Part<'a> {
        Part { label: Some(&step.label), tool: Some(&step.tool), toolpath: &step.toolpath }
    }

    fn tool_number(&self) -> Option<u32> {
        self.tool.map(|t| t.number)
    }
}

/// The program of `toolpath`, beginning with `header` as comments.
///
/// # Errors
/// Where a coordinate or a rate cannot be written.
pub fn write(
    toolpath: &Toolpath,
    header: &[String],
    dialect: &Dialect,
    options: WriteOptions,
) -> Result<String, WriteError> {
    compose(&[Part { label: None, tool: None, toolpath }], header, dialect, options)
}

/// One program of all `steps`, beginning with `header` as comments.
///
/// A program of one tool takes it to be in the spindle. With several, every tool is asked for, the first too.
///
/// # Errors
/// Where a coordinate or a rate cannot be written, and where there are several tools and the dialect cannot change them:
/// see [`write_files`].
pub fn write_steps(
    steps: &[Step],
    header: &[String],
    dialect: &Dialect,
    options: WriteOptions,
) -> Result<String, WriteError> {
    let parts: Vec<Part> = steps.iter().map(Part::of).collect();
    compose(&parts, header, dialect, options)
}

/// The programs of `steps`: one, where the dialect can change tools or there is but one tool; otherwise one for each run of
/// steps with the same tool, in the order in which they have to be run, each complete.
///
/// # Errors
/// Where a coordinate or a rate cannot be written.
pub fn write_files(
    steps: &[Step],
    header: &[String],
    dialect: &Dialect,
    options: WriteOptions,
) -> Result<Vec<ProgramFile>, WriteError> {
    let runs: Vec<&[Step]> = steps.chunk_by(|a, b| a.tool.number == b.tool.number).collect();
    if runs.len() < 2 || !dialect.tool_change.is_empty() {
        return Ok(vec![ProgramFile { suffix: String::new(), text: write_steps(steps, header, dialect, options)? }]);
    }
    let mut files: Vec<ProgramFile> = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        let number = run[0].tool.number;
        let mut head = header.to_vec();
        head.push(format!("program {} of {}", index + 1, runs.len()));
        files.push(ProgramFile {
            suffix: format!("-{}-t{number}", index + 1),
            text: write_steps(run, &head, dialect, options)?,
        });
    }
    Ok(files)
}

fn compose(parts: &[Part], header: &[String], dialect: &Dialect, options: WriteOptions) -> Result<String, WriteError> {
    let Some(last) = parts.last() else { return Err(WriteError::Empty) };
    if !dialect.units.contains(&options.units) {
        let unit = match options.units {
            Units::Millimetres => "millimetres",
            Units::Inches => "inches",
        };
        return Err(WriteError::Units { dialect: dialect.name.clone(), unit });
    }
    let mut tools: Vec<&Tool> = Vec::new();
    for tool in parts.iter().filter_map(|p| p.tool) {
        if tools.iter().all(|t| t.number != tool.number) {
            tools.push(tool);
        }
    }
    if tools.len() > 1 && dialect.tool_change.is_empty() {
        return Err(WriteError::NoToolChange { dialect: dialect.name.clone(), count: tools.len() });
    }
    let mut writer = Writer::new(dialect, options);
    for text in header.iter().cloned().chain(tools.iter().map(|t| t.comment())) {
        writer.comment(&text);
    }
    writer.line(if options.units == Units::Millimetres { "G21" } else { "G20" });
    for words in &dialect.preamble {
        writer.line(words);
    }
    writer.corner_tolerance()?;
    let mut before: Option<&Part> = None;
    for part in parts {
        let is_change = tools.len() > 1 && before.is_none_or(|b| b.tool_number() != part.tool_number());
        if let Some(before) = before.filter(|_| is_change) {
            writer.rest(before.toolpath)?;
        }
        if let Some(label) = part.label {
            writer.comment(&format!("{OPERATION_COMMENT}{label}"));
        }
        if let Some(number) = part.tool_number().filter(|_| is_change) {
            writer.change_tool(number);
        }
        writer.step(part.toolpath)?;
        before = Some(part);
    }
    writer.rest(last.toolpath)?;
    for words in &dialect.program_end {
        writer.line(words);
    }
    Ok(writer.text)
}

impl Writer<'_> {
    fn comment(&mut self, text: &str) {
        for line in comment_lines(text, self.dialect) {
            self.line(&line);
        }
    }

    /// Asks for a tool; afterwards nothing is known of where it is.
    fn change_tool(&mut self, number: u32) {
        let dialect = self.dialect;
        let lines = dialect.tool_change.iter().chain(std::iter::once(&dialect.tool_length_offset));
        for words in lines.filter(|l| !l.is_empty()) {
            self.line(&words.replace("{number}", &number.to_string()));
        }
        self.at = [None, None, if dialect.has_depth() { None } else { Some(0) }];
        self.feed = None;
        self.is_engaged = None;
    }

    /// Does what one toolpath says, from its safe height on.
    fn step(&mut self, toolpath: &Toolpath) -> Result<(), WriteError> {
        self.part_side = toolpath.part_side;
        self.cut_feed = toolpath.settings.feed.mm_per_min();
        self.plunge_feed = toolpath.settings.plunge_feed.mm_per_min();
        self.rapid_z(toolpath.settings.safe_height, 0)?;
        self.start_spindle(&toolpath.settings)?;
        toolpath.moves.iter().skip(1).try_for_each(|motion| self.motion(motion))
    }

    /// Leaves the work: z up, spindle off.
    fn rest(&mut self, toolpath: &Toolpath) -> Result<(), WriteError> {
        self.rapid_z(toolpath.settings.safe_height, toolpath.contour_count)?;
        self.stop_spindle()
    }
}
