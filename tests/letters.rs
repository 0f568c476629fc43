//! Lines of text and whole fonts, by the command, on a small font.
#![cfg(feature = "text")]

mod small_font;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use clopen::io::font::{self, Face, Fate, RestyleOptions, Sampling};
use clopen::plane::Region;
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use small_font::*;

/// The radius of most tests, in font units.
const R: f64 = 40.0;

/// The tables of a font file.
fn opened(bytes: &[u8]) -> Tables {
    let u32_at = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_be_bytes([bytes[4], bytes[5]]));
    let table = |k: usize| {
        let at = 12 + 16 * k;
        (bytes[at..at + 4].try_into().unwrap(), bytes[u32_at(at + 8)..u32_at(at + 8) + u32_at(at + 12)].to_vec())
    };
    (0..count).map(table).collect()
}

/// The bytes of a glyph, without padding of whole words.
fn glyph(tables: &Tables, number: usize) -> Vec<u8> {
    let long = tables[b"head"][51] == 1;
    let offset = |k: usize| {
        let loca = &tables[b"loca"];
        if long {
            u32::from_be_bytes(loca[4 * k..4 * k + 4].try_into().unwrap()) as usize
        } else {
            2 * usize::from(u16::from_be_bytes([loca[2 * k], loca[2 * k + 1]]))
        }
    };
    tables[b"glyf"][offset(number)..offset(number + 1)].to_vec()
}

fn clopen() -> Command {
    Command::cargo_bin("clopen").unwrap()
}

/// A folder with the font `test.ttf` in it.
fn folder(tables: &Tables) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let font = folder.path().join("test.ttf");
    std::fs::write(&font, file(tables)).unwrap();
    (folder, font)
}

/// What a command says that cannot run: one line.
fn refusal(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert_eq!(text.trim_end().lines().count(), 1, "{text}");
    text
}

/// Restyles the font; the report and the tables of the new one.
fn restyled(font: &Path, arguments: &[&str]) -> (serde_json::Value, Tables, Vec<u8>) {
    let new = font.with_file_name("new.ttf");
    let mut command = clopen();
    command.args(["font", "--format", "json", "-o"]).arg(&new).arg(font).args(arguments);
    let output = command.assert().success().get_output().stdout.clone();
    let bytes = std::fs::read(&new).unwrap();
    (serde_json::from_slice(&output).unwrap(), opened(&bytes), bytes)
}

/// What a text fills, in font units.
fn set(bytes: &[u8], text: &str) -> Region {
    let face = Face::parse(bytes, None).unwrap();
    font::line(&face, text, Sampling::new(EM, R), 100.0).unwrap().region
}

#[test]
fn a_line_of_text_is_set_with_kerning_on_a_page_of_its_size() {
    let (_folder, font) = folder(&tables());
    let text = |word: &str| {
        let mut command = clopen();
        command.args(["text", word, "-r", "40u", "--op", "close", "--size", "50mm", "--font"]).arg(&font);
        String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
    };
    let svg = text("LB");
    // Two advances less the kerning; ascender 800, descender -200; an em of 50 mm.
    assert!(svg.contains("viewBox=\"0 -800 1110 1000\""), "{svg}");
    assert!(svg.contains("width=\"55.5mm\" height=\"50mm\""), "{svg}");
    // The inside corner of the L, filled by the disk; the box has none and is where kerning puts it.
    assert_eq!(svg.matches("A40 40").count(), 1, "{svg}");
    assert!(svg.contains("610 -300") && svg.contains("910 0"), "{svg}");
    assert!(text("BL").contains("viewBox=\"0 -800 1200 1000\""));
    // A curve that does not move is written as the font's own.
    assert!(text("O").contains("Q512 -600"), "{}", text("O"));
}

#[test]
fn radii_are_font_units_or_parts_of_the_em() {
    let (_folder, font) = folder(&tables());
    let text = |radius: &str| {
        let mut command = clopen();
        command.args(["text", "L", "-r", radius, "--font"]).arg(&font);
        String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
    };
    let expected = text("40u");
    // Five convex corners.
    assert_eq!(expected.matches("A40 40").count(), 5);
    for radius in ["40", "40em/1000", "0.04em"] {
        assert_eq!(text(radius), expected, "{radius}");
    }
}

