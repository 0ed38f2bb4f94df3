//! Images of functions of depth, and their summed-area tables, as render passes.

use gnomon_raster::{Format, Recording, RenderPass, TextureBinding, TextureDescriptor, TextureId};
use gnomon_shaders::convolution::basis::Source;
use gnomon_shaders::convolution::look_up::{BoxEdges, Images, IntegerTables};
use gnomon_shaders::moments::Moments;
use gnomon_shaders::moments::filter::MomentTables;
use gnomon_shaders::moments::image::MomentImage;

use super::settings::{Kernel, Settings};
use crate::geometry::convolution::FixedPoint;
use crate::parts::maps::light_view::Reads;
use crate::parts::maps::mapped::LookUp;
use crate::parts::maps::tiles::{Level, Texels, Tiles};
use crate::parts::visibility::binding;
use crate::technique::TechniqueError;

/// Two textures of tables, one to read while the other is written. Views use them in
/// turn.
pub(super) struct TableTextures {
    tiles: Tiles,
    textures: [TextureId; 2],
}

impl TableTextures {
    /// For so many functions of views of `side` texels.
    pub(super) fn create(
        technique: &'static str,
        side: u32,
        functions: usize,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let tiles = Tiles::arranged(side, functions).ok_or_else(|| TechniqueError::BadValue {
            technique,
            key: "map-size",
            value: side.to_string(),
            valid: "up to 2048: textures end at 8192 texels".to_owned(),
        })?;
        let [width, height] = tiles.atlas.size();
        let mut create = |label: &str| {
            let desc = TextureDescriptor::d2(label, Format::R32Uint, width, height);
            recording.create(&desc)
        };
        Ok(Self {
            tiles,
            textures: [create("moments")?, create("moments aside")?],
        })
    }
}

/// Tables of a view to be made.
pub(super) struct Tables<'a> {
    textures: &'a TableTextures,
    look_up: &'a LookUp<'a>,
    texels: Texels,
    fixed: FixedPoint,
}

/// Passes that leave tables behind.
pub(super) struct Made {
    pub(super) passes: Vec<RenderPass>,
    pub(super) tables: MomentTables,
    pub(super) binding: TextureBinding,
    /// What 1 is stored as.
    pub(super) largest: u32,
}

impl<'a> Tables<'a> {
    /// With as many bits as the largest kernel leaves.
    pub(super) fn of(
        settings: &Settings,
        textures: &'a TableTextures,
        look_up: &'a LookUp<'a>,
    ) -> Self {
        let side = textures.tiles.atlas.side;
        let reads = look_up.reads().map(|r| widest(settings.kernel, r, side));
        let texels = match &reads {
            Some(reads) if settings.maps.skip => Texels::of_table(reads, side),
            _ => Texels::all(side),
        };
        Self {
            textures,
            look_up,
            texels,
            fixed: FixedPoint::of_box(most_texels(reads.as_ref(), side)),
        }
    }

    /// `moments` gives the functions for whole numbers up to its argument.
    pub(super) fn passes(&self, moments: impl Fn(u32) -> Moments) -> Made {
        let TableTextures { tiles, textures } = self.textures;
        let label = (self.look_up.label)("moments");
        let encoding = self.fixed.unsigned();
        let largest = self.fixed.largest();
        let moments = moments(largest);
        let image = |number: usize| {
            let image = MomentImage {
                moments,
                number,
                source: Source {
                    origin: tiles.atlas.origin(number),
                    exclusive: true,
                },
                encoding,
            };
            image.stage()
        };
        let view = Level::first_of(self.look_up.depths);
        let levels = textures.map(Level::first_of);
        let first = tiles.pass(&label, &view, &levels[0], self.texels, image);
        let (sums, table) = tiles.sum_passes(&label, self.texels, true, levels);
        Made {
            passes: std::iter::once(first).chain(sums).collect(),
            tables: MomentTables {
                moments,
                tables: IntegerTables {
                    side: tiles.atlas.side,
                    edges: BoxEdges::Exact,
                },
                images: Images {
                    slot: self.look_up.first_slot(),
                    atlas: tiles.atlas,
                    encoding,
                },
                least: least_variance(largest),
            },
            binding: binding(table.textures[0]),
            largest,
        }
    }
}

/// What rounding makes of no variance: of the stored values, and of f32.
fn least_variance(largest: u32) -> f32 {
    2.0 / largest as f32 + 5e-7
}

/// What of the picture is read, with kernels of this width.
fn widest(kernel: Kernel, reads: Reads, side: u32) -> Reads {
    let Kernel::Fixed(taps) = kernel else {
        return reads;
    };
    let half = [0.5 * f64::from(taps) / f64::from(side); 2];
    Reads {
        low: [0, 1].map(|k| reads.low[k] - half[k]),
        high: [0, 1].map(|k| reads.high[k] + half[k]),
        half,
    }
}

/// Texels in the largest kernel, without those outside the picture.
fn most_texels(reads: Option<&Reads>, side: u32) -> u64 {
    let whole = u64::from(side);
    let along = |k: usize| match reads {
        None => whole,
        Some(reads) => {
            // A texel is cut at each end; no kernel is narrower than one.
            let width = (2.0 * reads.half[k] * f64::from(side)).ceil() + 2.0;
            (width as u64).clamp(3, whole.max(3))
        }
    };
    along(0) * along(1)
}
