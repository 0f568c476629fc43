//! A restyled font, table by table.

use std::collections::BTreeMap;

use skrifa::MetadataProvider as _;

use super::contour::Contour;
use super::face::{Face, OutlineFormat, bearing_at};
use super::names::{FontNames, Names};
use super::restyle::{self, Done, Fate, Operation, RestyleOptions};
use super::sfnt::{self, Tag, i16_at, put_u16, u16_at, u32_at};
use super::{FontError, glyf};

/// Tables that do not fit new outlines: instructions and what they are made from, widths and heights of instructed glyphs,
/// bitmaps of the old ones, signatures, outlines in another format.
const DROPPED: [Tag; 26] = [
    *b"fpgm", *b"prep", *b"cvt ", *b"hdmx", *b"LTSH", *b"VDMX", *b"DSIG", *b"EBDT", *b"EBLC", *b"EBSC", *b"bdat",
    *b"bloc", *b"TSI0", *b"TSI1", *b"TSI2", *b"TSI3", *b"TSI5", *b"TSIB", *b"TSID", *b"TSIJ", *b"TSIP", *b"TSIS",
    *b"TSIV", *b"TTFA", *b"CFF ", *b"CFF2",
];

/// How much `head.fontRevision` is raised: names tell three decimals.
const REVISION_STEPS: f64 = 1000.0;

/// Bits of `head.flags` that speak of instructions: they depend on the size, and may alter advances.
const INSTRUCTED: u16 = 0x0014;

/// Smooth outlines at every size, in `gasp`: grey, and smooth in both directions.
const SMOOTH: u16 = 0x000A;

/// The licence bits of OS/2 fsType that forbid to modify a font, and those that all speak of a licence.
const RESTRICTED: u16 = 0x0002;
const LICENCE_BITS: u16 = 0x000F;

/// What was done to a font.
#[derive(Clone, Debug)]
pub struct Restyled {
    /// The new font, always with TrueType outlines.
    pub bytes: Vec<u8>,
    /// What became of each glyph.
    pub fates: Vec<Fate>,
    /// The largest distance between what was written and the exact result, and of which glyph, in font units.
    pub deviation: (f64, u16),
    /// Glyphs whose distance exceeds the tolerance.
    pub beyond: Vec<u16>,
    /// What it was called.
    pub before: FontNames,
    /// What it is called.
    pub after: FontNames,
    /// OS/2 fsType, which stays as it is.
    pub fs_type: Option<u16>,
    /// Which outlines it had.
    pub format: OutlineFormat,
    /// The tables that were dropped.
    pub dropped: Vec<String>,
}

