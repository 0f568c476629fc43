//! The table `name`: a restyled font must not bear the name of the font it was made from.

use super::FontError;
use super::sfnt::u16_at;

// What names are of.
const COPYRIGHT: u16 = 0;
const FAMILY: u16 = 1;
const STYLE: u16 = 2;
const UNIQUE: u16 = 3;
const FULL: u16 = 4;
const VERSION: u16 = 5;
const POSTSCRIPT: u16 = 6;
const LICENCE: u16 = 13;
const LICENCE_URL: u16 = 14;
const TYPOGRAPHIC_FAMILY: u16 = 16;
const COMPATIBLE_FULL: u16 = 18;
const POSTSCRIPT_CID: u16 = 20;
const WWS_FAMILY: u16 = 21;

/// Longer PostScript names are refused by printers.
const LONGEST_POSTSCRIPT: usize = 63;

/// One name in one language.
#[derive(Clone, Debug, PartialEq)]
struct Record {
    platform: u16,
    encoding: u16,
    language: u16,
    name: u16,
    bytes: Vec<u8>,
}

/// All names of a font.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Names {
    records: Vec<Record>,
    /// What follows the records in a table of format 1: tags of languages.
    languages: Vec<Vec<u8>>,
    format: u16,
}

/// What a font is called, and what its makers say about copying it.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct FontNames {
    /// Name 16, or else 1.
    pub family: String,
    /// Name 4.
    pub full: String,
    /// Name 6.
    pub postscript: String,
    /// Name 5.
    pub version: String,
    /// Name 13.
    pub licence: Option<String>,
    /// Name 14.
    pub licence_url: Option<String>,
}

impl Names {
    pub fn parse(table: &[u8]) -> Result<Names, FontError> {
        let cut = || FontError::damaged(b"name", "is cut off");
        let number = |at| u16_at(table, at).ok_or_else(cut);
        let (format, count, strings) = (number(0)?, number(2)?, usize::from(number(4)?));
        let bytes = |length: u16, offset: u16| {
            let from = strings + usize::from(offset);
            table.get(from..from + usize::from(length)).map(<[u8]>::to_vec).ok_or_else(cut)
        };
        let mut records = Vec::new();
        for k in 0..usize::from(count) {
            let at = 6 + 12 * k;
            records.push(Record {
                platform: number(at)?,
                encoding: number(at + 2)?,
                language: number(at + 4)?,
                name: number(at + 6)?,
                bytes: bytes(number(at + 8)?, number(at + 10)?)?,
            });
        }
        let mut languages = Vec::new();
        if format == 1 {
            let at = 6 + 12 * usize::from(count);
            for k in 0..usize::from(number(at)?) {
                languages.push(bytes(number(at + 2 + 4 * k)?, number(at + 4 + 4 * k)?)?);
            }
        }
        Ok(Names { records, languages, format })
    }

