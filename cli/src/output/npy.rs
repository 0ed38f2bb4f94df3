//! NumPy's array format, version 1.0.

use gnomon_raster::MAX_TEXTURE_SIZE;

/// A two-dimensional float32 array, row by row; `size` is (width, height).
pub(crate) fn encode(size: [u32; 2], values: &[f32]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    encode_texels(size, "<f4", 1, &bytes)
}

/// The same of float64.
pub(crate) fn encode_f64(size: [u32; 2], values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    encode_texels(size, "<f8", 1, &bytes)
}

/// An array (height, width), or (height, width, channels) of several channels, of numbers
/// that NumPy calls `kind`; `bytes` are little-endian, row by row, texel by texel.
pub(crate) fn encode_texels(size: [u32; 2], kind: &str, channels: usize, bytes: &[u8]) -> Vec<u8> {
    let [width, height] = size;
    let third = match channels {
        1 => String::new(),
        n => format!(", {n}"),
    };
    let mut header = format!(
        "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}{third}), }}"
    );
    // Magic, version, length and header fill a multiple of 64 bytes.
    let unpadded = PREFIX.len() + 2 + header.len() + 1;
    header.push_str(&" ".repeat(unpadded.next_multiple_of(64) - unpadded));
    header.push('\n');
    let mut out = PREFIX.to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.as_bytes());
    out.extend(bytes);
    out
}

const PREFIX: &[u8] = b"\x93NUMPY\x01\x00";

/// An array as it was read.
pub(crate) struct Array {
    /// Width and height.
    pub(crate) size: [u32; 2],
    /// Numbers of each texel.
    pub(crate) channels: usize,
    /// Row by row, texel by texel. Numbers of 8 bits are shares of 255, as booleans are of 1.
    pub(crate) values: Vec<f64>,
}

const VALID: &str = "expected a NumPy array (height, width) or (height, width, channels) of \
    float32, float64, uint8 or bool, in C order";

/// Reads an array; the error says what is wrong.
pub(crate) fn decode(file: &[u8]) -> Result<Array, String> {
    let (header, data) = parts(file).ok_or(VALID)?;
    if !header.contains("'fortran_order': False") {
        return Err(format!("is not in C order; {VALID}"));
    }
    let kind = after(header, "'descr':").and_then(|t| t.split('\'').nth(1));
    let shape = after(header, "'shape':").and_then(|t| t.split(['(', ')']).nth(1));
    let (kind, shape) = kind.zip(shape).ok_or(VALID)?;
    let sides = shape.split(',').map(str::trim).filter(|s| !s.is_empty());
    let sides: Option<Vec<u32>> = sides.map(|s| s.parse().ok()).collect();
    let (height, width, channels) = match sides.as_deref() {
        Some(&[h, w]) => (h, w, 1),
        Some(&[h, w, c]) => (h, w, c as usize),
        _ => return Err(format!("has the shape ({shape}); {VALID}")),
    };
    let valid = 1..=MAX_TEXTURE_SIZE;
    if !valid.contains(&height) || !valid.contains(&width) || !(1..=4).contains(&channels) {
        return Err(format!(
            "has the shape ({shape}); sides are from 1 to {MAX_TEXTURE_SIZE}, channels from 1 to 4"
        ));
    }
    let read = reader(kind).ok_or_else(|| format!("is of '{kind}'; {VALID}"))?;
    let count = u128::from(height) * u128::from(width) * channels as u128;
    if count * read.bytes as u128 != data.len() as u128 {
        let had = data.len();
        return Err(format!(
            "has {had} bytes of data, and the shape ({shape}) of '{kind}'"
        ));
    }
    let mut values = Vec::new();
    if values.try_reserve_exact(count as usize).is_err() {
        return Err(format!("has {count} numbers, for which memory is short"));
    }
    values.extend(data.chunks_exact(read.bytes).map(read.value));
    let size = [width, height];
    Ok(Array {
        size,
        channels,
        values,
    })
}

fn after<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    header.split_once(key).map(|(_, rest)| rest)
}

