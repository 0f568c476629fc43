//! Vertices at which parts of a surface touch in corners only.

use std::collections::HashMap;

/// Gives every fan of polygons but the first at the vertices that are asked for a vertex of its own, numbered from `next` on;
/// which vertices they are copies of.
pub(super) fn part_fans(polygons: &mut [Vec<u32>], next: u32, is_asked: impl Fn(u32) -> bool) -> Vec<u32> {
    // The corners at each vertex, and the two neighbours there.
    let mut at: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
    for (p, polygon) in polygons.iter().enumerate() {
        for (k, &v) in polygon.iter().enumerate() {
            if is_asked(v) {
                at.entry(v).or_default().push((p, k));
            }
        }
    }
    let mut vertices: Vec<u32> = at.keys().copied().collect();
    vertices.sort_unstable();
    let mut copies = vec![];
    let mut changes: Vec<(usize, usize, u32)> = vec![];
    for v in vertices {
        let corners = &at[&v];
        let mut fan: Vec<usize> = (0..corners.len()).collect();
        let mut by_spoke: HashMap<u32, usize> = HashMap::new();
        for (i, &(p, k)) in corners.iter().enumerate() {
            let n = polygons[p].len();
            for spoke in [polygons[p][(k + 1) % n], polygons[p][(k + n - 1) % n]] {
                let other = *by_spoke.entry(spoke).or_insert(i);
                let (from, to) = (fan[i].max(fan[other]), fan[i].min(fan[other]));
                fan.iter_mut().filter(|f| **f == from).for_each(|f| *f = to);
            }
        }
        let mut roots: Vec<usize> = fan.clone();
        roots.sort_unstable();
        roots.dedup();
        for &root in roots.iter().skip(1) {
            let copy = next + copies.len() as u32;
            copies.push(v);
            changes.extend(corners.iter().zip(&fan).filter(|(_, f)| **f == root).map(|(&(p, k), _)| (p, k, copy)));
        }
    }
    for (p, k, copy) in changes {
        polygons[p][k] = copy;
    }
    copies
}