#[test]
fn what_cannot_be_set_is_refused_in_one_sentence() {
    let (folder, font) = folder(&tables());
    let text = |word: &str, radius: &str, font: &Path| {
        refusal(clopen().args(["text", word, "-r", radius, "--font"]).arg(font))
    };
    let missing = text("LEB\u{e9}", "40u", &font);
    assert!(missing.contains("'E' (U+0045), '\u{e9}' (U+00E9)"), "{missing}");
    assert!(text("", "40u", &font).contains("no text"));
    assert!(text("L\nB", "40u", &font).contains("U+000A"));
    assert!(text(" ", "40u", &font).contains("blank"));
    assert!(text("q", "40u", &font).contains("blank"));
    assert!(text("L", "1001", &font).contains("the em, which is 1000"));
    assert!(text("L", "0", &font).contains("--radius"));
    assert!(text("L", "40u", &folder.path().join("absent.ttf")).contains("absent.ttf"));
    let other = folder.path().join("other.ttf");
    std::fs::write(&other, "G1 X3").unwrap();
    assert!(text("L", "40u", &other).contains("no TrueType or OpenType font"));
}

#[test]
fn a_closed_font_has_filled_corners_and_all_else_as_it_was() {
    let (_folder, font) = folder(&tables());
    let (report, new, bytes) = restyled(&font, &["-r", "40u", "--op", "close"]);
    let old = tables();
    for tag in [b"cmap", b"kern", b"OS/2"] {
        assert_eq!(new[tag], old[tag]);
    }
    for tag in [b"fpgm", b"prep", b"cvt ", b"DSIG", b"LTSH"] {
        assert!(!new.contains_key(tag));
    }
    let advances = |t: &Tables| t[b"hmtx"].chunks(4).map(|c| [c[0], c[1]]).collect::<Vec<_>>();
    assert_eq!(advances(&new), advances(&old));
    // The corner of the L gains what is between a square of side r and a quarter of the disk.
    let gained = set(&bytes, "L").area() - (200.0 * 700.0 + 300.0 * 200.0);
    assert!((gained - R * R * (1.0 - PI / 4.0)).abs() < 0.5 * R, "{gained}");
    // A box has nothing to fill, a round letter neither: their bytes, without instructions.
    let box_before = glyph(&old, 3);
    assert_eq!(glyph(&new, 3)[..box_before.len()], box_before);
    let (before, after) = (glyph(&old, 4), glyph(&new, 4));
    assert_eq!(before[..12], after[..12]);
    assert_eq!(before[12..15], [0, 1, 0x4F]);
    assert_eq!(before[15..51], after[14..50]);
    assert_eq!((&report["kept"], &report["changed"], &report["blank"]), (&5.into(), &3.into(), &1.into()), "{report}");
    assert_eq!(report["kept_glyphs"].as_array().unwrap().len(), 5, "{report}");
    let names = &report["after"];
    assert_eq!(names["family"], "Test Sans Close 40");
    assert_eq!(names["postscript"], "TestSansClose40-Regular");
    assert_eq!((&names["version"], &names["licence"]), (&"Version 2.501".into(), &"Do what you like".into()));
    assert!(report["largest_deviation_font_units"].as_f64().unwrap() <= 0.5);
}

#[test]
fn bearings_and_boxes_are_those_of_the_new_outlines() {
    // A bar 60 wide stands out of a box to the left; a disk of 40 does not fit into it.
    let mut tables = tables();
    let spiked =
        [on(100, 0), on(100, 120), on(0, 120), on(0, 180), on(100, 180), on(100, 300), on(400, 300), on(400, 0)];
    tables.insert(*b"glyf", simple(&[&spiked], &[]));
    let end = tables[b"glyf"].len() as i32 / 2;
    tables.insert(*b"loca", words(&[&[0, 0, 0, 0], &[end; 6][..]].concat()));
    let (_folder, font) = folder(&tables);
    let (_, new, bytes) = restyled(&font, &["-r", "40u", "--op", "open", "--family", "Stub"]);
    let bounds = set(&bytes, "B").bounds();
    let header: Vec<i16> = glyph(&new, 3)[2..10].chunks(2).map(|c| i16::from_be_bytes([c[0], c[1]])).collect();
    // The disk stands between the corners, 60 apart, and bulges out of them.
    let bulge = 100.0 - (40.0 - (40.0f64.powi(2) - 30.0f64.powi(2)).sqrt());
    assert!((bounds.min.x - bulge).abs() < 1.0, "{bounds:?}");
    assert_eq!([f64::from(header[0]), f64::from(header[2])], [bounds.min.x, bounds.max.x]);
    // The bearing was 100 to the left of what the outline had, and still is.
    let bearing = i16::from_be_bytes([new[b"hmtx"][14], new[b"hmtx"][15]]);
    assert_eq!(bearing, header[0] + 100);
    assert_eq!(new[b"head"][36..38], header[0].to_be_bytes());
}

