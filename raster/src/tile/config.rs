//! A draw's state in the form in which the tile stage uses it.

use crate::format::{Format, encode, to_stored};
use crate::geometry::{DepthEncoding, Triangle};
use crate::observer::Wants;
use crate::sampling::BoundTexture;
use crate::shader::ErasedFragmentShader;
use crate::state::{
    BlendOperation, BlendState, ColorWrites, CompareFunction, StencilFaceState, StencilOperation,
};

/// One facing's stencil state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StencilFace {
    pub(crate) state: StencilFaceState,
    pub(crate) reference: u8,
    /// The stage does anything at all.
    pub(crate) enabled: bool,
    /// Which of fail, depth fail and pass can change a value.
    pub(crate) effective: [bool; 3],
    /// What depth failure and pass add to every stencil value, where that is all
    /// that the stage does.
    pub(crate) counts: Option<[i8; 2]>,
}

impl StencilFace {
    pub(crate) fn new(state: StencilFaceState, reference: u8, attached: bool) -> Self {
        let effective = [state.fail_op, state.depth_fail_op, state.pass_op]
            .map(|op| attached && op != StencilOperation::Keep && state.write_mask != 0);
        let enabled =
            attached && (state.compare != CompareFunction::Always || effective.contains(&true));
        let counts =
            counting(&state, effective).filter(|_| state.compare == CompareFunction::Always);
        Self {
            state,
            reference,
            enabled,
            effective,
            counts,
        }
    }

    /// Whether the stage does no more than test, or no more than count.
    pub(crate) fn is_lean(&self) -> bool {
        self.counts.is_some() || !self.effective.contains(&true)
    }

    /// Whether something can happen to fragments that fail the depth test.
    pub(crate) fn acts_on_depth_failure(&self) -> bool {
        self.effective[0] || self.effective[1]
    }
}

/// What depth failure and pass add, if they do no more than add.
fn counting(state: &StencilFaceState, effective: [bool; 3]) -> Option<[i8; 2]> {
    let step = |op, effective: bool| match op {
        _ if !effective => Some(0),
        StencilOperation::IncrementWrap if state.write_mask == 0xff => Some(1),
        StencilOperation::DecrementWrap if state.write_mask == 0xff => Some(-1),
        _ => None,
    };
    Some([
        step(state.depth_fail_op, effective[1])?,
        step(state.pass_op, effective[2])?,
    ])
}

/// One colour target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TargetConfig {
    pub(crate) format: Format,
    pub(crate) blend: Option<BlendState>,
    /// The operation of blending that works on bytes as they are ([`BlendState::bytewise`]).
    pub(crate) bytewise: Option<BlendOperation>,
    /// Channels of the format that are written.
    pub(crate) mask: ColorWrites,
    /// The destination is read.
    pub(crate) reads: bool,
    /// The source as it is stored, where it is the same everywhere, fits the format, and
    /// replaces whole texels or is blended byte by byte.
    pub(crate) texel: Option<[u32; 4]>,
}

impl TargetConfig {
    pub(crate) fn new(format: Format, blend: Option<BlendState>, writes: ColorWrites) -> Self {
        let all = (1u8 << format.channels()) - 1;
        let mask = ColorWrites(writes.0 & all);
        let uses_dst = |c: &crate::state::BlendComponent| {
            use crate::state::BlendFactor;
            c.is_extreme() || c.dst_factor != BlendFactor::Zero || c.src_factor.reads_dst()
        };
        let blends = blend.is_some_and(|b| {
            (mask.0 & 7 != 0 && uses_dst(&b.color)) || (mask.0 & 8 != 0 && uses_dst(&b.alpha))
        });
        Self {
            format,
            blend,
            bytewise: blend.as_ref().and_then(BlendState::bytewise),
            mask,
            reads: mask.0 != 0 && (blends || mask.0 != all),
            texel: None,
        }
    }

    /// For fragments of one colour: it is converted once, if nothing about that is
    /// counted at every fragment.
    pub(crate) fn with_constant(self, color: [f32; 4]) -> Self {
        let whole = self.mask.0 == (1u8 << self.format.channels()) - 1;
        let bytes = self.format == Format::Rgba8Unorm && self.bytewise.is_some();
        let direct = self.blend.is_none() || bytes;
        let stored = whole && direct && fits(self.format, color);
        Self {
            texel: stored.then(|| to_stored(self.format, encode(self.format, color))),
            ..self
        }
    }
}

