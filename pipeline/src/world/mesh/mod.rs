//! Indexed triangle meshes in world space.

mod normal_tree;
mod normals;

pub use normals::Shading;

use glam::DVec3;

use crate::world::error::MeshError;

/// Most vertices a mesh may have: a shadow volume indexes two vertices per
/// mesh vertex with 32 bits.
pub const MAX_VERTICES: usize = (u32::MAX / 2) as usize;

/// An indexed triangle mesh: positions, triangles, and shading normals.
///
/// Positions and triangles carry the *topology*: shadow volumes and scene draws
/// use the same position indices in the same triangle order, which is what
/// makes a volume's cap coincide with the surface to the bit. Normals only
/// shade; they have indices of their own (as in OBJ), so a crease never splits
/// a position.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f32; 3]>,
    normal_triangles: Vec<[u32; 3]>,
    shading: Shading,
}

impl Mesh {
    /// Validates `positions` (world space, any unit) and `triangles` (position
    /// indices, counter-clockwise from outside) and computes shading normals.
    ///
    /// # Errors
    /// A position that is not finite, an index out of range, or more than
    /// [`MAX_VERTICES`] positions.
    pub fn new(
        positions: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
        shading: Shading,
    ) -> Result<Self, MeshError> {
        check_positions(&positions)?;
        check_triangles(&triangles, positions.len())?;
        let (normals, normal_triangles) = normals::compute(&positions, &triangles, shading);
        Ok(Self {
            positions,
            triangles,
            normals,
            normal_triangles,
            shading,
        })
    }

    /// How its normals were formed.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// Vertex positions, world space.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Triangles as position indices, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Unit shading normals (zero where every adjacent triangle is degenerate).
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// Per triangle and corner, an index into [`Mesh::normals`]; same triangle
    /// order as [`Mesh::triangles`].
    pub fn normal_triangles(&self) -> &[[u32; 3]] {
        &self.normal_triangles
    }

    /// A vertex list in which position and normal share one index, for drawing.
    pub fn shading_vertices(&self) -> ShadingVertices {
        ShadingVertices::new(self)
    }

    /// Position `index` in f64 (exact).
    pub fn position(&self, index: u32) -> DVec3 {
        widen(self.positions[index as usize])
    }

    /// The corners of triangle `index` in f64 (exact).
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].map(|i| self.position(i))
    }

    /// Smallest and largest coordinates; `None` for a mesh without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut points = self.positions.iter().map(|&p| widen(p));
        let first = points.next()?;
        Some(points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p))))
    }

    /// Signed volume enclosed by a closed mesh; positive when the triangles
    /// face outwards.
    pub fn signed_volume(&self) -> f64 {
        let six = (0..self.triangles.len()).map(|t| {
            let [a, b, c] = self.corners(t);
            a.dot(b.cross(c))
        });
        six.sum::<f64>() / 6.0
    }
}

/// f32 triple to f64, exactly.
pub(crate) fn widen(p: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}

/// f64 to f32, rounding each coordinate once.
pub(crate) fn narrow(p: DVec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

fn check_positions(positions: &[[f32; 3]]) -> Result<(), MeshError> {
    if positions.len() > MAX_VERTICES {
        return Err(MeshError::TooManyVertices {
            count: positions.len(),
            limit: MAX_VERTICES,
        });
    }
    match positions
        .iter()
        .position(|p| p.iter().any(|c| !c.is_finite()))
    {
        Some(vertex) => Err(MeshError::NonFinitePosition {
            vertex,
            value: positions[vertex],
        }),
        None => Ok(()),
    }
}

fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
            return Err(MeshError::IndexOutOfRange {
                triangle,
                index,
                vertices,
            });
        }
    }
    Ok(())
}

/// Drawing view of a mesh: one vertex per distinct (position, normal) pair.
///
/// Triangle order and corner order equal the mesh's, and
/// `positions[v] == mesh.positions()[position_index[v]]` to the bit, so drawing
/// this list rasterises exactly like drawing the mesh itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadingVertices {
    /// World-space positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// For each vertex, its index in the mesh's own positions.
    pub position_index: Vec<u32>,
    /// Triangles over this vertex list.
    pub triangles: Vec<[u32; 3]>,
}

impl ShadingVertices {
    fn new(mesh: &Mesh) -> Self {
        let mut out = Self::default();
        let alike = first_alike(mesh);
        let mut vertices = vec![0; alike.len()];
        for (corner, &first) in alike.iter().enumerate() {
            let first = first as usize;
            if first == corner {
                vertices[corner] = out.push(mesh, corner);
            }
            vertices[corner] = vertices[first];
        }
        out.triangles = vertices
            .chunks_exact(3)
            .map(|v| [v[0], v[1], v[2]])
            .collect();
        out
    }

