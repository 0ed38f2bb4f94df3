//! Vertices inside their own object.

use super::Vertex;

/// Gives buried vertices the mean of their neighbours that are not, round after round,
/// as far as that reaches; their number.
pub(super) fn replace(vertices: &mut [Vertex], triangles: &[[u32; 3]]) -> u64 {
    let mut left: Vec<bool> = vertices.iter().map(|v| v.buried).collect();
    let buried = left.iter().filter(|b| **b).count() as u64;
    let mut found = buried > 0;
    while found {
        let means = means(vertices, triangles, &left);
        found = !means.is_empty();
        for (vertex, [diffuse, glossy]) in means {
            left[vertex] = false;
            vertices[vertex].diffuse = diffuse;
            vertices[vertex].glossy = glossy;
        }
    }
    buried
}

/// Of each vertex that is left and has neighbours that are not, in ascending order.
fn means(
    vertices: &[Vertex],
    triangles: &[[u32; 3]],
    left: &[bool],
) -> Vec<(usize, [Vec<f64>; 2])> {
    let mut pairs: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .flat_map(|[a, b]| [[a, b], [b, a]])
        .filter(|[a, b]| left[*a as usize] && !left[*b as usize])
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    let own = pairs.chunk_by(|a, b| a[0] == b[0]);
    own.map(|own| (own[0][0] as usize, mean(vertices, own)))
        .collect()
}

/// Mean of the second vertices of pairs.
fn mean(vertices: &[Vertex], pairs: &[[u32; 2]]) -> [Vec<f64>; 2] {
    let rows = |row: fn(&Vertex) -> &Vec<f64>| {
        let mut sum: Vec<f64> = Vec::new();
        for [_, other] in pairs {
            let other = row(&vertices[*other as usize]);
            sum.resize(other.len(), 0.0);
            sum.iter_mut().zip(other).for_each(|(s, c)| *s += c);
        }
        sum.iter_mut().for_each(|s| *s /= pairs.len() as f64);
        sum
    };
    [rows(|v| &v.diffuse), rows(|v| &v.glossy)]
}
