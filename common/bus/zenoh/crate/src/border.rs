// SPDX-License-Identifier: Apache-2.0
//! Where C calls: no panic passes, failures become texts, objects become pointers.

use std::ffi::{c_char, c_int, c_void, CStr};
use std::panic::{catch_unwind, AssertUnwindSafe};

use zenoh::bytes::ZBytes;
use zenoh::key_expr::KeyExpr;
use zenoh::query::Query;
use zenoh::sample::Sample;

pub type Failure = Box<dyn std::error::Error + Send + Sync>;
pub type OnSample = extern "C" fn(*mut c_void, *mut Sample);
pub type OnQuery = extern "C" fn(*mut c_void, *mut Query);
pub type OnToken = extern "C" fn(*mut c_void, *const c_char, usize, c_int);
pub type Release = extern "C" fn(*mut c_void);

/// Runs `body`. @return None if it panics.
pub fn guarded<T>(body: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(body)).ok()
}

/// Runs `body`. @return a pointer that the caller owns; null after a failure, whose text goes to `error`.
pub unsafe fn made<T>(error: *mut c_char, capacity: usize, body: impl FnOnce() -> Result<T, Failure>) -> *mut T {
    let text = match guarded(|| body().map_err(|failure| failure.to_string())) {
        Some(Ok(value)) => return Box::into_raw(Box::new(value)),
        Some(Err(text)) => text,
        None => "Zenoh has failed inside".to_string(),
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
    matches!(guarded(body), Some(Ok(())))
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

/// What C lends, copied.
pub unsafe fn bytes(data: *const u8, size: usize) -> ZBytes {
    match size {
        0 => ZBytes::new(),
        _ => std::slice::from_raw_parts(data, size).into(),
    }
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
    /// Calls C.
    pub fn tell(&self, call: impl FnOnce(*mut c_void)) {
        guarded(|| call(self.object));
    }
}

impl Drop for Object {
    fn drop(&mut self) {
        (self.release)(self.object);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    extern "C" fn keep(_: *mut c_void) {}

    #[test]
    fn a_panic_is_a_failure_with_a_text() {
        let mut error: [c_char; 32] = [1; 32];
        let made = unsafe { made::<u8>(error.as_mut_ptr(), error.len(), || panic!("inside")) };
        assert!(made.is_null());
        assert_eq!(unsafe { text(error.as_ptr()) }.unwrap(), "Zenoh has failed inside");
    }

    #[test]
    fn a_failure_whose_text_panics_is_one_too() {
        #[derive(Debug)]
        struct Mute;
        impl std::fmt::Display for Mute {
            fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                panic!("inside")
            }
        }
        impl std::error::Error for Mute {}
        assert!(unsafe { made::<u8>(std::ptr::null_mut(), 0, || Err(Box::new(Mute))) }.is_null());
    }

    #[test]
    fn no_panic_leaves_what_c_calls_or_is_called_by() {
        assert!(!done(|| panic!("inside")));
        assert!(guarded(|| -> u8 { panic!("inside") }).is_none());
        Object::new(std::ptr::null_mut(), keep).tell(|_| panic!("inside"));
    }

    #[test]
    fn nothing_is_lent_as_null() {
        assert!(unsafe { bytes(std::ptr::null(), 0) }.is_empty());
    }
}
