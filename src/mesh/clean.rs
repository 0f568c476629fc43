//! Polygons that a surface can do without.

use super::PolygonMesh;

/// What a polygon is worth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Worth {
    /// It is a part of the surface.
    Whole,
    /// It has this corner twice in a row, or more such; these are left.
    Shorter(u32, Vec<u32>),
    /// It has fewer than three corners, of which this one is repeated.
    Nothing(u32),
    /// It is this earlier one again.
    Again(u32),
    /// It is this earlier one, turned over.
    Turned(u32),
}

impl Worth {
    /// Whether something of the polygon is left.
    pub fn is_kept(&self) -> bool {
        !matches!(self, Worth::Nothing(_) | Worth::Again(_))
    }
}

/// The worth of each polygon.
pub(super) fn worths(mesh: &PolygonMesh) -> Vec<Worth> {
    let mut worths: Vec<Worth> = mesh.polygons().map(shortened).collect();
    // The corners from the least one on, in the direction of its lesser neighbour.
    let mut keys: Vec<u32> = vec![];
    let mut named: Vec<(usize, usize, bool, u32)> = vec![];
    for (k, worth) in worths.iter().enumerate() {
        let corners = match worth {
            Worth::Whole => mesh.polygon(k),
            Worth::Shorter(_, left) => left,
            _ => continue,
        };
        let n = corners.len();
        let least = (0..n).min_by_key(|&i| corners[i]).unwrap_or(0);
        let is_forward = corners[(least + 1) % n] <= corners[(least + n - 1) % n];
        let step = if is_forward { 1 } else { n - 1 };
        let start = keys.len();
        keys.extend((0..n).map(|i| corners[(least + i * step) % n]));
        named.push((start, keys.len(), is_forward, k as u32));
    }
    let key = |entry: &(usize, usize, bool, u32)| &keys[entry.0..entry.1];
    named.sort_by(|a, b| key(a).cmp(key(b)).then(a.3.cmp(&b.3)));
    for same in named.chunk_by(|a, b| key(a) == key(b)) {
        let first = same[0];
        let mut turned = None;
        for other in &same[1..] {
            worths[other.3 as usize] = match turned {
                _ if other.2 == first.2 => Worth::Again(first.3),
                Some(earlier) => Worth::Again(earlier),
                None => {
                    turned = Some(other.3);
                    Worth::Turned(first.3)
                }
            };
        }
    }
    worths
}

/// What is left of a polygon without corners that follow themselves.
pub(super) fn shortened(polygon: &[u32]) -> Worth {
    let n = polygon.len();
    let repeated = (0..n).find(|&k| polygon[k] == polygon[(k + 1) % n]);
    let Some(k) = repeated else {
        // There and back again.
        return match *polygon {
            [] => Worth::Nothing(0),
            [a, _] => Worth::Nothing(a),
            [a, b, c, d] if a == c || b == d => Worth::Nothing(if a == c { a } else { b }),
            _ => Worth::Whole,
        };
    };
    let mut left: Vec<u32> = polygon.to_vec();
    left.dedup();
    while left.len() > 1 && left.first() == left.last() {
        left.pop();
    }
    match encloses(&left) {
        true => Worth::Shorter(polygon[k], left),
        false => Worth::Nothing(polygon[k]),
    }
}

/// Whether corners that do not follow themselves enclose something.
fn encloses(left: &[u32]) -> bool {
    left.len() > 2 && shortened(left) == Worth::Whole
}
