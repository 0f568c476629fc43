//! usvg with the fonts that the text of a drawing asks for.

use usvg::roxmltree::Document;

use super::error::ReadError;
use super::options::ReadOptions;

/// The tree of the drawing. No other file is opened than fonts, and those only where there is text.
pub(super) fn tree(document: &Document, options: &ReadOptions) -> Result<Result<usvg::Tree, usvg::Error>, ReadError> {
    #[cfg_attr(not(feature = "text"), allow(unused_mut))]
    let mut parsing = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    };
    #[cfg(feature = "text")]
    if document.descendants().any(|n| n.tag_name().name() == "text") {
        parsing.fontdb = with_text::database(options)?;
        parsing.font_resolver.select_fallback = with_text::bounded(usvg::FontResolver::default_fallback_selector());
    }
    #[cfg(not(feature = "text"))]
    let _ = options;
    Ok(usvg::Tree::from_xmltree(document, &parsing))
}

#[cfg(feature = "text")]
mod with_text {
    use std::collections::HashMap;
    use std::sync::{Arc, Mutex, OnceLock, PoisonError};

    use usvg::fontdb::{Database, ID};

    use super::{ReadError, ReadOptions};

    /// How many characters that the chosen font lacks are searched in all others. A search may open every font of the
    /// system, and a file of nothing but such characters would take minutes; beyond, a character counts as missing.
    const MAX_SEARCHES: usize = 128;

    /// The fonts of the system, and before them those that the options name.
    pub fn database(options: &ReadOptions) -> Result<Arc<Database>, ReadError> {
        /// Opening every font takes long, and they hardly change while the program runs.
        static SYSTEM: OnceLock<Arc<Database>> = OnceLock::new();
        let system = SYSTEM.get_or_init(|| {
            let mut fonts = Database::new();
            fonts.load_system_fonts();
            Arc::new(fonts)
        });
        if options.fonts.is_empty() {
            return Ok(system.clone());
        }
        let mut fonts = Database::new();
        for path in &options.fonts {
            let failed = |source| ReadError::Font { path: path.clone(), source };
            let before = fonts.len();
            fonts.load_font_data(std::fs::read(path).map_err(failed)?);
            if fonts.len() == before {
                let reason = "it is no TrueType or OpenType font";
                return Err(failed(std::io::Error::new(std::io::ErrorKind::InvalidData, reason)));
            }
        }
        // A family that is not there falls back to the font that was named, and to none where none was: a part with
        // other letters than drawn is worse than none.
        let named = fonts.faces().next().and_then(|face| face.families.first().map(|(name, _)| name.clone()));
        for face in system.faces() {
            fonts.push_face_info(face.clone());
        }
        if let Some(family) = named {
            fonts.set_serif_family(family.clone());
            fonts.set_sans_serif_family(family.clone());
            fonts.set_monospace_family(family.clone());
            fonts.set_cursive_family(family.clone());
            fonts.set_fantasy_family(family);
        }
        Ok(Arc::new(fonts))
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
