//! Square tiles of textures that passes treat alike: images made of a light view's
//! picture, and their summed-area tables.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect};
use gnomon_raster::{
    ColorAttachment, Draw, LoadOp, RenderPass, RenderPipeline, StoreOp, Subresource, TextureId,
};
use gnomon_shaders::convolution::Atlas;
use gnomon_shaders::convolution::prefilter::{CopyLevel, SumStep};
use gnomon_shaders::transform::FullScreen;

use super::light_view::Reads;
use crate::parts::visibility::{binding, full_screen};

/// Texels from `begin` to before `end`, of a tile of `side` texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Texels {
    pub(crate) begin: [u32; 2],
    pub(crate) end: [u32; 2],
    pub(crate) side: u32,
}

impl Texels {
    /// Of the whole tile.
    pub(crate) fn all(side: u32) -> Self {
        Self {
            begin: [0; 2],
            end: [side; 2],
            side,
        }
    }

    /// The texels that a filter at coordinates from `low` to `high` of 0..1 reads at
    /// this level, and one more on each side.
    pub(crate) fn read(reads: &Reads, side: u32) -> Self {
        let texel = |at: f64, more: f64| {
            let texel = (at * f64::from(side)).floor() + more;
            texel.clamp(0.0, f64::from(side)) as u32
        };
        // A picture that no kernel touches still has a texel.
        let begin = reads.low.map(|at| texel(at, -2.0).min(side - 1));
        let high = reads.high.map(|at| texel(at, 3.0));
        Self {
            begin,
            end: [0, 1].map(|k| high[k].max(begin[k] + 1)),
            side,
        }
    }

    /// The entries of a summed-area table that such a filter needs: all before the last
    /// one that it reads.
    pub(crate) fn of_table(reads: &Reads, side: u32) -> Self {
        Self {
            begin: [0; 2],
            ..Self::read(reads, side)
        }
    }
}

/// What a pass reads or writes: image `mip` of some textures.
#[derive(Clone)]
pub(crate) struct Level {
    pub(crate) textures: Vec<TextureId>,
    pub(crate) mip: u32,
}

impl Level {
    /// The first image of one texture.
    pub(crate) fn first_of(texture: TextureId) -> Self {
        Self {
            textures: vec![texture],
            mip: 0,
        }
    }
}

/// The tiles of a texture that hold something: the first `count`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiles {
    pub(crate) atlas: Atlas,
    pub(crate) count: usize,
}

impl Tiles {
    /// As many in rows as the largest texture has room for; their number is a power of
    /// two, so that borders between them stay exact in coordinates. `None` where they do
    /// not fit.
    pub(crate) fn arranged(side: u32, count: usize) -> Option<Self> {
        let most = gnomon_raster::MAX_TEXTURE_SIZE / side;
        let wanted = count as u32;
        let columns = wanted.next_power_of_two().min(most);
        let rows = wanted.div_ceil(columns).next_power_of_two();
        let atlas = Atlas {
            side,
            columns,
            rows,
        };
        (rows <= most).then_some(Self { atlas, count })
    }

    /// Reads one level and writes another: a draw for each tile, limited to `texels` of
    /// it.
    pub(crate) fn pass(
        &self,
        label: &str,
        read: &Level,
        written: &Level,
        texels: Texels,
        shader: impl Fn(usize) -> FragmentStage,
    ) -> RenderPass {
        let attachment = |texture: &TextureId| ColorAttachment {
            texture: *texture,
            subresource: Subresource {
                mip: written.mip,
                layer: 0,
            },
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        };
        let draw = |tile: usize| {
            let pipeline = RenderPipeline {
                label: label.to_owned(),
                vertex: FullScreen.stage(),
                fragment: Some(shader(tile)),
                primitive: PrimitiveState::default(),
                depth_stencil: DepthStencilState::default(),
                color_targets: vec![ColorTargetState::OPAQUE; written.textures.len()],
            };
            let textures = read.textures.iter().map(|t| binding(*t)).collect();
            Draw {
                scissor: Some(self.scissor(tile, texels)),
                ..full_screen(pipeline, textures)
            }
        };
        RenderPass {
            label: label.to_owned(),
            color: written.textures.iter().map(attachment).collect(),
            depth_stencil: None,
            draws: (0..self.count).map(draw).collect(),
        }
    }

    /// Levels 1 to `last` of mip chains, each of the one before, which `shader` reads. The
    /// GPU binds textures whole, so that odd levels are made in `aside`, whose level k is
    /// the chain's level k + 1, and copied back.
    pub(crate) fn mip_passes(
        &self,
        label: &str,
        last: u32,
        texels: impl Fn(u32) -> Texels,
        shader: impl Fn(u32) -> FragmentStage,
        [main, aside]: [&[TextureId]; 2],
    ) -> Vec<RenderPass> {
        let level = |of: &[TextureId], mip| Level {
            textures: of.to_vec(),
            mip,
        };
        let mut passes = Vec::new();
        let mut before = level(main, 0);
        for number in 1..=last {
            let texels = texels(number);
            let made = level(main, number);
            let halved = shader(before.mip);
            if number % 2 == 0 {
                passes.push(self.pass(label, &before, &made, texels, |_| halved.clone()));
                before = made;
                continue;
            }
            let beside = level(aside, number - 1);
            passes.push(self.pass(label, &before, &beside, texels, |_| halved.clone()));
            let copy = CopyLevel {
                textures: main.len(),
                mip: number - 1,
            };
            passes.push(self.pass(label, &beside, &made, texels, |_| copy.stage()));
            before = beside;
        }
        passes
    }

    /// Summed-area tables of `from`: rows, then columns, by recursive doubling, two
    /// steps a pass; to and fro between both. Also gives the level that holds the
    /// tables.
    pub(crate) fn sum_passes(
        &self,
        label: &str,
        texels: Texels,
        integer: bool,
        [mut from, mut to]: [Level; 2],
    ) -> (Vec<RenderPass>, Level) {
        let mut passes = Vec::new();
        for axis in 0..2 {
            // Entries beyond the last that is read need no sums.
            let end = texels.end[axis];
            let mut step = 1;
            while step < end {
                let twice = 2 * step < end;
                let shader = SumStep {
                    textures: from.textures.len(),
                    axis,
                    step,
                    twice,
                    side: self.atlas.side,
                    integer,
                };
                passes.push(self.pass(label, &from, &to, texels, |_| shader.stage()));
                std::mem::swap(&mut from, &mut to);
                step *= if twice { 4 } else { 2 };
            }
        }
        (passes, from)
    }

    fn scissor(&self, tile: usize, texels: Texels) -> ScissorRect {
        let cell = self.atlas.cell(tile);
        let side = texels.side;
        ScissorRect {
            x: cell[0] * side + texels.begin[0],
            y: cell[1] * side + texels.begin[1],
            width: texels.end[0] - texels.begin[0],
            height: texels.end[1] - texels.begin[1],
        }
    }
}
