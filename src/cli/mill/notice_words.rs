//! What planning noticed, in sentences.

use std::mem::{Discriminant, discriminant};

use super::setup::at;
use crate::cam::Notice;
use crate::cli::report::eased;

/// Of notices of one kind so many are told one by one.
pub(super) const MOST_ALIKE: usize = 4;

/// What went wrong, and what is only to be known; of many alike the first `most` and how many more there are.
pub(super) fn notice_words(notices: &[Notice], most: usize) -> [Vec<String>; 2] {
    let mut kinds: Vec<(Discriminant<Notice>, Vec<&Notice>)> = Vec::new();
    for notice in notices {
        let kind = discriminant(notice);
        match kinds.iter_mut().find(|(k, _)| *k == kind) {
            Some((_, alike)) => alike.push(notice),
            None => kinds.push((kind, vec![notice])),
        }
    }
    let mut words = [Vec::new(), Vec::new()];
    for (_, alike) in kinds {
        let told = if alike.len() > most.saturating_add(1) { most } else { alike.len() };
        let list = &mut words[usize::from(!is_failure(alike[0]))];
        list.extend(alike[..told].iter().map(|notice| sentence(notice)));
        if told < alike.len() {
            list.push(format!("{} more of this kind (--format json lists all)", alike.len() - told));
        }
    }
    words
}

/// Whether what was asked for is not done.
fn is_failure(notice: &Notice) -> bool {
    matches!(
        notice,
        Notice::OpenLine(_)
            | Notice::Covered(_)
            | Notice::NotRound(_)
            | Notice::HoleNarrow(..)
            | Notice::TabsDropped(..)
    )
}

fn sentence(notice: &Notice) -> String {
    match *notice {
        Notice::LeadSkipped(p) => format!("no room for a lead at {}", at(p)),
        Notice::LeadShortened(p, radius) => {
            format!("the lead at {} has room for a radius of {radius:.3} mm only", at(p))
        }
        Notice::OpenLine(p) => format!(
            "the line that begins at {} is open, and nothing is cut along it: close it in the drawing, or engrave it",
            at(p)
        ),
        Notice::TabMoved(p, to) => format!("the tab at {} had to be moved to {}", at(p), at(to)),
        Notice::Covered(p) => format!(
            "the shape around {} lies wholly on another one and changes nothing: draw it as a hole of that shape (one path, \
             fill-rule=\"evenodd\"), give it an operation of its own, or leave it out of select",
            at(p)
        ),
        Notice::NotRound(p) => format!(
            "the shape around {} is no circle and is not drilled: leave it out of select, or cut it with a pocket",
            at(p)
        ),
        Notice::HoleNarrow(p, diameter) => format!(
            "the hole of {diameter:.3} mm at {} comes out as wide as the drill: take a drill of its size, or bore it with an end \
             mill",
            at(p)
        ),
        Notice::HelixSkipped(p) => format!("no room for a helix at {}: the tool ramps along the path", at(p)),
        Notice::NoHole(p) => format!("no drilled hole near {} takes the tool: it ramps along the path", at(p)),
        Notice::CornerSkipped(p) => {
            format!("the tool does not come near the corner at {}: it stays round", at(p))
        }
        Notice::BottomCleared(step) => format!(
            "where the letters are wider than the tool reaches, the tip clears the bottom in paths {step:.2} mm apart"
        ),
        Notice::TabsDropped(p, count) => format!(
            "{} no place on an outline near {}: ask for fewer, narrower or others",
            if count == 1 { "a tab finds".to_owned() } else { format!("{count} tabs find") },
            at(p)
        ),
        Notice::TabsOnArcs(p, count) => format!(
            "{} on tight arcs of the outline at {}",
            if count == 1 { "a tab stands".to_owned() } else { format!("{count} tabs stand") },
            at(p)
        ),
        Notice::NothingToHold(count) => format!(
            "no tabs {}: the tool clears all inside, and nothing comes loose",
            if count == 1 { "on one outline".to_owned() } else { format!("on {count} outlines") }
        ),
        Notice::PathRadiusEased(count, least) => eased(count, least),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Point;

    #[test]
    fn many_notices_of_a_kind_are_told_by_their_number() {
        let dropped = |k: usize| Notice::TabsDropped(Point::new(k as f64, 0.0), 1);
        let mut notices: Vec<Notice> = (0..200).map(dropped).collect();
        notices.insert(3, Notice::NothingToHold(1));
        let [failures, notes] = notice_words(&notices, MOST_ALIKE);
        assert_eq!(failures.len(), MOST_ALIKE + 1);
        assert_eq!(failures[MOST_ALIKE], "196 more of this kind (--format json lists all)");
        assert_eq!(notes.len(), 1);
        assert_eq!(notice_words(&notices, usize::MAX)[0].len(), 200, "as for programs that read the report");
        // One more takes no more room than to say so.
        assert_eq!(notice_words(&notices[..MOST_ALIKE + 2], MOST_ALIKE)[0].len(), MOST_ALIKE + 1);
    }
}
