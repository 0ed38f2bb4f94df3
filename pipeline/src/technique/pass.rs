//! Passes with their roles: labels are for people, roles for programs.

use gnomon_raster::{Draw, RenderPass};

/// What a pass is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum PassRole {
    /// Depth and ambient light.
    Ambient,
    /// Adds a light to the picture.
    Lit,
    /// Counts hard shadow volumes.
    Volumes,
    /// Hard shadow volumes of points of a light, one after the other.
    Samples,
    /// Counts hard shadow quads for soft shadows.
    HardCount,
    /// Adds up what penumbra wedges cover, or their intensities.
    Wedges,
    /// Caps of umbrae, by depth.
    UmbraCaps,
    /// Boundaries of umbrae into a stencil.
    UmbraStencil,
    /// Counts of a stencil into a buffer.
    UmbraCounts,
    /// Depth copied, to be read while it is attached.
    DepthCopy,
    /// Depths of modelled tiles.
    TileDepths,
    /// Modelled tiles that wedges reach.
    TileClasses,
    /// Silhouettes combined.
    Combine,
    /// Buffers become visibility.
    Resolve,
    /// Surfaces that take no shadow.
    NotReceiving,
    /// Facets see what of the light is before them.
    Horizon,
    /// The scene seen from a light.
    LightView,
    /// Geometry round silhouettes, seen from a light.
    Smoothies,
    /// Images made of a light view, filtered.
    Prefilter,
    /// Shadows looked up in light views.
    LookUp,
    /// Light of vertices, and of surfaces from it.
    Radiance,
    /// Rays from receivers to lights.
    ShadowRays,
    /// Lines across lights.
    LineSamples,
    /// Samples of pixels become pixels.
    ResolveSamples,
    /// One picture added to another.
    AddPicture,
    /// Anything else.
    Other,
}

impl PassRole {
    /// Whether it adds up coverage or counts instead of light.
    pub fn adds_up_coverage(self) -> bool {
        matches!(self, Self::HardCount | Self::Wedges)
    }

    /// Whether it shades the scene: the same for every technique.
    pub fn is_shading(self) -> bool {
        matches!(self, Self::Ambient | Self::Lit)
    }
}

/// What a draw is for, where a pass has several kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum DrawRole {
    /// What the pass is for.
    #[default]
    Main,
    /// Notes the pixels of a wedge in the stencil.
    Note,
    /// Adds the coverage of a wedge.
    Coverage,
    /// Writes the sum of coverage and what was there aside.
    CoverageAside,
    /// Copies a sum back to where it belongs.
    CopyBack,
}

/// A pass of a frame with its role and those of its draws.
#[derive(Clone)]
pub struct Pass {
    /// What it is for.
    pub role: PassRole,
    /// What the GPU does.
    pub pass: RenderPass,
    /// Roles of its draws, in order; those behind the end are [`DrawRole::Main`].
    pub draws: Vec<DrawRole>,
}

impl Pass {
    /// A pass whose draws are all of one kind.
    pub fn new(role: PassRole, pass: RenderPass) -> Self {
        Self {
            role,
            pass,
            draws: Vec::new(),
        }
    }

    /// `pass` with these draws and their roles.
    pub fn with_draws(role: PassRole, pass: RenderPass, draws: Vec<(Draw, DrawRole)>) -> Self {
        let (list, roles) = draws.into_iter().unzip();
        Self {
            role,
            pass: RenderPass {
                draws: list,
                ..pass
            },
            draws: roles,
        }
    }
}

/// Roles of the passes of a frame, beside its command list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Roles {
    passes: Vec<PassRole>,
    draws: Vec<Vec<DrawRole>>,
}

impl Roles {
    /// Of each pass, in order.
    pub fn passes(&self) -> &[PassRole] {
        &self.passes
    }

    /// Of a pass; [`PassRole::Other`] where there is none.
    pub fn of_pass(&self, pass: usize) -> PassRole {
        self.passes.get(pass).copied().unwrap_or(PassRole::Other)
    }

    /// Of a draw of a pass.
    pub fn of_draw(&self, pass: usize, draw: usize) -> DrawRole {
        let draws = self.draws.get(pass);
        let role = draws.and_then(|d| d.get(draw));
        role.copied().unwrap_or_default()
    }

    /// Adds the roles of another pass.
    pub fn push(&mut self, role: PassRole, draws: Vec<DrawRole>) {
        self.passes.push(role);
        self.draws.push(draws);
    }

    /// Adds those of another frame behind these.
    pub fn append(&mut self, mut other: Self) {
        self.passes.append(&mut other.passes);
        self.draws.append(&mut other.draws);
    }
}

/// The GPU's passes and their roles.
pub fn apart(passes: Vec<Pass>) -> (Vec<RenderPass>, Roles) {
    let mut roles = Roles::default();
    let mut list = Vec::with_capacity(passes.len());
    for Pass { role, pass, draws } in passes {
        roles.push(role, draws);
        list.push(pass);
    }
    (list, roles)
}