#[test]
fn composites_draw_what_the_operation_makes_of_their_own_outline() {
    let (_folder, font) = folder(&tables());
    let radius = Radius::new(R).unwrap();
    let original = file(&tables());
    // Boxes apart, closed or opened, are two boxes closed or opened. An L of half the size keeps more than half of an L.
    // What overlaps has inside corners that its parts do not have, to be closed; opened, its corners are those of its
    // parts.
    for (operation, composites) in [("open", [true, true, false]), ("close", [true, false, false])] {
        let (_, new, bytes) = restyled(&font, &["-r", "40u", "--op", operation]);
        for ((letter, number), stays) in [("d", 5), ("x", 6), ("s", 7)].into_iter().zip(composites) {
            assert_eq!(glyph(&new, number)[0] == 0xFF, stays, "{operation} {letter}");
            let before = set(&original, letter);
            let exact = match operation {
                "open" => rolling::open(&before, radius, Topology::Keep).region.area(),
                _ => rolling::close(&before, radius, Topology::Keep).region.area(),
            };
            let written = set(&bytes, letter).area();
            assert!((written - exact).abs() < 100.0, "{operation} {letter}: {written} {exact}");
            let is_moved = (written - before.area()).abs() > 200.0;
            assert_eq!(is_moved, (operation, letter) != ("close", "d"), "{operation} {letter}");
        }
    }
}

#[test]
fn the_same_font_gives_the_same_bytes_whatever_the_threads() {
    let original = file(&tables());
    let face = Face::parse(&original, None).unwrap();
    let radius = Radius::new(R).unwrap();
    let open = |region: &Region| Some(rolling::open(region, radius, Topology::Keep).region);
    let with = |threads| {
        let options = RestyleOptions { sampling: Sampling::new(EM, R), tolerance: 0.5, threads };
        font::restyle(&face, "Other", &open, &options, &|_| {}).unwrap()
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.bytes, three.bytes);
    assert_eq!(one.fates[2], Fate::Changed);
    // An operation that vouches for nothing changes nothing.
    let options = RestyleOptions { sampling: Sampling::new(EM, R), tolerance: 0.5, threads: 1 };
    let refused = font::restyle(&face, "Other", &|_| None, &options, &|_| {}).unwrap();
    assert!(matches!(refused.fates[2], Fate::Refused(_)));
    assert_eq!(set(&refused.bytes, "LBOdxs"), set(&original, "LBOdxs"));
}

#[test]
fn fonts_that_must_not_be_changed_are_refused_in_one_sentence() {
    let refused = |change: &dyn Fn(&mut Tables), arguments: &[&str]| {
        let mut tables = tables();
        change(&mut tables);
        let (folder, font) = folder(&tables);
        let new = folder.path().join("new.ttf");
        let text = refusal(clopen().args(["font", "-r", "40u", "-o"]).arg(&new).arg(&font).args(arguments));
        assert!(!new.exists());
        text
    };
    let with = |tag: &'static [u8; 4]| {
        move |tables: &mut Tables| {
            tables.insert(*tag, vec![0; 8]);
        }
    };
    assert!(refused(&with(b"fvar"), &[]).contains("variable font"));
    assert!(refused(&|t| t.get_mut(b"OS/2").unwrap()[9] = 2, &[]).contains("forbids modification"));
    assert!(refused(&|_| {}, &["--family", "test sans"]).contains("name of the original"));
    assert!(refused(&|_| {}, &["--index", "1"]).contains("collection"));
    assert!(refused(&|_| {}, &["--tolerance", "0u"]).contains("--tolerance"));
    assert!(refused(&|t| drop(t.remove(b"glyf")), &[]).contains("no outlines"));
    assert!(refused(&|t| drop(t.remove(b"name")), &[]).contains("'name'"));
    assert!(refused(&|t| t.get_mut(b"loca").unwrap()[2] = 0x7F, &[]).contains("'loca'"));
}

#[test]
fn damaged_glyphs_stay_and_are_named() {
    let mut tables = tables();
    // The composite of two boxes is made of itself; the box is cut off.
    let glyf = tables.get_mut(b"glyf").unwrap();
    let itself = composite(&[(3, 0, 0, None), (3, 400, 0, None)]);
    let at = glyf.windows(itself.len()).position(|w| w == itself).unwrap();
    glyf[at + 12..at + 14].copy_from_slice(&[0, 5]);
    let (_folder, font) = folder(&tables);
    let new = font.with_file_name("new.ttf");
    let mut command = clopen();
    let output = command.args(["font", "-r", "40u", "-o"]).arg(&new).arg(&font).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("glyph 5") && text.contains("its own components"), "{text}");
    assert!(Face::parse(&std::fs::read(&new).unwrap(), None).is_ok());
}

