//! Everything that is wrong with a surface.

use std::f64::consts::PI;

use super::clean::{Worth, worths};
use super::intersect::{Meeting, all};
use super::repair::same_places;
use super::topology::{Edges, Joined, ends, have_neighbours, without_area};
use super::{Hierarchy, Point, PolygonMesh, Problem, TriangleMesh};

/// A component is inside out where its volume is below minus this times the cube of its diagonal: flat ones are neither.
const NO_VOLUME: f64 = 1e-12;

/// No more than so many pairs of faces that pass through each other are looked for.
pub const MOST_INTERSECTIONS: usize = 10_000;

/// All problems of a surface, kind by kind; where corners are no vertices or coordinates not finite,
/// these alone.
///
/// What [`repair`](super::repair()) leaves out (duplicates, faces without three different corners) is named, but does not count
/// for what follows: it makes no edge non-manifold.
pub fn problems(mesh: &PolygonMesh) -> Vec<Problem> {
    let mut problems = unusable(mesh);
    if !problems.is_empty() {
        return problems;
    }
    let worths = worths(mesh);
    let mut is_used = vec![false; mesh.points.len()];
    let mut again = vec![];
    for (worth, polygon) in worths.iter().zip(0u32..) {
        match worth {
            Worth::Whole => {}
            Worth::Shorter(vertex, _) => problems.push(Problem::RepeatedCorner { polygon, vertex: *vertex }),
            Worth::Nothing(vertex) => problems.push(Problem::RepeatedCorner { polygon, vertex: *vertex }),
            Worth::Again(of) => again.push(Problem::Duplicate { polygon, of: *of }),
            Worth::Turned(of) => again.push(Problem::TurnedDuplicate { polygon, of: *of }),
        }
        if worth.is_kept() {
            mesh.polygon(polygon as usize).iter().for_each(|v| is_used[*v as usize] = true);
        }
    }
    again.sort_by_key(|p| matches!(p, Problem::TurnedDuplicate { .. }));
    problems.extend(again);
    problems.extend((0u32..).zip(&is_used).filter(|(_, used)| !**used).map(|(vertex, _)| Problem::Unused { vertex }));
    surface(&triangles_of(mesh, &worths), mesh.polygon_count(), &mut problems);
    problems
}

/// The triangles of all polygons that count, with the polygons of the whole mesh as parents.
pub(super) fn triangles_of(mesh: &PolygonMesh, worths: &[Worth]) -> TriangleMesh {
    let mut cleaned = PolygonMesh::new(mesh.points.clone());
    let mut old = vec![];
    for (worth, polygon) in worths.iter().zip(0u32..) {
        match worth {
            Worth::Whole => cleaned.push(mesh.polygon(polygon as usize)),
            Worth::Shorter(_, left) => cleaned.push(left),
            _ => continue,
        }
        old.push(polygon);
    }
    let mut triangles = cleaned.triangulated();
    triangles.parents.iter_mut().for_each(|parent| *parent = old[*parent as usize]);
    triangles
}

/// What makes all further questions pointless.
pub(super) fn unusable(mesh: &PolygonMesh) -> Vec<Problem> {
    if mesh.polygon_count() == 0 {
        return vec![Problem::Empty];
    }
    let no_vertex = (0u32..).zip(mesh.polygons()).flat_map(|(polygon, corners)| {
        let missing = corners.iter().filter(|v| **v as usize >= mesh.points.len());
        missing.map(move |&vertex| Problem::NoSuchVertex { polygon, vertex })
    });
    if let Some((polygon, _)) = mesh.first_tangled() {
        let vertex = mesh.polygon(polygon)[0];
        return no_vertex.chain([Problem::Tangled { polygon: polygon as u32, vertex }]).collect();
    }
    let is_finite = |p: &Point| p.iter().all(|x| x.is_finite());
    let not_finite = (0u32..).zip(&mesh.points).filter(|(_, p)| !is_finite(p));
    no_vertex.chain(not_finite.map(|(vertex, _)| Problem::NotFinite { vertex })).collect()
}

