// SPDX-License-Identifier: Apache-2.0
//! What zenoh-link-tls 1.10.2 is given in place of its `UnsafeCell` of a TLS stream (zenoh-link-tls.sed): that was read by one
//! thread while another one wrote, and one `rustls` connection does not bear it.
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};

use tokio::io::{AsyncRead, AsyncWrite, AsyncWriteExt, ReadBuf};
use tokio::net::TcpStream;
use tokio_rustls::TlsStream;

/// One stream with a lock for each step of it; no step waits for the network.
#[derive(Clone)]
pub struct SharedStream(Arc<Mutex<TlsStream<TcpStream>>>);

impl SharedStream {
    pub fn new(stream: TlsStream<TcpStream>) -> Self {
        Self(Arc::new(Mutex::new(stream)))
    }

    /// Returns when the kernel has all: what `rustls` has encrypted would else wait for the next message where a link is full.
    pub async fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        AsyncWriteExt::write_all(self, bytes).await?;
        self.flush().await
    }

    fn step<T>(&self, step: impl FnOnce(Pin<&mut TlsStream<TcpStream>>) -> T) -> T {
        step(Pin::new(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

impl AsyncRead for SharedStream {
    fn poll_read(self: Pin<&mut Self>, context: &mut Context<'_>, into: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        self.step(|stream| stream.poll_read(context, into))
    }
}

impl AsyncWrite for SharedStream {
    fn poll_write(self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        self.step(|stream| stream.poll_write(context, bytes))
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.step(|stream| stream.poll_flush(context))
    }

    /// Of the TCP connection below, as zenoh-link-tls ends its links.
    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.step(|stream| Pin::new(stream.get_mut().get_mut().0).poll_shutdown(context))
    }
}
