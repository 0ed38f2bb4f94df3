//! Colour spaces of FLIP: linear sRGB, the linear opponent space YCxCz, CIELAB.

/// Three channels.
pub(super) type Rgb = [f64; 3];

/// XYZ of linear sRGB, from the chromaticities of IEC 61966-2-1 with white
/// (0.3127, 0.3290): rows X, Y, Z.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];

/// Linear light of an sRGB value in 0..=1.
pub(super) fn srgb_decode(value: f64) -> f64 {
    if value <= 0.040_45 {
        value / 12.92
    } else {
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

/// XYZ relative to white.
fn relative_xyz(rgb: Rgb) -> [f64; 3] {
    XYZ_FROM_RGB.map(|row| {
        let white = row[0] + row[1] + row[2];
        (row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]) / white
    })
}

/// YCxCz of linear RGB.
pub(super) fn opponent_of_linear(rgb: Rgb) -> [f64; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear RGB of YCxCz; may leave 0..=1.
pub(super) fn linear_of_opponent([luminance, cx, cz]: [f64; 3]) -> Rgb {
    let y = (luminance + 16.0) / 116.0;
    let xyz = [y + cx / 500.0, y, y - cz / 200.0];
    let white = XYZ_FROM_RGB.map(|row| row[0] + row[1] + row[2]);
    let target = [0, 1, 2].map(|k: usize| xyz[k] * white[k]);
    solve(&XYZ_FROM_RGB, target)
}

/// CIELAB of linear RGB.
pub(super) fn lab_of_linear(rgb: Rgb) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| {
        if t > DELTA * DELTA * DELTA {
            libm::cbrt(t)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Cramer's rule.
fn solve(m: &[[f64; 3]; 3], target: [f64; 3]) -> [f64; 3] {
    let determinant = |m: &[[f64; 3]; 3]| {
        let minor = |a: usize, b: usize| m[1][a] * m[2][b] - m[1][b] * m[2][a];
        m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1)
    };
    let whole = determinant(m);
    [0, 1, 2].map(|column: usize| {
        let mut replaced = *m;
        for row in 0..3 {
            replaced[row][column] = target[row];
        }
        determinant(&replaced) / whole
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f64; 3], b: [f64; 3], tolerance: f64) {
        assert!(
            (0..3).all(|k| (a[k] - b[k]).abs() < tolerance),
            "{a:?} {b:?}"
        );
    }

    #[test]
    fn opponent_space_is_undone() {
        for rgb in [[0.1, 0.7, 0.3], [1.0; 3], [0.0; 3], [0.9, 0.0, 0.2]] {
            close(linear_of_opponent(opponent_of_linear(rgb)), rgb, 1e-13);
        }
    }

    /// CIELAB of white, black and the red primary (a well-known triple).
    #[test]
    fn known_colours() {
        close(lab_of_linear([1.0; 3]), [100.0, 0.0, 0.0], 1e-12);
        close(lab_of_linear([0.0; 3]), [0.0; 3], 1e-12);
        close(lab_of_linear([1.0, 0.0, 0.0]), [53.24, 80.09, 67.20], 0.02);
        assert!((srgb_decode(0.5) - 0.214_041_14).abs() < 1e-8);
        assert_eq!(srgb_decode(1.0), 1.0);
    }
}
