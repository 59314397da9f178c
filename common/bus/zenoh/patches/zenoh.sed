# SPDX-License-Identifier: Apache-2.0
# 10 lines of zenoh 1.10.2: what the other side of a link declares has an end (declared.rs).
# src/net/routing/dispatcher/face.rs
s/^    pub(crate) is_local: bool,$/&\n    declared: super::declared::Declared,/
s/^            is_local: false,$/&\n            declared: Default::default(),/
/^        let ctrl_lock = zlock!(self\.tables\.ctrl_lock);$/{
N
s/^.*\n        match &mut msg\.body {$/        if !self.state.is_local \&\& !self.state.declared.admits(\&msg.body) {\n            return;\n        }\n&/
s/^.*\n        if msg\.mode != InterestMode::Final {$/        if !self.state.is_local \&\& !self.state.declared.admits_interest(msg) {\n            return;\n        }\n&/
}
s/^            self\.interest_final(msg);$/            self.state.declared.forget_interest(msg.id);\n&/
# src/net/routing/dispatcher/mod.rs
s/^pub mod face;$/mod declared;\n&/
