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
    if document.descendants().any(|n| n.tag_name().name() == "text") {
        #[cfg(feature = "text")]
        load(parsing.fontdb_mut(), options)?;
    }
    #[cfg(not(feature = "text"))]
    let _ = options;
    Ok(usvg::Tree::from_xmltree(document, &parsing))
}

#[cfg(feature = "text")]
fn load(fonts: &mut usvg::fontdb::Database, options: &ReadOptions) -> Result<(), ReadError> {
    for path in &options.fonts {
        let data = std::fs::read(path).map_err(|source| ReadError::Font { path: path.clone(), source })?;
        fonts.load_font_data(data);
    }
    // A family that is not there falls back to the font that was named, and to none where none was: a part with other
    // letters than drawn is worse than none.
    let named = fonts.faces().next().and_then(|face| face.families.first().map(|(name, _)| name.clone()));
    fonts.load_system_fonts();
    if let Some(family) = named {
        fonts.set_serif_family(family.clone());
        fonts.set_sans_serif_family(family.clone());
        fonts.set_monospace_family(family.clone());
        fonts.set_cursive_family(family.clone());
        fonts.set_fantasy_family(family);
    }
    Ok(())
}