/// Whether conversion changes no channel but by rounding.
fn fits(format: Format, color: [f32; 4]) -> bool {
    let channels = &color[..format.channels()];
    match format {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => {
            channels.iter().all(|c| (0.0..=1.0).contains(c))
        }
        Format::R16Sint => (-32768.0..=32767.0).contains(&color[0]),
        Format::R16Float
        | Format::Rgba16Float
        | Format::R32Float
        | Format::Rgba32Float
        | Format::R32Uint => channels.iter().all(|c| !c.is_nan()),
        Format::Depth24Stencil8 | Format::Depth32FloatStencil8 => false,
    }
}

/// Everything of a draw that the tile stage looks at.
pub(crate) struct DrawConfig<'a> {
    pub(crate) encoding: DepthEncoding,
    /// Pixels that may be drawn: x0, y0, x1, y1, half-open.
    pub(crate) rect: [i32; 4],
    /// There is a depth-stencil attachment.
    pub(crate) attached: bool,
    pub(crate) compare: CompareFunction,
    pub(crate) depth_write: bool,
    /// Encoded depth bounds.
    pub(crate) bounds: Option<[i32; 2]>,
    /// Encoded depth range of the viewport.
    pub(crate) depth_range: [i32; 2],
    /// The viewport's min depth is above its max depth.
    pub(crate) depth_reversed: bool,
    /// zmin/zmax tests apply.
    pub(crate) hiz: bool,
    /// No clip planes and no depth bounds.
    pub(crate) plain: bool,
    /// Plain, tests do not wait for the shader, and the stencil only tests or only
    /// counts: the kernel of `lean` applies.
    pub(crate) lean: bool,
    /// Whether both faces count in the stencil on depth failure and on pass, where
    /// they do so alike.
    pub(crate) counting: Option<[bool; 2]>,
    /// Somebody listens who wants the depth ranges of blocks.
    pub(crate) depth_ranges: bool,
    /// Fragment depth is looked at by anything.
    pub(crate) needs_depth: bool,
    /// Front, back.
    pub(crate) stencil: [StencilFace; 2],
    pub(crate) targets: Vec<TargetConfig>,
    pub(crate) blend_constant: [f32; 4],
    pub(crate) shader: Option<&'a dyn ErasedFragmentShader>,
    /// What the shader gives everywhere, so that it is not run.
    pub(crate) constant: Option<[f32; 4]>,
    pub(crate) discards: bool,
    pub(crate) writes_shader_depth: bool,
    /// How many varyings, and which are divided by w or flat.
    pub(crate) varyings: usize,
    pub(crate) perspective: u32,
    pub(crate) flat: u32,
    pub(crate) clip_planes: Vec<[f32; 4]>,
    pub(crate) textures: Vec<BoundTexture<'a>>,
}

impl DrawConfig<'_> {
    /// Prepares for what an observer wants.
    pub(crate) fn listen(&mut self, wants: Wants) {
        self.depth_ranges = wants.depth_ranges && self.attached;
        self.needs_depth |= self.depth_ranges || (wants.probe.is_some() && self.attached);
    }

    /// Whether [`Self::lean`] should be set.
    pub(crate) fn is_lean(&self) -> bool {
        let face = |f| !self.is_late(f) && f.is_lean();
        self.plain && self.stencil.iter().all(face)
    }

    /// What [`Self::counting`] should be.
    pub(crate) fn counts_alike(&self) -> Option<[bool; 2]> {
        let [front, back] = self
            .stencil
            .map(|f| f.counts.map(|steps| steps.map(|s| s != 0)));
        front.filter(|_| front == back)
    }

    /// Stencil state of the side that the triangle shows.
    #[inline(always)]
    pub(crate) fn face(&self, t: &Triangle) -> &StencilFace {
        if t.is_front() {
            &self.stencil[0]
        } else {
            &self.stencil[1]
        }
    }

    /// Tests wait for the shader (rules §7).
    #[inline(always)]
    pub(crate) fn is_late(&self, face: &StencilFace) -> bool {
        self.writes_shader_depth
            || (self.discards && (self.depth_write || face.effective.contains(&true)))
    }
}
