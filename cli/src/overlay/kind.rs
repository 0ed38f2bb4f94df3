//! Which pictures there are, by name.

use clap::ValueEnum;

/// Pictures that explain a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum OverlayKind {
    /// Fragments generated per pixel
    Overdraw,
    /// Stencil values left at the end
    Stencil,
    /// Bytes read and written per 8x8 block
    Traffic,
    /// Silhouette edges of the casters, seen from the lights
    Silhouette,
    /// Sides of the shadow volumes
    Volumes,
    /// Penumbra wedges, as the technique builds them
    Wedges,
    /// Penumbrae that overlap: edges that cut a light, seen from each pixel
    Overlap,
    /// Where the sum of soft shadow volumes leaves 0..1, and by how much
    Saturation,
    /// Where that sum is not the truth, and why
    Artefacts,
    /// How full the channels of coverage are, and where carries took room in them
    Carries,
    /// The map of the environment with the fitted lights outlined
    EnvLights,
}

impl OverlayKind {
    /// Its name on the command line and in file names.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Overdraw => "overdraw",
            Self::Stencil => "stencil",
            Self::Traffic => "traffic",
            Self::Silhouette => "silhouette",
            Self::Volumes => "volumes",
            Self::Wedges => "wedges",
            Self::Overlap => "overlap",
            Self::Saturation => "saturation",
            Self::Artefacts => "artefacts",
            Self::Carries => "carries",
            Self::EnvLights => "env-lights",
        }
    }
}
