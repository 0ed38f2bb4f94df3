//! Basis images, mip chains and summed-area tables as render passes.
//!
//! Odd mip levels are made in a second texture and copied back: 4/15 of the first
//! level's texels are written and read once more than on hardware that binds levels
//! apart.

use gnomon_raster::{RenderPass, TextureId};
use gnomon_shaders::convolution::basis::{BasisImages, DepthImage, Source};
use gnomon_shaders::convolution::prefilter::{CopyLevel, Halve, LessMean};

use super::images::{BasisTextures, Group};
use super::settings::{Filter, Settings};
use crate::parts::maps::tiles::{Level, Texels};

/// Passes that leave all prefiltered images of one view behind, and the textures
/// that hold them: CSM, CSM-Z, depth.
pub(super) struct Prefilter<'a> {
    pub(super) settings: &'a Settings,
    pub(super) images: &'a BasisTextures,
    /// The light view's depth.
    pub(super) view: TextureId,
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
            origin: group.tiles.atlas.origin(tile),
            exclusive: self.exclusive(),
        }
    }

    /// The images before filtering.
    fn basis_passes(&self, label: &str) -> Vec<RenderPass> {
        let read = Level::first_of(self.view);
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
        let texels = Texels::all(self.settings.side);
        vec![
            series
                .tiles
                .pass(label, &read, &mains(series, 0), texels, basis),
            depth
                .tiles
                .pass(label, &read, &mains(depth, 0), texels, depth_image),
        ]
    }

    /// Level after level.
    fn mip_passes(&self, group: &Group, label: &str) -> (Vec<RenderPass>, Vec<TextureId>) {
        let [main, aside] = [mains(group, 0).textures, asides(group, 0).textures];
        let textures = group.textures.len();
        let passes = group.tiles.mip_passes(
            label,
            self.settings.side.ilog2(),
            |level| Texels::all(self.settings.side >> level),
            |mip| Halve { textures, mip }.stage(),
            [&main, &aside],
        );
        (passes, main)
    }

    /// Summed-area tables, of what is left without the mean where that is asked for.
    fn table_passes(&self, group: &Group, label: &str) -> (Vec<RenderPass>, Vec<TextureId>) {
        let texels = Texels::all(self.settings.side);
        let mut passes = Vec::new();
        let (mut from, mut to) = (mains(group, 0), asides(group, 0));
        if self.centred() {
            passes = mean_passes(group, label);
            let shader = LessMean {
                textures: group.textures.len(),
                side: group.tiles.atlas.side,
            };
            passes.push(
                group
                    .tiles
                    .pass(label, &from, &to, texels, |_| shader.stage()),
            );
            std::mem::swap(&mut from, &mut to);
        }
        let (sums, table) = group
            .tiles
            .sum_passes(label, texels, self.integer(), [from, to]);
        passes.extend(sums);
        (passes, table.textures)
    }
}

/// The mean of each tile, into the last level of both textures: either may hold the
/// table in the end. Each level is in the texture that the one before is not.
fn mean_passes(group: &Group, label: &str) -> Vec<RenderPass> {
    let side = group.tiles.atlas.side;
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
        passes.push(
            group
                .tiles
                .pass(label, &before, &other, texels, |_| halve.stage()),
        );
        std::mem::swap(&mut before, &mut other);
    }
    other.mip = before.mip;
    let copy = CopyLevel {
        textures,
        mip: before.mip,
    };
    let one = Texels::all(1);
    passes.push(
        group
            .tiles
            .pass(label, &before, &other, one, |_| copy.stage()),
    );
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
