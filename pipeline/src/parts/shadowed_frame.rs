//! The skeleton of every frame: targets, ambient light, then for each light, the
//! first one last, what the technique draws to find its shadows, the horizon, and
//! the light itself.
//!
//! ```
//! # use gnomon_pipeline::parts::frame_settings::FrameSettings;
//! # use gnomon_pipeline::parts::passes::LitTest;
//! # use gnomon_pipeline::parts::shadowed_frame::ShadowedFrame;
//! # use gnomon_pipeline::technique::{Params, TechniqueError};
//! # let scene = gnomon_pipeline::world::scene::builtin::build("cylinder").unwrap();
//! # let params = Params::defaults(gnomon_pipeline::techniques::find("unshadowed")?);
//! let settings = FrameSettings::read(&params)?;
//! let frame = ShadowedFrame::new(&scene, [64, 48], &settings)?;
//! let frame = frame.with_ambient().lit(LitTest::Everywhere, |_light| Ok(Vec::new()))?;
//! assert_eq!(frame.roles.passes().len(), 2);
//! # Ok::<(), TechniqueError>(())
//! ```

use gnomon_raster::{CommandList, Recording, RenderPass};

use super::backdrop::Backdrop;
use super::frame_settings::FrameSettings;
use super::horizon::Horizon;
use super::passes::{LitTest, SceneDraws, Targets, label};
use super::view::View;
use super::visibility::Positions;
use crate::technique::{
    CasterUse, Figure, Frame, KeptWork, Outputs, Pass, PassRole, TechniqueError, VisibilityOutput,
    Warning, apart,
};
use crate::world::light::Light;
use crate::world::scene::{Object, Scene};

/// What is said of a frame, gathered light after light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    /// What was found amiss.
    pub warnings: Vec<Warning>,
    /// What became of casters.
    pub casters: Vec<CasterUse>,
    /// Numbers that were chosen.
    pub figures: Vec<Figure>,
}

/// A frame in the making.
pub struct ShadowedFrame<'a> {
    /// What is drawn.
    pub scene: &'a Scene,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Textures so far; those of the technique go here.
    pub recording: Recording,
    /// Colour and depth.
    pub targets: Targets,
    /// The scene's draws.
    pub draws: SceneDraws<'a>,
    /// Numbers of the lights that shine, first one first.
    pub lights: Vec<usize>,
    /// What is said of the frame.
    pub notes: Notes,
    passes: Vec<Pass>,
    backdrop: Option<Backdrop>,
    horizon: Option<HorizonOf>,
}

/// Facets are limited to what is before them.
#[derive(Clone, Copy)]
struct HorizonOf {
    has_image: bool,
}

/// One light's turn in a frame.
pub struct LightTurn<'f, 'a> {
    /// What is drawn.
    pub scene: &'a Scene,
    /// Index into [`Scene::lights`].
    pub number: usize,
    /// How many lights were drawn before.
    pub turn: usize,
    /// Colour and depth.
    pub targets: &'f Targets,
    /// The scene's draws.
    pub draws: &'f SceneDraws<'a>,
    /// For textures of the light.
    pub recording: &'f mut Recording,
    /// What is said of the light.
    pub notes: &'f mut Notes,
    /// Number of passes before those of the light.
    pub passes_before: usize,
    lights: &'f [usize],
}

impl<'f, 'a> LightTurn<'f, 'a> {
    /// The light.
    pub fn light(&self) -> &'a Light {
        &self.scene.lights[self.number]
    }

    /// The camera.
    pub fn view(&self) -> &'f View {
        &self.draws.view
    }

    /// `what`, with the light's number where there are several: a pass's label.
    pub fn label(&self, what: &str) -> String {
        label(what, self.number, self.lights)
    }

    /// The same, to be kept while the turn is changed.
    pub fn labels(&self) -> impl Fn(&str) -> String + use<'f> {
        let (number, lights) = (self.number, self.lights);
        move |what| label(what, number, lights)
    }
}

impl<'a> ShadowedFrame<'a> {
    /// Creates the targets of a picture of `size`.
    ///
    /// # Errors
    /// The size is impossible, or a light is asked for that the scene does not have.
    pub fn new(
        scene: &'a Scene,
        size: [u32; 2],
        settings: &FrameSettings,
    ) -> Result<Self, TechniqueError> {
        let mut recording = Recording::default();
        let targets = Targets::create(size, settings, &mut recording)?;
        let backdrop = Backdrop::create(scene, size, &mut recording)?;
        Ok(Self {
            scene,
            size,
            targets,
            draws: SceneDraws::new(scene, size, settings, &mut recording)?,
            recording,
            lights: settings.lights(scene)?,
            notes: Notes::default(),
            passes: Vec::new(),
            backdrop,
            horizon: None,
        })
    }

    /// Adds the pass of depth and ambient light.
    pub fn with_ambient(mut self) -> Self {
        let pass = self.draws.ambient_pass(&self.targets);
        self.push_ambient(pass);
        self
    }

