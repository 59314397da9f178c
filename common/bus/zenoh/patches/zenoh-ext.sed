# SPDX-License-Identifier: Apache-2.0
# 65 lines of zenoh-ext 1.10.2: what a publisher writes while it is asked for its history waits for the answer, and who is heard of first by a
# message that is not his first is asked. What strangers make it remember has an end (bounded.rs).
# src/advanced_subscriber.rs
s/^        if state.last_delivered.is_none() && states.global_pending_queries != 0 {$/        let asks_history = states.retransmission \&\& states.max_history_depth != usize::MAX;\n        if state.last_delivered.is_none()\n            \&\& (states.global_pending_queries + state.pending_queries != 0 || asks_history \&\& source_info.source_sn() != 0) {/

s/^    advanced_cache::{ke_liveliness, KE_UHLC},$/&\n    bounded::{bound, Asked, HeldSamples},/
s/ collections::BTreeMap,//
s/ BTreeMap<T, Sample>/ HeldSamples<T>/
s/\(pending_samples.* \)BTreeMap::new()/\1HeldSamples::new()/
s/^impl State {$/&\n    fn forget_strangers(\&mut self) {\n        bound(\&mut self.sequenced_states, |source| source.alive);\n        bound(\&mut self.timestamped_states, |source| source.alive);\n    }\n/
s/^\( *\)let states = &mut \*\(lock\|zlock!(.*)\);$/&\n\1states.forget_strangers();/
s/pending_samples\.entry(\*timestamp)\.or_insert(sample)/pending_samples.insert(*timestamp, sample)/
s/for (seq_num, sample) in pending_samples {/while let Some((seq_num, sample)) = pending_samples.pop_first() {/
s/for (timestamp, sample) in std::mem::take(&mut state.pending_samples) {/while let Some((timestamp, sample)) = state.pending_samples.pop_first() {/
/^        state.latest_access = Instant::now();$/{
N
s/^.*\n        new$/        while state.pending_samples.too_many() {\n            if let Some((sn, sample)) = state.pending_samples.pop_first() {\n                deliver_and_flush(sample, sn, callback, state);\n            }\n        }\n&/
s/^.*\n        false$/        while state.pending_samples.too_many() {\n            if let Some((timestamp, sample)) = state.pending_samples.pop_first() {\n                state.last_delivered = Some(timestamp);\n                callback.call(sample);\n            }\n        }\n&/
}

/^struct .*RepliesHandler {$/,/^}$/s/statesref: .*/&\n    _asked: Asked,/
s/^\( *\)statesref: statesref\.clone(),$/&\n\1_asked: Asked::new(),/
s/^                            && !state\.pending_samples\.is_empty()$/&\n                            \&\& !Asked::too_many()/
s/^                        && state\.pending_queries == 0$/&\n                        \&\& !Asked::too_many()/
s/^\( *\)let Ok(parsed) = ke_liveliness::parse(s\.key_expr()/\1if s.kind() == SampleKind::Put \&\& Asked::too_many() {\n\1    return;\n\1}\n&/
# src/lib.rs
s/^mod advanced_cache;$/&\nmod bounded;/
