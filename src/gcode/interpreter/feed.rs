//! At which feed motions are made, and who said it.

use super::super::block::Block;
use super::super::rules::Rule;
use super::{FeedMode, Interpreter, MotionMode};

impl Interpreter<'_> {
    /// Whose feed a motion is made at. F itself was taken from the block before.
    pub(super) fn follow_feed(&mut self, mode: Option<MotionMode>, block: &Block) {
        let is_rapid = matches!(mode, None | Some(MotionMode::Rapid));
        if !self.dialect().modal_motion
            && !block.words.iter().any(|w| w.letter == 'G' && (0.0..=3.0).contains(&w.value))
        {
            self.find(Rule::MotionWordMissing, "");
        }
        if block.value('F').is_some() {
            (self.feed_is_of_rapid, self.feed_is_of_tool_before) = (is_rapid, false);
        } else if is_rapid {
            if self.dialect().rapid_feed.is_some() && self.feed.is_some() && !self.feed_is_of_rapid {
                self.find_once(Rule::RapidWithoutFeed, "");
            }
        } else if self.feed_mode != Some(FeedMode::InverseTime) {
            if std::mem::take(&mut self.feed_is_of_rapid) {
                self.find(Rule::FeedOfRapid, "");
            }
            if std::mem::take(&mut self.feed_is_of_tool_before) {
                self.find(Rule::FeedAfterToolChange, "");
            }
        }
    }

    /// Feed in millimetres a minute for a way of `length`; 0 where there is none, which is a finding.
    pub(super) fn feed_for(&mut self, length: f64, block: &Block) -> f64 {
        let feed = match self.feed_mode {
            // F is one over the minutes that the motion takes, and holds for its line only.
            Some(FeedMode::InverseTime) => block.value('F').map(|f| f * length),
            Some(FeedMode::PerTurn) => self.feed.map(|f| f * self.spindle_speed),
            _ => self.feed,
        };
        let missing = match self.feed_mode {
            Some(FeedMode::InverseTime) => block.value('F').is_none_or(|f| f <= 0.0),
            _ => feed.is_none_or(|f| f <= 0.0),
        };
        if missing {
            self.find(Rule::NoFeed, "");
        }
        feed.unwrap_or(0.0).max(0.0)
    }
}
