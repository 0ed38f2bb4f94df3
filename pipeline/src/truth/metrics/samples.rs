//! Pictures for the tests of picture metrics.

/// Size of the pictures.
pub(super) const SIZE: [u32; 2] = [40, 30];

/// A reference with slopes, a fine pattern and blocks, and two changed ones:
/// slightly noisy, and with channels replaced.
pub(super) fn pictures() -> [Vec<u8>; 3] {
    let pixel = |i: u32| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let reference = [
            (x * 6 + y) % 256,
            (x * x + 3 * y) % 251,
            ((x / 5 + y / 7) % 2) * 180 + 30,
        ];
        let noise = ((x * 31 + y * 17) % 13) as i32 - 6;
        let noisy = reference.map(|v| (v as i32 + noise).clamp(0, 255) as u32);
        let replaced = [reference[0], 128, 255 - reference[2]];
        [reference, noisy, replaced]
    };
    [0, 1, 2].map(|which: usize| {
        let bytes = (0..SIZE[0] * SIZE[1]).flat_map(|i| pixel(i)[which]);
        bytes.map(|v| v as u8).collect()
    })
}
