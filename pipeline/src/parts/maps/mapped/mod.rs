//! What techniques on light views share: parameters, and the frame round them.
//!
//! Per light: visibility starts at 1; then for each view a pass with its picture
//! ("light view") and one that looks shadows up in it ("look-up"), one texture
//! serving all views in turn; then the lit pass.

mod notes;
mod params;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::light_view::LightMapping;
use gnomon_shaders::shadow_maps::{Shadow, ShadowTo};
use gnomon_shaders::transform::FullScreen;

pub(crate) use notes::{Hints, Notes, Said};
pub(crate) use params::MapParams;
pub(crate) use params::{
    BIAS, FIT, MAP_SIZE, Margin, NEAR, SKIP, SLOPE_BIAS, VIEW, pattern, square_side,
};

use super::light_view::{CasterGeometry, Fitted, LightMap, Surroundings, ViewedLight, views_of};
use super::lit_tiles::{FurtherLights, LitTiles};
use crate::parts::horizon::Horizon;
use crate::parts::passes::{self, LitTest, SceneDraws, Targets, View};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{Frame, Params, TechniqueError};
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
    pub(crate) params: &'a Params,
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
        let maps = MapParams::new(self.name, self.params)?;
        let lights = passes::lights(self.scene, self.params)?;
        let mut recording = Recording::default();
        let targets = Targets::create(self.size, self.params, &mut recording)?;
        let around = Surroundings::new(self.scene, self.size);
        let sources = lights.iter().map(|l| sources(*l));
        let sources = sources.collect::<Result<Vec<_>, _>>()?;
        let by_planes = |s: &Sources| self.margin.planes || s.are_far(&around);
        let positions = match sources.iter().any(by_planes) {
            true => Positions::with_planes(self.size, &mut recording)?,
            false => Positions::create(self.size, &mut recording)?,
        };
        let [width, height] = self.size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(recording.create(&desc)?);
        let mut map = LightMap::create(maps.fitting.size, &mut recording)?;
        let draws = SceneDraws::new(self.scene, self.size, self.params);
        let mut list = vec![draws.ambient_pass_with_positions(&targets, &positions)];
        let mut notes = Notes::default();
        let further = FurtherLights::new(self.scene, &around, &draws.view, &lights, maps.skip);
        for (&light, sources) in lights.iter().zip(&sources).rev() {
            let planes = by_planes(sources);
            let slope = if planes { 0.0 } else { self.margin.slope };
            map.slope = maps.slope_bias.unwrap_or(slope);
            let tiles = further.tiles(light);
            let one = OneLight {
                scene: self.scene,
                view: &draws.view,
                around: &around,
                maps: &maps,
                map,
                positions,
                planes,
                visibility,
                margin: self.margin,
                tiles: tiles.as_ref(),
                label: &|what| passes::label(what, light, &lights),
            };
            list.extend(one.passes(sources, &shader, &mut notes));
            let label = |what: &str| passes::label(what, light, &lights);
            let shone = &self.scene.lights[light];
            let horizon = Horizon::wanted(self.name, light, shone, false, self.params)?;
            list.extend(horizon.pass(label("horizon"), &draws, &targets, visibility));
            let test = LitTest::Visibility(visibility);
            list.push(draws.lit_pass(&targets, light, &label("lit"), test));
        }
        let mut frame = targets.frame(recording, list, visibility.output())?;
        frame.warnings = notes.warnings;
        frame.figures = notes.figures;
        Ok(frame)
    }
}

/// Views and look-ups of one light.
struct OneLight<'a> {
    scene: &'a Scene,
    view: &'a View,
    around: &'a Surroundings<'a>,
    maps: &'a MapParams,
    map: LightMap,
    positions: Positions,
    /// Whether texels are held against receivers' planes.
    planes: bool,
    visibility: VisibilityTexture,
    margin: Margin,
    /// Where shadows matter; `None`: everywhere.
    tiles: Option<&'a LitTiles>,
    label: &'a dyn Fn(&str) -> String,
}

impl OneLight<'_> {
    fn passes(
        &self,
        sources: &Sources,
        shader: &impl Fn(&LookUp<'_>) -> FragmentStage,
        notes: &mut Notes,
    ) -> Vec<RenderPass> {
        if let Some(tiles) = self.tiles {
            notes.skipped(tiles, self.label);
        }
        let nowhere = self.tiles.is_some_and(LitTiles::is_empty);
        let Some(first) = sources.lights.first().filter(|_| !nowhere) else {
            return vec![self.look_up(LoadOp::Clear([1.0; 4]), None)];
        };
        let reference = first.reference(self.around);
        let geometry = CasterGeometry::new(self.scene, self.around, self.view, reference);
        let mut passes = Vec::new();
        let mut load = LoadOp::Clear([1.0; 4]);
        let mut said = Said::default();
        for light in &sources.lights {
            let maps = self.maps;
            let found = views_of(light, self.around, maps.views, &maps.fitting);
            said.missing += found.missing;
            for fitted in found.views {
                let bias = maps.bias(&fitted, self.margin);
                said.add(&fitted, bias, maps.fitting.size);
                let label = (self.label)("light view");
                passes.push(fitted.pass(label, &geometry, self.view, &self.map, maps.skip));
                let look_up = LookUp {
                    fitted: &fitted,
                    light,
                    mapping: fitted.mapping(self.view, maps.fitting.size),
                    bias,
                    planes: self.planes,
                    share: 1.0 / sources.lights.len() as f32,
                };
                let stage = shader(&look_up);
                passes.push(self.look_up(load, Some((stage, sources.blend))));
                load = LoadOp::Load;
            }
        }
        if passes.is_empty() {
            passes.push(self.look_up(load, None));
        }
        let (views, near) = (self.maps.views, self.maps.fitting.near);
        let hints = Hints::of(views, near);
        said.into_notes(self.map.slope, hints, self.label, notes);
        passes
    }

    /// Looks shadows up in the picture; without a shader all is lit.
    fn look_up(
        &self,
        load: LoadOp<[f32; 4]>,
        shader: Option<(FragmentStage, ColorTargetState)>,
    ) -> RenderPass {
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
        RenderPass {
            label: (self.label)("look-up"),
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: shader.into_iter().map(draw).collect(),
        }
    }
}
