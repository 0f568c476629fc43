//! usvg with the fonts that the text of a drawing asks for.

use usvg::roxmltree::Document;

use super::error::ReadError;
use super::options::ReadOptions;

/// Families that a drawing asks for, and the installed ones that it gets instead.
pub(super) type Replaced = Vec<(String, String)>;

/// The tree of the drawing. No other file is opened than fonts: those that are named, and others only where there is text.
pub(super) fn tree(
    document: &Document,
    options: &ReadOptions,
) -> Result<(Result<usvg::Tree, usvg::Error>, Replaced), ReadError> {
    #[cfg_attr(not(feature = "text"), allow(unused_mut))]
    let mut parsing = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    };
    #[cfg(feature = "text")]
    {
        // Also without text: a name that is no font is a slip.
        let named = with_text::named(options)?;
        let replaced = std::sync::Arc::default();
        if document.descendants().any(|n| n.tag_name().name() == "text") {
            parsing.fontdb = with_text::database(named);
            parsing.font_resolver.select_fallback = with_text::bounded(usvg::FontResolver::default_fallback_selector());
            parsing.font_resolver.select_font = with_text::watched(std::sync::Arc::clone(&replaced));
        }
        let tree = usvg::Tree::from_xmltree(document, &parsing);
        Ok((tree, with_text::listed(&replaced)))
    }
    #[cfg(not(feature = "text"))]
    {
        if let Some(path) = options.fonts.first() {
            let reason = std::io::Error::new(std::io::ErrorKind::Unsupported, "this build sets no text");
            return Err(ReadError::Font { path: path.clone(), reason });
        }
        Ok((usvg::Tree::from_xmltree(document, &parsing), Vec::new()))
    }
}

#[cfg(feature = "text")]
mod with_text {
    use std::collections::{BTreeSet, HashMap};
    use std::sync::{Arc, Mutex, OnceLock, PoisonError};

    use usvg::fontdb::{Database, Family, ID, Query, Source, Style, Weight};

    use super::{ReadError, ReadOptions};

    /// How many characters that the chosen font lacks are searched in all others. A search may open every font of the
    /// system, and a file of nothing but such characters would take minutes; beyond, a character counts as missing.
    const MAX_SEARCHES: usize = 128;

    /// Families that are not there and may be replaced by an installed one, beside the generic ones: those that drawing
    /// programs write where nobody chose. In place of any other none is taken: a part with other letters than drawn is
    /// worse than none.
    const COMMON: [(&str, Family); 12] = [
        ("Arial", Family::SansSerif),
        ("Helvetica", Family::SansSerif),
        ("Verdana", Family::SansSerif),
        ("Tahoma", Family::SansSerif),
        ("Segoe UI", Family::SansSerif),
        ("sans", Family::SansSerif),
        ("Times New Roman", Family::Serif),
        ("Times", Family::Serif),
        ("Georgia", Family::Serif),
        ("Courier New", Family::Monospace),
        ("Courier", Family::Monospace),
        ("Consolas", Family::Monospace),
    ];

    /// What stands in for the generic families, the first that is installed.
    const SANS: [&str; 7] =
        ["Arial", "Helvetica", "Liberation Sans", "DejaVu Sans", "Noto Sans", "Roboto", "Open Sans"];
    const SERIF: [&str; 6] = ["Times New Roman", "Times", "Liberation Serif", "DejaVu Serif", "Noto Serif", "Georgia"];
    const MONO: [&str; 6] =
        ["Courier New", "Courier", "Liberation Mono", "DejaVu Sans Mono", "Noto Sans Mono", "Menlo"];

    /// The fonts that the options name.
    pub fn named(options: &ReadOptions) -> Result<Database, ReadError> {
        let mut fonts = Database::new();
        for path in &options.fonts {
            let failed = |reason| ReadError::Font { path: path.clone(), reason };
            let before = fonts.len();
            fonts.load_font_data(std::fs::read(path).map_err(failed)?);
            if fonts.len() == before {
                let kind = std::io::ErrorKind::InvalidData;
                return Err(failed(std::io::Error::new(kind, "it is no TrueType or OpenType font")));
            }
        }
        Ok(fonts)
    }

