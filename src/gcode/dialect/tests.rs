use super::*;
use crate::gcode::block::Block;

#[test]
fn every_built_in_file_is_a_dialect() {
    assert_eq!(BUILT_IN.len(), FILES.len());
    for dialect in Dialect::built_in() {
        assert_eq!(Dialect::named(&dialect.name.to_uppercase()), Ok(dialect));
        // What a dialect writes, it knows.
        let lines = dialect.preamble.iter().chain(&dialect.program_end).chain(&dialect.tool_change);
        for line in lines.chain([&dialect.spindle_off, &dialect.tool_length_offset]) {
            let block = Block::parse(&line.replace("{number}", "1"));
            assert!(block.faults.is_empty(), "{}: {line}", dialect.name);
            for word in block.words {
                let known = match word.letter {
                    'G' | 'M' => dialect.codes.contains(word.letter == 'G', (word.value * 10.0).round() as u32),
                    letter => dialect.knows_letter(letter),
                };
                assert!(known, "{}: {line}", dialect.name);
            }
        }
        assert!(dialect.refuses.values().all(|how| !how.is_empty()));
    }
    assert_eq!((GRBL.name.as_str(), LINUXCNC.name.as_str()), ("grbl", "linuxcnc"));
    assert_eq!(Dialect::portable().name, "portable");
    assert_eq!(Dialect::named("FluidNC").unwrap().name, "grblhal");
    assert_eq!(Dialect::named("mach4").unwrap().name, "mach3");
}

#[test]
fn an_unknown_name_is_told_the_nearest() {
    let error = Dialect::named("gbrl").unwrap_err();
    assert_eq!(error.meant, Some("grbl"));
    let said = error.to_string();
    assert!(said.contains("do you mean grbl?") && said.contains("smoothieware") && said.contains("fluidnc"), "{said}");
    assert!(!Dialect::named("heidenhain").unwrap_err().to_string().contains("mean"));
}

#[test]
fn a_machine_of_ones_own_says_what_differs() {
    let text = "base = \"grbl\"\ntitle = \"the shed\"\ndecimals-mm = 3\ntool-change = [\"M0\", \"T{number}\"]\n\
                [refuses]\nlow-travel = \"the clamps\"\n";
    let dialect = Dialect::parse(text, "shed").unwrap();
    assert_eq!((dialect.name.as_str(), dialect.decimals_mm, dialect.tool_change.len()), ("shed", 3, 2));
    assert_eq!(dialect.refuses.len(), GRBL.refuses.len() + 1);
    let same = Dialect { name: "grbl".into(), ..Dialect::parse("base = \"grbl\"", "x").unwrap() };
    assert_eq!(same, *GRBL);
    let laser = Dialect::parse("base = \"grbl-laser\"\nname = \"diode\"", "x").unwrap();
    assert_eq!((laser.name.as_str(), laser.machine), ("diode", MachineKind::Laser));
}

#[test]
fn a_wrong_value_is_named_with_its_key() {
    for (line, words) in [
        ("decimals-mm = 1", "decimals-mm"),
        ("decimals-inch = 9", "decimals-inch"),
        ("decimal-mm = 3", "decimal-mm"),
        ("longest-line = 10", "longest-line"),
        ("units = []", "units"),
        ("units = [\"cubit\"]", "cubit"),
        ("letters = \"XZ\"", "letters"),
        ("codes = [\"G1-M3\"]", "G1-M3"),
        ("spindle-on = \"M3\"", "spindle-on"),
        ("spindle-on = \"M3 S{rpm}\"", "spindle-on"),
        ("preamble = [\"G21\\nG90\"]", "preamble"),
        ("tool-change = [\"T{tool} M6\"]", "{number}"),
        ("largest-arc-radius = 0.0", "largest-arc-radius"),
        ("rapid-feed = -1.0", "rapid-feed"),
        ("dwell-word = \"X\"", "dwell-word"),
        ("dwell-units = { P = \"hours\" }", "hours"),
        ("machine = \"pen\"", "pen-up"),
        ("machine = \"saw\"", "saw"),
        ("pen-up-z = 1.0\npen-down-z = 2.0\nmachine = \"pen\"", "pen-down-z"),
        ("name = \"two words\"", "name"),
        ("corner-tolerance = nan", "corner-tolerance"),
        ("[refuses]\nno-such-rule = \"x\"", "no-such-rule"),
        ("arcs = 3", "arcs"),
    ] {
        let error = Dialect::parse(&format!("base = \"grbl\"\n{line}"), "x").unwrap_err().to_string();
        assert!(error.contains(words), "{line}: {error}");
    }
    let error = Dialect::parse("base = \"gbrl\"", "x").unwrap_err().to_string();
    assert!(error.contains("do you mean grbl?"), "{error}");
    let error = Dialect::parse("title = \"alone\"", "x").unwrap_err().to_string();
    assert!(error.contains("missing field"), "{error}");
}
