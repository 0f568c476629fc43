//! What was done to a surface, for people and for programs.

use std::fmt::Write as _;

use super::choose::Choice;
use super::digits::{Places, count, number};
use super::flow::Flown;
use super::work::{Done, Input};
use super::{MethodArg, Step, WorkArgs};
use crate::flow::End;
use crate::io::mesh::MeshFormat;
use crate::mesh::{NONE, TriangleMesh};
use crate::rolling::Trouble;

/// So many conflicts are named.
const NAMED: usize = 5;

/// A volume below this part of the cube of the diagonal is nothing but rounding.
const NO_VOLUME: f64 = 1e-12;

/// The report.
#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Report {
    steps: Vec<Step>,
    method: MethodArg,
    radius_units: f64,
    /// From where to where the radius goes, if it varies.
    #[serde(skip_serializing_if = "Option::is_none")]
    radii_units: Option<[f64; 2]>,
    edge_length_units: f64,
    vertices_in: usize,
    vertices_kept: usize,
    vertices_out: usize,
    faces_in: usize,
    faces_kept: usize,
    /// Faces are those of the files: quads and larger ones count once.
    faces_out: usize,
    triangles_out: usize,
    volume_in: f64,
    volume_out: f64,
    /// The largest distance of the middle of an edge or face of the moved part from the closing, in edge lengths.
    largest_error_edge_lengths: Option<f64>,
    /// Which method each step took, and why.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    choices: Vec<Choice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<Flown>,
    repairs: usize,
    remarks: Vec<String>,
    /// So many remarks at the start were said before the work began.
    #[serde(skip)]
    said: usize,
    #[serde(skip)]
    places: Places,
    /// The volume that is nothing but rounding.
    #[serde(skip)]
    no_volume: f64,
    pub conflicts: Vec<Place>,
}

#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Place {
    place: [f64; 3],
    trouble: Trouble,
}

impl Report {
    pub fn new(args: &WorkArgs, input: &Input, steps: &[Step], done: &Done) -> Report {
        let result = TriangleMesh::new(done.points.clone(), done.faces.clone());
        let diagonal = input.triangles.diagonal();
        let has_colours = output_format(args) == Some(MeshFormat::Ply);
        let remarks = input.warnings().into_iter().chain(input.remarks(true));
        let remarks = remarks.chain(input.left_out(has_colours)).chain(lost(args, input));
        Report {
            steps: steps.to_vec(),
            method: args.method,
            radius_units: done.radius,
            radii_units: Some(done.radii).filter(|[a, b]| a != b),
            edge_length_units: done.edge,
            vertices_in: input.triangles.points.len(),
            vertices_kept: done.origins.iter().filter(|&&v| v != NONE).count(),
            vertices_out: done.points.len(),
            faces_in: input.polygons.polygon_count(),
            faces_kept: done.kept_polygons(input).iter().filter(|kept| **kept).count(),
            faces_out: done.polygon_count(input),
            triangles_out: done.faces.len(),
            volume_in: input.triangles.volume(),
            volume_out: result.volume(),
            largest_error_edge_lengths: done.error.map(|error| error / done.edge),
            choices: if args.method == MethodArg::Auto { done.choices.clone() } else { Vec::new() },
            flow: done.flown.clone(),
            repairs: input.repairs.len(),
            remarks: remarks.collect(),
            said: input.warnings().len(),
            places: Places::on(diagonal),
            no_volume: NO_VOLUME * diagonal.powi(3),
            conflicts: done
                .conflicts
                .iter()
                .map(|c| Place { place: [c.place.x, c.place.y, c.place.z], trouble: c.trouble })
                .collect(),
        }
    }

    /// Whether the result is the input, though something should have changed.
    fn is_in_vain(&self) -> bool {
        !self.conflicts.is_empty()
            && [self.vertices_kept, self.vertices_out] == [self.vertices_in; 2]
            && [self.faces_kept, self.faces_out] == [self.faces_in; 2]
    }

    /// By how much the volume changed, in words.
    fn volume(&self) -> String {
        if self.volume_in.abs() <= self.no_volume {
            return format!("volume {}, of {} before", number(self.volume_out), number(self.volume_in));
        }
        format!("volume {:+.3} %", 100.0 * (self.volume_out / self.volume_in - 1.0))
    }

