//! What has been looked at since it last changed: what was refused is refused again as long as all that it depends on is as it was.

/// When vertices last changed, in counts of changes: in their places, in their states, or in the faces around them.
#[derive(Clone, Default)]
pub(super) struct Changes {
    now: u64,
    /// When all that has not changed since is taken to have changed.
    all: u64,
    at: Vec<u64>,
}

impl Changes {
    /// The present.
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Vertex `v` changes.
    pub fn mark(&mut self, v: u32) {
        self.now += 1;
        if self.at.len() <= v as usize {
            self.at.resize(v as usize + 1, 0);
        }
        self.at[v as usize] = self.now;
    }

    /// Anything may have changed.
    pub fn mark_all(&mut self) {
        self.now += 1;
        self.all = self.now;
    }

    /// Whether none of some vertices has changed since `time`.
    pub fn none_since(&self, time: u64, vertices: impl IntoIterator<Item = u32>) -> bool {
        let at = |v: u32| self.at.get(v as usize).copied().unwrap_or(0);
        self.now <= time || self.all <= time && vertices.into_iter().all(|v| at(v) <= time)
    }
}

/// When something was last refused, by its number.
#[derive(Clone, Default)]
pub(super) struct Refused {
    at: Vec<Option<u64>>,
}

impl Refused {
    /// Number `k` is refused.
    pub fn mark(&mut self, k: u32, time: u64) {
        if self.at.len() <= k as usize {
            self.at.resize(k as usize + 1, None);
        }
        self.at[k as usize] = Some(time);
    }

    /// When number `k` was last refused.
    pub fn at(&self, k: u32) -> Option<u64> {
        self.at.get(k as usize).copied().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_refused_is_so_until_something_changes_that_it_depends_on() {
        let (mut changes, mut refused) = (Changes::default(), Refused::default());
        assert_eq!(refused.at(3), None);
        refused.mark(3, changes.now());
        let is_refused =
            |changes: &Changes, refused: &Refused| refused.at(3).is_some_and(|at| changes.none_since(at, [1, 9]));
        assert!(is_refused(&changes, &refused));
        changes.mark(2);
        assert!(is_refused(&changes, &refused), "another vertex");
        changes.mark(9);
        assert!(!is_refused(&changes, &refused));
        refused.mark(3, changes.now());
        assert!(is_refused(&changes, &refused));
        changes.mark_all();
        assert!(!is_refused(&changes, &refused));
    }
}
