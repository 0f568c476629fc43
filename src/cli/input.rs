//! Reading what a command works on.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};

use super::output;
use crate::gcode::{Dialect, HeaderStock};
use crate::io::svg::{
    self, Curves, DEFAULT_FLATTEN, Drawing, Page, Parts, ReadOptions, Selection, Shapes, Strokes, Warning,
};
use crate::plane::{Point, Region, Stretch};
use crate::units::{DrawingScale, Length};

/// Files larger than this are read by no command.
const LARGEST_FILE: u64 = u32::MAX as u64;

/// What says no size, as pipes and devices do, may be without end: no more than this is read of it.
const LARGEST_STREAM: u64 = 1 << 30;

/// The bytes of a file, or of standard input where the name is `-`.
///
/// # Errors
/// Names the file. Where it is larger than any drawing or mesh, or without end, it is not read to the end.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    if path == Path::new("-") {
        return read_up_to(std::io::stdin().lock(), LARGEST_STREAM, Path::new("standard input"));
    }
    if path.is_dir() {
        bail!("{}: this is a folder; name a file in it", path.display());
    }
    let cannot = || format!("{}: cannot be read", path.display());
    let file = std::fs::File::open(path).with_context(cannot)?;
    let about = file.metadata().with_context(cannot)?;
    let most = if about.is_file() { LARGEST_FILE } else { LARGEST_STREAM };
    if about.len() > most {
        return Err(too_large(path, most));
    }
    read_up_to(file, most, path)
}

/// All bytes of a stream, of which there may be no more than `most`.
fn read_up_to(stream: impl std::io::Read, most: u64, path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    stream.take(most + 1).read_to_end(&mut bytes).with_context(|| format!("{}: cannot be read", path.display()))?;
    if bytes.len() as u64 > most { Err(too_large(path, most)) } else { Ok(bytes) }
}

fn too_large(path: &Path, most: u64) -> anyhow::Error {
    let gibibytes = most.div_ceil(1 << 30);
    anyhow::anyhow!("{}: more than {gibibytes} GiB: name a smaller file, or for a mesh decimate it", path.display())
}

/// The text of a program.
///
/// # Errors
/// Names the file.
pub(super) fn read_text(path: &Path) -> Result<String> {
    into_text(read_bytes(path)?, path)
}

/// The text of a program that was read from `path`.
///
/// # Errors
/// Names the file.
pub(super) fn into_text(bytes: Vec<u8>, path: &Path) -> Result<String> {
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        anyhow::anyhow!("{}: this is not text (byte {at}); name a G-code program", path.display())
    })
}

/// A length of a program, in millimetres: there is no drawing that user units or per cent could refer to.
///
/// # Errors
/// Names the option.
pub(super) fn millimetres(length: Length, option: &str) -> Result<f64> {
    let no_drawing = DrawingScale { mm_per_unit: None, diagonal: 0.0 };
    length
        .to_millimetres(&no_drawing)
        .map_err(|_| anyhow::anyhow!("{option} needs a physical length, for example 3mm; {length} is none"))
}

/// z of the top of the stock in millimetres: what was typed, else what the header of a program of clopen says, else 0.
///
/// # Errors
/// Where the typed length makes no sense.
pub(super) fn stock_top(typed: Option<Length>, program: &str) -> Result<f64> {
    match typed {
        Some(length) => millimetres(length, "--stock-top"),
        None => Ok(HeaderStock::of(program).map_or(0.0, |stock| stock.top)),
    }
}

/// The dialect that was asked for, by its name or by a file (`.toml`).
///
/// # Errors
/// Lists the names, or names the file and the key that is wrong.
pub(super) fn dialect(asked: &str) -> Result<Dialect> {
    let Some(path) = dialect_file(asked) else { return Ok(Dialect::named(asked)?.clone()) };
    // A name in a program is one word of ASCII.
    let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let name: String = stem.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
    Dialect::parse(&read_text(&path)?, &name).with_context(|| format!("{}: this is no dialect", path.display()))
}

