//! The passes that techniques share: ambient light with depth, and light added
//! per light source, over the same draws of the scene.
//!
//! # Colour
//!
//! Shaders compute linear light and passes add it. The default target is
//! `rgba16f`, precise enough that its sRGB picture shows no bands. `rgba8`
//! holds the same linear light in 8 bits, as the papers' hardware and the peers'
//! renderers do: half the bytes, bands in the dark, sums that
//! saturate. What a value means does not depend on the format.
//!
//! # Near plane
//!
//! All geometry is drawn with depth clamp, so that the near plane never cuts a
//! triangle and a volume's cap keeps the surface's depth plane to the bit.
//! Objects that reach nearer than the near plane get it as a clip plane, which
//! drops fragments and makes no vertices.
//!
//! # Origin
//!
//! f32 transforms resolve about 2^-22 of the largest coordinate. Where the eye
//! looks at something much nearer than the world's origin is, [`View`] moves
//! the origin next to the eye, by an amount that leaves differences of nearby
//! f32 coordinates exact; scene and volumes move alike. Elsewhere the origin
//! stays, and with it the peers' bits.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Draw, Format, IndexBuffer, LoadOp,
    RenderPass, RenderPipeline, StoreOp, Subresource, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::surface::{AmbientWithPosition, Constant, Lambert, Phong, PixelRays};
use gnomon_shaders::transform::{ClipFromWorld, Facets, Points, Surfaces};

use super::visibility::{Positions, VisibilityTexture, attachment, binding};
use crate::light::HardLight;
use crate::mesh::{narrow, widen};
use crate::scene::{Camera, Material, MaterialPart, Object, Scene};
use crate::technique::{
    Frame, Outputs, ParamInfo, Params, TechniqueError, TextureSource, VisibilityOutput,
};

pub(super) const LIGHT: ParamInfo = ParamInfo {
    name: "light",
    default: "all",
    valid: "all|N",
    summary: "which lights shine: all, or one by its number; visibility is that of the first",
};

pub(super) const SHADING: ParamInfo = ParamInfo {
    name: "shading",
    default: "phong",
    valid: "phong|lambert",
    summary: "with the material's highlights, or diffuse only",
};

pub(super) const COLOR_FORMAT: ParamInfo = ParamInfo {
    name: "color-format",
    default: "rgba16f",
    valid: "rgba16f|rgba8",
    summary: "target for linear light; rgba8 costs half the bytes, shows bands and saturates",
};

pub(super) const DEPTH_FORMAT: ParamInfo = ParamInfo {
    name: "depth-format",
    default: "d24",
    valid: "d24|d32f",
    summary: "24-bit integer or 32-bit float depth",
};

/// The lights that `params` asks for, first one first.
pub(super) fn lights(scene: &Scene, params: &Params) -> Result<Vec<usize>, TechniqueError> {
    let count = scene.lights.len();
    match params.get(LIGHT.name).parse() {
        Err(_) => Ok((0..count).collect()),
        Ok(given) if given < count => Ok(vec![given]),
        Ok(given) => Err(TechniqueError::NoSuchLight { given, count }),
    }
}

/// `what`, with the light's number where there are several.
pub(super) fn label(what: &str, light: usize, lights: &[usize]) -> String {
    if lights.len() == 1 {
        what.to_owned()
    } else {
        format!("{what} {light}")
    }
}

/// The attachments of a frame.
pub(super) struct Targets {
    color: TextureId,
    depth_stencil: TextureId,
}

impl Targets {
    pub(super) fn create(
        [width, height]: [u32; 2],
        params: &Params,
        textures: &mut dyn TextureSource,
    ) -> Result<Self, TechniqueError> {
        let rgba8 = params.get(COLOR_FORMAT.name) == "rgba8";
        let color = if rgba8 {
            Format::Rgba8Unorm
        } else {
            Format::Rgba16Float
        };
        let d32f = params.get(DEPTH_FORMAT.name) == "d32f";
        let depth = if d32f {
            Format::Depth32FloatStencil8
        } else {
            Format::Depth24Stencil8
        };
        Ok(Self {
            color: textures.create(&TextureDescriptor::d2("color", color, width, height))?,
            depth_stencil: textures.create(&TextureDescriptor::d2(
                "depth-stencil",
                depth,
                width,
                height,
            ))?,
        })
    }

    pub(super) fn frame(&self, passes: Vec<RenderPass>, visibility: VisibilityOutput) -> Frame {
        Frame {
            list: CommandList { passes },
            outputs: Outputs {
                color: self.color,
                depth_stencil: self.depth_stencil,
                visibility,
            },
            warnings: Vec::new(),
            casters: Vec::new(),
            figures: Vec::new(),
        }
    }