#[test]
fn no_damage_to_a_font_ends_in_a_panic() {
    let good = file(&tables());
    let radius = Radius::new(R).unwrap();
    let open = |region: &Region| Some(rolling::open(region, radius, Topology::Keep).region);
    let options = RestyleOptions { sampling: Sampling::new(EM, R), tolerance: 0.5, threads: 1 };
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let (mut done, mut refused) = (0, 0);
    for _ in 0..500 {
        let mut bytes = good.clone();
        for _ in 0..=random(3) {
            let at = random(bytes.len());
            bytes[at] = [0, 1, 0x7F, 0x80, 0xFF, random(256) as u8][random(6)];
        }
        if random(8) == 0 {
            bytes.truncate(random(good.len()));
        }
        match Face::parse(&bytes, None).and_then(|face| {
            let _ = font::line(&face, "LBdxs", Sampling::new(EM, R), 10.0);
            font::restyle(&face, "Other", &open, &options, &|_| {})
        }) {
            Ok(restyled) => {
                done += 1;
                assert!(Face::parse(&restyled.bytes, None).is_ok());
            }
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
            }
        }
    }
    assert!(done > 50 && refused > 50, "{done} {refused}");
}

#[test]
fn a_font_of_a_thousand_units_keeps_its_tolerance() {
    let paths = [
        "/usr/share/texmf/fonts/opentype/public/tex-gyre/texgyretermes-regular.otf",
        "/usr/share/fonts/opentype/ebgaramond/EBGaramond12-Regular.otf",
    ];
    let found = paths.iter().find_map(|path| std::fs::read(path).ok());
    let Some(bytes) = found else {
        println!("skipped: {} are absent", paths.join(" and "));
        return;
    };
    let face = Face::parse(&bytes, None).unwrap();
    let radius = Radius::new(30.0).unwrap();
    let open = |region: &Region| Some(rolling::open(region, radius, Topology::Keep).region);
    let options = RestyleOptions { sampling: Sampling::new(face.units_per_em(), 30.0), tolerance: 0.5, threads: 2 };
    let restyled = font::restyle(&face, "Other", &open, &options, &|_| {}).unwrap();
    assert_eq!(restyled.beyond, Vec::<u16>::new());
    assert!(restyled.deviation.0 <= 0.5, "{:?}", restyled.deviation);
    assert!(restyled.fates.iter().filter(|f| **f == Fate::Changed).count() > 500);
}

#[test]
fn a_glyph_beyond_the_tolerance_is_a_failed_check() {
    // The box alone, its corners rounded: a hundredth of a unit cannot be kept on a grid of units.
    let mut tables = tables();
    let only = [on(100, 0), on(100, 300), on(400, 300), on(400, 0)];
    tables.insert(*b"glyf", simple(&[&only], &[]));
    let end = tables[b"glyf"].len() as i32 / 2;
    tables.insert(*b"loca", words(&[&[0, 0, 0, 0], &[end; 6][..]].concat()));
    let (_folder, font) = folder(&tables);
    let new = font.with_file_name("new.ttf");
    let mut command = clopen();
    command.args(["font", "-r", "40.3u", "--op", "open", "--tolerance", "0.01u", "-o"]).arg(&new).arg(&font);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("BEYOND TOLERANCE: glyph 3"), "{text}");
    // It is written all the same.
    assert!(Face::parse(&std::fs::read(&new).unwrap(), None).is_ok());
}

#[test]
fn a_specimen_is_a_picture() {
    let (folder, font) = folder(&tables());
    let sheet = folder.path().join("sheet.png");
    restyled(&font, &["-r", "40u", "--sheet", sheet.to_str().unwrap()]);
    assert_eq!(std::fs::read(&sheet).unwrap()[1..4], *b"PNG");
}

#[test]
fn ligatures_of_an_installed_font_are_set() {
    let path = Path::new("/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf");
    let Ok(bytes) = std::fs::read(path) else {
        println!("skipped: {} is absent", path.display());
        return;
    };
    let face = Face::parse(&bytes, None).unwrap();
    assert_eq!(font::shape(&face, "fi").unwrap().len(), 1);
    let width = |text: &str| font::shape(&face, text).unwrap().iter().map(|g| g.advance).sum::<f64>();
    assert!(width("AV") < width("A") + width("V"));
}
