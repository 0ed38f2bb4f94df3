//! Transport on disk. A file is
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `GNOMPRT` and a line feed |
//! | 4 | format version, 1 |
//! | 8, 8 | numbers of rays that were cast, and of vertices inside the object |
//! | 32 | the hash that is its name |
//! | 4 per coefficient | diffuse ones, then glossy ones, vertex after vertex |
//! | 32 | BLAKE3 hash of all before |
//!
//! with all numbers little-endian, and is treated as images are.

use std::path::Path;
use std::sync::Arc;

use super::{CacheWarning, OracleCache};
use crate::geometry::harmonics::terms;
use crate::truth::oracle::transport::{
    Transport, TransportKey, TransportObject, TransportSettings,
};
use crate::world::files::{self, FileError};

const MAGIC: &[u8; 8] = b"GNOMPRT\n";
const FORMAT_VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 8 + 8 + 32;
const CHECKSUM: usize = 32;

/// Transport and how it was come by.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedTransport {
    /// It.
    pub transport: Arc<Transport>,
    /// Whether it was read, or known already; else it was computed.
    pub was_known: bool,
    /// What went wrong with the cache; the transport is right all the same.
    pub warnings: Vec<CacheWarning>,
}

impl OracleCache {
    /// Transport of an object: known, read, or else computed, and then kept both here
    /// and for [`Transport::kept`]. `done` is called with numbers of vertices that were
    /// computed, from any thread.
    pub fn transport(
        &self,
        object: &TransportObject<'_>,
        settings: TransportSettings,
        done: &(dyn Fn(usize) + Sync),
    ) -> CachedTransport {
        let key = TransportKey::of(object, settings);
        let mut warnings = Vec::new();
        if let Some(transport) = Transport::find(&key) {
            return CachedTransport {
                transport,
                was_known: true,
                warnings,
            };
        }
        let path = self.folder.join(key.file_name());
        let read = read(&path, &key, object.positions.len(), settings);
        let was_known = matches!(read, Ok(Some(_)));
        let transport = match read {
            Ok(Some(transport)) => transport,
            Ok(None) => self.computed(object, settings, done, &path, &mut warnings),
            Err(problem) => {
                let ignored = path.clone();
                warnings.push(CacheWarning::Ignored {
                    path: ignored,
                    problem,
                });
                self.computed(object, settings, done, &path, &mut warnings)
            }
        };
        let transport = Arc::new(transport);
        transport.clone().keep(key);
        CachedTransport {
            transport,
            was_known,
            warnings,
        }
    }

    fn computed(
        &self,
        object: &TransportObject<'_>,
        settings: TransportSettings,
        done: &(dyn Fn(usize) + Sync),
        path: &Path,
        warnings: &mut Vec<CacheWarning>,
    ) -> Transport {
        let transport = Transport::new(object, settings, done);
        let key = TransportKey::of(object, settings);
        if let Err(error) = self.write(path, &encode(&key, &transport)) {
            warnings.push(CacheWarning::NotWritten {
                path: path.to_owned(),
                problem: error.to_string(),
            });
        }
        transport
    }
}

fn encode(key: &TransportKey, transport: &Transport) -> Vec<u8> {
    let mut bytes = Vec::from(*MAGIC);
    bytes.extend(FORMAT_VERSION.to_le_bytes());
    bytes.extend(transport.rays.to_le_bytes());
    bytes.extend(transport.buried.to_le_bytes());
    bytes.extend(key.bytes());
    let all = transport.diffuse.iter().chain(&transport.glossy);
    bytes.extend(all.flat_map(|v| v.to_le_bytes()));
    let checksum = *blake3::hash(&bytes).as_bytes();
    bytes.extend(checksum);
    bytes
}

