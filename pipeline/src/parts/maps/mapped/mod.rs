//! What techniques on light views share: parameters, and the frame round them.
//!
//! Per light: visibility starts at 1; then for each view a pass with its picture
//! ("light view") and one that looks shadows up in it ("look-up"), one texture
//! serving all views in turn; then the lit pass.

mod notes;
mod settings;

use std::collections::BTreeMap;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::light_view::LightMapping;
use gnomon_shaders::shadow_maps::{Shadow, ShadowTo};
use gnomon_shaders::transform::FullScreen;

pub(crate) use notes::{Hints, MapNotes, ViewsOfLight};
pub(crate) use settings::{MAP_SIZE, MapSettings, Margin, SKIP, ViewSettings};

use super::light_view::{CasterGeometry, Fitted, LightMap, Surroundings, ViewedLight, views_of};
use super::lit_tiles::{FurtherLights, LitTiles};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::{LitTest, View};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{Frame, Pass, PassRole, TechniqueError};
use crate::world::scene::Scene;

/// A view in which shadows are looked up.
pub(crate) struct LookUp<'a> {
    fitted: &'a Fitted,
    light: &'a ViewedLight,
    mapping: LightMapping,
    bias: f64,
    /// Whether texels are held against receivers' planes.
    planes: bool,
    /// Of all the light's points, where it is looked at from several.
    share: f32,
}

impl LookUp<'_> {
    /// Half width of the light along the picture's axes, world units.
    pub(crate) fn light_half(&self) -> [f32; 2] {
        let axes = self.fitted.frame.axes;
        [0, 1].map(|k| self.light.extent.half_along(axes[k]) as f32)
    }

    /// What the light's only point says.
    pub(crate) fn whole<F>(&self, filter: F) -> Shadow<F> {
        Shadow {
            mapping: self.mapping,
            bias: self.bias as f32,
            planes: self.planes.then(|| self.fitted.planes()),
            filter,
            to: ShadowTo::Visibility,
        }
    }

    /// What one of several points adds.
    pub(crate) fn share<F>(&self, filter: F) -> Shadow<F> {
        Shadow {
            to: ShadowTo::Share(self.share),
            ..self.whole(filter)
        }
    }
}

/// Where a light is looked at from.
pub(crate) struct Sources {
    pub(crate) lights: Vec<ViewedLight>,
    /// How look-ups of several are combined.
    pub(crate) blend: ColorTargetState,
}

impl Sources {
    /// Whether receivers tell the light's place from a direction by a few digits only.
    fn are_far(&self, around: &Surroundings<'_>) -> bool {
        self.lights.first().is_some_and(|l| l.is_far(around))
    }

    /// The light's centre for all of it.
    pub(crate) fn centre(
        technique: &'static str,
        scene: &Scene,
        light: usize,
    ) -> Result<Self, TechniqueError> {
        let viewed = ViewedLight::new(technique, &scene.lights[light], light)?;
        Ok(Self {
            lights: vec![viewed],
            blend: ColorTargetState::OPAQUE,
        })
    }
}

/// The frame of a technique that looks shadows up with a shader for each view.
pub(crate) struct Mapped<'a> {
    pub(crate) name: &'static str,
    pub(crate) scene: &'a Scene,
    pub(crate) size: [u32; 2],
    pub(crate) frame: FrameSettings,
    pub(crate) maps: MapSettings,
    /// Limit what facets see to what is before them.
    pub(crate) horizon: bool,
    pub(crate) margin: Margin,
}

impl Mapped<'_> {
    /// `sources` gives the points of a light that views are taken from; `shader`
    /// reads positions in slot 0 and depths in slot 1.
    pub(crate) fn frame(
        &self,
        sources: impl Fn(usize) -> Result<Sources, TechniqueError>,
        shader: impl Fn(&LookUp<'_>) -> FragmentStage,
    ) -> Result<Frame, TechniqueError> {
        let around = Surroundings::new(self.scene, self.size);
        let frame = ShadowedFrame::new(self.scene, self.size, &self.frame)?;
        let frame = frame.with_horizon(self.name, self.horizon, false);
        let lights = frame.lights.clone();
        let sources = lights.iter().map(|l| Ok((*l, sources(*l)?)));
        let sources = sources.collect::<Result<BTreeMap<_, _>, TechniqueError>>()?;
        let by_planes = |s: &Sources| self.margin.planes || s.are_far(&around);
        let (mut frame, positions) = match sources.values().any(by_planes) {
            true => frame.with_positions_and_planes()?,
            false => frame.with_positions()?,
        };
        let [width, height] = self.size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(frame.recording.create(&desc)?);
        let mut map = LightMap::create(self.maps.view.fitting.size, &mut frame.recording)?;
        let view = View::new(&self.scene.camera, self.size);
        let further = FurtherLights::new(self.scene, &around, &view, &lights, self.maps.skip);
        frame.lit(LitTest::Visibility(visibility), |light| {
            let sources = &sources[&light.number];
            let planes = by_planes(sources);
            let slope = if planes { 0.0 } else { self.margin.slope };
            map.slope = self.maps.slope_bias.unwrap_or(slope);
            let tiles = further.tiles(light.number);
            let one = OneLight {
                view: &view,
                around: &around,
                maps: &self.maps,
                map,
                positions,
                planes,
                visibility,
                margin: self.margin,
                tiles: tiles.as_ref(),
            };
            Ok(one.passes(sources, &shader, light))
        })
    }
}

