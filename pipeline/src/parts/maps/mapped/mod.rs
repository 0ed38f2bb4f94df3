//! What techniques on light views share: parameters, and the frame round them.
//!
//! Per light: visibility starts at 1; then for each view a pass with its picture
//! ("light view") and one that looks shadows up in it ("look-up"), one texture
//! serving all views in turn; then the lit pass.

mod groups;
mod notes;
mod settings;

use std::collections::BTreeMap;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureBinding, TextureDescriptor,
    TextureId,
};
use gnomon_shaders::light_view::LightMapping;
use gnomon_shaders::shadow_maps::{Shadow, ShadowTo};
use gnomon_shaders::transform::FullScreen;

pub(crate) use notes::{Hints, MapNotes, ViewsOfLight};
pub(crate) use settings::{
    BIAS, FIT, MAP_SIZE, MapSettings, Margin, NEAR, Planes, SKIP, SLOPE_BIAS, VIEW, ViewSettings,
};

pub(crate) use groups::receivers_in_their_own_pictures;
use groups::{Group, ReceiverGroups};

use super::light_view::{
    CasterGeometry, Fitted, LightMap, Reads, Surroundings, ViewedLight, views_of,
};
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
    around: &'a Surroundings<'a>,
    /// Scaled depths.
    pub(crate) depths: TextureId,
    mapping: LightMapping,
    /// Adds the light's number where there are several.
    pub(crate) label: &'a dyn Fn(&str) -> String,
    bias: f64,
    /// Whether texels are held against receivers' planes.
    planes: bool,
    /// Of all the light's points, where it is looked at from several.
    share: f32,
    /// w of the positions of receivers; `None`: all.
    group: Option<f32>,
}

