//! Components of components of components: a small font that would take for ever to draw.
#![cfg(feature = "text")]

use clopen::io::font::{self, Face, Sampling};

const EM: f64 = 1000.0;

fn words(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| (*n as u16).to_be_bytes()).collect()
}

/// A font of the letter L, which is `width` times the next glyph, which is as many times the next, `levels` deep; the last glyph
/// is blank.
fn font(levels: i32, width: i32) -> Vec<u8> {
    let (mut glyf, mut loca) = (vec![], vec![0, 0]);
    for level in 1..=levels {
        glyf.extend(words(&[-1, 0, 0, 0, 0]));
        for k in 1..=width {
            let more = if k < width { 0x20 } else { 0 };
            glyf.extend(words(&[0x0003 | more, level + 1, 0, 0]));
        }
        loca.push((glyf.len() / 2) as i32);
    }
    loca.push((glyf.len() / 2) as i32);
    let count = levels + 2;
    let mut head = words(&[1, 0, 2, 0x8000, 0, 0, 0x5F0F, 0x3CF5, 0, EM as i32]);
    head.resize(54, 0);
    // One range of codes: L is glyph 1.
    let cmap = words(&[0, 1, 3, 1, 0, 12, 4, 32, 0, 4, 4, 1, 0, 76, 0xFFFF, 0, 76, 0xFFFF, 1 - 76, 1, 0, 0]);
    let tables = [
        (b"cmap", cmap),
        (b"glyf", glyf),
        (b"head", head),
        (b"hhea", words(&[1, 0, 800, -200, 0, 600, 0, 0, 600, 1, 0, 0, 0, 0, 0, 0, 0, count])),
        (b"hmtx", words(&[600, 0].repeat(count as usize))),
        (b"loca", words(&loca)),
        (b"maxp", words(&[1, 0, count, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, width, levels])),
    ];
    let mut file = words(&[1, 0, tables.len() as i32, 0, 0, 0]);
    let mut body = Vec::new();
    for (tag, table) in &tables {
        let offset = 12 + 16 * tables.len() + body.len();
        file.extend(*tag);
        [0, offset as u32, table.len() as u32].iter().for_each(|n| file.extend(n.to_be_bytes()));
        body.extend(table);
        body.resize(body.len().next_multiple_of(4), 0);
    }
    [file, body].concat()
}

fn drawn(levels: i32, width: i32) -> String {
    let bytes = font(levels, width);
    let face = Face::parse(&bytes, None).unwrap();
    font::line(&face, "L", Sampling::new(EM, 40.0), 10.0).unwrap_err().to_string()
}

#[test]
fn components_that_multiply_are_refused_and_not_walked() {
    // Ten thousand of nothing are a blank.
    assert!(drawn(4, 10).contains("blank"), "{}", drawn(4, 10));
    assert!(drawn(12, 40).contains("more components"), "{}", drawn(12, 40));
}
