//! Basis images, mip chains and summed-area tables as render passes.
//!
//! The GPU binds textures whole, so a level cannot be written while another of the
//! same texture is read. Odd mip levels are made in a second texture and copied
//! back: 4/15 of the first level's texels are written and read once more than on
//! hardware that binds levels apart.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect};
use gnomon_raster::{
    ColorAttachment, Draw, LoadOp, RenderPass, RenderPipeline, StoreOp, Subresource, TextureId,
};
use gnomon_shaders::convolution::basis::{BasisImages, DepthImage, Source};
use gnomon_shaders::convolution::prefilter::{CopyLevel, Halve, LessMean, SumStep};
use gnomon_shaders::transform::FullScreen;

use super::images::{BasisTextures, Group};
use super::needed::{Needed, Texels};
use super::settings::{Filter, Settings};
use crate::parts::visibility::{binding, full_screen};

/// Passes that leave all prefiltered images of one view behind, and the textures
/// that hold them: CSM, CSM-Z, depth.
pub(super) struct Prefilter<'a> {
    pub(super) settings: &'a Settings,
    pub(super) images: &'a BasisTextures,
    /// The light view's depth.
    pub(super) view: TextureId,
    /// What of it receivers read.
    pub(super) needed: &'a Needed,
}

/// What a pass reads and writes: image `mip` of some textures.
#[derive(Clone)]
struct Level {
    textures: Vec<TextureId>,
    mip: u32,
}

impl Prefilter<'_> {
    pub(super) fn passes(
        &self,
        label: impl Fn(&str) -> String,
    ) -> (Vec<RenderPass>, [TextureId; 3]) {
        let mut passes = self.basis_passes(&label("basis"));
        let mut made = Vec::new();
        for group in [&self.images.series, &self.images.depth] {
            let (more, textures) = match self.settings.filter {
                Filter::Mip => self.mip_passes(group, &label("mips")),
                Filter::Sat | Filter::SatMean | Filter::SatU32 => {
                    self.table_passes(group, &label("tables"))
                }
            };
            passes.extend(more);
            made.extend(textures);
        }
        (passes, [made[0], made[1], made[2]])
    }

    fn exclusive(&self) -> bool {
        self.settings.filter != Filter::Mip
    }

    fn centred(&self) -> bool {
        self.settings.filter == Filter::SatMean
    }

    fn integer(&self) -> bool {
        self.settings.filter == Filter::SatU32
    }

    fn source(&self, group: &Group, tile: usize) -> Source {
        Source {
            origin: group.atlas.origin(tile),
            exclusive: self.exclusive(),
        }
    }

    /// The images before filtering.
    fn basis_passes(&self, label: &str) -> Vec<RenderPass> {
        let read = Level {
            textures: vec![self.view],
            mip: 0,
        };
        let expansion = self.settings.series.expansion();
        let series = &self.images.series;
        let encodings = [0, 1].map(|k| series.textures[k].encoding);
        let basis = |tile: usize| {
            let integer = self.integer();
            let shader = BasisImages {
                expansion,
                pair: if integer { tile / 4 } else { tile },
                channel: integer.then_some(tile % 4),
                source: self.source(series, tile),
                encodings,
            };
            shader.stage()
        };
        let depth = &self.images.depth;
        let depth_image = |tile: usize| {
            let shader = DepthImage {
                reach: expansion.reach,
                integer: self.integer(),
                source: self.source(depth, tile),
                encoding: depth.textures[0].encoding,
            };
            shader.stage()
        };
        let texels = match self.centred() {
            true => Texels::all(self.settings.side),
            false => self.needed.level(0),
        };
        vec![
            pass(label, series, &read, &mains(series, 0), texels, basis),
            pass(label, depth, &read, &mains(depth, 0), texels, depth_image),
        ]
    }

    /// Level after level, as far as receivers read them.
    fn mip_passes(&self, group: &Group, label: &str) -> (Vec<RenderPass>, Vec<TextureId>) {
        let mut passes = Vec::new();
        let mut before = mains(group, 0);
        let textures = group.textures.len();
        for level in 1..=self.needed.last_level() {
            let texels = self.needed.level(level);
            let shader = Halve {
                textures,
                mip: before.mip,
            };
            let main = mains(group, level);
            if level % 2 == 0 {
                passes.push(pass(label, group, &before, &main, texels, |_| {
                    shader.stage()
                }));
                before = main;
                continue;
            }
            let beside = asides(group, level - 1);
            passes.push(pass(label, group, &before, &beside, texels, |_| {
                shader.stage()
            }));
            let copy = CopyLevel {
                textures,
                mip: level - 1,
            };
            passes.push(pass(label, group, &beside, &main, texels, |_| copy.stage()));
            before = beside;
        }
        (passes, mains(group, 0).textures)
    }

    /// Rows, then columns, by recursive doubling, two steps a pass; to and fro between
    /// two textures.
    fn table_passes(&self, group: &Group, label: &str) -> (Vec<RenderPass>, Vec<TextureId>) {
        let texels = self.needed.level(0);
        let mut passes = Vec::new();
        let (mut from, mut to) = (mains(group, 0), asides(group, 0));
        if self.centred() {
            passes = mean_passes(group, label);
            let shader = LessMean {
                textures: group.textures.len(),
                side: group.atlas.side,
            };
            passes.push(pass(label, group, &from, &to, texels, |_| shader.stage()));
            std::mem::swap(&mut from, &mut to);
        }
        for axis in 0..2 {
            // Entries beyond the last that is read need no sums.
            let end = texels.end[axis];
            let mut step = 1;
            while step < end {
                let twice = 2 * step < end;
                let shader = SumStep {
                    textures: group.textures.len(),
                    axis,
                    step,
                    twice,
                    side: group.atlas.side,
                    integer: self.integer(),
                };
                passes.push(pass(label, group, &from, &to, texels, |_| shader.stage()));
                std::mem::swap(&mut from, &mut to);
                step *= if twice { 4 } else { 2 };
            }
        }
        (passes, from.textures)
    }
}

