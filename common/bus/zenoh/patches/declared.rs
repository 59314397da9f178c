// SPDX-License-Identifier: Apache-2.0
//! An end, which zenoh 1.10.2 has not (zenoh.sed), of what the other side of a link may declare: each of it is kept as long as the link lasts.
use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use zenoh_protocol::network::{DeclareBody, Interest};

/// Of each kind, on each link.
const MOST: usize = 10_000;

#[derive(Default)]
struct Ids(Mutex<HashSet<u32>>);

impl Ids {
    /// @return false for one too many.
    fn add(&self, id: u32) -> bool {
        let mut ids = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if ids.len() == MOST && !ids.contains(&id) {
            return false;
        }
        if ids.insert(id) && ids.len() == MOST {
            tracing::error!("a link has declared {MOST} of a kind: what it declares beyond is left out");
        }
        true
    }

    /// @return true: what was left out may go as well.
    fn remove(&self, id: u32) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&id);
        true
    }
}

/// What one link has declared and not taken back.
#[derive(Default)]
pub(crate) struct Declared {
    subscribers: Ids,
    queryables: Ids,
    tokens: Ids,
    interests: Ids,
}

impl Declared {
    pub(crate) fn admits(&self, body: &DeclareBody) -> bool {
        match body {
            DeclareBody::DeclareSubscriber(m) => self.subscribers.add(m.id),
            DeclareBody::UndeclareSubscriber(m) => self.subscribers.remove(m.id),
            DeclareBody::DeclareQueryable(m) => self.queryables.add(m.id),
            DeclareBody::UndeclareQueryable(m) => self.queryables.remove(m.id),
            DeclareBody::DeclareToken(m) => self.tokens.add(m.id),
            DeclareBody::UndeclareToken(m) => self.tokens.remove(m.id),
            // 65536 at most, and not taken back with what they were for
            DeclareBody::DeclareKeyExpr(_) | DeclareBody::UndeclareKeyExpr(_) | DeclareBody::DeclareFinal(_) => true,
        }
    }

    /// Those that last: others are over when they are answered.
    pub(crate) fn admits_interest(&self, interest: &Interest) -> bool {
        !interest.mode.is_future() || self.interests.add(interest.id)
    }

    pub(crate) fn forget_interest(&self, id: u32) {
        self.interests.remove(id);
    }
}
