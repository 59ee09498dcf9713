//! Standard output and standard error, whose readers may leave.
//!
//! `triptych replay | head` loses its reader in the middle of a run. The run goes on:
//! its report, its JSON lines and its exit code are wanted all the same, and a run
//! that was cut short must not look like one that agreed.

use std::fmt::Display;
use std::io::{self, Write};

/// An output. What is written after its reader has left goes nowhere; any other
/// failure, such as a full disk, is one.
pub struct Output<W>(W);

/// Standard output.
pub fn stdout() -> Output<io::Stdout> {
    Output(io::stdout())
}

/// Says on standard error what went wrong.
pub fn complain(message: impl Display) {
    // If nobody listens there, the exit code still tells.
    let _ = writeln!(io::stderr(), "triptych: {message}");
}

impl<W: Write> Write for Output<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        or_left(self.0.write(bytes), bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        or_left(self.0.flush(), ())
    }
}

/// The result, or what it would be if the reader were still there.
fn or_left<T>(result: io::Result<T>, done: T) -> io::Result<T> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(done),
        result => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Failing(io::ErrorKind);

    impl Write for Failing {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Err(self.0.into())
        }
    }

    #[test]
    fn only_a_reader_may_leave() {
        let mut left = Output(Failing(io::ErrorKind::BrokenPipe));
        writeln!(left, "line").expect("nobody reads it");
        left.flush().expect("nobody reads it");
        let mut full = Output(Failing(io::ErrorKind::StorageFull));
        let error = writeln!(full, "line").expect_err("the disk is full");
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        full.flush().expect_err("the disk is full");
    }
}
