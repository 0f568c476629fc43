//! Which codes the reader knows, and which exclude each other. Codes are counted in tenths: G38.2 is 382.

use super::Dialect;

/// The value of a code in tenths; `None` for more decimals, negative or absurd numbers.
pub(super) fn tenths(value: f64) -> Option<u32> {
    let tenths = value * 10.0;
    let rounded = tenths.round();
    let is_code = (0.0..10_000.0).contains(&rounded) && (tenths - rounded).abs() < 1e-6;
    is_code.then_some(rounded as u32)
}

/// Whether any built-in dialect has a code, so that the reader knows what it does, or that it does not follow it.
pub(super) fn is_known(is_g: bool, tenths: u32) -> bool {
    Dialect::built_in().iter().any(|d| d.codes.contains(is_g, tenths))
}

/// The group of codes that exclude each other on one line; `None` where the code excludes nothing.
pub(super) fn group(is_g: bool, tenths: u32) -> Option<u32> {
    // G groups as in the NIST report; those of M are counted from 100.
    match (is_g, tenths) {
        (true, 0..=30 | 50..=53 | 330..=331 | 382..=385 | 730 | 760 | 800..=890) => Some(1),
        (true, 40 | 100 | 280..=301 | 520 | 530 | 920..=923) => Some(0),
        (true, 170..=190) => Some(2),
        (true, 900 | 910) => Some(3),
        (true, 901 | 911) => Some(4),
        (true, 930..=950) => Some(5),
        (true, 200 | 210) => Some(6),
        (true, 400..=421) => Some(7),
        (true, 430..=432 | 490) => Some(8),
        (true, 540..=593) => Some(12),
        (true, 610..=640) => Some(13),
        (false, 0..=20 | 300) => Some(104),
        (false, 30..=50) => Some(107),
        _ => None,
    }
}

/// Splines, pockets, polar coordinates, probing, threads, cutter compensation, scaling, macros, rotation and cycles other than
/// those of drilling, which are read but not followed.
pub(super) fn is_not_followed(tenths: u32) -> bool {
    matches!(
        tenths,
        50..=80 | 120 | 130 | 160 | 310 | 330 | 331 | 382..=385 | 410..=421 | 510 | 650..=680 | 740..=760 | 840..=890
    )
}
