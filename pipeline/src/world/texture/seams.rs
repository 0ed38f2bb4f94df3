//! Vertices that have one texture coordinate each: where a texture has a seam, a vertex of
//! the mesh is several.

use std::collections::BTreeMap;

use super::CornerCoordinates;

/// Vertices with coordinates, and triangles over them.
#[derive(Default)]
pub(crate) struct Seams {
    /// Of each vertex its number in the mesh, and its coordinates.
    pub(crate) vertices: Vec<(u32, [f32; 2])>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Splits the vertices of triangles, in order of first use.
pub(crate) fn split(corners: impl IntoIterator<Item = ([u32; 3], CornerCoordinates)>) -> Seams {
    let mut seams = Seams::default();
    let mut known: BTreeMap<(u32, [u32; 2]), u32> = BTreeMap::new();
    for (triangle, coordinates) in corners {
        let vertices = [0, 1, 2].map(|k| {
            let (vertex, at) = (triangle[k], coordinates[k]);
            let next = seams.vertices.len() as u32;
            *known
                .entry((vertex, at.map(f32::to_bits)))
                .or_insert_with(|| {
                    seams.vertices.push((vertex, at));
                    next
                })
        });
        seams.triangles.push(vertices);
    }
    seams
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_split_at_seams_only() {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.0]];
        let seams = split([
            ([7, 8, 9], [a, b, c]),
            ([9, 8, 3], [c, b, d]),
            ([7, 9, 3], [d, c, d]),
        ]);
        assert_eq!(seams.triangles, [[0, 1, 2], [2, 1, 3], [4, 2, 3]]);
        let expected = [(7, a), (8, b), (9, c), (3, d), (7, d)];
        assert_eq!(seams.vertices, expected);
    }
}
