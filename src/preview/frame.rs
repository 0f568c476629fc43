//! A state of a flow.

use crate::plane::Region;

/// A state of a flow.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The time, in squares of the radius.
    pub time: f64,
    /// The outlines.
    pub region: Region,
}

/// Decimals that times get beyond hundredths of the last one, at most.
const MORE_DECIMALS: usize = 3;

/// What is written below frames: their times, all with the decimals that tell hundredths of the last one, or a few more
/// where those would not tell different times apart.
pub fn time_captions(frames: &[Frame]) -> Vec<String> {
    let last = frames.iter().map(|f| f.time.abs()).filter(|t| t.is_finite()).fold(0.0, f64::max);
    let decimals = if last > 0.0 { (2.0 - last.log10().floor()).clamp(0.0, 9.0) as usize } else { 0 };
    let captions = |decimals: usize| frames.iter().map(|f| format!("{:.decimals$} r²", f.time)).collect::<Vec<_>>();
    let tells_apart = |captions: &[String]| {
        let pairs = frames.windows(2).zip(captions.windows(2));
        pairs.into_iter().all(|(times, texts)| times[0].time == times[1].time || texts[0] != texts[1])
    };
    let more = (decimals..decimals + MORE_DECIMALS).map(captions).find(|texts| tells_apart(texts));
    more.unwrap_or_else(|| captions(decimals + MORE_DECIMALS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_of_one_flow_have_the_same_decimals() {
        let captions = |times: &[f64]| {
            let frames: Vec<Frame> = times.iter().map(|&time| Frame { time, region: Region::default() }).collect();
            time_captions(&frames)
        };
        assert_eq!(captions(&[0.0, 0.125, 0.25]), ["0.000 r²", "0.125 r²", "0.250 r²"]);
        assert_eq!(captions(&[0.0, 1.2]), ["0.00 r²", "1.20 r²"]);
        assert_eq!(captions(&[0.0, 120.0]), ["0 r²", "120 r²"]);
        assert_eq!(captions(&[0.01, 0.013, 2.0]), ["0.010 r²", "0.013 r²", "2.000 r²"]);
        assert_eq!(captions(&[1.0, 1.0]), ["1.00 r²", "1.00 r²"], "no decimals tell equal times apart");
        assert_eq!(captions(&[1.0, 1.0 + 1e-12]), ["1.00000 r²", "1.00000 r²"]);
        assert_eq!(captions(&[0.0]), ["0 r²"]);
        assert_eq!(captions(&[f64::NAN]).len(), 1);
    }
}
