//! The file being written, and the threads on which its parts are made.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write as _};
use std::ops::Range;

use crate::base::{Error, ErrorKind, Result, Threads};

/// Rows that a thread writes at a time.
pub(super) const ROWS_PER_PART: usize = 4096;
/// Parts in flight per thread. More would need more memory; with fewer, threads wait for one another.
const PARTS_PER_THREAD: usize = 4;

/// The file being written. Bytes are added at its end, and may be replaced later.
#[derive(Debug)]
pub struct Output<'a> {
    place: Place<'a>,
    len: u64,
    threads: &'a Threads,
}

#[derive(Debug)]
enum Place<'a> {
    File(&'a mut File),
    Memory(&'a mut Vec<u8>),
}

/// A part of the file, and the state of the one who makes it.
#[derive(Default)]
struct Slot<S> {
    state: S,
    bytes: Vec<u8>,
}

impl<'a> Output<'a> {
    /// Writes to an empty file, in which positions can be set.
    pub(super) fn to_file(file: &'a mut File, threads: &'a Threads) -> Self {
        Self { place: Place::File(file), len: 0, threads }
    }

    /// Writes to an empty buffer.
    pub(super) fn to_memory(bytes: &'a mut Vec<u8>, threads: &'a Threads) -> Self {
        Self { place: Place::Memory(bytes), len: 0, threads }
    }

    /// Number of bytes written.
    pub(super) fn len(&self) -> u64 {
        self.len
    }

    /// The threads for work on the file.
    pub(super) fn threads(&self) -> &'a Threads {
        self.threads
    }

    /// Replaces bytes from `at`, which must have been written.
    pub(super) fn replace(&mut self, at: u64, bytes: &[u8]) -> Result<()> {
        match &mut self.place {
            Place::Memory(all) => {
                all[at as usize..][..bytes.len()].copy_from_slice(bytes);
                Ok(())
            }
            Place::File(file) => {
                let put = file.seek(SeekFrom::Start(at)).and_then(|_| file.write_all(bytes));
                put.and_then(|()| file.seek(SeekFrom::End(0))).map(drop).map_err(|e| failed(&e))
            }
        }
    }

    /// Writes the parts that `make` appends to a buffer for each number below `n`, in order; returns what it
    /// returned. Parts are made on all threads, a bounded number at a time, while those before are written.
    /// `make` also gets a state, which is reused.
    pub(super) fn parts<S: Default + Send, T: Send>(
        &mut self,
        n: usize,
        make: impl Fn(&mut S, usize, &mut Vec<u8>) -> Result<T> + Sync + Send,
    ) -> Result<Vec<T>> {
        let threads = self.threads;
        let window = if threads.count() == 1 { 1 } else { PARTS_PER_THREAD * threads.count() };
        let mut results = Vec::with_capacity(n);
        let (mut made, mut next): (Vec<Slot<S>>, Vec<Slot<S>>) = (Vec::new(), Vec::new());
        for start in (0..n).step_by(window) {
            next.resize_with(window.min(n - start), Slot::default);
            let of_slot = |(i, slot): (usize, &mut Slot<S>)| {
                slot.bytes.clear();
                make(&mut slot.state, start + i, &mut slot.bytes)
            };
            let (written, new) = threads.join(
                || made.iter_mut().try_for_each(|slot| self.add(&slot.bytes)),
                || threads.each(next.iter_mut().enumerate().collect(), of_slot),
            );
            written.map_err(|e| failed(&e))?;
            for result in new {
                results.push(result?);
            }
            std::mem::swap(&mut made, &mut next);
        }
        made.iter().try_for_each(|slot| self.add(&slot.bytes)).map_err(|e| failed(&e))?;
        Ok(results)
    }

    /// Writes what `make` appends for ranges of the numbers below `n`, in order, on all threads.
    pub(super) fn rows(
        &mut self,
        n: usize,
        make: impl Fn(Range<usize>, Vec<u8>) -> Vec<u8> + Sync + Send,
    ) -> Result<()> {
        let part = |(): &mut (), i: usize, out: &mut Vec<u8>| {
            let rows = i * ROWS_PER_PART..n.min((i + 1) * ROWS_PER_PART);
            *out = make(rows, std::mem::take(out));
            Ok(())
        };
        self.parts(n.div_ceil(ROWS_PER_PART), part).map(drop)
    }

    fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.place {
            Place::File(file) => file.write_all(bytes)?,
            Place::Memory(all) => all.extend_from_slice(bytes),
        }
        self.len += bytes.len() as u64;
        Ok(())
    }
}

/// Writes bytes at the end of an output.
pub(super) fn write_all(output: &mut Output<'_>, bytes: &[u8]) -> Result<()> {
    output.add(bytes).map_err(|e| failed(&e))
}

/// Writes all bytes of a buffer at the end of an output, and empties the buffer.
pub(super) fn drain(buffer: &mut Vec<u8>, output: &mut Output<'_>) -> Result<()> {
    write_all(output, buffer)?;
    buffer.clear();
    Ok(())
}

fn failed(error: &io::Error) -> Error {
    Error::new(ErrorKind::Output, format!("cannot be written: {error}"))
}