/// Restyles a whole font: every glyph goes through `operation`; the result is called `family`. `progress` is told how many
/// glyphs are done.
///
/// # Errors
/// Where the font is damaged, forbids modification, or must not be called `family`.
pub fn restyle(
    face: &Face,
    family: &str,
    operation: &Operation,
    options: &RestyleOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Restyled, FontError> {
    let fs_type = face.sfnt.tables.get(b"OS/2").and_then(|table| u16_at(table, 8));
    if let Some(bits) = fs_type.filter(|bits| bits & LICENCE_BITS == RESTRICTED) {
        return Err(FontError::Restricted(bits));
    }
    let head = face.sfnt.required(b"head", 54)?;
    let revision = f64::from(u32_at(head, 4).unwrap_or(0) as i32) / 65536.0;
    let revision = ((revision * REVISION_STEPS).round() + 1.0) / REVISION_STEPS;
    let mut names = Names::parse(face.sfnt.required(b"name", 6)?)?;
    let before = names.summary();
    names.rename(family, &format!("{revision:.3}"))?;

    let done = restyle::glyphs(face, operation, options, progress);

    let mut tables: BTreeMap<Tag, Vec<u8>> =
        face.sfnt.tables.iter().map(|(tag, table)| (*tag, table.to_vec())).collect();
    let is_dropped = |tag: &Tag| DROPPED.contains(tag);
    let dropped = tables.keys().filter(|tag| is_dropped(tag)).map(|tag| String::from_utf8_lossy(tag).into_owned());
    let dropped = dropped.collect();
    tables.retain(|tag, _| !is_dropped(tag));
    let (glyf, loca, long) = glyf_and_loca(&done);
    tables.insert(*b"glyf", glyf);
    tables.insert(*b"loca", loca);
    tables.insert(*b"head", new_head(head, &done, revision, long));
    let (hmtx, hhea) = metrics(face, &done);
    tables.insert(*b"hmtx", hmtx);
    tables.insert(*b"hhea", hhea);
    vertical_metrics(&mut tables, &done);
    let maxp = face.sfnt.required(b"maxp", 6)?;
    tables.insert(*b"maxp", new_maxp(maxp, &done));
    tables.insert(*b"gasp", [1u16, 1, 0xFFFF, SMOOTH].iter().flat_map(|n| n.to_be_bytes()).collect());
    if let Some(post) = tables.get_mut(b"post")
        && let Some(named) = with_glyph_names(post, face)
    {
        *post = named;
    }
    let too_long =
        || FontError::Name("the names are too long for the table 'name': choose a shorter --family".to_owned());
    tables.insert(*b"name", names.to_bytes().ok_or_else(too_long)?);
    // Of equals the first.
    let worst =
        done.iter().enumerate().fold(
            (0.0, 0),
            |worst: (f64, u16), (glyph, d)| {
                if d.deviation > worst.0 { (d.deviation, glyph as u16) } else { worst }
            },
        );
    let beyond = done.iter().enumerate().filter(|(_, d)| d.deviation > options.tolerance).map(|(k, _)| k as u16);
    Ok(Restyled {
        bytes: sfnt::write(&tables),
        fates: done.iter().map(|d| d.fate).collect(),
        deviation: worst,
        beyond: beyond.collect(),
        before,
        after: names.summary(),
        fs_type,
        format: face.format(),
        dropped,
    })
}

/// Both tables, and whether offsets are long.
fn glyf_and_loca(done: &[Done]) -> (Vec<u8>, Vec<u8>, bool) {
    let mut glyf = Vec::new();
    let mut offsets = vec![0u32];
    for d in done {
        glyf.extend(&d.data);
        // Words, as the long format asks; the short one counts in halves of them.
        glyf.resize(glyf.len().next_multiple_of(4), 0);
        offsets.push(glyf.len() as u32);
    }
    // Twice what the largest short offset says.
    let long = glyf.len() > 2 * usize::from(u16::MAX);
    let loca = if long {
        offsets.iter().flat_map(|o| o.to_be_bytes()).collect()
    } else {
        offsets.iter().flat_map(|o| ((o / 2) as u16).to_be_bytes()).collect()
    };
    // A font of blanks still has a table, which must not be empty for some readers.
    if glyf.is_empty() {
        glyf.extend([0; 4]);
    }
    (glyf, loca, long)
}

/// Whether a glyph shows anything, and its box.
fn shown(d: &Done) -> Option<[i16; 4]> {
    let is_shown = d.written.iter().any(|contour: &Contour| !contour.is_empty());
    is_shown.then(|| glyf::whole_box(&d.written))
}

fn new_head(head: &[u8], done: &[Done], revision: f64, long: bool) -> Vec<u8> {
    let mut head = head.to_vec();
    head[4..8].copy_from_slice(&((revision * 65536.0).round() as i32).to_be_bytes());
    let flags = u16_at(&head, 16).unwrap_or(0) & !INSTRUCTED;
    put_u16(&mut head, 16, flags);
    let all =
        done.iter().filter_map(shown).reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]);
    for (k, side) in all.unwrap_or_default().into_iter().enumerate() {
        put_u16(&mut head, 36 + 2 * k, side as u16);
    }
    put_u16(&mut head, 50, u16::from(long));
    // The only format of glyphs.
    put_u16(&mut head, 52, 0);
    head
}

