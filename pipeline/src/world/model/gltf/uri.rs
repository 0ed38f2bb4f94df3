//! What a URI names: bytes of its own, or a file beside.

/// What a URI is.
#[derive(Debug, PartialEq)]
pub(super) enum Uri {
    /// `data:` with its bytes.
    Data(Vec<u8>),
    /// A relative path.
    File(String),
}

/// Reads a URI; the error says what would be valid.
pub(super) fn read(uri: &str) -> Result<Uri, &'static str> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, data) = data
            .split_once(',')
            .ok_or("'data:…;base64,' and the data")?;
        return match kind.ends_with(";base64") {
            true => base64(data).map(Uri::Data).ok_or("data in base64"),
            false => Err("data in base64"),
        };
    }
    let scheme = uri.split(['/', '?', '#']).next().unwrap_or_default();
    if scheme.contains(':') && !is_drive(scheme) {
        return Err("a path in the file's folder, or 'data:'; nothing is fetched");
    }
    decoded(uri)
        .map(Uri::File)
        .ok_or("a path in UTF-8, other bytes written as %XX")
}

/// `C:` of a path that another system would write.
fn is_drive(scheme: &str) -> bool {
    scheme.find(':') == Some(1)
}

/// `%20` and its like as the bytes that they stand for. A `%` that no two digits follow is
/// itself, as exporters that encode nothing write it.
fn decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|d| std::str::from_utf8(d).ok());
        let digits = digits.filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()));
        match digits.and_then(|d| u8::from_str_radix(d, 16).ok()) {
            Some(byte) if first == b'%' => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

/// Bytes that base64 stands for; blanks and line ends inside are skipped.
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0_u32, 0);
    let words = text.bytes().filter(|b| !b.is_ascii_whitespace());
    for byte in words.take_while(|b| *b != b'=') {
        bits = bits << 6 | u32::from(sextet(byte)?);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
            bits &= (1 << held) - 1;
        }
    }
    (held < 6).then_some(bytes)
}

fn sextet(byte: u8) -> Option<u8> {
    Some(match byte {
        b'A'..=b'Z' => byte - b'A',
        b'a'..=b'z' => byte - b'a' + 26,
        b'0'..=b'9' => byte - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_are_decoded() {
        let data = |text: &str| read(&format!("data:application/octet-stream;base64,{text}"));
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYg", b"foob"),
            ("+/A\n=", &[0xfb, 0xf0]),
            ("-_A=", &[0xfb, 0xf0]),
        ] {
            assert_eq!(data(text), Ok(Uri::Data(bytes.to_vec())), "{text}");
        }
        assert!(data("Z").is_err() && data("Zm9v!").is_err());
        assert!(read("data:text/plain,abc").is_err());
        assert!(read("data:").is_err());
    }

    #[test]
    fn paths_are_decoded_and_nothing_is_fetched() {
        let file = |text: &str| Ok(Uri::File(text.to_owned()));
        assert_eq!(read("a%20b.bin"), file("a b.bin"));
        assert_eq!(read("%C3%a4.bin"), file("ä.bin"));
        assert_eq!(read("100%.bin"), file("100%.bin"));
        assert_eq!(read("%+1.bin"), file("%+1.bin"));
        assert_eq!(read("C:/a.bin"), file("C:/a.bin"));
        assert!(read("%ff").is_err());
        for remote in ["http://a/b.bin", "file:///etc/passwd", "ftp:x"] {
            assert!(read(remote).unwrap_err().contains("nothing is fetched"));
        }
    }
}
