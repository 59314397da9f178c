// SPDX-License-Identifier: Apache-2.0
use std::ffi::{c_char, c_int, c_void};
use std::time::Duration;

use zenoh::query::{ConsolidationMode, Query, QueryTarget};
use zenoh::Wait;

use crate::border::{bytes, done, guarded, key, made, Object, OnQuery, OnSample, Release};
use crate::publisher::Buffer;
use crate::session::Session;
use crate::subscriber::{gather_into, shown, View};

pub type Queryable = zenoh::query::Queryable<()>;

#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn declare_queryable(
    session: *const Session,
    key_expression: *const c_char,
    callback: OnQuery,
    object: *mut c_void,
    release: Release,
    error: *mut c_char,
    capacity: usize,
) -> *mut Queryable {
    let object = Object::new(object, release);
    made(error, capacity, || {
        (*session)
            .session
            .declare_queryable(key(key_expression)?)
            .complete(true)
            .callback(move |query| object.tell(|object| callback(object, Box::into_raw(Box::new(query)))))
            .wait()
    })
}

pub unsafe extern "C" fn view_query(query: *const Query, view: *mut View) {
    let q = &*query;
    *view = shown(|| (q.key_expr().as_str(), q.payload(), q.attachment(), q.source_info()));
}

pub unsafe extern "C" fn gather_query(query: *const Query, data: *mut u8) {
    guarded(|| (*query).payload().map(|payload| gather_into(payload, data)));
}

pub unsafe extern "C" fn reply(
    query: *const Query,
    buffer: *mut Buffer,
    attachment: *const u8,
    attachment_size: usize,
) -> c_int {
    c_int::from(done(|| {
        let payload = Buffer::into_bytes(buffer);
        let query = &*query;
        query
            .reply(query.key_expr().clone(), payload)
            .attachment(bytes(attachment, attachment_size))
            .wait()
    }))
}

#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn get(
    session: *const Session,
    key_expression: *const c_char,
    buffer: *mut Buffer,
    attachment: *const u8,
    attachment_size: usize,
    timeout_ms: u64,
    callback: OnSample,
    object: *mut c_void,
    release: Release,
) -> c_int {
    let object = Object::new(object, release);
    c_int::from(done(|| {
        let payload = Buffer::into_bytes(buffer);
        (*session)
            .session
            .get(key(key_expression)?)
            .payload(payload)
            .attachment(bytes(attachment, attachment_size))
            .target(QueryTarget::AllComplete)
            .consolidation(ConsolidationMode::None)
            .timeout(Duration::from_millis(timeout_ms))
            .callback(move |reply| {
                if let Ok(sample) = reply.into_result() {
                    object.tell(|object| callback(object, Box::into_raw(Box::new(sample))));
                }
            })
            .wait()
    }))
}
