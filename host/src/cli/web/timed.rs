//! Connections that last for a limited time in total.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Bytes that are written at once.
const MOST_WRITE: usize = 64 << 10;

/// A connection that is read or written until a time, however slowly its bytes come and go.
pub struct Timed<'s> {
    stream: &'s TcpStream,
    end: Instant,
}

impl<'s> Timed<'s> {
    /// Returns the connection, to be used for so long.
    pub fn new(stream: &'s TcpStream, patience: Duration) -> Self {
        let end = Instant::now() + patience;
        Self { stream, end }
    }

    /// Returns the time that is left.
    fn left(&self) -> io::Result<Duration> {
        let left = self.end.saturating_duration_since(Instant::now());
        match left.is_zero() {
            true => Err(io::ErrorKind::TimedOut.into()),
            false => Ok(left),
        }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(self.left()?))?;
        self.stream.read(bytes)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(Some(self.left()?))?;
        // A system may wait until it has taken all bytes, which a slow reader draws out.
        self.stream.write(&bytes[..bytes.len().min(MOST_WRITE)])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::{Ipv4Addr, TcpListener};
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;

    /// A server's end of a connection, and a browser's.
    fn connection() -> (TcpStream, TcpStream) {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let browser = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (listener.accept().unwrap().0, browser)
    }

    #[test]
    fn slow_reader_of_an_answer_is_given_up_in_time() {
        let (server, mut browser) = connection();
        let is_over = AtomicBool::new(false);
        thread::scope(|scope| {
            scope.spawn(|| {
                // Each piece is read long before the end of the time.
                let mut piece = [0; 1 << 12];
                while !is_over.load(Ordering::Relaxed) {
                    browser.read_exact(&mut piece).unwrap();
                    thread::sleep(Duration::from_millis(20));
                }
            });
            let begun = Instant::now();
            let mut timed = Timed::new(&server, Duration::from_millis(300));
            let written = timed.write_all(&vec![0; 64 << 20]);
            is_over.store(true, Ordering::Relaxed);
            assert!(written.is_err());
            assert!(begun.elapsed() < Duration::from_secs(5));
        });
    }

    #[test]
    fn slow_writer_of_a_request_is_given_up_in_time() {
        let (server, mut browser) = connection();
        thread::scope(|scope| {
            scope.spawn(move || {
                while browser.write_all(b"x").is_ok() {
                    thread::sleep(Duration::from_millis(20));
                }
            });
            let begun = Instant::now();
            let timed = Timed::new(&server, Duration::from_millis(300));
            let rest = io::copy(&mut timed.take(1 << 20), &mut io::sink());
            assert!(rest.is_err());
            assert!(begun.elapsed() < Duration::from_secs(5));
            drop(server);
        });
    }
}
