//! What was repaired, in words.

use crate::mesh::Repair;

/// So many places of one kind are named.
const NAMED: usize = 3;

/// What was repaired, each kind counted with its first places; nothing where nothing was.
pub(super) fn words(repairs: &[Repair]) -> Option<String> {
    let (mut kinds, mut places): (Vec<[&str; 2]>, Vec<Vec<String>>) = (vec![], vec![]);
    for repair in repairs {
        let (kind, place) = match *repair {
            Repair::DroppedCorner { polygon, .. } => {
                (["repeated corner left out", "repeated corners left out"], polygon)
            }
            Repair::DroppedDegenerate { polygon } => {
                (["degenerate face left out", "degenerate faces left out"], polygon)
            }
            Repair::DroppedDuplicate { polygon, .. } => {
                (["duplicate face left out", "duplicate faces left out"], polygon)
            }
            Repair::Reversed { polygon } => (["face turned over", "faces turned over"], polygon),
            Repair::Welded { vertex, .. } => {
                (["vertex welded to another at the same place", "vertices welded to others at the same places"], vertex)
            }
            Repair::DroppedVertex { vertex } => {
                (["vertex without faces left out", "vertices without faces left out"], vertex)
            }
        };
        let what =
            if matches!(repair, Repair::DroppedVertex { .. } | Repair::Welded { .. }) { "vertex" } else { "face" };
        let at = kinds.iter().position(|k| *k == kind).unwrap_or_else(|| {
            kinds.push(kind);
            places.push(vec![]);
            kinds.len() - 1
        });
        places[at].push(format!("{what} {place}"));
    }
    let parts: Vec<String> = kinds
        .iter()
        .zip(&places)
        .map(|([one, several], places)| {
            let dots = if places.len() > NAMED { ", ..." } else { "" };
            let named = places[..places.len().min(NAMED)].join(", ");
            format!("{} {} ({named}{dots})", places.len(), if places.len() == 1 { one } else { several })
        })
        .collect();
    (!parts.is_empty()).then(|| format!("repaired: {}", parts.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repairs_are_counted_by_kind_with_their_first_places() {
        assert_eq!(words(&[]), None);
        let mut repairs: Vec<Repair> = (4..9).map(|polygon| Repair::DroppedDuplicate { polygon, of: 1 }).collect();
        repairs.push(Repair::DroppedVertex { vertex: 8 });
        let expected = "repaired: 5 duplicate faces left out (face 4, face 5, face 6, ...); 1 vertex without faces left out (vertex 8)";
        assert_eq!(words(&repairs).unwrap(), expected);
    }
}
