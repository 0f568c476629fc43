//! Surfaces mended where there is no choice to make.

use std::collections::HashSet;

use super::clean::{Worth, shortened, worths};
use super::topology::{Edges, Joined, ends, have_neighbours, without_area};
use super::validate::{triangles_of, unusable};
use super::{Point, PolygonMesh, TriangleMesh};

/// Something that was mended. Vertices and polygons have the numbers that they had before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repair {
    /// A corner that followed itself is left out.
    DroppedCorner {
        /// Whose corner.
        polygon: u32,
        /// The corner.
        vertex: u32,
    },
    /// A polygon without three different corners, or without area and neighbours, is left out.
    DroppedDegenerate {
        /// Which one.
        polygon: u32,
    },
    /// A polygon that was there before is left out.
    DroppedDuplicate {
        /// Which one.
        polygon: u32,
        /// The one that is kept.
        of: u32,
    },
    /// A polygon has its corners the other way round.
    Reversed {
        /// Which one.
        polygon: u32,
    },
    /// A vertex on a border that lies exactly where an earlier one does became that one.
    Welded {
        /// Which one.
        vertex: u32,
        /// The earlier one.
        to: u32,
    },
    /// A vertex of no polygon is left out.
    DroppedVertex {
        /// Which one.
        vertex: u32,
    },
}

/// A surface without what is [repairable](super::Severity::Repairable), and what was done.
///
/// Vertices on borders that lie exactly where others do are welded (those of closed bodies that touch are not), faces that are
/// duplicates or degenerate and vertices without faces are dropped, and where neighbours are oriented against
/// each other the smaller part of their component is reversed (of two equal ones that without the first polygon). Nothing
/// else: everything that is not named keeps its order and its bits. Whether a whole component is inside out is not guessed,
/// and faces without area are kept where dropping them would open the surface.
pub fn repair(mesh: PolygonMesh) -> (PolygonMesh, Vec<Repair>) {
    if !unusable(&mesh).is_empty() {
        return (mesh, vec![]);
    }
    let (mesh, welded) = welded(mesh);
    let mut worths = worths(&mesh);
    let mut repairs = welded;
    let is_gone: HashSet<u32> = repairs
        .iter()
        .filter_map(|r| if let Repair::Welded { vertex, .. } = r { Some(*vertex) } else { None })
        .collect();
    let whole = triangles_of(&mesh, &worths);
    let have_neighbours = have_neighbours(&whole, &Edges::new(&whole), mesh.polygon_count());
    for polygon in without_area(&whole).into_iter().filter(|k| !have_neighbours[*k as usize]) {
        worths[polygon as usize] = Worth::Nothing(0);
    }
    let is_reversed = reversed(&triangles_of(&mesh, &worths), &worths);
    let mut kept = PolygonMesh::new(mesh.points.clone());
    let mut old: Vec<u32> = vec![];
    for (worth, polygon) in worths.iter().zip(0u32..) {
        match worth {
            Worth::Whole => kept.push(mesh.polygon(polygon as usize)),
            Worth::Turned(_) => match shortened(mesh.polygon(polygon as usize)) {
                Worth::Shorter(vertex, left) => {
                    repairs.push(Repair::DroppedCorner { polygon, vertex });
                    kept.push(&left);
                }
                _ => kept.push(mesh.polygon(polygon as usize)),
            },
            Worth::Shorter(vertex, left) => {
                repairs.push(Repair::DroppedCorner { polygon, vertex: *vertex });
                kept.push(left);
            }
            Worth::Nothing(_) => repairs.push(Repair::DroppedDegenerate { polygon }),
            Worth::Again(of) => repairs.push(Repair::DroppedDuplicate { polygon, of: *of }),
        }
        if worth.is_kept() {
            old.push(polygon);
        }
    }
    let mut is_used = vec![false; mesh.points.len()];
    kept.polygons().flatten().for_each(|v| is_used[*v as usize] = true);
    let mut number = vec![0u32; mesh.points.len()];
    let mut points = vec![];
    let (mut colours, mut scalars) = (vec![], vec![]);
    let mut unused = vec![];
    for (v, p) in mesh.points.iter().enumerate() {
        number[v] = points.len() as u32;
        if !is_used[v] {
            if !is_gone.contains(&(v as u32)) {
                unused.push(Repair::DroppedVertex { vertex: v as u32 });
            }
            continue;
        }
        points.push(*p);
        colours.extend(mesh.colours.get(v));
        scalars.extend(mesh.scalars.get(v));
    }
    let mut result = PolygonMesh::new(points);
    (result.colours, result.scalars) = (colours, scalars);
    for (k, polygon) in kept.polygons().enumerate() {
        let mut corners: Vec<u32> = polygon.iter().map(|v| number[*v as usize]).collect();
        if is_reversed[old[k] as usize] {
            // From the same corner, the other way round.
            corners[1..].reverse();
            repairs.push(Repair::Reversed { polygon: old[k] });
        }
        result.push(&corners);
    }
    repairs.extend(unused);
    (result, repairs)
}

