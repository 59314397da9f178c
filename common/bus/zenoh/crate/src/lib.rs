// SPDX-License-Identifier: Apache-2.0
//! `zenoh` and `zenoh-ext` behind the C interface of `rds_zenoh.h`, which has names, ownership and contracts.

mod border;
mod liveliness;
mod log;
mod publisher;
mod queryable;
mod session;
mod subscriber;

use std::ffi::{c_char, c_int, c_void};

use border::{OnQuery, OnSample, OnToken, Release};
use log::OnLog;
use publisher::{Buffer, Publisher, PublisherOptions};
use queryable::Queryable;
use session::Session;
use subscriber::{Subscriber, SubscriberOptions, View};
use zenoh::liveliness::LivelinessToken;
use zenoh::query::Query;
use zenoh::sample::Sample;

type Watch = zenoh::pubsub::Subscriber<()>;
type Text = *const c_char;
type Error = *mut c_char;

/// The order of `RdsZenohApi`.
#[repr(C)]
pub struct Api {
    version: u32,
    listen_to_log: unsafe extern "C" fn(OnLog),
    open: unsafe extern "C" fn(Text, Text, Error, usize) -> *mut Session,
    close: unsafe extern "C" fn(*mut Session),
    id: unsafe extern "C" fn(*const Session, *mut c_char),
    declare_publisher:
        unsafe extern "C" fn(*const Session, Text, *const PublisherOptions, Error, usize) -> *mut Publisher,
    undeclare_publisher: unsafe extern "C" fn(*mut Publisher),
    make_buffer: unsafe extern "C" fn(*const Session, usize, u8, *mut *mut u8) -> *mut Buffer,
    free_buffer: unsafe extern "C" fn(*mut Buffer),
    put: unsafe extern "C" fn(*const Publisher, *mut Buffer, *const u8, usize) -> c_int,
    declare_subscriber: unsafe extern "C" fn(
        *const Session,
        Text,
        *const SubscriberOptions,
        OnSample,
        *mut c_void,
        Release,
        Error,
        usize,
    ) -> *mut Subscriber,
    undeclare_subscriber: unsafe extern "C" fn(*mut Subscriber),
    view: unsafe extern "C" fn(*const Sample, *mut View),
    intact: unsafe extern "C" fn(*const Sample) -> c_int,
    gather: unsafe extern "C" fn(*const Sample, *mut u8),
    free_sample: unsafe extern "C" fn(*mut Sample),
    declare_queryable:
        unsafe extern "C" fn(*const Session, Text, OnQuery, *mut c_void, Release, Error, usize) -> *mut Queryable,
    undeclare_queryable: unsafe extern "C" fn(*mut Queryable),
    view_query: unsafe extern "C" fn(*const Query, *mut View),
    gather_query: unsafe extern "C" fn(*const Query, *mut u8),
    reply: unsafe extern "C" fn(*const Query, *mut Buffer, *const u8, usize) -> c_int,
    free_query: unsafe extern "C" fn(*mut Query),
    get: unsafe extern "C" fn(
        *const Session,
        Text,
        *mut Buffer,
        *const u8,
        usize,
        u64,
        OnSample,
        *mut c_void,
        Release,
    ) -> c_int,
    declare_token: unsafe extern "C" fn(*const Session, Text, Error, usize) -> *mut LivelinessToken,
    undeclare_token: unsafe extern "C" fn(*mut LivelinessToken),
    declare_watch:
        unsafe extern "C" fn(*const Session, Text, OnToken, *mut c_void, Release, Error, usize) -> *mut Watch,
    undeclare_watch: unsafe extern "C" fn(*mut Watch),
}

static API: Api = Api {
    version: 5,
    listen_to_log: log::listen_to_log,
    open: session::open,
    close: session::close,
    id: session::id,
    declare_publisher: publisher::declare_publisher,
    undeclare_publisher: border::give_back::<Publisher>,
    make_buffer: publisher::make_buffer,
    free_buffer: border::give_back::<Buffer>,
    put: publisher::put,
    declare_subscriber: subscriber::declare_subscriber,
    undeclare_subscriber: border::give_back::<Subscriber>,
    view: subscriber::view,
    intact: subscriber::intact,
    gather: subscriber::gather,
    free_sample: border::give_back::<Sample>,
    declare_queryable: queryable::declare_queryable,
    undeclare_queryable: border::give_back::<Queryable>,
    view_query: queryable::view_query,
    gather_query: queryable::gather_query,
    reply: queryable::reply,
    free_query: border::give_back::<Query>,
    get: queryable::get,
    declare_token: liveliness::declare_token,
    undeclare_token: border::give_back::<LivelinessToken>,
    declare_watch: liveliness::declare_watch,
    undeclare_watch: border::give_back::<Watch>,
};

#[no_mangle]
pub extern "C" fn rds_zenoh_api() -> *const Api {
    &API
}
