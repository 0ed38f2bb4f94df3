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
//! stencil, back faces, then the penumbrae. The stencil wraps and is read as a
//! signed byte: 127 nested umbrae. `passes=single` (§6.2): front planes add umbra
//! and penumbra at once wherever the same facing carries both; where the side
//! planes of a wedge meet, its front face is not all of the boundary, and the two
//! stay apart. Both give the same bits.
//!
//! # Where the eye may be
//!
//! `zpass` counts boundaries between eye and surface; the eye must be outside
//! every wedge and umbra. `zfail` counts those beyond, with the light-facing
//! triangles as top and a cap at infinity as bottom, and draws back faces of the
//! wedges; the bottom of a wedge closes it at infinity. `auto` decides per caster.
//! (The paper's "back facing planes are chosen in rasterizeUmbra()" must read
//! rasterizePenumbra().)
//!
//! # Culling and what is counted
//!
//! Tiles of `tile` pixels a side are a model, apart from the execution tiles: one
//! pass reduces depth to zmin and zmax of each tile, and the shader tests the
//! tile's box against the wedge's planes before it reads depth. So the depth reads
//! (texture 0), the reads and writes of the buffer and of the stencil that are
//! counted are those of hardware that culls tiles of that size. Only the reads of
//! zmin and zmax differ: here each fragment reads them (textures 1 and 2),
//! hardware once per triangle and tile; [`crate::measure::tile_traffic`] counts these.
//! Culling changes no bit of any buffer.
//!
//! Pixels without surface (depth 1) belong to no umbra and no wedge and are left
//! out of zmin and zmax: one pixel of sky would stretch its tile to infinity.
//!
//! # Where it is wrong
//!
//! Where the side planes of a wedge meet in its front plane, near sharp turns of
//! a silhouette under a large light, front planes pass through one another and
//! wedges share space: bright and dark triangles, counted in
//! `overlapping-side-planes`. That is the algorithm (paper II, §1), not rounding:
//! the buffer holds the sum that the paper defines.

mod draws;
mod list;

use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::penumbra::inside::{Culling, OutsideTest, TileTest, WedgeInside};
use gnomon_shaders::penumbra::intensity::Interpolation;

use crate::parts::casters::{self, Examined, OPEN_CASTERS};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::wedges::penumbra::hard::Method;
use crate::parts::wedges::penumbra::screen::Screen;
use crate::parts::wedges::penumbra::{self, EXTRA_WEDGES, INTERPOLATION};
use crate::technique::{CasterUse, Frame, ParamInfo, Params, Technique, TechniqueError, Warning};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct PenumbraWedgesRestructured;

const METHOD: ParamInfo = ParamInfo {
    name: "method",
    default: "auto",
    valid: "auto|zpass|zfail",
    summary: "auto: z-pass for casters whose penumbra and umbra the eye is outside of, else z-fail",
};

const PASSES: ParamInfo = ParamInfo {
    name: "passes",
    default: "single",
    valid: "single|three",
    summary: "umbra and penumbra of front planes at once, or umbra by two stencil passes; same bits",
};

const CULLING: ParamInfo = ParamInfo {
    name: "culling",
    default: "zminmax",
    valid: "none|zmax|zminmax",
    summary: "what is known of a tile's depths when it is culled; same bits",
};

const TILE: ParamInfo = ParamInfo {
    name: "tile",
    default: "8",
    valid: "2|4|8|16|32|64|128|256",
    summary: "side in pixels of the modelled tiles that are culled; same bits",
};

const AXES: ParamInfo = ParamInfo {
    name: "separating-axis",
    default: "faces",
    valid: "faces|range-faces|range|full",
    summary: "tiles against the wedge's planes, its range of depth first, that range alone, \
              or all separating axes; same bits",
};

impl Technique for PenumbraWedgesRestructured {
    fn name(&self) -> &'static str {
        "penumbra-wedges-restructured"
    }

    fn summary(&self) -> &'static str {
        "penumbra wedges with umbra and penumbra apart, tile culling and z-fail (paper II)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            METHOD,
            PASSES,
            CULLING,
            TILE,
            AXES,
            INTERPOLATION,
            EXTRA_WEDGES,
            OPEN_CASTERS,
            passes::LIGHT,
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
        build(scene, size, params).map(|built| built.frame)
    }
}

