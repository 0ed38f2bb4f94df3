//! What techniques on light views share: parameters, and the frame round them.
//!
//! Per light: visibility starts at 1; then for each view a pass with its picture
//! ("light view") and one that looks shadows up in it ("look-up"), one texture
//! serving all views in turn; then the lit pass.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::light_view::LightMapping;
use gnomon_shaders::transform::FullScreen;

use super::light_view::{
    CasterGeometry, FitTo, Fitted, Fitting, LightMap, Surroundings, ViewedLight, Views, views_of,
};
use super::passes::{self, LitTest, SceneDraws, Targets, View};
use super::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::scene::Scene;
use crate::technique::{Figure, Frame, ParamInfo, Params, TechniqueError, TextureSource, Warning};

pub(super) const MAP_SIZE: ParamInfo = ParamInfo {
    name: "map-size",
    default: "512",
    valid: "16|32|64|128|256|512|1024|2048|4096",
    summary: "texels along a side of a light view",
};

pub(super) const BIAS: ParamInfo = ParamInfo {
    name: "bias",
    default: "auto",
    valid: "auto|X",
    summary: "by how much a blocker is nearer to the light, world units; auto: a share of a texel",
};

pub(super) const SLOPE_BIAS: ParamInfo = ParamInfo {
    name: "slope-bias",
    default: "auto",
    valid: "auto|X",
    summary: "texels over which a caster's slope is taken to push it away from the light",
};

pub(super) const NEAR: ParamInfo = ParamInfo {
    name: "near",
    default: "auto",
    valid: "auto|X",
    summary: "casters nearer to the light than this are not looked at, world units above 0",
};

pub(super) const VIEW: ParamInfo = ParamInfo {
    name: "view",
    default: "auto",
    valid: "auto|planar|cube",
    summary: "a view along the light's normal to each side, or cube faces where that is too wide",
};

pub(super) const FIT: ParamInfo = ParamInfo {
    name: "fit",
    default: "casters",
    valid: "casters|receivers",
    summary: "views hold the casters that matter, or all receivers seen and what filters read there",
};

pub(super) const SKIP: ParamInfo = ParamInfo {
    name: "skip",
    default: "on",
    valid: "on|off",
    summary: "leave out casters outside a light view; same bits",
};

/// The checked values of the parameters above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MapParams {
    pub(super) fitting: Fitting,
    pub(super) views: Views,
    /// `None`: in proportion to the texels.
    bias: Option<f64>,
    slope_bias: Option<f64>,
    skip: bool,
}

impl MapParams {
    pub(super) fn new(technique: &'static str, params: &Params) -> Result<Self, TechniqueError> {
        let near = decimal(params, NEAR);
        if near == Some(0.0) {
            return Err(TechniqueError::BadValue {
                technique,
                key: NEAR.name,
                value: params.get(NEAR.name).to_owned(),
                valid: "auto and numbers above 0",
            });
        }
        Ok(Self {
            fitting: Fitting {
                size: params.get(MAP_SIZE.name).parse().unwrap_or(512),
                near,
                to: match params.get(FIT.name) {
                    "receivers" => FitTo::Receivers,
                    _ => FitTo::Casters,
                },
            },
            views: match params.get(VIEW.name) {
                "planar" => Views::Planar,
                "cube" => Views::Cube,
                _ => Views::Auto,
            },
            bias: decimal(params, BIAS),
            slope_bias: decimal(params, SLOPE_BIAS),
            skip: params.get(SKIP.name) != "off",
        })
    }

    /// The bias of a view, world units.
    fn bias(&self, fitted: &Fitted, margin: Margin) -> f64 {
        let texel = fitted.texel(self.fitting.size) * fitted.range[1];
        self.bias.unwrap_or(texel * margin.bias)
    }
}