    fn color(&self, load: LoadOp<[f32; 4]>) -> Vec<ColorAttachment> {
        vec![attachment(self.color, load)]
    }

    /// Depth and stencil, to be read while they are not attached.
    pub(super) fn depth_texture(&self) -> TextureId {
        self.depth_stencil
    }

    /// Depth and stencil as they are, but for the given loads.
    pub(super) fn depth_stencil(
        &self,
        depth: LoadOp<f32>,
        stencil: LoadOp<u8>,
    ) -> Option<DepthStencilAttachment> {
        Some(DepthStencilAttachment {
            texture: self.depth_stencil,
            subresource: Subresource::default(),
            depth_load: depth,
            depth_store: StoreOp::Store,
            stencil_load: stencil,
            stencil_store: StoreOp::Store,
        })
    }
}

/// Where a lit pass adds light, and how much of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LitTest {
    /// At every surface.
    Everywhere,
    /// Where the stencil is 0; objects that take no shadow set it to 0 first.
    StencilZero,
    /// At every surface, times the visibility in a texture; objects that take no
    /// shadow are fully lit.
    Visibility(VisibilityTexture),
}

/// Geometry of one object in one material, ready to draw.
struct SurfaceDraw<'a> {
    object: &'a Object,
    material: Material,
    vertices: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
    primitive: PrimitiveState,
}

/// All objects of a scene, ready to draw in any pass.
pub(super) struct SceneDraws<'a> {
    scene: &'a Scene,
    /// The camera that all passes share.
    pub(super) view: View,
    surfaces: Vec<SurfaceDraw<'a>>,
    highlights: bool,
}

impl<'a> SceneDraws<'a> {
    pub(super) fn new(scene: &'a Scene, size: [u32; 2], params: &Params) -> Self {
        let view = View::new(&scene.camera, size);
        let drawn = scene
            .objects
            .iter()
            .filter(|o| !o.mesh.triangles().is_empty());
        Self {
            scene,
            surfaces: drawn
                .flat_map(|o| SurfaceDraw::of_object(scene, &view, o))
                .collect(),
            view,
            highlights: params.get(SHADING.name) != "lambert",
        }
    }

