//! Soft shadows by penumbra wedges, umbra and penumbra apart (paper II).
//!
//! Assarsson and Akenine-Möller, "Interactive Rendering of Soft Shadows using an
//! Optimized and Generalized Penumbra Wedge Algorithm", 2002. The front planes of
//! the wedges bound the umbra, counted as in hard shadow volumes but in steps of
//! 255; surfaces inside a wedge get `round(255 s)` back. The same wedges,
//! intensities and light-intensity buffer as in `penumbra-wedges`.
//!
//! # Passes
//!
//! `passes=three` (§6.1): front faces of the umbra's boundary into an 8-bit
//! stencil, back faces, both by the ordinary depth test; then the penumbrae. The stencil
//! wraps and is read as a signed byte: 127 nested umbrae. `passes=single` (§6.2): front
//! planes add umbra and penumbra at once wherever one depth test decides both, else the
//! two stay apart. Both give the same bits.
//!
//! Penumbrae are drawn by the faces of a wedge on the front plane's side, those that rays
//! enter or those that they leave, whichever the front face is one of. The paper takes the
//! first for z-pass and the others for z-fail; both cover the same pixels, and so the one
//! face whose depth decides the umbra decides the penumbra too: no surface is counted by
//! one and missed by the other, though vertices are snapped and depth is rounded.
//!
//! # Where the eye may be
//!
//! `zpass` counts boundaries between eye and surface; the eye must be outside
//! every wedge and umbra. `zfail` counts those beyond, with the light-facing
//! triangles as top and a cap at infinity as bottom; the bottom of a wedge closes it at
//! infinity. `auto` decides per caster. (The paper's "back facing planes are chosen in
//! rasterizeUmbra()" must read rasterizePenumbra().)
//!
//! # Culling and what is counted
//!
//! Tiles of `tile` pixels a side are a model, apart from the execution tiles. One pass
//! reduces depth to zmin and zmax of each tile. Before the wedges are drawn, a pass tests
//! each wedge's tiles, a fragment for each (`tiles-tested` in the report's shader counts),
//! and their pixels look the outcome up (texture 1) before they read depth (texture 0: a
//! copy, since depth is attached). So the depth reads of penumbrae that are counted are
//! those of hardware that culls tiles of that size. Umbrae are culled by the emulated GPU's
//! own blocks of 8x8. How often hardware would test a tile, once for each triangle, is
//! counted by [`crate::measure::tile_traffic`]. Culling changes no bit of any buffer.
//!
//! `wedge-length` ends shadows in a plane that far behind each silhouette, square to the light's
//! direction, as the paper's end; the bottom is then counted by z-pass too. What lies beyond
//! is lit. Surfaces in that very plane may show single wrong pixels.
//!
//! Pixels without surface (depth 1) belong to no wedge and are left out of zmin and zmax:
//! one pixel of sky would stretch its tile to infinity.
//!
//! # Where it is wrong
//!
//! Where the side planes of a wedge meet in its front plane, near sharp turns of
//! a silhouette under a large light, front planes pass through one another and
//! wedges share space: bright and dark triangles, counted in
//! `overlapping-side-planes`. That is the algorithm (paper II, §1), not rounding:
//! the buffer holds the sum that the paper defines.

mod atlas;
mod draws;
mod list;

use gnomon_raster::TextureId;
use gnomon_shaders::penumbra::tiles::{Culling, OutsideTest, TileTest, WedgePlanes};

use atlas::Atlas;

