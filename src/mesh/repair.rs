//! Surfaces mended where there is no choice to make.

use super::clean::{Worth, shortened, worths};
use super::topology::{Edges, Joined, ends, have_neighbours, without_area};
use super::validate::{triangles_of, unusable};
use super::{PolygonMesh, TriangleMesh};

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
    /// A vertex of no polygon is left out.
    DroppedVertex {
        /// Which one.
        vertex: u32,
    },
}

/// A surface without what is [repairable](super::Severity::Repairable), and what was done.
///
/// Faces that are duplicates or degenerate and vertices without faces are dropped, and where neighbours are oriented against
/// each other the smaller part of their component is reversed (of two equal ones that without the first polygon). Nothing
/// else: everything that is not named keeps its order and its bits. Whether a whole component is inside out is not guessed,
/// and faces without area are kept where dropping them would open the surface.
pub fn repair(mesh: PolygonMesh) -> (PolygonMesh, Vec<Repair>) {
    if !unusable(&mesh).is_empty() {
        return (mesh, vec![]);
    }
    let mut worths = worths(&mesh);
    let mut repairs = vec![];
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
            unused.push(Repair::DroppedVertex { vertex: v as u32 });
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
