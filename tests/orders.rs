//! Closing and opening one after the other, over random shapes.

mod laws;
mod shapes;

use clopen::plane::{Link, Turn};
use clopen::reference::Operation;
use clopen::rolling::{Topology, close, open};
use clopen::units::Radius;
use shapes::mixed;

#[test]
fn the_second_operation_is_as_right_on_arcs_of_the_disk_as_the_first_on_what_was_drawn() {
    let r = Radius::new(1.0).unwrap();
    let (mut arcs, mut unproved) = (0, vec![]);
    for number in 0..300 {
        let (name, shape) = mixed(number);
        for topology in [Topology::Keep, Topology::Merge] {
            let closed = close(&shape, r, topology);
            let opened = open(&closed.region, r, topology);
            if closed.contradictions == 0 && opened.contradictions > 0 {
                unproved.push(format!("{name} {topology:?}"));
                continue;
            }
            let (out, at) = laws::containment(&closed.region, &opened.region, Operation::Open, 1.0);
            assert!(out < laws::ACCURACY, "{name} {topology:?}: {out:e} at {at}");
            // An opening makes no concave arcs: those that are there are the closing's.
            let made: Vec<Link> = closed.region.segments().map(|s| s.link).collect();
            for link in opened.region.segments().map(|s| s.link) {
                if let Link::Arc(arc) = link
                    && arc.turn == Turn::Right
                {
                    assert!(made.contains(&link), "{name} {topology:?}: {link:?}");
                    arcs += 1;
                }
            }
        }
    }
    assert!(arcs > 2000, "{arcs}");
    assert!(unproved.is_empty(), "{}: {}", unproved.len(), unproved.join(", "));
}