    /// `pass` with what is behind the scene, and ambient light that depends on normals.
    fn push_ambient(&mut self, mut pass: RenderPass) {
        let attachments = pass.color.len();
        pass.draws
            .extend(self.backdrop.map(|b| b.draw(attachments)));
        self.passes.push(Pass::new(PassRole::Ambient, pass));
        let leaning = self.draws.leaning_ambient(&self.targets);
        self.passes
            .extend(leaning.map(|p| Pass::new(PassRole::Ambient, p)));
    }

    /// Adds the pass of depth, ambient light and the positions of what is seen.
    ///
    /// # Errors
    /// The GPU refuses the texture.
    pub fn with_positions(mut self) -> Result<(Self, Positions), TechniqueError> {
        let positions = Positions::create(self.size, &mut self.recording)?;
        Ok(self.with_ambient_and(positions))
    }

    /// The same, and the planes of the facets that are seen.
    ///
    /// # Errors
    /// The GPU refuses the textures.
    pub fn with_positions_and_planes(mut self) -> Result<(Self, Positions), TechniqueError> {
        let positions = Positions::with_planes(self.size, &mut self.recording)?;
        Ok(self.with_ambient_and(positions))
    }

    /// The same, w of positions being what `number` gives to triangles of objects.
    ///
    /// # Errors
    /// The GPU refuses the texture.
    pub(crate) fn with_numbered_positions(
        mut self,
        number: &dyn Fn(&Object, u32) -> f32,
    ) -> Result<(Self, Positions), TechniqueError> {
        let positions = Positions::create(self.size, &mut self.recording)?;
        let pass = self
            .draws
            .ambient_pass_with_numbers(&self.targets, &positions, number);
        self.push_ambient(pass);
        Ok((self, positions))
    }

    fn with_ambient_and(mut self, positions: Positions) -> (Self, Positions) {
        let pass = self
            .draws
            .ambient_pass_with_positions(&self.targets, &positions);
        self.push_ambient(pass);
        (self, positions)
    }

    /// Adds a pass before the first light's.
    pub fn push(&mut self, pass: Pass) {
        self.passes.push(pass);
    }

    /// Limits what facets see to the light before their plane, where `wanted`; an
    /// image on the light rules that out.
    pub(crate) fn with_horizon(mut self, wanted: bool, has_image: bool) -> Self {
        self.horizon = wanted.then_some(HorizonOf { has_image });
        self
    }

    /// Each light, the first one last so that its visibility stays (where all light
    /// reaches everything none does, and the first is first): the passes that `shadows` gives, which leave its
    /// visibility where `test` says, and the light itself.
    ///
    /// # Errors
    /// Those of `shadows`.
    pub fn lit(
        mut self,
        test: LitTest,
        mut shadows: impl FnMut(&mut LightTurn<'_, 'a>) -> Result<Vec<Pass>, TechniqueError>,
    ) -> Result<Frame, TechniqueError> {
        let mut order = self.lights.clone();
        if test != LitTest::Everywhere {
            order.reverse();
        }
        for (turn, &number) in order.iter().enumerate() {
            let mut light = LightTurn {
                scene: self.scene,
                number,
                turn,
                targets: &self.targets,
                draws: &self.draws,
                recording: &mut self.recording,
                notes: &mut self.notes,
                passes_before: self.passes.len(),
                lights: &self.lights,
            };
            let own = shadows(&mut light)?;
            let horizon = horizon_pass(self.horizon, &mut light, test);
            let lit = self
                .draws
                .lit_pass(&self.targets, number, &light.label("lit"), test);
            self.passes.extend(own);
            self.passes.extend(horizon);
            self.passes.push(Pass::new(PassRole::Lit, lit));
        }
        self.finish(test.output())
    }

    /// The frame of the passes so far.
    ///
    /// # Errors
    /// The GPU refuses a name.
    pub(crate) fn finish(mut self, visibility: VisibilityOutput) -> Result<Frame, TechniqueError> {
        let (passes, roles) = apart(self.passes);
        self.recording.list = CommandList { passes };
        let outputs = Outputs {
            color: self.targets.color_texture(),
            depth_stencil: self.targets.depth_texture(),
            visibility,
        };
        self.recording.name_output("color", outputs.color)?;
        self.recording
            .name_output("depth-stencil", outputs.depth_stencil)?;
        if let Some(texture) = visibility.texture() {
            self.recording.name_output("visibility", texture)?;
        }
        Ok(Frame {
            recording: self.recording,
            roles,
            outputs,
            warnings: self.notes.warnings,
            casters: self.notes.casters,
            figures: self.notes.figures,
            keep: Vec::new(),
            work: KeptWork::default(),
        })
    }
}

fn horizon_pass(
    horizon: Option<HorizonOf>,
    light: &mut LightTurn<'_, '_>,
    test: LitTest,
) -> Option<Pass> {
    let (Some(of), LitTest::Visibility(visibility)) = (horizon, test) else {
        return None;
    };
    match Horizon::of(light.number, light.light(), of.has_image) {
        Ok(horizon) => {
            let label = light.label("horizon");
            let pass = horizon.pass(label, light.draws, light.targets, visibility);
            pass.map(|pass| Pass::new(PassRole::Horizon, pass))
        }
        Err(left_out) => {
            light.notes.warnings.push(left_out);
            None
        }
    }
}