    /// Clears all attachments, then draws ambient light and depth.
    pub(super) fn ambient_pass(&self, targets: &Targets) -> RenderPass {
        let [r, g, b] = self.scene.background;
        let ambient = self.scene.ambient;
        let draw = |s: &SurfaceDraw<'_>| {
            s.draw(RenderPipeline {
                label: "ambient".into(),
                vertex: Points(self.view.clip_from_world).stage(),
                fragment: Some(Constant(s.ambient(ambient)).stage()),
                primitive: s.primitive.clone(),
                depth_stencil: DepthStencilState::opaque(),
                color_targets: vec![ColorTargetState::OPAQUE],
            })
        };
        RenderPass {
            label: "ambient".into(),
            color: targets.color(LoadOp::Clear([r, g, b, 1.0])),
            depth_stencil: targets.depth_stencil(LoadOp::Clear(1.0), LoadOp::Clear(0)),
            draws: self.surfaces.iter().map(draw).collect(),
        }
    }

    /// The same, and writes where each pixel's surface is into `positions`: 16
    /// bytes a fragment, counted as colour traffic of attachment 1.
    pub(super) fn ambient_pass_with_positions(
        &self,
        targets: &Targets,
        positions: &Positions,
    ) -> RenderPass {
        let rays = self.view.pixel_rays();
        let draw = |s: &SurfaceDraw<'_>| {
            let shader = AmbientWithPosition {
                ambient: s.ambient(self.scene.ambient),
                receives: s.object.receives,
                rays,
            };
            s.draw_facets(
                &self.view,
                RenderPipeline {
                    label: "ambient".into(),
                    vertex: Facets(self.view.clip_from_world).stage(),
                    fragment: Some(shader.stage()),
                    primitive: s.primitive.clone(),
                    depth_stencil: DepthStencilState::opaque(),
                    color_targets: vec![ColorTargetState::OPAQUE; 2],
                },
            )
        };
        let mut pass = self.ambient_pass(targets);
        pass.color
            .push(attachment(positions.texture, LoadOp::Clear([0.0; 4])));
        pass.draws = self.surfaces.iter().map(draw).collect();
        pass
    }

    /// Adds the light of light `light` to what the ambient pass drew.
    pub(super) fn lit_pass(
        &self,
        targets: &Targets,
        light: usize,
        label: &str,
        test: LitTest,
    ) -> RenderPass {
        let draw = |s: &SurfaceDraw<'_>| {
            let visibility = match test {
                LitTest::Visibility(v) if s.object.receives => Some(v),
                _ => None,
            };
            let mut draw = s.draw(RenderPipeline {
                label: label.to_owned(),
                vertex: Surfaces(self.view.clip_from_world).stage(),
                fragment: Some(self.lit_shader(&s.material, light, visibility)),
                primitive: s.primitive.clone(),
                depth_stencil: lit_state(test, s.object.receives),
                color_targets: vec![ColorTargetState::ADDITIVE],
            });
            draw.textures = visibility.iter().map(|v| binding(v.texture)).collect();
            draw
        };
        RenderPass {
            label: label.to_owned(),
            color: targets.color(LoadOp::Load),
            depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: self.surfaces.iter().map(draw).collect(),
        }
    }

    /// Draws of the objects that take no shadow, where they are seen, in one
    /// colour; for a pass with one colour attachment and the depth of the frame.
    pub(super) fn not_receiving(&self, label: &str, colour: [f32; 4]) -> Vec<Draw> {
        let surfaces = self.surfaces.iter().filter(|s| !s.object.receives);
        let draw = |s: &SurfaceDraw<'_>| {
            s.draw(RenderPipeline {
                label: label.to_owned(),
                vertex: Points(self.view.clip_from_world).stage(),
                fragment: Some(Constant(colour).stage()),
                primitive: s.primitive.clone(),
                depth_stencil: equal_depth(),
                color_targets: vec![ColorTargetState::OPAQUE],
            })
        };
        surfaces.map(draw).collect()
    }

    fn lit_shader(
        &self,
        material: &Material,
        light: usize,
        visibility: Option<VisibilityTexture>,
    ) -> FragmentStage {
        let light = &self.scene.lights[light];
        let coloured = |c: [f32; 3]| [0, 1, 2].map(|i| c[i] * light.colour[i]);
        let lambert = Lambert {
            diffuse: coloured(material.albedo),
            light: self.view.light(light.hard()),
        };
        if !self.highlights || material.specular == [0.0; 3] {
            return match visibility {
                Some(v) => v.shadowed(lambert).stage(),
                None => lambert.stage(),
            };
        }
        let phong = Phong {
            lambert,
            specular: coloured(material.specular),
            shininess: material.shininess,
            eye: narrow(self.scene.camera.eye - self.view.origin),
        };
        match visibility {
            Some(v) => v.shadowed(phong).stage(),
            None => phong.stage(),
        }
    }
}

impl<'a> SurfaceDraw<'a> {
    /// A draw for each material; vertices are shared.
    fn of_object(scene: &Scene, view: &View, object: &'a Object) -> Vec<Self> {
        let shading = object.mesh.shading_vertices();
        let rows = shading.positions.iter().zip(&shading.normals);
        let data = rows
            .flat_map(|(p, n)| view.point(*p).into_iter().chain(*n))
            .collect();
        let mut primitive = clamped();
        if crosses_near_plane(scene, object) {
            primitive.clip_planes.push([0.0, 0.0, 1.0, 0.0]);
        }
        let vertices = Arc::new(VertexBuffer { data, stride: 6 });
        let draw = |part: MaterialPart| {
            let own = part
                .triangles
                .iter()
                .map(|&t| shading.triangles[t as usize]);
            Self {
                object,
                material: part.material,
                vertices: vertices.clone(),
                indices: index_buffer(&own.collect::<Vec<_>>()),
                primitive: primitive.clone(),
            }
        };
        object.painted().into_iter().map(draw).collect()
    }

    /// Ambient light times albedo, opaque.
    fn ambient(&self, light: [f32; 3]) -> [f32; 4] {
        let albedo = self.material.albedo;
        let [r, g, b] = [0, 1, 2].map(|i| light[i] * albedo[i]);
        [r, g, b, 1.0]
    }

