//! What an operation works on: the chosen part of a drawing, in a frame where the structuring element is a disk.

use std::borrow::Cow;

use anyhow::{Context as _, Result, bail};

use super::{CloseArgs, Operation};
use crate::io::svg::{self, Parts};
use crate::plane::{Bounds, Point, Region, Stretch, Stretched};
use crate::rolling::{self, Outcome, Topology};
use crate::units::{Length, Radius};

/// Sagitta of the chords by which the arcs of ellipses are measured, over the smaller half axis.
const FLATNESS: f64 = 1e-5;

/// A drawing made ready.
pub(in crate::cli) struct Work {
    pub(in crate::cli) parts: Parts,
    pub(in crate::cli) radius: Radius,
    pub(in crate::cli) topology: Topology,
    /// The chosen part in the frame of an ellipse; none for a disk.
    stretched: Option<Stretched>,
    /// A box around the whole drawing, in the frame, where the work is on some of its elements.
    whole: Option<Bounds>,
}

impl Work {
    /// Reads what `args` name.
    ///
    /// # Errors
    /// Where the drawing cannot be read, or radius, ellipse or selection mean nothing for it.
    pub(super) fn new(args: &CloseArgs) -> Result<Work> {
        let stretch = match args.aspect {
            Some(aspect) => Some(Stretch::new(aspect, args.angle.unwrap_or(0.0))?).filter(|s| !s.is_round()),
            None => None,
        };
        let parts = args.reading.read_parts(&args.input, &args.selection.selection(), stretch.as_ref())?;
        let units = args.radius.to_user_units(&parts.scale()).context("--radius")?;
        let radius =
            Radius::new(units).map_err(|_| anyhow::anyhow!("--radius {}: it must be above zero", args.radius))?;
        let bounds = parts.bounds();
        refuse_absurd(radius, args.radius, "--radius", bounds.diagonal())?;
        if let Some(stretch) = &stretch {
            refuse_absurd_ellipse(radius, stretch.aspect(), args.radius, bounds.diagonal())?;
        }
        let drawing = parts.chosen();
        let stretched =
            stretch.map(|stretch| Stretched::new(&drawing.region, stretch, &bounds, drawing.chord_tolerance));
        let is_whole = args.selection.selection().is_everything();
        let whole = (!is_whole).then(|| stretched.as_ref().map_or(bounds, Stretched::bounds));
        Ok(Work { parts, radius, topology: args.topology.into(), stretched, whole })
    }

    /// The ellipse, where it is no disk.
    pub(in crate::cli) fn stretch(&self) -> Option<&Stretch> {
        self.stretched.as_ref().map(Stretched::stretch)
    }

    /// What to work on, in the frame.
    pub(in crate::cli) fn region(&self) -> &Region {
        self.stretched.as_ref().map_or(&self.parts.chosen().region, Stretched::region)
    }

    /// Closes or opens a region of the frame.
    pub(in crate::cli) fn apply(&self, operation: Operation, region: &Region) -> Outcome {
        let (radius, topology) = (self.radius, self.topology);
        match (operation, &self.whole) {
            (Operation::Close, None) => rolling::close(region, radius, topology),
            (Operation::Open, None) => rolling::open(region, radius, topology),
            (Operation::Close, Some(whole)) => rolling::close_within(region, radius, topology, whole),
            (Operation::Open, Some(whole)) => rolling::open_within(region, radius, topology, whole),
        }
    }

    /// The drawing with a region of the frame in place of what was chosen.
    pub(super) fn svg(&self, region: &Region) -> String {
        svg::write_parts(&self.parts, region, self.stretched.as_ref())
    }

    /// How many vertices of a region of the frame are vertices of the drawing.
    pub(super) fn kept(&self, region: &Region) -> usize {
        let vertices = region.rings.iter().flat_map(|r| &r.vertices);
        match &self.stretched {
            None => vertices.filter(|v| v.id.is_some()).count(),
            Some(stretched) => vertices.filter(|v| stretched.restored(v).id.is_some()).count(),
        }
    }

    /// A region of the frame as it is on the page, with chords in place of arcs of ellipses.
    pub(in crate::cli) fn on_page<'r>(&self, region: &'r Region) -> Cow<'r, Region> {
        match &self.stretched {
            None => Cow::Borrowed(region),
            Some(stretched) => {
                let smaller = self.radius.get() / stretched.stretch().aspect().max(1.0);
                Cow::Owned(stretched.flattened(region, FLATNESS * smaller))
            }
        }
    }

    /// The area on the page of a region of the frame.
    pub(super) fn area(&self, region: &Region) -> f64 {
        self.stretched.as_ref().map_or_else(|| region.area(), |stretched| stretched.area(region))
    }

    /// A point of the frame on the page, y up.
    pub(super) fn point_on_page(&self, p: Point) -> Point {
        self.stretched.as_ref().map_or(p, |stretched| stretched.out_of_frame(p))
    }
}

/// Radii from the smallest to the largest of these, in diagonals of the drawing, make sense: beyond them coordinates do not
/// tell the disk from a point or a line.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-6..=1e3;

/// Refuses radii that are slips of the unit.
///
/// # Errors
/// Names the option.
pub(in crate::cli) fn refuse_absurd(radius: Radius, typed: Length, option: &str, diagonal: f64) -> Result<()> {
    let relative = radius.get() / diagonal;
    if !SENSIBLE.contains(&relative) {
        bail!(
            "{option} {typed} is {relative:.1e} of the drawing's diagonal ({diagonal:.4} user units): is the unit right? \
             2% means two hundredths of the diagonal"
        );
    }
    Ok(())
}

fn refuse_absurd_ellipse(radius: Radius, aspect: f64, typed: Length, diagonal: f64) -> Result<()> {
    let second = radius.get() / diagonal / aspect;
    if !SENSIBLE.contains(&second) {
        bail!(
            "--radius {typed} with --aspect {aspect} makes the other half axis {second:.1e} of the drawing's diagonal \
             ({diagonal:.4} user units): try an aspect nearer to 1"
        );
    }
    Ok(())
}
