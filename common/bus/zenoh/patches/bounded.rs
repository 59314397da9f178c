// SPDX-License-Identifier: Apache-2.0
//! What zenoh-ext 1.10.2 is given in place of memory without an end (zenoh-ext.sed): whoever may send may make up sources, leave gaps, and
//! not answer when he is asked for what is missing.
use std::collections::BTreeMap;
use std::hash::Hash;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use lru::LruCache;
use zenoh::sample::Sample;

/// Publishers that a subscriber knows beside those that have a token.
const MOST_SOURCES: usize = 1000;
/// Samples that wait for what is missing before them, in all subscribers of the process [bytes].
const MOST_HELD: usize = 256 << 20;
/// What the smallest sample may keep of the buffer that it was received in [bytes].
const RECEIVED_IN: usize = 64 << 10;
/// Questions to publishers, of all subscribers of the process.
const MOST_ASKED: usize = 1000;

static HELD: AtomicUsize = AtomicUsize::new(0);
static ASKED: AtomicUsize = AtomicUsize::new(0);

/// Forgets, while there are too many sources, the one without a token that was heard of longest ago.
pub(crate) fn bound<K: Copy + Eq + Hash, S>(sources: &mut LruCache<K, S>, has_token: impl Fn(&S) -> bool) {
    while sources.len() > MOST_SOURCES {
        let Some(oldest) = sources.iter().rev().find(|(_, s)| !has_token(s)).map(|(k, _)| *k) else {
            return;
        };
        sources.pop(&oldest);
    }
}

struct Bytes(usize);

impl Bytes {
    fn of(sample: &Sample) -> Self {
        let bytes = RECEIVED_IN + sample.payload().len() + sample.attachment().map_or(0, |a| a.len());
        HELD.fetch_add(bytes, Relaxed);
        Self(bytes)
    }
}

impl Drop for Bytes {
    fn drop(&mut self) {
        HELD.fetch_sub(self.0, Relaxed);
    }
}

/// Samples of one source that wait, by their number.
pub(crate) struct HeldSamples<K>(BTreeMap<K, (Sample, Bytes)>);

impl<K> HeldSamples<K> {
    pub(crate) fn new() -> Self {
        Self(BTreeMap::new())
    }
}

impl<K: Ord> HeldSamples<K> {
    pub(crate) fn insert(&mut self, key: K, sample: Sample) {
        let bytes = Bytes::of(&sample);
        self.0.insert(key, (sample, bytes));
    }

    pub(crate) fn remove(&mut self, key: &K) -> Option<Sample> {
        self.0.remove(key).map(|(sample, _)| sample)
    }

    pub(crate) fn pop_first(&mut self) -> Option<(K, Sample)> {
        self.0.pop_first().map(|(key, (sample, _))| (key, sample))
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the first of these must go on without what is missing.
    pub(crate) fn too_many(&self) -> bool {
        !self.is_empty() && HELD.load(Relaxed) > MOST_HELD
    }
}

/// A question to a publisher that is not answered yet.
pub(crate) struct Asked;

impl Asked {
    pub(crate) fn new() -> Self {
        ASKED.fetch_add(1, Relaxed);
        Self
    }

    /// Whether no further one may be asked now.
    pub(crate) fn too_many() -> bool {
        ASKED.load(Relaxed) >= MOST_ASKED
    }
}

impl Clone for Asked {
    fn clone(&self) -> Self {
        Self::new()
    }
}

impl Drop for Asked {
    fn drop(&mut self) {
        ASKED.fetch_sub(1, Relaxed);
    }
}
