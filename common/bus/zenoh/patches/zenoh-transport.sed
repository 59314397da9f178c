# SPDX-License-Identifier: Apache-2.0
# 8 lines of zenoh-transport 1.10.2: what waits for a link that is given up is dropped, and no other link takes its place before it is gone.
# src/common/pipeline.rs
/^        \/\/ Drain the remaining batches$/{
n
s/$/\n        if self.status.is_disabled() {\n            return batches;\n        }/
}
# src/unicast/universal/transport.rs
s/^        \/\/ Notify the callback$/        stl.pipeline.mark_disabled();\n        if is_last {\n            *self.get_status().await = TransportStatus::Closed;\n        }\n\n&/
