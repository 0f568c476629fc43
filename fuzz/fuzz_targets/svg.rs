//! Any bytes are a drawing or an error; and any drawing can be closed.
#![no_main]

use clopen::io::svg::{self, ReadOptions};
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use libfuzzer_sys::fuzz_target;

/// Larger drawings say nothing new and take long.
const MOST_VERTICES: usize = 20_000;

fuzz_target!(|bytes: &[u8]| {
    let Ok(drawing) = svg::read(bytes, &ReadOptions::default()) else { return };
    if drawing.region.vertex_count() > MOST_VERTICES {
        return;
    }
    let Ok(radius) = Radius::new(0.02 * drawing.region.bounds().diagonal()) else { return };
    for topology in [Topology::Merge, Topology::Keep] {
        let closed = rolling::close(&drawing.region, radius, topology).region;
        let finite =
            closed.rings.iter().flat_map(|r| &r.vertices).all(|v| v.point.x.is_finite() && v.point.y.is_finite());
        assert!(finite, "{topology:?}: a coordinate is not finite");
        let _ = svg::write(&drawing, &closed);
    }
});
