// SPDX-License-Identifier: Apache-2.0
//! What Zenoh logs of links that do not come about or break, for the caller to make sentences of.

use std::ffi::c_char;

use tracing::Level;
use zenoh_util::init_log_with_callback;

use crate::border::done;

pub type OnLog = extern "C" fn(*const c_char, usize);

/// Where Zenoh says so, and how: that it tries again is no warning for it.
const LINKS: [(&str, Level); 5] = [
    ("zenoh::net::runtime::orchestrator", Level::DEBUG),
    ("zenoh::net::routing::interceptor::access_control", Level::INFO),
    ("zenoh_transport::unicast::establishment", Level::DEBUG),
    ("zenoh_link_commons", Level::WARN),
    ("zenoh_link_tls", Level::WARN),
];

pub unsafe extern "C" fn listen_to_log(callback: OnLog) {
    done(|| {
        if std::env::var_os("RUST_LOG").is_some() {
            zenoh::init_log_from_env_or("error");
        } else {
            pass_on(callback);
        }
        Ok(())
    });
}

fn pass_on(callback: OnLog) {
    init_log_with_callback(
        |metadata| {
            LINKS
                .iter()
                .any(|(module, least)| metadata.level() <= least && metadata.target().starts_with(module))
        },
        move |record| {
            if let Some(message) = record.message {
                callback(message.as_ptr().cast(), message.len());
            }
        },
    );
}
