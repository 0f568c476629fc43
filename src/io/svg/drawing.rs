//! A drawing as read: the region, and where each of its vertices came from.

use std::sync::Arc;

use crate::plane::{self, Point, Region, VertexId};
use crate::units::DrawingScale;

use super::error::{Place, Warning};
use super::options::Curves;
use super::viewport::Page;

/// The attribute by which an element asks for a radius of its own, for itself and for all that is in it.
pub const RADIUS_ATTRIBUTE: &str = "data-clopen-radius";

/// A drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// All filled shapes united, in user units of the root (those of the view box) with the y axis pointing up: a point
    /// (x, y) of the file is (x, -y) here, both exact.
    pub region: Region,
    /// Millimetres in a user unit; `None` where neither the file nor the options say.
    pub mm_per_unit: Option<f64>,
    /// The page.
    pub page: Page,
    /// What became of circles and arcs; what is written follows it.
    pub curves: Curves,
    /// How far the chords may stray from the curves that they stand for, in user units.
    pub chord_tolerance: f64,
    /// Where the vertices come from.
    pub sources: Sources,
    /// What was left out.
    pub warnings: Vec<Warning>,
}

impl Drawing {
    /// What lengths typed for this drawing are measured by.
    pub fn scale(&self) -> DrawingScale {
        DrawingScale { mm_per_unit: self.mm_per_unit, diagonal: self.region.bounds().diagonal() }
    }
}

/// Where a vertex comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexSource {
    /// Where it is.
    pub point: Point,
    /// Index in [`Sources::elements`].
    pub element: u32,
    /// The curve that it is an inner sample of: index in [`Sources::curves`] and number of the sample from 1. A vertex
    /// at the end of a command has none.
    pub sample: Option<(u32, u32)>,
}

/// A curve command of the file, in root user units with y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Index in [`Sources::elements`].
    pub element: u32,
    /// Its shape.
    pub kind: CurveKind,
    /// The vertex where it starts.
    pub from: VertexId,
    /// The vertex where it ends.
    pub to: VertexId,
    /// Its inner samples are the `inner` vertices from this index on.
    pub first_inner: u32,
    /// How many inner samples it has.
    pub inner: u32,
    /// Its samples are at the parameters k / steps; `steps` is `inner` + 1 but where samples fell together.
    pub steps: u32,
}

/// The shape of a curve between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveKind {
    /// A Bézier curve of degree 2 with its control point.
    Quadratic(Point),
    /// A Bézier curve of degree 3 with its control points.
    Cubic(Point, Point),
    /// Part of an ellipse, by SVG's numbers.
    Elliptic {
        /// The half axes.
        radii: (f64, f64),
        /// Direction of the first axis in degrees, clockwise as y points down in a file.
        rotation: f64,
        /// How far it runs, in radians of the ellipse's parameter, positive.
        angle: f64,
        /// Whether it runs clockwise as seen on the page.
        sweep: bool,
        /// The circle, where it is one and kept as arcs: its links are this one.
        arc: Option<plane::Arc>,
    },
}

impl CurveKind {
    /// The same curve from its end to its start.
    pub fn reversed(self) -> CurveKind {
        match self {
            CurveKind::Quadratic(c) => CurveKind::Quadratic(c),
            CurveKind::Cubic(c, d) => CurveKind::Cubic(d, c),
            CurveKind::Elliptic { radii, rotation, angle, sweep, arc } => {
                let arc = arc.map(|arc| plane::Arc { turn: arc.turn.opposite(), ..arc });
                CurveKind::Elliptic { radii, rotation, angle, sweep: !sweep, arc }
            }
        }
    }
}

/// Where the vertices of a drawing come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sources {
    /// The elements that have vertices, one for each place where a `use` shows it.
    pub elements: Arc<[Place]>,
    /// For each of the elements what [`RADIUS_ATTRIBUTE`] says, as written: its own, or else that of the nearest element
    /// around it (where a `use` shows it, around that).
    pub radii: Arc<[Option<String>]>,
    /// One for each [`VertexId`].
    pub vertices: Vec<VertexSource>,
    /// The curve commands.
    pub curves: Vec<Curve>,
}

impl Sources {
    /// Where a vertex comes from.
    pub fn vertex(&self, id: VertexId) -> Option<VertexSource> {
        self.vertices.get(id.index()).copied()
    }

    /// The element that a vertex belongs to.
    pub fn place(&self, id: VertexId) -> Option<&Place> {
        self.elements.get(self.vertex(id)?.element as usize)
    }

    /// The radius that the element of a vertex asks for, as written.
    pub fn radius(&self, id: VertexId) -> Option<&str> {
        self.radii.get(self.vertex(id)?.element as usize)?.as_deref()
    }
}
