//! Files taken apart and put together again with other contents and right hashes, by the
//! description in `docs/traces.md` and not by the code that it describes.

use xxhash_rust::xxh3::xxh3_128;

const MAGIC: &[u8; 8] = b"\x89GNT\r\n\x1a\n";
const HEADER: usize = 48;

/// A section, unpacked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) tag: [u8; 4],
    pub(crate) version: u16,
    pub(crate) frame: u32,
    pub(crate) part: u32,
    pub(crate) data: Vec<u8>,
    /// Where its header begins.
    pub(crate) offset: usize,
}

fn number(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |n, b| n << 8 | usize::from(*b))
}

/// The sections of a file but its index.
pub(crate) fn take_apart(file: &[u8]) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut at = 16;
    while &file[at..at + 4] != b"INDX" {
        let h = &file[at..at + HEADER];
        let stored = number(&h[24..32]);
        let bytes = &file[at + HEADER..at + HEADER + stored];
        let data = match h[6] {
            0 => bytes.to_vec(),
            _ => zstd::bulk::decompress(bytes, number(&h[16..24])).unwrap(),
        };
        parts.push(Part {
            tag: h[..4].try_into().unwrap(),
            version: number(&h[4..6]) as u16,
            frame: number(&h[8..12]) as u32,
            part: number(&h[12..16]) as u32,
            data,
            offset: at,
        });
        at = (at + HEADER + stored).next_multiple_of(8);
    }
    parts
}

fn push(file: &mut Vec<u8>, part: &Part) -> Vec<u8> {
    let start = file.len();
    file.extend(part.tag);
    file.extend(part.version.to_le_bytes());
    file.extend([0, 0]);
    file.extend(part.frame.to_le_bytes());
    file.extend(part.part.to_le_bytes());
    file.extend((part.data.len() as u64).to_le_bytes());
    file.extend((part.data.len() as u64).to_le_bytes());
    file.extend(xxh3_128(&part.data).to_le_bytes());
    let header = file[start..].to_vec();
    file.extend(&part.data);
    file.resize(file.len().next_multiple_of(8), 0);
    header
}

/// A file of sections, none of them packed.
pub(crate) fn put_together(parts: &[Part]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend([1, 0, 0, 0, 0, 0, 0, 0]);
    let mut index = Vec::new();
    for part in parts {
        index.extend((file.len() as u64).to_le_bytes());
        index.extend(push(&mut file, part));
    }
    let at = file.len() as u64;
    let index = Part {
        tag: *b"INDX",
        version: 1,
        frame: 0,
        part: 0,
        data: index,
        offset: 0,
    };
    push(&mut file, &index);
    file.extend(at.to_le_bytes());
    file.extend(MAGIC);
    file
}

/// `file` with the data of a section changed.
pub(crate) fn forged(file: &[u8], tag: &[u8; 4], change: impl FnOnce(&mut Part)) -> Vec<u8> {
    let mut parts = take_apart(file);
    let part = parts.iter_mut().find(|p| p.tag == *tag);
    change(part.expect("there is such a section"));
    put_together(&parts)
}
