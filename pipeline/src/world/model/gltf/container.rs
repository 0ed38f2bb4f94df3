//! Binary glTF: JSON and one buffer in a file of chunks.

use super::error::GltfProblem;

/// Bytes of the JSON, and those of the buffer, if there is one.
pub(super) type Parts<'a> = (&'a [u8], Option<&'a [u8]>);

/// The parts of a file: the whole of a `.gltf`, the chunks of a `.glb`.
pub(super) fn parts(bytes: &[u8]) -> Result<Parts<'_>, GltfProblem> {
    if !bytes.starts_with(b"glTF") {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok((text, None));
    }
    let bad = |what: String| GltfProblem::BadContainer { what };
    let header = |at| word(bytes, at).ok_or_else(|| bad("the header is cut short".to_owned()));
    let [version, length] = [header(4)?, header(8)?];
    if version != 2 {
        return Err(bad(format!("the version is {version}")));
    }
    let whole = bytes.get(12..length as usize).ok_or_else(|| {
        let own = bytes.len();
        bad(format!(
            "the header says {length} bytes, the file has {own}"
        ))
    })?;
    let mut rest = whole;
    let (mut json, mut buffer) = (None, None);
    while !rest.is_empty() {
        let (kind, chunk, after) = chunk(rest).map_err(&bad)?;
        rest = after;
        match kind {
            b"JSON" => json = json.or(Some(chunk)),
            b"BIN\0" => buffer = buffer.or(Some(chunk)),
            _ => {} // Other chunks are for others.
        }
    }
    let json = json.ok_or_else(|| bad("there is no chunk 'JSON'".to_owned()))?;
    Ok((json, buffer))
}

/// Kind and bytes of a chunk, and what is behind it.
type Chunk<'a> = (&'a [u8], &'a [u8], &'a [u8]);

/// The kind of the first chunk, its bytes, and what is behind it.
fn chunk(bytes: &[u8]) -> Result<Chunk<'_>, String> {
    let cut = || "a chunk is cut short".to_owned();
    let length = word(bytes, 0).ok_or_else(cut)? as usize;
    let kind = bytes.get(4..8).ok_or_else(cut)?;
    let (chunk, after) = bytes[8..].split_at_checked(length).ok_or_else(cut)?;
    // Chunks begin at multiples of 4; the last one may lack its padding.
    let padding = (length.wrapping_neg() % 4).min(after.len());
    Ok((kind, chunk, &after[padding..]))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}
