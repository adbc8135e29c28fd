//! Reading saved states, in which every byte may be wrong.

use crate::{Error, Status};

/// Takes values from the front of `bytes`; all numbers are little-endian.
pub(crate) struct Reader<'a> {
    what: &'static str,
    len: usize,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// `what` names the owner of the state in errors.
    pub(crate) fn new(what: &'static str, bytes: &'a [u8]) -> Self {
        Reader { what, len: bytes.len(), rest: bytes }
    }

    pub(crate) fn take(&mut self, len: usize) -> Result<&'a [u8], Error> {
        let (head, rest) = self
            .rest
            .split_at_checked(len)
            .ok_or_else(|| self.bad(format!("only {} bytes", self.len), "a whole state"))?;
        self.rest = rest;
        Ok(head)
    }

    pub(crate) fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(crate) fn u8(&mut self) -> Result<u8, Error> {
        self.array().map(u8::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, Error> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Result<u64, Error> {
        self.array().map(u64::from_le_bytes)
    }

    pub(crate) fn status(&mut self) -> Result<Status, Error> {
        Ok(match self.u8()? {
            0 => Status::Running,
            1 => Status::Terminated,
            2 => Status::Truncated,
            other => return Err(self.bad(format!("status {other}"), "0 to 2")),
        })
    }

    /// The leading bytes that say what a state belongs to, and in which version of its layout.
    pub(crate) fn tag(&mut self, tag: &[u8]) -> Result<(), Error> {
        let got = self.take(tag.len())?;
        if got == tag {
            return Ok(());
        }
        Err(self.bad(format!("a state marked \"{}\"", got.escape_ascii()), format!("\"{}\"", tag.escape_ascii())))
    }

    /// What has not been taken yet, to its end.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.rest
    }

    /// Nothing may be left over.
    pub(crate) fn finish(&self) -> Result<(), Error> {
        if self.rest.is_empty() {
            return Ok(());
        }
        let used = self.len - self.rest.len();
        Err(self.bad(format!("{} bytes", self.len), format!("{used} bytes")))
    }

    /// The error that these bytes are no such state.
    pub(crate) fn bad(&self, got: impl Into<String>, expected: impl Into<String>) -> Error {
        Error::BadState { what: self.what, got: got.into(), expected: expected.into() }
    }
}
