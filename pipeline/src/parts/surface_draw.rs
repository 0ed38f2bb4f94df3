//! A scene's surfaces, ready to draw in any pass.
//!
//! # Near plane
//!
//! All geometry is drawn with depth clamp, so that the near plane never cuts a
//! triangle and a volume's cap keeps the surface's depth plane to the bit.
//! Objects that reach nearer than the near plane get it as a clip plane, which
//! drops fragments and makes no vertices.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::state::PrimitiveState;
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, TextureBinding, VertexBuffer};

use super::far_surface;
use super::surface_textures::SurfaceTextures;
use super::surface_vertices::{STRIDE, SurfaceVertices};
use super::view::View;
use crate::world::mesh::{narrow, widen};
use crate::world::scene::{Material, MaterialPart, Object, Scene};
use crate::world::texture::split;

/// Geometry of one object in one material, ready to draw.
pub(crate) struct SurfaceDraw<'a> {
    pub(crate) object: &'a Object,
    pub(crate) material: Material,
    vertices: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
    /// Of each triangle that in the object's mesh.
    numbers: Vec<u32>,
    pub(crate) primitive: PrimitiveState,
    /// What its albedo is multiplied by.
    pub(crate) texture: Option<Textured>,
}

/// The same geometry with texture coordinates, and the texture.
pub(crate) struct Textured {
    pub(crate) binding: TextureBinding,
    /// Eight floats each: those of the surface, and the coordinates.
    vertices: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
}

impl<'a> SurfaceDraw<'a> {
    /// A draw for each material; vertices are shared.
    pub(crate) fn of_object(
        scene: &Scene,
        view: &View,
        object: &'a Object,
        textures: &SurfaceTextures,
    ) -> Vec<Self> {
        let surface = far_surface::clipped(object, view);
        let surface = surface.unwrap_or_else(|| SurfaceVertices::whole(object, view));
        let mut primitive = clamped();
        if crosses_near_plane(scene, object) {
            primitive.clip_planes.push([0.0, 0.0, 1.0, 0.0]);
        }
        let indices = |part: &MaterialPart| {
            let own = part.triangles.iter().flat_map(|&t| surface.of(t));
            IndexBuffer::new(own.flatten().copied().collect())
        };
        let numbers = |part: &MaterialPart| {
            let own = part.triangles.iter();
            own.flat_map(|&t| surface.of(t).iter().map(move |_| t))
                .collect()
        };
        let parts = object.painted();
        let textured = |part: &MaterialPart| {
            let binding = part.texture.as_ref().and_then(|t| textures.binding(t))?;
            Some(textured(object, part, &surface, binding))
        };
        let textured: Vec<Option<Textured>> = parts.iter().map(textured).collect();
        let numbers: Vec<Vec<u32>> = parts.iter().map(numbers).collect();
        let indices: Vec<IndexBuffer> = parts.iter().map(indices).collect();
        let vertices = Arc::new(VertexBuffer {
            data: surface.data,
            stride: STRIDE,
        });
        let geometry = indices.into_iter().zip(numbers).zip(textured);
        let draw = |(part, ((indices, numbers), texture)): (MaterialPart, _)| Self {
            object,
            material: part.material,
            vertices: vertices.clone(),
            indices: Arc::new(indices),
            numbers,
            primitive: primitive.clone(),
            texture,
        };
        parts.into_iter().zip(geometry).map(draw).collect()
    }

    /// Six floats each: position relative to the view's origin, and normal. All
    /// draws of an object share them; those of a caster are its mesh's
    /// [`shading_vertices`](crate::world::mesh::Mesh::shading_vertices).
    pub(crate) fn vertices(&self) -> &Arc<VertexBuffer> {
        &self.vertices
    }

