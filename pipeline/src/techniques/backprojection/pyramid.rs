//! Pyramids of least depths.

use gnomon_raster::{
    Format, Recording, RenderPass, Sampler, TextureBinding, TextureDescriptor, TextureId,
};
use gnomon_shaders::backprojection::region::LeastOfFour;
use gnomon_shaders::convolution::Atlas;
use gnomon_shaders::convolution::prefilter::CopyLevel;

use crate::parts::maps::tiles::{Level, Texels, Tiles};
use crate::technique::TechniqueError;

/// The textures of a pyramid; views use them in turn.
pub(super) struct Pyramid {
    tiles: Tiles,
    main: TextureId,
    aside: TextureId,
}

impl Pyramid {
    /// Of views of `side` texels, a power of two.
    pub(super) fn create(side: u32, recording: &mut Recording) -> Result<Self, TechniqueError> {
        let levels = side.ilog2();
        let mut create = |label: &str, side: u32, mip_levels| {
            recording.create(&TextureDescriptor {
                mip_levels,
                ..TextureDescriptor::d2(label, Format::R32Float, side, side)
            })
        };
        let atlas = Atlas {
            side,
            columns: 1,
            rows: 1,
        };
        Ok(Self {
            tiles: Tiles { atlas, count: 1 },
            main: create("least depths", side, levels + 1)?,
            aside: create("least depths aside", side / 2, levels)?,
        })
    }

    /// Passes that make it of `depths`.
    pub(super) fn passes(&self, label: &str, depths: TextureId) -> Vec<RenderPass> {
        let side = self.tiles.atlas.side;
        let first = CopyLevel {
            textures: 1,
            mip: 0,
        };
        let [read, written] = [depths, self.main].map(Level::first_of);
        let all = Texels::all(side);
        let copied = self
            .tiles
            .pass(label, &read, &written, all, |_| first.stage());
        let levels = self.tiles.mip_passes(
            label,
            side.ilog2(),
            |level| Texels::all(side >> level),
            |mip| LeastOfFour { mip }.stage(),
            [&[self.main], &[self.aside]],
        );
        std::iter::once(copied).chain(levels).collect()
    }

    /// For look-ups of the texel and level that are nearest.
    pub(super) fn binding(&self) -> TextureBinding {
        TextureBinding {
            texture: self.main,
            sampler: Sampler::default(),
        }
    }
}
