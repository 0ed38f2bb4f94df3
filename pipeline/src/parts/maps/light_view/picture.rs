//! A view as a render pass, and as shaders find positions in it.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    DepthStencilAttachment, Draw, Format, IndexBuffer, LoadOp, Recording, RenderPass,
    RenderPipeline, StoreOp, Subresource, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::cones::patches::PatchPicture;
use gnomon_shaders::light_view::{DepthRange, LightMapping, PlanarDepth, Projection, ViewRegion};
use gnomon_shaders::shadow_maps::ReceiverPlanes;
use gnomon_shaders::surface::PixelRays;
use gnomon_shaders::transform::{ClipFromWorld, Facets};

use super::fit::Fitted;
use super::surroundings::Surroundings;
use crate::parts::passes::View;
use crate::parts::visibility::attachment;
use crate::technique::TechniqueError;
use crate::world::mesh::{Mesh, narrow};
use crate::world::scene::Scene;

/// The textures of a picture. Pictures may share them one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightMap {
    /// Linear planar depth in red, `R32Float`.
    pub(crate) depth: TextureId,
    buffer: TextureId,
    /// Texels along a side.
    pub(crate) size: u32,
    /// Texels by which slopes push surfaces away from the light: 0 unless set.
    pub(crate) slope: f64,
}

/// The most that slopes push, in texels at the far distance.
const SLOPE_LIMIT: f64 = 8.0;

impl LightMap {
    /// The depth buffer, of which nothing is kept.
    pub(crate) fn buffer(&self) -> TextureId {
        self.buffer
    }

    /// Of `size` by `size` texels.
    ///
    /// # Errors
    /// The GPU refuses the size.
    pub(crate) fn create(size: u32, recording: &mut Recording) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, size, size))
        };
        Ok(Self {
            depth: create("light view", Format::R32Float)?,
            buffer: create("light view depth", Format::Depth32FloatStencil8)?,
            size,
            slope: 0.0,
        })
    }
}

/// The casters' triangles with their planes, ready for any view of one light.
pub(crate) struct CasterGeometry {
    casters: Vec<CasterDraw>,
    /// What the planes' distances are taken from, world space.
    reference: DVec3,
}

struct CasterDraw {
    object: usize,
    name: String,
    vertices: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
}

impl CasterGeometry {
    /// Vertices are relative to the origin of `view`, and planes to `reference`:
    /// a point near the light.
    pub(crate) fn new(
        scene: &Scene,
        around: &Surroundings<'_>,
        view: &View,
        reference: DVec3,
    ) -> Self {
        Self::of(scene, around.casters.iter().copied(), view, reference)
    }

    /// All objects, casters or not.
    pub(crate) fn of_all(scene: &Scene, view: &View, reference: DVec3) -> Self {
        let meshes = scene.objects.iter().map(|o| &*o.mesh).enumerate();
        Self::of(scene, meshes, view, reference)
    }

    fn of<'a>(
        scene: &Scene,
        meshes: impl Iterator<Item = (usize, &'a Mesh)>,
        view: &View,
        reference: DVec3,
    ) -> Self {
        let casters = meshes.map(|(object, mesh)| {
            let vertices = Arc::new(facets(mesh, view, reference));
            let indices = (0..vertices.len() as u32).collect();
            CasterDraw {
                object,
                name: scene.objects[object].name.clone(),
                vertices,
                indices: Arc::new(IndexBuffer::new(indices)),
            }
        });
        Self {
            casters: casters.collect(),
            reference,
        }
    }
}

/// Each triangle with its plane, for [`Facets`].
fn facets(mesh: &Mesh, view: &View, reference: DVec3) -> VertexBuffer {
    let mut data = Vec::with_capacity(mesh.triangles().len() * 21);
    for t in 0..mesh.triangles().len() {
        let [a, b, c] = mesh.corners(t);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let distance = normal.dot(a - reference) as f32;
        for p in [a, b, c] {
            data.extend(narrow(view.relative(p)));
            data.extend(narrow(normal));
            data.push(distance);
        }
    }
    VertexBuffer { data, stride: 7 }
}

/// Where a picture goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PictureTarget {
    pub(crate) color: TextureId,
    /// Where nothing is in the way.
    pub(crate) clear: [f32; 4],
    /// A depth buffer of the picture's size, of which nothing is kept.
    pub(crate) buffer: TextureId,
}

