//! The command line of `gnomon wedge`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gnomon_pipeline::geometry::wedge::Construction;

use crate::flags::{SceneArgs, parse_size, parse_time};

/// Flags of `wedge`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    gnomon wedge demo                    all silhouette edges, with their numbers\n  \
    gnomon wedge demo --edge 12 --out wedge.png")]
pub(crate) struct WedgeArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Which silhouette edge [default: a list of all]
    #[arg(long, value_name = "N")]
    pub(crate) edge: Option<usize>,
    /// Which light: a rectangle, a disc or a sphere
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) light: usize,
    /// How the wedge is built
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Built::Exact)]
    pub(crate) construction: Built,
    /// Image size in pixels, of each of the two halves of the picture [default: the scene
    /// file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Draw the wedge with its halves and its hard shadow quad, and what it covers
    #[arg(
        short = 'o',
        long,
        alias = "out-dir",
        value_name = "FILE.png",
        requires = "edge"
    )]
    pub(crate) out: Option<PathBuf>,
    /// Write what the edge adds at each pixel, as float64; NaN where no surface is
    #[arg(long, value_name = "FILE.npy", requires = "edge")]
    pub(crate) coverage: Option<PathBuf>,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Constructions by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Built {
    /// The penumbra itself
    Exact,
    /// Tight round the light (paper IV)
    Tight,
    /// Four planes round the light's bounding sphere (paper III)
    Sphere,
}

impl Built {
    pub(super) fn construction(self) -> Construction {
        match self {
            Self::Exact => Construction::Exact,
            Self::Tight => Construction::Tight,
            Self::Sphere => Construction::BoundingSphere,
        }
    }
}
