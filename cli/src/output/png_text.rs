//! What a PNG says of itself: texts in chunks of their own (PNG 1.2, §4.2.3.1), behind the
//! header. They depend on what is drawn alone, so that equal pictures are equal files.

/// Keywords and texts.
pub(crate) type About = Vec<(&'static str, String)>;

/// Signature and header of a file.
const HEAD: usize = 8 + 25;

/// The program, as every picture names it.
pub(crate) fn software() -> (&'static str, String) {
    ("Software", format!("gnomon {}", env!("CARGO_PKG_VERSION")))
}

/// The file with its texts. What Latin-1 has not is written as Rust does, `\u{…}`.
pub(crate) fn with_text(png: &[u8], about: &About) -> Vec<u8> {
    let (head, rest) = png.split_at(HEAD.min(png.len()));
    let chunks = about
        .iter()
        .flat_map(|(keyword, text)| chunk(keyword, text));
    head.iter()
        .copied()
        .chain(chunks)
        .chain(rest.iter().copied())
        .collect()
}

fn chunk(keyword: &str, text: &str) -> Vec<u8> {
    let escape = |c: char| match c.is_ascii() && !c.is_ascii_control() {
        true => c.to_string(),
        false => c.escape_unicode().to_string(),
    };
    let text: String = text.chars().map(escape).collect();
    let mut body = b"tEXt".to_vec();
    body.extend(keyword.as_bytes());
    body.push(0);
    body.extend(text.as_bytes());
    let length = body.len() as u32 - 4;
    let check = crc(&body);
    [&length.to_be_bytes()[..], &body, &check.to_be_bytes()].concat()
}

/// The cyclic redundancy check of PNG (its §3.4).
fn crc(bytes: &[u8]) -> u32 {
    let step = |c: u32| match c & 1 {
        0 => c >> 1,
        _ => 0xedb8_8320 ^ (c >> 1),
    };
    let byte = |c: u32, b: &u8| (0..8).fold(c ^ u32::from(*b), |c, _| step(c));
    !bytes.iter().fold(u32::MAX, byte)
}

/// The texts of a file, in order.
#[cfg(test)]
pub(crate) fn texts(png: &[u8]) -> Vec<(String, String)> {
    let (mut at, mut found) = (8, Vec::new());
    while at + 12 <= png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        let body = &png[at + 4..at + 8 + length];
        let check = u32::from_be_bytes(png[at + 8 + length..at + 12 + length].try_into().unwrap());
        assert_eq!(crc(body), check);
        if body.starts_with(b"tEXt") {
            let text = String::from_utf8_lossy(&body[4..]).into_owned();
            let (keyword, text) = text.split_once('\0').unwrap();
            found.push((keyword.to_owned(), text.to_owned()));
        }
        at += 12 + length;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Picture;
    use crate::output::png::encode;

    #[test]
    fn texts_are_read_back_and_the_picture_stays() {
        let picture = Picture {
            size: [3, 2],
            pixels: vec![[9, 8, 7, 255]; 6],
        };
        let plain = encode(&picture);
        let about = vec![software(), ("Scene", "a\nb é".to_owned())];
        let told = with_text(&plain, &about);
        assert!(texts(&plain).is_empty());
        let found = texts(&told);
        assert_eq!(found[0].0, "Software");
        assert!(found[0].1.starts_with("gnomon "));
        assert_eq!(found[1], ("Scene".to_owned(), r"a\u{a}b \u{e9}".to_owned()));
        let read = |bytes: &[u8]| image::load_from_memory(bytes).unwrap().to_rgba8();
        assert_eq!(read(&plain), read(&told));
        // Of the standard's own example, an empty last chunk.
        assert_eq!(crc(b"IEND"), 0xae42_6082);
    }
}
