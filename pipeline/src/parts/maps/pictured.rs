//! The frame of a technique that makes pictures of its own of each light view, and looks
//! shadows up in them.
//!
//! Per light: visibility starts at 1; then for each view the passes that the technique
//! gives and one that looks shadows up ("look-up"), one texture serving all views in turn;
//! then the lit pass. ([`super::mapped`] is the same with one picture of depths.)

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::transform::FullScreen;

use super::light_view::{CasterGeometry, Fitted, LightViews, Surroundings, ViewedLight};
use super::lit_tiles::{FurtherLights, LitTiles};
use super::mapped::{Hints, MapNotes, ViewSettings, ViewsOfLight};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::{LitTest, View};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{Frame, Pass, PassRole, TechniqueError};
use crate::world::scene::Scene;

/// A light of a [`Pictures`].
pub(crate) struct PicturedLight<D> {
    pub(crate) viewed: ViewedLight,
    /// What is looked at from it.
    pub(crate) views: LightViews,
    /// What the technique knows of it.
    pub(crate) data: D,
}

/// A view that pictures are made of.
pub(crate) struct PicturedView<'a> {
    /// Among the light's.
    pub(crate) number: usize,
    pub(crate) fitted: &'a Fitted,
    pub(crate) geometry: &'a CasterGeometry,
    pub(crate) view: &'a View,
    /// Leave out casters outside the view.
    pub(crate) skip: bool,
}

/// Shadows looked up: positions are in slot 0, and these textures behind them.
pub(crate) struct PictureLookUp {
    pub(crate) stage: FragmentStage,
    pub(crate) textures: Vec<TextureId>,
}

/// What a technique draws for each view of each light.
pub(crate) trait Pictures {
    /// What it knows of a light.
    type Light;

    /// A light that shadows are looked for of.
    fn light(
        &self,
        turn: &mut LightTurn<'_, '_>,
        around: &Surroundings<'_>,
    ) -> Result<PicturedLight<Self::Light>, TechniqueError>;

    /// By how much blockers must be nearer than receivers in a view, world units.
    fn bias(&self, fitted: &Fitted) -> f64;

    /// Texels over which slopes push blockers away from the light.
    fn slope(&self) -> f64 {
        0.0
    }

    /// The passes that make the pictures, with labels for what they are.
    fn passes(
        &self,
        light: &Self::Light,
        view: &PicturedView<'_>,
        label: &dyn Fn(&str) -> String,
    ) -> Vec<Pass>;

    /// What reads them.
    fn look_up(&self, light: &Self::Light, view: &PicturedView<'_>) -> PictureLookUp;
}

/// What frames of pictures share.
pub(crate) struct Pictured<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) size: [u32; 2],
    pub(crate) frame: FrameSettings,
    pub(crate) views: ViewSettings,
    pub(crate) skip: bool,
    /// Limit what facets see to what is before them.
    pub(crate) horizon: bool,
}

impl Pictured<'_> {
    /// `create` makes the pictures' textures.
    pub(crate) fn frame<P: Pictures>(
        &self,
        create: impl FnOnce(&mut Recording) -> Result<P, TechniqueError>,
    ) -> Result<Frame, TechniqueError> {
        let around = Surroundings::new(self.scene, self.size);
        let frame = ShadowedFrame::new(self.scene, self.size, &self.frame)?;
        let frame = frame.with_horizon(self.horizon, false);
        let (mut frame, positions) = frame.with_positions()?;
        let [width, height] = self.size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(frame.recording.create(&desc)?);
        let pictures = create(&mut frame.recording)?;
        let view = View::new(&self.scene.camera, self.size);
        let lights = frame.lights.clone();
        let further = FurtherLights::new(self.scene, &around, &view, &lights, self.skip);
        frame.lit(LitTest::Visibility(visibility), |turn| {
            let tiles = further.tiles(turn.number);
            let one = OneLight {
                settings: self,
                around: &around,
                view: &view,
                positions,
                visibility,
                tiles: tiles.as_ref(),
            };
            one.passes(&pictures, turn)
        })
    }
}

/// Views and look-ups of one light.
struct OneLight<'a> {
    settings: &'a Pictured<'a>,
    around: &'a Surroundings<'a>,
    view: &'a View,
    positions: Positions,
    visibility: VisibilityTexture,
    /// Where shadows matter; `None`: everywhere.
    tiles: Option<&'a LitTiles>,
}

impl OneLight<'_> {
    fn passes<P: Pictures>(
        &self,
        pictures: &P,
        turn: &mut LightTurn<'_, '_>,
    ) -> Result<Vec<Pass>, TechniqueError> {
        let labels = turn.labels();
        let light = pictures.light(turn, self.around)?;
        let mut notes = MapNotes::new(turn.notes, &labels);
        if let Some(tiles) = self.tiles {
            notes.skipped(tiles);
            if tiles.is_empty() {
                return Ok(vec![self.look_up(labels("look-up"), true, None)]);
            }
        }
        let reference = light.viewed.reference(self.around);
        let geometry = CasterGeometry::new(turn.scene, self.around, self.view, reference);
        let ViewSettings { views, fitting } = self.settings.views;
        let mut counted = ViewsOfLight::default();
        counted.missing = light.views.missing;
        let mut passes = Vec::new();
        for (number, fitted) in light.views.views.iter().enumerate() {
            counted.add(fitted, pictures.bias(fitted), fitting.size);
            let view = PicturedView {
                number,
                fitted,
                geometry: &geometry,
                view: self.view,
                skip: self.settings.skip,
            };
            let first = passes.is_empty();
            passes.extend(pictures.passes(&light.data, &view, &labels));
            let look_up = pictures.look_up(&light.data, &view);
            passes.push(self.look_up(labels("look-up"), first, Some(look_up)));
        }
        if passes.is_empty() {
            passes.push(self.look_up(labels("look-up"), true, None));
        }
        notes.add(counted, pictures.slope(), Hints::of(views, fitting.near));
        Ok(passes)
    }

    /// Looks shadows up in the pictures; without them all is lit.
    fn look_up(&self, label: String, first: bool, look_up: Option<PictureLookUp>) -> Pass {
        let load = if first {
            LoadOp::Clear([1.0; 4])
        } else {
            LoadOp::Load
        };
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: look_up.into_iter().map(|l| self.draw(l)).collect(),
        };
        Pass::new(PassRole::LookUp, pass)
    }

    fn draw(&self, look_up: PictureLookUp) -> Draw {
        let pipeline = RenderPipeline {
            label: "look-up".into(),
            vertex: FullScreen.stage(),
            fragment: Some(look_up.stage),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let textures = std::iter::once(self.positions.texture).chain(look_up.textures);
        let bindings = textures.map(binding).collect();
        match self.tiles {
            Some(tiles) => tiles.draw(pipeline, bindings),
            None => full_screen(pipeline, bindings),
        }
    }
}
