//! A commented job file to start from.

use super::SETUP_VERSION;

/// What a drawing has, as far as a job file cares.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleShape {
    /// Its number in the order of the file, `id`, layers and colours, in words.
    pub words: String,
}

/// A job file for a drawing of this name and a machine of this dialect, with every key explained. It is read as it stands: the shapes
/// with the numbers `outer`, or all where there are none, are cut out.
pub fn commented_sample(drawing: &str, dialect: &str, shapes: &[SampleShape], outer: &[usize]) -> String {
    let select = match outer {
        [] => "#select = { id = \"plate\" }   # all shapes unless it is said".to_owned(),
        _ => format!(
            "select = {{ order = {outer:?} }}   # the others lie on these: give them operations of their own, above this one"
        ),
    };
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
dialect = "{dialect}"             # clopen lint --help lists them; a file of your own: "my-machine.toml"
#settings = "grbl.txt"       # what your machine answers to $$: accelerations, speeds, travel
#acceleration = [500, 500, 200]
#rapid = [5000, 5000, 1500]
#junction-deviation = 0.01
#travel = [300, 200, 60]     # programs that need more are refused
#safe-height = 5
#dwell = 3                   # seconds for the spindle to start
#arcs = true
#inches = false
#largest-spindle-speed = 24000   # faster ones are refused; $30 of the settings where it is not said

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

#[[tool]]
#number = 3
#diameter = 1
#depth-per-pass = 0.5

# The shapes of the drawing, for select = {{ id = "...", layer = "...", fill = "red", stroke = "#00f", order = [1, 2] }}:
{listed}
[[operation]]
kind = "profile"             # profile, pocket, drill, engrave, v-carve, facing or chamfer
name = "cut out"
tool = 1                     # by number or name
{select}
through = true               # 0.2 mm deeper than the stock is thick, so that nothing hangs on by a film; or depth = 3
#side = "outside"            # outside of parts and inside of holes; inside; on
#direction = "climb"         # the part on the right of a spindle that turns clockwise; or conventional
#feed = 900                  # along the path, instead of the tool's
#plunge-feed = 250           # in ramps and plunges, instead of the tool's
#spindle-speed = 16000       # turns a minute, instead of the tool's
#depth-per-pass = 0.8        # at most so much deeper from pass to pass, instead of the tool's
#start-depth = 0             # below the top of the stock: what lies above is cut already
#passes = "even"             # or stepped
#final-pass = 0.3            # thickness of the last pass
#path-radius = "auto"        # smallest radius of the path in inside corners
#entry = "ramp"              # ramp, helix, plunge or predrilled
#lead = 2                    # radius of the arcs on which the tool comes and goes
#tabs = {{ count = 3, width = 6, height = 2 }}    # or spacing = 80, or at = [[10, 0], [50, 0]]: x and y of the machine, from
                             # zero of the stock, in mm; a tab stands where the outline is nearest to it
#onion-skin = 0.2            # left at the floor until all outlines of this operation are cut, then cut at its end
#allowance = 0.3             # left at the walls for a finishing pass
#corners = "round"           # or dogbone, t-bone: square parts fit

#[[operation]]
#kind = "pocket"
#tool = 1
#depth = 2
#stepover = "40%"            # of the tool's diameter, or a length
#pattern = "rings"           # or raster

#[[operation]]
#kind = "pocket"
#tool = 3
#depth = 2
#rest-of = 1                 # only what that larger tool has left, in an operation above, as deep

#[[operation]]
#kind = "drill"              # all circles unless select says which; wider ones than the tool are bored on a helix
#tool = 1
#through = true
#peck = 2

#[[operation]]
#kind = "v-carve"
#tool = 2
#max-depth = 3               # wider places get a flat bottom there

#[[operation]]
#kind = "chamfer"            # breaks the edge of outlines; it goes as deep as its width asks for
#tool = 2
#width = 0.5                 # seen from above
#side = "outside"

#[[operation]]
#kind = "engrave"            # along strokes, or the outlines of what is filled
#tool = 2
#depth = 0.3

#[[operation]]
#kind = "facing"             # the top of the stock, or of the shapes, made flat
#tool = 1
#depth = 0.5
#stepover = "40%"

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
        let text = commented_sample("a.svg", "grbl", &[SampleShape { words: "1 circle \"x\ny\"".into() }], &[]);
        let some = commented_sample("a.svg", "linuxcnc", &[], &[1, 3]).parse::<SetupFile>().unwrap();
        assert_eq!(some.operation[0].as_ref().select.order, Some(vec![1, 3]));
        assert_eq!(some.machine.dialect.as_deref(), Some("linuxcnc"));
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
        assert_eq!((setup.operations.len(), setup.tools.len(), setup.keepouts.len()), (8, 3, 1));
    }
}