impl LookUp<'_> {
    /// Half width of the light along the picture's axes, world units.
    pub(crate) fn light_half(&self) -> [f32; 2] {
        let axes = self.fitted.frame.axes;
        [0, 1].map(|k| self.light.extent.half_along(axes[k]) as f32)
    }

    /// What of the picture filters read that are as wide as what lies between
    /// receivers and the light; `None` without receivers.
    pub(crate) fn reads(&self) -> Option<Reads> {
        self.fitted.reads(self.around, self.light.extent)
    }

    /// The nearest and the farthest distance of a caster in the picture, as shaders have
    /// distances.
    pub(crate) fn caster_distances(&self) -> [f64; 2] {
        let [near, far] = self.fitted.distances(self.around);
        [near, far].map(|z| z - self.fitted.base)
    }

    /// Bias, world units.
    pub(crate) fn bias(&self) -> f64 {
        self.bias
    }

    /// Slot of the first of [`Looked::textures`].
    pub(crate) fn first_slot(&self) -> usize {
        if self.planes { 3 } else { 2 }
    }

    /// What the light's only point says.
    pub(crate) fn whole<F>(&self, filter: F) -> Shadow<F> {
        Shadow {
            mapping: self.mapping,
            bias: self.bias as f32,
            planes: self.planes.then(|| self.fitted.planes()),
            filter,
            to: match self.group {
                Some(number) => ShadowTo::VisibilityOf(number),
                None => ShadowTo::Visibility,
            },
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

/// How shadows are looked up in a view.
pub(crate) struct Looked {
    /// What is made of the view's picture first.
    pub(crate) prefilter: Vec<RenderPass>,
    /// Reads positions in slot 0, depths in slot 1, planes, if there are any, in slot 2,
    /// then `textures`.
    pub(crate) stage: FragmentStage,
    pub(crate) textures: Vec<TextureBinding>,
    /// Numbers that were chosen for the view: of several, the least is reported.
    pub(crate) figures: Vec<(&'static str, f64)>,
    /// What was found amiss: code, what it is, and what can be done; the views of a light
    /// are counted.
    pub(crate) warnings: Vec<[&'static str; 3]>,
}

impl From<FragmentStage> for Looked {
    fn from(stage: FragmentStage) -> Self {
        Self {
            prefilter: Vec::new(),
            stage,
            textures: Vec::new(),
            figures: Vec::new(),
            warnings: Vec::new(),
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
    pub(crate) scene: &'a Scene,
    pub(crate) size: [u32; 2],
    pub(crate) frame: FrameSettings,
    pub(crate) maps: MapSettings,
    /// Limit what facets see to what is before them.
    pub(crate) horizon: bool,
    pub(crate) margin: Margin,
    /// Whether receivers have pictures without themselves.
    pub(crate) apart: bool,
}

impl Mapped<'_> {
    /// `sources` gives the points of a light that views are taken from; `shader`
    /// reads positions in slot 0 and depths in slot 1.
    pub(crate) fn frame(
        &self,
        sources: impl Fn(usize) -> Result<Sources, TechniqueError>,
        shader: impl Fn(&LookUp<'_>) -> FragmentStage,
    ) -> Result<Frame, TechniqueError> {
        self.prefiltered_frame(|_| Ok(()), sources, |(), l| shader(l).into())
    }

    /// The same with images made of each picture, in textures that `create` makes.
    pub(crate) fn prefiltered_frame<T>(
        &self,
        create: impl FnOnce(&mut Recording) -> Result<T, TechniqueError>,
        sources: impl Fn(usize) -> Result<Sources, TechniqueError>,
        looked: impl Fn(&T, &LookUp<'_>) -> Looked,
    ) -> Result<Frame, TechniqueError> {
        let around = Surroundings::new(self.scene, self.size);
        let apart = self.apart.then(|| ReceiverGroups::new(self.scene));
        let arounds = apart.as_ref().map(|g| g.around(self.size));
        let groups = groups_of(self.scene, &around, arounds.as_deref());
        let frame = ShadowedFrame::new(self.scene, self.size, &self.frame)?;
        let frame = frame.with_horizon(self.horizon, false);
        let lights = frame.lights.clone();
        let sources = lights.iter().map(|l| Ok((*l, sources(*l)?)));
        let sources = sources.collect::<Result<BTreeMap<_, _>, TechniqueError>>()?;
        let by_planes = |s: &Sources| match self.margin.planes {
            Planes::Never => false,
            Planes::Far => s.are_far(&around),
            Planes::Always => true,
        };
        let (mut frame, positions) = match (&apart, sources.values().any(by_planes)) {
            (Some(own), _) => frame.with_numbered_positions(&|object, t| own.number(object, t))?,
            (None, true) => frame.with_positions_and_planes()?,
            (None, false) => frame.with_positions()?,
        };
        let [width, height] = self.size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(frame.recording.create(&desc)?);
        let mut map = LightMap::create(self.maps.view.fitting.size, &mut frame.recording)?;
        let images = create(&mut frame.recording)?;
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
                groups: &groups,
                maps: &self.maps,
                map,
                positions,
                planes,
                visibility,
                margin: self.margin,
                tiles: tiles.as_ref(),
            };
            Ok(one.passes(sources, &|l: &LookUp<'_>| looked(&images, l), light))
        })
    }
}

/// Those that have pictures of their own, or all receivers as one.
fn groups_of<'a>(
    scene: &'a Scene,
    around: &'a Surroundings<'a>,
    apart: Option<&'a [(f32, &'a Scene, Surroundings<'a>)]>,
) -> Vec<Group<'a>> {
    let whole = Group {
        number: None,
        scene,
        around,
    };
    let own = |(number, scene, around): &'a (f32, &'a Scene, Surroundings<'a>)| Group {
        number: Some(*number),
        scene,
        around,
    };
    apart.map_or_else(|| vec![whole], |all| all.iter().map(own).collect())
}

/// A point of the light that looks at a group's occluders.
struct LightOfGroup<'a> {
    group: &'a Group<'a>,
    light: &'a ViewedLight,
    share: f32,
    blend: ColorTargetState,
}

/// Views and look-ups of one light.
struct OneLight<'a> {
    view: &'a View,
    around: &'a Surroundings<'a>,
    /// What pictures are made for, one after the other.
    groups: &'a [Group<'a>],
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
        looked: &impl Fn(&LookUp<'_>) -> Looked,
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
        let mut passes = Vec::new();
        let mut views = ViewsOfLight::default();
        for group in self.groups {
            let geometry = CasterGeometry::new(group.scene, group.around, self.view, reference);
            for light in &sources.lights {
                let light = LightOfGroup {
                    group,
                    light,
                    share: 1.0 / sources.lights.len() as f32,
                    blend: sources.blend,
                };
                self.add_views(
                    &light,
                    &geometry,
                    (looked, &labels),
                    &mut views,
                    &mut passes,
                );
            }
        }
        if passes.is_empty() {
            passes.push(look_up(LoadOp::Clear([1.0; 4]), None));
        }
        if self.groups.iter().any(|g| g.number.is_some()) {
            views.add_figures(&[("receiver-groups", self.groups.len() as f64)]);
        }
        let ViewSettings {
            views: kind,
            fitting,
        } = self.maps.view;
        notes.add(views, self.map.slope, Hints::of(kind, fitting.near));
        passes
    }

    /// Pictures of a group's occluders, and look-ups in them.
    fn add_views(
        &self,
        of: &LightOfGroup<'_>,
        geometry: &CasterGeometry,
        (looked, labels): (&impl Fn(&LookUp<'_>) -> Looked, &dyn Fn(&str) -> String),
        views: &mut ViewsOfLight,
        passes: &mut Vec<Pass>,
    ) {
        let ViewSettings {
            views: kind,
            fitting,
        } = self.maps.view;
        let found = views_of(of.light, of.group.around, kind, &fitting);
        views.missing += found.missing;
        for fitted in found.views {
            let bias = self.maps.bias(&fitted, self.margin);
            views.add(&fitted, bias, fitting.size);
            let picture = fitted.pass(
                labels("light view"),
                geometry,
                self.view,
                &self.map,
                self.maps.skip,
            );
            // The first look-up clears.
            let load = match passes.is_empty() {
                true => LoadOp::Clear([1.0; 4]),
                false => LoadOp::Load,
            };
            passes.push(Pass::new(PassRole::LightView, picture));
            let looked = looked(&LookUp {
                fitted: &fitted,
                light: of.light,
                around: of.group.around,
                depths: self.map.depth,
                label: labels,
                mapping: fitted.mapping(self.view, fitting.size),
                bias,
                planes: self.planes,
                share: of.share,
                group: of.group.number,
            });
            views.add_figures(&looked.figures);
            views.add_warnings(&looked.warnings);
            let prefilter = looked.prefilter.into_iter();
            passes.extend(prefilter.map(|p| Pass::new(PassRole::Prefilter, p)));
            let draw = self.draw(looked.stage, looked.textures, of.blend);
            passes.push(self.look_up(labels("look-up"), load, Some(draw)));
        }
    }

    /// Looks shadows up in the picture; without a draw all is lit.
    fn look_up(&self, label: String, load: LoadOp<[f32; 4]>, draw: Option<Draw>) -> Pass {
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: draw.into_iter().collect(),
        };
        Pass::new(PassRole::LookUp, pass)
    }

    fn draw(
        &self,
        stage: FragmentStage,
        more: Vec<TextureBinding>,
        blend: ColorTargetState,
    ) -> Draw {
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
        let bindings = textures.chain(planes).map(binding).chain(more).collect();
        match self.tiles {
            Some(tiles) => tiles.draw(pipeline, bindings),
            None => full_screen(pipeline, bindings),
        }
    }
}
