//! `--method auto`: which road to the closing is taken, and why.

use anyhow::{Context as _, Result};
use indicatif::ProgressBar;

use super::MethodArg;
use super::flow::{self, PIN_EASE};
use super::pins::Field;
use crate::flow::{FlownSurface, Obstacle, OnContact, SurfaceFlow, SurfaceSettings};
use crate::mesh::{Hierarchy, NONE, Point, TriangleMesh, self_intersections, self_intersections_of};
use crate::rolling::{ClosedSurface, Conflict, Roller, SurfaceOptions, Survey, Trouble, close_surface, land_surface};

/// A flow of which more than this part of the faces that moved is not the exact result is no result: what direct leaves
/// unmoved is better than what is rough.
const MOST_OFF: f64 = 0.05;

/// Which method was used, and why.
#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Choice {
    pub used: MethodArg,
    pub because: String,
}

/// A closed surface, and how it came about.
pub(super) struct Chosen {
    pub surface: ClosedSurface,
    pub choice: Choice,
}

/// So many threads.
pub(super) fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Closes a surface directly, and by a flow that lands on the ball where that is not enough and may be had.
pub(super) fn close(
    method: MethodArg,
    mesh: &TriangleMesh,
    field: &Field,
    edge: f64,
    bar: &ProgressBar,
) -> Result<Chosen> {
    let options =
        SurfaceOptions { radius: &*field.radius, pin_distance: &*field.pin_distance, edge, threads: threads() };
    let direct = close_surface(mesh, &options)?;
    let chosen = |surface, used, because: String| Chosen { surface, choice: Choice { used, because } };
    if method == MethodArg::Direct {
        return Ok(chosen(direct, MethodArg::Direct, "it was asked for".to_owned()));
    }
    let crossings = new_crossings(mesh, &direct);
    if direct.conflicts.is_empty() && crossings == 0 {
        return Ok(chosen(direct, MethodArg::Direct, "it left nothing undone".to_owned()));
    }
    bar.set_message("flowing, as not all could be done directly");
    let flown = flow_to_the_ball(mesh, field, edge)?;
    let roller = Roller::new(mesh)?;
    let look = |surface: &ClosedSurface, ease: f64| {
        let result = TriangleMesh::new(surface.points.clone(), surface.faces.clone());
        let radius = |p| (field.radius)(p).min(ease * (field.pin_distance)(p));
        roller.survey(&result, &radius, edge, threads())
    };
    let [by_direct, by_flow] = [look(&direct, 1.0), look(&flown, PIN_EASE)];
    let says = |survey: &Survey, crossings: usize| {
        format!(
            "{} faces farther than an edge length from the exact result ({} of them where the ball finds no rest), others at most {:.2}, and {crossings} new crossings",
            survey.off.len(),
            survey.lost,
            survey.largest / edge
        )
    };
    let flow_crossings = new_crossings(mesh, &flown);
    let moved = flown.parents.iter().filter(|parent| **parent == NONE).count();
    let is_rough = by_flow.off.len() as f64 > MOST_OFF * moved as f64;
    // What direct left unmoved lies on the input, whose faces may be too large to tell in their middles what is undone.
    // A flow that moved nothing found nothing out.
    let is_better = moved > 0
        && !is_rough
        && flow_crossings == 0
        && (by_flow.off.is_empty() || by_flow.off_area < by_direct.off_area);
    let (mut direct_says, flow_says) = (says(&by_direct, crossings), says(&by_flow, flow_crossings));
    if !direct.conflicts.is_empty() {
        direct_says = format!("what is around {} places undone, and {direct_says}", direct.conflicts.len());
    }
    if crossings > 0 && !is_better {
        let because = format!("direct leaves {direct_says}, the flow {flow_says}: nothing was moved");
        return Ok(chosen(unmoved(mesh, direct.conflicts, &by_direct), MethodArg::Direct, because));
    }
    Ok(if is_better {
        let conflicts = by_flow.off.iter().map(|&place| Conflict { place, trouble: Trouble::Lost }).collect();
        let surface = ClosedSurface { conflicts, error: by_flow.largest, ..flown };
        chosen(surface, MethodArg::Flow, format!("it leaves {flow_says}; direct {direct_says}"))
    } else {
        chosen(direct, MethodArg::Direct, format!("it leaves {direct_says}; the flow {flow_says}"))
    })
}

/// The closing as far as the flow along the surface gets that lands where the ball touches and never passes through itself.
fn flow_to_the_ball(mesh: &TriangleMesh, field: &Field, edge: f64) -> Result<ClosedSurface> {
    let settings = SurfaceSettings { on_contact: OnContact::Freeze, ..SurfaceSettings::new(edge) };
    let space = flow::space(field, Some(Roller::new(mesh)?));
    let mut flowing = SurfaceFlow::new(mesh, Obstacle::CLOSING, space, &settings).context("the flow")?;
    flowing.run(f64::INFINITY);
    let FlownSurface { points, origins, faces, parents } = flowing.result();
    let flown = ClosedSurface { points, origins, faces, parents, ..ClosedSurface::default() };
    // Near pins the flow has its own radius.
    let pin_distance = |p| PIN_EASE * (field.pin_distance)(p);
    let options = SurfaceOptions { radius: &*field.radius, pin_distance: &pin_distance, edge, threads: threads() };
    Ok(land_surface(mesh, &flown, &options)?)
}

/// How many pairs of faces pass through each other where none did before.
fn new_crossings(before: &TriangleMesh, after: &ClosedSurface) -> usize {
    let mesh = TriangleMesh::new(after.points.clone(), after.faces.clone());
    let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
    let changed = (0u32..).zip(&after.parents).filter(|(_, parent)| **parent == NONE).map(|(k, _)| k);
    let found = self_intersections_of(&mesh, &hierarchy, changed);
    if found.is_empty() {
        return 0;
    }
    // Faces that crossed in the input may have been cut, and their parts cross, where they did.
    let common = |mesh: &TriangleMesh, (f, g): (u32, u32)| {
        let bounds = |[a, b, c]: [Point; 3]| (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let ((low, high), (l, h)) = (bounds(mesh.triangle(f as usize)), bounds(mesh.triangle(g as usize)));
        (low.sup(&l), high.inf(&h))
    };
    let known: Vec<(Point, Point)> = self_intersections(before).into_iter().map(|pair| common(before, pair)).collect();
    let is_known = |pair: &(u32, u32)| {
        let (low, high) = common(&mesh, *pair);
        known.iter().any(|(l, h)| (0..3).all(|k| l[k] <= high[k] && h[k] >= low[k]))
    };
    found.iter().filter(|pair| !is_known(pair)).count()
}

/// The input, and that all of it is left to do.
fn unmoved(mesh: &TriangleMesh, mut conflicts: Vec<Conflict>, survey: &Survey) -> ClosedSurface {
    if conflicts.is_empty() {
        conflicts = survey.off.iter().take(1).map(|&place| Conflict { place, trouble: Trouble::Fold }).collect();
    }
    ClosedSurface {
        points: mesh.points.clone(),
        origins: (0..mesh.points.len() as u32).collect(),
        faces: mesh.faces.clone(),
        parents: (0..mesh.faces.len() as u32).collect(),
        conflicts,
        error: 0.0,
    }
}
