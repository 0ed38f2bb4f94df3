//! The header: what elements there are, and what each is made of.

use super::error::PlyProblem;
use crate::world::tally::{Tally, beginning};

/// Bytes of a header that are looked through at most.
const MAX_HEADER: usize = 1 << 20;

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a value.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One property of an element.
#[derive(Debug, PartialEq)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the length, if it is a list.
    pub(super) list: Option<Scalar>,
    pub(super) scalar: Scalar,
}

impl Property {
    /// Bytes that it has at least.
    fn least_bytes(&self) -> usize {
        self.list.unwrap_or(self.scalar).bytes()
    }
}

/// One element.
#[derive(Debug, PartialEq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Bytes of the data that one has at least.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> usize {
        match encoding {
            // A digit and a blank each.
            Encoding::Ascii => 2 * self.properties.len(),
            _ => self.properties.iter().map(Property::least_bytes).sum(),
        }
    }

    fn is_drawn(&self) -> bool {
        matches!(self.name.as_str(), "vertex" | "face" | "tristrips")
    }
}

/// What a file declares.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

impl Header {
    /// Reads the header of `bytes`; also returns what is behind it.
    pub(super) fn of(bytes: &[u8]) -> Result<(Self, &[u8]), PlyProblem> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut lines = Lines { rest: bytes };
        let first = lines.next().unwrap_or_default();
        if first.trim() != "ply" {
            return Err(PlyProblem::NoPly {
                beginning: beginning(first.trim(), 20),
            });
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        for number in 2.. {
            let searched = bytes.len() - lines.rest.len();
            let line = lines.next().filter(|_| searched <= MAX_HEADER);
            let line = line.ok_or(PlyProblem::NoEnd { searched })?;
            let bad = |expected| PlyProblem::BadHeader {
                line: number,
                text: beginning(line.trim(), 80),
                expected,
            };
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["end_header", ..] => break,
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, version] => {
                    encoding = Some(format(name, version).map_err(bad)?);
                }
                ["element", name, count] => elements.push(element(name, count).map_err(bad)?),
                ["property", ref rest @ ..] => {
                    let last = elements.last_mut();
                    let element: &mut Element =
                        last.ok_or_else(|| bad("'element NAME COUNT' before its properties"))?;
                    element.properties.push(property(rest).map_err(bad)?);
                }
                _ => {
                    return Err(bad(
                        "format, element, property, comment, obj_info or end_header",
                    ));
                }
            }
        }
        let encoding = encoding.ok_or(PlyProblem::Lacks {
            missing: "the header has no line 'format'",
            expected: "'format ascii 1.0', 'format binary_little_endian 1.0' or 'format binary_big_endian 1.0'",
        })?;
        Ok((Self { encoding, elements }, lines.rest))
    }

    /// Elements that are stepped over.
    pub(super) fn ignored(&self) -> Tally {
        let mut tally = Tally::default();
        for element in self
            .elements
            .iter()
            .filter(|e| !e.is_drawn() && e.count > 0)
        {
            let count = usize::try_from(element.count).unwrap_or(usize::MAX);
            tally.add_many(count, || format!("'{}'", element.name));
        }
        tally
    }

    /// Elements that have colours.
    pub(super) fn colours(&self) -> Tally {
        let mut tally = Tally::default();
        for element in self.elements.iter().filter(|e| e.is_drawn() && e.count > 0) {
            let red = |p: &&Property| matches!(p.name.as_str(), "red" | "diffuse_red");
            if let Some(red) = element.properties.iter().find(red) {
                tally.add(|| format!("'{}' of '{}'", red.name, element.name));
            }
        }
        tally
    }
}

fn format(name: &str, version: &str) -> Result<Encoding, &'static str> {
    if version != "1.0" {
        return Err("version 1.0, the only one there is");
    }
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => Err("ascii, binary_little_endian or binary_big_endian"),
    }
}

fn element(name: &str, count: &str) -> Result<Element, &'static str> {
    Ok(Element {
        name: name.to_owned(),
        count: count.parse().map_err(|_| "'element NAME COUNT'")?,
        properties: Vec::new(),
    })
}

fn property(words: &[&str]) -> Result<Property, &'static str> {
    const TYPES: &str = "'property TYPE NAME' or 'property list TYPE TYPE NAME' with the types char, uchar, short, ushort, int, uint, float, double or int8 to float64";
    let (list, scalar, name) = match words {
        ["list", length, scalar, name] => (Some(Scalar::of(length).ok_or(TYPES)?), scalar, name),
        [scalar, name] => (None, scalar, name),
        _ => return Err(TYPES),
    };
    Ok(Property {
        name: (*name).to_owned(),
        list,
        scalar: Scalar::of(scalar).ok_or(TYPES)?,
    })
}

/// Lines that end with LF, CR LF or CR alone. Bytes that are not UTF-8 become U+FFFD, so
/// that comments may be in any encoding.
struct Lines<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Lines<'a> {
    type Item = std::borrow::Cow<'a, str>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let ends = |b: &u8| matches!(b, b'\n' | b'\r');
        let end = (self.rest.iter().position(ends)).unwrap_or(self.rest.len());
        let (line, after) = self.rest.split_at(end);
        let end = if after.starts_with(b"\r\n") { 2 } else { 1 };
        self.rest = after.get(end..).unwrap_or_default();
        Some(String::from_utf8_lossy(line))
    }
}