/// The surface with the vertices of its borders welded that lie at exactly the same place, and which these are. The vertices
/// remain; no polygon has those that became others.
fn welded(mesh: PolygonMesh) -> (PolygonMesh, Vec<Repair>) {
    let mut sides: Vec<[u32; 2]> = Vec::new();
    for polygon in mesh.polygons() {
        let n = polygon.len();
        sides.extend((0..n).map(|k| (polygon[k], polygon[(k + 1) % n])).map(|(a, b)| [a.min(b), a.max(b)]));
    }
    sides.sort_unstable();
    let ends = sides.chunk_by(|a, b| a == b).filter(|edge| edge.len() == 1).flat_map(|edge| edge[0]).collect();
    let twice = same_places(&mesh.points, ends);
    if twice.is_empty() {
        return (mesh, vec![]);
    }
    let mut number: Vec<u32> = (0..mesh.points.len() as u32).collect();
    twice.iter().for_each(|&(vertex, to)| number[vertex as usize] = to);
    let mut result = PolygonMesh::new(mesh.points.clone());
    for polygon in mesh.polygons() {
        result.push(&polygon.iter().map(|&v| number[v as usize]).collect::<Vec<_>>());
    }
    (result.colours, result.scalars) = (mesh.colours, mesh.scalars);
    (result, twice.into_iter().map(|(vertex, to)| Repair::Welded { vertex, to }).collect())
}

/// Of some vertices those that lie exactly where an earlier one of them does, with the first of these; in order.
pub(super) fn same_places(points: &[Point], mut vertices: Vec<u32>) -> Vec<(u32, u32)> {
    // Minus zero is zero.
    let place = |v: u32| points[v as usize].coords.map(|x| (x + 0.0).to_bits());
    let key = |v: &u32| {
        let [x, y, z] = place(*v).into();
        (x, y, z, *v)
    };
    vertices.sort_unstable_by_key(key);
    vertices.dedup();
    let groups = vertices.chunk_by(|a, b| place(*a) == place(*b));
    let mut twice: Vec<(u32, u32)> =
        groups.flat_map(|group| group[1..].iter().map(|&vertex| (vertex, group[0]))).collect();
    twice.sort_unstable();
    twice
}

/// The polygons that must be reversed for each component to be consistent.
fn reversed(triangles: &TriangleMesh, worths: &[Worth]) -> Vec<bool> {
    let count = worths.len();
    let mut components = Joined::new(count);
    let mut one_sided = vec![];
    for group in Edges::new(triangles).groups() {
        let &[(_, g), (_, h)] = group else { continue };
        let (p, q) = (triangles.parents[g as usize / 3], triangles.parents[h as usize / 3]);
        if !components.join(p, q, ends(triangles, g)[0] == ends(triangles, h)[0]) {
            one_sided.push(p);
        }
    }
    let places: Vec<(u32, bool)> = (0..count as u32).map(|k| components.find(k)).collect();
    let mut odd = vec![[0u32; 2]; count];
    places.iter().for_each(|&(root, is_odd)| odd[root as usize][usize::from(is_odd)] += 1);
    // No choice of orientations makes these consistent.
    one_sided.iter().for_each(|&p| odd[places[p as usize].0 as usize] = [0; 2]);
    let is_reversed = |&(root, is_odd): &(u32, bool)| {
        let [even, odd] = odd[root as usize];
        // The root is the first polygon and even.
        if odd > even { !is_odd } else { is_odd && odd > 0 }
    };
    let mut reversed: Vec<bool> = places.iter().map(is_reversed).collect();
    for (k, worth) in worths.iter().enumerate() {
        // What is another polygon turned over remains so.
        if let Worth::Turned(of) = worth {
            reversed[k] = reversed[*of as usize];
        }
    }
    reversed
}
