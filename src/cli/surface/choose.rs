//! `--method auto`: which road to the closing is taken, and why.

use anyhow::{Context as _, Result};
use indicatif::ProgressBar;

use super::MethodArg;
use super::digits::count;
use super::flow::{self, PIN_EASE};
use super::pins::Field;
use crate::flow::{FlownSurface, Obstacle, OnContact, Status, SurfaceFlow, SurfaceSettings};
use crate::mesh::{Hierarchy, NONE, Point, TriangleMesh, self_intersections, self_intersections_of};
use crate::rolling::{ClosedSurface, Conflict, Roller, SurfaceOptions, Survey, Trouble, close_surface, land_surface};
use crate::threads;

/// A flow of which more than this part of the faces that moved is not the exact result is no result: what direct leaves
/// unmoved is better than what is rough.
const MOST_OFF: f64 = 0.05;

/// A flow that is tried where direct left something undone is given up after so many moves of a vertex, and so many more for each
/// vertex of the input: some seconds for small meshes.
const LEAST_MOVES: usize = 200_000;
const MOVES_PER_VERTEX: usize = 100;

/// A step counts as so many moves at least.
const LEAST_STEP: usize = 100;

/// Which method was used, and why.
#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Choice {
    pub used: MethodArg,
    /// What was found, with figures.
    pub because: String,
    /// The same in a sentence for people.
    pub summary: String,
}

/// A closed surface, and how it came about.
pub(super) struct Chosen {
    pub surface: ClosedSurface,
    pub choice: Choice,
}

/// Closes a surface directly, and by a flow that lands on the ball where that is not enough and may be had.
pub(super) fn close(
    method: MethodArg,
    mesh: &TriangleMesh,
    field: &Field,
    edge: f64,
    bar: &ProgressBar,
) -> Result<Chosen> {
    let options = SurfaceOptions {
        radius: &*field.radius,
        pin_distance: &*field.pin_distance,
        edge,
        threads: threads::available(),
    };
    let direct = close_surface(mesh, &options)?;
    let chosen = |surface, used, because: &str, summary: &str| {
        let choice = Choice { used, because: because.to_owned(), summary: summary.to_owned() };
        Chosen { surface, choice }
    };
    if method == MethodArg::Direct {
        return Ok(chosen(
            direct,
            MethodArg::Direct,
            "it was asked for",
            "the direct result is written, as was asked for",
        ));
    }
    let crossings = new_crossings(mesh, &direct);
    if direct.conflicts.is_empty() && crossings == 0 {
        let summary = "the direct result is written, with nothing left undone";
        return Ok(chosen(direct, MethodArg::Direct, "it left nothing undone", summary));
    }
    let left = format!("leaves what is around {}", count(direct.conflicts.len(), "place", "places"));
    bar.set_message("flowing, as not all could be done directly");
    let Some(flown) = flow_to_the_ball(mesh, field, edge)? else {
        let because =
            format!("direct leaves what is around {} places undone, the flow takes too long", direct.conflicts.len());
        let too_long = "that of a flow takes long and was given up (--method flow goes on as long as it takes)";
        if crossings == 0 {
            let summary = format!("the direct result is written, which {left} as it was; {too_long}");
            return Ok(chosen(direct, MethodArg::Direct, &because, &summary));
        }
        let summary = format!("the direct result would pass through itself, and {too_long}: neither is written");
        // A place that would have moved stands for all.
        let moved = direct.points.iter().zip(&direct.origins).find(|(_, origin)| **origin == NONE);
        let survey = Survey { off: moved.map(|(p, _)| *p).into_iter().collect(), ..Survey::default() };
        return Ok(chosen(unmoved(mesh, direct.conflicts, &survey), MethodArg::Direct, &because, &summary));
    };
    let roller = Roller::new(mesh)?;
    let look = |surface: &ClosedSurface, ease: f64| {
        let result = TriangleMesh::new(surface.points.clone(), surface.faces.clone());
        let radius = |p| (field.radius)(p).min(ease * (field.pin_distance)(p));
        roller.survey(&result, &radius, edge, threads::available())
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
        let summary =
            "the direct result would pass through itself, and that of a flow is no better: neither is written";
        return Ok(chosen(unmoved(mesh, direct.conflicts, &by_direct), MethodArg::Direct, &because, summary));
    }
    Ok(if is_better {
        let conflicts = by_flow.off.iter().map(|&place| Conflict { place, trouble: Trouble::Lost }).collect();
        let surface = ClosedSurface { conflicts, error: by_flow.largest, ..flown };
        let summary = format!(
            "the result of a flow is written, as the direct one {left} as it was; the flow {}",
            match by_flow.off.len() {
                0 => "leaves nothing undone".to_owned(),
                n => format!("is off in {}", count(n, "place", "places")),
            }
        );
        chosen(surface, MethodArg::Flow, &format!("it leaves {flow_says}; direct {direct_says}"), &summary)
    } else {
        let summary = format!("the direct result is written, which {left} as it was; that of a flow is no better");
        chosen(direct, MethodArg::Direct, &format!("it leaves {direct_says}; the flow {flow_says}"), &summary)
    })
}

/// The closing as far as the flow along the surface gets that lands where the ball touches and never passes through itself; nothing
/// where that takes too long.
fn flow_to_the_ball(mesh: &TriangleMesh, field: &Field, edge: f64) -> Result<Option<ClosedSurface>> {
    let settings = SurfaceSettings { on_contact: OnContact::Freeze, ..SurfaceSettings::new(edge) };
    let space = flow::space(field, Some(Roller::new(mesh)?));
    let mut flowing = SurfaceFlow::new(mesh, Obstacle::CLOSING, space, &settings).context("the flow")?;
    let most = LEAST_MOVES + MOVES_PER_VERTEX * mesh.points.len();
    let mut moves = 0;
    while flowing.step(f64::INFINITY) == Status::Going {
        moves += flowing.last_step().0.max(LEAST_STEP);
        if moves > most {
            return Ok(None);
        }
    }
    let FlownSurface { points, origins, faces, parents } = flowing.result();
    let flown = ClosedSurface { points, origins, faces, parents, ..ClosedSurface::default() };
    // Near pins the flow has its own radius.
    let pin_distance = |p| PIN_EASE * (field.pin_distance)(p);
    let options =
        SurfaceOptions { radius: &*field.radius, pin_distance: &pin_distance, edge, threads: threads::available() };
    Ok(Some(land_surface(mesh, &flown, &options)?))
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
