//! Block-level access events, for consumers that model caches, replay or explain.

use crate::MAX_COLOR_ATTACHMENTS;

/// What one primitive did to one 8×8 block. Bit `8·row + column` is a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockAccess {
    /// Number of the draw in its render pass.
    pub draw: u32,
    /// Number of the primitive in its draw, instances in turn.
    pub primitive: u32,
    /// Number of the triangle in its primitive (clipping and lines make several).
    pub piece: u32,
    /// Block column and row; pixel = 8 × block.
    pub block: [u16; 2],
    /// Fragments generated.
    pub covered: u64,
    /// Pixels whose depth was read.
    pub z_read: u64,
    /// Pixels whose depth was written.
    pub z_write: u64,
    /// Pixels whose stencil was read.
    pub stencil_read: u64,
    /// Pixels whose stencil was written.
    pub stencil_write: u64,
    /// Pixels whose colour was read, by attachment.
    pub color_read: [u64; MAX_COLOR_ATTACHMENTS],
    /// Pixels whose colour was written, by attachment.
    pub color_write: [u64; MAX_COLOR_ATTACHMENTS],
    /// The zmin/zmax entry was read.
    pub hiz_read: bool,
    /// The zmin/zmax entry was written.
    pub hiz_write: bool,
}

/// Receives the accesses of a render pass.
pub trait AccessObserver {
    /// All accesses of pass number `pass` in the command list, ordered by draw,
    /// primitive, piece, block row, block column: the same on every machine.
    fn render_pass(&mut self, pass: usize, label: &str, accesses: &[BlockAccess]);
}