impl Fitted {
    /// Draws the casters into `map`; those outside the picture too, unless `skip`.
    pub(crate) fn pass(
        &self,
        label: String,
        geometry: &CasterGeometry,
        view: &View,
        map: &LightMap,
        skip: bool,
    ) -> RenderPass {
        let target = PictureTarget {
            color: map.depth,
            clear: [1.0; 4],
            buffer: map.buffer,
        };
        let shader = self.planar_depth(geometry, map.size, map.slope).stage();
        self.pass_by(shader, label, geometry, view, &target, skip)
    }

    /// Linear planar depth, pushed away from the light by `slope` texels.
    fn planar_depth(&self, geometry: &CasterGeometry, size: u32, slope: f64) -> PlanarDepth {
        PlanarDepth {
            rays: self.rays(geometry.reference, size),
            projection: self.frame.projection,
            base: self.base as f32,
            range: self.depth_range(),
            slope: slope as f32,
            slope_limit: (self.texel_at_far(size) * SLOPE_LIMIT) as f32,
        }
    }

    /// Places and radii of micro-patches, relative to the origin of `view`.
    pub(crate) fn patches(
        &self,
        geometry: &CasterGeometry,
        view: &View,
        size: u32,
    ) -> PatchPicture {
        PatchPicture {
            depth: self.planar_depth(geometry, size, 0.0),
            reference: narrow(view.relative(geometry.reference)),
            half_diagonal: (self.texel(size) * FRAC_1_SQRT_2) as f32,
        }
    }

    /// Draws the casters into `target` by a shader of a technique's own, with the
    /// varyings of [`Facets`].
    pub(crate) fn pass_by(
        &self,
        shader: FragmentStage,
        label: String,
        geometry: &CasterGeometry,
        view: &View,
        target: &PictureTarget,
        skip: bool,
    ) -> RenderPass {
        let casters = geometry.casters.iter();
        let casters = casters.filter(|c| !skip || self.objects.binary_search(&c.object).is_ok());
        let drawn = casters.filter_map(|c| Some((c, self.drawn(c)?))).collect();
        self.picture(shader, label, drawn, view, target)
    }

    /// Depths of all objects of `geometry` into `color`, all of their triangles.
    pub(crate) fn pass_of_all(
        &self,
        label: String,
        geometry: &CasterGeometry,
        view: &View,
        map: &LightMap,
        color: TextureId,
    ) -> RenderPass {
        let target = PictureTarget {
            color,
            clear: [1.0; 4],
            buffer: map.buffer,
        };
        let shader = self.planar_depth(geometry, map.size, 0.0).stage();
        let all = geometry.casters.iter();
        let drawn = all.map(|c| (c, c.indices.clone())).collect();
        self.picture(shader, label, drawn, view, &target)
    }

    fn picture(
        &self,
        shader: FragmentStage,
        label: String,
        drawn: Vec<(&CasterDraw, Arc<IndexBuffer>)>,
        view: &View,
        target: &PictureTarget,
    ) -> RenderPass {
        let pipeline = Arc::new(RenderPipeline {
            label: "light view".into(),
            vertex: Facets(self.clip_from_world(view)).stage(),
            fragment: Some(shader),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::opaque(),
            color_targets: vec![ColorTargetState::OPAQUE],
        });
        RenderPass {
            label,
            color: vec![attachment(target.color, LoadOp::Clear(target.clear))],
            depth_stencil: Some(DepthStencilAttachment {
                texture: target.buffer,
                subresource: Subresource::default(),
                depth_load: LoadOp::Clear(1.0),
                depth_store: StoreOp::Discard,
                stencil_load: LoadOp::DontCare,
                stencil_store: StoreOp::Discard,
            }),
            draws: drawn
                .into_iter()
                .map(|(c, indices)| Draw::indexed(&c.name, &pipeline, &c.vertices, &indices))
                .collect(),
        }
    }

    /// What of a caster is drawn; `None` for nothing.
    fn drawn(&self, caster: &CasterDraw) -> Option<Arc<IndexBuffer>> {
        let Some(triangles) = &self.triangles else {
            return Some(caster.indices.clone());
        };
        let first = triangles.partition_point(|(object, _)| *object < caster.object);
        let own = triangles[first..].iter();
        let own = own.take_while(|(object, _)| *object == caster.object);
        let indices: Vec<u32> = own.flat_map(|(_, t)| 3 * t..3 * t + 3).collect();
        (!indices.is_empty()).then(|| Arc::new(IndexBuffer::new(indices)))
    }

