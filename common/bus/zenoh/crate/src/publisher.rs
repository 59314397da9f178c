// SPDX-License-Identifier: Apache-2.0
use std::ffi::{c_char, c_int};
use std::thread::sleep;
use std::time::{Duration, Instant};

use zenoh::bytes::ZBytes;
use zenoh::qos::{CongestionControl, Priority, Reliability};
use zenoh::shm::{Defragment, ShmProviderState, ZShmMut};
use zenoh::Wait;
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig, RepliesConfig};

use crate::border::{bytes, done, guarded, key, made};
use crate::session::Session;

#[repr(C)]
pub struct PublisherOptions {
    priority: u8,
    express: u8,
    reliable: u8,
    droppable: u8,
    latched: u8,
    cache: usize,
    heartbeat_ms: u64,
}

pub type Publisher = AdvancedPublisher<'static>;

pub enum Buffer {
    Own(Vec<u8>),
    Shared(ZShmMut),
}

impl Buffer {
    pub unsafe fn into_bytes(buffer: *mut Buffer) -> ZBytes {
        match *Box::from_raw(buffer) {
            Buffer::Own(bytes) => bytes.into(),
            Buffer::Shared(bytes) => bytes.into(),
        }
    }
}

/// None where the session has no shared memory, not yet, or none left.
fn shared(session: &Session, size: usize) -> Option<ZShmMut> {
    let provider = session.session.get_shm_provider().into_option()?;
    provider.garbage_collect(); // what was read is still in the processor's cache
    provider.alloc(size).with_policy::<Defragment>().wait().ok()
}

/// Zenoh makes its tables with a process's first piece of shared memory, which takes 8 ms of processor time: not while a message waits.
fn prepare(session: &Session) {
    let end = Instant::now() + Duration::from_secs(1);
    loop {
        match session.session.get_shm_provider() {
            ShmProviderState::Ready(provider) => return drop(provider.alloc(1).wait()),
            // its wait() would take the provider away from the session
            ShmProviderState::Initializing(_) if Instant::now() < end => sleep(Duration::from_millis(1)),
            _ => return,
        }
    }
}

pub unsafe extern "C" fn declare_publisher(
    session: *const Session,
    key_expression: *const c_char,
    options: *const PublisherOptions,
    error: *mut c_char,
    capacity: usize,
) -> *mut Publisher {
    made(error, capacity, || {
        let options = &*options;
        if options.cache == 0 {
            prepare(&*session); // what is kept is not shared
        }
        let priority = Priority::try_from(options.priority)?;
        let reliability = match options.reliable {
            0 => Reliability::BestEffort,
            _ => Reliability::Reliable,
        };
        let congestion = match options.droppable {
            0 => CongestionControl::BlockFirst,
            _ => CongestionControl::Drop,
        };
        let mut detection = MissDetectionConfig::default(); // numbers the messages
        if options.heartbeat_ms > 0 {
            detection = detection.sporadic_heartbeat(Duration::from_millis(options.heartbeat_ms));
        }
        let mut builder = (*session)
            .session
            .declare_publisher(key(key_expression)?)
            .reliability(reliability)
            .congestion_control(congestion)
            .priority(priority)
            .express(options.express != 0)
            .advanced()
            .sample_miss_detection(detection);
        if options.cache > 0 {
            let replies = RepliesConfig::default()
                .priority(priority)
                .congestion_control(CongestionControl::Block);
            builder = builder.cache(
                CacheConfig::default()
                    .max_samples(options.cache)
                    .replies_config(replies),
            );
        }
        if options.latched != 0 {
            builder = builder.publisher_detection();
        }
        builder.wait()
    })
}

pub unsafe extern "C" fn make_buffer(
    session: *const Session,
    size: usize,
    share: u8,
    data: *mut *mut u8,
) -> *mut Buffer {
    let memory = match share {
        0 => None,
        _ => guarded(|| shared(&*session, size)).flatten(),
    };
    let made = guarded(|| {
        Box::new(match memory {
            Some(memory) => Buffer::Shared(memory),
            None => Buffer::Own(uncleared(size)),
        })
    });
    let Some(mut buffer) = made else {
        return std::ptr::null_mut();
    };
    *data = match &mut *buffer {
        Buffer::Own(bytes) => bytes.as_mut_ptr(),
        Buffer::Shared(bytes) => bytes.as_mut().as_mut_ptr(),
    };
    Box::into_raw(buffer)
}

/// The caller writes all of it: to clear it first costs as much as the message's copy.
#[allow(clippy::uninit_vec)]
unsafe fn uncleared(size: usize) -> Vec<u8> {
    let mut bytes = Vec::<u8>::with_capacity(size);
    bytes.set_len(size);
    bytes
}

pub unsafe extern "C" fn put(
    publisher: *const Publisher,
    buffer: *mut Buffer,
    attachment: *const u8,
    attachment_size: usize,
) -> c_int {
    c_int::from(done(|| {
        let payload = Buffer::into_bytes(buffer);
        (*publisher)
            .put(payload)
            .attachment(bytes(attachment, attachment_size))
            .wait()
    }))
}
