# SPDX-License-Identifier: Apache-2.0
# 16 lines of zenoh-transport 1.10.2: what waits for a link that is given up is dropped, and no other link takes its place before it is gone; a link is
# waited for once.
# src/common/pipeline.rs
/^        \/\/ Drain the remaining batches$/{
n
s/$/\n        if self.status.is_disabled() {\n            return batches;\n        }/
}
# src/unicast/universal/transport.rs
s/^        \/\/ Notify the callback$/        stl.pipeline.mark_disabled();\n        if is_last {\n            *self.get_status().await = TransportStatus::Closed;\n        }\n\n&/
# src/unicast/universal/link.rs
s/^    pub block_first_waiters: .*/&\n    pub block_first_missed: Arc<[AtomicBool; Priority::NUM]>,/
s/^            block_first_waiters: .*/&\n            block_first_missed: Arc::default(),/
# src/unicast/universal/tx.rs
/CongestionControl::BlockFirst {$/,/^        }$/{
s/^            let priority = .*/&\n            let missed = \&transport_link.block_first_missed[priority as usize];/
s/wait_timeout(\(.*\))$/wait_timeout(if missed.load(Relaxed) { Duration::ZERO } else { \1 })/
s/^                return Ok(false);/                missed.store(true, Relaxed);\n&/
s/^            let transport = .*/            missed.store(false, Relaxed);\n&/
}
s/^use crate::unicast::transport_unicast_inner::TransportUnicastTrait;/&\nuse std::{sync::atomic::Ordering::Relaxed, time::Duration};/
