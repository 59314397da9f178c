# SPDX-License-Identifier: Apache-2.0
# 4 lines of zenoh-ext 1.10.2: what a publisher writes while it is asked for its history waits for the answer, and who is heard of first by a
# message that is not his first is asked.
# src/advanced_subscriber.rs
s/^        if state.last_delivered.is_none() && states.global_pending_queries != 0 {$/        let asks_history = states.retransmission \&\& states.max_history_depth != usize::MAX;\n        if state.last_delivered.is_none()\n            \&\& (states.global_pending_queries + state.pending_queries != 0 || asks_history \&\& source_info.source_sn() != 0) {/
