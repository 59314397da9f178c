# SPDX-License-Identifier: Apache-2.0
# In zenoh-link-tls 1.10.2, src/unicast.rs: SharedStream (shared_stream.rs) in place of an UnsafeCell.
s/UnsafeCell<TlsStream<TcpStream>>/SharedStream/
s/UnsafeCell::new(socket)/SharedStream::new(socket)/
s/unsafe { &mut \*self\.inner\.get() }/self.inner.clone()/
s/&mut TlsStream<TcpStream>/SharedStream/
s/let tls_stream = self\.get_mut_socket()/let mut tls_stream = self.get_mut_socket()/
s/let (tcp_stream, _) = \(.*\)\.get_mut();/let mut tcp_stream = \1;/
s/^use crate::{/use crate::shared_stream::SharedStream;\n&/
/cell::UnsafeCell,/d
/^unsafe impl /d
