//! Soft shadows by penumbra wedges, as first published (paper I).
//!
//! Akenine-Möller and Assarsson, "Approximate Soft Shadows on Arbitrary Surfaces
//! using Penumbra Wedges", 2002. A light-intensity buffer of signed 16 bits per
//! light starts at 255; each ray adds `round(255 s)` where it leaves a wedge, or at
//! the surface that it meets inside, less `round(255 s)` where it entered. Clamped
//! to 0..=255 the sum is the light's visibility. The light is a sphere.
//!
//! # How it is computed
//!
//! `side-planes=cancel`, the default, is what the paper implemented (§5, §6): what a wedge
//! gains at a side plane its neighbour takes, so it is left out; what stays is 255 at front
//! planes, and the intensity of surfaces inside. The plane that a ray meets is known from
//! the face that is drawn. Boundary of the umbra that no wedge has, beyond the point where
//! sides meet in the front plane and between wedges that do not touch, is drawn by itself:
//! without it a ray would enter a shadow that it never leaves. The sum is that of
//! `penumbra-wedges-restructured`, which counts the steps by a stencil.
//!
//! `evaluate` is the definition (§4): intensities wherever a ray enters and leaves, at side
//! planes from what both neighbours share, each rounded; what one wedge adds there the other
//! takes, to the bit. `naive` is its pseudocode: equation (3) at every entry and exit, and
//! their difference rounded.
//!
//! # What differs from the paper
//!
//! * Which faces are drawn: those on the front plane's side of the eye, or with `evaluate`
//!   and `naive` back faces, not those that face the eye. All cover the same pixels, and an
//!   eye inside a wedge sees back faces all round it.
//! * The buffer starts with what the *eye* has lost (`start=eye`), which is 255
//!   outside shadow. `start=lit` is the paper's 255, wrong for an eye in shadow.
//! * Ambient light is drawn first, and the buffer modulates each light as it is
//!   added: the same sum, also for several lights.
//!
//! `culling=zmax` lets the depth test cull blocks of 8x8 pixels whose surfaces all lie
//! before a face that rays enter by (§5; the paper left it for hardware). The report's tiles
//! say how many. It changes no bit: the face is moved towards the eye by a pixel of its
//! slope, more than its depth may be off.
//!
//! `shades=k` is full light in the buffer in place of 255, and the number of steps of a
//! penumbra (§4). 16 signed bits hold 127 overlaps of 255; an 8-bit buffer would hold three
//! of 31.
//!
//! `levels=N` is the approximation by hardware of §7 and figure 15: N quads in place of each
//! wedge, counted by the depth test, and N + 1 intensities. The paper had 6 to 16.
//!
//! Pixels without surface (depth 1) keep the start.
//!
//! # Where it is wrong
//!
//! With `evaluate` and `naive`, what a ray gains at a side plane is given back only where
//! the neighbour's wedge begins. Beyond the line where the side planes of a wedge meet, and
//! where a wedge is missing, it is not, and the difference stays with everything behind:
//! streaks along the rays of the eye (counted in `overlapping-side-planes` and
//! `wedges-without-sides`). Wedges of lights of about 1e-4 of the scene, whose front and back
//! planes f32 hardly tells apart, may be missed at single pixels; still smaller lights
//! cast hard shadows (`light-as-point`).

mod crossing;
mod draws;
mod faces;
mod levels;

use gnomon_raster::{Draw, LoadOp, RenderPass, TextureId};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::intensity::Interpolation;

