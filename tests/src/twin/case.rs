//! What the twin draws: a closed description from which a command list is built too.

use gnomon_raster::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect, StencilOperation, Viewport,
};
use gnomon_raster::{
    BlockAccess, BlockLeft, ClientTraffic, Counters, Format, FragmentRecord, LoadOp, ShadedBlock,
    StoreOp, TexelAccess,
};

use super::program::Program;
use super::texture::{TextureUse, TwinTexture};
use gnomon_raster::shader::Interpolation;

/// A colour image before the first pass.
#[derive(Clone, Debug)]
pub struct ColorImage {
    /// Its format.
    pub format: Format,
    /// Raw channels, row by row from the top.
    pub texels: Vec<[u32; 4]>,
}

/// A depth-stencil image before the first pass.
#[derive(Clone, Debug)]
pub struct DepthImage {
    /// Its format.
    pub format: Format,
    /// Depth in 0..=1.
    pub depth: Vec<f32>,
    /// Stencil.
    pub stencil: Vec<u8>,
}

/// A colour attachment of a pass.
#[derive(Clone, Debug)]
pub struct ColorUse {
    /// Index of the case's image.
    pub image: usize,
    /// At the beginning.
    pub load: LoadOp<[f32; 4]>,
    /// At the end.
    pub store: StoreOp,
}

/// The depth-stencil attachment of a pass.
#[derive(Clone, Debug)]
pub struct DepthUse {
    /// Depth at the beginning.
    pub depth_load: LoadOp<f32>,
    /// Depth at the end.
    pub depth_store: StoreOp,
    /// Stencil at the beginning.
    pub stencil_load: LoadOp<u8>,
    /// Stencil at the end.
    pub stencil_store: StoreOp,
}

/// Which of the two ways to write a shader the GPU takes; the twin's is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// Over lanes.
    Lanes,
    /// A closure that sees one vertex or fragment.
    Closure,
}

/// Where the GPU's vertex shader finds the vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexSource {
    /// A vertex buffer.
    Buffer,
    /// A table of the shader, looked up by vertex number.
    Table,
}

/// One draw.
#[derive(Clone, Debug)]
pub struct TwinDraw {
    /// Clip-space positions.
    pub positions: Vec<[f32; 4]>,
    /// Varyings of each vertex, as many as `interpolation` has entries.
    pub varyings: Vec<Vec<f32>>,
    /// How each varying is interpolated.
    pub interpolation: Vec<Interpolation>,
    /// Added to the position as often as the instance's number.
    pub instance_offset: [f32; 4],
    /// `None` draws vertices in order.
    pub indices: Option<Vec<u32>>,
    /// First index or vertex.
    pub first: u32,
    /// Number of indices or vertices.
    pub count: u32,
    /// Number of instances.
    pub instances: u32,
    /// Assembly and rasterisation.
    pub primitive: PrimitiveState,
    /// Tests.
    pub depth_stencil: DepthStencilState,
    /// One per colour attachment of the pass.
    pub targets: Vec<ColorTargetState>,
    /// References of front and back faces.
    pub stencil_reference: [u8; 2],
    /// Blend constant.
    pub blend_constant: [f32; 4],
    /// `None`: all of the attachments.
    pub viewport: Option<Viewport>,
    /// `None`: all of the attachments.
    pub scissor: Option<ScissorRect>,
    /// The fragment shader.
    pub program: Option<Program>,
    /// Texture slots of the fragment shader.
    pub textures: Vec<TextureUse>,
    /// Tier of the GPU's fragment shader.
    pub fragment_tier: Tier,
    /// Tier of the GPU's vertex shader; a table is always read by a closure.
    pub vertex_tier: Tier,
    /// Where the GPU finds the vertices.
    pub vertex_source: VertexSource,
}

impl TwinDraw {
    /// Triangles without state, varyings and fragment shader.
    #[must_use]
    pub fn triangles(positions: Vec<[f32; 4]>) -> Self {
        Self {
            varyings: vec![Vec::new(); positions.len()],
            count: positions.len() as u32,
            positions,
            interpolation: Vec::new(),
            instance_offset: [0.0; 4],
            indices: None,
            first: 0,
            instances: 1,
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            targets: Vec::new(),
            stencil_reference: [0; 2],
            blend_constant: [0.0; 4],
            viewport: None,
            scissor: None,
            program: None,
            textures: Vec::new(),
            fragment_tier: Tier::Lanes,
            vertex_tier: Tier::Lanes,
            vertex_source: VertexSource::Buffer,
        }
    }
}

/// Draws into one set of attachments.
#[derive(Clone, Debug)]
pub struct TwinPass {
    /// Colour attachments.
    pub color: Vec<ColorUse>,
    /// Depth and stencil.
    pub depth: Option<DepthUse>,
    /// In order.
    pub draws: Vec<TwinDraw>,
}

/// A whole case.
#[derive(Clone, Debug)]
pub struct TwinCase {
    /// Width and height of all images.
    pub size: [u32; 2],
    /// Colour images.
    pub color: Vec<ColorImage>,
    /// The depth-stencil image.
    pub depth: Option<DepthImage>,
    /// Textures that no pass draws into.
    pub textures: Vec<TwinTexture>,
    /// In order.
    pub passes: Vec<TwinPass>,
}

impl TwinCase {
    /// Pixels of an image.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}

/// What one pass counted.
#[derive(Clone, Debug, PartialEq)]
pub struct PassOutcome {
    /// By draw.
    pub draws: Vec<Counters>,
    /// Of clears.
    pub clear: ClientTraffic,
    /// Block accesses in order, as an observer sees them.
    pub events: Vec<BlockAccess>,
    /// What more there is to say of them.
    pub details: EventDetails,
}

/// What an observer may be told of the events of a pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventDetails {
    /// Texels that were read.
    pub texels: Vec<TexelAccess>,
    /// Fragments of the probed pixel.
    pub fragments: Vec<FragmentRecord>,
    /// What shaders gave.
    pub outputs: Vec<ShadedBlock>,
    /// Where `outputs` point.
    pub values: Vec<u32>,
    /// What draws left in blocks, by draw, row and column; only the GPU tells.
    pub left: Vec<BlockLeft>,
    /// The stencil operation of each of `fragments`; only the twin tells.
    pub operations: Vec<Option<StencilOperation>>,
    /// The probed pixel before and after load operations, before and after store
    /// operations; only the twin tells.
    pub looks: Vec<Look>,
}

/// What a pixel holds in all images of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Look {
    /// Raw channels by image.
    pub color: Vec<[u32; 4]>,
    /// Depth and stencil as stored, if there is such an image.
    pub depth: Option<(u32, u8)>,
}

/// What the twin writes down beside events and outcome.
#[derive(Clone, Copy, Debug, Default)]
pub struct Log {
    /// [`EventDetails::fragments`] of this pixel.
    pub probe: Option<[u32; 2]>,
    /// What [`super::BlockHash`] makes of each block that was written.
    pub witness: bool,
}

/// Everything that a run leaves behind.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Raw texels of each colour image.
    pub color: Vec<Vec<[u32; 4]>>,
    /// Stored depth: D24 integers or float bits; empty without a depth image.
    pub depth: Vec<u32>,
    /// Stored stencil; empty without a depth image.
    pub stencil: Vec<u8>,
    /// By pass.
    pub passes: Vec<PassOutcome>,
}
