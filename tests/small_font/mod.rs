//! A small font for tests, table by table.

#![allow(dead_code, reason = "every test uses some of it")]

use std::collections::BTreeMap;

/// Font units in an em.
pub const EM: f64 = 1000.0;

pub type Tables = BTreeMap<[u8; 4], Vec<u8>>;
pub type Point = (i16, i16, bool);

pub fn words(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| (*n as u16).to_be_bytes()).collect()
}

/// A glyph of contours, every coordinate in full, with `instructions`.
pub fn simple(contours: &[&[Point]], instructions: &[u8]) -> Vec<u8> {
    let points: Vec<Point> = contours.concat();
    let xs = || points.iter().map(|p| i32::from(p.0));
    let ys = || points.iter().map(|p| i32::from(p.1));
    let bounds = [xs().min(), ys().min(), xs().max(), ys().max()].map(Option::unwrap);
    let mut data = words(&[contours.len() as i32]);
    data.extend(words(&bounds));
    let ends = contours.iter().scan(-1, |end, c| {
        *end += c.len() as i32;
        Some(*end)
    });
    data.extend(words(&ends.collect::<Vec<_>>()));
    data.extend(words(&[instructions.len() as i32]));
    data.extend(instructions);
    data.extend(points.iter().map(|p| u8::from(p.2)));
    for values in [xs().collect::<Vec<_>>(), ys().collect()] {
        let mut before = 0;
        for value in values {
            data.extend(words(&[value - before]));
            before = value;
        }
    }
    data
}

/// A glyph of components: glyph, offset, and scale in 16384ths where it is not 1.
pub fn composite(components: &[(i32, i32, i32, Option<i32>)]) -> Vec<u8> {
    let mut data = words(&[-1, 0, 0, 0, 0]);
    for (k, &(glyph, x, y, scale)) in components.iter().enumerate() {
        let more = if k + 1 < components.len() { 0x20 } else { 0 };
        data.extend(words(&[0x0003 | more | if scale.is_some() { 0x08 } else { 0 }, glyph, x, y]));
        data.extend(scale.map(|s| words(&[s])).unwrap_or_default());
    }
    data
}

pub const fn on(x: i16, y: i16) -> Point {
    (x, y, true)
}

/// Clockwise, as TrueType has it: a corner of two bars 200 wide.
pub const ELL: [Point; 6] = [on(0, 0), on(0, 700), on(200, 700), on(200, 200), on(500, 200), on(500, 0)];
pub const BOX: [Point; 4] = [on(100, 0), on(100, 300), on(400, 300), on(400, 0)];
/// A circle of implied points, nearly.
pub const ROUND: [Point; 8] = [
    (300, 600, true),
    (512, 600, false),
    (600, 512, false),
    (600, 88, false),
    (512, 0, false),
    (88, 0, false),
    (0, 88, false),
    (0, 512, false),
];

/// What the glyphs are for, in their order.
pub const LETTERS: [&str; 9] = ["", " ", "L", "B", "O", "d", "x", "s", "q"];

