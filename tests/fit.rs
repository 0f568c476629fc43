//! Interlocking parts (Fig. 22 of the paper): closing one and opening its counterpart keeps their fit, bit for bit.

mod shapes;

use clopen::plane::{Link, Region, Ring, Vector};
use clopen::rolling::{Topology, close_within, open_within};
use clopen::units::Radius;
use shapes::{Numbers, mixed, placed, rectangle};

/// The elements of a ring, each with all its bits, from the smallest on: where a ring starts is no matter.
fn bits(ring: &Ring) -> Vec<[u64; 7]> {
    let mut elements: Vec<[u64; 7]> = ring
        .segments()
        .map(|s| {
            let [x, y, radius] = match s.link {
                Link::Line => [0.0; 3],
                Link::Arc(arc) => [arc.center.x, arc.center.y, arc.radius * arc.turn.sign()],
            };
            [s.start.x, s.start.y, s.end.x, s.end.y, x, y, radius].map(|v| (v + 0.0).to_bits())
        })
        .collect();
    let first = (0..elements.len()).min_by_key(|&k| elements[k]).unwrap_or(0);
    elements.rotate_left(first);
    elements
}

fn all_bits(rings: impl IntoIterator<Item = Ring>) -> Vec<Vec<[u64; 7]>> {
    let mut all: Vec<_> = rings.into_iter().map(|r| bits(&r)).collect();
    all.sort();
    all
}

#[test]
fn a_part_and_the_plate_around_it_keep_every_bit_of_their_boundary() {
    let r = Radius::new(1.0).unwrap();
    let (mut compared, mut wrong) = (0, vec![]);
    for number in 0..400 {
        let (name, shape) = mixed(number);
        let mut numbers = Numbers::new(number);
        let far = [0.0, 0.0, 1e3, 1e6][numbers.below(4)];
        let angle = numbers.between(0.0, 6.0);
        let part = placed(&shape, angle, 1.0, Vector::new(far, -0.3 * far + 0.1));
        // The same outline as holes of a plate, drawn from other vertices on and in another order.
        let bounds = part.bounds().inflated(5.0);
        let mut holes: Vec<Ring> = part.reversed().rings;
        for hole in &mut holes {
            let start = numbers.below(hole.len());
            hole.vertices.rotate_left(start);
        }
        holes.reverse();
        let edge = rectangle(bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y);
        let plate = Region::new(holes.into_iter().chain([edge]).collect());
        for topology in [Topology::Keep, Topology::Merge] {
            let closed = close_within(&part, r, topology, &bounds);
            let opened = open_within(&plate, r, topology, &bounds);
            let is_edge = |ring: &Ring| ring.area() > 0.0 && ring.bounds().width() > bounds.width() - 1e-6;
            let hole_rings = opened.region.reversed().rings.into_iter().filter(|ring| !is_edge(&ring.reversed()));
            let (a, b) = (all_bits(closed.region.rings), all_bits(hole_rings));
            compared += a.len();
            if a != b {
                wrong.push(format!("{name} {topology:?}"));
            }
        }
    }
    assert!(compared > 300, "{compared}");
    assert!(wrong.is_empty(), "{} of {compared}: {}", wrong.len(), wrong.join(", "));
}
