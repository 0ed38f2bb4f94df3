//! The lines of a text file as exporters of all ages write them.
//!
//! A line ends with LF, CR LF or CR alone. A backslash at its end joins the next
//! line, unless the line has a comment: a comment ends with its line, whatever
//! its last character. A byte order mark before a line is no part of it.

use std::borrow::Cow;

/// Why bytes are no text of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotText {
    /// Two or four bytes a character.
    #[error("the text is UTF-16 or UTF-32; save it as UTF-8 or ASCII")]
    WideCharacters,
    /// Something else altogether.
    #[error("byte {at} is 0, so this is no text; expected lines in UTF-8 or ASCII")]
    ZeroByte {
        /// Its place, from 0.
        at: usize,
    },
}

/// Lines with their numbers from 1, continued ones joined by a blank. Bytes that
/// are not UTF-8 become U+FFFD, so that comments may be in any encoding.
pub(super) fn logical_lines(
    bytes: &[u8],
) -> Result<impl Iterator<Item = (usize, Cow<'_, str>)>, NotText> {
    let mut lines = Lines {
        rest: text_of(bytes)?,
        number: 0,
    };
    Ok(std::iter::from_fn(move || {
        let first = lines.next()?;
        Some((lines.number, lines.joined(first)))
    }))
}

/// The bytes without what pads them at the end, if they are text.
fn text_of(bytes: &[u8]) -> Result<&[u8], NotText> {
    let padding = bytes.iter().rev().take_while(|b| **b == 0).count();
    let text = &bytes[..bytes.len() - padding];
    let wide = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    match text.iter().position(|b| *b == 0) {
        _ if wide => Err(NotText::WideCharacters),
        // A character of ASCII in UTF-16 or UTF-32, without a mark.
        Some(at) if at < 4 && text.len() > 4 => Err(NotText::WideCharacters),
        Some(at) => Err(NotText::ZeroByte { at }),
        None => Ok(text),
    }
}

struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    /// The next line as it is in the file.
    fn next(&mut self) -> Option<Cow<'a, str>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let (line, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest.strip_prefix(b"\r\n").or(rest.get(1..)).unwrap_or(&[]);
        self.number += 1;
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        Some(String::from_utf8_lossy(line))
    }

    /// `line` with those that it is continued by.
    fn joined(&mut self, line: Cow<'a, str>) -> Cow<'a, str> {
        let Some(start) = continued(&line) else {
            return line;
        };
        let mut joined = start.to_owned();
        while let Some(next) = self.next() {
            joined.push(' ');
            match continued(&next) {
                Some(part) => joined.push_str(part),
                None => {
                    joined.push_str(&next);
                    break;
                }
            }
        }
        Cow::Owned(joined)
    }
}

/// The line without the backslash that continues it.
fn continued(line: &str) -> Option<&str> {
    let part = line.trim_end().strip_suffix('\\')?;
    (!part.contains('#')).then_some(part)
}

/// A statement of numbers without its comment.
pub(super) fn without_comment(line: &str) -> &str {
    line.find('#').map_or(line, |at| &line[..at])
}

/// A name without the comment behind it. A name may contain the sign itself, but
/// not behind a blank, and may begin with it.
pub(super) fn name_without_comment(rest: &str) -> &str {
    let mut before = ' ';
    for (at, c) in rest.char_indices() {
        let sign = c == '#' && before.is_whitespace();
        let alone = || rest[1..].chars().next().is_none_or(char::is_whitespace);
        if sign && (at > 0 || alone()) {
            return rest[..at].trim_end();
        }
        before = c;
    }
    rest
}

/// The keyword of a statement and the rest of its line, trimmed; the rest begins
/// with the comment if there is one.
pub(super) fn keyword_and_rest(line: &str) -> Option<(&str, &str)> {
    let line = line.trim();
    let end = line.find(|c: char| c.is_whitespace() || c == '#');
    let (keyword, rest) = line.split_at(end.unwrap_or(line.len()));
    (!keyword.is_empty()).then_some((keyword, rest.trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(usize, String)> {
        let lines = logical_lines(bytes).unwrap();
        lines.map(|(n, l)| (n, l.into_owned())).collect()
    }

    fn texts(bytes: &[u8]) -> Vec<String> {
        lines(bytes).into_iter().map(|(_, l)| l).collect()
    }

    #[test]
    fn all_line_ends_are_known_and_counted() {
        for text in ["a\nb\n\nc", "a\rb\r\rc\r", "a\r\nb\r\n\r\nc\r\n"] {
            let expected = [(1, "a"), (2, "b"), (3, ""), (4, "c")];
            let expected = expected.map(|(n, l)| (n, l.to_owned()));
            assert_eq!(lines(text.as_bytes()), expected, "{text:?}");
        }
    }

    #[test]
    fn a_backslash_joins_lines_but_ends_no_comment() {
        let joined = lines(b"f 1 \\ \r\n2\\\r\n 3\nv 1");
        assert_eq!(joined, [(1, "f 1  2  3".to_owned()), (4, "v 1".to_owned())]);
        assert_eq!(texts(b"# a \\\nf 1"), ["# a \\", "f 1"]);
        assert_eq!(texts(b"f 1 \\\n2 # b \\\nf 3"), ["f 1  2 # b \\", "f 3"]);
        assert_eq!(texts(b"f 1 \\"), ["f 1 "]);
    }

    #[test]
    fn byte_order_marks_and_wide_characters_are_told_apart() {
        assert_eq!(texts("\u{feff}v 1\n\u{feff}v 2".as_bytes()), ["v 1", "v 2"]);
        let wide = [
            &b"\xff\xfev\0 \0"[..],
            b"\xfe\xff\0v\0 ",
            b"v\0 \x001\0",
            b"\0v\0 \x001",
        ];
        for bytes in wide {
            let error = logical_lines(bytes).err();
            assert_eq!(error, Some(NotText::WideCharacters), "{bytes:?}");
        }
        let zero = logical_lines(b"v 1 2 3\n\0\x01").err();
        assert_eq!(zero, Some(NotText::ZeroByte { at: 8 }));
        assert_eq!(texts(b"v 1\n\0\0\0"), ["v 1"], "padding");
    }

    #[test]
    fn comments_are_cut_off_numbers_and_names() {
        assert_eq!(without_comment("1 2 3#x"), "1 2 3");
        for (rest, name) in [
            ("red # body", "red"),
            ("red#2", "red#2"),
            ("#ff0000", "#ff0000"),
            ("#1 #2", "#1"),
            ("red\t#", "red"),
            ("# red", ""),
            ("#", ""),
        ] {
            assert_eq!(name_without_comment(rest), name);
        }
        assert_eq!(keyword_and_rest("  o\u{a0}a b "), Some(("o", "a b")));
        assert_eq!(keyword_and_rest("f#1"), Some(("f", "#1")));
        assert_eq!(keyword_and_rest("# f"), None);
        assert_eq!(keyword_and_rest(" "), None);
    }
}