    /// Each triangle with its plane, for [`Facets`].
    fn draw_facets(&self, view: &View, pipeline: RenderPipeline) -> Draw {
        let stride = self.vertices.stride;
        let corner = |i: u32| {
            let at = i as usize * stride;
            [0, 1, 2].map(|k| self.vertices.data[at + k])
        };
        let mut data = Vec::new();
        for triangle in self.indices.indices().chunks_exact(3) {
            let corners = [0, 1, 2].map(|k| corner(triangle[k]));
            let [a, b, c] = corners.map(widen);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let distance = normal.dot(a - view.eye()) as f32;
            for p in corners {
                data.extend(p);
                data.extend(narrow(normal));
                data.push(distance);
            }
        }
        let vertices = Arc::new(VertexBuffer { data, stride: 7 });
        let indices = (0..vertices.len() as u32).collect();
        Draw::indexed(
            &self.object.name,
            &Arc::new(pipeline),
            &vertices,
            &Arc::new(IndexBuffer::new(indices)),
        )
    }

    fn draw(&self, pipeline: RenderPipeline) -> Draw {
        Draw::indexed(
            &self.object.name,
            &Arc::new(pipeline),
            &self.vertices,
            &self.indices,
        )
    }
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
pub(super) fn clamped() -> PrimitiveState {
    PrimitiveState {
        depth_clamp: true,
        ..PrimitiveState::default()
    }
}

/// The camera's transform, and the origin that it is relative to.
pub(super) struct View {
    pub(super) clip_from_world: ClipFromWorld,
    /// In world space; world-space inputs of shaders are relative to it.
    origin: DVec3,
    camera: Camera,
    size: [u32; 2],
}

impl View {
    pub(super) fn new(camera: &Camera, [width, height]: [u32; 2]) -> Self {
        let origin = origin(camera);
        let moved = Camera {
            eye: camera.eye - origin,
            target: camera.target - origin,
            ..*camera
        };
        let aspect = f64::from(width) / f64::from(height);
        Self {
            clip_from_world: ClipFromWorld(moved.clip_from_world(aspect)),
            origin,
            camera: *camera,
            size: [width, height],
        }
    }

    /// The camera, world space.
    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The eye relative to the origin.
    pub(super) fn eye(&self) -> DVec3 {
        self.relative(self.camera.eye)
    }

    fn pixel_rays(&self) -> PixelRays {
        let [width, height] = self.size;
        let rays = self.camera.eye_rays(width, height);
        let first = rays.direction(0.0, 0.0);
        let across = rays.direction(f64::from(width), 0.0) - first;
        let down = rays.direction(0.0, f64::from(height)) - first;
        PixelRays {
            eye: narrow(self.eye()),
            first: narrow(first),
            right: narrow(across / f64::from(width)),
            down: narrow(down / f64::from(height)),
        }
    }

    /// A world-space position relative to the origin, as shaders have it.
    pub(super) fn relative(&self, p: DVec3) -> DVec3 {
        p - self.origin
    }

    /// A world-space position relative to the origin.
    pub(super) fn point(&self, p: [f32; 3]) -> [f32; 3] {
        narrow(widen(p) - self.origin)
    }

    /// The light as a homogeneous point relative to the origin.
    fn light(&self, light: HardLight) -> [f32; 4] {
        let ([x, y, z], w) = match light {
            HardLight::Point(p) => (narrow(p - self.origin), 1.0),
            HardLight::Directional(towards) => (narrow(towards), 0.0),
        };
        [x, y, z, w]
    }
}

/// Zero, or the eye rounded to a power of two near the distance it looks at,
/// if the eye is far from zero by that measure.
fn origin(camera: &Camera) -> DVec3 {
    let distance = (camera.target - camera.eye).length();
    if camera.eye.length() < 64.0 * distance {
        return DVec3::ZERO;
    }
    let mut step = 1.0;
    while step > distance {
        step /= 2.0;
    }
    while step * 2.0 <= distance {
        step *= 2.0;
    }
    (camera.eye / step).round() * step
}

pub(super) fn index_buffer(triangles: &[[u32; 3]]) -> Arc<IndexBuffer> {
    Arc::new(IndexBuffer::new(
        triangles.iter().flatten().copied().collect(),
    ))
}

fn lit_state(test: LitTest, receives: bool) -> DepthStencilState {
    match (test, receives) {
        (LitTest::StencilZero, true) => DepthStencilState::equal_where_stencil_matches(),
        (LitTest::StencilZero, false) => {
            let face = StencilFaceState {
                pass_op: StencilOperation::Zero,
                ..StencilFaceState::IGNORE
            };
            DepthStencilState {
                stencil: StencilState {
                    front: face,
                    back: face,
                },
                ..equal_depth()
            }
        }
        (LitTest::Everywhere | LitTest::Visibility(_), _) => equal_depth(),
    }
}

fn equal_depth() -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::Equal,
            write: false,
            bounds: None,
        },
        ..DepthStencilState::default()
    }
}
