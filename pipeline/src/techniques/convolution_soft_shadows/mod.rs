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
//! * Discs, spheres and polygons are squares of their area, and parallelograms that are no
//!   rectangles the rectangles about them, which is said.
//! * Receivers' depths are lessened by what their planes gain over a kernel, and limited by
//!   their horizon (`plane-offset=0`, `horizon=off`: the paper's form).

mod images;
mod prefilter;
mod settings;
#[cfg(test)]
mod tests;

use glam::DVec3;
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
use gnomon_shaders::convolution::visibility::{ConvolutionShadow, PlaneOffset, Sharpening};
use gnomon_shaders::transform::FullScreen;

use self::images::{BasisTextures, filtered};
use self::prefilter::Prefilter;
use self::settings::{Filter, Settings};
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::maps::light_view::{
    CasterGeometry, Fitted, LightMap, Surroundings, ViewedLight, views_of,
};
use crate::parts::maps::lit_tiles::{FurtherLights, LitTiles};
use crate::parts::maps::mapped::{Hints, MapNotes, ViewSettings, ViewsOfLight};
use crate::parts::passes::{LitTest, Targets, View};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{
    Capabilities, Frame, ParamInfo, Params, Pass, PassRole, ShadowKind, Technique, TechniqueError,
    Warning,
};
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
        param_list!(
            Settings::PARAMS,
            ViewSettings::PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(params)?;
        let frame = ShadowedFrame::new(scene, size, &settings.frame)?;
        let frame = frame.with_horizon(settings.horizon, false);
        let (mut frame, positions) = match settings.plane_offset > 0.0 {
            true => frame.with_positions_and_planes()?,
            false => frame.with_positions()?,
        };
        let recording = &mut frame.recording;
        let shadows = Shadows {
            size,
            positions,
            visibility: visibility_texture(size, recording)?,
            map: LightMap::create(settings.side, recording)?,
            images: BasisTextures::create(self.name(), &settings, recording)?,
            around: Surroundings::new(scene, size),
            view: View::new(&scene.camera, size),
            settings,
        };
        let lights = frame.lights.clone();
        let (around, view) = (&shadows.around, &shadows.view);
        let further = FurtherLights::new(scene, around, view, &lights, settings.skip);
        let visibility = VisibilityTexture::red(shadows.visibility);
        frame.lit(LitTest::Visibility(visibility), |turn| {
            let (light, number) = (turn.light(), turn.number);
            let viewed = ViewedLight::new(self.name(), light, number)?;
            let passes = shadows.light_passes(&viewed, further.tiles(number).as_ref(), turn);
            turn.notes.warnings.extend(square_instead(light, number));
            Ok(passes)
        })
    }
}

fn visibility_texture(
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
    Ok(recording.create(&desc)?)
}

/// Lights that are no rectangles.
fn square_instead(light: &Light, number: usize) -> Option<Warning> {
    let warning = |code, what: &str| Warning {
        code,
        count: 1,
        message: format!("light {number} is a {what}"),
    };
    let square = "convolution takes rectangles, so a square of its area stands for it";
    let square = |shape: &str| warning("light-as-square", &format!("{shape}; {square}"));
    match light.shape {
        LightShape::Disc { .. } => Some(square("disc")),
        LightShape::Sphere { .. } => Some(square("sphere")),
        LightShape::Polygon(_) => Some(square("polygon")),
        LightShape::Rectangle { edge_u, edge_v, .. } if is_sheared(edge_u, edge_v) => {
            let what = "parallelogram whose edges are not at right angles; convolution takes \
                rectangles, so the one about it stands for it";
            Some(warning("light-as-rectangle", what))
        }
        _ => None,
    }
}

/// Whether the angle between edges is off a right one by more than a twentieth of a degree.
fn is_sheared(u: DVec3, v: DVec3) -> bool {
    const COSINE: f64 = 1e-3;
    u.dot(v).abs() > COSINE * u.length() * v.length()
}

/// What all lights of a frame share.
struct Shadows<'a> {
    size: [u32; 2],
    settings: Settings,
    view: View,
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
        turn: &mut LightTurn<'_, '_>,
    ) -> Vec<Pass> {
        let label = turn.labels();
        let shadow_pass = |targets: &Targets, first, draws| {
            self.shadow_pass(targets, label("look-up"), first, draws)
        };
        let mut notes = MapNotes::new(turn.notes, &label);
        if let Some(tiles) = tiles {
            notes.skipped(tiles);
            if tiles.is_empty() {
                return vec![shadow_pass(turn.targets, true, Vec::new())];
            }
        }
        let ViewSettings { views, fitting } = self.settings.view;
        let hints = Hints::of(views, fitting.near);
        let found = views_of(light, &self.around, views, &fitting);
        let reference = light.reference(&self.around);
        let geometry = CasterGeometry::new(turn.scene, &self.around, &self.view, reference);
        let (mut list, mut counted) = (Vec::new(), ViewsOfLight::default());
        counted.missing = found.missing;
        for fitted in &found.views {
            counted.add(fitted, self.offset(fitted), self.settings.side);
            let (passes, draw) = self.view_passes(light, fitted, tiles, &geometry, &label);
            let first = list.is_empty();
            list.extend(passes);
            list.push(shadow_pass(turn.targets, first, vec![draw]));
        }
        if list.is_empty() {
            list.push(shadow_pass(turn.targets, true, Vec::new()));
        }
        notes.add(counted, 0.0, hints);
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
    ) -> (Vec<Pass>, Draw) {
        let settings = &self.settings;
        let picture = fitted.pass(
            label("light view"),
            geometry,
            &self.view,
            &self.map,
            settings.skip,
        );
        let mut list = vec![Pass::new(PassRole::LightView, picture)];
        let prefilter = Prefilter {
            settings,
            images: &self.images,
            view: self.map.depth,
        };
        let (passes, images) = prefilter.passes(label);
        let filtered = |pass| Pass::new(PassRole::Prefilter, pass);
        list.extend(passes.into_iter().map(filtered));
        let draw = self.shadow_draw(self.shader(light, fitted), tiles, images);
        (list, draw)
    }

    /// Visibility where something is in the light's way; 1 elsewhere.
    fn shadow_pass(&self, targets: &Targets, label: String, clear: bool, draws: Vec<Draw>) -> Pass {
        let load = if clear {
            LoadOp::Clear([1.0; 4])
        } else {
            LoadOp::Load
        };
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility, load)],
            depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        };
        Pass::new(PassRole::LookUp, pass)
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
        textures.extend(self.positions.planes.map(binding));
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
            mapping: fitted.mapping(&self.view, settings.side),
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
            plane_offset: (settings.plane_offset > 0.0).then(|| PlaneOffset {
                planes: fitted.planes(),
                first: settings.plane_offset * FIRST_SHARE,
                last: settings.plane_offset,
                most: MOST_OFFSET,
            }),
        }
    }
}

/// Where the average depth of blockers is looked for, receivers' depths are lessened by
/// this share of what they are for visibility.
const FIRST_SHARE: f32 = 0.5;
/// Largest offset of a receiver's depth, over the light view's range: beyond, blockers
/// come near the other half of the series' period.
const MOST_OFFSET: f32 = 0.2;

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