use crate::parts::casters::{self, Examined};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::volumes::volume_draws::CountMethod;
use crate::parts::wedges::penumbra::depth_copy;
use crate::parts::wedges::penumbra::hard::Method;
use crate::parts::wedges::penumbra::screen::Screen;
use crate::parts::wedges::penumbra::{self, PenumbraSettings};
use crate::technique::{
    Capabilities, Choice, Condition, Decimals, Frame, LightFact, Param, ParamInfo, Params,
    SceneWedges, ShadowKind, Technique, TechniqueError, WedgeUse,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct PenumbraWedgesRestructured;

const METHOD: Param<CountMethod> = Param::choice(
    "method",
    CountMethod::Auto.word(),
    "auto: z-pass for casters whose penumbra and umbra the eye is outside of, else z-fail",
);

choices! {
    /// How umbra and penumbra are drawn.
    enum PassCount {
        /// At once.
        Single = "single",
        /// The umbra by two stencil passes.
        Three = "three",
    }
}

const PASSES: Param<PassCount> = Param::choice(
    "passes",
    PassCount::Single.word(),
    "umbra and penumbra of front planes at once, or umbra by two stencil passes; same bits",
)
.when(Condition::Lights(LightFact::Extended));

impl Choice for Culling {
    const NAMES: &'static [&'static str] = &["none", "zmax", "zminmax"];
    const ALL: &'static [Self] = &[Self::None, Self::Zmax, Self::ZminZmax];
}

const CULLING: Param<Culling> = Param::choice(
    "culling",
    "zminmax",
    "what is known of a tile's depths when it is culled; same bits",
);

const TILE: Param<u32> = Param::<u32>::power_of_two(
    "tile",
    8,
    [2, 256],
    "side in pixels of the modelled tiles that are culled; same bits",
)
.unit("pixels")
.when(Condition::Not("culling", &["none"]));

choices! {
    /// What tiles are tested against.
    enum SeparatingAxis {
        /// The wedge's planes.
        Faces = "faces",
        /// Its range of depth, then its planes.
        RangeFaces = "range-faces",
        /// Its range of depth.
        Range = "range",
        /// All separating axes.
        Full = "full",
    }
}

const AXES: Param<SeparatingAxis> = Param::choice(
    "separating-axis",
    SeparatingAxis::Faces.word(),
    "tiles against the wedge's planes, its range of depth first, that range alone, \
     or all separating axes; same bits",
)
.when(Condition::All(&[
    Condition::Not("culling", &["none"]),
    Condition::Lights(LightFact::Extended),
]));

const LENGTH: Param<Option<f64>> = Param::decimal_or(
    &["infinite"],
    "wedge-length",
    Decimals {
        low: 0.0,
        with_low: true,
    },
    "how far behind its silhouette a shadow ends, in world units: what lies beyond is lit",
)
.when(Condition::Lights(LightFact::Extended));

impl Technique for PenumbraWedgesRestructured {
    fn name(&self) -> &'static str {
        "penumbra-wedges-restructured"
    }

    fn summary(&self) -> &'static str {
        "penumbra wedges with umbra and penumbra apart, tile culling and z-fail (paper II)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[
                METHOD.info,
                PASSES.info,
                CULLING.info,
                TILE.info,
                AXES.info,
                LENGTH.info
            ],
            &[penumbra::INTERPOLATION.info],
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
        build(scene, size, params).map(|built| built.frame)
    }

    fn wedges(
        &self,
        scene: &Scene,
        params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        penumbra::scene_wedges(scene, params).map(Some)
    }
}

/// A frame, and what its draws do of wedges.
pub(crate) struct Built {
    pub(crate) frame: Frame,
    /// In the order of passes and draws.
    pub(crate) wedge_draws: Vec<WedgeDraw>,
}

/// A draw of a wedge, or of a piece of the umbra's boundary.
#[derive(Clone, Debug)]
pub(crate) struct WedgeDraw {
    /// Index of the pass in the command list, and of the draw in the pass.
    pub(crate) at: [usize; 2],
    pub(crate) model: WedgeModel,
}

/// What a draw adds to the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Adds {
    /// 255 for each front plane, or a stencil count.
    Umbra,
    /// The intensity at surfaces inside the wedge.
    Penumbra,
    /// Both, for front planes that a single pass draws once.
    Both,
}

