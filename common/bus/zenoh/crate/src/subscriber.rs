// SPDX-License-Identifier: Apache-2.0
use std::ffi::{c_char, c_int, c_void};
use std::time::Duration;

use zenoh::bytes::ZBytes;
use zenoh::sample::{Sample, SourceInfo};
use zenoh::shm::ShmBuf;
use zenoh::Wait;
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

use crate::border::{guarded, key, made, Object, OnSample, Release};
use crate::session::{write_text, Session};

/// How long the state of a publisher is kept that nobody knows to be alive: a bound for made-up ones.
const RETENTION: Duration = Duration::from_secs(300);
const ATTACHMENT: usize = 64;

#[repr(C)]
pub struct SubscriberOptions {
    history: usize,
    recover: u8,
}

#[repr(C)]
pub struct View {
    key: *const c_char,
    key_size: usize,
    data: *const u8,
    size: usize,
    attachment_size: usize,
    attachment: [u8; ATTACHMENT],
    source: [c_char; 33],
}

/// Undeclared when dropped.
#[allow(dead_code)]
pub enum Subscriber {
    Plain(zenoh::pubsub::Subscriber<()>),
    Advanced(AdvancedSubscriber<()>),
}

#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn declare_subscriber(
    session: *const Session,
    key_expression: *const c_char,
    options: *const SubscriberOptions,
    callback: OnSample,
    object: *mut c_void,
    release: Release,
    error: *mut c_char,
    capacity: usize,
) -> *mut Subscriber {
    let object = Object::new(object, release);
    made(error, capacity, || {
        let options = &*options;
        let builder = (*session)
            .session
            .declare_subscriber(key(key_expression)?)
            .callback(move |sample| object.tell(|object| callback(object, Box::into_raw(Box::new(sample)))));
        if options.history == 0 && options.recover == 0 {
            return Ok(Subscriber::Plain(builder.wait()?));
        }
        let mut builder = builder.advanced();
        if options.history > 0 {
            let history = HistoryConfig::default()
                .detect_late_publishers()
                .max_samples(options.history);
            builder = builder.history(history).subscriber_detection();
        }
        if options.recover != 0 {
            builder = builder.recovery(RecoveryConfig::default().heartbeat().retention_period(RETENTION));
        }
        Ok(Subscriber::Advanced(builder.wait()?))
    })
}

/// What a view shows of a message or a request: key, payload, attachment, source (the writing session's identifier).
type Parts<'a> = (&'a str, Option<&'a ZBytes>, Option<&'a ZBytes>, Option<&'a SourceInfo>);

unsafe fn show((key, payload, attachment, source): Parts) -> View {
    let mut view: View = std::mem::zeroed();
    view.key = key.as_ptr().cast();
    view.key_size = key.len();
    view.size = payload.map_or(0, |p| p.len());
    if let Some(payload) = payload {
        let mut pieces = payload.slices();
        if let (Some(only), None) = (pieces.next(), pieces.next()) {
            view.data = only.as_ptr();
        }
    }
    view.attachment_size = attachment.map_or(0, |a| a.len());
    if let Some(attachment) = attachment {
        let bytes = attachment.to_bytes();
        let count = bytes.len().min(ATTACHMENT);
        view.attachment[..count].copy_from_slice(&bytes[..count]);
    }
    let source = source.map_or(String::new(), |s| s.source_id().zid().to_string());
    write_text(&source, view.source.as_mut_ptr());
    view
}

/// @return all zeros, which is a message without an attachment, if that panics.
pub unsafe fn shown<'a>(parts: impl FnOnce() -> Parts<'a>) -> View {
    guarded(|| show(parts())).unwrap_or_else(|| std::mem::zeroed())
}

/// Writes a payload into one piece.
pub unsafe fn gather_into(payload: &ZBytes, mut data: *mut u8) {
    for piece in payload.slices() {
        std::ptr::copy_nonoverlapping(piece.as_ptr(), data, piece.len());
        data = data.add(piece.len());
    }
}

pub unsafe extern "C" fn view(sample: *const Sample, view: *mut View) {
    let s = &*sample;
    *view = shown(|| {
        (
            s.key_expr().as_str(),
            Some(s.payload()),
            s.attachment(),
            s.source_info(),
        )
    });
}

/// Whether what view() has shown is still the message: memory that is shared goes back to its writer when a
/// reader stands still.
pub unsafe extern "C" fn intact(sample: *const Sample) -> c_int {
    let lost = guarded(|| matches!((*sample).payload().as_shm(), Some(memory) if !memory.is_valid()));
    c_int::from(lost == Some(false))
}

pub unsafe extern "C" fn gather(sample: *const Sample, data: *mut u8) {
    guarded(|| gather_into((*sample).payload(), data));
}