/// A frame, and the wedge shaders in it.
pub(crate) struct Built {
    pub(crate) frame: Frame,
    /// In the order of passes and draws.
    pub(crate) wedge_draws: Vec<WedgeDraw>,
}

/// A draw that runs a wedge shader.
#[derive(Clone, Debug)]
pub(crate) struct WedgeDraw {
    /// Index of the pass in the command list, and of the draw in the pass.
    pub(crate) at: [usize; 2],
    pub(crate) shader: WedgeInside,
}

/// The frame and what the model of tile traffic needs of it.
pub(crate) fn build(
    scene: &Scene,
    size: [u32; 2],
    params: &Params,
) -> Result<Built, TechniqueError> {
    let mut recording = Recording::default();
    let targets = Targets::create(size, params, &mut recording)?;
    let draws = SceneDraws::new(scene, size, params);
    let casters = casters::examine(PenumbraWedgesRestructured.name(), scene, params)?;
    let lights = passes::lights(scene, params)?;
    let choices = Choices::new(params, size);
    let mut list = vec![draws.ambient_pass(&targets)];
    let mut inputs = vec![targets.depth_texture()];
    if let Some((pass, bounds)) = list::tile_depths(&choices, &targets, size, &mut recording)? {
        list.push(pass);
        inputs.extend(bounds);
    }
    let builder = Builder {
        scene,
        size,
        params,
        targets: &targets,
        draws: &draws,
        casters: &casters,
        screen: Screen::new(&draws.view, size),
        choices,
        inputs,
        umbra_stencil: list::umbra_stencil(params, size, &mut recording)?,
    };
    let mut built = Parts::default();
    let buffer = penumbra::light_intensity(size, &mut recording)?;
    let visibility = penumbra::visibility(buffer);
    for &light in lights.iter().rev() {
        let named = |what: &str| passes::label(what, light, &lights);
        built.offset = list.len();
        list.extend(builder.light_passes(light, buffer, &named, &mut built));
        let label = named("not receiving");
        list.extend(penumbra::not_receiving_pass(
            label, buffer, &targets, &draws,
        ));
        list.push(draws.lit_pass(
            &targets,
            light,
            &named("lit"),
            LitTest::Visibility(visibility),
        ));
    }
    let mut frame = targets.frame(recording, list, visibility.output())?;
    frame.warnings = built.warnings;
    frame.casters = built.uses;
    Ok(Built {
        frame,
        wedge_draws: built.wedge_draws,
    })
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
    interpolation: Interpolation,
}

impl Choices {
    fn new(params: &Params, size: [u32; 2]) -> Self {
        let culling = match params.get(CULLING.name) {
            "none" => Culling::None,
            "zmax" => Culling::Zmax,
            _ => Culling::ZminZmax,
        };
        let tile: u32 = params.get(TILE.name).parse().unwrap_or(8);
        let axes = params.get(AXES.name);
        Self {
            forced: match params.get(METHOD.name) {
                "zpass" => Some(Method::DepthPass),
                "zfail" => Some(Method::DepthFail),
                _ => None,
            },
            three: params.get(PASSES.name) == "three",
            tiles: TileTest {
                culling,
                shift: tile.trailing_zeros(),
                size,
                outside: if axes == "range" {
                    OutsideTest::WithoutPlanes
                } else {
                    OutsideTest::Planes
                },
                ..TileTest::default()
            },
            axes: Axes {
                range: axes != "faces",
                edges: axes == "full",
            },
            interpolation: penumbra::interpolation(params),
        }
    }
}

/// What accumulates over lights.
#[derive(Default)]
struct Parts {
    warnings: Vec<Warning>,
    uses: Vec<CasterUse>,
    wedge_draws: Vec<WedgeDraw>,
    /// Number of passes before those of the light.
    offset: usize,
}

/// What the passes of all lights share.
struct Builder<'a> {
    scene: &'a Scene,
    size: [u32; 2],
    params: &'a Params,
    targets: &'a Targets,
    draws: &'a SceneDraws<'a>,
    casters: &'a [Examined<'a>],
    screen: Screen,
    choices: Choices,
    /// Depth, zmax, zmin, as far as there are.
    inputs: Vec<TextureId>,
    umbra_stencil: Option<TextureId>,
}
