//! Radiance pictures: the header is read here, the pixels by the `image` crate.
//!
//! That crate knows one of the first lines that are in use and one of the eight
//! orders of pixels, and leaves EXPOSURE and COLORCORR to its user. It gets a plain
//! header and the pixels of the file, which are walked through first: so nothing is
//! allocated for pixels that the file does not have.
//!
//! Source: G. Ward, "Radiance File Formats", picture files.

use image::ImageDecoder as _;
use image::codecs::hdr::HdrDecoder;

use super::{MAX_TEXELS, Read};
use crate::world::warning::SceneWarning;

/// What all Radiance pictures begin with; the program's name follows.
pub(super) const MAGIC: &[u8] = b"#?";

/// Lines of a header, and bytes of one, at most.
const MOST_LINES: usize = 10_000;

/// Decodes a picture that begins with [`MAGIC`]. Errors say what is wrong.
pub(super) fn decode(bytes: &[u8]) -> Result<Read, String> {
    let (header, pixels) = Header::of(bytes)?;
    check_pixels(pixels, header.length, header.lines)?;
    let plain = format!(
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
        header.lines, header.length
    );
    let both = std::io::Read::chain(plain.as_bytes(), pixels);
    let decoder = HdrDecoder::new(both).map_err(|e| e.to_string())?;
    let mut raw = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut raw).map_err(|e| e.to_string())?;
    let texels = raw.as_chunks::<12>().0.iter().map(|t| {
        let channel = |k: usize| f32::from_ne_bytes([t[k], t[k + 1], t[k + 2], t[k + 3]]);
        [channel(0), channel(4), channel(8)]
    });
    Ok(header.finish(texels.collect()))
}

/// What a header says.
#[derive(Debug)]
struct Header {
    /// Scanlines, and texels in each.
    lines: usize,
    length: usize,
    /// Whether scanlines are columns, and which axes run backwards.
    columns: bool,
    backwards: [bool; 2],
    /// What radiance was multiplied by.
    factor: [f64; 3],
    /// The first of the lines that say something that is not used.
    unused: Vec<String>,
}

impl Header {
    /// The header, and what follows it.
    fn of(bytes: &[u8]) -> Result<(Self, &[u8]), String> {
        let mut header = Self {
            lines: 0,
            length: 0,
            columns: false,
            backwards: [false; 2],
            factor: [1.0; 3],
            unused: Vec::new(),
        };
        let mut rest = bytes;
        let mut next = || -> Result<String, String> {
            let end = rest.iter().position(|b| *b == b'\n');
            let end = end.ok_or("the header has no end")?;
            let line = String::from_utf8_lossy(&rest[..end]).trim().to_owned();
            rest = &rest[end + 1..];
            Ok(line)
        };
        next()?;
        for _ in 0..MOST_LINES {
            let line = next()?;
            if line.is_empty() {
                header.resolution(&next()?)?;
                return Ok((header, rest));
            }
            header.line(&line)?;
        }
        Err(format!("the header has more than {MOST_LINES} lines"))
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        let Some((key, value)) = line.split_once('=').filter(|_| !line.starts_with('#')) else {
            return Ok(()); // a comment, or the command that made the picture
        };
        let value = value.trim();
        match key.trim() {
            "FORMAT" if value == "32-bit_rle_rgbe" => {}
            "FORMAT" => {
                return Err(format!(
                    "FORMAT is '{value}'; only 32-bit_rle_rgbe can be read"
                ));
            }
            "EXPOSURE" => {
                let [factor] = factors(line, value)?;
                self.factor = self.factor.map(|f| f * factor);
            }
            "COLORCORR" => {
                let factors: [f64; 3] = factors(line, value)?;
                (0..3).for_each(|c| self.factor[c] *= factors[c]);
            }
            "PRIMARIES" | "GAMMA" => self.unused.push(line.to_owned()),
            "PIXASPECT" if value.parse() != Ok(1.0) => self.unused.push(line.to_owned()),
            _ => {}
        }
        Ok(())
    }

    /// `-Y height +X width`, or any other order and direction of the axes.
    fn resolution(&mut self, line: &str) -> Result<(), String> {
        let bad = || format!("the resolution is '{line}'; expected such as '-Y 512 +X 1024'");
        let words: Vec<&str> = line.split_whitespace().collect();
        let &[slow, lines, fast, length] = &words[..] else {
            return Err(bad());
        };
        let number = |w: &str| w.parse::<usize>().ok().filter(|n| *n > 0).ok_or_else(bad);
        (self.lines, self.length) = (number(lines)?, number(length)?);
        self.columns = match (slow, fast) {
            ("-Y" | "+Y", "-X" | "+X") => false,
            ("-X" | "+X", "-Y" | "+Y") => true,
            _ => return Err(bad()),
        };
        let axes = if self.columns {
            [fast, slow]
        } else {
            [slow, fast]
        };
        self.backwards = [axes[0] == "+Y", axes[1] == "-X"];
        match self.lines.checked_mul(self.length) {
            Some(texels) if texels <= MAX_TEXELS => Ok(()),
            _ => Err(format!(
                "the picture is {}x{}; at most {MAX_TEXELS} texels are read",
                self.length, self.lines
            )),
        }
    }

