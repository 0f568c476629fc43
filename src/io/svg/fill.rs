//! Areas united: what each item fills by its own rule, cut down to its clip paths, all in one region.

use std::collections::HashMap;

use super::collect::{Collection, Item};
use super::drawing::Sources;
use super::sample::{self, Sampling};
use crate::io::unite::{self, Rule};
use crate::plane::{Region, Ring};

/// All `items` united; `sources` are without vertices, and get them.
pub(super) fn fill(collection: &Collection, items: &[Item], sampling: Sampling, sources: Sources) -> (Region, Sources) {
    let mut filler = Filler { collection, sampling, sources, clips: HashMap::new() };
    if sampling.tolerance <= 0.0 {
        return (Region::default(), filler.sources);
    }
    let rings = filler.union(items);
    (Region::new(rings), filler.sources)
}

struct Filler<'a> {
    collection: &'a Collection,
    sampling: Sampling<'a>,
    sources: Sources,
    clips: HashMap<usize, Vec<Ring>>,
}

impl Filler<'_> {
    fn union(&mut self, items: &[Item]) -> Vec<Ring> {
        // What is cut down to the same clip paths is cut at once.
        let mut first_of: HashMap<&[usize], usize> = HashMap::new();
        let mut groups: Vec<(&[usize], Vec<Vec<Ring>>)> = Vec::new();
        for item in items {
            let area = self.area(item);
            let clips = item.clips.as_slice();
            let at = *first_of.entry(clips).or_insert_with(|| {
                groups.push((clips, Vec::new()));
                groups.len() - 1
            });
            if !area.is_empty() {
                groups[at].1.push(area);
            }
        }
        let mut areas: Vec<Vec<Ring>> = Vec::new();
        for (clips, group) in groups {
            if clips.is_empty() {
                areas.extend(group);
            } else {
                let area = unite::united(group);
                areas.push(self.within(area, clips));
            }
        }
        unite::united(areas)
    }

    /// What one item fills, clip paths aside.
    fn area(&mut self, item: &Item) -> Vec<Ring> {
        let rings = sample::rings(&item.outline, &item.affine, self.sampling, item.element, &mut self.sources);
        let rule = match item.rule {
            usvg::FillRule::NonZero => Rule::NonZero,
            usvg::FillRule::EvenOdd => Rule::EvenOdd,
        };
        unite::resolve(rings, rule)
    }

    fn within(&mut self, mut area: Vec<Ring>, clips: &[usize]) -> Vec<Ring> {
        for &clip in clips {
            if area.is_empty() {
                break;
            }
            area.extend(self.clip(clip));
            area = unite::resolve(area, Rule::AtLeast(2));
        }
        area
    }

    fn clip(&mut self, index: usize) -> Vec<Ring> {
        if let Some(rings) = self.clips.get(&index) {
            return rings.clone();
        }
        let collection = self.collection;
        let clip = &collection.clips[index];
        let union = self.union(&clip.items);
        let rings = self.within(union, &clip.clips);
        self.clips.insert(index, rings.clone());
        rings
    }
}
