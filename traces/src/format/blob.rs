//! `BLOB`: data of buffers and images, each once, found by its hash.
//!
//! ```text
//! u32 count | count × (blake3[32] | u64 bytes) | the bytes, one after the other
//! ```

use std::collections::BTreeMap;
use std::sync::Arc;

/// Bytes of a blob's entry in the list.
const ENTRY: usize = 40;

/// Bytes and their name.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Blob {
    name: [u8; 32],
    bytes: Arc<[u8]>,
}

/// Blobs, by number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blobs {
    all: Vec<Blob>,
    numbers: BTreeMap<[u8; 32], u32>,
}

impl Blobs {
    /// The number of `bytes`, which are added where they are new.
    pub(crate) fn add(&mut self, bytes: &Arc<[u8]>) -> u32 {
        self.add_named(hash(bytes), || bytes.clone())
    }

    fn add_named(&mut self, name: [u8; 32], bytes: impl FnOnce() -> Arc<[u8]>) -> u32 {
        let next = self.all.len() as u32;
        let number = *self.numbers.entry(name).or_insert(next);
        if number == next {
            let bytes = bytes();
            self.all.push(Blob { name, bytes });
        }
        number
    }

    /// A blob.
    pub(crate) fn get(&self, number: u32) -> Result<&Arc<[u8]>, String> {
        let found = self.all.get(number as usize);
        found
            .map(|b| &b.bytes)
            .ok_or_else(|| format!("blob {number} is none of the {} there are", self.all.len()))
    }

    /// The section's data.
    pub(crate) fn encode(&self) -> Vec<u8> {
        let mut data = (self.all.len() as u32).to_le_bytes().to_vec();
        for blob in &self.all {
            data.extend(blob.name);
            data.extend((blob.bytes.len() as u64).to_le_bytes());
        }
        for blob in &self.all {
            data.extend_from_slice(&blob.bytes);
        }
        data
    }

    /// Reads the section's data.
    pub(crate) fn decode(data: &[u8]) -> Result<Self, String> {
        let (count, rest) = data.split_first_chunk().ok_or("it has no count of blobs")?;
        let count = u32::from_le_bytes(*count) as usize;
        let list = count.checked_mul(ENTRY).filter(|n| *n <= rest.len());
        let list =
            list.ok_or_else(|| format!("{count} blobs do not fit in {} bytes", data.len()))?;
        let (list, mut bytes) = rest.split_at(list);
        let mut blobs = Self::default();
        for (number, entry) in list.chunks_exact(ENTRY).enumerate() {
            let (name, size) = entry.split_at(32);
            let size = u64::from_le_bytes(size.try_into().expect("8 of 40 bytes"));
            let blob = usize::try_from(size)
                .ok()
                .and_then(|n| bytes.split_at_checked(n));
            let (blob, left) = blob.ok_or_else(|| {
                format!("blob {number} has {size} bytes, {} are left", bytes.len())
            })?;
            let found = hash(blob);
            if found != name {
                return Err(format!(
                    "blob {number} has another blake3 than it is listed with"
                ));
            }
            if blobs.add_named(found, || blob.into()) as usize != number {
                return Err(format!("blob {number} is there twice"));
            }
            bytes = left;
        }
        match bytes.len() {
            0 => Ok(blobs),
            left => Err(format!("{left} bytes are left over behind the blobs")),
        }
    }
}

fn hash(bytes: &[u8]) -> [u8; 32] {
    *blake3::hash(bytes).as_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blobs_are_kept_once_and_come_back() {
        let mut blobs = Blobs::default();
        let [a, b, empty]: [Arc<[u8]>; 3] = [vec![1, 2].into(), vec![3].into(), vec![].into()];
        assert_eq!([&a, &b, &a, &empty].map(|x| blobs.add(x)), [0, 1, 0, 2]);
        let again = Blobs::decode(&blobs.encode()).unwrap();
        assert_eq!(again.all, blobs.all);
        assert!(again.get(3).unwrap_err().contains("none of the 3"));
    }

    #[test]
    fn sizes_that_lie_are_refused() {
        let mut blobs = Blobs::default();
        blobs.add(&vec![7; 100].into());
        let data = blobs.encode();
        let refused = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bad = data.clone();
            change(&mut bad);
            Blobs::decode(&bad).unwrap_err()
        };
        assert!(refused(&|d| d[..4].fill(0xff)).contains("do not fit"));
        assert!(refused(&|d| d[36..44].fill(0xff)).contains("100 are left"));
        assert!(refused(&|d| d[4] ^= 1).contains("another blake3"));
        assert!(refused(&|d| d.push(0)).contains("left over"));
        assert!(refused(&|d| d.truncate(3)).contains("no count"));
    }
}
