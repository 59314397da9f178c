// SPDX-License-Identifier: Apache-2.0
use std::ffi::c_char;

use serde_json::Value;
use zenoh::{Config, Wait};

use crate::border::{done, guarded, made, text, Failure};

pub struct Session {
    pub session: zenoh::Session,
}

/// `over` wins element by element; lists are elements.
fn lay_over(base: &mut Value, over: Value) {
    match (base, over) {
        (Value::Object(base), Value::Object(over)) => {
            for (name, value) in over {
                lay_over(base.entry(name).or_insert(Value::Null), value);
            }
        }
        (base, over) => *base = over,
    }
}

fn settings(ours: &str, file: Option<&str>) -> Result<Config, Failure> {
    let mut settings: Value = json5::from_str(ours)?;
    if let Some(file) = file {
        let explain = |e: &dyn std::fmt::Display| format!("{file}: {e}");
        let theirs = std::fs::read_to_string(file).map_err(|e| explain(&e))?;
        lay_over(&mut settings, json5::from_str(&theirs).map_err(|e| explain(&e))?);
    }
    Config::from_json5(&settings.to_string())
}

pub unsafe extern "C" fn open(
    ours: *const c_char,
    over: *const c_char,
    error: *mut c_char,
    capacity: usize,
) -> *mut Session {
    made(error, capacity, || {
        let file = if over.is_null() { None } else { Some(text(over)?) };
        let session = zenoh::open(settings(text(ours)?, file)?).wait()?;
        Ok(Session { session })
    })
}

pub unsafe extern "C" fn close(session: *mut Session) {
    done(|| Box::from_raw(session).session.close().wait());
}

pub unsafe extern "C" fn id(session: *const Session, out: *mut c_char) {
    write_text(
        &guarded(|| (*session).session.zid().to_string()).unwrap_or_default(),
        out,
    );
}

/// `out` has room for 33 bytes.
pub unsafe fn write_text(id: &str, out: *mut c_char) {
    let count = id.len().min(32);
    std::ptr::copy_nonoverlapping(id.as_ptr(), out.cast(), count);
    *out.add(count) = 0;
}
