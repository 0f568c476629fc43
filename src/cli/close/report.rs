//! What was done to a drawing, for people and for programs.

use std::collections::HashMap;

use super::Work;
use crate::check::{Difference, finite_or_word};
use crate::cli::clopen::Order;
use crate::plane::{Point, Region, TopologyCount};
use crate::rolling::{Outcome, Topology};

/// Results that differ by no more than this, over the radius, differ by rounding.
const AGREES: f64 = 1e-9;

/// One of the two operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::cli) enum Operation {
    Close,
    Open,
}

/// A result, in the frame, with what is known of it.
pub(in crate::cli) struct Done {
    pub(in crate::cli) region: Region,
    /// Places where the meanings of the topology may differ.
    pub(in crate::cli) places: Vec<Point>,
    pub(in crate::cli) proved: bool,
}

impl From<Outcome> for Done {
    fn from(outcome: Outcome) -> Done {
        Done { region: outcome.region, places: outcome.differences, proved: outcome.contradictions == 0 }
    }
}

/// An ellipse in place of the disk.
#[derive(Debug, serde::Serialize)]
struct Ellipse {
    /// The first half axis is the radius.
    second_half_axis_units: f64,
    aspect: f64,
    angle_degrees: f64,
}

/// How much two results differ; the place as in SVG, y down.
#[derive(Debug, serde::Serialize)]
struct Differing {
    first: String,
    second: String,
    #[serde(serialize_with = "finite_or_word")]
    largest_units: f64,
    place_units: Option<[f64; 2]>,
    symmetric_difference_square_units: f64,
}

impl From<Difference> for Differing {
    fn from(d: Difference) -> Differing {
        Differing {
            first: d.first,
            second: d.second,
            largest_units: d.largest_units,
            place_units: d.place.map(|p| [p.x, -p.y]),
            symmetric_difference_square_units: d.symmetric_difference_units2,
        }
    }
}