/// `hmtx` with the left bearings of the new outlines, and `hhea` with their extremes. Advances stay.
fn metrics(face: &Face, done: &[Done]) -> (Vec<u8>, Vec<u8>) {
    let mut hmtx = face.hmtx.to_vec();
    let (mut left, mut right, mut extent) = (i16::MAX, i16::MAX, i16::MIN);
    for (glyph, d) in done.iter().enumerate() {
        let glyph = glyph as u16;
        let at = face.bearing_at(glyph);
        let old = i16_at(&hmtx, at).unwrap_or(0);
        let Some([x_min, _, x_max, _]) = shown(d) else {
            if d.fate == Fate::Vanished {
                put_u16(&mut hmtx, at, 0);
            }
            continue;
        };
        // Where the bearing is not the left side of the outline, rasterizers shift the glyph by the difference: it stays. Of
        // cubic outlines nobody has ever looked at it.
        let shift = match (face.format(), d.old_box) {
            (OutlineFormat::TrueType, Some([old_x_min, ..])) => old.saturating_sub(old_x_min),
            _ => 0,
        };
        let bearing = x_min.saturating_add(shift);
        put_u16(&mut hmtx, at, bearing as u16);
        let width = i32::from(x_max) - i32::from(x_min);
        let clamped = |x: i32| x.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16;
        left = left.min(bearing);
        right = right.min(clamped(i32::from(face.advance(glyph)) - i32::from(bearing) - width));
        extent = extent.max(clamped(i32::from(bearing) + width));
    }
    let mut hhea = face.sfnt.tables[b"hhea"].to_vec();
    if extent > i16::MIN {
        [left, right, extent].into_iter().enumerate().for_each(|(k, x)| put_u16(&mut hhea, 12 + 2 * k, x as u16));
    }
    (hmtx, hhea)
}

/// The bearings at the top, where a font is set in columns, too.
fn vertical_metrics(tables: &mut BTreeMap<Tag, Vec<u8>>, done: &[Done]) {
    let Some(count) = tables.get(b"vhea").and_then(|vhea| u16_at(vhea, 34)).filter(|count| *count > 0) else { return };
    let Some(vmtx) = tables.get_mut(b"vmtx") else { return };
    for (glyph, d) in done.iter().enumerate() {
        let at = bearing_at(glyph as u16, count);
        if let (Some([.., y_max]), Some([.., old_y_max]), Some(old)) = (shown(d), d.old_box, i16_at(vmtx, at)) {
            put_u16(vmtx, at, old.saturating_add(old_y_max).saturating_sub(y_max) as u16);
        }
    }
}

fn new_maxp(maxp: &[u8], done: &[Done]) -> Vec<u8> {
    let mut table = 0x0001_0000u32.to_be_bytes().to_vec();
    table.extend(&maxp[4..6]);
    let points = |d: &Done| d.written.iter().map(Vec::len).sum::<usize>();
    let largest =
        |of: &dyn Fn(&Done) -> usize| done.iter().map(of).max().unwrap_or(0).min(usize::from(u16::MAX)) as u16;
    let of_simple = |f: fn(&Done) -> usize| move |d: &Done| if d.nesting.is_none() { f(d) } else { 0 };
    let of_composite = |f: fn(&Done) -> usize| move |d: &Done| if d.nesting.is_some() { f(d) } else { 0 };
    let numbers = [
        largest(&of_simple(points)),
        largest(&of_simple(|d| d.written.len())),
        largest(&of_composite(points)),
        largest(&of_composite(|d| d.written.len())),
        // One zone, and nothing for instructions.
        1,
        0,
        0,
        0,
        0,
        0,
        0,
        largest(&|d| d.nesting.map_or(0, |(count, _)| count)),
        largest(&|d| d.nesting.map_or(0, |(_, depth)| depth)),
    ];
    numbers.iter().for_each(|n| table.extend(n.to_be_bytes()));
    table
}

/// The table `post` with the names of the glyphs, where they stood in the table `CFF `, which is gone.
fn with_glyph_names(post: &[u8], face: &Face) -> Option<Vec<u8>> {
    const NAMELESS: u32 = 0x0003_0000;
    const NAMED: u32 = 0x0002_0000;
    /// Names before these stand for a list that all readers know.
    const FIRST_OWN: u16 = 258;
    const LONGEST: usize = 63;
    if face.format() != OutlineFormat::Cff || u32_at(post, 0) != Some(NAMELESS) {
        return None;
    }
    let names = face.reference.glyph_names();
    let mut table = [&NAMED.to_be_bytes(), post.get(4..32)?, &face.glyph_count.to_be_bytes()].concat();
    let mut strings = Vec::new();
    for glyph in 0..face.glyph_count {
        let name = names.get(skrifa::GlyphId::from(glyph))?;
        let name = name.as_str();
        if name.is_empty() || name.len() > LONGEST || !name.is_ascii() {
            return None;
        }
        table.extend(FIRST_OWN.checked_add(glyph)?.to_be_bytes());
        strings.push(name.len() as u8);
        strings.extend(name.as_bytes());
    }
    table.extend(strings);
    Some(table)
}