/// The file of the dialect that was asked for; `None` for one that is built in.
pub(super) fn dialect_file(asked: &str) -> Option<PathBuf> {
    let path = Path::new(asked);
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")).then(|| path.to_path_buf())
}

/// The dialect that a job file asks for, and its file where it has one: files are looked for beside the job.
///
/// # Errors
/// As [`dialect`].
pub(super) fn dialect_beside(asked: &str, job: &Path) -> Result<(Dialect, Option<PathBuf>)> {
    let beside = job.parent().map(|folder| folder.join(asked));
    match beside {
        Some(path) if asked.to_ascii_lowercase().ends_with(".toml") && path.is_file() => {
            Ok((dialect(&path.to_string_lossy())?, Some(path)))
        }
        _ => Ok((dialect(asked)?, dialect_file(asked))),
    }
}

/// How a drawing is read.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Reading")]
pub(super) struct ReadArgs {
    /// User units in an inch, for a drawing that says no physical size (SVG editors: 96, 90 or 72) or a wrong one
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    dpi: Option<f64>,
    /// Scale the drawing so that its filled part is this wide
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    width: Option<Length>,
    /// Take strokes as areas
    #[arg(long)]
    strokes: bool,
    /// A font file to set text in, before those of the system; may be given more than once
    #[arg(long = "font", value_name = "FILE")]
    fonts: Vec<PathBuf>,
    /// How far chords may stray from curves that are no circles, in parts of the larger side of the largest shape
    #[arg(long, value_name = "NUMBER", default_value_t = DEFAULT_FLATTEN, allow_hyphen_values = true)]
    flatten: f64,
    /// What becomes of circles and arcs
    #[arg(long, value_enum, default_value_t = CurvesArg::Arcs)]
    curves: CurvesArg,
}

/// Which elements of a drawing a command works on.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Elements")]
pub(super) struct SelectionArgs {
    /// Work on this element alone, by its id, or on all that is in this group; may be given more than once. The other
    /// elements are written unchanged
    #[arg(long = "only", value_name = "ID")]
    only: Vec<String>,
    /// Leave this element, or all that is in this group, unchanged; may be given more than once
    #[arg(long = "except", value_name = "ID")]
    except: Vec<String>,
}

impl SelectionArgs {
    pub(super) fn selection(&self) -> Selection {
        Selection { only: self.only.clone(), except: self.except.clone() }
    }
}

/// `--curves`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CurvesArg {
    /// They stay true arcs, and smooth curves stay smooth
    Arcs,
    /// Every curve becomes a polygon with real corners, for comparison with tools that know polygons only
    Polygon,
}

impl ReadArgs {
    /// Reads a drawing and says on standard error what of it was left out.
    ///
    /// # Errors
    /// Names the file, and where in it the trouble is.
    pub(super) fn read(&self, path: &Path) -> Result<Drawing> {
        self.read_from(&read_bytes(path)?, path)
    }

    /// Reads a drawing from the bytes of `path`, as [`ReadArgs::read`] does.
    ///
    /// # Errors
    /// Names the file, and where in it the trouble is.
    pub(super) fn read_from(&self, bytes: &[u8], path: &Path) -> Result<Drawing> {
        let drawing = svg::read(bytes, &self.options()?).with_context(|| path.display().to_string())?;
        Ok(Self::with_warnings(path, drawing))
    }

    /// Reads a drawing in parts, for work in the frame of `stretch` where it is given.
    ///
    /// # Errors
    /// As [`ReadArgs::read`], and where the selection means nothing for the drawing.
    pub(super) fn read_parts(&self, path: &Path, selection: &Selection, stretch: Option<&Stretch>) -> Result<Parts> {
        self.read_parts_from(&read_bytes(path)?, path, selection, stretch)
    }

