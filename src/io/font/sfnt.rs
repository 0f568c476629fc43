//! The container of a font: a directory of tables, read and written.

use std::collections::BTreeMap;

use super::FontError;

/// The name of a table.
pub(super) type Tag = [u8; 4];

/// Begins a font with TrueType outlines.
pub(super) const TRUETYPE: u32 = 0x0001_0000;

const OPENTYPE_CFF: u32 = u32::from_be_bytes(*b"OTTO");
const APPLE_TRUETYPE: u32 = u32::from_be_bytes(*b"true");
const COLLECTION: u32 = u32::from_be_bytes(*b"ttcf");

/// What the sum of all words of a font file is, once `head` has its adjustment.
const WHOLE_SUM: u32 = 0xB1B0_AFBA;

/// Where `head` keeps the adjustment.
const ADJUSTMENT: usize = 8;

/// A font file, by tables.
#[derive(Clone, Debug)]
pub(super) struct Sfnt<'a> {
    pub tables: BTreeMap<Tag, &'a [u8]>,
    /// The number of the font in its file.
    pub index: u32,
}

/// The tables of a font may together be so many times as long as its file: in sound ones none share any bytes.
const MOST_SHARING: usize = 2;

impl<'a> Sfnt<'a> {
    /// Reads the directory; `index` tells which font of a collection.
    pub fn parse(bytes: &'a [u8], index: Option<u32>) -> Result<Sfnt<'a>, FontError> {
        let not = |found: &str| FontError::NotAFont { found: found.to_owned() };
        let version = u32_at(bytes, 0).ok_or_else(|| not("it is too short"))?;
        let start = match version {
            TRUETYPE | OPENTYPE_CFF | APPLE_TRUETYPE => 0,
            COLLECTION => {
                let count = u32_at(bytes, 8).unwrap_or(0);
                let chosen = index.or((count == 1).then_some(0)).filter(|i| *i < count);
                let chosen = chosen.ok_or(FontError::Collection { count })?;
                u32_at(bytes, 12 + 4 * chosen as usize).ok_or_else(|| not("its directory is cut off"))? as usize
            }
            _ if bytes.starts_with(b"wOFF") || bytes.starts_with(b"wOF2") => return Err(FontError::WebFont),
            _ => return Err(not("its first bytes are those of something else")),
        };
        if version != COLLECTION && index.is_some_and(|i| i > 0) {
            return Err(FontError::NoCollection);
        }
        let count = u16_at(bytes, start + 4).ok_or_else(|| not("its directory is cut off"))?;
        let (mut tables, mut total) = (BTreeMap::new(), 0);
        for k in 0..usize::from(count) {
            let entry = start + 12 + 16 * k;
            let record = bytes.get(entry..entry + 16).ok_or_else(|| not("its directory is cut off"))?;
            let tag = [record[0], record[1], record[2], record[3]];
            let (offset, length) = (u32_at(record, 8).unwrap_or(0) as usize, u32_at(record, 12).unwrap_or(0) as usize);
            let table = offset.checked_add(length).and_then(|end| bytes.get(offset..end));
            let table = table.ok_or_else(|| FontError::damaged(&tag, "reaches beyond the end of the file"))?;
            // Copies of tables are made: entries that all name the same bytes must not multiply them.
            total += table.len();
            if total > MOST_SHARING * bytes.len() {
                return Err(FontError::damaged(&tag, "shares its bytes with too many others"));
            }
            tables.insert(tag, table);
        }
        Ok(Sfnt { tables, index: index.unwrap_or(0) })
    }

    /// A table that must be there and hold at least `least` bytes.
    pub fn required(&self, tag: &Tag, least: usize) -> Result<&'a [u8], FontError> {
        let table = self.tables.get(tag).copied().ok_or_else(|| FontError::damaged(tag, "is missing"))?;
        if table.len() < least { Err(FontError::damaged(tag, "is cut off")) } else { Ok(table) }
    }
}

