//! Textures of basis images, and what becomes of them.

use gnomon_raster::{Format, Recording, Sampler, TextureBinding, TextureDescriptor, TextureId};
use gnomon_shaders::convolution::look_up::Images;
use gnomon_shaders::convolution::{Atlas, Encoding};

use super::settings::{Filter, MAP_SIZE, Settings};
use crate::geometry::convolution::FixedPoint;
use crate::parts::maps::tiles::Tiles;
use crate::technique::TechniqueError;

/// Textures of one size that are treated together, tile by tile.
pub(super) struct Group {
    pub(super) tiles: Tiles,
    pub(super) textures: Vec<ImageTexture>,
}

/// A texture of tiles, and a second one to write while the first is read.
pub(super) struct ImageTexture {
    pub(super) main: TextureId,
    /// For tables of the same size; for mip chains, of the levels from the second.
    pub(super) aside: TextureId,
    pub(super) encoding: Encoding,
}

impl Group {
    fn create(
        tiles: Tiles,
        filter: Filter,
        kinds: &[(&str, Format, Encoding)],
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let [width, height] = tiles.atlas.size();
        let levels = tiles.atlas.side.ilog2();
        let mut create = |&(label, format, encoding): &(&str, Format, Encoding)| {
            let main = TextureDescriptor::d2(label, format, width, height);
            let beside = TextureDescriptor::d2(&format!("{label} aside"), format, width, height);
            let (main, beside) = match filter {
                Filter::Sat | Filter::SatU32 => (main, beside),
                Filter::SatMean => (
                    // The means are made level by level, to and fro.
                    TextureDescriptor {
                        mip_levels: levels + 1,
                        ..main
                    },
                    TextureDescriptor {
                        mip_levels: levels + 1,
                        ..beside
                    },
                ),
                Filter::Mip => (
                    TextureDescriptor {
                        mip_levels: levels + 1,
                        ..main
                    },
                    TextureDescriptor {
                        size: [width / 2, height / 2, 1],
                        mip_levels: levels,
                        ..beside
                    },
                ),
            };
            Ok::<_, TechniqueError>(ImageTexture {
                main: recording.create(&main)?,
                aside: recording.create(&beside)?,
                encoding,
            })
        };
        Ok(Self {
            tiles,
            textures: kinds.iter().map(&mut create).collect::<Result<_, _>>()?,
        })
    }

    /// Tiles of the group's texture `number` in `slot`.
    pub(super) fn images(&self, number: usize, slot: usize) -> Images {
        Images {
            slot,
            atlas: self.tiles.atlas,
            encoding: self.textures[number].encoding,
        }
    }
}

/// All images of a light view; views use them in turn.
pub(super) struct BasisTextures {
    /// CSM and CSM-Z.
    pub(super) series: Group,
    /// Depth.
    pub(super) depth: Group,
}

impl BasisTextures {
    pub(super) fn create(
        technique: &'static str,
        settings: &Settings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let pairs = settings.terms.div_ceil(2);
        let tiles = if settings.filter == Filter::SatU32 {
            4 * pairs
        } else {
            pairs
        };
        let tiles = tiles_of(technique, settings.side, tiles)?;
        let single = Tiles {
            atlas: Atlas {
                columns: 1,
                rows: 1,
                ..tiles.atlas
            },
            count: 1,
        };
        let [csm, csm_z, depth] = formats(settings);
        let (filter, series) = (settings.filter, [("csm", csm), ("csm-z", csm_z)]);
        let series = series.map(|(label, (format, encoding))| (label, format, encoding));
        let depth = [("csm depth", depth.0, depth.1)];
        Ok(Self {
            series: Group::create(tiles, filter, &series, recording)?,
            depth: Group::create(single, filter, &depth, recording)?,
        })
    }
}

/// Formats and encodings of CSM, CSM-Z and depth (§6: two 8-bit and two 16-bit RGBA
/// textures at M = 4 under mip chains, all 32-bit float under tables).
fn formats(settings: &Settings) -> [(Format, Encoding); 3] {
    let plain = |format| (format, Encoding::PLAIN);
    match settings.filter {
        Filter::SatU32 => {
            let fixed = FixedPoint::of_tile(settings.side);
            let signed = (Format::R32Uint, fixed.signed());
            [signed, signed, (Format::R32Uint, fixed.unsigned())]
        }
        Filter::Mip if !settings.all_float => [
            (Format::Rgba8Unorm, Encoding::UNIT),
            plain(Format::Rgba16Float),
            plain(Format::R32Float),
        ],
        Filter::Mip | Filter::Sat | Filter::SatMean => [
            plain(Format::Rgba32Float),
            plain(Format::Rgba32Float),
            plain(Format::R32Float),
        ],
    }
}

/// Tiles in rows as long as textures may be.
fn tiles_of(technique: &'static str, side: u32, count: usize) -> Result<Tiles, TechniqueError> {
    Tiles::arranged(side, count).ok_or_else(|| TechniqueError::BadValue {
        technique,
        key: MAP_SIZE.info.name,
        value: side.to_string(),
        valid: "up to 1024 with filter=sat-u32 and m above 8: textures end at 8192 texels"
            .to_owned(),
    })
}

/// A texture for filtered look-ups, or for single texels of a table.
pub(super) fn filtered(texture: TextureId, filter: Filter) -> TextureBinding {
    let sampler = match filter {
        Filter::Mip => Sampler::trilinear(),
        Filter::Sat | Filter::SatMean => Sampler::bilinear(),
        Filter::SatU32 => Sampler::default(),
    };
    TextureBinding { texture, sampler }
}
