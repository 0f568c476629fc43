//! Keys that only certain kinds of operations know: elsewhere they would mean nothing, and who typed them expects something.

use std::ops::Range;

use super::{Place, Resolver};
use crate::cam::setup::file::{OperationFile, OperationKindName};

use OperationKindName::{Chamfer, Drill, Engrave, Facing, Pocket, Profile, VCarve};

/// A key of an operation, and who takes it.
struct Key {
    name: &'static str,
    is_said: fn(&OperationFile) -> bool,
    kinds: &'static [OperationKindName],
    /// Whether operations that cut only what a larger tool has left take it.
    rest: bool,
    /// What does the like elsewhere, in words.
    instead: &'static str,
}

const fn key(name: &'static str, is_said: fn(&OperationFile) -> bool, kinds: &'static [OperationKindName]) -> Key {
    Key { name, is_said, kinds, rest: true, instead: "" }
}

const fn whole(name: &'static str, is_said: fn(&OperationFile) -> bool, kinds: &'static [OperationKindName]) -> Key {
    Key { rest: false, ..key(name, is_said, kinds) }
}

/// All keys that not every operation takes.
const KEYS: [Key; 20] = [
    key("side", |o| o.side.is_some(), &[Profile, Chamfer]),
    Key {
        instead: ": the width of a chamfer, and max-depth in carving, say how deep it goes",
        ..key("depth", |o| o.depth.is_some(), &[Profile, Pocket, Drill, Engrave, Facing])
    },
    key("through", |o| o.through.is_some(), &[Profile, Pocket, Drill, Engrave]),
    key("passes", |o| o.passes.is_some(), &[Profile, Pocket, Drill, Engrave, Facing, Chamfer]),
    key("final-pass", |o| o.final_pass.is_some(), &[Profile, Pocket, Drill, Engrave, Facing, Chamfer]),
    key("direction", |o| o.direction.is_some(), &[Profile, Pocket, Drill, VCarve, Chamfer]),
    key("path-radius", |o| o.path_radius.is_some(), &[Profile, Pocket, Chamfer]),
    key("topology", |o| o.topology.is_some(), &[Profile, Pocket, VCarve, Chamfer]),
    whole("entry", |o| o.entry.is_some(), &[Profile, Pocket, Engrave, Chamfer]),
    whole("lead", |o| o.lead.is_some(), &[Profile, Pocket, Chamfer]),
    whole("tabs", |o| o.tabs.is_some(), &[Profile]),
    whole("onion-skin", |o| o.onion_skin.is_some(), &[Profile]),
    whole("allowance", |o| o.allowance.is_some(), &[Profile, Pocket]),
    whole("finish", |o| o.finish.is_some(), &[Profile, Pocket]),
    whole("corners", |o| o.corners.is_some(), &[Profile, Pocket]),
    whole("pattern", |o| o.pattern.is_some(), &[Pocket]),
    key("stepover", |o| o.stepover.is_some(), &[Pocket, Facing]),
    key("rest-of", |o| o.rest_of.is_some(), &[Profile, Pocket]),
    key("peck", |o| o.peck.is_some(), &[Drill]),
    key("width", |o| o.width.is_some(), &[Chamfer]),
];

/// The same for V-carving alone, whose message names the key that the others have.
const MAX_DEPTH: Key =
    Key { instead: ": elsewhere it is depth", ..key("max-depth", |o| o.max_depth.is_some(), &[VCarve]) };

impl Resolver<'_> {
    /// Refuses the keys of `file` that mean nothing for its kind.
    pub(super) fn keys(&mut self, file: &OperationFile, table: &Range<usize>, kind: OperationKindName) {
        let said = KEYS.iter().chain([&MAX_DEPTH]).filter(|key| (key.is_said)(file));
        for key in said {
            let place = Place { table, key: key.name };
            if !key.kinds.contains(&kind) {
                let takers: Vec<&str> = key.kinds.iter().map(|k| k.word()).collect();
                self.at(
                    place,
                    format!(
                        "{} means nothing in an operation of kind {}: leave it out, it belongs to {}{}",
                        key.name,
                        kind.word(),
                        takers.join(", "),
                        key.instead
                    ),
                );
            } else if file.rest_of.is_some() && !key.rest {
                self.at(
                    place,
                    format!(
                        "{} means nothing together with rest-of: leave it out, it belongs to the operation whose rest is cut",
                        key.name
                    ),
                );
            }
        }
    }
}