/// What keeps surfaces from shadowing themselves, where it is not given. Each
/// technique's is what was best against the exact oracle on the built-in scenes:
/// less leaves dots on surfaces seen steeply from the light, more parts shadows
/// from their casters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Margin {
    /// Bias in texels' widths at the farthest receiver.
    pub(super) bias: f64,
    /// Slope bias in texels.
    pub(super) slope: f64,
}

impl Margin {
    /// For one texel: the farthest point of it is half a texel off in both axes.
    pub(super) const ONE_TEXEL: Self = Self {
        bias: 0.25,
        slope: 0.5,
    };
}

/// A decimal parameter; `None` for a word.
fn decimal(params: &Params, info: ParamInfo) -> Option<f64> {
    params.get(info.name).parse().ok()
}

/// A view for which shadows are looked up.
pub(super) struct LookUp<'a> {
    pub(super) fitted: &'a Fitted,
    pub(super) light: &'a ViewedLight,
    pub(super) mapping: LightMapping,
    /// Of all the light's points, where it is looked at from several.
    pub(super) share: f32,
}

impl LookUp<'_> {
    /// Half width of the light along the picture's axes, world units.
    pub(super) fn light_half(&self) -> [f32; 2] {
        let axes = self.fitted.frame.axes;
        [0, 1].map(|k| self.light.extent.half_along(axes[k]) as f32)
    }
}

/// What is drawn for one light: its points, each with a share, or one for all.
pub(super) struct Sources {
    pub(super) lights: Vec<ViewedLight>,
    /// How look-ups of several are combined.
    pub(super) blend: ColorTargetState,
}

/// The frame of a technique that looks shadows up with a shader for each view.
pub(super) struct Mapped<'a> {
    pub(super) name: &'static str,
    pub(super) scene: &'a Scene,
    pub(super) size: [u32; 2],
    pub(super) params: &'a Params,
    pub(super) margin: Margin,
}

impl Mapped<'_> {
    /// `sources` gives the points of a light that views are taken from; `shader`
    /// reads positions in slot 0 and depths in slot 1, with the bias given.
    pub(super) fn frame(
        &self,
        textures: &mut dyn TextureSource,
        sources: impl Fn(usize) -> Result<Sources, TechniqueError>,
        shader: impl Fn(&LookUp<'_>, f32) -> FragmentStage,
    ) -> Result<Frame, TechniqueError> {
        let maps = MapParams::new(self.name, self.params)?;
        let lights = passes::lights(self.scene, self.params)?;
        let targets = Targets::create(self.size, self.params, textures)?;
        let positions = Positions::create(self.size, textures)?;
        let [width, height] = self.size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(textures.create(&desc)?);
        let mut map = LightMap::create(maps.fitting.size, textures)?;
        map.slope = maps.slope_bias.unwrap_or(self.margin.slope);
        let draws = SceneDraws::new(self.scene, self.size, self.params);
        let around = Surroundings::new(self.scene, self.size);
        let mut list = vec![draws.ambient_pass_with_positions(&targets, &positions)];
        let mut notes = Notes::default();
        for &light in lights.iter().rev() {
            let sources = sources(light)?;
            let one = OneLight {
                scene: self.scene,
                view: &draws.view,
                around: &around,
                maps: &maps,
                map,
                positions,
                visibility,
                margin: self.margin,
                label: &|what| passes::label(what, light, &lights),
            };
            list.extend(one.passes(&sources, &shader, &mut notes));
            let label = passes::label("lit", light, &lights);
            let test = LitTest::Visibility(visibility);
            list.push(draws.lit_pass(&targets, light, &label, test));
        }
        let mut frame = targets.frame(list, visibility.output());
        frame.warnings = notes.warnings;
        frame.figures = notes.figures;
        Ok(frame)
    }
}

/// What is said of the views of a frame.
#[derive(Default)]
pub(super) struct Notes {
    pub(super) warnings: Vec<Warning>,
    pub(super) figures: Vec<Figure>,
}