/// A wedge's draw as hardware with tiles of any size would cull it.
#[derive(Clone, Debug)]
pub(crate) struct WedgeModel {
    pub(crate) wedge: WedgePlanes,
    pub(crate) adds: Adds,
    /// Umbra boundaries are counted beyond the surface instead of before it.
    pub(crate) depth_fail: bool,
    pub(crate) tiles: TileTest,
}

/// The frame and what the model of tile traffic needs of it.
pub(crate) fn build(
    scene: &Scene,
    size: [u32; 2],
    params: &Params,
) -> Result<Built, TechniqueError> {
    let choices = Choices::read(params, size)?;
    let casters = casters::examine(scene, choices.penumbra.open_casters)?;
    let frame = ShadowedFrame::new(scene, size, &choices.penumbra.frame)?;
    let frame = frame.with_horizon(choices.penumbra.horizon, false);
    let mut frame = frame.with_ambient();
    let (pass, copy) = depth_copy::depth_copy(&frame.targets, size, &mut frame.recording)?;
    frame.push(pass);
    let (mut inputs, mut bounds) = (vec![copy], Vec::new());
    let mut atlas = None;
    if let Some((pass, found)) =
        list::tile_depths(&choices, &frame.targets, size, &mut frame.recording)?
    {
        frame.push(pass);
        bounds = found;
        let classes = Atlas::create(size, choices.tiles.shift, &mut frame.recording)?;
        inputs.push(classes.texture);
        atlas = Some(classes);
    }
    let draws = InsideDraws {
        size,
        casters: &casters,
        screen: Screen::new(&frame.draws.view, size),
        inputs,
        bounds,
        atlas,
        choices,
    };
    let buffer = penumbra::light_intensity(size, &mut frame.recording)?;
    let visibility = penumbra::visibility(buffer);
    let mut wedge_draws = Vec::new();
    let frame = frame.lit(LitTest::Visibility(visibility), |light| {
        let mut passes = draws.light_passes(buffer, light, &mut wedge_draws);
        let label = light.label("not receiving");
        passes.extend(penumbra::not_receiving_pass(
            label,
            buffer,
            light.targets,
            light.draws,
        ));
        Ok(passes)
    })?;
    Ok(Built { frame, wedge_draws })
}

/// Tests of tiles besides the wedge's planes.
#[derive(Clone, Copy, Default)]
struct Axes {
    range: bool,
    edges: bool,
}

/// What parameters decide.
struct Choices {
    forced: Option<Method>,
    three: bool,
    tiles: TileTest,
    axes: Axes,
    /// Where shadows end.
    length: Option<f64>,
    penumbra: PenumbraSettings,
}

impl Choices {
    fn read(params: &Params, size: [u32; 2]) -> Result<Self, TechniqueError> {
        let axes = params.get(&AXES)?;
        Ok(Self {
            forced: match params.get(&METHOD)? {
                CountMethod::Auto => None,
                CountMethod::DepthPass => Some(Method::DepthPass),
                CountMethod::DepthFail => Some(Method::DepthFail),
            },
            three: params.get(&PASSES)? == PassCount::Three,
            tiles: TileTest {
                culling: params.get(&CULLING)?,
                shift: params.get(&TILE)?.trailing_zeros(),
                size,
                outside: if axes == SeparatingAxis::Range {
                    OutsideTest::WithoutPlanes
                } else {
                    OutsideTest::Planes
                },
                ..TileTest::default()
            },
            axes: Axes {
                range: axes != SeparatingAxis::Faces,
                edges: axes == SeparatingAxis::Full,
            },
            length: params.get(&LENGTH)?,
            penumbra: PenumbraSettings::read(params)?,
        })
    }
}

/// What the draws of all lights share.
struct InsideDraws<'a> {
    size: [u32; 2],
    casters: &'a [Examined<'a>],
    screen: Screen,
    choices: Choices,
    /// The copy of depth, and the classes of tiles if there are.
    inputs: Vec<TextureId>,
    /// zmax and zmin of tiles, as far as there are.
    bounds: Vec<TextureId>,
    atlas: Option<Atlas>,
}