    /// Where positions relative to the origin of `view` are in the picture.
    pub(crate) fn mapping(&self, view: &View, size: u32) -> LightMapping {
        let scale = 0.5 / self.half;
        let mapping = LightMapping {
            centre: narrow(view.relative(self.frame.centre)),
            axes: self.frame.axes.map(narrow),
            projection: self.frame.projection,
            scale: scale as f32,
            offset: self.middle.map(|m| (0.5 - m * scale) as f32),
            base: 0.0,
            range: self.depth_range(),
            size,
            region: self.region,
        };
        if self.base == 0.0 {
            return mapping;
        }
        let [right, down, along] = self.frame.axes;
        // Where the regions of faces meet, coordinates must be those of the cube.
        if self.region == ViewRegion::Face {
            let before = self.frame.centre + along * self.base;
            return LightMapping {
                centre: narrow(view.relative(before)),
                base: self.base as f32,
                ..mapping
            };
        }
        // From the middle of the picture, with axes across that keep to it.
        let [x, y] = self.middle;
        let middle = self.frame.centre + self.middle_ray() * self.base;
        LightMapping {
            centre: narrow(view.relative(middle)),
            axes: [right - along * x, down - along * y, along].map(narrow),
            offset: [0.5; 2],
            base: self.base as f32,
            ..mapping
        }
    }

    /// How receivers' planes are seen.
    pub(crate) fn planes(&self) -> ReceiverPlanes {
        let mapped_from = match (self.base > 0.0, self.region) {
            (false, _) => DVec3::ZERO,
            (true, ViewRegion::Face) => self.frame.axes[2] * self.base,
            (true, ViewRegion::Front) => self.middle_ray() * self.base,
        };
        ReceiverPlanes {
            axes: self.frame.axes.map(narrow),
            base: narrow(mapped_from),
        }
    }

    /// Through the middle of the picture, one long along the axis.
    fn middle_ray(&self) -> DVec3 {
        let [right, down, along] = self.frame.axes;
        let [x, y] = self.middle;
        along + right * x + down * y
    }

    pub(crate) fn depth_range(&self) -> DepthRange {
        let [near, far] = self.range.map(|z| (z - self.base) as f32);
        DepthRange { near, far }
    }

    /// Width of a texel in the picture: of tangents, or of lengths.
    fn texel(&self, size: u32) -> f64 {
        2.0 * self.half / f64::from(size)
    }

    /// Width of a texel at the far distance, world units.
    pub(crate) fn texel_at_far(&self, size: u32) -> f64 {
        match self.frame.projection {
            Projection::Perspective => self.texel(size) * self.range[1],
            Projection::Orthographic => self.texel(size),
        }
    }

    fn rays(&self, reference: DVec3, size: u32) -> PixelRays {
        let [right, down, along] = self.frame.axes;
        let [x, y] = self.middle.map(|m| m - self.half);
        let texel = self.texel(size);
        let (eye, corner) = (self.frame.centre - reference, right * x + down * y);
        let (eye, first) = match self.frame.projection {
            Projection::Perspective => (eye + (along + corner) * self.base, along + corner),
            Projection::Orthographic => (eye + corner, along),
        };
        PixelRays {
            eye: narrow(eye),
            first: narrow(first),
            right: narrow(right * texel),
            down: narrow(down * texel),
        }
    }

    /// Depth 0 at the near distance, 1 at infinity, of orthographic views at the far
    /// distance; the picture's upper edge is `y = w`.
    pub(crate) fn clip_from_world(&self, view: &View) -> ClipFromWorld {
        let [right, down, along] = self.frame.axes;
        let centre = view.relative(self.frame.centre);
        let row = |axis: DVec3, offset: f64| {
            let [x, y, z] = axis.to_array();
            [x, y, z, offset - axis.dot(centre)].map(|v| v as f32)
        };
        let [x, y] = self.middle;
        if self.frame.projection == Projection::Orthographic {
            let [near, far] = self.range;
            let depth = far - near;
            return ClipFromWorld([
                row(right / self.half, -x / self.half),
                row(-down / self.half, y / self.half),
                row(along / depth, -near / depth),
                [0.0, 0.0, 0.0, 1.0],
            ]);
        }
        ClipFromWorld([
            row((right - along * x) / self.half, 0.0),
            row((along * y - down) / self.half, 0.0),
            row(along, -self.range[0]),
            row(along, 0.0),
        ])
    }
}