    /// The table; `None` where it is larger than the format can say.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        let head = 6 + 12 * self.records.len() + if self.format == 1 { 2 + 4 * self.languages.len() } else { 0 };
        let mut table = Vec::new();
        let mut strings: Vec<u8> = Vec::new();
        // Equal names share their bytes.
        let mut place = |bytes: &[u8]| -> Option<[u8; 4]> {
            let found = (!bytes.is_empty()).then(|| strings.windows(bytes.len()).position(|w| w == bytes)).flatten();
            let offset = found.unwrap_or_else(|| {
                strings.extend(bytes);
                strings.len() - bytes.len()
            });
            let (length, offset) = (u16::try_from(bytes.len()).ok()?, u16::try_from(offset).ok()?);
            let [a, b] = length.to_be_bytes();
            let [c, d] = offset.to_be_bytes();
            Some([a, b, c, d])
        };
        for number in [self.format, u16::try_from(self.records.len()).ok()?, u16::try_from(head).ok()?] {
            table.extend(number.to_be_bytes());
        }
        for r in &self.records {
            [r.platform, r.encoding, r.language, r.name].iter().for_each(|n| table.extend(n.to_be_bytes()));
            table.extend(place(&r.bytes)?);
        }
        if self.format == 1 {
            table.extend(u16::try_from(self.languages.len()).ok()?.to_be_bytes());
            for language in &self.languages {
                table.extend(place(language)?);
            }
        }
        table.extend(strings);
        Some(table)
    }

    /// The name in English, or in the first language there is.
    fn get(&self, name: u16) -> Option<String> {
        let all = || self.records.iter().filter(|r| r.name == name && r.is_text());
        let english =
            all().find(|r| (r.platform, r.language) == (3, 0x409)).or_else(|| all().find(|r| r.language == 0));
        english.or_else(|| all().next()).map(Record::text)
    }

    pub fn summary(&self) -> FontNames {
        let text = |name| self.get(name).unwrap_or_default();
        FontNames {
            family: self.get(TYPOGRAPHIC_FAMILY).unwrap_or_else(|| text(FAMILY)),
            full: text(FULL),
            postscript: text(POSTSCRIPT),
            version: text(VERSION),
            licence: self.get(LICENCE),
            licence_url: self.get(LICENCE_URL),
        }
    }

    /// Names that the licence reserves for the original (OFL, clause 3).
    fn reserved(&self) -> Vec<String> {
        const PHRASE: &str = "reserved font name";
        let mut reserved = Vec::new();
        for text in [COPYRIGHT, LICENCE].into_iter().filter_map(|name| self.get(name)) {
            let lower = text.to_ascii_lowercase();
            for (at, _) in lower.match_indices(PHRASE) {
                let rest = text[at + PHRASE.len()..].trim_start_matches(['s', 'S']);
                let sentence = rest.split(['\n', '\r', '.', ';', '(']).next().unwrap_or_default();
                let quotes = ['"', '\'', '“', '”', '‘', '’'];
                if sentence.contains(quotes) {
                    reserved.extend(sentence.split(quotes).skip(1).step_by(2).map(str::to_owned));
                } else if !sentence.trim().is_empty() && sentence.len() < 40 {
                    reserved.push(sentence.trim_matches([':', ' ', ',']).to_owned());
                }
            }
        }
        reserved.retain(|name| name.trim().len() > 1 && name.starts_with(char::is_uppercase));
        reserved
    }

    /// Renames the font: `family` is the new name of what was name 16, or 1; `version` as in `head`.
    ///
    /// # Errors
    /// Where the new name is the old one, or one that the licence reserves.
    pub fn rename(&mut self, family: &str, version: &str) -> Result<(), FontError> {
        let old = self.summary();
        let error = |text: String| Err(FontError::Name(text));
        if family.trim().is_empty()
            || family.chars().any(char::is_control)
            || family.chars().count() > LONGEST_POSTSCRIPT
        {
            return error(
                "the family needs a name of at most 63 characters in one line: give one with --family".to_owned(),
            );
        }
        let folded = |name: &str| -> String {
            name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
        };
        if folded(family) == folded(&old.family) || self.get(FAMILY).is_some_and(|f| folded(&f) == folded(family)) {
            return error(format!("\"{family}\" is the name of the original: choose another with --family"));
        }
        if let Some(name) = self.reserved().into_iter().find(|name| folded(family).contains(&folded(name))) {
            return error(format!(
                "the licence reserves the name \"{name}\" for the original, so the restyled font cannot be called \
                 \"{family}\": choose another name with --family"
            ));
        }
        let old_family = self.get(FAMILY).unwrap_or_else(|| old.family.clone());
        // What the family says beyond the typographic family: Condensed, Light.
        let group = if old.family.is_empty() { None } else { old_family.strip_prefix(old.family.as_str()) };
        let new_family = format!("{family}{}", group.unwrap_or_default());
        let style = self.get(STYLE).unwrap_or_default();
        let replaced = |text: &str, prefixes: [(&str, &str); 2], or_else: String| {
            let found = prefixes.iter().find(|(old, _)| !old.is_empty() && text.starts_with(old));
            found.map_or(or_else, |(old, new)| format!("{new}{}", &text[old.len()..]))
        };
        let full = replaced(
            &old.full,
            [(old_family.as_str(), new_family.as_str()), (old.family.as_str(), family)],
            format!("{new_family} {style}").trim_end().to_owned(),
        );
        let tail = old.postscript.split_once('-').map(|(_, tail)| format!("-{tail}")).unwrap_or_default();
        let keeps = LONGEST_POSTSCRIPT.saturating_sub(tail.len());
        let stem: String = postscript(if tail.is_empty() { &new_family } else { family }).chars().take(keeps).collect();
        let postscript = format!("{stem}{tail}");
        for record in &mut self.records {
            let text = record.text();
            let new = match record.name {
                FAMILY => new_family.clone(),
                UNIQUE => format!("{version};clopen;{postscript}"),
                FULL | COMPATIBLE_FULL => full.clone(),
                POSTSCRIPT | POSTSCRIPT_CID => postscript.clone(),
                TYPOGRAPHIC_FAMILY | WWS_FAMILY => family.to_owned(),
                VERSION => revised(&text, version),
                _ => continue,
            };
            record.set(&new)?;
        }
        Ok(())
    }
}

