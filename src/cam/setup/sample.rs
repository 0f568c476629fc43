//! A commented job file to start from.

use super::SETUP_VERSION;

/// What a drawing has, as far as a job file cares.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleShape {
    /// Its number in the order of the file, `id`, layers and colours, in words.
    pub words: String,
}

/// A job file for a drawing of this name, with every key explained. It is read as it stands.
pub fn commented_sample(drawing: &str, shapes: &[SampleShape]) -> String {
    let mut listed = String::new();
    for shape in shapes {
        // One line a shape, whatever its names hold.
        let words: String = shape.words.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        listed.push_str(&format!("#   {words}\n"));
    }
    let drawing: String = drawing.chars().filter(|c| !c.is_control()).collect();
    format!(
        r##"# A job for {drawing}:   clopen mill {drawing} --job THIS-FILE -o {stem}.nc
# Lengths are millimetres or have a unit ("1/8in"), feeds are mm/min or have one ("20mm/s"). Flags beat this file.
version = {SETUP_VERSION}
#sort-by-tool = true         # all that one tool does at once, instead of the order below

[stock]
thickness = 6
#width = 300                 # only facing needs width and height
#height = 200
#top = 0                     # z of its top
#zero = "corner"             # what becomes x = 0, y = 0: corner or center of the drawing, or the drawing's own origin
#material = "plywood"        # chooses the feeds of the tools below

[machine]
dialect = "grbl"             # clopen lint --help lists them; a file of your own: "my-machine.toml"
#settings = "grbl.txt"       # what your machine answers to $$: accelerations, speeds, travel
#acceleration = [500, 500, 200]
#rapid = [5000, 5000, 1500]
#junction-deviation = 0.01
#travel = [300, 200, 60]     # programs that need more are refused
#safe-height = 5
#dwell = 3                   # seconds for the spindle to start
#arcs = true
#inches = false

[[tool]]
number = 1
name = "3 mm end mill"
diameter = 3
#type = "flat"               # flat, ball, v or drill
#flutes = 2
#flute-length = 12
feed = 1000
plunge-feed = 300
spindle-speed = 18000
depth-per-pass = 1
#material.plywood = {{ feed = 1500, depth-per-pass = 1.5 }}

#[[tool]]
#number = 2
#name = "60 degree v-bit"
#type = "v"
#angle = 60
#diameter = 6

# The shapes of the drawing, for select = {{ id = "...", layer = "...", fill = "red", stroke = "#00f", order = [1, 2] }}:
{listed}
[[operation]]
kind = "profile"             # profile, pocket, drill, engrave, v-carve, facing or chamfer
name = "cut out"
tool = 1                     # by number or name
#select = {{ id = "plate" }}   # all shapes unless it is said
through = true               # or depth = 3
#side = "outside"            # outside of parts and inside of holes; inside; on
#start-depth = 0
#passes = "even"             # or stepped
#final-pass = 0.3            # thickness of the last pass
#path-radius = "auto"        # smallest radius of the path in inside corners
#entry = "ramp"              # ramp, helix, plunge or predrilled
#lead = 2                    # radius of the arcs on which the tool comes and goes
#tabs = {{ count = 3, width = 6, height = 2 }}    # or spacing = 80, or at = [[10, 0], [50, 0]]
#onion-skin = 0.2            # left at the floor until everything else is cut
#allowance = 0.3             # left at the walls for a finishing pass
#corners = "round"           # or dogbone, t-bone: square parts fit
#rest-of = 2                 # only what that larger tool has left

#[[operation]]
#kind = "pocket"
#tool = 1
#depth = 2
#stepover = "40%"            # of the tool's diameter, or a length
#pattern = "rings"           # or raster

#[[operation]]
#kind = "drill"              # circles; wider ones than the tool are bored on a helix
#tool = 1
#through = true
#peck = 2

#[[operation]]
#kind = "v-carve"
#tool = 2
#max-depth = 3

#[[keepout]]                 # clamps: no tool goes here
#x = [0, 20]
#y = [0, 10]
#top = 12
"##,
        stem = drawing.rsplit_once('.').map_or(drawing.as_str(), |(stem, _)| stem),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::{JobFile, SetupFile};
    use crate::units::DrawingScale;

    #[test]
    fn the_sample_is_read_as_it_stands_and_with_every_key_in_force() {
        let scale = DrawingScale { mm_per_unit: Some(1.0), diagonal: 100.0 };
        let text = commented_sample("a.svg", &[SampleShape { words: "1 circle \"x\ny\"".into() }]);
        let file: SetupFile = text.parse().unwrap();
        let setup = file.resolve(&JobFile::default(), &scale).unwrap();
        assert_eq!((setup.operations.len(), setup.tools.len()), (1, 1));
        // Every line that is a key or a table behind a # is good as well; no line is forgotten when keys change.
        let uncomment = |line: &str| match line.strip_prefix('#') {
            Some(rest) if rest.starts_with(|c: char| c.is_ascii_lowercase() || c == '[') => rest.to_owned(),
            _ => line.to_owned(),
        };
        let all: String = text.lines().map(|l| uncomment(l) + "\n").collect();
        let file: SetupFile = all.parse().unwrap_or_else(|e| panic!("{e}"));
        let setup = file.resolve(&JobFile::default(), &scale).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((setup.operations.len(), setup.tools.len(), setup.keepouts.len()), (4, 2, 1));
    }
}
