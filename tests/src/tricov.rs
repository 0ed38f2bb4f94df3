//! Reader of TRICOV1: which pixels another rasteriser covered, triangle by triangle.

use std::fmt;

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TricovError {
    /// It does not begin with the format's name.
    Magic,
    /// It ends too early.
    Truncated {
        /// What was being read.
        what: &'static str,
        /// Where, in bytes.
        at: usize,
        /// Bytes that are needed there.
        needed: usize,
        /// Length of the file.
        length: usize,
    },
    /// A span is not inside the image.
    Span {
        /// Number of the triangle.
        triangle: usize,
        /// Row, first column, one past the last column.
        span: [u8; 3],
    },
}

impl fmt::Display for TricovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Magic => write!(f, "not a TRICOV1 file: it must begin with \"TRICOV1\\0\""),
            Self::Truncated {
                what,
                at,
                needed,
                length,
            } => {
                write!(
                    f,
                    "{what} at byte {at} needs {needed} bytes; the file has {length}"
                )
            }
            Self::Span { triangle, span } => write!(
                f,
                "triangle {triangle}: span {span:?} is not inside the image"
            ),
        }
    }
}

impl std::error::Error for TricovError {}

/// One triangle and its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct CoveredTriangle {
    /// Corners in pixels, relative to the origin.
    pub corners: [[f32; 2]; 3],
    /// Index into [`crate::lcg::CLASSES`].
    pub class: u8,
    /// Row by row.
    pub covered: Vec<bool>,
}

/// A whole file.
#[derive(Clone, Debug, PartialEq)]
pub struct Tricov {
    /// The rasteriser.
    pub name: String,
    /// Width of the window in pixels.
    pub width: u32,
    /// Height of the window in pixels.
    pub height: u32,
    /// The window's column and row in the target.
    pub origin: u32,
    /// In order.
    pub triangles: Vec<CoveredTriangle>,
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize, what: &'static str) -> Result<&'a [u8], TricovError> {
        let length = self.bytes.len();
        let error = TricovError::Truncated {
            what,
            at: self.at,
            needed: n,
            length,
        };
        let end = self
            .at
            .checked_add(n)
            .filter(|&e| e <= length)
            .ok_or(error)?;
        let slice = &self.bytes[self.at..end];
        self.at = end;
        Ok(slice)
    }

    fn u32(&mut self, what: &'static str) -> Result<u32, TricovError> {
        let b = self.take(4, what)?;
        Ok(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    }
}

impl Tricov {
    /// Reads a file's bytes.
    ///
    /// # Errors
    /// Where they are not TRICOV1, end early, or name pixels outside the image.
    pub fn parse(bytes: &[u8]) -> Result<Self, TricovError> {
        let mut r = Reader { bytes, at: 0 };
        if r.take(8, "magic")? != b"TRICOV1\0" {
            return Err(TricovError::Magic);
        }
        let count = r.u32("count")?;
        let (width, height, origin) = (r.u32("width")?, r.u32("height")?, r.u32("origin")?);
        let length = r.u32("name length")? as usize;
        let name = String::from_utf8_lossy(r.take(length, "name")?).into_owned();
        let mut file = Self {
            name,
            width,
            height,
            origin,
            triangles: Vec::new(),
        };
        for i in 0..count as usize {
            let t = file.triangle(&mut r, i)?;
            file.triangles.push(t);
        }
        Ok(file)
    }

    fn triangle(&self, r: &mut Reader<'_>, number: usize) -> Result<CoveredTriangle, TricovError> {
        let mut corners = [[0.0; 2]; 3];
        for c in corners.iter_mut().flatten() {
            *c = f32::from_bits(r.u32("corner")?);
        }
        let class = r.take(1, "class")?[0];
        let spans = r.take(2, "span count")?;
        let spans = usize::from(u16::from_le_bytes([spans[0], spans[1]]));
        let mut covered = vec![false; self.width as usize * self.height as usize];
        for s in r.take(3 * spans, "spans")?.chunks_exact(3) {
            let [y, x0, x1] = [s[0], s[1], s[2]].map(usize::from);
            if x0 > x1 || x1 > self.width as usize || y >= self.height as usize {
                return Err(TricovError::Span {
                    triangle: number,
                    span: [s[0], s[1], s[2]],
                });
            }
            let row = y * self.width as usize;
            covered[row + x0..row + x1].fill(true);
        }
        Ok(CoveredTriangle {
            corners,
            class,
            covered,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A 4×2 window with one triangle: row 0 columns 1..3, row 1 column 0.
    fn small() -> Vec<u8> {
        let mut b = b"TRICOV1\0".to_vec();
        for v in [1u32, 4, 2, 16, 2] {
            b.extend(v.to_le_bytes());
        }
        b.extend(b"me");
        for v in [0.5f32, 1.0, 2.0, 3.5, -1.0, 0.25] {
            b.extend(v.to_le_bytes());
        }
        b.push(6);
        b.extend(2u16.to_le_bytes());
        b.extend([0, 1, 3, 1, 0, 1]);
        b
    }

    #[test]
    fn a_small_file_is_read() {
        let f = Tricov::parse(&small()).unwrap();
        assert_eq!(
            (f.name.as_str(), f.width, f.height, f.origin),
            ("me", 4, 2, 16)
        );
        let t = &f.triangles[0];
        assert_eq!(
            (t.corners, t.class),
            ([[0.5, 1.0], [2.0, 3.5], [-1.0, 0.25]], 6)
        );
        assert_eq!(
            t.covered,
            [false, true, true, false, true, false, false, false]
        );
    }

    #[test]
    fn every_truncation_is_refused() {
        let whole = small();
        for n in 0..whole.len() {
            let e = Tricov::parse(&whole[..n]).unwrap_err();
            assert!(
                matches!(e, TricovError::Truncated { length, .. } if length == n),
                "{n}: {e}"
            );
        }
    }

    #[test]
    fn other_files_and_spans_outside_are_refused() {
        assert_eq!(Tricov::parse(b"TRICOV2\0????"), Err(TricovError::Magic));
        let mut bad = small();
        let n = bad.len();
        bad[n - 1] = 5;
        assert_eq!(
            Tricov::parse(&bad),
            Err(TricovError::Span {
                triangle: 0,
                span: [1, 0, 5]
            })
        );
        let endless = [&b"TRICOV1\0"[..], &[255; 20]].concat();
        assert!(matches!(
            Tricov::parse(&endless),
            Err(TricovError::Truncated { what: "name", .. })
        ));
    }
}
