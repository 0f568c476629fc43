//! Times in words, and what rounding saves.

use serde_json::json;

use crate::cam::TimeSaved;

/// What rounding saves, in words.
pub(super) fn time_saved(saved: &TimeSaved) -> String {
    let (seconds, percent) = (saved.seconds(), saved.percent());
    let rounding = match seconds {
        _ if seconds.abs() < LEAST_SAVING => "rounding saves nothing".to_owned(),
        _ if seconds > 0.0 => format!("rounding saves {seconds:.1} s ({percent:.1} %)"),
        _ => format!("rounding costs {:.1} s ({:.1} %)", -seconds, -percent),
    };
    format!(
        "{rounding}: at a feed {:.1} s, with sharp inside corners {:.1} s; {:.0} mm cut, {:.0} mm with them{}",
        saved.rounded.feed_seconds,
        saved.sharp.feed_seconds,
        saved.rounded_length_mm,
        saved.sharp_length_mm,
        if saved.same_outlines { "" } else { ", which cut outlines that rounding loses" }
    )
}

/// Less, in seconds, is not worth a number.
const LEAST_SAVING: f64 = 0.05;

/// The sharp path, for JSON.
pub(super) fn sharp(saved: &TimeSaved) -> serde_json::Value {
    json!({
        "seconds": saved.sharp.total_seconds(),
        "feed_seconds": saved.sharp.feed_seconds,
        "cut_length_mm": saved.sharp_length_mm,
        "saved_seconds": saved.seconds(),
        "saved_percent": saved.percent(),
        "same_outlines": saved.same_outlines,
    })
}

/// Seconds in words.
pub(super) fn minutes(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    if whole < 60 { format!("{seconds:.1} s") } else { format!("{} min {:02} s", whole / 60, whole % 60) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::ProgramTime;

    #[test]
    fn savings_and_costs_are_told_apart() {
        let at_feed = |feed_seconds| ProgramTime { feed_seconds, rapid_seconds: 2.0, dwell_seconds: 3.0 };
        let saved = TimeSaved {
            rounded: at_feed(18.5),
            sharp: at_feed(74.0),
            rounded_length_mm: 100.0,
            sharp_length_mm: 110.0,
            same_outlines: true,
        };
        assert_eq!(
            time_saved(&saved),
            "rounding saves 55.5 s (75.0 %): at a feed 18.5 s, with sharp inside corners 74.0 s; 100 mm cut, 110 mm with them"
        );
        let words = time_saved(&TimeSaved { rounded: at_feed(80.0), same_outlines: false, ..saved });
        assert!(words.starts_with("rounding costs 6.0 s (8.1 %)") && words.ends_with("rounding loses"), "{words}");
        assert!(time_saved(&TimeSaved { rounded: at_feed(74.0), ..saved }).starts_with("rounding saves nothing"));
        assert_eq!(
            (sharp(&saved)["saved_percent"].as_f64(), sharp(&saved)["seconds"].as_f64()),
            (Some(75.0), Some(79.0))
        );
    }
}
