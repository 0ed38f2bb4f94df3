//! What a file says of a scene: solids, and sometimes an eye and lights.

use glam::DVec3;

use crate::world::light::Light;
use crate::world::material::MaterialPart;
use crate::world::shape::Shape;
use crate::world::texture::CornerCoordinates;
use crate::world::warning::SceneWarning;

/// Vertices or triangles that are drawn of a file at most: formats whose bytes say more than
/// one each are bounded by it.
pub(super) const MOST: u64 = 1 << 23;

/// One solid of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its name in the file.
    pub name: String,
    /// Its triangles, in the model's coordinates.
    pub shape: Shape,
    /// Triangles that have a material, material after material.
    pub parts: Vec<MaterialPart>,
    /// Of each triangle the texture coordinates of its corners; empty where there are none.
    pub coordinates: Vec<CornerCoordinates>,
}

/// An eye that a file has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelCamera {
    /// Where it is.
    pub eye: DVec3,
    /// A point that it looks at.
    pub target: DVec3,
    /// Up.
    pub up: DVec3,
    /// Vertical field of view, degrees.
    pub fov_y_degrees: f64,
    /// Distance of the near plane.
    pub near: f64,
}

/// What a file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Solids, at least one, each with at least one triangle.
    pub pieces: Vec<Piece>,
    /// Its eye, if it has one.
    pub camera: Option<ModelCamera>,
    /// Its lights.
    pub lights: Vec<Light>,
    /// Whether it is another at another time.
    pub moves: bool,
    /// What was amiss without stopping it.
    pub warnings: Vec<SceneWarning>,
}

impl Model {
    /// A single solid.
    pub fn of(piece: Piece, warnings: Vec<SceneWarning>) -> Self {
        Self {
            pieces: vec![piece],
            camera: None,
            lights: Vec::new(),
            moves: false,
            warnings,
        }
    }

    /// Smallest and largest coordinates of all solids.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let all = self.pieces.iter().filter_map(|p| p.shape.bounds());
        all.reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
    }

    /// All solids as one; of equal paint there is one part.
    pub fn merged(self) -> Piece {
        let mut parts: Vec<MaterialPart> = Vec::new();
        let mut base = 0;
        for piece in &self.pieces {
            for part in &piece.parts {
                let triangles = part.triangles.iter().map(|t| t + base);
                let alike = |p: &&mut MaterialPart| {
                    p.material == part.material && p.texture == part.texture
                };
                match parts.iter_mut().find(alike) {
                    Some(same) => same.triangles.extend(triangles),
                    None => parts.push(MaterialPart {
                        triangles: triangles.collect(),
                        ..part.clone()
                    }),
                }
            }
            base += piece.shape.triangles.len() as u32;
        }
        let coordinates = self.coordinates();
        let mut pieces = self.pieces.into_iter().peekable();
        Piece {
            name: pieces.peek().map_or_else(String::new, |p| p.name.clone()),
            shape: Shape::merged(pieces.map(|p| p.shape)),
            parts,
            coordinates,
        }
    }

    /// Texture coordinates of all triangles, zeros in solids that have none.
    fn coordinates(&self) -> Vec<CornerCoordinates> {
        let mut all = Vec::new();
        if self.pieces.iter().all(|p| p.coordinates.is_empty()) {
            return all;
        }
        let mut end = 0;
        for piece in &self.pieces {
            all.extend_from_slice(&piece.coordinates);
            end += piece.shape.triangles.len();
            all.resize(end, CornerCoordinates::default());
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::material::Material;

    #[test]
    fn pieces_are_merged_with_their_paint() {
        let piece = |albedo, triangles: Vec<u32>| Piece {
            name: String::new(),
            shape: crate::world::shape::plane(1.0, 0.0),
            parts: vec![MaterialPart {
                material: Material::matt([albedo; 3]),
                texture: None,
                triangles,
            }],
            coordinates: Vec::new(),
        };
        let mut model = Model::of(piece(0.5, vec![1]), Vec::new());
        model
            .pieces
            .extend([piece(0.25, vec![0]), piece(0.5, vec![0, 1])]);
        model.pieces[1].coordinates = vec![[[0.5; 2]; 3]; 2];
        let Piece {
            shape,
            parts,
            coordinates,
            ..
        } = model.merged();
        let used = [[0.0; 2], [0.5; 2], [0.0; 2]].map(|c| [[c; 3]; 2]);
        assert_eq!(coordinates, used.as_flattened());
        assert_eq!((shape.triangles.len(), shape.positions.len()), (6, 12));
        let triangles: Vec<_> = parts.iter().map(|p| p.triangles.clone()).collect();
        assert_eq!(triangles, [vec![1, 4, 5], vec![2]]);
    }
}
