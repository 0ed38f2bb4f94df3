//! Files that tell whether they are whole: a line with a hash of all that follows it,
//! then JSON.

use std::path::Path;

use gnomon_pipeline::world::files::{self, FileError};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::stored::FORMAT;

/// Most bytes that are read of one.
const LIMIT: u64 = 64 << 20;

/// `value` as the bytes of a file.
pub(super) fn seal(kind: &str, value: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let body = serde_json::to_string_pretty(value)? + "\n";
    let hash = blake3::hash(body.as_bytes()).to_hex();
    Ok(format!("{} {hash}\n{body}", title(kind)).into_bytes())
}

/// The value in the file at `path`: `None` where there is no file, or what is wrong
/// with it.
pub(super) fn open<T: DeserializeOwned>(kind: &str, path: &Path) -> Result<Option<T>, String> {
    let bytes = match files::read(path, LIMIT) {
        Ok(bytes) => bytes,
        Err(FileError::Unreadable(e)) if e.kind() == std::io::ErrorKind::NotFound => {
            return Ok(None);
        }
        Err(error) => return Err(error.to_string()),
    };
    let text = String::from_utf8(bytes).map_err(|_| "it is no text".to_owned())?;
    unseal(kind, &text).map(Some)
}

fn unseal<T: DeserializeOwned>(kind: &str, text: &str) -> Result<T, String> {
    let title = title(kind);
    let (head, body) = text.split_once('\n').unwrap_or((text, ""));
    let hash = head
        .strip_prefix(&title)
        .ok_or_else(|| format!("it does not begin with `{title}`"))?;
    if hash.trim() != blake3::hash(body.as_bytes()).to_hex().as_str() {
        return Err("it is not what was written: its hash differs".to_owned());
    }
    serde_json::from_str(body).map_err(|e| e.to_string())
}

fn title(kind: &str) -> String {
    format!("gnomon-bench-{kind} {FORMAT}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_changed_byte_is_noticed() {
        let whole = seal("cell", &vec![1.5, 2.5]).unwrap();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let read = |bytes: &[u8]| unseal::<Vec<f64>>("cell", &text(bytes));
        assert_eq!(read(&whole), Ok(vec![1.5, 2.5]));
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] = if changed[at] == b'7' { b'8' } else { b'7' };
            assert!(read(&changed).is_err(), "byte {at}");
            assert!(read(&whole[..at]).is_err(), "cut at {at}");
        }
        assert!(unseal::<Vec<f64>>("plan", &text(&whole)).is_err());
    }
}
