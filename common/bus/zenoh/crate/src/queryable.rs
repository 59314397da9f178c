// SPDX-License-Identifier: Apache-2.0
use std::ffi::{c_char, c_int, c_void};
use std::time::Duration;

use zenoh::bytes::ZBytes;
use zenoh::query::{ConsolidationMode, Query, QueryTarget};
use zenoh::Wait;

use crate::border::{done, key, made, Object, OnQuery, OnSample, Release};
use crate::publisher::Buffer;
use crate::session::Session;
use crate::subscriber::{gather_into, show, View};

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
            .callback(move |query| callback(object.get(), Box::into_raw(Box::new(query))))
            .wait()
    })
}

pub unsafe extern "C" fn view_query(query: *const Query, view: *mut View) {
    let q = &*query;
    show(
        &mut *view,
        q.key_expr().as_str(),
        q.payload(),
        q.attachment(),
        q.source_info(),
    );
}

pub unsafe extern "C" fn gather_query(query: *const Query, data: *mut u8) {
    if let Some(payload) = (*query).payload() {
        gather_into(payload, data);
    }
}

pub unsafe extern "C" fn reply(
    query: *const Query,
    buffer: *mut Buffer,
    attachment: *const u8,
    attachment_size: usize,
) -> c_int {
    let payload = Buffer::into_bytes(buffer);
    let attachment = ZBytes::from(std::slice::from_raw_parts(attachment, attachment_size));
    let query = &*query;
    c_int::from(done(|| {
        query
            .reply(query.key_expr().clone(), payload)
            .attachment(attachment)
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
    let payload = Buffer::into_bytes(buffer);
    let attachment = ZBytes::from(std::slice::from_raw_parts(attachment, attachment_size));
    let object = Object::new(object, release);
    c_int::from(done(|| {
        (*session)
            .session
            .get(key(key_expression)?)
            .payload(payload)
            .attachment(attachment)
            .target(QueryTarget::AllComplete)
            .consolidation(ConsolidationMode::None)
            .timeout(Duration::from_millis(timeout_ms))
            .callback(move |reply| {
                if let Ok(sample) = reply.into_result() {
                    callback(object.get(), Box::into_raw(Box::new(sample)));
                }
            })
            .wait()
    }))
}