    /// Texels in rows from the top, as radiance.
    fn finish(self, texels: Vec<[f32; 3]>) -> Read {
        let [width, height] = if self.columns {
            [self.lines, self.length]
        } else {
            [self.length, self.lines]
        };
        let scaled = |rgb: [f32; 3]| match self.factor {
            [1.0, 1.0, 1.0] => rgb,
            factor => [0, 1, 2].map(|c| (f64::from(rgb[c]) / factor[c]) as f32),
        };
        let [up, left] = self.backwards;
        let texel = |x: usize, y: usize| {
            let x = if left { width - 1 - x } else { x };
            let y = if up { height - 1 - y } else { y };
            let at = if self.columns {
                x * height + y
            } else {
                y * width + x
            };
            scaled(texels[at])
        };
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let warnings = self.unused.first().map(|first| SceneWarning {
            code: "ignored-header",
            count: self.unused.len(),
            message: format!("lines of the map's header are not used (first: {first})"),
        });
        Read {
            size: [width, height],
            texels: rows.map(|(x, y)| texel(x, y)).collect(),
            warnings: warnings.into_iter().collect(),
        }
    }
}

/// `N` numbers above 0.
fn factors<const N: usize>(line: &str, value: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = value.split_whitespace().map(str::parse).collect();
    let valid = |v: &f64| *v > 0.0 && v.is_finite();
    let numbers = numbers.ok().filter(|n| n.iter().all(valid));
    let numbers = numbers.and_then(|n| <[f64; N]>::try_from(n).ok());
    numbers.ok_or_else(|| format!("the header has '{line}'; valid are {N} numbers above 0"))
}

/// Walks through the scanlines, so that a file that is too short, or that is of no
/// such pixels, is found out before anything is made of it.
fn check_pixels(mut bytes: &[u8], length: usize, lines: usize) -> Result<(), String> {
    for line in 0..lines {
        let at = |e: &str| format!("scanline {} of {lines} {e}", line + 1);
        bytes = scanline(bytes, length).map_err(at)?;
    }
    Ok(())
}

const SHORT: &str = "ends before its time: the file is cut off";

/// What follows a scanline.
fn scanline(bytes: &[u8], length: usize) -> Result<&[u8], &'static str> {
    let (first, rest) = bytes.split_at_checked(4).ok_or(SHORT)?;
    if first[0] == 2 && first[1] == 2 && first[2] < 128 {
        (0..4).try_fold(rest, |rest, _| component(rest, length))
    } else {
        old_runs(bytes, length)
    }
}

/// Counts below 128 of bytes as they are, above of one byte repeated.
fn component(mut bytes: &[u8], length: usize) -> Result<&[u8], &'static str> {
    let mut texels = 0;
    while texels < length {
        let (count, rest) = bytes.split_first().ok_or(SHORT)?;
        let (count, run) = (usize::from(*count), *count > 128);
        let taken = if run { 1 } else { count };
        bytes = rest.get(taken..).ok_or(SHORT)?;
        if count == 0 {
            return Err("has a run of no texels");
        }
        texels += if run { count - 128 } else { count };
    }
    (texels == length).then_some(bytes).ok_or("is too long")
}

