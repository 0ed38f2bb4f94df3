//! The passes that techniques share: ambient light with depth, and light added
//! per light source, over the same draws of the scene.
//!
//! What they are drawn to is in [`super::targets`], what is drawn in
//! `surface_draw`, and from where in [`super::view`].

use glam::DVec3;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{Draw, LoadOp, Recording, RenderPass, RenderPipeline};
use gnomon_shaders::surface::{
    AmbientWithNumber, AmbientWithPosition, Constant, Lambert, LeaningAmbient, Phong,
};
use gnomon_shaders::textured::{TexturedAmbient, TexturedSurfaces};
use gnomon_shaders::transform::{Facets, NumberedFacets, Points, Surfaces};

use super::frame_settings::{FrameSettings, Shading};
use super::lit_surface::LitSurface;
use super::surface_draw::SurfaceDraw;
pub(crate) use super::surface_draw::{clamped, index_buffer};
use super::surface_textures::SurfaceTextures;
pub use super::targets::{Targets, label};
pub use super::view::View;
use super::visibility::{Positions, VisibilityTexture, attachment, binding, first_target};
use crate::technique::{TechniqueError, VisibilityOutput};
use crate::world::mesh::narrow;
use crate::world::scene::{Material, Object, Scene};

/// Where a lit pass adds light, and how much of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LitTest {
    /// At every surface.
    Everywhere,
    /// Where the stencil is 0; objects that take no shadow set it to 0 first.
    StencilZero,
    /// At every surface, times the visibility in a texture; objects that take no
    /// shadow are fully lit.
    Visibility(VisibilityTexture),
}

impl LitTest {
    /// Where a frame finds the visibility of the last light lit so.
    pub fn output(self) -> VisibilityOutput {
        match self {
            Self::Everywhere => VisibilityOutput::Full,
            Self::StencilZero => VisibilityOutput::StencilZero,
            Self::Visibility(texture) => texture.output(),
        }
    }
}

/// All objects of a scene, ready to draw in any pass.
pub struct SceneDraws<'a> {
    scene: &'a Scene,
    /// The camera that all passes share.
    pub view: View,
    surfaces: Vec<SurfaceDraw<'a>>,
    highlights: bool,
}

impl<'a> SceneDraws<'a> {
    /// Of `scene` in a picture of `size`; the pictures on its surfaces go to `recording`.
    ///
    /// # Errors
    /// The GPU refuses a texture.
    pub fn new(
        scene: &'a Scene,
        size: [u32; 2],
        settings: &FrameSettings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let view = View::new(&scene.camera, size);
        let textures = SurfaceTextures::create(scene, recording)?;
        let drawn = scene
            .objects
            .iter()
            .filter(|o| !o.mesh.triangles().is_empty());
        Ok(Self {
            scene,
            surfaces: drawn
                .flat_map(|o| SurfaceDraw::of_object(scene, &view, o, &textures))
                .collect(),
            view,
            highlights: settings.shading == Shading::Phong,
        })
    }

    /// What is drawn of the scene, object after object.
    pub(crate) fn surfaces(&self) -> &[SurfaceDraw<'a>] {
        &self.surfaces
    }

    /// Whether materials have highlights.
    pub(crate) fn has_highlights(&self) -> bool {
        self.highlights
    }

