//! What was computed from some content, kept while the program runs: a pure function
//! asked again gives what it gave, sooner. Nothing depends on whether it was kept.

use std::sync::{Arc, Mutex, PoisonError};

/// A few values by the hash of what they were computed from; the oldest go first.
pub(crate) struct Memo<T> {
    kept: Mutex<Vec<Kept<T>>>,
    most_bytes: usize,
}

struct Kept<T> {
    key: [u8; 32],
    value: Arc<T>,
    bytes: usize,
}

impl<T> Memo<T> {
    /// Keeps values of up to so many bytes together.
    pub(crate) const fn new(most_bytes: usize) -> Self {
        Self {
            kept: Mutex::new(Vec::new()),
            most_bytes,
        }
    }

    /// What was kept under `key`.
    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Arc<T>> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.iter().find(|k| k.key == *key);
        found.map(|k| k.value.clone())
    }

    /// Keeps `value`, which takes so many bytes, and lets the oldest go for it.
    pub(crate) fn keep(&self, key: [u8; 32], value: Arc<T>, bytes: usize) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|k| k.key != key);
        kept.push(Kept { key, value, bytes });
        let mut all: usize = kept.iter().map(|k| k.bytes).sum();
        while all > self.most_bytes && !kept.is_empty() {
            all -= kept.remove(0).bytes;
        }
    }

    /// What was kept under `key`, or else what `compute` gives, which is kept; nobody
    /// waits meanwhile.
    pub(crate) fn get(
        &self,
        key: [u8; 32],
        bytes: impl FnOnce(&T) -> usize,
        compute: impl FnOnce() -> T,
    ) -> Arc<T> {
        if let Some(found) = self.find(&key) {
            return found;
        }
        let value = Arc::new(compute());
        self.keep(key, value.clone(), bytes(&value));
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_computed_is_not_computed_again_and_the_oldest_goes() {
        let memo = Memo::new(10);
        let mut computed = 0;
        for key in [1u8, 2, 1, 3, 2, 1] {
            let value = memo.get(
                [key; 32],
                |_| 5,
                || {
                    computed += 1;
                    key
                },
            );
            assert_eq!(*value, key);
        }
        assert_eq!(computed, 4); // 3 took the place of 1
        memo.keep([9; 32], Arc::new(9), 11);
        assert_eq!(memo.find(&[9; 32]), None, "larger than all that is kept");
    }
}