/// The problems of triangles as a surface.
fn surface(mesh: &TriangleMesh, polygon_count: usize, problems: &mut Vec<Problem>) {
    for (&[a, b, c], &polygon) in mesh.faces.iter().zip(&mesh.parents) {
        if a == b || b == c || c == a {
            problems.push(Problem::Tangled { polygon, vertex: if b == c { b } else { a } });
        }
    }
    let edges = Edges::new(mesh);
    let parent = |h: u32| mesh.parents[h as usize / 3];
    let mut components = Joined::new(polygon_count);
    // Where the corners of triangles at one vertex hang together.
    let mut fans = Joined::new(3 * mesh.faces.len());
    let mut boundaries = Joined::new(mesh.points.len());
    let mut boundary_edges: Vec<[u32; 2]> = vec![];
    let mut is_closed = vec![true; polygon_count];
    let mut is_oriented = vec![true; polygon_count];
    let mut inconsistent: Vec<[u32; 2]> = vec![];
    for group in edges.groups() {
        let first = group[0].1;
        for &(_, h) in &group[1..] {
            let same_way = ends(mesh, first)[0] == ends(mesh, h)[0];
            let next = |h: u32| if h % 3 == 2 { h - 2 } else { h + 1 };
            let (at_start, at_end) = if same_way { (h, next(h)) } else { (next(h), h) };
            fans.join(first, at_start, false);
            fans.join(next(first), at_end, false);
        }
        match *group {
            [(_, h)] => {
                let [a, b] = ends(mesh, h);
                boundaries.join(a, b, false);
                boundary_edges.push([a, b]);
                is_closed[parent(h) as usize] = false;
            }
            [(_, g), (_, h)] => {
                let is_against = ends(mesh, g)[0] == ends(mesh, h)[0];
                let (p, q) = (parent(g), parent(h));
                if is_against {
                    inconsistent.push([p.min(q), p.max(q)]);
                    is_closed[p as usize] = false;
                }
                if !components.join(p, q, is_against) {
                    is_oriented[p as usize] = false;
                }
            }
            _ => {
                let [a, b] = ends(mesh, first);
                problems.push(Problem::NonManifoldEdge { a: a.min(b), b: a.max(b), polygons: group.len() as u32 });
                group.iter().for_each(|(_, h)| is_closed[parent(*h) as usize] = false);
            }
        }
    }
    non_manifold_vertices(mesh, &mut fans, problems);
    // What holds for one polygon holds for its component.
    let one_sided = gathered(&is_oriented, &mut components);
    inconsistent.retain(|&[p, _]| one_sided.binary_search(&components.find(p).0).is_err());
    let pair = |[polygon, neighbour]: [u32; 2]| Problem::Inconsistent { polygon, neighbour };
    problems.extend(inconsistent.into_iter().map(pair));
    problems.extend(one_sided.iter().map(|&polygon| Problem::OneSided { polygon }));
    let open = gathered(&is_closed, &mut components);
    inside_out(mesh, &mut components, &open, problems);
    let twice = same_places(&mesh.points, boundary_edges.iter().flat_map(|edge| *edge).collect());
    if let Some(&(vertex, _)) = twice.first() {
        problems.push(Problem::Unwelded { vertex, vertices: twice.len() as u32 });
    }
    let mut loops: Vec<u32> = boundary_edges.iter().map(|&[v, _]| boundaries.find(v).0).collect();
    loops.sort_unstable();
    let boundary = |edges: &[u32]| Problem::Boundary { vertex: edges[0], edges: edges.len() as u32 };
    problems.extend(loops.chunk_by(|a, b| a == b).map(boundary));
    let has_neighbour = have_neighbours(mesh, &edges, polygon_count);
    let zero = |polygon: u32| Problem::ZeroArea { polygon, is_alone: !has_neighbour[polygon as usize] };
    problems.extend(without_area(mesh).into_iter().map(zero));
    let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
    let mut pairs: Vec<(bool, [u32; 2])> = Vec::new();
    for (f, g, meeting) in all(&hierarchy, MOST_INTERSECTIONS) {
        let [p, q] = [mesh.parents[f as usize], mesh.parents[g as usize]];
        let is_flat = match meeting {
            Meeting::Through => false,
            // One body that is folded onto itself passes through itself.
            Meeting::Overlap => components.find(p).0 != components.find(q).0,
            Meeting::Same => true,
        };
        pairs.push((is_flat, [p.min(q), p.max(q)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    problems.extend(pairs.iter().map(|&(is_flat, [polygon, other])| match is_flat {
        true => Problem::Coincident { polygon, other },
        false => Problem::SelfIntersection { polygon, other },
    }));
}

/// The components of which a polygon is marked with false, in order.
fn gathered(marks: &[bool], components: &mut Joined) -> Vec<u32> {
    let marked = (0u32..).zip(marks).filter(|(_, mark)| !**mark);
    let mut found: Vec<u32> = marked.map(|(k, _)| components.find(k).0).collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn non_manifold_vertices(mesh: &TriangleMesh, fans: &mut Joined, problems: &mut Vec<Problem>) {
    let corners = mesh.faces.as_flattened();
    let mut at: Vec<(u32, u32)> = (0u32..).zip(corners).map(|(h, &v)| (v, fans.find(h).0)).collect();
    at.sort_unstable();
    at.dedup();
    let several = at.chunk_by(|a, b| a.0 == b.0).filter(|fans| fans.len() > 1);
    problems.extend(several.map(|f| Problem::NonManifoldVertex { vertex: f[0].0, fans: f.len() as u32 }));
}

/// A closed and consistent component.
struct Component {
    /// Its first polygon.
    root: u32,
    polygons: u32,
    triangles: Vec<u32>,
    low: Point,
    high: Point,
    volume: f64,
}

fn inside_out(mesh: &TriangleMesh, components: &mut Joined, open: &[u32], problems: &mut Vec<Problem>) {
    let mut roots: Vec<(u32, u32)> = (0u32..).zip(&mesh.parents).map(|(f, &p)| (components.find(p).0, f)).collect();
    roots.sort_unstable();
    let mut closed: Vec<Component> = vec![];
    for faces in roots.chunk_by(|a, b| a.0 == b.0).filter(|f| open.binary_search(&f[0].0).is_err()) {
        let triangles: Vec<u32> = faces.iter().map(|f| f.1).collect();
        let origin = mesh.triangle(triangles[0] as usize)[0];
        let mut component =
            Component { root: faces[0].0, polygons: 0, triangles: vec![], low: origin, high: origin, volume: 0.0 };
        let mut last = None;
        for &f in &triangles {
            let corners = mesh.triangle(f as usize);
            for p in &corners {
                (component.low, component.high) = (component.low.inf(p), component.high.sup(p));
            }
            let [a, b, c] = corners.map(|p| p - origin);
            component.volume += a.dot(&b.cross(&c)) / 6.0;
            // The triangles of a polygon follow each other.
            component.polygons += u32::from(last != Some(mesh.parents[f as usize]));
            last = Some(mesh.parents[f as usize]);
        }
        component.triangles = triangles;
        closed.push(component);
    }
    for component in &closed {
        let diagonal = (component.high - component.low).norm();
        if component.volume >= -NO_VOLUME * diagonal.powi(3) {
            continue;
        }
        let p = mesh.triangle(component.triangles[0] as usize)[0];
        let around = closed.iter().filter(|c| {
            c.root != component.root && c.volume > 0.0 && (0..3).all(|k| c.low[k] < p[k] && p[k] < c.high[k])
        });
        let is_cavity = around.into_iter().any(|c| winding(mesh, &c.triangles, p) > 0.5);
        if !is_cavity {
            problems.push(Problem::InsideOut { polygon: component.root, polygons: component.polygons });
        }
    }
}

/// How often a closed surface goes around a point (Van Oosterom and Strackee, 1983).
fn winding(mesh: &TriangleMesh, faces: &[u32], p: Point) -> f64 {
    let angle = |&f: &u32| {
        let [a, b, c] = mesh.triangle(f as usize).map(|q| q - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        2.0 * a.dot(&b.cross(&c)).atan2(below)
    };
    faces.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

#[cfg(test)]
mod tests;