/// Views and look-ups of one light.
struct OneLight<'a> {
    view: &'a View,
    around: &'a Surroundings<'a>,
    maps: &'a MapSettings,
    map: LightMap,
    positions: Positions,
    /// Whether texels are held against receivers' planes.
    planes: bool,
    visibility: VisibilityTexture,
    margin: Margin,
    /// Where shadows matter; `None`: everywhere.
    tiles: Option<&'a LitTiles>,
}

impl OneLight<'_> {
    fn passes(
        &self,
        sources: &Sources,
        shader: &impl Fn(&LookUp<'_>) -> FragmentStage,
        turn: &mut LightTurn<'_, '_>,
    ) -> Vec<Pass> {
        let labels = turn.labels();
        let mut notes = MapNotes::new(turn.notes, &labels);
        if let Some(tiles) = self.tiles {
            notes.skipped(tiles);
        }
        let look_up = |load, shader| self.look_up(labels("look-up"), load, shader);
        let nowhere = self.tiles.is_some_and(LitTiles::is_empty);
        let Some(first) = sources.lights.first().filter(|_| !nowhere) else {
            return vec![look_up(LoadOp::Clear([1.0; 4]), None)];
        };
        let reference = first.reference(self.around);
        let geometry = CasterGeometry::new(turn.scene, self.around, self.view, reference);
        let mut passes = Vec::new();
        let mut load = LoadOp::Clear([1.0; 4]);
        let mut views = ViewsOfLight::default();
        let ViewSettings {
            views: kind,
            fitting,
        } = self.maps.view;
        for light in &sources.lights {
            let found = views_of(light, self.around, kind, &fitting);
            views.missing += found.missing;
            for fitted in found.views {
                let bias = self.maps.bias(&fitted, self.margin);
                views.add(&fitted, bias, fitting.size);
                let picture = fitted.pass(
                    labels("light view"),
                    &geometry,
                    self.view,
                    &self.map,
                    self.maps.skip,
                );
                passes.push(Pass::new(PassRole::LightView, picture));
                let stage = shader(&LookUp {
                    fitted: &fitted,
                    light,
                    mapping: fitted.mapping(self.view, fitting.size),
                    bias,
                    planes: self.planes,
                    share: 1.0 / sources.lights.len() as f32,
                });
                passes.push(look_up(load, Some((stage, sources.blend))));
                load = LoadOp::Load;
            }
        }
        if passes.is_empty() {
            passes.push(look_up(load, None));
        }
        notes.add(views, self.map.slope, Hints::of(kind, fitting.near));
        passes
    }

    /// Looks shadows up in the picture; without a shader all is lit.
    fn look_up(
        &self,
        label: String,
        load: LoadOp<[f32; 4]>,
        shader: Option<(FragmentStage, ColorTargetState)>,
    ) -> Pass {
        let draw = |(stage, blend)| {
            let pipeline = RenderPipeline {
                label: "look-up".into(),
                vertex: FullScreen.stage(),
                fragment: Some(stage),
                primitive: PrimitiveState::default(),
                depth_stencil: DepthStencilState::default(),
                color_targets: vec![blend],
            };
            let planes = self.positions.planes.filter(|_| self.planes);
            let textures = [self.positions.texture, self.map.depth].into_iter();
            let bindings = textures.chain(planes).map(binding).collect();
            match self.tiles {
                Some(tiles) => tiles.draw(pipeline, bindings),
                None => full_screen(pipeline, bindings),
            }
        };
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: shader.into_iter().map(draw).collect(),
        };
        Pass::new(PassRole::LookUp, pass)
    }
}
