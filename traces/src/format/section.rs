//! Sections: what a file is made of. Each says what it is, how long, and the hash of what
//! is stored, so that a reader needs neither an index nor to know all of them.
//!
//! ```text
//! tag[4] | u16 version | u8 codec | u8 0 | u32 frame | u32 part | u64 raw | u64 stored
//!        | u128 xxh3 of stored | stored bytes | zeros up to a multiple of 8
//! ```

use std::io::Read;

use xxhash_rust::xxh3::xxh3_128;

use crate::error::TraceError;

/// Bytes of a section's header.
pub(crate) const HEADER: usize = 48;
/// No section may unpack to more: what sizes promise is not believed beyond this.
const MOST_RAW: u64 = 4 << 30;
/// zstd cannot shrink anything further than this, so that a size that promises more lies.
const MOST_RATIO: u64 = 1 << 16;
/// Level of compression: what it gains beyond costs more time than the frame.
const LEVEL: i32 = 1;

/// How a section is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Codec {
    Raw,
    Zstd,
}

/// A section, unpacked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Section {
    pub(crate) tag: [u8; 4],
    pub(crate) version: u16,
    /// Which frame it is of; 0 where it is of all.
    pub(crate) frame: u32,
    /// Which part of the frame, such as a pass; 0 where it is of all.
    pub(crate) part: u32,
    pub(crate) data: Vec<u8>,
}

/// Where a section is in a file, and what its header says; nothing of it is unpacked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) tag: [u8; 4],
    pub(crate) version: u16,
    pub(crate) codec: u8,
    pub(crate) frame: u32,
    pub(crate) part: u32,
    pub(crate) raw: u64,
    pub(crate) stored: u64,
    pub(crate) hash: u128,
    /// Where its header begins.
    pub(crate) offset: u64,
}

impl Section {
    /// The section as it lies in a file, wherever that is.
    pub(crate) fn pack(&self, codec: Codec) -> Vec<u8> {
        let packed = match codec {
            Codec::Raw => None,
            Codec::Zstd => zstd::bulk::compress(&self.data, LEVEL).ok(),
        };
        let (codec, stored) = match &packed {
            Some(bytes) if bytes.len() < self.data.len() => (1, bytes.as_slice()),
            _ => (0, self.data.as_slice()),
        };
        let mut to = Vec::with_capacity((HEADER + stored.len()).next_multiple_of(8));
        to.extend(self.tag);
        to.extend(self.version.to_le_bytes());
        to.extend([codec, 0]);
        to.extend(self.frame.to_le_bytes());
        to.extend(self.part.to_le_bytes());
        to.extend((self.data.len() as u64).to_le_bytes());
        to.extend((stored.len() as u64).to_le_bytes());
        to.extend(xxh3_128(stored).to_le_bytes());
        to.extend(stored);
        to.resize(to.len().next_multiple_of(8), 0);
        to
    }
}

impl Entry {
    /// The header at `offset`; `None` where the file ends before the section does, or
    /// there is no header.
    pub(crate) fn at(file: &[u8], offset: usize) -> Option<Self> {
        let header = file.get(offset..offset.checked_add(HEADER)?)?;
        let entry = Self {
            tag: header[..4].try_into().ok()?,
            version: u16::from_le_bytes(header[4..6].try_into().ok()?),
            codec: header[6],
            frame: u32::from_le_bytes(header[8..12].try_into().ok()?),
            part: u32::from_le_bytes(header[12..16].try_into().ok()?),
            raw: u64::from_le_bytes(header[16..24].try_into().ok()?),
            stored: u64::from_le_bytes(header[24..32].try_into().ok()?),
            hash: u128::from_le_bytes(header[32..48].try_into().ok()?),
            offset: offset as u64,
        };
        let named = entry.tag.iter().all(u8::is_ascii_uppercase);
        (named && header[7] == 0 && entry.end()? <= file.len()).then_some(entry)
    }

    /// Where the next section begins.
    pub(crate) fn end(&self) -> Option<usize> {
        let stored = usize::try_from(self.stored).ok()?;
        let end = (self.offset as usize)
            .checked_add(HEADER)?
            .checked_add(stored)?;
        end.checked_next_multiple_of(8)
    }

    /// Whether the stored bytes are those that were written.
    pub(crate) fn check(&self, file: &[u8]) -> Result<(), TraceError> {
        let stored = self.stored_bytes(file);
        if xxh3_128(stored) != self.hash {
            return Err(self.wrong("its bytes do not have the hash that was written with them"));
        }
        let end = self.offset as usize + HEADER + stored.len();
        let padding = &file[end..end.next_multiple_of(8)];
        match padding.iter().all(|b| *b == 0) {
            true => Ok(()),
            false => Err(self.wrong("the zeros behind it are not zeros")),
        }
    }

    fn stored_bytes<'a>(&self, file: &'a [u8]) -> &'a [u8] {
        let start = self.offset as usize + HEADER;
        &file[start..start + self.stored as usize]
    }

    /// The section itself, of a file that was checked.
    pub(crate) fn unpack(&self, file: &[u8]) -> Result<Section, TraceError> {
        let stored = self.stored_bytes(file);
        let data = match self.codec {
            0 if self.raw == self.stored => stored.to_vec(),
            1 => self.inflate(stored)?,
            _ => return Err(self.wrong("its codec is none of 0 (raw, sizes equal) and 1 (zstd)")),
        };
        Ok(Section {
            tag: self.tag,
            version: self.version,
            frame: self.frame,
            part: self.part,
            data,
        })
    }

    /// Its first bytes, without the rest, of a file that was checked.
    pub(crate) fn peek<const N: usize>(&self, file: &[u8]) -> Result<[u8; N], TraceError> {
        let stored = self.stored_bytes(file);
        let short = || self.wrong(&format!("it has less than {N} bytes"));
        match self.codec {
            0 => stored.first_chunk().copied().ok_or_else(short),
            _ => {
                let wrong = |e: std::io::Error| self.wrong(&format!("zstd: {e}"));
                let mut start = [0; N];
                let mut stream = zstd::stream::Decoder::with_buffer(stored).map_err(wrong)?;
                stream.read_exact(&mut start).map_err(wrong)?;
                Ok(start)
            }
        }
    }

    fn inflate(&self, stored: &[u8]) -> Result<Vec<u8>, TraceError> {
        if self.raw > MOST_RAW || self.raw / MOST_RATIO > self.stored {
            return Err(self.wrong("it promises more bytes than it can hold"));
        }
        let wrong = |e: std::io::Error| self.wrong(&format!("zstd: {e}"));
        // Memory grows with what is really there, never with what the header promises.
        let mut data = Vec::new();
        let stream = zstd::stream::Decoder::with_buffer(stored).map_err(wrong)?;
        let mut stream = stream.take(self.raw + 1);
        stream.read_to_end(&mut data).map_err(wrong)?;
        if data.len() as u64 != self.raw {
            return Err(self.wrong("it unpacks to another size than its header says"));
        }
        Ok(data)
    }

    /// An error about this section.
    pub(crate) fn wrong(&self, reason: &str) -> TraceError {
        TraceError::Section {
            tag: tag_text(self.tag),
            offset: self.offset,
            reason: reason.to_owned(),
        }
    }
}

/// A tag for people.
pub(crate) fn tag_text(tag: [u8; 4]) -> String {
    tag.iter().map(|b| char::from(*b)).collect()
}
