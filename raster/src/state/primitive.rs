//! Primitive assembly, facing, viewport and scissor.

/// What the indices describe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PrimitiveTopology {
    /// Independent triangles; a trailing incomplete one is ignored.
    #[default]
    TriangleList,
    /// Independent line segments, drawn as rectangles of [`PrimitiveState::line_width`].
    LineList,
    /// Points, drawn as squares of [`PrimitiveState::point_size`].
    PointList,
}

impl PrimitiveTopology {
    /// Vertices per primitive.
    #[must_use]
    pub fn vertices(self) -> u32 {
        match self {
            Self::TriangleList => 3,
            Self::LineList => 2,
            Self::PointList => 1,
        }
    }
}

/// Winding, as seen on the screen with y up, of front-facing triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FrontFace {
    /// Counter-clockwise.
    #[default]
    Ccw,
    /// Clockwise.
    Cw,
}

/// Which facing is thrown away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CullMode {
    /// None.
    #[default]
    None,
    /// Front-facing triangles.
    Front,
    /// Back-facing triangles.
    Back,
}

/// Assembly and rasterisation state.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveState {
    /// What the indices describe.
    pub topology: PrimitiveTopology,
    /// Which winding is the front.
    pub front_face: FrontFace,
    /// Which facing is thrown away.
    pub cull_mode: CullMode,
    /// Clamp fragment depth to the viewport's range instead of clipping at the
    /// near and far planes.
    pub depth_clamp: bool,
    /// User clip planes in clip space, at most [`crate::MAX_CLIP_PLANES`]: a
    /// fragment is kept where `dot(plane, position) ≥ 0` for each of them.
    pub clip_planes: Vec<[f32; 4]>,
    /// Width of lines in pixels.
    pub line_width: f32,
    /// Side of points in pixels.
    pub point_size: f32,
}

impl Default for PrimitiveState {
    fn default() -> Self {
        Self {
            topology: PrimitiveTopology::default(),
            front_face: FrontFace::default(),
            cull_mode: CullMode::default(),
            depth_clamp: false,
            clip_planes: Vec::new(),
            line_width: 1.0,
            point_size: 1.0,
        }
    }
}

/// Maps normalised device coordinates to pixels; row 0 is the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left edge in pixels.
    pub x: f32,
    /// Top edge in pixels.
    pub y: f32,
    /// Width in pixels.
    pub width: f32,
    /// Height in pixels.
    pub height: f32,
    /// Depth of NDC z = 0, in 0..=1.
    pub min_depth: f32,
    /// Depth of NDC z = 1, in 0..=1.
    pub max_depth: f32,
}

impl Viewport {
    /// All of a `width`×`height` target, depth 0..1.
    #[must_use]
    pub fn full(width: u32, height: u32) -> Self {
        Self {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        }
    }
}

/// Pixels outside are not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScissorRect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}
