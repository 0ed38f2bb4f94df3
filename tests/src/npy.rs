//! Reader of NumPy's .npy files, as far as the peers' stencil images need it:
//! unsigned bytes, two dimensions, row by row.

/// An image of bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ByteImage {
    /// Rows.
    pub height: usize,
    /// Columns.
    pub width: usize,
    /// Row by row.
    pub pixels: Vec<u8>,
}

impl ByteImage {
    /// Reads a file's bytes.
    ///
    /// # Errors
    /// What is not as expected, in words.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        if bytes.get(..6) != Some(b"\x93NUMPY".as_slice()) {
            return Err("not an .npy file: it must begin with \\x93NUMPY".into());
        }
        let field = |range| {
            bytes
                .get::<std::ops::Range<usize>>(range)
                .ok_or_else(|| format!("{} bytes are too few for a header", bytes.len()))
        };
        // Version 1 has two bytes of header length, later ones four.
        let start = if field(6..7)?[0] == 1 { 10 } else { 12 };
        let length = field(8..start)?
            .iter()
            .rev()
            .fold(0, |n, b| n << 8 | usize::from(*b));
        let header = String::from_utf8_lossy(field(start..start.saturating_add(length))?);
        if !header.contains("'|u1'") || !header.contains("'fortran_order': False") {
            return Err(format!(
                "unsigned bytes row by row are needed, not {header}"
            ));
        }
        let (height, width) = shape(&header).ok_or_else(|| format!("no (h, w) in {header}"))?;
        let pixels = bytes[start + length..].to_vec();
        if height.checked_mul(width) != Some(pixels.len()) {
            return Err(format!("{height} x {width} is not {} bytes", pixels.len()));
        }
        Ok(Self {
            height,
            width,
            pixels,
        })
    }
}

/// The two numbers of `'shape': (h, w)`.
fn shape(header: &str) -> Option<(usize, usize)> {
    let (_, rest) = header.split_once("'shape': (")?;
    let (inner, _) = rest.split_once(')')?;
    let (h, w) = inner.split_once(',')?;
    Some((h.trim().parse().ok()?, w.trim().parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn bytes_are_read_and_other_things_refused() {
        let good = "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }\n";
        let image = ByteImage::parse(&file(good, &[1, 2, 3, 4, 5, 6])).unwrap();
        assert_eq!((image.height, image.width), (2, 3));
        assert_eq!(image.pixels, [1, 2, 3, 4, 5, 6]);
        assert!(ByteImage::parse(&file(good, &[1, 2])).is_err());
        assert!(ByteImage::parse(b"\x93NUMPY\x01\x00\xff\xff").is_err());
        assert!(ByteImage::parse(b"PNG").is_err());
        let floats = good.replace("|u1", "<f4");
        assert!(ByteImage::parse(&file(&floats, &[0; 24])).is_err());
        let flat = good.replace("(2, 3)", "(6,)");
        assert!(ByteImage::parse(&file(&flat, &[0; 6])).is_err());
    }
}
