//! OpenEXR pictures: sizes are checked here, pixels read by the `image` crate.
//!
//! Its decoder believes what a header says: some bytes may ask for hundreds of
//! gigabytes. So the header is read once before, and sizes that the file cannot
//! hold are refused.

use std::io::Cursor;

use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use image::{ImageDecoder as _, codecs::openexr::OpenExrDecoder};

use super::{MAX_TEXELS, Read};

/// What all OpenEXR files begin with.
pub(super) const MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// Bytes that one byte of a file may stand for: the best that deflate can do is
/// 1032, and no other compression is near that for pictures with light in them.
const MOST_PER_BYTE: u64 = 2048;

/// Bytes that any file may stand for.
const ALWAYS: u64 = 1 << 20;

/// Decodes a picture that begins with [`MAGIC`]. Errors say what is wrong.
pub(super) fn decode(bytes: &[u8]) -> Result<Read, String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false);
    let meta = meta.map_err(|e| e.to_string())?;
    meta.headers
        .iter()
        .try_for_each(|h| check(h, bytes.len() as u64))?;
    let decoder = OpenExrDecoder::with_alpha_preference(Cursor::new(bytes), Some(false));
    let decoder = decoder.map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions();
    let mut raw = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut raw).map_err(|e| e.to_string())?;
    let texels = raw.as_chunks::<12>().0.iter().map(|t| {
        let channel = |k: usize| f32::from_ne_bytes([t[k], t[k + 1], t[k + 2], t[k + 3]]);
        [channel(0), channel(4), channel(8)]
    });
    Ok(Read {
        size: [width as usize, height as usize],
        texels: texels.collect(),
        warnings: Vec::new(),
    })
}

/// Whether a file of that many bytes can hold what the header says.
fn check(header: &Header, bytes: u64) -> Result<(), String> {
    let shown = header.shared_attributes.display_window.size;
    let limit = bytes.saturating_mul(MOST_PER_BYTE).saturating_add(ALWAYS);
    for (what, size) in [("picture", shown), ("data window", header.layer_size)] {
        let texels = (size.0 as u64).saturating_mul(size.1 as u64);
        if texels > MAX_TEXELS as u64 {
            return Err(format!(
                "the {what} is {}x{}; at most {MAX_TEXELS} texels are read",
                size.0, size.1
            ));
        }
        let whole = texels.saturating_mul(header.channels.bytes_per_pixel as u64);
        if whole > limit {
            return Err(format!(
                "the {what} is {}x{}, which {bytes} bytes cannot hold",
                size.0, size.1
            ));
        }
    }
    let block = block_bytes(header);
    if block > limit {
        return Err(format!(
            "its blocks are of {block} bytes, which {bytes} bytes cannot hold"
        ));
    }
    // Every block has its place in a table of eight bytes each.
    if header.chunk_count as u64 > bytes / 8 {
        return Err(format!(
            "it has {} blocks, of which {bytes} bytes cannot hold the table",
            header.chunk_count
        ));
    }
    Ok(())
}

/// Bytes of a block that is not compressed.
fn block_bytes(header: &Header) -> u64 {
    let texels = match header.blocks {
        BlockDescription::Tiles(tiles) => {
            (tiles.tile_size.0 as u64).saturating_mul(tiles.tile_size.1 as u64)
        }
        BlockDescription::ScanLines => {
            let lines = header.compression.scan_lines_per_block() as u64;
            lines.saturating_mul(header.layer_size.0 as u64)
        }
    };
    texels.saturating_mul(header.channels.bytes_per_pixel as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{Compression, Encoding, Image, SpecificChannels, Vec2, WritableImage as _};

    fn file(encoding: Encoding, size: [usize; 2]) -> Vec<u8> {
        let texel = |Vec2(x, y): Vec2<usize>| {
            let v = (1 + (x + 3 * y) % 5) as f32;
            (v, v / 2.0, v / 4.0)
        };
        let layer = exr::prelude::Layer::new(
            (size[0], size[1]),
            Default::default(),
            encoding,
            SpecificChannels::rgb(texel),
        );
        let mut bytes = Vec::new();
        let image = Image::from_layer(layer);
        image.write().to_buffered(Cursor::new(&mut bytes)).unwrap();
        bytes
    }

    #[test]
    fn every_compression_is_read() {
        let lossless = [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP1,
            Compression::ZIP16,
            Compression::PIZ,
            Compression::PXR24,
        ];
        let lossy = [
            Compression::B44,
            Compression::B44A,
            Compression::DWAA(None),
            Compression::DWAB(None),
        ];
        let with = |compression| {
            let encoding = Encoding {
                compression,
                ..Encoding::UNCOMPRESSED
            };
            decode(&file(encoding, [64, 32])).unwrap_or_else(|e| panic!("{compression}: {e}"))
        };
        let plain = with(Compression::Uncompressed);
        assert_eq!((plain.size, plain.texels[65]), ([64, 32], [5.0, 2.5, 1.25]));
        for compression in lossless {
            assert_eq!(with(compression).texels, plain.texels, "{compression}");
        }
        for compression in lossy {
            for (a, b) in with(compression).texels.iter().zip(&plain.texels) {
                (0..3).for_each(|c| {
                    assert!(
                        (a[c] - b[c]).abs() < 0.1 * b[c],
                        "{compression}: {a:?} {b:?}"
                    )
                });
            }
        }
        let flat = Encoding {
            compression: Compression::ZIP16,
            ..Encoding::UNCOMPRESSED
        };
        assert_eq!(
            decode(&file(flat, [1024, 512])).unwrap().texels.len(),
            1024 * 512
        );
    }

    #[test]
    fn sizes_that_a_file_cannot_hold_are_refused() {
        let bytes = file(Encoding::UNCOMPRESSED, [64, 32]);
        let window = |name: &[u8]| {
            let at = bytes.windows(name.len()).position(|w| w == name).unwrap();
            at + name.len() + b"box2i\0".len() + 4
        };
        for name in [&b"dataWindow\0"[..], b"displayWindow\0"] {
            // The last column, then the last row.
            for (at, value) in [
                (8, 0x0fff_ffff_u32),
                (12, 0x0fff_ffff),
                (8, 500_000),
                (12, 2_000_000),
            ] {
                let mut bytes = bytes.clone();
                let at = window(name) + at;
                bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
                let error = decode(&bytes).unwrap_err();
                assert!(
                    error.contains("cannot hold") || error.contains("at most"),
                    "{error}"
                );
            }
        }
    }
}