use crate::parts::casters::{self, Examined};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::VisibilityTexture;
use crate::parts::wedges::penumbra::screen::Screen;
use crate::parts::wedges::penumbra::{self, PenumbraSettings, depth_copy};
use crate::technique::{
    Capabilities, Condition, Frame, LightFact, Param, ParamInfo, Params, Pass, PassRole,
    SceneWedges, ShadowKind, Technique, TechniqueError, Warning, WedgeUse, Whole,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct PenumbraWedges;

choices! {
    /// Intensity that rays start with.
    enum Start {
        /// The eye's own.
        Eye = "eye",
        /// Full light.
        Lit = "lit",
    }
}

const START: Param<Start> = Param::choice(
    "start",
    Start::Eye.word(),
    "intensity that rays start with: the eye's own, or full light as in paper I",
)
.when(Condition::Lights(LightFact::Extended));

choices! {
    /// Intensity where rays pass side planes.
    enum SidePlanes {
        /// Left out.
        Cancel = "cancel",
        /// Computed from what neighbours share.
        Evaluate = "evaluate",
        /// By the equation for the inside, as at all planes.
        Naive = "naive",
    }
}

const SIDE_PLANES: Param<SidePlanes> = Param::choice(
    "side-planes",
    SidePlanes::Cancel.word(),
    "intensity where rays pass side planes: left out since neighbours cancel, evaluated, or \
     by the equation for the inside at every plane",
)
// Under points too, where it decides whether faces may be culled.
.when(Condition::Is("levels", &["continuous"]));

choices! {
    /// What is culled.
    enum Culling {
        /// Nothing.
        None = "none",
        /// Blocks whose surfaces all lie before a face.
        Zmax = "zmax",
    }
}

const CULLING: Param<Culling> = Param::choice(
    "culling",
    Culling::None.word(),
    "whether zmax of 8x8 pixels culls faces of wedges behind all surfaces; same bits",
)
.when(Condition::All(&[
    Condition::Not("side-planes", &["evaluate", "naive"]),
    Condition::Is("levels", &["continuous"]),
]));

/// With wedges, not quads.
const CONTINUOUS: Condition = Condition::All(&[
    Condition::Is("levels", &["continuous"]),
    Condition::Lights(LightFact::Extended),
]);

const INTERPOLATION: Param<Interpolation> = penumbra::INTERPOLATION.when(CONTINUOUS);

const LEVELS: Param<Option<u32>> = Param::<Option<u32>>::whole_or(
    &["continuous"],
    "levels",
    [2, 64],
    Whole::Any,
    "continuous intensities, or as many quads for each wedge, counted by the depth test",
);

/// Without quads, which are shades themselves.
const SHADES: Param<u32> = Param::whole(
    "shades",
    FULL as u64,
    [2, FULL as u64],
    "full light in the buffer, and so the steps of a penumbra: fewer leave room for more \
     overlaps in a buffer of fewer bits (paper I's k)",
)
.when(Condition::Is("levels", &["continuous"]));

/// What parameters decide.
struct CrossingSettings {
    /// Quads in place of each wedge.
    levels: Option<u32>,
    /// The paper's k.
    shades: u32,
    start: Start,
    side_planes: SidePlanes,
    culling: Culling,
    penumbra: PenumbraSettings,
}

impl CrossingSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        let side_planes = params.get(&SIDE_PLANES)?;
        let levels = params.get(&LEVELS)?;
        Ok(Self {
            start: params.get(&START)?,
            side_planes,
            culling: match side_planes {
                SidePlanes::Cancel if levels.is_none() => params.get(&CULLING)?,
                _ => Culling::None,
            },
            shades: match levels {
                Some(levels) => levels,
                None => params.get(&SHADES)?,
            },
            levels,
            penumbra: PenumbraSettings::read(params)?,
        })
    }
}

impl CrossingSettings {
    /// What the buffer holds in full light.
    fn full(&self) -> f32 {
        self.shades as f32
    }
}

