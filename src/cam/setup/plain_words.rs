//! What the reader of TOML says of a value that makes no sense, in words of people.

use crate::units::nearest;

/// What the reader calls things, and what they are for people; the first that is found counts.
const PLAIN_WORDS: [(&str, &str); 22] = [
    ("untagged enum ToolName", "a tool is named by its number or its name: 1, or \"3 mm end mill\""),
    ("untagged enum PerAxis", "one number for all axes, or one each for x, y and z: 500, or [500, 500, 200]"),
    ("untagged enum Words", "a text or several are needed: \"red\", or [\"red\", \"blue\"]"),
    ("expected struct SelectFile", "select = { id = \"plate\" } is needed; it takes id, layer, fill, stroke, order"),
    ("expected struct TabsFile", "tabs = { count = 3, width = 6, height = 2 } is needed"),
    ("expected struct RatesFile", "feeds in a material are a table: material.plywood = { feed = 1500 }"),
    ("expected struct StockFile", "[stock] is a table of its own: put it on a line, and its keys below"),
    ("expected struct MachineFile", "[machine] is a table of its own: put it on a line, and its keys below"),
    ("expected struct ToolFile", "[[tool]] is a table, one for each tool: put it on a line, and its keys below"),
    ("expected struct OperationFile", "[[operation]] is a table, one for each: put it on a line, and its keys below"),
    ("expected struct KeepoutFile", "[[keepout]] is a table, one for each: put it on a line, and its keys below"),
    (
        "expected a sequence",
        "a list is needed, in square brackets; tables such as tools and operations have two: [[tool]]",
    ),
    ("expected a map", "a table is needed: { key = value }"),
    ("expected a boolean", "true or false is needed, without quotes"),
    ("expected a string", "a text in quotes is needed"),
    ("expected an array of length 2", "two numbers in square brackets are needed: [0, 20]"),
    ("expected an array of length 3", "three numbers in square brackets are needed, for x, y and z: [300, 200, 60]"),
    ("expected f64", "a number is needed, without quotes"),
    ("expected u32", "a whole number is needed, 0 or more and without quotes"),
    ("expected usize", "a whole number is needed, 0 or more and without quotes"),
    ("expected i64", "a whole number is needed, without quotes"),
    ("expected a text or a number", "a number or a text with a unit is needed: 3, or \"1/8in\""),
];

/// serde's words, without the names that things have in this program.
fn plain_words(message: &str) -> String {
    let Some((_, plain)) = PLAIN_WORDS.iter().find(|(raw, _)| message.contains(raw)) else { return message.to_owned() };
    // "invalid type: string \"a\", expected ..." tells what there is.
    let found = message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid value: "));
    let found = found.and_then(|rest| Some(rest.rsplit_once(", expected")?.0));
    let Some(found) = found else { return (*plain).to_owned() };
    let said = match found.split_once(' ') {
        Some(("string", text)) => format!("the text {text}"),
        Some((_, value)) => format!("the value {}", value.replace('`', "")),
        None if found == "map" => "a table".to_owned(),
        None => "a list".to_owned(),
    };
    format!("{said} makes no sense here: {plain}")
}

/// serde's words about an unknown key, with the nearest one that there is.
pub(super) fn reworded(message: &str) -> String {
    let Some(rest) = message.strip_prefix("unknown field `") else { return plain_words(message) };
    let mut quoted = rest.split('`');
    let (Some(key), Some(_)) = (quoted.next(), quoted.next()) else { return plain_words(message) };
    let known: Vec<&str> = quoted.step_by(2).collect();
    match nearest(key, known.iter().copied()) {
        Some(near) => format!("there is no key \"{key}\" here; did you mean \"{near}\"?"),
        None => format!("there is no key \"{key}\" here; there are {}", known.join(", ")),
    }
}
