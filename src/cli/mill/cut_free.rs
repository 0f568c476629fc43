//! The order of a job: what is worked on after it has been cut out of the stock.

use crate::cam::{Operation, OperationKind, Setup, Side};
use crate::plane::Region;

/// Which operations work on parts that earlier ones have cut free, in sentences; `areas` are the shapes of all operations.
pub(super) fn cut_free(setup: &Setup, areas: &[Region]) -> Vec<String> {
    let free = |o: &Operation| cuts_out(setup, o) && o.cutting.tabs.is_none();
    late_work(setup, areas, free)
        .map(|(first, later)| {
            let cause = match first.cutting.onion_skin {
                Some(_) => "cuts the last skin below the part",
                None => "cuts the part free",
            };
            format!(
                "operation \"{}\" {cause} before \"{}\" works on it: write it behind that one, or give it tabs",
                first.label, later.label
            )
        })
        .collect()
}

/// The same for parts that hang on tabs only, which is no danger, but no good work either.
pub(super) fn loosened(setup: &Setup, areas: &[Region]) -> Vec<String> {
    let hangs = |o: &Operation| cuts_out(setup, o) && o.cutting.tabs.is_some();
    late_work(setup, areas, hangs)
        .map(|(first, later)| {
            format!(
                "operation \"{}\" leaves the part on its tabs before \"{}\" works on it: what is cut inside first is cut in \
                 firm stock",
                first.label, later.label
            )
        })
        .collect()
}

/// Pairs of an operation of some kind and the first later one on the same shapes.
fn late_work<'a>(
    setup: &'a Setup,
    areas: &'a [Region],
    of_kind: impl Fn(&Operation) -> bool,
) -> impl Iterator<Item = (&'a Operation, &'a Operation)> {
    let operations = setup.operations.iter().zip(areas);
    operations.enumerate().filter(move |(_, (o, _))| of_kind(o)).filter_map(move |(k, (first, outline))| {
        let later = setup.operations.iter().zip(areas).skip(k + 1);
        let (later, _) = later.filter(|(_, area)| !area.is_empty()).find(|(_, area)| outline.overlaps(area))?;
        Some((first, later))
    })
}

/// Whether an operation cuts around parts through the whole stock.
fn cuts_out(setup: &Setup, operation: &Operation) -> bool {
    let goes_through = setup.stock.thickness.is_some_and(|thickness| operation.cutting.depth >= thickness);
    goes_through && matches!(operation.kind, OperationKind::Profile { side: Side::Outside, rest_of: None, .. })
}