    /// Reads a drawing in parts from the bytes of `path`, as [`ReadArgs::read_parts`] does.
    ///
    /// # Errors
    /// As [`ReadArgs::read_parts`].
    pub(super) fn read_parts_from(
        &self,
        bytes: &[u8],
        path: &Path,
        selection: &Selection,
        stretch: Option<&Stretch>,
    ) -> Result<Parts> {
        let mut options = self.options()?;
        if let Some(stretch) = stretch {
            // Circles are none in the frame; and what strays from a curve may stray farther there, or when it is back.
            options.flatten /= stretch.largest_factor();
            if options.curves == Curves::Arcs {
                options.curves = Curves::Chords;
            }
        }
        let read = if selection.is_everything() {
            svg::read(bytes, &options).map(Parts::from)
        } else {
            svg::read_parts(bytes, &options, selection)
        };
        let parts = read.with_context(|| path.display().to_string())?;
        Self::say_warnings(path, &parts.chosen().warnings);
        Ok(parts)
    }

    /// Reads a drawing shape by shape.
    ///
    /// # Errors
    /// As [`ReadArgs::read`].
    pub(super) fn read_shapes(&self, path: &Path) -> Result<Shapes> {
        let shapes =
            svg::read_shapes(&read_bytes(path)?, &self.options()?).with_context(|| path.display().to_string())?;
        Self::say_warnings(path, &shapes.warnings);
        Ok(shapes)
    }

    /// The area of an element of the drawing that the bytes of `path` hold, painted or not.
    ///
    /// # Errors
    /// Names the file; where it has no such element, the one with the nearest name.
    pub(super) fn read_area(&self, bytes: &[u8], path: &Path, id: &str) -> Result<Region> {
        svg::read_area(bytes, &self.options()?, id).with_context(|| path.display().to_string())
    }

    /// Reads a drawing that was made from `other`, so that what was kept has the same vertices in both.
    ///
    /// # Errors
    /// As [`ReadArgs::read`].
    pub(super) fn read_alike(&self, path: &Path, other: &Drawing) -> Result<Drawing> {
        let bytes = read_bytes(path)?;
        let drawing = svg::read_alike(&bytes, &self.options()?, other).with_context(|| path.display().to_string())?;
        Ok(Self::with_warnings(path, drawing))
    }

    /// The middles of shapes that lie wholly on others, in user units; of a drawing that has been read, so that errors and warnings
    /// have been told.
    pub(super) fn covered(&self, path: &Path) -> Vec<Point> {
        let read = || svg::read_shapes(&read_bytes(path).ok()?, &self.options().ok()?).ok();
        read().map_or_else(Vec::new, |shapes| shapes.covered(&(0..shapes.shapes.len()).collect::<Vec<_>>()))
    }

    /// What is to be known of the scale of a drawing for a machine: a size without a unit is often meant in millimetres.
    pub(super) fn scale_note(&self, page: &Page) -> Option<&'static str> {
        let is_said = self.dpi.is_some() || self.width.is_some();
        (!is_said && page.has_size_without_unit()).then_some(
            "the drawing's width and height have no unit and are taken for 1/96 inch each: --dpi 25.4 takes them for millimetres, \
             --width says how wide the part is, and --dpi 96 that all is well",
        )
    }

    fn with_warnings(path: &Path, drawing: Drawing) -> Drawing {
        Self::say_warnings(path, &drawing.warnings);
        drawing
    }

    fn say_warnings(path: &Path, warnings: &[Warning]) {
        for warning in warnings {
            output::say(&format!("clopen: {}: {warning}\n", path.display()));
        }
    }

    fn options(&self) -> Result<ReadOptions> {
        let width_mm = self.width.map(|w| millimetres(w, "--width")).transpose()?;
        Ok(ReadOptions {
            flatten: self.flatten,
            curves: match self.curves {
                CurvesArg::Arcs => Curves::Arcs,
                CurvesArg::Polygon => Curves::Polygon,
            },
            strokes: if self.strokes { Strokes::Areas } else { Strokes::Ignore },
            dpi: self.dpi,
            width_mm,
            fonts: self.fonts.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_end_is_read_up_to_a_limit() {
        let name = Path::new("endless");
        let error = read_up_to(std::io::repeat(7), 1000, name).unwrap_err();
        assert!(error.to_string().starts_with("endless: more than"), "{error}");
        assert_eq!(read_up_to(&[7u8; 1000][..], 1000, name).unwrap(), [7; 1000]);
    }
}
