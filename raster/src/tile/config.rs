//! A draw's state in the form in which the tile stage uses it.

use crate::format::{Format, unorm8_from_f32};
use crate::geometry::{DepthEncoding, Triangle};
use crate::observer::Wants;
use crate::sampling::BoundTexture;
use crate::shader::ErasedFragmentShader;
use crate::state::{BlendState, ColorWrites, CompareFunction, StencilFaceState, StencilOperation};

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
    /// Channels of the format that are written.
    pub(crate) mask: ColorWrites,
    /// The destination is read.
    pub(crate) reads: bool,
    /// The source as a word of RGBA8, where it is the same everywhere, fits the
    /// format, and is stored or blended byte by byte.
    pub(crate) word: Option<u32>,
}

impl TargetConfig {
    pub(crate) fn new(format: Format, blend: Option<BlendState>, writes: ColorWrites) -> Self {
        let all = (1u8 << format.channels()) - 1;
        let mask = ColorWrites(writes.0 & all);
        let uses_dst = |c: &crate::state::BlendComponent| {
            use crate::state::{BlendFactor, BlendOperation};
            matches!(c.operation, BlendOperation::Min | BlendOperation::Max)
                || c.dst_factor != BlendFactor::Zero
                || c.src_factor.reads_dst()
        };
        let blends = blend.is_some_and(|b| {
            (mask.0 & 7 != 0 && uses_dst(&b.color)) || (mask.0 & 8 != 0 && uses_dst(&b.alpha))
        });
        Self {
            format,
            blend,
            mask,
            reads: mask.0 != 0 && (blends || mask.0 != all),
            word: None,
        }
    }

    /// For fragments of one colour.
    pub(crate) fn with_constant(self, color: [f32; 4]) -> Self {
        let bytewise = self.format == Format::Rgba8Unorm
            && self.mask == ColorWrites::ALL
            && self.blend.is_none_or(|b| b.bytewise().is_some());
        let fits = color.iter().all(|c| (0.0..=1.0).contains(c));
        Self {
            word: (bytewise && fits).then(|| u32::from_le_bytes(color.map(unorm8_from_f32))),
            ..self
        }
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
        self.needs_depth |= self.depth_ranges;
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