impl Technique for PenumbraWedges {
    fn name(&self) -> &'static str {
        "penumbra-wedges"
    }

    fn summary(&self) -> &'static str {
        "soft shadows of spherical lights by penumbra wedges, entry against exit (paper I)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[
                START.info,
                SIDE_PLANES.info,
                CULLING.info,
                LEVELS.info,
                SHADES.info,
                INTERPOLATION.info
            ],
            PenumbraSettings::OTHER_PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            wedges: WedgeUse::Linked,
            ..Capabilities::of_silhouettes(ShadowKind::Soft)
        }
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = CrossingSettings::read(params)?;
        let casters = casters::examine(scene, settings.penumbra.open_casters)?;
        let frame = ShadowedFrame::new(scene, size, &settings.penumbra.frame)?;
        let frame = frame.with_horizon(settings.penumbra.horizon, false);
        let mut frame = frame.with_ambient();
        let mut depth = frame.targets.depth_texture();
        if settings.culling == Culling::Zmax {
            let (pass, copy) = depth_copy::depth_copy(&frame.targets, size, &mut frame.recording)?;
            frame.push(pass);
            depth = copy;
        }
        let draws = CrossingDraws {
            size,
            depth,
            settings: &settings,
            casters: &casters,
            screen: Screen::new(&frame.draws.view, size),
        };
        let buffer = penumbra::light_intensity(size, &mut frame.recording)?;
        let visibility = VisibilityTexture {
            scale: 1.0 / settings.full(),
            ..penumbra::visibility(buffer)
        };
        frame.lit(LitTest::Visibility(visibility), |light| {
            let mut found = LightWedges::starting_with(settings.full());
            draws.fill(light, &mut found);
            let mut passes = draws.intensity_passes(light, buffer, found);
            let label = light.label("not receiving");
            passes.extend(penumbra::not_receiving_pass(
                label,
                buffer,
                light.targets,
                light.draws,
            ));
            Ok(passes)
        })
    }

    fn wedges(
        &self,
        scene: &Scene,
        params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        penumbra::scene_wedges(scene, params).map(Some)
    }
}

/// What the draws of all lights share.
struct CrossingDraws<'a> {
    size: [u32; 2],
    /// What shaders read depth from.
    depth: TextureId,
    settings: &'a CrossingSettings,
    casters: &'a [Examined<'a>],
    screen: Screen,
}

/// What one light needs drawn.
struct LightWedges {
    /// The light has no extent: there are no wedges.
    is_hard: bool,
    /// What the buffer starts with.
    start: f32,
    /// The eye's intensity.
    at_eye: f32,
    /// Volumes of casters for which the light has no extent.
    volumes: Vec<Draw>,
    wedges: Vec<Draw>,
}

impl LightWedges {
    fn starting_with(start: f32) -> Self {
        Self {
            is_hard: false,
            start,
            at_eye: start,
            volumes: Vec::new(),
            wedges: Vec::new(),
        }
    }
}

impl CrossingDraws<'_> {
    /// The pass of hard volumes, whose depth is tested, and that of wedges, as far as
    /// there are.
    fn intensity_passes(
        &self,
        turn: &LightTurn<'_, '_>,
        buffer: TextureId,
        found: LightWedges,
    ) -> Vec<Pass> {
        let start = match self.settings.start {
            Start::Eye => found.start,
            Start::Lit => self.settings.full(),
        };
        let mut load = penumbra::cleared(start);
        let mut list = Vec::new();
        if found.is_hard || !found.volumes.is_empty() {
            // One name where there is one pass.
            let (role, what) = match found.is_hard {
                true => (PassRole::Wedges, "wedges"),
                false => (PassRole::Volumes, "volumes"),
            };
            let mut pass = penumbra::intensity_pass(turn.label(what), buffer, load);
            pass.depth_stencil = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            pass.draws = found.volumes;
            list.push(Pass::new(role, pass));
            load = LoadOp::Load;
        }
        if !found.is_hard {
            let mut pass = RenderPass {
                draws: found.wedges,
                ..penumbra::intensity_pass(turn.label("wedges"), buffer, load)
            };
            if self.settings.culling == Culling::Zmax || self.settings.levels.is_some() {
                pass.depth_stencil = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            }
            list.push(Pass::new(PassRole::Wedges, pass));
        }
        list
    }
}

/// Says so where the eye is not in full light.
fn start_warning(light: usize, start: f32, full: f32) -> Option<Warning> {
    (start != full).then(|| Warning {
        code: "eye-in-shadow",
        count: 1,
        message: format!(
            "light {light}: the eye is in shadow, at {start} of {full}; start=lit would be wrong here"
        ),
    })
}