/// Views and look-ups of one light.
struct OneLight<'a> {
    scene: &'a Scene,
    view: &'a View,
    around: &'a Surroundings<'a>,
    maps: &'a MapParams,
    map: LightMap,
    positions: Positions,
    visibility: VisibilityTexture,
    margin: Margin,
    label: &'a dyn Fn(&str) -> String,
}

impl OneLight<'_> {
    fn passes(
        &self,
        sources: &Sources,
        shader: &impl Fn(&LookUp<'_>, f32) -> FragmentStage,
        notes: &mut Notes,
    ) -> Vec<RenderPass> {
        let Some(first) = sources.lights.first() else {
            return vec![self.look_up(LoadOp::Clear([1.0; 4]), None)];
        };
        let geometry = CasterGeometry::new(self.scene, self.around, self.view, first.frame.centre);
        let mut passes = Vec::new();
        let mut load = LoadOp::Clear([1.0; 4]);
        let mut said = Said::default();
        for light in &sources.lights {
            let maps = self.maps;
            for fitted in views_of(light, self.around, maps.views, &maps.fitting) {
                let bias = maps.bias(&fitted, self.margin);
                said.add(&fitted, bias, maps.fitting.size);
                let label = (self.label)("light view");
                passes.push(fitted.pass(label, &geometry, self.view, &self.map, maps.skip));
                let look_up = LookUp {
                    fitted: &fitted,
                    light,
                    mapping: fitted.mapping(self.view, maps.fitting.size),
                    share: 1.0 / sources.lights.len() as f32,
                };
                let stage = shader(&look_up, bias as f32);
                passes.push(self.look_up(load, Some((stage, sources.blend))));
                load = LoadOp::Load;
            }
        }
        if passes.is_empty() {
            passes.push(self.look_up(load, None));
        }
        said.into_notes(self.map.slope, self.label, notes);
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
            let bindings = [self.positions.texture, self.map.depth].map(binding);
            full_screen(pipeline, bindings.to_vec())
        };
        RenderPass {
            label: (self.label)("look-up"),
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: shader.into_iter().map(draw).collect(),
        }
    }
}

/// What is to be said of a light's views, together.
#[derive(Default)]
pub(super) struct Said {
    views: usize,
    cut: usize,
    limited: usize,
    /// Largest of the views.
    bias: f64,
    texel: f64,
    range: Option<[f64; 2]>,
}

impl Said {
    pub(super) fn add(&mut self, fitted: &Fitted, bias: f64, size: u32) {
        self.views += 1;
        self.cut += fitted.cut;
        self.limited += usize::from(fitted.limited);
        self.bias = self.bias.max(bias);
        let [near, far] = fitted.range;
        self.texel = self.texel.max(fitted.texel(size) * far);
        let [nearest, farthest] = self.range.unwrap_or([near, far]);
        self.range = Some([nearest.min(near), farthest.max(far)]);
    }

    pub(super) fn into_notes(self, slope: f64, label: &dyn Fn(&str) -> String, notes: &mut Notes) {
        let mut figure = |name: &str, value: f64| {
            let name = label(name);
            notes.figures.push(Figure { name, value });
        };
        figure("views", self.views as f64);
        if let Some([near, far]) = self.range {
            figure("bias", self.bias);
            figure("slope-bias", slope);
            figure("texel", self.texel);
            figure("near", near);
            figure("far", far);
        }
        let mut warn = |code, count: usize, what: &str| {
            if count > 0 {
                let message = format!("{}: {count} {what}", label("light view"));
                notes.warnings.push(Warning {
                    code,
                    count,
                    message,
                });
            }
        };
        warn(
            "casters-at-near-distance",
            self.cut,
            "triangles of casters reach nearer to the light than is looked at and are cut there; \
             set near to less",
        );
        warn(
            "view-limited",
            self.limited,
            "views do not hold all casters that matter, for those are too near to the light or \
             beside it; try view=cube or a larger near",
        );
    }
}
