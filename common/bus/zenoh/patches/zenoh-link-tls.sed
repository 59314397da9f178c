# SPDX-License-Identifier: Apache-2.0
# 35 lines of zenoh-link-tls 1.10.2: SharedStream (shared_stream.rs) in place of an UnsafeCell; closing does not wait.
s/UnsafeCell<TlsStream<TcpStream>>/SharedStream/
s/UnsafeCell::new(socket)/SharedStream::new(socket)/
s/unsafe { &mut \*self\.inner\.get() }/self.inner.clone()/
s/&mut TlsStream<TcpStream>/SharedStream/
s/let tls_stream = self\.get_mut_socket()/let mut tls_stream = self.get_mut_socket()/
s/let (tcp_stream, _) = \(.*\)\.get_mut();/let mut tcp_stream = \1;/
s/^use crate::{/use crate::shared_stream::SharedStream;\n&/
/cell::UnsafeCell,/d
/^unsafe impl /d
s/^mod unicast;/mod shared_stream;\n&/

/\/\/ Set the TLS linger option/,/^        }$/d
/static ref TLS_LINGER_TIMEOUT/d
/^    convert::TryInto,$/d
s/ TLS_LINGER_TIMEOUT,//