/// What a file holds; `None` if there is no such file.
fn read(
    path: &Path,
    key: &TransportKey,
    vertices: usize,
    settings: TransportSettings,
) -> Result<Option<Transport>, String> {
    let counts = [settings.bands, settings.glossy_bands].map(|b| vertices * terms(b));
    let length = HEADER + 4 * (counts[0] + counts[1]) + CHECKSUM;
    let bytes = match files::read(path, length as u64) {
        Ok(bytes) => bytes,
        Err(FileError::Unreadable(e)) if e.kind() == std::io::ErrorKind::NotFound => {
            return Ok(None);
        }
        Err(e) => return Err(e.to_string()),
    };
    decode(&bytes, length, key).map(|([rays, buried], mut values)| {
        let glossy = values.split_off(counts[0]);
        Some(Transport {
            settings,
            diffuse: values,
            glossy,
            rays,
            buried,
        })
    })
}

/// Rays and buried vertices, and coefficients.
type Decoded = ([u64; 2], Vec<f32>);

fn decode(bytes: &[u8], length: usize, key: &TransportKey) -> Result<Decoded, String> {
    if !bytes.starts_with(MAGIC) {
        return Err("not transport".into());
    }
    if bytes.len() != length {
        return Err(format!("{length} bytes are expected, not {}", bytes.len()));
    }
    let (content, checksum) = bytes.split_at(length - CHECKSUM);
    if blake3::hash(content).as_bytes() != checksum {
        return Err("damaged: the checksum differs".into());
    }
    let number = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|k| content[at + k]));
    if number(8) != FORMAT_VERSION {
        let version = number(8);
        return Err(format!(
            "format {version}, but this is for format {FORMAT_VERSION}"
        ));
    }
    if content[28..HEADER] != key.bytes() {
        return Err("transport of something else".into());
    }
    let long = |at: usize| u64::from(number(at)) | u64::from(number(at + 4)) << 32;
    let values = content[HEADER..].as_chunks::<4>().0;
    Ok((
        [long(12), long(20)],
        values.iter().map(|v| f32::from_le_bytes(*v)).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::world::scratch::Scratch;

    /// An object of its own for each test: what is kept in memory is asked first.
    fn object(at: f32) -> ([[f32; 3]; 3], [[f32; 3]; 3]) {
        let positions = [[at, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        (positions, [[0.0, 1.0, 0.0]; 3])
    }

    fn through(cache: &OracleCache, at: f32, directions: usize) -> CachedTransport {
        let (positions, normals) = object(at);
        let object = TransportObject {
            positions: &positions,
            normals: &normals,
            triangles: &[[0, 1, 2]],
            casts: true,
        };
        let settings = TransportSettings {
            directions,
            ..TransportSettings::default()
        };
        cache.transport(&object, settings, &|_| {})
    }

    #[test]
    fn what_is_known_is_not_computed_and_files_hold_the_same_bits() {
        let folder = Scratch::new("transport-cache");
        let cache = OracleCache::new(&*folder);
        let first = through(&cache, 0.125, 100);
        assert!(!first.was_known && first.warnings.is_empty());
        assert!(through(&cache, 0.125, 100).was_known);
        let key = {
            let (positions, normals) = object(0.125);
            let object = TransportObject {
                positions: &positions,
                normals: &normals,
                triangles: &[[0, 1, 2]],
                casts: true,
            };
            TransportKey::of(&object, first.transport.settings)
        };
        let path = folder.join(key.file_name());
        let settings = first.transport.settings;
        let read_back = || read(&path, &key, 3, settings);
        assert_eq!(read_back(), Ok(Some((*first.transport).clone())));
        let whole = fs::read(&path).unwrap();
        for (at, problem) in [
            (0, "not transport"),
            (30, "damaged"),
            (whole.len() - 1, "damaged"),
        ] {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            fs::write(&path, bytes).unwrap();
            assert!(read_back().unwrap_err().contains(problem), "{at}");
        }
        fs::write(&path, &whole[..whole.len() - 4]).unwrap();
        assert!(read_back().unwrap_err().contains("expected"));
    }

    #[test]
    fn a_cache_that_cannot_be_written_only_warns() {
        let folder = Scratch::made("transport-blocked");
        let blocked = folder.join("file");
        fs::write(&blocked, "a file where the folder should be").unwrap();
        let found = through(&OracleCache::new(blocked), 0.25, 90);
        assert!(!found.was_known && !found.warnings.is_empty());
        assert_eq!(found.transport.vertices(), 3);
    }
}
