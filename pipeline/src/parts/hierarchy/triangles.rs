//! Triangles of casters, and boxes round them.

/// Corners, relative to the view's origin.
pub(crate) type Triangle = [[f32; 3]; 3];

/// Three times the centre's coordinate.
pub(super) fn centre(triangle: &Triangle, axis: usize) -> f32 {
    let [a, b, c] = triangle;
    (a[axis] + b[axis]) + c[axis]
}

/// Least and greatest corner of some triangles.
pub(super) fn bounds(triangles: &[Triangle], part: &[u32]) -> [[f32; 3]; 2] {
    let corners = part.iter().flat_map(|i| triangles[*i as usize]);
    let empty = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    corners.fold(empty, |[low, high], p| {
        [0, 1].map(|side| {
            [0, 1, 2].map(|k| match side {
                0 => low[k].min(p[k]),
                _ => high[k].max(p[k]),
            })
        })
    })
}

/// Half the surface of a box.
pub(super) fn area([low, high]: [[f32; 3]; 2]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| f64::from(high[k]) - f64::from(low[k]));
    x * y + y * z + z * x
}