/// A font file of `tables`, with its checksums.
pub(super) fn write(tables: &BTreeMap<Tag, Vec<u8>>) -> Vec<u8> {
    let count = tables.len() as u16;
    let log = u16::BITS - 1 - count.max(1).leading_zeros();
    let range = 16u16 << log;
    let mut file = Vec::new();
    file.extend(TRUETYPE.to_be_bytes());
    for number in [count, range, log as u16, (16 * count).wrapping_sub(range)] {
        file.extend(number.to_be_bytes());
    }
    let mut offset = 12 + 16 * tables.len();
    let mut head_at = None;
    for (tag, table) in tables {
        if tag == b"head" {
            head_at = Some(offset);
        }
        file.extend(tag);
        for number in [checksum(tag, table), offset as u32, table.len() as u32] {
            file.extend(number.to_be_bytes());
        }
        offset += table.len().next_multiple_of(4);
    }
    for table in tables.values() {
        file.extend(table);
        file.resize(file.len().next_multiple_of(4), 0);
    }
    if let Some(at) = head_at.map(|at| at + ADJUSTMENT)
        && at + 4 <= file.len()
    {
        file[at..at + 4].fill(0);
        let adjustment = WHOLE_SUM.wrapping_sub(sum(&file));
        file[at..at + 4].copy_from_slice(&adjustment.to_be_bytes());
    }
    file
}

/// The sum of the words of a table; that of `head` without its adjustment.
fn checksum(tag: &Tag, table: &[u8]) -> u32 {
    let all = sum(table);
    match u32_at(table, ADJUSTMENT) {
        Some(adjustment) if tag == b"head" => all.wrapping_sub(adjustment),
        _ => all,
    }
}

fn sum(bytes: &[u8]) -> u32 {
    bytes.chunks(4).fold(0, |sum: u32, word| {
        let mut padded = [0; 4];
        padded[..word.len()].copy_from_slice(word);
        sum.wrapping_add(u32::from_be_bytes(padded))
    })
}

pub(super) fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(bytes.get(at..at.checked_add(2)?)?.try_into().ok()?))
}

pub(super) fn i16_at(bytes: &[u8], at: usize) -> Option<i16> {
    u16_at(bytes, at).map(|x| x as i16)
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

/// Replaces the number at `at`, where the table reaches so far.
pub(super) fn put_u16(table: &mut [u8], at: usize, number: u16) {
    if let Some(place) = table.get_mut(at..at + 2) {
        place.copy_from_slice(&number.to_be_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn font() -> Vec<u8> {
        let mut head = vec![7u8; 54];
        head[8..12].fill(9);
        write(&BTreeMap::from([(*b"head", head), (*b"name", b"odd".to_vec()), (*b"glyf", vec![])]))
    }

    #[test]
    fn what_is_written_is_read_and_sums_up() {
        let file = font();
        let read = Sfnt::parse(&file, None).unwrap();
        assert_eq!(read.tables.keys().collect::<Vec<_>>(), [b"glyf", b"head", b"name"]);
        assert_eq!(read.tables[b"name"], b"odd");
        assert_eq!(sum(&file), WHOLE_SUM);
        assert_eq!(file.len() % 4, 0);
        // The directory: two of three tables are the largest power of two.
        assert_eq!(&file[4..12], [0, 3, 0, 32, 0, 1, 0, 16]);
    }

    #[test]
    fn broken_containers_are_errors() {
        let file = font();
        for length in 0..file.len() {
            // Only the padding of the last table may be missing.
            assert!(Sfnt::parse(&file[..length], None).is_err() || length + 1 >= file.len(), "{length}");
        }
        assert_eq!(Sfnt::parse(b"wOF2....", None).unwrap_err(), FontError::WebFont);
        assert!(matches!(Sfnt::parse(b"<svg></svg>", None), Err(FontError::NotAFont { .. })));
        assert_eq!(Sfnt::parse(&file, Some(1)).unwrap_err(), FontError::NoCollection);
        // A hundred entries that all name the whole file.
        let mut many = TRUETYPE.to_be_bytes().to_vec();
        many.extend([0, 100, 0, 0, 0, 0, 0, 0]);
        let length: u32 = 12 + 100 * 16;
        for k in 0..100 {
            many.extend([b'a', b'b', b'c', k, 0, 0, 0, 0, 0, 0, 0, 0]);
            many.extend(length.to_be_bytes());
        }
        assert!(matches!(Sfnt::parse(&many, None), Err(FontError::Damaged { .. })));
    }

    #[test]
    fn of_a_collection_one_font_is_chosen() {
        let mut file = b"ttcf\0\x01\0\0\0\0\0\x02\0\0\0\0\0\0\0\x14".to_vec();
        file[12..16].copy_from_slice(&20u32.to_be_bytes());
        file.extend(TRUETYPE.to_be_bytes());
        file.extend([0; 8]);
        assert_eq!(Sfnt::parse(&file, None).unwrap_err(), FontError::Collection { count: 2 });
        assert!(Sfnt::parse(&file, Some(1)).unwrap().tables.is_empty());
        assert_eq!(Sfnt::parse(&file, Some(2)).unwrap_err(), FontError::Collection { count: 2 });
    }
}