    pub fn lines(&self) -> String {
        let steps: Vec<&str> = self
            .steps
            .iter()
            .map(|s| match s {
                Step::Close => "closing",
                Step::Open => "opening",
            })
            .collect();
        let radius = match self.radii_units {
            Some([least, most]) => format!("{} to {}", number(least), number(most)),
            None => number(self.radius_units),
        };
        if self.faces_out == 0 {
            return format!(
                "{} by {radius}: NOTHING is left, as the ball fits nowhere in it, and no mesh is written; give a smaller radius\n",
                steps.join(", then ")
            );
        }
        let mut text =
            format!("{} by {radius} with edges of {}: ", steps.join(", then "), number(self.edge_length_units));
        if self.is_in_vain() {
            let _ = writeln!(
                text,
                "NOTHING was changed, and it should have been: what is around {} could not be done; what is written is the input. Try another \
                 --edge-length or radius",
                count(self.conflicts.len(), "place", "places")
            );
        } else {
            let _ = writeln!(
                text,
                "{} of {} and {} of {} kept bit for bit, now {} and {}; {}",
                self.vertices_kept,
                count(self.vertices_in, "vertex", "vertices"),
                self.faces_kept,
                count(self.faces_in, "face", "faces"),
                count(self.vertices_out, "vertex", "vertices"),
                count(self.faces_out, "face", "faces"),
                self.volume()
            );
        }
        for choice in &self.choices {
            let _ = writeln!(text, "method: {}", choice.summary);
        }
        if let Some(error) = self.largest_error_edge_lengths.filter(|_| self.faces_kept < self.faces_in) {
            let _ = writeln!(
                text,
                "faces that moved are within {error:.3} edge lengths of the exact result at their middles"
            );
        }
        if let Some(flow) = &self.flow {
            let why = match flow.end {
                None => "as far as was asked",
                Some(End::Still | End::Slow) => "the limit, nothing moves any more",
                Some(End::Contact) => "STOPPED where the surface ran into itself",
                Some(End::Stalled) => {
                    "STALLED, vertices go on moving, and nothing comes of it; try another --edge-length"
                }
                Some(End::Singular) => "STOPPED, a step could not be solved; try another --edge-length or --time-step",
            };
            let _ = writeln!(text, "flow for {:.4} r² in {} steps: {why}", flow.time_r2, flow.steps);
            if let Some(&first) = flow.contacts.first() {
                let _ = writeln!(
                    text,
                    "CONTACT in {}, the first at {}: the surface crosses itself, or would if it went on",
                    count(flow.contacts.len(), "place", "places"),
                    self.places.show(first)
                );
            }
            if let Some(&first) = flow.short.first() {
                let _ = writeln!(
                    text,
                    "SHORT in {}, the first at {}: the surface is more than an edge length from the exact result",
                    count(flow.short.len(), "place", "places"),
                    self.places.show(first)
                );
            }
        }
        for remark in self.remarks.iter().skip(self.said) {
            let _ = writeln!(text, "note: {remark}");
        }
        let (done, beyond) = match self.steps.as_slice() {
            [Step::Close] => ("closed", "cut into the input"),
            [Step::Open] => ("opened", "stick out of the input"),
            _ => ("changed", "leave the side of the input that it belongs on"),
        };
        for conflict in self.conflicts.iter().take(NAMED) {
            let place = self.places.show(conflict.place);
            let what = match conflict.trouble {
                Trouble::Tear => "the surface would tear".to_owned(),
                Trouble::Fold => "the surface would fold".to_owned(),
                Trouble::Lost => "the ball finds no rest, or the surface did not get there".to_owned(),
                Trouble::Missed => "something between the corners of a face should have moved".to_owned(),
                Trouble::Dip => format!("the surface would {beyond}"),
            };
            let _ = writeln!(text, "CONFLICT at {place}: {what}; what is around it was {done} less or not at all");
        }
        if self.conflicts.len() > NAMED {
            let _ = writeln!(text, "CONFLICT: {} places in all; --format json lists them", self.conflicts.len());
        }
        text
    }
}

/// The format of the result by its name.
fn output_format(args: &WorkArgs) -> Option<MeshFormat> {
    args.output.as_deref().and_then(MeshFormat::of_path)
}

/// What of the numbers of the input is not in the result, in words.
fn lost(args: &WorkArgs, input: &Input) -> Option<String> {
    let name = input.scalar_name.as_ref()?;
    let is_ply = output_format(args) == Some(MeshFormat::Ply);
    let instead = if is_ply { ": the PLY has displacements instead" } else { "" };
    Some(format!("the numbers at the vertices of the input (`{name}`) are not in the result{instead}"))
}