    /// The fonts of the system, and before them those that are `named`.
    pub fn database(mut fonts: Database) -> Arc<Database> {
        /// Opening every font takes long, and they hardly change while the program runs.
        static SYSTEM: OnceLock<Arc<Database>> = OnceLock::new();
        let system = SYSTEM.get_or_init(|| {
            let mut fonts = Database::new();
            fonts.load_system_fonts();
            let installed = |names: &[&str]| {
                let found = names.iter().find(|name| has_family(&fonts, name)).map(|name| (*name).to_owned());
                found.or_else(|| fonts.faces().find_map(|face| face.families.first().map(|(name, _)| name.clone())))
            };
            let (sans, serif, mono) = (installed(&SANS), installed(&SERIF), installed(&MONO));
            if let (Some(sans), Some(serif), Some(mono)) = (sans, serif, mono) {
                fonts.set_cursive_family(sans.clone());
                fonts.set_fantasy_family(sans.clone());
                fonts.set_sans_serif_family(sans);
                fonts.set_serif_family(serif);
                fonts.set_monospace_family(mono);
            }
            Arc::new(fonts)
        });
        // A family that is not there falls back to the font that was named.
        let named = fonts.faces().next().and_then(|face| face.families.first().map(|(name, _)| name.clone()));
        let Some(family) = named else { return system.clone() };
        for face in system.faces() {
            fonts.push_face_info(face.clone());
        }
        fonts.set_serif_family(family.clone());
        fonts.set_sans_serif_family(family.clone());
        fonts.set_monospace_family(family.clone());
        fonts.set_cursive_family(family.clone());
        fonts.set_fantasy_family(family);
        Arc::new(fonts)
    }

    fn has_family(fonts: &Database, name: &str) -> bool {
        fonts.query(&Query { families: &[Family::Name(name)], ..Query::default() }).is_some()
    }

    /// What was replaced by what, while text is set.
    type Watch = Arc<Mutex<BTreeSet<(String, String)>>>;

    pub fn listed(replaced: &Watch) -> Vec<(String, String)> {
        replaced.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    /// The usual choice of a font, with a note of every family that is not there. In place of a family that somebody chose
    /// none is taken, unless a font file was named.
    pub fn watched(replaced: Watch) -> usvg::FontSelectionFn<'static> {
        let select = usvg::FontResolver::default_font_selector();
        Box::new(move |font, fonts| {
            let wanted: Vec<String> = font.families().iter().map(|f| f.to_string().replace('"', "")).collect();
            let is_there = |name: &String| has_family(fonts, name);
            let common = || wanted.iter().find_map(|name| COMMON.iter().find(|(c, _)| c.eq_ignore_ascii_case(name)));
            let is_generic = |family: &usvg::FontFamily| !matches!(family, usvg::FontFamily::Named(_));
            // Where a file was named, its font stands for all generic families, and stands in memory.
            let has_file = fonts.faces().next().is_some_and(|face| matches!(face.source, Source::Binary(_)));
            let id = if has_file || font.families().iter().any(is_generic) || wanted.iter().any(is_there) {
                select(font, fonts)?
            } else {
                let (_, generic) = common()?;
                let style = match font.style() {
                    usvg::FontStyle::Normal => Style::Normal,
                    usvg::FontStyle::Italic => Style::Italic,
                    usvg::FontStyle::Oblique => Style::Oblique,
                };
                let weight = Weight(font.weight());
                fonts.query(&Query { families: &[*generic], weight, style, ..Query::default() })?
            };
            let taken = fonts.face(id).and_then(|face| face.families.first().map(|(name, _)| name.clone()))?;
            let is_wanted = fonts.face(id).is_some_and(|face| {
                face.families.iter().any(|(name, _)| wanted.iter().any(|w| w.eq_ignore_ascii_case(name)))
            });
            if !is_wanted && !has_file {
                let mut replaced = replaced.lock().unwrap_or_else(PoisonError::into_inner);
                replaced.insert((wanted.join(", "), taken));
            }
            Some(id)
        })
    }

    /// `search` for another font that has a character, each result remembered, and no more than [`MAX_SEARCHES`] of them.
    pub fn bounded(search: usvg::FallbackSelectionFn<'static>) -> usvg::FallbackSelectionFn<'static> {
        // The character and the fonts that lack it.
        type Asked = (char, Vec<ID>);
        let found: Mutex<HashMap<Asked, Option<ID>>> = Mutex::new(HashMap::new());
        Box::new(move |c, used, fonts| {
            let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
            let asked = (c, used.to_vec());
            if let Some(font) = found.get(&asked) {
                return *font;
            }
            if found.len() >= MAX_SEARCHES {
                return None;
            }
            let font = search(c, used, fonts);
            found.insert(asked, font);
            font
        })
    }

    #[cfg(test)]
    mod tests {
        use std::sync::atomic::{AtomicUsize, Ordering};

        use super::*;

        #[test]
        fn lost_characters_are_searched_once_each_and_not_without_end() {
            let searches = Arc::new(AtomicUsize::new(0));
            let counter = searches.clone();
            let select = bounded(Box::new(move |_, _, _| {
                counter.fetch_add(1, Ordering::Relaxed);
                Some(ID::dummy())
            }));
            let mut fonts = Arc::new(Database::new());
            for (k, c) in ('\u{f0000}'..'\u{f1000}').enumerate() {
                for _ in 0..2 {
                    let font = select(c, &[ID::dummy()], &mut fonts);
                    assert_eq!(font.is_some(), k < MAX_SEARCHES);
                }
            }
            assert_eq!(searches.load(Ordering::Relaxed), MAX_SEARCHES);
        }
    }
}
