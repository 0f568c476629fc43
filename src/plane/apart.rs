//! Things that have nothing to do with each other: groups whose boxes lie apart.

use super::Bounds;

/// Whether any two boxes share a point: a sweep from the left.
pub fn any_meet(boxes: &[Bounds]) -> bool {
    let mut order: Vec<&Bounds> = boxes.iter().filter(|b| !b.is_empty()).collect();
    order.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
    // Those that what comes may still meet.
    let mut open: Vec<&Bounds> = Vec::new();
    order.into_iter().any(|next| {
        open.retain(|b| b.max.x >= next.min.x);
        let meets = open.iter().any(|b| b.overlaps(next));
        open.push(next);
        meets
    })
}

/// So many sweeps are made; where groups then still grow into each other, all is one group.
const MOST_SWEEPS: usize = 16;

/// The boxes in groups such that the boxes around any two groups share no point: what lies between the groups hangs together.
/// Groups are in the order of their first members, members in the order given, and there are as many as there can be, but for
/// boxes so contrived that the groups have not settled after `MOST_SWEEPS` sweeps: then they are one.
///
/// A sweep from the left; groups that have grown into each other are found by the next one. Empty boxes are left out.
pub fn groups_apart(boxes: &[Bounds]) -> Vec<Vec<usize>> {
    let mut groups: Vec<(Bounds, Vec<usize>)> =
        boxes.iter().enumerate().filter(|(_, b)| !b.is_empty()).map(|(k, b)| (*b, vec![k])).collect();
    for sweep in 0.. {
        let before = groups.len();
        if sweep == MOST_SWEEPS {
            groups = vec![groups.into_iter().fold((Bounds::EMPTY, vec![]), |mut all, (bounds, members)| {
                all.1.extend(members);
                (all.0.union(bounds), all.1)
            })];
        }
        groups.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x));
        let mut passed = Vec::with_capacity(before);
        // Those that what comes may still overlap.
        let mut open: Vec<(Bounds, Vec<usize>)> = Vec::new();
        for (mut around, mut members) in groups {
            let front = around.min.x;
            let mut k = 0;
            while k < open.len() {
                if open[k].0.max.x < front {
                    passed.push(open.swap_remove(k));
                } else if open[k].0.overlaps(&around) {
                    let (other, more) = open.swap_remove(k);
                    around = around.union(other);
                    members.extend(more);
                    // It has grown: those that were apart from it may not be any more.
                    k = 0;
                } else {
                    k += 1;
                }
            }
            open.push((around, members));
        }
        passed.extend(open);
        groups = passed;
        if groups.len() == before {
            break;
        }
    }
    let mut groups: Vec<Vec<usize>> = groups.into_iter().map(|(_, members)| members).collect();
    groups.iter_mut().for_each(|members| members.sort_unstable());
    groups.sort_unstable();
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Point;

    fn square(x: f64, y: f64, side: f64) -> Bounds {
        Bounds { min: Point::new(x, y), max: Point::new(x + side, y + side) }
    }

    #[test]
    fn boxes_that_touch_or_overlap_through_others_are_one_group() {
        let boxes =
            [square(0.0, 0.0, 1.0), square(5.0, 0.0, 1.0), square(1.0, 1.0, 1.0), Bounds::EMPTY, square(2.0, 1.5, 1.0)];
        assert_eq!(groups_apart(&boxes), [vec![0, 2, 4], vec![1]]);
        assert_eq!(groups_apart(&[]), Vec::<Vec<usize>>::new());
        assert!(any_meet(&boxes) && !any_meet(&boxes[..2]) && !any_meet(&[Bounds::EMPTY; 2]));
        assert!(any_meet(&[square(0.0, 0.0, 1.0), square(9.0, 0.0, 1.0), square(1.0, 1.0, 1.0)]), "corners that touch");
    }

    #[test]
    fn what_lies_within_a_ring_of_boxes_is_of_their_group() {
        // Four bars around a square that none of them overlaps.
        let bar = |x0: f64, y0: f64, x1: f64, y1: f64| Bounds { min: Point::new(x0, y0), max: Point::new(x1, y1) };
        let boxes = [
            bar(4.0, 4.0, 6.0, 6.0),
            bar(0.0, 0.0, 10.0, 1.0),
            bar(9.0, 0.0, 10.0, 10.0),
            bar(0.0, 9.0, 10.0, 10.0),
            bar(0.0, 0.0, 1.0, 10.0),
            bar(20.0, 4.0, 21.0, 5.0),
        ];
        assert_eq!(groups_apart(&boxes), [vec![0, 1, 2, 3, 4], vec![5]]);
    }

    #[test]
    fn groups_that_grow_into_each_other_without_end_are_one() {
        // Every step of the stairs meets what all before it have become, and no single one of them.
        let bar = |x0: f64, y0: f64, x1: f64, y1: f64| Bounds { min: Point::new(x0, y0), max: Point::new(x1, y1) };
        let mut boxes = vec![bar(0.0, 0.0, 1.0, 1.0)];
        for k in 1..200 {
            let x = f64::from(k);
            boxes.extend([bar(-x, x, 1.0 - x, x + 1.5), bar(x, -0.5, x + 1.0, 0.5)]);
        }
        let groups = groups_apart(&boxes);
        let around: Vec<Bounds> =
            groups.iter().map(|g| g.iter().fold(Bounds::EMPTY, |b, &k| b.union(boxes[k]))).collect();
        for i in 0..around.len() {
            assert!((0..i).all(|j| !around[i].overlaps(&around[j])));
        }
        assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), boxes.len());
    }

    #[test]
    fn groups_are_apart_whatever_the_order() {
        // A fixed walk over the plane, dense enough that about half of the boxes meet others.
        let boxes: Vec<Bounds> = (0..300u32)
            .map(|k| square(f64::from(k * 7919 % 1009), f64::from(k * 104_729 % 997), f64::from(k % 40)))
            .collect();
        let groups = groups_apart(&boxes);
        assert!(groups.len() > 20 && groups.len() < 280, "{}", groups.len());
        let around: Vec<Bounds> =
            groups.iter().map(|g| g.iter().fold(Bounds::EMPTY, |b, &k| b.union(boxes[k]))).collect();
        for i in 0..around.len() {
            assert!((0..i).all(|j| !around[i].overlaps(&around[j])));
        }
        let reversed: Vec<Bounds> = boxes.iter().rev().copied().collect();
        let mut same: Vec<Vec<usize>> = groups_apart(&reversed)
            .into_iter()
            .map(|g| g.into_iter().rev().map(|k| boxes.len() - 1 - k).collect())
            .collect();
        same.sort_unstable();
        assert_eq!(same, groups);
    }
}
