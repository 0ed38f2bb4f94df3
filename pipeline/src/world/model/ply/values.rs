//! The values behind the header, one after the other, as f64, which holds all types.

use super::header::{Encoding, Scalar};

/// Why there is no next value.
#[derive(Debug)]
pub(super) enum NoValue {
    /// The data end.
    End,
    /// A word of ASCII that is no number.
    NoNumber { text: String, line: usize },
}

/// What is left to read.
pub(super) struct Values<'a> {
    encoding: Encoding,
    rest: &'a [u8],
    line: usize,
}

impl<'a> Values<'a> {
    pub(super) fn new(encoding: Encoding, rest: &'a [u8]) -> Self {
        Self {
            encoding,
            rest,
            line: 1,
        }
    }

    /// Bytes left.
    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    /// What is left, without blanks at its end where these are text.
    pub(super) fn left_over(&self) -> usize {
        match self.encoding {
            Encoding::Ascii => self.rest.trim_ascii().len(),
            _ => self.rest.len(),
        }
    }

    /// The next value, which is of type `scalar`.
    pub(super) fn next(&mut self, scalar: Scalar) -> Result<f64, NoValue> {
        if self.encoding == Encoding::Ascii {
            let value = self.word()?;
            // As the same file says it in binary.
            return Ok(match scalar {
                Scalar::F32 => f64::from(value as f32),
                _ => value,
            });
        }
        let (bytes, rest) = self
            .rest
            .split_at_checked(scalar.bytes())
            .ok_or(NoValue::End)?;
        self.rest = rest;
        let mut word = [0; 8];
        // The least significant byte first.
        word[..bytes.len()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            word[..bytes.len()].reverse();
        }
        Ok(decode(scalar, u64::from_le_bytes(word)))
    }

    fn word(&mut self) -> Result<f64, NoValue> {
        let blanks = self.rest.len() - self.rest.trim_ascii_start().len();
        self.line += ends(&self.rest[..blanks]);
        let rest = &self.rest[blanks..];
        let end = rest.iter().position(u8::is_ascii_whitespace);
        let (word, rest) = rest.split_at(end.unwrap_or(rest.len()));
        if word.is_empty() {
            return Err(NoValue::End);
        }
        self.rest = rest;
        let text = String::from_utf8_lossy(word);
        text.parse().map_err(|_| NoValue::NoNumber {
            text: crate::world::tally::beginning(&text, 40),
            line: self.line,
        })
    }
}

/// Lines that end in `blanks`: CR LF is one end.
fn ends(blanks: &[u8]) -> usize {
    let count = |end: u8| blanks.iter().filter(|b| **b == end).count();
    count(b'\n').max(count(b'\r'))
}

/// The value of the bits of `word` that are of the type.
fn decode(scalar: Scalar, word: u64) -> f64 {
    match scalar {
        Scalar::I8 => f64::from(word as u8 as i8),
        Scalar::U8 => f64::from(word as u8),
        Scalar::I16 => f64::from(word as u16 as i16),
        Scalar::U16 => f64::from(word as u16),
        Scalar::I32 => f64::from(word as u32 as i32),
        Scalar::U32 => f64::from(word as u32),
        Scalar::F32 => f64::from(f32::from_bits(word as u32)),
        Scalar::F64 => f64::from_bits(word),
    }
}