/// Header and data.
fn parts(file: &[u8]) -> Option<(&str, &[u8])> {
    let rest = file.strip_prefix(b"\x93NUMPY")?;
    let (&major, rest) = rest.split_first()?;
    let rest = rest.get(1..)?;
    let (length, rest) = if major == 1 {
        let (length, rest) = rest.split_first_chunk::<2>()?;
        (u32::from(u16::from_le_bytes(*length)), rest)
    } else {
        let (length, rest) = rest.split_first_chunk::<4>()?;
        (u32::from_le_bytes(*length), rest)
    };
    let (header, data) = rest.split_at_checked(length as usize)?;
    Some((std::str::from_utf8(header).ok()?, data))
}

struct Reader {
    bytes: usize,
    value: fn(&[u8]) -> f64,
}

/// How numbers are read that NumPy calls `kind`.
fn reader(kind: &str) -> Option<Reader> {
    let (bytes, value): (usize, fn(&[u8]) -> f64) = match kind {
        "<f4" => (4, |b| {
            f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        }),
        ">f4" => (4, |b| {
            f64::from(f32::from_be_bytes([b[0], b[1], b[2], b[3]]))
        }),
        "<f8" => (8, |b| f64::from_le_bytes(std::array::from_fn(|k| b[k]))),
        ">f8" => (8, |b| f64::from_be_bytes(std::array::from_fn(|k| b[k]))),
        "|u1" => (1, |b| f64::from(b[0]) / 255.0),
        "|b1" => (1, |b| f64::from(u8::from(b[0] != 0))),
        _ => return None,
    };
    Some(Reader { bytes, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_read_as_they_were_written() {
        let array = decode(&encode([3, 2], &[0.0, 1.0, 2.0, 3.0, 4.5, f32::INFINITY])).unwrap();
        assert_eq!((array.size, array.channels), ([3, 2], 1));
        assert_eq!(array.values, [0.0, 1.0, 2.0, 3.0, 4.5, f64::INFINITY]);
        assert_eq!(decode(&encode_f64([1, 1], &[0.1])).unwrap().values, [0.1]);
        let bytes = decode(&encode_texels([1, 1], "|u1", 3, &[255, 0, 51])).unwrap();
        assert_eq!((bytes.channels, bytes.values), (3, vec![1.0, 0.0, 0.2]));
        let big = encode_texels([1, 1], ">f4", 1, &1.5_f32.to_be_bytes());
        assert_eq!(decode(&big).unwrap().values, [1.5]);
    }

    #[test]
    fn what_is_no_array_is_refused() {
        let good = encode([2, 2], &[0.0; 4]);
        let refused = |bytes: &[u8]| decode(bytes).err().unwrap();
        for cut in 0..good.len() {
            refused(&good[..cut]);
        }
        let with = |from: &str, to: &str| {
            let text: Vec<u8> = good.clone();
            let at = text
                .windows(from.len())
                .position(|w| w == from.as_bytes())
                .unwrap();
            [&text[..at], to.as_bytes(), &text[at + from.len()..]].concat()
        };
        assert!(refused(&with("<f4", "<i4")).contains("'<i4'"));
        assert!(refused(&with("False", "True ")).contains("C order"));
        assert!(refused(&with("(2, 2)", "(4,)  ")).contains("(4,)"));
        assert!(refused(&with("(2, 2)", "(0, 2)")).contains("from 1 to"));
        assert!(refused(&with("(2, 2)", "(2, 3)")).contains("16 bytes of data"));
    }

    #[test]
    fn header_is_aligned_and_data_follow() {
        let file = encode([3, 2], &[0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN]);
        let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
        assert_eq!((10 + length) % 64, 0);
        let header = std::str::from_utf8(&file[10..10 + length]).unwrap();
        assert!(header.contains("'shape': (2, 3)") && header.ends_with('\n'));
        assert_eq!(file.len(), 10 + length + 24);
        assert_eq!(file[10 + length + 4..][..4], 1f32.to_le_bytes());
    }

    #[test]
    fn channels_are_a_third_axis() {
        let file = encode_texels([1, 2], "|u1", 4, &[1, 2, 3, 4, 5, 6, 7, 8]);
        let text = String::from_utf8_lossy(&file);
        assert!(text.contains("'descr': '|u1'") && text.contains("'shape': (2, 1, 4)"));
        assert_eq!(file[file.len() - 8..], [1, 2, 3, 4, 5, 6, 7, 8]);
    }
}