/// The mean of each tile, into the last level of both textures: either may hold the
/// table in the end. Each level is in the texture that the one before is not.
fn mean_passes(group: &Group, label: &str) -> Vec<RenderPass> {
    let side = group.atlas.side;
    let textures = group.textures.len();
    let mut passes = Vec::new();
    let (mut before, mut other) = (mains(group, 0), asides(group, 0));
    for level in 1..=side.ilog2() {
        let halve = Halve {
            textures,
            mip: before.mip,
        };
        other.mip = level;
        let texels = Texels::all(side >> level);
        passes.push(pass(label, group, &before, &other, texels, |_| {
            halve.stage()
        }));
        std::mem::swap(&mut before, &mut other);
    }
    other.mip = before.mip;
    let copy = CopyLevel {
        textures,
        mip: before.mip,
    };
    let one = Texels::all(1);
    passes.push(pass(label, group, &before, &other, one, |_| copy.stage()));
    passes
}

/// Level `mip` of the group's textures.
fn mains(group: &Group, mip: u32) -> Level {
    let textures = group.textures.iter().map(|t| t.main).collect();
    Level { textures, mip }
}

/// Image `mip` of the textures beside them.
fn asides(group: &Group, mip: u32) -> Level {
    let textures = group.textures.iter().map(|t| t.aside).collect();
    Level { textures, mip }
}

/// Reads one level and writes another: a draw for each tile, limited to `texels` of
/// it.
fn pass(
    label: &str,
    group: &Group,
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
            scissor: Some(scissor(group, tile, texels)),
            ..full_screen(pipeline, textures)
        }
    };
    RenderPass {
        label: label.to_owned(),
        color: written.textures.iter().map(attachment).collect(),
        depth_stencil: None,
        draws: (0..group.tiles).map(draw).collect(),
    }
}

fn scissor(group: &Group, tile: usize, texels: Texels) -> ScissorRect {
    let cell = group.atlas.cell(tile);
    let side = texels.side;
    ScissorRect {
        x: cell[0] * side + texels.begin[0],
        y: cell[1] * side + texels.begin[1],
        width: texels.end[0] - texels.begin[0],
        height: texels.end[1] - texels.begin[1],
    }
}
