//! Convolution soft shadows (Annen et al. 2008; docs/papers.md, Annen et al. 2008).
//!
//! Per light and view of it: the light view's depth becomes basis images (CSM, CSM-Z
//! and depth), these are prefiltered, and each receiver that the camera sees takes
//! means over two rectangles of them: over all that may lie between it and the light,
//! for the average depth of its blockers, and over what lies there at that depth, for
//! its visibility. The work per pixel does not depend on the light's size.
//!
//! Exact where light, blockers and receiver are parallel planes and blockers have one
//! depth, but for the finite expansion; elsewhere blockers are flattened to their
//! average depth.
//!
//! # Departures from the paper, and why
//!
//! * Constants of the ringing suppression are derived ([`crate::geometry::convolution`]).
//! * What a kernel covers beyond the light view's border is empty: views are fitted so
//!   that no caster in the way is outside.
//! * All terms' images of a kind are tiles of one texture, so that any order fits the
//!   texture slots. Look-ups count as the paper counts them: at M = 4 and mip chains
//!   six RGBA and one depth a pixel.
//! * Discs, spheres and polygons are squares of their area, which is said.

mod images;
mod needed;
mod prefilter;
mod settings;
#[cfg(test)]
mod tests;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState, Viewport,
};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::convolution::look_up::{
    BoxEdges, FloatTables, IntegerTables, Mipmaps, Prefiltered,
};
use gnomon_shaders::convolution::visibility::{ConvolutionShadow, Sharpening};
use gnomon_shaders::transform::FullScreen;

use self::images::{BasisTextures, filtered};
use self::needed::Needed;
use self::prefilter::Prefilter;
use self::settings::{Filter, Settings};
use crate::parts::horizon::{HORIZON, Horizon};
use crate::parts::maps::light_view::{
    CasterGeometry, Fitted, LightMap, Surroundings, ViewedLight, views_of,
};
use crate::parts::maps::lit_tiles::{FurtherLights, LitTiles};
use crate::parts::maps::mapped::{self, Hints, Notes, Said};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError, Warning};
use crate::world::light::{Light, LightShape};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ConvolutionSoftShadows;

impl Technique for ConvolutionSoftShadows {
    fn name(&self) -> &'static str {
        "convolution-soft-shadows"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by filtered shadow maps in a Fourier basis (Annen et al. 2008)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            settings::TERMS,
            settings::FILTER,
            settings::EDGES,
            settings::FORMAT,
            settings::MAP_SIZE,
            mapped::NEAR,
            mapped::VIEW,
            mapped::FIT,
            settings::RINGING,
            settings::OFFSET,
            settings::STRENGTH,
            settings::FALLOFF,
            settings::ITERATE,
            settings::THRESHOLD,
            settings::MIP_SHARPER,
            settings::PROBES,
            HORIZON,
            passes::LIGHT,
            settings::SKIP,
            passes::SHADING,
            passes::COLOR_FORMAT,
            passes::DEPTH_FORMAT,
        ];
        PARAMS
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let mut recording = Recording::default();
        let settings = Settings::new(self.name(), params)?;
        let draws = SceneDraws::new(scene, size, params);
        let shadows = Shadows {
            scene,
            size,
            targets: Targets::create(size, params, &mut recording)?,
            positions: Positions::create(size, &mut recording)?,
            visibility: visibility_texture(size, &mut recording)?,
            map: LightMap::create(settings.side, &mut recording)?,
            images: BasisTextures::create(self.name(), &settings, &mut recording)?,
            around: Surroundings::new(scene, size),
            draws,
            settings,
        };
        let lights = passes::lights(scene, params)?;
        let targets = &shadows.targets;
        let mut list = vec![
            shadows
                .draws
                .ambient_pass_with_positions(targets, &shadows.positions),
        ];
        let mut notes = Notes::default();
        let visibility = VisibilityTexture::red(shadows.visibility);
        let (around, view) = (&shadows.around, &shadows.draws.view);
        let further = FurtherLights::new(scene, around, view, &lights, shadows.settings.skip);
        for &light in lights.iter().rev() {
            let label = |what: &str| passes::label(what, light, &lights);
            let viewed = ViewedLight::new(self.name(), &scene.lights[light], light)?;
            let tiles = further.tiles(light);
            list.extend(shadows.light_passes(&viewed, tiles.as_ref(), &label, &mut notes));
            notes
                .warnings
                .extend(square_instead(&scene.lights[light], light));
            let horizon = Horizon::wanted(self.name(), light, &scene.lights[light], false, params)?;
            list.extend(horizon.pass(label("horizon"), &shadows.draws, targets, visibility));
            let test = LitTest::Visibility(visibility);
            list.push(shadows.draws.lit_pass(targets, light, &label("lit"), test));
        }
        let mut frame = shadows
            .targets
            .frame(recording, list, visibility.output())?;
        frame.warnings = notes.warnings;
        frame.figures = notes.figures;
        Ok(frame)
    }
}

