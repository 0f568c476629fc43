//! Commands that are kept, and those that are made.

use crate::io::svg::{ReadOptions, read};

use super::*;

fn path_data(d: &str) -> (Drawing, String) {
    let text = format!("<svg viewBox='0 0 9 9'><path d='{d}'/></svg>");
    let drawing = read(text.as_bytes(), &ReadOptions::default()).unwrap();
    let written = write(&drawing, &drawing.region);
    let d = written.split(" d=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    (drawing, d)
}

#[test]
fn kept_commands_are_written_as_they_were_or_turned_round() {
    // Clockwise on the page is clockwise with y up: an outer ring is turned round.
    let (_, d) = path_data("M0 4C1 5 3 5 4 4Q5 2 4 0A2 2 0 0 0 0 0.1Z");
    assert_eq!(d, "M0 4C1 5 3 5 4 4Q5 2 4 0A2.000624902374256 2.000624902374256 0 0 0 0 0.1Z");
    let (_, d) = path_data("M0 4Q2 4.5 4 4L4 0C3 -1 1 -1 0 0.1Z");
    assert_eq!(d, "M0 4Q2 4.5 4 4L4 0C3 -1 1 -1 0 0.1Z");
    let (_, d) = path_data("M0 4L0 0.1C1 -1 3 -1 4 0L4 4Q2 4.5 0 4Z");
    assert_eq!(d, "M4 4L4 0C3 -1 1 -1 0 0.1L0 4Q2 4.5 4 4Z");
}

/// The drawing's region with the sample in the middle of each curve moved off it.
fn with_moved_samples(drawing: &Drawing) -> Region {
    let middles: Vec<VertexId> =
        drawing.sources.curves.iter().filter(|c| c.inner > 0).map(|c| c.sample(c.last() / 2)).collect();
    let mut region = drawing.region.clone();
    for v in region.rings.iter_mut().flat_map(|r| &mut r.vertices) {
        if v.id.is_some_and(|id| middles.contains(&id)) {
            *v = Vertex { id: None, point: v.point + crate::plane::Vector::new(1e-3, 1e-3), ..*v };
        }
    }
    region
}

const CURVES: &str = "M0 4C1 5 3 5 4 4Q5 2 4 0A3 2.5 10 0 0 0 0.1Z";

#[test]
fn a_curve_with_a_moved_sample_is_written_as_its_two_parts() {
    // Clockwise and counterclockwise, so that the parts are written in both directions.
    for path in [CURVES, "M0 4L0 0.1A3 2.5 10 0 1 4 0Q5 2 4 4C3 5 1 5 0 4Z"] {
        let (drawing, _) = path_data(path);
        let region = with_moved_samples(&drawing);
        let written = write(&drawing, &region);
        let count = |c| written.split(" d=\"").nth(1).unwrap().matches(c).count();
        // Two chords at each moved sample, and the closing line is the Z or a line.
        assert_eq!((count('C'), count('Q'), count('A')), (2, 2, 2), "{written}");
        assert!((6..=7).contains(&count('L')), "{written}");
        // The parts are the curves: their samples are found again, each bit of them.
        let again = crate::io::svg::read_alike(written.as_bytes(), &ReadOptions::default(), &drawing).unwrap();
        let points: Vec<Point> = again.region.rings.iter().flat_map(|r| &r.vertices).map(|v| v.point).collect();
        assert_eq!(points.len(), region.vertex_count());
        assert!(region.rings[0].vertices.iter().all(|v| points.contains(&v.point)));
        // Sampled by themselves, too, they stray no farther than chords may.
        let alone = read(written.as_bytes(), &ReadOptions::default()).unwrap();
        let index = crate::plane::BoundaryIndex::new(&region);
        let samples = alone.region.rings.iter().flat_map(|r| &r.vertices).map(|v| index.distance(v.point));
        let worst = samples.fold(0.0, f64::max);
        assert!(worst <= drawing.chord_tolerance, "{worst}");
    }
}

#[test]
fn a_part_of_an_ellipse_near_half_a_turn_is_written_in_two() {
    let (drawing, _) = path_data("M0 4A4 2 0 0 1 8 4Z");
    let mut region = drawing.region.clone();
    let last = drawing.sources.curves[0].sample(drawing.sources.curves[0].inner);
    region.rings[0].vertices.retain(|v| v.id != Some(last));
    let written = write(&drawing, &region);
    assert_eq!(written.matches('A').count(), 2, "{written}");
    let again = read(written.as_bytes(), &ReadOptions::default()).unwrap();
    let step = PI / f64::from(drawing.sources.curves[0].steps);
    assert!((again.region.area() - region.area()).abs() < step * step, "{written}");
}

#[test]
fn of_polygons_the_vertices_are_written() {
    let text = format!("<svg viewBox='0 0 9 9'><path d='{CURVES}'/><circle cx='7' cy='7' r='1'/></svg>");
    let options = ReadOptions { curves: Curves::Polygon, ..ReadOptions::default() };
    let drawing = read(text.as_bytes(), &options).unwrap();
    let written = write(&drawing, &drawing.region);
    let data = written.split(" d=\"").nth(1).unwrap();
    assert!(!data.contains(['C', 'Q', 'A']));
    let again = read(written.as_bytes(), &options).unwrap();
    let points =
        |d: &Drawing| -> Vec<Point> { d.region.rings.iter().flat_map(|r| &r.vertices).map(|v| v.point).collect() };
    let (first, second) = (points(&drawing), points(&again));
    assert_eq!(first.len(), second.len());
    assert!(first.iter().all(|p| second.contains(p)));
}

#[test]
fn arcs_near_half_a_turn_are_written_in_two() {
    let text = "<svg viewBox='0 0 9 9'><circle cx='4' cy='4' r='2'/></svg>";
    let drawing = read(text.as_bytes(), &ReadOptions::default()).unwrap();
    let mut region = drawing.region.clone();
    // Half circles without identity.
    region.rings[0].vertices = region.rings[0].vertices.iter().step_by(2).map(|v| Vertex { id: None, ..*v }).collect();
    let written = write(&drawing, &region);
    assert_eq!(written.matches('A').count(), 4);
    let again = read(written.as_bytes(), &ReadOptions::default()).unwrap();
    assert!((again.region.area() - 4.0 * PI).abs() < 1e-14);
    assert!(!written.contains("-0 ") && !written.contains("-0A"));
}
