//! What rays read, in textures.

use gnomon_raster::{Format, Recording, Subresource, TextureDescriptor, TextureId};
use gnomon_shaders::shadow_rays::Table;

use crate::parts::hierarchy::{self, Node, Triangle};
use crate::parts::tables::table;
use crate::parts::view::View;
use crate::technique::TechniqueError;
use crate::world::light::HardLight;
use crate::world::mesh::narrow;
use crate::world::scene::Scene;

/// The casters' triangles with their hierarchy.
pub(super) struct CasterTextures {
    pub(super) nodes: (TextureId, Table),
    pub(super) triangles: (TextureId, Table),
    /// Nodes.
    pub(super) count: u32,
    /// The largest coordinate of a caster.
    pub(super) largest: f32,
}

/// Most nodes whose numbers are exact in a float.
const MOST_NODES: usize = 1 << 24;

impl CasterTextures {
    /// Of all casters.
    ///
    /// # Errors
    /// There are too many triangles for the textures.
    pub(super) fn create(
        technique: &'static str,
        scene: &Scene,
        view: &View,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let triangles = triangles(scene, view);
        if 2 * triangles.len() > MOST_NODES {
            return Err(TechniqueError::TooManyTriangles {
                technique,
                given: triangles.len(),
                most: MOST_NODES / 2,
            });
        }
        let nodes = hierarchy::build(&triangles);
        let boxes = nodes.iter().flat_map(Node::texels);
        let corners = triangles.iter().flatten().map(|p| [p[0], p[1], p[2], 0.0]);
        Ok(Self {
            nodes: table("hierarchy", boxes.collect(), recording)?,
            triangles: table("triangles", corners.collect(), recording)?,
            count: nodes.len() as u32,
            largest: hierarchy::largest(&triangles),
        })
    }
}

fn triangles(scene: &Scene, view: &View) -> Vec<Triangle> {
    let casters = scene.objects.iter().filter(|o| o.casts);
    let of = |mesh: &crate::world::mesh::Mesh| {
        let all = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
        all.map(|corners| corners.map(|p| narrow(view.relative(p))))
            .collect::<Vec<_>>()
    };
    casters.flat_map(|o| of(&o.mesh)).collect()
}

/// Points of a light, a row for each pixel of a block.
pub(super) fn points(
    rows: &[Vec<HardLight>],
    view: &View,
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let columns = rows.first().map_or(0, Vec::len);
    let desc = TextureDescriptor::d2(
        "points",
        Format::Rgba32Float,
        columns as u32,
        rows.len() as u32,
    );
    let texture = recording.create(&desc)?;
    let texels: Vec<[f32; 4]> = rows.iter().flatten().map(|p| texel(p, view)).collect();
    recording.write(texture, Subresource::default(), &texels)?;
    Ok(texture)
}

fn texel(point: &HardLight, view: &View) -> [f32; 4] {
    let ([x, y, z], w) = match point {
        HardLight::Point(p) => (narrow(view.relative(*p)), 1.0),
        HardLight::Directional(towards) => (narrow(towards.normalize()), 0.0),
    };
    [x, y, z, w]
}
