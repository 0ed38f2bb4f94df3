//! NumPy's array format, version 1.0.

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

#[cfg(test)]
mod tests {
    use super::*;

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