    /// The vertex of a corner, counted over all triangles.
    fn push(&mut self, mesh: &Mesh, corner: usize) -> u32 {
        let of = |triangles: &[[u32; 3]]| triangles[corner / 3][corner % 3];
        let (position, normal) = (of(&mesh.triangles), of(&mesh.normal_triangles));
        self.positions.push(mesh.positions[position as usize]);
        self.normals.push(mesh.normals[normal as usize]);
        self.position_index.push(position);
        (self.positions.len() - 1) as u32
    }
}

/// For each corner the first one of the same position and normal. Corners are put in
/// buckets by position and sorted there: about linear, however many meet in one.
fn first_alike(mesh: &Mesh) -> Vec<u32> {
    let positions = mesh.triangles.as_flattened();
    let normals = mesh.normal_triangles.as_flattened();
    let mut ends = vec![0; mesh.positions.len()];
    positions.iter().for_each(|&p| ends[p as usize] += 1);
    let mut total = 0;
    for end in &mut ends {
        total += *end;
        *end = total - *end; // where the bucket begins, until it is filled
    }
    let mut by_position = vec![0; positions.len()];
    for (corner, &p) in positions.iter().enumerate() {
        by_position[ends[p as usize]] = corner as u32;
        ends[p as usize] += 1;
    }
    let mut first = vec![0; positions.len()];
    let mut begin = 0;
    for end in ends {
        let bucket = &mut by_position[begin..end];
        bucket.sort_unstable_by_key(|&c| (normals[c as usize], c));
        for alike in bucket.chunk_by(|a, b| normals[*a as usize] == normals[*b as usize]) {
            alike.iter().for_each(|&c| first[c as usize] = alike[0]);
        }
        begin = end;
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn bad_input_is_named() {
        let nan = vec![[0.0; 3], [f32::NAN, 0.0, 0.0]];
        let error = Mesh::new(nan, vec![], Shading::Smooth).unwrap_err();
        assert!(matches!(
            error,
            MeshError::NonFinitePosition { vertex: 1, .. }
        ));

        let error = Mesh::new(TRIANGLE.to_vec(), vec![[0, 1, 3]], Shading::Flat).unwrap_err();
        assert_eq!(
            error,
            MeshError::IndexOutOfRange {
                triangle: 0,
                index: 3,
                vertices: 3
            }
        );
    }

    /// The obvious twin: each corner looks at all vertices so far.
    #[test]
    fn shading_vertices_are_in_order_of_appearance() {
        let solids = [
            crate::world::shape::cylinder(9, 0.5, 0.0, 1.0),
            crate::world::shape::icosphere(2, 1.0, DVec3::ZERO),
        ];
        for solid in solids {
            for shading in [
                Shading::Flat,
                Shading::Smooth,
                Shading::Crease { degrees: 30.0 },
            ] {
                let mesh = solid.clone().into_mesh(shading).unwrap();
                let mut met: Vec<(u32, u32)> = Vec::new();
                let mut vertex = |pair| {
                    met.iter().position(|m| *m == pair).unwrap_or_else(|| {
                        met.push(pair);
                        met.len() - 1
                    }) as u32
                };
                let both = mesh.triangles().iter().zip(mesh.normal_triangles());
                let expected: Vec<[u32; 3]> = both
                    .map(|(p, n)| [0, 1, 2].map(|k| vertex((p[k], n[k]))))
                    .collect();
                let draw = mesh.shading_vertices();
                assert_eq!(draw.triangles, expected, "{shading:?}");
                for (k, (p, n)) in met.into_iter().enumerate() {
                    assert_eq!(draw.position_index[k], p);
                    assert_eq!(draw.normals[k], mesh.normals()[n as usize]);
                }
            }
        }
    }

    #[test]
    fn shading_vertices_keep_positions_and_order() {
        let cube = crate::world::shape::cuboid(DVec3::ZERO, DVec3::ONE)
            .into_mesh(Shading::Crease { degrees: 30.0 })
            .unwrap();
        let draw = cube.shading_vertices();
        assert_eq!(draw.positions.len(), 24); // 8 corners x 3 faces
        for (drawn, own) in draw.triangles.iter().zip(cube.triangles()) {
            assert_eq!(drawn.map(|v| draw.position_index[v as usize]), *own);
        }
        for (p, &i) in draw.positions.iter().zip(&draw.position_index) {
            assert_eq!(*p, cube.positions()[i as usize]);
        }
    }
}