fn visibility_texture(
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
    Ok(recording.create(&desc)?)
}

/// Lights that are no parallelograms.
fn square_instead(light: &Light, number: usize) -> Option<Warning> {
    let shape = match light.shape {
        LightShape::Disc { .. } => "disc",
        LightShape::Sphere { .. } => "sphere",
        LightShape::Polygon(_) => "polygon",
        _ => return None,
    };
    Some(Warning {
        code: "light-as-square",
        count: 1,
        message: format!(
            "light {number} is a {shape}; convolution takes rectangles, so a square of its area stands for it"
        ),
    })
}

/// What all lights of a frame share.
struct Shadows<'a> {
    scene: &'a Scene,
    size: [u32; 2],
    settings: Settings,
    draws: SceneDraws<'a>,
    targets: Targets,
    positions: Positions,
    visibility: TextureId,
    map: LightMap,
    images: BasisTextures,
    around: Surroundings<'a>,
}

impl Shadows<'_> {
    /// All passes that leave a light's visibility behind.
    fn light_passes(
        &self,
        light: &ViewedLight,
        tiles: Option<&LitTiles>,
        label: &dyn Fn(&str) -> String,
        notes: &mut Notes,
    ) -> Vec<RenderPass> {
        if let Some(tiles) = tiles {
            notes.skipped(tiles, label);
            if tiles.is_empty() {
                return vec![self.shadow_pass(label("look-up"), true, Vec::new())];
            }
        }
        let Settings { views, fitting, .. } = self.settings;
        let hints = Hints::of(views, fitting.near);
        let found = views_of(light, &self.around, views, &fitting);
        let geometry = CasterGeometry::new(
            self.scene,
            &self.around,
            &self.draws.view,
            light.reference(&self.around),
        );
        let (mut list, mut said) = (Vec::new(), Said::default());
        said.missing = found.missing;
        for fitted in &found.views {
            said.add(fitted, self.offset(fitted), self.settings.side);
            let (passes, draw) = self.view_passes(light, fitted, tiles, &geometry, label);
            let first = list.is_empty();
            list.extend(passes);
            list.push(self.shadow_pass(label("look-up"), first, vec![draw]));
        }
        if list.is_empty() {
            list.push(self.shadow_pass(label("look-up"), true, Vec::new()));
        }
        said.into_notes(0.0, hints, label, notes);
        list
    }

    /// What the series takes off receivers' depths, world units.
    fn offset(&self, fitted: &Fitted) -> f64 {
        let [near, far] = fitted.range;
        let series = &self.settings.series;
        series.offset() / series.reach() * (far - near)
    }

    /// A view's picture and what is made of it, and the draw that looks it up.
    fn view_passes(
        &self,
        light: &ViewedLight,
        fitted: &Fitted,
        tiles: Option<&LitTiles>,
        geometry: &CasterGeometry,
        label: &dyn Fn(&str) -> String,
    ) -> (Vec<RenderPass>, Draw) {
        let settings = &self.settings;
        let reads = fitted.reads(&self.around, light.extent);
        let needed = match reads.filter(|_| settings.skip) {
            Some(reads) => Needed::of(&reads, settings.side, settings.filter),
            None => Needed::all(settings.side),
        };
        let view = label("light view");
        let mut list =
            vec![fitted.pass(view, geometry, &self.draws.view, &self.map, settings.skip)];
        let prefilter = Prefilter {
            settings,
            images: &self.images,
            view: self.map.depth,
            needed: &needed,
        };
        let (passes, images) = prefilter.passes(label);
        list.extend(passes);
        let draw = self.shadow_draw(self.shader(light, fitted), tiles, images);
        (list, draw)
    }

    /// Visibility where something is in the light's way; 1 elsewhere.
    fn shadow_pass(&self, label: String, clear: bool, draws: Vec<Draw>) -> RenderPass {
        let load = if clear {
            LoadOp::Clear([1.0; 4])
        } else {
            LoadOp::Load
        };
        RenderPass {
            label,
            color: vec![attachment(self.visibility, load)],
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        }
    }

    /// At every pixel that shows a surface.
    fn shadow_draw(
        &self,
        shader: FragmentStage,
        tiles: Option<&LitTiles>,
        images: [TextureId; 3],
    ) -> Draw {
        let pipeline = RenderPipeline {
            label: "look-up".to_owned(),
            vertex: FullScreen.stage(),
            fragment: Some(shader),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState {
                depth: DepthState {
                    compare: CompareFunction::Greater,
                    write: false,
                    bounds: None,
                },
                ..DepthStencilState::default()
            },
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let mut textures = vec![binding(self.positions.texture)];
        textures.extend(images.map(|i| filtered(i, self.settings.filter)));
        let [width, height] = self.size;
        Draw {
            viewport: Some(Viewport {
                min_depth: 1.0,
                ..Viewport::full(width, height)
            }),
            ..match tiles {
                Some(tiles) => tiles.draw(pipeline, textures),
                None => full_screen(pipeline, textures),
            }
        }
    }

    fn shader(&self, light: &ViewedLight, fitted: &Fitted) -> FragmentStage {
        let settings = &self.settings;
        let half = [0, 1].map(|k| light.extent.half_along(fitted.frame.axes[k]));
        let edges = if settings.snapped {
            BoxEdges::Texel
        } else {
            BoxEdges::Exact
        };
        let side = settings.side;
        match settings.filter {
            Filter::Mip => {
                let mipmaps = mipmaps(half, settings);
                self.with(fitted, half, mipmaps).stage()
            }
            Filter::Sat | Filter::SatMean => {
                let tables = FloatTables {
                    side,
                    edges,
                    centred: settings.filter == Filter::SatMean,
                };
                self.with(fitted, half, tables).stage()
            }
            Filter::SatU32 => {
                let tables = IntegerTables { side, edges };
                self.with(fitted, half, tables).stage()
            }
        }
    }

    fn with<P: Prefiltered>(
        &self,
        fitted: &Fitted,
        half: [f64; 2],
        prefiltered: P,
    ) -> ConvolutionShadow<P> {
        let settings = &self.settings;
        let series = &self.images.series;
        ConvolutionShadow {
            mapping: fitted.mapping(&self.draws.view, settings.side),
            light_half: half.map(|h| h as f32),
            expansion: settings.series.expansion(),
            prefiltered,
            csm: series.images(0, 1),
            csm_z: series.images(1, 2),
            depth: self.images.depth.images(0, 3),
            threshold: settings.threshold,
            iterations: settings.iterations,
            sharpening: Sharpening {
                strength: settings.strength,
                falloff: settings.falloff,
            },
        }
    }
}

/// As many squares along the longer side as the light is longer than wide.
fn mipmaps(half: [f64; 2], settings: &Settings) -> Mipmaps {
    /// What hardware filters at most.
    const MOST: f64 = 16.0;
    let along = if half[0] < half[1] { 1 } else { 0 };
    let aspect = half[along] / half[1 - along];
    let probes = if aspect.is_finite() {
        aspect.round().clamp(1.0, MOST)
    } else {
        1.0
    };
    Mipmaps {
        side: settings.side,
        lod_bias: -settings.sharper as f32,
        probes: settings.probes.unwrap_or(probes as u32),
        along,
    }
}