/// What was done. Lengths are user units of the drawing.
#[derive(Debug, serde::Serialize)]
pub(in crate::cli) struct Report {
    /// What was done: close, open or clopen.
    operation: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    order: Option<Order>,
    topology: Topology,
    radius_units: f64,
    radius_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ellipse: Option<Ellipse>,
    vertices_in: usize,
    vertices_kept: usize,
    vertices_out: usize,
    area_in_square_units: f64,
    area_out_square_units: f64,
    topology_in: TopologyCount,
    topology_out: TopologyCount,
    /// Elements that were not chosen, and are written unchanged.
    #[serde(skip_serializing_if = "is_zero")]
    other_elements: usize,
    /// Places where keeping and merging differ (keep), or where parts were bridged (merge); x right, y down as in SVG.
    places_units: Vec<[f64; 2]>,
    pub(in crate::cli) proved: bool,
    /// How much the ways to have both bounds at once differ from each other.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    differences: Vec<Differing>,
    /// What is to be said of the flow among them.
    #[serde(skip_serializing_if = "Option::is_none")]
    flow_remark: Option<String>,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Report {
    pub(in crate::cli) fn new(operation: Operation, work: &Work, done: &Done) -> Report {
        let (input, output, r) = (work.region(), &done.region, work.radius.get());
        let places: Vec<Point> = done.places.iter().map(|p| work.point_on_page(*p)).collect();
        Report {
            operation: match operation {
                Operation::Close => "close",
                Operation::Open => "open",
            },
            order: None,
            topology: work.topology,
            radius_units: r,
            radius_mm: work.parts.chosen().mm_per_unit.map(|mm| mm * r),
            ellipse: work.stretch().map(|stretch| Ellipse {
                second_half_axis_units: r / stretch.aspect(),
                aspect: stretch.aspect(),
                angle_degrees: stretch.degrees(),
            }),
            vertices_in: input.vertex_count(),
            vertices_kept: work.kept(output),
            vertices_out: output.vertex_count(),
            area_in_square_units: work.area(input),
            area_out_square_units: work.area(output),
            topology_in: input.topology(),
            topology_out: output.topology(),
            other_elements: work.parts.parts.len() - 1,
            places_units: spread(&places, 2.0 * r).iter().map(|p| [p.x, -p.y]).collect(),
            proved: done.proved,
            differences: Vec::new(),
            flow_remark: None,
        }
    }

    /// The report of a clopening, with how much its ways differ.
    pub(in crate::cli) fn clopening(
        order: Order,
        work: &Work,
        done: &Done,
        differences: Vec<Difference>,
        flow_remark: Option<String>,
    ) -> Report {
        Report {
            operation: "clopen",
            order: Some(order),
            differences: differences.into_iter().map(Into::into).collect(),
            flow_remark,
            ..Report::new(Operation::Close, work, done)
        }
    }

    /// In words.
    pub(super) fn lines(&self) -> String {
        let name = match (self.operation, self.order) {
            (_, Some(Order::CloseOpen)) => "closed, then opened",
            (_, Some(Order::OpenClose)) => "opened, then closed",
            ("open", None) => "opened",
            (_, None) => "closed",
        };
        let mm = self.radius_mm.map_or(String::new(), |mm| format!(" ({mm:.4} mm)"));
        let ellipse = self.ellipse.as_ref().map_or(String::new(), |e| {
            format!(
                ", an ellipse with {:.6} across it, turned by {} degrees",
                e.second_half_axis_units, e.angle_degrees
            )
        });
        let count = |t: &TopologyCount| format!("{} + {}", t.components, t.holes);
        let mut text = format!(
            "{name} by {:.6} user units{mm}{ellipse}: {} of {} vertices kept bit for bit, area {:+.4} %, parts + holes {} -> {}\n",
            self.radius_units,
            self.vertices_kept,
            self.vertices_in,
            100.0 * (self.area_out_square_units / self.area_in_square_units - 1.0),
            count(&self.topology_in),
            count(&self.topology_out),
        );
        if self.other_elements > 0 {
            text += &format!("elements that were not chosen and are unchanged: {}\n", self.other_elements);
        }
        for Differing { first, second, largest_units, place_units, symmetric_difference_square_units } in
            &self.differences
        {
            text += &match place_units {
                _ if largest_units.is_infinite() => format!("nothing is left of one of {first} and {second}\n"),
                None => format!("{first} and {second} agree\n"),
                Some(_) if *largest_units <= AGREES * self.radius_units => {
                    format!("{first} and {second} agree up to rounding\n")
                }
                Some([x, y]) => format!(
                    "{first} and {second} differ by {largest_units:.6} user units at most, at ({x:.2}, {y:.2}), and by \
                     {symmetric_difference_square_units:.6} square units\n",
                ),
            };
        }
        if let Some(remark) = &self.flow_remark {
            text += &format!("{remark}\n");
        }
        if !self.places_units.is_empty() {
            const SHOWN: usize = 5;
            let places: Vec<String> =
                self.places_units.iter().take(SHOWN).map(|[x, y]| format!("({x:.2}, {y:.2})")).collect();
            let more = self.places_units.len().saturating_sub(SHOWN);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let what = match self.topology {
                Topology::Keep => "--topology merge would differ near",
                Topology::Merge => "the disk bridges distant boundary (where --topology keep may differ) near",
            };
            text += &format!("{what} {}{more}\n", places.join(" "));
        }
        if !self.proved {
            text += match self.topology {
                Topology::Keep => {
                    "NOT PROVED: outlines come too near to each other to be kept apart; --topology merge has an answer\n"
                }
                Topology::Merge => {
                    "NOT PROVED: rounding left contradictions; compare with clopen check, or change the radius slightly\n"
                }
            };
        }
        text
    }
}

/// Places at least `apart` from each other that stand for all of them.
pub(in crate::cli) fn spread(places: &[Point], apart: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = vec![];
    // Those that are kept, by squares of that side: only the nine about a place can hold one that is near it.
    let mut squares: HashMap<(i64, i64), Vec<Point>> = HashMap::new();
    for p in places {
        let (x, y) = ((p.x / apart).floor() as i64, (p.y / apart).floor() as i64);
        let about = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x.saturating_add(i), y.saturating_add(j))));
        if about.filter_map(|square| squares.get(&square)).flatten().all(|q| (p - q).norm() >= apart) {
            kept.push(*p);
            squares.entry((x, y)).or_default().push(*p);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_that_are_kept_stand_for_all() {
        let places: Vec<Point> =
            (0..5_000).map(|k| f64::from(k) * 2.399_963).map(|a| Point::new(a.cos(), a.sin()) * a.sqrt()).collect();
        let kept = spread(&places, 7.0);
        assert!(kept.len() > 50);
        for (i, p) in kept.iter().enumerate() {
            assert!(kept[..i].iter().all(|q| (p - q).norm() >= 7.0));
        }
        for p in &places {
            assert!(kept.iter().any(|q| (p - q).norm() < 7.0), "{p}");
        }
    }
}