/// The tables of the font: .notdef, blank, L, B (a box), O (round), d (two boxes apart: a composite), x (L and box that
/// overlap: a composite), s (half an L: a composite), q (a mark of one point).
pub fn tables() -> Tables {
    let glyphs = [
        simple(&[&BOX], &[]),
        vec![],
        simple(&[&ELL], &[0x4F, 0x4F, 0x4F]),
        simple(&[&BOX], &[]),
        simple(&[&ROUND], &[0x4F]),
        composite(&[(3, 0, 0, None), (3, 400, 0, None)]),
        composite(&[(2, 0, 0, None), (3, -50, 100, None)]),
        composite(&[(2, 0, 0, Some(0x2000))]),
        simple(&[&[on(5, 5)]], &[]),
    ];
    let mut tables = Tables::new();
    let (mut glyf, mut loca) = (vec![], vec![0]);
    for glyph in &glyphs {
        glyf.extend(glyph);
        glyf.resize(glyf.len().next_multiple_of(2), 0);
        loca.push((glyf.len() / 2) as i32);
    }
    tables.insert(*b"glyf", glyf);
    tables.insert(*b"loca", words(&loca));
    let count = glyphs.len() as i32;
    let mut head = words(&[1, 0, 2, 0x8000, 0, 0, 0x5F0F, 0x3CF5, 0x0014, EM as i32]);
    head.extend([0; 16]);
    head.extend(words(&[0, 0, 600, 700, 0, 8, 2, 0, 0]));
    tables.insert(*b"head", head);
    tables.insert(*b"hhea", words(&[1, 0, 800, -200, 0, 600, 0, 0, 600, 1, 0, 0, 0, 0, 0, 0, 0, count]));
    let bearings = [100, 0, 0, 100, 0, 100, 0, 0, 5];
    tables.insert(*b"hmtx", words(&bearings.iter().flat_map(|b| [600, *b]).collect::<Vec<_>>()));
    tables.insert(*b"maxp", words(&[1, 0, count, 8, 2, 20, 3, 2, 1, 1, 1, 0, 9, 9, 2, 1]));
    // Format 4 of one range for each letter, in the order of their codes.
    let mut codes: Vec<(i32, i32)> =
        LETTERS.iter().enumerate().filter_map(|(k, l)| l.chars().next().map(|c| (c as i32, k as i32))).collect();
    codes.sort_unstable();
    codes.push((0xFFFF, 0x10000));
    let n = codes.len() as i32;
    let mut subtable = vec![4, 16 + 8 * n, 0, 2 * n, 16, 3, 2 * n - 16];
    subtable.extend(codes.iter().map(|c| c.0));
    subtable.push(0);
    subtable.extend(codes.iter().map(|c| c.0));
    subtable.extend(codes.iter().map(|c| c.1 - c.0));
    subtable.extend(codes.iter().map(|_| 0));
    tables.insert(*b"cmap", words(&[&[0, 1, 3, 1, 0, 12], &subtable[..]].concat()));
    // L and B come 90 units nearer to each other.
    tables.insert(*b"kern", words(&[0, 1, 0, 20, 1, 1, 6, 0, 0, 2, 3, -90]));
    let (mut records, mut strings) = (vec![], vec![]);
    let names = [
        (0, "(c) Nobody"),
        (1, "Test Sans"),
        (2, "Regular"),
        (3, "me"),
        (4, "Test Sans"),
        (5, "Version 2.500"),
        (6, "TestSans-Regular"),
        (13, "Do what you like"),
    ];
    for (name, text) in names {
        let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        records.extend([3, 1, 0x409, name, bytes.len() as i32, strings.len() as i32]);
        strings.extend(bytes);
    }
    let mut name = words(&[0, names.len() as i32, 6 + 2 * records.len() as i32]);
    name.extend(words(&records));
    name.extend(strings);
    tables.insert(*b"name", name);
    let mut os2 = words(&[3, 500, 400, 5, 8]);
    os2.resize(96, 0);
    tables.insert(*b"OS/2", os2);
    for tag in [b"fpgm", b"prep", b"cvt ", b"DSIG", b"LTSH"] {
        tables.insert(*tag, vec![0, 1, 2, 3]);
    }
    tables
}

pub fn file(tables: &Tables) -> Vec<u8> {
    let mut bytes = words(&[1, 0, tables.len() as i32, 0, 0, 0]);
    let mut offset = 12 + 16 * tables.len();
    for (tag, table) in tables {
        bytes.extend(tag);
        [0, offset as u32, table.len() as u32].iter().for_each(|n| bytes.extend(n.to_be_bytes()));
        offset += table.len().next_multiple_of(4);
    }
    for table in tables.values() {
        bytes.extend(table);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}
