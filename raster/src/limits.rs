//! Sizes that the API does not go beyond.

/// Most colour attachments of a render pass.
pub const MAX_COLOR_ATTACHMENTS: usize = 4;
/// Most varyings of a vertex shader.
pub const MAX_VARYINGS: usize = 16;
/// Most texture slots of a draw.
pub const MAX_TEXTURES: usize = 8;
/// Numbers that a fragment shader may count.
pub const MAX_SHADER_COUNTS: usize = 4;
/// Most user clip planes.
pub const MAX_CLIP_PLANES: usize = 6;
/// Largest width, height or depth of a texture, in texels.
pub const MAX_TEXTURE_SIZE: u32 = 8192;
/// Most bytes that a texture's storage may take, padding to whole blocks included.
pub const MAX_TEXTURE_BYTES: u64 = 1 << 32;
/// Most vertices or indices of a draw.
pub const MAX_DRAW_VERTICES: u32 = 1 << 27;
/// Most instances of a draw.
pub const MAX_INSTANCES: u32 = 1 << 20;
/// Smallest width and height of a viewport, in pixels: 2⁻¹¹². Guard-band distances are
/// at most 2¹⁴ pixels over half of it, 2¹²⁷, and no float overflows.
pub const MIN_VIEWPORT_SIDE: f32 = f32::from_bits((127 - 112) << 23);
/// Most worker threads.
pub const MAX_THREADS: usize = 1024;