/// Texels of four bytes; 1, 1, 1, n repeats the one before, n growing by a factor of
/// 256 for each such in a row.
fn old_runs(mut bytes: &[u8], length: usize) -> Result<&[u8], &'static str> {
    let (mut texels, mut in_a_row) = (0, 0);
    while texels < length {
        let (texel, rest) = bytes.split_at_checked(4).ok_or(SHORT)?;
        bytes = rest;
        if texel[..3] == [1; 3] {
            if texels == 0 || in_a_row == 4 {
                return Err("has a run of no texel");
            }
            texels += usize::from(texel[3]) << (8 * in_a_row);
            in_a_row += 1;
        } else {
            (texels, in_a_row) = (texels + 1, 0);
        }
    }
    (texels == length).then_some(bytes).ok_or("is too long")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three texels by two, uncompressed, mantissas 0 to 5 and more.
    fn picture(first: &str, header: &str, resolution: &str) -> Vec<u8> {
        let mut bytes = format!("{first}\n{header}\n\n{resolution}\n").into_bytes();
        bytes.extend((0..6u8).flat_map(|i| [64 + i, 32, 16, 129]));
        bytes
    }

    fn read(header: &str, resolution: &str) -> Result<Read, String> {
        decode(&picture("#?RADIANCE", header, resolution))
    }

    const FORMAT: &str = "FORMAT=32-bit_rle_rgbe";

    #[test]
    fn exposure_and_colour_correction_are_taken_back() {
        let plain = read(FORMAT, "-Y 2 +X 3").unwrap();
        assert_eq!(plain.texels[1], [65.0 / 128.0, 0.25, 0.125]);
        let header =
            format!("EXPOSURE=4\n{FORMAT}\nEXPOSURE= 0.5\r\nCOLORCORR=1 2 4\r\nCOLORCORR=1 1 0.5");
        let read = read(&header, "-Y 2 +X 3").unwrap();
        for (a, b) in plain.texels.iter().zip(&read.texels) {
            assert_eq!([a[0] / 2.0, a[1] / 4.0, a[2] / 4.0], *b);
        }
        assert_eq!((plain.warnings, read.warnings), (vec![], vec![]));
    }

    #[test]
    fn all_first_lines_and_line_ends_are_known() {
        let plain = read(FORMAT, "-Y 2 +X 3").unwrap().texels;
        for first in ["#?RGBE", "#?AUTOPANO", "#?RADIANCE\r", "#?"] {
            let bytes = picture(first, &format!("# by hand\r\n{FORMAT}\r"), "-Y 2 +X 3\r");
            assert_eq!(decode(&bytes).unwrap().texels, plain, "{first}");
        }
    }

    #[test]
    fn every_order_of_texels_gives_the_same_picture() {
        let reds = |resolution: &str| {
            let read = read(FORMAT, resolution).unwrap();
            let red = |t: &[f32; 3]| (t[0] * 128.0) as u8 - 64;
            (read.size, read.texels.iter().map(red).collect::<Vec<_>>())
        };
        let wide = [3, 2];
        assert_eq!(reds("-Y 2 +X 3"), (wide, vec![0, 1, 2, 3, 4, 5]));
        assert_eq!(reds("+Y 2 +X 3"), (wide, vec![3, 4, 5, 0, 1, 2]));
        assert_eq!(reds("-Y 2 -X 3"), (wide, vec![2, 1, 0, 5, 4, 3]));
        assert_eq!(reds("+Y 2 -X 3"), (wide, vec![5, 4, 3, 2, 1, 0]));
        assert_eq!(reds("+X 3 -Y 2"), (wide, vec![0, 2, 4, 1, 3, 5]));
        assert_eq!(reds("-X 3 -Y 2"), (wide, vec![4, 2, 0, 5, 3, 1]));
        assert_eq!(reds("+X 3 +Y 2"), (wide, vec![1, 3, 5, 0, 2, 4]));
        assert_eq!(reds("-X 3 +Y 2"), (wide, vec![5, 3, 1, 4, 2, 0]));
    }

    #[test]
    fn what_is_not_used_is_said() {
        let read = read(
            &format!("{FORMAT}\nPRIMARIES=1 2 3 4 5 6 7 8\nPIXASPECT=1.0\nGAMMA=2.2\nVIEW= -vtv"),
            "-Y 2 +X 3",
        );
        let warnings = read.unwrap().warnings;
        assert_eq!((warnings[0].code, warnings[0].count), ("ignored-header", 2));
        assert!(warnings[0].message.contains("PRIMARIES=1 2"));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let message = |header: &str, resolution| match read(header, resolution) {
            Err(message) => message,
            Ok(read) => panic!("{read:?}"),
        };
        let with = |line: &str| message(&format!("{FORMAT}\n{line}"), "-Y 2 +X 3");
        for line in [
            "EXPOSURE=0",
            "EXPOSURE=x",
            "EXPOSURE=1 2",
            "COLORCORR=1 2",
            "COLORCORR=1 -1 1",
        ] {
            assert!(with(line).contains(line), "{}", with(line));
        }
        assert!(message("FORMAT=32-bit_rle_xyze", "-Y 2 +X 3").contains("xyze"));
        for resolution in ["-Y 2", "-Y 0 +X 3", "-Y 2 +Y 3", "2 3", "-Y -2 +X 3"] {
            assert!(message(FORMAT, resolution).contains(resolution));
        }
        assert!(message(FORMAT, "-Y 100000 +X 100000").contains("at most"));
        assert!(message(FORMAT, "-Y 3 +X 3").contains("scanline 3 of 3 ends"));
        assert!(
            decode(b"#?RADIANCE\nFORMAT=")
                .unwrap_err()
                .contains("no end")
        );
    }

    #[test]
    fn runs_are_walked_as_they_are_decoded() {
        let header = format!("#?RADIANCE\n{FORMAT}\n\n-Y 1 +X 300\n").into_bytes();
        let read = |pixels: &[u8]| decode(&[&header[..], pixels].concat());
        let run = |n: u8, v: u8| [128 + n, v];
        let channel = |v: u8| [run(127, v), run(127, v), run(46, v)].concat();
        let new = [
            &[2, 2, 1, 44][..],
            &channel(64),
            &channel(32),
            &channel(16),
            &channel(129),
        ];
        assert_eq!(
            read(&new.concat()).unwrap().texels,
            [[0.5, 0.25, 0.125]; 300]
        );
        let old = [64, 32, 16, 129, 1, 1, 1, 43, 1, 1, 1, 1];
        assert_eq!(read(&old).unwrap().texels, [[0.5, 0.25, 0.125]; 300]);
        let mut markers = vec![64, 32, 16, 129];
        markers.extend([1, 1, 1, 0].repeat(9));
        assert!(read(&markers).is_err());
        assert!(read(&[&new.concat()[..20], &[255; 40]].concat()).is_err());
    }
}
