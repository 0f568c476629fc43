//! Which codes controllers know, and which exclude each other. Codes are counted in tenths: G38.2 is 382.

/// Who knows a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Support {
    Both,
    LinuxcncOnly,
    Nowhere,
}

/// G codes of GRBL 1.1 in tenths.
const GRBL_G: &[u32] = &[
    0, 10, 20, 30, 40, 100, 170, 180, 190, 200, 210, 280, 281, 300, 301, 382, 383, 384, 385, 400, 431, 490, 530, 540,
    550, 560, 570, 580, 590, 610, 800, 900, 910, 911, 920, 921, 930, 940,
];

/// M codes of GRBL 1.1 as it is built by default.
const GRBL_M: &[u32] = &[0, 10, 20, 30, 40, 50, 80, 90, 300];

/// Further G codes of LinuxCNC.
const LINUXCNC_G: &[u32] = &[
    50, 51, 52, 53, 70, 80, 330, 331, 410, 411, 420, 421, 430, 432, 520, 591, 592, 593, 611, 640, 730, 740, 760, 810,
    820, 830, 840, 850, 860, 870, 880, 890, 901, 922, 923, 950, 960, 970, 980, 990,
];

/// Further M codes of LinuxCNC, first and last of each run, in whole numbers; from 100 on they are the user's.
const LINUXCNC_M: &[(u32, u32)] = &[(6, 7), (19, 19), (48, 53), (60, 68), (70, 73), (98, 99), (100, 199)];

/// The value of a code in tenths; `None` for more decimals, negative or absurd numbers.
pub(super) fn tenths(value: f64) -> Option<u32> {
    let tenths = value * 10.0;
    let rounded = tenths.round();
    let is_code = (0.0..10_000.0).contains(&rounded) && (tenths - rounded).abs() < 1e-6;
    is_code.then_some(rounded as u32)
}

/// Who knows a G or M code.
pub(super) fn support(is_g: bool, tenths: u32) -> Support {
    let (grbl, linuxcnc) = match is_g {
        true => (GRBL_G.contains(&tenths), LINUXCNC_G.contains(&tenths)),
        false => {
            let whole = tenths / 10;
            let in_a_run = LINUXCNC_M.iter().any(|&(first, last)| (first..=last).contains(&whole));
            (GRBL_M.contains(&tenths), tenths % 10 == 0 && in_a_run)
        }
    };
    match () {
        () if grbl => Support::Both,
        () if linuxcnc => Support::LinuxcncOnly,
        () => Support::Nowhere,
    }
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

/// Splines, threads, cutter compensation and cycles, which are read but not followed.
pub(super) fn is_not_followed(tenths: u32) -> bool {
    matches!(tenths, 50..=80 | 330 | 331 | 382..=385 | 410..=421 | 730..=760 | 810..=890)
}
