// SPDX-License-Identifier: Apache-2.0
//! Where C calls: no panic passes, failures become texts, objects become pointers.

use std::ffi::{c_char, c_int, c_void, CStr};
use std::panic::{catch_unwind, AssertUnwindSafe};

use zenoh::key_expr::KeyExpr;
use zenoh::query::Query;
use zenoh::sample::Sample;

pub type Failure = Box<dyn std::error::Error + Send + Sync>;
pub type OnSample = extern "C" fn(*mut c_void, *mut Sample);
pub type OnQuery = extern "C" fn(*mut c_void, *mut Query);
pub type OnToken = extern "C" fn(*mut c_void, *const c_char, usize, c_int);
pub type Release = extern "C" fn(*mut c_void);

/// Runs `body`. @return a pointer that the caller owns; null after a failure, whose text goes to `error`.
pub unsafe fn made<T>(error: *mut c_char, capacity: usize, body: impl FnOnce() -> Result<T, Failure>) -> *mut T {
    let text = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(value)) => return Box::into_raw(Box::new(value)),
        Ok(Err(failure)) => failure.to_string(),
        Err(_) => "Zenoh has failed inside".to_string(),
    };
    let count = text.len().min(capacity.saturating_sub(1));
    if capacity > 0 {
        std::ptr::copy_nonoverlapping(text.as_ptr(), error.cast(), count);
        *error.add(count) = 0;
    }
    std::ptr::null_mut()
}

/// Runs `body`. @return false after a failure.
pub fn done(body: impl FnOnce() -> Result<(), Failure>) -> bool {
    matches!(catch_unwind(AssertUnwindSafe(body)), Ok(Ok(())))
}

/// Ends an object that C owned.
pub unsafe extern "C" fn give_back<T>(object: *mut T) {
    done(|| {
        drop(Box::from_raw(object));
        Ok(())
    });
}

pub unsafe fn text<'a>(text: *const c_char) -> Result<&'a str, Failure> {
    Ok(CStr::from_ptr(text).to_str()?)
}

pub unsafe fn key(key: *const c_char) -> Result<KeyExpr<'static>, Failure> {
    KeyExpr::try_from(text(key)?.to_owned())
}

/// The caller's object behind a callback. Released with the last callback that knows it.
pub struct Object {
    object: *mut c_void,
    release: Release,
}

// It is the caller's promise that his object may be used from any thread.
unsafe impl Send for Object {}
unsafe impl Sync for Object {}

impl Object {
    pub fn new(object: *mut c_void, release: Release) -> Self {
        Self { object, release }
    }
    pub fn get(&self) -> *mut c_void {
        self.object
    }
}

impl Drop for Object {
    fn drop(&mut self) {
        (self.release)(self.object);
    }
}
