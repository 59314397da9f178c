// SPDX-License-Identifier: Apache-2.0
use std::ffi::{c_char, c_int, c_void};

use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::sample::SampleKind;
use zenoh::Wait;

use crate::border::{key, made, Object, OnToken, Release};
use crate::session::Session;

pub unsafe extern "C" fn declare_token(
    session: *const Session,
    key_expression: *const c_char,
    error: *mut c_char,
    capacity: usize,
) -> *mut LivelinessToken {
    made(error, capacity, || {
        (*session)
            .session
            .liveliness()
            .declare_token(key(key_expression)?)
            .wait()
    })
}

#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn declare_watch(
    session: *const Session,
    key_expression: *const c_char,
    callback: OnToken,
    object: *mut c_void,
    release: Release,
    error: *mut c_char,
    capacity: usize,
) -> *mut Subscriber<()> {
    let object = Object::new(object, release);
    made(error, capacity, || {
        (*session)
            .session
            .liveliness()
            .declare_subscriber(key(key_expression)?)
            .history(true)
            .callback(move |sample| {
                let token = sample.key_expr().as_str();
                let alive = c_int::from(sample.kind() == SampleKind::Put);
                object.tell(|object| callback(object, token.as_ptr().cast(), token.len(), alive));
            })
            .wait()
    })
}