    /// Clears all attachments, then draws ambient light and depth.
    pub fn ambient_pass(&self, targets: &Targets) -> RenderPass {
        let [r, g, b] = self.scene.background;
        let ambient = self.even_ambient();
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
            draws: (self.surfaces.iter().map(draw))
                .chain(self.textured_ambient(1))
                .collect(),
        }
    }

    /// Ambient light of surfaces with textures, over what the ambient pass drew of them;
    /// writes attachment 0 of `attachments`.
    fn textured_ambient(&self, attachments: usize) -> impl Iterator<Item = Draw> {
        let dark = self.scene.ambient == [0.0; 3] && self.scene.ambient_slope == [[0.0; 3]; 3];
        let surfaces = self.surfaces.iter();
        surfaces.filter(move |_| !dark).filter_map(move |s| {
            let textured = s.texture.as_ref()?;
            let light = self.ambient_light(s);
            let pipeline = RenderPipeline {
                label: "ambient with textures".into(),
                vertex: TexturedSurfaces(self.view.clip_from_world).stage(),
                fragment: Some(TexturedAmbient { light }.stage()),
                primitive: s.primitive.clone(),
                depth_stencil: equal_depth(),
                color_targets: first_target(attachments),
            };
            Some(s.draw_textured(pipeline, textured, None))
        })
    }

    /// All ambient light that a surface's own colour reflects.
    fn ambient_light(&self, s: &SurfaceDraw<'_>) -> LeaningAmbient {
        let albedo = s.material.albedo;
        let [r, g, b, _] = s.ambient(self.scene.ambient);
        let of = |c: usize| self.scene.ambient_slope[c].map(|v| v * albedo[c]);
        LeaningAmbient {
            even: [r, g, b],
            red: of(0),
            green: of(1),
            blue: of(2),
        }
    }

    /// The same, and writes where each pixel's surface is into `positions`: 16
    /// bytes a fragment, counted as colour traffic of attachment 1, and as many of
    /// attachment 2 where planes are wanted.
    pub fn ambient_pass_with_positions(
        &self,
        targets: &Targets,
        positions: &Positions,
    ) -> RenderPass {
        let rays = self.view.pixel_rays();
        let draw = |s: &SurfaceDraw<'_>| {
            let shader = AmbientWithPosition {
                ambient: s.ambient(self.even_ambient()),
                receives: s.object.receives,
                plane: positions.planes.is_some(),
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
                    color_targets: vec![ColorTargetState::OPAQUE; 1 + positions.textures().count()],
                },
            )
        };
        let mut pass = self.ambient_pass(targets);
        let cleared = |texture| attachment(texture, LoadOp::Clear([0.0; 4]));
        pass.color.extend(positions.textures().map(cleared));
        let textured = self.textured_ambient(pass.color.len());
        pass.draws = self.surfaces.iter().map(draw).chain(textured).collect();
        pass
    }

    /// Ambient light of the first pass: none where [`Self::leaning_ambient`] draws it.
    fn even_ambient(&self) -> [f32; 3] {
        if self.scene.ambient_slope == [[0.0; 3]; 3] {
            self.scene.ambient
        } else {
            [0.0; 3]
        }
    }

    /// Ambient light that depends on normals, over what the ambient pass drew; `None`
    /// where the scene has none such.
    pub(crate) fn leaning_ambient(&self, targets: &Targets) -> Option<RenderPass> {
        let slope = self.scene.ambient_slope;
        if slope == [[0.0; 3]; 3] {
            return None;
        }
        let draw = |s: &SurfaceDraw<'_>| {
            let shader = self.ambient_light(s);
            s.draw(RenderPipeline {
                label: "ambient from directions".into(),
                vertex: Surfaces(self.view.clip_from_world).stage(),
                fragment: Some(shader.stage()),
                primitive: s.primitive.clone(),
                depth_stencil: equal_depth(),
                color_targets: vec![ColorTargetState::ADDITIVE],
            })
        };
        Some(RenderPass {
            label: "ambient from directions".into(),
            color: targets.color(LoadOp::Load),
            depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: (self.surfaces.iter())
                .filter(|s| s.texture.is_none())
                .map(draw)
                .collect(),
        })
    }

    /// Clears and draws as [`Self::ambient_pass_with_positions`], with a number of each
    /// object's triangles for w of positions.
    pub(crate) fn ambient_pass_with_numbers(
        &self,
        targets: &Targets,
        positions: &Positions,
        number: &dyn Fn(&Object, u32) -> f32,
    ) -> RenderPass {
        let rays = self.view.pixel_rays();
        let draw = |s: &SurfaceDraw<'_>| {
            let ambient = s.ambient(self.even_ambient());
            let pipeline = RenderPipeline {
                label: "ambient".into(),
                vertex: NumberedFacets(self.view.clip_from_world).stage(),
                fragment: Some(AmbientWithNumber { ambient, rays }.stage()),
                primitive: s.primitive.clone(),
                depth_stencil: DepthStencilState::opaque(),
                color_targets: vec![ColorTargetState::OPAQUE; 2],
            };
            s.draw_numbered(&self.view, pipeline, &|t| number(s.object, t))
        };
        let mut pass = self.ambient_pass(targets);
        let clear = LoadOp::Clear([0.0; 4]);
        pass.color.push(attachment(positions.texture, clear));
        let textured = self.textured_ambient(pass.color.len());
        pass.draws = self.surfaces.iter().map(draw).chain(textured).collect();
        pass
    }

    /// Adds the light of light `light` to what the ambient pass drew.
    pub fn lit_pass(
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
            let surface = self.lit_surface(&s.material, light);
            let mut pipeline = RenderPipeline {
                label: label.to_owned(),
                vertex: Surfaces(self.view.clip_from_world).stage(),
                fragment: Some(surface.shader(visibility)),
                primitive: s.primitive.clone(),
                depth_stencil: lit_state(test, s.object.receives),
                color_targets: vec![ColorTargetState::ADDITIVE],
            };
            let before = visibility.iter().map(|v| binding(v.texture));
            if let Some(textured) = &s.texture {
                pipeline.vertex = TexturedSurfaces(self.view.clip_from_world).stage();
                pipeline.fragment = Some(surface.textured_shader(visibility));
                return s.draw_textured(pipeline, textured, before);
            }
            Draw {
                textures: before.collect(),
                ..s.draw(pipeline)
            }
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
    pub fn not_receiving(&self, label: &str, colour: [f32; 4]) -> Vec<Draw> {
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

    /// Draws of the facets that cast and take shadow and to which `flat` gives
    /// numbers, where they are seen; for a pass with one colour attachment and the
    /// depth of the frame.
    pub fn shadowed_facets(
        &self,
        label: &str,
        (fragment, target): (FragmentStage, ColorTargetState),
        flat: &dyn Fn([DVec3; 3]) -> Option<[f32; 4]>,
    ) -> Vec<Draw> {
        let both = |s: &&SurfaceDraw<'_>| s.object.casts && s.object.receives;
        let draw = |s: &SurfaceDraw<'_>| {
            let pipeline = RenderPipeline {
                label: label.to_owned(),
                vertex: Facets(self.view.clip_from_world).stage(),
                fragment: Some(fragment.clone()),
                primitive: s.primitive.clone(),
                depth_stencil: equal_depth(),
                color_targets: vec![target],
            };
            s.draw_flat(pipeline, flat)
        };
        let draws = self.surfaces.iter().filter(both).map(draw);
        draws
            .filter(|d| d.indices.as_ref().is_some_and(|i| !i.indices().is_empty()))
            .collect()
    }

    /// What a light does on a material.
    fn lit_surface(&self, material: &Material, light: usize) -> LitSurface {
        let light = &self.scene.lights[light];
        let coloured = |c: [f32; 3]| [0, 1, 2].map(|i| c[i] * light.colour[i]);
        let lambert = Lambert {
            diffuse: coloured(material.albedo),
            light: self.view.light(light.hard()),
        };
        if !self.highlights || material.specular == [0.0; 3] {
            return LitSurface::Lambert(lambert);
        }
        LitSurface::Phong(Phong {
            lambert,
            specular: coloured(material.specular),
            shininess: material.shininess,
            eye: narrow(self.view.eye()),
        })
    }
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

/// Where the surface is the one that is seen.
pub(crate) fn equal_depth() -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::Equal,
            write: false,
            bounds: None,
        },
        ..DepthStencilState::default()
    }
}
