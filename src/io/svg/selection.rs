//! Which elements of a drawing are meant.

use std::collections::HashSet;

use usvg::roxmltree::Node;

use super::document::Source;
use super::error::ReadError;
use super::gather::Gathered;
use crate::units::nearest;

/// Elements by their `id`: that of a shape, or of a group or a `use`, which stands for everything below it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Nothing but these; everything where there are none.
    pub only: Vec<String>,
    /// And of those not these.
    pub except: Vec<String>,
}

impl Selection {
    /// Whether it names no element, so that all are meant.
    pub fn is_everything(&self) -> bool {
        self.only.is_empty() && self.except.is_empty()
    }

    /// For each of the elements of a collection, whether it is meant.
    pub(super) fn choose(&self, gathered: &Gathered) -> Result<Vec<bool>, ReadError> {
        let source = gathered.source;
        for id in self.only.iter().chain(&self.except) {
            known(source, id)?;
        }
        if let Some(id) = self.only.iter().find(|id| self.except.contains(id)) {
            return Err(ReadError::ContradictorySelection { id: id.clone() });
        }
        let mut used: HashSet<&str> = HashSet::new();
        let mut chosen = Vec::new();
        for instance in &gathered.collection.instances {
            let around = source.around(instance);
            let named = |ids: &'_ [String]| -> Vec<&str> {
                let here = around.iter().filter_map(|n| n.attribute("id"));
                here.filter(|here| ids.iter().any(|id| id == here)).collect()
            };
            let only = named(&self.only);
            used.extend(&only);
            chosen.push((self.only.is_empty() || !only.is_empty()) && named(&self.except).is_empty());
        }
        let filled = |n: usize| gathered.collection.items.iter().any(|item| item.element as usize == n && chosen[n]);
        if let Some(id) = self.only.iter().find(|id| !used.contains(id.as_str())) {
            return Err(ReadError::NothingChosen { id: Some(id.clone()) });
        }
        if !(0..chosen.len()).any(filled) {
            return Err(ReadError::NothingChosen { id: None });
        }
        Ok(chosen)
    }
}

/// The elements that have this `id`.
///
/// # Errors
/// Where there are none, with the nearest `id` that there is.
pub(super) fn known<'a, 'input>(source: &Source<'a, 'input>, id: &str) -> Result<Vec<Node<'a, 'input>>, ReadError> {
    let found: Vec<Node> = source.elements(id).collect();
    if found.is_empty() {
        let nearest = nearest(id, source.ids().into_iter()).map(str::to_owned);
        return Err(ReadError::UnknownId { id: id.to_owned(), nearest });
    }
    Ok(found)
}