    /// Triangles over them.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let corners = self.indices.indices().chunks_exact(3);
        corners.map(|c| [c[0], c[1], c[2]])
    }

    /// Ambient light times albedo, opaque.
    pub(crate) fn ambient(&self, light: [f32; 3]) -> [f32; 4] {
        let albedo = self.material.albedo;
        let [r, g, b] = [0, 1, 2].map(|i| light[i] * albedo[i]);
        [r, g, b, 1.0]
    }

    /// Each triangle with its plane, for [`gnomon_shaders::transform::Facets`].
    pub(crate) fn draw_facets(&self, view: &View, pipeline: RenderPipeline) -> Draw {
        let plane = |corners: [DVec3; 3]| Some(plane_from_eye(view, corners));
        self.draw_flat(pipeline, &plane)
    }

    /// Each triangle with its plane and the number that `number` gives to that of the mesh,
    /// for [`gnomon_shaders::transform::NumberedFacets`].
    pub(crate) fn draw_numbered(
        &self,
        view: &View,
        pipeline: RenderPipeline,
        number: &dyn Fn(u32) -> f32,
    ) -> Draw {
        let mut data = Vec::with_capacity(self.numbers.len() * 3 * 8);
        for (triangle, of) in self.triangles().zip(&self.numbers) {
            let corners = triangle.map(|i| self.corner(i));
            let plane = plane_from_eye(view, corners.map(widen));
            for p in corners {
                data.extend(p);
                data.extend(plane);
                data.push(number(*of));
            }
        }
        self.draw_alone(pipeline, VertexBuffer { data, stride: 8 })
    }

    /// The surface with its texture, for [`gnomon_shaders::textured::TexturedSurfaces`];
    /// `before` are the textures before that of the surface.
    pub(crate) fn draw_textured(
        &self,
        pipeline: RenderPipeline,
        textured: &Textured,
        before: impl IntoIterator<Item = TextureBinding>,
    ) -> Draw {
        let textures = before
            .into_iter()
            .chain([textured.binding.clone()])
            .collect();
        Draw {
            textures,
            ..Draw::indexed(
                &self.object.name,
                &Arc::new(pipeline),
                &textured.vertices,
                &textured.indices,
            )
        }
    }

    fn corner(&self, i: u32) -> [f32; 3] {
        let at = i as usize * self.vertices.stride;
        [0, 1, 2].map(|k| self.vertices.data[at + k])
    }

    /// Triangles of three vertices each.
    fn draw_alone(&self, pipeline: RenderPipeline, vertices: VertexBuffer) -> Draw {
        let vertices = Arc::new(vertices);
        let indices = (0..vertices.len() as u32).collect();
        Draw::indexed(
            &self.object.name,
            &Arc::new(pipeline),
            &vertices,
            &Arc::new(IndexBuffer::new(indices)),
        )
    }

    /// The triangles to which `flat` gives four numbers, for the flat varyings of
    /// [`gnomon_shaders::transform::Facets`]; corners are relative to the view's origin.
    pub(crate) fn draw_flat(
        &self,
        pipeline: RenderPipeline,
        flat: &dyn Fn([DVec3; 3]) -> Option<[f32; 4]>,
    ) -> Draw {
        let mut data = Vec::new();
        for triangle in self.indices.indices().chunks_exact(3) {
            let corners = [0, 1, 2].map(|k| self.corner(triangle[k]));
            let Some(numbers) = flat(corners.map(widen)) else {
                continue;
            };
            for p in corners {
                data.extend(p);
                data.extend(numbers);
            }
        }
        self.draw_alone(pipeline, VertexBuffer { data, stride: 7 })
    }

    pub(crate) fn draw(&self, pipeline: RenderPipeline) -> Draw {
        Draw::indexed(
            &self.object.name,
            &Arc::new(pipeline),
            &self.vertices,
            &self.indices,
        )
    }
}

fn textured(
    object: &Object,
    part: &MaterialPart,
    surface: &SurfaceVertices,
    binding: TextureBinding,
) -> Textured {
    let corners = part.triangles.iter().flat_map(|&t| {
        let own = surface.of(t).iter();
        own.map(move |&c| (c, surface.coordinates_of(object, t, c)))
    });
    let seams = split(corners);
    let row = |&(vertex, at): &(u32, [f32; 2])| {
        let own = &surface.data[vertex as usize * STRIDE..][..STRIDE];
        own.iter().copied().chain(at)
    };
    let vertices = VertexBuffer {
        data: seams.vertices.iter().flat_map(row).collect(),
        stride: STRIDE + 2,
    };
    let indices = seams.triangles.into_iter().flatten();
    Textured {
        binding,
        vertices: Arc::new(vertices),
        indices: Arc::new(IndexBuffer::new(indices.collect())),
    }
}

/// A facet's unit normal and distance from the eye.
fn plane_from_eye(view: &View, [a, b, c]: [DVec3; 3]) -> [f32; 4] {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let [x, y, z] = narrow(normal);
    [x, y, z, normal.dot(a - view.eye()) as f32]
}

/// Whether some vertex may be nearer than the near plane.
fn crosses_near_plane(scene: &Scene, object: &Object) -> bool {
    let camera = &scene.camera;
    let [_, _, forward] = camera.basis();
    let nearest = camera.near * (1.0 + 1e-4);
    let depth = |i| (object.mesh.position(i) - camera.eye).dot(forward);
    (0..object.mesh.positions().len() as u32).any(|i| depth(i) < nearest)
}

/// Nothing culled, depth clamped: for scene geometry and volumes alike.
pub(crate) fn clamped() -> PrimitiveState {
    PrimitiveState {
        depth_clamp: true,
        ..PrimitiveState::default()
    }
}

pub(crate) fn index_buffer(triangles: &[[u32; 3]]) -> Arc<IndexBuffer> {
    Arc::new(IndexBuffer::new(
        triangles.iter().flatten().copied().collect(),
    ))
}
