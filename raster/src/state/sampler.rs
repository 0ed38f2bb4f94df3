//! How textures are read.

/// How a texture coordinate outside 0..=1 is mapped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AddressMode {
    /// To the nearest edge texel.
    #[default]
    ClampToEdge,
    /// To the sampler's border colour.
    ClampToBorder,
    /// Modulo 1.
    Repeat,
    /// Modulo 2, the odd half reversed.
    MirrorRepeat,
}

/// How texels become a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilterMode {
    /// The nearest texel.
    #[default]
    Nearest,
    /// Linear between the nearest texels.
    Linear,
}

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// In u, v and w.
    pub address: [AddressMode; 3],
    /// Where a texel is larger than a pixel.
    pub mag: FilterMode,
    /// Where a texel is smaller than a pixel.
    pub min: FilterMode,
    /// Between mip levels.
    pub mip: FilterMode,
    /// Smallest and largest level of detail.
    pub lod: [f32; 2],
    /// Added to the level of detail.
    pub lod_bias: f32,
    /// For [`AddressMode::ClampToBorder`].
    pub border: [f32; 4],
}

impl Default for Sampler {
    fn default() -> Self {
        Self {
            address: [AddressMode::ClampToEdge; 3],
            mag: FilterMode::Nearest,
            min: FilterMode::Nearest,
            mip: FilterMode::Nearest,
            lod: [0.0, 1000.0],
            lod_bias: 0.0,
            border: [0.0; 4],
        }
    }
}

impl Sampler {
    /// Linear in every direction and between levels.
    #[must_use]
    pub fn trilinear() -> Self {
        Self {
            mag: FilterMode::Linear,
            min: FilterMode::Linear,
            mip: FilterMode::Linear,
            ..Self::default()
        }
    }

    /// Linear in the image, nearest level.
    #[must_use]
    pub fn bilinear() -> Self {
        Self {
            mag: FilterMode::Linear,
            min: FilterMode::Linear,
            ..Self::default()
        }
    }
}