impl Record {
    /// Whether its bytes are known to be text.
    fn is_text(&self) -> bool {
        self.is_wide() || self.platform == 1
    }

    fn is_wide(&self) -> bool {
        matches!(self.platform, 0 | 3)
    }

    fn text(&self) -> String {
        if self.is_wide() {
            let units: Vec<u16> = self.bytes.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
            String::from_utf16_lossy(&units)
        } else {
            // Macintosh Roman and its kin agree with ASCII, which is all that is compared.
            self.bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '\u{fffd}' }).collect()
        }
    }

    fn set(&mut self, text: &str) -> Result<(), FontError> {
        self.bytes = if self.is_wide() {
            text.encode_utf16().flat_map(u16::to_be_bytes).collect()
        } else if text.is_ascii() {
            text.as_bytes().to_vec()
        } else {
            let hint = "the font has names in an old encoding that holds plain letters only: choose such with --family";
            return Err(FontError::Name(format!("\"{text}\" cannot be written: {hint}")));
        };
        Ok(())
    }
}

/// What of a name may stand in a PostScript name.
fn postscript(name: &str) -> String {
    let allowed = |c: &char| c.is_ascii_graphic() && !"[](){}<>/%-".contains(*c);
    name.chars().filter(allowed).collect()
}

/// `text` with its first number replaced: `Version 2.37; hinted` becomes `Version 2.371; hinted`.
fn revised(text: &str, version: &str) -> String {
    let Some(from) = text.find(|c: char| c.is_ascii_digit()) else { return format!("Version {version}") };
    let rest = &text[from..];
    let length = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    format!("{}{version}{}", &text[..from], &rest[length..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(all: &[(u16, &str)]) -> Names {
        let record = |platform, &(name, text): &(u16, &str)| {
            let language = if platform == 3 { 0x409 } else { 0 };
            let mut record = Record { platform, encoding: 1, language, name, bytes: vec![] };
            record.set(text).unwrap();
            record
        };
        let records = all.iter().map(|n| record(1, n)).chain(all.iter().map(|n| record(3, n))).collect();
        Names { records, languages: vec![], format: 0 }
    }

    const DEJAVU: [(u16, &str); 7] = [
        (1, "DejaVu Serif Condensed"),
        (2, "Bold"),
        (4, "DejaVu Serif Condensed Bold"),
        (5, "Version 2.37; with notes 1.0"),
        (6, "DejaVuSerifCondensed-Bold"),
        (13, "Fonts are (c) Bitstream"),
        (16, "DejaVu Serif"),
    ];

    #[test]
    fn all_names_that_identify_a_font_change_and_no_others() {
        let mut renamed = names(&DEJAVU);
        renamed.rename("Soft Type", "2.371").unwrap();
        let get = |name| renamed.get(name).unwrap();
        assert_eq!(get(1), "Soft Type Condensed");
        assert_eq!(get(2), "Bold");
        assert_eq!(get(4), "Soft Type Condensed Bold");
        assert_eq!(get(5), "Version 2.371; with notes 1.0");
        assert_eq!(get(6), "SoftType-Bold");
        assert_eq!(get(13), "Fonts are (c) Bitstream");
        assert_eq!(get(16), "Soft Type");
        let table = renamed.to_bytes().unwrap();
        assert_eq!(Names::parse(&table).unwrap(), renamed);
        for length in 0..table.len() {
            assert!(Names::parse(&table[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn the_old_name_and_reserved_names_are_refused() {
        let mut plain = names(&DEJAVU);
        assert!(plain.rename("dejavu-serif", "1").is_err() && plain.rename(" ", "1").is_err());
        assert!(plain.rename("Schräg", "1").is_err());
        for licence in [
            "Copyright (c) X, with Reserved Font Name 'Linux Libertine' and 'Biolinum'.",
            "with Reserved Font Names \"Linux Libertine\", Biolinum",
            "Copyright, with Reserved Font Name Linux Libertine.",
        ] {
            let mut all = DEJAVU.to_vec();
            all[5] = (0, licence);
            let mut reserving = names(&all);
            let refusal = reserving.rename("Linux Libertine Open 30", "1").unwrap_err().to_string();
            assert!(refusal.contains("\"Linux Libertine\"") && refusal.contains("--family"), "{refusal}");
            assert!(reserving.rename("Soft", "1").is_ok());
        }
    }
}
